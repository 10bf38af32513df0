/* test_baseline_tracer.c - the yardstick of the bench measures right
 *
 * Direct light against the configuration factor of a rectangle, bounces against
 * the integrating sphere.
 */
#include "tests/baseline_tracer.h"

#include <stdlib.h>

#include "tests/close.h"
#include "tests/relmse.h"

/* Owns arrays, and is thrown away whole. */
static float *render(const struct tracer_scene *s, int samples, int depth,
                     int threads, struct tracer_result *r)
{
    const struct tracer_options options = { samples, depth, threads, 7 };
    struct err err;
    float *rgb = calloc((size_t)s->camera.width * (size_t)s->camera.height,
                        3 * sizeof *rgb);
    assert_non_null(rgb);
    if (!tracer_render(s, &options, rgb, r, &err))
        fail_msg("%s", err.text);
    return rgb;
}

/* -- a rectangle above a floor --------------------------------------------- */

/* From a point to a rectangle in a parallel plane, one of whose corners lies
 * above it: sides a and b over the distance.  R. Siegel and J. R. Howell,
 * Thermal Radiation Heat Transfer, configuration factors between an element and
 * a rectangle. */
static double corner(double a, double b)
{
    const double p = sqrt(1 + a * a), q = sqrt(1 + b * b);
    return (a / p * atan(b / p) + b / q * atan(a / q)) / (2 * acos(-1));
}

/* Of the rectangle [x0, x1] x [y0, y1] at a height, seen from the origin. */
static double factor(double x0, double x1, double y0, double y1, double height)
{
    const double x[2] = { x0 / height, x1 / height };
    const double y[2] = { y0 / height, y1 / height };
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        const double a = x[i & 1], b = y[i >> 1];
        sum += ((i & 1) == (i >> 1) ? 1 : -1) * copysign(1, a) *
               copysign(1, b) * corner(fabs(a), fabs(b));
    }
    return sum;
}

/* A floor at z = 0 that is looked at from above through a lamp at z = 0.9,
 * which has no triangles. */
static const float floor_xyz[12] = { -5, -5, 0, 5, -5, 0, 5, 5, 0, -5, 5, 0 };
static const unsigned floor_index[6] = { 0, 1, 2, 0, 2, 3 };
static const unsigned char floor_material[2] = { 0, 0 };
static const float floor_albedo[3] = { 0.31f, 0.57f, 0.83f };

static struct tracer_scene floor_scene(void)
{
    return (struct tracer_scene){
        .xyz = floor_xyz,
        .vertices = 4,
        .index = floor_index,
        .triangles = 2,
        .material = floor_material,
        .albedo = floor_albedo,
        .materials = 1,
        .light = { .corner = { -0.4f, -0.4f, 0.9f },
                   .u = { 0, 1.1f, 0 },
                   .v = { 0.6f, 0, 0 },
                   .radiance = { 3, 5, 7 },
                   .lamp = 1 },
        .camera = { .to_world = { { { 1, 0, 0, 0.23 },
                                    { 0, -1, 0, -0.11 },
                                    { 0, 0, -1, 4 } } },
                    .width = 7,
                    .height = 5,
                    .focal = 9,
                    .near = 0.1,
                    .far = 100 },
    };
}

/* At the middle of pixel (x, y), of the floor. */
static double floor_radiance(const struct tracer_scene *s, int x, int y, int c)
{
    const struct camera *k = &s->camera;
    const double height = k->to_world.m[2][3];
    const double px =
        k->to_world.m[0][3] - (x + 0.5 - k->width / 2.0) / k->focal * height;
    const double py =
        k->to_world.m[1][3] + (y + 0.5 - k->height / 2.0) / k->focal * height;
    const double up = (double)s->light.corner[2];
    const double f = factor(-0.4 - px, 0.2 - px, -0.4 - py, 0.7 - py, up);
    return (double)(s->albedo[c] * s->light.radiance[c]) * f;
}

/* A pixel is as wide as 4/9 of the floor's unit, so the mean over one is taken
 * by the rule of 16 x 16 midpoints, with finer pixels. */
static void direct_light_is_that_of_a_rectangle(void **state)
{
    struct tracer_scene s = floor_scene(), fine = s;
    struct tracer_result r;
    float *rgb = render(&s, 40000, 1, 0, &r);
    (void)state;
    fine.camera.width *= 16;
    fine.camera.height *= 16;
    fine.camera.focal *= 16;
    double all = 0;
    for (int y = 0; y < 5; y++)
        for (int x = 0; x < 7; x++)
            for (int c = 0; c < 3; c++) {
                double mean = 0;
                for (int i = 0; i < 256; i++)
                    mean += floor_radiance(&fine, 16 * x + i % 16,
                                           16 * y + i / 16, c) /
                            256;
                const double got = (double)rgb[3 * (7 * y + x) + c];
                assert_close(got / mean, 1, 0.02);
                all += got / mean / (3 * 35);
            }
    assert_close(all, 1, 0.003);
    assert_int_equal(r.paths, 35 * 40000);
    assert_int_equal(r.rays, 2 * 35 * 40000);
    free(rgb);
}

/* -- an integrating sphere ------------------------------------------------- */

