/* subject.c - pilots, bins, masses, and the one pass of samples */
#include "validate/subject.h"

#include <stdlib.h>
#include <string.h>

#include "bsdf/frame.h"

enum { PILOTS = 16384, BATCH = 256 };

/* Leaves of this accuracy, some thousands of them, keep the whole within 1e-7;
 * the bound that is carried along says how well it went. */
static const double mass_tolerance = 1e-10, energy_tolerance = 1e-9;

/* What the rules differ by is no bound where a kink crosses the mesh, as the
 * root in F at the critical angle does: 4e-8 were seen there against 1.4e-8.
 * So much is always taken to be unknown of a whole. */
static const double unknown = 1e-7;
static const long mass_budget = 20000000;

const struct plan plan_default = { .seed = 1,
                                   .samples = 1000000,
                                   .significance = 1e-6 };

/* FNV-1a, 64 bits: G. Fowler, L. Noll and K.-P. Vo, 1991. */
static uint64_t hash(uint64_t h, const void *data, size_t size)
{
    for (const unsigned char *p = data; size-- > 0; p++)
        h = (h ^ *p) * 0x100000001b3;
    return h;
}

struct rng subject_rng(const struct subject *s, enum stream purpose)
{
    const char *spec = bsdf_spec(s->bsdf);
    const unsigned char tag = (unsigned char)purpose;
    uint64_t h = hash(0xcbf29ce484222325, spec, strlen(spec));
    h = hash(h, &s->wo, sizeof s->wo);
    return (struct rng){ s->plan->seed, hash(h, &tag, 1) };
}

const double subject_precision = 1e-7;
const double subject_unit_error = 1e-9;

/* n at most BATCH. */
static void draw(const struct subject *s, struct rng rng, uint64_t from,
                 size_t n, struct bsdf_sample *out)
{
    double wx[BATCH], wy[BATCH], wz[BATCH], x[BATCH], y[BATCH], z[BATCH];
    rng_uniform_many(rng, from, n, x, y, z);
    for (size_t i = 0; i < n; i++)
        wx[i] = s->wo.x, wy[i] = s->wo.y, wz[i] = s->wo.z;
    bsdf_sample_many(s->bsdf, n, (struct dirs){ wx, wy, wz },
                     (struct dirs){ x, y, z }, out);
}

bool subject_refused(const struct bsdf_sample *a)
{
    return a->pdf == 0 && spectrum_is(a->weight, BANDS_MAX, 0);
}

void subject_draw(const struct subject *s, struct rng rng, uint64_t from,
                  size_t n, struct bsdf_sample *out)
{
    for (size_t at = 0; at < n; at += BATCH)
        draw(s, rng, from + at, n - at < BATCH ? n - at : BATCH, out + at);
}

/* What no sample may be, whatever the model. */
static bool bad(const struct bsdf_sample *a)
{
    for (int b = 0; b < BANDS_MAX; b++)
        if (!(a->weight.band[b] >= 0 && isfinite(a->weight.band[b])))
            return true;
    return !isfinite(a->pdf) || (!subject_refused(a) &&
                                 !(a->pdf > 0 && fabs(vec3_length(a->wi) - 1) <=
                                                     subject_unit_error));
}

