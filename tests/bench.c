/* bench.c - what the models, chi-squares and the masses of bins cost
 *
 * One thread, of which the processor's time is taken; medians of several runs,
 * in which what is compared takes turns.  Ratios come first, as they can be
 * compared between machines.
 *
 * The baseline of the masses is what usual chi-square tests do: a trapezoidal
 * rule of 32 x 32 intervals on every bin, over the angles.  The reference, not
 * timed, is a product of 16-point Gauss-Legendre rules that quarters a bin
 * until it agrees with its quarters, and shares nothing with
 * validate/quadrature.c.
 *
 * The baseline of a chi-square on 51 x 102 bins is tests/baseline_simpson.c.
 */
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sort.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bsdf/lanes.h"
#include "tests/baseline_simpson.h"
#include "tests/publish.h"
#include "validate/checks.h"

enum {
    DIRECTIONS = 4096,
    BATCH = 256,
    RUNS = 31,
    CHI2_RUNS = 5,
    MASS_RUNS = 15
};
enum { OPS = 3, MODELS = 4, LOBES = 2, GRIDS = 2 };

/* Of a chi-square on a grid, and of evaluations of a pdf. */
enum { STRIPS = 51, SLICES = 102, CELLS = STRIPS * SLICES };
enum { GRID_SAMPLES = 1000000, GRID_ORDER = 6, GRID_RUNS = 5 };
enum { PDFS = 320000 };
static const double goal_ratio = 8, goal_pdf_ns = 4.5;

static const struct bands bands = { .count = 3, .nm = { 614, 549, 466 } };

static const struct {
    const char *name, *spec;
} models[MODELS] = {
    { "diffuse", "diffuse:reflectance=0.5" },
    { "roughconductor beckmann", "roughconductor:material=Ca,alpha=0.25" },
    { "roughconductor ggx",
      "roughconductor:material=Ca,alpha=0.25,distribution=ggx" },
    { "roughdielectric beckmann", "roughdielectric:int_ior=1.5,alpha=0.25" },
}, lobes[LOBES] = {
    { "beckmann", "roughconductor:material=Ca,alpha=0.005" },
    { "ggx", "roughconductor:material=Ca,alpha=0.005,distribution=ggx" },
};

/* -- time ------------------------------------------------------------------ */

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double median(double *time, size_t n)
{
    gsl_sort(time, 1, n);
    return time[n / 2];
}

static void *or_exit(void *made, const char *why)
{
    if (!made) {
        fprintf(stderr, "bench: %s\n", why);
        exit(1);
    }
    return made;
}

static struct bsdf *make(const char *spec)
{
    struct err err;
    return or_exit(bsdf_new(spec, &bands, &err), err.text);
}

static struct subject look(const struct bsdf *b, struct vec3 wo,
                           const struct plan *plan)
{
    struct subject s;
    struct err err;
    or_exit(subject_init(&s, b, wo, plan, &err) ? &s : NULL, err.text);
    return s;
}

/* -- one call, or many at once --------------------------------------------- */

/* Each as x, y, z. */
struct inputs {
    double wo[3][DIRECTIONS], wi[3][DIRECTIONS], u[3][DIRECTIONS];
};

static struct dirs from(const double d[3][DIRECTIONS], size_t at)
{
    return (struct dirs){ d[0] + at, d[1] + at, d[2] + at };
}

static void put(double d[3][DIRECTIONS], size_t i, struct vec3 w)
{
    d[0][i] = w.x, d[1][i] = w.y, d[2][i] = w.z;
}

/* wo uniform over the upper hemisphere, wi drawn by the model. */
static void fill(struct inputs *in, const struct bsdf *b)
{
    const struct rng rng = { 1, 2 };
    for (uint64_t i = 0, draw = 0; i < DIRECTIONS; draw++) {
        const struct vec3 v = rng_uniform(rng, 2 * draw);
        const struct vec3 u = rng_uniform(rng, 2 * draw + 1);
        const double z = 1 - v.x, r = sqrt(1 - z * z);
        const struct vec3 wo = { r * cos(2 * PI * v.y), r * sin(2 * PI * v.y),
                                 z };
        const struct bsdf_sample a = bsdf_sample(b, wo, u);
        if (subject_refused(&a))
            continue;
        put(in->wo, i, wo);
        put(in->wi, i, a.wi);
        put(in->u, i++, u);
    }
}

