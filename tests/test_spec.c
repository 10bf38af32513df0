/* test_spec.c - specs make what they say, or say what is wrong */
#include <stdio.h>
#include <stdlib.h>

#include "bsdf/bsdf.h"
#include "bsdf/rng.h"
#include "tests/close.h"

static void made(const char *spec)
{
    struct err err;
    struct bsdf *b = bsdf_new(spec, &bands_default, &err);
    if (!b)
        fail_msg("%s: %s", spec, err.text);
    assert_string_equal(bsdf_spec(b), spec);
    bsdf_free(b);
}

/* Refused, with all of these in the reason. */
static void refused(const char *spec, const char *a, const char *b)
{
    struct err err;
    struct bsdf *made = bsdf_new(spec, &bands_default, &err);
    if (made)
        fail_msg("%s was taken", spec);
    assert_has(err.text, a);
    assert_has(err.text, b);
}

static void good_specs_are_made(void **state)
{
    (void)state;
    made("diffuse");
    made("diffuse:reflectance=0.1/0.2/0.3");
    made("diffuse:reflectance='.5'");
    made("roughconductor:material='Ca',alpha=1e-4");
    made("roughconductor:material='data/ior/Ca/Mathewson.yml'");
    made("roughconductor:eta=0,k=1,alpha_u=1,alpha_v=0.0001,distribution=ggx,"
         "sample_visible=false,masking=separable,fresnel=schlick,"
         "specular_reflectance=1/0/0.5");
    made("dielectric:int_ior=diamond,ext_ior='fused quartz'");
    made("twosided:front=(blendbsdf:bsdf_0=(diffuse:reflectance='.5'),"
         "bsdf_1=(roughconductor:material='Ca')),back=(mirror)");
    made("course_microfacet:material=none,lambda=exact,fresnel_at=half");
}

static void what_is_wrong_is_named(void **state)
{
    (void)state;
    refused("", "expected name", "");
    refused("rough conductor", "expected name", "rough conductor");
    refused("roughconducter", "did you mean \"roughconductor\"", "diffuse");
    refused("zzz", "unknown", "mirror");
    refused("diffuse:", "after the colon", "");
    refused("diffuse:reflectance", "expected key=value", "reflectance");
    refused("diffuse:reflectance=", "expected a number", "reflectance=");
    refused("diffuse:reflectance=0.5,", "after the last comma", "");
    refused("diffuse:reflectance=0.5,,", "expected key=value", "");
    refused("diffuse:reflectance=1.5", "= 1.5", "[0, 1]");
    refused("diffuse:reflectance=nan", "nan", "[0, 1]");
    refused("diffuse:reflectance=0.1/0.2", "2 values", "3 bands");
    refused("diffuse:reflectance=0.1/0.2/0.3/0.4/0.5", "5 values", "3 bands");
    refused("diffuse:reflectance=0.1//0.3", "expected a number", "");
    refused("diffuse:reflectance=0.5x", "expected a number", "0.5x");
    refused("diffuse:reflectance= 0.5", "expected a number", "");
    refused("diffuse:reflectance=0.5,reflectance=0.5", "given twice", "");
    refused("diffuse:reflectance='0.5", "never closed", "");
    refused("diffuse:reflectance='0.5'x", "expected a comma", "x");
    refused("diffuse:reflectanse=1", "did you mean \"reflectance\"", "");
    refused("roughconductor:distribution=beckman", "did you mean \"beckmann\"",
            "distribution");
    refused("roughconductor:sample_visible=yes", "false, true", "yes");
    refused("roughconductor:alpha=0", "= 0", "[0.0001, 1]");
    refused("roughconductor:alpha=0.1,alpha_u=0.1,alpha_v=0.1", "either alpha",
            "not both");
    refused("roughconductor:alpha_u=0.1", "without alpha_v", "");
    refused("roughconductor:eta=1", "eta", "without k");
    refused("roughconductor:eta=0,k=0", "eta = k = 0", "band 1");
    refused("roughconductor:eta=1,k=1,material=Au", "either material", "");
    refused("roughconductor:material=Cq", "Cq", "Ca");
    refused("roughconductor:material='no/such.yml'", "no/such.yml", "");
    refused("twosided", "expected a model", "front=(diffuse)");
    refused("twosided:front=(dielectric)", "dielectric", "transmits");
    refused("twosided:front=(diffus)", "front", "did you mean \"diffuse\"");
    refused("twosided:front=(diffuse", "never closed", "(diffuse");
    refused("twosided:front=diffuse", "in parentheses", "diffuse");
    refused("twosided:front=(diffuse))", "not opened", "");
    refused("twosided:front=((((((((((((((((((diffuse))))))))))))))))))",
            "16 deep", "");
    refused("blendbsdf:bsdf_0=(diffuse)", "bsdf_1 is missing", "");
    refused("blendbsdf:bsdf_0=(mirror),bsdf_1=(mirror)", "same delta lobe", "");
    refused("dielectric:int_ior=glas", "glas", "int_ior");
    refused("dielectric:int_ior=0.01", "0.01", "[0.1, 100]");
    refused("dielectric:int_ior=nan", "nan", "[0.1, 100]");
    refused("mirror:reflectance=0x1p+4", "= 16", "[0, 1]");
}

