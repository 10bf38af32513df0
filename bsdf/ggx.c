/* ggx.c - slopes with the tail of Trowbridge and Reitz
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
#include "bsdf/ndf.h"

static double p22(double r2)
{
    return 1 / (PI * (1 + r2) * (1 + r2));
}

/* (sqrt(1 + t) - 1) / 2 with t = 1 / a^2, without its cancellation; for small
 * a from hypot, as t would overflow. */
static double lambda(double a)
{
    if (a < 1)
        return (hypot(a, 1) - a) / (2 * a);
    const double t = 1 / (a * a);
    return t / (2 * (1 + sqrt(1 + t)));
}

/* Inverts the share u of slopes whose square is below r2: r2 / (1 + r2). */
static double r2_at(double u)
{
    return u / (1 - u);
}

/* [3]: w plus a direction uniform on the cap z > -w.z is along the normal.
 * With z = (1 - u) (1 + w.z) - w.z, both 1 - z and the normal's own z come out
 * without cancellation. */
static struct vec3 visible(struct vec3 w, double u, double v)
{
    const double below = u * (1 + w.z), above = (1 - u) * (1 + w.z);
    const double r = sqrt(below * (2 - below)), phi = 2 * PI * v;
    return (struct vec3){ r * cos(phi) + w.x, r * sin(phi), above };
}

const struct ndf ndf_ggx = {
    .name = "ggx",
    .p22 = p22,
    .lambda = lambda,
    .r2_at = r2_at,
    .visible = visible,
};
