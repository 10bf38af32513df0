/* trace.c - Embree, and spheres and disks of our own
 *
 * Rays are kept in double beside Embree's in float, in the context that comes
 * along, so that what is intersected here loses nothing.
 *
 * Where rays start: a point of a triangle is good to about 2^-53 of its
 * coordinates, but to 2^-24 when Embree gets it, and its own intersection is
 * off by some 2^-24 of the mesh's coordinates.  2^-19 of the largest of the
 * mesh's leaves room for 32 of them; spheres and disks, intersected in double,
 * need room for other shapes' sake alone.
 */
#include "integrator/trace.h"

#include <float.h>
#include <math.h>
#include <stdalign.h>

#include "bsdf/fastmath.h"
#include "integrator/light.h"
#include "integrator/scene_parts.h"

static const double hair = 0x1p-19;

double trace_hair(double reach)
{
    return hair * reach;
}

struct context {
    struct RTCIntersectContext embree; /* comes first */
    const struct rays *rays;           /* by their numbers */
    double *distance; /* of the nearest sphere or disk so far, likewise */
};

/* -- spheres and disks ------------------------------------------------------
 */

static struct ray ray_at(const struct rays *r, size_t i)
{
    return (struct ray){ vecs_at(&r->origin, i), vecs_at(&r->dir, i),
                         r->near[i], r->far[i] };
}

/* The nearest of two crossings in (near, far), else a negative number.  The
 * smaller root by the quotient of the product, as their difference cancels. */
static double sphere_distance(const struct shape *a, const struct ray *ray,
                              double near, double far)
{
    const struct vec3 to = vec3_minus(a->center, ray->origin);
    const double along = vec3_dot(to, ray->dir);
    const struct vec3 off = vec3_minus(to, vec3_scale(along, ray->dir));
    const double half2 = a->radius * a->radius - vec3_dot(off, off);
    if (half2 < 0)
        return -1;
    const double half = sqrt(half2);
    const double power = vec3_dot(to, to) - a->radius * a->radius;
    const double large = along > 0 ? along + half : along - half;
    const double small = large != 0 ? power / large : 0;
    const double first = fmin(large, small), second = fmax(large, small);
    const double t = first > near ? first : second;
    return t > near && t < far ? t : -1;
}

static double disk_distance(const struct shape *a, const struct ray *ray,
                            double near, double far)
{
    const double slope = vec3_dot(ray->dir, a->normal);
    if (slope == 0)
        return -1;
    const struct vec3 to = vec3_minus(a->center, ray->origin);
    const double t = vec3_dot(to, a->normal) / slope;
    const struct vec3 at = vec3_minus(vec3_scale(t, ray->dir), to);
    const double r2 = vec3_dot(a->u, a->u);
    return t > near && t < far && vec3_dot(at, at) <= r2 ? t : -1;
}

static void bounds(const struct RTCBoundsFunctionArguments *args)
{
    const struct shape *a = args->geometryUserPtr;
    struct vec3 half = { a->radius, a->radius, a->radius };
    if (a->kind == SHAPE_DISK)
        half = (struct vec3){ hypot(a->u.x, a->v.x), hypot(a->u.y, a->v.y),
                              hypot(a->u.z, a->v.z) };
    /* Outward, by more than the rounding to float. */
    const double size = vec3_length(a->center) + vec3_length(half);
    const struct vec3 more = { size * 0x1p-20, size * 0x1p-20, size * 0x1p-20 };
    half = vec3_add(half, more);
    const struct vec3 lo = vec3_minus(a->center, half);
    const struct vec3 hi = vec3_add(a->center, half);
    struct RTCBounds *const out = args->bounds_o;
    out->lower_x = (float)lo.x, out->upper_x = (float)hi.x;
    out->lower_y = (float)lo.y, out->upper_y = (float)hi.y;
    out->lower_z = (float)lo.z, out->upper_z = (float)hi.z;
}

static double distance_to(const struct shape *a, const struct ray *ray,
                          double far)
{
    return a->kind == SHAPE_SPHERE ? sphere_distance(a, ray, ray->near, far)
                                   : disk_distance(a, ray, ray->near, far);
}

/* Where a packet of N has the numbers of a ray and of a hit, in Embree's own
 * order (rtcore_ray.h), which it tells in C++ alone. */
