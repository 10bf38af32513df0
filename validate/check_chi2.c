/* check_chi2.c - samples fall where the pdf says
 *
 * Chi-square at four resolutions: the bins (some 400 that are full), strips in
 * theta, slices in phi, and groups of both (some 20), as many bins have no
 * power against smooth errors and few none against local ones; and the bin that
 * is furthest off, in a pool or not, by its exact binomial tail.  Refused
 * samples and delta directions are cells as well, and nothing is rescaled.
 * Cells that expect fewer than 100 samples are pooled, those that expect less
 * than 1 apart; a pool that still expects fewer is tested by its exact binomial
 * tail, never dropped. The integration error is read in favour of the model: a
 * residual counts only as far as it exceeds N times the error.
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
    struct cell pool[2]; /* of cells that expect less than 1, and fewer than
                            100, where they expect fewer than 100 together */
    long degrees;
};

static void cell_add(struct cell *to, struct cell from)
{
    to->share = estimate_add(to->share, from.share);
    to->count += from.count;
}

/* A share that rounding made negative is as good as 0. */
static struct cell above_0(struct cell c)
{
    c.share.value = fmax(c.share.value, 0);
    return c;
}

/* (O - E) / sqrt(E), as far as the error does not explain it. */
static double residual(struct cell c, double samples)
{
    const double expected = c.share.value * samples;
    const double off = (double)c.count - expected;
    const double excess = fmax(fabs(off) - c.share.error * samples, 0);
    return copysign(excess, off) / sqrt(expected);
}

static void outcome_add(struct outcome *o, struct cell c, double samples)
{
    const double r = residual(c, samples);
    o->statistic += r * r;
    o->degrees++;
}

static struct outcome test(const struct cell *cell, size_t n, uint64_t samples)
{
    struct outcome o = { .degrees = -1 };
    for (size_t i = 0; i < n; i++) {
        const struct cell c = above_0(cell[i]);
        const double expected = c.share.value * (double)samples;
        if (expected < pool_below)
            cell_add(&o.pool[expected >= pool_apart_below], c);
        else
            outcome_add(&o, c, (double)samples);
    }
    for (int k = 0; k < 2; k++)
        if (o.pool[k].share.value * (double)samples >= pool_below) {
            outcome_add(&o, o.pool[k], (double)samples);
            o.pool[k] = (struct cell){ { 0, 0 }, 0 };
        }
    o.p = pvalue_chi_square(o.statistic, o.degrees);
    return o;
}

/* What is no bin: refused samples, and delta directions. */
static size_t others(const struct survey *v, struct cell *cell)
{
    cell[0] = (struct cell){ survey_refusal(v), v->refused };
    for (int k = 0; k < v->deltas; k++)
        cell[k + 1] =
            (struct cell){ { v->delta[k].pdf, 0 }, v->delta[k].count };
    return 1 + (size_t)v->deltas;
}

static void chi_square_part(struct verdict *v, const char *name,
                            const struct outcome *o, const struct survey *s,
                            const char *before)
{
    verdict_part(v, (struct verdict_part){
                        .name = name,
                        .p = o->p,
                        .uniform = o->degrees > 0 ? o->p : NAN,
                        .kind = o->degrees > 0 ? PART_CHI_SQUARE : PART_OTHER,
                        .degrees = o->degrees,
                        /* The sum of N m d^2 over cells of mass m. */
                        .scale = (double)s->samples * s->total.value,
                        .before = before,
                        .after = "%",
                    });
}

/* A pool of few; the number u makes the p-value uniform, for calibration. */
static void pool_part(struct verdict *v, const char *name, struct cell c,
                      const struct survey *s, double u, const char *after)
{
    const double n = (double)s->samples;
    const bool some = c.share.value * n > 0 || c.count > 0;
    verdict_part(v, (struct verdict_part){
                        .name = name,
                        .p = pvalue_binomial(c.count, s->samples, c.share),
                        .uniform = some ? pvalue_binomial_uniform(
                                              c.count, s->samples,
                                              fmin(c.share.value, 1), u)
                                        : NAN,
                        .kind = PART_POISSON,
                        .mean = (c.share.value + c.share.error) * n,
                        .scale = n,
                        .before = after ? "" : NULL,
                        .after = after,
                    });
}

/* A cell whose count is hardly likely; of no p where none is off by two
 * standard deviations. */
struct worst {
    size_t at;
    double p, sigma;
};

