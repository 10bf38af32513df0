/* medium.h - the relative index of an interface, as the models take it
 *
 * `int_ior` (below, z < 0) and `ext_ior` (above) are numbers, or name a
 * material: a page of optical constants (ior.h), or one of the names that
 * Mitsuba 3 knows, with its indices near 589 nm (E. Hecht, Optics, 4th ed.).
 */
#ifndef BSDF_MEDIUM_H
#define BSDF_MEDIUM_H

#include "bsdf/bsdf.h"

/** The rows of a parameter table, for a state with fields of these names. */
#define MEDIUM_PARAMS(state)                                                   \
    { "int_ior",                                                               \
      BSDF_STRING,                                                             \
      offsetof(state, int_ior),                                                \
      "bk7",                                                                   \
      0,                                                                       \
      0,                                                                       \
      NULL,                                                                    \
      "index below the surface: a number or a material" },                     \
    {                                                                          \
        "ext_ior", BSDF_STRING, offsetof(state, ext_ior), "air", 0, 0, NULL,   \
            "index above the surface: a number or a material"                  \
    }

/** The index below over that above.  A page gives its n at the wavelength of
 * an instance with one band, and at 589.3 nm, the sodium D lines, where there
 * are several, as light of all bands takes one path.  False and the reason: no
 * such material, or an index outside [0.1, 100]. */
bool medium_settle(const char *model, const char *int_ior, const char *ext_ior,
                   const struct bands *bands, double *eta, struct err *err);

/** The refraction of w at a facet with unit normal m on the side of w, w.m > 0;
 * n is the index beyond over that of w's side, cos_t from fresnel_dielectric
 * and above 0. */
static inline struct vec3 medium_refract(struct vec3 w, struct vec3 m, double n,
                                         double cos_t)
{
    const double along = vec3_dot(w, m) / n - cos_t;
    return vec3_unit(vec3_add(vec3_scale(-1 / n, w), vec3_scale(along, m)));
}

#endif
