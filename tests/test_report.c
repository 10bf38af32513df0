/* test_report.c - reports that are whole, follow their schema, and replay
 *
 * The test runs in the root of the repository and writes only into $T.
 */
#include <jansson.h>
#include <libxml/parser.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "tests/broken.h"
#include "tests/close.h"
#include "tests/shell.h"
#include "validate/recorded.h"
#include "validate/replay.h"
#include "validate/report.h"

static int setup(void **state)
{
    (void)state;
    if (shell_setup("report", "") != 0)
        return -1;
    /* Sound, failing, not applicable; and a name that is no text. */
    return sh("cp data/ior/Ca/Mathewson.yml \"$T/$(printf '\\377<&').yml\" && "
              "cd $T && bsdf-validate diffuse mirror --samples 1e4 --skip chi2 "
              "--json sound.json --junit sound.xml >sound.txt && "
              "{ bsdf-validate course_microfacet course_refraction diffuse "
              "--samples 1e4 --nm 614,549 --json fails.json --junit fails.xml "
              ">fails.txt; [ $? = 1 ]; } && "
              "bsdf-validate \"roughconductor:material='$(printf "
              "'\\377<&').yml'\" --wo 40,10 --samples 1e4 --json odd.json "
              "--junit odd.xml >odd.txt");
}

/* -- the schema ------------------------------------------------------------ */

static json_t *schema;

static bool type_is(const json_t *type, const json_t *value)
{
    const char *name = json_string_value(type);
    return (strcmp(name, "null") == 0 && json_is_null(value)) ||
           (strcmp(name, "boolean") == 0 && json_is_boolean(value)) ||
           (strcmp(name, "integer") == 0 && json_is_integer(value)) ||
           (strcmp(name, "number") == 0 && json_is_number(value)) ||
           (strcmp(name, "string") == 0 && json_is_string(value)) ||
           (strcmp(name, "array") == 0 && json_is_array(value)) ||
           (strcmp(name, "object") == 0 && json_is_object(value));
}

static bool any_type(const json_t *type, const json_t *value)
{
    bool any = json_is_string(type) && type_is(type, value);
    for (size_t i = 0; i < json_array_size(type); i++)
        any |= type_is(json_array_get(type, i), value);
    return any;
}

static bool follows(const json_t *rule, const json_t *value, const char *where);

static bool object_follows(const json_t *rule, const json_t *value)
{
    bool ok = true;
    const json_t *known = json_object_get(rule, "properties"), *one;
    const json_t *required = json_object_get(rule, "required");
    const char *key;
    json_t *part;
    for (size_t i = 0; i < json_array_size(required); i++) {
        key = json_string_value(json_array_get(required, i));
        if (!json_object_get(value, key)) {
            print_error("%s is missing\n", key);
            ok = false;
        }
    }
    json_object_foreach((json_t *)value, key, part)
    {
        one = json_object_get(known, key);
        if (!one)
            print_error("%s is not in the schema\n", key);
        ok = ok && one && follows(one, part, key);
    }
    return ok;
}

/* The part of JSON Schema that ours is written in; anything else fails. */
static bool follows(const json_t *rule, const json_t *value, const char *where)
{
    static const char *const words[] = {
        "$schema",    "title",    "description", "type", "additionalProperties",
        "properties", "required", "items",       "enum", "$ref",
        "$defs"
    };
    const char *key, *ref = json_string_value(json_object_get(rule, "$ref"));
    const json_t *type = json_object_get(rule, "type");
    const json_t *choice = json_object_get(rule, "enum");
    const json_t *items = json_object_get(rule, "items");
    bool ok = true, any = !choice;
    json_t *part;
    json_object_foreach((json_t *)rule, key, part)
    {
        bool known = false;
        for (size_t i = 0; i < sizeof words / sizeof *words; i++)
            known |= strcmp(key, words[i]) == 0;
        assert_true(known);
    }
    if (ref) {
        assert_int_equal(strncmp(ref, "#/$defs/", 8), 0);
        rule = json_object_get(json_object_get(schema, "$defs"), ref + 8);
        assert_non_null(rule);
        return follows(rule, value, where);
    }
    if (type && !any_type(type, value)) {
        char *text = json_dumps(value, JSON_ENCODE_ANY);
        print_error("%s is of the wrong type: %.100s\n", where, text);
        free(text);
        return false;
    }
    for (size_t i = 0; i < json_array_size(choice); i++)
        any |= json_equal(json_array_get(choice, i), value);
    for (size_t i = 0; ok && items && i < json_array_size(value); i++)
        ok = follows(items, json_array_get(value, i), where);
    return ok && any && (!json_is_object(value) || object_follows(rule, value));
}

