/* test_plots.c - pictures that are whole, repeatable and right, and the tables
 * and scripts beside them; test_figures.c has every kind in every form
 */
#include "bsdf/bsdf.h"
#include "bsdf/ior.h"
#include "bsdf/utf8.h"
#include "plots/axis.h"
#include "plots/gnuplot.h"
#include "tests/plotting.h"

/* -- the pictures ---------------------------------------------------------- */

static const char *const specs[] = {
    "roughconductor:material=Ca,alpha=0.25",
    "roughconductor:material=Cu,alpha_u=0.3,alpha_v=0.05,distribution=ggx",
    "diffuse:reflectance=0.2/0.5/0.8",
};
static const char *const forms[] = { "svg", "pdf", "png" };
static const char *const kinds[] = { "lobe", "histogram", "lobe3d" };

/* What follows `bsdf-plot`, without the output. */
static void request(char *line, size_t size, int i)
{
    static const char *const pages[] = { "Ca", "BK7,Au/Johnson,SiO2 --nm 480",
                                         "H2O --range 300,5000" };
    if (i % 4 == 3)
        snprintf(line, size, "ior %s", pages[i / 4 % 3]);
    else
        snprintf(line, size, "%s %s --wo 57.3,%d --seed 7 --samples 30000",
                 kinds[i % 4], specs[i / 4 % 3], 31 * i);
}

static void every_kind_in_every_form_is_whole_and_redraws_itself(void **state)
{
    (void)state;
    for (int i = 0; i < 36; i++) {
        const char *form = forms[i / 12];
        char line[1024], name[32], what[512];
        snprintf(name, sizeof name, "f%d.%s", i, form);
        request(what, sizeof what, i);
        snprintf(line, sizeof line, "bsdf-plot %s -o $T/%s >$T/made", what,
                 name);
        quiet(line);
        assert_whole(name);
        snprintf(
            line, sizeof line,
            "printf '%%s\\n' $T/f%d.tsv $T/f%d.gp $T/f%d.caption $T/%s | cmp - "
            "$T/made; "
            "cd $T; mv %s first; gnuplot f%d.gp",
            i, i, i, name, name, i);
        quiet(line);
        size_t size, again;
        char *a = read_all("first", &size), *b = read_all(name, &again);
        char *date = memmem(b, again, "/CreationDate (D:", 17);
        if (date)
            memcpy(date + 17, "20000101000000", 14);
        if (strcmp(form, "pdf") != 0 || getenv("TZ")) /* has a time zone */
            assert_int_equal(size, again);
        if (size == again)
            assert_memory_equal(a, b, size);
        free(a);
        free(b);
    }
}

static void the_same_request_gives_the_same_bytes(void **state)
{
    (void)state;
    for (int i = 0; i < 12; i++) {
        char line[1024], what[512];
        request(what, sizeof what, i);
        snprintf(line, sizeof line,
                 "cd $T; for n in 1 2; do mkdir again; cd again; TZ=XYZ$n "
                 "OMP_NUM_THREADS=$n bsdf-plot %s -o x.%s; cd ..; mv again "
                 "again$n; done; diff -r again1 again2 >&2; "
                 "rm -r again1 again2",
                 what, forms[i % 3]);
        quiet(line);
    }
}

static void another_seed_gives_other_samples(void **state)
{
    (void)state;
    quiet("cd $T; for s in 1 2; do bsdf-plot histogram diffuse --wo 20,0 "
          "--samples 5000 --seed $s -o s$s.svg; done; ! cmp -s s1.tsv s2.tsv");
}

static void names_and_specs_are_nothing_but_text(void **state)
{
    (void)state;
    static const char line[] =
        "ca=$(ls $PWD/data/ior/Ca/*.yml); d=\"$T/a \\\"b\\\" 'c'\"; "
        "mkdir \"$d\"; cd \"$d\"; "
        "m=$(printf 'm `touch pwned` \"; system(\"touch pwned\") "
        "#\\n\\\\ $1 @x %%s <b> {a}_b \\377.yml'); cp \"$ca\" \"$m\"; "
        "for f in '-x.svg' '|touch pwned.svg' '<touch pwned.pdf' "
        "'`touch pwned` $x @y #1.png' \"$(printf 'new\\nline\\\\.svg')\"; "
        "do bsdf-plot lobe \"roughconductor:material='$m'\" --wo 45,0 "
        "-o \"$f\"; [ -s \"$f\" ] || echo no $f >&2; done; "
        "bsdf-plot lobe diffuse --wo 45,0 -o \"$d/y.svg\"; "
        "[ ! -e pwned ] || echo pwned >&2; cp y.svg $T; cd $T; rm -r a*";
    quiet(line);
    assert_whole("y.svg");
}

