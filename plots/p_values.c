/* p_values.c - are p-values uniform, as those of sound models must be
 *
 * Their empirical distribution against the uniform one, and what lies between
 * the two.  In grey how far chance alone takes it, 99 times of 100, by
 * Kolmogorov's limit: 1.6276 / sqrt(n).
 *
 * The file is a report of bsdf-validate --json, whose p-values are those of
 * verdicts, by check, and conservative; or a table of named columns (rows.h),
 * as tests/calibrate --p-values writes it: `p`, in [0, 1], and `name`.
 */
#include <gsl/gsl_sort.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/utf8.h"
#include "plots/chart.h"
#include "plots/key.h"
#include "plots/kinds.h"
#include "plots/rows.h"
#include "plots/table.h"
#include "validate/recorded.h"

enum { NAMES_MAX = 8, NAME_SIZE = 48 };
static const double kolmogorov_99 = 1.6276;

/* The values of one name, sorted in the end. */
struct sample {
    char name[NAME_SIZE];
    double *p;
    size_t n, room;
    double off; /* the largest distance from uniform */
};

struct samples {
    struct sample of[NAMES_MAX];
    int n;
    size_t left_out; /* values of further names */
    bool reported;   /* from a report */
};

static bool add(struct samples *s, const char *name, double p, struct err *err)
{
    int i = 0;
    char *plain = utf8_plain(name), cut[NAME_SIZE];
    snprintf(cut, sizeof cut, "%s", plain ? plain : "");
    free(plain);
    while (i < s->n && strcmp(s->of[i].name, cut) != 0)
        i++;
    if (i == NAMES_MAX) {
        s->left_out++;
        return true;
    }
    struct sample *a = &s->of[i];
    if (i == s->n) {
        s->n++;
        memcpy(a->name, cut, sizeof cut);
    }
    if (a->n == a->room) {
        a->room = a->room ? 2 * a->room : 256;
        double *grown = realloc(a->p, a->room * sizeof *grown);
        if (!grown)
            return err_set(err, "out of memory");
        a->p = grown;
    }
    a->p[a->n++] = p;
    return true;
}

static bool from_report(struct samples *s, const char *path, struct err *err)
{
    struct recorded r;
    bool ok = recorded_read(&r, path, err);
    if (!ok)
        return false;
    s->reported = true;
    for (size_t i = 0; ok && i < r.results; i++)
        for (size_t k = 0; ok && k < r.result[i].verdicts; k++) {
            const struct verdict *v = &r.result[i].verdict[k];
            if (v->applies && !isnan(v->p))
                ok = add(s, v->check, v->p, err);
        }
    recorded_clear(&r);
    return ok &&
           (s->n > 0 || err_set(err, "%s: no verdict has a p-value", path));
}

static bool from_table(struct samples *s, const char *path, struct err *err)
{
    struct rows r;
    if (!rows_read(&r, path, err))
        return false;
    const int p = rows_column(&r, "p", err);
    const int name = p >= 0 ? rows_column(&r, "name", err) : -1;
    bool ok = name >= 0;
    for (size_t i = 0; ok && i < r.n; i++) {
        double x;
        ok = rows_number(&r, i, p, 0, 1, false, &x, err) &&
             add(s, r.row[i].field[name], x, err);
    }
    rows_clear(&r);
    return ok;
}

static void settle(struct samples *s)
{
    for (int i = 0; i < s->n; i++) {
        struct sample *a = &s->of[i];
        const double n = (double)a->n;
        gsl_sort(a->p, 1, a->n);
        for (size_t k = 0; k < a->n; k++)
            a->off = fmax(a->off, fmax((double)(k + 1) / n - a->p[k],
                                       a->p[k] - (double)k / n));
    }
}

static double band(const struct sample *s)
{
    return kolmogorov_99 / sqrt((double)s->n);
}

/* Of the fewest values, which is the widest. */
static double widest(const struct samples *s)
{
    double most = 0;
    for (int i = 0; i < s->n; i++)
        most = fmax(most, band(&s->of[i]));
    return fmin(most, 1);
}

/* Both ends of every step. */
static void table_write(FILE *out, const struct samples *s, const char *path)
{
    table_comment(out, "made by", "bsdf-plot p-values");
    table_comment(out, "file", path);
    for (int i = 0; i < s->n; i++) {
        const struct sample *a = &s->of[i];
        const double n = (double)a->n;
        fprintf(out,
                "%s# %s: %zu values, %.4g from uniform at most, chance %.4g\n"
                "# p [1]\tshare at or below [1]\n0\t0\n",
                i ? "\n\n" : "", a->name, a->n, a->off, band(a));
        for (size_t k = 0; k < a->n; k++) {
            table_row(out, (double[]){ a->p[k], (double)k / n }, 2);
            table_row(out, (double[]){ a->p[k], (double)(k + 1) / n }, 2);
        }
        fputs("1\t1\n", out);
    }
    fprintf(out, "\n\n# chance\n# p [1]\tleast share [1]\tmost [1]\n");
    for (int k = 0; k <= 100; k++) {
        const double p = k / 100., w = widest(s);
        table_row(out, (double[]){ p, fmax(p - w, 0), fmin(p + w, 1) }, 3);
    }
}

