/* run.c - subjects in parallel, Holm at the end */
#include "validate/run.h"

#include <omp.h>
#include <stdlib.h>

#include "validate/diagnosis.h"
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

/* Fresh samples count as a confirmation below this, and a result below it that
 * is not rejected is doubtful. */
static const double doubtful = 1e-3;

static struct verdict *verdict_at(const struct run *run, size_t i)
{
    const size_t c = (size_t)checks_count();
    return &run->result[i / c].verdict[i % c];
}

static bool statistical(const struct verdict *v)
{
    return v->applies && !isnan(v->p);
}

/* What fresh samples could change. */
static bool open_still(const struct verdict *v)
{
    return statistical(v) && v->p > pvalue_impossible && !v->confirmed &&
           (!v->passed || v->p < doubtful);
}

/* Holm's procedure over those of the run that are marked. */
static bool decide(struct run *run, const bool *marked, double significance)
{
    const size_t all = run->results * (size_t)checks_count();
    struct verdict **list = malloc((all + 1) * sizeof *list);
    size_t n = 0;
    for (size_t i = 0; list && i < all; i++)
        if (marked[i])
            list[n++] = verdict_at(run, i);
    if (list)
        holm(list, n, significance);
    free(list);
    return list;
}

/* One more look at an open verdict, with what fresh samples say. */
static bool judge_again(struct verdict *v, const struct verdict *fresh)
{
    if (!v->passed && fresh->p < doubtful) {
        v->confirmed = true;
        verdict_add(v, "; confirmed on %.3g fresh samples, p %.2g",
                    (double)fresh->samples, fresh->p);
        return false;
    }
    *v = *fresh;
    return true;
}

struct looked {
    struct run *run;
    bool *marked; /* one a verdict: open before, to be decided after */
    int stage;    /* 0: everything */
    run_progress *progress;
    void *context;
    size_t done, of;
    bool ok;
    struct err *err;
};

static void look_at(struct looked *l, size_t i)
{
    struct run *run = l->run;
    struct result *r = &run->result[i];
    struct subject subject;
    struct err why;
    const uint64_t samples = run->plan.samples << (2 * l->stage);
    const bool made = subject_init_stage(&subject, r->bsdf, r->wo, &run->plan,
                                         l->stage, samples, &why);
    for (int k = 0; made && k < checks_count(); k++) {
        bool *marked = &l->marked[i * (size_t)checks_count() + (size_t)k];
        if (l->stage == 0) {
            r->verdict[k] = check_run(k, &subject);
            *marked = statistical(&r->verdict[k]);
        } else if (*marked) {
            const struct verdict fresh = check_run(k, &subject);
            *marked = judge_again(&r->verdict[k], &fresh);
        }
    }
    if (made)
        subject_clear(&subject);
#pragma omp critical(run_progress)
    {
        l->done++;
        if (!made)
            l->ok = err_set(l->err, "%s", why.text);
        if (l->progress)
            l->progress(l->context, l->done, l->of);
    }
}

static bool wanted(const struct looked *l, size_t i)
{
    const size_t c = (size_t)checks_count();
    bool any = l->stage == 0;
    for (size_t k = 0; k < c; k++)
        any |= l->marked[i * c + k];
    return any;
}

/* Looks at what is marked, in parallel; no subject depends on another. */
static bool look(struct looked *l)
{
    const size_t n = l->run->results;
    const int threads = l->run->plan.threads;
    for (size_t i = 0; i < n; i++)
        l->of += wanted(l, i);
#pragma omp parallel for schedule(dynamic, 1)                                  \
    num_threads(threads ? threads : omp_get_max_threads())
    for (size_t i = 0; i < n; i++)
        if (wanted(l, i))
            look_at(l, i);
    return l->ok;
}

/* The first look, and further ones at what is open, each with four times the
 * samples, fresh, at half the significance that was left. */
