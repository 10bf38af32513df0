/* affine.c - where things stand in the world
 *
 * Rotation about an axis: O. Rodrigues, Des lois geometriques qui regissent les
 * deplacements d'un systeme solide, Journal de Mathematiques 5, 1840.
 */
#include "integrator/affine.h"

const struct affine affine_identity = {
    { { 1, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, 1, 0 } }
};

/* The columns of the linear part and the translation. */
static struct affine columns(struct vec3 x, struct vec3 y, struct vec3 z,
                             struct vec3 t)
{
    return (struct affine){ { { x.x, y.x, z.x, t.x },
                              { x.y, y.y, z.y, t.y },
                              { x.z, y.z, z.z, t.z } } };
}

static struct vec3 column(const struct affine *a, int k)
{
    return (struct vec3){ a->m[0][k], a->m[1][k], a->m[2][k] };
}

struct affine affine_mul(struct affine a, struct affine b)
{
    return columns(
        affine_vector(&a, column(&b, 0)), affine_vector(&a, column(&b, 1)),
        affine_vector(&a, column(&b, 2)), affine_point(&a, column(&b, 3)));
}

double affine_det(const struct affine *a)
{
    return vec3_dot(vec3_cross(column(a, 0), column(a, 1)), column(a, 2));
}

/* The matrix of cofactors, whose columns are these products. */
struct vec3 affine_normal(const struct affine *a, struct vec3 n)
{
    const struct vec3 x = column(a, 0), y = column(a, 1), z = column(a, 2);
    return vec3_add(vec3_scale(n.x, vec3_cross(y, z)),
                    vec3_add(vec3_scale(n.y, vec3_cross(z, x)),
                             vec3_scale(n.z, vec3_cross(x, y))));
}

bool affine_inverse(const struct affine *a, struct affine *inverse)
{
    const double det = affine_det(a);
    const struct vec3 x = column(a, 0), y = column(a, 1), z = column(a, 2);
    const struct vec3 row[] = { vec3_cross(y, z), vec3_cross(z, x),
                                vec3_cross(x, y) };
    if (det == 0 || !isfinite(det) || !isfinite(1 / det))
        return false;
    struct affine made;
    for (int i = 0; i < 3; i++) {
        const struct vec3 r = vec3_scale(1 / det, row[i]);
        const double line[] = { r.x, r.y, r.z, -vec3_dot(r, column(a, 3)) };
        for (int k = 0; k < 4; k++)
            made.m[i][k] = line[k];
    }
    *inverse = made;
    return true;
}

struct affine affine_translate(struct vec3 t)
{
    struct affine a = affine_identity;
    a.m[0][3] = t.x, a.m[1][3] = t.y, a.m[2][3] = t.z;
    return a;
}

struct affine affine_scale(struct vec3 s)
{
    struct affine a = affine_identity;
    a.m[0][0] = s.x, a.m[1][1] = s.y, a.m[2][2] = s.z;
    return a;
}

struct affine affine_rotate(struct vec3 axis, double degrees)
{
    const struct vec3 k = vec3_unit(axis);
    /* Quarter turns are exact. */
    const double turn = remainder(degrees, 360);
    const double c = fabs(turn) == 90 ? 0 : cos(turn * PI / 180);
    const double s = fabs(turn) == 180 ? 0 : sin(turn * PI / 180);
    const struct vec3 unit[] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    struct vec3 turned[3];
    for (int i = 0; i < 3; i++)
        turned[i] = vec3_add(vec3_add(vec3_scale(c, unit[i]),
                                      vec3_scale(s, vec3_cross(k, unit[i]))),
                             vec3_scale((1 - c) * vec3_dot(k, unit[i]), k));
    return columns(turned[0], turned[1], turned[2], (struct vec3){ 0, 0, 0 });
}

bool affine_look_at(struct vec3 origin, struct vec3 target, struct vec3 up,
                    struct affine *out)
{
    const struct vec3 to = vec3_minus(target, origin);
    const double far = vec3_length(to), tall = vec3_length(up);
    if (!(far > 0 && isfinite(far) && tall > 0 && isfinite(tall)))
        return false;
    const struct vec3 dir = vec3_scale(1 / far, to);
    const struct vec3 left = vec3_cross(vec3_scale(1 / tall, up), dir);
    if (!(vec3_length(left) > 1e-9)) /* what rounding makes of parallels */
        return false;
    const struct vec3 x = vec3_unit(left);
    *out = columns(x, vec3_cross(dir, x), dir, origin);
    return true;
}
