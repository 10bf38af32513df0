/* test_course.c - what is wrong in the course's BSDF is found, in its numbers
 *
 * The reference figures are quadratures of the course's formulas on two grids
 * that agree to ten digits, with the optical constants of gold and copper by
 * P. Johnson and R. Christy, Phys. Rev. B 6, 4370, 1972, at 614, 549, 466 nm.
 */
#include <stdio.h>

#include "tests/close.h"
#include "validate/energy.h"
#include "validate/run.h"

static struct bsdf *made(const char *spec)
{
    struct err err;
    struct bsdf *b = bsdf_new(spec, &bands_fixed, &err);
    if (!b)
        fail_msg("%s", err.text);
    return b;
}

static void albedo(const char *spec, double theta_deg, double out[BANDS_MAX])
{
    struct bsdf *b = made(spec);
    struct subject s;
    struct err err;
    struct plan plan = plan_default;
    plan.samples = 1000;
    assert_true(
        subject_init(&s, b, dir_from_degrees(theta_deg, 0), &plan, &err));
    const struct estimate *e = subject_energy(&s)->albedo;
    for (int i = 0; i < 3; i++) {
        assert_at_most(e[i].error, 1e-6);
        out[i] = e[i].value;
    }
    subject_clear(&s);
    bsdf_free(b);
}

static void pi_for_its_root_creates_energy(void **state)
{
    (void)state;
    static const struct {
        double alpha, theta_deg, course, right;
    } row[] = { { 0.25, 85, 1.2430, 0.9411 },
                { 0.5, 75, 1.1014, 0.9053 },
                { 0.5, 85, 1.4315, 0.9601 },
                { 0.5, 89, 1.6874, 0.9912 } };
    for (int i = 0; i < 4; i++) {
        char spec[120];
        double got[BANDS_MAX];
        const char *base = "course_microfacet:eta=0/0/0,k=1/1/1,alpha=%g%s";
        snprintf(spec, sizeof spec, base, row[i].alpha, "");
        albedo(spec, row[i].theta_deg, got);
        assert_close(got[0], row[i].course, 5e-5);
        assert_close(got[2], row[i].course, 5e-5);
        snprintf(spec, sizeof spec, base, row[i].alpha, ",lambda=exact");
        albedo(spec, row[i].theta_deg, got);
        assert_close(got[0], row[i].right, 5e-5);
    }
}

static void gold_breaks_energy_beyond_75_degrees(void **state)
{
    (void)state;
    double got[BANDS_MAX];
    const char *gold = "course_microfacet:material=Au,alpha=0.5";
    albedo(gold, 85, got);
    assert_close(got[0], 1.328, 5e-4);
    assert_close(got[1], 1.147, 5e-4);
    assert_close(got[2], 0.645, 5e-4);
    albedo(gold, 75, got);
    assert_close(got[0], 1.022, 5e-4);
    assert_close(got[1], 0.883, 5e-4);
    assert_close(got[2], 0.498, 5e-4);
}

static void fresnel_at_the_normal_is_not_reciprocal(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        double ratio[3];
    } row[] = { { "course_microfacet:material=Au", { 1.01, 1.10, 1.57 } },
                { "course_microfacet:material=Cu", { 1.02, 1.18, 1.25 } } };
    const struct vec3 a = dir_from_degrees(0, 0), b = dir_from_degrees(80, 0);
    for (int i = 0; i < 2; i++) {
        struct bsdf *m = made(row[i].spec);
        const struct spectrum there = bsdf_eval(m, a, b);
        const struct spectrum back = bsdf_eval(m, b, a);
        for (int c = 0; c < 3; c++)
            assert_close(there.band[c] / back.band[c], row[i].ratio[c], 5e-3);
        bsdf_free(m);
    }
}

/* The names of the failing checks of a run over the usual directions, and
 * whether all are put down to the same. */
static void failing(const char *spec, const char *why, char *names, size_t size)
{
    struct bsdf *b = made(spec);
    struct run run;
    struct err err;
    assert_true(run_checks(&run, &plan_default, (const struct bsdf **)&b, 1,
                           NULL, 0, NULL, NULL, &err));
    names[0] = '\0';
    for (int c = 0; c < checks_count(); c++) {
        bool failed = false;
        for (size_t i = 0; i < run.results; i++) {
            const struct verdict *v = &run.result[i].verdict[c];
            if (!v->applies || v->passed)
                continue;
            failed = true;
            if (why && !strstr(v->diagnosis, why))
                fail_msg("%s: %s: %s", spec, checks[c]->name, v->diagnosis);
        }
        const size_t used = strlen(names);
        if (failed)
            snprintf(names + used, size - used, " %s", checks[c]->name);
    }
    run_clear(&run);
    bsdf_free(b);
}

static void each_fault_fails_its_checks(void **state)
{
    (void)state;
    static const struct {
        const char *spec, *names, *why;
    } row[] = {
        { "course_microfacet:material=Au,alpha=0.5",
          " energy furnace reciprocity" },
        { "course_microfacet:material=Au,alpha=0.5,lambda=exact",
          " reciprocity" },
        { "course_microfacet:material=Au,alpha=0.5,fresnel_at=half",
          " energy furnace" },
        { "course_microfacet:material=Au,alpha=0.5,lambda=exact,"
          "fresnel_at=half",
          "" },
        { "course_refraction", " energy reciprocity", "eta^2 upside down" },
        { "course_refraction:ior=1.33", " energy reciprocity",
          "eta^2 upside down" },
        { "course_refraction:factor=right", "" },
        { "course_glass:schlick_at=thinner", " energy reciprocity",
          "eta^2 upside down" },
        { "course_glass:factor=right", " reciprocity",
          "Schlick's reflectance by" },
        { "course_glass:factor=right,schlick_at=thinner", "" },
    };
    char names[200];
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        failing(row[i].spec, row[i].why, names, sizeof names);
        assert_string_equal(names, row[i].names);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "pi for sqrt(pi) in Lambda creates energy",
          pi_for_its_root_creates_energy },
        { "gold breaks energy beyond 75 degrees",
          gold_breaks_energy_beyond_75_degrees },
        { "Fresnel at the normal is not reciprocal",
          fresnel_at_the_normal_is_not_reciprocal },
        { "each fault fails its checks and no other",
          each_fault_fails_its_checks },
    };
    return cmocka_run_group_tests_name("course", tests, NULL, NULL);
}
