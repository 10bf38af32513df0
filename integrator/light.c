/* light.c - where lights are sampled, and how densely
 *
 *   by area        pdf = d^2 / (A |cos|), with the angle at the light
 *   by a cone      pdf = 1 / (2 pi (1 - cos_max)), sin_max = r / d: what a
 *                  sphere fills, seen from outside
 *   by direction   pdf = 1 / 4 pi, or 1 / 2 pi of a hemisphere
 *
 * P. Shirley, C. Wang and K. Zimmerman, Monte Carlo Techniques for Direct
 * Lighting Calculations, ACM Transactions on Graphics 15(1), 1996.
 */
#include "integrator/light.h"

#include <math.h>

#include "integrator/compat.h"
#include "integrator/disk.h"
#include "integrator/environment.h"
#include "integrator/scene_parts.h"

int light_count(const struct scene *s)
{
    return (int)s->lights;
}

/* The triangle that a share of the area falls into, and the share of it. */
static size_t triangle_at(const struct shape *a, double *u)
{
    const double *sum = a->cumulated;
    size_t low = 0, high = a->mesh->triangles - 1;
    const double at = *u * sum[high];
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (sum[middle] > at)
            high = middle;
        else
            low = middle + 1;
    }
    const double before = low > 0 ? sum[low - 1] : 0;
    const double size = sum[low] - before;
    *u = size > 0 ? fmin((at - before) / size, 0x1.fffffffffffffp-1) : 0;
    return low;
}

/* One of struct light_samples. */
struct light_sample {
    struct vec3 wi, point;
    double pdf;
    struct spectrum radiance;
};

/* A point of a rectangle is its corner and shares of its sides. */
INLINE struct vec3 on_rectangle(struct vec3 corner, struct vec3 u,
                                struct vec3 v, double a, double b)
{
    return vec3_add(corner, vec3_add(vec3_scale(a, u), vec3_scale(b, v)));
}

/* Uniform over the area. */
static struct light_hit on_shape(const struct shape *a, double u, double v)
{
    if (a->kind == SHAPE_MESH) {
        const size_t i = triangle_at(a, &u);
        const struct vec3 p = mesh_vertex(a->mesh, i, 0);
        const struct vec3 e = vec3_minus(mesh_vertex(a->mesh, i, 1), p);
        const struct vec3 f = vec3_minus(mesh_vertex(a->mesh, i, 2), p);
        const double root = sqrt(u);
        return (
            struct light_hit){ on_rectangle(p, e, f, root * (1 - v), root * v),
                               vec3_unit(vec3_cross(e, f)) };
    }
    if (a->kind == SHAPE_DISK) {
        const struct disk_point d = disk_map(u, v);
        return (struct light_hit){
            on_rectangle(a->center, a->u, a->v, d.x, d.y), a->normal
        };
    }
    const double z = 1 - 2 * u, r = sqrt(fmax(0, 1 - z * z));
    const struct vec3 n = { r * cos(2 * PI * v), r * sin(2 * PI * v), z };
    return (struct light_hit){ vec3_add(a->center, vec3_scale(a->radius, n)),
                               a->flags & SHAPE_FLIPPED ? vec3_scale(-1, n)
                                                        : n };
}

/* 1 - cos of the half angle of the cone that is sampled; 0 where the area is:
 * from inside, from points that rounding may have put on either side of the
 * sphere, and of one that emits inward alone, which is seen from inside only.
 */
static double cone(const struct shape *a, struct vec3 from)
{
    const struct vec3 to = vec3_minus(a->center, from);
    const double sine2 = a->radius * a->radius / vec3_dot(to, to);
    const double room = 0x1p-30 + 0x1p-40 * a->reach / a->radius;
    const bool inward = a->flags & SHAPE_FLIPPED && !a->surface.both_sides;
    return sine2 < 1 - room && !inward ? sine2 / (1 + sqrt(1 - sine2)) : 0;
}

