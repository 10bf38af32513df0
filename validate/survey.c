/* survey.c - pilots, bins, masses, and the one pass of samples */
#include <float.h>
#include <stdlib.h>

#include "bsdf/lanes.h"
#include "validate/subject.h"

enum { PILOTS = 16384, TAILS = 16384, BATCH = SUBJECT_BATCH };

/* Leaves of this accuracy, some thousands of them, keep the whole within 1e-7;
 * the bound that is carried along says how well it went. */
static const double mass_tolerance = 1e-10;
static const long mass_budget = 20000000;

const double survey_unknown = 1e-7;

static double difference(const struct delta *d, const struct bsdf_sample *a)
{
    const struct vec3 off = vec3_minus(a->wi, d->wi);
    double sum = vec3_length(off) + fabs(a->pdf - d->pdf);
    for (int b = 0; b < BANDS_MAX; b++)
        sum += fabs(a->weight.band[b] - d->weight.band[b]);
    return sum;
}

/* A direction is another one from 1e-6 away. */
static void delta_count(struct survey *v, const struct bsdf_sample *a)
{
    for (int k = 0; k < v->deltas; k++) {
        struct delta *d = &v->delta[k];
        if (vec3_length(vec3_minus(a->wi, d->wi)) < 1e-6) {
            d->count++;
            const double off = difference(d, a);
            if (!(off <= d->spread)) /* a NaN stays */
                d->spread = off;
            return;
        }
    }
    if (v->deltas == DELTAS_MAX) {
        v->delta_others++;
        return;
    }
    v->delta[v->deltas++] = (struct delta){
        .wi = a->wi, .pdf = a->pdf, .weight = a->weight, .count = 1
    };
}

/* The largest band of a weight as energy. */
static double largest(const struct subject *s, const struct bsdf_sample *a)
{
    double most = 0;
    for (int b = 0; b < BANDS_MAX; b++)
        most = fmax(most, a->weight.band[b]);
    return most * subject_compression(s, a->wi);
}

/* Samples as they come, and what they are: 1 or 0. */
struct drawn {
    double number[4 + BANDS_MAX][BATCH];
    bool delta[BATCH];
    uint64_t bad[BATCH], refused[BATCH];
    uint32_t bin[BATCH];
    struct bsdf_samples at; /* the arrays above */
};

static struct drawn *drawn_new(int bands)
{
    struct drawn *d = malloc(sizeof *d);
    if (!d)
        return NULL;
    d->at = (struct bsdf_samples){ d->number[0], d->number[1], d->number[2],
                                   d->number[3], { NULL },     d->delta };
    for (int b = 0; b < bands; b++)
        d->at.weight[b] = d->number[4 + b];
    return d;
}

/* What no sample may be, whatever the model: not finite, negative, or, unless
 * it is refused, without a pdf or a direction.  Refused is as subject_refused
 * has it. */
LANES static void judge(struct drawn *d, size_t n, double unit_error)
{
    const struct bsdf_samples a = d->at;
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        d->refused[i] = a.pdf[i] == 0 ? 1 : 0;
        d->bad[i] = 0;
    }
    for (int b = 0; b < BANDS_MAX && a.weight[b]; b++) {
        const double *w = a.weight[b];
        LANES_LOOP
        for (size_t i = 0; i < n; i++) {
            d->refused[i] &= w[i] == 0 ? 1 : 0;
            d->bad[i] |= w[i] >= 0 ? w[i] > DBL_MAX ? 1 : 0 : 1;
        }
    }
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const double l2 = a.x[i] * a.x[i] + a.y[i] * a.y[i] + a.z[i] * a.z[i];
        const double off = fabs(sqrt(l2) - 1);
        const uint64_t sound = a.pdf[i] > 0 ? off <= unit_error ? 1 : 0 : 0;
        d->bad[i] |= a.pdf[i] <= DBL_MAX ? (sound | d->refused[i]) ^ 1 : 1;
    }
}

