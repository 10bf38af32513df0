/* load.c - scenes from files */
#include "integrator/load.h"

#include <libxml/hash.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "integrator/loader.h"

/* Bytes of meshes to a byte of a file, from 16 MiB on. */
static const size_t mesh_times = 64, mesh_least = (size_t)16 << 20;

void loader_warn(const struct loader *l, const xmlNode *node,
                 const char *format, ...)
{
    struct err what, text;
    va_list args;
    if (!l->options->warn)
        return;
    va_start(args, format);
    vsnprintf(what.text, sizeof what.text, format, args);
    va_end(args);
    xml_fail(node, &text, "%s", what.text);
    l->options->warn(text.text, l->options->context);
}

bool loader_unknown(const struct loader *l, const xmlNode *node,
                    struct err *err, const char *what)
{
    if (!l->options->lenient)
        return xml_fail(node, err, "%s", what);
    loader_warn(l, node, "%s; left out", what);
    return true;
}

int loader_bsdf(const struct loader *l, const xmlNode *node, const char *spec,
                struct err *err)
{
    struct err why;
    const int bsdf = scene_add_bsdf(l->scene, spec, &why);
    if (bsdf < 0)
        xml_fail(node, err, "%s", why.text);
    else if (why.text[0])
        loader_warn(l, node, "%s", why.text);
    return bsdf;
}

bool loader_spectrum(const struct loader *l, const xmlNode *node,
                     const double *value, int count, struct spectrum *s,
                     struct err *err)
{
    const int bands = scene_bands(l->scene)->count;
    const bool grey =
        count == 1 || (value[0] == value[1] && value[0] == value[2]);
    if (!grey && bands != 3)
        return xml_fail(node, err,
                        "%g, %g, %g is a colour of R, G and B: expected one "
                        "value for each of the %d bands",
                        value[0], value[1], value[2], bands);
    *s = (struct spectrum){ { 0 } };
    for (int b = 0; b < bands; b++)
        s->band[b] = value[grey ? 0 : b];
    return true;
}

/* Room for a mesh file's triangles, once. */
static void allow(struct loader *l, const char *file)
{
    struct stat about;
    char key[64];
    if (!l->files)
        l->files = xmlHashCreate(16);
    if (!l->files || stat(file, &about) != 0)
        return;
    snprintf(key, sizeof key, "%ju:%ju", (uintmax_t)about.st_dev,
             (uintmax_t)about.st_ino);
    if (xmlHashAddEntry(l->files, (const xmlChar *)key, l) == 0)
        l->allowed += mesh_times * (size_t)about.st_size;
}

bool loader_budget(struct loader *l, const xmlNode *node, size_t vertices,
                   size_t triangles, const char *file, struct err *err)
{
    size_t most = mesh_times * l->xml.bytes;
    most = most > mesh_least ? most : mesh_least;
    if (file)
        allow(l, file);
    l->bytes += 24 * vertices + 12 * triangles;
    if (l->bytes > most + l->allowed)
        return xml_fail(node, err,
                        "the meshes take more than %zu bytes, too much for "
                        "files of this size",
                        most + l->allowed);
    return true;
}

static bool ends(const char *path, const char *ending)
{
    const size_t n = strlen(path), k = strlen(ending);
    return n > k && strcmp(path + n - k, ending) == 0;
}

struct scene *scene_load(const char *path, const struct bands *bands,
                         const struct load_options *options, struct err *err)
{
    struct loader l = { .options = options };
    const bool collada = ends(path, ".dae") || ends(path, ".dae.xz");
    bool ok = false;
    if (!collada && !ends(path, ".xml")) {
        err_set(err, "%s: expected a name that ends in .xml, .dae or .dae.xz",
                path);
        return NULL;
    }
    if (!xml_open(&l.xml, path, err))
        return NULL;
    l.ids = xml_ids(&l.xml, err);
    l.scene = l.ids ? scene_new(bands, err) : NULL;
    if (l.scene)
        ok = collada ? collada_load(&l, err) : mitsuba_load(&l, err);
    if (l.ids)
        xmlHashFree(l.ids, NULL);
    if (l.files)
        xmlHashFree(l.files, NULL);
    xml_close(&l.xml);
    if (ok)
        return l.scene;
    scene_free(l.scene);
    return NULL;
}
