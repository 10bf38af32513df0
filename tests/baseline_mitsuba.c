/* baseline_mitsuba.c - the test of Mitsuba 3, 50 x 101 cells or 202 x 101
 *
 * Facts, from mitsuba-renderer/mitsuba3 src/python/python/chi2.py (05547141)
 * and include/mitsuba/core/math.h: 101 rows of equal -cos(theta) by columns of
 * phi from -pi, 10^6 samples.  The documentation of `res` makes that 202
 * columns, twice the rows; the code divides where that multiplies, int(101 /
 * 2), and makes it 50.  Trapezoids of 4 x 4 nodes in each cell, moved inward by
 * 1e-4 of their spacing.  In the order of what they expect, cells below 5 are
 * pooled until the pool is above 5, then a new pool begins; one that never gets
 * there is dropped.  A cell that expects nothing but has samples fails, and so
 * does a sum of masses or samples above 1.1, a negative mass, or no degree of
 * freedom.  1 % for each direction.
 */
#include <gsl/gsl_cdf.h>

#include "tests/baseline.h"

enum { ROWS = 101, NODES = 4 };

static double mass(const struct bsdf *b, struct vec3 wo, int row, int column,
                   int columns)
{
    const double high = 2.0 / ROWS, wide = 2 * PI / columns;
    const double dy = high / (NODES - 1), dx = wide / (NODES - 1);
    double sum = 0;
    for (int i = 0; i < NODES; i++)
        for (int k = 0; k < NODES; k++) {
            const double y = -1 + row * high + (i + 1e-4) * (1 - 2e-4) * dy;
            const double phi =
                -PI + column * wide + (k + 1e-4) * (1 - 2e-4) * dx;
            const double s = sqrt(fmax(1 - y * y, 0));
            const double weight = (i % (NODES - 1) == 0 ? 0.5 : 1) *
                                  (k % (NODES - 1) == 0 ? 0.5 : 1);
            sum += weight *
                   bsdf_pdf(b, wo,
                            (struct vec3){ s * cos(phi), s * sin(phi), -y });
        }
    return sum * dx * dy;
}

/* Whether it can be tested at all. */
static const char *objection(const struct baseline_cells *c,
                             const struct baseline_draws *d)
{
    double expected = 0;
    for (int i = 0; i < c->rows * c->columns; i++) {
        if (!(c->expected[i] >= 0))
            return "a negative mass";
        if (c->expected[i] == 0 && c->observed[i] > 0)
            return "samples where none are expected";
        expected += c->expected[i];
    }
    if (expected > 1.1 * (double)d->samples ||
        (double)d->kept > 1.1 * (double)d->samples)
        return "a sum above 1.1";
    for (size_t i = 0; i < d->kept; i++)
        if (isnan(d->wi[i].z + atan2(d->wi[i].y, d->wi[i].x)))
            return "a sample that is no direction";
    return NULL;
}

static struct baseline_verdict decide(const struct baseline_cells *c,
                                      const struct baseline_draws *d)
{
    static const double least = 5, level = 0.01;
    static _Thread_local int order[BASELINE_CELLS_MAX];
    struct baseline_verdict v = { .p = NAN, .why = objection(c, d) };
    double chi2 = 0, pool_observed = 0, pool_expected = 0;
    if (v.why)
        return v;
    baseline_sort(c, order);
    for (int i = 0; i < c->rows * c->columns; i++) {
        const double e = c->expected[order[i]], o = c->observed[order[i]];
        if (e == 0)
            continue;
        if (e >= least) {
            chi2 += (o - e) * (o - e) / e;
            v.degrees++;
            continue;
        }
        pool_observed += o;
        pool_expected += e;
        if (pool_expected > least) {
            chi2 += (pool_observed - pool_expected) *
                    (pool_observed - pool_expected) / pool_expected;
            v.degrees++;
            pool_observed = pool_expected = 0;
        }
    }
    if (--v.degrees < 1) {
        v.why = "no degree of freedom";
        return v;
    }
    v.p = gsl_cdf_chisq_Q(chi2, (double)v.degrees);
    v.passed = v.p >= level;
    return v;
}

static struct baseline_verdict at(const struct bsdf *b, struct vec3 wo,
                                  const struct baseline_draws *d, int columns)
{
    static _Thread_local struct baseline_cells c;
    c = (struct baseline_cells){ .rows = ROWS, .columns = columns };
    for (size_t i = 0; i < d->kept; i++) {
        const double phi = atan2(d->wi[i].y, d->wi[i].x);
        const int row = baseline_index((1 - d->wi[i].z) / 2, ROWS);
        const int column = baseline_index((phi + PI) / (2 * PI), columns);
        c.observed[row * columns + column]++;
    }
    for (int i = 0; i < ROWS; i++)
        for (int k = 0; k < columns; k++)
            c.expected[i * columns + k] =
                (double)d->samples * mass(b, wo, i, k, columns);
    return decide(&c, d);
}

static struct baseline_verdict coarse(const struct bsdf *b, struct vec3 wo,
                                      const struct baseline_draws *d)
{
    return at(b, wo, d, 50);
}

static struct baseline_verdict fine(const struct bsdf *b, struct vec3 wo,
                                    const struct baseline_draws *d)
{
    return at(b, wo, d, 202);
}

const struct baseline baseline_mitsuba = {
    .name = "Mitsuba 3",
    .about = "50 x 101 (phi, -cos theta), 4 x 4 trapezoids",
    .test = coarse,
};

const struct baseline baseline_mitsuba_fine = {
    .name = "Mitsuba 3, as documented",
    .about = "202 x 101 (phi, -cos theta), 4 x 4 trapezoids",
    .test = fine,
};
