/* render.c - passes over tiles, and sums over samples */
#include "integrator/render.h"

#include <float.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "bsdf/cli.h"

enum { TILE = 16, PASS = 64 };

/* What a pixel's samples add up to. */
struct sums {
    uint64_t n;
    double s1[3], s2[3], y1, y2; /* radiance, its luminance, and squares */
    double depth, normal[3], albedo[3];
    bool done;
};

struct job {
    const struct scene *scene;
    const struct render_settings *settings;
    int x, y, width, height; /* of the picture */
    struct sums *sums;
    struct render_result *result;
};

static struct sums *sums_at(const struct job *job, int x, int y)
{
    return &job->sums[(size_t)y * (size_t)job->width + (size_t)x];
}

static void add(struct sums *a, const struct path *p)
{
    const double *rgb = p->radiance.band;
    const double y = film_luminance_of(rgb[0], rgb[1], rgb[2]);
    a->n++;
    for (int b = 0; b < 3; b++) {
        const double x = p->radiance.band[b];
        a->s1[b] += x;
        a->s2[b] += x * x;
        a->albedo[b] += p->albedo.band[b];
    }
    a->y1 += y;
    a->y2 += y * y;
    a->depth += p->depth;
    a->normal[0] += p->normal.x;
    a->normal[1] += p->normal.y;
    a->normal[2] += p->normal.z;
}

/* s^2 / n from sums; not a number below two samples. */
static double variance(uint64_t n, double s1, double s2)
{
    const double count = (double)n;
    return n < 2 ? NAN : fmax(0, s2 - s1 * s1 / count) / (count - 1) / count;
}

/* Not as long as no sample has seen light: that some would is not known. */
static bool certain(const struct sums *a, double tolerance)
{
    const double mu = a->y1 / (double)a->n;
    const double i = 1.96 * sqrt(variance(a->n, a->y1, a->y2));
    return a->n > 1 && mu > 0 && i <= tolerance * mu;
}

static struct film_pixel pixel(const struct sums *a)
{
    struct film_pixel p = { .count = (uint32_t)a->n };
    const double n = a->n > 0 ? (double)a->n : 1;
    for (int b = 0; b < 3; b++) {
        p.mean[b] = (float)(a->s1[b] / n);
        p.variance[b] = (float)variance(a->n, a->s1[b], a->s2[b]);
        p.normal[b] = (float)(a->normal[b] / n);
        p.albedo[b] = (float)(a->albedo[b] / n);
    }
    p.luminance_variance = (float)variance(a->n, a->y1, a->y2);
    p.depth = (float)(a->depth / n);
    return p;
}

/* What one thread found in a pass. */
struct tally {
    uint64_t paths, rays, bad;
    struct render_place first_bad;
};

/* Whether a comes before b, row by row. */
static bool before(struct render_place a, struct render_place b)
{
    if (a.y != b.y || a.x != b.x)
        return a.y != b.y ? a.y < b.y : a.x < b.x;
    return a.sample < b.sample;
}

/* Counts samples that are no numbers, and keeps where the first was. */
static void count_bad(uint64_t *bad, struct render_place *first, uint64_t more,
                      struct render_place at)
{
    if (more > 0 && (*bad == 0 || before(at, *first)))
        *first = at;
    *bad += more;
}

/* Samples of a pixel that are in the wave, or in none yet. */
struct piece {
    struct sums *sums;
    int x, y;
    size_t n;
};

/* What a thread works with. */
struct worker {
    struct paths *paths;
    size_t pieces;
    struct piece piece[WAVE];
    struct tally tally;
};

static void worker_free(struct worker *w)
{
    if (w)
        paths_free(w->paths);
    free(w);
}

/* NULL when out of memory. */
static struct worker *worker_new(const struct job *job)
{
    const struct render_settings *set = job->settings;
    struct worker *w = calloc(1, sizeof *w);
    if (w)
        w->paths = paths_new(job->scene, &set->path,
                             (struct sampler){ set->sampler, set->seed });
    if (w && !w->paths) {
        free(w);
        return NULL;
    }
    return w;
}

static void count(struct tally *tally, const struct piece *at, struct path p)
{
    tally->paths++;
    /* Nor what no float of the film can hold. */
    if (!(fabs(p.radiance.band[0]) + fabs(p.radiance.band[1]) +
              fabs(p.radiance.band[2]) <=
          (double)FLT_MAX)) {
        count_bad(&tally->bad, &tally->first_bad, 1,
                  (struct render_place){ at->x, at->y, at->sums->n });
        p.radiance = p.albedo = (struct spectrum){ { 0 } };
    }
    add(at->sums, &p);
}

static void flush(struct worker *w)
{
    const struct path *p = paths_trace(w->paths, &w->tally.rays);
    for (const struct piece *at = w->piece; at < w->piece + w->pieces; at++)
        for (size_t i = 0; i < at->n; i++)
            count(&w->tally, at, *p++);
    w->pieces = 0;
}

/* One pixel's samples of a pass. */
static void samples(const struct job *job, int x, int y, struct sums *a,
                    uint64_t more, struct worker *w)
{
    /* Wide enough for any picture, whose sides are below 2^16. */
    const uint64_t stream = (uint64_t)y << 32 | (uint64_t)x;
    const uint64_t left = job->settings->samples - a->n;
    const uint64_t end = a->n + (more < left ? more : left);
    for (uint64_t at = a->n; at < end;) {
        const size_t n = end - at < PIECE ? (size_t)(end - at) : PIECE;
        if (!paths_add(w->paths, x, y, stream, at, n)) {
            flush(w);
            continue;
        }
        w->piece[w->pieces++] = (struct piece){ a, x, y, n };
        at += n;
    }
}

