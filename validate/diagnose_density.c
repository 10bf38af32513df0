/* diagnose_density.c - mistakes in pdf() and in where samples go */
#include <stdio.h>
#include <stdlib.h>

#include "bsdf/ndf.h"
#include "validate/guess.h"

/* -- what is said of a sample ---------------------------------------------- */

/* What a mixture's sample says where it knows one lobe: the density of that
 * lobe alone, or with its probability. */
static void suggest_one_lobe(struct guess *g, const struct subject *s,
                             const struct clues *clues)
{
    double predicted[2][CLUES_MAX];
    bool overlaps = false;
    for (size_t i = 0; i < clues->n; i++) {
        const struct clue *c = &clues->clue[i];
        const double pdf = bsdf_pdf(s->bsdf, s->wo, c->wi);
        overlaps |= c->overlap;
        predicted[0][i] = log(1 / (c->det * pdf));
        predicted[1][i] = log(c->share / (c->det * pdf));
    }
    for (int k = 0; overlaps && k < 2; k++)
        suggest(g, factors_explain(clues, SCOPE_ALL, predicted[k]) + 1e-6,
                "one lobe's pdf only: a sample's pdf is that of the lobe it "
                "was drawn from%s",
                k ? "" : ", without the probability of that lobe");
}

/* Between the smallest and the largest probability of a lobe wherever lobes
 * overlap, f of the sample or of eval lacks them. */
static void suggest_missing_shares(struct guess *g, const struct clues *clues,
                                   const char *what)
{
    double least = INFINITY, most = 0, low = INFINITY, high = 0;
    bool overlaps = false;
    for (size_t i = 0; i < clues->n; i++) {
        const struct clue *c = &clues->clue[i];
        overlaps |= c->overlap;
        if (c->share > 0) {
            least = fmin(least, c->share);
            most = fmax(most, c->share);
        }
        low = fmin(low, c->ratio);
        high = fmax(high, c->ratio);
    }
    if (!overlaps || !(most < 1))
        return;
    /* Of one lobe or of all: between its probability and 1. */
    const bool lacks = low > 1 - 1e-6 && high <= 1.01 / least;
    const bool other = high < 1 + 1e-6 && low >= 0.99 * least;
    if (lacks || other)
        suggest_rank(g, 0.99, "missing lobe probability in %s",
                     lacks ? what : "what it is compared with (eval)");
}

void diagnose_sample(struct guess *g, const struct subject *s,
                     struct clues *clues)
{
    if (!gather(s, CLUES_SAMPLE_PDF, clues))
        return;
    double off = 0;
    g->exact = true;
    for (size_t i = 0; i < clues->n; i++)
        off = fmax(off, fabs(clues->clue[i].ratio - 1));
    if (off > 10 * subject_precision(s)) {
        suggest_one_lobe(g, s, clues);
        suggest_factors(g, clues, "a sample's pdf");
    } else if (gather(s, CLUES_WEIGHT, clues)) {
        suggest_missing_shares(g, clues, "a sample's weight");
        suggest_factors(g, clues, "a sample's weight");
    }
}

/* -- where samples go ------------------------------------------------------ */

static void alpha_text(char *text, size_t size, const struct facets_fit *f)
{
    if (fabs(f->alpha_u - f->alpha_v) < 1e-3 * f->alpha_u)
        snprintf(text, size, "%.4g", f->alpha_u);
    else
        snprintf(text, size, "%.4g by %.4g", f->alpha_u, f->alpha_v);
}

/* Fits both what the pdf says and where samples go. */
static void suggest_alphas(struct guess *g, const struct clues *clues)
{
    double *said = malloc(2 * (clues->n + 1) * sizeof *said);
    double *drawn = said ? said + clues->n : NULL;
    double left = 0, all = 0;
    struct facets_fit a, b;
    for (size_t i = 0; said && i < clues->n; i++) {
        const struct clue *c = &clues->clue[i];
        drawn[i] = 1 / c->det;
        said[i] = c->ratio * drawn[i];
    }
    const bool fitted = said && facets_fit(clues->clue, said, clues->n, &a) &&
                        facets_fit(clues->clue, drawn, clues->n, &b);
    free(said);
    if (!fitted || !near(a.scale, b.scale) ||
        (near(a.alpha_u, b.alpha_u) && near(a.alpha_v, b.alpha_v)))
        return;
    for (size_t i = 0; i < clues->n; i++) {
        const struct clue *c = &clues->clue[i];
        if (c->through)
            continue;
        const double x = log(c->ratio);
        const double y =
            log(a.scale / b.scale * ndf_d(a.ndf, a.alpha_u, a.alpha_v, c->m) /
                ndf_d(b.ndf, b.alpha_u, b.alpha_v, c->m));
        left += (x - y) * (x - y);
        all += x * x;
    }
    char pdf[40], sampled[40];
    alpha_text(pdf, sizeof pdf, &a);
    alpha_text(sampled, sizeof sampled, &b);
    const bool swapped =
        near(a.alpha_u, b.alpha_v) && near(a.alpha_v, b.alpha_u);
    const bool square = near(b.alpha_u, a.alpha_u * a.alpha_u) ||
                        near(a.alpha_u, b.alpha_u * b.alpha_u);
    suggest(g, all > 0 ? 1 - left / all : 0, "%s: the pdf has %s, samples %s",
            swapped  ? "swapped alpha_u and alpha_v"
            : square ? "alpha against alpha^2"
                     : "another alpha",
            pdf, sampled);
}

