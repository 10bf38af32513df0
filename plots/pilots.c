/* pilots.c - drawing pilots */
#include "plots/pilots.h"

#include <stdio.h>
#include <stdlib.h>

#include "bsdf/rng.h"

static int from_normal(const void *a, const void *b)
{
    const double x = ((const struct delta *)a)->wi.z;
    const double y = ((const struct delta *)b)->wi.z;
    return (x < y) - (x > y);
}

static void delta_add(struct pilots *p, const struct bsdf_sample *a)
{
    for (int k = 0; k < p->deltas; k++)
        if (vec3_dot(a->wi, p->delta[k].wi) > 1 - 1e-12)
            return;
    if (p->deltas < DELTAS_MAX)
        p->delta[p->deltas++] =
            (struct delta){ .wi = a->wi, .pdf = a->pdf, .weight = a->weight };
}

void pilots_draw(struct pilots *p, const struct bsdf *b, struct vec3 wo,
                 uint64_t seed)
{
    const struct plan plan = { .seed = seed };
    const struct subject s = subject_plain(b, wo, &plan);
    const struct rng rng = subject_rng(&s, STREAM_PILOT);
    p->n = 0;
    p->deltas = 0;
    for (uint64_t i = 0; i < PILOTS_MAX; i++) {
        const struct bsdf_sample a = bsdf_sample(b, wo, rng_uniform(rng, i));
        if (!(vec3_dot(a.wi, a.wi) > 0.5))
            continue;
        if (a.delta)
            delta_add(p, &a);
        else
            p->wi[p->n++] = a.wi;
    }
    qsort(p->delta, (size_t)p->deltas, sizeof *p->delta, from_normal);
}

void delta_text(const struct delta *d, int bands, double theta_deg, char *text,
                size_t size)
{
    const bool same = spectrum_is(d->weight, bands, d->weight.band[0]);
    int n = snprintf(text, size, "δ at θᵢ = %.6g°: probability %.4g, weight",
                     theta_deg, d->pdf);
    for (int b = 0; b < (same ? 1 : bands); b++)
        n += snprintf(text + n, size - (size_t)n, "%s %.4g", b ? "," : "",
                      d->weight.band[b]);
}
