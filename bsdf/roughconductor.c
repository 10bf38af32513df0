/* roughconductor.c - a metal of small mirrors
 *
 *   f = F(wi.h) D(h) G2(wo, wi) / (4 cos_o cos_i)
 *   pdf = D(h) cos_h / (4 wi.h)       all normals
 *         G1(wo) D(h) / (4 cos_o)     visible normals
 *
 * The height-correlated G2 = 1 / (1 + Lambda(wo) + Lambda(wi)) is the default,
 * the separable one G1(wo) G1(wi).
 *
 * [1] K. Torrance and E. Sparrow, Theory for Off-Specular Reflection from
 *     Roughened Surfaces, JOSA 57(9), 1967.
 * [2] B. Walter et al., Microfacet Models for Refraction through Rough
 *     Surfaces, EGSR 2007, eq. 20, 13, 14.
 * [3] E. Heitz, Understanding the Masking-Shadowing Function in
 *     Microfacet-Based BRDFs, JCGT 3(2), 2014, eq. 99 (correlated G2).
 */
#include "bsdf/fresnel.h"
#include "bsdf/metal.h"
#include "bsdf/ndf.h"
#include "bsdf/roughness.h"
#include "bsdf/types.h"

enum { EXACT, APPROX, SCHLICK };

struct roughconductor {
    char *material;
    struct spectrum eta, k, specular_reflectance;
    struct spectrum r0; /* reflectance at normal incidence */
    double alpha, alpha_u, alpha_v;
    int distribution, sample_visible, masking, fresnel;
    int bands;
};

static const char *const fresnels[] = { "exact", "approx", "schlick", NULL };

#define FIELD(name) offsetof(struct roughconductor, name)
static const struct bsdf_param params[] = {
    METAL_PARAMS(struct roughconductor),
    ROUGHNESS_PARAMS(struct roughconductor),
    { "fresnel", BSDF_CHOICE, FIELD(fresnel), "exact", 0, 0, fresnels,
      "reflectance of a facet" },
    { "specular_reflectance", BSDF_SPECTRUM, FIELD(specular_reflectance), "1",
      0, 1, NULL, "factor on the result; 1 is physical" },
    { 0 },
};

static bool init(void *state, const struct bands *bands, struct err *err)
{
    struct roughconductor *m = state;
    if (!roughness_settle("roughconductor", m->alpha, &m->alpha_u, &m->alpha_v,
                          err))
        return false;
    if (!metal_settle("roughconductor", m->material, &m->eta, &m->k, bands,
                      err))
        return false;
    m->bands = bands->count;
    for (int b = 0; b < m->bands; b++)
        m->r0.band[b] = fresnel_conductor(1, m->eta.band[b], m->k.band[b]);
    return true;
}

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    (void)state, (void)bands;
    return (struct bsdf_claims){ .lobes = BSDF_GLOSSY_REFLECTION,
                                 .reciprocal = true,
                                 .eta = 1 };
}

static const struct ndf *ndf(const struct roughconductor *m)
{
    return roughness_ndf[m->distribution];
}

static double lambda(const struct roughconductor *m, struct vec3 w)
{
    return ndf_lambda(ndf(m), m->alpha_u, m->alpha_v, w);
}

static double d(const struct roughconductor *m, struct vec3 h)
{
    return ndf_d(ndf(m), m->alpha_u, m->alpha_v, h);
}

/* From lambda(wo) and lambda(wi). */
static double g2(const struct roughconductor *m, double lo, double li)
{
    return m->masking == MASKING_CORRELATED ? 1 / (1 + lo + li)
                                            : 1 / ((1 + lo) * (1 + li));
}

/* The model's F, with its factor, times a common one. */
static struct spectrum tinted(const struct roughconductor *m, double cos_d,
                              double common)
{
    struct spectrum f = { { 0 } };
    const double c = fmin(cos_d, 1);
    for (int b = 0; b < m->bands; b++) {
        const double eta = m->eta.band[b], k = m->k.band[b];
        const double r = m->fresnel == EXACT ? fresnel_conductor(c, eta, k)
                         : m->fresnel == APPROX
                             ? fresnel_conductor_approx(c, eta, k)
                             : fresnel_schlick(c, m->r0.band[b]);
        f.band[b] = common * m->specular_reflectance.band[b] * r;
    }
    return f;
}

static bool above(struct vec3 wo, struct vec3 wi)
{
    return wo.z > 0 && wi.z > 0;
}

/* h, and wi.h as half the length of wo + wi. */
static struct vec3 half(struct vec3 wo, struct vec3 wi, double *cos_d)
{
    const struct vec3 sum = vec3_add(wo, wi);
    const double length = vec3_length(sum);
    *cos_d = length / 2;
    return vec3_scale(1 / length, sum);
}

static struct spectrum eval(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct roughconductor *m = state;
    if (!above(wo, wi))
        return (struct spectrum){ { 0 } };
    double cos_d;
    const struct vec3 h = half(wo, wi, &cos_d);
    const double g = g2(m, lambda(m, wo), lambda(m, wi));
    return tinted(m, cos_d, d(m, h) * g / (4 * wo.z * wi.z));
}

/* The pdf, from lambda(wo). */
static double density(const struct roughconductor *m, struct vec3 wo,
                      struct vec3 wi, double lo)
{
    double cos_d;
    const struct vec3 h = half(wo, wi, &cos_d);
    return m->sample_visible ? d(m, h) / (4 * wo.z * (1 + lo))
                             : d(m, h) * h.z / (4 * cos_d);
}

static double pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct roughconductor *m = state;
    if (!above(wo, wi))
        return 0;
    return density(m, wo, wi, m->sample_visible ? lambda(m, wo) : 0);
}

/* weight = f cos_i / pdf, with D divided out by hand. */
static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct roughconductor *m = state;
    const struct bsdf_sample refused = { 0 };
    if (!(wo.z > 0))
        return refused;
    const struct vec3 h =
        m->sample_visible
            ? ndf_sample_visible(ndf(m), m->alpha_u, m->alpha_v, wo, u.x, u.y)
            : ndf_sample_all(ndf(m), m->alpha_u, m->alpha_v, u.x, u.y);
    const double cos_d = vec3_dot(wo, h);
    const struct vec3 wi = vec3_unit(vec3_reflect(wo, h));
    if (!(cos_d > 0 && wi.z > 0))
        return refused;
    const double lo = lambda(m, wo), g = g2(m, lo, lambda(m, wi));
    const double p = density(m, wo, wi, lo);
    if (!(p > 0))
        return refused;
    return (struct bsdf_sample){
        .wi = wi,
        .pdf = p,
        .weight =
            tinted(m, cos_d,
                   m->sample_visible ? g * (1 + lo) : g * cos_d / (wo.z * h.z)),
    };
}

static double facet_d(const void *state, struct vec3 h)
{
    return d(state, h);
}

static double facet_g1(const void *state, struct vec3 w)
{
    const struct roughconductor *m = state;
    return ndf_g1(ndf(m), m->alpha_u, m->alpha_v, w);
}

const struct bsdf_type type_roughconductor = {
    .name = "roughconductor",
    .about = "rough metal (Torrance-Sparrow, Smith)",
    .params = params,
    .size = sizeof(struct roughconductor),
    .claims = claims,
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
    .init = init,
    .facet_d = facet_d,
    .facet_g1 = facet_g1,
};
