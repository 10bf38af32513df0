/* broken.c - one formula each, with a switch for one mistake */
#include "tests/broken.h"

#include "bsdf/fresnel.h"
#include "bsdf/ndf.h"

/* By size: what is wrong is mixed in with that share, so that 1 is the mistake
 * in full, unless a line says otherwise. */
enum fault {
    NONE,
    MASKING_TWICE,  /* G1(wo)^2 for G1(wo) G1(wi) [5] */
    SAMPLED_ALPHA,  /* sampled with alpha times size [6] */
    NO_COS_H,       /* the pdf lacks cos(theta_h) [6] */
    F_BELOW,        /* f goes on below the horizon [14] */
    PDF_BELOW,      /* and the pdf does [14] */
    NO_COSINE,      /* the weight is f / pdf */
    PDF_FACTOR,     /* pdf, and the sample's, times size; its weight over it */
    F_FACTOR,       /* f and weight times size */
    WEIGHT_FACTOR,  /* the weight alone times size */
    SAMPLE_PDF,     /* the sample's pdf alone times size */
    REFUSES,        /* a share size of good samples is refused */
    LEAKS,          /* a share size goes anywhere within 45 deg, or 15
                       alpha */
    NAN_F,          /* f is no number within a cosine of size to the horizon */
    NEGATIVE_PDF,   /* the pdf is negative there */
    LONG_WI,        /* sampled directions are longer than 1 by size */
    G1_FACTOR,      /* the model shows G1 times size */
    HALF,           /* the pdf is 0 where wi.y < size - 1, and so are samples
                       refused */
    RARE_NAN,       /* the weight is no number in a share size of samples */
    HUGE_F,         /* f times 1e300 */
    FORGETFUL,      /* another sample each time that it is asked */
    NO_JACOBIAN,    /* the pdf lacks 1 / (4 wi.h) */
    NO_COS_O,       /* f lacks 1 / cos_o */
    F_COS_I,        /* f has the cosine that eval must not have */
    NO_MASKING,     /* f lacks G */
    G_SQUARED,      /* f has G twice */
    PDF_NO_MASKING, /* the pdf of visible normals lacks G1(wo) */
    PDF_MASKING,    /* and has it twice */
    SWAPPED_ALPHAS, /* sampled with alpha_u and alpha_v the wrong way round */
    LAMBDA_PI,      /* Lambda has pi for sqrt(pi) [28] */
    FRESNEL_NORMAL, /* F at n.wi for h.wi [28] */
    D_FACTOR,       /* D times size, but not in the pdf [27] */
    ZERO_ALPHA,     /* D of f with an alpha_u of 0 [26] */
    GRAZING_WO,     /* f and pdf at wo.z = 0 [26] */
    UNDERFLOW,      /* a ratio of two D that both underflow [26] */
    FLOAT_U,        /* u is rounded to float, and may be 1 [26] */
};

static const char *const faults[] = {
    "none",
    "masking_twice",
    "sampled_alpha",
    "no_cos_h",
    "f_below",
    "pdf_below",
    "no_cosine",
    "pdf_factor",
    "f_factor",
    "weight_factor",
    "sample_pdf",
    "refuses",
    "leaks",
    "nan_f",
    "negative_pdf",
    "long_wi",
    "g1_factor",
    "half",
    "rare_nan",
    "huge_f",
    "forgetful",
    "no_jacobian",
    "no_cos_o",
    "f_cos_i",
    "no_masking",
    "g_squared",
    "pdf_no_masking",
    "pdf_masking",
    "swapped_alphas",
    "lambda_pi",
    "fresnel_normal",
    "d_factor",
    "zero_alpha",
    "grazing_wo",
    "underflow",
    "float_u",
    NULL,
};

struct metal {
    double alpha, alpha_v, r0, size;
    int visible, fault;
};

#define FIELD(name) offsetof(struct metal, name)
static const struct bsdf_param metal_params[] = {
    { "alpha", BSDF_NUMBER, FIELD(alpha), "0.3", 1e-4, 1, NULL,
      "roughness along x" },
    { "alpha_v", BSDF_NUMBER, FIELD(alpha_v), NULL, 1e-4, 1, NULL,
      "roughness along y; alpha if not given" },
    { "r0", BSDF_NUMBER, FIELD(r0), "1", 0, 1, NULL,
      "reflectance at the normal, Schlick's" },
    { "visible", BSDF_FLAG, FIELD(visible), "false", 0, 0, NULL,
      "sample visible normals" },
    { "fault", BSDF_CHOICE, FIELD(fault), "none", 0, 0, faults,
      "what is wrong" },
    { "size", BSDF_NUMBER, FIELD(size), "1", 0, 10, NULL, "by how much" },
    { 0 },
};
#undef FIELD