/* With the directions changing places the pdf is what is drawn. */
static void suggest_swapped(struct guess *g, const struct subject *s,
                            const struct clues *clues)
{
    double predicted[CLUES_MAX];
    for (size_t i = 0; i < clues->n; i++) {
        const struct clue *c = &clues->clue[i];
        predicted[i] = log(bsdf_pdf(s->bsdf, s->wo, c->wi)) - log(c->back);
    }
    suggest(g, factors_explain(clues, SCOPE_ALL, predicted),
            "swapped directions: pdf(wo, wi) is that of wi given");
}

/* eta^2 times the ratio of the cosines on both sides of a coat of index eta. */
static void suggest_coat(struct guess *g, const struct clues *clues)
{
    double predicted[CLUES_MAX], best = -INFINITY, best_eta = 0, best_sign = 1;
    for (double eta = 1.1; eta < 3; eta += 0.01)
        for (int sign = -1; sign <= 1; sign += 2) {
            for (size_t i = 0; i < clues->n; i++) {
                const double c = clues->clue[i].cos_i;
                const double inside = sqrt(1 - (1 - c) * (1 + c) / (eta * eta));
                predicted[i] = sign * log(eta * eta * inside / c);
            }
            const double e = factors_explain(clues, SCOPE_ALL, predicted);
            if (e > best) {
                best = e;
                best_eta = eta;
                best_sign = sign;
            }
        }
    suggest(g, best - 1e-4,
            "%s the factor eta^2 cos_t / cos_i of a coat with eta = %.3g",
            best_sign > 0 ? "the pdf lacks, below a fraction bar,"
                          : "the pdf has in excess, below a fraction bar,",
            best_eta);
}

/* Whether a bin is on the other side, where the model claims no lobe. */
static bool bin_below(const struct subject *s, size_t bin)
{
    const struct patch p = partition_patch(s->survey.partition, bin);
    return !(s->claims.lobes & BSDF_TRANSMISSION) &&
           patch_centre(p).z * s->wo.z < 0;
}

static void suggest_below(struct guess *g, const struct subject *s)
{
    const struct survey *v = &s->survey;
    struct estimate below = { 0, 0 };
    for (size_t i = 0; i < partition_bins(v->partition); i++)
        if (bin_below(s, i))
            below = estimate_add(below, v->mass[i]);
    if (below.value > below.error + 1e-9)
        suggest_rank(g, 1, "mass below the horizon: %.3g of the pdf's",
                     below.value);
}

/* Where the pdf of overlapping lobes is too large as a whole, but by no more
 * than what their probabilities divide by. */
static void suggest_whole_lobes(struct guess *g, const struct subject *s,
                                struct clues *clues)
{
    const double total = s->survey.total.value;
    double least = INFINITY;
    if (!(total > 1.01) || !gather(s, CLUES_SAMPLE_PDF, clues))
        return;
    for (size_t i = 0; i < clues->n; i++)
        if (clues->clue[i].overlap && clues->clue[i].share > 0)
            least = fmin(least, clues->clue[i].share);
    if (total <= 1.01 / least)
        suggest_rank(
            g, 0.81,
            "missing lobe probability: the pdf integrates to %.4g, and "
            "its lobes overlap",
            total);
}

/* Of more refusals than the pdf leaves room for, and than chance explains; what
 * is drawn is then denser everywhere by as much. */
static void suggest_refused(struct guess *g, const struct subject *s,
                            const struct clues *clues)
{
    const struct survey *v = &s->survey;
    const double n = (double)v->samples, refused = (double)v->refused / n;
    const struct estimate left = survey_refusal(v);
    const double excess = refused - left.value;
    double mean = 0;
    for (size_t i = 0; i < clues->n; i++)
        mean += log(clues->clue[i].ratio) / (double)clues->n;
    if (excess > 1e-5 + left.error + 6 * sqrt(refused * (1 - refused) / n) &&
        fabs(v->total.value - 1) < 1e-4 &&
        fabs(mean + log1p(-excess)) < 0.1 * excess + 1e-5)
        suggest_rank(
            g, 0.99,
            "%.3g of the samples are refused, and the pdf integrates to 1 "
            "as if none were",
            excess);
}

/* Where the support check found something: there the pdf has mass, or f is not
 * 0, or samples go. */
void diagnose_support(struct guess *g, const struct subject *s)
{
    const struct survey *v = &s->survey;
    uint64_t below = 0;
    for (size_t i = 0; i < partition_bins(v->partition); i++)
        if (bin_below(s, i))
            below += v->count[i];
    suggest_below(g, s);
    if (below > v->samples / 2)
        suggest_rank(g, 0.9,
                     "samples are -wi for wi, the way that light travels: most "
                     "are below the horizon");
    suggest_rank(g, 0.85, "mass below the horizon%s",
                 below ? ", where samples go" : ", of f");
}

void diagnose_density(struct guess *g, const struct subject *s,
                      struct clues *clues)
{
    suggest_below(g, s);
    suggest_whole_lobes(g, s, clues);
    if (!gather(s, CLUES_DENSITY, clues))
        return;
    const bool exact = clues->n >= 32;
    g->exact = exact;
    if (!exact && !gather(s, CLUES_BINS, clues))
        return;
    suggest_refused(g, s, clues);
    if (!deviates(clues, 1e-5))
        return;
    suggest_factors(g, clues, "the pdf");
    if (exact) {
        suggest_swapped(g, s, clues);
        suggest_alphas(g, clues);
        suggest_coat(g, clues);
    }
}
