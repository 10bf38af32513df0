/* test_figures.c - every kind of figure in every form: whole, the same again,
 * and with the numbers that it should have
 */
#include "bsdf/fresnel.h"
#include "bsdf/ndf.h"
#include "plots/text.h"
#include "tests/plotting.h"

#include "bsdf/bsdf.h"

/* A metal, glass, and one that is neither. */
static const char *const specs[] = {
    "roughconductor:material=Ca,alpha=0.25",
    "roughdielectric:alpha=0.1",
    "diffuse:reflectance=0.2/0.5/0.8",
};
static const char *const forms[] = { "svg", "pdf", "png", "tex" };

/* What a kind is asked for; %s is a spec.  Files are those of setup_files. */
static const struct asked {
    const char *name, *line;
    int subjects; /* of specs; or 0 for what each[] has */
    const char *each[3];
} kinds[] = {
    { "lobe", "lobe %s --wo 57,31", 3, { NULL } },
    { "lobelog", "lobe %s --wo 57,31 --wo 10,0 --log --phi 20", 3, { NULL } },
    { "lobe3d", "lobe3d %s --wo 57,31", 3, { NULL } },
    { "lobe3dlog", "lobe3d %s --wo 57,31 --log", 3, { NULL } },
    { "histogram", "histogram %s --wo 57,31", 3, { NULL } },
    { "half", "histogram %s --wo 57,31 --zoom half", 3, { NULL } },
    { "disk", "histogram %s --wo 57,31 --zoom disk", 3, { NULL } },
    { "slice", "slice %s", 3, { NULL } },
    { "albedo", "albedo %s", 3, { NULL } },
    { "convergence", "convergence %s --wo 57,31", 3, { NULL } },
    { "compare", "compare roughconductor %s --wo 57,31", 3, { NULL } },
    { "ndf",
      "ndf %s",
      0,
      { "roughconductor:material=Ca,alpha=0.25", "roughdielectric:alpha=0.1",
        "course_microfacet:material=Au --phi 30" } },
    { "fresnel",
      "fresnel %s",
      0,
      { "roughconductor:material=Ca,alpha=0.25", "roughdielectric:alpha=0.1",
        "conductor:material=Cu --nm 650,550,500,450" } },
    { "ior",
      "ior %s",
      0,
      { "Ca", "BK7,Au/Johnson --nm 480", "H2O,$T/b/x.yml,$T/b/y.yml" } },
    { "colour", "colour %s", 0, { "Ca", "Au,Cu", "Ti --nm 600,540,450" } },
    { "killmatrix",
      "kill-matrix %s",
      0,
      { "$T/matrix.tsv", "$T/matrix.tsv", "$T/matrix.tsv" } },
    { "pvalues", "p-values %s", 0, { "$T/p.tsv", "$T/run.json", "$T/p.tsv" } },
    { "series",
      "series %s",
      0,
      { "$T/measured.tsv", "$T/measured.tsv --log", "$T/wide.tsv --log" } },
};
enum { KINDS = sizeof kinds / sizeof *kinds, SUBJECTS = 3 };

/* A kind asked for in another way: SVG and TeX will do. */
static bool variant(int kind)
{
    static const char *const names[] = { "lobelog", "lobe3dlog", "half",
                                         "disk" };
    for (int i = 0; i < 4; i++)
        if (strcmp(kinds[kind].name, names[i]) == 0)
            return true;
    return false;
}

static void request(char *line, size_t size, int kind, int subject)
{
    const struct asked *k = &kinds[kind];
    char what[512];
    snprintf(what, sizeof what, k->line,
             k->subjects ? specs[subject] : k->each[subject]);
    snprintf(line, size, "%s --samples 3000", what);
}