/* -- what goes wrong ------------------------------------------------------- */

static void without_gnuplot_the_table_and_the_script_are_made(void **state)
{
    (void)state;
    ends("mkdir $T/none && cd $T/none && { PATH=/nonexistent $BIN/bsdf-plot "
         "lobe diffuse --wo 10,0 -o x.svg 2>&1 >$T/made; }",
         2);
    assert_has(output, "gnuplot");
    assert_has(output, "PATH");
    quiet("cd $T; printf 'x.tsv\\nx.gp\\nx.caption\\n' | cmp - made; cd none; "
          "gnuplot "
          "x.gp; [ \"$(ls | tr '\\n' ' ')\" = 'x.caption x.gp x.svg x.tsv ' ]; "
          "rm -r $T/none");
}

static void gnuplots_own_words_are_passed_on(void **state)
{
    (void)state;
    quiet("mkdir $T/fake; cd $T/fake; printf '#!/bin/sh\\necho its words >&2\\n"
          "exit 3\\n' >gnuplot; chmod +x gnuplot");
    ends("cd $T/fake; { PATH=$PWD:$PATH bsdf-plot lobe diffuse --wo 10,0; } "
         "2>&1 >/dev/null",
         2);
    assert_has(output, "its words");
    assert_has(output, "status 3");
    quiet("cd $T/fake; [ ! -e lobe.svg ]; [ -s lobe.gp ]; rm -r $T/fake");
}

static void wrong_requests_are_refused(void **state)
{
    (void)state;
    refused("bsdf-plot lobe diffuse --wo 1,0 -o x.jpg", "\".jpg\"",
            ".svg, .pdf, .png or .tex");
    refused("bsdf-plot lobe diffuse --wo 1,0 -o x", "no extension", ".svg");
    refused("bsdf-plot lobe diffuse --wo 1,0 -o .svg", "name before", ".svg");
    refused("bsdf-plot lobe diffuse --wo 1,0 -o none/x.svg", "none/x.svg",
            "No such file");
    refused("bsdf-plot lobe diffuse --wo 1,0 -o $T/out/x.svg", "out/x.svg",
            "Not a directory");
    refused("bsdf-plot lobes diffuse --wo 1,0", "\"lobes\"",
            "did you mean \"lobe\"?");
    refused("bsdf-plot none diffuse --wo 1,0", "\"none\"",
            "lobe, lobe3d, histogram, slice, albedo, convergence, compare, "
            "ndf, fresnel, ior, colour, kill-matrix, p-values, series, report, "
            "writeup");
    refused("bsdf-plot", "kind", "SPEC");
    refused("bsdf-plot lobe", "lobe", "SPEC");
    refused("bsdf-plot lobe diffuse", "--wo", "degrees");
    refused("bsdf-plot histogram diffuse x --wo 1,0", "\"x\"", "too many");
    refused("bsdf-plot lobe diffuse:reflectance=2 --wo 1,0", "reflectance",
            "[0, 1]");
    refused("bsdf-plot lobe diffuse --wo 120,0", "120", "nothing to draw");
    refused("bsdf-plot histogram diffuse --wo 120,0", "120", "nothing to draw");
    refused("bsdf-plot histogram mirror --wo 45,0", "delta", "no density");
    refused("bsdf-plot histogram diffuse --wo 45,0 --samples 10", "--samples",
            "[1000");
    refused("bsdf-plot lobe3d diffuse --wo 120,0", "120", "nothing to draw");
    refused("bsdf-plot lobe diffuse --wo 45,0 --rgb best", "\"best\"", "fit");
    refused("bsdf-plot slice diffuse:reflectance=0",
            "diffuse:reflectance=0 reflects nothing; ", "nothing to draw");
    refused("bsdf-plot slice mirror", "nothing but single directions",
            "nothing to draw");
    refused("bsdf-plot ior", "ior", "NAME");
    refused("bsdf-plot ior Xx", "Xx", "Ca");
    refused("bsdf-plot ior Ca,,Cu", "name", "missing");
    refused("bsdf-plot ior Ca,Ca,Ca,Ca,Ca,Ca,Ca,Ca,Ca", "at most", "8");
    refused("bsdf-plot ior Ca --range 500", "\"500\"", "360,830");
    refused("bsdf-plot ior Ca --range 700,600", "\"700,600\"", "rising");
    refused("bsdf-plot ior Ca --range 1e5,2e5", "100000", "1653.12");
    refused("bsdf-plot ior Ca --range 500,600nm", "600nm", "360,830");
}

