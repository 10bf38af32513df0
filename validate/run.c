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
    const size_t c = (size_t)checks_count();
    *run = (struct run){ .plan = *plan };
    run->result = calloc(bsdfs * (wos ? wos : RUN_DIRECTIONS_MAX) + 1,
                         sizeof *run->result);
    bool ok = run->result;
    for (size_t i = 0; ok && i < bsdfs; i++) {
        struct vec3 own[RUN_DIRECTIONS_MAX];
        const size_t count = wos ? wos : run_directions(bsdf[i], own);
        for (size_t k = 0; ok && k < count; k++) {
            struct result *r = &run->result[run->results++];
            r->bsdf = bsdf[i];
            r->wo = wos ? wo[k] : own[k];
            r->verdict = calloc(c, sizeof *r->verdict);
            ok = r->verdict;
        }
    }
    if (!ok) {
        run_clear(run);
        return err_set(err, "out of memory");
    }

    size_t done = 0;
    const size_t n = run->results;
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

#define ROUGHDIELECTRIC(distribution, visible)                                 \
    ROUGH("roughdielectric:distribution=" distribution                         \
          ",sample_visible=" visible)

const char *const run_all_specs[] = {
    "diffuse",
    "diffuse:reflectance=1",
    "mirror",
    "mirror:reflectance=0.9",
    "conductor:material=Au",
    "refraction",
    "dielectric",
    "dielectric:int_ior=1,ext_ior=1.5",
    "dielectric:int_ior=1,ext_ior=1",
    "dielectric:fresnel=schlick",
    "dielectric:lobes=reflection",
    "dielectric:lobes=transmission",
    "thindielectric",
    "thindielectric:int_ior=1,ext_ior=1",
    ROUGHCONDUCTOR("beckmann", "true"),
    ROUGHCONDUCTOR("beckmann", "false"),
    ROUGHCONDUCTOR("ggx", "true"),
    ROUGHCONDUCTOR("ggx", "false"),
    "roughconductor:material=Ca,masking=separable,alpha_u=0.3,alpha_v=0.1",
    "roughconductor:material=Au,fresnel=schlick,alpha=0.25",
    "roughconductor:material=Cu,fresnel=approx,distribution=ggx,alpha=0.25",
    ROUGHDIELECTRIC("beckmann", "true"),
    ROUGHDIELECTRIC("ggx", "false"),
    "roughdielectric:int_ior=1,ext_ior=1",
    "roughdielectric:int_ior=1.05,ext_ior=1",
    "roughdielectric:masking=separable,alpha_u=0.3,alpha_v=0.1",
    "roughdielectric:lobes=reflection",
    "roughdielectric:lobes=transmission",
    "twosided:front=(diffuse),back=(roughconductor)",
    "blendbsdf:weight=0.3,bsdf_0=(diffuse),bsdf_1=(roughdielectric)",
    "blendbsdf:weight=0.3,bsdf_0=(mirror),bsdf_1=(roughconductor:alpha=0.3)",
    "course_mirror",
    "course_refraction:factor=right",
    "course_glass:factor=right,schlick_at=thinner",
    ROUGH("course_microfacet:lambda=exact,fresnel_at=half"),
    NULL,
};

size_t run_directions(const struct bsdf *b, struct vec3 wo[RUN_DIRECTIONS_MAX])
{
    static const double theta_deg[] = { 0, 30, 75, 89, 89.9 };
    const struct bsdf_claims claims = bsdf_claims(b);
    size_t n = 0;
    for (int i = 0; i < 5; i++) {
        wo[n++] = dir_from_degrees(theta_deg[i], 40);
        if (claims.two_sided)
            wo[n++] = dir_from_degrees(180 - theta_deg[i], 40);
    }
    if (claims.two_sided && (claims.lobes & BSDF_TRANSMISSION) &&
        claims.eta != 1) {
        const double critical_deg =
            asin(fmin(claims.eta, 1 / claims.eta)) * (180 / PI);
        wo[n++] = dir_from_degrees(
            claims.eta > 1 ? 180 - critical_deg : critical_deg, 40);
    }
    return n;
}
