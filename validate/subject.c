/* subject.c - asking, drawing, and how exact the answers can be */
#include "validate/subject.h"

#include <gsl/gsl_sort.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/frame.h"
#include "bsdf/lanes.h"
#include "validate/energy.h"

const struct plan plan_default = {
    .seed = 1, .samples = 1000000, .significance = 1e-6, .escalations = 2
};

/* FNV-1a, 64 bits: G. Fowler, L. Noll and K.-P. Vo, 1991. */
static uint64_t hash(uint64_t h, const void *data, size_t size)
{
    for (const unsigned char *p = data; size-- > 0; p++)
        h = (h ^ *p) * 0x100000001b3;
    return h;
}

struct rng subject_rng(const struct subject *s, enum stream purpose)
{
    const char *spec = bsdf_spec(s->bsdf);
    const unsigned char tag[2] = { (unsigned char)purpose,
                                   (unsigned char)s->stage };
    uint64_t h = hash(0xcbf29ce484222325, spec, strlen(spec));
    h = hash(h, &s->wo, sizeof s->wo);
    return (struct rng){ s->plan->seed, hash(h, tag, s->stage > 0 ? 2 : 1) };
}

size_t subject_batch(const struct subject *s)
{
    return bsdf_has_trouble(s->bsdf) ? SUBJECT_BATCH : 4 * LANES_MAX;
}

struct subject subject_plain(const struct bsdf *b, struct vec3 wo,
                             const struct plan *plan)
{
    return (struct subject){ .bsdf = b,
                             .wo = wo,
                             .plan = plan,
                             .samples = plan->samples,
                             .claims = bsdf_claims(b) };
}

bool subject_init_stage(struct subject *s, const struct bsdf *b, struct vec3 wo,
                        const struct plan *plan, int stage, uint64_t samples,
                        struct err *err)
{
    *s = subject_plain(b, wo, plan);
    s->stage = stage;
    s->samples = samples;
    s->energy = calloc(1, sizeof *s->energy);
    if (!s->energy)
        return err_set(err, "out of memory");
    if (survey_make(s, err))
        return true;
    subject_clear(s);
    return false;
}

bool subject_init(struct subject *s, const struct bsdf *b, struct vec3 wo,
                  const struct plan *plan, struct err *err)
{
    return subject_init_stage(s, b, wo, plan, 0, plan->samples, err);
}

void subject_clear(struct subject *s)
{
    survey_clear(&s->survey);
    free(s->energy);
    s->energy = NULL;
}

/* The same direction n times, until another is asked for. A thread keeps the
 * last one, as most calls are about that. */
static struct dirs repeat(struct vec3 w, size_t n)
{
    static _Thread_local struct {
        struct vec3 w;
        size_t n;
        double x[SUBJECT_BATCH], y[SUBJECT_BATCH], z[SUBJECT_BATCH];
    } last;
    if (memcmp(&last.w, &w, sizeof w) != 0) {
        last.w = w;
        last.n = 0;
    }
    for (; last.n < n; last.n++) {
        last.x[last.n] = w.x;
        last.y[last.n] = w.y;
        last.z[last.n] = w.z;
    }
    return (struct dirs){ last.x, last.y, last.z };
}

