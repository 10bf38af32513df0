/* run.h - all checks on all subjects, and the decision over the whole
 *
 * A run has one significance.  Holm's procedure shares it among the p-values:
 * the i-th smallest of m is held against significance / (m - i + 1), and the
 * first that is not below its level, with all behind it, passes.
 *
 * With escalations it spends the significance over further looks: half of it at
 * the first, half of the rest at the next, and what is left at the last.
 * A rejection is looked at again with four times the samples, fresh ones, and
 * stands when their p is below .001; and so is a result that is doubtful, with
 * p below .001 but not rejected, which the fresh samples alone decide.  They do
 * not depend on what chose it, so Holm's procedure shares the level of a look
 * among those that it is for.  At most two looks more, by default.
 *
 * A. Gandy and J. Scott, Unit Testing for MCMC and other Monte Carlo Methods,
 * arXiv 2001.06465, 2020 (sequential testing of doubtful results).
 * S. Holm, A Simple Sequentially Rejective Multiple Test Procedure,
 * Scandinavian Journal of Statistics 6(2), 1979.
 */
#ifndef VALIDATE_RUN_H
#define VALIDATE_RUN_H

#include <stddef.h>

#include "validate/checks.h"

struct result {
    const struct bsdf *bsdf; /* borrowed */
    struct vec3 wo;
    struct verdict *verdict; /* one a check, in the order of `checks` */
};

struct run {
    struct plan plan;
    size_t results;
    struct result *result;
    size_t passed, failed, statistical; /* verdicts; those with a p */
};

/** Called by one thread at a time, after each subject. */
typedef void run_progress(void *context, size_t done, size_t of);

/** Checks every bsdf from every direction, or from its own run_directions where
 * wos is 0; progress may be NULL.  False when out of memory.  The bsdfs must
 * outlive the run. */
bool run_checks(struct run *run, const struct plan *plan,
                const struct bsdf *const *bsdf, size_t bsdfs,
                const struct vec3 *wo, size_t wos, run_progress *progress,
                void *context, struct err *err);

/** The same of a list of pairs; those of one bsdf follow one another. */
struct run_pair {
    const struct bsdf *bsdf;
    struct vec3 wo;
};
bool run_pairs(struct run *run, const struct plan *plan,
               const struct run_pair *pair, size_t pairs,
               run_progress *progress, void *context, struct err *err);
void run_clear(struct run *run);

/** Decides n statistical verdicts: passed, value and limit in sigma. */
void holm(struct verdict **verdict, size_t n, double significance);

/** The specs of `--all`: every model over its roughnesses, distributions and
 * ways of sampling.  The last is NULL. */
extern const char *const run_all_specs[];

/** theta 0, 30, 75, 89, 89.9 degrees at an azimuth without symmetry; for a
 * two-sided model also 180 degrees less each, and the critical angle of its
 * eta where it transmits.  Returns how many. */
enum { RUN_DIRECTIONS_MAX = 11 };
size_t run_directions(const struct bsdf *b, struct vec3 wo[RUN_DIRECTIONS_MAX]);

#endif
