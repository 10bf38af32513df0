/* ior_bibtex.c - the references of a page, as BibTeX
 *
 * What the database and data/ior/ write, one or several with 1), 2) before
 * them:
 *
 *   A. Alpha, B. Beta and C. Gamma.            A. Alpha and B. Beta,
 *   Title.                                     Title,
 *   Journal 12, 345-350 (1971) (URL)           Journal 12, 345-350, 1971, doi:D
 *   (remarks)
 *
 * at times on fewer lines.  So the year is looked for first, the journal before
 * it and the authors at the start, and what is between is the title.  Where one
 * of them is not found the whole reference becomes a note: better as it was
 * than wrong.
 */
#include "bsdf/ior_page.h"

#include <stdio.h>
#include <string.h>

enum { KEYS_MAX = 16, KEY_MAX = 48, WORDS_MAX = 8 };

/* -- text that grows ------------------------------------------------------- */

struct out {
    char *text;
    size_t used, size;
    bool full;
};

static void put(struct out *o, const char *s, size_t length)
{
    if (o->full || length >= o->size - o->used) {
        o->full = true;
        return;
    }
    memcpy(o->text + o->used, s, length);
    o->used += length;
    o->text[o->used] = '\0';
}

static void put_text(struct out *o, const char *s)
{
    put(o, s, strlen(s));
}

/* With TeX's special characters escaped, line breaks as spaces, and dashes
 * between numbers as TeX has them. */
static void put_tex(struct out *o, struct ior_span s)
{
    static const char *const escapes[256] = {
        ['#'] = "\\#",
        ['$'] = "\\$",
        ['%'] = "\\%",
        ['&'] = "\\&",
        ['_'] = "\\_",
        ['{'] = "\\textbraceleft{}", /* BibTeX counts braces, \{ too */
        ['}'] = "\\textbraceright{}",
        ['~'] = "\\textasciitilde{}",
        ['^'] = "\\textasciicircum{}",
        ['\\'] = "\\textbackslash{}",
        ['\n'] = " ",
    };
    static const char dash[] = "\xE2\x80\x93";
    for (size_t i = 0; i < s.length; i++) {
        const char *escape = escapes[(unsigned char)s.at[i]];
        if (escape) {
            put_text(o, escape);
        } else if (s.length - i >= 3 && memcmp(s.at + i, dash, 3) == 0) {
            put_text(o, "--");
            i += 2;
        } else {
            put(o, s.at + i, 1);
        }
    }
}

/* A DOI or a URL is taken as it is, but for what would end the entry. */
static void put_verbatim(struct out *o, struct ior_span s)
{
    for (size_t i = 0; i < s.length; i++) {
        const char c = s.at[i];
        char code[8];
        snprintf(code, sizeof code, strchr("{}\\\"<>^`| ", c) ? "%%%02X" : "%c",
                 c);
        put_text(o, code);
    }
}

static void put_field(struct out *o, const char *key, struct ior_span value,
                      bool verbatim)
{
    if (!value.length)
        return;
    put_text(o, "  ");
    put_text(o, key);
    /* Two braces keep the capitals of Al and SiO2 in a title. */
    put_text(o, strcmp(key, "title") == 0 ? " = {{" : " = {");
    if (verbatim)
        put_verbatim(o, value);
    else
        put_tex(o, value);
    put_text(o, strcmp(key, "title") == 0 ? "}},\n" : "},\n");
}

/* A hyphen between two pages is TeX's dash. */
static void put_pages(struct out *o, struct ior_span pages)
{
    const char *hyphen = memchr(pages.at, '-', pages.length);
    put_text(o, "  pages = {");
    if (hyphen) {
        put_tex(o, (struct ior_span){ pages.at, (size_t)(hyphen - pages.at) });
        put_text(o, "--");
        const size_t rest = pages.length - (size_t)(hyphen + 1 - pages.at);
        put_tex(o, (struct ior_span){ hyphen + 1, rest });
    } else {
        put_tex(o, pages);
    }
    put_text(o, "},\n");
}

