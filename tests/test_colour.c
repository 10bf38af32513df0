/* test_colour.c - from optical constants to colours, and back
 *
 * Where $BSDF_SHARED (../shared if unset) has a copy of part of the
 * refractiveindex.info database and colours computed from it by other code,
 * these are compared as well.
 */
#include "bsdf/colour.h"
#include "bsdf/fresnel.h"
#include "tests/close.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static struct cie cie;
static char folder[] = "/tmp/test_colour.XXXXXX"; /* of all that is written */

static const char *path_of(const char *name)
{
    static char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

/* In $BSDF_SHARED; NULL if it is not there. */
static const char *shared_path(const char *name)
{
    static char path[PATH_MAX];
    const char *shared = getenv("BSDF_SHARED");
    snprintf(path, sizeof path, "%s/%s", shared ? shared : "../shared", name);
    return access(path, R_OK) == 0 ? path : NULL;
}

static struct ior_page *find(const char *name, const char *ior_path)
{
    struct err err = { "" };
    struct ior_page *page = ior_find(name, ior_path, &err);
    if (!page)
        fail_msg("%s", err.text);
    return page;
}

/* A page with these rows "um n k". */
static struct ior_page *page_of(const char *rows)
{
    const char *path = path_of("page.yml");
    struct err err = { "" };
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "DATA:\n  - type: tabulated nk\n    data: |\n%s", rows);
    assert_int_equal(fclose(f), 0);
    struct ior_page *page = ior_page_load(path, &err);
    if (!page)
        fail_msg("%s", err.text);
    return page;
}

struct outcome {
    struct spectrum eta, k;
    struct colour_report report;
};

static struct outcome conduct(const struct ior_page *page,
                              enum colour_method method,
                              const struct bands *bands)
{
    struct outcome o;
    struct err err = { "" };
    if (!colour_conductor(&cie, page, method, bands, &o.eta, &o.k, &o.report,
                          &err))
        fail_msg("%s", err.text);
    return o;
}

static void assert_spectrum(struct spectrum got, double r, double g, double b,
                            double limit)
{
    assert_close(got.band[0], r, limit);
    assert_close(got.band[1], g, limit);
    assert_close(got.band[2], b, limit);
}

/* -- colour spaces --------------------------------------------------------- */

/* The tables give x = .312727, y = .329023, which in linear sRGB, made for a
 * white of (.3127, .3290), is 1.00016, .99998, .99976. */
static void daylight_is_white(void **state)
{
    (void)state;
    const struct xyz white = colour_white(&cie);
    const double sum = white.x + white.y + white.z;
    assert_close(white.x / sum, 0.312727, 1e-6);
    assert_close(white.y / sum, 0.329023, 1e-6);
    assert_spectrum(colour_rgb(white), 1, 1, 1, 1e-3);
    assert_spectrum(colour_rgb(white), 1.00016, 0.99998, 0.99976, 1e-5);
    const struct lab lab = colour_lab(white, white);
    assert_close(lab.l, 100, 1e-12);
    assert_close(lab.a, 0, 1e-12);
    assert_close(lab.b, 0, 1e-12);
}

/* The sums that come with the functions in CIE 018: equal energy is white to
 * a few 1e-4. */
static void functions_sum_up(void **state)
{
    (void)state;
    static const double sums[] = { 106.865469, 106.856917, 106.892251 };
    for (int c = 0; c < 3; c++) {
        double sum = 0;
        for (int row = 0; row < CIE_ROWS; row++)
            sum += cie.bar[row][c];
        assert_close(sum, sums[c], 1e-6);
    }
    assert_close(cie.d65[560 - CIE_LO_NM], 100, 0);
}

/* IEC 61966-2-1 prints the matrix to four decimals. */
static void srgb_is_that_of_the_standard(void **state)
{
    (void)state;
    static const double printed[3][3] = { { 0.4124, 0.3576, 0.1805 },
                                          { 0.2126, 0.7152, 0.0722 },
                                          { 0.0193, 0.1192, 0.9505 } };
    for (int c = 0; c < 3; c++) {
        struct spectrum primary = { { 0 } };
        primary.band[c] = 1;
        const struct xyz xyz = colour_xyz(primary);
        assert_close(xyz.x, printed[0][c], 6e-5);
        assert_close(xyz.y, printed[1][c], 6e-5);
        assert_close(xyz.z, printed[2][c], 6e-5);
    }
    const struct spectrum beyond = { { 1.0376, 0.7284, -0.0346 } };
    assert_spectrum(colour_rgb(colour_xyz(beyond)), 1.0376, 0.7284, -0.0346,
                    1e-14);
}

