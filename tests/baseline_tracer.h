/* baseline_tracer.h - a minimal path tracer on Embree, to measure others by
 *
 * As fast as a short program of its kind gets: triangles, one diffuse albedo
 * each, one rectangle that emits, a pinhole; float; camera rays in packets of
 * 16, all others one by one; cosine sampling, one uniform point of the light a
 * bounce, no multiple importance sampling, no Russian roulette, a box filter.
 * It computes what integrator/render.h does of such a scene, in expectation;
 * the yardstick of `make bench`.
 *
 * Points, vectors and colours are three floats; the arrays are borrowed.
 */
#ifndef TESTS_BASELINE_TRACER_H
#define TESTS_BASELINE_TRACER_H

#include <stddef.h>
#include <stdint.h>

#include "bsdf/err.h"
#include "integrator/camera.h"

struct tracer_scene {
    const float *xyz; /* 3 a vertex */
    size_t vertices;
    const unsigned *index; /* 3 a triangle */
    size_t triangles;
    const unsigned char *material; /* of each triangle, below materials */
    const float *albedo;           /* 3 a material */
    int materials;

    /* corner + a u + b v, a and b in [0, 1], emits toward u x v.  To be seen it
     * needs two triangles as well, which turn that way and are of the material
     * lamp; they reflect nothing. */
    struct {
        float corner[3], u[3], v[3], radiance[3];
        int lamp;
    } light;

    struct camera camera; /* its lens is left out */
};

struct tracer_options {
    int samples; /* a pixel */
    int depth;   /* bounces: 0 is emission, 1 direct light, ... */
    int threads; /* 0 for all */
    uint64_t seed;
};

struct tracer_result {
    double build_s;       /* of Embree's tree, all threads' wall time */
    double wall_s, cpu_s; /* of the tracing; cpu_s sums over threads */
    uint64_t paths, rays;
};

/** Fills width * height * 3 floats, linear, row by row from the upper left;
 * the same for any number of threads. */
bool tracer_render(const struct tracer_scene *scene,
                   const struct tracer_options *options, float *rgb,
                   struct tracer_result *result, struct err *err);

/** The scene of the bench: a Cornell box of x, z in [-1, 1], y in [0, 1.5],
 * open toward +z, walls of .6 (left .6/.2/.2, right .2/.2/.6), a lamp of
 * .8 x .6 at y = 1.49 with radiance 10, and a blob of about so many triangles;
 * 480 x 360.  Owned by the caller: tracer_box_free. */
bool tracer_box(struct tracer_scene *scene, size_t triangles, struct err *err);
void tracer_box_free(struct tracer_scene *scene);

#endif
