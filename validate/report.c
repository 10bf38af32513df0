/* report.c - what a run found */
#include "validate/report.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bsdf/cli.h"
#include "bsdf/outfile.h"

/* Failures before passes, then the least room below the limit; a check without
 * a word on one direction may have one on another. */
static bool worse(const struct verdict *a, const struct verdict *b)
{
    if (!a->applies || !b->applies)
        return a->applies;
    if (a->passed != b->passed)
        return !a->passed;
    const double x = a->limit > 0 ? a->value / a->limit : a->value;
    const double y = b->limit > 0 ? b->value / b->limit : b->value;
    return x > y || (isnan(x) && !isnan(y));
}

static void direction_text(char *text, size_t size, struct vec3 w)
{
    const struct angles a = dir_to_degrees(w);
    snprintf(text, size, "%.7g,%.5g", a.theta_deg, a.phi_deg);
}

/* Colours, or nothing where nobody would see them. */
struct paint {
    const char *good, *bad, *plain;
};

static struct paint paint_for(FILE *out)
{
    const char *no = getenv("NO_COLOR"); /* no-color.org */
    const bool terminal = isatty(fileno(out)) && !(no && no[0]);
    return terminal ? (struct paint){ "\033[32m", "\033[1;31m", "\033[0m" }
                    : (struct paint){ "", "", "" };
}

static void row(FILE *out, const struct verdict *v, bool verbose)
{
    const struct paint paint = paint_for(out);
    char wo[40] = "", p[16] = "-", value[16] = "-", limit[16] = "-";
    direction_text(wo, sizeof wo, v->wo);
    if (v->applies) {
        snprintf(value, sizeof value, "%.6g", v->value);
        snprintf(limit, sizeof limit, "%.4g", v->limit);
        if (!isnan(v->p))
            snprintf(p, sizeof p, "%.2g", v->p);
    } else {
        strcpy(wo, "-");
    }
    fprintf(out, "  %-12s %-12s %-10s %-10s %-10s %-9s %s%s%s  %s\n", v->check,
            wo, value, limit, v->unit[0] && v->applies ? v->unit : "-", p,
            !v->applies ? ""
            : v->passed ? paint.good
                        : paint.bad,
            !v->applies ? "n/a "
            : v->passed ? "pass"
                        : "FAIL",
            v->applies ? paint.plain : "", v->note);
    if (v->applies && !v->passed && v->has_wi) {
        char wi[40];
        direction_text(wi, sizeof wi, v->wi);
        fprintf(out, "  %-12s at wi = %s\n", "", wi);
    }
    if (v->diagnosis[0])
        fprintf(out, "  %-12s probably: %s\n", "", v->diagnosis);
    if (verbose && v->effect[0])
        fprintf(out, "  %-12s would have found: %s\n", "", v->effect);
}

/* What a model's passes would have found, by check, from the direction where
 * that is least. */
static void found(FILE *out, const struct run *run, size_t first, size_t last)
{
    bool any = false;
    for (int c = 0; c < checks_count(); c++) {
        const struct verdict *worst = NULL;
        for (size_t i = first; i < last; i++) {
            const struct verdict *v = &run->result[i].verdict[c];
            if (v->effect[0] && (!worst || v->effect_size > worst->effect_size))
                worst = v;
        }
        if (!worst)
            continue;
        if (!any)
            fprintf(out, "  These passes would have found, 99 times of 100:\n");
        any = true;
        fprintf(out, "    %-12s %s\n", checks[c]->name, worst->effect);
    }
}

void report_text(FILE *out, const struct run *run, bool verbose)
{
    char bands[96];
    if (run->results > 0) {
        bands_print(bsdf_bands(run->result[0].bsdf), bands, sizeof bands);
        fprintf(out,
                "bands %s; seed %llu, %llu samples a direction, run-level "
                "significance %g (Holm over %zu p-values)\n",
                bands, (unsigned long long)run->plan.seed,
                (unsigned long long)run->plan.samples, run->plan.significance,
                run->statistical);
    }
    for (size_t first = 0; first < run->results;) {
        size_t last = first;
        while (last < run->results &&
               run->result[last].bsdf == run->result[first].bsdf)
            last++;
        fprintf(out, "\n%s\n", bsdf_spec(run->result[first].bsdf));
        fprintf(out, "  %-12s %-12s %-10s %-10s %-10s %-9s %s\n", "check",
                verbose ? "wo" : "worst wo", "value", "limit", "unit", "p",
                "verdict");
        for (int c = 0; c < checks_count(); c++) {
            size_t worst = first;
            for (size_t i = first; i < last; i++) {
                if (verbose)
                    row(out, &run->result[i].verdict[c], true);
                if (worse(&run->result[i].verdict[c],
                          &run->result[worst].verdict[c]))
                    worst = i;
            }
            if (!verbose)
                row(out, &run->result[worst].verdict[c], false);
        }
        found(out, run, first, last);
        first = last;
    }
    fprintf(out, "\n%zu passed, %zu failed\n", run->passed, run->failed);
}

