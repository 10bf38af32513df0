/* main.c - bsdf-info: what models and materials there are, and their values */
#include <argp.h>
#include <errno.h>
#include <gsl/gsl_errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/bsdf.h"
#include "bsdf/cli.h"
#include "bsdf/ior.h"
#include "bsdf/rng.h"

enum { OPT_NM = 1, OPT_IOR_PATH, OPT_WO, OPT_SEED };

struct request {
    struct bands bands;
    struct vec3 wo;
    bool has_wo;
    uint64_t count, seed;
    const char *arg[3]; /* the command and its arguments */
    int args;
};

const char *argp_program_version = "bsdf-info " BSDF_VERSION;
static const char about[] =
    "Lists scattering models, evaluates and samples them, looks up optical "
    "constants."
    "\vCommands:\n"
    "  list               the models, their keys, the materials\n"
    "  eval SPEC [FILE]   reads lines \"theta_o phi_o theta_i phi_i\" [deg] "
    "from "
    "FILE or standard input, appends f [1/sr] per band and pdf [1/sr]\n"
    "  sample SPEC --wo THETA,PHI [-n N] [--seed S]   draws directions\n"
    "  ior NAME [--nm A,B,C]   optical constants, as in Ca, Ca/Mathewson or a "
    "file.yml\n\n"
    "A SPEC is name or name:key=value,key=a/b/c; a value may be in single "
    "quotes.  Output is tab-separated, with comments after #.  Exit status: 0, "
    "or 2 if the request was wrong.";

static const struct argp_option options[] = {
    { "nm", OPT_NM, "A,B,C", 0,
      "the bands, one to four wavelengths; "
      "614,549,466",
      0 },
    { "ior-path", OPT_IOR_PATH, "DIR", 0,
      "a refractiveindex.info database "
      "(or BSDF_IOR_PATH)",
      0 },
    { "wo", OPT_WO, "THETA,PHI", 0, "outgoing direction [deg]", 0 },
    { "count", 'n', "N", 0, "how many samples, 1 to 1e12; 10", 0 },
    { "seed", OPT_SEED, "S", 0, "of the random numbers; 1", 0 },
    { 0 },
};

