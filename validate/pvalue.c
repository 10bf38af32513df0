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

double pvalue_binomial(uint64_t k, uint64_t n, struct estimate q)
{
    double low = q.value - q.error, high = q.value + q.error;
    if (!(high >= 0 && low <= 1))
        return pvalue_impossible;
    low = fmax(low, 0);
    high = fmin(high, 1);
    const unsigned int count = (unsigned int)k, trials = (unsigned int)n;
    const double at_most = or_normal(gsl_cdf_binomial_P(count, low, trials),
                                     count, trials, low, false);
    const double at_least =
        count == 0 ? 1
                   : or_normal(gsl_cdf_binomial_Q(count - 1, high, trials),
                               count, trials, high, true);
    return bounded(2 * fmin(at_most, at_least));
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
