/* test_compare.c - equal pictures are called so, others are found
 *
 * Pictures are made of samples of known distributions; every number of false
 * alarms and of finds is held against its binomial distribution.
 */
#include "integrator/compare.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "bsdf/rng.h"
#include "tests/close.h"

enum { WIDTH = 40, LONGEST = 256 };
static const double level = 0.05; /* of whole pictures */

/* Means of 1, from a uniform number. */
static double steady(double u)
{
    return 0.7 - 0.3 * log1p(-u);
}

static double exponential(double u)
{
    return -log1p(-u);
}

/* One sample in 500 carries a tenth of the light. */
static double fireflies(double u)
{
    return u < 0.002 ? -50 * log1p(-u / 0.002)
                     : -0.9 * log1p(-(u - 0.002) / 0.998);
}

/* No fourth moment. */
static double pareto(double u)
{
    return 1.5 / 2.5 * pow(1 - u, -1 / 2.5);
}

struct kind {
    double (*sample)(double u);
    int count;   /* samples a pixel */
    bool grey;   /* the same in R, G and B */
    double bias; /* of all means */
};

/* Brighter to the right, where it is three times as bright. */
static double brightness(const struct film *f, size_t i)
{
    return 1 + 2.0 * (double)(i % (size_t)f->width) / f->width;
}

static void expose(struct film *f, const struct kind *k, uint64_t picture)
{
    double u[3][LONGEST];
    const struct rng rng = { 20, picture };
    for (size_t i = 0; i < (size_t)f->width * (size_t)f->height; i++) {
        struct film_pixel *p = &f->pixel[i];
        rng_uniform_many(rng, i * LONGEST, (size_t)k->count, u[0], u[1], u[2]);
        const double scale = brightness(f, i) * (1 + k->bias);
        for (int c = 0; c < 3; c++) {
            double mean = 0, squares = 0;
            for (int n = 0; n < k->count; n++) {
                const double x = scale * k->sample(u[k->grey ? 0 : c][n]);
                const double d = x - mean;
                mean += d / (n + 1);
                squares += d * (x - mean);
            }
            p->mean[c] = (float)mean;
            p->variance[c] = (float)(squares / (k->count - 1) / k->count);
        }
        p->count = (uint32_t)k->count;
    }
}

static struct film *film(int width, int height)
{
    struct film *f = film_new(width, height, NULL);
    assert_non_null(f);
    return f;
}

/* Of pictures of a and b, so many; bias is the mean of those stated. */
static int differ(int pictures, int width, const struct kind *a,
                  const struct kind *b, double *bias)
{
    const struct compare_options options = { .significance = level };
    int different = 0, failed = 0;
    double sum = 0;
#pragma omp parallel for reduction(+ : different, failed, sum)
    for (int i = 0; i < pictures; i++) {
        struct film *fa = film(width, width), *fb = film(width, width);
        struct comparison r;
        expose(fa, a, 2 * (uint64_t)i);
        expose(fb, b, 2 * (uint64_t)i + 1);
        failed += !compare_films(fa, fb, &options, &r, NULL, NULL);
        different += !r.same;
        sum += r.bias;
        film_free(fa);
        film_free(fb);
    }
    assert_int_equal(failed, 0);
    *bias = sum / pictures;
    return different;
}

/* -- false alarms ---------------------------------------------------------- */

struct pair {
    const char *name;
    struct kind a, b;
};
enum { PICTURES = 100 };

static void equal_pictures_are_called_so(void **state)
{
    const struct pair pairs[] = {
        { "exponential", { exponential, 16 }, { exponential, 16 } },
        { "exponential, 8 and 64", { exponential, 8 }, { exponential, 64 } },
        { "fireflies", { fireflies, 16 }, { fireflies, 16 } },
        { "fireflies, 8 and 64", { fireflies, 8 }, { fireflies, 64 } },
        { "pareto", { pareto, 16 }, { pareto, 16 } },
        { "pareto, 8 and 64", { pareto, 8 }, { pareto, 64 } },
        { "steady against fireflies", { steady, 32 }, { fireflies, 32 } },
    };
    (void)state;
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        double bias;
        const int k = differ(PICTURES, WIDTH, &pairs[i].a, &pairs[i].b, &bias);
        print_message("%s: %d of %d called different at %g; a bias of %.1f %% "
                      "would be found\n",
                      pairs[i].name, k, PICTURES, level, 100 * bias);
        if (k > 0)
            assert_true(gsl_cdf_binomial_Q((unsigned)k - 1, level, PICTURES) >
                        1e-6);
    }
}

