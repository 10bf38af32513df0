/* lobe3d.c - the BSDF as a surface about the point that scatters, see surface.h
 */
#include "plots/kinds.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plots/axis.h"
#include "plots/colours.h"
#include "plots/key.h"
#include "plots/surface.h"
#include "plots/table.h"

/* -- the table ------------------------------------------------------------- */

static void side_write(FILE *out, const struct surface *s,
                       const struct surface_side *side)
{
    const struct bands *bands = bsdf_bands(s->bsdf);
    const size_t n = (size_t)bands->count;
    for (size_t i = 0; i < side->theta.n; i++) {
        for (size_t k = 0; k < side->phi.n; k++) {
            const struct vec3 wi =
                surface_direction(s, side->theta.deg[i], side->phi.deg[k]);
            const struct spectrum f = surface_value(s, wi);
            double row[3 + BANDS_MAX] = { side->theta.deg[i],
                                          side->phi.deg[k] + s->mirror_phi_deg,
                                          surface_mean(s, wi) };
            memcpy(row + 3, f.band, n * sizeof *row);
            table_row(out, row, 3 + n);
        }
        if (i + 1 < side->theta.n)
            fputc('\n', out);
    }
}

static void table_write(FILE *out, const struct surface *s)
{
    const struct bands *bands = bsdf_bands(s->bsdf);
    const size_t n = (size_t)bands->count;
    int blocks = 0;
    table_head(out, s->bsdf, s->wo);
    fprintf(out,
            "# mean: %s\n"
            "# theta_i [deg]\tphi_i [deg]\tmean f |cos theta_i| [1/sr]",
            bands->kind == BANDS_NM
                ? "of the bands"
                : "luminance, 0.2126 R + 0.7152 G + 0.0722 B");
    table_columns(out, bands, "f |cos theta_i| [1/sr]");
    fputc('\n', out);
    for (int below = 0; below < 2; below++)
        if (surface_present(&s->side[below])) {
            fprintf(out, "%s# %s the surface, a block for each theta_i\n",
                    blocks++ ? "\n\n" : "", below ? "below" : "above");
            side_write(out, s, &s->side[below]);
        }
    if (s->pilots.deltas == 0)
        return;
    fprintf(out,
            "%s# single directions\n# theta_i [deg]\tphi_i [deg]\tprobability "
            "[1]",
            blocks ? "\n\n" : "");
    table_columns(out, bands, "weight [1]");
    fputc('\n', out);
    for (int k = 0; k < s->pilots.deltas; k++) {
        const struct delta *d = &s->pilots.delta[k];
        const struct angles a = dir_to_degrees(d->wi);
        double row[3 + BANDS_MAX] = { a.theta_deg, a.phi_deg, d->pdf };
        memcpy(row + 3, d->weight.band, n * sizeof *row);
        table_row(out, row, 3 + n);
    }
}

/* -- the picture ----------------------------------------------------------- */

/* In pixels. */
enum {
    PAGE = 800,
    RADIUS = 240, /* of the outermost ring */
    CENTRE = 355, /* of the rings, from the left */
    ABOVE = 270,  /* from there upward */
    FRONT = 120,  /* and downward, where nothing is below the surface */
    BACK = 265,   /* or something is */
    BAR = 700,    /* the left edge of the colour bar */
    LINE = 17
};

/* The plane of incidence is seen nearly from the side, the surface from above,
 * so that what is below it comes first, then its grid, then what is above. */
static const double view_down_deg = 68, view_turn_deg = 20;

struct scale {
    double step, unit; /* [1/sr] between rings, and that they are written in */
    double reach;      /* of the last ring [1/sr] */
    int steps;
    bool log;
    int decade; /* of the last ring, with logarithms */
    char unit_text[32];
};

static struct scale scale_of(const struct surface *s)
{
    const double most = surface_largest(s);
    struct scale c = { .step = 1, .unit = 1, .reach = 1, .steps = 1 };
    if (!(most > 0))
        return c;
    if (s->top > 0) { /* a ring a decade */
        c.steps = SURFACE_DECADES;
        c.reach = s->top;
        c.decade = (int)lround(log10(s->top));
        c.log = true;
        axis_unit(c.unit_text, sizeof c.unit_text, 0, "1/sr");
        return c;
    }
    c.step = axis_step(most, 5);
    c.steps = (int)ceil(most / c.step * (1 - 1e-12));
    c.reach = c.step * c.steps;
    const int exponent = axis_exponent(c.reach);
    c.unit = pow(10, exponent);
    axis_unit(c.unit_text, sizeof c.unit_text, exponent, "1/sr");
    return c;
}