static json_t *load(const char *file)
{
    json_error_t why;
    json_t *root = json_load_file(file, 0, &why);
    if (!root)
        fail_msg("%s:%d: %s", file, why.line, why.text);
    return root;
}

static void reports_follow_the_schema(void **state)
{
    (void)state;
    static const char *const file[] = { "sound.json", "fails.json",
                                        "odd.json" };
    schema = load("validate/report.schema.json");
    for (int i = 0; i < 3; i++) {
        json_t *root = load(in_folder(file[i]));
        assert_true(follows(schema, root, file[i]));
        json_object_del(root, "nm");
        print_message("    a report without one field:\n");
        assert_false(follows(schema, root, file[i]));
        json_decref(root);
    }
    json_decref(schema);
}

static json_t *first_verdict(json_t *root)
{
    json_t *result = json_array_get(json_object_get(root, "results"), 0);
    return json_array_get(json_object_get(result, "verdicts"), 0);
}

static const char *text_of(const json_t *object, const char *key)
{
    return json_string_value(json_object_get(object, key));
}

static void assert_xml(const char *file, const char *has)
{
    xmlDocPtr doc = xmlReadFile(file, NULL, XML_PARSE_NONET | XML_PARSE_HUGE);
    assert_non_null(doc);
    xmlChar *text = xmlNodeGetContent(xmlDocGetRootElement(doc));
    if (has)
        assert_has((const char *)text, has);
    xmlFree(text);
    xmlFreeDoc(doc);
}

/* A verdict with all that cannot be written as it is. */
static void what_is_no_number_or_text_is_there_all_the_same(void **state)
{
    (void)state;
    struct err err;
    struct plan plan = plan_default;
    struct run run;
    struct bsdf *b =
        bsdf_new_of(&type_broken_diffuse, "fault=no_pi", &bands_default, &err);
    const struct vec3 wo = dir_from_degrees(31, 40);
    assert_non_null(b);
    plan.samples = 1000;
    assert_true(run_checks(&run, &plan, (const struct bsdf *const *)&b, 1, &wo,
                           1, NULL, NULL, &err));
    struct verdict *v = &run.result[0].verdict[0];
    v->passed = false;
    v->value = NAN;
    v->limit = INFINITY;
    v->has_wi = true;
    v->wi = (struct vec3){ NAN, 0, -INFINITY };
    strcpy(v->note, "a \xff ]]> & \x01 \n <b> note");
    strcpy(v->diagnosis, "half a letter: \xc3");
    v->parts = 1;
    v->part[0] = (struct verdict_part){ .name = "\xfe", .p = NAN };
    char word[] = "wo\xffrd", *words[] = { word };
    if (!report_json(in_folder("nan.json"), &run, 1, words, &err))
        fail_msg("%s", err.text);
    json_t *root = load(in_folder("nan.json"));
    schema = load("validate/report.schema.json");
    assert_true(follows(schema, root, "nan.json"));
    json_decref(schema);
    const json_t *first = first_verdict(root);
    assert_true(json_is_null(json_object_get(first, "value")));
    assert_true(json_is_null(json_object_get(first, "limit")));
    assert_has(text_of(first, "note"), "a \\xff ]]> &");
    assert_string_equal(text_of(first, "diagnosis"), "half a letter: \\xc3");
    assert_string_equal(
        json_string_value(json_array_get(json_object_get(root, "command"), 0)),
        "wo\\xffrd");
    json_decref(root);

    struct recorded recorded;
    if (!recorded_read(&recorded, in_folder("nan.json"), &err))
        fail_msg("%s", err.text);
    assert_true(isnan(recorded.result[0].verdict[0].value));
    assert_false(recorded.result[0].verdict[0].passed);
    recorded_clear(&recorded);

    if (!report_junit(in_folder("nan.xml"), &run, &err))
        fail_msg("%s", err.text);
    assert_xml(in_folder("nan.xml"), "a \\xff ]]> & \\x01 \\x0a <b> note");
    does("cd $T && bsdf-plot report nan.json -o nan.html");
    assert_xml(in_folder("nan.html"), "not finite");
    assert_xml(in_folder("nan.html"), "half a letter: \\xc3");
    run_clear(&run);
    bsdf_free(b);
}

