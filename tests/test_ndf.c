/* test_ndf.c - what makes a function a distribution of microfacet normals */
#include "bsdf/fresnel.h"
#include "bsdf/ndf.h"
#include "tests/close.h"
#include "validate/sphere.h"

static const double ax = 0.237, ay = 0.618;

static double projected_area(struct vec3 m, const void *ndf)
{
    return m.z * ndf_d(ndf, ax, ay, m);
}

static void unit_area(void **ndf)
{
    assert_close(hemisphere(projected_area, *ndf).value, 1, 1e-9);
}

struct seen {
    const struct ndf *ndf;
    struct vec3 wo;
};

static double seen_area(struct vec3 m, const void *context)
{
    const struct seen *s = context;
    return vec3_dot(m, s->wo) * ndf_d(s->ndf, ax, ay, m);
}

static void seen_area_is_the_cosine(void **ndf)
{
    static const double theta_deg[] = { 3, 31, 62, 83, 89.7 };
    for (int i = 0; i < 5; i++) {
        const struct seen s = { *ndf, dir_from_degrees(theta_deg[i], 137) };
        const double area = hemisphere_facing(seen_area, &s, s.wo, 1e-12).value;
        assert_close(area * ndf_g1(s.ndf, ax, ay, s.wo) / s.wo.z, 1, 1e-8);
    }
}

/* bc -l, 40 digits: e(-2.385)/(4*a(1)), and for a = .731
 * (e(-a^2)/(a*sqrt(4*a(1))) - erfc)/2 with erfc from its series. */
static void forty_digits_of_bc(void **state)
{
    (void)state;
    assert_close(ndf_beckmann.p22(2.385), 0.029312832608662412, 1e-15);
    assert_close(ndf_beckmann.lambda(0.731), 0.075538614993236875, 1e-15);
}

/* The share of visible facets whose slope in the plane of w is below x, by the
 * integral of (a + t) exp(-t^2) over t > -a. */
static double share_below(double a, double x)
{
    const double all = a * erfc(-a) / 2 + exp(-a * a) / (2 * sqrt(PI));
    return 1 - (a * erfc(x) / 2 + exp(-x * x) / (2 * sqrt(PI))) / all;
}

static void beckmann_inverts_what_is_seen(void **state)
{
    (void)state;
    static const double cot[] = { 1e-8, 1e-3, 0.1, 0.731, 2, 9, 1e3, 1e8 };
    for (int i = 0; i < 8; i++)
        for (double u = 0.0005; u < 1; u += 0.013) {
            const double length = hypot(1, cot[i]);
            const struct vec3 w = { 1 / length, 0, cot[i] / length };
            const struct vec3 m = ndf_beckmann.visible(w, u, 0.3);
            assert_close(share_below(w.z / w.x, m.x / m.z), u, 4e-14);
        }
}

/* Roughness and grazing to the limits: unit normals, on the side that faces
 * w, without a NaN. */
static void sampling_holds_to_the_edges(void **ndf)
{
    static const double alpha[] = { 1e-4, 0.03, 1 };
    static const double cosine[] = { 1e-8, 1e-3, 0.3, 1 };
    static const double end[] = { 0,   0x1p-53, 1e-9,        0.25,
                                  0.5, 0.9,     1 - 0x1p-24, 1 - 0x1p-53 };
    for (int i = 0; i < 3 * 3 * 4 * 8 * 8; i++) {
        const double au = alpha[i % 3], av = alpha[i / 3 % 3];
        const double c = cosine[i / 9 % 4], s = sqrt((1 - c) * (1 + c));
        const struct vec3 w = { 0.6 * s, 0.8 * s, c };
        const double u = end[i / 36 % 8], v = end[i / 288];
        const struct vec3 m = ndf_sample_visible(*ndf, au, av, w, u, v);
        assert_close(vec3_length(m), 1, 1e-15);
        assert_true(m.z > 0);
        /* The farthest visible normal is a difference of two vectors, good to
         * 2^-53 of them over its own length, some sqrt(1 - u); it has no
         * direction at all where u is the last below 1 and v is a half. */
        if (u < 1 - 0x1p-53 || v != 0.5)
            assert_true(vec3_dot(m, w) >= -2e-8);
        const struct vec3 n = ndf_sample_all(*ndf, au, av, u, v);
        assert_close(vec3_length(n), 1, 1e-15);
        assert_true(n.z > 0);
        assert_true(isfinite(ndf_d(*ndf, au, av, m)));
        assert_true(ndf_g1(*ndf, au, av, w) > 0);
    }
}

