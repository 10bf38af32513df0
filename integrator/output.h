/* output.h - what a rendering leaves behind */
#ifndef INTEGRATOR_OUTPUT_H
#define INTEGRATOR_OUTPUT_H

#include <stdio.h>

#include "integrator/render.h"

struct output_settings {
    const struct render_settings *render;
    const char *scene, *command; /* for an EXR's attributes */
    enum film_tone tone;         /* of a PNG */
    double exposure;
};

bool output_is_png(const char *path); /* by its name */

/** Whether a name ends in .png or .exr. */
bool output_check(const char *path, struct err *err);

/** Whether a file can be made there, before hours are spent on what goes into
 * it. */
bool output_can(const char *path, struct err *err);

/** The scene's name in the present folder, with .png for its ending. */
void output_name(const char *scene, char *name, size_t size);

/** Writes a PNG or an EXR; a PNG of an adaptive rendering gets NAME_rate.png
 * beside it. */
bool output_write(const struct render_result *made, const char *path,
                  const struct output_settings *how, struct err *err);

/** "NAME: 9 shapes, 24 triangles, 1 light, 0.1 MB". */
void output_scene(FILE *out, const char *name, const struct scene *s);

/** Paths, rays and time; the mean luminance and its standard error; of adaptive
 * sampling, how many samples the pixels took. */
void output_summary(FILE *out, const struct render_result *made,
                    const struct render_settings *settings);

#endif