/* The files that kinds read. */
static int setup_files(void **state)
{
    static const char files[] =
        "cd $T; printf '# a comment\nname\tsize\tpdf\tchi2\tenergy\tsmallest "
        "scale\tstatus\nno cosine\t1\tfails\tfails\t-\t0.01\tcaught\nswapped & "
        "{odd}\t2\tpasses\tfails\tfails\t0.5\tcaught\ncontrol\t0\tpasses\t"
        "passes\t-\t-\tpassed\n' >matrix.tsv; { printf 'name\tp\n'; "
        "awk 'BEGIN { for (i = 0; i < 200; i++) { x = i * 0.61803398875; "
        "printf \"one, two\\t%.17g\\n\", x - int(x) } for (i = 0; i < 50; i++) "
        "printf \"small\\t%.17g\\n\", i * i / 3000 }'; } >p.tsv; "
        "bsdf-validate diffuse roughconductor --samples 2000 --json run.json "
        ">made; mkdir b; for n in x y; do { echo 'REFERENCES: a page'; echo "
        "'DATA:'; echo '  - type: tabulated nk'; echo '    data: |'; for l in "
        "0.4 0.5 0.6 0.8; do echo \"        $l 1.$(echo $n | tr xy 36) 0.01\"; "
        "done; } >b/$n.yml; done; printf 'curve\tM [1]\tL [W/(m² sr)]\terror\n"
        "one & {odd}\t0\t1e-3\t0\none & {odd}\t1\t2.5\t3\ntwo\t1\t0\t.1\n"
        "limit\t-\t3\t0\n' >measured.tsv; printf 'c\talpha [1]\tn\te\n"
        "a\t.001\t5\t1\na\t0.5\t7\t.1\n' >wide.tsv";
    if (setup(state) != 0)
        return -1;
    quiet(files);
    return 0;
}

/* -- all of them ------------------------------------------------------------
 */

/* It was drawn without a word of gnuplot's; the files beside it are there,
 * listed in order, and whole. */
static void assert_all_whole(const char *stem, const char *form)
{
    char line[2048], name[64];
    const bool tex = strcmp(form, "tex") == 0;
    snprintf(
        line, sizeof line,
        "cd $T; grep -v 'bsdf-plot: warning: ' %s.said >&2 || true; [ $(cat "
        "%s.status) = 0 ]; printf '%%s\\n' $T/%s.tsv $T/%s.gp "
        "$T/%s.caption %s%s%s $T/%s.%s | cmp - %s.made; [ -s %s.tsv ]; [ "
        "-s %s.gp ]; grep -q 'bsdf-plot.* 0' %s.caption; [ $(wc -l "
        "<%s.caption) = 1 ]",
        stem, stem, stem, stem, stem, tex ? "$T/" : "", tex ? stem : "",
        tex ? ".pdf" : "", stem, form, stem, stem, stem, stem, stem);
    quiet(line);
    snprintf(name, sizeof name, "%s.%s", stem, form);
    assert_whole(name);
    if (strcmp(form, "svg") == 0)
        snprintf(line, sizeof line,
                 "! command -v xmllint >$T/found || xmllint --noout $T/%s",
                 name);
    else
        snprintf(line, sizeof line,
                 "! command -v pdfinfo >$T/found || ! [ -e $T/%s.pdf ] || "
                 "pdfinfo $T/%s.pdf",
                 stem, stem);
    quiet(line);
}

/* A kind's three at the same time. */
static void draw_all(const char *form)
{
    for (int k = 0; k < KINDS; k++) {
        char line[4096] = "cd $T; ", stem[32];
        if (variant(k) && strcmp(form, "svg") != 0 && strcmp(form, "tex") != 0)
            continue;
        for (int i = 0; i < SUBJECTS; i++) {
            char what[1024];
            const size_t n = strlen(line);
            request(what, sizeof what, k, i);
            snprintf(stem, sizeof stem, "%s%d-%s", kinds[k].name, i, form);
            snprintf(line + n, sizeof line - n,
                     "{ bsdf-plot %s -o $T/%s.%s >%s.made 2>%s.said; echo $? "
                     ">%s.status; } & ",
                     what, stem, form, stem, stem, stem);
        }
        strcat(line, "wait");
        quiet(line);
        for (int i = 0; i < SUBJECTS; i++) {
            snprintf(stem, sizeof stem, "%s%d-%s", kinds[k].name, i, form);
            assert_all_whole(stem, form);
        }
    }
}

