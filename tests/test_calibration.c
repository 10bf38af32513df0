/* test_calibration.c - the verdicts are as sure as they say, in short
 *
 * What `make calibrate` and `make power` do at length, and what they reckon
 * with.
 */
#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "tests/broken.h"
#include "tests/calibration.h"
#include "tests/chart.h"
#include "tests/close.h"
#include "tests/detection.h"
#include "tests/publish.h"
#include "tests/uniformity.h"

/* The first series of uniformity.c in 40 digits; the table of N. Smirnov,
 * Annals of Mathematical Statistics 19(2), 1948, has .27 at 1. */
static void kolmogorov_is_what_it_is(void **state)
{
    (void)state;
    assert_close(kolmogorov_tail(0.5), 0.9639452436648751, 1e-14);
    assert_close(kolmogorov_tail(1), 0.26999967167735456, 1e-14);
    assert_close(kolmogorov_tail(1.3581), 0.05, 1e-5);
    assert_close(kolmogorov_tail(2) / 0.00067092525577969527, 1, 1e-13);
    assert_true(kolmogorov_tail(0) == 1 && kolmogorov_tail(30) == 0);
    assert_true(kolmogorov_tail(NAN) == 0);
    assert_close(kolmogorov_tail(1 - 1e-9), kolmogorov_tail(1 + 1e-9), 1e-8);
}

/* In fractions; .36866 is the 5 % point for ten in L. Miller, Table of
 * Percentage Points of Kolmogorov Statistics, JASA 51, 1956. */
static void smirnov_is_exact(void **state)
{
    (void)state;
    assert_close(smirnov_tail(1, 0.3), 0.7, 1e-15);
    assert_close(smirnov_tail(2, 0.3), 0.61, 1e-15);
    assert_close(smirnov_tail(10, 0.36866), 0.05, 1e-5);
    assert_true(smirnov_tail(10, 0) == 1 && smirnov_tail(10, 1) == 0);
    /* exp(-2 n d^2) for many. */
    assert_close(smirnov_tail(10000, 0.02) / exp(-8), 1, 0.02);
}

static void clopper_and_pearson_are_exact(void **state)
{
    (void)state;
    const struct interval none = clopper_pearson(0, 50, .025);
    const struct interval all = clopper_pearson(50, 50, .025);
    assert_true(none.low == 0 && all.high == 1);
    assert_close(none.high, 1 - pow(.025, 1. / 50), 1e-12);
    assert_close(all.low, pow(.025, 1. / 50), 1e-12);
    /* The binomial tails at the ends are what is left out. */
    const struct interval some = clopper_pearson(3, 20, .025);
    double above = 0, below = 0;
    static const double choose[] = { 1, 20, 190, 1140 };
    for (int k = 0; k <= 3; k++) {
        if (k < 3)
            above += choose[k] * pow(some.low, k) * pow(1 - some.low, 20 - k);
        below += choose[k] * pow(some.high, k) * pow(1 - some.high, 20 - k);
    }
    assert_close(1 - above, .025, 1e-9);
    assert_close(below, .025, 1e-9);
    /* GSL's inverse of the beta distribution is NaN for some of these. */
    for (size_t n = 1000; n < 11000; n += 1760)
        for (size_t k = 1; k < n; k += 1 + k / 8) {
            const struct interval i = clopper_pearson(k, n, .025);
            const double share = (double)k / (double)n;
            assert_true(i.low > 0 && i.low < share && i.high > share &&
                        i.high < 1);
        }
}

static void what_is_not_uniform_is_noticed(void **state)
{
    (void)state;
    enum { N = 2000 };
    static double value[N];
    for (int i = 0; i < N; i++)
        value[i] = rng_uniform((struct rng){ 1, 7 }, (uint64_t)i).x;
    assert_true(uniformity_of(value, N).p > 1e-6);
    for (int i = 0; i < N; i++)
        value[i] = pow(value[i], 1.3);
    assert_true(uniformity_of(value, N).p_above < 1e-6);
    for (int i = 0; i < N; i++)
        value[i] = pow(value[i], 0.6);
    const struct uniformity large = uniformity_of(value, N);
    assert_true(large.p < 1e-6 && large.p_above > 1e-6);
    value[3] = NAN;
    assert_true(uniformity_of(value, N).p == 0);
    assert_true(uniformity_of(value, 0).p == 1);
}

