/* fresnel.h - reflectance of a smooth interface for unpolarised light
 *
 * cos_i is the cosine of the angle of incidence, in [0, 1].  Indices are
 * relative: those of the far medium over that of the medium the light is in.
 *
 * The functions are inline and without branches, for loops; see fastmath.h.
 */
#ifndef BSDF_FRESNEL_H
#define BSDF_FRESNEL_H

#include <math.h>
#include <stddef.h>

/** Exact, for a complex index eta + i k with eta, k >= 0, not both 0 unless
 * total reflection is meant.
 * M. Born and E. Wolf, Principles of Optics, 7th ed., 1999, sec. 14.2.
 *
 * With c the cosine of incidence, a + i b the complex cosine of refraction
 * times the index, (a + i b)^2 = (eta + i k)^2 - s^2, s^2 = 1 - c^2:
 *
 *   Rs = |c - (a + i b)|^2 / |c + (a + i b)|^2
 *   Rp = Rs |s^2 / c - (a + i b)|^2 / |s^2 / c + (a + i b)|^2
 *
 * the second by multiplying Rp = |n^2 c - q|^2 / |n^2 c + q|^2 out with
 * n^2 = q^2 + s^2, q = a + i b.  Both are kept free of division by c. */
static inline double fresnel_conductor(double cos_i, double eta, double k)
{
    const double c = cos_i, s2 = (1 - c) * (1 + c);
    const double re = (eta - k) * (eta + k) - s2, im = 2 * eta * k;

    /* g is the larger part of q = sqrt(re + i im), so that nothing cancels, and
     * a and b stand for g times the parts: the smaller is im / (2 g). */
    const double modulus = sqrt(re * re + im * im);
    const double g2 = (modulus + fabs(re)) / 2, g = sqrt(g2);
    const double a = re >= 0 ? g2 : im / 2;
    const double b = re >= 0 ? im / 2 : g2;

    /* |x - q|^2 and |x + q|^2 share x^2 + |q|^2 and differ in 2 x a: the former
     * times g^2, the latter times g. */
    const double plus_s = (c * c + modulus) * g + 2 * c * a;
    const double plus_p = (s2 * s2 + c * c * modulus) * g + 2 * c * s2 * a;
    const double p = s2 * g - c * a, s = c * g - a;
    const double minus_s = s * s + b * b;
    const double minus_p = p * p + c * c * (b * b);
    /* (Rs + Rp) / 2 over one division.  At q = 0 all is reflected. */
    const double below = 2 * plus_s * plus_p * g2;
    const double above = minus_s * (plus_p * g + minus_p);
    const double r = below > 0 ? above / below : 1;
    return r < 1 ? r : 1;
}

/** The write-up's (Rs + Rp) / 2, good where eta^2 + k^2 >> 1. */
static inline double fresnel_conductor_approx(double cos_i, double eta,
                                              double k)
{
    const double c = cos_i, n2 = eta * eta + k * k;
    const double rs = (n2 - 2 * eta * c + c * c) / (n2 + 2 * eta * c + c * c);
    const double rp =
        (n2 * c * c - 2 * eta * c + 1) / (n2 * c * c + 2 * eta * c + 1);
    return (rs + rp) / 2;
}

/** C. Schlick, An Inexpensive BRDF Model for Physically-based Rendering, CGF
 * 13(3), 1994: r0 + (1 - r0) (1 - cos_i)^5. */
static inline double fresnel_schlick(double cos_i, double r0)
{
    const double m = 1 - cos_i, m2 = m * m;
    return r0 + (1 - r0) * m2 * m2 * m;
}

/** Exact, for a real index eta > 0; 1 beyond the critical angle.  cos_t, if
 * not NULL, takes the cosine of the refracted direction, or 0.
 * Born and Wolf, sec. 1.5.2. */
static inline double fresnel_dielectric(double cos_i, double eta, double *cos_t)
{
    const double c = cos_i, s2 = (1 - c) * (1 + c);
    /* eta cos_t, by the law of refraction */
    const double q2 = (eta - 1) * (eta + 1) + c * c;
    const double q = sqrt(q2 > 0 ? q2 : 0);
    if (cos_t)
        *cos_t = q / eta;
    /* c + q is 0 beyond the critical angle alone, s2 + c q at s = 0 alone,
     * where both polarisations are one. */
    const double plus_s = c + q, plus_p = s2 + c * q;
    const double rs = (c - q) / (plus_s > 0 ? plus_s : 1);
    const double rp =
        (plus_p > 0 ? s2 - c * q : 1) / (plus_p > 0 ? plus_p : 1) * rs;
    return q2 > 0 ? (rs * rs + rp * rp) / 2 : 1;
}

/** 1 less that, from both cosines, cos_t beyond: without its cancellation where
 * nearly all is reflected, and without cos_t's own near the critical angle.
 *
 * 1 - ((a - q) / (a + q))^2 = 4 a q / (a + q)^2, with q = eta cos_t, and a = c
 * for s-polarised light and eta^2 c for p. */
static inline double fresnel_dielectric_through(double cos_i, double cos_t,
                                                double eta)
{
    const double c = cos_i, p = eta * eta * c, q = eta * cos_t;
    const double t =
        2 * c * q / ((c + q) * (c + q)) + 2 * p * q / ((p + q) * (p + q));
    return q > 0 ? t : 0;
}

#endif
