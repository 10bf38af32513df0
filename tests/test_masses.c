/* test_masses.c - integrals over bins are as good as their error says */
#include <gsl/gsl_integration.h>
#include <stdlib.h>

#include "tests/close.h"
#include "validate/subject.h"

static void polynomials_are_exact(const void *context, size_t n,
                                  const double (*x)[QUADRATURE_ORDER],
                                  const double (*y)[QUADRATURE_ORDER],
                                  double *value)
{
    (void)context;
    for (size_t rule = 0; rule < n; rule++)
        for (int i = 0; i < QUADRATURE_ORDER; i++)
            for (int k = 0; k < QUADRATURE_ORDER; k++)
                *value++ = 10 * pow(x[rule][i], 9) * 8 * pow(y[rule][k], 7);
}

static void degree_nine_is_exact(void **state)
{
    (void)state;
    struct estimate e = { 0, 0 };
    long budget = 1000;
    const struct quadrature_job job = { { 0, 1, 0, 2 }, NULL, 0, &e };
    assert_true(
        quadrature(polynomials_are_exact, NULL, 1, &job, 1, 1e-5, &budget));
    assert_close(e.value, 256, 1e-12);
    assert_int_equal(budget, 1000 - 6 * 36);
}

/* A ridge a thousandth wide along y = 0.3 + 0.37 x, in a square of GRID x GRID
 * jobs: each line x = const has SIGMA sqrt(pi) / cos of it. */
enum { GRID = 7 };
static const double sigma = 1e-3, slope = 0.37;

static void ridge(const void *context, size_t n,
                  const double (*x)[QUADRATURE_ORDER],
                  const double (*y)[QUADRATURE_ORDER], double *value)
{
    (void)context;
    for (size_t rule = 0; rule < n; rule++)
        for (int i = 0; i < QUADRATURE_ORDER; i++)
            for (int k = 0; k < QUADRATURE_ORDER; k++) {
                const double off = (y[rule][k] - 0.3 - slope * x[rule][i]) /
                                   sqrt(1 + slope * slope) / sigma;
                *value++ = exp(-off * off);
            }
}

static size_t beside(const void *mesh, size_t job, enum quadrature_side side,
                     double *x, double *y)
{
    static const int step[][2] = { { -1, 0 }, { 1, 0 }, { 0, -1 }, { 0, 1 } };
    const int row = (int)job / GRID + step[side][0];
    const int column = (int)job % GRID + step[side][1];
    (void)mesh, (void)x, (void)y;
    return row < 0 || row == GRID || column < 0 || column == GRID
               ? QUADRATURE_NONE
               : (size_t)(row * GRID + column);
}

/* From one hint on it, at x = 0.5. */
static void a_ridge_is_followed(void **state)
{
    (void)state;
    const double whole = sigma * sqrt(PI) * sqrt(1 + slope * slope);
    struct estimate e = { 0, 0 };
    struct quadrature_hint hint = { 0.5, 0.3 + slope * 0.5, 1 };
    struct quadrature_job job[GRID * GRID];
    long budget = 10000000;
    for (int i = 0; i < GRID * GRID; i++) {
        const double x = i / GRID, y = i % GRID;
        job[i] = (struct quadrature_job){
            { x / GRID, (x + 1) / GRID, y / GRID, (y + 1) / GRID }, NULL, 0, &e
        };
    }
    const int at = GRID / 2 * GRID + (int)(hint.y * GRID);
    job[at].hint = &hint;
    job[at].n = 1;
    assert_true(quadrature_joined(ridge, NULL, 1, job, GRID * GRID, beside,
                                  NULL, 1e-10, &budget));
    assert_close(e.value, whole, 1e-8);

    const struct quadrature_job one = { { 0, 1, 0, 1 }, &hint, 1, &e };
    e = (struct estimate){ 0, 0 };
    assert_true(quadrature(ridge, NULL, 1, &one, 1, 1e-10, &budget));
    assert_close(e.value, whole, 1e-8);
    assert_true(budget > 8000000);
}

static void a_mesh_never_more_than_doubles(void **state)
{
    (void)state;
    const double edge[] = { 0, 1, 1.001, 1.0015, 3, 3.2 };
    double graded[200];
    const size_t n = mesh_grade(edge, 6, 0.5, graded, 200);
    size_t given = 0;
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 6; k++)
            given += graded[i] == edge[k];
    assert_int_equal(given, 6);
    /* As wide as twice the interval beyond, and what lies between. */
    for (size_t i = 0, k = 0; i + 1 < n; i++) {
        const double width = graded[i + 1] - graded[i];
        assert_true(width > 0);
        assert_at_most(width, 0.5 + 1e-12);
        while (graded[i] >= edge[k + 1])
            k++;
        if (k > 0)
            assert_at_most(width, 2 * (graded[i] - edge[k - 1]) + 1e-12);
        if (k < 4)
            assert_at_most(width, 2 * (edge[k + 2] - graded[i + 1]) + 1e-12);
    }
    assert_int_equal(mesh_grade(edge, 6, 1e-9, graded, 10), 10);
    assert_true(graded[9] == 3.2);
}

static struct subject survey(const char *spec, struct bsdf **b, double theta,
                             double phi)
{
    struct subject s;
    struct err err;
    static struct plan plan;
    plan = plan_default;
    plan.samples = 1000;
    *b = bsdf_new(spec, &bands_default, &err);
    if (!*b)
        fail_msg("%s", err.text);
    if (!subject_init(&s, *b, dir_from_degrees(theta, phi), &plan, &err))
        fail_msg("%s", err.text);
    return s;
}

