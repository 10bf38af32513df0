/* quadrature.c - adaptive Gauss-Legendre quadrature */
#include "validate/quadrature.h"

#include <math.h>
#include <stdbool.h>

enum { ORDER = QUADRATURE_ORDER, DEPTH_MAX = 60 };

/* Nodes and weights on [-1, 1], the roots of P6.  M. Abramowitz and I. Stegun,
 * Handbook of Mathematical Functions, 1964, table 25.4. */
static const double node[ORDER] = {
    -0.932469514203152, -0.661209386466265, -0.238619186083197,
    0.238619186083197,  0.661209386466265,  0.932469514203152,
};
static const double node_weight[ORDER] = {
    0.171324492379170, 0.360761573048139, 0.467913934572691,
    0.467913934572691, 0.360761573048139, 0.171324492379170,
};

struct job {
    quadrature_fn *f;
    const void *context;
    int parts;
    double tolerance;
    long *budget;
    struct estimate *out;
};

/* The rule on one rectangle, a value a part; the largest |f| at a node. */
static double rule(struct job *j, struct rectangle r, double *value)
{
    double x[ORDER], y[ORDER], f[QUADRATURE_PARTS_MAX * ORDER * ORDER];
    const double dx = (r.x1 - r.x0) / 2, dy = (r.y1 - r.y0) / 2;
    for (int i = 0; i < ORDER; i++) {
        x[i] = r.x0 + dx * (1 + node[i]);
        y[i] = r.y0 + dy * (1 + node[i]);
    }
    j->f(j->context, x, y, f);
    *j->budget -= ORDER * ORDER;
    double most = 0;
    for (int i = 0; i < j->parts * ORDER * ORDER; i++)
        most = fmax(most, fabs(f[i]));
    for (int part = 0, at = 0; part < j->parts; part++) {
        value[part] = 0;
        for (int i = 0; i < ORDER; i++) {
            double row = 0;
            for (int k = 0; k < ORDER; k++, at++)
                row += node_weight[k] * f[at];
            value[part] += dx * dy * node_weight[i] * row;
        }
    }
    return most;
}

/* Both halves of a rectangle along x or along y, and how far the sum is off the
 * whole. */
struct halves {
    struct rectangle r[2];
    double value[2][QUADRATURE_PARTS_MAX], off[QUADRATURE_PARTS_MAX];
    double most;   /* off, in tolerances */
    double height; /* the largest |f| at a node */
};

static void halve(struct job *j, struct rectangle r, bool along_x,
                  const double *whole, struct halves *h)
{
    h->r[0] = h->r[1] = r;
    if (along_x)
        h->r[0].x1 = h->r[1].x0 = (r.x0 + r.x1) / 2;
    else
        h->r[0].y1 = h->r[1].y0 = (r.y0 + r.y1) / 2;
    h->height =
        fmax(rule(j, h->r[0], h->value[0]), rule(j, h->r[1], h->value[1]));
    h->most = 0;
    for (int part = 0; part < j->parts; part++) {
        h->off[part] = h->value[0][part] + h->value[1][part] - whole[part];
        if (!(fabs(h->off[part]) <= h->most * j->tolerance)) /* or NaN */
            h->most = fabs(h->off[part]) / j->tolerance;
    }
}

/* Whether the nodes have met what the hints say is there. */
static bool met(const struct quadrature_hint *hint, size_t n, double height)
{
    for (size_t i = 0; i < n; i++)
        if (hint[i].height > 2 * height)
            return false;
    return true;
}

/* Brings the hints in a rectangle to the front; how many they are. */
static size_t hints_in(struct quadrature_hint *hint, size_t n,
                       struct rectangle r)
{
    size_t in = 0;
    for (size_t i = 0; i < n; i++)
        if (hint[i].x <= r.x1 && hint[i].y <= r.y1) {
            const struct quadrature_hint t = hint[i];
            hint[i] = hint[in];
            hint[in++] = t;
        }
    return in;
}

static void refine(struct job *j, struct rectangle r, const double *whole,
                   struct quadrature_hint *hint, size_t n, int depth)
{
    struct halves x, y;
    halve(j, r, true, whole, &x);
    halve(j, r, false, whole, &y);
    const bool seen = met(hint, n, fmax(x.height, y.height));
    /* A NaN is not looked into. */
    if ((!(x.most + y.most > 1) && seen) || depth == DEPTH_MAX ||
        *j->budget <= 0) {
        for (int part = 0; part < j->parts; part++) {
            j->out[part].value += whole[part] + x.off[part] + y.off[part];
            j->out[part].error += fabs(x.off[part]) + fabs(y.off[part]);
        }
        return;
    }
    /* Where nothing tells the axes apart, they take turns. */
    const bool along_x = x.most == y.most ? depth % 2 == 0 : x.most > y.most;
    const struct halves *worse = along_x ? &x : &y;
    const size_t first = hints_in(hint, n, worse->r[0]);
    refine(j, worse->r[0], worse->value[0], hint, first, depth + 1);
    refine(j, worse->r[1], worse->value[1], hint + first, n - first, depth + 1);
}

void quadrature(quadrature_fn *f, const void *context, int parts,
                struct rectangle r, double tolerance, long *budget,
                struct quadrature_hint *hint, size_t n, struct estimate *out)
{
    struct job j = { f, context, parts, tolerance, budget, out };
    double whole[QUADRATURE_PARTS_MAX];
    (void)rule(&j, r, whole);

    /* On a graded mesh what a rectangle does not see its neighbours do: a
     * thousandth of the tolerance need not be looked at more closely. */
    bool negligible = n == 0;
    for (int part = 0; part < parts; part++)
        negligible &= fabs(whole[part]) <= tolerance * 1e-3;
    if (!negligible) {
        refine(&j, r, whole, hint, n, 0);
        return;
    }
    for (int part = 0; part < parts; part++) {
        out[part].value += whole[part];
        out[part].error += fabs(whole[part]);
    }
}

size_t mesh_grade(const double *edges, size_t n, double widest, double *graded,
                  size_t max)
{
    size_t count = 0;
    for (size_t i = 0; i + 1 < n; i++) {
        double low = edges[i], high = edges[i + 1];
        double left = i > 0 ? low - edges[i - 1] : widest;
        double right = i + 2 < n ? edges[i + 2] - high : widest;
        double from_right[128];
        size_t rights = 0;
        graded[count++] = low;
        /* Room must remain for the edges that were given. */
        while (high - low > fmin(2 * fmin(left, right), widest) &&
               rights < 128 && count + rights + (n - 1 - i) < max) {
            if (left <= right) {
                left = fmin(2 * left, widest);
                low += left;
                graded[count++] = low;
            } else {
                right = fmin(2 * right, widest);
                high -= right;
                from_right[rights++] = high;
            }
        }
        while (rights > 0)
            graded[count++] = from_right[--rights];
    }
    graded[count++] = edges[n - 1];
    return count;
}
