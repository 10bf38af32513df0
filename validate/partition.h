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

#include <stdint.h>

#include "validate/sphere.h"

struct partition;

/** From n pilot directions, unit vectors; may be none.  Behind them m further
 * directions where the lobe goes on, which shape no bin but are hints for its
 * integral.  NULL when out of memory.  Owned by the caller. */
struct partition *partition_new(const struct vec3 *pilot, size_t n, size_t m);
void partition_free(struct partition *p); /* NULL is fine */

size_t partition_bins(const struct partition *p);

/** The bin that holds each of n directions, or the number of bins where it is
 * not a direction. */
void partition_find(const struct partition *p, size_t n, struct dirs w,
                    uint32_t *bin);

/** The angles that a bin spans. */
struct patch partition_patch(const struct partition *p, size_t bin);

/** Groupings of the bins: by strips and by slices, twenty a hemisphere with
 * pilots, and coarse, five by four. */
enum partition_grouping { PARTITION_THETA, PARTITION_PHI, PARTITION_COARSE };
size_t partition_groups(const struct partition *p, enum partition_grouping by);
size_t partition_group(const struct partition *p, enum partition_grouping by,
                       size_t bin);

/** Integrates over each bin: out[bin * parts + part].  See quadrature; the
 * pilots and the further directions are the hints.  f is asked about up to a
 * batch of directions at a time; the budget is for all bins together.  False
 * when out of memory. */
bool partition_integrate(const struct partition *p, sphere_fn *f,
                         const void *context, int parts, double tolerance,
                         size_t batch, long budget, struct estimate *out);

#endif
