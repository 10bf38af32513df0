/* checks.c - the list of checks, and how one is run */
#include "validate/checks.h"

#include <string.h>

const struct check *const checks[] = {
    &check_finite,  &check_support, &check_lobes,       &check_sample,
    &check_pdf,     &check_chi2,    &check_jacobian,    &check_energy,
    &check_weights, &check_furnace, &check_reciprocity, &check_delta,
    &check_answers, /* last, as it hears of what the others met */
    NULL,
};

int checks_count(void)
{
    return (int)(sizeof checks / sizeof *checks) - 1;
}

struct verdict check_run(int index, const struct subject *s)
{
    const struct check *check = checks[index];
    struct verdict v = {
        .check = check->name,
        .applies = true,
        .passed = true,
        .unit = "",
        .p = NAN,
        .wo = s->wo,
        .samples = s->samples,
    };
    if (s->plan->skip >> index & 1) {
        v.applies = false;
        verdict_note(&v, "skipped");
        return v;
    }
    check->run(s, &v);
    if (v.applies && isnan(v.p))
        v.passed = v.passed && v.value - v.error <= v.limit;
    return v;
}

int checks_find(const char *name)
{
    int i = 0;
    while (checks[i] && strcmp(checks[i]->name, name) != 0)
        i++;
    return checks[i] ? i : -1;
}
