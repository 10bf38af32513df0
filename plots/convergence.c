/* convergence.c - how fast an estimate of the albedo comes near it
 *
 * Root mean square error of the bands' mean over independent runs, against the
 * number of samples: of mean weights, of directions that are uniform, and of
 * one run of the former by itself.  The albedo is that of quadrature, and its
 * own error is the floor.  A line of 1/sqrt(n) goes with each, from the
 * standard deviation of a single sample.
 */
#include <stdlib.h>
#include <string.h>

#include "plots/chart.h"
#include "plots/colours.h"
#include "plots/kinds.h"
#include "plots/table.h"
#include "plots/variant.h"
#include "validate/subject.h"

enum {
    RUNS = 16,
    FIRST = 16, /* samples */
    POINTS_MAX = 32,
    BATCH = 256
};
enum { WEIGHTS, UNIFORM, WAYS };

struct point {
    double n, rms[WAYS], one;
};

struct convergence {
    const struct bsdf *bsdf;
    struct vec3 wo;
    uint64_t seed, samples;
    struct estimate albedo, beside; /* the mean of the bands; without deltas */
    double deviation[WAYS];
    struct point point[POINTS_MAX];
    int points;
};

/* Sums of one run at the points. */
struct run {
    double at[WAYS][POINTS_MAX], sum[WAYS], square[WAYS];
};

/* The solid angle over which directions are uniform. */
static double solid_angle(const struct bsdf *b)
{
    return bsdf_claims(b).lobes & BSDF_TRANSMISSION ? 4 * PI : 2 * PI;
}

static double by_uniform(const struct subject *s, struct vec3 u)
{
    const bool both = solid_angle(s->bsdf) > 2 * PI;
    const double z = both ? 2 * u.x - 1 : copysign(u.x, s->wo.z);
    const double r = sqrt((1 - z) * (1 + z)), phi = 2 * PI * u.y;
    const struct vec3 w = { r * cos(phi), r * sin(phi), z };
    return colours_mean(bsdf_bands(s->bsdf), bsdf_eval(s->bsdf, s->wo, w)) *
           fabs(z) * solid_angle(s->bsdf) * subject_compression(s, w);
}

static void sums_of(const struct convergence *c, int index, struct run *r)
{
    const struct plan plan = { .seed = c->seed + (uint64_t)index };
    const struct subject s = subject_plain(c->bsdf, c->wo, &plan);
    const struct rng drawn = subject_rng(&s, STREAM_SURVEY);
    const struct rng even = subject_rng(&s, STREAM_UNIFORM);
    struct bsdf_sample a[BATCH];
    int next = 0;
    *r = (struct run){ .sum = { 0 } };
    for (uint64_t i = 0; i < c->samples; i++) {
        if (i % BATCH == 0)
            subject_draw(
                &s, drawn, i,
                c->samples - i < BATCH ? (size_t)(c->samples - i) : BATCH, a);
        const struct bsdf_sample *w = &a[i % BATCH];
        const double x[WAYS] = {
            colours_mean(bsdf_bands(c->bsdf), w->weight) *
                subject_compression(&s, w->wi),
            by_uniform(&s, rng_uniform(even, i)),
        };
        for (int k = 0; k < WAYS; k++) {
            r->sum[k] += x[k];
            r->square[k] += x[k] * x[k];
        }
        if ((double)(i + 1) == c->point[next].n) {
            for (int k = 0; k < WAYS; k++)
                r->at[k][next] = r->sum[k] / c->point[next].n;
            next++;
        }
    }
}

