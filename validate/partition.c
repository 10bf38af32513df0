/* partition.c - bins by the quantiles of pilot directions
 *
 * phi is measured from the pilots' mean azimuth, so that a lobe is not cut by
 * the seam at +- pi.
 */
#include "validate/partition.h"

#include <gsl/gsl_sort.h>
#include <stdbool.h>
#include <stdlib.h>

#include "bsdf/lanes.h"

enum { QUANTILES = 20, INTERVALS_MAX = 192 }; /* numbers of bytes */
enum { COARSE_THETA = 5, COARSE_PHI = 4 };

/* Intervals between sorted edges, and the group of QUANTILES that each is in
 * or nearest to. */
struct cuts {
    size_t count;
    double edge[INTERVALS_MAX + 1]; /* [rad] */
    double key[INTERVALS_MAX + 1];  /* what grows with the angle, see below */
    unsigned char quantile[INTERVALS_MAX];
};

struct side {
    double phi0, cos0, sin0;
    struct cuts theta;
    struct cuts phi[QUANTILES];      /* of the strips of each quantile */
    size_t first[INTERVALS_MAX + 1]; /* bin of each strip */
    bool empty;                      /* without pilots */
};

/* A strip as a search ends at it: its first bin, and what its slices are found
 * by. */
struct strip {
    uint32_t first, last; /* last: how many slices, less one */
    size_t keys;
};

/* The keys of all cuts one behind another, 2^steps of each with infinity behind
 * the last; those of theta above and below come first, then those of phi. */
struct search {
    int theta_steps, phi_steps;
    double *theta, *phi;
    struct strip strip[2][INTERVALS_MAX];
};

struct partition {
    struct side side[2]; /* above and below */
    struct search search;
    size_t bins;
    unsigned char *strip; /* of each bin */
    double *pilot;        /* x, y and z of all of them */
    struct dirs pilots;   /* the same, by bins */
    size_t *first;        /* pilot of each bin; one more at the end */
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

/* A direction is found by what grows with its angles and costs no arc
 * tangent: tan^2(theta), with a minus below the horizon, and the way round a
 * square instead of a circle.  Both keep all digits, at the normal and at the
 * horizon. */
INLINE double theta_key(struct vec3 w)
{
    const double tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return w.z < 0 ? -tan2 : tan2;
}

INLINE double square(double x, double y)
{
    const double d = fabs(x) + fabs(y) + 0x1p-1022, s = y / d;
    return x >= 0 ? s : copysign(2, y) - s;
}

static void keys_make(struct side *s)
{
    for (size_t i = 0; i <= s->theta.count; i++) {
        const double t = s->theta.edge[i];
        s->theta.key[i] = theta_key((struct vec3){ .x = sin(t), .z = cos(t) });
    }
    for (int k = 0; k < QUANTILES; k++)
        for (size_t i = 0; i <= s->phi[k].count; i++) {
            const double phi = s->phi[k].edge[i];
            s->phi[k].key[i] = square(cos(phi), sin(phi));
        }
}

static int max(int a, int b)
{
    return a > b ? a : b;
}

static int steps_for(size_t count)
{
    int steps = 0;
    while ((size_t)1 << steps < count)
        steps++;
    return steps;
}

static void keys_lay(const struct cuts *c, int steps, double *key)
{
    for (size_t i = 0; i < (size_t)1 << steps; i++)
        key[i] = i < c->count ? c->key[i] : INFINITY;
}

static bool search_make(struct partition *p)
{
    struct search *t = &p->search;
    for (int below = 0; below < 2; below++) {
        const struct side *s = &p->side[below];
        t->theta_steps = max(t->theta_steps, steps_for(s->theta.count));
        for (int k = 0; k < QUANTILES; k++)
            t->phi_steps = max(t->phi_steps, steps_for(s->phi[k].count));
    }
    t->theta = malloc((2 * sizeof *t->theta) << t->theta_steps);
    t->phi = malloc((2 * QUANTILES * sizeof *t->phi) << t->phi_steps);
    for (int below = 0; t->theta && t->phi && below < 2; below++) {
        const struct side *s = &p->side[below];
        keys_lay(&s->theta, t->theta_steps,
                 t->theta + ((size_t)below << t->theta_steps));
        for (int k = 0; k < QUANTILES; k++)
            keys_lay(&s->phi[k], t->phi_steps,
                     t->phi +
                         ((size_t)(below * QUANTILES + k) << t->phi_steps));
        for (size_t i = 0; i < s->theta.count; i++) {
            const size_t k = s->theta.quantile[i];
            t->strip[below][i] = (struct strip){
                (uint32_t)s->first[i], (uint32_t)s->phi[k].count - 1,
                (size_t)(below * QUANTILES + (int)k) << t->phi_steps
            };
        }
    }
    return t->theta && t->phi;
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
        gsl_sort(value + first, 1, last - first);
        cut(&s->phi[k], value + first, last - first, -PI, PI, PI / 4);
    }
    keys_make(s);
    for (size_t i = 0; i < s->theta.count; i++) {
        s->first[i] = *bins;
        *bins += s->phi[s->theta.quantile[i]].count;
    }
}