static void names_that_are_no_text_are_shown_and_not_replayed(void **state)
{
    (void)state;
    json_t *root = load(in_folder("odd.json"));
    const json_t *one = json_array_get(json_object_get(root, "results"), 0);
    assert_string_equal(text_of(one, "spec"),
                        "roughconductor:material='\\xff<&.yml'");
    assert_true(json_is_true(json_object_get(one, "repaired")));
    json_decref(root);
    assert_xml(in_folder("odd.xml"), NULL);
    does("grep -c 'name=.*.xff&lt;&amp;.yml' $T/odd.xml");
    refused("cd $T && bsdf-validate --replay odd.json", "results[0].spec",
            "cannot be made again");
}

static void the_same_run_gives_the_same_bytes(void **state)
{
    (void)state;
    does("mkdir $T/again && cd $T/again && bsdf-validate diffuse mirror "
         "--samples 1e4 --skip chi2 --json sound.json --junit sound.xml "
         "--threads 1 >sound.txt; cmp sound.xml ../sound.xml && cmp sound.txt "
         "../sound.txt && for f in . ..; do sed -n '/\"seed\"/,$p' "
         "$f/sound.json >$f/cut; done; cmp cut ../cut");
}

/* -- JUnit ----------------------------------------------------------------- */

static int attribute(xmlNodePtr node, const char *name)
{
    xmlChar *text = xmlGetProp(node, BAD_CAST name);
    const int value = text ? atoi((const char *)text) : -1;
    xmlFree(text);
    return value;
}

static int children(xmlNodePtr node, const char *name)
{
    int n = 0;
    for (xmlNodePtr c = node->children; c; c = c->next)
        n += c->type == XML_ELEMENT_NODE &&
             strcmp((const char *)c->name, name) == 0;
    return n;
}

static void junit_counts_what_it_holds(void **state)
{
    (void)state;
    json_t *root = load(in_folder("fails.json"));
    xmlDocPtr doc = xmlReadFile(in_folder("fails.xml"), NULL, XML_PARSE_NONET);
    assert_non_null(doc);
    xmlNodePtr top = xmlDocGetRootElement(doc);
    assert_string_equal((const char *)top->name, "testsuites");
    assert_int_equal(children(top, "testsuite"), 3);
    assert_int_equal(attribute(top, "failures"),
                     json_integer_value(json_object_get(root, "failed")));
    int failures = 0, skipped = 0, cases = 0;
    for (xmlNodePtr suite = top->children; suite; suite = suite->next)
        for (xmlNodePtr c = suite->children; c; c = c->next) {
            cases += c->name && strcmp((const char *)c->name, "testcase") == 0;
            failures += children(c, "failure");
            skipped += children(c, "skipped");
        }
    assert_int_equal(attribute(top, "tests"), cases);
    assert_int_equal(attribute(top, "failures"), failures);
    assert_int_equal(attribute(top, "skipped"), skipped);
    assert_true(failures > 0 && skipped > 0);
    xmlFreeDoc(doc);
    json_decref(root);
    does("grep -m 1 -o 'message=\"value [0-9.]*[^\"]*limit' $T/fails.xml");
    if (sh("command -v xmllint") == 0)
        does("xmllint --noout $T/*.xml");
    else
        print_message("no xmllint here\n");
}

