/* baseline_nori.c - the test of Nori, 10 x 20 cells
 *
 * Facts, from wjakob/nori src/chi2test.cpp (05f66eac) and wjakob/hypothesis
 * hypothesis.h (39ed9053): 10 rows of equal cosine from -1 to 1 by 20 columns
 * of phi from 0, 5000 samples for each of the 200 cells; adaptive Simpson; 1 %
 * over 5 directions by Sidak.
 */
#include "tests/baseline.h"

enum { ROWS = 10, COLUMNS = 20 };

struct lobe {
    const struct bsdf *b;
    struct vec3 wo;
};

static double density(double c, double phi, const void *context)
{
    const struct lobe *l = context;
    const double s = sqrt(fmax(1 - c * c, 0));
    return bsdf_pdf(l->b, l->wo,
                    (struct vec3){ s * cos(phi), s * sin(phi), c });
}

static struct baseline_verdict test(const struct bsdf *b, struct vec3 wo,
                                    const struct baseline_draws *d)
{
    static _Thread_local struct baseline_cells c;
    const struct lobe lobe = { b, wo };
    c = (struct baseline_cells){ .rows = ROWS, .columns = COLUMNS };
    for (size_t i = 0; i < d->kept; i++) {
        const double turn = atan2(d->wi[i].y, d->wi[i].x) / (2 * PI);
        const int row = baseline_index((d->wi[i].z + 1) / 2, ROWS);
        const int column = baseline_index(turn < 0 ? turn + 1 : turn, COLUMNS);
        c.observed[row * COLUMNS + column]++;
    }
    for (int i = 0; i < ROWS; i++)
        for (int k = 0; k < COLUMNS; k++)
            c.expected[i * COLUMNS + k] =
                (double)d->samples *
                baseline_simpson(
                    density, &lobe, -1 + i * 2.0 / ROWS, k * 2 * PI / COLUMNS,
                    -1 + (i + 1) * 2.0 / ROWS, (k + 1) * 2 * PI / COLUMNS);
    return baseline_decide(&c, d->samples);
}

const struct baseline baseline_nori = {
    .name = "Nori",
    .about = "10 x 20 (cos theta, phi), adaptive Simpson",
    .test = test,
};
