/* chart.c - stretched slopes of the half vector
 *
 * With h = (x, y, 1) / sqrt(1 + x^2 + y^2) and wi = 2 (wo.h) h - wo,
 *
 *   dwi = 4 (wo.h) dh,   dh = h.z^3 dx dy,
 *   wi.z > 0  where  wo.z (x^2 + y^2) < 2 (wo.x x + wo.y y) + wo.z,
 *
 * a disk that holds the origin, so that each ray from there leaves it once.
 *
 * B. Walter et al., Microfacet Models for Refraction through Rough Surfaces,
 * EGSR 2007, eq. 14 (dwi / dh).
 */
#include "tests/chart.h"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_sort.h>
#include <math.h>

#include "bsdf/bsdf.h"

enum { FINE = 12, ROUGH = 8, DEPTH_MAX = 48 };

/* Nodes and weights on [0, 1]. */
struct rule {
    int nodes;
    double x[FINE], weight[FINE];
};

static struct rule rule_of(int nodes)
{
    struct rule r = { .nodes = nodes };
    gsl_integration_glfixed_table *t =
        gsl_integration_glfixed_table_alloc((size_t)nodes);
    for (int i = 0; i < nodes; i++) {
        r.x[i] = r.weight[i] = NAN;
        if (t)
            gsl_integration_glfixed_point(0, 1, (size_t)i, &r.x[i],
                                          &r.weight[i], t);
    }
    gsl_integration_glfixed_table_free(t);
    return r;
}

static struct vec3 at(double theta, double phi)
{
    return (struct vec3){ sin(theta) * cos(phi), sin(theta) * sin(phi),
                          cos(theta) };
}

/* The product of a rule with itself over theta and phi. */
static double product(const struct chart *c, const struct rule *r,
                      struct patch p)
{
    double x[FINE * FINE], y[FINE * FINE], z[FINE * FINE], o[3][FINE * FINE];
    double pdf[FINE * FINE], sum = 0;
    const double dtheta = p.theta1 - p.theta0, dphi = p.phi1 - p.phi0;
    size_t n = 0;
    for (int i = 0; i < r->nodes; i++)
        for (int k = 0; k < r->nodes; k++, n++) {
            const struct vec3 w =
                at(p.theta0 + dtheta * r->x[i], p.phi0 + dphi * r->x[k]);
            x[n] = w.x, y[n] = w.y, z[n] = w.z;
            o[0][n] = c->wo.x, o[1][n] = c->wo.y, o[2][n] = c->wo.z;
        }
    bsdf_pdf_many(c->bsdf, n, (struct dirs){ o[0], o[1], o[2] },
                  (struct dirs){ x, y, z }, pdf);
    n = 0;
    for (int i = 0; i < r->nodes; i++) {
        double row = 0;
        for (int k = 0; k < r->nodes; k++)
            row += r->weight[k] * pdf[n++];
        sum += r->weight[i] * sin(p.theta0 + dtheta * r->x[i]) * row;
    }
    return sum * dtheta * dphi;
}

/* A point of the chart; near grazing what else varies is wo.h. */
struct point {
    double x, y, log_cos;
};

static struct point point_of(const struct chart *c, struct vec3 wi)
{
    const struct vec3 sum = vec3_add(c->wo, wi);
    return (struct point){ sum.x / sum.z / c->alpha_u,
                           sum.y / sum.z / c->alpha_v, log(vec3_length(sum)) };
}

/* How far apart two points are, in units of what the pdf varies over: 1 in the
 * lobe, and in its tails in proportion to the distance from the origin. */
static double apart(struct point a, struct point b, double least)
{
    return hypot(a.x - b.x, a.y - b.y) / fmax(1, least) +
           fabs(a.log_cos - b.log_cos);
}