/* -- replaying ------------------------------------------------------------- */

/* That as many verdicts are said to be the same as the file has. */
static void assert_same(const char *file)
{
    char text[96];
    json_t *root = load(in_folder(file));
    const json_t *results = json_object_get(root, "results");
    size_t n = 0;
    for (size_t i = 0; i < json_array_size(results); i++)
        n += json_array_size(
            json_object_get(json_array_get(results, i), "verdicts"));
    snprintf(text, sizeof text, "the same %zu verdicts in every field", n);
    json_decref(root);
    assert_has(output, text);
}

static void a_replay_gives_the_same_verdicts(void **state)
{
    (void)state;
    does("cd $T && bsdf-validate --replay sound.json --json sound2.json");
    assert_same("sound.json");
    ends("cd $T && bsdf-validate --replay fails.json", 1);
    assert_same("fails.json");
    assert_has(output, "\ncourse_microfacet\n");
    assert_null(strstr(output, "\ndiffuse\n"));
    does("cd $T && bsdf-validate --replay fails.json --spec 3");
    assert_has(output, "replayed: the same ");
    does("cd $T && bsdf-validate --replay fails.json --spec diffuse");
    ends("cd $T && bsdf-validate --replay fails.json --spec 1", 1);
    does("cd $T && for f in sound sound2; do sed -n '/\"seed\"/,$p' $f.json "
         ">$f.cut; done; cmp sound.cut sound2.cut");
}

static void a_replay_names_what_is_different(void **state)
{
    (void)state;
    json_t *root = load(in_folder("sound.json"));
    json_t *v = first_verdict(root);
    json_object_set_new(v, "limit", json_real(0.25));
    assert_int_equal(json_dump_file(root, in_folder("other.json"), 0), 0);
    refused("bsdf-validate --replay $T/other.json >$T/said",
            "results[0].verdicts[0] (finite).limit was 0.25, and is now 0.0",
            "other.json");
    json_t *verdicts = json_object_get(
        json_array_get(json_object_get(root, "results"), 0), "verdicts");
    const size_t last = json_array_size(verdicts) - 1;
    char changed[96];
    json_array_remove(verdicts, last);
    json_object_set_new(v, "limit", json_real(0));
    assert_int_equal(json_dump_file(root, in_folder("other.json"), 0), 0);
    snprintf(changed, sizeof changed,
             "the number of results[0].verdicts was %zu, and is now %zu", last,
             last + 1);
    refused("bsdf-validate --replay $T/other.json >$T/said", changed, "");
    /* another model does not matter to this one */
    does("bsdf-validate --replay $T/other.json --spec mirror");
    json_decref(root);
}

static void wrong_requests_are_refused(void **state)
{
    (void)state;
    refused("bsdf-validate --replay $T/none.json", "none.json", "No such file");
    refused("bsdf-validate --replay $T", "Is a directory", "");
    refused("bsdf-validate --replay $T/sound.json diffuse", "no SPEC", "");
    refused("bsdf-validate --replay $T/sound.json --seed 2", "--seed",
            "the report");
    refused("bsdf-validate --replay $T/sound.json --spec 3", "--spec 3",
            "[1, 2]");
    refused("bsdf-validate --replay $T/sound.json --spec matt", "\"matt\"",
            "a spec of the report");
    refused("bsdf-validate diffuse --spec 1", "--spec", "--replay FILE");
    refused(
        "bsdf-validate diffuse --samples 1e3 --junit $T/none/x.xml >$T/said",
        "none/x.xml", "");
    refused("bsdf-plot report $T/none.json -o $T/x.html", "none.json",
            "No such file");
    refused("bsdf-plot report $T/sound.json -o $T/x.svg", "x.svg", ".html");
    refused("bsdf-plot report", "a FILE", "");
}

