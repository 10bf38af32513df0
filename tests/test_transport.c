/* test_transport.c - what a path tracer must return, where that is known
 *
 * Every expectation is held against the picture's own standard error; the
 * significance of a test is that of six standard errors, 2e-9.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "integrator/render.h"
#include "integrator/trace.h"
#include "tests/close.h"
#include "validate/energy.h"
#include "validate/subject.h"

/* -- scenes by hand ---------------------------------------------------------
 */

static struct scene *empty(void)
{
    struct err err;
    struct scene *s = scene_new(&bands_default, &err);
    assert_non_null(s);
    return s;
}

static void done(bool ok, const struct err *err)
{
    if (!ok)
        print_message("%s\n", err->text);
    assert_true(ok);
}

static struct surface matter(struct scene *s, const char *spec, double radiance)
{
    struct err err;
    const struct surface out = { .bsdf = scene_add_bsdf(s, spec, &err),
                                 .radiance = spectrum_of(3, radiance),
                                 .name = spec };
    done(out.bsdf >= 0, &err);
    return out;
}

/* Looks from one point at another; pixels of so many degrees. */
static void look(struct scene *s, struct vec3 from, struct vec3 at, int pixels,
                 double degrees)
{
    struct camera c = { .width = pixels,
                        .height = pixels,
                        .focal = 1 / tan(degrees * PI / 180),
                        .near = 0,
                        .far = INFINITY };
    const struct vec3 along = vec3_minus(at, from);
    const struct vec3 up = fabs(along.y) > 0.9 * vec3_length(along)
                               ? (struct vec3){ 0, 0, 1 }
                               : (struct vec3){ 0, 1, 0 };
    assert_true(affine_look_at(from, at, up, &c.to_world));
    scene_set_camera(s, &c);
}

static const struct render_settings usual = {
    .path = { .max_depth = 1,
              .only_bounce = -1,
              .light_samples = 1,
              .rr_depth = PATH_DEPTH_MAX },
    .samples = 256,
    .seed = 1,
};

/* The mean of a picture, of one band, and its standard error. */
struct brightness {
    double value, error;
};

static struct brightness mean_of(const struct film *f, int band)
{
    const size_t n = (size_t)f->width * (size_t)f->height;
    struct brightness m = { 0, 0 };
    for (size_t i = 0; i < n; i++) {
        m.value += (double)f->pixel[i].mean[band];
        m.error += (double)f->pixel[i].variance[band];
    }
    m.value /= (double)n;
    m.error = sqrt(m.error) / (double)n;
    return m;
}

static struct brightness rendered(struct scene *s,
                                  const struct render_settings *set, int band)
{
    struct err err;
    struct render_result made;
    done(render(s, set, &made, &err), &err);
    assert_int_equal(made.bad, 0);
    const struct brightness m = mean_of(made.film, band);
    film_free(made.film);
    return m;
}

/* Six standard errors, and what floats of the film may be off. */
static void expect(struct brightness m, double value)
{
    if (!(fabs(m.value - value) <= 6 * m.error + 2e-6 * fabs(value)))
        fail_msg("%.8g +- %.2g: expected %.8g", m.value, m.error, value);
}

/* -- direct light -----------------------------------------------------------
 */

static void floor_under(struct scene *s, double reflectance)
{
    char spec[64];
    struct err err;
    snprintf(spec, sizeof spec, "diffuse:reflectance=%g", reflectance);
    const struct surface matt = matter(s, spec, 0);
    done(scene_add_rectangle(s, (struct vec3){ -50, 0, 50 },
                             (struct vec3){ 100, 0, 0 },
                             (struct vec3){ 0, 0, -100 }, &matt, &err),
         &err);
}

/* The irradiance at the foot of a corner of a parallel rectangle a x b at
 * height 1, radiance 1: J. Howell, A Catalog of Radiation Heat Transfer
 * Configuration Factors, B-3, times pi. */
static double corner_irradiance(double a, double b)
{
    const double p = sqrt(1 + a * a), q = sqrt(1 + b * b);
    return (a / p * atan(b / p) + b / q * atan(a / q)) / 2;
}

