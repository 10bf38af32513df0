/* facets.h - which distribution of normals a density looks like
 *
 * Slopes of normals drawn with the density D cos_h are Beckmann's where
 * log(D cos_h^4) is linear in the squares of the slopes, and GGX's where the
 * root of 1 / (D cos_h^4) is.  The fit is linear either way.
 */
#ifndef VALIDATE_FACETS_H
#define VALIDATE_FACETS_H

#include "validate/clues.h"

struct facets_fit {
    const struct ndf *ndf;
    double alpha_u, alpha_v;
    double scale; /* the density that was fitted is so many times D */
    double off;   /* the largest relative deviation of its logarithm's fit */
    bool visible; /* fitted to the normals that wo sees */
};

/** Fits the densities of wi [1/sr] at n clues in reflection, whether normals
 * were drawn from all or from the visible ones; false where neither family is
 * within 2 %. */
bool facets_fit(const struct clue *clue, const double *density, size_t n,
                struct facets_fit *fit);

/** Fits D itself where the model shows it. */
bool facets_fit_shown(const struct subject *s, struct facets_fit *fit);

#endif
