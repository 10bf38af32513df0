/* mathml.h - formulas of LaTeX for pages of HTML
 *
 * What the formulas of a text need, and no more: letters, numbers, operators,
 * Greek letters, names of functions, {}, _ and ^, \frac, \sqrt, \bar, \mathrm,
 * \left and \right, and spaces.
 */
#ifndef PLOTS_MATHML_H
#define PLOTS_MATHML_H

#include <stdbool.h>
#include <stdio.h>

#include "bsdf/err.h"

/** Writes a <math> element, in a line of its own if display is set.  False for
 * what is not known, which is named; then part of it may be written. */
bool mathml(FILE *out, const char *latex, bool display, struct err *err);

#endif
