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

/* A page whose n is a formula. */
static struct ior_page *load_formula(int number, const char *coefficients,
                                     const char *range)
{
    char text[1024];
    snprintf(text, sizeof text,
             "DATA:\n"
             "  - type: formula %d\n"
             "    wavelength_range: %s\n"
             "    coefficients: %s\n",
             number, range, coefficients);
    return load_text(text);
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
    if (!ior_lookup("Ca", &bands_fixed, &eta, &k, &err))
        fail_msg("%s", err.text);
    for (int b = 0; b < bands_fixed.count; b++) {
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
                                      "  - type: formula 12\n"
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
    assert_warns(page, "\"formula 12\" in DATA is ignored");
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

#define FORMULA "DATA:\n  - type: formula 5\n    wavelength_range: .3 .8\n"

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
        { "DATA:\n  - type: formula 0\n", ":2: unknown type \"formula 0\"" },
        { "DATA:\n  - type: formula 10\n",
          ":2: unknown type \"formula 10\", expected tabulated nk, n or k, or "
          "formula 1 to 9" },
        { "DATA:\n  - type: formula A\n", ":2: unknown type \"formula A\"" },
        { "DATA:\n  - type: formula\n", ":2: unknown type \"formula\"" },
        { "DATA:\n  - type: formula  2\n", ":2: unknown type" },
        { "DATA:\n  - type: formula 2\n    coefficients: 0 1 2\n",
          ":2: formula 2 has no wavelength_range" },
        { "DATA:\n  - type: formula 2\n    range: .3 .8\n",
          ":2: formula 2 has no coefficients" },
        { FORMULA "    coefficients:\n", ":2: formula 5 has no coefficients" },
        { FORMULA "    coefficients: [1, 2]\n",
          ":4: coefficients in DATA: expected text" },
        { FORMULA "    coefficients: 1 x 3\n",
          ":4: formula 5: coefficients \"x\" is not a number" },
        { FORMULA "    coefficients: 1 nan 3\n", "\"nan\" is not a number" },
        { FORMULA "    coefficients: 1 1e999 3\n",
          "\"1e999\" is not a number" },
        { FORMULA "    coefficients: 1, 2\n", "\"1,\" is not a number" },
        { FORMULA "    coefficients: |\n      1 2\n\n      3 y\n",
          ":7: formula 5: coefficients \"y\" is not a number" },
        { FORMULA "    coefficients: 1 2 3 4 5 6 7 8 9 10 11 12\n",
          ":4: formula 5: coefficients \"12\" is one too many, as it takes "
          "11" },
        { FORMULA "    coefficients: 1\n    coefficients: 1\n",
          ":5: a second coefficients in one item" },
        { FORMULA "    range: 1 2\n    coefficients: 1\n",
          ":4: a second range in one item" },
        { "DATA:\n  - type: formula 7\n    wavelength_range: 1 2\n"
          "    coefficients: 1 2 3 4 5 6 7\n",
          "\"7\" is one too many, as it takes 6" },
        { "DATA:\n  - type: formula 8\n    wavelength_range: 1 2\n"
          "    coefficients: 1 2 3 4 5\n",
          "\"5\" is one too many, as it takes 4" },
        { "DATA:\n  - type: formula 5\n    coefficients: 1\n"
          "    wavelength_range: .8 .3\n",
          ":4: formula 5: range from 0.8 to 0.3 um, expected to rise" },
        { "DATA:\n  - type: formula 5\n    coefficients: 1\n    range: -.3 "
          ".8\n",
          ":4: formula 5: range from -0.3 to 0.8 um" },
        { "DATA:\n  - type: formula 5\n    coefficients: 1\n    range: 0 .8\n",
          ":4: formula 5: range from 0 to 0.8 um" },
        { "DATA:\n  - type: formula 5\n    coefficients: 1\n    range: .8\n",
          ":4: formula 5: 1 number in its range, expected the least" },
        { "DATA:\n  - type: formula 5\n    coefficients: 1\n    range:\n",
          ":4: formula 5: 0 numbers in its range" },
        { "DATA:\n  - type: formula 5\n    coefficients: 1\n"
          "    range: .3 .4 .5\n",
          ":4: formula 5: range \".5\" is one too many" },
        { "DATA:\n  - type: formula 5\n    coefficients: 1\n"
          "    range: .3 - .5\n",
          ":4: formula 5: range \"-\" is not a number" },
        { "DATA:\n  - type: formula 5\n    coefficients: 1\n"
          "    range: [.3, .5]\n",
          ":4: range in DATA: expected text" },
        { FORMULA "    coefficients: 1\n  - type: formula 5\n    range: 1 2\n"
                  "    coefficients: 2\n",
          ":5: formula 5: there is n already" },
        { FORMULA "    coefficients: 1\n  - type: tabulated n\n"
                  "    data: 0.5 1.5\n",
          ":5: tabulated n: there is n already" },
        { FORMULA "    coefficients: 1\n  - type: tabulated nk\n"
                  "    data: 0.5 1.5 1\n",
          ":5: tabulated nk: there is n already" },
        { ROWS "  - type: formula 5\n    range: .3 .8\n    coefficients: 1\n",
          ":5: formula 5: there is n already" },
        { FORMULA "    coefficients: 1\n  - type: tabulated k\n"
                  "    data: 0.9 1.5\n",
          "no wavelength has both, n in [300, 800] and k in [900, 900] nm" },
        { "DATA:\n  - type: tabulated kn\n",
          ":2: unknown type \"tabulated kn\", expected tabulated nk, n or k" },
        { "DATA:\n  - type: tabulated n2\n", "no n in DATA" },
        { "DATA:\n  - type: tabulated k\n    data: 0.4 1\n", "no n in DATA" },
        { "DATA:\n  - type: tabulated n\n    data: 0.4 1\n"
          "  - type: tabulated k\n    data: 0.5 1\n",
          "no wavelength has both, n in [400, 400] and k in [500, 500] nm" },
        { ROWS "  - type: tabulated k\n    data: 0.5 1\n",
          ":5: tabulated k: there is k already" },
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

static const char small_formula[] = "DATA:\n"
                                    "- type: formula 4\n"
                                    "  range: 0.4 .7\n"
                                    "  coefficients: |\n"
                                    "    2.1 .01 0 .03 1\n"
                                    "    0 0 0 1 .1 -2\n"
                                    "- {type: tabulated k, data: .5 2}\n";

static const char small_columns[] = "# nm n k\n400,1.25,2\n6e2 , 1.5 ,3 # x\n";

static void any_byte_replaced(void **state)
{
    static const char by[] = "\t\n\r \"'#&*-:[{|>%@\\<.,9e\x80\xC2\xFF";
    static const struct {
        const char *text, *name;
    } all[] = { { small, "byte.yml" },
                { small_formula, "byte.yml" },
                { small_columns, "byte.csv" } };
    (void)state;
    for (size_t a = 0; a < sizeof all / sizeof *all; a++) {
        const size_t length = strlen(all[a].text);
        size_t loaded = 0, count = 0;
        char text[sizeof small + sizeof small_formula];
        for (size_t i = 0; i < length; i++)
            for (size_t b = 0; b < sizeof by; b++, count++) { /* and a zero */
                memcpy(text, all[a].text, length);
                text[i] = by[b];
                loaded += survives(write_bytes(all[a].name, text, length));
            }
        for (size_t n = 0; n < length; n++)
            survives(write_bytes(all[a].name, all[a].text, n));
        print_message("             %zu of %zu still make sense\n", loaded,
                      count);
        assert_true(loaded > 100 && loaded < count);
    }
}

/* -- formulas -------------------------------------------------------------- */

/* By mpmath 1.3 in 40 digits, as in pages_of_every_kind; the terms of which the
 * first coefficient is 0 were left out there. */
static void formulas_of_every_number(void **state)
{
    static const struct {
        int number;
        const char *coefficients;
        double um, n;
    } refs[] = {
        { 1, "0 0.6961663 0.0684043 0.4079426 0.1162414 0.8974794 9.896161",
          .5876, 1.4584623420532409 },
        { 1,
          ".21 .31 .13 .17 .19 .11 .23 .07 .29 .05 .31 .03 7.3 .02 8.9 .013 "
          "11.7",
          .6137, 1.416851749869959 },
        { 2,
          "0 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 "
          "103.560653",
          .5876, 1.5167984379050087 },
        { 2,
          "-.13 .41 .013 .37 .017 .31 .019 .23 .023 .17 .029 .11 .031 .07 53 "
          ".05 97",
          .4321, 1.6303359038854081 },
        { 3, "2.986556 0.01828907 -2 -0.01445419 2", .6543,
          1.7387031608710672 },
        { 3,
          "2.1 .013 -2 .0017 -4 .00019 -6 -.011 2 .0013 4 .07 .5 .019 -1.5 "
          ".003 1",
          .4567, 1.5265463834005162 },
        { 4, "2.1823 0.0125 0 0.0300 1 0 0 0 1", .532, 1.4938883586895482 },
        { 4,
          "1.9 .31 1.7 .23 1.3 .11 2.1 3.7 1.9 .013 -2 -.007 2 .0011 4 .0003 "
          "-3.3",
          .5893, 1.602137594025956 },
        { 5, "1.31984 5190.553e-6 -2 -2.56169e-4 -4 9.39388e-6 -6", .6123,
          1.3320405036730411 },
        { 5, "1.41 .0071 -2 .00013 -4 .003 .7 -.002 2 .0007 -1.1", .4861,
          1.4452615127385783 },
        { 6, "0 0.05792105 238.0185 0.00167917 57.362", .6328,
          1.0002765327380835 },
        { 6,
          ".00011 .013 131.7 .0017 57.3 .00091 77.1 .00037 91.3 .00013 211.9",
          .5461, 1.0002599705215322 },
        { 7, "3.41983 0.159906 -0.123109 1.26878E-6 -1.95104E-9", 3.39,
          3.4328560159766477 },
        { 7, "1.91 .0131 .00071 -.0123 .00037 -.000019", .7071,
          1.9348821136642801 },
        { 8, "0.452505 0.09939 0.070537 -0.000150", .55, 2.275584479878346 },
        { 9, "2.51527 0.0240 0.0300 0.020 1.52 0.8771", .6, 1.605403788031452 },
        { 1, "1.25", .5, 1.5 },
        { 2, ".25 1.5", .5, 1.6583123951776999 },
        { 3, "2.25 .5", .7, 1.6583123951776999 },
        { 4, "2.25", .7, 1.5 },
        { 4, "2.5 .5 2 .04 1", .6, 1.75 },
        { 5, "1.5", .5, 1.5 },
        { 6, ".5 1", .5, 1.25 },
        { 7, "1.5", .6, 1.5 },
        { 8, ".25", .5, 1.414213562373095 },
        { 9, "2.25", .5, 1.5 },
        { 1, "0 0 .5 1.25 .1", .5, 1.5172617880027604 },
        { 2, "0 0 .25 1.25 .01", .5, 1.5172617880027604 },
        { 4, "2.25 0 0 .5 2", .5, 1.5 },
        { 9, "2.25 0 .25 0 .5 0", .5, 1.5 },
    };
    (void)state;
    for (size_t i = 0; i < sizeof refs / sizeof *refs; i++) {
        struct ior_page *page =
            load_formula(refs[i].number, refs[i].coefficients, ".3 4");
        assert_false(ior_page_has_k(page));
        assert_int_equal(ior_page_n(page).rows, 0);
        assert_int_equal(ior_page_formula(page).number, refs[i].number);
        assert_at(page, refs[i].um * 1000, refs[i].n, 0, 4e-15);
        ior_page_free(page);
    }
}

static void formula_pages(void **state)
{
    (void)state;
    struct ior_page *page = load_text("PROPERTIES:\n"
                                      "    thermal_dispersion:\n"
                                      "      - type: formula A\n"
                                      "        coefficients: 1 2 3\n"
                                      "DATA:\n"
                                      "  - coefficients: |\n"
                                      "      1.25  .5\t-1\n"
                                      "      .001 -4\n"
                                      "    range: 0.33968 0.80001\n"
                                      "    type: formula 5\n"
                                      "  - type: tabulated k\n"
                                      "    data: |\n"
                                      "        0.4 1.5\n"
                                      "        0.9 2.5\n");
    const struct ior_formula f = ior_page_formula(page);
    double lo, hi;
    ior_page_range(page, &lo, &hi);
    assert_true(lo == 400 && hi == 800.01);
    assert_true(f.number == 5 && f.count == 5 && f.lo_nm == 339.68 &&
                f.hi_nm == 800.01);
    assert_true(f.c[0] == 1.25 && f.c[1] == .5 && f.c[2] == -1 &&
                f.c[3] == .001 && f.c[4] == -4);
    assert_int_equal(ior_page_k(page).rows, 2);
    assert_int_equal(warnings(page), 0);
    assert_at(page, 500, 2.266, 1.7, 1e-15);
    assert_not_at(page, 399.99, "399.99 nm is outside [400, 800.01] nm");
    assert_not_at(page, 800.02, "is outside [400, 800.01] nm");
    assert_not_at(page, NAN, "nan nm is outside");
    ior_page_free(page);

    page = load_formula(5, "1.5", ".5 .5"); /* one wavelength is a range */
    assert_at(page, 500, 1.5, 0, 0);
    assert_not_at(page, 501, "outside [500, 500]");
    ior_page_free(page);
}

/* As in a page of the database of which the last number was forgotten. */
static void missing_coefficients(void **state)
{
    static const struct {
        int number, count;
        bool odd;
    } refs[] = {
        { 1, 1, false },  { 1, 2, true },  { 2, 3, false },  { 3, 4, true },
        { 4, 1, false },  { 4, 4, true },  { 4, 5, false },  { 4, 8, true },
        { 4, 9, false },  { 4, 10, true }, { 4, 11, false }, { 5, 10, true },
        { 6, 11, false }, { 6, 8, true },  { 7, 4, false },  { 8, 1, false },
        { 8, 2, true },   { 8, 3, false }, { 9, 2, true },   { 9, 3, false },
        { 9, 5, true },   { 9, 6, false },
    };
    (void)state;
    for (size_t i = 0; i < sizeof refs / sizeof *refs; i++) {
        char c[100] = "";
        for (int j = 0; j < refs[i].count; j++)
            strcat(c, ".25 ");
        struct ior_page *page = load_formula(refs[i].number, c, "1 2");
        assert_int_equal(warnings(page), refs[i].odd);
        if (refs[i].odd)
            assert_warns(page, "end inside a term; those missing are taken");
        ior_page_free(page);
    }
}

static void no_n_by_a_formula(void **state)
{
    static const struct {
        int number;
        const char *coefficients, *why;
    } refs[] = {
        { 1, "-2 0 0", "formula 1 gives n^2 = -1" },
        { 1, "0 1 .5", "formula 1 gives n^2 = inf" },
        { 1, "0 1 .6", "formula 1 gives n^2 = -1.2" },
        { 2, "0 1 .25", "formula 2 gives n^2 = inf" },
        { 3, "1 1 1e9", "" },
        { 3, "1 1 -1e9", "formula 3 gives n^2 = inf" },
        { 4, "2 1 0 -.5 .5", "formula 4 gives n^2 = -nan" },
        { 4, "2 1 0 .25 1", "formula 4 gives n^2 = inf" },
        { 4, "-2", "formula 4 gives n^2 = -2" },
        { 5, "-.5", "formula 5 gives n = -0.5" },
        { 5, "1 1e300 -1e300", "formula 5 gives n = inf" },
        { 6, "0 1 4", "formula 6 gives n = inf" },
        { 6, "-3", "formula 6 gives n = -2" },
        { 7, "-1", "formula 7 gives n = -1" },
        { 7, "1 1e308 1e308 0 0 1e308", "formula 7 gives n = inf" },
        { 8, "1", "formula 8 gives n^2 = inf" },
        { 8, "2", "formula 8 gives n^2 = -5" },
        { 8, "0 1 .25", "formula 8 gives n^2 = -nan" },
        { 9, "0 0 0 1 .5 0", "formula 9 gives n^2 = -nan" },
        { 9, "-1 1 .2", "" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof refs / sizeof *refs; i++) {
        struct ior_page *page =
            load_formula(refs[i].number, refs[i].coefficients, ".3 .8");
        struct err err = { "" };
        double n, k;
        if (!*refs[i].why) {
            assert_true(ior_page_at(page, 500, &n, &k, NULL));
            assert_true(n >= 0 && n < INFINITY);
        } else {
            assert_false(ior_page_at(page, 500, &n, &k, &err));
            /* The sign of a NaN is the processor's. */
            const char *nan = strstr(refs[i].why, "-nan");
            assert_non_null(strstr(err.text, "no n at 500 nm, as formula"));
            if (nan)
                assert_says(&err, "nan there");
            else
                assert_not_at(page, 500, refs[i].why);
        }
        ior_page_free(page);
    }
}

/* -- plain columns --------------------------------------------------------- */

static void pairs_of_spectra(void **state)
{
    char path[PATH_MAX];
    (void)state;
    write_text("spd/Xx.eta.spd", "# Xx, as measured\r\n"
                                 "400 1.25\r\n"
                                 "500.5\t1.5 # in the middle\r\n"
                                 "\r\n"
                                 "  600 2.5");
    snprintf(path, sizeof path, "%s",
             write_text("spd/Xx.k.spd", "\xEF\xBB\xBF#### \xC2\xB5m \xFF\x80\n"
                                        "450 3\r650 5\r"));
    static const char *const names[] = { "spd/Xx.eta.spd", "spd/Xx.k.spd" };
    for (int i = 0; i < 2; i++) {
        struct err err = { "" };
        struct ior_page *page = ior_find(path_of(names[i]), "", &err);
        if (!page)
            fail_msg("%s", err.text);
        double lo, hi;
        ior_page_range(page, &lo, &hi);
        assert_true(lo == 450 && hi == 600);
        assert_int_equal(ior_page_n(page).rows, 3);
        assert_int_equal(ior_page_k(page).rows, 2);
        assert_int_equal(ior_page_formula(page).number, 0);
        assert_at(page, 500.5, 1.5, 3.505, 1e-15);
        assert_at(page, 550.25, 2, 4.0025, 1e-15);
        assert_not_at(page, 449, "449 nm is outside [450, 600] nm");
        assert_int_equal(warnings(page), 0);
        assert_string_equal(ior_page_path(page), path_of(names[i]));
        assert_string_equal(ior_page_reference(page), "");
        assert_string_equal(ior_page_comments(page),
                            "Xx, as measured\nin the middle\n\xC2\xB5m \?\?");
        ior_page_free(page);
    }
}

/* Writes a pair and loads it by the first of its names. */
static struct ior_page *load_pair(const char *eta, const char *k,
                                  struct err *err)
{
    char path[PATH_MAX];
    unlink(path_of("spd/p.k.spd"));
    if (k)
        write_text("spd/p.k.spd", k);
    unlink(path_of("spd/p.eta.spd"));
    if (eta)
        write_text("spd/p.eta.spd", eta);
    snprintf(path, sizeof path, "%s",
             path_of(eta ? "spd/p.eta.spd" : "spd/p.k.spd"));
    return ior_page_load(path, err);
}

static void pairs_with_faults(void **state)
{
    static const struct {
        const char *eta, *k, *why;
    } bad[] = {
        { "400 1\n", NULL, "spd/p.k.spd: no such file, and /tmp/" },
        { "400 1\n", NULL, "spd/p.eta.spd needs it" },
        { NULL, "400 1\n", "spd/p.eta.spd: no such file, and /tmp/" },
        { "", "400 1\n", "p.eta.spd: eta has no rows" },
        { "400 1\n", "# 1 2\n", "p.k.spd: k has no rows" },
        { "400 1\n# x\n500 nan\n", "400 1\n",
          "p.eta.spd:3: row 2 of eta: \"nan\" is not a number" },
        { "400 1\n", "400 1\n500 inf\n",
          "p.k.spd:2: row 2 of k: \"inf\" is not a number" },
        { "400 1 2\n", "400 1\n",
          "p.eta.spd:1: row 1 of eta: 3 values, expected wavelength and eta" },
        { "400, 1\n", "400 1\n", ":1: row 1 of eta: \"400,\"" },
        { "400\n", "400 1\n", ":1: row 1 of eta: 1 value, expected" },
        { "-400 1\n", "400 1\n",
          ":1: row 1 of eta: wavelength -400 nm, expected more than 0" },
        { "0 1\n", "400 1\n", ":1: row 1 of eta: wavelength 0 nm" },
        { "400 1\n", "500 1\n",
          "no wavelength has both, n in [400, 400] and k in [500, 500] nm" },
        { ".4 1\n.5 1\n", "400 1\n",
          "p.eta.spd: eta: wavelengths from 0.4 to 0.5 nm; expected some from "
          "50 nm on, and these may be micrometres" },
        { "400 1\n", "0.36 1\n.83 1\n",
          "p.k.spd: k: wavelengths from 0.36 to 0.83 nm" },
        { "400 1\n5\x01 1\n", "400 1\n", "p.eta.spd:2: byte 1" },
        { "400 <1>\n", "400 1\n", "\"<1>\" is not a number" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct err err = { "" };
        assert_null(load_pair(bad[i].eta, bad[i].k, &err));
        assert_says(&err, bad[i].why);
    }

    /* What is only odd is read with a warning, as it is in a .yml. */
    struct err err = { "" };
    struct ior_page *page =
        load_pair("600 2\n400 1\n500 1.5\n500 1.75\n", "400 1\n600 -1\n", &err);
    if (!page)
        fail_msg("%s", err.text);
    assert_int_equal(warnings(page), 3);
    assert_warns(page, "eta: wavelengths do not rise at 1 of 4 rows, the first "
                       "of them row 2 with 400 nm after 600 nm; sorted");
    assert_warns(page, "eta: 2 rows (3, 4) differ at 500 nm; averaged");
    assert_warns(page, "k: row 2 has a negative k = -1 at 600 nm");
    assert_at(page, 400, 1, 1, 0);
    assert_not_at(page, 500, "k is -1 at 600 nm");
    ior_page_free(page);
}

static void plain_columns(void **state)
{
    static const struct {
        const char *name, *text;
        bool k;
    } good[] = {
        { "a.txt", "400 1.25 2\n600 1.75 4\n", true },
        { "b.csv", "# nm,n,k\n400,1.25,2\n600,1.75,4\n", true },
        { "c.csv", "400, 1.25 ,\t2\r\n 600,1.75, 4 # end\r\n", true },
        { "d.dat", "\t400\t1.25\t2\t\n\n600\t1.75\t4", true },
        { "e.nk",
          "\xEF\xBB\xBF"
          "400 1.25 2\r600 1.75 4\r",
          true },
        { "f.txt", "600 1.75 4\n400 1.25 2\n", true }, /* warns */
        { "g.txt", "400 1.25\n600 1.75\n", false },
        { "h.csv", "#\n400,1.25\n600,1.75\n", false },
        { "i.csv", "4e2,1.25e0\n+600,17.5E-1\n", false },
    };
    (void)state;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        struct err err = { "" };
        struct ior_page *page =
            ior_find(write_text(good[i].name, good[i].text), "", &err);
        if (!page)
            fail_msg("%s: %s", good[i].name, err.text);
        assert_int_equal(ior_page_has_k(page), good[i].k);
        assert_at(page, 400, 1.25, good[i].k ? 2 : 0, 0);
        assert_at(page, 500, 1.5, good[i].k ? 3 : 0, 1e-15);
        assert_int_equal(warnings(page), good[i].name[0] == 'f');
        ior_page_free(page);
    }
}

static void plain_columns_with_faults(void **state)
{
    static const struct {
        const char *text, *why;
    } bad[] = {
        { "", ": the table has no rows" },
        { "# 400 1 2\n", ": the table has no rows" },
        { "nm n k\n400 1 2\n",
          ":1: row 1 of the table: \"nm\" is not a number" },
        { "400\n", ":1: row 1 of the table: 1 value, expected wavelength, n" },
        { "400 1 2 3\n", ":1: row 1 of the table: 4 values" },
        { "400 1 2\n500 1\n", ":2: row 2 of the table: 2 values, expected "
                              "wavelength, n and k" },
        { "400 1\n\n500 1 2\n", ":3: row 2 of the table: 3 values, expected "
                                "wavelength and n" },
        { "400 1,5 2,0\n", ":1: row 1 of the table: \"400 1\"" },
        { "400 1,5\n", ":1: row 1 of the table: \"400 1\" is not a number" },
        { "400;1;2\n", "\"400;1;2\" is not a number" },
        { "400,,2\n", ":1: row 1 of the table: \"\" is not a number" },
        { "400,1,2,\n", ":1: row 1 of the table: 4 values" },
        { "400,1,\n", ":1: row 1 of the table: \"\" is not a number" },
        { ",\n", "\"\" is not a number" },
        { "400 1 nan\n", "\"nan\" is not a number" },
        { "400 1 -inf\n", "\"-inf\" is not a number" },
        { "0.4 1 2\n0.8 1 2\n",
          ": the table: wavelengths from 0.4 to 0.8 nm; expected some from 50 "
          "nm on, and these may be micrometres" },
        { "; 4000 1 2\n", "\";\" is not a number" },
        { "DATA:\n", "\"DATA:\" is not a number" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_refused(write_text("bad.csv", bad[i].text), bad[i].why);
    assert_refused(write_bytes("utf16.txt",
                               "\xFF\xFE"
                               "4\0"
                               "0\0",
                               6),
                   ":1: byte 0, expected plain text");
    assert_refused(path_of("none.dat"), "No such file");
    mkdir(path_of("folder.txt"), 0700);
    assert_refused(path_of("folder.txt"), "a folder, expected a file");
    const char *path = write_text("big.dat", "400 1 2\n");
    assert_int_equal(truncate(path, (64 << 20) + 1), 0);
    assert_refused(path, "67108865 bytes, expected at most 67108864");
}

/* -- citing ---------------------------------------------------------------- */

/* How many articles are cited, after a look at whether it is BibTeX at all. */
static size_t assert_bibtex(const struct ior_page *page)
{
    static char text[8192];
    int depth = 0;
    size_t articles = 0;
    assert_true(ior_page_bibtex(page, text, sizeof text));
    for (const char *c = text; *c; c++) {
        depth += (*c == '{') - (*c == '}');
        assert_true(depth >= 0 && depth <= 4);
        if (*c == '@' && (c == text || c[-1] == '\n')) {
            assert_int_equal(depth, 0);
            articles += strncmp(c, "@article{", 9) == 0;
        }
    }
    assert_int_equal(depth, 0);
    return articles;
}

#define DATABASE                                                               \
    "\n"                                                                       \
    "@article{Polyanskiy2024,\n"                                               \
    "  author = {Polyanskiy, M. N.},\n"                                        \
    "  title = {{Refractiveindex.info database of optical constants}},\n"      \
    "  journal = {Scientific Data},\n"                                         \
    "  volume = {11},\n"                                                       \
    "  pages = {94},\n"                                                        \
    "  year = {2024},\n"                                                       \
    "  doi = {10.1038/s41597-023-02898-2},\n"                                  \
    "}\n"

static void assert_cites(const struct ior_page *page, const char *bibtex)
{
    char text[8192];
    assert_bibtex(page);
    assert_true(ior_page_bibtex(page, text, sizeof text));
    assert_string_equal(text, bibtex);
}

static void our_pages_are_cited(void **state)
{
    static const struct {
        const char *name, *key, *more;
    } ours[] = {
        { "Ag", "@article{Johnson1972,", "volume = {6}" },
        { "Al", "@article{Rakic1995,", "author = {Raki\xC4\x87, A. D.}" },
        { "Au", "@article{Johnson1972,", "pages = {4370--4379}" },
        { "BK7", "@misc{Schott2017,", "note = {SCHOTT AG, optical glass" },
        { "C", "@article{Phillip1964,", "pages = {A1445--A1448}" },
        { "Ca", "@article{Mathewson1971,", "journal = {Physica Scripta}" },
        { "Cr", "@article{Johnson1974,", "Cr, Mn, Fe, Co, Ni, and Pd}}" },
        { "Cu", "@article{Johnson1972,", "year = {1972}" },
        { "Fe", "@article{Johnson1974,", "doi = {10.1103/PhysRevB.9.5056}" },
        { "H2O", "@article{Daimon2007,", "Daimon, M. and Masumura, A." },
        { "Ni", "@article{Johnson1974,", "pages = {5056--5070}" },
        { "Pt", "@article{Tselin2024,", "pages = {195130}" },
        { "SiO2", "@article{Malitson1965,", "\n\n@article{Tan1998,\n" },
        { "Ti", "@article{Johnson1974,", "journal = {Physical Review B}" },
        { "W", "@article{Weaver1975,", "volume = {12}" },
    };
    char text[8192];
    (void)state;
    for (size_t i = 0; i < sizeof ours / sizeof *ours; i++) {
        struct ior_page *page = ior_find(ours[i].name, "", NULL);
        assert_non_null(page);
        assert_bibtex(page);
        assert_true(ior_page_bibtex(page, text, sizeof text));
        if (strncmp(text, ours[i].key, strlen(ours[i].key)) != 0)
            fail_msg("%s: %s", ours[i].name, text);
        if (!strstr(text, ours[i].more) || !strstr(text, DATABASE))
            fail_msg("%s: no %s in %s", ours[i].name, ours[i].more, text);
        ior_page_free(page);
    }
    struct ior_page *page = ior_find("Ca", "", NULL);
    assert_cites(page,
                 "@article{Mathewson1971,\n"
                 "  author = {Mathewson, A. G. and Myers, H. P.},\n"
                 "  title = {{Absolute values of the optical constants of some "
                 "pure metals}},\n"
                 "  journal = {Physica Scripta},\n"
                 "  volume = {4},\n"
                 "  pages = {291--292},\n"
                 "  year = {1971},\n"
                 "  doi = {10.1088/0031-8949/4/6/009},\n"
                 "}\n" DATABASE);
    const size_t length =
        ior_page_bibtex(page, text, sizeof text) ? strlen(text) : 0;
    for (size_t size = 0; size <= length; size++) {
        assert_false(ior_page_bibtex(page, text, size));
        assert_true(size == 0 || !*text);
    }
    assert_true(ior_page_bibtex(page, text, length + 1));
    ior_page_free(page);
}

static struct ior_page *load_reference(const char *reference)
{
    char text[2048];
    snprintf(text, sizeof text,
             "DATA: [ { type: tabulated nk, data: 0.5 1 2 } ]\n"
             "REFERENCES: |\n%s",
             reference);
    return load(write_text("My-page_2.yml", text));
}

static void references_of_many_looks(void **state)
{
    static const struct {
        const char *reference, *bibtex;
    } refs[] = {
        /* All in one line, a link with a bracket in it, a remark. */
        { "  \xC3\x96. \xC3\x85lpha-Beta, Th. de la Gamma and C Li. Of "
          "CaF<sub>2</sub>, 50% & {more}, <a href=\"https://doi.org/10.1016/"
          "S0030(99)00091-7\"><i>J. X_Y: Z</i>, <b>6B</b>, 12\xE2\x80\x93"
          "34 "
          "(1999)</a> (See ~/x^2 #3)\n",
          "@article{AlphaBeta1999,\n"
          "  author = {\xC3\x85lpha-Beta, \xC3\x96. and de la Gamma, Th. and "
          "Li, C},\n"
          "  title = {{Of CaF2, 50\\% \\& \\textbraceleft{}more"
          "\\textbraceright{}}},\n"
          "  journal = {J. X\\_Y: Z},\n"
          "  volume = {6B},\n"
          "  pages = {12--34},\n"
          "  year = {1999},\n"
          "  doi = {10.1016/S0030(99)00091-7},\n"
          "  note = {(See \\textasciitilde{}/x\\textasciicircum{}2 \\#3)},\n"
          "}\n" DATABASE },
        /* Two by the same in one year. */
        { "  1) A. Alpha et al.\n  One.\n  J. X 1, 2 (2001)\n"
          "  2) A. Alpha.\n  Two?\n  J. X 1 3-4 (2001) (http://x.y/a b.pdf)\n",
          "@article{Alpha2001,\n"
          "  author = {Alpha, A. and others},\n"
          "  title = {{One}},\n"
          "  journal = {J. X},\n"
          "  volume = {1},\n"
          "  pages = {2},\n"
          "  year = {2001},\n"
          "}\n"
          "\n"
          "@article{Alpha2001b,\n"
          "  author = {Alpha, A.},\n"
          "  title = {{Two?}},\n"
          "  journal = {J. X},\n"
          "  volume = {1},\n"
          "  pages = {3--4},\n"
          "  year = {2001},\n"
          "  url = {http://x.y/a%20b.pdf},\n"
          "}\n" DATABASE },
        /* Not to be taken apart. */
        { "  A. Alpha, private communications (2013)\n",
          "@misc{Mypage22013,\n"
          "  year = {2013},\n"
          "  note = {A. Alpha, private communications (2013)},\n"
          "}\n" DATABASE },
        { "  A. Alpha.\n  A book in 1999 parts.\n  Publisher, 2001\n",
          "@misc{Mypage21999,\n"
          "  year = {1999},\n"
          "  note = {A. Alpha. A book in 1999 parts. Publisher, 2001},\n"
          "}\n" DATABASE },
        { "  The Company, J. X 1, 2-3 (2001)\n",
          "@misc{Mypage22001,\n"
          "  year = {2001},\n"
          "  note = {The Company, J. X 1, 2-3 (2001)},\n"
          "}\n" DATABASE },
        { "  \\\\ $ { (\n",
          "@misc{Mypage2,\n"
          "  note = {\\textbackslash{} \\$ \\textbraceleft{} (},\n"
          "}\n" DATABASE },
        { "  (2001)\n", "@misc{Mypage22001,\n"
                        "  year = {2001},\n"
                        "  note = {(2001)},\n"
                        "}\n" DATABASE },
        { "  x\n", "@misc{Mypage2,\n"
                   "  note = {x},\n"
                   "}\n" DATABASE },
        { "\n", "@misc{Mypage2,\n"
                "  title = {{My-page\\_2}},\n"
                "}\n" DATABASE },
    };
    (void)state;
    for (size_t i = 0; i < sizeof refs / sizeof *refs; i++) {
        struct ior_page *page = load_reference(refs[i].reference);
        assert_cites(page, refs[i].bibtex);
        ior_page_free(page);
    }
    struct ior_page *page =
        load(write_text("Xx.txt", "# of 100% Xx\n400 1 2\n"));
    assert_cites(page, "@misc{Xx,\n"
                       "  title = {{Xx}},\n"
                       "  note = {of 100\\% Xx},\n"
                       "}\n");
    ior_page_free(page);
}

/* Whatever is cut off or put in the place of a byte, what comes out is BibTeX.
 */
static void any_reference_is_cited(void **state)
{
    static const char whole[] =
        "  1) A. Alpha, Th. Beta, and C. Gamma.\n  Of 1999 X.\n"
        "  J. X 1, 2-3 (2001) (https://doi.org/10.1/x(1)2)\n"
        "  2) D. Delta. Y, Z 4, 5, 1888, doi:10.2/y\n";
    static const char by[] = "\n .,(){})0A\\-";
    char text[sizeof whole];
    size_t count = 0;
    (void)state;
    for (size_t i = 0; i + 1 < sizeof whole; i++)
        for (size_t b = 0; b < sizeof by; b++) {
            memcpy(text, whole, sizeof whole);
            text[i] = by[b]; /* a zero cuts off */
            char page_text[sizeof whole + 100];
            snprintf(page_text, sizeof page_text,
                     "DATA: [ { type: tabulated nk, data: 0.5 1 2 } ]\n"
                     "REFERENCES: |\n%s",
                     text);
            struct ior_page *page =
                ior_page_load(write_text("any.yml", page_text), NULL);
            if (!page) /* the byte was for YAML */
                continue;
            assert_true(assert_bibtex(page) >= 1);
            ior_page_free(page);
            count++;
        }
    assert_true(count > 1000);
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
        { "Tu", "no optical constants of \"Tu\"" },
        { "BK8", "(did you mean BK7?), only of Ag, Al, Au, BK7, C, Ca, Cr" },
        { "CA", "(did you mean Ca?)" },
        { "unobtainium", "only of Ag, Al, Au, BK7, C, Ca, Cr, Cu, Fe, H2O" },
        { "Ca/Matheson", "no page \"Matheson\" of Ca" },
        { "Ca/Matheson", "(did you mean Mathewson?), only Mathewson" },
        { "Ca/mathewson", "(did you mean Mathewson?)" },
        { "Ca/Johnson and Christy", "only Mathewson" },
        { ".yml", "expected MATERIAL" },
        { ".spd", "expected MATERIAL" },
        { "Ca.spd", "expected a name that ends in .eta.spd or .k.spd" },
        { "Ca.eta.spd", "Ca.eta.spd: No such file" },
        { "Ca.TXT", "no optical constants of \"Ca.TXT\"" },
        { "Ca.txt", "Ca.txt: No such file" },
        { "Ca/Ca.nk", "Ca/Ca.nk: No such file" },
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
    char names[400] = "";
    struct err err = { "" };
    (void)state;
    if (!ior_list(add_name, names, &err))
        fail_msg("%s", err.text);
    assert_string_equal(names,
                        "Ag/Johnson Al/Rakic Au/Johnson BK7/Schott C/Phillip "
                        "Ca/Mathewson Cr/Johnson Cu/Johnson Fe/Johnson "
                        "H2O/Daimon-20.0C Ni/Johnson Pt/Tselin SiO2/Malitson "
                        "Ti/Johnson W/Weaver ");
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

static size_t loaded, refused, odd, formulas, entries;

static int read_page(const char *path, const struct stat *s, int type,
                     struct FTW *at)
{
    (void)s;
    const char *name = path + at->base;
    if (type != FTW_F || !strstr(name, ".yml") || strstr(name, "about.yml"))
        return 0;
    struct err err = { "" };
    struct ior_page *page = ior_page_load(path, &err);
    if (!page) {
        refused++;
        print_message("             %s\n", err.text);
        assert_says(&err, path);
        assert_says(&err, "row ");
        return 0;
    }
    loaded++;
    odd += ior_page_warnings(page)[0] != NULL;
    for (const char *const *w = ior_page_warnings(page); *w; w++)
        print_message("             %s: %s\n", name, *w);
    assert_null(strpbrk(ior_page_reference(page), "<>"));
    entries += assert_bibtex(page);
    formulas += ior_page_formula(page).number > 0;
    double lo, hi, n, k;
    ior_page_range(page, &lo, &hi);
    if (ior_page_at(page, (lo + hi) / 2, &n, &k, &err))
        assert_true(n > 0 && n < 1e4 && k >= 0 && k < 1e4);
    else
        assert_says(&err, "should not be negative");
    if (!strstr(path, "/nk/")) {
        ior_page_free(page);
        return 0;
    }

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
    loaded = refused = odd = formulas = entries = 0;
    assert_int_equal(nftw(database(), read_page, 16, FTW_PHYS), 0);
    print_message("             loaded %zu, %zu of them with warnings and %zu "
                  "with formulas, citing %zu articles; refused %zu\n",
                  loaded, odd, formulas, entries, refused);
    assert_true(loaded > 200 && formulas > 10 && entries > loaded);
}

/* What n and k are at a wavelength, by mpmath 1.3 in 40 digits from the text of
 * the page; the formulas are written there as sums over b / (1 - (c / l)^2) and
 * the like, and rows are joined in the micrometres that they are given in. */
static void pages_of_every_kind(void **state)
{
    static const struct {
        const char *path;
        double nm, n, k;
    } pages[] = {
        { "main/SiO2/nk/Malitson.yml", 587.6, 1.4584623420532409, 0.0 },
        { "main/C/nk/Peter.yml", 441.3, 2.4481323206790016, 0.0 },
        { "specs/schott/optical/N-BK7.yml", 532.1, 1.5194670463408448,
          7.7551689130434783e-9 },
        { "main/H2O/nk/Daimon-20.0C.yml", 633.3, 1.332092753270554, 0.0 },
        { "main/BeAl6O10/nk/Pestryakov-alpha.yml", 1017, 1.7289560250598647,
          0.0 },
        { "organic/CH4N2O - urea/nk/Rosker-o.yml", 355.7, 1.5204616065723703,
          0.0 },
        { "main/H2O/nk/Bashkatov.yml", 489.1, 1.3377476706586902, 0.0 },
        { "organic/C8H8O3 - methyl salicylate/nk/Rheims.yml", 613.7,
          1.5319688957295304, 0.0 },
        { "other/mixed gases/air/nk/Ciddor.yml", 549.3, 1.0002778513453367,
          0.0 },
        { "main/Si/nk/Edwards.yml", 10590, 3.4213641622882062, 0.0 },
        { "main/AgBr/nk/Schroter.yml", 571.9, 2.2646955489251273, 0.0 },
        { "organic/CH4N2O - urea/nk/Rosker-e.yml", 777.7, 1.5958154136985813,
          0.0 },
        { "main/SiO2/nk/Ghosh-e.yml", 466.1, 1.5604820317100605, 0.0 },
        { "main/Au/nk/Johnson.yml", 613.9, 0.21668587896253602,
          3.2378184438040346 },
        { "main/H2O/nk/Hale.yml", 701.7, 1.330932, 3.7444e-8 },
        { "main/W/nk/Weaver.yml", 549.9, 3.5220925925925926,
          2.7412222222222222 },
        { "main/Pt/nk/Tselin.yml", 465.7, 1.698012077294686,
          3.8795392512077295 },
        { "main/K/nk/Sutherland.yml", 211.1, 0.8427319587628866, 0 },
    };
    char path[PATH_MAX];
    (void)state;
    for (size_t i = 0; i < sizeof pages / sizeof *pages; i++) {
        snprintf(path, sizeof path, "%s/database/data/%s", database(),
                 pages[i].path);
        struct ior_page *page = load(path);
        assert_at(page, pages[i].nm, pages[i].n, pages[i].k, 1e-12);
        ior_page_free(page);
    }
}

static void same_column(struct ior_table a, struct ior_table b)
{
    assert_int_equal(a.rows, b.rows);
    if (!a.rows)
        return;
    assert_memory_equal(a.nm, b.nm, a.rows * sizeof *a.nm);
    assert_memory_equal(a.value, b.value, a.rows * sizeof *a.value);
}

static void our_tables_are_the_databases(void **state)
{
    static const struct {
        const char *name, *path; /* NULL where the name is the same there */
        size_t n, k, c;          /* how many of each */
    } ours[] = {
        { "Ag/Johnson", NULL, 49, 49, 0 },
        { "Al/Rakic", NULL, 206, 206, 0 },
        { "Au/Johnson", NULL, 49, 49, 0 },
        { "BK7/Schott", "specs/schott/optical/N-BK7.yml", 0, 25, 7 },
        { "C/Phillip", NULL, 176, 176, 0 },
        { "Ca/Mathewson", NULL, 59, 59, 0 },
        { "Cr/Johnson", NULL, 49, 49, 0 },
        { "Cu/Johnson", NULL, 49, 49, 0 },
        { "Fe/Johnson", NULL, 49, 49, 0 },
        { "H2O/Daimon-20.0C", NULL, 0, 0, 9 },
        { "Ni/Johnson", NULL, 49, 49, 0 },
        { "Pt/Tselin", NULL, 2000, 2000, 0 },
        { "SiO2/Malitson", NULL, 0, 0, 7 },
        { "Ti/Johnson", NULL, 49, 49, 0 },
        { "W/Weaver", NULL, 383, 383, 0 },
    };
    (void)state;
    for (size_t i = 0; i < sizeof ours / sizeof *ours; i++) {
        char path[PATH_MAX];
        snprintf(path, sizeof path, "%s/database/data/%s", database(),
                 ours[i].path ? ours[i].path : "");
        struct ior_page *a = ior_find(ours[i].name, "", NULL);
        struct ior_page *b = ours[i].path
                                 ? load(path)
                                 : ior_find(ours[i].name, database(), NULL);
        assert_non_null(a);
        assert_non_null(b);
        assert_string_not_equal(ior_page_path(a), ior_page_path(b));
        const struct ior_formula f = ior_page_formula(a),
                                 g = ior_page_formula(b);
        assert_int_equal(ior_page_n(a).rows, ours[i].n);
        assert_int_equal(ior_page_k(a).rows, ours[i].k);
        assert_int_equal(f.count, ours[i].c);
        same_column(ior_page_n(a), ior_page_n(b));
        same_column(ior_page_k(a), ior_page_k(b));
        assert_int_equal(f.number, g.number);
        assert_int_equal(f.count, g.count);
        assert_memory_equal(f.c, g.c, f.count * sizeof *f.c);
        assert_true(f.lo_nm == g.lo_nm && f.hi_nm == g.hi_nm);
        assert_int_equal(warnings(a), 0);
        ior_page_free(a);
        ior_page_free(b);
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
        { .name = "formulas 1 to 9 agree with 40 digits",
          .test_func = formulas_of_every_number },
        { .name = "a formula may have k beside it",
          .test_func = formula_pages },
        { .name = "coefficients that end inside a term are 0 with a warning",
          .test_func = missing_coefficients },
        { .name = "what is no index is refused by formula and wavelength",
          .test_func = no_n_by_a_formula },
        { .name = "a pair of .spd files is a page",
          .test_func = pairs_of_spectra },
        { .name = "a pair with a fault is refused, or read with a warning",
          .test_func = pairs_with_faults },
        { .name = "columns of plain text are a page",
          .test_func = plain_columns },
        { .name = "columns of anything else are refused",
          .test_func = plain_columns_with_faults },
        { .name = "our pages are cited", .test_func = our_pages_are_cited },
        { .name = "references of many looks become BibTeX or a note",
          .test_func = references_of_many_looks },
        { .name = "a reference with any byte replaced does no harm",
          .test_func = any_reference_is_cited },
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
        { .name = "pages of every kind agree with 40 digits",
          .test_func = pages_of_every_kind },
        { .name = "our tables are the database's, row for row",
          .test_func = our_tables_are_the_databases },
    };
    return cmocka_run_group_tests_name("ior", tests, make_folder,
                                       remove_folder);
}
