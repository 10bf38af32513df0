/* partition.c - bins by the quantiles of pilot directions
 *
 * phi is measured from the pilots' mean azimuth, so that a lobe is not cut by
 * the seam at +- pi.
 */
#include "validate/partition.h"

#include <stdbool.h>
#include <stdlib.h>

enum { QUANTILES = 20, INTERVALS_MAX = 192 };
enum { COARSE_THETA = 5, COARSE_PHI = 4 };

/* Intervals between sorted edges, and the group of QUANTILES that each is in
 * or nearest to. */
struct cuts {
    size_t count;
    double edge[INTERVALS_MAX + 1];
    unsigned char quantile[INTERVALS_MAX];
};

struct side {
    double phi0;
    struct cuts theta;
    struct cuts phi[QUANTILES];      /* of the strips of each quantile */
    size_t first[INTERVALS_MAX + 1]; /* bin of each strip */
    size_t coarse;                   /* the first group */
};

struct partition {
    struct side side[2]; /* above and below */
    size_t bins, coarse;
    struct vec3 *pilot; /* by bins */
    size_t *first;      /* pilot of each bin; one more at the end */
};

struct polar {
    double theta, phi;
};

static double polar_theta(struct vec3 w)
{
    return atan2(sqrt(w.x * w.x + w.y * w.y), w.z);
}

static double polar_phi(struct vec3 w, double phi0)
{
    const double phi = atan2(w.y, w.x) - phi0;
    return phi < -PI ? phi + 2 * PI : phi >= PI ? phi - 2 * PI : phi;
}

