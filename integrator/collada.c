/* collada.c - scenes of COLLADA 1.4 as the course's programs read them
 *
 * What is read of a document:
 *   asset/up_axis       Z_UP is turned by (x, y, z) -> (-x, z, y); Y_UP is not
 *   visual_scene        nodes with one <matrix> of 16 numbers, row by row,
 *                       children, and instances of nodes, geometry, lights and
 *                       cameras
 *   geometry            <mesh> of <polylist> or <triangles>, of which positions
 *                       alone count, or the technique CGL's <sphere>
 *   effect              the technique CGL's model (collada_effect.c), else the
 *                       diffuse colour of <phong> and its like
 *   light               CGL's <area>, <ambient>, <point>
 *   camera              <perspective>: xfov, znear, zfar
 *
 * Normals are the sum of those of the triangles around, weighted by area.
 *
 * The camera looks at the middle of the scene's box from 1.5 diagonals away, in
 * the direction of M (0, 0, -1, 1), the translation included; +y is up.
 *
 * An area light's corners are its position +- dim / 2 with dim_x = M (-1, 0, 0)
 * - position, dim_y = M (0, 1, 0) - position, and it faces M (0, 0, -1) -
 * position.  Beside it the course's scenes have a mesh that glows: that mesh is
 * the light, and <area> counts only where there is none in its place; with
 * COMPAT_LIGHT_QUAD it is the other way round.
 */
#include <float.h>
#include <libxml/hash.h>
#include <stdlib.h>
#include <string.h>

#include "integrator/collada_effect.h"
#include "integrator/loader.h"

enum { NODES_MAX = 1 << 16, LIGHTS_MAX = 1024, GLOWING_MAX = 1024 };

/* A quadrilateral that emits, its place in the document with it. */
struct area {
    const xmlNode *node;
    struct vec3 center, x, y, dir;
    double rgb[3];
};

/* A mesh that emits. */
struct glowing {
    struct vec3 lo, hi;
    const double *rgb;
};

struct dae {
    struct loader *l;
    struct affine up; /* from the document's axes to ours */
    size_t nodes;     /* visited, instances included */
    struct area area[LIGHTS_MAX];
    int areas;
    struct glowing glowing[GLOWING_MAX];
    double glow[GLOWING_MAX][3];
    int glowings;
    const xmlNode *camera, *camera_node;
    struct affine camera_world;
};

/* The element of this name that a URL such as "#x" points to. */
static const xmlNode *pointed(const struct dae *d, const xmlNode *from,
                              const char *attribute, const char *name,
                              struct err *err)
{
    const char *url = xml_get(from, attribute);
    if (!url || url[0] != '#') {
        xml_fail(from, err, "%s=\"%.60s\": expected # and the id of a <%s>",
                 attribute, url ? url : "", name);
        return NULL;
    }
    const xmlNode *to = xmlHashLookup(d->l->ids, (const xmlChar *)url + 1);
    if (!to)
        xml_fail(from, err, "%s=\"%.60s\": there is no such <%s>", attribute,
                 url, name);
    else if (!xml_is(to, name)) {
        xml_fail(from, err, "%s=\"%.60s\" is a <%s>: expected a <%s>",
                 attribute, url, (const char *)to->name, name);
        to = NULL;
    }
    return to;
}

/* The numbers of an element's text. */
static bool reals(const xmlNode *node, double *value, size_t count,
                  struct err *err)
{
    struct xml_numbers n;
    return xml_numbers(node, &n, err) && xml_reals(&n, value, count, err);
}

/* -- meshes -- */

/* Numbers, as many as there are. */
struct floats {
    float *at;
    size_t count;
};

struct counts {
    unsigned *at;
    size_t count;
};

/* Room for one more element of 4 bytes; sizes are powers of two. */
static bool room(void **at, size_t count, const xmlNode *node, struct err *err)
{
    if (count & (count - 1))
        return true;
    void *larger = realloc(*at, (count ? 2 * count : 1) * 4);
    if (!larger)
        return xml_fail(node, err, "out of memory for %zu numbers", 2 * count);
    *at = larger;
    return true;
}

