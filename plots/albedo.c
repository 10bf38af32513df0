/* albedo.c - the share of light that comes back, and what is lost
 *
 * Against the angle of wo for each band: lines from mean weights, points by
 * quadrature.  For a model with a roughness against both: curves at a few
 * angles, and maps of what is lost, 1 - albedo, of the bands' mean.  A metal
 * has a second map with a reflectance of 1, where what is lost is what single
 * scattering leaves out.
 */
#include <stdlib.h>
#include <string.h>

#include "plots/chart.h"
#include "plots/colours.h"
#include "plots/kinds.h"
#include "plots/table.h"
#include "plots/variant.h"

enum { ANGLES = 46, EXACT = 5, MAPS = 2, ROUGH = 16, TILTS = 15, CUTS = 4 };

/* The last angle: at 90 degrees there is nothing. */
static const double last_deg = 89.5;
/* Rows of the map that are curves as well. */
static const int cut[CUTS] = { 0, 7, 12, 14 };

struct share {
    struct estimate albedo[BANDS_MAX];
    double mean; /* of the bands */
};

struct loss {
    const struct bsdf *bsdf;
    double phi_deg;
    uint64_t seed, samples; /* of each mean weight */
    double error;           /* the largest standard error of those */
    struct share at[ANGLES], exact[EXACT];
    bool rough; /* there are maps */
    int maps;
    struct share map[MAPS][ROUGH][TILTS];
    bool same; /* all bands */
    double most, least;
};

static double angle_of(int i)
{
    return fmin(2. * i, last_deg);
}

static double exact_of(int i)
{
    return 20. * i;
}

static double tilt_of(int i)
{
    return (i + 0.5) * 90 / TILTS;
}

static double alpha_of(int i)
{
    return (i + 0.5) / ROUGH;
}

static bool share_of(struct share *s, const struct loss *l,
                     const struct bsdf *b, double theta_deg, bool quadrature,
                     struct err *err)
{
    const struct vec3 wo = dir_from_degrees(theta_deg, l->phi_deg);
    struct spectrum value = { { 0 } };
    if (!quadrature)
        variant_weights(b, wo, l->seed, l->samples, s->albedo);
    else if (!variant_albedo(b, wo, l->seed, s->albedo, err))
        return false;
    for (int i = 0; i < bsdf_bands(b)->count; i++)
        value.band[i] = s->albedo[i].value;
    s->mean = colours_mean(bsdf_bands(b), value);
    return true;
}

/* One of the maps: as it is, or without absorption. */
static bool map_make(struct loss *l, int map, struct err *err)
{
    bool ok = true;
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < ROUGH; i++) {
        char alpha[32];
        struct err why;
        snprintf(alpha, sizeof alpha, "%.17g", alpha_of(i));
        const struct variant v[] = {
            { "alpha_u", NULL }, { "alpha_v", NULL }, { "alpha", alpha },
            { "eta", NULL },     { "k", NULL },       { "material", "none" },
        };
        struct bsdf *b = variant_new(l->bsdf, v, map ? 6 : 3, &why);
        bool good = b;
        for (int k = 0; good && k < TILTS; k++)
            good = share_of(&l->map[map][i][k], l, b, tilt_of(k), false, &why);
        bsdf_free(b);
        if (!good)
#pragma omp critical(albedo_map)
            ok = err_set(err, "albedo: %s", why.text);
    }
    return ok;
}

static bool loss_make(struct loss *l, struct err *err)
{
    bool ok = true;
    l->rough = variant_has(l->bsdf, "alpha");
    l->maps = l->rough ? 1 + variant_has(l->bsdf, "material") : 0;
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < ANGLES + EXACT; i++) {
        const int k = EXACT - 1 - i; /* what takes long first */
        struct err why;
        if (k >= 0
                ? !share_of(&l->exact[k], l, l->bsdf, exact_of(k), true, &why)
                : !share_of(&l->at[i - EXACT], l, l->bsdf, angle_of(i - EXACT),
                            false, &why))
#pragma omp critical(albedo_map)
            ok = err_set(err, "albedo: %s", why.text);
    }
    for (int m = 0; ok && m < l->maps; m++)
        ok = map_make(l, m, err);
    for (int m = 0; m < l->maps; m++)
        for (int i = 0; i < ROUGH; i++)
            for (int k = 0; k < TILTS; k++)
                for (int b = 0; b < bsdf_bands(l->bsdf)->count; b++)
                    l->error = fmax(l->error, l->map[m][i][k].albedo[b].error);
    l->same = true;
    for (int i = 0; i < ANGLES; i++)
        for (int b = 0; b < bsdf_bands(l->bsdf)->count; b++) {
            const double a = l->at[i].albedo[b].value;
            l->error = fmax(l->error, l->at[i].albedo[b].error);
            l->same &= a == l->at[i].albedo[0].value;
            l->most = fmax(l->most, a);
        }
    return ok;
}

