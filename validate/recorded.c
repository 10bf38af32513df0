/* recorded.c - reading a report */
#include "validate/recorded.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/utf8.h"
#include "validate/report.h"

/* Where a value is: a member of the value above, or an element of it. */
struct node {
    const struct node *above;
    const char *key; /* NULL for an element */
    size_t index;
    const json_t *json; /* NULL if it is not there */
    struct reader *reader;
};

/* Stops at the first thing that is wrong. */
struct reader {
    const char *path;
    struct err *err;
    bool ok;
};

static void path_print(FILE *out, const struct node *n)
{
    if (!n->above)
        return;
    path_print(out, n->above);
    if (!n->key)
        fprintf(out, "[%zu]", n->index);
    else
        fprintf(out, "%s%s", n->above->above ? "." : "", n->key);
}

/* What is there, in a few words; owned by the caller. */
static char *described(const json_t *json)
{
    if (!json)
        return strdup("is missing");
    if (json_is_object(json))
        return strdup("is an object");
    if (json_is_array(json))
        return strdup("is an array");
    char *text = json_dumps(json, JSON_ENCODE_ANY), *is = NULL;
    if (asprintf(&is, "is %.60s%s", text ? text : "?",
                 text && strlen(text) > 60 ? "..." : "") < 0)
        is = NULL;
    free(text);
    return is;
}

static void wrong(const struct node *n, const char *expected)
{
    char *path = NULL, *is = described(n->json);
    char *plain = is ? utf8_plain(is) : NULL;
    size_t size;
    FILE *out = open_memstream(&path, &size);
    if (out) {
        path_print(out, n);
        fclose(out);
    }
    if (n->reader->ok)
        err_set(n->reader->err, "%s: %s %s; expected %s", n->reader->path,
                path && *path ? path : "the whole", plain ? plain : "?",
                expected);
    n->reader->ok = false;
    free(path);
    free(is);
    free(plain);
}

static struct node member(const struct node *above, const char *key)
{
    return (struct node){ .above = above,
                          .key = key,
                          .json = json_object_get(above->json, key),
                          .reader = above->reader };
}

static struct node element(const struct node *above, size_t i)
{
    return (struct node){ .above = above,
                          .index = i,
                          .json = json_array_get(above->json, i),
                          .reader = above->reader };
}

/* -- values ---------------------------------------------------------------- */

static const char *text_at(const struct node *above, const char *key,
                           bool optional)
{
    const struct node n = member(above, key);
    if (json_is_string(n.json))
        return json_string_value(n.json);
    if (!optional || !json_is_null(n.json))
        wrong(&n, optional ? "a text or null" : "a text");
    return "";
}

/* NaN for null. */
static double number_of(const struct node *n)
{
    if (json_is_number(n->json))
        return json_number_value(n->json);
    if (!json_is_null(n->json))
        wrong(n, "a number or null");
    return NAN;
}

static double number_at(const struct node *above, const char *key)
{
    const struct node n = member(above, key);
    return number_of(&n);
}

static uint64_t whole_at(const struct node *above, const char *key,
                         json_int_t min, json_int_t max)
{
    const struct node n = member(above, key);
    char expected[80];
    const json_int_t value = json_integer_value(n.json);
    if (json_is_integer(n.json) && value >= min && value <= max)
        return (uint64_t)value;
    snprintf(expected, sizeof expected, "a whole number in [%lld, %lld]",
             (long long)min, (long long)max);
    wrong(&n, expected);
    return 0;
}

static bool flag_at(const struct node *above, const char *key)
{
    const struct node n = member(above, key);
    if (!json_is_boolean(n.json))
        wrong(&n, "true or false");
    return json_is_true(n.json);
}

static struct node array_at(const struct node *above, const char *key)
{
    const struct node n = member(above, key);
    if (!json_is_array(n.json))
        wrong(&n, "an array");
    return n;
}

/* Texts of an array, owned by the caller, NULL if there are none. */
static const char **texts_at(const struct node *above, const char *key,
                             size_t *count)
{
    const struct node array = array_at(above, key);
    const size_t n = json_array_size(array.json);
    const char **texts = n ? calloc(n, sizeof *texts) : NULL;
    *count = texts ? n : 0;
    for (size_t i = 0; i < *count; i++) {
        const struct node one = element(&array, i);
        texts[i] = json_string_value(one.json);
        if (!texts[i]) {
            wrong(&one, "a text");
            texts[i] = "";
        }
    }
    return texts;
}

