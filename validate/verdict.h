/* verdict.h - what a check found, in one shape for all of them
 *
 * A check either computes a value and its limit, or hands over a p-value; then
 * value and limit are in sigma, the two-sided normal equivalents of p and of
 * the level that Holm's procedure leaves it (run.h).  value <= limit passes,
 * and a value that is not a number fails.
 */
#ifndef VALIDATE_VERDICT_H
#define VALIDATE_VERDICT_H

#include <stdbool.h>

#include "bsdf/vec.h"

/** One of the p-values that a check's own is made of. */
struct verdict_part {
    const char *name; /* "coarse", "total" ... */
    double p;         /* conservative where the statistic is discrete */
    double uniform;   /* randomised there, so that it is uniform for a sound
                         model: for calibration alone */
};

enum { VERDICT_PARTS_MAX = 12 };

struct verdict {
    const char *check; /* its name */
    bool applies;      /* false: nothing to check, and only note is set */
    bool passed;

    double value, limit;
    double error;     /* how far off value may be, in its unit; already
                         counted in the decision */
    const char *unit; /* of value and limit; "" where it has none */
    double p;         /* probability of a sound model doing worse; NaN
                         where the check is not statistical */

    bool has_wi;
    struct vec3 wo, wi;  /* worst directions; wi only where has_wi */
    char note[256];      /* the numbers behind it, one line */
    char effect[128];    /* of one that passed: the smallest mistake that it
                            would have found with 99 % power; or "" */
    char diagnosis[256]; /* of one that failed: what is probably wrong; or "" */

    int parts;
    struct verdict_part part[VERDICT_PARTS_MAX];
};

/** Sets the note, or adds to it; what does not fit is cut off. */
__attribute__((format(printf, 2, 3))) void
verdict_note(struct verdict *v, const char *format, ...);
__attribute__((format(printf, 2, 3))) void verdict_add(struct verdict *v,
                                                       const char *format, ...);

#endif
