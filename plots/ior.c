/* ior.c - n and k of pages of optical constants against wavelength
 *
 * Two panels share the axis of wavelengths.  A table's rows are points, and the
 * line between them is what its n and k are taken to be there; a formula is a
 * line.  What is between pages of one material is grey.  Where bands are
 * wavelengths these are marked; where they are R, G and B of a single metal the
 * three pairs that stand for it are marked at the edge.
 */
#include "bsdf/ior.h"

#include <stdlib.h>
#include <string.h>

#include "bsdf/cli.h"
#include "bsdf/colour.h"
#include "bsdf/utf8.h"
#include "plots/axis.h"
#include "plots/key.h"
#include "plots/kinds.h"
#include "plots/table.h"

enum { PAGES_MAX = 8, FORMULA_POINTS = 400 };
static const double visible_lo_nm = 360, visible_hi_nm = 830;
static const double log_span = 100; /* of k, beyond which its axis has logs */

struct curve {
    struct ior_page *page;
    char name[128];
    double lo_nm, hi_nm; /* where it has n, and k if it has any */
    bool has_k;
    int index[2];  /* of n and of k in the table; -1 where there are none */
    int spread[2]; /* likewise, how pages of its material differ, which the
                      first of them has */
};

struct span {
    double lo, hi;
};

struct constants {
    struct curve curve[PAGES_MAX];
    int curves;
    struct span nm;
    struct span value[2]; /* of n and of k, where there are any in range */
    bool any_k;

    struct bands bands;
    bool fitted; /* eta and k of R, G, B are there */
    struct spectrum three[2];
};

/* -- pages ----------------------------------------------------------------- */

/* "Ca/Mathewson" for Ca; files as they were given. */
static void name_page(struct curve *c, const char *given)
{
    const char *path = ior_page_path(c->page);
    const char *slash = strrchr(path, '/');
    const char *stem = slash ? slash + 1 : path;
    if (strchr(given, '/') || strcmp(path, given) == 0)
        snprintf(c->name, sizeof c->name, "%s", given);
    else
        snprintf(c->name, sizeof c->name, "%s/%.*s", given,
                 (int)strcspn(stem, "."), stem);
}

static bool page_add(struct constants *all, const char *given, struct err *err)
{
    struct curve *c = &all->curve[all->curves];
    if (all->curves == PAGES_MAX)
        return err_set(err, "ior: expected at most %d pages", PAGES_MAX);
    if (*given == '\0')
        return err_set(err, "ior: a name is missing between commas");
    c->page = ior_find(given, NULL, err);
    if (!c->page)
        return false;
    all->curves++;
    name_page(c, given);
    ior_page_range(c->page, &c->lo_nm, &c->hi_nm);
    c->has_k = ior_page_has_k(c->page);
    return true;
}

static bool pages_find(struct constants *all, const char *names,
                       struct err *err)
{
    char *list = strdup(names), *rest = list;
    bool ok = list || err_set(err, "out of memory");
    for (char *name; ok && (name = strsep(&rest, ","));)
        ok = page_add(all, name, err);
    free(list);
    return ok;
}

/* What was asked for, or what there is of the visible, or all there is. */
static bool range_choose(struct constants *all, const struct plot_request *r,
                         struct err *err)
{
    struct span has = { INFINITY, 0 };
    for (int i = 0; i < all->curves; i++) {
        has.lo = fmin(has.lo, all->curve[i].lo_nm);
        has.hi = fmax(has.hi, all->curve[i].hi_nm);
    }
    all->nm = (struct span){ fmax(has.lo, visible_lo_nm),
                             fmin(has.hi, visible_hi_nm) };
    if (r->hi_nm > 0)
        all->nm = (struct span){ r->lo_nm, r->hi_nm };
    else if (!(all->nm.hi > all->nm.lo))
        all->nm = has;
    if (has.hi < all->nm.lo || has.lo > all->nm.hi)
        return err_set(
            err,
            "ior: nothing between %.6g and %.6g nm; expected a range "
            "that meets %.6g to %.6g nm",
            all->nm.lo, all->nm.hi, has.lo, has.hi);
    if (!(all->nm.hi > all->nm.lo)) { /* a page of one row */
        all->nm.lo *= 0.95;
        all->nm.hi *= 1.05;
    }
    return true;
}

