/* sphere.c - quadrature in polar angles */
#include "validate/sphere.h"

#include <gsl/gsl_sort.h>
#include <stdlib.h>

#include "bsdf/fastmath.h"
#include "bsdf/lanes.h"

enum { ORDER = QUADRATURE_ORDER, NODES = QUADRATURE_NODES, WIDE = 8 };

/* The integrand, and room for a batch of directions and what it is there. */
struct over {
    sphere_fn *f;
    const void *context;
    int parts;
    size_t rules, size; /* of a batch: the latter in directions */
    double *x, *y, *z, *sine, *value;
};

static bool over_make(struct over *o, size_t batch)
{
    o->rules = batch / NODES < 1                  ? 1
               : batch / NODES > QUADRATURE_RULES ? QUADRATURE_RULES
                                                  : batch / NODES;
    o->size = o->rules * NODES;
    const size_t each = o->size + WIDE;
    double *room = malloc((4 + (size_t)o->parts) * each * sizeof *room);
    o->x = room;
    if (!room)
        return false;
    o->y = room + each;
    o->z = room + 2 * each;
    o->sine = room + 3 * each;
    o->value = room + 4 * each;
    return true;
}

/* The directions of the nodes of n rules, ORDER angles each way.  A row is
 * written as a whole vector, of which the next row takes back what is too
 * much. */
LANES static void directions(const struct over *over, size_t n,
                             const double *theta, const double *phi)
{
    const struct over o = *over;
    double st[QUADRATURE_RULES * ORDER], ct[QUADRATURE_RULES * ORDER];
    double sp[QUADRATURE_RULES * ORDER + WIDE];
    double cp[QUADRATURE_RULES * ORDER + WIDE];
    LANES_LOOP
    for (size_t i = 0; i < n * ORDER; i++)
        fm_sincos(theta[i], &st[i], &ct[i]);
    LANES_LOOP
    for (size_t i = 0; i < n * ORDER; i++)
        fm_sincos(phi[i], &sp[i], &cp[i]);
    for (size_t i = n * ORDER; i < n * ORDER + WIDE; i++)
        sp[i] = cp[i] = 0;
    for (size_t rule = 0; rule < n * ORDER; rule += ORDER)
        for (size_t row = rule; row < rule + ORDER; row++) {
            const double s = st[row], c = ct[row];
            const size_t at = row * ORDER;
            LANES_LOOP
            for (size_t k = 0; k < WIDE; k++) {
                o.x[at + k] = s * cp[rule + k];
                o.y[at + k] = s * sp[rule + k];
                o.z[at + k] = c;
                o.sine[at + k] = s;
            }
        }
}

LANES static void product(size_t n, const double *a, const double *b,
                          double *out)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        out[i] = a[i] * b[i];
}

static void on_patches(const void *context, size_t n,
                       const double (*theta)[ORDER], const double (*phi)[ORDER],
                       double *value)
{
    const struct over *o = context;
    for (size_t at = 0, k; at < n; at += k) {
        k = n - at < o->rules ? n - at : o->rules;
        directions(o, k, theta[at], phi[at]);
        o->f(o->context, k * NODES, (struct dirs){ o->x, o->y, o->z },
             o->value);
        for (size_t part = 0; part < (size_t)o->parts; part++)
            product(k * NODES, o->value + part * k * NODES, o->sine,
                    value + (part * n + at) * NODES);
    }
}

/* Where n directions of o are in their patches, of which o->sine has the middle
 * of phi.  phi and that are within pi of one another and of 2 pi more. */
LANES static void places(const struct over *over, size_t n,
                         struct quadrature_hint *hint)
{
    const struct over o = *over;
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const double middle = o.sine[i];
        const double r = sqrt(o.x[i] * o.x[i] + o.y[i] * o.y[i]);
        const double off = fm_atan2(o.y[i], o.x[i]) - middle;
        const double turned = off > PI ? off - 2 * PI : off;
        hint[i].x = fm_atan2(r, o.z[i]);
        hint[i].y = middle + (off < -PI ? off + 2 * PI : turned);
        o.sine[i] = r;
    }
}

/* How large the integrand is at n directions, of which o->sine has the sine. */
LANES static void heights(const struct over *o, size_t n, const double *value,
                          struct quadrature_hint *hint)
{
    for (int part = 0; part < o->parts; part++, value += n)
        LANES_LOOP
    for (size_t i = 0; i < n; i++)
        hint[i].height = fm_max(fabs(value[i]) * o->sine[i], hint[i].height);
}

static void hints_fill(const struct over *o, size_t n,
                       struct quadrature_hint *hint)
{
    places(o, n, hint);
    for (size_t i = 0; i < n; i++)
        hint[i].height = 0;
    o->f(o->context, n, (struct dirs){ o->x, o->y, o->z }, o->value);
    heights(o, n, o->value, hint);
}

