/* lobe3d.c - the BSDF as a surface about the point that scatters
 *
 *   radius = f |cos theta_i| [1/sr] in every direction wi, one number for all
 *   bands: the luminance of R, G, B, or the mean of wavelengths.
 *
 * Each side of the surface has a mesh in theta_i and phi_i.  Its lines start
 * from a coarse grid and from angles ever closer to the peak, which pilot
 * directions find however narrow it is.  Intervals are halved until the chords
 * between neighbours are as good as the surface, everywhere along a line; then
 * lines that no chord needs are left out.
 */
#include "plots/kinds.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plots/axis.h"
#include "plots/colours.h"
#include "plots/key.h"
#include "plots/pilots.h"
#include "plots/table.h"

enum { LINES_MAX = 512, QUADS_MAX = 9000, PASSES_MAX = 24, CLOSER = 26 };

/* How far a chord may be from the surface, and how long it may be; both of the
 * largest radius of both sides. */
static const double bend_max = 0.0015, chord_max = 0.06;
static const double interval_min_deg = 1e-9;

struct lines {
    double deg[LINES_MAX];
    size_t n;
};

struct peak {
    double theta_deg, phi_deg; /* phi from that of the mirror direction */
    double radius;
};

struct side {
    double from_deg, to_deg; /* of theta */
    struct peak peak;
    struct lines theta, phi;
};

struct surface {
    const struct bsdf *bsdf;
    struct vec3 wo;
    double mirror_phi_deg;
    struct side side[2]; /* above and below */
    struct pilots pilots;
    size_t odd; /* directions where a value is not a finite number */
};

/* -- radii ----------------------------------------------------------------- */

/* A direction from theta and from phi about the mirror direction. */
static struct vec3 direction(const struct surface *s, double theta_deg,
                             double phi_deg)
{
    return dir_from_degrees(theta_deg, phi_deg + s->mirror_phi_deg);
}

/* f |cos|, 0 where it is not a finite number. */
static struct spectrum value(const struct surface *s, struct vec3 wi)
{
    const struct spectrum f =
        spectrum_scale(fabs(wi.z), bsdf_eval(s->bsdf, s->wo, wi));
    const int n = bsdf_bands(s->bsdf)->count;
    for (int b = 0; b < n; b++)
        if (!isfinite(f.band[b]))
            return spectrum_of(n, 0);
    return f;
}

static double radius(const struct surface *s, struct vec3 wi)
{
    return fmax(colours_mean(bsdf_bands(s->bsdf), value(s, wi)), 0);
}

static double radius_at(const struct surface *s, double theta_deg,
                        double phi_deg)
{
    return radius(s, direction(s, theta_deg, phi_deg));
}

static double largest(const struct surface *s)
{
    return fmax(s->side[0].peak.radius, s->side[1].peak.radius);
}

/* -- the peak -------------------------------------------------------------- */

static void peak_try(const struct surface *s, const struct side *side,
                     struct peak *p, double theta_deg, double phi_deg)
{
    const double theta = fmin(fmax(theta_deg, side->from_deg), side->to_deg);
    const double r = radius_at(s, theta, phi_deg);
    if (r > p->radius)
        *p = (struct peak){ theta, remainder(phi_deg, 360), r };
}

/* The best of a grid and of the pilots, then uphill by ever smaller steps. */
static void peak_find(const struct surface *s, struct side *side)
{
    const double middle = (side->from_deg + side->to_deg) / 2;
    struct peak p = { side->from_deg > 0 ? 180 : 0, 0, 0 };
    for (int i = 0; i <= 45; i++)
        for (int k = 0; k < 90; k++)
            peak_try(s, side, &p, side->from_deg + 2 * i, 4 * k);
    for (size_t i = 0; i < s->pilots.n; i++) {
        const struct angles a = dir_to_degrees(s->pilots.wi[i]);
        if ((a.theta_deg > 90) == (middle > 90))
            peak_try(s, side, &p, a.theta_deg, a.phi_deg - s->mirror_phi_deg);
    }
    for (double step = 2; step > 1e-9;) {
        const struct peak was = p;
        const double across =
            fmin(step / fmax(sin(was.theta_deg * PI / 180), 1e-6), 90);
        peak_try(s, side, &p, was.theta_deg - step, was.phi_deg);
        peak_try(s, side, &p, was.theta_deg + step, was.phi_deg);
        peak_try(s, side, &p, was.theta_deg, was.phi_deg - across);
        peak_try(s, side, &p, was.theta_deg, was.phi_deg + across);
        if (!(p.radius > was.radius * (1 + 1e-12)))
            step /= 2;
    }
    side->peak = p;
}

