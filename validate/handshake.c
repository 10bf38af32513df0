/* handshake.c - lines of key and value */
#include "validate/handshake.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/cli.h"
#include "validate/protocol.h"

size_t handshake_ask(const struct bands *bands, char text[HANDSHAKE_MAX])
{
    int n = snprintf(text, HANDSHAKE_MAX, "bsdf %d\nbands %d", PROTOCOL_VERSION,
                     bands->count);
    for (int b = 0; b < bands->count; b++)
        if (bands->kind == BANDS_NM)
            n += snprintf(text + n, HANDSHAKE_MAX - (size_t)n, " %.17g",
                          bands->nm[b]);
        else
            n += snprintf(text + n, HANDSHAKE_MAX - (size_t)n, " %c", "RGB"[b]);
    n += snprintf(text + n, HANDSHAKE_MAX - (size_t)n, "\n\n");
    return (size_t)n;
}

/* The end of the line at `at`, or NULL where it is not there yet. */
static const char *line_end(const char *at, const char *end)
{
    return memchr(at, '\n', (size_t)(end - at));
}

static bool line_empty(const char *at, const char *end)
{
    return end == at || (end == at + 1 && *at == '\r');
}

bool handshake_whole(const char *answer, size_t n)
{
    const char *at = answer, *const end = answer + n;
    for (int lines = 0; lines < PROTOCOL_LINES; lines++) {
        const char *stop = line_end(at, end);
        if (!stop)
            return end - at >= PROTOCOL_LINE;
        if (line_empty(at, stop))
            return true;
        at = stop + 1;
    }
    return true;
}

/* A line of the answer, in its own memory: key, and value or "". */
struct line {
    char text[PROTOCOL_LINE];
    const char *key, *value;
};

static void line_split(struct line *l)
{
    size_t n = strlen(l->text);
    while (n > 0 && isspace((unsigned char)l->text[n - 1]))
        l->text[--n] = '\0';
    char *gap = l->text + strcspn(l->text, " \t");
    l->key = l->text;
    l->value = gap + strspn(gap, " \t");
    *gap = '\0';
}

static bool lobes_read(unsigned *lobes, const char *value, struct err *err)
{
    static const char *const words[] = {
        "diffuse_reflection",
        "glossy_reflection",
        "delta_reflection",
        "diffuse_transmission",
        "glossy_transmission",
        "delta_transmission",
        NULL /* in the order of enum bsdf_lobes */
    };
    *lobes = 0;
    while (*value) {
        char word[64];
        size_t n = strcspn(value, " \t");
        snprintf(word, sizeof word, "%.*s", (int)(n < 63 ? n : 63), value);
        int i = 0;
        while (words[i] && strcmp(words[i], word) != 0)
            i++;
        if (!words[i])
            return err_unknown(err, "lobe", word, words);
        *lobes |= 1u << i;
        value += n;
        value += strspn(value, " \t");
    }
    return *lobes || err_set(err, "lobes: expected at least one");
}

/* Keys with two words to choose from have the field that takes whether it is
 * the second. */
static const struct entry {
    const char *key;
    const char *words[2];
    size_t field;
} entries[] = {
    { "bsdf", { NULL }, 0 },
    { "format", { "binary", "text" }, offsetof(struct handshake, text) },
    { "name", { NULL }, 0 },
    { "lobes", { NULL }, 0 },
    { "lossless",
      { "no", "yes" },
      offsetof(struct handshake, claims.lossless) },
    { "reciprocal",
      { "no", "yes" },
      offsetof(struct handshake, claims.reciprocal) },
    { "two_sided",
      { "no", "yes" },
      offsetof(struct handshake, claims.two_sided) },
    { "eta", { NULL }, 0 },
    { "precision", { "double", "float" }, offsetof(struct handshake, single) },
    { "cosine",
      { "excluded", "included" },
      offsetof(struct handshake, cosine_included) },
    { "given", { "wo", "wi" }, offsetof(struct handshake, given_wi) },
    { "parameter", { NULL }, 0 },
};
enum { ENTRIES = sizeof entries / sizeof *entries };

static bool entry_read(struct handshake *h, const struct entry *e,
                       const char *value, struct err *err)
{
    if (strcmp(e->key, "lobes") == 0)
        return lobes_read(&h->claims.lobes, value, err);
    if (strcmp(e->key, "eta") == 0)
        return cli_number(&h->claims.eta, "eta", value, 0.01, 100, err);
    if (!e->words[0])
        return true; /* for people */
    const char *const words[] = { e->words[0], e->words[1], NULL };
    bool *second = (bool *)((char *)h + e->field);
    *second = strcmp(value, words[1]) == 0;
    return *second || strcmp(value, words[0]) == 0 ||
           err_unknown(err, e->key, value, words);
}

static bool first_read(const struct line *l, struct err *err)
{
    char ours[16];
    snprintf(ours, sizeof ours, "%d", PROTOCOL_VERSION);
    if (strcmp(l->key, "bsdf") != 0)
        return err_set(err,
                       "expected \"bsdf %d\" as the first line of the answer, "
                       "got \"%.60s%s%.60s\"",
                       PROTOCOL_VERSION, l->key, *l->value ? " " : "",
                       l->value);
    return strcmp(l->value, ours) == 0 ||
           err_set(err,
                   "the adapter speaks version %.20s of the protocol, this "
                   "toolkit version %d",
                   l->value, PROTOCOL_VERSION);
}

static bool line_read(struct handshake *h, const struct line *l, bool *given,
                      struct err *err)
{
    const char *keys[ENTRIES + 1] = { NULL };
    int i = 0;
    for (; i < ENTRIES; i++) {
        keys[i] = entries[i].key;
        if (strcmp(keys[i], l->key) == 0)
            break;
    }
    if (i == ENTRIES)
        return err_unknown(err, "key", l->key, keys);
    if (given[i] && strcmp(l->key, "parameter") != 0)
        return err_set(err, "%s is said twice", l->key);
    given[i] = true;
    return entry_read(h, &entries[i], l->value, err);
}

bool handshake_read(struct handshake *h, const char *answer, size_t n,
                    struct err *err)
{
    const char *at = answer, *const end = answer + n;
    bool given[ENTRIES] = { true }; /* the first line is */
    struct line l;
    *h = (struct handshake){ .claims = { .reciprocal = true, .eta = 1 } };
    for (int lines = 0;; lines++) {
        const char *stop = line_end(at, end);
        if (lines == PROTOCOL_LINES || !stop || stop - at >= PROTOCOL_LINE)
            return err_set(err,
                           "expected at most %d lines of %d bytes, an empty "
                           "one last, got \"%.*s...\"",
                           PROTOCOL_LINES, PROTOCOL_LINE,
                           (int)(end - at < 40 ? end - at : 40), at);
        if (line_empty(at, stop) && lines > 0) {
            at = stop + 1;
            break;
        }
        snprintf(l.text, sizeof l.text, "%.*s", (int)(stop - at), at);
        line_split(&l);
        if (strcmp(l.key, "error") == 0)
            return err_set(err, "%s", l.value);
        if (!(lines == 0 ? first_read(&l, err) : line_read(h, &l, given, err)))
            return false;
        at = stop + 1;
    }
    if (at != end)
        return err_set(err,
                       "%zu bytes behind the empty line that nobody "
                       "asked for",
                       (size_t)(end - at));
    if (h->single)
        h->claims.epsilon = 0x1p-23;
    return h->claims.lobes ||
           err_set(err, "the adapter did not say its lobes, as in \"lobes "
                        "diffuse_reflection\"");
}
