/* baselines.c - who catches what, and who cries wolf
 *
 * The chi-square procedures of baseline.h beside the checks of validate/:
 *
 *   1  sound rough mirrors, narrower and narrower, each from 20 directions that
 *      are uniform over the hemisphere: how many are rejected;
 *   2  the mutants of mutant_table.c at the size that a renderer had and at a
 *      hundredth of it, from the directions that the table names: who rejects
 *      them; and their sound controls.
 *
 * Prints both, writes every verdict to a table, and puts the summary between
 * two comments of the README, where nobody else writes.
 *
 * Exit status: 0; 1 where our checks reject a sound mirror; 2 where the request
 * was wrong.
 */
#include <argp.h>
#include <errno.h>
#include <gsl/gsl_errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "bsdf/cli.h"
#include "bsdf/outfile.h"
#include "tests/baseline.h"
#include "tests/mutant_table.h"
#include "tests/plan_argp.h"
#include "tests/publish.h"

enum { OTHERS = 4, OURS = OTHERS, WHO, DIRECTIONS = 20, MANY = 128 };

static const struct baseline *const others[OTHERS] = {
    &baseline_mitsuba, &baseline_mitsuba_fine, &baseline_pbrt, &baseline_nori
};

static const char *name_of(int who)
{
    return who < OTHERS ? others[who]->name : "all checks";
}

static const double alphas[] = { .05, .02, .01, .005, .002, .001 };
static const char *const families[] = { "beckmann", "ggx" };
enum { ALPHAS = sizeof alphas / sizeof *alphas, FAMILIES = 2 };

struct request {
    struct plan plan;
    const char *table, *readme;
};

static const struct argp_option options[] = {
    { "output", 'f', "FILE", 0, "build/baselines/verdicts.tsv", 0 },
    { "readme", 'r', "FILE", 0, "the file with <!-- baselines --> in it; none",
      0 },
    { 0 },
};

