/* test_scenes.c - what scene files come to, and what is said of broken ones
 *
 * Good documents are short and written here; a broken one is a good one with a
 * piece of it replaced.  The course's own files are used where BSDF_SHARED says
 * that they are.
 */
#include <lzma.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "bsdf/rng.h"
#include "integrator/compat.h"
#include "integrator/load.h"
#include "integrator/meshfile.h"
#include "integrator/path.h"
#include "integrator/scene_parts.h"
#include "tests/close.h"
#include "tests/shell.h"

/* -- documents -- */

#define NODE(id, matrix, what)                                                 \
    "<node id=\"" id "\"><matrix sid=\"transform\">" matrix "</matrix>" what   \
    "</node>\n"
#define GEOMETRY(url, material)                                                \
    "<instance_geometry url=\"#" url "\"><bind_material><technique_common>"    \
    "<instance_material symbol=\"m\" target=\"#" material                      \
    "\"/></technique_common></bind_material></instance_geometry>"
#define EFFECT(id, cgl)                                                        \
    "<effect id=\"" id "\"><profile_COMMON><technique sid=\"common\"><phong>"  \
    "<diffuse><color>0.6 0.2 0.3 1</color></diffuse></phong></technique>"      \
    "</profile_COMMON>" cgl "</effect>\n"
#define CGL(what)                                                              \
    "<extra><technique profile=\"CGL\">" what "</technique></extra>"
#define MATERIAL(id, effect)                                                   \
    "<material id=\"" id "\"><instance_effect url=\"#" effect                  \
    "\"/></material>\n"
#define QUAD(id, points)                                                       \
    "<geometry id=\"" id "\"><mesh><source id=\"" id "-p\">"                   \
    "<float_array id=\"" id "-a\" count=\"12\">" points "</float_array>"       \
    "<technique_common><accessor source=\"#" id "-a\" count=\"4\" "            \
    "stride=\"3\"/></technique_common></source>\n"                             \
    "<vertices id=\"" id "-v\"><input semantic=\"POSITION\" source=\"#" id     \
    "-p\"/></vertices>\n<polylist material=\"m\" count=\"1\">"                 \
    "<input semantic=\"VERTEX\" source=\"#" id "-v\" offset=\"0\"/>"           \
    "<input semantic=\"NORMAL\" source=\"#none\" offset=\"1\"/>"               \
    "<vcount>4</vcount>\n<p>0 0 1 0 2 0 3 "                                    \
    "0</p></polylist></mesh></geometry>\n"

static const char dae[] =
    "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
    "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
    "version=\"1.4.1\">\n"
    "<asset><up_axis>Z_UP</up_axis></asset>\n"
    "<library_lights><light id=\"lamp\"><technique_common><point>"
    "<color>3 3 3</color></point></technique_common>\n" CGL(
        "<area><color>10 10 10</color></area>") "</light></library_lights>\n"
                                                "<library_cameras><camera "
                                                "id=\"eye\"><optics><technique_"
                                                "common>"
                                                "<perspective><xfov>49.13434</"
                                                "xfov><znear>0.1</"
                                                "znear><zfar>100</zfar>"
                                                "</perspective></"
                                                "technique_common></optics></"
                                                "camera></library_cameras>\n"
                                                "<library_effects>\n" EFFECT(
                                                    "matt-fx",
                                                    "") EFFECT("glow-fx",
                                                               CGL("<emission><"
                                                                   "radiance>"
                                                                   "10 10 "
                                                                   "10</"
                                                                   "radiance></"
                                                                   "emission>")) EFFECT("metal-fx",
                                                                                        CGL("<microfacet><alpha>.25</alpha><eta>.2 .9 1.1</eta>"
                                                                                            "<k>3.9 2.4 2.2</k></microfacet>"))
                                                    EFFECT(
                                                        "glass-fx", CGL("<glass"
                                                                        "><"
                                                                        "reflec"
                                                                        "tance>"
                                                                        "1 1 "
                                                                        "1</"
                                                                        "reflec"
                                                                        "tance>"
                                                                        "<trans"
                                                                        "mittan"
                                                                        "ce>1 "
                                                                        "1 "
                                                                        ".9</"
                                                                        "transm"
                                                                        "ittanc"
                                                                        "e>"
                                                                        "<rough"
                                                                        "ness>"
                                                                        "0</"
                                                                        "roughn"
                                                                        "ess><"
                                                                        "ior>1."
                                                                        "45</"
                                                                        "ior></"
                                                                        "glass"
                                                                        ">")) "</library_effects>\n<library_materials>" MATERIAL("matt",
                                                                                                                                 "matt-fx")
                                                        MATERIAL(
                                                            "glow",
                                                            "glow-"
                                                            "fx") MATERIAL("met"
                                                                           "al",
                                                                           "met"
                                                                           "al-"
                                                                           "fx")
                                                            MATERIAL("glass", "glass-fx") "</library_materials>\n<library_geometries>\n" QUAD(
                                                                "floor",
                                                                "-1 -1 0 1 -1 "
                                                                "0 1 1 0 -1 1 "
                                                                "0")
                                                                QUAD(
                                                                    "light",
                                                                    "-.3 "
                                                                    ".4 "
                                                                    "1."
                                                                    "49 "
                                                                    ".3 "
                                                                    ".4 "
                                                                    "1."
                                                                    "49 "
                                                                    ".3 "
                                                                    "-.4 "
                                                                    "1."
                                                                    "49 "
                                                                    "-.3 "
                                                                    "-.4 "
                                                                    "1."
                                                                    "49") "<geo"
                                                                          "metr"
                                                                          "y "
                                                                          "id="
                                                                          "\"ba"
                                                                          "ll\""
                                                                          ">" CGL(
                                                                              "<sphere><"
                                                                              "radius>.3</"
                                                                              "radius></"
                                                                              "sphere>") "</"
                                                                                         "geo"
                                                                                         "met"
                                                                                         "ry>"
                                                                                         "</"
                                                                                         "lib"
                                                                                         "rar"
                                                                                         "y_"
                                                                                         "geo"
                                                                                         "met"
                                                                                         "rie"
                                                                                         "s>"
                                                                                         "\n"
                                                                                         "<li"
                                                                                         "bra"
                                                                                         "ry_"
                                                                                         "vis"
                                                                                         "ual"
                                                                                         "_sc"
                                                                                         "ene"
                                                                                         "s><"
                                                                                         "vis"
                                                                                         "ual"
                                                                                         "_sc"
                                                                                         "ene"
                                                                                         " id"
                                                                                         "=\""
                                                                                         "all"
                                                                                         "\">"
                                                                                         "\n" NODE(
                                                                                             "eye-node",
                                                                                             "-1 0 0 0 0 0 1 3 0 1 0 0 0 0 0 1",
                                                                                             "<instance_camera url=\"#eye\"/>")
                                                                                             NODE(
                                                                                                 "lamp-node",
                                                                                                 "0.6 0 0 0 0 0.8 0 0 0 0 1 1.49 0 0 0 1",
                                                                                                 "<instance_light url=\"#lamp\"/>")
                                                                                                 NODE(
                                                                                                     "floor-node",
                                                                                                     "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
                                                                                                     GEOMETRY(
                                                                                                         "floor",
                                                                                                         "matt"))
                                                                                                     NODE(
                                                                                                         "light-node",
                                                                                                         "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
                                                                                                         GEOMETRY(
                                                                                                             "light",
                                                                                                             "glow"))
                                                                                                         NODE(
                                                                                                             "ball-node",
                                                                                                             "2 0 0 .1 0 2 0 .2 0 0 2 .6 0 0 0 1",
                                                                                                             GEOMETRY(
                                                                                                                 "ball",
                                                                                                                 "metal")) "</visual_scene></library_visual_scenes>\n"
                                                                                                                           "<scene><instance_visual_scene url=\"#all\"/></scene>\n</COLLADA>\n";

