/* sampler.h - the random numbers of a pixel
 *
 * A triple is a function of (seed, pixel, sample, row) only; which row serves
 * what is path.c's.
 *
 *   independent   Threefry (bsdf/rng.h): samples know nothing of each other,
 * and s^2 / n is the variance of a mean ldsampler     the first two numbers of
 * a row's samples are Sobol's (0, 2)-sequence, the third van der Corput's, with
 * Owen's scrambling and their order shuffled by row; s^2 / n is mostly more
 * than the variance of a mean
 *
 * Both are unbiased.  The names are Mitsuba 3's.  Triples of a row are made for
 * some samples at a time, which vectors do, so that a pixel's samples are best
 * taken in their order.
 */
#ifndef INTEGRATOR_SAMPLER_H
#define INTEGRATOR_SAMPLER_H

#include <stdint.h>

#include "bsdf/rng.h"

enum { SAMPLER_LANES = 8, SAMPLER_ROWS = 64 };

enum sampler_kind { SAMPLER_INDEPENDENT, SAMPLER_LD };

/* What a row is scrambled and shuffled by. */
struct sampler_seeds {
    uint32_t order, x, y, order_z, z;
};

struct sampler {
    enum sampler_kind kind;
    struct rng rng;
    uint64_t sample; /* at present */
    uint64_t first;  /* of those whose triples are there */
    uint64_t there;  /* a bit a row */
    uint64_t seeded; /* likewise */
    struct sampler_seeds seeds[SAMPLER_ROWS];
    double x[SAMPLER_ROWS][SAMPLER_LANES];
    double y[SAMPLER_ROWS][SAMPLER_LANES];
    double z[SAMPLER_ROWS][SAMPLER_LANES];
};

void sampler_start(struct sampler *s, enum sampler_kind kind, uint64_t seed,
                   uint64_t pixel);

/** Goes to a sample, below 2^32. */
void sampler_go(struct sampler *s, uint64_t sample);

/** The triple of a row, below 2^31; each number in [0, 1). */
struct vec3 sampler_row(struct sampler *s, uint64_t row);

#endif
