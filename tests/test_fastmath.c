/* test_fastmath.c - the polynomials are as good as their header says
 *
 * Against libm in long double, of 64 bits, whose own rounding is a two
 * thousandth of a unit here; arguments all over the range, evenly and by
 * magnitude, and its ends.
 */
#include "bsdf/fastmath.h"
#include "bsdf/rng.h"
#include "tests/close.h"

#include <float.h>

enum { DRAWS = 200000 };

/* How far off, in units of the last place of what is expected. */
static double units(double got, long double expected)
{
    const double e = fabs((double)expected);
    const double unit = nextafter(e, INFINITY) - e;
    return (double)(fabsl(got - expected) / unit);
}

struct function {
    double (*got)(double x);
    long double (*expected)(long double x);
    double low, high;   /* evenly in between */
    double least, most; /* and by magnitude */
    double limit;       /* in units */
};

static void is_close(void **state)
{
    const struct function *f = *state;
    double worst = 0, at = 0;
    for (uint64_t i = 0; i < DRAWS; i++) {
        const struct vec3 u = rng_uniform((struct rng){ 1, 4 }, i);
        const double x[] = { f->low + (f->high - f->low) * u.x,
                             f->least * pow(f->most / f->least, u.y),
                             f->low,
                             f->high,
                             f->least,
                             f->most };
        for (size_t k = 0; k < sizeof x / sizeof *x; k++) {
            if (!(x[k] >= f->low && x[k] <= f->high))
                continue;
            const double off = units(f->got(x[k]), f->expected(x[k]));
            if (!(off <= worst)) {
                worst = off;
                at = x[k];
            }
        }
    }
    if (!(worst <= f->limit))
        print_error("off by %.3f units at %a\n", worst, at);
    assert_true(worst <= f->limit);
}

static double exp_minus(double x)
{
    return fm_exp_minus(x);
}

static long double exp_minus_l(long double x)
{
    return expl(-x);
}

static double minus_log(double x)
{
    return fm_minus_log(x);
}

static long double minus_log_l(long double x)
{
    return -logl(x);
}

static double minus_log1m(double x)
{
    return fm_minus_log1m(x);
}

static long double minus_log1m_l(long double x)
{
    return -log1pl(-x);
}

static const long double pi_l = 3.14159265358979323846264338327950288L;

static double sine(double x)
{
    double s, c;
    fm_sincos_turns(x, &s, &c);
    return s;
}

static long double sine_l(long double x)
{
    /* About the nearest zero, where sinl(2 pi x) would lose digits. */
    const long double from = x - roundl(2 * x) / 2;
    return sinl(2 * pi_l * from) * (fmodl(roundl(2 * x), 2) != 0 ? -1 : 1);
}

static double cosine(double x)
{
    double s, c;
    fm_sincos_turns(x, &s, &c);
    return c;
}

static long double cosine_l(long double x)
{
    return x < 0.5L ? sine_l(0.25L - x) : -sine_l(0.75L - x);
}

static double erfcx(double x)
{
    return fm_erfcx(x);
}

/* The continued fraction from 8 on, where erfcl(x) soon underflows. */
static long double erfcx_l(long double x)
{
    if (x < 8)
        return expl(x * x) * erfcl(x);
    long double rest = x;
    for (int k = 60; k > 0; k--)
        rest = x + k / 2.0L / rest;
    return 1 / (rest * sqrtl(pi_l));
}

static double atan_below(double t)
{
    return fm_atan2(t, 1);
}

/* One Newton step from the value leaves its square: u - erfc(-x) / 2, on the
 * side where it is small. */
static void the_probit_is_close(void **state)
{
    (void)state;
    double worst = 0, at = 0;
    for (uint64_t i = 0; i < DRAWS; i++) {
        const struct vec3 v = rng_uniform((struct rng){ 1, 5 }, i);
        const double small = exp2(-53 * v.y);
        const double u[] = { v.x, small, 1 - small, 0x1p-54, 1 - 0x1p-53 };
        for (size_t k = 0; k < sizeof u / sizeof *u; k++) {
            if (!(u[k] >= 0x1p-54 && u[k] < 1))
                continue;
            const long double x = fm_probit(u[k]), y = fabsl(x);
            const long double tail = u[k] < 0.5 ? u[k] : 1 - (long double)u[k];
            const long double off =
                (erfcl(y) / 2 - tail) * sqrtl(pi_l) * expl(y * y);
            const double share = (double)(fabsl(off) / fmaxl(y, 1 / 16.0L));
            if (!(share <= worst)) {
                worst = share;
                at = u[k];
            }
        }
    }
    if (!(worst <= 8 * DBL_EPSILON))
        print_error("off by %g at %a\n", worst, at);
    assert_true(worst <= 8 * DBL_EPSILON);
    assert_true(fm_probit(0.5) == 0);
    assert_true(fm_probit(0) == fm_probit(0x1p-54));
}