/* -- the table ------------------------------------------------------------- */

static void rows_write(FILE *out, const struct loss *l, bool exact)
{
    const struct bands *bands = bsdf_bands(l->bsdf);
    const int n = bands->count;
    fputs("# theta_o [deg]", out);
    table_columns(out, bands, "albedo [1]");
    table_columns(out, bands, exact ? "error [1]" : "standard error [1]");
    fputc('\n', out);
    for (int i = 0; i < (exact ? EXACT : ANGLES); i++) {
        const struct share *s = exact ? &l->exact[i] : &l->at[i];
        double row[1 + 2 * BANDS_MAX] = { exact ? exact_of(i) : angle_of(i) };
        for (int b = 0; b < n; b++) {
            row[1 + b] = s->albedo[b].value;
            row[1 + n + b] = s->albedo[b].error;
        }
        table_row(out, row, 1 + 2 * (size_t)n);
    }
}

static void table_write(FILE *out, const struct loss *l)
{
    const struct bands *bands = bsdf_bands(l->bsdf);
    table_head(out, l->bsdf, dir_from_degrees(0, l->phi_deg));
    fprintf(out,
            "# albedo: integral of f (n_i/n_o)^2 |cos| for wo at phi = %.10g "
            "deg, here the mean weight of %llu samples, seed %llu\n",
            l->phi_deg, (unsigned long long)l->samples,
            (unsigned long long)l->seed);
    rows_write(out, l, false);
    fputs("\n\n# by quadrature\n", out);
    rows_write(out, l, true);
    if (!l->rough)
        return;
    fprintf(out,
            "\n\n# mean weights of %llu samples, standard error at most %.2g\n"
            "# mean: %s\n# theta_o [deg]\talpha [1]\tmean albedo "
            "[1]\tlost [1]%s\n",
            (unsigned long long)l->samples, l->error, colours_mean_name(bands),
            l->maps > 1 ? "\tlost where F is 1 [1]" : "");
    for (int i = 0; i < ROUGH; i++)
        for (int k = 0; k < TILTS; k++) {
            const double mean = l->map[0][i][k].mean;
            const double row[] = { tilt_of(k), alpha_of(i), mean, 1 - mean,
                                   1 - l->map[1][i][k].mean };
            table_row(out, row, 3 + (size_t)l->maps);
        }
    for (int c = 0; c < CUTS; c++) {
        fprintf(out, "\n\n# theta_o = %g deg\n# alpha [1]\tmean albedo [1]%s\n",
                tilt_of(cut[c]), l->maps > 1 ? "\twhere F is 1 [1]" : "");
        for (int i = 0; i < ROUGH; i++) {
            const double row[] = { alpha_of(i), l->map[0][i][cut[c]].mean,
                                   l->map[1][i][cut[c]].mean };
            table_row(out, row, 1 + (size_t)l->maps);
        }
    }
}

/* -- the picture ----------------------------------------------------------- */

enum { PANEL = 190, MAP = 190 };

static int bands_curves(const struct loss *l, struct chart_curve *curve)
{
    const struct bands *bands = bsdf_bands(l->bsdf);
    const int n = l->same ? 1 : bands->count;
    for (int i = 0; i < n; i++) {
        curve[i] = (struct chart_curve){
            .x = "$1", .line = l->same ? LINE_ONLY : colours_line(bands, i)
        };
        snprintf(curve[i].y, sizeof curve[i].y, "$%d", 2 + i);
        if (l->same && bands->count > 1)
            strcpy(curve[i].text, "all bands");
        else
            bands_print_one(bands, i, curve[i].text, sizeof curve[i].text);
    }
    return n;
}

/* Of the mean, against alpha. */
static void alpha_panel(struct figure *fig, double bottom, struct chart_axis y)
{
    struct chart_curve curve[CUTS];
    struct chart c = { .y0 = bottom,
                       .y1 = bottom + PANEL,
                       .x = chart_axis_exact(0, 1, 0.2, "α", "1"),
                       .y = y,
                       .curve = curve,
                       .curves = CUTS };
    for (int i = 0; i < CUTS; i++) {
        curve[i] = (struct chart_curve){
            .block = 3 + i, .x = "$1", .y = "$2", .line = 5 + i
        };
        snprintf(curve[i].text, sizeof curve[i].text, "θₒ = %g°",
                 tilt_of(cut[i]));
    }
    chart_column(&c, 1, 2, false);
    chart_draw(fig, &c);
}

static double lost_most(const struct loss *l)
{
    double most = 1e-3;
    for (int m = 0; m < l->maps; m++)
        for (int i = 0; i < ROUGH; i++)
            for (int k = 0; k < TILTS; k++)
                most = fmax(most, 1 - l->map[m][i][k].mean);
    return most;
}