/* A sphere's inside, a small lamp in it, the camera in the middle.  What is
 * reflected from any of it lights all of it alike: after k bounces the
 * irradiance is albedo^(k - 1) flux / area. */
enum { RINGS = 160, AROUND = 320 };

static struct tracer_scene sphere_scene(void)
{
    static float xyz[3 * (RINGS + 1) * AROUND];
    static unsigned index[6 * RINGS * AROUND];
    static unsigned char material[2 * RINGS * AROUND];
    static const float albedo[3] = { 0.3f, 0.6f, 0.9f };
    const double pi = acos(-1);
    for (int i = 0; i <= RINGS; i++)
        for (int j = 0; j < AROUND; j++) {
            float *p = xyz + 3 * (i * AROUND + j);
            const double theta = pi * i / RINGS, phi = 2 * pi * j / AROUND;
            p[0] = (float)(sin(theta) * cos(phi));
            p[1] = (float)(sin(theta) * sin(phi));
            p[2] = (float)cos(theta);
        }
    for (unsigned i = 0; i < RINGS; i++)
        for (unsigned j = 0; j < AROUND; j++) {
            const unsigned a = i * AROUND + j,
                           b = i * AROUND + (j + 1) % AROUND;
            const unsigned quad[6] = { a, b,          a + AROUND,
                                       b, b + AROUND, a + AROUND };
            memcpy(index + 6 * a, quad, sizeof quad);
        }
    return (struct tracer_scene){
        .xyz = xyz,
        .vertices = (RINGS + 1) * AROUND,
        .index = index,
        .triangles = 2 * RINGS * AROUND,
        .material = material,
        .albedo = albedo,
        .materials = 1,
        .light = { .corner = { 0.51f, -0.02f, 0.03f },
                   .u = { 0, 0, 0.05f },
                   .v = { 0, 0.04f, 0 },
                   .radiance = { 500, 500, 500 },
                   .lamp = 1 },
        .camera = { .to_world = { { { 1, 0, 0, 0.02 },
                                    { 0, 1, 0, -0.03 },
                                    { 0, 0, 1, 0.01 } } },
                    .width = 64,
                    .height = 48,
                    .focal = 60,
                    .near = 0.01,
                    .far = 100 },
    };
}

static double channel_mean(const float *rgb, int pixels, int c)
{
    double sum = 0;
    for (int i = 0; i < pixels; i++)
        sum += (double)rgb[3 * i + c];
    return sum / pixels;
}

static void bounces_are_those_of_an_integrating_sphere(void **state)
{
    const struct tracer_scene s = sphere_scene();
    const double pi = acos(-1), albedo[3] = { 0.3, 0.6, 0.9 };
    const double flux = pi * 500 * 0.05 * 0.04, irradiance = flux / (4 * pi);
    struct tracer_result r;
    float *one = render(&s, 256, 1, 0, &r), *six = render(&s, 256, 6, 0, &r);
    (void)state;
    for (int c = 0; c < 3; c++) {
        double sum = 0;
        for (int k = 2; k <= 6; k++)
            sum += albedo[c] / pi * irradiance * pow(albedo[c], k - 1);
        const double got =
            channel_mean(six, 64 * 48, c) - channel_mean(one, 64 * 48, c);
        assert_close(got / sum, 1, 0.01);
    }
    free(one);
    free(six);
}

/* -- the box --------------------------------------------------------------- */

static void the_box_is_the_same_for_any_threads(void **state)
{
    struct tracer_scene s;
    struct tracer_result r;
    struct err err;
    (void)state;
    assert_true(tracer_box(&s, 70000, &err));
    assert_in_range(s.triangles, 69000, 71000);
    s.camera.width = 120;
    s.camera.height = 90;
    s.camera.focal /= 4;
    const size_t n = 3 * 120 * 90;
    float *one = render(&s, 4, 5, 1, &r), *two = render(&s, 4, 5, 2, &r);
    float *many = render(&s, 64, 5, 0, &r);
    assert_memory_equal(one, two, n * sizeof *one);
    assert_true(r.cpu_s > 0 && r.wall_s > 0 && r.rays > r.paths);
    /* Sixteen times the samples, a sixteenth of the error: seeds are shared, so
     * the reference is 4 of the 64. */
    assert_in_range(1e3 * relmse(one, many, n), 30, 3000);
    /* The lamp is seen, ten times as bright as white. */
    const float *lamp = many + 3 * (size_t)(120 * 11 + 60);
    assert_close((double)lamp[0], 10, 1e-5);
    free(one);
    free(two);
    free(many);
    tracer_box_free(&s);
}

static void relmse_is_as_defined(void **state)
{
    static const float x[3] = { 1.1f, 0.3f, 0 }, reference[3] = { 1, 0, 2 };
    (void)state;
    assert_close(relmse(x, reference, 3),
                 (0.01 / 1.01 + 0.09 / 0.01 + 4 / 4.01) / 3, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "direct light is that of a rectangle",
          direct_light_is_that_of_a_rectangle },
        { "bounces are those of an integrating sphere",
          bounces_are_those_of_an_integrating_sphere },
        { "the box is the same for any number of threads",
          the_box_is_the_same_for_any_threads },
        { "relmse is as defined", relmse_is_as_defined },
    };
    return cmocka_run_group_tests_name("baseline tracer", tests, NULL, NULL);
}
