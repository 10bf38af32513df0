/* plan.h - what a run of the checks is asked to do */
#ifndef VALIDATE_PLAN_H
#define VALIDATE_PLAN_H

#include <stdbool.h>
#include <stdint.h>

struct plan {
    uint64_t seed;
    uint64_t samples;    /* for each model and direction, 1000 to 1e9 */
    double significance; /* of the whole run: the chance that anything sound
                            is called unsound, in (0, 1) */
    int threads;         /* 0: as many as there are */
    int escalations;  /* how often a doubtful result may ask for four times the
                         samples, see run.h */
    uint64_t skip;    /* bit i: without the i-th check */
    bool unexplained; /* failures are not looked into for their reason */
};

/** 1, 10^6, 1e-6, 0, 2, 0, false */
extern const struct plan plan_default;

#endif
