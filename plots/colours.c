/* colours.c - bands among the lines of a figure */
#include "plots/colours.h"

#include <stdbool.h>
#include <stdio.h>

/* From long waves to short ones. */
static const double line_from_nm[] = { 580, 490, 430, 0 };

static int line_of(double nm)
{
    int line = 0;
    while (nm < line_from_nm[line])
        line++;
    return line + 1;
}

int colours_line(const struct bands *bands, int band)
{
    if (bands->kind != BANDS_NM)
        return band + 1;
    bool clash = false;
    int rank = 0;
    for (int b = 0; b < bands->count; b++) {
        for (int k = 0; k < b; k++)
            clash |= line_of(bands->nm[b]) == line_of(bands->nm[k]);
        rank += bands->nm[b] > bands->nm[band] ||
                (bands->nm[b] == bands->nm[band] && b < band);
    }
    return clash ? rank + 1 : line_of(bands->nm[band]);
}

/* Of linear sRGB: the second row of the matrix of IEC 61966-2-1. */
static double share(const struct bands *bands, int band)
{
    static const double luminance[] = { 0.2126, 0.7152, 0.0722 };
    return bands->kind == BANDS_NM ? 1. / bands->count : luminance[band];
}

double colours_mean(const struct bands *bands, struct spectrum f)
{
    double sum = 0;
    for (int b = 0; b < bands->count; b++)
        sum += f.band[b] * share(bands, b);
    return sum;
}

const char *colours_mean_name(const struct bands *bands)
{
    return bands->kind != BANDS_NM ? "luminance 0.2126 R + 0.7152 G + 0.0722 B"
           : bands->count > 1      ? "mean of the bands"
                                   : "in the band";
}

void colours_mean_columns(const struct bands *bands, int first, char *text,
                          size_t size)
{
    size_t n = 0;
    for (int b = 0; b < bands->count && n < size; b++)
        n += (size_t)snprintf(text + n, size - n, "%s%.10g*$%d", b ? "+" : "",
                              share(bands, b), first + b);
}
