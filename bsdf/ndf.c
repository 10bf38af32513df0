/* ndf.c - stretching a distribution, and sampling it
 *
 * A slope (x, y) of the stretched surface is (x / alpha_u, y / alpha_v) on the
 * surface of unit roughness; a direction w there is (alpha_u w.x, alpha_v w.y,
 * w.z), not normalised.  Cosines and roughnesses of 1e-8 are far from where
 * their squares underflow, so no hypot is needed.
 */
#include "bsdf/ndf.h"

double ndf_d(const struct ndf *ndf, double alpha_u, double alpha_v,
             struct vec3 m)
{
    const double z2 = m.z * m.z, z4 = z2 * z2;
    if (!(m.z > 0 && z4 > 0))
        return 0;
    const double x = m.x / (alpha_u * m.z), y = m.y / (alpha_v * m.z);
    return ndf->p22(x * x + y * y) / (alpha_u * alpha_v * z4);
}

double ndf_lambda(const struct ndf *ndf, double alpha_u, double alpha_v,
                  struct vec3 w)
{
    const double x = alpha_u * w.x, y = alpha_v * w.y;
    return ndf->lambda(fabs(w.z) / sqrt(x * x + y * y));
}

double ndf_g1(const struct ndf *ndf, double alpha_u, double alpha_v,
              struct vec3 w)
{
    return 1 / (1 + ndf_lambda(ndf, alpha_u, alpha_v, w));
}

struct vec3 ndf_sample_all(const struct ndf *ndf, double alpha_u,
                           double alpha_v, double u, double v)
{
    const double r = sqrt(ndf->r2_at(u)), phi = 2 * PI * v;
    return vec3_unit(
        (struct vec3){ alpha_u * r * cos(phi), alpha_v * r * sin(phi), 1 });
}

struct vec3 ndf_sample_visible(const struct ndf *ndf, double alpha_u,
                               double alpha_v, struct vec3 w, double u,
                               double v)
{
    const double x = alpha_u * w.x, y = alpha_v * w.y;
    const double s = sqrt(x * x + y * y), length = sqrt(s * s + w.z * w.z);
    const double c = s > 0 ? x / s : 1, d = s > 0 ? y / s : 0;
    const struct vec3 m =
        ndf->visible((struct vec3){ s / length, 0, w.z / length }, u, v);
    return vec3_unit((struct vec3){ alpha_u * (c * m.x - d * m.y),
                                    alpha_v * (d * m.x + c * m.y), m.z });
}