/* Looks at the origin, and has all it needs. */
static void finish(struct scene *s)
{
    struct err err;
    look(s, (struct vec3){ -2, 0.5, -1 }, (struct vec3){ 0, 0, 0 }, 4, 1e-4);
    done(scene_commit(s, &err), &err);
}

/* By all ways to direct light the same; frees the scene. */
static void expect_irradiance(struct scene *s, double e)
{
    for (int d = PATH_MIS; d <= PATH_HEMISPHERE; d++) {
        struct render_settings set = usual;
        set.path.direct = (enum path_direct)d;
        set.samples = 2048;
        expect(rendered(s, &set, 1), 0.73 / PI * e);
    }
    scene_free(s);
}

/* A floor of reflectance .73 at the origin, a light of radiance 7.1 above. */
static struct scene *under_rectangle(void)
{
    struct scene *s = empty();
    struct err err;
    floor_under(s, 0.73);
    const struct surface glow = matter(s, "diffuse:reflectance=0", 7.1);
    /* Its normal is down: u x v = x x z = -y. */
    done(scene_add_rectangle(s, (struct vec3){ 0, 1.3, 0 },
                             (struct vec3){ 0.9, 0, 0 },
                             (struct vec3){ 0, 0, 1.7 }, &glow, &err),
         &err);
    finish(s);
    return s;
}

static const char *const direct_name[] = { "mis", "light", "bsdf",
                                           "hemisphere" };

static void rectangle_light(void **state)
{
    const double e = 7.1 * corner_irradiance(0.9 / 1.3, 1.7 / 1.3);
    struct scene *s = under_rectangle();
    (void)state;
    for (int d = PATH_MIS; d <= PATH_HEMISPHERE; d++) {
        struct render_settings set = usual;
        set.path.direct = (enum path_direct)d;
        set.samples = 2048;
        const struct brightness m = rendered(s, &set, 0);
        print_message("%-10s %.6f +- %.6f\n", direct_name[d], m.value, m.error);
        expect(m, 0.73 / PI * e);
    }
    scene_free(s);
}

static void disk_light(void **state)
{
    struct scene *s = empty();
    struct err err;
    (void)state;
    floor_under(s, 0.73);
    const struct surface glow = matter(s, "diffuse:reflectance=0", 7.1);
    done(scene_add_disk(s, (struct vec3){ 0, 1.3, 0 },
                        (struct vec3){ 0.6, 0, 0 }, (struct vec3){ 0, 0, 0.6 },
                        &glow, &err),
         &err);
    finish(s);
    /* E = pi L sin^2 of the half angle. */
    const double e = PI * 7.1 * 0.36 / (0.36 + 1.69);
    expect_irradiance(s, e);
}

static void sphere_light(void **state)
{
    struct scene *s = empty();
    struct err err;
    (void)state;
    floor_under(s, 0.73);
    const struct surface glow = matter(s, "diffuse:reflectance=0", 7.1);
    done(scene_add_sphere(s, (struct vec3){ 0.4, 1.3, 0.2 }, 0.55, false, &glow,
                          &err),
         &err);
    finish(s);
    /* A sphere above the horizon: E = pi L (r/d)^2 cos theta. */
    const double d2 = 0.16 + 1.69 + 0.04;
    const double e = PI * 7.1 * 0.55 * 0.55 / d2 * 1.3 / sqrt(d2);
    expect_irradiance(s, e);
}

/* The walls of a ball that glow inward see one another, wherever it is; after
 * n bounces L (1 + r + ... + r^n). */
