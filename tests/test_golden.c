/* test_golden.c - the models agree with fifty digits
 *
 * tests/golden.py evaluates the formulas of the literature in fifty digits and
 * shares nothing with the library; its head states the formulas, their sources
 * and what a rounded direction stands for.
 */
#include "bsdf/bsdf.h"
#include "bsdf/fresnel.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char eval_table[] = "tests/golden/eval.tsv";
static const char sample_table[] = "tests/golden/sample.tsv";
static const char fresnel_table[] = "tests/golden/fresnel.tsv";

struct table {
    const char *path;
    FILE *file;
    char *line;
    size_t size;
    int number; /* of the line, from 1 */
};

static struct table table_open(const char *path)
{
    const struct table t = { .path = path, .file = fopen(path, "r") };
    if (!t.file)
        fail_msg("%s: %s; the tests run in the root of the repository", path,
                 strerror(errno));
    return t;
}

/* Splits the next line that is not a comment into its first column and n
 * numbers; false at the end. */
static bool table_row(struct table *t, const char **name, int n, double *x)
{
    do {
        if (getline(&t->line, &t->size, t->file) < 0)
            return false;
        t->number++;
    } while (t->line[0] == '#');

    char *at = t->line + strcspn(t->line, "\t");
    for (int i = 0; i < n; i++) {
        char *end = at;
        if (*at == '\t') {
            *at++ = '\0';
            x[i] = strtod(at, &end);
        }
        if (end == at || (*end != '\t' && *end != '\n'))
            fail_msg("%s:%d: column %d is not a number", t->path, t->number,
                     i + 2);
        at = end;
    }
    if (*at != '\n')
        fail_msg("%s:%d: more than %d columns", t->path, t->number, n + 1);
    *name = t->line;
    return true;
}

static void table_close(struct table *t)
{
    free(t->line);
    (void)fclose(t->file);
}

/* 0 where the two are equal, 0 included; NaN where one of them is. */
static double relative_error(double got, double expected)
{
    return got == expected ? 0 : fabs(got - expected) / fabs(expected);
}

/* How far off f and pdf may be, relative to what they are, where nothing
 * cancels.
 *
 * The table's directions are exact, so wo + wi is rounded once and the slope
 * over alpha is good to some eps = 1.1e-16 of itself.  In the table it is at
 * most 4, and exp(-s^2) turns s (1 + d) into a relative 2 s^2 d <= 32 d.  Sums
 * and library functions add some eps each: 1e-14 in all, at any roughness and
 * cosine, of which a hundredfold is allowed. */
static const double eval_limit = 1e-12;

/* Where something cancels, the table has what one rounding, 2^-53 of the terms,
 * does in each such step.  The longest is (wo + n wi) / |wo + n wi|, whose n,
 * product, sum, square, two sums of squares, root and division make eight: so
 * many are allowed in each. */
static const double roundings = 8;

struct eval_row {
    const char *spec;
    struct vec3 wo, wi;
    double expected[4]; /* f of three bands, pdf */
    double limit[4];    /* relative */
};

static bool eval_row_next(struct table *t, struct eval_row *row)
{
    double x[12];
    if (!table_row(t, &row->spec, 12, x))
        return false;
    row->wo = (struct vec3){ x[0], x[1], x[2] };
    row->wi = (struct vec3){ x[3], x[4], x[5] };
    memcpy(row->expected, x + 6, sizeof row->expected);
    for (int i = 0; i < 4; i++)
        row->limit[i] = fmax(eval_limit, roundings * x[i < 3 ? 10 : 11]);
    return true;
}

/* How many of the four values are off, each of them reported. */
static int eval_row_failures(const struct bsdf *b, const struct eval_row *row)
{
    static const char *const names[] = { "f[0]", "f[1]", "f[2]", "pdf" };
    const struct spectrum f = bsdf_eval(b, row->wo, row->wi);
    const double got[] = { f.band[0], f.band[1], f.band[2],
                           bsdf_pdf(b, row->wo, row->wi) };
    int failures = 0;
    for (int i = 0; i < 4; i++) {
        const double error = relative_error(got[i], row->expected[i]);
        if (error <= row->limit[i]) /* a NaN fails */
            continue;
        failures++;
        print_error("%s\n  wo = %a %a %a\n  wi = %a %a %a\n"
                    "  %s is %.17g, expected %.17g: off by %.3g, "
                    "limit %.3g\n",
                    row->spec, row->wo.x, row->wo.y, row->wo.z, row->wi.x,
                    row->wi.y, row->wi.z, names[i], got[i], row->expected[i],
                    error, row->limit[i]);
    }
    return failures;
}

