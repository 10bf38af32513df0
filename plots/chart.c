/* chart.c - panels with two axes */
#include "plots/chart.h"

#include <math.h>
#include <string.h>

#include "plots/axis.h"
#include "plots/key.h"

enum { KEYS_MAX = 24 };

static void title_set(struct chart_axis *a, const char *what, const char *unit)
{
    char text[48];
    axis_unit(text, sizeof text, a->exponent, unit);
    if (a->exponent && strcmp(unit, "1") == 0) /* "10^3 1" is 10^3 */
        text[strcspn(text, " ")] = '\0';
    snprintf(a->title, sizeof a->title, "%s [%s]", what, text);
}

struct chart_axis chart_axis_exact(double lo, double hi, double step,
                                   const char *what, const char *unit)
{
    const double largest = fmax(fabs(lo), fabs(hi));
    struct chart_axis a = { .exponent = largest >= 1e4 || largest < 1e-2
                                            ? axis_exponent(largest)
                                            : 0 };
    const double scale = pow(10, a.exponent);
    a.lo = lo / scale;
    a.hi = hi / scale;
    a.step = step > 0                   ? step / scale
             : strcmp(unit, "deg") == 0 ? axis_step_deg(a.hi - a.lo)
                                        : axis_step(a.hi - a.lo, 5);
    title_set(&a, what, unit);
    return a;
}

struct chart_axis chart_axis(double lo, double hi, int n, const char *what,
                             const char *unit)
{
    if (!(hi > lo)) {
        const double room = hi != 0 ? 0.1 * fabs(hi) : 1;
        lo -= lo == 0 ? 0 : room;
        hi += room;
    }
    const double step = axis_step((hi - lo) * 1.02, n);
    return chart_axis_exact(floor(lo / step + 1e-9) * step,
                            ceil(hi / step - 1e-9) * step, step, what, unit);
}

struct chart_axis chart_axis_log(double lo, double hi, const char *what,
                                 const char *unit)
{
    const double from = floor(log10(lo) + 1e-9), to = ceil(log10(hi) - 1e-9);
    struct chart_axis a = { .log = true,
                            .lo = pow(10, from),
                            .hi = pow(10, fmax(to, from + 1)) };
    a.step = fmax(ceil(log10(a.hi / a.lo) / 8), 1);
    title_set(&a, what, unit);
    return a;
}

/* Marks every decade, and names every so many. */
static void decades(struct figure *fig, const struct chart_axis *a, char which,
                    bool bare, bool outward)
{
    FILE *out = fig->script;
    const int from = (int)lround(log10(a->lo)), to = (int)lround(log10(a->hi));
    fprintf(out,
            "set logscale %c; set %crange [%.10g:%.10g]\n"
            "set %ctics nomirror %s scale 0.7,0.4 (",
            which, which, a->lo * (1 - 1e-6), a->hi * (1 + 1e-6), which,
            outward ? "out" : "in");
    for (int e = from; e <= to; e++) {
        char name[32];
        axis_unit(name, sizeof name, e, "");
        name[strcspn(name, " ")] = '\0';
        fputs(e > from ? ", " : "", out);
        figure_text(fig, bare || (to - e) % (int)a->step ? "" : e ? name : "1");
        fprintf(out, " 1e%d", e);
    }
    fputs(")\n", out);
}

static void axis_set(struct figure *fig, const struct chart_axis *a, char which,
                     bool bare, bool out)
{
    if (a->log) {
        decades(fig, a, which, bare, out);
        return;
    }
    const double room = 1e-7 * (a->hi - a->lo); /* for points on the edge */
    fprintf(
        fig->script,
        "unset logscale %c; set %crange [%.12g:%.12g]\n"
        "set %ctics autofreq %.10g nomirror %s scale 0.7,0.4 format \"%s\"\n",
        which, which, a->lo - room, a->hi + room, which, a->step,
        out ? "out" : "in", bare ? "" : fig->form->number);
}

