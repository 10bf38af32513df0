/* film.h - pictures that know how sure they are
 *
 * A pixel has the mean of its samples, the variance of that mean, and how many
 * samples there were; besides, what the camera saw first: depth, normal,
 * albedo.  Row by row from the upper left pixel, linear, in float.
 */
#ifndef INTEGRATOR_FILM_H
#define INTEGRATOR_FILM_H

#include <stddef.h>
#include <stdint.h>

#include "bsdf/err.h"

struct film_pixel {
    float mean[3];            /* radiance in R, G and B */
    float variance[3];        /* of the mean: s^2 / n; NaN for n < 2 */
    float luminance_variance; /* of the mean's luminance, likewise */
    uint32_t count;           /* n */
    float depth;     /* mean distance of what was hit; 0 where nothing was */
    float normal[3]; /* mean shading normal in the world; 0 likewise */
    float albedo[3]; /* mean of the first weight that is not of a delta lobe */
};

struct film {
    int width, height;
    struct film_pixel *pixel; /* width * height */
};

/** A name and a text, kept in the file. */
struct film_note {
    const char *name, *value;
};

/** All 0; NULL and the reason where a side is not in [1, 65536], the product is
 * above 2^28, or memory is out. Owned by the caller. */
struct film *film_new(int width, int height, struct err *err);
void film_free(struct film *f); /* NULL is fine */

/** Luminance of linear R, G and B: 0.2126, 0.7152, 0.0722 (ITU-R BT.709). */
double film_luminance(const float rgb[3]);

/** Writes all of it: channels R, G, B, variance.R ..., variance.Y, count,
 * depth, normal.X ..., albedo.R ..., float but for the count, ZIP; notes are
 * string attributes, the last has no name.  Whole or not at all. */
bool film_write_exr(const struct film *f, const char *path,
                    const struct film_note *notes, struct err *err);

/** Reads what film_write_exr wrote; R, G and B must be there, the rest is NaN
 * or 0 where it is not. Any file of another size or nature is an error. */
struct film *film_read_exr(const char *path, struct err *err);

enum film_tone {
    FILM_SRGB,  /* the sRGB curve (IEC 61966-2-1), rounded */
    FILM_COURSE /* (sqrt(2) L)^(1/2.2), truncated */
};

/** The means as 8-bit PNG, clamped; exposure is a factor. */
bool film_write_png(const struct film *f, const char *path, enum film_tone tone,
                    double exposure, struct err *err);

/** The rate map: r = count / samples, blue to green up to 1/2, then green to
 * red, linear, 8 bits. */
bool film_write_rate(const struct film *f, const char *path, uint64_t samples,
                     struct err *err);

/** 8-bit RGB from a PNG, three bytes a pixel. */
struct png {
    int width, height;
    unsigned char *rgb; /* owned */
};
bool png_read(struct png *png, const char *path, struct err *err);
bool png_write(const struct png *png, const char *path, struct err *err);

#endif
