/* energy.c - quadrature, weights, and uniform directions */
#include "validate/energy.h"

#include <stdlib.h>

enum { UNIFORM_MAX = 262144 };

static const double energy_tolerance = 1e-9;
static const long energy_budget = 20000000;

/* f (n_i / n_o)^2 |cos| in each band; behind them what of it cannot be sampled,
 * and what weights above the cap carry. */
static void energy_at(const void *context, size_t n, struct dirs w,
                      double *value)
{
    const struct subject *s = context;
    const size_t bands = (size_t)bsdf_bands(s->bsdf)->count;
    struct spectrum f[SUBJECT_BATCH];
    double pdf[SUBJECT_BATCH];
    for (size_t at = 0; at < n; at += SUBJECT_BATCH) {
        const struct dirs wi = { w.x + at, w.y + at, w.z + at };
        const size_t m = n - at < SUBJECT_BATCH ? n - at : SUBJECT_BATCH;
        subject_eval(s, m, wi, f);
        subject_pdf(s, m, wi, pdf);
        for (size_t i = 0; i < m; i++) {
            const double scale =
                fabs(wi.z[i]) * subject_compression(s, dirs_at(wi, i));
            double most = 0;
            for (size_t b = 0; b < bands; b++) {
                value[b * n + at + i] = f[i].band[b] * scale;
                most = fmax(most, f[i].band[b] * scale);
            }
            value[bands * n + at + i] = pdf[i] > 0 ? 0 : most;
            value[(bands + 1) * n + at + i] =
                fmax(most - s->survey.cap * pdf[i], 0);
        }
    }
}

/* Of f over drawn directions, as f is rounded anew at every node. */
static double typical_rounding(const struct subject *s)
{
    enum { DRAWS = 65 };
    struct bsdf_sample sample[DRAWS];
    struct vec3 wi[DRAWS];
    size_t n = 0;
    subject_draw(s, subject_rng(s, STREAM_PAIRS), 0, DRAWS, sample);
    for (size_t i = 0; i < DRAWS; i++)
        if (subject_spread(&sample[i]))
            wi[n++] = sample[i].wi;
    return subject_typical_rounding(s, wi, n, false);
}

static bool by_quadrature(const struct subject *s, struct energy *e)
{
    const struct survey *v = &s->survey;
    const int bands = bsdf_bands(s->bsdf)->count, parts = bands + 2;
    const size_t bins = partition_bins(v->partition);
    const double rounding = typical_rounding(s);
    struct estimate sum[BANDS_MAX + 2] = { { 0, 0 } };
    struct estimate *part = malloc(bins * (size_t)parts * sizeof *part);
    const bool ok =
        part && partition_integrate(v->partition, energy_at, s, parts,
                                    energy_tolerance + rounding / 400,
                                    subject_batch(s), energy_budget, part);
    for (int b = 0; ok && b < parts; b++)
        for (size_t i = 0; i < bins; i++)
            sum[b] = estimate_add(sum[b], part[i * (size_t)parts + (size_t)b]);
    free(part);
    e->unsampled = sum[bands];
    e->capped = sum[bands + 1];
    for (int b = 0; b < bands; b++) {
        sum[b].error += survey_unknown * sum[b].value;
        sum[b].error +=
            (16 * s->claims.epsilon + rounding) * fabs(sum[b].value);
        e->beside[b] = e->albedo[b] = sum[b];
        for (int k = 0; k < v->deltas; k++)
            e->albedo[b].value += v->delta[k].pdf * v->delta[k].weight.band[b] *
                                  subject_compression(s, v->delta[k].wi);
        e->albedo[b].error +=
            16 * s->claims.epsilon * fabs(e->albedo[b].value - sum[b].value);
    }
    return ok;
}

static struct mean mean_of(double sum, double square, uint64_t n, double most)
{
    const double count = (double)n, value = sum / count;
    return (struct mean){ value,
                          fmax(square - count * value * value, 0) / (count - 1),
                          most, n };
}

