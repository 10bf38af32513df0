/* cells.c - charts of the sphere, counts and integrals over their cells */
#include "plots/cells.h"

#include <gsl/gsl_sort.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/fresnel.h"
#include "bsdf/medium.h"
#include "bsdf/rng.h"
#include "validate/quadrature.h"

enum {
    PILOTS = 16384,
    BATCH = 256,
    SIDE_MIN = 12,
    SIDE_MAX = 53,
    LEAF_PILOTS = 8,
    LEAF_DEPTH = 30
};
const double cells_expected_min = 5;
static const double samples_per_cell = 50; /* at least, on average */

/* -- directions and the plane ---------------------------------------------- */

/* The half vector, on the side of wo; of refraction the one that Snell's law
 * has.  Its length is any. */
static struct vec3 half(const struct cells *h, struct vec3 w)
{
    const double n = h->through > 0 ? h->through : 1;
    const struct vec3 m = vec3_add(h->wo, vec3_scale(n, w));
    return m.z * h->wo.z < 0 ? vec3_scale(-1, m) : m;
}

/* Along the azimuth of the mirror direction, and across it. */
static struct cell_point turned(const struct cells *h, struct vec3 w)
{
    return (struct cell_point){ w.x * h->ahead.x + w.y * h->ahead.y,
                                w.y * h->ahead.x - w.x * h->ahead.y, 0 };
}

struct cell_point cells_point(const struct cells *h, struct vec3 w)
{
    const bool halved = h->plane == CELLS_HALF;
    const struct vec3 m = halved ? half(h, w) : w;
    const struct cell_point p = turned(h, m);
    if (halved || h->plane == CELLS_DISK) {
        const double length = halved ? vec3_length(m) : 1;
        return (struct cell_point){ p.x / length, p.y / length, 0 };
    }
    const double theta = atan2(hypot(p.x, p.y), h->side * w.z);
    const double phi = atan2(p.y, p.x);
    return h->plane == CELLS_POLE
               ? (struct cell_point){ theta * cos(phi), theta * sin(phi), 0 }
               : (struct cell_point){ theta, phi, 0 };
}

/* The direction with these components along and across. */
static struct vec3 turned_back(const struct cells *h, double along,
                               double across, double z)
{
    return (struct vec3){ along * h->ahead.x - across * h->ahead.y,
                          along * h->ahead.y + across * h->ahead.x, z };
}

/* wi of a half vector, and its solid angle for one of that vector's.
 * B. Walter et al., Microfacet Models for Refraction through Rough Surfaces,
 * EGSR 2007, sec. 4.1. */
static struct vec3 from_half(const struct cells *h, struct vec3 m,
                             double *density)
{
    const struct vec3 none = { 0, 0, -h->side };
    const double c = vec3_dot(h->wo, m), n = h->through;
    *density = 0;
    if (!(c > 0))
        return none;
    if (!(n > 0)) {
        *density = 4 * c;
        return vec3_reflect(h->wo, m);
    }
    double cos_t;
    fresnel_dielectric(fmin(c, 1), n, &cos_t);
    if (!(cos_t > 0))
        return none;
    const struct vec3 w = medium_refract(h->wo, m, n, cos_t);
    const double root = c + n * vec3_dot(w, m);
    *density = root * root / (n * n * fabs(vec3_dot(w, m)));
    return w;
}

/* The direction at a point, and the solid angle of a unit square there; 0 where
 * there is none. */
static struct vec3 direction(const struct cells *h, double x, double y,
                             double *density)
{
    if (h->plane == CELLS_HALF || h->plane == CELLS_DISK) {
        const double z2 = 1 - x * x - y * y;
        *density = 0;
        if (!(z2 > 0))
            return (struct vec3){ 0, 0, -h->side };
        const double z = sqrt(z2);
        if (h->plane == CELLS_DISK) {
            *density = 1 / z;
            return turned_back(h, x, y, h->side * z);
        }
        const struct vec3 w =
            from_half(h, turned_back(h, x, y, copysign(z, h->wo.z)), density);
        *density /= z;
        return w;
    }
    const bool pole = h->plane == CELLS_POLE;
    const double theta = pole ? hypot(x, y) : x, s = sin(theta);
    *density = !pole ? s : theta > 0 ? s / theta : 1;
    return turned_back(h, *density * (pole ? x : cos(y)),
                       *density * (pole ? y : sin(y)), h->side * cos(theta));
}

