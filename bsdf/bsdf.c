/* bsdf.c - from a spec to an instance, and calls into the model
 *
 * A spec is read once, here; the models contain no parsing.
 */
#include "bsdf/bsdf.h"

#include <assert.h>
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct bsdf {
    const struct bsdf_type *type;
    struct bands bands;
    char *spec;
    void *state;
};

enum { NAME_MAX_LENGTH = 64, VALUE_MAX_LENGTH = 4096, WORDS_MAX = 64 };
enum { DEPTH_MAX = 16 };

/* One key=value, unquoted. */
struct setting {
    char key[NAME_MAX_LENGTH];
    char value[VALUE_MAX_LENGTH];
};

static bool name_char(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

/* A value in quotes, the quotes taken off. */
static bool quoted_read(const char **at, char *value, const char *spec,
                        struct err *err)
{
    size_t n = 0;
    for (const char *p = *at + 1; n + 1 < VALUE_MAX_LENGTH; p++) {
        if (*p == '\0')
            return err_set(err,
                           "\"%.200s\": the quote at \"%.40s\" is never "
                           "closed",
                           spec, *at);
        if (*p == '\'' && *++p != '\'') {
            *at = p;
            value[n] = '\0';
            return true;
        }
        value[n++] = *p;
    }
    return err_set(err, "\"%.40s...\": a value is longer than %d characters",
                   spec, VALUE_MAX_LENGTH - 1);
}

/* How long a value without quotes is: to the next comma outside parentheses
 * and outside the quotes in them. */
static bool plain_length(const char *at, size_t *length, const char *spec,
                         struct err *err)
{
    int depth = 0;
    bool quoted = false;
    size_t n = 0;
    for (; at[n] && (depth > 0 || at[n] != ','); n++) {
        quoted ^= depth > 0 && at[n] == '\'';
        if (!quoted && at[n] == '(' && ++depth > DEPTH_MAX)
            return err_set(err,
                           "\"%.40s...\": parentheses are more than %d deep",
                           spec, DEPTH_MAX);
        if (!quoted && at[n] == ')' && --depth < 0)
            break;
    }
    *length = n;
    if (depth != 0)
        return err_set(err, "\"%.200s\": %s at \"%.40s\"", spec,
                       depth < 0 ? "a parenthesis that was not opened"
                                 : "a parenthesis that is never closed",
                       at);
    return n < VALUE_MAX_LENGTH ||
           err_set(err, "\"%.40s...\": a value is longer than %d characters",
                   spec, VALUE_MAX_LENGTH - 1);
}

static bool value_text(const char **at, char *value, const char *spec,
                       struct err *err)
{
    size_t length = 0;
    if (**at == '\'')
        return quoted_read(at, value, spec, err);
    if (!plain_length(*at, &length, spec, err))
        return false;
    memcpy(value, *at, length);
    value[length] = '\0';
    *at += length;
    return true;
}

/* Reads one setting and the comma behind it. */
static bool setting_read(const char **at, struct setting *s, const char *spec,
                         struct err *err)
{
    size_t n = 0;
    const char *p = *at;
    while (name_char(p[n]))
        n++;
    if (n == 0 || n >= sizeof s->key || p[n] != '=')
        return err_set(err, "\"%.200s\": expected key=value at \"%.40s\"", spec,
                       p);
    memcpy(s->key, p, n);
    s->key[n] = '\0';
    *at = p + n + 1;
    if (!value_text(at, s->value, spec, err))
        return false;
    if (**at != ',' && **at != '\0')
        return err_set(err,
                       "\"%.200s\": expected a comma or the end at "
                       "\"%.40s\"",
                       spec, *at);
    if (**at == ',' && *++*at == '\0')
        return err_set(err,
                       "\"%.200s\": expected key=value after the last "
                       "comma",
                       spec);
    return true;
}

static bool number_read(const struct bsdf_type *type,
                        const struct bsdf_param *p, const char *text,
                        size_t length, double *value, struct err *err)
{
    char copy[64], *end = copy;
    if (length < sizeof copy) {
        memcpy(copy, text, length);
        copy[length] = '\0';
        if (!isspace((unsigned char)copy[0]))
            *value = strtod(copy, &end);
    }
    if (length == 0 || length >= sizeof copy || end != copy + length)
        return err_set(err, "%s: %s=%.60s: expected a number at \"%.60s\"",
                       type->name, p->key, text, text);
    if (!(*value >= p->min && *value <= p->max)) /* a NaN fails too */
        return err_set(err, "%s: %s = %g is outside [%g, %g]", type->name,
                       p->key, *value, p->min, p->max);
    return true;
}

static bool spectrum_read(const struct bsdf_type *type,
                          const struct bsdf_param *p, const char *text,
                          int count, struct spectrum *s, struct err *err)
{
    int n = 0;
    struct spectrum read = { { 0 } };
    for (const char *at = text;;) {
        const size_t length = strcspn(at, "/");
        double value;
        if (!number_read(type, p, at, length, &value, err))
            return false;
        if (n < BANDS_MAX)
            read.band[n] = value;
        n++;
        at += length;
        if (*at++ == '\0')
            break;
    }
    if (n != 1 && n != count)
        return err_set(err,
                       "%s: %s=%.60s has %d values; expected one, or one "
                       "for each of the %d bands",
                       type->name, p->key, text, n, count);
    *s = n == 1 ? spectrum_of(count, read.band[0]) : read;
    return true;
}

static bool word_read(const struct bsdf_type *type, const struct bsdf_param *p,
                      const char *const words[], const char *text, int *index,
                      struct err *err)
{
    for (*index = 0; words[*index]; ++*index)
        if (strcmp(words[*index], text) == 0)
            return true;
    char what[160];
    snprintf(what, sizeof what, "%s: %s", type->name, p->key);
    return err_unknown(err, what, text, words);
}

/* The spec in a pair of parentheses. */
static bool nested_read(const struct bsdf_type *type,
                        const struct bsdf_param *p, const char *text,
                        const struct bands *bands, struct bsdf **nested,
                        struct err *err)
{
    const size_t length = strlen(text);
    struct err why;
    if (length < 2 || text[0] != '(' || text[length - 1] != ')')
        return err_set(err,
                       "%s: %s=%.60s: expected a model in parentheses, "
                       "as in %s=(diffuse)",
                       type->name, p->key, text, p->key);
    char *spec = strndup(text + 1, length - 2);
    if (!spec)
        return err_set(err, "out of memory");
    *nested = bsdf_new(spec, bands, &why);
    free(spec);
    if (!*nested || why.text[0])
        err_set(err, "%s: %s: %s", type->name, p->key, why.text);
    return *nested;
}

static bool value_read(const struct bsdf_type *type, const struct bsdf_param *p,
                       const char *text, const struct bands *bands, void *field,
                       struct err *err)
{
    static const char *const flag[] = { "false", "true", NULL };
    switch (p->kind) {
    case BSDF_NUMBER:
        return number_read(type, p, text, strlen(text), field, err);
    case BSDF_SPECTRUM:
        return spectrum_read(type, p, text, bands->count, field, err);
    case BSDF_CHOICE:
        return word_read(type, p, p->choices, text, field, err);
    case BSDF_FLAG:
        return word_read(type, p, flag, text, field, err);
    case BSDF_STRING:
        free(*(char **)field);
        *(char **)field = strdup(text);
        return *(char **)field || err_set(err, "out of memory");
    case BSDF_NESTED:
        return nested_read(type, p, text, bands, field, err);
    }
    return false;
}

static void value_unset(const struct bsdf_param *p, void *field)
{
    switch (p->kind) {
    case BSDF_NUMBER:
        *(double *)field = NAN;
        break;
    case BSDF_SPECTRUM:
        *(struct spectrum *)field = spectrum_of(BANDS_MAX, NAN);
        break;
    case BSDF_CHOICE:
    case BSDF_FLAG:
        *(int *)field = -1;
        break;
    case BSDF_STRING:
    case BSDF_NESTED:
        break; /* NULL already */
    }
}

static bool settings_read(struct bsdf *b, const char *settings, struct err *err)
{
    const struct bsdf_type *type = b->type;
    const char *keys[WORDS_MAX + 1] = { NULL };
    bool given[WORDS_MAX] = { false };
    int n = 0;
    for (const struct bsdf_param *p = type->params; p->key; p++) {
        void *field = (char *)b->state + p->offset;
        assert(n < WORDS_MAX);
        keys[n++] = p->key;
        value_unset(p, field);
        if (p->def && !value_read(type, p, p->def, &b->bands, field, err))
            return false;
    }
    struct setting *s = malloc(sizeof *s);
    if (!s)
        return err_set(err, "out of memory");
    bool ok = true;
    for (const char *at = settings; ok && *at;) {
        ok = setting_read(&at, s, b->spec, err);
        if (!ok)
            break;
        int i = 0;
        while (i < n && strcmp(keys[i], s->key) != 0)
            i++;
        if (i == n)
            ok = err_unknown(err, type->name, s->key, keys);
        else if (given[i])
            ok = err_set(err, "%s: %s is given twice", type->name, s->key);
        else
            ok = value_read(type, &type->params[i], s->value, &b->bands,
                            (char *)b->state + type->params[i].offset, err);
        if (ok)
            given[i] = true;
    }
    free(s);
    return ok && (!type->init || type->init(b->state, &b->bands, err));
}

/* With a state of zeros; NULL when out of memory. */
static struct bsdf *blank(const struct bsdf_type *type, const char *spec,
                          const struct bands *bands, struct err *err)
{
    if (err)
        err->text[0] = '\0';
    assert(bands->count >= 1 && bands->count <= BANDS_MAX);
    struct bsdf *b = calloc(1, sizeof *b);
    if (b) {
        b->type = type;
        b->bands = *bands;
        b->spec = strdup(spec);
        b->state = calloc(1, type->size ? type->size : 1);
        if (b->spec && b->state)
            return b;
        free(b->spec);
        free(b->state);
        free(b);
    }
    err_set(err, "out of memory");
    return NULL;
}

/* spec is what to remember, settings a part of it. */
static struct bsdf *make(const struct bsdf_type *type, const char *spec,
                         const char *settings, const struct bands *bands,
                         struct err *err)
{
    struct bsdf *b = blank(type, spec, bands, err);
    if (!b || settings_read(b, settings, err))
        return b;
    bsdf_free(b);
    return NULL;
}

struct bsdf *bsdf_new_around(const struct bsdf_type *type, const char *spec,
                             const void *state, const struct bands *bands,
                             struct err *err)
{
    struct bsdf *b = blank(type, spec, bands, err);
    if (b)
        memcpy(b->state, state, type->size);
    return b;
}

struct bsdf *bsdf_new(const char *spec, const struct bands *bands,
                      struct err *err)
{
    const char *names[WORDS_MAX + 1] = { NULL };
    char name[NAME_MAX_LENGTH];
    size_t n = 0;
    while (name_char(spec[n]))
        n++;
    if (n == 0 || n >= sizeof name || (spec[n] != ':' && spec[n] != '\0')) {
        err_set(err, "spec \"%.200s\": expected name or name:key=value,...",
                spec);
        return NULL;
    }
    memcpy(name, spec, n);
    name[n] = '\0';
    if (spec[n] == ':' && spec[n + 1] == '\0') {
        err_set(err, "spec \"%.200s\": expected key=value after the colon",
                spec);
        return NULL;
    }
    for (int i = 0; bsdf_types[i]; i++) {
        assert(i < WORDS_MAX);
        names[i] = bsdf_types[i]->name;
        if (strcmp(name, names[i]) == 0)
            return make(bsdf_types[i], spec, spec + n + (spec[n] == ':'), bands,
                        err);
    }
    err_unknown(err, "model", name, names);
    return NULL;
}

struct bsdf *bsdf_new_of(const struct bsdf_type *type, const char *settings,
                         const struct bands *bands, struct err *err)
{
    const size_t size = strlen(type->name) + strlen(settings) + 2;
    char *spec = malloc(size);
    if (!spec) {
        err_set(err, "out of memory");
        return NULL;
    }
    snprintf(spec, size, "%s%s%s", type->name, *settings ? ":" : "", settings);
    struct bsdf *b = make(type, spec, settings, bands, err);
    free(spec);
    return b;
}

void bsdf_free(struct bsdf *b)
{
    if (!b)
        return;
    if (b->state) {
        if (b->type->clear)
            b->type->clear(b->state);
        for (const struct bsdf_param *p = b->type->params; p->key; p++) {
            void *field = (char *)b->state + p->offset;
            if (p->kind == BSDF_STRING)
                free(*(char **)field);
            if (p->kind == BSDF_NESTED)
                bsdf_free(*(struct bsdf **)field);
        }
    }
    free(b->state);
    free(b->spec);
    free(b);
}

const struct bsdf_type *bsdf_type(const struct bsdf *b)
{
    return b->type;
}

const struct bands *bsdf_bands(const struct bsdf *b)
{
    return &b->bands;
}

const char *bsdf_spec(const struct bsdf *b)
{
    return b->spec;
}

struct bsdf_claims bsdf_claims(const struct bsdf *b)
{
    struct bsdf_claims claims = b->type->claims(b->state, &b->bands);
    if (claims.epsilon == 0)
        claims.epsilon = 0x1p-52;
    return claims;
}

struct spectrum bsdf_eval(const struct bsdf *b, struct vec3 wo, struct vec3 wi)
{
    return b->type->eval ? b->type->eval(b->state, wo, wi)
                         : (struct spectrum){ { 0 } };
}

double bsdf_pdf(const struct bsdf *b, struct vec3 wo, struct vec3 wi)
{
    return b->type->pdf ? b->type->pdf(b->state, wo, wi) : 0;
}

struct bsdf_sample bsdf_sample(const struct bsdf *b, struct vec3 wo,
                               struct vec3 u)
{
    return b->type->sample(b->state, wo, u);
}

void bsdf_eval_many(const struct bsdf *b, size_t n, struct dirs wo,
                    struct dirs wi, struct spectrum *f)
{
    if (b->type->eval_many) {
        b->type->eval_many(b->state, n, wo, wi, f);
        return;
    }
    for (size_t i = 0; i < n; i++)
        f[i] = bsdf_eval(b, dirs_at(wo, i), dirs_at(wi, i));
}

void bsdf_pdf_many(const struct bsdf *b, size_t n, struct dirs wo,
                   struct dirs wi, double *pdf)
{
    if (b->type->pdf_many) {
        b->type->pdf_many(b->state, n, wo, wi, pdf);
        return;
    }
    for (size_t i = 0; i < n; i++)
        pdf[i] = bsdf_pdf(b, dirs_at(wo, i), dirs_at(wi, i));
}

struct bsdf_samples bsdf_samples_from(const struct bsdf_samples *s, size_t i)
{
    struct bsdf_samples from = { s->x + i,   s->y + i, s->z + i,
                                 s->pdf + i, { NULL }, s->delta + i };
    for (int b = 0; b < BANDS_MAX; b++)
        from.weight[b] = s->weight[b] ? s->weight[b] + i : NULL;
    return from;
}

struct bsdf_sample bsdf_samples_at(const struct bsdf_samples *s, size_t i)
{
    struct bsdf_sample a = {
        { s->x[i], s->y[i], s->z[i] }, s->pdf[i], { { 0 } }, s->delta[i]
    };
    for (int b = 0; b < BANDS_MAX; b++)
        a.weight.band[b] = s->weight[b] ? s->weight[b][i] : 0;
    return a;
}

void bsdf_samples_put(const struct bsdf_samples *s, size_t i,
                      const struct bsdf_sample *a)
{
    s->x[i] = a->wi.x, s->y[i] = a->wi.y, s->z[i] = a->wi.z;
    s->pdf[i] = a->pdf;
    s->delta[i] = a->delta;
    for (int b = 0; b < BANDS_MAX; b++)
        if (s->weight[b])
            s->weight[b][i] = a->weight.band[b];
}

void bsdf_sample_into(const struct bsdf *b, size_t n, struct dirs wo,
                      struct dirs u, struct bsdf_samples out)
{
    for (int band = b->bands.count; band < BANDS_MAX; band++)
        out.weight[band] = NULL;
    if (b->type->sample_many) {
        b->type->sample_many(b->state, n, wo, u, out);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        const struct bsdf_sample a =
            b->type->sample(b->state, dirs_at(wo, i), dirs_at(u, i));
        bsdf_samples_put(&out, i, &a);
    }
}

void bsdf_sample_many(const struct bsdf *b, size_t n, struct dirs wo,
                      struct dirs u, struct bsdf_sample *sample)
{
    /* As many as another program wants at a time, of what is computed here as
     * many as stay in the first cache. */
    enum { BLOCK = 4096 };
    const size_t most = b->type->trouble ? BLOCK : 256;
    struct {
        double number[4 + BANDS_MAX][BLOCK];
        bool delta[BLOCK];
    } room;
    double(*const a)[BLOCK] = room.number;
    struct bsdf_samples out = { a[0], a[1], a[2], a[3], { NULL }, room.delta };
    for (int band = 0; band < b->bands.count; band++)
        out.weight[band] = a[4 + band];
    for (size_t at = 0, k; at < n; at += k) {
        k = n - at < most ? n - at : most;
        bsdf_sample_into(b, k, dirs_from(wo, at), dirs_from(u, at), out);
        for (size_t i = 0; i < k; i++)
            sample[at + i] = bsdf_samples_at(&out, i);
    }
}

bool bsdf_has_trouble(const struct bsdf *b)
{
    return b->type->trouble;
}

bool bsdf_trouble(const struct bsdf *b, struct err *what)
{
    return b->type->trouble && b->type->trouble(b->state, what);
}

bool bsdf_has_facets(const struct bsdf *b)
{
    return b->type->facet_d && b->type->facet_g1;
}

double bsdf_facet_d(const struct bsdf *b, struct vec3 m)
{
    return b->type->facet_d(b->state, m);
}

double bsdf_facet_g1(const struct bsdf *b, struct vec3 w)
{
    return b->type->facet_g1(b->state, w);
}

bool bsdf_index(const struct bsdf *b, struct spectrum *eta, struct spectrum *k)
{
    if (b->type->index)
        b->type->index(b->state, eta, k);
    return b->type->index;
}

char *bsdf_spec_with(const char *spec, const char *key, const char *value,
                     struct err *err)
{
    const size_t name = strcspn(spec, ":");
    struct setting *s = malloc(sizeof *s);
    char *made = NULL, between = ':';
    size_t size;
    FILE *out = s ? open_memstream(&made, &size) : NULL;
    bool ok = true;
    if (!out) {
        free(s);
        err_set(err, "out of memory");
        return NULL;
    }
    fprintf(out, "%.*s", (int)name, spec);
    for (const char *at = spec + name + (spec[name] == ':'); ok && *at;) {
        const char *from = at;
        ok = setting_read(&at, s, spec, err);
        if (!ok || strcmp(s->key, key) == 0)
            continue;
        const size_t n = (size_t)(at - from) - (at[-1] == ',' && *at);
        fprintf(out, "%c%.*s", between, (int)n, from);
        between = ',';
    }
    if (ok && value)
        fprintf(out, "%c%s=%s", between, key, value);
    if (fclose(out) != 0 && ok)
        ok = err_set(err, "out of memory");
    free(s);
    if (!ok) {
        free(made);
        made = NULL;
    }
    return made;
}
