/* writeup.c - a text, its figures and its numbers as HTML or as LaTeX
 *
 * The text says what is done and seen; every number in it stands in a table
 * beside the figures, or in a report of bsdf-validate, and is named in braces.
 * One source serves both forms.  By the beginning of a line:
 *
 *   =, ==, ===    title and headings
 *   $$            a formula in a line of its own, in LaTeX (mathml.h)
 *   !             NAME | caption: a figure; figures in lines that follow each
 *                 other stand side by side
 *   |             a row of a table, cells between |; the first is its head
 *   -             an item of a list
 *   >             a file, as it stands
 *   #             left out
 *
 * and everything else is a paragraph up to an empty line.  Within them {NAME}
 * is a number or a word, {NAME %.3f} so formatted, {100 NAME %.1f} and times
 * 100; `code`, *emphasis*, $formula$.
 *
 * Names are looked up in the folder of the output: numbers.tsv, with columns
 * `name` and `value`; else in R.json for R.CHECK.FIELD, of the direction where
 * that check does worst.  A figure is NAME.svg or NAME.png; for LaTeX
 * tex/NAME.tex comes first.  Beside it lie its data (NAME.tsv or NAME.exr) and
 * its script (NAME.gp or NAME.sh); those of NAME_rate are NAME's.  What is
 * missing is an error.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bsdf/cli.h"
#include "plots/html.h"
#include "plots/kinds.h"
#include "plots/mathml.h"
#include "plots/rows.h"
#include "plots/text.h"
#include "validate/recorded.h"
#include "validate/report.h"

enum { PATH_SIZE = 4352, CELLS_MAX = 16, ROW_MAX = 16, WORD_MAX = 512 };

struct page {
    FILE *out;
    bool tex;
    const char *path; /* of the text */
    size_t line;
    char *folder;
    struct rows numbers;
    int name_column, value_column;
    char report_name[64]; /* of the report that was read last, or "" */
    struct recorded report;
    int pictures;
};

/* Puts the text's file and line before what went wrong. */
static bool at_line(const struct page *p, struct err *err)
{
    struct err why = *err;
    return err_set(err, "%s:%zu: %.900s", p->path, p->line, why.text);
}

/* FOLDER/NAME and an ending. */
static const char *beside(const struct page *p, char path[PATH_SIZE],
                          const char *name, const char *ending)
{
    snprintf(path, PATH_SIZE, "%s/%s%s", p->folder, name, ending);
    return path;
}

/* -- numbers ----------------------------------------------------------------
 */

static const struct verdict *worst(const struct recorded *r, const char *check)
{
    const struct verdict *w = NULL;
    for (size_t i = 0; i < r->results; i++)
        for (size_t k = 0; k < r->result[i].verdicts; k++) {
            const struct verdict *v = &r->result[i].verdict[k];
            if (strcmp(v->check, check) == 0 && (!w || report_worse(v, w)))
                w = v;
        }
    return w;
}

static bool field_of(const struct verdict *v, const char *field, char *text,
                     size_t size, struct err *err)
{
    static const char *const fields[] = { "value",     "limit", "p",
                                          "theta",     "wi",    "note",
                                          "diagnosis", "found", "verdict",
                                          NULL };
    const double number[] = { v->value, v->limit, v->p,
                              dir_to_degrees(v->wo).theta_deg,
                              dir_to_degrees(v->wi).theta_deg };
    for (size_t i = 0; i < sizeof number / sizeof *number; i++)
        if (strcmp(field, fields[i]) == 0) {
            snprintf(text, size, "%.17g", number[i]);
            return true;
        }
    const char *word = strcmp(field, "note") == 0        ? v->note
                       : strcmp(field, "diagnosis") == 0 ? v->diagnosis
                       : strcmp(field, "found") == 0     ? v->effect
                       : strcmp(field, "verdict") != 0   ? NULL
                       : !v->applies                     ? "does not apply"
                       : v->passed                       ? "passes"
                                                         : "fails";
    if (!word)
        return err_unknown(err, "a verdict's field", field, fields);
    snprintf(text, size, "%s", word);
    return true;
}