/* -- pieces of a reference ------------------------------------------------- */

static struct ior_span between(const char *from, const char *to)
{
    return (struct ior_span){ from, from < to ? (size_t)(to - from) : 0 };
}

static const char *end_of(struct ior_span s)
{
    return s.at + s.length;
}

static struct ior_span trim(struct ior_span s, const char *chars)
{
    while (s.length && strchr(chars, s.at[0]))
        s.at++, s.length--;
    while (s.length && strchr(chars, s.at[s.length - 1]))
        s.length--;
    return s;
}

static bool starts(struct ior_span s, const char *word)
{
    const size_t n = strlen(word);
    return s.length >= n && memcmp(s.at, word, n) == 0;
}

static bool has_digit(struct ior_span s)
{
    for (size_t i = 0; i < s.length; i++)
        if (ior_is_digit(s.at[i]))
            return true;
    return false;
}

static bool has_letter(struct ior_span s)
{
    for (size_t i = 0; i < s.length; i++)
        if (ior_is_letter(s.at[i]))
            return true;
    return false;
}

/* Cuts the last word off, and what is between it and the one before. */
static struct ior_span last_word(struct ior_span *s)
{
    struct ior_span word = trim(*s, " ,\n");
    const char *from = end_of(word);
    while (from > word.at && !strchr(" \n", from[-1]))
        from--;
    word = between(from, end_of(word));
    *s = trim(between(s->at, from), " ,\n");
    return word;
}

/* Up to a bracket that was opened before; or white space, unless the link is
 * known to be in brackets, where some files have spaces in their names. */
static struct ior_span link_at(const char *from, const char *end, bool in)
{
    int depth = 0;
    const char *to = from;
    for (; to < end && (in || !ior_is_space(*to)); to++) {
        depth += (*to == '(') - (*to == ')');
        if (depth < 0)
            break;
    }
    struct ior_span link = between(from, to);
    while (link.length && strchr(".,; ", link.at[link.length - 1]))
        link.length--;
    return link;
}

static struct ior_span find_link(struct ior_span s, const char *before,
                                 const char *first)
{
    for (const char *at = s.at; at < end_of(s); at++) {
        if (!starts(between(at, end_of(s)), before))
            continue;
        const char *from = at + strlen(before);
        if (!starts(between(from, end_of(s)), first))
            continue;
        const char *line = memchr(from, '\n', (size_t)(end_of(s) - from));
        return link_at(from, line ? line : end_of(s),
                       at > s.at && at[-1] == '(');
    }
    return (struct ior_span){ s.at, 0 };
}

/* -- authors --------------------------------------------------------------- */

/* Whether a word is short for a name: A, A., A.-B., Th. */
static bool is_initial(struct ior_span word)
{
    return memchr(word.at, '.', word.length) ||
           ior_letter(word.at, word.length) == word.length;
}

/* Whether the full stop after a word ends what the authors are listed in. */
static bool ends_authors(struct ior_span word)
{
    static const char *const shorts[] = { "Ch", "Jr", "Ph", "Sh",
                                          "St", "Th", "Yu", "Zh" };
    for (size_t i = 0; i < sizeof shorts / sizeof *shorts; i++)
        if (word.length == 2 && starts(word, shorts[i]))
            return false;
    const bool capitals =
        word.length == 2 && word.at[1] >= 'A' && word.at[1] <= 'Z';
    return word.length && !capitals && !is_initial(word);
}

static struct ior_span find_authors(struct ior_span s)
{
    const char *word = s.at;
    for (const char *at = s.at; at < end_of(s); at++) {
        const char after = at + 1 < end_of(s) ? at[1] : '\n';
        if (after == '\n' && (*at == '.' || *at == ','))
            return between(s.at, at);
        if (after == ' ' && *at == '.' && ends_authors(between(word, at)))
            return between(s.at, at);
        if (*at == ' ' || *at == '\n')
            word = at + 1;
    }
    return between(s.at, s.at);
}