static bool measure(struct convergence *c, struct err *err)
{
    struct run *run = calloc(RUNS, sizeof *run);
    if (!run)
        return err_set(err, "out of memory");
    for (uint64_t n = FIRST; n <= c->samples && c->points + 1 < POINTS_MAX;
         n *= 2)
        c->point[c->points++].n = (double)n;
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < RUNS; i++)
        sums_of(c, i, &run[i]);
    const double truth[WAYS] = { c->albedo.value, c->beside.value };
    for (int k = 0; k < WAYS; k++) {
        double sum = 0, square = 0;
        const double n = RUNS * (double)c->samples;
        for (int p = 0; p < c->points; p++) {
            double squares = 0;
            for (int i = 0; i < RUNS; i++) {
                const double off = run[i].at[k][p] - truth[k];
                squares += off * off;
            }
            c->point[p].rms[k] = sqrt(squares / RUNS);
        }
        for (int i = 0; i < RUNS; i++) {
            sum += run[i].sum[k];
            square += run[i].square[k];
        }
        c->deviation[k] = sqrt(fmax(square / n - sum / n * (sum / n), 0));
    }
    for (int p = 0; p < c->points; p++)
        c->point[p].one = fabs(run[0].at[WEIGHTS][p] - truth[WEIGHTS]);
    free(run);
    return true;
}

/* Of the bands' mean; the uniform directions meet no delta. */
static bool truths(struct convergence *c, struct err *err)
{
    const struct bands *bands = bsdf_bands(c->bsdf);
    struct estimate albedo[BANDS_MAX], beside[BANDS_MAX];
    struct spectrum v[4] = { { { 0 } } };
    if (!variant_energy(c->bsdf, c->wo, c->seed, albedo, beside, err))
        return false;
    for (int b = 0; b < bands->count; b++) {
        v[0].band[b] = albedo[b].value;
        v[1].band[b] = albedo[b].error;
        v[2].band[b] = beside[b].value;
        v[3].band[b] = beside[b].error;
    }
    c->albedo = (struct estimate){ colours_mean(bands, v[0]),
                                   colours_mean(bands, v[1]) };
    c->beside = (struct estimate){ colours_mean(bands, v[2]),
                                   colours_mean(bands, v[3]) };
    return c->albedo.value > 0 ||
           err_set(err, "convergence: the albedo is 0, so there is no error to "
                        "draw");
}

/* Whether a way has an error that is more than that of quadrature. */
static bool drawn(const struct convergence *c, int way)
{
    return c->deviation[way] > 1e-4 * c->albedo.value;
}

static void table_write(FILE *out, const struct convergence *c)
{
    table_head(out, c->bsdf, c->wo);
    fprintf(out,
            "# albedo by quadrature: %.17g +- %.2g, %.17g of it in no single "
            "direction; %s\n"
            "# seeds: %llu and the %d that follow\n"
            "# standard deviation of a weight: %.6g, of a uniform direction's "
            "value: %.6g\n"
            "# samples [1]\trms error of mean weights [1]\trms error of "
            "uniform directions [1]\terror of one run of the former [1]\n",
            c->albedo.value, c->albedo.error, c->beside.value,
            colours_mean_name(bsdf_bands(c->bsdf)), (unsigned long long)c->seed,
            RUNS - 1, c->deviation[WEIGHTS], c->deviation[UNIFORM]);
    for (int i = 0; i < c->points; i++) {
        const struct point *p = &c->point[i];
        const double row[] = { p->n, p->rms[WEIGHTS], p->rms[UNIFORM], p->one };
        table_row(out, row, sizeof row / sizeof *row);
    }
}

enum { PANEL = 320 };

static int curves_of(const struct convergence *c, struct chart_curve *curve)
{
    static const char *const names[WAYS] = { "mean weights",
                                             "uniform directions" };
    int n = 0;
    for (int k = 0; k < WAYS; k++) {
        if (!drawn(c, k))
            continue;
        curve[n] = (struct chart_curve){
            .x = "$1", .line = k ? 3 : 1, .as = CHART_BOTH, .point = k ? 5 : 7
        };
        snprintf(curve[n].y, sizeof curve[n].y, "$%d", 2 + k);
        snprintf(curve[n++].text, sizeof curve[0].text, "%s", names[k]);
        curve[n] = (struct chart_curve){ .x = "$1", .line = LINE_REFERENCE };
        snprintf(curve[n].y, sizeof curve[n].y, "%.10g/sqrt($1)",
                 c->deviation[k]);
        strcpy(curve[n++].text, k && drawn(c, WEIGHTS) ? "" : "s / √n");
    }
    if (drawn(c, WEIGHTS))
        curve[n++] = (struct chart_curve){
            .x = "$1", .y = "$4", .line = 8, .text = "one run of mean weights"
        };
    return n;
}

