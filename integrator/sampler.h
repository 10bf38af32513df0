/* sampler.h - the random numbers of a pixel
 *
 * A triple is a function of (seed, pixel, sample, row) only; which row serves
 * what is path.c's.
 *
 * independent: Threefry (bsdf/rng.h).  Samples know nothing of each other, and
 * s^2 / n is the variance of a mean.
 *
 * ldsampler: the first two numbers of a row's samples are Sobol's (0,
 * 2)-sequence, the third van der Corput's, with Owen's scrambling and their
 * order shuffled by row; s^2 / n is mostly more than the variance of a mean.
 *
 * Both are unbiased.  The names are Mitsuba 3's.
 */
#ifndef INTEGRATOR_SAMPLER_H
#define INTEGRATOR_SAMPLER_H

#include <stdint.h>

#include "integrator/wave.h"

enum sampler_kind { SAMPLER_INDEPENDENT, SAMPLER_LD };

struct sampler {
    enum sampler_kind kind;
    uint64_t seed;
};

/** Whose numbers are wanted; borrowed. */
struct sampler_lanes {
    size_t pieces;         /* at most WAVE */
    const uint64_t *pixel; /* of each */
    size_t n;              /* at most WAVE */
    const uint16_t *piece; /* of each of n, and the sample of its pixel */
    const uint32_t *sample;
};

/** Their triples of a row, below 2^31; each number in [0, 1). */
void sampler_row(const struct sampler *s, uint64_t row,
                 const struct sampler_lanes *lanes, struct vecs *out);

#endif
