/* broken_layers.c - what is made of other models: a mixture, a coat, a wrapper
 *
 * In each, what is wrong is mixed in with a share of size, 1 if not given.
 */
#include "bsdf/fresnel.h"
#include "tests/broken.h"

static double mixed(double right, double wrong, double share)
{
    return right + share * (wrong - right);
}

/* The rest of u.z, uniform again, once it has been drawn by a share below
 * which it is first. */
static struct vec3 rest(struct vec3 u, double share, bool first)
{
    const double z = first ? u.z / share : (u.z - share) / (1 - share);
    return (struct vec3){ u.x, u.y, fmin(z, 1 - 0x1p-53) };
}

/* -- a mixture ------------------------------------------------------------- */

/*   f = (1 - tint) a + tint b, the tint one a band
 *   pdf = (1 - w) pdf_a + w pdf_b, w the largest tint
 */
struct mix {
    struct bsdf *a, *b;
    struct spectrum tint;
    double largest, least; /* of the tints */
    double size;
    int fault, bands;
};

enum {
    ONE_LOBE = 1,  /* a sample's pdf and weight are those of its lobe [16] */
    WRONG_TESTED,  /* b's pdf only where a has one [9] */
    REMAP,         /* (u - w) / w for (u - w) / (1 - w) [15] */
    NO_WEIGHT,     /* f lacks the share of b [17] */
    MAX_AND_MIN,   /* drawn by the largest tint, pdf by the least [18] */
    OTHER_SHARE,   /* b is drawn with w + size (1 - w) / 2 [19] */
    SQUARED,       /* w^2 in sampling and pdf: another choice, no fault [22] */
    PDF_NO_WEIGHT, /* the pdf lacks the share of b */
    BY_FIRST,      /* the number that chooses goes on as the first: no fault */
};
static const char *const mix_faults[] = {
    "none",        "one_lobe",    "wrong_tested", "remap",         "no_weight",
    "max_and_min", "other_share", "squared",      "pdf_no_weight", "by_first",
    NULL
};

#define FIELD(name) offsetof(struct mix, name)
static const struct bsdf_param mix_params[] = {
    { "a", BSDF_NESTED, FIELD(a), "(diffuse)", 0, 0, NULL, "one model" },
    { "b", BSDF_NESTED, FIELD(b), "(roughconductor:alpha=0.3)", 0, 0, NULL,
      "the other" },
    { "tint", BSDF_SPECTRUM, FIELD(tint), "0.5", 0, 1, NULL, "share of b" },
    { "fault", BSDF_CHOICE, FIELD(fault), "none", 0, 0, mix_faults,
      "what is wrong" },
    { "size", BSDF_NUMBER, FIELD(size), "1", 0, 1, NULL, "share of it" },
    { 0 },
};
#undef FIELD

static bool mix_init(void *state, const struct bands *bands, struct err *err)
{
    struct mix *m = state;
    (void)err;
    m->bands = bands->count;
    m->largest = m->least = m->tint.band[0];
    for (int b = 1; b < m->bands; b++) {
        m->largest = fmax(m->largest, m->tint.band[b]);
        m->least = fmin(m->least, m->tint.band[b]);
    }
    return true;
}

static struct bsdf_claims mix_claims(const void *state,
                                     const struct bands *bands)
{
    const struct mix *m = state;
    (void)bands;
    const struct bsdf_claims a = bsdf_claims(m->a), b = bsdf_claims(m->b);
    return (struct bsdf_claims){
        .lobes = a.lobes | b.lobes,
        .reciprocal = true,
        .eta = (a.lobes & BSDF_TRANSMISSION) ? a.eta : b.eta,
    };
}

/* With what probability b is drawn, and what the pdf takes that for. */
static double mix_drawn(const struct mix *m)
{
    const double w = m->largest;
    return m->fault == OTHER_SHARE ? w + m->size * (1 - w) / 2
           : m->fault == SQUARED   ? mixed(w, w * w, m->size)
                                   : w;
}