static void inside_a_sphere_that_glows(void **state)
{
    static const struct vec3 center[] = { { 0, 0, 0 }, { 10, 20, -5 } };
    (void)state;
    for (int i = 0; i < 2; i++)
        for (int d = PATH_MIS; d <= PATH_HEMISPHERE; d++) {
            struct scene *s = empty();
            struct err err;
            struct render_settings set = usual;
            const struct surface wall = matter(s, "diffuse:reflectance=0.5", 1);
            done(scene_add_sphere(s, center[i], 3, true, &wall, &err), &err);
            look(s, vec3_add(center[i], (struct vec3){ 1, 0.3, 0 }),
                 vec3_add(center[i], (struct vec3){ 0, 0, 1 }), 8, 6);
            done(scene_commit(s, &err), &err);
            set.path.max_depth = 5;
            set.path.direct = (enum path_direct)d;
            const struct brightness m = rendered(s, &set, 0);
            print_message("%-10s %.6f +- %.6f\n", direct_name[d], m.value,
                          m.error);
            /* A ray that starts a hair inside the ball meets it elsewhere by
             * as much as that is of the radius. */
            const double reach = 3 + fmax(center[i].x, center[i].y);
            const double hairs = 4 * 0x1p-19 * reach / 3;
            if (fabs(m.value - (2 - 0x1p-5)) > hairs)
                expect(m, 2 - 0x1p-5);
            scene_free(s);
        }
}

/* From within a ball that glows outward nothing glows, even where light goes
 * through its wall: all ways find the same. */
static void inside_a_sphere_that_does_not(void **state)
{
    struct brightness m[PATH_HEMISPHERE + 1];
    struct scene *s = empty();
    struct err err;
    const struct surface wall =
        matter(s, "roughdielectric:alpha=0.4,int_ior=1.5", 1);
    (void)state;
    done(scene_add_sphere(s, (struct vec3){ 0.2, -0.1, 0.3 }, 1, false, &wall,
                          &err),
         &err);
    look(s, (struct vec3){ 0, 0, -3 }, (struct vec3){ 0, 0, 0 }, 6, 3);
    done(scene_commit(s, &err), &err);
    for (int d = PATH_MIS; d <= PATH_HEMISPHERE; d++) {
        struct render_settings set = usual;
        set.path.max_depth = 4;
        set.samples = 2048;
        set.path.direct = (enum path_direct)d;
        m[d] = rendered(s, &set, 0);
        print_message("%-10s %.6f +- %.6f\n", direct_name[d], m[d].value,
                      m[d].error);
        expect((struct brightness){ m[d].value,
                                    hypot(m[d].error, m[PATH_MIS].error) },
               m[PATH_MIS].value);
    }
    scene_free(s);
}

static void point_light(void **state)
{
    struct scene *s = empty();
    struct err err;
    const struct light light = { .kind = LIGHT_POINT,
                                 .radiance = spectrum_of(3, 7.1),
                                 .position = { 0.4, 1.3, 0.2 } };
    (void)state;
    floor_under(s, 0.73);
    done(scene_add_light(s, &light, &err), &err);
    finish(s);
    const double d2 = 0.16 + 1.69 + 0.04;
    for (int d = PATH_MIS; d <= PATH_HEMISPHERE; d++) {
        struct render_settings set = usual;
        set.path.direct = (enum path_direct)d;
        const struct brightness m = rendered(s, &set, 1);
        assert_close(m.value, 0.73 / PI * 7.1 * 1.3 / (d2 * sqrt(d2)), 1e-4);
    }
    scene_free(s);
}

/* -- mirrors ----------------------------------------------------------------
 */

/* The mirror image of a light is where geometry has it, pixel by pixel. */
static void mirror_image(void **state)
{
    struct scene *s = empty(), *t = empty();
    struct err err;
    (void)state;
    /* A mirror in the plane y = 0, and a light above; or its image below, seen
     * through nothing. */
    struct scene *const both[] = { s, t };
    for (int i = 0; i < 2; i++) {
        struct scene *a = both[i];
        const double sign = i == 0 ? 1 : -1;
        const struct surface glow = matter(a, "diffuse:reflectance=0", 2.5);
        done(scene_add_sphere(a, (struct vec3){ 0.1, sign * 0.8, 0.3 }, 0.45,
                              false, &glow, &err),
             &err);
        if (i == 0) {
            const struct surface mirror = matter(a, "mirror", 0);
            done(scene_add_rectangle(
                     a, (struct vec3){ -50, 0, 50 }, (struct vec3){ 100, 0, 0 },
                     (struct vec3){ 0, 0, -100 }, &mirror, &err),
                 &err);
        }
        look(a, (struct vec3){ -2, 1.1, -3 }, (struct vec3){ 0.1, -0.8, 0.3 },
             40, 0.6);
        done(scene_commit(a, &err), &err);
    }
    struct render_settings set = usual;
    set.samples = 4;
    struct render_result image, direct;
    done(render(s, &set, &image, &err), &err);
    done(render(t, &set, &direct, &err), &err);
    int lit = 0, other = 0; /* rays within a hair of the edge */
    for (int i = 0; i < 1600; i++) {
        lit += direct.film->pixel[i].mean[0] > 0;
        other += image.film->pixel[i].mean[0] != direct.film->pixel[i].mean[0];
    }
    print_message("%d of 1600 pixels see the light, %d otherwise\n", lit,
                  other);
    assert_in_range(other, 0, 2);
    assert_in_range(lit, 200, 1400);
    film_free(image.film);
    film_free(direct.film);
    scene_free(s);
    scene_free(t);
}

