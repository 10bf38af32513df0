/* host.c - bsdf-plugin-host: a shared object that speaks protocol.h
 *
 * bsdf-validate and bsdf-plot start it for specs like ./my.so:alpha=0.2.  The
 * settings are read as those of the library's own models are: the plugin's
 * table becomes one of bsdf.h.
 */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bsdf/bsdf.h"
#include "bsdf/cli.h"
#include "bsdf/plugin.h"
#include "validate/protocol.h"

enum { PARAMS_MAX = 63, WORDS = 32 };

/* -- the streams ----------------------------------------------------------- */

/* A plugin may print or read what it likes: the protocol has numbers of its
 * own. */
struct streams {
    int in, out;
};

static bool streams_take(struct streams *s)
{
    s->in = fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3);
    s->out = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    return s->in >= 0 && s->out >= 0 && nothing >= 0 &&
           dup2(nothing, STDIN_FILENO) >= 0 &&
           dup2(STDERR_FILENO, STDOUT_FILENO) >= 0;
}

/* Whether all n bytes came; false at the end as well. */
static bool take(const struct streams *s, void *data, size_t n)
{
    for (char *at = data; n > 0;) {
        const ssize_t got = read(s->in, at, n);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        at += got;
        n -= (size_t)got;
    }
    return true;
}

static bool give(const struct streams *s, const void *data, size_t n)
{
    for (const char *at = data; n > 0;) {
        const ssize_t wrote = write(s->out, at, n);
        if (wrote < 0 && errno == EINTR)
            continue;
        if (wrote < 0)
            return false;
        at += wrote;
        n -= (size_t)wrote;
    }
    return true;
}

/* -- the object ------------------------------------------------------------ */

static bool plugin_check(const struct bsdf_plugin *p, const char *path,
                         struct err *err)
{
    if (!p)
        return err_set(err, "%.200s: bsdf_plugin() gave NULL", path);
    if (p->abi != BSDF_PLUGIN_ABI)
        return err_set(err,
                       "%.200s: made for version %u of bsdf/plugin.h, this "
                       "toolkit has version %d",
                       path, p->abi, BSDF_PLUGIN_ABI);
    if (p->size < sizeof *p)
        return err_set(err,
                       "%.200s: its struct bsdf_plugin has %zu bytes, expected "
                       "sizeof(struct bsdf_plugin), %zu",
                       path, p->size, sizeof *p);
    if (!p->name || !p->claims || !p->eval || !p->pdf || !p->sample)
        return err_set(err,
                       "%.200s: expected name, claims, eval, pdf and sample in "
                       "its struct bsdf_plugin; one is NULL",
                       path);
    return true;
}

static const struct bsdf_plugin *plugin_load(const char *path, struct err *err)
{
    void *object = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!object) {
        err_set(err, "%.800s", dlerror());
        return NULL;
    }
    void *symbol = dlsym(object, "bsdf_plugin");
    if (!symbol) {
        err_set(err,
                "%.200s: it defines no function bsdf_plugin, see "
                "bsdf/plugin.h",
                path);
        return NULL;
    }
    const struct bsdf_plugin *(*entry)(void);
    memcpy(&entry, &symbol, sizeof entry); /* ISO C has no cast for it */
    const struct bsdf_plugin *p = entry();
    return plugin_check(p, path, err) ? p : NULL;
}

/* -- the settings ---------------------------------------------------------- */

/* The model as bsdf.h wants it, for the sake of its settings. */
struct model {
    const struct bsdf_plugin *plugin;
    struct bsdf_param param[PARAMS_MAX + 1];
    char def[PARAMS_MAX][WORDS];
    struct bsdf_type type;
    struct bsdf *instance;
    const double *values;
    void *state;
};

/* There is one, and `init` has no other way to it. */
static struct model model;

