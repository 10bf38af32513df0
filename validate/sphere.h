/* sphere.h - integrals over parts of the sphere, with an error bound
 *
 * Polar angles [rad]: theta from the normal, phi about it.
 */
#ifndef VALIDATE_SPHERE_H
#define VALIDATE_SPHERE_H

#include "bsdf/vec.h"
#include "validate/quadrature.h"

struct patch {
    double theta0, theta1, phi0, phi1;
};

/** The direction in the middle of the angles. */
static inline struct vec3 patch_centre(struct patch p)
{
    const double theta = (p.theta0 + p.theta1) / 2;
    const double phi = (p.phi0 + p.phi1) / 2;
    return (struct vec3){ sin(theta) * cos(phi), sin(theta) * sin(phi),
                          cos(theta) };
}

/** Fills value[part * n + i] with the part-th integrand at w[i]. */
typedef void sphere_fn(const void *context, size_t n, struct dirs w,
                       double *value);

/** Adds the integrals over a patch to out; see quadrature.  The n directions in
 * it, which may be none, are where the integrand is known to be large; at most
 * PATCH_HINTS_MAX are heeded. */
enum { PATCH_HINTS_MAX = 256 };
void patch_integrate(sphere_fn *f, const void *context, int parts,
                     struct patch p, double tolerance, long *budget,
                     const struct vec3 *hint, size_t n, struct estimate *out);

/** The integral over the upper hemisphere of a function that may peak at the
 * normal, down to a width of 1e-5 rad, and along the x and y axes. */
struct estimate hemisphere(double (*f)(struct vec3 w, const void *context),
                           const void *context);

/** The same over the directions in it that face wo, w.wo > 0; wo.z > 0.  The
 * tolerance is a leaf's, see quadrature; hemisphere has 1e-11. */
struct estimate
hemisphere_facing(double (*f)(struct vec3 w, const void *context),
                  const void *context, struct vec3 wo, double tolerance);

#endif