enum { PANEL = 330 };

static void script_write(struct figure *fig, const struct samples *s,
                         const char *path)
{
    struct chart_curve curve[NAMES_MAX + 1] = {
        { .block = s->n,
          .x = "$1",
          .y = "$2",
          .y2 = "$3",
          .as = CHART_FILL,
          .text = "chance, 99 %" },
    };
    char note[3][200], title[200];
    double off = 0;
    size_t all = 0;
    for (int i = 0; i < s->n; i++) {
        curve[1 + i] = (struct chart_curve){
            .block = i, .x = "$1", .y = "$2", .line = 1 + i
        };
        snprintf(curve[1 + i].text, sizeof curve[0].text, "%s, %zu",
                 s->of[i].name, s->of[i].n);
        off = fmax(off, s->of[i].off);
        all += s->of[i].n;
    }
    const int n = 1 + s->n, rows = chart_key_rows(curve, n);
    int notes = 0;
    snprintf(note[notes++], sizeof note[0],
             "grey: where an empirical distribution of uniform values stays 99 "
             "times of 100 (for the fewest values)");
    if (s->reported)
        snprintf(note[notes++], sizeof note[0],
                 "the p-values of a report are conservative: above the "
                 "diagonal is a mistake, below it is not");
    if (s->left_out > 0)
        snprintf(note[notes++], sizeof note[0],
                 "%zu values of further names are left out", s->left_out);
    snprintf(title, sizeof title, "p-values of %.150s", path);
    const double foot = 12 + notes * CHART_NOTE;
    const double bottom = foot + rows * KEY_ROW + 14 + CHART_BELOW;
    struct chart c = {
        .y0 = bottom,
        .y1 = bottom + PANEL,
        .x = chart_axis_exact(0, 1, 0.2, "p", "1"),
        .y = chart_axis_exact(0, 1, 0.2, "share of p-values at or below", "1"),
        .curve = curve,
        .curves = n,
    };
    char below[160];
    snprintf(below, sizeof below, "%zu values; farthest from uniform by %.3g",
             all, off);
    figure_page(fig, FIGURE_PAGE, bottom + PANEL + 18, title, below);
    chart_notes(fig, foot, (const char *[]){ note[0], note[1], note[2] },
                notes);
    chart_key(fig, curve, n, foot + 14 + (rows - 1) * KEY_ROW);
    chart_column(&c, 0, 2, false);
    fprintf(fig->script, "set arrow from 0,0 to 1,1 nohead front lt %d\n",
            LINE_REFERENCE);
    chart_draw(fig, &c);
    const double reach = fmax(off, widest(s));
    for (int i = 0; i < n; i++) {
        strcpy(curve[i].y, "$2-$1");
        strcpy(curve[i].y2, "$3-$1");
    }
    c.y = chart_axis(-reach, reach, 6, "share − p", "1");
    chart_column(&c, 1, 2, false);
    fprintf(fig->script, "set arrow from 0,0 to 1,0 nohead front lt %d\n",
            LINE_REFERENCE);
    chart_draw(fig, &c);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct samples s = { .n = 0 };
    const char *dot = strrchr(r->file, '.');
    bool ok = (dot && strcmp(dot, ".json") == 0 ? from_report
                                                : from_table)(&s, r->file, err);
    if (ok)
        settle(&s);
    ok = ok && figure_open(&fig, r->output, &r->look, err);
    if (ok) {
        table_write(fig.table, &s, r->file);
        script_write(&fig, &s, r->file);
        plot_caption(&fig, &plot_p_values, r, r->file,
                     "Empirical distribution of p-values against the uniform "
                     "one, and the difference. File:");
        ok = figure_draw(&fig, made, err);
    }
    for (int i = 0; i < s.n; i++)
        free(s.of[i].p);
    if (ok)
        err->text[0] = '\0';
    return ok;
}

const struct plot plot_p_values = {
    .name = "p-values",
    .about = "the distribution of p-values, of a report or of calibrate",
    .subject = PLOT_FILE,
    .file = "bsdf-validate --json, or of calibrate --p-values",
    .run = run,
};