static void every_kind_is_whole(void **form)
{
#ifdef __SANITIZE_ADDRESS__
    /* What differs between forms is gnuplot's; TeX's letters are ours. */
    if (strcmp(*form, "pdf") == 0 || strcmp(*form, "png") == 0)
        skip();
#endif
    draw_all(*form);
}

/* With all that any of them holds. */
static void tex_sets_every_kind_in_the_documents_fonts(void **state)
{
    (void)state;
    if (sh("command -v pdflatex pdffonts >/dev/null 2>&1") != 0) {
        print_message("skipped: there is no pdflatex, or no pdffonts\n");
        skip();
    }
    quiet("cd $T; ! grep -F 'U+' *-tex.tex *-tex.caption >&2");
    quiet("cd $T; { printf '%s\\n' '\\documentclass{article}' "
          "'\\usepackage{graphicx,color}' '\\begin{document}'; for t in "
          "*-tex.tex; do printf '%s\\n' '\\begin{figure}' "
          "\"\\\\input{$t}\" \"\\\\caption{\\\\protect\\\\input{"
          "${t%.tex}.caption}}\" '\\end{figure}' '\\clearpage'; done; printf "
          "'%s\\n' '\\end{document}'; } >doc.tex; pdflatex -halt-on-error "
          "-interaction=batchmode doc.tex >tex.out || { cat tex.out; grep "
          "-A 3 '^!' doc.log; } >&2");
    quiet("cd $T; pdffonts doc.pdf >fonts; grep -q CMR fonts; ! grep -i dejavu "
          "fonts >&2; [ $(pdfinfo doc.pdf | sed -n 's/^Pages: *//p') -ge 40 ]");
}

static void the_same_request_gives_the_same_bytes(void **state)
{
    (void)state;
    for (int k = 0; k < KINDS; k++) {
        char line[2048], what[1024];
        request(what, sizeof what, k, k % SUBJECTS);
        snprintf(line, sizeof line,
                 "cd $T; for n in 1 2; do mkdir again; cd again; TZ=XYZ$n "
                 "OMP_NUM_THREADS=$n bsdf-plot %s -o x.%s 2>&-; cd ..; mv "
                 "again again$n; done; diff -r again1 again2 >&2; rm -r again1 "
                 "again2",
                 what, forms[(k + 1) % 4]);
        quiet(line);
    }
}

/* A script draws what was drawn, the TeX of it as well. */
static void a_tex_figure_redraws_itself(void **state)
{
    (void)state;
    quiet("cd $T; bsdf-plot lobe diffuse --wo 20,0 -o again.tex >made; cp "
          "again.tex first; rm again.tex again.pdf; gnuplot again.gp; cmp "
          "first again.tex; rm again.*");
}

/* -- how they look ----------------------------------------------------------
 */

static void a_width_is_that_of_the_picture(void **state)
{
    (void)state;
    quiet("cd $T; for f in svg pdf png tex; do bsdf-plot lobe diffuse --wo "
          "20,0 --width 127 -o w$f.$f >made; done; grep -q '^ width=\"480\"' "
          "wsvg.svg; ! command -v pdfinfo >$T/found || for p in wpdf wtex; do "
          "pdfinfo "
          "$p.pdf | grep -q 'Page size: *360 x'; done; grep -q "
          "'fontsize{5.4}' wtex.tex");
    assert_whole_wide("wpng.png", 960);
}

/* Nor of what TeX is drawn under. */
static void nothing_is_left_where_gnuplot_fails(void **state)
{
    (void)state;
    quiet("mkdir $T/fails; cd $T/fails; echo 'no such command' >s.gp");
    ends("cd $T/fails; bsdf-plot lobe diffuse --wo 20,0 --style s.gp -o x.tex "
         "2>&1 >made",
         2);
    assert_has(output, "no such command");
    assert_has(output, "gnuplot failed");
    quiet("cd $T/fails; [ \"$(ls | tr '\\n' ' ')\" = 'made s.gp x.caption x.gp "
          "x.tsv ' ]; rm -r $T/fails");
}

