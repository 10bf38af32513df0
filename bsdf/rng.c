/* rng.c - Philox by Random123 */
#include "bsdf/rng.h"

#include <Random123/philox.h>

static inline double unit(uint64_t word)
{
    return (double)(word >> 11) * 0x1p-53;
}

static inline struct vec3 uniform(struct rng rng, uint64_t index)
{
    const philox4x64_ctr_t counter = { { index, rng.stream } };
    const philox4x64_key_t key = { { rng.seed } };
    const philox4x64_ctr_t word = philox4x64(counter, key);
    return (struct vec3){ unit(word.v[0]), unit(word.v[1]), unit(word.v[2]) };
}

struct vec3 rng_uniform(struct rng rng, uint64_t index)
{
    return uniform(rng, index);
}

/* Inlined, so that the rounds of one index, each of which waits for the one
 * before, run beside those of the next. */
void rng_uniform_many(struct rng rng, uint64_t first, size_t n, double *x,
                      double *y, double *z)
{
    for (size_t i = 0; i < n; i++) {
        const struct vec3 u = uniform(rng, first + i);
        x[i] = u.x, y[i] = u.y, z[i] = u.z;
    }
}
