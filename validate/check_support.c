/* check_support.c - nothing where the model says that nothing is
 *
 * A model without transmission is 0 for directions on the other side, in f, in
 * pdf and in what it samples; one without reflection is 0 on the same side.
 * value is the largest of f [1/sr] and pdf [1/sr] found there, or 1 for a
 * sample.
 */
#include "validate/checks.h"

#include <stdio.h>

static void found(struct verdict *v, struct vec3 wo, struct vec3 wi,
                  const char *what, double value)
{
    if (!(value > v->value))
        return;
    v->value = value;
    v->wo = wo;
    v->wi = wi;
    v->has_wi = true;
    verdict_note(v, "%s = %g on the %s side", what, value,
                 wo.z * wi.z < 0 ? "other" : "same");
}

static void pair(const struct subject *s, struct verdict *v, struct vec3 wo,
                 struct vec3 wi)
{
    const struct spectrum f = bsdf_eval(s->bsdf, wo, wi);
    for (int b = 0; b < BANDS_MAX; b++)
        found(v, wo, wi, "f", f.band[b]);
    found(v, wo, wi, "pdf", bsdf_pdf(s->bsdf, wo, wi));
}

static void run(const struct subject *s, struct verdict *v)
{
    const unsigned lobes = bsdf_claims(s->bsdf).lobes;
    const bool same = lobes & BSDF_REFLECTION;
    const bool other = lobes & BSDF_TRANSMISSION;
    v->unit = "1/sr";
    if (same && other) {
        v->applies = false;
        verdict_note(v, "reflects and transmits");
        return;
    }
    const struct rng rng = subject_rng(s, STREAM_PAIRS);
    for (uint64_t i = 0; i < 4096; i++) {
        const struct vec3 u = rng_uniform(rng, i);
        /* Half of the directions within 1e-3 of the horizon. */
        const double z = i % 2 ? u.x : u.x * 1e-3;
        const double r = sqrt((1 - z) * (1 + z)), phi = 2 * PI * u.y;
        const double side = (s->wo.z < 0) == other ? -1 : 1;
        struct vec3 wi = { r * cos(phi), r * sin(phi), side * z };
        if (z > 0)
            pair(s, v, s->wo, wi);

        const struct bsdf_sample a = bsdf_sample(s->bsdf, s->wo, u);
        const double toward = a.wi.z * s->wo.z;
        if (a.pdf > 0 && (toward < 0 ? !other : !same))
            found(v, s->wo, a.wi, "a sample, counted", 1);
        /* Where a lobe that is cut at the horizon would go on. */
        wi = (struct vec3){ a.wi.x, a.wi.y, -a.wi.z };
        if (a.pdf > 0 && (toward < 0 ? other : same))
            pair(s, v, s->wo, wi);
    }
    if (v->value == 0)
        verdict_note(v, "8192 directions, 4096 samples");
}

const struct check check_support = {
    .name = "support",
    .about = "f, pdf and samples are 0 on a side without a claimed lobe",
    .run = run,
};
