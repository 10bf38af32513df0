/* rng.h - random numbers that depend on (seed, stream, index) only
 *
 * Threefry 4x64-20 of Random123: the number of a sample is a function of its
 * index, so neither the order nor the number of threads matters.  The seed and
 * the stream are its key, the index its counter, of 64 bits each, so no two of
 * (seed, stream, index) share their numbers.  It adds, turns and mixes words of
 * 64 bits, which vectors do as well; Philox multiplies them, which they cannot.
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

/** Those of n pairs of a stream and an index. */
void rng_uniform_each(uint64_t seed, size_t n, const uint64_t *stream,
                      const uint64_t *index, double *x, double *y, double *z);

#endif
