/* form.c - terminals of gnuplot, and what they leave to be done */
#include "plots/form.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* gnuplot's settings for a page of %g by %g, the letters' scale and that of
 * lines, such that they look the same in all.  Viewers of SVG blur an image,
 * and cairo leaves gaps between the rectangles that take its place there. */
struct terminal {
    struct form form;
    const char *settings;
    double unit, letters, lines; /* for a pixel, and at a scale of 1 */
};

static const struct terminal terminals[] = {
    { { ".svg", false, "image pixels", "%.10g", "°" },
      "svg size %.6g,%.6g noenhanced font \"sans-serif,%.6g\" linewidth %.6g "
      "background \"#ffffff\"",
      1,
      12, /* its scale of fonts would leave tics and their labels behind */
      1 },
    { { ".pdf", false, "image", "%.10g", "°" },
      "pdfcairo size %.6g,%.6g noenhanced font \"sans-serif,12\" fontscale "
      "%.6g linewidth %.6g background \"#ffffff\"",
      1 / 96.,
      0.75 * 0.75,
      2 * 0.75 },
    { { ".png", false, "image", "%.10g", "°" },
      "pngcairo size %.6g,%.6g noenhanced font \"sans-serif,12\" fontscale "
      "%.6g linewidth %.6g pointscale 2 background \"#ffffff\"",
      2,
      1.55,
      2 },
    { { ".tex", true, "image", "$%.10g$", "$^\\circ$" },
      "cairolatex pdf input color colortext size %.6g,%.6g font \",12\" "
      "fontscale %.6g linewidth %.6g",
      1 / 96.,
      0.75 * 0.75,
      4 * 0.75 },
};
enum { FORMS = sizeof terminals / sizeof *terminals };

const struct form *form_of(const char *path, struct err *err)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    for (int i = 0; i < FORMS; i++)
        if (dot && strcmp(dot, terminals[i].form.extension) == 0)
            return &terminals[i].form;
    err_set(err,
            "output \"%.200s\": %s%.20s%s; expected .svg, .pdf, .png or .tex",
            path, dot ? "extension \"" : "no extension", dot ? dot : "",
            dot ? "\" is unknown" : "");
    return NULL;
}

void form_terminal(FILE *script, const struct form *form, double width,
                   double height, double scale)
{
    const struct terminal *t = terminals;
    while (&t->form != form)
        t++;
    /* An image has whole pixels. */
    const double w = width * t->unit * scale, h = height * t->unit * scale;
    const bool whole = t->unit >= 1;
    fprintf(script, t->settings,
            whole && scale != 1 ? (double)(long)(w + 0.5) : w,
            whole && scale != 1 ? (double)(long)(h + 0.5) : h,
            t->letters * scale, t->lines * scale);
    if (form->tex) /* 12 pixels are 9 pt */
        fprintf(script, " header \"\\\\fontsize{%.4g}{%.4g}\\\\selectfont\"",
                9 * scale, 10.8 * scale);
}

double form_font(const struct form *form, double pixels, double scale)
{
    return form == &terminals[0].form ? pixels * scale : pixels;
}

/* A whole file, a 0 behind it; NULL and the reason. */
static char *read_bytes(const char *path, size_t *size, struct err *err)
{
    FILE *f = fopen(path, "rb");
    char *bytes = NULL;
    long n = -1;
    if (f && fseek(f, 0, SEEK_END) == 0)
        n = ftell(f);
    if (n > 0 && fseek(f, 0, SEEK_SET) == 0)
        bytes = malloc((size_t)n + 1);
    if (bytes && fread(bytes, 1, (size_t)n, f) != (size_t)n) {
        free(bytes);
        bytes = NULL;
    }
    if (!bytes)
        err_set(err, "%s: cannot be read: %s", path,
                n == 0 ? "it is empty" : strerror(errno));
    else
        bytes[n] = '\0';
    if (f)
        fclose(f);
    *size = bytes ? (size_t)n : 0;
    return bytes;
}

/* The date of a PDF becomes that of the year 2000, so that the same input gives
 * the same bytes. */
static void date_fix(char *bytes, size_t size)
{
    static const char key[] = "/CreationDate (D:", date[] = "20000101000000";
    char *at = memmem(bytes, size, key, strlen(key));
    if (at && (size_t)(bytes + size - at) >= strlen(key) + strlen(date))
        memcpy(at + sizeof key - 1, date, sizeof date - 1);
}

bool form_finish(const struct form *form, const char *path, struct err *err)
{
    if (strcmp(form->extension, ".pdf") != 0)
        return true;
    size_t size;
    char *bytes = read_bytes(path, &size, err);
    if (!bytes)
        return false;
    date_fix(bytes, size);
    FILE *f = fopen(path, "r+b");
    bool ok = f && fwrite(bytes, 1, size, f) == size;
    if (f)
        ok = fclose(f) == 0 && ok;
    free(bytes);
    return ok ||
           err_set(err, "%s: cannot be written: %s", path, strerror(errno));
}

/* Writes the text with one of its parts replaced, wherever that stands. */
static void replaced(FILE *out, const char *text, const char *part,
                     const char *by)
{
    for (const char *at; (at = strstr(text, part)); text = at + strlen(part))
        fprintf(out, "%.*s%s", (int)(at - text), text, by);
    fputs(text, out);
}

bool form_tex_move(const char *drawn, const char *stem, struct outfile *out,
                   struct outfile *graphic, struct err *err)
{
    const char *slash = strrchr(drawn, '/');
    const char *name = slash ? slash + 1 : drawn;
    char *path[2] = { NULL, NULL }, *text = NULL, *bytes = NULL, *was = NULL;
    char *is = NULL;
    size_t size, length;
    bool ok = asprintf(&path[0], "%s.tex", drawn) > 0 &&
              asprintf(&path[1], "%s.pdf", drawn) > 0 &&
              asprintf(&was, "{./%s}", name) > 0 &&
              asprintf(&is, "{%s}", stem) > 0;
    if (!ok)
        err_set(err, "out of memory");
    ok = ok && (text = read_bytes(path[0], &length, err)) &&
         (bytes = read_bytes(path[1], &size, err));
    if (ok) {
        replaced(out->stream, text, was, is);
        date_fix(bytes, size);
        fwrite(bytes, 1, size, graphic->stream);
    }
    for (int i = 0; i < 2; i++) {
        if (path[i])
            unlink(path[i]);
        free(path[i]);
    }
    free(text);
    free(bytes);
    free(was);
    free(is);
    return ok;
}