/* bc -l, 40 digits: 1.055*e(l(v)/2.4)-0.055 */
static void srgb_encodes(void **state)
{
    (void)state;
    assert_close(colour_srgb_encode(0.18), 0.46135612950044164, 1e-15);
    assert_close(colour_srgb_encode(0.9), 0.95468717188586623, 1e-15);
    assert_close(colour_srgb_encode(0.00237), 12.92 * 0.00237, 1e-17);
    assert_close(colour_srgb_encode(-0.3), 0, 0);
    assert_close(colour_srgb_encode(1.0376), 1, 1e-15);
}

/* CIE 15: L* is 116 cbrt(Y) - 16 above Y = (6/29)^3, where it is 8. */
static void lab_is_a_cube_root_and_its_tangent(void **state)
{
    (void)state;
    const struct xyz white = { 0.9505, 1, 1.0888 };
    const double y50 = pow(66.0 / 116, 3), y8 = pow(6.0 / 29, 3);
    assert_close(colour_lab((struct xyz){ 0.3, y50, 0.4 }, white).l, 50, 1e-12);
    assert_close(colour_lab((struct xyz){ 0.3, y8, 0.4 }, white).l, 8, 1e-12);
    assert_close(colour_lab((struct xyz){ 0.3, y8 / 3, 0.4 }, white).l, 8. / 3,
                 1e-12);
    const struct lab lab = colour_lab((struct xyz){ 0.31, 0.27, 0.19 }, white);
    assert_close(lab.a, 500 * (cbrt(0.31 / 0.9505) - cbrt(0.27)), 1e-12);
    assert_close(lab.b, 200 * (cbrt(0.27) - cbrt(0.19 / 1.0888)), 1e-12);
}

/* Sharma, Wu and Dalal 2005, table 1, all of it: two colours, CIEDE2000. */
static void ciede2000_agrees_with_table_1(void **state)
{
    (void)state;
    static const double table[34][7] = {
        { 50, 2.6772, -79.7751, 50, 0, -82.7485, 2.0425 },
        { 50, 3.1571, -77.2803, 50, 0, -82.7485, 2.8615 },
        { 50, 2.8361, -74.02, 50, 0, -82.7485, 3.4412 },
        { 50, -1.3802, -84.2814, 50, 0, -82.7485, 1 },
        { 50, -1.1848, -84.8006, 50, 0, -82.7485, 1 },
        { 50, -0.9009, -85.5211, 50, 0, -82.7485, 1 },
        { 50, 0, 0, 50, -1, 2, 2.3669 },
        { 50, -1, 2, 50, 0, 0, 2.3669 },
        { 50, 2.49, -0.001, 50, -2.49, 0.0009, 7.1792 },
        { 50, 2.49, -0.001, 50, -2.49, 0.001, 7.1792 },
        { 50, 2.49, -0.001, 50, -2.49, 0.0011, 7.2195 },
        { 50, 2.49, -0.001, 50, -2.49, 0.0012, 7.2195 },
        { 50, -0.001, 2.49, 50, 0.0009, -2.49, 4.8045 },
        { 50, -0.001, 2.49, 50, 0.001, -2.49, 4.8045 },
        { 50, -0.001, 2.49, 50, 0.0011, -2.49, 4.7461 },
        { 50, 2.5, 0, 50, 0, -2.5, 4.3065 },
        { 50, 2.5, 0, 73, 25, -18, 27.1492 },
        { 50, 2.5, 0, 61, -5, 29, 22.8977 },
        { 50, 2.5, 0, 56, -27, -3, 31.903 },
        { 50, 2.5, 0, 58, 24, 15, 19.4535 },
        { 50, 2.5, 0, 50, 3.1736, 0.5854, 1 },
        { 50, 2.5, 0, 50, 3.2972, 0, 1 },
        { 50, 2.5, 0, 50, 1.8634, 0.5757, 1 },
        { 50, 2.5, 0, 50, 3.2592, 0.335, 1 },
        { 60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644 },
        { 63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.263 },
        { 61.2901, 3.7196, -5.3901, 61.4292, 2.248, -4.962, 1.8731 },
        { 35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645 },
        { 22.7233, 20.0904, -46.694, 23.0331, 14.973, -42.5619, 2.0373 },
        { 36.4612, 47.858, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146 },
        { 90.8027, -2.0831, 1.441, 91.1528, -1.6435, 0.0447, 1.4441 },
        { 90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381 },
        { 6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377 },
        { 2.0776, 0.0795, -1.135, 0.9033, -0.0636, -0.5514, 0.9082 },
    };
    for (int i = 0; i < 34; i++) {
        const double *t = table[i];
        const struct lab p = { t[0], t[1], t[2] }, q = { t[3], t[4], t[5] };
        assert_close(colour_ciede2000(p, q), t[6], 1e-4);
        assert_close(colour_ciede2000(q, p), t[6], 1e-4);
        assert_close(colour_ciede2000(p, p), 0, 0);
    }
}