static bool metal_init(void *state, const struct bands *bands, struct err *err)
{
    struct metal *m = state;
    (void)bands, (void)err;
    if (isnan(m->alpha_v))
        m->alpha_v = m->alpha;
    return true;
}

static struct bsdf_claims metal_claims(const void *state,
                                       const struct bands *bands)
{
    (void)state, (void)bands;
    return (struct bsdf_claims){ .lobes = BSDF_GLOSSY_REFLECTION,
                                 .reciprocal = true,
                                 .eta = 1 };
}

/* The wrong value where that is the fault, as far as size says. */
static double or_wrong(const struct metal *m, int fault, double right,
                       double wrong)
{
    return m->fault == fault ? right + m->size * (wrong - right) : right;
}

static double lambda(const struct metal *m, struct vec3 w)
{
    const double right = ndf_lambda(&ndf_beckmann, m->alpha, m->alpha_v, w);
    if (m->fault != LAMBDA_PI)
        return right;
    const double a = fabs(w.z) / hypot(m->alpha * w.x, m->alpha_v * w.y);
    return or_wrong(m, LAMBDA_PI, right,
                    (exp(-a * a) / (a * PI) - erfc(a)) / 2);
}

static double g1(const struct metal *m, struct vec3 w)
{
    return 1 / (1 + lambda(m, w));
}

static double d(const struct metal *m, struct vec3 h)
{
    return ndf_d(&ndf_beckmann, m->alpha, m->alpha_v, h);
}

/* D as f and the shown facets have it. */
static double d_of_f(const struct metal *m, struct vec3 h)
{
    const double right = d(m, h);
    if (m->fault == ZERO_ALPHA) {
        const double alpha_u = 0, x = h.x / (alpha_u * h.z);
        return exp(-x * x) / (PI * alpha_u * m->alpha_v);
    }
    return m->fault == D_FACTOR    ? right * m->size
           : m->fault == UNDERFLOW ? right * (right / right)
                                   : right;
}

static struct vec3 half(struct vec3 wo, struct vec3 wi)
{
    return vec3_unit(vec3_add(wo, wi));
}

static bool above(const struct metal *m, struct vec3 wo, struct vec3 wi)
{
    return wi.z > 0 && (m->fault == GRAZING_WO ? wo.z >= 0 : wo.z > 0);
}

static double fresnel(const struct metal *m, struct vec3 wi, struct vec3 h)
{
    const double right = fresnel_schlick(fmin(vec3_dot(wi, h), 1), m->r0);
    return or_wrong(m, FRESNEL_NORMAL, right,
                    fresnel_schlick(fmin(wi.z, 1), m->r0));
}

static double masking(const struct metal *m, struct vec3 wo, struct vec3 wi)
{
    const double o = g1(m, wo), g = o * g1(m, wi);
    return m->fault == MASKING_TWICE ? or_wrong(m, MASKING_TWICE, g, o * o)
           : m->fault == NO_MASKING  ? or_wrong(m, NO_MASKING, g, 1)
                                     : or_wrong(m, G_SQUARED, g, g * g);
}

static double f_value(const struct metal *m, struct vec3 wo, struct vec3 wi)
{
    double factor = 1;
    if (m->fault == F_BELOW && wi.z < 0) {
        wi.z = -wi.z;
        factor = m->size;
    }
    if (!above(m, wo, wi))
        return 0;
    if (m->fault == NAN_F && wi.z < m->size)
        return NAN;
    const struct vec3 h = half(wo, wi);
    const double f = factor * fresnel(m, wi, h) * d_of_f(m, h) *
                     masking(m, wo, wi) / (4 * wo.z * wi.z);
    switch (m->fault) {
    case F_FACTOR:
        return f * m->size;
    case HUGE_F:
        return f * 1e300;
    case NO_COS_O:
        return or_wrong(m, NO_COS_O, f, f * wo.z);
    default:
        return or_wrong(m, F_COS_I, f, f * wi.z);
    }
}