static json_t *number(double x)
{
    return isfinite(x) ? json_real(x) : json_null();
}

static json_t *direction(struct vec3 w)
{
    const struct angles a = dir_to_degrees(w);
    return json_pack("{s:f, s:f, s:[f, f, f]}", "theta_deg", a.theta_deg,
                     "phi_deg", a.phi_deg, "xyz", w.x, w.y, w.z);
}

/* A spec may hold bytes that are no UTF-8; they become question marks. */
static json_t *text(const char *bytes)
{
    json_t *s = json_string(bytes);
    if (s)
        return s;
    char *copy = strdup(bytes);
    for (char *p = copy; p && *p; p++)
        if ((unsigned char)*p >= 0x80)
            *p = '?';
    s = copy ? json_string(copy) : NULL;
    free(copy);
    return s;
}

static json_t *verdict_json(const struct verdict *v)
{
    if (!v->applies)
        return json_pack("{s:s, s:s, s:o}", "check", v->check, "verdict",
                         "not applicable", "note", text(v->note));
    json_t *o = json_pack(
        "{s:s, s:s, s:o, s:o, s:o, s:s, s:o, s:o, s:o}", "check", v->check,
        "verdict", v->passed ? "pass" : "fail", "value", number(v->value),
        "limit", number(v->limit), "error", number(v->error), "unit", v->unit,
        "p", number(v->p), "wo", direction(v->wo), "note", text(v->note));
    if (o && v->has_wi && isfinite(v->wi.x + v->wi.y + v->wi.z))
        json_object_set_new(o, "wi", direction(v->wi));
    return o;
}

static json_t *run_json(const struct run *run)
{
    json_t *results = json_array();
    for (size_t i = 0; i < run->results; i++) {
        const struct result *r = &run->result[i];
        json_t *verdicts = json_array();
        for (int c = 0; c < checks_count(); c++)
            json_array_append_new(verdicts, verdict_json(&r->verdict[c]));
        json_array_append_new(results, json_pack("{s:o, s:o, s:o}", "spec",
                                                 text(bsdf_spec(r->bsdf)), "wo",
                                                 direction(r->wo), "verdicts",
                                                 verdicts));
    }
    json_t *bands = json_array();
    char name[32];
    for (int b = 0;
         run->results > 0 && b < bsdf_bands(run->result[0].bsdf)->count; b++) {
        bands_print_one(bsdf_bands(run->result[0].bsdf), b, name, sizeof name);
        json_array_append_new(bands, json_string(name));
    }
    return json_pack("{s:s, s:s, s:I, s:I, s:f, s:o, s:I, s:I, s:o}", "program",
                     "bsdf-validate", "version", BSDF_VERSION, "seed",
                     (json_int_t)run->plan.seed, "samples",
                     (json_int_t)run->plan.samples, "significance",
                     run->plan.significance, "bands", bands, "passed",
                     (json_int_t)run->passed, "failed", (json_int_t)run->failed,
                     "results", results);
}

bool report_json(const char *path, const struct run *run, struct err *err)
{
    struct outfile out;
    json_t *root = run_json(run);
    if (!root)
        return err_set(err, "%s: the report could not be made", path);
    bool ok = outfile_open(&out, path, err);
    if (ok) {
        const bool dumped = json_dumpf(root, out.stream, JSON_INDENT(1)) == 0 &&
                            fputc('\n', out.stream) != EOF;
        if (dumped)
            ok = outfile_close(&out, err);
        else {
            ok = err_set(err, "%s: cannot be written", path);
            outfile_abandon(&out);
        }
    }
    json_decref(root);
    return ok;
}
