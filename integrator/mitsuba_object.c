/* mitsuba_object.c - elements and what is inside them */
#include "integrator/mitsuba.h"

#include <libxml/hash.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool object_fail(struct object *o, const xmlNode *node, const char *format, ...)
{
    struct err what;
    va_list args;
    if (o->failed)
        return false;
    va_start(args, format);
    vsnprintf(what.text, sizeof what.text, format, args);
    va_end(args);
    o->failed = true;
    return xml_fail(node, o->err, "%s", what.text);
}

void object_open(struct object *o, struct loader *l, const xmlNode *node,
                 struct err *err)
{
    const char *type = xml_get(node, "type");
    o->l = l;
    o->err = err;
    o->node = node;
    o->type = type ? type : "";
    o->failed = false;
    o->parts = 0;
    for (const xmlNode *n = xml_first(node); n; n = xml_next(n)) {
        const char *name = xml_get(n, "name");
        if (xml_is(n, "default"))
            continue;
        if (o->parts == OBJECT_PARTS_MAX) {
            object_fail(o, n, "expected at most %d elements in one",
                        OBJECT_PARTS_MAX);
            return;
        }
        for (int i = 0; name && i < o->parts; i++)
            if (strcmp(o->part[i].name, name) == 0)
                object_fail(o, n, "the name is given twice");
        o->part[o->parts++] =
            (struct object_part){ n, name ? name : "", false };
    }
}

bool object_close(struct object *o)
{
    for (int i = 0; i < o->parts && !o->failed; i++) {
        if (o->part[i].used)
            continue;
        char what[256];
        snprintf(what, sizeof what, "<%.60s> %s%.60s%s %s",
                 (const char *)o->node->name, o->type[0] ? "of type \"" : "",
                 o->type, o->type[0] ? "\":" : ":",
                 o->part[i].name[0] ? "it is unknown"
                                    : "it is unknown, or one too many");
        o->failed = !loader_unknown(o->l, o->part[i].node, o->err, what);
    }
    return !o->failed;
}

const xmlNode *object_part(struct object *o, const char *name)
{
    for (int i = 0; i < o->parts; i++)
        if (strcmp(o->part[i].name, name) == 0) {
            o->part[i].used = true;
            return o->part[i].node;
        }
    return NULL;
}

const xmlNode *object_child(struct object *o, const char *element)
{
    for (int i = 0; i < o->parts; i++) {
        const xmlNode *n = o->part[i].node;
        if (o->part[i].used)
            continue;
        if (xml_is(n, "ref")) {
            const char *id = xml_get(n, "id");
            n = id ? xmlHashLookup(o->l->ids, (const xmlChar *)id) : NULL;
            if (!n) {
                object_fail(o, o->part[i].node, "there is nothing of this id");
                return NULL;
            }
        }
        if (!xml_is(n, element))
            continue;
        o->part[i].used = true;
        return n;
    }
    return NULL;
}

/* The text of an attribute that must be there. */
static const char *text_of(struct object *o, const xmlNode *node,
                           const char *attribute)
{
    const char *text = xml_get(node, attribute);
    if (!text)
        object_fail(o, node, "expected %s=", attribute);
    return text ? text : "";
}

/* Up to count numbers of an attribute, white space or commas between them. */
static int numbers(struct object *o, const xmlNode *node, const char *attribute,
                   double *value, int count)
{
    struct xml_numbers n = { .node = node, .commas = true };
    struct err why;
    int read = 0;
    n.text = text_of(o, node, attribute);
    while (!o->failed && !xml_numbers_end(&n)) {
        if (read == count)
            object_fail(o, node, "%s=\"%.60s\": expected at most %d numbers",
                        attribute, xml_get(node, attribute), count);
        else if (!xml_real(&n, &value[read++], &why)) {
            o->failed = true;
            err_set(o->err, "%s", why.text);
        }
    }
    if (!o->failed && read == 0)
        object_fail(o, node, "%s=\"\": expected a number", attribute);
    return o->failed ? 0 : read;
}

int object_values(struct object *o, const xmlNode *node, double value[3])
{
    const int n = numbers(o, node, "value", value, 3);
    if (n == 2)
        object_fail(o, node, "value=\"%.60s\": expected one number or three",
                    xml_get(node, "value"));
    return o->failed ? 0 : n;
}

/* A number in an attribute, or a default if it is not there. */
static double attribute(struct object *o, const xmlNode *node, const char *name,
                        double def)
{
    double value = def;
    if (xml_get(node, name) && numbers(o, node, name, &value, 1) != 1)
        return def;
    return value;
}

/* The part of this name if it is one of two elements. */
static const xmlNode *typed(struct object *o, const char *name,
                            const char *element, const char *or_element)
{
    const xmlNode *n = o->failed ? NULL : object_part(o, name);
    if (!n || xml_is(n, element) || xml_is(n, or_element))
        return n;
    object_fail(o, n, "expected <%s name=\"%s\">", element, name);
    return NULL;
}

double object_float(struct object *o, const char *name, double def)
{
    const xmlNode *n = typed(o, name, "float", "integer");
    double value = def;
    if (!n || numbers(o, n, "value", &value, 1) != 1)
        return def;
    return value;
}

int object_integer(struct object *o, const char *name, int def)
{
    const xmlNode *n = typed(o, name, "integer", "integer");
    char *end = NULL;
    if (!n)
        return def;
    const char *text = text_of(o, n, "value");
    const long value = strtol(text, &end, 10);
    if (end == text || *end || value < -1000000000 || value > 1000000000) {
        object_fail(o, n, "value=\"%.60s\": expected a whole number", text);
        return def;
    }
    return (int)value;
}

