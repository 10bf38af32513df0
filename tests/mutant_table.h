/* mutant_table.h - known mistakes, as data, and how one is run
 *
 * A mutant is a model of broken.h with one fault.  Its size at scale 1 is that
 * of the renderer that had it; at scale 0 nothing is left of it.
 */
#ifndef TESTS_MUTANT_TABLE_H
#define TESTS_MUTANT_TABLE_H

#include "tests/broken.h"
#include "validate/run.h"

struct mutant {
    const char *bug;  /* its number in the list of mutant_table.c, or "-" */
    const char *name; /* unique */
    const char *seen; /* who made the mistake; "" where nobody is known to */
    const struct bsdf_type *type;
    const char *settings; /* all but size */
    enum mutant_way {
        MUTANT_SHARE,  /* size = original scale */
        MUTANT_FACTOR, /* size = 1 + (original - 1) scale */
        MUTANT_FIXED,  /* there is but one size */
    } way;
    double original;       /* size at scale 1 */
    double theta_deg[2];   /* of wo; a second one of 0 is none */
    const char *caught_by; /* the checks, all of which fail at scale 1; NULL
                              where none does, and one of the next says why */
    const char *diagnosis; /* what it should be said to be; NULL where it is
                              none of the hypotheses */
    const char *sound;     /* no mistake at all, and it must pass: why */
    const char *blind;     /* no check can know without a reference: why */
    const char *gap;       /* no check asks yet: what one would have to ask; or
                              why this sound one fails as yet */
};

/** All of them; the last has no name. */
extern const struct mutant mutants[];

/** The models with nothing wrong, as the mutants use them; the last has no
 * name.  All are sound, and one that has a gap fails nevertheless. */
extern const struct mutant mutant_controls[];

/** The size at a scale, and the settings with it. */
double mutant_size(const struct mutant *m, double scale);
void mutant_settings(const struct mutant *m, double scale, char *text,
                     size_t size);

/** What a run found, bit i for checks[i], over all directions. */
struct mutant_found {
    unsigned failed, applied;
    char diagnosis[256]; /* the first that was given, or "" */
    char note[256];      /* of the first that failed */
};

/** False and the reason if the model cannot be made. */
bool mutant_run(const struct mutant *m, double scale, const struct plan *plan,
                struct mutant_found *found, struct err *err);

/** The names of the checks in a set, in their order, with spaces between. */
void mutant_names(unsigned set, char *names, size_t size);

/** Whether all checks that are named, with spaces between, are in the set; a
 * name that is no check's is not. */
bool mutant_has_all(unsigned set, const char *names);

#endif