static struct vec3 direction_of(const struct node *n, bool finite)
{
    double x[3];
    if (!json_is_object(n->json)) {
        wrong(n, "a direction");
        return (struct vec3){ 0, 0, 1 };
    }
    number_at(n, "theta_deg");
    number_at(n, "phi_deg");
    const struct node xyz = array_at(n, "xyz");
    if (json_array_size(xyz.json) != 3)
        wrong(&xyz, "three numbers");
    for (size_t i = 0; i < 3; i++) {
        const struct node one = element(&xyz, i);
        x[i] = number_of(&one);
    }
    const struct vec3 w = { x[0], x[1], x[2] };
    if (finite && !(fabs(vec3_dot(w, w) - 1) < 1e-9))
        wrong(n, "a direction of length 1");
    return w;
}

/* -- verdicts -------------------------------------------------------------- */

static void parts_check(const struct node *above)
{
    const struct node parts = array_at(above, "parts");
    for (size_t i = 0; i < json_array_size(parts.json); i++) {
        const struct node part = element(&parts, i);
        text_at(&part, "name", false);
        number_at(&part, "p");
    }
}

/* "pass", "fail" or "not applicable". */
static void outcome(const struct node *above, struct verdict *v)
{
    const char *said = text_at(above, "verdict", false);
    v->applies = strcmp(said, report_none) != 0;
    v->passed = strcmp(said, report_pass) == 0;
    if (v->applies && !v->passed && strcmp(said, report_fail) != 0) {
        const struct node n = member(above, "verdict");
        wrong(&n, "\"pass\", \"fail\" or \"not applicable\"");
    }
}

/* Whether a field is there and not null. */
static bool present(const struct node *n)
{
    if (!n->json)
        wrong(n, "a value or null");
    return n->json && !json_is_null(n->json);
}

static struct verdict verdict_of(const struct node *n)
{
    struct verdict v = { .check = text_at(n, "check", false) };
    const struct node samples = member(n, "samples"), wo = member(n, "wo");
    const struct node wi = member(n, "wi"), confirmed = member(n, "confirmed");
    outcome(n, &v);
    v.value = number_at(n, "value");
    v.limit = number_at(n, "limit");
    v.error = number_at(n, "error");
    v.p = number_at(n, "p");
    v.effect_size = number_at(n, "effect_size");
    v.unit = text_at(n, "unit", true);
    snprintf(v.note, sizeof v.note, "%s", text_at(n, "note", true));
    snprintf(v.effect, sizeof v.effect, "%s", text_at(n, "effect", true));
    snprintf(v.diagnosis, sizeof v.diagnosis, "%s",
             text_at(n, "diagnosis", true));
    if (present(&samples))
        v.samples = whole_at(n, "samples", 0, INT64_MAX);
    if (present(&confirmed))
        v.confirmed = flag_at(n, "confirmed");
    if (present(&wo) || v.applies)
        v.wo = direction_of(&wo, true);
    v.has_wi = present(&wi);
    if (v.has_wi)
        v.wi = direction_of(&wi, false);
    parts_check(n);
    return v;
}

static bool result_read(struct recorded_result *r, const struct node *n)
{
    r->spec = text_at(n, "spec", false);
    r->repaired = flag_at(n, "repaired");
    const struct node wo = member(n, "wo");
    r->wo = direction_of(&wo, true);
    const struct node verdicts = array_at(n, "verdicts");
    r->json = verdicts.json;
    r->verdicts = json_array_size(verdicts.json);
    r->verdict = calloc(r->verdicts + 1, sizeof *r->verdict);
    for (size_t i = 0; r->verdict && n->reader->ok && i < r->verdicts; i++) {
        const struct node one = element(&verdicts, i);
        r->verdict[i] = verdict_of(&one);
    }
    return r->verdict;
}

/* -- the whole ------------------------------------------------------------- */

static void bands_read(struct recorded *r, const struct node *root)
{
    const struct node rgb = member(root, "rgb"), nm = member(root, "nm");
    char text[160] = "";
    struct err why;
    size_t names;
    free(texts_at(root, "bands", &names));
    r->bands = bands_default;
    if (present(&rgb)) {
        if (!bands_parse_rgb(&r->bands, text_at(root, "rgb", true), &why))
            wrong(&rgb, "\"fit\", \"average\" or null");
    } else if (present(&nm)) {
        const struct node array = array_at(root, "nm");
        for (size_t i = 0; i < json_array_size(array.json) && i <= BANDS_MAX;
             i++) {
            const struct node one = element(&array, i);
            const size_t used = strlen(text);
            snprintf(text + used, sizeof text - used, "%s%.17g", i ? "," : "",
                     number_of(&one));
        }
        if (!bands_parse(&r->bands, text, &why))
            wrong(&nm, "one to four wavelengths in (0, 1e9] nm");
    }
}

