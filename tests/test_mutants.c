/* test_mutants.c - every known mistake is caught by the check that it should be
 *
 * `make mutants` runs the same table at more samples and smaller sizes.
 */
#include "tests/close.h"
#include "tests/mutant_table.h"

/* A tenth of the default: what a renderer had wrong is large. */
static const uint64_t samples = 100000;

enum { MANY = 128 };

/* All of a list that a filter picks, at a scale. */
struct looked {
    const struct mutant *at[MANY];
    struct mutant_found found[MANY];
    int n;
};

static void look(struct looked *l, const struct mutant *list,
                 bool (*pick)(const struct mutant *m), double scale)
{
    struct plan plan = plan_default;
    struct err err;
    bool ok = true;
    plan.samples = samples;
    plan.threads = 1;
    l->n = 0;
    for (const struct mutant *m = list; m->name; m++) {
        assert_true(l->n < MANY);
        if (pick(m))
            l->at[l->n++] = m;
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < l->n; i++) {
        struct err why;
        if (!mutant_run(l->at[i], scale, &plan, &l->found[i], &why))
#pragma omp critical(look)
            ok = err_set(&err, "%s: %s", l->at[i]->name, why.text);
    }
    if (!ok)
        fail_msg("%s", err.text);
}

/* How many do not fail just as they should; NULL stands for nothing. */
static void assert_failed(const struct looked *l,
                          const char *(*expected)(const struct mutant *m))
{
    int wrong = 0;
    for (int i = 0; i < l->n; i++) {
        char names[256];
        const char *e = expected(l->at[i]);
        const unsigned failed = l->found[i].failed;
        if (e ? mutant_has_all(failed, e) : failed == 0)
            continue;
        mutant_names(failed, names, sizeof names);
        print_error("%s (%s): failed \"%s\", expected \"%s\"; %s\n",
                    l->at[i]->name, l->at[i]->settings, names, e ? e : "",
                    l->found[i].note);
        wrong++;
    }
    assert_true(l->n > 0);
    assert_int_equal(wrong, 0);
}

static struct looked looked;

static bool is_caught(const struct mutant *m)
{
    return m->caught_by;
}

static bool passes(const struct mutant *m)
{
    return (m->sound || m->blind) && !m->gap;
}

static bool is_gap(const struct mutant *m)
{
    return m->gap;
}

static bool has_sizes(const struct mutant *m)
{
    return m->way != MUTANT_FIXED;
}

static const char *its_checks(const struct mutant *m)
{
    return m->caught_by;
}

static const char *nothing(const struct mutant *m)
{
    (void)m;
    return NULL;
}

static void each_is_caught_by_the_checks_it_names(void **state)
{
    (void)state;
    look(&looked, mutants, is_caught, 1);
    assert_failed(&looked, its_checks);
}

/* Once a check asks, it has a name to give. */
static void what_nothing_asks_yet_is_marked_so(void **state)
{
    (void)state;
    look(&looked, mutants, is_gap, 1);
    if (looked.n > 0)
        assert_failed(&looked, nothing);
}

static void sound_and_blind_ones_pass(void **state)
{
    (void)state;
    look(&looked, mutants, passes, 1);
    assert_failed(&looked, nothing);
}

static void the_controls_pass(void **state)
{
    (void)state;
    look(&looked, mutant_controls, passes, 1);
    assert_failed(&looked, nothing);
}

/* Nothing is left of a mistake whose size is 0. */
static void at_scale_0_they_are_sound(void **state)
{
    (void)state;
    look(&looked, mutants, has_sizes, 0);
    assert_failed(&looked, nothing);
}

static void every_line_says_what_is_expected(void **state)
{
    (void)state;
    for (const struct mutant *m = mutants; m->name; m++) {
        assert_int_equal(!!m->caught_by + !!m->sound + !!m->blind + !!m->gap,
                         1);
        for (const struct mutant *k = mutants; k < m; k++)
            assert_string_not_equal(m->name, k->name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "every line says what is expected",
          every_line_says_what_is_expected },
        { "the sound controls pass", the_controls_pass },
        { "each mistake is caught by the checks it names",
          each_is_caught_by_the_checks_it_names },
        { "at scale 0 they are sound", at_scale_0_they_are_sound },
        { "what is no mistake, or needs a reference, passes",
          sound_and_blind_ones_pass },
        { "what nothing asks yet is marked so",
          what_nothing_asks_yet_is_marked_so },
    };
    return cmocka_run_group_tests_name("mutants", tests, NULL, NULL);
}