/* The rectangle of a cell. */
static struct rectangle rectangle_of(const struct cells *h, size_t cell)
{
    const size_t column = cell % h->n, row = cell / h->n;
    const double x = h->x0 + (double)column * h->dx;
    const double y = h->y0 + (double)row * h->dy;
    return (struct rectangle){ x, x + h->dx, y, y + h->dy };
}

struct cell_point cells_middle(const struct cells *h, size_t cell)
{
    const struct rectangle r = rectangle_of(h, cell);
    return (struct cell_point){ (r.x0 + r.x1) / 2, (r.y0 + r.y1) / 2, cell };
}

/* The cell, or n * n outside the window. */
static size_t cell_of(const struct cells *h, struct vec3 w)
{
    if (!(h->side * w.z >= 0))
        return h->n * h->n;
    const struct cell_point p = cells_point(h, w);
    const double i = floor((p.x - h->x0) / h->dx);
    const double k = floor((p.y - h->y0) / h->dy);
    const double n = (double)h->n;
    return i >= 0 && i < n && k >= 0 && k < n ? (size_t)k * h->n + (size_t)i
                                              : h->n * h->n;
}

/* -- samples --------------------------------------------------------------- */

static void count(struct cells *h)
{
    const struct rng rng = subject_rng(&h->subject, STREAM_SURVEY);
    const int64_t batches = (int64_t)((h->samples + BATCH - 1) / BATCH);
    uint64_t none = 0, single = 0, inside = 0, beyond = 0;
#pragma omp parallel for schedule(static) reduction(+ : none, single, inside, beyond)
    for (int64_t k = 0; k < batches; k++) {
        struct bsdf_sample batch[BATCH];
        const uint64_t from = (uint64_t)k * BATCH, left = h->samples - from;
        const size_t n = left < BATCH ? (size_t)left : BATCH;
        subject_draw(&h->subject, rng, from, n, batch);
        for (size_t i = 0; i < n; i++) {
            if (subject_refused(&batch[i])) {
                none++;
            } else if (batch[i].delta) {
                single++;
            } else {
                const size_t cell = cell_of(h, batch[i].wi);
                beyond += h->side * batch[i].wi.z < 0;
                if (cell == h->n * h->n)
                    continue;
                inside++;
#pragma omp atomic
                h->cell[cell].count++;
            }
        }
    }
    h->refused = none;
    h->deltas = single;
    h->inside = inside;
    h->beyond = beyond;
}

/* -- the window ------------------------------------------------------------ */

struct range {
    double from, to;
};

static double width(struct range r)
{
    return r.to - r.from;
}

/* Where 96 % of the pilots are, in x or in y, and a margin of 20 % of it. */
static struct range bulk(const struct cell_point *p, size_t n, bool of_y,
                         double *room)
{
    for (size_t i = 0; i < n; i++)
        room[i] = of_y ? p[i].y : p[i].x;
    gsl_sort(room, 1, n);
    const struct range r = { room[n / 50], room[n - 1 - n / 50] };
    const double margin = fmax(0.2 * width(r), 1e-9);
    return (struct range){ r.from - margin, r.to + margin };
}

/* Moves a range into [-limit, limit], or cuts it. */
static struct range within(struct range r, double limit)
{
    if (width(r) >= 2 * limit)
        return (struct range){ -limit, limit };
    const double off = fmax(r.to - limit, 0) - fmax(-limit - r.from, 0);
    return (struct range){ r.from - off, r.to - off };
}

static struct range widened(struct range r, double to)
{
    const double by = (to - width(r)) / 2;
    return (struct range){ r.from - by, r.to + by };
}

