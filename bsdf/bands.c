/* bands.c - reading and naming wavelengths */
#include "bsdf/bands.h"

#include <stdio.h>
#include <stdlib.h>

const struct bands bands_default = { 3, { 614, 549, 466 } };

bool bands_parse(struct bands *bands, const char *text, struct err *err)
{
    struct bands read = { 0 };
    for (const char *at = text;; at++) {
        char *end;
        const double nm = strtod(at, &end);
        if (end == at || (*end != ',' && *end != '\0'))
            return err_set(err,
                           "wavelengths \"%.80s\": expected numbers in nm "
                           "separated by commas, as in 614,549,466",
                           text);
        if (!(nm > 0 && nm <= 1e9))
            return err_set(err,
                           "wavelength %g nm in \"%.80s\": expected a value "
                           "in (0, 1e9]",
                           nm, text);
        if (read.count == BANDS_MAX)
            return err_set(err, "wavelengths \"%.80s\": expected at most %d",
                           text, BANDS_MAX);
        read.nm[read.count++] = nm;
        if (*end == '\0')
            break;
        at = end;
    }
    *bands = read;
    return true;
}

void bands_print(const struct bands *bands, char *text, int size)
{
    int used = 0;
    for (int b = 0; b < bands->count && used < size; b++)
        used += snprintf(text + used, (size_t)(size - used), "%s%.12g",
                         b ? ", " : "", bands->nm[b]);
    if (used < size)
        snprintf(text + used, (size_t)(size - used), " nm");
}
