/* compare.h - are two pictures estimates of the same one?
 *
 * Blocks of pixels, and the picture as a whole, are compared channel by channel
 * from their means and the pixels' variances, by Welch's t; all their p-values
 * go through Holm's procedure, so that the significance holds for the whole
 * picture, however the blocks depend on each other.
 *
 * Where few samples carry most of the light a pixel's variance says too little,
 * which is why blocks, not pixels, are compared.  Even a block may lack the
 * rare samples, and be darker and smoother than it has a right to.  Three
 * things are done about it:
 *
 *   - The standard error of a difference is the larger one of Welch's and of
 *     the pooled one, which takes the variance of a sample to be the same in
 *     both pictures.  For as many samples a pixel the two are one; the pooled
 *     one costs power where the picture of many samples is also the noisier.
 *   - The degrees of freedom are no more than half the pixels that carry the
 *     variance, (sum v)^2 / sum(v^2), less one.
 *   - By the same count over the whole picture, with variances relative to the
 *     squared mean around, a block has 16 such pixels on average: unless its
 *     side is asked for, it is doubled from 20 until it has.  Where it has
 *     not even so, pictures are not called different but unsure.
 *
 * Measured over 2000 pairs of 40 x 40 pixels each, at a significance of .05
 * (tests/test_compare.c has the same with fewer): equal pictures were called
 * different in
 *
 *   .049  exponential samples, 16 a pixel;  .039  8 against 64
 *   .010  a tenth of the light in every 500th sample, 16;  .003  8 against 64
 *   .028  samples without a fourth moment, 16;  .015  8 against 64
 *   .042  steady samples against every 500th, 32
 *
 * and a stated bias of 1.03 % was found in .991 of the cases, half of it in
 * .43.  By Welch's error alone equal pictures of 8 and 64 samples were called
 * different in .36 (lognormal), .14 (every 1000th sample) and .32 (Pareto) of
 * 400 cases, in blocks of 6.
 *
 * The samples of a pixel are taken to be independent; stratified ones vary less
 * than their variance says, and are called different less often.
 *
 * B. L. Welch, The generalization of "Student's" problem when several different
 * population variances are involved, Biometrika 34, 1947.
 * S. Holm, A simple sequentially rejective multiple test procedure,
 * Scandinavian Journal of Statistics 6, 1979.
 */
#ifndef INTEGRATOR_COMPARE_H
#define INTEGRATOR_COMPARE_H

#include <stdio.h>

#include "integrator/film.h"

struct compare_options {
    int block; /* side [pixels], less at the border; 0 for 20 or more */
    double significance; /* of the whole picture; 0 for 1e-6 */
};

struct comparison {
    bool same;           /* p above the significance, and no bad pixel */
    int tests;           /* blocks and the whole picture, by three channels */
    int different;       /* of them, by Holm */
    int block;           /* side [pixels] */
    double carriers;     /* pixels of a block that carry its variance */
    double p;            /* the smallest, after Holm */
    double significance; /* as it was asked for */

    /* The pixels and the channel (0 to 2) where p is the smallest. */
    int x, y, width, height, channel;
    double z; /* there: B less A in standard errors; infinite without spread */

    double ratio; /* of the pictures' mean luminances, B over A; NaN of none */
    double variance_ratio; /* of a pixel's luminance, on average; likewise */

    /* The smallest share by which B could be brighter than A throughout, and
     * would have been called different 99 times of 100; and by which a typical
     * block alone could (the median).  Blocks without noise, as on a lamp, do
     * not count.  Infinite where nothing would. */
    double bias, block_bias;

    /* Pixels with a number that is not finite, or a variance below 0, in
     * either picture: the first is then x, y, channel. */
    long bad;
};

/** Compares; if map is not NULL it is given a film of the pictures' size, owned
 * by the caller, whose means are z of the pixel's block; NaN where it has a bad
 * pixel.  False and the reason where sizes differ, or a pixel has fewer than
 * two samples, and so no variance. */
bool compare_films(const struct film *a, const struct film *b,
                   const struct compare_options *options,
                   struct comparison *result, struct film **map,
                   struct err *err);

/** What came out, in a few lines. */
void compare_print(FILE *out, const struct comparison *c);

/** The same as lines of a name, a tab and a number. */
void compare_print_numbers(FILE *out, const struct comparison *c);

/** A map of z as PNG, of the channel that differs most: blue where B is darker,
 * white where equal, red where brighter; full colour at 6 standard errors. */
bool compare_write_map(const struct film *map, const char *path,
                       struct err *err);

#endif
