/* partition.c - bins by the quantiles of pilot directions
 *
 * phi is measured from the pilots' mean azimuth, so that a lobe is not cut by
 * the seam at +- pi.
 */
#include "validate/partition.h"

#include <assert.h>
#include <stdlib.h>

enum { EDGES_MAX = 512 };

struct strip {
    size_t slices, first; /* number of bins, and the first of them */
    double phi[SLICES + 1];
};

struct side {
    double phi0;
    size_t strips;
    double theta[STRIPS + 1];
    struct strip strip[STRIPS];
    size_t coarse_first;
};

struct partition {
    struct side side[2]; /* above and below */
    size_t bins, coarse;
};

enum { COARSE_THETA = 5, COARSE_PHI = 4 };

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

static int by_phi(const void *a, const void *b)
{
    const double x = ((const struct polar *)a)->phi;
    const double y = ((const struct polar *)b)->phi;
    return (x > y) - (x < y);
}

/* Appends an edge between two pilots unless it would make an empty bin. */
static void edge_add(double *edges, size_t *n, double a, double b, double last)
{
    const double edge = a + (b - a) / 2;
    if (edge > edges[*n - 1] && edge < last)
        edges[(*n)++] = edge;
}

static void strip_cut(struct strip *s, struct polar *pilot, size_t n,
                      size_t *bins)
{
    size_t edges = 1;
    qsort(pilot, n, sizeof *pilot, by_phi);
    s->phi[0] = -PI;
    for (size_t k = 1; k < SLICES && n >= 2 * SLICES; k++) {
        const size_t at = k * n / SLICES;
        edge_add(s->phi, &edges, pilot[at - 1].phi, pilot[at].phi, PI);
    }
    s->phi[edges] = PI;
    s->slices = edges;
    s->first = *bins;
    *bins += edges;
}

static void side_cut(struct side *s, double from, double to,
                     struct polar *pilot, size_t n, size_t *bins)
{
    size_t edges = 1;
    qsort(pilot, n, sizeof *pilot, by_theta);
    s->theta[0] = from;
    for (size_t k = 1; k < STRIPS && n >= 2 * STRIPS; k++) {
        const size_t at = k * n / STRIPS;
        edge_add(s->theta, &edges, pilot[at - 1].theta, pilot[at].theta, to);
    }
    s->theta[edges] = to;
    s->strips = edges;
    for (size_t i = 0, first = 0; i < s->strips; i++) {
        size_t next = first;
        while (next < n &&
               (i + 1 == s->strips || pilot[next].theta < s->theta[i + 1]))
            next++;
        strip_cut(&s->strip[i], pilot + first, next - first, bins);
        first = next;
    }
}

struct partition *partition_new(const struct vec3 *pilot, size_t n)
{
    struct partition *p = calloc(1, sizeof *p);
    struct polar *polar = calloc(n ? n : 1, sizeof *polar);
    if (!p || !polar) {
        free(p);
        free(polar);
        return NULL;
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
        s->coarse_first = p->coarse;
        side_cut(s, below * PI / 2, (below + 1) * PI / 2, polar, count,
                 &p->bins);
        p->coarse += s->strips > 1 ? COARSE_THETA * COARSE_PHI : 1;
    }
    free(polar);
    return p;
}

void partition_free(struct partition *p)
{
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

/* The interval of n that holds x; the ends belong to the outer ones. */
static size_t interval(const double *edges, size_t n, double x)
{
    size_t low = 0, high = n;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        if (x < edges[middle])
            high = middle;
        else
            low = middle;
    }
    return low;
}

size_t partition_bin(const struct partition *p, struct vec3 w)
{
    if (!(vec3_dot(w, w) > 0.5)) /* not a number fails too */
        return p->bins;
    const struct side *s = &p->side[w.z < 0];
    const struct strip *t =
        &s->strip[interval(s->theta, s->strips, polar_theta(w))];
    return t->first + interval(t->phi, t->slices, polar_phi(w, s->phi0));
}

/* The strip that a bin is in, and its side. */
static const struct strip *strip_of(const struct partition *p, size_t bin,
                                    const struct side **side)
{
    const struct side *s = &p->side[bin >= p->side[1].strip[0].first];
    size_t i = s->strips - 1;
    while (s->strip[i].first > bin)
        i--;
    *side = s;
    return &s->strip[i];
}

size_t partition_coarse(const struct partition *p, size_t bin)
{
    const struct side *s;
    const struct strip *t = strip_of(p, bin, &s);
    const size_t i = (size_t)(t - s->strip), k = bin - t->first;
    return s->coarse_first + i * COARSE_THETA / s->strips * COARSE_PHI +
           k * COARSE_PHI / t->slices;
}

struct vec3 partition_centre(const struct partition *p, size_t bin)
{
    const struct side *s;
    const struct strip *t = strip_of(p, bin, &s);
    const size_t i = (size_t)(t - s->strip), k = bin - t->first;
    const double theta = (s->theta[i] + s->theta[i + 1]) / 2;
    const double phi = s->phi0 + (t->phi[k] + t->phi[k + 1]) / 2;
    return (struct vec3){ sin(theta) * cos(phi), sin(theta) * sin(phi),
                          cos(theta) };
}

/* Adds the mesh cells of one strip to its bins. */
static void strip_integrate(const struct strip *s, double phi0,
                            const double *theta, size_t thetas, sphere_fn *f,
                            const void *context, int parts, double tolerance,
                            long *budget, struct estimate *out)
{
    double phi[EDGES_MAX];
    const size_t phis =
        mesh_grade(s->phi, s->slices + 1, PI / 4, phi, EDGES_MAX);
    size_t slice = 0;
    for (size_t k = 0; k + 1 < phis; k++) {
        if (phi[k] >= s->phi[slice + 1])
            slice++;
        for (size_t i = 0; i + 1 < thetas; i++)
            patch_integrate(f, context, parts,
                            (struct patch){ theta[i], theta[i + 1],
                                            phi0 + phi[k], phi0 + phi[k + 1] },
                            tolerance, budget,
                            out + (s->first + slice) * (size_t)parts);
    }
}

void partition_integrate(const struct partition *p, sphere_fn *f,
                         const void *context, int parts, double tolerance,
                         long budget, struct estimate *out)
{
    for (size_t i = 0; i < p->bins * (size_t)parts; i++)
        out[i] = (struct estimate){ 0, 0 };
    for (int below = 0; below < 2; below++) {
        const struct side *s = &p->side[below];
        double theta[EDGES_MAX];
        const size_t thetas =
            mesh_grade(s->theta, s->strips + 1, PI / 8, theta, EDGES_MAX);
        size_t first = 0;
        for (size_t i = 0; i < s->strips; i++) {
            size_t last = first + 1;
            while (last + 1 < thetas && theta[last] < s->theta[i + 1])
                last++;
            strip_integrate(&s->strip[i], s->phi0, theta + first,
                            last - first + 1, f, context, parts, tolerance,
                            &budget, out);
            first = last;
        }
    }
}