static void maps(struct figure *fig, const struct loss *l, double bottom)
{
    const struct chart_axis lost =
        chart_axis(0, lost_most(l), 5, "lost, 1 − albedo", "1");
    for (int m = 0; m < l->maps; m++) {
        struct chart_map map = {

            .block = 2, .x = "$1", .y = "$2", .palette = "heat", .hi = lost.hi
        };
        struct chart c = {
            .y0 = bottom,
            .y1 = bottom + MAP,
            .title = m              ? "lost by single scattering, F = 1"
                     : l->maps == 1 ? "lost"
                                    : "lost, with absorption",
            .x = chart_axis_exact(0, 90, 30, "θₒ", "deg"),
            .y = chart_axis_exact(0, 1, 0.2, "α", "1"),
            .map = &map,
        };
        snprintf(map.z, sizeof map.z, "($%d)/1e%d", 4 + m, lost.exponent);
        chart_column(&c, m, l->maps, false);
        if (m == 0)
            chart_bar(fig, c.x0, FIGURE_PAGE - 26,
                      bottom - CHART_BELOW - CHART_BAR - 4, &map, lost.step,
                      lost.title);
        chart_draw(fig, &c);
    }
}

static void script_write(struct figure *fig, const struct loss *l)
{
    struct chart_curve key[2 * BANDS_MAX + CUTS];
    const int bands = bands_curves(l, key);
    int n = 2 * bands;
    char note[200], below[160], names[96];
    for (int i = 0; i < bands; i++) {
        key[bands + i] = key[i];
        key[bands + i].block = 1;
        key[bands + i].as = CHART_POINTS;
        key[bands + i].point = 6;
        key[bands + i].text[0] = '\0';
    }
    for (int i = 0; l->rough && i < CUTS; i++) {
        key[n] = (struct chart_curve){ .line = 5 + i };
        snprintf(key[n++].text, sizeof key[0].text, "θₒ = %g°",
                 tilt_of(cut[i]));
    }
    const int rows = chart_key_rows(key, n);
    const double foot = 12 + CHART_NOTE;
    const double map_y = foot + CHART_BAR_BELOW + CHART_BAR + 4 + CHART_BELOW;
    const double key_y = l->rough ? map_y + MAP + CHART_ABOVE + 16 : foot + 14;
    const double panel = key_y + (rows - 1) * 20 + 14 + CHART_BELOW;
    const struct chart_axis y =
        chart_axis(0, fmax(l->most, 1), 5, "albedo", "1");
    bands_print(bsdf_bands(l->bsdf), names, sizeof names);
    snprintf(below, sizeof below, "ωₒ at φ = %.6g°;  %s%s", l->phi_deg, names,
             strstr(bsdf_spec(l->bsdf), "alpha_u=")
                 ? ";  α the same along x and y"
                 : "");
    snprintf(note, sizeof note,
             "circles: by quadrature; lines%s: mean weights of %llu samples, ± "
             "%.1g%s",
             l->rough ? " and maps" : "", (unsigned long long)l->samples,
             l->error,
             !l->rough                               ? ""
             : bsdf_bands(l->bsdf)->kind == BANDS_NM ? "; maps: mean of the "
                                                       "bands"
                                                     : "; maps: luminance");
    figure_page(fig, FIGURE_PAGE, panel + PANEL + 22, bsdf_spec(l->bsdf),
                below);
    chart_notes(fig, foot, (const char *[]){ note }, 1);
    struct chart c = { .y0 = panel,
                       .y1 = panel + PANEL,
                       .x = chart_axis_exact(0, 90, l->rough ? 30 : 15, "θₒ",
                                             "deg"),
                       .y = y,
                       .curve = key,
                       .curves = 2 * bands };
    chart_column(&c, 0, l->rough ? 2 : 1, false);
    chart_key(fig, key, n, key_y + (rows - 1) * 20);
    chart_draw(fig, &c);
    if (l->rough) {
        alpha_panel(fig, panel, y);
        maps(fig, l, map_y);
    }
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct loss *l = calloc(1, sizeof *l);
    if (!l)
        return err_set(err, "out of memory");
    l->bsdf = r->bsdf[0];
    l->phi_deg = isnan(r->phi_deg) ? 0 : r->phi_deg;
    l->seed = r->seed;
    l->samples = (uint64_t)fmin(fmax((double)r->samples / 50, 1000), 1e5);
    bool ok = loss_make(l, err) && figure_open(&fig, r->output, &r->look, err);
    if (ok) {
        table_write(fig.table, l);
        script_write(&fig, l);
        plot_caption(&fig, &plot_albedo, r, NULL,
                     "Albedo against the angle of ωₒ and the roughness, by "
                     "quadrature, and the share of light that is lost.");
        ok = figure_draw(&fig, made, err);
    }
    free(l);
    return ok;
}

const struct plot plot_albedo = {
    .name = "albedo",
    .about = "the albedo against theta and alpha, and what is lost",
    .heeds = HEEDS_PHI | HEEDS_SAMPLES,
    .run = run,
};