/* -- values ---------------------------------------------------------------- */

struct rows {
    size_t n;
    double (*at)[2]; /* wavelength and value */
};

/* The rows of a table within the range, and one more at either side. */
static bool table_rows(struct rows *out, struct ior_table t, struct span nm)
{
    size_t first = 0, end = t.rows;
    while (first + 1 < t.rows && t.nm[first + 1] < nm.lo)
        first++;
    while (end > first + 1 && t.nm[end - 2] > nm.hi)
        end--;
    out->at = malloc((end - first + 1) * sizeof *out->at);
    for (size_t i = first; out->at && i < end; i++, out->n++) {
        out->at[out->n][0] = t.nm[i];
        out->at[out->n][1] = t.value[i];
    }
    return out->at;
}

/* Of n by a formula, which the page may know beyond where it knows k; at the
 * same wavelengths whatever other pages there are. */
static bool formula_rows(struct rows *out, const struct curve *c,
                         struct span nm)
{
    const double lo = fmax(c->lo_nm, nm.lo), hi = fmin(c->hi_nm, nm.hi);
    out->at = malloc((FORMULA_POINTS + 1) * sizeof *out->at);
    for (int i = 0; out->at && lo < hi && i <= FORMULA_POINTS; i++) {
        const double at = fmin(lo + (hi - lo) * i / FORMULA_POINTS, hi);
        double n, k;
        if (!ior_page_at(c->page, at, &n, &k, NULL))
            continue;
        out->at[out->n][0] = at;
        out->at[out->n++][1] = n;
    }
    return out->at;
}

/* Of n or of k; none is no failure. */
static bool rows_of(struct rows *out, const struct curve *c, bool of_k,
                    struct span nm, struct err *err)
{
    *out = (struct rows){ 0, NULL };
    if (of_k && !c->has_k)
        return true;
    const bool ok = of_k ? table_rows(out, ior_page_k(c->page), nm)
                    : ior_page_formula(c->page).number
                        ? formula_rows(out, c, nm)
                        : table_rows(out, ior_page_n(c->page), nm);
    return ok || err_set(err, "out of memory");
}

/* What the line through the rows reaches within the range. */
static void reach(struct span *s, const struct rows *rows, struct span nm)
{
    for (size_t i = 0; i < rows->n; i++) {
        const double *a = rows->at[i], *b = rows->at[i + (i + 1 < rows->n)];
        const double edge[2] = { fmax(a[0], nm.lo), fmin(b[0], nm.hi) };
        if (edge[0] > edge[1] || a[1] < 0 || b[1] < 0)
            continue;
        for (int k = 0; k < 2; k++) {
            const double share =
                b[0] > a[0] ? (edge[k] - a[0]) / (b[0] - a[0]) : 0;
            const double y = a[1] + share * (b[1] - a[1]);
            s->lo = fmin(s->lo, y);
            s->hi = fmax(s->hi, y);
        }
    }
}

static void three_fit(struct constants *all, struct err *warning)
{
    struct colour_report report = { .warnings = "" };
    struct cie *cie = malloc(sizeof *cie);
    const bool metal =
        all->curves == 1 && all->curve[0].has_k && all->bands.kind != BANDS_NM;
    all->fitted =
        metal && cie && cie_load(cie, NULL) &&
        colour_conductor(cie, all->curve[0].page,
                         all->bands.kind == BANDS_RGB_FIT ? COLOUR_FIT
                                                          : COLOUR_AVERAGE,
                         NULL, &all->three[0], &all->three[1], &report, NULL);
    if (all->fitted && report.warnings[0])
        err_set(warning, "%s: %s", all->curve[0].name, report.warnings);
    free(cie);
}

/* -- the table ------------------------------------------------------------- */

static void curve_comments(FILE *out, const struct curve *c, bool of_k)
{
    char text[300];
    const int formula = ior_page_formula(c->page).number;
    if (formula && !of_k)
        snprintf(text, sizeof text, "n by formula %d", formula);
    else
        snprintf(text, sizeof text, "%s, rows as published", of_k ? "k" : "n");
    table_comment(out, c->name, text);
    snprintf(text, sizeof text, "%.10g to %.10g nm", c->lo_nm, c->hi_nm);
    table_comment(out, "range of the page", text);
    fprintf(out, "# vacuum wavelength [nm]\t%s [1]\n", of_k ? "k" : "n");
}

