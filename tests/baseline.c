/* baseline.c - what the procedures of others have in common */
#include "tests/baseline.h"

#include <gsl/gsl_cdf.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/rng.h"

bool baseline_draw(struct baseline_draws *d, const struct bsdf *b,
                   struct vec3 wo, uint64_t samples, uint64_t seed)
{
    uint64_t stream;
    memcpy(&stream, &wo.x, sizeof stream);
    const struct rng rng = { seed, stream ^ 0x62617365 };
    *d = (struct baseline_draws){ .samples = samples };
    d->wi = malloc(samples * sizeof *d->wi);
    if (!d->wi)
        return false;
    for (uint64_t i = 0; i < samples; i++) {
        const struct bsdf_sample a = bsdf_sample(b, wo, rng_uniform(rng, i));
        if (!a.delta && !spectrum_is(a.weight, BANDS_MAX, 0))
            d->wi[d->kept++] = a.wi;
    }
    return true;
}

void baseline_draws_clear(struct baseline_draws *d)
{
    free(d->wi);
    *d = (struct baseline_draws){ 0 };
}

int baseline_index(double x, int n)
{
    const double at = floor(x * n);
    return at >= n ? n - 1 : at > 0 ? (int)at : 0;
}

/* -- Simpson --------------------------------------------------------------- */

typedef double line_fn(double x, const void *context);

struct panel {
    double a, c, fa, fb, fc, whole; /* ends, f there and between, Simpson's */
};

static double halve(line_fn *f, const void *context, struct panel p,
                    double tolerance, int depth)
{
    const double b = (p.a + p.c) / 2, h = p.c - p.a;
    const double fd = f((p.a + b) / 2, context);
    const double fe = f((b + p.c) / 2, context);
    const double left = h / 12 * (p.fa + 4 * fd + p.fb);
    const double right = h / 12 * (p.fb + 4 * fe + p.fc);
    const double off = left + right - p.whole;
    if (depth == 0 || fabs(off) < 15 * tolerance)
        return left + right + off / 15;
    return halve(f, context, (struct panel){ p.a, b, p.fa, fd, p.fb, left },
                 tolerance / 2, depth - 1) +
           halve(f, context, (struct panel){ b, p.c, p.fb, fe, p.fc, right },
                 tolerance / 2, depth - 1);
}

static double line(line_fn *f, const void *context, double a, double c)
{
    const double fa = f(a, context), fb = f((a + c) / 2, context);
    const double fc = f(c, context);
    const double whole = (c - a) / 6 * (fa + 4 * fb + fc);
    return halve(f, context, (struct panel){ a, c, fa, fb, fc, whole }, 1e-6,
                 6);
}

struct rows {
    double (*f)(double x, double y, const void *context);
    const void *context;
    double x0, x1, y;
};

static double in_row(double x, const void *context)
{
    const struct rows *r = context;
    return r->f(x, r->y, r->context);
}

static double row(double y, const void *context)
{
    struct rows r = *(const struct rows *)context;
    r.y = y;
    return line(in_row, &r, r.x0, r.x1);
}

double baseline_simpson(double (*f)(double x, double y, const void *context),
                        const void *context, double x0, double y0, double x1,
                        double y1)
{
    const struct rows r = { f, context, x0, x1, 0 };
    return line(row, &r, y0, y1);
}

/* -- deciding -------------------------------------------------------------- */

static int by_expected(const void *a, const void *b, void *context)
{
    const struct baseline_cells *c = context;
    const double x = c->expected[*(const int *)a];
    const double y = c->expected[*(const int *)b];
    return (x > y) - (x < y);
}

void baseline_sort(const struct baseline_cells *c, int *order)
{
    const int n = c->rows * c->columns;
    for (int i = 0; i < n; i++)
        order[i] = i;
    qsort_r(order, (size_t)n, sizeof *order, by_expected, (void *)c);
}

struct baseline_verdict baseline_decide(const struct baseline_cells *c,
                                        uint64_t samples)
{
    static const double least = 5, level = 0.01, directions = 5;
    static _Thread_local int order[BASELINE_CELLS_MAX];
    struct baseline_verdict v = { .p = NAN };
    double chi2 = 0, pool_observed = 0, pool_expected = 0;
    baseline_sort(c, order);
    for (int i = 0; i < c->rows * c->columns; i++) {
        const double e = c->expected[order[i]], o = c->observed[order[i]];
        if (e < 0) {
            v.why = "a negative mass";
            return v;
        }
        if (e == 0) {
            if (o > 1e-5 * (double)samples) {
                v.why = "samples where none are expected";
                return v;
            }
        } else if (e < least || (pool_expected > 0 && pool_expected < least)) {
            pool_observed += o;
            pool_expected += e;
        } else {
            chi2 += (o - e) * (o - e) / e;
            v.degrees++;
        }
    }
    if (pool_expected > 0 || pool_observed > 0) {
        chi2 += (pool_observed - pool_expected) *
                (pool_observed - pool_expected) / pool_expected;
        v.degrees++;
    }
    if (--v.degrees <= 0) {
        v.why = "no degree of freedom";
        return v;
    }
    v.p = gsl_cdf_chisq_Q(chi2, (double)v.degrees);
    v.passed = v.p >= 1 - pow(1 - level, 1 / directions);
    return v;
}