enum {
    RAY_TFAR = 8,
    RAY_ID = 10,
    RAY_SIZE = 12,
    HIT_TRIANGLE = RAY_SIZE + 5,
    HIT_SHAPE = RAY_SIZE + 6,
    HIT_INSTANCE = RAY_SIZE + 7
};

static void intersect(const struct RTCIntersectFunctionNArguments *args)
{
    const struct shape *a = args->geometryUserPtr;
    const struct context *c = (const struct context *)args->context;
    float *const packet = (float *)args->rayhit;
    unsigned *const numbers = (unsigned *)args->rayhit;
    for (unsigned i = 0; i < args->N; i++) {
        if (!args->valid[i])
            continue;
        const unsigned id = numbers[RAY_ID * args->N + i];
        const struct ray ray = ray_at(c->rays, id);
        float *const tfar = packet + RAY_TFAR * args->N + i;
        const double far = fmin(c->distance[id], (double)*tfar);
        const double t = distance_to(a, &ray, far);
        if (!(t > 0))
            continue;
        c->distance[id] = t;
        *tfar = (float)t;
        numbers[HIT_SHAPE * args->N + i] = args->geomID;
        numbers[HIT_TRIANGLE * args->N + i] = 0;
        numbers[HIT_INSTANCE * args->N + i] = RTC_INVALID_GEOMETRY_ID;
    }
}

static void occluded(const struct RTCOccludedFunctionNArguments *args)
{
    const struct shape *a = args->geometryUserPtr;
    const struct context *c = (const struct context *)args->context;
    const unsigned *const id = (unsigned *)args->ray + RAY_ID * args->N;
    float *const tfar = (float *)args->ray + RAY_TFAR * args->N;
    for (unsigned i = 0; i < args->N; i++) {
        if (!args->valid[i])
            continue;
        const struct ray ray = ray_at(c->rays, id[i]);
        if (distance_to(a, &ray, ray.far) > 0)
            tfar[i] = -INFINITY;
    }
}

/* -- building ---------------------------------------------------------------
 */

static bool memory(void *scene, ssize_t bytes, bool post)
{
    struct scene *s = scene;
    (void)post;
    __atomic_fetch_add(&s->bytes_embree, (int64_t)bytes, __ATOMIC_RELAXED);
    return true;
}

static void attach(struct scene *s, unsigned number)
{
    struct shape *a = &s->shape[number];
    const struct mesh *m = a->mesh;
    RTCGeometry g = rtcNewGeometry(s->device, m ? RTC_GEOMETRY_TYPE_TRIANGLE
                                                : RTC_GEOMETRY_TYPE_USER);
    if (m) {
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0,
                                   RTC_FORMAT_FLOAT3, m->xyz, 0,
                                   3 * sizeof *m->xyz, m->vertices);
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0,
                                   RTC_FORMAT_UINT3, m->index, 0,
                                   3 * sizeof *m->index, m->triangles);
    } else {
        rtcSetGeometryUserPrimitiveCount(g, 1);
        rtcSetGeometryUserData(g, a);
        rtcSetGeometryBoundsFunction(g, bounds, NULL);
        rtcSetGeometryIntersectFunction(g, intersect);
        rtcSetGeometryOccludedFunction(g, occluded);
    }
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(s->embree, g, number);
    rtcReleaseGeometry(g);
}

bool scene_commit(struct scene *s, struct err *err)
{
    if (s->shapes == 0)
        return err_set(err, "the scene has no shapes");
    if (!s->has_camera)
        return err_set(err, "the scene has no camera");
    const struct vec3 eye =
        affine_point(&s->camera.to_world, (struct vec3){ 0, 0, 0 });
    const double reach =
        fmax(fmax(vec3_largest(s->lo), vec3_largest(s->hi)), vec3_largest(eye));
    if (!(reach < 1e15))
        return err_set(err,
                       "the scene reaches to %g: expected coordinates below "
                       "1e15",
                       reach);
    const double room = 0x1p-18 * reach;
    s->glow_lo = vec3_minus(s->glow_lo, (struct vec3){ room, room, room });
    s->glow_hi = vec3_add(s->glow_hi, (struct vec3){ room, room, room });
    s->device = rtcNewDevice(NULL);
    if (!s->device)
        return err_set(err, "Embree: no device (error %d)",
                       (int)rtcGetDeviceError(NULL));
    rtcSetDeviceMemoryMonitorFunction(s->device, memory, s);
    s->embree = rtcNewScene(s->device);
    if (s->wishes.robust)
        rtcSetSceneFlags(s->embree, RTC_SCENE_FLAG_ROBUST);
    for (size_t i = 0; i < s->shapes; i++)
        attach(s, (unsigned)i);
    rtcCommitScene(s->embree);
    const enum RTCError failed = rtcGetDeviceError(s->device);
    return failed == RTC_ERROR_NONE ||
           err_set(err, "Embree: error %d while building its tree",
                   (int)failed);
}

