/* course_delta.c - mirror, refraction and glass as a course has them
 *
 * As a student of CS184/284A writes them in project 3-2, with f of a delta as
 * something over |cos|, which the integrator multiplies back.  Each claims what
 * its author would claim, and each fault can be mended:
 *
 *   factor=course      transmission weighs T / eta^2 with eta = 1 / ior on the
 *                      way in, that is T ior^2; radiance asks for T / ior^2.
 *   schlick_at=inside  Schlick takes the cosine on the side of wo, also where
 *                      that is the denser side; right is the thinner side's.
 *   over_cos=false     the mirror's f without the division by |cos|.
 */
#include "bsdf/fresnel.h"
#include "bsdf/medium.h"
#include "bsdf/types.h"

enum { FACTOR_COURSE, FACTOR_RIGHT };
enum { AT_INSIDE, AT_THINNER };

struct course_delta {
    struct spectrum reflectance, transmittance;
    double ior;
    int factor, schlick_at, over_cos;
};

static const char *const factors[] = { "course", "right", NULL };
static const char *const places[] = { "inside", "thinner", NULL };

#define FIELD(name) offsetof(struct course_delta, name)
#define REFLECTANCE                                                            \
    {                                                                          \
        "reflectance", BSDF_SPECTRUM, FIELD(reflectance), "1", 0, 1, NULL,     \
            "share of the light that is reflected"                             \
    }
#define TRANSMITTANCE                                                          \
    { "transmittance",                                                         \
      BSDF_SPECTRUM,                                                           \
      FIELD(transmittance),                                                    \
      "1",                                                                     \
      0,                                                                       \
      1,                                                                       \
      NULL,                                                                    \
      "share of the light that is refracted" },                                \
        { "ior",      BSDF_NUMBER,                                             \
          FIELD(ior), "1.5",                                                   \
          1,          100,                                                     \
          NULL,       "index below the surface, over that above" },            \
    {                                                                          \
        "factor", BSDF_CHOICE, FIELD(factor), "course", 0, 0, factors,         \
            "of transmitted radiance: the course's ior^2, or the right one"    \
    }

static const struct bsdf_param mirror_params[] = {
    REFLECTANCE,
    { "over_cos", BSDF_FLAG, FIELD(over_cos), "true", 0, 0, NULL,
      "whether f is divided by |cos|" },
    { 0 },
};

static const struct bsdf_param refraction_params[] = { TRANSMITTANCE, { 0 } };

static const struct bsdf_param glass_params[] = {
    REFLECTANCE,
    TRANSMITTANCE,
    { "schlick_at", BSDF_CHOICE, FIELD(schlick_at), "inside", 0, 0, places,
      "cosine in Schlick's R: on the side of wo, or in the thinner medium" },
    { 0 },
};

static struct bsdf_claims claims_of(unsigned lobes, bool lossless, double eta)
{
    return (struct bsdf_claims){
        .lobes = lobes,
        .lossless = lossless,
        .reciprocal = true,
        .two_sided = lobes & BSDF_TRANSMISSION,
        .eta = eta,
    };
}

static struct bsdf_claims mirror_claims(const void *state,
                                        const struct bands *bands)
{
    const struct course_delta *m = state;
    return claims_of(BSDF_DELTA_REFLECTION,
                     spectrum_is(m->reflectance, bands->count, 1), 1);
}

static struct bsdf_claims refraction_claims(const void *state,
                                            const struct bands *bands)
{
    const struct course_delta *m = state;
    (void)bands;
    return claims_of(BSDF_DELTA_TRANSMISSION, false, m->ior);
}

static struct bsdf_claims glass_claims(const void *state,
                                       const struct bands *bands)
{
    const struct course_delta *m = state;
    return claims_of(BSDF_DELTA_REFLECTION | BSDF_DELTA_TRANSMISSION,
                     spectrum_is(m->reflectance, bands->count, 1) &&
                         spectrum_is(m->transmittance, bands->count, 1),
                     m->ior);
}

static struct bsdf_sample mirrored(const struct course_delta *m, struct vec3 wo,
                                   double pdf)
{
    return (struct bsdf_sample){ .wi = { -wo.x, -wo.y, wo.z },
                                 .pdf = pdf,
                                 .weight = m->reflectance,
                                 .delta = true };
}

static struct bsdf_sample refracted(const struct course_delta *m,
                                    struct vec3 wo, double pdf, double n,
                                    double cos_t)
{
    const struct vec3 up = { 0, 0, wo.z > 0 ? 1 : -1 };
    const double factor = m->factor == FACTOR_COURSE ? n * n : 1 / (n * n);
    return (struct bsdf_sample){
        .wi = medium_refract(wo, up, n, cos_t),
        .pdf = pdf,
        .weight = spectrum_scale(factor, m->transmittance),
        .delta = true,
    };
}

static struct bsdf_sample mirror_sample(const void *state, struct vec3 wo,
                                        struct vec3 u)
{
    const struct course_delta *m = state;
    (void)u;
    if (!(wo.z > 0))
        return (struct bsdf_sample){ 0 };
    struct bsdf_sample s = mirrored(m, wo, 1);
    if (!m->over_cos)
        s.weight = spectrum_scale(wo.z, s.weight);
    return s;
}

/* The index beyond over that on the side of wo, and the cosine there; false
 * beyond the critical angle and at the horizon. */
static bool beyond(const struct course_delta *m, struct vec3 wo, double *n,
                   double *cos_t)
{
    *n = wo.z > 0 ? m->ior : 1 / m->ior;
    *cos_t = 0;
    if (wo.z != 0)
        (void)fresnel_dielectric(fmin(fabs(wo.z), 1), *n, cos_t);
    return *cos_t > 0;
}

static struct bsdf_sample refraction_sample(const void *state, struct vec3 wo,
                                            struct vec3 u)
{
    const struct course_delta *m = state;
    double n, cos_t;
    (void)u;
    return beyond(m, wo, &n, &cos_t) ? refracted(m, wo, 1, n, cos_t)
                                     : (struct bsdf_sample){ 0 };
}

static struct bsdf_sample glass_sample(const void *state, struct vec3 wo,
                                       struct vec3 u)
{
    const struct course_delta *m = state;
    double n, cos_t;
    if (wo.z == 0)
        return (struct bsdf_sample){ 0 };
    if (!beyond(m, wo, &n, &cos_t))
        return mirrored(m, wo, 1);
    const double r0 = (n - 1) / (n + 1) * ((n - 1) / (n + 1));
    const double c = m->schlick_at == AT_THINNER && n < 1 ? cos_t : fabs(wo.z);
    const double r = fresnel_schlick(fmin(c, 1), r0);
    return u.z < r ? mirrored(m, wo, r) : refracted(m, wo, 1 - r, n, cos_t);
}

const struct bsdf_type type_course_mirror = {
    .name = "course_mirror",
    .about = "ideal mirror as in the course",
    .params = mirror_params,
    .size = sizeof(struct course_delta),
    .claims = mirror_claims,
    .sample = mirror_sample,
};

const struct bsdf_type type_course_refraction = {
    .name = "course_refraction",
    .about = "refraction as in the course, fault included",
    .params = refraction_params,
    .size = sizeof(struct course_delta),
    .claims = refraction_claims,
    .sample = refraction_sample,
};

const struct bsdf_type type_course_glass = {
    .name = "course_glass",
    .about = "glass as in the course, faults included",
    .params = glass_params,
    .size = sizeof(struct course_delta),
    .claims = glass_claims,
    .sample = glass_sample,
};