/* A few hundred cases; every test at 1e-6 or less. */
static void sound_models_are_uniform(void **state)
{
    (void)state;
    static const char *const spec[] = {
        "diffuse",
        "roughconductor:alpha=0.005",
        "roughconductor:alpha=0.3,distribution=ggx,sample_visible=false",
        "roughconductor:alpha_u=0.4,alpha_v=0.05",
        "roughdielectric:alpha=0.3",
        "blendbsdf:weight=0.3,bsdf_0=(mirror),bsdf_1=(roughconductor)",
        "dielectric",
        NULL,
    };
    struct calibration c = { .spec = spec,
                             .seed = 1,
                             .rounds = 4,
                             .directions = 8,
                             .samples = 40000,
                             .often = 4 };
    struct err err;
    double room[1000];
    if (!calibration_make(&c, NULL, &err))
        fail_msg("%s", err.text);
    if (c.failure[0])
        print_error("%s\n", c.failure);
    assert_int_equal(c.cases, 224);
    assert_int_equal(c.runs_failed, 0);
    assert_int_equal(c.deterministic_failed, 0);
    assert_true(c.deterministic > 300 && c.rows >= 10);
    for (int i = 0; i < c.rows; i++) {
        const struct calibration_row *row = &c.row[i];
        const struct uniformity u =
            uniformity_of(room, calibration_values(row, -1, room));
        const bool uniform = u.p_above > 1e-6;
        bool rare = true;
        for (int k = 0; k < LEVELS; k++)
            rare &= clopper_pearson(row->small[k], row->cases, 1e-6).low <=
                    calibration_level[k];
        if (!rare || !uniform)
            fail_msg("%s %s: %zu of %zu below .05, %+.3f above uniform",
                     row->check, row->part ? row->part : "", row->small[0],
                     row->cases, u.above);
    }
    calibration_clear(&c);
}

static void caught(const char *settings, double theta_deg)
{
    struct detection d = { .type = &type_broken_metal,
                           .settings = settings,
                           .wo = dir_from_degrees(theta_deg, 40),
                           .seed = 1,
                           .runs = 5,
                           .samples = 1000000 };
    struct err err;
    if (!detection_make(&d, NULL, NULL, &err))
        fail_msg("%s", err.text);
    if (d.caught != d.runs)
        fail_msg("%s: %zu of %zu", settings, d.caught, d.runs);
    assert_true(d.least_degrees >= 50);
}

static void small_mistakes_are_caught(void **state)
{
    (void)state;
    caught("fault=pdf_factor,size=1.005,alpha=0.005", 20);
    caught("fault=sampled_alpha,size=1.01,alpha=0.05,visible=true", 20);
    caught("fault=leaks,size=0.001,alpha=0.005", 10);
}

/* Seen from the normal with all normals drawn, light is refused where the slope
 * is beyond 1: exp(-1 / alpha^2), and alpha^2 / (1 + alpha^2). */
static void the_chart_has_the_analytic_total(void **state)
{
    (void)state;
    static const char *const spec[] = {
        "roughconductor:sample_visible=false,alpha=0.7",
        "roughconductor:sample_visible=false,alpha=0.7,distribution=ggx",
    };
    const double total[] = { 1 - exp(-1 / 0.49), 1 / 1.49 };
    for (int i = 0; i < 2; i++) {
        struct err err;
        struct bsdf *b = bsdf_new(spec[i], &bands_default, &err);
        assert_non_null(b);
        const struct chart c = { b, { 0, 0, 1 }, 0.7, 0.7 };
        assert_close(chart_total(&c), total[i], 1e-10);
        const struct estimate sum =
            chart_mass(&c, (struct patch){ 0, PI / 2, -PI, PI });
        assert_close(sum.value, total[i], 1e-10);
        assert_at_most(sum.error, 1e-8);
        bsdf_free(b);
    }
}

