/* main.c - bsdf-render: pictures of scenes, and whether two are the same */
#include <argp.h>
#include <errno.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bsdf/cli.h"
#include "integrator/camera_file.h"
#include "integrator/compare.h"
#include "integrator/compare_png.h"
#include "integrator/compat.h"
#include "integrator/environment.h"
#include "integrator/load.h"
#include "integrator/measure.h"
#include "integrator/output.h"
#include "integrator/render.h"
#include "integrator/trace.h"

enum {
    OPT_ONLY = 1,
    OPT_SAMPLING,
    OPT_DIRECT,
    OPT_RR_DEPTH,
    OPT_RR_PROBABILITY,
    OPT_SAMPLER,
    OPT_COMPAT,
    OPT_LENIENT,
    OPT_ROBUST,
    OPT_EXPOSURE,
    OPT_QUIET,
    OPT_COMPARE,
    OPT_MEASURE,
    OPT_NUMBERS,
    OPT_MAP,
    OPT_BLOCK,
    OPT_SIGNIFICANCE
};

enum { FILES_MAX = 16 };

struct request {
    struct render_settings render;
    struct load_options load;
    struct cli_shared shared;
    bool has_samples, has_depth, has_rr_depth, only_last, robust, quiet;
    double lens_radius, focal_distance; /* NaN for the scene's */
    const char *camera, *environment;
    const char *output[FILES_MAX];
    int outputs;
    double exposure;
    const char *arg[2];
    int args;
    bool compare, measure, numbers;
    struct compare_options comparing;
    const char *map;
};

const char *argp_program_version = "bsdf-render " BSDF_VERSION;
static const char about[] =
    "Renders a scene by path tracing, compares two pictures, measures one."
    "\vA SCENE is Mitsuba 3's XML or a course's COLLADA (.dae, .dae.xz).  "
    "Depth counts bounces: 0 is what emits, 1 direct light.  An EXR holds "
    "means, variances, numbers of samples, depth, normals and albedo.  Exit "
    "status: 0; 1 when pictures differ, or samples were no numbers; 2 if the "
    "request was wrong.";