/* R.CHECK.FIELD, or R.passed and R.failed. */
static bool from_report(struct page *p, const char *name, char *text,
                        size_t size, struct err *err)
{
    char report[64], check[32], field[32], path[PATH_SIZE];
    const int words =
        sscanf(name, "%63[^.].%31[^.].%31s", report, check, field);
    const bool counts = words == 2 && (strcmp(check, "passed") == 0 ||
                                       strcmp(check, "failed") == 0);
    beside(p, path, words >= 2 ? report : "", ".json");
    if ((words != 3 && !counts) || access(path, R_OK) != 0)
        return err_set(err,
                       "{%.80s}: no such number in %s, and no report of that "
                       "name",
                       name, p->numbers.path);
    if (strcmp(p->report_name, report) != 0) {
        if (p->report_name[0])
            recorded_clear(&p->report);
        p->report_name[0] = '\0';
        if (!recorded_read(&p->report, path, err))
            return false;
        strcpy(p->report_name, report);
    }
    if (counts) {
        snprintf(text, size, "%zu",
                 check[0] == 'p' ? p->report.passed : p->report.failed);
        return true;
    }
    const struct verdict *v = worst(&p->report, check);
    return v ? field_of(v, field, text, size, err)
             : err_set(err, "%s: no check \"%s\"", path, check);
}

static bool look_up(struct page *p, const char *name, char *text, size_t size,
                    struct err *err)
{
    const struct rows *r = &p->numbers;
    for (size_t i = 0; i < r->n; i++)
        if (strcmp(r->row[i].field[p->name_column], name) == 0) {
            snprintf(text, size, "%s", r->row[i].field[p->value_column]);
            return true;
        }
    return from_report(p, name, text, size, err);
}

/* %, perhaps digits behind a point, and one of f, e, g. */
static bool format_ok(const char *format)
{
    if (*format++ != '%')
        return false;
    if (*format == '+')
        format++;
    if (*format == '.' && strspn(format + 1, "0123456789") == 1)
        format += 2;
    return strchr("feg", *format) && *format && !format[1];
}

/* "NAME", "NAME %.3f", "100 NAME %.1f" to what it stands for. */
static bool value_of(struct page *p, const char *what, char *text, size_t size,
                     struct err *err)
{
    char name[128], format[16] = "", *end;
    double factor = strtod(what, &end);
    if (end == what || *end != ' ')
        factor = 1;
    else
        what = end + 1;
    const int words = sscanf(what, "%127s %15s", name, format);
    if (words < 1)
        return err_set(err, "{}: expected a name");
    if (!look_up(p, name, text, size, err))
        return false;
    if (words < 2)
        return true;
    if (!format_ok(format))
        return err_set(err, "{%s %s}: expected a format like %%.3f", name,
                       format);
    const double x = strtod(text, &end);
    if (end == text || *end)
        return err_set(err, "{%s %s}: \"%.80s\" is no number", name, format,
                       text);
    snprintf(text, size, format, factor * x);
    return true;
}

/* -- running text -----------------------------------------------------------
 */

static void plain(struct page *p, const char *text)
{
    char *tex = p->tex ? text_tex(text) : NULL;
    if (p->tex)
        fputs(tex ? tex : "", p->out);
    else
        html_text(p->out, text);
    free(tex);
}

/* A run of n bytes. */
static void run_of(struct page *p, const char *text, size_t n)
{
    char *part = strndup(text, n);
    plain(p, part ? part : "");
    free(part);
}

/* Long words of it may go on in the next line behind punctuation. */
static void code(struct page *p, const char *text)
{
    char *tex = p->tex ? text_tex_spec(text) : NULL;
    fputs(tex ? tex : "", p->out);
    free(tex);
    while (!p->tex && *text) {
        const size_t n = text_piece(text);
        run_of(p, text, n);
        text += n;
        fputs(*text ? "<wbr/>" : "", p->out);
    }
}

