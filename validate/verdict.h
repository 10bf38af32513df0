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
    struct vec3 wo, wi; /* worst directions; wi only where has_wi */
    char note[256];     /* the numbers behind it, one line */
};

/** Sets the note, or adds to it; what does not fit is cut off. */
__attribute__((format(printf, 2, 3))) void
verdict_note(struct verdict *v, const char *format, ...);
__attribute__((format(printf, 2, 3))) void verdict_add(struct verdict *v,
                                                       const char *format, ...);

#endif
