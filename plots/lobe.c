/* lobe.c - the BSDF along a cut through the normal, in polar angles
 *
 * Two disks, of f and of f |cos theta_i|, and close-ups of a lobe that is too
 * narrow for them; with logarithms a panel of all angles instead.  One model
 * has a curve for each band; of several models or directions each has one, of
 * the bands' mean.
 */
#include "plots/kinds.h"

#include <stdlib.h>
#include <string.h>

#include "plots/axis.h"
#include "plots/chart.h"
#include "plots/colours.h"
#include "plots/key.h"
#include "plots/polar.h"

/* In pixels. */
enum { PAGE = FIGURE_PAGE, PANEL = 128, ZOOM = 196, LINE = 17 };

/* -- close-ups ------------------------------------------------------------- */

struct window {
    double from, to, half_width; /* [deg] */
};

/* From the largest value outward, as far as it stays above a limit. */
static void around(const struct trace *l, int channel, size_t best,
                   double above, size_t *low, size_t *high)
{
    *low = *high = best;
    while (*low > 0 && l->point[*low].f[channel] > above)
        --*low;
    while (*high + 1 < l->points && l->point[*high].f[channel] > above)
        ++*high;
}

static struct window window_of(const struct trace *l, bool cosine)
{
    const double largest = trace_most(l, cosine);
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
static bool narrow(const struct trace *l)
{
    const double widest_deg = 12;
    return trace_most(l, false) > 0 && trace_most(l, true) > 0 &&
           fmin(window_of(l, false).half_width, window_of(l, true).half_width) <
               widest_deg;
}

/* Over the window of a lobe, or with logarithms over all angles. */
static void panel(struct figure *fig, const struct polar *p, bool cosine,
                  double x, double y)
{
    const struct trace *l = p->trace;
    const double limit = polar_half(p) ? 90 : 180;
    const struct window w = p->log ? (struct window){ -limit, limit, 2 * limit }
                                   : window_of(l, cosine);
    struct chart_mark mark = { .at = l->mirror_deg };
    struct chart c = {
        .x0 = x - 124,
        .x1 = x + 165,
        .y0 = y + 54,
        .y1 = y + 54 + PANEL,
        .x = chart_axis_exact(w.from, w.to, axis_step_deg(w.to - w.from), "θᵢ",
                              "deg"),
        .y = polar_axis(p, cosine),
        .curve = p->curve[cosine],
        .curves = p->curves,
        .mark = &mark,
        .marks = p->traces == 1 && l->incidence,
    };
    chart_draw(fig, &c);
}

/* -- the page -------------------------------------------------------------- */

struct notes {
    char text[DELTAS_MAX + 6][256];
    int lines;
};

enum { NOTE = sizeof((struct notes *)0)->text[0] };

static void note_plane(struct notes *n, const struct polar *p)
{
    const struct trace *l = p->trace;
    bool incidence = true; /* and positive toward the mirror direction */
    for (int i = 0; i < p->traces; i++)
        incidence &= p->trace[i].incidence && p->trace[i].wo_deg <= 0;
    if (incidence)
        snprintf(n->text[n->lines++], NOTE, "θᵢ: angle of ωᵢ to the normal; %s",
                 l->wo_deg == 0 && p->traces == 1
                     ? "positive toward φ = 0"
                     : "negative on the side of ωₒ, positive on the "
                       "side of its mirror direction");
    else
        snprintf(n->text[n->lines++], NOTE,
                 "θᵢ: angle of ωᵢ to the normal in the plane of φ = %.6g°, "
                 "positive toward it%s",
                 l->phi_deg,
                 p->traces == 1 && !l->incidence ? "; ωₒ is not in it" : "");
}

static struct notes notes_of(const struct polar *p)
{
    const struct trace *l = p->trace;
    struct notes n = { .lines = 0 };
    note_plane(&n, p);
    if (p->traces > 1)
        snprintf(n.text[n.lines++], NOTE, "curves: %s",
                 colours_mean_name(bsdf_bands(l->bsdf)));
    if (p->log)
        snprintf(n.text[n.lines++], NOTE,
                 "logarithmic; the middle of a disk is at and below its "
                 "smallest number");
    if (p->traces > 1)
        return n;
    if (l->limit_deg > 90 && trace_most(l, true) > 0) {
        double side[2] = { 0, 0 };
        for (size_t i = 0; i < l->points; i++)
            for (int b = 0; b < l->bands; b++) {
                const bool below = fabs(l->point[i].theta_deg) > 90;
                side[below] = fmax(side[below], l->point[i].f[l->bands + b]);
            }
        snprintf(n.text[n.lines++], NOTE,
                 "largest f |cos θᵢ|: %.4g/sr above the surface, %.4g/sr below",
                 side[0], side[1]);
    }
    for (int k = 0; k < l->pilots.deltas; k++) {
        const struct vec3 w = l->pilots.delta[k].wi;
        delta_text(&l->pilots.delta[k], l->bands,
                   atan2(vec3_dot(w, l->plane), w.z) * (180 / PI),
                   n.text[n.lines++], NOTE);
    }
    if (l->odd > 0)
        snprintf(n.text[n.lines++], NOTE,
                 "f is infinite or not a number at %zu of %zu angles", l->odd,
                 l->points);
    return n;
}

static void title_write(const struct plot_request *r, char *title, size_t size)
{
    size_t n = 0;
    title[0] = '\0';
    for (int i = 0; i < r->bsdfs && n < size; i++)
        n += (size_t)snprintf(title + n, size - n, "%s%s", i ? "\n" : "",
                              bsdf_spec(r->bsdf[i]));
}

/* "omega_o: theta = 45, phi = 0;  R, G, B (fit)" */
static void below_write(const struct plot_request *r, char *below, size_t size)
{
    char bands[96];
    size_t n = (size_t)snprintf(below, size, "ωₒ: ");
    for (int i = 0; i < r->wos && n < size; i++) {
        const struct angles a = dir_to_degrees(r->wo[i]);
        n += (size_t)snprintf(below + n, size - n,
                              i ? " and %.6g°, %.6g°" : "θ = %.6g°, φ = %.6g°",
                              a.theta_deg, a.phi_deg);
    }
    bands_print(bsdf_bands(r->bsdf[0]), bands, sizeof bands);
    if (n < size)
        snprintf(below + n, size - n, ";  %s", bands);
}

static void script_write(struct figure *fig, const struct plot_request *r,
                         const struct polar *p)
{
    const bool any = p->most[0] > 0;
    const bool panels = any && (p->log || (p->traces == 1 && narrow(p->trace)));
    const struct notes notes = notes_of(p);
    const int rows = polar_key_rows(p);
    const double foot = 8 + notes.lines * LINE;
    const double above_key = foot + 10 + rows * KEY_ROW + (panels ? ZOOM : 0);
    const double centre =
        above_key + (polar_half(p) ? POLAR_BELOW : POLAR_BACK);
    char below[400], title[4096];
    title_write(r, title, sizeof title);
    below_write(r, below, sizeof below);
    figure_page(fig, PAGE, centre + POLAR_ABOVE, title, below);
    for (int i = 0; i < notes.lines; i++)
        figure_label(fig, PAGE / 2., foot - LINE * (i + 0.5), "center",
                     notes.text[i]);
    polar_key(fig, p, above_key - KEY_ROW / 2. - 5);
    for (int cosine = 0; cosine < 1 + any; cosine++)
        polar_disk(fig, p, cosine,
                   any ? PAGE * (cosine ? 0.75 : 0.25) : PAGE / 2., centre);
    for (int cosine = 0; cosine < 2 * panels; cosine++)
        panel(fig, p, cosine, PAGE * (cosine ? 0.75 : 0.25), foot);
}

static bool nothing(const struct trace *t, int traces, struct err *err)
{
    const struct angles wo = dir_to_degrees(t->wo);
    for (int i = 0; i < traces; i++)
        if (trace_most(&t[i], false) > 0 || t[i].pilots.deltas > 0)
            return false;
    err_set(err,
            "lobe: f is not above 0 anywhere in the plane of phi = %.6g deg "
            "from theta %.6g, phi %.6g deg; there is nothing to draw",
            t->phi_deg, wo.theta_deg, wo.phi_deg);
    return true;
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct trace *t = calloc(POLAR_TRACES_MAX, sizeof *t);
    int n = 0;
    bool ok = true;
    if (!t)
        return err_set(err, "out of memory");
    if (r->bsdfs * r->wos > POLAR_TRACES_MAX)
        ok = err_set(err,
                     "lobe: %d models from %d directions; expected at most %d "
                     "curves",
                     r->bsdfs, r->wos, POLAR_TRACES_MAX);
    for (int i = 0; ok && i < r->bsdfs; i++)
        for (int k = 0; ok && k < r->wos; k++)
            ok = trace_make(&t[n++], r->bsdf[i], r->wo[k], r->phi_deg, r->log,
                            r->seed, err);
    ok = ok && !nothing(t, n, err) &&
         figure_open(&fig, r->output, &r->look, err);
    if (ok) {
        const struct polar p = polar_of(t, n, r->log);
        polar_table(fig.table, &p);
        script_write(&fig, r, &p);
        plot_caption(&fig, &plot_lobe, r, NULL,
                     "The BSDF f and f |cos θᵢ| [1/sr] along a cut through "
                     "the normal, against the angle of ωᵢ to it.");
        ok = figure_draw(&fig, made, err);
    }
    for (int i = 0; i < n; i++)
        trace_clear(&t[i]);
    free(t);
    return ok;
}

const struct plot plot_lobe = {
    .name = "lobe",
    .about = "f and f |cos| in the plane of incidence or at --phi",
    .heeds = HEEDS_WO | HEEDS_PHI | HEEDS_LOG,
    .models = PLOT_MODELS_MAX,
    .directions = PLOT_DIRECTIONS_MAX,
    .run = run,
};