static void a_style_has_the_last_word(void **state)
{
    (void)state;
    quiet(
        "cd $T; echo 'set linetype 9 lc rgb \"#123456\" dt 3 lw 7' >mine.gp; "
        "bsdf-plot lobe diffuse --wo 20,0 --style mine.gp -o s.svg >made; rm "
        "mine.gp; bsdf-plot lobe diffuse --wo 20,0 -o plain.svg >made; grep -q "
        "'18,  *52,  *86' s.svg; ! grep -q '18,  *52,  *86' plain.svg");
    refused("bsdf-plot lobe diffuse --wo 20,0 --style none.gp", "none.gp",
            "No such file");
}

static void a_caption_says_how_it_was_made(void **state)
{
    (void)state;
    quiet("cd $T; bsdf-plot histogram "
          "roughconductor:alpha_u=0.3,alpha_v=0.2 --wo 20,10 --nm 614,549 "
          "--seed 42 --samples 5000 -o cap.svg >made; for w in "
          "'roughconductor:alpha_u=0.3,alpha_v=0.2' '614, 549 nm' 'Seed 42' "
          "'5000 samples' 'θ = 20°, φ = 10°' 'histogram 0.'; do grep -q -F "
          "\"$w\" cap.caption; done; bsdf-plot lobe "
          "roughconductor:alpha_u=0.3,alpha_v=0.2 --wo 20,10 -o cap.tex >made; "
          "grep -q -F 'alpha\\_\\allowbreak{}u' cap.caption");
}

static void a_window_is_opened_or_one_line_says_why_not(void **state)
{
    (void)state;
    ends("cd $T; rm -f win.*; { env -u DISPLAY -u WAYLAND_DISPLAY bsdf-plot "
         "lobe "
         "diffuse --wo 20,0 --interactive -o win.svg 2>&1 >made; }",
         2);
    assert_has(output, "bsdf-plot: --interactive: ");
    assert_ptr_equal(strchr(output, '\n'), output + strlen(output) - 1);
    assert_whole("win.svg");
    /* A gnuplot that has one draws the same script into it. */
    quiet("mkdir -p $T/gp; cd $T/gp; printf '#!/bin/sh\\ncase \"$*\" in "
          "*TERMINALS*) echo svg x11 qt >&2;; *window*) echo \"$*\" "
          ">$T/asked;; *) exec %s \"$@\";; esac\\n' \"$(command -v gnuplot)\" "
          ">gnuplot; chmod +x gnuplot; cd ..; DISPLAY=:9 PATH=$T/gp:$PATH "
          "bsdf-plot lobe diffuse --wo 20,0 --interactive -o win.svg >made; "
          "grep -q \"window = 'x11 size 800\" asked; grep -q './win.gp' asked; "
          "rm -r gp");
}

static void tex_is_given_what_it_can_set(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        { "alpha_u 5% {x} #1 & $", "\\relax{}alpha\\_u 5\\% \\{x\\} \\#1 \\& "
                                   "\\$" },
        { "θᵢ = 45°", "\\relax{}$\\theta_i$ = 45$^\\circ$" },
        { "10⁻³/sr", "\\relax{}10$^-$$^3$/sr" },
        { "a\\b ~^ [1]", "\\relax{}a\\textbackslash{}b "
                         "\\textasciitilde{}\\textasciicircum{} {[}1]" },
        { "ж€𝛼", "\\relax{}U+0436U+20ACU+1D6FC" },
        { "", "\\relax{}" },
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        char *tex = text_tex(pairs[i][0]);
        assert_non_null(tex);
        assert_string_equal(tex, pairs[i][1]);
        free(tex);
    }
}

/* -- what goes wrong --------------------------------------------------------
 */