static void a_material_ends_where_its_table_does(void **state)
{
    (void)state;
    const struct bands red = { 1, { 5000 } };
    struct err err;
    assert_null(bsdf_new("roughconductor:material=Ca", &red, &err));
    assert_has(err.text, "5000");
    assert_has(err.text, "1653.12");
}

static void no_mutilated_spec_crashes(void **state)
{
    (void)state;
    static const char spec[] =
        "roughconductor:material='Ca',alpha_u=0.2,alpha_v=0.1,"
        "specular_reflectance=1/0.5/0.1,distribution=ggx";
    static const char odd[] = "\1\t '\",/:=\\x\x7f\xff%s0";
    char copy[sizeof spec];
    struct err err;
    long refusals = 0;
    for (size_t cut = 0; cut < sizeof spec; cut++) {
        memcpy(copy, spec, sizeof spec);
        copy[cut] = '\0';
        struct bsdf *b = bsdf_new(copy, &bands_default, &err);
        refusals += !b;
        assert_true(b || strlen(err.text) > 10);
        bsdf_free(b);
        for (const char *c = odd; *c && cut + 1 < sizeof spec; c++) {
            memcpy(copy, spec, sizeof spec);
            copy[cut] = *c;
            b = bsdf_new(copy, &bands_default, &err);
            refusals += !b;
            bsdf_free(b);
        }
    }
    assert_true(refusals > 1000);
}

static void a_huge_spec_is_refused(void **state)
{
    (void)state;
    struct err err;
    const size_t size = 10000000;
    char *spec = malloc(size + 1);
    assert_non_null(spec);
    memset(spec, '7', size);
    memcpy(spec, "diffuse:reflectance=", 20);
    spec[size] = '\0';
    assert_null(bsdf_new(spec, &bands_default, &err));
    memset(spec, 'a', size);
    assert_null(bsdf_new(spec, &bands_default, &err));
    free(spec);
}

static void wavelengths_are_read_or_refused(void **state)
{
    (void)state;
    struct bands bands = bands_default;
    struct err err;
    assert_true(bands_parse(&bands, "589.3", &err));
    assert_int_equal(bands.count, 1);
    assert_true(bands_parse(&bands, "400,500,600,700", &err));
    assert_int_equal(bands.count, 4);
    static const char *const bad[] = { "",         ",",       "500,",
                                       "500,,600", "0",       "-5",
                                       "nan",      "inf",     "1,2,3,4,5",
                                       "5e10",     "500 600", "x" };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const struct bands before = bands;
        assert_false(bands_parse(&bands, bad[i], &err));
        assert_has(err.text, "expected");
        assert_memory_equal(&bands, &before, sizeof bands);
    }
}

static void angles_are_exact_at_quarter_turns(void **state)
{
    (void)state;
    const struct vec3 x = dir_from_degrees(90, 360e6);
    assert_true(x.x == 1 && x.y == 0 && x.z == 0);
    const struct vec3 y = dir_from_degrees(90, -270);
    assert_true(y.x == 0 && y.y == 1 && y.z == 0);
    const struct vec3 down = dir_from_degrees(180, 12);
    assert_true(down.z == -1 && down.x == 0);
    /* sin and cos of 37 deg by bc, 20 digits */
    const struct vec3 w = dir_from_degrees(37, 180 - 720);
    assert_close(w.x, -0.60181502315204827992, 1e-16);
    assert_close(w.z, 0.79863551004729284628, 1e-16);
    const struct angles back = dir_to_degrees(w);
    assert_close(back.theta_deg, 37, 1e-13);
    assert_close(fabs(back.phi_deg), 180, 1e-13);
}

