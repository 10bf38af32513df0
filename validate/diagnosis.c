/* diagnosis.c - mistakes tried on clues, the best in words */
#include "validate/diagnosis.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/fresnel.h"
#include "bsdf/ndf.h"
#include "validate/checks.h"
#include "validate/energy.h"
#include "validate/facets.h"
#include "validate/factors.h"
#include "validate/furnace.h"

/* A mistake is named where it explains at least so much. */
static const double enough = 0.8;

/* The best so far, and how it would be put.  What cannot be measured as a share
 * of a sum of squares has a rank instead, which is not shown. */
struct guess {
    double explained;
    bool measured;
    char text[200];
};

__attribute__((format(printf, 3, 4))) static void
suggest(struct guess *g, double explained, const char *format, ...)
{
    va_list args;
    if (!(explained > g->explained))
        return;
    g->explained = explained;
    g->measured = true;
    va_start(args, format);
    vsnprintf(g->text, sizeof g->text, format, args);
    va_end(args);
}

__attribute__((format(printf, 3, 4))) static void
suggest_rank(struct guess *g, double rank, const char *format, ...)
{
    va_list args;
    if (!(rank > g->explained))
        return;
    g->explained = rank;
    g->measured = false;
    va_start(args, format);
    vsnprintf(g->text, sizeof g->text, format, args);
    va_end(args);
}

static const char *const scope_text[] = { "", ", in reflection",
                                          ", in transmission" };

/* -- factors --------------------------------------------------------------- */

/* Where the deviation is: on one side only, or everywhere. */
static enum clue_scope scope_of(const struct clues *clues)
{
    double most[2] = { 0, 0 };
    bool any[2] = { false, false };
    for (size_t i = 0; i < clues->n; i++) {
        const struct clue *c = &clues->clue[i];
        most[c->through] = fmax(most[c->through], fabs(log(c->ratio)));
        any[c->through] = true;
    }
    return !any[0] || !any[1]         ? SCOPE_ALL
           : most[0] < 1e-3 * most[1] ? SCOPE_TRANSMISSION
           : most[1] < 1e-3 * most[0] ? SCOPE_REFLECTION
                                      : SCOPE_ALL;
}

/* The factor to a power, in every clue, as logarithms.  Turned round: what is
 * left of it where the ratio is that of f to f with the directions swapped. */
static double try_factor(const struct clues *clues, enum clue_scope scope,
                         const struct factor *f, double power, bool turned)
{
    double predicted[CLUES_MAX];
    for (size_t i = 0; i < clues->n; i++) {
        const struct clue *c = &clues->clue[i];
        predicted[i] = power * (log(f->at(c)) - (turned ? log(f->back(c)) : 0));
    }
    return factors_explain(clues, scope, predicted);
}

/* One constant for all. */
static void suggest_constant(struct guess *g, const struct clues *clues,
                             enum clue_scope scope, const char *what)
{
    double predicted[CLUES_MAX], sum = 0, n = 0;
    for (size_t i = 0; i < clues->n; i++)
        if (clue_in(&clues->clue[i], scope)) {
            sum += log(clues->clue[i].ratio);
            n++;
        }
    for (size_t i = 0; i < clues->n; i++)
        predicted[i] = sum / n;
    /* Anything with a name comes first. */
    suggest(g, factors_explain(clues, scope, predicted) - 1e-3,
            "%s is %.5g times what it should be%s", what, exp(sum / n),
            scope_text[scope]);
}

static void suggest_factors(struct guess *g, const struct clues *clues,
                            const char *what)
{
    const enum clue_scope scope = scope_of(clues);
    for (const struct factor *f = factors; f->name; f++) {
        const bool share = strcmp(f->name, "lobe probability") == 0;
        const bool masks = strncmp(f->name, "G1", 2) == 0;
        suggest(g, try_factor(clues, scope, f, 1, false),
                "%s%s has the %s%s too many%s",
                masks ? "doubled masking: " : "", what, share ? "" : "factor ",
                f->name, scope_text[scope]);
        suggest(g, try_factor(clues, scope, f, -1, false),
                "%s%s lacks the %s%s%s",
                masks   ? "missing masking: "
                : share ? "missing lobe probability: "
                        : "",
                what, share ? "" : "factor ", f->name, scope_text[scope]);
    }
    suggest_constant(g, clues, scope, what);
}

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

