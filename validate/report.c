/* report.c - what a run found, as a table for people */
#include "validate/report.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool report_worse(const struct verdict *a, const struct verdict *b)
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
                if (report_worse(&run->result[i].verdict[c],
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
