/* diagnosis.c - who is to look for what, and which verdicts are told */
#include "validate/diagnosis.h"

#include <stdlib.h>

#include "validate/checks.h"
#include "validate/guess.h"

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
        guess_put(g, v);
}

void diagnose(const struct subject *s, struct verdict *verdict)
{
    struct clues *clues = malloc(sizeof *clues);
    struct guess sample = { 0 }, density = { 0 }, back = { 0 }, f = { 0 },
                 facets = { 0 }, delta = { 0 }, support = { 0 };
    if (!clues)
        return;
    struct facets_fit fit;
    clues->fit = NULL;
    if (!bsdf_has_facets(s->bsdf) && fit_drawn(s, clues, &fit))
        clues->fit = &fit;
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
        diagnose_support(&support, s);
    if (failed(verdict, "energy") && !guess_named(&facets))
        diagnose_facets(&f, s, clues);
    put_by_name(verdict, "support", &support);
    put_by_name(verdict, "sample", &sample);
    const struct guess *where =
        guess_named(&support) && !guess_named(&density) ? &support : &density;
    put_by_name(verdict, "pdf", where);
    put_by_name(verdict, "chi2", where);
    put_by_name(verdict, "jacobian", &density);
    put_by_name(verdict, "furnace", &facets);
    put_by_name(verdict, "delta", &delta);
    put_by_name(verdict, "reciprocity", &back);
    /* Energy hears of every other mistake that may have caused it. */
    const struct guess *const causes[] = { &facets,  &f,     &sample, &back,
                                           &density, &delta, &support };
    const struct guess *best = causes[0];
    for (int i = 1; i < 7; i++)
        if (guess_named(causes[i]) && !guess_named(best))
            best = causes[i];
    struct guess constant = { 0 };
    if (!guess_named(best)) {
        diagnose_constant(&constant, s);
        if (constant.order > best->order)
            best = &constant;
    }
    put_by_name(verdict, "energy", best);
    put_by_name(verdict, "weights", best);
    free(clues);
}