static struct bsdf *made(const char *spec)
{
    struct err err;
    struct bsdf *b = bsdf_new(spec, &bands_default, &err);
    if (!b)
        fail_msg("%s: %s", spec, err.text);
    return b;
}

/* Whether f and pdf are 0 here: nothing but an exact 0 passes. */
static bool dark(const struct eval_row *row)
{
    return row->expected[3] == 0;
}

/* A share of the table, and the least number of rows it has to have, lest a
 * lost table pass. */
struct share {
    const char *name; /* what the first column starts with */
    int rows;
    int dark; /* of them */
};

static bool is_of(const char *spec, const struct share *share)
{
    return !strncmp(spec, share->name, strlen(share->name));
}

static void f_and_pdf_agree(void **state)
{
    const struct share *share = *state;
    struct table t = table_open(eval_table);
    struct bsdf *b = NULL;
    struct eval_row row;
    int rows = 0, darks = 0, failures = 0;
    while (eval_row_next(&t, &row)) {
        if (!is_of(row.spec, share))
            continue;
        if (!b || strcmp(bsdf_spec(b), row.spec) != 0) {
            bsdf_free(b);
            b = made(row.spec);
        }
        failures += eval_row_failures(b, &row);
        rows++;
        darks += dark(&row);
    }
    bsdf_free(b);
    table_close(&t);
    assert_int_equal(failures, 0);
    assert_true(rows >= share->rows);
    assert_true(darks >= share->dark);
}

static void rows_are_there(void **state)
{
    const struct share *share = *state;
    struct table t = table_open(eval_table);
    struct eval_row row;
    int rows = 0;
    while (eval_row_next(&t, &row))
        rows += is_of(row.spec, share);
    table_close(&t);
    assert_true(rows >= share->rows);
}

struct sample_row {
    const char *spec;
    struct vec3 wo;
    double begin, end; /* of u.z */
    struct bsdf_sample expected;
    double wi_limit, pdf_limit; /* absolute */
};

static bool sample_row_next(struct table *t, struct sample_row *row)
{
    double x[14];
    if (!table_row(t, &row->spec, 14, x))
        return false;
    row->wo = (struct vec3){ x[0], x[1], x[2] };
    row->begin = x[3];
    row->end = x[4];
    row->expected = (struct bsdf_sample){
        .wi = { x[5], x[6], x[7] },
        .pdf = x[8],
        .weight = { { x[9], x[10], x[11] } },
        .delta = x[8] > 0, /* or absorbed */
    };
    /* One rounding of 1 on top, for 1 - R and wo.x / n. */
    row->wi_limit = roundings * (DBL_EPSILON / 2 + x[12]);
    row->pdf_limit = roundings * (DBL_EPSILON / 2 + x[13]);
    return true;
}

static bool sample_agrees(const struct sample_row *row,
                          const struct bsdf_sample *got)
{
    const struct bsdf_sample *want = &row->expected;
    bool agrees = got->delta == want->delta &&
                  fabs(got->wi.x - want->wi.x) <= row->wi_limit &&
                  fabs(got->wi.y - want->wi.y) <= row->wi_limit &&
                  fabs(got->wi.z - want->wi.z) <= row->wi_limit &&
                  fabs(got->pdf - want->pdf) <= row->pdf_limit;
    for (int i = 0; i < 3; i++)
        agrees &= relative_error(got->weight.band[i], want->weight.band[i]) <=
                  eval_limit;
    return agrees;
}

static void sample_print(const char *what, const struct bsdf_sample *s)
{
    print_error("  %s: wi %.17g %.17g %.17g, pdf %.17g, "
                "weight %.17g %.17g %.17g, %s\n",
                what, s->wi.x, s->wi.y, s->wi.z, s->pdf, s->weight.band[0],
                s->weight.band[1], s->weight.band[2],
                s->delta ? "delta" : "not delta");
}

/* Draws just behind where the branch begins, in its middle and just before it
 * ends; how many of them are off, each of them reported.  0 and 1 are exact. */
