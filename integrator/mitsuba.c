/* mitsuba.c - scenes in Mitsuba 3's format
 *
 * What is read of it, with Mitsuba's meaning and defaults:
 *   sensor       perspective, thinlens: fov, fov_axis, near_clip, far_clip,
 *                to_world, aperture_radius, focus_distance
 *   film         hdrfilm: width, height; <rfilter type="box"/> must be there,
 *                as the film's pixels are boxes and Mitsuba's else are not
 *   sampler      independent: sample_count
 *   integrator   path: max_depth, rr_depth
 *   shape        see mitsuba_shape.c
 *   emitter      area of a shape; constant; point
 *   bsdf         the models by name (mitsuba_bsdf.c)
 *   boolean      embree_use_robust_intersections, of the scene
 *   ref, default, $name
 *
 * Colours are <rgb> in linear sRGB.  An integrator's max_depth is a path's
 * length in edges, one more than its bounces; -1 is PATH_DEPTH_MAX bounces.
 */
#include <stdlib.h>
#include <string.h>

#include "integrator/mitsuba.h"
#include "integrator/path.h"

/* What is read before it is put together. */
struct reading {
    struct loader *l;
    struct err *err;
    struct scene_wishes wishes;
    bool camera, integrator;
};

/* Opens a part of an object that it may have once; false if it is not there. */
static bool sub_open(struct object *o, const char *element, struct object *sub)
{
    const xmlNode *node = o->failed ? NULL : object_child(o, element);
    if (!node)
        return false;
    object_open(sub, o->l, node, o->err);
    o->failed |= sub->failed;
    return !sub->failed;
}

static void sub_close(struct object *o, struct object *sub)
{
    o->failed |= !object_close(sub);
}

static void type_check(struct object *o, const char *type)
{
    if (strcmp(o->type, type) != 0)
        object_fail(o, o->node, "type=\"%.60s\": expected %s", o->type, type);
}

static void film(struct object *sensor, struct camera *c, struct object *sub)
{
    struct object *filter = malloc(sizeof *filter);
    static const char *const ignored[] = { "file_format", "pixel_format",
                                           "component_format", NULL };
    const struct load_options *options = sensor->l->options;
    c->width = 768, c->height = 576;
    if (filter && sub_open(sensor, "film", sub)) {
        type_check(sub, "hdrfilm");
        c->width = object_integer(sub, "width", c->width);
        c->height = object_integer(sub, "height", c->height);
        for (int i = 0; ignored[i]; i++)
            (void)object_string(sub, ignored[i], NULL);
        const bool there = sub_open(sub, "rfilter", filter);
        const char *type = there ? filter->type : "gaussian";
        if (!sub->failed && strcmp(type, "box") != 0)
            sub->failed = !loader_unknown(
                sensor->l, there ? filter->node : sub->node, sensor->err,
                "expected <rfilter type=\"box\"/>: the film's pixels are "
                "boxes");
        if (there && !sub->failed)
            sub_close(sub, filter);
        if (c->width < 1 || c->height < 1 || c->width > 65536 ||
            c->height > 65536)
            object_fail(sub, sub->node,
                        "%d x %d pixels: expected 1 to 65536 a side", c->width,
                        c->height);
        sub_close(sensor, sub);
    }
    c->width = options->width ? options->width : c->width;
    c->height = options->height ? options->height : c->height;
    free(filter);
}

static void sampler(struct object *sensor, int *samples, struct object *sub)
{
    if (!sub_open(sensor, "sampler", sub))
        return;
    type_check(sub, "independent");
    *samples = object_integer(sub, "sample_count", 4);
    (void)object_integer(sub, "seed", 0);
    if (*samples < 1)
        object_fail(sub, sub->node, "sample_count %d: expected at least 1",
                    *samples);
    sub_close(sensor, sub);
}

