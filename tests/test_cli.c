/* test_cli.c - the programs as a user meets them
 *
 * They run in the root of the repository and write only into $T.
 */
#include <stdio.h>

#include "tests/close.h"
#include "tests/shell.h"

static int setup(void **state)
{
    (void)state;
    return shell_setup("cli", "");
}

/* A wrong request that comes to light after comments, and nothing else, are
 * printed. */
static void refused_late(const char *command, const char *a, const char *b)
{
    char line[256];
    snprintf(line, sizeof line, "%s >$T/comments", command);
    refused(line, a, b);
    ends("grep -v '^#' $T/comments", 1);
}

static void list_names_models_keys_and_materials(void **state)
{
    (void)state;
    does("bsdf-info list");
    assert_has(output, "roughconductor");
    assert_has(output, "sample_visible");
    assert_has(output, "Ca/Mathewson");
}

static void ior_prints_the_write_ups_calcium(void **state)
{
    (void)state;
    prints(
        "bsdf-info ior Ca --nm 614,549,466 | grep -v '^#' | awk '{printf \"%d "
        "%.5f %.5f\\n\", $1, $2, $3}'",
        "614 0.29294 2.71809\n549 0.28568 2.34786\n"
        "466 0.28733 1.83329\n");
    does("bsdf-info ior Ca");
    assert_has(output, "Mathewson");
    assert_has(output, "339.68 to 1653.12 nm");
}

static void ior_finds_where_the_write_ups_numbers_come_from(void **state)
{
    (void)state;
    prints(
        "bsdf-info ior --match 0.29294/0.28568/0.28733 2.7181/2.3479/1.8333 | "
        "grep -v '^#' | cut -f 1,2",
        "Ca/Mathewson\t614\nCa/Mathewson\t549\n"
        "Ca/Mathewson\t466\n");
}

static void gold_is_out_of_gamut_and_says_so(void **state)
{
    (void)state;
    does("bsdf-info ior Au --rgb all | cut -f 1,11");
    assert_has(output, "spectral\t0.00");
    assert_has(output, "614, 549, 466 nm\t6.35");
    assert_has(output, "warning: R: the spectrum has F0 = 1.0377");
    does("bsdf-info eval conductor:material=Au </dev/null 2>&1 >/dev/null");
    assert_has(output, "bsdf-info: warning: conductor: R:");
    prints("bsdf-info eval conductor:material=Ca </dev/null 2>&1 >/dev/null",
           "");
}

static void exports_and_citations_are_written(void **state)
{
    (void)state;
    does("bsdf-info ior Ca --as mitsuba");
    assert_has(output, "<spectrum name=\"eta\" value=\"360:0.412815, ");
    does("bsdf-info ior Ca --as pbrt");
    assert_has(output, "\"spectrum k\" [ 360 1.23545  365 ");
    does("bsdf-info ior Cu --as openpbr-f82");
    assert_has(output, "base_color = 0.931");
    does("bsdf-info ior Ca --as cpp");
    assert_has(output, "constexpr double eta[3] = { 0.30187, ");
    does("bsdf-info cite Ca");
    assert_has(output, "@article{Mathewson1971,");
    assert_has(output, "Polyanskiy2024");
}

static void albedo_tells_energy_from_radiance(void **state)
{
    (void)state;
    /* Glass without loss from above: T / eta^2 + R in radiance. */
    does("bsdf-info albedo dielectric:int_ior=1.5,ext_ior=1 --wo 0,0 -n 1e5 | "
         "grep '^G' | cut -f 2,4");
    double energy, radiance;
    assert_int_equal(sscanf(output, "%lf %lf", &energy, &radiance), 2);
    assert_close(energy, 1, 1e-6);
    assert_close(radiance, 0.04 + 0.96 / 2.25, 5 * 2e-3);
}

static void eval_takes_lines_and_keeps_comments(void **state)
{
    (void)state;
    does("printf '# mine\\n\\n 30 -1234.5 60 90 \\r\\n' >$T/in; bsdf-info eval "
         "diffuse:reflectance=0.5 $T/in | tail -n 2");
    assert_string_equal(output,
                        "# mine\n30\t-1234.5\t60\t90\t0.15915494309189535\t"
                        "0.15915494309189535\t0.15915494309189535\t"
                        "0.15915494309189532\n");
}