static double difference(const struct delta *d, const struct bsdf_sample *a)
{
    const struct vec3 off = vec3_add(a->wi, vec3_scale(-1, d->wi));
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
        if (vec3_length(vec3_add(a->wi, vec3_scale(-1, d->wi))) < 1e-6) {
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

static void survey_sample(struct subject *s)
{
    struct survey *v = &s->survey;
    const struct rng rng = subject_rng(s, STREAM_SURVEY);
    const size_t bins = partition_bins(v->partition);
    struct bsdf_sample batch[BATCH];
    v->samples = s->plan->samples;
    for (uint64_t at = 0; at < v->samples; at += BATCH) {
        const uint64_t left = v->samples - at;
        const size_t n = left < BATCH ? (size_t)left : BATCH;
        draw(s, rng, at, n, batch);
        for (size_t i = 0; i < n; i++) {
            if (bad(&batch[i]) && v->bad++ == 0)
                v->first_bad = batch[i];
            if (subject_refused(&batch[i])) {
                v->refused++;
            } else if (batch[i].delta) {
                delta_count(v, &batch[i]);
            } else {
                const size_t bin = partition_bin(v->partition, batch[i].wi);
                if (bin < bins)
                    v->count[bin]++;
                else
                    v->stray++;
            }
        }
    }
}

/* The same wo for n directions. */
struct many {
    const struct subject *s;
    double x[BATCH], y[BATCH], z[BATCH];
};

static struct dirs many_wo(struct many *m, const struct subject *s, size_t n)
{
    m->s = s;
    for (size_t i = 0; i < n; i++)
        m->x[i] = s->wo.x, m->y[i] = s->wo.y, m->z[i] = s->wo.z;
    return (struct dirs){ m->x, m->y, m->z };
}

static void pdf_at(const void *context, size_t n, struct dirs w, double *value)
{
    struct many m;
    const struct subject *s = context;
    bsdf_pdf_many(s->bsdf, n, many_wo(&m, s, n), w, value);
}

double subject_compression(const struct subject *s, struct vec3 wi)
{
    const double eta = bsdf_claims(s->bsdf).eta;
    return wi.z * s->wo.z >= 0 ? 1 : s->wo.z > 0 ? eta * eta : 1 / (eta * eta);
}

/* The bands, and behind them what cannot be sampled. */
static void energy_at(const void *context, size_t n, struct dirs w,
                      double *value)
{
    struct many m;
    const struct subject *s = context;
    struct spectrum f[BATCH];
    double pdf[BATCH];
    const struct dirs wo = many_wo(&m, s, n);
    bsdf_eval_many(s->bsdf, n, wo, w, f);
    bsdf_pdf_many(s->bsdf, n, wo, w, pdf);
    const int bands = bsdf_bands(s->bsdf)->count;
    for (size_t i = 0; i < n; i++) {
        const double scale =
            fabs(w.z[i]) * subject_compression(s, dirs_at(w, i));
        double most = 0;
        for (int b = 0; b < bands; b++) {
            value[(size_t)b * n + i] = f[i].band[b] * scale;
            most = fmax(most, f[i].band[b] * scale);
        }
        value[(size_t)bands * n + i] = pdf[i] > 0 ? 0 : most;
    }
}

/* Where the integral of a bin fell short of what was drawn there by far, it may
 * have missed a ridge: it is taken again with drawn directions as hints.  A
 * better integral is all that this can give, so a sampler that is wrong stays
 * wrong.  False when out of memory. */
static bool survey_look_again(struct subject *s)
{
    enum { HINTS = 64 };
    struct survey *v = &s->survey;
    const size_t bins = partition_bins(v->partition);
    const struct rng rng = subject_rng(s, STREAM_SURVEY);
    struct bsdf_sample batch[BATCH];
    size_t *slot = calloc(bins, sizeof *slot), slots = 0;
    for (size_t i = 0; slot && i < bins; i++) {
        const double expected =
            (v->mass[i].value + v->mass[i].error) * (double)v->samples;
        if ((double)v->count[i] > expected + 4 * sqrt(expected + 4))
            slot[i] = ++slots;
    }
    struct vec3 *hint = malloc((slots * HINTS + 1) * sizeof *hint);
    size_t *n = calloc(slots + 1, sizeof *n);
    const bool ok = slot && hint && n;
    for (uint64_t at = 0; ok && slots > 0 && at < v->samples; at += BATCH) {
        const uint64_t left = v->samples - at;
        const size_t count = left < BATCH ? (size_t)left : BATCH;
        draw(s, rng, at, count, batch);
        for (size_t i = 0; i < count; i++) {
            if (subject_refused(&batch[i]) || batch[i].delta)
                continue;
            const size_t bin = partition_bin(v->partition, batch[i].wi);
            const size_t k = bin < bins ? slot[bin] : 0;
            if (k > 0 && n[k] < HINTS)
                hint[(k - 1) * HINTS + n[k]++] = batch[i].wi;
        }
    }
    long budget = mass_budget;
    for (size_t i = 0; ok && i < bins; i++)
        if (slot[i] > 0)
            partition_integrate_bin(
                v->partition, i, pdf_at, s, 1, mass_tolerance, &budget,
                hint + (slot[i] - 1) * HINTS, n[slot[i]], &v->mass[i]);
    free(slot);
    free(hint);
    free(n);
    return ok;
}

/* Up to PILOTS directions on each side; more are drawn than usual where few of
 * them come on a side that has any, lest a rare lobe be lost. */
static struct vec3 *pilots_draw(const struct subject *s, size_t *n)
{
    enum { ENOUGH = 500, ROUNDS = 64 };
    const struct rng rng = subject_rng(s, STREAM_PILOT);
    const unsigned lobes = bsdf_claims(s->bsdf).lobes & ~(unsigned)BSDF_DELTA;
    struct vec3 *pilot = malloc(2 * PILOTS * sizeof *pilot);
    struct bsdf_sample batch[BATCH];
    size_t count[2] = { 0, 0 };
    bool rare = true;
    *n = 0;
    for (uint64_t at = 0; pilot && at < ROUNDS * PILOTS; at += BATCH) {
        if (at >= PILOTS && !rare)
            break;
        draw(s, rng, at, BATCH, batch);
        for (size_t i = 0; i < BATCH; i++) {
            const bool through = batch[i].wi.z * s->wo.z < 0;
            if (subject_refused(&batch[i]) || batch[i].delta ||
                !(vec3_dot(batch[i].wi, batch[i].wi) > 0.5) ||
                count[through] == PILOTS)
                continue;
            count[through]++;
            pilot[(*n)++] = batch[i].wi;
        }
        rare = ((lobes & BSDF_REFLECTION) && count[0] < ENOUGH) ||
               ((lobes & BSDF_TRANSMISSION) && count[1] < ENOUGH);
    }
    return pilot;
}

bool subject_init(struct subject *s, const struct bsdf *b, struct vec3 wo,
                  const struct plan *plan, struct err *err)
{
    *s = (struct subject){ .bsdf = b, .wo = wo, .plan = plan };
    struct survey *v = &s->survey;
    size_t n;
    struct vec3 *pilot = pilots_draw(s, &n);
    v->partition = pilot ? partition_new(pilot, n) : NULL;
    free(pilot);
    const size_t bins = v->partition ? partition_bins(v->partition) : 1;
    v->mass = calloc(bins, sizeof *v->mass);
    v->count = calloc(bins, sizeof *v->count);
    if (!v->partition || !v->mass || !v->count) {
        subject_clear(s);
        return err_set(err, "out of memory");
    }
    partition_integrate(v->partition, pdf_at, s, 1, mass_tolerance, mass_budget,
                        v->mass);
    survey_sample(s);
    if (!survey_look_again(s)) {
        subject_clear(s);
        return err_set(err, "out of memory");
    }
    for (size_t i = 0; i < bins; i++)
        v->total = estimate_add(v->total, v->mass[i]);
    v->total.error += unknown * v->total.value;
    return true;
}

void subject_clear(struct subject *s)
{
    partition_free(s->survey.partition);
    free(s->survey.mass);
    free(s->survey.count);
    s->survey = (struct survey){ 0 };
}

struct estimate survey_refusal(const struct survey *v)
{
    struct estimate left = { 1 - v->total.value, v->total.error };
    for (int k = 0; k < v->deltas; k++)
        left.value -= v->delta[k].pdf;
    return left;
}

double subject_rounding(const struct subject *s, struct vec3 wi, bool of_pdf)
{
    const double step = 0x1p-40;
    const struct frame frame = frame_about(wi);
    const struct vec3 at[3] = {
        wi,
        vec3_unit(vec3_add(wi, vec3_scale(step, frame.s))),
        vec3_unit(vec3_add(wi, vec3_scale(step, frame.t))),
    };
    double value[3], most = 0;
    for (int i = 0; i < 3; i++) {
        if (of_pdf) {
            value[i] = bsdf_pdf(s->bsdf, s->wo, at[i]);
            continue;
        }
        const struct spectrum f = bsdf_eval(s->bsdf, s->wo, at[i]);
        value[i] = 0;
        for (int b = 0; b < BANDS_MAX; b++)
            value[i] = fmax(value[i], f.band[b]);
    }
    for (int i = 1; i < 3; i++)
        most = fmax(most, fabs(value[i] / value[0] - 1));
    return fmin(16 * 0x1p-52 / step * most, 0.5);
}

/* The median of the rounding over drawn directions, as f is rounded anew at
 * every node. */
static double typical_rounding(const struct subject *s)
{
    enum { DRAWS = 65 };
    struct bsdf_sample sample[DRAWS];
    double off[DRAWS];
    size_t n = 0;
    draw(s, subject_rng(s, STREAM_PAIRS), 0, DRAWS, sample);
    for (size_t i = 0; i < DRAWS; i++) {
        if (subject_refused(&sample[i]) || sample[i].delta)
            continue;
        const double r = subject_rounding(s, sample[i].wi, false);
        size_t at = n++;
        for (; at > 0 && off[at - 1] > r; at--)
            off[at] = off[at - 1];
        off[at] = r;
    }
    return n ? off[n / 2] : 0;
}

void subject_albedo(const struct subject *s, struct estimate albedo[BANDS_MAX],
                    struct estimate *unsampled)
{
    const struct survey *v = &s->survey;
    const int bands = bsdf_bands(s->bsdf)->count, parts = bands + 1;
    const size_t bins = partition_bins(v->partition);
    const double rounding = 0x1p-48 + typical_rounding(s);
    struct estimate sum[BANDS_MAX + 1] = { { 0, 0 } };
    struct estimate *part = malloc(bins * (size_t)parts * sizeof *part);
    if (part)
        partition_integrate(v->partition, energy_at, s, parts, energy_tolerance,
                            mass_budget, part);
    for (int b = 0; b < parts; b++)
        for (size_t i = 0; i < bins; i++)
            sum[b] =
                estimate_add(sum[b], part ? part[i * (size_t)parts + (size_t)b]
                                          : (struct estimate){ NAN, NAN });
    free(part);
    *unsampled = sum[bands];
    for (int b = 0; b < bands; b++) {
        albedo[b] = sum[b];
        albedo[b].error += unknown * sum[b].value;
        for (int k = 0; k < v->deltas; k++)
            albedo[b].value += v->delta[k].pdf * v->delta[k].weight.band[b] *
                               subject_compression(s, v->delta[k].wi);
        albedo[b].error += rounding * fabs(albedo[b].value);
    }
}
