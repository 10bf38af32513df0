/* figure.c - three files side by side */
#include "plots/figure.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bsdf/utf8.h"

/* gnuplot's settings for a page of %g by %g pixels, such that letters and lines
 * look the same in all three.  Viewers of SVG blur an image, and cairo leaves
 * gaps between the rectangles that take its place there. */
struct figure_form {
    const char *extension, *terminal;
    double scale; /* of the lengths that the terminal wants */
    const char *cells;
};

static const struct figure_form forms[] = {
    { ".svg",
      "svg size %.6g,%.6g noenhanced font \"sans-serif,12\" background "
      "\"#ffffff\"",
      1, "image pixels" },
    { ".pdf",
      "pdfcairo size %.6g,%.6g noenhanced font \"sans-serif,12\" fontscale "
      "0.75 linewidth 2 background \"#ffffff\"",
      1 / 72., "image" },
    { ".png",
      "pngcairo size %.6g,%.6g noenhanced font \"sans-serif,12\" fontscale "
      "1.55 linewidth 2 pointscale 2 background \"#ffffff\"",
      2, "image" },
};
enum { FORMS = sizeof forms / sizeof *forms };

enum { LINE_MAX = 100, LINES_MAX = 4, LINE_HEIGHT = 17 };

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
    *fig = (struct figure){ 0 };
}

/* "FOLDER/STEM.svg" into folder and "./STEM". */
static bool names(struct figure *fig, const char *path, struct err *err)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    for (int i = 0; i < FORMS; i++)
        if (dot && strcmp(dot, forms[i].extension) == 0)
            fig->form = &forms[i];
    if (!fig->form)
        return err_set(err,
                       "output \"%.200s\": %s%.20s%s; expected .svg, .pdf or "
                       ".png",
                       path, dot ? "extension \"" : "no extension",
                       dot ? dot : "", dot ? "\" is unknown" : "");
    if (dot == name)
        return err_set(err, "output \"%.200s\": expected a name before %s",
                       path, dot);
    fig->folder = slash == path ? strdup("/")
                  : slash       ? strndup(path, (size_t)(slash - path))
                                : strdup(".");
    if (asprintf(&fig->stem, "./%.*s", (int)(dot - name), name) < 0)
        fig->stem = NULL;
    return (fig->folder && fig->stem) || err_set(err, "out of memory");
}

static bool open_beside(struct figure *fig, struct outfile *out,
                        const char *path, const char *extension,
                        struct err *err)
{
    const size_t n = strlen(path) - strlen(fig->form->extension);
    char *beside;
    if (asprintf(&beside, "%.*s%s", (int)n, path, extension) < 0)
        return err_set(err, "out of memory");
    const bool ok = outfile_open(out, beside, err);
    free(beside);
    return ok;
}

bool figure_open(struct figure *fig, const char *path, struct err *err)
{
    *fig = (struct figure){ 0 };
    if (names(fig, path, err) && outfile_open(&fig->picture, path, err) &&
        open_beside(fig, &fig->tables, path, ".tsv", err) &&
        open_beside(fig, &fig->scripts, path, ".gp", err)) {
        fig->table = fig->tables.stream;
        fig->script = fig->scripts.stream;
        fig->cells = fig->form->cells;
        return true;
    }
    figure_abandon(fig);
    return false;
}

void figure_abandon(struct figure *fig)
{
    struct outfile *const all[] = { &fig->picture, &fig->tables,
                                    &fig->scripts };
    for (int i = 0; i < 3; i++)
        if (all[i]->stream)
            outfile_abandon(all[i]);
    forget(fig);
}

/* How many bytes of a text make its next line: up to a comma, or cut. */
static size_t line_length(const char *text)
{
    size_t characters = 0, comma = 0, n = 0;
    for (; text[n]; n++) {
        const bool begins = ((unsigned char)text[n] & 0xc0) != 0x80;
        if (begins && characters++ == LINE_MAX)
            return comma > n / 2 ? comma : n;
        if (text[n] == ',')
            comma = n + 1;
    }
    return n;
}

/* The spec in lines, as a string of the script; returns how many. */
static int title_wrap(FILE *out, const char *spec)
{
    char *plain = utf8_plain(spec);
    int lines = 0;
    for (const char *at = plain ? plain : ""; *at && lines < LINES_MAX;
         lines++) {
        const size_t n = line_length(at);
        fprintf(out, "%s%.*s", lines ? "\n" : "", (int)n, at);
        at += n;
        if (*at && lines + 1 == LINES_MAX)
            fputs(" …", out);
    }
    free(plain);
    return lines;
}

