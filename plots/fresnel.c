/* fresnel.c - reflectance of a smooth interface, and what stands in for it
 *
 * Of a metal a column for each band: s, p and unpolarised light, exact; the
 * write-up's approximation and Schlick's; and what the two are off by.  Of
 * glass a column for light from above and one for light from below.
 *
 *   q^2 = n^2 - sin^2,  r_s = (c - q) / (c + q),  r_p = (n^2 c - q) / (n^2 c +
 * q)
 *
 * with n = eta + i k the relative index and c the cosine of incidence.
 *
 * M. Born and E. Wolf, Principles of Optics, 7th ed., 1999, sec. 1.5.2, 14.2;
 * for a metal the pseudo-Brewster angle is where r_p is least.
 */
#include "bsdf/fresnel.h"

#include <complex.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_min.h>
#include <string.h>

#include "plots/chart.h"
#include "plots/kinds.h"
#include "plots/table.h"

enum { STEPS = 360, COLUMNS_MAX = BANDS_MAX };

/* An interface as light of one column meets it. */
struct side {
    char name[32], index[64];
    double eta, k;                     /* of what is beyond, relative */
    bool approximate;                  /* the write-up's form is for metals */
    double brewster_deg, critical_deg; /* NaN where there is none */
};

struct interface {
    struct side side[COLUMNS_MAX];
    int sides;
    double worst; /* of the differences */
};

static double complex root(const struct side *s, double c)
{
    const double complex n = s->eta + I * s->k;
    return csqrt((n - 1) * (n + 1) + c * c);
}

static double squared(double complex r)
{
    return creal(r) * creal(r) + cimag(r) * cimag(r);
}

static double reflectance_s(const struct side *s, double c)
{
    const double complex q = root(s, c);
    return squared((c - q) / (c + q));
}

static double reflectance_p(const struct side *s, double c)
{
    const double complex n = s->eta + I * s->k, q = root(s, c);
    return squared((n * n * c - q) / (n * n * c + q));
}

static double exact(const struct side *s, double c)
{
    return s->k > 0 ? fresnel_conductor(c, s->eta, s->k)
                    : fresnel_dielectric(c, s->eta, NULL);
}

/* In the thinner medium, as the models have it. */
static double schlick(const struct side *s, double c)
{
    double cos_t = c;
    if (s->k == 0 && s->eta < 1) {
        fresnel_dielectric(c, s->eta, &cos_t);
        if (cos_t == 0)
            return 1;
    }
    return fresnel_schlick(cos_t, exact(s, 1));
}

static double p_at(double deg, void *side)
{
    return reflectance_p(side, cos(deg * PI / 180));
}

/* Where r_p is least, from a grid and then by Brent's method. */
static double least_p_deg(struct side *s)
{
    gsl_function f = { p_at, s };
    gsl_min_fminimizer *m = gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent);
    double best = 1;
    for (int deg = 1; deg < 90; deg++)
        if (p_at(deg, s) < p_at(best, s))
            best = deg;
    double at = NAN;
    if (m && gsl_min_fminimizer_set(m, &f, best, best - 1, best + 1) ==
                 GSL_SUCCESS) {
        for (int i = 0; i < 60; i++)
            gsl_min_fminimizer_iterate(m);
        at = gsl_min_fminimizer_x_minimum(m);
    }
    if (m)
        gsl_min_fminimizer_free(m);
    return at;
}

static void side_add(struct interface *f, double eta, double k,
                     const char *name)
{
    struct side *s = &f->side[f->sides++];
    const double deg = 180 / PI;
    *s = (struct side){ .eta = eta,
                        .k = k,
                        .approximate = k > 0,
                        .brewster_deg = NAN,
                        .critical_deg = NAN };
    snprintf(s->name, sizeof s->name, "%s", name);
    if (k > 0)
        snprintf(s->index, sizeof s->index, "n = %.4g, k = %.4g", eta, k);
    else
        snprintf(s->index, sizeof s->index, "n = %.6g", eta);
    if (k > 0)
        s->brewster_deg = least_p_deg(s);
    else if (eta != 1)
        s->brewster_deg = atan(eta) * deg;
    if (k == 0 && eta < 1)
        s->critical_deg = asin(eta) * deg;
}

