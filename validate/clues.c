/* clues.c - samples, Jacobians and bins, as ratios */
#include "validate/clues.h"

#include <stdlib.h>

#include "validate/jacobian.h"

/* The normal of the facet, toward the upper side: along wo + wi, or with both
 * scaled by their index where the light goes through.  B. Walter et al.,
 * Microfacet Models for Refraction through Rough Surfaces, EGSR 2007, eq. 13,
 * 16 and 17. */
static struct clue clue_at(const struct subject *s, struct vec3 wi)
{
    const struct vec3 wo = s->wo;
    const double eta = s->claims.eta;
    const double n_o = wo.z < 0 ? eta : 1, n_i = wi.z < 0 ? eta : 1;
    struct clue c = { .wo = wo, .wi = wi, .through = wo.z * wi.z < 0 };
    const struct vec3 sum = vec3_add(vec3_scale(n_o, wo), vec3_scale(n_i, wi));
    c.m = vec3_unit(vec3_scale(sum.z < 0 ? -1 : 1, sum));
    const double o = vec3_dot(wo, c.m), i = vec3_dot(wi, c.m);
    c.cos_o = fabs(wo.z);
    c.cos_i = fabs(wi.z);
    c.cos_h = c.m.z;
    c.wo_h = fabs(o);
    c.wi_h = fabs(i);
    c.eta2 = subject_compression(s, wi);
    c.jacobian = c.through ? n_i * n_i * c.wi_h /
                                 ((n_o * o + n_i * i) * (n_o * o + n_i * i))
                           : 1 / (4 * c.wi_h);
    const bool facets = bsdf_has_facets(s->bsdf);
    c.g1_o = facets ? bsdf_facet_g1(s->bsdf, wo) : NAN;
    c.g1_i = facets ? bsdf_facet_g1(s->bsdf, wi) : NAN;
    c.share = c.det = NAN;
    c.back = bsdf_pdf(s->bsdf, wi, wo);
    return c;
}

static void keep(struct clues *out, struct clue c, double ratio)
{
    c.ratio = ratio;
    if (ratio > 0 && isfinite(log(ratio)) && out->n < CLUES_MAX)
        out->clue[out->n++] = c;
}

/* f, as the mean of its bands: mistakes that differ between bands are looked
 * for by none but Fresnel's, and that shows in the mean too. */
static double mean_band(const struct subject *s, struct spectrum f)
{
    const int n = bsdf_bands(s->bsdf)->count;
    double sum = 0;
    for (int b = 0; b < n; b++)
        sum += f.band[b];
    return sum / n;
}

static void of_sample(const struct subject *s, const struct bsdf_sample *a,
                      enum clue_kind kind, facets_fn *d, const void *context,
                      struct clue c, struct clues *out)
{
    const double f = mean_band(s, bsdf_eval(s->bsdf, s->wo, a->wi));
    switch (kind) {
    case CLUES_WEIGHT:
        keep(out, c, mean_band(s, a->weight) * a->pdf / (f * c.cos_i));
        break;
    case CLUES_SAMPLE_PDF:
        keep(out, c, a->pdf / bsdf_pdf(s->bsdf, s->wo, a->wi));
        break;
    case CLUES_DENSITY:
        if (!c.overlap)
            keep(out, c, bsdf_pdf(s->bsdf, s->wo, a->wi) * c.det / c.share);
        break;
    case CLUES_RECIPROCITY:
        keep(out, c,
             f * c.eta2 / mean_band(s, bsdf_eval(s->bsdf, a->wi, s->wo)));
        break;
    case CLUES_FACETS:
        if (!c.through)
            keep(out, c, f * 4 * c.cos_o * c.cos_i / d(context, c.m));
        break;
    case CLUES_BINS:
    default:
        break;
    }
}

static void of_bins(const struct subject *s, struct clues *out)
{
    const struct survey *v = &s->survey;
    const double n = (double)v->samples;
    for (size_t i = 0; i < partition_bins(v->partition); i++)
        if (v->mass[i].value * n >= 100 && v->count[i] >= 100)
            keep(out,
                 clue_at(s, patch_centre(partition_patch(v->partition, i))),
                 v->mass[i].value * n / (double)v->count[i]);
}

bool clues_gather(const struct subject *s, enum clue_kind kind, facets_fn *d,
                  const void *context, struct clues *out)
{
    out->n = 0;
    if (kind == CLUES_BINS) {
        of_bins(s, out);
        return true;
    }
    struct jacobian_point *p = malloc(JACOBIAN_POINTS * sizeof *p);
    if (!p || !jacobian_points(s, p)) {
        free(p);
        return false;
    }
    for (size_t i = 0; i < JACOBIAN_POINTS; i++) {
        if (!subject_spread(&p[i].at) || !(p[i].at.pdf > 0))
            continue;
        struct clue c = clue_at(s, p[i].at.wi);
        if (p[i].usable && p[i].step_error < 0.01) {
            c.share = p[i].share;
            c.det = p[i].det;
            c.overlap = p[i].overlap;
        } else if (kind == CLUES_DENSITY) {
            continue;
        }
        of_sample(s, &p[i].at, kind, d, context, c, out);
    }
    free(p);
    return true;
}
