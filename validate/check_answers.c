/* check_answers.c - a model that is computed elsewhere answered every question
 *
 * Last of all, so that it hears of what went wrong in the others: a program
 * that crashed, hung or wrote garbage.  value is 1 then.
 */
#include "validate/checks.h"

static void run(const struct subject *s, struct verdict *v)
{
    struct err what;
    v->limit = 0;
    if (!bsdf_has_trouble(s->bsdf)) {
        v->applies = false;
        verdict_note(v, "computed in this program");
        return;
    }
    if (!bsdf_trouble(s->bsdf, &what)) {
        verdict_note(v, "all answered");
        return;
    }
    v->value = 1;
    verdict_note(v, "%s", what.text);
}

const struct check check_answers = {
    .name = "answers",
    .about = "a model that is another program answered every question",
    .run = run,
};