static bool interface_of(struct interface *f, const struct bsdf *b,
                         struct err *err)
{
    const struct bands *bands = bsdf_bands(b);
    struct spectrum eta = { { 0 } }, k = { { 0 } };
    bool same = true;
    if (!bsdf_index(b, &eta, &k))
        return err_set(err,
                       "fresnel: %s has no interface with an index; expected a "
                       "metal or glass, as conductor:material=Ca or "
                       "dielectric:int_ior=1.5",
                       bsdf_type(b)->name);
    *f = (struct interface){ .sides = 0 };
    for (int i = 1; i < bands->count; i++)
        same &= eta.band[i] == eta.band[0] && k.band[i] == k.band[0];
    if (same && k.band[0] == 0) {
        side_add(f, eta.band[0], 0, "from above");
        side_add(f, 1 / eta.band[0], 0, "from below");
        return true;
    }
    for (int i = 0; i < (same ? 1 : bands->count); i++) {
        char name[32];
        bands_print_one(bands, i, name, sizeof name);
        side_add(f, eta.band[i], k.band[i],
                 same && bands->count > 1 ? "all bands" : name);
    }
    return true;
}

/* A block for each column. */
static void table_write(FILE *out, struct interface *f, const struct bsdf *b)
{
    table_comment(out, "made by", "bsdf-plot fresnel");
    table_comment(out, "spec", bsdf_spec(b));
    for (int i = 0; i < f->sides; i++) {
        const struct side *s = &f->side[i];
        fprintf(out,
                "%s# %s: %s\n# theta [deg]\ts [1]\tp [1]\tunpolarised [1]\t"
                "write-up's approximation [1]\tSchlick's [1]\tthe former's "
                "error [1]\tthe latter's error [1]\n",
                i ? "\n\n" : "", s->name, s->index);
        for (int k = 0; k <= STEPS; k++) {
            const double deg = 90. * k / STEPS;
            const double c = k == STEPS ? 0 : cos(deg * PI / 180);
            const double r = exact(s, c);
            const double a = s->approximate
                                 ? fresnel_conductor_approx(c, s->eta, s->k)
                                 : NAN;
            const double row[] = { deg,
                                   reflectance_s(s, c),
                                   reflectance_p(s, c),
                                   r,
                                   a,
                                   schlick(s, c),
                                   a - r,
                                   schlick(s, c) - r };
            table_row(out, row, sizeof row / sizeof *row);
            f->worst = fmax(f->worst, fabs(schlick(s, c) - r));
            if (s->approximate)
                f->worst = fmax(f->worst, fabs(a - r));
        }
    }
}

/* -- the picture ----------------------------------------------------------- */

enum { PANEL = 230, BELOW = 130, CURVES = 5 };

/* What the columns of the table are drawn as. */
static const struct {
    const char *text;
    int line;
} looks[CURVES] = { { "s", 3 },
                    { "p", 1 },
                    { "unpolarised, exact", LINE_ONLY },
                    { "write-up's approximation", 5 },
                    { "Schlick's", 2 } };

static int curves_of(const struct interface *f, int block,
                     struct chart_curve *curve)
{
    int n = 0;
    for (int i = 0; i < CURVES; i++) {
        if (i == 3 && !f->side[block].approximate)
            continue;
        struct chart_curve *c = &curve[n++];
        *c = (struct chart_curve){ .block = block,
                                   .x = "$1",
                                   .line = looks[i].line };
        snprintf(c->y, sizeof c->y, "$%d", 2 + i);
        snprintf(c->text, sizeof c->text, "%s", looks[i].text);
    }
    return n;
}

