/* slice.c - the BSDF against the angles of half and difference
 *
 *   h = the half vector of wo and wi, at theta_h from the normal
 *   d = wi where h is the pole, at theta_d from it and at azimuth phi_d
 *
 * A map for each band, in logarithms, at one phi_d (--phi, 90 degrees): mirror
 * directions are at the left, retroreflection below, grazing angles at the top
 * right, where one of the two directions is below the surface.  Below the maps
 * their left and lower edges.  h has the azimuth 0.
 *
 * S. Rusinkiewicz, A New Change of Variables for Efficient BRDF Representation,
 * EGWR 1998; B. Burley, Physically Based Shading at Disney, SIGGRAPH 2012.
 */
#include <stdlib.h>
#include <string.h>

#include "plots/chart.h"
#include "plots/colours.h"
#include "plots/kinds.h"
#include "plots/table.h"

enum { CELLS = 90, DECADES = 7 };

struct slice {
    const struct bsdf *bsdf;
    double phi_deg;                  /* phi_d */
    struct spectrum f[CELLS][CELLS]; /* NaN below the surface */
    bool same;
    bool cut; /* some of it is below the surface */
    double most;
};

static double middle(int i)
{
    return (i + 0.5) * 90 / CELLS;
}

/* False where either direction is below the surface. */
static bool directions(double theta_h_deg, double theta_d_deg, double phi_deg,
                       struct vec3 *wo, struct vec3 *wi)
{
    const struct vec3 h = dir_from_degrees(theta_h_deg, 0);
    const struct vec3 d = dir_from_degrees(theta_d_deg, phi_deg);
    *wi = vec3_unit(
        (struct vec3){ h.z * d.x + h.x * d.z, d.y, h.z * d.z - h.x * d.x });
    *wo = vec3_unit(vec3_reflect(*wi, h));
    return wi->z > 0 && wo->z > 0;
}

static struct spectrum value(const struct slice *s, double theta_h_deg,
                             double theta_d_deg)
{
    struct vec3 wo, wi;
    return directions(theta_h_deg, theta_d_deg, s->phi_deg, &wo, &wi)
               ? bsdf_eval(s->bsdf, wo, wi)
               : spectrum_of(BANDS_MAX, NAN);
}

static void fill(struct slice *s)
{
    const int n = bsdf_bands(s->bsdf)->count;
    s->same = true;
    for (int i = 0; i < CELLS; i++)
        for (int k = 0; k < CELLS; k++) {
            const struct spectrum f = value(s, middle(i), middle(k));
            s->f[i][k] = f;
            s->cut |= isnan(f.band[0]);
            for (int b = 0; b < n; b++) {
                if (isfinite(f.band[b]))
                    s->most = fmax(s->most, f.band[b]);
                s->same &= f.band[b] == f.band[0] || isnan(f.band[0]);
            }
        }
}

/* The maps; then the edge along theta_h, at theta_d = 0, and the other. */
static void table_write(FILE *out, const struct slice *s)
{
    const struct bands *bands = bsdf_bands(s->bsdf);
    const size_t n = (size_t)bands->count;
    table_comment(out, "made by", "bsdf-plot slice");
    table_comment(out, "spec", bsdf_spec(s->bsdf));
    fprintf(out, "# phi_d: %.10g deg\n# theta_h [deg]\ttheta_d [deg]",
            s->phi_deg);
    table_columns(out, bands, "f [1/sr]");
    fputc('\n', out);
    for (int i = 0; i < CELLS; i++)
        for (int k = 0; k < CELLS; k++) {
            double row[2 + BANDS_MAX] = { middle(i), middle(k) };
            memcpy(row + 2, s->f[i][k].band, n * sizeof *row);
            table_row(out, row, 2 + n);
        }
    for (int along_d = 0; along_d < 2; along_d++) {
        fprintf(out, "\n\n# theta_%c = 0\n# theta_%c [deg]",
                along_d ? 'h' : 'd', along_d ? 'd' : 'h');
        table_columns(out, bands, "f [1/sr]");
        fputc('\n', out);
        for (int i = 0; i < 360; i++) {
            const double deg = i * 0.25;
            const struct spectrum f =
                along_d ? value(s, 0, deg) : value(s, deg, 0);
            double row[1 + BANDS_MAX] = { deg };
            memcpy(row + 1, f.band, n * sizeof *row);
            table_row(out, row, 1 + n);
        }
    }
}

enum { PANEL = 150 };

static void edge(struct figure *fig, int column, double bottom,
                 struct chart_axis y, struct chart_curve *curve, int n)
{
    struct chart c = {
        .y0 = bottom,
        .y1 = bottom + PANEL,
        .title =
            column ? "θ_h = 0, mirror directions" : "θ_d = 0, retroreflection",
        .x = chart_axis_exact(0, 90, 15, column ? "θ_d" : "θ_h", "deg"),
        .y = y,
        .curve = curve,
        .curves = n,
    };
    for (int i = 0; i < n; i++)
        curve[i].block = 1 + column;
    chart_column(&c, column, 2, false);
    chart_draw(fig, &c);
}

