/* pipe.c - batches of requests, and what to do when one fails */
#include "validate/pipe.h"

#include <ctype.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "validate/child.h"
#include "validate/handshake.h"
#include "validate/protocol.h"

enum { NUMBER = 32, PORTION = 256, ANSWER_MAX = 5 + BANDS_MAX };

static double time_limit = 10;

void pipe_set_time_limit(double seconds)
{
    time_limit = seconds;
}

/* A process, waiting to be asked. */
struct worker {
    struct child child;
    struct worker *next;
};

/* A thread that has met trouble, now or before. */
struct talker {
    pthread_t thread;
    int failures; /* since the trouble was asked for */
    bool troubled;
    struct err what;
    struct talker *next;
};

/* What may change while threads share an instance is behind the mutex. */
struct pipe {
    char **argv;
    struct bands bands;
    struct handshake hello;
    double seconds;
    pthread_mutex_t mutex;
    struct worker *idle;
    struct talker *talkers;
    int failures;
};

struct state {
    struct pipe *pipe;
};

/* -- processes ------------------------------------------------------------- */

static bool hello_whole(void *context, const char *reply, size_t n)
{
    (void)context;
    return handshake_whole(reply, n);
}

/* What became of a child, in words, and the child's end. */
static void end_of(struct child *c, enum child_said said, double seconds,
                   struct err *what)
{
    switch (said) {
    case CHILD_WHOLE:
        break; /* the caller knows what is wrong */
    case CHILD_GONE:
        child_bury(c, what);
        break;
    case CHILD_LATE:
        err_set(what, "no answer within %g s", seconds);
        break;
    case CHILD_MUCH:
        err_set(what, "more than any answer could be");
        break;
    case CHILD_SPOKE:
        err_set(what, "bytes on its standard output that nobody asked for");
        break;
    case CHILD_MEMORY:
        err_set(what, "out of memory");
        break;
    }
    child_stop(c);
}

/* A new process, after its handshake. */
static struct worker *worker_new(char *const argv[], const struct bands *bands,
                                 double seconds, struct handshake *hello,
                                 struct err *err)
{
    const double patience = 3 * seconds;
    char ask[HANDSHAKE_MAX];
    struct err why;
    struct worker *w = calloc(1, sizeof *w);
    if (!w) {
        err_set(err, "out of memory");
        return NULL;
    }
    if (child_start(&w->child, argv, err)) {
        const enum child_said said =
            child_ask(&w->child, ask, handshake_ask(bands, ask),
                      (size_t)PROTOCOL_LINES * PROTOCOL_LINE, patience,
                      hello_whole, NULL);
        if (said == CHILD_WHOLE) {
            if (handshake_read(hello, w->child.reply, w->child.replied, err))
                return w;
            child_stop(&w->child);
        } else {
            end_of(&w->child, said, patience, &why);
            err_set(err, "%s before it had said what it is", why.text);
        }
    }
    free(w);
    return NULL;
}

static bool hello_same(const struct handshake *a, const struct handshake *b)
{
    return a->claims.lobes == b->claims.lobes &&
           a->claims.lossless == b->claims.lossless &&
           a->claims.reciprocal == b->claims.reciprocal &&
           a->claims.two_sided == b->claims.two_sided &&
           a->claims.eta == b->claims.eta &&
           a->claims.epsilon == b->claims.epsilon && a->text == b->text &&
           a->cosine_included == b->cosine_included &&
           a->given_wi == b->given_wi;
}

/* An idle process, or a new one. */
static struct worker *worker_take(struct pipe *p, struct err *err)
{
    struct handshake hello;
    pthread_mutex_lock(&p->mutex);
    struct worker *w = p->idle;
    if (w)
        p->idle = w->next;
    pthread_mutex_unlock(&p->mutex);
    if (w)
        return w;
    w = worker_new(p->argv, &p->bands, p->seconds, &hello, err);
    if (!w || hello_same(&hello, &p->hello))
        return w;
    err_set(err, "says other things of itself when it is started again");
    child_stop(&w->child);
    free(w);
    return NULL;
}

