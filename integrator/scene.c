/* scene.c - filling a scene */
#include "integrator/scene.h"

#include <math.h>
#include <search.h>
#include <stdlib.h>
#include <string.h>

#include "integrator/environment.h"
#include "integrator/scene_parts.h"

/* A node of the tree of specs. */
struct named {
    const char *spec; /* of the instance */
    int number;
};

static int named_compare(const void *a, const void *b)
{
    const struct named *x = a, *y = b;
    return strcmp(x->spec, y->spec);
}

struct scene *scene_new(const struct bands *bands, struct err *err)
{
    struct scene *s = calloc(1, sizeof *s);
    if (!s) {
        err_set(err, "scene: out of memory");
        return NULL;
    }
    s->bands = *bands;
    s->wishes = (struct scene_wishes){ -1, -1, -1, false };
    s->lo = (struct vec3){ INFINITY, INFINITY, INFINITY };
    s->hi = (struct vec3){ -INFINITY, -INFINITY, -INFINITY };
    s->glow_lo = s->lo;
    s->glow_hi = s->hi;
    return s;
}

void scene_free(struct scene *s)
{
    if (!s)
        return;
    if (s->embree)
        rtcReleaseScene(s->embree);
    if (s->device)
        rtcReleaseDevice(s->device);
    for (size_t i = 0; i < s->shapes; i++) {
        mesh_free(s->shape[i].mesh);
        free((char *)s->shape[i].surface.name);
        free(s->shape[i].cumulated);
    }
    for (size_t i = 0; i < s->lights; i++)
        environment_free(s->light[i].light.environment);
    tdestroy(s->by_spec, free);
    for (size_t i = 0; i < s->bsdfs; i++)
        bsdf_free(s->bsdf[i]);
    free(s->bsdf);
    free(s->shape);
    free(s->light);
    free(s);
}

const struct bands *scene_bands(const struct scene *s)
{
    return &s->bands;
}

/* Room for one more element of an array that grows. */
static bool grow(void **array, size_t n, size_t *room, size_t size,
                 struct err *err)
{
    if (n < *room)
        return true;
    const size_t more = *room ? 2 * *room : 16;
    void *larger = realloc(*array, more * size);
    if (!larger)
        return err_set(err, "scene: out of memory for %zu elements", more);
    *array = larger;
    *room = more;
    return true;
}

int scene_add_bsdf(struct scene *s, const char *spec, struct err *err)
{
    if (err)
        err->text[0] = '\0';
    const struct named key = { spec, 0 };
    struct named **found = tfind(&key, &s->by_spec, named_compare);
    if (found)
        return (*found)->number;
    struct bsdf *b = bsdf_new(spec, &s->bands, err);
    if (!b)
        return -1;
    struct named *node = malloc(sizeof *node);
    if (!node || !grow((void **)&s->bsdf, s->bsdfs, &s->bsdfs_room,
                       sizeof(struct bsdf *), err)) {
        free(node);
        bsdf_free(b);
        err_set(err, "scene: out of memory");
        return -1;
    }
    *node = (struct named){ bsdf_spec(b), (int)s->bsdfs };
    if (!tsearch(node, &s->by_spec, named_compare)) {
        free(node);
        bsdf_free(b);
        err_set(err, "scene: out of memory");
        return -1;
    }
    s->bsdf[s->bsdfs] = b;
    return (int)s->bsdfs++;
}

static void enclose(struct vec3 p, struct vec3 *lo, struct vec3 *hi)
{
    *lo = (struct vec3){ fmin(lo->x, p.x), fmin(lo->y, p.y), fmin(lo->z, p.z) };
    *hi = (struct vec3){ fmax(hi->x, p.x), fmax(hi->y, p.y), fmax(hi->z, p.z) };
}