/* Directions on their way to a bin. */
struct sought {
    double theta[LANES_MAX], phi[LANES_MAX];     /* keys */
    uint64_t from[LANES_MAX];                    /* where theirs begin */
    uint64_t low[LANES_MAX];                     /* the interval found */
    uint64_t below[LANES_MAX], known[LANES_MAX]; /* 0 or 1 */
};

LANES static void keys_of(const struct side *side, size_t n, struct dirs w,
                          struct sought *t)
{
    const double c0 = side[0].cos0, s0 = side[0].sin0;
    const double c1 = side[1].cos0, s1 = side[1].sin0;
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct vec3 d = dirs_at(w, i);
        const double c = d.z < 0 ? c1 : c0, s = d.z < 0 ? s1 : s0;
        t->theta[i] = theta_key(d);
        t->phi[i] = square(d.x * c + d.y * s, d.y * c - d.x * s);
        t->below[i] = d.z < 0 ? 1 : 0;
        t->known[i] = vec3_dot(d, d) > 0.5 ? 1 : 0; /* not if it is a NaN */
    }
}

/* The intervals that hold the keys; the ends belong to the outer ones.  Without
 * a branch on the key, which no processor could predict, and a step of all
 * searches before the next of any, as a step waits for the one before. */
LANES static void search(const double *key, int steps, size_t n,
                         const double *sought, const uint64_t *from,
                         uint64_t *low)
{
    for (size_t i = 0; i < n; i++)
        low[i] = 0;
    for (uint64_t half = (uint64_t)1 << steps >> 1; half > 0; half /= 2)
        LANES_LOOP
    for (size_t i = 0; i < n; i++)
        low[i] += sought[i] < key[from[i] + low[i] + half] ? 0 : half;
}

/* n <= LANES_MAX */
static void find(const struct partition *p, size_t n, struct dirs w,
                 uint32_t *bin)
{
    const struct search *s = &p->search;
    const struct strip *strip[LANES_MAX];
    struct sought t;
    keys_of(p->side, n, w, &t);
    for (size_t i = 0; i < n; i++)
        t.from[i] = t.below[i] << s->theta_steps;
    search(s->theta, s->theta_steps, n, t.theta, t.from, t.low);
    for (size_t i = 0; i < n; i++) {
        /* A key as large as infinity has gone beyond the last. */
        const size_t last = p->side[t.below[i]].theta.count - 1;
        strip[i] = &s->strip[t.below[i]][t.low[i] < last ? t.low[i] : last];
        t.from[i] = strip[i]->keys;
    }
    search(s->phi, s->phi_steps, n, t.phi, t.from, t.low);
    for (size_t i = 0; i < n; i++) {
        const uint32_t slice = (uint32_t)t.low[i], last = strip[i]->last;
        const uint32_t at = strip[i]->first + (slice < last ? slice : last);
        bin[i] = t.known[i] ? at : (uint32_t)p->bins;
    }
}

static bool strips_keep(struct partition *p)
{
    p->strip = malloc(p->bins);
    size_t bin = 0;
    for (int below = 0; p->strip && below < 2; below++) {
        const struct side *s = &p->side[below];
        for (size_t i = 0; i < s->theta.count; i++)
            for (size_t k = s->phi[s->theta.quantile[i]].count; k > 0; k--)
                p->strip[bin++] = (unsigned char)i;
    }
    return p->strip;
}

/* Keeps the pilots in the order of their bins. */
static bool pilots_keep(struct partition *p, const struct vec3 *pilot, size_t n)
{
    p->pilot = malloc((3 * n + 1) * sizeof *p->pilot);
    p->first = calloc(p->bins + 2, sizeof *p->first);
    uint32_t *bin = malloc((n + 1) * sizeof *bin);
    const bool ok = p->pilot && p->first && bin;
    if (ok)
        p->pilots = (struct dirs){ p->pilot, p->pilot + n, p->pilot + 2 * n };
    for (size_t at = 0; ok && at < n; at += LANES_MAX) {
        double x[LANES_MAX], y[LANES_MAX], z[LANES_MAX];
        const size_t k = n - at < LANES_MAX ? n - at : LANES_MAX;
        for (size_t i = 0; i < k; i++)
            x[i] = pilot[at + i].x, y[i] = pilot[at + i].y,
            z[i] = pilot[at + i].z;
        find(p, k, (struct dirs){ x, y, z }, bin + at);
    }
    for (size_t i = 0; ok && i < n; i++)
        p->first[bin[i] + 1]++;
    for (size_t k = 0; ok && k <= p->bins; k++)
        p->first[k + 1] += p->first[k];
    /* first[k] runs up to where k + 1 starts, and is put back. */
    for (size_t i = 0; ok && i < n; i++) {
        const size_t at = p->first[bin[i]]++;
        p->pilot[at] = pilot[i].x;
        p->pilot[n + at] = pilot[i].y;
        p->pilot[2 * n + at] = pilot[i].z;
    }
    for (size_t k = p->bins + 1; ok && k > 0; k--)
        p->first[k] = p->first[k - 1];
    if (ok)
        p->first[0] = 0;
    free(bin);
    return ok;
}

