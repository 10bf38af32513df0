/* mitsuba.h - pieces of Mitsuba 3 scenes; internal to the loader
 *
 * An object is an element such as <shape type="sphere">; what is inside it is
 * asked for by name, and what nobody asked for is unknown.  The first mistake
 * is kept, and after it every answer is the default.
 */
#ifndef INTEGRATOR_MITSUBA_H
#define INTEGRATOR_MITSUBA_H

#include "integrator/loader.h"

enum { OBJECT_PARTS_MAX = 128 };

struct object {
    struct loader *l;
    struct err *err;
    const xmlNode *node;
    const char *type; /* "" if it has none */
    bool failed;
    int parts;
    struct object_part {
        const xmlNode *node;
        const char *name; /* "" if it has none */
        bool used;
    } part[OBJECT_PARTS_MAX];
};

/** Opens one; it fails if it has too many parts or one name twice. */
void object_open(struct object *o, struct loader *l, const xmlNode *node,
                 struct err *err);

/** Complains about parts that nobody asked for; false if anything failed. */
bool object_close(struct object *o);

/** Fails, if nothing has before: always false. */
__attribute__((format(printf, 3, 4))) bool
object_fail(struct object *o, const xmlNode *node, const char *format, ...);

/** The part of this name; NULL if there is none. */
const xmlNode *object_part(struct object *o, const char *name);

/** The next part that is such an element and not used yet, in the document's
 * order, whatever its name; a <ref> counts as what it refers to, which is
 * returned.  NULL if there is none. */
const xmlNode *object_child(struct object *o, const char *element);

double object_float(struct object *o, const char *name, double def);
int object_integer(struct object *o, const char *name, int def);
bool object_flag(struct object *o, const char *name, bool def);
const char *object_string(struct object *o, const char *name, const char *def);
struct vec3 object_point(struct object *o, const char *name, struct vec3 def);

/** A colour or a number of which def is one; at least 0. */
struct spectrum object_radiance(struct object *o, const char *name, double def);
struct affine object_transform(struct object *o, const char *name);

/** One to three numbers of an element's attribute value. */
int object_values(struct object *o, const xmlNode *node, double value[3]);

/** Reads "true" or "false"; of anything else value stays. */
bool mitsuba_truth(const char *text, bool *value);

/** Puts defaults and definitions in the place of $name, everywhere. */
bool mitsuba_substitute(struct loader *l, struct err *err);

/** The number of the BSDF that a <bsdf> describes; -1 and the reason. */
int mitsuba_bsdf(struct loader *l, const xmlNode *node, struct err *err);

/** Adds a <shape>. */
bool mitsuba_shape(struct loader *l, const xmlNode *node, struct err *err);

/** A file's name as seen from the document's folder; NULL when out of memory.
 * Owned by the caller. */
char *mitsuba_path(const struct loader *l, const char *name);

#endif
