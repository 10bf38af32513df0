/* check_chi2.c - samples fall where the pdf says
 *
 * Chi-square at two resolutions: the bins (some 400 that are full) and groups
 * of them (some 20), as many bins have no power against smooth errors and few
 * none against local ones.  Refused samples and delta directions are cells as
 * well, and nothing is rescaled.  Cells that expect fewer than 100 samples are
 * pooled, those that expect less than 1 apart; a pool that still expects fewer
 * is tested by its exact binomial tail, never dropped.
 * The integration error is read in favour of the model: a residual counts only
 * as far as it exceeds N times the error.
 *
 * K. Subr and J. Arvo, Statistical Hypothesis Testing for Assessing Monte
 * Carlo Estimators: Applications to Image Synthesis, Pacific Graphics 2007.
 */
#include "validate/checks.h"

#include <stdio.h>
#include <stdlib.h>

#include "validate/pvalue.h"

static const double pool_below = 100, pool_apart_below = 1;

struct cell {
    struct estimate share;
    uint64_t count;
};

struct outcome {
    double statistic, p;
    double p_pool[2]; /* of cells that expect less than 1, and fewer than 100 */
    long degrees;
    size_t worst; /* the cell with the largest residual */
    double worst_sigma;
};

static void cell_add(struct cell *to, struct cell from)
{
    to->share = estimate_add(to->share, from.share);
    to->count += from.count;
}

/* (O - E) / sqrt(E), as far as the error does not explain it. */
static double residual(struct cell c, double samples)
{
    const double expected = c.share.value * samples;
    const double off = (double)c.count - expected;
    const double excess = fmax(fabs(off) - c.share.error * samples, 0);
    return copysign(excess, off) / sqrt(expected);
}

static void outcome_add(struct outcome *o, struct cell c, size_t at,
                        double samples)
{
    const double r = residual(c, samples);
    o->statistic += r * r;
    o->degrees++;
    if (fabs(r) > fabs(o->worst_sigma)) {
        o->worst_sigma = r;
        o->worst = at;
    }
}

static struct outcome test(const struct cell *cell, size_t n, uint64_t samples)
{
    struct outcome o = { .degrees = -1, .worst = n };
    struct cell pool[2] = { { { 0, 0 }, 0 } };
    for (size_t i = 0; i < n; i++) {
        /* A share that rounding made negative is as good as 0. */
        struct cell c = cell[i];
        c.share.value = fmax(c.share.value, 0);
        const double expected = c.share.value * (double)samples;
        if (expected < pool_below)
            cell_add(&pool[expected >= pool_apart_below], c);
        else
            outcome_add(&o, c, i, (double)samples);
    }
    for (int k = 0; k < 2; k++) {
        o.p_pool[k] = 1;
        if (pool[k].share.value * (double)samples < pool_below) {
            o.p_pool[k] =
                pvalue_binomial(pool[k].count, samples, pool[k].share);
        } else {
            outcome_add(&o, pool[k], n, (double)samples);
        }
    }
    o.p = pvalue_chi_square(o.statistic, o.degrees);
    return o;
}

static void run(const struct subject *s, struct verdict *v)
{
    const struct survey *survey = &s->survey;
    const size_t bins = partition_bins(survey->partition);
    const size_t groups = partition_coarse_bins(survey->partition);
    const size_t others = 1 + (size_t)survey->deltas;
    if (!(bsdf_claims(s->bsdf).lobes & ~(unsigned)BSDF_DELTA)) {
        v->applies = false;
        verdict_note(v, "only delta lobes");
        return;
    }
    struct cell *fine = calloc(bins + others, sizeof *fine);
    struct cell *coarse = calloc(groups + others, sizeof *coarse);
    v->unit = "sigma";
    if (!fine || !coarse) {
        v->value = NAN;
        verdict_note(v, "out of memory");
        goto done;
    }
    for (size_t i = 0; i < bins; i++) {
        fine[i] = (struct cell){ survey->mass[i], survey->count[i] };
        cell_add(&coarse[partition_coarse(survey->partition, i)], fine[i]);
    }
    for (int k = 0; k < survey->deltas; k++) {
        const struct delta *d = &survey->delta[k];
        fine[bins + 1 + (size_t)k] = coarse[groups + 1 + (size_t)k] =
            (struct cell){ { d->pdf, 0 }, d->count };
    }
    fine[bins] = coarse[groups] =
        (struct cell){ survey_refusal(survey), survey->refused };

    const struct outcome f = test(fine, bins + others, survey->samples);
    const struct outcome c = test(coarse, groups + others, survey->samples);
    /* The groups' pools are the fine ones once more. */
    const double p[] = { f.p, f.p_pool[0], f.p_pool[1], c.p };
    v->p = pvalue_best(p, 4);
    if (survey->stray > 0 || isnan(survey->total.value))
        v->p = pvalue_impossible;
    if (f.worst < bins) {
        v->has_wi = true;
        v->wi = patch_centre(partition_patch(survey->partition, f.worst));
    }
    verdict_note(
        v,
        "fine %.1f on %ld, coarse %.1f on %ld degrees of freedom, nearly "
        "empty bins p %.2g, worst bin %+.1f sigma%s",
        f.statistic, f.degrees, c.statistic, c.degrees,
        fmin(f.p_pool[0], f.p_pool[1]), f.worst_sigma,
        survey->stray > 0 ? ", samples that are no directions" : "");
done:
    free(fine);
    free(coarse);
}

const struct check check_chi2 = {
    .name = "chi2",
    .about = "samples are distributed as the pdf says (chi-square)",
    .run = run,
};