static void options_that_a_kind_has_no_use_for_are_refused(void **state)
{
    (void)state;
    refused("bsdf-plot histogram diffuse --wo 1,0 --log", "--log",
            "lobe, lobe3d, compare");
    refused("bsdf-plot lobe diffuse --wo 1,0 --zoom half", "--zoom",
            "histogram");
    refused("bsdf-plot ior Ca --wo 1,0", "--wo", "lobe");
    refused("bsdf-plot histogram diffuse --wo 1,0 --wo 2,0", "histogram",
            "one --wo");
    refused("bsdf-plot lobe diffuse --wo 1,0 --wo 2,0 --wo 3,0 --wo 4,0 --wo "
            "5,0",
            "5,0", "at most 4");
    refused("bsdf-plot histogram diffuse --wo 1,0 --zoom quarter", "quarter",
            "half, disk");
    refused("bsdf-plot compare diffuse --wo 1,0", "compare", "two SPECs");
    refused("bsdf-plot lobe diffuse --wo 1,0 --width 10", "--width", "40");
    refused("bsdf-plot lobe diffuse --wo 1,0 --phi north", "north", "--phi");
    refused("bsdf-plot lobe diffuse --wo 1,0 -o a_b.tex", "a_b.tex", "TeX");
    refused("bsdf-plot report $T/run.json --width 100", "--width", "report");
    refused("bsdf-plot ndf diffuse", "diffuse", "microfacet");
    refused("bsdf-plot fresnel diffuse", "diffuse", "metal or glass");
    refused("bsdf-plot slice mirror", "mirror", "nothing to draw");
    refused("bsdf-plot convergence mirror --wo 1,0", "weight", "1");
    refused("bsdf-plot colour SiO2", "k", "SiO2");
    refused("bsdf-plot colour Ca,,Au", "name", "missing");
    refused("bsdf-plot histogram thindielectric --wo 1,0 --zoom half", "delta",
            "density");
}

static void bad_files_are_refused_by_line(void **state)
{
    (void)state;
#define HEAD "name\\tsize\\tpdf\\tsmallest scale\\tstatus\\n"
    refused("bsdf-plot kill-matrix $T/none.tsv", "none.tsv", "No such file");
    refused("printf '" HEAD "a\\t1\\tmaybe\\t1\\tx\\n' >$T/bad; bsdf-plot "
            "kill-matrix $T/bad",
            "bad:2: pdf \"maybe\"", "fails, passes or -");
    refused("printf '" HEAD "a\\t1\\tfails\\t1\\n' >$T/bad; bsdf-plot "
            "kill-matrix $T/bad",
            "bad:2: 4 fields", "expected 5");
    refused("printf '#\\n" HEAD "a\\t1\\tfails\\t2\\tx\\n' >$T/bad; bsdf-plot "
            "kill-matrix $T/bad",
            "bad:3: smallest scale \"2\"", "1]");
    refused("printf 'a\\tb\\n1\\t2\\n' >$T/bad; bsdf-plot kill-matrix $T/bad",
            "no column \"name\"", "a, b");
    refused("printf '" HEAD "' >$T/bad; bsdf-plot kill-matrix $T/bad",
            "no rows", "line of names");
    refused("printf 'name\\tp\\nx\\t0.5\\nx\\t1.5\\n' >$T/bad; bsdf-plot "
            "p-values $T/bad",
            "bad:3: p \"1.5\"", "[0, 1]");
    refused("printf 'name\\tp\\nx\\tnan\\n' >$T/bad; bsdf-plot p-values $T/bad",
            "bad:2: p \"nan\"", "[0, 1]");
    refused("printf 'name\\tp\\nx\\t\\0\\n' >$T/bad; bsdf-plot p-values $T/bad",
            "bad", "zero byte");
    refused("echo '{}' >$T/bad.json; bsdf-plot p-values $T/bad.json",
            "bad.json", "expected");
    refused("bsdf-plot p-values /dev/null", "/dev/null", "no rows");
    refused("bsdf-plot series $T/p.tsv", "2 columns", "expected 4");
    refused("printf 'c\\tx\\ty\\te\\na\\t1\\t2\\t-1\\n' >$T/bad; bsdf-plot "
            "series $T/bad",
            "bad:2: e \"-1\"", "[0, ");
    refused("printf 'c\\tx\\ty\\te\\na\\t-\\t2\\t1\\n' >$T/bad; bsdf-plot "
            "series $T/bad",
            "bad", "no point");
    refused(
        "{ printf 'c\\tx\\ty\\te\\n'; for i in 1 2 3 4 5 6 7 8 9; do printf "
        "\"$i\\t1\\t2\\t1\\n\"; done; } >$T/bad; bsdf-plot series $T/bad",
        "bad:10: \"9\"", "too many");
#undef HEAD
}

