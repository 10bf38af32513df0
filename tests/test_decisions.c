/* test_decisions.c - what the chi-square takes into account, one thing at a
 * time
 *
 * A survey of a sound model is changed by hand, as a mistake of the model or a
 * bound of the integration would have changed it, and judged again.
 */
#include <gsl/gsl_sort.h>

#include "tests/close.h"
#include "validate/checks.h"

static struct plan plan;
static struct bsdf *bsdf;

static struct subject look(uint64_t seed, uint64_t samples)
{
    struct subject s;
    struct err err;
    plan = plan_default;
    plan.seed = seed;
    plan.samples = samples;
    if (!bsdf &&
        !(bsdf = bsdf_new("roughconductor:alpha=0.25", &bands_default, &err)))
        fail_msg("%s", err.text);
    if (!subject_init(&s, bsdf, dir_from_degrees(40, 70), &plan, &err))
        fail_msg("%s", err.text);
    return s;
}

static double p_of(const struct subject *s)
{
    const struct verdict v = check_run(checks_find("chi2"), s);
    assert_true(v.applies);
    return v.p;
}

static size_t fullest(const struct survey *v)
{
    size_t best = 0;
    for (size_t i = 0; i < partition_bins(v->partition); i++)
        if (v->mass[i].value > v->mass[best].value)
            best = i;
    return best;
}

/* A matt surface that remembers what it was drawn with. */
enum { SEEN_MAX = 100000 };
static double seen[SEEN_MAX];
static size_t seen_count;

static struct bsdf_claims spy_claims(const void *state,
                                     const struct bands *bands)
{
    (void)state, (void)bands;
    return (struct bsdf_claims){ .lobes = BSDF_DIFFUSE_REFLECTION,
                                 .reciprocal = true,
                                 .eta = 1 };
}

static struct spectrum spy_eval(const void *state, struct vec3 wo,
                                struct vec3 wi)
{
    (void)state;
    return spectrum_of(3, wo.z > 0 && wi.z > 0 ? 1 / PI : 0);
}

static double spy_pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    (void)state;
    return wo.z > 0 && wi.z > 0 ? wi.z / PI : 0;
}

static struct bsdf_sample spy_sample(const void *state, struct vec3 wo,
                                     struct vec3 u)
{
    const double r = sqrt(u.x), phi = 2 * PI * u.y;
    const struct vec3 wi = { r * cos(phi), r * sin(phi), sqrt(1 - u.x) };
    if (seen_count < SEEN_MAX)
        seen[seen_count++] = u.x;
    return (struct bsdf_sample){ .wi = wi,
                                 .pdf = spy_pdf(state, wo, wi),
                                 .weight = spectrum_of(3, 1) };
}

static const struct bsdf_param spy_params[] = { { 0 } };
static const struct bsdf_type spy = {
    .name = "spy",
    .about = "remembers what it was drawn with",
    .params = spy_params,
    .claims = spy_claims,
    .eval = spy_eval,
    .pdf = spy_pdf,
    .sample = spy_sample,
};

/* Bins that were laid through the samples which are then tested in them would
 * make a test of its own making.  Of 53 random bits no two are the same. */
static void no_number_is_drawn_with_twice(void **state)
{
    struct subject s;
    struct err err;
    struct bsdf *b = bsdf_new_of(&spy, "", &bands_default, &err);
    (void)state;
    plan = plan_default;
    plan.samples = 1000;
    assert_true(b &&
                subject_init(&s, b, dir_from_degrees(40, 70), &plan, &err));
    assert_in_range(seen_count, plan.samples + 1, SEEN_MAX - 1);
    gsl_sort(seen, 1, seen_count);
    /* But for the tails, which shape no bin: 1 less a tiny number has few bits.
     */
    for (size_t i = 1; i < seen_count; i++)
        assert_true(seen[i] != seen[i - 1] || seen[i] > 1 - 0x1p-10);
    subject_clear(&s);
    bsdf_free(b);
}

static void an_error_of_integration_is_no_mistake(void **state)
{
    struct subject s = look(1, 1000000);
    struct estimate *mass = &s.survey.mass[fullest(&s.survey)];
    const double off = mass->value / 2;
    (void)state;
    mass->value += off;
    assert_at_most(p_of(&s), 1e-20);
    mass->error += off;
    assert_true(p_of(&s) > 1e-6);
    subject_clear(&s);
}

/* Takes samples from all bins that have many, or gives them, one after the
 * other, so that none of these shows it. */
static void change_evenly(struct survey *v, uint64_t samples, bool take)
{
    for (size_t i = 0; samples > 0; i = (i + 1) % partition_bins(v->partition))
        if (v->count[i] > 100) {
            v->count[i] += take ? (uint64_t)-1 : 1;
            samples--;
        }
}

/* Adds samples to the first bins that expect from low to high; how many. */
static uint64_t put(struct survey *v, double low, double high, uint64_t each,
                    size_t bins)
{
    uint64_t samples = 0;
    for (size_t i = 0; i < partition_bins(v->partition) && bins > 0; i++) {
        const double expected = v->mass[i].value * (double)v->samples;
        if (expected >= low && expected < high) {
            v->count[i] += each;
            samples += each;
            bins--;
        }
    }
    return samples;
}

/* A few more in each of many, which is much for none of them: the pools know,
 * that of bins which expect less than 1, and that of those which expect more.
 */
