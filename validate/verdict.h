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
#include <stdint.h>

#include "bsdf/vec.h"

/** One of the p-values that a check's own is made of, and how it grows with a
 * mistake of relative size d: a chi-square of so many degrees has the
 * non-centrality scale d^2, a normal statistic the mean scale d, a Poisson
 * count of a mean that is known scale d more. */
struct verdict_part {
    const char *name; /* "coarse", "total" ... */
    double p;         /* conservative where the statistic is discrete */
    double uniform;   /* randomised there, so that it is uniform for a sound
                         model, and NaN where it cannot be: for calibration */
    enum part_kind {
        PART_OTHER,
        PART_CHI_SQUARE,
        PART_NORMAL,
        PART_POISSON
    } kind;
    long degrees;
    double mean, scale;
    double error;       /* of what the statistic is held against, relative */
    const char *before; /* "the pdf wrong by" d "%": what d says, or NULL: it */
    const char *after;  /* is not said */
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

    uint64_t samples; /* that were drawn for it */
    bool confirmed;   /* a rejection that fresh samples agree with */

    bool has_wi;
    struct vec3 wo, wi;  /* worst directions; wi only where has_wi */
    char note[256];      /* the numbers behind it, one line */
    double effect_size;  /* of the first in effect, relative; or 0 */
    char effect[192];    /* of one that passed: the smallest mistake that it
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

/** Adds to the effect, behind a semicolon. */
__attribute__((format(printf, 2, 3))) void
verdict_found(struct verdict *v, const char *format, ...);

/** Adds a part; the check's p is made of all, see verdict_combine. */
void verdict_part(struct verdict *v, struct verdict_part part);

/** p by Bonferroni over the parts: the whole check has one. */
void verdict_combine(struct verdict *v);

/** Says of a verdict whose p passed what it would have found, where each p is
 * held against the level. */
void verdict_effect(struct verdict *v, double level);

#endif
