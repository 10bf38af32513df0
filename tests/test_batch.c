/* test_batch.c - many at once are the same bits as one by one
 *
 * The single calls are what the other tests know; a batch has other loops, and
 * on another processor other instructions.
 */
#include "bsdf/bsdf.h"
#include "bsdf/rng.h"
#include "tests/close.h"
#include "validate/partition.h"

enum { EDGES = 14, CORNERS = 9, N = 1500 };

/* Each as x, y, z. */
struct batch {
    double wo[3][N], wi[3][N], u[3][N];
    size_t n;
};

static void put(double d[3][N], size_t i, struct vec3 w)
{
    d[0][i] = w.x, d[1][i] = w.y, d[2][i] = w.z;
}

static struct dirs of(const double d[3][N], size_t at)
{
    return (struct dirs){ d[0] + at, d[1] + at, d[2] + at };
}

/* Straight up and down, grazing, within rounding of it, and anywhere. */
static struct vec3 edge(size_t i)
{
    static const double z[EDGES] = { 1,     -1,          0,         1e-8, -1e-8,
                                     1e-3,  0x1p-53,     1e-120,    0.6,  -0.6,
                                     0.999, 1 - 0x1p-53, -0x1p-400, 0.2 };
    const double r = sqrt((1 - z[i]) * (1 + z[i]));
    const double turn = i % 3 == 0 ? 0 : (double)i;
    return (struct vec3){ r * cos(turn), r * sin(turn), z[i] };
}

static const double corner[CORNERS] = { 0,    0x1p-1022,   0x1p-53,
                                        1e-9, 0.25,        0.5,
                                        0.75, 1 - 0x1p-24, 1 - 0x1p-53 };

/* Every edge with every edge and the corners of u, then at random, the first
 * part of that with one wo, as when a lobe is drawn. */
static struct batch *batch(void)
{
    static struct batch b;
    for (b.n = 0; b.n < EDGES * EDGES; b.n++) {
        const size_t i = b.n;
        put(b.wo, i, edge(i / EDGES));
        put(b.wi, i, edge(i % EDGES));
        put(b.u, i,
            (struct vec3){ corner[i % CORNERS], corner[i / CORNERS % CORNERS],
                           corner[i / 7 % CORNERS] });
    }
    for (; b.n < N; b.n++) {
        const struct rng rng = { 3, 0 };
        const struct vec3 a = rng_uniform(rng, 3 * b.n);
        const struct vec3 c = rng_uniform(rng, 3 * b.n + 1);
        put(b.wo, b.n,
            b.n < N / 2 ? dir_from_degrees(52, 31)
                        : dir_from_degrees(100 * a.x, 360 * a.y));
        put(b.wi, b.n, dir_from_degrees(100 * c.x, 360 * c.y));
        put(b.u, b.n, rng_uniform(rng, 3 * b.n + 2));
    }
    return &b;
}

static bool is_nan(struct spectrum s)
{
    bool nan = false;
    for (int b = 0; b < BANDS_MAX; b++)
        nan |= isnan(s.band[b]);
    return nan;
}

static bool samples_equal(const struct bsdf_sample *a,
                          const struct bsdf_sample *b)
{
    return memcmp(&a->wi, &b->wi, sizeof a->wi) == 0 &&
           memcmp(&a->pdf, &b->pdf, sizeof a->pdf) == 0 &&
           memcmp(&a->weight, &b->weight, sizeof a->weight) == 0 &&
           a->delta == b->delta;
}

/* From one of them on, as blocks of a batch end anywhere. */
static void compare(const struct bsdf *b, const struct batch *in, size_t at,
                    size_t n)
{
    static struct spectrum f[N];
    static double pdf[N];
    static struct bsdf_sample sample[N];
    const struct dirs wo = of(in->wo, at), wi = of(in->wi, at);
    const struct dirs u = of(in->u, at);
    bsdf_eval_many(b, n, wo, wi, f);
    bsdf_pdf_many(b, n, wo, wi, pdf);
    bsdf_sample_many(b, n, wo, u, sample);
    for (size_t i = 0; i < n; i++) {
        const struct vec3 o = dirs_at(wo, i), w = dirs_at(wi, i);
        const struct spectrum one = bsdf_eval(b, o, w);
        const double p = bsdf_pdf(b, o, w);
        const struct bsdf_sample s = bsdf_sample(b, o, dirs_at(u, i));
        if (memcmp(&f[i], &one, sizeof one) == 0 &&
            memcmp(&pdf[i], &p, sizeof p) == 0 &&
            samples_equal(&sample[i], &s) && !is_nan(one) && !isnan(p) &&
            !isnan(s.pdf) && !is_nan(s.weight))
            continue;
        print_error(
            "%s\n  wo %a %a %a, wi %a %a %a, u %a %a %a\n"
            "  f %a, pdf %a, sample %a %a %a, pdf %a, weight %a: one\n"
            "  f %a, pdf %a, sample %a %a %a, pdf %a, weight %a: many\n",
            bsdf_spec(b), o.x, o.y, o.z, w.x, w.y, w.z, u.x[i], u.y[i], u.z[i],
            one.band[0], p, s.wi.x, s.wi.y, s.wi.z, s.pdf, s.weight.band[0],
            f[i].band[0], pdf[i], sample[i].wi.x, sample[i].wi.y,
            sample[i].wi.z, sample[i].pdf, sample[i].weight.band[0]);
        fail();
    }
}

