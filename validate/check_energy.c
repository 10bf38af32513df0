/* check_energy.c - no more light out than in
 *
 * The albedo, the integral of f |cos| over wi, by quadrature: at most 1 in
 * every band.  An error above 1e-6 leaves it undecided, which fails.  A model
 * that claims to be lossless must reach 1 within 1e-3 as well.  Light where the
 * pdf is 0 is lost to whoever samples, and fails above 1e-6.
 */
#include "validate/checks.h"

#include <stdio.h>

static const double error_limit = 1e-6, loss_limit = 1e-3;

static void run(const struct subject *s, struct verdict *v)
{
    struct estimate albedo[BANDS_MAX], unsampled;
    const struct bsdf_claims claims = bsdf_claims(s->bsdf);
    /* A one-sided model takes all that comes from below. */
    const bool lossless =
        claims.lossless && (s->wo.z > 0 || (claims.two_sided && s->wo.z < 0));
    subject_albedo(s, albedo, &unsampled);
    const int bands = bsdf_bands(s->bsdf)->count;
    double least = INFINITY;
    verdict_note(v, "albedo");
    v->value = 0;
    v->limit = 1;
    for (int b = 0; b < bands; b++) {
        /* A NaN stays: nothing is above it. */
        if (isnan(albedo[b].value) || albedo[b].value > v->value)
            v->value = albedo[b].value;
        if (!(albedo[b].error <= v->error))
            v->error = albedo[b].error;
        least = fmin(least, albedo[b].value);
        verdict_add(v, "%s%.6g", b ? "/" : " ", albedo[b].value);
    }
    v->passed = v->error <= error_limit;
    if (!(unsampled.value - unsampled.error <= error_limit)) {
        v->passed = false;
        verdict_add(v, ", %.6g of it where the pdf is 0", unsampled.value);
    } else if (!v->passed) {
        verdict_add(v, ", undecided: error above %g", error_limit);
    } else if (lossless && v->value - v->error <= 1 &&
               !(least + v->error >= 1 - loss_limit)) {
        v->passed = false;
        verdict_add(v, ", but lossless is claimed");
    }
}

const struct check check_energy = {
    .name = "energy",
    .about = "the albedo is at most 1, or is 1 where lossless is claimed",
    .run = run,
};
