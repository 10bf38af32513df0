/* furnace.c - both integrals by quadrature */
#include "validate/furnace.h"

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

struct furnace furnace(const struct subject *s)
{
    const double scale = bsdf_facet_g1(s->bsdf, s->wo) / s->wo.z;
    const struct estimate visibly =
        hemisphere_facing(visible, s, s->wo, 1e-11 * fmin(1, 1 / scale));
    return (struct furnace){ hemisphere(projected, s),
                             { visibly.value * scale, visibly.error * scale } };
}
