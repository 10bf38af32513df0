/* thindielectric.c - a pane: two parallel interfaces, too close to see
 *
 * Light that bounces between them leaves on either side:
 *
 *   R' = R + T R T + T R^3 T ... = 2 R / (1 + R),  T' = 1 - R',  T = 1 - R
 *
 * and goes on in its own direction; the medium is the same on both sides, so
 * no squared indices enter.
 *
 * M. Pharr, W. Jakob and G. Humphreys, Physically Based Rendering, 4th ed.,
 * 2023, sec. 9.5.
 */
#include "bsdf/fresnel.h"
#include "bsdf/medium.h"
#include "bsdf/types.h"

struct thindielectric {
    char *int_ior, *ext_ior;
    struct spectrum specular_reflectance, specular_transmittance;
    double eta;
};

#define FIELD(name) offsetof(struct thindielectric, name)
static const struct bsdf_param params[] = {
    MEDIUM_PARAMS(struct thindielectric),
    { "specular_reflectance", BSDF_SPECTRUM, FIELD(specular_reflectance), "1",
      0, 1, NULL, "factor on what is reflected; 1 is physical" },
    { "specular_transmittance", BSDF_SPECTRUM, FIELD(specular_transmittance),
      "1", 0, 1, NULL, "factor on what goes through; 1 is physical" },
    { 0 },
};

static bool init(void *state, const struct bands *bands, struct err *err)
{
    struct thindielectric *m = state;
    return medium_settle("thindielectric", m->int_ior, m->ext_ior, bands,
                         &m->eta, err);
}

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    const struct thindielectric *m = state;
    (void)bands;
    return (struct bsdf_claims){ .lobes =
                                     BSDF_DELTA_TRANSMISSION |
                                     (m->eta != 1 ? BSDF_DELTA_REFLECTION : 0),
                                 .reciprocal = true,
                                 .two_sided = true,
                                 .eta = 1 };
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct thindielectric *m = state;
    if (wo.z == 0)
        return (struct bsdf_sample){ 0 };
    const double r = fresnel_dielectric(fmin(fabs(wo.z), 1), m->eta, NULL);
    const double all = 2 * r / (1 + r);
    if (u.z < all)
        return (struct bsdf_sample){ .wi = { -wo.x, -wo.y, wo.z },
                                     .pdf = all,
                                     .weight = m->specular_reflectance,
                                     .delta = true };
    return (struct bsdf_sample){ .wi = { -wo.x, -wo.y, -wo.z },
                                 .pdf = 1 - all,
                                 .weight = m->specular_transmittance,
                                 .delta = true };
}

static void index_of(const void *state, struct spectrum *eta,
                     struct spectrum *k)
{
    const struct thindielectric *m = state;
    *eta = spectrum_of(BANDS_MAX, m->eta);
    *k = spectrum_of(BANDS_MAX, 0);
}

const struct bsdf_type type_thindielectric = {
    .name = "thindielectric",
    .about = "thin pane of glass",
    .params = params,
    .size = sizeof(struct thindielectric),
    .claims = claims,
    .sample = sample,
    .init = init,
    .index = index_of,
};
