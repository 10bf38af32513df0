/* facets.c - linear fits to densities of normals */
#include "validate/facets.h"

#include <gsl/gsl_multifit.h>
#include <stdlib.h>

#include "bsdf/ndf.h"

enum { TERMS = 3 };

struct row {
    double x2, y2; /* squares of the slopes */
    double d;      /* D, up to a factor */
};

/* Coefficients of y = c0 + c1 x2 + c2 y2 with weights; false when out of
 * memory. */
static bool linear(const struct row *row, size_t n, const double *y,
                   const double *weight, double c[TERMS])
{
    gsl_multifit_linear_workspace *space = gsl_multifit_linear_alloc(n, TERMS);
    gsl_matrix *x = gsl_matrix_alloc(n, TERMS);
    gsl_matrix *covariance = gsl_matrix_alloc(TERMS, TERMS);
    gsl_vector *at = gsl_vector_alloc(TERMS);
    const bool ok = space && x && covariance && at;
    if (ok) {
        double chi2;
        const gsl_vector_const_view values = gsl_vector_const_view_array(y, n);
        const gsl_vector_const_view weights =
            gsl_vector_const_view_array(weight, n);
        for (size_t i = 0; i < n; i++) {
            gsl_matrix_set(x, i, 0, 1);
            gsl_matrix_set(x, i, 1, row[i].x2);
            gsl_matrix_set(x, i, 2, row[i].y2);
        }
        gsl_multifit_wlinear(x, &weights.vector, &values.vector, at, covariance,
                             &chi2, space);
        for (int k = 0; k < TERMS; k++)
            c[k] = gsl_vector_get(at, (size_t)k);
    }
    gsl_vector_free(at);
    gsl_matrix_free(covariance);
    gsl_matrix_free(x);
    gsl_multifit_linear_free(space);
    return ok;
}

/* What of the density there is at most this far below its largest is heeded:
 * the far tail of a Gaussian has no digits left. */
static const double depth = 1e-8;

static bool fit_family(const struct row *row, size_t n, const struct ndf *ndf,
                       struct facets_fit *fit)
{
    const bool beckmann = ndf == &ndf_beckmann;
    double *y = malloc(2 * n * sizeof *y), *weight = y ? y + n : NULL, c[TERMS];
    if (!y)
        return false;
    for (size_t i = 0; i < n; i++) {
        y[i] = beckmann ? log(row[i].d) : 1 / sqrt(row[i].d);
        weight[i] = beckmann ? 1 : row[i].d;
    }
    bool ok = linear(row, n, y, weight, c);
    fit->ndf = ndf;
    fit->off = 0;
    /* -1 / alpha^2 for Beckmann, c0 / alpha^2 for GGX */
    const double u2 = beckmann ? -1 / c[1] : c[0] / c[1];
    const double v2 = beckmann ? -1 / c[2] : c[0] / c[2];
    ok = ok && u2 > 0 && v2 > 0 && isfinite(u2 + v2);
    for (size_t i = 0; ok && i < n; i++) {
        const double line = c[0] + c[1] * row[i].x2 + c[2] * row[i].y2;
        const double off =
            beckmann ? exp(line - y[i]) - 1 : y[i] * y[i] / (line * line) - 1;
        fit->off = fmax(fit->off, fabs(off));
    }
    fit->alpha_u = sqrt(u2);
    fit->alpha_v = sqrt(v2);
    fit->scale =
        (beckmann ? exp(c[0]) : 1 / (c[0] * c[0])) * PI * sqrt(u2 * v2);
    free(y);
    return ok;
}

static bool fit_rows(struct row *row, size_t n, struct facets_fit *best)
{
    const struct ndf *const families[] = { &ndf_beckmann, &ndf_ggx };
    double most = 0;
    size_t kept = 0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, row[i].d);
    for (size_t i = 0; i < n; i++)
        if (row[i].d > depth * most)
            row[kept++] = row[i];
    best->off = INFINITY;
    for (int k = 0; k < 2 && kept > 4 * TERMS; k++) {
        struct facets_fit fit = { .visible = best->visible };
        if (fit_family(row, kept, families[k], &fit) && fit.off < best->off)
            *best = fit;
    }
    return best->off < 0.02;
}

static struct row row_of(struct vec3 m, double d)
{
    const double x = m.x / m.z, y = m.y / m.z, c2 = m.z * m.z;
    return (struct row){ x * x, y * y, d * c2 * c2 };
}

bool facets_fit(const struct clue *clue, const double *density, size_t n,
                struct facets_fit *fit)
{
    struct row *row = malloc((n + 1) * sizeof *row);
    fit->off = INFINITY;
    for (int visible = 0; row && visible < 2; visible++) {
        struct facets_fit one = { .visible = visible };
        size_t rows = 0;
        for (size_t i = 0; i < n; i++) {
            const struct clue *c = &clue[i];
            if (c->through || !(density[i] > 0) || !isfinite(density[i]))
                continue;
            /* Per solid angle of the normal; then without what they were
             * chosen by. */
            const double normals = density[i] / c->jacobian;
            row[rows++] =
                row_of(c->m, normals / (visible ? c->wo_h : c->cos_h));
        }
        if (fit_rows(row, rows, &one) && one.off < fit->off)
            *fit = one;
    }
    free(row);
    return fit->off < 0.02;
}

bool facets_fit_shown(const struct subject *s, struct facets_fit *fit)
{
    enum { N = 12 };
    struct row row[N * N];
    size_t n = 0;
    if (!bsdf_has_facets(s->bsdf))
        return false;
    for (int i = 0; i < N; i++)
        for (int k = 0; k < N; k++) {
            const double theta_deg = 0.01 * pow(8000, (i + 0.5) / N);
            const struct vec3 m =
                dir_from_degrees(theta_deg, 360. * k / N + 11);
            const double d = bsdf_facet_d(s->bsdf, m);
            if (d > 0 && isfinite(d))
                row[n++] = row_of(m, d);
        }
    fit->visible = false;
    return fit_rows(row, n, fit);
}
