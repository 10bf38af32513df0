/* bands.h - the colours that an instance is made for, and values in them
 *
 * A band is a vacuum wavelength [nm], or one of R, G and B in linear sRGB.
 * For the latter the measured constants of a metal are brought to three pairs
 * by a method of colour.h.
 */
#ifndef BSDF_BANDS_H
#define BSDF_BANDS_H

#include <stdbool.h>

#include "bsdf/err.h"

enum { BANDS_MAX = 4 };

enum bands_kind {
    BANDS_NM,          /* wavelengths */
    BANDS_RGB_AVERAGE, /* R, G, B: colour-matching averages of eta and of k */
    BANDS_RGB_FIT,     /* R, G, B: eta and k fitted to the reflectance, D65 */
};

struct bands {
    int count;            /* 1 to BANDS_MAX; 3 for R, G, B */
    double nm[BANDS_MAX]; /* 0 for R, G, B */
    enum bands_kind kind;
};

/** One value a band; those past the count are 0. */
struct spectrum {
    double band[BANDS_MAX];
};

/** R, G, B by the fit. */
extern const struct bands bands_default;

/** The write-up's three wavelengths that stand for R, G and B, 614, 549 and
 * 466 nm. */
extern const struct bands bands_fixed;

/** Reads "614,549,466": one to four wavelengths in (0, 1e9] nm. */
bool bands_parse(struct bands *bands, const char *text, struct err *err);

/** Reads a way to R, G, B: "fit", "average", or "fixed:A,B,C" for three
 * wavelengths in nm. */
bool bands_parse_rgb(struct bands *bands, const char *text, struct err *err);

/** Writes "614, 549, 466 nm" or "R, G, B (fit)". */
void bands_print(const struct bands *bands, char *text, int size);

/** Writes "549 nm" or "G". */
void bands_print_one(const struct bands *bands, int band, char *text, int size);

static inline struct spectrum spectrum_of(int count, double value)
{
    struct spectrum s = { { 0 } };
    for (int b = 0; b < count; b++)
        s.band[b] = value;
    return s;
}

/** Whether every one of the bands has this value. */
static inline bool spectrum_is(struct spectrum s, int count, double value)
{
    for (int b = 0; b < count; b++)
        if (s.band[b] != value)
            return false;
    return true;
}

static inline struct spectrum spectrum_scale(double a, struct spectrum s)
{
    for (int b = 0; b < BANDS_MAX; b++)
        s.band[b] *= a;
    return s;
}

static inline struct spectrum spectrum_mul(struct spectrum a, struct spectrum c)
{
    for (int b = 0; b < BANDS_MAX; b++)
        a.band[b] *= c.band[b];
    return a;
}

#endif