/* The material of a page, by its name or by its folder. */
static void material_of(const struct curve *c, char *text, size_t size)
{
    const char *path = strchr(c->name, '.') ? ior_page_path(c->page) : c->name;
    const char *end = strrchr(path, '/');
    if (!strchr(c->name, '.') && strchr(c->name, '/'))
        end = strchr(c->name, '/');
    if (end && end - path > 3 && strncmp(end - 3, "/nk", 3) == 0)
        end -= 3; /* as the database has it since 2024 */
    const char *from = end ? end : path;
    while (from > path && from[-1] != '/')
        from--;
    snprintf(text, size, "%.*s", (int)(end ? end - from : 0), from);
}

static bool same_material(const struct constants *all, int i, int k)
{
    char a[128], b[128];
    material_of(&all->curve[i], a, sizeof a);
    material_of(&all->curve[k], b, sizeof b);
    return a[0] && strcmp(a, b) == 0;
}

/* How far the pages of one material are apart, where at least two have a value,
 * as a block of wavelength, least and greatest. */
static void spread_write(FILE *out, struct constants *all, int first, bool of_k,
                         int *blocks)
{
    enum { POINTS = 200 };
    struct curve *c = &all->curve[first];
    char material[128];
    int rows = 0;
    c->spread[of_k] = -1;
    for (int k = 0; k < first; k++)
        if (same_material(all, k, first))
            return;
    material_of(c, material, sizeof material);
    for (int i = 0; i <= POINTS; i++) {
        const double nm = all->nm.lo + (all->nm.hi - all->nm.lo) * i / POINTS;
        double least = INFINITY, most = -INFINITY;
        int pages = 0;
        for (int k = first; k < all->curves; k++) {
            double value[2];
            if (!same_material(all, first, k) ||
                (of_k && !all->curve[k].has_k) ||
                !ior_page_at(all->curve[k].page, nm, &value[0], &value[1],
                             NULL))
                continue;
            least = fmin(least, value[of_k]);
            most = fmax(most, value[of_k]);
            pages++;
        }
        if (pages < 2)
            continue;
        if (rows++ == 0) {
            fputs((*blocks)++ ? "\n\n" : "", out);
            table_comment(out, "spread between pages of", material);
            fprintf(out,
                    "# vacuum wavelength [nm]\tleast %s [1]\tgreatest "
                    "[1]\n",
                    of_k ? "k" : "n");
            c->spread[of_k] = *blocks - 1;
        }
        table_row(out, (double[]){ nm, least, most }, 3);
    }
}

/* Writes all curves as blocks and notes what they reach. */
static bool table_write(FILE *out, struct constants *all, struct err *err)
{
    char text[160];
    int blocks = 0;
    table_comment(out, "made by", "bsdf-plot " BSDF_VERSION);
    for (int i = 0; i < all->curves; i++)
        table_comment(out, all->curve[i].name,
                      ior_page_reference(all->curve[i].page));
    bands_print(&all->bands, text, sizeof text);
    table_comment(out, "bands", text);
    for (int of_k = 0; of_k < 2; of_k++) {
        struct span reached = { INFINITY, -INFINITY };
        for (int i = 0; i < all->curves; i++) {
            struct curve *c = &all->curve[i];
            struct rows rows;
            if (!rows_of(&rows, c, of_k, all->nm, err))
                return false;
            c->index[of_k] = rows.n > 0 ? blocks : -1;
            if (rows.n > 0) {
                fputs(blocks++ ? "\n\n" : "", out);
                curve_comments(out, c, of_k);
                for (size_t k = 0; k < rows.n; k++)
                    table_row(out, rows.at[k], 2);
                reach(&reached, &rows, all->nm);
            }
            free(rows.at);
        }
        for (int i = 0; i < all->curves; i++)
            spread_write(out, all, i, of_k, &blocks);
        for (int b = 0; all->fitted && b < 3; b++) {
            reached.lo = fmin(reached.lo, all->three[of_k].band[b]);
            reached.hi = fmax(reached.hi, all->three[of_k].band[b]);
        }
        all->value[of_k] = reached;
    }
    all->any_k = all->value[1].hi > 0;
    return all->value[0].hi >= all->value[0].lo ||
           err_set(err, "ior: no page has n between %.6g and %.6g nm",
                   all->nm.lo, all->nm.hi);
}

