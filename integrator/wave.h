/* wave.h - many rays at once
 *
 * A wave is up to WAVE paths that go bounce by bounce together.  Numbers of its
 * rays are arrays, one a coordinate, so that loops over them are vector
 * instructions (bsdf/lanes.h).
 *
 * Embree takes rays in packets, and what a ray hits may depend, in the last
 * bits, on its companions.  So a wave consists of pieces: samples of one pixel,
 * whose number a pass of render.c decides, and a packet is of one piece's rays,
 * in an order that is the piece's own.  What else is in the wave changes
 * nothing.
 */
#ifndef INTEGRATOR_WAVE_H
#define INTEGRATOR_WAVE_H

#include <stdint.h>

#include "bsdf/lanes.h"
#include "bsdf/vec.h"

enum {
    WAVE = LANES_MAX,
    PACKET = 16, /* rays that Embree takes at a time */
    PIECE = 64   /* samples of a pixel */
};

struct vecs {
    double x[WAVE], y[WAVE], z[WAVE];
};

INLINE struct vec3 vecs_at(const struct vecs *v, size_t i)
{
    return (struct vec3){ v->x[i], v->y[i], v->z[i] };
}

INLINE void vecs_put(struct vecs *v, size_t i, struct vec3 a)
{
    v->x[i] = a.x, v->y[i] = a.y, v->z[i] = a.z;
}

/** As an array of directions, from one on. */
static inline struct dirs vecs_dirs(const struct vecs *v, size_t from)
{
    return (struct dirs){ v->x + from, v->y + from, v->z + from };
}

/** Rays; dir is unit, near and far are distances along it. */
struct rays {
    struct vecs origin, dir;
    double near[WAVE], far[WAVE];
};

/** Some of a wave's rays, in the order in which packets are filled. */
struct queue {
    size_t n;
    uint16_t ray[WAVE];
    uint16_t piece[WAVE]; /* of each, which rises */
};

#endif