static void a_script_in_the_way_leaves_nothing(void **state)
{
    (void)state;
    ends("mkdir -p $T/way/x.gp/y && cd $T/way && { bsdf-plot lobe diffuse --wo "
         "10,0 -o x.svg 2>&1 >$T/out; }",
         2);
    assert_has(output, "x.gp");
    quiet("cd $T/way; rm -r x.gp; [ -z \"$(ls)\" ]; rmdir $T/way");
}

static void what_is_read_is_never_replaced(void **state)
{
    (void)state;
    static const char *const wrong[][3] = {
        { "series mine.tsv -o mine.png", "mine.tsv", "the figure's data" },
        { "series ./mine.tsv -o $T/read/mine.tex", "./mine.tsv", "data" },
        { "series link.tsv -o mine.svg", "link.tsv", "data" },
        { "series mine.tsv -o hard.svg", "mine.tsv", "data" },
        { "kill-matrix mine.tsv -o mine.pdf", "mine.tsv", "data" },
        { "p-values mine.tsv -o mine.png", "mine.tsv", "data" },
        { "lobe diffuse --wo 1,0 --style my.gp -o my.png", "my.gp",
          "the figure's script" },
        { "lobe roughconductor:material=./my.gp --wo 1,0 -o my.png", "./my.gp",
          "script" },
        { "ior Ca,my.gp -o my.svg", "my.gp", "script" },
        { "report run.html -o run.html", "run.html", "the page" },
        { "writeup run.html -o ./run.html", "run.html", "the page" },
    };
    char line[1024];
    quiet(
        "mkdir $T/read; cd $T/read; printf 'c\\tx\\ty\\te\\na\\t1\\t2\\t1\\n' "
        ">mine.tsv; echo 'unset grid' >my.gp; ln -s mine.tsv link.tsv; ln "
        "mine.tsv hard.tsv; cp mine.tsv run.html; ls -l >$T/before; cat * "
        ">>$T/before");
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        snprintf(line, sizeof line, "cd $T/read; bsdf-plot %s 2>&1",
                 wrong[i][0]);
        ends(line, 2);
        assert_has(output, wrong[i][1]);
        assert_has(output, wrong[i][2]);
        assert_has(output, "-o with another name");
        quiet("cd $T/read; { ls -l; cat *; } | cmp - $T/before");
    }
    quiet("cd $T/read; cp mine.tsv series.tsv; bsdf-plot series series.tsv "
          ">$T/made; cmp mine.tsv series.tsv; [ -s series-plot.svg ]; "
          "bsdf-plot series mine.tsv >$T/made; [ -s series.svg ]; rm -r "
          "$T/read");
}

static void names_are_printed_as_they_were_given(void **state)
{
    (void)state;
    quiet("mkdir $T/given; cd $T/given; for n in 1 2; do bsdf-plot lobe "
          "diffuse --wo 10,0 -o ./x.tex >$T/made; printf './x.%s\\n' tsv gp "
          "caption pdf tex | cmp - $T/made; done; rm -r $T/given");
}

/* -- the numbers ----------------------------------------------------------- */

struct view {
    const char *spec, *wo;
    double theta_deg, phi_deg;
};
static const struct view views[] = {
    { "roughconductor:material=Ca,alpha=0.001", "45,0", 45, 0 },
    { "roughconductor:material=Ca,alpha=0.0001", "89.9,20", 89.9, 20 },
    { "roughconductor:material=Au,alpha=1,distribution=ggx", "0,0", 0, 180 },
    { "course_microfacet:material=Au,alpha=0.02", "85,-70", 85, -70 },
};

