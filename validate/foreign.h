/* foreign.h - specs of models that live elsewhere, beside those of the library
 *
 *   pipe:COMMAND          another program, see protocol.h; the whole rest is
 *                         what `sh -c` runs
 *   ./my.so, /my.so       a shared object, see bsdf/plugin.h; there must be a
 *   my/path.so:alpha=0.2  slash before the first colon, and .so
 */
#ifndef VALIDATE_FOREIGN_H
#define VALIDATE_FOREIGN_H

#include "bsdf/bsdf.h"

/** bsdf_new for these as well.  A shared object is loaded by the program
 * bsdf-plugin-host, the one that BSDF_PLUGIN_HOST names, else beside this
 * program or in the folder above it, else in PATH. */
struct bsdf *foreign_new(const char *spec, const struct bands *bands,
                         struct err *err);

/** The same for a spec that a file brought: one that would start a program is
 * refused unless programs are allowed. */
struct bsdf *foreign_recorded(const char *spec, const struct bands *bands,
                              bool programs, struct err *err);

#endif
