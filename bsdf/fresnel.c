/* fresnel.c - Fresnel's equations
 *
 * With c the cosine of incidence, a + i b the complex cosine of refraction
 * times the index, (a + i b)^2 = (eta + i k)^2 - s^2, s^2 = 1 - c^2:
 *
 *   Rs = |c - (a + i b)|^2 / |c + (a + i b)|^2
 *   Rp = Rs |s^2 / c - (a + i b)|^2 / |s^2 / c + (a + i b)|^2
 *
 * the second by multiplying Rp = |n^2 c - q|^2 / |n^2 c + q|^2 out with
 * n^2 = q^2 + s^2, q = a + i b.  Both are kept free of division by c.
 */
#include "bsdf/fresnel.h"

#include <math.h>

double fresnel_conductor(double cos_i, double eta, double k)
{
    const double c = cos_i, s2 = (1 - c) * (1 + c);
    const double re = (eta - k) * (eta + k) - s2, im = 2 * eta * k;

    /* q = sqrt(re + i im), the larger part first so that nothing cancels. */
    const double modulus = sqrt(re * re + im * im);
    const double larger = sqrt((modulus + fabs(re)) / 2);
    const double smaller = larger > 0 ? im / (2 * larger) : 0;
    const double a = re >= 0 ? larger : smaller;
    const double b = re >= 0 ? smaller : larger;

    /* |x - q|^2 and |x + q|^2 share x^2 + |q|^2 and differ in 2 x a. */
    const double sum_s = c * c + modulus, diff_s = 2 * c * a;
    const double sum_p = s2 * s2 + c * c * modulus, diff_p = 2 * c * s2 * a;
    if (!(sum_s + diff_s > 0))
        return 1; /* nothing to refract into: eta = k = 0 at c = 0 */
    const double rs = ((c - a) * (c - a) + b * b) / (sum_s + diff_s);
    if (!(sum_p + diff_p > 0))
        return rs; /* s = 0: both polarisations are one */
    const double p = s2 - c * a;
    return fmin(rs * (1 + (p * p + c * c * b * b) / (sum_p + diff_p)) / 2, 1);
}

double fresnel_conductor_approx(double cos_i, double eta, double k)
{
    const double c = cos_i, n2 = eta * eta + k * k;
    const double rs = (n2 - 2 * eta * c + c * c) / (n2 + 2 * eta * c + c * c);
    const double rp =
        (n2 * c * c - 2 * eta * c + 1) / (n2 * c * c + 2 * eta * c + 1);
    return (rs + rp) / 2;
}

double fresnel_schlick(double cos_i, double r0)
{
    const double m = 1 - cos_i, m2 = m * m;
    return r0 + (1 - r0) * m2 * m2 * m;
}

double fresnel_dielectric(double cos_i, double eta, double *cos_t)
{
    const double c = cos_i, s2 = (1 - c) * (1 + c);
    /* eta cos_t, by the law of refraction */
    const double q2 = (eta - 1) * (eta + 1) + c * c, q = sqrt(fmax(q2, 0));
    if (cos_t)
        *cos_t = q / eta;
    if (q2 <= 0)
        return 1;
    const double rs = (c - q) / (c + q);
    const double rp = (s2 - c * q) / (s2 + c * q) * rs;
    return s2 + c * q > 0 ? (rs * rs + rp * rp) / 2 : rs * rs;
}

/* 1 - ((a - q) / (a + q))^2 = 4 a q / (a + q)^2, with q = eta cos_t, and a = c
 * for s-polarised light and eta^2 c for p. */
double fresnel_dielectric_through(double cos_i, double cos_t, double eta)
{
    const double c = cos_i, p = eta * eta * c, q = eta * cos_t;
    return q > 0 ? 2 * c * q / ((c + q) * (c + q)) +
                       2 * p * q / ((p + q) * (p + q))
                 : 0;
}
