/* sampler.c - index = row 2^32 + sample, the pixel is the stream */
#include "integrator/sampler.h"

void sampler_start(struct sampler *s, uint64_t seed, uint64_t pixel)
{
    s->rng = (struct rng){ .seed = seed, .stream = pixel };
    s->sample = s->first = 0;
    s->there = 0;
}

void sampler_go(struct sampler *s, uint64_t sample)
{
    const uint64_t first = sample - sample % SAMPLER_LANES;
    if (first != s->first)
        s->there = 0;
    s->first = first;
    s->sample = sample;
}

struct vec3 sampler_row(struct sampler *s, uint64_t row)
{
    if (row >= SAMPLER_ROWS)
        return rng_uniform(s->rng, row << 32 | s->sample);
    if (!(s->there >> row & 1)) {
        rng_uniform_many(s->rng, row << 32 | s->first, SAMPLER_LANES, s->x[row],
                         s->y[row], s->z[row]);
        s->there |= (uint64_t)1 << row;
    }
    const size_t i = s->sample % SAMPLER_LANES;
    return (struct vec3){ s->x[row][i], s->y[row][i], s->z[row][i] };
}
