/* fastmath.h - exp, log, sin and their like, without a branch
 *
 * A compiler turns a loop over these into vector instructions, which it cannot
 * do with calls of libm.  They are plain IEEE arithmetic, without contraction
 * (-ffp-contract=off), so one call gives to the last bit what a lane of a loop
 * gives, whatever the width of the vectors.
 *
 * The coefficients are those that tests/fastmath.py prints; each function says
 * how far it is off, in units of the last place (2^-52 of the value at most),
 * and tests/test_fastmath.c holds it to that.
 */
#ifndef BSDF_FASTMATH_H
#define BSDF_FASTMATH_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "bsdf/vec.h"

#define FM static inline __attribute__((always_inline, unused))

FM uint64_t fm_bits(double x)
{
    uint64_t u;
    memcpy(&u, &x, sizeof u);
    return u;
}

FM double fm_double(uint64_t u)
{
    double x;
    memcpy(&x, &u, sizeof x);
    return x;
}

/** The smaller and the larger; the second where a is not a number.  fmin and
 * fmax would be calls, for the sake of NaN and -0. */
FM double fm_min(double a, double b)
{
    return a < b ? a : b;
}

FM double fm_max(double a, double b)
{
    return a > b ? a : b;
}

/* Polynomials by G. Estrin, Organization of Computer Systems, 1960: pairs
 * first, so that the terms do not wait for one another. */
FM double fm_poly4(double x, const double *c)
{
    return (c[0] + c[1] * x) + (c[2] + c[3] * x) * (x * x);
}

FM double fm_poly8(double x, const double *c)
{
    const double x2 = x * x;
    return fm_poly4(x, c) + fm_poly4(x, c + 4) * (x2 * x2);
}

static const double fm_exp_c[] = {
    0x1.0000000000001p-1,  0x1.5555555555556p-3,  0x1.5555555553ce3p-5,
    0x1.111111111098cp-7,  0x1.6c16c178bd6bcp-10, 0x1.a01a01a7e29cdp-13,
    0x1.a019b84d17a80p-16, 0x1.71de0d383914ap-19, 0x1.28926932adb78p-22,
    0x1.af39c20098071p-26,
};
/** exp(-x) for x in [0, inf]: 1.1 units; 0 from 708 on, where numbers begin to
 * be denormal, which is slow and of no use. */
FM double fm_exp_minus(double x)
{
    /* Added to a number below 2^51, this rounds it to an integer, which is then
     * in its last bits. */
    const double shifter = 0x1.8p52;
    const double y = x > 708 ? -708 : -x; /* a NaN stays */
    const double shifted = y * 0x1.71547652b82fep0 + shifter;
    const double k = shifted - shifter;
    /* ln 2 in two parts, the first of 32 bits, so that k times it is exact. */
    const double r = (y - k * 0x1.62e42feep-1) - k * 0x1.a39ef35793c76p-33;
    const double r2 = r * r, r4 = r2 * r2;
    const double tail =
        fm_poly8(r, fm_exp_c) + (fm_exp_c[8] + fm_exp_c[9] * r) * (r4 * r4);
    const double power = fm_double((fm_bits(shifted) + 1023) << 52);
    return x > 708 ? 0 : (1 + (r + r2 * tail)) * power;
}

static const double fm_log_c[] = {
    0x1.5555555555555p-1, 0x1.9999999999a38p-2, 0x1.2492492476ba1p-2,
    0x1.c71c72017a15cp-3, 0x1.745cf8f6c9119p-3, 0x1.3b1c38474d3eep-3,
    0x1.0fbe478772696p-3, 0x1.0c06cf14c641bp-3,
};
/** -log(x) for x in [2^-1022, 1]: 1 unit.
 * log(m) = f - (f^2 / 2 - s (f^2 / 2 + R(s^2))), f = m - 1, s = f / (2 + f), as
 * in FreeBSD's msun, e_log.c, 1993. */