static double sample_one(const struct bsdf *b, const struct inputs *in)
{
    const struct dirs wo = from(in->wo, 0), u = from(in->u, 0);
    double sum = 0;
    for (size_t i = 0; i < DIRECTIONS; i++)
        sum += bsdf_sample(b, dirs_at(wo, i), dirs_at(u, i)).pdf;
    return sum;
}

/* Room for a batch of samples. */
struct drawn {
    double number[4 + BANDS_MAX][BATCH];
    bool delta[BATCH];
};

static struct bsdf_samples into(struct drawn *d, int bands_asked)
{
    struct bsdf_samples s = { d->number[0], d->number[1], d->number[2],
                              d->number[3], { NULL },     d->delta };
    for (int i = 0; i < bands_asked; i++)
        s.weight[i] = d->number[4 + i];
    return s;
}

static double sample_many(const struct bsdf *b, const struct inputs *in)
{
    struct drawn d;
    double sum = 0;
    for (size_t at = 0; at < DIRECTIONS; at += BATCH) {
        const struct bsdf_samples s = into(&d, bands.count);
        bsdf_sample_into(b, BATCH, from(in->wo, at), from(in->u, at), s);
        for (size_t i = 0; i < BATCH; i++)
            sum += s.pdf[i];
    }
    return sum;
}

static double pdf_one(const struct bsdf *b, const struct inputs *in)
{
    const struct dirs wo = from(in->wo, 0), wi = from(in->wi, 0);
    double sum = 0;
    for (size_t i = 0; i < DIRECTIONS; i++)
        sum += bsdf_pdf(b, dirs_at(wo, i), dirs_at(wi, i));
    return sum;
}

static double pdf_many(const struct bsdf *b, const struct inputs *in)
{
    double pdf[BATCH], sum = 0;
    for (size_t at = 0; at < DIRECTIONS; at += BATCH) {
        bsdf_pdf_many(b, BATCH, from(in->wo, at), from(in->wi, at), pdf);
        for (size_t i = 0; i < BATCH; i++)
            sum += pdf[i];
    }
    return sum;
}

static double eval_one(const struct bsdf *b, const struct inputs *in)
{
    const struct dirs wo = from(in->wo, 0), wi = from(in->wi, 0);
    double sum = 0;
    for (size_t i = 0; i < DIRECTIONS; i++)
        sum += bsdf_eval(b, dirs_at(wo, i), dirs_at(wi, i)).band[0];
    return sum;
}

static double eval_many(const struct bsdf *b, const struct inputs *in)
{
    struct spectrum f[BATCH];
    double sum = 0;
    for (size_t at = 0; at < DIRECTIONS; at += BATCH) {
        bsdf_eval_many(b, BATCH, from(in->wo, at), from(in->wi, at), f);
        for (size_t i = 0; i < BATCH; i++)
            sum += f[i].band[0];
    }
    return sum;
}

static const struct {
    const char *name;
    double (*one)(const struct bsdf *b, const struct inputs *in);
    double (*many)(const struct bsdf *b, const struct inputs *in);
} ops[OPS] = {
    { "sample", sample_one, sample_many },
    { "pdf", pdf_one, pdf_many },
    { "eval", eval_one, eval_many },
};

struct calls {
    double one, many; /* [ns] each */
    bool same;        /* both sums, to the last bit */
};

static struct calls time_calls(int op, const struct bsdf *b,
                               const struct inputs *in)
{
    double one[RUNS], many[RUNS];
    struct calls c = { .same = true };
    for (int run = 0; run < RUNS; run++) {
        const double start = seconds();
        const double a = ops[op].one(b, in);
        const double middle = seconds();
        c.same &= ops[op].many(b, in) == a;
        one[run] = middle - start;
        many[run] = seconds() - middle;
    }
    c.one = median(one, RUNS) / DIRECTIONS * 1e9;
    c.many = median(many, RUNS) / DIRECTIONS * 1e9;
    return c;
}

/* -- a chi-square ---------------------------------------------------------- */

/* A survey and its chi-square, seen from 45 degrees [ms]. */
static double time_chi2(const struct bsdf *b)
{
    double time[CHI2_RUNS];
    for (int run = 0; run < CHI2_RUNS; run++) {
        const double start = seconds();
        struct subject s = look(b, dir_from_degrees(45, 0), &plan_default);
        check_run(checks_find("chi2"), &s);
        subject_clear(&s);
        time[run] = seconds() - start;
    }
    return median(time, CHI2_RUNS) * 1e3;
}

