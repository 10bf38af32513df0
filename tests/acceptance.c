/* acceptance.c - sound models, bin masses, mistakes, threads */
#include "tests/acceptance.h"

#include <stdlib.h>
#include <time.h>

#include "tests/broken.h"
#include "tests/calibration.h"
#include "tests/chart.h"
#include "tests/detection.h"

enum { SPEC_MAX = 160 };

static const char *const distributions[] = { "beckmann", "ggx" };
static const char *const flags[] = { "false", "true" };

static void say(const struct acceptance *a, const char *what, size_t done,
                size_t of)
{
    if (a->progress)
        a->progress(what, done, of);
}

static const char *holds(bool line, bool *ok)
{
    *ok &= line;
    return line ? "" : " **fails**";
}

/* -- sound models ---------------------------------------------------------- */

/* How many directions of a run have a verdict that failed. */
static size_t rejected(const struct run *run, size_t from, size_t to)
{
    size_t n = 0;
    for (size_t i = from; i < to; i++) {
        bool any = false;
        for (int k = 0; k < checks_count(); k++) {
            const struct verdict *v = &run->result[i].verdict[k];
            any |= v->applies && !v->passed;
        }
        n += any;
    }
    return n;
}

static bool sound_cell(const struct acceptance *a, const char *spec,
                       size_t count[2], struct err *err)
{
    enum { MOST = 100 };
    struct vec3 wo[MOST + 2];
    struct run run;
    struct plan plan = plan_default;
    size_t n = a->sound < MOST ? a->sound : MOST;
    plan.seed = a->seed;
    plan.samples = a->sound_samples;
    for (size_t i = 0; i < n; i++)
        wo[i] = calibration_direction(a->seed, 100, i, false);
    wo[n] = dir_from_degrees(0, 0);
    wo[n + 1] = dir_from_degrees(89.9, 40);
    struct bsdf *b = bsdf_new(spec, &bands_default, err);
    const bool ok = b && run_checks(&run, &plan, (const struct bsdf *const *)&b,
                                    1, wo, n + 2, NULL, NULL, err);
    if (ok) {
        count[0] = rejected(&run, 0, n);
        count[1] = rejected(&run, n, n + 2);
        run_clear(&run);
    }
    bsdf_free(b);
    return ok;
}

static bool sound_models(const struct acceptance *a, bool *ok, struct err *err)
{
    static const double alpha[] = {
        1, .5, .05, .02, .01, .005, .002, .001, 1e-4
    };
    enum { ALPHAS = sizeof alpha / sizeof *alpha };
    fprintf(a->out,
            "\n**Sound models rejected**, of %zu random directions + of 0 and "
            "89.9 degrees, at 1e-6 for all of them together, %.2g samples "
            "each:\n\n| alpha |",
            a->sound, (double)a->sound_samples);
    for (int i = 0; i < ALPHAS; i++)
        fprintf(a->out, " %g |", alpha[i]);
    fprintf(a->out, "\n|---|");
    for (int i = 0; i < ALPHAS; i++)
        fprintf(a->out, "---|");
    for (int kind = 0; kind < 4; kind++) {
        fprintf(a->out, "\n| %s, %s normals |", distributions[kind / 2],
                kind % 2 ? "visible" : "all");
        for (int i = 0; i < ALPHAS; i++) {
            char spec[SPEC_MAX];
            size_t count[2];
            snprintf(spec, sizeof spec,
                     "roughconductor:distribution=%s,sample_visible=%s,"
                     "alpha=%g",
                     distributions[kind / 2], flags[kind % 2], alpha[i]);
            if (!sound_cell(a, spec, count, err))
                return false;
            fprintf(a->out, " %zu + %zu%s |", count[0], count[1],
                    holds(count[0] + count[1] == 0, ok));
            say(a, "sound models", (size_t)(kind * ALPHAS + i + 1), 4 * ALPHAS);
        }
    }
    fprintf(a->out, "\n");
    return true;
}

/* -- bin masses ------------------------------------------------------------ */

/* The largest over many surveys. */
struct masses {
    double bin, bin_stated, total, total_stated;
    double reference; /* what two orders of the reference differ by */
    size_t bins, all; /* looked at, and there */
};

static void most(double *a, double b)
{
    if (!(b <= *a)) /* a NaN stays */
        *a = b;
}