/* -- finds ----------------------------------------------------------------- */

static void the_bias_that_is_stated_is_found(void **state)
{
    struct kind a = { steady, 32, .grey = true }, b = a;
    double stated, ignored;
    (void)state;
    assert_in_range(differ(PICTURES, WIDTH, &a, &b, &stated), 0, 16);
    assert_close(stated, 0.01, 0.002);
    b.bias = stated;
    const int whole = differ(PICTURES, WIDTH, &a, &b, &ignored);
    b.bias = stated / 2;
    const int half = differ(PICTURES, WIDTH, &a, &b, &ignored);
    print_message("a bias of %.2f %% was found %d times of %d, half of it %d\n",
                  100 * stated, whole, PICTURES, half);
    assert_true(gsl_cdf_binomial_P((unsigned)whole, 0.99, PICTURES) > 1e-6);
    assert_in_range(half, 5, 80);
}

/* A block is made brighter by its own mean's noise, so often. */
static void change(struct film *f, int left, int top, int width, int height,
                   float factor)
{
    for (int y = top; y < top + height; y++)
        for (int x = left; x < left + width; x++)
            for (int c = 0; c < 3; c++)
                f->pixel[(size_t)y * (size_t)f->width + (size_t)x].mean[c] *=
                    factor;
}

static void one_block_is_found_and_named(void **state)
{
    const struct compare_options options = { .block = 20 };
    const struct kind kind = { exponential, 64 };
    struct film *a = film(107, 83), *b = film(107, 83), *map = NULL;
    struct comparison r;
    (void)state;
    expose(a, &kind, 0);
    expose(b, &kind, 1);
    assert_true(compare_films(a, b, &options, &r, NULL, NULL));
    assert_true(r.same);
    assert_int_equal(r.tests, 3 * (6 * 5 + 1));
    assert_int_equal(r.different, 0);
    assert_close(r.ratio, 1, 0.02);

    change(b, 40, 60, 20, 20, 1.25f);
    change(b, 100, 80, 7, 3, 0.5f);
    assert_true(compare_films(a, b, &options, &r, &map, NULL));
    assert_false(r.same);
    assert_in_range(r.different, 6, 9); /* the picture as a whole, perhaps */
    assert_int_equal(r.x, 40);
    assert_int_equal(r.y, 60);
    assert_int_equal(r.width, 20);
    assert_int_equal(r.height, 20);
    assert_true(r.z > 10);
    assert_close((double)map->pixel[79 * 107 + 59].mean[r.channel], r.z, 1e-5);
    assert_close((double)map->pixel[79 * 107 + 60].mean[0], 0, 5);
    assert_true(map->pixel[82 * 107 + 106].mean[1] < -6);
    film_free(map);

    change(b, 40, 60, 20, 20, 1 / 1.25f);
    assert_true(compare_films(a, b, &options, &r, NULL, NULL));
    assert_false(r.same);
    assert_int_equal(r.x, 100);
    assert_int_equal(r.y, 80);
    assert_int_equal(r.width, 7);
    assert_int_equal(r.height, 3);
    film_free(a);
    film_free(b);
}

/* -- what is no noise ------------------------------------------------------ */

/* A lamp before a black wall. */
static struct film *lamp(float radiance)
{
    struct film *f = film(60, 40);
    for (int i = 0; i < 60 * 40; i++)
        f->pixel[i].count = 16;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 400; i++)
            f->pixel[i / 20 * 60 + i % 20].mean[c] = radiance;
    return f;
}

static void without_noise_numbers_are_equal_or_not(void **state)
{
    const struct compare_options options = { 0 };
    struct film *a = lamp(10), *b = lamp(nextafterf(10, 11)),
                *c = lamp(10.0001f);
    struct comparison r;
    (void)state;
    assert_true(compare_films(a, a, &options, &r, NULL, NULL));
    assert_true(r.same && r.p == 1 && r.z == 0 && r.bias == 0);
    assert_true(compare_films(a, b, &options, &r, NULL, NULL));
    assert_true(r.same && r.p == 1);
    assert_true(compare_films(a, c, &options, &r, NULL, NULL));
    assert_false(r.same);
    assert_true(isinf(r.z) && r.z > 0 && r.x == 0 && r.y == 0);
    film_free(a);
    film_free(b);
    film_free(c);
}