/* -- the picture ----------------------------------------------------------- */

/* In pixels. */
enum {
    PAGE = 800,
    LEFT = 84,
    RIGHT = 742,
    PANEL = 205,
    GAP = 22,
    AXIS = 54, /* below the panels */
    ABOVE = 30,
    LINE = 17,
    SMALL = 14, /* a line of small print */
    SMALL_LETTERS = 142,
    CITED_MAX = 40 /* lines */
};

static const int mark[PAGES_MAX] = { 7, 5, 9, 13, 6, 4, 8, 12 };

static struct ior_table measured(const struct curve *c, bool of_k)
{
    return of_k ? ior_page_k(c->page) : ior_page_n(c->page);
}

/* Points that would run into each other are left to the line. */
static bool dotted(const struct constants *all, const struct curve *c,
                   bool of_k)
{
    const struct ior_table t = measured(c, of_k);
    const double apart_px = 5;
    size_t inside = 0;
    for (size_t i = 0; i < t.rows; i++)
        inside += t.nm[i] >= all->nm.lo && t.nm[i] <= all->nm.hi;
    return inside > 0 && (RIGHT - LEFT) / (double)inside > apart_px;
}

static void key_entries(const struct constants *all, struct key_entry *entry)
{
    for (int i = 0; i < all->curves; i++) {
        const struct curve *c = &all->curve[i];
        char *plain = utf8_plain(c->name);
        entry[i] = (struct key_entry){ .look = "" };
        snprintf(entry[i].look, sizeof entry[i].look, "nohead lt %d", i + 1);
        if (dotted(all, c, false) || dotted(all, c, true))
            snprintf(entry[i].point, sizeof entry[i].point,
                     "lt %d pt %d ps 0.5 front", i + 1, mark[i]);
        snprintf(entry[i].text, sizeof entry[i].text, "%.60s, %.6g–%.6g nm%s",
                 plain ? plain : "", c->lo_nm, c->hi_nm,
                 c->has_k ? "" : ", no k");
        free(plain);
    }
}

/* Small print: the citations, wrapped. */
struct cited {
    char text[CITED_MAX][512];
    int lines;
};

static void cite(struct cited *out, const char *names, const char *reference)
{
    char joined[1600], all[2800];
    size_t n = 0;
    for (const char *p = reference; *p && n + 1 < sizeof joined; p++)
        joined[n++] = *p == '\n' ? ' ' : *p;
    joined[n] = '\0';
    snprintf(all, sizeof all, "%s: %s", names,
             n > 0 ? joined : "no reference on the page");
    char *plain = utf8_plain(all), *at = plain;
    while (at && *at && out->lines < CITED_MAX) {
        size_t bytes = 0, letters = 0, space = 0;
        for (; at[bytes]; bytes++) {
            letters += ((unsigned char)at[bytes] & 0xc0) != 0x80;
            if (letters > SMALL_LETTERS)
                break;
            if (at[bytes] == ' ')
                space = bytes;
        }
        const size_t take = at[bytes] && space > 0 ? space : bytes;
        snprintf(out->text[out->lines++], sizeof out->text[0], "%.*s",
                 (int)take, at);
        at += take + (at[take] == ' ');
    }
    free(plain);
}

/* Pages of one publication share its citation. */
static void cite_all(struct cited *out, const struct constants *all)
{
    bool done[PAGES_MAX] = { false };
    for (int i = 0; i < all->curves; i++) {
        char names[PAGES_MAX * 130] = "";
        const char *reference = ior_page_reference(all->curve[i].page);
        size_t n = 0;
        if (done[i])
            continue;
        for (int k = i; k < all->curves; k++)
            if (strcmp(ior_page_reference(all->curve[k].page), reference) ==
                0) {
                done[k] = true;
                n += (size_t)snprintf(names + n, sizeof names - n, "%s%s",
                                      k > i ? ", " : "", all->curve[k].name);
            }
        cite(out, names, reference);
    }
}

/* One of the two axes of values. */
struct axis {
    double lo, hi, step, unit;
    bool log;
    char title[48];
};

