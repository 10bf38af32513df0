/* broken.c - one formula each, with a switch for one mistake */
#include "tests/broken.h"

#include "bsdf/ndf.h"

enum fault {
    NONE,
    MASKING_TWICE, /* G1(wo)^2 for G1(wo) G1(wi) [5] */
    SAMPLED_ALPHA, /* sampled with alpha times size [6] */
    NO_COS_H,      /* the pdf lacks cos(theta_h) [6] */
    F_BELOW,       /* f goes on below the horizon [14] */
    PDF_BELOW,     /* and the pdf does [14] */
    NO_COSINE,     /* the weight is f / pdf */
    PDF_FACTOR,    /* pdf, and the sample's, times size; its weight over it */
    F_FACTOR,      /* f and weight times size */
    WEIGHT_FACTOR, /* the weight alone times size */
    SAMPLE_PDF,    /* the sample's pdf alone times size */
    REFUSES,       /* a share size of good samples is refused */
    LEAKS,         /* a share size goes anywhere within 45 deg, or 15 alpha */
    NAN_F,         /* f is no number within a cosine of size to the horizon */
    NEGATIVE_PDF,  /* the pdf is negative there */
    LONG_WI,       /* sampled directions are longer than 1 by size */
    G1_FACTOR,     /* the model shows G1 times size */
    HALF,          /* the pdf is 0 where wi.y < 0, and so are samples refused */
    RARE_NAN,      /* the weight is no number in a share size of samples */
    HUGE_F,        /* f times 1e300 */
    FORGETFUL,     /* another sample each time that it is asked */
};

static const char *const faults[] = {
    "none",          "masking_twice",
    "sampled_alpha", "no_cos_h",
    "f_below",       "pdf_below",
    "no_cosine",     "pdf_factor",
    "f_factor",      "weight_factor",
    "sample_pdf",    "refuses",
    "leaks",         "nan_f",
    "negative_pdf",  "long_wi",
    "g1_factor",     "half",
    "rare_nan",      "huge_f",
    "forgetful",     NULL,
};

struct metal {
    double alpha, size;
    int visible, fault;
};

static const struct bsdf_param metal_params[] = {
    { "alpha", BSDF_NUMBER, offsetof(struct metal, alpha), "0.3", 1e-4, 1, NULL,
      "roughness" },
    { "visible", BSDF_FLAG, offsetof(struct metal, visible), "false", 0, 0,
      NULL, "sample visible normals" },
    { "fault", BSDF_CHOICE, offsetof(struct metal, fault), "none", 0, 0, faults,
      "what is wrong" },
    { "size", BSDF_NUMBER, offsetof(struct metal, size), "1", 0, 10, NULL,
      "by how much" },
    { 0 },
};

static struct bsdf_claims metal_claims(const void *state,
                                       const struct bands *bands)
{
    (void)state, (void)bands;
    return (struct bsdf_claims){ .lobes = BSDF_GLOSSY_REFLECTION,
                                 .reciprocal = true,
                                 .eta = 1 };
}

static double g1(const struct metal *m, struct vec3 w)
{
    return ndf_g1(&ndf_beckmann, m->alpha, m->alpha, w);
}

static double d(const struct metal *m, struct vec3 h)
{
    return ndf_d(&ndf_beckmann, m->alpha, m->alpha, h);
}

static struct vec3 half(struct vec3 wo, struct vec3 wi)
{
    return vec3_unit(vec3_add(wo, wi));
}

static double f_value(const struct metal *m, struct vec3 wo, struct vec3 wi)
{
    if (m->fault == F_BELOW && wi.z < 0)
        wi.z = -wi.z;
    if (!(wo.z > 0 && wi.z > 0))
        return 0;
    if (m->fault == NAN_F && wi.z < m->size)
        return NAN;
    const double other = m->fault == MASKING_TWICE ? g1(m, wo) : g1(m, wi);
    const double f = d(m, half(wo, wi)) * g1(m, wo) * other / (4 * wo.z * wi.z);
    return m->fault == F_FACTOR ? f * m->size
           : m->fault == HUGE_F ? f * 1e300
                                : f;
}

