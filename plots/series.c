/* series.c - what was measured against what was set, with error bars
 *
 * The file is a table (rows.h) of four columns, a point a row: which curve it
 * belongs to, x, y, and the standard error of y.  The names of the second and
 * the third column are the axes' titles, with the unit behind in brackets, as
 * in "bounces [1]".  Where x is - there is a line across at y.  An axis of x
 * whose values are all above 0 and span a factor of 30 is in logarithms.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/utf8.h"
#include "plots/chart.h"
#include "plots/key.h"
#include "plots/kinds.h"
#include "plots/rows.h"
#include "plots/table.h"

enum { CURVES_MAX = LINE_CURVES, MARKS_MAX = 8, WORD_SIZE = 64 };
enum { PANEL = 320 };
static const double wide = 30, largest = 1e300;

struct point {
    int curve; /* or mark */
    double x, y, error;
};

struct series {
    struct point *point;
    size_t n;
    char name[CURVES_MAX][WORD_SIZE], mark[MARKS_MAX][WORD_SIZE];
    int curves, marks;
    char what[2][WORD_SIZE], unit[2][WORD_SIZE]; /* of x and y */
};

/* "bounces [1]" to "bounces" and "1". */
static void axis_words(const char *title, char *what, char *unit)
{
    char *plain = utf8_plain(title);
    const char *text = plain ? plain : "", *open = strrchr(text, '[');
    const size_t n = open ? (size_t)(open - text) : strlen(text);
    snprintf(what, WORD_SIZE, "%.*s", (int)(n > 0 && open ? n - 1 : n), text);
    snprintf(unit, WORD_SIZE, "%.*s", open ? (int)strcspn(open + 1, "]") : 1,
             open ? open + 1 : "1");
    free(plain);
}

/* The index of a word in a list, to which it is added; -1 where that is full.
 */
static int word_index(char list[][WORD_SIZE], int *n, int most,
                      const char *word)
{
    char *plain = utf8_plain(word), text[WORD_SIZE];
    snprintf(text, sizeof text, "%s", plain ? plain : "");
    free(plain);
    for (int i = 0; i < *n; i++)
        if (strcmp(list[i], text) == 0)
            return i;
    if (*n == most)
        return -1;
    strcpy(list[*n], text);
    return (*n)++;
}

static bool point_of(struct series *s, const struct rows *r, size_t i,
                     struct err *err)
{
    struct point *p = &s->point[i];
    const char *word = r->row[i].field[0];
    if (!rows_number(r, i, 1, -largest, largest, true, &p->x, err) ||
        !rows_number(r, i, 2, -largest, largest, false, &p->y, err) ||
        !rows_number(r, i, 3, 0, largest, false, &p->error, err))
        return false;
    p->curve = isnan(p->x) ? word_index(s->mark, &s->marks, MARKS_MAX, word)
                           : word_index(s->name, &s->curves, CURVES_MAX, word);
    return p->curve >= 0 ||
           err_set(err, "%s:%zu: \"%.40s\" is one curve too many", r->path,
                   r->row[i].line, word);
}

static bool series_read(struct series *s, const char *path, struct err *err)
{
    struct rows r;
    if (!rows_read(&r, path, err))
        return false;
    bool ok = r.columns == 4 ||
              err_set(err, "%s: %zu columns; expected 4: curve, x, y, error",
                      path, r.columns);
    s->n = r.n;
    s->point = calloc(r.n, sizeof *s->point);
    ok = ok && (s->point || err_set(err, "out of memory"));
    for (size_t i = 0; ok && i < r.n; i++)
        ok = point_of(s, &r, i, err);
    for (int k = 0; ok && k < 2; k++)
        axis_words(r.name[1 + k], s->what[k], s->unit[k]);
    rows_clear(&r);
    return ok && (s->curves > 0 ||
                  err_set(err, "%s: no point has a number for x", path));
}

static void table_write(FILE *out, const struct series *s, const char *path)
{
    table_comment(out, "made by", "bsdf-plot series");
    table_comment(out, "file", path);
    for (int k = 0; k < s->curves + s->marks; k++) {
        const bool mark = k >= s->curves;
        const int own = mark ? k - s->curves : k;
        if (k)
            fputs("\n\n", out);
        table_comment(out, mark ? "across" : "curve",
                      mark ? s->mark[own] : s->name[own]);
        fprintf(out, "# %s [%s]\t%s [%s]\tstandard error\n", s->what[0],
                s->unit[0], s->what[1], s->unit[1]);
        for (size_t i = 0; i < s->n; i++) {
            const struct point *p = &s->point[i];
            if (isnan(p->x) == mark && p->curve == own)
                table_row(out, (double[]){ p->x, p->y, p->error }, 3);
        }
    }
}

