/* test_mitsuba.c - Mitsuba 3, through its adapter, against models of ours
 *
 * Two programs that share nothing but the literature agree to what float
 * allows.  Where Mitsuba is not there (`make peer-mitsuba` installs it into
 * build/venv-mitsuba), every test is skipped.
 */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "bsdf/rng.h"
#include "tests/close.h"
#include "validate/foreign.h"

#define PYTHON "build/venv-mitsuba/bin/python"
#define ADAPTER PYTHON " validate/adapters/mitsuba_bsdf.py "

/* 16 roundings of 2^-24, and what a facet at 0.3 makes of them. */
static const double float_limit = 1e-4;

static void needs_mitsuba(void)
{
    if (access(PYTHON, X_OK) != 0 ||
        system(PYTHON " -c 'import mitsuba' 2>/dev/null") != 0)
        skip();
}

static struct bsdf *made(const char *spec)
{
    struct err err;
    struct bsdf *b = foreign_new(spec, &bands_default, &err);
    if (!b)
        fail_msg("%s: %s", spec, err.text);
    return b;
}

/* Half of the directions are above the surface; none is within half a degree of
 * it. */
static struct vec3 direction(struct rng rng, uint64_t i)
{
    const struct vec3 u = rng_uniform(rng, i);
    const double z = copysign(0.01 + 0.99 * fabs(2 * u.x - 1), u.x - 0.5);
    const double r = sqrt((1 - z) * (1 + z)), phi = 6.283185307179586 * u.y;
    return (struct vec3){ r * cos(phi), r * sin(phi), z };
}

/* What is a millionth of the largest value may have lost all its digits. */
static void agree(const char *what, double theirs, double ours, double largest)
{
    if (!(fabs(theirs - ours) <= float_limit * ours + 1e-6 * largest))
        fail_msg("%s: Mitsuba has %.9g, we have %.9g", what, theirs, ours);
}

static const struct {
    const char *ours, *theirs;
} pairs[] = {
    { "diffuse:reflectance=0.2/0.5/0.9",
      "{\"type\": \"diffuse\", \"reflectance\": "
      "{\"type\": \"rgb\", \"value\": [0.2, 0.5, 0.9]}}" },
    { "roughconductor:eta=0.2,k=3.9,alpha=0.3,distribution=ggx,"
      "masking=separable",
      "{\"type\": \"roughconductor\", \"eta\": 0.2, \"k\": 3.9, "
      "\"alpha\": 0.3, \"distribution\": \"ggx\"}" },
    { "roughconductor:eta=0.2,k=3.9,alpha_u=0.3,alpha_v=0.6,distribution=ggx,"
      "masking=separable,sample_visible=false",
      "{\"type\": \"roughconductor\", \"eta\": 0.2, \"k\": 3.9, "
      "\"alpha_u\": 0.3, \"alpha_v\": 0.6, \"distribution\": \"ggx\", "
      "\"sample_visible\": false}" },
    { "roughdielectric:int_ior=1.5,ext_ior=1,alpha=0.4,distribution=ggx,"
      "masking=separable",
      "{\"type\": \"roughdielectric\", \"int_ior\": 1.5, \"ext_ior\": 1.0, "
      "\"alpha\": 0.4, \"distribution\": \"ggx\"}" },
};

enum { PAIRS = sizeof pairs / sizeof *pairs, DIRECTIONS = 4000 };

static void values_and_densities_agree(void **state)
{
    (void)state;
    needs_mitsuba();
    static double ox[DIRECTIONS], oy[DIRECTIONS], oz[DIRECTIONS];
    static double ix[DIRECTIONS], iy[DIRECTIONS], iz[DIRECTIONS];
    static struct spectrum f[2][DIRECTIONS];
    static double pdf[2][DIRECTIONS];
    for (size_t i = 0; i < DIRECTIONS; i++) {
        const struct vec3 wo = direction((struct rng){ 1, 1 }, i);
        const struct vec3 wi = direction((struct rng){ 1, 2 }, i);
        ox[i] = wo.x, oy[i] = wo.y, oz[i] = wo.z;
        ix[i] = wi.x, iy[i] = wi.y, iz[i] = wi.z;
    }
    const struct dirs wo = { ox, oy, oz }, wi = { ix, iy, iz };
    for (int k = 0; k < PAIRS; k++) {
        char spec[400];
        double f_most = 0, pdf_most = 0;
        snprintf(spec, sizeof spec, "pipe:" ADAPTER "'%s'", pairs[k].theirs);
        struct bsdf *b[] = { made(spec), made(pairs[k].ours) };
        for (int side = 0; side < 2; side++) {
            bsdf_eval_many(b[side], DIRECTIONS, wo, wi, f[side]);
            bsdf_pdf_many(b[side], DIRECTIONS, wo, wi, pdf[side]);
        }
        for (size_t i = 0; i < DIRECTIONS; i++) {
            f_most = fmax(f_most, f[1][i].band[1]);
            pdf_most = fmax(pdf_most, pdf[1][i]);
        }
        for (size_t i = 0; i < DIRECTIONS; i++) {
            for (int band = 0; band < 3; band++)
                agree(pairs[k].ours, f[0][i].band[band], f[1][i].band[band],
                      f_most);
            agree(pairs[k].ours, pdf[0][i], pdf[1][i], pdf_most);
        }
        bsdf_free(b[0]);
        bsdf_free(b[1]);
    }
}

