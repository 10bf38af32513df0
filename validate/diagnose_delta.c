/* diagnose_delta.c - mistakes in single directions */
#include "bsdf/fresnel.h"
#include "validate/guess.h"

/* Whether wi is where wo would be refracted with 1 / eta for eta, which is
 * another direction unless both are straight. */
static bool upside_down(const struct subject *s, struct vec3 wi)
{
    const struct vec3 wo = s->wo;
    const double n = wo.z > 0 ? s->claims.eta : 1 / s->claims.eta;
    const double sine2 = n * n * (wo.x * wo.x + wo.y * wo.y);
    const struct vec3 there = { -n * wo.x, -n * wo.y,
                                copysign(sqrt(fmax(1 - sine2, 0)), -wo.z) };
    return fabs(n - 1) * sqrt(sine2) > 0.01 &&
           vec3_length(vec3_minus(wi, there)) < 1e-3;
}

void diagnose_delta(struct guess *g, const struct subject *s)
{
    const struct survey *v = &s->survey;
    for (int k = 0; k < v->deltas; k++) {
        const struct delta *d = &v->delta[k];
        const double drawn = (double)d->count / (double)v->samples;
        const bool through = d->wi.z * s->wo.z < 0;
        if (through && upside_down(s, d->wi))
            suggest_rank(g, 0.95,
                         "refraction with eta upside down, or with that of the "
                         "other side");
        const double chance =
            6 * sqrt(d->pdf * fmax(1 - d->pdf, 0) / (double)v->samples);
        if (d->pdf > 0 && fabs(drawn - d->pdf) > chance + 1e-9)
            suggest_rank(
                g, 0.9,
                "the %s direction is drawn %.4g of the time and says %.4g, "
                "%.4g times that",
                through ? "refracted" : "reflected", drawn, d->pdf,
                d->pdf / drawn);
    }
}

/* What a delta on one side adds to the mean weight of wo's samples; 0 where
 * none is drawn. */
static double delta_share(const struct bsdf *b, struct vec3 wo, bool through)
{
    enum { DRAWS = 256 };
    for (int i = 0; i < DRAWS; i++) {
        const struct vec3 u = { 0.5, 0.5, (i + 0.5) / DRAWS };
        const struct bsdf_sample a = bsdf_sample(b, wo, u);
        if (a.delta && (a.wi.z * wo.z < 0) == through)
            return a.pdf * a.weight.band[0];
    }
    return 0;
}

/* Straight through and back, where Fresnel's equations say the same both ways,
 * a weight is over eta^2 there and over 1 / eta^2 back. */
void diagnose_transmission(struct guess *g, const struct subject *s)
{
    static const char *const texts[] = {
        "is off by the factor eta^2 one way",
        "lacks the factor eta^2 either way",
        "is off by the factor eta^2 one way, by eta^4 the other",
        "has the factor eta^2 upside down: times it for over it, either way",
    };
    const double eta2 = s->claims.eta * s->claims.eta;
    if (eta2 == 1 || !(s->claims.lobes & BSDF_DELTA_TRANSMISSION))
        return;
    const double there = delta_share(s->bsdf, (struct vec3){ 0, 0, 1 }, true);
    const double back = delta_share(s->bsdf, (struct vec3){ 0, 0, -1 }, true);
    const double power = log(there / back * eta2 * eta2) / log(eta2);
    for (int i = 0; i < 4; i++)
        if (fabs(power - (i + 1)) < 1e-3)
            suggest_rank(g, 0.99, "the weight of transmission %s", texts[i]);
}

/* Schlick's reflectance is one of the angle in the thinner medium; by that in
 * the denser one, it is another there and back. */
void diagnose_schlick(struct guess *g, const struct subject *s)
{
    const unsigned both = BSDF_DELTA_REFLECTION | BSDF_DELTA_TRANSMISSION;
    const double eta = s->claims.eta, n = fmax(eta, 1 / eta);
    if (n == 1 || (s->claims.lobes & both) != both)
        return;
    const double cos_thin = 0.6, sine = 0.8 / n,
                 cos_dense = sqrt(1 - sine * sine);
    const double r0 = (n - 1) / (n + 1) * ((n - 1) / (n + 1));
    const double right = fresnel_schlick(cos_thin, r0);
    const double wrong = fresnel_schlick(cos_dense, r0);
    const struct vec3 wo = { sine, 0, eta > 1 ? -cos_dense : cos_dense };
    const double seen = delta_share(s->bsdf, wo, false);
    if (near(seen, wrong) && !near(seen, right))
        suggest_rank(g, 0.98,
                     "Fresnel at the wrong angle: Schlick's reflectance by the "
                     "cosine in the denser medium");
}