/* In the units of the plots, whose outermost ring is 1 and whose x axis goes
 * toward the mirror direction. */
static struct vec3 placed(const struct surface *s, struct vec3 w, double length)
{
    const struct angles a = dir_to_degrees(w);
    return vec3_scale(
        length, dir_from_degrees(a.theta_deg, a.phi_deg - s->mirror_phi_deg));
}

static void arrow(FILE *out, struct vec3 a, struct vec3 b, const char *look)
{
    fprintf(out, "set arrow from %.6g,%.6g,%.6g to %.6g,%.6g,%.6g front %s\n",
            a.x, a.y, a.z, b.x, b.y, b.z, look);
}

/* Of wo and its mirror direction, from where they leave the lobe, and of the
 * single directions; those on one side of the surface. */
static void arrows(FILE *out, const struct surface *s, const struct scale *c,
                   bool below)
{
    const struct vec3 mirror = { -s->wo.x, -s->wo.y, s->wo.z };
    const struct vec3 both[] = { mirror, s->wo };
    if ((s->wo.z < 0) == below)
        for (int i = 0; i < 2; i++) {
            const double from = surface_radius(s, both[i]) / c->reach;
            const double to = fmax(1.1, from + 0.15);
            arrow(out, placed(s, both[i], i ? from : fmax(from, to - 0.18)),
                  placed(s, both[i], to), i ? key_wo : key_mirror);
        }
    for (int k = 0; k < s->pilots.deltas; k++)
        if ((s->pilots.delta[k].wi.z < 0) == below)
            arrow(out, (struct vec3){ 0, 0, 0 },
                  placed(s, s->pilots.delta[k].wi, 1), key_delta);
}

struct pixel {
    double x, y; /* from the centre, upward */
};

/* Where gnuplot's view puts a point of the plots. */
static struct pixel seen(struct vec3 p)
{
    const double turn = view_turn_deg * PI / 180;
    const double down = view_down_deg * PI / 180;
    const double away = p.y * cos(turn) - p.x * sin(turn);
    return (struct pixel){ RADIUS * (p.x * cos(turn) + p.y * sin(turn)),
                           RADIUS * (p.z * sin(down) + away * cos(down)) };
}

/* Whether a lobe would cover some of a short text in the middle of at. */
static bool covered(const struct surface *s, const struct scale *c,
                    struct pixel at)
{
    const double wide = 24, high = 10;
    for (int below = 0; below < 2; below++) {
        const struct surface_side *side = &s->side[below];
        for (size_t i = 0; i < side->theta.n; i++)
            for (size_t k = 0; k < side->phi.n; k++) {
                const double theta = side->theta.deg[i];
                const double phi = side->phi.deg[k];
                const struct pixel p = seen(vec3_scale(
                    surface_radius(s, surface_direction(s, theta, phi)) /
                        c->reach,
                    dir_from_degrees(theta, phi)));
                if (fabs(p.x - at.x) < wide && fabs(p.y - at.y) < high)
                    return true;
            }
    }
    return false;
}

static struct vec3 on_plane(double radius, double phi_deg)
{
    return vec3_scale(radius, dir_from_degrees(90, phi_deg));
}

/* Below the mark of a ring, the middle of its number. */
static struct pixel number_at(const struct scale *c, int ring, double phi_deg)
{
    struct pixel p = seen(on_plane((double)ring / c->steps, phi_deg));
    p.y -= 11;
    return p;
}

/* The spoke nearest to the viewer of those that have no name, and where no lobe
 * would cover the numbers along it if there is such a one. */
static double numbered_spoke(const struct surface *s, const struct scale *c)
{
    const double viewer = view_turn_deg - 90;
    const double nearest = 30 * round((viewer + s->mirror_phi_deg - 15) / 30) +
                           15 - s->mirror_phi_deg;
    for (int i = 0; i < 5; i++) {
        const int turns = (i + 1) / 2;
        const double phi = nearest + (i % 2 ? 30 : -30) * turns;
        bool free = true;
        for (int k = 1; k <= c->steps; k++)
            free = free && !covered(s, c, number_at(c, k, phi));
        if (free)
            return phi;
    }
    return nearest;
}

static void ring_number(const struct scale *c, int ring, char *text,
                        size_t size)
{
    const int e = c->decade - c->steps + ring;
    if (!c->log) {
        snprintf(text, size, "%g", ring * c->step / c->unit);
    } else if (e == 0) {
        snprintf(text, size, "1");
    } else {
        axis_unit(text, size, e, "");
        text[strcspn(text, " ")] = '\0';
    }
}

