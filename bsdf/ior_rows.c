/* ior_rows.c - rows of numbers, made into columns that rise
 *
 * Rows out of order are sorted and those of one wavelength averaged, with a
 * warning: of 3,720 pages of the database 17 have the one and 31 the other.
 */
#include "bsdf/ior_page.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct row {
    double nm, value[2];
    size_t number; /* in the file, from 1; blank lines do not count */
};

struct rows {
    struct row *at;
    size_t count, room;
};

/* The shift goes into the exponent before the number is rounded, so that
 * 0.54321 um is the 543.21 nm that a caller writes, to the last bit. */
bool ior_number(const char *text, size_t length, long shift, double *value)
{
    char copy[80];
    size_t i = 0, digits = 0;
    if (length >= sizeof copy - 24)
        return false;
    i += i < length && (text[i] == '+' || text[i] == '-');
    for (; i < length && ior_is_digit(text[i]); i++)
        digits++;
    i += i < length && text[i] == '.';
    for (; i < length && ior_is_digit(text[i]); i++)
        digits++;
    if (!digits)
        return false;
    const size_t mantissa = i;
    if (i < length && (text[i] == 'e' || text[i] == 'E')) {
        i++;
        const bool minus = i < length && text[i] == '-';
        i += minus || (i < length && text[i] == '+');
        if (i == length || length - i > 6)
            return false;
        long exponent = 0;
        for (; i < length && ior_is_digit(text[i]); i++)
            exponent = 10 * exponent + (text[i] - '0');
        shift += minus ? -exponent : exponent;
    }
    if (i != length)
        return false;
    snprintf(copy, sizeof copy, "%.*se%ld", (int)mantissa, text, shift);
    *value = strtod(copy, NULL);
    return isfinite(*value);
}

int ior_split(const char *line, size_t length, bool commas,
              struct ior_span values[3])
{
    int count = 0;
    commas = commas && memchr(line, ',', length);
    for (size_t i = 0, end; i <= length; i = end + 1) {
        while (i < length && ior_is_space(line[i]))
            i++;
        if (i == length && !commas)
            break;
        for (end = i; end < length; end++)
            if (commas ? line[end] == ',' : ior_is_space(line[end]))
                break;
        size_t n = end - i; /* 0 between two commas */
        while (n && ior_is_space(line[i + n - 1]))
            n--;
        if (count < 3)
            values[count] = (struct ior_span){ line + i, n };
        count++;
    }
    return count;
}

static bool read_row(const struct ior_source *file, const struct ior_kind *kind,
                     const char *text, size_t length, size_t line,
                     struct row *row)
{
    struct ior_span spans[3];
    const int columns = ior_split(text, length, kind->csv, spans);
    for (int i = 0; i < columns && i < kind->columns; i++)
        if (!ior_number(spans[i].at, spans[i].length, i || kind->nm ? 0 : 3,
                        i ? &row->value[i - 1] : &row->nm))
            return ior_fail(file, line, "row %zu of %s: \"%s\" is not a number",
                            row->number, kind->type,
                            ior_quote(spans[i].at, spans[i].length).text);
    if (columns != kind->columns)
        return ior_fail(file, line, "row %zu of %s: %d value%s, expected %s",
                        row->number, kind->type, columns,
                        columns == 1 ? "" : "s", kind->heads);
    if (!(row->nm > 0))
        return ior_fail(
            file, line, "row %zu of %s: wavelength %g %s, expected more than 0",
            row->number, kind->type, kind->nm ? row->nm : row->nm / 1000,
            kind->nm ? "nm" : "um");
    return true;
}

static bool rows_add(struct rows *rows, struct row row)
{
    if (rows->count == rows->room) {
        const size_t room = rows->room ? 2 * rows->room : 256;
        struct row *at = realloc(rows->at, room * sizeof *at);
        if (!at)
            return false;
        rows->at = at;
        rows->room = room;
    }
    rows->at[rows->count++] = row;
    return true;
}

static bool read_rows(const struct ior_source *file,
                      const struct ior_kind *kind,
                      const struct ior_lines *lines, struct rows *rows)
{
    size_t line = lines->line;
    for (size_t i = 0, end; i < lines->length; i = end + 1) {
        bool blank = true;
        for (end = i; end < lines->length && lines->text[end] != '\n'; end++)
            blank = blank && ior_is_space(lines->text[end]);
        if (!blank) {
            struct row row = { .number = rows->count + 1 };
            if (row.number > IOR_ROWS_MAX)
                return ior_fail(file, line, "%s has more than %d rows",
                                kind->type, IOR_ROWS_MAX);
            if (!read_row(file, kind, lines->text + i, end - i, line, &row))
                return false;
            if (!rows_add(rows, row))
                return ior_out_of_memory(file);
        }
        line += lines->each;
    }
    return rows->count ||
           ior_fail(file, lines->header, "%s has no rows", kind->type);
}

