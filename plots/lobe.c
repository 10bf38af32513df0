/* lobe.c - the BSDF in the plane of incidence, in polar angles
 *
 *   f and f |cos theta_i| against theta_i, the angle of wi to the normal:
 *   negative on the side of wo, positive on the side of its mirror direction.
 *
 * The angles are not a regular grid, where a lobe of 1e-3 rad would fall
 * between two of them.  They start from one, from angles ever closer to wo, the
 * mirror direction and the horizon, and from drawn directions; intervals are
 * then halved until a line between neighbours is as good as the curve.
 */
#include "plots/kinds.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plots/axis.h"
#include "plots/key.h"
#include "plots/pilots.h"
#include "plots/table.h"

enum { POINTS_MAX = 60000, DRAWS_APART = 16, CLOSER = 30 };

/* What a line may be off in the middle of an interval, and how far neighbours
 * may be apart; both of the largest value. */
static const double bend_max = 5e-4, step_max = 0.02;
static const double interval_min_deg = 1e-11;

struct point {
    double theta_deg;
    double f[2 * BANDS_MAX]; /* of the bands, then times |cos| */
    bool settled;            /* the line to the next point is good enough */
};

struct lobe {
    const struct bsdf *bsdf;
    struct vec3 wo,
        plane; /* unit vectors; plane.z = 0, toward positive theta */
    double wo_deg, mirror_deg; /* signed as theta_i is */
    double limit_deg;          /* of theta_i: 90, or 180 with the back */
    int bands;

    struct point *point;
    size_t points;
    double most[2 * BANDS_MAX]; /* largest values */
    size_t odd; /* angles where a value is not a finite number */
    bool same;  /* all bands are, everywhere */

    struct pilots pilots;
};

static struct vec3 direction(const struct lobe *l, double theta_deg)
{
    const struct vec3 w = dir_from_degrees(theta_deg, 0);
    return (struct vec3){ w.x * l->plane.x, w.x * l->plane.y, w.z };
}

static double angle(const struct lobe *l, struct vec3 w)
{
    return atan2(vec3_dot(w, l->plane), w.z) * (180 / PI);
}

static struct point at(struct lobe *l, double theta_deg)
{
    struct point p = { .theta_deg = theta_deg };
    const struct vec3 wi = direction(l, theta_deg);
    const struct spectrum f = bsdf_eval(l->bsdf, l->wo, wi);
    bool odd = false;
    for (int b = 0; b < l->bands; b++) {
        p.f[b] = f.band[b];
        p.f[l->bands + b] = f.band[b] * fabs(wi.z);
        odd |= !isfinite(f.band[b]);
    }
    for (int c = 0; c < 2 * l->bands; c++)
        if (isfinite(p.f[c]))
            l->most[c] = fmax(l->most[c], p.f[c]);
    l->odd += odd;
    return p;
}

static double most(const struct lobe *l, bool cosine)
{
    double value = 0;
    for (int b = 0; b < l->bands; b++)
        value = fmax(value, l->most[cosine * l->bands + b]);
    return value;
}

/* Whether the line from a to b misses the curve at m, in their middle. */
static bool bent(const struct lobe *l, const struct point *a,
                 const struct point *m, const struct point *b)
{
    for (int c = 0; c < 2 * l->bands; c++) {
        const double scale = most(l, c >= l->bands);
        if (fabs(m->f[c] - (a->f[c] + b->f[c]) / 2) > bend_max * scale ||
            fabs(a->f[c] - b->f[c]) > step_max * scale)
            return true;
    }
    return false;
}

/* Halves every interval that is not settled; false when all are.  The middle
 * stays in any case, as it may be the largest value. */
