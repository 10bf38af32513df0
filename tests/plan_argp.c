/* plan_argp.c - a seed, and how many samples */
#include "tests/plan_argp.h"

#include "bsdf/cli.h"
#include "validate/plan.h"

static const struct argp_option options[] = {
    { "seed", 's', "S", 0, "of the random numbers, or of the first run; 1", 0 },
    { "samples", 'n', "N", 0, "of a case or a direction, 1000 to 1e8", 0 },
    { 0 },
};

static error_t option(int key, char *arg, struct argp_state *state)
{
    struct plan *plan = state->input;
    struct err err;
    bool ok = true;
    switch (key) {
    case 's':
        ok = cli_count(&plan->seed, "--seed", arg, 0, INT64_MAX / 2, &err);
        break;
    case 'n':
        ok = cli_count(&plan->samples, "--samples", arg, 1000, 100000000, &err);
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    if (!ok)
        argp_failure(state, EXIT_REQUEST, 0, "%s", err.text);
    return 0;
}

const struct argp plan_argp = { options, option, 0, 0, 0, 0, 0 };
