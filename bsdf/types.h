/* types.h - the models of this library, one file each */
#ifndef BSDF_TYPES_H
#define BSDF_TYPES_H

#include "bsdf/bsdf.h"

extern const struct bsdf_type type_course_microfacet, type_diffuse, type_mirror,
    type_roughconductor;

#endif