static int sample_row_failures(const struct bsdf *b,
                               const struct sample_row *row)
{
    const double low = row->begin > 0 ? row->begin + row->pdf_limit : 0;
    const double high =
        row->end < 1 ? row->end - row->pdf_limit : 1 - DBL_EPSILON / 2;
    const double z[] = { low, (row->begin + row->end) / 2, high };
    int failures = 0;
    for (int i = 0; i < 3; i++) {
        const struct vec3 u = { 0.3719, 0.6143, z[i] };
        const struct bsdf_sample got = bsdf_sample(b, row->wo, u);
        if (sample_agrees(row, &got))
            continue;
        failures++;
        print_error("%s\n  wo = %a %a %a, u.z = %.17g, limits %.3g of wi, "
                    "%.3g of pdf\n",
                    row->spec, row->wo.x, row->wo.y, row->wo.z, z[i],
                    row->wi_limit, row->pdf_limit);
        sample_print("sampled", &got);
        sample_print("expected", &row->expected);
    }
    return failures;
}

static void samples_agree(void **state)
{
    const struct share *share = *state;
    struct table t = table_open(sample_table);
    struct bsdf *b = NULL;
    struct sample_row row;
    int rows = 0, absorbed = 0, failures = 0;
    while (sample_row_next(&t, &row)) {
        if (!is_of(row.spec, share))
            continue;
        if (!b || strcmp(bsdf_spec(b), row.spec) != 0) {
            bsdf_free(b);
            b = made(row.spec);
        }
        failures += sample_row_failures(b, &row);
        rows++;
        absorbed += !row.expected.delta;
    }
    bsdf_free(b);
    table_close(&t);
    assert_int_equal(failures, 0);
    assert_true(rows >= share->rows);
    assert_true(absorbed >= share->dark);
}

static double schlick(double c, double eta, double r0)
{
    (void)eta;
    return fresnel_schlick(c, r0);
}

static double dielectric(double c, double eta, double k)
{
    (void)k;
    return fresnel_dielectric(c, eta, NULL);
}

/* A dozen roundings of eps = 1.1e-16, magnified by the differences that make F.
 * The smallest F of a conductor in the table, exact or approximate, is 0.004:
 * exact, it is the square of a difference of 1/15 of its terms; approximate, a
 * difference of 1/100.  Schlick's 1 - c is off by one rounding. */
static double limit_opaque(double c, double n, double f)
{
    (void)c;
    (void)n;
    return 1e-13 * f;
}

/* d/dq of (a - q) / (a + q), but for the sign. */
static double slope(double a, double q)
{
    return 2 * a / ((a + q) * (a + q));
}

/* A dielectric's F = (rs^2 + rp^2) / 2 has no relative limit:
 *   - it passes 0 as n passes 1.  Amplitudes off by d each make F off by
 *     2 d sqrt(F) + d^2 at most.
 *   - the root of q^2 = n^2 - 1 + c^2 is infinitely steep at the critical
 *     angle, q = 0, where the terms cancel.  If q^2 is off by e, q is off by
 *     e / (2 q), or sqrt(e) at q = 0: by less than e / q where q^2 >= e.
 * Hence d is 4 eps for the arithmetic of the amplitudes, and what they make of
 * q's error.  At Brewster's angle rp is 0, but rs keeps F from it. */
static double limit_dielectric(double c, double n, double f)
{
    const double eps = DBL_EPSILON;
    const double n2_1 = (n - 1) * (n + 1);
    const double e = 2 * eps * (fabs(n2_1) + c * c);
    const double q = sqrt(fmax(fabs(n2_1 + c * c), e));
    const double d = 4 * eps + (slope(c, q) + slope(n * n * c, q)) * e / q;
    return 2 * d * sqrt(f) + d * d;
}

struct fresnel {
    struct share share;
    double (*value)(double c, double eta, double k);
    double (*limit)(double c, double eta, double f); /* of |got - f| */
};

