/* test_ior.c - optical constants: right figures, and no file that breaks us
 *
 * Where $BSDF_SHARED (../shared if unset) has a copy of part of the
 * refractiveindex.info database, every page of it is read as well.
 */
#include "bsdf/ior.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <errno.h>
#include <ftw.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static char folder[] = "/tmp/test_ior.XXXXXX"; /* of all that is written */

/* -- files to be read ------------------------------------------------------ */

static const char *path_of(const char *name)
{
    static char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

/* Writes a file and the folders it is in. */
static const char *write_bytes(const char *name, const char *bytes, size_t n)
{
    static char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    for (char *slash = path + strlen(folder) + 1; (slash = strchr(slash, '/'));
         slash++) {
        *slash = '\0';
        assert_true(mkdir(path, 0700) == 0 || errno == EEXIST);
        *slash = '/';
    }
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, n, f), n);
    assert_int_equal(fclose(f), 0);
    return path;
}

static const char *write_text(const char *name, const char *text)
{
    return write_bytes(name, text, strlen(text));
}

static void assert_says(const struct err *err, const char *words)
{
    if (!strstr(err->text, words))
        fail_msg("\"%s\" does not say \"%s\"", err->text, words);
}

static void assert_near(double value, double expected, double within)
{
    if (!(fabs(value - expected) <= within))
        fail_msg("%.17g is not within %g of %.17g", value, within, expected);
}

static struct ior_page *load(const char *path)
{
    struct err err = { "" };
    struct ior_page *page = ior_page_load(path, &err);
    if (!page)
        fail_msg("%s", err.text);
    return page;
}

static struct ior_page *load_text(const char *text)
{
    return load(write_text("page.yml", text));
}

/* A page with these rows of n and k. */
static struct ior_page *load_rows(const char *rows)
{
    char text[1024];
    snprintf(text, sizeof text,
             "DATA:\n"
             "  - type: tabulated nk\n"
             "    data: |\n"
             "%s",
             rows);
    return load_text(text);
}

static void assert_refused(const char *path, const char *why)
{
    struct err err = { "" };
    struct ior_page *page = ior_page_load(path, &err);
    if (page)
        fail_msg("loaded, though expected: %s", why);
    assert_says(&err, path);
    assert_says(&err, why);
}

static void assert_at(const struct ior_page *page, double nm, double n_expected,
                      double k_expected, double within)
{
    struct err err = { "" };
    double n, k;
    if (!ior_page_at(page, nm, &n, &k, &err))
        fail_msg("%s", err.text);
    assert_near(n, n_expected, within);
    assert_near(k, k_expected, within);
}

static void assert_not_at(const struct ior_page *page, double nm,
                          const char *why)
{
    struct err err = { "" };
    double n = 1.25, k = 3.5;
    assert_false(ior_page_at(page, nm, &n, &k, &err));
    assert_true(n == 1.25 && k == 3.5);
    assert_says(&err, ior_page_path(page));
    assert_says(&err, why);
}

static void assert_warns(const struct ior_page *page, const char *words)
{
    for (const char *const *w = ior_page_warnings(page); *w; w++)
        if (strstr(*w, words))
            return;
    fail_msg("no warning says \"%s\"", words);
}