/* -- the masses of bins ---------------------------------------------------- */

/* As in validate/survey.c. */
static const double mass_tolerance = 1e-10;
static const long mass_budget = 20000000;

struct lobe {
    const struct subject *subject;
    long *evaluations;
};

enum { INTERVALS = 32, NODES = INTERVALS + 1, GAUSS = 16 };

static void pdf_at(const void *context, size_t n, struct dirs w, double *pdf)
{
    const struct lobe *l = context;
    subject_pdf(l->subject, n, w, pdf);
    *l->evaluations += (long)n;
}

/* Nodes and weights on [0, 1]. */
struct rule {
    size_t nodes;
    double x[NODES], weight[NODES];
};

static struct rule trapezoid(void)
{
    struct rule r = { .nodes = NODES };
    for (int i = 0; i < NODES; i++) {
        r.x[i] = (double)i / INTERVALS;
        r.weight[i] = (i == 0 || i == INTERVALS ? 0.5 : 1.0) / INTERVALS;
    }
    return r;
}

static struct rule gauss(size_t nodes)
{
    struct rule r = { .nodes = nodes };
    gsl_integration_glfixed_table *t =
        or_exit(gsl_integration_glfixed_table_alloc(nodes), "out of memory");
    for (size_t i = 0; i < nodes; i++)
        gsl_integration_glfixed_point(0, 1, i, &r.x[i], &r.weight[i], t);
    gsl_integration_glfixed_table_free(t);
    return r;
}

/* The product of a rule with itself, over theta and phi. */
static double product(const struct rule *r, const struct lobe *l,
                      struct patch p)
{
    double x[NODES * NODES], y[NODES * NODES], z[NODES * NODES];
    double pdf[NODES * NODES], c[NODES], s[NODES], sum = 0;
    const double dtheta = p.theta1 - p.theta0, dphi = p.phi1 - p.phi0;
    const size_t n = r->nodes;
    for (size_t k = 0; k < n; k++) {
        c[k] = cos(p.phi0 + dphi * r->x[k]);
        s[k] = sin(p.phi0 + dphi * r->x[k]);
    }
    for (size_t i = 0; i < n; i++) {
        const double theta = p.theta0 + dtheta * r->x[i];
        const double sin_theta = sin(theta), cos_theta = cos(theta);
        for (size_t k = 0; k < n; k++) {
            x[i * n + k] = sin_theta * c[k];
            y[i * n + k] = sin_theta * s[k];
            z[i * n + k] = cos_theta;
        }
    }
    pdf_at(l, n * n, (struct dirs){ x, y, z }, pdf);
    for (size_t i = 0; i < n; i++) {
        double row = 0;
        for (size_t k = 0; k < n; k++)
            row += r->weight[k] * pdf[i * n + k];
        sum += r->weight[i] * sin(p.theta0 + dtheta * r->x[i]) * row;
    }
    return sum * dtheta * dphi;
}

/* Until quarters change a part by less than 1e-15, at most to 1/64 of a bin. */
static double refined(const struct rule *r, const struct lobe *l,
                      struct patch p, double whole, int deeper)
{
    const double theta = (p.theta0 + p.theta1) / 2;
    const double phi = (p.phi0 + p.phi1) / 2;
    const struct patch quarter[] = { { p.theta0, theta, p.phi0, phi },
                                     { p.theta0, theta, phi, p.phi1 },
                                     { theta, p.theta1, p.phi0, phi },
                                     { theta, p.theta1, phi, p.phi1 } };
    double part[4], sum = 0;
    for (int i = 0; i < 4; i++)
        sum += part[i] = product(r, l, quarter[i]);
    if (fabs(sum - whole) <= 1e-15 || deeper == 0)
        return sum;
    sum = 0;
    for (int i = 0; i < 4; i++)
        sum += refined(r, l, quarter[i], part[i], deeper - 1);
    return sum;
}

struct masses {
    size_t bins;
    double total; /* of the reference */
    struct method {
        double ms;
        long evaluations;
        double error; /* the largest of any bin */
    } plain, ours;
    double bound; /* the largest error that ours states */
};

