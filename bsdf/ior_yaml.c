/* ior_yaml.c - reading pages of the refractiveindex.info database [1]
 *
 * A page is a mapping.  Its DATA is a list, of which these items count:
 *
 *   type: tabulated nk      n and k on the same grid
 *   type: tabulated n       n alone
 *   type: tabulated k       k alone
 *   data: |                 rows of a wavelength [um] and one or two values
 *
 * "tabulated n2" is nonlinear optics and skipped; "formula 1" to "formula 9"
 * are not read yet.  REFERENCES and COMMENTS are HTML, or Markdown since 2026;
 * the other keys are skipped.
 *
 * The YAML is read as a stream of events, of which nothing but the tables and
 * those two texts is kept, and whose depth is bounded: libyaml's own loader
 * runs past a minute on 200,000 brackets.
 *
 * [1] M. N. Polyanskiy, Refractiveindex.info database of optical constants,
 *     Scientific Data 11, 94, 2024.
 */
#include "bsdf/ior.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <yaml.h>

/* Far beyond any page; the largest seen has 0.1 MB. */
enum {
    BYTES_MAX = 64 << 20,
    ROWS_MAX = 1000000,
    DEPTH_MAX = 64,
    TEXT_MAX = 1 << 14,
    WARNINGS_MAX = 32,
};

struct table {
    size_t rows;
    double *nm, *value;
};

struct ior_page {
    char *path, *reference, *comments;
    struct table n, k;
    double lo, hi;   /* range [nm] */
    char **warnings; /* the last is NULL */
    size_t warned;   /* how many there would be without the limit */
};

/* -- a page that has been read --------------------------------------------- */

void ior_page_free(struct ior_page *page)
{
    if (!page)
        return;
    for (size_t i = 0; page->warnings && i <= WARNINGS_MAX; i++)
        free(page->warnings[i]);
    free(page->warnings);
    free(page->n.nm);
    free(page->n.value);
    free(page->k.nm);
    free(page->k.value);
    free(page->path);
    free(page->reference);
    free(page->comments);
    free(page);
}

const char *ior_page_path(const struct ior_page *page)
{
    return page->path;
}

const char *ior_page_reference(const struct ior_page *page)
{
    return page->reference ? page->reference : "";
}

const char *ior_page_comments(const struct ior_page *page)
{
    return page->comments ? page->comments : "";
}

const char *const *ior_page_warnings(const struct ior_page *page)
{
    static const char *const none[] = { NULL };
    return page->warnings ? (const char *const *)page->warnings : none;
}

struct ior_table ior_page_n(const struct ior_page *page)
{
    return (struct ior_table){ page->n.rows, page->n.nm, page->n.value };
}

struct ior_table ior_page_k(const struct ior_page *page)
{
    return (struct ior_table){ page->k.rows, page->k.nm, page->k.value };
}

bool ior_page_has_k(const struct ior_page *page)
{
    return page->k.rows > 0;
}

void ior_page_range(const struct ior_page *page, double *lo_nm, double *hi_nm)
{
    *lo_nm = page->lo;
    *hi_nm = page->hi;
}

/* Linear in the wavelength, which is inside the table.  A row's own wavelength
 * gives its value to the bit, and asks nothing of its neighbours. */
static bool at(const struct ior_page *page, const struct table *t,
               const char *what, double nm, double *value, struct err *err)
{
    size_t below = 0, above = t->rows; /* nm[below] <= nm < nm[above] */
    while (above - below > 1) {
        const size_t middle = below + (above - below) / 2;
        if (t->nm[middle] <= nm)
            below = middle;
        else
            above = middle;
    }
    const bool on_row = t->nm[below] == nm;
    for (size_t i = below; i <= below + !on_row; i++)
        if (t->value[i] < 0)
            return err_set(err,
                           "%.400s: no %s at %.10g nm, as the measured %s is "
                           "%g at %.10g nm, and it should not be negative",
                           page->path, what, nm, what, t->value[i], t->nm[i]);
    *value = t->value[below];
    if (!on_row)
        *value += (nm - t->nm[below]) / (t->nm[above] - t->nm[below]) *
                  (t->value[above] - t->value[below]);
    return true;
}