/* -- numbers ----------------------------------------------------------------
 */

static void fresnel_is_that_of_the_library(void **state)
{
    (void)state;
    quiet("bsdf-plot fresnel conductor:eta=0.31,k=2.9 --nm 550 -o "
          "$T/f.svg; bsdf-plot fresnel dielectric:int_ior=1.5,ext_ior=1 -o "
          "$T/g.svg; grep -q '>critical 41.81°<' $T/g.svg; grep -q '>Brewster "
          "56.31°<' $T/g.svg");
    for (int glass = 0; glass < 2; glass++) {
        const struct table t = table_read(glass ? "g.tsv" : "f.tsv");
        for (size_t i = 0; i < t.rows; i++) {
            const double c =
                i + 1 == t.rows ? 0 : cos(table_at(&t, i, 0) * PI / 180);
            const double exact = glass ? fresnel_dielectric(c, 1.5, NULL)
                                       : fresnel_conductor(c, 0.31, 2.9);
            const double r0 = glass ? 0.04 : fresnel_conductor(1, 0.31, 2.9);
            assert_close(table_at(&t, i, 3), exact, 1e-14);
            assert_close((table_at(&t, i, 1) + table_at(&t, i, 2)) / 2, exact,
                         1e-12);
            assert_close(table_at(&t, i, 5), fresnel_schlick(c, r0), 1e-12);
            assert_close(table_at(&t, i, 7),
                         table_at(&t, i, 5) - table_at(&t, i, 3), 1e-14);
            if (!glass)
                assert_close(table_at(&t, i, 4),
                             fresnel_conductor_approx(c, 0.31, 2.9), 1e-14);
        }
        free(t.value);
    }
}

static void facets_are_those_of_both_families(void **state)
{
    (void)state;
    quiet("bsdf-plot ndf roughconductor:alpha_u=0.3,alpha_v=0.1 --phi 25 -o "
          "$T/n.svg");
    const struct table t = table_read_block("n.tsv", 2);
    for (size_t i = 0; i < t.rows; i++) {
        const struct vec3 w = dir_from_degrees(table_at(&t, i, 0), 25);
        assert_close(table_at(&t, i, 1), ndf_d(&ndf_beckmann, 0.3, 0.1, w),
                     1e-12);
        assert_close(table_at(&t, i, 3), ndf_g1(&ndf_beckmann, 0.3, 0.1, w),
                     1e-12);
    }
    free(t.value);
    quiet("sed '1,/^# GGX/d' $T/n.tsv >$T/ggx.tsv");
    const struct table g = table_read("ggx.tsv");
    for (size_t i = 0; i < g.rows; i++)
        assert_close(
            table_at(&g, i, 1),
            ndf_d(&ndf_ggx, 0.3, 0.1, dir_from_degrees(table_at(&g, i, 0), 25)),
            1e-12);
    free(g.value);
}

static void an_albedo_is_that_of_a_mean_and_of_quadrature(void **state)
{
    (void)state;
    quiet("bsdf-plot albedo diffuse:reflectance=0.2/0.5/0.8 -o $T/al.svg; "
          "bsdf-plot albedo roughconductor:alpha=0.4 --samples 5e5 -o "
          "$T/lost.svg");
    const struct table t = table_read_block("al.tsv", 2);
    for (size_t i = 0; i < t.rows; i++)
        for (size_t b = 0; b < 3; b++)
            assert_close(table_at(&t, i, 1 + b), 0.2 + 0.3 * (double)b, 1e-9);
    free(t.value);
    /* F is 1: what is lost is the same in both maps. */
    quiet("grep -A 240 'lost where F' $T/lost.tsv >$T/map.tsv");
    const struct table m = table_read("map.tsv");
    assert_int_equal(m.rows, 240);
    for (size_t i = 0; i < m.rows; i++) {
        assert_close(table_at(&m, i, 3), table_at(&m, i, 4), 0.03);
        assert_close(table_at(&m, i, 2) + table_at(&m, i, 3), 1, 1e-12);
        assert_true(table_at(&m, i, 3) > -0.05 && table_at(&m, i, 3) < 0.7);
    }
    free(m.value);
}

