/* main.c - bsdf-validate: is this scattering model sound, and why not */
#include <argp.h>
#include <gsl/gsl_errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bsdf/cli.h"
#include "validate/foreign.h"
#include "validate/pipe.h"
#include "validate/replay.h"
#include "validate/report.h"
#include "validate/run.h"

enum {
    OPT_ALL = 1,
    OPT_JSON,
    OPT_JUNIT,
    OPT_REPLAY,
    OPT_PROGRAMS,
    OPT_SPEC,
    OPT_SAMPLES,
    OPT_SIGNIFICANCE,
    OPT_WO,
    OPT_THREADS,
    OPT_ESCALATIONS,
    OPT_SKIP,
    OPT_LIST,
    OPT_TIME_LIMIT
};
enum { WO_MAX = 256, SPECS_MAX = 256 };

/* Some hundred directions of --all, in less than a minute on two cores. */
static const uint64_t all_samples = 100000;

struct request {
    struct plan plan;
    struct cli_shared shared;
    struct vec3 wo[WO_MAX];
    size_t wos;
    const char *spec[SPECS_MAX];
    size_t specs;
    const char *json, *junit;
    const char *replay, *replay_spec;
    bool programs;
    const char *own; /* an option that a report answers instead */
    bool all, verbose;
};

const char *argp_program_version = "bsdf-validate " BSDF_VERSION;
static const char about[] =
    "Says whether scattering models are sound, and why not."
    "\vA SPEC is name or name:key=value,...; `bsdf-info list` names the models "
    "and their keys.  A model of yours is pipe:COMMAND or "
    "./my.so:key=value,...  Exit status: 0 sound, 1 a check failed, 2 the "
    "request "
    "was wrong.";

static const struct argp_option options[] = {
    { "all", OPT_ALL, 0, 0,
      "every model of the library over its roughnesses, distributions "
      "and ways of sampling",
      0 },
    { "wo", OPT_WO, "THETA,PHI", 0,
      "outgoing direction [deg], may be "
      "repeated; if none 0, 30, 75, 89, 89.9 and for two-sided models those "
      "below and the critical angle",
      0 },
    { "samples", OPT_SAMPLES, "N", 0,
      "drawn for each model and direction, "
      "1000 to 1e9; 1e6, or 1e5 with --all",
      0 },
    { "significance", OPT_SIGNIFICANCE, "A", 0,
      "chance that a run of sound "
      "models fails; 1e-6",
      0 },
    { "escalations", OPT_ESCALATIONS, "N", 0,
      "how often a doubtful result may ask for four times the samples, 0 to 4; "
      "2",
      0 },
    { "skip", OPT_SKIP, "CHECK", 0,
      "leave a check out, may be repeated; --list names them", 0 },
    { "threads", OPT_THREADS, "N", 0,
      "as many as there are, if not given; "
      "the verdicts do not depend on it",
      0 },
    { "time-limit", OPT_TIME_LIMIT, "SECONDS", 0,
      "for each request to a model in another program; 10", 0 },
    { "json", OPT_JSON, "FILE", 0, "write the whole run there as well", 0 },
    { "junit", OPT_JUNIT, "FILE", 0,
      "write it as JUnit's XML, for continuous integration", 0 },
    { "programs", OPT_PROGRAMS, 0, 0,
      "a report that is replayed may start the programs and plugins that its "
      "specs name",
      0 },
    { "replay", OPT_REPLAY, "FILE", 0,
      "run a report (--json) again as it says, show what fails, and say "
      "whether "
      "every verdict is the same; 2 if one is not",
      0 },
    { "spec", OPT_SPEC, "SPEC", 0,
      "of a report that is replayed, compare and show this model alone; or its "
      "number, from 1",
      0 },
    { "verbose", 'v', 0, 0, "every direction, not just the worst", 0 },
    { "list", OPT_LIST, 0, 0, "name the checks and stop", 0 },
    { 0 },
};

