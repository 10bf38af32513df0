/* xml.c - XML files, opened with bounds, and places in them
 *
 * The parser gets the text in memory.  Its own limits are off, as they would
 * stop a mesh at ten million characters; what they are there for cannot happen
 * without entities.
 */
#include "integrator/xml.h"

#include <errno.h>
#include <libxml/hash.h>
#include <libxml/parser.h>
#include <limits.h>
#include <lzma.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "bsdf/utf8.h"

static const size_t times = 32, at_least = 1 << 16; /* unpacked over packed */
static const uint64_t lzma_memory = 96 << 20;       /* xz -9 takes 65 MiB */

char *xml_read_file(const char *path, size_t *size, struct err *err)
{
    FILE *f = fopen(path, "rb");
    struct stat about;
    char *text = NULL;
    if (!f || fstat(fileno(f), &about) != 0) {
        err_set(err, "%s: %s", path, strerror(errno));
        goto fail;
    }
    if (!S_ISREG(about.st_mode) || about.st_size >= INT_MAX) {
        err_set(err, "%s: expected a file of less than 2 GiB", path);
        goto fail;
    }
    *size = (size_t)about.st_size;
    text = malloc(*size + 1);
    if (!text) {
        err_set(err, "%s: out of memory for %zu bytes", path, *size);
        goto fail;
    }
    if (fread(text, 1, *size, f) != *size) {
        err_set(err, "%s: it cannot be read, or becomes shorter", path);
        goto fail;
    }
    text[*size] = '\0';
    fclose(f);
    return text;
fail:
    free(text);
    if (f)
        fclose(f);
    return NULL;
}

static const char *lzma_reason(lzma_ret r)
{
    switch (r) {
    case LZMA_BUF_ERROR:
        return "it is cut off";
    case LZMA_MEM_ERROR:
        return "out of memory";
    case LZMA_MEMLIMIT_ERROR:
        return "it takes more than 96 MiB to unpack";
    case LZMA_FORMAT_ERROR:
        return "it is not packed by xz";
    default:
        return "it is damaged";
    }
}

/* Replaces what is packed by what it holds. */
static bool unpack(char **text, size_t *size, const char *path, struct err *err)
{
    const size_t limit = times * *size > at_least ? times * *size : at_least;
    size_t room = 4 * *size + 4096 < limit ? 4 * *size + 4096 : limit;
    lzma_stream z = LZMA_STREAM_INIT;
    char *out = malloc(room + 1);
    bool ok = false;
    lzma_ret r = out ? lzma_stream_decoder(&z, lzma_memory, LZMA_CONCATENATED)
                     : LZMA_MEM_ERROR;
    z.next_in = (const uint8_t *)*text;
    z.avail_in = *size;
    z.next_out = (uint8_t *)out;
    z.avail_out = room;
    while (r == LZMA_OK) {
        r = lzma_code(&z, LZMA_FINISH);
        if (r != LZMA_OK || z.avail_out > 0)
            continue;
        if (room >= limit)
            break;
        const size_t more = 2 * room < limit ? 2 * room : limit;
        char *larger = realloc(out, more + 1);
        if (!larger) {
            r = LZMA_MEM_ERROR;
            break;
        }
        out = larger;
        z.next_out = (uint8_t *)out + room;
        z.avail_out = more - room;
        room = more;
    }
    if (r == LZMA_OK) {
        err_set(err,
                "%s: it unpacks to more than %zu bytes, %zu times its size",
                path, limit, times);
    } else if (r != LZMA_STREAM_END) {
        err_set(err, "%s: %s", path, lzma_reason(r));
    } else {
        ok = true;
        free(*text);
        *text = out;
        *size = room - z.avail_out;
        out[*size] = '\0';
    }
    lzma_end(&z);
    if (!ok)
        free(out);
    return ok;
}

/* Instead of taking a document type definition. */
static void refuse(void *context, const xmlChar *name, const xmlChar *external,
                   const xmlChar *system)
{
    xmlParserCtxt *parser = context;
    (void)name, (void)external, (void)system;
    *(int *)parser->_private = parser->input ? parser->input->line : 1;
    xmlStopParser(parser);
}