/* -- the mesh -------------------------------------------------------------- */

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void lines_init(struct lines *l, double from, double to, double step,
                       double peak)
{
    double all[LINES_MAX];
    const int steps = (int)lround((to - from) / step);
    size_t n = 0;
    for (int i = 0; i <= steps; i++)
        all[n++] = from + i * step;
    all[n++] = peak;
    for (int k = 1; k <= CLOSER; k++) {
        all[n++] = peak - ldexp(90, -k);
        all[n++] = peak + ldexp(90, -k);
    }
    qsort(all, n, sizeof *all, ascending);
    l->n = 0;
    for (size_t i = 0; i < n; i++)
        if (all[i] >= from && all[i] <= to &&
            (l->n == 0 || all[i] > l->deg[l->n - 1]))
            l->deg[l->n++] = all[i];
}

/* Point k of a line of the mesh: theta is along[k] or across, phi the other. */
static struct vec3 point(const struct surface *s, bool of_phi, double along,
                         double across)
{
    const struct vec3 w =
        of_phi ? direction(s, across, along) : direction(s, along, across);
    return vec3_scale(radius(s, w), w);
}

static double apart(struct vec3 a, struct vec3 b)
{
    return vec3_length(vec3_add(a, vec3_scale(-1, b)));
}

/* How far a point is from the line between two others. */
static double off_chord(struct vec3 p, struct vec3 a, struct vec3 b)
{
    const struct vec3 ab = vec3_add(b, vec3_scale(-1, a));
    const struct vec3 ap = vec3_add(p, vec3_scale(-1, a));
    const double length2 = vec3_dot(ab, ab);
    const double t =
        length2 > 0 ? fmin(fmax(vec3_dot(ap, ab) / length2, 0), 1) : 0;
    return apart(ap, vec3_scale(t, ab));
}

/* Halves intervals of the lines wherever one across has a chord that is not
 * good enough; false when there was none. */
static bool refine(const struct surface *s, struct lines *l,
                   const struct lines *across, bool of_phi)
{
    const double scale = largest(s);
    struct lines next = { .n = 0 };
    for (size_t i = 0; i < l->n; i++) {
        next.deg[next.n++] = l->deg[i];
        if (i + 1 == l->n || next.n + (l->n - i) > LINES_MAX ||
            !(l->deg[i + 1] - l->deg[i] > interval_min_deg))
            continue;
        const double x[3] = { l->deg[i], (l->deg[i] + l->deg[i + 1]) / 2,
                              l->deg[i + 1] };
        for (size_t k = 0; k < across->n; k++) {
            struct vec3 p[3];
            for (int j = 0; j < 3; j++)
                p[j] = point(s, of_phi, x[j], across->deg[k]);
            if (off_chord(p[1], p[0], p[2]) > bend_max * scale ||
                apart(p[0], p[2]) > chord_max * scale) {
                next.deg[next.n++] = x[1];
                break;
            }
        }
    }
    const bool more = next.n > l->n;
    *l = next;
    return more;
}

/* Whether chords from line a to line b may replace all that is between. */
static bool spare(const struct surface *s, const struct lines *l, size_t a,
                  size_t b, const struct lines *across, bool of_phi,
                  double slack)
{
    const double scale = largest(s) * slack;
    for (size_t k = 0; k < across->n; k++) {
        const struct vec3 p = point(s, of_phi, l->deg[a], across->deg[k]);
        const struct vec3 q = point(s, of_phi, l->deg[b], across->deg[k]);
        if (apart(p, q) > chord_max * scale)
            return false;
        for (size_t i = a + 1; i < b; i++)
            if (off_chord(point(s, of_phi, l->deg[i], across->deg[k]), p, q) >
                bend_max * scale)
                return false;
    }
    return true;
}

static void prune(const struct surface *s, struct lines *l,
                  const struct lines *across, bool of_phi, double keep,
                  double slack)
{
    struct lines kept = { .n = 0 };
    size_t last = 0;
    kept.deg[kept.n++] = l->deg[0];
    for (size_t i = 1; i + 1 < l->n; i++)
        if (l->deg[i] == keep ||
            !spare(s, l, last, i + 1, across, of_phi, slack)) {
            last = i;
            kept.deg[kept.n++] = l->deg[i];
        }
    kept.deg[kept.n++] = l->deg[l->n - 1];
    *l = kept;
}

