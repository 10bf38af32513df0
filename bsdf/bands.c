/* bands.c - reading and naming wavelengths */
#include "bsdf/bands.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct bands bands_default = { 3, { 0 }, BANDS_RGB_FIT };
const struct bands bands_fixed = { 3, { 614, 549, 466 }, BANDS_NM };

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

bool bands_parse_rgb(struct bands *bands, const char *text, struct err *err)
{
    static const char fixed[] = "fixed:";
    struct bands read = { .count = 3 };
    if (strcmp(text, "fit") == 0) {
        read.kind = BANDS_RGB_FIT;
    } else if (strcmp(text, "average") == 0) {
        read.kind = BANDS_RGB_AVERAGE;
    } else if (strncmp(text, fixed, strlen(fixed)) == 0) {
        if (!bands_parse(&read, text + strlen(fixed), err))
            return false;
        if (read.count != 3)
            return err_set(err, "\"%.80s\" has %d wavelengths; expected three",
                           text, read.count);
    } else {
        return err_set(err,
                       "\"%.80s\" is no way to R, G, B: expected fit, average "
                       "or fixed:A,B,C in nm",
                       text);
    }
    *bands = read;
    return true;
}

void bands_print(const struct bands *bands, char *text, int size)
{
    int used = 0;
    if (bands->kind != BANDS_NM) {
        snprintf(text, (size_t)size, "R, G, B (%s)",
                 bands->kind == BANDS_RGB_FIT ? "fit" : "average");
        return;
    }
    for (int b = 0; b < bands->count && used < size; b++)
        used += snprintf(text + used, (size_t)(size - used), "%s%.12g",
                         b ? ", " : "", bands->nm[b]);
    if (used < size)
        snprintf(text + used, (size_t)(size - used), " nm");
}

void bands_print_one(const struct bands *bands, int band, char *text, int size)
{
    if (bands->kind == BANDS_NM)
        snprintf(text, (size_t)size, "%.10g nm", bands->nm[band]);
    else
        snprintf(text, (size_t)size, "%c", "RGB"[band]);
}