static size_t warnings(const struct ior_page *page)
{
    size_t n = 0;
    while (ior_page_warnings(page)[n])
        n++;
    return n;
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* -- figures --------------------------------------------------------------- */

/* The write-up's calcium, to the digits it prints. */
static const double calcium_n[] = { .29294, .28568, .28733 };
static const double calcium_k[] = { 2.71809, 2.34786, 1.83329 };

static void calcium(void **state)
{
    struct err err = { "" };
    struct spectrum eta, k;
    (void)state;
    if (!ior_lookup("Ca", &bands_default, &eta, &k, &err))
        fail_msg("%s", err.text);
    for (int b = 0; b < bands_default.count; b++) {
        assert_near(eta.band[b], calcium_n[b], 5e-6);
        assert_near(k.band[b], calcium_k[b], 5e-6);
    }
    assert_true(eta.band[3] == 0 && k.band[3] == 0);
}

static void lookup_fails_whole(void **state)
{
    const struct bands bands = { 2, { 614, 2000 } };
    struct err err = { "" };
    struct spectrum eta = { { 7 } }, k = { { 8 } };
    (void)state;
    assert_false(ior_lookup("Ca", &bands, &eta, &k, &err));
    assert_true(eta.band[0] == 7 && k.band[0] == 8);
    assert_says(&err, "2000 nm is outside [339.68, 1653.12] nm");
    assert_says(&err, "Ca/Mathewson.yml");
}

static void linear_between_rows(void **state)
{
    (void)state;
    struct ior_page *page = ior_find("Cu/Johnson", "", NULL);
    assert_non_null(page);
    const struct ior_table n = ior_page_n(page), k = ior_page_k(page);
    for (size_t i = 0; i < n.rows; i++)
        assert_at(page, n.nm[i], n.value[i], k.value[i], 0);
    for (size_t i = 1; i < n.rows; i++) {
        const double t = .37, s = 1 - t;
        assert_at(page, s * n.nm[i - 1] + t * n.nm[i],
                  s * n.value[i - 1] + t * n.value[i],
                  s * k.value[i - 1] + t * k.value[i], 1e-12);
    }
    ior_page_free(page);
}

static void outside_the_range(void **state)
{
    (void)state;
    struct ior_page *page = ior_find("Au", "", NULL);
    assert_non_null(page);
    double lo, hi;
    ior_page_range(page, &lo, &hi);
    assert_true(lo == 187.9 && hi == 1937);
    assert_not_at(page, 187.8999, "187.8999 nm is outside [187.9, 1937] nm");
    assert_not_at(page, nextafter(hi, 1e9), "is outside [187.9, 1937] nm");
    assert_not_at(page, NAN, "nan nm is outside");
    assert_not_at(page, INFINITY, "inf nm is outside");
    assert_not_at(page, -500, "-500 nm is outside");
    ior_page_free(page);
}

/* 0.33968 * 1000 is 339.68000000000001 and above the double 339.68. */
static void micrometres_to_the_last_bit(void **state)
{
    (void)state;
    struct ior_page *page = load_rows("      .33968 1.25 2\n"
                                      "      4.3219e-1 1.5 3\n"
                                      "      5432.1E-4 1.75 4\n"
                                      "      +0.62e+0 2.25 5.\n");
    const struct ior_table n = ior_page_n(page);
    assert_int_equal(n.rows, 4);
    assert_true(n.nm[0] == 339.68 && n.nm[1] == 432.19 && n.nm[2] == 543.21 &&
                n.nm[3] == 620);
    assert_at(page, 339.68, 1.25, 2, 0);
    assert_at(page, 620, 2.25, 5, 0);
    ior_page_free(page);
}

/* -- what pages look like -------------------------------------------------- */

static void several_tables(void **state)
{
    (void)state;
    struct ior_page *page = load_text("COMMENTS: none\n"
                                      "PROPERTIES:\n"
                                      "    thermal_dispersion:\n"
                                      "      - type: formula A\n"
                                      "        coefficients: 1 2 3\n"
                                      "DATA:\n"
                                      "  - data: |\n"
                                      "        0.43 3.25\n"
                                      "        0.53 2.25\n"
                                      "        0.73 4.25\n"
                                      "    type: tabulated k\n"
                                      "  - type: formula 2\n"
                                      "    coefficients: 0 1.5 0.25\n"
                                      "  - type: tabulated n2\n"
                                      "    data: |\n"
                                      "        nothing to us\n"
                                      "  - type: tabulated n\n"
                                      "    note: [ a, { b: c } ]\n"
                                      "    data: |\n"
                                      "        0.41 1.125\n"
                                      "        0.61 1.625\n");
    double lo, hi;
    ior_page_range(page, &lo, &hi);
    assert_true(lo == 430 && hi == 610);
    assert_true(ior_page_has_k(page));
    assert_int_equal(ior_page_n(page).rows, 2);
    assert_int_equal(ior_page_k(page).rows, 3);
    assert_at(page, 480, 1.3, 2.75, 1e-15);
    assert_at(page, 580, 1.55, 2.75, 1e-15);
    assert_not_at(page, 420, "420 nm is outside [430, 610] nm");
    assert_not_at(page, 620, "620 nm is outside [430, 610] nm");
    assert_int_equal(warnings(page), 1);
    assert_warns(page, "formula 2 is ignored");
    ior_page_free(page);
}

static void without_k(void **state)
{
    (void)state;
    struct ior_page *page = load_text("DATA:\n"
                                      "  - type: tabulated n\n"
                                      "    data: |\n"
                                      "        0.41 1.125\n"
                                      "        0.61 1.625\n");
    assert_false(ior_page_has_k(page));
    assert_at(page, 510, 1.375, 0, 1e-15);
    ior_page_free(page);
}

static void plain_references(void **state)
{
    (void)state;
    struct ior_page *page = load_text(
        "REFERENCES: |\n"
        "    A. Alpha  and B. Beta.<br>Of CaF<sub>2</sub> at T < 5 K.\n"
        "    <a href=\"https://doi.org/10.1/x\"><i>J. X</i> <b>6</b>, 1</a> "
        "[in German]\n"
        "\n"
        "    [*J. \\*Y\\** **7**, 2 [b]](https://doi.org/10.1/(y)), 3*5 * 2\n"
        "    <https://doi.org/10.1/z>\n"
        "COMMENTS: \"\\e[31mred\\0 \\t\\r\\n\"\n"
        "DATA: [ { type: tabulated nk, data: 0.5 1 2 } ]\n");
    assert_string_equal(ior_page_reference(page),
                        "A. Alpha and B. Beta.\n"
                        "Of CaF2 at T < 5 K.\n"
                        "J. X 6, 1 (https://doi.org/10.1/x) [in German]\n"
                        "J. *Y* 7, 2 [b] (https://doi.org/10.1/(y)), 3*5 * 2\n"
                        "https://doi.org/10.1/z");
    assert_string_equal(ior_page_comments(page), "[31mred");
    ior_page_free(page);

    page = load_rows("        0.5 1 2\n");
    assert_string_equal(ior_page_reference(page), "");
    assert_string_equal(ior_page_comments(page), "");
    ior_page_free(page);
}

/* Names the page after what is odd about it; all have the same two rows. */
static void harmless_oddities(void **state)
{
    static const struct {
        const char *oddity, *text;
    } odd[] = {
        { "tabs", "DATA:\n  - type: tabulated nk\n    data: |\n"
                  "        0.5\t1.25\t2 \t\n        \t0.7 1.75 \t 4\n" },
        { "CRLF", "DATA:\r\n  - type: tabulated nk\r\n    data: |\r\n"
                  "        0.5 1.25 2\r\n        0.7 1.75 4\r\n" },
        { "CR", "DATA:\r  - type: tabulated nk\r    data: |\r"
                "        0.5 1.25 2\r        0.7 1.75 4\r" },
        { "no newline at the end",
          "DATA:\n  - type: tabulated nk\n    data: |\n"
          "        0.5 1.25 2\n        0.7 1.75 4" },
        { "blank lines", "\n\nDATA:\n\n  - type: tabulated nk\n    data: |\n\n"
                         "        0.5 1.25 2\n\n  \n        0.7 1.75 4\n\n\n" },
        { "byte order mark", "\xEF\xBB\xBF"
                             "DATA:\n  - type: tabulated nk\n    data: |\n"
                             "        0.5 1.25 2\n        0.7 1.75 4\n" },
        { "quoted rows", "DATA: [{data: \"0.5 1.25 2\\n0.7 1.75 4\","
                         " type: 'tabulated nk'}]" },
        { "start and end of the document",
          "%YAML 1.1\n---\nDATA:\n  - type: tabulated nk\n    data: |2\n"
          "        0.5 1.25 2\n        0.7 1.75 4\n...\n# end\n" },
        { "anchors, and aliases elsewhere",
          "A: &a [1, 2]\nB: *a\nDATA: &d\n  - type: tabulated nk\n"
          "    data: |\n        0.5 1.25 2\n        0.7 1.75 4\n" },
        { "keys that are not text",
          "[a, b]: c\n? {d: e}\n: f\nDATA:\n  - type: tabulated nk\n"
          "    {g: h}: i\n"
          "    data: |\n        0.5 1.25 2\n        0.7 1.75 4\n" },
        { "equal rows twice", "DATA:\n  - type: tabulated nk\n    data: |\n"
                              "      0.5 1.25 2\n      0.50 1.25 2\n"
                              "      0.7 1.75 4\n      0.7 1.75 4.0\n" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        print_message("             %s\n", odd[i].oddity);
        struct ior_page *page = load_text(odd[i].text);
        assert_int_equal(ior_page_n(page).rows, 2);
        assert_int_equal(warnings(page), 0);
        assert_at(page, 500, 1.25, 2, 0);
        assert_at(page, 550, 1.375, 2.5, 1e-15);
        assert_at(page, 700, 1.75, 4, 0);
        ior_page_free(page);
    }
}

static void sorted_with_a_warning(void **state)
{
    (void)state;
    struct ior_page *page = load_rows("        0.7 1.75 4\n"
                                      "        0.5 1.25 2\n"
                                      "        0.6 1.625 3\n");
    assert_at(page, 550, 1.4375, 2.5, 1e-15);
    assert_int_equal(warnings(page), 1);
    assert_warns(page, "row 2 with 500 nm after 700 nm");
    ior_page_free(page);
}

static void averaged_with_a_warning(void **state)
{
    (void)state;
    struct ior_page *page = load_rows("        0.5 1.25 2\n"
                                      "\n"
                                      "        0.6 1.5 3\n"
                                      "        0.6 1.75 3\n"
                                      "        0.7 2.25 4\n");
    assert_int_equal(ior_page_n(page).rows, 3);
    assert_at(page, 600, 1.625, 3, 1e-15);
    assert_int_equal(warnings(page), 1);
    assert_warns(page, "2 rows (2, 3) differ at 600 nm; averaged");
    ior_page_free(page);
}

static void one_row(void **state)
{
    (void)state;
    struct ior_page *page = load_rows("        0.6328 0.2 3.5\n");
    double lo, hi;
    ior_page_range(page, &lo, &hi);
    assert_true(lo == 632.8 && hi == 632.8);
    assert_at(page, 632.8, .2, 3.5, 0);
    assert_not_at(page, 632.7, "is outside [632.8, 632.8] nm");
    ior_page_free(page);
}

/* Noise about zero at one end is no reason to do without the other. */
static void negative_values(void **state)
{
    (void)state;
    struct ior_page *page = load_rows("        0.5 1.25 2\n"
                                      "        0.6 1.5 0\n"
                                      "        0.7 0 -0.001\n"
                                      "        0.8 1.75 0.25\n");
    assert_at(page, 550, 1.375, 1, 1e-15);
    assert_at(page, 600, 1.5, 0, 0);
    assert_at(page, 800, 1.75, .25, 0);
    assert_not_at(page, 601, "k is -0.001 at 700 nm");
    assert_not_at(page, 700, "k is -0.001 at 700 nm");
    assert_not_at(page, 799, "k is -0.001 at 700 nm");
    assert_int_equal(warnings(page), 1);
    assert_warns(page, "row 3 has a negative k = -0.001 at 700 nm");
    ior_page_free(page);
}

static void few_warnings(void **state)
{
    char rows[1024] = "";
    (void)state;
    for (int i = 0; i < 40; i++)
        snprintf(rows + strlen(rows), sizeof rows - strlen(rows),
                 "      0.5%02d 1 -1\n", i);
    struct ior_page *page = load_rows(rows);
    assert_int_equal(warnings(page), 33);
    assert_warns(page, "row 32 ");
    assert_warns(page, "and 8 more");
    ior_page_free(page);
}

/* -- what is refused ------------------------------------------------------- */

#define ROWS "DATA:\n  - type: tabulated nk\n    data: |\n      0.4 1 2\n"

static void refused_with_a_reason(void **state)
{
    static const struct {
        const char *text, *why;
    } bad[] = {
        { "", "nothing in it" },
        { "# only this\n", "nothing in it" },
        { "REFERENCES: someone\n", "no DATA in it" },
        { "data:\n  - type: tabulated nk\n", "no DATA in it" },
        { "DATA\n", ":1: expected a mapping" },
        { "- DATA\n", ":1: expected a mapping" },
        { "DATA:\n", ":1: DATA is not a list" },
        { "DATA: {type: tabulated nk}\n", ":1: DATA is not a list" },
        { "DATA: []\n", "no n in DATA" },
        { "DATA:\n  - tabulated nk\n", ":2: an item of DATA is no mapping" },
        { "DATA:\n  - data: 0.5 1 2\n", ":2: an item of DATA has no type" },
        { "DATA:\n  - type: tabulated nk\n", ":2: tabulated nk has no data" },
        { "DATA:\n  - type: tabulated nk\n    data: |\n\n",
          ":2: tabulated nk has no rows" },
        { "DATA:\n  - type: tabulated nk\n    data: [0.5, 1, 2]\n",
          ":3: data in DATA: expected text" },
        { "DATA:\n  - type: [tabulated nk]\n", ":2: type in DATA: expected" },
        { "DATA:\n  - type: formula 2\n    coefficients: 0 1 2\n",
          ":2: formula dispersion is not supported yet (formula 2)" },
        { "DATA:\n  - type: formula 1\n  - type: tabulated k\n"
          "    data: |\n      0.4 1\n",
          ":2: formula dispersion is not supported yet (formula 1)" },
        { "DATA:\n  - type: tabulated kn\n",
          ":2: unknown type \"tabulated kn\", expected tabulated nk, n or k" },
        { "DATA:\n  - type: tabulated n2\n", "no n in DATA" },
        { "DATA:\n  - type: tabulated k\n    data: 0.4 1\n", "no n in DATA" },
        { "DATA:\n  - type: tabulated n\n    data: 0.4 1\n"
          "  - type: tabulated k\n    data: 0.5 1\n",
          "no wavelength has both, n in [400, 400] and k in [500, 500] nm" },
        { ROWS "  - type: tabulated k\n    data: 0.5 1\n",
          ":5: tabulated k: DATA has k already" },
        { ROWS "    type: tabulated n\n", ":5: a second type" },
        { ROWS "    data: 0.5 1 2\n", ":5: a second data" },
        { ROWS "DATA: []\n", ":5: a second DATA" },
        { ROWS "---\nDATA: []\n", "a second document" },
        { ROWS "      0.5 1\n",
          ":5: row 2 of tabulated nk: 2 values, expected wavelength, n and k" },
        { ROWS "\n      0.5 1 2 3\n", ":6: row 2 of tabulated nk: 4 values" },
        { ROWS "      0.5 1 nan\n",
          ":5: row 2 of tabulated nk: \"nan\" is not a number" },
        { ROWS "      0.5 inf 2\n", ":5: row 2 of tabulated nk: \"inf\"" },
        { ROWS "      0.5 1e999 2\n", ":5: row 2 of tabulated nk: \"1e999\"" },
        { ROWS "      0x1p-1 1 2\n", ":5: row 2 of tabulated nk: \"0x1p-1\"" },
        { ROWS "      0.5 1,5 2\n", ":5: row 2 of tabulated nk: \"1,5\"" },
        { ROWS "      0.5 1.5.2 2\n", ":5: row 2 of tabulated nk: \"1.5.2\"" },
        { ROWS "      0.5 1e 2\n", ":5: row 2 of tabulated nk: \"1e\"" },
        { ROWS "      0.5 1e+ 2\n", ":5: row 2 of tabulated nk: \"1e+\"" },
        { ROWS "      0.5 . 2\n", ":5: row 2 of tabulated nk: \".\"" },
        { ROWS "      0.5 --1 2\n", ":5: row 2 of tabulated nk: \"--1\"" },
        { ROWS "      0.5 \xC2\xA0"
               "1 2\n",
          ":5: row 2 of tabulated nk: \"\?\?1\"" },
        { ROWS "      0.5 1000000000000000000000000000000000000000000000000 "
               "1e99999999999999999999\n",
          "\"1e99999999999999999999\" is not a number" },
        { ROWS "      0 1 2\n",
          ":5: row 2 of tabulated nk: wavelength 0 um, expected more than 0" },
        { ROWS "      -0.5 1 2\n", ":5: row 2 of tabulated nk: wavelength" },
        { ROWS "      1e-400 1 2\n", ":5: row 2 of tabulated nk: wavelength" },
        { ROWS "\t- type: x\n", ":5: not YAML: found a tab" },
        { "X: &x [1]\nDATA: *x\n", ":2: an alias" },
        { "X: &x a\nDATA:\n  - type: tabulated nk\n    data: *x\n",
          ":4: an alias" },
        { "X: &x a\nDATA:\n  - type: tabulated nk\n    more: [[*x]]\n",
          ":4: an alias" },
        { "A: b\nDATA: [\n", ":3: not YAML: " },
        { "A: b\nC: d: e\n", ":2: not YAML: " },
        { "A: b\n\tC: d\n", ":2: not YAML: " },
        { "A: b\nC: \"d\n", ":3: not YAML: " },
        { "A: b\nC: caf\xE9 ole\n", ":2: not YAML: " },
        { "A: b\nC: \x01\n", ":2: not YAML: " },
        { "%TAG ! x\n---\nDATA: []\n", "%TAG" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_refused(write_text("bad.yml", bad[i].text), bad[i].why);
}

static void not_files(void **state)
{
    (void)state;
    assert_refused(path_of("none.yml"), "No such file");
    assert_refused(folder, "a folder, expected a file");
    assert_int_equal(mkfifo(path_of("fifo.yml"), 0600), 0);
    assert_refused(path_of("fifo.yml"), "not a regular file");
    assert_refused("/dev/zero", "not a regular file");
    if (geteuid() != 0) {
        const char *path = write_text("secret.yml", ROWS);
        chmod(path, 0);
        assert_refused(path, "Permission denied");
    }
}

static void bytes_of_all_kinds(void **state)
{
    char bytes[256];
    (void)state;
    for (int i = 0; i < 256; i++)
        bytes[i] = (char)i;
    assert_refused(write_bytes("binary.yml", bytes, 256), ":1: not YAML: ");
    assert_refused(write_bytes("utf16.yml",
                               "\xFF\xFE"
                               "D\0A\0T\0A\0",
                               10),
                   ":1: not YAML: ");
}

/* What would take minutes or gigabytes if it were believed. */
static void sizes_are_bounded(void **state)
{
    const size_t deep = 200000, many = 1000001;
    char *text = malloc(7 * many + 100);
    (void)state;
    assert_non_null(text);

    double start = seconds();
    static const char *const open[] = { "[", "{", "- ", "? ", "[{" };
    for (size_t o = 0; o < sizeof open / sizeof *open; o++) {
        const size_t length = strlen(open[o]);
        for (size_t i = 0; i < deep; i++)
            memcpy(text + length * i, open[o], length);
        assert_refused(write_bytes("deep.yml", text, length * deep), ":1: ");
        memcpy(text, "A: ", 3);
        assert_refused(write_bytes("deep.yml", text, length * deep), ":1: ");
    }
    for (size_t i = 0; i < deep; i++)
        memcpy(text + 12 * i, "%TAG !x! y \n", 12);
    assert_refused(write_bytes("deep.yml", text, 12 * deep / 3), "%TAG");
    if (seconds() - start > 1)
        fail_msg("%g seconds", seconds() - start);

    size_t used = (size_t)sprintf(text, "DATA:\n"
                                        "- type: tabulated n\n"
                                        "  data: |\n");
    for (size_t i = 0; i < many; i++, used += 7)
        memcpy(text + used, "   1 1\n", 7);
    assert_refused(write_bytes("many.yml", text, used),
                   ":1000004: tabulated n has more than 1000000 rows");
    struct ior_page *page = load(write_bytes("many.yml", text, used - 7));
    assert_int_equal(ior_page_n(page).rows, 1);
    ior_page_free(page);
    free(text);

    const char *path = write_text("big.yml", ROWS);
    assert_int_equal(truncate(path, (64 << 20) + 1), 0);
    assert_refused(path, "67108865 bytes, expected at most 67108864");
}

/* Loads, or says why and of which file; nothing that is loaded is absurd. */
static bool survives(const char *path)
{
    struct err err = { "" };
    struct ior_page *page = ior_page_load(path, &err);
    if (!page) {
        assert_says(&err, path);
        assert_true(strlen(err.text) > strlen(path) + 5);
        return false;
    }
    double lo, hi, n, k;
    ior_page_range(page, &lo, &hi);
    assert_true(lo > 0 && lo <= hi && hi < INFINITY);
    if (ior_page_at(page, (lo + hi) / 2, &n, &k, NULL))
        assert_true(n >= 0 && k >= 0 && n < INFINITY && k < INFINITY);
    ior_page_free(page);
    return true;
}

static const char small[] = "# x\n"
                            "REFERENCES: |\n"
                            "  <a href=\"u\">[v](w)</a> *\\*\n"
                            "DATA:\n"
                            "- type: tabulated n\n"
                            "  data: |\n"
                            "    0.54 1.25\n"
                            "    0.53 1.5e-1\n"
                            "- data: \"0.5 1\\n 0.6 2\"\n"
                            "  type: tabulated k\n"
                            "P: [{a: b}, 'c', &d e, *d, !!f g]\n";

static void cut_off_anywhere(void **state)
{
    size_t loaded = 0;
    (void)state;
    for (size_t n = 0; n < sizeof small; n++)
        loaded += survives(write_bytes("cut.yml", small, n));
    print_message("             %zu of %zu pieces make sense\n", loaded,
                  sizeof small);
    assert_true(loaded > 10 && loaded < sizeof small / 2);
}

static void any_byte_replaced(void **state)
{
    static const char by[] = "\t\n\r \"'#&*-:[{|>%@\\<.9e\x80\xC2\xFF";
    char text[sizeof small];
    size_t loaded = 0, count = 0;
    (void)state;
    for (size_t i = 0; i + 1 < sizeof small; i++)
        for (size_t b = 0; b < sizeof by; b++, count++) { /* and a zero */
            memcpy(text, small, sizeof small);
            text[i] = by[b];
            loaded += survives(write_bytes("byte.yml", text, sizeof small - 1));
        }
    print_message("             %zu of %zu still make sense\n", loaded, count);
    assert_true(loaded > 100 && loaded < count);
}

/* -- names ----------------------------------------------------------------- */

static void write_page(const char *name, double n)
{
    char text[200];
    snprintf(text, sizeof text,
             "DATA:\n  - type: tabulated n\n    data: 0.5 %g\n", n);
    write_text(name, text);
}

/* Expects a page with n at 500 nm, or a reason if n is 0. */
static void assert_find(const char *name, const char *root, double n,
                        const char *why)
{
    struct err err = { "" };
    struct ior_page *page = ior_find(name, root, &err);
    if (page && n == 0)
        fail_msg("%s: found %s", name, ior_page_path(page));
    if (!page && n != 0)
        fail_msg("%s", err.text);
    if (page)
        assert_at(page, 500, n, 0, 0);
    else
        assert_says(&err, why);
    ior_page_free(page);
}

static void layouts_of_the_database(void **state)
{
    static const char *const layouts[][3] = {
        /* what ROOT is, where its shelves are, what pages are in */
        { "new", "new/database/data", "/nk" },
        { "new2/database", "new2/database/data", "/nk" },
        { "new3/database/data", "new3/database/data", "/nk" },
        { "old", "old/database/data-nk", "" },
        { "old2/database", "old2/database/data-nk", "" },
        { "old3/data", "old3/data/", "" },
        { "old4", "old4/data/", "" },
    };
    static const char *const shelves[] = {
        "glass/Xx",
        "main/Xx",
        "other/mixed gases/Yy",
        "organic/C1 - zed",
        "specs/maker/optical",
        "glass/optical/Zz",
    };
    (void)state;
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++) {
        const char *const *l = layouts[i];
        char path[300], root[PATH_MAX];
        for (size_t s = 0; s < sizeof shelves / sizeof *shelves; s++) {
            snprintf(path, sizeof path, "%s/%s%s/Page.yml", l[1], shelves[s],
                     l[2]);
            write_page(path, 1.25 + (double)s);
        }
        snprintf(path, sizeof path, "%s/glass/Xx%s/Other.yml", l[1], l[2]);
        write_page(path, 9.5);
        snprintf(path, sizeof path, "%s/main/Xx/about.yml", l[1]);
        write_page(path, 7.5);
        snprintf(root, sizeof root, "%s/%s", folder, l[0]);

        assert_find("Xx/Page", root, 2.25, "");  /* main before glass */
        assert_find("Xx/Other", root, 9.5, "");  /* but glass has more */
        assert_find("Yy", root, 3.25, "");       /* the only page */
        assert_find("C1", root, 4.25, "");       /* up to " - " */
        assert_find("C1 - zed", root, 4.25, ""); /* or all of it */
        assert_find("optical/Page", root, 5.25, "");
        assert_find("Zz/Page", root, 6.25, "");
        assert_find("Xx", root, 0, "Xx has 2 pages");
        assert_find("Xx", root, 0, "Page, Other");
        assert_find("Xx/about", root, 0, "no page \"about\" of Xx");
        assert_find("nk/Page", root, 0, "no optical constants of \"nk\"");
        assert_find("xx", root, 0, "(did you mean Xx?)");
        assert_find("Xx/Pag", root, 0,
                    "(did you mean Page?), only Page, Other");

        struct ior_page *page = ior_find("Ca", root, NULL); /* in the tree */
        assert_non_null(page);
        assert_at(page, 614, calcium_n[0], calcium_k[0], 5e-6);
        ior_page_free(page);
    }
}

static void the_users_copy_comes_first(void **state)
{
    char root[PATH_MAX];
    (void)state;
    write_page("mine/data/main/Ca/nk/Mathewson.yml", 1.75);
    write_page("mine/data/main/Ca/nk/Other.yml", 2.5);
    write_page("mine/data/main/Au/nk/Only.yml", 3.5);
    snprintf(root, sizeof root, "%s/mine", folder);
    assert_find("Ca", root, 1.75, "");
    assert_find("Ca/Other", root, 2.5, "");
    assert_find("Au/Only", root, 3.5, "");
    setenv("BSDF_IOR_PATH", root, 1);
    assert_find("Ca", NULL, 1.75, "");
    setenv("BSDF_IOR_PATH", "", 1);
    assert_find("Ca/Other", NULL, 0, "no page \"Other\" of Ca");
    unsetenv("BSDF_IOR_PATH");

    struct ior_page *page = ior_find("Au", root, NULL); /* Johnson's */
    assert_non_null(page);
    assert_int_equal(ior_page_n(page).rows, 49);
    ior_page_free(page);

    snprintf(root, sizeof root, "%s/nowhere", folder);
    assert_find("Ca", root, 0, "nowhere: no such folder");
    write_text("no-folder", "");
    snprintf(root, sizeof root, "%s/no-folder", folder);
    assert_find("Ca", root, 0, "no-folder: no such folder");
}

static void files_and_data_folders(void **state)
{
    char path[PATH_MAX];
    (void)state;
    write_page("own/ior/Qq/Page.yml", 2.125);
    assert_find(path_of("own/ior/Qq/Page.yml"), "", 2.125, "");
    snprintf(path, sizeof path, "%s/own/../own/ior/Qq/Page.yml", folder);
    assert_find(path, "", 2.125, "");
    setenv("BSDF_DATA", path_of("own"), 1);
    assert_find("Qq", "", 2.125, "");
    assert_find("Ca", "", 0, "only of Qq");
    setenv("BSDF_DATA", path_of("nothing"), 1);
    assert_find("Ca", "", 0, "nothing/ior: no such folder");
    assert_find("Qq", path_of("own/ior"), 2.125, ""); /* needs no other */
    assert_find("Ca", path_of("own/ior"), 0, "own/ior, only of Qq");
    unsetenv("BSDF_DATA");
}

static void names_that_mean_nothing(void **state)
{
    static const struct {
        const char *name, *why;
    } bad[] = {
        { "", "expected MATERIAL, MATERIAL/PAGE or a file" },
        { "..", "expected MATERIAL" },
        { ".", "expected MATERIAL" },
        { "../Ca", "expected MATERIAL" },
        { "Ca/..", "expected MATERIAL" },
        { "Ca/../Au", "expected MATERIAL" },
        { "/Ca", "expected MATERIAL" },
        { "Ca/", "expected MATERIAL" },
        { "Ca//Mathewson", "expected MATERIAL" },
        { "main/Ca/Mathewson", "expected MATERIAL" },
        { "/etc/passwd", "expected MATERIAL" },
        { "Cb", "no optical constants of \"Cb\"" },
        { "Cb", "(did you mean Ca?), only of Au, Ca, Cu" },
        { "CA", "(did you mean Ca?)" },
        { "unobtainium", "only of Au, Ca, Cu" },
        { "Ca/Matheson", "no page \"Matheson\" of Ca" },
        { "Ca/Matheson", "(did you mean Mathewson?), only Mathewson" },
        { "Ca/mathewson", "(did you mean Mathewson?)" },
        { "Ca/Johnson and Christy", "only Mathewson" },
        { ".yml", "expected MATERIAL" },
        { "Ca/Mathewson.yml", "Ca/Mathewson.yml: No such file" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_find(bad[i].name, "", 0, bad[i].why);
    char name[5000];
    memset(name, 'x', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    assert_find(name, "", 0, "expected MATERIAL");
    memcpy(name, "Ca/", 3);
    assert_find(name, "", 0, "expected MATERIAL");
    memcpy(name + sizeof name - 5, ".yml", 4);
    assert_find(name, "", 0, "File name too long");
}

static void walks_are_bounded(void **state)
{
    char root[300], loop[320];
    (void)state;
    write_page("loop/main/Xx/nk/Page.yml", 1.25);
    snprintf(root, sizeof root, "%s/loop", folder);
    for (int i = 0; i < 12; i++) {
        snprintf(loop, sizeof loop, "%s/%d", root, i);
        assert_int_equal(symlink(".", loop), 0);
    }
    const double start = seconds();
    assert_find("Xx", root, 0, "gave up after 50000 files and folders");
    assert_find("Xx/Page", root, 1.25, "");
    if (seconds() - start > 10)
        fail_msg("%g seconds", seconds() - start);
}

static void add_name(void *text, const char *name)
{
    strcat(strcat(text, name), " ");
}

static void lists_what_comes_along(void **state)
{
    char names[200] = "";
    struct err err = { "" };
    (void)state;
    if (!ior_list(add_name, names, &err))
        fail_msg("%s", err.text);
    assert_string_equal(names, "Au/Johnson Ca/Mathewson Cu/Johnson ");
    setenv("BSDF_DATA", path_of("nothing"), 1);
    assert_false(ior_list(add_name, names, &err));
    assert_says(&err, "nothing/ior: no such folder");
    unsetenv("BSDF_DATA");
}

/* -- a copy of the database ------------------------------------------------ */

static const char *database(void)
{
    static char path[PATH_MAX];
    const char *shared = getenv("BSDF_SHARED");
    snprintf(path, sizeof path, "%s/data/refractiveindex",
             shared ? shared : "../shared");
    if (access(path, R_OK) != 0) {
        print_message("             skipped: no %s\n", path);
        skip();
    }
    return path;
}

static size_t loaded, refused, odd;

static int read_page(const char *path, const struct stat *s, int type,
                     struct FTW *at)
{
    (void)s;
    const char *name = path + at->base;
    if (type != FTW_F || !strstr(path, "/nk/") || !strstr(name, ".yml"))
        return 0;
    struct err err = { "" };
    struct ior_page *page = ior_page_load(path, &err);
    if (!page) {
        refused++;
        print_message("             %s\n", err.text);
        assert_says(&err, path);
        if (!strstr(err.text, "formula dispersion is not supported yet"))
            assert_says(&err, "row ");
        return 0;
    }
    loaded++;
    odd += ior_page_warnings(page)[0] != NULL;
    for (const char *const *w = ior_page_warnings(page); *w; w++)
        print_message("             %s: %s\n", name, *w);
    assert_null(strpbrk(ior_page_reference(page), "<>"));

    /* By its name it is found again. */
    char material[PATH_MAX], *end;
    snprintf(material, sizeof material, "%.*s", at->base - 4, path);
    const char *folder_of = strrchr(material, '/') + 1;
    char full[PATH_MAX * 2];
    snprintf(full, sizeof full, "%s/%s", folder_of, name);
    if ((end = strrchr(full, '.')))
        *end = '\0';
    struct ior_page *again = ior_find(full, database(), &err);
    if (!again)
        fail_msg("%s", err.text);
    assert_string_equal(ior_page_path(again), path);
    ior_page_free(again);
    ior_page_free(page);
    return 0;
}

static void every_page_of_the_database(void **state)
{
    (void)state;
    loaded = refused = odd = 0;
    assert_int_equal(nftw(database(), read_page, 16, FTW_PHYS), 0);
    print_message("             loaded %zu, %zu of them with warnings; "
                  "refused %zu\n",
                  loaded, odd, refused);
    assert_true(loaded > 200);
}

static void our_tables_are_the_databases(void **state)
{
    static const char *const names[] = { "Au/Johnson", "Ca/Mathewson",
                                         "Cu/Johnson" };
    static const size_t rows[] = { 49, 59, 49 };
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct ior_page *ours = ior_find(names[i], "", NULL);
        struct ior_page *theirs = ior_find(names[i], database(), NULL);
        assert_non_null(ours);
        assert_non_null(theirs);
        assert_string_not_equal(ior_page_path(ours), ior_page_path(theirs));
        const struct ior_table a[] = { ior_page_n(ours), ior_page_k(ours) };
        const struct ior_table b[] = { ior_page_n(theirs), ior_page_k(theirs) };
        for (int j = 0; j < 2; j++) {
            assert_int_equal(a[j].rows, rows[i]);
            assert_int_equal(b[j].rows, rows[i]);
            const size_t bytes = rows[i] * sizeof(double);
            assert_memory_equal(a[j].nm, b[j].nm, bytes);
            assert_memory_equal(a[j].value, b[j].value, bytes);
        }
        assert_int_equal(warnings(ours), 0);
        ior_page_free(ours);
        ior_page_free(theirs);
    }
}

/* -- all of them ----------------------------------------------------------- */

static int make_folder(void **state)
{
    (void)state;
    unsetenv("BSDF_IOR_PATH");
    unsetenv("BSDF_DATA");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_one(const char *path, const struct stat *s, int type,
                      struct FTW *at)
{
    (void)s, (void)type, (void)at;
    return remove(path);
}

static int remove_folder(void **state)
{
    (void)state;
    return nftw(folder, remove_one, 16, FTW_PHYS | FTW_DEPTH);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { .name = "calcium is the write-up's", .test_func = calcium },
        { .name = "a lookup fails for all bands or none",
          .test_func = lookup_fails_whole },
        { .name = "n and k are linear between rows",
          .test_func = linear_between_rows },
        { .name = "outside the range there is an error that states it",
          .test_func = outside_the_range },
        { .name = "micrometres become nanometres to the last bit",
          .test_func = micrometres_to_the_last_bit },
        { .name = "n and k may come in tables of their own",
          .test_func = several_tables },
        { .name = "a page without k has k = 0", .test_func = without_k },
        { .name = "references are plain text", .test_func = plain_references },
        { .name = "harmless oddities are read in silence",
          .test_func = harmless_oddities },
        { .name = "rows out of order are sorted with a warning",
          .test_func = sorted_with_a_warning },
        { .name = "rows of one wavelength are averaged with a warning",
          .test_func = averaged_with_a_warning },
        { .name = "one row is a table", .test_func = one_row },
        { .name = "a negative value cannot be had",
          .test_func = negative_values },
        { .name = "the list of warnings is bounded",
          .test_func = few_warnings },
        { .name = "what makes no sense is refused with a reason",
          .test_func = refused_with_a_reason },
        { .name = "what is no file is refused", .test_func = not_files },
        { .name = "binary files are refused", .test_func = bytes_of_all_kinds },
        { .name = "depth, rows and size are bounded",
          .test_func = sizes_are_bounded },
        { .name = "a page cut off anywhere does no harm",
          .test_func = cut_off_anywhere },
        { .name = "a page with any byte replaced does no harm",
          .test_func = any_byte_replaced },
        { .name = "old and new layouts of the database are found",
          .test_func = layouts_of_the_database },
        { .name = "the user's copy of the database comes first",
          .test_func = the_users_copy_comes_first },
        { .name = "files and other data folders can be named",
          .test_func = files_and_data_folders },
        { .name = "a wrong name is told what there is",
          .test_func = names_that_mean_nothing },
        { .name = "a walk through folders is bounded",
          .test_func = walks_are_bounded },
        { .name = "what comes along can be listed",
          .test_func = lists_what_comes_along },
        { .name = "every page of the database loads or says why not",
          .test_func = every_page_of_the_database },
        { .name = "our tables are the database's, row for row",
          .test_func = our_tables_are_the_databases },
    };
    return cmocka_run_group_tests_name("ior", tests, make_folder,
                                       remove_folder);
}
