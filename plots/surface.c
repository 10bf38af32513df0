/* surface.c - meshes that follow a lobe however narrow it is */
#include "plots/surface.h"

#include <gsl/gsl_sort.h>
#include <stdlib.h>

#include "plots/colours.h"

enum { QUADS_MAX = 9000, PASSES_MAX = 24, CLOSER = 26 };

/* How far a chord may be from the surface, and how long it may be; both of the
 * largest radius of both sides. */
static const double bend_max = 0.0015, chord_max = 0.06;
static const double interval_min_deg = 1e-9;

/* -- radii ----------------------------------------------------------------- */

/* A direction from theta and from phi about the mirror direction. */
struct vec3 surface_direction(const struct surface *s, double theta_deg,
                              double phi_deg)
{
    return dir_from_degrees(theta_deg, phi_deg + s->mirror_phi_deg);
}

/* f |cos|, 0 where it is not a finite number. */
struct spectrum surface_value(const struct surface *s, struct vec3 wi)
{
    const struct spectrum f =
        spectrum_scale(fabs(wi.z), bsdf_eval(s->bsdf, s->wo, wi));
    const int n = bsdf_bands(s->bsdf)->count;
    for (int b = 0; b < n; b++)
        if (!isfinite(f.band[b]))
            return spectrum_of(n, 0);
    return f;
}

double surface_mean(const struct surface *s, struct vec3 wi)
{
    return fmax(colours_mean(bsdf_bands(s->bsdf), surface_value(s, wi)), 0);
}

double surface_radius(const struct surface *s, struct vec3 wi)
{
    const double mean = surface_mean(s, wi);
    return s->top > 0
               ? fmax(s->top * (1 + log10(mean / s->top) / SURFACE_DECADES), 0)
               : mean;
}

static double mean_most(const struct surface *s)
{
    return fmax(s->side[0].peak.mean, s->side[1].peak.mean);
}

double surface_largest(const struct surface *s)
{
    const double most = mean_most(s);
    return s->top > 0 ? s->top * (1 + log10(most / s->top) / SURFACE_DECADES)
                      : most;
}

/* -- the peak -------------------------------------------------------------- */

static void peak_try(const struct surface *s, const struct surface_side *side,
                     struct surface_peak *p, double theta_deg, double phi_deg)
{
    const double theta = fmin(fmax(theta_deg, side->from_deg), side->to_deg);
    const double mean = surface_mean(s, surface_direction(s, theta, phi_deg));
    if (mean > p->mean)
        *p = (struct surface_peak){ theta, remainder(phi_deg, 360), mean };
}

/* The best of a grid and of the pilots, then uphill by ever smaller steps. */
static void peak_find(const struct surface *s, struct surface_side *side)
{
    const double middle = (side->from_deg + side->to_deg) / 2;
    struct surface_peak p = { side->from_deg > 0 ? 180 : 0, 0, 0 };
    for (int i = 0; i <= 45; i++)
        for (int k = 0; k < 90; k++)
            peak_try(s, side, &p, side->from_deg + 2 * i, 4 * k);
    for (size_t i = 0; i < s->pilots.n; i++) {
        const struct angles a = dir_to_degrees(s->pilots.wi[i]);
        if ((a.theta_deg > 90) == (middle > 90))
            peak_try(s, side, &p, a.theta_deg, a.phi_deg - s->mirror_phi_deg);
    }
    for (double step = 2; step > 1e-9;) {
        const struct surface_peak was = p;
        const double across =
            fmin(step / fmax(sin(was.theta_deg * PI / 180), 1e-6), 90);
        peak_try(s, side, &p, was.theta_deg - step, was.phi_deg);
        peak_try(s, side, &p, was.theta_deg + step, was.phi_deg);
        peak_try(s, side, &p, was.theta_deg, was.phi_deg - across);
        peak_try(s, side, &p, was.theta_deg, was.phi_deg + across);
        if (!(p.mean > was.mean * (1 + 1e-12)))
            step /= 2;
    }
    side->peak = p;
}

/* -- the mesh -------------------------------------------------------------- */

static void lines_init(struct surface_lines *l, double from, double to,
                       double step, double peak)
{
    double all[SURFACE_LINES_MAX];
    const int steps = (int)lround((to - from) / step);
    size_t n = 0;
    for (int i = 0; i <= steps; i++)
        all[n++] = from + i * step;
    all[n++] = peak;
    for (int k = 1; k <= CLOSER; k++) {
        all[n++] = peak - ldexp(90, -k);
        all[n++] = peak + ldexp(90, -k);
    }
    gsl_sort(all, 1, n);
    l->n = 0;
    for (size_t i = 0; i < n; i++)
        if (all[i] >= from && all[i] <= to &&
            (l->n == 0 || all[i] > l->deg[l->n - 1]))
            l->deg[l->n++] = all[i];
}

/* Point k of a line of the mesh: theta is along[k] or across, phi the other. */
static struct vec3 point(const struct surface *s, bool of_phi, double along,
                         double across)
{
    const struct vec3 w = of_phi ? surface_direction(s, across, along)
                                 : surface_direction(s, along, across);
    return vec3_scale(surface_radius(s, w), w);
}

static double apart(struct vec3 a, struct vec3 b)
{
    return vec3_length(vec3_add(a, vec3_scale(-1, b)));
}