static const char xml[] =
    "<scene version=\"3.0.0\">\n"
    "<default name=\"alpha\" value=\"0.2\"/>\n"
    "<default name=\"half\" value=\"0.25\"/>\n"
    "<integrator type=\"path\"><integer name=\"max_depth\" value=\"6\"/>"
    "</integrator>\n"
    "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/>\n"
    "<transform name=\"to_world\"><lookat origin=\"0,1,5\" target=\"0 1 0\" "
    "up=\"0,1,0\"/></transform>\n"
    "<sampler type=\"independent\"><integer name=\"sample_count\" value=\"9\"/>"
    "</sampler>\n"
    "<film type=\"hdrfilm\"><integer name=\"width\" value=\"40\"/>"
    "<integer name=\"height\" value=\"30\"/><rfilter type=\"box\"/></film>\n"
    "</sensor>\n"
    "<bsdf type=\"twosided\" id=\"wall\"><bsdf type=\"diffuse\">"
    "<rgb name=\"reflectance\" value=\".5, .4, .3\"/></bsdf></bsdf>\n"
    "<shape type=\"rectangle\" id=\"floor\"><transform name=\"to_world\">"
    "<rotate x=\"1\" angle=\"-90\"/></transform><ref id=\"wall\"/></shape>\n"
    "<shape type=\"rectangle\" id=\"light\"><transform name=\"to_world\">"
    "<scale value=\"$half\"/><rotate x=\"1\" angle=\"90\"/>"
    "<translate y=\"2\"/></transform>"
    "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1 2 3\"/></emitter>"
    "</shape>\n"
    "<shape type=\"sphere\" id=\"ball\"><point name=\"center\" x=\".1\" "
    "y=\".5\" z=\"0\"/><float name=\"radius\" value=\".4\"/>\n"
    "<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"$alpha\"/>"
    "<string name=\"distribution\" value=\"ggx\"/></bsdf></shape>\n"
    "<emitter type=\"constant\"><rgb name=\"radiance\" value=\".1\"/>"
    "</emitter>\n"
    "</scene>\n";

/* -- files -- */

static const char *written(const char *name, const char *text, size_t size)
{
    const char *path = in_folder(name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(text, 1, size, f), size);
    assert_int_equal(fclose(f), 0);
    return path;
}

/* The document with the first `what` replaced; the caller's. */
static char *replaced(const char *document, const char *what, const char *by)
{
    const char *at = strstr(document, what);
    char *made = malloc(strlen(document) + strlen(by) + 1);
    if (!at)
        fail_msg("\"%s\" is not in the document", what);
    assert_non_null(made);
    sprintf(made, "%.*s%s%s", (int)(at - document), document, by,
            at + strlen(what));
    return made;
}

static char warning[1024];

static void keep_warning(const char *text, void *context)
{
    (void)context;
    snprintf(warning, sizeof warning, "%s", text);
}

static struct scene *load_with(const char *path,
                               const struct load_options *options)
{
    struct load_options o = *options;
    struct err err;
    o.warn = keep_warning;
    warning[0] = '\0';
    struct scene *s = scene_load(path, &bands_default, &o, &err);
    if (!s)
        fail_msg("%s", err.text);
    return s;
}

static struct scene *load(const char *path)
{
    return load_with(path, &(struct load_options){ 0 });
}

static const char *dae_file(const char *what, const char *by)
{
    char *text = replaced(dae, what, by);
    const char *path = written("scene.dae", text, strlen(text));
    free(text);
    return path;
}

#define ROBUST(value)                                                          \
    "<boolean name=\"embree_use_robust_intersections\" value=\"" value "\"/>"

static const char *xml_file(const char *what, const char *by)
{
    char *text = replaced(xml, what, by);
    const char *path = written("scene.xml", text, strlen(text));
    free(text);
    return path;
}

/* Refused with all of these in the reason. */
static void refused_at(const char *path, const char *a, const char *b,
                       const char *c)
{
    const struct load_options o = { 0 };
    struct err err;
    struct scene *s = scene_load(path, &bands_default, &o, &err);
    if (s)
        fail_msg("%s was taken; expected \"%s\" %s %s", path, a, b, c);
    assert_has(err.text, a);
    assert_has(err.text, b);
    assert_has(err.text, c);
}

static void dae_refused(const char *what, const char *by, const char *place,
                        const char *a, const char *b)
{
    const char *path = dae_file(what, by);
    refused_at(path, place, a, b);
    refused_at(path, path, a, b);
}

static void xml_refused(const char *what, const char *by, const char *place,
                        const char *a, const char *b)
{
    const char *path = xml_file(what, by);
    refused_at(path, place, a, b);
    refused_at(path, path, a, b);
}

/* -- COLLADA -- */

static void assert_vec(struct vec3 got, double x, double y, double z)
{
    assert_close(got.x, x, 1e-6);
    assert_close(got.y, y, 1e-6);
    assert_close(got.z, z, 1e-6);
}

static struct vec3 position(const struct camera *c)
{
    return affine_point(&c->to_world, (struct vec3){ 0, 0, 0 });
}

static void a_dae_is_what_it_says(void **state)
{
    (void)state;
    struct scene *s = load(written("scene.dae", dae, sizeof dae - 1));
    struct vec3 lo, hi;
    assert_int_equal(s->shapes, 3);
    assert_int_equal(s->lights, 1); /* the mesh; <area> is in its place */
    assert_string_equal(bsdf_spec(s->shape[0].bsdf),
                        "twosided:front=(diffuse:reflectance=0.6/0.2/0.3)");
    assert_string_equal(bsdf_spec(s->shape[2].bsdf),
                        "roughconductor:alpha=0.25,eta=0.2/0.9/1.1,"
                        "k=3.9/2.4/2.2,distribution=beckmann");
    assert_close(s->shape[2].radius, .6, 1e-12);
    assert_vec(s->shape[2].center, -.1, .6, .2);
    assert_true(s->shape[1].surface.both_sides);
    assert_false(s->shape[1].surface.unsampled);
    assert_close(s->shape[1].surface.radiance.band[0], 10, 0);
    assert_true(s->shape[1].flags & SHAPE_RECTANGLE);
    assert_close(s->shape[1].area, .48, 1e-6);
    assert_true(scene_box(s, &lo, &hi));
    assert_vec(lo, -1, 0, -1);
    assert_vec(hi, 1, 1.49, 1);
    const double far = 1.5 * sqrt(8 + 1.49 * 1.49);
    assert_vec(position(scene_camera(s)), 0, .745, far);
    /* 875.0 pixels, from the course's own program. */
    assert_close(scene_camera(s)->focal, 875, .05);
    assert_int_equal(scene_camera(s)->width, 800);
    assert_int_equal(scene_camera(s)->height, 600);
    assert_string_equal(warning, "");
    scene_free(s);
}

static void compatibility_is_the_courses(void **state)
{
    (void)state;
    const struct load_options o = { .compat = COMPAT_COURSE,
                                    .width = 480,
                                    .height = 360 };
    const char *path =
        dae_file(GEOMETRY("ball", "metal"),
                 GEOMETRY("ball", "metal") GEOMETRY("ball", "glass"));
    struct scene *s = load_with(path, &o);
    assert_close(scene_camera(s)->focal, 875, .05);
    assert_true(s->shape[1].surface.unsampled);
    assert_int_equal(s->lights, 1);
    const struct light *l = &s->light[0].light;
    assert_int_equal(l->kind, LIGHT_HIDDEN);
    assert_close(vec3_length(l->u) * vec3_length(l->v), .48, 1e-9);
    assert_vec(vec3_unit(vec3_cross(l->u, l->v)), 0, -1, 0);
    assert_vec(vec3_add(l->position, vec3_scale(.5, vec3_add(l->u, l->v))), 0,
               1.49, 0);
    assert_string_equal(bsdf_spec(s->shape[2].bsdf),
                        "course_microfacet:alpha=0.25,eta=0.2/0.9/1.1,"
                        "k=3.9/2.4/2.2,lambda=course,fresnel_at=normal");
    assert_string_equal(bsdf_spec(s->shape[3].bsdf),
                        "course_glass:ior=1.45,reflectance=1,"
                        "transmittance=1/1/0.9,schlick_at=inside,"
                        "factor=course");
    scene_free(s);
    struct load_options one = o;
    one.compat = COMPAT_REFRACTION;
    s = load_with(path, &one);
    assert_string_equal(bsdf_spec(s->shape[3].bsdf),
                        "course_glass:ior=1.45,reflectance=1,"
                        "transmittance=1/1/0.9,schlick_at=thinner,"
                        "factor=course");
    assert_close(scene_camera(s)->focal, 525, .05);
    scene_free(s);
    s = load(path);
    assert_string_equal(bsdf_spec(s->shape[3].bsdf),
                        "dielectric:int_ior=1.45,specular_reflectance=1,"
                        "specular_transmittance=1/1/0.9,ext_ior=1");
    scene_free(s);
}

