/* path.h - light transport: what comes along one ray of the camera
 *
 * Paths start at the camera.  Depth counts bounces as the course does: 0 is
 * emission that is seen, 1 direct light, 2 one surface more, and so on.
 *
 * Direct light is estimated at every surface that has more than delta lobes,
 * by a number of samples a light.  The strategies, which have the same mean:
 *   mis         lights and the BSDF, weighted by the balance heuristic
 *   light       lights alone; emission is seen by the camera and through delta
 *               lobes only
 *   bsdf        what the path runs into; lights that cannot be hit are sampled
 *   hemisphere  uniform directions, as many as there would be light samples
 *
 * Paths go on in directions that the model samples, or, for what is not a delta
 * lobe, in ones by the cosine or uniform: over the hemisphere of wo for models
 * that reflect, over that or the other one, each half of the times, for those
 * that transmit.  A model with both kinds of lobes is asked for its delta lobes
 * half of the times.
 *
 * Russian roulette: after rr_depth bounces a path goes on with probability
 * rr_probability, or, where that is 0, with min(0.95, the largest band of its
 * weight, radiance's compression in glass taken out), and its weight is divided
 * by it, so that means stay what they are.
 *
 * E. Veach and L. Guibas, Optimally Combining Sampling Techniques for Monte
 * Carlo Rendering, SIGGRAPH 1995.  J. Arvo and D. Kirk, Particle Transport and
 * Image Synthesis, SIGGRAPH 1990.
 */
#ifndef INTEGRATOR_PATH_H
#define INTEGRATOR_PATH_H

#include "integrator/sampler.h"
#include "integrator/scene.h"

enum path_direct { PATH_MIS, PATH_LIGHT, PATH_HIT, PATH_HEMISPHERE };
enum path_sampling { PATH_BSDF, PATH_COSINE, PATH_UNIFORM };

enum { PATH_DEPTH_MAX = 100000, PATH_LIGHT_SAMPLES_MAX = 65536 };

struct path_settings {
    int max_depth;     /* bounces, at most PATH_DEPTH_MAX */
    int only_bounce;   /* this one alone; -1 for all */
    int light_samples; /* a light, at least 1 */
    int rr_depth;      /* at most PATH_DEPTH_MAX, where there is no roulette */
    double rr_probability;
    enum path_direct direct;
    enum path_sampling sampling;
    unsigned compat; /* COMPAT_LIGHT_PDF counts */
};

/** What a path found. */
struct path {
    struct spectrum radiance;
    double depth;           /* distance of what was hit first; 0 if nothing */
    struct vec3 normal;     /* its shading normal; 0 likewise */
    struct spectrum albedo; /* the first weight that is not a delta lobe's */
};

/** A wave of paths of one thread. */
struct paths;

/** NULL when out of memory; the scene and the settings are borrowed. */
struct paths *paths_new(const struct scene *s, const struct path_settings *p,
                        struct sampler sampler);
void paths_free(struct paths *w); /* NULL is fine */

/** Adds n samples, at most PIECE, from one on, of pixel (x, y), whose random
 * numbers are those of a stream; false if there is no room. */
bool paths_add(struct paths *w, int x, int y, uint64_t stream, uint64_t first,
               size_t n);

/** What came along those that were added, in their order, to be read before the
 * next call; the wave is empty again.  Adds the number of rays to theirs. */
const struct path *paths_trace(struct paths *w, uint64_t *rays);

#endif