static void eval_names_the_line_that_is_wrong(void **state)
{
    (void)state;
    refused_late("printf '1 2 3\\n' | bsdf-info eval diffuse",
                 "standard input:1", "phi_i is missing");
    sh("printf '1 2 3 4 5\\n' >$T/bad");
    refused_late("bsdf-info eval diffuse $T/bad", "bad:1", "\"5");
    refused_late("printf '181 0 0 0\\n' | bsdf-info eval diffuse", "181",
                 "[0, 180]");
    refused_late("printf '0 inf 0 0\\n' | bsdf-info eval diffuse", "phi_o",
                 "finite");
    refused_late(
        "head -c 100000 /dev/zero | tr '\\0' 1 | bsdf-info eval diffuse",
        "longer than", "");
    refused_late("bsdf-info eval diffuse $T/none", "none", "No such file");
    refused_late("bsdf-info eval diffuse $T", "directory", "");
}

static void samples_repeat_with_their_seed(void **state)
{
    (void)state;
    does("bsdf-info sample roughconductor --wo 60,10 -n 100 --seed 7 >$T/a; "
         "bsdf-info sample roughconductor --wo 60,10 -n 50 --seed 7 >$T/b; "
         "bsdf-info sample roughconductor --wo 60,10 -n 50 --seed 8 >$T/c; "
         "head -n 54 $T/a | cmp - $T/b && ! cmp -s $T/b $T/c");
    does("head -n 2 $T/a; sed -n 3p $T/a");
    assert_has(output, "R, G, B (fit)");
    assert_has(output, "seed: 7");
}

static void wrong_requests_are_status_two(void **state)
{
    (void)state;
    refused("bsdf-info", "expected a command", "");
    refused("bsdf-info lst", "did you mean \"list\"", "");
    refused("bsdf-info eval", "SPEC", "");
    refused("bsdf-info sample diffuse", "--wo", "");
    refused("bsdf-info sample diffuse --wo 1", "THETA,PHI", "\"1\"");
    refused("bsdf-info sample diffuse --wo 200,0", "[0, 180]", "");
    refused("bsdf-info sample diffuse --wo 0,0 -n 0", "-n 0", "[1,");
    refused("bsdf-info sample diffuse --wo 0,0 -n -1", "-n -1", "");
    refused("bsdf-info sample diffuse --wo 0,0 --seed 1e99", "seed", "");
    refused("bsdf-info ior Cq", "Cq", "Ca");
    refused("bsdf-info ior Ca --nm 5000", "5000", "1653.12");
    refused("bsdf-info ior Ca --nm x", "wavelengths", "\"x\"");
    refused("bsdf-info ior Ca --rgb fitt", "fitt", "average");
    refused("bsdf-info ior Ca --rgb fixed:1,2", "2 wavelengths", "three");
    refused_late("bsdf-info ior SiO2 --rgb fit", "SiO2", "k");
    refused("bsdf-info ior Ca --as mitsubb", "did you mean \"mitsuba\"", "");
    refused("bsdf-info ior --match 1/2 1/2/3", "ETA", "three values");
    refused("bsdf-info ior --match 1/2/3 1/2/x", "K", "three values");
    refused("bsdf-info ior --match 1/2/3", "expected ETA and K", "");
    refused("bsdf-info eval diffuse --rgb all", "--rgb all", "ior NAME");
    refused("bsdf-info albedo diffuse", "--wo", "");
    refused("bsdf-info cite Cq", "Cq", "Ca");
    refused("bsdf-validate diffuse --rgb x", "\"x\"", "fixed:A,B,C");
    refused("bsdf-info ior Ca --ior-path $T/none", "--ior-path", "none");
    refused("bsdf-info list a b c", "too many", "");
    refused("bsdf-validate", "expected a SPEC", "");
    refused("bsdf-validate roughconducter", "did you mean", "");
    refused("bsdf-validate diffuse --samples 10", "[1000,", "10");
    refused("bsdf-validate diffuse --significance 0", "--significance 0", "");
    refused("bsdf-validate diffuse --significance nan", "nan", "");
    refused("bsdf-validate diffuse --threads 0", "--threads 0", "");
    refused("bsdf-validate diffuse --escalations 5", "--escalations 5", "4");
    refused("bsdf-validate diffuse --skip chi", "did you mean \"chi2\"", "");
    ends("bsdf-info --nope 2>&1 >$T/printed", 2);
    assert_has(output, "nope");
    does("[ ! -s $T/printed ]");
}

