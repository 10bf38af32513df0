/* ior_yaml.c - reading pages of the refractiveindex.info database [1]
 *
 * A page is a mapping.  Its DATA is a list, of which these items count:
 *
 *   type: tabulated nk      n and k on the same grid
 *   type: tabulated n       n alone
 *   type: tabulated k       k alone
 *   data: |                 rows of a wavelength [um] and one or two values
 *
 *   type: formula 1         n, up to formula 9, see ior_formula.c
 *   wavelength_range: A B   [um]; before 2018 it was called range
 *   coefficients: C1 C2 ..
 *
 * "tabulated n2" is nonlinear optics and skipped.  So are the keys other than
 * REFERENCES and COMMENTS, and with them the formulas under PROPERTIES, which
 * are about temperature.
 *
 * The YAML is read as a stream of events, of which nothing but the numbers and
 * those two texts is kept, and whose depth is bounded: libyaml's own loader
 * runs past a minute on 200,000 brackets.
 *
 * [1] M. N. Polyanskiy, Refractiveindex.info database of optical constants,
 *     Scientific Data 11, 94, 2024.
 */
#include "bsdf/ior_page.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

enum { DEPTH_MAX = 64 };

/* -- YAML events ----------------------------------------------------------- */

struct reader {
    const struct ior_source *file;
    yaml_parser_t parser;
    yaml_event_t event;     /* the one being looked at */
    int depth;              /* of the mappings and lists it is in */
    bool in_data;           /* where an alias would stand for numbers */
    struct ior_quote other; /* the first type in DATA that is not read */
    size_t other_line;      /* where it is; 0 if there is none */
};

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
        return ior_out_of_memory(r->file);
    if (p->error == YAML_READER_ERROR) { /* knows the byte, not the line */
        size_t line = 1;
        for (size_t i = 0; i < p->problem_offset && i < r->file->size; i++)
            line += r->file->bytes[i] == '\n';
        return ior_fail(r->file, line, "not YAML: %s", p->problem);
    }
    return ior_fail(r->file, p->problem_mark.line + 1, "not YAML: %s%s%s",
                    p->problem, *context ? " " : "", context);
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
            return ior_fail(r->file, line_of(r), "nested more than %d deep",
                            DEPTH_MAX);
        break;
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        r->depth--;
        break;
    case YAML_ALIAS_EVENT:
        if (r->in_data)
            return ior_fail(r->file, line_of(r),
                            "an alias (*) in DATA is not followed");
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

static bool read_text(struct reader *r, char **text)
{
    free(*text);
    *text = ior_plain_text(text_of(r), length_of(r));
    return *text || ior_out_of_memory(r->file);
}

/* -- items of DATA --------------------------------------------------------- */

static const struct ior_kind kinds[] = {
    { "tabulated nk", 3, "wavelength, n and k", .has_n = true, .has_k = true },
    { "tabulated n", 2, "wavelength and n", .has_n = true },
    { "tabulated k", 2, "wavelength and k", .has_k = true },
};

enum part { DATA, COEFFICIENTS, RANGE, PARTS };

static const struct {
    const char *key;
    enum part part;
} keys[] = {
    { "data", DATA },
    { "coefficients", COEFFICIENTS },
    { "wavelength_range", RANGE },
    { "range", RANGE },
};

struct item {
    struct ior_quote type;
    struct ior_lines parts[PARTS]; /* owned; the text is NULL if not given */
    size_t line;                   /* of the item in the file */
};

static bool keep_part(struct reader *r, struct item *item, enum part part)
{
    struct ior_lines *lines = &item->parts[part];
    const bool literal =
        r->event.data.scalar.style == YAML_LITERAL_SCALAR_STYLE;
    char *copy = malloc(length_of(r) + 1);
    if (!copy)
        return ior_out_of_memory(r->file);
    memcpy(copy, text_of(r), length_of(r));
    *lines = (struct ior_lines){ copy, length_of(r), line_of(r) + literal,
                                 literal, item->line };
    return true;
}