static void an_area_light_alone_is_a_rectangle(void **state)
{
    (void)state;
    struct scene *s =
        load(dae_file(GEOMETRY("light", "glow"), GEOMETRY("light", "matt")));
    assert_int_equal(s->shapes, 4);
    assert_int_equal(s->lights, 1);
    assert_false(s->shape[3].surface.both_sides);
    const struct vec3 n = vec3_unit(vec3_cross(s->shape[3].u, s->shape[3].v));
    assert_vec(n, 0, -1, 0);
    scene_free(s);
    s = load(dae_file("10 10 10", "5 5 5"));
    assert_has(warning, "<area>");
    assert_has(warning, "5 5 5");
    scene_free(s);
}

static void other_lights_are_taken(void **state)
{
    (void)state;
    struct scene *s =
        load(dae_file("<area><color>10 10 10</color></area>",
                      "<ambient><color>1 .5 1</color></ambient>"));
    assert_int_equal(s->lights, 2);
    assert_int_equal(s->light[0].light.kind, LIGHT_HEMISPHERE);
    assert_close(s->light[0].light.radiance.band[1], .5, 0);
    scene_free(s);
    s = load(dae_file(CGL("<area><color>10 10 10</color></area>"), ""));
    assert_int_equal(s->light[0].light.kind, LIGHT_POINT);
    assert_vec(s->light[0].light.position, 0, 1.49, 0);
    scene_free(s);
}

static void matrices_of_fifteen_numbers_are_named(void **state)
{
    (void)state;
    dae_refused("-1 0 0 0 0 0 1 3 0 1 0 0 0 0 0 1",
                "-1 0 0 0 0 0 1 3 0 1 0 0 0 0 1", ":29: <matrix>",
                "it has 15 numbers", "expected 16");
    dae_refused("-1 0 0 0 0 0 1 3 0 1 0 0 0 0 0 1",
                "-1 0 0 0 0 0 1 3 0 1 0 0 0 0 0 1 7 7", "<matrix>",
                "it has 18 numbers", "expected 16");
    dae_refused("-1 0 0 0 0 0 1 3", "-1 0 0 0 0 zero 1 3", ":29: <matrix>",
                "number 6 is \"zero\"", "expected a finite number");
    dae_refused("0 1 0 0 0 0 0 1</matrix>", "0 1 0 0 0 0 0 2</matrix>",
                "<matrix>", "the last row is 0 0 0 2", "expected 0 0 0 1");
}

static void missing_and_cyclic_references_are_named(void **state)
{
    (void)state;
    dae_refused("url=\"#eye\"", "url=\"#eyes\"", "<instance_camera>", "#eyes",
                "there is no such <camera>");
    dae_refused("url=\"#eye\"", "url=\"#ball\"", "<instance_camera>",
                "is a <geometry>", "expected a <camera>");
    dae_refused("url=\"#matt-fx\"", "url=\"matt-fx\"", "<instance_effect>",
                "expected # and", "<effect>");
    dae_refused("target=\"#matt\"", "", "<instance_material>",
                "target=", "<material>");
    dae_refused("source=\"#floor-v\"", "source=\"#floor\"", "<input>",
                "is a <geometry>", "expected a <vertices>");
    dae_refused("<instance_light url=\"#lamp\"/>",
                "<instance_node url=\"#lamp-node\"/>", "<node \"lamp-node\">",
                "more than 100 deep", "itself");
    /* No cycle, but two to the power of what nests. */
    char many[4096] = "";
    for (int i = 0; i < 30; i++)
        sprintf(many + strlen(many),
                "<node id=\"n%d\"><instance_node url=\"#n%d\"/>"
                "<instance_node url=\"#n%d\"/></node>",
                i, i + 1, i + 1);
    strcat(many, "<node id=\"n30\"/></visual_scene>");
    dae_refused("</visual_scene>", many, "<node \"n", "more than 65536", "");
    dae_refused("id=\"glass\"", "id=\"metal\"", "<material \"metal\">",
                "taken by <material>", "in line");
}

static void what_is_missing_in_a_dae_is_named(void **state)
{
    (void)state;
    dae_refused("<COLLADA", "<COLLADE", ":", "", "");
    dae_refused("Z_UP", "X_UP", "<up_axis>", "X_UP", "expected Z_UP or Y_UP");
    dae_refused("<xfov>49.13434</xfov>", "", "<perspective>", "expected a",
                "<xfov>");
    dae_refused("49.13434", "180", "<perspective>", "xfov 180", "below 180");
    dae_refused("<znear>0.1", "<znear>200", "znear 200", "zfar 100", "");
    dae_refused("url=\"#eye\"/>", "url=\"#eye\"/><spot/>", "<spot>",
                "expected a matrix", "");
    dae_refused("<matrix sid=\"transform\">0.6", "<scale>1 1 1</scale><matrix>",
                "<scale>", "expected a <matrix>", "");
    dae_refused("<instance_camera url=\"#eye\"/>", "", "<COLLADA>", "expected",
                "<instance_camera>");
    dae_refused("0 0 1 3 0 1 0 0", "0 1 0 0 0 0 1 3", "<instance_camera>",
                "straight up or down", "");
    dae_refused("<radius>.3</radius>", "<radius>0</radius>", "<radius>",
                "0: expected a radius above 0", "");
    dae_refused("<radius>.3</radius>", "", "<sphere>", "expected a <radius>",
                "");
    dae_refused("<microfacet><alpha>.25", "<microfacet><alpha>7",
                "<microfacet>", "alpha = 7", "[0.0001, 1]");
    dae_refused("<microfacet><alpha>.25</alpha>", "<microfacet>",
                "<microfacet>", "expected a <alpha>", "");
    dae_refused("<microfacet>", "<velvet/><microfacet>", "<velvet>",
                "expected mirror", "");
    dae_refused("<color>0.6 0.2 0.3 1</color>", "<color>0.6 0.2 0.3</color>",
                "<color>", "it has 3 numbers", "expected 4");
    dae_refused("<color>0.6 0.2 0.3 1</color>", "<color>0.6 0.2 3 1</color>",
                "<color>", "reflectance = 3", "[0, 1]");
    dae_refused("<radiance>10 10 10", "<radiance>10 -1 10", "radiance -1",
                "expected at least 0", "");
    dae_refused("<scene><instance_visual_scene url=\"#all\"/></scene>", "",
                "<COLLADA>", "expected a <scene>", "");
}

static void lenient_leaves_out_what_is_unknown(void **state)
{
    (void)state;
    const struct load_options o = { .lenient = true };
    struct scene *s = load_with(
        dae_file("url=\"#eye\"/>", "url=\"#eye\"/><instance_controller/>"), &o);
    assert_has(warning, "<instance_controller>");
    assert_has(warning, "left out");
    scene_free(s);
    s = load_with(xml_file("<film type",
                           "<float name=\"shutter\" value=\"1\"/><film "
                           "type"),
                  &o);
    assert_has(warning, "<float \"shutter\">");
    scene_free(s);
    s = load_with(xml_file("type=\"constant\"", "type=\"sunsky\""), &o);
    assert_has(warning, "<emitter>");
    scene_free(s);
}