static void worker_return(struct pipe *p, struct worker *w)
{
    pthread_mutex_lock(&p->mutex);
    w->next = p->idle;
    p->idle = w;
    pthread_mutex_unlock(&p->mutex);
}

/* -- requests -------------------------------------------------------------- */

struct request {
    const struct pipe *pipe;
    enum protocol_op op;
    size_t n;
    const double *record; /* of PROTOCOL_NUMBERS each */
    int numbers;          /* of one answer */
    size_t lines, looked; /* of a text reply: whole lines so far, bytes */
};

static const char *const names[] = { [PROTOCOL_EVAL] = "eval",
                                     [PROTOCOL_PDF] = "pdf",
                                     [PROTOCOL_SAMPLE] = "sample" };

static bool header_fits(const struct request *r, const char *reply)
{
    struct protocol_header h;
    memcpy(&h, reply, sizeof h);
    return h.op == (uint32_t)r->op && h.n == r->n;
}

static size_t binary_size(const struct request *r)
{
    return sizeof(struct protocol_header) +
           r->n * (size_t)r->numbers * sizeof(double);
}

static bool binary_whole(void *context, const char *reply, size_t n)
{
    const struct request *r = context;
    return n >= binary_size(r) ||
           (n >= sizeof(struct protocol_header) && !header_fits(r, reply));
}

static bool text_whole(void *context, const char *reply, size_t n)
{
    struct request *r = context;
    const char *at = reply + r->looked, *const end = reply + n;
    for (; (at = memchr(at, '\n', (size_t)(end - at))); at++)
        r->lines++;
    r->looked = n;
    return r->lines >= r->n;
}

/* What cannot be printed as dots. */
static void quote(char *text, size_t size, const char *bytes, size_t n)
{
    size_t i = 0;
    for (; i < n && i + 1 < size; i++)
        text[i] = isprint((unsigned char)bytes[i]) ? bytes[i] : '.';
    text[i] = '\0';
}

static bool binary_read(const struct request *r, const struct child *c,
                        double *answer, struct err *err)
{
    struct protocol_header h;
    char said[33];
    if (!header_fits(r, c->reply)) {
        memcpy(&h, c->reply, sizeof h);
        quote(said, sizeof said, c->reply, c->replied);
        return err_set(err,
                       "the answer begins with the header (%u, %u) in place "
                       "of (%u, %zu), as text \"%s\"",
                       h.op, h.n, (unsigned)r->op, r->n, said);
    }
    if (c->replied > binary_size(r))
        return err_set(err, "more than the %zu bytes that were asked for",
                       binary_size(r));
    memcpy(answer, c->reply + sizeof h, binary_size(r) - sizeof h);
    return true;
}

static bool text_read(const struct request *r, const struct child *c,
                      double *answer, struct err *err)
{
    char *at = c->reply;
    for (size_t i = 0; i < r->n; i++) {
        char *stop = strchr(at, '\n'), *from = at, *end = at, said[61];
        int got = 0;
        if (!stop)
            return err_set(err, "a NUL in the answer");
        *stop = '\0';
        while (got <= r->numbers) {
            const double x = strtod(from, &end);
            if (end == from)
                break;
            if (got < r->numbers)
                answer[i * (size_t)r->numbers + (size_t)got] = x;
            got++;
            from = end;
        }
        if (got != r->numbers || from[strspn(from, " \t\r")] != '\0') {
            quote(said, sizeof said, at, strlen(at));
            return err_set(err,
                           "line %zu of the answer is \"%s\", expected %d "
                           "numbers",
                           i + 1, said, r->numbers);
        }
        at = stop + 1;
    }
    return at == c->reply + c->replied ||
           err_set(err,
                   "%zu bytes behind the last line of the answer that "
                   "nobody asked for",
                   (size_t)(c->reply + c->replied - at));
}

/* What no formula can make good. */
static bool answer_check(const struct request *r, const double *answer,
                         struct err *err)
{
    for (size_t i = 1; r->op == PROTOCOL_SAMPLE && i <= r->n; i++) {
        const double delta = answer[i * (size_t)r->numbers - 1];
        if (delta != 0 && delta != 1)
            return err_set(err,
                           "delta of sample %zu of the answer is %g, expected "
                           "0 or 1",
                           i, delta);
    }
    return true;
}