static void mesh(const struct surface *s, struct side *side)
{
    struct lines *theta = &side->theta, *phi = &side->phi;
    const struct peak *p = &side->peak;
    lines_init(theta, side->from_deg, side->to_deg, 5, p->theta_deg);
    lines_init(phi, -180, 180, 10, p->phi_deg);
    for (int pass = 0; pass < PASSES_MAX; pass++) {
        const bool more = refine(s, theta, phi, false);
        if (!refine(s, phi, theta, true) && !more)
            break;
    }
    for (double slack = 1; slack < 8; slack *= 1.25) {
        prune(s, theta, phi, false, p->theta_deg, slack);
        prune(s, phi, theta, true, p->phi_deg, slack);
        if (theta->n * phi->n <= QUADS_MAX)
            break;
    }
}

static bool present(const struct side *side)
{
    return side->peak.radius > 0;
}

static void count_odd(struct surface *s)
{
    const int n = bsdf_bands(s->bsdf)->count;
    for (int below = 0; below < 2; below++) {
        const struct side *side = &s->side[below];
        for (size_t i = 0; i < side->theta.n; i++)
            for (size_t k = 0; k < side->phi.n; k++) {
                const struct spectrum f = bsdf_eval(
                    s->bsdf, s->wo,
                    direction(s, side->theta.deg[i], side->phi.deg[k]));
                bool odd = false;
                for (int b = 0; b < n; b++)
                    odd |= !isfinite(f.band[b]);
                s->odd += odd;
            }
    }
}

/* -- the table ------------------------------------------------------------- */