static void errors_fall_as_they_should(void **state)
{
    (void)state;
    quiet("bsdf-plot convergence diffuse:reflectance=0.5 --wo 30,0 --nm 550 "
          "--samples 1e6 -o $T/c.svg; grep -q 'every weight is the albedo' "
          "$T/c.svg");
    const struct table t = table_read("c.tsv");
    /* 2 f cos pi = cos, over cos uniform in [0, 1]: variance 1/12 */
    for (size_t i = 0; i < t.rows; i++)
        assert_close(log(table_at(&t, i, 2) * sqrt(table_at(&t, i, 0) * 12)), 0,
                     log(2.5));
    free(t.value);
}

static void a_cut_is_at_the_azimuth_that_was_asked_for(void **state)
{
    (void)state;
    const char *spec = "roughconductor:alpha_u=0.3,alpha_v=0.1";
    quiet("bsdf-plot lobe roughconductor:alpha_u=0.3,alpha_v=0.1 --wo 40,20 "
          "--phi 75 --nm 550 --log -o $T/cut.svg; grep -q 'φ = 75°' "
          "$T/cut.svg");
    const struct table t = table_read("cut.tsv");
    struct bsdf *b =
        bsdf_new(spec, &(struct bands){ 1, { 550 }, BANDS_NM }, NULL);
    assert_non_null(b);
    for (size_t i = 0; i < t.rows; i++) {
        const double theta = table_at(&t, i, 0);
        const double f =
            bsdf_eval(b, dir_from_degrees(40, 20), dir_from_degrees(theta, 75))
                .band[0];
        assert_close(table_at(&t, i, 1), f, 1e-9 * (1 + f));
    }
    bsdf_free(b);
    free(t.value);
    /* The plane of incidence, seen from the other side. */
    quiet(
        "cd $T; bsdf-plot lobe roughconductor --wo 40,20 --phi 20 -o cut.svg; "
        "grep -q 'φ = 20°, positive toward it' cut.svg; ! grep -q 'not in "
        "it' cut.svg; bsdf-plot lobe roughconductor --wo 40,20 --phi 200 -o "
        "cut.svg; grep -q 'negative on the side of ωₒ' cut.svg");
}

/* Whatever the chart, the same samples are counted against the same pdf. */
static void charts_hold_what_is_expected(void **state)
{
    (void)state;
    static const char *const zoom[] = { "half", "disk" };
    static const char *const seen[] = {
        "roughconductor:alpha=0.2 --wo 40,20",
        "diffuse --wo 40,20",
        "roughdielectric:alpha=0.2 --wo 40,20",
        "roughdielectric:alpha=0.1 --wo 150,20",
    };
    for (int z = 0; z < 2; z++)
        for (int i = 0; i < 4; i++) {
            char line[512];
            snprintf(line, sizeof line,
                     "bsdf-plot histogram %s --zoom %s --samples 3e5 -o "
                     "$T/chart.svg",
                     seen[i], zoom[z]);
            quiet(line);
            const struct table t = table_read("chart.tsv");
            double observed = 0, expected = 0, squares = 0, full = 0;
            for (size_t k = 0; k < t.rows; k++) {
                const double r = table_at(&t, k, 8);
                observed += table_at(&t, k, 3);
                expected += table_at(&t, k, 4);
                if (isnan(r))
                    continue;
                squares += r * r;
                full++;
            }
            free(t.value);
            assert_true(full > 300);
            assert_close(squares / full, 1, 5 * sqrt(2 / full));
            assert_close(observed, expected, 5 * sqrt(expected));
            assert_true(expected > 0.8 * 3e5);
        }
}