static void broken_meshes_are_named(void **state)
{
    (void)state;
    dae_refused("-1 -1 0 1 -1 0 1", "-1 nan 0 1 -1 0 1",
                "<float_array \"floor-a\">", "number 2 is \"nan\"",
                "expected a finite number");
    dae_refused("-1 -1 0 1 -1 0 1", "-1 1e999 0 1 -1 0 1", "<float_array",
                "number 2 is \"1e999\"", "expected a finite number");
    dae_refused("-1 -1 0 1 -1 0 1", "-1 1e300 0 1 -1 0 1", "<float_array",
                "number 2 is 1e+300", "a float can hold");
    dae_refused("count=\"12\"", "count=\"3000000\"", "<float_array",
                "count=\"3000000\"", "there are 12 numbers");
    dae_refused("count=\"4\"", "count=\"1000000\"", "<accessor>",
                "count=\"1000000\"", "there are 4 positions");
    dae_refused("stride=\"3\"", "stride=\"2\"", "<accessor>", "stride=\"2\"",
                "expected 3");
    dae_refused("<polylist material=\"m\" count=\"1\"",
                "<polylist material=\"m\" count=\"1000000\"", "<polylist>",
                "count=\"1000000\"", "there are 1 polygons");
    dae_refused("<vcount>4", "<vcount>5", "<p>", "it has 8 numbers",
                "expected 10");
    dae_refused("<vcount>4", "<vcount>2", "<vcount>", "polygon 1 has 2",
                "at least 3");
    dae_refused("<vcount>4", "<vcount>4000000000", "<vcount>",
                "number 1 is \"4000000000\"", "a whole number");
    dae_refused("<vcount>4", "<vcount>-4", "<vcount>", "number 1 is \"-4\"",
                "a whole number");
    dae_refused("<p>0 0 1 0", "<p>0 0 4 0", "<polylist>", "vertex 4",
                "below 4");
    dae_refused("offset=\"1\"", "offset=\"99\"", "<input>", "offset=\"99\"",
                "0 to 15");
    dae_refused("-1 1 0</float_array>", "-1 1</float_array>", "<float_array",
                "there are 11 numbers", "");
    dae_refused("<polylist material=\"m\" count=\"1\"", "<lines ", ":", "", "");
    dae_refused("<vcount>4", "<vcount><b/>4", "<vcount>",
                "numbers and nothing else", "");
}

static void lights_without_area_are_named(void **state)
{
    (void)state;
    dae_refused("0.6 0 0 0 0 0.8 0 0", "0 0 0 0 0 0.8 0 0", "<area>",
                "its area is 0", "expected more than 0");
    dae_refused("-.3 .4 1.49 .3 .4 1.49 .3 -.4 1.49 -.3 -.4 1.49",
                "-.3 .4 1.49 .3 .4 1.49 .1 .4 1.49 .2 .4 1.49", "<polylist>",
                "it emits, but its area is 0", "#light");
    xml_refused("<scale value=\"$half\"/>", "<scale x=\"0\"/>", "<transform",
                "determinant is 0", "");
    xml_refused("<scale value=\"$half\"/>", "<scale value=\"1e-200\"/>",
                "<transform", "determinant is 0", "");
    xml_refused("<scale value=\"$half\"/>", "<scale x=\"1e-60\"/>", "<shape",
                "its area is 0", "light");
}

/* -- files that are cut off, packed, too deep -- */

static void cut_off_files_are_refused(void **state)
{
    (void)state;
    struct err err;
    const struct load_options o = { 0 };
    long refusals = 0;
    for (size_t cut = 0; cut + 2 < sizeof dae; cut += 7) {
        const char *path = written("cut.dae", dae, cut);
        struct scene *s = scene_load(path, &bands_default, &o, &err);
        assert_null(s);
        assert_has(err.text, "cut.dae");
        refusals++;
    }
    for (size_t cut = 0; cut + 2 < sizeof xml; cut += 3) {
        const char *path = written("cut.xml", xml, cut);
        struct scene *s = scene_load(path, &bands_default, &o, &err);
        assert_null(s);
        assert_has(err.text, "cut.xml");
        refusals++;
    }
    assert_true(refusals > 500);
    refused_at(written("cut.dae", dae, 1000), "cut.dae:", "", "");
    refused_at(in_folder("none.dae"), "none.dae", "No such file", "");
    refused_at(in_folder("scene.obj"), "scene.obj", ".xml, .dae or", "");
    refused_at(folder, "expected a name", "", "");
}

/* Packs a text of as many bytes, the document first and then blanks. */
static const char *packed(const char *name, const char *document, size_t size,
                          size_t *bytes)
{
    const size_t room = size / 16 + 65536;
    uint8_t *text = malloc(size), *out = malloc(room);
    assert_true(text && out);
    memset(text, ' ', size);
    memcpy(text, document, strlen(document));
    *bytes = 0;
    assert_int_equal(lzma_easy_buffer_encode(6, LZMA_CHECK_CRC64, NULL, text,
                                             size, out, bytes, room),
                     LZMA_OK);
    const char *path = written(name, (const char *)out, *bytes);
    free(text);
    free(out);
    return path;
}

static void packed_files_are_the_same(void **state)
{
    (void)state;
    size_t bytes;
    scene_free(load(packed("scene.dae.xz", dae, sizeof dae - 1, &bytes)));
    const char *path = in_folder("scene.dae.xz");
    assert_int_equal(truncate(path, (off_t)bytes - 40), 0);
    refused_at(path, "scene.dae.xz", "cut off", "");
    FILE *f = fopen(path, "r+b");
    assert_non_null(f);
    fseek(f, (long)bytes / 2, SEEK_SET);
    fputs("no", f);
    fclose(f);
    refused_at(path, "scene.dae.xz", "", "");
}

/* What a load that fails adds to the process' peak of memory [KiB], measured in
 * a process of its own. */
static long peak_kib(const char *path, const char *part)
{
    int pipes[2];
    assert_int_equal(pipe(pipes), 0);
    const pid_t child = fork();
    if (child == 0) {
        struct rusage before, after;
        const struct load_options o = { 0 };
        struct err err = { "" };
        getrusage(RUSAGE_SELF, &before);
        struct scene *s = scene_load(path, &bands_default, &o, &err);
        getrusage(RUSAGE_SELF, &after);
        const long more = s || !strstr(err.text, part)
                              ? -1
                              : after.ru_maxrss - before.ru_maxrss;
        if (more < 0)
            fprintf(stderr, "%s\n", s ? "it was taken" : err.text);
        _exit(write(pipes[1], &more, sizeof more) != sizeof more);
    }
    long more = -1;
    int status;
    assert_true(child > 0);
    assert_int_equal(read(pipes[0], &more, sizeof more), sizeof more);
    close(pipes[0]);
    close(pipes[1]);
    assert_int_equal(waitpid(child, &status, 0), child);
    return more;
}

static void assert_small(const char *path, const char *part, long limit_kib)
{
    const long kib = peak_kib(path, part);
    print_message("%s: %ld KiB more\n", strrchr(path, '/') + 1, kib);
    assert_true(kib >= 0);
    assert_true(kib <= limit_kib);
}

