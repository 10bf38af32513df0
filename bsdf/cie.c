/* cie.c - reading the tables of the standard observer and of D65 */
#include "bsdf/cie.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef BSDF_DATA_DIR
#define BSDF_DATA_DIR "data"
#endif

enum { LINE_MAX_BYTES = 256, COLUMNS = 5 };

const char *data_folder(void)
{
    const char *data = getenv("BSDF_DATA");
    return data && *data ? data : BSDF_DATA_DIR;
}

struct place {
    const char *path;
    int line;
    struct err *err;
};

/* Reads one row, which has to be the one for this wavelength. */
static bool read_row(const struct place *at, const char *text, int nm,
                     double column[COLUMNS])
{
    static const char *const names[] = { "the wavelength", "xbar", "ybar",
                                         "zbar", "D65" };
    for (int c = 0; c < COLUMNS; c++) {
        char *end;
        column[c] = strtod(text, &end);
        if (end == text || !strchr(" \t\r\n", *end))
            return err_set(at->err,
                           "%.400s:%d: expected %s as a number, and five of "
                           "them: nm, xbar, ybar, zbar, D65",
                           at->path, at->line, names[c]);
        if (!(column[c] >= 0 && isfinite(column[c])))
            return err_set(at->err,
                           "%.400s:%d: %s = %g; expected 0 or more, and finite",
                           at->path, at->line, names[c], column[c]);
        text = end;
    }
    if (text[strspn(text, " \t\r\n")])
        return err_set(at->err,
                       "%.400s:%d: more than the five columns nm, xbar, ybar, "
                       "zbar, D65",
                       at->path, at->line);
    if (column[0] != nm)
        return err_set(at->err,
                       "%.400s:%d: wavelength %g nm; expected %d, as rows go "
                       "from %d to %d nm in steps of 1",
                       at->path, at->line, column[0], nm, CIE_LO_NM, CIE_HI_NM);
    return true;
}

static bool read_rows(FILE *f, struct place *at, struct cie *cie)
{
    char text[LINE_MAX_BYTES];
    int row = 0;
    while (fgets(text, sizeof text, f)) {
        double column[COLUMNS] = { 0 };
        at->line++;
        if (!strchr(text, '\n') && !feof(f))
            return err_set(at->err,
                           "%.400s:%d: expected a line of text, of at most %d "
                           "bytes",
                           at->path, at->line, LINE_MAX_BYTES - 2);
        const char *start = text + strspn(text, " \t\r\n");
        if (*start == '#' || !*start)
            continue;
        if (row == CIE_ROWS)
            return err_set(at->err,
                           "%.400s:%d: a row after that for %d nm, which "
                           "should be the last",
                           at->path, at->line, CIE_HI_NM);
        if (!read_row(at, start, CIE_LO_NM + row, column))
            return false;
        memcpy(cie->bar[row], column + 1, sizeof cie->bar[row]);
        cie->d65[row++] = column[4];
    }
    if (ferror(f))
        return err_set(at->err, "%.400s: %s", at->path, strerror(errno));
    if (row < CIE_ROWS)
        return err_set(at->err,
                       "%.400s:%d: ends after %d rows; expected %d, from %d to "
                       "%d nm",
                       at->path, at->line, row, CIE_ROWS, CIE_LO_NM, CIE_HI_NM);
    return true;
}

/* The columns are divided by, so none may be empty. */
static bool has_light(const struct cie *cie, struct place *at)
{
    for (int c = 0; c < 3; c++) {
        double sum = 0;
        for (int row = 0; row < CIE_ROWS; row++)
            sum += cie->d65[row] * cie->bar[row][c];
        if (!(sum > 0 && isfinite(sum)))
            return err_set(at->err,
                           "%.400s:%d: %cbar times D65 sums up to %g; expected "
                           "more than 0",
                           at->path, at->line, "xyz"[c], sum);
    }
    return true;
}

bool cie_load_file(struct cie *cie, const char *path, struct err *err)
{
    struct place at = { path, 0, err };
    FILE *f = fopen(path, "r");
    if (!f)
        return err_set(err, "%.400s: %s", path, strerror(errno));
    const bool good = read_rows(f, &at, cie) && has_light(cie, &at);
    fclose(f);
    return good;
}

bool cie_load(struct cie *cie, struct err *err)
{
    char path[PATH_MAX];
    struct err why;
    const int n =
        snprintf(path, sizeof path, "%s/cie/cie1931_d65.tsv", data_folder());
    if (n >= (int)sizeof path)
        return err_set(err, "%.400s...: longer than a path can be",
                       data_folder());
    if (!cie_load_file(cie, path, &why))
        return err_set(err,
                       "%s (colour matching functions and D65; BSDF_DATA can "
                       "name the data folder)",
                       why.text);
    return true;
}