static void by_weights(const struct subject *s, struct energy *e)
{
    const struct survey *v = &s->survey;
    for (int b = 0; b < bsdf_bands(s->bsdf)->count; b++)
        e->weight[b] =
            mean_of(v->weight[b].sum, v->weight[b].square, v->samples, v->cap);
}

/* The solid angle of the sides on which there may be light, and a direction
 * uniform over it. */
static double sides(const struct subject *s)
{
    const unsigned lobes = s->claims.lobes;
    return (lobes & BSDF_REFLECTION) && (lobes & BSDF_TRANSMISSION) ? 4 * PI
                                                                    : 2 * PI;
}

static struct vec3 uniform(const struct subject *s, struct vec3 u)
{
    const unsigned lobes = s->claims.lobes;
    const bool both = sides(s) > 2 * PI;
    const double up = lobes & BSDF_REFLECTION ? 1 : -1;
    const double z = both ? 2 * u.x - 1 : copysign(1, s->wo.z) * up * u.x;
    const double r = sqrt((1 - z) * (1 + z)), phi = 2 * PI * u.y;
    return (struct vec3){ r * cos(phi), r * sin(phi), z };
}

struct sums {
    double value, square, most;
};

static void uniform_batch(const struct subject *s, struct rng rng,
                          uint64_t first, size_t n, struct sums *sums)
{
    double x[SUBJECT_BATCH], y[SUBJECT_BATCH], z[SUBJECT_BATCH];
    struct spectrum f[SUBJECT_BATCH];
    const struct dirs wi = { x, y, z };
    for (size_t i = 0; i < n; i++) {
        const struct vec3 w = uniform(s, rng_uniform(rng, first + i));
        x[i] = w.x, y[i] = w.y, z[i] = w.z;
    }
    subject_eval(s, n, wi, f);
    for (size_t i = 0; i < n; i++) {
        const double scale =
            sides(s) * fabs(z[i]) * subject_compression(s, dirs_at(wi, i));
        for (int b = 0; b < bsdf_bands(s->bsdf)->count; b++) {
            const double value = f[i].band[b] * scale;
            sums[b].value += value;
            sums[b].square += value * value;
            sums[b].most = fmax(sums[b].most, value);
        }
    }
}

/* E[x^2] of x = f |cos| times the solid angle, where directions are uniform, is
 * the solid angle times the mean of w^2 pdf where they are drawn. */
static void by_uniform(const struct subject *s, struct energy *e)
{
    const struct survey *v = &s->survey;
    const uint64_t n = s->samples < UNIFORM_MAX ? s->samples : UNIFORM_MAX;
    struct sums sums[BANDS_MAX] = { { 0, 0, 0 } };
    bool worth = false;
    for (int b = 0; b < bsdf_bands(s->bsdf)->count; b++) {
        const double square = sides(s) * v->weight[b].peak / (double)v->samples;
        const double a = e->beside[b].value;
        e->hits[b] = square > 0 ? (double)n * a * a / square : 0;
        worth |= e->hits[b] >= 1000;
    }
    if (!worth)
        return;
    const struct rng rng = subject_rng(s, STREAM_UNIFORM);
    for (uint64_t at = 0; at < n; at += SUBJECT_BATCH) {
        const uint64_t left = n - at;
        uniform_batch(s, rng, at,
                      left < SUBJECT_BATCH ? (size_t)left : SUBJECT_BATCH,
                      sums);
    }
    for (int b = 0; b < bsdf_bands(s->bsdf)->count; b++)
        e->uniform[b] =
            mean_of(sums[b].value, sums[b].square, n, 1.5 * sums[b].most);
}

const struct energy *subject_energy(const struct subject *s)
{
    struct energy *e = s->energy;
    if (e->weight[0].n > 0)
        return e;
    if (!by_quadrature(s, e))
        return NULL;
    by_uniform(s, e);
    by_weights(s, e);
    return e;
}
