/* test_install.c - what `make install` leaves is whole without the sources
 *
 * Installs the release build into a folder of its own, once by PREFIX and once
 * by DESTDIR, and uses it from there as a stranger would.  The staging folder
 * is the test's as well, so that build/install/ stays as it is.
 */
#include <stdio.h>
#include <stdlib.h>

#include "bsdf/bsdf.h"
#include "tests/close.h"
#include "tests/shell.h"

/* The settings of the make that runs this test are not those of the one that
 * installs: a library with sanitizers would not link by itself.  The programs
 * that were built are not in PATH. */
static int setup(void **state)
{
    (void)state;
    if (shell_setup("install", "exec 2>&1; PATH=${PATH#*:}; ") != 0)
        return -1;
    static const char *const settings[] = {
        "MAKEFLAGS", "MFLAGS", "MAKELEVEL", "MAKEOVERRIDES",
        "config",    "PREFIX", "DESTDIR",   "BSDF_DATA",
        "WRAP",      "BIN",    "LD_PRELOAD"
    };
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++)
        unsetenv(settings[i]);
    return 0;
}

static void install_fills_a_prefix(void **state)
{
    (void)state;
    does("make -j2 install PREFIX=$T/usr STAGE=$T/stage");
    does("cd $T/usr/bin && [ -x bsdf-info -a -x bsdf-plot -a -x bsdf-validate "
         "]");
    prints("cd $T/usr && ls lib lib/pkgconfig",
           "lib:\nlibbsdf.a\npkgconfig\n\nlib/pkgconfig:\nlibbsdf.pc\n");
    /* The mesh of a scene in place of the program that makes it. */
    does("diff -r -x 'knot.*' data $T/usr/share/bsdf/data && "
         "test -s $T/usr/share/bsdf/data/scenes/knot.ply && "
         "test ! -e $T/usr/share/bsdf/data/scenes/knot.c");
    does("cmp validate/report.schema.json "
         "$T/usr/share/bsdf/report.schema.json");
}

/* Manual pages where there is help2man, else a word that there are none. */
static void manuals_and_completion_come_along(void **state)
{
    (void)state;
    does("cd $T/usr/share/bash-completion/completions && "
         "ls bsdf-info bsdf-plot bsdf-render bsdf-validate");
    if (sh("command -v bash") == 0)
        prints("PATH=$T/usr/bin:$PATH bash -c '. "
               "$T/usr/share/bash-completion/completions/bsdf-plot; "
               "complete -p bsdf-plot; COMP_LINE=\"bsdf-plot lobe3\" "
               "COMP_POINT=15 COMP_WORDS=(bsdf-plot); _bsdf; "
               "echo $COMPREPLY'",
               "complete -o default -F _bsdf bsdf-plot\nlobe3d\n");
    if (sh("command -v help2man") == 0)
        does("cd $T/usr/share/man/man1 && for p in bsdf-info bsdf-plot "
             "bsdf-render bsdf-validate; do grep -qi \"^.TH $p\" $p.1 || "
             "exit 1; done");
    does("make install HAS_HELP2MAN= PREFIX=$T/bare STAGE=$T/stage");
    assert_has(output, "without manual pages");
    does("ls $T/bare/bin/bsdf-validate && [ ! -e $T/bare/share/man ] && "
         "make uninstall PREFIX=$T/bare && rm -r $T/bare");
}

static void relative_prefixes_are_refused(void **state)
{
    (void)state;
    ends("make install PREFIX=usr STAGE=$T/none", 2);
    assert_has(output, "absolute");
    ends("make uninstall PREFIX='/a b'", 2);
    assert_has(output, "spaces");
}

static void every_header_stands_alone(void **state)
{
    (void)state;
    does("cd $T/usr/include && for h in bsdf/*.h; do "
         "echo \"#include \\\"$h\\\"\" | cc -Wall -Werror -I$T/usr/include "
         "-fsyntax-only -x c - || exit 1; done");
}

/* Of the installed files alone, by the host that is beside the program. */
static void a_plugin_needs_one_header(void **state)
{
    (void)state;
    does("echo '#include \"bsdf/plugin.h\"' | cc -std=c99 -pedantic -Wall "
         "-Werror -I$T/usr/include -fsyntax-only -x c -");
    does("cc -shared -fPIC -O2 -I$T/usr/include -o $T/glass.so "
         "tests/plugins/glass.c -lm");
    does("cd $T && usr/bin/bsdf-validate ./glass.so:eta=1.5 --wo 30,0 "
         "--samples 1000");
    assert_has(output, " 0 failed");
    if (sh("command -v c++") == 0)
        does("echo '#include \"bsdf/course.hpp\"' | c++ -std=c++11 -pedantic "
             "-Wall -Werror -I$T/usr/include -fsyntax-only -x c++ -");
    else
        print_message("skipped: no C++ compiler here\n");
}

static const char user[] =
    "#include <stdio.h>\n"
    "#include \"bsdf/bsdf.h\"\n"
    "int main(void)\n"
    "{\n"
    "    const struct bands bands = { .count = 3, .nm = { 614, 549, 466 } };\n"
    "    struct err err;\n"
    "    struct bsdf *b = bsdf_new(\"roughconductor:material=Ca,alpha=0.25\",\n"
    "                              &bands, &err);\n"
    "    if (!b)\n"
    "        return printf(\"%s\\n\", err.text), 1;\n"
    "    struct vec3 wo = dir_from_degrees(45, 0);\n"
    "    struct vec3 wi = dir_from_degrees(41, 163);\n"
    "    printf(\"%.17g\\n\", bsdf_eval(b, wo, wi).band[2]);\n"
    "    bsdf_free(b);\n"
    "}\n";

