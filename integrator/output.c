/* output.c - files and a summary */
#include "integrator/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bsdf/cli.h"
#include "bsdf/outfile.h"
#include "integrator/measure.h"

static bool ends(const char *path, const char *with)
{
    const size_t n = strlen(path), k = strlen(with);
    return n > k && strcmp(path + n - k, with) == 0;
}

bool output_is_png(const char *path)
{
    return ends(path, ".png");
}

bool output_check(const char *path, struct err *err)
{
    return output_is_png(path) || ends(path, ".exr") ||
           err_set(err, "-f %.200s: expected a name that ends in .png or .exr",
                   path);
}

bool output_can(const char *path, struct err *err)
{
    struct outfile out;
    const bool can = outfile_open(&out, path, err);
    if (can)
        outfile_abandon(&out);
    return can;
}

void output_name(const char *scene, char *name, size_t size)
{
    const char *slash = strrchr(scene, '/');
    const char *base = slash ? slash + 1 : scene;
    static const char *const ending[] = { ".dae.xz", ".dae", ".xml" };
    size_t stem = strlen(base);
    for (int i = 0; i < 3; i++)
        if (ends(base, ending[i])) {
            stem -= strlen(ending[i]);
            break;
        }
    snprintf(name, size, "%.*s.png", stem > 200 ? 200 : (int)stem, base);
}

/* NAME.png to NAME_rate.png; NULL when out of memory. */
static char *rate_name(const char *path)
{
    const size_t n = strlen(path) - strlen(".png");
    char *name = malloc(n + sizeof "_rate.png");
    if (name) {
        memcpy(name, path, n);
        strcpy(name + n, "_rate.png");
    }
    return name;
}

static bool write_png(const struct render_result *made, const char *path,
                      const struct output_settings *how, struct err *err)
{
    if (!film_write_png(made->film, path, how->tone, how->exposure, err))
        return false;
    if (!(how->render->tolerance > 0))
        return true;
    char *name = rate_name(path);
    const bool ok =
        name ? film_write_rate(made->film, name, how->render->samples, err)
             : err_set(err, "%s: out of memory", path);
    free(name);
    return ok;
}

static bool write_exr(const struct render_result *made, const char *path,
                      const struct output_settings *how, struct err *err)
{
    char seed[32], seconds[32], when[32] = "";
    const time_t now = time(NULL);
    struct tm utc;
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)how->render->seed);
    snprintf(seconds, sizeof seconds, "%.3f", made->seconds);
    if (gmtime_r(&now, &utc))
        strftime(when, sizeof when, "%Y-%m-%dT%H:%M:%SZ", &utc);
    const struct film_note notes[] = {
        { "scene", how->scene }, { "command", how->command },
        { "seed", seed },        { "version", "bsdf-render " BSDF_VERSION },
        { "seconds", seconds },  { "time", when },
        { NULL, NULL },
    };
    return film_write_exr(made->film, path, notes, err);
}

bool output_write(const struct render_result *made, const char *path,
                  const struct output_settings *how, struct err *err)
{
    return ends(path, ".exr") ? write_exr(made, path, how, err)
                              : write_png(made, path, how, err);
}

void output_scene(FILE *out, const char *name, const struct scene *s)
{
    const struct scene_size size = scene_size(s);
    const struct camera *c = scene_camera(s);
    fprintf(out, "%s: %zu shape%s, %zu triangles, %zu light%s, %.1f MB; ", name,
            size.shapes, size.shapes == 1 ? "" : "s", size.triangles,
            size.lights, size.lights == 1 ? "" : "s", (double)size.bytes / 1e6);
    fprintf(out, "%d x %d pixels\n", c->width, c->height);
}

void output_summary(FILE *out, const struct render_result *made,
                    const struct render_settings *settings)
{
    const double s = made->seconds > 0 ? made->seconds : 1e-9;
    const char *const by =
        settings->path.rr_probability > 0 ? "fixed" : "weight";
    fprintf(out,
            "%ssamples %llu, depth %d, roulette after %d (by %s), seed %llu: "
            "%.2f million paths, %.2f million rays in %.2f s "
            "(%.2f million rays/s)\n",
            made->stopped ? "stopped; " : "",
            (unsigned long long)settings->samples, settings->path.max_depth,
            settings->path.rr_depth, by, (unsigned long long)settings->seed,
            (double)made->paths / 1e6, (double)made->rays / 1e6, made->seconds,
            (double)made->rays / 1e6 / s);
    struct measure m;
    if (!measure_film(made->film, 0, 0, 0, 0, &m, NULL))
        return; /* all of a picture is always in it */
    if (m.without > 0)
        fprintf(out, "%ld pixels have no sample yet, and count for nothing\n",
                m.without);
    fprintf(out, "mean luminance %.6g", m.luminance);
    if (isfinite(m.error))
        fprintf(out, " +- %.2g", m.error);
    fputc('\n', out);
    if (settings->tolerance > 0)
        fprintf(out, "samples a pixel: %.1f on average, %u to %u\n", m.samples,
                m.least, m.most);
}
