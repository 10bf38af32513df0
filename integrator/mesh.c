/* mesh.c - triangles
 *
 * Normals weighted by area are the sum of the triangles' cross products: H.
 * Gouraud, Continuous Shading of Curved Surfaces, IEEE Transactions on
 * Computers C-20, 1971, with weights.
 */
#include "integrator/mesh.h"

#include <stdlib.h>

static const size_t most = (size_t)1 << 31;

struct mesh *mesh_new(size_t vertices, size_t triangles, bool normals,
                      struct err *err)
{
    if (vertices > most || triangles > most) {
        err_set(err,
                "mesh: %zu vertices and %zu triangles: expected at most %zu",
                vertices, triangles, most);
        return NULL;
    }
    struct mesh *m = calloc(1, sizeof *m);
    if (m) {
        *m = (struct mesh){ .vertices = vertices, .triangles = triangles };
        /* Never 0 bytes, for which NULL would be no failure. */
        m->xyz = calloc(3 * vertices + 1, sizeof *m->xyz);
        m->index = calloc(3 * triangles + 1, sizeof *m->index);
        m->normal =
            normals ? calloc(3 * vertices + 1, sizeof *m->normal) : NULL;
        if (m->xyz && m->index && (m->normal || !normals))
            return m;
        mesh_free(m);
    }
    err_set(err, "mesh: out of memory for %zu vertices and %zu triangles",
            vertices, triangles);
    return NULL;
}

void mesh_free(struct mesh *m)
{
    if (!m)
        return;
    free(m->xyz);
    free(m->normal);
    free(m->index);
    free(m);
}

static bool floats_check(const float *value, size_t vertices, const char *name,
                         const char *what, struct err *err)
{
    for (size_t i = 0; i < 3 * vertices; i++)
        if (!isfinite(value[i]))
            return err_set(err,
                           "%s: %s of vertex %zu is %g: expected a finite "
                           "number",
                           name, what, i / 3, (double)value[i]);
    return true;
}

bool mesh_check(const struct mesh *m, const char *name, struct err *err)
{
    if (m->triangles == 0)
        return err_set(err, "%s: it has no triangles", name);
    for (size_t i = 0; i < 3 * m->triangles; i++)
        if (m->index[i] >= m->vertices)
            return err_set(err,
                           "%s: triangle %zu has vertex %u: expected a number "
                           "below %zu, as many as there are",
                           name, i / 3, m->index[i], m->vertices);
    return floats_check(m->xyz, m->vertices, name, "a coordinate", err) &&
           (!m->normal ||
            floats_check(m->normal, m->vertices, name, "the normal", err));
}

struct vec3 mesh_cross(const struct mesh *m, size_t triangle)
{
    const struct vec3 a = mesh_vertex(m, triangle, 0);
    return vec3_cross(vec3_minus(mesh_vertex(m, triangle, 1), a),
                      vec3_minus(mesh_vertex(m, triangle, 2), a));
}

bool mesh_smooth(struct mesh *m, struct err *err)
{
    struct vec3 *sum = calloc(m->vertices + 1, sizeof *sum);
    if (sum && !m->normal)
        m->normal = calloc(3 * m->vertices + 1, sizeof *m->normal);
    if (!sum || !m->normal) {
        free(sum);
        return err_set(err, "mesh: out of memory for %zu normals", m->vertices);
    }
    for (size_t i = 0; i < m->triangles; i++) {
        const struct vec3 n = mesh_cross(m, i);
        for (size_t k = 0; k < 3; k++) {
            struct vec3 *at = &sum[m->index[3 * i + k]];
            *at = vec3_add(*at, n);
        }
    }
    for (size_t i = 0; i < m->vertices; i++) {
        /* A vertex of no triangle, or of ones that cancel out, points up. */
        const double length = vec3_length(sum[i]);
        const struct vec3 n = length > 0 && isfinite(length)
                                  ? vec3_scale(1 / length, sum[i])
                                  : (struct vec3){ 0, 1, 0 };
        float *to = m->normal + 3 * i;
        to[0] = (float)n.x, to[1] = (float)n.y, to[2] = (float)n.z;
    }
    free(sum);
    return true;
}
