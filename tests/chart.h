/* chart.h - integrals of a reflecting microfacet pdf, in another chart
 *
 * A reference for the masses of bins that shares nothing with
 * validate/quadrature.c: it neither looks at values to decide where to look
 * closer, nor at drawn directions.  It knows where the lobe is: the slope of
 * the half vector, over alpha_u along x and alpha_v along y, is distributed
 * about the origin with a width of 1 however narrow or stretched the lobe is.
 */
#ifndef TESTS_CHART_H
#define TESTS_CHART_H

#include "validate/sphere.h"

struct bsdf;

struct chart {
    const struct bsdf *bsdf; /* borrowed */
    struct vec3 wo;          /* above the surface */
    double alpha_u, alpha_v;
};

/** The integral over a patch above the horizon, by 12 x 12 Gauss nodes on each
 * piece of it that is small in the chart; the error is what 8 x 8 differ by. */
struct estimate chart_mass(const struct chart *c, struct patch p);

/** The integral over the hemisphere, in polar coordinates of the chart; NaN
 * when out of memory. */
double chart_total(const struct chart *c);

#endif