FM double fm_minus_log_of(double x, double low)
{
    const uint64_t root = 0x3fe6a09e667f3bcd; /* sqrt(1/2) */
    const uint64_t bits = fm_bits(x);
    const uint64_t e = (bits + (0x3ff0000000000000 - root)) >> 52;
    const double k = fm_double(e | 0x4330000000000000) - (0x1p52 + 1023);
    const double f = fm_double(bits - (e << 52) + 0x3ff0000000000000) - 1;
    const double s = f / (2 + f), z = s * s, half = f * f / 2;
    const double r = z * fm_poly8(z, fm_log_c);
    return ((half - (s * (half + r) + (k * 0x1.a39ef35793c76p-33 + low))) - f) -
           k * 0x1.62e42feep-1;
}

FM double fm_minus_log(double x)
{
    return fm_minus_log_of(x, 0);
}

/** -log(1 - x) for x in [0, 1): 1 unit. */
FM double fm_minus_log1m(double x)
{
    const double y = 1 - x;
    const double lost = (1 - y) - x; /* 1 - x = y + lost, exactly */
    return fm_minus_log_of(y, lost + lost * x);
}

static const double fm_sin_c[] = {
    -0x1.5555555555555p-3, 0x1.1111111110bb1p-7,   -0x1.a01a019e83460p-13,
    0x1.71de379607474p-19, -0x1.ae600a7a70c62p-26, 0x1.5e0ae8e372075p-33,
};
static const double fm_cos_c[] = {
    0x1.5555555555555p-5,   -0x1.6c16c16c16966p-10, 0x1.a01a019f4e7d9p-16,
    -0x1.27e4fa179895fp-22, 0x1.1eeb68a508535p-29,  -0x1.907d724680d4ep-37,
};
/* Sine and cosine of t + q pi / 2, |t| <= pi / 4, from q + 0x1.8p52. */
FM void fm_sincos_of(double t, double shifted, double *sine, double *cosine)
{
    const double z = t * t, z2 = z * z;
    const double s =
        t + t * (z * (fm_poly4(z, fm_sin_c) +
                      (fm_sin_c[4] + fm_sin_c[5] * z) * (z2 * z2)));
    const double c =
        1 - (z / 2 - z2 * (fm_poly4(z, fm_cos_c) +
                           (fm_cos_c[4] + fm_cos_c[5] * z) * (z2 * z2)));
    const uint64_t quarter = fm_bits(shifted);
    const uint64_t odd = 0 - (quarter & 1); /* all bits or none */
    const uint64_t bs = fm_bits(s), bc = fm_bits(c);
    *sine = fm_double(((bs & ~odd) | (bc & odd)) ^ (quarter & 2) << 62);
    *cosine = fm_double(((bc & ~odd) | (bs & odd)) ^ ((quarter + 1) & 2) << 62);
}

/** Sine and cosine of x turns, x in [0, 1]: 2 units, and exact at quarters. */
FM void fm_sincos_turns(double x, double *sine, double *cosine)
{
    const double shifter = 0x1.8p52;
    const double shifted = 4 * x + shifter;
    const double t = (4 * x - (shifted - shifter)) * (PI / 2);
    fm_sincos_of(t, shifted, sine, cosine);
}

/** Sine and cosine of an angle in [-16, 16] rad: 2 units, and 2^-80 where that
 * is more. */
FM void fm_sincos(double x, double *sine, double *cosine)
{
    const double shifter = 0x1.8p52;
    const double shifted = x * (2 / PI) + shifter;
    const double q = shifted - shifter;
    /* pi / 2 in two parts, the first of 33 bits, so that q times it is exact.
     */
    const double t = (x - q * 0x1.921fb544p0) - q * 0x1.0b4611a626331p-34;
    fm_sincos_of(t, shifted, sine, cosine);
}

static const double fm_atan_c[] = {
    -0x1.5555555555555p-2, 0x1.9999999999953p-3,  -0x1.249249248d7e6p-3,
    0x1.c71c71c3045bap-4,  -0x1.745d165de250bp-4, 0x1.3b1392d7e8f74p-4,
    -0x1.110e87e6a8722p-4, 0x1.e19a10824a50bp-5,  -0x1.ac7a7bd8f05c0p-5,
    0x1.74dd67f0d3109p-5,  -0x1.1b32a3266af2ep-5, 0x1.0ad10221730d6p-6,
};
/** The angle of (x, y) from x toward y, in (-pi, pi], as atan2(y, x) has it,
 * for finite x and y that are not both below 2^-1022: 3 units. */
