/* utf8.h - any bytes as text that can be read */
#ifndef BSDF_UTF8_H
#define BSDF_UTF8_H

/** The text in one line of printable UTF-8: every byte that is not part of it,
 * and every control character, becomes \xHH.  NULL when out of memory; owned
 * by the caller. */
char *utf8_plain(const char *text);

#endif
