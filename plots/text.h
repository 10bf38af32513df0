/* text.h - the words of a figure as TeX takes them */
#ifndef PLOTS_TEXT_H
#define PLOTS_TEXT_H

/** LaTeX for a line of UTF-8: its special characters escaped, Greek letters,
 * indices, exponents and signs as mathematics, so that any engine sets them in
 * the document's fonts.  A character that is not known becomes U+HHHH.  NULL
 * when out of memory; owned by the caller. */
char *text_tex(const char *text);

#endif
