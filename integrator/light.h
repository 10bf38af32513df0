/* light.h - sampling what emits
 *
 * Lights are numbered from 0.  Rectangles, disks and meshes are sampled by
 * area, spheres from outside by the cone that they fill, others by the solid
 * angle that they emit from.
 */
#ifndef INTEGRATOR_LIGHT_H
#define INTEGRATOR_LIGHT_H

#include "integrator/trace.h"

struct light_sample {
    struct vec3 wi;           /* unit, toward the light */
    struct vec3 point;        /* of the light */
    bool infinite;            /* a background, which has no points */
    double pdf;               /* [1/sr]; 1 where delta is set */
    struct spectrum radiance; /* from there; for a point, intensity over
                                 distance^2 */
    bool delta;               /* nothing else would find it */
};

int light_count(const struct scene *s);

/** One of a light's points as seen from another; pdf 0 where there is none that
 * sends light there.  compat: COMPAT_LIGHT_PDF counts. */
struct light_sample light_sample(const struct scene *s, int light,
                                 struct vec3 from, double u, double v,
                                 unsigned compat);

/** The density at which light_sample would have found what a ray hit, or, for a
 * background and hit NULL, its direction. */
double light_pdf(const struct scene *s, int light, struct vec3 from,
                 struct vec3 dir, const struct hit *hit);

/** What a ray that leaves the scene sees of a light; 0 of those that are no
 * background. */
struct spectrum light_background(const struct scene *s, int light,
                                 struct vec3 dir);

/** Whether it is a point. */
bool light_is_point(const struct scene *s, int light);

/** Whether rays that sample a BSDF can find it. */
bool light_can_be_hit(const struct scene *s, int light);

#endif
