/* camera.c - Gaussian optics: the lens is a disk, what is sharp a plane
 *
 * P. Shirley and K. Chiu, A Low Distortion Map Between Disk and Square, Journal
 * of Graphics Tools 2(3), 1997.
 */
#include "integrator/camera.h"

#include "integrator/disk.h"

/* Where on the lens, in the camera's frame. */
static struct vec3 on_lens(const struct camera *c, double u, double v)
{
    if (!(c->lens_radius > 0))
        return (struct vec3){ 0, 0, 0 };
    const struct disk_point at = disk_map(u, v);
    return (struct vec3){ c->lens_radius * at.x, c->lens_radius * at.y, 0 };
}

/* The ray that leaves the camera's z = 0 at a point and sees what a pinhole
 * there would see at (x, y) where it is sharp. */
INLINE struct ray through(const struct camera *c, double x, double y,
                          struct vec3 origin)
{
    const double sharp = c->lens_radius > 0 ? c->focal_distance : 1;
    const struct vec3 to = { sharp * ((0.5 * c->width - x) / c->focal),
                             sharp * ((0.5 * c->height - y) / c->focal),
                             sharp };
    const struct vec3 dir = vec3_scale(1 / sharp, vec3_minus(to, origin));
    const double length = vec3_length(dir); /* of a z of 1 */
    const struct vec3 w = affine_vector(&c->to_world, dir);
    return (struct ray){
        .origin = affine_point(&c->to_world, origin),
        .dir = vec3_unit(w),
        .near = c->near * length,
        .far = c->far * length,
    };
}

struct ray camera_ray(const struct camera *c, double x, double y, double lens_u,
                      double lens_v)
{
    return through(c, x, y, on_lens(c, lens_u, lens_v));
}

LANES static void all_through(const struct camera *camera, size_t n,
                              const double *x, const double *y,
                              const struct vecs *origin, struct rays *out)
{
    const struct camera c = *camera;
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct ray r = through(&c, x[i], y[i], vecs_at(origin, i));
        vecs_put(&out->origin, i, r.origin);
        vecs_put(&out->dir, i, r.dir);
        out->near[i] = r.near;
        out->far[i] = r.far;
    }
}

void camera_rays(const struct camera *c, size_t n, const double *x,
                 const double *y, const double *lens_u, const double *lens_v,
                 struct rays *out)
{
    struct vecs origin;
    for (size_t i = 0; i < n; i++)
        vecs_put(&origin, i, on_lens(c, lens_u[i], lens_v[i]));
    all_through(c, n, x, y, &origin, out);
}