static struct axis axis_of(const struct constants *all, bool of_k)
{
    const struct span v = all->value[of_k];
    struct axis a = { .unit = 1 };
    char unit[32];
    double least = INFINITY;
    for (int i = 0; of_k && i < all->curves; i++) {
        const struct ior_table t = ior_page_k(all->curve[i].page);
        for (size_t k = 0; k < t.rows; k++)
            if (t.value[k] > 0 && t.nm[k] >= all->nm.lo &&
                t.nm[k] <= all->nm.hi)
                least = fmin(least, t.value[k]);
    }
    if (of_k && v.hi > log_span * least) {
        a.log = true;
        a.lo = pow(10, floor(log10(least)));
        a.hi = pow(10, ceil(log10(v.hi)));
        a.step = fmax(ceil(log10(a.hi / a.lo) / 6), 1);
        snprintf(a.title, sizeof a.title, "k [1]");
        return a;
    }
    const double low = v.lo < v.hi / 3 ? 0 : v.lo;
    const double length = fmax(v.hi - low, 1e-3 * fmax(v.hi, 1e-300)) * 1.04;
    a.step = axis_step(length, 5);
    a.lo = floor(low / a.step + 1e-9) * a.step;
    a.hi = ceil((low + length) / a.step - 1e-9) * a.step;
    const int exponent = of_k && a.hi < 1e-2 ? axis_exponent(a.hi) : 0;
    a.unit = pow(10, exponent);
    axis_unit(unit, sizeof unit, exponent, "");
    if (exponent)
        snprintf(a.title, sizeof a.title, "k [%.*s]", (int)strcspn(unit, " "),
                 unit);
    else
        snprintf(a.title, sizeof a.title, "%c [1]", of_k ? 'k' : 'n');
    return a;
}

/* An order of what rises, and places in that order that keep apart. */
static void spread(const double *wanted, int n, double apart, double from,
                   double to, int *order, double *at)
{
    for (int i = 0; i < n; i++) {
        int k = i;
        for (; k > 0 && wanted[order[k - 1]] > wanted[i]; k--)
            order[k] = order[k - 1];
        order[k] = i;
    }
    for (int i = 0; i < n; i++)
        at[i] = fmax(wanted[order[i]], i ? at[i - 1] + apart : from);
    for (int i = n - 1; i >= 0; i--)
        at[i] = fmin(at[i], i + 1 < n ? at[i + 1] - apart : to);
}

static void band_lines(struct figure *fig, const struct constants *all,
                       bool named)
{
    FILE *out = fig->script;
    const double apart = 0.1;
    int order[BANDS_MAX], band[BANDS_MAX], n = 0;
    double x[BANDS_MAX], at[BANDS_MAX];
    char name[32];
    for (int b = 0; all->bands.kind == BANDS_NM && b < all->bands.count; b++)
        if (all->bands.nm[b] >= all->nm.lo && all->bands.nm[b] <= all->nm.hi) {
            x[n] = (all->bands.nm[b] - all->nm.lo) / (all->nm.hi - all->nm.lo);
            band[n++] = b;
        }
    spread(x, n, apart, 0, 1, order, at);
    for (int i = 0; i < n; i++) {
        const double here = x[order[i]];
        fprintf(out,
                "set arrow from graph %.6g,0 to graph %.6g,1 nohead back lc "
                "rgb \"#909090\" lw 0.8 dt (4,4)\n",
                here, here);
        if (!named)
            continue;
        bands_print_one(&all->bands, band[order[i]], name, sizeof name);
        fprintf(out,
                "set arrow from graph %.6g,1 to graph %.6g,1.045 nohead back "
                "lc rgb \"#909090\" lw 0.8\n",
                here, at[i]);
        figure_label_at(fig, name, "graph %.6g,1.09 center tc rgb \"#505050\"",
                        at[i]);
    }
}

/* Ticks of R, G and B at the right edge. */
static void three_marks(struct figure *fig, const struct constants *all,
                        bool of_k, const struct axis *a)
{
    FILE *out = fig->script;
    int order[3];
    double y[3], at[3];
    char name[8];
    if (!all->fitted)
        return;
    for (int b = 0; b < 3; b++) {
        const double v = all->three[of_k].band[b];
        y[b] = a->log ? log(v / a->lo) / log(a->hi / a->lo)
                      : (v - a->lo) / (a->hi - a->lo);
    }
    spread(y, 3, 0.075, 0.035, 0.965, order, at);
    for (int i = 0; i < 3; i++) {
        const double here = y[order[i]];
        bands_print_one(&all->bands, order[i], name, sizeof name);
        fprintf(out,
                "set arrow from graph 0.985,%.6g to graph 1.012,%.6g nohead "
                "front lw 1.5\n"
                "set arrow from graph 1.012,%.6g to graph 1.025,%.6g nohead lw "
                "0.6\n",
                here, here, here, at[i]);
        figure_label_at(fig, name, "graph 1.03,%.6g left", at[i]);
    }
}

