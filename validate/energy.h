/* energy.h - the share of light that is not lost, three ways
 *
 * By quadrature of f (n_i / n_o)^2 |cos| over the sphere, deltas included; by
 * the mean weight of the survey's samples; and by directions that are uniform
 * on the sphere.
 */
#ifndef VALIDATE_ENERGY_H
#define VALIDATE_ENERGY_H

#include "validate/subject.h"

struct energy {
    struct estimate albedo[BANDS_MAX]; /* by quadrature */
    struct estimate beside[BANDS_MAX]; /* the part of it that is no delta */
    struct estimate unsampled; /* of the band with the most of it, where the pdf
                                  is 0 */
    struct estimate capped;    /* what the survey's cap of weights takes off, of
                                  the band with the most of it */
    struct mean weight[BANDS_MAX];  /* capped */
    struct mean uniform[BANDS_MAX]; /* against beside */
    double hits[BANDS_MAX]; /* effective number of uniform directions that meet
                               the lobe, (sum f)^2 / sum f^2, expected from the
                               survey */
};

/** The energy of a subject; computed when it is asked for first, and the
 * subject's.  NULL when out of memory. */
const struct energy *subject_energy(const struct subject *s);

#endif