static bool inline_text(struct page *p, const char *text, struct err *err);

/* What stands between a sign and the next one like it. */
static bool between(struct page *p, char sign, const char *inside,
                    struct err *err)
{
    FILE *out = p->out;
    bool ok = true;
    if (sign == '$') {
        if (!p->tex)
            return mathml(out, inside, false, err);
        fprintf(out, "$%s$", inside);
    } else if (sign == '{') {
        char value[WORD_MAX];
        ok = value_of(p, inside, value, sizeof value, err);
        if (ok)
            code(p, value);
    } else if (sign == '*') {
        fputs(p->tex ? "\\emph{" : "<em>", out);
        ok = inline_text(p, inside, err);
        fputs(p->tex ? "}" : "</em>", out);
    } else {
        fputs(p->tex ? "\\texttt{" : "<code>", out);
        if (*inside == '{' && inside[strlen(inside) - 1] == '}') {
            ok = inline_text(p, inside, err);
        } else {
            code(p, inside);
        }
        fputs(p->tex ? "}" : "</code>", out);
    }
    return ok;
}

static bool inline_text(struct page *p, const char *text, struct err *err)
{
    bool ok = true;
    while (ok && *text) {
        const size_t n = strcspn(text, "{`*$");
        if (n > 0)
            run_of(p, text, n);
        text += n;
        if (!*text)
            break;
        const char sign = *text++;
        const char *end = strchr(text, sign == '{' ? '}' : sign);
        if (!end)
            return err_set(err, "\"%c%.40s\": it does not end in this block",
                           sign, text);
        char *inside = strndup(text, (size_t)(end - text));
        ok = inside ? between(p, sign, inside, err)
                    : err_set(err, "out of memory");
        free(inside);
        text = end + 1;
    }
    return ok;
}

static bool tagged(struct page *p, const char *html, const char *tex,
                   const char *text, struct err *err)
{
    if (p->tex)
        fprintf(p->out, "%s", tex);
    else
        fprintf(p->out, "<%s>", html);
    const bool ok = inline_text(p, text, err);
    if (p->tex)
        fputs(*tex ? "}\n\n" : "\n\n", p->out);
    else
        fprintf(p->out, "</%s>\n", html);
    return ok;
}

/* -- figures ----------------------------------------------------------------
 */

struct shown {
    char name[64];
    const char *caption;       /* borrowed from the text */
    bool vector;               /* else pixels */
    const char *data, *script; /* their endings */
};

static bool there(const struct page *p, const char *name, const char *ending)
{
    char path[PATH_SIZE];
    return access(beside(p, path, name, ending), R_OK) == 0;
}

/* Whose data and script a figure has. */
static void origin(const struct shown *s, char name[64])
{
    const size_t n = strlen(s->name), k = strlen("_rate");
    strcpy(name, s->name);
    if (n > k && strcmp(s->name + n - k, "_rate") == 0)
        name[n - k] = '\0';
}

/* "NAME | caption". */
static bool shown_of(const struct page *p, char *text, struct shown *s,
                     struct err *err)
{
    char own[64];
    char *bar = strstr(text, " | ");
    const size_t n = bar ? (size_t)(bar - text) : 0;
    if (n == 0 || n >= sizeof s->name || memchr(text, '/', n))
        return err_set(err, "\"! %.40s\": expected NAME | caption", text);
    memcpy(s->name, text, n);
    s->name[n] = '\0';
    s->caption = bar + 3;
    s->vector = there(p, s->name, ".svg");
    origin(s, own);
    s->data = there(p, own, ".exr")   ? ".exr"
              : there(p, own, ".tsv") ? ".tsv"
                                      : NULL;
    s->script = there(p, own, ".gp") ? ".gp" : there(p, own, ".sh") ? ".sh" : 0;
    if (!s->vector && !there(p, s->name, ".png"))
        return err_set(err, "figure %s: neither %s/%s.svg nor .png", s->name,
                       p->folder, s->name);
    if (!s->data || !s->script)
        return err_set(err, "figure %s: no %s in %s", s->name,
                       s->data ? "script (.gp or .sh)" : "data (.tsv or .exr)",
                       p->folder);
    return true;
}