/* -- tracing ----------------------------------------------------------------
 */

INLINE float to_float(double x)
{
    return x < (double)FLT_MAX ? (float)x : INFINITY;
}

/* The rays of a queue from one on, as many as fit. */
LANES static void fill(const struct rays *r, const struct queue *queue,
                       size_t from, size_t n, int *valid, struct RTCRay16 *out)
{
    const uint16_t *const at = queue->ray + from;
    LANES_LOOP
    for (size_t i = 0; i < PACKET; i++) {
        const size_t k = at[i < n ? i : 0];
        valid[i] = i < n ? -1 : 0;
        out->org_x[i] = (float)r->origin.x[k];
        out->org_y[i] = (float)r->origin.y[k];
        out->org_z[i] = (float)r->origin.z[k];
        out->tnear[i] = (float)r->near[k];
        out->dir_x[i] = (float)r->dir.x[k];
        out->dir_y[i] = (float)r->dir.y[k];
        out->dir_z[i] = (float)r->dir.z[k];
        out->time[i] = 0;
        out->tfar[i] = to_float(r->far[k]);
        out->mask[i] = -1u;
        out->id[i] = (unsigned)k;
        out->flags[i] = 0;
    }
}

/* How many of a queue, from one on, make a packet. */
static size_t packet(const struct queue *queue, size_t from)
{
    size_t n = 1;
    while (n < PACKET && from + n < queue->n &&
           queue->piece[from + n] == queue->piece[from])
        n++;
    return n;
}

void trace_rays(const struct scene *s, const struct rays *rays,
                const struct queue *queue, bool together, struct met *met)
{
    alignas(64) int valid[PACKET];
    struct RTCRayHit16 rh;
    struct context c = { .rays = rays, .distance = met->distance };
    rtcInitIntersectContext(&c.embree);
    if (together)
        c.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (size_t i = 0; i < queue->n; i++)
        met->distance[queue->ray[i]] = INFINITY;
    for (size_t at = 0, n; at < queue->n; at += n) {
        n = packet(queue, at);
        fill(rays, queue, at, n, valid, &rh.ray);
        for (int i = 0; i < PACKET; i++)
            rh.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect16(valid, s->embree, &c.embree, &rh);
        for (size_t i = 0; i < n; i++) {
            const size_t k = queue->ray[at + i];
            const unsigned number = rh.hit.geomID[i];
            met->shape[k] = NULL;
            if (number == RTC_INVALID_GEOMETRY_ID)
                continue;
            met->shape[k] = &s->shape[number];
            met->triangle[k] = rh.hit.primID[i];
            met->u[k] = (double)rh.hit.u[i];
            met->v[k] = (double)rh.hit.v[i];
            if (met->shape[k]->kind == SHAPE_MESH)
                met->distance[k] = (double)rh.ray.tfar[i];
        }
    }
}

void trace_blocked(const struct scene *s, const struct rays *rays,
                   const struct queue *queue, bool *blocked)
{
    alignas(64) int valid[PACKET];
    struct RTCRay16 r;
    struct context c = { .rays = rays };
    rtcInitIntersectContext(&c.embree);
    for (size_t at = 0, n; at < queue->n; at += n) {
        n = packet(queue, at);
        fill(rays, queue, at, n, valid, &r);
        rtcOccluded16(valid, s->embree, &c.embree, &r);
        for (size_t i = 0; i < n; i++)
            blocked[queue->ray[at + i]] = r.tfar[i] == -INFINITY;
    }
}

/* Rows of slabs: T. Kay and J. Kajiya, Ray Tracing Complex Scenes, SIGGRAPH
 * 1986.  What is parallel to a side and in its plane may go either way, as what
 * emits is well inside. */
