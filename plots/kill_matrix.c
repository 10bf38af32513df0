/* kill_matrix.c - which check fails for which mistake, and how small
 *
 * From a table of named columns (rows.h), as `make mutants` writes it to
 * build/mutants/kill-matrix.tsv:
 *
 *   name            of the mistake
 *   size            followed by a column for each check, its cells fails,
 *                   passes or - where it does not apply
 *   smallest scale  closes them: in (0, 1], the share of the mistake at which
 *                   a check still fails, or -
 *   status          a word, as caught
 */
#include <string.h>

#include "bsdf/utf8.h"
#include "plots/chart.h"
#include "plots/key.h"
#include "plots/kinds.h"
#include "plots/rows.h"
#include "plots/table.h"

#include <stdlib.h>

enum { MISTAKES_MAX = 200, CHECKS_MAX = 24 };

struct matrix {
    struct rows rows;
    int name, first, checks, scale, status; /* columns */
    double smallest[MISTAKES_MAX], least;
};

enum cell { NO_CELL, PASSES, FAILS };

static bool cell_read(const struct matrix *m, size_t row, int check,
                      enum cell *cell, struct err *err)
{
    const char *text = m->rows.row[row].field[m->first + check];
    *cell = strcmp(text, "fails") == 0    ? FAILS
            : strcmp(text, "passes") == 0 ? PASSES
                                          : NO_CELL;
    return *cell != NO_CELL || strcmp(text, "-") == 0 ||
           err_set(err, "%s:%zu: %s \"%.40s\": expected fails, passes or -",
                   m->rows.path, m->rows.row[row].line,
                   m->rows.name[m->first + check], text);
}

/* By a check that fails, or by the scale down to which one does. */
static bool found(const struct matrix *m, size_t row)
{
    enum cell cell;
    bool any = !isnan(m->smallest[row]);
    for (int k = 0; k < m->checks && !any; k++)
        any = cell_read(m, row, k, &cell, NULL) && cell == FAILS;
    return any;
}

static bool matrix_read(struct matrix *m, const char *path, struct err *err)
{
    if (!rows_read(&m->rows, path, err))
        return false;
    m->name = rows_column(&m->rows, "name", err);
    if (m->name < 0)
        return false;
    m->first = rows_column(&m->rows, "size", err) + 1;
    if (m->first < 1)
        return false;
    m->scale = rows_column(&m->rows, "smallest scale", err);
    if (m->scale < 0)
        return false;
    m->status = rows_column(&m->rows, "status", err);
    if (m->status < 0)
        return false;
    m->checks = m->scale - m->first;
    if (m->checks < 1 || m->checks > CHECKS_MAX)
        return err_set(err,
                       "%s: %d columns between \"size\" and \"smallest "
                       "scale\"; expected 1 to %d, one for each check",
                       path, m->checks, CHECKS_MAX);
    if (m->rows.n > MISTAKES_MAX)
        return err_set(err, "%s: %zu rows; expected at most %d", path,
                       m->rows.n, MISTAKES_MAX);
    m->least = 0.1;
    for (size_t i = 0; i < m->rows.n; i++) {
        enum cell cell;
        if (!rows_number(&m->rows, i, m->scale, 1e-300, 1, true,
                         &m->smallest[i], err))
            return false;
        if (m->smallest[i] < m->least)
            m->least = m->smallest[i];
        for (int k = 0; k < m->checks; k++)
            if (!cell_read(m, i, k, &cell, err))
                return false;
    }
    return true;
}

/* Blocks of what fails, of what passes, and of the scales; rows from above. */
static void table_write(FILE *out, const struct matrix *m)
{
    const double top = (double)m->rows.n - 0.5;
    table_comment(out, "made by", "bsdf-plot kill-matrix");
    table_comment(out, "file", m->rows.path);
    for (int which = FAILS; which >= PASSES; which--) {
        fprintf(out, "%s# check that %s\tmistake, from below\n",
                which == FAILS ? "" : "\n\n",
                which == FAILS ? "fails" : "passes");
        fputs("-9\t-9\n", out); /* no block is without a row */
        for (size_t i = 0; i < m->rows.n; i++)
            for (int k = 0; k < m->checks; k++) {
                enum cell cell;
                cell_read(m, i, k, &cell, NULL);
                if ((int)cell == which)
                    table_row(out, (double[]){ k + 0.5, top - (double)i }, 2);
            }
    }
    fputs("\n\n# smallest scale [1]\tmistake, from below\n1e9\t-9\n", out);
    for (size_t i = 0; i < m->rows.n; i++)
        if (!isnan(m->smallest[i]))
            table_row(out, (double[]){ m->smallest[i], top - (double)i }, 2);
}