static void pkg_config_and_a_plain_cc_make_a_program(void **state)
{
    (void)state;
    if (sh("command -v pkg-config") != 0) {
        print_message("no pkg-config here, so nothing to ask it\n");
        skip();
    }
    FILE *f = fopen(in_folder("user.c"), "w");
    assert_non_null(f);
    fputs(user, f);
    fclose(f);
    prints("cd $T && export PKG_CONFIG_PATH=$T/usr/lib/pkgconfig && "
           "cc user.c $(pkg-config --cflags --libs libbsdf) -o user",
           "");

    const struct bands bands = { .count = 3, .nm = { 614, 549, 466 } };
    struct err err;
    struct bsdf *b =
        bsdf_new("roughconductor:material=Ca,alpha=0.25", &bands, &err);
    assert_non_null(b);
    const double f466 =
        bsdf_eval(b, dir_from_degrees(45, 0), dir_from_degrees(41, 163))
            .band[2];
    bsdf_free(b);
    does("cd / && $T/user");
    assert_true(f466 > 0.1);
    assert_close(atof(output), f466, 1e-13 * f466);
}

static void programs_work_from_anywhere(void **state)
{
    (void)state;
    does("cd / && $T/usr/bin/bsdf-info list");
    assert_has(output, "roughconductor");
    assert_has(output, "Ca/Mathewson");
    prints("cd / && $T/usr/bin/bsdf-info ior Ca --nm 614,549,466 | "
           "grep -v '^#' | awk '{printf \"%d %.5f %.5f\\n\", $1, $2, $3}'",
           "614 0.29294 2.71809\n549 0.28568 2.34786\n466 0.28733 1.83329\n");
    does("cd / && $T/usr/bin/bsdf-validate diffuse --samples 10000");
    assert_has(output, "0 failed");
}

/* With the installed tables out of the way nothing is found, although those of
 * the sources are where they were. */
static void tables_are_the_installed_ones(void **state)
{
    (void)state;
    does("mv $T/usr/share/bsdf/data $T/away");
    const int info = sh("cd / && $T/usr/bin/bsdf-info ior Ca");
    assert_has(output, folder);
    assert_has(output, "/usr/share/bsdf/data/ior");
    const int program = sh("cd / && { [ ! -e $T/user ] || $T/user; }");
    const bool built = sh("[ -e $T/user ]") == 0;
    does("mv $T/away $T/usr/share/bsdf/data");
    assert_int_equal(info, 2);
    assert_int_equal(program, built ? 1 : 0);
    prints("grep -rlF \"$ROOT/data\" $T/usr || :", "");
}

static void destdir_is_in_no_file(void **state)
{
    (void)state;
    does("make -j2 install PREFIX=/opt/of-a-package DESTDIR=$T/dest "
         "STAGE=$T/stage");
    prints("cd $T/dest && ls . opt && grep -rlF $T . || :",
           ".:\nopt\n\nopt:\nof-a-package\n");
    does("cd $T/dest/opt/of-a-package && "
         "grep -x prefix=/opt/of-a-package lib/pkgconfig/libbsdf.pc && "
         "grep -q /opt/of-a-package/share/bsdf/data bin/bsdf-info "
         "lib/libbsdf.a");
    does("make uninstall PREFIX=/opt/of-a-package DESTDIR=$T/dest");
    prints("find $T/dest ! -type d", "");
}

static void uninstall_takes_what_is_ours_alone(void **state)
{
    (void)state;
    does("touch $T/usr/bin/other $T/usr/share/bsdf/data/ior/Ca/Mine.yml");
    does("make uninstall PREFIX=$T/usr");
    prints("cd $T/usr && find . ! -type d | sort",
           "./bin/other\n./share/bsdf/data/ior/Ca/Mine.yml\n");
    does("make uninstall PREFIX=$T/usr"); /* where there is nothing to do */
    does("rm -r $T/usr");
    does("make install PREFIX=$T/usr STAGE=$T/stage");
    does("make uninstall PREFIX=$T/usr");
    prints("cd $T/usr && find . | sort",
           ".\n./bin\n./include\n./lib\n./lib/pkgconfig\n./share\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "install fills a prefix", install_fills_a_prefix },
        { "manual pages and completion come along",
          manuals_and_completion_come_along },
        { "relative prefixes and spaces are refused",
          relative_prefixes_are_refused },
        { "every installed header stands alone", every_header_stands_alone },
        { "a plugin needs one header", a_plugin_needs_one_header },
        { "pkg-config and a plain cc make a program",
          pkg_config_and_a_plain_cc_make_a_program },
        { "the installed programs work from anywhere",
          programs_work_from_anywhere },
        { "the tables read are the installed ones",
          tables_are_the_installed_ones },
        { "DESTDIR is in no file", destdir_is_in_no_file },
        { "uninstall takes what is ours alone",
          uninstall_takes_what_is_ours_alone },
    };
    return cmocka_run_group_tests_name("install", tests, setup, shell_teardown);
}
