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
#include <stdlib.h>

enum { THETAS = 12, TURNS = 8, DRAWS = 1024 };
enum { PAIRS = 2 * THETAS * TURNS + 2 * DRAWS };

struct room {
    double x[PAIRS], y[PAIRS], z[PAIRS];
    struct spectrum there[PAIRS], back[PAIRS];
    size_t n;
};

static void ask(struct room *r, struct vec3 wi)
{
    r->x[r->n] = wi.x, r->y[r->n] = wi.y, r->z[r->n++] = wi.z;
}

/* Keeps the deviation that exceeds its limit most.  The limit costs further
 * calls, and is at least the precision: what rounding may do to f either way,
 * and no less than twice what it may do to f(wo, wi). */
static void keep(const struct subject *s, struct verdict *v, struct vec3 wi,
                 double off, struct spectrum there, struct spectrum back,
                 double n2)
{
    const double best = v->value / v->limit, precision = subject_precision(s);
    if (!(off / precision > best) && !isnan(off))
        return;
    const struct subject other = subject_plain(s->bsdf, wi, s->plan);
    const double one_way = subject_rounding(s, wi, false);
    const double other_way = subject_rounding(&other, s->wo, false);
    const double limit = precision + one_way + fmax(one_way, other_way);
    if (!(off / limit > best) && !isnan(off))
        return;
    v->value = off;
    v->limit = limit;
    v->has_wi = true;
    v->wi = wi;
    verdict_note(v, "f there / f back =");
    for (int c = 0; c < bsdf_bands(s->bsdf)->count; c++)
        verdict_add(v, "%s%.5g", c ? "/" : " ",
                    there.band[c] * n2 / back.band[c]);
}

static void pairs(const struct subject *s, struct verdict *v, struct room *r)
{
    const struct dirs wi = { r->x, r->y, r->z };
    subject_eval(s, r->n, wi, r->there);
    subject_eval_back(s, r->n, wi, r->back);
    for (size_t i = 0; i < r->n; i++) {
        const double n2 = subject_compression(s, dirs_at(wi, i));
        for (int b = 0; b < bsdf_bands(s->bsdf)->count; b++) {
            const double x = r->there[i].band[b] * n2;
            const double y = r->back[i].band[b];
            const double larger = fmax(x, y);
            /* Denormal numbers have no digits to compare. */
            if (isnan(v->value) || (!(larger > 1e-290) && !isnan(x + y)))
                continue;
            keep(s, v, dirs_at(wi, i), fabs(x - y) / larger, r->there[i],
                 r->back[i], n2);
        }
    }
}

/* The delta that leads from wi back to wo, by drawing; false if none comes. */
static bool delta_back(const struct subject *s, const struct delta *d,
                       struct bsdf_sample *back)
{
    enum { BATCH = 1024, BATCHES = 64 };
    const struct subject other = subject_plain(s->bsdf, d->wi, s->plan);
    const struct rng rng = subject_rng(s, STREAM_PAIRS);
    struct bsdf_sample sample[BATCH];
    for (uint64_t at = 0; at < BATCHES * BATCH; at += BATCH) {
        subject_draw(&other, rng, at, BATCH, sample);
        for (size_t i = 0; i < BATCH; i++) {
            const struct vec3 off = vec3_minus(sample[i].wi, s->wo);
            *back = sample[i];
            if (back->delta && back->pdf > 0 && vec3_length(off) < 1e-6)
                return true;
        }
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

static void directions(const struct subject *s, struct room *r)
{
    static const double theta_deg[THETAS] = { 0,    5,  13, 30,   45,   60,
                                              72.5, 80, 85, 88.5, 89.5, 89.9 };
    const bool below = s->claims.lobes & BSDF_TRANSMISSION;
    struct bsdf_sample sample[DRAWS];
    for (int turn = 0; turn < TURNS; turn++)
        for (int i = 0; i < THETAS; i++) {
            const double phi_deg = 360. / TURNS * turn + 7;
            ask(r, dir_from_degrees(theta_deg[i], phi_deg));
            if (below)
                ask(r, dir_from_degrees(180 - theta_deg[i], phi_deg));
        }
    const struct rng rng = subject_rng(s, STREAM_PAIRS);
    subject_draw(s, rng, 0, DRAWS, sample);
    for (uint64_t i = 0; i < DRAWS; i++) {
        const struct vec3 u = rng_uniform(rng, i);
        const double z = below ? 2 * u.x - 1 : u.x;
        const double rim = sqrt((1 - z) * (1 + z)), phi = 2 * PI * u.y;
        ask(r, (struct vec3){ rim * cos(phi), rim * sin(phi), z });
        if (sample[i].pdf > 0 && !sample[i].delta)
            ask(r, sample[i].wi);
    }
}

static void run(const struct subject *s, struct verdict *v)
{
    if (!s->claims.reciprocal) {
        v->applies = false;
        verdict_note(v, "declared not reciprocal");
        return;
    }
    v->unit = "relative";
    v->limit = subject_precision(s);
    for (int k = 0; k < s->survey.deltas; k++)
        delta_pair(s, v, &s->survey.delta[k]);
    if (!(s->claims.lobes & ~(unsigned)BSDF_DELTA))
        return;
    struct room *r = malloc(sizeof *r);
    if (!r) {
        v->value = NAN;
        verdict_note(v, "out of memory");
        return;
    }
    r->n = 0;
    directions(s, r);
    pairs(s, v, r);
    if (v->value == 0 && !v->note[0])
        verdict_note(v, "the same in %zu pairs", r->n);
    free(r);
    verdict_found(v, "an f wrong one way by %.1g %%, in one pair of %.2g",
                  100 * v->limit, DRAWS / log(100));
}

const struct check check_reciprocity = {
    .name = "reciprocity",
    .about = "f(wo, wi) = f(wi, wo), divided by the squared indices",
    .run = run,
};
