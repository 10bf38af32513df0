/* ggx.h - slopes with the tail of Trowbridge and Reitz
 *
 *   P22(r2)   = 1 / (pi (1 + r2)^2)
 *   Lambda(a) = (sqrt(1 + 1 / a^2) - 1) / 2
 *
 * [1] T. Trowbridge and K. Reitz, Average irregularity representation of a
 *     rough surface for ray reflection, JOSA 65(5), 1975.
 * [2] B. Walter et al., Microfacet Models for Refraction through Rough
 *     Surfaces, EGSR 2007, eq. 33-36.
 * [3] J. Dupuy and A. Benyoub, Sampling Visible GGX Normals with Spherical
 *     Caps, CGF 42(8), 2023.
 */
#ifndef BSDF_GGX_H
#define BSDF_GGX_H

#include "bsdf/fastmath.h"
#include "bsdf/lanes.h"

INLINE double ggx_p22(double r2)
{
    return 1 / (PI * (1 + r2) * (1 + r2));
}

/* Lambda, times 2 a (sqrt(1 + a^2) + a) over itself, so that nothing cancels;
 * from the tangent of the angle at unit roughness as the root of r2 over z, as
 * that needs no root of r2. */
INLINE double ggx_lambda_of(double r2, double z)
{
    return r2 / (2 * z * (sqrt(r2 + z * z) + z));
}

INLINE double ggx_lambda(double a)
{
    return 1 / (2 * a * (sqrt(1 + a * a) + a));
}

/* Inverts the share u of slopes whose square is below r2: r2 / (1 + r2). */
INLINE double ggx_r2_at(double u)
{
    return u / (1 - u);
}

/* [3]: w plus a direction uniform on the cap z > -w.z is along the normal.
 * With z = (1 - u) (1 + w.z) - w.z, both 1 - z and the normal's own z come out
 * without cancellation. */
INLINE struct vec3 ggx_visible(struct vec3 w, double u, double v)
{
    const double below = u * (1 + w.z), above = (1 - u) * (1 + w.z);
    const double r = sqrt(below * (2 - below));
    double sine, cosine;
    fm_sincos_turns(v, &sine, &cosine);
    return (struct vec3){ r * cosine + w.x, r * sine, above };
}

#endif
