/* facets.h - a stretched distribution of microfacets, for one call or many
 *
 * The arithmetic of ndf.h, which has the definitions, without a branch.  A
 * slope (x, y) of the stretched surface is (x / alpha_u, y / alpha_v) on the
 * surface of unit roughness; a direction w there is (alpha_u w.x, alpha_v w.y,
 * w.z), not normalised.  Cosines and roughnesses of 1e-8 are far from where
 * their squares underflow, so no hypot is needed.
 */
#ifndef BSDF_FACETS_H
#define BSDF_FACETS_H

#include "bsdf/beckmann.h"
#include "bsdf/ggx.h"
#include "bsdf/ndf.h"
#include "bsdf/vec.h"

struct facets {
    enum ndf_family family;
    double alpha_u, alpha_v;
    double per_u, per_v; /* 1 over them */
};

INLINE struct facets facets_of(enum ndf_family family, double alpha_u,
                               double alpha_v)
{
    return (struct facets){ family, alpha_u, alpha_v, 1 / alpha_u,
                            1 / alpha_v };
}

/** f with a family that the compiler sees, so that a loop has no branch on it.
 */
INLINE struct facets facets_as(struct facets f, enum ndf_family family)
{
    f.family = family;
    return f;
}

/** The half vector wo + wi, 2 wi.h long, and its square. */
INLINE struct vec3 facets_half(struct vec3 wo, struct vec3 wi, double *h2)
{
    const struct vec3 h = vec3_add(wo, wi);
    *h2 = vec3_dot(h, h);
    return h;
}

/** What D of the normal along m is made of, which may have any length and
 * m.z > 0; m2 = m.m. */
struct facets_part {
    double slope2;  /* of the unit roughness, squared; GGX has it in t */
    double t;       /* 1 / cos^2, or over 1 + slope^2 with GGX */
    double inverse; /* t / m2 */
};

INLINE struct facets_part facets_part(struct facets f, struct vec3 m, double m2)
{
    const double x = m.x * f.per_u, y = m.y * f.per_v;
    const double r2 = x * x + y * y;
    const double z2 = fm_max(m.z * m.z, 1e-300);
    if (f.family == NDF_GGX) { /* (1 + tan^2) / (1 + slope^2) */
        const double inverse = 1 / (z2 + r2);
        return (struct facets_part){ 0, m2 * inverse, inverse };
    }
    /* Where P22 is 0, 1 / cos^4 may be infinite. */
    const double inverse = 1 / z2, slope2 = r2 * inverse;
    const double finite = slope2 > 708 ? 0 : inverse;
    return (struct facets_part){ slope2, m2 * finite, finite };
}

/** The density of slopes that is left of D, per projected area. */
INLINE double facets_p22(struct facets f, double slope2)
{
    const double per_area = f.per_u * f.per_v;
    return f.family == NDF_GGX ? per_area / PI
                               : beckmann_p22(slope2) * per_area;
}

INLINE double facets_d(struct facets f, struct vec3 m, double m2)
{
    const struct facets_part d = facets_part(f, m, m2);
    return facets_p22(f, d.slope2) * (d.t * d.t);
}

/** How long the horizontal part of w is where the roughness is 1, squared. */
INLINE double facets_sine2(struct facets f, struct vec3 w)
{
    const double x = f.alpha_u * w.x, y = f.alpha_v * w.y;
    return x * x + y * y;
}

INLINE double facets_lambda(struct facets f, struct vec3 w)
{
    const double s2 = facets_sine2(f, w), z = fabs(w.z);
    return f.family == NDF_GGX ? ggx_lambda_of(s2, z)
                               : beckmann_lambda(z / sqrt(s2));
}

/** The squared slope, at unit roughness, below which a share u of all is. */
INLINE double facets_r2_at(struct facets f, double u)
{
    return f.family == NDF_GGX ? ggx_r2_at(u) : beckmann_r2_at(u);
}

/** A normal with that slope, v turns around, of any length. */
INLINE struct vec3 facets_around(struct facets f, double r2, double v)
{
    double sine, cosine;
    const double r = sqrt(r2);
    fm_sincos_turns(v, &sine, &cosine);
    return (struct vec3){ f.alpha_u * r * cosine, f.alpha_v * r * sine, 1 };
}

/** A normal with density D(m) m.z per solid angle, of any length. */
INLINE struct vec3 facets_all(struct facets f, double u, double v)
{
    return facets_around(f, facets_r2_at(f, u), v);
}

/** What the sampling of visible normals needs of w alone; seen from below, w.z
 * counts by its size. */
struct facets_view {
    double x, y; /* the azimuth of w where the roughness is 1 */
    union {
        struct vec3 ggx; /* (sin, 0, cos) there */
        struct beckmann_seen beckmann;
    };
};

INLINE struct facets_view facets_view(struct facets f, struct vec3 w)
{
    const double s = sqrt(facets_sine2(f, w)),
                 inverse = 1 / fm_max(s, 0x1p-1022);
    struct facets_view v = {
        s > 0 ? f.alpha_u * w.x * inverse : 1,
        f.alpha_v * w.y * inverse,
        .ggx = { 0, 0, 0 },
    };
    if (f.family == NDF_GGX) {
        const double length = 1 / sqrt(s * s + w.z * w.z);
        v.ggx = (struct vec3){ s * length, 0, fabs(w.z) * length };
    } else {
        v.beckmann = beckmann_seen_at(fabs(w.z) * inverse);
    }
    return v;
}

/** From a normal (m.x, m.y, m.z) of unit roughness, seen by (sin, 0, cos), to
 * the stretched one. */
INLINE struct vec3 facets_stretch(struct facets f, double x, double y,
                                  struct vec3 m)
{
    return (struct vec3){ f.alpha_u * (x * m.x - y * m.y),
                          f.alpha_v * (y * m.x + x * m.y), m.z };
}

/** A normal with density G1(w) max(0, w.m) D(m) / w.z, of any length. */
static inline struct vec3 facets_visible(struct facets f, struct vec3 w,
                                         double u, double v)
{
    const struct facets_view at = facets_view(f, w);
    const struct vec3 m =
        f.family == NDF_GGX
            ? ggx_visible(at.ggx, u, v)
            : (struct vec3){ beckmann_slope(at.beckmann, u), fm_probit(v), 1 };
    return facets_stretch(f, at.x, at.y, m);
}

/** Whether all directions have the bits of the first; n at least 1.  What
 * depends on such a direction alone need be computed but once, as of n = 1, and
 * be filled in from there. */
bool dirs_same(size_t n, struct dirs w);
void facets_fill(size_t n, double *x);

/** Lambda of n directions, n <= LANES_MAX. */
void facets_lambda_many(struct facets f, size_t n, struct dirs w,
                        double *lambda);

/** Normals as of facets_all and facets_visible, n <= LANES_MAX, from u.x and
 * u.y; one: all w are the same, as of dirs_same. */
void facets_all_many(struct facets f, size_t n, struct dirs u, double *mx,
                     double *my, double *mz);
void facets_visible_many(struct facets f, size_t n, struct dirs w, bool one,
                         struct dirs u, double *mx, double *my, double *mz);

#endif
