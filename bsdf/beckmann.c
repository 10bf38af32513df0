/* beckmann.c - Gaussian slopes
 *
 *   P22(r2)   = exp(-r2) / pi
 *   Lambda(a) = exp(-a^2) / (2 a sqrt(pi)) - erfc(a) / 2
 *
 * Lambda is the exact form, not the rational fit that renderers use.
 *
 * [1] P. Beckmann and A. Spizzichino, The Scattering of Electromagnetic Waves
 *     from Rough Surfaces, Pergamon, 1963.
 * [2] E. Heitz, Understanding the Masking-Shadowing Function in
 *     Microfacet-Based BRDFs, JCGT 3(2), 2014, sec. 5.
 * [3] W. Jakob, An Improved Visible Normal Sampling Routine for the Beckmann
 *     Distribution, 2014: why to invert in one dimension; the inversion below
 *     works on the upper tail and is not the one given there.
 */
#include "bsdf/ndf.h"

#include <gsl/gsl_cdf.h>

static double p22(double r2)
{
    return exp(-r2) / PI;
}

static double lambda(double a)
{
    return (exp(-a * a) / (a * sqrt(PI)) - erfc(a)) / 2;
}

/* Inverts the share u of slopes whose square is below r2: 1 - exp(-r2). */
static double r2_at(double u)
{
    return -log1p(-u);
}

/* A standard normal value over sqrt(2); u = 0 stands for its half cell. */
static double gauss_at(double u)
{
    return (u < 0.5 ? gsl_cdf_ugaussian_Pinv(fmax(u, 0x1p-54))
                    : gsl_cdf_ugaussian_Qinv(1 - u)) /
           sqrt(2);
}

/* w sees a slope x at a = cot(theta) in proportion to a + x, so that
 *
 *   S(x) = int_x^inf (a + t) exp(-t^2) dt / sqrt(pi)
 *        = a erfc(x) / 2 + exp(-x^2) / (2 sqrt(pi)),    x > -a,
 *
 * falls from S(-a) to 0, and S(x) = (1 - u) S(-a) is what we seek: by Halley's
 * steps, kept inside the bracket by bisection. */
static double visible_slope(double a, double u)
{
    const double q = 1 / (2 * sqrt(PI));
    const double target = (1 - u) * (a * erfc(-a) / 2 + q * exp(-a * a));

    /* exp(-x^2) at 7.5 is 4e-25, far below the least 1 - u, 2^-53. */
    double low = fmax(-a, -7.5), high = 7.5;

    /* Between the limits for a = 0 (Rayleigh) and a = inf (Gauss, to whose
     * mean 1 / (2 a) is added); good to .1 for 0 <= a, two steps do. */
    const double toward = a / (0.6 + a);
    double x = (1 - toward) * sqrt(-log1p(-u)) +
               toward * (gauss_at(u) + 0.25 / (a + 0.56));
    for (int i = 0; i < 60; i++) {
        if (!(x > low && x < high))
            x = (low + high) / 2;
        const double e = exp(-x * x);
        const double s = a * erfc(x) / 2 + q * e - target;
        if (s > 0)
            low = x;
        else
            high = x;
        /* S' = -(a + x) e 2 q and S'' / S' = 1 / (a + x) - 2 x */
        const double newton = s / (2 * q * (a + x) * e);
        const double step = newton / (1 + newton * (1 / (a + x) - 2 * x) / 2);
        const double next = x + step;
        /* Cubic: a step of 1e-5 of the local scale leaves 1e-15. */
        if (next > -a && fabs(step) <= 1e-5 * fmin(1, a + next))
            return next;
        x = next;
    }
    return (low + high) / 2;
}

static struct vec3 visible(struct vec3 w, double u, double v)
{
    const double x = w.x > 0 ? visible_slope(w.z / w.x, u) : gauss_at(u);
    return (struct vec3){ x, gauss_at(v), 1 };
}

const struct ndf ndf_beckmann = {
    .name = "beckmann",
    .p22 = p22,
    .lambda = lambda,
    .r2_at = r2_at,
    .visible = visible,
};