/* From the least to the greatest of x (which 0) or y (1), error bars
 * included; in logarithms only of what is above 0. */
static void range_of(const struct series *s, int which, bool log, double *lo,
                     double *hi)
{
    *lo = INFINITY;
    *hi = -INFINITY;
    for (size_t i = 0; i < s->n; i++) {
        const struct point *p = &s->point[i];
        const double at = which ? p->y : p->x;
        const double less = which && !(log && p->y <= p->error) ? p->error : 0;
        if (isnan(at) || (log && at <= 0))
            continue;
        *lo = fmin(*lo, at - less);
        *hi = fmax(*hi, at + (which ? p->error : 0));
    }
    if (!isfinite(*lo)) { /* nothing above 0 */
        *lo = 0.1;
        *hi = 1;
    }
}

static struct chart_axis axis_of(const struct series *s, int which, bool log)
{
    double lo, hi;
    range_of(s, which, log, &lo, &hi);
    if (log)
        return chart_axis_log(lo, hi, s->what[which], s->unit[which]);
    if (which && lo > 0 && lo < 0.5 * hi)
        lo = 0;
    return chart_axis(lo, hi, 8, s->what[which], s->unit[which]);
}

static double on_axis(double at, const struct chart_axis *a)
{
    return a->log ? at : at / pow(10, a->exponent);
}

static void error_bars(struct figure *fig, const struct series *s,
                       const struct chart *c)
{
    for (size_t i = 0; i < s->n; i++) {
        const struct point *p = &s->point[i];
        const double bottom = p->y - p->error, x = on_axis(p->x, &c->x);
        if (isnan(p->x) || p->error == 0 || (c->y.log && p->y <= 0) ||
            (c->x.log && p->x <= 0))
            continue;
        fprintf(
            fig->script,
            "set arrow from %.10g,%.10g to %.10g,%.10g heads size graph "
            "0.004,90 lt %d\n",
            x, c->y.log && bottom <= c->y.lo ? c->y.lo : on_axis(bottom, &c->y),
            x, on_axis(p->y + p->error, &c->y), 1 + p->curve);
    }
}

static void script_write(struct figure *fig, const struct series *s, bool log)
{
    struct chart_curve curve[CURVES_MAX];
    struct chart_mark mark[MARKS_MAX];
    char title[2 * WORD_SIZE + 16];
    double lo, hi;
    for (int k = 0; k < s->curves; k++) {
        curve[k] = (struct chart_curve){ .block = k,
                                         .x = "$1",
                                         .y = "$2",
                                         .line = 1 + k,
                                         .as = CHART_BOTH,
                                         .point = 7 };
        snprintf(curve[k].text, sizeof curve[k].text, "%s", s->name[k]);
    }
    struct chart c = { .curve = curve,
                       .curves = s->curves,
                       .mark = mark,
                       .y = axis_of(s, 1, log) };
    range_of(s, 0, false, &lo, &hi);
    c.x = axis_of(s, 0, lo > 0 && hi / lo >= wide);
    for (size_t i = 0; i < s->n; i++)
        if (isnan(s->point[i].x) && c.marks < MARKS_MAX) {
            struct chart_mark *m = &mark[c.marks++];
            *m = (struct chart_mark){ .across = true, .at = s->point[i].y };
            snprintf(m->text, sizeof m->text, "%.60s",
                     s->mark[s->point[i].curve]);
        }
    const int rows = chart_key_rows(curve, s->curves);
    const double foot = 12;
    c.y0 = foot + rows * KEY_ROW + 4 + CHART_BELOW;
    c.y1 = c.y0 + PANEL;
    snprintf(title, sizeof title, "%s against %s", s->what[1], s->what[0]);
    figure_page(fig, FIGURE_PAGE, c.y1 + 18, title, "");
    chart_key(fig, curve, s->curves, foot + (rows - 1) * KEY_ROW);
    chart_column(&c, 0, 1, false);
    error_bars(fig, s, &c);
    chart_draw(fig, &c);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct series s = { .n = 0 };
    bool ok = series_read(&s, r->file, err) &&
              figure_open(&fig, r->output, &r->look, err);
    if (ok) {
        table_write(fig.table, &s, r->file);
        script_write(&fig, &s, r->log);
        plot_caption(&fig, &plot_series, r, NULL,
                     "What was measured, with standard errors.");
        ok = figure_draw(&fig, made, err);
    }
    free(s.point);
    return ok;
}

const struct plot plot_series = {
    .name = "series",
    .about = "curves of a table, with error bars",
    .subject = PLOT_FILE,
    .heeds = HEEDS_LOG,
    .file = "four columns: curve, x, y, error",
    .run = run,
};