/* -- many bounces -----------------------------------------------------------
 */

/* A closed room whose walls all emit 0.37 and reflect 0.6. */
static struct scene *room(const char *spec)
{
    struct scene *s = empty();
    struct err err;
    const struct surface wall = matter(s, spec, 0.37);
    const struct vec3 x = { 2, 0, 0 }, y = { 0, 3, 0 }, z = { 0, 0, 4 };
    const struct vec3 o = { -1, -1, -1 }, e = { 1, 2, 3 };
    const struct vec3 side[][3] = {
        { o, z, x }, { o, x, y }, { o, y, z }, /* normals inward */
    };
    for (int i = 0; i < 3; i++) {
        done(scene_add_rectangle(s, side[i][0], side[i][1], side[i][2], &wall,
                                 &err),
             &err);
        done(scene_add_rectangle(s, e, vec3_scale(-1, side[i][2]),
                                 vec3_scale(-1, side[i][1]), &wall, &err),
             &err);
    }
    look(s, (struct vec3){ -0.3, 0.2, 0.1 }, (struct vec3){ 1, 1, 2.5 }, 6, 3);
    done(scene_commit(s, &err), &err);
    return s;
}

static double series(double emitted, double reflectance, int depth)
{
    double sum = 0;
    for (int k = 0; k <= depth; k++)
        sum += emitted * pow(reflectance, k);
    return sum;
}

static void closed_room(void **state)
{
    struct scene *s = room("diffuse:reflectance=0.6");
    (void)state;
    for (int d = PATH_MIS; d <= PATH_HEMISPHERE; d++)
        for (int depth = 0; depth <= 6; depth += depth < 2 ? 1 : 4) {
            struct render_settings set = usual;
            set.path.max_depth = depth;
            set.path.direct = (enum path_direct)d;
            expect(rendered(s, &set, 2), series(0.37, 0.6, depth));
        }
    struct render_settings set = usual;
    set.path.max_depth = 5;
    set.path.only_bounce = 3;
    expect(rendered(s, &set, 2), 0.37 * 0.6 * 0.6 * 0.6);
    scene_free(s);
}

static void roulette_is_unbiased(void **state)
{
    struct scene *s = room("diffuse:reflectance=0.6");
    (void)state;
    for (int i = 0; i < 4; i++) {
        static const double probability[] = { 0, 0.65, 0.3, 0 };
        static const int depth[] = { 5, 1, 2, 0 };
        struct render_settings set = usual;
        set.path.max_depth = 1000;
        set.path.rr_depth = depth[i];
        set.path.rr_probability = probability[i];
        set.samples = 512;
        expect(rendered(s, &set, 0), 0.37 / (1 - 0.6));
    }
    scene_free(s);
}

