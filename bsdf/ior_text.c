/* ior_text.c - HTML, Markdown and UTF-8 made plain
 *
 * The database's REFERENCES and COMMENTS are HTML, or Markdown since 2026.
 */
#include "bsdf/ior_text.h"

#include <stdlib.h>
#include <string.h>

struct ior_quote ior_quote(const char *text, size_t length)
{
    struct ior_quote q = { "" };
    const size_t room = sizeof q.text - 4;
    size_t i = 0;
    for (; i < length && i < room; i++)
        q.text[i] = text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
    if (length > room)
        memcpy(q.text + i, "...", 4);
    return q;
}

size_t ior_letter(const char *text, size_t length)
{
    /* By its first byte: the bytes in a letter and the least code of so many,
     * so that none is written longer than it has to be. */
    static const struct {
        unsigned char mask, is;
        unsigned least;
    } kinds[] = { { 0x80, 0x00, 0 },
                  { 0xE0, 0xC0, 0x80 },
                  { 0xF0, 0xE0, 0x800 },
                  { 0xF8, 0xF0, 0x10000 } };
    const unsigned char *s = (const unsigned char *)text;
    for (size_t n = 1; n <= 4 && n <= length; n++) {
        if ((s[0] & kinds[n - 1].mask) != kinds[n - 1].is)
            continue;
        unsigned code = s[0] & (unsigned)(unsigned char)~kinds[n - 1].mask;
        for (size_t i = 1; i < n; i++) {
            if ((s[i] & 0xC0) != 0x80)
                return 0;
            code = code << 6 | (s[i] & 0x3Fu);
        }
        const bool surrogate = code >= 0xD800 && code < 0xE000;
        return code < kinds[n - 1].least || code > 0x10FFFF || surrogate ? 0
                                                                         : n;
    }
    return 0;
}

/* Plain text in the making; never longer than what it is made from. */
struct plain {
    const char *s; /* what it is made from */
    size_t n, i;   /* its length, and how much of it has been read */
    char *text;
    size_t used;
    const char *url; /* of the HTML link that is open, or NULL */
    size_t url_length;
    size_t link_end; /* the ] of the Markdown link that is open, or 0 */
};

static bool is_word(char c)
{
    return ior_is_letter(c) || ior_is_digit(c) || (unsigned char)c >= 0x80;
}

/* One space or line break for any number of them. */
static void put(struct plain *p, char c)
{
    if (c == '\n')
        while (p->used && p->text[p->used - 1] == ' ')
            p->used--;
    const char last = p->used ? p->text[p->used - 1] : '\n';
    if (!ior_is_space(c))
        p->text[p->used++] = c;
    else if (!ior_is_space(last))
        p->text[p->used++] = c == '\n' ? '\n' : ' ';
}

static void put_link(struct plain *p, const char *url, size_t length)
{
    put(p, ' ');
    put(p, '(');
    for (size_t i = 0; i < length; i++)
        put(p, url[i]);
    put(p, ')');
}

/* The URL in <a href="URL">, or NULL. */
static const char *url_in(const char *tag, size_t n, size_t *length)
{
    static const char href[] = "href=\"";
    const char *url = memmem(tag, n, href, sizeof href - 1);
    if (!url)
        return NULL;
    url += sizeof href - 1;
    const char *end = memchr(url, '"', n - (size_t)(url - tag));
    *length = end ? (size_t)(end - url) : 0;
    return end ? url : NULL;
}

/* Reads a tag, if there is one; <https://...> is Markdown's. */
static bool html(struct plain *p)
{
    const char *s = p->s + p->i;
    const size_t left = p->n - p->i;
    if (left < 3 || s[0] != '<' || !(ior_is_letter(s[1]) || s[1] == '/'))
        return false;
    const char *end = memchr(s, '>', left);
    if (!end)
        return false;
    const size_t length = (size_t)(end - s) + 1;
    if (s[1] == 'a' && ior_is_space(s[2])) {
        if (p->url) /* never closed */
            put_link(p, p->url, p->url_length);
        p->url = url_in(s, length, &p->url_length);
    } else if (length == 4 && memcmp(s, "</a>", 4) == 0) {
        if (p->url)
            put_link(p, p->url, p->url_length);
        p->url = NULL;
    } else if (s[1] == 'b' && s[2] == 'r') {
        put(p, '\n');
    } else if (memmem(s, length, "://", 3) && !memchr(s, ' ', length)) {
        for (size_t i = 1; i + 1 < length; i++)
            put(p, s[i]);
    }
    p->i += length;
    return true;
}

/* Length of the bracketed text that starts at i; 0 if none does. */
static size_t bracketed(const struct plain *p, size_t i, char open, char close)
{
    int depth = 0;
    for (size_t j = i; j < p->n && (j > i || p->s[j] == open); j++) {
        if (p->s[j] == open)
            depth++;
        else if (p->s[j] == close && --depth == 0)
            return j - i + 1;
    }
    return 0;
}

/* Reads one of its marks, if there is one: [text](URL), stars, escapes.  A
 * star between letters or digits, or on its own, stands for itself. */
static bool markdown(struct plain *p)
{
    const char *s = p->s;
    const size_t i = p->i;
    size_t end = i;
    switch (s[i]) {
    case '[':
        end += bracketed(p, i, '[', ']');
        if (p->link_end || end == i || !bracketed(p, end, '(', ')'))
            return false;
        p->link_end = end - 1;
        p->i++;
        return true;
    case ']':
        if (!p->link_end || i != p->link_end)
            return false;
        p->link_end = 0;
        end = i + 1 + bracketed(p, i + 1, '(', ')');
        put_link(p, s + i + 2, end - i - 3);
        p->i = end;
        return true;
    case '*':
        while (end < p->n && s[end] == '*')
            end++;
        const char before = i ? s[i - 1] : ' ',
                   after = end < p->n ? s[end] : ' ';
        if ((is_word(before) && is_word(after)) ||
            (ior_is_space(before) && ior_is_space(after)))
            return false;
        p->i = end;
        return true;
    case '\\':
        if (i + 1 >= p->n || is_word(s[i + 1]) || ior_is_space(s[i + 1]))
            return false;
        put(p, s[i + 1]);
        p->i += 2;
        return true;
    default:
        return false;
    }
}

char *ior_plain_text(const char *s, size_t n)
{
    if (n > IOR_TEXT_MAX)
        for (n = IOR_TEXT_MAX; n && ((unsigned char)s[n] & 0xC0) == 0x80; n--)
            ; /* not in the middle of a letter */
    struct plain p = { .s = s, .n = n, .text = malloc(n + 1) };
    if (!p.text)
        return NULL;
    while (p.i < n)
        if (!html(&p) && !markdown(&p))
            put(&p, s[p.i++]);
    while (p.used && ior_is_space(p.text[p.used - 1]))
        p.used--;
    p.text[p.used] = '\0';
    return p.text;
}
