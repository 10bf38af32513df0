/* test_docs.c - what the pages say, done as they say it
 *
 * The commands of a page's sh blocks run in a folder of the test's own, $T/..,
 * and each line of its text blocks must be a line that they printed.  Where a
 * page builds, it does so in a copy of the sources, with what is built already
 * beside them; FRESH=1 leaves that out, as for somebody who has just cloned.
 */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/close.h"
#include "tests/shell.h"

/* Runs the blocks of a page's sections (all: "") in a folder below $T. */
static void replays(const char *page, const char *sections, const char *where)
{
    char command[1024];
    setenv("PAGE", page, 1);
    setenv("SECTIONS", sections, 1);
    snprintf(command, sizeof command, "%s/%s", folder, where);
    setenv("WHERE", command, 1);
    does("for kind in sh text; do sh tests/blocks.sh $kind \"$PAGE\" "
         "\"$SECTIONS\" >$T/$kind || exit 1; done");
    if (sh("cd \"$WHERE\" && sh -e $T/sh >$T/printed 2>&1") != 0) {
        sh("tail -n 20 $T/printed");
        fail_msg("%s failed: %s", page, output);
    }
    if (sh("grep -v -e '^$' -e '^\\.\\.\\.$' $T/text | grep -vxFf "
           "$T/printed") != 1)
        fail_msg("%s shows what was not printed:\n%s", page, output);
}

static int setup(void **state)
{
    (void)state;
    if (shell_setup("docs", "exec 2>&1; ") != 0)
        return -1;
    return setenv("BSDF", getenv("ROOT"), 1) ||
           setenv("CPATH", getenv("ROOT"), 1);
}

/* The sources as a clone has them, and what was made of them in the folder
 * that BIN is in, each file younger than those that it was made of. */
static void sources_are_copied(void)
{
    does("mkdir $T/clone && tar cf - --exclude=./build --exclude=./.git . | "
         "tar xf - -C $T/clone");
    if (!getenv("FRESH"))
        does("B=${BIN%/bin}; [ \"$B\" = \"${B#$ROOT/build}\" ] || "
             "{ cd $B && to=$T/clone/${B#$ROOT/} && mkdir -p $to/obj && "
             "for f in bsdf validate plots integrator data; do "
             "cp -r obj/$f $to/obj/; done && cp *.a $to/ && "
             "cp -r scenes $to/ && cp -r bin $to/ && "
             "rm -rf $to/bin/tests && cp $ROOT/build/.setup-* "
             "$T/clone/build/ 2>/dev/null; :; }");
}

/* From a clone to a validated BSDF of one's own, and a figure. */
static void the_readmes_path_leads_there(void **state)
{
    (void)state;
    sources_are_copied();
    unsetenv("CPATH");
    replays("README.md", "tour|Your own BSDF|Reports|Pictures", "clone");
    setenv("CPATH", getenv("ROOT"), 1);
    does("cd $T/clone/build/tour && ls lobe.svg histogram.svg gold.html "
         "matt.so");
}

/* With the programs of the copy, which are made again. */
static void a_model_is_added_as_bsdfs_readme_says(void **state)
{
    (void)state;
    char *path = strdup(getenv("PATH"));
    assert_non_null(path);
    setenv("CFLAGS", "-O0", 1); /* what is new is little, and built sooner */
    does("printf %s \"$T/clone/${BIN#$ROOT/}:$PATH\"");
    setenv("PATH", output, 1);
    replays("bsdf/README.md", "Adding a model", "clone");
    setenv("PATH", path, 1);
    unsetenv("CFLAGS");
    free(path);
}

static void a_table_is_added_as_bsdfs_readme_says(void **state)
{
    (void)state;
    does("mkdir $T/table");
    replays("bsdf/README.md", "Adding a table", "table");
}

static void the_tutorial_runs_in_an_empty_folder(void **state)
{
    (void)state;
    does("mkdir $T/own");
    const bool python = sh("command -v python3") == 0;
    if (!python)
        print_message("skipped, without python3: the same in Python\n");
    replays("validate/TUTORIAL.md",
            python ? "" : "Write it|Have it|Mend it|Look at it|Keep it", "own");
    does("cd $T/own && ls lobe.svg histogram.svg rough.html rough.xml");
}

/* Each check has a section, in which it fails. */
static void every_check_is_shown_failing(void **state)
{
    (void)state;
    replays("validate/README.md", "", "own");
    does("cat $T/own/answers.txt >>$T/printed; bsdf-validate --list | "
         "while read -r check about; do "
         "grep -qx \"## $check\" validate/README.md && "
         "grep -q \"^  $check .* FAIL\" $T/printed || "
         "{ echo $check; exit 1; }; done");
}

/* What a page shows is there, and drawn by its commands, which `make gallery`
 * runs. */
