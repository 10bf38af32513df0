/* check_pdf.c - the pdf integrates to 1 less what is refused
 *
 * The integral, with its error, and the probabilities of the delta directions
 * leave a probability of refusal; the number of refused samples must be
 * binomial with it.  An integral above 1 is impossible whatever was drawn, and
 * one that is not known to 1e-4, or as far as rounding goes, fails.
 */
#include "validate/checks.h"

#include <stdio.h>

#include "validate/pvalue.h"

/* A bound this large would excuse what a million samples show. */
static const double error_limit = 1e-4;

static void run(const struct subject *s, struct verdict *v)
{
    const struct survey *survey = &s->survey;
    const struct estimate q = survey_refusal(survey);
    /* Rounding in a sum of positive parts, far below what samples resolve. */
    const double rounding = fmax(1e-12, 4 * s->claims.epsilon);
    const struct estimate rounded = { q.value, q.error + rounding };
    const double n = (double)survey->samples;
    const double limit = fmax(error_limit, 4 * survey->rounding);
    v->unit = "sigma";
    v->error = q.error;
    if (!(q.error <= limit)) { /* a NaN value has a NaN error */
        v->p = pvalue_impossible;
        verdict_note(v, "integral %.6g +- %.1e: undecided, error above %g",
                     1 - q.value, q.error, limit);
        return;
    }
    const bool known = q.value > q.error && q.value < 1;
    const double spread = sqrt(q.value * (1 - q.value) / n);
    const double u = rng_uniform(subject_rng(s, STREAM_RANDOMISE), 1).x;
    verdict_part(
        v,
        (struct verdict_part){
            .name = "total",
            .p = pvalue_binomial(survey->refused, survey->samples, rounded),
            .uniform = known ? pvalue_binomial_uniform(
                                   survey->refused, survey->samples, q.value, u)
                             : NAN,
            /* Without refusals, one of k samples too few is seen when about
             * k were drawn. */
            .kind = known ? PART_NORMAL : PART_POISSON,
            .mean = q.error * n,
            .scale = known ? 1 / spread : n,
            .before = "the pdf wrong as a whole by",
            .after = "%",
        });
    verdict_combine(v);
    verdict_note(v, "integral %.9f +- %.1e, refused share %.6f, sum %.6f",
                 1 - q.value, q.error, (double)survey->refused / n,
                 1 - q.value + (double)survey->refused / n);
}

const struct check check_pdf = {
    .name = "pdf",
    .about = "the pdf integrates to 1 minus the share of refused samples",
    .run = run,
};
