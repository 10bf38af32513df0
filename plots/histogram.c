/* histogram.c - what is sampled against what the pdf says is sampled
 *
 * Three panels over a window that pilot directions choose, see cells.h: the
 * density of the samples, that of the pdf, and (O - E) / sqrt(E) of the counts
 * O observed and E expected in each cell.
 */
#include "plots/kinds.h"

#include <stdlib.h>
#include <string.h>

#include "plots/axis.h"
#include "plots/cells.h"
#include "plots/chart.h"
#include "plots/table.h"

static const double sigma_max = 5;

/* The two axes of a chart, in the table and in the picture. */
static const struct {
    const char *x, *y, *x_title, *y_title, *unit;
} charts[] = {
    [CELLS_ANGLES] = { "theta", "phi'", "θ", "φ′", "deg" },
    [CELLS_POLE] = { "theta cos phi'", "theta sin phi'", "θ cos φ′", "θ sin φ′",
                     "deg" },
    [CELLS_DISK] = { "sin theta cos phi'", "sin theta sin phi'", "sin θ cos φ′",
                     "sin θ sin φ′", "1" },
    [CELLS_HALF] = { "sin theta_h cos phi_h'", "sin theta_h sin phi_h'",
                     "sin θ cos φ′", "sin θ sin φ′", "1" },
};

static double unit_of(const struct cells *h)
{
    return h->plane == CELLS_ANGLES || h->plane == CELLS_POLE ? 180 / PI : 1;
}

/* -- the table ------------------------------------------------------------- */

static void table_write(FILE *out, const struct cells *h)
{
    const double unit = unit_of(h), samples = (double)h->samples;
    const char *from = h->side > 0 ? "normal" : "normal's opposite";
    table_head(out, h->bsdf, h->wo);
    fprintf(out,
            "# samples: %llu, of which %llu are refused and %llu in single "
            "directions\n"
            "# seed: %llu\n"
            "# theta: from the %s; phi': azimuth from %s\n"
            "# %s [%s]\t%s [%s]\tsolid angle [sr]\tobserved [1]\texpected "
            "[1]\terror of expected [1]\tdensity observed [1/sr]\tdensity "
            "expected [1/sr]\tresidual [sigma], nan if less than %g are "
            "expected\n",
            (unsigned long long)h->samples, (unsigned long long)h->refused,
            (unsigned long long)h->deltas,
            (unsigned long long)h->subject.plan->seed, from,
            hypot(h->wo.x, h->wo.y) > 0 ? "the mirror direction of wo" : "x",
            charts[h->plane].x, charts[h->plane].unit, charts[h->plane].y,
            charts[h->plane].unit, cells_expected_min);
    for (size_t i = 0; i < h->n * h->n; i++) {
        const struct cell *c = &h->cell[i];
        const struct cell_point p = cells_middle(h, i);
        const bool blank = cells_sliver(h, i);
        const double o = (double)c->count, solid = c->solid.value;
        const double row[] = {
            p.x * unit,
            p.y * unit,
            solid,
            o,
            cells_expected(h, c),
            c->mass.error * samples,
            blank ? NAN : o / samples / solid,
            blank ? NAN : c->mass.value / solid,
            cells_residual(h, c),
        };
        table_row(out, row, sizeof row / sizeof *row);
    }
}

/* -- the picture ----------------------------------------------------------- */

/* In pixels, from the left and from below. */
enum {
    PAGE = FIGURE_PAGE,
    PANEL = 212, /* four for each of the most cells a side */
    LEFT = 72,
    STEP = 241, /* from one panel to the next */
    NOTES = 70,
    BAR = 114,    /* the lower edge of the colour bars */
    BOTTOM = 180, /* that of the panels */
    ABOVE = 24
};

struct axes {
    struct chart_axis x, y;
    double x_one, y_one; /* what 1 rad, or 1, is on them */
};

