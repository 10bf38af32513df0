/* report_json.c - a run as JSON
 *
 * report.schema.json says what there is; recorded.c reads it back.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/cli.h"
#include "bsdf/outfile.h"
#include "bsdf/utf8.h"
#include "validate/report.h"

const char report_pass[] = "pass", report_fail[] = "fail",
           report_none[] = "not applicable";

static json_t *number(double x)
{
    return isfinite(x) ? json_real(x) : json_null();
}

static json_t *text(const char *bytes)
{
    json_t *s = json_string(bytes);
    if (s)
        return s;
    char *plain = utf8_plain(bytes);
    s = plain ? json_string(plain) : NULL;
    free(plain);
    return s;
}

static json_t *text_or_null(const char *bytes)
{
    return bytes && bytes[0] ? text(bytes) : json_null();
}

/* A value that is not worth a word is null. */
static json_t *unless(bool absent, json_t *value)
{
    if (!absent)
        return value;
    json_decref(value);
    return json_null();
}

static json_t *direction(struct vec3 w)
{
    const struct angles a = dir_to_degrees(w);
    return json_pack("{s:o, s:o, s:[o, o, o]}", "theta_deg",
                     number(a.theta_deg), "phi_deg", number(a.phi_deg), "xyz",
                     number(w.x), number(w.y), number(w.z));
}

static json_t *parts(const struct verdict *v)
{
    json_t *all = json_array();
    for (int i = 0; i < v->parts; i++)
        json_array_append_new(all, json_pack("{s:o, s:o}", "name",
                                             text(v->part[i].name), "p",
                                             number(v->part[i].p)));
    return all;
}

static json_t *verdict_json(const struct verdict *v)
{
    const bool none = !v->applies;
    return json_pack(
        "{s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, "
        "s:o, s:o, s:o}",
        "check", v->check, "verdict",
        none        ? report_none
        : v->passed ? report_pass
                    : report_fail,
        "value", unless(none, number(v->value)), "limit",
        unless(none, number(v->limit)), "error", unless(none, number(v->error)),
        "unit", none ? json_null() : text_or_null(v->unit), "p",
        unless(none, number(v->p)), "samples",
        unless(none, json_integer((json_int_t)v->samples)), "confirmed",
        unless(none, json_boolean(v->confirmed)), "wo",
        unless(none, direction(v->wo)), "wi",
        unless(none || !v->has_wi, direction(v->wi)), "note",
        text_or_null(v->note), "effect",
        none ? json_null() : text_or_null(v->effect), "effect_size",
        unless(none || !v->effect[0], number(v->effect_size)), "diagnosis",
        none ? json_null() : text_or_null(v->diagnosis), "parts", parts(v));
}

static json_t *result_json(const struct result *r)
{
    json_t *verdicts = json_array();
    const char *spec = bsdf_spec(r->bsdf);
    json_t *exact = json_string(spec);
    const bool repaired = !exact;
    json_decref(exact);
    for (int c = 0; c < checks_count(); c++)
        json_array_append_new(verdicts, verdict_json(&r->verdict[c]));
    return json_pack("{s:o, s:b, s:o, s:o}", "spec", text(spec), "repaired",
                     (int)repaired, "wo", direction(r->wo), "verdicts",
                     verdicts);
}

/* "fit" or "average", null where the bands are wavelengths. */
static json_t *rgb(const struct bands *bands)
{
    return !bands || bands->kind == BANDS_NM  ? json_null()
           : bands->kind == BANDS_RGB_AVERAGE ? json_string("average")
                                              : json_string("fit");
}

static json_t *wavelengths(const struct bands *bands)
{
    if (!bands || bands->kind != BANDS_NM)
        return json_null();
    json_t *nm = json_array();
    for (int b = 0; b < bands->count; b++)
        json_array_append_new(nm, json_real(bands->nm[b]));
    return nm;
}

static json_t *band_names(const struct bands *bands)
{
    json_t *names = json_array();
    char name[32];
    for (int b = 0; bands && b < bands->count; b++) {
        bands_print_one(bands, b, name, sizeof name);
        json_array_append_new(names, json_string(name));
    }
    return names;
}

static json_t *skipped(const struct plan *plan)
{
    json_t *names = json_array();
    for (int c = 0; c < checks_count(); c++)
        if (plan->skip >> c & 1)
            json_array_append_new(names, json_string(checks[c]->name));
    return names;
}

json_t *report_json_of(const struct run *run, int words, char *const *word)
{
    const struct plan *plan = &run->plan;
    const struct bands *bands =
        run->results > 0 ? bsdf_bands(run->result[0].bsdf) : NULL;
    json_t *command = json_array(), *results = json_array();
    for (int i = 0; i < words; i++)
        json_array_append_new(command, text(word[i]));
    for (size_t i = 0; i < run->results; i++)
        json_array_append_new(results, result_json(&run->result[i]));
    return json_pack(
        "{s:i, s:s, s:s, s:o, s:I, s:I, s:o, s:i, s:o, s:o, s:o, s:o, s:o, "
        "s:I, s:I, s:I, s:o}",
        "schema", REPORT_SCHEMA, "program", "bsdf-validate", "version",
        BSDF_VERSION, "command", command, "seed", (json_int_t)plan->seed,
        "samples", (json_int_t)plan->samples, "significance",
        number(plan->significance), "escalations", plan->escalations, "skipped",
        skipped(plan), "bands", band_names(bands), "rgb", rgb(bands), "nm",
        wavelengths(bands), "ior_path", text_or_null(getenv("BSDF_IOR_PATH")),
        "passed", (json_int_t)run->passed, "failed", (json_int_t)run->failed,
        "statistical", (json_int_t)run->statistical, "results", results);
}

bool report_json(const char *path, const struct run *run, int words,
                 char *const *word, struct err *err)
{
    struct outfile out;
    json_t *root = report_json_of(run, words, word);
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
