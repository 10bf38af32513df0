/* ndf.c - the facets of a model: D, G1 and Lambda, Beckmann's against GGX
 *
 * Along an azimuth (--phi), against the angle to the normal.  What the model
 * itself shows is one line; where it has a choice of distribution the same
 * model with the other one is another.  Lambda = 1 / G1 - 1.
 */
#include <stdlib.h>
#include <string.h>

#include "plots/chart.h"
#include "plots/kinds.h"
#include "plots/table.h"
#include "plots/variant.h"

enum { FACETS_MAX = 2, STEPS = 900 };

struct facets_shown {
    const struct bsdf *bsdf;
    char name[96];
};

struct shown {
    struct facets_shown of[FACETS_MAX];
    struct bsdf *made[FACETS_MAX]; /* owned */
    int n;
    double phi_deg;
    double d_most, d_least, g1_most, lambda_most, lambda_least;
    double theta_deg; /* as far as D is worth drawing */
};

/* Both distributions of a model, or the model alone. */
static bool gather(struct shown *s, const struct bsdf *b, struct err *err)
{
    static const char *const families[] = { "beckmann", "ggx" };
    static const char *const names[] = { "Beckmann", "GGX" };
    if (!bsdf_has_facets(b))
        return err_set(err,
                       "ndf: %s shows no facets; expected a microfacet model, "
                       "as roughconductor or roughdielectric",
                       bsdf_type(b)->name);
    if (!variant_has(b, "distribution")) {
        s->of[s->n].bsdf = b;
        snprintf(s->of[s->n++].name, sizeof s->of[0].name, "%s",
                 bsdf_type(b)->name);
        return true;
    }
    for (int i = 0; i < 2; i++) {
        const struct variant v[] = { { "distribution", families[i] } };
        s->made[i] = variant_new(b, v, 1, err);
        if (!s->made[i])
            return false;
        s->of[s->n].bsdf = s->made[i];
        snprintf(s->of[s->n++].name, sizeof s->of[0].name, "%s", names[i]);
    }
    return true;
}

static struct vec3 at(const struct shown *s, double theta_deg)
{
    return dir_from_degrees(theta_deg, s->phi_deg);
}

/* Out to where both D have fallen to half a percent of their largest. */
static void range(struct shown *s)
{
    for (int i = 0; i < s->n; i++)
        for (int k = 0; k < STEPS; k++)
            s->d_most = fmax(
                s->d_most, bsdf_facet_d(s->of[i].bsdf, at(s, 90. * k / STEPS)));
    s->d_least = s->d_most * 1e-6;
    s->theta_deg = 0.05;
    for (int i = 0; i < s->n; i++)
        for (double deg = 90; deg > s->theta_deg; deg -= 0.05)
            if (bsdf_facet_d(s->of[i].bsdf, at(s, deg)) > s->d_most * 5e-3) {
                s->theta_deg = deg;
                break;
            }
}

static void table_write(FILE *out, struct shown *s, const struct bsdf *b)
{
    table_comment(out, "made by", "bsdf-plot ndf");
    table_comment(out, "spec", bsdf_spec(b));
    fprintf(out, "# phi: %.10g deg\n", s->phi_deg);
    s->lambda_least = INFINITY;
    for (int i = 0; i < s->n; i++) {
        const struct bsdf *f = s->of[i].bsdf;
        fprintf(out,
                "%s# %s\n# theta [deg]\tD [1/sr]\tD cos [1/sr]\tG1 [1]\tLambda "
                "[1]\ttheta as far as D is drawn [deg]\tD there [1/sr]\n",
                i ? "\n\n" : "", s->of[i].name);
        for (int k = 0; k <= STEPS; k++) {
            const double deg = 90. * k / STEPS;
            const double near = s->theta_deg * k / STEPS;
            const struct vec3 w = at(s, deg);
            const double d = bsdf_facet_d(f, w), g1 = bsdf_facet_g1(f, w);
            const double lambda = 1 / g1 - 1;
            const double row[] = {
                deg, d, d * w.z, g1, lambda, near, bsdf_facet_d(f, at(s, near))
            };
            if (isfinite(g1)) /* a faulty one exceeds 1 */
                s->g1_most = fmax(s->g1_most, g1);
            if (deg < 89.5)
                s->lambda_most = fmax(s->lambda_most, lambda);
            if (lambda > 0 && deg > 10)
                s->lambda_least = fmin(s->lambda_least, lambda);
            table_row(out, row, sizeof row / sizeof *row);
        }
    }
    s->lambda_most = fmax(s->lambda_most, 1e-3);
    s->lambda_least =
        fmax(fmin(s->lambda_least, s->lambda_most / 10), s->lambda_most * 1e-6);
}

