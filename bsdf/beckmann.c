/* beckmann.c - the family's functions, to be pointed at, and the slow inversion
 */
#include "bsdf/beckmann.h"
#include "bsdf/ndf.h"

static double p22(double r2)
{
    return beckmann_p22(r2);
}

static double lambda(double a)
{
    return beckmann_lambda(a);
}

static double r2_at(double u)
{
    return beckmann_r2_at(u);
}

double beckmann_slope_surely(double a, double u)
{
    const struct beckmann_seen w = beckmann_seen_at(a);
    const double target = beckmann_target(w, u);

    double low = fm_max(-w.a, -BECKMANN_SLOPE_MAX), high = BECKMANN_SLOPE_MAX;
    double x = beckmann_start_at(w, u);
    for (int i = 0; i < 60; i++) {
        if (!(x > low && x < high))
            x = (low + high) / 2;
        const struct beckmann_tail t = beckmann_tail_at(x);
        if (beckmann_above(w.a, x, t) > target)
            low = x;
        else
            high = x;
        const double step = beckmann_step(w.a, x, t, target);
        const double next = x + step;
        if (next > -w.a && fabs(step) <= 2e-4 * fm_min(1, w.a + next))
            return next;
        x = next;
    }
    return (low + high) / 2;
}

static struct vec3 visible(struct vec3 w, double u, double v)
{
    return (struct vec3){ beckmann_slope(beckmann_seen_at(w.z / w.x), u),
                          fm_probit(v), 1 };
}

const struct ndf ndf_beckmann = {
    .name = "beckmann",
    .family = NDF_BECKMANN,
    .p22 = p22,
    .lambda = lambda,
    .r2_at = r2_at,
    .visible = visible,
};
