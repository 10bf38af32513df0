/* facets.c - the loops of facets.h
 *
 * What depends on w alone is computed once where all w of a batch are the
 * same, as they are when one lobe is drawn from; the numbers are the same ones.
 * A family is a constant in each loop, so that no lane has a branch on it.
 */
#include "bsdf/facets.h"

LANES static uint64_t differences(size_t n, struct dirs w)
{
    const uint64_t x = fm_bits(w.x[0]), y = fm_bits(w.y[0]);
    const uint64_t z = fm_bits(w.z[0]);
    uint64_t differ = 0;
    _Pragma("omp simd reduction(|:differ)") for (size_t i = 0; i < n; i++)
        differ |=
        (fm_bits(w.x[i]) ^ x) | (fm_bits(w.y[i]) ^ y) | (fm_bits(w.z[i]) ^ z);
    return differ;
}

bool dirs_same(size_t n, struct dirs w)
{
    return differences(n, w) == 0;
}

LANES static void fill(size_t n, double *x)
{
    const double first = x[0];
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        x[i] = first;
}

void facets_fill(size_t n, double *x)
{
    fill(n, x);
}

INLINE void lambdas(struct facets f, size_t n, struct dirs w, double *lambda)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        lambda[i] = facets_lambda(f, dirs_at(w, i));
}

LANES static void lambda_lanes(struct facets f, size_t n, struct dirs w,
                               double *lambda)
{
    if (f.family == NDF_GGX)
        lambdas(facets_as(f, NDF_GGX), n, w, lambda);
    else
        lambdas(facets_as(f, NDF_BECKMANN), n, w, lambda);
}

void facets_lambda_many(struct facets f, size_t n, struct dirs w,
                        double *lambda)
{
    lambda_lanes(f, n, w, lambda);
}

INLINE void all(struct facets f, size_t n, struct dirs u, double *mx,
                double *my, double *mz)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        mz[i] = facets_r2_at(f, u.x[i]);
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct vec3 m = facets_around(f, mz[i], u.y[i]);
        mx[i] = m.x, my[i] = m.y, mz[i] = m.z;
    }
}

LANES static void all_lanes(struct facets f, size_t n, struct dirs u,
                            double *mx, double *my, double *mz)
{
    if (f.family == NDF_GGX)
        all(facets_as(f, NDF_GGX), n, u, mx, my, mz);
    else
        all(facets_as(f, NDF_BECKMANN), n, u, mx, my, mz);
}

void facets_all_many(struct facets f, size_t n, struct dirs u, double *mx,
                     double *my, double *mz)
{
    all_lanes(f, n, u, mx, my, mz);
}

/* A facets_view a lane. */
struct views {
    double x[LANES_MAX], y[LANES_MAX];
    union {
        struct {
            double sine[LANES_MAX], cosine[LANES_MAX];
        } ggx;
        struct {
            double a[LANES_MAX], all[LANES_MAX], toward[LANES_MAX];
            double shift[LANES_MAX], edge[LANES_MAX], bend[LANES_MAX];
        } beckmann;
    };
};

LANES static void ggx_views(struct facets f, size_t n, struct dirs w,
                            struct views *v)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct facets_view at =
            facets_view(facets_as(f, NDF_GGX), dirs_at(w, i));
        v->x[i] = at.x, v->y[i] = at.y;
        v->ggx.sine[i] = at.ggx.x, v->ggx.cosine[i] = at.ggx.z;
    }
}

/* one: there is one view for all lanes, which the compiler then keeps. */
INLINE void ggx_loop(struct facets f, size_t n, const struct views *v, bool one,
                     struct dirs u, double *mx, double *my, double *mz)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const size_t k = one ? 0 : i;
        const struct vec3 w = { v->ggx.sine[k], 0, v->ggx.cosine[k] };
        const struct vec3 m =
            facets_stretch(f, v->x[k], v->y[k], ggx_visible(w, u.x[i], u.y[i]));
        mx[i] = m.x, my[i] = m.y, mz[i] = m.z;
    }
}

LANES static void ggx_lanes(struct facets f, size_t n, const struct views *v,
                            bool one, struct dirs u, double *mx, double *my,
                            double *mz)
{
    if (one)
        ggx_loop(f, n, v, true, u, mx, my, mz);
    else
        ggx_loop(f, n, v, false, u, mx, my, mz);
}

LANES static void beckmann_views(struct facets f, size_t n, struct dirs w,
                                 struct views *v)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct facets_view at =
            facets_view(facets_as(f, NDF_BECKMANN), dirs_at(w, i));
        v->x[i] = at.x, v->y[i] = at.y;
        v->beckmann.a[i] = at.beckmann.a;
        v->beckmann.all[i] = at.beckmann.all;
        v->beckmann.toward[i] = at.beckmann.toward;
        v->beckmann.shift[i] = at.beckmann.shift;
        v->beckmann.edge[i] = at.beckmann.edge;
        v->beckmann.bend[i] = at.beckmann.bend;
    }
}