/* What the parser says, in one line without its own full stop. */
static void parser_error(const xmlParserCtxt *parser, const char *path,
                         int refused, struct err *err)
{
    const xmlError *e = &parser->lastError;
    char *plain = utf8_plain(e->message ? e->message : "");
    if (refused)
        err_set(err,
                "%s:%d: <!DOCTYPE: document types and entities are not taken",
                path, refused);
    else if (plain && e->message) {
        size_t n = strlen(plain);
        if (n >= 4 && strcmp(plain + n - 4, "\\x0a") == 0)
            plain[n - 4] = '\0';
        err_set(err, "%s:%d: %.300s", path, e->line, plain);
    } else
        err_set(err, "%s: it is no XML", path);
    free(plain);
}

/* Without recursion, as it may be deep. */
static bool depth_check(const struct xml *x, struct err *err)
{
    int depth = 0;
    for (const xmlNode *n = xmlDocGetRootElement(x->doc); n;) {
        if (depth > XML_DEPTH_MAX)
            return xml_fail(n, err, "elements nest more than %d deep",
                            XML_DEPTH_MAX);
        if (n->type == XML_ELEMENT_NODE && n->children) {
            n = n->children;
            depth++;
            continue;
        }
        while (n && !n->next) {
            n = n->parent;
            if (--depth <= 0)
                return true;
        }
        n = n ? n->next : NULL;
    }
    return true;
}

bool xml_open(struct xml *x, const char *path, struct err *err)
{
    static const char magic[] = "\xfd"
                                "7zXZ";
    *x = (struct xml){ .path = path };
    char *text = xml_read_file(path, &x->bytes, err);
    xmlParserCtxt *parser = NULL;
    int refused = 0;
    if (!text)
        return false;
    if (x->bytes >= 6 && memcmp(text, magic, 6) == 0 &&
        !unpack(&text, &x->bytes, path, err))
        goto done;
    parser = xmlNewParserCtxt();
    if (!parser || x->bytes > INT_MAX) {
        err_set(err, "%s: out of memory for %zu bytes", path, x->bytes);
        goto done;
    }
    parser->_private = &refused;
    parser->sax->internalSubset = refuse;
    x->doc = xmlCtxtReadMemory(parser, text, (int)x->bytes, NULL, NULL,
                               XML_PARSE_NONET | XML_PARSE_BIG_LINES |
                                   XML_PARSE_HUGE | XML_PARSE_NOERROR |
                                   XML_PARSE_NOWARNING | XML_PARSE_COMPACT);
    if (!x->doc || refused) {
        parser_error(parser, path, refused, err);
        xml_close(x);
        goto done;
    }
    x->doc->_private = (void *)path;
    if (!depth_check(x, err))
        xml_close(x);
done:
    xmlFreeParserCtxt(parser);
    free(text);
    return x->doc;
}

void xml_close(struct xml *x)
{
    xmlFreeDoc(x->doc);
    x->doc = NULL;
}

bool xml_fail(const xmlNode *node, struct err *err, const char *format, ...)
{
    struct err what;
    va_list args;
    va_start(args, format);
    vsnprintf(what.text, sizeof what.text, format, args);
    va_end(args);
    const char *id = xml_get(node, "id");
    if (!id)
        id = xml_get(node, "name");
    char *plain = utf8_plain(id ? id : "");
    err_set(err, "%s:%ld: <%s%s%.100s%s>: %s",
            (const char *)node->doc->_private, xmlGetLineNo(node), node->name,
            id ? " \"" : "", plain ? plain : "", id ? "\"" : "", what.text);
    free(plain);
    return false;
}

const char *xml_get(const xmlNode *node, const char *attribute)
{
    for (const xmlAttr *a = node->properties; a; a = a->next)
        if (strcmp((const char *)a->name, attribute) == 0)
            return a->children && a->children->content
                       ? (const char *)a->children->content
                       : "";
    return NULL;
}

bool xml_is(const xmlNode *node, const char *name)
{
    return strcmp((const char *)node->name, name) == 0;
}

static xmlNode *element(xmlNode *n)
{
    while (n && n->type != XML_ELEMENT_NODE)
        n = n->next;
    return n;
}

xmlNode *xml_first(const xmlNode *node)
{
    return element(node->children);
}

xmlNode *xml_next(const xmlNode *node)
{
    return element(node->next);
}

