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

/* What need not be looked at more closely, in tolerances. */
static const double negligible = 1e-3;

/* What a rule found on a rectangle. */
struct found {
    double value[PARTS];
    double height; /* the largest |f| at a node */
};

/* What a leaf's nodes met on one of its edges: the largest |f|, and where. */
struct edge {
    double height, at;
};

/* The rectangle of a job, or a half of one; a leaf as long as it has no halves
 * itself. */
struct node {
    struct rectangle r;
    size_t job;
    size_t halves; /* the first of two nodes; 0 of a leaf */
    bool along_x;  /* what was halved */
    bool fresh;    /* accepted since edges were last compared */
    int depth;
    double height; /* of a leaf: the largest |f| at a node */
    struct edge edge[QUADRATURE_SIDES];
};

/* A node that is not accepted yet. */
struct leaf {
    size_t node;
    struct found whole;
    struct quadrature_hint *hint;
    size_t n;
};

struct room {
    double x[RULES][ORDER], y[RULES][ORDER], value[PARTS * RULES * NODES];
};

struct work {
    quadrature_fn *f;
    const void *context;
    quadrature_beside *beside;
    const void *mesh;
    int parts;
    double tolerance;
    long *budget;
    struct room *room;
    struct leaf *leaf; /* a stack of those that are not accepted yet */
    size_t leaves, leaves_size;
    struct node *node;      /* those of the jobs come first */
    struct estimate *value; /* of the parts of each node that is a leaf */
    size_t nodes, nodes_size;
};

/* An array with room for one more than n, or NULL. */
static void *grown(void *array, size_t each, size_t n, size_t *size)
{
    if (n < *size)
        return array;
    const size_t more = 2 * *size + 1024;
    void *a = realloc(array, more * each);
    if (a)
        *size = more;
    return a;
}

/* The nodes of n rectangles. */
LANES static void place_nodes(const struct rectangle *r, size_t n,
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
    place_nodes(r, n, at_node, a);
    w->f(w->context, n, (const double(*)[ORDER])a->x,
         (const double(*)[ORDER])a->y, a->value);
    *w->budget -= (long)(n * NODES);
    weigh(a->value, r, n, w->parts, row_weight, found);
}

static double area(struct rectangle r)
{
    return (r.x1 - r.x0) * (r.y1 - r.y0);
}

/* Whether the nodes have met what the hints say is there, as far as it is worth
 * the while. */
static bool met(const struct work *w, const struct leaf *l, double height)
{
    const double least =
        fmax(2 * height, w->tolerance * negligible / area(w->node[l->node].r));
    for (size_t i = 0; i < l->n; i++)
        if (l->hint[i].height > least)
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
    struct leaf *leaf =
        grown(w->leaf, sizeof *leaf, w->leaves, &w->leaves_size);
    if (!leaf)
        return false;
    w->leaf = leaf;
    w->leaf[w->leaves++] = l;
    return true;
}

static bool node_add(struct work *w, struct node added)
{
    size_t size = w->nodes_size;
    struct node *more = grown(w->node, sizeof *more, w->nodes, &size);
    if (!more)
        return false;
    w->node = more;
    if (size > w->nodes_size) {
        struct estimate *value =
            realloc(w->value, size * (size_t)w->parts * sizeof *value);
        if (!value)
            return false;
        w->value = value;
        w->nodes_size = size;
    }
    w->node[w->nodes++] = added;
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
    const struct node parent = w->node[l->node];
    const size_t halves_at = w->nodes;
    struct rectangle part[4];
    halves(parent.r, part);
    for (int i = 0; i < 2; i++)
        if (!node_add(w, (struct node){ .r = part[axis + i],
                                        .job = parent.job,
                                        .depth = parent.depth + 1 }))
            return false;
    w->node[l->node].halves = halves_at;
    w->node[l->node].along_x = along_x;
    const size_t first = hints_in(l->hint, l->n, part[axis]);
    return push(w, (struct leaf){ halves_at, half[axis], l->hint, first }) &&
           push(w,
                (struct leaf){ halves_at + 1, half[axis + 1],
                               l->n ? l->hint + first : NULL, l->n - first });
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
    k.last = w->node[l->node].depth == DEPTH_MAX || *w->budget <= 0;
    return k;
}

static double height_of(const struct found half[4])
{
    return fmax(fmax(half[0].height, half[1].height),
                fmax(half[2].height, half[3].height));
}

