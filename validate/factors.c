/* factors.c - factors as functions of a clue */
#include "validate/factors.h"

#include <stdlib.h>

static double two(const struct clue *c)
{
    (void)c;
    return 2;
}

static double four(const struct clue *c)
{
    (void)c;
    return 4;
}

static double pi(const struct clue *c)
{
    (void)c;
    return PI;
}

static double one(const struct clue *c)
{
    (void)c;
    return 1;
}

static double cos_i(const struct clue *c)
{
    return c->cos_i;
}

static double cos_o(const struct clue *c)
{
    return c->cos_o;
}

static double cos_h(const struct clue *c)
{
    return c->cos_h;
}

static double wi_h(const struct clue *c)
{
    return c->wi_h;
}

static double four_wi_h(const struct clue *c)
{
    return 4 * c->wi_h;
}

static double eta2(const struct clue *c)
{
    return c->eta2;
}

static double eta2_back(const struct clue *c)
{
    return 1 / c->eta2;
}

static double share(const struct clue *c)
{
    return c->share;
}

static double not_known(const struct clue *c)
{
    (void)c;
    return NAN;
}

static double g1_o(const struct clue *c)
{
    return c->g1_o;
}

static double g1_i(const struct clue *c)
{
    return c->g1_i;
}

static double g1_both(const struct clue *c)
{
    return c->g1_o * c->g1_i;
}

const struct factor factors[] = {
    { "2", two, two },
    { "4", four, four },
    { "pi", pi, pi },
    { "cos_i", cos_i, cos_o },
    { "cos_o", cos_o, cos_i },
    { "cos_h", cos_h, cos_h },
    { "4 wi.h", four_wi_h, four_wi_h },
    { "wi.h", wi_h, wi_h },
    { "eta^2", eta2, eta2_back },
    { "lobe probability", share, not_known },
    { "G1(wo)", g1_o, g1_i },
    { "G1(wi)", g1_i, g1_o },
    { "G1(wo) G1(wi)", g1_both, one },
    { 0 },
};

bool clue_in(const struct clue *c, enum clue_scope scope)
{
    return scope == SCOPE_ALL || (scope == SCOPE_TRANSMISSION) == c->through;
}

double factors_explain(const struct clues *clues, enum clue_scope scope,
                       const double *predicted)
{
    double before = 0, after = 0;
    for (size_t i = 0; i < clues->n; i++) {
        if (!clue_in(&clues->clue[i], scope))
            continue;
        const double x = log(clues->clue[i].ratio);
        const double left = x - predicted[i];
        before += x * x;
        after += left * left;
    }
    return before > 0 && isfinite(after) ? 1 - after / before : -INFINITY;
}

struct ordered {
    double angle, x;
};

static int by_angle(const void *a, const void *b)
{
    const double x = ((const struct ordered *)a)->angle;
    const double y = ((const struct ordered *)b)->angle;
    return (x > y) - (x < y);
}

double factors_explain_by(const struct clues *clues, enum clue_scope scope,
                          double (*angle)(const struct clue *c))
{
    enum { AROUND = 2 };
    struct ordered *o = malloc((clues->n + 1) * sizeof *o);
    size_t n = 0;
    double before = 0, after = 0;
    for (size_t i = 0; o && i < clues->n; i++)
        if (clue_in(&clues->clue[i], scope))
            o[n++] = (struct ordered){ angle(&clues->clue[i]),
                                       log(clues->clue[i].ratio) };
    if (n > 0)
        qsort(o, n, sizeof *o, by_angle);
    /* A constant is no function of an angle. */
    double mean = 0;
    for (size_t i = 0; i < n; i++)
        mean += o[i].x / (double)n;
    for (size_t i = 0; i < n; i++)
        o[i].x -= mean;
    for (size_t i = AROUND; i + AROUND < n; i++) {
        double sum = 0;
        for (size_t k = i - AROUND; k <= i + AROUND; k++)
            sum += k == i ? 0 : o[k].x;
        const double left = o[i].x - sum / (2 * AROUND);
        before += o[i].x * o[i].x;
        after += left * left;
    }
    free(o);
    /* Four neighbours share a quarter of the noise. */
    return n > 32 && before > 0 ? 1 - after / (1.25 * before) : -INFINITY;
}
