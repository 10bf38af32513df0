/* mutants.c - which check catches which mistake, down to what size
 *
 * Every mutant of mutant_table.c is run at the size that a renderer had, then
 * at scales 2^-k, k found by bisection, as far as any check still fails: a
 * smallest size within a factor of 2, if a larger mistake is never harder to
 * see.  Prints the matrix and writes it, in full, as a table.
 *
 * Exit status: 0; 1 where a mistake got through, or something sound did not; 2
 * where the request was wrong.
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
#include "tests/mutant_table.h"
#include "tests/plan_argp.h"

/* 2^-24 = 6e-8 is below what any check allows for rounding, 1e-7. */
enum { HALVINGS_MAX = 24, MANY = 128 };

struct request {
    struct plan plan;
    const char *only, *output;
};

static const struct argp_option options[] = {
    { "only", 'o', "NAME", 0, "of all mutants this one", 0 },
    { "output", 'f', "FILE", 0, "build/mutants/kill-matrix.tsv", 0 },
    { 0 },
};

static error_t option(int key, char *arg, struct argp_state *state)
{
    struct request *r = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &r->plan;
        return 0;
    case 'o':
        r->only = arg;
        break;
    case 'f':
        r->output = arg;
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

/* -- running --------------------------------------------------------------- */

struct outcome {
    const struct mutant *m;
    bool control;
    struct mutant_found at_1;  /* at the original size */
    double scale;              /* the smallest that failed; 0 if none did */
    struct mutant_found least; /* at that scale */
    unsigned besides;          /* checks that fail at smaller sizes alone */
    char why[256];             /* it could not be run; or "" */
    bool done;
};

static bool run_at(struct outcome *o, double scale, const struct plan *plan,
                   struct mutant_found *found)
{
    struct err err;
    const bool ok = mutant_run(o->m, scale, plan, found, &err);
    if (!ok)
        snprintf(o->why, sizeof o->why, "%.200s", err.text);
    return ok;
}

/* Fails at 2^-low, and at 2^-high no more. */
static void bisect(struct outcome *o, const struct plan *plan)
{
    int low = 0, high = HALVINGS_MAX + 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        struct mutant_found found;
        if (!run_at(o, ldexp(1, -middle), plan, &found))
            return;
        /* Catches are counted of the checks that see the whole mistake. */
        o->besides |= found.failed & ~o->at_1.failed;
        found.failed &= o->at_1.failed;
        if (found.failed) {
            low = middle;
            o->scale = ldexp(1, -low);
            o->least = found;
        } else {
            high = middle;
        }
    }
}

static void work(struct outcome *o, const struct plan *plan)
{
    if (!run_at(o, 1, plan, &o->at_1) || !o->at_1.failed)
        return;
    o->scale = 1;
    o->least = o->at_1;
    if (!o->control && o->m->way != MUTANT_FIXED)
        bisect(o, plan);
}

/* -- what became of it ----------------------------------------------------- */

enum status { CAUGHT, MISSED, PASSED, FALSE_ALARM, BLIND, GAP, CLOSED };
static const char *const status_names[] = {
    "caught", "MISSED",      "passed", "FALSE ALARM", "needs a reference",
    "gap",    "gap, closed",
};

static enum status status_of(const struct outcome *o)
{
    const bool failed = o->at_1.failed;
    const struct mutant *m = o->m;
    if (o->why[0])
        return m->sound ? FALSE_ALARM : MISSED;
    if (m->gap)
        return failed == !!m->sound ? GAP : CLOSED;
    if (m->sound)
        return failed ? FALSE_ALARM : PASSED;
    if (m->blind)
        return failed ? CAUGHT : BLIND;
    return mutant_has_all(o->at_1.failed, m->caught_by) ? CAUGHT : MISSED;
}

static const char *named(const struct outcome *o)
{
    const char *got = o->at_1.diagnosis;
    return got[0] == '\0'                                    ? "-"
           : o->m->diagnosis && strstr(got, o->m->diagnosis) ? "right"
           : o->m->diagnosis                                 ? "wrong"
                                                             : "uncalled for";
}

/* -- text ------------------------------------------------------------------ */