/* Whether all nodes agree. */
static bool agrees(const struct work *w, const struct known *k,
                   const struct leaf *l, const struct found half[4])
{
    /* A NaN is not looked into. */
    return !(k->x + k->y > 1) && met(w, l, height_of(half));
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

static void accept(struct work *w, const struct leaf *l, const struct known *k,
                   double height, double at_ends)
{
    struct estimate *value = w->value + l->node * (size_t)w->parts;
    for (int part = 0; part < w->parts; part++) {
        value[part].value =
            l->whole.value[part] + k->off_x[part] + k->off_y[part];
        value[part].error = fabs(k->off_x[part]) + fabs(k->off_y[part]);
        if (at_ends > ends_limit)
            value[part].error += at_ends * w->tolerance;
    }
    w->node[l->node].height = height;
    w->node[l->node].fresh = true;
}

static void edge_meet(struct edge *e, double value, double at)
{
    if (fabs(value) > e->height)
        *e = (struct edge){ fabs(value), at };
}

/* What the nodes with ends, of which rule `at` of n was the leaf's, met on its
 * edges. */
static void edges_meet(const struct work *w, size_t at, size_t n,
                       struct edge edge[QUADRATURE_SIDES])
{
    const double *x = w->room->x[at], *y = w->room->y[at];
    for (int part = 0; part < w->parts; part++) {
        const double(*f)[ORDER] = (const double(*)[ORDER])(
            w->room->value + ((size_t)part * n + at) * NODES);
        for (int i = 0; i < ORDER; i++) {
            edge_meet(&edge[QUADRATURE_X0], f[0][i], y[i]);
            edge_meet(&edge[QUADRATURE_X1], f[ORDER - 1][i], y[i]);
            edge_meet(&edge[QUADRATURE_Y0], f[i][0], x[i]);
            edge_meet(&edge[QUADRATURE_Y1], f[i][ORDER - 1], x[i]);
        }
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
            halves(w->node[taken[i].node].r, r + 4 * i);
        }
        rules(w, r, 4 * n, node, node_weight, found);
        for (size_t i = 0; i < n; i++) {
            const struct leaf *l = &taken[i];
            known[i] = know(w, l, found + 4 * i);
            const struct known *k = &known[i];
            if (agrees(w, k, l, found + 4 * i))
                agreed[waiting++] = i;
            else if (k->last)
                accept(w, l, k, height_of(found + 4 * i), 0);
            /* Where nothing tells the axes apart, they take turns. */
            else if (!split(w, l,
                            k->x == k->y ? w->node[l->node].depth % 2 == 0
                                         : k->x > k->y,
                            found + 4 * i))
                return false;
        }
        for (size_t i = 0; i < waiting; i++)
            r[i] = w->node[taken[agreed[i]].node].r;
        rules(w, r, waiting, end_node, end_weight, ends);
        for (size_t i = 0; i < waiting; i++) {
            const size_t at = agreed[i];
            const struct leaf *l = &taken[at];
            const double off = off_at_ends(w, l, &known[at], &ends[i]);
            if (known[at].last || !(off > ends_limit)) {
                accept(w, l, &known[at],
                       fmax(height_of(found + 4 * at), ends[i].height), off);
                edges_meet(w, i, waiting, w->node[l->node].edge);
            } else if (!split(
                           w, l,
                           out_along_x(w, i, waiting, w->node[l->node].depth),
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

/* The first rule on up to RULES nodes; of those with hints left that promise
 * anything, and those that are not negligible, leaves are made. */
static bool begin(struct work *w, const struct leaf *leaf, size_t n)
{
    struct rectangle r[RULES] = { { 0 } };
    struct found found[RULES];
    for (size_t i = 0; i < n; i++)
        r[i] = w->node[leaf[i].node].r;
    rules(w, r, n, node, node_weight, found);
    for (size_t i = 0; i < n; i++) {
        /* On a graded mesh what a rectangle does not see its neighbours do. */
        const double small = w->tolerance * negligible;
        struct leaf l = leaf[i];
        l.whole = found[i];
        l.n = worth(l.hint, l.n, small / area(r[i]));
        bool done = l.n == 0;
        for (int part = 0; part < w->parts; part++)
            done &= fabs(found[i].value[part]) <= small;
        if (!done && !push(w, l))
            return false;
        for (int part = 0; done && part < w->parts; part++)
            w->value[l.node * (size_t)w->parts + (size_t)part] =
                (struct estimate){ found[i].value[part],
                                   fabs(found[i].value[part]) };
        if (done) {
            w->node[l.node].height = found[i].height;
            w->node[l.node].fresh = true;
        }
    }
    return true;
}

static bool go(struct work *w, const struct leaf *leaf, size_t n)
{
    for (size_t at = 0; at < n; at += RULES)
        if (!begin(w, leaf + at, n - at < RULES ? n - at : RULES) || !refine(w))
            return false;
    return true;
}

/* -- ridges that go on beyond an edge -------------------------------------- */

/* Where a leaf met more on an edge than its neighbour saw anywhere. */
struct crossing {
    size_t into;               /* the neighbour */
    enum quadrature_side side; /* the leaf's, that it lies beyond */
    double x, y;               /* in the neighbour's coordinates */
    double dx, dy;             /* how large the leaf is */
    struct quadrature_hint hint;
};

/* The leaf beyond a side of another at a point on it, which is put into that
 * one's coordinates. */
static size_t neighbour(const struct work *w, const struct node *l,
                        enum quadrature_side side, double *x, double *y)
{
    const struct rectangle r = l->r, all = w->node[l->job].r;
    const bool last[QUADRATURE_SIDES] = { r.x0 == all.x0, r.x1 == all.x1,
                                          r.y0 == all.y0, r.y1 == all.y1 };
    size_t at = l->job;
    if (last[side])
        at = w->beside ? w->beside(w->mesh, l->job, side, x, y)
                       : QUADRATURE_NONE;
    while (at != QUADRATURE_NONE && w->node[at].halves > 0) {
        const struct node *n = &w->node[at];
        const struct rectangle first = w->node[n->halves].r;
        const double to = n->along_x ? *x : *y;
        const double cut = n->along_x ? first.x1 : first.y1;
        const bool up =
            n->along_x ? side == QUADRATURE_X1 : side == QUADRATURE_Y1;
        at = n->halves + (to > cut || (up && to == cut) ? 1 : 0);
    }
    return at;
}

/* Whether a height that was met at the edge of a leaf is more than it saw, and
 * would matter. */
static bool missed(const struct work *w, const struct node *l, double height)
{
    return height > 2 * l->height && height * area(l->r) > w->tolerance &&
           l->depth < DEPTH_MAX;
}

/* Where a leaf met most on a side. */
static struct crossing crossing_at(const struct node *l,
                                   enum quadrature_side side)
{
    const struct rectangle r = l->r;
    const double at = l->edge[side].at;
    struct crossing c = {
        .side = side, .x = at, .y = at, .dx = r.x1 - r.x0, .dy = r.y1 - r.y0
    };
    if (side == QUADRATURE_X0 || side == QUADRATURE_X1)
        c.x = side == QUADRATURE_X0 ? r.x0 : r.x1;
    else
        c.y = side == QUADRATURE_Y0 ? r.y0 : r.y1;
    return c;
}

/* Finds crossings of edges of which a side was accepted since the last time;
 * false when out of memory.  The array is the caller's. */
static bool crossings(struct work *w, struct crossing **out, size_t *n)
{
    enum { SIDES = QUADRATURE_SIDES };
    size_t size = 0;
    *n = 0;
    for (size_t i = 0; i < SIDES * w->nodes; i++) {
        const struct node *l = &w->node[i / SIDES];
        const enum quadrature_side side = (enum quadrature_side)(i % SIDES);
        if (l->halves > 0 || !(l->edge[side].height > 0))
            continue;
        struct crossing c = crossing_at(l, side);
        c.into = neighbour(w, l, side, &c.x, &c.y);
        if (c.into == QUADRATURE_NONE || !(l->fresh || w->node[c.into].fresh) ||
            !missed(w, &w->node[c.into], l->edge[side].height))
            continue;
        struct crossing *more = grown(*out, sizeof *more, *n, &size);
        if (!more)
            return false;
        *out = more;
        more[(*n)++] = c;
    }
    for (size_t i = 0; i < w->nodes; i++)
        w->node[i].fresh = false;
    return true;
}

static double within(double x, double low, double high)
{
    return fmin(fmax(x, low), high);
}

/* Looks beyond the edges of up to RULES crossings, as far as the leaf is large:
 * the highest point there is the hint. */
static void look_beyond(struct work *w, struct crossing *c, size_t n)
{
    static const double away[ORDER] = { 1e-9, 0.1, 0.25, 0.5, 0.75, 1 };
    static const double along[ORDER] = { -0.3, -0.1, -0.03, 0, 0.03, 0.1 };
    struct room *a = w->room;
    for (size_t i = 0; i < n; i++) {
        const struct rectangle r = w->node[c[i].into].r;
        for (int k = 0; k < ORDER; k++) {
            const double x[QUADRATURE_SIDES] = { -away[k], away[k], along[k],
                                                 along[k] };
            const double y[QUADRATURE_SIDES] = { along[k], along[k], -away[k],
                                                 away[k] };
            a->x[i][k] = within(c[i].x + x[c[i].side] * c[i].dx, r.x0, r.x1);
            a->y[i][k] = within(c[i].y + y[c[i].side] * c[i].dy, r.y0, r.y1);
        }
    }
    w->f(w->context, n, (const double(*)[ORDER])a->x,
         (const double(*)[ORDER])a->y, a->value);
    *w->budget -= (long)(n * NODES);
    for (size_t i = 0; i < n; i++) {
        c[i].hint.height = 0;
        for (int part = 0; part < w->parts; part++)
            for (int k = 0; k < NODES; k++) {
                const double f =
                    fabs(a->value[((size_t)part * n + i) * NODES + (size_t)k]);
                if (f > c[i].hint.height)
                    c[i].hint =
                        (struct quadrature_hint){ a->x[i][k / ORDER],
                                                  a->y[i][k % ORDER], f };
            }
    }
}

static int by_node(const void *a, const void *b)
{
    const size_t x = ((const struct crossing *)a)->into;
    const size_t y = ((const struct crossing *)b)->into;
    return (x > y) - (x < y);
}

/* Integrates again over the leaves that have missed something. */
static bool mend(struct work *w, const struct crossing *c, size_t n)
{
    struct leaf *leaf = malloc((n + 1) * sizeof *leaf);
    struct quadrature_hint *hint = malloc((n + 1) * sizeof *hint);
    bool ok = leaf && hint;
    size_t leaves = 0;
    for (size_t i = 0; ok && i < n; i++) {
        hint[i] = c[i].hint;
        if (i == 0 || c[i].into != c[i - 1].into)
            leaf[leaves++] =
                (struct leaf){ .node = c[i].into, .hint = hint + i };
        leaf[leaves - 1].n++;
    }
    ok = ok && go(w, leaf, leaves);
    free(hint);
    free(leaf);
    return ok;
}

/* A ridge may cross a corner of a leaf unseen; where it does its neighbour, in
 * which nodes lie on the common edge, has met it there. */
static bool follow(struct work *w)
{
    struct crossing *c = NULL;
    size_t n;
    bool ok = true, any = true;
    while (ok && any && *w->budget > 0) {
        size_t kept = 0;
        ok = crossings(w, &c, &n);
        for (size_t at = 0; ok && at < n; at += RULES)
            look_beyond(w, c + at, n - at < RULES ? n - at : RULES);
        for (size_t i = 0; ok && i < n; i++)
            if (missed(w, &w->node[c[i].into], c[i].hint.height))
                c[kept++] = c[i];
        any = kept > 0;
        if (ok && any) {
            qsort(c, kept, sizeof *c, by_node);
            ok = mend(w, c, kept);
        }
    }
    free(c);
    return ok;
}

bool quadrature_joined(quadrature_fn *f, const void *context, int parts,
                       const struct quadrature_job *job, size_t jobs,
                       quadrature_beside *beside, const void *mesh,
                       double tolerance, long *budget)
{
    struct work w = { .f = f,
                      .context = context,
                      .beside = beside,
                      .mesh = mesh,
                      .parts = parts,
                      .tolerance = tolerance,
                      .budget = budget,
                      .room = malloc(sizeof *w.room) };
    struct leaf *leaf = malloc((jobs + 1) * sizeof *leaf);
    bool ok = w.room && leaf;
    for (size_t i = 0; ok && i < jobs; i++) {
        leaf[i] =
            (struct leaf){ .node = i, .hint = job[i].hint, .n = job[i].n };
        ok = node_add(&w, (struct node){ .r = job[i].r, .job = i });
    }
    ok = ok && go(&w, leaf, jobs) && follow(&w);
    for (size_t i = 0; ok && i < w.nodes; i++)
        for (int part = 0; w.node[i].halves == 0 && part < parts; part++) {
            struct estimate *out = &job[w.node[i].job].out[part];
            *out =
                estimate_add(*out, w.value[i * (size_t)parts + (size_t)part]);
        }
    free(leaf);
    free(w.leaf);
    free(w.value);
    free(w.node);
    free(w.room);
    return ok;
}

bool quadrature(quadrature_fn *f, const void *context, int parts,
                const struct quadrature_job *job, size_t jobs, double tolerance,
                long *budget)
{
    return quadrature_joined(f, context, parts, job, jobs, NULL, NULL,
                             tolerance, budget);
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