static struct spectrum metal_eval(const void *state, struct vec3 wo,
                                  struct vec3 wi)
{
    return spectrum_of(3, f_value(state, wo, wi));
}

static double metal_pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct metal *m = state;
    if (m->fault == PDF_BELOW && wi.z < 0)
        wi.z = -wi.z;
    if (!(wo.z > 0 && wi.z > 0))
        return 0;
    const struct vec3 h = half(wo, wi);
    double pdf = m->visible ? g1(m, wo) * d(m, h) / (4 * wo.z)
                            : d(m, h) * h.z / (4 * vec3_dot(wi, h));
    if (m->fault == NO_COS_H)
        pdf /= h.z;
    if (m->fault == HALF && wi.y < 0)
        return 0;
    if (m->fault == PDF_FACTOR)
        pdf *= m->size;
    if (m->fault == NEGATIVE_PDF && wi.z < m->size)
        pdf = -pdf;
    return pdf;
}

static struct bsdf_sample metal_sample(const void *state, struct vec3 wo,
                                       struct vec3 u)
{
    const struct metal *m = state;
    const struct bsdf_sample refused = { 0 };
    const double alpha = m->alpha * (m->fault == SAMPLED_ALPHA ? m->size : 1);
    static _Atomic unsigned calls;
    if (m->fault == FORGETFUL)
        u.y = fmod(u.y + 0.618 * (double)(++calls), 1);
    if (!(wo.z > 0) || (m->fault == REFUSES && u.z < m->size))
        return refused;
    const struct vec3 h =
        m->visible
            ? ndf_sample_visible(&ndf_beckmann, alpha, alpha, wo, u.x, u.y)
            : ndf_sample_all(&ndf_beckmann, alpha, alpha, u.x, u.y);
    struct vec3 wi = vec3_reflect(wo, h);
    if (m->fault == LEAKS && u.z < m->size) {
        /* Not as far as the pdf underflows to 0, where it would be refused. */
        const double rim = fmax(0.7, cos(15 * fmin(m->alpha, 0.2)));
        const double z = rim + (1 - rim) * u.x, phi = 2 * PI * u.y;
        const double r = sqrt((1 - z) * (1 + z));
        wi = (struct vec3){ r * cos(phi), r * sin(phi), z };
    }
    const double pdf = metal_pdf(m, wo, wi);
    if (!(wi.z > 0 && pdf != 0))
        return refused;
    double weight = f_value(m, wo, wi) * wi.z / pdf;
    if (m->fault == NO_COSINE)
        weight /= wi.z;
    if (m->fault == WEIGHT_FACTOR)
        weight *= m->size;
    if (m->fault == RARE_NAN && u.z < m->size)
        weight = NAN;
    return (struct bsdf_sample){
        .wi = vec3_scale(m->fault == LONG_WI ? 1 + m->size : 1, wi),
        .pdf = m->fault == SAMPLE_PDF ? pdf * m->size : pdf,
        .weight = spectrum_of(3, weight),
    };
}

static double metal_d(const void *state, struct vec3 h)
{
    return d(state, h);
}

static double metal_g1(const void *state, struct vec3 w)
{
    const struct metal *m = state;
    return g1(m, w) * (m->fault == G1_FACTOR ? m->size : 1);
}

const struct bsdf_type type_broken_metal = {
    .name = "broken_metal",
    .about = "rough mirror with a fault",
    .params = metal_params,
    .size = sizeof(struct metal),
    .claims = metal_claims,
    .eval = metal_eval,
    .pdf = metal_pdf,
    .sample = metal_sample,
    .facet_d = metal_d,
    .facet_g1 = metal_g1,
};

struct matt {
    int fault;
};

