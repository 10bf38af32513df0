/* jacobian.c - finite differences of the map, and how much of u leads where */
#include "validate/jacobian.h"

#include <stdlib.h>

enum {
    POINTS = JACOBIAN_POINTS,
    AXES = 3,
    STEPS = 4, /* + and -, whole and half */
    SLICES = 32,
    BISECTIONS = 44
};

struct room {
    double u[AXES][POINTS * AXES * STEPS];
    struct bsdf_sample sample[POINTS * AXES * STEPS];
    struct jacobian_point point[POINTS];
    bool same[POINTS][SLICES];
};

static struct dirs numbers(const struct room *r)
{
    return (struct dirs){ r->u[0], r->u[1], r->u[2] };
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
        r->point[i] = (struct jacobian_point){ .u = { in[0], in[1], in[2] } };
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
static void differences(const struct subject *s, struct jacobian_point *p,
                        const struct bsdf_sample *sample)
{
    /* What the rounding of wi is worth in a difference, twice over. */
    const double rounding = 2 * s->claims.epsilon;
    double off[AXES], length[AXES], longest = 0;
    for (int a = 0; a < AXES; a++, sample += STEPS) {
        const double h = step_of(s, p->u[a]);
        for (int i = 0; i < STEPS; i++)
            p->usable &=
                subject_spread(&sample[i]) && sample[i].wi.z * p->at.wi.z > 0;
        const struct vec3 whole =
            vec3_scale(1 / (2 * h), vec3_minus(sample[0].wi, sample[1].wi));
        const struct vec3 half =
            vec3_scale(1 / h, vec3_minus(sample[2].wi, sample[3].wi));
        p->d[a] = vec3_scale(1. / 3, vec3_minus(vec3_scale(4, half), whole));
        off[a] = vec3_length(vec3_minus(half, whole)) + rounding / h;
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
           vec3_length(vec3_minus(a->wi, b->wi)) < 1e-6;
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
            struct jacobian_point *p = &r->point[i];
            r->same[i][k] = same_direction(&p->at, &r->sample[i]);
            p->overlap |= !r->same[i][k] && subject_spread(&r->sample[i]) &&
                          r->sample[i].wi.z * p->at.wi.z > 0;
        }
    }
    for (size_t i = 0; i < POINTS; i++) {
        const struct jacobian_point *p = &r->point[i];
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

bool jacobian_points(const struct subject *s, struct jacobian_point *point)
{
    struct room *r = malloc(sizeof *r);
    if (!r)
        return false;
    points_draw(s, r);
    points_differentiate(s, r);
    shares(s, r);
    for (size_t i = 0; i < POINTS; i++)
        point[i] = r->point[i];
    free(r);
    return true;
}