static void column(struct figure *fig, const struct interface *f, int i,
                   double bottom)
{
    const struct side *s = &f->side[i];
    struct chart_curve curve[CURVES];
    struct chart_mark mark[2] = { { .at = s->brewster_deg },
                                  { .at = s->critical_deg } };
    const int n = curves_of(f, i, curve);
    struct chart c = {
        .y0 = bottom + BELOW + 44,
        .y1 = bottom + BELOW + 44 + PANEL,
        .x = chart_axis_exact(0, 90, 30, "θᵢ", "deg"),
        .y = chart_axis_exact(0, 1, 0.2, "reflectance", "1"),
        .bare_x = true,
        .curve = curve,
        .curves = n,
        .mark = mark,
        .marks = 2,
    };
    chart_column(&c, i, f->sides, true);
    figure_label(fig, (c.x0 + c.x1) / 2, c.y1 + 34 + CHART_NOTE, "center",
                 s->name);
    figure_label(fig, (c.x0 + c.x1) / 2, c.y1 + 34, "center", s->index);
    if (!isnan(s->brewster_deg))
        snprintf(mark[0].text, sizeof mark[0].text, "%s%.4g°",
                 f->sides > 3 ? ""
                 : s->k > 0   ? "pseudo-B. "
                              : "Brewster ",
                 s->brewster_deg);
    if (!isnan(s->critical_deg))
        snprintf(mark[1].text, sizeof mark[1].text, "critical %.4g°",
                 s->critical_deg);
    /* The two are close to each other in dense glass: the second below. */
    if (!isnan(s->critical_deg)) {
        figure_label_at(
            fig, mark[1].text, "screen %.6g,%.6g left tc rgb \"#505050\"",
            (c.x0 + (c.x1 - c.x0) * s->critical_deg / 90 + 8) / fig->width,
            (c.y0 + 0.5 * PANEL) / fig->height);
        mark[1].text[0] = '\0';
    }
    chart_draw(fig, &c);
    for (int k = 3, at = 0; k < n; k++, at++) {
        curve[at] = curve[k];
        snprintf(curve[at].y, sizeof curve[at].y, "$%d",
                 s->approximate && at == 0 ? 7 : 8);
    }
    c.curves = 1 + s->approximate;
    c.y0 = bottom;
    c.y1 = bottom + BELOW;
    c.bare_x = false;
    c.y = chart_axis(-f->worst, f->worst, 6, "approximate − exact", "1");
    mark[0].text[0] = '\0';
    chart_draw(fig, &c);
}

static void script_write(struct figure *fig, const struct interface *f,
                         const struct bsdf *b)
{
    static const char *const notes[] = {
        "θᵢ: angle of incidence; Schlick's R₀ is the exact reflectance at 0°, "
        "its angle the one in the thinner medium",
        "thin line: pseudo-Brewster angle, where p is least",
        "thin lines: Brewster's angle, where p is 0, and the critical angle, "
        "beyond which all is reflected",
    };
    char bands[96];
    struct chart_curve key[CURVES];
    const bool metal = f->side[0].k > 0;
    const int n = curves_of(f, 0, key), rows = chart_key_rows(key, n);
    const double foot = 12 + 2 * CHART_NOTE;
    const double bottom = foot + rows * 20 + 14 + CHART_BELOW;
    bands_print(bsdf_bands(b), bands, sizeof bands);
    figure_page(fig, FIGURE_PAGE, bottom + BELOW + 44 + PANEL + 54 + CHART_NOTE,
                bsdf_spec(b), bands);
    chart_notes(fig, foot - 2,
                (const char *[]){ notes[0], notes[metal ? 1 : 2] }, 2);
    chart_key(fig, key, n, foot + 8 + (rows - 1) * 20 + 4);
    for (int i = 0; i < f->sides; i++)
        column(fig, f, i, bottom);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct interface f = { .sides = 0 };
    if (!interface_of(&f, r->bsdf[0], err) ||
        !figure_open(&fig, r->output, &r->look, err))
        return false;
    table_write(fig.table, &f, r->bsdf[0]);
    script_write(&fig, &f, r->bsdf[0]);
    plot_caption(&fig, &plot_fresnel, r, NULL,
                 "Reflectance of the smooth interface against the angle of "
                 "incidence: exact, for s, p and unpolarised light, by "
                 "approximations, and what these are off by.");
    return figure_draw(&fig, made, err);
}

const struct plot plot_fresnel = {
    .name = "fresnel",
    .about = "reflectance of the interface: exact, approximate, differences",
    .run = run,
};
