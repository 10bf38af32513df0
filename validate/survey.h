/* survey.h - what was drawn from one model seen from one direction
 *
 * The survey is the work that several checks share: bins that fit the lobe,
 * the mass of the pdf in each with its error, how many of the plan's samples
 * fell there, and the sums of their weights.  Samples that a model refuses are
 * a category of their own, and so are its delta directions.
 */
#ifndef VALIDATE_SURVEY_H
#define VALIDATE_SURVEY_H

#include "bsdf/bsdf.h"
#include "validate/partition.h"

enum { DELTAS_MAX = 8 };

/** One of the directions that come with a probability instead of a density. */
struct delta {
    struct vec3 wi;
    double pdf;             /* as the first sample said it */
    struct spectrum weight; /* likewise */
    uint64_t count;
    double spread; /* largest difference of a later sample from the first, in
                      any of direction, pdf and weight */
};

/** Sums over all samples, refused ones as 0: of w = the weight as energy, cut
 * off at the cap; of its square; and of w^2 pdf of those with a density. */
struct weight_sums {
    double sum, square, peak;
};

struct survey {
    struct partition *partition;
    struct estimate *mass; /* integral of the pdf over each bin */
    uint64_t *count;       /* samples in each bin */
    struct estimate total; /* sum of the masses; the error is 1e-7 of it more */
    double rounding;       /* typical relative rounding of the pdf */

    double cap; /* of weights: 5/4 of the largest of a pilot */
    struct weight_sums weight[BANDS_MAX];

    uint64_t samples; /* drawn: bins + refused + stray + deltas */
    uint64_t refused; /* all zeros */
    uint64_t stray;   /* neither refused nor a direction, NaN for one */
    uint64_t bad;     /* not finite, negative, without a pdf, or not a unit */
    struct bsdf_sample first_bad;

    struct delta delta[DELTAS_MAX];
    int deltas;
    uint64_t delta_others; /* samples in more directions than DELTAS_MAX */
};

struct subject;

/** Fills the survey of a subject; false when out of memory. */
bool survey_make(struct subject *s, struct err *err);
void survey_clear(struct survey *v);

/** Probability that the pdf and the deltas leave for refusal, with error. */
struct estimate survey_refusal(const struct survey *v);

/** So much is always taken to be unknown of an integral over the sphere,
 * relative to it: what rules of a quadrature differ by is no bound where a kink
 * crosses the mesh, as the root in F at the critical angle does; 4e-8 were seen
 * there against 1.4e-8. */
extern const double survey_unknown;

#endif
