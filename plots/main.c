/* main.c - bsdf-plot: pictures of scattering models */
#include <argp.h>
#include <errno.h>
#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/cli.h"
#include "plots/kinds.h"
#include "validate/foreign.h"

enum {
    OPT_NM = 1,
    OPT_RGB,
    OPT_IOR_PATH,
    OPT_WO,
    OPT_SEED,
    OPT_SAMPLES,
    OPT_RANGE,
    OPT_PROGRAMS
};

struct request {
    struct plot_request plot;
    bool has_wo;
    const char *arg[2]; /* the kind, and a spec or names */
    int args;
};

const char *argp_program_version = "bsdf-plot " BSDF_VERSION;
static const char about[] =
    "Draws scattering models, and the optical constants that they are made of."
    "\vBeside the picture lie its numbers (.tsv) and the script that draws it "
    "again (.gp, for gnuplot).  A SPEC is name or name:key=value,...; a NAME "
    "is a material like Ca, a page like Ca/Mathewson, or a file.  `bsdf-info "
    "list` names the models, their keys and the materials.  Exit status: 0, "
    "or 2 if the request was wrong or gnuplot failed.";

static const struct argp_option options[] = {
    { "wo", OPT_WO, "THETA,PHI", 0, "outgoing direction [deg]", 0 },
    { "output", 'o', "FILE", 0,
      "ends in .svg, .pdf or .png, for a report in .html; KIND.svg if not "
      "given",
      0 },
    { "samples", OPT_SAMPLES, "N", 0, "drawn for a histogram, 1000 to 1e9; 1e6",
      0 },
    { "seed", OPT_SEED, "S", 0, "of the random numbers; 1", 0 },
    { "nm", OPT_NM, "A,B,C", 0, "the bands: one to four wavelengths", 0 },
    { "rgb", OPT_RGB, "METHOD", 0,
      "the bands: R, G, B by fit (if neither is given), average or fixed:A,B,C",
      0 },
    { "range", OPT_RANGE, "LO,HI", 0,
      "of wavelengths in nm; what there is from 360 to 830", 0 },
    { "programs", OPT_PROGRAMS, 0, 0,
      "a report may start the programs and plugins that its specs name", 0 },
    { "ior-path", OPT_IOR_PATH, "DIR", 0,
      "a refractiveindex.info database (or BSDF_IOR_PATH)", 0 },
    { 0 },
};

/* "LO,HI" in nm. */
static bool range_read(struct plot_request *r, const char *text,
                       struct err *err)
{
    char *end;
    const double lo = strtod(text, &end);
    const bool comma = end != text && *end == ',';
    const char *second = comma ? end + 1 : text;
    const double hi = strtod(second, &end);
    if (!comma || end == second || *end != '\0' ||
        !(lo > 0 && hi > lo && hi <= 1e9))
        return err_set(err,
                       "--range \"%.80s\": expected two rising wavelengths in "
                       "(0, 1e9] nm, as in 360,830",
                       text);
    r->lo_nm = lo;
    r->hi_nm = hi;
    return true;
}

static error_t option(int key, char *arg, struct argp_state *state)
{
    struct request *r = state->input;
    struct err err;
    bool ok = true;
    switch (key) {
    case OPT_NM:
        ok = bands_parse(&r->plot.bands, arg, &err);
        break;
    case OPT_RGB:
        ok = bands_parse_rgb(&r->plot.bands, arg, &err);
        break;
    case OPT_RANGE:
        ok = range_read(&r->plot, arg, &err);
        break;
    case OPT_PROGRAMS:
        r->plot.programs = true;
        break;
    case OPT_IOR_PATH:
        ok = cli_ior_path(arg, &err);
        break;
    case OPT_WO:
        ok = r->has_wo = cli_direction(&r->plot.wo, arg, &err);
        break;
    case OPT_SAMPLES:
        ok = cli_count(&r->plot.samples, "--samples", arg, 1000, 1000000000,
                       &err);
        break;
    case OPT_SEED:
        ok = cli_count(&r->plot.seed, "--seed", arg, 0, INT64_MAX, &err);
        break;
    case 'o':
        r->plot.output = arg;
        break;
    case ARGP_KEY_ARG:
        if (r->args == 2)
            ok = err_set(&err, "\"%.200s\" is one argument too many", arg);
        else
            r->arg[r->args++] = arg;
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    if (!ok)
        argp_failure(state, EXIT_REQUEST, 0, "%s", err.text);
    return 0;
}

/* Puts the kinds before the rest of the help. */
static char *help(int key, const char *text, void *input)
{
    (void)input;
    if (key != ARGP_KEY_HELP_POST_DOC)
        return (char *)text;
    char *all = NULL;
    size_t size;
    FILE *out = open_memstream(&all, &size);
    if (!out)
        return (char *)text;
    fputs("Kinds:\n", out);
    for (int i = 0; plots[i]; i++)
        fprintf(out, "  %-10s %s\n", plots[i]->name, plots[i]->about);
    fprintf(out, "\n%s", text);
    fclose(out);
    return all;
}

/* NULL and the reason if there is no such kind. */
static const struct plot *kind(const char *name, struct err *err)
{
    const char *names[16] = { NULL };
    char list[256] = "";
    for (int i = 0; plots[i] && i < 15; i++) {
        if (strcmp(plots[i]->name, name) == 0)
            return plots[i];
        names[i] = plots[i]->name;
        const size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "",
                 names[i]);
    }
    const char *near = err_nearest(name, names);
    if (near)
        err_set(err, "kind \"%.60s\" is unknown: did you mean \"%s\"?", name,
                near);
    else
        err_set(err, "kind \"%.60s\" is unknown; there is: %s", name, list);
    return NULL;
}

