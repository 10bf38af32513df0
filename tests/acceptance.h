/* acceptance.h - what the checks promise: tables, and whether each line holds
 *
 *   sound models at every roughness are not rejected;
 *   bin masses are right within 1e-7;
 *   mistakes of half a percent and of one percent are caught;
 *   two threads are nearly twice as fast as one (which is only said).
 */
#ifndef TESTS_ACCEPTANCE_H
#define TESTS_ACCEPTANCE_H

#include <stdio.h>

#include "validate/run.h"

enum acceptance_part {
    ACCEPTANCE_SOUND,
    ACCEPTANCE_MASSES,
    ACCEPTANCE_MISTAKES,
    ACCEPTANCE_THREADS,
    ACCEPTANCE_PARTS
};

/** "sound", "masses", "mistakes", "threads" */
extern const char *const acceptance_parts[ACCEPTANCE_PARTS];

struct acceptance {
    unsigned parts;                /* 1 << part, of those that are tried */
    FILE *out;                     /* tables, in Markdown */
    uint64_t seed;                 /* of the first run */
    uint64_t samples;              /* for mistakes */
    uint64_t sound_samples;        /* for sound models, and for the time */
    size_t sound;                  /* random directions a sound model */
    size_t directions;             /* random directions for bin masses */
    size_t seeds_pdf, seeds_alpha; /* runs for each mistake */
    size_t seeds_leaks;
    /* Called with what is being done and how far it is; may be NULL. */
    void (*progress)(const char *what, size_t done, size_t of);
};

/** Writes the tables; *ok is whether every line holds.  False when something
 * could not be run at all. */
bool acceptance(const struct acceptance *a, bool *ok, struct err *err);

#endif
