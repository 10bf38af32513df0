/* film.c - room for a picture */
#include "integrator/film.h"

#include <stdlib.h>

bool film_size_ok(int64_t width, int64_t height)
{
    return width >= 1 && width <= FILM_SIDE_MAX && height >= 1 &&
           height <= FILM_SIDE_MAX && width * height <= FILM_PIXELS_MAX;
}

struct film *film_new(int width, int height, struct err *err)
{
    if (!film_size_ok(width, height)) {
        err_set(err,
                "a picture of %d x %d pixels: expected sides from 1 to %d and "
                "at most %d pixels",
                width, height, FILM_SIDE_MAX, FILM_PIXELS_MAX);
        return NULL;
    }
    struct film *f = malloc(sizeof *f);
    struct film_pixel *pixel =
        calloc((size_t)width * (size_t)height, sizeof *pixel);
    if (!f || !pixel) {
        free(f);
        free(pixel);
        err_set(err, "out of memory for a picture of %d x %d pixels", width,
                height);
        return NULL;
    }
    *f = (struct film){ .width = width, .height = height, .pixel = pixel };
    return f;
}

void film_free(struct film *f)
{
    if (!f)
        return;
    free(f->pixel);
    free(f);
}

double film_luminance(const float rgb[3])
{
    return film_luminance_of((double)rgb[0], (double)rgb[1], (double)rgb[2]);
}
