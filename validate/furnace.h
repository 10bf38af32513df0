/* furnace.h - facets cover the surface, and what is seen of them too
 *
 *   int D(m) cos_m dm = 1,   G1(wo) int D(m) max(0, wo.m) dm = cos_o
 *
 * E. Heitz, Understanding the Masking-Shadowing Function in Microfacet-Based
 * BRDFs, JCGT 3(2), 2014, eq. 5, 14 and sec. 5.2.
 */
#ifndef VALIDATE_FURNACE_H
#define VALIDATE_FURNACE_H

#include "validate/subject.h"

/** The first integral, and the second over cos_o, of a model that shows its
 * facets, from above. */
struct furnace {
    struct estimate area, seen;
};
struct furnace furnace(const struct subject *s);

#endif
