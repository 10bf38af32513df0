/* kinds.c - the list of plots */
#include "plots/kinds.h"

const struct plot *const plots[] = { &plot_lobe, &plot_histogram, NULL };