static bool init(void *values, const struct bands *bands, struct err *err)
{
    const struct bsdf_plugin *p = model.plugin;
    char why[512] = "";
    model.values = values;
    for (int i = 0; model.param[i].key; i++)
        if (isnan(model.values[i]))
            return err_set(err, "%.60s: %s must be given: %s", p->name,
                           model.param[i].key, model.param[i].about);
    if (!p->create) {
        model.state = values;
        return true;
    }
    model.state =
        p->create(values, bands->count,
                  bands->kind == BANDS_NM ? bands->nm : NULL, why, sizeof why);
    why[sizeof why - 1] = '\0';
    return model.state || err_set(err, "%.60s: %s", p->name,
                                  why[0] ? why : "create gave NULL");
}

static struct bsdf_claims no_claims(const void *state,
                                    const struct bands *bands)
{
    (void)state, (void)bands;
    return (struct bsdf_claims){ 0 };
}

static bool model_make(const char *settings, const struct bands *bands,
                       struct err *err)
{
    const struct bsdf_plugin *p = model.plugin;
    int n = 0;
    for (; p->params && p->params[n].key; n++) {
        const struct bsdf_plugin_param *from = &p->params[n];
        if (n == PARAMS_MAX)
            return err_set(err, "%.60s: more than %d settings", p->name,
                           PARAMS_MAX);
        snprintf(model.def[n], WORDS, "%.17g", from->def);
        model.param[n] = (struct bsdf_param){
            .key = from->key,
            .kind = BSDF_NUMBER,
            .offset = (size_t)n * sizeof(double),
            .def = isnan(from->def) ? NULL : model.def[n],
            .min = from->min,
            .max = from->max,
            .about = from->about ? from->about : "",
        };
    }
    model.type = (struct bsdf_type){
        .name = p->name,
        .about = p->about ? p->about : "",
        .params = model.param,
        .size = (size_t)n * sizeof(double),
        .claims = no_claims,
        .init = init,
    };
    model.instance = bsdf_new_of(&model.type, settings, bands, err);
    return model.instance;
}

/* -- the protocol ---------------------------------------------------------- */

/* Reads "bands 3 614 549 466" or "bands 3 R G B". */
static bool bands_read(struct bands *bands, const char *line)
{
    int at = 0;
    *bands = (struct bands){ .kind = BANDS_NM };
    if (sscanf(line, "bands %d%n", &bands->count, &at) != 1 ||
        bands->count < 1 || bands->count > BANDS_MAX)
        return false;
    if (strcmp(line + at, " R G B\n") == 0) {
        *bands = bands_default;
        return true;
    }
    for (int b = 0; b < bands->count; b++) {
        int used = 0;
        if (sscanf(line + at, "%lf%n", &bands->nm[b], &used) != 1)
            return false;
        at += used;
    }
    return strcmp(line + at, "\n") == 0;
}

static bool line_take(const struct streams *s, char *line, size_t size)
{
    size_t n = 0;
    while (n + 1 < size && take(s, line + n, 1))
        if (line[n++] == '\n') {
            line[n] = '\0';
            return true;
        }
    return false;
}

static bool asked(const struct streams *s, struct bands *bands)
{
    char line[256];
    int version;
    return line_take(s, line, sizeof line) &&
           sscanf(line, "bsdf %d", &version) == 1 &&
           version == PROTOCOL_VERSION && line_take(s, line, sizeof line) &&
           bands_read(bands, line) && line_take(s, line, sizeof line) &&
           strcmp(line, "\n") == 0;
}

