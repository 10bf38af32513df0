/* figure.h - a picture, together with the table and the script that made it
 *
 * FILE.svg lies beside FILE.tsv, its numbers, and FILE.gp: `gnuplot FILE.gp` in
 * that folder draws the picture again, to the last byte but for the date of a
 * PDF.  None of the three is ever there in part.
 *
 * A page is measured in pixels of an SVG, from its lower left corner; a PNG has
 * four for each.  The title stands on top of the page, above the body, which is
 * what a plot lays out.
 */
#ifndef PLOTS_FIGURE_H
#define PLOTS_FIGURE_H

#include "bsdf/bsdf.h"
#include "bsdf/outfile.h"
#include "plots/gnuplot.h"

struct figure {
    FILE *table, *script; /* write here */
    double width, height; /* of the page */

    const char *cells; /* gnuplot's style for a grid of crisp cells */

    struct outfile tables, scripts, picture;
    char *folder, *stem; /* names in the folder begin with ./ */
    const struct figure_form *form;
};

/** What there is after a run: full paths, and what gnuplot said. */
struct figure_made {
    char *path[3]; /* owned */
    int paths;
    char said[GNUPLOT_SAID_MAX];
};

void figure_made_clear(struct figure_made *made);

/** Opens all three for a picture to be at path, which ends in .svg, .pdf or
 * .png.  Either figure_draw or figure_abandon must follow. */
bool figure_open(struct figure *fig, const char *path, struct err *err);

/** Begins the script: terminal, title (the spec, as many lines as it takes, and
 * a line below it) and multiplot.  Variables: picture, table. */
void figure_page(struct figure *fig, double width, double body,
                 const char *spec, const char *below);

/** Writes a label; aligned is left, center or right. */
void figure_label(struct figure *fig, double x, double y, const char *aligned,
                  const char *text);

/** Small print, from the left; y is the middle of the line. */
void figure_small(struct figure *fig, double x, double y, const char *text);

/** The borders of the next plot of the page. */
void figure_panel(struct figure *fig, double x0, double x1, double y0,
                  double y1);

/** Closes the table and the script, runs the script.  When gnuplot fails the
 * two are made all the same. */
bool figure_draw(struct figure *fig, struct figure_made *made, struct err *err);

/** Leaves nothing. */
void figure_abandon(struct figure *fig);

#endif