static bool floats_read(const xmlNode *node, struct floats *f, struct err *err)
{
    struct xml_numbers n;
    if (!xml_numbers(node, &n, err))
        return false;
    while (!xml_numbers_end(&n)) {
        double value;
        if (!xml_real(&n, &value, err) ||
            !room((void **)&f->at, f->count, node, err))
            return false;
        if (!(fabs(value) <= (double)FLT_MAX))
            return xml_fail(node, err,
                            "number %zu is %g: expected one that a float can "
                            "hold",
                            n.count, value);
        f->at[f->count++] = (float)value;
    }
    return true;
}

static bool counts_read(const xmlNode *node, struct counts *c, struct err *err)
{
    struct xml_numbers n;
    if (!xml_numbers(node, &n, err))
        return false;
    while (!xml_numbers_end(&n)) {
        unsigned value;
        if (!xml_count(&n, &value, err) ||
            !room((void **)&c->at, c->count, node, err))
            return false;
        c->at[c->count++] = value;
    }
    return true;
}

/* What an element says that there is must be there: nothing is believed. */
static bool claim(const xmlNode *node, size_t there, const char *what,
                  struct err *err)
{
    const char *count = xml_get(node, "count");
    char *end = NULL;
    if (!count)
        return true;
    const unsigned long long claimed = strtoull(count, &end, 10);
    if (end == count || *end || claimed != there)
        return xml_fail(node, err, "count=\"%.40s\", but there are %zu %s",
                        count, there, what);
    return true;
}

/* The element inside of one kind whose semantic is this. */
static const xmlNode *input(const xmlNode *node, const char *semantic)
{
    for (const xmlNode *n = xml_first(node); n; n = xml_next(n)) {
        const char *s = xml_is(n, "input") ? xml_get(n, "semantic") : NULL;
        if (s && strcmp(s, semantic) == 0)
            return n;
    }
    return NULL;
}

static bool positions(const struct dae *d, const xmlNode *polygons,
                      struct floats *f, struct err *err)
{
    const xmlNode *vertex = input(polygons, "VERTEX");
    if (!vertex)
        return xml_fail(polygons, err,
                        "expected an <input semantic=\"VERTEX\">");
    const xmlNode *vertices = pointed(d, vertex, "source", "vertices", err);
    if (!vertices)
        return false;
    const xmlNode *position = input(vertices, "POSITION");
    if (!position)
        return xml_fail(vertices, err,
                        "expected an <input semantic=\"POSITION\">");
    const xmlNode *source = pointed(d, position, "source", "source", err);
    if (!source)
        return false;
    const xmlNode *array = xml_child(source, "float_array");
    if (!array)
        return xml_fail(source, err, "expected a <float_array>");
    if (!floats_read(array, f, err) || !claim(array, f->count, "numbers", err))
        return false;
    const xmlNode *common = xml_child(source, "technique_common");
    const xmlNode *accessor = common ? xml_child(common, "accessor") : NULL;
    const char *stride = accessor ? xml_get(accessor, "stride") : NULL;
    if (stride && strcmp(stride, "3") != 0)
        return xml_fail(accessor, err, "stride=\"%.40s\": expected 3", stride);
    if (f->count % 3)
        return xml_fail(array, err,
                        "%zu numbers: expected a multiple of 3, x, y and z",
                        f->count);
    return !accessor || claim(accessor, f->count / 3, "positions", err);
}

/* Numbers to a corner, and which of them is the position. */
static bool strides(const xmlNode *polygons, unsigned *stride, unsigned *at,
                    struct err *err)
{
    *stride = *at = 0;
    for (const xmlNode *n = xml_first(polygons); n; n = xml_next(n)) {
        if (!xml_is(n, "input"))
            continue;
        const char *text = xml_get(n, "offset");
        const char *semantic = xml_get(n, "semantic");
        char *end = NULL;
        const unsigned long offset = text ? strtoul(text, &end, 10) : 0;
        if (text && (end == text || *end || offset > 15))
            return xml_fail(n, err,
                            "offset=\"%.40s\": expected a number from 0 to 15",
                            text);
        if (offset + 1 > *stride)
            *stride = (unsigned)offset + 1;
        if (semantic && strcmp(semantic, "VERTEX") == 0)
            *at = (unsigned)offset;
    }
    return true;
}