/* Names of azimuths, and numbers of rings. */
static void plane_labels(struct figure *fig, const struct surface *s,
                         const struct scale *c)
{
    static const char colour[] = "tc rgb \"#505050\"";
    for (int a = 0; a < 360; a += 30) {
        const struct vec3 at = on_plane(1.13, a - s->mirror_phi_deg);
        if (!covered(s, c, seen(at))) {
            char text[32];
            snprintf(text, sizeof text, "%s%d°", a ? "" : "φ = ", a);
            figure_label_at(fig, text, "%.6g,%.6g,0 center %s", at.x, at.y,
                            colour);
        }
    }
    if (!(surface_largest(s) > 0))
        return;
    const double spoke = numbered_spoke(s, c);
    for (int i = 1; i <= c->steps; i++) {
        char text[64];
        const struct vec3 at = on_plane((double)i / c->steps, spoke);
        char number[32];
        ring_number(c, i, number, sizeof number);
        snprintf(text, sizeof text, i < c->steps ? "%s" : "%s [%s]", number,
                 c->unit_text);
        figure_label_at(fig, text, "%.6g,%.6g,0 center offset 0,-0.7 %s", at.x,
                        at.y, colour);
    }
}

/* Spokes and rings in the surface; and the normal, with marks at the same
 * radii, within a circle in the plane of incidence. */
static void plane(FILE *out, const struct surface *s, const struct scale *c,
                  bool back)
{
    static const char look[] = "nohead back lc rgb \"#b8b8b8\" lw";
    fputs("\n# the surface and the plane of incidence\n", out);
    fprintf(out,
            "do for [a=0:345:15] {\n"
            "    p = a - (%.10g)\n"
            "    set arrow from 0,0,0 to cos(p),sin(p),0 %s (a %% 30 ? 0.3 : "
            "0.6)\n"
            "}\n"
            "set arrow from 0,0,%d to 0,0,1 %s 0.8 dt (6,4)\n"
            "do for [i=%d:%d] {\n"
            "    set arrow from -0.015,0,i/%d. to 0.015,0,i/%d. %s 0.8\n"
            "}\n",
            s->mirror_phi_deg, look, back ? -1 : 0, look, back ? -c->steps : 1,
            c->steps, c->steps, c->steps, look);
    fprintf(out,
            "set samples 121\n"
            "splot for [i=1:%d] [t=0:360] '+' using "
            "(i/%d.*cos($1)):(i/%d.*sin($1)):(0) with lines lc rgb \"#b8b8b8\" "
            "dt 1 lw 0.6, \\\n"
            "     [t=%d:180] '+' using (cos($1)):(0):(sin($1)) with lines lc "
            "rgb \"#b8b8b8\" lw 0.8 dt (6,4)\n"
            "unset arrow; unset label\n",
            c->steps, c->steps, c->steps, back ? -180 : 0);
}

/* How wide a lobe is where it has fallen to half of its peak, across the
 * direction where it is narrower [px]. */
static double lobe_width(const struct surface *s,
                         const struct surface_side *side, const struct scale *c)
{
    const struct surface_peak *p = &side->peak;
    const struct vec3 top = surface_direction(s, p->theta_deg, p->phi_deg);
    const struct vec3 down =
        surface_direction(s, p->theta_deg + 90, p->phi_deg);
    const struct vec3 way[2] = { down, vec3_cross(top, down) };
    const double peak = surface_radius(s, top);
    double narrow = 1;
    for (int k = 0; k < 2; k++)
        for (double a = 1e-4; a < narrow; a *= 1.1) {
            const struct vec3 along = vec3_scale(cos(a), top);
            const struct vec3 by = vec3_scale(sin(a), way[k]);
            if (fmax(surface_radius(s, vec3_add(along, by)),
                     surface_radius(s, vec3_add(along, vec3_scale(-1, by)))) <
                peak / 2)
                narrow = a;
        }
    return sin(narrow) * peak / c->reach * RADIUS;
}

/* The lines of the mesh are drawn where there is room for them.  Where there is
 * not, faces that hide each other have about the same radius and colour, so
 * that their order is no matter; and in it gnuplot 5.4 would leave the outlines
 * of an SVG filled with black. */