static void add(const struct chart *c, const struct rule rule[2],
                struct patch p, int depth, double sum[2])
{
    static const double small = 0.7;
    struct point grid[3][3];
    double least = INFINITY, along[2] = { 0, 0 };
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            grid[i][k] =
                point_of(c, at(p.theta0 + (p.theta1 - p.theta0) * i / 2,
                               p.phi0 + (p.phi1 - p.phi0) * k / 2));
            least = fmin(least, hypot(grid[i][k].x, grid[i][k].y));
        }
    for (int i = 0; i < 3; i++) {
        along[0] = fmax(along[0], apart(grid[0][i], grid[1][i], least) +
                                      apart(grid[1][i], grid[2][i], least));
        along[1] = fmax(along[1], apart(grid[i][0], grid[i][1], least) +
                                      apart(grid[i][1], grid[i][2], least));
    }
    if (depth == DEPTH_MAX || fmax(along[0], along[1]) <= small) {
        for (int i = 0; i < 2; i++)
            sum[i] += product(c, &rule[i], p);
        return;
    }
    struct patch half[2] = { p, p };
    if (along[0] > along[1])
        half[0].theta1 = half[1].theta0 = (p.theta0 + p.theta1) / 2;
    else
        half[0].phi1 = half[1].phi0 = (p.phi0 + p.phi1) / 2;
    add(c, rule, half[0], depth + 1, sum);
    add(c, rule, half[1], depth + 1, sum);
}

struct estimate chart_mass(const struct chart *c, struct patch p)
{
    const struct rule rule[2] = { rule_of(FINE), rule_of(ROUGH) };
    double sum[2] = { 0, 0 };
    add(c, rule, p, 0, sum);
    return (struct estimate){ sum[0], fabs(sum[0] - sum[1]) };
}

struct ray {
    const struct chart *c;
    struct rule rule;
};

/* Where a ray leaves the disk. */
static double reach(const struct chart *c, double x, double y)
{
    const struct vec3 wo = c->wo;
    const double b = wo.x * x + wo.y * y, length2 = x * x + y * y;
    const double root = sqrt(b * b + wo.z * wo.z * length2);
    return b > 0 ? (b + root) / (wo.z * length2) : wo.z / (root - b);
}

static double along_ray(double psi, void *context)
{
    const struct ray *r = context;
    const struct chart *c = r->c;
    const double x = c->alpha_u * cos(psi), y = c->alpha_v * sin(psi);
    const double end = reach(c, x, y);
    double sum = 0, from = 0, to;
    for (; from < end; from = to) {
        to = fmin(fmax(from + 0.5, 1.4 * from), end);
        for (int i = 0; i < r->rule.nodes; i++) {
            const double rho = from + (to - from) * r->rule.x[i];
            const struct vec3 h =
                vec3_unit((struct vec3){ rho * x, rho * y, 1 });
            const double cos_d = vec3_dot(c->wo, h);
            sum += (to - from) * r->rule.weight[i] * rho * 4 * cos_d * h.z *
                   h.z * h.z *
                   bsdf_pdf(c->bsdf, c->wo, vec3_unit(vec3_reflect(c->wo, h)));
        }
    }
    return sum * c->alpha_u * c->alpha_v;
}

/* The rays reach far within half a turn, and hardly anywhere in the other; at
 * grazing the change is sudden, and stretching makes it more so. */
enum { STEPS = 10, EDGES = 2 * (2 * STEPS + 1) + 5 };

static size_t edges_of(const struct chart *c, double edge[EDGES])
{
    const double turn =
        atan2(-c->wo.x * c->alpha_u, c->wo.y * c->alpha_v) + 2 * PI;
    size_t n = 0;
    for (int i = 0; i < 2; i++) {
        const double change = fmod(turn + i * PI, 2 * PI);
        edge[n++] = change;
        for (int k = 0; k < STEPS; k++)
            for (int side = -1; side <= 1; side += 2)
                edge[n++] = fmod(change + side * ldexp(PI / 4, -2 * k) + 2 * PI,
                                 2 * PI);
    }
    for (int i = 0; i <= 4; i++)
        edge[n++] = i * PI / 2;
    gsl_sort(edge, 1, n);
    return n;
}

double chart_total(const struct chart *c)
{
    enum { PIECES = 500 };
    struct ray ray = { c, rule_of(FINE) };
    gsl_function f = { along_ray, &ray };
    gsl_integration_workspace *room = gsl_integration_workspace_alloc(PIECES);
    double edge[EDGES], sum = room ? 0 : NAN;
    const size_t n = edges_of(c, edge);
    for (size_t i = 0; room && i + 1 < n; i++) {
        double part, error;
        if (!(edge[i] < edge[i + 1]))
            continue;
        gsl_integration_qag(&f, edge[i], edge[i + 1], 1e-11, 0, PIECES,
                            GSL_INTEG_GAUSS15, room, &part, &error);
        sum += part;
    }
    gsl_integration_workspace_free(room);
    return sum;
}
