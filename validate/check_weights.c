/* check_weights.c - the energy, three ways
 *
 * The albedo by quadrature of f |cos| is also the mean weight of samples, and
 * the mean of f |cos| over directions that are uniform, times their solid
 * angle.  Each is held against the quadrature, band by band, in Welch's way but
 * by a bound that holds for numbers which are rarely large; weights are cut off
 * at 5/4 of the largest of a pilot for that, and what the cut takes is known.
 * Uniform directions mean nothing while fewer than 1000 of them, effectively,
 * hit the lobe.
 *
 * A. Jung, J. Hanika and C. Dachsbacher, Detecting Bias in Monte Carlo
 * Renderers using Welch's t-test, JCGT 9(2), 2020.
 */
#include "validate/checks.h"

#include <stdio.h>

#include "validate/energy.h"
#include "validate/pvalue.h"

static const double hits_least = 1000;

/* An error of what is compared with is read in favour of the model.  p is
 * uniform where that is at most this part of a standard error, which moves p by
 * 2 * 0.4 times as much, and 0.4 is the largest density of a normal number; and
 * where weights differ by more than the rounding of one and the same, which
 * leaves 2^-52 of the sum of their squares, whose root is 1.5e-8. */
static const double nothing_beside = 0.005, rounding = 1e-7;

static void part(struct verdict *v, const char *name, struct mean m,
                 struct estimate truth, const char *before)
{
    const double spread = sqrt(m.variance / (double)m.n);
    const bool known = truth.error <= nothing_beside * spread &&
                       sqrt(m.variance) > rounding * fabs(truth.value);
    verdict_part(v, (struct verdict_part){
                        .name = name,
                        .p = pvalue_mean(m, truth),
                        .uniform = known ? pvalue_mean_normal(m, truth) : NAN,
                        .kind = spread > 0 ? PART_NORMAL : PART_OTHER,
                        .scale = truth.value / spread,
                        .error = truth.error / truth.value,
                        .before = before,
                        .after = "%",
                    });
}

static void run(const struct subject *s, struct verdict *v)
{
    const struct energy *e = subject_energy(s);
    const int bands = bsdf_bands(s->bsdf)->count;
    double hits = 0;
    v->unit = "sigma";
    if (!e) {
        v->p = pvalue_impossible;
        verdict_note(v, "out of memory");
        return;
    }
    verdict_note(v, "mean weight");
    for (int b = 0; b < bands; b++) {
        struct estimate capped = e->albedo[b];
        /* Somewhere between all that the cut can take and nothing. */
        const double taken = e->capped.value + e->capped.error;
        capped.value -= taken / 2;
        capped.error += taken / 2;
        part(v, "weights", e->weight[b], capped,
             b == 0 ? "weights wrong on average by" : NULL);
        verdict_add(v, "%s%.6g", b ? "/" : " ", e->weight[b].value);
        hits = fmax(hits, e->hits[b]);
    }
    for (int b = 0; b < bands; b++)
        if (e->hits[b] >= hits_least)
            part(v, "uniform", e->uniform[b], e->beside[b], NULL);
    verdict_combine(v);
    if (hits < hits_least)
        verdict_add(v,
                    ", albedo %.6g; uniform directions do not apply (%.0f "
                    "would hit)",
                    e->albedo[0].value, hits);
    else {
        verdict_add(v, ", uniform");
        for (int b = 0; b < bands; b++)
            verdict_add(v, "%s%.4g", b ? "/" : " ",
                        e->uniform[b].value + e->albedo[b].value -
                            e->beside[b].value);
    }
}

const struct check check_weights = {
    .name = "weights",
    .about =
        "mean weight, uniform directions and quadrature agree on the albedo",
    .run = run,
};
