/* utf8.c - bytes that are no text are shown as numbers */
#include "bsdf/utf8.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* How many bytes at p are one printable character of UTF-8; 0 if none are.
 * Unicode 15, table 3-7; without controls and non-characters. */
static size_t character(const unsigned char *p)
{
    if (p[0] < 0x80)
        return p[0] >= 0x20 && p[0] != 0x7f;
    const size_t n = p[0] >= 0xf0 ? 4 : p[0] >= 0xe0 ? 3 : 2;
    static const unsigned long least[] = { 0, 0, 0xa0, 0x800, 0x10000 };
    unsigned long code = p[0] & (0x7fu >> n);
    if (p[0] < 0xc2 || p[0] > 0xf4)
        return 0;
    for (size_t i = 1; i < n; i++) {
        if ((p[i] & 0xc0) != 0x80) /* the final 0 as well */
            return 0;
        code = code << 6 | (p[i] & 0x3f);
    }
    const bool surrogate = code >= 0xd800 && code < 0xe000;
    const bool separator = code == 0x2028 || code == 0x2029;
    return code < least[n] || code > 0x10ffff || surrogate || separator ||
                   (code & 0xfffe) == 0xfffe
               ? 0
               : n;
}

char *utf8_plain(const char *text)
{
    char *plain = malloc(4 * strlen(text) + 1), *to = plain;
    if (!plain)
        return NULL;
    for (const unsigned char *p = (const unsigned char *)text; *p;) {
        const size_t n = character(p);
        if (n > 0)
            memcpy(to, p, n);
        else
            snprintf(to, 5, "\\x%02x", *p);
        to += n > 0 ? n : 4;
        p += n > 0 ? n : 1;
    }
    *to = '\0';
    return plain;
}
