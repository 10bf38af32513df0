/* film_png.c - pictures in PNG files, by libpng's simplified interface
 *
 * IEC 61966-2-1:1999, Default RGB colour space - sRGB.
 */
#include "integrator/film.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "bsdf/colour.h"
#include "bsdf/outfile.h"

/* -- files ----------------------------------------------------------------- */

bool png_write(const struct png *png, const char *path, bool srgb,
               struct err *err)
{
    assert(film_size_ok(png->width, png->height));
    png_image image = {
        .version = PNG_IMAGE_VERSION,
        .width = (png_uint_32)png->width,
        .height = (png_uint_32)png->height,
        .format = PNG_FORMAT_RGB,
        .flags = srgb ? 0 : PNG_IMAGE_FLAG_COLORSPACE_NOT_sRGB,
    };
    struct outfile out;
    if (!outfile_open(&out, path, err))
        return false;
    errno = 0;
    if (png_image_write_to_stdio(&image, out.stream, 0, png->rgb, 0, NULL))
        return outfile_close(&out, err);
    err_set(err, "%s: cannot be written: %s", path,
            errno ? strerror(errno) : image.message);
    outfile_abandon(&out);
    return false;
}

/* Deflate makes 1032 bytes of one at the most, and a byte holds 8 pixels. */
static bool can_hold(FILE *file, int64_t pixels)
{
    struct stat st;
    return fstat(fileno(file), &st) == 0 && S_ISREG(st.st_mode) &&
           pixels / (8 * 1032) <= st.st_size;
}

static bool read_image(struct png *png, png_image *image, FILE *file,
                       const char *path, struct err *err)
{
    if (!png_image_begin_read_from_stdio(image, file))
        return err_set(err, "%s: %s", path, image->message);
    if (!film_size_ok(image->width, image->height))
        return err_set(err,
                       "%s: claims %u x %u pixels, expected sides from 1 to %d "
                       "and at most %d pixels",
                       path, image->width, image->height, FILM_SIDE_MAX,
                       FILM_PIXELS_MAX);
    if (!can_hold(file, (int64_t)image->width * image->height))
        return err_set(err,
                       "%s: claims %u x %u pixels, more than a file of its "
                       "size can hold",
                       path, image->width, image->height);
    image->format = PNG_FORMAT_RGB;
    png->width = (int)image->width;
    png->height = (int)image->height;
    png->rgb = calloc(PNG_IMAGE_SIZE(*image), 1);
    if (!png->rgb)
        return err_set(err, "out of memory");
    const png_color black = { 0 };
    if (!png_image_finish_read(image, &black, png->rgb, 0, NULL))
        return err_set(err, "%s: %s", path, image->message);
    return true;
}

bool png_read(struct png *png, const char *path, struct err *err)
{
    *png = (struct png){ 0 };
    FILE *file = fopen(path, "rbe");
    if (!file)
        return err_set(err, "%s: cannot be read: %s", path, strerror(errno));
    png_image image = { .version = PNG_IMAGE_VERSION };
    const bool ok = read_image(png, &image, file, path, err);
    png_image_free(&image);
    fclose(file);
    if (!ok) {
        free(png->rgb);
        *png = (struct png){ 0 };
    }
    return ok;
}

/* -- films ----------------------------------------------------------------- */

struct tone {
    enum film_tone curve;
    double exposure;
};

/* A NaN is none of these; see write_pixels. */
static unsigned char encode(double linear, const struct tone *t)
{
    const double x = linear * t->exposure;
    if (t->curve == FILM_SRGB)
        return (unsigned char)floor(255 * colour_srgb_encode(x) + 0.5);
    const double y = x > 0 ? pow(sqrt(2) * x, 1 / 2.2) : 0;
    return (unsigned char)(255 * (y < 1 ? y : 1));
}

static void tone_pixel(unsigned char rgb[3], const struct film_pixel *p,
                       const void *tone)
{
    for (int c = 0; c < 3; c++)
        rgb[c] = encode((double)p->mean[c], tone);
}

static void rate_pixel(unsigned char rgb[3], const struct film_pixel *p,
                       const void *samples)
{
    const double r = fmin(1, p->count / (double)*(const uint64_t *)samples);
    const double green = r < 0.5 ? 2 * r : 2 * (1 - r);
    rgb[0] = (unsigned char)(255 * (r < 0.5 ? 0 : 1 - green));
    rgb[1] = (unsigned char)(255 * green);
    rgb[2] = (unsigned char)(255 * (r < 0.5 ? 1 - green : 0));
}

static bool is_nan(const struct film_pixel *p)
{
    return isnan(p->mean[0]) || isnan(p->mean[1]) || isnan(p->mean[2]);
}

static bool write_pixels(const struct film *f, const char *path, bool srgb,
                         void (*paint)(unsigned char *,
                                       const struct film_pixel *, const void *),
                         const void *context, struct err *err)
{
    static const unsigned char magenta[3] = { 255, 0, 255 };
    const size_t n = (size_t)f->width * (size_t)f->height;
    struct png png = { f->width, f->height, malloc(3 * n) };
    if (!png.rgb)
        return err_set(err, "out of memory");
    for (size_t i = 0; i < n; i++) {
        if (is_nan(&f->pixel[i]))
            memcpy(png.rgb + 3 * i, magenta, 3);
        else
            paint(png.rgb + 3 * i, &f->pixel[i], context);
    }
    const bool ok = png_write(&png, path, srgb, err);
    free(png.rgb);
    return ok;
}

bool film_write_png(const struct film *f, const char *path, enum film_tone tone,
                    double exposure, struct err *err)
{
    const struct tone t = { tone, exposure };
    return write_pixels(f, path, tone == FILM_SRGB, tone_pixel, &t, err);
}

bool film_write_rate(const struct film *f, const char *path, uint64_t samples,
                     struct err *err)
{
    assert(samples >= 1);
    return write_pixels(f, path, false, rate_pixel, &samples, err);
}
