/* mirror.c - the ideal mirror of the write-up
 *
 * One direction, (-wo.x, -wo.y, wo.z), with probability 1 and the reflectance
 * as weight: f |cos| integrated over the delta.
 */
#include "bsdf/types.h"

struct mirror {
    struct spectrum reflectance;
};

static const struct bsdf_param params[] = {
    { "reflectance", BSDF_SPECTRUM, offsetof(struct mirror, reflectance), "1",
      0, 1, NULL, "share of the light that is reflected" },
    { 0 },
};

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    const struct mirror *m = state;
    return (struct bsdf_claims){
        .lobes = BSDF_DELTA_REFLECTION,
        .lossless = spectrum_is(m->reflectance, bands->count, 1),
        .reciprocal = true,
        .eta = 1,
    };
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct mirror *m = state;
    (void)u;
    if (!(wo.z > 0))
        return (struct bsdf_sample){ 0 };
    return (struct bsdf_sample){ .wi = { -wo.x, -wo.y, wo.z },
                                 .pdf = 1,
                                 .weight = m->reflectance,
                                 .delta = true };
}

const struct bsdf_type type_mirror = {
    .name = "mirror",
    .about = "ideal mirror",
    .params = params,
    .size = sizeof(struct mirror),
    .claims = claims,
    .sample = sample,
};
