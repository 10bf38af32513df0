/* course.hpp - a BSDF class of a rendering course as a plugin
 *
 * SPDX-License-Identifier: MIT-0, as bsdf/plugin.h, which has its text.
 *
 * For classes like those of CS184/284A's path tracer: f and the result of
 * sample_f are vectors of R, G and B, directions are vectors in the frame with
 * z along the normal, sample_f draws its own random numbers and gives wi and
 * the pdf through pointers.  Needs C++11.  What is to be written:
 *
 *     #include "bsdf/course.hpp"
 *     #include "my_bsdf.h"
 *
 *     struct Mine : course::model<Vector3D> {
 *         MyBSDF bsdf;
 *         explicit Mine(const double *v) : bsdf(v[0]) {}
 *         static const bsdf_plugin_param *params() {
 *             static const bsdf_plugin_param p[] = {
 *                 { "alpha", 0.5, 1e-3, 1, "roughness" }, {} };
 *             return p;
 *         }
 *         static unsigned lobes() { return BSDF_PLUGIN_GLOSSY_REFLECTION; }
 *         Vector3D f(Vector3D wo, Vector3D wi) { return bsdf.f(wo, wi); }
 *         Vector3D sample_f(Vector3D wo, Vector3D *wi, double *pdf) {
 *             return bsdf.sample_f(wo, wi, pdf);
 *         }
 *         double pdf(Vector3D wo, Vector3D wi) { ... }
 *     };
 *     COURSE_PLUGIN("mine", Mine)
 *
 * and built by c++ -shared -fPIC -o mine.so mine.cpp.
 *
 * Random numbers: sample_f must draw them from course::uniform(), so that it
 * gives the same sample for the same u: let the class's own generator return
 * it, as by -Drandom_uniform=course::uniform on the compiler's command line
 * (and this header included before).  The first three are u; any more, as for a
 * rejection loop, follow from u.
 *
 * pdf: sample_f tells the density of what it drew, but a check must ask it
 * anywhere.  A class without one can be loaded, but says that it needs one.
 *
 * A sample with pdf 0 is taken for a refused one.  One of a delta lobe has
 * f = reflectance / |cos| and its probability as pdf, as the course has it.
 */
#ifndef BSDF_COURSE_HPP
#define BSDF_COURSE_HPP

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <type_traits>

#include "bsdf/plugin.h"

