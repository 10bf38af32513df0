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
#include <string.h>

#include "integrator/scene_parts.h"

static const double hair = 0x1p-19;

struct context {
    struct RTCIntersectContext embree; /* comes first */
    const struct ray *ray;
    double distance; /* of the nearest sphere or disk so far */
};

/* -- spheres and disks ------------------------------------------------------
 */

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

static void intersect(const struct RTCIntersectFunctionNArguments *args)
{
    const struct shape *a = args->geometryUserPtr;
    struct context *c = (struct context *)args->context;
    struct RTCRayHit *rh = (struct RTCRayHit *)args->rayhit;
    if (args->N != 1 || !args->valid[0])
        return;
    const double far = fmin(c->distance, (double)rh->ray.tfar);
    const double t = distance_to(a, c->ray, far);
    if (!(t > 0))
        return;
    c->distance = t;
    rh->ray.tfar = (float)t;
    rh->hit.geomID = args->geomID;
    rh->hit.primID = 0;
    rh->hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

static void occluded(const struct RTCOccludedFunctionNArguments *args)
{
    const struct shape *a = args->geometryUserPtr;
    const struct context *c = (const struct context *)args->context;
    struct RTCRay *ray = (struct RTCRay *)args->ray;
    if (args->N != 1 || !args->valid[0])
        return;
    if (distance_to(a, c->ray, c->ray->far) > 0)
        ray->tfar = -INFINITY;
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

static double largest(struct vec3 v)
{
    return fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
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
        fmax(fmax(largest(s->lo), largest(s->hi)), largest(eye));
    if (!(reach < 1e15))
        return err_set(err,
                       "the scene reaches to %g: expected coordinates below "
                       "1e15",
                       reach);
    s->device = rtcNewDevice(NULL);
    if (!s->device)
        return err_set(err, "Embree: no device (error %d)",
                       (int)rtcGetDeviceError(NULL));
    rtcSetDeviceMemoryMonitorFunction(s->device, memory, s);
    s->embree = rtcNewScene(s->device);
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

static struct RTCRay embree_ray(const struct ray *r)
{
    return (struct RTCRay){
        .org_x = (float)r->origin.x,
        .org_y = (float)r->origin.y,
        .org_z = (float)r->origin.z,
        .dir_x = (float)r->dir.x,
        .dir_y = (float)r->dir.y,
        .dir_z = (float)r->dir.z,
        .tnear = (float)r->near,
        .tfar = r->far < FLT_MAX ? (float)r->far : INFINITY,
        .mask = -1u,
    };
}

/* The point by its shares of the corners, and the interpolated normal. */
static void on_triangle(const struct shape *a, size_t triangle, double u,
                        double v, struct hit *hit)
{
    const struct mesh *m = a->mesh;
    const struct vec3 p = mesh_vertex(m, triangle, 0);
    const struct vec3 e = vec3_minus(mesh_vertex(m, triangle, 1), p);
    const struct vec3 f = vec3_minus(mesh_vertex(m, triangle, 2), p);
    hit->point = vec3_add(p, vec3_add(vec3_scale(u, e), vec3_scale(v, f)));
    const struct vec3 n = vec3_cross(e, f);
    const double length = vec3_length(n);
    hit->normal =
        length > 0 ? vec3_scale(1 / length, n) : (struct vec3){ 0, 0, 1 };
    struct vec3 shading = hit->normal;
    if (m->normal) {
        const unsigned *at = m->index + 3 * triangle;
        const float *const corner[] = { m->normal + 3 * (size_t)at[0],
                                        m->normal + 3 * (size_t)at[1],
                                        m->normal + 3 * (size_t)at[2] };
        const double w = 1 - u - v;
        const struct vec3 mean = {
            w * corner[0][0] + u * corner[1][0] + v * corner[2][0],
            w * corner[0][1] + u * corner[1][1] + v * corner[2][1],
            w * corner[0][2] + u * corner[1][2] + v * corner[2][2],
        };
        const double size = vec3_length(mean);
        if (size > 0)
            shading = vec3_scale(1 / size, mean);
    }
    hit->shading = frame_about(shading);
}

static void on_sphere(const struct shape *a, const struct ray *ray, double t,
                      struct hit *hit)
{
    const struct vec3 at = vec3_add(ray->origin, vec3_scale(t, ray->dir));
    const struct vec3 n = vec3_unit(vec3_minus(at, a->center));
    hit->point = vec3_add(a->center, vec3_scale(a->radius, n));
    hit->normal = a->flags & SHAPE_FLIPPED ? vec3_scale(-1, n) : n;
    hit->shading = frame_about(hit->normal);
}

static void on_disk(const struct shape *a, const struct ray *ray, double t,
                    struct hit *hit)
{
    hit->point = vec3_add(ray->origin, vec3_scale(t, ray->dir));
    hit->normal = a->normal;
    const double length = vec3_length(a->u);
    hit->shading = (struct frame){ vec3_scale(1 / length, a->u),
                                   vec3_scale(1 / length, a->v), a->normal };
}

bool trace_hit(const struct scene *s, const struct ray *ray, struct hit *hit)
{
    struct context c = { .ray = ray, .distance = INFINITY };
    rtcInitIntersectContext(&c.embree);
    struct RTCRayHit rh = { .ray = embree_ray(ray) };
    rh.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(s->embree, &c.embree, &rh);
    if (rh.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    const struct shape *a = &s->shape[rh.hit.geomID];
    hit->distance = (double)rh.ray.tfar;
    if (a->kind == SHAPE_MESH)
        on_triangle(a, rh.hit.primID, (double)rh.hit.u, (double)rh.hit.v, hit);
    else if (a->kind == SHAPE_SPHERE)
        on_sphere(a, ray, hit->distance = c.distance, hit);
    else
        on_disk(a, ray, hit->distance = c.distance, hit);
    hit->hair = hair * a->reach;
    hit->bsdf = a->bsdf;
    hit->claims = &a->claims;
    hit->light = a->light;
    hit->emits = a->flags & SHAPE_EMITS &&
                 (a->surface.both_sides || vec3_dot(hit->normal, ray->dir) < 0);
    hit->surface = &a->surface;
    return true;
}

bool trace_blocked(const struct scene *s, const struct ray *ray)
{
    struct context c = { .ray = ray };
    rtcInitIntersectContext(&c.embree);
    struct RTCRay r = embree_ray(ray);
    rtcOccluded1(s->embree, &c.embree, &r);
    return r.tfar == -INFINITY;
}

struct ray trace_from(const struct hit *hit, struct vec3 dir)
{
    const double off = copysign(hit->hair, vec3_dot(dir, hit->normal));
    return (struct ray){ .origin =
                             vec3_add(hit->point, vec3_scale(off, hit->normal)),
                         .dir = dir,
                         .near = 0,
                         .far = INFINITY };
}

/* Aimed anew from where it starts: a tangent of a sphere that is moved by a
 * hair enters it much earlier. */
struct ray trace_to(const struct hit *hit, struct vec3 dir, struct vec3 point)
{
    struct ray r = trace_from(hit, dir);
    const struct vec3 to = vec3_minus(point, r.origin);
    const double d = vec3_length(to);
    const double last = hair * (largest(point) + 3 * d);
    if (d > 0)
        r.dir = vec3_scale(1 / d, to);
    r.far = fmax(0, d - last - hit->hair);
    return r;
}