static void samples_in_nearly_empty_bins_count(void **state)
{
    (void)state;
    for (int some = 0; some < 2; some++) {
        struct subject s = look(1, 1000000);
        struct survey *v = &s.survey;
        const uint64_t moved =
            some ? put(v, 1, 100, 15, SIZE_MAX) : put(v, 0.01, 1, 7, SIZE_MAX);
        assert_in_range(moved, 50, 1000);
        change_evenly(v, moved, true);
        assert_at_most(p_of(&s), 1e-20);
        subject_clear(&s);
    }
}

/* So many in one that its pool need not show them. */
static void samples_in_one_nearly_empty_bin_count(void **state)
{
    struct subject s = look(1, 100000);
    (void)state;
    change_evenly(&s.survey, put(&s.survey, 1, 5, 50, 1), true);
    assert_at_most(p_of(&s), 1e-20);
    subject_clear(&s);
}

/* None of which is much by itself: 40 are expected at most. */
static void nearly_empty_bins_that_are_never_drawn_count(void **state)
{
    struct subject s = look(1, 100000);
    struct survey *v = &s.survey;
    uint64_t never = 0;
    (void)state;
    for (size_t i = 0; i < partition_bins(v->partition); i++) {
        const double expected = v->mass[i].value * (double)v->samples;
        if (expected >= 5 && expected < 40) {
            never += v->count[i];
            v->count[i] = 0;
        }
    }
    assert_in_range(never, 500, 5000);
    change_evenly(v, never, false);
    assert_at_most(p_of(&s), 1e-20);
    subject_clear(&s);
}

/* Samples refused that the pdf has no room for, taken evenly from all bins: no
 * shape has changed. */
static void refused_samples_are_not_scaled_away(void **state)
{
    struct subject s = look(1, 1000000);
    struct survey *v = &s.survey;
    (void)state;
    for (size_t i = 0; i < partition_bins(v->partition); i++) {
        const uint64_t tenth = v->count[i] / 10;
        v->count[i] -= tenth;
        v->refused += tenth;
    }
    assert_at_most(p_of(&s), 1e-20);
    subject_clear(&s);
}

/* One from each of many bins changes none of them. */
static void samples_that_are_refused_count(void **state)
{
    struct subject s = look(1, 1000000);
    struct survey *v = &s.survey;
    uint64_t moved = 0;
    (void)state;
    for (size_t i = 0; i < partition_bins(v->partition); i++)
        if (v->count[i] > 1000) {
            v->count[i] -= 2;
            moved += 2;
        }
    assert_in_range(moved, 400, 1000);
    v->refused += moved;
    assert_at_most(p_of(&s), 1e-20);
    subject_clear(&s);
}

/* A bin that expects no more than it needs to be tested alone; its samples go
 * to the others of its group, where they are not seen. */
static void a_bin_that_is_never_drawn_counts(void **state)
{
    struct subject s = look(1, 1000000);
    struct survey *v = &s.survey;
    size_t none = fullest(v);
    for (size_t i = 0; i < partition_bins(v->partition); i++)
        if (v->mass[i].value > 5e-4 && v->mass[i].value < v->mass[none].value)
            none = i;
    const size_t group = partition_group(v->partition, PARTITION_COARSE, none);
    uint64_t in_group = 0;
    (void)state;
    for (size_t i = 0; i < partition_bins(v->partition); i++)
        if (i != none &&
            partition_group(v->partition, PARTITION_COARSE, i) == group)
            in_group += v->count[i];
    const double more = (double)v->count[none] / (double)in_group;
    for (size_t i = 0; i < partition_bins(v->partition); i++)
        if (i != none &&
            partition_group(v->partition, PARTITION_COARSE, i) == group)
            v->count[i] += (uint64_t)(more * (double)v->count[i] + 0.5);
    v->count[none] = 0;
    assert_at_most(p_of(&s), 1e-20);
    subject_clear(&s);
}

static void a_mass_that_is_no_number_is_impossible(void **state)
{
    struct subject s = look(1, 10000);
    (void)state;
    s.survey.mass[fullest(&s.survey)].value = NAN;
    s.survey.total.value = NAN;
    assert_at_most(p_of(&s), 1e-200);
    subject_clear(&s);
}

static void a_sample_that_goes_nowhere_is_impossible(void **state)
{
    struct subject s = look(1, 10000);
    (void)state;
    s.survey.stray++;
    assert_at_most(p_of(&s), 1e-200);
    subject_clear(&s);
}

static int forget(void **state)
{
    (void)state;
    bsdf_free(bsdf);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "no number is drawn with twice", no_number_is_drawn_with_twice },
        { "an error of integration is no mistake of the model",
          an_error_of_integration_is_no_mistake },
        { "samples in nearly empty bins count",
          samples_in_nearly_empty_bins_count },
        { "samples in one nearly empty bin count",
          samples_in_one_nearly_empty_bin_count },
        { "nearly empty bins that are never drawn count",
          nearly_empty_bins_that_are_never_drawn_count },
        { "refused samples are not scaled away",
          refused_samples_are_not_scaled_away },
        { "samples that are refused count", samples_that_are_refused_count },
        { "a bin that is never drawn counts",
          a_bin_that_is_never_drawn_counts },
        { "a mass that is no number is impossible",
          a_mass_that_is_no_number_is_impossible },
        { "a sample that goes nowhere is impossible",
          a_sample_that_goes_nowhere_is_impossible },
    };
    return cmocka_run_group_tests_name("decisions", tests, NULL, forget);
}
