/* test_depth.c - what each bounce adds to the spheres, as numbers
 *
 * A mirror ball and a glass ball in a box (data/scenes/spheres.xml).  What a
 * write-up sees in the pictures: the mirror first shows the walls with two
 * bounces, walls are seen through the glass with three, and the glass in the
 * mirror with four.  Pixels are sorted by what their centers meet first.
 */
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "integrator/load.h"
#include "integrator/render.h"
#include "integrator/scene_parts.h"
#include "integrator/trace.h"
#include "tests/close.h"

enum { WIDTH = 120, HEIGHT = 90, PIXELS = WIDTH * HEIGHT };

enum part {
    PART_OTHER,
    PART_MIRROR,          /* the mirror, and in it a wall */
    PART_GLASS,           /* the glass, and behind it a wall */
    PART_GLASS_IN_MIRROR, /* the mirror, and in it the glass */
    PARTS
};

static const char *const part_name[] = { "all", "mirror", "glass",
                                         "glass in mirror" };

static struct scene *scene;
static enum part part[PIXELS];

/* What a ray meets, and where; NULL if nothing. */
static const struct shape *met(const struct ray *ray, struct hits *hits)
{
    static struct rays rays;
    static struct met found;
    const struct queue queue = { .n = 1 };
    const uint16_t first = 0;
    vecs_put(&rays.origin, 0, ray->origin);
    vecs_put(&rays.dir, 0, ray->dir);
    rays.near[0] = ray->near;
    rays.far[0] = ray->far;
    trace_rays(scene, &rays, &queue, false, &found);
    if (found.shape[0])
        trace_places(&rays, &found, &first, 1, hits);
    return found.shape[0];
}

static bool is(const struct shape *a, const char *model)
{
    return strcmp(bsdf_type(a->bsdf)->name, model) == 0;
}

static enum part part_at(int x, int y)
{
    static struct hits hits;
    const struct ray ray =
        camera_ray(scene_camera(scene), x + 0.5, y + 0.5, 0, 0);
    const struct shape *a = met(&ray, &hits);
    if (!a)
        return PART_OTHER;
    if (is(a, "dielectric"))
        return PART_GLASS;
    if (!is(a, "conductor"))
        return PART_OTHER;
    const struct vec3 normal = vecs_at(&hits.n, 0);
    const struct vec3 dir = vec3_reflect(vec3_scale(-1, ray.dir), normal);
    const struct ray on = {
        .origin =
            vec3_add(vecs_at(&hits.point, 0), vec3_scale(hits.hair[0], normal)),
        .dir = dir,
        .far = INFINITY,
    };
    a = met(&on, &hits);
    if (!a || a->flags & SHAPE_EMITS)
        return PART_OTHER;
    return is(a, "dielectric") ? PART_GLASS_IN_MIRROR : PART_MIRROR;
}

static int setup(void **state)
{
    struct err err;
    const struct load_options options = { .width = WIDTH, .height = HEIGHT };
    (void)state;
    scene =
        scene_load("data/scenes/spheres.xml", &bands_default, &options, &err);
    if (!scene || !scene_commit(scene, &err)) {
        print_error("%s\n", err.text);
        return -1;
    }
    for (int i = 0; i < PIXELS; i++)
        part[i] = part_at(i % WIDTH, i / WIDTH);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    scene_free(scene);
    return 0;
}

static struct render_result rendered(int depth, uint64_t samples,
                                     double tolerance)
{
    struct err err;
    struct render_result made;
    const struct render_settings set = {
        .path = { .max_depth = depth,
                  .only_bounce = -1,
                  .light_samples = 1,
                  .rr_depth = 5 },
        .samples = samples,
        .seed = 1,
        .batch = 32,
        .tolerance = tolerance,
    };
    assert_true(render(scene, &set, &made, &err));
    assert_int_equal(made.bad, 0);
    return made;
}

/* The median of a part's luminances: what most of it shows. */
static double median(const struct film *f, enum part of)
{
    double y[PIXELS];
    size_t n = 0;
    for (int i = 0; i < PIXELS; i++)
        if (part[i] == of)
            y[n++] = film_luminance(f->pixel[i].mean);
    assert_true(n > 3);
    gsl_sort(y, 1, n);
    return gsl_stats_median_from_sorted_data(y, 1, n);
}

static double mean(const struct film *f)
{
    double sum = 0;
    for (int i = 0; i < PIXELS; i++)
        sum += film_luminance(f->pixel[i].mean);
    return sum / PIXELS;
}

static void bounces_show_what_they_reach(void **state)
{
    static const int depth[] = { 0, 1, 2, 3, 4, 5, 100 };
    enum { N = sizeof depth / sizeof *depth };
    double seen[N][PARTS];
    (void)state;
    print_message("%5s %10s", "M", "mean");
    for (int p = PART_MIRROR; p < PARTS; p++)
        print_message(" %16s", part_name[p]);
    print_message("\n");
    for (int i = 0; i < N; i++) {
        struct render_result made = rendered(depth[i], 48, 0);
        seen[i][PART_OTHER] = mean(made.film);
        print_message("%5d %10.5f", depth[i], seen[i][PART_OTHER]);
        for (int p = PART_MIRROR; p < PARTS; p++) {
            seen[i][p] = median(made.film, (enum part)p);
            print_message(" %16.5f", seen[i][p]);
        }
        print_message("\n");
        film_free(made.film);
    }
    /* Nothing before, and then most of what there will be. */
    assert_true(seen[1][PART_MIRROR] == 0);
    assert_true(seen[2][PART_MIRROR] > 0.5 * seen[5][PART_MIRROR]);
    assert_true(seen[2][PART_GLASS] < 0.2 * seen[5][PART_GLASS]);
    assert_true(seen[3][PART_GLASS] > 0.5 * seen[5][PART_GLASS]);
    assert_true(seen[3][PART_GLASS_IN_MIRROR] <
                0.2 * seen[5][PART_GLASS_IN_MIRROR]);
    assert_true(seen[4][PART_GLASS_IN_MIRROR] >
                0.5 * seen[5][PART_GLASS_IN_MIRROR]);
    for (int i = 1; i < N; i++)
        assert_true(seen[i][PART_OTHER] > seen[i - 1][PART_OTHER]);
    /* Each bounce adds less than the one before it, from the second on. */
    for (int i = 3; i < 6; i++)
        assert_true(seen[i][PART_OTHER] - seen[i - 1][PART_OTHER] <
                    seen[i - 1][PART_OTHER] - seen[i - 2][PART_OTHER]);
}

static void rates_hardly_depend_on_depth(void **state)
{
    double samples[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct render_result made = rendered(i ? 100 : 5, 128, 0.05);
        samples[i] = (double)made.paths / PIXELS;
        print_message("M = %d: %.1f samples a pixel of at most 128\n",
                      i ? 100 : 5, samples[i]);
        film_free(made.film);
    }
    assert_true(samples[0] > 32 && samples[0] < 128);
    assert_true(fabs(samples[1] - samples[0]) < 0.1 * samples[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "bounces show what they reach", bounces_show_what_they_reach },
        { "rates hardly depend on depth", rates_hardly_depend_on_depth },
    };
    return cmocka_run_group_tests_name("depth", tests, setup, teardown);
}
