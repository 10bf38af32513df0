/* partition.h - the sphere cut into bins that fit a lobe
 *
 * The bins come from pilot directions: strips of equal pilot counts in theta,
 * each cut into bins of equal counts in phi.  Every bin is a patch of its own
 * graded mesh, so its mass can be integrated however narrow the lobe is.  The
 * upper and the lower hemisphere are cut apart; bins 0 .. upper-1 are above.
 */
#ifndef VALIDATE_PARTITION_H
#define VALIDATE_PARTITION_H

#include <stddef.h>

#include "validate/sphere.h"

enum { STRIPS = 20, SLICES = 20 };

struct partition;

/** From n pilot directions, unit vectors; may be none.  NULL when out of
 * memory.  Owned by the caller. */
struct partition *partition_new(const struct vec3 *pilot, size_t n);
void partition_free(struct partition *p); /* NULL is fine */

size_t partition_bins(const struct partition *p);

/** The bin that holds w, or the number of bins where w is not a direction. */
size_t partition_bin(const struct partition *p, struct vec3 w);

/** The direction in the middle of a bin's angles. */
struct vec3 partition_centre(const struct partition *p, size_t bin);

/** A coarser grouping of the bins, about five by four a hemisphere. */
size_t partition_coarse_bins(const struct partition *p);
size_t partition_coarse(const struct partition *p, size_t bin);

/** Integrates over each bin: out[bin * parts + part].  See patch_integrate.
 * The budget is for all bins together. */
void partition_integrate(const struct partition *p, sphere_fn *f,
                         const void *context, int parts, double tolerance,
                         long budget, struct estimate *out);

#endif
