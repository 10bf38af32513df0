/* calibration.c - runs of sound models, and a ledger of their p-values */
#include "tests/calibration.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const double calibration_level[LEVELS] = { .05, .01, .001 };

#define METAL "roughconductor:distribution="
const char *const calibration_specs[] = {
    "diffuse",
    METAL "beckmann,alpha=0.005",
    METAL "beckmann,alpha=0.05,sample_visible=false",
    METAL "beckmann,alpha=1",
    METAL "beckmann,alpha_u=0.4,alpha_v=0.05",
    METAL "ggx,alpha=0.005,sample_visible=false",
    METAL "ggx,alpha=0.2",
    METAL "ggx,alpha=0.5,sample_visible=false",
    METAL "ggx,alpha_u=0.1,alpha_v=0.3,sample_visible=false",
    "roughdielectric:alpha=0.3",
    "roughdielectric:alpha=0.1,distribution=ggx,sample_visible=false",
    "blendbsdf:weight=0.3,bsdf_0=(diffuse),bsdf_1=(roughconductor:alpha=0.3)",
    "blendbsdf:weight=0.3,bsdf_0=(mirror),bsdf_1=(roughconductor:alpha=0.3)",
    "twosided:front=(diffuse),back=(roughconductor)",
    "dielectric",
    "thindielectric",
    NULL,
};

struct vec3 calibration_direction(uint64_t seed, uint64_t stream,
                                  uint64_t index, bool both_sides)
{
    const struct vec3 u =
        rng_uniform((struct rng){ seed, 0xca11 + stream }, index);
    const double z = (both_sides && u.z < 0.5 ? -1 : 1) * (1 - u.x);
    const double r = sqrt((1 - z) * (1 + z)), phi = 2 * PI * u.y;
    return (struct vec3){ r * cos(phi), r * sin(phi), z };
}

static struct calibration_row *row_of(struct calibration *c, const char *check,
                                      const char *part)
{
    int i = 0;
    for (; i < c->rows; i++)
        if (strcmp(c->row[i].check, check) == 0 && !part == !c->row[i].part &&
            (!part || strcmp(c->row[i].part, part) == 0))
            return &c->row[i];
    if (c->rows == CALIBRATION_ROWS_MAX)
        return NULL;
    c->row[c->rows] = (struct calibration_row){ .check = check, .part = part };
    return &c->row[c->rows++];
}

static bool enter(struct calibration *c, const char *check, const char *part,
                  int model, double p, double uniform, long degrees)
{
    struct calibration_row *row = row_of(c, check, part);
    if (!row)
        return false;
    row->cases++;
    row->degrees += (double)degrees;
    for (int k = 0; k < LEVELS; k++)
        row->small[k] += p > calibration_level[k] ? 0 : 1; /* a NaN too */
    if (isnan(uniform))
        return true;
    if (row->values == row->room) {
        const size_t room = 2 * row->room + 256;
        void *grown = realloc(row->value, room * sizeof *row->value);
        if (!grown)
            return false;
        row->value = grown;
        row->room = room;
    }
    row->value[row->values++] = (struct calibration_value){ uniform, model };
    return true;
}

/* Parts of one name are bands, which depend on each other: the first counts. */
static bool repeated(const struct verdict *v, int part)
{
    for (int i = 0; i < part; i++)
        if (strcmp(v->part[i].name, v->part[part].name) == 0)
            return true;
    return false;
}

static bool enter_verdict(struct calibration *c, const struct verdict *v,
                          int model)
{
    if (!v->applies)
        return true;
    if (isnan(v->p)) {
        c->deterministic++;
        c->deterministic_failed += !v->passed;
        return true;
    }
    bool ok = enter(c, v->check, NULL, model, v->p, NAN, 0);
    for (int i = 0; ok && i < v->parts; i++)
        if (!repeated(v, i))
            ok = enter(c, v->check, v->part[i].name, model, v->part[i].p,
                       v->part[i].uniform, v->part[i].degrees);
    return ok;
}

static void keep_failure(struct calibration *c, const struct run *run)
{
    for (size_t i = 0; !c->failure[0] && i < run->results; i++)
        for (int k = 0; !c->failure[0] && k < checks_count(); k++) {
            const struct result *r = &run->result[i];
            const struct verdict *v = &r->verdict[k];
            if (v->applies && !v->passed)
                snprintf(c->failure, sizeof c->failure,
                         "%s, wo %.9g %.9g %.9g, seed %llu: %s: %s",
                         bsdf_spec(r->bsdf), r->wo.x, r->wo.y, r->wo.z,
                         (unsigned long long)run->plan.seed, v->check, v->note);
        }
}