static void masses_agree_with_the_chart(void **state)
{
    (void)state;
    static const char *const spec[] = {
        "roughconductor:alpha_u=0.005,alpha_v=0.005",
        "roughconductor:alpha_u=0.9,alpha_v=0.02,distribution=ggx",
        "roughconductor:alpha_u=0.9,alpha_v=0.02,sample_visible=false",
    };
    static const double alpha[][2] = { { .005, .005 },
                                       { .9, .02 },
                                       { .9, .02 } };
    for (size_t i = 0; i < 6; i++) {
        struct err err;
        struct subject s;
        struct plan plan = plan_default;
        plan.samples = 1000;
        struct bsdf *b = bsdf_new(spec[i % 3], &bands_default, &err);
        const struct vec3 wo = calibration_direction(1, 103, i, false);
        assert_non_null(b);
        assert_true(subject_init(&s, b, wo, &plan, &err));
        const struct survey *v = &s.survey;
        const struct chart c = { b, wo, alpha[i % 3][0], alpha[i % 3][1] };
        assert_close(v->total.value, chart_total(&c), 1e-7);
        for (size_t k = i; k < partition_bins(v->partition); k += 20) {
            const struct patch p = partition_patch(v->partition, k);
            if (p.theta1 <= PI / 2)
                assert_close(v->mass[k].value, chart_mass(&c, p).value, 1e-7);
        }
        subject_clear(&s);
        bsdf_free(b);
    }
}

static void put(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    assert_int_equal(fclose(f), 0);
}

static void has(const char *path, const char *expected)
{
    char text[400] = "";
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    fclose(f);
    assert_string_equal(text, expected);
}

static void results_go_between_their_markers(void **state)
{
    (void)state;
    char path[] = "/tmp/bsdf-publish-XXXXXX";
    struct err err;
    const int made = mkstemp(path);
    assert_true(made >= 0);
    close(made);
    put(path, "a\n<!-- x -->\nold\n<!-- /x -->\nb\n<!-- y -->\n<!-- /y -->\n");
    assert_true(publish(path, "x", "new\nlines\n", &err));
    has(path, "a\n<!-- x -->\nnew\nlines\n<!-- /x -->\nb\n<!-- y -->\n"
              "<!-- /y -->\n");
    assert_true(publish(path, "y", "more\n", &err));
    assert_false(publish(path, "z", "none\n", &err));
    assert_has(err.text, "<!-- z -->");
    static const char *const wrong[] = {
        "<!-- x -->\nno end\n",
        "<!-- /x -->\n<!-- x -->\n",
        "<!-- x -->\n<!-- x -->\n<!-- /x -->\n",
        "<!-- x -->\n<!-- /x -->\n<!-- x -->\n<!-- /x -->\n",
    };
    for (int i = 0; i < 4; i++) {
        put(path, wrong[i]);
        assert_false(publish(path, "x", "none\n", &err));
        has(path, wrong[i]);
    }
    assert_false(publish("/nowhere/at/all", "x", "", &err));
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "Kolmogorov's distribution has its digits",
          kolmogorov_is_what_it_is },
        { "Smirnov's distribution is exact", smirnov_is_exact },
        { "Clopper and Pearson's intervals are exact",
          clopper_and_pearson_are_exact },
        { "what is not uniform is noticed", what_is_not_uniform_is_noticed },
        { "results go between their markers, or nowhere",
          results_go_between_their_markers },
        { "the chart has the analytic total",
          the_chart_has_the_analytic_total },
        { "masses of bins agree with the chart", masses_agree_with_the_chart },
        { "half a percent, one percent, and a leak are caught",
          small_mistakes_are_caught },
        { "p-values of sound models are uniform", sound_models_are_uniform },
    };
    gsl_set_error_handler_off();
    return cmocka_run_group_tests_name("calibration", tests, NULL, NULL);
}
