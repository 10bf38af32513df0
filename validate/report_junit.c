/* report_junit.c - a run as JUnit's XML
 *
 * There is no standard of it; this is what the readers of Jenkins and GitLab
 * share: testsuites, testsuite, testcase, failure, skipped, properties.
 */
#include <libxml/xmlwriter.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/cli.h"
#include "bsdf/outfile.h"
#include "bsdf/utf8.h"
#include "validate/report.h"

/* Each function leaves ok false for good once the writer fails. */
struct junit {
    xmlTextWriterPtr to;
    bool ok;
};

static void open_element(struct junit *j, const char *name)
{
    j->ok = j->ok && xmlTextWriterStartElement(j->to, BAD_CAST name) >= 0;
}

static void close_element(struct junit *j)
{
    j->ok = j->ok && xmlTextWriterEndElement(j->to) >= 0;
}

static void attribute(struct junit *j, const char *name, const char *bytes)
{
    char *plain = utf8_plain(bytes);
    j->ok =
        j->ok && plain &&
        xmlTextWriterWriteAttribute(j->to, BAD_CAST name, BAD_CAST plain) >= 0;
    free(plain);
}

static void count(struct junit *j, const char *name, size_t n)
{
    char text[32];
    snprintf(text, sizeof text, "%zu", n);
    attribute(j, name, text);
}

static void property(struct junit *j, const char *name, const char *value)
{
    open_element(j, "property");
    attribute(j, "name", name);
    attribute(j, "value", value);
    close_element(j);
}

static void properties(struct junit *j, const struct run *run)
{
    char text[96];
    const struct plan *plan = &run->plan;
    open_element(j, "properties");
    property(j, "version", BSDF_VERSION);
    snprintf(text, sizeof text, "%llu", (unsigned long long)plan->seed);
    property(j, "seed", text);
    snprintf(text, sizeof text, "%llu", (unsigned long long)plan->samples);
    property(j, "samples", text);
    snprintf(text, sizeof text, "%g", plan->significance);
    property(j, "significance", text);
    bands_print(bsdf_bands(run->result[0].bsdf), text, sizeof text);
    property(j, "bands", text);
    close_element(j);
}

/* "value 1.33, limit 1; probably: ..." and the note. */
static void failure(struct junit *j, const struct verdict *v)
{
    char text[400];
    char *plain = utf8_plain(v->note);
    int n = snprintf(text, sizeof text, "value %.6g%s%s, limit %.4g", v->value,
                     v->unit[0] ? " " : "", v->unit, v->limit);
    if (!isnan(v->p))
        n += snprintf(text + n, sizeof text - (size_t)n, ", p %.2g", v->p);
    if (v->diagnosis[0])
        snprintf(text + n, sizeof text - (size_t)n, "; probably: %s",
                 v->diagnosis);
    open_element(j, "failure");
    attribute(j, "message", text);
    attribute(j, "type", v->check);
    j->ok =
        j->ok && plain && xmlTextWriterWriteString(j->to, BAD_CAST plain) >= 0;
    close_element(j);
    free(plain);
}

static void test_case(struct junit *j, const struct result *r,
                      const struct verdict *v)
{
    char name[96];
    const struct angles a = dir_to_degrees(r->wo);
    snprintf(name, sizeof name, "%s at wo %.7g,%.5g", v->check, a.theta_deg,
             a.phi_deg);
    open_element(j, "testcase");
    attribute(j, "name", name);
    attribute(j, "classname", bsdf_spec(r->bsdf));
    if (!v->applies) {
        open_element(j, "skipped");
        attribute(j, "message", v->note);
        close_element(j);
    } else if (!v->passed) {
        failure(j, v);
    }
    close_element(j);
}

/* The attributes that suites have, over results [first, last). */
static void totals(struct junit *j, const struct run *run, size_t first,
                   size_t last)
{
    size_t tests = 0, failures = 0, none = 0;
    for (size_t i = first; i < last; i++)
        for (int c = 0; c < checks_count(); c++) {
            const struct verdict *v = &run->result[i].verdict[c];
            tests++;
            none += !v->applies;
            failures += v->applies && !v->passed;
        }
    count(j, "tests", tests);
    count(j, "failures", failures);
    count(j, "errors", 0);
    count(j, "skipped", none);
}

static void suites(struct junit *j, const struct run *run)
{
    open_element(j, "testsuites");
    attribute(j, "name", "bsdf-validate");
    totals(j, run, 0, run->results);
    for (size_t first = 0, last; first < run->results; first = last) {
        const struct bsdf *b = run->result[first].bsdf;
        last = first;
        while (last < run->results && run->result[last].bsdf == b)
            last++;
        open_element(j, "testsuite");
        attribute(j, "name", bsdf_spec(b));
        totals(j, run, first, last);
        properties(j, run);
        for (size_t i = first; i < last; i++)
            for (int c = 0; c < checks_count(); c++)
                test_case(j, &run->result[i], &run->result[i].verdict[c]);
        close_element(j);
    }
    close_element(j);
}

/* The whole document; NULL when out of memory. */
static xmlBufferPtr document(const struct run *run)
{
    xmlBufferPtr buffer = xmlBufferCreate();
    struct junit j = { buffer ? xmlNewTextWriterMemory(buffer, 0) : NULL,
                       true };
    j.ok = j.to && xmlTextWriterSetIndent(j.to, 1) >= 0 &&
           xmlTextWriterStartDocument(j.to, NULL, "UTF-8", NULL) >= 0;
    suites(&j, run);
    j.ok = j.ok && xmlTextWriterEndDocument(j.to) >= 0;
    xmlFreeTextWriter(j.to);
    if (j.ok)
        return buffer;
    xmlBufferFree(buffer);
    return NULL;
}

bool report_junit(const char *path, const struct run *run, struct err *err)
{
    struct outfile out;
    xmlBufferPtr buffer = document(run);
    if (!buffer)
        return err_set(err, "%s: the report could not be made", path);
    bool ok = outfile_open(&out, path, err);
    if (ok) {
        fwrite(xmlBufferContent(buffer), 1, (size_t)xmlBufferLength(buffer),
               out.stream);
        ok = outfile_close(&out, err);
    }
    xmlBufferFree(buffer);
    return ok;
}