static void script_write(struct figure *fig, const struct convergence *c)
{
    struct chart_curve curve[2 * WAYS + 1];
    const int n = curves_of(c, curve);
    const struct angles wo = dir_to_degrees(c->wo);
    char below[200], bands[96], note[2][200];
    double least = INFINITY, most = 0;
    for (int i = 0; i < c->points; i++)
        for (int k = 0; k < WAYS; k++)
            if (drawn(c, k)) {
                const double line = c->deviation[k] / sqrt(c->point[i].n);
                most = fmax(most, fmax(c->point[i].rms[k], line));
                least = fmin(least, fmin(c->point[i].rms[k], line));
            }
    const bool floor_near = c->albedo.error > least / 100;
    const struct chart_mark mark = { .across = true,
                                     .at = c->albedo.error,
                                     .text = "quadrature's own error" };
    const double foot = 12 + 2 * CHART_NOTE;
    const double bottom = foot + 34 + CHART_BELOW;
    struct chart chart = {
        .y0 = bottom,
        .y1 = bottom + PANEL,
        .x = chart_axis_log(FIRST, c->point[c->points - 1].n, "samples n", "1"),
        .y = chart_axis_log(floor_near ? fmin(least, c->albedo.error) : least,
                            most, "error of the albedo", "1"),
        .curve = curve,
        .curves = n,
        .mark = &mark,
        .marks = floor_near,
    };
    bands_print(bsdf_bands(c->bsdf), bands, sizeof bands);
    snprintf(below, sizeof below, "ωₒ: θ = %.6g°, φ = %.6g°;  %s;  seed %llu",
             wo.theta_deg, wo.phi_deg, bands, (unsigned long long)c->seed);
    snprintf(note[0], sizeof note[0],
             "root mean square error of %d runs; albedo by quadrature %.6g ± "
             "%.1g (%s)",
             RUNS, c->albedo.value, c->albedo.error,
             bsdf_bands(c->bsdf)->kind == BANDS_NM ? "mean of the bands"
                                                   : "luminance");
    snprintf(note[1], sizeof note[1],
             "s: standard deviation of one sample, %.3g of weights, %.3g of "
             "uniform directions%s",
             c->deviation[WEIGHTS], c->deviation[UNIFORM],
             drawn(c, WEIGHTS) ? "" : "; every weight is the albedo");
    figure_page(fig, FIGURE_PAGE, bottom + PANEL + 18, bsdf_spec(c->bsdf),
                below);
    chart_notes(fig, foot, (const char *[]){ note[0], note[1] }, 2);
    chart_key(fig, curve, n, foot + 14);
    chart_column(&chart, 0, 1, false);
    chart_draw(fig, &chart);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct convergence c = { .bsdf = r->bsdf[0],
                             .wo = r->wo[0],
                             .seed = r->seed,
                             .samples = r->samples / RUNS };
    if (!truths(&c, err) || !measure(&c, err))
        return false;
    if (!drawn(&c, WEIGHTS) && !drawn(&c, UNIFORM))
        return err_set(
            err,
            "convergence: every sample has the weight of the albedo, "
            "%.6g, and there is no lobe that uniform directions "
            "would meet",
            c.albedo.value);
    if (!figure_open(&fig, r->output, &r->look, err))
        return false;
    table_write(fig.table, &c);
    script_write(&fig, &c);
    plot_caption(&fig, &plot_convergence, r, NULL,
                 "Root mean square error of the estimated albedo against the "
                 "number of samples, held against quadrature.");
    return figure_draw(&fig, made, err);
}

const struct plot plot_convergence = {
    .name = "convergence",
    .about = "the error of the albedo against the number of samples",
    .heeds = HEEDS_WO | HEEDS_SAMPLES,
    .run = run,
};
