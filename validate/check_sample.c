/* check_sample.c - a sample says of itself what the model says of it
 *
 *   pdf = pdf(wo, wi),  weight = f(wo, wi) |cos_i| / pdf
 *
 * relative to the largest band, within 1e-7 (subject_precision) and what
 * rounding explains.
 * Chi-square tests never look at weights; this one does.
 */
#include "validate/checks.h"

#include <stdio.h>

enum { DRAWS = 4096 };

/* Keeps the deviation that exceeds its limit most. */
static void keep(struct verdict *v, struct vec3 wi, const char *what,
                 double off, double limit, double got, double expected)
{
    const double excess = off / limit;
    if (!(excess > v->value / v->limit) && !isnan(off))
        return;
    v->value = off;
    v->limit = limit;
    v->wi = wi;
    v->has_wi = true;
    verdict_note(v, "worst %s %.10g, expected %.10g", what, got, expected);
}

static void sample_check(const struct subject *s, struct verdict *v,
                         struct vec3 u)
{
    const struct bsdf_sample a = bsdf_sample(s->bsdf, s->wo, u);
    if (a.delta || isnan(v->value) || a.pdf == 0)
        return;
    const double pdf = bsdf_pdf(s->bsdf, s->wo, a.wi);
    const double rounding = subject_rounding(s, a.wi, true);
    keep(v, a.wi, "pdf", fabs(a.pdf - pdf) / fmax(a.pdf, pdf),
         subject_precision + rounding, a.pdf, pdf);

    const struct spectrum f = bsdf_eval(s->bsdf, s->wo, a.wi);
    double most = 0;
    for (int b = 0; b < BANDS_MAX; b++) {
        most = fmax(most, f.band[b] * fabs(a.wi.z) / a.pdf);
        most = fmax(most, a.weight.band[b]);
    }
    const double limit =
        subject_precision + rounding + subject_rounding(s, a.wi, false);
    for (int b = 0; b < BANDS_MAX; b++) {
        const double expected = f.band[b] * fabs(a.wi.z) / a.pdf;
        const double off = fabs(a.weight.band[b] - expected);
        if (off != 0) /* so is a NaN, which `most` does not see */
            keep(v, a.wi, "weight", off / most, limit, a.weight.band[b],
                 expected);
    }
}

static void run(const struct subject *s, struct verdict *v)
{
    static const double end[] = { 0, 0x1p-53, 0.5, 1 - 0x1p-24, 1 - 0x1p-53 };
    enum { ENDS = sizeof end / sizeof *end };
    if (!(bsdf_claims(s->bsdf).lobes & ~(unsigned)BSDF_DELTA)) {
        v->applies = false;
        verdict_note(v, "only delta lobes");
        return;
    }
    v->unit = "relative";
    v->limit = subject_precision;
    const struct rng rng = subject_rng(s, STREAM_SAMPLE);
    for (uint64_t i = 0; i < DRAWS; i++)
        sample_check(s, v, rng_uniform(rng, i));
    for (int i = 0; i < ENDS * ENDS; i++)
        sample_check(s, v, (struct vec3){ end[i % ENDS], end[i / ENDS], 0.5 });
}

const struct check check_sample = {
    .name = "sample",
    .about = "a sample's pdf is pdf(), its weight f |cos| / pdf",
    .run = run,
};
