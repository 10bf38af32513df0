/* ior_page.h - the inside of a page of optical constants
 *
 * Internal to the ior files: ior_page.c opens a file and answers for the page
 * made of it; ior_yaml.c and ior_spd.c know what a file looks like; ior_rows.c
 * and ior_formula.c read the numbers in it.
 */
#ifndef BSDF_IOR_PAGE_H
#define BSDF_IOR_PAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "bsdf/err.h"
#include "bsdf/ior.h"
#include "bsdf/ior_text.h"

/* Far beyond any page; the largest seen has 0.1 MB. */
enum {
    IOR_BYTES_MAX = 64 << 20,
    IOR_ROWS_MAX = 1000000,
    IOR_WARNINGS_MAX = 32,
    IOR_COEFFICIENTS_MAX = 17, /* what the longest formula takes */
};

struct ior_column {
    size_t rows;
    double *nm, *value;
};

struct ior_dispersion {
    int number; /* 1 to 9; 0 if there is none */
    size_t count;
    double c[IOR_COEFFICIENTS_MAX]; /* 0 from count on */
    double lo_nm, hi_nm;
};

struct ior_page {
    char *path, *reference, *comments;
    struct ior_column n, k;
    struct ior_dispersion formula; /* in place of n */
    bool of_database;              /* has its form, at least */
    double lo, hi;                 /* range [nm] */
    char **warnings;               /* the last is NULL */
    size_t warned; /* how many there would be without the limit */
};

/** A file that is being read into a page. */
struct ior_source {
    const char *path;
    struct ior_page *page;
    struct err *err;
    char *bytes; /* of the whole file, owned; and their number */
    size_t size;
};

/** Reads the bytes of a regular file; a pipe or a device is not waited for. */
bool ior_source_open(struct ior_source *file);
void ior_source_close(struct ior_source *file);

/** Always false: "FILE:LINE: why", with lines counted from 1; 0 for none. */
__attribute__((format(printf, 3, 4))) bool
ior_fail(const struct ior_source *file, size_t line, const char *format, ...);
bool ior_out_of_memory(const struct ior_source *file);

/** Without memory for a warning there will be none for the rest either. */
__attribute__((format(printf, 2, 3))) void ior_warn(struct ior_page *page,
                                                    const char *format, ...);

/* -- numbers, in ior_rows.c ------------------------------------------------ */

/** A decimal number, times ten to the shift; false if it is none. */
bool ior_number(const char *text, size_t length, long shift, double *value);

struct ior_span {
    const char *at;
    size_t length;
};

/** The number of values in a line, and the first three of them.  White space
 * is between them, or commas if they may be and there are any. */
int ior_split(const char *line, size_t length, bool commas,
              struct ior_span values[3]);

/** What a table has beside the wavelength. */
struct ior_kind {
    const char *type; /* to be named in messages */
    int columns;
    const char *heads;
    bool has_n, has_k;
    bool nm;  /* wavelengths are [nm], and not [um] */
    bool csv; /* commas may stand between values */
};

/** The lines of a table. */
struct ior_lines {
    char *text;
    size_t length;
    size_t line;   /* of the first row in the file */
    bool each;     /* each is a line of the file, and not all of them one */
    size_t header; /* the line to name where there are no rows at all */
};

/** Sorts and averages where it has to, and keeps the columns in the page. */
bool ior_read_rows(const struct ior_source *file, const struct ior_kind *kind,
                   const struct ior_lines *lines);

/* -- formulas, in ior_formula.c -------------------------------------------- */

/** How many coefficients a formula takes; 0 if there is no such formula. */
size_t ior_formula_room(int number);

/** Whether the last of so many coefficients is also the last of a term. */
bool ior_formula_whole(int number, size_t count);

/** n at a wavelength inside the range; false and why there is none. */
bool ior_formula_at(const struct ior_dispersion *f, double nm, double *n,
                    char *why, size_t size);

/* -- formats --------------------------------------------------------------- */

/* Each reads a file that is open, but for .spd, where there are two. */
bool ior_read_yaml(struct ior_source *file);  /* a page of the database */
bool ior_read_spd(struct ior_source *file);   /* one of a pair, and the other */
bool ior_read_plain(struct ior_source *file); /* nm, n and maybe k */

/** Whether a name is that of a file, by its ending. */
bool ior_is_file(const char *name);

#endif
