/* mitsuba_substitute.c - $name in scenes
 *
 * <default name="x" value="1"/> gives what "$x" stands for where the command
 * line does not; a default serves what comes behind it.
 */
#include <libxml/hash.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "integrator/mitsuba.h"

enum { VALUE_MAX = 1024, NAME_MAX_LENGTH = 64 };

struct table {
    struct loader *l;
    xmlHashTable *value; /* char * by name, owned */
    struct err *err;
};

static bool put(struct table *t, const char *name, const char *value)
{
    char *copy = strdup(value);
    if (copy && xmlHashAddEntry(t->value, (const xmlChar *)name, copy) == 0)
        return true;
    free(copy);
    return false;
}

static size_t name_length(const char *text)
{
    return strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                        "0123456789_");
}

/* Writes the text with what $name stands for. */
static bool expand(struct table *t, const xmlNode *node, const char *text,
                   char out[VALUE_MAX])
{
    size_t used = 0;
    for (const char *at = text; *at;) {
        char name[NAME_MAX_LENGTH];
        const size_t n = *at == '$' ? name_length(at + 1) : 0;
        const char *from = at;
        size_t length = 1;
        if (*at == '$') {
            snprintf(name, sizeof name, "%.*s", (int)n, at + 1);
            from = n && n < sizeof name
                       ? xmlHashLookup(t->value, (const xmlChar *)name)
                       : NULL;
            if (!from)
                return xml_fail(node, t->err,
                                "\"$%.*s\" has no <default> before it, and no "
                                "-D NAME=VALUE",
                                (int)(n < 60 ? n : 60), at + 1);
            length = strlen(from);
        }
        if (used + length >= VALUE_MAX)
            return xml_fail(node, t->err,
                            "a value of more than %d characters after $name is "
                            "replaced",
                            VALUE_MAX - 1);
        memcpy(out + used, from, length);
        used += length;
        at += n + 1;
    }
    out[used] = '\0';
    return true;
}

static bool attributes(struct table *t, xmlNode *node)
{
    for (xmlAttr *a = node->properties; a; a = a->next) {
        char value[VALUE_MAX];
        const char *text = a->children && a->children->content
                               ? (const char *)a->children->content
                               : "";
        if (!strchr(text, '$'))
            continue;
        if (!expand(t, node, text, value))
            return false;
        if (!value[0])
            return xml_fail(node, t->err, "%.60s=\"%.60s\": it is empty",
                            (const char *)a->name, text);
        xmlNodeSetContent(a->children, NULL);
        xmlNodeAddContent(a->children, (const xmlChar *)value);
        if (!a->children->content)
            return xml_fail(node, t->err, "out of memory");
    }
    return true;
}

static bool walk(struct table *t, xmlNode *first)
{
    for (xmlNode *n = first; n; n = xml_next(n)) {
        if (!attributes(t, n))
            return false;
        if (xml_is(n, "default")) {
            const char *name = xml_get(n, "name"), *value = xml_get(n, "value");
            if (!name || !value || name_length(name) != strlen(name) ||
                !name[0] || strlen(name) >= NAME_MAX_LENGTH)
                return xml_fail(n, t->err,
                                "expected a name of letters, digits and _, and "
                                "a value");
            put(t, name, value); /* unless it is there */
        }
        if (!walk(t, xml_first(n)))
            return false;
    }
    return true;
}

/* What the command line defines must be of use. */
static bool wanted(struct table *t, const char *name)
{
    const char *words[65] = { NULL };
    int n = 0;
    for (const xmlNode *d = xml_first(xmlDocGetRootElement(t->l->xml.doc)); d;
         d = xml_next(d))
        if (xml_is(d, "default") && xml_get(d, "name") && n < 64) {
            words[n++] = xml_get(d, "name");
            if (strcmp(words[n - 1], name) == 0)
                return true;
        }
    char what[160];
    snprintf(what, sizeof what, "%.120s: -D", t->l->xml.path);
    return err_unknown(t->err, what, name, words);
}

static bool defines(struct table *t)
{
    const struct load_options *o = t->l->options;
    for (int i = 0; i < o->defines; i++) {
        char name[NAME_MAX_LENGTH];
        const size_t n = name_length(o->define[i]);
        if (n == 0 || n >= sizeof name || o->define[i][n] != '=')
            return err_set(t->err, "-D %.60s: expected NAME=VALUE",
                           o->define[i]);
        snprintf(name, sizeof name, "%.*s", (int)n, o->define[i]);
        if (!wanted(t, name))
            return false;
        if (!put(t, name, o->define[i] + n + 1))
            return err_set(t->err, "-D %.60s: %s is defined twice",
                           o->define[i], name);
    }
    return true;
}

static void free_value(void *value, const xmlChar *name)
{
    (void)name;
    free(value);
}

bool mitsuba_substitute(struct loader *l, struct err *err)
{
    struct table t = { l, xmlHashCreate(32), err };
    if (!t.value)
        return err_set(err, "%s: out of memory", l->xml.path);
    const bool ok = defines(&t) && walk(&t, xmlDocGetRootElement(l->xml.doc));
    xmlHashFree(t.value, free_value);
    return ok;
}