/* Small files come along, pictures of floats lie beside the page. */
static bool sources_html(struct page *p, const struct shown *s, struct err *err)
{
    FILE *out = p->out;
    char own[64], path[PATH_SIZE];
    origin(s, own);
    const bool table = strcmp(s->data, ".tsv") == 0;
    fprintf(out,
            "<details><summary>data and script</summary><p>data: <a href=\"");
    if (table && !html_data(out, "text/tab-separated-values",
                            beside(p, path, own, s->data), err))
        return false;
    if (table)
        fprintf(out, "\" download=\"%s%s\">%s%s</a>", own, s->data, own,
                s->data);
    else
        fprintf(out, "%s%s\">%s%s</a>, beside this page", own, s->data, own,
                s->data);
    fprintf(out, "; script: <a download=\"%s%s\" href=\"", own, s->script);
    if (!html_data(out, "text/plain", beside(p, path, own, s->script), err))
        return false;
    fprintf(out, "\">%s%s</a></p>", own, s->script);
    if (there(p, own, ".sh")) {
        char *text = html_file(beside(p, path, own, ".sh"));
        fputs("<pre>", out);
        /* The text is made one of lines again: each by itself. */
        char *rest = text;
        for (char *line; rest && (line = strsep(&rest, "\n"));)
            if (*line && *line != '#') {
                html_text(out, line);
                fputc('\n', out);
            }
        fputs("</pre>", out);
        free(text);
    }
    fputs("</details>", out);
    return true;
}

static bool figure_html(struct page *p, const struct shown *s, struct err *err)
{
    FILE *out = p->out;
    char path[PATH_SIZE];
    bool ok = true;
    fprintf(out, "<figure id=\"%s\">", s->name);
    if (s->vector) {
        char *svg = html_file(beside(p, path, s->name, ".svg"));
        fputs("<div class=\"scroll\">", out);
        if (svg)
            html_svg(out, svg, p->pictures);
        fputs("</div>", out);
        free(svg);
    } else {
        fprintf(out, "<img alt=\"%s\" src=\"", s->name);
        ok = html_data(out, "image/png", beside(p, path, s->name, ".png"), err);
        fputs("\"/>", out);
    }
    fprintf(out, "<figcaption><b>%d</b> ", p->pictures);
    ok = ok && inline_text(p, s->caption, err);
    fputs("</figcaption>", out);
    ok = ok && sources_html(p, s, err);
    fputs("</figure>\n", out);
    return ok;
}

static bool figure_tex(struct page *p, const struct shown *s, int across,
                       struct err *err)
{
    char own[64], path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/tex/%s.tex", p->folder, s->name);
    fprintf(p->out,
            "\\begin{minipage}[t]{%.3f\\linewidth}\\vspace{0pt}\\centering\n",
            across > 1 ? 0.97 / across : 1.);
    if (s->vector && access(path, R_OK) == 0)
        fprintf(p->out, "\\resizebox{\\linewidth}{!}{\\input{tex/%s}}\\par\n",
                s->name);
    else if (s->vector)
        return err_set(err, "figure %s: no %s", s->name, path);
    else
        fprintf(p->out, "\\includegraphics[width=\\linewidth]{%s.png}\\par\n",
                s->name);
    origin(s, own);
    fprintf(p->out, "\\raggedright\\small\\textbf{%d} ", p->pictures);
    const bool ok = inline_text(p, s->caption, err);
    fputs(" \\textup{(", p->out);
    plain(p, own);
    fprintf(p->out, "\\texttt{%s}, ", s->data);
    fprintf(p->out, "\\texttt{%s})}\\end{minipage}", s->script);
    return ok;
}