static double mix_share(const struct mix *m)
{
    return m->fault == MAX_AND_MIN ? mixed(m->largest, m->least, m->size)
           : m->fault == SQUARED   ? mix_drawn(m)
                                   : m->largest;
}

static struct spectrum mix_eval(const void *state, struct vec3 wo,
                                struct vec3 wi)
{
    const struct mix *m = state;
    const struct spectrum a = bsdf_eval(m->a, wo, wi);
    struct spectrum f = bsdf_eval(m->b, wo, wi);
    for (int i = 0; i < m->bands; i++) {
        const double t = m->tint.band[i];
        f.band[i] =
            (1 - t) * a.band[i] +
            (m->fault == NO_WEIGHT ? mixed(t, 1, m->size) : t) * f.band[i];
    }
    return f;
}

static double mix_pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct mix *m = state;
    const double w = mix_share(m);
    const double a = bsdf_pdf(m->a, wo, wi);
    double b = bsdf_pdf(m->b, wo, wi);
    if (m->fault == WRONG_TESTED && !(a > 0))
        b *= 1 - m->size;
    return (1 - w) * a +
           (m->fault == PDF_NO_WEIGHT ? mixed(w, 1, m->size) : w) * b;
}

static struct bsdf_sample mix_sample(const void *state, struct vec3 wo,
                                     struct vec3 u)
{
    const struct mix *m = state;
    const double w = mix_drawn(m);
    const bool second = u.z < w;
    struct vec3 left = rest(u, w, second);
    if (m->fault == REMAP || m->fault == BY_FIRST) {
        left = (struct vec3){ left.z, u.y, u.x };
        if (m->fault == REMAP && !second)
            left.x = mixed(left.x, (u.z - w) / w, m->size);
    }
    struct bsdf_sample s = bsdf_sample(second ? m->b : m->a, wo, left);
    if (!(s.pdf > 0))
        return s;
    const struct bsdf_sample lobe = s;
    s.pdf = mix_pdf(m, wo, s.wi);
    s.weight = spectrum_scale(fabs(s.wi.z) / s.pdf, mix_eval(m, wo, s.wi));
    if (m->fault == NO_WEIGHT) { /* the sampler has it right */
        struct mix right = *m;
        right.fault = 0;
        s.weight =
            spectrum_scale(fabs(s.wi.z) / s.pdf, mix_eval(&right, wo, s.wi));
    }
    if (m->fault == ONE_LOBE) {
        s.pdf = mixed(s.pdf, lobe.pdf, m->size);
        for (int i = 0; i < m->bands; i++)
            s.weight.band[i] =
                mixed(s.weight.band[i], lobe.weight.band[i], m->size);
    }
    return s;
}

const struct bsdf_type type_broken_mix = {
    .name = "broken_mix",
    .about = "two models mixed, with a fault",
    .params = mix_params,
    .size = sizeof(struct mix),
    .claims = mix_claims,
    .eval = mix_eval,
    .pdf = mix_pdf,
    .sample = mix_sample,
    .init = mix_init,
};

/* -- a coat ---------------------------------------------------------------- */

/* A smooth coat of index n above a base that only reflects.  With w' the
 * refraction of w into the coat, F its reflectance, T = 1 - F:
 *
 *   f   = T(wo) T(wi) f_base(wo', wi') / n^2
 *   pdf = T(wo) pdf_base(wo', wi') cos_i / (n^2 cos_i')
 *
 * and a mirror of probability F(wo).  1 / n^2 is radiance's on its way out,
 * and cos_i / (n^2 cos_i') = dw_i' / dw_i.  What the base sends back to the
 * coat below its critical angle, or what the coat reflects down again, is lost:
 * less light than there is, but reciprocal.
 *
 * A. Weidlich and A. Wilkie, Arbitrarily Layered Micro-Facet Surfaces,
 * GRAPHITE 2007; for 1 / n^2 E. Veach, Robust Monte Carlo Methods for Light
 * Transport Simulation, 1997, sec. 5.2.
 */
