/* cli.h - what the command lines of the programs share
 *
 * A request that is wrong ends a program with status 2 and one sentence.
 */
#ifndef BSDF_CLI_H
#define BSDF_CLI_H

#include <argp.h>
#include <stddef.h>
#include <stdint.h>

#include "bsdf/bands.h"
#include "bsdf/err.h"
#include "bsdf/vec.h"

enum { EXIT_SOUND = 0, EXIT_UNSOUND = 1, EXIT_REQUEST = 2 };

#define BSDF_VERSION "0.1.0"

/** Reads "THETA,PHI" in degrees, theta in [0, 180], phi finite. */
bool cli_direction(struct vec3 *w, const char *text, struct err *err);

/** Reads a whole number in [min, max], in digits or as 1e6; what names it. */
bool cli_count(uint64_t *n, const char *what, const char *text, uint64_t min,
               uint64_t max, struct err *err);

/** Reads a number in [min, max]. */
bool cli_number(double *x, const char *what, const char *text, double min,
                double max, struct err *err);

/** Makes a database folder the one that material names are looked up in, by
 * setting BSDF_IOR_PATH for this process; the folder must be there. */
bool cli_ior_path(const char *path, struct err *err);

/** --nm, --rgb, --ior-path and --seed, as a child of a program's own parser;
 * its input is one of these, with the defaults in it. */
struct cli_shared {
    struct bands bands;
    uint64_t seed;
    bool compares;     /* wanted: "--rgb all" is a method as well */
    bool all;          /* --rgb all was given */
    bool has_bands;    /* --nm or --rgb was given */
    const char *given; /* "nm", "rgb" or "seed", the last that was; or NULL */
};
extern const struct argp cli_shared_argp;

/** Seconds since the first call. */
double cli_elapsed(void);

/** "done of of WHAT, N s left" on standard error, over the line that is there;
 * wiped out when all is done.  The time is taken from the first cli_elapsed. */
void cli_progress(const char *what, size_t done, size_t of);

#endif
