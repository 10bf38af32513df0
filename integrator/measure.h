/* measure.h - what a picture, or a part of it, amounts to
 *
 * Means over pixels, and how sure they are, from the variances that the pixels
 * carry.  Samples of different pixels are independent, so their variances add.
 */
#ifndef INTEGRATOR_MEASURE_H
#define INTEGRATOR_MEASURE_H

#include <stdio.h>

#include "integrator/film.h"

struct measure {
    int x, y, width, height; /* what was measured [pixels] */
    double mean[3];          /* radiance in R, G and B */
    double luminance, error; /* its mean, and the standard error of that */
    double variance;         /* of a pixel's luminance, on average */
    double noise;            /* its root over the mean luminance [1] */
    double samples;          /* a pixel, on average */
    uint32_t least, most;    /* samples of a pixel */
    long without; /* pixels that have none, as of a picture that was stopped;
                     they count for nothing */
};

/** Measures the part of so many pixels at (x, y), cut off at the picture's
 * border; with width = 0 all of it.  What needs variances is NaN where a pixel
 * has none.  False where the part is not in the picture. */
bool measure_film(const struct film *f, int x, int y, int width, int height,
                  struct measure *m, struct err *err);

/** Lines of a name, a tab and a number. */
void measure_print(FILE *out, const struct measure *m);

#endif
