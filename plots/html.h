/* html.h - the parts of a page that needs nothing but itself
 *
 * What is written is XML as well as HTML.
 */
#ifndef PLOTS_HTML_H
#define PLOTS_HTML_H

#include <stdbool.h>
#include <stdio.h>

#include "bsdf/err.h"

/** Writes any bytes as text, for elements and for attributes in quotes. */
void html_text(FILE *out, const char *bytes);

/** The same within <tag> and </tag>. */
void html_element(FILE *out, const char *tag, const char *bytes);

/** What begins a page, up to the body: its title and its style. */
void html_head(FILE *out, const char *title, const char *style);

/** The rules that all pages share, to begin a style with. */
extern const char html_style[];

/** Writes a picture's <svg> alone, its names made unlike those of the page's
 * other pictures, which have other numbers. */
void html_svg(FILE *out, const char *svg, int picture);

/** Writes "data:TYPE;base64,..." of a file. */
bool html_data(FILE *out, const char *type, const char *path, struct err *err);

/** A file as text; NULL if it cannot be read; owned by the caller. */
char *html_file(const char *path);

#endif
