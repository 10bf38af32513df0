/* guess.c - the best explanation, and what every search for one asks */
#include "validate/guess.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "bsdf/ndf.h"

/* A mistake is named where it explains at least so much; of what is known to
 * many digits, the right one leaves next to nothing. */
static const double enough = 0.8, enough_exact = 0.98;

void suggest(struct guess *g, double explained, const char *format, ...)
{
    va_list args;
    const bool named = explained >= (g->exact ? enough_exact : enough);
    const double order = named ? explained : explained / 2;
    if (!(order > g->order))
        return;
    g->explained = explained;
    g->order = order;
    g->measured = true;
    va_start(args, format);
    vsnprintf(g->text, sizeof g->text, format, args);
    va_end(args);
}

void suggest_rank(struct guess *g, double rank, const char *format, ...)
{
    va_list args;
    if (!(rank > g->order))
        return;
    g->explained = g->order = rank;
    g->measured = false;
    va_start(args, format);
    vsnprintf(g->text, sizeof g->text, format, args);
    va_end(args);
}

double fitted_lambda(const struct facets_fit *f, struct vec3 w)
{
    return ndf_lambda(f->ndf, f->alpha_u, f->alpha_v, w);
}

/* Clues, with the masking that the facets which were fitted have. */
bool gather(const struct subject *s, enum clue_kind kind, struct clues *clues)
{
    if (!clues_gather(s, kind, NULL, NULL, clues))
        return false;
    for (size_t i = 0; clues->fit && i < clues->n; i++) {
        struct clue *c = &clues->clue[i];
        c->g1_o = 1 / (1 + fitted_lambda(clues->fit, c->wo));
        c->g1_i = 1 / (1 + fitted_lambda(clues->fit, c->wi));
    }
    return true;
}

/* The facets that samples are drawn by. */
bool fit_drawn(const struct subject *s, struct clues *clues,
               struct facets_fit *fit)
{
    double drawn[CLUES_MAX];
    if (!gather(s, CLUES_DENSITY, clues))
        return false;
    for (size_t i = 0; i < clues->n; i++)
        drawn[i] = clues->clue[i].share / clues->clue[i].det;
    return facets_fit(clues->clue, drawn, clues->n, fit);
}

const char *const scope_text[] = { "", ", in reflection", ", in transmission" };
/* Where the deviation is: on one side only, or everywhere. */
enum clue_scope scope_of(const struct clues *clues)
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
double try_factor(const struct clues *clues, enum clue_scope scope,
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
void suggest_constant(struct guess *g, const struct clues *clues,
                      enum clue_scope scope, const char *what)
{
    double predicted[CLUES_MAX], sum = 0, n = 0;
    for (size_t i = 0; i < clues->n; i++)
        if (clue_in(&clues->clue[i], scope)) {
            sum += log(clues->clue[i].ratio);
            n++;
        }
    if (!(fabs(sum / n) > 1e-3))
        return;
    for (size_t i = 0; i < clues->n; i++)
        predicted[i] = sum / n;
    /* Anything with a name comes first. */
    suggest(g, factors_explain(clues, scope, predicted) - 1e-3,
            "%s is %.5g times what it should be%s", what, exp(sum / n),
            scope_text[scope]);
}

void suggest_factors(struct guess *g, const struct clues *clues,
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
bool deviates(const struct clues *clues, double limit)
{
    for (size_t i = 0; i < clues->n; i++)
        if (fabs(log(clues->clue[i].ratio)) > limit)
            return true;
    return false;
}
bool guess_named(const struct guess *g)
{
    return g->order >= enough;
}

void guess_put(const struct guess *g, struct verdict *v)
{
    if (guess_named(g) && g->measured)
        snprintf(v->diagnosis, sizeof v->diagnosis,
                 "%s (explains %.4g %% of the deviation)", g->text,
                 100 * fmin(g->explained, 1));
    else if (guess_named(g))
        snprintf(v->diagnosis, sizeof v->diagnosis, "%s (fits what was seen)",
                 g->text);
    else
        snprintf(v->diagnosis, sizeof v->diagnosis,
                 "none of the known mistakes explains it%s%s",
                 g->text[0] ? "; nearest: " : "", g->text);
}