/* Pixels that the field of view spans. */
static double span(struct object *o, const struct camera *c)
{
    const double w = c->width, h = c->height;
    const char *axis = object_string(o, "fov_axis", "x");
    const struct {
        const char *name;
        double pixels;
    } axes[] = { { "x", w },
                 { "y", h },
                 { "smaller", fmin(w, h) },
                 { "larger", fmax(w, h) },
                 { "diagonal", hypot(w, h) } };
    for (int i = 0; i < 5; i++)
        if (strcmp(axes[i].name, axis) == 0)
            return axes[i].pixels;
    object_fail(o, o->node,
                "fov_axis \"%.60s\": expected x, y, smaller, larger or "
                "diagonal",
                axis);
    return w;
}

/* A camera's axes have length 1; what rounding left of that is taken away. */
static void axes_settle(struct object *o, struct affine *a)
{
    struct vec3 axis[3];
    for (int k = 0; k < 3; k++) {
        axis[k] = (struct vec3){ a->m[0][k], a->m[1][k], a->m[2][k] };
        const double length = vec3_length(axis[k]);
        if (!(fabs(length - 1) <= 1e-3)) {
            object_fail(o, o->node,
                        "to_world stretches by %g: expected no scale in a "
                        "camera's",
                        length);
            return;
        }
        axis[k] = vec3_unit(axis[k]);
        for (int i = 0; i < 3; i++)
            a->m[i][k] = ((double[]){ axis[k].x, axis[k].y, axis[k].z })[i];
    }
    for (int k = 0; k < 3; k++)
        if (!(fabs(vec3_dot(axis[k], axis[(k + 1) % 3])) <= 1e-3))
            object_fail(o, o->node,
                        "to_world skews: expected right angles in a camera's");
}

static void lens(struct object *o, struct camera *c)
{
    if (strcmp(o->type, "thinlens") != 0) {
        type_check(o, "perspective");
        return;
    }
    c->lens_radius = object_float(o, "aperture_radius", 0);
    c->focal_distance = object_float(o, "focus_distance", 0);
    if (!(c->lens_radius > 0 && c->focal_distance > 0))
        object_fail(o, o->node,
                    "expected an aperture_radius and a focus_distance above "
                    "0");
}

static bool sensor(struct reading *r, const xmlNode *node)
{
    struct object *o = malloc(2 * sizeof *o);
    struct camera c = { 0 };
    if (!o)
        return xml_fail(node, r->err, "out of memory");
    object_open(o, r->l, node, r->err);
    if (r->camera)
        object_fail(o, node, "expected one sensor");
    film(o, &c, &o[1]);
    sampler(o, &r->wishes.samples, &o[1]);
    lens(o, &c);
    const double fov = object_float(o, "fov", 0);
    if (!(fov > 0 && fov < 180))
        object_fail(o, node,
                    "fov %g: expected a <float name=\"fov\"> above 0 and below "
                    "180",
                    fov);
    c.near = object_float(o, "near_clip", 1e-2);
    c.far = object_float(o, "far_clip", 1e4);
    if (!(c.near > 0 && c.far > c.near))
        object_fail(o, node,
                    "near_clip %g, far_clip %g: expected 0 < near_clip < "
                    "far_clip",
                    c.near, c.far);
    c.focal = span(o, &c) / 2 / tan(fov * PI / 360);
    c.to_world = object_transform(o, "to_world");
    axes_settle(o, &c.to_world);
    const bool ok = object_close(o);
    if (ok)
        scene_set_camera(r->l->scene, &c);
    r->camera = true;
    free(o);
    return ok;
}

static bool integrator(struct reading *r, const xmlNode *node)
{
    struct object *o = malloc(sizeof *o);
    if (!o)
        return xml_fail(node, r->err, "out of memory");
    object_open(o, r->l, node, r->err);
    type_check(o, "path");
    const int depth = object_integer(o, "max_depth", -1);
    const int roulette = object_integer(o, "rr_depth", 5);
    if (r->integrator)
        object_fail(o, node, "expected one integrator");
    if (depth != -1 && depth < 1)
        object_fail(o, node, "max_depth %d: expected -1, or at least 1", depth);
    if (roulette < 1)
        object_fail(o, node, "rr_depth %d: expected at least 1", roulette);
    r->wishes.max_depth =
        depth == -1 || depth > PATH_DEPTH_MAX ? PATH_DEPTH_MAX : depth - 1;
    r->wishes.rr_depth = roulette < PATH_DEPTH_MAX ? roulette : PATH_DEPTH_MAX;
    r->integrator = true;
    const bool ok = object_close(o);
    free(o);
    return ok;
}

