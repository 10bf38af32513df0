/* compare_png.h - how alike two 8-bit pictures are
 *
 * A PNG has lost what a test would need, so this is a measure, not a verdict:
 * means of blocks, by channel, made linear by L = v^2.2, and their ratios and
 * correlation.  Blocks in which a pixel is clipped (255) in either picture, or
 * whose mean is below 1e-3, are left out.  The lower left 48 x 5 pixels, where
 * some programs put their mark, are left out of every block.
 */
#ifndef INTEGRATOR_COMPARE_PNG_H
#define INTEGRATOR_COMPARE_PNG_H

#include <stdio.h>

#include "integrator/compare.h"

struct png_comparison {
    double alike;       /* share of pixels that differ by at most 2 of 255
                           in every channel */
    int blocks;         /* that were compared, of all channels */
    int clipped, dark;  /* that were left out */
    double median;      /* of the ratios B over A; NaN, as what follows, of
                           fewer than 3 blocks */
    double low, high;   /* their 5th and 95th percentile */
    double correlation; /* of the means, Pearson's */
};

/** Blocks of options->block pixels (0: 20). False and the reason where a file
 * cannot be read or sizes differ. */
bool compare_png(const char *a, const char *b,
                 const struct compare_options *options,
                 struct png_comparison *result, struct err *err);

void compare_png_print(FILE *out, const struct png_comparison *c);

#endif