static struct masses masses_of(const struct subject *s, struct chart c,
                               uint64_t seed)
{
    const struct survey *v = &s->survey;
    struct masses m = { .all = partition_bins(v->partition) };
    for (size_t k = 0; k < m.all; k++) {
        const struct patch p = partition_patch(v->partition, k);
        /* One in ten. */
        if (p.theta0 >= PI / 2 - 1e-12 ||
            rng_uniform((struct rng){ seed, 0xb1 }, k).x >= 0.1)
            continue;
        const struct estimate truth = chart_mass(&c, p);
        most(&m.bin, fabs(v->mass[k].value - truth.value));
        most(&m.bin_stated, v->mass[k].error);
        most(&m.reference, truth.error);
        m.bins++;
    }
    most(&m.total, fabs(v->total.value - chart_total(&c)));
    most(&m.total_stated, v->total.error);
    return m;
}

static bool masses_make(const struct acceptance *a, const char *spec,
                        double alpha_u, double alpha_v, struct masses *m,
                        struct err *err)
{
    struct bsdf *b = bsdf_new(spec, &bands_default, err);
    bool ok = b;
    *m = (struct masses){ 0 };
#pragma omp parallel for schedule(dynamic, 1)
    for (size_t i = 0; i < (b ? a->directions : 0); i++) {
        struct plan plan = plan_default;
        struct subject s;
        struct err why;
        plan.samples = 1000;
        plan.seed = a->seed;
        const struct vec3 wo = calibration_direction(a->seed, 101, i, false);
        const bool made = subject_init(&s, b, wo, &plan, &why);
        struct masses one = { 0 };
        if (made) {
            one = masses_of(&s, (struct chart){ b, wo, alpha_u, alpha_v }, i);
            subject_clear(&s);
        }
#pragma omp critical(masses)
        {
            if (!made)
                ok = err_set(err, "%s", why.text);
            most(&m->bin, one.bin);
            most(&m->bin_stated, one.bin_stated);
            most(&m->total, one.total);
            most(&m->total_stated, one.total_stated);
            most(&m->reference, one.reference);
            m->bins += one.bins;
            m->all += one.all;
        }
    }
    bsdf_free(b);
    return ok;
}

static bool bin_masses(const struct acceptance *a, bool *ok, struct err *err)
{
    static const double limit = 1e-7;
    static const double alpha[][2] = { { .005, .005 },
                                       { .9, .02 },
                                       { .5, .001 } };
    fprintf(
        a->out,
        "\n**Bin masses** against an integral in another chart, from %zu "
        "random directions, before samples are looked at; a random tenth of "
        "the bins, and every total. "
        "The largest error seen, and the largest stated:\n\n"
        "| alpha_u, alpha_v | bins | off by | stated | total off by | "
        "stated | reference off by |\n|---|---|---|---|---|---|---|\n",
        a->directions);
    for (int i = 0; i < 12; i++) {
        char spec[SPEC_MAX];
        struct masses m;
        const double *at = alpha[i / 4];
        snprintf(spec, sizeof spec,
                 "roughconductor:distribution=%s,sample_visible=%s,"
                 "alpha_u=%g,alpha_v=%g",
                 distributions[i / 2 % 2], flags[i % 2], at[0], at[1]);
        if (!masses_make(a, spec, at[0], at[1], &m, err))
            return false;
        fprintf(a->out,
                "| %g, %g, %s, %s normals | %zu of %zu | %.2g | %.2g | %.2g | "
                "%.2g | %.1g%s |\n",
                at[0], at[1], distributions[i / 2 % 2],
                i % 2 ? "visible" : "all", m.bins, m.all, m.bin, m.bin_stated,
                m.total, m.total_stated, m.reference,
                holds(m.bin <= limit && m.total <= limit, ok));
        say(a, "bin masses", (size_t)i + 1, 12);
    }
    return true;
}

/* -- mistakes -------------------------------------------------------------- */

static bool mistake(const struct acceptance *a, const char *name,
                    const char *fault, double alpha, int visible,
                    double theta_deg, size_t runs, size_t at_least, bool *ok,
                    struct err *err)
{
    char settings[SPEC_MAX];
    struct detection d = { .type = &type_broken_metal,
                           .settings = settings,
                           .wo = dir_from_degrees(theta_deg, 40),
                           .seed = a->seed,
                           .runs = runs,
                           .samples = a->samples };
    snprintf(settings, sizeof settings, "fault=none,alpha=%g,visible=%s", alpha,
             flags[visible]);
    struct bsdf *sound = bsdf_new_of(d.type, settings, &bands_default, err);
    if (!sound)
        return false;
    const double refused = detection_refused(sound, d.wo);
    bsdf_free(sound);
    snprintf(settings, sizeof settings, "%s,alpha=%g,visible=%s", fault, alpha,
             flags[visible]);
    if (!detection_make(&d, NULL, NULL, err))
        return false;
    const bool degrees = alpha > .005 || d.least_degrees >= 50;
    fprintf(a->out, "| %s | %g, %s | %.1f %% | %zu of %zu%s | %ld%s |", name,
            alpha, visible ? "visible" : "all", 100 * refused, d.caught, d.runs,
            holds(d.caught >= at_least && refused <= .2, ok), d.least_degrees,
            holds(degrees, ok));
    for (int i = 0; i < d.finders; i++)
        fprintf(a->out, "%s %s%s%s %zu", i ? "," : "", d.finder[i].check,
                d.finder[i].part[0] ? " " : "", d.finder[i].part,
                d.finder[i].runs);
    fprintf(a->out, " |\n");
    return true;
}

