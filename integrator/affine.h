/* affine.h - where things stand in the world
 *
 * Points of the world are in double, in the scene's unit of length; what Embree
 * and meshes keep of them is in float.
 */
#ifndef INTEGRATOR_AFFINE_H
#define INTEGRATOR_AFFINE_H

#include <stdbool.h>

#include "bsdf/lanes.h"
#include "bsdf/vec.h"

/** p -> m p + t, row by row: the last column of each row is t. */
struct affine {
    double m[3][4];
};

extern const struct affine affine_identity;

/** First b, then a. */
struct affine affine_mul(struct affine a, struct affine b);

INLINE struct vec3 affine_vector(const struct affine *a, struct vec3 v)
{
    return (struct vec3){
        a->m[0][0] * v.x + a->m[0][1] * v.y + a->m[0][2] * v.z,
        a->m[1][0] * v.x + a->m[1][1] * v.y + a->m[1][2] * v.z,
        a->m[2][0] * v.x + a->m[2][1] * v.y + a->m[2][2] * v.z,
    };
}

INLINE struct vec3 affine_point(const struct affine *a, struct vec3 p)
{
    const struct vec3 t = { a->m[0][3], a->m[1][3], a->m[2][3] };
    return vec3_add(affine_vector(a, p), t);
}

/** The determinant of the linear part; negative where it mirrors. */
double affine_det(const struct affine *a);

/** Normals go by the inverse transposed of the linear part, here times its
 * determinant, which always exists; the length is not kept. */
struct vec3 affine_normal(const struct affine *a, struct vec3 n);

/** The inverse; false where the determinant is 0 or not finite. */
bool affine_inverse(const struct affine *a, struct affine *inverse);

struct affine affine_translate(struct vec3 t);
struct affine affine_scale(struct vec3 s);
struct affine affine_rotate(struct vec3 axis, double degrees); /* axis != 0 */

/** A camera's: at origin, z toward target, y as near to up as can be, x to the
 * left, as in Mitsuba 3's look_at; false where these do not span the space. */
bool affine_look_at(struct vec3 origin, struct vec3 target, struct vec3 up,
                    struct affine *out);

#endif