/* Marks every decade; names every so many. */
static void decades(struct figure *fig, const struct axis *a)
{
    FILE *out = fig->script;
    const int from = (int)lround(log10(a->lo)), to = (int)lround(log10(a->hi));
    char unit[32];
    fprintf(out,
            "set logscale y; set yrange [%.10g:%.10g]\n"
            "set ytics nomirror scale 0.7,0.4 (",
            a->lo, a->hi);
    for (int e = from; e <= to; e++) {
        axis_unit(unit, sizeof unit, e, "");
        unit[strcspn(unit, " ")] = '\0';
        fputs(e > from ? ", " : "", out);
        figure_text(fig, (to - e) % (int)a->step ? "" : e ? unit : "1");
        fprintf(out, " 1e%d", e);
    }
    fputs(")\n", out);
}

static void panel(struct figure *fig, const struct constants *all, bool of_k,
                  double bottom, bool lowest)
{
    FILE *out = fig->script;
    const struct axis a = axis_of(all, of_k);
    int plots_made = 0;
    fprintf(out, "\n# %s\n", of_k ? "k" : "n");
    figure_panel(fig, LEFT, RIGHT, bottom, bottom + PANEL);
    figure_label_at(fig, a.title, "screen %.6g,%.6g center rotate by 90",
                    24 / fig->width, (bottom + PANEL / 2.) / fig->height);
    if (a.log)
        decades(fig, &a);
    else
        fprintf(out,
                "unset logscale y; set yrange [%.10g:%.10g]; set ytics %.10g "
                "nomirror scale 0.7,0.4 format \"%s\"\n",
                a.lo / a.unit, a.hi / a.unit, a.step / a.unit,
                fig->form->number);
    fprintf(out, "set format x \"%s\"\n", lowest ? fig->form->number : "");
    if (lowest)
        figure_label_at(fig, "vacuum wavelength [nm]",
                        "graph 0.5,-0.22 center");
    band_lines(fig, all, !of_k);
    three_marks(fig, all, of_k, &a);
    fputs("plot ", out);
    for (int i = 0; i < all->curves; i++)
        if (all->curve[i].spread[of_k] >= 0)
            fprintf(out,
                    "%stable index %d using 1:($2/%.10g):($3/%.10g) with "
                    "filledcurves fc rgb \"#d0d0d0\" fs solid 1 noborder",
                    plots_made++ ? ", \\\n     " : "",
                    all->curve[i].spread[of_k], a.unit, a.unit);
    for (int i = 0; i < all->curves; i++) {
        const struct curve *c = &all->curve[i];
        if (c->index[of_k] < 0)
            continue;
        fprintf(out,
                "%stable index %d using 1:($2 >= 0 ? $2/%.10g : NaN) with "
                "lines lt %d",
                plots_made++ ? ", \\\n     " : "", c->index[of_k], a.unit,
                i + 1);
        if (dotted(all, c, of_k))
            fprintf(out,
                    ", \\\n     table index %d using 1:($2 >= 0 ? $2/%.10g : "
                    "NaN) with points lt %d pt %d ps 0.5",
                    c->index[of_k], a.unit, i + 1, mark[i]);
    }
    fputs("\nunset arrow; unset label\n", out);
}

