/* plan_argp.h - what the long programs of this folder are asked for alike */
#ifndef TESTS_PLAN_ARGP_H
#define TESTS_PLAN_ARGP_H

#include <argp.h>

/** The options --seed and --samples; the input is a struct plan, which has the
 * defaults. */
extern const struct argp plan_argp;

#endif