bool ior_page_at(const struct ior_page *page, double nm, double *n, double *k,
                 struct err *err)
{
    double n_read, k_read = 0;
    if (!(nm >= page->lo && nm <= page->hi)) /* a NaN fails too */
        return err_set(err,
                       "%.400s: wavelength %.10g nm is outside [%.10g, %.10g] "
                       "nm, which the page covers",
                       page->path, nm, page->lo, page->hi);
    if (!at(page, &page->n, "n", nm, &n_read, err))
        return false;
    if (page->k.rows && !at(page, &page->k, "k", nm, &k_read, err))
        return false;
    *n = n_read;
    *k = k_read;
    return true;
}

/* -- YAML events ----------------------------------------------------------- */

/* A piece of a file, fit to be quoted in a message. */
struct quote {
    char text[32];
};

static struct quote quote(const char *text, size_t length)
{
    struct quote q = { "" };
    const size_t room = sizeof q.text - 4;
    size_t i = 0;
    for (; i < length && i < room; i++)
        q.text[i] = text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
    if (length > room)
        memcpy(q.text + i, "...", 4);
    return q;
}

struct reader {
    struct ior_page *page;
    struct err *err;
    const char *bytes; /* of the whole file */
    size_t size;
    yaml_parser_t parser;
    yaml_event_t event; /* the one being looked at */
    int depth;          /* of the mappings and lists it is in */
    bool in_data;       /* where an alias would stand for numbers */
    struct quote other; /* the first type in DATA that is not read */
    size_t other_line;  /* where it is; 0 if there is none */
};

/* Always false: "FILE:LINE: why", with lines counted from 1; 0 for none. */
__attribute__((format(printf, 3, 4))) static bool
fail(const struct reader *r, size_t line, const char *format, ...)
{
    char why[512];
    va_list args;
    va_start(args, format);
    vsnprintf(why, sizeof why, format, args);
    va_end(args);
    if (line)
        return err_set(r->err, "%.400s:%zu: %s", r->page->path, line, why);
    return err_set(r->err, "%.400s: %s", r->page->path, why);
}

static bool out_of_memory(const struct reader *r)
{
    return fail(r, 0, "out of memory");
}

/* Where the current event starts, in lines counted from 1. */
static size_t line_of(const struct reader *r)
{
    return r->event.start_mark.line + 1;
}

static bool fail_syntax(const struct reader *r)
{
    const yaml_parser_t *p = &r->parser;
    const char *context = p->context ? p->context : "";
    if (p->error == YAML_MEMORY_ERROR)
        return out_of_memory(r);
    if (p->error == YAML_READER_ERROR) { /* knows the byte, not the line */
        size_t line = 1;
        for (size_t i = 0; i < p->problem_offset && i < r->size; i++)
            line += r->bytes[i] == '\n';
        return fail(r, line, "not YAML: %s", p->problem);
    }
    return fail(r, p->problem_mark.line + 1, "not YAML: %s%s%s", p->problem,
                *context ? " " : "", context);
}

/* On to the next event. */
static bool next(struct reader *r)
{
    yaml_event_delete(&r->event);
    if (!yaml_parser_parse(&r->parser, &r->event))
        return fail_syntax(r);
    switch (r->event.type) {
    case YAML_SEQUENCE_START_EVENT:
    case YAML_MAPPING_START_EVENT:
        if (++r->depth > DEPTH_MAX)
            return fail(r, line_of(r), "nested more than %d deep", DEPTH_MAX);
        break;
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        r->depth--;
        break;
    case YAML_ALIAS_EVENT:
        if (r->in_data)
            return fail(r, line_of(r), "an alias (*) in DATA is not followed");
        break;
    default:
        break;
    }
    return true;
}

