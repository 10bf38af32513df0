/* mitsuba_bsdf.c - <bsdf> elements as specs
 *
 * Types and settings are the models' own, by the names that they share with
 * Mitsuba 3.  A model inside another needs no name: they count as front and
 * back of twosided, as bsdf_0 and bsdf_1 of blendbsdf.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "integrator/mitsuba.h"

enum { NESTED_MAX = 8, SPEC_MAX = 4000 };

/* A text that grows. */
struct spec {
    char text[SPEC_MAX];
    size_t used;
};

static bool add(struct object *o, const xmlNode *node, struct spec *s,
                const char *text)
{
    const size_t n = strlen(text);
    if (s->used + n >= sizeof s->text)
        return object_fail(o, node,
                           "it comes to a spec of more than %d characters",
                           SPEC_MAX - 1);
    memcpy(s->text + s->used, text, n + 1);
    s->used += n;
    return true;
}

static bool add_quoted(struct object *o, const xmlNode *node, struct spec *s,
                       const char *text)
{
    bool ok = add(o, node, s, "'");
    for (const char *p = text; ok && *p; p++)
        ok = add(o, node, s, *p == '\'' ? "''" : (char[]){ *p, '\0' });
    return ok && add(o, node, s, "'");
}

static const struct bsdf_type *type_find(struct object *o)
{
    const char *names[65] = { NULL };
    struct err why;
    for (int i = 0; bsdf_types[i] && i < 64; i++) {
        names[i] = bsdf_types[i]->name;
        if (strcmp(o->type, names[i]) == 0)
            return bsdf_types[i];
    }
    err_unknown(&why, "BSDF", o->type, names);
    object_fail(o, o->node, "%s", why.text);
    return NULL;
}

/* One to three numbers as one or three bands. */
static bool add_colour(struct object *o, const xmlNode *node, struct spec *s)
{
    double value[3];
    struct spectrum checked;
    const int n = object_values(o, node, value);
    if (n == 0)
        return false;
    if (!loader_spectrum(o->l, node, value, n, &checked, o->err)) {
        o->failed = true;
        return false;
    }
    const bool grey = n == 1 || (value[0] == value[1] && value[0] == value[2]);
    for (int i = 0; i < (grey ? 1 : 3); i++) {
        char text[40];
        snprintf(text, sizeof text, "%s%.17g", i ? "/" : "", value[i]);
        if (!add(o, node, s, text))
            return false;
    }
    return true;
}

/* Which elements a setting may be written as. */
static const char *const *elements(enum bsdf_param_kind kind)
{
    static const char *const number[] = { "float", "integer", NULL };
    static const char *const spectrum[] = { "rgb", "spectrum", "float", NULL };
    static const char *const flag[] = { "boolean", NULL };
    static const char *const choice[] = { "string", NULL };
    static const char *const string[] = { "string", "float", "integer", NULL };
    static const char *const none[] = { NULL };
    switch (kind) {
    case BSDF_NUMBER:
        return number;
    case BSDF_SPECTRUM:
        return spectrum;
    case BSDF_FLAG:
        return flag;
    case BSDF_CHOICE:
        return choice;
    case BSDF_STRING:
        return string;
    case BSDF_NESTED:
        break;
    }
    return none;
}

static bool add_value(struct object *o, const xmlNode *node,
                      const struct bsdf_param *p, struct spec *s)
{
    const char *const *e = elements(p->kind);
    const char *value = xml_get(node, "value");
    while (*e && !xml_is(node, *e))
        e++;
    if (!*e)
        return object_fail(o, node, "expected <%s name=\"%s\">",
                           elements(p->kind)[0] ? elements(p->kind)[0] : "bsdf",
                           p->key);
    if (!value)
        return object_fail(o, node, "expected value=");
    return p->kind == BSDF_SPECTRUM ? add_colour(o, node, s)
                                    : add_quoted(o, node, s, value);
}

static bool add_spec(struct loader *l, const xmlNode *node, struct spec *s,
                     int depth, struct err *err);

static bool add_setting(struct object *o, const struct bsdf_param *p,
                        struct spec *s, int *settings, int depth)
{
    const xmlNode *node = object_part(o, p->key);
    bool nested = false;
    if (p->kind == BSDF_NESTED && (!node || xml_is(node, "bsdf"))) {
        node = node ? node : object_child(o, "bsdf");
        nested = true;
    }
    if (o->failed || !node)
        return !o->failed;
    if (!add(o, node, s, (*settings)++ ? "," : ":") ||
        !add(o, node, s, p->key) || !add(o, node, s, "="))
        return false;
    if (!nested)
        return add_value(o, node, p, s);
    if (!add(o, node, s, "("))
        return false;
    if (!add_spec(o->l, node, s, depth + 1, o->err)) {
        o->failed = true;
        return false;
    }
    return add(o, node, s, ")");
}

static bool add_spec(struct loader *l, const xmlNode *node, struct spec *s,
                     int depth, struct err *err)
{
    if (depth > NESTED_MAX)
        return xml_fail(node, err,
                        "models nest more than %d deep: expected none that "
                        "refers to itself",
                        NESTED_MAX);
    struct object *o = malloc(sizeof *o);
    if (!o)
        return xml_fail(node, err, "out of memory");
    object_open(o, l, node, err);
    const struct bsdf_type *type = o->failed ? NULL : type_find(o);
    int settings = 0;
    bool ok = type && add(o, node, s, type->name);
    for (const struct bsdf_param *p = type ? type->params : NULL; ok && p->key;
         p++)
        ok = add_setting(o, p, s, &settings, depth);
    ok = ok && object_close(o);
    free(o);
    return ok;
}

int mitsuba_bsdf(struct loader *l, const xmlNode *node, struct err *err)
{
    struct spec *s = calloc(1, sizeof *s);
    int bsdf = -1;
    if (!s)
        xml_fail(node, err, "out of memory");
    else if (add_spec(l, node, s, 0, err))
        bsdf = loader_bsdf(l, node, s->text, err);
    free(s);
    return bsdf;
}
