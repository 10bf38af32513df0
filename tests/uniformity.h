/* uniformity.h - are p-values uniform, and how often is one small
 *
 * p-values of sound models are uniform in (0, 1) where their statistic is
 * continuous and its distribution exact.  Too many small ones raise false
 * alarms; too few cost power only.  So the two sides are told apart.
 */
#ifndef TESTS_UNIFORMITY_H
#define TESTS_UNIFORMITY_H

#include <stddef.h>

/** P(K >= x) of Kolmogorov's limiting distribution, that of sqrt(n) D. */
double kolmogorov_tail(double x);

/** P(D+ >= d) for n independent uniform numbers, exact; the same as for D-. */
double smirnov_tail(size_t n, double d);

/** How the empirical distribution of n numbers lies about the uniform one. */
struct uniformity {
    size_t n;
    double above, below; /* D+ (too many small ones) and D- (too few) */
    double p;            /* of the larger, two-sided, by the limit */
    double p_above;      /* of D+ alone, exact */
};

/** Sorts the values; p is 1 of none, and 0 where one is not in [0, 1]. */
struct uniformity uniformity_of(double *value, size_t n);

struct interval {
    double low, high;
};

/** Clopper and Pearson's interval for a share of which k of n were seen: either
 * side leaves out at most `tail` (.025 for 95 %). */
struct interval clopper_pearson(size_t k, size_t n, double tail);

#endif
