/* ggx.c - the family's functions, to be pointed at */
#include "bsdf/ggx.h"
#include "bsdf/ndf.h"

static double p22(double r2)
{
    return ggx_p22(r2);
}

static double lambda(double a)
{
    return ggx_lambda(a);
}

static double r2_at(double u)
{
    return ggx_r2_at(u);
}

static struct vec3 visible(struct vec3 w, double u, double v)
{
    return ggx_visible(w, u, v);
}

const struct ndf ndf_ggx = {
    .name = "ggx",
    .family = NDF_GGX,
    .p22 = p22,
    .lambda = lambda,
    .r2_at = r2_at,
    .visible = visible,
};
