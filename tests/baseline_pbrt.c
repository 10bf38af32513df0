/* baseline_pbrt.c - the test of pbrt-v4, 80 x 160 cells
 *
 * Facts, from mmp/pbrt-v4 src/pbrt/bsdfs_test.cpp (00aad0a6): 80 rows of equal
 * theta by 160 columns of phi from 0, 10^6 samples; adaptive Simpson of pdf
 * sin; 1 % over 5 directions by Sidak.
 */
#include "tests/baseline.h"

enum { ROWS = 80, COLUMNS = 160 };

struct lobe {
    const struct bsdf *b;
    struct vec3 wo;
};

static double density(double theta, double phi, const void *context)
{
    const struct lobe *l = context;
    const double s = sin(theta);
    return s *
           bsdf_pdf(l->b, l->wo,
                    (struct vec3){ s * cos(phi), s * sin(phi), cos(theta) });
}

static struct baseline_verdict test(const struct bsdf *b, struct vec3 wo,
                                    const struct baseline_draws *d)
{
    static _Thread_local struct baseline_cells c;
    const struct lobe lobe = { b, wo };
    c = (struct baseline_cells){ .rows = ROWS, .columns = COLUMNS };
    for (size_t i = 0; i < d->kept; i++) {
        const double turn = atan2(d->wi[i].y, d->wi[i].x) / (2 * PI);
        const double theta = acos(fmax(-1, fmin(1, d->wi[i].z)));
        const int row = baseline_index(theta / PI, ROWS);
        const int column = baseline_index(turn < 0 ? turn + 1 : turn, COLUMNS);
        c.observed[row * COLUMNS + column]++;
    }
    for (int i = 0; i < ROWS; i++)
        for (int k = 0; k < COLUMNS; k++)
            c.expected[i * COLUMNS + k] =
                (double)d->samples *
                baseline_simpson(density, &lobe, i * PI / ROWS,
                                 k * 2 * PI / COLUMNS, (i + 1) * PI / ROWS,
                                 (k + 1) * 2 * PI / COLUMNS);
    return baseline_decide(&c, d->samples);
}

const struct baseline baseline_pbrt = {
    .name = "pbrt-v4",
    .about = "80 x 160 (theta, phi), adaptive Simpson",
    .test = test,
};
