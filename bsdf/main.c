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
#include "bsdf/export.h"
#include "bsdf/ior.h"
#include "bsdf/rng.h"

enum {
    OPT_AS = 1,
    OPT_MATCH,
    OPT_WO,
};

struct request {
    struct cli_shared shared;
    struct vec3 wo;
    bool has_wo;
    int as; /* enum export_format, or -1 */
    const char *match;
    uint64_t count;     /* 0 where it was not given */
    const char *arg[3]; /* the command and its arguments */
    int args;
};

const char *argp_program_version = "bsdf-info " BSDF_VERSION;
static const char about[] =
    "Lists scattering models, evaluates and samples them, looks up optical "
    "constants."
    "\vCommands:\n"
    "  list                   the models, their keys, the materials\n"
    "  eval SPEC [FILE]       reads lines \"theta_o phi_o theta_i phi_i\" "
    "[deg]\n"
    "                         from FILE or standard input, appends f [1/sr] "
    "per\n"
    "                         band and pdf [1/sr]\n"
    "  sample SPEC            draws directions: --wo THETA,PHI [-n N] [--seed "
    "S]\n"
    "  albedo SPEC            share of the energy, and of the radiance, that\n"
    "                         samples carry: --wo THETA,PHI [-n N] [--seed S]\n"
    "  ior NAME [--nm A,B,C]  optical constants, as in Ca, Ca/Mathewson or a\n"
    "                         file.yml\n"
    "  ior NAME --rgb METHOD  its three pairs for R, G, B, and how far their\n"
    "                         colour is off; METHOD all compares\n"
    "  ior NAME --as FORMAT   the metal for mitsuba, pbrt, openpbr-f82 or cpp\n"
    "  ior --match ETA K      which page, at which wavelengths, A/B/C and "
    "D/E/F\n"
    "                         come from\n"
    "  cite NAME              BibTeX\n\n"
    "A SPEC is name or name:key=value,key=a/b/c; a value may be in single "
    "quotes.  Output is tab-separated, with comments after #.  Exit status: 0, "
    "or 2 if the request was wrong.";

static const struct argp_option options[] = {
    { "as", OPT_AS, "FORMAT", 0, "mitsuba, pbrt, openpbr-f82 or cpp", 0 },
    { "match", OPT_MATCH, "ETA", 0, "three values A/B/C, and K behind it", 0 },
    { "wo", OPT_WO, "THETA,PHI", 0, "outgoing direction [deg]", 0 },
    { "count", 'n', "N", 0,
      "how many samples, 1 to 1e12; 10, or 1e6 for an albedo", 0 },
    { 0 },
};

