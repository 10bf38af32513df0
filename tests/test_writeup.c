/* test_writeup.c - the page that `make writeup` makes, and how it is made
 *
 * In the smallest quality, into a folder of the test's own.  The programs are
 * in the folder that BIN names, build/bin by default; the test runs in the root
 * of the repository.
 */
#include <libxml/parser.h>
#include <libxml/xpath.h>
#include <libxml/xpathInternals.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "plots/mathml.h"
#include "tests/close.h"
#include "tests/shell.h"

enum { OUTPUT_MAX = 1 << 16 };
static char folder[64], output[OUTPUT_MAX];

/* Without what a make that runs the tests says to its own. */
#define MAKE                                                                   \
    "env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS -u COURSE_SCENES make "           \
    "--no-print-directory -j2 -f plots/writeup/writeup.mk BIN=$B "             \
    "QUALITY=test OUT=$T "

static int sh(const char *command)
{
    return shell(command, output, OUTPUT_MAX);
}

static void done(const char *command)
{
    char line[2048];
    snprintf(line, sizeof line, "{ %s; } 2>&1", command);
    const int status = sh(line);
    if (status != 0)
        print_error("%s: status %d: %s\n", command, status, output);
    assert_int_equal(status, 0);
}

static int count(const char *command)
{
    done(command);
    return atoi(output);
}

static int setup(void **state)
{
    (void)state;
    char bin[4096];
    const char *given = getenv("BIN");
    if (!realpath(given ? given : "build/bin", bin))
        return -1;
    strcpy(folder, "/tmp/bsdf-writeup-XXXXXX");
    return mkdtemp(folder) && setenv("T", folder, 1) == 0 &&
                   setenv("B", bin, 1) == 0
               ? 0
               : -1;
}

static int teardown(void **state)
{
    (void)state;
    return sh("rm -rf \"$T\"");
}

/* -- how it is made ---------------------------------------------------------
 */

static void an_interrupted_run_goes_on(void **state)
{
    (void)state;
    /* It is stopped in the middle of something. */
    sh("setsid " MAKE ">$T/first 2>&1 & while [ $(ls $T | grep -c "
       "'\\.done$') -lt 3 ]; do sleep 0.05; done; kill -TERM -$!; wait $!");
    const int before = count("ls $T | grep -c '\\.done$' || true");
    const int all = count(MAKE "-n 2>/dev/null | grep -o '\\[[0-9]*/[0-9]*\\]' "
                               "| sed 's/.*\\/\\(.*\\)]/\\1/' | head -1");
    done(MAKE);
    assert_has(output, "/writeup.html");
    assert_in_range(before, 1, (unsigned)all - 1);
    assert_int_equal(count("ls $T | grep -c '[^f]\\.done$'"), all);
}

static void a_second_run_does_nothing(void **state)
{
    (void)state;
    done("ls -l --time-style=full-iso $T | grep -v total >$T.list; " MAKE
         "; ls -l --time-style=full-iso $T | grep -v total | cmp - $T.list; "
         "s=$?; rm $T.list; exit $s");
    assert_int_equal(strchr(output, '[') != NULL, 0);
}

static void only_what_changed_is_made_again(void **state)
{
    (void)state;
    done(MAKE "CROP='.3 .5 .25 .25'");
    assert_has(output, "a part of the same with cosine sampling");
    assert_has(output, "the numbers of the text");
    assert_null(strstr(output, "adaptive"));
    assert_null(strstr(output, "copper with cosine sampling"));
    assert_null(strstr(output, "validated"));
}

/* -- the page ----------------------------------------------------------------
 */

static xmlDocPtr page(void)
{
    char path[128];
    snprintf(path, sizeof path, "%s/writeup.html", folder);
    xmlDocPtr doc = xmlReadFile(path, NULL, XML_PARSE_NONET | XML_PARSE_HUGE);
    assert_non_null(doc);
    return doc;
}

static xmlXPathObjectPtr found(xmlDocPtr doc, const char *what)
{
    xmlXPathContextPtr context = xmlXPathNewContext(doc);
    xmlXPathRegisterNs(context, BAD_CAST "h",
                       BAD_CAST "http://www.w3.org/1999/xhtml");
    xmlXPathObjectPtr all = xmlXPathEval(BAD_CAST what, context);
    xmlXPathFreeContext(context);
    assert_non_null(all);
    return all;
}

