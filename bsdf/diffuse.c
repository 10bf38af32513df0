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

LANES static void direction_lanes(size_t n, struct dirs u, double *x, double *y,
                                  double *z)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct vec3 w = direction(dirs_at(u, i));
        x[i] = w.x, y[i] = w.y, z[i] = w.z;
    }
}

static void sample_many(const void *state, size_t n, struct dirs wo,
                        struct dirs u, struct bsdf_sample *s)
{
    const struct diffuse m = *(const struct diffuse *)state;
    double x[LANES_MAX], y[LANES_MAX], z[LANES_MAX];
    for (size_t at = 0, k; at < n; at += k) {
        k = n - at < LANES_MAX ? n - at : LANES_MAX;
        direction_lanes(k, dirs_from(u, at), x, y, z);
        for (size_t i = 0; i < k; i++) {
            const double cos_o = wo.z[at + i];
            s[at + i] = cos_o > 0
                            ? (struct bsdf_sample){ .wi = { x[i], y[i], z[i] },
                                                    .pdf = density(cos_o, z[i]),
                                                    .weight = m.reflectance }
                            : (struct bsdf_sample){ 0 };
        }
    }
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
