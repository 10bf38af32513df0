/* scene.h - shapes, what they are made of, lights and a camera
 *
 * A scene is filled, by a loader or by hand, then committed; from then on it
 * does not change, and threads may share it.
 *
 * Radiance and reflectance have one value a band (bsdf/bands.h), linear.
 * Surfaces have two sides; the normal's is the upper one (z > 0) of the models.
 * A shape that emits does so on the normal's side, or on both.
 *
 * A mesh of two triangles that make a parallelogram is a rectangle to whatever
 * samples lights.
 */
#ifndef INTEGRATOR_SCENE_H
#define INTEGRATOR_SCENE_H

#include <stddef.h>

#include "bsdf/bsdf.h"
#include "integrator/camera.h"
#include "integrator/mesh.h"

struct scene;

/** What a shape is made of. */
struct surface {
    int bsdf;                 /* as scene_add_bsdf gave it */
    struct spectrum radiance; /* emitted; 0 for most */
    bool both_sides;          /* emit */
    bool unsampled;           /* it emits, but is no light to sample: seen by
                                 the camera and through delta bounces alone */
    const char *name;         /* for messages; copied */
};

/** Lights that are no shape. */
enum light_kind {
    LIGHT_CONSTANT,    /* from everywhere */
    LIGHT_HEMISPHERE,  /* from the directions with y > 0 */
    LIGHT_POINT,       /* intensity [W/sr] in radiance's place */
    LIGHT_ENVIRONMENT, /* a picture, from everywhere */
    LIGHT_HIDDEN       /* a rectangle that emits to its normal's side and that
                          nothing hits: the course's <area> */
};
struct light {
    enum light_kind kind;
    struct spectrum radiance;
    struct vec3 position; /* of a point; of a rectangle's corner */
    struct vec3 u, v;     /* a rectangle's sides; it emits toward u x v */
    struct environment *environment; /* the scene's once it is added */
};

/** What a file asks of the renderer, where it does; the command line goes
 * before it. -1 or NaN where it asks nothing. */
struct scene_wishes {
    int samples;   /* a pixel */
    int max_depth; /* bounces, as the course counts them: 0 is emission */
    int rr_depth;  /* bounces before Russian roulette */
    bool robust;   /* no ray slips between two triangles that share an edge;
                      else about 6e-7 of them do: 19 of 3e7 random ones in a
                      sphere of 69,168 (tests/test_transport.c) */
};

/** For instances of these bands; NULL when out of memory. */
struct scene *scene_new(const struct bands *bands, struct err *err);
void scene_free(struct scene *s); /* NULL is fine */

const struct bands *scene_bands(const struct scene *s);

/** The number of what a spec makes, the same for the same spec; -1 and the
 * reason if it cannot be made.  Every call may leave a warning in err. */
int scene_add_bsdf(struct scene *s, const char *spec, struct err *err);

/** Takes the mesh, whether it succeeds or not; it is checked (mesh_check). */
bool scene_add_mesh(struct scene *s, struct mesh *m,
                    const struct surface *surface, struct err *err);

/** Two triangles: corner, corner + u, corner + u + v, corner + v; the normal is
 * along u x v, which must not be 0. */
bool scene_add_rectangle(struct scene *s, struct vec3 corner, struct vec3 u,
                         struct vec3 v, const struct surface *surface,
                         struct err *err);

/** The normal points outward, or inward if flipped; radius > 0. */
bool scene_add_sphere(struct scene *s, struct vec3 center, double radius,
                      bool flipped, const struct surface *surface,
                      struct err *err);

/** The points center + a u + b v, a^2 + b^2 <= 1; u and v at right angles and
 * of the same length; the normal is along u x v. */
bool scene_add_disk(struct scene *s, struct vec3 center, struct vec3 u,
                    struct vec3 v, const struct surface *surface,
                    struct err *err);

bool scene_add_light(struct scene *s, const struct light *light,
                     struct err *err);

void scene_set_camera(struct scene *s, const struct camera *camera);
void scene_set_wishes(struct scene *s, const struct scene_wishes *wishes);

/** NULL as long as there is none. */
const struct camera *scene_camera(const struct scene *s);
struct scene_wishes scene_wishes(const struct scene *s);

/** The box around every shape so far; false if there is none. */
bool scene_box(const struct scene *s, struct vec3 *lo, struct vec3 *hi);

struct scene_size {
    size_t shapes, triangles, lights;
    size_t bytes; /* of meshes, and of Embree's structures once committed */
};
struct scene_size scene_size(const struct scene *s);

/** Builds what rays are traced with; the scene must have a shape and a
 * camera. */
bool scene_commit(struct scene *s, struct err *err);

#endif