static void side_write(FILE *out, const struct surface *s,
                       const struct side *side)
{
    const struct bands *bands = bsdf_bands(s->bsdf);
    const size_t n = (size_t)bands->count;
    for (size_t i = 0; i < side->theta.n; i++) {
        for (size_t k = 0; k < side->phi.n; k++) {
            const struct vec3 wi =
                direction(s, side->theta.deg[i], side->phi.deg[k]);
            const struct spectrum f = value(s, wi);
            double row[3 + BANDS_MAX] = { side->theta.deg[i],
                                          side->phi.deg[k] + s->mirror_phi_deg,
                                          radius(s, wi) };
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
        if (present(&s->side[below])) {
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
    char unit_text[32];
};

static struct scale scale_of(const struct surface *s)
{
    const double most = largest(s);
    struct scale c = { .step = 1, .unit = 1, .reach = 1, .steps = 1 };
    if (!(most > 0))
        return c;
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
            const double from = radius(s, both[i]) / c->reach;
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
        const struct side *side = &s->side[below];
        for (size_t i = 0; i < side->theta.n; i++)
            for (size_t k = 0; k < side->phi.n; k++) {
                const double theta = side->theta.deg[i];
                const double phi = side->phi.deg[k];
                const struct pixel p =
                    seen(vec3_scale(radius_at(s, theta, phi) / c->reach,
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
    if (!(largest(s) > 0))
        return;
    const double spoke = numbered_spoke(s, c);
    for (int i = 1; i <= c->steps; i++) {
        char text[64];
        const struct vec3 at = on_plane((double)i / c->steps, spoke);
        snprintf(text, sizeof text, i < c->steps ? "%g" : "%g [%s]",
                 i * c->step / c->unit, c->unit_text);
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
static double lobe_width(const struct surface *s, const struct side *side,
                         const struct scale *c)
{
    const struct peak *p = &side->peak;
    const struct vec3 top = direction(s, p->theta_deg, p->phi_deg);
    const struct vec3 down = direction(s, p->theta_deg + 90, p->phi_deg);
    const struct vec3 way[2] = { down, vec3_cross(top, down) };
    double narrow = 1;
    for (int k = 0; k < 2; k++)
        for (double a = 1e-4; a < narrow; a *= 1.1) {
            const struct vec3 along = vec3_scale(cos(a), top);
            const struct vec3 by = vec3_scale(sin(a), way[k]);
            if (fmax(radius(s, vec3_add(along, by)),
                     radius(s, vec3_add(along, vec3_scale(-1, by)))) <
                p->radius / 2)
                narrow = a;
        }
    return 2 * sin(narrow) * p->radius / 2 / c->reach * RADIUS;
}

/* The lines of the mesh are drawn where there is room for them.  Where there is
 * not, faces that hide each other have about the same radius and colour, so
 * that their order is no matter; and in it gnuplot 5.4 would leave the outlines
 * of an SVG filled with black. */
static void lobe(FILE *out, const struct surface *s, const struct scale *c,
                 bool below)
{
    const double room = 24;
    const struct side *side = &s->side[below];
    const int index = below && present(&s->side[0]) ? 1 : 0;
    fprintf(out, "\n# %s the surface\n", below ? "below" : "above");
    arrows(out, s, c, below);
    if (present(side))
        fprintf(out,
                "set pm3d %s\n"
                "splot table index %d using "
                "($3/%.10g*sin($1)*cos($2-(%.10g))):"
                "($3/%.10g*sin($1)*sin($2-(%.10g))):($3/%.10g*cos($1)):"
                "($3/%.10g) with pm3d\n",
                lobe_width(s, side, c) > room
                    ? "depthorder border lc rgb \"#80000000\" lw 0.15"
                    : "scansautomatic border retrace lw 0.3",
                index, c->reach, s->mirror_phi_deg, c->reach, s->mirror_phi_deg,
                c->reach, c->unit);
    else /* for the arrows and labels */
        fputs("splot '+' using (0):(0):(0) every ::0::0 with dots lc rgb "
              "\"#b8b8b8\"\n",
              out);
    fprintf(out, "unset arrow; unset label%s\n",
            present(side) ? "; unset colorbox" : "");
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
    if (largest(s) > 0)
        snprintf(n.text[n.lines++], SIZE,
                 "radius and colour: f |cos θᵢ|, %s; the same scale along all "
                 "axes",
                 colours_mean_name(bands));
    for (int below = 0; below < 2; below++)
        if (present(&s->side[below])) {
            const struct peak *p = &s->side[below].peak;
            const double phi = named_phi(s, p->phi_deg);
            const bool pole = p->theta_deg == 0 || p->theta_deg == 180;
            int used =
                snprintf(n.text[n.lines++], SIZE,
                         "maximum %s the surface: %.5g/sr at θᵢ = %.5g°",
                         below ? "below" : "above", p->radius, p->theta_deg);
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
    fprintf(fig->script,
            "set colorbox vertical user origin screen %.6g,%.6g size screen "
            "%.6g,%.6g border\n"
            "set cbtics scale 0.5 %.10g format \"%s\"\n",
            BAR / fig->width, from / fig->height, 14 / fig->width,
            (to - from) / fig->height, c->step / c->unit, fig->form->number);
    snprintf(text, sizeof text, "f |cos θᵢ| [%s]", c->unit_text);
    figure_label(fig, BAR + 20, to + 22, "center", text);
}

static void script_write(struct figure *fig, const struct surface *s)
{
    FILE *out = fig->script;
    const struct scale c = scale_of(s);
    const struct angles wo = dir_to_degrees(s->wo);
    const struct notes notes = notes_of(s);
    const bool back = present(&s->side[1]) || s->wo.z < 0 ||
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
            "set palette @heat\n"
            "set cbrange [0:%.10g]\n",
            lowest, lowest, view_down_deg, view_turn_deg, c.reach / c.unit);
    if (largest(s) > 0)
        colour_bar(fig, &c, centre);
    else
        fputs("unset colorbox\n", out);
    plane_labels(fig, s, &c);
    lobe(out, s, &c, true);
    plane(out, s, &c, back);
    lobe(out, s, &c, false);
}

/* -- all of it ------------------------------------------------------------- */

static bool surface_init(struct surface *s, const struct plot_request *r,
                         struct err *err)
{
    const struct angles wo = dir_to_degrees(r->wo[0]);
    s->bsdf = r->bsdf[0];
    s->wo = r->wo[0];
    s->mirror_phi_deg =
        hypot(r->wo[0].x, r->wo[0].y) > 0 ? wo.phi_deg + 180 : 0;
    if (s->mirror_phi_deg > 180)
        s->mirror_phi_deg -= 360;
    s->side[0] = (struct side){ .from_deg = 0, .to_deg = 90 };
    s->side[1] = (struct side){ .from_deg = 90, .to_deg = 180 };
    pilots_draw(&s->pilots, r->bsdf[0], r->wo[0], r->seed);
    for (int below = 0; below < 2; below++)
        peak_find(s, &s->side[below]);
    for (int below = 0; below < 2; below++)
        if (present(&s->side[below]))
            mesh(s, &s->side[below]);
    count_odd(s);
    return largest(s) > 0 || s->pilots.deltas > 0 ||
           err_set(err,
                   "lobe3d: f is not above 0 anywhere for theta %.6g, phi %.6g "
                   "deg; there is nothing to draw",
                   wo.theta_deg, wo.phi_deg);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct surface *s = calloc(1, sizeof *s);
    if (!s)
        return err_set(err, "out of memory");
    const bool ready =
        surface_init(s, r, err) && figure_open(&fig, r->output, &r->look, err);
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
    .heeds = HEEDS_WO,
    .run = run,
};
