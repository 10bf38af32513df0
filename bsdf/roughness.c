/* roughness.c - settling the roughness of a microfacet model */
#include "bsdf/roughness.h"

const char *const roughness_distributions[] = { "beckmann", "ggx", NULL };
const char *const roughness_maskings[] = { "correlated", "separable", NULL };
const struct ndf *const roughness_ndf[] = { &ndf_beckmann, &ndf_ggx };

bool roughness_settle(const char *model, double alpha, double *alpha_u,
                      double *alpha_v, struct err *err)
{
    const bool has_u = !isnan(*alpha_u), has_v = !isnan(*alpha_v);
    if (has_u != has_v)
        return err_set(err, "%s: %s is given without %s; expected both", model,
                       has_u ? "alpha_u" : "alpha_v",
                       has_u ? "alpha_v" : "alpha_u");
    if (has_u && !isnan(alpha))
        return err_set(err,
                       "%s: expected either alpha or alpha_u and alpha_v, not "
                       "both",
                       model);
    if (!has_u)
        *alpha_u = *alpha_v = isnan(alpha) ? 0.1 : alpha;
    return true;
}
