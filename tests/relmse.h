/* relmse.h - how far a picture is from a better one of the same */
#ifndef TESTS_RELMSE_H
#define TESTS_RELMSE_H

#include <stddef.h>

/** The mean of (x - r)^2 / (r^2 + 0.01) over n numbers, the channels of all
 * pixels, linear.  The relative error of F. Rousselle, C. Knaus and M. Zwicker,
 * Adaptive Sampling and Reconstruction using Greedy Error Minimization, ACM TOG
 * 30(6), 2011, with the 0.01 that comparisons commonly take.  The reference's
 * own noise adds to it. */
double relmse(const float *x, const float *reference, size_t n);

#endif
