/* broken.h - models that are wrong in one way, and their sound control
 *
 * Numbers in [] are those of the list of bugs that public renderers had:
 * pbrt-v3 a8c3616 [5], pbrt-v3 277d749 [6], tungsten 83e8316 [13], tungsten
 * d008dc6 [14].
 */
#ifndef TESTS_BROKEN_H
#define TESTS_BROKEN_H

#include "bsdf/bsdf.h"

/** A rough mirror with F = 1; keys alpha, visible, fault (see broken.c) and
 * size, by how much: a factor, or a share. */
extern const struct bsdf_type type_broken_metal;

/** fault = none, or no_pi [13]: f lacks 1 / pi. */
extern const struct bsdf_type type_broken_diffuse;

/** fault = none; tilted: the direction is off by size; rare: a pdf of 1 with
 * only a share size drawn. */
extern const struct bsdf_type type_broken_mirror;

#endif