/* The curve through the table, against the model at angles drawn around the
 * mirror direction; how much the table's largest value is above all of them. */
static void assert_traced(const struct view *v, const struct table *t)
{
    struct bsdf *b = bsdf_new(v->spec, &bands_fixed, NULL);
    assert_non_null(b);
    const struct vec3 wo = dir_from_degrees(v->theta_deg, v->phi_deg);
    double most[7] = { 0 };
    for (size_t i = 0; i < t->rows; i++)
        for (size_t c = 1; c < 7; c++)
            most[c] = fmax(most[c], table_at(t, i, c));
    for (int k = 0; k < 20000; k++) {
        /* from -90 to 90, a fourth of them within half a degree */
        const double share = fmod(0.61803398874989485 * k, 1);
        const double theta =
            k % 4 ? 180 * share - 90 : fmin(v->theta_deg + share - 0.5, 90);
        size_t i = 1;
        while (table_at(t, i, 0) < theta)
            i++;
        const double x0 = table_at(t, i - 1, 0), x1 = table_at(t, i, 0);
        const struct vec3 wi = dir_from_degrees(theta, v->phi_deg + 180);
        const struct spectrum f = bsdf_eval(b, wo, wi);
        for (size_t c = 1; c < 7; c++) {
            const double y0 = table_at(t, i - 1, c), y1 = table_at(t, i, c);
            const double line = y0 + (y1 - y0) * (theta - x0) / (x1 - x0);
            const double truth = f.band[(c - 1) % 3] * (c > 3 ? fabs(wi.z) : 1);
            assert_at_most(truth, most[c] * 1.001);
            if (theta < 89.99999) /* f may end with a jump */
                assert_close(line / most[c], truth / most[c], 2e-3);
        }
    }
    bsdf_free(b);
}

static void a_lobe_follows_the_model_however_narrow(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        char line[512];
        snprintf(line, sizeof line,
                 "bsdf-plot lobe %s --rgb fixed:614,549,466 --wo %s "
                 "-o $T/lobe%zu.svg",
                 views[i].spec, views[i].wo, i);
        quiet(line);
        snprintf(line, sizeof line, "lobe%zu.tsv", i);
        const struct table t = table_read(line);
        assert_int_equal(t.columns, 7);
        assert_true(t.rows < 10000);
        assert_traced(&views[i], &t);
        free(t.value);
    }
}

/* From one scan to the next and along it: the middle of the chord between two
 * points is about where the surface is; and nothing is beyond the peak. */
static void assert_meshed(const struct view *v, const struct table *t)
{
    static const double luminance[] = { 0.2126, 0.7152, 0.0722 };
    struct bsdf *b = bsdf_new(v->spec, &bands_default, NULL);
    assert_non_null(b);
    const struct vec3 wo = dir_from_degrees(v->theta_deg, v->phi_deg);
    size_t width = 1;
    double most = 0;
    while (table_at(t, width, 0) == table_at(t, 0, 0))
        width++;
    assert_int_equal(t->rows % width, 0);
    for (size_t i = 0; i < t->rows; i++)
        most = fmax(most, table_at(t, i, 2));
    assert_true(most > 0);
    for (size_t i = 0; i < t->rows; i++) {
        const size_t next[] = { i + 1, i + width };
        for (int k = 0; k < 3; k++) {
            const size_t j = k < 2 ? next[k] : i;
            if (j >= t->rows || (k == 0 && j % width == 0))
                continue;
            const double theta = (table_at(t, i, 0) + table_at(t, j, 0)) / 2;
            const double phi = (table_at(t, i, 1) + table_at(t, j, 1)) / 2;
            const struct vec3 wi = dir_from_degrees(theta, phi);
            const struct spectrum f = bsdf_eval(b, wo, wi);
            double truth = 0;
            for (int c = 0; c < 3; c++)
                truth += luminance[c] * f.band[c] * wi.z;
            assert_at_most(truth, most * (1 + 1e-9));
            if (k == 2)
                assert_close(table_at(t, i, 2), truth, 1e-6 * most);
            const struct vec3 p =
                dir_from_degrees(table_at(t, i, 0), table_at(t, i, 1));
            const struct vec3 q =
                dir_from_degrees(table_at(t, j, 0), table_at(t, j, 1));
            const struct vec3 chord =
                vec3_add(vec3_scale(table_at(t, i, 2) / most, p),
                         vec3_scale(table_at(t, j, 2) / most, q));
            const double middle = truth / most;
            /* the middle in angle may be away from that of the chord along it,
             * by no more than half of its length */
            assert_at_most(fabs(middle - vec3_length(chord) / 2), 0.045);
        }
    }
    bsdf_free(b);
}

