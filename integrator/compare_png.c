/* compare_png.c - means of blocks */
#include "integrator/compare_png.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double darkest = 1e-3;
enum { MARK_WIDTH = 48, MARK_HEIGHT = 5, BLOCK = 20 };

struct block {
    double sum[2];
    int pixels;
    bool clipped;
};

static bool in_mark(const struct png *p, int x, int y)
{
    return x < MARK_WIDTH && y >= p->height - MARK_HEIGHT;
}

static struct block block_at(const struct png *pair[2], int x0, int y0,
                             int side, int channel)
{
    struct block out = { .pixels = 0 };
    for (int y = y0; y < y0 + side && y < pair[0]->height; y++)
        for (int x = x0; x < x0 + side && x < pair[0]->width; x++) {
            if (in_mark(pair[0], x, y))
                continue;
            const size_t at =
                3 * ((size_t)y * (size_t)pair[0]->width + (size_t)x) +
                (size_t)channel;
            out.pixels++;
            for (int i = 0; i < 2; i++) {
                const int v = pair[i]->rgb[at];
                out.sum[i] += pow(v / 255.0, 2.2);
                out.clipped |= v == 255;
            }
        }
    return out;
}

/* Fills the blocks' means, n of them, and counts the others. */
static size_t means(const struct png *pair[2], int side, double *a, double *b,
                    struct png_comparison *c)
{
    size_t n = 0;
    for (int y = 0; y < pair[0]->height; y += side)
        for (int x = 0; x < pair[0]->width; x += side)
            for (int channel = 0; channel < 3; channel++) {
                const struct block k = block_at(pair, x, y, side, channel);
                if (k.pixels == 0)
                    continue;
                const double first = k.sum[0] / k.pixels;
                const double second = k.sum[1] / k.pixels;
                c->clipped += k.clipped;
                if (k.clipped)
                    continue;
                const bool dark = first < darkest || second < darkest;
                c->dark += dark;
                if (dark)
                    continue;
                a[n] = first;
                b[n++] = second;
            }
    return n;
}

/* Apart from the mark. */
static double alike(const struct png *pair[2])
{
    const struct png *a = pair[0], *b = pair[1];
    size_t same = 0, n = 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            const size_t at = 3 * ((size_t)y * (size_t)a->width + (size_t)x);
            int most = 0;
            for (size_t c = at; c < at + 3; c++) {
                const int off = abs(a->rgb[c] - b->rgb[c]);
                most = off > most ? off : most;
            }
            n += !in_mark(a, x, y);
            same += !in_mark(a, x, y) && most <= 2;
        }
    return n > 0 ? (double)same / (double)n : NAN;
}

static bool measure(const struct png *pair[2], int side,
                    struct png_comparison *c, struct err *err)
{
    const size_t across = (size_t)((pair[0]->width + side - 1) / side);
    const size_t down = (size_t)((pair[0]->height + side - 1) / side);
    const size_t room = 3 * across * down;
    double *a = malloc(3 * room * sizeof *a);
    if (!a)
        return err_set(err, "out of memory");
    double *b = a + room, *ratio = b + room;
    const size_t n = means(pair, side, a, b, c);
    c->blocks = (int)n;
    c->median = c->low = c->high = c->correlation = NAN;
    for (size_t i = 0; i < n; i++)
        ratio[i] = b[i] / a[i];
    gsl_sort(ratio, 1, n);
    if (n >= 3) {
        c->median = gsl_stats_median_from_sorted_data(ratio, 1, n);
        c->low = gsl_stats_quantile_from_sorted_data(ratio, 1, n, 0.05);
        c->high = gsl_stats_quantile_from_sorted_data(ratio, 1, n, 0.95);
        c->correlation = gsl_stats_correlation(a, 1, b, 1, n);
    }
    free(a);
    c->alike = alike(pair);
    return true;
}

bool compare_png(const char *a, const char *b,
                 const struct compare_options *options,
                 struct png_comparison *result, struct err *err)
{
    struct png first = { .rgb = NULL }, second = { .rgb = NULL };
    const int side = options->block > 0 ? options->block : BLOCK;
    const struct png *pair[] = { &first, &second };
    *result = (struct png_comparison){ .blocks = 0 };
    bool ok = png_read(&first, a, err) && png_read(&second, b, err);
    if (ok && (first.width != second.width || first.height != second.height))
        ok =
            err_set(err, "%s is %d x %d, %s %d x %d: expected the same size", a,
                    first.width, first.height, b, second.width, second.height);
    ok = ok && measure(pair, side, result, err);
    free(first.rgb);
    free(second.rgb);
    return ok;
}

void compare_png_print(FILE *out, const struct png_comparison *c)
{
    fprintf(out,
            "blocks %d, left out %d clipped and %d dark\n"
            "ratio of B to A: median %.4f, 5 to 95 %%: %.4f to %.4f\n"
            "correlation %.5f\n"
            "pixels within 2 of 255: %.4f %%\n",
            c->blocks, c->clipped, c->dark, c->median, c->low, c->high,
            c->correlation, 100 * c->alike);
}