static error_t option(int key, char *arg, struct argp_state *state)
{
    struct request *r = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &r->plan;
        return 0;
    case 'f':
        r->table = arg;
        break;
    case 'r':
        r->readme = arg;
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

/* -- one model from one direction ------------------------------------------ */

struct trial {
    bool rejected[WHO];
    double p[OTHERS];
    bool applies;  /* the others are made for models with a density alone */
    char by[128];  /* our checks that failed */
    char why[200]; /* it could not be tried, or "" */
};

static void try_others(struct trial *t, const struct bsdf *b, struct vec3 wo,
                       const struct plan *plan)
{
    struct baseline_draws d;
    t->applies = bsdf_claims(b).lobes & ~(unsigned)BSDF_DELTA;
    if (!t->applies)
        return;
    if (!baseline_draw(&d, b, wo, plan->samples, plan->seed)) {
        snprintf(t->why, sizeof t->why, "out of memory");
        return;
    }
    for (int i = 0; i < OTHERS; i++) {
        const struct baseline_verdict v = others[i]->test(b, wo, &d);
        t->p[i] = v.p;
        t->rejected[i] = !v.passed;
    }
    baseline_draws_clear(&d);
}

static void try_ours(struct trial *t, const struct bsdf *b, struct vec3 wo,
                     const struct plan *plan)
{
    struct run run;
    struct err err;
    unsigned failed = 0;
    if (!run_checks(&run, plan, &b, 1, &wo, 1, NULL, NULL, &err)) {
        snprintf(t->why, sizeof t->why, "%.190s", err.text);
        return;
    }
    for (int c = 0; c < checks_count(); c++) {
        const struct verdict *v = &run.result[0].verdict[c];
        if (v->applies && !v->passed)
            failed |= 1u << c;
    }
    run_clear(&run);
    t->rejected[OURS] = failed;
    mutant_names(failed, t->by, sizeof t->by);
}

static void try_all(struct trial *t, const struct bsdf *b, struct vec3 wo,
                    const struct plan *plan)
{
    *t = (struct trial){ .p = { NAN, NAN, NAN, NAN } };
    try_others(t, b, wo, plan);
    try_ours(t, b, wo, plan);
}

/* -- 1: sound mirrors ------------------------------------------------------ */

struct mirrors {
    struct trial at[FAMILIES][ALPHAS][DIRECTIONS];
    struct vec3 wo[DIRECTIONS];
};

static void mirrors_try(struct mirrors *m, const struct plan *plan)
{
    const struct rng rng = { plan->seed, 0x6d6972726f72 };
    for (int k = 0; k < DIRECTIONS; k++) {
        const struct vec3 u = rng_uniform(rng, (uint64_t)k);
        const double z = 1 - u.x, s = sqrt((1 - z) * (1 + z));
        m->wo[k] =
            (struct vec3){ s * cos(2 * PI * u.y), s * sin(2 * PI * u.y), z };
    }
#pragma omp parallel for schedule(dynamic, 1) collapse(3)
    for (int f = 0; f < FAMILIES; f++)
        for (int a = 0; a < ALPHAS; a++)
            for (int k = 0; k < DIRECTIONS; k++) {
                char spec[100];
                struct err err;
                struct trial *t = &m->at[f][a][k];
                snprintf(spec, sizeof spec,
                         "roughconductor:distribution=%s,alpha=%g", families[f],
                         alphas[a]);
                struct bsdf *b = bsdf_new(spec, &bands_default, &err);
                if (b)
                    try_all(t, b, m->wo[k], plan);
                else
                    snprintf(t->why, sizeof t->why, "%.190s", err.text);
                bsdf_free(b);
            }
}

static int mirrors_rejected(const struct mirrors *m, int f, int a, int who)
{
    int n = 0;
    for (int k = 0; k < DIRECTIONS; k++)
        n += m->at[f][a][k].rejected[who];
    return n;
}

/* -- 2: mutants ------------------------------------------------------------ */

struct case_of {
    const struct mutant *m;
    bool control, small; /* small: a hundredth of the size */
    struct trial all;    /* rejected from any of its directions */
};

struct cases {
    struct case_of at[3 * MANY];
    int n;
};

static void cases_gather(struct cases *c)
{
    for (const struct mutant *m = mutant_controls; m->name && c->n < MANY; m++)
        c->at[c->n++] = (struct case_of){ .m = m, .control = true };
    for (int small = 0; small < 2; small++)
        for (const struct mutant *m = mutants; m->name && c->n < 3 * MANY; m++)
            if (!small || m->way != MUTANT_FIXED)
                c->at[c->n++] = (struct case_of){ .m = m, .small = small };
}

static void case_try(struct case_of *c, const struct plan *plan)
{
    char settings[256];
    struct err err;
    mutant_settings(c->m, c->small ? 0.01 : 1, settings, sizeof settings);
    struct bsdf *b = bsdf_new_of(c->m->type, settings, &bands_default, &err);
    if (!b) {
        snprintf(c->all.why, sizeof c->all.why, "%.190s", err.text);
        return;
    }
    for (int i = 0; i < 2; i++) {
        if (!(c->m->theta_deg[i] > 0))
            continue;
        struct trial t;
        try_all(&t, b, dir_from_degrees(c->m->theta_deg[i], 40), plan);
        if (i == 0) {
            c->all = t;
            continue;
        }
        for (int who = 0; who < WHO; who++)
            c->all.rejected[who] |= t.rejected[who];
        if (c->all.by[0] == '\0')
            memcpy(c->all.by, t.by, sizeof t.by);
        if (c->all.why[0] == '\0')
            memcpy(c->all.why, t.why, sizeof t.why);
    }
    bsdf_free(b);
}

static void cases_try(struct cases *c, const struct plan *plan)
{
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < c->n; i++)
        case_try(&c->at[i], plan);
}

/* A mistake that can be seen without a reference. */
static bool is_mistake(const struct case_of *c)
{
    return !c->control && !c->m->sound && !c->m->blind;
}