static void a_surface_follows_the_model_however_narrow(void **state)
{
    (void)state;
    static const struct view seen[] = {
        { "roughconductor:material=Ca,alpha=0.01", "45,0", 45, 0 },
        { "roughconductor:material=Ca,alpha=0.001", "70,-100", 70, -100 },
        { "roughconductor:material=Ca,alpha=0.01", "0,0", 0, 0 },
        { "diffuse", "30,200", 30, 200 },
    };
    for (size_t i = 0; i < sizeof seen / sizeof *seen; i++) {
        char line[512];
        snprintf(line, sizeof line,
                 "bsdf-plot lobe3d %s --wo %s -o $T/surface%zu.svg",
                 seen[i].spec, seen[i].wo, i);
        quiet(line);
        snprintf(line, sizeof line, "surface%zu.tsv", i);
        const struct table t = table_read_block(line, 2);
        assert_int_equal(t.columns, 6);
        assert_true(t.rows < 10000);
        assert_meshed(&seen[i], &t);
        free(t.value);
    }
}

static void both_sides_of_glass_are_there(void **state)
{
    (void)state;
    quiet("cd $T; bsdf-plot lobe3d roughdielectric:alpha=0.2 --wo 135,10 -o "
          "glass.svg; grep -q '^# above the surface' glass.tsv; grep -q '^# "
          "below the surface' glass.tsv; grep -q 'maximum below the surface: "
          "2.8135/sr' glass.svg; bsdf-plot lobe3d thindielectric --wo 45,0 -o "
          "thin.svg; grep -q 'δ at θᵢ = 135°' thin.svg");
}

static void bands_are_named_as_they_are(void **state)
{
    (void)state;
    quiet("cd $T; s=diffuse:reflectance=0.2/0.5/0.8; "
          "bsdf-plot lobe $s --wo 45,0 -o rgb.svg; "
          "grep -q '^# bands: R, G, B (fit)$' rgb.tsv; "
          "grep -q '1/sr. in G' rgb.tsv; grep -q '>G<' rgb.svg; "
          "bsdf-plot lobe $s --wo 45,0 --rgb fixed:600,550,450 -o nm.svg; "
          "grep -q '1/sr. at 550 nm' nm.tsv; grep -q '>550 nm<' nm.svg; "
          "bsdf-plot lobe diffuse --wo 45,0 -o same.svg; "
          "grep -q '>all bands<' same.svg; ! grep -q '>G<' same.svg");
}

static void a_colour_that_is_not_quite_met_is_warned_of(void **state)
{
    (void)state;
    does("cd $T; bsdf-plot lobe roughconductor:material=Au --wo 45,0 -o "
         "gold.svg 2>&1 >gold.out");
    assert_has(output, "bsdf-plot: warning: ");
    assert_has(output, "F0");
    assert_whole("gold.svg");
    does("cd $T; bsdf-plot ior Au -o gold.svg 2>&1 >gold.out");
    assert_has(output, "bsdf-plot: warning: ");
}

/* Of a sound model: counts spread about what is expected as they should. */
static void residuals_are_those_of_chance(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        char line[512];
        snprintf(line, sizeof line,
                 "bsdf-plot histogram %s --wo %s --nm 614,549,466 "
                 "-o $T/h%zu.svg --samples 3e5",
                 views[i].spec, views[i].wo, i);
        quiet(line);
        snprintf(line, sizeof line, "h%zu.tsv", i);
        const struct table t = table_read(line);
        assert_int_equal(t.columns, 9);
        double observed = 0, expected = 0, squares = 0, full = 0, worst = 0;
        for (size_t k = 0; k < t.rows; k++) {
            const double o = table_at(&t, k, 3), e = table_at(&t, k, 4);
            const double r = table_at(&t, k, 8);
            observed += o;
            expected += e;
            assert_true(isnan(r) == (e < 5));
            worst = fmax(worst, table_at(&t, k, 5) / sqrt(e + 1));
            if (isnan(r))
                continue;
            assert_close(r, (o - e) / sqrt(e), 1e-9);
            squares += r * r;
            full++;
        }
        assert_true(full > 300);
        assert_close(squares / full, 1, 5 * sqrt(2 / full));
        assert_close(observed, expected, 5 * sqrt(expected));
        assert_true(expected > 0.4 * 3e5);
        assert_at_most(worst, 0.3);
        free(t.value);
    }
}

