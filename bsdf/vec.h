/* vec.h - directions, and arrays of them
 *
 * The local frame has z along the surface normal.  A direction is a unit
 * vector that points away from the surface; theta is its angle to the normal,
 * phi its azimuth from x toward y.
 */
#ifndef BSDF_VEC_H
#define BSDF_VEC_H

#include <math.h>
#include <stddef.h>

#define PI 3.14159265358979323846

struct vec3 {
    double x, y, z;
};

/** An array of directions, one array a coordinate; borrowed. */
struct dirs {
    const double *x, *y, *z;
};

static inline struct vec3 dirs_at(struct dirs d, size_t i)
{
    return (struct vec3){ d.x[i], d.y[i], d.z[i] };
}

/** The same from one of them on. */
static inline struct dirs dirs_from(struct dirs d, size_t i)
{
    return (struct dirs){ d.x + i, d.y + i, d.z + i };
}

static inline struct vec3 vec3_add(struct vec3 a, struct vec3 b)
{
    return (struct vec3){ a.x + b.x, a.y + b.y, a.z + b.z };
}

static inline struct vec3 vec3_minus(struct vec3 a, struct vec3 b)
{
    return (struct vec3){ a.x - b.x, a.y - b.y, a.z - b.z };
}

static inline struct vec3 vec3_scale(double s, struct vec3 a)
{
    return (struct vec3){ s * a.x, s * a.y, s * a.z };
}

static inline double vec3_dot(struct vec3 a, struct vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vec3 vec3_cross(struct vec3 a, struct vec3 b)
{
    return (struct vec3){ a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                          a.x * b.y - a.y * b.x };
}

/** The largest of its numbers, by size. */
static inline double vec3_largest(struct vec3 a)
{
    return fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z)));
}

static inline double vec3_length(struct vec3 a)
{
    return sqrt(vec3_dot(a, a));
}

/** a over its length; the length must not be 0. */
static inline struct vec3 vec3_unit(struct vec3 a)
{
    return vec3_scale(1 / vec3_length(a), a);
}

/** The same where rounding alone made the length another than 1: Newton's step
 * for 1 / sqrt(a.a) from 1, off by the square of that. */
static inline struct vec3 vec3_unit_again(struct vec3 a)
{
    return vec3_scale(1.5 - vec3_dot(a, a) / 2, a);
}

/** Reflection of w at a facet whose unit normal is m: 2 (w.m) m - w. */
static inline struct vec3 vec3_reflect(struct vec3 w, struct vec3 m)
{
    const double t = 2 * vec3_dot(w, m);
    return (struct vec3){ t * m.x - w.x, t * m.y - w.y, t * m.z - w.z };
}

/** Angles in degrees, any finite phi; exact at multiples of 90. */
struct vec3 dir_from_degrees(double theta_deg, double phi_deg);

/** theta in [0, 180] and phi in (-180, 180], in degrees. */
struct angles {
    double theta_deg, phi_deg;
};
struct angles dir_to_degrees(struct vec3 w);

#endif