struct partition *partition_new(const struct vec3 *pilot, size_t n, size_t m)
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
        s->cos0 = cos(s->phi0);
        s->sin0 = sin(s->phi0);
        for (size_t i = 0; i < n; i++)
            if ((pilot[i].z < 0) == below)
                polar[count++] = (struct polar){ polar_theta(pilot[i]),
                                                 polar_phi(pilot[i], s->phi0) };
        s->empty = count == 0;
        side_cut(s, below * PI / 2, (below + 1) * PI / 2, polar, count, value,
                 &p->bins);
    }
    if (!search_make(p) || !strips_keep(p) || !pilots_keep(p, pilot, n + m)) {
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
    free(p->search.theta);
    free(p->search.phi);
    free(p->strip);
    free(p->pilot);
    free(p->first);
    free(p);
}

size_t partition_bins(const struct partition *p)
{
    return p->bins;
}

void partition_find(const struct partition *p, size_t n, struct dirs w,
                    uint32_t *bin)
{
    for (size_t at = 0; at < n; at += LANES_MAX)
        find(p, n - at < LANES_MAX ? n - at : LANES_MAX, dirs_from(w, at),
             bin + at);
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
    const size_t i = p->strip[bin];
    return (struct place){ s, &s->phi[s->theta.quantile[i]], i,
                           bin - s->first[i] };
}

/* Rows and columns of a grouping. */
static const size_t rows[] = { QUANTILES, 1, COARSE_THETA };
static const size_t columns[] = { 1, QUANTILES, COARSE_PHI };

size_t partition_groups(const struct partition *p, enum partition_grouping by)
{
    size_t n = 0;
    for (int below = 0; below < 2; below++)
        n += p->side[below].empty ? 1 : rows[by] * columns[by];
    return n;
}

size_t partition_group(const struct partition *p, enum partition_grouping by,
                       size_t bin)
{
    const struct place at = place_of(p, bin);
    const size_t row = at.side->theta.quantile[at.strip];
    const size_t column = at.phi->quantile[at.slice];
    const size_t before = at.side == &p->side[0] ? 0
                          : p->side[0].empty     ? 1
                                                 : rows[by] * columns[by];
    return at.side->empty ? before
                          : before + row * rows[by] / QUANTILES * columns[by] +
                                column * columns[by] / QUANTILES;
}

struct patch partition_patch(const struct partition *p, size_t bin)
{
    const struct place at = place_of(p, bin);
    const double *theta = at.side->theta.edge + at.strip;
    const double *phi = at.phi->edge + at.slice;
    return (struct patch){ theta[0], theta[1], at.side->phi0 + phi[0],
                           at.side->phi0 + phi[1] };
}

/* The slice that holds an azimuth, of one strip. */
static size_t slice_at(const struct cuts *phi, double at)
{
    size_t low = 0, high = phi->count;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        if (at < phi->edge[middle])
            high = middle;
        else
            low = middle;
    }
    return low;
}

/* The bin beyond an edge of one; none beyond the normals and the horizon. */
static size_t bin_beside(const void *partition, size_t bin,
                         enum quadrature_side side, double *theta, double *phi)
{
    const struct place at = place_of(partition, bin);
    const struct side *s = at.side;
    (void)theta;
    if (side == QUADRATURE_Y0 || side == QUADRATURE_Y1) {
        const size_t last = at.phi->count - 1;
        if (side == QUADRATURE_Y0 ? at.slice > 0 : at.slice < last)
            return side == QUADRATURE_Y0 ? bin - 1 : bin + 1;
        *phi += side == QUADRATURE_Y0 ? 2 * PI : -2 * PI;
        return side == QUADRATURE_Y0 ? bin + last : bin - last;
    }
    if (side == QUADRATURE_X0 ? at.strip == 0 : at.strip + 1 == s->theta.count)
        return QUADRATURE_NONE;
    const size_t strip = side == QUADRATURE_X0 ? at.strip - 1 : at.strip + 1;
    const struct cuts *slices = &s->phi[s->theta.quantile[strip]];
    return s->first[strip] +
           (slices == at.phi ? at.slice : slice_at(slices, *phi - s->phi0));
}

bool partition_integrate(const struct partition *p, sphere_fn *f,
                         const void *context, int parts, double tolerance,
                         size_t batch, long budget, struct estimate *out)
{
    struct patch_job *job = malloc((p->bins + 1) * sizeof *job);
    bool ok = job;
    for (size_t bin = 0; ok && bin < p->bins; bin++) {
        job[bin] = (struct patch_job){
            .patch = partition_patch(p, bin),
            .hint = dirs_from(p->pilots, p->first[bin]),
            .n = p->first[bin + 1] - p->first[bin],
            .out = out + bin * (size_t)parts,
        };
        for (int part = 0; part < parts; part++)
            job[bin].out[part] = (struct estimate){ 0, 0 };
    }
    ok = ok && patches_integrate(f, context, parts, job, p->bins, bin_beside, p,
                                 tolerance, batch, &budget);
    free(job);
    return ok;
}
