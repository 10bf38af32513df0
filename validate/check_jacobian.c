/* check_jacobian.c - the pdf is what the map from u to wi makes of 1
 *
 *   pdf(wi) |d wi / d(u_a, u_b)| = s
 *
 * where u_a and u_b move the direction, the third number does not, and s is the
 * share of the third for which wi stays what it is: the probability of the
 * lobe.  A local test without bins, which no narrow lobe escapes.
 *
 * Derivatives are central differences of two steps, extrapolated; what the two
 * differ by is in the limit, with the precision and what rounding explains.
 * Where they differ by more than 1 % the map has a kink between them; where a
 * sample nearby comes from elsewhere in u the lobes overlap.  Such points are
 * counted, and where they are more than one in 20, or all three numbers move
 * the direction, the check does not apply.
 */
#include "validate/checks.h"

#include <stdio.h>
#include <stdlib.h>

enum {
    POINTS = 512,
    AXES = 3,
    STEPS = 4, /* + and -, whole and half */
    SLICES = 32,
    BISECTIONS = 44,
    AROUND = 16384
};
static const double kink = 0.01, spoiled_share = 0.05;

struct point {
    double u[AXES];
    struct bsdf_sample at;
    bool usable;
    int still;              /* the axis that does not move wi */
    int axis[2];            /* those that do */
    struct vec3 d[AXES];    /* d wi / d u, extrapolated */
    double det, step_error; /* relative */
    double share;           /* of the still axis */
    bool overlap;           /* another direction on the same side in there */
};

struct room {
    double u[AXES][POINTS * AXES * STEPS];
    struct bsdf_sample sample[POINTS * AXES * STEPS];
    struct point point[POINTS];
    struct bsdf_sample around[AROUND];
    bool same[POINTS][SLICES];
};

static struct dirs numbers(const struct room *r)
{
    return (struct dirs){ r->u[0], r->u[1], r->u[2] };
}

static struct vec3 minus(struct vec3 a, struct vec3 b)
{
    return vec3_add(a, vec3_scale(-1, b));
}

/* With rounding of e in wi and a map that is smooth on the scale of u, the
 * extrapolated difference is best where the fourth power of the step is e over
 * the step. */
static double step_of(const struct subject *s, double u)
{
    return pow(s->claims.epsilon, 0.2) / 2 * fmin(u, 1 - u);
}

static void set(struct room *r, size_t i, const double u[AXES])
{
    for (int a = 0; a < AXES; a++)
        r->u[a][i] = u[a];
}

static void points_draw(const struct subject *s, struct room *r)
{
    const struct rng rng = subject_rng(s, STREAM_JACOBIAN);
    for (size_t i = 0; i < POINTS; i++) {
        const struct vec3 u = rng_uniform(rng, i);
        /* Away from the ends, where maps are singular. */
        const double in[AXES] = { 0.005 + 0.99 * u.x, 0.005 + 0.99 * u.y,
                                  0.005 + 0.99 * u.z };
        r->point[i] = (struct point){ .u = { in[0], in[1], in[2] } };
        set(r, i, in);
    }
    subject_sample(s, POINTS, numbers(r), r->sample);
    for (size_t i = 0; i < POINTS; i++) {
        r->point[i].at = r->sample[i];
        r->point[i].usable = subject_spread(&r->sample[i]) &&
                             r->sample[i].pdf > 0 && isfinite(r->sample[i].pdf);
    }
}

/* Fills d, and how far the two steps differ, relative to the longest of the
 * three. */
static void differences(const struct subject *s, struct point *p,
                        const struct bsdf_sample *sample)
{
    double off[AXES], length[AXES], longest = 0;
    for (int a = 0; a < AXES; a++, sample += STEPS) {
        const double h = step_of(s, p->u[a]);
        for (int i = 0; i < STEPS; i++)
            p->usable &=
                subject_spread(&sample[i]) && sample[i].wi.z * p->at.wi.z > 0;
        const struct vec3 whole =
            vec3_scale(1 / (2 * h), minus(sample[0].wi, sample[1].wi));
        const struct vec3 half =
            vec3_scale(1 / h, minus(sample[2].wi, sample[3].wi));
        p->d[a] = vec3_scale(1. / 3, minus(vec3_scale(4, half), whole));
        off[a] = vec3_length(minus(half, whole));
        length[a] = vec3_length(p->d[a]);
        longest = fmax(longest, length[a]);
    }
    int moving = 0;
    p->still = -1;
    for (int a = 0; a < AXES; a++) {
        if (length[a] <= 1e-9 * longest)
            p->still = a;
        else if (moving < 2)
            p->axis[moving++] = a;
        else
            moving++;
    }
    p->usable &= moving == 2 && isfinite(longest);
    if (!p->usable)
        return;
    const int a = p->axis[0], b = p->axis[1];
    p->det = fabs(vec3_dot(vec3_cross(p->d[a], p->d[b]), p->at.wi));
    /* The error of an area, not of its sides, which may be nearly parallel. */
    p->step_error =
        (off[a] * length[b] + off[b] * length[a]) / fmax(p->det, 1e-300);
}