/* All of diffuse is in sight: mass 1, solid angle 2 pi. */
static void a_whole_hemisphere_adds_up(void **state)
{
    (void)state;
    quiet("bsdf-plot histogram diffuse --wo 33,120 -o $T/whole.svg");
    const struct table t = table_read("whole.tsv");
    double solid = 0, observed = 0, expected = 0;
    for (size_t k = 0; k < t.rows; k++) {
        solid += table_at(&t, k, 2);
        observed += table_at(&t, k, 3);
        expected += table_at(&t, k, 4);
    }
    free(t.value);
    assert_close(solid, 2 * PI, 1e-4);
    assert_close(observed, 1e6, 0);
    assert_close(expected, 1e6, 2);
}

static void a_mirror_is_an_arrow_with_its_weight(void **state)
{
    (void)state;
    quiet("bsdf-plot lobe mirror:reflectance=0.25/0.5/1 --wo 45,0 -o $T/m.svg; "
          "grep -A 2 'single directions' $T/m.tsv | tail -n 1 >$T/row; "
          "printf '45\\t1\\t0.25\\t0.5\\t1\\n' | cmp - $T/row");
    quiet("grep -q 'probability 1, weight 0.25, 0.5, 1' $T/m.svg");
}

static void ratios_of_like_models_have_short_numbers(void **state)
{
    (void)state;
    quiet("cd $T; for s in diffuse:reflectance=0.5 "
          "diffuse:reflectance=0.50001; do bsdf-plot compare diffuse $s --wo "
          "45,0 --samples 1000 -o like.svg >made; grep -q '>1.005<' like.svg; "
          "! grep -q '>1.00000' like.svg; ! grep -q '>0.99999' like.svg; done");
    quiet("cd $T; bsdf-plot compare roughconductor diffuse:reflectance=0 --wo "
          "45,0 --samples 1000 -o black.svg >made; grep -q 'first: 0, as the "
          "second is' black.svg; bsdf-plot compare diffuse:reflectance=0 "
          "roughconductor --wo 45,0 --samples 1000 -o black.svg >made; grep -q "
          "'none, the first is 0' black.svg");
}

static void captions_count_the_samples_of_kinds_that_draw_some(void **state)
{
    (void)state;
    quiet("cd $T; at='--wo 20,10 --samples 1000 -o cap.svg'; for k in "
          "\"histogram diffuse $at\" \"convergence diffuse $at\" "
          "\"compare diffuse diffuse $at\" 'albedo diffuse --samples 1000 -o "
          "cap.svg'; do bsdf-plot $k >made; grep -q 'Seed 1, 1000 samples' "
          "cap.caption || echo $k >&2; done; c=conductor:material=Cu; for k in "
          "\"lobe diffuse $at\" \"lobe3d diffuse $at\" 'slice diffuse -o "
          "cap.svg' \"ndf rough$c -o cap.svg\" \"fresnel $c -o cap.svg\" "
          "'ior Ca -o cap.svg' 'colour Ca -o cap.svg'; do bsdf-plot $k >made "
          "2>said; ! grep -E 'Seed|samples' cap.caption || echo $k >&2; done");
}

static void mistakes_are_found_with_or_without_a_scale(void **state)
{
    (void)state;
    quiet("cd $T; printf 'name\\tsize\\tpdf\\tsmallest "
          "scale\\tstatus\\na\\t1\\tfails\\t"
          "0.01\\tcaught\\nb\\t1\\tfails\\t-\\tcaught\\nc\\t0\\tpasses\\t-"
          "\\tpassed"
          "\\n' >found.tsv; bsdf-plot kill-matrix found.tsv -o k.svg >made; "
          "grep -q '3 mistakes, 2 of which some check finds' k.svg");
}

