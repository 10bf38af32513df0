/* form.h - the forms that a picture comes in
 *
 * A page is laid out in pixels of 1/96 inch on a page 800 of them wide; another
 * width scales all of it, letters and lines included.  Text of a .tex is set by
 * LaTeX, in the document's fonts; what is no text of it lies beside it in a
 * .pdf of the same name.
 */
#ifndef PLOTS_FORM_H
#define PLOTS_FORM_H

#include <stdbool.h>
#include <stdio.h>

#include "bsdf/err.h"
#include "bsdf/outfile.h"

struct form {
    const char *extension;
    bool tex;
    const char *cells;  /* gnuplot's style for a grid of crisp cells */
    const char *number; /* its format of a number, for tics and sprintf */
    const char *degree;
};

/** The form that a path's extension stands for; NULL and the reason. */
const struct form *form_of(const char *path, struct err *err);

/** Writes what follows `set terminal`, for so many pixels; scale 1 is 800
 * pixels to 211.67 mm. */
void form_terminal(FILE *script, const struct form *form, double width,
                   double height, double scale);

/** The size that gnuplot is to be told for letters of so many pixels. */
double form_font(const struct form *form, double pixels, double scale);

/** What remains to be done to a picture that was drawn at a path: a PDF gets a
 * fixed date. */
bool form_finish(const struct form *form, const char *path, struct err *err);

/** For a .tex drawn as DRAWN.tex, DRAWN.pdf beside it: moves them to out and to
 * graphic, where the former includes the latter by `stem`, without extension.
 * Removes what was drawn in any case. */
bool form_tex_move(const char *drawn, const char *stem, struct outfile *out,
                   struct outfile *graphic, struct err *err);

#endif