/* -- tables ---------------------------------------------------------------- */

/* The good table with one line of it replaced; line 0 for none, and all of it
 * up to but not with the line where that is cut. */
static const char *spoilt(int line, const char *text, bool cut)
{
    static char path[PATH_MAX];
    char from[PATH_MAX], buffer[512];
    snprintf(path, sizeof path, "%s/spoilt.tsv", folder);
    snprintf(from, sizeof from, "%s/cie/cie1931_d65.tsv", data_folder());
    FILE *in = fopen(from, "r"), *out = fopen(path, "w");
    assert_non_null(in);
    assert_non_null(out);
    for (int i = 1; fgets(buffer, sizeof buffer, in) && !(cut && i == line);
         i++)
        fputs(i == line ? text : buffer, out);
    if (line < 0)
        fputs(text, out);
    fclose(in);
    assert_int_equal(fclose(out), 0);
    return path;
}

static void bad_tables_are_refused(void **state)
{
    (void)state;
    static const struct {
        int line; /* the first row, 360 nm, is line 18; -1 appends */
        const char *text;
        bool cut;
        const char *says;
    } bad[] = {
        { 18, "360 0.0001 0.000004 0.0006\n", false,
          "spoilt.tsv:18: expected D65 as a number" },
        { 18, "360 0.0001 0.000004 0.0006 46.6 7\n", false,
          "spoilt.tsv:18: more than the five" },
        { 19, "361,0.0001,0.000004,0.0006,46.6\n", false,
          "spoilt.tsv:19: expected the wavelength" },
        { 19, "361 0.0001 0.00_0004 0.0006 46.6\n", false,
          "spoilt.tsv:19: expected ybar" },
        { 20, "362 0.0001 -0.000004 0.0006 46.6\n", false, "ybar = -4e-06" },
        { 20, "362 nan 0.000004 0.0006 46.6\n", false, "xbar = nan" },
        { 20, "362 0.0001 0.000004 inf 46.6\n", false, "zbar = inf" },
        { 21, "", false, "spoilt.tsv:21: wavelength 364 nm; expected 363" },
        { 21, "363.5 0.1 0.1 0.1 46.6\n", false, "wavelength 363.5 nm" },
        { 488, "", true, "spoilt.tsv:487: ends after 470 rows" },
        { 1, "", true, "spoilt.tsv:0: ends after 0 rows" },
        { -1, "831 0.1 0.1 0.1 46.6\n", false, "after that for 830 nm" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct cie read;
        struct err err = { "" };
        assert_false(cie_load_file(
            &read, spoilt(bad[i].line, bad[i].text, bad[i].cut), &err));
        assert_has(err.text, bad[i].says);
    }
}

static void long_lines_and_folders_are_no_tables(void **state)
{
    (void)state;
    struct cie read;
    struct err err = { "" };
    char longer[300];
    memset(longer, '7', sizeof longer - 1);
    longer[sizeof longer - 1] = '\0';
    assert_false(cie_load_file(&read, spoilt(5, longer, false), &err));
    assert_has(err.text, "spoilt.tsv:5: expected a line of text");
    assert_false(cie_load_file(&read, folder, &err));
    assert_has(err.text, folder);
    assert_false(cie_load_file(&read, path_of("none.tsv"), &err));
    assert_has(err.text, "none.tsv: No such file");
}

static void dark_tables_are_refused(void **state)
{
    (void)state;
    const char *path = path_of("dark.tsv");
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    for (int nm = CIE_LO_NM; nm <= CIE_HI_NM; nm++)
        fprintf(f, "%d 0.5 0 0.5 100\n", nm);
    assert_int_equal(fclose(f), 0);
    struct cie read;
    struct err err = { "" };
    assert_false(cie_load_file(&read, path, &err));
    assert_has(err.text, "ybar times D65 sums up to 0");
}

static void a_missing_table_is_named(void **state)
{
    (void)state;
    struct cie read;
    struct err err = { "" };
    char *data = getenv("BSDF_DATA");
    char *saved = data ? strdup(data) : NULL;
    setenv("BSDF_DATA", folder, 1);
    const bool good = cie_load(&read, &err);
    if (saved)
        setenv("BSDF_DATA", saved, 1);
    else
        unsetenv("BSDF_DATA");
    free(saved);
    assert_false(good);
    assert_has(err.text, folder);
    assert_has(err.text, "/cie/cie1931_d65.tsv: No such file");
    assert_has(err.text, "BSDF_DATA");
}

static void a_last_line_needs_no_end(void **state)
{
    (void)state;
    struct cie read;
    struct err err = { "" };
    assert_true(cie_load_file(&read, spoilt(0, "", false), &err));
    assert_memory_equal(&read, &cie, sizeof cie);
    assert_true(cie_load_file(
        &read, spoilt(488, "830\t1e-6\t4e-7\t0\t60.3", false), &err));
    assert_close(read.d65[CIE_ROWS - 1], 60.3, 0);
}

/* -- a metal, wavelength by wavelength ------------------------------------- */

/* One n and k at every wavelength: the reflectance is Fresnel's, as grey as
 * the white of the tables. */
static const char *const grey = "      0.20 0.7123 3.217\n"
                                "      0.95 0.7123 3.217\n";

static void a_grey_metal_is_fresnels(void **state)
{
    (void)state;
    struct ior_page *page = page_of(grey);
    struct colour_metal metal;
    assert_true(colour_metal_init(&metal, &cie, page, NULL));
    assert_close(metal.covered, 1, 0);
    const struct spectrum white = colour_rgb(colour_white(&cie));
    for (int i = 0; i <= 7; i++) {
        const double f = fresnel_conductor(i / 7., 0.7123, 3.217);
        const struct spectrum rgb = colour_metal_rgb(&metal, i / 7.);
        for (int b = 0; b < 3; b++)
            assert_close(rgb.band[b], f * white.band[b], 1e-13);
    }
    ior_page_free(page);
}

static void pages_that_miss_little_are_held(void **state)
{
    (void)state;
    struct ior_page *page = page_of("      0.45 0.6 3\n      0.70 0.4 4\n");
    const struct outcome o = conduct(page, COLOUR_FIT, NULL);
    assert_has(o.report.warnings, "page.yml: has 450 to 700 nm");
    assert_has(o.report.warnings, "held for the other");
    /* Z has the least there; its share below 450 nm */
    double below = 0, all = 0;
    for (int row = 0; row < CIE_ROWS; row++) {
        const double z = cie.d65[row] * cie.bar[row][2];
        below += CIE_LO_NM + row < 450 ? z : 0;
        all += z;
    }
    assert_close(o.report.covered, 1 - below / all, 1e-6);
    struct colour_metal metal;
    assert_true(colour_metal_init(&metal, &cie, page, NULL));
    assert_close(metal.n[0], 0.6, 0);
    assert_close(metal.k[CIE_ROWS - 1], 4, 0);
    assert_close(metal.n[575 - CIE_LO_NM], 0.5, 1e-15);
    assert_close(metal.lo_nm, 450, 1e-10);
    assert_close(metal.hi_nm, 700, 1e-10);
    ior_page_free(page);

    page = page_of("      0.37 0.6 3\n      0.80 0.4 4\n");
    assert_string_equal(conduct(page, COLOUR_FIT, NULL).report.warnings, "");
    ior_page_free(page);
}

static void assert_refused(const char *rows, enum colour_method method,
                           const struct bands *bands, const char *says)
{
    struct ior_page *page = page_of(rows);
    struct spectrum eta = { { 7, 7, 7 } }, k = eta;
    struct colour_report report;
    struct err err = { "" };
    assert_false(
        colour_conductor(&cie, page, method, bands, &eta, &k, &report, &err));
    assert_has(err.text, says);
    assert_spectrum(eta, 7, 7, 7, 0);
    assert_spectrum(k, 7, 7, 7, 0);
    ior_page_free(page);
}

static void pages_that_miss_much_are_refused(void **state)
{
    (void)state;
    assert_refused("      0.50 0.6 3\n      0.80 0.4 4\n", COLOUR_AVERAGE, NULL,
                   "has 500 to 800 nm");
    assert_refused("      0.55 0.6 3\n", COLOUR_FIT, NULL, "at least half");
    assert_refused("      0.36 0.6 3\n      0.55 -0.1 4\n      0.83 0.4 4\n",
                   COLOUR_FIT, NULL, "page.yml");
    assert_refused("      0.45 0.6 3\n      0.83 0.4 4\n", COLOUR_FIXED,
                   &(struct bands){ 3, { 630, 532, 440 } }, "440");
    assert_refused("      0.35 0.6 3\n      0.83 0.4 4\n", COLOUR_FIXED,
                   &(struct bands){ 1, { 630 } }, "expected three");
}

/* Three wavelengths need no more of a page if nobody asks how good they are. */
static void fixed_without_a_report_needs_three_wavelengths(void **state)
{
    (void)state;
    struct ior_page *page = page_of("      0.50 0.6 3\n      0.70 0.4 4\n");
    const struct bands bands = { 3, { 600, 550, 500 } };
    struct spectrum eta, k;
    assert_true(colour_conductor(&cie, page, COLOUR_FIXED, &bands, &eta, &k,
                                 NULL, NULL));
    assert_spectrum(eta, 0.5, 0.55, 0.6, 1e-12);
    assert_spectrum(k, 3.5, 3.25, 3, 1e-12);
    ior_page_free(page);
}

static void methods_have_names(void **state)
{
    (void)state;
    enum colour_method method = COLOUR_FIXED;
    struct err err = { "" };
    assert_true(colour_method_parse(&method, "fit", &err));
    assert_int_equal(method, COLOUR_FIT);
    assert_string_equal(colour_method_names[COLOUR_AVERAGE], "average");
    assert_false(colour_method_parse(&method, "best", &err));
    assert_has(err.text, "\"best\": expected fixed, average or fit");
}

/* -- against other code ---------------------------------------------------- */

struct row {
    char material[16], page[64], method[64];
    struct spectrum f0, f82;
};

/* "Ca,Ca/nk/Mathewson,sample_650_550_450,eta,eta,eta,k,k,k,F0 ...,F82 ...",
 * where the eta and k of spectral_D65 are empty. */
static bool read_row(struct row *row, const char *line)
{
    *row = (struct row){ "" };
    if (sscanf(line, "%15[^,],%63[^,],%63[^,]", row->material, row->page,
               row->method) != 3)
        return false;
    double *to[] = { row->f0.band, row->f82.band };
    int comma = 0;
    for (const char *at = line; *at; at++)
        if (*at == ',' && ++comma > 8 && comma < 15)
            to[(comma - 9) / 3][(comma - 9) % 3] = atof(at + 1);
    return comma == 14;
}

static void compare_row(const struct row *row, const struct ior_page *page)
{
    /* That code takes the white of the tables for its white; see above. */
    const double limit = 2e-3;
    struct bands bands = { .count = 3 };
    struct outcome o;
    if (strcmp(row->method, "spectral_D65") == 0) {
        struct colour_metal metal;
        assert_true(colour_metal_init(&metal, &cie, page, NULL));
        const struct spectrum f0 = colour_metal_rgb(&metal, 1);
        const struct spectrum f82 = colour_metal_rgb(&metal, 1. / 7);
        for (int b = 0; b < 3; b++) {
            assert_close(f0.band[b], row->f0.band[b], limit);
            assert_close(f82.band[b], row->f82.band[b], limit);
        }
        return;
    }
    if (strcmp(row->method, "cmf_avg_eta_k") == 0) {
        o = conduct(page, COLOUR_AVERAGE, NULL);
    } else {
        assert_int_equal(sscanf(row->method, "sample_%lf_%lf_%lf", &bands.nm[0],
                                &bands.nm[1], &bands.nm[2]),
                         3);
        o = conduct(page, COLOUR_FIXED, &bands);
    }
    for (int b = 0; b < 3; b++) {
        assert_close(o.report.f0.band[b], row->f0.band[b], limit);
        assert_close(fresnel_conductor(1. / 7, o.eta.band[b], o.k.band[b]),
                     row->f82.band[b], limit);
    }
}

static void colours_agree_with_other_code(void **state)
{
    (void)state;
    char database[PATH_MAX], line[512], name[80];
    const char *path = shared_path("data/refractiveindex");
    snprintf(database, sizeof database, "%s", path ? path : "");
    path = shared_path("data/derived/metal_rgb_methods.csv");
    FILE *f = path ? fopen(path, "r") : NULL;
    if (!f || !*database) {
        print_message("             skipped: no derived colours\n");
        skip();
    }
    int rows = 0;
    while (fgets(line, sizeof line, f)) {
        struct row row;
        if (line[0] == '#' || !read_row(&row, line) ||
            strcmp(row.material, "material") == 0)
            continue;
        snprintf(name, sizeof name, "%s%s", row.material,
                 strrchr(row.page, '/'));
        struct ior_page *page = find(name, database);
        compare_row(&row, page);
        ior_page_free(page);
        rows++;
    }
    fclose(f);
    assert_in_range(rows, 30, 100);
}

/* CIEDE2000 between F0 of three pairs and that of the spectrum, computed by
 * other code to one digit after the point. */
static void calcium_gold_and_copper_are_off_by_so_much(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        enum colour_method method;
        struct bands bands;
        double ciede2000;
    } known[] = {
        { "Ca", COLOUR_FIXED, { 3, { 650, 550, 450 } }, 0.5 },
        { "Ca", COLOUR_FIXED, { 3, { 614, 549, 466 } }, 1.5 },
        { "Ca", COLOUR_AVERAGE, { 0 }, 1.0 },
        { "Au", COLOUR_FIXED, { 3, { 614, 549, 466 } }, 6.4 },
        { "Cu", COLOUR_FIXED, { 3, { 614, 549, 466 } }, 2.1 },
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        struct ior_page *page = find(known[i].name, "");
        const struct outcome o =
            conduct(page, known[i].method, &known[i].bands);
        assert_close(o.report.ciede2000, known[i].ciede2000, 0.1);
        assert_string_equal(o.report.warnings, "");
        ior_page_free(page);
    }
}

