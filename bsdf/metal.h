/* metal.h - the index of a metal, as the conducting models take it
 *
 * `material` names a page of optical constants (ior.h); `eta` and `k` give
 * them instead.  Neither, or "none", is a perfect mirror: eta = 0, k = 1.
 */
#ifndef BSDF_METAL_H
#define BSDF_METAL_H

#include "bsdf/bsdf.h"

/** The rows of a parameter table, for a state with fields of these names. */
#define METAL_PARAMS(state)                                                    \
    { "material",                                                              \
      BSDF_STRING,                                                             \
      offsetof(state, material),                                               \
      NULL,                                                                    \
      0,                                                                       \
      0,                                                                       \
      NULL,                                                                    \
      "optical constants: Ca, Ca/Mathewson or a file.yml; none" },             \
        { "eta",                                                               \
          BSDF_SPECTRUM,                                                       \
          offsetof(state, eta),                                                \
          NULL,                                                                \
          0,                                                                   \
          1000,                                                                \
          NULL,                                                                \
          "refractive index, in place of material" },                          \
    {                                                                          \
        "k", BSDF_SPECTRUM, offsetof(state, k), NULL, 0, 1000, NULL,           \
            "extinction coefficient, in place of material"                     \
    }

/** Settles eta and k, NaN where they were not given, for wavelengths or for R,
 * G, B.  True with a warning in err where a colour is not quite the metal's;
 * err is left alone where there is none.  False and the reason:
 * both ways given, only one of eta and k, no such page, a band out of its
 * range, or eta = k = 0. */
bool metal_settle(const char *model, const char *material, struct spectrum *eta,
                  struct spectrum *k, const struct bands *bands,
                  struct err *err);

#endif
