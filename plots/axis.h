/* axis.h - marks that are easy to read */
#ifndef PLOTS_AXIS_H
#define PLOTS_AXIS_H

#include <stddef.h>

/** A step of 1, 2, 2.5 or 5 times a power of ten that goes at most n times
 * into a length > 0; n at least 2. */
double axis_step(double length, int n);

/** The same for an angle, at most 5 times; 30 degrees where it is wide. */
double axis_step_deg(double length);

/** The exponent, a multiple of 3, that leaves the largest value of an axis a
 * number in [1, 1000); 0 where that is 0 or not finite. */
int axis_exponent(double largest);

/** Writes the unit of what was divided by 10^exponent, so that 3 makes "1/sr"
 * "10³/sr", and "deg" "10³ deg". */
void axis_unit(char *text, size_t size, int exponent, const char *unit);

#endif
