/* student_microfacet.cpp - a rough metal as a student writes it for a course
 *
 * CS184/284A's project 3-2: a class with f and sample_f, on the course's
 * masking, which has pi where sqrt(pi) belongs, and with its Fresnel term at
 * n.wi.  The metal is gold, Johnson and Christy at 614, 549 and 466 nm.
 */
#include "validate/adapters/course.hpp"

/* -- what the course's framework has --------------------------------------- */

struct Vector3D {
    double x, y, z;
    Vector3D(double x = 0, double y = 0, double z = 0) : x(x), y(y), z(z)
    {
    }
    Vector3D operator+(const Vector3D &v) const
    {
        return Vector3D(x + v.x, y + v.y, z + v.z);
    }
    Vector3D operator-(const Vector3D &v) const
    {
        return Vector3D(x - v.x, y - v.y, z - v.z);
    }
    Vector3D operator*(double s) const
    {
        return Vector3D(x * s, y * s, z * s);
    }
    double norm() const
    {
        return std::sqrt(x * x + y * y + z * z);
    }
    Vector3D unit() const
    {
        return *this * (1 / norm());
    }
};

static double dot(const Vector3D &a, const Vector3D &b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double random_uniform()
{
    return course::uniform();
}

static const double PI = 3.14159265358979323846;

/* -- what the student has -------------------------------------------------- */

class MicrofacetBSDF
{
  public:
    MicrofacetBSDF(Vector3D eta, Vector3D k, double alpha)
        : eta(eta), k(k), alpha(alpha)
    {
    }

    Vector3D f(const Vector3D wo, const Vector3D wi)
    {
        if (wo.z <= 0 || wi.z <= 0)
            return Vector3D();
        const Vector3D h = (wo + wi).unit();
        return F(wi) * (G(wo, wi) * D(h) / (4 * wo.z * wi.z));
    }

    Vector3D sample_f(const Vector3D wo, Vector3D *wi, double *pdf)
    {
        const double r1 = random_uniform(), r2 = random_uniform();
        const double theta =
            std::atan(std::sqrt(-alpha * alpha * std::log(1 - r1)));
        const double phi = 2 * PI * r2;
        const Vector3D h(std::sin(theta) * std::cos(phi),
                         std::sin(theta) * std::sin(phi), std::cos(theta));
        *wi = h * (2 * dot(wo, h)) - wo;
        if (wo.z <= 0 || wi->z <= 0) {
            *pdf = 0;
            return Vector3D();
        }
        *wi = wi->unit();
        *pdf = this->pdf(wo, *wi);
        return f(wo, *wi);
    }

    double pdf(const Vector3D wo, const Vector3D wi)
    {
        if (wo.z <= 0 || wi.z <= 0)
            return 0;
        const Vector3D h = (wo + wi).unit();
        return D(h) * h.z / (4 * dot(wi, h)); /* D cos = p_theta p_phi / sin */
    }

  private:
    Vector3D eta, k;
    double alpha;

    double Lambda(const Vector3D w)
    {
        const double a = 1 / (alpha * std::tan(std::acos(w.z)));
        return 0.5 * (std::erf(a) - 1 + std::exp(-a * a) / (a * PI));
    }

    double G(const Vector3D wo, const Vector3D wi)
    {
        return 1 / (1 + Lambda(wi) + Lambda(wo));
    }

    double D(const Vector3D h)
    {
        const double c2 = h.z * h.z, t2 = (1 - c2) / c2, a2 = alpha * alpha;
        return std::exp(-t2 / a2) / (PI * a2 * c2 * c2);
    }

    static double reflectance(double n, double kappa, double c)
    {
        const double n2 = n * n + kappa * kappa, c2 = c * c, nc = 2 * n * c;
        return ((n2 - nc + c2) / (n2 + nc + c2) +
                (n2 * c2 - nc + 1) / (n2 * c2 + nc + 1)) /
               2;
    }

    Vector3D F(const Vector3D wi)
    {
        return Vector3D(reflectance(eta.x, k.x, wi.z),
                        reflectance(eta.y, k.y, wi.z),
                        reflectance(eta.z, k.z, wi.z));
    }
};

/* -- what the student adds ------------------------------------------------- */

struct Student : course::model<Vector3D> {
    MicrofacetBSDF bsdf;
    explicit Student(const double *v)
        : bsdf(Vector3D(0.216455, 0.428328, 1.32844),
               Vector3D(3.239, 2.45987, 1.86612), v[0])
    {
    }
    static const bsdf_plugin_param *params()
    {
        static const bsdf_plugin_param p[] = {
            { "alpha", 0.5, 1e-3, 1, "roughness" }, {}
        };
        return p;
    }
    static unsigned lobes()
    {
        return BSDF_PLUGIN_GLOSSY_REFLECTION;
    }
    Vector3D f(Vector3D wo, Vector3D wi)
    {
        return bsdf.f(wo, wi);
    }
    Vector3D sample_f(Vector3D wo, Vector3D *wi, double *pdf)
    {
        return bsdf.sample_f(wo, wi, pdf);
    }
#ifndef NO_PDF
    double pdf(Vector3D wo, Vector3D wi)
    {
        return bsdf.pdf(wo, wi);
    }
#endif
};
COURSE_PLUGIN("student", Student)
