/* figure.h - a picture, together with the table and the script that made it
 *
 * FILE.svg lies beside FILE.tsv, its numbers, FILE.gp: `gnuplot FILE.gp` in
 * that folder draws the picture again, to the last byte but for the date of a
 * PDF; and FILE.caption, a few sentences that say what it shows and how it was
 * made.  FILE.tex has all that is no text in FILE.pdf, and its caption is
 * LaTeX.  None of them is ever there in part.
 *
 * A page is measured in pixels of an SVG that is FIGURE_PAGE wide, from its
 * lower left corner.  The title stands on top of the page, above the body,
 * which is what a plot lays out.
 *
 * Lines are drawn in gnuplot's linetypes, which a style file may redefine:
 * 1 to 8 for curves, 9 for the only one, 10 for a reference, 11 for grids.
 */
#ifndef PLOTS_FIGURE_H
#define PLOTS_FIGURE_H

#include "bsdf/bsdf.h"
#include "bsdf/outfile.h"
#include "plots/form.h"
#include "plots/gnuplot.h"

enum { FIGURE_PAGE = 800 };
enum { LINE_CURVES = 8, LINE_ONLY = 9, LINE_REFERENCE = 10, LINE_GRID = 11 };

/** How a figure is to look. */
struct figure_look {
    double width_mm;   /* of the page; 0 for FIGURE_PAGE pixels, 211.67 mm */
    const char *style; /* a file of gnuplot's commands; or NULL */
    bool window;       /* show it as well */
};

struct figure {
    FILE *table, *script, *caption; /* write here */
    double width, height;           /* of the page */
    const struct form *form;

    const char *path; /* of the picture; borrowed */
    struct figure_look look;
    char *style; /* the commands of the style file */
    struct outfile picture, graphic, tables, scripts, captions;
    char *folder, *stem; /* names in the folder begin with ./ */
};

/** What there is after a run: paths as they were given, and what gnuplot said.
 */
struct figure_made {
    char *path[5]; /* owned */
    int paths;
    char said[GNUPLOT_SAID_MAX];
};

void figure_made_clear(struct figure_made *made);

/** Closes a file and remembers it by a name; nothing is left where either
 * fails, or there is no name for want of memory. */
bool figure_made_keep(struct figure_made *made, struct outfile *out,
                      const char *name, struct err *err);

/** Whether an output, a page alone or a picture with what lies beside it, would
 * leave a file that is read as it is; false and the reason if not. */
bool figure_spares(const char *output, bool page, const char *input,
                   struct err *err);

/** Opens all of them for a picture to be at path, which ends in .svg, .pdf,
 * .png or .tex, and which must outlive the figure.  Either figure_draw or
 * figure_abandon must follow. */
bool figure_open(struct figure *fig, const char *path,
                 const struct figure_look *look, struct err *err);

/** Begins the script: terminal, linetypes, palettes (@heat, and @sigma for
 * what is about 0), style, title (as many lines as it takes, and one below it)
 * and multiplot.  Variables: picture, table, degree. */
void figure_page(struct figure *fig, double width, double body,
                 const char *title, const char *below);

/** Writes a string of the script, quotes included, as the form has text. */
void figure_text(struct figure *fig, const char *text);

/** Writes "set label TEXT at WHERE\n", where being the rest of the command. */
__attribute__((format(printf, 3, 4))) void
figure_label_at(struct figure *fig, const char *text, const char *where, ...);

/** Writes a label of the page; aligned is left, center or right. */
void figure_label(struct figure *fig, double x, double y, const char *aligned,
                  const char *text);

/** Small print, from the left; y is the middle of the line. */
void figure_small(struct figure *fig, double x, double y, const char *text);

/** The borders of the next plot of the page. */
void figure_panel(struct figure *fig, double x0, double x1, double y0,
                  double y1);

/** Adds to the caption. */
__attribute__((format(printf, 2, 3))) void
figure_caption(struct figure *fig, const char *format, ...);

/** Adds a spec or a path, which TeX may go on with in the next line. */
void figure_caption_spec(struct figure *fig, const char *spec);

/** Closes all but the picture, runs the script.  When gnuplot fails the others
 * are made all the same. */
bool figure_draw(struct figure *fig, struct figure_made *made, struct err *err);

/** Leaves nothing. */
void figure_abandon(struct figure *fig);

#endif
