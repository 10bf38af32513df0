/* bands.h - the colours that an instance is made for, and values in them
 *
 * A band is a vacuum wavelength [nm].  For now the three bands of a picture
 * are three fixed wavelengths as well: 614, 549 and 466 nm for R, G and B.
 */
#ifndef BSDF_BANDS_H
#define BSDF_BANDS_H

#include <stdbool.h>

#include "bsdf/err.h"

enum { BANDS_MAX = 4 };

struct bands {
    int count; /* 1 to BANDS_MAX */
    double nm[BANDS_MAX];
};

/** One value a band; those past the count are 0. */
struct spectrum {
    double band[BANDS_MAX];
};

/** The three wavelengths that stand for R, G and B. */
extern const struct bands bands_default;

/** Reads "614,549,466": one to four wavelengths in (0, 1e9] nm. */
bool bands_parse(struct bands *bands, const char *text, struct err *err);

/** Writes "614, 549, 466 nm". */
void bands_print(const struct bands *bands, char *text, int size);

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
