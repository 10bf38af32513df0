/* rows.h - a table of named columns, read from a file
 *
 * Lines of tab-separated fields: first the columns' names, then the rows; a
 * line that begins with # is a comment, and an empty one nothing.  Nothing is
 * taken on trust: an error names the file, the line, what it says and what was
 * expected.
 */
#ifndef PLOTS_ROWS_H
#define PLOTS_ROWS_H

#include <stdbool.h>
#include <stddef.h>

#include "bsdf/err.h"

enum { ROWS_COLUMNS_MAX = 64 };

struct rows {
    const char *path; /* borrowed */
    char *text;       /* the file, cut into fields */
    size_t columns, n;
    char *name[ROWS_COLUMNS_MAX];
    struct row {
        size_t line;
        char *field[ROWS_COLUMNS_MAX];
    } * row;
};

/** Reads a file of at most 64 MiB and 10^6 rows. */
bool rows_read(struct rows *r, const char *path, struct err *err);
void rows_clear(struct rows *r);

/** The index of a column; -1 and what there is if it is not there. */
int rows_column(const struct rows *r, const char *name, struct err *err);

/** A number in [min, max]; "-" is NaN where that is allowed. */
bool rows_number(const struct rows *r, size_t row, int column, double min,
                 double max, bool or_none, double *x, struct err *err);

#endif