static void bombs_stay_small(void **state)
{
    (void)state;
    size_t bytes;
    const char *path = packed("bomb.dae.xz", dae, (size_t)300 << 20, &bytes);
    assert_true(bytes < 60000);
    assert_small(path, "unpacks to more than", 64 << 10);
    static const char entities[] =
        "<?xml version=\"1.0\"?>\n<!DOCTYPE COLLADA [<!ENTITY a \"aaaaaaaaaa\">"
        "\n<!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;\">"
        "<!ENTITY c \"&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;\">"
        "<!ENTITY d \"&c;&c;&c;&c;&c;&c;&c;&c;&c;&c;\">"
        "<!ENTITY e \"&d;&d;&d;&d;&d;&d;&d;&d;&d;&d;\">"
        "<!ENTITY f \"&e;&e;&e;&e;&e;&e;&e;&e;&e;&e;\">"
        "<!ENTITY g \"&f;&f;&f;&f;&f;&f;&f;&f;&f;&f;\">"
        "<!ENTITY h \"&g;&g;&g;&g;&g;&g;&g;&g;&g;&g;\">]>\n"
        "<COLLADA>&h;</COLLADA>";
    assert_small(written("entities.dae", entities, sizeof entities - 1),
                 "not taken", 8 << 10);
    static const char file[] = "<!DOCTYPE scene [<!ENTITY a SYSTEM "
                               "\"/etc/passwd\">]><scene>&a;</scene>";
    refused_at(written("file.xml", file, sizeof file - 1), "file.xml:1",
               "<!DOCTYPE", "not taken");
    /* Defaults of defaults. */
    char text[4096] = "<scene version=\"3.0.0\"><default name=\"a0\" "
                      "value=\"aaaaaaaaaa\"/>";
    for (int i = 1; i < 20; i++)
        sprintf(text + strlen(text),
                "<default name=\"a%d\" value=\"$a%d$a%d$a%d$a%d\"/>", i, i - 1,
                i - 1, i - 1, i - 1);
    strcat(text, "<shape type=\"$a19\"/></scene>");
    assert_small(written("defaults.xml", text, strlen(text)),
                 "more than 1023 characters", 8 << 10);
}

static void deep_files_are_refused(void **state)
{
    (void)state;
    enum { DEEP = 1000 };
    char *text = calloc(1, 16 * DEEP);
    strcpy(text, "<scene version=\"3.0.0\">");
    for (int i = 0; i < DEEP; i++)
        strcat(text, "<bsdf>");
    for (int i = 0; i < DEEP; i++)
        strcat(text, "</bsdf>");
    strcat(text, "</scene>");
    refused_at(written("deep.xml", text, strlen(text)), "deep.xml:1",
               "more than 100 deep", "");
    free(text);
}

/* A short file that uses a mesh many times. */
static void repeated_meshes_are_counted(void **state)
{
    (void)state;
    enum { CORNERS = 20000, COPIES = 3000 };
    char *points = calloc(1, 16 * CORNERS), *p = calloc(1, 16 * CORNERS);
    char *copies = calloc(1, (size_t)COPIES * 256), *at = p, *to = copies;
    for (int i = 0; i < CORNERS; i++)
        at += sprintf(at, "%d 0 ", i % 4);
    sprintf(points, "<vcount>%d</vcount>\n<p>%s</p>", CORNERS, p);
    for (int i = 0; i < COPIES; i++)
        to += sprintf(to, "%s", GEOMETRY("floor", "matt"));
    char *a =
        replaced(dae, "<vcount>4</vcount>\n<p>0 0 1 0 2 0 3 0</p>", points);
    char *text = replaced(a, GEOMETRY("floor", "matt"), copies);
    assert_small(written("copies.dae", text, strlen(text)),
                 "the meshes take more than", 256 << 10);
    free(points);
    free(p);
    free(copies);
    free(a);
    free(text);
}

/* -- Mitsuba -- */

static void an_xml_is_what_it_says(void **state)
{
    (void)state;
    struct scene *s = load(written("scene.xml", xml, sizeof xml - 1));
    assert_int_equal(s->shapes, 3);
    assert_int_equal(s->lights, 2);
    assert_string_equal(bsdf_spec(s->shape[0].bsdf),
                        "twosided:front=(diffuse:reflectance=0.5/"
                        "0.40000000000000002/0.29999999999999999)");
    assert_string_equal(bsdf_spec(s->shape[1].bsdf), "diffuse");
    assert_string_equal(bsdf_spec(s->shape[2].bsdf),
                        "roughconductor:alpha='0.2',distribution='ggx'");
    assert_vec(mesh_cross(s->shape[0].mesh, 0), 0, 4, 0);
    assert_vec(mesh_cross(s->shape[1].mesh, 0), 0, -.25, 0);
    assert_vec(mesh_vertex(s->shape[1].mesh, 0, 0), -.25, 2, -.25);
    assert_close(s->shape[1].surface.radiance.band[2], 3, 0);
    assert_false(s->shape[1].surface.both_sides);
    assert_vec(s->shape[2].center, .1, .5, 0);
    assert_close(s->shape[2].radius, .4, 1e-12);
    const struct camera *c = scene_camera(s);
    assert_vec(position(c), 0, 1, 5);
    assert_vec(affine_vector(&c->to_world, (struct vec3){ 1, 0, 0 }), -1, 0, 0);
    assert_vec(affine_vector(&c->to_world, (struct vec3){ 0, 0, 1 }), 0, 0, -1);
    assert_close(c->focal, 20 / tan(20 * PI / 180), 1e-9);
    assert_close(c->near, .01, 1e-12);
    const struct scene_wishes w = scene_wishes(s);
    assert_int_equal(w.samples, 9);
    assert_int_equal(w.max_depth, 5);
    assert_int_equal(w.rr_depth, 5);
    assert_false(w.robust);
    scene_free(s);
    s = load(xml_file("<shape ", ROBUST("true") "<shape "));
    assert_true(scene_wishes(s).robust);
    scene_free(s);
}

static void definitions_replace_defaults(void **state)
{
    (void)state;
    const char *path = written("scene.xml", xml, sizeof xml - 1);
    const struct load_options o = { .width = 80,
                                    .height = 20,
                                    .define = { "half=1", "alpha=.3" },
                                    .defines = 2 };
    struct scene *s = load_with(path, &o);
    assert_close(s->shape[1].area, 4, 1e-6);
    assert_string_equal(bsdf_spec(s->shape[2].bsdf),
                        "roughconductor:alpha='.3',distribution='ggx'");
    assert_close(scene_camera(s)->focal, 40 / tan(20 * PI / 180), 1e-9);
    scene_free(s);
    static const struct {
        const char *define[2], *part;
    } bad[] = { { { "alpha", NULL }, "expected NAME=VALUE" },
                { { "alpa=1", NULL }, "did you mean \"alpha\"" },
                { { "alpha=1", "alpha=2" }, "defined twice" },
                { { "alpha=x", NULL }, "expected a number at \"x\"" },
                { { "alpha=0.1',k='1", NULL }, "expected a number" } };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct load_options b = { .define = { bad[i].define[0],
                                              bad[i].define[1] },
                                  .defines = bad[i].define[1] ? 2 : 1 };
        struct err err;
        assert_null(scene_load(path, &bands_default, &b, &err));
        assert_has(err.text, bad[i].part);
        assert_has(err.text, i == 0 || i == 2 ? "-D" : "scene.xml");
    }
    xml_refused("$half", "$quarter", "<scale>", "\"$quarter\"", "no <default>");
    xml_refused("$half", "$", "<scale>", "\"$\"", "no <default>");
}

/* Half the side of the picture that the field of view spans, for 40 x 30. */
static void fields_of_view_are_mitsubas(void **state)
{
    (void)state;
    static const struct {
        const char *axis;
        double half;
    } axes[] = { { "x", 20 },
                 { "y", 15 },
                 { "smaller", 15 },
                 { "larger", 20 },
                 { "diagonal", 25 } };
    for (size_t i = 0; i < 5; i++) {
        char by[128];
        snprintf(by, sizeof by,
                 "value=\"40\"/><string name=\"fov_axis\" value=\"%s\"/>",
                 axes[i].axis);
        struct scene *s = load(xml_file("value=\"40\"/>", by));
        assert_close(scene_camera(s)->focal, axes[i].half / tan(20 * PI / 180),
                     1e-9);
        scene_free(s);
    }
    xml_refused("value=\"40\"/>",
                "value=\"40\"/><string name=\"fov_axis\" value=\"z\"/>",
                "<sensor>", "fov_axis \"z\"", "diagonal");
}