/* The request as bytes, owned by the caller. */
static char *request_write(const struct request *r, size_t *size)
{
    const size_t numbers = r->n * PROTOCOL_NUMBERS;
    if (!r->pipe->hello.text) {
        const struct protocol_header h = { (uint32_t)r->op, (uint32_t)r->n };
        *size = sizeof h + numbers * sizeof(double);
        char *bytes = malloc(*size);
        if (bytes) {
            memcpy(bytes, &h, sizeof h);
            memcpy(bytes + sizeof h, r->record, numbers * sizeof(double));
        }
        return bytes;
    }
    char *text = malloc(NUMBER + numbers * NUMBER);
    if (!text)
        return NULL;
    size_t at = (size_t)sprintf(text, "%s %zu\n", names[r->op], r->n);
    for (size_t i = 0; i < numbers; i++)
        at += (size_t)sprintf(text + at, "%.17g%c", r->record[i],
                              (i + 1) % PROTOCOL_NUMBERS ? ' ' : '\n');
    *size = at;
    return text;
}

/* Asks a process.  Where it fails, it is at its end and the sentence is set. */
static bool ask(struct request *r, struct worker *w, double *answer,
                struct err *what)
{
    const bool text = r->pipe->hello.text;
    const double seconds = r->pipe->seconds;
    size_t size;
    char *bytes = request_write(r, &size);
    if (!bytes) {
        child_stop(&w->child);
        return err_set(what, "out of memory");
    }
    r->lines = r->looked = 0;
    const enum child_said said =
        text ? child_ask(&w->child, bytes, size, r->n * PROTOCOL_TEXT_LINE,
                         seconds, text_whole, r)
             : child_ask(&w->child, bytes, size, binary_size(r), seconds,
                         binary_whole, r);
    free(bytes);
    if (said == CHILD_WHOLE &&
        (text ? text_read(r, &w->child, answer, what)
              : binary_read(r, &w->child, answer, what)) &&
        answer_check(r, answer, what))
        return true;
    const size_t heard = w->child.replied;
    end_of(&w->child, said, seconds, what);
    if (heard > 0 && (said == CHILD_GONE || said == CHILD_LATE)) {
        const size_t used = strlen(what->text);
        snprintf(what->text + used, sizeof what->text - used,
                 " but %zu bytes%s", heard, text ? "" : " of it");
    }
    return false;
}

/* -- trouble --------------------------------------------------------------- */

/* The talker of this thread, made when it is first needed; the mutex is held.
 * NULL when out of memory. */
static struct talker *talker_here(struct pipe *p, bool make)
{
    struct talker *t = p->talkers;
    while (t && !pthread_equal(t->thread, pthread_self()))
        t = t->next;
    if (!t && make && (t = calloc(1, sizeof *t))) {
        t->thread = pthread_self();
        t->next = p->talkers;
        p->talkers = t;
    }
    return t;
}

static bool tired(const struct pipe *p, const struct talker *t)
{
    return p->failures > PIPE_RESTARTS ||
           (t && t->failures > PIPE_RESTARTS_OF_VIEW);
}

/* Whether there is no more asking, and why not. */
static bool given_up(struct pipe *p)
{
    pthread_mutex_lock(&p->mutex);
    struct talker *t = talker_here(p, p->failures > PIPE_RESTARTS);
    const bool up = tired(p, t);
    if (up && t && !t->troubled) {
        t->troubled = true;
        err_set(&t->what,
                "not asked any more, as it had been started again "
                "%d times before",
                PIPE_RESTARTS);
    }
    pthread_mutex_unlock(&p->mutex);
    return up;
}

/* The pair of directions, or the direction and the random numbers: short, and
 * to the last digit. */
