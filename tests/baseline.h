/* baseline.h - how others test a sampler against its pdf
 *
 * Three chi-square procedures, written from what public sources do: which grid,
 * which quadrature, which pooling, which level.  They are here to be compared
 * with the checks of validate/, see baselines.c, and are in double precision
 * where the originals are in single.
 *
 * Samples of delta lobes are left out, for none of the three is made for them,
 * and so are those whose weight is 0, as each of them does.
 */
#ifndef TESTS_BASELINE_H
#define TESTS_BASELINE_H

#include <stdint.h>

#include "bsdf/bsdf.h"

/** What was drawn, once for all procedures. */
struct baseline_draws {
    uint64_t samples;
    size_t kept;
    struct vec3 *wi; /* those that were kept */
};

/** False when out of memory.  The numbers depend on seed and wo. */
bool baseline_draw(struct baseline_draws *d, const struct bsdf *b,
                   struct vec3 wo, uint64_t samples, uint64_t seed);
void baseline_draws_clear(struct baseline_draws *d);

struct baseline_verdict {
    bool passed;
    double p;
    long degrees;
    const char *why; /* it was rejected without a p; or NULL */
};

struct baseline {
    const char *name;
    const char *about; /* grid, quadrature, level */
    struct baseline_verdict (*test)(const struct bsdf *b, struct vec3 wo,
                                    const struct baseline_draws *d);
};

/** Mitsuba 3's grid as its code makes it, 50 x 101, and as its documentation
 * says, 202 x 101. */
extern const struct baseline baseline_mitsuba, baseline_mitsuba_fine;
extern const struct baseline baseline_pbrt, baseline_nori;

/* -- what the three have in common ----------------------------------------- */

/** Cells of a grid, columns along phi, and how full they are. */
enum { BASELINE_CELLS_MAX = 202 * 101 };
struct baseline_cells {
    int rows, columns;
    double expected[BASELINE_CELLS_MAX], observed[BASELINE_CELLS_MAX];
};

/** The cell of a coordinate in [0, 1) times n, clamped; 0 for a NaN. */
int baseline_index(double x, int n);

/** Nested adaptive Simpson rule over a rectangle: tolerance 1e-6 of each
 * integral, 6 halvings at most, with Richardson's last term.
 * J. N. Lyness, Notes on the Adaptive Simpson Quadrature Routine, JACM 16(3),
 * 1969. */
double baseline_simpson(double (*f)(double x, double y, const void *context),
                        const void *context, double x0, double y0, double x1,
                        double y1);

/** Pools cells that expect fewer than 5 with the next emptiest until there are
 * 5, and tests at 1 % over 5 directions (Sidak).  A cell that expects nothing
 * fails where it has more than 1e-5 of the samples, and so does a negative one;
 * no degree of freedom fails as well.  This is pbrt's and Nori's. */
struct baseline_verdict baseline_decide(const struct baseline_cells *c,
                                        uint64_t samples);

/** The order of cells by what they expect; order is room for all. */
void baseline_sort(const struct baseline_cells *c, int *order);

#endif
