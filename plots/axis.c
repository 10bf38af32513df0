/* axis.c - steps, exponents and units of axes */
#include "plots/axis.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

double axis_step(double length, int n)
{
    static const double steps[] = { 1, 2, 2.5, 5, 10 };
    const double unit = pow(10, floor(log10(length / n)));
    size_t i = 0;
    while (i < 4 && length > n * steps[i] * unit * (1 + 1e-9))
        i++;
    return steps[i] * unit;
}

double axis_step_deg(double length)
{
    return length > 75 ? (length > 180 ? 60 : 30) : axis_step(length, 5);
}

int axis_exponent(double largest)
{
    return largest > 0 && isfinite(largest)
               ? 3 * (int)floor(log10(largest * (1 + 1e-12)) / 3)
               : 0;
}

void axis_unit(char *text, size_t size, int exponent, const char *unit)
{
    static const char *const digit[] = { "⁰", "¹", "²", "³", "⁴",
                                         "⁵", "⁶", "⁷", "⁸", "⁹" };
    const int e = abs(exponent);
    const bool inverse = strncmp(unit, "1/", 2) == 0;
    if (e == 0)
        snprintf(text, size, "%s", unit);
    else
        snprintf(text, size, "10%s%s%s%s%s%s", exponent < 0 ? "⁻" : "",
                 e < 100 ? "" : digit[e / 100 % 10],
                 e < 10 ? "" : digit[e / 10 % 10], digit[e % 10],
                 inverse ? "" : " ", inverse ? unit + 1 : unit);
}
