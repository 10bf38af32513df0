/* outfile.h - a file that is there whole or not at all
 *
 * Written under a temporary name beside the final one and renamed at the end,
 * so that a failure, an interruption or a full disk leaves what was there.  A
 * link is followed, and what is no regular file (a device, a pipe) is written
 * as it stands, without a temporary.
 */
#ifndef BSDF_OUTFILE_H
#define BSDF_OUTFILE_H

#include <stdbool.h>
#include <stdio.h>

#include "bsdf/err.h"

struct outfile {
    FILE *stream;           /* write here */
    char *path, *temporary; /* temporary is NULL for a device */
};

/** Opens; false and the reason (path and system's word) if it cannot. */
bool outfile_open(struct outfile *out, const char *path, struct err *err);

/** Flushes, closes, renames.  false, nothing left behind, if any write failed.
 * Either this or outfile_abandon must follow an open. */
bool outfile_close(struct outfile *out, struct err *err);

/** Closes and removes the temporary file. */
void outfile_abandon(struct outfile *out);

#endif