static void malformed(const char *bytes, size_t n, const char *has)
{
    struct recorded r;
    struct err err = { "" };
    FILE *f = fopen(in_folder("bad.json"), "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, n, f), n);
    fclose(f);
    assert_false(recorded_read(&r, in_folder("bad.json"), &err));
    assert_has(err.text, "bad.json");
    assert_has(err.text, has);
}

/* Every field that an object has is taken away, and replaced by something of
 * each type; nothing crashes, and what is missing is named. */
static void spoil(json_t *root, json_t *object, const char *above)
{
    static const char *const other[] = { "null",  "true", "\"x\"", "-1",
                                         "1e300", "[]",   "{}",    "[[0]]" };
    char name[64];
    json_t *keys = json_array();
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value)
        json_array_append_new(keys, json_string(key));
    for (size_t k = 0; k < json_array_size(keys); k++) {
        struct recorded r;
        struct err err;
        key = json_string_value(json_array_get(keys, k));
        json_t *was = json_incref(json_object_get(object, key));
        for (size_t i = 0; i < sizeof other / sizeof *other; i++) {
            json_object_set_new(object, key,
                                json_loads(other[i], JSON_DECODE_ANY, NULL));
            assert_int_equal(json_dump_file(root, in_folder("bad.json"), 0), 0);
            if (recorded_read(&r, in_folder("bad.json"), &err))
                recorded_clear(&r);
            else
                assert_has(err.text, "expected");
        }
        json_object_del(object, key);
        snprintf(name, sizeof name, "%s%s is missing", above, key);
        char *text = json_dumps(root, 0);
        malformed(text, strlen(text), name);
        free(text);
        json_object_set_new(object, key, was);
    }
    json_decref(keys);
}

static void malformed_reports_are_refused(void **state)
{
    (void)state;
    json_t *root = load(in_folder("fails.json"));
    json_t *results = json_object_get(root, "results");
    while (json_array_size(results) > 2)
        json_array_remove(results, 2);
    char *text = json_dumps(root, JSON_COMPACT);
    const size_t n = strlen(text);
    for (size_t i = 0; i < 200; i++)
        malformed(text, i * n / 200, "bad.json:");
    for (size_t i = 0; i < 400; i++) { /* a byte that is another one */
        struct recorded r;
        struct err err;
        char *copy = strdup(text);
        const size_t at = (i * 7919 * 31) % n;
        copy[at] = "\"{[0,}]n\xff"[i % 9];
        FILE *f = fopen(in_folder("bad.json"), "wb");
        assert_non_null(f);
        fwrite(copy, 1, n, f);
        fclose(f);
        if (recorded_read(&r, in_folder("bad.json"), &err))
            recorded_clear(&r);
        free(copy);
    }
    malformed("", 0, "bad.json:");
    malformed("[]", 2, "program");
    malformed("{\"program\": 1}", 14, "program is 1; expected a text");
    malformed("{\"program\": \"x\"}", 16, "\"bsdf-validate\"");
    char *deep = malloc(200000);
    memset(deep, '[', 200000);
    malformed(deep, 200000, "depth");
    free(deep);
    free(text);
    json_t *none = json_copy(root);
    json_object_set_new(none, "results", json_array());
    text = json_dumps(none, 0);
    malformed(text, strlen(text), "results is an array; expected at least one");
    free(text);
    json_decref(none);
    json_t *result = json_array_get(results, 0);
    json_t *verdict = json_array_get(json_object_get(result, "verdicts"), 10);
    spoil(root, root, "");
    spoil(root, result, "results[0].");
    spoil(root, verdict, "results[0].verdicts[10].");
    spoil(root, json_object_get(verdict, "wo"), "results[0].verdicts[10].wo.");
    json_decref(root);
    refused("timeout 20 bsdf-validate --replay /dev/zero", "/dev/zero",
            "expected a report");
    refused(
        "yes '                                 ' | timeout 60 bsdf-validate "
        "--replay /dev/stdin",
        "larger than 64 MB", "");
}

