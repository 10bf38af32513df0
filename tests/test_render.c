/* test_render.c - bsdf-render as a user meets it
 *
 * Scenes are those of data/scenes, and one of the test's own; pictures of the
 * course's are compared where BSDF_SHARED (../shared) has them.
 */
#include <stdio.h>
#include <stdlib.h>

#include "tests/close.h"
#include "tests/shell.h"

/* A lamp above a floor, beside a ball of rough silver. */
static const char scene[] =
    "<scene version='3.0.0'>\n"
    "<default name='radius' value='0.3'/>\n"
    "<default name='spp' value='4'/>\n"
    "<integrator type='path'><integer name='max_depth' value='4'/>"
    "</integrator>\n"
    "<sensor type='perspective'><float name='fov' value='40'/>\n"
    "<transform name='to_world'><lookat origin='0, 1.6, 2' target='0, 0.2, 0' "
    "up='0, 1, 0'/></transform>\n"
    "<film type='hdrfilm'><integer name='width' value='60'/>"
    "<integer name='height' value='40'/><rfilter type='box'/></film>\n"
    "<sampler type='independent'><integer name='sample_count' "
    "value='$spp'/></sampler></sensor>\n"
    "<shape type='rectangle'><transform name='to_world'>"
    "<rotate x='1' angle='-90'/></transform><bsdf type='diffuse'/></shape>\n"
    "<shape type='rectangle'><transform name='to_world'><scale value='0.3'/>"
    "<rotate x='1' angle='90'/><translate y='1.5'/></transform>"
    "<emitter type='area'><rgb name='radiance' value='9, 8, 7'/></emitter>"
    "</shape>\n"
    "<shape type='sphere'><point name='center' x='0.4' y='0.3' z='0'/>"
    "<float name='radius' value='$radius'/><bsdf type='roughconductor'>"
    "<float name='alpha' value='0.3'/></bsdf></shape>\n"
    "</scene>\n";

/* Arguments, with the files of $T, that are refused. */
static void not_told(const char *arguments, const char *a, const char *b)
{
    char line[2048];
    snprintf(line, sizeof line, "cd $T && bsdf-render %s", arguments);
    refused(line, a, b);
}

/* The same, and no picture. */
static void not_made(const char *arguments, const char *a, const char *b)
{
    char with[1024];
    snprintf(with, sizeof with, "-f no.png %s", arguments);
    does("rm -f $T/no.png");
    not_told(with, a, b);
    ends("test -e $T/no.png", 1);
}

static int setup(void **state)
{
    (void)state;
    if (shell_setup("render", "") != 0)
        return -1;
    FILE *out = fopen(in_folder("a.xml"), "w");
    return !out || fputs(scene, out) < 0 || fclose(out) != 0;
}

static void writes_pictures(void **state)
{
    (void)state;
    does("bsdf-render $T/a.xml -f $T/a.png -f $T/a.exr 2>$T/said && "
         "test -s $T/a.png && test -s $T/a.exr && ls $T | wc -l");
    assert_string_equal(output + strlen(output) - 2, "4\n"); /* said, a.* */
    does("cat $T/said");
    assert_has(output, "3 shapes");
    assert_has(output, "60 x 40 pixels");
    assert_has(output, "samples 4, depth 3,");
    assert_has(output, "mean luminance 0.");
    prints("cd $T && bsdf-render --quiet a.xml 2>&1", "a.png\n");
}

static void says_how_a_picture_was_made(void **state)
{
    (void)state;
    does("bsdf-render --quiet --seed 17 $T/a.xml -f $T/a.exr && "
         "strings -n 3 $T/a.exr");
    assert_has(output, "--seed 17");
    assert_has(output, "bsdf-render ");
    assert_has(output, "seconds");
}

