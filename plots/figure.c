/* figure.c - files side by side */
#include "plots/figure.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bsdf/utf8.h"
#include "plots/text.h"

enum { LINE_MAX = 100, LINES_MAX = 4, LINE_HEIGHT = 17 };
enum { STYLE_MAX = 1 << 20 };       /* bytes */
static const double small_px = 9.5; /* pixels of small print */

void figure_made_clear(struct figure_made *made)
{
    for (int i = 0; i < made->paths; i++)
        free(made->path[i]);
    made->paths = 0;
}

static void forget(struct figure *fig)
{
    free(fig->folder);
    free(fig->stem);
    free(fig->style);
    *fig = (struct figure){ 0 };
}

/* -- names ----------------------------------------------------------------- */

/* What lies beside a picture; the last of a .tex only. */
enum { TABLE, SCRIPT, CAPTION, GRAPHIC, BESIDE };
static const struct {
    const char *extension, *what;
} beside[BESIDE] = { [TABLE] = { ".tsv", "the figure's data" },
                     [SCRIPT] = { ".gp", "the figure's script" },
                     [CAPTION] = { ".caption", "the figure's caption" },
                     [GRAPHIC] = { ".pdf", "the figure's graphic" } };

/* A picture's path with another extension; owned by the caller. */
static char *path_beside(const char *picture, const struct form *form,
                         const char *extension)
{
    const size_t n = strlen(picture) - strlen(form->extension);
    char *path;
    return asprintf(&path, "%.*s%s", (int)n, picture, extension) < 0 ? NULL
                                                                     : path;
}

static bool same_file(const char *a, const char *b)
{
    struct stat x, y;
    return stat(a, &x) == 0 && stat(b, &y) == 0 && S_ISREG(x.st_mode) &&
           x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

bool figure_spares(const char *output, bool page, const char *input,
                   struct err *err)
{
    static const char format[] =
        "%.200s: it is read, and %s would replace it; -o with another name";
    const struct form *form = page ? NULL : form_of(output, NULL);
    bool spared = true;
    if (same_file(output, input))
        return err_set(err, format, input, page ? "the page" : "the picture");
    for (int i = 0; form && spared && i < BESIDE - !form->tex; i++) {
        char *path = path_beside(output, form, beside[i].extension);
        if (path && same_file(path, input))
            spared = err_set(err, format, input, beside[i].what);
        free(path);
    }
    return spared;
}

/* What TeX reads as a name whatever it has been told. */
static bool tex_name(const char *path, const char *name, struct err *err)
{
    const size_t n = strlen(name) - strlen(".tex");
    return strspn(name, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                        "0123456789-") >= n ||
           err_set(err,
                   "output \"%.200s\": expected a name of letters, digits and "
                   "-, as TeX takes it",
                   path);
}

/* "FOLDER/STEM.svg" into folder and "./STEM". */
static bool names(struct figure *fig, const char *path, struct err *err)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    fig->form = form_of(path, err);
    if (!fig->form)
        return false;
    const char *dot = strrchr(name, '.');
    if (dot == name)
        return err_set(err, "output \"%.200s\": expected a name before %s",
                       path, dot);
    if (fig->form->tex && !tex_name(path, name, err))
        return false;
    fig->folder = slash == path ? strdup("/")
                  : slash       ? strndup(path, (size_t)(slash - path))
                                : strdup(".");
    if (asprintf(&fig->stem, "./%.*s", (int)(dot - name), name) < 0)
        fig->stem = NULL;
    return (fig->folder && fig->stem) || err_set(err, "out of memory");
}

static bool open_beside(struct figure *fig, struct outfile *out, int which,
                        struct err *err)
{
    char *path = path_beside(fig->path, fig->form, beside[which].extension);
    if (!path)
        return err_set(err, "out of memory");
    const bool ok = outfile_open(out, path, err);
    free(path);
    return ok;
}

/* The style becomes a part of the script. */
static bool style_read(struct figure *fig, struct err *err)
{
    const char *path = fig->look.style;
    if (!path)
        return true;
    FILE *in = fopen(path, "r");
    fig->style = in ? calloc(1, STYLE_MAX + 1) : NULL;
    if (!in || !fig->style) {
        if (in)
            fclose(in);
        return err_set(err, "--style %.200s: %s", path, strerror(errno));
    }
    const size_t n = fread(fig->style, 1, STYLE_MAX + 1, in);
    const bool read = !ferror(in);
    fclose(in);
    if (!read)
        return err_set(err, "--style %.200s: %s", path, strerror(errno));
    if (n > STYLE_MAX || memchr(fig->style, '\0', n))
        return err_set(err,
                       "--style %.200s: %s; expected commands of gnuplot's",
                       path, n > STYLE_MAX ? "more than 1 MiB" : "a zero byte");
    return true;
}