static bool read_item_key(struct reader *r, struct item *item)
{
    char key[20] = "";
    const size_t line = line_of(r);
    enum part part = PARTS;
    const bool type = text_is(r, "type");
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (text_is(r, keys[i].key))
            part = keys[i].part;
    if (type || part != PARTS)
        snprintf(key, sizeof key, "%s", text_of(r));
    if (!skip(r) || !next(r))
        return false;
    if (!*key)
        return skip(r);
    if (!is_scalar(r))
        return ior_fail(r->file, line, "%s in DATA: expected text", key);
    if (type ? *item->type.text != '\0' : item->parts[part].text != NULL)
        return ior_fail(r->file, line, "a second %s in one item of DATA", key);
    if (!type)
        return keep_part(r, item, part);
    item->type = ior_quote(text_of(r), length_of(r));
    return true;
}

/* Numbers that white space parts, up to the given room for them; how many there
 * are, or -1 if there are more or one is none. */
static int read_numbers(struct reader *r, const struct item *item,
                        enum part part, long shift, size_t room, double *value)
{
    const struct ior_lines *lines = &item->parts[part];
    const char *what = part == RANGE ? "range" : "coefficients";
    size_t line = lines->line, count = 0;
    for (size_t i = 0, end; i < lines->length; i = end + 1) {
        for (end = i; end < lines->length; end++)
            if (ior_is_space(lines->text[end]))
                break;
        const char *number = lines->text + i;
        if (end > i && count == room) {
            ior_fail(r->file, line,
                     "%s: %s \"%s\" is one too many, as it "
                     "takes %zu",
                     item->type.text, what, ior_quote(number, end - i).text,
                     room);
            return -1;
        }
        if (end > i && !ior_number(number, end - i, shift, &value[count++])) {
            ior_fail(r->file, line, "%s: %s \"%s\" is not a number",
                     item->type.text, what, ior_quote(number, end - i).text);
            return -1;
        }
        line +=
            lines->each && end < lines->length && *(number + end - i) == '\n';
    }
    return (int)count;
}

static bool read_range(struct reader *r, const struct item *item,
                       struct ior_dispersion *f)
{
    double nm[2];
    const char *type = item->type.text;
    const size_t line = item->parts[RANGE].line;
    if (!item->parts[RANGE].text)
        return ior_fail(r->file, item->line, "%s has no wavelength_range",
                        type);
    const int count = read_numbers(r, item, RANGE, 3, 2, nm);
    if (count >= 0 && count != 2)
        return ior_fail(r->file, line,
                        "%s: %d number%s in its range, expected the least and "
                        "the greatest wavelength",
                        type, count, count == 1 ? "" : "s");
    if (count == 2 && !(nm[0] > 0 && nm[0] <= nm[1]))
        return ior_fail(r->file, line,
                        "%s: range from %g to %g um, expected to rise and to "
                        "be more than 0",
                        type, nm[0] / 1000, nm[1] / 1000);
    f->lo_nm = nm[0];
    f->hi_nm = nm[1];
    return count == 2;
}

static bool read_formula(struct reader *r, const struct item *item, int number)
{
    struct ior_page *page = r->file->page;
    struct ior_dispersion f = { .number = number };
    const char *type = item->type.text;
    if (page->n.rows || page->formula.number)
        return ior_fail(r->file, item->line, "%s: there is n already", type);
    if (!item->parts[COEFFICIENTS].text)
        return ior_fail(r->file, item->line, "%s has no coefficients", type);
    const int count =
        read_numbers(r, item, COEFFICIENTS, 0, ior_formula_room(number), f.c);
    if (count == 0)
        return ior_fail(r->file, item->line, "%s has no coefficients", type);
    if (count < 0 || !read_range(r, item, &f))
        return false;
    f.count = (size_t)count;
    if (!ior_formula_whole(number, f.count))
        ior_warn(page,
                 "%s: its %zu coefficients end inside a term; those missing "
                 "are taken as 0",
                 type, f.count);
    page->formula = f;
    return true;
}

/* The N of "formula N" where there is such a formula; or else 0. */
static int formula_number(const char *type)
{
    static const char word[] = "formula ";
    const size_t length = sizeof word - 1;
    if (strncmp(type, word, length) != 0 || strlen(type) != length + 1 ||
        !ior_is_digit(type[length]))
        return 0;
    const int number = type[length] - '0';
    return ior_formula_room(number) ? number : 0;
}