/* Cuts the first of "A. Alpha, B. Beta, and C. Gamma" off. */
static struct ior_span next_author(struct ior_span *s)
{
    static const char *const seams[] = { ", and ", " and ", ", " };
    for (const char *at = s->at; at < end_of(*s); at++)
        for (size_t i = 0; i < sizeof seams / sizeof *seams; i++)
            if (starts(between(at, end_of(*s)), seams[i])) {
                const struct ior_span name = between(s->at, at);
                *s = between(at + strlen(seams[i]), end_of(*s));
                return name;
            }
    const struct ior_span name = *s;
    *s = between(end_of(*s), end_of(*s));
    return name;
}

struct name {
    struct ior_span given, family;
    bool et_al; /* and others */
};

static bool read_name(struct ior_span s, struct name *name)
{
    const char *family = NULL;
    int words = 0;
    s = trim(s, " ");
    name->et_al =
        s.length > 6 && starts(between(end_of(s) - 6, end_of(s)), " et al");
    if (name->et_al)
        s.length -= 6;
    for (const char *at = s.at, *to; at < end_of(s); at = to + 1) {
        for (to = at; to < end_of(s) && *to != ' '; to++)
            ;
        const struct ior_span word = between(at, to);
        if (++words > WORDS_MAX || !word.length ||
            !(ior_is_letter(*at) || (unsigned char)*at >= 0x80) ||
            memchr(at, '\n', word.length) || memchr(at, ',', word.length))
            return false;
        if (!family && !is_initial(word))
            family = at;
    }
    if (!family || family == s.at)
        return false;
    name->given = between(s.at, family - 1);
    name->family = between(family, end_of(s));
    return true;
}

static bool names_make_sense(struct ior_span authors)
{
    struct name name;
    if (!authors.length)
        return false;
    while (authors.length)
        if (!read_name(next_author(&authors), &name))
            return false;
    return true;
}

static void put_authors(struct out *o, struct ior_span authors)
{
    struct name name = { .et_al = false };
    const char *seam = "";
    put_text(o, "  author = {");
    for (; authors.length; seam = " and ") {
        read_name(next_author(&authors), &name);
        put_text(o, seam);
        put_tex(o, name.family);
        put_text(o, ", ");
        put_tex(o, name.given);
    }
    put_text(o, name.et_al ? " and others},\n" : "},\n");
}

/* -- a reference ----------------------------------------------------------- */

struct reference {
    struct ior_span all;
    struct ior_span authors, title, journal, volume, pages, note;
    struct ior_span year, doi, url; /* of length 0 where there is none */
    bool article;                   /* all of the first five are there */
};

/* Four digits that may be a year, on their own. */
static bool is_year(struct ior_span all, const char *at)
{
    for (int i = 0; i < 4; i++)
        if (at + i >= end_of(all) || !ior_is_digit(at[i]))
            return false;
    const bool more =
        at + 4 < end_of(all) && (ior_is_digit(at[4]) || ior_is_letter(at[4]));
    return !more && at > all.at && strchr("( ", at[-1]) &&
           (memcmp(at, "18", 2) == 0 || memcmp(at, "19", 2) == 0 ||
            memcmp(at, "20", 2) == 0);
}

/* "Journal 12, 345-350" before a year; false if that is not what is there. */
static bool read_journal(struct reference *r, struct ior_span s)
{
    r->pages = last_word(&s);
    r->volume = last_word(&s);
    r->journal = s;
    return has_digit(r->pages) && has_digit(r->volume) &&
           r->volume.length <= 8 && has_letter(s);
}

