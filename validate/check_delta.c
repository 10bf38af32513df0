/* check_delta.c - single directions: which, how often, with what weight
 *
 * A delta sample goes in the mirror direction or, where transmission is
 * claimed, along the refracted one of claims.eta; every sample of it says the
 * same pdf and weight, and it is drawn as often as its pdf says (binomial, two
 * sides).  value in sigma; what needs no statistics fails outright.
 */
#include "validate/checks.h"

#include <stdio.h>

#include "validate/pvalue.h"

/* The mirror direction, or the refracted one; false beyond the critical
 * angle.  Snell: sin_t = sin_o n_o / n_t. */
static bool expected(const struct subject *s, bool refracted, struct vec3 *wi)
{
    const struct vec3 wo = s->wo;
    const double eta = s->claims.eta;
    const double ratio = wo.z > 0 ? 1 / eta : eta;
    /* 1 - (ratio sin_o)^2, without its cancellation at grazing */
    const double cos2 = ratio * ratio * wo.z * wo.z + (1 - ratio) * (1 + ratio);
    *wi = (struct vec3){ -wo.x, -wo.y, wo.z };
    if (!refracted)
        return true;
    *wi = (struct vec3){ -wo.x * ratio, -wo.y * ratio,
                         copysign(sqrt(fmax(cos2, 0)), -wo.z) };
    return cos2 > 0;
}

static bool fault(struct verdict *v, const struct delta *d, const char *what,
                  double value)
{
    v->passed = false;
    v->value = value;
    v->limit = 0;
    v->p = NAN;
    if (d) {
        v->has_wi = true;
        v->wi = d->wi;
    }
    verdict_note(v, "%s (%g)", what, value);
    return false;
}

static bool delta_judge(const struct subject *s, const struct delta *d,
                        unsigned lobes, struct verdict *v)
{
    const bool refracted = d->wi.z * s->wo.z < 0;
    struct vec3 right;
    const bool exists = expected(s, refracted, &right);
    /* Directions are exact to a few roundings e; the cosine beyond is the root
     * of a difference, and so off by e / cos, or sqrt(e) where it is 0. */
    const double e = 16 * s->claims.epsilon;
    const double close =
        3 * e + (refracted ? fmin(e / fabs(right.z), sqrt(e)) : 0);
    const double off = vec3_length(vec3_minus(d->wi, right));
    if (!(lobes &
          (refracted ? BSDF_DELTA_TRANSMISSION : BSDF_DELTA_REFLECTION)))
        return fault(v, d, "a delta direction on a side without one", 1);
    if (!exists || !(off <= close))
        return fault(v, d, "the direction is off by", off);
    if (!(d->spread <= close))
        return fault(v, d, "samples of one direction differ by", d->spread);
    if (!(d->pdf > 0 && d->pdf <= 1))
        return fault(v, d, "the probability is outside (0, 1]", d->pdf);
    const uint64_t n = s->survey.samples;
    const bool rare = d->pdf < 1;
    const double spread = sqrt(d->pdf * (1 - d->pdf) / (double)n);
    const double u =
        rng_uniform(subject_rng(s, STREAM_RANDOMISE), 2 + (uint64_t)v->parts).x;
    verdict_part(
        v,
        (struct verdict_part){
            .name = refracted ? "refracted" : "reflected",
            .p = pvalue_binomial(d->count, n, (struct estimate){ d->pdf, 0 }),
            .uniform =
                rare ? pvalue_binomial_uniform(d->count, n, d->pdf, u) : NAN,
            .kind = rare ? PART_NORMAL : PART_OTHER,
            .scale = d->pdf / spread,
            .before = refracted ? "the probability of transmission wrong by"
                                : "the probability of reflection wrong by",
            .after = "%",
        });
    return true;
}

static void run(const struct subject *s, struct verdict *v)
{
    const struct survey *survey = &s->survey;
    const unsigned lobes = s->claims.lobes;
    if (!(lobes & BSDF_DELTA) && survey->deltas == 0) {
        v->applies = false;
        verdict_note(v, "no delta lobe");
        return;
    }
    v->unit = "sigma";
    if (survey->delta_others > 0) {
        fault(v, NULL, "more delta directions than a lobe each",
              (double)survey->delta_others);
        return;
    }
    if (s->wo.z < 0 && !s->claims.two_sided && survey->deltas == 0) {
        v->applies = false;
        verdict_note(v, "one-sided");
        return;
    }
    /* A mirror that is all there is always reflects. */
    if (lobes == BSDF_DELTA_REFLECTION && survey->deltas == 0 && s->wo.z != 0) {
        fault(v, NULL, "the claimed delta reflection was never drawn", 1);
        return;
    }
    for (int k = 0; k < survey->deltas; k++)
        if (!delta_judge(s, &survey->delta[k], lobes, v))
            return;
    verdict_combine(v); /* 1 beyond the critical angle */
    verdict_note(
        v, "%d direction%s, the first %llu times", survey->deltas,
        survey->deltas == 1 ? "" : "s",
        (unsigned long long)(survey->deltas ? survey->delta[0].count : 0));
}

const struct check check_delta = {
    .name = "delta",
    .about = "delta lobes: exact direction, one weight, the right frequency",
    .run = run,
};