static struct dirs from(struct dirs d, size_t at)
{
    return (struct dirs){ d.x + at, d.y + at, d.z + at };
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

void subject_eval(const struct subject *s, size_t n, struct dirs wi,
                  struct spectrum *f)
{
    const size_t step = subject_batch(s);
    const struct dirs wo = repeat(s->wo, least(n, step));
    for (size_t at = 0; at < n; at += step)
        bsdf_eval_many(s->bsdf, least(n - at, step), wo, from(wi, at), f + at);
}

void subject_eval_back(const struct subject *s, size_t n, struct dirs wi,
                       struct spectrum *f)
{
    const size_t step = subject_batch(s);
    const struct dirs wo = repeat(s->wo, least(n, step));
    for (size_t at = 0; at < n; at += step)
        bsdf_eval_many(s->bsdf, least(n - at, step), from(wi, at), wo, f + at);
}

void subject_pdf(const struct subject *s, size_t n, struct dirs wi, double *pdf)
{
    const size_t step = subject_batch(s);
    const struct dirs wo = repeat(s->wo, least(n, step));
    for (size_t at = 0; at < n; at += step)
        bsdf_pdf_many(s->bsdf, least(n - at, step), wo, from(wi, at), pdf + at);
}

void subject_sample(const struct subject *s, size_t n, struct dirs u,
                    struct bsdf_sample *out)
{
    const size_t step = subject_batch(s);
    const struct dirs wo = repeat(s->wo, least(n, step));
    for (size_t at = 0; at < n; at += step)
        bsdf_sample_many(s->bsdf, least(n - at, step), wo, from(u, at),
                         out + at);
}

void subject_draw(const struct subject *s, struct rng rng, uint64_t first,
                  size_t n, struct bsdf_sample *out)
{
    double x[SUBJECT_BATCH], y[SUBJECT_BATCH], z[SUBJECT_BATCH];
    const size_t step = subject_batch(s);
    const struct dirs wo = repeat(s->wo, least(n, step)), u = { x, y, z };
    for (size_t at = 0; at < n; at += step) {
        rng_uniform_many(rng, first + at, least(n - at, step), x, y, z);
        bsdf_sample_many(s->bsdf, least(n - at, step), wo, u, out + at);
    }
}

void subject_draw_into(const struct subject *s, struct rng rng, uint64_t first,
                       size_t n, struct bsdf_samples out)
{
    double x[SUBJECT_BATCH], y[SUBJECT_BATCH], z[SUBJECT_BATCH];
    const size_t step = subject_batch(s);
    const struct dirs wo = repeat(s->wo, least(n, step)), u = { x, y, z };
    for (size_t at = 0; at < n; at += step) {
        rng_uniform_many(rng, first + at, least(n - at, step), x, y, z);
        bsdf_sample_into(s->bsdf, least(n - at, step), wo, u,
                         bsdf_samples_from(&out, at));
    }
}

bool subject_refused(const struct bsdf_sample *a)
{
    return a->pdf == 0 && spectrum_is(a->weight, BANDS_MAX, 0);
}

bool subject_spread(const struct bsdf_sample *a)
{
    return !a->delta && !subject_refused(a);
}

double subject_compression(const struct subject *s, struct vec3 wi)
{
    const double eta = s->claims.eta;
    return wi.z * s->wo.z >= 0 ? 1 : s->wo.z > 0 ? eta * eta : 1 / (eta * eta);
}

double subject_precision(const struct subject *s)
{
    return fmax(1e-7, 10 * sqrt(s->claims.epsilon / 2));
}

double subject_unit_error(const struct subject *s)
{
    return fmax(1e-9, 8 * s->claims.epsilon);
}

double subject_rounding(const struct subject *s, struct vec3 wi, bool of_pdf)
{
    /* 2^-40 for double: small, and yet seen with some digits. */
    const double e = s->claims.epsilon, step = pow(e, 10. / 13);
    const struct frame frame = frame_about(wi);
    enum { LOOKS = 7, SLOPES = 3 };
    /* By a step each way, and to neighbours of wi itself. */
    const double along[LOOKS] = { 0, step, 0, 4 * e, -4 * e, 0, 0 };
    const double across[LOOKS] = { 0, 0, step, 0, 0, 4 * e, -4 * e };
    double x[LOOKS], y[LOOKS], z[LOOKS], value[LOOKS] = { 0 };
    for (int i = 0; i < LOOKS; i++) {
        const struct vec3 w =
            vec3_unit(vec3_add(wi, vec3_add(vec3_scale(along[i], frame.s),
                                            vec3_scale(across[i], frame.t))));
        x[i] = i ? w.x : wi.x, y[i] = i ? w.y : wi.y, z[i] = i ? w.z : wi.z;
    }
    const struct dirs at = { x, y, z };
    if (of_pdf) {
        subject_pdf(s, LOOKS, at, value);
    } else {
        struct spectrum f[LOOKS];
        subject_eval(s, LOOKS, at, f);
        for (int i = 0; i < LOOKS; i++)
            for (int k = 0; k < BANDS_MAX; k++)
                value[i] = fmax(value[i], f[i].band[k]);
    }
    double most = 0, noise = 0;
    for (int i = 1; i < LOOKS; i++) {
        double *const to = i < SLOPES ? &most : &noise;
        *to = fmax(*to, fabs(value[i] / value[0] - 1));
    }
    return fmin(16 * e / step * most + 4 * noise, 0.5);
}

double subject_typical_rounding(const struct subject *s, const struct vec3 *wi,
                                size_t n, bool of_pdf)
{
    enum { LOOKS = 65 };
    double off[LOOKS];
    const size_t looks = n < LOOKS ? n : LOOKS;
    for (size_t i = 0; i < looks; i++)
        off[i] = subject_rounding(s, wi[i * (n / looks)], of_pdf);
    gsl_sort(off, 1, looks);
    return looks ? off[looks / 2] : 0;
}