static void malformed_pages_are_status_two(void **state)
{
    (void)state;
    sh("head -c 700 data/ior/Ca/Mathewson.yml >$T/cut.yml; "
       "head -c 100000 /dev/urandom >$T/binary.yml; "
       "head -c 300000 /dev/zero | tr '\\0' '[' >$T/deep.yml; "
       "printf 'DATA:\\n  - type: tabulated nk\\n    data: |\\n"
       "        0.5 nan 1\\n' >$T/nan.yml; "
       "printf 'DATA:\\n  - type: tabulated nk\\n    data: |\\n"
       "        0.4 1 1\\n        0.5 1\\n' >$T/short.yml; : >$T/empty.yml");
    static const char *const file[] = { "cut",   "binary", "deep", "nan",
                                        "short", "empty",  "none" };
    for (size_t i = 0; i < sizeof file / sizeof *file; i++) {
        char command[200];
        snprintf(command, sizeof command, "timeout 5 bsdf-info ior $T/%s.yml",
                 file[i]);
        refused(command, file[i], ".yml");
        snprintf(command, sizeof command,
                 "timeout 5 bsdf-validate "
                 "\"roughconductor:material='$T/%s.yml'\"",
                 file[i]);
        refused(command, file[i], "roughconductor");
    }
    refused("bsdf-info ior $T/nan.yml", "row 1", "nan");
    refused("bsdf-info ior $T/short.yml", "row 2", "");
}

static void validate_says_sound_or_not(void **state)
{
    (void)state;
    does("bsdf-validate diffuse mirror --samples 1e4 --json $T/v.json");
    assert_has(output, "\n90 passed, 0 failed\n");
    assert_has(output, "seed 1,");
    prints("grep -c '\"verdict\": \"pass\"' $T/v.json", "90\n");
    ends("bsdf-validate course_microfacet:material=Au --nm 614,549,466 "
         "--samples 1e4 --wo 85,0 --json $T/v.json",
         1);
    assert_has(output, "1.32784/1.14691/0.644822");
    assert_has(output, "\n8 passed, 3 failed\n");
    prints("grep -c '\"verdict\": \"fail\"' $T/v.json", "3\n");
}

static void a_verdict_can_be_replayed_alone(void **state)
{
    (void)state;
    does("bsdf-validate diffuse roughconductor --samples 1e4 --seed 9 -v "
         "--threads 2 | sed -n '/^roughconductor/,$p' | grep '75,40' >$T/a; "
         "bsdf-validate roughconductor --samples 1e4 --seed 9 -v --wo 75,40 | "
         "grep '75,40' >$T/b; cut -c 1-38 $T/a >$T/c; cut -c 1-38 $T/b | cmp - "
         "$T/c && cat $T/c");
    assert_has(output, "chi2");
}

static void a_report_is_whole_or_not_there(void **state)
{
    (void)state;
    ends("bsdf-validate diffuse --samples 1e3 --json $T/none/v.json 2>&1 "
         ">/dev/null",
         2);
    assert_has(output, "none/v.json");
    prints("echo old >$T/old.json; (ulimit -f 0; trap '' XFSZ; bsdf-validate "
           "diffuse --samples 1e3 --json $T/old.json 2>/dev/null >/dev/null); "
           "cat $T/old.json; ls $T | grep -c old",
           "old\n1\n");
    /* Links are followed, and what is no file is written as it stands. */
    does("cd $T && echo old >real && ln -s real link && bsdf-validate diffuse "
         "--samples 1e3 --json link >/dev/null && test -L link && grep -c seed "
         "real");
    does("cd $T && mkfifo pipe && (cat pipe >piped & bsdf-validate diffuse "
         "--samples 1e3 --json pipe >/dev/null; wait) && test -p pipe && grep "
         "-c seed piped");
    ends("bsdf-info list >/dev/full 2>/dev/null", 2);
    ends("bsdf-validate diffuse --samples 1e3 >/dev/full 2>/dev/null", 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "list names models, keys and materials",
          list_names_models_keys_and_materials },
        { "ior prints the write-up's calcium",
          ior_prints_the_write_ups_calcium },
        { "ior finds where the write-up's numbers come from",
          ior_finds_where_the_write_ups_numbers_come_from },
        { "gold is out of gamut and says so",
          gold_is_out_of_gamut_and_says_so },
        { "exports and citations are written",
          exports_and_citations_are_written },
        { "albedo tells energy from radiance",
          albedo_tells_energy_from_radiance },
        { "eval takes lines and keeps comments",
          eval_takes_lines_and_keeps_comments },
        { "eval names the line that is wrong",
          eval_names_the_line_that_is_wrong },
        { "samples repeat with their seed", samples_repeat_with_their_seed },
        { "wrong requests are status 2, with a reason",
          wrong_requests_are_status_two },
        { "malformed pages are status 2, with a reason",
          malformed_pages_are_status_two },
        { "validate says sound or not", validate_says_sound_or_not },
        { "a verdict can be replayed alone", a_verdict_can_be_replayed_alone },
        { "a report is whole or not there", a_report_is_whole_or_not_there },
    };
    return cmocka_run_group_tests_name("cli", tests, setup, shell_teardown);
}
