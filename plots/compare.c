/* compare.c - two models side by side, and what they differ by
 *
 * Polar cuts of both; the ratio and the difference of f |cos theta_i| along the
 * cut; albedos of both against theta_o, from mean weights and at a few angles
 * by quadrature.  All of it is the bands' mean.  The second model is held
 * against the first.
 */
#include <stdlib.h>
#include <string.h>

#include "plots/colours.h"
#include "plots/key.h"
#include "plots/kinds.h"
#include "plots/polar.h"
#include "plots/table.h"
#include "plots/variant.h"

enum { ANGLES = 46, EXACT = 5 };
/* Where the first is below this share of its largest value there is no ratio.
 */
static const double ratio_floor = 1e-6;
/* The axis of ratios is no narrower than 1 and this to either side. */
static const double ratio_room = 0.01;
static const double last_deg = 89.5;

struct comparison {
    struct trace trace[2];
    struct polar polar;
    double phi_deg; /* of wo, for the albedos */
    uint64_t seed, samples;
    double albedo[2][ANGLES], exact[2][EXACT];
    double ratio_lo, ratio_hi;   /* of those above 0 */
    bool ratio_none, ratio_zero; /* nowhere a ratio; somewhere 0 */
    double difference;
};

static double angle_of(int i)
{
    return fmin(2. * i, last_deg);
}

static double exact_of(int i)
{
    return 20. * i;
}

static double mean_at(const struct trace *t, double theta_deg)
{
    const struct vec3 w = dir_from_degrees(theta_deg, 0);
    const struct vec3 wi = { w.x * t->plane.x, w.x * t->plane.y, w.z };
    return colours_mean(bsdf_bands(t->bsdf), bsdf_eval(t->bsdf, t->wo, wi)) *
           fabs(w.z);
}

static double mean_of(const struct bsdf *b, const struct estimate *a)
{
    struct spectrum v = { { 0 } };
    for (int i = 0; i < bsdf_bands(b)->count; i++)
        v.band[i] = a[i].value;
    return colours_mean(bsdf_bands(b), v);
}

static bool albedos(struct comparison *c, struct err *err)
{
    bool ok = true;
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < 2 * (EXACT + ANGLES); k++) {
        const int i = k / 2, m = k % 2;
        const struct bsdf *b = c->trace[m].bsdf;
        struct estimate a[BANDS_MAX];
        struct err why;
        if (i >= EXACT) {
            variant_weights(b,
                            dir_from_degrees(angle_of(i - EXACT), c->phi_deg),
                            c->seed, c->samples, a);
            c->albedo[m][i - EXACT] = mean_of(b, a);
        } else if (variant_albedo(b, dir_from_degrees(exact_of(i), c->phi_deg),
                                  c->seed, a, &why)) {
            c->exact[m][i] = mean_of(b, a);
        } else {
#pragma omp critical(compare_albedos)
            ok = err_set(err, "compare: %s", why.text);
        }
    }
    return ok;
}

/* NaN where there is none. */
static double ratio_of(double x, double y, double floor)
{
    return x > floor && (y > floor || y == 0) ? y / x : NAN;
}

static void ratio_add(struct comparison *c, double ratio)
{
    c->ratio_none &= isnan(ratio);
    c->ratio_zero |= ratio == 0;
    if (ratio > 0) {
        c->ratio_lo = fmin(c->ratio_lo, ratio);
        c->ratio_hi = fmax(c->ratio_hi, ratio);
    }
}

/* Angles of both traces, in order. */
static void differences_write(FILE *out, struct comparison *c)
{
    const struct trace *a = &c->trace[0], *b = &c->trace[1];
    const double floor = ratio_floor * c->polar.most[1];
    size_t i = 0, k = 0;
    double last = NAN;
    c->ratio_lo = INFINITY;
    c->ratio_none = true;
    fputs("\n\n# theta_i [deg]\tf |cos theta_i| of the first [1/sr]\tof the "
          "second [1/sr]\tsecond / first [1]\tsecond - first [1/sr]\n",
          out);
    while (i < a->points || k < b->points) {
        const bool first =
            k == b->points ||
            (i < a->points && a->point[i].theta_deg <= b->point[k].theta_deg);
        const double deg =
            first ? a->point[i++].theta_deg : b->point[k++].theta_deg;
        if (deg == last)
            continue;
        last = deg;
        const double x = mean_at(a, deg), y = mean_at(b, deg);
        const double ratio = ratio_of(x, y, floor);
        ratio_add(c, ratio);
        if (isfinite(y - x))
            c->difference = fmax(c->difference, fabs(y - x));
        table_row(out, (double[]){ deg, x, y, ratio, y - x }, 5);
    }
}

