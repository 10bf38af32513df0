/* test_checks.c - sound models pass, and small mistakes fail their own check
 *
 * Large ones, as renderers had them, are in mutant_table.c and test_mutants.c.
 * A run of a sound model is allowed to fail with probability 1e-6; the seeds
 * are 1, 2, 3 ... as they come.  A mistake shows in more than the check that a
 * test is named for; the sets are exact.
 */
#include <stdio.h>

#include "tests/broken.h"
#include "tests/close.h"
#include "validate/run.h"

static const struct bsdf_type *const broken[] = { &type_broken_metal,
                                                  &type_broken_mirror };
enum { METAL, FLAT };

/* The names of the checks that fail, in their order, with spaces between. */
static void failures(const struct bsdf *b, const struct vec3 *wo, size_t wos,
                     struct plan plan, char *names, size_t size)
{
    struct run run;
    struct err err;
    names[0] = '\0';
    assert_true(run_checks(&run, &plan, &b, 1, wo, wos, NULL, NULL, &err));
    for (int c = 0; c < checks_count(); c++) {
        bool failed = false;
        for (size_t i = 0; i < run.results; i++) {
            const struct verdict *v = &run.result[i].verdict[c];
            if (v->applies && !v->passed) {
                failed = true;
                print_message("    %s: %s: %g > %g (%s)\n", bsdf_spec(b),
                              v->check, v->value, v->limit, v->note);
            }
        }
        if (failed) {
            const size_t used = strlen(names);
            snprintf(names + used, size - used, "%s%s", used ? " " : "",
                     checks[c]->name);
        }
    }
    run_clear(&run);
}

static void expect(int type, const char *settings, double theta_deg,
                   uint64_t samples, const char *expected)
{
    char names[256];
    struct err err;
    struct plan plan = plan_default;
    plan.samples = samples;
    struct bsdf *b = bsdf_new_of(broken[type], settings, &bands_default, &err);
    if (!b)
        fail_msg("%s", err.text);
    const struct vec3 wo = dir_from_degrees(theta_deg, 40);
    failures(b, &wo, 1, plan, names, sizeof names);
    assert_string_equal(names, expected);
    bsdf_free(b);
}

static void sound_models_pass_over_many_seeds(void **state)
{
    (void)state;
    static const char *const spec[] = {
        "diffuse",
        "mirror",
        "roughconductor:material=Ca,alpha=0.25",
        "roughconductor:alpha_u=0.4,alpha_v=0.05,distribution=ggx",
        "roughconductor:alpha=0.005,sample_visible=false",
    };
    enum { SPECS = sizeof spec / sizeof *spec };
#ifdef __SANITIZE_ADDRESS__
    enum { SEEDS = 1 }; /* memory is the same for all */
#else
    enum { SEEDS = 10 };
#endif
    struct bsdf *b[SPECS];
    struct err err;
    for (int i = 0; i < SPECS; i++)
        if (!(b[i] = bsdf_new(spec[i], &bands_default, &err)))
            fail_msg("%s", err.text);
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        struct plan plan = plan_default;
        struct run run;
        plan.seed = seed;
        plan.samples = 30000;
        assert_true(run_checks(&run, &plan, (const struct bsdf *const *)b,
                               SPECS, NULL, 0, NULL, NULL, &err));
        assert_int_equal(run.failed, 0);
        assert_true(run.passed > 100);
        run_clear(&run);
    }
    for (int i = 0; i < SPECS; i++)
        bsdf_free(b[i]);
}

static void alpha_one_percent_off_fails_chi2(void **state)
{
    (void)state;
    /* From near the normal, where hardly any sample is refused. */
    expect(METAL, "fault=sampled_alpha,size=1.01", 5, 1000000, "chi2 jacobian");
    expect(METAL, "fault=sampled_alpha,size=1.01,alpha=0.02,visible=true", 20,
           1000000, "chi2 jacobian");
}

static void a_pdf_one_percent_too_large_fails_pdf(void **state)
{
    (void)state;
    expect(METAL, "fault=pdf_factor,size=1.01", 20, 1000000,
           "pdf chi2 jacobian weights");
    expect(METAL, "fault=pdf_factor,size=0.99", 20, 1000000,
           "pdf chi2 jacobian weights");
}

static void weights_and_densities_of_samples_are_looked_at(void **state)
{
    (void)state;
    expect(METAL, "fault=weight_factor,size=1.0001", 50, 100000, "sample");
    expect(METAL, "fault=sample_pdf,size=1.0001", 50, 100000,
           "sample jacobian");
}

static void more_light_out_than_in_fails_energy(void **state)
{
    (void)state;
    expect(METAL, "fault=f_factor,size=1.2", 20, 100000, "energy");
}

static void refusing_good_samples_fails_pdf(void **state)
{
    (void)state;
    expect(METAL, "fault=refuses,size=0.01", 20, 1000000,
           "pdf chi2 jacobian weights");
}