/* Of the shape that was added last, too. */
static void box_add(struct scene *s, struct vec3 p)
{
    struct shape *a = &s->shape[s->shapes - 1];
    a->reach = fmax(a->reach, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
    enclose(p, &s->lo, &s->hi);
    if (a->flags & SHAPE_EMITS && !a->mesh)
        enclose(p, &s->glow_lo, &s->glow_hi);
}

/* Of what emits; of a mesh not all vertices need belong to triangles. */
static void glow_add(struct scene *s, const struct mesh *m)
{
    for (size_t i = 0; i < m->triangles; i++)
        for (int k = 0; k < 3; k++)
            enclose(mesh_vertex(m, i, k), &s->glow_lo, &s->glow_hi);
}

static bool finite3(struct vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static bool emits(const struct scene *s, const struct spectrum *radiance)
{
    bool any = false;
    for (int b = 0; b < s->bands.count; b++)
        any |= radiance->band[b] > 0;
    return any;
}

static bool radiance_check(const struct scene *s, const char *name,
                           const struct spectrum *radiance, struct err *err)
{
    for (int b = 0; b < s->bands.count; b++)
        if (!(radiance->band[b] >= 0 && isfinite(radiance->band[b])))
            return err_set(err, "%s: radiance %g: expected at least 0", name,
                           radiance->band[b]);
    return true;
}

/* Adds a light; the shape's number or -1. */
static int light_add(struct scene *s, const struct light *light, int shape,
                     double area, struct vec3 normal, struct err *err)
{
    if (!grow((void **)&s->light, s->lights, &s->lights_room, sizeof *s->light,
              err))
        return -1;
    s->light[s->lights] = (struct light_source){ shape, *light, area, normal };
    return (int)s->lights++;
}

/* The triangles' areas, summed up; NULL when out of memory. */
static double *areas(const struct mesh *m)
{
    double *sum = malloc(m->triangles * sizeof *sum), total = 0;
    for (size_t i = 0; sum && i < m->triangles; i++)
        sum[i] = total += vec3_length(mesh_cross(m, i)) / 2;
    return sum;
}

/* Adds a shape, which then owns what it points to, and the light that it is. */
static bool shape_add(struct scene *s, struct shape *shape,
                      const struct surface *surface, struct err *err)
{
    const char *name = surface->name ? surface->name : "shape";
    const bool glows = emits(s, &surface->radiance);
    if (surface->bsdf < 0 || (size_t)surface->bsdf >= s->bsdfs)
        return err_set(err, "%s: it has no BSDF", name);
    if (!radiance_check(s, name, &surface->radiance, err))
        return false;
    if (glows && !(shape->area > 0 && isfinite(shape->area)))
        return err_set(err, "%s: it emits, but its area is %g", name,
                       shape->area);
    if (!grow((void **)&s->shape, s->shapes, &s->shapes_room, sizeof *shape,
              err))
        return false;
    shape->surface = *surface;
    shape->surface.name = strdup(name);
    shape->bsdf = s->bsdf[surface->bsdf];
    shape->claims = bsdf_claims(shape->bsdf);
    shape->light = -1;
    shape->flags |= glows ? SHAPE_EMITS : 0;
    const bool samples = glows && !surface->unsampled;
    const bool listed =
        samples && shape->mesh && !(shape->flags & SHAPE_RECTANGLE);
    if (listed)
        shape->cumulated = areas(shape->mesh);
    if (!shape->surface.name || (listed && !shape->cumulated)) {
        free((char *)shape->surface.name);
        free(shape->cumulated);
        return err_set(err, "%s: out of memory", name);
    }
    if (samples) {
        const struct light light = { .radiance = surface->radiance };
        shape->light = light_add(s, &light, (int)s->shapes, shape->area,
                                 shape->normal, err);
        if (shape->light < 0) {
            free((char *)shape->surface.name);
            free(shape->cumulated);
            return false;
        }
    }
    s->shape[s->shapes++] = *shape;
    return true;
}

/* Whether two triangles make a parallelogram, and which: their common edge is
 * its diagonal. */
static bool rectangle_find(const struct mesh *m, struct shape *shape)
{
    if (m->triangles != 2 || m->normal)
        return false;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            /* Opposite corners, and the diagonal between them. */
            const struct vec3 a = mesh_vertex(m, 0, i);
            const struct vec3 b = mesh_vertex(m, 0, (i + 1) % 3);
            const struct vec3 c = mesh_vertex(m, 1, k);
            const struct vec3 d = mesh_vertex(m, 0, (i + 2) % 3);
            const struct vec3 off = vec3_minus(vec3_add(a, c), vec3_add(b, d));
            const double size = vec3_length(vec3_minus(b, d));
            const bool shared =
                vec3_length(vec3_minus(mesh_vertex(m, 1, (k + 1) % 3), d)) <=
                    1e-6 * size &&
                vec3_length(vec3_minus(mesh_vertex(m, 1, (k + 2) % 3), b)) <=
                    1e-6 * size;
            if (shared && vec3_length(off) <= 1e-6 * size) {
                shape->center = a;
                shape->u = vec3_minus(b, a);
                shape->v = vec3_minus(d, a);
                return true;
            }
        }
    return false;
}

/* Every interpolated normal is its triangle's own, so there is no need of it.
 */
static void flatten(struct mesh *m)
{
    for (size_t i = 0; m->normal && i < m->triangles; i++) {
        const struct vec3 n = mesh_cross(m, i);
        for (int k = 0; k < 3; k++) {
            const float *at = m->normal + 3 * m->index[3 * i + (size_t)k];
            const struct vec3 own = { at[0], at[1], at[2] };
            if (!(vec3_dot(n, own) >= (1 - 1e-9) * vec3_length(n)))
                return;
        }
    }
    free(m->normal);
    m->normal = NULL;
}

bool scene_add_mesh(struct scene *s, struct mesh *m,
                    const struct surface *surface, struct err *err)
{
    struct shape shape = { .kind = SHAPE_MESH, .mesh = m };
    const char *name = surface->name ? surface->name : "mesh";
    /* Embree reads 16 bytes for the last vertex. */
    float *padded = NULL;
    if (!mesh_check(m, name, err))
        goto fail;
    padded = realloc(m->xyz, (3 * m->vertices + 4) * sizeof *padded);
    if (!padded) {
        err_set(err, "%s: out of memory", name);
        goto fail;
    }
    m->xyz = padded;
    struct vec3 sum = { 0, 0, 0 };
    for (size_t i = 0; i < m->triangles; i++) {
        const struct vec3 n = mesh_cross(m, i);
        shape.area += vec3_length(n) / 2;
        sum = vec3_add(sum, n);
    }
    if (m->triangles <= 2)
        flatten(m);
    if (vec3_length(sum) > 0)
        shape.normal = vec3_unit(sum);
    if (rectangle_find(m, &shape))
        shape.flags |= SHAPE_RECTANGLE;
    if (!shape_add(s, &shape, surface, err))
        goto fail;
    if (s->shape[s->shapes - 1].flags & SHAPE_EMITS)
        glow_add(s, m);
    for (size_t i = 0; i < m->vertices; i++)
        box_add(s, (struct vec3){ m->xyz[3 * i], m->xyz[3 * i + 1],
                                  m->xyz[3 * i + 2] });
    return true;
fail:
    mesh_free(m);
    return false;
}

bool scene_add_rectangle(struct scene *s, struct vec3 corner, struct vec3 u,
                         struct vec3 v, const struct surface *surface,
                         struct err *err)
{
    struct mesh *m = mesh_new(4, 2, false, err);
    if (!m)
        return false;
    const struct vec3 p[] = { corner, vec3_add(corner, u),
                              vec3_add(corner, vec3_add(u, v)),
                              vec3_add(corner, v) };
    for (int i = 0; i < 4; i++) {
        m->xyz[3 * i] = (float)p[i].x;
        m->xyz[3 * i + 1] = (float)p[i].y;
        m->xyz[3 * i + 2] = (float)p[i].z;
    }
    static const unsigned index[] = { 0, 1, 2, 0, 2, 3 };
    memcpy(m->index, index, sizeof index);
    return scene_add_mesh(s, m, surface, err);
}

bool scene_add_sphere(struct scene *s, struct vec3 center, double radius,
                      bool flipped, const struct surface *surface,
                      struct err *err)
{
    struct shape shape = { .kind = SHAPE_SPHERE,
                           .flags = flipped ? SHAPE_FLIPPED : 0,
                           .center = center,
                           .radius = radius,
                           .area = 4 * PI * radius * radius };
    const char *name = surface->name ? surface->name : "sphere";
    if (!finite3(center) || !(radius > 0 && isfinite(radius)))
        return err_set(err,
                       "%s: center %g, %g, %g, radius %g: expected numbers, "
                       "and a radius above 0",
                       name, center.x, center.y, center.z, radius);
    if (!shape_add(s, &shape, surface, err))
        return false;
    const struct vec3 r = { radius, radius, radius };
    box_add(s, vec3_minus(center, r));
    box_add(s, vec3_add(center, r));
    return true;
}

bool scene_add_disk(struct scene *s, struct vec3 center, struct vec3 u,
                    struct vec3 v, const struct surface *surface,
                    struct err *err)
{
    const struct vec3 n = vec3_cross(u, v);
    const double r2 = vec3_dot(u, u), off = vec3_dot(v, v) - r2;
    const char *name = surface->name ? surface->name : "disk";
    if (!finite3(center) || !(r2 > 0 && isfinite(r2)) ||
        !(fabs(off) <= 1e-6 * r2 && fabs(vec3_dot(u, v)) <= 1e-6 * r2))
        return err_set(
            err, "%s: expected two radii of one length at right angles", name);
    struct shape shape = { .kind = SHAPE_DISK,
                           .center = center,
                           .u = u,
                           .v = v,
                           .normal = vec3_unit(n),
                           .area = PI * r2 };
    if (!shape_add(s, &shape, surface, err))
        return false;
    const struct vec3 half = { sqrt(u.x * u.x + v.x * v.x),
                               sqrt(u.y * u.y + v.y * v.y),
                               sqrt(u.z * u.z + v.z * v.z) };
    box_add(s, vec3_minus(center, half));
    box_add(s, vec3_add(center, half));
    return true;
}

bool scene_add_light(struct scene *s, const struct light *light,
                     struct err *err)
{
    static const char *const names[] = { "constant light", "hemisphere light",
                                         "point light", "environment",
                                         "area light" };
    const char *name = names[light->kind];
    const struct vec3 n = vec3_cross(light->u, light->v);
    const double area = vec3_length(n);
    if (!radiance_check(s, name, &light->radiance, err))
        return false;
    if (!finite3(light->position))
        return err_set(err, "%s: its position is not finite", name);
    if (light->kind == LIGHT_HIDDEN && !(area > 0 && isfinite(area)))
        return err_set(err, "%s: its area is %g", name, area);
    const bool hidden = light->kind == LIGHT_HIDDEN;
    return light_add(s, light, -1, area,
                     hidden ? vec3_unit(n) : (struct vec3){ 0, 0, 0 },
                     err) >= 0;
}

void scene_set_camera(struct scene *s, const struct camera *camera)
{
    s->camera = *camera;
    s->has_camera = true;
}

void scene_set_wishes(struct scene *s, const struct scene_wishes *wishes)
{
    s->wishes = *wishes;
}

const struct camera *scene_camera(const struct scene *s)
{
    return s->has_camera ? &s->camera : NULL;
}

struct scene_wishes scene_wishes(const struct scene *s)
{
    return s->wishes;
}

bool scene_box(const struct scene *s, struct vec3 *lo, struct vec3 *hi)
{
    *lo = s->lo;
    *hi = s->hi;
    return s->lo.x <= s->hi.x;
}

struct scene_size scene_size(const struct scene *s)
{
    struct scene_size size = { .shapes = s->shapes, .lights = s->lights };
    for (size_t i = 0; i < s->shapes; i++) {
        const struct mesh *m = s->shape[i].mesh;
        if (!m)
            continue;
        size.triangles += m->triangles;
        size.bytes += 3 * m->vertices * sizeof *m->xyz +
                      (m->normal ? 3 * m->vertices * sizeof *m->normal : 0) +
                      3 * m->triangles * sizeof *m->index;
    }
    size.bytes += (size_t)(s->bytes_embree > 0 ? s->bytes_embree : 0);
    return size;
}