/* The one with the least binomial tail, be it in a pool or not: a few samples
 * too many in a cell that expects next to none are lost in a pool. */
static struct worst worst_of(const struct cell *cell, size_t n,
                             uint64_t samples)
{
    struct worst w = { n, 1, 0 };
    for (size_t i = 0; i < n; i++) {
        const double r = residual(above_0(cell[i]), (double)samples);
        if (!(fabs(r) > 2)) /* nor of a mass that is no number */
            continue;
        const double p = pvalue_binomial(cell[i].count, samples, cell[i].share);
        if (p < w.p)
            w = (struct worst){ i, p, copysign(pvalue_sigma(p), r) };
    }
    return w;
}

/* Paid for by the number of cells. */
static void worst_part(struct verdict *v, struct worst w, size_t cells)
{
    verdict_part(v, (struct verdict_part){ .name = "worst bin",
                                           .p = fmin(w.p * (double)cells, 1),
                                           .uniform = NAN });
}

/* The resolution of a grouping of the fine cells. */
static struct outcome grouped(const struct survey *s, const struct cell *fine,
                              enum partition_grouping by, struct cell *cell)
{
    const size_t bins = partition_bins(s->partition);
    const size_t n = partition_groups(s->partition, by);
    for (size_t i = 0; i < n; i++)
        cell[i] = (struct cell){ { 0, 0 }, 0 };
    for (size_t i = 0; i < bins; i++)
        cell_add(&cell[partition_group(s->partition, by, i)], fine[i]);
    return test(cell, n + others(s, cell + n), s->samples);
}

static void run(const struct subject *s, struct verdict *v)
{
    const struct survey *survey = &s->survey;
    const size_t bins = partition_bins(survey->partition);
    if (!(s->claims.lobes & ~(unsigned)BSDF_DELTA)) {
        v->applies = false;
        verdict_note(v, "only delta lobes");
        return;
    }
    /* No grouping has more cells than there are bins. */
    struct cell *fine = calloc(bins + 1 + DELTAS_MAX, sizeof *fine);
    struct cell *group = calloc(bins + 1 + DELTAS_MAX, sizeof *group);
    v->unit = "sigma";
    if (!fine || !group) {
        v->value = NAN;
        verdict_note(v, "out of memory");
        goto done;
    }
    for (size_t i = 0; i < bins; i++)
        fine[i] = (struct cell){ survey->mass[i], survey->count[i] };
    const size_t cells = bins + others(survey, fine + bins);
    const struct outcome f = test(fine, cells, survey->samples);
    const struct worst worst = worst_of(fine, cells, survey->samples);
    const struct outcome theta = grouped(survey, fine, PARTITION_THETA, group);
    const struct outcome phi = grouped(survey, fine, PARTITION_PHI, group);
    const struct outcome c = grouped(survey, fine, PARTITION_COARSE, group);

    const struct vec3 u = rng_uniform(subject_rng(s, STREAM_RANDOMISE), 0);
    chi_square_part(v, "fine", &f, survey, NULL);
    chi_square_part(v, "theta", &theta, survey, NULL);
    chi_square_part(v, "phi", &phi, survey, NULL);
    chi_square_part(v, "coarse", &c, survey, "the pdf wrong here and there by");
    pool_part(v, "empty", f.pool[0], survey, u.x,
              "% of the samples where nearly none should be");
    /* The groups' pools are the fine ones once more. */
    pool_part(v, "sparse", f.pool[1], survey, u.y, NULL);
    worst_part(v, worst, cells);
    verdict_combine(v);
    if (survey->stray > 0 || isnan(survey->total.value))
        v->p = pvalue_impossible;
    if (worst.at < bins) {
        v->has_wi = true;
        v->wi = patch_centre(partition_patch(survey->partition, worst.at));
    }
    verdict_note(v,
                 "fine %.1f on %ld, theta %.1f on %ld, phi %.1f on %ld, coarse "
                 "%.1f on %ld degrees of freedom, nearly empty bins p %.2g, "
                 "worst bin %+.1f sigma%s",
                 f.statistic, f.degrees, theta.statistic, theta.degrees,
                 phi.statistic, phi.degrees, c.statistic, c.degrees,
                 fmin(v->part[4].p, v->part[5].p), worst.sigma,
                 survey->stray > 0 ? ", samples that are no directions" : "");
done:
    free(fine);
    free(group);
}

const struct check check_chi2 = {
    .name = "chi2",
    .about = "samples are distributed as the pdf says (chi-square)",
    .run = run,
};
