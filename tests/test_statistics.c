/* test_statistics.c - p-values, and what is made of many of them */
#include <math.h>

#include "tests/close.h"
#include "validate/pvalue.h"
#include "validate/run.h"

/* Chi-square with 2 degrees of freedom: Q(x) = exp(-x / 2), to where 1 - CDF
 * has no digit left. */
static void chi_square_tails_have_digits(void **state)
{
    (void)state;
    assert_close(pvalue_chi_square(3, 2), exp(-1.5), 1e-15);
    assert_close(pvalue_chi_square(400, 2) / exp(-200), 1, 1e-12);
    assert_close(pvalue_chi_square(1e5, 2), 1e-300, 0);
    assert_true(pvalue_chi_square(5, 0) == 1);
}

/* 0 of 20 at q = 0.3: 2 (0.7)^20. */
static void binomial_tails_are_exact(void **state)
{
    (void)state;
    assert_close(pvalue_binomial(0, 20, (struct estimate){ 0.3, 0 }) /
                     (2 * pow(0.7, 20)),
                 1, 1e-12);
    assert_true(pvalue_binomial(6, 20, (struct estimate){ 0.3, 0 }) > 0.9);
    assert_true(pvalue_binomial(0, 1000, (struct estimate){ 0, 0 }) == 1);
    assert_true(pvalue_binomial(1, 1000, (struct estimate){ 0, 0 }) <= 1e-300);
    assert_true(pvalue_binomial(1000, 1000, (struct estimate){ 1, 0 }) == 1);
    /* GSL's own tail is NaN here. */
    assert_true(
        pvalue_binomial(5000000, 10000000, (struct estimate){ 0.5, 0 }) > 0.9);
    assert_close(
        pvalue_binomial(5001000, 10000000, (struct estimate){ 0.5, 0 }),
        erfc(1000 / sqrt(5e6)), 2e-3);
}

/* The error is read in favour of what was counted, and no further. */
static void the_error_counts_in_favour(void **state)
{
    (void)state;
    assert_true(pvalue_binomial(0, 1000, (struct estimate){ -1e-9, 1e-8 }) ==
                1);
    assert_true(pvalue_binomial(0, 1000, (struct estimate){ -1e-6, 1e-8 }) <=
                1e-300);
    assert_true(pvalue_binomial(0, 1000000, (struct estimate){ 1e-4, 1e-4 }) ==
                1);
    assert_true(pvalue_binomial(0, 1000000, (struct estimate){ 2e-4, 1e-6 }) <
                1e-80);
    assert_true(pvalue_binomial(0, 1000, (struct estimate){ NAN, 0 }) <=
                1e-300);
}

static void the_best_of_many_keeps_a_nan(void **state)
{
    (void)state;
    const double p[] = { 0.5, NAN, 0.01 };
    assert_true(pvalue_best(p, 3) <= 1e-300);
    assert_true(pvalue_best(p, 1) == 0.5);
    assert_true(pvalue_best(p, 0) == 1);
}

static void sigma_is_two_sided(void **state)
{
    (void)state;
    assert_true(pvalue_sigma(1) == 0);
    assert_close(pvalue_sigma(0.31731050786291410), 1, 1e-9);
    assert_close(pvalue_sigma(1e-300), 37.0658, 1e-3);
}

static void holm_steps_down(void **state)
{
    (void)state;
    /* At .05 of 4: .01 against .0125, .016 against .0167, .03 against .025
     * stops it, and .001 behind a failure of its own is impossible. */
    struct verdict v[] = {
        { .p = 0.03 }, { .p = 0.01 }, { .p = 0.016 }, { .p = 0.04 }
    };
    struct verdict *at[] = { &v[0], &v[1], &v[2], &v[3] };
    holm(at, 4, 0.05);
    assert_true(v[0].passed && v[3].passed);
    assert_false(v[1].passed || v[2].passed);
    for (int i = 0; i < 4; i++)
        assert_int_equal(v[i].passed, v[i].value <= v[i].limit);
    holm(at, 0, 0.05);
}

static void a_significance_of_zero_is_noticed(void **state)
{
    (void)state;
    struct verdict v = { .p = 1e-300 };
    struct verdict *at = &v;
    holm(&at, 1, 1e-100);
    assert_false(v.passed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "chi-square tails have their digits", chi_square_tails_have_digits },
        { "binomial tails are exact", binomial_tails_are_exact },
        { "an error counts in favour, and no further",
          the_error_counts_in_favour },
        { "the best of many keeps a NaN", the_best_of_many_keeps_a_nan },
        { "sigma is two-sided", sigma_is_two_sided },
        { "Holm steps down and stops", holm_steps_down },
        { "the least p fails at any significance",
          a_significance_of_zero_is_noticed },
    };
    return cmocka_run_group_tests_name("statistics", tests, NULL, NULL);
}