static void place(const struct request *r, char *brief, char *exact,
                  size_t size)
{
    const double *x = r->record;
    const struct vec3 wo = { x[0], x[1], x[2] }, wi = { x[3], x[4], x[5] };
    const struct angles o = dir_to_degrees(wo), i = dir_to_degrees(wi);
    const bool draw = r->op == PROTOCOL_SAMPLE;
    if (draw)
        snprintf(brief, size, "wo %.6g,%.6g deg and u %.6g,%.6g,%.6g",
                 o.theta_deg, o.phi_deg, wi.x, wi.y, wi.z);
    else
        snprintf(brief, size, "wo %.6g,%.6g and wi %.6g,%.6g deg", o.theta_deg,
                 o.phi_deg, i.theta_deg, i.phi_deg);
    snprintf(exact, size, "wo (%.17g, %.17g, %.17g), %s (%.17g, %.17g, %.17g)",
             wo.x, wo.y, wo.z, draw ? "u" : "wi", wi.x, wi.y, wi.z);
}

static void tell(struct talker *t, const struct request *r,
                 const struct err *what)
{
    enum { SIZE = 256 };
    char brief[SIZE], exact[SIZE], count[48] = "";
    place(r, brief, exact, SIZE);
    if (r->n > 1)
        snprintf(count, sizeof count, ", the first of %zu", r->n);
    err_set(&t->what, "%s: %s of %s%s; expected %d number%s%s; %s", what->text,
            names[r->op], brief, count, r->numbers, r->numbers == 1 ? "" : "s",
            r->n > 1 ? " each" : "", exact);
    t->troubled = true;
}

static void add(struct talker *t, const char *more)
{
    const size_t used = strlen(t->what.text);
    snprintf(t->what.text + used, sizeof t->what.text - used, "; %s", more);
}

/* Counts a failure.  The first trouble is kept; where it is of this call, it
 * gives way to a narrower place.  Whether what is kept is of this call. */
static bool failed(struct pipe *p, const struct request *r,
                   const struct err *what, bool mine)
{
    pthread_mutex_lock(&p->mutex);
    struct talker *t = talker_here(p, true);
    p->failures++;
    if (t) {
        t->failures++;
        if (mine || !t->troubled) {
            tell(t, r, what);
            mine = true;
        }
        if (tired(p, t))
            add(t, "started again too often, so asked no more");
    }
    pthread_mutex_unlock(&p->mutex);
    return mine;
}

static void nowhere(struct pipe *p)
{
    pthread_mutex_lock(&p->mutex);
    struct talker *t = talker_here(p, false);
    if (t && t->troubled)
        add(t, "asked again in smaller portions, it answered them all");
    pthread_mutex_unlock(&p->mutex);
}

static bool trouble(const void *state, struct err *what)
{
    struct pipe *p = ((const struct state *)state)->pipe;
    pthread_mutex_lock(&p->mutex);
    struct talker *t = talker_here(p, false);
    const bool troubled = t && t->troubled;
    if (troubled && what)
        *what = t->what;
    if (t) {
        t->troubled = false;
        t->failures = 0;
    }
    pthread_mutex_unlock(&p->mutex);
    return troubled;
}

/* -- answers --------------------------------------------------------------- */

/* Asks until all is answered, NaN where it could not be.  A portion that fails
 * is asked again in smaller ones, of one record at last, which costs few
 * failures though many questions. */
static void answer(struct pipe *p, enum protocol_op op, size_t n,
                   const double *record, double *out)
{
    const size_t numbers = (size_t)protocol_answer(op, p->bands.count);
    const size_t most =
        p->hello.text ? PROTOCOL_TEXT_RECORDS : PROTOCOL_RECORDS;
    struct worker *w = NULL;
    size_t portion = most, at = 0;
    bool narrowing = false, mine = false;
    while (at < n && !given_up(p)) {
        const size_t k = n - at < portion ? n - at : portion;
        struct request r = { .pipe = p,
                             .op = op,
                             .n = k,
                             .record = record + at * PROTOCOL_NUMBERS,
                             .numbers = (int)numbers };
        struct err what;
        if (!w)
            w = worker_take(p, &what);
        if (w && ask(&r, w, out + at * numbers, &what)) {
            at += k;
            continue;
        }
        free(w);
        w = NULL;
        mine = failed(p, &r, &what, mine);
        narrowing = k > 1;
        portion = k > PORTION ? PORTION : k > 1 ? 1 : most;
        if (k == 1) {
            mine = false;
            for (size_t b = 0; b < numbers; b++)
                out[at * numbers + b] = NAN;
            at++;
        }
    }
    if (mine && narrowing && at == n)
        nowhere(p);
    for (size_t i = at * numbers; i < n * numbers; i++)
        out[i] = NAN;
    if (w)
        worker_return(p, w);
}