INLINE void slab(double lo, double hi, double origin, double dir, double *enter,
                 double *leave)
{
    const double scale = 1 / dir;
    const double a = (lo - origin) * scale, b = (hi - origin) * scale;
    *enter = fm_max(fm_min(a, b), *enter);
    *leave = fm_min(fm_max(a, b), *leave);
}

LANES static void through(struct vec3 lo, struct vec3 hi, const struct rays *r,
                          size_t n, bool *hit)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        double enter = 0, leave = INFINITY;
        slab(lo.x, hi.x, r->origin.x[i], r->dir.x[i], &enter, &leave);
        slab(lo.y, hi.y, r->origin.y[i], r->dir.y[i], &enter, &leave);
        slab(lo.z, hi.z, r->origin.z[i], r->dir.z[i], &enter, &leave);
        hit[i] = enter <= leave;
    }
}

void trace_toward_light(const struct scene *s, const struct rays *rays,
                        size_t n, bool *toward)
{
    bool endless = false;
    for (int i = 0; i < (int)s->lights; i++)
        endless |= light_is_infinite(s, i);
    for (size_t i = 0; i < n; i++)
        toward[i] = endless;
    if (!endless && s->glow_lo.x <= s->glow_hi.x)
        through(s->glow_lo, s->glow_hi, rays, n, toward);
}

/* -- places -----------------------------------------------------------------
 */

/* Triangles: a corner, the edges from it, and the shares of those. */
struct corners {
    struct vecs p, e, f;
    double u[WAVE], v[WAVE];
};

static void corners_at(const struct met *met, size_t ray, size_t i,
                       struct corners *c)
{
    const struct mesh *m = met->shape[ray]->mesh;
    struct vec3 p = { 0, 0, 0 }, q = p, r = p;
    if (m) {
        const size_t triangle = met->triangle[ray];
        p = mesh_vertex(m, triangle, 0);
        q = mesh_vertex(m, triangle, 1);
        r = mesh_vertex(m, triangle, 2);
    }
    vecs_put(&c->p, i, p);
    vecs_put(&c->e, i, q);
    vecs_put(&c->f, i, r);
    c->u[i] = met->u[ray];
    c->v[i] = met->v[ray];
}

INLINE void frame_put(struct hits *h, size_t i, struct frame f)
{
    vecs_put(&h->s, i, f.s);
    vecs_put(&h->t, i, f.t);
    vecs_put(&h->n, i, f.n);
}

/* Points by their shares of the corners. */
LANES static void on_triangles(struct corners *c, size_t n, struct hits *h)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct vec3 p = vecs_at(&c->p, i);
        const struct vec3 e = vec3_minus(vecs_at(&c->e, i), p);
        const struct vec3 f = vec3_minus(vecs_at(&c->f, i), p);
        const struct vec3 cross = vec3_cross(e, f);
        const double length = vec3_length(cross);
        const bool flat = length > 0;
        const double scale = flat ? 1 / length : 0;
        struct vec3 normal = vec3_scale(scale, cross);
        normal.z = flat ? normal.z : 1;
        vecs_put(&h->point, i,
                 vec3_add(p, vec3_add(vec3_scale(c->u[i], e),
                                      vec3_scale(c->v[i], f))));
        vecs_put(&h->normal, i, normal);
        frame_put(h, i, frame_about(normal));
    }
}

/* About the interpolated normal. */
static void smooth(const struct mesh *m, const struct met *met, size_t ray,
                   size_t i, struct hits *h)
{
    const unsigned *at = m->index + 3 * (size_t)met->triangle[ray];
    const float *const corner[] = { m->normal + 3 * (size_t)at[0],
                                    m->normal + 3 * (size_t)at[1],
                                    m->normal + 3 * (size_t)at[2] };
    const double u = met->u[ray], v = met->v[ray], w = 1 - u - v;
    const struct vec3 mean = {
        w * corner[0][0] + u * corner[1][0] + v * corner[2][0],
        w * corner[0][1] + u * corner[1][1] + v * corner[2][1],
        w * corner[0][2] + u * corner[1][2] + v * corner[2][2],
    };
    const double size = vec3_length(mean);
    if (size > 0)
        frame_put(h, i, frame_about(vec3_scale(1 / size, mean)));
}