static double *reference_masses(const struct partition *p, struct lobe l,
                                double *total)
{
    const struct rule rule = gauss(GAUSS);
    double *mass =
        or_exit(malloc(partition_bins(p) * sizeof *mass), "out of memory");
    *total = 0;
    for (size_t i = 0; i < partition_bins(p); i++) {
        const struct patch bin = partition_patch(p, i);
        mass[i] = refined(&rule, &l, bin, product(&rule, &l, bin), 6);
        *total += mass[i];
    }
    return mass;
}

static struct method plain(const struct partition *p, struct lobe l,
                           struct estimate *mass)
{
    struct method m = { 0 };
    const struct rule rule = trapezoid();
    const double start = seconds();
    l.evaluations = &m.evaluations;
    for (size_t i = 0; i < partition_bins(p); i++)
        mass[i].value = product(&rule, &l, partition_patch(p, i));
    m.ms = (seconds() - start) * 1e3;
    return m;
}

static struct method ours(const struct partition *p, struct lobe l,
                          struct estimate *mass)
{
    struct method m = { 0 };
    const double start = seconds();
    l.evaluations = &m.evaluations;
    partition_integrate(p, pdf_at, &l, 1, mass_tolerance,
                        subject_batch(l.subject), mass_budget, mass);
    m.ms = (seconds() - start) * 1e3;
    return m;
}

/* The bins of a survey; seen from 30 degrees. */
static struct masses time_masses(const struct bsdf *b)
{
    const struct plan plan = { .seed = 1,
                               .samples = 1000,
                               .significance = .01 };
    const struct vec3 wo = dir_from_degrees(30, 0);
    struct subject s = look(b, wo, &plan);
    const struct partition *p = s.survey.partition;
    const size_t bins = partition_bins(p);
    struct estimate *mass =
        or_exit(malloc(bins * sizeof *mass), "out of memory");
    double time[2][MASS_RUNS];
    struct masses m = { .bins = bins };
    double *truth = reference_masses(
        p, (struct lobe){ &s, &m.plain.evaluations }, &m.total);
    for (int run = 0; run < MASS_RUNS; run++) {
        double error[2] = { 0, 0 };
        m.plain = plain(p, (struct lobe){ &s, NULL }, mass);
        for (size_t i = 0; i < bins; i++)
            error[0] = fmax(error[0], fabs(mass[i].value - truth[i]));
        m.ours = ours(p, (struct lobe){ &s, NULL }, mass);
        for (size_t i = 0; i < bins; i++) {
            error[1] = fmax(error[1], fabs(mass[i].value - truth[i]));
            m.bound = fmax(m.bound, mass[i].error);
        }
        time[0][run] = m.plain.ms, m.plain.error = error[0];
        time[1][run] = m.ours.ms, m.ours.error = error[1];
    }
    m.plain.ms = median(time[0], MASS_RUNS);
    m.ours.ms = median(time[1], MASS_RUNS);
    free(truth);
    free(mass);
    subject_clear(&s);
    return m;
}

/* -- a chi-square on a grid -------------------------------------------------
 */

#define METAL "roughconductor:eta=0.29/0.32/0.36,k=2.7/2.3/1.8,alpha=0.25,"

static const struct {
    const char *name, *spec;
    enum baseline_kind kind;
} grids[GRIDS] = {
    { "beckmann, all normals", METAL "sample_visible=false",
      BASELINE_BECKMANN_ALL },
    { "ggx, visible normals", METAL "distribution=ggx", BASELINE_GGX_VISIBLE },
};

struct grid_test {
    double sampling, integrating; /* [ms] */
    double statistic, weight;     /* chi-square, mean over samples and bands */
    double error;                 /* the largest of a mass, of ours */
    long degrees;
};

struct grid_tests {
    struct grid_test usual, ours, weighed;
};

static struct grid_test grid_usual(int kind, double theta)
{
    static long counts[CELLS];
    static double mass[CELLS];
    const struct baseline b = { .kind = grids[kind].kind,
                                .alpha = 0.25F,
                                .eta = { 0.29F, 0.32F, 0.36F },
                                .k = { 2.7F, 2.3F, 1.8F },
                                .theta = (float)theta };
    struct grid_test t;
    memset(counts, 0, sizeof counts);
    const double start = seconds();
    t.weight = baseline_sample(&b, 1, GRID_SAMPLES, STRIPS, SLICES, counts);
    const double middle = seconds();
    baseline_integrate(&b, STRIPS, SLICES, mass);
    t.statistic =
        chi_square_pooled(counts, mass, CELLS, GRID_SAMPLES, &t.degrees);
    t.sampling = (middle - start) * 1e3;
    t.integrating = (seconds() - middle) * 1e3;
    return t;
}