/* Whether an option is one that a report answers. */
static bool of_the_report(int key)
{
    static const int keys[] = { OPT_SAMPLES, OPT_SIGNIFICANCE, OPT_WO,
                                OPT_ESCALATIONS, OPT_SKIP };
    bool found = false;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        found |= keys[i] == key;
    return found;
}

static bool skip(struct plan *plan, const char *name, struct err *err)
{
    const int index = checks_find(name);
    const char *names[65] = { NULL };
    if (index >= 0) {
        plan->skip |= (uint64_t)1 << index;
        return true;
    }
    for (int i = 0; checks[i] && i < 64; i++)
        names[i] = checks[i]->name;
    return err_unknown(err, "check", name, names);
}

/* A report says by itself what to run. */
static bool request_check(const struct request *r, struct err *err)
{
    if (r->replay && r->specs > 0)
        return err_set(err,
                       "--replay: expected no SPEC and no --all; the report "
                       "has them");
    const char *own = r->own ? r->own : r->shared.given;
    if (r->replay && own)
        return err_set(err, "--replay: --%s is what the report says", own);
    if (r->replay_spec && !r->replay)
        return err_set(err, "--spec: expected --replay FILE with it");
    if (!r->replay && r->specs == 0)
        return err_set(err, "expected a SPEC, as in roughconductor:"
                            "material=Ca,alpha=0.25, or --all");
    return true;
}

static error_t option(int key, char *arg, struct argp_state *state)
{
    struct request *r = state->input;
    struct err err;
    uint64_t n;
    double seconds;
    bool ok = true;
    for (int i = 0; key > 0 && options[i].name; i++)
        if (options[i].key == key && of_the_report(key))
            r->own = options[i].name;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &r->shared;
        break;
    case OPT_ALL:
        r->all = true;
        for (int i = 0; run_all_specs[i] && r->specs < SPECS_MAX; i++)
            r->spec[r->specs++] = run_all_specs[i];
        break;
    case OPT_WO:
        if (r->wos == WO_MAX)
            ok = err_set(&err, "--wo: at most %d directions", WO_MAX);
        else
            ok = cli_direction(&r->wo[r->wos], arg, &err);
        r->wos++;
        break;
    case OPT_SAMPLES:
        ok = cli_count(&r->plan.samples, "--samples", arg, 1000, 1000000000,
                       &err);
        break;
    case OPT_SIGNIFICANCE:
        ok = cli_number(&r->plan.significance, "--significance", arg, 1e-100,
                        0.5, &err);
        break;
    case OPT_ESCALATIONS:
        ok = cli_count(&n, "--escalations", arg, 0, 4, &err);
        r->plan.escalations = ok ? (int)n : 0;
        break;
    case OPT_SKIP:
        ok = skip(&r->plan, arg, &err);
        break;
    case OPT_THREADS:
        ok = cli_count(&n, "--threads", arg, 1, 1024, &err);
        r->plan.threads = ok ? (int)n : 0;
        break;
    case OPT_TIME_LIMIT:
        ok = cli_number(&seconds, "--time-limit", arg, 0.001, 1e6, &err);
        if (ok)
            pipe_set_time_limit(seconds);
        break;
    case OPT_JSON:
        r->json = arg;
        break;
    case OPT_JUNIT:
        r->junit = arg;
        break;
    case OPT_PROGRAMS:
        r->programs = true;
        break;
    case OPT_REPLAY:
        r->replay = arg;
        break;
    case OPT_SPEC:
        r->replay_spec = arg;
        break;
    case 'v':
        r->verbose = true;
        break;
    case OPT_LIST:
        for (int c = 0; checks[c]; c++)
            printf("%-12s %s\n", checks[c]->name, checks[c]->about);
        exit(EXIT_SOUND);
    case ARGP_KEY_ARG:
        if (r->specs == SPECS_MAX)
            ok = err_set(&err, "at most %d specs", SPECS_MAX);
        else
            r->spec[r->specs++] = arg;
        break;
    case ARGP_KEY_END:
        ok = request_check(r, &err);
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
    cli_progress("directions", done, of);
}

