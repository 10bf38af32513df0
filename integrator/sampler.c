/* sampler.c - index = row 2^32 + sample, the pixel is the stream
 *
 * Owen's scrambling flips each digit by a function of those before it; on
 * reversed digits that is a hash in which each bit depends on the lower ones
 * alone [1].  Of a number with i-th binary digit d_i, van der Corput's sequence
 * reverses the digits, and Sobol's second dimension those of P d, where P_ij =
 * binomial(j, i) mod 2, which by Lucas is 1 where i is a subset of j as sets of
 * binary digits; so P d takes five steps.
 *
 * [1] B. Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020; the
 *     constants are those of its listing 1, by S. Laine and T. Karras.
 * [2] I. M. Sobol', On the distribution of points in a cube and the approximate
 *     evaluation of integrals, USSR Computational Mathematics and Mathematical
 *     Physics 7(4), 1967.
 * [3] A. B. Owen, Randomly Permuted (t, m, s)-Nets and (t, s)-Sequences, Monte
 *     Carlo and Quasi-Monte Carlo Methods in Scientific Computing, 1995.
 */
#include "integrator/sampler.h"

#include "bsdf/rng.h"

INLINE uint32_t reversed(uint32_t x)
{
    x = x >> 16 | x << 16;
    x = (x & 0xff00ff00) >> 8 | (x & 0x00ff00ff) << 8;
    x = (x & 0xf0f0f0f0) >> 4 | (x & 0x0f0f0f0f) << 4;
    x = (x & 0xcccccccc) >> 2 | (x & 0x33333333) << 2;
    return (x & 0xaaaaaaaa) >> 1 | (x & 0x55555555) << 1;
}

INLINE uint32_t permuted(uint32_t x, uint32_t seed)
{
    x += seed;
    x ^= x * 0x6c50b47c;
    x ^= x * 0xb82f1e52;
    x ^= x * 0xc7afe638;
    return x ^ x * 0x8d22f6e6;
}

INLINE uint32_t pascal(uint32_t d)
{
    d ^= d >> 1 & 0x55555555;
    d ^= d >> 2 & 0x33333333;
    d ^= d >> 4 & 0x0f0f0f0f;
    d ^= d >> 8 & 0x00ff00ff;
    return d ^ d >> 16;
}

/* The number whose reversed digits, unscrambled, are given. */
INLINE double scrambled(uint32_t digits, uint32_t seed)
{
    return (double)(int32_t)(reversed(permuted(digits, seed)) ^ 0x80000000) *
               0x1p-32 +
           0.5;
}

/* What a row of a pixel is scrambled and shuffled by. */
struct seeds {
    uint32_t order[WAVE], x[WAVE], y[WAVE], order_z[WAVE], z[WAVE];
};

LANES static void spread(const struct seeds *s, size_t n, const uint16_t *piece,
                         const uint32_t *sample, struct vecs *out)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const size_t k = piece[i];
        const uint32_t back = reversed(sample[i]);
        const uint32_t d = reversed(permuted(back, s->order[k]));
        out->x[i] = scrambled(d, s->x[k]);
        out->y[i] = scrambled(pascal(d), s->y[k]);
        out->z[i] = scrambled(reversed(permuted(back, s->order_z[k])), s->z[k]);
    }
}

/* Of indices that no sample has. */
static void seeds_of(const struct sampler *s, uint64_t row,
                     const uint64_t *pixel, size_t n, struct seeds *seeds)
{
    struct vecs a, b;
    uint64_t index[WAVE];
    for (size_t i = 0; i < WAVE; i++)
        index[i] = (uint64_t)1 << 63 | row << 1;
    rng_uniform_each(s->seed, n, pixel, index, a.x, a.y, a.z);
    for (size_t i = 0; i < WAVE; i++)
        index[i] |= 1;
    rng_uniform_each(s->seed, n, pixel, index, b.x, b.y, b.z);
    for (size_t i = 0; i < n; i++) {
        seeds->order[i] = (uint32_t)(a.x[i] * 0x1p32);
        seeds->x[i] = (uint32_t)(a.y[i] * 0x1p32);
        seeds->y[i] = (uint32_t)(a.z[i] * 0x1p32);
        seeds->order_z[i] = (uint32_t)(b.x[i] * 0x1p32);
        seeds->z[i] = (uint32_t)(b.y[i] * 0x1p32);
    }
}

LANES static void independent(const struct sampler_lanes *lanes, uint64_t row,
                              uint64_t *stream, uint64_t *index)
{
    LANES_LOOP
    for (size_t i = 0; i < lanes->n; i++) {
        stream[i] = lanes->pixel[lanes->piece[i]];
        index[i] = row << 32 | lanes->sample[i];
    }
}

void sampler_row(const struct sampler *s, uint64_t row,
                 const struct sampler_lanes *lanes, struct vecs *out)
{
    if (s->kind == SAMPLER_LD) {
        struct seeds seeds;
        seeds_of(s, row, lanes->pixel, lanes->pieces, &seeds);
        spread(&seeds, lanes->n, lanes->piece, lanes->sample, out);
        return;
    }
    uint64_t stream[WAVE], index[WAVE];
    independent(lanes, row, stream, index);
    rng_uniform_each(s->seed, lanes->n, stream, index, out->x, out->y, out->z);
}
