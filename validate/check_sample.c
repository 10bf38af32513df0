/* check_sample.c - a sample says of itself what the model says of it
 *
 *   pdf = pdf(wo, wi),  weight = f(wo, wi) |cos_i| / pdf
 *
 * relative to the largest band, within 1e-7 (subject_precision) and what
 * rounding explains, for as many as 131,072 samples.
 * Chi-square tests never look at weights; this one does.
 */
#include "validate/checks.h"

#include <stdio.h>
#include <stdlib.h>

enum { DRAWS_MAX = 131072, BATCH = SUBJECT_BATCH, ENDS = 5 };

struct room {
    struct bsdf_sample sample[BATCH];
    struct spectrum f[BATCH];
    double x[BATCH], y[BATCH], z[BATCH], pdf[BATCH];
};

/* Keeps the deviation that exceeds its limit most.  The limit costs further
 * calls, and is at least the precision. */
static void keep(const struct subject *s, struct verdict *v, struct vec3 wi,
                 const char *what, double off, bool of_f, double got,
                 double expected)
{
    const double best = v->value / v->limit, precision = subject_precision(s);
    if (!(off / precision > best) && !isnan(off))
        return;
    double limit = precision + subject_rounding(s, wi, true);
    if (of_f)
        limit += subject_rounding(s, wi, false);
    if (!(off / limit > best) && !isnan(off))
        return;
    v->value = off;
    v->limit = limit;
    v->wi = wi;
    v->has_wi = true;
    verdict_note(v, "worst %s %.10g, expected %.10g", what, got, expected);
}

static void sample_check(const struct subject *s, struct verdict *v,
                         const struct bsdf_sample *a, double pdf,
                         struct spectrum f)
{
    if (isnan(v->value))
        return;
    keep(s, v, a->wi, "pdf", fabs(a->pdf - pdf) / fmax(a->pdf, pdf), false,
         a->pdf, pdf);
    double most = 0;
    for (int b = 0; b < BANDS_MAX; b++) {
        most = fmax(most, f.band[b] * fabs(a->wi.z) / a->pdf);
        most = fmax(most, a->weight.band[b]);
    }
    for (int b = 0; b < BANDS_MAX && !isnan(v->value); b++) {
        const double expected = f.band[b] * fabs(a->wi.z) / a->pdf;
        const double off = fabs(a->weight.band[b] - expected);
        if (off != 0) /* so is a NaN, which `most` does not see */
            keep(s, v, a->wi, "weight", off / most, true, a->weight.band[b],
                 expected);
    }
}

/* n samples that were drawn, without the deltas and the refused. */
static void check_drawn(const struct subject *s, struct verdict *v,
                        struct room *r, size_t n)
{
    size_t spread = 0;
    for (size_t i = 0; i < n; i++)
        if (!r->sample[i].delta && r->sample[i].pdf != 0) {
            const struct bsdf_sample a = r->sample[spread++] = r->sample[i];
            r->x[spread - 1] = a.wi.x, r->y[spread - 1] = a.wi.y;
            r->z[spread - 1] = a.wi.z;
        }
    const struct dirs wi = { r->x, r->y, r->z };
    subject_eval(s, spread, wi, r->f);
    subject_pdf(s, spread, wi, r->pdf);
    for (size_t i = 0; i < spread; i++)
        sample_check(s, v, &r->sample[i], r->pdf[i], r->f[i]);
}

static void run(const struct subject *s, struct verdict *v)
{
    static const double end[] = { 0, 0x1p-53, 0.5, 1 - 0x1p-24, 1 - 0x1p-53 };
    if (!(s->claims.lobes & ~(unsigned)BSDF_DELTA)) {
        v->applies = false;
        verdict_note(v, "only delta lobes");
        return;
    }
    struct room *r = malloc(sizeof *r);
    v->unit = "relative";
    v->limit = subject_precision(s);
    if (!r) {
        v->value = NAN;
        verdict_note(v, "out of memory");
        return;
    }
    double x[ENDS * ENDS], y[ENDS * ENDS], z[ENDS * ENDS];
    for (int i = 0; i < ENDS * ENDS; i++)
        x[i] = end[i % ENDS], y[i] = end[i / ENDS], z[i] = 0.5;
    subject_sample(s, ENDS * ENDS, (struct dirs){ x, y, z }, r->sample);
    check_drawn(s, v, r, ENDS * ENDS);

    const uint64_t draws = s->samples < DRAWS_MAX ? s->samples : DRAWS_MAX;
    for (uint64_t at = 0; at < draws; at += BATCH) {
        const size_t n = draws - at < BATCH ? (size_t)(draws - at) : BATCH;
        subject_draw(s, subject_rng(s, STREAM_SAMPLE), at, n, r->sample);
        check_drawn(s, v, r, n);
    }
    free(r);
    verdict_found(v, "a pdf or weight wrong by %.1g %%, one in %.2g",
                  100 * v->limit, (double)draws / log(100));
}

const struct check check_sample = {
    .name = "sample",
    .about = "a sample's pdf is pdf(), its weight f |cos| / pdf",
    .run = run,
};
