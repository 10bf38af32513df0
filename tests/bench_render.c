/* bench_render.c - the renderer beside a minimal tracer, on one scene
 *
 * Both render the box of baseline_tracer.h, of five bounces; runs take turns,
 * and what is printed are medians of several, with the least and the most.
 * Noise is that of one run's picture against a reference, the mean of two
 * pictures of ours with more samples and other seeds, each far from the other
 * by 4 times the reference's own error, which is printed and taken off.
 *
 *   bench_render [samples of a pixel [runs]]
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include "integrator/render.h"
#include "tests/baseline_tracer.h"
#include "tests/relmse.h"

enum { TRIANGLES = 70000, DEPTH = 5, RUNS_MAX = 99, REFERENCE = 4 };
enum { YARDSTICK, INDEPENDENT, SPREAD, ONE_THREAD, KINDS };
static const char *const names[KINDS] = { "yardstick", "ours, independent",
                                          "ours, ldsampler",
                                          "ours, one thread" };
static const double goal_speed = 0.8, goal_noise = 0.85, goal_threads = 1.9;

/* What one run cost, and how noisy its picture is. */
struct run {
    double wall_s, cpu_s, paths, relmse;
};

static void or_exit(bool ok, const struct err *err)
{
    if (ok)
        return;
    fprintf(stderr, "bench_render: %s\n", err->text);
    exit(1);
}

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* -- the scene ------------------------------------------------------------- */

/* The triangles of a material, with their own vertices. */
static struct mesh *part(const struct tracer_scene *t, int material,
                         struct err *err)
{
    size_t triangles = 0, vertices = 0;
    for (size_t i = 0; i < t->triangles; i++)
        triangles += t->material[i] == material;
    unsigned *number = calloc(t->vertices, sizeof *number); /* and 1 */
    struct mesh *m =
        number ? mesh_new(3 * triangles, triangles, false, err) : NULL;
    unsigned *to = m ? m->index : NULL;
    for (size_t i = 0; m && i < 3 * t->triangles; i++) {
        const unsigned k = t->index[i];
        if (t->material[i / 3] != material)
            continue;
        if (number[k] == 0) {
            memcpy(m->xyz + 3 * vertices, t->xyz + 3 * (size_t)k,
                   3 * sizeof *t->xyz);
            number[k] = (unsigned)++vertices;
        }
        *to++ = number[k] - 1;
    }
    if (m)
        m->vertices = vertices;
    free(number);
    return m;
}

static struct scene *ours(const struct tracer_scene *t)
{
    struct err err = { "out of memory" };
    struct scene *s = scene_new(&bands_default, &err);
    or_exit(s != NULL, &err);
    for (int k = 0; k <= t->light.lamp; k++) {
        char spec[120];
        const float *a = t->albedo + 3 * k;
        snprintf(spec, sizeof spec, "diffuse:reflectance=%.9g/%.9g/%.9g",
                 (double)a[0], (double)a[1], (double)a[2]);
        struct surface surface = { .bsdf = scene_add_bsdf(s, spec, &err),
                                   .name = spec };
        or_exit(surface.bsdf >= 0, &err);
        for (int b = 0; k == t->light.lamp && b < 3; b++)
            surface.radiance.band[b] = (double)t->light.radiance[b];
        struct mesh *m = part(t, k, &err);
        or_exit(m != NULL, &err);
        or_exit(scene_add_mesh(s, m, &surface, &err), &err);
    }
    scene_set_camera(s, &t->camera);
    or_exit(scene_commit(s, &err), &err);
    return s;
}

/* -- runs ------------------------------------------------------------------ */

static struct run render_ours(const struct scene *s, int samples,
                              enum sampler_kind sampler, uint64_t seed,
                              int threads, float *rgb)
{
    const struct render_settings set = {
        .path = { .max_depth = DEPTH,
                  .only_bounce = -1,
                  .light_samples = 1,
                  .rr_depth = PATH_DEPTH_MAX },
        .samples = (uint64_t)samples,
        .sampler = sampler,
        .seed = seed,
        .threads = threads,
    };
    struct err err;
    struct render_result made;
    const double wall = seconds(CLOCK_MONOTONIC);
    const double cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    or_exit(render(s, &set, &made, &err), &err);
    const struct run run = {
        .wall_s = seconds(CLOCK_MONOTONIC) - wall,
        .cpu_s = seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu,
        .paths = (double)made.paths,
    };
    const size_t n = (size_t)made.film->width * (size_t)made.film->height;
    for (size_t i = 0; i < n; i++)
        memcpy(rgb + 3 * i, made.film->pixel[i].mean, 3 * sizeof *rgb);
    film_free(made.film);
    return run;
}

static struct run render_yardstick(const struct tracer_scene *t, int samples,
                                   uint64_t seed, float *rgb)
{
    const struct tracer_options options = { samples, DEPTH, 2, seed };
    struct tracer_result made;
    struct err err;
    or_exit(tracer_render(t, &options, rgb, &made, &err), &err);
    return (struct run){ .wall_s = made.wall_s,
                         .cpu_s = made.cpu_s,
                         .paths = (double)made.paths };
}