static struct axes axes_of(const struct cells *h)
{
    const double n = (double)h->n, unit = unit_of(h);
    struct axes a = {
        .x = chart_axis_exact(h->x0 * unit, (h->x0 + n * h->dx) * unit, 0,
                              charts[h->plane].x_title, charts[h->plane].unit),
        .y = chart_axis_exact(h->y0 * unit, (h->y0 + n * h->dy) * unit, 0,
                              charts[h->plane].y_title, charts[h->plane].unit),
    };
    a.x_one = unit / pow(10, a.x.exponent);
    a.y_one = unit / pow(10, a.y.exponent);
    return a;
}

/* The rim of a chart, or 0: that of the angles is their window. */
static double rim(const struct cells *h)
{
    return h->plane == CELLS_ANGLES ? 0 : h->plane == CELLS_POLE ? PI / 2 : 1;
}

/* Cells without a value show the ground. */
static void ground(FILE *out, const struct cells *h, const struct axes *a)
{
    static const char look[] =
        "behind fillcolor rgb \"#d9d9d9\" fillstyle solid 1 noborder";
    if (rim(h) > 0)
        fprintf(out,
                "set object ellipse center 0,0 size %.10g,%.10g units xy %s\n",
                2 * rim(h) * a->x_one, 2 * rim(h) * a->y_one, look);
    else
        fprintf(out, "set object rectangle from graph 0,0 to graph 1,1 %s\n",
                look);
}

/* Circles of 30 and 60 degrees and the rim; to go on with. */
static void rings(FILE *out, const struct cells *h, const struct axes *a,
                  const char *colour)
{
    for (int deg = 30; rim(h) > 0 && deg <= 90; deg += 30) {
        const double r =
            h->plane == CELLS_POLE ? deg * PI / 180 : sin(deg * PI / 180);
        fprintf(out,
                ", \\\n     %.10g*cos(t),%.10g*sin(t) with lines lc rgb "
                "\"%s\" dt 1 lw %g notitle",
                r * a->x_one, r * a->y_one, deg < 90 ? colour : "#404040",
                deg < 90 ? 0.5 : 1.);
    }
}

/* A cross where the mirror direction is, or among half vectors the normal, if
 * in sight. */
static void cross(FILE *out, const struct cells *h, const struct axes *a,
                  const char *colour)
{
    const struct vec3 mirror = { -h->wo.x, -h->wo.y, h->side * fabs(h->wo.z) };
    const struct cell_point p = h->plane == CELLS_HALF
                                    ? (struct cell_point){ 0, 0, 0 }
                                    : cells_point(h, mirror);
    const double x = p.x * a->x_one, y = p.y * a->y_one;
    if (x >= a->x.lo && x <= a->x.hi && y >= a->y.lo && y <= a->y.hi)
        fprintf(out,
                "set label \"\" at %.12g,%.12g point pt 1 ps 0.9 lc rgb \"%s\" "
                "lw 1.2 front\n",
                x, y, colour);
}

/* A panel of a column of the table, and its colour bar over so many places. */
static void panel(struct figure *fig, const struct cells *h, int place,
                  const char *title, struct chart_map map)
{
    FILE *out = fig->script;
    const struct axes a = axes_of(h);
    const double x = LEFT + place * STEP;
    char *also = NULL;
    size_t size;
    FILE *more = open_memstream(&also, &size);
    if (!more)
        return;
    rings(more, h, &a, place == 2 ? "#808080" : "#c0c0c0");
    fclose(more);
    strcpy(map.x, "$1");
    strcpy(map.y, "$2");
    const struct chart c = {
        .x0 = x,
        .x1 = x + PANEL,
        .y0 = BOTTOM,
        .y1 = BOTTOM + PANEL,
        .title = title,
        .x = a.x,
        .y = a.y,
        .bare_y = place > 0,
        .map = &map,
        .also = also,
    };
    ground(out, h, &a);
    cross(out, h, &a, place == 2 ? "#000000" : "#ffffff");
    chart_draw(fig, &c);
    fputs("unset object\n", out);
    free(also);
}