static bool refine(struct lobe *l, struct point *next)
{
    size_t n = 0;
    bool more = false;
    for (size_t i = 0; i < l->points; i++) {
        struct point *a = &next[n++];
        *a = l->point[i];
        if (i + 1 == l->points || a->settled)
            continue;
        const struct point *b = &l->point[i + 1];
        const double width = b->theta_deg - a->theta_deg;
        a->settled =
            !(width > interval_min_deg) || n + (l->points - i) >= POINTS_MAX;
        if (a->settled)
            continue;
        struct point m = at(l, a->theta_deg + width / 2);
        a->settled = m.settled = !bent(l, a, &m, b);
        more |= !a->settled;
        next[n++] = m;
    }
    memcpy(l->point, next, n * sizeof *next);
    l->points = n;
    return more;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Angles ever closer to one; returns how many. */
static size_t closer(double *theta, double to)
{
    size_t n = 0;
    theta[n++] = to;
    for (int k = 1; k <= CLOSER; k++) {
        theta[n++] = to - ldexp(90, -k);
        theta[n++] = to + ldexp(90, -k);
    }
    return n;
}

/* Angles of some of the pilots; returns how many. */
static size_t drawn(const struct lobe *l, double *theta)
{
    size_t kept = 0;
    for (size_t i = 0; i < l->pilots.n; i++)
        theta[i] = angle(l, l->pilots.wi[i]);
    qsort(theta, l->pilots.n, sizeof *theta, ascending);
    for (size_t i = 0; i < l->pilots.n; i += DRAWS_APART)
        theta[kept++] = theta[i];
    return kept;
}

/* Whether no band is unlike the first. */
static bool all_same(const struct lobe *l)
{
    for (size_t i = 0; i < l->points; i++)
        for (int b = 1; b < l->bands; b++)
            if (l->point[i].f[b] != l->point[i].f[0])
                return false;
    return true;
}

static bool trace(struct lobe *l, struct err *err)
{
    enum { GRID = 360, ANGLES = GRID + 1 + PILOTS_MAX + 4 * (2 * CLOSER + 1) };
    double *theta = malloc(ANGLES * sizeof *theta);
    struct point *next = malloc(POINTS_MAX * sizeof *next);
    l->point = malloc(POINTS_MAX * sizeof *l->point);
    size_t n = 0;
    bool ok = false;
    if (!theta || !next || !l->point) {
        err_set(err, "out of memory");
        goto done;
    }
    for (int i = 0; i <= GRID; i++)
        theta[n++] = l->limit_deg * (2. * i / GRID - 1);
    n += closer(theta + n, l->wo_deg);
    n += closer(theta + n, l->mirror_deg);
    n += closer(theta + n, 90);
    n += closer(theta + n, -90);
    n += drawn(l, theta + n);
    qsort(theta, n, sizeof *theta, ascending);
    for (size_t i = 0; i < n; i++)
        if (fabs(theta[i]) <= l->limit_deg &&
            (i == 0 || theta[i] > theta[i - 1]))
            l->point[l->points++] = at(l, theta[i]);
    while (refine(l, next))
        ;
    l->same = all_same(l);
    ok = true;
done:
    free(theta);
    free(next);
    return ok;
}

/* -- the table ------------------------------------------------------------- */

static void table_write(FILE *out, const struct lobe *l)
{
    const struct bands *bands = bsdf_bands(l->bsdf);
    const size_t n = (size_t)l->bands;
    table_head(out, l->bsdf, l->wo);
    fprintf(out,
            "# theta_i: of wi to the normal, in the plane of incidence; %s\n"
            "# theta_i [deg]",
            l->wo_deg == 0 ? "> 0 toward phi = 0"
                           : "< 0 on the side of wo, > 0 on that of its mirror "
                             "direction");
    table_columns(out, bands, "f [1/sr]");
    table_columns(out, bands, "f |cos theta_i| [1/sr]");
    fputc('\n', out);
    for (size_t i = 0; i < l->points; i++) {
        double row[1 + 2 * BANDS_MAX] = { l->point[i].theta_deg };
        memcpy(row + 1, l->point[i].f, 2 * n * sizeof *row);
        table_row(out, row, 1 + 2 * n);
    }
    if (l->pilots.deltas == 0)
        return;
    fputs("\n\n# single directions\n# theta_i [deg]\tprobability [1]", out);
    table_columns(out, bands, "weight [1]");
    fputc('\n', out);
    for (int k = 0; k < l->pilots.deltas; k++) {
        const struct delta *d = &l->pilots.delta[k];
        double row[2 + BANDS_MAX] = { angle(l, d->wi), d->pdf };
        memcpy(row + 2, d->weight.band, n * sizeof *row);
        table_row(out, row, 2 + n);
    }
}

/* -- the picture ----------------------------------------------------------- */

/* In pixels. */
enum {
    PAGE = 800,
    RADIUS = 146,
    SIDE = 196,  /* from the middle of a disk to either side of its panel */
    ABOVE = 215, /* upward, with the title */
    BELOW = 34,  /* downward from a half disk */
    BACK = 196,  /* downward from a whole one */
    ZOOM = 190,  /* a close-up with its axes */
    KEY = 30,
    LINE = 17
};

/* Vermillion, bluish green, blue and reddish purple of M. Okabe and K. Ito,
 * Color Universal Design, 2008; from long waves to short ones. */
static const char *const hue[] = { "#D55E00", "#009E73", "#0072B2", "#CC79A7" };
static const double hue_from_nm[] = { 580, 490, 430, 0 };

static int hue_of(double nm)
{
    int h = 0;
    while (nm < hue_from_nm[h])
        h++;
    return h;
}

/* By the wavelength, or by rank where two bands would look the same. */
static const char *colour_of(const struct bands *bands, int band)
{
    if (bands->kind != BANDS_NM)
        return hue[band];
    bool clash = false;
    int rank = 0;
    for (int b = 0; b < bands->count; b++) {
        for (int k = 0; k < b; k++)
            clash |= hue_of(bands->nm[b]) == hue_of(bands->nm[k]);
        rank += bands->nm[b] > bands->nm[band] ||
                (bands->nm[b] == bands->nm[band] && b < band);
    }
    return hue[clash ? rank : hue_of(bands->nm[band])];
}

/* One of the two quantities, and how its axis is marked. */
struct scale {
    bool cosine;
    const char *what;
    double step, unit; /* [1/sr] between marks, and that they are written in */
    int steps;
    char unit_text[32];
};

static struct scale scale_of(const struct lobe *l, bool cosine)
{
    const double largest = most(l, cosine);
    struct scale s = { .cosine = cosine,
                       .what = cosine ? "f |cos θᵢ|" : "f",
                       .step = 1,
                       .unit = 1,
                       .steps = 1 };
    if (!(largest > 0))
        return s;
    s.step = axis_step(largest, 5);
    s.steps = (int)ceil(largest / s.step * (1 - 1e-12));
    const int exponent = axis_exponent(s.steps * s.step);
    s.unit = pow(10, exponent);
    axis_unit(s.unit_text, sizeof s.unit_text, exponent, "1/sr");
    return s;
}

struct look {
    char text[64];
};

static struct look band_look(const struct lobe *l, int b)
{
    static const char *const dash[] = { "1", "(12,7)", "(3,4)", "(12,4,3,4)" };
    static const double width[] = { 2.2, 2, 2.2, 1.6 };
    struct look look = { "lc rgb \"#303030\" lw 2.2" };
    if (!l->same)
        snprintf(look.text, sizeof look.text, "lc rgb \"%s\" dt %s lw %g",
                 colour_of(bsdf_bands(l->bsdf), b), dash[b], width[b]);
    return look;
}

static int curves_of(const struct lobe *l)
{
    return l->same ? 1 : l->bands;
}

/* A curve a band, in units of one [1/sr], for a plot command to go on with. */
static void curves(FILE *out, const struct lobe *l, bool cosine, bool polar,
                   double one)
{
    for (int b = 0; b < curves_of(l); b++) {
        const int column = 2 + cosine * l->bands + b;
        fprintf(out, "%s     table index 0 using ", b ? ", \\\n" : "");
        if (polar)
            fprintf(out, "($%d/%.10g*sin($1)):($%d/%.10g*cos($1))", column, one,
                    column, one);
        else
            fprintf(out, "1:($%d/%.10g)", column, one);
        fprintf(out, " with lines %s", band_look(l, b).text);
    }
}

/* Spokes and their labels; rings, for a plot command to go on with.  A circle
 * is a curve because the terminal for SVG loses the colour of an object. */
static void polar_grid(FILE *out, bool half)
{
    fprintf(out,
            "do for [a=%d:%d:15] {\n"
            "    set arrow from 0,0 to sin(a),cos(a) nohead back lc rgb "
            "\"#b8b8b8\" lw (a %% 30 ? 0.3 : 0.6)\n"
            "}\n",
            half ? -90 : -165, half ? 90 : 180);
    fprintf(
        out,
        "do for [a=%d:%d:30] {\n"
        "    s = sin(a)\n"
        "    if (abs(s) < 0.1) {\n"
        "        set label sprintf(\"%%d°\", a) at 0,1.19*cos(a) center tc "
        "rgb \"#505050\"\n"
        "    } else { if (s < 0) {\n"
        "        set label sprintf(\"%%d°\", a) at 1.14*s,1.15*cos(a) right "
        "tc rgb \"#505050\"\n"
        "    } else {\n"
        "        set label sprintf(\"%%d°\", a) at 1.14*s,1.15*cos(a) left "
        "tc rgb \"#505050\"\n"
        "    }}\n"
        "}\n",
        half ? -90 : -150, half ? 90 : 180);
}

static void rings(FILE *out, bool half, int n)
{
    fprintf(out,
            "set parametric; set trange [%d:%d]; set samples 361\n"
            "plot for [i=1:%d] i/%d.*sin(t),i/%d.*cos(t) with lines lc rgb "
            "\"#b8b8b8\" lw 0.5, \\\n",
            half ? -90 : -180, half ? 90 : 180, n, n, n);
}

/* Short lines outside the rim, each drawn from the first row of the table,
 * which is as good as any; and arrows for the single directions. */
static void marks(FILE *out, const struct lobe *l)
{
    static const char at_rim[] =
        "     table index 0 every ::0::0 using (1.012*sin(%.10g)):"
        "(1.012*cos(%.10g)):(0.075*sin(%.10g)):(0.075*cos(%.10g)) with vectors "
        "%s";
    const double m = l->mirror_deg, w = l->wo_deg;
    fprintf(out, at_rim, m, m, m, m, key_mirror);
    fputs(", \\\n", out);
    fprintf(out, at_rim, w, w, w, w, key_wo);
    if (l->pilots.deltas > 0)
        fprintf(out,
                ", \\\n     table index 1 using (0):(0):(sin($1)):(cos($1)) "
                "with vectors %s",
                key_delta);
    fputc('\n', out);
}

/* A half or a whole disk about (x, y) on the page. */
static void disk(struct figure *fig, const struct lobe *l,
                 const struct scale *s, double x, double y)
{
    FILE *out = fig->script;
    const bool half = l->limit_deg == 90;
    const double side = (double)SIDE / RADIUS, up = (double)ABOVE / RADIUS;
    const double down = (double)(half ? BELOW : BACK) / RADIUS;
    fprintf(out, "\n# %s\n", s->cosine ? "f |cos|" : "f");
    figure_panel(fig, x - SIDE, x + SIDE, y - down * RADIUS, y + ABOVE);
    fprintf(out, "set xrange [%.6g:%.6g]; set yrange [%.6g:%.6g]\n", -side,
            side, -down, up);
    polar_grid(out, half);
    if (most(l, s->cosine) > 0)
        fprintf(out,
                "set label \"%s [%s]\" at 0,1.38 center\n"
                "do for [i=%d:%d] {\n"
                "    set label sprintf(\"%%g\", i*%.10g) at %si/%d.,-0.09 "
                "center tc rgb \"#505050\"\n"
                "}\n",
                s->what, s->unit_text, half ? 0 : 1, s->steps,
                s->step / s->unit, half ? "" : "-", s->steps);
    if (!half) /* the surface, and the numbers where lobes are rare */
        fputs("set arrow from -1,0 to 1,0 nohead back lc rgb \"#707070\" lw "
              "1.2\n",
              out);
    rings(out, half, s->steps);
    if (most(l, s->cosine) > 0) {
        curves(out, l, s->cosine, true, s->step * s->steps);
        fputs(", \\\n", out);
    }
    marks(out, l);
    fputs("unset parametric; unset arrow; unset label\n", out);
}

/* -- close-ups ------------------------------------------------------------- */

struct window {
    double from, to, half_width; /* [deg] */
};

/* From the largest value outward, as far as it stays above a limit. */
static void around(const struct lobe *l, int channel, size_t best, double above,
                   size_t *low, size_t *high)
{
    *low = *high = best;
    while (*low > 0 && l->point[*low].f[channel] > above)
        --*low;
    while (*high + 1 < l->points && l->point[*high].f[channel] > above)
        ++*high;
}

static struct window window_of(const struct lobe *l, bool cosine)
{
    const double largest = most(l, cosine);
    size_t best = 0, low, high;
    int channel = 0;
    for (int b = 0; b < l->bands; b++)
        for (size_t i = 0; i < l->points; i++)
            if (l->point[i].f[cosine * l->bands + b] == largest) {
                best = i;
                channel = cosine * l->bands + b;
            }
    around(l, channel, best, largest / 2, &low, &high);
    const double half_width =
        l->point[high].theta_deg - l->point[low].theta_deg;
    around(l, channel, best, largest / 50, &low, &high);
    const double top = l->point[best].theta_deg, reach = 4 * half_width;
    const double from = fmax(l->point[low].theta_deg, top - reach);
    const double to = fmin(l->point[high].theta_deg, top + reach);
    const double margin = 0.1 * (to - from);
    if (!(to > from))
        return (struct window){ -l->limit_deg, l->limit_deg, half_width };
    return (struct window){ fmax(from - margin, -l->limit_deg),
                            fmin(to + margin, l->limit_deg), half_width };
}

/* Whether a lobe is so narrow that a disk does not show its shape. */
static bool narrow(const struct lobe *l)
{
    const double widest_deg = 12;
    return most(l, false) > 0 && most(l, true) > 0 &&
           fmin(window_of(l, false).half_width, window_of(l, true).half_width) <
               widest_deg;
}

static void close_up(struct figure *fig, const struct lobe *l,
                     const struct scale *s, double x, double y)
{
    FILE *out = fig->script;
    const struct window w = window_of(l, s->cosine);
    fprintf(out, "\n# %s, close up\n", s->cosine ? "f |cos|" : "f");
    figure_panel(fig, x - 130, x + 155, y + 50, y + ZOOM - 12);
    fprintf(out,
            "set xrange [%.12g:%.12g]; set yrange [0:%.10g]\n"
            "set label \"θᵢ [deg]\" at graph 0.5,-0.3 center\n"
            "set ylabel \"%s [%s]\"\n"
            "set xtics nomirror scale 0.7 %.10g format \"%%.10g\"\n"
            "set ytics nomirror scale 0.7 %.10g\n",
            w.from, w.to, s->step * s->steps / s->unit * 1.04, s->what,
            s->unit_text, axis_step_deg(w.to - w.from), s->step / s->unit);
    if (l->mirror_deg > w.from && l->mirror_deg < w.to)
        fprintf(out,
                "set arrow from first %.10g, graph 0 to first %.10g, graph 1 "
                "nohead back lc rgb \"#d0d0d0\" lw 3\n",
                l->mirror_deg, l->mirror_deg);
    fputs("plot \\\n", out);
    curves(out, l, s->cosine, false, s->unit);
    fputs("\nunset arrow; unset label\n", out);
}

/* -- the page -------------------------------------------------------------- */

static void key(struct figure *fig, const struct lobe *l, double y)
{
    struct key_entry entry[BANDS_MAX + 3] = { { .look = "" } };
    int n = 0;
    for (int b = 0; b < curves_of(l) && most(l, false) > 0; b++, n++) {
        snprintf(entry[n].look, sizeof entry[n].look, "nohead %s",
                 band_look(l, b).text);
        if (l->same && l->bands > 1)
            strcpy(entry[n].text, "all bands");
        else
            bands_print_one(bsdf_bands(l->bsdf), b, entry[n].text,
                            sizeof entry[n].text);
    }
    const char *const others[][2] = { { key_wo, "ωₒ" },
                                      { key_mirror, "mirror direction" },
                                      { key_delta, "δ" } };
    for (int i = 0; i < 2 + (l->pilots.deltas > 0); i++, n++) {
        snprintf(entry[n].look, sizeof entry[n].look, "%s", others[i][0]);
        snprintf(entry[n].text, sizeof entry[n].text, "%s", others[i][1]);
    }
    key_draw(fig, entry, n, y);
}

struct notes {
    char text[DELTAS_MAX + 3][256];
    int lines;
};

static struct notes notes_of(const struct lobe *l)
{
    enum { SIZE = sizeof((struct notes *)0)->text[0] };
    struct notes n = { .lines = 0 };
    snprintf(n.text[n.lines++], SIZE, "θᵢ: angle of ωᵢ to the normal; %s",
             l->wo_deg == 0 ? "positive toward φ = 0"
                            : "negative on the side of ωₒ, positive on the "
                              "side of its mirror direction");
    if (l->limit_deg > 90 && most(l, true) > 0) {
        double side[2] = { 0, 0 };
        for (size_t i = 0; i < l->points; i++)
            for (int b = 0; b < l->bands; b++) {
                const bool below = fabs(l->point[i].theta_deg) > 90;
                side[below] = fmax(side[below], l->point[i].f[l->bands + b]);
            }
        snprintf(n.text[n.lines++], SIZE,
                 "largest f |cos θᵢ|: %.4g/sr above the surface, %.4g/sr below",
                 side[0], side[1]);
    }
    for (int k = 0; k < l->pilots.deltas; k++)
        delta_text(&l->pilots.delta[k], l->bands,
                   angle(l, l->pilots.delta[k].wi), n.text[n.lines++], SIZE);
    if (l->odd > 0)
        snprintf(n.text[n.lines++], SIZE,
                 "f is infinite or not a number at %zu of %zu angles", l->odd,
                 l->points);
    return n;
}

static void script_write(struct figure *fig, const struct lobe *l)
{
    FILE *out = fig->script;
    const struct angles wo = dir_to_degrees(l->wo);
    const bool any = most(l, false) > 0, zoomed = narrow(l);
    const struct notes notes = notes_of(l);
    const double foot = 8 + notes.lines * LINE;
    const double above_key = foot + KEY + (zoomed ? ZOOM : 0);
    const double centre = above_key + (l->limit_deg == 90 ? BELOW : BACK);
    char below[200], bands[96];
    bands_print(bsdf_bands(l->bsdf), bands, sizeof bands);
    snprintf(below, sizeof below, "ωₒ: θ = %.6g°, φ = %.6g°;  %s", wo.theta_deg,
             wo.phi_deg, bands);
    figure_page(fig, PAGE, centre + ABOVE, bsdf_spec(l->bsdf), below);
    for (int i = 0; i < notes.lines; i++)
        figure_label(fig, PAGE / 2., foot - LINE * (i + 0.5), "center",
                     notes.text[i]);
    key(fig, l, above_key - KEY / 2.);
    fputs("unset border; unset tics; unset key\n", out);
    for (int cosine = 0; cosine < 1 + any; cosine++) {
        const struct scale s = scale_of(l, cosine);
        disk(fig, l, &s, any ? PAGE * (cosine ? 0.75 : 0.25) : PAGE / 2.,
             centre);
    }
    if (zoomed)
        fputs("set border 3 lc rgb \"#505050\"\n", out);
    for (int cosine = 0; cosine < 2 * zoomed; cosine++) {
        const struct scale s = scale_of(l, cosine);
        close_up(fig, l, &s, PAGE * (cosine ? 0.75 : 0.25), foot);
    }
}

static bool lobe_init(struct lobe *l, const struct plot_request *r,
                      struct err *err)
{
    const struct bsdf *b = r->bsdf;
    const double across = hypot(r->wo.x, r->wo.y);
    const struct angles wo = dir_to_degrees(r->wo);
    const bool back =
        r->wo.z < 0 || (bsdf_claims(b).lobes & BSDF_TRANSMISSION) != 0;
    *l = (struct lobe){
        .bsdf = b,
        .wo = r->wo,
        .plane = across > 0
                     ? (struct vec3){ -r->wo.x / across, -r->wo.y / across, 0 }
                     : (struct vec3){ 1, 0, 0 },
        .wo_deg = -wo.theta_deg,
        .mirror_deg = wo.theta_deg,
        .limit_deg = back ? 180 : 90,
        .bands = bsdf_bands(b)->count,
    };
    pilots_draw(&l->pilots, b, r->wo, r->seed);
    if (!trace(l, err))
        return false;
    return most(l, false) > 0 || l->pilots.deltas > 0 ||
           err_set(err,
                   "lobe: f is not above 0 anywhere in the plane of incidence "
                   "of theta %.6g, phi %.6g deg; there is nothing to draw",
                   wo.theta_deg, wo.phi_deg);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct lobe *l = calloc(1, sizeof *l);
    if (!l)
        return err_set(err, "out of memory");
    bool ok = lobe_init(l, r, err) && figure_open(&fig, r->output, err);
    if (ok) {
        table_write(fig.table, l);
        script_write(&fig, l);
        ok = figure_draw(&fig, made, err);
    }
    if (l)
        free(l->point);
    free(l);
    return ok;
}

const struct plot plot_lobe = {
    .name = "lobe",
    .about = "f and f |cos| in the plane of incidence, in polar angles",
    .run = run,
};
