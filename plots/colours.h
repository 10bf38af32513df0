/* colours.h - which line a band has, and one number for all bands */
#ifndef PLOTS_COLOURS_H
#define PLOTS_COLOURS_H

#include <stddef.h>

#include "bsdf/bands.h"

/** The linetype of a band: by its wavelength, or by rank where two bands would
 * look the same. */
int colours_line(const struct bands *bands, int band);

/** Luminance of R, G, B, or the mean of wavelengths. */
double colours_mean(const struct bands *bands, struct spectrum f);

/** "luminance 0.2126 R + 0.7152 G + 0.0722 B", "mean of the bands", or "in the
 * band" where there is one. */
const char *colours_mean_name(const struct bands *bands);

/** The mean of columns of a table from `first` on, as gnuplot has it. */
void colours_mean_columns(const struct bands *bands, int first, char *text,
                          size_t size);

#endif
