/* sphere.c - quadrature in polar angles */
#include "validate/sphere.h"

#include <stdlib.h>

enum { ORDER = QUADRATURE_ORDER, NODES = ORDER * ORDER };

struct patch_job {
    sphere_fn *f;
    const void *context;
    int parts;
};

static void on_patch(const void *context, const double theta[ORDER],
                     const double phi[ORDER], double *value)
{
    const struct patch_job *j = context;
    double x[NODES], y[NODES], z[NODES], sine[ORDER], cp[ORDER], sp[ORDER];
    for (int k = 0; k < ORDER; k++) {
        cp[k] = cos(phi[k]);
        sp[k] = sin(phi[k]);
    }
    for (int i = 0, at = 0; i < ORDER; i++) {
        const double c = cos(theta[i]);
        sine[i] = sin(theta[i]);
        for (int k = 0; k < ORDER; k++, at++) {
            x[at] = sine[i] * cp[k];
            y[at] = sine[i] * sp[k];
            z[at] = c;
        }
    }
    j->f(j->context, NODES, (struct dirs){ x, y, z }, value);
    for (int part = 0, at = 0; part < j->parts; part++)
        for (int i = 0; i < ORDER; i++)
            for (int k = 0; k < ORDER; k++, at++)
                value[at] *= sine[i];
}

/* Where a direction is in a patch, and how large the integrand is there. */
static struct quadrature_hint hint_of(const struct patch_job *j, struct patch p,
                                      struct vec3 w)
{
    double value[QUADRATURE_PARTS_MAX];
    const double sine = sqrt(w.x * w.x + w.y * w.y);
    const double middle = (p.phi0 + p.phi1) / 2;
    struct quadrature_hint h = {
        .x = atan2(sine, w.z),
        .y = middle + remainder(atan2(w.y, w.x) - middle, 2 * PI),
    };
    j->f(j->context, 1, (struct dirs){ &w.x, &w.y, &w.z }, value);
    for (int part = 0; part < j->parts; part++)
        h.height = fmax(h.height, fabs(value[part]) * sine);
    return h;
}

void patch_integrate(sphere_fn *f, const void *context, int parts,
                     struct patch p, double tolerance, long *budget,
                     const struct vec3 *hint, size_t n, struct estimate *out)
{
    const struct patch_job j = { f, context, parts };
    struct quadrature_hint place[PATCH_HINTS_MAX];
    n = n < PATCH_HINTS_MAX ? n : PATCH_HINTS_MAX;
    for (size_t i = 0; i < n; i++)
        place[i] = hint_of(&j, p, hint[i]);
    quadrature(on_patch, &j, parts,
               (struct rectangle){ p.theta0, p.theta1, p.phi0, p.phi1 },
               tolerance, budget, place, n, out);
}

struct facing {
    double (*f)(struct vec3 w, const void *context);
    const void *context;
    struct vec3 wo;
};

/* theta as a share of the way to where w stops to face wo, or to the horizon:
 * w.wo = 0 at tan(theta) = -wo.z / (wo.x cos(phi) + wo.y sin(phi)).  So the
 * edge of what is faced is an edge of the mesh. */
static void on_share(const void *context, const double share[ORDER],
                     const double phi[ORDER], double *value)
{
    const struct facing *j = context;
    for (int k = 0; k < ORDER; k++) {
        const double c = cos(phi[k]), s = sin(phi[k]);
        const double along = j->wo.x * c + j->wo.y * s;
        const double last = along < 0 ? atan2(j->wo.z, -along) : PI / 2;
        for (int i = 0; i < ORDER; i++) {
            const double theta = share[i] * last, st = sin(theta);
            const struct vec3 w = { st * c, st * s, cos(theta) };
            value[i * ORDER + k] = st * last * j->f(w, j->context);
        }
    }
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

struct estimate
hemisphere_facing(double (*f)(struct vec3 w, const void *context),
                  const void *context, struct vec3 wo, double tolerance)
{
    enum { RINGS = 19, STEPS = 8, MARKS = 7, EDGES = 2 * STEPS * MARKS };
    const struct facing j = { f, context, wo };
    struct estimate total = { 0, 0 };
    long budget = 20000000;

    /* The axes, and the azimuths where the limit leaves the horizon. */
    double mark[MARKS] = { 0, PI / 2, PI, 3 * PI / 2, 2 * PI };
    const double turn = atan2(wo.y, wo.x);
    mark[5] = fmod(turn + 5 * PI / 2, 2 * PI);
    mark[6] = fmod(turn + 7 * PI / 2, 2 * PI);
    qsort(mark, MARKS, sizeof *mark, ascending);

    double phi[EDGES];
    size_t n = 0;
    phi[n++] = mark[0];
    for (int i = 0; i + 1 < MARKS; i++) {
        const double middle = (mark[i + 1] - mark[i]) / 2;
        if (!(middle > 1e-9))
            continue;
        for (int k = STEPS - 1; k >= 0; k--)
            phi[n++] = mark[i] + ldexp(middle, -k);
        for (int k = 1; k < STEPS; k++)
            phi[n++] = mark[i + 1] - ldexp(middle, -k);
        phi[n++] = mark[i + 1];
    }
    for (int ring = 0; ring < RINGS; ring++) {
        const double out = ldexp(1, -ring);
        const double in = ring == RINGS - 1 ? 0 : out / 2;
        for (size_t k = 0; k + 1 < n; k++)
            quadrature(on_share, &j, 1,
                       (struct rectangle){ in, out, phi[k], phi[k + 1] },
                       tolerance, &budget, NULL, 0, &total);
    }
    return total;
}

struct estimate hemisphere(double (*f)(struct vec3 w, const void *context),
                           const void *context)
{
    return hemisphere_facing(f, context, (struct vec3){ 0, 0, 1 }, 1e-11);
}
