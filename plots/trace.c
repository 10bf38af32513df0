/* trace.c - angles where a line between neighbours is as good as the curve */
#include "plots/trace.h"

#include <gsl/gsl_sort.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plots/table.h"

enum { POINTS_MAX = 60000, DRAWS_APART = 16, CLOSER = 30 };

/* What a line may be off in the middle of an interval, and how far neighbours
 * may be apart; both of the largest value. */
static const double bend_max = 5e-4, step_max = 0.02;
static const double interval_min_deg = 1e-11;

static struct vec3 direction(const struct trace *l, double theta_deg)
{
    const struct vec3 w = dir_from_degrees(theta_deg, 0);
    return (struct vec3){ w.x * l->plane.x, w.x * l->plane.y, w.z };
}

static double angle(const struct trace *l, struct vec3 w)
{
    return atan2(vec3_dot(w, l->plane), w.z) * (180 / PI);
}

static struct trace_point at(struct trace *l, double theta_deg)
{
    struct trace_point p = { .theta_deg = theta_deg };
    const struct vec3 wi = direction(l, theta_deg);
    const struct spectrum f = bsdf_eval(l->bsdf, l->wo, wi);
    bool odd = false;
    for (int b = 0; b < l->bands; b++) {
        p.f[b] = f.band[b];
        p.f[l->bands + b] = f.band[b] * fabs(wi.z);
        odd |= !isfinite(f.band[b]);
    }
    for (int c = 0; c < 2 * l->bands; c++)
        if (isfinite(p.f[c]))
            l->most[c] = fmax(l->most[c], p.f[c]);
    l->odd += odd;
    return p;
}

double trace_most(const struct trace *l, bool cosine)
{
    double value = 0;
    for (int b = 0; b < l->bands; b++)
        value = fmax(value, l->most[cosine * l->bands + b]);
    return value;
}

/* Of a value at most 1, on a scale of logarithms from 0 to 1. */
static double height(double value)
{
    return 1 + log10(fmax(value, pow(10, -TRACE_DECADES))) / TRACE_DECADES;
}

/* Whether the line from a to b misses the curve at m, in their middle. */
static bool bent(const struct trace *l, const struct trace_point *a,
                 const struct trace_point *m, const struct trace_point *b,
                 bool log)
{
    for (int c = 0; c < 2 * l->bands; c++) {
        const double scale = trace_most(l, c >= l->bands);
        if (fabs(m->f[c] - (a->f[c] + b->f[c]) / 2) > bend_max * scale ||
            fabs(a->f[c] - b->f[c]) > step_max * scale)
            return true;
        if (log && scale > 0) {
            const double x = height(a->f[c] / scale);
            const double y = height(b->f[c] / scale);
            if (fabs(height(m->f[c] / scale) - (x + y) / 2) > 2 * bend_max ||
                fabs(x - y) > 2 * step_max)
                return true;
        }
    }
    return false;
}

/* Halves every interval that is not settled; false when all are.  The middle
 * stays in any case, as it may be the largest value. */
static bool refine(struct trace *l, struct trace_point *next, bool log)
{
    size_t n = 0;
    bool more = false;
    for (size_t i = 0; i < l->points; i++) {
        struct trace_point *a = &next[n++];
        *a = l->point[i];
        if (i + 1 == l->points || a->settled)
            continue;
        const struct trace_point *b = &l->point[i + 1];
        const double width = b->theta_deg - a->theta_deg;
        a->settled =
            !(width > interval_min_deg) || n + (l->points - i) >= POINTS_MAX;
        if (a->settled)
            continue;
        struct trace_point m = at(l, a->theta_deg + width / 2);
        a->settled = m.settled = !bent(l, a, &m, b, log);
        more |= !a->settled;
        next[n++] = m;
    }
    memcpy(l->point, next, n * sizeof *next);
    l->points = n;
    return more;
}

/* Angles ever closer to one; returns how many. */
static size_t closer(double *theta, double to)
{
    size_t n = 0;
    theta[n++] = to;
    for (int k = 1; k <= CLOSER; k++) {
        theta[n++] = to - ldexp(90, -k);
        theta[n++] = to + ldexp(90, -k);
    }
    return n;
}

/* Angles of some of the pilots; returns how many. */
static size_t drawn(const struct trace *l, double *theta)
{
    size_t kept = 0;
    for (size_t i = 0; i < l->pilots.n; i++)
        theta[i] = angle(l, l->pilots.wi[i]);
    gsl_sort(theta, 1, l->pilots.n);
    for (size_t i = 0; i < l->pilots.n; i += DRAWS_APART)
        theta[kept++] = theta[i];
    return kept;
}

/* Whether no band is unlike the first. */
static bool all_same(const struct trace *l)
{
    for (size_t i = 0; i < l->points; i++)
        for (int b = 1; b < l->bands; b++)
            if (l->point[i].f[b] != l->point[i].f[0])
                return false;
    return true;
}

