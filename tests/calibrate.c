/* calibrate.c - how far the verdicts can be trusted, by trying
 *
 * Calibration: what the checks say of thousands of sound cases.  Their p-values
 * must not be small more often than they say, and where they can be uniform
 * they must be.  Power (--power): mistakes of a given size that must be caught,
 * sound models that must not, bin masses held against another integral.
 *
 * The tables go to standard output and, with --publish, between two lines of a
 * file, <!-- calibrate --> and <!-- /calibrate --> (or power).  Exit status 1
 * if anything is worse than it may be.
 */
#include <argp.h>
#include <gsl/gsl_errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bsdf/cli.h"
#include "bsdf/outfile.h"
#include "tests/acceptance.h"
#include "tests/calibration.h"
#include "tests/plan_argp.h"
#include "tests/publish.h"
#include "tests/uniformity.h"

/* The chance that a sound program fails the calibration, shared by all of its
 * tests (Bonferroni): each row has LEVELS rates, and a KS where it can be
 * uniform. */
static const double false_alarm = 1e-3;

enum {
    OPT_SEED = 1,
    OPT_ROUNDS,
    OPT_SAMPLES,
    OPT_PUBLISH,
    OPT_POWER,
    OPT_P_VALUES,
    OPT_ONLY
};

struct request {
    struct plan plan; /* seed: of the first round; samples: of a case */
    uint64_t rounds;
    const char *publish, *p_values;
    bool power;
    unsigned parts; /* of the power; 0 for all */
};

static const struct argp_option options[] = {
    { "rounds", OPT_ROUNDS, "N", 0, "runs a model, each at its own seed; 64",
      0 },
    { "publish", OPT_PUBLISH, "FILE", 0,
      "put the tables between the marker lines of a file", 0 },
    { "p-values", OPT_P_VALUES, "FILE", 0,
      "write those that can be uniform, for bsdf-plot p-values", 0 },
    { "power", OPT_POWER, 0, 0, "what mistakes are caught, instead", 0 },
    { "only", OPT_ONLY, "PART", 0,
      "of the power: sound, masses, mistakes or threads; may be repeated", 0 },
    { 0 },
};

static bool part_of(unsigned *parts, const char *name, struct err *err)
{
    for (int i = 0; i < ACCEPTANCE_PARTS; i++)
        if (strcmp(name, acceptance_parts[i]) == 0) {
            *parts |= 1U << i;
            return true;
        }
    return err_set(
        err, "--only %s: expected sound, masses, mistakes or threads", name);
}

static error_t option(int key, char *arg, struct argp_state *state)
{
    struct request *r = state->input;
    struct err err;
    bool ok = true;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &r->plan;
        break;
    case OPT_ROUNDS:
        ok = cli_count(&r->rounds, "--rounds", arg, 1, 100000, &err);
        break;
    case OPT_PUBLISH:
        r->publish = arg;
        break;
    case OPT_P_VALUES:
        r->p_values = arg;
        break;
    case OPT_POWER:
        r->power = true;
        break;
    case OPT_ONLY:
        ok = part_of(&r->parts, arg, &err);
        break;
    case ARGP_KEY_END:
        if (r->parts && (!r->power || r->publish))
            argp_error(state, "--only goes with --power, and without --publish,"
                              " as it would leave out the other tables");
        break;
    case ARGP_KEY_ARG:
        argp_usage(state);
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    if (!ok)
        argp_failure(state, EXIT_REQUEST, 0, "%s", err.text);
    return 0;
}

static void progress(void *context, size_t done, size_t of)
{
    (void)context;
    cli_progress("runs", done, of);
}

static void print_machine(FILE *out, uint64_t seed)
{
    const struct machine m = machine_now();
    fprintf(out, "%s, seeds from %llu, %s, %.0f minutes.\n", m.date,
            (unsigned long long)seed, m.processor, cli_elapsed() / 60);
}

/* -- calibration ----------------------------------------------------------- */

/* How many tests share the false alarm. */
static int tests_of(const struct calibration *c)
{
    int n = 0;
    for (int i = 0; i < c->rows; i++)
        n += LEVELS + (c->row[i].values > 0);
    return n;
}