static void on_sphere(const struct shape *a, const struct rays *rays,
                      size_t ray, double t, size_t i, struct hits *h)
{
    const struct vec3 at = vec3_add(vecs_at(&rays->origin, ray),
                                    vec3_scale(t, vecs_at(&rays->dir, ray)));
    const struct vec3 n = vec3_unit(vec3_minus(at, a->center));
    const struct vec3 normal = a->flags & SHAPE_FLIPPED ? vec3_scale(-1, n) : n;
    vecs_put(&h->point, i, vec3_add(a->center, vec3_scale(a->radius, n)));
    vecs_put(&h->normal, i, normal);
    frame_put(h, i, frame_about(normal));
}

static void on_disk(const struct shape *a, const struct rays *rays, size_t ray,
                    double t, size_t i, struct hits *h)
{
    const double length = vec3_length(a->u);
    vecs_put(&h->point, i,
             vec3_add(vecs_at(&rays->origin, ray),
                      vec3_scale(t, vecs_at(&rays->dir, ray))));
    vecs_put(&h->normal, i, a->normal);
    frame_put(h, i,
              (struct frame){ vec3_scale(1 / length, a->u),
                              vec3_scale(1 / length, a->v), a->normal });
}

void trace_places(const struct rays *rays, const struct met *met,
                  const uint16_t *ray, size_t n, struct hits *h)
{
    struct corners c;
    uint16_t more[WAVE]; /* those of which triangles are not all */
    size_t mores = 0;
    for (size_t i = 0; i < n; i++) {
        const struct shape *a = h->shape[i] = met->shape[ray[i]];
        h->hair[i] = trace_hair(a->reach);
        h->emits[i] = false;
        corners_at(met, ray[i], i, &c);
        more[mores] = (uint16_t)i;
        mores +=
            a->kind != SHAPE_MESH || a->mesh->normal || a->flags & SHAPE_EMITS;
    }
    on_triangles(&c, n, h);
    for (size_t j = 0; j < mores; j++) {
        const size_t i = more[j], k = ray[i];
        const struct shape *a = h->shape[i];
        if (a->kind == SHAPE_SPHERE)
            on_sphere(a, rays, k, met->distance[k], i, h);
        else if (a->kind == SHAPE_DISK)
            on_disk(a, rays, k, met->distance[k], i, h);
        else if (a->mesh->normal)
            smooth(a->mesh, met, k, i, h);
        h->emits[i] =
            a->flags & SHAPE_EMITS &&
            (a->surface.both_sides ||
             vec3_dot(vecs_at(&h->normal, i), vecs_at(&rays->dir, k)) < 0);
    }
}

/* -- rays from places -------------------------------------------------------
 */

INLINE struct vec3 start(const struct hits *h, size_t i, struct vec3 dir)
{
    const struct vec3 normal = vecs_at(&h->normal, i);
    const double off = copysign(h->hair[i], vec3_dot(dir, normal));
    return vec3_add(vecs_at(&h->point, i), vec3_scale(off, normal));
}

LANES void trace_from(const struct hits *h, size_t n, const struct vecs *dir,
                      struct rays *rays)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct vec3 d = vecs_at(dir, i);
        vecs_put(&rays->origin, i, start(h, i, d));
        vecs_put(&rays->dir, i, d);
        rays->near[i] = 0;
        rays->far[i] = INFINITY;
    }
}

/* Aimed anew from where it starts: a tangent of a sphere that is moved by a
 * hair enters it much earlier. */
LANES void trace_to(const struct hits *h, size_t n, const struct vecs *dir,
                    const struct vecs *point, struct rays *rays)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct vec3 d = vecs_at(dir, i), p = vecs_at(point, i);
        const struct vec3 origin = start(h, i, d);
        const struct vec3 to = vec3_minus(p, origin);
        const double length = vec3_length(to);
        const double reach = fm_max(fabs(p.x), fm_max(fabs(p.y), fabs(p.z)));
        const double last = hair * (reach + 3 * length);
        const double scale = length > 0 ? 1 / length : 0;
        const struct vec3 aimed = vec3_scale(scale, to);
        vecs_put(&rays->origin, i, origin);
        rays->dir.x[i] = length > 0 ? aimed.x : d.x;
        rays->dir.y[i] = length > 0 ? aimed.y : d.y;
        rays->dir.z[i] = length > 0 ? aimed.z : d.z;
        rays->near[i] = 0;
        rays->far[i] = fm_max(0, length - last - h->hair[i]);
    }
}
