/* relmse.c - how far a picture is from a better one of the same */
#include "tests/relmse.h"

double relmse(const float *x, const float *reference, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        const double r = (double)reference[i], d = (double)x[i] - r;
        sum += d * d / (r * r + 0.01);
    }
    return sum / (double)n;
}
