/* beckmann.h - Gaussian slopes
 *
 *   P22(r2)   = exp(-r2) / pi
 *   Lambda(a) = exp(-a^2) / (2 a sqrt(pi)) - erfc(a) / 2
 *
 * Lambda is the exact form, not the rational fit that renderers use.
 *
 * Of the facets that w sees at a = cot(theta), a slope x in the plane of w has
 * the density a + x times exp(-x^2), and the share u that is seen of those
 * below x is inverted:
 *
 *   S(x) = int_x^inf (a + t) exp(-t^2) dt / sqrt(pi)
 *        = a erfc(x) / 2 + exp(-x^2) / (2 sqrt(pi)),    x > -a,
 *
 * falls from S(-a) to 0, and S(x) = (1 - u) S(-a) is what we seek.
 *
 * [1] P. Beckmann and A. Spizzichino, The Scattering of Electromagnetic Waves
 *     from Rough Surfaces, Pergamon, 1963.
 * [2] E. Heitz, Understanding the Masking-Shadowing Function in
 *     Microfacet-Based BRDFs, JCGT 3(2), 2014, sec. 5.
 * [3] W. Jakob, An Improved Visible Normal Sampling Routine for the Beckmann
 *     Distribution, 2014: why to invert in one dimension; the inversion below
 *     works on the upper tail and is not the one given there.
 * [4] A. Householder, The Numerical Treatment of a Single Nonlinear Equation,
 *     McGraw-Hill, 1970, sec. 4.4: the step of fourth order.
 */
#ifndef BSDF_BECKMANN_H
#define BSDF_BECKMANN_H

#include "bsdf/fastmath.h"
#include "bsdf/lanes.h"

#define SQRT_PI 1.77245385090551602730

INLINE double beckmann_p22(double r2)
{
    return fm_exp_minus(r2) * (1 / PI);
}

/* exp(-30^2) is 0, and so is Lambda from there on. */
INLINE double beckmann_lambda(double a)
{
    const double b = fm_min(a, 30);
    return fm_exp_minus(b * b) * (1 / (SQRT_PI * b) - fm_erfcx(b)) / 2;
}

/* Inverts the share u of slopes whose square is below r2: 1 - exp(-r2). */
INLINE double beckmann_r2_at(double u)
{
    return fm_minus_log1m(u);
}

/* exp(-x^2) is 4e-25 there, far below the least 1 - u, 2^-53. */
#define BECKMANN_SLOPE_MAX 7.5

/* What the inversion needs of w alone. */
struct beckmann_seen {
    double a;
    double all;           /* S(-a) */
    double toward, shift; /* from the limit a = 0 to that of a = inf */
    double edge;          /* how fast a + x leaves 0, over sqrt(u) */
    double bend;          /* ... and how soon it is slower */
};

/* From 1e20 on it is as if a were infinite. */
INLINE struct beckmann_seen beckmann_seen_at(double cot)
{
    const double a = fm_min(cot, 1e20), b = fm_min(a, 30);
    const double e = fm_exp_minus(b * b), f = fm_erfcx(b);
    const double inverse = 1 / ((0.6 + a) * (a + 0.56));
    return (struct beckmann_seen){
        .a = a,
        .all = a + e * (0.5 / SQRT_PI - a * f / 2),
        .toward = a * (a + 0.56) * inverse,
        .shift = 0.25 * (0.6 + a) * inverse,
        .edge = sqrt(1 + SQRT_PI * b * (2 / fm_max(e, 1e-300) - f)),
        .bend = fm_min(a, 5) / 2,
    };
}

/* What S at x is made of. */
struct beckmann_tail {
    double e; /* exp(-x^2) */
    double f; /* erfcx(|x|) */
};

INLINE double beckmann_e(double x)
{
    return fm_exp_minus(x * x);
}

INLINE double beckmann_f(double x)
{
    return fm_erfcx(fabs(x));
}

INLINE struct beckmann_tail beckmann_tail_at(double x)
{
    return (struct beckmann_tail){ beckmann_e(x), beckmann_f(x) };
}

/* S(x). */
INLINE double beckmann_above(double a, double x, struct beckmann_tail t)
{
    const double half = a * t.f / 2;
    return x < 0 ? a + t.e * (0.5 / SQRT_PI - half)
                 : t.e * (0.5 / SQRT_PI + half);
}

/* What S is to be for a share u. */
INLINE double beckmann_target(struct beckmann_seen w, double u)
{
    return (1 - u) * w.all;
}

/* A step of fourth order toward S(x) = target.  With s = a + x and n, d the
 * numerator and the denominator of Newton's, S' = -d = -s e / sqrt(pi),
 * S'' / S' = k / s and S''' / S' = (k^2 - 1 - 2 s^2) / s^2; one division. */
INLINE double beckmann_step(double a, double x, struct beckmann_tail t,
                            double target)
{
    const double n = beckmann_above(a, x, t) - target;
    const double s = a + x, k = 1 - 2 * x * s, ds = s * s * t.e / SQRT_PI;
    return n * s * (ds + n * k / 2) /
           (ds * (ds + n * k) + n * n * (k * k - 1 - 2 * s * s) / 6);
}

/* Slopes of either end, by which a start is found: Rayleigh's at u, and the
 * same at 1 - u. */
INLINE double beckmann_rayleigh(double u)
{
    return sqrt(fm_minus_log1m(u));
}

INLINE double beckmann_rayleigh_rest(double u)
{
    return sqrt(fm_minus_log(fm_max(u, 0x1p-60)));
}

/* Where to start: between Rayleigh's slopes at a = 0, r, and Gauss' at inf, to
 * whose mean 1 / (2 a) is added.  The Gaussian value is a fit in r and l, the
 * slopes of either end, that is good to .0013.  Near the edge, x > -a, the
 * density is linear first, and a + x at most edge r; never less than the last
 * bound here by much.  Off by .02 of the smaller of 1 and a + x as a rule,
 * rarely by .2. */
INLINE double beckmann_start(struct beckmann_seen w, double r, double l)
{
    const double p = r + l;
    const double gauss =
        (r - l) *
        (0.393952464 +
         p * (0.289458278 +
              p * (-0.0591557103 + p * (0.00567800939 - p * 0.000208750595))));
    const double edge = w.edge * r, least = edge / (1 + w.bend * edge);
    const double x = (1 - w.toward) * r + w.toward * (gauss + w.shift);
    return fm_min(fm_max(x, least - w.a), edge - w.a);
}

INLINE double beckmann_start_at(struct beckmann_seen w, double u)
{
    return beckmann_start(w, beckmann_rayleigh(u), beckmann_rayleigh_rest(u));
}

/* Whether a second step from x is the last; if not, as of less than one u in
 * thousand, the sure way is to be taken.  Fourth order: a last step of 2e-4 of
 * the local scale leaves 1e-15. */
INLINE bool beckmann_arrived(double a, double x, double step)
{
    return (fabs(x + step) <= BECKMANN_SLOPE_MAX) &
           (fabs(step) <= 2e-4 * fm_min(1, a + x + step));
}

/** By as many steps as it takes, within a bracket. */
double beckmann_slope_surely(double a, double u);

static inline double beckmann_slope(struct beckmann_seen w, double u)
{
    const double target = beckmann_target(w, u);
    double x = beckmann_start_at(w, u);
    x += beckmann_step(w.a, x, beckmann_tail_at(x), target);
    const double step = beckmann_step(w.a, x, beckmann_tail_at(x), target);
    return beckmann_arrived(w.a, x, step) ? x + step
                                          : beckmann_slope_surely(w.a, u);
}

#endif