/* Whether further looks, had they been allowed, would have been taken. */
static bool open_still(const struct run *run)
{
    for (size_t i = 0; i < run->results; i++)
        for (int k = 0; k < checks_count(); k++) {
            const struct verdict *v = &run->result[i].verdict[k];
            if (v->applies && v->p < 1e-3)
                return true;
        }
    return run->failed > 0;
}

uint64_t calibration_without_p(void)
{
    static const char *const name[] = { "finite",     "support",  "lobes",
                                        "sample",     "jacobian", "furnace",
                                        "reciprocity" };
    uint64_t skip = 0;
    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        skip |= (uint64_t)1 << checks_find(name[i]);
    return skip;
}

/* One look gives the p-values; it is also the run's verdict unless something is
 * doubtful, when the run is made again with its further looks. */
static bool run_one(struct calibration *c, const struct bsdf *b, int model,
                    size_t round, struct err *err)
{
    enum { MOST = 64 };
    struct vec3 wo[MOST];
    struct run run, further;
    struct plan plan = plan_default;
    const size_t n = c->directions < MOST ? c->directions : MOST;
    plan.seed = c->seed + round;
    plan.samples = c->samples;
    plan.threads = 1;
    plan.escalations = 0;
    if ((round + (size_t)model) % (size_t)c->often)
        plan.skip = calibration_without_p();
    for (size_t i = 0; i < n; i++)
        wo[i] = calibration_direction(plan.seed, (uint64_t)model, i,
                                      bsdf_claims(b).two_sided);
    if (!run_checks(&run, &plan, &b, 1, wo, n, NULL, NULL, err))
        return false;
    const bool again = open_still(&run);
    plan.escalations = plan_default.escalations;
    bool ok =
        !again || run_checks(&further, &plan, &b, 1, wo, n, NULL, NULL, err);
#pragma omp critical(calibration)
    {
        c->runs++;
        c->cases += n;
        c->runs_further += again;
        if (ok && again && further.failed > 0) {
            c->runs_failed++;
            keep_failure(c, &further);
        }
        for (size_t i = 0; ok && i < run.results; i++)
            for (int k = 0; ok && k < checks_count(); k++)
                ok = enter_verdict(c, &run.result[i].verdict[k], model) ||
                     err_set(err, "out of memory");
    }
    if (ok && again)
        run_clear(&further);
    run_clear(&run);
    return ok;
}

static int by_check(const void *a, const void *b)
{
    const struct calibration_row *x = a, *y = b;
    const int apart = checks_find(x->check) - checks_find(y->check);
    return apart      ? apart
           : !x->part ? -1
           : !y->part ? 1
                      : strcmp(x->part, y->part);
}

bool calibration_make(struct calibration *c, run_progress *progress,
                      struct err *err)
{
    enum { MODELS_MAX = 32 };
    struct bsdf *b[MODELS_MAX] = { NULL };
    static const struct bands band = { .count = 1, .nm = { 550 } };
    bool ok = true;
    size_t done = 0;
    c->models = 0;
    while (ok && c->spec[c->models] && c->models < MODELS_MAX) {
        b[c->models] = bsdf_new(c->spec[c->models], &band, err);
        ok = b[c->models++];
    }
    const size_t runs = ok ? c->models * c->rounds : 0;
#pragma omp parallel for schedule(dynamic, 1)
    for (size_t i = 0; i < runs; i++) {
        struct err why;
        const size_t model = i % c->models;
        const bool made = run_one(c, b[model], (int)model, i / c->models, &why);
#pragma omp critical(calibration)
        {
            if (!made)
                ok = err_set(err, "%s", why.text);
            done++;
            if (progress)
                progress(c, done, runs);
        }
    }
    for (size_t i = 0; i < c->models; i++)
        bsdf_free(b[i]);
    qsort(c->row, (size_t)c->rows, sizeof *c->row, by_check);
    return ok;
}

void calibration_clear(struct calibration *c)
{
    for (int i = 0; i < c->rows; i++)
        free(c->row[i].value);
    c->rows = 0;
}

size_t calibration_values(const struct calibration_row *row, int model,
                          double *out)
{
    size_t n = 0;
    for (size_t i = 0; i < row->values; i++)
        if (model < 0 || row->value[i].model == model)
            out[n++] = row->value[i].uniform;
    return n;
}
