/* ior_formula.c - n by the dispersion formulas of the database [1]
 *
 * With l the wavelength [um]:
 *
 *   1  n^2 = 1 + C1 + C2 l^2 / (l^2 - C3^2) + C4 l^2 / (l^2 - C5^2) + ...
 *   2  n^2 = 1 + C1 + C2 l^2 / (l^2 - C3) + C4 l^2 / (l^2 - C5) + ...
 *   3  n^2 = C1 + C2 l^C3 + C4 l^C5 + ...
 *   4  n^2 = C1 + C2 l^C3 / (l^2 - C4^C5) + C6 l^C7 / (l^2 - C8^C9)
 *            + C10 l^C11 + C12 l^C13 + ...
 *   5  n = C1 + C2 l^C3 + C4 l^C5 + ...
 *   6  n = 1 + C1 + C2 / (C3 - l^-2) + C4 / (C5 - l^-2) + ...
 *   7  n = C1 + C2 / (l^2 - 0.028) + C3 / (l^2 - 0.028)^2
 *          + C4 l^2 + C5 l^4 + C6 l^6
 *   8  (n^2 - 1) / (n^2 + 2) = C1 + C2 l^2 / (l^2 - C3) + C4 l^2
 *   9  n^2 = C1 + C2 / (l^2 - C3) + C4 (l - C5) / ((l - C5)^2 + C6)
 *
 * They are Sellmeier's (1, 2), a polynomial, the database's own, Cauchy's, one
 * for gases, Herzberger's, Retro and Exotic.  Coefficients that are not given
 * are 0, and a term whose first coefficient is 0 is none, also where the rest
 * of it would be 0 / 0.
 *
 * [1] M. N. Polyanskiy, Dispersion formulas, refractiveindex.info.
 */
#include "bsdf/ior_page.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

static double sellmeier(const double *c, double l)
{
    double sum = 1 + c[0];
    for (int i = 1; i < IOR_COEFFICIENTS_MAX; i += 2)
        if (c[i] != 0)
            sum += c[i] * l * l / ((l - c[i + 1]) * (l + c[i + 1]));
    return sum;
}

static double sellmeier_2(const double *c, double l)
{
    double sum = 1 + c[0];
    for (int i = 1; i < IOR_COEFFICIENTS_MAX; i += 2)
        if (c[i] != 0)
            sum += c[i] * l * l / (l * l - c[i + 1]);
    return sum;
}

static double powers(const double *c, int first, double l)
{
    double sum = 0;
    for (int i = first; i < IOR_COEFFICIENTS_MAX; i += 2)
        if (c[i] != 0)
            sum += c[i] * pow(l, c[i + 1]);
    return sum;
}

static double polynomial(const double *c, double l)
{
    return c[0] + powers(c, 1, l);
}

static double database(const double *c, double l)
{
    double sum = c[0] + powers(c, 9, l);
    for (int i = 1; i < 9; i += 4)
        if (c[i] != 0)
            sum += c[i] * pow(l, c[i + 1]) / (l * l - pow(c[i + 2], c[i + 3]));
    return sum;
}

static double gases(const double *c, double l)
{
    double sum = 1 + c[0];
    for (int i = 1; i < IOR_COEFFICIENTS_MAX; i += 2)
        if (c[i] != 0)
            sum += c[i] / (c[i + 1] - 1 / (l * l));
    return sum;
}

static double herzberger(const double *c, double l)
{
    const double l2 = l * l, away = l2 - .028; /* [um^2] */
    double sum = c[0] + l2 * (c[3] + l2 * (c[4] + l2 * c[5]));
    if (c[1] != 0)
        sum += c[1] / away;
    if (c[2] != 0)
        sum += c[2] / (away * away);
    return sum;
}

static double retro(const double *c, double l)
{
    double r = c[0] + c[3] * l * l;
    if (c[1] != 0)
        r += c[1] * l * l / (l * l - c[2]);
    return (1 + 2 * r) / (1 - r);
}

static double exotic(const double *c, double l)
{
    const double away = l - c[4];
    double sum = c[0];
    if (c[1] != 0)
        sum += c[1] / (l * l - c[2]);
    if (c[3] != 0)
        sum += c[3] * away / (away * away + c[5]);
    return sum;
}

static const struct {
    double (*value)(const double *c, double l);
    bool squared; /* gives n^2 */
    size_t room;
} formulas[] = {
    { sellmeier, true, 17 },   { sellmeier_2, true, 17 },
    { polynomial, true, 17 },  { database, true, 17 },
    { polynomial, false, 11 }, { gases, false, 11 },
    { herzberger, false, 6 },  { retro, true, 4 },
    { exotic, true, 6 },
};

static bool known(int number)
{
    return number >= 1 && number <= (int)(sizeof formulas / sizeof *formulas);
}

size_t ior_formula_room(int number)
{
    return known(number) ? formulas[number - 1].room : 0;
}

bool ior_formula_whole(int number, size_t count)
{
    switch (number) {
    case 4:
        return count % (count < 9 ? 4 : 2) == 1;
    case 7:
        return true;
    case 8:
        return count != 2;
    case 9:
        return count == 1 || count == 3 || count == 6;
    default:
        return count % 2 == 1;
    }
}

bool ior_formula_at(const struct ior_dispersion *f, double nm, double *n,
                    char *why, size_t size)
{
    assert(known(f->number));
    const bool squared = formulas[f->number - 1].squared;
    const double value = formulas[f->number - 1].value(f->c, nm / 1000);
    if (!isfinite(value) || value < 0) {
        snprintf(why, size, "formula %d gives n%s = %g", f->number,
                 squared ? "^2" : "", value);
        return false;
    }
    *n = squared ? sqrt(value) : value;
    return true;
}