static bool introduce(const struct streams *s)
{
    static const char *const lobes[] = {
        "diffuse_reflection",   "glossy_reflection",   "delta_reflection",
        "diffuse_transmission", "glossy_transmission", "delta_transmission",
    };
    struct bsdf_plugin_claims c = { .reciprocal = 1, .eta = 1 };
    char text[4096];
    int n = 0;
    model.plugin->claims(model.state, &c);
    n = snprintf(
        text, sizeof text,
        "bsdf %d\nname %.200s\nlossless %s\nreciprocal %s\n"
        "two_sided %s\neta %.17g\nprecision %s\ncosine %s\n"
        "given %s\nlobes",
        PROTOCOL_VERSION, model.plugin->name, c.lossless ? "yes" : "no",
        c.reciprocal ? "yes" : "no", c.two_sided ? "yes" : "no", c.eta,
        c.single ? "float" : "double",
        c.cosine_included ? "included" : "excluded", c.given_wi ? "wi" : "wo");
    for (int i = 0; i < 6; i++)
        if (c.lobes & 1u << i)
            n += snprintf(text + n, sizeof text - (size_t)n, " %s", lobes[i]);
    n += snprintf(text + n, sizeof text - (size_t)n, "\n\n");
    return give(s, text, (size_t)n);
}

static void refuse(const struct streams *s, const struct err *err)
{
    char text[sizeof err->text + 16];
    const int n = snprintf(text, sizeof text, "error %s\n\n", err->text);
    for (int i = 0; i < n - 2; i++)
        if (text[i] == '\n')
            text[i] = ' ';
    (void)give(s, text, (size_t)n);
}

/* Until the toolkit has no more questions. */
static bool serve(const struct streams *s, int bands)
{
    const struct bsdf_plugin *p = model.plugin;
    const size_t most = sizeof(double) * PROTOCOL_RECORDS;
    double *in = malloc(PROTOCOL_NUMBERS * most);
    /* The header lies before the numbers, so that one write takes both. */
    double *reply = malloc(sizeof(double) + (5 + BANDS_MAX) * most);
    double *const out = reply + 1;
    struct protocol_header h;
    _Static_assert(sizeof h == sizeof *reply, "the header has 8 bytes");
    bool ok = in && reply;
    while (ok && take(s, &h, sizeof h)) {
        ok = h.op >= PROTOCOL_EVAL && h.op <= PROTOCOL_SAMPLE && h.n > 0 &&
             h.n <= PROTOCOL_RECORDS &&
             take(s, in, sizeof *in * PROTOCOL_NUMBERS * h.n);
        if (!ok)
            break;
        const size_t size =
            sizeof *out * h.n * (size_t)protocol_answer(h.op, bands);
        memset(out, 0, size);
        if (h.op == PROTOCOL_EVAL)
            p->eval(model.state, bands, h.n, in, out);
        else if (h.op == PROTOCOL_PDF)
            p->pdf(model.state, bands, h.n, in, out);
        else
            p->sample(model.state, bands, h.n, in, out);
        memcpy(reply, &h, sizeof h);
        ok = give(s, reply, sizeof h + size);
    }
    free(in);
    free(reply);
    return ok;
}

int main(int argc, char **argv)
{
    struct streams s;
    struct bands bands;
    struct err err = { "" };
    if (argc < 2 || argc > 3 || argv[1][0] == '-') {
        fprintf(stderr, "usage: bsdf-plugin-host FILE.so [key=value,...]\n"
                        "bsdf-validate and bsdf-plot start it by themselves "
                        "for specs like ./my.so:alpha=0.2\n");
        return EXIT_REQUEST;
    }
    if (!streams_take(&s) || !asked(&s, &bands)) {
        fprintf(stderr, "bsdf-plugin-host: expected the handshake of a toolkit "
                        "on standard input\n");
        return EXIT_REQUEST;
    }
    model.plugin = plugin_load(argv[1], &err);
    if (!model.plugin || !model_make(argc > 2 ? argv[2] : "", &bands, &err)) {
        refuse(&s, &err);
        return EXIT_REQUEST;
    }
    const bool ok = introduce(&s) && serve(&s, bands.count);
    if (model.plugin->create && model.plugin->destroy)
        model.plugin->destroy(model.state);
    bsdf_free(model.instance);
    return ok ? EXIT_SOUND : EXIT_REQUEST;
}