static void albedos_write(FILE *out, const struct comparison *c)
{
    for (int exact = 0; exact < 2; exact++) {
        fprintf(out,
                "\n\n# albedo %s\n# theta_o [deg]\tof the first [1]\tof the "
                "second [1]\tsecond - first [1]\n",
                exact ? "by quadrature" : "from mean weights");
        for (int i = 0; i < (exact ? EXACT : ANGLES); i++) {
            const double a = exact ? c->exact[0][i] : c->albedo[0][i];
            const double b = exact ? c->exact[1][i] : c->albedo[1][i];
            table_row(
                out,
                (double[]){ exact ? exact_of(i) : angle_of(i), a, b, b - a },
                4);
        }
    }
}

/* -- the picture ----------------------------------------------------------- */

enum { PANEL = 150, GAP = CHART_BELOW + CHART_ABOVE + 12 };

static void panel(struct figure *fig, int column, double bottom,
                  const char *title, struct chart_axis x, struct chart_axis y,
                  const struct chart_curve *curve, int n, double across)
{
    const struct chart_mark mark = { .across = true, .at = across };
    struct chart c = { .y0 = bottom,
                       .y1 = bottom + PANEL,
                       .title = title,
                       .x = x,
                       .y = y,
                       .curve = curve,
                       .curves = n,
                       .mark = &mark,
                       .marks = isnan(across) ? 0 : 1 };
    chart_column(&c, column, 2, false);
    chart_draw(fig, &c);
}

/* The ratio in logarithms where it is more than tenfold. */
static struct chart_axis ratio_axis(const struct comparison *c)
{
    static const char what[] = "ratio";
    const double lo = c->ratio_zero ? 0 : fmin(c->ratio_lo, 1 - ratio_room);
    if (c->ratio_hi > 10 * c->ratio_lo)
        return chart_axis_log(c->ratio_lo, c->ratio_hi, what, "1");
    return chart_axis(lo, fmax(c->ratio_hi, 1 + ratio_room), 5, what, "1");
}

static const char *ratio_title(const struct comparison *c)
{
    return c->ratio_none      ? "f, second / first: none, the first is 0"
           : c->ratio_hi == 0 ? "f, second / first: 0, as the second is"
           : c->ratio_zero && c->ratio_hi > 10 * c->ratio_lo
               ? "f, second / first; blank where either is 0"
               : "f, second / first";
}

static struct chart_axis about_zero(double most, const char *what,
                                    const char *unit)
{
    return chart_axis(-fmax(most, 1e-12), fmax(most, 1e-12), 5, what, unit);
}

static void differences(struct figure *fig, const struct comparison *c,
                        int block, double bottom)
{
    const double limit = polar_half(&c->polar) ? 90 : 180;
    const struct chart_axis x =
        chart_axis_exact(-limit, limit, limit / 3, "θᵢ", "deg");
    struct chart_curve curve = {
        .block = block, .x = "$1", .y = "$4", .line = LINE_ONLY
    };
    panel(fig, 0, bottom, ratio_title(c), x, ratio_axis(c), &curve, 1, 1);
    strcpy(curve.y, "$5");
    panel(fig, 1, bottom, "f |cos θᵢ|, second − first", x,
          about_zero(c->difference, "difference", "1/sr"), &curve, 1, 0);
}

static void albedo_panels(struct figure *fig, const struct comparison *c,
                          int block, double bottom)
{
    const struct chart_axis x = chart_axis_exact(0, 90, 30, "θₒ", "deg");
    struct chart_curve curve[4];
    double most = 1, apart = 0;
    for (int i = 0; i < ANGLES; i++) {
        most = fmax(most, fmax(c->albedo[0][i], c->albedo[1][i]));
        apart = fmax(apart, fabs(c->albedo[1][i] - c->albedo[0][i]));
    }
    for (int i = 0; i < 4; i++) {
        const int m = i % 2, exact = i / 2;
        curve[i] =
            (struct chart_curve){ .block = block + exact,
                                  .x = "$1",
                                  .line = 1 + m,
                                  .as = exact ? CHART_POINTS : CHART_LINE,
                                  .point = 6 };
        snprintf(curve[i].y, sizeof curve[i].y, "$%d", 2 + m);
    }
    panel(fig, 0, bottom, "albedo", x, chart_axis(0, most, 5, "albedo", "1"),
          curve, 4, NAN);
    for (int exact = 0; exact < 2; exact++) {
        curve[exact] = curve[2 * exact];
        curve[exact].line = LINE_ONLY;
        strcpy(curve[exact].y, "$4");
    }
    panel(fig, 1, bottom, "albedo, second − first", x,
          about_zero(apart, "difference", "1"), curve, 2, 0);
}