static size_t heeded(const struct patch_job *job)
{
    return job->n < PATCH_HINTS_MAX ? job->n : PATCH_HINTS_MAX;
}

/* Copies n directions of a job, from `at` on, behind those that wait. */
LANES static void wait(const struct over *over, size_t waiting,
                       const struct patch_job *job, size_t at, size_t n)
{
    const struct over o = *over;
    const struct dirs w = dirs_from(job->hint, at);
    const double middle = (job->patch.phi0 + job->patch.phi1) / 2;
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        o.x[waiting + i] = w.x[i];
        o.y[waiting + i] = w.y[i];
        o.z[waiting + i] = w.z[i];
        o.sine[waiting + i] = middle;
    }
}

/* Fills the hints of all jobs, one job's behind another's. */
static void hints_make(const struct over *o, const struct patch_job *job,
                       size_t jobs, struct quadrature_hint *hint)
{
    size_t waiting = 0;
    for (size_t i = 0; i < jobs; i++)
        for (size_t at = 0, n; at < heeded(&job[i]); at += n) {
            const size_t left = heeded(&job[i]) - at, room = o->size - waiting;
            n = left < room ? left : room;
            wait(o, waiting, &job[i], at, n);
            waiting += n;
            if (waiting == o->size) {
                hints_fill(o, waiting, hint);
                hint += waiting;
                waiting = 0;
            }
        }
    if (waiting > 0)
        hints_fill(o, waiting, hint);
}

bool patches_integrate(sphere_fn *f, const void *context, int parts,
                       const struct patch_job *job, size_t jobs,
                       quadrature_beside *beside, const void *mesh,
                       double tolerance, size_t batch, long *budget)
{
    struct over o = { .f = f, .context = context, .parts = parts };
    size_t hints = 0;
    for (size_t i = 0; i < jobs; i++)
        hints += heeded(&job[i]);
    struct quadrature_job *part = malloc((jobs + 1) * sizeof *part);
    struct quadrature_hint *hint = malloc((hints + 1) * sizeof *hint);
    bool ok = over_make(&o, batch) && part && hint;
    if (ok)
        hints_make(&o, job, jobs, hint);
    for (size_t i = 0, at = 0; ok && i < jobs; i++) {
        const struct patch p = job[i].patch;
        part[i] =
            (struct quadrature_job){ { p.theta0, p.theta1, p.phi0, p.phi1 },
                                     hint + at,
                                     heeded(&job[i]),
                                     job[i].out };
        at += heeded(&job[i]);
    }
    ok = ok && quadrature_joined(on_patches, &o, parts, part, jobs, beside,
                                 mesh, tolerance, budget);
    free(part);
    free(hint);
    free(o.x);
    return ok;
}

struct facing {
    double (*f)(struct vec3 w, const void *context);
    const void *context;
    struct vec3 wo;
};

/* theta as a share of the way to where w stops to face wo, or to the horizon:
 * w.wo = 0 at tan(theta) = -wo.z / (wo.x cos(phi) + wo.y sin(phi)).  So the
 * edge of what is faced is an edge of the mesh. */
static void on_share(const void *context, size_t n,
                     const double (*share)[ORDER], const double (*phi)[ORDER],
                     double *value)
{
    const struct facing *j = context;
    for (size_t rule = 0; rule < n; rule++, value += NODES)
        for (int k = 0; k < ORDER; k++) {
            const double c = cos(phi[rule][k]), s = sin(phi[rule][k]);
            const double along = j->wo.x * c + j->wo.y * s;
            const double last = along < 0 ? atan2(j->wo.z, -along) : PI / 2;
            for (int i = 0; i < ORDER; i++) {
                const double theta = share[rule][i] * last, st = sin(theta);
                const struct vec3 w = { st * c, st * s, cos(theta) };
                value[i * ORDER + k] = st * last * j->f(w, j->context);
            }
        }
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
    gsl_sort(mark, 1, MARKS);

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
    struct quadrature_job job[RINGS * EDGES];
    size_t jobs = 0;
    for (int ring = 0; ring < RINGS; ring++) {
        const double out = ldexp(1, -ring);
        const double in = ring == RINGS - 1 ? 0 : out / 2;
        for (size_t k = 0; k + 1 < n; k++)
            job[jobs++] = (struct quadrature_job){
                { in, out, phi[k], phi[k + 1] }, NULL, 0, &total
            };
    }
    if (!quadrature(on_share, &j, 1, job, jobs, tolerance, &budget))
        total = (struct estimate){ NAN, NAN };
    return total;
}

struct estimate hemisphere(double (*f)(struct vec3 w, const void *context),
                           const void *context)
{
    return hemisphere_facing(f, context, (struct vec3){ 0, 0, 1 }, 1e-11);
}