/* In the title as in the key. */
static void long_specs_are_told_apart(void **state)
{
    (void)state;
    quiet(
        "cd $T; s=roughconductor:eta=0.123456789/0.223456789/0.323456789,k="
        "2.123456789/2.323456789/2.523456789,distribution=ggx,alpha_v="
        "0.1234567,specular_reflectance=0.123456789,alpha_u=; bsdf-plot "
        "compare ${s}0.11 ${s}0.22 --wo 45,0 --samples 1000 -o far.svg >made; "
        "for n in 11 22; do grep -q \">…alpha_u=0.$n<\" far.svg; grep -q "
        "\">.*,alpha_u=0.$n<\" far.svg; done; bsdf-plot lobe ${s}0.11 "
        "${s}0.22 diffuse diffuse --wo 45,0 -o far.svg >made; for t in "
        "…alpha_u=0.11 …alpha_u=0.22 '3: diffuse' '4: diffuse'; do grep -q "
        "\">$t<\" far.svg; done");
}

/* Every row in range and one to each side of it. */
static void rows_are_those_of_the_page(void **state)
{
    (void)state;
    struct err err;
    struct ior_page *page = ior_find("Ca", NULL, &err);
    assert_non_null(page);
    const struct ior_table n = ior_page_n(page);
    quiet("bsdf-plot ior Ca --range 450,700 -o $T/ca.svg; "
          "! grep -q '^set logscale' $T/ca.gp");
    const struct table t = table_read_block("ca.tsv", 2);
    size_t first = 0;
    while (n.nm[first + 1] < 450)
        first++;
    assert_true(table_at(&t, 0, 0) < 450);
    assert_true(table_at(&t, 1, 0) >= 450);
    assert_true(table_at(&t, t.rows - 1, 0) > 700);
    assert_true(table_at(&t, t.rows - 2, 0) <= 700);
    for (size_t i = 0; i < t.rows; i++) {
        assert_close(table_at(&t, i, 0), n.nm[first + i], 0);
        assert_close(table_at(&t, i, 1), n.value[first + i], 0);
    }
    free(t.value);
    ior_page_free(page);
}

static void a_formula_is_drawn_as_what_it_gives(void **state)
{
    (void)state;
    struct ior_page *page = ior_find("SiO2", NULL, NULL);
    assert_non_null(page);
    quiet("bsdf-plot ior SiO2 -o $T/sio2.svg");
    const struct table t = table_read("sio2.tsv");
    for (size_t i = 0; i < t.rows; i++) {
        double n, k;
        assert_true(ior_page_at(page, table_at(&t, i, 0), &n, &k, NULL));
        assert_close(table_at(&t, i, 1), n, 0);
    }
    assert_close(table_at(&t, 0, 0), 360, 0);
    assert_close(table_at(&t, t.rows - 1, 0), 830, 0);
    free(t.value);
    ior_page_free(page);
}

static void a_page_is_cited_and_its_bands_are_marked(void **state)
{
    (void)state;
    quiet("cd $T; bsdf-plot ior Ca,BK7 --nm 614,549 -o two.svg; "
          "grep -q 'Physica Scripta 4' two.svg; grep -q '>549 nm<' two.svg; "
          "grep -q 'Ca/Mathewson, 339.68–1653.12 nm' two.svg; "
          "grep -q '^set logscale y' two.gp; "
          "bsdf-plot ior Ca --rgb average -o one.svg; "
          "grep -q '>G<' one.svg; grep -q '(average)' one.svg");
}

/* -- the parts ------------------------------------------------------------- */

static void a_string_of_a_script_is_what_it_was(void **state)
{
    (void)state;
    char text[300];
    size_t n = 0;
    for (int c = 1; c < 128; c++)
        text[n++] = (char)c;
    snprintf(text + n, sizeof text - n, "$1 \"7\" `8` '9' \\0 ω€");
    FILE *script = fopen(in_folder("string.gp"), "w");
    assert_non_null(script);
    fputs("set print \"-\"\nprint ", script);
    gnuplot_string(script, text);
    fputc('\n', script);
    fclose(script);
    does("gnuplot -d $T/string.gp");
    n = strlen(output);
    assert_true(n > 0);
    output[n - 1] = '\0';
    assert_string_equal(output, text);
}