static void the_page_needs_nothing_but_itself(void **state)
{
    (void)state;
    xmlDocPtr doc = page();
    xmlXPathObjectPtr sources = found(doc, "//@src");
    const int n = sources->nodesetval->nodeNr;
    assert_in_range(n, 30, 100);
    for (int i = 0; i < n; i++) {
        xmlChar *text = xmlNodeGetContent(sources->nodesetval->nodeTab[i]);
        assert_memory_equal(text, "data:image/png;base64,iVBOR", 27);
        xmlFree(text);
    }
    xmlXPathFreeObject(sources);
    xmlXPathObjectPtr other = found(
        doc, "//h:script | //h:link | //h:iframe | //@href[starts-with(., "
             "'http')] | //*[@*[name() = 'xlink:href' and not("
             "starts-with(., '#'))]]");
    assert_true(xmlXPathNodeSetIsEmpty(other->nodesetval));
    xmlXPathFreeObject(other);
    xmlFreeDoc(doc);
    assert_int_equal(sh("grep -E '@import|url\\(.?http' $T/writeup.html"), 1);
}

static void every_figure_has_its_data_and_script(void **state)
{
    (void)state;
    xmlDocPtr doc = page();
    xmlXPathObjectPtr ids = found(doc, "//h:figure/@id");
    const int n = ids->nodesetval->nodeNr;
    assert_in_range(n, 40, 100);
    for (int i = 0; i < n; i++) {
        char line[512];
        xmlChar *id = xmlNodeGetContent(ids->nodesetval->nodeTab[i]);
        snprintf(line, sizeof line,
                 "cd $T; n=%s; n=${n%%_rate}; { [ -s $n.exr ] || [ -s $n.tsv "
                 "]; } && { [ -s $n.gp ] || [ -s $n.sh ]; }",
                 (char *)id);
        xmlFree(id);
        done(line);
    }
    xmlXPathFreeObject(ids);
    xmlFreeDoc(doc);
}

static void a_script_makes_its_figure_again(void **state)
{
    (void)state;
    done("cd $T && cp m3.png was.png && rm m3.png && PATH=$B:$PATH sh m3.sh && "
         "cmp m3.png was.png");
}

static void the_document_has_its_fonts(void **state)
{
    (void)state;
    if (sh("command -v pdflatex && command -v pdffonts") != 0)
        skip();
    done("pdffonts $T/writeup.pdf");
    assert_has(output, "CMR10");
}

static void long_specs_stay_on_the_page(void **state)
{
    (void)state;
    if (sh("command -v pdflatex") != 0)
        skip();
    done("mkdir $T/long $T/long/tex; cd $T/long; s=course_microfacet:material="
         "Au,alpha=0.5,distribution=ggx,fresnel_at=half,k_d=0.123456789/"
         "0.2345/0.8,lambda=exact; printf 'name\\tvalue\\nspec\\t%s\\n' $s "
         ">numbers.tsv; echo $s $s >file; cp $T/variant.* .; cp "
         "$T/tex/variant.* tex; printf '= A title\\nOf `{spec}` and `%s`, and "
         "{spec}, here.\\n\\n- of `{spec}`\\n\\n| a | b |\\n| `{spec}` | "
         "`{spec}` |\\n\\n! variant | of `{spec}`\\n\\n> file\\n' $s >text; "
         "$B/bsdf-plot writeup text -o text.tex; pdflatex -halt-on-error "
         "-interaction=batchmode text; $B/bsdf-plot compare diffuse "
         "roughconductor:eta=0.123456789/0.223456789/0.323456789,k=2.123456789/"
         "2.323456789/2.523456789,alpha_u=0.123456789,alpha_v=0.223456789 --wo "
         "45,0 --samples 1000 -o c.tex; printf '%s\\n' "
         "'\\documentclass{article}\\usepackage{graphicx,color}' "
         "'\\begin{document}\\begin{figure}\\caption{\\protect\\input{c."
         "caption}}' "
         "'\\end{figure}\\end{document}' >doc.tex; pdflatex -halt-on-error "
         "-interaction=batchmode doc");
    assert_int_equal(sh("cd $T; grep -E 'Overfull .hbox .[0-9]{2}' "
                        "writeup.log long/text.log long/doc.log"),
                     1);
    done("rm -r $T/long");
}