static const struct argp_option options[] = {
    { 0, 0, 0, 0, "Picture:", 1 },
    { "samples", 's', "N", 0, "a pixel; the scene's, or 1", 0 },
    { "depth", 'm', "M", 0, "bounces at most; the scene's, or 1", 0 },
    { "resolution", 'r', "W H", 0, "pixels, two arguments; the scene's", 0 },
    { "file", 'f', "FILE", 0,
      "to write, .png or .exr, may be repeated; the scene's name with .png",
      0 },
    { "cell", 'p', "X Y DX DY", 0, "render this part alone, four arguments",
      0 },
    { "exposure", OPT_EXPOSURE, "F", 0, "factor for the PNG; 1", 0 },
    { "sampler", OPT_SAMPLER, "KIND", 0,
      "independent (if not given), or ldsampler: less noise, and standard "
      "errors "
      "that are mostly too large",
      0 },
    { "threads", 't', "N", 0,
      "as many as there are, if not given; the picture does not depend on it",
      0 },
    { "quiet", OPT_QUIET, 0, 0, "no progress and no summary", 0 },
    { 0, 0, 0, 0, "Transport:", 2 },
    { "light-samples", 'l', "N", 0, "for each light; 1", 0 },
    { "direct", OPT_DIRECT, "HOW", 0,
      "direct light by mis (if not given), light, bsdf or hemisphere", 0 },
    { "hemisphere", 'H', 0, 0, "the same as --direct hemisphere", 0 },
    { "sampling", OPT_SAMPLING, "HOW", 0,
      "paths go on by bsdf (if not given), cosine or uniform", 0 },
    { "accumulate", 'o', "0|1", 0, "0: only paths of the full depth", 0 },
    { "only-bounce", OPT_ONLY, "N", 0, "only paths of so many bounces", 0 },
    { "rr-depth", OPT_RR_DEPTH, "N", 0,
      "bounces before Russian roulette; the scene's, or 5", 0 },
    { "rr-probability", OPT_RR_PROBABILITY, "P", 0,
      "to go on, in (0, 1]; by the weight of the path, if not given", 0 },
    { "adaptive", 'a', "BATCH TOL", 0,
      "two arguments: after every BATCH samples a pixel is done whose 95 % "
      "interval is within TOL of its mean, which is biased by that; a PNG gets "
      "a rate map beside it",
      0 },
    { 0, 0, 0, 0, "Scene:", 3 },
    { "define", 'D', "NAME=VALUE", 0, "for $NAME in the file", 0 },
    { "lenient", OPT_LENIENT, 0, 0, "warn of what is unknown and go on", 0 },
    { "robust", OPT_ROBUST, 0, 0,
      "no ray slips between two triangles that share an edge; slower, and the "
      "scene's own choice if not given",
      0 },
    { "compat", OPT_COMPAT, "LIST", 0,
      "a course's ways: course for all, or some of camera, tone, light-pdf, "
      "light-quad, schlick, lambda, fresnel, refraction",
      0 },
    { "lens-radius", 'b', "R", 0, "of the camera; 0", 0 },
    { "focal-distance", 'd', "D", 0, "of what is sharp", 0 },
    { "camera", 'c', "FILE", 0, "a camera as the course's program saves it",
      0 },
    { "environment", 'e', "FILE", 0,
      "an EXR that surrounds the scene, latitude by longitude", 0 },
    { 0, 0, 0, 0, "Comparison:", 5 },
    { "compare", OPT_COMPARE, 0, 0,
      "two EXRs: are they estimates of one picture?  Two PNGs: how alike are "
      "their blocks?",
      0 },
    { "measure", OPT_MEASURE, 0, 0,
      "an EXR, or of it the part -p: mean, noise, samples, as lines of a name "
      "and a number",
      0 },
    { "numbers", OPT_NUMBERS, 0, 0,
      "of a comparison of two EXRs, as such lines too", 0 },
    { "map", OPT_MAP, "FILE.png", 0, "of the differences in standard errors",
      0 },
    { "block", OPT_BLOCK, "N", 0, "side of a block in pixels; 20", 0 },
    { "significance", OPT_SIGNIFICANCE, "A", 0,
      "chance that two estimates of one picture differ; 1e-6", 0 },
    { 0 },
};

/* -- options ----------------------------------------------------------------
 */

/* The next argument of an option that takes several. */
static const char *another(struct argp_state *state, const char *what,
                           struct err *err)
{
    if (state->next < state->argc)
        return state->argv[state->next++];
    err_set(err, "%s: an argument is missing", what);
    return NULL;
}

static bool whole(int *n, const char *what, const char *text, int min, int max,
                  struct err *err)
{
    uint64_t value = 0;
    const bool ok = text && cli_count(&value, what, text, (uint64_t)min,
                                      (uint64_t)max, err);
    if (ok)
        *n = (int)value;
    return ok;
}

static bool word(int *choice, const char *what, const char *text,
                 const char *const words[], struct err *err)
{
    for (int i = 0; words[i]; i++)
        if (strcmp(words[i], text) == 0) {
            *choice = i;
            return true;
        }
    return err_unknown(err, what, text, words);
}

static bool resolution(struct request *r, struct argp_state *state,
                       const char *text, struct err *err)
{
    return whole(&r->load.width, "-r W", text, 1, 65535, err) &&
           whole(&r->load.height, "-r H", another(state, "-r W H", err), 1,
                 65535, err);
}

static bool cell(struct request *r, struct argp_state *state, const char *text,
                 struct err *err)
{
    static const char what[] = "-p X Y DX DY";
    struct render_settings *p = &r->render;
    return whole(&p->x, "-p X", text, 0, 65534, err) &&
           whole(&p->y, "-p Y", another(state, what, err), 0, 65534, err) &&
           whole(&p->width, "-p DX", another(state, what, err), 1, 65535,
                 err) &&
           whole(&p->height, "-p DY", another(state, what, err), 1, 65535, err);
}