/* Corners of each polygon; all 3 where there is no <vcount>. */
static bool corners(const xmlNode *polygons, struct counts *vcount,
                    size_t *total, size_t *triangles, struct err *err)
{
    const xmlNode *node = xml_child(polygons, "vcount");
    *total = *triangles = 0;
    if (!node)
        return xml_fail(polygons, err, "expected a <vcount>");
    if (!counts_read(node, vcount, err) ||
        !claim(polygons, vcount->count, "polygons", err))
        return false;
    for (size_t i = 0; i < vcount->count; i++) {
        if (vcount->at[i] < 3)
            return xml_fail(node, err,
                            "polygon %zu has %u corners: expected at least 3",
                            i + 1, vcount->at[i]);
        *total += vcount->at[i];
        *triangles += vcount->at[i] - 2;
    }
    return true;
}

/* The corners of a <polylist> or <triangles> as triangles around the first. */
static bool indices(const xmlNode *polygons, struct counts *out,
                    struct err *err)
{
    struct counts vcount = { 0 }, p = { 0 };
    unsigned stride, at;
    size_t total = 0, triangles = 0, from = 0;
    bool ok = false;
    const bool list = xml_is(polygons, "polylist");
    const xmlNode *node = xml_child(polygons, "p");
    if (!node) {
        xml_fail(polygons, err, "expected a <p>");
        goto done;
    }
    if (!strides(polygons, &stride, &at, err) || !counts_read(node, &p, err) ||
        (list && !corners(polygons, &vcount, &total, &triangles, err)))
        goto done;
    if (!list) {
        triangles = p.count / (3 * (size_t)stride);
        total = 3 * triangles;
        if (!claim(polygons, triangles, "triangles", err))
            goto done;
    }
    if (p.count != total * stride) {
        xml_fail(node, err,
                 "it has %zu numbers: expected %zu, %u for each of %zu corners",
                 p.count, total * stride, stride, total);
        goto done;
    }
    out->at = malloc((3 * triangles + 1) * sizeof *out->at);
    if (!out->at) {
        xml_fail(node, err, "out of memory for %zu triangles", triangles);
        goto done;
    }
    for (size_t i = 0, k = 0; k < triangles; i++) {
        const unsigned n = list ? vcount.at[i] : 3;
        for (unsigned c = 1; c + 1 < n; c++, k++) {
            const size_t corner[] = { from, from + c, from + c + 1 };
            for (int j = 0; j < 3; j++)
                out->at[out->count++] = p.at[corner[j] * stride + at];
        }
        from += n;
    }
    ok = true;
done:
    free(vcount.at);
    free(p.at);
    return ok;
}

static struct mesh *mesh_make(struct dae *d, const xmlNode *polygons,
                              const struct floats *f, const struct counts *c,
                              const struct affine *world, struct err *err)
{
    struct err why;
    if (!loader_budget(d->l, polygons, f->count / 3, c->count / 3, NULL, err))
        return NULL;
    struct mesh *m = mesh_new(f->count / 3, c->count / 3, false, &why);
    if (!m) {
        xml_fail(polygons, err, "%s", why.text);
        return NULL;
    }
    for (size_t i = 0; i < m->vertices; i++) {
        const float *p = f->at + 3 * i;
        const struct vec3 w = affine_point(
            world, (struct vec3){ (double)p[0], (double)p[1], (double)p[2] });
        m->xyz[3 * i] = (float)w.x;
        m->xyz[3 * i + 1] = (float)w.y;
        m->xyz[3 * i + 2] = (float)w.z;
    }
    memcpy(m->index, c->at, 3 * m->triangles * sizeof *m->index);
    if (mesh_check(m, "the mesh", &why) && mesh_smooth(m, &why))
        return m;
    xml_fail(polygons, err, "%s", why.text);
    mesh_free(m);
    return NULL;
}

