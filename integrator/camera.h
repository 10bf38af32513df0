/* camera.h - a thin lens, or a pinhole
 *
 * Pixel (0, 0) is the upper left one; a point of the picture is (x, y) in
 * pixels from its upper left corner.
 */
#ifndef INTEGRATOR_CAMERA_H
#define INTEGRATOR_CAMERA_H

#include "integrator/affine.h"
#include "integrator/wave.h"

struct camera {
    struct affine to_world; /* x to the left, y up, z into the scene; of unit
                               columns */
    int width, height;      /* of the picture [pixels] */
    double focal;           /* distance at which a pixel is 1 x 1 [pixels] */
    double near, far;       /* along z; what is outside is not seen */
    double lens_radius;     /* 0 for a pinhole */
    double focal_distance;  /* along z, of what is sharp; for a lens */
};

struct ray {
    struct vec3 origin, dir; /* unit */
    double near, far;        /* distances along dir */
};

/** The ray through a point of the picture and, for a lens, the point of it that
 * two numbers in [0, 1) choose (uniformly, by Shirley and Chiu's map). */
struct ray camera_ray(const struct camera *c, double x, double y, double lens_u,
                      double lens_v);

/** The same of n points, at most WAVE. */
void camera_rays(const struct camera *c, size_t n, const double *x,
                 const double *y, const double *lens_u, const double *lens_v,
                 struct rays *out);

#endif