/* A cube of 2 x 2 x 6, turned and mirrored, has its own volume inside. */
static void shapes_keep_their_outside(void **state)
{
    (void)state;
    static const char *const steps[] = {
        "<scale z=\"3\"/><rotate y=\"1\" angle=\"33\"/><translate x=\"2\"/>",
        "<scale x=\"-1\" z=\"3\"/><rotate x=\"1\" angle=\"77\"/>",
        "<matrix value=\"1 0 0 2 0 0 1 0 0 3 0 0 0 0 0 1\"/>",
    };
    for (int i = 0; i < 3; i++) {
        char by[512];
        snprintf(by, sizeof by,
                 "<shape type=\"cube\"><transform name=\"to_world\">%s"
                 "</transform></shape><shape type=\"sphere\" id=\"ball\">",
                 steps[i]);
        struct scene *s =
            load(xml_file("<shape type=\"sphere\" id=\"ball\">", by));
        const struct mesh *m = s->shape[2].mesh;
        double volume = 0;
        for (size_t k = 0; k < m->triangles; k++)
            volume += vec3_dot(mesh_vertex(m, k, 0), mesh_cross(m, k)) / 6;
        assert_int_equal(m->triangles, 12);
        assert_close(volume, 24, 1e-4);
        scene_free(s);
    }
    /* A mirrored rectangle faces where it did, a mirrored sphere inward. */
    struct scene *s =
        load(xml_file("<rotate x=\"1\" angle=\"-90\"/>", "<scale x=\"-1\"/>"));
    assert_vec(mesh_cross(s->shape[0].mesh, 0), 0, 0, 4);
    scene_free(s);
    s = load(xml_file("<float name=\"radius\"",
                      "<transform name=\"to_world\"><scale value=\"-2\"/>"
                      "</transform><float name=\"radius\""));
    assert_true(s->shape[2].flags & SHAPE_FLIPPED);
    assert_close(s->shape[2].radius, .8, 1e-12);
    assert_vec(s->shape[2].center, -.2, -1, 0);
    scene_free(s);
    s = load(xml_file("type=\"rectangle\" id=\"floor\">",
                      "type=\"disk\" id=\"floor\"><boolean "
                      "name=\"flip_normals\" value=\"true\"/>"));
    assert_int_equal(s->shape[0].kind, SHAPE_DISK);
    assert_vec(s->shape[0].normal, 0, -1, 0);
    scene_free(s);
}

static void what_is_wrong_in_an_xml_is_named(void **state)
{
    (void)state;
    xml_refused("<shape ", ROBUST("yes") "<shape ", "<boolean", "\"yes\"",
                "expected true or false");
    xml_refused("<shape ", "<boolean name=\"robust\" value=\"true\"/><shape ",
                "<boolean \"robust\">", "embree_use_robust_intersections", "");
    xml_refused("version=\"3.0.0\"", "version=\"0.6.0\"", ":1: <scene>",
                "0.6.0", "expected 3.0.0");
    xml_refused("type=\"box\"", "type=\"tent\"", "<rfilter>",
                "expected <rfilter type=\"box\"/>", "");
    xml_refused("<rfilter type=\"box\"/>", "", "<film>", "rfilter", "");
    xml_refused("type=\"perspective\"", "type=\"fisheye\"", "<sensor>",
                "fisheye", "expected perspective");
    xml_refused("type=\"path\"", "type=\"volpath\"", "<integrator>", "volpath",
                "expected path");
    xml_refused("value=\"6\"", "value=\"0\"", "<integrator>", "max_depth 0",
                "at least 1");
    xml_refused("value=\"6\"", "value=\"6.5\"", ":4: <integer \"max_depth\">",
                "6.5", "a whole number");
    xml_refused("<integer name=\"max_depth\"", "<float name=\"max_depth\"",
                "<float \"max_depth\">", "expected <integer", "");
    xml_refused("name=\"max_depth\"", "name=\"depth\"", "<integer \"depth\">",
                "it is unknown", "path");
    xml_refused("value=\"40\"/>", "value=\"180\"/>", "<sensor>", "fov 180",
                "below 180");
    xml_refused("value=\"40\"/>", "value=\"wide\"/>", "<float \"fov\">",
                "\"wide\"", "a finite number");
    xml_refused("value=\"30\"", "value=\"0\"", "<film>", "40 x 0", "65536");
    xml_refused("origin=\"0,1,5\"", "origin=\"0,1\"", "<lookat>",
                "origin=\"0,1\"", "expected three numbers");
    xml_refused("origin=\"0,1,5\"", "origin=\"0,1,0\"", "<lookat>",
                "other than the origin", "");
    xml_refused("<lookat ", "<scale value=\"2\"/><lookat ", "<sensor>",
                "stretches by 2", "");
    xml_refused("type=\"rectangle\"", "type=\"rectangel\"", "<shape \"floor\">",
                "did you mean \"rectangle\"", "");
    xml_refused("<ref id=\"wall\"/>", "<ref id=\"wal\"/>", "<ref \"wal\">",
                "nothing of this id", "");
    xml_refused("type=\"diffuse\"", "type=\"principled\"", "<bsdf>",
                "\"principled\" is unknown", "diffuse");
    xml_refused("type=\"area\"", "type=\"spot\"", "<emitter>", "spot",
                "expected area");
    xml_refused("value=\".5, .4, .3\"", "value=\".5, .4\"",
                "<rgb \"reflectance\">", "one number or three", "");
    xml_refused("value=\".5, .4, .3\"", "value=\"#808080\"",
                "<rgb \"reflectance\">", "#808080", "a finite number");
    xml_refused("value=\".5, .4, .3\"", "value=\".5, 4, .3\"", "<bsdf",
                "reflectance = 4", "[0, 1]");
    xml_refused("value=\"1 2 3\"", "value=\"1 -2 3\"", "<rgb \"radiance\">",
                "-2", "at least 0");
    xml_refused("<float name=\"alpha\"", "<rgb name=\"alpha\"",
                "<rgb \"alpha\">", "expected <float name=\"alpha\">", "");
    xml_refused("name=\"alpha\" value=\"$", "name=\"alhpa\" value=\"$",
                "<float \"alhpa\">", "unknown", "roughconductor");
    xml_refused("<float name=\"radius\" value=\".4\"/>",
                "<float name=\"radius\" value=\"0\"/>", "<shape \"ball\">",
                "radius 0", "above 0");
    xml_refused("<float name=\"radius\" value=\".4\"/>",
                "<float name=\"radius\" value=\".4\"/><float name=\"radius\" "
                "value=\".4\"/>",
                "<float \"radius\">", "given twice", "");
    xml_refused("<float name=\"radius\"",
                "<transform name=\"to_world\"><scale x=\"2\"/></transform>"
                "<float name=\"radius\"",
                "<shape \"ball\">", "no sphere", "");
    xml_refused("<bsdf type=\"diffuse\">", "<ref id=\"wall\"/><bsdf>",
                "<bsdf \"wall\">", "more than 8 deep", "itself");
    xml_refused("<rotate x=\"1\"", "<rotate x=\"0\"", "<rotate>",
                "an axis other than 0, 0, 0", "");
    xml_refused("<emitter type=\"constant\">",
                "<medium/><emitter "
                "type=\"constant\">",
                "<medium>", "expected integrator", "");
}

/* -- mesh files -- */