/* To the end of the value that the current event starts. */
static bool skip(struct reader *r)
{
    if (r->event.type != YAML_SEQUENCE_START_EVENT &&
        r->event.type != YAML_MAPPING_START_EVENT)
        return true;
    const int outside = r->depth - 1;
    while (r->depth > outside)
        if (!next(r))
            return false;
    return true;
}

static bool is_scalar(const struct reader *r)
{
    return r->event.type == YAML_SCALAR_EVENT;
}

static const char *text_of(const struct reader *r)
{
    return (const char *)r->event.data.scalar.value;
}

static size_t length_of(const struct reader *r)
{
    return r->event.data.scalar.length;
}

static bool text_is(const struct reader *r, const char *word)
{
    return is_scalar(r) && length_of(r) == strlen(word) &&
           memcmp(text_of(r), word, length_of(r)) == 0;
}

/* -- texts ----------------------------------------------------------------- */

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

static bool is_space(char c)
{
    return (unsigned char)c <= ' ' || c == 0x7f; /* and controls */
}

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool is_word(char c)
{
    return is_letter(c) || is_digit(c) || (unsigned char)c >= 0x80;
}

/* One space or line break for any number of them. */
static void put(struct plain *p, char c)
{
    if (c == '\n')
        while (p->used && p->text[p->used - 1] == ' ')
            p->used--;
    const char last = p->used ? p->text[p->used - 1] : '\n';
    if (!is_space(c))
        p->text[p->used++] = c;
    else if (!is_space(last))
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
    if (left < 3 || s[0] != '<' || !(is_letter(s[1]) || s[1] == '/'))
        return false;
    const char *end = memchr(s, '>', left);
    if (!end)
        return false;
    const size_t length = (size_t)(end - s) + 1;
    if (s[1] == 'a' && is_space(s[2])) {
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
            (is_space(before) && is_space(after)))
            return false;
        p->i = end;
        return true;
    case '\\':
        if (i + 1 >= p->n || is_word(s[i + 1]) || is_space(s[i + 1]))
            return false;
        put(p, s[i + 1]);
        p->i += 2;
        return true;
    default:
        return false;
    }
}

/* Without the marks of HTML and Markdown; "text (URL)" for a link, as that is
 * where the DOI is.  NULL if there is no memory. */
static char *plain_text(const char *s, size_t n)
{
    if (n > TEXT_MAX)
        for (n = TEXT_MAX; n && ((unsigned char)s[n] & 0xC0) == 0x80; n--)
            ; /* not in the middle of a letter */
    struct plain p = { .s = s, .n = n, .text = malloc(n + 1) };
    if (!p.text)
        return NULL;
    while (p.i < n)
        if (!html(&p) && !markdown(&p))
            put(&p, s[p.i++]);
    while (p.used && is_space(p.text[p.used - 1]))
        p.used--;
    p.text[p.used] = '\0';
    return p.text;
}

static bool read_text(struct reader *r, char **text)
{
    free(*text);
    *text = plain_text(text_of(r), length_of(r));
    return *text || out_of_memory(r);
}

/* -- tables ---------------------------------------------------------------- */

/* What each type of table has beside the wavelength. */
static const struct kind {
    const char *type;
    int columns;
    const char *heads;
    bool has_n, has_k;
} kinds[] = {
    { "tabulated nk", 3, "wavelength, n and k", true, true },
    { "tabulated n", 2, "wavelength and n", true, false },
    { "tabulated k", 2, "wavelength and k", false, true },
};

struct row {
    double nm, value[2];
    size_t number; /* in the file, from 1; blank lines do not count */
};

struct rows {
    struct row *at;
    size_t count, room;
};

/* An item of DATA. */
struct item {
    struct quote type;
    char *data;
    size_t length;
    size_t line;      /* of the item in the file */
    size_t data_line; /* of the first row */
    bool literal;     /* each line of the data is one of the file */
};