static void the_same_for_any_threads(void **state)
{
    (void)state;
    does("for t in 1 2 5; do bsdf-render --quiet -t $t -s 9 $T/a.xml -f "
         "$T/t$t.png >$T/said || exit 1; done; cmp $T/t1.png $T/t2.png && "
         "cmp $T/t1.png $T/t5.png");
}

static double number_of(const char *name)
{
    char line[64];
    snprintf(line, sizeof line, "\n%s\t", name);
    const char *at = strstr(output, line);
    assert_non_null(at);
    return strtod(at + strlen(line), NULL);
}

/* A part alone is what it is of the whole, and errors shrink with samples. */
static void measures(void **state)
{
    (void)state;
    does("cd $T && bsdf-render --quiet -s 16 a.xml -f few.exr && bsdf-render "
         "--quiet -s 16 a.xml -p 10 8 20 12 -f part.exr && bsdf-render --quiet "
         "-s 256 a.xml -f many.exr");
    does("bsdf-render --measure $T/part.exr");
    const double mean = number_of("luminance"),
                 error = number_of("luminance_error");
    assert_true(mean > 0 && error > 0);
    assert_close(number_of("samples"), 16, 0);
    assert_close(error, sqrt(number_of("variance") / 240), 1e-6 * error);
    does("bsdf-render --measure $T/few.exr -p 10 8 20 12");
    assert_close(number_of("luminance"), mean, 0);
    assert_close(number_of("luminance_error"), error, 0);
    assert_close(number_of("width"), 20, 0);
    does("bsdf-render --measure $T/few.exr -p 59 39 20 12");
    assert_close(number_of("width") * number_of("height"), 1, 0);
    does("bsdf-render --measure $T/few.exr");
    const double all = number_of("luminance_error");
    does("bsdf-render --measure $T/many.exr");
    assert_close(number_of("luminance_error") / all, 0.25, 0.1);
}

static void compares(void **state)
{
    (void)state;
    does("cd $T && bsdf-render --quiet -s 64 -r 180 120 a.xml -f a.exr && "
         "bsdf-render --quiet -s 64 -r 180 120 --seed 2 a.xml -f b.exr && "
         "bsdf-render --quiet -s 64 -r 180 120 -D radius=0.32 a.xml -f c.exr");
    does("cd $T && bsdf-render --compare a.exr b.exr");
    print_message("%s", output);
    ends("cd $T && bsdf-render --compare a.exr c.exr --map z.png", 1);
    print_message("%s", output);
    does("test -s $T/z.png");
    ends("cd $T && bsdf-render --compare a.exr c.exr --numbers", 1);
    assert_has(output, "same\t0\n");
    assert_has(output, "variance_ratio\t");
    does("cd $T && bsdf-render --quiet -s 64 a.xml -f a.png && bsdf-render "
         "--quiet -s 64 --seed 2 a.xml -f b.png && bsdf-render --compare a.png "
         "b.png --block 10");
    assert_has(output, "correlation 0.9");
}

static void ways_to_the_same_picture(void **state)
{
    static const char *const ways[] = {
        "--direct light",
        "--direct bsdf",
        "-H",
        "--sampling cosine",
        "--sampling uniform",
        "-l 3",
        "--rr-depth 1",
        "--rr-depth 1 --rr-probability 0.6",
    };
    (void)state;
    does("cd $T && bsdf-render --quiet -r 120 80 -s 100 --seed 9 a.xml -f "
         "a.exr");
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        char line[512];
        snprintf(line, sizeof line,
                 "cd $T && bsdf-render --quiet -r 120 80 -s 100 %s a.xml -f "
                 "b.exr && "
                 "bsdf-render --compare a.exr b.exr",
                 ways[i]);
        does(line);
    }
}

