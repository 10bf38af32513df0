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
 * sample nearby comes from elsewhere in u, or the map jumps as it does where a
 * lobe is chosen by a number that moves the direction too, a pdf that is more
 * than the map gives may be that of overlapping lobes.  Such points are
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

/* Between two numbers on a line along an axis, what they lead to. */
struct between {
    double low, high;
    struct bsdf_sample at_low, at_high;
    double whole; /* how far apart that was at first */
};
enum { LOOKS = 1024, STEPS_MAX = 64 };

/* Directions along an axis through a point, at up to LOOKS numbers. */
static void line(const struct subject *s, const struct jacobian_point *p,
                 int axis, const double *at, size_t n, struct bsdf_sample *out)
{
    double u[3][LOOKS];
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            u[k][i] = k == axis ? at[i] : p->u[k];
    subject_sample(s, n, (struct dirs){ u[0], u[1], u[2] }, out);
}

/* How far apart two directions on one side are; 0 if they are not on one. */
static double distance(const struct bsdf_sample *a, const struct bsdf_sample *b)
{
    return subject_spread(a) && subject_spread(b) && a->wi.z * b->wi.z > 0
               ? vec3_length(vec3_minus(a->wi, b->wi))
               : 0;
}

/* How far two steps that follow one another are from being the same, over the
 * longer one. */
static double bend(const struct bsdf_sample *at)
{
    const double before = distance(&at[0], &at[1]);
    const double after = distance(&at[1], &at[2]);
    const struct vec3 off = vec3_minus(vec3_minus(at[2].wi, at[1].wi),
                                       vec3_minus(at[1].wi, at[0].wi));
    return before > 0 && after > 0 ? vec3_length(off) / fmax(before, after) : 0;
}

/* Steps that may be jumps: those that are unlike the ones beside them, and
 * those to or from what is refused. */
static size_t steps_find(const struct subject *s,
                         const struct jacobian_point *p, int axis,
                         struct between step[STEPS_MAX])
{
    const double unlike = 0.5;
    double at[LOOKS];
    struct bsdf_sample look[LOOKS];
    size_t n = 0;
    for (int i = 0; i < LOOKS; i++)
        at[i] = (i + 0.5) / LOOKS;
    line(s, p, axis, at, LOOKS, look);
    for (int i = 0; i + 1 < LOOKS && n < STEPS_MAX; i++)
        if (subject_spread(&look[i]) != subject_spread(&look[i + 1]) ||
            (i > 0 && bend(look + i - 1) > unlike) ||
            (i + 2 < LOOKS && bend(look + i) > unlike))
            step[n++] =
                (struct between){ at[i], at[i + 1], look[i], look[i + 1],
                                  distance(&look[i], &look[i + 1]) };
    return n;
}

/* Nearer to where most of a step is, or to where refusal ends: a lobe that is
 * cut off at the horizon is followed by one that begins elsewhere. */
static void step_halve(struct between *b, double middle,
                       const struct bsdf_sample *found)
{
    const bool low = subject_spread(&b->at_low);
    const bool high = subject_spread(&b->at_high);
    const bool here = subject_spread(found);
    const bool up = low && high ? !here || distance(found, &b->at_high) >
                                               distance(&b->at_low, found)
                                : here == low;
    *(up ? &b->low : &b->high) = middle;
    *(up ? &b->at_low : &b->at_high) = *found;
}

/* What is left of a step is most of it, or is refused on one side and far from
 * the horizon on the other. */
static bool is_jump(const struct between *b)
{
    const bool low = subject_spread(&b->at_low);
    const bool high = subject_spread(&b->at_high);
    return low && high ? distance(&b->at_low, &b->at_high) > 0.25 * b->whole
                       : fabs((low ? b->at_low : b->at_high).wi.z) > 0.05;
}

/* Whether the map jumps on the line along an axis through a point: so a lobe is
 * chosen by a number that moves the direction, and another lobe may lead to the
 * same one. */
static bool jumps(const struct subject *s, const struct jacobian_point *p,
                  int axis)
{
    enum { HALVINGS = 30 };
    struct between step[STEPS_MAX];
    const size_t n = steps_find(s, p, axis, step);
    for (int k = 0; k < HALVINGS; k++) {
        double middle[STEPS_MAX];
        struct bsdf_sample found[STEPS_MAX];
        for (size_t i = 0; i < n; i++)
            middle[i] = (step[i].low + step[i].high) / 2;
        line(s, p, axis, middle, n, found);
        for (size_t i = 0; i < n; i++)
            step_halve(&step[i], middle[i], &found[i]);
    }
    for (size_t i = 0; i < n; i++)
        if (is_jump(&step[i]))
            return true;
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
            if (overlaps > spoiled_share * POINTS || other_source(r, p, rng) ||
                jumps(s, p, p->axis[0]) || jumps(s, p, p->axis[1])) {
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