FM double fm_atan2(double y, double x)
{
    const double ax = fabs(x), ay = fabs(y);
    const double small = fm_min(ax, ay), large = ax < ay ? ay : ax;
    /* Beyond pi / 8, from the diagonal. */
    const bool far = small > 0.41421356237309503 * large;
    const double over = far ? small - large : small;
    const double under = far ? small + large : large;
    const double t = over / fm_max(under, 0x1p-1022), z = t * t, z2 = z * z;
    const double tail = fm_poly8(z, fm_atan_c) +
                        fm_poly4(z, fm_atan_c + 8) * ((z2 * z2) * (z2 * z2));
    const double near = (far ? PI / 4 : 0) + (t + t * (z * tail));
    const double quarter = ax < ay ? PI / 2 - near : near;
    return copysign(x < 0 ? PI - quarter : quarter, y);
}

static const double fm_erfcx_c[] = {
    0x1.2a2af19c1492fp-3,   -0x1.05cce4d22cfb0p-3,  0x1.9220d8dc4611ep-4,
    -0x1.0bdcb780d895ep-4,  0x1.30cf6791b9b91p-5,   -0x1.2042cf161e7e7p-6,
    0x1.ad34d909942e1p-8,   -0x1.b62927e5cfab2p-10, 0x1.13ccd4178038cp-13,
    0x1.bc7f4f0fd7136p-14,  -0x1.85f46c317a0dcp-15, 0x1.7b2bfef72b28ap-20,
    0x1.4f499d14fbd13p-18,  -0x1.3eae141666f00p-20, -0x1.d6cef35bae2c3p-22,
    0x1.da2366bf4de78p-23,  0x1.3f22dcb793a43p-25,  -0x1.2e104252860b3p-25,
    -0x1.dad774f5bfe1cp-29, 0x1.72b9d5f1f0197p-28,  0x1.96206c7fd1bc7p-32,
    -0x1.90f098b13cd5ap-31, -0x1.0cabe2f37ddf9p-35, 0x1.0c92b75b12019p-34,
};
/** exp(x^2) erfc(x) for x in [0, inf): 10 units.
 * The variable is that of M. Shepherd and J. Laframboise, Chebyshev
 * Approximation of (1 + 2x) exp(x^2) erfc(x), Mathematics of Computation
 * 36(153), 1981; 1 - t falls as the function does. */
FM double fm_erfcx(double x)
{
    const double k = 3.75, inverse = 1 / (x + k);
    const double t = (x - k) * inverse, t2 = t * t, t4 = t2 * t2, t8 = t4 * t4;
    return 2 * k * inverse *
           (fm_poly8(t, fm_erfcx_c) + fm_poly8(t, fm_erfcx_c + 8) * t8 +
            fm_poly8(t, fm_erfcx_c + 16) * (t8 * t8));
}