/* Figures side by side: as many in a line as are not too small. */
static bool figures(struct page *p, struct shown *s, int n, struct err *err)
{
    const int most = s[0].vector ? 2 : 4;
    const int across = n < most ? n : most;
    bool ok = true;
    fputs(p->tex        ? "\n\\noindent"
          : s[0].vector ? "<div class=\"plots\">\n"
          : n <= 3      ? "<div class=\"renders few\">\n"
                        : "<div class=\"renders\">\n",
          p->out);
    for (int i = 0; ok && i < n; i++) {
        p->pictures++;
        ok = p->tex ? figure_tex(p, &s[i], across, err)
                    : figure_html(p, &s[i], err);
        if (p->tex)
            fputs(i == n - 1              ? "\\par\\medskip\n\n"
                  : (i + 1) % across == 0 ? "\\par\\medskip\\noindent\n"
                                          : "\\hspace*{.01\\linewidth}%\n",
                  p->out);
    }
    if (!p->tex)
        fputs("</div>\n", p->out);
    return ok;
}

/* -- blocks -----------------------------------------------------------------
 */

/* Cuts "| a | b |" at its bars; how many cells. */
static int cells_of(char *line, char *cell[CELLS_MAX])
{
    int n = 0;
    char *rest = line + 1, *bar = strrchr(rest, '|');
    if (bar)
        *bar = '\0';
    for (char *c; n < CELLS_MAX && (c = strsep(&rest, "|"));) {
        c += strspn(c, " ");
        char *end = c + strlen(c);
        while (end > c && end[-1] == ' ')
            *--end = '\0';
        cell[n++] = c;
    }
    return n;
}

static bool table_row_out(struct page *p, char *line, bool head, int *columns,
                          struct err *err)
{
    char *cell[CELLS_MAX];
    const int n = cells_of(line, cell);
    bool ok = true;
    if (head && p->tex) {
        fputs("\n\\begin{center}\\small\\begin{lrbox}{\\rows}"
              "\\begin{tabular}{",
              p->out);
        for (int i = 0; i < n; i++)
            fputc(i ? 'r' : 'l', p->out);
        fputs("}\\hline\n", p->out);
    } else if (head) {
        fputs("<div class=\"scroll rows\"><table><thead>", p->out);
    }
    if (head)
        *columns = n;
    else if (n != *columns)
        return err_set(err, "%d cells; expected %d, as in the table's head", n,
                       *columns);
    fputs(p->tex ? "" : "<tr>", p->out);
    for (int i = 0; ok && i < n; i++) {
        const char *tag = head ? "th" : "td";
        if (!p->tex)
            fprintf(p->out, "<%s%s>", tag, i ? " class=\"n\"" : "");
        else if (i)
            fputs(" & ", p->out);
        ok = inline_text(p, cell[i], err);
        if (!p->tex)
            fprintf(p->out, "</%s>", tag);
    }
    fputs(p->tex ? head ? "\\\\\\hline\n" : "\\\\\n"
          : head ? "</tr></thead><tbody>\n"
                 : "</tr>\n",
          p->out);
    return ok;
}

static void table_end(struct page *p)
{
    fputs(p->tex ? "\\hline\\end{tabular}\\end{lrbox}\\fitting"
                   "\\end{center}\n\n"
                 : "</tbody></table></div>\n",
          p->out);
}

/* For TeX, which makes one of several spaces. */
static void aligned(struct page *p, const char *line)
{
    while (*line) {
        const size_t n = strcspn(line, " "), spaces = strspn(line + n, " ");
        char *word = strndup(line, n);
        code(p, word ? word : "");
        free(word);
        for (size_t i = 0; i < spaces; i++)
            fputs(spaces == 1 ? " " : "~", p->out);
        line += n + spaces;
    }
}