static error_t option(int key, char *arg, struct argp_state *state)
{
    struct request *r = state->input;
    struct err err;
    bool ok = true;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &r->shared;
        break;
    case OPT_AS:
        for (r->as = 0; export_names[r->as]; r->as++)
            if (strcmp(arg, export_names[r->as]) == 0)
                break;
        if (!export_names[r->as])
            ok = err_unknown(&err, "format", arg, export_names);
        break;
    case OPT_MATCH:
        r->match = arg;
        break;
    case OPT_WO:
        ok = r->has_wo = cli_direction(&r->wo, arg, &err);
        break;
    case 'n':
        ok = cli_count(&r->count, "-n", arg, 1, 1000000000000, &err);
        break;
    case ARGP_KEY_ARG:
        if (r->args == 3)
            ok = err_set(&err, "\"%s\" is one argument too many", arg);
        else
            r->arg[r->args++] = arg;
        break;
    case ARGP_KEY_END:
        if (r->args == 0)
            ok = err_set(
                &err, "expected a command: list, eval, sample, albedo, ior or "
                      "cite");
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

/* The model of a request; its warning, if any, goes to standard error. */
static struct bsdf *made(const struct request *r, struct err *err)
{
    if (r->shared.all) {
        err_set(err, "--rgb all compares optical constants: expected ior NAME");
        return NULL;
    }
    struct bsdf *b = bsdf_new(r->arg[1], &r->shared.bands, err);
    if (b && err->text[0])
        fprintf(stderr, "bsdf-info: warning: %s\n", err->text);
    return b;
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
    const size_t rest = strcspn(line, "\r\n");
    return rest == 0 ||
           err_set(err, "\"%.*s\" after phi_i: expected four numbers",
                   (int)(rest < 40 ? rest : 40), line);
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
    struct bsdf *b = made(r, err);
    if (!b)
        return false;
    const bool from_file = r->args == 3 && strcmp(r->arg[2], "-") != 0;
    FILE *in = from_file ? fopen(r->arg[2], "r") : stdin;
    bool ok = in || err_set(err, "%s: %s", r->arg[2], strerror(errno));
    if (ok) {
        printf("# %s\n", bsdf_spec(b));
        bands_comment(&r->shared.bands);
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
    struct bsdf *b = made(r, err);
    if (!b)
        return false;
    const struct rng rng = { r->shared.seed, 0 };
    printf("# %s\n", bsdf_spec(b));
    bands_comment(&r->shared.bands);
    printf("# seed: %" PRIu64 "; a row of zeros is a refused sample\n",
           r->shared.seed);
    printf("# wi.x\twi.y\twi.z\tpdf [1/sr]\tweight per band\tdelta\n");
    const uint64_t count = r->count ? r->count : 10;
    for (uint64_t i = 0; i < count && !ferror(stdout); i++) {
        const struct bsdf_sample s = bsdf_sample(b, r->wo, rng_uniform(rng, i));
        const double row[4] = { s.wi.x, s.wi.y, s.wi.z, s.pdf };
        numbers_print(row, 4, '\t');
        numbers_print(s.weight.band, r->shared.bands.count, '\t');
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

static void page_comments(const struct ior_page *page)
{
    double low, high;
    ior_page_range(page, &low, &high);
    comment("source", ior_page_path(page));
    comment("citation", ior_page_reference(page));
    comment("comments", ior_page_comments(page));
    for (const char *const *w = ior_page_warnings(page); *w; w++)
        comment("warning", *w);
    printf("# range: %.10g to %.10g nm, %s%s\n", low, high,
           ior_page_formula(page).number ? "by a formula"
                                         : "linear between rows",
           ior_page_has_k(page) ? "" : "; no k, taken as 0");
}

/* n and k at the wavelengths asked for; the three of the write-up if none. */
static bool constants(const struct request *r, const struct ior_page *page,
                      struct err *err)
{
    const struct bands *bands =
        r->shared.has_bands ? &r->shared.bands : &bands_fixed;
    double n[BANDS_MAX], k[BANDS_MAX];
    for (int b = 0; b < bands->count; b++)
        if (!ior_page_at(page, bands->nm[b], &n[b], &k[b], err))
            return false;
    page_comments(page);
    printf("# nm\tn\tk\n");
    for (int b = 0; b < bands->count; b++) {
        const double row[3] = { bands->nm[b], n[b], k[b] };
        numbers_print(row, 3, '\n');
    }
    return true;
}

static void colour_row(const char *method, const struct spectrum *eta,
                       const struct spectrum *k, struct spectrum f0,
                       double ciede2000)
{
    printf("%s", method);
    for (int b = 0; b < 3; b++)
        eta ? printf("\t%.6g", eta->band[b]) : printf("\t-");
    for (int b = 0; b < 3; b++)
        k ? printf("\t%.6g", k->band[b]) : printf("\t-");
    for (int b = 0; b < 3; b++)
        printf("\t%.4f", f0.band[b]);
    printf("\t%.2f\n", ciede2000);
}

/* The pairs of one method, or of each, and the colour that they give. */
static bool colours(const struct request *r, const struct cie *cie,
                    const struct ior_page *page, struct err *err)
{
    struct bands way[3] = { bands_fixed,
                            { 3, { 0 }, BANDS_RGB_AVERAGE },
                            { 3, { 0 }, BANDS_RGB_FIT } };
    if (!r->shared.all)
        way[0] = r->shared.bands;
    page_comments(page);
    printf("# method\teta R\tG\tB\tk R\tG\tB\tF0 R\tG\tB (linear sRGB, D65)\t"
           "CIEDE2000 from the spectral colour\n");
    for (int i = 0; i < (r->shared.all ? 3 : 1); i++) {
        static const enum colour_method method[] = {
            [BANDS_NM] = COLOUR_FIXED,
            [BANDS_RGB_AVERAGE] = COLOUR_AVERAGE,
            [BANDS_RGB_FIT] = COLOUR_FIT,
        };
        struct spectrum eta, k;
        struct colour_report report;
        char name[96];
        if (!colour_conductor(cie, page, method[way[i].kind], &way[i], &eta, &k,
                              &report, err))
            return false;
        comment("warning", report.warnings);
        if (i == 0)
            colour_row("spectral", NULL, NULL, report.f0_spectral, 0);
        bands_print(&way[i], name, sizeof name);
        colour_row(name, &eta, &k, report.f0, report.ciede2000);
    }
    return true;
}

static bool exported(const struct request *r, const struct cie *cie,
                     const struct ior_page *page, struct err *err)
{
    struct colour_metal *metal = malloc(sizeof *metal);
    struct colour_report report = { .warnings = "" };
    struct export e = { r->arg[1],         page,      metal,
                        "fit for R, G, B", { { 0 } }, { { 0 } } };
    bool ok = metal || err_set(err, "out of memory");
    ok = ok && colour_metal_init(metal, cie, page, err) &&
         colour_conductor(cie, page, COLOUR_FIT, NULL, &e.eta, &e.k, &report,
                          err) &&
         export_write(stdout, (enum export_format)r->as, &e, err);
    if (ok && report.warnings[0] && r->as == EXPORT_CPP)
        fprintf(stderr, "bsdf-info: warning: %s\n", report.warnings);
    free(metal);
    return ok;
}

/* Three values and half a unit of the last digit that any of them has. */
static bool triple_read(const char *what, const char *text, struct spectrum *s,
                        double *half, struct err *err)
{
    int digits = 0, n = 0;
    *s = (struct spectrum){ { 0 } };
    for (const char *at = text; n < 4; n++) {
        char *end;
        const double x = strtod(at, &end);
        const size_t point = strcspn(at, "./");
        if (end == at || !(x >= 0 && x <= 1000))
            break;
        const int behind = (int)(end - at) - (int)point - 1;
        if (at[point] == '.' && behind > digits)
            digits = behind;
        if (n < 3)
            s->band[n] = x;
        if (*end != '/') {
            n = *end == '\0' && n == 2 ? 3 : 9;
            break;
        }
        at = end + 1;
    }
    *half = 0.5 * pow(10, -digits);
    return n == 3 || err_set(err,
                             "%s \"%.60s\": expected three values in [0, "
                             "1000] as in 0.29294/0.28568/0.28733",
                             what, text);
}

static bool match(const struct request *r, struct err *err)
{
    struct spectrum eta, k;
    struct colour_match m;
    double eta_half, k_half;
    if (r->args != 2)
        return err_set(err, "--match: expected ETA and K, as in --match "
                            "0.29/0.28/0.28 2.7/2.3/1.8");
    if (!triple_read("ETA", r->match, &eta, &eta_half, err) ||
        !triple_read("K", r->arg[1], &k, &k_half, err) ||
        !colour_match(&eta, &k, eta_half, k_half, NULL, 0, NULL, &m, err))
        return false;
    printf("# %d pages compared, linear between rows\n", m.compared);
    printf("# %s: the largest difference is %.3g of half a last digit\n",
           m.within ? "the same numbers when rounded"
                    : "not the same numbers, but the nearest",
           m.error);
    printf("# page\tnm\tn\tk\n");
    for (int b = 0; b < 3; b++)
        printf("%s\t%g\t%.6g\t%.6g\n", m.page, m.bands.nm[b], m.eta.band[b],
               m.k.band[b]);
    return true;
}

static bool ior(const struct request *r, struct err *err)
{
    if (r->match)
        return match(r, err);
    if (r->args != 2)
        return err_set(err, "ior: expected one NAME, as in Ca");
    struct cie *cie = malloc(sizeof *cie);
    struct ior_page *page = cie ? ior_find(r->arg[1], NULL, err)
                                : (err_set(err, "out of memory"), NULL);
    const bool rgb = r->shared.all ||
                     (r->shared.has_bands && r->shared.bands.kind != BANDS_NM);
    bool ok = page;
    if (ok && (rgb || r->as >= 0))
        ok = cie_load(cie, err);
    if (ok)
        ok = r->as >= 0 ? exported(r, cie, page, err)
             : rgb      ? colours(r, cie, page, err)
                        : constants(r, page, err);
    ior_page_free(page);
    free(cie);
    return ok;
}

static bool cite(const struct request *r, struct err *err)
{
    char text[16384];
    if (r->args != 2)
        return err_set(err, "cite: expected one NAME, as in Ca");
    struct ior_page *page = ior_find(r->arg[1], NULL, err);
    if (!page)
        return false;
    const bool ok =
        ior_page_bibtex(page, text, sizeof text) ||
        err_set(err, "%s: its reference is too long", ior_page_path(page));
    if (ok)
        fputs(text, stdout);
    ior_page_free(page);
    return ok;
}

/* Means of weights, with their standard errors; by validate's quadrature they
 * are known to more digits, see the energy check. */
static bool albedo(const struct request *r, struct err *err)
{
    if (r->args != 2)
        return err_set(err, "albedo: expected one SPEC");
    if (!r->has_wo)
        return err_set(err, "albedo: expected --wo THETA,PHI in degrees");
    struct bsdf *b = made(r, err);
    if (!b)
        return false;
    const int bands = r->shared.bands.count;
    const uint64_t count = r->count ? r->count : 1000000;
    const double eta = bsdf_claims(b).eta;
    const struct rng rng = { r->shared.seed, 0 };
    double sum[2][BANDS_MAX] = { { 0 } }, square[2][BANDS_MAX] = { { 0 } };
    for (uint64_t i = 0; i < count; i++) {
        const struct bsdf_sample s = bsdf_sample(b, r->wo, rng_uniform(rng, i));
        const double n2 = s.wi.z * r->wo.z >= 0 ? 1
                          : r->wo.z > 0         ? eta * eta
                                                : 1 / (eta * eta);
        for (int k = 0; k < bands; k++)
            for (int radiance = 0; radiance < 2; radiance++) {
                const double x = s.weight.band[k] * (radiance ? 1 : n2);
                sum[radiance][k] += x;
                square[radiance][k] += x * x;
            }
    }
    printf("# %s\n", bsdf_spec(b));
    bands_comment(&r->shared.bands);
    printf("# seed: %" PRIu64 "; mean weight of %" PRIu64 " samples\n",
           r->shared.seed, count);
    printf("# band\tenergy\t+-\tradiance\t+-\n");
    for (int k = 0; k < bands; k++) {
        char name[32];
        const double n = (double)count;
        bands_print_one(&r->shared.bands, k, name, sizeof name);
        printf("%s", name);
        for (int radiance = 0; radiance < 2; radiance++) {
            const double mean = sum[radiance][k] / n;
            const double variance = square[radiance][k] / n - mean * mean;
            printf("\t%.6f\t%.1e", mean, sqrt(fmax(variance, 0) / n));
        }
        printf("\n");
    }
    bsdf_free(b);
    return true;
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        bool (*run)(const struct request *r, struct err *err);
    } command[] = {
        { "list", list },     { "eval", eval }, { "sample", sample },
        { "albedo", albedo }, { "ior", ior },   { "cite", cite },
    };
    enum { COMMANDS = sizeof command / sizeof *command };
    static const char *const names[] = { "list", "eval", "sample", "albedo",
                                         "ior",  "cite", NULL };
    struct request r = {
        .shared = { .bands = bands_default, .seed = 1, .compares = true },
        .as = -1
    };
    struct err err;
    gsl_set_error_handler_off();
    argp_err_exit_status = EXIT_REQUEST;
    argp_parse(&(struct argp){ options, option, "COMMAND [ARGUMENT...]", about,
                               (const struct argp_child[]){
                                   { &cli_shared_argp, 0, 0, 0 }, { 0 } },
                               0, 0 },
               argc, argv, 0, NULL, &r);
    int i = 0;
    while (i < COMMANDS && strcmp(command[i].name, r.arg[0]) != 0)
        i++;
    bool ok;
    if (i < COMMANDS) {
        ok = command[i].run(&r, &err);
    } else {
        ok = err_unknown(&err, "command", r.arg[0], names);
    }
    if (!ok)
        fprintf(stderr, "bsdf-info: %s\n", err.text);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "bsdf-info: standard output: %s\n", strerror(errno));
        ok = false;
    }
    return ok ? EXIT_SOUND : EXIT_REQUEST;
}