static struct light_sample in_cone(const struct shape *a, struct vec3 from,
                                   double versine, double u, double v)
{
    const struct vec3 to = vec3_minus(a->center, from);
    const double d = vec3_length(to);
    const struct frame frame = frame_about(vec3_scale(1 / d, to));
    const double down = versine * u; /* 1 - cos */
    const double sine2 = down * (2 - down), sine = sqrt(sine2);
    const struct vec3 local = { sine * cos(2 * PI * v), sine * sin(2 * PI * v),
                                1 - down };
    const double half2 = a->radius * a->radius - d * d * sine2;
    const struct vec3 wi = frame_to_world(&frame, local);
    const double far = d * local.z - sqrt(fmax(0, half2));
    return (struct light_sample){
        .wi = wi,
        .point = vec3_add(from, vec3_scale(far, wi)),
        .pdf = 1 / (2 * PI * versine),
    };
}

/* Toward a point of an area; none where the light does not emit that way. */
INLINE struct light_sample toward(struct light_hit at, double area,
                                  bool both_sides, struct vec3 from,
                                  bool by_distance)
{
    const struct vec3 to = vec3_minus(at.point, from);
    const double d2 = vec3_dot(to, to), d = sqrt(d2);
    const double along = -vec3_dot(to, at.normal); /* d times the cosine */
    const double seen = both_sides ? fabs(along) : along;
    const bool there = seen > 0; /* then d > 0 as well */
    const double scale = there ? 1 / d : 0;
    const double pdf = (by_distance ? d2 : d * d2) / (area * seen);
    return (struct light_sample){
        .wi = { scale * to.x, scale * to.y, there ? scale * to.z : 1 },
        .point = at.point,
        .pdf = there ? pdf : 0,
    };
}

/* A rectangle's, for many. */
struct rectangle {
    struct vec3 corner, u, v, normal;
    double area;
    bool both_sides, by_distance;
};

LANES static void toward_rectangle(const struct rectangle *rectangle, size_t n,
                                   const struct vecs *from,
                                   const struct vecs *u,
                                   struct light_samples *out)
{
    const struct rectangle r = *rectangle;
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct light_hit at = {
            on_rectangle(r.corner, r.u, r.v, u->x[i], u->y[i]), r.normal
        };
        const struct light_sample l =
            toward(at, r.area, r.both_sides, vecs_at(from, i), r.by_distance);
        vecs_put(&out->wi, i, l.wi);
        vecs_put(&out->point, i, l.point);
        out->pdf[i] = l.pdf;
    }
}

static struct light_sample of_shape(const struct shape *a, struct vec3 from,
                                    double u, double v)
{
    const bool both = a->surface.both_sides;
    struct light_sample out;
    const double versine = a->kind == SHAPE_SPHERE ? cone(a, from) : 0;
    if (versine > 0)
        out = in_cone(a, from, versine, u, v);
    else
        out = toward(on_shape(a, u, v), a->area, both, from, false);
    out.radiance = a->surface.radiance;
    return out;
}

static struct light_sample by_direction(const struct light *light, double u,
                                        double v)
{
    const bool half = light->kind == LIGHT_HEMISPHERE;
    const double y = half ? 1 - u : 1 - 2 * u;
    const double r = sqrt(fmax(0, 1 - y * y));
    return (struct light_sample){
        .wi = { r * sin(2 * PI * v), y, r * cos(2 * PI * v) },
        .pdf = half ? 1 / (2 * PI) : 1 / (4 * PI),
        .radiance = light->radiance,
    };
}

static struct light_sample by_picture(const struct environment *e, double u,
                                      double v)
{
    struct light_sample out = { .pdf = 0 };
    out.wi = environment_sample(e, u, v, &out.pdf);
    out.radiance = environment_radiance(e, out.wi);
    return out;
}

static struct light_sample of_point(const struct light *light, struct vec3 from)
{
    const struct vec3 to = vec3_minus(light->position, from);
    const double d = vec3_length(to);
    if (!(d > 0))
        return (struct light_sample){ .wi = { 0, 0, 1 } };
    return (struct light_sample){
        .wi = vec3_scale(1 / d, to),
        .point = light->position,
        .pdf = 1,
        .radiance = spectrum_scale(1 / (d * d), light->radiance),
    };
}