enum { PANEL = 190, GAP = 74 };

static void panel(struct figure *fig, const struct shown *s, int column,
                  double bottom, const char *x, const char *y,
                  struct chart_axis x_axis, struct chart_axis y_axis)
{
    struct chart_curve curve[FACETS_MAX];
    struct chart c = { .y0 = bottom,
                       .y1 = bottom + PANEL,
                       .x = x_axis,
                       .y = y_axis,
                       .curve = curve,
                       .curves = s->n };
    for (int i = 0; i < s->n; i++) {
        curve[i] = (struct chart_curve){ .block = i, .line = i ? 3 : 1 };
        snprintf(curve[i].x, sizeof curve[i].x, "%s", x);
        snprintf(curve[i].y, sizeof curve[i].y, "%s", y);
    }
    chart_column(&c, column, 2, false);
    chart_draw(fig, &c);
}

static void script_write(struct figure *fig, const struct shown *s,
                         const struct bsdf *b)
{
    struct chart_curve key[FACETS_MAX];
    char note[160];
    const double foot = 12 + CHART_NOTE;
    const double lower = foot + 34 + CHART_BELOW;
    const double upper = lower + PANEL + GAP;
    const struct chart_axis whole = chart_axis_exact(0, 90, 15, "θ", "deg");
    const struct chart_axis near =
        chart_axis_exact(0, s->theta_deg, 0, "θ", "deg");
    for (int i = 0; i < s->n; i++) {
        key[i] = (struct chart_curve){ .line = i ? 3 : 1 };
        snprintf(key[i].text, sizeof key[i].text, "%s", s->of[i].name);
    }
    snprintf(note, sizeof note,
             "θ: angle of the facet's normal (D) or of the direction (G1, Λ) "
             "to the surface's, at φ = %.6g°",
             s->phi_deg);
    figure_page(fig, FIGURE_PAGE, upper + PANEL + 22, bsdf_spec(b),
                "distribution D of the facets' normals, Smith's masking G1 = "
                "1/(1 + Λ)");
    chart_notes(fig, foot, (const char *[]){ note }, 1);
    chart_key(fig, key, s->n, foot + 14);
    panel(fig, s, 0, upper, "$6", "$7", near,
          chart_axis(0, s->d_most, 5, "D", "1/sr"));
    panel(fig, s, 1, upper, "$1", "$2", whole,
          chart_axis_log(s->d_least, s->d_most, "D", "1/sr"));
    panel(fig, s, 0, lower, "$1", "$4", whole,
          chart_axis(0, fmax(s->g1_most, 1), 5, "G1", "1"));
    panel(fig, s, 1, lower, "$1", "$5", whole,
          chart_axis_log(s->lambda_least, s->lambda_most, "Λ", "1"));
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct shown s = { .phi_deg = isnan(r->phi_deg) ? 0 : r->phi_deg };
    bool ok = gather(&s, r->bsdf[0], err);
    if (ok)
        range(&s);
    ok = ok && figure_open(&fig, r->output, &r->look, err);
    if (ok) {
        table_write(fig.table, &s, r->bsdf[0]);
        script_write(&fig, &s, r->bsdf[0]);
        plot_caption(&fig, &plot_ndf, r, NULL,
                     "Distribution D of the facets' normals [1/sr], near the "
                     "normal and in logarithms, Smith's masking G1 and its Λ "
                     "[1].");
        ok = figure_draw(&fig, made, err);
    }
    for (int i = 0; i < FACETS_MAX; i++)
        bsdf_free(s.made[i]);
    if (ok)
        err->text[0] = '\0'; /* the model's own warning was given already */
    return ok;
}

const struct plot plot_ndf = {
    .name = "ndf",
    .about = "D, G1 and Lambda of a model's facets, Beckmann's against GGX",
    .heeds = HEEDS_PHI,
    .run = run,
};