static bool adaptive(struct request *r, struct argp_state *state,
                     const char *text, struct err *err)
{
    if (!cli_count(&r->render.batch, "-a BATCH", text, 2, 1 << 30, err))
        return false;
    const char *second = another(state, "-a BATCH TOL", err);
    return second &&
           cli_number(&r->render.tolerance, "-a TOL", second, 1e-9, 1e6, err);
}

static bool transport(struct request *r, int key, const char *arg,
                      struct err *err)
{
    static const char *const directs[] = { "mis", "light", "bsdf", "hemisphere",
                                           NULL };
    static const char *const samplings[] = { "bsdf", "cosine", "uniform",
                                             NULL };
    struct path_settings *p = &r->render.path;
    int choice = 0;
    bool ok = true;
    switch (key) {
    case 'm':
        r->has_depth = true;
        return whole(&p->max_depth, "-m", arg, 0, PATH_DEPTH_MAX, err);
    case 'l':
        return whole(&p->light_samples, "-l", arg, 1, PATH_LIGHT_SAMPLES_MAX,
                     err);
    case 'H':
        p->direct = PATH_HEMISPHERE;
        return true;
    case 'o':
        ok = whole(&choice, "-o", arg, 0, 1, err);
        r->only_last = choice == 0;
        return ok;
    case OPT_ONLY:
        return whole(&p->only_bounce, "--only-bounce", arg, 0, PATH_DEPTH_MAX,
                     err);
    case OPT_DIRECT:
        ok = word(&choice, "--direct", arg, directs, err);
        p->direct = (enum path_direct)choice;
        return ok;
    case OPT_SAMPLING:
        ok = word(&choice, "--sampling", arg, samplings, err);
        p->sampling = (enum path_sampling)choice;
        return ok;
    case OPT_RR_DEPTH:
        r->has_rr_depth = true;
        return whole(&p->rr_depth, "--rr-depth", arg, 0, PATH_DEPTH_MAX, err);
    case OPT_RR_PROBABILITY:
        return cli_number(&p->rr_probability, "--rr-probability", arg, 1e-3, 1,
                          err);
    default:
        return false;
    }
}

static bool define(struct request *r, const char *arg, struct err *err)
{
    const char *equals = strchr(arg, '=');
    if (!equals || equals == arg)
        return err_set(err, "-D %.80s: expected NAME=VALUE", arg);
    if (r->load.defines == LOAD_DEFINES_MAX)
        return err_set(err, "-D: more than %d of them", LOAD_DEFINES_MAX);
    r->load.define[r->load.defines++] = arg;
    return true;
}

static bool other(struct request *r, int key, char *arg,
                  struct argp_state *state, struct err *err)
{
    static const char *const samplers[] = { "independent", "ldsampler", NULL };
    int choice = 0;
    switch (key) {
    case 's':
        r->has_samples = true;
        return cli_count(&r->render.samples, "-s", arg, 1, UINT32_MAX, err);
    case 'r':
        return resolution(r, state, arg, err);
    case 'p':
        return cell(r, state, arg, err);
    case 'a':
        return adaptive(r, state, arg, err);
    case 'f':
        if (r->outputs == FILES_MAX)
            return err_set(err, "-f: more than %d files", FILES_MAX);
        r->output[r->outputs++] = arg;
        return output_check(arg, err);
    case 't':
        return whole(&r->render.threads, "-t", arg, 1, 1024, err);
    case 'b':
        return cli_number(&r->lens_radius, "-b", arg, 0, 1e9, err);
    case 'd':
        return cli_number(&r->focal_distance, "-d", arg, 1e-9, 1e9, err);
    case 'c':
        r->camera = arg;
        return true;
    case 'e':
        r->environment = arg;
        return true;
    case 'D':
        return define(r, arg, err);
    case OPT_SAMPLER:
        if (!word(&choice, "--sampler", arg, samplers, err))
            return false;
        r->render.sampler = (enum sampler_kind)choice;
        return true;
    case OPT_EXPOSURE:
        return cli_number(&r->exposure, "--exposure", arg, 1e-9, 1e9, err);
    case OPT_COMPAT:
        return compat_parse(&r->load.compat, arg, err);
    case OPT_BLOCK:
        return whole(&r->comparing.block, "--block", arg, 1, 65535, err);
    case OPT_SIGNIFICANCE:
        return cli_number(&r->comparing.significance, "--significance", arg,
                          1e-300, 0.5, err);
    default:
        return err_set(err, "unknown option");
    }
}

