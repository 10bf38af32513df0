/* main.c - bsdf-plot: pictures of scattering models */
#include <argp.h>
#include <errno.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/cli.h"
#include "plots/kinds.h"
#include "validate/foreign.h"

enum {
    OPT_WO = 1,
    OPT_SAMPLES,
    OPT_RANGE,
    OPT_PROGRAMS,
    OPT_PHI,
    OPT_LOG,
    OPT_ZOOM,
    OPT_WIDTH,
    OPT_STYLE,
    OPT_INTERACTIVE
};

struct request {
    struct plot_request plot;
    struct cli_shared shared;
    const char *arg[1 + PLOT_MODELS_MAX]; /* the kind, and specs or names */
    int args;
};

const char *argp_program_version = "bsdf-plot " BSDF_VERSION;
static const char about[] =
    "Draws scattering models, and the optical constants that they are made of."
    "\vBeside the picture lie its numbers (.tsv), the script that draws it "
    "again "
    "(.gp, for gnuplot) and a caption (.caption).  A .tex is for \\input in a "
    "document with the packages graphicx and color; what is no text in it lies "
    "in a .pdf of the same name.  A style FILE is gnuplot's commands, read "
    "before anything is drawn, such as `set linetype 1 lc rgb \"black\" dt 2`: "
    "1 to 8 are the curves, 9 is the only one, 10 a reference, 11 a grid; the "
    "palettes are the strings heat and sigma.  A SPEC is name or "
    "name:key=value,...; a NAME "
    "is a material like Ca, a page like Ca/Mathewson, or a file.  `bsdf-info "
    "list` names the models, their keys and the materials.  Exit status: 0, "
    "or 2 if the request was wrong or gnuplot failed.";

