/* html.c - text, pictures and files within a page */
#include "plots/html.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/utf8.h"

void html_text(FILE *out, const char *bytes)
{
    char *plain = utf8_plain(bytes);
    for (const char *p = plain ? plain : ""; *p; p++)
        switch (*p) {
        case '&':
            fputs("&amp;", out);
            break;
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        case '\'':
            fputs("&#39;", out);
            break;
        default:
            fputc(*p, out);
        }
    free(plain);
}

void html_element(FILE *out, const char *tag, const char *bytes)
{
    fprintf(out, "<%s>", tag);
    html_text(out, bytes);
    fprintf(out, "</%s>", tag);
}

const char html_style[] =
    ":root{color-scheme:light}"
    "*{box-sizing:border-box}"
    "body{margin:0 auto;padding:1rem;max-width:85rem;background:#fff;"
    "color:#1a1a1a;font:16px/1.5 system-ui,sans-serif;overflow-wrap:anywhere}"
    "h1{font-size:1.5rem;margin:.2rem 0 .8rem}"
    "h2{font-size:1.25rem;margin:2.2rem 0 .6rem;padding-bottom:.2rem;"
    "border-bottom:1px solid #ccc}"
    "h3{font-size:1.05rem;margin:1.6rem 0 .5rem}"
    ".scroll{overflow-x:auto;max-width:100%;border:1px solid #ddd;"
    "margin:.5rem 0}"
    "table{border-collapse:collapse;font-size:.85rem;width:100%}"
    "th,td{text-align:left;padding:.3rem .55rem;border-bottom:1px solid "
    "#e4e4e4;"
    "vertical-align:top;white-space:nowrap}"
    "thead th{background:#f4f4f4;position:sticky;top:0}"
    "pre{white-space:pre-wrap;background:#f4f4f4;border:1px solid #ddd;"
    "padding:.5rem .7rem;margin:.3rem 0;font-size:.82rem;user-select:all}"
    "figure{margin:0;min-width:0}"
    "figcaption{font-size:.85rem;color:#444}"
    "details{margin:.4rem 0;border:1px solid #ddd;padding:.3rem .7rem}"
    "summary{cursor:pointer;overflow-wrap:anywhere}";

void html_head(FILE *out, const char *title, const char *style)
{
    fputs("<!DOCTYPE html>\n"
          "<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n"
          "<head><meta charset=\"utf-8\"/>\n"
          "<meta name=\"viewport\" content=\"width=device-width, "
          "initial-scale=1\"/>\n"
          "<title>",
          out);
    html_text(out, title);
    fprintf(out, "</title>\n<style>%s%s</style></head>\n", html_style, style);
}

void html_svg(FILE *out, const char *svg, int picture)
{
    static const char *const named[] = { "id=\"", "id='", "href='#", "href=\"#",
                                         "url(#" };
    const char *p = strstr(svg, "<svg");
    while (p && *p) {
        size_t n = 0;
        for (size_t i = 0; n == 0 && i < sizeof named / sizeof *named; i++)
            if (strncmp(p, named[i], strlen(named[i])) == 0)
                n = strlen(named[i]);
        if (n > 0) {
            fprintf(out, "%.*sp%d-", (int)n, p, picture);
            p += n;
        } else {
            fputc(*p++, out);
        }
    }
}

/* Three bytes as four characters; the last may be fewer. */
static void four(FILE *out, const unsigned char *b, size_t n)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqr"
                                 "stuvwxyz0123456789+/";
    const unsigned bits = (unsigned)b[0] << 16 |
                          (n > 1 ? (unsigned)b[1] << 8 : 0) |
                          (n > 2 ? b[2] : 0);
    for (size_t i = 0; i < 4; i++)
        fputc(i <= n ? digits[bits >> (18 - 6 * i) & 63] : '=', out);
}

bool html_data(FILE *out, const char *type, const char *path, struct err *err)
{
    unsigned char b[3];
    size_t n;
    FILE *in = fopen(path, "rb");
    if (!in)
        return err_set(err, "%s: cannot be read: %s", path, strerror(errno));
    fprintf(out, "data:%s;base64,", type);
    while ((n = fread(b, 1, sizeof b, in)) > 0)
        four(out, b, n);
    const bool ok = !ferror(in);
    fclose(in);
    return ok || err_set(err, "%s: cannot be read", path);
}

char *html_file(const char *path)
{
    char *text = NULL;
    size_t size = 0;
    FILE *in = fopen(path, "r");
    const bool ok = in && getdelim(&text, &size, '\0', in) > 0;
    if (in)
        fclose(in);
    if (ok)
        return text;
    free(text);
    return NULL;
}