static void are_the_same_bits(void **specs)
{
    static const struct bands bands[] = { { 1, { 550 } },
                                          { 3, { 614, 549, 466 } },
                                          { 4, { 614, 549, 466, 500 } } };
    const struct batch *in = batch();
    for (const char *const *spec = (const char *const *)*specs; *spec; spec++)
        for (size_t k = 0; k < sizeof bands / sizeof *bands; k++) {
            struct err err;
            struct bsdf *b = bsdf_new(*spec, &bands[k], &err);
            if (!b)
                fail_msg("%s", err.text);
            compare(b, in, 0, in->n);
            for (size_t n = 0; n < 70; n++)
                compare(b, in, 7 * n, n);
            bsdf_free(b);
        }
}

static void random_numbers_are_the_same_bits(void **state)
{
    (void)state;
    const struct rng rng = { 11, 0xfedcba9876543210 };
    const uint64_t first = 0xfffffffffffffff0; /* the index wraps */
    double x[40], y[40], z[40];
    for (size_t n = 0; n <= 40; n++) {
        rng_uniform_many(rng, first, n, x, y, z);
        for (size_t i = 0; i < n; i++) {
            const struct vec3 u = rng_uniform(rng, first + i);
            assert_true(x[i] == u.x && y[i] == u.y && z[i] == u.z);
        }
    }
}

/* Whether a bin's angles hold a direction, but for rounding. */
static bool holds(struct patch p, struct vec3 w)
{
    const double slack = 1e-14;
    const double theta = atan2(sqrt(w.x * w.x + w.y * w.y), w.z);
    const double middle = (p.phi0 + p.phi1) / 2;
    const double phi = remainder(atan2(w.y, w.x) - middle, 2 * PI);
    return theta >= p.theta0 - slack && theta <= p.theta1 + slack &&
           (fabs(phi) <= (p.phi1 - p.phi0) / 2 + slack ||
            theta * (PI - theta) < 1e-300);
}

/* A corner of a bin, or within rounding of it. */
static struct vec3 corner_of(struct patch p, size_t which)
{
    const double theta = which & 1 ? p.theta0 : p.theta1;
    const double phi = which & 2 ? p.phi0 : p.phi1;
    const double off = ((double)(which / 4 % 3) - 1) * 0x1p-53;
    return (struct vec3){ sin(theta + off) * cos(phi), sin(theta) * sin(phi),
                          cos(theta) };
}

/* All together, and as blocks that start and end anywhere. */
static void find_them(const struct partition *p, size_t n, struct dirs w)
{
    static uint32_t all[N], some[N];
    partition_find(p, n, w, all);
    for (size_t i = 0; i < n; i++) {
        const struct vec3 d = dirs_at(w, i);
        if (!(vec3_dot(d, d) > 0.5))
            assert_int_equal(all[i], partition_bins(p));
        else if (all[i] >= partition_bins(p) ||
                 !holds(partition_patch(p, all[i]), d))
            fail_msg("%a %a %a is not in bin %u", d.x, d.y, d.z, all[i]);
    }
    for (size_t at = 0, k = 0; at < n; at += k) {
        k = at % 7 + 1 < n - at ? at % 7 + 1 : n - at;
        partition_find(p, k, dirs_from(w, at), some);
        assert_memory_equal(some, all + at, k * sizeof *some);
    }
}

/* Pilots of two lobes; one side has none. */
static struct partition *bins_about(struct vec3 a, struct vec3 b, double width)
{
    enum { PILOTS = 3000 };
    static struct vec3 pilot[PILOTS];
    for (size_t i = 0; i < PILOTS; i++) {
        const struct vec3 u = rng_uniform((struct rng){ 5, 0 }, i);
        const struct vec3 off = { width * (u.x - 0.5), width * (u.y - 0.5),
                                  width * (u.z - 0.5) };
        pilot[i] = vec3_unit(vec3_add(i % 3 ? a : b, off));
    }
    struct partition *p = partition_new(pilot, PILOTS, 0);
    assert_non_null(p);
    return p;
}