static const struct argp_option options[] = {
    { "wo", OPT_WO, "THETA,PHI", 0,
      "outgoing direction [deg]; a lobe takes several", 0 },
    { "phi", OPT_PHI, "DEG", 0,
      "azimuth of the cut of a lobe (of wo's mirror direction), of wo for an "
      "albedo (0), of the normals of an ndf (0); phi_d of a slice (90)",
      0 },
    { "log", OPT_LOG, 0, 0, "values in logarithms", 0 },
    { "zoom", OPT_ZOOM, "half|disk", 0,
      "a histogram over half vectors, or over the projected disk", 0 },
    { "output", 'o', "FILE", 0,
      "ends in .svg, .pdf, .png or .tex, for a report in .html, for a writeup "
      "in .html or .tex; KIND.svg if not given, or KIND-plot.svg where that "
      "would replace what is read",
      0 },
    { "width", OPT_WIDTH, "MM", 0,
      "of the picture, 40 to 2000; 211.67, which is 800 pixels of an SVG", 0 },
    { "style", OPT_STYLE, "FILE.gp", 0, "commands of gnuplot's, see below", 0 },
    { "interactive", OPT_INTERACTIVE, 0, 0,
      "show it in a window as well, if gnuplot has one", 0 },
    { "samples", OPT_SAMPLES, "N", 0,
      "drawn for a histogram, a convergence or an albedo, 1000 to 1e9; 1e6",
      0 },
    { "range", OPT_RANGE, "LO,HI", 0,
      "of wavelengths in nm; what there is from 360 to 830", 0 },
    { "programs", OPT_PROGRAMS, 0, 0,
      "a report may start the programs and plugins that its specs name", 0 },
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

/* The bits of the options that not every kind heeds. */
static const struct {
    const char *name;
    unsigned bit;
} heeded[] = { { "--wo", HEEDS_WO },
               { "--phi", HEEDS_PHI },
               { "--log", HEEDS_LOG },
               { "--zoom", HEEDS_ZOOM } };
enum { HEEDED = sizeof heeded / sizeof *heeded };

static bool direction_add(struct plot_request *r, const char *text,
                          struct err *err)
{
    if (r->wos == PLOT_DIRECTIONS_MAX)
        return err_set(err, "--wo \"%.80s\": expected at most %d of them", text,
                       PLOT_DIRECTIONS_MAX);
    return cli_direction(&r->wo[r->wos++], text, err);
}

static bool zoom_read(enum plot_zoom *zoom, const char *text, struct err *err)
{
    static const char *const names[] = { "half", "disk", NULL };
    for (int i = 0; names[i]; i++)
        if (strcmp(text, names[i]) == 0) {
            *zoom = i == 0 ? ZOOM_HALF : ZOOM_DISK;
            return true;
        }
    return err_unknown(err, "--zoom", text, names);
}

static error_t option(int key, char *arg, struct argp_state *state)
{
    struct request *r = state->input;
    struct err err;
    bool ok = true;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &r->shared;
        break;
    case OPT_RANGE:
        ok = range_read(&r->plot, arg, &err);
        break;
    case OPT_PROGRAMS:
        r->plot.programs = true;
        break;
    case OPT_WO:
        ok = direction_add(&r->plot, arg, &err);
        break;
    case OPT_PHI:
        ok = cli_number(&r->plot.phi_deg, "--phi", arg, -360, 360, &err);
        break;
    case OPT_LOG:
        r->plot.log = true;
        break;
    case OPT_ZOOM:
        ok = zoom_read(&r->plot.zoom, arg, &err);
        break;
    case OPT_WIDTH:
        ok = cli_number(&r->plot.look.width_mm, "--width", arg, 40, 2000, &err);
        break;
    case OPT_STYLE:
        r->plot.look.style = arg;
        break;
    case OPT_INTERACTIVE:
        r->plot.look.window = true;
        break;
    case OPT_SAMPLES:
        ok = cli_count(&r->plot.samples, "--samples", arg, 1000, 1000000000,
                       &err);
        break;
    case 'o':
        r->plot.output = arg;
        break;
    case ARGP_KEY_ARG:
        if (r->args == 1 + PLOT_MODELS_MAX)
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
        fprintf(out, "  %-12s %s\n", plots[i]->name, plots[i]->about);
    fprintf(out, "\n%s", text);
    fclose(out);
    return all;
}

/* NULL and the reason if there is no such kind. */
static const struct plot *kind(const char *name, struct err *err)
{
    const char *names[32] = { NULL };
    char list[256] = "";
    for (int i = 0; plots[i] && i < 31; i++) {
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

/* Makes the models, if the plot is of some, and draws. */
static bool draw_of(const struct plot *plot, struct request *r,
                    struct figure_made *made, struct err *err)
{
    struct plot_request *p = &r->plot;
    if (plot->subject != PLOT_MODEL) {
        *(plot->subject == PLOT_FILE ? &p->file : &p->pages) = r->arg[1];
        return plot->run(p, made, err);
    }
    struct bsdf *b[PLOT_MODELS_MAX] = { NULL };
    bool ok = true;
    for (int i = 1; ok && i < r->args; i++) {
        b[p->bsdfs] = foreign_new(r->arg[i], &p->bands, err);
        ok = b[p->bsdfs];
        if (ok) {
            warn(err);
            err->text[0] = '\0';
            p->bsdf[p->bsdfs] = b[p->bsdfs];
            p->bsdfs++;
        }
    }
    ok = ok && plot->run(p, made, err);
    for (int i = 0; i < p->bsdfs; i++) {
        ok = ok && answered(b[i], err);
        bsdf_free(b[i]);
    }
    return ok;
}

/* Whether a kind heeds what was asked of it. */
static bool fits(const struct plot *plot, const struct request *r,
                 struct err *err)
{
    const struct plot_request *p = &r->plot;
    const unsigned given = (p->wos > 0) * HEEDS_WO |
                           !isnan(p->phi_deg) * HEEDS_PHI | p->log * HEEDS_LOG |
                           (p->zoom != ZOOM_NONE) * HEEDS_ZOOM;
    const int most = plot->models ? plot->models : 1;
    const int least = plot->models_least ? plot->models_least : 1;
    const int directions = plot->directions ? plot->directions : 1;
    if (r->args - 1 < least)
        return err_set(
            err, "%s: expected %s%s", plot->name,
            plot->subject == PLOT_MODEL  ? least > 1 ? "two SPECs" : "a SPEC"
            : plot->subject == PLOT_FILE ? "a FILE of "
                                         : "a NAME, or several: NAME,NAME",
            plot->subject == PLOT_FILE ? plot->file : "");
    if (r->args - 1 > most)
        return err_set(err, "\"%.200s\" is one argument too many",
                       r->arg[1 + most]);
    if (plot->extension &&
        (p->look.width_mm > 0 || p->look.style || p->look.window))
        return err_set(err,
                       "%s: it makes no single picture; --width, --style and "
                       "--interactive are for those that do",
                       plot->name);
    for (int i = 0; i < HEEDED; i++) {
        if (!(given & ~plot->heeds & heeded[i].bit))
            continue;
        char list[256] = "";
        for (int k = 0; plots[k]; k++)
            if (plots[k]->heeds & heeded[i].bit)
                snprintf(list + strlen(list), sizeof list - strlen(list),
                         "%s%s", list[0] ? ", " : "", plots[k]->name);
        return err_set(err, "%s: it has no use for %s, which is for %s",
                       plot->name, heeded[i].name, list);
    }
    if (p->wos > directions)
        return err_set(err, "%s: expected one --wo", plot->name);
    return p->wos > 0 || !(plot->heeds & HEEDS_WO) || plot->any_wo ||
           err_set(err, "%s: expected --wo THETA,PHI in degrees", plot->name);
}

/* Whether an output would leave all that is read as it is: the file, the style,
 * and those that pages and specs name, which stand between such signs. */
static bool spares(const struct plot *plot, const struct request *r,
                   const char *output, struct err *err)
{
    const char *style = r->plot.look.style;
    bool ok = !style || figure_spares(output, plot->extension, style, err);
    for (int i = 1; ok && i < r->args; i++) {
        char *words = strdup(r->arg[i]), *rest = words;
        ok = figure_spares(output, plot->extension, r->arg[i], err);
        for (char *word; ok && (word = strsep(&rest, ":,='()"));)
            ok = figure_spares(output, plot->extension, word, err);
        free(words);
    }
    return ok;
}

/* KIND.svg, or KIND-plot.svg where that would replace what is read. */
static const char *default_output(const struct plot *plot,
                                  const struct request *r)
{
    static char name[64]; /* the request keeps it */
    const char *extension = plot->extension ? plot->extension : ".svg";
    snprintf(name, sizeof name, "%s%s", plot->name, extension);
    if (!spares(plot, r, name, NULL))
        snprintf(name, sizeof name, "%s-plot%s", plot->name, extension);
    return name;
}

static bool draw(struct request *r, struct figure_made *made, struct err *err)
{
    const struct plot *plot = r->args > 0 ? kind(r->arg[0], err) : NULL;
    if (r->args == 0)
        return err_set(err, "expected a kind of plot and a SPEC, as in lobe "
                            "roughconductor:material=Ca --wo 45,0");
    if (!plot || !fits(plot, r, err))
        return false;
    if (!r->plot.output)
        r->plot.output = default_output(plot, r);
    return spares(plot, r, r->plot.output, err) && draw_of(plot, r, made, err);
}

int main(int argc, char **argv)
{
    struct request r = { .plot = { .phi_deg = NAN, .samples = 1000000 },
                         .shared = { .bands = bands_default, .seed = 1 } };
    struct figure_made made = { .paths = 0 };
    struct err err = { "" };
    gsl_set_error_handler_off();
    argp_err_exit_status = EXIT_REQUEST;
    argp_parse(
        &(struct argp){
            options, option, "KIND SPEC...\nKIND NAME[,NAME...]\nKIND FILE",
            about,
            (const struct argp_child[]){ { &cli_shared_argp, 0, 0, 0 }, { 0 } },
            help, 0 },
        argc, argv, 0, NULL, &r);
    r.plot.bands = r.shared.bands;
    r.plot.seed = r.shared.seed;
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