static void note_write(const struct constants *all, char *text, size_t size)
{
    bool points = false, tables = false, formulas = false, negative = false;
    bool spread = false;
    for (int i = 0; i < all->curves; i++) {
        spread |= all->curve[i].spread[0] >= 0 || all->curve[i].spread[1] >= 0;
        formulas |= ior_page_formula(all->curve[i].page).number > 0;
        for (int of_k = 0; of_k < 2; of_k++) {
            const struct ior_table t = measured(&all->curve[i], of_k);
            tables |= t.rows > 0;
            points |= dotted(all, &all->curve[i], of_k);
            for (size_t k = 0; k < t.rows; k++)
                negative |= t.value[k] < 0 && t.nm[k] >= all->nm.lo &&
                            t.nm[k] <= all->nm.hi;
        }
    }
    snprintf(text, size, "%s%s%s%s%s%s",
             points   ? "points: as published, lines: linear between them"
             : tables ? "lines: linear between published rows"
                      : "",
             tables && formulas ? "; n without points: by a formula"
             : formulas         ? "by a formula"
                                : "",
             all->fitted ? "; at the right: n and k that stand for R, G, B "
                         : "",
             !all->fitted                       ? ""
             : all->bands.kind == BANDS_RGB_FIT ? "(fit)"
                                                : "(average)",
             negative ? "; negative rows left out" : "",
             spread ? "; grey: between the pages of a material" : "");
}

static void title_write(const struct constants *all, char *text, size_t size)
{
    int n = snprintf(text, size, "%s of ", all->any_k ? "n and k" : "n");
    for (int i = 0; i < all->curves && (size_t)n < size; i++)
        n += snprintf(text + n, size - (size_t)n, "%s%s", i ? ", " : "",
                      all->curve[i].name);
}

static void script_write(struct figure *fig, const struct constants *all)
{
    FILE *out = fig->script;
    struct key_entry entry[PAGES_MAX];
    struct cited cited = { .lines = 0 };
    char title[1200], note[256], below[160], bands[96];
    cite_all(&cited, all);
    key_entries(all, entry);
    const int rows = key_rows(entry, all->curves, PAGE);
    const int panels = 1 + all->any_k;
    const double small = 10 + cited.lines * SMALL;
    const double note_y = small + 14;
    const double key_y = note_y + 22 + (rows - 1) * KEY_ROW;
    const double bottom = key_y + 16 + AXIS;
    const double body = bottom + panels * PANEL + (panels - 1) * GAP + ABOVE;
    title_write(all, title, sizeof title);
    bands_print(&all->bands, bands, sizeof bands);
    snprintf(below, sizeof below, "%.6g to %.6g nm%s%s", all->nm.lo, all->nm.hi,
             all->fitted || all->bands.kind == BANDS_NM ? ";  bands: " : "",
             all->fitted || all->bands.kind == BANDS_NM ? bands : "");
    figure_page(fig, PAGE, body, title, below);
    for (int i = 0; i < cited.lines; i++)
        figure_small(fig, 24, small - SMALL * (i + 0.5), cited.text[i]);
    note_write(all, note, sizeof note);
    figure_label(fig, PAGE / 2., note_y, "center", note);
    key_draw(fig, entry, all->curves, key_y);
    fprintf(out,
            "unset key; set border 3 lc rgb \"#505050\"; set clip two\n"
            "set xrange [%.12g:%.12g]\n"
            "set xtics nomirror scale 0.7,0.4 %.10g\n"
            "set mxtics 2\n",
            all->nm.lo, all->nm.hi, axis_step(all->nm.hi - all->nm.lo, 10));
    for (int i = 0; i < panels; i++)
        panel(fig, all, i == 1, bottom + (panels - 1 - i) * (PANEL + GAP),
              i + 1 == panels);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct constants all = { .bands = r->bands };
    struct err warning = { "" };
    bool ok = pages_find(&all, r->pages, err) && range_choose(&all, r, err);
    if (ok) {
        three_fit(&all, &warning);
        ok = figure_open(&fig, r->output, &r->look, err);
    }
    if (ok && !table_write(fig.table, &all, err)) {
        figure_abandon(&fig);
        ok = false;
    } else if (ok) {
        script_write(&fig, &all);
        plot_caption(&fig, &plot_ior, r, r->pages,
                     "Index of refraction n and extinction coefficient k [1] "
                     "against vacuum wavelength [nm]. Pages:");
        ok = figure_draw(&fig, made, err);
    }
    if (ok && warning.text[0])
        *err = warning;
    for (int i = 0; i < all.curves; i++)
        ior_page_free(all.curve[i].page);
    return ok;
}

const struct plot plot_ior = {
    .name = "ior",
    .about = "n and k of optical constants against wavelength",
    .subject = PLOT_PAGES,
    .run = run,
};
