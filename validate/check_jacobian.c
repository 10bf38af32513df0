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

#include "validate/jacobian.h"

enum { POINTS = JACOBIAN_POINTS, AROUND = 16384 };
static const double kink = 0.01, spoiled_share = 0.05;

struct room {
    struct jacobian_point point[POINTS];
    struct bsdf_sample around[AROUND];
};

/* Whether a sample near a point comes from elsewhere in u than the derivatives
 * say. */
static bool other_source(const struct room *r, const struct jacobian_point *p,
                         struct rng rng)
{
    const struct vec3 a = p->d[p->axis[0]], b = p->d[p->axis[1]];
    const double aa = vec3_dot(a, a), bb = vec3_dot(b, b), ab = vec3_dot(a, b);
    const double area2 = aa * bb - ab * ab;
    for (size_t i = 0; i < AROUND; i++) {
        const struct vec3 off = vec3_minus(r->around[i].wi, p->at.wi);
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
        const double u[3] = { v.x, v.y, v.z };
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
        const struct jacobian_point *p = &r->point[i];
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
    if (jacobian_points(s, r->point)) {
        judge(s, v, r);
    } else {
        v->value = NAN;
        verdict_note(v, "out of memory");
    }
    free(r);
}

const struct check check_jacobian = {
    .name = "jacobian",
    .about = "the pdf is the inverse of what sampling stretches",
    .run = run,
};
