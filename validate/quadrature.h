/* quadrature.h - integrals over many rectangles, with an error bound
 *
 * A rectangle is integrated by a 6 x 6 Gauss-Legendre rule, compared with the
 * sums over its halves along x and along y, and split along the worse of the
 * two until both agree with it; so a jump along an axis costs a bisection.  The
 * value is corrected by both differences, and they are taken for the error.
 * Then a 6 x 6 Lobatto rule must agree as well, within twice the tolerance:
 * its nodes are others and reach the edges, so that neither a jump just inside
 * an edge nor a ridge between nodes is missed for long.
 *
 * A rule sees only what its nodes see.  A mesh must be graded toward a peak,
 * never laid over it, and have its edges where the integrand has kinks; and
 * where the integrand is known to be large, as at a sampled direction, a hint
 * keeps the rule splitting until its nodes have seen that.  Where the nodes on
 * an edge have met what the rectangle beyond it has not, that one is integrated
 * again with a hint there: so a narrow ridge is followed from rectangle to
 * rectangle, wherever it was found first.
 *
 * All rectangles are refined side by side, so that the integrand is asked for
 * thousands of values at once.  The result does not depend on how they are
 * grouped.
 */
#ifndef VALIDATE_QUADRATURE_H
#define VALIDATE_QUADRATURE_H

#include <stdbool.h>
#include <stddef.h>

#include "validate/estimate.h"

enum { QUADRATURE_ORDER = 6, QUADRATURE_PARTS_MAX = 6 };
enum {
    QUADRATURE_NODES = QUADRATURE_ORDER * QUADRATURE_ORDER,
    QUADRATURE_RULES = 256 /* the most at once */
};

struct rectangle {
    double x0, x1, y0, y1;
};

/** Fills value[part * n * NODES + rule * NODES + i * ORDER + k] with the
 * part-th integrand at (x[rule][i], y[rule][k]), for n rules, at most RULES. */
typedef void quadrature_fn(const void *context, size_t n,
                           const double (*x)[QUADRATURE_ORDER],
                           const double (*y)[QUADRATURE_ORDER], double *value);

/** A point in a rectangle, and the largest |integrand| of any part there. */
struct quadrature_hint {
    double x, y, height;
};

/** A rectangle, the n hints in it, which may be none and are put in another
 * order, and where the integrals are added, an estimate a part. */
struct quadrature_job {
    struct rectangle r;
    struct quadrature_hint *hint;
    size_t n;
    struct estimate *out;
};

/** Integrates over the rectangle of each job; parts at most
 * QUADRATURE_PARTS_MAX.  A leaf is accepted where the rules differ by at
 * most the tolerance, or where the budget of evaluations, shared by many calls,
 * is used up; either way the difference is in the error.  A leaf with hints
 * must have met half of the greatest height among them too.  False when out of
 * memory. */
bool quadrature(quadrature_fn *f, const void *context, int parts,
                const struct quadrature_job *job, size_t jobs, double tolerance,
                long *budget);

/** Which job lies beyond an edge of a job at a point on that edge, which is put
 * into that one's coordinates; QUADRATURE_NONE where there is none. */
enum quadrature_side {
    QUADRATURE_X0,
    QUADRATURE_X1,
    QUADRATURE_Y0,
    QUADRATURE_Y1,
    QUADRATURE_SIDES
};
#define QUADRATURE_NONE ((size_t)-1)
typedef size_t quadrature_beside(const void *mesh, size_t job,
                                 enum quadrature_side side, double *x,
                                 double *y);

/** The same where the rectangles of the jobs are parts of a mesh, so that
 * ridges are followed from one to another; beside may be NULL. */
bool quadrature_joined(quadrature_fn *f, const void *context, int parts,
                       const struct quadrature_job *job, size_t jobs,
                       quadrature_beside *beside, const void *mesh,
                       double tolerance, long *budget);

/** Cuts the intervals between n sorted edges so that none is wider than widest
 * or more than twice as wide as the narrower one beside it was.  Writes at
 * most max edges, the given ones among them, and returns how many; n <= max. */
size_t mesh_grade(const double *edges, size_t n, double widest, double *graded,
                  size_t max);

#endif
