/* roughness.h - the settings that microfacet models share */
#ifndef BSDF_ROUGHNESS_H
#define BSDF_ROUGHNESS_H

#include "bsdf/bsdf.h"
#include "bsdf/ndf.h"

enum roughness_masking { MASKING_CORRELATED, MASKING_SEPARABLE };

extern const char *const roughness_distributions[], *const roughness_maskings[];

/** The family that a choice of distribution stands for. */
extern const struct ndf *const roughness_ndf[];

/** Below this a facet's normal has too few digits of its slope left. */
#define ROUGHNESS_MIN 1e-4

/** The rows of a parameter table, for a state with fields of these names. */
#define ROUGHNESS_PARAMS(state)                                                  \
    { "alpha",                                                                   \
      BSDF_NUMBER,                                                               \
      offsetof(state, alpha),                                                    \
      NULL,                                                                      \
      ROUGHNESS_MIN,                                                             \
      1,                                                                         \
      NULL,                                                                      \
      "roughness, the same along x and y; 0.1 if not given" },                   \
        { "alpha_u",                                                             \
          BSDF_NUMBER,                                                           \
          offsetof(state, alpha_u),                                              \
          NULL,                                                                  \
          ROUGHNESS_MIN,                                                         \
          1,                                                                     \
          NULL,                                                                  \
          "roughness along x, with alpha_v in place of alpha" },                 \
        { "alpha_v", BSDF_NUMBER, offsetof(state, alpha_v), NULL, ROUGHNESS_MIN, \
          1,         NULL,        "roughness along y" },                         \
        { "distribution",                                                        \
          BSDF_CHOICE,                                                           \
          offsetof(state, distribution),                                         \
          "beckmann",                                                            \
          0,                                                                     \
          0,                                                                     \
          roughness_distributions,                                               \
          "of the microfacet normals" },                                         \
        { "sample_visible",                                                      \
          BSDF_FLAG,                                                             \
          offsetof(state, sample_visible),                                       \
          "true",                                                                \
          0,                                                                     \
          0,                                                                     \
          NULL,                                                                  \
          "sample the normals that wo sees, or all of them" },                   \
    {                                                                            \
        "masking", BSDF_CHOICE, offsetof(state, masking), "correlated", 0, 0,    \
            roughness_maskings,                                                  \
            "Smith's shadowing and masking, height-correlated or separable"      \
    }

/** Settles alpha_u and alpha_v, NaN where they were not given.  False and the
 * reason: both ways given, or one of the two alone. */
bool roughness_settle(const char *model, double alpha, double *alpha_u,
                      double *alpha_v, struct err *err);

#endif