static void warn(struct ior_page *page, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Without memory for a warning there will be none for the rows either. */
static void warn(struct ior_page *page, const char *format, ...)
{
    char text[256];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (!page->warnings)
        page->warnings = calloc(WARNINGS_MAX + 2, sizeof *page->warnings);
    if (page->warnings && page->warned < WARNINGS_MAX)
        page->warnings[page->warned] = strdup(text);
    page->warned++;
}

/* A decimal number, times ten to the shift.  The shift goes into the exponent
 * before the number is rounded, so that 0.54321 um is the 543.21 nm that a
 * caller writes, to the last bit. */
static bool read_number(const char *text, size_t length, long shift,
                        double *value)
{
    char copy[80];
    size_t i = 0, digits = 0;
    if (length >= sizeof copy - 24)
        return false;
    i += i < length && (text[i] == '+' || text[i] == '-');
    for (; i < length && is_digit(text[i]); i++)
        digits++;
    i += i < length && text[i] == '.';
    for (; i < length && is_digit(text[i]); i++)
        digits++;
    if (!digits)
        return false;
    const size_t mantissa = i;
    if (i < length && (text[i] == 'e' || text[i] == 'E')) {
        i++;
        const bool minus = i < length && text[i] == '-';
        i += minus || (i < length && text[i] == '+');
        if (i == length || length - i > 6)
            return false;
        long exponent = 0;
        for (; i < length && is_digit(text[i]); i++)
            exponent = 10 * exponent + (text[i] - '0');
        shift += minus ? -exponent : exponent;
    }
    if (i != length)
        return false;
    snprintf(copy, sizeof copy, "%.*se%ld", (int)mantissa, text, shift);
    *value = strtod(copy, NULL);
    return isfinite(*value);
}

static bool read_row(const struct reader *r, const struct kind *kind,
                     const char *text, size_t length, size_t line,
                     struct row *row)
{
    int columns = 0;
    for (size_t i = 0, end; i < length; i = end) {
        if (is_space(text[i])) {
            end = i + 1;
            continue;
        }
        for (end = i; end < length && !is_space(text[end]);)
            end++;
        if (columns < kind->columns) {
            double *value = columns ? &row->value[columns - 1] : &row->nm;
            if (!read_number(text + i, end - i, columns ? 0 : 3, value))
                return fail(r, line, "row %zu of %s: \"%s\" is not a number",
                            row->number, kind->type,
                            quote(text + i, end - i).text);
        }
        columns++;
    }
    if (columns != kind->columns)
        return fail(r, line, "row %zu of %s: %d value%s, expected %s",
                    row->number, kind->type, columns, columns == 1 ? "" : "s",
                    kind->heads);
    if (!(row->nm > 0))
        return fail(r, line,
                    "row %zu of %s: wavelength %g um, expected more than 0",
                    row->number, kind->type, row->nm / 1000);
    return true;
}

static bool rows_add(struct rows *rows, struct row row)
{
    if (rows->count == rows->room) {
        const size_t room = rows->room ? 2 * rows->room : 256;
        struct row *at = realloc(rows->at, room * sizeof *at);
        if (!at)
            return false;
        rows->at = at;
        rows->room = room;
    }
    rows->at[rows->count++] = row;
    return true;
}

static bool read_rows(const struct reader *r, const struct kind *kind,
                      const struct item *item, struct rows *rows)
{
    size_t line = item->data_line;
    for (size_t i = 0, end; i < item->length; i = end + 1) {
        bool blank = true;
        for (end = i; end < item->length && item->data[end] != '\n'; end++)
            blank = blank && is_space(item->data[end]);
        if (!blank) {
            struct row row = { .number = rows->count + 1 };
            if (row.number > ROWS_MAX)
                return fail(r, line, "%s has more than %d rows", kind->type,
                            ROWS_MAX);
            if (!read_row(r, kind, item->data + i, end - i, line, &row))
                return false;
            if (!rows_add(rows, row))
                return out_of_memory(r);
        }
        line += item->literal;
    }
    return rows->count || fail(r, item->line, "%s has no rows", kind->type);
}

static int by_wavelength(const void *a, const void *b)
{
    const struct row *p = a, *q = b;
    if (p->nm != q->nm)
        return p->nm < q->nm ? -1 : 1;
    return (p->number > q->number) - (p->number < q->number);
}

static void sort(struct ior_page *page, const struct kind *kind,
                 struct rows *rows)
{
    size_t wrong = 0, first = 0;
    for (size_t i = 1; i < rows->count; i++)
        if (rows->at[i].nm < rows->at[i - 1].nm && !wrong++)
            first = i;
    if (!wrong)
        return;
    warn(page,
         "%s: wavelengths do not rise at %zu of %zu rows, the first of them "
         "row %zu with %.10g nm after %.10g nm; sorted",
         kind->type, wrong, rows->count, rows->at[first].number,
         rows->at[first].nm, rows->at[first - 1].nm);
    qsort(rows->at, rows->count, sizeof *rows->at, by_wavelength);
}

/* One row for the given ones of one wavelength. */
static struct row mean(struct ior_page *page, const struct kind *kind,
                       const struct row *rows, size_t count)
{
    struct row m = rows[0];
    bool same = true;
    for (size_t i = 1; i < count; i++)
        same = same && rows[i].value[0] == m.value[0] &&
               rows[i].value[1] == m.value[1];
    if (same)
        return m;
    m.value[0] = m.value[1] = 0;
    char numbers[80] = "";
    for (size_t i = 0, used = 0; i < count; i++) {
        m.value[0] += rows[i].value[0] / (double)count;
        m.value[1] += rows[i].value[1] / (double)count;
        if (used + 24 < sizeof numbers)
            used += (size_t)snprintf(numbers + used, sizeof numbers - used,
                                     "%s%zu", i ? ", " : "", rows[i].number);
    }
    warn(page, "%s: %zu rows (%s) differ at %.10g nm; averaged", kind->type,
         count, numbers, m.nm);
    return m;
}

static void merge(struct ior_page *page, const struct kind *kind,
                  struct rows *rows)
{
    size_t kept = 0;
    for (size_t i = 0, end; i < rows->count; i = end) {
        for (end = i + 1; end < rows->count; end++)
            if (rows->at[end].nm != rows->at[i].nm)
                break;
        rows->at[kept++] = mean(page, kind, rows->at + i, end - i);
    }
    rows->count = kept;
}

/* Keeps one column of a table. */
static bool keep(struct reader *r, const struct kind *kind,
                 const struct item *item, const struct rows *rows, int column,
                 const char *what, struct table *t)
{
    assert(rows->count > 0);
    if (t->rows)
        return fail(r, item->line, "%s: DATA has %s already", kind->type, what);
    t->nm = malloc(rows->count * sizeof *t->nm);
    t->value = malloc(rows->count * sizeof *t->value);
    if (!t->nm || !t->value)
        return out_of_memory(r);
    t->rows = rows->count;
    for (size_t i = 0; i < rows->count; i++) {
        const struct row *row = &rows->at[i];
        t->nm[i] = row->nm;
        t->value[i] = row->value[column] + 0.; /* no -0 */
        if (t->value[i] < 0)
            warn(r->page,
                 "%s: row %zu has a negative %s = %g at %.10g nm; there is no "
                 "%s from there to the rows next to it",
                 kind->type, row->number, what, t->value[i], row->nm, what);
    }
    return true;
}

static bool read_table(struct reader *r, const struct kind *kind,
                       const struct item *item)
{
    struct rows rows = { 0 };
    bool good = read_rows(r, kind, item, &rows);
    if (good) {
        sort(r->page, kind, &rows);
        merge(r->page, kind, &rows);
    }
    if (good && kind->has_n)
        good = keep(r, kind, item, &rows, 0, "n", &r->page->n);
    if (good && kind->has_k)
        good = keep(r, kind, item, &rows, kind->columns - 2, "k", &r->page->k);
    free(rows.at);
    return good;
}

/* -- the page -------------------------------------------------------------- */

static bool read_item_key(struct reader *r, struct item *item)
{
    const bool type = text_is(r, "type"), data = text_is(r, "data");
    const size_t line = line_of(r);
    if (!skip(r) || !next(r))
        return false;
    if (!type && !data)
        return skip(r);
    if (!is_scalar(r))
        return fail(r, line, "%s in DATA: expected text",
                    type ? "type" : "data");
    if (type ? item->type.text[0] != '\0' : item->data != NULL)
        return fail(r, line, "a second %s in one item of DATA",
                    type ? "type" : "data");
    if (type) {
        item->type = quote(text_of(r), length_of(r));
        return true;
    }
    item->literal = r->event.data.scalar.style == YAML_LITERAL_SCALAR_STYLE;
    item->data_line = line_of(r) + item->literal;
    item->length = length_of(r);
    item->data = malloc(item->length + 1);
    if (!item->data)
        return out_of_memory(r);
    memcpy(item->data, text_of(r), item->length);
    return true;
}

static bool use_item(struct reader *r, const struct item *item)
{
    const char *type = item->type.text;
    if (!*type)
        return fail(r, item->line, "an item of DATA has no type");
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(type, kinds[i].type) == 0)
            return item->data ? read_table(r, &kinds[i], item)
                              : fail(r, item->line, "%s has no data", type);
    if (strcmp(type, "tabulated n2") != 0 && !r->other_line) {
        r->other = item->type;
        r->other_line = item->line;
    }
    return true;
}