static bool mistakes(const struct acceptance *a, bool *ok, struct err *err)
{
    static const double alpha[] = { .5, .05, .005 };
    fprintf(
        a->out,
        "\n**Mistakes caught** at 1e-6 by one look at %.2g samples of one "
        "direction (20 degrees; 10 for leaks), by the checks that have a p; "
        "the mistake is in pdf() and in what samples say alike:\n\n"
        "| mistake | alpha, normals | refused | caught | degrees (fine) | "
        "surest |\n|---|---|---|---|---|---|\n",
        (double)a->samples);
    for (size_t i = 0; i < 6; i++) {
        const int visible = i % 2;
        if (!mistake(a, "pdf x 1.005", "fault=pdf_factor,size=1.005",
                     alpha[i / 2], visible, 20, a->seeds_pdf, a->seeds_pdf, ok,
                     err))
            return false;
        say(a, "pdf x 1.005", i + 1, 6);
    }
    for (size_t i = 0; i < 6; i++) {
        const int visible = i % 2;
        if (!mistake(a, "alpha x 1.01 sampled", "fault=sampled_alpha,size=1.01",
                     alpha[i / 2], visible, 20, a->seeds_alpha,
                     (a->seeds_alpha * 97 + 99) / 100, ok, err))
            return false;
        say(a, "alpha x 1.01", i + 1, 6);
    }
    for (size_t i = 2; i < 6; i++) {
        const int visible = i % 2;
        if (!mistake(a, "0.1 % leaked", "fault=leaks,size=0.001", alpha[i / 2],
                     visible, 10, a->seeds_leaks, a->seeds_leaks, ok, err))
            return false;
        say(a, "leaks", i - 1, 4);
    }
    return true;
}

/* -- threads --------------------------------------------------------------- */

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The least of three times, which take turns. */
static bool threads(const struct acceptance *a, bool *line, struct err *err)
{
    double least[2] = { INFINITY, INFINITY }, load[1] = { NAN };
    struct bsdf *b = bsdf_new("roughconductor:alpha=0.2", &bands_default, err);
    struct vec3 wo[16];
    bool ok = b;
    (void)line; /* it depends on what else the machine does */
    for (size_t i = 0; i < 16; i++)
        wo[i] = calibration_direction(a->seed, 102, i, false);
    for (int i = 0; ok && i < 6; i++) {
        struct plan plan = plan_default;
        struct run run;
        plan.samples = a->sound_samples;
        plan.threads = 1 + i % 2;
        const double start = seconds();
        ok = run_checks(&run, &plan, (const struct bsdf *const *)&b, 1, wo, 16,
                        NULL, NULL, err);
        least[i % 2] = fmin(least[i % 2], seconds() - start);
        if (ok)
            run_clear(&run);
        say(a, "threads", (size_t)i + 1, 6);
    }
    bsdf_free(b);
    getloadavg(load, 1);
    fprintf(a->out,
            "\n**Two threads** take 1/%.2f of the time of one (%.2f s and %.2f "
            "s, the least of three; the load of the machine was %.1f).\n",
            least[0] / least[1], least[1], least[0], load[0]);
    return ok;
}

const char *const acceptance_parts[ACCEPTANCE_PARTS] = {
    [ACCEPTANCE_SOUND] = "sound",
    [ACCEPTANCE_MASSES] = "masses",
    [ACCEPTANCE_MISTAKES] = "mistakes",
    [ACCEPTANCE_THREADS] = "threads",
};

bool acceptance(const struct acceptance *a, bool *ok, struct err *err)
{
    static bool (*const part[ACCEPTANCE_PARTS])(const struct acceptance *,
                                                bool *, struct err *) = {
        [ACCEPTANCE_SOUND] = sound_models,
        [ACCEPTANCE_MASSES] = bin_masses,
        [ACCEPTANCE_MISTAKES] = mistakes,
        [ACCEPTANCE_THREADS] = threads,
    };
    *ok = true;
    for (int i = 0; i < ACCEPTANCE_PARTS; i++)
        if ((a->parts & 1U << i) && !part[i](a, ok, err))
            return false;
    return true;
}