/* Between 1.3 and 1.6, and a page of another material is none of it. */
static void pages_of_one_material_are_so_far_apart(void **state)
{
    (void)state;
    quiet(
        "cd $T; bsdf-plot ior b/x.yml,b/y.yml,BK7 -o spread.svg; grep -A 400 "
        "'^# spread between pages of: b' spread.tsv | sed 1,2d | awk 'NF == 0 "
        "{ exit } { print }' >span.tsv; grep -q 'grey: between the pages' "
        "spread.svg; bsdf-plot ior b/x.yml,BK7 -o one.svg; ! grep -q spread "
        "one.tsv");
    const struct table t = table_read("span.tsv");
    assert_true(t.rows > 150);
    for (size_t i = 0; i < t.rows; i++) {
        assert_true(table_at(&t, i, 0) >= 400 && table_at(&t, i, 0) <= 800);
        assert_close(table_at(&t, i, 1), 1.3, 1e-12);
        assert_close(table_at(&t, i, 2), 1.6, 1e-12);
    }
    free(t.value);
}

static void a_spec_is_changed_in_one_setting(void **state)
{
    (void)state;
    static const struct {
        const char *spec, *key, *value, *made;
    } cases[] = {
        { "diffuse", "reflectance", "0.5", "diffuse:reflectance=0.5" },
        { "a:x=1,y=2,z=3", "y", "7", "a:x=1,z=3,y=7" },
        { "a:x=1,y=2,z=3", "x", NULL, "a:y=2,z=3" },
        { "a:x=1,y=2,z=3", "z", NULL, "a:x=1,y=2" },
        { "a:x=1", "x", NULL, "a" },
        { "a:m='it''s, so',y=(b:x=1,y=2)", "x", "3",
          "a:m='it''s, so',y=(b:x=1,y=2),x=3" },
        { "a:y=(b:x=1,y=2),m='x,'", "y", NULL, "a:m='x,'" },
        { "./m.so:k=1", "k", "2", "./m.so:k=2" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *made =
            bsdf_spec_with(cases[i].spec, cases[i].key, cases[i].value, NULL);
        assert_non_null(made);
        assert_string_equal(made, cases[i].made);
        free(made);
    }
    struct err err;
    assert_null(bsdf_spec_with("a:x='1", "y", "2", &err));
    assert_has(err.text, "never closed");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "every kind is whole as SVG", every_kind_is_whole,
          .initial_state = (void *)forms[0] },
        { "every kind is whole as PDF", every_kind_is_whole,
          .initial_state = (void *)forms[1] },
        { "every kind is whole as PNG", every_kind_is_whole,
          .initial_state = (void *)forms[2] },
        { "every kind is whole as TeX", every_kind_is_whole,
          .initial_state = (void *)forms[3] },
        { "TeX sets every kind in the document's fonts",
          tex_sets_every_kind_in_the_documents_fonts },
        { "the same request gives the same bytes",
          the_same_request_gives_the_same_bytes },
        { "a TeX figure redraws itself", a_tex_figure_redraws_itself },
        { "a width is that of the picture", a_width_is_that_of_the_picture },
        { "nothing is left where gnuplot fails",
          nothing_is_left_where_gnuplot_fails },
        { "a style has the last word", a_style_has_the_last_word },
        { "a caption says how it was made", a_caption_says_how_it_was_made },
        { "a window is opened, or one line says why not",
          a_window_is_opened_or_one_line_says_why_not },
        { "TeX is given what it can set", tex_is_given_what_it_can_set },
        { "options that a kind has no use for are refused",
          options_that_a_kind_has_no_use_for_are_refused },
        { "bad files are refused by line", bad_files_are_refused_by_line },
        { "fresnel is that of the library", fresnel_is_that_of_the_library },
        { "facets are those of both families",
          facets_are_those_of_both_families },
        { "an albedo is that of a mean and of quadrature",
          an_albedo_is_that_of_a_mean_and_of_quadrature },
        { "errors fall as they should", errors_fall_as_they_should },
        { "a cut is at the azimuth that was asked for",
          a_cut_is_at_the_azimuth_that_was_asked_for },
        { "charts hold what is expected", charts_hold_what_is_expected },
        { "pages of one material are so far apart",
          pages_of_one_material_are_so_far_apart },
        { "a spec is changed in one setting",
          a_spec_is_changed_in_one_setting },
    };
    return cmocka_run_group_tests_name("figures", tests, setup_files,
                                       shell_teardown);
}
