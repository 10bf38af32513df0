/* check_furnace.c - facets cover the surface, and what is seen of them too
 *
 * The two integrals of furnace.h.  value is the larger deviation from 1, the
 * second relative to cos_o.
 */
#include "validate/checks.h"

#include <stdio.h>

#include "validate/furnace.h"

static void run(const struct subject *s, struct verdict *v)
{
    if (!bsdf_has_facets(s->bsdf) || !(s->wo.z > 0)) {
        v->applies = false;
        verdict_note(v, "%s",
                     bsdf_has_facets(s->bsdf) ? "not seen from above"
                                              : "the model shows no facets");
        return;
    }
    const struct furnace f = furnace(s);
    const double off_area = fabs(f.area.value - 1);
    const double off_seen = fabs(f.seen.value - 1);
    v->limit = 1e-6;
    const bool worse = off_area > off_seen || isnan(off_area);
    v->value = worse ? off_area : off_seen;
    v->error = worse ? f.area.error : f.seen.error;
    v->passed = v->error <= v->limit;
    verdict_found(v, "a D or G1 wrong by %.1g %%", 100 * v->limit);
    verdict_note(v, "int D cos = %.9f, G1 int D max(0, wo.m) / cos_o = %.9f%s",
                 f.area.value, f.seen.value,
                 v->passed ? "" : ", undecided: error above 1e-6");
}

const struct check check_furnace = {
    .name = "furnace",
    .about = "D and G1 pass the weak white furnace test",
    .run = run,
};
