/* histogram.c - what is sampled against what the pdf says is sampled
 *
 * Three panels over a window that pilot directions choose: the density of the
 * samples, that of the pdf, and (O - E) / sqrt(E) of the counts O observed and
 * E expected in each cell.  E is an integral over the cell, from quadrature on
 * a mesh that pilots grade, so that a lobe much narrower than a cell is seen.
 * The samples are the ones that bsdf-validate tests with the same seed.
 *
 * A lobe that keeps away from the pole is shown in theta and phi', the azimuth
 * from the mirror direction of wo.  About the pole these tear a lobe apart, so
 * that it is shown in the plane where they are polar coordinates:
 * x = theta cos phi', y = theta sin phi'.  Below the surface theta is taken
 * from the normal's opposite.
 */
#include "plots/kinds.h"

#include <stdlib.h>
#include <string.h>

#include "bsdf/rng.h"
#include "plots/axis.h"
#include "plots/table.h"
#include "validate/quadrature.h"
#include "validate/subject.h"

enum {
    PILOTS = 16384,
    BATCH = 256,
    SIDE_MIN = 12,
    SIDE_MAX = 53,
    LEAF_PILOTS = 8,
    LEAF_DEPTH = 30
};
static const double expected_min = 5, sigma_max = 5;
static const double samples_per_cell = 50; /* at least, on average */

struct point {
    double x, y;
    size_t cell;
};

struct cell {
    uint64_t count;
    struct estimate mass;  /* of the pdf */
    struct estimate solid; /* [sr] that is on this side of the surface */
};

struct histogram {
    const struct bsdf *bsdf;
    struct subject subject; /* for its random numbers; no survey */
    struct vec3 wo, ahead;  /* ahead.z = 0, the azimuth where phi' is 0 */
    double side;            /* 1 above the surface, -1 below */
    bool about_pole;        /* x and y are a plane about it */
    double x0, y0, dx, dy;  /* the window [rad] and its cells */
    size_t n;               /* cells a side */
    struct cell *cell;      /* cell[iy * n + ix] */

    uint64_t samples, refused, deltas, inside;
    uint64_t beyond; /* on the other side of the surface */
};

/* -- directions and the plane ---------------------------------------------- */

static struct point flat(const struct histogram *h, struct vec3 w)
{
    const double along = w.x * h->ahead.x + w.y * h->ahead.y;
    const double across = w.y * h->ahead.x - w.x * h->ahead.y;
    const double theta = atan2(hypot(along, across), h->side * w.z);
    const double phi = atan2(across, along);
    return h->about_pole
               ? (struct point){ theta * cos(phi), theta * sin(phi), 0 }
               : (struct point){ theta, phi, 0 };
}

/* The direction at a point, and the solid angle of a unit square there. */
static struct vec3 direction(const struct histogram *h, double x, double y,
                             double *density)
{
    const double theta = h->about_pole ? hypot(x, y) : x;
    const double s = sin(theta);
    *density = !h->about_pole ? s : theta > 0 ? s / theta : 1;
    const double along = *density * (h->about_pole ? x : cos(y));
    const double across = *density * (h->about_pole ? y : sin(y));
    return (struct vec3){ along * h->ahead.x - across * h->ahead.y,
                          along * h->ahead.y + across * h->ahead.x,
                          h->side * cos(theta) };
}

/* The rectangle of a cell. */
static struct rectangle rectangle_of(const struct histogram *h, size_t cell)
{
    const size_t column = cell % h->n, row = cell / h->n;
    const double x = h->x0 + (double)column * h->dx;
    const double y = h->y0 + (double)row * h->dy;
    return (struct rectangle){ x, x + h->dx, y, y + h->dy };
}

static struct point middle_of(const struct histogram *h, size_t cell)
{
    const struct rectangle r = rectangle_of(h, cell);
    return (struct point){ (r.x0 + r.x1) / 2, (r.y0 + r.y1) / 2, cell };
}

/* The cell, or n * n outside the window. */
static size_t cell_of(const struct histogram *h, struct vec3 w)
{
    if (!(h->side * w.z >= 0))
        return h->n * h->n;
    const struct point p = flat(h, w);
    const double i = floor((p.x - h->x0) / h->dx);
    const double k = floor((p.y - h->y0) / h->dy);
    const double n = (double)h->n;
    return i >= 0 && i < n && k >= 0 && k < n ? (size_t)k * h->n + (size_t)i
                                              : h->n * h->n;
}

/* -- samples --------------------------------------------------------------- */

static void count(struct histogram *h)
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

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

struct range {
    double from, to;
};