/* Lines of a file as they stand. */
static bool verbatim(struct page *p, const char *name, struct err *err)
{
    char path[PATH_SIZE];
    char *text = html_file(beside(p, path, name, ""));
    if (!text)
        return err_set(err, "%s: cannot be read: %s", path, strerror(errno));
    fputs(p->tex ? "\n{\\scriptsize\\begin{flushleft}\\ttfamily\n"
                 : "<pre class=\"file\">",
          p->out);
    char *rest = text;
    for (char *line; (line = strsep(&rest, "\n"));) {
        if (!rest && !*line)
            break;
        if (p->tex) {
            const size_t n = strspn(line, " ");
            fprintf(p->out, "\\mbox{}\\hspace*{%zu.5em}", n / 2);
            aligned(p, line + n);
            fputs("\\\\\n", p->out);
        } else {
            html_text(p->out, line);
            fputc('\n', p->out);
        }
    }
    fputs(p->tex ? "\\end{flushleft}}\n\n" : "</pre>\n", p->out);
    free(text);
    return true;
}

static const char style[] =
    "body{max-width:80rem}"
    "p,li{max-width:46rem}"
    "pre{max-width:60rem;overflow-x:auto}"
    "pre.file{white-space:pre;max-width:100%}"
    "math[display=block]{margin:.7rem 0 .7rem 1.5rem;width:fit-content;"
    "overflow-x:auto;overflow-y:hidden;font-size:1.1rem;max-width:100%}"
    "thead th{white-space:normal;vertical-align:bottom}"
    "code,pre{font-family:ui-monospace,monospace;font-size:.85em}"
    ".n{text-align:right;font-variant-numeric:tabular-nums}"
    ".scroll{max-width:60rem}.rows{width:fit-content;max-width:100%}"
    "th,td{overflow-wrap:normal}"
    ".plots .scroll{max-width:100%}"
    ".renders,.plots{display:grid;gap:1rem;margin:1rem 0}"
    ".renders{grid-template-columns:repeat(auto-fill,minmax(min(100%,17rem),"
    "1fr))}"
    ".few{grid-template-columns:repeat(auto-fill,minmax(min(100%,24rem),1fr))}"
    ".plots{grid-template-columns:repeat(auto-fill,minmax(min(100%,34rem),"
    "1fr))}"
    "img{display:block;width:100%;image-rendering:pixelated;background:#000}"
    "figure svg{display:block;width:100%;height:auto;min-width:540px}"
    "figcaption{margin-top:.3rem}"
    "figure details{font-size:.8rem;padding:.1rem .5rem}"
    "figure details p{margin:.3rem 0}"
    "@media(max-width:40rem){body{padding:.6rem}"
    "math[display=block]{margin-left:0;font-size:.95rem}}"
    "@media print{body{max-width:none;font-size:11px}figure,tr{break-inside:"
    "avoid}*{print-color-adjust:exact}}";

static const char preamble[] =
    "% Made by bsdf-plot writeup.  The figures lie beside it and in tex/.\n"
    "\\documentclass[a4paper]{article}\n"
    "\\usepackage[utf8]{inputenc}\n"
    "\\usepackage{amsmath}\n"
    "\\usepackage{graphicx}\n"
    "\\usepackage{color}\n"
    "\\usepackage[margin=22mm]{geometry}\n"
    "\\graphicspath{{tex/}{./}}\n"
    "\\setlength{\\parindent}{0pt}\\setlength{\\parskip}{.6em}\n"
    "\\emergencystretch=4em\n"
    "\\newsavebox{\\rows}\n"
    "\\newcommand{\\fitting}{\\ifdim\\wd\\rows>\\linewidth\n"
    "  \\resizebox{\\linewidth}{!}{\\usebox{\\rows}}"
    "\\else\\usebox{\\rows}\\fi}\n"
    "\\renewcommand{\\labelitemi}{$\\bullet$}\n";

static bool title(struct page *p, const char *text, struct err *err)
{
    if (!p->tex) {
        html_head(p->out, text, style);
        fputs("<body>\n", p->out);
        return tagged(p, "h1", "", text, err);
    }
    fprintf(p->out, "%s\\begin{document}\n", preamble);
    return tagged(p, "", "{\\LARGE\\bfseries ", text, err);
}

enum block {
    TEXT,
    TITLE,
    HEADING,
    SUBHEADING,
    FORMULA,
    FIGURE,
    ROW,
    ITEM,
    VERBATIM,
    COMMENT,
    EMPTY
};

