/* calibration.h - what the checks say of models that are sound
 *
 * A run is one sound model seen from some random directions at a seed of its
 * own; a case is one of its directions.  Random numbers depend on (seed, spec,
 * direction), so cases are independent, and so are the p-values of one name in
 * them; those of one case are not.
 */
#ifndef TESTS_CALIBRATION_H
#define TESTS_CALIBRATION_H

#include "validate/run.h"

/** How often a p-value must be at or below them at most. */
enum { LEVELS = 3 };
extern const double calibration_level[LEVELS]; /* .05, .01, .001 */

/** One p-value a case: a check's own, or that of one of its parts. */
struct calibration_row {
    const char *check, *part; /* part NULL: the check's */
    size_t cases, small[LEVELS];
    double degrees; /* summed over cases, of chi-square */
    struct calibration_value {
        double uniform;
        int model;
    } * value; /* of the cases where it can be uniform */
    size_t values, room;
};

enum { CALIBRATION_ROWS_MAX = 40 };
struct calibration {
    /* What is asked for. */
    const char *const *spec; /* the last is NULL */
    uint64_t seed;           /* of the first run; one more for each round */
    size_t rounds, directions;
    uint64_t samples;
    int often; /* the checks without a p are run once in so many runs */

    /* What was found. */
    size_t models, runs, cases;
    size_t runs_failed;   /* at a significance of 1e-6 */
    size_t runs_further;  /* that looked further than once */
    size_t deterministic; /* verdicts without a p, and how many failed */
    size_t deterministic_failed;
    char failure[512]; /* the first */
    int rows;
    struct calibration_row row[CALIBRATION_ROWS_MAX];
};

/** Fills in what was found; progress as in run.h, by runs, may be NULL. */
bool calibration_make(struct calibration *c, run_progress *progress,
                      struct err *err);
void calibration_clear(struct calibration *c);

/** Bits of a plan's skip: the checks that have no p, but for those that cost
 * nothing. */
uint64_t calibration_without_p(void);

/** A random direction of the seed's, uniform over the upper hemisphere, or over
 * the sphere. */
struct vec3 calibration_direction(uint64_t seed, uint64_t stream,
                                  uint64_t index, bool both_sides);

/** Values of a row, of one model or all (-1), into `out`; how many. */
size_t calibration_values(const struct calibration_row *row, int model,
                          double *out);

/** Sound models of the kinds that there are; the last is NULL. */
extern const char *const calibration_specs[];

#endif