/* What a surface shows of itself, read from its effect. */
static bool surface_make(struct dae *d, const xmlNode *instance,
                         const struct collada_effect *e,
                         struct surface *surface, struct err *err)
{
    *surface = (struct surface){
        .bsdf = loader_bsdf(d->l, e->node ? e->node : instance, e->spec, err),
        .both_sides = true,
        .unsampled = d->l->options->compat & COMPAT_LIGHT_QUAD,
        .name = xml_get(instance, "url"),
    };
    return surface->bsdf >= 0 &&
           loader_spectrum(d->l, e->node ? e->node : instance, e->radiance, 3,
                           &surface->radiance, err);
}

/* Remembers a mesh that emits, to be compared with area lights. */
static void remember(struct dae *d, const struct mesh *m, const double *rgb)
{
    if (d->glowings == GLOWING_MAX ||
        (rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0))
        return;
    struct vec3 lo = { INFINITY, INFINITY, INFINITY };
    struct vec3 hi = { -INFINITY, -INFINITY, -INFINITY };
    for (size_t i = 0; i < m->vertices; i++) {
        const float *p = m->xyz + 3 * i;
        lo = (struct vec3){ fmin(lo.x, (double)p[0]), fmin(lo.y, (double)p[1]),
                            fmin(lo.z, (double)p[2]) };
        hi = (struct vec3){ fmax(hi.x, (double)p[0]), fmax(hi.y, (double)p[1]),
                            fmax(hi.z, (double)p[2]) };
    }
    memcpy(d->glow[d->glowings], rgb, sizeof d->glow[0]);
    d->glowing[d->glowings] = (struct glowing){ lo, hi, d->glow[d->glowings] };
    d->glowings++;
}

/* The effect that a symbol of the geometry is bound to; an only binding is for
 * every symbol. */
static const xmlNode *bound(const struct dae *d, const xmlNode *instance,
                            const char *symbol, struct err *err)
{
    const xmlNode *bind = xml_child(instance, "bind_material");
    const xmlNode *common = bind ? xml_child(bind, "technique_common") : NULL;
    const xmlNode *found = NULL;
    int bindings = 0;
    for (const xmlNode *n = common ? xml_first(common) : NULL; n;
         n = xml_next(n)) {
        if (!xml_is(n, "instance_material"))
            continue;
        const char *s = xml_get(n, "symbol");
        bindings++;
        if (!found || (s && symbol && strcmp(s, symbol) == 0))
            found = n;
    }
    const char *s = found ? xml_get(found, "symbol") : NULL;
    if (!found || (bindings > 1 && !(s && symbol && strcmp(s, symbol) == 0))) {
        xml_fail(instance, err,
                 "expected a <bind_material> for the symbol \"%.60s\"",
                 symbol ? symbol : "");
        return NULL;
    }
    const xmlNode *material = pointed(d, found, "target", "material", err);
    const xmlNode *use =
        material ? xml_child(material, "instance_effect") : NULL;
    if (material && !use)
        xml_fail(material, err, "expected an <instance_effect>");
    return use ? pointed(d, use, "url", "effect", err) : NULL;
}

static bool effect_of(const struct dae *d, const xmlNode *instance,
                      const char *symbol, struct collada_effect *e,
                      struct err *err)
{
    const xmlNode *effect = bound(d, instance, symbol, err);
    return effect && collada_effect(d->l, effect, e, err);
}

static bool polygons_add(struct dae *d, const xmlNode *instance,
                         const xmlNode *polygons, const struct affine *world,
                         struct err *err)
{
    struct collada_effect e;
    struct floats f = { 0 };
    struct counts c = { 0 };
    struct surface surface;
    struct err why;
    bool ok = effect_of(d, instance, xml_get(polygons, "material"), &e, err) &&
              surface_make(d, instance, &e, &surface, err) &&
              positions(d, polygons, &f, err) && indices(polygons, &c, err);
    struct mesh *m = ok ? mesh_make(d, polygons, &f, &c, world, err) : NULL;
    free(f.at);
    free(c.at);
    if (!m)
        return false;
    remember(d, m, e.radiance);
    return scene_add_mesh(d->l->scene, m, &surface, &why) ||
           xml_fail(polygons, err, "%s", why.text);
}