static void black_pictures_are_equal(void **state)
{
    const struct compare_options options = { 0 };
    struct film *a = lamp(0);
    struct comparison r;
    (void)state;
    assert_true(compare_films(a, a, &options, &r, NULL, NULL));
    assert_true(r.same && r.p == 1 && isnan(r.ratio));
    film_free(a);
}

static void a_nan_is_named(void **state)
{
    const struct compare_options options = { 0 };
    const struct kind kind = { exponential, 8 };
    struct film *a = film(50, 30), *b = film(50, 30), *map = NULL;
    struct comparison r;
    char text[1000] = "";
    (void)state;
    expose(a, &kind, 0);
    expose(b, &kind, 1);
    const struct film_pixel sound = b->pixel[17 * 50 + 33];
    struct film_pixel *p = &b->pixel[17 * 50 + 33];
    for (size_t i = 0; i < 4; i++) {
        *p = sound;
        if (i == 0)
            p->mean[1] = NAN;
        else if (i == 1)
            p->mean[1] = INFINITY;
        else
            p->variance[1] = i == 2 ? -1e-9f : NAN;
        assert_true(compare_films(a, b, &options, &r, &map, NULL));
        assert_false(r.same);
        assert_true(r.bad == 1 && r.x == 33 && r.y == 17 && r.channel == 1);
        assert_true(isnan(map->pixel[17 * 50 + 33].mean[1]));
        assert_true(!isnan(map->pixel[0].mean[1]));
        film_free(map);
    }
    FILE *out = fmemopen(text, sizeof text, "w");
    compare_print(out, &r);
    fclose(out);
    assert_has(text, "different: 1 pixel with");
    assert_has(text, "(33, 17), channel G");
    film_free(a);
    film_free(b);
}

/* -- what cannot be compared ----------------------------------------------- */

static void what_cannot_be_compared_is_said(void **state)
{
    const struct compare_options options = { 0 };
    struct film *a = film(5, 4), *b = film(5, 3);
    struct comparison r;
    struct err err;
    (void)state;
    assert_false(compare_films(a, b, &options, &r, NULL, &err));
    assert_has(err.text, "5 x 4 and 5 x 3");
    for (int i = 0; i < 20; i++)
        a->pixel[i].count = i == 13 ? 1 : 2;
    assert_false(compare_films(a, a, &options, &r, NULL, &err));
    assert_has(err.text, "first picture has 1 samples at (3, 2)");
    film_free(a);
    film_free(b);
}

/* -- the map --------------------------------------------------------------- */

static void the_map_is_blue_white_red(void **state)
{
    static const float z[5] = { -8, -3, 0, 3, NAN };
    static const unsigned char expected[5][3] = { { 0, 0, 255 },
                                                  { 128, 128, 255 },
                                                  { 255, 255, 255 },
                                                  { 255, 128, 128 },
                                                  { 255, 0, 255 } };
    char path[] = "/tmp/test_compare.XXXXXX";
    struct film *map = film(5, 1);
    struct png png;
    struct err err;
    (void)state;
    const int fd = mkstemp(path);
    assert_true(fd >= 0);
    close(fd);
    for (size_t i = 0; i < 5; i++)
        map->pixel[i].mean[i % 3] = z[i];
    assert_true(compare_write_map(map, path, &err));
    assert_true(png_read(&png, path, &err));
    assert_memory_equal(png.rgb, expected, sizeof expected);
    free(png.rgb);
    film_free(map);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "equal pictures are called so, whatever their noise",
          equal_pictures_are_called_so },
        { "the bias that is stated is found 99 times of 100",
          the_bias_that_is_stated_is_found },
        { "one changed block is found and named",
          one_block_is_found_and_named },
        { "without noise, numbers are equal up to rounding or not at all",
          without_noise_numbers_are_equal_or_not },
        { "black pictures are equal", black_pictures_are_equal },
        { "a pixel that is no number is named", a_nan_is_named },
        { "what cannot be compared is said", what_cannot_be_compared_is_said },
        { "the map is blue, white and red", the_map_is_blue_white_red },
    };
    gsl_set_error_handler_off();
    return cmocka_run_group_tests_name("compare", tests, NULL, NULL);
}
