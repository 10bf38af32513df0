/* test_writeup.c - the page that `make writeup` makes, and how it is made
 *
 * In the smallest quality, into $T, from the root of the repository.
 */
#include <libxml/parser.h>
#include <libxml/xpath.h>
#include <libxml/xpathInternals.h>
#include <stdio.h>
#include <stdlib.h>

#include "plots/mathml.h"
#include "tests/close.h"
#include "tests/shell.h"

/* Without what a make that runs the tests says to its own. */
#define MAKE                                                                   \
    "env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS -u COURSE_SCENES make "           \
    "--no-print-directory -j2 -f plots/writeup/writeup.mk BIN=$BIN "           \
    "QUALITY=test OUT=$T "

static int count(const char *command)
{
    does(command);
    return atoi(output);
}

/* The programs are not in PATH, where the scripts would find them. */
static int setup(void **state)
{
    (void)state;
    return shell_setup("writeup", "exec 2>&1; PATH=${PATH#*:}; ");
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
    does(MAKE);
    assert_has(output, "/writeup.html");
    assert_in_range(before, 1, (unsigned)all - 1);
    assert_int_equal(count("ls $T | grep -c '[^f]\\.done$'"), all);
}

static void a_second_run_does_nothing(void **state)
{
    (void)state;
    does("ls -l --time-style=full-iso $T | grep -v total >$T.list; " MAKE
         "; ls -l --time-style=full-iso $T | grep -v total | cmp - $T.list; "
         "s=$?; rm $T.list; exit $s");
    assert_int_equal(strchr(output, '[') != NULL, 0);
}

static void only_what_changed_is_made_again(void **state)
{
    (void)state;
    does(MAKE "CROP='.3 .5 .25 .25'");
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
    xmlDocPtr doc = xmlReadFile(in_folder("writeup.html"), NULL,
                                XML_PARSE_NONET | XML_PARSE_HUGE);
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
    ends("grep -E '@import|url\\(.?http' $T/writeup.html", 1);
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
        does(line);
    }
    xmlXPathFreeObject(ids);
    xmlFreeDoc(doc);
}

static void a_script_makes_its_figure_again(void **state)
{
    (void)state;
    does("cd $T && cp m3.png was.png && rm m3.png && PATH=$BIN:$PATH sh m3.sh "
         "&& cmp m3.png was.png");
}

static void the_document_has_its_fonts(void **state)
{
    (void)state;
    if (sh("command -v pdflatex && command -v pdffonts") != 0)
        skip();
    does("pdffonts $T/writeup.pdf");
    assert_has(output, "CMR10");
}

static void long_specs_stay_on_the_page(void **state)
{
    (void)state;
    if (sh("command -v pdflatex") != 0)
        skip();
    does("mkdir $T/long $T/long/tex; cd $T/long; s=course_microfacet:material="
         "Au,alpha=0.5,distribution=ggx,fresnel_at=half,k_d=0.123456789/"
         "0.2345/0.8,lambda=exact; printf 'name\\tvalue\\nspec\\t%s\\n' $s "
         ">numbers.tsv; echo $s $s >file; cp $T/variant.* .; cp "
         "$T/tex/variant.* tex; printf '= A title\\nOf `{spec}` and `%s`, and "
         "{spec}, here.\\n\\n- of `{spec}`\\n\\n| a | b |\\n| `{spec}` | "
         "`{spec}` |\\n\\n! variant | of `{spec}`\\n\\n> file\\n' $s >text; "
         "$BIN/bsdf-plot writeup text -o text.tex; pdflatex -halt-on-error "
         "-interaction=batchmode text; $BIN/bsdf-plot compare diffuse "
         "roughconductor:eta=0.123456789/0.223456789/0.323456789,k=2.123456789/"
         "2.323456789/2.523456789,alpha_u=0.123456789,alpha_v=0.223456789 --wo "
         "45,0 --samples 1000 -o c.tex; printf '%s\\n' "
         "'\\documentclass{article}\\usepackage{graphicx,color}' "
         "'\\begin{document}\\begin{figure}\\caption{\\protect\\input{c."
         "caption}}' "
         "'\\end{figure}\\end{document}' >doc.tex; pdflatex -halt-on-error "
         "-interaction=batchmode doc");
    ends("cd $T; grep -E 'Overfull .hbox .[0-9]{2}' writeup.log long/text.log "
         "long/doc.log",
         1);
    does("rm -r $T/long");
}

/* -- what is wrong in a text -------------------------------------------------
 */

static void text_refused(const char *text, const char *a, const char *b)
{
    char line[1024];
    snprintf(line, sizeof line,
             "cd $T && printf '%s' >wrong.txt && $BIN/bsdf-plot writeup "
             "wrong.txt -o wrong.html",
             text);
    refused(line, a, b);
    ends("ls $T | grep wrong.html", 1);
}

static void what_is_missing_is_named(void **state)
{
    (void)state;
    text_refused("= a\\nx {m5.lumen %%.3f}\\n", "wrong.txt:2", "{m5.lumen}");
    text_refused("= a\\nx {m5.luminance %%d}\\n", "{m5.luminance %d}", "%.3f");
    text_refused("= a\\nx {quality %%.3f}\\n", "\"test\"", "no number");
    text_refused("= a\\nx {course.energy.worth}\\n", "worth", "value, limit");
    text_refused("= a\\nx {course.enrgy.value}\\n", "course.json", "enrgy");
    text_refused("= a\\n\\n! none | x\\n", "wrong.txt:3: figure none", ".png");
    text_refused("= a\\n! wrong | x\\n", "figure wrong", ".svg");
    text_refused("= a\\n| a | b |\\n| 1 |\\n", "wrong.txt:3", "expected 2");
    text_refused("= a\\n> none.txt\\n", "none.txt", "No such file");
    text_refused("= a\\nx `y\\n", "`y", "does not end");
    text_refused("= a\\n$$ \\\\frob\\n", "\\frob", "unknown command");
    text_refused("x\\n", "wrong.txt:1", "title");
    text_refused("", "wrong.txt", "it is empty");
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
    return cmocka_run_group_tests_name("writeup", tests, setup, shell_teardown);
}