bool figure_open(struct figure *fig, const char *path,
                 const struct figure_look *look, struct err *err)
{
    *fig = (struct figure){ .path = path, .look = *look };
    if (names(fig, path, err) && style_read(fig, err) &&
        outfile_open(&fig->picture, path, err) &&
        (!fig->form->tex || open_beside(fig, &fig->graphic, GRAPHIC, err)) &&
        open_beside(fig, &fig->tables, TABLE, err) &&
        open_beside(fig, &fig->scripts, SCRIPT, err) &&
        open_beside(fig, &fig->captions, CAPTION, err)) {
        fig->table = fig->tables.stream;
        fig->script = fig->scripts.stream;
        fig->caption = fig->captions.stream;
        return true;
    }
    figure_abandon(fig);
    return false;
}

void figure_abandon(struct figure *fig)
{
    struct outfile *const all[] = { &fig->picture, &fig->graphic, &fig->tables,
                                    &fig->scripts, &fig->captions };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (all[i]->stream)
            outfile_abandon(all[i]);
    forget(fig);
}

/* -- text ------------------------------------------------------------------ */

void figure_text(struct figure *fig, const char *text)
{
    char *tex = fig->form->tex ? text_tex(text) : NULL;
    gnuplot_string(fig->script, tex ? tex : text);
    free(tex);
}

void figure_label_at(struct figure *fig, const char *text, const char *where,
                     ...)
{
    va_list args;
    fputs("set label ", fig->script);
    figure_text(fig, text);
    fputs(" at ", fig->script);
    va_start(args, where);
    vfprintf(fig->script, where, args);
    va_end(args);
    fputc('\n', fig->script);
}

void figure_label(struct figure *fig, double x, double y, const char *aligned,
                  const char *text)
{
    figure_label_at(fig, text, "screen %.6g,%.6g %s noenhanced", x / fig->width,
                    y / fig->height, aligned);
}

static double scale_of(const struct figure *fig)
{
    const double mm = fig->look.width_mm;
    return mm > 0 ? mm / 25.4 * 96 / fig->width : 1;
}

/* LaTeX is told of the size by a command. */
void figure_small(struct figure *fig, double x, double y, const char *text)
{
    char *tex = fig->form->tex ? text_tex(text) : NULL, *sized = NULL;
    const double pt = 0.75 * small_px * scale_of(fig);
    if (tex && asprintf(&sized, "\\fontsize{%.4g}{%.4g}\\selectfont %s", pt,
                        1.2 * pt, tex) < 0)
        sized = NULL;
    fputs("set label ", fig->script);
    gnuplot_string(fig->script, sized ? sized : text);
    fprintf(fig->script,
            " at screen %.6g,%.6g left noenhanced font \",%.6g\" tc rgb "
            "\"#505050\"\n",
            x / fig->width, y / fig->height,
            form_font(fig->form, small_px, scale_of(fig)));
    free(sized);
    free(tex);
}

void figure_caption(struct figure *fig, const char *format, ...)
{
    char *text, *tex;
    va_list args;
    va_start(args, format);
    if (vasprintf(&text, format, args) < 0)
        text = NULL;
    va_end(args);
    tex = text && fig->form->tex ? text_tex(text) : NULL;
    fputs(tex ? tex : text ? text : "", fig->caption);
    free(tex);
    free(text);
}

void figure_caption_spec(struct figure *fig, const char *spec)
{
    char *tex = fig->form->tex ? text_tex_spec(spec) : NULL;
    fputs(tex ? tex : spec, fig->caption);
    free(tex);
}

/* How many bytes of a text make its next line: up to a comma, or cut. */
static size_t line_length(const char *text)
{
    size_t characters = 0, comma = 0, n = 0;
    for (; text[n]; n++) {
        const bool begins = ((unsigned char)text[n] & 0xc0) != 0x80;
        if (text[n] == '\n')
            return n;
        if (begins && characters++ == LINE_MAX)
            return comma > n / 2 ? comma : n;
        if (text[n] == ',')
            comma = n + 1;
    }
    return n;
}

/* The lines of a title, a label each, upward from y. */
struct title {
    char *plain;
    size_t from[LINES_MAX], length[LINES_MAX];
    bool cut[LINES_MAX]; /* there is more of this part */
    int lines;
};

/* How many lines a part takes; a part ends with its line of the text. */
static int lines_of(const char *at)
{
    int lines = 0;
    for (; *at && *at != '\n'; lines++)
        at += line_length(at);
    return lines > 0 ? lines : 1;
}

