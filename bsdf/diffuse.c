/* diffuse.c - the ideal matt surface
 *
 *   f = reflectance / pi,  pdf = cos_i / pi on the side of wo, from above
 *
 * J. H. Lambert, Photometria, 1760.  Sampled through the disk: M. Pharr,
 * W. Jakob and G. Humphreys, Physically Based Rendering, 4th ed., 2023,
 * sec. A.5.3, with the plain polar map of the disk.
 */
#include "bsdf/types.h"

struct diffuse {
    struct spectrum reflectance;
};

static const struct bsdf_param params[] = {
    { "reflectance", BSDF_SPECTRUM, offsetof(struct diffuse, reflectance),
      "0.5", 0, 1, NULL, "share of the light that is reflected" },
    { 0 },
};

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    const struct diffuse *m = state;
    return (struct bsdf_claims){
        .lobes = BSDF_DIFFUSE_REFLECTION,
        .lossless = spectrum_is(m->reflectance, bands->count, 1),
        .reciprocal = true,
        .eta = 1,
    };
}

static inline struct spectrum value(const struct diffuse *m, struct vec3 wo,
                                    struct vec3 wi)
{
    return spectrum_scale(wo.z > 0 && wi.z > 0 ? 1 / PI : 0, m->reflectance);
}

static struct spectrum eval(const void *state, struct vec3 wo, struct vec3 wi)
{
    return value(state, wo, wi);
}

static void eval_many(const void *state, size_t n, struct dirs wo,
                      struct dirs wi, struct spectrum *f)
{
    const struct diffuse m = *(const struct diffuse *)state;
    for (size_t i = 0; i < n; i++)
        f[i] = value(&m, dirs_at(wo, i), dirs_at(wi, i));
}

static double pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    (void)state;
    return wo.z > 0 && wi.z > 0 ? wi.z / PI : 0;
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct diffuse *m = state;
    const double r = sqrt(u.x), phi = 2 * PI * u.y;
    const struct vec3 wi = { r * cos(phi), r * sin(phi), sqrt(1 - u.x) };
    if (!(wo.z > 0))
        return (struct bsdf_sample){ 0 };
    return (struct bsdf_sample){ .wi = wi,
                                 .pdf = pdf(m, wo, wi),
                                 .weight = m->reflectance };
}

const struct bsdf_type type_diffuse = {
    .name = "diffuse",
    .about = "matt surface (Lambert)",
    .params = params,
    .size = sizeof(struct diffuse),
    .claims = claims,
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
    .eval_many = eval_many,
};