/* Seen from the normal, all normals sampled: theta_i = 2 theta_h, and the share
 * of Beckmann normals within theta_h is 1 - exp(-tan^2(theta_h) / alpha^2). */
static void bins_at_the_normal_are_what_they_are(void **state)
{
    (void)state;
    static const char *const spec[] = {
        "roughconductor:sample_visible=false,alpha=0.001",
        "roughconductor:sample_visible=false,alpha=0.03",
        "roughconductor:sample_visible=false,alpha=1",
    };
    static const double alpha[] = { 0.001, 0.03, 1 };
    for (int i = 0; i < 3; i++) {
        struct bsdf *b;
        struct subject s = survey(spec[i], &b, 0, 0);
        const struct survey *v = &s.survey;
        for (size_t k = 0; k < partition_bins(v->partition); k++) {
            const struct patch p = partition_patch(v->partition, k);
            const double t0 = tan(p.theta0 / 2), t1 = tan(p.theta1 / 2);
            const double a2 = alpha[i] * alpha[i];
            const double share = p.theta0 >= PI / 2
                                     ? 0
                                     : exp(-t0 * t0 / a2) - exp(-t1 * t1 / a2);
            assert_close(v->mass[k].value, share * (p.phi1 - p.phi0) / (2 * PI),
                         1e-10);
        }
        assert_at_most(v->total.error, 2e-7); /* 1e-7 is always in it */
        subject_clear(&s);
        bsdf_free(b);
    }
}

struct nested {
    const struct bsdf *b;
    struct vec3 wo;
    double theta, phi0, phi1;
    gsl_integration_cquad_workspace *inner;
};

static double pdf_at_phi(double phi, void *context)
{
    const struct nested *n = context;
    return bsdf_pdf(n->b, n->wo,
                    (struct vec3){ sin(n->theta) * cos(phi),
                                   sin(n->theta) * sin(phi), cos(n->theta) });
}

static double pdf_at_theta(double theta, void *context)
{
    struct nested *n = context;
    gsl_function f = { pdf_at_phi, n };
    double value;
    n->theta = theta;
    gsl_integration_cquad(&f, n->phi0, n->phi1, 1e-14, 1e-10, n->inner, &value,
                          NULL, NULL);
    return value * sin(theta);
}

/* Every bin within 1e-7 of GSL's doubly adaptive Clenshaw-Curtis, from the
 * normal to 89.9 degrees, alpha 1e-3 to 1, and the sum of the errors too. */
static void bins_agree_with_gsl(void **state)
{
    (void)state;
    static const char *const spec[] = {
        "roughconductor:alpha=0.001",
        "roughconductor:alpha=0.001,distribution=ggx",
        "roughconductor:alpha=0.05,sample_visible=false",
        "roughconductor:alpha=1,distribution=ggx",
        "roughconductor:alpha=1,sample_visible=false",
    };
    static const double theta_deg[] = { 0, 30, 75, 89, 89.9 };
    gsl_integration_cquad_workspace *outer =
        gsl_integration_cquad_workspace_alloc(100);
    gsl_integration_cquad_workspace *inner =
        gsl_integration_cquad_workspace_alloc(100);
    for (int i = 0; i < 25; i++) {
        struct bsdf *b;
        struct subject s = survey(spec[i % 5], &b, theta_deg[i / 5], 40);
        const struct survey *v = &s.survey;
        const size_t bins = partition_bins(v->partition);
        for (size_t k = (size_t)i; k < bins; k += 37) {
            const struct patch p = partition_patch(v->partition, k);
            struct nested n = { b, s.wo, 0, p.phi0, p.phi1, inner };
            gsl_function f = { pdf_at_theta, &n };
            double value;
            gsl_integration_cquad(&f, p.theta0, p.theta1, 1e-13, 1e-9, outer,
                                  &value, NULL, NULL);
            assert_close(v->mass[k].value, value, 1e-9);
        }
        assert_at_most(v->total.error, 2e-7); /* 1e-7 is always in it */
        subject_clear(&s);
        bsdf_free(b);
    }
    gsl_integration_cquad_workspace_free(inner);
    gsl_integration_cquad_workspace_free(outer);
}

static uint32_t bin_of(const struct partition *p, struct vec3 w)
{
    uint32_t bin;
    partition_find(p, 1, (struct dirs){ &w.x, &w.y, &w.z }, &bin);
    return bin;
}

static void a_bin_holds_its_own_directions(void **state)
{
    (void)state;
    struct bsdf *b;
    struct subject s = survey("roughconductor:alpha=0.02", &b, 60, 130);
    const struct partition *p = s.survey.partition;
    for (size_t k = 0; k < partition_bins(p); k++) {
        assert_int_equal(bin_of(p, patch_centre(partition_patch(p, k))), k);
        for (int by = PARTITION_THETA; by <= PARTITION_COARSE; by++)
            assert_true(partition_group(p, (enum partition_grouping)by, k) <
                        partition_groups(p, (enum partition_grouping)by));
    }
    assert_int_equal(bin_of(p, (struct vec3){ NAN, 0, 1 }), partition_bins(p));
    subject_clear(&s);
    bsdf_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "the rules are exact to degree nine", degree_nine_is_exact },
        { "a ridge is followed from one hint", a_ridge_is_followed },
        { "a graded mesh keeps its edges and its limits",
          a_mesh_never_more_than_doubles },
        { "bins seen from the normal have their analytic masses",
          bins_at_the_normal_are_what_they_are },
        { "bins agree with GSL from the normal to 89.9 degrees",
          bins_agree_with_gsl },
        { "a bin holds its own directions", a_bin_holds_its_own_directions },
    };
    return cmocka_run_group_tests_name("masses", tests, NULL, NULL);
}