struct coat {
    struct bsdf *base;
    double eta, albedo, size;
    int fault, bands;
};

enum {
    COSINE_RATIO = 1, /* f has cos_i / cos_i' once more [11] */
    COAT_JACOBIAN,    /* the pdf lacks cos_i / (n^2 cos_i') [12] */
    ALBEDO_TWICE,     /* the base's weight is divided by its albedo [23] */
    COAT_NO_SHARE,    /* the pdf lacks T(wo) [20] */
};
static const char *const coat_faults[] = { "none",     "cosine_ratio",
                                           "jacobian", "albedo_twice",
                                           "no_share", NULL };

#define FIELD(name) offsetof(struct coat, name)
static const struct bsdf_param coat_params[] = {
    { "base", BSDF_NESTED, FIELD(base), "(diffuse)", 0, 0, NULL,
      "what is coated" },
    { "eta", BSDF_NUMBER, FIELD(eta), "1.5", 1, 10, NULL, "index of the coat" },
    { "albedo", BSDF_NUMBER, FIELD(albedo), "0.5", 0.01, 1, NULL,
      "of the base, by which a fault divides" },
    { "fault", BSDF_CHOICE, FIELD(fault), "none", 0, 0, coat_faults,
      "what is wrong" },
    { "size", BSDF_NUMBER, FIELD(size), "1", 0, 1, NULL, "share of it" },
    { 0 },
};
#undef FIELD

static bool coat_init(void *state, const struct bands *bands, struct err *err)
{
    struct coat *m = state;
    m->bands = bands->count;
    if (bsdf_claims(m->base).lobes & (BSDF_TRANSMISSION | BSDF_DELTA))
        return err_set(err, "broken_coat: expected a base that reflects and "
                            "has no delta lobe");
    return true;
}

static struct bsdf_claims coat_claims(const void *state,
                                      const struct bands *bands)
{
    const struct coat *m = state;
    (void)bands;
    const struct bsdf_claims base = bsdf_claims(m->base);
    return (struct bsdf_claims){ .lobes = base.lobes | BSDF_DELTA_REFLECTION,
                                 .reciprocal = base.reciprocal,
                                 .eta = 1 };
}

/* w inside the coat, on the same side of the surface, and how much of what
 * comes from w gets there. */
struct inside {
    struct vec3 w;
    double through;
};

static struct inside enter(const struct coat *m, struct vec3 w)
{
    double cos_t;
    (void)fresnel_dielectric(fmin(w.z, 1), m->eta, &cos_t);
    return (struct inside){
        .w = vec3_unit((struct vec3){ w.x / m->eta, w.y / m->eta, cos_t }),
        .through = fresnel_dielectric_through(fmin(w.z, 1), cos_t, m->eta),
    };
}

static double coat_dense(const struct coat *m, struct vec3 wi, struct inside i)
{
    return wi.z / (m->eta * m->eta * i.w.z);
}

static struct spectrum coat_eval(const void *state, struct vec3 wo,
                                 struct vec3 wi)
{
    const struct coat *m = state;
    if (!(wo.z > 0 && wi.z > 0))
        return (struct spectrum){ { 0 } };
    const struct inside o = enter(m, wo), i = enter(m, wi);
    double factor = o.through * i.through / (m->eta * m->eta);
    if (m->fault == COSINE_RATIO)
        factor *= mixed(1, wi.z / i.w.z, m->size);
    return spectrum_scale(factor, bsdf_eval(m->base, o.w, i.w));
}

static double coat_pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct coat *m = state;
    if (!(wo.z > 0 && wi.z > 0))
        return 0;
    const struct inside o = enter(m, wo), i = enter(m, wi);
    const double dense = coat_dense(m, wi, i);
    const double share =
        m->fault == COAT_NO_SHARE ? mixed(o.through, 1, m->size) : o.through;
    return share * bsdf_pdf(m->base, o.w, i.w) *
           (m->fault == COAT_JACOBIAN ? mixed(dense, 1, m->size) : dense);
}

