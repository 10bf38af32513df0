/* quadrature.c - adaptive Gauss-Legendre quadrature */
#include "validate/quadrature.h"

#include <math.h>
#include <stdlib.h>

#include "bsdf/fastmath.h"
#include "bsdf/lanes.h"

enum {
    ORDER = QUADRATURE_ORDER,
    NODES = QUADRATURE_NODES,
    PARTS = QUADRATURE_PARTS_MAX,
    DEPTH_MAX = 60,
    RULES = QUADRATURE_RULES,
    LEAVES = RULES / 4 /* refined at once: two halves along each axis */
};

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

/* Lobatto's, which has the ends among its nodes; those are moved inward by a
 * hair, as what is beyond an edge is not the leaf's.  Abramowitz and Stegun,
 * table 25.6; exact to degree 9. */
#define END (1 - 1e-9)
static const double end_node[ORDER] = {
    -END,
    -0.765055323929465,
    -0.285231516480645,
    0.285231516480645,
    0.765055323929465,
    END,
};
static const double end_weight[ORDER] = {
    0.066666666666667, 0.378474956297847, 0.554858377035486,
    0.554858377035486, 0.378474956297847, 0.066666666666667,
};

/* How far it may be off, in tolerances, before a leaf is split for it: on
 * smooth functions it is worse than the other rule. */
static const double ends_limit = 2;

/* What a rule found on a rectangle. */
struct found {
    double value[PARTS];
    double height; /* the largest |f| at a node */
};

struct leaf {
    struct rectangle r;
    struct found whole;
    struct quadrature_hint *hint;
    size_t n;
    struct estimate *out;
    int depth;
};

struct room {
    double x[RULES][ORDER], y[RULES][ORDER], value[PARTS * RULES * NODES];
};

struct work {
    quadrature_fn *f;
    const void *context;
    int parts;
    double tolerance;
    long *budget;
    struct room *room;
    struct leaf *leaf; /* a stack of those that are not accepted yet */
    size_t leaves, size;
};

/* The nodes of n rectangles. */
LANES static void nodes(const struct rectangle *r, size_t n,
                        const double *at_node, struct room *a)
{
    for (size_t at = 0; at < n; at++) {
        const double dx = (r[at].x1 - r[at].x0) / 2;
        const double dy = (r[at].y1 - r[at].y0) / 2;
        const double x0 = r[at].x0, y0 = r[at].y0;
        LANES_LOOP
        for (int i = 0; i < ORDER; i++) {
            a->x[at][i] = x0 + dx * (1 + at_node[i]);
            a->y[at][i] = y0 + dy * (1 + at_node[i]);
        }
    }
}

/* The weighted sum of a rectangle's values and the largest of them; by
 * SHARES partial ones, whatever the width of the vectors, so that the same
 * numbers are added in the same order everywhere. */
