/* diffuse.c - the ideal matt surface
 *
 *   f = reflectance / pi,  pdf = cos_i / pi on the side of wo, from above
 *
 * J. H. Lambert, Photometria, 1760.  Sampled through the disk: M. Pharr,
 * W. Jakob and G. Humphreys, Physically Based Rendering, 4th ed., 2023,
 * sec. A.5.3, with the plain polar map of the disk.
 */
#include "bsdf/fastmath.h"
#include "bsdf/lanes.h"
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

INLINE struct spectrum value(const struct diffuse *m, struct vec3 wo,
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

INLINE double density(double wo_z, double wi_z)
{
    const double p = wo_z > 0 ? wi_z / PI : 0;
    return wi_z > 0 ? p : 0;
}

static double pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    (void)state;
    return density(wo.z, wi.z);
}

LANES static void pdf_many(const void *state, size_t n, struct dirs wo,
                           struct dirs wi, double *p)
{
    (void)state;
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        p[i] = density(wo.z[i], wi.z[i]);
}

INLINE struct vec3 direction(struct vec3 u)
{
    const double r = sqrt(u.x);
    double sine, cosine;
    fm_sincos_turns(u.y, &sine, &cosine);
    return (struct vec3){ r * cosine, r * sine, sqrt(1 - u.x) };
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct diffuse *m = state;
    const struct vec3 wi = direction(u);
    if (!(wo.z > 0))
        return (struct bsdf_sample){ 0 };
    return (struct bsdf_sample){ .wi = wi,
                                 .pdf = density(wo.z, wi.z),
                                 .weight = m->reflectance };
}

LANES static void sample_lanes(const struct diffuse *state, size_t n,
                               struct dirs wo, struct dirs u,
                               const struct bsdf_samples *out)
{
    const struct diffuse m = *state;
    const struct bsdf_samples s = *out;
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct vec3 w = direction(dirs_at(u, i));
        const bool above = wo.z[i] > 0;
        s.x[i] = above ? w.x : 0;
        s.y[i] = above ? w.y : 0;
        s.z[i] = above ? w.z : 0;
        s.pdf[i] = density(wo.z[i], w.z);
    }
    for (int b = 0; b < BANDS_MAX && s.weight[b]; b++)
        LANES_LOOP
    for (size_t i = 0; i < n; i++)
        s.weight[b][i] = wo.z[i] > 0 ? m.reflectance.band[b] : 0;
}

static void sample_many(const void *state, size_t n, struct dirs wo,
                        struct dirs u, struct bsdf_samples out)
{
    sample_lanes(state, n, wo, u, &out);
    memset(out.delta, 0, n * sizeof *out.delta);
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
    .pdf_many = pdf_many,
    .sample_many = sample_many,
};