static const char *const matt_faults[] = { "none", "no_pi", NULL };
static const struct bsdf_param matt_params[] = {
    { "fault", BSDF_CHOICE, offsetof(struct matt, fault), "none", 0, 0,
      matt_faults, "what is wrong" },
    { 0 },
};

static struct bsdf_claims matt_claims(const void *state,
                                      const struct bands *bands)
{
    (void)state, (void)bands;
    return (struct bsdf_claims){ .lobes = BSDF_DIFFUSE_REFLECTION,
                                 .reciprocal = true,
                                 .eta = 1 };
}

static struct spectrum matt_eval(const void *state, struct vec3 wo,
                                 struct vec3 wi)
{
    const struct matt *m = state;
    const bool above = wo.z > 0 && wi.z > 0;
    return spectrum_of(3, above ? 0.5 / (m->fault ? 1 : PI) : 0);
}

static double matt_pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    (void)state;
    return wo.z > 0 && wi.z > 0 ? wi.z / PI : 0;
}

static struct bsdf_sample matt_sample(const void *state, struct vec3 wo,
                                      struct vec3 u)
{
    const double r = sqrt(u.x), phi = 2 * PI * u.y;
    const struct vec3 wi = { r * cos(phi), r * sin(phi), sqrt(1 - u.x) };
    const double pdf = matt_pdf(state, wo, wi);
    if (!(pdf > 0))
        return (struct bsdf_sample){ 0 };
    return (struct bsdf_sample){
        .wi = wi,
        .pdf = pdf,
        .weight = spectrum_scale(wi.z / pdf, matt_eval(state, wo, wi)),
    };
}

const struct bsdf_type type_broken_diffuse = {
    .name = "broken_diffuse",
    .about = "matt surface with a fault",
    .params = matt_params,
    .size = sizeof(struct matt),
    .claims = matt_claims,
    .eval = matt_eval,
    .pdf = matt_pdf,
    .sample = matt_sample,
};

struct flat {
    double size;
    int fault;
};

enum { TILTED = 1, RARE };
static const char *const flat_faults[] = { "none", "tilted", "rare", NULL };
static const struct bsdf_param flat_params[] = {
    { "fault", BSDF_CHOICE, offsetof(struct flat, fault), "none", 0, 0,
      flat_faults, "what is wrong" },
    { "size", BSDF_NUMBER, offsetof(struct flat, size), "0", 0, 1, NULL,
      "by how much" },
    { 0 },
};

static struct bsdf_claims flat_claims(const void *state,
                                      const struct bands *bands)
{
    (void)state, (void)bands;
    return (struct bsdf_claims){ .lobes = BSDF_DELTA_REFLECTION,
                                 .reciprocal = true,
                                 .eta = 1 };
}

static struct spectrum flat_eval(const void *state, struct vec3 wo,
                                 struct vec3 wi)
{
    (void)state, (void)wo, (void)wi;
    return (struct spectrum){ { 0 } };
}

static double flat_pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    (void)state, (void)wo, (void)wi;
    return 0;
}

static struct bsdf_sample flat_sample(const void *state, struct vec3 wo,
                                      struct vec3 u)
{
    const struct flat *m = state;
    if (!(wo.z > 0) || (m->fault == RARE && u.x >= m->size))
        return (struct bsdf_sample){ 0 };
    const double tilt = m->fault == TILTED ? m->size : 0;
    return (struct bsdf_sample){
        .wi = vec3_unit((struct vec3){ -wo.x + tilt, -wo.y, wo.z }),
        .pdf = 1,
        .weight = spectrum_of(3, 1),
        .delta = true,
    };
}

const struct bsdf_type type_broken_mirror = {
    .name = "broken_mirror",
    .about = "mirror with a fault",
    .params = flat_params,
    .size = sizeof(struct flat),
    .claims = flat_claims,
    .eval = flat_eval,
    .pdf = flat_pdf,
    .sample = flat_sample,
};
