/* check_furnace.c - facets cover the surface, and what is seen of them too
 *
 *   int D(m) cos_m dm = 1,   G1(wo) int D(m) max(0, wo.m) dm = cos_o
 *
 * the second being the weak white furnace.  value is the larger deviation,
 * the second relative to cos_o.
 *
 * E. Heitz, Understanding the Masking-Shadowing Function in Microfacet-Based
 * BRDFs, JCGT 3(2), 2014, eq. 5, 14 and sec. 5.2.
 */
#include "validate/checks.h"

#include <stdio.h>

static double projected(struct vec3 m, const void *context)
{
    const struct subject *s = context;
    return m.z * bsdf_facet_d(s->bsdf, m);
}

static double visible(struct vec3 m, const void *context)
{
    const struct subject *s = context;
    return vec3_dot(m, s->wo) * bsdf_facet_d(s->bsdf, m);
}

static void run(const struct subject *s, struct verdict *v)
{
    if (!bsdf_has_facets(s->bsdf) || !(s->wo.z > 0)) {
        v->applies = false;
        verdict_note(v, "%s",
                     bsdf_has_facets(s->bsdf) ? "not seen from above"
                                              : "the model shows no facets");
        return;
    }
    const double scale = bsdf_facet_g1(s->bsdf, s->wo) / s->wo.z;
    const struct estimate area = hemisphere(projected, s);
    const struct estimate seen =
        hemisphere_facing(visible, s, s->wo, 1e-11 * fmin(1, 1 / scale));
    const double off_area = fabs(area.value - 1);
    const double off_seen = fabs(seen.value * scale - 1);
    v->limit = 1e-6;
    const bool worse = off_area > off_seen || isnan(off_area);
    v->value = worse ? off_area : off_seen;
    v->error = worse ? area.error : seen.error * scale;
    v->passed = v->error <= v->limit;
    verdict_found(v, "a D or G1 wrong by %.1g %%", 100 * v->limit);
    verdict_note(v, "int D cos = %.9f, G1 int D max(0, wo.m) / cos_o = %.9f%s",
                 area.value, seen.value * scale,
                 v->passed ? "" : ", undecided: error above 1e-6");
}

const struct check check_furnace = {
    .name = "furnace",
    .about = "D and G1 pass the weak white furnace test",
    .run = run,
};
