/* collada_effect.c - the course's materials as models
 *
 *   <mirror>      an ideal mirror, on both sides
 *   <glass>       Fresnel's, or Schlick's with COMPAT_SCHLICK
 *   <refraction>  no reflection, and nothing beyond the critical angle
 *   <microfacet>  a rough metal with Beckmann's distribution, from above
 *   <emission>    black, with a radiance
 *   none of them  the diffuse colour, on both sides
 *
 * With COMPAT_SCHLICK, COMPAT_REFRACTION, COMPAT_LAMBDA or COMPAT_FRESNEL the
 * models are the course's own, with just those faults.
 */
#include "integrator/collada_effect.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const xmlNode *collada_cgl(const xmlNode *node)
{
    for (const xmlNode *e = xml_first(node); e; e = xml_next(e))
        for (const xmlNode *t = xml_is(e, "extra") ? xml_first(e) : NULL; t;
             t = xml_next(t)) {
            const char *profile = xml_get(t, "profile");
            if (xml_is(t, "technique") && profile &&
                strcmp(profile, "CGL") == 0)
                return t;
        }
    return NULL;
}

/* The shortest text that is the same number. */
struct digits {
    char text[32];
};

static struct digits digits(double value)
{
    struct digits d;
    for (int n = 6; n <= 17; n++) {
        snprintf(d.text, sizeof d.text, "%.*g", n, value);
        if (strtod(d.text, NULL) == value)
            break;
    }
    return d;
}

/* The numbers of an element below. */
static bool part(const xmlNode *node, const char *name, double *value,
                 size_t count, struct err *err)
{
    const xmlNode *n = xml_child(node, name);
    struct xml_numbers numbers;
    return n ? xml_numbers(n, &numbers, err) &&
                   xml_reals(&numbers, value, count, err)
             : xml_fail(node, err, "expected a <%s>", name);
}

static void append(struct collada_effect *e, const char *text)
{
    const size_t used = strlen(e->spec);
    snprintf(e->spec + used, sizeof e->spec - used, "%s", text);
}

/* ",key=r/g/b" behind the spec, or ",key=v" where all are the same. */
static bool put(const struct loader *l, struct collada_effect *e,
                const xmlNode *node, const double *rgb, const char *key,
                struct err *err)
{
    char text[160];
    struct spectrum s;
    if (!loader_spectrum(l, node, rgb, 3, &s, err))
        return false;
    if (rgb[0] == rgb[1] && rgb[0] == rgb[2])
        snprintf(text, sizeof text, ",%s=%s", key, digits(rgb[0]).text);
    else
        snprintf(text, sizeof text, ",%s=%s/%s/%s", key, digits(rgb[0]).text,
                 digits(rgb[1]).text, digits(rgb[2]).text);
    append(e, text);
    return true;
}

static bool colour(const struct loader *l, struct collada_effect *e,
                   const xmlNode *node, const char *name, const char *key,
                   struct err *err)
{
    double rgb[3];
    return part(node, name, rgb, 3, err) &&
           put(l, e, xml_child(node, name), rgb, key, err);
}

static bool number(struct collada_effect *e, const xmlNode *node,
                   const char *name, const char *key, struct err *err)
{
    double value;
    if (!part(node, name, &value, 1, err))
        return false;
    char text[80];
    snprintf(text, sizeof text, ",%s=%s", key, digits(value).text);
    append(e, text);
    return true;
}

/* The models below have no roughness, and the course ignores it. */
static bool smooth(const struct loader *l, const xmlNode *node, struct err *err)
{
    double roughness = 0;
    const xmlNode *n = xml_child(node, "roughness");
    if (n && !part(node, "roughness", &roughness, 1, err))
        return false;
    if (roughness != 0)
        loader_warn(l, n, "roughness %g is ignored", roughness);
    return true;
}

/* Around the settings so far, of which the first has a comma too many. */
static bool enclose(struct collada_effect *e, const char *model, bool two_sided)
{
    char settings[sizeof e->spec];
    snprintf(settings, sizeof settings, "%.440s", e->spec + 1);
    snprintf(e->spec, sizeof e->spec,
             two_sided ? "twosided:front=(%.20s:%.440s)" : "%.20s:%.440s",
             model, settings);
    return true;
}

static bool mirror(const struct loader *l, const xmlNode *node,
                   struct collada_effect *e, struct err *err)
{
    return colour(l, e, node, "reflectance", "reflectance", err) &&
           enclose(e, "mirror", true);
}