static const double fm_probit_near_c[] = {
    0x1.c5bf891b4ef6bp-1,   0x1.db29fb2fee55cp-3,   0x1.7a72e72c2fdd7p-7,
    -0x1.321102615f87cp-9,  -0x1.0c86b6edcd5a6p-13, 0x1.870136a4be99dp-15,
    0x1.0f226113d5036p-19,  -0x1.0fde286bf36d1p-20, -0x1.3d82d2ab68d2cp-25,
    0x1.81704f3ccb660p-26,  0x1.20c8b8e45159ep-30,  -0x1.88b07c73eed0ap-31,
    0x1.5a554f0ad191dp-34,  -0x1.b118932c146f0p-36, 0x1.8fd3b232100d7p-37,
    -0x1.822d8a5772e31p-39, 0x1.a7961a9c9c87fp-42,  -0x1.031bbd5248fc0p-45,
    0x1.b5a4283d62888p-51,  0x1.1fbebdf6f3da5p-54,  -0x1.c2165a7ac6cb3p-58,
    0x1.847e944433021p-63,
};
static const double fm_probit_c[] = {
    0x1.43931fbae7648p+1,   0x1.12ca79c88dffep+1,   0x1.11d11f0a22b4ep-1,
    0x1.23aac6c4517aap-2,   0x1.3810e52ee7fd3p-2,   -0x1.79a06f191652ep-6,
    0x1.e051ecba2ca87p-6,   0x1.209642c536e97p-3,   -0x1.1fb129ea14a80p-5,
    -0x1.98be5f75ec06cp-5,  0x1.1a978ab3ad1a8p-4,   0x1.70edbf2355bd1p-7,
    -0x1.4afe30670daa4p-5,  0x1.35c7a67fba69ap-6,   0x1.cdda3f9c2f908p-7,
    -0x1.56642c97ffbdfp-6,  0x1.85391c4c4ccf5p-8,   0x1.9f462731ea639p-7,
    -0x1.893e04b151b16p-7,  -0x1.242ed75c4e098p-9,  0x1.3a0b7618d09e5p-7,
    -0x1.02c4b87bd9fa6p-8,  -0x1.08f61addce205p-8,  0x1.5e66335c986afp-8,
    -0x1.9323c4dbc6cabp-12, -0x1.f2f57eb0f6a37p-9,  0x1.331cabc55ed07p-9,
    0x1.b9eeca5ffa339p-10,  -0x1.2dfd8a9d3512dp-9,  -0x1.35cd14c1a5edap-12,
    0x1.78802e094bc16p-10,  -0x1.9068169b4db40p-13, -0x1.497ad1a954ab5p-11,
    0x1.83fe2264ab41bp-13,  0x1.8d5ca20bde95cp-13,  -0x1.430a4ce5a09bbp-14,
    -0x1.2afc863352c39p-15, 0x1.23677d6532a4dp-16,  0x1.aa4d17cf98711p-19,
    -0x1.cd39d9f1fd9bcp-20,
};
/** The value below which a share u in [0, 1) of exp(-x^2) / sqrt(pi) is,
 * erfinv(2 u - 1); u = 0 stands for its half cell, 2^-54: 8 units of the value
 * or of 1/16.
 * erfinv(y) / y as a function of w = -log(1 - y^2): M. Giles, Approximating
 * the erfinv Function, GPU Computing Gems, 2011.  For all but one u in 300,
 * where w is below 5, that is one polynomial in w, and for all w one in
 * w / (w + 12). */
FM double fm_probit_w(double u)
{
    const double v = fm_max(u, 0x1p-54);
    return fm_minus_log(4 * v * (1 - v));
}

FM double fm_probit_near(double u, double w)
{
    const double w2 = w * w, w4 = w2 * w2, w8 = w4 * w4;
    const double high = fm_poly4(w, fm_probit_near_c + 16) +
                        (fm_probit_near_c[20] + fm_probit_near_c[21] * w) * w4;
    const double p = fm_poly8(w, fm_probit_near_c) +
                     fm_poly8(w, fm_probit_near_c + 8) * w8 + high * (w8 * w8);
    return ((u - 0.5) + (u - 0.5)) * p;
}

FM double fm_probit_far(double u, double w)
{
    const double k = 12, w_max = 36.75;
    const double t = w / (w + k) * (2 * (w_max + k) / w_max) - 1;
    const double t2 = t * t, t4 = t2 * t2, t8 = t4 * t4;
    const double low =
        fm_poly8(t, fm_probit_c) + fm_poly8(t, fm_probit_c + 8) * t8;
    const double high = fm_poly8(t, fm_probit_c + 16) +
                        fm_poly8(t, fm_probit_c + 24) * t8 +
                        fm_poly8(t, fm_probit_c + 32) * (t8 * t8);
    const double v = fm_max(u, 0x1p-54);
    return ((v - 0.5) + (v - 0.5)) * (low + high * (t8 * t8));
}

/** Where fm_probit_near is meant. */
FM bool fm_probit_is_near(double w)
{
    return w < 5;
}

static inline double fm_probit(double u)
{
    const double w = fm_probit_w(u);
    return fm_probit_is_near(w) ? fm_probit_near(u, w) : fm_probit_far(u, w);
}

#endif