enum { SHARES = 4 };
INLINE double weighted(const double *weight, const double *f, double *height)
{
    double sum[SHARES] = { 0 }, top[SHARES] = { 0 };
    for (int k = 0; k < NODES; k += SHARES)
        LANES_LOOP
    for (int i = 0; i < SHARES; i++) {
        sum[i] += weight[k + i] * f[k + i];
        top[i] = fm_max(fabs(f[k + i]), top[i]); /* a NaN is passed over */
    }
    for (int i = 0; i < SHARES; i++)
        *height = fm_max(top[i], *height);
    return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

LANES static void weigh(const double *value, const struct rectangle *r,
                        size_t n, int parts, const double *row_weight,
                        struct found *found)
{
    double weight[NODES];
    for (int k = 0; k < NODES; k++)
        weight[k] = row_weight[k / ORDER] * row_weight[k % ORDER];
    for (size_t at = 0; at < n; at++)
        found[at].height = 0;
    for (int part = 0; part < parts; part++)
        for (size_t at = 0; at < n; at++, value += NODES)
            found[at].value[part] = (r[at].x1 - r[at].x0) *
                                    (r[at].y1 - r[at].y0) / 4 *
                                    weighted(weight, value, &found[at].height);
}

/* A rule of these nodes and weights on n rectangles, at most RULES. */
static void rules(struct work *w, const struct rectangle *r, size_t n,
                  const double *at_node, const double *row_weight,
                  struct found *found)
{
    struct room *a = w->room;
    nodes(r, n, at_node, a);
    w->f(w->context, n, (const double(*)[ORDER])a->x,
         (const double(*)[ORDER])a->y, a->value);
    *w->budget -= (long)(n * NODES);
    weigh(a->value, r, n, w->parts, row_weight, found);
}

/* Whether the nodes have met what the hints say is there. */
static bool met(const struct leaf *l, double height)
{
    for (size_t i = 0; i < l->n; i++)
        if (l->hint[i].height > 2 * height)
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

/* Not quite in the middle: around that all rules take a jump for one that is
 * just there, and so they agree. */
static const double middle = 15. / 32;

static void halves(struct rectangle r, struct rectangle half[4])
{
    for (int i = 0; i < 4; i++)
        half[i] = r;
    half[0].x1 = half[1].x0 = r.x0 + middle * (r.x1 - r.x0);
    half[2].y1 = half[3].y0 = r.y0 + middle * (r.y1 - r.y0);
}

static bool push(struct work *w, struct leaf l)
{
    if (w->leaves == w->size) {
        const size_t size = 2 * w->size + 1024;
        struct leaf *grown = realloc(w->leaf, size * sizeof *grown);
        if (!grown)
            return false;
        w->leaf = grown;
        w->size = size;
    }
    w->leaf[w->leaves++] = l;
    return true;
}

/* How far the sum of two halves is off the whole, in tolerances. */
static double disagreement(const struct work *w, const struct leaf *l,
                           const struct found half[2], double *off)
{
    double most = 0;
    for (int part = 0; part < w->parts; part++) {
        off[part] =
            half[0].value[part] + half[1].value[part] - l->whole.value[part];
        if (!(fabs(off[part]) <= most * w->tolerance)) /* or NaN */
            most = fabs(off[part]) / w->tolerance;
    }
    return most;
}

/* Puts the halves of a leaf along an axis on the stack. */
static bool split(struct work *w, const struct leaf *l, bool along_x,
                  const struct found half[4])
{
    const int axis = along_x ? 0 : 2;
    struct rectangle part[4];
    halves(l->r, part);
    struct leaf child = *l;
    const size_t first = hints_in(l->hint, l->n, part[axis]);
    child.depth++;
    child.r = part[axis];
    child.whole = half[axis];
    child.n = first;
    if (!push(w, child))
        return false;
    child.r = part[axis + 1];
    child.whole = half[axis + 1];
    child.hint = l->n ? l->hint + first : NULL;
    child.n = l->n - first;
    return push(w, child);
}

/* What is known of a leaf: the sums over its halves, and the rule with ends. */
struct known {
    double off_x[PARTS], off_y[PARTS];
    double x, y; /* the disagreements along both axes, in tolerances */
    bool last;   /* it cannot be split any more */
};

static struct known know(const struct work *w, const struct leaf *l,
                         const struct found half[4])
{
    struct known k;
    k.x = disagreement(w, l, half, k.off_x);
    k.y = disagreement(w, l, half + 2, k.off_y);
    k.last = l->depth == DEPTH_MAX || *w->budget <= 0;
    return k;
}

/* Whether all nodes agree. */
static bool agrees(const struct known *k, const struct leaf *l,
                   const struct found half[4])
{
    const double height = fmax(fmax(half[0].height, half[1].height),
                               fmax(half[2].height, half[3].height));
    /* A NaN is not looked into. */
    return !(k->x + k->y > 1) && met(l, height);
}

/* How far the rule with ends is off, in tolerances: a jump nearer to an edge
 * than the last node is seen by nothing else. */
static double off_at_ends(const struct work *w, const struct leaf *l,
                          const struct known *k, const struct found *ends)
{
    double most = 0;
    for (int part = 0; part < w->parts; part++)
        most = fmax(most, fabs(ends->value[part] - l->whole.value[part] -
                               k->off_x[part] - k->off_y[part]));
    return most / w->tolerance;
}

/* The axis along which the values at the n nodes just asked for are out of line
 * in a rectangle, by their second differences; in turns where both are, as at a
 * corner. */
static bool out_along_x(const struct work *w, size_t at, size_t n, int depth)
{
    double x = 0, y = 0;
    for (int part = 0; part < w->parts; part++) {
        const double(*f)[ORDER] = (const double(*)[ORDER])(
            w->room->value + ((size_t)part * n + at) * NODES);
        for (int i = 0; i < ORDER; i++)
            for (int k = 1; k + 1 < ORDER; k++) {
                x += fabs(f[k - 1][i] - 2 * f[k][i] + f[k + 1][i]);
                y += fabs(f[i][k - 1] - 2 * f[i][k] + f[i][k + 1]);
            }
    }
    return x > 2 * y || (!(y > 2 * x) && depth % 2 == 0);
}

static void accept(const struct work *w, const struct leaf *l,
                   const struct known *k, double at_ends)
{
    for (int part = 0; part < w->parts; part++) {
        l->out[part].value +=
            l->whole.value[part] + k->off_x[part] + k->off_y[part];
        l->out[part].error += fabs(k->off_x[part]) + fabs(k->off_y[part]);
        if (at_ends > ends_limit)
            l->out[part].error += at_ends * w->tolerance;
    }
}

/* Refines the last leaves of the stack until it is empty. */
static bool refine(struct work *w)
{
    struct leaf taken[LEAVES];
    struct known known[LEAVES];
    struct rectangle r[RULES];
    struct found found[RULES], ends[LEAVES];
    size_t agreed[LEAVES];
    while (w->leaves > 0) {
        const size_t n = w->leaves < LEAVES ? w->leaves : LEAVES;
        size_t waiting = 0;
        w->leaves -= n;
        for (size_t i = 0; i < n; i++) {
            taken[i] = w->leaf[w->leaves + i];
            halves(taken[i].r, r + 4 * i);
        }
        rules(w, r, 4 * n, node, node_weight, found);
        for (size_t i = 0; i < n; i++) {
            const struct leaf *l = &taken[i];
            known[i] = know(w, l, found + 4 * i);
            const struct known *k = &known[i];
            if (agrees(k, l, found + 4 * i))
                agreed[waiting++] = i;
            else if (k->last)
                accept(w, l, k, 0);
            /* Where nothing tells the axes apart, they take turns. */
            else if (!split(w, l,
                            k->x == k->y ? l->depth % 2 == 0 : k->x > k->y,
                            found + 4 * i))
                return false;
        }
        for (size_t i = 0; i < waiting; i++)
            r[i] = taken[agreed[i]].r;
        rules(w, r, waiting, end_node, end_weight, ends);
        for (size_t i = 0; i < waiting; i++) {
            const size_t at = agreed[i];
            const double off = off_at_ends(w, &taken[at], &known[at], &ends[i]);
            if (known[at].last || !(off > ends_limit))
                accept(w, &taken[at], &known[at], off);
            else if (!split(w, &taken[at],
                            out_along_x(w, i, waiting, taken[at].depth),
                            found + 4 * at))
                return false;
        }
    }
    return true;
}

/* Brings the hints that promise more than a height to the front; how many they
 * are. */
static size_t worth(struct quadrature_hint *hint, size_t n, double height)
{
    size_t in = 0;
    for (size_t i = 0; i < n; i++)
        if (hint[i].height > height) {
            const struct quadrature_hint t = hint[i];
            hint[i] = hint[in];
            hint[in++] = t;
        }
    return in;
}

/* The first rule on up to RULES jobs. */
static bool begin(struct work *w, const struct quadrature_job *job, size_t n)
{
    struct rectangle r[RULES] = { { 0 } };
    struct found found[RULES];
    for (size_t i = 0; i < n; i++)
        r[i] = job[i].r;
    rules(w, r, n, node, node_weight, found);
    for (size_t i = 0; i < n; i++) {
        /* On a graded mesh what a rectangle does not see its neighbours do: a
         * thousandth of the tolerance need not be looked at more closely. */
        const struct rectangle b = job[i].r;
        const double area = (b.x1 - b.x0) * (b.y1 - b.y0);
        const size_t hints =
            worth(job[i].hint, job[i].n, w->tolerance * 1e-3 / area);
        bool negligible = hints == 0;
        for (int part = 0; part < w->parts; part++)
            negligible &= fabs(found[i].value[part]) <= w->tolerance * 1e-3;
        for (int part = 0; negligible && part < w->parts; part++) {
            job[i].out[part].value += found[i].value[part];
            job[i].out[part].error += fabs(found[i].value[part]);
        }
        if (!negligible &&
            !push(w, (struct leaf){ job[i].r, found[i], job[i].hint, hints,
                                    job[i].out, 0 }))
            return false;
    }
    return true;
}

bool quadrature(quadrature_fn *f, const void *context, int parts,
                const struct quadrature_job *job, size_t jobs, double tolerance,
                long *budget)
{
    struct work w = { .f = f,
                      .context = context,
                      .parts = parts,
                      .tolerance = tolerance,
                      .budget = budget,
                      .room = malloc(sizeof *w.room) };
    bool ok = w.room;
    for (size_t at = 0; ok && at < jobs; at += RULES)
        ok = begin(&w, job + at, jobs - at < RULES ? jobs - at : RULES) &&
             refine(&w);
    free(w.leaf);
    free(w.room);
    return ok;
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