/* What all options say together. */
static bool agree(struct request *r, struct err *err)
{
    r->render.seed = r->shared.seed;
    if (r->compare && r->measure)
        return err_set(err, "--measure: not with --compare");
    if ((r->compare || r->measure) && r->outputs > 0)
        return err_set(err, "-f %.200s: nothing is rendered with --%s",
                       r->output[0], r->compare ? "compare" : "measure");
    if (r->map && !output_is_png(r->map))
        return err_set(err, "--map %.200s: expected a name that ends in .png",
                       r->map);
    return r->shared.bands.count == 3 ||
           err_set(err,
                   "--nm: %d wavelengths: expected three, for a picture's "
                   "red, green and blue",
                   r->shared.bands.count);
}

static error_t option(int key, char *arg, struct argp_state *state)
{
    struct request *r = state->input;
    struct err err;
    bool ok = true;
    switch (key) {
    case ARGP_KEY_ARG:
        if (r->args == 2)
            ok = err_set(&err, "\"%.200s\" is one argument too many", arg);
        else
            r->arg[r->args++] = arg;
        break;
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &r->shared;
        break;
    case ARGP_KEY_END:
        ok = agree(r, &err);
        break;
    case ARGP_KEY_FINI:
    case ARGP_KEY_SUCCESS:
    case ARGP_KEY_ERROR:
    case ARGP_KEY_NO_ARGS:
    case ARGP_KEY_ARGS:
        return ARGP_ERR_UNKNOWN;
    case OPT_LENIENT:
        r->load.lenient = true;
        break;
    case OPT_ROBUST:
        r->robust = true;
        break;
    case OPT_QUIET:
        r->quiet = true;
        break;
    case OPT_COMPARE:
        r->compare = true;
        break;
    case OPT_MEASURE:
        r->measure = true;
        break;
    case OPT_NUMBERS:
        r->numbers = true;
        break;
    case OPT_MAP:
        r->map = arg;
        break;
    case 'm':
    case 'l':
    case 'H':
    case 'o':
    case OPT_ONLY:
    case OPT_DIRECT:
    case OPT_SAMPLING:
    case OPT_RR_DEPTH:
    case OPT_RR_PROBABILITY:
        ok = transport(r, key, arg, &err);
        break;
    default:
        ok = other(r, key, arg, state, &err);
    }
    if (!ok)
        argp_failure(state, EXIT_REQUEST, 0, "%s", err.text);
    return 0;
}

/* -- rendering --------------------------------------------------------------
 */

static volatile sig_atomic_t stop;

static void stop_soon(int signal)
{
    (void)signal;
    stop = 1;
}

static void warn(const char *text, void *context)
{
    (void)context;
    fprintf(stderr, "bsdf-render: warning: %s\n", text);
}

/* Puts the picture -e around the scene. */
static bool surround(const struct request *r, struct scene *s, struct err *err)
{
    struct film *f = film_read_exr(r->environment, err);
    struct light light = { .kind = LIGHT_ENVIRONMENT };
    light.environment = f ? environment_new(f, r->environment, err) : NULL;
    film_free(f);
    if (!light.environment)
        return false;
    const bool ok = scene_add_light(s, &light, err);
    if (!ok)
        environment_free(light.environment);
    return ok;
}