/* Both scales of a plane are the same, unless the lobe is a thin line. */
static void pole_window(struct range *x, struct range *y, double limit)
{
    const double wide = fmax(width(*x), width(*y));
    if (fmin(width(*x), width(*y)) > wide / 6) {
        *x = widened(*x, wide);
        *y = widened(*y, wide);
    }
    *x = within(*x, limit);
    *y = within(*y, limit);
    /* Nearly the whole side is better shown whole. */
    if (fmin(width(*x), width(*y)) > 1.6 * limit)
        *x = *y = (struct range){ -limit, limit };
}

static void flatten(const struct cells *h, const struct vec3 *w, size_t n,
                    struct cell_point *p)
{
    for (size_t i = 0; i < n; i++)
        p[i] = cells_point(h, w[i]);
}

/* Chooses the plane, and the window in it; n > 0. */
static void window(struct cells *h, const struct vec3 *w, size_t n,
                   struct cell_point *p, double *room)
{
    flatten(h, w, n, p);
    struct range x = bulk(p, n, false, room), y = bulk(p, n, true, room);
    if (h->plane == CELLS_ANGLES && width(y) > PI / 2) {
        h->plane = CELLS_POLE;
        flatten(h, w, n, p);
        x = bulk(p, n, false, room);
        y = bulk(p, n, true, room);
    }
    if (h->plane != CELLS_ANGLES) {
        pole_window(&x, &y, h->plane == CELLS_POLE ? PI / 2 : 1);
    } else {
        x.from = fmax(x.from, 0);
        x.to = fmin(x.to, PI / 2);
        y.from = fmax(y.from, -PI);
        y.to = fmin(y.to, PI);
    }
    h->x0 = x.from;
    h->y0 = y.from;
    h->dx = width(x) / (double)h->n;
    h->dy = width(y) / (double)h->n;
}

/* -- integrals ------------------------------------------------------------- */

static void on_cell(const void *context, size_t n,
                    const double (*x)[QUADRATURE_ORDER],
                    const double (*y)[QUADRATURE_ORDER], double *value)
{
    enum { ORDER = QUADRATURE_ORDER, NODES = QUADRATURE_NODES };
    const struct cells *h = context;
    double *area = value + n * NODES;
    for (size_t rule = 0; rule < n; rule++, value += NODES, area += NODES) {
        double wx[NODES], wy[NODES], wz[NODES];
        for (int i = 0, at = 0; i < ORDER; i++)
            for (int k = 0; k < ORDER; k++, at++) {
                const struct vec3 w =
                    direction(h, x[rule][i], y[rule][k], &area[at]);
                wx[at] = w.x, wy[at] = w.y, wz[at] = w.z;
            }
        subject_pdf(&h->subject, NODES, (struct dirs){ wx, wy, wz }, value);
        for (int at = 0; at < NODES; at++) {
            area[at] *= h->side * wz[at] > 0;
            value[at] = area[at] > 0 ? value[at] * area[at] : 0;
        }
    }
}

/* Moves the points below the middle to the front; returns how many. */
static size_t split(struct cell_point *p, size_t n, bool of_y, double middle)
{
    size_t low = 0;
    for (size_t i = 0; i < n; i++)
        if ((of_y ? p[i].y : p[i].x) < middle) {
            const struct cell_point swap = p[low];
            p[low++] = p[i];
            p[i] = swap;
        }
    return low;
}

/* The rectangles that a cell is integrated over. */
struct parts {
    struct quadrature_job *job;
    size_t n, size;
    struct estimate *out;
};

static bool parts_add(struct parts *p, struct rectangle r)
{
    if (p->n == p->size) {
        const size_t size = 2 * p->size + 64;
        struct quadrature_job *grown = realloc(p->job, size * sizeof *grown);
        if (!grown)
            return false;
        p->job = grown;
        p->size = size;
    }
    p->job[p->n++] = (struct quadrature_job){ r, NULL, 0, p->out };
    return true;
}