/* f of transmission becomes radiance's, see protocol.h. */
static double compression(const struct pipe *p, double wo_z, double wi_z)
{
    const double eta = p->hello.claims.eta;
    if (!p->hello.given_wi || !(wo_z * wi_z < 0))
        return 1;
    return wo_z > 0 ? 1 / (eta * eta) : eta * eta;
}

static struct spectrum eval_read(const struct pipe *p, const double *record,
                                 const double *out)
{
    struct spectrum f = { { 0 } };
    const double wo_z = record[2], wi_z = record[5];
    double scale = compression(p, wo_z, wi_z);
    if (p->hello.cosine_included)
        scale /= fabs(wi_z);
    for (int b = 0; b < p->bands.count; b++)
        f.band[b] = p->hello.cosine_included && wi_z == 0 && isfinite(out[b])
                        ? 0
                        : out[b] * scale;
    return f;
}

static struct bsdf_sample sample_read(const struct pipe *p,
                                      const double *record, const double *out)
{
    struct bsdf_sample s = { .wi = { out[0], out[1], out[2] },
                             .pdf = out[3],
                             .delta = out[4 + p->bands.count] == 1 };
    const double scale = compression(p, record[2], s.wi.z);
    for (int b = 0; b < p->bands.count; b++)
        s.weight.band[b] = out[4 + b] * scale;
    return s;
}

static void record_write(double *record, struct vec3 a, struct vec3 b)
{
    const double x[PROTOCOL_NUMBERS] = { a.x, a.y, a.z, b.x, b.y, b.z };
    memcpy(record, x, sizeof x);
}

static struct pipe *pipe_of(const void *state)
{
    return ((const struct state *)state)->pipe;
}

/* The answers to n questions, between the records and what is made of them:
 * PROTOCOL_NUMBERS n numbers, and ANSWER_MAX n behind them.  NULL when out of
 * memory. */
static double *ask_many(struct pipe *p, enum protocol_op op, size_t n,
                        struct dirs a, struct dirs b)
{
    double *record =
        malloc((PROTOCOL_NUMBERS + ANSWER_MAX) * n * sizeof *record);
    if (!record)
        return NULL;
    for (size_t i = 0; i < n; i++)
        record_write(record + i * PROTOCOL_NUMBERS, dirs_at(a, i),
                     dirs_at(b, i));
    answer(p, op, n, record, record + PROTOCOL_NUMBERS * n);
    return record;
}

static struct spectrum eval(const void *state, struct vec3 wo, struct vec3 wi)
{
    struct pipe *p = pipe_of(state);
    double record[PROTOCOL_NUMBERS], out[ANSWER_MAX];
    record_write(record, wo, wi);
    answer(p, PROTOCOL_EVAL, 1, record, out);
    return eval_read(p, record, out);
}

static void eval_many(const void *state, size_t n, struct dirs wo,
                      struct dirs wi, struct spectrum *f)
{
    struct pipe *p = pipe_of(state);
    const size_t numbers = (size_t)p->bands.count;
    double *all = ask_many(p, PROTOCOL_EVAL, n, wo, wi);
    for (size_t i = 0; i < n; i++)
        f[i] = all ? eval_read(p, all + i * PROTOCOL_NUMBERS,
                               all + n * PROTOCOL_NUMBERS + i * numbers)
                   : spectrum_of(p->bands.count, NAN);
    free(all);
}

