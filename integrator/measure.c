/* measure.c - sums over pixels */
#include "integrator/measure.h"

#include <math.h>

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static void add(struct measure *m, const struct film_pixel *p)
{
    if (p->count == 0)
        m->without++;
    for (int c = 0; c < 3; c++)
        m->mean[c] += (double)p->mean[c];
    m->luminance += film_luminance(p->mean);
    m->variance += (double)p->luminance_variance;
    m->samples += p->count;
    m->least = p->count < m->least ? p->count : m->least;
    m->most = p->count > m->most ? p->count : m->most;
}

bool measure_film(const struct film *f, int x, int y, int width, int height,
                  struct measure *m, struct err *err)
{
    if (x >= f->width || y >= f->height)
        return err_set(err,
                       "-p %d %d: the picture has %d x %d pixels, and none "
                       "there",
                       x, y, f->width, f->height);
    *m = (struct measure){ .x = x,
                           .y = y,
                           .width = f->width - x,
                           .height = f->height - y,
                           .least = UINT32_MAX };
    if (width > 0) {
        m->width = smaller(m->width, width);
        m->height = smaller(m->height, height);
    }
    for (int j = y; j < y + m->height; j++)
        for (int i = x; i < x + m->width; i++)
            add(m, &f->pixel[(size_t)j * (size_t)f->width + (size_t)i]);
    /* Where no pixel has samples the file does not tell. */
    const long all = (long)m->width * m->height;
    m->without = m->without == all ? 0 : m->without;
    const double n = (double)(all - m->without);
    for (int c = 0; c < 3; c++)
        m->mean[c] /= n;
    m->luminance /= n;
    m->error = sqrt(m->variance) / n;
    m->variance /= n;
    m->noise = m->luminance > 0 ? sqrt(m->variance) / m->luminance : NAN;
    m->samples /= n;
    return true;
}

static void line(FILE *out, const char *name, double value)
{
    if (isfinite(value))
        fprintf(out, "%s\t%.9g\n", name, value);
    else
        fprintf(out, "%s\tnan\n", name);
}

void measure_print(FILE *out, const struct measure *m)
{
    fprintf(out, "x\t%d\ny\t%d\nwidth\t%d\nheight\t%d\n", m->x, m->y, m->width,
            m->height);
    line(out, "R", m->mean[0]);
    line(out, "G", m->mean[1]);
    line(out, "B", m->mean[2]);
    line(out, "luminance", m->luminance);
    line(out, "luminance_error", m->error);
    line(out, "variance", m->variance);
    line(out, "noise", m->noise);
    line(out, "samples", m->samples);
    fprintf(out, "samples_least\t%u\nsamples_most\t%u\n", m->least, m->most);
    fprintf(out, "pixels_without_samples\t%ld\n", m->without);
}