static void samplings_agree(void **state)
{
    static const char *const specs[] = {
        "diffuse:reflectance=0.6",
        "roughconductor:material=Cu,alpha=0.4",
        "blendbsdf:weight=0.4,bsdf_0=(diffuse:reflectance=0.7),bsdf_1=(mirror)",
    };
    (void)state;
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) {
        struct scene *s = room(specs[i]);
        struct render_settings set = usual;
        set.path.max_depth = 3;
        set.samples = 512;
        const struct brightness a = rendered(s, &set, 0);
        for (int how = PATH_COSINE; how <= PATH_UNIFORM; how++)
            for (int d = PATH_MIS; d <= PATH_HEMISPHERE; d++) {
                set.path.sampling = (enum path_sampling)how;
                set.path.direct = (enum path_direct)d;
                struct brightness b = rendered(s, &set, 0);
                b.error = hypot(a.error, b.error);
                expect(b, a.value);
            }
        print_message("%s: %.5f +- %.5f\n", specs[i], a.value, a.error);
        scene_free(s);
    }
}

/* -- energy -----------------------------------------------------------------
 */

/* A sheet seen at an angle under a sky of radiance 1. */
static struct brightness sheet(const char *spec, double theta_deg, int band)
{
    struct scene *s = empty();
    struct err err;
    const struct light sky = { .kind = LIGHT_CONSTANT,
                               .radiance = spectrum_of(3, 1) };
    const struct surface surface = matter(s, spec, 0);
    const double theta = theta_deg * PI / 180;
    done(scene_add_rectangle(s, (struct vec3){ -50, 0, 50 },
                             (struct vec3){ 100, 0, 0 },
                             (struct vec3){ 0, 0, -100 }, &surface, &err),
         &err);
    done(scene_add_light(s, &sky, &err), &err);
    look(s, (struct vec3){ 20 * sin(theta), 20 * cos(theta), 0 },
         (struct vec3){ 0, 0, 0 }, 4, 1e-4);
    done(scene_commit(s, &err), &err);
    struct render_settings set = usual;
    set.samples = 2048;
    const struct brightness m = rendered(s, &set, band);
    scene_free(s);
    return m;
}

static void sheets_return_their_albedo(void **state)
{
    static const char *const specs[] = {
        "diffuse:reflectance=0.43",
        "roughconductor:material=Au,alpha=0.25",
        "roughconductor:material=Ca,alpha=0.5,distribution=ggx",
        "conductor:material=Cu",
    };
    (void)state;
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++)
        for (int k = 0; k < 2; k++) {
            const double theta_deg = k ? 71 : 23;
            struct err err;
            struct bsdf *b = bsdf_new(specs[i], &bands_default, &err);
            struct subject subject;
            const struct plan plan = { .samples = 10000 };
            assert_non_null(b);
            done(subject_init(&subject, b, dir_from_degrees(theta_deg, 0),
                              &plan, &err),
                 &err);
            expect(sheet(specs[i], theta_deg, 1),
                   subject_energy(&subject)->albedo[1].value);
            subject_clear(&subject);
            bsdf_free(b);
        }
}

/* A lossless ball under a sky of radiance 1 cannot be seen. */
static void lossless_balls_vanish(void **state)
{
    static const char *const specs[] = {
        "mirror",
        "dielectric:int_ior=1.5,ext_ior=1",
        "dielectric:int_ior=1.5,ext_ior=2.4",
        "thindielectric:int_ior=1.5,ext_ior=1",
        "twosided:front=(diffuse:reflectance=1)",
    };
    (void)state;
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) {
        struct scene *s = empty();
        struct err err;
        const struct light sky = { .kind = LIGHT_CONSTANT,
                                   .radiance = spectrum_of(3, 1) };
        const struct surface surface = matter(s, specs[i], 0);
        done(scene_add_sphere(s, (struct vec3){ 0.1, 0.2, -0.3 }, 0.7, false,
                              &surface, &err),
             &err);
        done(scene_add_light(s, &sky, &err), &err);
        look(s, (struct vec3){ 2, 1, 3 }, (struct vec3){ 0, 0, 0 }, 24, 1.2);
        done(scene_commit(s, &err), &err);
        struct render_settings set = usual;
        set.path.max_depth = 2000;
        set.path.rr_depth = 4;
        set.samples = 128;
        const struct brightness m = rendered(s, &set, 0);
        print_message("%s: %.6f +- %.6f\n", specs[i], m.value, m.error);
        expect(m, 1);
        scene_free(s);
    }
}