namespace course
{

/** What a model may have otherwise than the course. */
template <class V> struct model {
    typedef V vector;
    static V make(double x, double y, double z)
    {
        return V(x, y, z);
    }
    static double x(const V &v)
    {
        return v.x;
    }
    static double y(const V &v)
    {
        return v.y;
    }
    static double z(const V &v)
    {
        return v.z;
    }

    static const bsdf_plugin_param *params()
    {
        return nullptr;
    }
    static bool cosine_included()
    {
        return false;
    } /* f is f |wi.z| */
    static bool reciprocal()
    {
        return true;
    }
    static bool two_sided()
    {
        return false;
    }
    static bool single()
    {
        return false;
    } /* computes in float */
    double eta() const
    {
        return 1;
    }
    /** Whether a direction that sample_f gave is of a delta lobe; called right
     * after it.  All or none, if not said otherwise. */
    template <class M> static bool is_delta(const M &)
    {
        const unsigned delta =
            BSDF_PLUGIN_DELTA_REFLECTION | BSDF_PLUGIN_DELTA_TRANSMISSION;
        return (M::lobes() & ~delta) == 0;
    }
};

namespace detail
{

struct source {
    double u[3];
    int drawn;
    std::uint64_t state;
};

inline source &the_source()
{
    static source s;
    return s;
}

/* SplitMix64: G. Steele, D. Lea and C. Flood, Fast Splittable Pseudorandom
 * Number Generators, OOPSLA 2014. */
inline std::uint64_t mix(std::uint64_t &state)
{
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

inline void feed(const double *u)
{
    source &s = the_source();
    s.drawn = 0;
    s.state = 0;
    for (int i = 0; i < 3; i++) {
        std::uint64_t bits;
        s.u[i] = u[i];
        std::memcpy(&bits, &u[i], sizeof bits);
        s.state ^= bits;
        s.state = mix(s.state);
    }
}

/* Whether M has double pdf(V, V). */
template <class M> struct has_pdf {
    typedef typename M::vector V;
    template <class T>
    static auto test(T *m)
        -> decltype(double(m->pdf(V(), V())), std::true_type());
    static std::false_type test(...);
    enum { value = decltype(test(static_cast<M *>(nullptr)))::value };
};

template <class M>
double pdf_of(M &m, const typename M::vector &wo, const typename M::vector &wi,
              std::true_type)
{
    return m.pdf(wo, wi);
}

template <class M>
double pdf_of(M &, const typename M::vector &, const typename M::vector &,
              std::false_type)
{
    return 0;
}

} // namespace detail

/** The next random number of the sample that is being drawn, in [0, 1). */
inline double uniform()
{
    detail::source &s = detail::the_source();
    if (s.drawn < 3)
        return s.u[s.drawn++];
    return double(detail::mix(s.state) >> 11) / 9007199254740992.0; /* 2^53 */
}

/** The plugin of a model M. */
template <class M> struct plugin {
    typedef typename M::vector V;
    enum { BANDS = 3 };

    static void *create(const double *values, int bands, const double *,
                        char *why, size_t size)
    {
        if (!detail::has_pdf<M>::value)
            std::snprintf(why, size,
                          "a function double pdf(Vector wo, Vector wi) is "
                          "needed: the density with which sample_f draws wi");
        else if (bands != BANDS)
            std::snprintf(why, size, "made for 3 bands, not for %d", bands);
        else
            try {
                return new M(values);
            } catch (const std::exception &e) {
                std::snprintf(why, size, "%s", e.what());
            }
        return nullptr;
    }

    static void destroy(void *state)
    {
        delete static_cast<M *>(state);
    }

    static M &of(const void *state)
    {
        return *static_cast<M *>(const_cast<void *>(state));
    }

    static V at(const double *x)
    {
        return M::make(x[0], x[1], x[2]);
    }

    static void put(const V &v, double *x)
    {
        x[0] = M::x(v);
        x[1] = M::y(v);
        x[2] = M::z(v);
    }

    static void claims(const void *state, bsdf_plugin_claims *c)
    {
        c->lobes = M::lobes();
        c->reciprocal = M::reciprocal();
        c->two_sided = M::two_sided();
        c->eta = of(state).eta();
        c->single = M::single();
        c->cosine_included = M::cosine_included();
    }

    static void eval(const void *state, int bands, size_t n, const double *in,
                     double *out)
    {
        for (size_t i = 0; i < n; i++, in += 6, out += bands)
            put(of(state).f(at(in), at(in + 3)), out);
    }

    static void pdf(const void *state, int, size_t n, const double *in,
                    double *out)
    {
        const std::integral_constant<bool, detail::has_pdf<M>::value> has{};
        for (size_t i = 0; i < n; i++, in += 6)
            *out++ = detail::pdf_of(of(state), at(in), at(in + 3), has);
    }

    static void sample(const void *state, int bands, size_t n, const double *in,
                       double *out)
    {
        for (size_t i = 0; i < n; i++, in += 6, out += 5 + bands) {
            M &m = of(state);
            V wi = M::make(0, 0, 0);
            double density = 0;
            detail::feed(in + 3);
            const V f = m.sample_f(at(in), &wi, &density);
            if (density == 0)
                continue;
            put(wi, out);
            put(f, out + 4);
            out[3] = density;
            const double cosine = M::cosine_included() ? 1 : std::fabs(out[2]);
            for (int b = 0; b < bands; b++)
                out[4 + b] *= cosine / density;
            out[4 + bands] = M::is_delta(m);
        }
    }
};

} // namespace course

/** Makes M the model of this shared object. */
#define COURSE_PLUGIN(name, M)                                                 \
    BSDF_PLUGIN_EXPORT const struct bsdf_plugin *bsdf_plugin(void)             \
    {                                                                          \
        typedef course::plugin<M> P;                                           \
        static const struct bsdf_plugin it = {                                 \
            BSDF_PLUGIN_ABI, sizeof it, name,       "a BSDF of a course",      \
            M::params(),     P::create, P::destroy, P::claims,                 \
            P::eval,         P::pdf,    P::sample                              \
        };                                                                     \
        return &it;                                                            \
    }

#endif
