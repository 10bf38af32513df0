/* checks.c - the list of checks, and how one is run */
#include "validate/checks.h"

const struct check *const checks[] = {
    &check_finite, &check_support, &check_sample,  &check_pdf,
    &check_chi2,   &check_energy,  &check_furnace, &check_reciprocity,
    &check_delta,  &check_answers, NULL,
};

int checks_count(void)
{
    return (int)(sizeof checks / sizeof *checks) - 1;
}

struct verdict check_run(const struct check *check, const struct subject *s)
{
    struct verdict v = {
        .check = check->name,
        .applies = true,
        .passed = true,
        .unit = "",
        .p = NAN,
        .wo = s->wo,
    };
    check->run(s, &v);
    if (v.applies && isnan(v.p))
        v.passed = v.passed && v.value - v.error <= v.limit;
    return v;
}
