/* pvalue.c - tails by GSL
 *
 * Never 1 - CDF: that has no digits where they are needed.
 */
#include "validate/pvalue.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

static double bounded(double p)
{
    return p < 1e-300 ? 1e-300 : p > 1 ? 1 : p;
}

double pvalue_chi_square(double statistic, long degrees)
{
    return degrees < 1 ? 1
                       : bounded(gsl_cdf_chisq_Q(statistic, (double)degrees));
}

double pvalue_binomial(uint64_t k, uint64_t n, struct estimate q)
{
    double low = q.value - q.error, high = q.value + q.error;
    if (!(high >= 0 && low <= 1))
        return bounded(0);
    low = fmax(low, 0);
    high = fmin(high, 1);
    const unsigned int count = (unsigned int)k, trials = (unsigned int)n;
    const double at_most = gsl_cdf_binomial_P(count, low, trials);
    const double at_least =
        count == 0 ? 1 : gsl_cdf_binomial_Q(count - 1, high, trials);
    return bounded(2 * fmin(at_most, at_least));
}

double pvalue_best(const double *p, int n)
{
    double best = 1;
    for (int i = 0; i < n; i++)
        best = fmin(best, p[i]);
    return bounded(best * n);
}

double pvalue_sigma(double p)
{
    return fabs(gsl_cdf_ugaussian_Qinv(p / 2)); /* 0, not -0, at p = 1 */
}
