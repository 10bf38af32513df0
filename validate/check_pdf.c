/* check_pdf.c - the pdf integrates to 1 less what is refused
 *
 * The integral, with its error, and the probabilities of the delta directions
 * leave a probability of refusal; the number of refused samples must be
 * binomial with it.  An integral above 1 is impossible whatever was drawn.
 */
#include "validate/checks.h"

#include <stdio.h>

#include "validate/pvalue.h"

static void run(const struct subject *s, struct verdict *v)
{
    const struct survey *survey = &s->survey;
    const struct estimate q = survey_refusal(survey);
    /* Rounding in a sum of positive parts, far below what samples resolve. */
    const struct estimate rounded = { q.value, q.error + 1e-12 };
    v->unit = "sigma";
    v->p = pvalue_binomial(survey->refused, survey->samples, rounded);
    if (isnan(q.value))
        v->p = pvalue_binomial(0, 1, (struct estimate){ -1, 0 });
    snprintf(v->note, sizeof v->note,
             "integral %.9f +- %.1e, refused share %.6f, sum %.6f", 1 - q.value,
             q.error, (double)survey->refused / (double)survey->samples,
             1 - q.value + (double)survey->refused / (double)survey->samples);
}

const struct check check_pdf = {
    .name = "pdf",
    .about = "the pdf integrates to 1 minus the share of refused samples",
    .run = run,
};
