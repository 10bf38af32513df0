/* kinds.h - what there is to draw
 *
 * A kind of plot is one file with one constant, and one line in kinds.c.
 */
#ifndef PLOTS_KINDS_H
#define PLOTS_KINDS_H

#include <stdint.h>

#include "plots/figure.h"

enum { PLOT_MODELS_MAX = 4, PLOT_DIRECTIONS_MAX = 4 };

enum plot_zoom { ZOOM_NONE, ZOOM_HALF, ZOOM_DISK };

struct plot_request {
    const struct bsdf *bsdf[PLOT_MODELS_MAX]; /* borrowed */
    int bsdfs;
    const char *pages; /* names, separated by commas; or NULL */
    const char *file;  /* a report or a table, or NULL */
    bool programs;     /* it may start those that its specs name */
    struct bands bands;
    struct vec3 wo[PLOT_DIRECTIONS_MAX];
    int wos;
    double phi_deg; /* NaN where the plot is to choose */
    bool log;
    enum plot_zoom zoom;
    uint64_t seed, samples;
    double lo_nm, hi_nm; /* both 0 where the plot is to choose */
    const char *output;  /* ends as figure.h has it; in .html for a report */
    struct figure_look look;
};

enum plot_subject {
    PLOT_MODEL,
    PLOT_PAGES, /* of optical constants */
    PLOT_FILE
};

/** What a kind heeds beside what all do. */
enum plot_heeds {
    HEEDS_WO = 1,
    HEEDS_PHI = 2,
    HEEDS_LOG = 4,
    HEEDS_ZOOM = 8,
    HEEDS_SAMPLES = 16, /* and the seed */
};

struct plot {
    const char *name, *about;
    enum plot_subject subject;
    unsigned heeds;
    int models, models_least; /* how many SPECs it takes; 0 is 1 */
    int directions;           /* and wo at most; 0 is 1 */
    bool any_wo;              /* wo need not be given */
    const char *file;         /* of what, for PLOT_FILE */
    const char *extension;    /* of what it makes, if no name is given; .svg */

    /* True with a warning in err where there is one, which else is left. */
    bool (*run)(const struct plot_request *r, struct figure_made *made,
                struct err *err);
};

extern const struct plot plot_lobe, plot_lobe3d, plot_histogram, plot_slice,
    plot_albedo, plot_fresnel, plot_ior, plot_ndf, plot_colour,
    plot_convergence, plot_kill_matrix, plot_p_values, plot_compare,
    plot_series, plot_report, plot_writeup;

/** All of them; the last is NULL. */
extern const struct plot *const plots[];

/** Writes a caption: what the figure shows; of what, the model(s) or else
 * `subject`; directions, bands, seed and samples as far as the kind heeds
 * them; and the program's version. */
void plot_caption(struct figure *fig, const struct plot *plot,
                  const struct plot_request *r, const char *subject,
                  const char *shows);

#endif