static void lobe(FILE *out, const struct surface *s, const struct scale *c,
                 bool below)
{
    const double room = 24;
    const struct surface_side *side = &s->side[below];
    const int index = below && surface_present(&s->side[0]) ? 1 : 0;
    fprintf(out, "\n# %s the surface\n", below ? "below" : "above");
    arrows(out, s, c, below);
    if (surface_present(side))
        fprintf(out,
                "set pm3d %s\n"
                "splot table index %d using "
                "(r($3)*sin($1)*cos($2-(%.10g))):"
                "(r($3)*sin($1)*sin($2-(%.10g))):(r($3)*cos($1)):"
                "(colour($3)) with pm3d\n",
                lobe_width(s, side, c) > room
                    ? "depthorder border lc rgb \"#80000000\" lw 0.15"
                    : "scansautomatic border retrace lw 0.3",
                index, s->mirror_phi_deg, s->mirror_phi_deg);
    else /* for the arrows and labels */
        fputs("splot '+' using (0):(0):(0) every ::0::0 with dots lc rgb "
              "\"#b8b8b8\"\n",
              out);
    fprintf(out, "unset arrow; unset label%s\n",
            surface_present(side) ? "; unset colorbox" : "");
}

/* From 0 up to 360, to as many digits as are written. */
static double named_phi(const struct surface *s, double phi_deg)
{
    const double phi = phi_deg + s->mirror_phi_deg;
    const double turned = phi - 360 * floor(phi / 360);
    return turned > 359.995 ? 0 : turned;
}

struct notes {
    char text[DELTAS_MAX + 4][256];
    int lines;
};

static struct notes notes_of(const struct surface *s)
{
    enum { SIZE = sizeof((struct notes *)0)->text[0] };
    const struct bands *bands = bsdf_bands(s->bsdf);
    struct notes n = { .lines = 0 };
    if (surface_largest(s) > 0)
        snprintf(n.text[n.lines++], SIZE,
                 "radius and colour: f |cos θᵢ|, %s; %s",
                 colours_mean_name(bands),
                 s->top > 0 ? "logarithmic, in the middle all that is less"
                            : "the same scale along all axes");
    for (int below = 0; below < 2; below++)
        if (surface_present(&s->side[below])) {
            const struct surface_peak *p = &s->side[below].peak;
            const double phi = named_phi(s, p->phi_deg);
            const bool pole = p->theta_deg == 0 || p->theta_deg == 180;
            int used =
                snprintf(n.text[n.lines++], SIZE,
                         "maximum %s the surface: %.5g/sr at θᵢ = %.5g°",
                         below ? "below" : "above", p->mean, p->theta_deg);
            if (!pole)
                snprintf(n.text[n.lines - 1] + used, SIZE - (size_t)used,
                         ", φᵢ = %.5g°", phi);
        }
    for (int k = 0; k < s->pilots.deltas; k++)
        delta_text(&s->pilots.delta[k], bands->count,
                   dir_to_degrees(s->pilots.delta[k].wi).theta_deg,
                   n.text[n.lines++], SIZE);
    if (s->odd > 0)
        snprintf(n.text[n.lines++], SIZE,
                 "f is infinite or not a number in %zu directions of the mesh, "
                 "drawn as 0",
                 s->odd);
    return n;
}

static void key(struct figure *fig, const struct surface *s, double y)
{
    struct key_entry entry[3] = { { .text = "ωₒ" },
                                  { .text = "mirror direction" },
                                  { .text = "δ" } };
    const char *const look[] = { key_wo, key_mirror, key_delta };
    for (int i = 0; i < 3; i++)
        snprintf(entry[i].look, sizeof entry[i].look, "%s", look[i]);
    key_draw(fig, entry, 2 + (s->pilots.deltas > 0), y);
}

static void colour_bar(struct figure *fig, const struct scale *c, double centre)
{
    char text[64];
    const double from = centre - 60, to = centre + 160;
    FILE *out = fig->script;
    fprintf(out,
            "set colorbox vertical user origin screen %.6g,%.6g size screen "
            "%.6g,%.6g border\n"
            "set cbtics scale 0.5 ",
            BAR / fig->width, from / fig->height, 14 / fig->width,
            (to - from) / fig->height);
    if (!c->log)
        fprintf(out, "%.10g format \"%s\"\n", c->step / c->unit,
                fig->form->number);
    for (int i = 0; c->log && i <= c->steps; i++) {
        ring_number(c, i, text, sizeof text);
        fputs(i ? ", " : "(", out);
        figure_text(fig, text);
        fprintf(out, " 1e%d%s", c->decade - c->steps + i,
                i < c->steps ? "" : ")\n");
    }
    snprintf(text, sizeof text, "f |cos θᵢ| [%s]", c->unit_text);
    figure_label(fig, BAR + 20, to + 22, "center", text);
}