/* Fills in what the command line left to the scene, and the reverse. */
static bool settle(struct request *r, struct scene *s, struct err *err)
{
    struct scene_wishes w = scene_wishes(s);
    struct path_settings *p = &r->render.path;
    if (!r->has_samples && w.samples > 0)
        r->render.samples = (uint64_t)w.samples;
    if (!r->has_depth && w.max_depth >= 0)
        p->max_depth = w.max_depth;
    if (!r->has_rr_depth && w.rr_depth >= 0)
        p->rr_depth = w.rr_depth;
    if (r->only_last && p->only_bounce >= 0)
        return err_set(err, "-o 0: not with --only-bounce %d", p->only_bounce);
    if (p->only_bounce > p->max_depth)
        return err_set(err, "--only-bounce %d: paths end after %d bounces, -m",
                       p->only_bounce, p->max_depth);
    if (r->only_last)
        p->only_bounce = p->max_depth;
    p->compat = r->load.compat;
    w.robust |= r->robust;
    scene_set_wishes(s, &w);
    struct camera c = *scene_camera(s);
    if (r->camera && !camera_file_read(&c, r->camera, err))
        return false;
    if (isfinite(r->lens_radius))
        c.lens_radius = r->lens_radius;
    if (isfinite(r->focal_distance))
        c.focal_distance = r->focal_distance;
    if (c.lens_radius > 0 && !(c.focal_distance > 0))
        return err_set(err,
                       "lens radius %g: a lens needs a focal distance above "
                       "0, -d",
                       c.lens_radius);
    scene_set_camera(s, &c);
    return !r->environment || surround(r, s, err);
}

static bool save(const struct request *r, const struct render_result *made,
                 const char *command, struct err *err)
{
    const struct output_settings how = {
        .render = &r->render,
        .scene = r->arg[0],
        .command = command,
        .tone = r->load.compat & COMPAT_TONE ? FILM_COURSE : FILM_SRGB,
        .exposure = r->exposure,
    };
    bool ok = true;
    for (int i = 0; ok && i < r->outputs; i++)
        ok = output_write(made, r->output[i], &how, err);
    for (int i = 0; ok && i < r->outputs; i++)
        puts(r->output[i]);
    return ok;
}

/* Far from the origin the scene's floats are coarse. */
static void warn_if_far(const struct request *r, const struct scene *s)
{
    struct vec3 lo, hi;
    char text[300];
    if (!scene_box(s, &lo, &hi))
        return;
    const double size = vec3_length(vec3_minus(hi, lo));
    const double off = trace_hair(fmax(vec3_largest(lo), vec3_largest(hi)));
    if (!(off > 0.01 * size))
        return;
    snprintf(text, sizeof text,
             "%.100s: it is %.3g across, but so far from the origin that rays "
             "start %.2g off surfaces, as a float knows no better: expected it "
             "nearer to the origin",
             r->arg[0], size, off);
    warn(text, NULL);
}

/* Loads, renders, writes; an exit status. */
static int draw(struct request *r, const char *command, struct err *err)
{
    struct scene *s = scene_load(r->arg[0], &r->shared.bands, &r->load, err);
    struct render_result made = { .film = NULL };
    char name[256];
    bool ok = s && (scene_camera(s) ||
                    err_set(err, "%s: it has no camera", r->arg[0]));
    ok = ok && settle(r, s, err) && scene_commit(s, err);
    if (ok)
        warn_if_far(r, s);
    if (ok && r->outputs == 0) {
        output_name(r->arg[0], name, sizeof name);
        r->output[r->outputs++] = name;
    }
    for (int i = 0; ok && i < r->outputs; i++)
        ok = output_can(r->output[i], err);
    if (ok) {
        const struct sigaction once = { .sa_handler = stop_soon,
                                        .sa_flags = (int)SA_RESETHAND };
        sigaction(SIGINT, &once, NULL);
        r->render.stop = &stop;
        r->render.progress = !r->quiet && isatty(STDERR_FILENO);
        ok = render(s, &r->render, &made, err);
    }
    if (ok && !r->quiet) {
        output_scene(stderr, r->arg[0], s);
        output_summary(stderr, &made, &r->render);
    }
    ok = ok && save(r, &made, command, err);
    if (ok && made.bad > 0)
        fprintf(stderr,
                "bsdf-render: %llu samples were no finite numbers and count "
                "as black; the first: pixel %d, %d, sample %llu\n",
                (unsigned long long)made.bad, made.first_bad.x,
                made.first_bad.y, (unsigned long long)made.first_bad.sample);
    film_free(made.film);
    scene_free(s);
    if (!ok)
        return EXIT_REQUEST;
    if (made.stopped)
        raise(SIGINT); /* whoever waits for us shall know */
    return made.bad > 0 ? EXIT_UNSOUND : EXIT_SOUND;
}