/* The files first, as a reader of the text may hang up. */
static bool files_write(const struct request *r, const struct run *run,
                        int words, char *const *word, struct err *err)
{
    return (!r->json || report_json(r->json, run, words, word, err)) &&
           (!r->junit || report_junit(r->junit, run, err));
}

/* Runs the checks, and says what they found; the exit status. */
static int validate(struct request *r, int words, char *const *word,
                    struct err *err)
{
    static struct bsdf *bsdf[SPECS_MAX];
    struct run run;
    int status = EXIT_REQUEST;
    if (r->plan.samples == 0) /* not asked for */
        r->plan.samples = r->all ? all_samples : plan_default.samples;
    for (size_t i = 0; i < r->specs; i++) {
        bsdf[i] = foreign_new(r->spec[i], &r->shared.bands, err);
        if (!bsdf[i])
            goto done;
        if (err->text[0])
            fprintf(stderr, "bsdf-validate: warning: %s\n", err->text);
    }
    if (run_checks(&run, &r->plan, (const struct bsdf *const *)bsdf, r->specs,
                   r->wo, r->wos, isatty(2) ? progress : NULL, NULL, err)) {
        if (files_write(r, &run, words, word, err))
            status = run.failed ? EXIT_UNSOUND : EXIT_SOUND;
        report_text(stdout, &run, r->verbose);
        run_clear(&run);
    }
done:
    for (size_t i = 0; i < r->specs; i++)
        bsdf_free(bsdf[i]);
    return status;
}

/* Runs a report again; the exit status. */
static int replay(const struct request *r, int words, char *const *word,
                  struct err *err)
{
    struct replay again;
    int status = EXIT_REQUEST;
    if (!replay_run(&again, r->replay, r->replay_spec, r->plan.threads,
                    r->programs, isatty(2) ? progress : NULL, NULL, err))
        return EXIT_REQUEST;
    const bool written = files_write(r, &again.run, words, word, err);
    report_text(stdout, &again.shown, r->verbose);
    if (again.same)
        printf("replayed: the same %zu verdicts in every field\n",
               again.compared);
    else
        printf("replayed: not the same\n");
    if (written && !again.same)
        err_set(err, "%s (made by version %s, this is " BSDF_VERSION "): %s",
                r->replay, again.recorded.version, again.differs.text);
    else if (written)
        status = again.shown.failed ? EXIT_UNSOUND : EXIT_SOUND;
    replay_clear(&again);
    return status;
}

int main(int argc, char **argv)
{
    static struct request r;
    struct err err;
    /* Parsing puts the options first. */
    char **word = malloc((size_t)argc * sizeof *word);
    if (!word)
        return EXIT_REQUEST;
    memcpy(word, argv, (size_t)argc * sizeof *word);
    r.plan = plan_default;
    r.plan.samples = 0;
    r.shared =
        (struct cli_shared){ .bands = bands_default, .seed = r.plan.seed };
    gsl_set_error_handler_off();
    (void)cli_elapsed();
    argp_err_exit_status = EXIT_REQUEST;
    argp_parse(&(struct argp){ options, option, "SPEC...\n--replay FILE", about,
                               (const struct argp_child[]){
                                   { &cli_shared_argp, 0, 0, 0 }, { 0 } },
                               0, 0 },
               argc, argv, 0, NULL, &r);
    r.plan.seed = r.shared.seed;
    int status = r.replay ? replay(&r, argc, word, &err)
                          : validate(&r, argc, word, &err);
    if (status == EXIT_REQUEST)
        fprintf(stderr, "bsdf-validate: %s\n", err.text);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "bsdf-validate: standard output: write error\n");
        status = EXIT_REQUEST;
    }
    free(word);
    return status;
}
