/* loader.h - what the loaders share; internal to them */
#ifndef INTEGRATOR_LOADER_H
#define INTEGRATOR_LOADER_H

#include "integrator/compat.h"
#include "integrator/load.h"
#include "integrator/xml.h"

/** A file on its way into a scene. */
struct loader {
    struct xml xml;
    struct _xmlHashTable *ids; /* nodes by id */
    struct scene *scene;
    const struct load_options *options;
    struct _xmlHashTable *files; /* of meshes, by device and inode */
    size_t bytes;                /* of meshes so far */
    size_t allowed;              /* of them for the files' sake */
};

/** Each fills a scene from a document. */
bool collada_load(struct loader *l, struct err *err);
bool mitsuba_load(struct loader *l, struct err *err);

/** What is unknown: a warning and true where loading is lenient, else false and
 * the reason. */
bool loader_unknown(const struct loader *l, const xmlNode *node,
                    struct err *err, const char *what);

__attribute__((format(printf, 3, 4))) void loader_warn(const struct loader *l,
                                                       const xmlNode *node,
                                                       const char *format, ...);

/** scene_add_bsdf, with the node's place in errors and warnings. */
int loader_bsdf(const struct loader *l, const xmlNode *node, const char *spec,
                struct err *err);

/** One value a band from one or three; of several values, where the bands are
 * not three, all must be equal. */
bool loader_spectrum(const struct loader *l, const xmlNode *node,
                     const double *value, int count, struct spectrum *s,
                     struct err *err);

/** Counts a mesh, which is used perhaps many times in a short file; file is
 * where it comes from if not from the document, else NULL. */
bool loader_budget(struct loader *l, const xmlNode *node, size_t vertices,
                   size_t triangles, const char *file, struct err *err);

#endif
