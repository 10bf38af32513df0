/* clues.h - where and how a model's numbers deviate from one another
 *
 * A clue is a direction of incidence with the ratio of two numbers that should
 * be equal there, and with the angles that a mistake may be a function of.
 */
#ifndef VALIDATE_CLUES_H
#define VALIDATE_CLUES_H

#include "validate/subject.h"

struct clue {
    double ratio;          /* 1 where nothing is wrong */
    struct vec3 wo, wi, m; /* m the normal of the facet that leads from wo to
                              wi */
    bool through;
    double cos_o, cos_i, cos_h, wo_h, wi_h; /* all positive */
    double eta2;                            /* (n_i / n_o)^2 */
    double jacobian;   /* d m / d wi [1], 1 / (4 wi.h) in reflection */
    double g1_o, g1_i; /* NaN where the model shows no facets */
    double share;      /* of the third random number for this lobe, or NaN */
    double det;        /* d wi / d u [sr], or NaN */
    double back;       /* pdf(wi, wo) */
    bool overlap;      /* another lobe on the same side */
};

enum clue_kind {
    CLUES_WEIGHT,      /* weight pdf / (f cos) of samples */
    CLUES_SAMPLE_PDF,  /* a sample's pdf / pdf() */
    CLUES_DENSITY,     /* pdf() / the density of samples, from Jacobians */
    CLUES_BINS,        /* mass / share of samples, of bins that expect some */
    CLUES_RECIPROCITY, /* f / f turned round, as energy */
    CLUES_FACETS       /* f 4 cos_o cos_i / D of the facets: F G */
};

enum { CLUES_MAX = 1024 };
struct clues {
    size_t n;
    struct clue clue[CLUES_MAX];
    /* What samples say of the facets of a model that shows none, or NULL;
     * borrowed. */
    const struct facets_fit *fit;
};

/** D(m) of the facets [1/sr]. */
typedef double facets_fn(const void *context, struct vec3 m);

/** Gathers the clues of a kind; d is what CLUES_FACETS divides by.  Clues whose
 * ratio is not a positive number are left out.  False when out of memory. */
bool clues_gather(const struct subject *s, enum clue_kind kind, facets_fn *d,
                  const void *context, struct clues *out);

#endif