INLINE void weigh_one(const struct bsdf_samples *a, const double *weight,
                      size_t i, double cap, double side, double compression,
                      double *sum, double *square, double *peak)
{
    double w = weight[i] * (a->z[i] * side >= 0 ? 1 : compression);
    w = w > cap ? cap : w; /* a NaN stays */
    *sum += w;
    *square += w * w;
    *peak += w * w * (a->delta[i] ? 0 : a->pdf[i]);
}

/* Adds to the sums of a band.  Eight partial sums, whatever the width of the
 * vectors, so that the same numbers are added in the same order everywhere. */
enum { PARTIAL = 8 };
LANES static void weigh(const struct drawn *d, size_t n, int band, double cap,
                        double side, double compression,
                        struct weight_sums *sums)
{
    const struct bsdf_samples a = d->at;
    const double *weight = a.weight[band];
    double sum[PARTIAL] = { 0 }, square[PARTIAL] = { 0 }, peak[PARTIAL] = { 0 };
    size_t at = 0;
    for (; at + PARTIAL <= n; at += PARTIAL)
        LANES_LOOP
    for (int i = 0; i < PARTIAL; i++)
        weigh_one(&a, weight, at + (size_t)i, cap, side, compression, &sum[i],
                  &square[i], &peak[i]);
    for (int i = 0; at < n; at++, i++)
        weigh_one(&a, weight, at, cap, side, compression, &sum[i], &square[i],
                  &peak[i]);
    for (int i = 0; i < PARTIAL; i++) {
        sums->sum += sum[i];
        sums->square += square[i];
        sums->peak += peak[i];
    }
}

/* Counts what a batch of n samples holds; count has one more than the bins, for
 * those that have none. */
static void sort(struct subject *s, struct drawn *d, size_t n, uint64_t *count)
{
    struct survey *v = &s->survey;
    const uint32_t bins = (uint32_t)partition_bins(v->partition);
    const double through =
        subject_compression(s, (struct vec3){ 0, 0, -copysign(1, s->wo.z) });
    judge(d, n, subject_unit_error(s));
    for (int b = 0; b < BANDS_MAX && d->at.weight[b]; b++)
        weigh(d, n, b, v->cap, s->wo.z, through, &v->weight[b]);
    partition_find(v->partition, n, (struct dirs){ d->at.x, d->at.y, d->at.z },
                   d->bin);
    for (size_t i = 0; i < n; i++) {
        if (d->bad[i] && v->bad++ == 0)
            v->first_bad = bsdf_samples_at(&d->at, i);
        if (d->delta[i] && !d->refused[i]) {
            const struct bsdf_sample a = bsdf_samples_at(&d->at, i);
            delta_count(v, &a);
        } else {
            const bool refused = d->refused[i];
            v->refused += refused;
            count[refused ? bins : d->bin[i]]++;
        }
    }
}

static bool samples_draw(struct subject *s)
{
    struct survey *v = &s->survey;
    const struct rng rng = subject_rng(s, STREAM_SURVEY);
    const size_t bins = partition_bins(v->partition);
    struct drawn *d = drawn_new(bsdf_bands(s->bsdf)->count);
    v->samples = s->samples;
    const size_t batch = subject_batch(s);
    for (uint64_t at = 0; d && at < v->samples; at += batch) {
        const uint64_t left = v->samples - at;
        const size_t n = left < batch ? (size_t)left : batch;
        subject_draw_into(s, rng, at, n, d->at);
        sort(s, d, n, v->count);
    }
    v->stray = v->count[bins] - v->refused;
    free(d);
    return d;
}

static void pdf_at(const void *context, size_t n, struct dirs w, double *value)
{
    subject_pdf(context, n, w, value);
}

/* Directions of samples that fell into one of the bins that have a slot, HINTS
 * a slot at most. */
enum { HINTS = 64 };
struct slots {
    size_t *of_bin; /* 1 + the slot, or 0 */
    size_t *n;
    double *hint; /* x of all, then y, then z */
    size_t count;
};

static struct dirs slots_at(const struct slots *s, size_t i)
{
    const size_t all = s->count * HINTS;
    return (struct dirs){ s->hint + i, s->hint + all + i,
                          s->hint + 2 * all + i };
}