static double width(struct range r)
{
    return r.to - r.from;
}

/* Where 96 % of the pilots are, in x or in y, and a margin of 20 % of it. */
static struct range bulk(const struct point *p, size_t n, bool of_y,
                         double *room)
{
    for (size_t i = 0; i < n; i++)
        room[i] = of_y ? p[i].y : p[i].x;
    qsort(room, n, sizeof *room, ascending);
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
static void pole_window(struct range *x, struct range *y)
{
    const double wide = fmax(width(*x), width(*y));
    if (fmin(width(*x), width(*y)) > wide / 6) {
        *x = widened(*x, wide);
        *y = widened(*y, wide);
    }
    *x = within(*x, PI / 2);
    *y = within(*y, PI / 2);
    /* Nearly the whole side is better shown whole. */
    if (fmin(width(*x), width(*y)) > 0.8 * PI)
        *x = *y = (struct range){ -PI / 2, PI / 2 };
}

static void flatten(const struct histogram *h, const struct vec3 *w, size_t n,
                    struct point *p)
{
    for (size_t i = 0; i < n; i++)
        p[i] = flat(h, w[i]);
}

/* Chooses the plane, and the window in it; n > 0. */
static void window(struct histogram *h, const struct vec3 *w, size_t n,
                   struct point *p, double *room)
{
    flatten(h, w, n, p);
    struct range x = bulk(p, n, false, room), y = bulk(p, n, true, room);
    h->about_pole = width(y) > PI / 2;
    if (h->about_pole) {
        flatten(h, w, n, p);
        x = bulk(p, n, false, room);
        y = bulk(p, n, true, room);
        pole_window(&x, &y);
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
    const struct histogram *h = context;
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
            value[at] *= area[at];
        }
    }
}

