/* blendbsdf.c - two models, mixed
 *
 *   f = (1 - weight) f_0 + weight f_1, and the pdf alike
 *
 * One of the two is drawn by its weight; what it gives is weighed by both,
 * unless it is a delta direction, where the other has no density.
 */
#include "bsdf/types.h"

struct blendbsdf {
    double weight;
    struct bsdf *bsdf_0, *bsdf_1;
    int bands;
};

#define FIELD(name) offsetof(struct blendbsdf, name)
static const struct bsdf_param params[] = {
    { "weight", BSDF_NUMBER, FIELD(weight), "0.5", 0, 1, NULL,
      "share of bsdf_1" },
    { "bsdf_0", BSDF_NESTED, FIELD(bsdf_0), NULL, 0, 0, NULL,
      "the first model, as in bsdf_0=(diffuse)" },
    { "bsdf_1", BSDF_NESTED, FIELD(bsdf_1), NULL, 0, 0, NULL,
      "the second model" },
    { 0 },
};

static bool init(void *state, const struct bands *bands, struct err *err)
{
    struct blendbsdf *m = state;
    m->bands = bands->count;
    if (!m->bsdf_0 || !m->bsdf_1)
        return err_set(err,
                       "blendbsdf: %s is missing; expected two models, as "
                       "in bsdf_0=(diffuse),bsdf_1=(mirror)",
                       m->bsdf_0 ? "bsdf_1" : "bsdf_0");
    const struct bsdf_claims a = bsdf_claims(m->bsdf_0);
    const struct bsdf_claims b = bsdf_claims(m->bsdf_1);
    if ((a.lobes & BSDF_TRANSMISSION) && (b.lobes & BSDF_TRANSMISSION) &&
        a.eta != b.eta)
        return err_set(err,
                       "blendbsdf: the models transmit with the indices %g and "
                       "%g; expected the same",
                       a.eta, b.eta);
    if (a.lobes & b.lobes & BSDF_DELTA)
        return err_set(err, "blendbsdf: both models have the same delta lobe, "
                            "whose probability neither knows of the other");
    return true;
}

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    const struct blendbsdf *m = state;
    (void)bands;
    const struct bsdf_claims a = bsdf_claims(m->bsdf_0);
    const struct bsdf_claims b = bsdf_claims(m->bsdf_1);
    return (struct bsdf_claims){
        .lobes = a.lobes | b.lobes,
        .lossless = a.lossless && b.lossless,
        .reciprocal = a.reciprocal && b.reciprocal,
        .two_sided = a.two_sided || b.two_sided,
        .eta = (a.lobes & BSDF_TRANSMISSION) ? a.eta : b.eta,
    };
}

static struct spectrum eval(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct blendbsdf *m = state;
    const struct spectrum a = bsdf_eval(m->bsdf_0, wo, wi);
    struct spectrum f = bsdf_eval(m->bsdf_1, wo, wi);
    for (int b = 0; b < m->bands; b++)
        f.band[b] = (1 - m->weight) * a.band[b] + m->weight * f.band[b];
    return f;
}

static double pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct blendbsdf *m = state;
    return (1 - m->weight) * bsdf_pdf(m->bsdf_0, wo, wi) +
           m->weight * bsdf_pdf(m->bsdf_1, wo, wi);
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct blendbsdf *m = state;
    const double w = m->weight;
    const bool second = u.z < w;
    /* The rest of u.z is uniform again; rounding must not make it 1. */
    u.z = fmin(second ? u.z / w : (u.z - w) / (1 - w), 1 - 0x1p-53);
    struct bsdf_sample s = bsdf_sample(second ? m->bsdf_1 : m->bsdf_0, wo, u);
    if (s.delta) {
        s.pdf *= second ? w : 1 - w;
        return s;
    }
    if (!(s.pdf > 0))
        return s;
    s.pdf = pdf(m, wo, s.wi);
    s.weight = spectrum_scale(fabs(s.wi.z) / s.pdf, eval(m, wo, s.wi));
    return s;
}

const struct bsdf_type type_blendbsdf = {
    .name = "blendbsdf",
    .about = "two models, mixed",
    .params = params,
    .size = sizeof(struct blendbsdf),
    .claims = claims,
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
    .init = init,
};