/* -- the fit --------------------------------------------------------------- */

/* Stated: what was found, rounded up.  The red of copper comes from either side
 * of an edge of its absorption, and no one pair follows that as well. */
static void the_fit_follows_the_spectrum(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        struct spectrum worst; /* over angle; NAN where out of gamut */
    } metals[] = {
        { "Ca", { { 8e-4, 3e-4, 3e-4 } } },
        { "Cu", { { 5e-3, 5e-4, 5e-4 } } },
        { "Au", { { NAN, 1.2e-3, 2e-3 } } },
    };
    for (int i = 0; i < 3; i++) {
        struct ior_page *page = find(metals[i].name, "");
        const struct outcome o = conduct(page, COLOUR_FIT, NULL);
        const struct outcome fixed = conduct(page, COLOUR_FIXED, NULL);
        const struct outcome mean = conduct(page, COLOUR_AVERAGE, NULL);
        for (int b = 0; b < 3; b++) {
            const double worst = metals[i].worst.band[b];
            if (isnan(worst))
                continue;
            assert_close(o.report.f0.band[b], o.report.f0_spectral.band[b],
                         2e-3);
            assert_at_most(o.report.worst.band[b], worst);
            assert_at_most(o.report.rms.band[b], fixed.report.rms.band[b]);
            assert_at_most(o.report.rms.band[b], mean.report.rms.band[b]);
            assert_true(o.eta.band[b] > 0 && o.k.band[b] > 0);
        }
        assert_at_most(o.report.ciede2000, i == 2 ? 1.4 : 0.05);
        ior_page_free(page);
    }
}

