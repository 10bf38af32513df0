/* camera_file.c - thirty numbers */
#include "integrator/camera_file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NUMBERS = 30, NEEDED = 28 };

/* What is read where, in the file's order. */
enum { HFOV = 0, NEAR = 3, FAR = 4, POSITION = 5, ROTATION = 16, FOCUS = 28 };

static bool numbers(double *x, int *n, const char *path, struct err *err)
{
    FILE *in = fopen(path, "r");
    if (!in)
        return err_set(err, "%s: %s", path, strerror(errno));
    int got = 1;
    for (*n = 0; *n < NUMBERS && got == 1; *n += got == 1)
        got = fscanf(in, "%lf", &x[*n]);
    const bool junk = got == 0;
    char more[2];
    const bool long_one = *n == NUMBERS && fscanf(in, "%1s", more) == 1;
    fclose(in);
    if (long_one)
        return err_set(err,
                       "%s: expected the %d numbers of a camera, and "
                       "there is more",
                       path, NUMBERS);
    for (int i = 0; i < *n; i++)
        if (!isfinite(x[i]))
            return err_set(err, "%s: number %d of a camera is %g", path, i + 1,
                           x[i]);
    if (junk)
        return err_set(err, "%s: number %d of a camera: expected a number",
                       path, *n + 1);
    return *n >= NEEDED || err_set(err,
                                   "%s: %d numbers: expected the %d of a "
                                   "camera",
                                   path, *n, NUMBERS);
}

/* Rows and columns are at right angles and of length 1. */
static bool rotation(const double m[9])
{
    double off = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            double dot = i == k ? -1 : 0;
            for (int r = 0; r < 3; r++)
                dot += m[3 * r + i] * m[3 * r + k];
            off = fmax(off, fabs(dot));
        }
    return off < 1e-3; /* the file has six digits */
}

bool camera_file_read(struct camera *c, const char *path, struct err *err)
{
    double x[NUMBERS] = { 0 };
    int n = 0;
    if (!numbers(x, &n, path, err))
        return false;
    const double half = x[HFOV] * PI / 360;
    const double *m = x + ROTATION;
    if (!(half > 0 && half < PI / 2))
        return err_set(err, "%s: hFov %g: expected degrees in (0, 180)", path,
                       x[HFOV]);
    if (!(x[NEAR] >= 0 && x[FAR] > x[NEAR]))
        return err_set(err, "%s: near %g, far %g: expected 0 <= near < far",
                       path, x[NEAR], x[FAR]);
    if (!rotation(m))
        return err_set(err, "%s: its rotation (numbers %d to %d) is none", path,
                       ROTATION + 1, ROTATION + 9);
    for (int r = 0; r < 3; r++) {
        double *row = c->to_world.m[r];
        row[0] = -m[3 * r]; /* ours go to the left and into the scene */
        row[1] = m[3 * r + 1];
        row[2] = -m[3 * r + 2];
        row[3] = x[POSITION + r];
    }
    c->focal = c->width / 2.0 / tan(half);
    c->near = x[NEAR];
    c->far = x[FAR];
    if (n == NUMBERS) {
        c->focal_distance = x[FOCUS];
        c->lens_radius = x[FOCUS + 1];
    }
    return c->lens_radius >= 0 ||
           err_set(err, "%s: lens radius %g: expected 0 or more", path,
                   c->lens_radius);
}