static const char ply[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
    "property float y\nproperty float z\nelement face 2\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n3 0 1 2\n3 0 2 3\n";

static const char obj[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\n"
                          "f 1 2 3\nf 1 3 4\n";

static struct mesh *mesh_of(const char *path, bool flat)
{
    const struct meshfile_options o = { affine_identity, flat, false };
    struct err err;
    struct mesh *m = meshfile_read(path, &o, &err);
    if (!m)
        fail_msg("%s", err.text);
    return m;
}

static void mesh_refused(const char *name, const char *document,
                         const char *what, const char *by, const char *a,
                         const char *b)
{
    const struct meshfile_options o = { .to_world = affine_identity };
    char *text = replaced(document, what, by);
    const char *path = written(name, text, strlen(text));
    struct err err;
    struct mesh *m = meshfile_read(path, &o, &err);
    free(text);
    if (m)
        fail_msg("%s was taken", by);
    assert_has(err.text, name);
    assert_has(err.text, a);
    assert_has(err.text, b);
}

static void mesh_files_are_what_they_say(void **state)
{
    (void)state;
    const char *paths[] = { written("mesh.ply", ply, sizeof ply - 1),
                            written("mesh.obj", obj, sizeof obj - 1) };
    for (int i = 0; i < 2; i++) {
        struct mesh *m = mesh_of(paths[i], false);
        assert_int_equal(m->vertices, 4);
        assert_int_equal(m->triangles, 2);
        assert_non_null(m->normal);
        assert_vec(mesh_vertex(m, 1, 2), 0, 1, .5);
        assert_vec(mesh_cross(m, 0), 0, 0, 1);
        mesh_free(m);
        m = mesh_of(paths[i], true);
        assert_null(m->normal);
        mesh_free(m);
    }
    static const char bare[] = "v .5 .5 0\nv\t-.5 +.5 -.25\r\nv 0 -0.5 0\n"
                               "f 1 2 3\n";
    struct mesh *m = mesh_of(written("mesh.obj", bare, sizeof bare - 1), true);
    assert_vec(mesh_vertex(m, 0, 0), .5, .5, 0);
    assert_vec(mesh_vertex(m, 0, 1), -.5, .5, -.25);
    mesh_free(m);
    struct scene *s =
        load(xml_file("<shape type=\"sphere\" id=\"ball\">",
                      "<shape type=\"ply\"><string name=\"filename\" "
                      "value=\"mesh.ply\"/></shape><shape type=\"sphere\" "
                      "id=\"ball\">"));
    assert_int_equal(s->shape[2].mesh->triangles, 2);
    scene_free(s);
}

static void broken_mesh_files_are_named(void **state)
{
    (void)state;
    mesh_refused("mesh.ply", ply, "vertex 4", "vertex 1000000", "mesh.ply:3",
                 "1000000 of \"vertex\" are claimed");
    mesh_refused("mesh.ply", ply, "face 2", "face 4000000000", "mesh.ply:7",
                 "too short");
    mesh_refused("mesh.ply", ply, "face 2", "face -2", "mesh.ply:7",
                 "a name and a number");
    mesh_refused("mesh.ply", ply, "1 1 0\n", "1 nan 0\n", "vertex", "nan");
    mesh_refused("mesh.ply", ply, "end_header\n", "", "expected", "");
    mesh_refused("mesh.ply", ply, "ply\n", "plx\n", "mesh.ply:1", "\"ply\"");
    mesh_refused("mesh.ply", ply, "3 0 2 3", "3 0 2 7", "", "");
    mesh_refused("mesh.ply", ply, "float y", "flout y", "mesh.ply:5",
                 "expected a type");
    mesh_refused("mesh.obj", obj, "f 1 2 3\nf 1 3 4\n", "", "", "");
    mesh_refused("mesh.obj", obj, "v 1 1 0", "v 1 inf 0", "", "");
    mesh_refused("mesh.obj", obj, "v 1 1 0", "v 1 1", "mesh.obj:3: \"v 1 1\"",
                 "three numbers");
    mesh_refused("mesh.obj", obj, "v 1 1 0", "v 1 one 0", "mesh.obj:3",
                 "three numbers");
    mesh_refused("mesh.stl", obj, "v", "v", ".ply or .obj", "");
    const char *path = xml_file(
        "<shape type=\"sphere\" id=\"ball\">",
        "<shape type=\"ply\" id=\"far\"><string name=\"filename\" "
        "value=\"none.ply\"/></shape><shape type=\"sphere\" id=\"ball\">");
    refused_at(path, "<shape \"far\">", "none.ply", "No such file");
    char claim[] = "ply\nformat binary_little_endian 1.0\nelement vertex "
                   "1000000\nproperty float x\nproperty float y\nproperty "
                   "float z\nelement face 1\nproperty list uchar int "
                   "vertex_indices\nend_header\n1234567890";
    written("none.ply", claim, sizeof claim - 1);
    assert_small(path, "claimed", 8 << 10);
}

/* Of a text the last digits may be missing. */
static void cut_off_mesh_files_are_refused(void **state)
{
    static const char head[] =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
        "property float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    static const float xyz[] = { 0, 0, 0, 1, 0, 0, 1, 1, 0 };
    static const int corner[2][3] = { { 0, 1, 2 }, { 2, 1, 0 } };
    const struct meshfile_options o = { .to_world = affine_identity };
    char text[sizeof head + sizeof xyz + 2 * 13], *to = text;
    (void)state;
    to = (char *)memcpy(to, head, sizeof head - 1) + sizeof head - 1;
    to = (char *)memcpy(to, xyz, sizeof xyz) + sizeof xyz;
    for (int i = 0; i < 2; i++) {
        *to++ = 3;
        to = (char *)memcpy(to, corner[i], 12) + 12;
    }
    const size_t size = (size_t)(to - text);
    struct err err;
    mesh_free(mesh_of(written("cut.ply", text, size), false));
    for (size_t cut = 0; cut < size; cut++) {
        const char *path = written("cut.ply", text, cut);
        struct mesh *m = meshfile_read(path, &o, &err);
        if (m)
            fail_msg("%zu of %zu bytes were taken", cut, size);
        assert_has(err.text, "cut.ply");
    }
    for (size_t cut = 0; cut + 3 < sizeof ply; cut += 5) {
        const char *path = written("cut.ply", ply, cut);
        if (meshfile_read(path, &o, &err))
            fail_msg("%zu bytes were taken", cut);
    }
}

/* Every byte that a mutation can touch, and what is left of files: nothing may
 * crash or hang.  Under sanitizers that means more. */
static void no_mutilated_file_crashes(void **state)
{
    static const char odd[] = "\0\xff<>&\"' -9e.#$/";
    static const struct {
        const char *name, *text;
        size_t size;
    } files[] = { { "fuzz.dae", dae, sizeof dae - 1 },
                  { "fuzz.xml", xml, sizeof xml - 1 } };
    (void)state;
    const struct rng rng = { 1, 0 };
    long taken = 0;
    for (uint64_t i = 0; i < 1500; i++) {
        const int which = (int)(i % 2);
        const double size = (double)files[which].size;
        char text[sizeof dae];
        memcpy(text, files[which].text, files[which].size);
        for (uint64_t k = 0; k < 1 + i / 2 % 3; k++) {
            const struct vec3 u = rng_uniform(rng, 4 * i + k);
            text[(size_t)(size * u.x)] = odd[(size_t)((sizeof odd - 1) * u.y)];
        }
        const struct load_options o = { .lenient = i % 3 == 0 };
        struct err err = { "" };
        struct scene *s =
            scene_load(written(files[which].name, text, files[which].size),
                       &bands_default, &o, &err);
        taken += s != NULL;
        assert_true(s || err.text[0]);
        scene_free(s);
    }
    print_message("%ld of 1500 mutilated files were taken\n", taken);
}

/* -- parts -- */

static void transforms_are_what_they_say(void **state)
{
    (void)state;
    const struct affine a = affine_mul(
        affine_translate((struct vec3){ .3, -.7, 2.1 }),
        affine_mul(affine_rotate((struct vec3){ .2, 1.3, -.4 }, 41.3),
                   affine_scale((struct vec3){ 1.7, -.6, 2.3 })));
    struct affine b;
    assert_close(affine_det(&a), -1.7 * .6 * 2.3, 1e-12);
    assert_true(affine_inverse(&a, &b));
    const struct vec3 p = { .13, .57, -.91 }, q = { -.33, .21, .77 };
    assert_vec(affine_point(&b, affine_point(&a, p)), p.x, p.y, p.z);
    /* Normals stay at right angles to what they were at right angles to. */
    const struct vec3 n = vec3_cross(p, q);
    assert_close(vec3_dot(affine_normal(&a, n), affine_vector(&a, p)), 0,
                 1e-12);
    const struct vec3 turned = affine_normal(&a, n);
    const struct vec3 crossed =
        vec3_cross(affine_vector(&a, p), affine_vector(&a, q));
    assert_vec(turned, crossed.x, crossed.y, crossed.z);
    const struct affine quarter = affine_rotate((struct vec3){ 0, 0, 1 }, 90);
    const struct vec3 y = affine_vector(&quarter, (struct vec3){ 1, 0, 0 });
    assert_true(y.x == 0 && y.y == 1 && y.z == 0);
    struct affine flat = affine_scale((struct vec3){ 1, 0, 1 });
    assert_false(affine_inverse(&flat, &b));
    assert_false(affine_look_at(p, p, q, &b));
    assert_false(affine_look_at(p, vec3_add(p, q), vec3_scale(-2, q), &b));
}

static void compatibility_has_names(void **state)
{
    (void)state;
    struct err err;
    unsigned compat;
    char text[128];
    assert_true(compat_parse(&compat, "course", &err));
    assert_int_equal(compat, COMPAT_COURSE);
    compat_print(compat, text, sizeof text);
    assert_string_equal(text, "camera,tone,light-pdf,light-quad,schlick,lambda,"
                              "fresnel,refraction");
    assert_true(compat_parse(&compat, "light-pdf,tone", &err));
    assert_int_equal(compat, COMPAT_LIGHT_PDF | COMPAT_TONE);
    assert_true(compat_parse(&compat, "none", &err));
    assert_int_equal(compat, 0);
    compat_print(compat, text, sizeof text);
    assert_string_equal(text, "none");
    compat_print(COMPAT_COURSE, text, 10);
    assert_int_equal(strlen(text), 9);
    assert_false(compat_parse(&compat, "schlik", &err));
    assert_has(err.text, "did you mean \"schlick\"");
    assert_false(compat_parse(&compat, "tone,", &err));
    assert_false(compat_parse(&compat, "", &err));
}

/* -- what is there besides -- */

/* The triangles' normals cancel out, and point outward. */
static void closed(const struct mesh *m)
{
    struct vec3 sum = { 0, 0, 0 };
    double volume = 0, area = 0;
    for (size_t i = 0; i < m->triangles; i++) {
        const struct vec3 n = mesh_cross(m, i);
        sum = vec3_add(sum, n);
        area += vec3_length(n);
        volume += vec3_dot(mesh_vertex(m, i, 0), n) / 6;
    }
    assert_non_null(m->normal);
    assert_at_most(vec3_length(sum), 1e-6 * area);
    assert_true(volume > 0);
}

static void in_tree_scenes_load(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t shapes, triangles;
    } scenes[] = { { "spheres", 8, 12 },
                   { "spheres_diffuse", 8, 12 },
                   { "spheres_metal", 8, 12 },
                   { "furnace", 1, 0 },
                   { "mesh", 7, 70012 } };
    for (size_t i = 0; i < 5; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/../scenes/%s.xml", getenv("BIN"),
                 scenes[i].name);
        const struct load_options o = { .define = { "max_depth=3" },
                                        .defines = 1 };
        struct scene *s = load_with(path, &o);
        struct err err;
        assert_int_equal(scene_size(s).shapes, scenes[i].shapes);
        assert_int_equal(scene_size(s).triangles, scenes[i].triangles);
        assert_int_equal(scene_size(s).lights, 1);
        assert_int_equal(scene_wishes(s).max_depth, 2);
        assert_true(scene_commit(s, &err));
        if (scenes[i].triangles > 12)
            closed(s->shape[6].mesh);
        scene_free(s);
    }
}