static int by_theta(const void *a, const void *b)
{
    const double x = ((const struct polar *)a)->theta;
    const double y = ((const struct polar *)b)->theta;
    return (x > y) - (x < y);
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The interval that holds x; the ends belong to the outer ones.  Without a
 * branch on x, which no processor could predict. */
static size_t interval(const struct cuts *c, double x)
{
    size_t low = 0;
    for (size_t n = c->count; n > 1;) {
        const size_t half = n / 2;
        low = x < c->edge[low + half] ? low : low + half;
        n -= half;
    }
    return low;
}

/* Cuts [from, to] at the quantiles of n sorted values, at fewer of them where
 * the values are fewer, then grades the mesh. */
static void cut(struct cuts *c, const double *value, size_t n, double from,
                double to, double widest)
{
    double edge[QUANTILES + 1] = { from };
    unsigned char at_quantile[QUANTILES] = { 0 };
    size_t count = 1;
    for (size_t k = 1; k < QUANTILES; k++) {
        const size_t at = k * n / QUANTILES;
        const double x = at > 0 ? (value[at - 1] + value[at]) / 2 : from;
        if (x > edge[count - 1] && x < to) {
            at_quantile[count] = (unsigned char)k;
            edge[count++] = x;
        }
    }
    edge[count] = to;
    c->count =
        mesh_grade(edge, count + 1, widest, c->edge, INTERVALS_MAX + 1) - 1;
    for (size_t i = 0, k = 0; i < c->count; i++) {
        while (k + 1 < count && c->edge[i] >= edge[k + 1])
            k++;
        c->quantile[i] = at_quantile[k];
    }
}

/* value is room for n numbers. */
static void side_cut(struct side *s, double from, double to,
                     struct polar *pilot, size_t n, double *value, size_t *bins)
{
    qsort(pilot, n, sizeof *pilot, by_theta);
    for (size_t i = 0; i < n; i++)
        value[i] = pilot[i].theta;
    cut(&s->theta, value, n, from, to, PI / 8);
    /* Where a strip would have too few pilots, all strips take all of them. */
    const bool few = n < 10 * QUANTILES;
    for (size_t k = 0; k < QUANTILES; k++) {
        const size_t first = few ? 0 : k * n / QUANTILES;
        const size_t last = few ? n : (k + 1) * n / QUANTILES;
        for (size_t i = first; i < last; i++)
            value[i] = pilot[i].phi;
        qsort(value + first, last - first, sizeof *value, ascending);
        cut(&s->phi[k], value + first, last - first, -PI, PI, PI / 4);
    }
    for (size_t i = 0; i < s->theta.count; i++) {
        s->first[i] = *bins;
        *bins += s->phi[s->theta.quantile[i]].count;
    }
}

/* Keeps the pilots in the order of their bins. */
static bool pilots_keep(struct partition *p, const struct vec3 *pilot, size_t n)
{
    p->pilot = malloc((n + 1) * sizeof *p->pilot);
    p->first = calloc(p->bins + 2, sizeof *p->first);
    size_t *bin = malloc((n + 1) * sizeof *bin);
    const bool ok = p->pilot && p->first && bin;
    for (size_t i = 0; ok && i < n; i++) {
        bin[i] = partition_bin(p, pilot[i]);
        p->first[bin[i] + 1]++;
    }
    for (size_t k = 0; ok && k <= p->bins; k++)
        p->first[k + 1] += p->first[k];
    /* first[k] runs up to where k + 1 starts, and is put back. */
    for (size_t i = 0; ok && i < n; i++)
        p->pilot[p->first[bin[i]]++] = pilot[i];
    for (size_t k = p->bins + 1; ok && k > 0; k--)
        p->first[k] = p->first[k - 1];
    if (ok)
        p->first[0] = 0;
    free(bin);
    return ok;
}

struct partition *partition_new(const struct vec3 *pilot, size_t n)
{
    struct partition *p = calloc(1, sizeof *p);
    struct polar *polar = calloc(n + 1, sizeof *polar);
    double *value = calloc(n + 1, sizeof *value);
    if (!p || !polar || !value) {
        free(p);
        p = NULL;
        goto done;
    }
    for (int below = 0; below < 2; below++) {
        struct side *s = &p->side[below];
        double x = 0, y = 0;
        size_t count = 0;
        for (size_t i = 0; i < n; i++)
            if ((pilot[i].z < 0) == below) {
                x += pilot[i].x;
                y += pilot[i].y;
            }
        s->phi0 = atan2(y, x);
        for (size_t i = 0; i < n; i++)
            if ((pilot[i].z < 0) == below)
                polar[count++] = (struct polar){ polar_theta(pilot[i]),
                                                 polar_phi(pilot[i], s->phi0) };
        s->coarse = p->coarse;
        side_cut(s, below * PI / 2, (below + 1) * PI / 2, polar, count, value,
                 &p->bins);
        p->coarse += count == 0 ? 1 : COARSE_THETA * COARSE_PHI;
    }
    if (!pilots_keep(p, pilot, n)) {
        partition_free(p);
        p = NULL;
    }
done:
    free(polar);
    free(value);
    return p;
}

void partition_free(struct partition *p)
{
    if (!p)
        return;
    free(p->pilot);
    free(p->first);
    free(p);
}

size_t partition_bins(const struct partition *p)
{
    return p->bins;
}

size_t partition_coarse_bins(const struct partition *p)
{
    return p->coarse;
}

size_t partition_bin(const struct partition *p, struct vec3 w)
{
    if (!(vec3_dot(w, w) > 0.5)) /* not a number fails too */
        return p->bins;
    const struct side *s = &p->side[w.z < 0];
    const size_t i = interval(&s->theta, polar_theta(w));
    return s->first[i] +
           interval(&s->phi[s->theta.quantile[i]], polar_phi(w, s->phi0));
}

/* Where a bin is: its side, strip and slice. */
struct place {
    const struct side *side;
    const struct cuts *phi;
    size_t strip, slice;
};

static struct place place_of(const struct partition *p, size_t bin)
{
    const struct side *s = &p->side[bin >= p->side[1].first[0]];
    size_t i = s->theta.count - 1;
    while (s->first[i] > bin)
        i--;
    return (struct place){ s, &s->phi[s->theta.quantile[i]], i,
                           bin - s->first[i] };
}

size_t partition_coarse(const struct partition *p, size_t bin)
{
    const struct place at = place_of(p, bin);
    const size_t row = at.side->theta.quantile[at.strip];
    const size_t column = at.phi->quantile[at.slice];
    return at.side->coarse + row * COARSE_THETA / QUANTILES * COARSE_PHI +
           column * COARSE_PHI / QUANTILES;
}

struct patch partition_patch(const struct partition *p, size_t bin)
{
    const struct place at = place_of(p, bin);
    const double *theta = at.side->theta.edge + at.strip;
    const double *phi = at.phi->edge + at.slice;
    return (struct patch){ theta[0], theta[1], at.side->phi0 + phi[0],
                           at.side->phi0 + phi[1] };
}

void partition_integrate_bin(const struct partition *p, size_t bin,
                             sphere_fn *f, const void *context, int parts,
                             double tolerance, long *budget,
                             const struct vec3 *hint, size_t n,
                             struct estimate *out)
{
    for (int part = 0; part < parts; part++)
        out[part] = (struct estimate){ 0, 0 };
    patch_integrate(f, context, parts, partition_patch(p, bin), tolerance,
                    budget, hint, n, out);
}

void partition_integrate(const struct partition *p, sphere_fn *f,
                         const void *context, int parts, double tolerance,
                         long budget, struct estimate *out)
{
    for (size_t bin = 0; bin < p->bins; bin++, out += parts)
        partition_integrate_bin(p, bin, f, context, parts, tolerance, &budget,
                                p->pilot + p->first[bin],
                                p->first[bin + 1] - p->first[bin], out);
}