static struct bsdf_sample coat_sample(const void *state, struct vec3 wo,
                                      struct vec3 u)
{
    const struct coat *m = state;
    const struct bsdf_sample refused = { 0 };
    if (!(wo.z > 0))
        return refused;
    const struct inside o = enter(m, wo);
    const double reflected = 1 - o.through;
    if (u.z < reflected)
        return (struct bsdf_sample){ .wi = { -wo.x, -wo.y, wo.z },
                                     .pdf = reflected,
                                     .weight = spectrum_of(m->bands, 1),
                                     .delta = true };
    struct bsdf_sample s = bsdf_sample(m->base, o.w, rest(u, reflected, false));
    if (!(s.pdf > 0 && s.wi.z > 0))
        return refused;
    /* Out again: n sin_i' = sin_i, unless it is reflected back in. */
    const double z2 = 1 - m->eta * m->eta * (1 - s.wi.z) * (1 + s.wi.z);
    if (!(z2 > 0))
        return refused;
    s.wi =
        vec3_unit((struct vec3){ m->eta * s.wi.x, m->eta * s.wi.y, sqrt(z2) });
    s.pdf = coat_pdf(m, wo, s.wi);
    s.weight = spectrum_scale(s.wi.z / s.pdf, coat_eval(m, wo, s.wi));
    if (m->fault == ALBEDO_TWICE)
        s.weight = spectrum_scale(mixed(1, 1 / m->albedo, m->size), s.weight);
    return s;
}

const struct bsdf_type type_broken_coat = {
    .name = "broken_coat",
    .about = "smooth coat over a base, with a fault",
    .params = coat_params,
    .size = sizeof(struct coat),
    .claims = coat_claims,
    .eval = coat_eval,
    .pdf = coat_pdf,
    .sample = coat_sample,
    .init = coat_init,
};

/* -- a wrapper ------------------------------------------------------------- */

/* Another model, as it is. */
struct wrapper {
    struct bsdf *inner;
    double size;
    int fault;
};

/* The pdf is that of a base class, cos_i / pi [7]. */
enum { DEFAULT_PDF = 1 };
static const char *const wrapper_faults[] = { "none", "default_pdf", NULL };

static const struct bsdf_param wrapper_params[] = {
    { "inner", BSDF_NESTED, offsetof(struct wrapper, inner),
      "(roughconductor:alpha=0.3)", 0, 0, NULL, "what is wrapped" },
    { "fault", BSDF_CHOICE, offsetof(struct wrapper, fault), "none", 0, 0,
      wrapper_faults, "what is wrong" },
    { "size", BSDF_NUMBER, offsetof(struct wrapper, size), "1", 0, 1, NULL,
      "share of it" },
    { 0 },
};

static struct bsdf_claims wrapper_claims(const void *state,
                                         const struct bands *bands)
{
    (void)bands;
    return bsdf_claims(((const struct wrapper *)state)->inner);
}

static struct spectrum wrapper_eval(const void *state, struct vec3 wo,
                                    struct vec3 wi)
{
    return bsdf_eval(((const struct wrapper *)state)->inner, wo, wi);
}

static double wrapper_pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct wrapper *m = state;
    const double right = bsdf_pdf(m->inner, wo, wi);
    return m->fault == DEFAULT_PDF && wo.z > 0 && wi.z > 0
               ? mixed(right, wi.z / PI, m->size)
               : right;
}

static struct bsdf_sample wrapper_sample(const void *state, struct vec3 wo,
                                         struct vec3 u)
{
    return bsdf_sample(((const struct wrapper *)state)->inner, wo, u);
}

const struct bsdf_type type_broken_wrapper = {
    .name = "broken_wrapper",
    .about = "another model, with a fault",
    .params = wrapper_params,
    .size = sizeof(struct wrapper),
    .claims = wrapper_claims,
    .eval = wrapper_eval,
    .pdf = wrapper_pdf,
    .sample = wrapper_sample,
};