/* -- comparing --------------------------------------------------------------
 */

static int compare_pngs(const struct request *r, struct err *err)
{
    struct png_comparison c;
    if (r->map || r->numbers) {
        err_set(err, "--%s: of EXRs alone", r->map ? "map" : "numbers");
        return EXIT_REQUEST;
    }
    if (!compare_png(r->arg[0], r->arg[1], &r->comparing, &c, err))
        return EXIT_REQUEST;
    compare_png_print(stdout, &c);
    return EXIT_SOUND;
}

static int compare(const struct request *r, struct err *err)
{
    if (output_is_png(r->arg[0]) && output_is_png(r->arg[1]))
        return compare_pngs(r, err);
    struct film *a = film_read_exr(r->arg[0], err);
    struct film *b = a ? film_read_exr(r->arg[1], err) : NULL;
    struct film *map = NULL;
    struct comparison c = { .same = false };
    bool ok = a && b &&
              compare_films(a, b, &r->comparing, &c, r->map ? &map : NULL, err);
    if (ok)
        (r->numbers ? compare_print_numbers : compare_print)(stdout, &c);
    if (ok && r->map)
        ok = compare_write_map(map, r->map, err);
    if (ok && r->map && !r->numbers)
        puts(r->map);
    film_free(a);
    film_free(b);
    film_free(map);
    return !ok ? EXIT_REQUEST : c.same ? EXIT_SOUND : EXIT_UNSOUND;
}

static int measure(const struct request *r, struct err *err)
{
    const struct render_settings *p = &r->render;
    struct measure m;
    struct film *f = film_read_exr(r->arg[0], err);
    const bool ok =
        f && measure_film(f, p->x, p->y, p->width, p->height, &m, err);
    if (ok)
        measure_print(stdout, &m);
    film_free(f);
    return ok ? EXIT_SOUND : EXIT_REQUEST;
}

/* The command line, to be read by people. */
static char *command_of(int argc, char **argv)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    fputs("bsdf-render", out);
    for (int i = 1; i < argc; i++)
        fprintf(out, " %s", argv[i]);
    fclose(out);
    return text;
}

static int run(struct request *r, const char *command, struct err *err)
{
    if (r->compare && r->args != 2) {
        err_set(err, "--compare: expected two pictures");
        return EXIT_REQUEST;
    }
    if (r->compare)
        return compare(r, err);
    if (r->measure && r->args != 1) {
        err_set(err, "--measure: expected one picture, an EXR");
        return EXIT_REQUEST;
    }
    if (r->measure)
        return measure(r, err);
    if (r->args != 1) {
        err_set(err,
                r->args ? "\"%.200s\" is one argument too many"
                        : "expected a SCENE, as in "
                          "data/scenes/spheres.xml",
                r->arg[1]);
        return EXIT_REQUEST;
    }
    return draw(r, command, err);
}

int main(int argc, char **argv)
{
    struct request r = {
        .render = { .path = { .max_depth = 1,
                              .only_bounce = -1,
                              .light_samples = 1,
                              .rr_depth = 5 },
                    .samples = 1 },
        .shared = { .bands = bands_default, .seed = 1 },
        .load = { .warn = warn },
        .lens_radius = NAN,
        .focal_distance = NAN,
        .exposure = 1,
    };
    struct err err = { "" };
    char *command = command_of(argc, argv);
    gsl_set_error_handler_off();
    argp_err_exit_status = EXIT_REQUEST;
    const struct argp_child shared[] = {
        { &cli_shared_argp, 0, "Colours, random numbers:", 4 }, { 0 }
    };
    argp_parse(&(struct argp){ options, option,
                               "SCENE\n--compare A.exr B.exr\n--measure A.exr",
                               about, shared, 0, 0 },
               argc, argv, 0, NULL, &r);
    int status = run(&r, command ? command : "bsdf-render", &err);
    if (status == EXIT_REQUEST)
        fprintf(stderr, "bsdf-render: %s\n", err.text);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "bsdf-render: standard output: %s\n", strerror(errno));
        status = EXIT_REQUEST;
    }
    free(command);
    return status;
}