static void a_thousandth_leaked_fails_chi2(void **state)
{
    (void)state;
    expect(METAL, "fault=leaks,size=0.001,alpha=0.05", 10, 1000000,
           "chi2 jacobian");
}

static void what_is_no_number_fails_finite(void **state)
{
    char names[256];
    (void)state;
    struct err err;
    struct plan plan = plan_default;
    plan.samples = 10000;
    const struct vec3 wo = dir_from_degrees(50, 40);
    static const char *const settings[] = { "fault=nan_f,size=1e-7",
                                            "fault=negative_pdf,size=1e-7",
                                            "fault=long_wi,size=1e-6" };
    for (int i = 0; i < 3; i++) {
        struct bsdf *b =
            bsdf_new_of(&type_broken_metal, settings[i], &bands_default, &err);
        failures(b, &wo, 1, plan, names, sizeof names);
        assert_has(names, "finite");
        bsdf_free(b);
    }
}

static void nan_everywhere_never_passes(void **state)
{
    char names[256];
    (void)state;
    struct err err;
    struct plan plan = plan_default;
    plan.samples = 10000;
    const struct vec3 wo = dir_from_degrees(50, 40);
    struct bsdf *b = bsdf_new_of(&type_broken_metal, "fault=nan_f,size=2",
                                 &bands_default, &err);
    failures(b, &wo, 1, plan, names, sizeof names);
    assert_string_equal(names,
                        "finite lobes sample energy weights reciprocity");
    bsdf_free(b);
}

static void one_bad_sample_in_ten_thousand_fails_finite(void **state)
{
    (void)state;
    expect(METAL, "fault=rare_nan,size=1e-4", 20, 1000000,
           "finite sample weights");
}

static void huge_values_do_not_overflow_a_note(void **state)
{
    (void)state;
    expect(METAL, "fault=huge_f", 20, 100000, "energy");
}

static void a_wrong_g1_fails_the_furnace(void **state)
{
    (void)state;
    expect(METAL, "fault=g1_factor,size=1.00001", 50, 10000, "furnace");
}

static void a_tilted_mirror_fails_delta(void **state)
{
    (void)state;
    expect(FLAT, "fault=tilted,size=1e-12", 50, 10000, "delta");
}

static void a_mirror_drawn_too_rarely_fails_delta(void **state)
{
    (void)state;
    expect(FLAT, "fault=rare,size=0.999", 50, 100000, "pdf weights delta");
}

static void the_verdicts_do_not_depend_on_threads(void **state)
{
    (void)state;
    struct run run[2];
    struct err err;
    const struct bsdf *b =
        bsdf_new("roughconductor:alpha=0.2", &bands_default, &err);
    for (int i = 0; i < 2; i++) {
        struct plan plan = plan_default;
        plan.samples = 20000;
        plan.threads = 1 + 2 * i;
        assert_true(
            run_checks(&run[i], &plan, &b, 1, NULL, 0, NULL, NULL, &err));
    }
    for (size_t i = 0; i < run[0].results; i++)
        for (int c = 0; c < checks_count(); c++) {
            const struct verdict *x = &run[0].result[i].verdict[c];
            const struct verdict *y = &run[1].result[i].verdict[c];
            assert_int_equal(x->applies, y->applies);
            assert_memory_equal(&x->value, &y->value, sizeof x->value);
            assert_memory_equal(&x->p, &y->p, sizeof x->p);
        }
    run_clear(&run[0]);
    run_clear(&run[1]);
    bsdf_free((struct bsdf *)b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "sound models pass over seeds", sound_models_pass_over_many_seeds },
        { "alpha 1 % off fails chi2", alpha_one_percent_off_fails_chi2 },
        { "a pdf 1 % off fails pdf", a_pdf_one_percent_too_large_fails_pdf },
        { "a weight or pdf of a sample 1e-4 off fails sample",
          weights_and_densities_of_samples_are_looked_at },
        { "an albedo above 1 fails energy",
          more_light_out_than_in_fails_energy },
        { "1 % refused without reason fails pdf",
          refusing_good_samples_fails_pdf },
        { "0.1 % leaked fails chi2", a_thousandth_leaked_fails_chi2 },
        { "NaN, negative and long vectors at an edge fail finite",
          what_is_no_number_fails_finite },
        { "an f that is NaN passes nothing that looks at f",
          nan_everywhere_never_passes },
        { "one bad sample in ten thousand fails finite",
          one_bad_sample_in_ten_thousand_fails_finite },
        { "huge values do not overflow a note",
          huge_values_do_not_overflow_a_note },
        { "a G1 1e-5 off fails the furnace", a_wrong_g1_fails_the_furnace },
        { "a mirror 1e-12 off fails delta", a_tilted_mirror_fails_delta },
        { "a mirror drawn too rarely fails delta",
          a_mirror_drawn_too_rarely_fails_delta },
        { "one thread and three give the same verdicts",
          the_verdicts_do_not_depend_on_threads },
    };
    return cmocka_run_group_tests_name("checks", tests, NULL, NULL);
}
