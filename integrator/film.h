/* film.h - pictures that know how sure they are
 *
 * A pixel has the mean of its samples, the variance of that mean, and how many
 * samples there were; besides, what the camera saw first: depth, normal,
 * albedo.  Row by row from the upper left pixel, linear, in float.
 */
#ifndef INTEGRATOR_FILM_H
#define INTEGRATOR_FILM_H

#include <stdbool.h>
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

enum { FILM_SIDE_MAX = 65536, FILM_PIXELS_MAX = 1 << 28 };

/** Whether a picture may be of that size. */
bool film_size_ok(int64_t width, int64_t height);

/** All 0; NULL and the reason where film_size_ok is false or memory is out.
 * Owned by the caller. */
struct film *film_new(int width, int height, struct err *err);
void film_free(struct film *f); /* NULL is fine */

/** Luminance of linear R, G and B (ITU-R BT.709). */
static inline double film_luminance_of(double r, double g, double b)
{
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
double film_luminance(const float rgb[3]);

/* -- OpenEXR ---------------------------------------------------------------
 *
 *   R G B              the mean, which every viewer shows
 *   Z                  depth
 *   albedo.R .G .B     layers of the first hit
 *   normal.X .Y .Z
 *   variance.R .G .B   of the mean; .Y is that of its luminance
 *   count              of samples, 32-bit whole numbers (float is read as
 * well); the rest are float
 *
 * R, G, B and Z are names that the format's own documentation reserves for
 * these; LAYER.CHANNEL is its way of grouping the others.  Scan lines, ZIP.
 */

/** Writes all of it, every bit of every number; notes are string attributes,
 * the last has no name (NULL notes: none).  The same film and notes give the
 * same bytes.  Whole or not at all (bsdf/outfile.h); a pipe cannot be
 * written to. */
bool film_write_exr(const struct film *f, const char *path,
                    const struct film_note *notes, struct err *err);

/** Reads a single picture in scan lines of any compression but DWA, its data
 * window the display window.  R, G and B must be there, float or half; what
 * else is not there is NaN if a variance, else 0.  Owned by the caller; NULL
 * and the reason for any other file: what a header claims is held against the
 * file's size before room is made for it. */
struct film *film_read_exr(const char *path, struct err *err);

/* -- PNG -------------------------------------------------------------------
 *
 * 8-bit R, G and B.  A pixel with a channel that is not a number is magenta, so
 * that nobody overlooks it; infinities are clamped like other numbers.
 */

enum film_tone {
    FILM_SRGB,  /* the sRGB curve (IEC 61966-2-1), rounded; marked as sRGB */
    FILM_COURSE /* (sqrt(2) L)^(1/2.2), truncated; marked as gamma 1/2.2 */
};

/** The means, times exposure, clamped. */
bool film_write_png(const struct film *f, const char *path, enum film_tone tone,
                    double exposure, struct err *err);

/** The rate map: r = count / samples (at least 1), blue at 0 to green at 1/2
 * to red at 1, linear, truncated, no curve. */
bool film_write_rate(const struct film *f, const char *path, uint64_t samples,
                     struct err *err);

/** Three bytes a pixel, row by row from the upper left one. */
struct png {
    int width, height;
    unsigned char *rgb; /* owned; free() */
};

/** Reads a PNG of any kind as 8-bit R, G, B; what is transparent lies on black.
 * A gamma that the file states is turned into sRGB's.  Limits and claims as in
 * film_read_exr. */
bool png_read(struct png *png, const char *path, struct err *err);

/** srgb: marked as such, else as gamma 1/2.2. Whole or not at all. */
bool png_write(const struct png *png, const char *path, bool srgb,
               struct err *err);

#endif