static void slots_fill(const struct subject *s, struct slots *slots,
                       struct bsdf_sample *sample)
{
    const struct survey *v = &s->survey;
    const struct rng rng = subject_rng(s, STREAM_SURVEY);
    const size_t bins = partition_bins(v->partition);
    for (uint64_t at = 0; at < v->samples; at += BATCH) {
        const uint64_t left = v->samples - at;
        const size_t n = left < BATCH ? (size_t)left : BATCH;
        subject_draw(s, rng, at, n, sample);
        for (size_t i = 0; i < n; i++) {
            uint32_t bin;
            if (!subject_spread(&sample[i]))
                continue;
            partition_find(v->partition, 1,
                           (struct dirs){ &sample[i].wi.x, &sample[i].wi.y,
                                          &sample[i].wi.z },
                           &bin);
            const size_t k = bin < bins ? slots->of_bin[bin] : 0;
            if (k > 0 && slots->n[k - 1] < HINTS) {
                const size_t all = slots->count * HINTS;
                double *to = slots->hint + (k - 1) * HINTS + slots->n[k - 1]++;
                to[0] = sample[i].wi.x;
                to[all] = sample[i].wi.y;
                to[2 * all] = sample[i].wi.z;
            }
        }
    }
}

/* Where the integral of a bin fell short of what was drawn there by far, it may
 * have missed a ridge: it is taken again with drawn directions as hints.  A
 * better integral is all that this can give, so a sampler that is wrong stays
 * wrong.  False when out of memory. */
static bool look_again(struct subject *s, double tolerance)
{
    struct survey *v = &s->survey;
    const size_t bins = partition_bins(v->partition);
    struct slots slots = { .of_bin = calloc(bins, sizeof *slots.of_bin) };
    struct bsdf_sample *sample = malloc(BATCH * sizeof *sample);
    for (size_t i = 0; slots.of_bin && i < bins; i++) {
        const double expected =
            (v->mass[i].value + v->mass[i].error) * (double)v->samples;
        if ((double)v->count[i] > expected + 4 * sqrt(expected) + 0.5)
            slots.of_bin[i] = ++slots.count;
    }
    slots.hint = malloc((3 * slots.count * HINTS + 1) * sizeof *slots.hint);
    slots.n = calloc(slots.count + 1, sizeof *slots.n);
    struct patch_job *job = malloc((slots.count + 1) * sizeof *job);
    bool ok = slots.of_bin && sample && slots.hint && slots.n && job;
    if (ok && slots.count > 0) {
        long budget = mass_budget;
        slots_fill(s, &slots, sample);
        for (size_t i = 0; i < bins; i++) {
            const size_t k = slots.of_bin[i];
            if (k == 0)
                continue;
            v->mass[i] = (struct estimate){ 0, 0 };
            job[k - 1] = (struct patch_job){ partition_patch(v->partition, i),
                                             slots_at(&slots, (k - 1) * HINTS),
                                             slots.n[k - 1], &v->mass[i] };
        }
        ok = patches_integrate(pdf_at, s, 1, job, slots.count, NULL, NULL,
                               tolerance, subject_batch(s), &budget);
    }
    free(job);
    free(slots.n);
    free(slots.hint);
    free(sample);
    free(slots.of_bin);
    return ok;
}

/* Up to PILOTS directions on each side; more are drawn than usual where few of
 * them come on a side that has any, lest a rare lobe be lost.  NULL when out of
 * memory. */
