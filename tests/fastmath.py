#!/usr/bin/env python3
"""The polynomials of bsdf/fastmath.h: python3 tests/fastmath.py

Each is the interpolation of a function in fifty digits at Chebyshev nodes, in
powers of its variable, rounded to double.  Interpolation at those nodes is
within a small factor of the best polynomial of the degree (L. N. Trefethen,
Approximation Theory and Approximation Practice, 2013, ch. 15).  What is left
is printed behind each name, as the largest relative error of the function that
the polynomial is for, on a fine grid and before rounding.

Needs mpmath (PyPI).
"""
from mpmath import (mp, mpf, atan, cos, sin, exp, expm1, log, pi, sqrt, erfc, nstr)

mp.dps = 50


def powers(f, low, high, n):
    """f on [low, high] as c[0] + c[1] x + ... + c[n-1] x^(n-1)."""
    mid, half = (low + high) / 2, (high - low) / 2
    nodes = [cos(pi * (k + mpf(1) / 2) / n) for k in range(n)]
    values = [f(mid + half * x) for x in nodes]
    cheb = [(2 if j else 1) / mpf(n) *
            sum(v * cos(pi * j * (k + mpf(1) / 2) / n)
                for k, v in enumerate(values)) for j in range(n)]
    # T_j by recurrence, then x -> (x - mid) / half.
    in_t = [mpf(0)] * n
    before, now = [mpf(1)], [mpf(0), mpf(1)]
    for j in range(n):
        row = before
        for i, c in enumerate(row):
            in_t[i] += cheb[j] * c
        after = [mpf(0)] + [2 * c for c in now]
        for i, c in enumerate(before):
            after[i] -= c
        before, now = now, after
    out = [mpf(0)]
    for c in reversed(in_t):
        shifted = [mpf(0)] * (len(out) + 1)
        for i, o in enumerate(out):
            shifted[i] -= o * mid / half
            shifted[i + 1] += o / half
        shifted[0] += c
        out = shifted[:n]
    return out


def value(c, x):
    total = mpf(0)
    for a in reversed(c):
        total = total * x + a
    return total


def show(name, c, of, low, high):
    """of(x, p) is the function where p is what the polynomial stands for, and
    of(x, None) where it is exact."""
    worst = mpf(0)
    for k in range(2001):
        x = low + (high - low) * (mpf(k) + mpf('0.37')) / 2002
        exact = of(x, None)
        worst = max(worst, abs(of(x, value(c, x)) / exact - 1))
    print('%s: %d coefficients, off by %s' % (name, len(c), nstr(worst, 2)))
    print(',\n'.join('    %s' % float(a).hex() for a in c))


def exp_tail(r):
    return (exp(r) - 1 - r) / r ** 2 if r else mpf(1) / 2


def log_tail(z):
    s = sqrt(z)
    return (log((1 + s) / (1 - s)) / s - 2) / z if z else mpf(2) / 3


def sin_tail(z):
    t = sqrt(z)
    return (sin(t) / t - 1) / z if z else -mpf(1) / 6


def cos_tail(z):
    return (cos(sqrt(z)) - 1 + z / 2) / z ** 2 if z else mpf(1) / 24


def atan_tail(z):
    t = sqrt(z)
    return (atan(t) / t - 1) / z if z else -mpf(1) / 3


K_ERFCX = mpf('3.75')


def erfcx(x):
    return exp(x * x) * erfc(x)


def erfcx_scaled(t):
    """erfcx over 1 - t, with x = K (1 + t) / (1 - t)."""
    return erfcx(K_ERFCX * (1 + t) / (1 - t)) / (1 - t)


K_PROBIT, W_MAX = mpf(12), mpf('36.75')


def probit_of_w(w):
    """erfinv(y) / y at w = -log(1 - y^2)."""
    y = sqrt(-expm1(-w))
    q = exp(-w) / (1 + y)  # 1 - y
    x = sqrt(w) * mpf('0.9') if w > 1 else y * sqrt(pi) / 2
    for _ in range(60):
        newton = (erfc(x) - q) * sqrt(pi) / 2 * exp(x * x)
        step = newton / (1 + newton * x)
        x += step
        if abs(step) < mpf(10) ** -45:
            break
    return x / y


def probit_w(t):
    v = (1 + t) / 2 * W_MAX / (W_MAX + K_PROBIT)
    return K_PROBIT * v / (1 - v)


def main():
    b = mpf('0.3475')
    show('exp', powers(exp_tail, -b, b, 10),
         lambda r, p: exp(r) if p is None else 1 + r + r * r * p, -b, b)
    z = mpf('0.02945')
    show('log', powers(log_tail, mpf(0), z, 8),
         lambda x, p: 2 + x * (log_tail(x) if p is None else p), mpf(0), z)
    z = mpf('0.617')
    show('sin', powers(sin_tail, mpf(0), z, 6),
         lambda x, p: 1 + x * (sin_tail(x) if p is None else p), mpf(0), z)
    show('cos', powers(cos_tail, mpf(0), z, 6),
         lambda x, p: 1 - x / 2 + x * x * (cos_tail(x) if p is None else p),
         mpf(0), z)
    z = mpf('0.17158')  # tan(pi / 8)^2
    show('atan', powers(atan_tail, mpf(0), z, 12),
         lambda x, p: 1 + x * (atan_tail(x) if p is None else p), mpf(0), z)
    one = mpf(1)
    show('erfcx', powers(erfcx_scaled, -one, one, 24),
         lambda t, p: erfcx_scaled(t) if p is None else p, -one, one)
    show('probit_near', powers(probit_of_w, mpf(0), mpf(5), 22),
         lambda w, p: probit_of_w(w) if p is None else p, mpf(0), mpf(5))
    show('probit', powers(lambda t: probit_of_w(probit_w(t)), -one, one, 40),
         lambda t, p: probit_of_w(probit_w(t)) if p is None else p, -one, one)


main()