/* Quarters a rectangle until each holds but a few pilots. */
static bool quarter(struct parts *parts, struct rectangle r,
                    struct cell_point *p, size_t n, int depth)
{
    if (n <= LEAF_PILOTS || depth == LEAF_DEPTH)
        return parts_add(parts, r);
    const double x = (r.x0 + r.x1) / 2, y = (r.y0 + r.y1) / 2;
    const size_t left = split(p, n, false, x);
    for (int right = 0; right < 2; right++) {
        struct cell_point *q = right ? p + left : p;
        const size_t all = right ? n - left : left;
        const size_t low = split(q, all, true, y);
        const double x0 = right ? x : r.x0, x1 = right ? r.x1 : x;
        if (!quarter(parts, (struct rectangle){ x0, x1, r.y0, y }, q, low,
                     depth + 1) ||
            !quarter(parts, (struct rectangle){ x0, x1, y, r.y1 }, q + low,
                     all - low, depth + 1))
            return false;
    }
    return true;
}

static void integrate(const struct cells *h, struct rectangle r,
                      struct cell_point *p, size_t n, double tolerance,
                      long *budget, struct estimate *out)
{
    struct parts parts = { .out = out };
    if (!quarter(&parts, r, p, n, 0) ||
        !quadrature(on_cell, h, 2, parts.job, parts.n, tolerance, budget))
        out[0] = out[1] = (struct estimate){ NAN, NAN };
    free(parts.job);
}

static int by_cell(const void *a, const void *b)
{
    const size_t x = ((const struct cell_point *)a)->cell;
    const size_t y = ((const struct cell_point *)b)->cell;
    return (x > y) - (x < y);
}

/* A cell may be off by some hundredths of a sample; its budget bounds the time
 * that a pdf with many edges takes. */
static void masses(struct cells *h, const struct vec3 *w, struct cell_point *p,
                   size_t n)
{
    const size_t cells = h->n * h->n;
    const double tolerance = fmax(0.01 / (double)h->samples, 1e-11);
    for (size_t i = 0; i < n; i++) {
        p[i] = cells_point(h, w[i]);
        p[i].cell = cell_of(h, w[i]);
    }
    qsort(p, n, sizeof *p, by_cell);
#pragma omp parallel for schedule(dynamic)
    for (size_t c = 0; c < cells; c++) {
        long budget = 100000;
        size_t first = 0, end = n;
        while (first < end) { /* the first pilot that is not before this cell */
            const size_t middle = (first + end) / 2;
            if (p[middle].cell < c)
                first = middle + 1;
            else
                end = middle;
        }
        while (end < n && p[end].cell == c)
            end++;
        struct estimate out[2] = { { 0, 0 }, { 0, 0 } };
        integrate(h, rectangle_of(h, c), p + first, end - first, tolerance,
                  &budget, out);
        h->cell[c].mass = out[0];
        h->cell[c].solid = out[1];
    }
}

/* -- all of the numbers ---------------------------------------------------- */

/* Pilots on the side that has most of them. */
static size_t pilots(struct cells *h, struct vec3 *w)
{
    const struct rng rng = subject_rng(&h->subject, STREAM_PILOT);
    size_t n = 0, above = 0, kept = 0;
    struct bsdf_sample batch[BATCH];
    for (uint64_t at = 0; at < PILOTS; at += BATCH) {
        subject_draw(&h->subject, rng, at, BATCH, batch);
        for (size_t i = 0; i < BATCH; i++)
            if (!subject_refused(&batch[i]) && !batch[i].delta &&
                vec3_dot(batch[i].wi, batch[i].wi) > 0.5)
                w[n++] = batch[i].wi;
    }
    for (size_t i = 0; i < n; i++)
        above += w[i].z >= 0;
    h->side = 2 * above >= n ? 1 : -1;
    for (size_t i = 0; i < n; i++)
        if (h->side * w[i].z >= 0)
            w[kept++] = w[i];
    return kept;
}

static size_t cells_a_side(uint64_t samples)
{
    const double n = sqrt((double)samples / samples_per_cell);
    return (size_t)fmin(fmax(n, SIDE_MIN), SIDE_MAX);
}