static void place(struct object *o, struct light *light)
{
    const struct affine a = object_transform(o, "to_world");
    light->kind = LIGHT_POINT;
    light->radiance = object_radiance(o, "intensity", 1);
    light->position =
        object_point(o, "position", affine_point(&a, (struct vec3){ 0, 0, 0 }));
}

static bool emitter(struct reading *r, const xmlNode *node)
{
    struct object *o = malloc(sizeof *o);
    struct light light = { .kind = LIGHT_CONSTANT };
    struct err why;
    if (!o)
        return xml_fail(node, r->err, "out of memory");
    object_open(o, r->l, node, r->err);
    const bool known =
        strcmp(o->type, "constant") == 0 || strcmp(o->type, "point") == 0;
    if (o->type[0] == 'c')
        light.radiance = object_radiance(o, "radiance", 1);
    else if (known)
        place(o, &light);
    bool ok = !o->failed;
    if (ok && !known)
        ok = loader_unknown(r->l, node, r->err,
                            "expected a constant or a point, or an area inside "
                            "a shape");
    else if (ok)
        ok = object_close(o) && (scene_add_light(r->l->scene, &light, &why) ||
                                 xml_fail(node, r->err, "%s", why.text));
    free(o);
    return ok;
}

/* What the scene itself has. */
static bool flag(struct reading *r, const xmlNode *n)
{
    const char *name = xml_get(n, "name"), *value = xml_get(n, "value");
    if (!name || strcmp(name, "embree_use_robust_intersections") != 0)
        return loader_unknown(r->l, n, r->err,
                              "expected embree_use_robust_intersections");
    return (value && mitsuba_truth(value, &r->wishes.robust)) ||
           xml_fail(n, r->err, "value=\"%.60s\": expected true or false",
                    value ? value : "");
}

static bool part(struct reading *r, const xmlNode *n)
{
    if (xml_is(n, "shape"))
        return mitsuba_shape(r->l, n, r->err);
    if (xml_is(n, "bsdf")) /* here it is checked, and used where referred to */
        return mitsuba_bsdf(r->l, n, r->err) >= 0;
    if (xml_is(n, "sensor"))
        return sensor(r, n);
    if (xml_is(n, "emitter"))
        return emitter(r, n);
    if (xml_is(n, "integrator"))
        return integrator(r, n);
    if (xml_is(n, "boolean"))
        return flag(r, n);
    return xml_is(n, "default") ||
           loader_unknown(r->l, n, r->err,
                          "expected integrator, sensor, bsdf, shape, emitter "
                          "or default");
}

bool mitsuba_load(struct loader *l, struct err *err)
{
    struct reading r = { .l = l, .err = err, .wishes = { -1, -1, -1, false } };
    const xmlNode *root = xmlDocGetRootElement(l->xml.doc);
    const char *version = xml_get(root, "version");
    if (!xml_is(root, "scene"))
        return xml_fail(root, err, "expected <scene>");
    if (!version || strncmp(version, "3.", 2) != 0)
        return xml_fail(root, err, "version=\"%.60s\": expected 3.0.0",
                        version ? version : "");
    if (!mitsuba_substitute(l, err))
        return false;
    for (const xmlNode *n = xml_first(root); n; n = xml_next(n))
        if (!part(&r, n))
            return false;
    if (!r.camera)
        return xml_fail(root, err, "expected a <sensor>");
    scene_set_wishes(l->scene, &r.wishes);
    return true;
}