static void directions_are_in_their_bins(void **state)
{
    (void)state;
    static double w[3][N];
    const struct vec3 up = dir_from_degrees(40, 170);
    struct partition *const p[] = {
        bins_about(up, dir_from_degrees(80, 10), 0.3),
        bins_about(up, dir_from_degrees(130, -90), 1),
        bins_about(up, dir_from_degrees(179.99, 0), 1e-4),
        bins_about(dir_from_degrees(95, 0), dir_from_degrees(0, 0), 0.01),
        partition_new(NULL, 0, 0),
    };
    for (size_t k = 0; k < sizeof p / sizeof *p; k++) {
        for (size_t i = 0; i < EDGES * CORNERS; i++)
            put(w, i, edge(i % EDGES));
        put(w, 0, (struct vec3){ NAN, 0, 1 });
        put(w, 1, (struct vec3){ 0, 0, 0 });
        put(w, 2, (struct vec3){ 0, -1, -0.0 });
        find_them(p[k], EDGES * CORNERS, of(w, 0));
        for (size_t i = 0; i < 12 * partition_bins(p[k]); i += N) {
            for (size_t j = 0; j < N; j++)
                put(w, j,
                    corner_of(partition_patch(p[k], (i + j) / 12 %
                                                        partition_bins(p[k])),
                              (i + j) % 12));
            find_them(p[k], N, of(w, 0));
        }
        for (size_t i = 0; i < 200 * (size_t)N; i += N) {
            for (size_t j = 0; j < N; j++) {
                const struct vec3 u = rng_uniform((struct rng){ 6, k }, i + j);
                const double z = 2 * u.x - 1, r = sqrt((1 - z) * (1 + z));
                put(w, j,
                    (struct vec3){ r * cos(2 * PI * u.y), r * sin(2 * PI * u.y),
                                   z });
            }
            find_them(p[k], N, of(w, 0));
        }
        partition_free(p[k]);
    }
}

int main(void)
{
#define CONDUCTOR "roughconductor:eta=0.3,k=2.7,"
#define GLASS "roughdielectric:int_ior=1.5,"
    static const char *conductor[] = {
        CONDUCTOR "alpha=0.25",
        CONDUCTOR "alpha=0.25,distribution=ggx",
        CONDUCTOR "alpha=0.0001",
        CONDUCTOR "alpha=0.0001,distribution=ggx",
        CONDUCTOR "alpha_u=1,alpha_v=0.005,masking=separable",
        CONDUCTOR "alpha_u=1,alpha_v=0.005,distribution=ggx,fresnel=schlick",
        CONDUCTOR "alpha=0.3,sample_visible=false,fresnel=approx",
        CONDUCTOR "alpha_u=0.1,alpha_v=1,distribution=ggx,sample_visible=false,"
                  "masking=separable,specular_reflectance=0.7",
        NULL
    };
    static const char *glass[] = {
        GLASS "alpha=0.25",
        GLASS "alpha=0.25,distribution=ggx",
        GLASS "alpha=0.0001",
        GLASS "alpha_u=1,alpha_v=0.005,masking=separable",
        GLASS "alpha=0.3,sample_visible=false,lobes=reflection",
        GLASS "alpha=0.3,distribution=ggx,sample_visible=false,"
              "lobes=transmission",
        "roughdielectric:int_ior=1,ext_ior=1.7,alpha=0.4",
        "roughdielectric:int_ior=1.5,ext_ior=1.5,alpha=0.4",
        NULL
    };
    static const char *others[] = {
        "diffuse:reflectance=0.4",
        "mirror",
        "conductor:eta=0.3,k=2.7",
        "dielectric",
        "thindielectric",
        "refraction",
        "course_microfacet:eta=0.3,k=2.7,alpha=0.2",
        "course_microfacet:eta=0.3,k=2.7,lambda=exact,fresnel_at=half",
        "course_glass",
        "twosided:front=(roughconductor)",
        "blendbsdf:bsdf_0=(diffuse),bsdf_1=(roughconductor)",
        NULL
    };
    const struct CMUnitTest tests[] = {
        { "a rough conductor gives the same bits in batches", are_the_same_bits,
          .initial_state = conductor },
        { "rough glass gives the same bits in batches", are_the_same_bits,
          .initial_state = glass },
        { "the other models give the same bits in batches", are_the_same_bits,
          .initial_state = others },
        { "random numbers are the same bits in batches",
          random_numbers_are_the_same_bits },
        { "directions are found in the bins that hold them",
          directions_are_in_their_bins },
    };
    return cmocka_run_group_tests_name("batch", tests, NULL, NULL);
}