/* One rate with its 95 % interval; "!" where that is above what is allowed. */
static bool print_rate(FILE *out, size_t k, size_t n, double level, double tail)
{
    const struct interval usual = clopper_pearson(k, n, .025);
    const struct interval strict = clopper_pearson(k, n, tail);
    fprintf(out, " %.2f (%.2f to %.2f)%s |", 100 * (double)k / (double)n,
            100 * usual.low, 100 * usual.high,
            strict.low > level  ? " **above**"
            : usual.low > level ? " !"
                                : "");
    return strict.low <= level;
}

static bool print_row(FILE *out, const struct calibration *c,
                      const struct calibration_row *row, double *room)
{
    const double tail = false_alarm / tests_of(c);
    bool ok = true;
    fprintf(out, "| %s%s%s", row->check, row->part ? ", " : "",
            row->part ? row->part : "");
    if (row->degrees > 0)
        fprintf(out, " (%.0f degrees)", row->degrees / (double)row->cases);
    fprintf(out, " | %zu |", row->cases);
    for (int k = 0; k < LEVELS; k++)
        ok &= print_rate(out, row->small[k], row->cases, calibration_level[k],
                         tail);
    if (row->values == 0) {
        fprintf(out, " - | - | - |\n");
        return ok;
    }
    const struct uniformity u =
        uniformity_of(room, calibration_values(row, -1, room));
    fprintf(out, " %zu | %+.4f %+.4f | %.2g%s |\n", u.n, u.above, -u.below, u.p,
            u.p_above < tail ? " **above**"
            : u.p < tail     ? " below"
                             : "");
    return ok && u.p_above >= tail;
}

/* Which models make a row differ from uniform. */
static void print_why(FILE *out, const struct calibration *c,
                      const struct calibration_row *row, double *room)
{
    const double tail = false_alarm / tests_of(c) / (double)c->models;
    for (int m = 0; m < (int)c->models; m++) {
        const size_t n = calibration_values(row, m, room);
        const struct uniformity u = uniformity_of(room, n);
        if (n > 0 && u.p < tail)
            fprintf(out, "- %s, %s: `%s`, %+.3f %+.3f of %zu, p %.2g\n",
                    row->check, row->part, c->spec[m], u.above, -u.below, n,
                    u.p);
    }
}