static void plain_text_is_one_line_of_utf8(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        { "alpha_u=0.3, 'ä€𝛼'", "alpha_u=0.3, 'ä€𝛼'" },
        { "a\tb\n\x7f", "a\\x09b\\x0a\\x7f" },
        { "\xff\xc3", "\\xff\\xc3" },                            /* cut off */
        { "\xc0\xaf\xe0\x80\x80", "\\xc0\\xaf\\xe0\\x80\\x80" }, /* too long */
        { "\xed\xa0\x80", "\\xed\\xa0\\x80" },          /* a surrogate */
        { "\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80" }, /* past the end */
        { "\xc2\x85\xe2\x80\xa8", "\\xc2\\x85\\xe2\\x80\\xa8" }, /* new lines */
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        char *plain = utf8_plain(pairs[i][0]);
        assert_non_null(plain);
        assert_string_equal(plain, pairs[i][1]);
        free(plain);
    }
}

static void axes_are_easy_to_read(void **state)
{
    (void)state;
    char unit[32];
    assert_close(axis_step(0.47, 5), 0.1, 1e-15);
    assert_close(axis_step(2.3, 5), 0.5, 1e-15);
    assert_close(axis_step(10, 5), 2, 1e-15);
    assert_close(axis_step(1.1e-5, 5), 2.5e-6, 1e-20);
    assert_int_equal(axis_exponent(1000), 3);
    assert_int_equal(axis_exponent(999), 0);
    assert_int_equal(axis_exponent(0.001), -3);
    assert_int_equal(axis_exponent(0), 0);
    assert_int_equal(axis_exponent(INFINITY), 0);
    axis_unit(unit, sizeof unit, 0, "1/sr");
    assert_string_equal(unit, "1/sr");
    axis_unit(unit, sizeof unit, 12, "1/sr");
    assert_string_equal(unit, "10¹²/sr");
    axis_unit(unit, sizeof unit, -6, "deg");
    assert_string_equal(unit, "10⁻⁶ deg");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "every kind in every form is whole and redraws itself",
          every_kind_in_every_form_is_whole_and_redraws_itself },
        { "the same request gives the same bytes",
          the_same_request_gives_the_same_bytes },
        { "another seed gives other samples",
          another_seed_gives_other_samples },
        { "names and specs are nothing but text",
          names_and_specs_are_nothing_but_text },
        { "without gnuplot the table and the script are made",
          without_gnuplot_the_table_and_the_script_are_made },
        { "gnuplot's own words are passed on",
          gnuplots_own_words_are_passed_on },
        { "wrong requests are refused", wrong_requests_are_refused },
        { "a script in the way leaves nothing",
          a_script_in_the_way_leaves_nothing },
        { "what is read is never replaced", what_is_read_is_never_replaced },
        { "names are printed as they were given",
          names_are_printed_as_they_were_given },
        { "a lobe follows the model however narrow",
          a_lobe_follows_the_model_however_narrow },
        { "a surface follows the model however narrow",
          a_surface_follows_the_model_however_narrow },
        { "both sides of glass are there", both_sides_of_glass_are_there },
        { "bands are named as they are", bands_are_named_as_they_are },
        { "a colour that is not quite met is warned of",
          a_colour_that_is_not_quite_met_is_warned_of },
        { "ratios of like models have short numbers",
          ratios_of_like_models_have_short_numbers },
        { "captions count the samples of kinds that draw some",
          captions_count_the_samples_of_kinds_that_draw_some },
        { "mistakes are found with or without a scale",
          mistakes_are_found_with_or_without_a_scale },
        { "long specs are told apart", long_specs_are_told_apart },
        { "rows are those of the page", rows_are_those_of_the_page },
        { "a formula is drawn as what it gives",
          a_formula_is_drawn_as_what_it_gives },
        { "a page is cited and its bands are marked",
          a_page_is_cited_and_its_bands_are_marked },
        { "residuals are those of chance", residuals_are_those_of_chance },
        { "a whole hemisphere adds up", a_whole_hemisphere_adds_up },
        { "a mirror is an arrow with its weight",
          a_mirror_is_an_arrow_with_its_weight },
        { "a string of a script is what it was",
          a_string_of_a_script_is_what_it_was },
        { "plain text is one line of UTF-8", plain_text_is_one_line_of_utf8 },
        { "axes are easy to read", axes_are_easy_to_read },
    };
    return cmocka_run_group_tests_name("plots", tests, setup, shell_teardown);
}