/* -- the same for everyone --------------------------------------------------
 */

static void threads_do_not_matter(void **state)
{
    struct scene *s = room("roughconductor:material=Cu,alpha=0.4");
    struct err err;
    struct render_result one, three, part;
    struct render_settings set = usual;
    (void)state;
    set.path.max_depth = 4;
    set.path.rr_depth = 2;
    set.samples = 70;
    set.threads = 1;
    done(render(s, &set, &one, &err), &err);
    set.threads = 3;
    done(render(s, &set, &three, &err), &err);
    assert_memory_equal(one.film->pixel, three.film->pixel,
                        36 * sizeof *one.film->pixel);
    set.x = 2, set.y = 3, set.width = 3, set.height = 2;
    done(render(s, &set, &part, &err), &err);
    for (int y = 0; y < 2; y++)
        assert_memory_equal(part.film->pixel + 3 * y,
                            one.film->pixel + 6 * (3 + y) + 2,
                            3 * sizeof *part.film->pixel);
    film_free(part.film);
    set.width = 5;
    assert_false(render(s, &set, &part, &err));
    assert_string_equal(err.text, "cell 5 x 2 at 2, 3: expected it inside the "
                                  "picture, 6 x 6");
    film_free(one.film);
    film_free(three.film);
    scene_free(s);
}

/* Nor does what else is in a wave: many BSDFs, shapes and lights, lobes of all
 * kinds, and pixels that are done early. */
static void company_does_not_matter(void **state)
{
    struct scene *s = empty();
    struct err err;
    const struct light sky = { .kind = LIGHT_HEMISPHERE,
                               .radiance = spectrum_of(3, 0.3) };
    const struct light point = { .kind = LIGHT_POINT,
                                 .radiance = spectrum_of(3, 2),
                                 .position = { 1, 2, -1 } };
    (void)state;
    floor_under(s, 0.6);
    const struct surface glass = matter(s, "dielectric:int_ior=1.5", 0);
    const struct surface metal =
        matter(s, "roughconductor:material=Cu,alpha=0.3", 0);
    const struct surface glow = matter(s, "diffuse:reflectance=0", 3);
    done(scene_add_sphere(s, (struct vec3){ -0.4, 0.5, 0 }, 0.5, false, &glass,
                          &err),
         &err);
    done(scene_add_disk(s, (struct vec3){ 0.6, 0.4, 0.3 },
                        (struct vec3){ 0.3, 0, 0.3 },
                        (struct vec3){ 0, sqrt(0.18), 0 }, &metal, &err),
         &err);
    done(scene_add_sphere(s, (struct vec3){ 0, 2, 0.5 }, 0.2, false, &glow,
                          &err),
         &err);
    done(scene_add_light(s, &sky, &err), &err);
    done(scene_add_light(s, &point, &err), &err);
    look(s, (struct vec3){ 0.2, 1.3, -3 }, (struct vec3){ 0, 0.5, 0 }, 20, 2);
    done(scene_commit(s, &err), &err);
    for (int d = PATH_MIS; d <= PATH_HEMISPHERE; d++) {
        struct render_settings set = usual;
        struct render_result all, part;
        set.path.max_depth = 6;
        set.path.rr_depth = 3;
        set.path.light_samples = 1 + d % 2;
        set.path.direct = (enum path_direct)d;
        set.sampler = d % 2 ? SAMPLER_LD : SAMPLER_INDEPENDENT;
        set.samples = 75;
        set.batch = 13;
        set.tolerance = d >= PATH_HIT ? 0.1 : 0;
        done(render(s, &set, &all, &err), &err);
        assert_int_equal(all.bad, 0);
        set.x = 7, set.y = 5, set.width = 9, set.height = 11;
        set.threads = 1;
        done(render(s, &set, &part, &err), &err);
        for (int y = 0; y < 11; y++)
            assert_memory_equal(part.film->pixel + 9 * y,
                                all.film->pixel + 20 * (5 + y) + 7,
                                9 * sizeof *part.film->pixel);
        film_free(all.film);
        film_free(part.film);
    }
    scene_free(s);
}

/* -- edges ------------------------------------------------------------------
 */

