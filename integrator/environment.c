/* environment.c - pixels of equal azimuth, sampled by luminance
 *
 * A pixel fills dphi (cos theta_0 - cos theta_1) of the sphere, so uniform
 * numbers in phi and cos theta are uniform on it.
 */
#include "integrator/environment.h"

#include <gsl/gsl_histogram2d.h>
#include <math.h>
#include <stdlib.h>

struct environment {
    int width, height;
    struct spectrum *radiance; /* row by row */
    gsl_histogram2d *power;    /* by phi and cos theta, luminance times angle */
    gsl_histogram2d_pdf *pdf;
    double total;
};

static double theta_edge(const struct environment *e, int row)
{
    return PI * row / e->height;
}

static double phi_edge(const struct environment *e, int column)
{
    return 2 * PI * column / e->width;
}

static double luminance(struct spectrum s)
{
    return film_luminance_of(s.band[0], s.band[1], s.band[2]);
}

/* The edges of the histogram's bins, which rise: rows from below. */
static gsl_histogram2d *bins(const struct environment *e)
{
    gsl_histogram2d *h =
        gsl_histogram2d_alloc((size_t)e->width, (size_t)e->height);
    for (int x = 0; h && x <= e->width; x++)
        h->xrange[x] = phi_edge(e, x);
    for (int y = 0; h && y <= e->height; y++)
        h->yrange[y] = cos(theta_edge(e, e->height - y));
    return h;
}

static bool fill(struct environment *e, const struct film *f, const char *name,
                 struct err *err)
{
    for (int y = 0; y < e->height; y++) {
        const double angle =
            2 * PI / e->width *
            (cos(theta_edge(e, y)) - cos(theta_edge(e, y + 1)));
        for (int x = 0; x < e->width; x++) {
            const size_t i = (size_t)y * (size_t)e->width + (size_t)x;
            struct spectrum s = { { 0 } };
            for (int b = 0; b < 3; b++) {
                s.band[b] = (double)f->pixel[i].mean[b];
                if (!(s.band[b] >= 0 && isfinite(s.band[b])))
                    return err_set(err,
                                   "%s: pixel %d, %d is %g: expected radiance "
                                   "of at least 0",
                                   name, x, y, s.band[b]);
            }
            e->radiance[i] = s;
            const double power = luminance(s) * angle;
            e->power->bin[(size_t)x * (size_t)e->height +
                          (size_t)(e->height - 1 - y)] = power;
            e->total += power;
        }
    }
    return e->total > 0 || err_set(err, "%s: it is black", name);
}

struct environment *environment_new(const struct film *f, const char *name,
                                    struct err *err)
{
    const size_t n = (size_t)f->width * (size_t)f->height;
    struct environment *e = calloc(1, sizeof *e);
    if (e) {
        e->width = f->width;
        e->height = f->height;
        e->radiance = malloc(n * sizeof *e->radiance);
        e->power = bins(e);
        e->pdf = gsl_histogram2d_pdf_alloc((size_t)e->width, (size_t)e->height);
    }
    if (!e || !e->radiance || !e->power || !e->pdf) {
        err_set(err, "%s: out of memory", name);
        goto fail;
    }
    if (!fill(e, f, name, err))
        goto fail;
    gsl_histogram2d_pdf_init(e->pdf, e->power);
    return e;
fail:
    environment_free(e);
    return NULL;
}

void environment_free(struct environment *e)
{
    if (!e)
        return;
    if (e->pdf)
        gsl_histogram2d_pdf_free(e->pdf);
    if (e->power)
        gsl_histogram2d_free(e->power);
    free(e->radiance);
    free(e);
}

struct spectrum environment_radiance(const struct environment *e,
                                     struct vec3 dir)
{
    const double theta = acos(fmax(-1, fmin(1, dir.y)));
    const double phi = atan2(-dir.z, dir.x) + PI;
    int x = (int)(phi / (2 * PI) * e->width);
    int y = (int)(theta / PI * e->height);
    x = x < e->width ? x : e->width - 1;
    y = y < e->height ? y : e->height - 1;
    return e->radiance[(size_t)y * (size_t)e->width + (size_t)x];
}

struct vec3 environment_sample(const struct environment *e, double u, double v,
                               double *pdf)
{
    double phi = 0, y = 0;
    gsl_histogram2d_pdf_sample(e->pdf, u, v, &phi, &y);
    const double r = sqrt(fmax(0, 1 - y * y));
    const struct vec3 dir = { r * cos(phi - PI), y, -r * sin(phi - PI) };
    *pdf = environment_pdf(e, dir);
    return dir;
}

double environment_pdf(const struct environment *e, struct vec3 dir)
{
    return luminance(environment_radiance(e, dir)) / e->total;
}
