/* detection.h - how often a mistake is caught, and by what */
#ifndef TESTS_DETECTION_H
#define TESTS_DETECTION_H

#include "validate/run.h"

enum { DETECTION_FINDERS_MAX = 24 };

struct detection {
    /* What is asked for; one look at 1e-6, by the checks that have a p. */
    const struct bsdf_type *type;
    const char *settings; /* of the type */
    struct vec3 wo;
    uint64_t seed; /* of the first run */
    size_t runs;
    uint64_t samples;

    /* What was found. */
    size_t caught;
    long least_degrees; /* of the fine chi-square */
    int finders;
    struct finder {
        const char *check, *part; /* of the least p; part "" without one */
        size_t runs;
    } finder[DETECTION_FINDERS_MAX];
};

/** Runs the checks at every seed; progress as in run.h, may be NULL. */
bool detection_make(struct detection *d, run_progress *progress, void *context,
                    struct err *err);

/** Share of the samples that a model refuses. */
double detection_refused(const struct bsdf *b, struct vec3 wo);

#endif