static bool run_stages(struct run *run, run_progress *progress, void *context,
                       struct err *err)
{
    const size_t all = run->results * (size_t)checks_count();
    struct looked l = { .run = run,
                        .marked = calloc(all + 1, sizeof *l.marked),
                        .progress = progress,
                        .context = context,
                        .ok = true,
                        .err = err };
    bool ok = l.marked;
    if (!ok)
        err_set(err, "out of memory");
    double left = run->plan.significance;
    for (l.stage = 0; ok && l.stage <= run->plan.escalations; l.stage++) {
        size_t marked = 0;
        for (size_t i = 0; l.stage > 0 && i < all; i++)
            marked += l.marked[i] = open_still(verdict_at(run, i));
        if (l.stage > 0 && marked == 0)
            break;
        if (l.stage < run->plan.escalations)
            left /= 2;
        ok = look(&l) &&
             (decide(run, l.marked, left) || err_set(err, "out of memory"));
        for (size_t i = 0; l.stage > 0 && i < all; i++)
            if (l.marked[i])
                verdict_at(run, i)->confirmed = !verdict_at(run, i)->passed;
    }
    free(l.marked);
    return ok;
}

/* Looks at each result with a failure once more, to find out why. */
static bool diagnoses(struct run *run, struct err *err)
{
    const int threads = run->plan.threads;
    bool ok = true;
#pragma omp parallel for schedule(dynamic, 1)                                  \
    num_threads(threads ? threads : omp_get_max_threads())
    for (size_t i = 0; i < run->results; i++) {
        struct result *r = &run->result[i];
        struct subject subject;
        struct err why;
        bool any = false;
        for (int c = 0; c < checks_count(); c++)
            any |= r->verdict[c].applies && !r->verdict[c].passed;
        if (!any)
            continue;
        if (subject_init(&subject, r->bsdf, r->wo, &run->plan, &why)) {
            diagnose(&subject, r->verdict);
            subject_clear(&subject);
        } else {
#pragma omp critical(run_progress)
            ok = err_set(err, "%s", why.text);
        }
    }
    return ok;
}

static void count(struct run *run)
{
    const size_t all = run->results * (size_t)checks_count();
    for (size_t i = 0; i < all; i++) {
        const struct verdict *v = verdict_at(run, i);
        run->passed += v->applies && v->passed;
        run->failed += v->applies && !v->passed;
        run->statistical += statistical(v);
    }
}

/* What each that passed would have found at the first look. */
static void effects(struct run *run)
{
    const size_t all = run->results * (size_t)checks_count();
    const double share = run->plan.escalations > 0 ? 0.5 : 1;
    for (size_t i = 0; i < all; i++) {
        struct verdict *v = verdict_at(run, i);
        if (!v->applies || !v->passed)
            v->effect[0] = '\0';
        else if (statistical(v))
            verdict_effect(v, share * run->plan.significance /
                                  (double)run->statistical);
    }
}

bool run_pairs(struct run *run, const struct plan *plan,
               const struct run_pair *pair, size_t pairs,
               run_progress *progress, void *context, struct err *err)
{
    *run = (struct run){ .plan = *plan };
    run->result = calloc(pairs + 1, sizeof *run->result);
    bool ok = run->result;
    for (size_t i = 0; ok && i < pairs; i++) {
        struct result *r = &run->result[run->results++];
        r->bsdf = pair[i].bsdf;
        r->wo = pair[i].wo;
        r->verdict = calloc((size_t)checks_count(), sizeof *r->verdict);
        ok = r->verdict;
    }
    if (!ok)
        err_set(err, "out of memory");
    ok = ok && run_stages(run, progress, context, err) &&
         (plan->unexplained || diagnoses(run, err));
    if (!ok) {
        run_clear(run);
        return false;
    }
    count(run);
    effects(run);
    return true;
}

bool run_checks(struct run *run, const struct plan *plan,
                const struct bsdf *const *bsdf, size_t bsdfs,
                const struct vec3 *wo, size_t wos, run_progress *progress,
                void *context, struct err *err)
{
    struct run_pair *pair =
        calloc(bsdfs * (wos ? wos : RUN_DIRECTIONS_MAX) + 1, sizeof *pair);
    size_t pairs = 0;
    *run = (struct run){ .result = NULL };
    if (!pair)
        return err_set(err, "out of memory");
    for (size_t i = 0; i < bsdfs; i++) {
        struct vec3 own[RUN_DIRECTIONS_MAX];
        const size_t n = wos ? wos : run_directions(bsdf[i], own);
        for (size_t k = 0; k < n; k++)
            pair[pairs++] = (struct run_pair){ bsdf[i], wos ? wo[k] : own[k] };
    }
    const bool ok = run_pairs(run, plan, pair, pairs, progress, context, err);
    free(pair);
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
