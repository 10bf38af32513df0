/* mitsuba_shape.c - <shape> elements
 *
 *   sphere       center, radius; to_world may turn, move and scale it evenly
 *   rectangle    [-1, 1]^2 in the plane z = 0, normal +z
 *   disk         of radius 1 there, likewise
 *   cube         [-1, 1]^3
 *   ply, obj     filename, face_normals
 *
 * all with to_world and flip_normals, a BSDF (diffuse if none is given) and
 * perhaps <emitter type="area">.  Where to_world mirrors, normals stay what
 * they are, except a sphere's, which turn around; as in Mitsuba 3.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "integrator/meshfile.h"
#include "integrator/mitsuba.h"

char *mitsuba_path(const struct loader *l, const char *name)
{
    const char *slash = strrchr(l->xml.path, '/');
    const int folder =
        slash && name[0] != '/' ? (int)(slash + 1 - l->xml.path) : 0;
    char *path = NULL;
    if (asprintf(&path, "%.*s%s", folder, l->xml.path, name) < 0)
        return NULL;
    return path;
}

/* A shape on its way. */
struct making {
    struct object o;
    struct affine world;
    struct surface surface;
    bool flipped;
    struct err why; /* what the scene said */
};

static void emission(struct making *s)
{
    const xmlNode *node = object_child(&s->o, "emitter");
    struct object *e = node && !s->o.failed ? malloc(sizeof *e) : NULL;
    if (!node || s->o.failed)
        return;
    if (!e) {
        object_fail(&s->o, node, "out of memory");
        return;
    }
    object_open(e, s->o.l, node, s->o.err);
    if (strcmp(e->type, "area") != 0)
        object_fail(e, node, "type=\"%.60s\": expected area", e->type);
    s->surface.radiance = object_radiance(e, "radiance", 1);
    s->o.failed |= !object_close(e);
    free(e);
}

static void material(struct making *s)
{
    const xmlNode *node = object_child(&s->o, "bsdf");
    if (s->o.failed)
        return;
    s->surface.bsdf = node
                          ? mitsuba_bsdf(s->o.l, node, s->o.err)
                          : loader_bsdf(s->o.l, s->o.node, "diffuse", s->o.err);
    s->o.failed = s->surface.bsdf < 0;
}

static struct vec3 point(const struct making *s, double x, double y, double z)
{
    return affine_point(&s->world, (struct vec3){ x, y, z });
}

static struct vec3 vector(const struct making *s, double x, double y, double z)
{
    return affine_vector(&s->world, (struct vec3){ x, y, z });
}

/* Whether the two sides of a flat shape change places so that their product is
 * its normal. */
static bool swaps(const struct making *s)
{
    return (affine_det(&s->world) < 0) != s->flipped;
}

static bool rectangle(struct making *s)
{
    const struct vec3 u = vector(s, 2, 0, 0), v = vector(s, 0, 2, 0);
    const bool swap = swaps(s);
    return scene_add_rectangle(s->o.l->scene, point(s, -1, -1, 0), swap ? v : u,
                               swap ? u : v, &s->surface, &s->why);
}

static bool disk(struct making *s)
{
    const struct vec3 u = vector(s, 1, 0, 0), v = vector(s, 0, 1, 0);
    const bool swap = swaps(s);
    return scene_add_disk(s->o.l->scene, point(s, 0, 0, 0), swap ? v : u,
                          swap ? u : v, &s->surface, &s->why);
}

