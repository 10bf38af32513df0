/* camera.c - Gaussian optics: the lens is a disk, what is sharp a plane
 *
 * P. Shirley and K. Chiu, A Low Distortion Map Between Disk and Square, Journal
 * of Graphics Tools 2(3), 1997.
 */
#include "integrator/camera.h"

#include "integrator/disk.h"

struct ray camera_ray(const struct camera *c, double x, double y, double lens_u,
                      double lens_v)
{
    struct vec3 dir = { (0.5 * c->width - x) / c->focal,
                        (0.5 * c->height - y) / c->focal, 1 };
    struct vec3 origin = { 0, 0, 0 };
    if (c->lens_radius > 0) {
        const struct disk_point at = disk_map(lens_u, lens_v);
        origin.x = c->lens_radius * at.x;
        origin.y = c->lens_radius * at.y;
        dir = vec3_minus(vec3_scale(c->focal_distance, dir), origin);
        dir = vec3_scale(1 / dir.z, dir);
    }
    const double length = vec3_length(dir); /* of a z of 1 */
    return (struct ray){
        .origin = affine_point(&c->to_world, origin),
        .dir = vec3_unit(affine_vector(&c->to_world, dir)),
        .near = c->near * length,
        .far = c->far * length,
    };
}
