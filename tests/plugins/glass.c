/* glass.c - a smooth interface as a path from a light sees it, as a plugin
 *
 * Fresnel's equations; transmission is not scaled by the indices, which `said`
 * tells the toolkit or not.
 */
#include <math.h>

#include "bsdf/plugin.h"

enum { ETA, SAID };

static const struct bsdf_plugin_param params[] = {
    { "eta", NAN, 1, 4, "index below over that above" },
    { "said", 1, 0, 1, "whether it says that light comes from wo" },
    { 0 },
};

static void claims(const void *state, struct bsdf_plugin_claims *c)
{
    const double *m = state;
    c->lobes = BSDF_PLUGIN_DELTA_REFLECTION | BSDF_PLUGIN_DELTA_TRANSMISSION;
    c->lossless = c->two_sided = 1;
    c->eta = m[ETA];
    c->given_wi = m[SAID] == 1;
}

static void nothing(const void *state, int bands, size_t n, const double *in,
                    double *out)
{
    (void)state, (void)bands, (void)n, (void)in, (void)out;
}

static void sample(const void *state, int bands, size_t n, const double *in,
                   double *out)
{
    const double *m = state;
    size_t i;
    for (i = 0; i < n; i++, in += 6, out += 5 + bands) {
        const double ratio = in[2] > 0 ? m[ETA] : 1 / m[ETA];
        const double cos_o = fabs(in[2]);
        const double t2 = 1 - (1 - cos_o * cos_o) / (ratio * ratio);
        const double cos_t = t2 > 0 ? sqrt(t2) : 0;
        const double s = (cos_o - ratio * cos_t) / (cos_o + ratio * cos_t);
        const double p = (ratio * cos_o - cos_t) / (ratio * cos_o + cos_t);
        const double r = t2 > 0 ? (s * s + p * p) / 2 : 1;
        const int back = in[3] < r;
        int b;
        out[0] = back ? -in[0] : -in[0] / ratio;
        out[1] = back ? -in[1] : -in[1] / ratio;
        out[2] = back ? in[2] : in[2] > 0 ? -cos_t : cos_t;
        out[3] = back ? r : 1 - r;
        for (b = 0; b < bands; b++)
            out[4 + b] = 1;
        out[4 + bands] = 1;
    }
}

BSDF_PLUGIN_EXPORT const struct bsdf_plugin *bsdf_plugin(void)
{
    static const struct bsdf_plugin plugin = {
        BSDF_PLUGIN_ABI, sizeof plugin, "glass", "smooth interface",
        params,          NULL,          NULL,    claims,
        nothing,         nothing,       sample,
    };
    return &plugin;
}