static bool nothing_to_draw(const struct cells *h, struct err *err)
{
    const char *name = bsdf_type(h->bsdf)->name;
    const struct angles wo = dir_to_degrees(h->wo);
    if (!(bsdf_claims(h->bsdf).lobes & ~(unsigned)BSDF_DELTA))
        return err_set(err,
                       "histogram: %s has only delta lobes, so there is no "
                       "density to draw; expected a model with another lobe",
                       name);
    return err_set(err,
                   "histogram: %s draws no direction from theta %.6g, phi "
                   "%.6g deg, so there is nothing to draw",
                   name, wo.theta_deg, wo.phi_deg);
}

/* What a half vector means depends on the side that most light is on. */
static bool through(struct cells *h, struct err *err)
{
    const double eta = h->subject.claims.eta;
    h->through = h->side * h->wo.z >= 0 ? 0 : h->wo.z > 0 ? eta : 1 / eta;
    return h->plane != CELLS_HALF || h->through != 1 ||
           err_set(err,
                   "--zoom half: most light goes through, and there is no half "
                   "vector without refraction; expected --zoom disk");
}

static bool make(struct cells *h, struct err *err)
{
    struct vec3 *w = malloc(PILOTS * sizeof *w);
    struct cell_point *p = malloc(PILOTS * sizeof *p);
    double *room = malloc(PILOTS * sizeof *room);
    bool ok = false;
    h->n = cells_a_side(h->samples);
    h->cell = calloc(h->n * h->n, sizeof *h->cell);
    if (!w || !p || !room || !h->cell) {
        err_set(err, "out of memory");
        goto done;
    }
    const size_t n = pilots(h, w);
    ok = (n > 0 || nothing_to_draw(h, err)) && through(h, err);
    if (ok) {
        window(h, w, n, p, room);
        masses(h, w, p, n);
        count(h);
    }
done:
    free(w);
    free(p);
    free(room);
    return ok;
}

bool cells_make(struct cells *h, const struct bsdf *b, struct vec3 wo,
                enum cells_plane plane, const struct plan *plan,
                struct err *err)
{
    const double across = hypot(wo.x, wo.y);
    *h = (struct cells){
        .bsdf = b,
        .subject = subject_plain(b, wo, plan),
        .wo = wo,
        .ahead = across > 0 ? (struct vec3){ -wo.x / across, -wo.y / across, 0 }
                            : (struct vec3){ 1, 0, 0 },
        .plane = plane,
        .side = 1,
        .samples = plan->samples,
    };
    if (make(h, err))
        return true;
    cells_clear(h);
    return false;
}

void cells_clear(struct cells *h)
{
    free(h->cell);
    h->cell = NULL;
}

double cells_expected(const struct cells *h, const struct cell *c)
{
    return c->mass.value * (double)h->samples;
}

/* NaN where too little is expected. */
double cells_residual(const struct cells *h, const struct cell *c)
{
    const double e = cells_expected(h, c);
    return e >= cells_expected_min ? ((double)c->count - e) / sqrt(e) : NAN;
}

/* A density is not drawn where less than a tenth of the cell is on this side
 * of the surface. */
bool cells_sliver(const struct cells *h, size_t i)
{
    const struct cell_point p = cells_middle(h, i);
    double density;
    direction(h, p.x, p.y, &density);
    return !(h->cell[i].solid.value > 0.1 * density * h->dx * h->dy);
}

/* The largest density of the cells that have, or expect, so many samples. */
static double densest(const struct cells *h, double at_least)
{
    double most = 0;
    for (size_t i = 0; i < h->n * h->n; i++) {
        const struct cell *c = &h->cell[i];
        const double larger = fmax(cells_expected(h, c), (double)c->count);
        if (!cells_sliver(h, i) && larger >= at_least && isfinite(larger))
            most = fmax(most, larger / (double)h->samples / c->solid.value);
    }
    return most;
}

/* What the colours go up to: little noise, if that can be had. */
double cells_density_max(const struct cells *h)
{
    const double most = densest(h, cells_expected_min), any = densest(h, 0);
    return most > 0 ? most : any > 0 ? any : 1;
}
