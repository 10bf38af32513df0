/* twosided.c - a reflecting model on both sides of a surface
 *
 * Seen from below, the model of that side is looked at in the mirror of the
 * surface: the z of both directions changes its sign.
 */
#include "bsdf/types.h"

struct twosided {
    struct bsdf *front, *back;
};

static const struct bsdf_param params[] = {
    { "front", BSDF_NESTED, offsetof(struct twosided, front), NULL, 0, 0, NULL,
      "the model above, as in front=(diffuse)" },
    { "back", BSDF_NESTED, offsetof(struct twosided, back), NULL, 0, 0, NULL,
      "the model below; as above if not given" },
    { 0 },
};

static bool init(void *state, const struct bands *bands, struct err *err)
{
    const struct twosided *m = state;
    (void)bands;
    if (!m->front)
        return err_set(err, "twosided: expected a model, as in "
                            "front=(diffuse)");
    const struct bsdf *const side[] = { m->front, m->back };
    for (int i = 0; i < 2; i++)
        if (side[i] && (bsdf_claims(side[i]).lobes & BSDF_TRANSMISSION))
            return err_set(err,
                           "twosided: \"%.200s\" transmits; expected models "
                           "that only reflect",
                           bsdf_spec(side[i]));
    return true;
}

static const struct bsdf *below(const struct twosided *m)
{
    return m->back ? m->back : m->front;
}

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    const struct twosided *m = state;
    (void)bands;
    const struct bsdf_claims a = bsdf_claims(m->front);
    const struct bsdf_claims b = bsdf_claims(below(m));
    return (struct bsdf_claims){
        .lobes = a.lobes | b.lobes,
        .lossless = a.lossless && b.lossless,
        .reciprocal = a.reciprocal && b.reciprocal,
        .two_sided = true,
        .eta = 1,
    };
}

static struct vec3 flipped(struct vec3 w)
{
    return (struct vec3){ w.x, w.y, -w.z };
}

static struct spectrum eval(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct twosided *m = state;
    return wo.z < 0 ? bsdf_eval(below(m), flipped(wo), flipped(wi))
                    : bsdf_eval(m->front, wo, wi);
}

static double pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct twosided *m = state;
    return wo.z < 0 ? bsdf_pdf(below(m), flipped(wo), flipped(wi))
                    : bsdf_pdf(m->front, wo, wi);
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct twosided *m = state;
    if (!(wo.z < 0))
        return bsdf_sample(m->front, wo, u);
    struct bsdf_sample s = bsdf_sample(below(m), flipped(wo), u);
    if (s.pdf > 0)
        s.wi = flipped(s.wi);
    return s;
}

const struct bsdf_type type_twosided = {
    .name = "twosided",
    .about = "a reflecting model on both sides",
    .params = params,
    .size = sizeof(struct twosided),
    .claims = claims,
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
    .init = init,
};
