/* cells.h - what is sampled and what should be, on a grid over a lobe
 *
 * Pilot directions choose the window of a chart of one side of the surface:
 *
 *   angles   theta, and phi', the azimuth from the mirror direction of wo
 *   pole     x = theta cos phi', y = theta sin phi': where the lobe is about
 *            the pole, at which the angles would tear it apart
 *   disk     x = sin theta cos phi', y = sin theta sin phi'
 *   half     the same of the half vector, that of refraction where most light
 *            goes through
 *
 * Below the surface theta is taken from the normal's opposite.  What is
 * expected of a cell is an integral over it, from quadrature on a mesh that
 * pilots grade, so that a lobe much narrower than a cell is seen.  The samples
 * are the ones that bsdf-validate tests with the same seed.
 */
#ifndef PLOTS_CELLS_H
#define PLOTS_CELLS_H

#include "validate/subject.h"

/** Where less is expected there is no residual. */
extern const double cells_expected_min;

enum cells_plane { CELLS_ANGLES, CELLS_POLE, CELLS_DISK, CELLS_HALF };

struct cell_point {
    double x, y;
    size_t cell;
};

struct cell {
    uint64_t count;
    struct estimate mass;  /* of the pdf */
    struct estimate solid; /* [sr] that is on this side of the surface */
};

struct cells {
    const struct bsdf *bsdf;
    struct subject subject; /* for its random numbers; no survey */
    struct vec3 wo, ahead;  /* ahead.z = 0, the azimuth where phi' is 0 */
    double side;            /* 1 above the surface, -1 below */
    enum cells_plane plane;
    double through;        /* the index beyond over wo's, 0 in reflection */
    double x0, y0, dx, dy; /* the window [rad or 1] and its cells */
    size_t n;              /* cells a side */
    struct cell *cell;     /* cell[iy * n + ix] */

    uint64_t samples, refused, deltas, inside;
    uint64_t beyond; /* on the other side of the surface */
};

/** Draws, integrates and counts; CELLS_ANGLES becomes CELLS_POLE where that
 * serves better.  The plan is borrowed for as long.  False where there is
 * nothing to draw, or no memory. */
bool cells_make(struct cells *h, const struct bsdf *b, struct vec3 wo,
                enum cells_plane plane, const struct plan *plan,
                struct err *err);
void cells_clear(struct cells *h);

/** Where a direction is in the chart, and the middle of a cell. */
struct cell_point cells_point(const struct cells *h, struct vec3 w);
struct cell_point cells_middle(const struct cells *h, size_t cell);

/** So many samples are expected, and (O - E) / sqrt(E), NaN where that is too
 * few. */
double cells_expected(const struct cells *h, const struct cell *c);
double cells_residual(const struct cells *h, const struct cell *c);

/** Whether less than a tenth of a cell is on this side of the surface, so that
 * its density is not drawn. */
bool cells_sliver(const struct cells *h, size_t cell);

/** What colours go up to [1/sr]: little noise, if that can be had. */
double cells_density_max(const struct cells *h);

#endif