/* How many parts follow, this one included, and how many lines these take. */
static int parts_of(const char *at, int *lines)
{
    int parts = 0;
    *lines = 0;
    for (; *at; parts++) {
        *lines += lines_of(at);
        at += strcspn(at, "\n");
        at += *at == '\n';
    }
    return parts;
}

/* Parts that are too long for the title together share its lines. */
static void title_lines(struct title *t)
{
    for (const char *at = t->plain; *at && t->lines < LINES_MAX;) {
        int all;
        const int parts = parts_of(at, &all), left = LINES_MAX - t->lines;
        const int share = all <= left ? left : left > parts ? left / parts : 1;
        for (int i = 0; i < share && *at && *at != '\n'; i++) {
            const size_t n = line_length(at);
            t->from[t->lines] = (size_t)(at - t->plain);
            t->length[t->lines++] = n;
            at += n;
        }
        if (*at && *at != '\n')
            t->cut[t->lines - 1] = true;
        at += strcspn(at, "\n");
        at += *at == '\n';
    }
}

static struct title title_wrap(const char *text)
{
    struct title t = { .plain = NULL };
    char *plain = NULL;
    size_t size;
    FILE *out = open_memstream(&plain, &size);
    for (const char *at = text; out && *at;) { /* line by line */
        const size_t n = strcspn(at, "\n");
        char *part = strndup(at, n), *clean = part ? utf8_plain(part) : NULL;
        fprintf(out, "%s%s", at > text ? "\n" : "", clean ? clean : "");
        free(part);
        free(clean);
        at += n + (at[n] == '\n');
    }
    if (!out || fclose(out) != 0)
        return t;
    t.plain = plain;
    title_lines(&t);
    return t;
}

/* -- the script ------------------------------------------------------------ */

/* Vermillion, bluish green, blue, reddish purple, orange, sky blue of M. Okabe
 * and K. Ito, Color Universal Design, 2008; black and a grey.  Each has a dash
 * of its own.  The palettes are viridis, of S. van der Walt and N. Smith, and
 * cividis, of J. Nunez, C. Anderton and R. Renslow, PLOS ONE 13(7), 2018: both
 * rise in lightness, so that they can be read in grey. */
static const char defaults[] =
    "set linetype 1 lc rgb \"#D55E00\" dt 1 lw 2.2\n"
    "set linetype 2 lc rgb \"#009E73\" dt (12,7) lw 2\n"
    "set linetype 3 lc rgb \"#0072B2\" dt (3,4) lw 2.2\n"
    "set linetype 4 lc rgb \"#CC79A7\" dt (12,4,3,4) lw 1.8\n"
    "set linetype 5 lc rgb \"#E69F00\" dt (12,4,3,4,3,4) lw 1.8\n"
    "set linetype 6 lc rgb \"#56B4E9\" dt (6,3) lw 1.8\n"
    "set linetype 7 lc rgb \"#000000\" dt (18,4) lw 1.5\n"
    "set linetype 8 lc rgb \"#808080\" dt (2,5) lw 2\n"
    "set linetype 9 lc rgb \"#303030\" dt 1 lw 2.2\n"
    "set linetype 10 lc rgb \"#606060\" dt (14,9) lw 1\n"
    "set linetype 11 lc rgb \"#b8b8b8\" dt 1 lw 0.5\n"
    "heat = 'defined (0 \"#440154\", 1 \"#482878\", 2 \"#3e4a89\", 3 "
    "\"#31688e\", 4 \"#26828e\", 5 \"#1f9e89\", 6 \"#35b779\", 7 \"#6dcd59\", "
    "8 \"#b4de2c\", 9 \"#fde725\")'\n"
    "sigma = 'defined (0 \"#00224e\", 1 \"#123570\", 2 \"#3b496c\", 3 "
    "\"#575d6d\", 4 \"#707173\", 5 \"#8a8779\", 6 \"#a69d75\", 7 \"#c4b56c\", "
    "8 \"#e4cf5b\", 9 \"#fee838\")'\n";

