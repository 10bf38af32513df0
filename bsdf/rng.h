/* rng.h - random numbers that depend on (seed, stream, index) only
 *
 * Philox 4x64-10 of Random123: the number of a sample is a function of its
 * index, so neither the order nor the number of threads matters.
 *
 * J. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC11, 2011.
 */
#ifndef BSDF_RNG_H
#define BSDF_RNG_H

#include <stdint.h>

#include "bsdf/vec.h"

struct rng {
    uint64_t seed, stream;
};

/** Three numbers uniform in [0, 1), multiples of 2^-53. */
struct vec3 rng_uniform(struct rng rng, uint64_t index);

/** Those of n indices from the first on, an array a coordinate. */
void rng_uniform_many(struct rng rng, uint64_t first, size_t n, double *x,
                      double *y, double *z);

#endif