static void marks(struct figure *fig, const struct chart *c)
{
    for (int i = 0; i < c->marks; i++) {
        const struct chart_mark *m = &c->mark[i];
        const struct chart_axis *a = m->across ? &c->y : &c->x;
        const double scale = a->log ? 1 : pow(10, a->exponent);
        const double at = m->at / scale;
        if (!(at >= a->lo && at <= a->hi))
            continue;
        if (m->across) {
            fprintf(fig->script,
                    "set arrow from graph 0, first %.10g to graph 1, first "
                    "%.10g nohead back lt %d\n",
                    at, at, LINE_REFERENCE);
            if (m->text[0])
                figure_label_at(fig, m->text,
                                "graph 0.985, first %.10g right offset 0,0.5 "
                                "tc rgb \"#505050\"",
                                at);
            continue;
        }
        fprintf(fig->script,
                "set arrow from first %.10g, graph 0 to first %.10g, graph 1 "
                "nohead back lt %d\n",
                at, at, LINE_REFERENCE);
        if (m->text[0])
            figure_label_at(fig, m->text,
                            "first %.10g, graph 1.045 center tc rgb "
                            "\"#505050\"",
                            at);
    }
}

/* A column divided by the power of ten of its axis. */
static void column(FILE *out, const char *text, const struct chart_axis *a)
{
    if (a->log || a->exponent == 0)
        fprintf(out, "(%s)", text);
    else
        fprintf(out, "((%s)/1e%d)", text, a->exponent);
}

static void curve(FILE *out, const struct chart *c, const struct chart_curve *k)
{
    fprintf(out, "     table index %d using ", k->block);
    column(out, k->x, &c->x);
    fputc(':', out);
    column(out, k->y, &c->y);
    if (k->as == CHART_FILL) {
        fputc(':', out);
        column(out, k->y2, &c->y);
        fputs(" with filledcurves fc rgb \"#d0d0d0\" fs solid 1 noborder "
              "notitle",
              out);
        return;
    }
    if (k->as == CHART_POINTS || k->as == CHART_BOTH)
        fprintf(out, " with %s lt %d pt %d ps 0.6 notitle",
                k->as == CHART_BOTH ? "linespoints" : "points", k->line,
                k->point);
    else
        fprintf(out, " with %s lt %d notitle",
                k->as == CHART_STEPS ? "steps" : "lines", k->line);
}

static void map(struct figure *fig, const struct chart *c)
{
    FILE *out = fig->script;
    const struct chart_map *m = c->map;
    fprintf(out,
            "set palette @%s\n%s logscale cb; set cbrange [%.10g:%.10g]\n"
            "plot table index %d using ",
            m->palette, m->log ? "set" : "unset", m->lo, m->hi, m->block);
    column(out, m->x, &c->x);
    fputc(':', out);
    column(out, m->y, &c->y);
    fprintf(out, ":(%s) with %s notitle%s\n", m->z, fig->form->cells,
            c->also ? c->also : "");
}

void chart_draw(struct figure *fig, const struct chart *c)
{
    FILE *out = fig->script;
    const double w = fig->width, h = fig->height;
    fprintf(out, "\n# %s\n", c->title ? c->title : c->y.title);
    figure_panel(fig, c->x0, c->x1, c->y0, c->y1);
    fprintf(out, "unset key; set border %d lc rgb \"#505050\"; set clip two\n",
            c->map ? 15 : 3);
    axis_set(fig, &c->x, 'x', c->bare_x, c->map);
    axis_set(fig, &c->y, 'y', c->bare_y, c->map);
    if (c->title)
        figure_label_at(fig, c->title, "screen %.6g,%.6g center",
                        (c->x0 + c->x1) / 2 / w, (c->y1 + 14) / h);
    if (!c->bare_x)
        figure_label_at(fig, c->x.title, "screen %.6g,%.6g center",
                        (c->x0 + c->x1) / 2 / w, (c->y0 - 38) / h);
    if (!c->bare_y)
        figure_label_at(fig, c->y.title, "screen %.6g,%.6g center rotate by 90",
                        (c->x0 - CHART_LEFT + 20) / w, (c->y0 + c->y1) / 2 / h);
    marks(fig, c);
    if (c->map) {
        map(fig, c);
    } else {
        fputs("plot \\\n", out);
        for (int i = 0; i < c->curves; i++) {
            curve(out, c, &c->curve[i]);
            fputs(i + 1 < c->curves ? ", \\\n" : "", out);
        }
        fprintf(out, "%s\n", c->also ? c->also : "");
    }
    fputs("unset arrow; unset label; unset colorbox\n", out);
}

