/* scene_parts.h - what a scene is made of, for the files that build and trace
 */
#ifndef INTEGRATOR_SCENE_PARTS_H
#define INTEGRATOR_SCENE_PARTS_H

#include <embree3/rtcore.h>
#include <stdint.h>

#include "integrator/scene.h"

enum shape_kind { SHAPE_MESH, SHAPE_SPHERE, SHAPE_DISK };

struct shape {
    enum shape_kind kind;
    struct surface surface; /* its name is owned */
    const struct bsdf *bsdf;
    struct bsdf_claims claims;
    unsigned flags; /* of enum shape_flag */
    int light;      /* its number among the lights, or -1 */

    struct mesh *mesh;
    struct vec3 center; /* of a sphere or disk; a rectangle's corner */
    struct vec3 u, v;   /* a disk's radii, a rectangle's sides */
    struct vec3 normal; /* of a disk or rectangle, unit */
    double radius;      /* of a sphere */
    double area;
    double reach;      /* its largest coordinate */
    double *cumulated; /* a light's triangles' areas; mesh.triangles of them */
};

enum shape_flag {
    SHAPE_FLIPPED = 1,   /* a sphere's normal points inward */
    SHAPE_RECTANGLE = 2, /* a mesh whose corner, u and v are known */
    SHAPE_EMITS = 4
};

/* Something to sample: a shape, or a light that is none. */
struct light_source {
    int shape; /* or -1 */
    struct light light;
    double area;
    struct vec3 normal;
};

struct scene {
    struct bands bands;
    struct bsdf **bsdf;
    size_t bsdfs, bsdfs_room;
    void *by_spec; /* a tree of struct named */
    struct shape *shape;
    size_t shapes, shapes_room;
    struct light_source *light;
    size_t lights, lights_room;
    struct camera camera;
    bool has_camera;
    struct scene_wishes wishes;
    struct vec3 lo, hi;           /* lo.x > hi.x: nothing yet */
    struct vec3 glow_lo, glow_hi; /* of what emits, likewise; once committed
                                     with room for Embree's rounding */

    RTCDevice device;
    RTCScene embree;
    int64_t bytes_embree; /* as Embree reports it */
};

#endif
