/* test_foreign.c - models that other programs compute, sound, wrong and hostile
 *
 * The plugins and adapters of tests/plugins are built with cc into a folder of
 * the test's own, $T; what crashes, hangs, lies or leaves there gets a verdict,
 * and nothing of it is left behind.
 */
#include <dirent.h>
#include <errno.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bsdf/rng.h"
#include "tests/close.h"
#include "tests/shell.h"
#include "validate/foreign.h"
#include "validate/pipe.h"

/* Whether a process has this test's $T in its environment, as all that it
 * starts has, and nothing else. */
static bool ours(const char *pid)
{
    static char text[1 << 16];
    char name[300];
    snprintf(name, sizeof name, "/proc/%s/environ", pid);
    FILE *f = fopen(name, "r");
    if (!f)
        return false;
    const size_t n = fread(text, 1, sizeof text, f);
    fclose(f);
    return memmem(text, n, folder, strlen(folder));
}

/* What was started is gone half a second after whoever started it. */
static void nothing_is_left(void)
{
    int left = 1;
    for (int wait = 0; left > 0 && wait < 50; wait++) {
        DIR *all = opendir("/proc");
        assert_non_null(all);
        left = 0;
        for (struct dirent *d; (d = readdir(all));)
            left +=
                d->d_name[0] >= '0' && d->d_name[0] <= '9' && ours(d->d_name);
        closedir(all);
        poll(NULL, 0, left ? 10 : 0);
    }
    assert_int_equal(left, 0);
}

static int setup(void **state)
{
    (void)state;
    if (shell_setup("foreign", "exec 2>&1; cd $T; ") != 0)
        return -1;
    setenv("AWK",
           sh("awk -W version | grep -q ^mawk") == 0 ? "awk -W interactive"
                                                     : "awk",
           1);
    return sh("build() { ${CC:-cc} -O2 -shared -fPIC -I$ROOT -o $@ -lm; }; "
              "p=$ROOT/tests/plugins; "
              "build ggx.so $p/ggx.c && build glass.so $p/glass.c && "
              "build later.so -DABI=7 $p/ggx.c && "
              "echo 'int x;' >x.c && build empty.so x.c && "
              "echo text >text.so && cp $p/diffuse.awk .");
}

/* A model with $T before "ggx.so...". */
static struct bsdf *made(const char *of_folder, const struct bands *bands)
{
    char spec[256];
    struct err err;
    snprintf(spec, sizeof spec, "%s/%s", folder, of_folder);
    struct bsdf *b = foreign_new(spec, bands, &err);
    if (!b)
        fail_msg("%s", err.text);
    assert_string_equal(bsdf_spec(b), spec);
    return b;
}

/* This process has no child, not even a dead one. */
static void childless(void)
{
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
    assert_int_equal(errno, ECHILD);
}

/* -- sound ones ------------------------------------------------------------ */

enum { MANY = 70000 }; /* more than one request may have */

struct pairs {
    double ox[MANY], oy[MANY], oz[MANY], ix[MANY], iy[MANY], iz[MANY];
    double ux[MANY], uy[MANY], uz[MANY];
};

static struct pairs *pairs_new(void)
{
    const struct rng rng = { 7, 11 };
    struct pairs *p = malloc(sizeof *p);
    assert_non_null(p);
    for (size_t i = 0; i < MANY; i++) {
        const struct vec3 u = rng_uniform(rng, 2 * i);
        const struct vec3 v = rng_uniform(rng, 2 * i + 1);
        const struct vec3 o = dir_from_degrees(89 * u.x, 360 * u.y);
        const struct vec3 w = dir_from_degrees(95 * u.z, 360 * v.x);
        p->ox[i] = o.x, p->oy[i] = o.y, p->oz[i] = o.z;
        p->ix[i] = w.x, p->iy[i] = w.y, p->iz[i] = w.z;
        p->ux[i] = v.y, p->uy[i] = v.z, p->uz[i] = u.x;
    }
    return p;
}