static void diagnose_sample(struct guess *g, const struct subject *s,
                            struct clues *clues)
{
    if (!clues_gather(s, CLUES_SAMPLE_PDF, NULL, NULL, clues))
        return;
    double off = 0;
    for (size_t i = 0; i < clues->n; i++)
        off = fmax(off, fabs(clues->clue[i].ratio - 1));
    if (off > 10 * subject_precision(s)) {
        suggest_one_lobe(g, s, clues);
        suggest_factors(g, clues, "a sample's pdf");
    } else if (clues_gather(s, CLUES_WEIGHT, NULL, NULL, clues)) {
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

static bool near(double a, double b)
{
    return fabs(a - b) < 0.01 * fabs(b);
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
    if (!fitted || (near(a.alpha_u, b.alpha_u) && near(a.alpha_v, b.alpha_v)))
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
    for (double eta = 1.02; eta < 3; eta += 0.01)
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

static void suggest_below(struct guess *g, const struct subject *s)
{
    const struct survey *v = &s->survey;
    const bool through = s->claims.lobes & BSDF_TRANSMISSION;
    struct estimate below = { 0, 0 };
    for (size_t i = 0; !through && i < partition_bins(v->partition); i++)
        if (patch_centre(partition_patch(v->partition, i)).z * s->wo.z < 0)
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
    if (!(total > 1.01) ||
        !clues_gather(s, CLUES_SAMPLE_PDF, NULL, NULL, clues))
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

static void suggest_refused(struct guess *g, const struct subject *s)
{
    const struct survey *v = &s->survey;
    const double refused = (double)v->refused / (double)v->samples;
    const double excess = refused - survey_refusal(v).value;
    if (excess > 1e-5 && fabs(v->total.value - 1) < 1e-4)
        suggest_rank(
            g, 0.9,
            "%.3g of the samples are refused, and the pdf integrates to 1 "
            "as if none were",
            excess);
}

static bool deviates(const struct clues *clues, double limit)
{
    for (size_t i = 0; i < clues->n; i++)
        if (fabs(log(clues->clue[i].ratio)) > limit)
            return true;
    return false;
}

static void diagnose_density(struct guess *g, const struct subject *s,
                             struct clues *clues)
{
    suggest_below(g, s);
    suggest_whole_lobes(g, s, clues);
    if (!clues_gather(s, CLUES_DENSITY, NULL, NULL, clues))
        return;
    const bool exact = clues->n >= 32;
    if (!exact && !clues_gather(s, CLUES_BINS, NULL, NULL, clues))
        return;
    if (!deviates(clues, 1e-5)) {
        suggest_refused(g, s);
        return;
    }
    suggest_factors(g, clues, "the pdf");
    if (exact) {
        suggest_swapped(g, s, clues);
        suggest_alphas(g, clues);
        suggest_coat(g, clues);
    }
    suggest_refused(g, s);
}

/* -- f --------------------------------------------------------------------- */

static double angle_i(const struct clue *c)
{
    return c->cos_i;
}

static double angle_h(const struct clue *c)
{
    return c->wi_h;
}

/* How f goes with the directions changing places. */
static void diagnose_reciprocity(struct guess *g, const struct subject *s,
                                 struct clues *clues)
{
    static const struct {
        int factor;
        double power;
        const char *text;
    } mistake[] = {
        { 3, 1, "f has the factor cos_i too many, or lacks cos_o" },
        { 3, -1, "f lacks the factor cos_i, or has cos_o too many" },
        { 8, 0.5, "f has the factor eta too many" },
        { 8, -0.5, "f lacks the factor eta" },
        { 8, 1,
          "f has the factor eta^2 too many, as without the compression of "
          "radiance, or swapped directions: it is that of wi given" },
        { 8, -1,
          "f lacks the factor eta^2, as with the compression of radiance "
          "twice" },
        { 10, 2, "doubled masking of wo: G1(wo) G1(wo) for G1(wo) G1(wi)" },
        { 11, 2, "doubled masking of wi: G1(wi) G1(wi) for G1(wo) G1(wi)" },
        { 10, 1, "missing masking G1(wi)" },
        { 11, 1, "missing masking G1(wo)" },
    };
    if (!clues_gather(s, CLUES_RECIPROCITY, NULL, NULL, clues) ||
        !deviates(clues, 1e-6))
        return;
    const enum clue_scope scope = scope_of(clues);
    for (size_t i = 0; i < sizeof mistake / sizeof *mistake; i++)
        suggest(g,
                try_factor(clues, scope, &factors[mistake[i].factor],
                           mistake[i].power, true),
                "%s%s", mistake[i].text, scope_text[scope]);
    /* Functions that are free to fit cost something. */
    suggest(g, factors_explain_by(clues, scope, angle_i) - 0.02,
            "Fresnel at the wrong angle: f turned round differs by a factor "
            "that depends on n.wi alone, as F at n.wi for wi.h would%s",
            scope_text[scope]);
    suggest(g, factors_explain_by(clues, scope, angle_h) - 0.02,
            "Fresnel at the wrong angle: f turned round differs by a factor "
            "that depends on wi.h alone, as F of one side taken for the "
            "other's would%s",
            scope_text[scope]);
}

static double fitted_d(const void *context, struct vec3 m)
{
    const struct facets_fit *f = context;
    return ndf_d(f->ndf, f->alpha_u, f->alpha_v, m);
}

static double fitted_lambda(const struct facets_fit *f, struct vec3 w)
{
    return ndf_lambda(f->ndf, f->alpha_u, f->alpha_v, w);
}

/* The course's starter code for Beckmann: pi for its root. */
static double course_lambda(const struct facets_fit *f, struct vec3 w)
{
    const double a = fabs(w.z) / hypot(f->alpha_u * w.x, f->alpha_v * w.y);
    return (exp(-a * a) / (a * PI) - erfc(a)) / 2;
}

/* Ways to mask, all as G(wo, wi). */
static double g_height(const struct facets_fit *f, struct vec3 o, struct vec3 i)
{
    return 1 / (1 + fitted_lambda(f, o) + fitted_lambda(f, i));
}

static double g_apart(const struct facets_fit *f, struct vec3 o, struct vec3 i)
{
    return 1 / (1 + fitted_lambda(f, o)) / (1 + fitted_lambda(f, i));
}

static double g_none(const struct facets_fit *f, struct vec3 o, struct vec3 i)
{
    (void)f, (void)o, (void)i;
    return 1;
}

static double g_of_wo(const struct facets_fit *f, struct vec3 o, struct vec3 i)
{
    (void)i;
    return 1 / (1 + fitted_lambda(f, o));
}

static double g_of_wi(const struct facets_fit *f, struct vec3 o, struct vec3 i)
{
    return g_of_wo(f, i, o);
}

static double g_wo_twice(const struct facets_fit *f, struct vec3 o,
                         struct vec3 i)
{
    return g_of_wo(f, o, i) * g_of_wo(f, o, i);
}

static double g_squared(const struct facets_fit *f, struct vec3 o,
                        struct vec3 i)
{
    return g_height(f, o, i) * g_height(f, o, i);
}

static double g_course(const struct facets_fit *f, struct vec3 o, struct vec3 i)
{
    return 1 / (1 + course_lambda(f, o) + course_lambda(f, i));
}

static const struct {
    const char *text; /* NULL: as it should be */
    double (*g)(const struct facets_fit *f, struct vec3 o, struct vec3 i);
} maskings[] = {
    { NULL, g_height },
    { NULL, g_apart },
    { "missing masking", g_none },
    { "missing masking of wi: G1(wo) alone", g_of_wo },
    { "missing masking of wo: G1(wi) alone", g_of_wi },
    { "doubled masking of wo: G1(wo)^2", g_wo_twice },
    { "doubled masking: G^2", g_squared },
    { "masking with pi for sqrt(pi) in Lambda", g_course },
};

/* f 4 cos_o cos_i / D seen from here and from four other directions, so that a
 * mistake in masking is not taken for a constant. */
static bool gather_facets(const struct subject *s, const struct facets_fit *fit,
                          struct clues *all)
{
    static const double theta_deg[] = { 20, 45, 65, 80 };
    struct clues *some = malloc(sizeof *some);
    all->n = 0;
    for (int i = 0; some && i < 5; i++) {
        const struct vec3 wo =
            i == 0 ? s->wo : dir_from_degrees(theta_deg[i - 1], 40);
        const struct subject from = subject_plain(s->bsdf, wo, s->plan);
        if (!clues_gather(&from, CLUES_FACETS, fitted_d, fit, some))
            continue;
        for (size_t k = 0; k < some->n && k < CLUES_MAX / 5; k++)
            all->clue[all->n++] = some->clue[k];
    }
    free(some);
    return all->n >= 64;
}

/* F as one masking implies it: how far it is from a function of one angle, rms
 * of the logarithm, and the largest. */
struct implied {
    double off, most;
};

static struct implied implied_f(struct clues *clues, const double *ratio,
                                const struct facets_fit *fit, int masking,
                                double (*angle)(const struct clue *c))
{
    struct implied f = { 0, 0 };
    double mean = 0, spread = 0;
    const double n = (double)clues->n;
    for (size_t i = 0; i < clues->n; i++) {
        struct clue *c = &clues->clue[i];
        c->ratio = ratio[i] / maskings[masking].g(fit, c->wo, c->wi);
        f.most = fmax(f.most, c->ratio);
        mean += log(c->ratio) / n;
    }
    for (size_t i = 0; i < clues->n; i++) {
        struct clue *c = &clues->clue[i];
        c->ratio /= exp(mean);
        spread += log(c->ratio) * log(c->ratio) / n;
    }
    const double by = factors_explain_by(clues, SCOPE_ALL, angle);
    f.off = spread < 1e-20 ? 0 : sqrt(spread * fmax(1 - by, 0));
    return f;
}

/* f as D G F / (4 cos_o cos_i) with one thing wrong: the masking, the angle of
 * F, or a constant. */
static void diagnose_facets(struct guess *g, const struct subject *s,
                            struct clues *clues)
{
    enum { MASKINGS = sizeof maskings / sizeof *maskings };
    struct facets_fit fit;
    double ratio[CLUES_MAX];
    struct implied f[MASKINGS][2], right = { INFINITY, 0 };
    if (!facets_fit_shown(s, &fit)) {
        double drawn[CLUES_MAX];
        if (!clues_gather(s, CLUES_DENSITY, NULL, NULL, clues))
            return;
        for (size_t i = 0; i < clues->n; i++)
            drawn[i] = clues->clue[i].share / clues->clue[i].det;
        if (!facets_fit(clues->clue, drawn, clues->n, &fit))
            return;
    }
    if (!gather_facets(s, &fit, clues))
        return;
    for (size_t i = 0; i < clues->n; i++)
        ratio[i] = clues->clue[i].ratio;
    for (int k = 0; k < MASKINGS; k++)
        for (int turn = 0; turn < 2; turn++) {
            f[k][turn] =
                implied_f(clues, ratio, &fit, k, turn ? angle_i : angle_h);
            if (!maskings[k].text && f[k][turn].off < right.off)
                right = f[k][turn];
        }
    /* Right, but for a constant. */
    if (right.off < 0.01 && right.most > 1 + 1e-6)
        suggest_rank(g, 0.99,
                     "f has the factor %s too many, or lacks what is below "
                     "its fraction bar",
                     right.most > 3.2   ? "4"
                     : right.most > 2.2 ? "pi"
                                        : "2");
    for (int k = 0; k < MASKINGS; k++)
        for (int turn = 0; turn < 2; turn++)
            if (maskings[k].text && f[k][turn].most <= 1 + 1e-4 &&
                f[k][turn].off < 0.3 * right.off) {
                const double left = f[k][turn].off / right.off;
                suggest(g, 1 - left * left, "%s%s", maskings[k].text,
                        turn ? ", and Fresnel at the wrong angle, n.wi" : "");
            }
}

/* An albedo above 1 with nothing but a constant wrong. */
static void diagnose_constant(struct guess *g, const struct subject *s)
{
    const struct energy *e = subject_energy(s);
    double most = 0;
    for (int b = 0; e && b < bsdf_bands(s->bsdf)->count; b++)
        most = fmax(most, e->albedo[b].value);
    const unsigned matt = BSDF_DIFFUSE_REFLECTION | BSDF_DIFFUSE_TRANSMISSION;
    const unsigned rough =
        matt | BSDF_GLOSSY_REFLECTION | BSDF_GLOSSY_TRANSMISSION;
    if (!(most > 1 + 1e-6) || !(s->claims.lobes & rough))
        return;
    const bool pi = !(s->claims.lobes & ~matt) && most <= PI * (1 + 1e-6);
    suggest_rank(g, 0.85,
                 "f lacks a division by a constant: the factor %s too many "
                 "would give an albedo of %.3g",
                 pi          ? "pi"
                 : most <= 2 ? "2"
                 : most <= 4 ? "4"
                             : "4 pi",
                 most / (pi          ? PI
                         : most <= 2 ? 2
                         : most <= 4 ? 4
                                     : 4 * PI));
}

static const char *constant_name(double x)
{
    return near(x, 2) || near(x, 0.5)       ? "2"
           : near(x, 4) || near(x, 0.25)    ? "4"
           : near(x, PI) || near(x, 1 / PI) ? "pi"
                                            : NULL;
}

static void diagnose_furnace(struct guess *g, const struct subject *s)
{
    struct facets_fit fit;
    if (!bsdf_has_facets(s->bsdf) || !(s->wo.z > 0))
        return;
    const struct furnace f = furnace(s);
    const double area = f.area.value, seen = f.seen.value / area;
    if (fabs(area - 1) > 1e-6)
        suggest_rank(g, 0.99, "D %s the factor %s: its furnace gives %.4g",
                     area > 1 ? "has" : "lacks",
                     constant_name(area) ? constant_name(area)
                                         : "that makes it 1",
                     area);
    if (!(fabs(seen - 1) > 1e-6) || !facets_fit_shown(s, &fit))
        return;
    /* What G1 is, against what it may have become. */
    const double shown = bsdf_facet_g1(s->bsdf, s->wo);
    const double g1 = 1 / (1 + fitted_lambda(&fit, s->wo));
    const double course = 1 / (1 + course_lambda(&fit, s->wo));
    if (near(shown, course))
        suggest_rank(g, 1,
                     "masking with pi for sqrt(pi) in Lambda: G1 is %.4g for "
                     "%.4g",
                     shown, g1);
    if (near(shown, 1))
        suggest_rank(g, 0.99, "missing masking: G1 is 1 for %.4g", g1);
    if (near(shown, g1 * g1))
        suggest_rank(g, 0.99, "doubled masking: G1 is %.4g for %.4g", shown,
                     g1);
    suggest_rank(g, 0.9, "G1 is %.4g times what D asks for", seen);
}

/* -- deltas ---------------------------------------------------------------- */

static void diagnose_delta(struct guess *g, const struct subject *s)
{
    const struct survey *v = &s->survey;
    for (int k = 0; k < v->deltas; k++) {
        const struct delta *d = &v->delta[k];
        const double drawn = (double)d->count / (double)v->samples;
        const bool through = d->wi.z * s->wo.z < 0;
        if (d->pdf > 0 && fabs(drawn / d->pdf - 1) > 0.001)
            suggest_rank(
                g, 0.9,
                "the %s direction is drawn %.4g of the time and says %.4g, "
                "%.4g times that",
                through ? "refracted" : "reflected", drawn, d->pdf,
                d->pdf / drawn);
    }
}

/* What a delta on one side adds to the mean weight of wo's samples; 0 where
 * none is drawn. */
static double delta_share(const struct bsdf *b, struct vec3 wo, bool through)
{
    enum { DRAWS = 256 };
    for (int i = 0; i < DRAWS; i++) {
        const struct vec3 u = { 0.5, 0.5, (i + 0.5) / DRAWS };
        const struct bsdf_sample a = bsdf_sample(b, wo, u);
        if (a.delta && (a.wi.z * wo.z < 0) == through)
            return a.pdf * a.weight.band[0];
    }
    return 0;
}

/* Straight through and back, where Fresnel's equations say the same both ways,
 * a weight is over eta^2 there and over 1 / eta^2 back. */
static void diagnose_transmission(struct guess *g, const struct subject *s)
{
    static const char *const texts[] = {
        "is off by the factor eta^2 one way",
        "lacks the factor eta^2 either way",
        "is off by the factor eta^2 one way, by eta^4 the other",
        "has the factor eta^2 upside down: times it for over it, either way",
    };
    const double eta2 = s->claims.eta * s->claims.eta;
    if (eta2 == 1 || !(s->claims.lobes & BSDF_DELTA_TRANSMISSION))
        return;
    const double there = delta_share(s->bsdf, (struct vec3){ 0, 0, 1 }, true);
    const double back = delta_share(s->bsdf, (struct vec3){ 0, 0, -1 }, true);
    const double power = log(there / back * eta2 * eta2) / log(eta2);
    for (int i = 0; i < 4; i++)
        if (fabs(power - (i + 1)) < 1e-3)
            suggest_rank(g, 0.99, "the weight of transmission %s", texts[i]);
}

/* Schlick's reflectance is one of the angle in the thinner medium; by that in
 * the denser one, it is another there and back. */
static void diagnose_schlick(struct guess *g, const struct subject *s)
{
    const unsigned both = BSDF_DELTA_REFLECTION | BSDF_DELTA_TRANSMISSION;
    const double eta = s->claims.eta, n = fmax(eta, 1 / eta);
    if (n == 1 || (s->claims.lobes & both) != both)
        return;
    const double cos_thin = 0.6, sine = 0.8 / n,
                 cos_dense = sqrt(1 - sine * sine);
    const double r0 = (n - 1) / (n + 1) * ((n - 1) / (n + 1));
    const double right = fresnel_schlick(cos_thin, r0);
    const double wrong = fresnel_schlick(cos_dense, r0);
    const struct vec3 wo = { sine, 0, eta > 1 ? -cos_dense : cos_dense };
    const double seen = delta_share(s->bsdf, wo, false);
    if (near(seen, wrong) && !near(seen, right))
        suggest_rank(g, 0.98,
                     "Fresnel at the wrong angle: Schlick's reflectance by the "
                     "cosine in the denser medium");
}

/* -- all of it ------------------------------------------------------------- */

static void put(struct verdict *v, const struct guess *g)
{
    if (g->explained >= enough && g->measured)
        snprintf(v->diagnosis, sizeof v->diagnosis,
                 "%s (explains %.4g %% of the deviation)", g->text,
                 100 * fmin(g->explained, 1));
    else if (g->explained >= enough)
        snprintf(v->diagnosis, sizeof v->diagnosis, "%s (fits what was seen)",
                 g->text);
    else
        snprintf(v->diagnosis, sizeof v->diagnosis,
                 "none of the known mistakes explains it%s%s",
                 g->text[0] ? "; nearest: " : "", g->text);
}

static bool failed(const struct verdict *verdict, const char *name)
{
    const struct verdict *v = &verdict[checks_find(name)];
    return v->applies && !v->passed;
}

static void put_by_name(struct verdict *verdict, const char *name,
                        const struct guess *g)
{
    struct verdict *v = &verdict[checks_find(name)];
    if (v->applies && !v->passed && !v->diagnosis[0])
        put(v, g);
}

void diagnose(const struct subject *s, struct verdict *verdict)
{
    struct clues *clues = malloc(sizeof *clues);
    struct guess sample = { 0 }, density = { 0 }, back = { 0 }, f = { 0 },
                 facets = { 0 }, delta = { 0 };
    if (!clues)
        return;
    if (failed(verdict, "sample"))
        diagnose_sample(&sample, s, clues);
    if (failed(verdict, "pdf") || failed(verdict, "chi2") ||
        failed(verdict, "jacobian"))
        diagnose_density(&density, s, clues);
    if (failed(verdict, "reciprocity") || failed(verdict, "energy"))
        diagnose_transmission(&back, s);
    if (failed(verdict, "reciprocity")) {
        diagnose_schlick(&back, s);
        diagnose_reciprocity(&back, s, clues);
    }
    if (failed(verdict, "furnace"))
        diagnose_furnace(&facets, s);
    if (failed(verdict, "delta"))
        diagnose_delta(&delta, s);
    if (failed(verdict, "support"))
        suggest_below(&density, s);
    if (failed(verdict, "support") && density.explained < enough)
        suggest_rank(&density, 0.9, "mass below the horizon, of f");
    if (failed(verdict, "energy") && facets.explained < enough)
        diagnose_facets(&f, s, clues);
    put_by_name(verdict, "support", &density);
    put_by_name(verdict, "sample", &sample);
    put_by_name(verdict, "pdf", &density);
    put_by_name(verdict, "chi2", &density);
    put_by_name(verdict, "jacobian", &density);
    put_by_name(verdict, "furnace", &facets);
    put_by_name(verdict, "delta", &delta);
    put_by_name(verdict, "reciprocity", &back);
    /* Energy hears of every other mistake that may have caused it. */
    const struct guess *const causes[] = { &facets, &f,       &sample,
                                           &back,   &density, &delta };
    const struct guess *best = causes[0];
    for (int i = 1; i < 6; i++)
        if (causes[i]->explained >= enough && best->explained < enough)
            best = causes[i];
    struct guess constant = { 0 };
    if (best->explained < enough) {
        diagnose_constant(&constant, s);
        if (constant.explained > best->explained)
            best = &constant;
    }
    put_by_name(verdict, "energy", best);
    put_by_name(verdict, "weights", best);
    free(clues);
}
