/* pvalue.h - probabilities of doing worse, by complementary functions
 *
 * A p-value below 1e-300 is given as 1e-300, so that it always has a sigma.
 */
#ifndef VALIDATE_PVALUE_H
#define VALIDATE_PVALUE_H

#include <stdint.h>

#include "validate/estimate.h"

/** What has no chance at all, 1e-300. */
extern const double pvalue_impossible;

/** P(X >= statistic) of chi-square; 1 without a degree of freedom. */
double pvalue_chi_square(double statistic, long degrees);

/** Two-sided, exact: k of n where each has the probability q, which is known
 * up to its error; the error is read in favour of k.  A q below 0 even so
 * (or above 1) is impossible whatever k is.  n below 2^32. */
double pvalue_binomial(uint64_t k, uint64_t n, struct estimate q);

/** The same, randomised by u in (0, 1) so that it is uniform for a sound model;
 * not for verdicts. */
double pvalue_binomial_uniform(uint64_t k, uint64_t n, double q, double u);

/** Two-sided: the mean of n independent numbers in [0, most], against what it
 * should be.  The normal tail is no bound for numbers that are rarely large;
 * this is, by the empirical Bernstein inequality, at the cost of a factor of
 * some 10 in p.  A. Maurer and M. Pontil, Empirical Bernstein Bounds and Sample
 * Variance Penalization, COLT 2009, theorem 4. */
double pvalue_mean(struct mean m, struct estimate truth);

/** The same by the normal tail, as Welch's test has it where one of the two
 * means is known; NaN without a spread. */
double pvalue_mean_normal(struct mean m, struct estimate truth);

/** The best of several p-values of one thing, for the whole (Bonferroni); 1 of
 * none, and impossible where one is not a number. */
double pvalue_best(const double *p, int n);

/** How many standard deviations a two-sided p is worth. */
double pvalue_sigma(double p);

#endif
