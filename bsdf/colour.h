/* colour.h - from measured optical constants to the colours of a picture
 *
 *   rgb     linear sRGB: primaries and white of IEC 61966-2-1 [1], 1 a channel
 *           for a perfect reflector under D65; bands 0, 1, 2 of a spectrum are
 *           R, G, B.  Never clamped unless it says so: saturated metals lie
 *           outside of [0, 1].
 *   xyz     CIE 1931 [2], Y = 1 for a perfect reflector under D65.
 *   lab     CIELAB [2], L from 0 to 100; under D65 as the tables have it.
 *   F0      reflectance at normal incidence, a colour like any other.
 *
 * A metal's colour at one angle is an integral over wavelength; three pairs
 * (eta, k), one for each of R, G and B, stand for it.  How to come by them:
 *
 *   fixed     eta and k at three wavelengths; cheap, common, and the colour is
 *             what it happens to be.
 *   average   eta and k weighted with the colour matching functions, as
 *             renderers with three channels do; off even for a metal without
 *             any colour, as the white of equal energy is not D65.
 *   fit       reflectances are integrated under D65 at angles from normal to
 *             grazing, and each channel gets the eta and k whose reflectance
 *             comes nearest, by least squares weighted with the cosine.
 *
 * The tables are loaded once by the caller (cie.h) and borrowed here.
 *
 * [1] IEC 61966-2-1:1999, Default RGB colour space - sRGB.
 * [2] CIE 015:2018, Colorimetry, 4th ed.
 * [3] G. Sharma, W. Wu and E. N. Dalal, The CIEDE2000 Color-Difference Formula:
 *     Implementation Notes, Supplementary Test Data, and Mathematical
 *     Observations, Color Research and Application 30(1), 21-30, 2005.
 */
#ifndef BSDF_COLOUR_H
#define BSDF_COLOUR_H

#include <stdbool.h>
#include <stddef.h>

#include "bsdf/bands.h"
#include "bsdf/cie.h"
#include "bsdf/err.h"
#include "bsdf/ior.h"

/* -- colour spaces --------------------------------------------------------- */

struct xyz {
    double x, y, z;
};

struct lab {
    double l, a, b;
};

/** Of a perfect reflector under D65, by the tables. */
struct xyz colour_white(const struct cie *cie);

/** By the matrix that takes the primaries' chromaticities (.64, .33), (.30,
 * .60), (.15, .06) to a white of (.3127, .3290) [1]; unclamped. */
struct spectrum colour_rgb(struct xyz xyz);
struct xyz colour_xyz(struct spectrum rgb); /* the inverse */

/** [2], sec. 8.2.1; any real xyz, relative to a white of positive ones. */
struct lab colour_lab(struct xyz xyz, struct xyz white);

/** CIEDE2000 with kL = kC = kH = 1 [3]; about 1 is just seen side by side. */
double colour_ciede2000(struct lab p, struct lab q);

/** The sRGB encoding [1] of a linear value, which is clamped to [0, 1]. */
double colour_srgb_encode(double linear);

/* -- a metal, wavelength by wavelength ------------------------------------- */

/** A page at the wavelengths of the tables, 8 kB; owned by the caller, who
 * keeps the tables for as long. */
struct colour_metal {
    const struct cie *cie;
    double n[CIE_ROWS], k[CIE_ROWS];

    /* The wavelengths that the page has [nm], of those of the tables; at others
     * the values at its ends are held. */
    double lo_nm, hi_nm;

    /* Share of X, Y or Z of the white that lies in there, of the one with the
     * least, in [0.5, 1].  An n and k that are held make it as uncertain as
     * the rest of that share. */
    double covered;
};

/** Linear in wavelength.  Fails for a page without k, next to negative values,
 * and where it covers less than half. */
bool colour_metal_init(struct colour_metal *metal, const struct cie *cie,
                       const struct ior_page *page, struct err *err);

/** The colour of its reflectance (fresnel_conductor) under D65, for light that
 * comes at a cosine in [0, 1]: sums of F D65 cmf over that of D65 ybar. */
struct xyz colour_metal_xyz(const struct colour_metal *metal, double cos_i);
struct spectrum colour_metal_rgb(const struct colour_metal *metal,
                                 double cos_i);

/* -- three pairs for it ---------------------------------------------------- */

enum colour_method { COLOUR_FIXED, COLOUR_AVERAGE, COLOUR_FIT };

/** "fixed", "average", "fit", NULL. */
extern const char *const colour_method_names[];

bool colour_method_parse(enum colour_method *method, const char *text,
                         struct err *err);

/** The F0s are linear sRGB.  Differences over angle are those of the pairs'
 * reflectance from the spectral one, unclamped, at cosines of 1, 31/32, ...
 * 1/32. */
struct colour_report {
    struct spectrum f0;          /* of the three pairs */
    struct spectrum f0_spectral; /* of the whole spectrum */
    double ciede2000;            /* between the two, unclamped */
    struct spectrum rms;         /* over angle, weighted with the cosine */
    struct spectrum worst;       /* and the largest */
    double covered;              /* as in struct colour_metal */
    char warnings[1024]; /* sentences, one a line; "" if there are none */
};

/** eta and k of R, G and B; both untouched on failure.
 *
 * bands are the three wavelengths of the method fixed, NULL meaning
 * bands_fixed, which the page has to reach; the other methods ignore them.
 * With no report the method fixed takes pages of any range; else a page has to
 * cover half of the white, and a report warns if that is less than 99.9 %.
 *
 * The method fit cannot meet an F0 that is not in (0, 1): it fits one that is
 * just inside and the report warns. */
bool colour_conductor(const struct cie *cie, const struct ior_page *page,
                      enum colour_method method, const struct bands *bands,
                      struct spectrum *eta, struct spectrum *k,
                      struct colour_report *report, struct err *err);

/* -- and back: where three pairs come from --------------------------------- */

/** Whole wavelengths [nm] within the tables' 360 to 830, for R, G, B. */
struct colour_match {
    char page[512]; /* its name, MATERIAL/PAGE */
    struct bands bands;
    struct spectrum eta, k; /* of the page there, linear in wavelength */
    double error;      /* the largest difference, in halves of a last digit */
    bool within;       /* error <= 1: all six numbers, rounded, are the same */
    int candidates[3]; /* so many whole wavelengths are within, in each band */
    int compared, skipped; /* pages; one without k in the visible is skipped */
};

/** Which page, at which wavelengths, three pairs were looked up at.
 *
 * eta_half and k_half [1] are half a unit of the last digit that eta and k were
 * given with: 5e-6 for .29294.
 *
 * names lists the count pages that come into question, as for ior_find with
 * this ior_path; NULL means those that come along.  The first of those
 * that match equally well is returned.  False if none could be compared. */
bool colour_match(const struct spectrum *eta, const struct spectrum *k,
                  double eta_half, double k_half, const char *const names[],
                  size_t count, const char *ior_path,
                  struct colour_match *match, struct err *err);

#endif