INLINE struct beckmann_seen beckmann_at(const struct views *v, size_t i)
{
    return (struct beckmann_seen){
        v->beckmann.a[i],     v->beckmann.all[i],  v->beckmann.toward[i],
        v->beckmann.shift[i], v->beckmann.edge[i], v->beckmann.bend[i],
    };
}

/* Tails at n slopes, short loops as in along_loop. */
struct tails {
    double e[LANES_MAX], f[LANES_MAX];
};

INLINE void tail_loop(size_t n, const double *x, struct tails *t)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        t->f[i] = beckmann_f(x[i]);
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        t->e[i] = beckmann_e(x[i]);
}

INLINE struct beckmann_tail tail_at(const struct tails *t, size_t i)
{
    return (struct beckmann_tail){ t->e[i], t->f[i] };
}

/* Slopes along w, and which of them are not to be trusted.  In short loops: a
 * processor that waits for a quotient has room for some dozens of instructions,
 * which are then those of other lanes. */
INLINE void along_loop(size_t n, const struct views *v, bool one,
                       const double *u, double *x, uint64_t *late)
{
    struct tails t;
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        t.e[i] = beckmann_rayleigh(u[i]);
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        t.f[i] = beckmann_rayleigh_rest(u[i]);
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        x[i] = beckmann_start(beckmann_at(v, one ? 0 : i), t.e[i], t.f[i]);
    tail_loop(n, x, &t);
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct beckmann_seen w = beckmann_at(v, one ? 0 : i);
        x[i] +=
            beckmann_step(w.a, x[i], tail_at(&t, i), beckmann_target(w, u[i]));
    }
    tail_loop(n, x, &t);
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct beckmann_seen w = beckmann_at(v, one ? 0 : i);
        const double step =
            beckmann_step(w.a, x[i], tail_at(&t, i), beckmann_target(w, u[i]));
        late[i] = beckmann_arrived(w.a, x[i], step) ? 0 : 1;
        x[i] += step;
    }
}

/* The same across w. */
INLINE void across_loop(size_t n, const double *u, double *y, uint64_t *late)
{
    double w[LANES_MAX];
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        w[i] = fm_probit_w(u[i]);
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        y[i] = fm_probit_near(u[i], w[i]);
        late[i] |= fm_probit_is_near(w[i]) ? 0 : 2;
    }
}

INLINE void slope_loop(size_t n, const struct views *v, bool one, struct dirs u,
                       double *x, double *y, uint64_t *late)
{
    along_loop(n, v, one, u.x, x, late);
    across_loop(n, u.y, y, late);
}

LANES static void slope_lanes(size_t n, const struct views *v, bool one,
                              struct dirs u, double *x, double *y,
                              uint64_t *late)
{
    if (one)
        slope_loop(n, v, true, u, x, y, late);
    else
        slope_loop(n, v, false, u, x, y, late);
}

INLINE void stretch_loop(struct facets f, size_t n, const struct views *v,
                         bool one, double *mx, double *my, double *mz)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const size_t k = one ? 0 : i;
        const struct vec3 m = facets_stretch(f, v->x[k], v->y[k],
                                             (struct vec3){ mx[i], my[i], 1 });
        mx[i] = m.x, my[i] = m.y, mz[i] = m.z;
    }
}

LANES static void stretch_lanes(struct facets f, size_t n,
                                const struct views *v, bool one, double *mx,
                                double *my, double *mz)
{
    if (one)
        stretch_loop(f, n, v, true, mx, my, mz);
    else
        stretch_loop(f, n, v, false, mx, my, mz);
}

static void beckmann_lanes(struct facets f, size_t n, const struct views *v,
                           bool one, struct dirs u, double *mx, double *my,
                           double *mz)
{
    uint64_t late[LANES_MAX];
    slope_lanes(n, v, one, u, mx, my, late);
    for (size_t i = 0; i < n; i++) {
        if (late[i] & 1)
            mx[i] = beckmann_slope_surely(v->beckmann.a[one ? 0 : i], u.x[i]);
        if (late[i] & 2)
            my[i] = fm_probit_far(u.y[i], fm_probit_w(u.y[i]));
    }
    stretch_lanes(f, n, v, one, mx, my, mz);
}

void facets_visible_many(struct facets f, size_t n, struct dirs w, bool one,
                         struct dirs u, double *mx, double *my, double *mz)
{
    struct views v;
    if (f.family == NDF_GGX) {
        ggx_views(f, one ? 1 : n, w, &v);
        ggx_lanes(f, n, &v, one, u, mx, my, mz);
    } else {
        beckmann_views(f, one ? 1 : n, w, &v);
        beckmann_lanes(f, n, &v, one, u, mx, my, mz);
    }
}
