/* broken.h - models that are wrong in one way, and their sound control
 *
 * Keys: those of the model, fault (none: the control) and size, by how much: a
 * factor, or the share of it that is mixed in; the source of each says what its
 * faults are.  mutants.c has them all in a table, with who made the mistake.
 */
#ifndef TESTS_BROKEN_H
#define TESTS_BROKEN_H

#include "bsdf/bsdf.h"

/** A rough mirror with F = 1, or Schlick's with r0 (broken.c). */
extern const struct bsdf_type type_broken_metal;

/** A matt surface of albedo 0.5 (broken.c). */
extern const struct bsdf_type type_broken_diffuse;

/** fault = tilted: the direction is off by size; rare: a pdf of 1 with only a
 * share size drawn (broken.c). */
extern const struct bsdf_type type_broken_mirror;

/** Rough glass (broken_glass.c). */
extern const struct bsdf_type type_broken_glass;

/** A pane that absorbs half of what it reflects (broken_glass.c). */
extern const struct bsdf_type type_broken_pane;

/** Two models mixed by a tint, a smooth coat over a model, and a wrapper
 * around one (broken_layers.c). */
extern const struct bsdf_type type_broken_mix, type_broken_coat,
    type_broken_wrapper;

/** A matt surface from tables (broken_table.c). */
extern const struct bsdf_type type_broken_table;

#endif