static bool print_calibration(FILE *out, const struct calibration *c)
{
    const double tail = false_alarm / tests_of(c);
    bool ok = c->deterministic_failed == 0 && c->runs_failed == 0;
    double *room = malloc((c->cases + 1) * sizeof *room);
    if (!room)
        return false;
    fprintf(out,
            "%zu sound cases: %zu models, %zu runs of %zu random directions, "
            "%llu samples each. ",
            c->cases, c->models, c->runs, c->directions,
            (unsigned long long)c->samples);
    print_machine(out, c->seed);
    fprintf(
        out,
        "\nRuns that failed at the significance of 1e-6: %zu of %zu, below "
        "%.2g with 95 %% confidence; %zu took a further look. Verdicts "
        "without a p that failed: %zu of %zu, below %.2g.\n\n",
        c->runs_failed, c->runs,
        clopper_pearson(c->runs_failed, c->runs, .05).high, c->runs_further,
        c->deterministic_failed, c->deterministic,
        clopper_pearson(c->deterministic_failed, c->deterministic, .05).high);
    fprintf(out,
            "| p-value | cases | p <= .05 [%%] | p <= .01 [%%] | p <= .001 "
            "[%%] | uniform in | off by | KS p |\n"
            "|---|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < c->rows; i++)
        ok &= print_row(out, c, &c->row[i], room);
    fprintf(out,
            "\nIn parentheses 95 %% intervals (Clopper and Pearson), \"!\" "
            "where one is above its level; \"**above**\", a failure, where the "
            "interval of the confidence 1 - %.2g is, %g shared by %d tests. "
            "\"off by\" is how far the distribution of the p-values lies above "
            "and below the uniform one at most: above raises false alarms, and "
            "fails alike.\n",
            tail, false_alarm, tests_of(c));
    if (c->failure[0])
        fprintf(out, "\nThe first failure: %s\n", c->failure);
    fprintf(out, "\nFarther from uniform than chance allows, by model (above, "
                 "below):\n\n");
    const long before = ftell(out);
    for (int i = 0; i < c->rows; i++)
        if (c->row[i].values > 0)
            print_why(out, c, &c->row[i], room);
    if (ftell(out) == before)
        fprintf(out, "- none\n");
    free(room);
    return ok;
}

/* The values that can be uniform, a line each. */
static bool write_p_values(const char *path, const struct calibration *c,
                           struct err *err)
{
    struct outfile out;
    if (!outfile_open(&out, path, err))
        return false;
    fprintf(out.stream, "# of sound models; seeds from %llu\nname\tp\tmodel\n",
            (unsigned long long)c->seed);
    for (int i = 0; i < c->rows; i++)
        for (size_t k = 0; k < c->row[i].values; k++)
            fprintf(out.stream, "%s, %s\t%.17g\t%s\n", c->row[i].check,
                    c->row[i].part, c->row[i].value[k].uniform,
                    c->spec[c->row[i].value[k].model]);
    return outfile_close(&out, err);
}

static bool calibrate(FILE *out, const struct request *r, bool *ok,
                      struct err *err)
{
    static struct calibration c;
    c = (struct calibration){ .spec = calibration_specs,
                              .seed = r->plan.seed,
                              .rounds = r->rounds,
                              .directions = 10,
                              .samples = r->plan.samples,
                              .often = 8 };
    bool made = calibration_make(&c, isatty(2) ? progress : NULL, err);
    if (made)
        *ok = print_calibration(out, &c);
    if (made && r->p_values)
        made = write_p_values(r->p_values, &c, err);
    calibration_clear(&c);
    return made;
}

/* -- power ----------------------------------------------------------------- */

/* What was found so far is on standard output before the end, as it takes a
 * while. */
static struct {
    FILE *out;
    char *text;
    size_t size, shown;
} report;

static void show(void)
{
    fflush(report.out);
    fwrite(report.text + report.shown, 1, report.size - report.shown, stdout);
    fflush(stdout);
    report.shown = report.size;
}

static void progress_of(const char *what, size_t done, size_t of)
{
    show();
    if (!isatty(2))
        return;
    fprintf(stderr, "\r%s: %zu of %zu, %.0f s\033[K%s", what, done, of,
            cli_elapsed(), done == of ? "\r\033[K" : "");
    fflush(stderr);
}

static bool power(FILE *out, const struct request *r, bool *ok, struct err *err)
{
    const struct acceptance a = {
        .parts = r->parts ? r->parts : (1U << ACCEPTANCE_PARTS) - 1,
        .out = out,
        .seed = r->plan.seed,
        .samples = 1000000,
        .sound_samples = 100000,
        .sound = 20,
        .directions = 300,
        .seeds_pdf = 100,
        .seeds_alpha = 100,
        .seeds_leaks = 50,
        .progress = progress_of,
    };
    const bool made = acceptance(&a, ok, err);
    fprintf(out, "\n");
    print_machine(out, r->plan.seed);
    return made;
}

int main(int argc, char **argv)
{
    struct request r = { .plan = { .seed = 1, .samples = 50000 },
                         .rounds = 64 };
    struct err err;
    bool ok = false;
    gsl_set_error_handler_off();
    (void)cli_elapsed();
    argp_err_exit_status = EXIT_REQUEST;
    argp_parse(
        &(struct argp){
            options, option, NULL, "Tries how far the verdicts can be trusted.",
            (const struct argp_child[]){ { &plan_argp, 0, 0, 0 }, { 0 } }, 0,
            0 },
        argc, argv, 0, NULL, &r);
    report.out = open_memstream(&report.text, &report.size);
    bool made = report.out || err_set(&err, "out of memory");
    made = made && (r.power ? power : calibrate)(report.out, &r, &ok, &err);
    if (made)
        show();
    if (report.out && fclose(report.out) != 0)
        made = err_set(&err, "out of memory");
    if (made && r.publish)
        made = publish(r.publish, r.power ? "power" : "calibrate", report.text,
                       &err);
    if (!made)
        fprintf(stderr, "calibrate: %s\n", err.text);
    free(report.text);
    return !made ? EXIT_REQUEST : ok ? EXIT_SOUND : EXIT_UNSOUND;
}