/* A sphere of radius 1 as triangles between circles of latitude; 69,168 for a
 * number of 132. */
static struct mesh *globe(unsigned rows)
{
    struct err err;
    const unsigned across = 2 * rows;
    struct mesh *m = mesh_new((size_t)(rows + 1) * across,
                              (size_t)2 * (rows - 1) * across, false, &err);
    done(m != NULL, &err);
    float *p = m->xyz;
    unsigned *index = m->index;
    for (unsigned i = 0; i <= rows; i++)
        for (unsigned k = 0; k < across; k++) {
            const double theta = PI * i / rows, phi = 2 * PI * k / across;
            const bool pole = i == 0 || i == rows;
            *p++ = (float)(pole ? 0 : sin(theta) * cos(phi));
            *p++ = (float)(pole ? 0 : sin(theta) * sin(phi));
            *p++ = (float)cos(theta);
        }
    for (unsigned i = 0; i < rows; i++)
        for (unsigned k = 0; k < across; k++) {
            const unsigned a = i * across + k, b = a + across;
            const unsigned c = i * across + (k + 1) % across, d = c + across;
            const unsigned pair[2][3] = { { a, b, c }, { c, b, d } };
            for (unsigned t = i == 0; t < (i == rows - 1 ? 1 : 2); t++)
                for (int corner = 0; corner < 3; corner++)
                    *index++ = pair[t][corner];
        }
    return m;
}

/* Toward a point of an edge of a triangle that a number chooses, or anywhere,
 * from somewhere inside. */
static struct ray from_inside(const struct mesh *m, bool at_edge, struct rng g,
                              uint64_t number)
{
    const struct vec3 u = rng_uniform(g, 2 * number);
    const struct vec3 v = rng_uniform(g, 2 * number + 1);
    const struct vec3 from = { u.x - 0.5, u.y - 0.5, u.z - 0.5 };
    const double z = 2 * v.x - 1, r = sqrt(1 - z * z);
    struct vec3 dir = { r * cos(2 * PI * v.y), r * sin(2 * PI * v.y), z };
    if (at_edge) {
        const size_t i = (size_t)(v.x * (double)m->triangles);
        const struct vec3 p = mesh_vertex(m, i, 0), q = mesh_vertex(m, i, 1);
        dir = vec3_minus(vec3_add(vec3_scale(v.y, p), vec3_scale(1 - v.y, q)),
                         from);
    }
    return (struct ray){ from, vec3_unit(dir), 0, INFINITY };
}

/* Of how many rays from inside nothing is met. */
static int slipped(bool robust, bool at_edge, int waves)
{
    struct err err;
    struct scene *s = empty();
    struct mesh *m = globe(132);
    const struct surface matt = matter(s, "diffuse", 0);
    const struct scene_wishes wishes = { .robust = robust };
    const struct rng g = { .seed = 1, .stream = at_edge };
    struct rays rays;
    struct queue queue = { .n = WAVE };
    struct met met;
    int n = 0;
    done(scene_add_mesh(s, m, &matt, &err), &err);
    look(s, (struct vec3){ 0, 0, 3 }, (struct vec3){ 0, 0, 0 }, 1, 1);
    scene_set_wishes(s, &wishes);
    done(scene_commit(s, &err), &err);
    for (int wave = 0; wave < waves; wave++) {
        for (uint16_t i = 0; i < WAVE; i++) {
            const struct ray r =
                from_inside(m, at_edge, g, (uint64_t)wave * WAVE + (uint64_t)i);
            vecs_put(&rays.origin, i, r.origin);
            vecs_put(&rays.dir, i, r.dir);
            rays.near[i] = r.near, rays.far[i] = r.far;
            queue.ray[i] = i, queue.piece[i] = 0;
        }
        trace_rays(s, &rays, &queue, false, &met);
        for (int i = 0; i < WAVE; i++)
            n += met.shape[i] == NULL;
    }
    scene_free(s);
    return n;
}