/* What a line is, and what is behind its sign. */
static enum block block_of(char *line, char **rest)
{
    static const struct {
        const char *sign;
        enum block is;
    } signs[] = {
        { "=== ", SUBHEADING }, { "== ", HEADING }, { "= ", TITLE },
        { "$$ ", FORMULA },     { "! ", FIGURE },   { "- ", ITEM },
        { "> ", VERBATIM },     { "#", COMMENT },
    };
    *rest = line;
    if (line[strspn(line, " \t\r")] == '\0')
        return EMPTY;
    if (*line == '|')
        return ROW;
    for (size_t i = 0; i < sizeof signs / sizeof *signs; i++)
        if (strncmp(line, signs[i].sign, strlen(signs[i].sign)) == 0) {
            *rest = line + strlen(signs[i].sign);
            return signs[i].is;
        }
    return TEXT;
}

/* Lines from line i on that are one block; how many. */
static size_t joined(char **line, size_t i, size_t n, enum block first)
{
    size_t k = i + 1;
    char *rest;
    while (k < n && (first == TEXT || first == ITEM || first == FIGURE) &&
           block_of(line[k], &rest) == TEXT)
        k++;
    return k - i;
}

/* Their text in one; owned by the caller. */
static char *join(char *first, char **line, size_t i, size_t k)
{
    char *text = NULL;
    size_t size;
    FILE *mem = open_memstream(&text, &size);
    if (!mem)
        return NULL;
    fputs(first, mem);
    for (size_t m = 1; m < k; m++)
        fprintf(mem, " %s", line[i + m] + strspn(line[i + m], " "));
    fclose(mem);
    return text;
}

/* Figures, rows or items that follow each other. */
static bool sequence(struct page *p, enum block kind, char **line, size_t n,
                     size_t *i, struct err *err)
{
    struct shown shown[ROW_MAX] = { { .caption = NULL } };
    char *text[ROW_MAX], *rest;
    int count = 0, columns = 0, owned = 0;
    bool ok = true;
    if (kind == ITEM)
        fputs(p->tex ? "\\begin{itemize}\n" : "<ul>\n", p->out);
    while (ok && *i < n && block_of(line[*i], &rest) == kind) {
        const size_t k = joined(line, *i, n, kind);
        p->line = *i + 1;
        char *all = join(rest, line, *i, k);
        *i += k;
        if (!all) {
            ok = err_set(err, "out of memory");
        } else if (kind == ROW) {
            ok = table_row_out(p, all, count++ == 0, &columns, err);
            free(all);
        } else if (kind == ITEM) {
            ok = tagged(p, "li", "\\item{", all, err);
            free(all);
        } else {
            text[owned++] = all;
            ok = shown_of(p, all, &shown[count++], err) &&
                 (count < ROW_MAX || err_set(err, "too many figures in a row"));
        }
    }
    if (kind == ITEM)
        fputs(p->tex ? "\\end{itemize}\n" : "</ul>\n", p->out);
    else if (kind == ROW)
        table_end(p);
    else if (ok && count > 0)
        ok = figures(p, shown, count, err);
    while (owned > 0)
        free(text[--owned]);
    return ok;
}

static bool formula(struct page *p, const char *text, struct err *err)
{
    bool ok = true;
    if (p->tex)
        fprintf(p->out, "\\[ %s \\]\n", text);
    else
        ok = mathml(p->out, text, true, err);
    fputc('\n', p->out);
    return ok;
}

static bool single(struct page *p, enum block kind, const char *text,
                   struct err *err)
{
    switch (kind) {
    case TITLE:
        return title(p, text, err);
    case HEADING:
        return tagged(p, "h2", "\\section*{", text, err);
    case SUBHEADING:
        return tagged(p, "h3", "\\subsection*{", text, err);
    case FORMULA:
        return formula(p, text, err);
    case VERBATIM:
        return verbatim(p, text, err);
    case TEXT:
        return tagged(p, "p", "", text, err);
    default:
        return true;
    }
}