static const char *course(const char *name)
{
    static char path[1024];
    const char *shared = getenv("BSDF_SHARED");
    if (!shared)
        return NULL;
    snprintf(path, sizeof path, "%s/data/cs184/%s", shared, name);
    return access(path, R_OK) == 0 ? path : NULL;
}

/* The figures are from the course's own program. */
static void course_scenes_load(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t shapes, triangles;
        double z; /* of the camera */
    } scenes[] = {
        { "CBspheres.dae", 8, 12, 4.802344 },
        { "CBspheres_lambertian.dae", 8, 12, 4.802344 },
        { "CBspheres_refract.dae", 8, 12, 4.802344 },
        { "CBspheres_microfacet_al_ag.dae", 8, 12, 4.802344 },
        { "CBempty.dae", 6, 12, 4.802344 },
        { "CBbunny_microfacet_cu.dae", 7, 28588, -4.802344 },
        { "CBdragon_microfacet_au.dae.xz", 7, 100012, 4.802344 },
    };
    if (!course("CBspheres.dae"))
        skip();
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        const char *path = course(scenes[i].name);
        if (!path)
            continue;
        const clock_t start = clock();
        struct scene *s = load(path);
        print_message("%s: %.3f s\n", scenes[i].name,
                      (double)(clock() - start) / CLOCKS_PER_SEC);
        assert_int_equal(scene_size(s).shapes, scenes[i].shapes);
        assert_int_equal(scene_size(s).triangles, scenes[i].triangles);
        assert_vec(position(scene_camera(s)), 0, .75, scenes[i].z);
        scene_free(s);
    }
    /* As shipped, with a camera's matrix of 15 numbers. */
    if (course("CBgems.dae"))
        refused_at(course("CBgems.dae"), "<matrix>", "it has 15 numbers",
                   "expected 16");
}

static void a_wrong_scene_ends_the_program_with_2(void **state)
{
    (void)state;
    char command[1024];
    const char *path = dae_file("-1 0 0 0 0 0 1 3 0 1 0 0 0 0 0 1", "1 0");
    snprintf(command, sizeof command, "bsdf-render %s", path);
    refused(command, path, "it has 2 numbers: expected 16");
}

static int setup(void **state)
{
    (void)state;
    return shell_setup("scenes", "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "a .dae is what it says", a_dae_is_what_it_says },
        { "compatibility gives the course's models, light and camera",
          compatibility_is_the_courses },
        { "an area light without a mesh is a rectangle",
          an_area_light_alone_is_a_rectangle },
        { "ambient and point lights are taken", other_lights_are_taken },
        { "a matrix of 15 numbers is named",
          matrices_of_fifteen_numbers_are_named },
        { "missing and cyclic references are named",
          missing_and_cyclic_references_are_named },
        { "what a .dae lacks is named", what_is_missing_in_a_dae_is_named },
        { "lenient: what is unknown is left out with a warning",
          lenient_leaves_out_what_is_unknown },
        { "NaN vertices and claims of a million are named",
          broken_meshes_are_named },
        { "lights without an area are named", lights_without_area_are_named },
        { "files that are cut off are refused", cut_off_files_are_refused },
        { "packed files are the same, or damaged", packed_files_are_the_same },
        { "bombs take little memory", bombs_stay_small },
        { "elements may not nest without end", deep_files_are_refused },
        { "a mesh that is used many times is counted",
          repeated_meshes_are_counted },
        { "an .xml is what it says", an_xml_is_what_it_says },
        { "-D goes before defaults", definitions_replace_defaults },
        { "fields of view are Mitsuba's", fields_of_view_are_mitsubas },
        { "turned and mirrored shapes keep their outside",
          shapes_keep_their_outside },
        { "what is wrong in an .xml is named",
          what_is_wrong_in_an_xml_is_named },
        { "PLY and OBJ are what they say", mesh_files_are_what_they_say },
        { "broken mesh files are named", broken_mesh_files_are_named },
        { "mesh files that are cut off are refused",
          cut_off_mesh_files_are_refused },
        { "no mutilated file crashes", no_mutilated_file_crashes },
        { "transforms are what they say", transforms_are_what_they_say },
        { "compatibility has names", compatibility_has_names },
        { "the scenes of this project load", in_tree_scenes_load },
        { "the course's scenes load", course_scenes_load },
        { "a scene that is wrong ends bsdf-render with status 2",
          a_wrong_scene_ends_the_program_with_2 },
    };
    return cmocka_run_group_tests_name("scenes", tests, setup, shell_teardown);
}
