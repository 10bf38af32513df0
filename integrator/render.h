/* render.h - a picture of a scene
 *
 * The picture is made in passes of some samples for every pixel, so that
 * whenever it is stopped, but in the first, there is a whole one; then pixels
 * without a sample are black, and count 0.  Each pixel depends on the seed
 * and its place alone: neither on the number of threads nor on what part of the
 * picture is rendered.
 *
 * Adaptive: after every batch a pixel is done whose mean luminance mu is known
 * to I = 1.96 sigma / sqrt(n) <= tolerance mu, sigma^2 = (s2 - s1^2 / n) /
 * (n - 1), and that has seen light.  That stops when luck looks like certainty,
 * so that the means of adaptive pictures are biased, and their variances too
 * small; comparisons should use others.
 */
#ifndef INTEGRATOR_RENDER_H
#define INTEGRATOR_RENDER_H

#include <signal.h>

#include "integrator/film.h"
#include "integrator/path.h"

struct render_settings {
    struct path_settings path;
    uint64_t samples; /* a pixel, at least 1, below 2^32 */
    enum sampler_kind sampler;
    uint64_t seed;
    uint64_t batch;          /* of adaptive sampling */
    double tolerance;        /* 0: every pixel gets all its samples */
    int threads;             /* 0 for as many as there are */
    int x, y, width, height; /* of the picture; all of it where width is 0 */
    bool progress;           /* on standard error */
    const volatile sig_atomic_t *stop; /* set to stop; or NULL */
};

struct render_place {
    int x, y; /* of the picture */
    uint64_t sample;
};

struct render_result {
    struct film *film; /* owned by the caller */
    uint64_t paths, rays;
    double seconds;
    bool stopped;
    uint64_t bad; /* samples that were no finite number, which count as 0 */
    struct render_place first_bad;
};

/** False and the reason if it cannot be done. */
bool render(const struct scene *s, const struct render_settings *settings,
            struct render_result *result, struct err *err);

#endif
