/* kinds.h - what there is to draw
 *
 * A kind of plot is one file with one constant, and one line in kinds.c.
 */
#ifndef PLOTS_KINDS_H
#define PLOTS_KINDS_H

#include <stdint.h>

#include "plots/figure.h"

struct plot_request {
    const char *spec;
    struct bands bands;
    struct vec3 wo;
    uint64_t seed, samples;
    const char *output; /* ends in .svg, .pdf or .png */
};

struct plot {
    const char *name, *about;
    bool (*run)(const struct plot_request *r, struct figure_made *made,
                struct err *err);
};

extern const struct plot plot_lobe, plot_histogram;

/** All of them; the last is NULL. */
extern const struct plot *const plots[];

#endif