static void what_it_says_of_itself(void **state)
{
    (void)state;
    needs_mitsuba();
    struct bsdf *glass = made("pipe:" ADAPTER "'{\"type\": \"dielectric\", "
                              "\"int_ior\": 1.5, \"ext_ior\": 1.0}'");
    const struct bsdf_claims c = bsdf_claims(glass);
    assert_int_equal(c.lobes, BSDF_DELTA);
    assert_true(c.lossless && c.reciprocal && c.two_sided);
    assert_close(c.eta, 1.5, 1e-6);
    assert_close(c.epsilon, 0x1p-23, 0);
    bsdf_free(glass);

    struct bsdf *metal =
        made("pipe:" ADAPTER "'{\"type\": \"roughconductor\"}'");
    assert_int_equal(bsdf_claims(metal).lobes, BSDF_GLOSSY_REFLECTION);
    assert_false(bsdf_claims(metal).two_sided);
    bsdf_free(metal);
}

/* One sample of each side, [0] reflected. */
static void both_sides(const char *spec, struct bsdf_sample side[2])
{
    struct bsdf *b = made(spec);
    for (int i = 0; i < 64; i++) {
        const double u = (i + 0.5) / 64; /* whichever of them chooses */
        const struct bsdf_sample a = bsdf_sample(
            b, (struct vec3){ 0.6, 0, 0.8 }, (struct vec3){ u, u, u });
        side[a.wi.z < 0] = a;
    }
    bsdf_free(b);
}

/* Snell's direction and Fresnel's share, to float. */
static void glass_refracts(void **state)
{
    (void)state;
    needs_mitsuba();
    struct bsdf_sample theirs[2] = { { .pdf = 0 } }, ours[2] = { { .pdf = 0 } };
    both_sides("pipe:" ADAPTER "'{\"type\": \"dielectric\", "
               "\"int_ior\": 1.5, \"ext_ior\": 1.0}'",
               theirs);
    both_sides("dielectric:int_ior=1.5,ext_ior=1", ours);
    for (int k = 0; k < 2; k++) {
        assert_true(theirs[k].delta && theirs[k].pdf > 0);
        assert_close(theirs[k].wi.x, ours[k].wi.x, 1e-6);
        assert_close(theirs[k].wi.z, ours[k].wi.z, 1e-6);
        assert_close(theirs[k].pdf, ours[k].pdf, 1e-6);
        assert_close(theirs[k].weight.band[0], ours[k].weight.band[0], 1e-6);
    }
}

static void refusals(const char *arguments, const char *why)
{
    char spec[400];
    struct err err;
    snprintf(spec, sizeof spec, "pipe:" ADAPTER "%s 2>/dev/null", arguments);
    struct bsdf *b = foreign_new(spec, &bands_default, &err);
    assert_null(b);
    assert_has(err.text, why);
}

static void what_cannot_be_made_says_why(void **state)
{
    (void)state;
    needs_mitsuba();
    refusals("'{\"type\": \"nosuch\"}'", "nosuch");
    refusals("'{\"type\"'", "Expecting");
    refusals("nosuch.xml", "nosuch.xml");
    refusals("--variant nosuch '{\"type\": \"diffuse\"}'",
             "expected one of scalar_rgb");
    refusals("--variant scalar_spectral '{\"type\": \"diffuse\"}'",
             "expected one of rgb");
    refusals("'{\"type\": \"sphere\"}'", "expected a BSDF");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "values and densities are those of our own models",
          values_and_densities_agree },
        { "lobes, losses, sides and the index are found out",
          what_it_says_of_itself },
        { "glass refracts and reflects as ours does", glass_refracts },
        { "what cannot be made says why", what_cannot_be_made_says_why },
    };
    return cmocka_run_group_tests_name("mitsuba", tests, NULL, NULL);
}
