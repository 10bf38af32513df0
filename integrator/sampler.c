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

#include "bsdf/lanes.h"

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

LANES static void spread(const struct sampler_seeds *seeds, uint32_t first,
                         double *x, double *y, double *z)
{
    const struct sampler_seeds s = *seeds;
    LANES_LOOP
    for (uint32_t i = 0; i < SAMPLER_LANES; i++) {
        const uint32_t back = reversed(first + i);
        const uint32_t d = reversed(permuted(back, s.order));
        x[i] = scrambled(d, s.x);
        y[i] = scrambled(pascal(d), s.y);
        z[i] = scrambled(reversed(permuted(back, s.order_z)), s.z);
    }
}

void sampler_start(struct sampler *s, enum sampler_kind kind, uint64_t seed,
                   uint64_t pixel)
{
    s->kind = kind;
    s->rng = (struct rng){ .seed = seed, .stream = pixel };
    s->sample = s->first = 0;
    s->there = s->seeded = 0;
}

void sampler_go(struct sampler *s, uint64_t sample)
{
    const uint64_t first = sample - sample % SAMPLER_LANES;
    if (first != s->first)
        s->there = 0;
    s->first = first;
    s->sample = sample;
}

/* Of indices that no sample has. */
static struct sampler_seeds seeds_of(struct rng rng, uint64_t row)
{
    const struct vec3 a = rng_uniform(rng, (uint64_t)1 << 63 | row << 1);
    const struct vec3 b = rng_uniform(rng, (uint64_t)1 << 63 | row << 1 | 1);
    return (struct sampler_seeds){
        (uint32_t)(a.x * 0x1p32), (uint32_t)(a.y * 0x1p32),
        (uint32_t)(a.z * 0x1p32), (uint32_t)(b.x * 0x1p32),
        (uint32_t)(b.y * 0x1p32),
    };
}

/* A row that is too far to be kept; needed by few paths. */
static struct vec3 alone(const struct sampler *s, uint64_t row)
{
    if (s->kind == SAMPLER_INDEPENDENT)
        return rng_uniform(s->rng, row << 32 | s->sample);
    const struct sampler_seeds seeds = seeds_of(s->rng, row);
    double x[SAMPLER_LANES], y[SAMPLER_LANES], z[SAMPLER_LANES];
    const size_t i = s->sample % SAMPLER_LANES;
    spread(&seeds, (uint32_t)s->first, x, y, z);
    return (struct vec3){ x[i], y[i], z[i] };
}

static void fill(struct sampler *s, uint64_t row)
{
    const uint64_t bit = (uint64_t)1 << row;
    s->there |= bit;
    if (s->kind == SAMPLER_INDEPENDENT) {
        rng_uniform_many(s->rng, row << 32 | s->first, SAMPLER_LANES, s->x[row],
                         s->y[row], s->z[row]);
        return;
    }
    if (!(s->seeded & bit)) {
        s->seeds[row] = seeds_of(s->rng, row);
        s->seeded |= bit;
    }
    spread(&s->seeds[row], (uint32_t)s->first, s->x[row], s->y[row], s->z[row]);
}

struct vec3 sampler_row(struct sampler *s, uint64_t row)
{
    if (row >= SAMPLER_ROWS)
        return alone(s, row);
    if (!(s->there >> row & 1))
        fill(s, row);
    const size_t i = s->sample % SAMPLER_LANES;
    return (struct vec3){ s->x[row][i], s->y[row][i], s->z[row][i] };
}