static const char *cell(const struct outcome *o, int check)
{
    return o->at_1.failed & 1u << check    ? "X"
           : o->at_1.applied & 1u << check ? "."
                                           : "";
}

static void print_row(const struct outcome *o)
{
    char names[128];
    printf("%-3s %-26s", o->m->bug, o->m->name);
    for (int c = 0; c < checks_count(); c++)
        printf("%5s", cell(o, c));
    mutant_names(o->least.failed, names, sizeof names);
    char size[40] = "-";
    if (o->scale > 0 && o->m->way == MUTANT_FACTOR)
        snprintf(size, sizeof size, "1%+.2g", mutant_size(o->m, o->scale) - 1);
    else if (o->scale > 0 && o->m->way == MUTANT_SHARE)
        snprintf(size, sizeof size, "%.2g", mutant_size(o->m, o->scale));
    if (o->scale == 0)
        printf("  %-9s", "-");
    else if (o->m->way == MUTANT_FIXED)
        printf("  %-9s", "one size");
    else
        printf("  %-9.2g", o->scale);
    printf("%-11s%-22s", size, names[0] ? names : "-");
    printf(" %-13s%s", named(o), status_names[status_of(o)]);
    if (o->why[0])
        printf(": %s", o->why);
    else if (status_of(o) == BLIND)
        printf(": %s", o->m->blind);
    else if (status_of(o) == GAP)
        printf(": %s", o->m->gap);
    else if (status_of(o) == CLOSED)
        printf(": the mark can go");
    if (o->besides) {
        mutant_names(o->besides, names, sizeof names);
        printf(", and at a smaller size by %s, which passed this one", names);
    }
    printf("\n");
}

static void print_head(const struct request *r)
{
    printf("seed %llu, %llu samples for each direction and size, significance "
           "%g\n\nX fails, . passes at the size that a renderer had; smallest: "
           "the scale 2^-k of that, and\nthe size then, as the model takes "
           "it\n\n%-30s",
           (unsigned long long)r->plan.seed,
           (unsigned long long)r->plan.samples, r->plan.significance, "");
    for (int c = 0; c < checks_count(); c++)
        printf(" %.4s", checks[c]->name);
    printf("  %-9s%-11s%-22s %-13s%s\n", "smallest", "size", "by", "diagnosis",
           "");
}

static void print_totals(const struct outcome *o, int n)
{
    int of[sizeof status_names / sizeof *status_names] = { 0 };
    int right = 0, wrong = 0, none = 0, library = 0;
    for (int i = 0; i < n; i++) {
        of[status_of(&o[i])]++;
        if (o[i].control || !o[i].m->diagnosis)
            continue;
        library++;
        right += strcmp(named(&o[i]), "right") == 0;
        wrong += strcmp(named(&o[i]), "wrong") == 0;
        none += strcmp(named(&o[i]), "-") == 0;
    }
    printf("\n%d caught, %d missed; %d need a reference, %d gaps, %d closed; "
           "%d sound ones passed, %d failed\n"
           "diagnosis, where it is one of the hypotheses: %d right, %d wrong, "
           "%d none of %d\n",
           of[CAUGHT], of[MISSED], of[BLIND], of[GAP], of[CLOSED], of[PASSED],
           of[FALSE_ALARM], right, wrong, none, library);
}

/* -- the table ------------------------------------------------------------- */

