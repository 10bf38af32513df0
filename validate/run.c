/* run.c - subjects in parallel, Holm at the end */
#include "validate/run.h"

#include <omp.h>
#include <stdlib.h>

#include "validate/pvalue.h"

static int by_p(const void *a, const void *b)
{
    const double x = (*(struct verdict *const *)a)->p;
    const double y = (*(struct verdict *const *)b)->p;
    return (x > y) - (x < y);
}

void holm(struct verdict **verdict, size_t n, double significance)
{
    bool reject = true;
    double level = significance;
    qsort(verdict, n, sizeof *verdict, by_p);
    for (size_t i = 0; i < n; i++) {
        struct verdict *v = verdict[i];
        if (reject) {
            level = significance / (double)(n - i);
            reject = v->p < level;
        }
        v->passed = !reject;
        v->value = pvalue_sigma(v->p);
        v->limit = pvalue_sigma(level);
    }
}

static bool decide(struct run *run)
{
    const size_t all = run->results * (size_t)checks_count();
    struct verdict **statistical =
        malloc((all ? all : 1) * sizeof *statistical);
    if (!statistical)
        return false;
    for (size_t i = 0; i < run->results; i++)
        for (int c = 0; c < checks_count(); c++) {
            struct verdict *v = &run->result[i].verdict[c];
            if (v->applies && !isnan(v->p))
                statistical[run->statistical++] = v;
        }
    holm(statistical, run->statistical, run->plan.significance);
    free(statistical);
    for (size_t i = 0; i < run->results; i++)
        for (int c = 0; c < checks_count(); c++)
            if (run->result[i].verdict[c].applies)
                ++*(run->result[i].verdict[c].passed ? &run->passed
                                                     : &run->failed);
    return true;
}

bool run_checks(struct run *run, const struct plan *plan,
                const struct bsdf *const *bsdf, size_t bsdfs,
                const struct vec3 *wo, size_t wos, run_progress *progress,
                void *context, struct err *err)
{
    const size_t n = bsdfs * wos, c = (size_t)checks_count();
    *run = (struct run){ .plan = *plan, .results = n };
    run->result = calloc(n ? n : 1, sizeof *run->result);
    for (size_t i = 0; run->result && i < n; i++) {
        run->result[i].bsdf = bsdf[i / wos];
        run->result[i].wo = wo[i % wos];
        run->result[i].verdict = calloc(c, sizeof *run->result[i].verdict);
        if (!run->result[i].verdict) {
            run_clear(run);
            break;
        }
    }
    if (!run->result)
        return err_set(err, "out of memory");

    size_t done = 0;
    bool ok = true;
    const int threads = plan->threads ? plan->threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (size_t i = 0; i < n; i++) {
        struct result *r = &run->result[i];
        struct subject subject;
        struct err why;
        const bool made =
            subject_init(&subject, r->bsdf, r->wo, &run->plan, &why);
        for (int k = 0; made && k < checks_count(); k++)
            r->verdict[k] = check_run(checks[k], &subject);
        if (made)
            subject_clear(&subject);
#pragma omp critical(run_progress)
        {
            done++;
            if (!made) {
                ok = false;
                err_set(err, "%s", why.text);
            }
            if (progress)
                progress(context, done, n);
        }
    }
    if (ok && !decide(run))
        ok = err_set(err, "out of memory");
    if (!ok)
        run_clear(run);
    return ok;
}

void run_clear(struct run *run)
{
    for (size_t i = 0; run->result && i < run->results; i++)
        free(run->result[i].verdict);
    free(run->result);
    *run = (struct run){ .result = NULL };
}

/* Rough models at five roughnesses. */
#define ROUGH(spec)                                                            \
    spec ",alpha=0.001", spec ",alpha=0.01", spec ",alpha=0.1",                \
        spec ",alpha=0.5", spec ",alpha=1"
#define ROUGHCONDUCTOR(distribution, visible)                                  \
    ROUGH("roughconductor:distribution=" distribution                          \
          ",sample_visible=" visible)

const char *const run_all_specs[] = {
    "diffuse",
    "diffuse:reflectance=1",
    "mirror",
    "mirror:reflectance=0.9",
    ROUGHCONDUCTOR("beckmann", "true"),
    ROUGHCONDUCTOR("beckmann", "false"),
    ROUGHCONDUCTOR("ggx", "true"),
    ROUGHCONDUCTOR("ggx", "false"),
    "roughconductor:material=Ca,masking=separable,alpha_u=0.3,alpha_v=0.1",
    "roughconductor:material=Au,fresnel=schlick,alpha=0.25",
    "roughconductor:material=Cu,fresnel=approx,distribution=ggx,alpha=0.25",
    ROUGH("course_microfacet:lambda=exact,fresnel_at=half"),
    NULL,
};

void run_directions(struct vec3 wo[RUN_DIRECTIONS])
{
    static const double theta_deg[RUN_DIRECTIONS] = { 0, 30, 75, 89, 89.9 };
    for (int i = 0; i < RUN_DIRECTIONS; i++)
        wo[i] = dir_from_degrees(theta_deg[i], 40);
}