/* The difference of the tables' white from 1 is all that is left. */
static void the_fit_finds_what_a_grey_metal_is_made_of(void **state)
{
    (void)state;
    struct ior_page *page = page_of(grey);
    const struct outcome o = conduct(page, COLOUR_FIT, NULL);
    assert_spectrum(o.eta, 0.7123, 0.7123, 0.7123, 5e-3);
    assert_spectrum(o.k, 3.217, 3.217, 3.217, 1e-2);
    assert_at_most(o.report.ciede2000, 0.01);
    assert_string_equal(o.report.warnings, "");
    ior_page_free(page);
}

static void golds_red_is_out_of_reach(void **state)
{
    (void)state;
    struct ior_page *page = find("Au", "");
    const struct outcome o = conduct(page, COLOUR_FIT, NULL);
    assert_close(o.report.f0_spectral.band[0], 1.0376, 1e-3);
    assert_has(o.report.warnings, "R: the spectrum has F0 = 1.0377");
    assert_has(o.report.warnings, "0.999 was fitted instead");
    assert_null(strstr(o.report.warnings, "G:"));
    assert_null(strstr(o.report.warnings, "B:"));
    assert_true(o.report.f0.band[0] < 1 && o.report.f0.band[0] > 0.998);
    ior_page_free(page);
}