static void plan_read(struct recorded *r, const struct node *root)
{
    const struct node significance = member(root, "significance");
    r->plan = plan_default;
    r->plan.seed = whole_at(root, "seed", 0, INT64_MAX);
    r->plan.samples = whole_at(root, "samples", 1000, 1000000000);
    r->plan.escalations = (int)whole_at(root, "escalations", 0, 4);
    r->plan.significance = number_of(&significance);
    if (!(r->plan.significance >= 1e-100 && r->plan.significance <= 0.5))
        wrong(&significance, "a number in [1e-100, 0.5]");
    r->skip = texts_at(root, "skipped", &r->skips);
}

static bool results_read(struct recorded *r, const struct node *root)
{
    const struct node array = array_at(root, "results");
    const size_t n = json_array_size(array.json);
    if (n == 0)
        wrong(&array, "at least one result");
    r->result = calloc(n + 1, sizeof *r->result);
    for (size_t i = 0; r->result && root->reader->ok && i < n; i++) {
        const struct node one = element(&array, i);
        struct recorded_result *now = &r->result[r->results++];
        if (!result_read(now, &one))
            return false;
        if (i == 0 || strcmp(now->spec, now[-1].spec) != 0)
            r->models++;
        now->model = r->models - 1;
    }
    return r->result;
}

static bool fields_read(struct recorded *r, struct reader *reader)
{
    const struct node root = { .json = r->root, .reader = reader };
    const char *program = text_at(&root, "program", false);
    if (reader->ok && strcmp(program, "bsdf-validate") != 0) {
        const struct node n = member(&root, "program");
        wrong(&n, "\"bsdf-validate\"");
    }
    whole_at(&root, "schema", REPORT_SCHEMA, REPORT_SCHEMA);
    r->version = text_at(&root, "version", false);
    r->word = texts_at(&root, "command", &r->words);
    plan_read(r, &root);
    bands_read(r, &root);
    r->ior_path = text_at(&root, "ior_path", true);
    if (!r->ior_path[0])
        r->ior_path = NULL;
    r->passed = whole_at(&root, "passed", 0, INT64_MAX);
    r->failed = whole_at(&root, "failed", 0, INT64_MAX);
    r->statistical = whole_at(&root, "statistical", 0, INT64_MAX);
    return results_read(r, &root) || err_set(reader->err, "out of memory");
}

/* At most RECORDED_MAX bytes for jansson, so that a device ends as well. */
struct source {
    FILE *file;
    size_t read;
};

static size_t more(void *buffer, size_t size, void *context)
{
    struct source *s = context;
    const size_t left = RECORDED_MAX + (size_t)1 - s->read;
    const size_t n = fread(buffer, 1, size < left ? size : left, s->file);
    s->read += n;
    return n;
}

static json_t *load(const char *path, struct err *err)
{
    struct source source = { fopen(path, "r"), 0 };
    json_error_t why;
    if (!source.file) {
        err_set(err, "%s: %s", path, strerror(errno));
        return NULL;
    }
    errno = 0;
    json_t *root =
        json_load_callback(more, &source, JSON_REJECT_DUPLICATES, &why);
    char *plain = utf8_plain(why.text);
    if (source.read > RECORDED_MAX) {
        err_set(err, "%s: is larger than %d MB; expected a report", path,
                RECORDED_MAX >> 20);
        json_decref(root);
        root = NULL;
    } else if (ferror(source.file)) {
        err_set(err, "%s: %s", path, strerror(errno));
        json_decref(root);
        root = NULL;
    } else if (!root) {
        err_set(err, "%s:%d: %s; expected a report of bsdf-validate --json",
                path, why.line, plain ? plain : "no JSON");
    }
    free(plain);
    fclose(source.file);
    return root;
}

bool recorded_read(struct recorded *r, const char *path, struct err *err)
{
    struct reader reader = { path, err, true };
    *r = (struct recorded){ .root = load(path, err) };
    if (r->root && fields_read(r, &reader) && reader.ok)
        return true;
    recorded_clear(r);
    return false;
}

void recorded_clear(struct recorded *r)
{
    for (size_t i = 0; i < r->results; i++)
        free(r->result[i].verdict);
    free(r->result);
    free(r->word);
    free(r->skip);
    json_decref(r->root);
    *r = (struct recorded){ .root = NULL };
}