/* -- what is wrong in a text -------------------------------------------------
 */

static void refused(const char *text, const char *a, const char *b)
{
    char line[1024];
    snprintf(
        line, sizeof line,
        "cd $T && printf '%s' >wrong.txt && $B/bsdf-plot writeup wrong.txt "
        "-o wrong.html 2>&1",
        text);
    assert_int_equal(sh(line), 2);
    assert_has(output, a);
    assert_has(output, b);
    assert_int_equal(sh("ls $T | grep wrong.html"), 1);
}

static void what_is_missing_is_named(void **state)
{
    (void)state;
    refused("= a\\nx {m5.lumen %%.3f}\\n", "wrong.txt:2", "{m5.lumen}");
    refused("= a\\nx {m5.luminance %%d}\\n", "{m5.luminance %d}", "%.3f");
    refused("= a\\nx {quality %%.3f}\\n", "\"test\"", "no number");
    refused("= a\\nx {course.energy.worth}\\n", "worth", "value, limit");
    refused("= a\\nx {course.enrgy.value}\\n", "course.json", "enrgy");
    refused("= a\\n\\n! none | x\\n", "wrong.txt:3: figure none", ".png");
    refused("= a\\n! wrong | x\\n", "figure wrong", ".svg");
    refused("= a\\n| a | b |\\n| 1 |\\n", "wrong.txt:3", "expected 2");
    refused("= a\\n> none.txt\\n", "none.txt", "No such file");
    refused("= a\\nx `y\\n", "`y", "does not end");
    refused("= a\\n$$ \\\\frob\\n", "\\frob", "unknown command");
    refused("x\\n", "wrong.txt:1", "title");
    refused("", "wrong.txt", "it is empty");
}

static void formulas_become_mathml(void **state)
{
    (void)state;
    static const char *const made[][2] = {
        { "x^2_i", "<msubsup><mi>x</mi><mi>i</mi><mn>2</mn></msubsup>" },
        { "\\frac{a}{2}", "<mfrac><mrow><mi>a</mi></mrow>" },
        { "\\left( a \\right)^2", "</mrow><mn>2</mn></msup>" },
        { "\\sqrt{\\pi}", "<msqrt><mrow><mi>π</mi></mrow></msqrt>" },
        { "a < b", "<mo>&lt;</mo>" },
    };
    static const char *const wrong[][2] = {
        { "\\frac{a", "} is missing" }, { "a}", "cannot be read" },
        { "a^2^3", "a second one" },    { "\\left( a", "\\right is missing" },
        { "a & b", "cannot be read" },  { "\\", "unknown command" },
        { "a^", "cannot be read" },
    };
    for (size_t i = 0; i < sizeof made / sizeof *made; i++) {
        struct err err = { "" };
        FILE *out = fmemopen(output, sizeof output, "w");
        assert_true(mathml(out, made[i][0], false, &err));
        fclose(out);
        assert_has(output, made[i][1]);
    }
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct err err = { "" };
        FILE *out = fmemopen(output, sizeof output, "w");
        assert_false(mathml(out, wrong[i][0], false, &err));
        fclose(out);
        assert_has(err.text, wrong[i][1]);
    }
    char deep[4096] = "";
    struct err err = { "" };
    memset(deep, '{', sizeof deep - 1);
    FILE *out = fmemopen(output, sizeof output, "w");
    assert_false(mathml(out, deep, false, &err));
    fclose(out);
    assert_has(err.text, "too deep");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "an interrupted run goes on", an_interrupted_run_goes_on },
        { "a second run does nothing", a_second_run_does_nothing },
        { "only what changed is made again", only_what_changed_is_made_again },
        { "the page needs nothing but itself",
          the_page_needs_nothing_but_itself },
        { "every figure has its data and its script",
          every_figure_has_its_data_and_script },
        { "a script makes its figure again", a_script_makes_its_figure_again },
        { "the document has its fonts", the_document_has_its_fonts },
        { "long specs stay on the page", long_specs_stay_on_the_page },
        { "what is missing is named", what_is_missing_is_named },
        { "formulas become MathML", formulas_become_mathml },
    };
    return cmocka_run_group_tests_name("writeup", tests, setup, teardown);
}
