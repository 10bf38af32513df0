/* rng.c - Philox by Random123 */
#include "bsdf/rng.h"

#include <Random123/philox.h>

static double unit(uint64_t word)
{
    return (double)(word >> 11) * 0x1p-53;
}

struct vec3 rng_uniform(struct rng rng, uint64_t index)
{
    const philox4x64_ctr_t counter = { { index, rng.stream } };
    const philox4x64_key_t key = { { rng.seed } };
    const philox4x64_ctr_t word = philox4x64(counter, key);
    return (struct vec3){ unit(word.v[0]), unit(word.v[1]), unit(word.v[2]) };
}