static void write_rows(FILE *f, const struct request *r,
                       const struct outcome *o, int n)
{
    char names[128];
    fprintf(f,
            "# seed %llu, samples %llu, significance %g\n"
            "# scale: 1 is the size that a renderer had; smallest: the "
            "least 2^-k at which a check fails\n"
            "bug\tname\tseen in\tmodel\tsettings\ttheta_o [deg]\tsize",
            (unsigned long long)r->plan.seed,
            (unsigned long long)r->plan.samples, r->plan.significance);
    for (int c = 0; c < checks_count(); c++)
        fprintf(f, "\t%s", checks[c]->name);
    fprintf(f, "\tsmallest scale\tsmallest size\tby\tstatus\tdiagnosis "
               "expected\tdiagnosis given\tdiagnosis is\twhy\tfails at smaller "
               "sizes alone\n");
    for (int i = 0; i < n; i++) {
        const struct mutant *m = o[i].m;
        fprintf(f, "%s\t%s\t%s\t%s\t%s\t%g", m->bug, m->name,
                m->seen[0] ? m->seen : "-", m->type->name, m->settings,
                m->theta_deg[0]);
        if (m->theta_deg[1] > 0)
            fprintf(f, "/%g", m->theta_deg[1]);
        fprintf(f, "\t%.17g", m->original);
        for (int c = 0; c < checks_count(); c++) {
            const char *text = cell(&o[i], c);
            fprintf(f, "\t%s",
                    *text == 'X'   ? "fails"
                    : *text == '.' ? "passes"
                                   : "-");
        }
        mutant_names(o[i].least.failed, names, sizeof names);
        if (o[i].scale > 0)
            fprintf(f, "\t%.6g\t%.17g\t%s", o[i].scale,
                    mutant_size(m, o[i].scale), names);
        else
            fprintf(f, "\t-\t-\t-");
        fprintf(f, "\t%s\t%s\t%s\t%s\t%s", status_names[status_of(&o[i])],
                m->diagnosis ? m->diagnosis : "-",
                o[i].at_1.diagnosis[0] ? o[i].at_1.diagnosis : "-",
                named(&o[i]),
                o[i].why[0] ? o[i].why
                : m->sound  ? m->sound
                : m->blind  ? m->blind
                : m->gap    ? m->gap
                            : "-");
        mutant_names(o[i].besides, names, sizeof names);
        fprintf(f, "\t%s\n", names[0] ? names : "-");
    }
}

static bool write_table(const struct request *r, const struct outcome *o, int n,
                        struct err *err)
{
    struct outfile out;
    if (!outfile_open(&out, r->output, err))
        return false;
    write_rows(out.stream, r, o, n);
    return outfile_close(&out, err);
}

/* -- all of it ------------------------------------------------------------- */

static int gather(struct outcome *o, const char *only)
{
    int n = 0;
    for (int control = 1; control >= 0; control--)
        for (const struct mutant *m = control ? mutant_controls : mutants;
             m->name && n < MANY; m++)
            if (!only || strcmp(m->name, only) == 0)
                o[n++] = (struct outcome){ .m = m, .control = control };
    return n;
}

int main(int argc, char **argv)
{
    static struct outcome o[MANY];
    struct request r = { .plan = plan_default,
                         .output = "build/mutants/kill-matrix.tsv" };
    struct err err;
    int bad = 0;
    gsl_set_error_handler_off();
    argp_err_exit_status = EXIT_REQUEST;
    argp_parse(&(struct argp){ options, option, NULL,
                               "Which check catches which mistake, and how "
                               "small it may be.",
                               (const struct argp_child[]){
                                   { &plan_argp, 0, 0, 0 }, { 0 } },
                               0, 0 },
               argc, argv, 0, NULL, &r);
    const int n = gather(o, r.only);
    if (n == 0) {
        fprintf(stderr, "mutants: --only %s: there is no such mutant\n",
                r.only);
        return EXIT_REQUEST;
    }
    const time_t start = time(NULL);
    r.plan.threads = 1;
    print_head(&r);
    fflush(stdout);
    int printed = 0;
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < n; i++) {
        work(&o[i], &r.plan);
#pragma omp critical(print)
        {
            o[i].done = true;
            while (printed < n && o[printed].done)
                print_row(&o[printed++]);
            fflush(stdout);
        }
    }
    for (int i = 0; i < n; i++) {
        const enum status s = status_of(&o[i]);
        bad += s == MISSED || s == FALSE_ALARM;
    }
    print_totals(o, n);
    printf("%.0f s\n", difftime(time(NULL), start));
    if ((mkdir("build", 0777) != 0 && errno != EEXIST) ||
        (mkdir("build/mutants", 0777) != 0 && errno != EEXIST) ||
        !write_table(&r, o, n, &err)) {
        fprintf(stderr, "mutants: %s\n",
                errno && errno != EEXIST ? strerror(errno) : err.text);
        return EXIT_REQUEST;
    }
    printf("%s\n", r.output);
    return bad ? EXIT_UNSOUND : EXIT_SOUND;
}
