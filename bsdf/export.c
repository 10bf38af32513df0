/* export.c - text for other programs */
#include "bsdf/export.h"

#include <math.h>

#include "bsdf/fresnel.h"

const char *const export_names[] = { "mitsuba", "pbrt", "openpbr-f82", "cpp",
                                     NULL };

static const double step_nm = 5;

/* "NM SEPARATOR VALUE" every 5 nm of what the page has between 360 and 830. */
static bool pairs(FILE *out, const struct export *e, bool of_k,
                  const char *between, const char *after, struct err *err)
{
    double low, high;
    ior_page_range(e->page, &low, &high);
    const int first = (int)ceil(fmax(low, 360) / step_nm);
    const int last = (int)floor(fmin(high, 830) / step_nm);
    for (int i = first; i <= last; i++) {
        const double nm = i * step_nm;
        double n, k;
        if (!ior_page_at(e->page, nm, &n, &k, err))
            return false;
        fprintf(out, "%s%g%s%.6g", i > first ? after : "", nm, between,
                of_k ? k : n);
    }
    return true;
}

static bool mitsuba(FILE *out, const struct export *e, struct err *err)
{
    fprintf(out,
            "<!-- %s -->\n<bsdf type=\"conductor\">\n"
            "    <spectrum name=\"eta\" value=\"",
            e->name);
    if (!pairs(out, e, false, ":", ", ", err))
        return false;
    fprintf(out, "\"/>\n    <spectrum name=\"k\" value=\"");
    if (!pairs(out, e, true, ":", ", ", err))
        return false;
    fprintf(out, "\"/>\n</bsdf>\n");
    return true;
}

static bool pbrt(FILE *out, const struct export *e, struct err *err)
{
    fprintf(out, "# %s\nMaterial \"conductor\"\n    \"spectrum eta\" [ ",
            e->name);
    if (!pairs(out, e, false, " ", "  ", err))
        return false;
    fprintf(out, " ]\n    \"spectrum k\" [ ");
    if (!pairs(out, e, true, " ", "  ", err))
        return false;
    fprintf(out, " ]\n    \"float roughness\" [ 0 ]\n");
    return true;
}

static void triple(FILE *out, const char *before, struct spectrum s,
                   const char *after)
{
    fprintf(out, "%s%.6g, %.6g, %.6g%s", before, s.band[0], s.band[1],
            s.band[2], after);
}

static void openpbr(FILE *out, const struct export *e)
{
    const double edge = 1. / 7;
    const struct spectrum f0 = colour_metal_rgb(e->metal, 1);
    struct spectrum tint = colour_metal_rgb(e->metal, edge);
    bool inside = true;
    for (int b = 0; b < 3; b++) {
        tint.band[b] /= fresnel_schlick(edge, f0.band[b]);
        inside &= f0.band[b] >= 0 && f0.band[b] <= 1 && tint.band[b] <= 1;
    }
    fprintf(out, "# %s, linear sRGB, reflectance under D65%s\n", e->name,
            inside ? "" : "; not in [0, 1], left as it is");
    fprintf(out, "base_metalness = 1\n");
    triple(out, "base_color = ", f0, "\n");
    triple(out, "specular_color = ", tint, "\n");
}

static void cpp(FILE *out, const struct export *e)
{
    fprintf(out, "// %s, %s\n", e->name, e->method);
    triple(out, "constexpr double eta[3] = { ", e->eta, " };\n");
    triple(out, "constexpr double k[3] = { ", e->k, " };\n");
}

bool export_write(FILE *out, enum export_format format, const struct export *e,
                  struct err *err)
{
    switch (format) {
    case EXPORT_MITSUBA:
        return mitsuba(out, e, err);
    case EXPORT_PBRT:
        return pbrt(out, e, err);
    case EXPORT_OPENPBR_F82:
        openpbr(out, e);
        return true;
    case EXPORT_CPP:
        cpp(out, e);
        return true;
    }
    return false;
}
