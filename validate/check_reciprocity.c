/* check_reciprocity.c - light may go either way
 *
 *   f(wo, wi) / n_o^2 = f(wi, wo) / n_i^2
 *
 * with the index on the side that a direction is on; relative to the larger
 * side, within 1e-7 (subject_precision) and what rounding explains.  Pairs of
 * wo with a grid, with random directions, and with directions that the model
 * samples.  A delta direction's f |cos| is its pdf times its weight, and with
 * (n_i / n_o)^2 that is the same both ways.
 *
 * B. Walter et al., Microfacet Models for Refraction through Rough Surfaces,
 * EGSR 2007, sec. 3; E. Veach, Robust Monte Carlo Methods for Light Transport
 * Simulation, 1997, eq. 5.14.
 */
#include "validate/checks.h"

#include <stdio.h>

static void pair(const struct subject *s, struct verdict *v, struct vec3 wi)
{
    const double eta = bsdf_claims(s->bsdf).eta;
    const double n_o = s->wo.z < 0 ? eta : 1, n_i = wi.z < 0 ? eta : 1;
    const struct spectrum there = bsdf_eval(s->bsdf, s->wo, wi);
    const struct spectrum back = bsdf_eval(s->bsdf, wi, s->wo);
    const int bands = bsdf_bands(s->bsdf)->count;
    for (int b = 0; b < bands; b++) {
        const double x = there.band[b] / (n_o * n_o);
        const double y = back.band[b] / (n_i * n_i);
        const double larger = fmax(x, y);
        /* Denormal numbers have no digits to compare. */
        if (!(larger > 1e-290) && !isnan(x + y))
            continue;
        const double off = fabs(x - y) / larger;
        const double limit =
            subject_precision + 2 * subject_rounding(s, wi, false);
        if (!(off / limit > v->value / v->limit) && !isnan(off))
            continue;
        if (isnan(v->value))
            return;
        v->value = off;
        v->limit = limit;
        v->has_wi = true;
        v->wi = wi;
        verdict_note(v, "f there / f back =");
        for (int c = 0; c < bands; c++)
            verdict_add(v, "%s%.5g", c ? "/" : " ",
                        there.band[c] * n_i * n_i / (back.band[c] * n_o * n_o));
    }
}

/* The delta that leads from wi back to wo, by drawing; false if none comes. */
static bool delta_back(const struct subject *s, const struct delta *d,
                       struct bsdf_sample *back)
{
    const struct rng rng = subject_rng(s, STREAM_PAIRS);
    for (uint64_t i = 0; i < 65536; i++) {
        *back = bsdf_sample(s->bsdf, d->wi, rng_uniform(rng, i));
        const struct vec3 off = vec3_add(back->wi, vec3_scale(-1, s->wo));
        if (back->delta && back->pdf > 0 && vec3_length(off) < 1e-6)
            return true;
    }
    return false;
}

static void delta_pair(const struct subject *s, struct verdict *v,
                       const struct delta *d)
{
    struct bsdf_sample back;
    /* Rarer than this it may well not be drawn on the way back. */
    if (d->pdf < 1e-3)
        return;
    const bool found = delta_back(s, d, &back);
    const double n2 = subject_compression(s, d->wi);
    for (int b = 0; b < bsdf_bands(s->bsdf)->count; b++) {
        const double x = d->pdf * d->weight.band[b] * n2;
        const double y = found ? back.pdf * back.weight.band[b] / n2 : 0;
        const double off = fabs(x - y) / fmax(x, y);
        if (!(off > v->value) && !(isnan(off) && x != y))
            continue;
        v->value = off;
        v->has_wi = true;
        v->wi = d->wi;
        verdict_note(v, "delta, as energy: %.6g there, %.6g back", x, y);
    }
}

static void run(const struct subject *s, struct verdict *v)
{
    const struct bsdf_claims claims = bsdf_claims(s->bsdf);
    if (!claims.reciprocal) {
        v->applies = false;
        verdict_note(v, "declared not reciprocal");
        return;
    }
    static const double theta_deg[] = { 0,    5,  13, 30,   45,   60,
                                        72.5, 80, 85, 88.5, 89.5, 89.9 };
    enum { THETAS = sizeof theta_deg / sizeof *theta_deg, TURNS = 8 };
    const bool below = claims.lobes & BSDF_TRANSMISSION;
    v->unit = "relative";
    v->limit = subject_precision;
    for (int k = 0; k < s->survey.deltas; k++)
        delta_pair(s, v, &s->survey.delta[k]);
    if (!(claims.lobes & ~(unsigned)BSDF_DELTA))
        return;
    for (int turn = 0; turn < TURNS; turn++)
        for (int i = 0; i < THETAS; i++) {
            const double phi_deg = 360. / TURNS * turn + 7;
            pair(s, v, dir_from_degrees(theta_deg[i], phi_deg));
            if (below)
                pair(s, v, dir_from_degrees(180 - theta_deg[i], phi_deg));
        }
    const struct rng rng = subject_rng(s, STREAM_PAIRS);
    for (uint64_t i = 0; i < 1024; i++) {
        const struct vec3 u = rng_uniform(rng, i);
        const double z = below ? 2 * u.x - 1 : u.x;
        const double r = sqrt((1 - z) * (1 + z)), phi = 2 * PI * u.y;
        pair(s, v, (struct vec3){ r * cos(phi), r * sin(phi), z });
        const struct bsdf_sample a = bsdf_sample(s->bsdf, s->wo, u);
        if (a.pdf > 0 && !a.delta)
            pair(s, v, a.wi);
    }
}

const struct check check_reciprocity = {
    .name = "reciprocity",
    .about = "f(wo, wi) = f(wi, wo), divided by the squared indices",
    .run = run,
};
