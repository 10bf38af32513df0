/* variant.h - a model with some of its settings others, and its albedo */
#ifndef PLOTS_VARIANT_H
#define PLOTS_VARIANT_H

#include <stdint.h>

#include "bsdf/bsdf.h"
#include "validate/estimate.h"

struct variant {
    const char *key, *value; /* NULL: without it */
};

/** Whether a model has a setting of this name. */
bool variant_has(const struct bsdf *b, const char *key);

/** The model with n settings changed; NULL and the reason if it cannot be made.
 * A warning is not passed on: the model itself has given it. */
struct bsdf *variant_new(const struct bsdf *b, const struct variant *v, int n,
                         struct err *err);

/** The albedo in each band by quadrature, as the energy check has it; false
 * when out of memory. */
bool variant_albedo(const struct bsdf *b, struct vec3 wo, uint64_t seed,
                    struct estimate albedo[BANDS_MAX], struct err *err);

/** Both the albedo and what of it is in no single direction. */
bool variant_energy(const struct bsdf *b, struct vec3 wo, uint64_t seed,
                    struct estimate albedo[BANDS_MAX],
                    struct estimate beside[BANDS_MAX], struct err *err);

/** The albedo from the mean weight of n samples, with its standard error, which
 * is quicker. */
void variant_weights(const struct bsdf *b, struct vec3 wo, uint64_t seed,
                     uint64_t n, struct estimate albedo[BANDS_MAX]);

#endif
