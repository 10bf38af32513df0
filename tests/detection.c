/* detection.c - the checks on a broken model, over many seeds */
#include "tests/detection.h"

#include <stdio.h>
#include <string.h>

#include "tests/calibration.h"

/* What was most certain that something is wrong: a check without a p before
 * any with one. */
static struct finder finder_of(const struct run *run)
{
    struct finder best = { "", "", 0 };
    double least = INFINITY;
    for (int k = 0; k < checks_count(); k++) {
        const struct verdict *v = &run->result[0].verdict[k];
        if (!v->applies || v->passed)
            continue;
        if (isnan(v->p) && least > 0) {
            best = (struct finder){ v->check, "", 0 };
            least = 0;
        }
        for (int i = 0; !isnan(v->p) && i < v->parts; i++)
            if (v->part[i].p < least) {
                best = (struct finder){ v->check, v->part[i].name, 0 };
                least = v->part[i].p;
            }
    }
    return best;
}

static void count_finder(struct detection *d, struct finder f)
{
    int i = 0;
    while (i < d->finders && (strcmp(d->finder[i].check, f.check) != 0 ||
                              strcmp(d->finder[i].part, f.part) != 0))
        i++;
    if (i == DETECTION_FINDERS_MAX)
        return;
    if (i == d->finders)
        d->finder[d->finders++] = f;
    d->finder[i].runs++;
}

static long fine_degrees(const struct run *run)
{
    const struct verdict *v = &run->result[0].verdict[checks_find("chi2")];
    for (int i = 0; i < v->parts; i++)
        if (strcmp(v->part[i].name, "fine") == 0)
            return v->part[i].degrees;
    return 0;
}

static bool run_one(struct detection *d, const struct bsdf *b, size_t i,
                    struct err *err)
{
    struct run run;
    struct plan plan = plan_default;
    plan.seed = d->seed + i;
    plan.samples = d->samples;
    plan.threads = 1;
    plan.escalations = 0;
    plan.skip = calibration_without_p();
    plan.unexplained = true;
    if (!run_checks(&run, &plan, &b, 1, &d->wo, 1, NULL, NULL, err))
        return false;
    const long degrees = fine_degrees(&run);
#pragma omp critical(detection)
    {
        if (d->least_degrees < 0 || degrees < d->least_degrees)
            d->least_degrees = degrees;
        d->caught += run.failed > 0;
        if (run.failed > 0)
            count_finder(d, finder_of(&run));
    }
    run_clear(&run);
    return true;
}

bool detection_make(struct detection *d, run_progress *progress, void *context,
                    struct err *err)
{
    struct bsdf *b = bsdf_new_of(d->type, d->settings, &bands_default, err);
    bool ok = b;
    size_t done = 0;
    d->caught = 0;
    d->finders = 0;
    d->least_degrees = -1;
    const size_t runs = ok ? d->runs : 0;
#pragma omp parallel for schedule(dynamic, 1)
    for (size_t i = 0; i < runs; i++) {
        struct err why;
        const bool made = run_one(d, b, i, &why);
#pragma omp critical(detection)
        {
            if (!made)
                ok = err_set(err, "%s", why.text);
            done++;
            if (progress)
                progress(context, done, runs);
        }
    }
    bsdf_free(b);
    return ok;
}

double detection_refused(const struct bsdf *b, struct vec3 wo)
{
    enum { DRAWS = 65536, BATCH = 1024 };
    struct bsdf_sample sample[BATCH];
    const struct subject s = subject_plain(b, wo, &plan_default);
    size_t refused = 0;
    for (uint64_t first = 0; first < DRAWS; first += BATCH) {
        subject_draw(&s, subject_rng(&s, STREAM_PAIRS), first, BATCH, sample);
        for (size_t i = 0; i < BATCH; i++)
            refused += subject_refused(&sample[i]);
    }
    return (double)refused / DRAWS;
}
