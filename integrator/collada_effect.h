/* collada_effect.h - what a surface of a COLLADA scene is made of
 *
 * Internal to the loader.
 */
#ifndef INTEGRATOR_COLLADA_EFFECT_H
#define INTEGRATOR_COLLADA_EFFECT_H

#include "integrator/loader.h"

struct collada_effect {
    const xmlNode *node; /* where it stands */
    char spec[512];      /* as bsdf_new takes it */
    double radiance[3];  /* R, G and B */
};

/** Reads an <effect>. */
bool collada_effect(const struct loader *l, const xmlNode *effect,
                    struct collada_effect *e, struct err *err);

/** What extra/technique[@profile="CGL"] is below a node; NULL without. */
const xmlNode *collada_cgl(const xmlNode *node);

#endif