void chart_column(struct chart *c, int i, int n, bool shared)
{
    const double left = CHART_LEFT + 4, right = 26;
    const double gap = shared ? 26 : CHART_LEFT + 14;
    const double wide = (FIGURE_PAGE - left - right - (n - 1) * gap) / n;
    c->x0 = left + i * (wide + gap);
    c->x1 = c->x0 + wide;
    c->bare_y = shared && i > 0;
}

void chart_notes(struct figure *fig, double y, const char *const *line, int n)
{
    for (int i = 0; i < n; i++)
        figure_label(fig, FIGURE_PAGE / 2., y - CHART_NOTE * (i + 0.5),
                     "center", line[i]);
}

void chart_bar(struct figure *fig, double x0, double x1, double y,
               const struct chart_map *m, double step, const char *title)
{
    fprintf(fig->script,
            "set colorbox horizontal user origin screen %.6g,%.6g size screen "
            "%.6g,%.6g border\n"
            "set cbtics %s scale 0.5",
            x0 / fig->width, y / fig->height, (x1 - x0) / fig->width,
            CHART_BAR / fig->height, m->log ? "autofreq" : "");
    if (m->log) {
        const int from = (int)floor(log10(m->lo)), to = (int)ceil(log10(m->hi));
        const char *between = " (";
        for (int e = from; e <= to; e++) {
            char name[32];
            axis_unit(name, sizeof name, e, "");
            name[strcspn(name, " ")] = '\0';
            fputs(between, fig->script);
            figure_text(fig, e ? name : "1");
            fprintf(fig->script, " 1e%d", e);
            between = ", ";
        }
        fputs(")\n", fig->script);
    } else {
        fprintf(fig->script, " %.10g format \"%s\"\n", step, fig->form->number);
    }
    figure_label(fig, (x0 + x1) / 2, y - 34, "center", title);
}

/* Entries for the key; how many. */
static int entries(const struct chart_curve *curve, int n,
                   struct key_entry entry[KEYS_MAX])
{
    int k = 0;
    for (int i = 0; i < n && k < KEYS_MAX; i++) {
        const struct chart_curve *c = &curve[i];
        if (!c->text[0])
            continue;
        entry[k] = (struct key_entry){ .look = "" };
        if (c->as == CHART_FILL)
            strcpy(entry[k].look, "nohead lc rgb \"#d0d0d0\" lw 8");
        else if (c->as != CHART_POINTS)
            snprintf(entry[k].look, sizeof entry[k].look, "nohead lt %d",
                     c->line);
        if (c->as == CHART_POINTS || c->as == CHART_BOTH)
            snprintf(entry[k].point, sizeof entry[k].point,
                     "lt %d pt %d ps 0.6 front", c->line, c->point);
        snprintf(entry[k].text, sizeof entry[k].text, "%s", c->text);
        k++;
    }
    return k;
}

int chart_key_rows(const struct chart_curve *curve, int n)
{
    struct key_entry entry[KEYS_MAX];
    return key_rows(entry, entries(curve, n, entry), FIGURE_PAGE);
}

void chart_key(struct figure *fig, const struct chart_curve *curve, int n,
               double y)
{
    struct key_entry entry[KEYS_MAX];
    key_draw(fig, entry, entries(curve, n, entry), y);
}
