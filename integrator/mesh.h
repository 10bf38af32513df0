/* mesh.h - triangles
 *
 * A triangle's own normal follows the right hand around its vertices.
 */
#ifndef INTEGRATOR_MESH_H
#define INTEGRATOR_MESH_H

#include <stddef.h>

#include "bsdf/err.h"
#include "integrator/affine.h"

struct mesh {
    size_t vertices, triangles;
    float *xyz;      /* 3 a vertex, in the world */
    float *normal;   /* 3 a vertex, unit, interpolated; NULL for flat ones */
    unsigned *index; /* 3 a triangle, each below vertices */
};

/** With room for so many, normals too if asked for; NULL when out of memory or
 * above 2^31 of either. Owned by the caller. */
struct mesh *mesh_new(size_t vertices, size_t triangles, bool normals,
                      struct err *err);
void mesh_free(struct mesh *m); /* NULL is fine */

/** Whether every number is finite and every index there; name begins the
 * sentence where not. */
bool mesh_check(const struct mesh *m, const char *name, struct err *err);

/** Gives each vertex the unit sum of its triangles' normals, weighted by area;
 * allocates the array where there is none. */
bool mesh_smooth(struct mesh *m, struct err *err);

static inline struct vec3 mesh_vertex(const struct mesh *m, size_t triangle,
                                      int corner)
{
    const float *p =
        m->xyz + 3 * (size_t)m->index[3 * triangle + (size_t)corner];
    return (struct vec3){ (double)p[0], (double)p[1], (double)p[2] };
}

/** Twice the area times the unit normal. */
struct vec3 mesh_cross(const struct mesh *m, size_t triangle);

#endif
