/* check_finite.c - numbers, everywhere
 *
 * f and pdf are finite and not negative, a sample is a unit direction with a
 * finite weight and a density that is not 0, to the edges of the domain: the
 * normal, cosines of 1e-8, the horizon, below it, wi = wo, wi = -wo, and random
 * numbers at both ends of [0, 1); and the same when asked again.  value counts
 * what is not.
 */
#include "validate/checks.h"

#include <stdio.h>

struct tally {
    const struct subject *s;
    struct verdict *v;
};

static void bad(struct tally *t, struct vec3 wo, struct vec3 wi,
                const char *what, double value)
{
    struct verdict *v = t->v;
    v->value += 1;
    if (v->value > 1)
        return;
    v->wo = wo;
    v->wi = wi;
    v->has_wi = true;
    verdict_note(v, "first: %s = %g", what, value);
}

static bool good(double x)
{
    return isfinite(x) && x >= 0;
}

static void value_check(struct tally *t, struct vec3 wo, struct vec3 wi)
{
    const struct spectrum f = bsdf_eval(t->s->bsdf, wo, wi);
    const double pdf = bsdf_pdf(t->s->bsdf, wo, wi);
    for (int b = 0; b < BANDS_MAX; b++)
        if (!good(f.band[b]))
            bad(t, wo, wi, "f", f.band[b]);
    if (!good(pdf))
        bad(t, wo, wi, "pdf", pdf);
}

static void sample_check(struct tally *t, struct vec3 wo, struct vec3 u)
{
    const struct bsdf_sample a = bsdf_sample(t->s->bsdf, wo, u);
    char what[80];
    snprintf(what, sizeof what, "for u = (%.17g, %.17g) the sample's", u.x,
             u.y);
    const struct bsdf_sample again = bsdf_sample(t->s->bsdf, wo, u);
    char name[128];
    bool carries = false;
    for (int b = 0; b < BANDS_MAX; b++) {
        carries |= a.weight.band[b] > 0;
        snprintf(name, sizeof name, "%s weight", what);
        if (!good(a.weight.band[b]))
            bad(t, wo, a.wi, name, a.weight.band[b]);
    }
    snprintf(name, sizeof name, "%s pdf", what);
    if (!good(a.pdf) || (carries && !(a.pdf > 0)))
        bad(t, wo, a.wi, name, a.pdf);
    snprintf(name, sizeof name, "%s |wi|", what);
    if (a.pdf > 0 && !(fabs(vec3_length(a.wi) - 1) <= subject_unit_error))
        bad(t, wo, a.wi, name, vec3_length(a.wi));
    snprintf(name, sizeof name, "%s pdf, another one when asked again,", what);
    if (again.pdf != a.pdf || again.wi.x != a.wi.x || again.wi.z != a.wi.z)
        bad(t, wo, a.wi, name, a.pdf);
}

static void run(const struct subject *s, struct verdict *v)
{
    /* 1e-8 is a cosine; its sine is 1 to the last bit. */
    const struct vec3 wo = s->wo;
    const struct vec3 edge[] = {
        wo,
        { -wo.x, -wo.y, wo.z },
        { wo.x, wo.y, -wo.z },
        { -wo.x, -wo.y, -wo.z },
        { 0, 0, 1 },
        { 0, 0, -1 },
        { 1e-8, 0, 1 },
        { 1, 0, 1e-8 },
        { -1, 0, 1e-8 },
        { -0.6, 0.8, 1e-8 },
        { 0.6, 0.8, -1e-8 },
        { 1, 0, 0 },
        { -1, 0, 0 },
        { 0.6, -0.8, 0 },
        { 0.36, 0.48, 0.8 },
    };
    enum { EDGES = sizeof edge / sizeof *edge, ENDS = 6 };
    const double end[ENDS] = { 0,   0x1p-53,     0x1p-30,
                               0.5, 1 - 0x1p-24, 1 - 0x1p-53 };
    struct tally t = { s, v };
    v->unit = "bad values";
    v->limit = 0;
    for (int o = 0; o < EDGES; o++) {
        for (int i = 0; i < EDGES; i++)
            value_check(&t, edge[o], edge[i]);
        for (int i = 0; i < ENDS * ENDS; i++)
            sample_check(&t, edge[o],
                         (struct vec3){ end[i % ENDS], end[i / ENDS],
                                        end[(i + 2) % ENDS] });
    }
    const struct rng rng = subject_rng(s, STREAM_PAIRS);
    for (uint64_t i = 0; i < 1024; i++) {
        const struct bsdf_sample a =
            bsdf_sample(s->bsdf, wo, rng_uniform(rng, i));
        sample_check(&t, wo, rng_uniform(rng, i));
        if (a.pdf > 0)
            value_check(&t, wo, a.wi);
    }
    if (s->survey.bad > 0) {
        const struct bsdf_sample *a = &s->survey.first_bad;
        bad(&t, wo, a->wi, "one of the drawn samples has the pdf", a->pdf);
        v->value += (double)s->survey.bad - 1;
    }
    if (v->value == 0)
        verdict_note(v, "%d pairs of edges, %d samples at edges, %llu drawn",
                     EDGES * EDGES, EDGES * ENDS * ENDS,
                     (unsigned long long)s->survey.samples);
}

const struct check check_finite = {
    .name = "finite",
    .about = "f, pdf and samples are finite and not negative to the edges",
    .run = run,
};
