/* medium.c - settling the index of an interface */
#include <stdlib.h>
#include <string.h>

#include "bsdf/ior.h"
#include "bsdf/medium.h"

static const double d_line_nm = 589.3;

/* Mitsuba 3's presets, include/mitsuba/render/ior.h. */
static const struct {
    const char *name;
    double index;
} preset[] = {
    { "vacuum", 1.0 },
    { "helium", 1.000036 },
    { "hydrogen", 1.000132 },
    { "air", 1.000277 },
    { "carbon dioxide", 1.00045 },
    { "water", 1.3330 },
    { "acetone", 1.36 },
    { "ethanol", 1.361 },
    { "carbon tetrachloride", 1.461 },
    { "glycerol", 1.4729 },
    { "benzene", 1.501 },
    { "silicone oil", 1.52045 },
    { "bromine", 1.661 },
    { "water ice", 1.31 },
    { "fused quartz", 1.458 },
    { "pyrex", 1.470 },
    { "acrylic glass", 1.49 },
    { "polypropylene", 1.49 },
    { "bk7", 1.5046 },
    { "sodium chloride", 1.544 },
    { "amber", 1.55 },
    { "pet", 1.5750 },
    { "diamond", 2.419 },
};

static bool index_of(const char *model, const char *key, const char *name,
                     const struct bands *bands, double *index, struct err *err)
{
    char *end;
    *index = strtod(name, &end);
    bool found = end != name && *end == '\0';
    for (size_t i = 0; !found && i < sizeof preset / sizeof *preset; i++)
        if (strcmp(name, preset[i].name) == 0) {
            *index = preset[i].index;
            found = true;
        }
    if (!found) {
        const struct bands one = {
            1, { bands->count == 1 ? bands->nm[0] : d_line_nm }
        };
        struct spectrum n;
        struct err why;
        if (!ior_lookup(name, &one, &n, NULL, &why))
            return err_set(err, "%s: %s=%.60s: %s", model, key, name, why.text);
        *index = n.band[0];
    }
    return (*index >= 0.1 && *index <= 100) ||
           err_set(err, "%s: %s = %g is outside [0.1, 100]", model, key,
                   *index);
}

bool medium_settle(const char *model, const char *int_ior, const char *ext_ior,
                   const struct bands *bands, double *eta, struct err *err)
{
    double below, above;
    if (!index_of(model, "int_ior", int_ior, bands, &below, err) ||
        !index_of(model, "ext_ior", ext_ior, bands, &above, err))
        return false;
    *eta = below / above;
    return true;
}
