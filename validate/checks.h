/* checks.h - what a scattering model must satisfy
 *
 * A check is a file check_<name>.c, declared below, and a line in checks.c.  It
 * fills a verdict whose check, wo, applies (true), passed (true), p (NaN) and
 * unit ("") are set already.  It gives either value, limit and error, or p
 * alone: what it leaves undecided, checks_run decides by value - error <=
 * limit, and p is decided at the end of the whole run.
 */
#ifndef VALIDATE_CHECKS_H
#define VALIDATE_CHECKS_H

#include "validate/subject.h"
#include "validate/verdict.h"

struct check {
    const char *name;
    const char *about; /* what it asks, one line */
    void (*run)(const struct subject *s, struct verdict *v);
};

extern const struct check check_answers, check_chi2, check_delta, check_energy,
    check_finite, check_furnace, check_jacobian, check_lobes, check_pdf,
    check_reciprocity, check_sample, check_support, check_weights;

/** All checks, in the order of reports; the last is NULL. */
extern const struct check *const checks[];
int checks_count(void);

/** The index of the check of a name, or -1. */
int checks_find(const char *name);

/** Runs the check of an index on a subject.  A verdict with a p is not decided
 * yet; one that the plan skips does not apply. */
struct verdict check_run(int index, const struct subject *s);

#endif
