/* trace.h - a BSDF along a cut through the normal, in polar angles
 *
 *   f and f |cos theta_i| against theta_i, the angle of wi to the normal:
 *   positive toward an azimuth, negative away from it.
 *
 * The angles are not a regular grid, where a lobe of 1e-3 rad would fall
 * between two of them.  They start from one, from angles ever closer to wo, the
 * mirror direction and the horizon, and from drawn directions; intervals are
 * then halved until a line between neighbours is as good as the curve.
 */
#ifndef PLOTS_TRACE_H
#define PLOTS_TRACE_H

#include <stdio.h>

#include "plots/pilots.h"

struct trace_point {
    double theta_deg;
    double f[2 * BANDS_MAX]; /* of the bands, then times |cos| */
    bool settled;            /* the line to the next point is good enough */
};

struct trace {
    const struct bsdf *bsdf;   /* borrowed */
    struct vec3 wo, plane;     /* unit vectors; plane.z = 0, toward positive
                                  theta */
    double phi_deg;            /* the azimuth of plane */
    bool incidence;            /* it is the plane of incidence, */
    double wo_deg, mirror_deg; /* where these are the signed theta_i of wo and
                                  of its mirror direction; else of their shadows
                                  on the plane */
    double limit_deg;          /* of theta_i: 90, or 180 with the back */
    int bands;

    struct trace_point *point;
    size_t points;
    double most[2 * BANDS_MAX]; /* largest values */
    size_t odd; /* angles where a value is not a finite number */
    bool same;  /* all bands are, everywhere */

    struct pilots pilots; /* and the single directions in the plane */
};

/** So many times smaller than the largest value is where logarithms end. */
enum { TRACE_DECADES = 6 };

/** Follows a model along the cut at phi_deg, that of the plane of incidence if
 * NaN; with log as good in logarithms too.  False when out of memory. */
bool trace_make(struct trace *t, const struct bsdf *b, struct vec3 wo,
                double phi_deg, bool log, uint64_t seed, struct err *err);
void trace_clear(struct trace *t);

/** The largest value of all bands, of f or of f |cos|. */
double trace_most(const struct trace *t, bool cosine);

/** Writes the comments and rows of a trace as a block, its heading unless it
 * goes on; the single directions as another. */
void trace_write(FILE *out, const struct trace *t);
void trace_write_deltas(FILE *out, const struct trace *t);

#endif