/* A direction is found by 1 - cos(theta) and by the way round a square instead
 * of a circle, which grow with the angles: a slot of a table holds one edge at
 * most. */
enum { SLOTS = 2048 };
struct finder {
    unsigned char strip[SLOTS + 1],
        slice[SLOTS + 1]; /* where the slot begins */
    double strip_end[STRIPS + 1], slice_end[SLICES + 1];
};

INLINE double square(double x, double y)
{
    const double s = y / (fabs(x) + fabs(y) + 0x1p-1022);
    const double right = s < 0 ? 4 + s : s;
    return x < 0 ? 2 - s : right;
}

static void slots_fill(unsigned char *slot, double span, const double *end,
                       int last)
{
    for (int i = 0, at = 0; i <= SLOTS; i++) {
        while (at < last && end[at] <= i * span / SLOTS)
            at++;
        slot[i] = (unsigned char)at;
    }
}

static void finder_make(struct finder *f)
{
    for (int i = 0; i < STRIPS; i++)
        f->strip_end[i] = 1 - cos((i + 1) * PI / STRIPS);
    for (int i = 0; i < SLICES; i++) {
        const double phi = (i + 1) * 2 * PI / SLICES;
        f->slice_end[i] = square(cos(phi), sin(phi));
    }
    f->strip_end[STRIPS - 1] = f->slice_end[SLICES - 1] = INFINITY;
    slots_fill(f->strip, 2, f->strip_end, STRIPS - 1);
    slots_fill(f->slice, 4, f->slice_end, SLICES - 1);
}

/* What a batch is found by. */
struct sought {
    double down[BATCH], round[BATCH];
    int strip[BATCH], slice[BATCH]; /* slots */
};

LANES static void keys_of(const double *x, const double *y, const double *z,
                          struct sought *k)
{
    LANES_LOOP
    for (int i = 0; i < BATCH; i++) {
        k->down[i] = 1 - z[i];
        k->round[i] = square(x[i], y[i]);
        k->strip[i] = (int)(k->down[i] * (SLOTS / 2));
        k->slice[i] = (int)(k->round[i] * (SLOTS / 4));
    }
}

/* Counts n directions by cells, those without a pdf in a last one. */
static void count(const struct finder *f, const struct sought *k,
                  const double *pdf, size_t n, unsigned *counts)
{
    for (size_t i = 0; i < n; i++) {
        const int strip = f->strip[k->strip[i]], slice = f->slice[k->slice[i]];
        const int row = strip + (k->down[i] >= f->strip_end[strip]);
        const int column = slice + (k->round[i] >= f->slice_end[slice]);
        counts[pdf[i] > 0 ? row * SLICES + column : CELLS]++;
    }
}

LANES static double total(size_t n, const double *x)
{
    double sum = 0;
    _Pragma("omp simd reduction(+:sum)") for (size_t i = 0; i < n; i++) sum +=
        x[i];
    return sum;
}

/* The weights are summed where they are asked for, else 0 is returned. */
static double grid_sample(const struct bsdf *b, struct vec3 wo, bool weights,
                          unsigned *counts)
{
    static double u[3][BATCH], o[3][BATCH];
    static struct drawn d;
    static struct finder find;
    const struct bsdf_samples s = into(&d, weights ? bands.count : 0);
    struct sought sought;
    double sum = 0;
    finder_make(&find);
    for (int i = 0; i < BATCH; i++)
        o[0][i] = wo.x, o[1][i] = wo.y, o[2][i] = wo.z;
    for (uint64_t at = 0; at < GRID_SAMPLES; at += BATCH) {
        const size_t n = at + BATCH > GRID_SAMPLES ? (size_t)(GRID_SAMPLES - at)
                                                   : (size_t)BATCH;
        rng_uniform_many((struct rng){ 1, 9 }, at, BATCH, u[0], u[1], u[2]);
        bsdf_sample_into(b, n, (struct dirs){ o[0], o[1], o[2] },
                         (struct dirs){ u[0], u[1], u[2] }, s);
        for (int k = 0; k < BANDS_MAX && s.weight[k]; k++)
            sum += total(n, s.weight[k]);
        keys_of(s.x, s.y, s.z, &sought);
        count(&find, &sought, s.pdf, n, counts);
    }
    return sum / ((double)bands.count * GRID_SAMPLES);
}