static bool read_data(struct reader *r)
{
    if (r->event.type != YAML_SEQUENCE_START_EVENT)
        return fail(r, line_of(r), "DATA is not a list");
    for (;;) {
        if (!next(r))
            return false;
        if (r->event.type == YAML_SEQUENCE_END_EVENT)
            return true;
        if (r->event.type != YAML_MAPPING_START_EVENT)
            return fail(r, line_of(r),
                        "an item of DATA is no mapping with a type and data");
        struct item item = { .line = line_of(r) };
        bool good = next(r);
        while (good && r->event.type != YAML_MAPPING_END_EVENT)
            good = read_item_key(r, &item) && next(r);
        good = good && use_item(r, &item);
        free(item.data);
        if (!good)
            return false;
    }
}

/* A key and its value, of the mapping that the file is. */
static bool read_key(struct reader *r, bool *had_data)
{
    const bool data = text_is(r, "DATA");
    char **text = text_is(r, "REFERENCES") ? &r->page->reference
                  : text_is(r, "COMMENTS") ? &r->page->comments
                                           : NULL;
    if (data && *had_data)
        return fail(r, line_of(r), "a second DATA");
    *had_data = *had_data || data;
    r->in_data = data;
    bool good = skip(r) && next(r);
    if (good && data)
        good = read_data(r);
    else if (good && text && is_scalar(r))
        good = read_text(r, text);
    else if (good)
        good = skip(r);
    r->in_data = false;
    return good;
}

