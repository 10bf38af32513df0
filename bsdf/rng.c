/* rng.c - Threefry by Random123 */
#include "bsdf/rng.h"

#include <Random123/threefry.h>

#include "bsdf/fastmath.h"
#include "bsdf/lanes.h"

/* The first 53 bits as a share of 1.  Each half becomes a double by its bits,
 * which is exact, and so is their sum; a conversion of 64 bits is an
 * instruction that AVX2 lacks. */
INLINE double unit(uint64_t word)
{
    const uint64_t high = word >> 43, low = (word >> 11) & 0xffffffff;
    return ((fm_double(high | 0x4530000000000000) - (0x1p84 + 0x1p52)) +
            fm_double(low | 0x4330000000000000)) *
           0x1p-53;
}

INLINE struct vec3 uniform(struct rng rng, uint64_t index)
{
    const threefry4x64_ctr_t counter = { { index } };
    const threefry4x64_key_t key = { { rng.seed, rng.stream } };
    const threefry4x64_ctr_t word = threefry4x64(counter, key);
    return (struct vec3){ unit(word.v[0]), unit(word.v[1]), unit(word.v[2]) };
}

struct vec3 rng_uniform(struct rng rng, uint64_t index)
{
    return uniform(rng, index);
}

LANES void rng_uniform_many(struct rng rng, uint64_t first, size_t n, double *x,
                            double *y, double *z)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct vec3 u = uniform(rng, first + i);
        x[i] = u.x, y[i] = u.y, z[i] = u.z;
    }
}

LANES void rng_uniform_each(uint64_t seed, size_t n, const uint64_t *stream,
                            const uint64_t *index, double *x, double *y,
                            double *z)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct rng rng = { seed, stream[i] };
        const struct vec3 u = uniform(rng, index[i]);
        x[i] = u.x, y[i] = u.y, z[i] = u.z;
    }
}
