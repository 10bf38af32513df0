/* power.h - how large a mistake must be to be found 99 times of 100
 *
 * The level is the p-value below which a test rejects, two-sided where the test
 * is.
 */
#ifndef VALIDATE_POWER_H
#define VALIDATE_POWER_H

/** The non-centrality that a chi-square must have. */
double power_chi_square(long degrees, double level);

/** The mean, in standard deviations, that a normal statistic must have. */
double power_normal(double level);

/** By how much the mean of a Poisson count must exceed the known one. */
double power_poisson(double mean, double level);

#endif