/* Moves the points below the middle to the front; returns how many. */
static size_t split(struct point *p, size_t n, bool of_y, double middle)
{
    size_t low = 0;
    for (size_t i = 0; i < n; i++)
        if ((of_y ? p[i].y : p[i].x) < middle) {
            const struct point swap = p[low];
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
static bool quarter(struct parts *parts, struct rectangle r, struct point *p,
                    size_t n, int depth)
{
    if (n <= LEAF_PILOTS || depth == LEAF_DEPTH)
        return parts_add(parts, r);
    const double x = (r.x0 + r.x1) / 2, y = (r.y0 + r.y1) / 2;
    const size_t left = split(p, n, false, x);
    for (int right = 0; right < 2; right++) {
        struct point *q = right ? p + left : p;
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

static void integrate(const struct histogram *h, struct rectangle r,
                      struct point *p, size_t n, double tolerance, long *budget,
                      struct estimate *out)
{
    struct parts parts = { .out = out };
    if (!quarter(&parts, r, p, n, 0) ||
        !quadrature(on_cell, h, 2, parts.job, parts.n, tolerance, budget))
        out[0] = out[1] = (struct estimate){ NAN, NAN };
    free(parts.job);
}

static int by_cell(const void *a, const void *b)
{
    const size_t x = ((const struct point *)a)->cell;
    const size_t y = ((const struct point *)b)->cell;
    return (x > y) - (x < y);
}

/* A cell may be off by some hundredths of a sample; its budget bounds the time
 * that a pdf with many edges takes. */
static void masses(struct histogram *h, const struct vec3 *w, struct point *p,
                   size_t n)
{
    const size_t cells = h->n * h->n;
    const double tolerance = fmax(0.01 / (double)h->samples, 1e-11);
    for (size_t i = 0; i < n; i++) {
        p[i] = flat(h, w[i]);
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
static size_t pilots(struct histogram *h, struct vec3 *w)
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

static bool nothing_to_draw(const struct histogram *h, struct err *err)
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

static bool histogram_make(struct histogram *h, struct err *err)
{
    struct vec3 *w = malloc(PILOTS * sizeof *w);
    struct point *p = malloc(PILOTS * sizeof *p);
    double *room = malloc(PILOTS * sizeof *room);
    bool ok = false;
    h->n = cells_a_side(h->samples);
    h->cell = calloc(h->n * h->n, sizeof *h->cell);
    if (!w || !p || !room || !h->cell) {
        err_set(err, "out of memory");
        goto done;
    }
    const size_t n = pilots(h, w);
    ok = n > 0 || nothing_to_draw(h, err);
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

static double expected(const struct histogram *h, const struct cell *c)
{
    return c->mass.value * (double)h->samples;
}

/* NaN where too little is expected. */
static double residual(const struct histogram *h, const struct cell *c)
{
    const double e = expected(h, c);
    return e >= expected_min ? ((double)c->count - e) / sqrt(e) : NAN;
}

/* A density is not drawn where less than a tenth of the cell is on this side
 * of the surface. */
static bool sliver(const struct histogram *h, size_t i)
{
    const struct point p = middle_of(h, i);
    double density;
    direction(h, p.x, p.y, &density);
    return !(h->cell[i].solid.value > 0.1 * density * h->dx * h->dy);
}

/* The largest density of the cells that have, or expect, so many samples. */
static double densest(const struct histogram *h, double at_least)
{
    double most = 0;
    for (size_t i = 0; i < h->n * h->n; i++) {
        const struct cell *c = &h->cell[i];
        const double larger = fmax(expected(h, c), (double)c->count);
        if (!sliver(h, i) && larger >= at_least && isfinite(larger))
            most = fmax(most, larger / (double)h->samples / c->solid.value);
    }
    return most;
}

/* What the colours go up to: little noise, if that can be had. */
static double density_max(const struct histogram *h)
{
    const double most = densest(h, expected_min), any = densest(h, 0);
    return most > 0 ? most : any > 0 ? any : 1;
}

/* -- the table ------------------------------------------------------------- */

static void table_write(FILE *out, const struct histogram *h)
{
    const double deg = 180 / PI, samples = (double)h->samples;
    const char *from = h->side > 0 ? "normal" : "normal's opposite";
    table_head(out, h->bsdf, h->wo);
    fprintf(out,
            "# samples: %llu, of which %llu are refused and %llu in single "
            "directions\n"
            "# seed: %llu\n"
            "# theta: from the %s; phi': azimuth from %s\n"
            "# %s [deg]\t%s [deg]\tsolid angle [sr]\tobserved [1]\texpected "
            "[1]\terror of expected [1]\tdensity observed [1/sr]\tdensity "
            "expected [1/sr]\tresidual [sigma], nan if less than %g are "
            "expected\n",
            (unsigned long long)h->samples, (unsigned long long)h->refused,
            (unsigned long long)h->deltas,
            (unsigned long long)h->subject.plan->seed, from,
            hypot(h->wo.x, h->wo.y) > 0 ? "the mirror direction of wo" : "x",
            h->about_pole ? "theta cos phi'" : "theta",
            h->about_pole ? "theta sin phi'" : "phi'", expected_min);
    for (size_t i = 0; i < h->n * h->n; i++) {
        const struct cell *c = &h->cell[i];
        const struct point p = middle_of(h, i);
        const bool blank = sliver(h, i);
        const double o = (double)c->count, solid = c->solid.value;
        const double row[] = {
            p.x * deg,
            p.y * deg,
            solid,
            o,
            expected(h, c),
            c->mass.error * samples,
            blank ? NAN : o / samples / solid,
            blank ? NAN : c->mass.value / solid,
            residual(h, c),
        };
        table_row(out, row, sizeof row / sizeof *row);
    }
}

/* -- the picture ----------------------------------------------------------- */

/* In pixels, from the left and from below. */
enum {
    PAGE = 800,
    PANEL = 212, /* four for each of SIDE_MAX cells */
    LEFT = 72,
    STEP = 241, /* from one panel to the next */
    NOTES = 70,
    BAR = 114,    /* the lower edge of the colour bars */
    BOTTOM = 180, /* that of the panels */
    ABOVE = 24
};

/* How one of the two axes is marked. */
struct axis {
    double from, to, step; /* in units of 10^exponent deg */
    int exponent;
    char unit[32];
};

/* Small numbers get an exponent; not an angle like 44.95 though. */
static struct axis axis_of(double from, double width, bool about_zero)
{
    const double deg = 180 / PI, to = from + width;
    const double largest = fmax(fabs(from), fabs(to)) * deg;
    struct axis a = { .exponent = about_zero && largest < 0.1
                                      ? axis_exponent(largest)
                                      : 0 };
    const double unit = pow(10, a.exponent) / deg;
    a.from = from / unit;
    a.to = to / unit;
    a.step = axis_step_deg(a.to - a.from);
    axis_unit(a.unit, sizeof a.unit, a.exponent, "deg");
    return a;
}

struct axes {
    struct axis x, y;
};

static struct axes axes_of(const struct histogram *h)
{
    const double n = (double)h->n;
    return (struct axes){ axis_of(h->x0, n * h->dx, h->about_pole),
                          axis_of(h->y0, n * h->dy, true) };
}

/* Cells without a value show the ground. */
static void ground(FILE *out, const struct histogram *h, const struct axes *a)
{
    static const char look[] =
        "behind fillcolor rgb \"#d9d9d9\" fillstyle solid 1 noborder";
    if (h->about_pole)
        fprintf(
            out, "set object ellipse center 0,0 size %.10g,%.10g units xy %s\n",
            180 / pow(10, a->x.exponent), 180 / pow(10, a->y.exponent), look);
    else
        fprintf(out, "set object rectangle from graph 0,0 to graph 1,1 %s\n",
                look);
}

/* Circles of 30 and 60 degrees and the horizon; to go on with. */
static void rings(FILE *out, const struct axes *a, const char *colour)
{
    for (int theta_deg = 30; theta_deg <= 90; theta_deg += 30)
        fprintf(out,
                ", \\\n     %.10g*cos(t),%.10g*sin(t) with lines lc rgb \"%s\" "
                "lw %g notitle",
                theta_deg / pow(10, a->x.exponent),
                theta_deg / pow(10, a->y.exponent),
                theta_deg < 90 ? colour : "#404040", theta_deg < 90 ? 0.5 : 1.);
}

/* A cross where the mirror direction is, if in sight. */
static void cross(FILE *out, const struct histogram *h, const struct axes *a,
                  const char *colour)
{
    const struct vec3 mirror = { -h->wo.x, -h->wo.y, h->side * fabs(h->wo.z) };
    const struct point p = flat(h, mirror);
    const double deg = 180 / PI;
    fprintf(out,
            "set label \"\" at %.12g,%.12g point pt 1 ps 0.9 lc rgb \"%s\" lw "
            "1.2 front\n",
            p.x * deg / pow(10, a->x.exponent),
            p.y * deg / pow(10, a->y.exponent), colour);
}

static void colour_bar(struct figure *fig, double from, double to,
                       const char *title)
{
    fprintf(fig->script,
            "set colorbox horizontal user origin screen %.6g,%.6g size screen "
            "%.6g,%.6g border\n",
            from / fig->width, BAR / fig->height, (to - from) / fig->width,
            11 / fig->height);
    figure_label(fig, (from + to) / 2, BAR - 36, "center", title);
}

/* Draws a column of the table, in units of 10^exponent. */
static void panel(struct figure *fig, const struct histogram *h, int place,
                  const char *title, int column, int exponent)
{
    FILE *out = fig->script;
    const struct axes a = axes_of(h);
    const double x = LEFT + place * STEP;
    fprintf(out, "\n# %s\n", title);
    figure_panel(fig, x, x + PANEL, BOTTOM, BOTTOM + PANEL);
    fprintf(out, "set label \"%s\" at graph 0.5,1.055 center\n", title);
    fprintf(out, "set label \"%s [%s]\" at graph 0.5,-0.19 center\n",
            h->about_pole ? "θ cos φ′" : "θ", a.x.unit);
    ground(out, h, &a);
    cross(out, h, &a, place == 2 ? "#000000" : "#ffffff");
    fprintf(out,
            "plot table using ($1/1e%d):($2/1e%d):($%d/1e%d) with %s notitle",
            a.x.exponent, a.y.exponent, column, exponent, fig->cells);
    if (h->about_pole)
        rings(out, &a, place == 2 ? "#808080" : "#c0c0c0");
    fputs("\nunset object; unset label; unset ylabel; set format y \"\"\n",
          out);
}

static void notes(struct figure *fig, const struct histogram *h)
{
    char text[300];
    double blank = 0, within_window = 0;
    uint64_t held = 0;
    for (size_t i = 0; i < h->n * h->n; i++) {
        within_window += h->cell[i].mass.value;
        if (isnan(residual(h, &h->cell[i]))) {
            blank += expected(h, &h->cell[i]);
            held += h->cell[i].count;
        }
    }
    const double percent = 100 / (double)h->samples;
    snprintf(text, sizeof text,
             "θ: angle of ωᵢ to the %s; φ′: its azimuth%s; cross: mirror "
             "direction of ωₒ",
             h->side > 0 ? "normal" : "normal's opposite",
             hypot(h->wo.x, h->wo.y) > 0 ? " from that of the mirror direction"
                                         : "");
    figure_label(fig, PAGE / 2., NOTES - 14, "center", text);
    const struct {
        const char *what;
        uint64_t count;
    } others[] = { { "on the other side of the surface", h->beyond },
                   { "in single directions", h->deltas },
                   { "refused", h->refused } };
    int n = snprintf(text, sizeof text,
                     "In the window: %.4g%% of the samples, %.4g%% expected",
                     percent * (double)h->inside, 100 * within_window);
    for (int i = 0; i < 3; i++)
        if (others[i].count > 0)
            n += snprintf(text + n, sizeof text - (size_t)n, "; %s: %.3g%%",
                          others[i].what, percent * (double)others[i].count);
    figure_label(fig, PAGE / 2., NOTES - 31, "center", text);
    snprintf(
        text, sizeof text,
        "O observed, E expected in a cell; residual left blank where E < %g: "
        "there O = %llu, E = %.5g in all",
        expected_min, (unsigned long long)held, blank);
    figure_label(fig, PAGE / 2., NOTES - 48, "center", text);
}

static void script_write(struct figure *fig, const struct histogram *h)
{
    static const char viridis[] =
        "set palette defined (0 \"#440154\", 1 \"#482878\", 2 \"#3e4a89\", 3 "
        "\"#31688e\", 4 \"#26828e\", 5 \"#1f9e89\", 6 \"#35b779\", 7 "
        "\"#6dcd59\", 8 \"#b4de2c\", 9 \"#fde725\")\n";
    static const char diverging[] =
        "set palette defined (-5 \"#053061\", -3.5 \"#2166ac\", -2 "
        "\"#67a9cf\", -1 \"#d1e5f0\", 0 \"#f7f7f7\", 1 \"#fddbc7\", 2 "
        "\"#ef8a62\", 3.5 \"#b2182b\", 5 \"#67001f\")\n";
    FILE *out = fig->script;
    const double most = density_max(h);
    const int exponent = axis_exponent(most);
    const struct angles wo = dir_to_degrees(h->wo);
    const struct axes a = axes_of(h);
    char below[256], bands[96], unit[32], text[64];
    bands_print(bsdf_bands(h->bsdf), bands, sizeof bands);
    snprintf(below, sizeof below,
             "ωₒ: θ = %.6g°, φ = %.6g°;  %s;  %llu samples, seed %llu",
             wo.theta_deg, wo.phi_deg, bands, (unsigned long long)h->samples,
             (unsigned long long)h->subject.plan->seed);
    figure_page(fig, PAGE, BOTTOM + PANEL + ABOVE, bsdf_spec(h->bsdf), below);
    notes(fig, h);
    fprintf(out,
            "set xrange [%.12g:%.12g]; set yrange [%.12g:%.12g]\n"
            "set ylabel \"%s [%s]\"\n"
            "set xtics out nomirror scale 0.6 %.10g format \"%%.10g\"\n"
            "set ytics out nomirror scale 0.6 %.10g; set border lc rgb "
            "\"#505050\"\n",
            a.x.from, a.x.to, a.y.from, a.y.to,
            h->about_pole ? "θ sin φ′" : "φ′", a.y.unit, a.x.step, a.y.step);
    if (h->about_pole)
        fputs("set parametric; set trange [0:360]; set samples 361\n", out);
    fprintf(out, "set cbrange [0:%.10g]\n%s", most / pow(10, exponent),
            viridis);
    axis_unit(unit, sizeof unit, exponent, "1/sr");
    snprintf(text, sizeof text, "density [%s]", unit);
    colour_bar(fig, LEFT, LEFT + STEP + PANEL, text);
    panel(fig, h, 0, "samples", 7, exponent);
    fputs("unset colorbox\n", out);
    panel(fig, h, 1, "pdf, integrated over each cell", 8, exponent);
    fprintf(out, "\nset cbrange [-%g:%g]; set cbtics 1\n%s", sigma_max,
            sigma_max, diverging);
    colour_bar(fig, LEFT + 2 * STEP, LEFT + 2 * STEP + PANEL,
               "(O − E) / √E [σ]");
    panel(fig, h, 2, "residual", 9, 0);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    const double across = hypot(r->wo.x, r->wo.y);
    const struct plan plan = { .seed = r->seed, .samples = r->samples };
    struct histogram h = {
        .bsdf = r->bsdf,
        .subject = subject_plain(r->bsdf, r->wo, &plan),
        .wo = r->wo,
        .ahead = across > 0
                     ? (struct vec3){ -r->wo.x / across, -r->wo.y / across, 0 }
                     : (struct vec3){ 1, 0, 0 },
        .side = 1,
        .samples = r->samples,
    };
    bool ok = histogram_make(&h, err) && figure_open(&fig, r->output, err);
    if (ok) {
        table_write(fig.table, &h);
        script_write(&fig, &h);
        ok = figure_draw(&fig, made, err);
    }
    free(h.cell);
    return ok;
}

const struct plot plot_histogram = {
    .name = "histogram",
    .about = "samples against the integrated pdf, and the residual",
    .run = run,
};
