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

/** A patch, the n directions in it where the integrand is known to be large,
 * of which at most PATCH_HINTS_MAX are heeded, and where its integrals are
 * added, an estimate a part. */
enum { PATCH_HINTS_MAX = 256 };
struct patch_job {
    struct patch patch;
    struct dirs hint;
    size_t n;
    struct estimate *out;
};

/** Integrates over the patch of each job; see quadrature.  Theta is its x and
 * phi its y for beside, which may be NULL; f is asked about up to a batch of
 * directions at a time.  False when out of memory. */
bool patches_integrate(sphere_fn *f, const void *context, int parts,
                       const struct patch_job *job, size_t jobs,
                       quadrature_beside *beside, const void *mesh,
                       double tolerance, size_t batch, long *budget);

/** The integral over the upper hemisphere of a function that may peak at the
 * normal, down to a width of 1e-5 rad, and along the x and y axes; NaN when out
 * of memory. */
struct estimate hemisphere(double (*f)(struct vec3 w, const void *context),
                           const void *context);

/** The same over the directions in it that face wo, w.wo > 0; wo.z > 0.  The
 * tolerance is a leaf's, see quadrature; hemisphere has 1e-11. */
struct estimate
hemisphere_facing(double (*f)(struct vec3 w, const void *context),
                  const void *context, struct vec3 wo, double tolerance);

#endif