static void notes(struct figure *fig, const struct cells *h)
{
    char text[300];
    double blank = 0, within_window = 0;
    uint64_t held = 0;
    for (size_t i = 0; i < h->n * h->n; i++) {
        within_window += h->cell[i].mass.value;
        if (isnan(cells_residual(h, &h->cell[i]))) {
            blank += cells_expected(h, &h->cell[i]);
            held += h->cell[i].count;
        }
    }
    const double percent = 100 / (double)h->samples;
    snprintf(
        text, sizeof text,
        "θ: angle of %s to the %s; φ′: its azimuth%s; cross: %s",
        h->plane == CELLS_HALF ? "the half vector" : "ωᵢ",
        h->side > 0 || h->plane == CELLS_HALF ? "normal" : "normal's opposite",
        hypot(h->wo.x, h->wo.y) > 0 ? " from that of the mirror direction" : "",
        h->plane == CELLS_HALF ? "normal" : "mirror direction of ωₒ");
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
        cells_expected_min, (unsigned long long)held, blank);
    figure_label(fig, PAGE / 2., NOTES - 48, "center", text);
}

static void script_write(struct figure *fig, const struct cells *h)
{
    const double most = cells_density_max(h);
    const int exponent = axis_exponent(most);
    const struct angles wo = dir_to_degrees(h->wo);
    char below[256], bands[96], unit[32], text[64];
    bands_print(bsdf_bands(h->bsdf), bands, sizeof bands);
    snprintf(below, sizeof below,
             "ωₒ: θ = %.6g°, φ = %.6g°;  %s;  %llu samples, seed %llu",
             wo.theta_deg, wo.phi_deg, bands, (unsigned long long)h->samples,
             (unsigned long long)h->subject.plan->seed);
    figure_page(fig, PAGE, BOTTOM + PANEL + ABOVE, bsdf_spec(h->bsdf), below);
    notes(fig, h);
    if (rim(h) > 0)
        fputs("set parametric; set trange [0:360]; set samples 361\n",
              fig->script);
    struct chart_map density = { .palette = "heat",
                                 .hi = most / pow(10, exponent) };
    const struct chart_map sigma = {
        .palette = "sigma", .z = "$9", .lo = -sigma_max, .hi = sigma_max
    };
    axis_unit(unit, sizeof unit, exponent, "1/sr");
    snprintf(text, sizeof text, "density [%s]", unit);
    chart_bar(fig, LEFT, LEFT + STEP + PANEL, BAR, &density,
              axis_step(density.hi, 10), text);
    snprintf(density.z, sizeof density.z, "$7/1e%d", exponent);
    panel(fig, h, 0, "samples", density);
    snprintf(density.z, sizeof density.z, "$8/1e%d", exponent);
    panel(fig, h, 1, "pdf, integrated over each cell", density);
    chart_bar(fig, LEFT + 2 * STEP, LEFT + 2 * STEP + PANEL, BAR, &sigma, 1,
              "(O − E) / √E [σ]");
    panel(fig, h, 2, "residual", sigma);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct cells h;
    const struct plan plan = { .seed = r->seed, .samples = r->samples };
    const enum cells_plane plane = r->zoom == ZOOM_HALF   ? CELLS_HALF
                                   : r->zoom == ZOOM_DISK ? CELLS_DISK
                                                          : CELLS_ANGLES;
    if (!cells_make(&h, r->bsdf[0], r->wo[0], plane, &plan, err))
        return false;
    bool ok = figure_open(&fig, r->output, &r->look, err);
    if (ok) {
        table_write(fig.table, &h);
        script_write(&fig, &h);
        plot_caption(&fig, &plot_histogram, r, NULL,
                     "Density of samples and of the pdf [1/sr], and the "
                     "residual (O − E) / √E [σ] of the counts O observed and E "
                     "expected in each cell.");
        ok = figure_draw(&fig, made, err);
    }
    cells_clear(&h);
    return ok;
}

const struct plot plot_histogram = {
    .name = "histogram",
    .about = "samples against the integrated pdf, and the residual",
    .heeds = HEEDS_WO | HEEDS_ZOOM | HEEDS_SAMPLES,
    .run = run,
};