/* What a value is drawn as: its radius, of which 1 is the last ring, and its
 * colour. */
static void functions(FILE *out, const struct scale *c)
{
    const double least = c->reach * pow(10, -c->steps);
    if (c->log)
        fprintf(out,
                "set logscale cb; set cbrange [%.10g:%.10g]\n"
                "r(x) = x > %.10g ? 1 + log10(x/%.10g)/%d : 0\n"
                "colour(x) = x > %.10g ? x : %.10g\n",
                least * (1 - 1e-6), c->reach * (1 + 1e-6), least, c->reach,
                c->steps, least, least);
    else
        fprintf(out,
                "set cbrange [0:%.10g]\n"
                "r(x) = x/%.10g\n"
                "colour(x) = x/%.10g\n",
                c->reach / c->unit, c->reach, c->unit);
}

static void script_write(struct figure *fig, const struct surface *s)
{
    FILE *out = fig->script;
    const struct scale c = scale_of(s);
    const struct angles wo = dir_to_degrees(s->wo);
    const struct notes notes = notes_of(s);
    const bool back = surface_present(&s->side[1]) || s->wo.z < 0 ||
                      (s->pilots.deltas > 0 &&
                       s->pilots.delta[s->pilots.deltas - 1].wi.z < 0);
    const double foot = 12 + notes.lines * LINE, key_y = foot + 14;
    const double centre = key_y + 20 + (back ? BACK : FRONT);
    char below[200], bands[96];
    bands_print(bsdf_bands(s->bsdf), bands, sizeof bands);
    snprintf(below, sizeof below, "ωₒ: θ = %.6g°, φ = %.6g°;  %s", wo.theta_deg,
             wo.phi_deg, bands);
    figure_page(fig, PAGE, centre + ABOVE, bsdf_spec(s->bsdf), below);
    for (int i = 0; i < notes.lines; i++)
        figure_label(fig, PAGE / 2., foot - LINE * (i + 0.5), "center",
                     notes.text[i]);
    key(fig, s, key_y);
    /* gnuplot puts the middle of the ranges into that of the panel, and half
     * of its height is a length of 1 if it fits the page. */
    const double lowest = back ? -1 : -0.4;
    const double middle =
        centre + seen((struct vec3){ 0, 0, (lowest + 1) / 2 }).y;
    figure_panel(fig, CENTRE - RADIUS, CENTRE + RADIUS, middle - RADIUS,
                 middle + RADIUS);
    fprintf(out,
            "unset border; unset tics; unset key\n"
            "set xrange [-1:1]; set yrange [-1:1]; set zrange [%g:1]\n"
            "set xyplane at %g\n"
            "set view %g,%g\n"
            "set view equal xyz\n"
            "set palette @heat\n",
            lowest, lowest, view_down_deg, view_turn_deg);
    functions(out, &c);
    if (surface_largest(s) > 0)
        colour_bar(fig, &c, centre);
    else
        fputs("unset colorbox\n", out);
    plane_labels(fig, s, &c);
    lobe(out, s, &c, true);
    plane(out, s, &c, back);
    lobe(out, s, &c, false);
}

/* -- all of it ------------------------------------------------------------- */

static bool nothing(const struct surface *s, struct err *err)
{
    const struct angles wo = dir_to_degrees(s->wo);
    if (surface_largest(s) > 0 || s->pilots.deltas > 0)
        return false;
    err_set(err,
            "lobe3d: f is not above 0 anywhere for theta %.6g, phi %.6g deg; "
            "there is nothing to draw",
            wo.theta_deg, wo.phi_deg);
    return true;
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct surface *s = calloc(1, sizeof *s);
    if (!s)
        return err_set(err, "out of memory");
    surface_make(s, r->bsdf[0], r->wo[0], r->log, r->seed);
    const bool ready =
        !nothing(s, err) && figure_open(&fig, r->output, &r->look, err);
    bool ok = ready;
    if (ready) {
        table_write(fig.table, s);
        script_write(&fig, s);
        plot_caption(&fig, &plot_lobe3d, r, NULL,
                     "f |cos θᵢ| [1/sr] as the radius of a surface, in every "
                     "direction ωᵢ.");
        ok = figure_draw(&fig, made, err);
    }
    free(s);
    return ok;
}

const struct plot plot_lobe3d = {
    .name = "lobe3d",
    .about = "f |cos| over all directions, as a surface",
    .heeds = HEEDS_WO | HEEDS_LOG,
    .run = run,
};