/* Into rgb; its own error. */
static double reference(const struct scene *s, int samples, float *rgb,
                        size_t n)
{
    float *other = malloc(n * sizeof *other);
    const struct err err = { "out of memory" };
    or_exit(other != NULL, &err);
    render_ours(s, samples, SAMPLER_LD, 1001, 2, rgb);
    render_ours(s, samples, SAMPLER_LD, 1002, 2, other);
    const double apart = relmse(rgb, other, n);
    for (size_t i = 0; i < n; i++)
        rgb[i] = (rgb[i] + other[i]) / 2;
    free(other);
    return apart / 4;
}

/* -- what is printed ------------------------------------------------------- */

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts. */
static void print_spread(const char *name, double *x, int n, double goal,
                         const char *than)
{
    qsort(x, (size_t)n, sizeof *x, by_size);
    printf("  %-46s%8.3f  [%.3f, %.3f]  (goal: at %s %g)\n", name, x[n / 2],
           x[0], x[n - 1], than, goal);
}

typedef double quantity(const struct run *a, const struct run *b);

static double speed_by_cpu(const struct run *a, const struct run *b)
{
    return a->paths / a->cpu_s / (b->paths / b->cpu_s);
}

static double speed_by_wall(const struct run *a, const struct run *b)
{
    return a->paths / a->wall_s / (b->paths / b->wall_s);
}

static double noise_times_cpu(const struct run *a, const struct run *b)
{
    return a->relmse * a->cpu_s / (b->relmse * b->cpu_s);
}

static void print_ratio(struct run run[KINDS][RUNS_MAX], int runs,
                        const char *name, quantity *of, int a, int b,
                        double goal, const char *than)
{
    double x[RUNS_MAX];
    char text[80];
    for (int i = 0; i < runs; i++)
        x[i] = of(&run[a][i], &run[b][i]);
    snprintf(text, sizeof text, "%s, %s", name, names[a]);
    print_spread(text, x, runs, goal, than);
}

static void print_all(struct run run[KINDS][RUNS_MAX], int runs)
{
    printf("\nRATIOS to the yardstick, of %d runs in turns: median [least, "
           "most]\n",
           runs);
    for (int k = INDEPENDENT; k <= SPREAD; k++) {
        print_ratio(run, runs, "paths per CPU-s", speed_by_cpu, k, YARDSTICK,
                    goal_speed, "least");
        print_ratio(run, runs, "paths/s", speed_by_wall, k, YARDSTICK,
                    goal_speed, "least");
        print_ratio(run, runs, "relMSE x CPU-s", noise_times_cpu, k, YARDSTICK,
                    goal_noise, "most");
    }
    print_ratio(run, runs, "two threads, in the time of", speed_by_wall,
                INDEPENDENT, ONE_THREAD, goal_threads, "least");
    printf("\nABSOLUTE, last run\n%-20s%14s%14s%14s\n", "", "Mpaths/CPU-s",
           "Mpaths/s", "relMSE");
    for (int k = 0; k < KINDS; k++) {
        const struct run *r = &run[k][runs - 1];
        printf("%-20s%14.3f%14.3f%14.3g\n", names[k], r->paths / r->cpu_s / 1e6,
               r->paths / r->wall_s / 1e6, r->relmse);
    }
}

static void print_memory(const struct scene *s)
{
    const struct scene_size size = scene_size(s);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    printf("memory: scene %.1f MB (%zu triangles, %.0f bytes each), the whole "
           "program at most %.1f MB\n",
           (double)size.bytes / 1e6, size.triangles,
           (double)size.bytes / (double)size.triangles,
           (double)usage.ru_maxrss * 1024 / 1e6);
}

int main(int argc, char **argv)
{
    static struct run run[KINDS][RUNS_MAX];
    const int samples = argc > 1 ? atoi(argv[1]) : 64;
    const int runs = argc > 2 ? atoi(argv[2]) : 5;
    struct tracer_scene t;
    struct err err = { "expected samples from 1 and runs from 1 to 99" };
    or_exit(samples >= 1 && runs >= 1 && runs <= RUNS_MAX, &err);
    or_exit(tracer_box(&t, TRIANGLES, &err), &err);
    struct scene *s = ours(&t);
    const size_t n = 3 * (size_t)t.camera.width * (size_t)t.camera.height;
    float *rgb = malloc(n * sizeof *rgb), *better = malloc(n * sizeof *better);
    err = (struct err){ "out of memory" };
    or_exit(rgb && better, &err);
    const double off = reference(s, REFERENCE * samples, better, n);
    printf("box of %d triangles, %d x %d, %d samples, %d bounces; reference "
           "2 x %d samples, its relMSE %.2g\n",
           TRIANGLES, t.camera.width, t.camera.height, samples, DEPTH,
           REFERENCE * samples, off);
    fflush(stdout);
    for (int i = 0; i < runs; i++)
        for (int k = 0; k < KINDS; k++) {
            const uint64_t seed = 1 + (uint64_t)i;
            run[k][i] = k == YARDSTICK
                            ? render_yardstick(&t, samples, seed, rgb)
                            : render_ours(s, samples,
                                          k == SPREAD ? SAMPLER_LD
                                                      : SAMPLER_INDEPENDENT,
                                          seed, k == ONE_THREAD ? 1 : 2, rgb);
            run[k][i].relmse = relmse(rgb, better, n) - off;
        }
    print_all(run, runs);
    print_memory(s);
    free(rgb);
    free(better);
    scene_free(s);
    tracer_box_free(&t);
    return 0;
}