static struct dirs pairs_wo(const struct pairs *p)
{
    return (struct dirs){ p->ox, p->oy, p->oz };
}

static struct dirs pairs_wi(const struct pairs *p)
{
    return (struct dirs){ p->ix, p->iy, p->iz };
}

static void a_plugin_gives_the_values_of_the_model_it_is(void **state)
{
    (void)state;
    struct bsdf *b = made("ggx.so:alpha=0.3", &bands_fixed);
    struct bsdf *ours = bsdf_new("roughconductor:alpha=0.3,distribution=ggx",
                                 &bands_fixed, NULL);
    assert_non_null(ours);
    struct pairs *p = pairs_new();
    struct spectrum *f = malloc(MANY * sizeof *f);
    struct bsdf_sample *s = malloc(MANY * sizeof *s);
    double *pdf = malloc(MANY * sizeof *pdf);
    assert_true(f && s && pdf);
    const struct dirs u = { p->ux, p->uy, p->uz };
    bsdf_eval_many(b, MANY, pairs_wo(p), pairs_wi(p), f);
    bsdf_pdf_many(b, MANY, pairs_wo(p), pairs_wi(p), pdf);
    bsdf_sample_many(b, MANY, pairs_wo(p), u, s);
    for (size_t i = 0; i < MANY; i++) {
        const struct vec3 wo = dirs_at(pairs_wo(p), i);
        const struct vec3 wi = dirs_at(pairs_wi(p), i);
        const double f0 = bsdf_eval(ours, wo, wi).band[2];
        const double p0 = bsdf_pdf(ours, wo, wi);
        assert_close(f[i].band[2], f0, 1e-11 * f0);
        assert_close(pdf[i], p0, 1e-11 * p0);
        assert_true(f[i].band[3] == 0);
        if (s[i].pdf > 0) {
            const double p1 = bsdf_pdf(ours, wo, s[i].wi);
            assert_close(s[i].pdf, p1, 1e-11 * p1);
        }
        if (i % 997 == 0) { /* one at a time, bit for bit */
            assert_true(bsdf_eval(b, wo, wi).band[2] == f[i].band[2]);
            assert_true(bsdf_pdf(b, wo, wi) == pdf[i]);
            assert_true(bsdf_sample(b, wo, dirs_at(u, i)).wi.x == s[i].wi.x);
        }
    }
    assert_false(bsdf_trouble(b, NULL));
    free(p);
    free(f);
    free(s);
    free(pdf);
    bsdf_free(ours);
    bsdf_free(b);
    childless();
}

static void a_plugin_is_judged_as_the_model_it_is(void **state)
{
    (void)state;
    prints("for s in ./ggx.so:alpha=0.3 "
           "roughconductor:alpha=0.3,distribution=ggx; do "
           "bsdf-validate $s --samples 1e4 --wo 40,10 -v >$T/out || exit 1; "
           "sed -n '/^  check/,/^$/p' $T/out | "
           "awk '/pass/ && !/furnace|answers/ {print $1, $2}' >$T/rows; "
           "[ ! -e $T/first ] && mv $T/rows $T/first; done; "
           "cmp $T/first $T/rows && grep -c chi2 $T/rows",
           "1\n");
    nothing_is_left();
}

static void text_from_awk_is_sound(void **state)
{
    (void)state;
    does("bsdf-validate \"pipe:$AWK -f $T/diffuse.awk\" --samples 1000 "
         "--wo 40,10");
    assert_has(output, "passed, 0 failed");
    nothing_is_left();
}

