/* ndf.c - single calls of what facets.h computes */
#include "bsdf/ndf.h"

#include "bsdf/facets.h"

double ndf_d(const struct ndf *ndf, double alpha_u, double alpha_v,
             struct vec3 m)
{
    return m.z > 0 ? facets_d(facets_of(ndf->family, alpha_u, alpha_v), m,
                              vec3_dot(m, m))
                   : 0;
}

double ndf_lambda(const struct ndf *ndf, double alpha_u, double alpha_v,
                  struct vec3 w)
{
    return facets_lambda(facets_of(ndf->family, alpha_u, alpha_v), w);
}

double ndf_g1(const struct ndf *ndf, double alpha_u, double alpha_v,
              struct vec3 w)
{
    return 1 / (1 + ndf_lambda(ndf, alpha_u, alpha_v, w));
}

struct vec3 ndf_sample_all(const struct ndf *ndf, double alpha_u,
                           double alpha_v, double u, double v)
{
    return vec3_unit(
        facets_all(facets_of(ndf->family, alpha_u, alpha_v), u, v));
}

struct vec3 ndf_sample_visible(const struct ndf *ndf, double alpha_u,
                               double alpha_v, struct vec3 w, double u,
                               double v)
{
    return vec3_unit(
        facets_visible(facets_of(ndf->family, alpha_u, alpha_v), w, u, v));
}