/* Six Gauss-Legendre points each way in every bin; strip by strip, as the
 * sines of phi are the same in each. */
static void grid_integrate(const struct bsdf *b, struct vec3 wo, double *mass)
{
    enum { ROW = SLICES * GRID_ORDER, ROUNDED = (ROW / BATCH + 1) * BATCH };
    static double c[ROW], s[ROW], o[3][ROUNDED], w[3][ROUNDED], pdf[ROUNDED];
    const struct rule rule = gauss(GRID_ORDER);
    memset(mass, 0, CELLS * sizeof *mass);
    for (int i = 0; i < ROUNDED; i++)
        o[0][i] = wo.x, o[1][i] = wo.y, o[2][i] = wo.z;
    for (int k = 0; k < ROW; k++) {
        const double phi =
            2 * PI / SLICES * (k / GRID_ORDER + rule.x[k % GRID_ORDER]);
        c[k] = cos(phi), s[k] = sin(phi);
    }
    for (int i = 0; i < STRIPS * GRID_ORDER; i++) {
        const double theta =
            PI / STRIPS * (i / GRID_ORDER + rule.x[i % GRID_ORDER]);
        const double sine = sin(theta), cosine = cos(theta);
        for (int k = 0; k < ROW; k++)
            w[0][k] = sine * c[k], w[1][k] = sine * s[k], w[2][k] = cosine;
        bsdf_pdf_many(b, ROW, (struct dirs){ o[0], o[1], o[2] },
                      (struct dirs){ w[0], w[1], w[2] }, pdf);
        const double scale = rule.weight[i % GRID_ORDER] * sine *
                             (PI / STRIPS) * (2 * PI / SLICES);
        double *row = mass + i / GRID_ORDER * SLICES;
        for (int k = 0; k < ROW; k++)
            row[k / GRID_ORDER] += scale * rule.weight[k % GRID_ORDER] * pdf[k];
    }
}

/* The largest error of a mass, not timed. */
static double grid_error(const struct bsdf *b, struct vec3 wo,
                         const double *mass)
{
    const struct rule rule = gauss(GAUSS);
    long evaluations = 0;
    const struct plan plan = { .seed = 1 };
    const struct subject s = subject_plain(b, wo, &plan);
    const struct lobe l = { &s, &evaluations };
    double most = 0;
    for (int i = 0; i < CELLS; i++) {
        const int row = i / SLICES, column = i % SLICES;
        const struct patch bin = { row * PI / STRIPS, (row + 1) * PI / STRIPS,
                                   column * 2 * PI / SLICES,
                                   (column + 1) * 2 * PI / SLICES };
        const double truth =
            refined(&rule, &l, bin, product(&rule, &l, bin), 6);
        most = fmax(most, fabs(mass[i] - truth));
    }
    return most;
}

static struct grid_test grid_ours(const struct bsdf *b, struct vec3 wo,
                                  bool weights, bool check)
{
    static unsigned counted[CELLS + 1];
    static long counts[CELLS];
    static double mass[CELLS];
    struct grid_test t;
    memset(counted, 0, sizeof counted);
    const double start = seconds();
    t.weight = grid_sample(b, wo, weights, counted);
    for (int i = 0; i < CELLS; i++)
        counts[i] = counted[i];
    const double middle = seconds();
    grid_integrate(b, wo, mass);
    t.statistic =
        chi_square_pooled(counts, mass, CELLS, GRID_SAMPLES, &t.degrees);
    t.sampling = (middle - start) * 1e3;
    t.integrating = (seconds() - middle) * 1e3;
    t.error = check ? grid_error(b, wo, mass) : 0;
    return t;
}