static void bytes_from_python_are_its_numbers(void **state)
{
    (void)state;
    struct err err;
    if (sh("python3 -c 'import array, sys; sys.version_info >= (3, 8) or "
           "sys.exit(1)'") != 0) {
        print_message("skipped: no Python 3.8 here\n");
        skip();
    }
    struct bsdf *b =
        foreign_new("pipe:python3 $ROOT/validate/adapters/diffuse.py 0.8",
                    &bands_fixed, &err);
    if (!b)
        fail_msg("%s", err.text);
    struct bsdf *matt = bsdf_new("diffuse:reflectance=0.8", &bands_fixed, &err);
    struct pairs *p = pairs_new();
    enum { N = 3000 };
    struct spectrum f[N];
    struct bsdf_sample s[N];
    double pdf[N];
    bsdf_eval_many(b, N, pairs_wo(p), pairs_wi(p), f);
    bsdf_pdf_many(b, N, pairs_wo(p), pairs_wi(p), pdf);
    bsdf_sample_many(b, N, pairs_wo(p), (struct dirs){ p->ux, p->uy, p->uz },
                     s);
    for (size_t i = 0; i < N; i++) {
        const struct vec3 wo = dirs_at(pairs_wo(p), i);
        const struct vec3 wi = dirs_at(pairs_wi(p), i);
        const struct vec3 u = { p->ux[i], p->uy[i], p->uz[i] };
        const struct bsdf_sample t = bsdf_sample(matt, wo, u);
        assert_close(f[i].band[2], bsdf_eval(matt, wo, wi).band[2], 1e-15);
        assert_close(pdf[i], bsdf_pdf(matt, wo, wi), 1e-15);
        assert_close(s[i].wi.x, t.wi.x, 1e-14);
        assert_close(s[i].pdf, t.pdf, 1e-14);
        assert_true(s[i].weight.band[1] == 0.8 && !s[i].delta);
    }
    free(p);
    bsdf_free(matt);
    bsdf_free(b);
    childless();
}

static void light_from_wo_becomes_radiance(void **state)
{
    (void)state;
    struct bsdf *b = made("glass.so:eta=1.5", &bands_default);
    struct bsdf *ours =
        bsdf_new("dielectric:int_ior=1.5,ext_ior=1", &bands_default, NULL);
    assert_non_null(ours);
    assert_true(bsdf_claims(b).eta == 1.5 && bsdf_claims(b).lossless);
    for (int i = 0; i < 40; i++) {
        const struct vec3 wo = dir_from_degrees(4.7 * i, 33);
        const struct vec3 u = { 0.97 - 0.024 * i, 0.3, 0.6 };
        const struct bsdf_sample s = bsdf_sample(b, wo, u);
        const struct bsdf_sample t = bsdf_sample(ours, wo, u);
        const double w = t.weight.band[0];
        assert_true(s.delta && t.delta);
        if (s.wi.z * t.wi.z > 0) /* which of the two is drawn may differ */
            assert_close(s.weight.band[0], w, 1e-12);
    }
    bsdf_free(ours);
    bsdf_free(b);
    does("bsdf-validate ./glass.so:eta=1.5 --samples 1000 --wo 30,0 "
         "--wo 150,0");
    ends("bsdf-validate ./glass.so:eta=1.5,said=0 --samples 1000 --wo 30,0", 1);
    assert_has(output, "energy       30,0         2.");
}

static void the_cosine_and_the_precision_are_as_said(void **state)
{
    (void)state;
    const struct vec3 wo = dir_from_degrees(41, 0);
    const struct vec3 wi = dir_from_degrees(57, 171), flat = { 1, 0, 0 };
    double value[3];
    static const char *const spec[3] = { "ggx.so", "ggx.so:fault=7",
                                         "ggx.so:fault=8" };
    for (int i = 0; i < 3; i++) {
        struct bsdf *b = made(spec[i], &bands_default);
        value[i] = bsdf_eval(b, wo, wi).band[1];
        assert_true(bsdf_eval(b, wo, flat).band[1] == 0);
        assert_true(bsdf_claims(b).epsilon == 0x1p-52);
        bsdf_free(b);
    }
    assert_close(value[1], value[0] * wi.z, 1e-15);
    assert_close(value[2], value[0], 1e-15);
    does("bsdf-validate ./ggx.so:fault=8 --samples 1000 --wo 40,0");
    ends("bsdf-validate ./ggx.so:fault=7 --samples 1000 --wo 40,0 | "
         "grep FAIL; exit 1",
         1);
    assert_has(output, "sample ");
    assert_has(output, "reciprocity ");

    struct bsdf *single = made("ggx.so:fault=10", &bands_default);
    assert_true(bsdf_claims(single).epsilon == 0x1p-23);
    bsdf_free(single);
}

