/* guess.h - the best explanation so far of what deviates, and who looks for it
 *
 * A guess starts as { 0 }.  Each suggestion that explains more than the best
 * before takes its place.
 */
#ifndef VALIDATE_GUESS_H
#define VALIDATE_GUESS_H

#include <math.h>

#include "validate/clues.h"
#include "validate/facets.h"
#include "validate/factors.h"
#include "validate/verdict.h"

/** The best so far, and how it would be put.  What cannot be measured as a
 * share of a sum of squares has a rank instead, which is not shown. */
struct guess {
    double explained;
    double order; /* the same, or below enough where it is not to be named */
    bool measured;
    bool exact; /* what is to be explained is known to many digits */
    char text[200];
};

/** A mistake that explains so much of a sum of squares, at most 1. */
__attribute__((format(printf, 3, 4))) void
suggest(struct guess *g, double explained, const char *format, ...);

/** One with a rank instead; it is named from 0.8 on. */
__attribute__((format(printf, 3, 4))) void
suggest_rank(struct guess *g, double rank, const char *format, ...);

/** Whether it explains enough to be named. */
bool guess_named(const struct guess *g);

/** Puts it into a verdict, in words. */
void guess_put(const struct guess *g, struct verdict *v);

/** Within a hundredth. */
static inline bool near(double a, double b)
{
    return fabs(a - b) < 0.01 * fabs(b);
}

/** ", in transmission" and its like, by scope. */
extern const char *const scope_text[];

/** Where the deviation is: on one side only, or everywhere. */
enum clue_scope scope_of(const struct clues *clues);

/** Whether a logarithm of a ratio is more than the limit. */
bool deviates(const struct clues *clues, double limit);

/** Clues, with the masking that the facets which were fitted have. */
bool gather(const struct subject *s, enum clue_kind kind, struct clues *clues);

/** The facets that samples are drawn by; false where they are none. */
bool fit_drawn(const struct subject *s, struct clues *clues,
               struct facets_fit *fit);

/** Lambda(w) of facets that were fitted. */
double fitted_lambda(const struct facets_fit *f, struct vec3 w);

/** How much a factor to a power explains.  Turned round: what is left of it
 * where the ratio is that of f to f with the directions swapped. */
double try_factor(const struct clues *clues, enum clue_scope scope,
                  const struct factor *f, double power, bool turned);

/** One constant for all; and that, and every factor of the library. */
void suggest_constant(struct guess *g, const struct clues *clues,
                      enum clue_scope scope, const char *what);
void suggest_factors(struct guess *g, const struct clues *clues,
                     const char *what);

/* -- who looks: each for one kind of failure ------------------------------- */

/** diagnose_density.c: what is said of a sample, where samples go. */
void diagnose_sample(struct guess *g, const struct subject *s,
                     struct clues *clues);
void diagnose_support(struct guess *g, const struct subject *s);
void diagnose_density(struct guess *g, const struct subject *s,
                      struct clues *clues);

/** diagnose_f.c: f turned round, f over D, an albedo above 1, the furnace. */
void diagnose_reciprocity(struct guess *g, const struct subject *s,
                          struct clues *clues);
void diagnose_facets(struct guess *g, const struct subject *s,
                     struct clues *clues);
void diagnose_constant(struct guess *g, const struct subject *s);
void diagnose_furnace(struct guess *g, const struct subject *s);

/** diagnose_delta.c: where deltas go, how often, and what they carry. */
void diagnose_delta(struct guess *g, const struct subject *s);
void diagnose_transmission(struct guess *g, const struct subject *s);
void diagnose_schlick(struct guess *g, const struct subject *s);

#endif