static void bounces_add_up(void **state)
{
    (void)state;
    does("cd $T && for m in 0 1 2 3; do bsdf-render -s 64 -m $m -o 0 a.xml -f "
         "m.exr 2>&1 | sed -n 's/mean luminance \\([^ ]*\\).*/\\1/p'; done");
    double sum = 0, part[4];
    assert_int_equal(
        sscanf(output, "%lf %lf %lf %lf", part, part + 1, part + 2, part + 3),
        4);
    for (int i = 0; i < 4; i++)
        sum += part[i];
    does("cd $T && bsdf-render -s 64 -m 3 a.xml -f m.exr 2>&1 | sed -n "
         "'s/mean luminance \\([^ ]*\\).*/\\1/p'");
    print_message("%g + %g + %g + %g = %g; all %s", part[0], part[1], part[2],
                  part[3], sum, output);
    assert_close(atof(output), sum, 0.02 * sum);
}

static void adaptive_counts(void **state)
{
    (void)state;
    does("cd $T && bsdf-render -s 256 -a 16 0.1 a.xml -f a.png 2>&1 && "
         "test -s a_rate.png");
    assert_has(output, "samples a pixel: ");
    assert_has(output, ", 16 to 256");
}

static void wrong_requests(void **state)
{
    (void)state;
    not_made("", "SCENE", "data/scenes");
    not_made("a.xml b.xml", "b.xml", "one argument too many");
    not_made("missing.xml", "missing.xml", "No such file");
    not_made("a.xml -f b.jpg", "b.jpg", ".png or .exr");
    not_made("a.xml -s 0", "-s 0", "[1, 4294967295]");
    not_made("a.xml -m -1", "-m -1", "whole number");
    not_made("a.xml -m 1.5", "-m 1.5", "whole number");
    not_made("a.xml -r 0 5", "-r W 0", "whole number");
    not_made("a.xml -r 7", "-r W H", "missing");
    not_made("a.xml -a 8", "-a BATCH TOL", "missing");
    not_made("a.xml -a 8 -1", "-a TOL -1", "[1e-09, ");
    not_made("a.xml -a 8 0", "-a TOL 0", "[1e-09, ");
    not_made("a.xml -o 2", "-o 2", "[0, 1]");
    not_made("a.xml -p 50 0 20 5", "20 x 5 at 50, 0", "60 x 40");
    not_made("a.xml -b 0.1", "lens radius 0.1", "focal distance");
    not_made("a.xml -m 2 --only-bounce 3", "--only-bounce 3",
             "after 2 bounces");
    not_made("a.xml -o 0 --only-bounce 1", "-o 0", "--only-bounce 1");
    not_made("a.xml --nm 500,600", "--nm", "expected three");
    not_made("a.xml -D radius=", "a.xml", "it is empty");
    not_made("a.xml -c a.xml", "a.xml", "number 1");
    not_made("a.xml -e a.xml", "a.xml", "EXR");
    not_made("a.xml --direct mix", "mix", "mis");
    not_made("a.xml --sampling cosin", "cosin", "cosine");
    not_made("a.xml --sampler sobol", "sobol", "ldsampler");
    not_made("a.xml --compat corse", "corse", "course");
    not_made("a.xml -D radius", "radius", "NAME=VALUE");
    not_made("a.xml -D radius=wide", "a.xml", "wide");
    not_made("--compare a.xml", "nothing is rendered", "--compare");
    not_made("--measure a.xml", "nothing is rendered", "--measure");
    not_told("--compare a.xml", "--compare", "two pictures");
    not_told("--compare a.xml a.xml", "a.xml", "EXR");
    not_told("--compare few.exr few.exr --map z.exr", "--map z.exr", ".png");
    not_told("--compare few.exr few.exr --measure", "--measure", "--compare");
    not_told("--compare a.png b.png --numbers", "--numbers", "EXRs alone");
    not_told("--measure few.exr b.exr", "--measure", "one picture");
    not_told("--measure a.xml", "a.xml", "");
    not_told("--measure few.exr -p 500 0 1 1", "-p 500 0", "60 x 40");
    not_made("a.xml -f /dev/full/x.png", "/dev/full/x.png", "Not a directory");
}

