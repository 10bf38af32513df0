/* partition.h - the sphere cut into bins that fit a lobe
 *
 * The bins come from pilot directions: strips of equal pilot counts in theta,
 * each cut into slices of equal counts in phi, and beyond the outermost
 * quantiles strips and slices that double in width up to the horizon.  So the
 * lobe's bins are about equally full, a peak is resolved however narrow it is,
 * and far from it there are bins that expect nearly nothing, where a few
 * samples gone astray are seen.  The hemispheres are cut apart.
 */
#ifndef VALIDATE_PARTITION_H
#define VALIDATE_PARTITION_H

#include "validate/sphere.h"

struct partition;

/** From n pilot directions, unit vectors; may be none.  NULL when out of
 * memory.  Owned by the caller. */
struct partition *partition_new(const struct vec3 *pilot, size_t n);
void partition_free(struct partition *p); /* NULL is fine */

size_t partition_bins(const struct partition *p);

/** The bin that holds w, or the number of bins where w is not a direction. */
size_t partition_bin(const struct partition *p, struct vec3 w);

/** The angles that a bin spans. */
struct patch partition_patch(const struct partition *p, size_t bin);

/** A coarser grouping of the bins, five by four a hemisphere with pilots. */
size_t partition_coarse_bins(const struct partition *p);
size_t partition_coarse(const struct partition *p, size_t bin);

/** Integrates over each bin: out[bin * parts + part].  See quadrature; the
 * pilots are the hints.  The budget is for all bins together. */
void partition_integrate(const struct partition *p, sphere_fn *f,
                         const void *context, int parts, double tolerance,
                         long budget, struct estimate *out);

/** One bin again, with n other directions in it as hints. */
void partition_integrate_bin(const struct partition *p, size_t bin,
                             sphere_fn *f, const void *context, int parts,
                             double tolerance, long *budget,
                             const struct vec3 *hint, size_t n,
                             struct estimate *out);

#endif
