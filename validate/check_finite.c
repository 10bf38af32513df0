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
#include <stdlib.h>

enum { EDGES = 15, ENDS = 6, DRAWS = 1024 };
enum { SAMPLES = EDGES * ENDS * ENDS + DRAWS, PAIRS = EDGES * EDGES + DRAWS };

/* Pairs of directions, or directions and random numbers, and the answers. */
struct questions {
    double wo[3][SAMPLES], other[3][SAMPLES];
    size_t n;
    struct bsdf_sample sample[SAMPLES], again[SAMPLES];
    struct spectrum f[PAIRS];
    double pdf[PAIRS];
};

static void ask(struct questions *q, struct vec3 wo, struct vec3 other)
{
    q->wo[0][q->n] = wo.x, q->wo[1][q->n] = wo.y, q->wo[2][q->n] = wo.z;
    q->other[0][q->n] = other.x, q->other[1][q->n] = other.y;
    q->other[2][q->n++] = other.z;
}

static struct dirs dirs_of(double (*d)[SAMPLES])
{
    return (struct dirs){ d[0], d[1], d[2] };
}

static void bad(struct verdict *v, struct vec3 wo, struct vec3 wi,
                const char *what, double value)
{
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

static void values_check(const struct subject *s, struct verdict *v,
                         struct questions *q)
{
    const struct dirs wo = dirs_of(q->wo), wi = dirs_of(q->other);
    bsdf_eval_many(s->bsdf, q->n, wo, wi, q->f);
    bsdf_pdf_many(s->bsdf, q->n, wo, wi, q->pdf);
    for (size_t i = 0; i < q->n; i++) {
        for (int b = 0; b < BANDS_MAX; b++)
            if (!good(q->f[i].band[b]))
                bad(v, dirs_at(wo, i), dirs_at(wi, i), "f", q->f[i].band[b]);
        if (!good(q->pdf[i]))
            bad(v, dirs_at(wo, i), dirs_at(wi, i), "pdf", q->pdf[i]);
    }
}

static void sample_check(const struct subject *s, struct verdict *v,
                         const struct questions *q, size_t i)
{
    const struct bsdf_sample a = q->sample[i], again = q->again[i];
    const struct vec3 wo = dirs_at(dirs_of((double(*)[SAMPLES])q->wo), i);
    char what[80], name[128];
    bool carries = false;
    snprintf(what, sizeof what, "for u = (%.17g, %.17g) the sample's",
             q->other[0][i], q->other[1][i]);
    for (int b = 0; b < BANDS_MAX; b++) {
        carries |= a.weight.band[b] > 0;
        snprintf(name, sizeof name, "%s weight", what);
        if (!good(a.weight.band[b]))
            bad(v, wo, a.wi, name, a.weight.band[b]);
    }
    snprintf(name, sizeof name, "%s pdf", what);
    if (!good(a.pdf) || (carries && !(a.pdf > 0)))
        bad(v, wo, a.wi, name, a.pdf);
    snprintf(name, sizeof name, "%s |wi|", what);
    if (a.pdf > 0 && !(fabs(vec3_length(a.wi) - 1) <= subject_unit_error(s)))
        bad(v, wo, a.wi, name, vec3_length(a.wi));
    snprintf(name, sizeof name, "%s pdf, another one when asked again,", what);
    if (again.pdf != a.pdf || again.wi.x != a.wi.x || again.wi.z != a.wi.z)
        bad(v, wo, a.wi, name, a.pdf);
}

/* The drawn ones are last; their directions are new pairs. */
static void samples_check(const struct subject *s, struct verdict *v,
                          struct questions *q)
{
    const struct dirs wo = dirs_of(q->wo), u = dirs_of(q->other);
    const size_t n = q->n;
    bsdf_sample_many(s->bsdf, n, wo, u, q->sample);
    bsdf_sample_many(s->bsdf, n, wo, u, q->again);
    for (size_t i = 0; i < n; i++)
        sample_check(s, v, q, i);
    q->n = 0;
    for (size_t i = n - DRAWS; i < n; i++)
        if (q->sample[i].pdf > 0)
            ask(q, s->wo, q->sample[i].wi);
}

static void run(const struct subject *s, struct verdict *v)
{
    /* 1e-8 is a cosine; its sine is 1 to the last bit. */
    const struct vec3 wo = s->wo;
    const struct vec3 edge[EDGES] = {
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
    const double end[ENDS] = { 0,   0x1p-53,     0x1p-30,
                               0.5, 1 - 0x1p-24, 1 - 0x1p-53 };
    struct questions *q = malloc(sizeof *q);
    v->unit = "bad values";
    v->limit = 0;
    if (!q) {
        v->value = NAN;
        verdict_note(v, "out of memory");
        return;
    }
    q->n = 0;
    for (int o = 0; o < EDGES; o++)
        for (int i = 0; i < ENDS * ENDS; i++)
            ask(q, edge[o],
                (struct vec3){ end[i % ENDS], end[i / ENDS],
                               end[(i + 2) % ENDS] });
    const struct rng rng = subject_rng(s, STREAM_PAIRS);
    for (uint64_t i = 0; i < DRAWS; i++)
        ask(q, wo, rng_uniform(rng, i));
    samples_check(s, v, q);
    for (int i = 0; i < EDGES * EDGES; i++)
        ask(q, edge[i / EDGES], edge[i % EDGES]);
    values_check(s, v, q);
    free(q);
    if (s->survey.bad > 0) {
        const struct bsdf_sample *a = &s->survey.first_bad;
        bad(v, wo, a->wi, "one of the drawn samples has the pdf", a->pdf);
        v->value += (double)s->survey.bad - 1;
    }
    if (v->value == 0)
        verdict_note(v, "%d pairs of edges, %d samples at edges, %llu drawn",
                     EDGES * EDGES, EDGES * ENDS * ENDS,
                     (unsigned long long)s->survey.samples);
    /* (1 - share)^n = 1 % */
    verdict_found(v, "a sample that is no number, one in %.2g",
                  (double)s->survey.samples / log(100));
}

const struct check check_finite = {
    .name = "finite",
    .about = "f, pdf and samples are finite and not negative to the edges",
    .run = run,
};
