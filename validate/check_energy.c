/* check_energy.c - no more light out than in
 *
 * The albedo, the integral of f |cos| over wi, by quadrature: at most 1 in
 * every band.  An error above 1e-6 leaves it undecided, which fails.  A model
 * that claims to be lossless must reach 1 within 1e-3 as well.  Light where the
 * pdf is 0 is lost to whoever samples, and fails above 1e-6.
 */
#include "validate/checks.h"

#include <stdio.h>

#include "validate/energy.h"

static const double error_limit = 1e-6, loss_limit = 1e-3;

static void run(const struct subject *s, struct verdict *v)
{
    const struct energy *e = subject_energy(s);
    const struct bsdf_claims claims = s->claims;
    /* A one-sided model takes all that comes from below. */
    const bool lossless =
        claims.lossless && (s->wo.z > 0 || (claims.two_sided && s->wo.z < 0));
    const double known =
        fmax(error_limit, 4 * s->survey.rounding + 64 * claims.epsilon);
    const int bands = bsdf_bands(s->bsdf)->count;
    double least = INFINITY;
    v->limit = 1;
    if (!e) {
        v->value = NAN;
        verdict_note(v, "out of memory");
        return;
    }
    verdict_note(v, "albedo");
    v->value = 0;
    for (int b = 0; b < bands; b++) {
        const struct estimate albedo = e->albedo[b];
        /* A NaN stays: nothing is above it. */
        if (isnan(albedo.value) || albedo.value > v->value)
            v->value = albedo.value;
        if (!(albedo.error <= v->error))
            v->error = albedo.error;
        least = fmin(least, albedo.value);
        verdict_add(v, "%s%.6g", b ? "/" : " ", albedo.value);
    }
    v->passed = v->error <= known;
    if (!(e->unsampled.value - e->unsampled.error <= error_limit)) {
        v->passed = false;
        verdict_add(v, ", %.6g of it where the pdf is 0", e->unsampled.value);
    } else if (!v->passed) {
        verdict_add(v, ", undecided: error above %g", known);
    } else if (lossless && v->value - v->error <= 1 &&
               !(least + v->error >= 1 - loss_limit)) {
        v->passed = false;
        verdict_add(v, ", but lossless is claimed");
    }
    verdict_found(v, "light that comes from nowhere, %.1g %% of it",
                  100 * v->error);
}

const struct check check_energy = {
    .name = "energy",
    .about = "the albedo is at most 1, or is 1 where lossless is claimed",
    .run = run,
};