/* It shows no facets: they are seen in its samples. */
static void masking_is_named(void **state)
{
    (void)state;
    ends("bsdf-validate ./ggx.so:fault=13 --samples 1000 --wo 60,0", 1);
    assert_has(output, "missing masking G1(wi) (explains 100 % of the");
}

static void a_students_metal_is_caught(void **state)
{
    (void)state;
    if (sh("command -v ${CXX:-c++}") != 0) {
        print_message("skipped: no C++ compiler here\n");
        skip();
    }
    ends("${CXX:-c++} -std=c++11 -Wall -Wextra -Werror -O2 -shared -fPIC "
         "-I$ROOT -o student.so $ROOT/tests/plugins/student_microfacet.cpp && "
         "bsdf-validate ./student.so --nm 614,549,466 --samples 1000 "
         "--wo 85,0",
         1);
    assert_has(output, "1.32784/1.14691/0.644822"); /* as by quadrature */
    assert_has(output, "masking with pi for sqrt(pi)");
    assert_has(output, "Fresnel at the wrong angle");
    prints("bsdf-validate ./student.so --samples 1000 --wo 85,0 | grep FAIL | "
           "cut -c 3-14",
           "energy      \nreciprocity \n");
    ends("${CXX:-c++} -std=c++11 -DNO_PDF -shared -fPIC -I$ROOT -o nopdf.so "
         "$ROOT/tests/plugins/student_microfacet.cpp && "
         "bsdf-validate ./nopdf.so",
         2);
    assert_has(output, "double pdf(Vector wo, Vector wi)");
}

static void pictures_show_them_too(void **state)
{
    (void)state;
    does("bsdf-plot lobe ./ggx.so:alpha=0.3 --wo 40,0 -o lobe.svg && "
         "grep -c 'ggx.so:alpha=0.3' lobe.svg");
    does("bsdf-plot histogram \"pipe:bsdf-plugin-host $T/ggx.so alpha=0.2\" "
         "--wo 40,0 --samples 1000 -o h.svg");
    ends("bsdf-plot lobe ./ggx.so:fault=1 --wo 40,0 -o x.svg", 2);
    assert_has(output, "killed by signal 11");
    nothing_is_left();
}

/* -- hostile ones ---------------------------------------------------------- */