/* -- the page -------------------------------------------------------------- */

static void a_page_needs_nothing_but_itself(void **state)
{
    (void)state;
    ends("cd $T && bsdf-plot report sound.json -o sound.html && bsdf-plot "
         "report fails.json -o fails.html && bsdf-plot report odd.json -o "
         "odd.html && ls -A $T | grep -c bsdf-plot-",
         1);
    assert_has(output, "sound.html\nfails.html\nodd.html\n");
    assert_xml(in_folder("sound.html"), "Sound: ");
    assert_xml(in_folder("sound.html"), " verdicts passed, 0 failed, of 2 "
                                        "models from 10 directions in all.");
    assert_xml(in_folder("odd.html"), "\\xff<&.yml");
    assert_xml(in_folder("fails.html"), "bsdf-validate --replay fails.json "
                                        "--spec 1");
    assert_xml(in_folder("fails.html"), "only delta lobes");
    assert_xml(in_folder("fails.html"), "--nm 614,549");
    /* names of namespaces alone */
    ends("cat $T/*.html | grep -o 'http[^\"]*' | sort -u | grep -v "
         "'^http://www.w3.org/'",
         1);
    ends("grep -E '<script|<link|src=|@import' $T/*.html", 1);
    does("grep -o '<svg' $T/fails.html | wc -l");
    assert_int_equal(atoi(output), 3); /* a map and two lobes */
    prints("grep -o \" id=['\\\"][^'\\\"]*\" $T/fails.html | tr \"'\" '\"' | "
           "sort | uniq -d | wc -l",
           "0\n");
}

static void pictures_are_few_and_a_model_may_be_gone(void **state)
{
    (void)state;
    json_t *root = load(in_folder("fails.json"));
    json_t *results = json_object_get(root, "results");
    json_t *one = json_deep_copy(json_array_get(results, 2)); /* fails */
    char spec[64];
    json_array_clear(results);
    for (int i = 0; i < 8; i++) {
        json_t *copy = json_deep_copy(one);
        snprintf(spec, sizeof spec, "course_microfacet:alpha=0.%d", i + 1);
        json_object_set_new(copy, "spec",
                            json_string(i == 3 ? "gone:a='<b>'" : spec));
        json_array_append_new(results, copy);
    }
    json_decref(one);
    assert_int_equal(json_dump_file(root, in_folder("many.json"), 0), 0);
    json_decref(root);
    does("cd $T && bsdf-plot report many.json -o many.html");
    assert_xml(in_folder("many.html"), "this model cannot be made again");
    assert_xml(in_folder("many.html"), "some for the first 6 models that fail");
    does("grep -o '<svg' $T/many.html | wc -l");
    assert_int_equal(atoi(output), 12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "reports follow their schema", reports_follow_the_schema },
        { "what is no number or no text is there all the same",
          what_is_no_number_or_text_is_there_all_the_same },
        { "names that are no text are shown, and not replayed",
          names_that_are_no_text_are_shown_and_not_replayed },
        { "the same run gives the same bytes",
          the_same_run_gives_the_same_bytes },
        { "JUnit counts what it holds", junit_counts_what_it_holds },
        { "a replay gives the same verdicts",
          a_replay_gives_the_same_verdicts },
        { "a replay names what is different",
          a_replay_names_what_is_different },
        { "wrong requests are refused", wrong_requests_are_refused },
        { "malformed reports are refused", malformed_reports_are_refused },
        { "a page needs nothing but itself", a_page_needs_nothing_but_itself },
        { "pictures are few, and a model may be gone",
          pictures_are_few_and_a_model_may_be_gone },
    };
    return cmocka_run_group_tests_name("report", tests, setup, shell_teardown);
}
