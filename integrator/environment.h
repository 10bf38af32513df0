/* environment.h - a picture that surrounds the scene
 *
 * Rows are angles from +y, columns azimuths: theta = acos(y), phi = atan2(-z,
 * x) + pi, both from 0 at the upper left corner, as the course's maps are.
 * Radiance is constant over a pixel, so that sampling by radiance is exact.
 */
#ifndef INTEGRATOR_ENVIRONMENT_H
#define INTEGRATOR_ENVIRONMENT_H

#include "bsdf/bands.h"
#include "bsdf/vec.h"
#include "integrator/film.h"

struct environment;

/** Of a film's means, none negative, not all 0; name begins the sentence where
 * it is not.  Owned by the caller. */
struct environment *environment_new(const struct film *f, const char *name,
                                    struct err *err);
void environment_free(struct environment *e); /* NULL is fine */

struct spectrum environment_radiance(const struct environment *e,
                                     struct vec3 dir);

/** A direction at a density proportional to the luminance. */
struct vec3 environment_sample(const struct environment *e, double u, double v,
                               double *pdf);

/** That density [1/sr]. */
double environment_pdf(const struct environment *e, struct vec3 dir);

#endif