/* Dark below 600 nm and bright above: more saturated than any red of sRGB. */
static void a_negative_green_is_out_of_reach(void **state)
{
    (void)state;
    struct ior_page *page = page_of("      0.36 1.02 0.02\n"
                                    "      0.60 1.02 0.02\n"
                                    "      0.61 0.02 5\n"
                                    "      0.83 0.02 5\n");
    const struct outcome o = conduct(page, COLOUR_FIT, NULL);
    assert_true(o.report.f0_spectral.band[1] < 0);
    assert_has(o.report.warnings, "G: the spectrum has F0 = -0.");
    assert_has(o.report.warnings, "0.001 was fitted instead");
    for (int b = 0; b < 3; b++)
        assert_true(o.eta.band[b] >= 0 && isfinite(o.eta.band[b]) &&
                    o.k.band[b] >= 0 && isfinite(o.k.band[b]));
    ior_page_free(page);
}

static void fits_repeat_to_the_last_bit(void **state)
{
    (void)state;
    struct ior_page *page = find("Cu", "");
    const struct outcome a = conduct(page, COLOUR_FIT, NULL);
    const struct outcome b = conduct(page, COLOUR_FIT, NULL);
    assert_memory_equal(&a.eta, &b.eta, sizeof a.eta);
    assert_memory_equal(&a.k, &b.k, sizeof a.k);
    ior_page_free(page);
}