static void fresnel_agrees(void **state)
{
    const struct fresnel *fresnel = *state;
    struct table t = table_open(fresnel_table);
    const char *kind;
    double x[4];
    int rows = 0, failures = 0;
    while (table_row(&t, &kind, 4, x)) {
        if (strcmp(kind, fresnel->share.name) != 0)
            continue;
        const double got = fresnel->value(x[0], x[1], x[2]);
        const double limit = fresnel->limit(x[0], x[1], x[3]);
        if (!(fabs(got - x[3]) <= limit)) { /* a NaN fails */
            failures++;
            print_error("%s: cos = %a, eta = %.17g, k or r0 = %.17g:\n"
                        "  F is %.17g, expected %.17g: off by %.3g, "
                        "limit %.3g\n",
                        kind, x[0], x[1], x[2], got, x[3], fabs(got - x[3]),
                        limit);
        }
        rows++;
    }
    table_close(&t);
    assert_int_equal(failures, 0);
    assert_true(rows >= fresnel->share.rows);
}

int main(void)
{
    static struct share all = { "", 1200, 110 };
    static struct share lambertian = { "diffuse:", 17, 4 };
    static struct share rough = { "roughconductor:", 300, 16 };
    static struct share frosted = { "roughdielectric:", 600, 45 };
    static struct share blend = { "blendbsdf:", 60, 27 };
    static struct share two = { "twosided:", 36, 18 };
    static struct share course = { "course_microfacet:", 202, 8 };
    static struct share smooth[] = {
        { "mirror:", 10, 5 },          { "conductor:", 30, 15 },
        { "refraction:", 60, 20 },     { "dielectric:", 280, 40 },
        { "thindielectric:", 100, 0 }, { "twosided:", 20, 0 },
        { "course_mirror:", 20, 10 },  { "course_refraction:", 60, 20 },
        { "course_glass:", 180, 0 },
    };
    static struct fresnel of_conductor = { { "conductor", 100 },
                                           fresnel_conductor,
                                           limit_opaque };
    static struct fresnel of_approx = { { "approx", 100 },
                                        fresnel_conductor_approx,
                                        limit_opaque };
    static struct fresnel of_schlick = { { "schlick", 50 },
                                         schlick,
                                         limit_opaque };
    static struct fresnel of_dielectric = { { "dielectric", 100 },
                                            dielectric,
                                            limit_dielectric };
    const struct CMUnitTest tests[] = {
        { "the table of f and pdf has 1200 rows or more", rows_are_there,
          .initial_state = &all },
        { "diffuse agrees with fifty digits", f_and_pdf_agree,
          .initial_state = &lambertian },
        { "roughconductor agrees with fifty digits", f_and_pdf_agree,
          .initial_state = &rough },
        { "roughdielectric agrees with fifty digits", f_and_pdf_agree,
          .initial_state = &frosted },
        { "blendbsdf agrees with fifty digits", f_and_pdf_agree,
          .initial_state = &blend },
        { "twosided agrees with fifty digits", f_and_pdf_agree,
          .initial_state = &two },
        { "course_microfacet agrees with fifty digits", f_and_pdf_agree,
          .initial_state = &course },
        { "a mirror's samples agree with fifty digits", samples_agree,
          .initial_state = &smooth[0] },
        { "conductor's samples agree with fifty digits", samples_agree,
          .initial_state = &smooth[1] },
        { "refraction's samples agree with fifty digits", samples_agree,
          .initial_state = &smooth[2] },
        { "dielectric's samples agree with fifty digits", samples_agree,
          .initial_state = &smooth[3] },
        { "thindielectric's samples agree with fifty digits", samples_agree,
          .initial_state = &smooth[4] },
        { "twosided's samples agree with fifty digits", samples_agree,
          .initial_state = &smooth[5] },
        { "course_mirror's samples agree with fifty digits", samples_agree,
          .initial_state = &smooth[6] },
        { "course_refraction's samples agree with fifty digits", samples_agree,
          .initial_state = &smooth[7] },
        { "course_glass's samples agree with fifty digits", samples_agree,
          .initial_state = &smooth[8] },
        { "the conductor's Fresnel term agrees with fifty digits",
          fresnel_agrees, .initial_state = &of_conductor },
        { "the approximate Fresnel term agrees with fifty digits",
          fresnel_agrees, .initial_state = &of_approx },
        { "Schlick's Fresnel term agrees with fifty digits", fresnel_agrees,
          .initial_state = &of_schlick },
        { "the dielectric's Fresnel term agrees with fifty digits",
          fresnel_agrees, .initial_state = &of_dielectric },
    };
    return cmocka_run_group_tests_name("golden", tests, NULL, NULL);
}