static void points_differentiate(const struct subject *s, struct room *r)
{
    for (size_t i = 0, at = 0; i < POINTS; i++)
        for (int a = 0; a < AXES; a++)
            for (int k = 0; k < STEPS; k++, at++) {
                double u[AXES] = { r->point[i].u[0], r->point[i].u[1],
                                   r->point[i].u[2] };
                u[a] += step_of(s, u[a]) * (k % 2 ? -1 : 1) / (k < 2 ? 1 : 2);
                set(r, at, u);
            }
    subject_sample(s, POINTS * AXES * STEPS, numbers(r), r->sample);
    for (size_t i = 0; i < POINTS; i++)
        if (r->point[i].usable)
            differences(s, &r->point[i], r->sample + i * AXES * STEPS);
}

static bool same_direction(const struct bsdf_sample *a,
                           const struct bsdf_sample *b)
{
    return subject_spread(a) && subject_spread(b) &&
           vec3_length(minus(a->wi, b->wi)) < 1e-6;
}

/* Asks every point again with another still number. */
static void ask_still(const struct subject *s, struct room *r,
                      const double *still)
{
    for (size_t i = 0; i < POINTS; i++) {
        double u[AXES] = { r->point[i].u[0], r->point[i].u[1],
                           r->point[i].u[2] };
        if (r->point[i].usable)
            u[r->point[i].still] = still[i];
        set(r, i, u);
    }
    subject_sample(s, POINTS, numbers(r), r->sample);
}

/* How much of the still axis leads to the same direction: slices tell where,
 * and bisection finds the one or two ends. */
static void shares(const struct subject *s, struct room *r)
{
    double in[POINTS][2], out[POINTS][2], try[POINTS];
    for (int k = 0; k < SLICES; k++) {
        for (size_t i = 0; i < POINTS; i++)
            try[i] = (k + 0.5) / SLICES;
        ask_still(s, r, try);
        for (size_t i = 0; i < POINTS; i++) {
            struct point *p = &r->point[i];
            r->same[i][k] = same_direction(&p->at, &r->sample[i]);
            p->overlap |= !r->same[i][k] && subject_spread(&r->sample[i]) &&
                          r->sample[i].wi.z * p->at.wi.z > 0;
        }
    }
    for (size_t i = 0; i < POINTS; i++) {
        const struct point *p = &r->point[i];
        const double u = p->usable ? p->u[p->still] : 0.5;
        in[i][0] = in[i][1] = u;
        out[i][0] = 0, out[i][1] = 1;
        for (int k = 0; k < SLICES; k++) {
            const double z = (k + 0.5) / SLICES;
            double *bound = z < u ? &out[i][0] : &out[i][1];
            if (!r->same[i][k] && fabs(z - u) < fabs(*bound - u))
                *bound = z;
        }
        for (int end = 0; end < 2; end++)
            for (int k = 0; k < SLICES; k++) {
                const double z = (k + 0.5) / SLICES;
                if (r->same[i][k] && z > out[i][0] && z < out[i][1] &&
                    (end ? z > in[i][1] : z < in[i][0]))
                    in[i][end] = z;
            }
    }
    for (int end = 0; end < 2; end++)
        for (int step = 0; step < BISECTIONS; step++) {
            for (size_t i = 0; i < POINTS; i++)
                try[i] = (in[i][end] + out[i][end]) / 2;
            ask_still(s, r, try);
            for (size_t i = 0; i < POINTS; i++) {
                const bool inside =
                    same_direction(&r->point[i].at, &r->sample[i]);
                *(inside ? &in[i][end] : &out[i][end]) = try[i];
            }
        }
    for (size_t i = 0; i < POINTS; i++)
        r->point[i].share = in[i][1] - in[i][0];
}