/* In turns; seen from 45 degrees. */
static struct grid_tests time_grid(int kind)
{
    double sampling[3][GRID_RUNS], integrating[3][GRID_RUNS];
    struct grid_tests t;
    struct grid_test *const each[] = { &t.usual, &t.ours, &t.weighed };
    struct bsdf *b = make(grids[kind].spec);
    const struct vec3 wo = dir_from_degrees(45, 0);
    for (int run = 0; run < GRID_RUNS; run++) {
        const bool last = run == GRID_RUNS - 1;
        t.usual = grid_usual(kind, PI / 4);
        t.ours = grid_ours(b, wo, false, last);
        t.weighed = grid_ours(b, wo, true, false);
        for (int i = 0; i < 3; i++) {
            sampling[i][run] = each[i]->sampling;
            integrating[i][run] = each[i]->integrating;
        }
    }
    for (int i = 0; i < 3; i++) {
        each[i]->sampling = median(sampling[i], GRID_RUNS);
        each[i]->integrating = median(integrating[i], GRID_RUNS);
    }
    bsdf_free(b);
    return t;
}

/* Of a pdf in batches, seen from 30 degrees [ns]. */
static double time_pdf(const struct bsdf *b)
{
    static struct inputs in;
    double time[RUNS], pdf[BATCH];
    fill(&in, b);
    for (size_t i = 0; i < DIRECTIONS; i++) {
        const struct vec3 wo = dir_from_degrees(30, 0);
        put(in.wo, i, wo);
        put(in.wi, i, bsdf_sample(b, wo, dirs_at(from(in.u, 0), i)).wi);
    }
    for (int run = 0; run < RUNS; run++) {
        const double start = seconds();
        for (size_t at = 0; at < PDFS; at += BATCH)
            bsdf_pdf_many(b, BATCH, from(in.wo, at % DIRECTIONS),
                          from(in.wi, at % DIRECTIONS), pdf);
        time[run] = seconds() - start;
    }
    return median(time, RUNS) / PDFS * 1e9;
}

/* -- the report ------------------------------------------------------------ */

struct results {
    struct calls calls[MODELS][OPS];
    double chi2[MODELS]; /* [ms] */
    struct masses masses[LOBES];
    double pdf[LOBES]; /* [ns] */
    struct grid_tests grid[GRIDS];
};

static void print_machine(void)
{
    const struct machine m = machine_now();
#ifdef __clang__
    const char *compiler = __VERSION__;
#else
    const char *compiler = "gcc " __VERSION__;
#endif
    printf("machine   %s\ncompiler  %s\ndate      %s\n", m.processor, compiler,
           m.date);
    printf("method    one thread, its own time; medians; three bands; %d "
           "directions, wo "
           "uniform over the upper\n          hemisphere and wi drawn by the "
           "model; batches of %d\n",
           DIRECTIONS, BATCH);
}

static void print_ratios(const struct results *r)
{
    printf("\nRATIOS\n%-42s", "one by one / batches");
    for (int op = 0; op < OPS; op++)
        printf("%12s", ops[op].name);
    for (int m = 0; m < MODELS; m++) {
        printf("\n  %-40s", models[m].name);
        for (int op = 0; op < OPS; op++)
            printf("%12.2f", r->calls[m][op].one / r->calls[m][op].many);
    }
    printf("\n%-42s%12s%12s%12s%16s\n",
           "usual chi-square / ours, 51 x 102 bins", "samples", "masses",
           "both", "with weights");
    for (int k = 0; k < GRIDS; k++) {
        const struct grid_tests *t = &r->grid[k];
        const struct grid_test *a = &t->usual, *b = &t->ours;
        const double usual = a->sampling + a->integrating;
        printf("  %-40s%12.2f%12.2f%12.2f%16.2f  (goal of both: %g)\n",
               grids[k].name, a->sampling / b->sampling,
               a->integrating / b->integrating,
               usual / (b->sampling + b->integrating),
               usual / (t->weighed.sampling + t->weighed.integrating),
               goal_ratio);
    }
    printf("%-42s%12s\n", "chi-square / drawing its samples", "time");
    for (int m = 0; m < MODELS; m++)
        printf("  %-40s%12.2f\n", models[m].name,
               r->chi2[m] /
                   (r->calls[m][0].many * 1e-6 * (double)plan_default.samples));
    printf("%-42s%12s%12s%12s\n", "bin masses, trapezoids / graded Gauss",
           "time", "evaluations", "error");
    for (int k = 0; k < LOBES; k++) {
        const struct masses *m = &r->masses[k];
        printf("  %-40s%12.2f%12.2f%12.2g\n", lobes[k].name,
               m->plain.ms / m->ours.ms,
               (double)m->plain.evaluations / (double)m->ours.evaluations,
               m->plain.error / m->ours.error);
    }
}