static struct vec3 *pilots_draw(struct subject *s, size_t *n)
{
    enum { ENOUGH = 500, ROUNDS = 64 };
    const struct rng rng = subject_rng(s, STREAM_PILOT);
    const unsigned lobes = s->claims.lobes & ~(unsigned)BSDF_DELTA;
    struct vec3 *pilot = malloc((2 * PILOTS + TAILS) * sizeof *pilot);
    struct bsdf_sample *sample = malloc(BATCH * sizeof *sample);
    size_t count[2] = { 0, 0 };
    bool rare = true;
    *n = 0;
    for (uint64_t at = 0; pilot && sample && at < ROUNDS * PILOTS;
         at += BATCH) {
        if (at >= PILOTS && !rare)
            break;
        subject_draw(s, rng, at, BATCH, sample);
        for (size_t i = 0; i < BATCH; i++) {
            const bool through = sample[i].wi.z * s->wo.z < 0;
            const double w = largest(s, &sample[i]);
            if (isfinite(w))
                s->survey.cap = fmax(s->survey.cap, 1.25 * w);
            if (!subject_spread(&sample[i]) ||
                !(vec3_dot(sample[i].wi, sample[i].wi) > 0.5) ||
                count[through] == PILOTS)
                continue;
            count[through]++;
            pilot[(*n)++] = sample[i].wi;
        }
        rare = ((lobes & BSDF_REFLECTION) && count[0] < ENOUGH) ||
               ((lobes & BSDF_TRANSMISSION) && count[1] < ENOUGH);
    }
    if (!sample) {
        free(pilot);
        pilot = NULL;
    }
    free(sample);
    return pilot;
}

/* Directions drawn with one of the first two numbers close to an end, by 2^-1
 * to 2^-40: where a lobe has its tails, and no pilot comes.  Returns how many
 * of TAILS there are; 0 when out of memory. */
static size_t tails_draw(const struct subject *s, struct vec3 *tail)
{
    const struct rng rng = subject_rng(s, STREAM_TAILS);
    struct bsdf_sample *sample = malloc(TAILS * sizeof *sample);
    double u[3][TAILS];
    size_t n = 0;
    for (size_t i = 0; i < TAILS; i++) {
        const struct vec3 v = rng_uniform(rng, i);
        const double small = exp2(-1 - 39 * v.x);
        u[0][i] = v.y, u[1][i] = v.y, u[2][i] = v.z;
        u[i % 2][i] = i / 2 % 2 ? small : 1 - small;
    }
    if (sample)
        subject_sample(s, TAILS, (struct dirs){ u[0], u[1], u[2] }, sample);
    for (size_t i = 0; sample && i < TAILS; i++)
        if (subject_spread(&sample[i]) &&
            vec3_dot(sample[i].wi, sample[i].wi) > 0.5)
            tail[n++] = sample[i].wi;
    free(sample);
    return n;
}

bool survey_make(struct subject *s, struct err *err)
{
    struct survey *v = &s->survey;
    size_t n;
    struct vec3 *pilot = pilots_draw(s, &n);
    if (pilot) {
        v->partition = partition_new(pilot, n, tails_draw(s, pilot + n));
        v->rounding = subject_typical_rounding(s, pilot, n, true);
    }
    free(pilot);
    const size_t bins = v->partition ? partition_bins(v->partition) : 1;
    v->mass = calloc(bins, sizeof *v->mass);
    v->count = calloc(bins + 1, sizeof *v->count); /* and for none */
    /* What rounding puts off a full bin, no rule can agree on; the bound is
     * of a whole, and so of every part of it. */
    const double tolerance = mass_tolerance + v->rounding / 400;
    if (!v->partition || !v->mass || !v->count ||
        !partition_integrate(v->partition, pdf_at, s, 1, tolerance,
                             subject_batch(s), mass_budget, v->mass) ||
        !samples_draw(s) || !look_again(s, tolerance)) {
        survey_clear(v);
        return err_set(err, "out of memory");
    }
    for (size_t i = 0; i < bins; i++) {
        v->mass[i].error += v->rounding * fabs(v->mass[i].value);
        v->total = estimate_add(v->total, v->mass[i]);
    }
    v->total.error += survey_unknown * v->total.value;
    return true;
}

void survey_clear(struct survey *v)
{
    partition_free(v->partition);
    free(v->mass);
    free(v->count);
    *v = (struct survey){ 0 };
}

struct estimate survey_refusal(const struct survey *v)
{
    struct estimate left = { 1 - v->total.value, v->total.error };
    for (int k = 0; k < v->deltas; k++)
        left.value -= v->delta[k].pdf;
    return left;
}
