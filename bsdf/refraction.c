/* refraction.c - the write-up's part 1: refracts, or absorbs
 *
 * The refracted direction with probability 1 and weight (n_o / n_i)^2 times
 * specular_transmittance; nothing beyond the critical angle.
 */
#include "bsdf/fresnel.h"
#include "bsdf/medium.h"
#include "bsdf/types.h"

struct refraction {
    char *int_ior, *ext_ior;
    struct spectrum specular_transmittance;
    double eta; /* below over above */
};

static const struct bsdf_param params[] = {
    MEDIUM_PARAMS(struct refraction),
    { "specular_transmittance", BSDF_SPECTRUM,
      offsetof(struct refraction, specular_transmittance), "1", 0, 1, NULL,
      "share of the light that is refracted" },
    { 0 },
};

static bool init(void *state, const struct bands *bands, struct err *err)
{
    struct refraction *m = state;
    return medium_settle("refraction", m->int_ior, m->ext_ior, bands, &m->eta,
                         err);
}

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    const struct refraction *m = state;
    (void)bands;
    return (struct bsdf_claims){ .lobes = BSDF_DELTA_TRANSMISSION,
                                 .reciprocal = true,
                                 .two_sided = true,
                                 .eta = m->eta };
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct refraction *m = state;
    const struct vec3 up = { 0, 0, wo.z > 0 ? 1 : -1 };
    const double n = wo.z > 0 ? m->eta : 1 / m->eta;
    double cos_t = 0;
    (void)u;
    if (wo.z != 0)
        (void)fresnel_dielectric(fmin(fabs(wo.z), 1), n, &cos_t);
    if (cos_t == 0)
        return (struct bsdf_sample){ 0 };
    return (struct bsdf_sample){
        .wi = medium_refract(wo, up, n, cos_t),
        .pdf = 1,
        .weight = spectrum_scale(1 / (n * n), m->specular_transmittance),
        .delta = true,
    };
}

const struct bsdf_type type_refraction = {
    .name = "refraction",
    .about = "refracts, absorbs beyond the critical angle",
    .params = params,
    .size = sizeof(struct refraction),
    .claims = claims,
    .sample = sample,
    .init = init,
};
