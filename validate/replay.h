/* replay.h - a recorded run once more, and whether it comes out the same
 *
 * Holm's procedure and the further looks (run.h) depend on every p-value of a
 * run, so the whole of it runs again; what may be restricted to one model is
 * what is compared and shown.
 */
#ifndef VALIDATE_REPLAY_H
#define VALIDATE_REPLAY_H

#include "validate/recorded.h"

struct replay {
    struct recorded recorded;
    struct bsdf **bsdf; /* one a model of the report */
    struct run run;     /* the whole, again */
    struct run shown;   /* of it, what fails of the models that are compared;
                           its results are borrowed from run */
    size_t compared;    /* verdicts */
    bool same;          /* in every field */
    struct err differs; /* if not, the first field that is not */
};

/** Reads the report and runs it again; spec is a spec of the report, or its
 * number, from 1, or NULL for all; programs allows models that are programs.
 * False if the report is wrong or a model of
 * it cannot be made.  Sets BSDF_IOR_PATH to the report's where it has none. */
bool replay_run(struct replay *r, const char *path, const char *spec,
                int threads, bool programs, run_progress *progress,
                void *context, struct err *err);
void replay_clear(struct replay *r);

#endif