static void script_write(struct figure *fig, const struct comparison *c,
                         const struct plot_request *r)
{
    const struct trace *t = c->trace;
    const int block = 2 + (t[0].pilots.deltas > 0) + (t[1].pilots.deltas > 0);
    const int rows = polar_key_rows(&c->polar);
    const double foot = 12 + 2 * CHART_NOTE;
    const double albedo_y = foot + 8 + CHART_BELOW;
    const double difference_y = albedo_y + PANEL + GAP;
    const double key_y =
        difference_y + PANEL + CHART_ABOVE + 14 + (rows - 1) * KEY_ROW;
    const double centre =
        key_y + 16 + (polar_half(&c->polar) ? POLAR_BELOW : POLAR_BACK);
    const struct angles wo = dir_to_degrees(r->wo[0]);
    char title[4096], below[200], bands[96], note[200];
    snprintf(title, sizeof title, "%s\n%s", bsdf_spec(r->bsdf[0]),
             bsdf_spec(r->bsdf[1]));
    bands_print(&r->bands, bands, sizeof bands);
    snprintf(below, sizeof below, "ωₒ: θ = %.6g°, φ = %.6g°;  %s", wo.theta_deg,
             wo.phi_deg, bands);
    snprintf(note, sizeof note,
             "circles: albedo by quadrature; lines: mean weights of %llu "
             "samples, ωₒ at φ = %.6g°",
             (unsigned long long)c->samples, c->phi_deg);
    figure_page(fig, FIGURE_PAGE, centre + POLAR_ABOVE, title, below);
    chart_notes(fig, foot,
                (const char *[]){ colours_mean_name(&r->bands), note }, 2);
    polar_key(fig, &c->polar, key_y);
    for (int cosine = 0; cosine < 2; cosine++)
        polar_disk(fig, &c->polar, cosine, FIGURE_PAGE * (cosine ? 0.75 : 0.25),
                   centre);
    differences(fig, c, block, difference_y);
    albedo_panels(fig, c, block + 1, albedo_y);
}

static bool comparison_make(struct comparison *c, const struct plot_request *r,
                            struct err *err)
{
    for (int i = 0; i < 2; i++)
        if (!trace_make(&c->trace[i], r->bsdf[i], r->wo[0], r->phi_deg, r->log,
                        r->seed, err))
            return false;
    c->polar = polar_of(c->trace, 2, r->log);
    c->phi_deg = dir_to_degrees(r->wo[0]).phi_deg;
    c->seed = r->seed;
    c->samples = (uint64_t)fmin(fmax((double)r->samples / 50, 1000), 1e5);
    return albedos(c, err);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct comparison *c = calloc(1, sizeof *c);
    if (!c)
        return err_set(err, "out of memory");
    bool ok = comparison_make(c, r, err) &&
              figure_open(&fig, r->output, &r->look, err);
    if (ok) {
        polar_table(fig.table, &c->polar);
        differences_write(fig.table, c);
        albedos_write(fig.table, c);
        script_write(&fig, c, r);
        plot_caption(&fig, &plot_compare, r, NULL,
                     "Two models: polar cuts, ratio and difference along the "
                     "cut, albedos and their difference.");
        ok = figure_draw(&fig, made, err);
    }
    for (int i = 0; i < 2; i++)
        trace_clear(&c->trace[i]);
    free(c);
    return ok;
}

const struct plot plot_compare = {
    .name = "compare",
    .about = "two models: cuts, ratio, difference, albedos",
    .heeds = HEEDS_WO | HEEDS_PHI | HEEDS_LOG | HEEDS_SAMPLES,
    .models = 2,
    .models_least = 2,
    .run = run,
};