static bool read_file(struct reader *r)
{
    bool had_data = false;
    if (!next(r) || !next(r)) /* stream, document */
        return false;
    if (r->event.type == YAML_STREAM_END_EVENT)
        return fail(r, 0, "nothing in it");
    if (!next(r))
        return false;
    if (r->event.type != YAML_MAPPING_START_EVENT)
        return fail(r, line_of(r), "expected a mapping with DATA in it");
    if (!next(r))
        return false;
    while (r->event.type != YAML_MAPPING_END_EVENT)
        if (!read_key(r, &had_data) || !next(r))
            return false;
    if (!next(r) || !next(r)) /* ends of document and stream */
        return false;
    if (r->event.type != YAML_STREAM_END_EVENT)
        return fail(r, line_of(r), "a second document in one file");
    return had_data || fail(r, 0, "no DATA in it");
}

/* The range, and the last warnings. */
static bool finish(struct reader *r)
{
    struct ior_page *page = r->page;
    const struct table *n = &page->n, *k = &page->k;
    if (!n->rows && r->other_line)
        return fail(r, r->other_line,
                    strncmp(r->other.text, "formula", 7) == 0
                        ? "formula dispersion is not supported yet (%s)"
                        : "unknown type \"%s\", expected tabulated nk, n or k",
                    r->other.text);
    if (!n->rows)
        return fail(r, 0, "no n in DATA, expected tabulated nk or n");
    if (r->other_line)
        warn(page, "%s is ignored, as n is tabulated as well", r->other.text);
    page->lo = n->nm[0];
    page->hi = n->nm[n->rows - 1];
    if (k->rows) {
        page->lo = fmax(page->lo, k->nm[0]);
        page->hi = fmin(page->hi, k->nm[k->rows - 1]);
    }
    if (page->lo > page->hi)
        return fail(r, 0,
                    "no wavelength has both, n in [%.10g, %.10g] and k in "
                    "[%.10g, %.10g] nm",
                    n->nm[0], n->nm[n->rows - 1], k->nm[0], k->nm[k->rows - 1]);
    if (page->warnings && page->warned > WARNINGS_MAX) {
        char text[64];
        snprintf(text, sizeof text, "and %zu more such warnings",
                 page->warned - WARNINGS_MAX);
        page->warnings[WARNINGS_MAX] = strdup(text);
    }
    return true;
}