static double pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    double record[PROTOCOL_NUMBERS], out;
    record_write(record, wo, wi);
    answer(pipe_of(state), PROTOCOL_PDF, 1, record, &out);
    return out;
}

static void pdf_many(const void *state, size_t n, struct dirs wo,
                     struct dirs wi, double *value)
{
    double *all = ask_many(pipe_of(state), PROTOCOL_PDF, n, wo, wi);
    for (size_t i = 0; i < n; i++)
        value[i] = all ? all[n * PROTOCOL_NUMBERS + i] : NAN;
    free(all);
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    struct pipe *p = pipe_of(state);
    double record[PROTOCOL_NUMBERS], out[ANSWER_MAX];
    record_write(record, wo, u);
    answer(p, PROTOCOL_SAMPLE, 1, record, out);
    return sample_read(p, record, out);
}

static void sample_many(const void *state, size_t n, struct dirs wo,
                        struct dirs u, struct bsdf_samples out)
{
    struct pipe *p = pipe_of(state);
    const int bands = p->bands.count;
    const size_t numbers = (size_t)protocol_answer(PROTOCOL_SAMPLE, bands);
    double *all = ask_many(p, PROTOCOL_SAMPLE, n, wo, u);
    for (size_t i = 0; i < n; i++) {
        const struct bsdf_sample a =
            all ? sample_read(p, all + i * PROTOCOL_NUMBERS,
                              all + n * PROTOCOL_NUMBERS + i * numbers)
                : (struct bsdf_sample){ .pdf = NAN,
                                        .weight = spectrum_of(bands, NAN) };
        bsdf_samples_put(&out, i, &a);
    }
    free(all);
}

/* -- instances ------------------------------------------------------------- */

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    (void)bands;
    return pipe_of(state)->hello.claims;
}

static void pipe_free(struct pipe *p)
{
    for (struct worker *w = p->idle; w; w = w->next)
        child_hush(&w->child); /* so that they leave at the same time */
    while (p->idle) {
        struct worker *w = p->idle;
        p->idle = w->next;
        child_dismiss(&w->child);
        free(w);
    }
    while (p->talkers) {
        struct talker *t = p->talkers;
        p->talkers = t->next;
        free(t);
    }
    for (char **arg = p->argv; arg && *arg; arg++)
        free(*arg);
    free(p->argv);
    pthread_mutex_destroy(&p->mutex);
    free(p);
}

static void clear(void *state)
{
    pipe_free(pipe_of(state));
}

static const struct bsdf_param params[] = { { 0 } };

static const struct bsdf_type type_pipe = {
    .name = "pipe",
    .about = "computed by another program",
    .params = params,
    .size = sizeof(struct state),
    .claims = claims,
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
    .clear = clear,
    .trouble = trouble,
    .eval_many = eval_many,
    .pdf_many = pdf_many,
    .sample_many = sample_many,
};

static bool argv_copy(struct pipe *p, char *const argv[])
{
    size_t n = 0;
    while (argv[n])
        n++;
    p->argv = calloc(n + 1, sizeof *p->argv);
    for (size_t i = 0; p->argv && i < n; i++)
        if (!(p->argv[i] = strdup(argv[i])))
            return false;
    return p->argv;
}

struct bsdf *pipe_new(const char *spec, char *const argv[],
                      const struct bands *bands, struct err *err)
{
    struct err why;
    struct pipe *p = calloc(1, sizeof *p);
    if (!p || pthread_mutex_init(&p->mutex, NULL) != 0) {
        free(p);
        err_set(err, "out of memory");
        return NULL;
    }
    p->bands = *bands;
    p->seconds = time_limit;
    if (!argv_copy(p, argv)) {
        err_set(err, "out of memory");
        goto fail;
    }
    p->idle = worker_new(p->argv, bands, p->seconds, &p->hello, &why);
    if (!p->idle) {
        err_set(err, "%.300s: %s", spec, why.text);
        goto fail;
    }
    struct bsdf *b =
        bsdf_new_around(&type_pipe, spec, &(struct state){ p }, bands, err);
    if (b)
        return b;
fail:
    pipe_free(p);
    return NULL;
}
