/* jacobian.h - the density of samples at a point, from the map that makes them
 *
 * Where two of the three random numbers move the direction and the third one
 * picks a lobe, samples have the density share / |d wi / d(u_a, u_b)| there, if
 * no other u leads to the same place.  Derivatives are central differences of
 * two steps, extrapolated.
 */
#ifndef VALIDATE_JACOBIAN_H
#define VALIDATE_JACOBIAN_H

#include "validate/subject.h"

enum { JACOBIAN_POINTS = 512 };

struct jacobian_point {
    double u[3];
    struct bsdf_sample at;
    bool usable;       /* two numbers move it, and so do their neighbours */
    int still;         /* the number that does not */
    int axis[2];       /* those that do */
    struct vec3 d[3];  /* d wi / d u */
    double det;        /* [sr] */
    double step_error; /* relative: what the two steps differ by */
    double share;      /* of the still number that leads to this wi */
    bool overlap;      /* it leads to another one on the same side as well */
};

/** Fills JACOBIAN_POINTS points, whose u are uniform but not within .005 of the
 * ends; false when out of memory. */
bool jacobian_points(const struct subject *s, struct jacobian_point *point);

#endif