void figure_page(struct figure *fig, double width, double body,
                 const char *title, const char *below)
{
    FILE *out = fig->script;
    struct title t = title_wrap(title);
    fig->width = width;
    fig->height = body + (t.lines + 1) * LINE_HEIGHT + 14;
    fputs("reset\n"
          "set encoding utf8\n"
          "set angles degrees\n"
          "table = ",
          out);
    gnuplot_string(out, fig->stem);
    fputs(" . \".tsv\"\nif (!exists(\"picture\")) picture = ", out);
    gnuplot_string(out, fig->stem);
    fprintf(out, " . \"%s\"\ndegree = ", fig->form->extension);
    gnuplot_string(out, fig->form->degree);
    fputs("\nset terminal ", out);
    form_terminal(out, fig->form, fig->width, fig->height, scale_of(fig));
    fputs("\nset output picture\nif (exists(\"window\")) { set output; "
          "eval(\"set terminal \" . window) }\n",
          out);
    fputs(defaults, out);
    if (fig->style)
        fprintf(out, "\n# the style\n%s\n# its end\n", fig->style);
    fputs("set multiplot\n\n", out);
    for (int i = 0; i < t.lines; i++) {
        char *line = NULL;
        if (asprintf(&line, "%.*s%s", (int)t.length[i], t.plain + t.from[i],
                     t.cut[i] ? " …" : "") >= 0)
            figure_label(fig, width / 2, fig->height - LINE_HEIGHT * (i + 1),
                         "center", line);
        free(line);
    }
    figure_label(fig, width / 2, body + LINE_HEIGHT - 4, "center", below);
    free(t.plain);
}

void figure_panel(struct figure *fig, double x0, double x1, double y0,
                  double y1)
{
    fprintf(fig->script,
            "set lmargin at screen %.6g; set rmargin at screen %.6g\n"
            "set bmargin at screen %.6g; set tmargin at screen %.6g\n",
            x0 / fig->width, x1 / fig->width, y0 / fig->height,
            y1 / fig->height);
}

/* -- drawing --------------------------------------------------------------- */

/* A .tex and its graphic are drawn under another name, as gnuplot takes the
 * graphic's from that of the other. */
static bool picture_draw(struct figure *fig, const char *script, char *said,
                         struct err *err)
{
    const char *drawn =
        fig->picture.temporary ? fig->picture.temporary : fig->picture.path;
    const char *slash = strrchr(drawn, '/');
    const bool tex = fig->form->tex;
    char *name, *whole = NULL;
    if (asprintf(&name, "./%s%s", slash ? slash + 1 : drawn,
                 tex ? ".tex" : "") < 0)
        return err_set(err, "out of memory");
    bool ok = gnuplot_run(fig->folder, script, name, said, err);
    free(name);
    if (tex) {
        /* Where it was drawn, as seen from here. */
        if (asprintf(&whole, "%s/%s", fig->folder, slash ? slash + 1 : drawn) <
            0)
            return err_set(err, "out of memory");
        ok = form_tex_move(whole, fig->stem, &fig->picture, &fig->graphic,
                           ok ? err : NULL) &&
             ok;
        free(whole);
        return ok;
    }
    if (ok && fseek(fig->picture.stream, 0, SEEK_END) == 0 &&
        ftell(fig->picture.stream) == 0)
        ok = err_set(err, "gnuplot has drawn nothing");
    return ok && form_finish(fig->form, drawn, err);
}

bool figure_made_keep(struct figure_made *made, struct outfile *out,
                      const char *name, struct err *err)
{
    char *path = name ? strdup(name) : NULL;
    if (!path) {
        outfile_abandon(out);
        return err_set(err, "out of memory");
    }
    if (!outfile_close(out, err)) {
        free(path);
        return false;
    }
    made->path[made->paths++] = path;
    return true;
}

static bool keep(struct figure *fig, struct outfile *out, int which,
                 struct figure_made *made, struct err *err)
{
    char *path = path_beside(fig->path, fig->form, beside[which].extension);
    const bool ok = figure_made_keep(made, out, path, err);
    free(path);
    return ok;
}

bool figure_draw(struct figure *fig, struct figure_made *made, struct err *err)
{
    char *script = NULL;
    fputs("\nunset multiplot\nunset output\n", fig->script);
    fputc('\n', fig->caption);
    *made = (struct figure_made){ 0 };
    if (asprintf(&script, "%s.gp", fig->stem) < 0)
        script = NULL;
    const bool written = (script || err_set(err, "out of memory")) &&
                         keep(fig, &fig->tables, TABLE, made, err) &&
                         keep(fig, &fig->scripts, SCRIPT, made, err) &&
                         keep(fig, &fig->captions, CAPTION, made, err);
    if (!written) { /* a table alone is no use */
        for (int i = 0; i < made->paths; i++)
            unlink(made->path[i]);
        figure_made_clear(made);
    }
    bool ok =
        written && picture_draw(fig, script, made->said, err) &&
        (!fig->form->tex || keep(fig, &fig->graphic, GRAPHIC, made, err)) &&
        figure_made_keep(made, &fig->picture, fig->path, err);
    if (ok && fig->look.window)
        ok = gnuplot_window(fig->folder, script, fig->width, fig->height, err);
    free(script);
    figure_abandon(fig);
    return ok;
}