/* Whether a sample near a point comes from elsewhere in u than the derivatives
 * say. */
static bool other_source(const struct room *r, const struct point *p,
                         struct rng rng)
{
    const struct vec3 a = p->d[p->axis[0]], b = p->d[p->axis[1]];
    const double aa = vec3_dot(a, a), bb = vec3_dot(b, b), ab = vec3_dot(a, b);
    const double area2 = aa * bb - ab * ab;
    for (size_t i = 0; i < AROUND; i++) {
        const struct vec3 off = minus(r->around[i].wi, p->at.wi);
        if (!subject_spread(&r->around[i]) ||
            r->around[i].wi.z * p->at.wi.z <= 0)
            continue;
        /* Where in u the linear map puts it. */
        const double oa = vec3_dot(off, a), ob = vec3_dot(off, b);
        const double da = (oa * bb - ob * ab) / area2;
        const double db = (ob * aa - oa * ab) / area2;
        if (!(fabs(da) < 0.05 && fabs(db) < 0.05))
            continue;
        const struct vec3 v = rng_uniform(rng, i);
        const double u[AXES] = { v.x, v.y, v.z };
        const double x = u[p->axis[0]] - p->u[p->axis[0]] - da;
        const double y = u[p->axis[1]] - p->u[p->axis[1]] - db;
        if (fabs(x - round(x)) > 0.2 || fabs(y - round(y)) > 0.2)
            return true;
    }
    return false;
}

static void judge(const struct subject *s, struct verdict *v, struct room *r)
{
    const struct rng rng = subject_rng(s, STREAM_PILOT);
    int used = 0, kinks = 0, overlaps = 0;
    bool drawn = false;
    for (size_t i = 0; i < POINTS; i++) {
        const struct point *p = &r->point[i];
        if (!p->usable)
            continue;
        used++;
        if (!(p->step_error <= kink)) {
            kinks++;
            continue;
        }
        if (p->overlap) {
            overlaps++;
            continue;
        }
        const double got = p->at.pdf * p->det / p->share;
        const double off = fabs(got - 1);
        double limit = subject_precision(s) + 2 * p->step_error;
        const double best = v->value / v->limit;
        if (!(off / limit > best) && !isnan(off))
            continue;
        limit += subject_rounding(s, p->at.wi, true);
        if (!(off / limit > best) && !isnan(off))
            continue;
        if (off > limit && got > 1) {
            /* More than this source gives: is there another one? */
            if (!drawn)
                subject_draw(s, rng, 0, AROUND, r->around);
            drawn = true;
            if (other_source(r, p, rng)) {
                overlaps++;
                continue;
            }
        }
        v->value = off;
        v->limit = limit;
        v->has_wi = true;
        v->wi = p->at.wi;
        verdict_note(v, "pdf |det| / share = %.8g", got);
    }
    if (used < 32) {
        v->applies = false;
        verdict_note(v, "%d of %d points move with just two numbers", used,
                     POINTS);
    } else if (kinks + overlaps > spoiled_share * used) {
        v->applies = false;
        verdict_note(v, "%d of %d points at kinks, %d where lobes overlap",
                     kinks, used, overlaps);
    } else {
        verdict_add(v, ", at worst of %d points", used - kinks - overlaps);
        verdict_found(v, "a pdf wrong by %.1g %%, in one place of %.2g",
                      100 * v->limit, used / log(100));
    }
}

static void run(const struct subject *s, struct verdict *v)
{
    if (!(s->claims.lobes & ~(unsigned)BSDF_DELTA)) {
        v->applies = false;
        verdict_note(v, "only delta lobes");
        return;
    }
    struct room *r = malloc(sizeof *r);
    v->unit = "relative";
    v->limit = subject_precision(s);
    if (!r) {
        v->value = NAN;
        verdict_note(v, "out of memory");
        return;
    }
    points_draw(s, r);
    points_differentiate(s, r);
    shares(s, r);
    judge(s, v, r);
    free(r);
}

const struct check check_jacobian = {
    .name = "jacobian",
    .about = "the pdf is the inverse of what sampling stretches",
    .run = run,
};