static void pictures_are_drawn_by_the_page(void **state)
{
    (void)state;
    does("for page in validate/README.md plots/GALLERY.md; do "
         "sh tests/blocks.sh sh $page >$T/sh; "
         "sed -n 's/.*!\\[[^]]*\\](\\([^)]*\\)).*/\\1/p' $page | "
         "while read -r f; do [ -s ${page%/*}/$f ] && "
         "grep -q -e \"-o ${f##*/}\\>\" $T/sh || { echo $page: $f; exit 1; }; "
         "done || exit 1; done");
}

static void links_lead_somewhere(void **state)
{
    (void)state;
    does("for page in README.md */*.md */*/*.md; do "
         "[ ! -e $page ] || grep -o '](\\([^)#]*\\)' $page | cut -c 3- | "
         "grep -v '^http' | while read -r f; do "
         "[ -e $(dirname $page)/$f ] || { echo $page: $f; exit 1; }; "
         "done || exit 1; done");
}

static void manual_pages_are_made_of_the_help(void **state)
{
    (void)state;
    if (sh("command -v help2man") != 0) {
        print_message("skipped: no help2man here\n");
        skip();
    }
    does("for p in bsdf/bsdf-info validate/bsdf-validate plots/bsdf-plot "
         "integrator/bsdf-render; do n=${p##*/}; "
         "help2man --no-info --include=$p.h2m -o $T/$n.1 $BIN/$n || exit 1; "
         "for h in NAME SYNOPSIS DESCRIPTION 'EXIT STATUS' 'SEE ALSO'; do "
         "grep -qi \"^.SH \\\"*$h\" $T/$n.1 || { echo $n: $h; exit 1; }; "
         "done; "
         "$BIN/$n --help | grep -o -e '--[a-z][a-z-]*' | sort -u | "
         "sed 's/-/\\\\-/g' | while read -r o; do "
         "grep -qFe \"$o\" $T/$n.1 || { echo $n: $o; exit 1; }; done || "
         "exit 1; done");
    if (sh("command -v man") == 0)
        prints("for f in $T/*.1; do man -l --warnings $f; done 2>&1 >/dev/null",
               "");
}

/* A line up to where the tab key is hit, and the words that may follow. */
static void completes(const char *line, const char *words)
{
    setenv("LINE", line, 1);
    prints("bash -c '. bsdf/completion.bash; COMP_LINE=$LINE "
           "COMP_POINT=${#LINE} COMP_WORDS=(${LINE%% *}); _bsdf; "
           "echo \"${COMPREPLY[*]}\"'",
           words);
}

static void the_shell_completes_what_there_is(void **state)
{
    (void)state;
    if (sh("command -v bash") != 0) {
        print_message("skipped: no bash here\n");
        skip();
    }
    completes("bsdf-validate --sk", "--skip=\n");
    completes("bsdf-validate diffuse --skip fi", "finite\n");
    completes("bsdf-validate diffuse --skip=f", "finite furnace\n");
    completes("bsdf-validate rough", "roughconductor: roughdielectric:\n");
    completes("bsdf-validate roughconductor:al", "alpha= alpha_u= alpha_v=\n");
    completes("bsdf-validate roughconductor:alpha=0.1,sample", /* from the = */
              "0.1,sample_visible=\n");
    completes("bsdf-validate roughconductor:distribution=", "beckmann ggx\n");
    completes("bsdf-plot lobe conductor:material=Ca", "Ca/Mathewson Ca\n");
    completes("bsdf-plot lobe3", "lobe3d\n");
    completes("bsdf-plot lobe --wo 45,0 mir", "mirror:\n");
    completes("bsdf-plot ior W", "W/Weaver W\n");
    completes("bsdf-plot report plots/bsdf-plot.h", "plots/bsdf-plot.h2m\n");
    completes("bsdf-info al", "albedo\n");
    completes("bsdf-info -n 4 ior Fe/", "Fe/Johnson\n");
    completes("bsdf-info ior Fe --as m", "mitsuba\n");
    completes("bsdf-info ior --rgb=av", "average\n");
    completes("bsdf-render --ad", "--adaptive=\n");
    completes("bsdf-validate --nm ", "\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "the README's path leads from a clone to a figure",
          the_readmes_path_leads_there },
        { "a model is added as bsdf/README.md says",
          a_model_is_added_as_bsdfs_readme_says },
        { "a table is added as bsdf/README.md says",
          a_table_is_added_as_bsdfs_readme_says },
        { "the tutorial runs in an empty folder",
          the_tutorial_runs_in_an_empty_folder },
        { "every check is shown failing", every_check_is_shown_failing },
        { "pictures are drawn by the page that shows them",
          pictures_are_drawn_by_the_page },
        { "links lead somewhere", links_lead_somewhere },
        { "manual pages are made of the help",
          manual_pages_are_made_of_the_help },
        { "the shell completes what there is",
          the_shell_completes_what_there_is },
    };
    return cmocka_run_group_tests_name("docs", tests, setup, shell_teardown);
}
