/* types.c - the models that specs can name */
#include "bsdf/types.h"

const struct bsdf_type *const bsdf_types[] = {
    &type_diffuse,
    &type_mirror,
    &type_conductor,
    &type_refraction,
    &type_dielectric,
    &type_thindielectric,
    &type_roughconductor,
    &type_roughdielectric,
    &type_twosided,
    &type_blendbsdf,
    &type_course_mirror,
    &type_course_refraction,
    &type_course_glass,
    &type_course_microfacet,
    NULL, /* one a line, so that a new one is one line */
};