static bool mesh_add(struct dae *d, const xmlNode *instance,
                     const xmlNode *mesh, const struct affine *world,
                     struct err *err)
{
    static const char *const others[] = { "lines",   "linestrips", "polygons",
                                          "trifans", "tristrips",  NULL };
    int parts = 0;
    for (const xmlNode *n = xml_first(mesh); n; n = xml_next(n)) {
        if (xml_is(n, "polylist") || xml_is(n, "triangles")) {
            if (!polygons_add(d, instance, n, world, err))
                return false;
            parts++;
        }
        for (int i = 0; others[i]; i++)
            if (xml_is(n, others[i]) &&
                !loader_unknown(d->l, n, err,
                                "expected a <polylist> or <triangles>"))
                return false;
    }
    return parts || xml_fail(mesh, err, "expected a <polylist> or <triangles>");
}

static bool sphere_add(struct dae *d, const xmlNode *instance,
                       const xmlNode *sphere, const struct affine *world,
                       struct err *err)
{
    const xmlNode *node = xml_child(sphere, "radius");
    struct collada_effect e;
    struct surface surface;
    struct err why;
    double radius;
    if (!node)
        return xml_fail(sphere, err, "expected a <radius>");
    if (!reals(node, &radius, 1, err))
        return false;
    if (!(radius > 0))
        return xml_fail(node, err, "%g: expected a radius above 0", radius);
    const double scale =
        vec3_length(affine_vector(world, (struct vec3){ 1, 0, 0 }));
    return effect_of(d, instance, NULL, &e, err) &&
           surface_make(d, instance, &e, &surface, err) &&
           (scene_add_sphere(d->l->scene,
                             affine_point(world, (struct vec3){ 0, 0, 0 }),
                             scale * radius, false, &surface, &why) ||
            xml_fail(instance, err, "%s", why.text));
}

static bool geometry_add(struct dae *d, const xmlNode *instance,
                         const struct affine *world, struct err *err)
{
    const xmlNode *g = pointed(d, instance, "url", "geometry", err);
    if (!g)
        return false;
    const xmlNode *own = collada_cgl(g);
    const xmlNode *sphere = own ? xml_child(own, "sphere") : NULL;
    const xmlNode *mesh = xml_child(g, "mesh");
    if (sphere)
        return sphere_add(d, instance, sphere, world, err);
    return mesh ? mesh_add(d, instance, mesh, world, err)
                : xml_fail(g, err, "expected a <mesh>, or a <sphere> of CGL");
}

/* -- lights -- */

static bool colour(const xmlNode *light, double *rgb, struct err *err)
{
    const xmlNode *node = xml_child(light, "color");
    return node ? reals(node, rgb, 3, err)
                : xml_fail(light, err, "expected a <color>");
}

static bool area_add(struct dae *d, const xmlNode *light,
                     const struct affine *world, const double *rgb,
                     struct err *err)
{
    const struct vec3 p = affine_point(world, (struct vec3){ 0, 0, 0 });
    if (d->areas == LIGHTS_MAX)
        return xml_fail(light, err, "there are more than %d area lights",
                        LIGHTS_MAX);
    struct area a = {
        .node = light,
        .center = p,
        .x = affine_vector(world, (struct vec3){ -1, 0, 0 }),
        .y = affine_vector(world, (struct vec3){ 0, 1, 0 }),
        .dir = affine_vector(world, (struct vec3){ 0, 0, -1 }),
        .rgb = { rgb[0], rgb[1], rgb[2] },
    };
    const double area = vec3_length(vec3_cross(a.x, a.y));
    if (!(area > 0 && isfinite(area)))
        return xml_fail(light, err, "its area is %g: expected more than 0",
                        area);
    d->area[d->areas++] = a;
    return true;
}

