/* frame.h - an orthonormal frame about a unit vector
 *
 * T. Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017.
 */
#ifndef BSDF_FRAME_H
#define BSDF_FRAME_H

#include "bsdf/vec.h"

/** Right-handed: s x t = n. */
struct frame {
    struct vec3 s, t, n;
};

static inline struct frame frame_about(struct vec3 n)
{
    const double sign = copysign(1, n.z);
    const double a = -1 / (sign + n.z), b = n.x * n.y * a;
    return (struct frame){
        { 1 + sign * n.x * n.x * a, sign * b, -sign * n.x },
        { b, sign + n.y * n.y * a, -n.y },
        n,
    };
}

static inline struct vec3 frame_to_local(const struct frame *f, struct vec3 w)
{
    return (struct vec3){ vec3_dot(w, f->s), vec3_dot(w, f->t),
                          vec3_dot(w, f->n) };
}

static inline struct vec3 frame_to_world(const struct frame *f, struct vec3 w)
{
    return vec3_add(vec3_scale(w.x, f->s),
                    vec3_add(vec3_scale(w.y, f->t), vec3_scale(w.z, f->n)));
}

#endif