bool mitsuba_truth(const char *text, bool *value)
{
    const bool yes = strcmp(text, "true") == 0;
    const bool known = yes || strcmp(text, "false") == 0;
    *value = known ? yes : *value;
    return known;
}

bool object_flag(struct object *o, const char *name, bool def)
{
    const xmlNode *n = typed(o, name, "boolean", "boolean");
    if (!n)
        return def;
    const char *text = text_of(o, n, "value");
    bool value = def;
    if (!mitsuba_truth(text, &value))
        object_fail(o, n, "value=\"%.60s\": expected true or false", text);
    return value;
}

const char *object_string(struct object *o, const char *name, const char *def)
{
    const xmlNode *n = typed(o, name, "string", "string");
    return n ? text_of(o, n, "value") : def;
}

/* x, y and z, or a value of three numbers, or, where one is enough, of one. */
static struct vec3 triple(struct object *o, const xmlNode *node,
                          struct vec3 def, bool one)
{
    double v[3];
    if (!xml_get(node, "value"))
        return (struct vec3){ attribute(o, node, "x", def.x),
                              attribute(o, node, "y", def.y),
                              attribute(o, node, "z", def.z) };
    const int n = object_values(o, node, v);
    if (n == 1 && one)
        return (struct vec3){ v[0], v[0], v[0] };
    if (n == 3)
        return (struct vec3){ v[0], v[1], v[2] };
    object_fail(o, node, "value=\"%.60s\": expected three numbers",
                xml_get(node, "value"));
    return def;
}

struct vec3 object_point(struct object *o, const char *name, struct vec3 def)
{
    const xmlNode *n = typed(o, name, "point", "vector");
    return n ? triple(o, n, (struct vec3){ 0, 0, 0 }, false) : def;
}

struct spectrum object_radiance(struct object *o, const char *name, double def)
{
    const xmlNode *n = o->failed ? NULL : object_part(o, name);
    struct spectrum s = spectrum_of(scene_bands(o->l->scene)->count, def);
    double value[3];
    if (!n)
        return s;
    if (!xml_is(n, "rgb") && !xml_is(n, "spectrum") && !xml_is(n, "float")) {
        object_fail(o, n, "expected <rgb name=\"%s\">", name);
        return s;
    }
    const int count = object_values(o, n, value);
    for (int i = 0; i < count; i++)
        if (!(value[i] >= 0))
            object_fail(o, n, "%g: expected at least 0", value[i]);
    if (!o->failed && !loader_spectrum(o->l, n, value, count, &s, o->err))
        o->failed = true;
    return s;
}

static struct vec3 vector_in(struct object *o, const xmlNode *node,
                             const char *name)
{
    double v[3] = { 0 };
    if (numbers(o, node, name, v, 3) != 3)
        object_fail(o, node, "%s=\"%.60s\": expected three numbers", name,
                    xml_get(node, name) ? xml_get(node, name) : "");
    return (struct vec3){ v[0], v[1], v[2] };
}

static struct affine matrix(struct object *o, const xmlNode *n)
{
    double m[16] = { 0 };
    struct affine a = affine_identity;
    const int count = numbers(o, n, "value", m, 16);
    if (count != 16)
        object_fail(o, n, "it has %d numbers: expected 16", count);
    else if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
        object_fail(o, n, "the last row is %g %g %g %g: expected 0 0 0 1",
                    m[12], m[13], m[14], m[15]);
    for (int i = 0; !o->failed && i < 12; i++)
        a.m[i / 4][i % 4] = m[i];
    return a;
}

static struct affine rotation(struct object *o, const xmlNode *n)
{
    const struct vec3 axis = triple(o, n, (struct vec3){ 0, 0, 0 }, false);
    if (!xml_get(n, "angle"))
        object_fail(o, n, "expected angle=");
    const double angle = attribute(o, n, "angle", 0);
    const double length = vec3_length(axis);
    if (length > 0 && isfinite(length))
        return affine_rotate(axis, angle);
    object_fail(o, n, "expected an axis other than 0, 0, 0");
    return affine_identity;
}

static struct affine look_at(struct object *o, const xmlNode *n)
{
    struct affine a = affine_identity;
    const struct vec3 origin = vector_in(o, n, "origin");
    const struct vec3 target = vector_in(o, n, "target");
    const struct vec3 up = vector_in(o, n, "up");
    if (!o->failed && !affine_look_at(origin, target, up, &a))
        object_fail(o, n,
                    "expected a target other than the origin, and up in "
                    "another direction");
    return a;
}

static struct affine step(struct object *o, const xmlNode *n)
{
    if (xml_is(n, "translate"))
        return affine_translate(triple(o, n, (struct vec3){ 0, 0, 0 }, false));
    if (xml_is(n, "scale"))
        return affine_scale(triple(o, n, (struct vec3){ 1, 1, 1 }, true));
    if (xml_is(n, "rotate"))
        return rotation(o, n);
    if (xml_is(n, "lookat"))
        return look_at(o, n);
    if (xml_is(n, "matrix"))
        return matrix(o, n);
    object_fail(o, n, "expected translate, scale, rotate, lookat or matrix");
    return affine_identity;
}

struct affine object_transform(struct object *o, const char *name)
{
    const xmlNode *t = typed(o, name, "transform", "transform");
    struct affine a = affine_identity;
    for (const xmlNode *n = t ? xml_first(t) : NULL; n && !o->failed;
         n = xml_next(n))
        a = affine_mul(step(o, n), a);
    const double det = affine_det(&a);
    if (!o->failed && !(isfinite(det) && det != 0))
        object_fail(o, t, "its determinant is %g: expected another than 0",
                    det);
    return a;
}
