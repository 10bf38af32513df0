/* table.c - writing tables */
#include "plots/table.h"

#include <stdlib.h>
#include <string.h>

#include "bsdf/cli.h"

/* How many bytes at p are one printable character of UTF-8; 0 if none are.
 * Unicode 15, table 3-7; without controls and non-characters. */
static size_t character(const unsigned char *p)
{
    if (p[0] < 0x80)
        return p[0] >= 0x20 && p[0] != 0x7f;
    const size_t n = p[0] >= 0xf0 ? 4 : p[0] >= 0xe0 ? 3 : 2;
    static const unsigned long least[] = { 0, 0, 0xa0, 0x800, 0x10000 };
    unsigned long code = p[0] & (0x7fu >> n);
    if (p[0] < 0xc2 || p[0] > 0xf4)
        return 0;
    for (size_t i = 1; i < n; i++) {
        if ((p[i] & 0xc0) != 0x80) /* the final 0 as well */
            return 0;
        code = code << 6 | (p[i] & 0x3f);
    }
    const bool surrogate = code >= 0xd800 && code < 0xe000;
    const bool separator = code == 0x2028 || code == 0x2029;
    return code < least[n] || code > 0x10ffff || surrogate || separator ||
                   (code & 0xfffe) == 0xfffe
               ? 0
               : n;
}

char *table_plain(const char *text)
{
    char *plain = malloc(4 * strlen(text) + 1), *to = plain;
    if (!plain)
        return NULL;
    for (const unsigned char *p = (const unsigned char *)text; *p;) {
        const size_t n = character(p);
        if (n > 0)
            memcpy(to, p, n);
        else
            snprintf(to, 5, "\\x%02x", *p);
        to += n > 0 ? n : 4;
        p += n > 0 ? n : 1;
    }
    *to = '\0';
    return plain;
}

void table_comment(FILE *out, const char *what, const char *text)
{
    char *plain = table_plain(text);
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