static void each_misbehaviour_is_a_verdict(void **state)
{
    (void)state;
    static const struct {
        const char *spec, *said; /* by the check that is called answers */
    } bad[] = {
        { "./ggx.so:fault=1,at=0.9", "killed by signal 11" },
        { "./ggx.so:fault=2,at=0.9", "no answer within 1 s" },
        { "./ggx.so:fault=3,at=0.9", "no answer within 1 s" },
        { "./ggx.so:fault=4,at=0.9", "left with status 0" },
        { "./ggx.so:fault=11,at=0.9", "killed by signal 6" },
        { "\"pipe:bsdf-plugin-host $T/ggx.so fault=1,at=0.9; exit 3\"",
          "left with status 3" },
        { "'pipe:read a; read b; read c; "
          "printf \"bsdf 1\\nlobes diffuse_reflection\\n\\n\"; "
          "head -c 1 >/dev/null; exec cat $T/diffuse.awk'",
          "in place of" },
        { "'pipe:read a; read b; read c; "
          "printf \"bsdf 1\\nlobes diffuse_reflection\\n\\n\"; exec tee "
          "/dev/stderr 2>&1'",
          "bytes that were asked for" },
        { "'pipe:read a; read b; read c; "
          "printf \"bsdf 1\\nlobes diffuse_reflection\\n\\n\"; "
          "exec head -c 3'",
          "left with status 0 but 3 bytes" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char command[512];
        snprintf(command, sizeof command,
                 "bsdf-validate %s diffuse --samples 1000 --wo 30,10 "
                 "--time-limit 1 --threads 2 >$T/out; s=$?; "
                 "grep '^  answers.*FAIL' $T/out; "
                 "[ $(grep -c '^  energy.*pass' $T/out) = 1 ] && exit $s",
                 bad[i].spec);
        ends(command, 1);
        assert_has(output, bad[i].said);
        assert_has(output, "30,10");
        nothing_is_left();
    }
    ends("bsdf-validate ./ggx.so:fault=5,at=0.9 diffuse --samples 1000 "
         "--wo 30,10",
         1);
    assert_has(output, "finite ");
    does("bsdf-validate ./ggx.so:fault=6,at=0.9999 --samples 1000 --wo 30,10 "
         "2>$T/printed && grep -c wi.z $T/printed");
}

static void what_cannot_be_made_says_why(void **state)
{
    (void)state;
    static const char *const bad[][2] = {
        { "./none.so", "none.so" },
        { "./text.so", "text.so" },
        { "./empty.so", "no function bsdf_plugin" },
        { "./later.so", "made for version 7" },
        { "ggx.so", "./ggx.so" },
        { "./ggx.so:alpa=0.2", "did you mean \"alpha\"" },
        { "./ggx.so:alpha=2", "outside [0.001, 1]" },
        { "./ggx.so:alpha=", "expected a number" },
        { "./ggx.so:fault=12", "no such day" },
        { "./glass.so", "eta must be given" },
        { "pipe:", "left with status 0" },
        { "pipe:false", "left with status 1" },
        { "pipe:no-such-program", "left with status 127" },
        { "'pipe:kill -SEGV $$'", "killed by signal 11" },
        { "'pipe:sleep 60'", "no answer within" },
        { "'pipe:kill -STOP $$'", "no answer within" },
        { "'pipe:exec >&-; sleep 60'", "closed its output" },
        { "pipe:yes", "got \"y\"" },
        { "'pipe:cat /dev/zero'", "4096 bytes" },
        { "'pipe:yes \"bsdf 1\"'", "said twice" },
        { "'pipe:printf \"bsdf 2\\n\\n\"'", "speaks version 2" },
        { "'pipe:printf \"bsdf 1\\n\\n\"'", "lobes" },
        { "'pipe:printf \"bsdf 1\\nlobs x\\n\\n\"'", "did you mean \"lobes\"" },
        { "'pipe:printf \"bsdf 1\\nlobes glosy_reflection\\n\\n\"'",
          "did you mean \"glossy_reflection\"" },
        { "'pipe:printf \"bsdf 1\\nformat txt\\n\\n\"'",
          "did you mean \"text\"" },
        { "'pipe:printf \"bsdf 1\\neta -1\\n\\n\"'", "[0.01, 100]" },
        { "'pipe:printf \"error no graphics card\\n\\n\"'",
          "no graphics card" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char command[512];
        snprintf(command, sizeof command,
                 "bsdf-validate diffuse %s --samples 1000 --time-limit 0.2",
                 bad[i][0]);
        ends(command, 2);
        assert_has(output, bad[i][1]);
    }
    ends("BSDF_PLUGIN_HOST=/none bsdf-validate ./ggx.so", 2);
    assert_has(output, "/none cannot be started");
    ends("bsdf-plugin-host ./ggx.so", 2);
    assert_has(output, "handshake");
    nothing_is_left();
}

static void text_that_is_no_answer_is_quoted(void **state)
{
    (void)state;
    static const char *const bad[][2] = {
        { "short", "the answer is \"0.1591" },
        { "long", "expected 3 numbers" },
        { "words", "\"a warning\"" },
        { "more", "behind the last line" },
        { "half", "delta of sample 1 of the answer is 0.5" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const double x[2] = { 0.6, 0 }, y[2] = { 0, 0 }, z[2] = { 0.8, 1 };
        const struct dirs w = { x, y, z };
        char spec[256];
        struct spectrum f[2];
        struct err what;
        snprintf(spec, sizeof spec, "pipe:$AWK -v fault=%s -f $T/diffuse.awk",
                 bad[i][0]);
        struct bsdf *b = foreign_new(spec, &bands_default, &what);
        if (!b)
            fail_msg("%s", what.text);
        if (strcmp(bad[i][0], "half") == 0) {
            const struct bsdf_sample s =
                bsdf_sample(b, dirs_at(w, 1), dirs_at(w, 0));
            assert_true(isnan(s.pdf) && !s.delta);
        } else {
            bsdf_eval_many(b, 2, w, w, f);
            assert_close(f[0].band[2], 0.5 / PI, 1e-16);
            assert_true(isnan(f[1].band[2]));
        }
        assert_true(bsdf_trouble(b, &what));
        assert_has(what.text, bad[i][1]);
        assert_has(what.text, "of wo 0,0");
        bsdf_free(b);
    }
    childless();
}

static void the_guilty_record_is_named(void **state)
{
    (void)state;
    enum { N = 1000, GUILTY = 613 };
    struct bsdf *b = made("ggx.so:fault=1,at=0.99", &bands_default);
    struct pairs *p = pairs_new();
    struct spectrum f[N];
    struct err what;
    char digits[64];
    for (size_t i = 0; i < N; i++)
        p->ix[i] = 0.6, p->iy[i] = 0, p->iz[i] = 0.8;
    const struct vec3 wi = dir_from_degrees(1.25, 77);
    p->ix[GUILTY] = wi.x, p->iy[GUILTY] = wi.y, p->iz[GUILTY] = wi.z;
    bsdf_eval_many(b, N, pairs_wo(p), pairs_wi(p), f);
    for (size_t i = 0; i < N; i++)
        assert_true(isnan(f[i].band[0]) == (i == GUILTY));
    assert_true(bsdf_trouble(b, &what));
    assert_has(what.text, "killed by signal 11 (Segmentation fault)");
    assert_has(what.text, "wi 1.25,77 deg");
    snprintf(digits, sizeof digits, "%.17g", p->oy[GUILTY]);
    assert_has(what.text, digits);
    assert_false(bsdf_trouble(b, &what)); /* forgotten */
    assert_true(
        isfinite(bsdf_eval(b, dirs_at(pairs_wo(p), 0), dirs_at(pairs_wi(p), 0))
                     .band[0]));
    free(p);
    bsdf_free(b);
    childless();
}

static void patience_ends(void **state)
{
    (void)state;
    struct bsdf *b = made("ggx.so:fault=4,at=0.9", &bands_default);
    const struct vec3 up = { 0, 0, 1 }, side = { 0.8, 0, 0.6 };
    struct err what;
    int views = 0;
    for (; views < 40; views++) {
        /* Three new starts of a view; then not even the good is answered. */
        for (int i = 0; i < PIPE_RESTARTS_OF_VIEW; i++)
            assert_true(isnan(bsdf_eval(b, up, up).band[0]));
        if (!isfinite(bsdf_eval(b, up, side).band[0]))
            break;
        assert_true(isnan(bsdf_eval(b, up, up).band[0]));
        assert_true(isnan(bsdf_eval(b, up, side).band[0]));
        assert_true(bsdf_trouble(b, &what));
        assert_has(what.text, "wi 0,0 deg");
        assert_has(what.text, "asked no more");
    }
    /* A view takes four failures, an instance thirteen. */
    assert_int_equal(views, PIPE_RESTARTS / (PIPE_RESTARTS_OF_VIEW + 1));
    assert_true(bsdf_trouble(b, &what));
    assert_true(isnan(bsdf_eval(b, up, side).band[0]));
    assert_true(isnan(bsdf_pdf(b, up, side)));
    assert_true(isnan(bsdf_sample(b, up, side).pdf));
    assert_true(bsdf_trouble(b, &what));
    assert_has(what.text, "not asked any more");
    bsdf_free(b);
    childless();
}

static void threads_share_an_instance(void **state)
{
    (void)state;
    struct bsdf *b = made("ggx.so:fault=1,at=0.95", &bands_default);
    const struct vec3 wo = dir_from_degrees(30, 0);
    const struct vec3 up = { 0, 0, 1 };
    int wrong = 0, troubled = 0;
#pragma omp parallel for num_threads(4) schedule(static, 1)                    \
    reduction(+ : wrong, troubled)
    for (int t = 0; t < 4; t++) {
        if (t == 2)
            wrong += !isnan(bsdf_eval(b, wo, up).band[0]);
        for (int i = 0; i < 500; i++) {
            const struct vec3 wi = dir_from_degrees(20 + 0.1 * i, 11 * t);
            const struct vec3 back = dir_from_degrees(20 + 0.1 * i, 22 * t);
            wrong += !isfinite(bsdf_eval(b, wo, wi).band[0]);
            wrong += bsdf_pdf(b, wo, back) != bsdf_pdf(b, wo, back);
        }
        troubled += (1 + 100 * (t != 2)) * bsdf_trouble(b, NULL);
    }
    assert_int_equal(wrong, 0);
    assert_int_equal(troubled, 1);
    bsdf_free(b);
    childless();
}

static void nobody_outlives_the_program(void **state)
{
    (void)state;
    static const char *const name[] = { "INT", "TERM", "KILL" };
    for (int i = 0; i < 3; i++)
        for (int fault = 2; fault <= 3; fault++) {
            char command[512];
            /* A background job would ignore SIGINT without env. */
            snprintf(command, sizeof command,
                     "env --default-signal=INT bsdf-validate "
                     "$T/ggx.so:fault=%d --wo 30,0 --samples 1000 "
                     "--time-limit 60 & sleep 0.7; kill -%s $! && wait $!; "
                     "[ $? -gt 128 ]",
                     fault, name[i]);
            does(command);
            nothing_is_left();
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "a plugin gives the values of the model it is",
          a_plugin_gives_the_values_of_the_model_it_is },
        { "a plugin is judged as the model it is",
          a_plugin_is_judged_as_the_model_it_is },
        { "text from awk is sound", text_from_awk_is_sound },
        { "bytes from Python are its numbers",
          bytes_from_python_are_its_numbers },
        { "light from wo becomes radiance", light_from_wo_becomes_radiance },
        { "the cosine and the precision are as said",
          the_cosine_and_the_precision_are_as_said },
        { "missing masking is named", masking_is_named },
        { "a student's metal is caught", a_students_metal_is_caught },
        { "pictures show them too", pictures_show_them_too },
        { "each misbehaviour is a verdict", each_misbehaviour_is_a_verdict },
        { "what cannot be made says why", what_cannot_be_made_says_why },
        { "text that is no answer is quoted",
          text_that_is_no_answer_is_quoted },
        { "the guilty record is named", the_guilty_record_is_named },
        { "patience ends", patience_ends },
        { "threads share an instance", threads_share_an_instance },
        { "nobody outlives the program", nobody_outlives_the_program },
    };
    return cmocka_run_group_tests_name("foreign", tests, setup, shell_teardown);
}
