/* baseline_simpson.h - the chi-square test as renderers do it, to measure by
 *
 * What their own tests have in common (hypothesis.h of Nori and Mitsuba,
 * pbrt-v4's bsdfs_test.cpp): a model in single precision behind a table of
 * functions, one call a sample with a weight in three bands; a histogram over
 * theta and phi by acos and atan2; adaptive Simpson quadrature of the pdf over
 * every bin, nested; cells that expect fewer than 5 pooled.  It is written for
 * speed as one would write it there: PCG32 for the numbers, masking by the
 * rational fit, spherical caps for visible normals.
 *
 * M. O'Neill, PCG, HMC-CS-2014-0905, 2014.  G. Kuncir, Algorithm 103: Simpson's
 * rule integrator, CACM 5(6), 1962.  B. Walter et al., EGSR 2007 (the model and
 * the fit).  J. Dupuy and A. Benyoub, CGF 42(8), 2023 (the caps).
 */
#ifndef TESTS_BASELINE_SIMPSON_H
#define TESTS_BASELINE_SIMPSON_H

#include <stddef.h>
#include <stdint.h>

enum baseline_kind {
    BASELINE_BECKMANN_ALL, /* all normals */
    BASELINE_GGX_VISIBLE,
};

struct baseline {
    enum baseline_kind kind;
    float alpha, eta[3], k[3];
    float theta; /* of wo [rad], its azimuth is 0 */
};

/** Draws the samples, counts[i * slices + j] of those in strip i of [0, pi] and
 * slice j of [0, 2 pi]; returns the mean weight over the bands. */
double baseline_sample(const struct baseline *b, uint64_t seed, long samples,
                       size_t strips, size_t slices, long *counts);

/** The mass of the pdf in each of those bins. */
void baseline_integrate(const struct baseline *b, size_t strips, size_t slices,
                        double *mass);

/** Pearson's statistic over pooled cells, and their number less 1. */
double chi_square_pooled(const long *counts, const double *mass, size_t n,
                         long samples, long *degrees);

#endif