static void angles_are_close_all_around(void **state)
{
    (void)state;
    double worst = 0;
    for (uint64_t i = 0; i < DRAWS; i++) {
        const struct vec3 u = rng_uniform((struct rng){ 1, 6 }, i);
        const double size = pow(10, 300 * (u.z - 0.5) * (i % 2 == 0));
        const double x = size * (2 * u.x - 1), y = (2 * u.y - 1);
        worst = fmax(worst, units(fm_atan2(y, x), atan2l(y, x)));
    }
    assert_at_most(worst, 3);
    assert_true(fm_atan2(0, 1) == 0 && fm_atan2(0, -1) == PI);
    assert_true(fm_atan2(1, 0) == PI / 2 && fm_atan2(-1, 0) == -PI / 2);
    assert_true(fm_atan2(0, 0) == 0);
}

static void ends_are_exact(void **state)
{
    (void)state;
    static const double quarter[][2] = {
        { 0, 1 }, { 1, 0 }, { 0, -1 }, { -1, 0 }, { 0, 1 }
    };
    for (int k = 0; k < 5; k++) {
        double s, c;
        fm_sincos_turns(k / 4., &s, &c);
        assert_true(s == quarter[k][0] && c == quarter[k][1]);
    }
    assert_true(fm_exp_minus(0) == 1);
    assert_true(fm_exp_minus(0x1p-1074) == 1);
    assert_true(fm_exp_minus(709) == 0 && fm_exp_minus(INFINITY) == 0);
    assert_true(isnan(fm_exp_minus(NAN)));
    assert_true(fm_minus_log(1) == 0 && fm_minus_log1m(0) == 0);
    assert_true(fm_minus_log1m(0x1p-1074) == 0x1p-1074);
    assert_true(fm_erfcx(1e300) > 0);
}

static void sines_of_angles_are_close(void **state)
{
    (void)state;
    double worst = 0;
    for (uint64_t i = 0; i < DRAWS; i++) {
        const struct vec3 v = rng_uniform((struct rng){ 1, 7 }, i);
        const double near = PI / 2 * round(16 * v.x - 8);
        const double x[] = { 32 * v.y - 16,
                             near + (v.y - 0.5) * exp2(-60 * v.z), near };
        for (int k = 0; k < 3; k++) {
            double s, c;
            fm_sincos(x[k], &s, &c);
            const long double sl = sinl(x[k]), cl = cosl(x[k]);
            const long double off_s =
                fabsl(s - sl) / (fabsl(sl) * DBL_EPSILON + 0x1p-81L);
            const long double off_c =
                fabsl(c - cl) / (fabsl(cl) * DBL_EPSILON + 0x1p-81L);
            worst = fmax(worst, (double)fmaxl(off_s, off_c));
        }
    }
    if (!(worst <= 2))
        print_error("off by %g units\n", worst);
    assert_true(worst <= 2);
}

int main(void)
{
    static struct function e = {
        exp_minus, exp_minus_l, 0, 708, 1e-30, 708, 1.1
    };
    static struct function l = { minus_log, minus_log_l, 0x1p-1022, 1,
                                 0x1p-1022, 1,           1 };
    static struct function l1 = { minus_log1m, minus_log1m_l, 0, 1 - 0x1p-53,
                                  0x1p-1022,   1 - 0x1p-53,   1 };
    static struct function s = { sine, sine_l, 0, 1, 1e-300, 1, 2 };
    static struct function c = { cosine, cosine_l, 0, 1, 1e-300, 1, 2 };
    static struct function x = { erfcx, erfcx_l, 0, 40, 1e-30, 1e15, 10 };
    static struct function far = { erfcx, erfcx_l, 30, 1e150, 1e3, 1e150, 10 };
    static struct function t = { atan_below, atanl, 0, 1, 1e-300, 1, 3 };
    const struct CMUnitTest tests[] = {
        { "exp(-x) is within 1.1 units", is_close, .initial_state = &e },
        { "-log(x) is within a unit", is_close, .initial_state = &l },
        { "-log(1 - x) is within a unit", is_close, .initial_state = &l1 },
        { "the sine of turns is within two units", is_close,
          .initial_state = &s },
        { "sine and cosine of angles are within two units",
          sines_of_angles_are_close },
        { "the cosine of turns is within two units", is_close,
          .initial_state = &c },
        { "exp(x^2) erfc(x) is within ten units", is_close,
          .initial_state = &x },
        { "exp(x^2) erfc(x) is within ten units far out", is_close,
          .initial_state = &far },
        { "the arc tangent is within three units", is_close,
          .initial_state = &t },
        { "angles are within three units all around",
          angles_are_close_all_around },
        { "the Gaussian quantile is within eight units", the_probit_is_close },
        { "ends are exact", ends_are_exact },
    };
    return cmocka_run_group_tests_name("fastmath", tests, NULL, NULL);
}