static int curves_of(const struct slice *s, struct chart_curve *curve)
{
    const struct bands *bands = bsdf_bands(s->bsdf);
    const int n = s->same ? 1 : bands->count;
    for (int i = 0; i < n; i++) {
        curve[i] = (struct chart_curve){
            .x = "$1", .line = s->same ? LINE_ONLY : colours_line(bands, i)
        };
        snprintf(curve[i].y, sizeof curve[i].y, "$%d", 2 + i);
        if (s->same && bands->count > 1)
            strcpy(curve[i].text, "all bands");
        else
            bands_print_one(bands, i, curve[i].text, sizeof curve[i].text);
    }
    return n;
}

static void script_write(struct figure *fig, const struct slice *s)
{
    struct chart_curve curve[BANDS_MAX];
    const int n = curves_of(s, curve);
    const double hi = pow(10, ceil(log10(s->most) - 1e-9));
    const struct chart_axis y =
        chart_axis_log(hi * pow(10, -DECADES), hi, "f", "1/sr");
    const double foot = 12 + CHART_NOTE, key = foot + 14;
    const double bottom = key + 16 + CHART_BELOW;
    const double map = bottom + PANEL + CHART_ABOVE + CHART_BAR_BELOW +
                       CHART_BAR + 10 + CHART_BELOW;
    struct chart c = { .y0 = map,
                       .x = chart_axis_exact(0, 90, 30, "θ_h", "deg"),
                       .y = chart_axis_exact(0, 90, 30, "θ_d", "deg") };
    chart_column(&c, 0, n, true);
    const double high = fmin(c.x1 - c.x0, 240);
    char below[160], bands[96];
    bands_print(bsdf_bands(s->bsdf), bands, sizeof bands);
    snprintf(below, sizeof below, "φ_d = %.6g°;  %s", s->phi_deg, bands);
    figure_page(fig, FIGURE_PAGE, map + high + CHART_ABOVE + 6,
                bsdf_spec(s->bsdf), below);
    chart_notes(fig, foot,
                (const char *[]){
                    s->cut ? "θ_h: angle of the half vector to the normal; "
                             "θ_d: of ωᵢ to the half vector; grey: below the "
                             "surface"
                           : "θ_h: angle of the half vector to the normal; "
                             "θ_d: of ωᵢ to the half vector" },
                1);
    chart_key(fig, curve, n, key);
    for (int i = 0; i < n; i++) {
        struct chart_map m = { .x = "$1",
                               .y = "$2",
                               .palette = "heat",
                               .lo = y.lo,
                               .hi = y.hi,
                               .log = true };
        /* What is 0 has the colour of the least. */
        snprintf(m.z, sizeof m.z, "$%d < %.3g ? %.3g : $%d", 3 + i, y.lo, y.lo,
                 3 + i);
        chart_column(&c, i, n, true);
        if (n == 1) { /* a square in the middle */
            c.x0 = (FIGURE_PAGE - high) / 2;
            c.x1 = c.x0 + high;
        }
        c.y1 = map + high;
        c.title = curve[i].text;
        c.map = &m;
        if (i == 0)
            chart_bar(fig, n == 1 ? 160 : c.x0,
                      n == 1 ? FIGURE_PAGE - 160 : FIGURE_PAGE - 26,
                      map - CHART_BELOW - CHART_BAR - 4, &m, 1, y.title);
        fputs("set object rectangle from graph 0,0 to graph 1,1 behind "
              "fillcolor rgb \"#d9d9d9\" fillstyle solid 1 noborder\n",
              fig->script);
        chart_draw(fig, &c);
        fputs("unset object\n", fig->script);
    }
    edge(fig, 0, bottom, y, curve, n);
    edge(fig, 1, bottom, y, curve, n);
}

static bool nothing(const struct slice *s, struct err *err)
{
    const bool single = bsdf_claims(s->bsdf).lobes & BSDF_DELTA;
    return s->most == 0 &&
           !err_set(err,
                    "slice: %.200s reflects nothing%s; there is nothing "
                    "to draw",
                    bsdf_spec(s->bsdf), single ? " but single directions" : "");
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct slice *s = calloc(1, sizeof *s);
    if (!s)
        return err_set(err, "out of memory");
    s->bsdf = r->bsdf[0];
    s->phi_deg = isnan(r->phi_deg) ? 90 : r->phi_deg;
    fill(s);
    bool ok = !nothing(s, err) && figure_open(&fig, r->output, &r->look, err);
    if (ok) {
        table_write(fig.table, s);
        script_write(&fig, s);
        plot_caption(&fig, &plot_slice, r, NULL,
                     "f [1/sr] in reflection against the angle θ_h of the half "
                     "vector to the normal and θ_d of ωᵢ to the half vector.");
        ok = figure_draw(&fig, made, err);
    }
    free(s);
    return ok;
}

const struct plot plot_slice = {
    .name = "slice",
    .about = "f against the angles of half vector and difference",
    .heeds = HEEDS_PHI,
    .run = run,
};