static error_t option(int key, char *arg, struct argp_state *state)
{
    struct request *r = state->input;
    struct err err;
    bool ok = true;
    switch (key) {
    case OPT_NM:
        ok = bands_parse(&r->bands, arg, &err);
        break;
    case OPT_IOR_PATH:
        ok = cli_ior_path(arg, &err);
        break;
    case OPT_WO:
        ok = r->has_wo = cli_direction(&r->wo, arg, &err);
        break;
    case 'n':
        ok = cli_count(&r->count, "-n", arg, 1, 1000000000000, &err);
        break;
    case OPT_SEED:
        ok = cli_count(&r->seed, "--seed", arg, 0, INT64_MAX, &err);
        break;
    case ARGP_KEY_ARG:
        if (r->args == 3)
            ok = err_set(&err, "\"%s\" is one argument too many", arg);
        else
            r->arg[r->args++] = arg;
        break;
    case ARGP_KEY_END:
        if (r->args == 0)
            ok = err_set(&err, "expected a command: list, eval, sample or ior");
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    if (!ok)
        argp_failure(state, EXIT_REQUEST, 0, "%s", err.text);
    return 0;
}

static void bands_comment(const struct bands *bands)
{
    char text[96];
    bands_print(bands, text, sizeof text);
    printf("# bands: %s\n", text);
}

static void param_print(const struct bsdf_param *p)
{
    printf("    %-22s ", p->key);
    switch (p->kind) {
    case BSDF_NUMBER:
        printf("number in [%g, %g]", p->min, p->max);
        break;
    case BSDF_SPECTRUM:
        printf("one value, or one a band, in [%g, %g]", p->min, p->max);
        break;
    case BSDF_CHOICE:
        for (int i = 0; p->choices[i]; i++)
            printf("%s%s", i ? " | " : "", p->choices[i]);
        break;
    case BSDF_FLAG:
        printf("true | false");
        break;
    case BSDF_STRING:
        printf("name or path");
        break;
    case BSDF_NESTED:
        printf("a spec in parentheses");
        break;
    }
    printf("%s%s\n    %-22s %s\n", p->def ? "; default " : "",
           p->def ? p->def : "", "", p->about);
}

static void material_print(void *context, const char *name)
{
    (void)context;
    printf("    %s\n", name);
}

static bool list(const struct request *r, struct err *err)
{
    (void)r;
    printf("models\n");
    for (int i = 0; bsdf_types[i]; i++) {
        printf("  %s: %s\n", bsdf_types[i]->name, bsdf_types[i]->about);
        for (const struct bsdf_param *p = bsdf_types[i]->params; p->key; p++)
            param_print(p);
    }
    printf("materials\n");
    return ior_list(material_print, NULL, err);
}

/* Four numbers in one line; the reason without the place otherwise. */
static bool angles_read(const char *line, double angle[4], struct err *err)
{
    static const char *const name[] = { "theta_o", "phi_o", "theta_i",
                                        "phi_i" };
    for (int i = 0; i < 4; i++) {
        char *end;
        line += strspn(line, " \t\r\n");
        angle[i] = strtod(line, &end);
        const size_t length = strcspn(line, " \t\r\n");
        if (length == 0)
            return err_set(err,
                           "%s is missing; expected theta_o phi_o "
                           "theta_i phi_i in degrees",
                           name[i]);
        if (end != line + length || !isfinite(angle[i]))
            return err_set(err,
                           "%s = \"%.*s\": expected a finite number of "
                           "degrees",
                           name[i], (int)(length < 40 ? length : 40), line);
        if (i % 2 == 0 && !(angle[i] >= 0 && angle[i] <= 180))
            return err_set(err, "%s = %g: expected a value in [0, 180] degrees",
                           name[i], angle[i]);
        line = end;
    }
    line += strspn(line, " \t\r\n");
    return *line == '\0' ||
           err_set(err, "\"%.40s\" after phi_i: expected four numbers", line);
}

static void numbers_print(const double *x, int n, char last)
{
    for (int i = 0; i < n; i++)
        printf("%.17g%c", x[i], i + 1 < n ? '\t' : last);
}

static bool eval_lines(const struct bsdf *b, FILE *in, const char *name,
                       struct err *err)
{
    char line[1024];
    const int bands = bsdf_bands(b)->count;
    for (unsigned long long at = 1; fgets(line, sizeof line, in); at++) {
        double angle[4] = { 0 };
        struct err why;
        const size_t length = strlen(line);
        if (length == 0 ||
            (line[length - 1] != '\n' && !feof(in) && length + 1 < sizeof line))
            return err_set(err, "%s:%llu: a zero byte; expected text", name,
                           at);
        if (length + 1 == sizeof line && line[length - 1] != '\n')
            return err_set(err,
                           "%s:%llu: the line is longer than %zu "
                           "characters",
                           name, at, sizeof line - 2);
        const char *first = line + strspn(line, " \t\r\n");
        if (*first == '\0')
            continue;
        if (*first == '#') {
            fputs(line, stdout);
            continue;
        }
        if (!angles_read(line, angle, &why))
            return err_set(err, "%s:%llu: %s", name, at, why.text);
        const struct vec3 wo = dir_from_degrees(angle[0], angle[1]);
        const struct vec3 wi = dir_from_degrees(angle[2], angle[3]);
        const struct spectrum f = bsdf_eval(b, wo, wi);
        const double pdf = bsdf_pdf(b, wo, wi);
        numbers_print(angle, 4, '\t');
        numbers_print(f.band, bands, '\t');
        numbers_print(&pdf, 1, '\n');
    }
    return !ferror(in) || err_set(err, "%s: %s", name, strerror(errno));
}

static bool eval(const struct request *r, struct err *err)
{
    if (r->args < 2)
        return err_set(err, "eval: expected a SPEC");
    struct bsdf *b = bsdf_new(r->arg[1], &r->bands, err);
    if (!b)
        return false;
    const bool from_file = r->args == 3 && strcmp(r->arg[2], "-") != 0;
    FILE *in = from_file ? fopen(r->arg[2], "r") : stdin;
    bool ok = in || err_set(err, "%s: %s", r->arg[2], strerror(errno));
    if (ok) {
        printf("# %s\n", bsdf_spec(b));
        bands_comment(&r->bands);
        printf("# theta_o\tphi_o\ttheta_i\tphi_i [deg]\tf [1/sr] per band\t"
               "pdf [1/sr]\n");
        ok = eval_lines(b, in, from_file ? r->arg[2] : "standard input", err);
    }
    if (from_file && in)
        fclose(in);
    bsdf_free(b);
    return ok;
}

static bool sample(const struct request *r, struct err *err)
{
    if (r->args != 2)
        return err_set(err, "sample: expected one SPEC");
    if (!r->has_wo)
        return err_set(err, "sample: expected --wo THETA,PHI in degrees");
    struct bsdf *b = bsdf_new(r->arg[1], &r->bands, err);
    if (!b)
        return false;
    const struct rng rng = { r->seed, 0 };
    printf("# %s\n", bsdf_spec(b));
    bands_comment(&r->bands);
    printf("# seed: %" PRIu64 "; a row of zeros is a refused sample\n",
           r->seed);
    printf("# wi.x\twi.y\twi.z\tpdf [1/sr]\tweight per band\tdelta\n");
    for (uint64_t i = 0; i < r->count && !ferror(stdout); i++) {
        const struct bsdf_sample s = bsdf_sample(b, r->wo, rng_uniform(rng, i));
        const double row[4] = { s.wi.x, s.wi.y, s.wi.z, s.pdf };
        numbers_print(row, 4, '\t');
        numbers_print(s.weight.band, r->bands.count, '\t');
        printf("%d\n", s.delta);
    }
    bsdf_free(b);
    return true;
}

/* Text of several lines as comments. */
static void comment(const char *what, const char *text)
{
    while (*text) {
        const size_t length = strcspn(text, "\n");
        printf("# %s: %.*s\n", what, (int)length, text);
        text += length + (text[length] == '\n');
    }
}

static bool ior(const struct request *r, struct err *err)
{
    if (r->args != 2)
        return err_set(err, "ior: expected one NAME, as in Ca");
    struct ior_page *page = ior_find(r->arg[1], NULL, err);
    if (!page)
        return false;
    double low, high, n[BANDS_MAX], k[BANDS_MAX];
    bool ok = true;
    for (int b = 0; b < r->bands.count && ok; b++)
        ok = ior_page_at(page, r->bands.nm[b], &n[b], &k[b], err);
    if (ok) {
        ior_page_range(page, &low, &high);
        comment("source", ior_page_path(page));
        comment("citation", ior_page_reference(page));
        comment("comments", ior_page_comments(page));
        for (const char *const *w = ior_page_warnings(page); *w; w++)
            comment("warning", *w);
        printf("# range: %.10g to %.10g nm, linear between rows%s\n", low, high,
               ior_page_has_k(page) ? "" : "; no k, taken as 0");
        printf("# nm\tn\tk\n");
        for (int b = 0; b < r->bands.count; b++) {
            const double row[3] = { r->bands.nm[b], n[b], k[b] };
            numbers_print(row, 3, '\n');
        }
    }
    ior_page_free(page);
    return ok;
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        bool (*run)(const struct request *r, struct err *err);
    } command[] = {
        { "list", list }, { "eval", eval }, { "sample", sample }, { "ior", ior }
    };
    enum { COMMANDS = sizeof command / sizeof *command };
    static const char *const names[] = { "list", "eval", "sample", "ior",
                                         NULL };
    struct request r = { .bands = bands_default, .count = 10, .seed = 1 };
    struct err err;
    gsl_set_error_handler_off();
    argp_err_exit_status = EXIT_REQUEST;
    argp_parse(&(struct argp){ options, option, "COMMAND [ARGUMENT...]", about,
                               0, 0, 0 },
               argc, argv, 0, NULL, &r);
    int i = 0;
    while (i < COMMANDS && strcmp(command[i].name, r.arg[0]) != 0)
        i++;
    bool ok;
    if (i < COMMANDS) {
        ok = command[i].run(&r, &err);
    } else {
        const char *near = err_nearest(r.arg[0], names);
        ok = err_set(&err,
                     "command \"%.60s\" is unknown%s%s%s; expected list, "
                     "eval, sample or ior",
                     r.arg[0], near ? ": did you mean \"" : "",
                     near ? near : "", near ? "\"?" : "");
    }
    if (!ok)
        fprintf(stderr, "bsdf-info: %s\n", err.text);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "bsdf-info: standard output: %s\n", strerror(errno));
        ok = false;
    }
    return ok ? EXIT_SOUND : EXIT_REQUEST;
}
