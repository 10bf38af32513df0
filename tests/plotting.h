/* plotting.h - what the tests of bsdf-plot share
 *
 * They run in the root of the repository and write only into $T.
 */
#ifndef TESTS_PLOTTING_H
#define TESTS_PLOTTING_H

#include <stdio.h>
#include <stdlib.h>

#include "tests/close.h"
#include "tests/shell.h"

enum { COLUMNS_MAX = 16 };

/* Commands that all succeed, without a word on standard error. */
static inline void quiet(const char *command)
{
    char line[8192];
    snprintf(line, sizeof line, "{ set -e; %s; } 2>&1 >$T/out", command);
    prints(line, "");
}

static inline int setup(void **state)
{
    (void)state;
    return shell_setup("plots", "");
}

static inline char *read_all(const char *name, size_t *size)
{
    const char *path = in_folder(name);
    FILE *f = fopen(path, "rb");
    if (!f)
        print_error("%s is not there\n", path);
    assert_non_null(f);
    assert_int_equal(fseek(f, 0, SEEK_END), 0);
    *size = (size_t)ftell(f);
    rewind(f);
    char *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, f), *size);
    bytes[*size] = '\0';
    fclose(f);
    return bytes;
}

static inline unsigned long big_endian(const char *bytes)
{
    unsigned long n = 0;
    for (int i = 0; i < 4; i++)
        n = n << 8 | (unsigned char)bytes[i];
    return n;
}

/* A picture of any form; a PNG is so many pixels wide. */
static inline void assert_whole_wide(const char *name, unsigned long wide)
{
    size_t size;
    char *bytes = read_all(name, &size);
    const char *form = strrchr(name, '.');
    assert_true(size > 1000);
    if (strcmp(form, ".svg") == 0) {
        assert_memory_equal(bytes, "<?xml", 5);
        assert_has(bytes, "<svg");
        assert_has(bytes + size - 10, "</svg>");
    } else if (strcmp(form, ".png") == 0) {
        assert_memory_equal(bytes, "\x89PNG\r\n\x1a\n", 8);
        assert_memory_equal(bytes + 12, "IHDR", 4);
        assert_int_equal(big_endian(bytes + 16), wide);
        assert_true(big_endian(bytes + 20) > 300);
        assert_memory_equal(bytes + size - 8, "IEND", 4);
    } else if (strcmp(form, ".tex") == 0) {
        assert_has(bytes, "\\begin{picture}");
        assert_has(bytes, "\\fontsize{");
        assert_has(bytes + size - 11, "\\endgroup");
    } else {
        assert_memory_equal(bytes, "%PDF", 4);
        assert_has(bytes + size - 8, "%%EOF");
        assert_non_null(memmem(bytes, size, "(D:20000101000000", 17));
    }
    free(bytes);
}

static inline void assert_whole(const char *name)
{
    assert_whole_wide(name, 1600);
}

/* A table without its comments, row by row; NaN where it says so. */
struct table {
    size_t rows, columns;
    double *value;
};

static inline double table_at(const struct table *t, size_t row, size_t column)
{
    return t->value[row * t->columns + column];
}

/* The block that ends with so many blank lines; one of fewer is skipped. */
static inline struct table table_read_block(const char *name, int ending)
{
    struct table t = { 0, 0, NULL };
    size_t size, room = 0;
    int blank = 0;
    char *bytes = read_all(name, &size), *rest = bytes;
    for (char *line; (line = strsep(&rest, "\n")) && rest;) {
        size_t n = 0;
        blank = *line == '\0' ? blank + 1 : 0;
        if (blank == ending)
            break;
        if (*line == '#' || blank)
            continue;
        double row[COLUMNS_MAX];
        for (char *end; *line && n < COLUMNS_MAX; line = end + (*end == '\t')) {
            row[n++] = strtod(line, &end);
            assert_true(end != line);
        }
        assert_true(t.rows == 0 || n == t.columns);
        t.columns = n;
        if (t.rows == room) {
            room = room ? 2 * room : 1024;
            t.value = realloc(t.value, room * n * sizeof *t.value);
            assert_non_null(t.value);
        }
        memcpy(t.value + t.rows++ * n, row, n * sizeof *row);
    }
    free(bytes);
    assert_true(t.rows > 0);
    return t;
}

static inline struct table table_read(const char *name)
{
    return table_read_block(name, 1);
}

#endif