/* The bytes of a regular file; NULL if it cannot be read.  A pipe or a device
 * is not waited for. */
static char *read_bytes(const struct reader *r, size_t *size)
{
    char *bytes = NULL;
    struct stat s;
    const int file =
        open(r->page->path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0 || fstat(file, &s) != 0) {
        fail(r, 0, "%s", strerror(errno));
        goto done;
    }
    if (!S_ISREG(s.st_mode)) {
        fail(r, 0,
             S_ISDIR(s.st_mode) ? "a folder, expected a file"
                                : "not a regular file");
        goto done;
    }
    if (s.st_size > BYTES_MAX) {
        fail(r, 0, "%lld bytes, expected at most %d", (long long)s.st_size,
             BYTES_MAX);
        goto done;
    }
    bytes = malloc((size_t)s.st_size + 1);
    if (!bytes) {
        out_of_memory(r);
        goto done;
    }
    ssize_t got;
    *size = 0;
    while ((got = read(file, bytes + *size, (size_t)s.st_size - *size)) > 0)
        *size += (size_t)got;
    if (got < 0) {
        fail(r, 0, "%s", strerror(errno));
        free(bytes);
        bytes = NULL;
    }
done:
    if (file >= 0)
        close(file);
    return bytes;
}

static bool read_page(struct reader *r)
{
    /* libyaml compares each of these with all before it: 80,000 take 26 s. */
    if (memmem(r->bytes, r->size, "%TAG", 4))
        return fail(r, 0, "%%TAG in it, which no page has use for");
    if (!yaml_parser_initialize(&r->parser))
        return out_of_memory(r);
    yaml_parser_set_encoding(&r->parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&r->parser, (const unsigned char *)r->bytes,
                                 r->size);
    const bool good = read_file(r) && finish(r);
    yaml_event_delete(&r->event);
    yaml_parser_delete(&r->parser);
    return good;
}

struct ior_page *ior_page_load(const char *path, struct err *err)
{
    assert(path);
    struct reader r = { .err = err, .page = calloc(1, sizeof *r.page) };
    char *bytes = NULL;
    bool good = r.page && (r.page->path = strdup(path));
    if (!good)
        err_set(err, "%.400s: out of memory", path);
    else
        good = (bytes = read_bytes(&r, &r.size)) != NULL;
    r.bytes = bytes;
    good = good && read_page(&r);
    free(bytes);
    if (good)
        return r.page;
    ior_page_free(r.page);
    return NULL;
}
