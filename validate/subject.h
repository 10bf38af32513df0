/* subject.h - one model seen from one direction, and what was drawn from it
 *
 * The survey is the work that several checks share: bins that fit the lobe,
 * the mass of the pdf in each with its error, and how many of the plan's
 * samples fell there.  Samples that a model refuses are a category of their
 * own, and so are its delta directions.
 *
 * Random numbers depend on (seed, spec, wo, purpose, index) only, so a verdict
 * can be replayed alone.
 */
#ifndef VALIDATE_SUBJECT_H
#define VALIDATE_SUBJECT_H

#include "bsdf/bsdf.h"
#include "bsdf/rng.h"
#include "validate/partition.h"
#include "validate/plan.h"

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

struct survey {
    struct partition *partition;
    struct estimate *mass; /* integral of the pdf over each bin */
    uint64_t *count;       /* samples in each bin */
    struct estimate total; /* sum of the masses; the error is 1e-7 of it more */

    uint64_t samples; /* drawn: bins + refused + stray + deltas */
    uint64_t refused; /* all zeros */
    uint64_t stray;   /* neither refused nor a direction, NaN for one */
    uint64_t bad;     /* not finite, negative, without a pdf, or not a unit */
    struct bsdf_sample first_bad;

    struct delta delta[DELTAS_MAX];
    int deltas;
    uint64_t delta_others; /* samples in more directions than DELTAS_MAX */
};

enum stream { STREAM_PILOT, STREAM_SURVEY, STREAM_SAMPLE, STREAM_PAIRS };

struct subject {
    const struct bsdf *bsdf; /* borrowed */
    struct vec3 wo;
    const struct plan *plan; /* borrowed */
    struct survey survey;
};

/** Surveys a model from a direction; false when out of memory. */
bool subject_init(struct subject *s, const struct bsdf *b, struct vec3 wo,
                  const struct plan *plan, struct err *err);
void subject_clear(struct subject *s);

struct rng subject_rng(const struct subject *s, enum stream purpose);

/** Probability that the pdf and the deltas leave for refusal, with error. */
struct estimate survey_refusal(const struct survey *v);

/** (n_i / n_o)^2, which makes energy of radiance that comes from wi: 1 on the
 * side of wo, and by the claimed eta through the surface. */
double subject_compression(const struct subject *s, struct vec3 wi);

/** The share of light that is not lost, one a band: the integral of
 * f (n_i / n_o)^2 |cos| over the sphere, deltas included.  unsampled takes what
 * the band with the most of it has where the pdf is 0. */
void subject_albedo(const struct subject *s, struct estimate albedo[BANDS_MAX],
                    struct estimate *unsampled);

/** Draws n samples from an index on. */
void subject_draw(const struct subject *s, struct rng rng, uint64_t from,
                  size_t n, struct bsdf_sample *out);

/** All zeros, as when the light is absorbed. */
bool subject_refused(const struct bsdf_sample *a);

/** How far two ways to the same value may differ, relative to it, whatever the
 * direction.  1 - F and the cosine beyond the critical angle are, as most write
 * them, roots and differences of numbers that are known to 2^-53; what is left
 * of them near that angle has half the digits, sqrt(2^-53) = 1e-8.  Ten times
 * that; no mistake of a formula is as small. */
extern const double subject_precision;

/** How far the length of a direction may be off 1. */
extern const double subject_unit_error;

/** How far plain double arithmetic may put the pdf, or the largest band of f,
 * off at wi, relative to it: the relative change when wi moves by 2^-40, scaled
 * to 16 roundings of 2^-52; at most 0.5. */
double subject_rounding(const struct subject *s, struct vec3 wi, bool of_pdf);

#endif