static void warn(const struct err *err)
{
    if (err->text[0])
        fprintf(stderr, "bsdf-plot: warning: %s\n", err->text);
}

/* False and the first trouble that a model of another program was in, in any
 * thread that drew. */
static bool answered(const struct bsdf *b, struct err *err)
{
    bool good = true;
#pragma omp parallel
    {
        struct err what;
        if (bsdf_trouble(b, &what)) {
#pragma omp critical(plots_answered)
            good = err_set(err, "%s", what.text);
        }
    }
    return good;
}

/* Makes the model, if the plot is of one, and draws. */
static bool draw_of(const struct plot *plot, struct request *r,
                    struct figure_made *made, struct err *err)
{
    if (plot->subject != PLOT_MODEL) {
        *(plot->subject == PLOT_RUN ? &r->plot.file : &r->plot.pages) =
            r->arg[1];
        return plot->run(&r->plot, made, err);
    }
    struct bsdf *b = foreign_new(r->arg[1], &r->plot.bands, err);
    if (!b)
        return false;
    warn(err);
    err->text[0] = '\0';
    r->plot.bsdf = b;
    const bool ok = plot->run(&r->plot, made, err) && answered(b, err);
    bsdf_free(b);
    return ok;
}

static bool draw(struct request *r, struct figure_made *made, struct err *err)
{
    static char name[64]; /* the request keeps it */
    const struct plot *plot = r->args > 0 ? kind(r->arg[0], err) : NULL;
    if (r->args == 0)
        return err_set(err, "expected a kind of plot and a SPEC, as in lobe "
                            "roughconductor:material=Ca --wo 45,0");
    if (!plot)
        return false;
    const bool model = plot->subject == PLOT_MODEL;
    if (r->args == 1)
        return err_set(err, "%s: expected %s", plot->name,
                       model                       ? "a SPEC"
                       : plot->subject == PLOT_RUN ? "a FILE of bsdf-validate "
                                                     "--json"
                                                   : "a NAME, or several: "
                                                     "NAME,NAME");
    if (model && !r->has_wo)
        return err_set(err, "%s: expected --wo THETA,PHI in degrees",
                       plot->name);
    snprintf(name, sizeof name, "%s%s", plot->name,
             plot->extension ? plot->extension : ".svg");
    if (!r->plot.output)
        r->plot.output = name;
    return draw_of(plot, r, made, err);
}

int main(int argc, char **argv)
{
    struct request r = {
        .plot = { .bands = bands_default, .seed = 1, .samples = 1000000 }
    };
    struct figure_made made = { .paths = 0 };
    struct err err = { "" };
    gsl_set_error_handler_off();
    argp_err_exit_status = EXIT_REQUEST;
    argp_parse(&(struct argp){ options, option,
                               "KIND SPEC\nKIND NAME[,NAME...]\nreport FILE",
                               about, 0, help, 0 },
               argc, argv, 0, NULL, &r);
    bool ok = draw(&r, &made, &err);
    for (int i = 0; i < made.paths; i++)
        puts(made.path[i]);
    fputs(made.said, stderr);
    if (ok)
        warn(&err);
    else
        fprintf(stderr, "bsdf-plot: %s\n", err.text);
    figure_made_clear(&made);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "bsdf-plot: standard output: %s\n", strerror(errno));
        ok = false;
    }
    return ok ? EXIT_SOUND : EXIT_REQUEST;
}