static int by_wavelength(const void *a, const void *b)
{
    const struct row *p = a, *q = b;
    if (p->nm != q->nm)
        return p->nm < q->nm ? -1 : 1;
    return (p->number > q->number) - (p->number < q->number);
}

static void sort(struct ior_page *page, const struct ior_kind *kind,
                 struct rows *rows)
{
    size_t wrong = 0, first = 0;
    for (size_t i = 1; i < rows->count; i++)
        if (rows->at[i].nm < rows->at[i - 1].nm && !wrong++)
            first = i;
    if (!wrong)
        return;
    ior_warn(
        page,
        "%s: wavelengths do not rise at %zu of %zu rows, the first of them "
        "row %zu with %.10g nm after %.10g nm; sorted",
        kind->type, wrong, rows->count, rows->at[first].number,
        rows->at[first].nm, rows->at[first - 1].nm);
    qsort(rows->at, rows->count, sizeof *rows->at, by_wavelength);
}

/* One row for the given ones of one wavelength. */
static struct row mean(struct ior_page *page, const struct ior_kind *kind,
                       const struct row *rows, size_t count)
{
    struct row m = rows[0];
    bool same = true;
    for (size_t i = 1; i < count; i++)
        same = same && rows[i].value[0] == m.value[0] &&
               rows[i].value[1] == m.value[1];
    if (same)
        return m;
    m.value[0] = m.value[1] = 0;
    char numbers[80] = "";
    for (size_t i = 0, used = 0; i < count; i++) {
        m.value[0] += rows[i].value[0] / (double)count;
        m.value[1] += rows[i].value[1] / (double)count;
        if (used + 24 < sizeof numbers)
            used += (size_t)snprintf(numbers + used, sizeof numbers - used,
                                     "%s%zu", i ? ", " : "", rows[i].number);
    }
    ior_warn(page, "%s: %zu rows (%s) differ at %.10g nm; averaged", kind->type,
             count, numbers, m.nm);
    return m;
}

static void merge(struct ior_page *page, const struct ior_kind *kind,
                  struct rows *rows)
{
    size_t kept = 0;
    for (size_t i = 0, end; i < rows->count; i = end) {
        for (end = i + 1; end < rows->count; end++)
            if (rows->at[end].nm != rows->at[i].nm)
                break;
        rows->at[kept++] = mean(page, kind, rows->at + i, end - i);
    }
    rows->count = kept;
}

/* Keeps one column of a table. */
static bool keep(const struct ior_source *file, const struct ior_kind *kind,
                 const struct ior_lines *lines, const struct rows *rows,
                 int column, const char *what, struct ior_column *t)
{
    struct ior_page *page = file->page;
    assert(rows->count > 0);
    if (t->rows || (t == &page->n && page->formula.number))
        return ior_fail(file, lines->header, "%s: there is %s already",
                        kind->type, what);
    t->nm = malloc(rows->count * sizeof *t->nm);
    t->value = malloc(rows->count * sizeof *t->value);
    if (!t->nm || !t->value)
        return ior_out_of_memory(file);
    t->rows = rows->count;
    for (size_t i = 0; i < rows->count; i++) {
        const struct row *row = &rows->at[i];
        t->nm[i] = row->nm;
        t->value[i] = row->value[column] + 0.; /* no -0 */
        if (t->value[i] < 0)
            ior_warn(page,
                     "%s: row %zu has a negative %s = %g at %.10g nm; there "
                     "is no %s from there to the rows next to it",
                     kind->type, row->number, what, t->value[i], row->nm, what);
    }
    return true;
}

bool ior_read_rows(const struct ior_source *file, const struct ior_kind *kind,
                   const struct ior_lines *lines)
{
    struct rows rows = { 0 };
    struct ior_page *page = file->page;
    bool good = read_rows(file, kind, lines, &rows);
    if (good) {
        sort(page, kind, &rows);
        merge(page, kind, &rows);
    }
    if (good && kind->has_n)
        good = keep(file, kind, lines, &rows, 0, "n", &page->n);
    if (good && kind->has_k)
        good = keep(file, kind, lines, &rows, kind->columns - 2, "k", &page->k);
    free(rows.at);
    return good;
}
