/* metal.c - settling the index of a metal */
#include "bsdf/metal.h"

#include <stdlib.h>
#include <string.h>

#include "bsdf/colour.h"
#include "bsdf/ior.h"

/* R, G and B of a page; a warning stays in err. */
static bool colours(const char *material, const struct bands *bands,
                    struct spectrum *eta, struct spectrum *k, struct err *err)
{
    struct cie *cie = malloc(sizeof *cie);
    struct colour_report report;
    struct ior_page *page =
        cie && cie_load(cie, err) ? ior_find(material, NULL, err) : NULL;
    const bool ok =
        page && colour_conductor(cie, page,
                                 bands->kind == BANDS_RGB_FIT ? COLOUR_FIT
                                                              : COLOUR_AVERAGE,
                                 NULL, eta, k, &report, err);
    if (ok && report.warnings[0])
        err_set(err, "%s", report.warnings);
    if (!cie)
        err_set(err, "out of memory");
    ior_page_free(page);
    free(cie);
    return ok;
}

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
        struct err why = { "" };
        const bool found = bands->kind == BANDS_NM
                               ? ior_lookup(material, bands, eta, k, &why)
                               : colours(material, bands, eta, k, &why);
        if (!found || why.text[0])
            err_set(err, "%s: %s", model, why.text);
        if (!found)
            return false;
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