xmlNode *xml_child(const xmlNode *node, const char *name)
{
    for (xmlNode *n = xml_first(node); n; n = xml_next(n))
        if (xml_is(n, name))
            return n;
    return NULL;
}

bool xml_numbers(const xmlNode *node, struct xml_numbers *n, struct err *err)
{
    const xmlNode *text = node->children;
    *n = (struct xml_numbers){ .node = node, .text = "" };
    if (!text)
        return true;
    if (text->next || text->type != XML_TEXT_NODE)
        return xml_fail(node, err, "expected numbers and nothing else");
    n->text = (const char *)text->content;
    return true;
}

static bool separates(const struct xml_numbers *n, char c)
{
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' ||
           (n->commas && c == ',');
}

bool xml_numbers_end(struct xml_numbers *n)
{
    while (separates(n, *n->text))
        n->text++;
    return *n->text == '\0';
}

static bool no_number(const struct xml_numbers *n, const char *expected,
                      struct err *err)
{
    size_t length = 0;
    while (length < 40 && n->text[length] && !separates(n, n->text[length]))
        length++;
    char *word = strndup(n->text, length);
    char *plain = word ? utf8_plain(word) : NULL;
    if (length == 0)
        xml_fail(n->node, err, "expected %s after %zu numbers", expected,
                 n->count);
    else
        xml_fail(n->node, err, "number %zu is \"%s\": expected %s",
                 n->count + 1, plain ? plain : "", expected);
    free(plain);
    free(word);
    return false;
}

bool xml_real(struct xml_numbers *n, double *value, struct err *err)
{
    char *end = NULL;
    if (!xml_numbers_end(n)) {
        *value = strtod(n->text, &end);
        if (end != n->text && isfinite(*value) &&
            (*end == '\0' || separates(n, *end))) {
            n->text = end;
            n->count++;
            return true;
        }
    }
    return no_number(n, "a finite number", err);
}

bool xml_count(struct xml_numbers *n, unsigned *value, struct err *err)
{
    const char *at = NULL;
    uint64_t read = 0;
    if (!xml_numbers_end(n))
        for (at = n->text; *at >= '0' && *at <= '9' && read <= INT_MAX; at++)
            read = 10 * read + (uint64_t)(*at - '0');
    if (!at || at == n->text || read > INT_MAX ||
        (*at != '\0' && !separates(n, *at)))
        return no_number(n, "a whole number from 0", err);
    n->text = at;
    n->count++;
    *value = (unsigned)read;
    return true;
}

bool xml_reals(struct xml_numbers *n, double *value, size_t count,
               struct err *err)
{
    for (size_t i = 0; i < count; i++) {
        if (xml_numbers_end(n))
            return xml_fail(n->node, err, "it has %zu numbers: expected %zu",
                            n->count, count);
        if (!xml_real(n, &value[i], err))
            return false;
    }
    size_t more = 0;
    for (; !xml_numbers_end(n); more++)
        while (*n->text && !separates(n, *n->text))
            n->text++;
    if (more)
        return xml_fail(n->node, err, "it has %zu numbers: expected %zu",
                        n->count + more, count);
    return true;
}

static bool ids_add(xmlHashTable *ids, xmlNode *node, struct err *err)
{
    for (xmlNode *n = node; n; n = xml_next(n)) {
        /* Mitsuba's <ref> has another's. */
        const char *id = xml_is(n, "ref") ? NULL : xml_get(n, "id");
        if (id && xmlHashAddEntry(ids, (const xmlChar *)id, n) != 0) {
            const xmlNode *other = xmlHashLookup(ids, (const xmlChar *)id);
            return xml_fail(n, err, "the id is taken by <%s> in line %ld",
                            other ? (const char *)other->name : "?",
                            other ? xmlGetLineNo(other) : 0);
        }
        xmlNode *below = xml_first(n);
        if (below && !ids_add(ids, below, err))
            return false;
    }
    return true;
}

struct _xmlHashTable *xml_ids(const struct xml *x, struct err *err)
{
    xmlHashTable *ids = xmlHashCreate(64);
    if (!ids) {
        err_set(err, "%s: out of memory", x->path);
        return NULL;
    }
    if (ids_add(ids, xmlDocGetRootElement(x->doc), err))
        return ids;
    xmlHashFree(ids, NULL);
    return NULL;
}