static bool light_add(struct dae *d, const xmlNode *instance,
                      const struct affine *world, struct err *err)
{
    const xmlNode *node = pointed(d, instance, "url", "light", err);
    if (!node)
        return false;
    const xmlNode *own = collada_cgl(node);
    const xmlNode *common = xml_child(node, "technique_common");
    const xmlNode *kind = own ? xml_first(own) : NULL;
    if (!kind)
        kind = common ? xml_first(common) : NULL;
    if (!kind)
        return xml_fail(node, err, "expected a light in it");
    struct light light = { .kind = LIGHT_POINT };
    struct err why;
    double rgb[3];
    if (!colour(kind, rgb, err))
        return false;
    if (xml_is(kind, "area"))
        return area_add(d, kind, world, rgb, err);
    if (xml_is(kind, "ambient"))
        light.kind = LIGHT_HEMISPHERE;
    else if (xml_is(kind, "point"))
        light.position = affine_point(world, (struct vec3){ 0, 0, 0 });
    else
        return loader_unknown(d->l, kind, err,
                              "expected an area, ambient or point light");
    return loader_spectrum(d->l, kind, rgb, 3, &light.radiance, err) &&
           (scene_add_light(d->l->scene, &light, &why) ||
            xml_fail(kind, err, "%s", why.text));
}

/* Whether a mesh that emits lies in an area light's plane and over it, within a
 * hundredth of its size. */
static bool covers(const struct glowing *g, const struct area *a)
{
    const struct vec3 n = vec3_unit(vec3_cross(a->x, a->y));
    const double size = vec3_length(a->x) + vec3_length(a->y);
    const struct vec3 mid =
        vec3_minus(vec3_scale(.5, vec3_add(g->lo, g->hi)), a->center);
    const struct vec3 half = vec3_scale(.5, vec3_minus(g->hi, g->lo));
    const double thick =
        fabs(half.x * n.x) + fabs(half.y * n.y) + fabs(half.z * n.z);
    return fabs(vec3_dot(mid, n)) + thick <= .01 * size &&
           fabs(vec3_dot(mid, a->x)) <= .5 * vec3_dot(a->x, a->x) &&
           fabs(vec3_dot(mid, a->y)) <= .5 * vec3_dot(a->y, a->y);
}

/* The light's two sides, their product toward where it emits. */
static bool area_settle(struct dae *d, const struct area *a, struct err *err)
{
    const bool hidden = d->l->options->compat & COMPAT_LIGHT_QUAD;
    for (int i = 0; !hidden && i < d->glowings; i++) {
        const double *mesh = d->glowing[i].rgb;
        if (!covers(&d->glowing[i], a))
            continue;
        if (memcmp(mesh, a->rgb, sizeof a->rgb) != 0)
            loader_warn(d->l, a->node,
                        "it has the radiance %g %g %g, the mesh in its place, "
                        "which counts, %g %g %g",
                        a->rgb[0], a->rgb[1], a->rgb[2], mesh[0], mesh[1],
                        mesh[2]);
        return true;
    }
    const bool along = vec3_dot(vec3_cross(a->x, a->y), a->dir) >= 0;
    struct light light = {
        .kind = LIGHT_HIDDEN,
        .position = vec3_minus(a->center, vec3_scale(.5, vec3_add(a->x, a->y))),
        .u = along ? a->x : a->y,
        .v = along ? a->y : a->x,
    };
    struct err why;
    if (!loader_spectrum(d->l, a->node, a->rgb, 3, &light.radiance, err))
        return false;
    if (hidden)
        return scene_add_light(d->l->scene, &light, &why) ||
               xml_fail(a->node, err, "%s", why.text);
    const struct surface surface = {
        .bsdf = loader_bsdf(d->l, a->node, "diffuse:reflectance=0", err),
        .radiance = light.radiance,
        .name = "area light",
    };
    return surface.bsdf >= 0 &&
           (scene_add_rectangle(d->l->scene, light.position, light.u, light.v,
                                &surface, &why) ||
            xml_fail(a->node, err, "%s", why.text));
}