/* -- matching -------------------------------------------------------------- */

/* A write-up's calcium, without a word on where it is from. */
static const struct spectrum eta_given = { { 0.29294, 0.28568, 0.28733 } };
static const struct spectrum k_given = { { 2.7181, 2.3479, 1.8333 } };

static void calcium_is_found(void **state)
{
    (void)state;
    struct colour_match m;
    struct err err = { "" };
    assert_true(
        colour_match(&eta_given, &k_given, 5e-6, 5e-5, NULL, 0, "", &m, &err));
    assert_string_equal(m.page, "Ca/Mathewson");
    assert_int_equal(m.bands.count, 3);
    assert_close(m.bands.nm[0], 614, 0);
    assert_close(m.bands.nm[1], 549, 0);
    assert_close(m.bands.nm[2], 466, 0);
    assert_true(m.within);
    assert_at_most(m.error, 1);
    for (int b = 0; b < 3; b++) {
        assert_int_equal(m.candidates[b], 1);
        assert_close(m.eta.band[b], eta_given.band[b], 5e-6);
        assert_close(m.k.band[b], k_given.band[b], 5e-5);
    }
    assert_true(m.compared >= 3);
    assert_int_equal(m.skipped, 2);
}

static void calcium_is_found_among_named_pages(void **state)
{
    (void)state;
    static const char *const names[] = { "Cu/Johnson", "Xx/Nobody", "Ca" };
    struct colour_match m;
    struct err err = { "" };
    assert_true(
        colour_match(&eta_given, &k_given, 5e-6, 5e-5, names, 3, "", &m, &err));
    assert_string_equal(m.page, "Ca");
    assert_true(m.within);
    assert_int_equal(m.compared, 2);
    assert_int_equal(m.skipped, 1);
}

