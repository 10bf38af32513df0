/* text.h - the words of a figure as TeX takes them */
#ifndef PLOTS_TEXT_H
#define PLOTS_TEXT_H

#include <stddef.h>

/** LaTeX for a line of UTF-8: its special characters escaped, Greek letters,
 * indices, exponents and signs as mathematics, so that any engine sets them in
 * the document's fonts.  A character that is not known becomes U+HHHH.  NULL
 * when out of memory; owned by the caller. */
char *text_tex(const char *text);

/** The same of a spec or a path, which may go on in the next line behind its
 * punctuation. */
char *text_tex_spec(const char *spec);

/** How many bytes of a spec or a path there are up to where it may go on in the
 * next line, or to its end. */
size_t text_piece(const char *spec);

#endif