/* -- the camera -- */

static bool perspective_read(const xmlNode *camera, double *xfov, double *near,
                             double *far, struct err *err)
{
    const xmlNode *at = camera;
    static const char *const path[] = { "optics", "technique_common",
                                        "perspective", NULL };
    for (int i = 0; path[i]; i++) {
        const xmlNode *below = xml_child(at, path[i]);
        if (!below)
            return xml_fail(at, err, "expected a <%s>", path[i]);
        at = below;
    }
    const struct {
        const char *name;
        double *value;
    } part[] = { { "xfov", xfov }, { "znear", near }, { "zfar", far } };
    for (int i = 0; i < 3; i++) {
        const xmlNode *n = xml_child(at, part[i].name);
        if (!n)
            return xml_fail(at, err, "expected a <%s>", part[i].name);
        if (!reals(n, part[i].value, 1, err))
            return false;
    }
    if (!(*xfov > 0 && *xfov < 180))
        return xml_fail(at, err, "xfov %g: expected above 0 and below 180",
                        *xfov);
    return (*near >= 0 && *far > *near) ||
           xml_fail(at, err, "znear %g, zfar %g: expected 0 <= znear < zfar",
                    *near, *far);
}

static bool camera_settle(struct dae *d, struct err *err)
{
    struct vec3 lo, hi;
    const struct load_options *o = d->l->options;
    struct camera c = { .width = o->width ? o->width : 800,
                        .height = o->height ? o->height : 600 };
    double xfov;
    if (!d->camera)
        return xml_fail(xmlDocGetRootElement(d->l->xml.doc), err,
                        "expected an <instance_camera> in the visual scene");
    if (!perspective_read(d->camera, &xfov, &c.near, &c.far, err))
        return false;
    if (!scene_box(d->l->scene, &lo, &hi))
        return xml_fail(d->camera_node, err, "there is nothing to see");
    const struct vec3 target = vec3_scale(.5, vec3_add(lo, hi));
    const struct vec3 to =
        affine_point(&d->camera_world, (struct vec3){ 0, 0, -1 });
    const double length = vec3_length(to);
    const struct vec3 position = vec3_add(
        target, vec3_scale(1.5 * vec3_length(vec3_minus(hi, lo)) / length, to));
    const int across = o->compat & COMPAT_CAMERA ? 800 : c.width;
    c.focal = across / 2. / tan(xfov * PI / 360);
    if (!affine_look_at(position, target, (struct vec3){ 0, 1, 0 },
                        &c.to_world))
        return xml_fail(d->camera_node, err,
                        "it looks along %g, %g, %g: expected a direction other "
                        "than straight up or down",
                        -to.x, -to.y, -to.z);
    scene_set_camera(d->l->scene, &c);
    return true;
}

/* -- nodes -- */

static bool matrix_read(const xmlNode *node, struct affine *a, struct err *err)
{
    double m[16];
    if (!reals(node, m, 16, err))
        return false;
    for (int i = 0; i < 16; i++)
        if (i < 12)
            a->m[i / 4][i % 4] = m[i];
        else if (m[i] != (i == 15))
            return xml_fail(node, err,
                            "the last row is %g %g %g %g: expected 0 0 0 1",
                            m[12], m[13], m[14], m[15]);
    return true;
}

/* Where a node's children are: in the world times its matrix. */
static bool transform(const xmlNode *node, struct affine *world,
                      struct err *err)
{
    const xmlNode *matrix = NULL;
    for (const xmlNode *n = xml_first(node); n; n = xml_next(n)) {
        static const char *const others[] = { "lookat", "rotate",    "scale",
                                              "skew",   "translate", NULL };
        for (int i = 0; others[i]; i++)
            if (xml_is(n, others[i]))
                return xml_fail(n, err, "expected a <matrix> in its place");
        if (!xml_is(n, "matrix"))
            continue;
        if (matrix)
            return xml_fail(n, err, "expected one <matrix> in a node");
        matrix = n;
    }
    struct affine own;
    if (!matrix)
        return true;
    if (!matrix_read(matrix, &own, err))
        return false;
    *world = affine_mul(*world, own);
    return true;
}

