/* diagnosis.h - what is probably wrong with a model that fails
 *
 * From how its numbers deviate from one another (clues.h), a library of
 * mistakes is tried: constant factors, cosines, Jacobians, squares of indices,
 * masking, roughnesses, swapped directions, lobes' probabilities, Fresnel at
 * another angle.  A mistake predicts the ratio in every clue; how much of the
 * logarithm's sum of squares it explains says how good it is.
 */
#ifndef VALIDATE_DIAGNOSIS_H
#define VALIDATE_DIAGNOSIS_H

#include "validate/subject.h"
#include "validate/verdict.h"

/** Fills the diagnosis of the verdicts that failed; there is one a check, in
 * the order of `checks`.  A verdict for which no mistake of the library
 * explains enough is told so. */
void diagnose(const struct subject *s, struct verdict *verdict);

#endif