/* How far a point is from the line between two others. */
static double off_chord(struct vec3 p, struct vec3 a, struct vec3 b)
{
    const struct vec3 ab = vec3_add(b, vec3_scale(-1, a));
    const struct vec3 ap = vec3_add(p, vec3_scale(-1, a));
    const double length2 = vec3_dot(ab, ab);
    const double t =
        length2 > 0 ? fmin(fmax(vec3_dot(ap, ab) / length2, 0), 1) : 0;
    return apart(ap, vec3_scale(t, ab));
}

/* Halves intervals of the lines wherever one across has a chord that is not
 * good enough; false when there was none. */
static bool refine(const struct surface *s, struct surface_lines *l,
                   const struct surface_lines *across, bool of_phi)
{
    const double scale = surface_largest(s);
    struct surface_lines next = { .n = 0 };
    for (size_t i = 0; i < l->n; i++) {
        next.deg[next.n++] = l->deg[i];
        if (i + 1 == l->n || next.n + (l->n - i) > SURFACE_LINES_MAX ||
            !(l->deg[i + 1] - l->deg[i] > interval_min_deg))
            continue;
        const double x[3] = { l->deg[i], (l->deg[i] + l->deg[i + 1]) / 2,
                              l->deg[i + 1] };
        for (size_t k = 0; k < across->n; k++) {
            struct vec3 p[3];
            for (int j = 0; j < 3; j++)
                p[j] = point(s, of_phi, x[j], across->deg[k]);
            if (off_chord(p[1], p[0], p[2]) > bend_max * scale ||
                apart(p[0], p[2]) > chord_max * scale) {
                next.deg[next.n++] = x[1];
                break;
            }
        }
    }
    const bool more = next.n > l->n;
    *l = next;
    return more;
}

/* Whether chords from line a to line b may replace all that is between. */
static bool spare(const struct surface *s, const struct surface_lines *l,
                  size_t a, size_t b, const struct surface_lines *across,
                  bool of_phi, double slack)
{
    const double scale = surface_largest(s) * slack;
    for (size_t k = 0; k < across->n; k++) {
        const struct vec3 p = point(s, of_phi, l->deg[a], across->deg[k]);
        const struct vec3 q = point(s, of_phi, l->deg[b], across->deg[k]);
        if (apart(p, q) > chord_max * scale)
            return false;
        for (size_t i = a + 1; i < b; i++)
            if (off_chord(point(s, of_phi, l->deg[i], across->deg[k]), p, q) >
                bend_max * scale)
                return false;
    }
    return true;
}

static void prune(const struct surface *s, struct surface_lines *l,
                  const struct surface_lines *across, bool of_phi, double keep,
                  double slack)
{
    struct surface_lines kept = { .n = 0 };
    size_t last = 0;
    kept.deg[kept.n++] = l->deg[0];
    for (size_t i = 1; i + 1 < l->n; i++)
        if (l->deg[i] == keep ||
            !spare(s, l, last, i + 1, across, of_phi, slack)) {
            last = i;
            kept.deg[kept.n++] = l->deg[i];
        }
    kept.deg[kept.n++] = l->deg[l->n - 1];
    *l = kept;
}

static void mesh(const struct surface *s, struct surface_side *side)
{
    struct surface_lines *theta = &side->theta, *phi = &side->phi;
    const struct surface_peak *p = &side->peak;
    lines_init(theta, side->from_deg, side->to_deg, 5, p->theta_deg);
    lines_init(phi, -180, 180, 10, p->phi_deg);
    for (int pass = 0; pass < PASSES_MAX; pass++) {
        const bool more = refine(s, theta, phi, false);
        if (!refine(s, phi, theta, true) && !more)
            break;
    }
    for (double slack = 1; slack < 8; slack *= 1.25) {
        prune(s, theta, phi, false, p->theta_deg, slack);
        prune(s, phi, theta, true, p->phi_deg, slack);
        if (theta->n * phi->n <= QUADS_MAX)
            break;
    }
}

bool surface_present(const struct surface_side *side)
{
    return side->peak.mean > 0;
}

static void count_odd(struct surface *s)
{
    const int n = bsdf_bands(s->bsdf)->count;
    for (int below = 0; below < 2; below++) {
        const struct surface_side *side = &s->side[below];
        for (size_t i = 0; i < side->theta.n; i++)
            for (size_t k = 0; k < side->phi.n; k++) {
                const struct spectrum f = bsdf_eval(
                    s->bsdf, s->wo,
                    surface_direction(s, side->theta.deg[i], side->phi.deg[k]));
                bool odd = false;
                for (int b = 0; b < n; b++)
                    odd |= !isfinite(f.band[b]);
                s->odd += odd;
            }
    }
}

void surface_make(struct surface *s, const struct bsdf *b, struct vec3 wo,
                  bool log, uint64_t seed)
{
    *s = (struct surface){ .bsdf = b, .wo = wo };
    s->mirror_phi_deg =
        hypot(wo.x, wo.y) > 0 ? dir_to_degrees(wo).phi_deg + 180 : 0;
    if (s->mirror_phi_deg > 180)
        s->mirror_phi_deg -= 360;
    s->side[0] = (struct surface_side){ .from_deg = 0, .to_deg = 90 };
    s->side[1] = (struct surface_side){ .from_deg = 90, .to_deg = 180 };
    pilots_draw(&s->pilots, b, wo, seed);
    for (int below = 0; below < 2; below++)
        peak_find(s, &s->side[below]);
    if (log && mean_most(s) > 0)
        s->top = pow(10, ceil(log10(mean_most(s)) - 1e-9));
    for (int below = 0; below < 2; below++)
        if (surface_present(&s->side[below]))
            mesh(s, &s->side[below]);
    count_odd(s);
}