static bool node_add(struct dae *d, const xmlNode *node, struct affine world,
                     int depth, struct err *err)
{
    if (depth > XML_DEPTH_MAX)
        return xml_fail(node, err,
                        "nodes nest more than %d deep: expected no node that "
                        "contains itself",
                        XML_DEPTH_MAX);
    if (++d->nodes > NODES_MAX)
        return xml_fail(node, err, "there are more than %d instances of nodes",
                        NODES_MAX);
    if (!transform(node, &world, err))
        return false;
    for (const xmlNode *n = xml_first(node); n; n = xml_next(n)) {
        bool ok = true;
        if (xml_is(n, "node"))
            ok = node_add(d, n, world, depth + 1, err);
        else if (xml_is(n, "instance_geometry"))
            ok = geometry_add(d, n, &world, err);
        else if (xml_is(n, "instance_light"))
            ok = light_add(d, n, &world, err);
        else if (xml_is(n, "instance_node")) {
            const xmlNode *to = pointed(d, n, "url", "node", err);
            ok = to && node_add(d, to, world, depth + 1, err);
        } else if (xml_is(n, "instance_camera")) {
            d->camera = pointed(d, n, "url", "camera", err);
            d->camera_node = n;
            d->camera_world = world;
            ok = d->camera;
        } else if (!xml_is(n, "matrix") && !xml_is(n, "extra") &&
                   !xml_is(n, "asset"))
            ok = loader_unknown(d->l, n, err,
                                "expected a matrix, a node, or an instance of "
                                "a node, geometry, light or camera");
        if (!ok)
            return false;
    }
    return true;
}

static bool up_read(struct dae *d, const xmlNode *root, struct err *err)
{
    static const struct affine z_up = {
        { { -1, 0, 0, 0 }, { 0, 0, 1, 0 }, { 0, 1, 0, 0 } }
    };
    const xmlNode *asset = xml_child(root, "asset");
    const xmlNode *axis = asset ? xml_child(asset, "up_axis") : NULL;
    const xmlNode *text = axis ? axis->children : NULL;
    const char *name =
        text && text->type == XML_TEXT_NODE ? (const char *)text->content : "";
    d->up = affine_identity;
    if (!axis || strcmp(name, "Y_UP") == 0)
        return true;
    d->up = z_up;
    return strcmp(name, "Z_UP") == 0 ||
           xml_fail(axis, err, "\"%.40s\": expected Z_UP or Y_UP", name);
}

static bool document(struct dae *d, struct err *err)
{
    const xmlNode *root = xmlDocGetRootElement(d->l->xml.doc);
    if (!xml_is(root, "COLLADA"))
        return xml_fail(root, err, "expected <COLLADA>");
    const xmlNode *scene = xml_child(root, "scene");
    const xmlNode *use =
        scene ? xml_child(scene, "instance_visual_scene") : NULL;
    if (!use)
        return xml_fail(scene ? scene : root, err,
                        "expected a <scene> with an <instance_visual_scene>");
    const xmlNode *visual = pointed(d, use, "url", "visual_scene", err);
    if (!visual || !up_read(d, root, err))
        return false;
    for (const xmlNode *n = xml_first(visual); n; n = xml_next(n))
        if (xml_is(n, "node") && !node_add(d, n, d->up, 0, err))
            return false;
    if (!camera_settle(d, err))
        return false;
    for (int i = 0; i < d->areas; i++)
        if (!area_settle(d, &d->area[i], err))
            return false;
    return true;
}

bool collada_load(struct loader *l, struct err *err)
{
    struct dae *d = calloc(1, sizeof *d);
    if (!d)
        return err_set(err, "%s: out of memory", l->xml.path);
    d->l = l;
    const bool ok = document(d, err);
    free(d);
    return ok;
}