static void robust_rays_do_not_slip(void **state)
{
    enum { WAVES = 4000 };
    (void)state;
    assert_int_equal(slipped(true, true, WAVES), 0);
    assert_int_equal(slipped(true, false, WAVES), 0);
    const int random = slipped(false, false, WAVES);
    print_message("not robust: of %d rays %d slip, and %d of those toward "
                  "edges\n",
                  WAVES * WAVE, random, slipped(false, true, WAVES));
    /* 0.3 is expected of 6e-7 each; 8 and more have a chance of 1e-9. */
    assert_true(random < 8);
}

/* Of 2^k samples of a row, the first two numbers fall once each into every box
 * of area 2^-k whose sides are powers of two, the third into each interval. */
static void spread_samples_fill_boxes(void **state)
{
    enum { BITS = 8, N = 1 << BITS };
    const struct sampler s = { SAMPLER_LD, 3 };
    const uint64_t pixel[] = { 12345, 777 };
    (void)state;
    for (uint64_t row = 60; row < 68; row++) {
        struct vec3 u[N];
        for (uint32_t from = 0; from < N; from += WAVE / 2) {
            uint16_t piece[WAVE];
            uint32_t sample[WAVE];
            struct vecs out;
            const struct sampler_lanes lanes = { 2, pixel, WAVE, piece,
                                                 sample };
            for (uint32_t i = 0; i < WAVE; i++) {
                piece[i] = i % 2;
                sample[i] = from + i / 2;
            }
            sampler_row(&s, row, &lanes, &out);
            for (size_t i = 0; i < WAVE; i += 2)
                u[sample[i]] = vecs_at(&out, i + row % 2);
        }
        for (int wide = 0; wide <= BITS + 1; wide++) {
            char hit[N] = { 0 };
            for (int i = 0; i < N; i++) {
                const int x = (int)ldexp(u[i].x, wide);
                const int y = (int)ldexp(u[i].y, BITS - wide);
                const int box = wide > BITS ? (int)ldexp(u[i].z, BITS)
                                            : x << (BITS - wide) | y;
                hit[box]++;
            }
            for (int i = 0; i < N; i++)
                assert_int_equal(hit[i], 1);
        }
    }
}

/* The same mean, and less noise than the samples' own spread says. */
static void spread_samples_know_less_noise(void **state)
{
    const double e = 7.1 * corner_irradiance(0.9 / 1.3, 1.7 / 1.3);
    struct scene *s = under_rectangle();
    struct render_settings set = usual;
    struct render_result made;
    struct err err;
    (void)state;
    set.sampler = SAMPLER_LD;
    done(render(s, &set, &made, &err), &err);
    double off = 0, claimed = 0;
    for (int i = 0; i < 16; i++) {
        const double d = (double)made.film->pixel[i].mean[0] - 0.73 / PI * e;
        off += d * d;
        claimed += (double)made.film->pixel[i].variance[0];
    }
    expect(mean_of(made.film, 0), 0.73 / PI * e);
    print_message("variance %.2g, claimed %.2g\n", off / 16, claimed / 16);
    assert_true(off < claimed / 4);
    film_free(made.film);
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "a rectangle sends what geometry says", rectangle_light },
        { "so does a disk", disk_light },
        { "so does a sphere", sphere_light },
        { "a sphere that glows inward lights itself",
          inside_a_sphere_that_glows },
        { "a sphere that glows outward does not",
          inside_a_sphere_that_does_not },
        { "so does a point", point_light },
        { "a mirror shows what is behind it", mirror_image },
        { "a closed room is a geometric series", closed_room },
        { "Russian roulette changes no mean", roulette_is_unbiased },
        { "all ways of sampling have one mean", samplings_agree },
        { "sheets return their albedo", sheets_return_their_albedo },
        { "lossless balls vanish", lossless_balls_vanish },
        { "spread samples fill boxes", spread_samples_fill_boxes },
        { "spread samples know less noise", spread_samples_know_less_noise },
        { "neither threads nor cells change a pixel", threads_do_not_matter },
        { "nor does a pixel's company", company_does_not_matter },
        { "robust rays do not slip between triangles",
          robust_rays_do_not_slip },
    };
    return cmocka_run_group_tests_name("transport", tests, NULL, NULL);
}
