/* chart.h - panels with two axes, for curves and for maps
 *
 * A plot says what there is in a panel; ticks, units, exponents, lines and
 * their dashes are settled here.  Lengths are pixels of the page.
 */
#ifndef PLOTS_CHART_H
#define PLOTS_CHART_H

#include "plots/figure.h"

struct chart_axis {
    double lo, hi, step; /* in units of 10^exponent */
    int exponent;
    bool log;       /* then step is in decades, and there is no exponent */
    char title[96]; /* with the unit */
};

/** An axis that holds [lo, hi], from a round number to another, with at most n
 * steps; "what [10^3 unit]".  With lo = hi some room is made. */
struct chart_axis chart_axis(double lo, double hi, int n, const char *what,
                             const char *unit);

/** The same from and to the very numbers, with steps of its choice where step
 * is 0. */
struct chart_axis chart_axis_exact(double lo, double hi, double step,
                                   const char *what, const char *unit);

/** Whole decades about [lo, hi], both above 0. */
struct chart_axis chart_axis_log(double lo, double hi, const char *what,
                                 const char *unit);

struct chart_curve {
    int block;         /* of the table */
    char x[48], y[96]; /* columns as gnuplot has them, "$1" and "abs($2)", in
                          units of the table */
    int line;          /* a linetype */
    enum { CHART_LINE, CHART_POINTS, CHART_BOTH, CHART_STEPS, CHART_FILL } as;
    int point;     /* its type, for points */
    char y2[96];   /* the other edge of what is filled */
    char text[96]; /* in the key */
};

/** A line across the panel, at x or at y, with a word beside it. */
struct chart_mark {
    bool across; /* at y, from left to right */
    double at;
    char text[64];
};

/** A grid of colours in place of curves: columns as above. */
struct chart_map {
    int block;
    char x[48], y[48], z[96];
    const char *palette; /* heat or sigma */
    double lo, hi;
    bool log;
};

struct chart {
    double x0, x1, y0, y1; /* the frame */
    const char *title;     /* above it, or NULL */
    struct chart_axis x, y;
    bool bare_x, bare_y; /* ticks without numbers and title */
    const struct chart_curve *curve;
    int curves;
    const struct chart_mark *mark;
    int marks;
    const struct chart_map *map; /* or NULL */
    const char *also;            /* to end the plot command with, or NULL */
};

/** Draws a panel.  Below the frame it takes CHART_BELOW, to the left
 * CHART_LEFT, above CHART_ABOVE if it has a title. */
enum { CHART_BELOW = 52, CHART_LEFT = 78, CHART_ABOVE = 26 };
void chart_draw(struct figure *fig, const struct chart *c);

/** The frame's sides for column i of n across the page; with a shared axis of y
 * only the first has room for its numbers. */
void chart_column(struct chart *c, int i, int n, bool shared);

/** Lines of notes, centred, from y downward, CHART_NOTE each. */
enum { CHART_NOTE = 17 };
void chart_notes(struct figure *fig, double y, const char *const *line, int n);

/** A colour bar for maps drawn next, below their titles of x; y is its lower
 * edge, and it takes CHART_BAR_BELOW downward. */
enum { CHART_BAR = 11, CHART_BAR_BELOW = 42 };
void chart_bar(struct figure *fig, double x0, double x1, double y,
               const struct chart_map *map, double step, const char *title);

/** How many rows the key of some curves takes, and the key; y is the middle of
 * the top one.  Curves without a text are left out. */
int chart_key_rows(const struct chart_curve *curve, int n);
void chart_key(struct figure *fig, const struct chart_curve *curve, int n,
               double y);

#endif