static bool follow(struct trace *l, bool log, struct err *err)
{
    enum { GRID = 360, ANGLES = GRID + 1 + PILOTS_MAX + 4 * (2 * CLOSER + 1) };
    double *theta = malloc(ANGLES * sizeof *theta);
    struct trace_point *next = malloc(POINTS_MAX * sizeof *next);
    l->point = malloc(POINTS_MAX * sizeof *l->point);
    size_t n = 0;
    bool ok = false;
    if (!theta || !next || !l->point) {
        err_set(err, "out of memory");
        goto done;
    }
    for (int i = 0; i <= GRID; i++)
        theta[n++] = l->limit_deg * (2. * i / GRID - 1);
    n += closer(theta + n, l->wo_deg);
    n += closer(theta + n, l->mirror_deg);
    n += closer(theta + n, 90);
    n += closer(theta + n, -90);
    n += drawn(l, theta + n);
    gsl_sort(theta, 1, n);
    for (size_t i = 0; i < n; i++)
        if (fabs(theta[i]) <= l->limit_deg &&
            (i == 0 || theta[i] > theta[i - 1]))
            l->point[l->points++] = at(l, theta[i]);
    while (refine(l, next, log))
        ;
    l->same = all_same(l);
    ok = true;
done:
    free(theta);
    free(next);
    return ok;
}

void trace_write(FILE *out, const struct trace *l)
{
    const struct bands *bands = bsdf_bands(l->bsdf);
    const size_t n = (size_t)l->bands;
    table_head(out, l->bsdf, l->wo);
    if (l->incidence && l->wo_deg <= 0)
        fprintf(out,
                "# theta_i: of wi to the normal, in the plane of incidence; "
                "%s\n",
                l->wo_deg == 0 ? "> 0 toward phi = 0"
                               : "< 0 on the side of wo, > 0 on that of its "
                                 "mirror direction");
    else
        fprintf(out,
                "# theta_i: of wi to the normal, in the plane of phi = %.10g "
                "deg; > 0 toward it\n",
                l->phi_deg);
    fputs("# theta_i [deg]", out);
    table_columns(out, bands, "f [1/sr]");
    table_columns(out, bands, "f |cos theta_i| [1/sr]");
    fputc('\n', out);
    for (size_t i = 0; i < l->points; i++) {
        double row[1 + 2 * BANDS_MAX] = { l->point[i].theta_deg };
        memcpy(row + 1, l->point[i].f, 2 * n * sizeof *row);
        table_row(out, row, 1 + 2 * n);
    }
}

void trace_write_deltas(FILE *out, const struct trace *l)
{
    const struct bands *bands = bsdf_bands(l->bsdf);
    const size_t n = (size_t)l->bands;
    fputs("# single directions\n# theta_i [deg]\tprobability [1]", out);
    table_columns(out, bands, "weight [1]");
    fputc('\n', out);
    for (int k = 0; k < l->pilots.deltas; k++) {
        const struct delta *d = &l->pilots.delta[k];
        double row[2 + BANDS_MAX] = { angle(l, d->wi), d->pdf };
        memcpy(row + 2, d->weight.band, n * sizeof *row);
        table_row(out, row, 2 + n);
    }
}

/* Those of the single directions that are in the plane. */
static void deltas_in_plane(struct trace *l)
{
    const struct vec3 across = { -l->plane.y, l->plane.x, 0 };
    int kept = 0;
    for (int k = 0; k < l->pilots.deltas; k++)
        if (fabs(vec3_dot(l->pilots.delta[k].wi, across)) < 1e-9)
            l->pilots.delta[kept++] = l->pilots.delta[k];
    l->pilots.deltas = kept;
}

bool trace_make(struct trace *l, const struct bsdf *b, struct vec3 wo,
                double phi_deg, bool log, uint64_t seed, struct err *err)
{
    const double across = hypot(wo.x, wo.y);
    const bool back =
        wo.z < 0 || (bsdf_claims(b).lobes & BSDF_TRANSMISSION) != 0;
    *l = (struct trace){
        .bsdf = b,
        .wo = wo,
        .plane = across > 0 ? (struct vec3){ -wo.x / across, -wo.y / across, 0 }
                            : (struct vec3){ 1, 0, 0 },
        .limit_deg = back ? 180 : 90,
        .bands = bsdf_bands(b)->count,
    };
    if (!isnan(phi_deg)) {
        const struct vec3 given = dir_from_degrees(90, phi_deg);
        l->incidence =
            fabs(l->plane.x * given.y - l->plane.y * given.x) < 1e-12 ||
            across == 0;
        l->plane = (struct vec3){ given.x, given.y, 0 };
    } else {
        l->incidence = true;
    }
    l->phi_deg = dir_to_degrees(l->plane).phi_deg;
    const double theta = dir_to_degrees(wo).theta_deg;
    const struct vec3 mirror = { -wo.x, -wo.y, wo.z };
    const double side = vec3_dot(wo, l->plane) > 0 ? 1 : -1;
    l->wo_deg = l->incidence ? side * theta : angle(l, wo);
    l->mirror_deg = l->incidence ? -side * theta : angle(l, mirror);
    pilots_draw(&l->pilots, b, wo, seed);
    deltas_in_plane(l);
    return follow(l, log, err);
}

void trace_clear(struct trace *l)
{
    free(l->point);
    l->point = NULL;
}