static bool glass(const struct loader *l, const xmlNode *node,
                  struct collada_effect *e, struct err *err)
{
    const unsigned compat = l->options->compat;
    const bool course = compat & (COMPAT_SCHLICK | COMPAT_REFRACTION);
    if (!smooth(l, node, err) ||
        !number(e, node, "ior", course ? "ior" : "int_ior", err) ||
        !colour(l, e, node, "reflectance",
                course ? "reflectance" : "specular_reflectance", err) ||
        !colour(l, e, node, "transmittance",
                course ? "transmittance" : "specular_transmittance", err))
        return false;
    if (!course) {
        append(e, ",ext_ior=1");
        return enclose(e, "dielectric", false);
    }
    append(e, compat & COMPAT_SCHLICK ? ",schlick_at=inside"
                                      : ",schlick_at=thinner");
    append(e, compat & COMPAT_REFRACTION ? ",factor=course" : ",factor=right");
    return enclose(e, "course_glass", false);
}

static bool refraction(const struct loader *l, const xmlNode *node,
                       struct collada_effect *e, struct err *err)
{
    const bool course = l->options->compat & COMPAT_REFRACTION;
    if (!smooth(l, node, err) ||
        !number(e, node, "ior", course ? "ior" : "int_ior", err) ||
        !colour(l, e, node, "transmittance",
                course ? "transmittance" : "specular_transmittance", err))
        return false;
    if (course)
        return enclose(e, "course_refraction", false);
    append(e, ",ext_ior=1");
    return enclose(e, "refraction", false);
}

static bool microfacet(const struct loader *l, const xmlNode *node,
                       struct collada_effect *e, struct err *err)
{
    const unsigned compat = l->options->compat;
    if (!number(e, node, "alpha", "alpha", err) ||
        !colour(l, e, node, "eta", "eta", err) ||
        !colour(l, e, node, "k", "k", err))
        return false;
    if (!(compat & (COMPAT_LAMBDA | COMPAT_FRESNEL))) {
        append(e, ",distribution=beckmann");
        return enclose(e, "roughconductor", false);
    }
    append(e, compat & COMPAT_LAMBDA ? ",lambda=course" : ",lambda=exact");
    append(e,
           compat & COMPAT_FRESNEL ? ",fresnel_at=normal" : ",fresnel_at=half");
    return enclose(e, "course_microfacet", false);
}

static bool emission(const struct loader *l, const xmlNode *node,
                     struct collada_effect *e, struct err *err)
{
    (void)l;
    snprintf(e->spec, sizeof e->spec, "diffuse:reflectance=0");
    return part(node, "radiance", e->radiance, 3, err);
}

/* The diffuse colour in profile_COMMON, which has four numbers, the last for
 * how opaque it is. */
static bool common(const struct loader *l, const xmlNode *effect,
                   struct collada_effect *e, struct err *err)
{
    const xmlNode *at = effect;
    static const char *const shading[] = { "phong", "lambert", "blinn", NULL };
    static const char *const path[] = { "profile_COMMON", "technique", NULL };
    for (int i = 0; path[i]; i++) {
        const xmlNode *below = xml_child(at, path[i]);
        if (!below)
            return xml_fail(at, err, "expected a <%s>", path[i]);
        at = below;
    }
    const xmlNode *model = NULL;
    for (int i = 0; shading[i] && !model; i++)
        model = xml_child(at, shading[i]);
    if (!model)
        return xml_fail(at, err, "expected a <phong>");
    const xmlNode *node = xml_child(model, "diffuse");
    if (!node)
        return xml_fail(model, err, "expected a <diffuse>");
    const xmlNode *color = xml_child(node, "color");
    if (!color)
        return xml_fail(node, err, "expected a <color>");
    double rgba[4];
    struct xml_numbers n;
    e->node = color;
    return xml_numbers(color, &n, err) && xml_reals(&n, rgba, 4, err) &&
           put(l, e, color, rgba, "reflectance", err) &&
           enclose(e, "diffuse", true);
}

bool collada_effect(const struct loader *l, const xmlNode *effect,
                    struct collada_effect *e, struct err *err)
{
    const xmlNode *own = collada_cgl(effect);
    const xmlNode *model = own ? xml_first(own) : NULL;
    *e = (struct collada_effect){ .node = model ? model : effect };
    if (!model)
        return common(l, effect, e, err);
    if (xml_is(model, "mirror"))
        return mirror(l, model, e, err);
    if (xml_is(model, "glass"))
        return glass(l, model, e, err);
    if (xml_is(model, "refraction"))
        return refraction(l, model, e, err);
    if (xml_is(model, "microfacet"))
        return microfacet(l, model, e, err);
    if (xml_is(model, "emission"))
        return emission(l, model, e, err);
    return loader_unknown(l, model, err,
                          "expected mirror, glass, refraction, microfacet or "
                          "emission") &&
           common(l, effect, e, err);
}
