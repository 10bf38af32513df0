/* diagnose_f.c - mistakes in f */
#include <stdlib.h>

#include "bsdf/ndf.h"
#include "validate/energy.h"
#include "validate/furnace.h"
#include "validate/guess.h"

static double angle_i(const struct clue *c)
{
    return c->cos_i;
}

static double angle_h(const struct clue *c)
{
    return c->wi_h;
}

/* How f goes with the directions changing places. */
void diagnose_reciprocity(struct guess *g, const struct subject *s,
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
        { 8, 2, "f has eta^2 upside down: times it where it is over it" },
        { 8, -2, "f has eta^2 twice" },
        { 10, 2, "doubled masking of wo: G1(wo) G1(wo) for G1(wo) G1(wi)" },
        { 11, 2, "doubled masking of wi: G1(wi) G1(wi) for G1(wo) G1(wi)" },
        { 10, 1, "missing masking G1(wi)" },
        { 11, 1, "missing masking G1(wo)" },
    };
    if (!gather(s, CLUES_RECIPROCITY, clues) || !deviates(clues, 1e-6))
        return;
    const enum clue_scope scope = scope_of(clues);
    g->exact = true;
    for (size_t i = 0; i < sizeof mistake / sizeof *mistake; i++)
        suggest(g,
                try_factor(clues, scope, &factors[mistake[i].factor],
                           mistake[i].power, true),
                "%s%s", mistake[i].text, scope_text[scope]);
    suggest_constant(g, clues, scope, "f, over f turned round,");
    /* Functions that are free to fit cost something.  Masking is one where it
     * could not be tried itself. */
    const bool masked = !isnan(clues->clue[0].g1_i);
    g->exact = false;
    suggest(g, factors_explain_by(clues, scope, angle_i) - 0.02,
            "Fresnel at the wrong angle: f turned round differs by a factor "
            "that depends on n.wi alone, as F at n.wi for wi.h%s would%s",
            masked ? "" : ", or masking of one direction,", scope_text[scope]);
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
void diagnose_facets(struct guess *g, const struct subject *s,
                     struct clues *clues)
{
    enum { MASKINGS = sizeof maskings / sizeof *maskings };
    struct facets_fit fit;
    double ratio[CLUES_MAX];
    struct implied f[MASKINGS][2], right = { INFINITY, 0 };
    if (clues->fit)
        fit = *clues->fit;
    else if (!facets_fit_shown(s, &fit) && !fit_drawn(s, clues, &fit))
        return;
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

static double largest_albedo(const struct subject *s)
{
    const struct energy *e = subject_energy(s);
    double most = 0;
    for (int b = 0; e && b < bsdf_bands(s->bsdf)->count; b++)
        most = fmax(most, e->albedo[b].value);
    return most;
}

/* An albedo above 1, and nothing else wrong: a constant, if it is above 1 from
 * straight above as well. */
void diagnose_constant(struct guess *g, const struct subject *s)
{
    const unsigned matt = BSDF_DIFFUSE_REFLECTION | BSDF_DIFFUSE_TRANSMISSION;
    const double limit = 1 + 1e-6, most = largest_albedo(s);
    if (!(most > limit) || most > 4 * PI ||
        !(s->claims.lobes & ~(unsigned)BSDF_DELTA))
        return;
    struct plan few = *s->plan;
    struct subject above;
    struct err err;
    few.samples = 1000;
    if (!subject_init(&above, s->bsdf, (struct vec3){ 0, 0, 1 }, &few, &err))
        return;
    const double there = largest_albedo(&above);
    subject_clear(&above);
    static const struct {
        const char *name;
        double value;
    } constant[] = { { "pi", PI }, { "2", 2 }, { "4", 4 }, { "4 pi", 4 * PI } };
    const int k = !(s->claims.lobes & ~matt) && most <= PI * limit ? 0
                  : most <= 2 * limit                              ? 1
                  : most <= 4 * limit                              ? 2
                                                                   : 3;
    if (there <= limit)
        suggest_rank(g, 0.85,
                     "f is too large toward the horizon alone, as where "
                     "masking is missing or a cosine is divided by: the albedo "
                     "is %.3g here, %.3g from straight above",
                     most, there);
    else
        suggest_rank(g, 0.85,
                     "f lacks a division by a constant of at least %.3g: the "
                     "factor %s too many would give an albedo of %.3g",
                     most, constant[k].name, most / constant[k].value);
}

static const char *constant_name(double x)
{
    return near(x, 2) || near(x, 0.5)       ? "2"
           : near(x, 4) || near(x, 0.25)    ? "4"
           : near(x, PI) || near(x, 1 / PI) ? "pi"
                                            : NULL;
}

void diagnose_furnace(struct guess *g, const struct subject *s)
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