/* Given the year, which is in the line of the journal. */
static bool read_article(struct reference *r)
{
    const char *line = r->year.at;
    while (line > r->all.at && line[-1] != '\n')
        line--;
    r->authors = find_authors(r->all);
    const char *rest = end_of(r->authors);
    if (rest >= r->year.at || !names_make_sense(r->authors))
        return false;
    if (!read_journal(r, between(line > rest ? line : rest, r->year.at - 1)))
        return false;
    r->title = trim(between(rest, line), " .,\n");
    if (!r->title.length) { /* in one line with the journal */
        const struct ior_span both = r->journal;
        const char *comma = end_of(both) - 1;
        while (comma > both.at && *comma != ',')
            comma--;
        r->title = trim(between(both.at, comma), " .,\n");
        r->journal = trim(between(comma, end_of(both)), " ,\n");
    }
    return r->title.length && has_letter(r->journal);
}

/* What comes after the year, other than a link to the article. */
static struct ior_span read_note(const struct reference *r)
{
    struct ior_span s = between(end_of(r->year), end_of(r->all));
    s = trim(s, " .,\n");
    if (starts(s, ")"))
        s = trim(between(s.at + 1, end_of(s)), " .,\n");
    if (starts(s, "(http")) {
        const struct ior_span link = link_at(s.at + 1, end_of(s), true);
        s = between(end_of(link) + 1, end_of(s));
    } else if (starts(s, "doi:")) {
        s = between(end_of(link_at(s.at, end_of(s), false)), end_of(s));
    }
    return trim(s, " .,\n");
}

static struct reference read_reference(struct ior_span all)
{
    struct reference r = { .all = all, .year = { all.at, 0 } };
    r.doi = find_link(all, "doi.org/", "10.");
    if (!r.doi.length)
        r.doi = find_link(all, "doi:", "10.");
    if (!r.doi.length)
        r.url = find_link(all, "", "http");
    for (const char *at = all.at; !r.article && at < end_of(all); at++)
        if (is_year(all, at)) {
            const struct ior_span first = r.year;
            r.year = between(at, at + 4);
            r.article = read_article(&r);
            if (!r.article && first.length)
                r.year = first;
        }
    if (r.article)
        r.note = read_note(&r);
    return r;
}

/* -- keys ------------------------------------------------------------------ */

/* The letters from U+00C0 to U+017F without their accents. */
static const char plain_letters[] =
    "AAAAAAACEEEEIIIIDNOOOOOxOUUUUYTsaaaaaaaceeeeiiiidnooooo-ouuuuyty"
    "AaAaAaCcCcCcCcDdDdEeEeEeEeEeGgGgGgGgHhHhIiIiIiIiIiIiJjKkkLlLlLlLlLl"
    "NnNnNnnNnOoOoOoOoRrRrRrSsSsSsSsTtTtTtUuUuUuUuUuUuWwYyYZzZzZzs";
_Static_assert(sizeof plain_letters == 0x180 - 0xC0 + 1, "one a letter");

static void add_to_key(char key[KEY_MAX], struct ior_span s)
{
    size_t used = strlen(key), n;
    for (size_t i = 0; i < s.length && used + 6 < KEY_MAX; i += n ? n : 1) {
        const unsigned char *c = (const unsigned char *)s.at + i;
        n = ior_letter(s.at + i, s.length - i);
        const unsigned code = n == 2 ? (c[0] & 0x1Fu) << 6 | (c[1] & 0x3Fu) : 0;
        char letter = (char)*c;
        if (code >= 0xC0 && code < 0x180)
            letter = plain_letters[code - 0xC0];
        if (ior_is_letter(letter) || ior_is_digit(letter))
            key[used++] = letter;
    }
    key[used] = '\0';
}

static struct ior_span stem_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    return between(name, dot && dot > name ? dot : name + strlen(name));
}

struct keys {
    char at[KEYS_MAX][KEY_MAX];
    int count;
};