/* The answer that Random123's own kat_vectors file gives for threefry4x64-20.
 */
static void threefry_gives_the_known_answer(void **state)
{
    (void)state;
    const struct vec3 u = rng_uniform((struct rng){ 0, 0 }, 0);
    assert_true(u.x == (double)(0x09218ebde6c85537 >> 11) * 0x1p-53);
    assert_true(u.y == (double)(0x55941f5266d86105 >> 11) * 0x1p-53);
    assert_true(u.z == (double)(0x4bd25e16282434dc >> 11) * 0x1p-53);
}

static void many_at_once_are_the_same_bits(void **state)
{
    (void)state;
    enum { N = 257 };
    static double wx[N], wy[N], wz[N], x[N], y[N], z[N], ux[N], uy[N], uz[N];
    static struct spectrum f[N];
    static double pdf[N];
    static struct bsdf_sample sample[N];
    struct err err;
    for (int i = 0; i < N; i++) {
        const struct rng rng = { 5, 1 };
        const struct vec3 a = rng_uniform(rng, (uint64_t)(3 * i));
        const struct vec3 b = rng_uniform(rng, (uint64_t)(3 * i + 1));
        const struct vec3 u = rng_uniform(rng, (uint64_t)(3 * i + 2));
        const struct vec3 wo = dir_from_degrees(100 * a.x, 360 * a.y);
        const struct vec3 wi = dir_from_degrees(100 * b.x, 360 * b.y);
        wx[i] = wo.x, wy[i] = wo.y, wz[i] = wo.z;
        x[i] = wi.x, y[i] = wi.y, z[i] = wi.z;
        ux[i] = u.x, uy[i] = u.y, uz[i] = u.z;
    }
    const struct dirs wo = { wx, wy, wz }, wi = { x, y, z }, u = { ux, uy, uz };
    for (int t = 0; bsdf_types[t]; t++) {
        const char *name = bsdf_types[t]->name;
        const char *spec =
            strcmp(name, "twosided") == 0 ? "twosided:front=(roughconductor)"
            : strcmp(name, "blendbsdf") == 0
                ? "blendbsdf:bsdf_0=(diffuse),bsdf_1=(roughdielectric)"
                : name;
        struct bsdf *b = bsdf_new(spec, &bands_default, &err);
        if (!b)
            fail_msg("%s", err.text);
        bsdf_eval_many(b, N, wo, wi, f);
        bsdf_pdf_many(b, N, wo, wi, pdf);
        bsdf_sample_many(b, N, wo, u, sample);
        for (size_t i = 0; i < N; i++) {
            const struct vec3 o = dirs_at(wo, i), w = dirs_at(wi, i);
            const struct spectrum one = bsdf_eval(b, o, w);
            const struct bsdf_sample s = bsdf_sample(b, o, dirs_at(u, i));
            assert_memory_equal(&f[i], &one, sizeof one);
            assert_true(pdf[i] == bsdf_pdf(b, o, w));
            assert_memory_equal(&sample[i].wi, &s.wi, sizeof s.wi);
            assert_memory_equal(&sample[i].weight, &s.weight, sizeof s.weight);
            assert_true(sample[i].pdf == s.pdf && sample[i].delta == s.delta);
        }
        bsdf_free(b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "good specs are made", good_specs_are_made },
        { "bad specs are refused with the reason", what_is_wrong_is_named },
        { "a material ends where its table does",
          a_material_ends_where_its_table_does },
        { "no mutilated spec crashes", no_mutilated_spec_crashes },
        { "ten megabytes of spec are refused", a_huge_spec_is_refused },
        { "wavelengths are read or refused", wavelengths_are_read_or_refused },
        { "angles are exact at quarter turns",
          angles_are_exact_at_quarter_turns },
        { "threefry gives the known answer", threefry_gives_the_known_answer },
        { "many at once are the same bits as one by one",
          many_at_once_are_the_same_bits },
    };
    return cmocka_run_group_tests_name("spec", tests, NULL, NULL);
}
