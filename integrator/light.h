/* light.h - sampling what emits
 *
 * Lights are numbered from 0.  Rectangles, disks and meshes are sampled by
 * area, spheres from outside by the cone that they fill, others by the solid
 * angle that they emit from.
 */
#ifndef INTEGRATOR_LIGHT_H
#define INTEGRATOR_LIGHT_H

#include "integrator/trace.h"

/** Where n vertices look for a light. */
struct light_samples {
    struct vecs wi;    /* unit, toward the light */
    struct vecs point; /* of the light; not of one that is infinite */
    double pdf[WAVE];  /* [1/sr], 0 where there is no light; 1 of a point's */
    struct spectrum radiance[WAVE]; /* from there; of a point, intensity over
                                       distance^2 */
};

int light_count(const struct scene *s);

/** One of a light's points for each of n places, by the first two numbers of u;
 * pdf 0 where it sends no light there.  compat: COMPAT_LIGHT_PDF counts. */
void light_sample(const struct scene *s, int light, size_t n,
                  const struct vecs *from, const struct vecs *u,
                  unsigned compat, struct light_samples *out);

/** A point of a light, and the surface's normal there. */
struct light_hit {
    struct vec3 point, normal;
};

/** The density at which light_sample would have found what a ray hit, or, for a
 * background and hit NULL, its direction. */
double light_pdf(const struct scene *s, int light, struct vec3 from,
                 struct vec3 dir, const struct light_hit *hit);

/** What a ray that leaves the scene sees of a light; 0 of those that are no
 * background. */
struct spectrum light_background(const struct scene *s, int light,
                                 struct vec3 dir);

/** Whether it is a point, which nothing but its own samples finds. */
bool light_is_point(const struct scene *s, int light);

/** Whether it is a background, which has no points. */
bool light_is_infinite(const struct scene *s, int light);

/** Whether rays that sample a BSDF can find it. */
bool light_can_be_hit(const struct scene *s, int light);

#endif
