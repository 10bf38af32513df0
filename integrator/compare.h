/* compare.h - are two pictures estimates of the same one?
 *
 * Blocks of pixels are compared by Welch's t from their means and the pixels'
 * variances; the blocks' p-values go through Holm's procedure, so that the
 * significance holds for the whole picture.  A pixel's variance of the mean is
 * what its samples say; where few samples carry most of the light that is too
 * little, which is why blocks, not pixels, are compared.
 *
 * B. L. Welch, The generalization of "Student's" problem when several different
 * population variances are involved, Biometrika 34, 1947.
 */
#ifndef INTEGRATOR_COMPARE_H
#define INTEGRATOR_COMPARE_H

#include "integrator/film.h"

struct compare_options {
    int block;           /* side [pixels]; 0 for 20 */
    double significance; /* of the whole picture; 0 for 1e-6 */
};

struct comparison {
    int blocks;        /* that were compared, of all channels */
    double p;          /* the smallest, after Holm */
    bool same;         /* p above the significance */
    int x, y, channel; /* upper left pixel of the block where */
    double z;          /* there: the difference in standard errors */
    double ratio;      /* of the pictures' means, B over A */
    double bias;       /* the smallest relative bias of the whole picture that
                          would have been found with 99 % power */
    double block_bias; /* the same of a typical block */
};

/** Compares; if map is not NULL it is filled with z by block, owned by the
 * caller.  False and the reason where sizes differ or variances are missing. */
bool compare_films(const struct film *a, const struct film *b,
                   const struct compare_options *options,
                   struct comparison *result, struct film **map,
                   struct err *err);

/** A map of z: blue where B is darker, white where equal, red where brighter;
 * full colour at 6 standard errors. */
bool compare_write_map(const struct film *map, const char *path,
                       struct err *err);

#endif
