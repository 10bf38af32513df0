/* rows.c - cutting a file into fields */
#include "plots/rows.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BYTES_MAX = 64 << 20, ROWS_MAX = 1000000 };

static bool text_read(struct rows *r, struct err *err)
{
    FILE *in = fopen(r->path, "r");
    size_t size = 0, room = 0, got = 1;
    while (in && got > 0 && size <= BYTES_MAX) {
        if (room - size < 65536) {
            char *grown = realloc(r->text, room + (room ? room : 65536) + 1);
            if (!grown)
                break;
            room += room ? room : 65536;
            r->text = grown;
        }
        got = fread(r->text + size, 1, room - size, in);
        size += got;
    }
    const bool ok = in && r->text && got == 0 && !ferror(in);
    const int why = errno;
    if (in)
        fclose(in);
    if (size > BYTES_MAX)
        return err_set(err, "%s: more than %d MiB", r->path, BYTES_MAX >> 20);
    if (!ok)
        return err_set(err, "%s: cannot be read: %s", r->path, strerror(why));
    r->text[size] = '\0';
    return strlen(r->text) == size ||
           err_set(err, "%s: a zero byte; expected text", r->path);
}

/* Cuts a line at its tabs; how many fields, or one too many. */
static size_t cut(char *line, char *field[ROWS_COLUMNS_MAX])
{
    size_t n = 0;
    for (char *f; (f = strsep(&line, "\t"));) {
        if (n == ROWS_COLUMNS_MAX)
            return n + 1;
        field[n++] = f;
    }
    return n;
}

static bool row_add(struct rows *r, size_t *room, size_t line, char *text,
                    struct err *err)
{
    if (r->n == ROWS_MAX)
        return err_set(err, "%s:%zu: more than %d rows", r->path, line,
                       ROWS_MAX);
    if (r->n == *room) {
        *room = *room ? 2 * *room : 64;
        void *grown = realloc(r->row, *room * sizeof *r->row);
        if (!grown)
            return err_set(err, "out of memory");
        r->row = grown;
    }
    struct row *row = &r->row[r->n++];
    row->line = line;
    const size_t n = cut(text, row->field);
    return n == r->columns ||
           err_set(err,
                   "%s:%zu: %zu fields at \"%.40s\"; expected %zu, as "
                   "there are names of columns",
                   r->path, line, n, row->field[0], r->columns);
}

bool rows_read(struct rows *r, const char *path, struct err *err)
{
    size_t room = 0, at = 0;
    *r = (struct rows){ .path = path };
    bool ok = text_read(r, err);
    char *rest = r->text;
    for (char *line; ok && (line = strsep(&rest, "\n"));) {
        const size_t n = strlen(line);
        at++;
        if (n > 0 && line[n - 1] == '\r')
            line[n - 1] = '\0';
        if (*line == '#' || *line == '\0')
            continue;
        if (r->columns == 0) {
            r->columns = cut(line, r->name);
            if (r->columns > ROWS_COLUMNS_MAX)
                ok = err_set(err, "%s:%zu: more than %d columns", path, at,
                             ROWS_COLUMNS_MAX);
        } else {
            ok = row_add(r, &room, at, line, err);
        }
    }
    if (ok && r->n == 0)
        ok = err_set(err,
                     "%s: no rows; expected a line of names, tabs between "
                     "them, and rows below",
                     path);
    if (!ok)
        rows_clear(r);
    return ok;
}

void rows_clear(struct rows *r)
{
    free(r->text);
    free(r->row);
    *r = (struct rows){ 0 };
}

int rows_column(const struct rows *r, const char *name, struct err *err)
{
    char list[400] = "";
    for (size_t i = 0; i < r->columns; i++) {
        if (strcmp(r->name[i], name) == 0)
            return (int)i;
        const size_t n = strlen(list);
        snprintf(list + n, sizeof list - n, "%s%s", i ? ", " : "", r->name[i]);
    }
    err_set(err, "%s: no column \"%s\"; there is: %s", r->path, name, list);
    return -1;
}

bool rows_number(const struct rows *r, size_t row, int column, double min,
                 double max, bool or_none, double *x, struct err *err)
{
    const char *text = r->row[row].field[column];
    char *end;
    if (or_none && strcmp(text, "-") == 0) {
        *x = NAN;
        return true;
    }
    *x = strtod(text, &end);
    return (end != text && *end == '\0' && *x >= min && *x <= max) ||
           err_set(err, "%s:%zu: %s \"%.40s\": expected a number in [%g, %g]%s",
                   r->path, r->row[row].line, r->name[column], text, min, max,
                   or_none ? " or -" : "");
}