/* Corner i is at -1 or 1 by the bits of i: x, y, z. */
static bool cube(struct making *s)
{
    static const unsigned sides[6][4] = { { 0, 4, 6, 2 }, { 1, 3, 7, 5 },
                                          { 0, 1, 5, 4 }, { 2, 6, 7, 3 },
                                          { 0, 2, 3, 1 }, { 4, 5, 7, 6 } };
    struct mesh *m = mesh_new(8, 12, false, &s->why);
    const bool swap = swaps(s);
    if (!m)
        return false;
    for (int i = 0; i < 8; i++) {
        const struct vec3 p =
            point(s, i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        m->xyz[3 * i] = (float)p.x;
        m->xyz[3 * i + 1] = (float)p.y;
        m->xyz[3 * i + 2] = (float)p.z;
    }
    for (int i = 0; i < 12; i++) {
        const unsigned *side = sides[i / 2];
        const unsigned b = side[1 + i % 2], c = side[2 + i % 2];
        m->index[3 * i] = side[0];
        m->index[3 * i + 1] = swap ? c : b;
        m->index[3 * i + 2] = swap ? b : c;
    }
    return scene_add_mesh(s->o.l->scene, m, &s->surface, &s->why);
}

/* Whether the transform leaves a sphere one: columns of one length at right
 * angles. */
static bool even(const struct making *s)
{
    const struct vec3 x = vector(s, 1, 0, 0), y = vector(s, 0, 1, 0);
    const struct vec3 z = vector(s, 0, 0, 1);
    const double r2 = vec3_dot(x, x), limit = 1e-5 * r2;
    return fabs(vec3_dot(y, y) - r2) <= limit &&
           fabs(vec3_dot(z, z) - r2) <= limit &&
           fabs(vec3_dot(x, y)) <= limit && fabs(vec3_dot(y, z)) <= limit &&
           fabs(vec3_dot(z, x)) <= limit;
}

static bool sphere(struct making *s)
{
    const struct vec3 c =
        object_point(&s->o, "center", (struct vec3){ 0, 0, 0 });
    const double radius = object_float(&s->o, "radius", 1);
    if (!object_close(&s->o))
        return false;
    if (!even(s))
        return object_fail(&s->o, s->o.node,
                           "to_world makes it no sphere: expected the same "
                           "scale in all directions, and right angles");
    return scene_add_sphere(s->o.l->scene, affine_point(&s->world, c),
                            radius * vec3_length(vector(s, 1, 0, 0)), swaps(s),
                            &s->surface, &s->why);
}

static bool file(struct making *s)
{
    const xmlNode *node = s->o.node;
    const char *name = object_string(&s->o, "filename", NULL);
    const struct meshfile_options how = {
        .to_world = s->world,
        .face_normals = object_flag(&s->o, "face_normals", false),
        .flip_normals = s->flipped,
    };
    if (!name)
        object_fail(&s->o, node, "expected <string name=\"filename\">");
    if (!object_close(&s->o))
        return false;
    char *path = mitsuba_path(s->o.l, name);
    if (!path)
        return err_set(&s->why, "out of memory");
    struct mesh *m = meshfile_read(path, &how, &s->why);
    if (m && !loader_budget(s->o.l, node, m->vertices, m->triangles, path,
                            s->o.err)) {
        s->o.failed = true;
        mesh_free(m);
        m = NULL;
    }
    free(path);
    return m && scene_add_mesh(s->o.l->scene, m, &s->surface, &s->why);
}

static const struct shape_kind {
    const char *name;
    bool (*add)(struct making *s);
    bool more; /* it has settings of its own, and looks for unknown ones */
} kinds[] = {
    { "sphere", sphere, true }, { "rectangle", rectangle, false },
    { "disk", disk, false },    { "cube", cube, false },
    { "ply", file, true },      { "obj", file, true },
};

enum { KINDS = sizeof kinds / sizeof *kinds };

static const struct shape_kind *kind_of(struct making *s)
{
    const char *names[KINDS + 1] = { NULL };
    for (int i = 0; i < KINDS; i++) {
        names[i] = kinds[i].name;
        if (strcmp(s->o.type, names[i]) == 0)
            return &kinds[i];
    }
    err_unknown(&s->why, "shape", s->o.type, names);
    return NULL;
}

static bool make(struct making *s)
{
    char name[128];
    const char *id = xml_get(s->o.node, "id");
    const struct shape_kind *kind = kind_of(s);
    if (!kind)
        return loader_unknown(s->o.l, s->o.node, s->o.err, s->why.text);
    snprintf(name, sizeof name, "%.60s%s%.60s", s->o.type, id ? " " : "",
             id ? id : "");
    s->surface = (struct surface){ .name = name };
    s->world = object_transform(&s->o, "to_world");
    s->flipped = object_flag(&s->o, "flip_normals", false);
    emission(s);
    material(s);
    if (s->o.failed || (!kind->more && !object_close(&s->o)))
        return false;
    if (kind->add(s))
        return true;
    return object_fail(&s->o, s->o.node, "%s", s->why.text);
}

bool mitsuba_shape(struct loader *l, const xmlNode *node, struct err *err)
{
    struct making *s = calloc(1, sizeof *s);
    if (!s)
        return xml_fail(node, err, "out of memory");
    object_open(&s->o, l, node, err);
    const bool ok = !s->o.failed && make(s);
    free(s);
    return ok;
}
