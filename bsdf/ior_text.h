/* ior_text.h - texts out of pages: plain, printable, and in short quotes
 *
 * Internal to the ior files.
 */
#ifndef BSDF_IOR_TEXT_H
#define BSDF_IOR_TEXT_H

#include <stdbool.h>
#include <stddef.h>

/* Bytes of a reference or a comment that are read. */
enum { IOR_TEXT_MAX = 1 << 14 };

static inline bool ior_is_space(char c)
{
    return (unsigned char)c <= ' ' || c == 0x7f; /* and controls */
}

static inline bool ior_is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

static inline bool ior_is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/** A piece of a file, fit to be quoted in a message. */
struct ior_quote {
    char text[32];
};

struct ior_quote ior_quote(const char *text, size_t length);

/** Without the marks of HTML and Markdown; "text (URL)" for a link, as that is
 * where the DOI is.  Owned by the caller; NULL if there is no memory. */
char *ior_plain_text(const char *text, size_t length);

/** How many bytes the first letter of a UTF-8 text has; 0 if it is none. */
size_t ior_letter(const char *text, size_t length);

#endif
