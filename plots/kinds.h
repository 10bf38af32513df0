/* kinds.h - what there is to draw
 *
 * A kind of plot is one file with one constant, and one line in kinds.c.
 */
#ifndef PLOTS_KINDS_H
#define PLOTS_KINDS_H

#include <stdint.h>

#include "plots/figure.h"

struct plot_request {
    const struct bsdf *bsdf; /* borrowed; NULL for a plot of pages */
    const char *pages;       /* names, separated by commas; or NULL */
    const char *file;        /* a report, or NULL */
    bool programs;           /* it may start those that its specs name */
    struct bands bands;
    struct vec3 wo;
    uint64_t seed, samples;
    double lo_nm, hi_nm; /* both 0 where the plot is to choose */
    const char *output;  /* ends in .svg, .pdf or .png; in .html for a report */
};

enum plot_subject {
    PLOT_MODEL,
    PLOT_PAGES, /* of optical constants */
    PLOT_RUN    /* a file */
};

struct plot {
    const char *name, *about;
    enum plot_subject subject;
    const char *extension; /* of what it makes, if no name is given; .svg */

    /* True with a warning in err where there is one, which else is left. */
    bool (*run)(const struct plot_request *r, struct figure_made *made,
                struct err *err);
};

extern const struct plot plot_lobe, plot_lobe3d, plot_histogram, plot_ior,
    plot_report;

/** All of them; the last is NULL. */
extern const struct plot *const plots[];

#endif
