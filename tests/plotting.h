/* plotting.h - what the tests of bsdf-plot share
 *
 * bsdf-plot is in the folder that BIN names, build/bin by default; the tests
 * run in the root of the repository and write only into a folder of their own,
 * $T.
 */
#ifndef TESTS_PLOTTING_H
#define TESTS_PLOTTING_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "tests/close.h"
#include "tests/shell.h"

enum { OUTPUT_MAX = 1 << 16, COLUMNS_MAX = 16 };

/* Where the programs are, the test's own folder, what a command printed. */
static char bin[4096], folder[64], output[OUTPUT_MAX];

/* Runs a shell command with the program in PATH and the test's own folder as
 * $T; its exit status, or -1 if it was killed; output has what it printed. */
static inline int sh(const char *command)
{
    return shell(command, output, OUTPUT_MAX);
}

/* Commands that all succeed, without a word on standard error. */
static inline void quiet(const char *command)
{
    char line[8192];
    snprintf(line, sizeof line, "{ set -e; %s; } 2>&1 >$T/out </dev/null",
             command);
    const int status = sh(line);
    if (status != 0 || *output)
        print_error("%s: status %d: %s\n", command, status, output);
    assert_int_equal(status, 0);
    assert_string_equal(output, "");
}

/* A wrong request: status 2, both parts on standard error, and no file. */
static inline void refused(const char *command, const char *a, const char *b)
{
    char line[1024];
    quiet("mkdir $T/refused");
    snprintf(line, sizeof line,
             "{ cd $T/refused && %s; } 2>&1 >$T/printed </dev/null", command);
    const int status = sh(line);
    if (status != 2)
        print_error("%s: status %d: %s\n", command, status, output);
    assert_int_equal(status, 2);
    assert_has(output, a);
    assert_has(output, b);
    quiet("[ ! -s $T/printed ]; rmdir $T/refused");
}

static inline int setup(void **state)
{
    (void)state;
    unsetenv("BSDF_IOR_PATH");
    return shell_setup("plots", bin, folder);
}

static inline int teardown(void **state)
{
    (void)state;
    return sh("rm -rf \"$T\"");
}

static inline char *read_all(const char *name, size_t *size)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
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