static void print_times(const struct results *r)
{
    bool same = true;
    printf("\nABSOLUTE\n%-42s", "[ns], one by one | in batches");
    for (int op = 0; op < OPS; op++)
        printf("%16s", ops[op].name);
    for (int m = 0; m < MODELS; m++) {
        printf("\n  %-40s", models[m].name);
        for (int op = 0; op < OPS; op++) {
            const struct calls *c = &r->calls[m][op];
            printf("%7.1f |%7.1f", c->one, c->many);
            same &= c->same;
        }
    }
    printf("\n  %s\n", same ? "both give the same, to the last bit"
                            : "THE TWO DIFFER, which they must not");
    printf("pdf in batches, alpha .005, one wo at 30 degrees, %d calls\n",
           PDFS);
    for (int k = 0; k < LOBES; k++)
        printf("  %-40s%7.2f ns  (goal: at most %g)\n", lobes[k].name,
               r->pdf[k], goal_pdf_ns);
    printf("chi-square of %.0g samples on %d x %d bins, alpha .25, at 45 "
           "degrees\n"
           "  the usual one's sample() gives weights in three bands as well, "
           "which a chi-square does\n  not look at; ours without them, and "
           "with them\n"
           "  %-22s%14s%14s%14s%22s\n",
           (double)GRID_SAMPLES, STRIPS, SLICES, "", "samples, ms",
           "masses, ms", "mean weight", "chi-square / degrees");
    for (int k = 0; k < GRIDS; k++) {
        static const char *const who[] = { "usual", "ours", "ours, weights" };
        const struct grid_tests *all = &r->grid[k];
        const struct grid_test *t[] = { &all->usual, &all->ours,
                                        &all->weighed };
        for (int i = 0; i < 3; i++) {
            char weight[16] = "-";
            if (i != 1)
                snprintf(weight, sizeof weight, "%.4f", t[i]->weight);
            printf("  %-22s%14.1f%14.1f%14s%15.0f /%5ld  %s\n",
                   i ? "" : grids[k].name, t[i]->sampling, t[i]->integrating,
                   weight, t[i]->statistic, t[i]->degrees, who[i]);
        }
        printf("  %-22slargest error of a mass, ours: %.1g\n", "",
               all->ours.error);
    }
    printf("chi-square of %.0g samples, at 45 degrees\n",
           (double)plan_default.samples);
    for (int m = 0; m < MODELS; m++)
        printf("  %-40s%9.1f ms\n", models[m].name, r->chi2[m]);
    printf("bin masses, alpha .005, at 30 degrees: %d x %d trapezoids a bin | "
           "graded Gauss, %g a leaf\n",
           INTERVALS, INTERVALS, mass_tolerance);
    for (int k = 0; k < LOBES; k++) {
        const struct masses *m = &r->masses[k];
        printf("  %-20s%10s%14s%16s\n", lobes[k].name, "ms", "evaluations",
               "largest error");
        printf("    %-18s%10.2f%14ld%16.2g\n", "trapezoids", m->plain.ms,
               m->plain.evaluations, m->plain.error);
        printf("    %-18s%10.2f%14ld%16.2g, stated as at most %.2g\n",
               "graded Gauss", m->ours.ms, m->ours.evaluations, m->ours.error,
               m->bound);
        printf("    %-18s%zu bins; the sum of masses less 1: %+.1g\n",
               "reference", m->bins, m->total - 1);
    }
}

int main(void)
{
    static struct inputs in;
    static struct results r;
    print_machine();
    fflush(stdout);
    for (int m = 0; m < MODELS; m++) {
        struct bsdf *b = make(models[m].spec);
        fill(&in, b);
        for (int op = 0; op < OPS; op++)
            r.calls[m][op] = time_calls(op, b, &in);
        r.chi2[m] = time_chi2(b);
        bsdf_free(b);
    }
    for (int k = 0; k < LOBES; k++) {
        struct bsdf *b = make(lobes[k].spec);
        r.masses[k] = time_masses(b);
        r.pdf[k] = time_pdf(b);
        bsdf_free(b);
    }
    for (int k = 0; k < GRIDS; k++)
        r.grid[k] = time_grid(k);
    print_ratios(&r);
    print_times(&r);
    return 0;
}