static bool blocks(struct page *p, char **line, size_t n, struct err *err)
{
    bool ok = true, begun = false;
    for (size_t i = 0; ok && i < n;) {
        char *rest;
        const enum block kind = block_of(line[i], &rest);
        p->line = i + 1;
        if (kind != COMMENT && kind != EMPTY && begun == (kind == TITLE))
            ok = err_set(err, "expected one title (= TITLE), at the beginning");
        begun |= kind == TITLE;
        if (ok && (kind == FIGURE || kind == ROW || kind == ITEM)) {
            ok = sequence(p, kind, line, n, &i, err);
            continue;
        }
        const size_t k = joined(line, i, n, kind);
        char *text = ok ? join(rest, line, i, k) : NULL;
        ok = ok && (text || err_set(err, "out of memory")) &&
             single(p, kind, text, err);
        free(text);
        i += k;
    }
    if (ok)
        return begun || err_set(err, "%s: it has no title", p->path);
    return at_line(p, err);
}

/* -- all of it ---------------------------------------------------------------
 */

static char **lines_of(char *text, size_t *n)
{
    size_t room = 0;
    char **line = NULL;
    *n = 0;
    for (char *l; (l = strsep(&text, "\n"));) {
        if (*n == room) {
            room = room ? 2 * room : 256;
            char **grown = realloc(line, room * sizeof *grown);
            if (!grown) {
                free(line);
                return NULL;
            }
            line = grown;
        }
        line[(*n)++] = l;
    }
    return line;
}

/* The folder of the output, and its form. */
static bool place(struct page *p, const char *output, struct err *err)
{
    const char *slash = strrchr(output, '/'), *dot = strrchr(output, '.');
    p->tex = dot && strcmp(dot, ".tex") == 0;
    if (!dot || (slash && dot < slash) ||
        (!p->tex && strcmp(dot, ".html") != 0))
        return err_set(err,
                       "output \"%.200s\": expected a name that ends in .html "
                       "or .tex",
                       output);
    p->folder = slash == output ? strdup("/")
                : slash         ? strndup(output, (size_t)(slash - output))
                                : strdup(".");
    return p->folder || err_set(err, "out of memory");
}

static bool write_page(struct page *p, const char *output, char **line,
                       size_t n, struct figure_made *made, struct err *err)
{
    struct outfile out;
    if (!outfile_open(&out, output, err))
        return false;
    p->out = out.stream;
    if (!blocks(p, line, n, err)) {
        outfile_abandon(&out);
        return false;
    }
    fputs(p->tex ? "\\end{document}\n" : "</body>\n</html>\n", p->out);
    return figure_made_keep(made, &out, output, err);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct page p = { .path = r->file };
    char numbers[PATH_SIZE], **line = NULL;
    size_t n = 0;
    if (!place(&p, r->output, err))
        return false;
    beside(&p, numbers, "numbers.tsv", "");
    errno = 0;
    char *text = html_file(r->file);
    bool ok = text || err_set(err, "%s: cannot be read: %s", r->file,
                              errno ? strerror(errno) : "it is empty");
    ok = ok && rows_read(&p.numbers, numbers, err);
    ok = ok && (p.name_column = rows_column(&p.numbers, "name", err)) >= 0 &&
         (p.value_column = rows_column(&p.numbers, "value", err)) >= 0;
    line = ok ? lines_of(text, &n) : NULL;
    if (ok && !line) {
        err_set(err, "out of memory");
        ok = false;
    }
    ok = ok && write_page(&p, r->output, line, n, made, err);
    if (p.report_name[0])
        recorded_clear(&p.report);
    rows_clear(&p.numbers);
    free(line);
    free(text);
    free(p.folder);
    if (ok)
        err->text[0] = '\0';
    return ok;
}

const struct plot plot_writeup = {
    .name = "writeup",
    .about = "a text with figures and numbers as a page of HTML, or LaTeX",
    .subject = PLOT_FILE,
    .file = "text, see plots/writeup.c",
    .extension = ".html",
    .run = run,
};
