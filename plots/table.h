/* table.h - numbers and words that any program can read back
 *
 * A table is tab-separated text.  Comments after # come first and say what made
 * it and what the columns are, with units; then the rows, in 17 digits, which
 * is all that a double has.
 */
#ifndef PLOTS_TABLE_H
#define PLOTS_TABLE_H

#include <stdio.h>

#include "bsdf/bsdf.h"

/** Writes "# what: text", the text as utf8_plain has it. */
void table_comment(FILE *out, const char *what, const char *text);

/** Writes the comments that every table has: program, spec, wo, bands. */
void table_head(FILE *out, const struct bsdf *b, struct vec3 wo);

/** Writes a column's heading for each band: "\tWHAT at 549 nm", "\tWHAT in G".
 */
void table_columns(FILE *out, const struct bands *bands, const char *what);

/** Writes a row; what is not a number is "nan", whatever its sign. */
void table_row(FILE *out, const double *x, size_t n);

#endif
