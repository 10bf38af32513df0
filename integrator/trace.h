/* trace.h - what rays meet
 *
 * Embree finds the triangle in float; the point is then computed in double from
 * the triangle's corners.  Spheres and disks are intersected in double.
 */
#ifndef INTEGRATOR_TRACE_H
#define INTEGRATOR_TRACE_H

#include "bsdf/frame.h"
#include "integrator/scene.h"
#include "integrator/wave.h"

struct shape; /* integrator/scene_parts.h */

/** What rays met, by the ray's number. */
struct met {
    const struct shape *shape[WAVE]; /* NULL: nothing */
    double distance[WAVE];
    uint32_t triangle[WAVE];
    double u[WAVE], v[WAVE]; /* shares of its second and third corner */
};

/** Places on surfaces. */
struct hits {
    const struct shape *shape[WAVE];
    struct vecs point;
    struct vecs normal;  /* of the surface itself, unit */
    double hair[WAVE];   /* how far off the surface rays start */
    struct vecs s, t, n; /* the frame about the interpolated normal */
    bool emits[WAVE];    /* against the ray */
};

INLINE struct frame hits_frame(const struct hits *h, size_t i)
{
    return (struct frame){ vecs_at(&h->s, i), vecs_at(&h->t, i),
                           vecs_at(&h->n, i) };
}

/** How far off a surface rays start, of a shape whose largest coordinate is
 * known. */
double trace_hair(double reach);

/** Whether the queue's rays meet something, and what; together: they mostly
 * take the same way. */
void trace_rays(const struct scene *s, const struct rays *rays,
                const struct queue *queue, bool together, struct met *met);

/** Whether rays may see something that emits, were nothing in the way: false
 * where they surely do not. */
void trace_toward_light(const struct scene *s, const struct rays *rays,
                        size_t n, bool *toward);

/** The places of those of n rays that met something. */
void trace_places(const struct rays *rays, const struct met *met,
                  const uint16_t *ray, size_t n, struct hits *hits);

/** Whether something is between two points, neither of which counts: rays start
 * and end a hair away from the surface. By the ray's number. */
void trace_blocked(const struct scene *s, const struct rays *rays,
                   const struct queue *queue, bool *blocked);

/** The rays from n places toward directions; they start a hair off the surface,
 * on the side that they go to. */
void trace_from(const struct hits *hits, size_t n, const struct vecs *dir,
                struct rays *rays);

/** The same that go to points and end a hair before them. */
void trace_to(const struct hits *hits, size_t n, const struct vecs *dir,
              const struct vecs *point, struct rays *rays);

#endif