void figure_page(struct figure *fig, double width, double body,
                 const char *spec, const char *below)
{
    char *title = NULL;
    size_t size;
    FILE *out = open_memstream(&title, &size);
    const int lines = out ? title_wrap(out, spec) : 0;
    if (out)
        fclose(out);
    fig->width = width;
    fig->height = body + (lines + 1) * LINE_HEIGHT + 14;
    fprintf(fig->script, "reset\n"
                         "set encoding utf8\n"
                         "set angles degrees\n"
                         "table = ");
    gnuplot_string(fig->script, fig->stem);
    fputs(" . \".tsv\"\nif (!exists(\"picture\")) picture = ", fig->script);
    gnuplot_string(fig->script, fig->stem);
    fprintf(fig->script, " . \"%s\"\nset terminal ", fig->form->extension);
    const double w = fig->width * fig->form->scale;
    const double h = fig->height * fig->form->scale;
    fprintf(fig->script, fig->form->terminal, w, h);
    fputs("\nset output picture\nset multiplot\n\n", fig->script);
    figure_label(fig, width / 2, fig->height - LINE_HEIGHT, "center",
                 title ? title : "");
    figure_label(fig, width / 2, body + LINE_HEIGHT - 4, "center", below);
    free(title);
}

void figure_label(struct figure *fig, double x, double y, const char *aligned,
                  const char *text)
{
    fputs("set label ", fig->script);
    gnuplot_string(fig->script, text);
    fprintf(fig->script, " at screen %.6g,%.6g %s noenhanced\n", x / fig->width,
            y / fig->height, aligned);
}

void figure_small(struct figure *fig, double x, double y, const char *text)
{
    fputs("set label ", fig->script);
    gnuplot_string(fig->script, text);
    fprintf(fig->script,
            " at screen %.6g,%.6g left noenhanced font \",9.5\" tc rgb "
            "\"#505050\"\n",
            x / fig->width, y / fig->height);
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

/* The date of a PDF becomes that of the year 2000, so that the same input gives
 * the same bytes. */
static bool date_fix(const char *path, struct err *err)
{
    static const char key[] = "/CreationDate (D:", date[] = "20000101000000";
    FILE *f = fopen(path, "r+b");
    char *bytes = NULL, *at = NULL;
    long size = -1;
    if (f && fseek(f, 0, SEEK_END) == 0)
        size = ftell(f);
    if (size > 0 && fseek(f, 0, SEEK_SET) == 0)
        bytes = malloc((size_t)size);
    bool ok = bytes && fread(bytes, 1, (size_t)size, f) == (size_t)size;
    if (ok)
        at = memmem(bytes, (size_t)size, key, strlen(key));
    if (at) {
        const long place = at - bytes + (long)strlen(key);
        ok = place + (long)strlen(date) <= size &&
             fseek(f, place, SEEK_SET) == 0 && fputs(date, f) >= 0;
    }
    if (f)
        ok = fclose(f) == 0 && ok;
    free(bytes);
    return ok ||
           err_set(err, "%s: cannot be written: %s", path, strerror(errno));
}

static bool picture_draw(struct figure *fig, const char *script, char *said,
                         struct err *err)
{
    const char *temporary = strrchr(fig->picture.temporary, '/');
    char *name;
    if (asprintf(&name, "./%s",
                 temporary ? temporary + 1 : fig->picture.temporary) < 0)
        return err_set(err, "out of memory");
    bool ok = gnuplot_run(fig->folder, script, name, said, err);
    free(name);
    if (ok && fseek(fig->picture.stream, 0, SEEK_END) == 0 &&
        ftell(fig->picture.stream) == 0)
        ok = err_set(err, "gnuplot has drawn nothing");
    if (ok && strcmp(fig->form->extension, ".pdf") == 0)
        ok = date_fix(fig->picture.temporary, err);
    return ok;
}

/* Closes one of the three and remembers its path. */
static bool keep(struct outfile *out, struct figure_made *made, struct err *err)
{
    char *path = strdup(out->path);
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

bool figure_draw(struct figure *fig, struct figure_made *made, struct err *err)
{
    char *script = NULL;
    fputs("\nunset multiplot\nunset output\n", fig->script);
    *made = (struct figure_made){ 0 };
    if (asprintf(&script, "%s.gp", fig->stem) < 0)
        script = NULL;
    const bool written = (script || err_set(err, "out of memory")) &&
                         keep(&fig->tables, made, err) &&
                         keep(&fig->scripts, made, err);
    if (!written && made->paths > 0) { /* a table alone is no use */
        unlink(made->path[0]);
        figure_made_clear(made);
    }
    const bool ok = written && picture_draw(fig, script, made->said, err) &&
                    keep(&fig->picture, made, err);
    free(script);
    figure_abandon(fig);
    return ok;
}
