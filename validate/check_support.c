/* check_support.c - nothing where the model says that nothing is
 *
 * A model without transmission is 0 for directions on the other side, in f, in
 * pdf and in what it samples; one without reflection is 0 on the same side.
 * value is the largest of f [1/sr] and pdf [1/sr] found there, or 1 for a
 * sample.
 */
#include "validate/checks.h"

#include <stdio.h>
#include <stdlib.h>

enum { DRAWS = SUBJECT_BATCH };

struct room {
    struct bsdf_sample sample[DRAWS];
    struct spectrum f[2 * DRAWS];
    double x[2 * DRAWS], y[2 * DRAWS], z[2 * DRAWS], pdf[2 * DRAWS];
    size_t n;
};

static void found(const struct subject *s, struct verdict *v, struct vec3 wi,
                  const char *what, double value)
{
    if (!(value > v->value))
        return;
    v->value = value;
    v->wi = wi;
    v->has_wi = true;
    verdict_note(v, "%s = %g on the %s side", what, value,
                 s->wo.z * wi.z < 0 ? "other" : "same");
}

static void ask(struct room *r, struct vec3 wi)
{
    r->x[r->n] = wi.x, r->y[r->n] = wi.y, r->z[r->n++] = wi.z;
}

static void look(const struct subject *s, struct verdict *v, struct room *r,
                 bool same, bool other)
{
    const struct rng rng = subject_rng(s, STREAM_PAIRS);
    const struct dirs wi = { r->x, r->y, r->z };
    subject_draw(s, rng, 0, DRAWS, r->sample);
    r->n = 0;
    for (uint64_t i = 0; i < DRAWS; i++) {
        const struct vec3 u = rng_uniform(rng, i);
        /* Half of the directions within 1e-3 of the horizon. */
        const double z = i % 2 ? u.x : u.x * 1e-3;
        const double rim = sqrt((1 - z) * (1 + z)), phi = 2 * PI * u.y;
        const double side = (s->wo.z < 0) == other ? -1 : 1;
        if (z > 0)
            ask(r, (struct vec3){ rim * cos(phi), rim * sin(phi), side * z });

        const struct bsdf_sample *a = &r->sample[i];
        const double toward = a->wi.z * s->wo.z;
        if (!(a->pdf > 0))
            continue;
        if (toward < 0 ? !other : !same)
            found(s, v, a->wi, "a sample, counted", 1);
        /* Where a lobe that is cut at the horizon would go on. */
        if (toward < 0 ? other : same)
            ask(r, (struct vec3){ a->wi.x, a->wi.y, -a->wi.z });
    }
    subject_eval(s, r->n, wi, r->f);
    subject_pdf(s, r->n, wi, r->pdf);
    for (size_t i = 0; i < r->n; i++) {
        for (int b = 0; b < BANDS_MAX; b++)
            found(s, v, dirs_at(wi, i), "f", r->f[i].band[b]);
        found(s, v, dirs_at(wi, i), "pdf", r->pdf[i]);
    }
}

static void run(const struct subject *s, struct verdict *v)
{
    const bool same = s->claims.lobes & BSDF_REFLECTION;
    const bool other = s->claims.lobes & BSDF_TRANSMISSION;
    v->unit = "1/sr";
    if (same && other) {
        v->applies = false;
        verdict_note(v, "reflects and transmits");
        return;
    }
    struct room *r = malloc(sizeof *r);
    if (!r) {
        v->value = NAN;
        verdict_note(v, "out of memory");
        return;
    }
    look(s, v, r, same, other);
    if (v->value == 0)
        verdict_note(v, "%zu directions, %d samples", r->n, DRAWS);
    free(r);
    verdict_found(v, "samples on the wrong side, one in %.2g",
                  DRAWS / log(100));
}

const struct check check_support = {
    .name = "support",
    .about = "f, pdf and samples are 0 on a side without a claimed lobe",
    .run = run,
};