static void what_is_nowhere_is_not_within(void **state)
{
    (void)state;
    struct spectrum eta = eta_given;
    eta.band[1] += 1e-4;
    struct colour_match m;
    struct err err = { "" };
    assert_true(
        colour_match(&eta, &k_given, 5e-6, 5e-5, NULL, 0, "", &m, &err));
    assert_string_equal(m.page, "Ca/Mathewson"); /* the nearest still */
    assert_false(m.within);
    assert_true(m.error > 1 && m.error < 25);
    assert_int_equal(m.candidates[1], 0);

    static const char *const none[] = { "Xx/Nobody" };
    assert_false(
        colour_match(&eta, &k_given, 5e-6, 5e-5, none, 1, "", &m, &err));
    assert_has(err.text, "no page of optical constants to compare with");
    assert_has(err.text, "Xx");
}

/* -------------------------------------------------------------------------- */

static int set_up(void **state)
{
    (void)state;
    struct err err = { "" };
    if (mkdtemp(folder) && cie_load(&cie, &err))
        return 0;
    print_error("%s\n", err.text);
    return -1;
}

static int tear_down(void **state)
{
    (void)state;
    unlink(path_of("page.yml"));
    unlink(path_of("spoilt.tsv"));
    unlink(path_of("dark.tsv"));
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "a perfect reflector under D65 is white", daylight_is_white },
        { "the colour matching functions sum up", functions_sum_up },
        { "linear sRGB is that of the standard", srgb_is_that_of_the_standard },
        { "sRGB is encoded to the digits of bc", srgb_encodes },
        { "CIELAB is a cube root and its tangent",
          lab_is_a_cube_root_and_its_tangent },
        { "CIEDE2000 agrees with its authors' table",
          ciede2000_agrees_with_table_1 },
        { "tables with a bad line are refused", bad_tables_are_refused },
        { "long lines and folders are no tables",
          long_lines_and_folders_are_no_tables },
        { "tables without light are refused", dark_tables_are_refused },
        { "a missing table is named", a_missing_table_is_named },
        { "a table's last line needs no end", a_last_line_needs_no_end },
        { "a grey metal is Fresnel's at every angle",
          a_grey_metal_is_fresnels },
        { "pages that miss little are held, with a warning",
          pages_that_miss_little_are_held },
        { "pages that miss much are refused",
          pages_that_miss_much_are_refused },
        { "fixed needs three wavelengths and no more",
          fixed_without_a_report_needs_three_wavelengths },
        { "methods have names", methods_have_names },
        { "colours agree with other code", colours_agree_with_other_code },
        { "calcium, gold and copper are off by so much",
          calcium_gold_and_copper_are_off_by_so_much },
        { "the fit follows the spectrum over angle",
          the_fit_follows_the_spectrum },
        { "the fit finds what a grey metal is made of",
          the_fit_finds_what_a_grey_metal_is_made_of },
        { "gold's red is out of reach, and it says so",
          golds_red_is_out_of_reach },
        { "a negative green is out of reach, and it says so",
          a_negative_green_is_out_of_reach },
        { "fits repeat to the last bit", fits_repeat_to_the_last_bit },
        { "a write-up's calcium is found", calcium_is_found },
        { "calcium is found among named pages",
          calcium_is_found_among_named_pages },
        { "numbers from nowhere are not within rounding",
          what_is_nowhere_is_not_within },
    };
    return cmocka_run_group_tests_name("colour", tests, set_up, tear_down);
}