/* G1 / cos_o has a limit at the horizon, so a lobe seen at a cosine of 1e-8 is
 * not lost: it is that of 1e-7 to seven digits. */
static void nothing_is_lost_at_grazing(void **ndf)
{
    const struct vec3 a = { 1, 0, 1e-8 }, b = { 1, 0, 1e-7 };
    const double ga = ndf_g1(*ndf, 0.2, 0.2, a) / a.z;
    const double gb = ndf_g1(*ndf, 0.2, 0.2, b) / b.z;
    assert_true(ga > 1);
    assert_close(ga / gb, 1, 1e-5);
}

static void stretching_both_ways_is_scaling(void **ndf)
{
    const struct vec3 w = dir_from_degrees(61, 17);
    const struct vec3 turned = dir_from_degrees(61, 107);
    assert_close(ndf_g1(*ndf, ax, ay, w), ndf_g1(*ndf, ay, ax, turned), 1e-15);
    assert_close(ndf_d(*ndf, ax, ay, w), ndf_d(*ndf, ay, ax, turned), 1e-14);
}

/* Born and Wolf: at normal incidence ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2), at
 * grazing 1; n = 1.5: 4 %, nothing p-polarised at Brewster's angle. */
static void fresnel_has_its_known_values(void **state)
{
    (void)state;
    const double n = 0.29294, k = 2.71809;
    assert_close(fresnel_conductor(1, n, k),
                 ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k),
                 1e-15);
    assert_close(fresnel_conductor(0, n, k), 1, 1e-15);
    assert_close(fresnel_conductor(0.37, 0, 1), 1, 1e-15);
    double cos_t;
    assert_close(fresnel_dielectric(1, 1.5, &cos_t), 0.04, 1e-16);
    assert_close(fresnel_conductor(0.6, 1.5, 0),
                 fresnel_dielectric(0.6, 1.5, NULL), 1e-15);
    const double brewster = cos(atan(1.5));
    const double rs = (1 - 1.5 * 1.5) / (1 + 1.5 * 1.5);
    assert_close(fresnel_dielectric(brewster, 1.5, NULL), rs * rs / 2, 1e-15);
    assert_close(fresnel_dielectric(0.7, 1 / 1.5, &cos_t), 1, 0);
    assert_true(cos_t == 0);
    assert_close(fresnel_dielectric(0.3, 1, NULL), 0, 1e-30);
}

int main(void)
{
    void *beckmann = (void *)&ndf_beckmann, *ggx = (void *)&ndf_ggx;
    const struct CMUnitTest tests[] = {
        { "beckmann facets project to unit area", unit_area,
          .initial_state = beckmann },
        { "ggx facets project to unit area", unit_area, .initial_state = ggx },
        { "beckmann facets that wo sees project to cos_o",
          seen_area_is_the_cosine, .initial_state = beckmann },
        { "ggx facets that wo sees project to cos_o", seen_area_is_the_cosine,
          .initial_state = ggx },
        { "beckmann agrees with 40 digits of bc", forty_digits_of_bc },
        { "beckmann inverts the share of facets seen",
          beckmann_inverts_what_is_seen },
        { "beckmann is sampled to the edges", sampling_holds_to_the_edges,
          .initial_state = beckmann },
        { "ggx is sampled to the edges", sampling_holds_to_the_edges,
          .initial_state = ggx },
        { "beckmann keeps its lobe at a cosine of 1e-8",
          nothing_is_lost_at_grazing, .initial_state = beckmann },
        { "ggx keeps its lobe at a cosine of 1e-8", nothing_is_lost_at_grazing,
          .initial_state = ggx },
        { "beckmann turns with its roughnesses",
          stretching_both_ways_is_scaling, .initial_state = beckmann },
        { "ggx turns with its roughnesses", stretching_both_ways_is_scaling,
          .initial_state = ggx },
        { "fresnel has its known values", fresnel_has_its_known_values },
    };
    return cmocka_run_group_tests_name("ndf", tests, NULL, NULL);
}
