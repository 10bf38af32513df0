/* metal.c - settling the index of a metal */
#include "bsdf/metal.h"

#include <string.h>

#include "bsdf/ior.h"

bool metal_settle(const char *model, const char *material, struct spectrum *eta,
                  struct spectrum *k, const struct bands *bands,
                  struct err *err)
{
    const bool has_eta = !isnan(eta->band[0]), has_k = !isnan(k->band[0]);
    if (has_eta != has_k)
        return err_set(err, "%s: %s is given without %s; expected both", model,
                       has_eta ? "eta" : "k", has_eta ? "k" : "eta");
    if (has_eta && material)
        return err_set(err,
                       "%s: expected either material or eta and k, not "
                       "both",
                       model);
    if (!has_eta && material && strcmp(material, "none") != 0) {
        struct err why;
        if (!ior_lookup(material, bands, eta, k, &why))
            return err_set(err, "%s: %s", model, why.text);
    } else if (!has_eta) {
        *eta = spectrum_of(bands->count, 0);
        *k = spectrum_of(bands->count, 1);
    }
    for (int b = 0; b < bands->count; b++)
        if (!(eta->band[b] + k->band[b] > 0))
            return err_set(err,
                           "%s: eta = k = 0 in band %d; expected at "
                           "least one above 0",
                           model, b + 1);
    return true;
}
