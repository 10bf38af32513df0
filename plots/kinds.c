/* kinds.c - the list of plots */
#include "plots/kinds.h"

const struct plot *const plots[] = { &plot_lobe, &plot_lobe3d, &plot_histogram,
                                     &plot_ior,  &plot_report, NULL };