static struct spectrum metal_eval(const void *state, struct vec3 wo,
                                  struct vec3 wi)
{
    return spectrum_of(3, f_value(state, wo, wi));
}

static double metal_pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct metal *m = state;
    double factor = 1;
    if (m->fault == PDF_BELOW && wi.z < 0) {
        wi.z = -wi.z;
        factor = m->size;
    }
    if (!above(m, wo, wi) || (m->fault == HALF && wi.y < m->size - 1))
        return 0;
    const struct vec3 h = half(wo, wi);
    const double g = g1(m, wo);
    const double pdf =
        factor * (m->visible ? g * d(m, h) / (4 * wo.z)
                             : d(m, h) * h.z / (4 * vec3_dot(wi, h)));
    switch (m->fault) {
    case NO_COS_H:
        return or_wrong(m, NO_COS_H, pdf, pdf / h.z);
    case PDF_FACTOR:
        return pdf * m->size;
    case NEGATIVE_PDF:
        return wi.z < m->size ? -pdf : pdf;
    case NO_JACOBIAN:
        return or_wrong(m, NO_JACOBIAN, pdf, pdf * 4 * vec3_dot(wi, h));
    case PDF_NO_MASKING:
        return or_wrong(m, PDF_NO_MASKING, pdf, pdf / g);
    default:
        return or_wrong(m, PDF_MASKING, pdf, pdf * g);
    }
}

static struct vec3 sampled_h(const struct metal *m, struct vec3 wo,
                             struct vec3 u)
{
    double along_x = m->alpha, along_y = m->alpha_v;
    if (m->fault == SAMPLED_ALPHA) {
        along_x *= m->size;
        along_y *= m->size;
    }
    if (m->fault == SWAPPED_ALPHAS) {
        along_x = m->alpha * pow(m->alpha_v / m->alpha, m->size);
        along_y = m->alpha_v * pow(m->alpha / m->alpha_v, m->size);
    }
    if (m->fault == FLOAT_U)
        u = (struct vec3){ (float)u.x, (float)u.y, u.z };
    return m->visible
               ? ndf_sample_visible(&ndf_beckmann, along_x, along_y, wo, u.x,
                                    u.y)
               : ndf_sample_all(&ndf_beckmann, along_x, along_y, u.x, u.y);
}

static struct bsdf_sample metal_sample(const void *state, struct vec3 wo,
                                       struct vec3 u)
{
    const struct metal *m = state;
    const struct bsdf_sample refused = { 0 };
    static _Atomic unsigned calls;
    if (m->fault == FORGETFUL)
        u.y = fmod(u.y + 0.618 * (double)(++calls), 1);
    if (!(wo.z > 0) || (m->fault == REFUSES && u.z < m->size))
        return refused;
    struct vec3 wi = vec3_reflect(wo, sampled_h(m, wo, u));
    if (m->fault == LEAKS && u.z < m->size) {
        /* Not as far as the pdf underflows to 0, where it would be refused. */
        const double rim = fmax(0.7, cos(15 * fmin(m->alpha, 0.2)));
        const double z = rim + (1 - rim) * u.x, phi = 2 * PI * u.y;
        const double r = sqrt((1 - z) * (1 + z));
        wi = (struct vec3){ r * cos(phi), r * sin(phi), z };
    }
    const double pdf = metal_pdf(m, wo, wi);
    /* A NaN goes through where the fault is one. */
    if (m->fault == FLOAT_U ? wi.z <= 0 : !(wi.z > 0 && pdf != 0))
        return refused;
    double weight = f_value(m, wo, wi) * wi.z / pdf;
    weight = or_wrong(m, NO_COSINE, weight, weight / wi.z);
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
    return d_of_f(state, h);
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
    .init = metal_init,
    .facet_d = metal_d,
    .facet_g1 = metal_g1,
};

struct matt {
    double size;
    int fault;
};

static const char *const matt_faults[] = { "none", "no_pi", NULL };
static const struct bsdf_param matt_params[] = {
    { "fault", BSDF_CHOICE, offsetof(struct matt, fault), "none", 0, 0,
      matt_faults, "what is wrong" },
    { "size", BSDF_NUMBER, offsetof(struct matt, size), "1", 0, 1, NULL,
      "share of it" },
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
    const bool facing = wo.z > 0 && wi.z > 0;
    const double right = 0.5 / PI;
    const double f = m->fault ? right + m->size * (0.5 - right) : right;
    return spectrum_of(3, facing ? f : 0);
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