static bool use_item(struct reader *r, const struct item *item)
{
    const char *type = item->type.text;
    const struct ior_lines *data = &item->parts[DATA];
    if (!*type)
        return ior_fail(r->file, item->line, "an item of DATA has no type");
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(type, kinds[i].type) == 0)
            return data->text
                       ? ior_read_rows(r->file, &kinds[i], data)
                       : ior_fail(r->file, item->line, "%s has no data", type);
    const int number = formula_number(type);
    if (number)
        return read_formula(r, item, number);
    if (strcmp(type, "tabulated n2") != 0 && !r->other_line) {
        r->other = item->type;
        r->other_line = item->line;
    }
    return true;
}

/* -- the page -------------------------------------------------------------- */

static bool read_data(struct reader *r)
{
    if (r->event.type != YAML_SEQUENCE_START_EVENT)
        return ior_fail(r->file, line_of(r), "DATA is not a list");
    for (;;) {
        if (!next(r))
            return false;
        if (r->event.type == YAML_SEQUENCE_END_EVENT)
            return true;
        if (r->event.type != YAML_MAPPING_START_EVENT)
            return ior_fail(
                r->file, line_of(r),
                "an item of DATA is no mapping with a type and data");
        struct item item = { .line = line_of(r) };
        bool good = next(r);
        while (good && r->event.type != YAML_MAPPING_END_EVENT)
            good = read_item_key(r, &item) && next(r);
        good = good && use_item(r, &item);
        for (int i = 0; i < PARTS; i++)
            free(item.parts[i].text);
        if (!good)
            return false;
    }
}

/* A key and its value, of the mapping that the file is. */
static bool read_key(struct reader *r, bool *had_data)
{
    const bool data = text_is(r, "DATA");
    char **text = text_is(r, "REFERENCES") ? &r->file->page->reference
                  : text_is(r, "COMMENTS") ? &r->file->page->comments
                                           : NULL;
    if (data && *had_data)
        return ior_fail(r->file, line_of(r), "a second DATA");
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
        return ior_fail(r->file, 0, "nothing in it");
    if (!next(r))
        return false;
    if (r->event.type != YAML_MAPPING_START_EVENT)
        return ior_fail(r->file, line_of(r),
                        "expected a mapping with DATA in it");
    if (!next(r))
        return false;
    while (r->event.type != YAML_MAPPING_END_EVENT)
        if (!read_key(r, &had_data) || !next(r))
            return false;
    if (!next(r) || !next(r)) /* ends of document and stream */
        return false;
    if (r->event.type != YAML_STREAM_END_EVENT)
        return ior_fail(r->file, line_of(r), "a second document in one file");
    return had_data || ior_fail(r->file, 0, "no DATA in it");
}

/* Whether there is n at all. */
static bool finish(struct reader *r)
{
    struct ior_page *page = r->file->page;
    const bool has_n = page->n.rows || page->formula.number;
    if (!has_n && r->other_line)
        return ior_fail(r->file, r->other_line,
                        "unknown type \"%s\", expected tabulated nk, n or k, "
                        "or formula 1 to 9",
                        r->other.text);
    if (!has_n)
        return ior_fail(r->file, 0,
                        "no n in DATA, expected tabulated nk or n, or a "
                        "formula");
    if (r->other_line)
        ior_warn(page, "unknown type \"%s\" in DATA is ignored", r->other.text);
    return true;
}

bool ior_read_yaml(struct ior_source *file)
{
    struct reader r = { .file = file };
    /* libyaml compares each of these with all before it: 80,000 take 26 s. */
    if (memmem(file->bytes, file->size, "%TAG", 4))
        return ior_fail(file, 0, "%%TAG in it, which no page has use for");
    if (!yaml_parser_initialize(&r.parser))
        return ior_out_of_memory(file);
    yaml_parser_set_encoding(&r.parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&r.parser, (const unsigned char *)file->bytes,
                                 file->size);
    file->page->of_database = true;
    const bool good = read_file(&r) && finish(&r);
    yaml_event_delete(&r.event);
    yaml_parser_delete(&r.parser);
    return good;
}