enum { ROW = 15, CELL = 22, NAMES = 216, HEAD = 90 };

static void words(struct figure *fig, const struct matrix *m, double bottom,
                  double right)
{
    const double top = bottom + ROW * (double)m->rows.n;
    for (size_t i = 0; i < m->rows.n; i++) {
        const double y = top - ROW * ((double)i + 0.5);
        char text[64];
        char *plain = utf8_plain(m->rows.row[i].field[m->name]);
        snprintf(text, sizeof text, "%.28s", plain ? plain : "");
        figure_label(fig, NAMES - 8, y, "right", text);
        free(plain);
        plain = utf8_plain(m->rows.row[i].field[m->status]);
        snprintf(text, sizeof text, "%.18s", plain ? plain : "");
        figure_label(fig, right + 10, y, "left", text);
        free(plain);
    }
    for (int k = 0; k < m->checks; k++) {
        char text[32];
        char *plain = utf8_plain(m->rows.name[m->first + k]);
        snprintf(text, sizeof text, "%.14s", plain ? plain : "");
        figure_label_at(fig, text, "screen %.6g,%.6g left rotate by 90",
                        (NAMES + CELL * (k + 0.5)) / fig->width,
                        (top + 8) / fig->height);
        free(plain);
    }
}

static void script_write(struct figure *fig, const struct matrix *m)
{
    const double n = (double)m->rows.n;
    const double foot = 12, bottom = foot + 26 + CHART_BELOW;
    const double right = FIGURE_PAGE - 136;
    struct chart_curve curve[] = {
        { .block = 0,
          .x = "$1",
          .y = "$2",
          .line = 1,
          .as = CHART_POINTS,
          .point = 5,
          .text = "fails" },
        { .block = 1,
          .x = "$1",
          .y = "$2",
          .line = 8,
          .as = CHART_POINTS,
          .point = 6,
          .text = "passes" },
    };
    const struct chart_curve scale = { .block = 2,
                                       .x = "$1",
                                       .y = "$2",
                                       .line = 3,
                                       .as = CHART_POINTS,
                                       .point = 7 };
    char below[200];
    size_t caught = 0;
    for (size_t i = 0; i < m->rows.n; i++)
        caught += found(m, i);
    snprintf(below, sizeof below,
             "%zu mistakes, %zu of which some check finds; a blank: the check "
             "does not apply",
             m->rows.n, caught);
    figure_page(fig, FIGURE_PAGE, bottom + ROW * n + HEAD,
                "Which check fails for which mistake, and how small that may "
                "be",
                below);
    words(fig, m, bottom, right);
    chart_key(fig, curve, 2, foot + 8);
    struct chart c = {
        .x0 = NAMES,
        .x1 = NAMES + CELL * m->checks,
        .y0 = bottom,
        .y1 = bottom + ROW * n,
        .x = { .lo = 0, .hi = m->checks, .step = m->checks, .title = "check" },
        .y = { .lo = 0, .hi = n, .step = n },
        .bare_x = true,
        .bare_y = true,
        .curve = curve,
        .curves = 2,
    };
    for (int k = 0; k <= m->checks; k++)
        fprintf(fig->script,
                "set arrow from first %d, graph 0 to first %d, graph 1 nohead "
                "back lt %d\n",
                k, k, LINE_GRID);
    for (int i = 0; i <= (int)n; i++)
        fprintf(fig->script,
                "set arrow from screen %.6g, first %d to screen %.6g, first %d "
                "nohead back lt %d\n",
                NAMES / fig->width, i, right / fig->width, i, LINE_GRID);
    chart_draw(fig, &c);
    c.x0 = c.x1 + 14;
    c.x1 = right;
    c.x = chart_axis_log(m->least, 1, "smallest scale", "1");
    c.x.step = fmax(c.x.step, 3); /* it is narrow */
    c.bare_x = false;
    c.curve = &scale;
    c.curves = 1;
    chart_draw(fig, &c);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct matrix m = { .rows = { .n = 0 } };
    bool ok = matrix_read(&m, r->file, err) &&
              figure_open(&fig, r->output, &r->look, err);
    if (ok) {
        table_write(fig.table, &m);
        script_write(&fig, &m);
        plot_caption(
            &fig, &plot_kill_matrix, r, r->file,
            "Known mistakes, which check fails for each, and the "
            "smallest share of the mistake at which one still does. File:");
        ok = figure_draw(&fig, made, err);
    }
    rows_clear(&m.rows);
    return ok;
}

const struct plot plot_kill_matrix = {
    .name = "kill-matrix",
    .about = "which check finds which known mistake, from `make mutants`",
    .subject = PLOT_FILE,
    .file = "`make mutants`, build/mutants/kill-matrix.tsv",
    .run = run,
};
