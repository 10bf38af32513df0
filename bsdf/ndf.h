/* ndf.h - distributions of microfacet normals
 *
 * A family is stated for unit roughness, in slopes; stretching by alpha_u
 * along x and alpha_v along y makes the anisotropic distribution.  The slope
 * of a facet with normal m is (m.x, m.y) / m.z, up to sign.
 *
 *   D(m)      density of facets per area and solid angle [1/sr]
 *   Lambda(w) masking, G1(w) = 1 / (1 + Lambda(w)) (Smith)
 *
 * alpha_u, alpha_v in (0, inf); directions are unit vectors.
 *
 * E. Heitz, Understanding the Masking-Shadowing Function in Microfacet-Based
 * BRDFs, JCGT 3(2), 2014: sec. 5 (Lambda), eq. 72 ff. (stretching).
 */
#ifndef BSDF_NDF_H
#define BSDF_NDF_H

#include "bsdf/vec.h"

enum ndf_family { NDF_BECKMANN, NDF_GGX };

/** A family, for unit roughness. */
struct ndf {
    const char *name;
    enum ndf_family family;

    double (*p22)(double r2);   /* density of slopes [1], r2 = squared slope */
    double (*lambda)(double a); /* a = 1 / tan(theta), in [0, inf] */
    double (*r2_at)(double u);  /* squared slope below which a share u is */

    /* A slope (x, y) of the facets that w = (sin, 0, cos) sees, as the normal
     * (x, y, 1) times any positive number; u, v uniform in [0, 1). */
    struct vec3 (*visible)(struct vec3 w, double u, double v);
};

extern const struct ndf ndf_beckmann, ndf_ggx;

/** D(m); 0 for m.z <= 0. */
double ndf_d(const struct ndf *ndf, double alpha_u, double alpha_v,
             struct vec3 m);

/** Lambda(w) for either side; infinite at w.z = 0. */
double ndf_lambda(const struct ndf *ndf, double alpha_u, double alpha_v,
                  struct vec3 w);

/** G1(w) for a facet that faces w; 0 at w.z = 0. */
double ndf_g1(const struct ndf *ndf, double alpha_u, double alpha_v,
              struct vec3 w);

/** A normal with density D(m) m.z per solid angle. */
struct vec3 ndf_sample_all(const struct ndf *ndf, double alpha_u,
                           double alpha_v, double u, double v);

/** A normal with density G1(w) max(0, w.m) D(m) / w.z, for w.z > 0.
 * E. Heitz and E. d'Eon, Importance Sampling Microfacet-Based BSDFs using the
 * Distribution of Visible Normals, CGF 33(4), 2014, eq. 2. */
struct vec3 ndf_sample_visible(const struct ndf *ndf, double alpha_u,
                               double alpha_v, struct vec3 w, double u,
                               double v);

#endif
