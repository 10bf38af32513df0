/* load.h - scenes from files
 *
 *   NAME.xml      Mitsuba 3's format, see mitsuba.c for what of it
 *   NAME.dae      COLLADA as the course's scenes use it, see collada.c
 *   NAME.dae.xz   the same, packed
 *
 * Whatever a file may hold, memory stays bounded by a small multiple of its
 * size, and an error names file, line, element and what was expected.
 */
#ifndef INTEGRATOR_LOAD_H
#define INTEGRATOR_LOAD_H

#include "integrator/scene.h"

enum { LOAD_DEFINES_MAX = 64 };

struct load_options {
    int width, height; /* of the picture; 0 for the file's, or 800 x 600 */
    unsigned compat;   /* of enum compat; for COLLADA */
    bool lenient;      /* what is unknown is a warning and left out */

    /* -D NAME=VALUE, for $NAME; borrowed. */
    const char *define[LOAD_DEFINES_MAX];
    int defines;

    /* Called with each warning, or NULL. */
    void (*warn)(const char *text, void *context);
    void *context;
};

/** A scene that is filled but not committed; NULL and the reason. Owned by the
 * caller. */
struct scene *scene_load(const char *path, const struct bands *bands,
                         const struct load_options *options, struct err *err);

#endif