static struct light_sample one(const struct scene *s,
                               const struct light_source *source,
                               struct vec3 from, double u, double v)
{
    const struct light *l = &source->light;
    if (source->shape >= 0)
        return of_shape(&s->shape[source->shape], from, u, v);
    if (l->kind == LIGHT_POINT)
        return of_point(l, from);
    if (l->kind == LIGHT_ENVIRONMENT)
        return by_picture(l->environment, u, v);
    return by_direction(l, u, v);
}

/* Whether a light is a rectangle, and which. */
static bool rectangle_of(const struct scene *s,
                         const struct light_source *source, unsigned compat,
                         struct rectangle *out)
{
    const struct light *l = &source->light;
    const struct shape *a =
        source->shape >= 0 ? &s->shape[source->shape] : NULL;
    const bool by_distance = compat & COMPAT_LIGHT_PDF;
    if (a && a->flags & SHAPE_RECTANGLE)
        *out = (struct rectangle){ a->center,  a->u,    a->v,
                                   a->normal,  a->area, a->surface.both_sides,
                                   by_distance };
    else if (!a && l->kind == LIGHT_HIDDEN)
        *out =
            (struct rectangle){ l->position,  l->u,  l->v,       source->normal,
                                source->area, false, by_distance };
    else
        return false;
    return true;
}

void light_sample(const struct scene *s, int light, size_t n,
                  const struct vecs *from, const struct vecs *u,
                  unsigned compat, struct light_samples *out)
{
    const struct light_source *source = &s->light[light];
    struct rectangle r;
    if (rectangle_of(s, source, compat, &r)) {
        toward_rectangle(&r, n, from, u, out);
        for (size_t i = 0; i < n; i++)
            out->radiance[i] = source->light.radiance;
        return;
    }
    for (size_t i = 0; i < n; i++) {
        const struct light_sample l =
            one(s, source, vecs_at(from, i), u->x[i], u->y[i]);
        vecs_put(&out->wi, i, l.wi);
        vecs_put(&out->point, i, l.point);
        out->pdf[i] = l.pdf;
        out->radiance[i] = l.radiance;
    }
}

/* 0 of what is no background. */
static double background_pdf(const struct light *light, struct vec3 dir)
{
    switch (light->kind) {
    case LIGHT_CONSTANT:
        return 1 / (4 * PI);
    case LIGHT_HEMISPHERE:
        return dir.y > 0 ? 1 / (2 * PI) : 0;
    case LIGHT_ENVIRONMENT:
        return environment_pdf(light->environment, dir);
    default:
        return 0;
    }
}

double light_pdf(const struct scene *s, int light, struct vec3 from,
                 struct vec3 dir, const struct light_hit *hit)
{
    const struct light_source *source = &s->light[light];
    if (source->shape < 0)
        return background_pdf(&source->light, dir);
    const struct shape *a = &s->shape[source->shape];
    const double versine = a->kind == SHAPE_SPHERE ? cone(a, from) : 0;
    if (versine > 0)
        return 1 / (2 * PI * versine);
    const struct vec3 to = vec3_minus(hit->point, from);
    const double d2 = vec3_dot(to, to);
    const double along = fabs(vec3_dot(to, hit->normal));
    return along > 0 ? d2 * sqrt(d2) / (a->area * along) : 0;
}

struct spectrum light_background(const struct scene *s, int light,
                                 struct vec3 dir)
{
    const struct light_source *source = &s->light[light];
    const struct light *l = &source->light;
    if (source->shape < 0 && l->kind == LIGHT_ENVIRONMENT)
        return environment_radiance(l->environment, dir);
    const bool seen = source->shape < 0 && background_pdf(l, dir) > 0;
    return seen ? l->radiance : (struct spectrum){ { 0 } };
}

bool light_can_be_hit(const struct scene *s, int light)
{
    const struct light_source *source = &s->light[light];
    return source->shape >= 0 || (source->light.kind != LIGHT_POINT &&
                                  source->light.kind != LIGHT_HIDDEN);
}

bool light_is_point(const struct scene *s, int light)
{
    const struct light_source *source = &s->light[light];
    return source->shape < 0 && source->light.kind == LIGHT_POINT;
}

bool light_is_infinite(const struct scene *s, int light)
{
    const struct light_source *source = &s->light[light];
    return source->shape < 0 && source->light.kind != LIGHT_POINT &&
           source->light.kind != LIGHT_HIDDEN;
}