/* How many of a kind are rejected, and there are. */
static int cases_rejected(const struct cases *c, int who, bool mistakes,
                          bool small, int *of)
{
    int n = 0;
    *of = 0;
    for (int i = 0; i < c->n; i++) {
        const struct case_of *k = &c->at[i];
        const bool sound = k->control || (k->m->sound && !k->small);
        if (mistakes ? !is_mistake(k) || k->small != small : !sound)
            continue;
        n += k->all.rejected[who];
        ++*of;
    }
    return n;
}

/* -- the report ------------------------------------------------------------ */

/* Markdown, which reads well on a terminal too. */
static void summary(FILE *f, const struct request *r, const struct mirrors *m,
                    const struct cases *c)
{
    const struct machine where = machine_now();
    int of;
    fprintf(f,
            "Written by `make baselines`: %s, %s, seed %llu, %llu samples a "
            "direction.\n\n",
            where.date, where.processor, (unsigned long long)r->plan.seed,
            (unsigned long long)r->plan.samples);
    fprintf(f,
            "Sound rough mirrors (Beckmann, GGX; visible normals) rejected, "
            "of %d directions:\n\n| alpha |",
            DIRECTIONS);
    for (int a = 0; a < ALPHAS; a++)
        fprintf(f, " %g |", alphas[a]);
    fprintf(f, "\n|---|");
    for (int a = 0; a < ALPHAS; a++)
        fprintf(f, "---|");
    for (int who = 0; who < WHO; who++) {
        fprintf(f, "\n| %s |", name_of(who));
        for (int a = 0; a < ALPHAS; a++)
            fprintf(f, " %d, %d |", mirrors_rejected(m, 0, a, who),
                    mirrors_rejected(m, 1, a, who));
    }
    fprintf(f, "\n\nKnown mistakes of renderers, and sound models:\n\n"
               "| | caught as they were | at 1 %% of their size | sound models "
               "rejected |\n|---|---|---|---|");
    for (int who = 0; who < WHO; who++) {
        fprintf(f, "\n| %s |", name_of(who));
        const int full = cases_rejected(c, who, true, false, &of);
        fprintf(f, " %d of %d |", full, of);
        const int small = cases_rejected(c, who, true, true, &of);
        fprintf(f, " %d of %d |", small, of);
        const int sound = cases_rejected(c, who, false, false, &of);
        fprintf(f, " %d of %d |", sound, of);
    }
    fprintf(f, "\n");
}

static void print_cases(const struct cases *c)
{
    printf("\n+ rejected, . passed, blank: not made for it\n%-38s%8s%8s%8s%8s"
           "  by our checks\n",
           "", "Mitsuba", "as doc.", "pbrt", "Nori");
    for (int i = 0; i < c->n; i++) {
        const struct case_of *k = &c->at[i];
        printf("%-3s %-26s%-8s", k->m->bug, k->m->name,
               k->control || !k->small ? "" : "1 %");
        for (int who = 0; who < OTHERS; who++)
            printf("%8s", !k->all.applies        ? ""
                          : k->all.rejected[who] ? "+"
                                                 : ".");
        printf("  %s%s\n", k->all.by[0] ? k->all.by : "-", k->all.why);
    }
}

