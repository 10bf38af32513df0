/* broken.h - models that are wrong in one way, and their sound control
 *
 * Numbers in [] are those of the list of bugs that public renderers had:
 * pbrt-v4 dfa11074 [1], pbrt-v3 #228 [3], pbrt-v3 478b2e6 [4], pbrt-v3 a8c3616
 * [5], pbrt-v3 277d749 [6], pbrt-v4 #215 [8], pbrt-v4 7ad70fe7 [10], tungsten
 * 83e8316 [13], tungsten d008dc6 [14], mitsuba3 ae5e05bab [16], GLSL-PathTracer
 * #24 [20], mitsuba3 62a0295e8 [24].
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

/** Rough glass; keys alpha, eta, fault (see broken_glass.c). */
extern const struct bsdf_type type_broken_glass;

/** A pane that absorbs half of what it reflects; fault = none, signed [10]: F
 * of a cosine with its sign; complement [24]: what goes through is 1 less the
 * tinted reflectance. */
extern const struct bsdf_type type_broken_pane;

/** Two models, mixed; fault = none, one_lobe [16]: a sample's pdf and weight
 * are those of the lobe that was drawn. */
extern const struct bsdf_type type_broken_mix;

#endif
