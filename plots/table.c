/* table.c - writing tables */
#include "plots/table.h"

#include <stdlib.h>
#include <string.h>

#include "bsdf/cli.h"
#include "bsdf/utf8.h"

void table_comment(FILE *out, const char *what, const char *text)
{
    char *plain = utf8_plain(text);
    fprintf(out, "# %s: %s\n", what, plain ? plain : "(out of memory)");
    free(plain);
}

void table_head(FILE *out, const struct bsdf *b, struct vec3 wo)
{
    char text[160];
    const struct angles a = dir_to_degrees(wo);
    table_comment(out, "made by", "bsdf-plot " BSDF_VERSION);
    table_comment(out, "spec", bsdf_spec(b));
    snprintf(text, sizeof text,
             "theta %.10g, phi %.10g deg, as a vector %.17g %.17g %.17g",
             a.theta_deg, a.phi_deg, wo.x, wo.y, wo.z);
    table_comment(out, "wo", text);
    bands_print(bsdf_bands(b), text, sizeof text);
    table_comment(out, "bands", text);
}

void table_columns(FILE *out, const struct bands *bands, const char *what)
{
    char name[32];
    for (int b = 0; b < bands->count; b++) {
        bands_print_one(bands, b, name, sizeof name);
        fprintf(out, "\t%s %s %s", what, bands->kind == BANDS_NM ? "at" : "in",
                name);
    }
}

void table_row(FILE *out, const double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (isnan(x[i]))
            fputs("nan", out);
        else
            fprintf(out, "%.17g", x[i]);
        fputc(i + 1 < n ? '\t' : '\n', out);
    }
}