static void write_verdicts(FILE *f, const struct request *r,
                           const struct mirrors *m, const struct cases *c)
{
    const struct machine where = machine_now();
    fprintf(f, "# %s, %s, seed %llu, %llu samples a direction\n", where.date,
            where.processor, (unsigned long long)r->plan.seed,
            (unsigned long long)r->plan.samples);
    for (int who = 0; who < OTHERS; who++)
        fprintf(f, "# %s: %s\n", others[who]->name, others[who]->about);
    fprintf(f, "model\tscale\ttheta_o [deg]\tphi_o [deg]");
    for (int who = 0; who < OTHERS; who++)
        fprintf(f, "\t%s\tp", name_of(who));
    fprintf(f, "\tour checks that fail\n");
    for (int n = 0; n < FAMILIES * ALPHAS * DIRECTIONS; n++) {
        const int k = n % DIRECTIONS, a = n / DIRECTIONS % ALPHAS;
        const int family = n / DIRECTIONS / ALPHAS;
        const struct trial *t = &m->at[family][a][k];
        const struct angles at = dir_to_degrees(m->wo[k]);
        fprintf(f, "roughconductor:distribution=%s,alpha=%g\t-\t%.4f\t%.4f",
                families[family], alphas[a], at.theta_deg, at.phi_deg);
        for (int who = 0; who < OTHERS; who++)
            fprintf(f, "\t%s\t%.3g", t->rejected[who] ? "rejects" : "passes",
                    t->p[who]);
        fprintf(f, "\t%s\n", t->by[0] ? t->by : "-");
    }
    for (int i = 0; i < c->n; i++) {
        const struct case_of *k = &c->at[i];
        fprintf(f, "%s %s\t%g\t%g", k->m->bug, k->m->name,
                k->control ? 0
                : k->small ? 0.01
                           : 1,
                k->m->theta_deg[0]);
        if (k->m->theta_deg[1] > 0)
            fprintf(f, "/%g", k->m->theta_deg[1]);
        fprintf(f, "\t40");
        for (int who = 0; who < OTHERS; who++)
            fprintf(f, "\t%s\t%.3g",
                    !k->all.applies        ? "-"
                    : k->all.rejected[who] ? "rejects"
                                           : "passes",
                    k->all.p[who]);
        fprintf(f, "\t%s\n", k->all.by[0] ? k->all.by : "-");
    }
}

/* -- the README ------------------------------------------------------------ */

static bool write_readme(const struct request *r, const struct mirrors *m,
                         const struct cases *c, struct err *err)
{
    char *text = NULL;
    size_t size;
    FILE *f = open_memstream(&text, &size);
    if (f)
        summary(f, r, m, c);
    const bool ok = f && fclose(f) == 0
                        ? publish(r->readme, "baselines", text, err)
                        : err_set(err, "out of memory");
    free(text);
    return ok;
}

static bool folder(const char *path, struct err *err)
{
    return mkdir(path, 0777) == 0 || errno == EEXIST ||
           err_set(err, "%s: %s", path, strerror(errno));
}

int main(int argc, char **argv)
{
    static struct mirrors mirrors;
    static struct cases cases;
    struct request r = { .plan = plan_default,
                         .table = "build/baselines/verdicts.tsv" };
    struct outfile out;
    struct err err;
    int wolf = 0;
    gsl_set_error_handler_off();
    argp_err_exit_status = EXIT_REQUEST;
    argp_parse(
        &(struct argp){
            options, option, NULL, "Who catches what, and who cries wolf.",
            (const struct argp_child[]){ { &plan_argp, 0, 0, 0 }, { 0 } }, 0,
            0 },
        argc, argv, 0, NULL, &r);
    const time_t start = time(NULL);
    r.plan.threads = 1;
    r.plan.unexplained = true;
    mirrors_try(&mirrors, &r.plan);
    cases_gather(&cases);
    cases_try(&cases, &r.plan);
    summary(stdout, &r, &mirrors, &cases);
    print_cases(&cases);
    printf("%.0f s\n", difftime(time(NULL), start));
    if (!folder("build", &err) || !folder("build/baselines", &err) ||
        !outfile_open(&out, r.table, &err))
        goto fail;
    write_verdicts(out.stream, &r, &mirrors, &cases);
    if (!outfile_close(&out, &err) ||
        (r.readme && !write_readme(&r, &mirrors, &cases, &err)))
        goto fail;
    printf("%s\n", r.table);
    for (int f = 0; f < FAMILIES; f++)
        for (int a = 0; a < ALPHAS; a++)
            wolf += mirrors_rejected(&mirrors, f, a, OURS);
    return wolf ? EXIT_UNSOUND : EXIT_SOUND;
fail:
    fprintf(stderr, "baselines: %s\n", err.text);
    return EXIT_REQUEST;
}
