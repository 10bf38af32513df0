/* dielectric.c - smooth glass: mirror or refracted direction
 *
 *   reflection   with probability F, weight specular_reflectance
 *   refraction   with probability 1 - F, weight (n_o / n_i)^2 times
 *                specular_transmittance: radiance is compressed on the way
 *                into the denser medium
 *
 * Schlick's approximation takes the angle in the thinner medium, where it
 * reaches 1 at the critical angle of the denser one.
 *
 * M. Pharr, W. Jakob and G. Humphreys, Physically Based Rendering, 4th ed.,
 * 2023, sec. 9.5; E. Veach, Robust Monte Carlo Methods for Light Transport
 * Simulation, 1997, sec. 5.2 (the squared indices).
 */
#include "bsdf/fresnel.h"
#include "bsdf/medium.h"
#include "bsdf/types.h"

enum { EXACT, SCHLICK };
enum { BOTH, REFLECTION, TRANSMISSION };

struct dielectric {
    char *int_ior, *ext_ior;
    struct spectrum specular_reflectance, specular_transmittance;
    double eta; /* below over above */
    int fresnel, lobes;
};

static const char *const fresnels[] = { "exact", "schlick", NULL };
static const char *const lobe_sets[] = { "both", "reflection", "transmission",
                                         NULL };

#define FIELD(name) offsetof(struct dielectric, name)
static const struct bsdf_param params[] = {
    MEDIUM_PARAMS(struct dielectric),
    { "fresnel", BSDF_CHOICE, FIELD(fresnel), "exact", 0, 0, fresnels,
      "reflectance of the interface" },
    { "specular_reflectance", BSDF_SPECTRUM, FIELD(specular_reflectance), "1",
      0, 1, NULL, "factor on what is reflected; 1 is physical" },
    { "specular_transmittance", BSDF_SPECTRUM, FIELD(specular_transmittance),
      "1", 0, 1, NULL, "factor on what is refracted; 1 is physical" },
    { "lobes", BSDF_CHOICE, FIELD(lobes), "both", 0, 0, lobe_sets,
      "one alone is drawn with its own share, the rest absorbed" },
    { 0 },
};

static bool init(void *state, const struct bands *bands, struct err *err)
{
    struct dielectric *m = state;
    return medium_settle("dielectric", m->int_ior, m->ext_ior, bands, &m->eta,
                         err);
}

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    const struct dielectric *m = state;
    const unsigned lobes[] = { BSDF_DELTA_REFLECTION | BSDF_DELTA_TRANSMISSION,
                               BSDF_DELTA_REFLECTION, BSDF_DELTA_TRANSMISSION };
    return (struct bsdf_claims){
        /* Schlick's F grows to 1 at grazing even there. */
        .lobes =
            lobes[m->lobes] &
            ~(m->eta == 1 && m->fresnel == EXACT ? BSDF_DELTA_REFLECTION : 0u),
        .lossless = m->lobes == BOTH &&
                    spectrum_is(m->specular_reflectance, bands->count, 1) &&
                    spectrum_is(m->specular_transmittance, bands->count, 1),
        .reciprocal = true,
        .two_sided = true,
        .eta = m->eta,
    };
}

/* F toward an index n over the light's own, what is left of 1, and the cosine
 * beyond. */
static double reflectance(const struct dielectric *m, double c, double n,
                          double *left, double *cos_t)
{
    const double exact = fresnel_dielectric(c, n, cos_t);
    *left = fresnel_dielectric_through(c, *cos_t, n);
    if (m->fresnel == EXACT || *cos_t == 0)
        return exact;
    const double r = (n - 1) / (n + 1);
    const double f = fresnel_schlick(n < 1 ? *cos_t : c, r * r);
    *left = 1 - f;
    return f;
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct dielectric *m = state;
    const struct vec3 up = { 0, 0, wo.z > 0 ? 1 : -1 };
    const double n = wo.z > 0 ? m->eta : 1 / m->eta, c = fmin(fabs(wo.z), 1);
    if (wo.z == 0)
        return (struct bsdf_sample){ 0 };
    double left, cos_t;
    const double f = reflectance(m, c, n, &left, &cos_t);
    if (u.z < f)
        return m->lobes == TRANSMISSION
                   ? (struct bsdf_sample){ 0 }
                   : (struct bsdf_sample){ .wi = { -wo.x, -wo.y, wo.z },
                                           .pdf = f,
                                           .weight = m->specular_reflectance,
                                           .delta = true };
    if (m->lobes == REFLECTION || !(left > 0))
        return (struct bsdf_sample){ 0 };
    return (struct bsdf_sample){
        .wi = medium_refract(wo, up, n, cos_t),
        .pdf = left,
        .weight = spectrum_scale(1 / (n * n), m->specular_transmittance),
        .delta = true,
    };
}

static void index_of(const void *state, struct spectrum *eta,
                     struct spectrum *k)
{
    const struct dielectric *m = state;
    *eta = spectrum_of(BANDS_MAX, m->eta);
    *k = spectrum_of(BANDS_MAX, 0);
}

const struct bsdf_type type_dielectric = {
    .name = "dielectric",
    .about = "smooth glass",
    .params = params,
    .size = sizeof(struct dielectric),
    .claims = claims,
    .sample = sample,
    .init = init,
    .index = index_of,
};
