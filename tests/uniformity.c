/* uniformity.c - Kolmogorov, Smirnov, Clopper and Pearson
 *
 *   P(K >= x)  = 2 sum_{k >= 1} (-1)^(k-1) exp(-2 k^2 x^2) [1] = 1 - sqrt(2 pi)
 * / x sum_{k odd} exp(-k^2 pi^2 / (8 x^2))     [2] P(D+ >= d) = d sum_{j =
 * 0}^{n (1 - d)} C(n, j) (d + j/n)^(j-1) (1 - d - j/n)^(n-j)               [3]
 *
 * The first series serves large x and the second small ones; all terms of the
 * third are positive.
 *
 * [1] A. Kolmogorov, Sulla determinazione empirica di una legge di
 *     distribuzione, Giorn. Ist. Ital. Attuari 4, 1933.
 * [2] W. Feller, On the Kolmogorov-Smirnov Limit Theorems for Empirical
 *     Distributions, Annals of Mathematical Statistics 19(2), 1948, eq. 1.4.
 * [3] Z. Birnbaum and F. Tingey, One-sided Confidence Contours for Probability
 *     Distribution Functions, Annals of Mathematical Statistics 22(4), 1951.
 * [4] C. Clopper and E. Pearson, The Use of Confidence or Fiducial Limits
 *     Illustrated in the Case of the Binomial, Biometrika 26(4), 1934.
 */
#include "tests/uniformity.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sf_gamma.h>
#include <gsl/gsl_sort.h>
#include <math.h>

#include "bsdf/vec.h"

double kolmogorov_tail(double x)
{
    double sum = 0;
    if (!(x > 0))
        return isnan(x) ? 0 : 1;
    if (x < 1) {
        for (int k = 1; k < 20; k += 2)
            sum += exp(-(double)(k * k) * PI * PI / (8 * x * x));
        return 1 - sqrt(2 * PI) / x * sum;
    }
    for (int k = 1; k < 20; k++)
        sum += (k % 2 ? 2 : -2) * exp(-2 * (double)(k * k) * x * x);
    return sum;
}

double smirnov_tail(size_t n, double d)
{
    const double count = (double)n;
    double sum = 0;
    if (!(d > 0) || n == 0)
        return isnan(d) ? 0 : 1;
    for (size_t j = 0; j < n; j++) {
        const double at = d + (double)j / count;
        if (at >= 1)
            break;
        sum +=
            exp(log(d) + gsl_sf_lnchoose((unsigned)n, (unsigned)j) +
                ((double)j - 1) * log(at) + (count - (double)j) * log1p(-at));
    }
    return fmin(sum, 1);
}

struct uniformity uniformity_of(double *value, size_t n)
{
    struct uniformity u = { .n = n, .p = 1, .p_above = 1 };
    const double count = (double)n;
    for (size_t i = 0; i < n; i++)
        if (!(value[i] >= 0 && value[i] <= 1))
            return (struct uniformity){ n, 1, 1, 0, 0 };
    gsl_sort(value, 1, n);
    for (size_t i = 0; i < n; i++) {
        u.above = fmax(u.above, (double)(i + 1) / count - value[i]);
        u.below = fmax(u.below, value[i] - (double)i / count);
    }
    u.p = kolmogorov_tail(sqrt(count) * fmax(u.above, u.below));
    u.p_above = smirnov_tail(n, u.above);
    return u;
}

/* The x where the share of a beta distribution below it is p.  GSL's inverse is
 * not a number for some of thousands; its distribution has its digits. */
static double beta_inverse(double p, double a, double b)
{
    double low = 0, high = 1;
    for (int i = 0; i < 100; i++) {
        const double middle = (low + high) / 2;
        *(gsl_cdf_beta_P(middle, a, b) < p ? &low : &high) = middle;
    }
    return high;
}

struct interval clopper_pearson(size_t k, size_t n, double tail)
{
    const double hits = (double)k, misses = (double)(n - k);
    return (struct interval){
        k == 0 ? 0 : beta_inverse(tail, hits, misses + 1),
        k == n ? 1 : 1 - beta_inverse(tail, misses, hits + 1),
    };
}
