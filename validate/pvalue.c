/* pvalue.c - tails by GSL
 *
 * Never 1 - CDF: that has no digits where they are needed.
 */
#include "validate/pvalue.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdbool.h>

const double pvalue_impossible = 1e-300;

static double bounded(double p)
{
    return !(p >= pvalue_impossible) ? pvalue_impossible : p > 1 ? 1 : p;
}

double pvalue_chi_square(double statistic, long degrees)
{
    return degrees < 1 ? 1
                       : bounded(gsl_cdf_chisq_Q(statistic, (double)degrees));
}

/* The normal tail where GSL's continued fraction does not converge: within some
 * 2 standard deviations of the mean, from 10^7 trials on. */
static double or_normal(double p, double k, double n, double q, bool above)
{
    const double z = (k - n * q) / sqrt(n * q * (1 - q));
    return !isnan(p) ? p
           : above   ? gsl_cdf_ugaussian_Q(z)
                     : gsl_cdf_ugaussian_P(z);
}

static double at_most(unsigned int k, unsigned int n, double q)
{
    return or_normal(gsl_cdf_binomial_P(k, q, n), k, n, q, false);
}

static double at_least(unsigned int k, unsigned int n, double q)
{
    return k == 0 ? 1
                  : or_normal(gsl_cdf_binomial_Q(k - 1, q, n), k, n, q, true);
}

double pvalue_binomial(uint64_t k, uint64_t n, struct estimate q)
{
    double low = q.value - q.error, high = q.value + q.error;
    if (!(high >= 0 && low <= 1))
        return pvalue_impossible;
    low = fmax(low, 0);
    high = fmin(high, 1);
    const unsigned int count = (unsigned int)k, trials = (unsigned int)n;
    return bounded(
        2 * fmin(at_most(count, trials, low), at_least(count, trials, high)));
}

double pvalue_binomial_uniform(uint64_t k, uint64_t n, double q, double u)
{
    const unsigned int count = (unsigned int)k, trials = (unsigned int)n;
    const double below = k == 0 ? 0 : at_most(count - 1, trials, q);
    const double above = k == n ? 0 : at_least(count + 1, trials, q);
    const double here = fmax(1 - below - above, 0);
    return bounded(2 * fmin(below + u * here, above + (1 - u) * here));
}

/* How far a mean is off what is known of its truth. */
static double excess(struct mean m, struct estimate truth)
{
    return fmax(fabs(m.value - truth.value) - truth.error, 0);
}

double pvalue_mean(struct mean m, struct estimate truth)
{
    const double n = (double)m.n, off = excess(m, truth);
    if (isnan(m.value + m.variance + truth.value + truth.error))
        return pvalue_impossible;
    /* off = sqrt(2 variance x / n) + 7 most x / (3 (n - 1)), for sqrt(x), where
     * the bound is 2 exp(-x) on each side. */
    const double a = 7 * m.most / (3 * (n - 1));
    const double b = sqrt(2 * m.variance / n);
    const double root = 2 * off / (b + sqrt(b * b + 4 * a * off));
    return off > 0 ? bounded(4 * exp(-root * root)) : 1;
}

double pvalue_mean_normal(struct mean m, struct estimate truth)
{
    const double z = excess(m, truth) / sqrt(m.variance / (double)m.n);
    return m.variance > 0 ? bounded(2 * gsl_cdf_ugaussian_Q(z)) : NAN;
}

double pvalue_best(const double *p, int n)
{
    double best = 1;
    for (int i = 0; i < n; i++)
        if (isnan(p[i]) || p[i] < best) /* a NaN stays */
            best = p[i];
    return n > 0 ? bounded(best * n) : 1;
}

double pvalue_sigma(double p)
{
    return fabs(gsl_cdf_ugaussian_Qinv(p / 2)); /* 0, not -0, at p = 1 */
}
