/* conductor.c - a smooth metal
 *
 * The mirror direction with probability 1 and Fresnel's exact reflectance as
 * weight.
 */
#include "bsdf/fresnel.h"
#include "bsdf/metal.h"
#include "bsdf/types.h"

struct conductor {
    char *material;
    struct spectrum eta, k, specular_reflectance;
    int bands;
};

static const struct bsdf_param params[] = {
    METAL_PARAMS(struct conductor),
    { "specular_reflectance", BSDF_SPECTRUM,
      offsetof(struct conductor, specular_reflectance), "1", 0, 1, NULL,
      "factor on the result; 1 is physical" },
    { 0 },
};

static bool init(void *state, const struct bands *bands, struct err *err)
{
    struct conductor *m = state;
    m->bands = bands->count;
    return metal_settle("conductor", m->material, &m->eta, &m->k, bands, err);
}

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    (void)state, (void)bands;
    return (struct bsdf_claims){ .lobes = BSDF_DELTA_REFLECTION,
                                 .reciprocal = true,
                                 .eta = 1 };
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct conductor *m = state;
    (void)u;
    if (!(wo.z > 0))
        return (struct bsdf_sample){ 0 };
    struct bsdf_sample s = { .wi = { -wo.x, -wo.y, wo.z },
                             .pdf = 1,
                             .delta = true };
    for (int b = 0; b < m->bands; b++)
        s.weight.band[b] =
            m->specular_reflectance.band[b] *
            fresnel_conductor(fmin(wo.z, 1), m->eta.band[b], m->k.band[b]);
    return s;
}

static void index_of(const void *state, struct spectrum *eta,
                     struct spectrum *k)
{
    const struct conductor *m = state;
    *eta = m->eta;
    *k = m->k;
}

const struct bsdf_type type_conductor = {
    .name = "conductor",
    .about = "smooth metal",
    .params = params,
    .size = sizeof(struct conductor),
    .claims = claims,
    .sample = sample,
    .init = init,
    .index = index_of,
};
