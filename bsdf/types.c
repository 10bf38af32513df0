/* types.c - the models that specs can name */
#include "bsdf/types.h"

const struct bsdf_type *const bsdf_types[] = {
    &type_diffuse,           &type_mirror, &type_roughconductor,
    &type_course_microfacet, NULL,
};
