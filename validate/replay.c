/* replay.c - the same pairs of model and direction, compared field by field */
#include "validate/replay.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/cli.h"
#include "bsdf/utf8.h"
#include "validate/foreign.h"
#include "validate/report.h"

/* The number of the spec among the models of the report, or -1. */
static long model_find(const struct recorded *r, const char *spec,
                       struct err *err)
{
    const bool counted = spec[0] && strspn(spec, "0123456789") == strlen(spec);
    if (counted) {
        uint64_t n;
        if (r->models == 0)
            return err_set(err, "--spec %s: the report has no model", spec) - 1;
        return cli_count(&n, "--spec", spec, 1, r->models, err) ? (long)n - 1
                                                                : -1;
    }
    for (size_t i = 0; i < r->results; i++)
        if (strcmp(r->result[i].spec, spec) == 0)
            return (long)r->result[i].model;
    err_set(err,
            "--spec \"%.200s\": expected a spec of the report, or its number "
            "in [1, %zu]",
            spec, r->models);
    return -1;
}

static bool skips_read(struct recorded *r, const char *path, struct err *err)
{
    for (size_t i = 0; i < r->skips; i++) {
        const int check = checks_find(r->skip[i]);
        if (check < 0) {
            char *plain = utf8_plain(r->skip[i]);
            err_set(err,
                    "%s: skipped[%zu] is \"%.60s\"; expected the name of a "
                    "check",
                    path, i, plain ? plain : "?");
            free(plain);
            return false;
        }
        r->plan.skip |= (uint64_t)1 << check;
    }
    return true;
}

/* One instance a model, in the order of the report. */
static bool models_make(struct replay *r, const char *path, bool programs,
                        struct err *err)
{
    const struct recorded *old = &r->recorded;
    struct err why;
    r->bsdf = calloc(old->models + 1, sizeof *r->bsdf);
    if (!r->bsdf)
        return err_set(err, "out of memory");
    for (size_t i = 0; i < old->results; i++) {
        const struct recorded_result *one = &old->result[i];
        if (r->bsdf[one->model])
            continue;
        if (one->repaired)
            return err_set(err,
                           "%s: results[%zu].spec had bytes that are no UTF-8, "
                           "which the report shows as \\xHH; it cannot be made "
                           "again",
                           path, i);
        r->bsdf[one->model] =
            foreign_recorded(one->spec, &old->bands, programs, &why);
        if (!r->bsdf[one->model])
            return err_set(err, "%s: results[%zu].spec: %s", path, i, why.text);
    }
    return true;
}

static bool run_again(struct replay *r, int threads, run_progress *progress,
                      void *context, struct err *err)
{
    const struct recorded *old = &r->recorded;
    struct plan plan = old->plan;
    struct run_pair *pair = calloc(old->results + 1, sizeof *pair);
    if (!pair)
        return err_set(err, "out of memory");
    for (size_t i = 0; i < old->results; i++)
        pair[i] = (struct run_pair){ r->bsdf[old->result[i].model],
                                     old->result[i].wo };
    plan.threads = threads;
    const bool ok =
        run_pairs(&r->run, &plan, pair, old->results, progress, context, err);
    free(pair);
    return ok;
}

/* -- comparing ------------------------------------------------------------- */

/* A value in a few words; owned by the caller. */
static char *brief(const json_t *json)
{
    char *text = json ? json_dumps(json, JSON_ENCODE_ANY | JSON_COMPACT)
                      : strdup("missing");
    char *plain = text ? utf8_plain(text) : NULL;
    free(text);
    return plain;
}

static void differ(struct replay *r, const char *path, const json_t *was,
                   const json_t *is)
{
    char *a = brief(was), *b = brief(is);
    if (r->same)
        err_set(&r->differs, "%s was %.300s, and is now %.300s", path,
                a ? a : "?", b ? b : "?");
    r->same = false;
    free(a);
    free(b);
}

/* Every field of a verdict; theta and phi follow from xyz. */
static void compare(struct replay *r, size_t i, size_t k, const json_t *was,
                    json_t *is)
{
    char path[128];
    const char *key;
    json_t *now;
    json_object_foreach(is, key, now)
    {
        const json_t *then = json_object_get(was, key);
        if (json_equal(then, now))
            continue;
        snprintf(path, sizeof path, "results[%zu].verdicts[%zu] (%s).%s", i, k,
                 json_string_value(json_object_get(is, "check")), key);
        differ(r, path, then, now);
    }
}

static void compare_result(struct replay *r, size_t i, const json_t *now)
{
    char path[64];
    const json_t *was = r->recorded.result[i].json;
    const json_t *is = json_object_get(json_array_get(now, i), "verdicts");
    const size_t n = json_array_size(is);
    if (json_array_size(was) != n) {
        snprintf(path, sizeof path, "the number of results[%zu].verdicts", i);
        json_t *a = json_integer((json_int_t)json_array_size(was));
        json_t *b = json_integer((json_int_t)n);
        differ(r, path, a, b);
        json_decref(a);
        json_decref(b);
    }
    for (size_t k = 0; r->same && k < n; k++) {
        compare(r, i, k, json_array_get(was, k), json_array_get(is, k));
        r->compared++;
    }
}

/* Compares the results of a model, or of all where it is negative, and
 * collects those that fail. */
static bool compare_all(struct replay *r, long model, struct err *err)
{
    const struct run *run = &r->run;
    json_t *report = report_json_of(run, 0, NULL);
    const json_t *now = json_object_get(report, "results");
    r->shown = *run;
    r->shown.passed = r->shown.failed = r->shown.results = 0;
    r->shown.result = calloc(run->results + 1, sizeof *r->shown.result);
    r->same = true;
    for (size_t i = 0; report && r->shown.result && i < run->results; i++) {
        if (model >= 0 && r->recorded.result[i].model != (size_t)model)
            continue;
        size_t failed = 0;
        compare_result(r, i, now);
        for (int c = 0; c < checks_count(); c++) {
            const struct verdict *v = &run->result[i].verdict[c];
            failed += v->applies && !v->passed;
            r->shown.passed += v->applies && v->passed;
        }
        r->shown.failed += failed;
        if (failed > 0)
            r->shown.result[r->shown.results++] = run->result[i];
    }
    const bool ok = report && r->shown.result;
    json_decref(report);
    return ok || err_set(err, "out of memory");
}

bool replay_run(struct replay *r, const char *path, const char *spec,
                int threads, bool programs, run_progress *progress,
                void *context, struct err *err)
{
    *r = (struct replay){ .same = false };
    if (!recorded_read(&r->recorded, path, err))
        return false;
    const struct recorded *old = &r->recorded;
    const long model = spec ? model_find(old, spec, err) : -1;
    bool ok = (!spec || model >= 0) && skips_read(&r->recorded, path, err);
    if (ok && old->ior_path && !getenv("BSDF_IOR_PATH"))
        ok = cli_ior_path(old->ior_path, err);
    ok = ok && models_make(r, path, programs, err) &&
         run_again(r, threads, progress, context, err) &&
         compare_all(r, model, err);
    if (!ok)
        replay_clear(r);
    return ok;
}

void replay_clear(struct replay *r)
{
    free(r->shown.result);
    run_clear(&r->run);
    for (size_t i = 0; r->bsdf && i < r->recorded.models; i++)
        bsdf_free(r->bsdf[i]);
    free(r->bsdf);
    recorded_clear(&r->recorded);
    *r = (struct replay){ .same = false };
}
