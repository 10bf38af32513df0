/* factors.h - the library of factors that a formula may have lost or doubled */
#ifndef VALIDATE_FACTORS_H
#define VALIDATE_FACTORS_H

#include "validate/clues.h"

struct factor {
    const char *name; /* "4 wi.h" */
    double (*at)(const struct clue *c);
    double (*back)(const struct clue *c); /* with wo and wi changing places */
};

/** The last has no name. */
extern const struct factor factors[];

/** How well predicted logarithms explain those of the ratios, where the clue
 * is in the scope: 1 less the share of the sum of squares that is left; at most
 * 1, and -infinity for a prediction that is no number. */
enum clue_scope { SCOPE_ALL, SCOPE_REFLECTION, SCOPE_TRANSMISSION };
double factors_explain(const struct clues *clues, enum clue_scope scope,
                       const double *predicted);

/** The same for any function of one angle, by what is left against the mean of
 * the neighbours in order of that angle. */
double factors_explain_by(const struct clues *clues, enum clue_scope scope,
                          double (*angle)(const struct clue *c));

bool clue_in(const struct clue *c, enum clue_scope scope);

#endif
