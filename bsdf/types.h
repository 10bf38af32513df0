/* types.h - the models of this library, one file each */
#ifndef BSDF_TYPES_H
#define BSDF_TYPES_H

#include "bsdf/bsdf.h"

extern const struct bsdf_type type_blendbsdf, type_conductor, type_course_glass,
    type_course_microfacet, type_course_mirror, type_course_refraction,
    type_dielectric, type_diffuse, type_mirror, type_refraction,
    type_roughconductor, type_roughdielectric, type_thindielectric,
    type_twosided;

#endif
