/* subject.h - one model seen from one direction, and how it is asked
 *
 * Random numbers depend on (seed, spec, wo, stage, purpose, index) only, so a
 * verdict can be replayed alone.  Models are asked about many directions at
 * once, as one may be another program.
 */
#ifndef VALIDATE_SUBJECT_H
#define VALIDATE_SUBJECT_H

#include "bsdf/bsdf.h"
#include "bsdf/rng.h"
#include "validate/plan.h"
#include "validate/survey.h"

enum stream {
    STREAM_PILOT,
    STREAM_SURVEY,
    STREAM_SAMPLE,
    STREAM_PAIRS,
    STREAM_UNIFORM,
    STREAM_JACOBIAN,
    STREAM_LOBES,
    STREAM_RANDOMISE,
    STREAM_TAILS
};

enum { SUBJECT_BATCH = 4096 }; /* the most that are worth asking for at once */

struct energy;

struct subject {
    const struct bsdf *bsdf; /* borrowed */
    struct vec3 wo;
    const struct plan *plan; /* borrowed */
    int stage; /* 0 at first; samples are fresh at every further stage */
    uint64_t samples;
    struct bsdf_claims claims;
    struct survey survey;
    struct energy *energy; /* see energy.h; at first demand */
};

/** Surveys a model from a direction; false when out of memory. */
bool subject_init(struct subject *s, const struct bsdf *b, struct vec3 wo,
                  const struct plan *plan, struct err *err);

/** The same with samples of its own at a further stage. */
bool subject_init_stage(struct subject *s, const struct bsdf *b, struct vec3 wo,
                        const struct plan *plan, int stage, uint64_t samples,
                        struct err *err);
void subject_clear(struct subject *s);

/** A subject that can be asked and drawn from, without a survey; needs no
 * clearing. */
struct subject subject_plain(const struct bsdf *b, struct vec3 wo,
                             const struct plan *plan);

/** How many to ask for at a time: SUBJECT_BATCH of another program; of a model
 * of ours as many as stay in the first cache. */
size_t subject_batch(const struct subject *s);

struct rng subject_rng(const struct subject *s, enum stream purpose);

/** f and pdf of n directions of incidence, and f of the pairs turned round. */
void subject_eval(const struct subject *s, size_t n, struct dirs wi,
                  struct spectrum *f);
void subject_pdf(const struct subject *s, size_t n, struct dirs wi,
                 double *pdf);
void subject_eval_back(const struct subject *s, size_t n, struct dirs wi,
                       struct spectrum *f);

/** Draws n samples, from an index on, or for numbers u of the caller's. */
void subject_draw(const struct subject *s, struct rng rng, uint64_t from,
                  size_t n, struct bsdf_sample *out);
void subject_sample(const struct subject *s, size_t n, struct dirs u,
                    struct bsdf_sample *out);

/** The same into arrays. */
void subject_draw_into(const struct subject *s, struct rng rng, uint64_t from,
                       size_t n, struct bsdf_samples out);

/** All zeros, as when the light is absorbed. */
bool subject_refused(const struct bsdf_sample *a);

/** Neither refused nor a delta. */
bool subject_spread(const struct bsdf_sample *a);

/** (n_i / n_o)^2, which makes energy of radiance that comes from wi: 1 on the
 * side of wo, and by the claimed eta through the surface. */
double subject_compression(const struct subject *s, struct vec3 wi);

/** How far two ways to the same value may differ, relative to it, whatever the
 * direction.  1 - F and the cosine beyond the critical angle are, as most write
 * them, roots and differences of numbers that are known to half an epsilon;
 * what is left of them near that angle has half the digits, for double
 * sqrt(2^-53) = 1e-8.  Ten times that; no mistake of a formula is as small. */
double subject_precision(const struct subject *s);

/** How far the length of a direction may be off 1. */
double subject_unit_error(const struct subject *s);

/** How far the model's arithmetic may put the pdf, or the largest band of f,
 * off at wi, relative to it: the relative change when wi moves a little, scaled
 * to 16 roundings of epsilon, and four times that to neighbours of wi, where a
 * difference of large numbers shows; at most 0.5. */
double subject_rounding(const struct subject *s, struct vec3 wi, bool of_pdf);

/** The median of that over n directions, 65 of them where there are more; 0 of
 * none. */
double subject_typical_rounding(const struct subject *s, const struct vec3 *wi,
                                size_t n, bool of_pdf);

#endif