/* Denormal numbers cost much and change nothing that is seen. */
static void flush_denormals(void)
{
#ifdef __SSE2__
    _mm_setcsr(_mm_getcsr() | 0x8040); /* to zero, as results and as input */
#endif
}

static int tiles(int length)
{
    return (length + TILE - 1) / TILE;
}

static void tile(const struct job *job, int index, uint64_t more,
                 struct worker *w)
{
    const struct render_settings *set = job->settings;
    const int across = tiles(job->width);
    const int x0 = index % across * TILE, y0 = index / across * TILE;
    const int x1 = x0 + TILE < job->width ? x0 + TILE : job->width;
    const int y1 = y0 + TILE < job->height ? y0 + TILE : job->height;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            struct sums *a = sums_at(job, x, y);
            if (!a->done)
                samples(job, job->x + x, job->y + y, a, more, w);
        }
    flush(w);
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            struct sums *a = sums_at(job, x, y);
            a->done = a->done || a->n >= set->samples ||
                      (set->tolerance > 0 && certain(a, set->tolerance));
        }
}

static void gather(struct render_result *r, const struct tally *t)
{
    r->paths += t->paths;
    r->rays += t->rays;
    count_bad(&r->bad, &r->first_bad, t->bad, t->first_bad);
}

static void show(const struct job *job, uint64_t rays, uint64_t pass, int at)
{
    const struct render_settings *set = job->settings;
    const uint64_t count =
        (uint64_t)tiles(job->width) * (uint64_t)tiles(job->height);
    const uint64_t passes = (set->samples + pass - 1) / pass;
    char what[64];
    const double seconds = cli_elapsed() - job->result->seconds;
    snprintf(what, sizeof what, "tiles, %.2f million rays/s",
             seconds > 0 ? (double)rays / seconds / 1e6 : 0);
    cli_progress(what, (size_t)at, (size_t)(passes * count));
}

/* One pass over all tiles; false when it was stopped on the way. */
static bool pass_over(const struct job *job, uint64_t more, int *shown)
{
    const int count = tiles(job->width) * tiles(job->height);
    const struct render_settings *set = job->settings;
    bool stopped = false;
#pragma omp parallel num_threads(set->threads > 0 ? set->threads               \
                                                  : omp_get_max_threads())
    {
        struct worker *worker = worker_new(job);
        double last = cli_elapsed();
        flush_denormals();
#pragma omp for schedule(dynamic, 1)
        for (int i = 0; i < count; i++) {
            bool halt;
#pragma omp atomic read
            halt = stopped;
            if (halt || !worker)
                continue;
            if (set->stop && *set->stop) {
#pragma omp atomic write
                stopped = true;
                continue;
            }
            tile(job, i, more, worker);
            int so_far;
#pragma omp atomic capture
            so_far = ++*shown;
            if (set->progress && omp_get_thread_num() == 0 &&
                cli_elapsed() - last > 0.2) {
                last = cli_elapsed();
                show(job,
                     job->result->rays +
                         worker->tally.rays * (uint64_t)omp_get_num_threads(),
                     more, so_far);
            }
        }
        if (!worker) {
#pragma omp atomic write
            stopped = true;
        } else {
#pragma omp critical(render_gather)
            gather(job->result, &worker->tally);
        }
        worker_free(worker);
    }
    return !stopped;
}

static bool all_done(const struct job *job)
{
    const size_t n = (size_t)job->width * (size_t)job->height;
    bool done = true;
    for (size_t i = 0; i < n && done; i++)
        done = job->sums[i].done;
    return done;
}

bool render(const struct scene *s, const struct render_settings *settings,
            struct render_result *result, struct err *err)
{
    const struct camera *c = scene_camera(s);
    const bool part = settings->width > 0;
    struct job job = { s,
                       settings,
                       part ? settings->x : 0,
                       part ? settings->y : 0,
                       part ? settings->width : c->width,
                       part ? settings->height : c->height,
                       NULL,
                       result };
    *result = (struct render_result){ .bad = 0 };
    if (job.x < 0 || job.y < 0 || job.height < 1 ||
        job.x > c->width - job.width || job.y > c->height - job.height)
        return err_set(err,
                       "cell %d x %d at %d, %d: expected it inside the "
                       "picture, %d x %d",
                       job.width, job.height, job.x, job.y, c->width,
                       c->height);
    result->film = film_new(job.width, job.height, err);
    const size_t n = (size_t)job.width * (size_t)job.height;
    job.sums = result->film ? calloc(n, sizeof *job.sums) : NULL;
    if (!job.sums) {
        if (result->film)
            err_set(err, "no memory for a picture of %d x %d", job.width,
                    job.height);
        film_free(result->film);
        result->film = NULL;
        return false;
    }
    const double start = cli_elapsed();
    result->seconds = start; /* until the end: when it began */
    const uint64_t pass = settings->tolerance > 0 ? settings->batch : PASS;
    int shown = 0;
    while (!all_done(&job) && !result->stopped)
        result->stopped = !pass_over(&job, pass, &shown);
    result->seconds = cli_elapsed() - start;
    if (settings->progress)
        cli_progress("tiles", 1, 1);
    for (size_t i = 0; i < n; i++)
        result->film->pixel[i] = pixel(&job.sums[i]);
    free(job.sums);
    return true;
}
