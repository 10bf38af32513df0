/* power.c - non-central distributions, solved for their parameter */
#include "validate/power.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>
#include <math.h>

static const double miss = 0.01;

/* P(X > x) of a non-central chi-square, the mixture of central ones over a
 * Poisson number of pairs of further degrees.  N. Johnson, S. Kotz and N.
 * Balakrishnan, Continuous Univariate Distributions 2, 1995, eq. 29.2. */
static double above(double x, double degrees, double lambda)
{
    const double mean = lambda / 2, reach = 8 * sqrt(mean) + 8;
    const unsigned first = mean > reach ? (unsigned)(mean - reach) : 0;
    double sum = 0;
    for (unsigned j = first; j <= mean + reach; j++)
        sum += gsl_ran_poisson_pdf(j, mean) *
               gsl_cdf_chisq_Q(x, degrees + 2 * (double)j);
    return sum;
}

double power_chi_square(long degrees, double level)
{
    const double n = (double)degrees;
    const double x = degrees > 0 ? gsl_cdf_chisq_Qinv(level, n) : NAN;
    if (!isfinite(x))
        return NAN;
    /* Where it is about normal, with variance 2 (n + 2 lambda), and beyond. */
    const double z = gsl_cdf_ugaussian_Qinv(miss);
    const double guess = x - n + 2 * z * (z + sqrt(z * z + x - n / 2)) + 1;
    double low = 0, high = 2 * guess;
    for (int i = 0; i < 40 && high - low > 1e-3 * high; i++) {
        /* Half way, but at first where it should be. */
        const double middle = i == 0 ? guess : (low + high) / 2;
        *(above(x, n, middle) < 1 - miss ? &low : &high) = middle;
    }
    return high;
}

double power_normal(double level)
{
    return gsl_cdf_ugaussian_Qinv(level / 2) + gsl_cdf_ugaussian_Qinv(miss);
}

double power_poisson(double mean, double level)
{
    mean = fmax(mean, 1e-12); /* GSL has none of 0 */
    unsigned k = (unsigned)mean;
    while (k < 1000000 && gsl_cdf_poisson_Q(k, mean) > level / 2)
        k++;
    /* Rejected from k + 1 on. */
    double low = 0, high = 2. * k + 20;
    for (int i = 0; i < 40; i++) {
        const double middle = (low + high) / 2;
        *(gsl_cdf_poisson_Q(k, mean + middle) < 1 - miss ? &low : &high) =
            middle;
    }
    return high;
}