/* As in Mathewson1971; with a, b and so on after it where there are more. */
static const char *new_key(struct keys *keys, const struct reference *r,
                           const char *path)
{
    char *key = keys->at[keys->count++];
    key[0] = '\0';
    if (r->article) {
        struct ior_span authors = r->authors;
        struct name name;
        read_name(next_author(&authors), &name);
        add_to_key(key, name.family);
    }
    if (!*key)
        add_to_key(key, stem_of(path));
    if (!*key)
        add_to_key(key, (struct ior_span){ "page", 4 });
    add_to_key(key, r->year);
    int alike = 0;
    for (int i = 0; i + 1 < keys->count; i++)
        alike += strncmp(keys->at[i], key, strlen(key)) == 0;
    if (alike)
        add_to_key(key, (struct ior_span){ &"abcdefghijklmnop"[alike], 1 });
    return key;
}

/* -- entries --------------------------------------------------------------- */

static void put_reference(struct out *o, const struct reference *r,
                          const char *key)
{
    put_text(o, r->article ? "@article{" : "@misc{");
    put_text(o, key);
    put_text(o, ",\n");
    if (r->article) {
        put_authors(o, r->authors);
        put_field(o, "title", r->title, false);
        put_field(o, "journal", r->journal, false);
        put_field(o, "volume", r->volume, false);
        put_pages(o, r->pages);
    }
    put_field(o, "year", r->year, false);
    put_field(o, "doi", r->doi, true);
    put_field(o, "url", r->url, true);
    put_field(o, "note", r->article ? r->note : r->all, false);
    put_text(o, "}\n");
}

/* Up to the next line that starts with the number of a reference and ")". */
static struct ior_span next_reference(struct ior_span *s, int number)
{
    const char *from = s->at, *to = from;
    char mark[16];
    snprintf(mark, sizeof mark, "%d) ", number);
    if (starts(*s, mark))
        from += strlen(mark);
    snprintf(mark, sizeof mark, "\n%d) ", number + 1);
    while (to < end_of(*s) && !starts(between(to, end_of(*s)), mark))
        to++;
    const struct ior_span all = between(from, to);
    *s = between(to < end_of(*s) ? to + 1 : to, end_of(*s));
    return trim(all, " \n");
}

static void put_unknown(struct out *o, const struct ior_page *page)
{
    const char *comments = ior_page_comments(page);
    struct keys keys = { .count = 0 };
    const struct reference none = { .year = { comments, 0 } };
    put_text(o, "@misc{");
    put_text(o, new_key(&keys, &none, page->path));
    put_text(o, ",\n");
    put_field(o, "title", stem_of(page->path), false);
    put_field(o, "note", (struct ior_span){ comments, strlen(comments) },
              false);
    put_text(o, "}\n");
}

bool ior_page_bibtex(const struct ior_page *page, char *text, size_t size)
{
    static const char database[] =
        "@article{Polyanskiy2024,\n"
        "  author = {Polyanskiy, M. N.},\n"
        "  title = {{Refractiveindex.info database of optical constants}},\n"
        "  journal = {Scientific Data},\n"
        "  volume = {11},\n"
        "  pages = {94},\n"
        "  year = {2024},\n"
        "  doi = {10.1038/s41597-023-02898-2},\n"
        "}\n";
    struct out o = { .text = text, .size = size };
    struct keys keys = { .count = 0 };
    const char *reference = ior_page_reference(page);
    struct ior_span s = { reference, strlen(reference) };
    if (!size)
        return false;
    text[0] = '\0';
    if (!s.length)
        put_unknown(&o, page);
    for (int i = 1; s.length && i <= KEYS_MAX; i++) {
        /* The last takes what is left. */
        struct ior_span all = i < KEYS_MAX ? next_reference(&s, i) : s;
        if (i == KEYS_MAX)
            s.length = 0;
        const struct reference r = read_reference(all);
        if (i > 1)
            put_text(&o, "\n");
        put_reference(&o, &r, new_key(&keys, &r, page->path));
    }
    if (page->of_database) {
        put_text(&o, "\n");
        put_text(&o, database);
    }
    if (o.full)
        text[0] = '\0';
    return !o.full;
}