/* A picture that was there stays, or the new one is whole. */
static void killed_while_writing(void **state)
{
    (void)state;
    does(
        "cd $T && bsdf-render --quiet a.xml -r 900 700 -s 1 -f k.exr -f k.png");
    does(
        "cd $T && cp k.exr old.exr && for i in 1 2 3 4 5 6 7 8 9 10 11 12; do "
        "bsdf-render --quiet a.xml -r 900 700 -s 2 --seed $i -f k.exr >said & "
        "p=$!; sleep 0.$((i * 7 + 5)); kill -9 $p 2>/dev/null; wait $p "
        "2>/dev/null; bsdf-render --compare k.exr k.exr --block 100 >said 2>&1 "
        "|| grep -q 'at least 2' said || { cat said; exit 1; }; done");
}

static void interrupted_keeps_what_is_done(void **state)
{
    (void)state;
    const int status = sh("cd $T && rm -f i.exr && (bsdf-render a.xml -s 1e9 "
                          "-f i.exr 2>said & p=$!; sleep 1; kill -INT $p; "
                          "wait $p)");
    assert_int_equal(status, 130);
    does("cd $T && cat said && test -s i.exr");
    assert_has(output, "stopped; samples 1000000000");
}

static void surroundings(void **state)
{
    (void)state;
    /* What a lamp's picture lights is a sky of the same mean. */
    does("cd $T && bsdf-render --quiet -s 16 a.xml -f sky.exr && bsdf-render "
         "--quiet -s 200 -e sky.exr a.xml -f a.exr && bsdf-render --quiet -s "
         "200 --direct bsdf --seed 2 -e sky.exr a.xml -f b.exr && bsdf-render "
         "--compare a.exr b.exr");
}

static void cameras_of_the_course(void **state)
{
    (void)state;
    does("cd $T && printf '50 39 1.3333 0.1 100\\n0 0.75 4.8 0 0.75 0\\n1.57 0 "
         "4.8 0.1 10\\n1 0 0 0 1 0 0 0 1\\n60 40 64.3\\n4.7 0.01\\n' >c.txt && "
         "bsdf-render -c c.txt a.xml -f c.png 2>&1");
    assert_has(output, "mean luminance 0.");
}

static void the_courses_pictures(void **state)
{
    (void)state;
    const char *shared = getenv("BSDF_SHARED");
    char line[1024];
    snprintf(line, sizeof line, "test -d '%s/data/cs184'",
             shared ? shared : "../shared");
    if (sh(line) != 0) {
        print_message("skipped: there is no %s/data/cs184\n",
                      shared ? shared : "../shared");
        skip();
    }
    snprintf(line, sizeof line,
             "sh tests/course.sh \"$(dirname \"$(command -v bsdf-render)\")\" "
             "'%s' $T/course fast",
             shared ? shared : "../shared");
    const int status = sh(line);
    print_message("%s", output);
    assert_int_equal(status, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "it writes pictures and says what it did", writes_pictures },
        { "a picture says how it was made", says_how_a_picture_was_made },
        { "threads do not change a picture", the_same_for_any_threads },
        { "a picture and its parts are measured", measures },
        { "pictures are compared", compares },
        { "there are many ways to one picture", ways_to_the_same_picture },
        { "bounces add up", bounces_add_up },
        { "adaptive sampling counts", adaptive_counts },
        { "wrong requests are refused", wrong_requests },
        { "kill -9 leaves the old picture or the new", killed_while_writing },
        { "an interruption keeps what is done",
          interrupted_keeps_what_is_done },
        { "a picture may surround the scene", surroundings },
        { "the course's camera files are read", cameras_of_the_course },
        { "the course's pictures are made again", the_courses_pictures },
    };
    return cmocka_run_group_tests_name("render", tests, setup, shell_teardown);
}
