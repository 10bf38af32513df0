/* trace.h - what a ray meets
 *
 * Embree finds the triangle in float; the point is then computed in double from
 * the triangle's corners.  Spheres and disks are intersected in double.
 */
#ifndef INTEGRATOR_TRACE_H
#define INTEGRATOR_TRACE_H

#include "bsdf/frame.h"
#include "integrator/scene.h"

struct hit {
    double distance;
    struct vec3 point;
    struct vec3 normal;   /* of the surface itself, unit */
    double hair;          /* how far off the surface rays start */
    struct frame shading; /* about the interpolated normal */
    const struct bsdf *bsdf;
    const struct bsdf_claims *claims; /* the BSDF's */
    const struct surface *surface;
    int light;  /* number of the light that was hit, or -1 */
    bool emits; /* against the ray */
};

/** Whether a ray meets something, and what. */
bool trace_hit(const struct scene *s, const struct ray *ray, struct hit *hit);

/** Whether something is between two points, neither of which counts: rays start
 * and end a hair away from the surface. */
bool trace_blocked(const struct scene *s, const struct ray *ray);

/** The ray from a hit toward dir; it starts a hair off the surface, on the side
 * that it goes to. */
struct ray trace_from(const struct hit *hit, struct vec3 dir);

/** The same that goes to a point and ends a hair before it. */
struct ray trace_to(const struct hit *hit, struct vec3 dir, struct vec3 point);

#endif
