/* sampler.h - the random numbers of a pixel
 *
 * A triple is a function of (seed, pixel, sample, row) only; which row serves
 * what is path.c's.  Triples of one row are made for some samples at a time,
 * which vectors do; so a pixel's samples are best taken in their order.
 */
#ifndef INTEGRATOR_SAMPLER_H
#define INTEGRATOR_SAMPLER_H

#include <stdint.h>

#include "bsdf/rng.h"

enum { SAMPLER_LANES = 8, SAMPLER_ROWS = 64 };

struct sampler {
    struct rng rng;
    uint64_t sample; /* at present */
    uint64_t first;  /* of those whose triples are there */
    uint64_t there;  /* a bit a row */
    double x[SAMPLER_ROWS][SAMPLER_LANES];
    double y[SAMPLER_ROWS][SAMPLER_LANES];
    double z[SAMPLER_ROWS][SAMPLER_LANES];
};

void sampler_start(struct sampler *s, uint64_t seed, uint64_t pixel);

/** Goes to a sample, of at most 2^32. */
void sampler_go(struct sampler *s, uint64_t sample);

/** The triple of a row, of at most 2^32; each number in [0, 1). */
struct vec3 sampler_row(struct sampler *s, uint64_t row);

#endif
