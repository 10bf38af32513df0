/* export.h - a metal as other programs take it
 *
 * mitsuba, pbrt   the measured spectrum, every 5 nm, for them to reduce:
 *                 Mitsuba 3's wavelength:value pairs, pbrt-v4's inline
 *                 spectra.
 * openpbr-f82     base_color, the reflectance at normal incidence, and
 *                 specular_color, that at a cosine of 1/7 over Schlick's
 *                 there: OpenPBR's F82-tint, of the spectrum under D65.
 * cpp             the three pairs of a method as constants.
 *
 * OpenPBR Surface specification 1.1, Academy Software Foundation, sec. on
 * metal; N. Hoffman, Fresnel Equations Considered Harmful, MAM 2019.
 */
#ifndef BSDF_EXPORT_H
#define BSDF_EXPORT_H

#include <stdio.h>

#include "bsdf/colour.h"

enum export_format {
    EXPORT_MITSUBA,
    EXPORT_PBRT,
    EXPORT_OPENPBR_F82,
    EXPORT_CPP,
};

/** "mitsuba", "pbrt", "openpbr-f82", "cpp", NULL. */
extern const char *const export_names[];

/** What is to be written; all borrowed. */
struct export
{
    const char *name; /* of the page, Ca/Mathewson */
    const struct ior_page *page;
    const struct colour_metal *metal;
    const char *method; /* that eta and k come from */
    struct spectrum eta, k;
};

/** Writes it; false and the reason where the page does not reach. */
bool export_write(FILE *out, enum export_format format, const struct export *e,
                  struct err *err);

#endif
