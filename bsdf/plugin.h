/* plugin.h - a scattering model in a shared object, to be judged as it is
 *
 * SPDX-License-Identifier: MIT-0, so that it can go into any program; the rest
 * of the project has another licence.
 *
 * Permission is hereby granted, free of charge, to any person obtaining a copy
 * of this software and associated documentation files (the "Software"), to
 * deal in the Software without restriction, including without limitation the
 * rights to use, copy, modify, merge, publish, distribute, sublicense, and/or
 * sell copies of the Software, and to permit persons to whom the Software is
 * furnished to do so.
 *
 * THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
 * IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
 * FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
 * AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
 * LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
 * OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
 * SOFTWARE.
 *
 * This file stands alone, in C99 and in C++11, and what includes it links
 * nothing.  A shared object defines one function,
 *
 *     BSDF_PLUGIN_EXPORT const struct bsdf_plugin *bsdf_plugin(void);
 *
 * and is built and judged by
 *
 *     cc -shared -fPIC -o my.so my.c
 *     bsdf-validate ./my.so:alpha=0.2
 *
 * It is loaded by a process of its own, one for each thread of the toolkit, and
 * never called by two threads at once: it may crash, hang, or print, to
 * standard output or error; nothing else suffers.  It must answer the same
 * question the same way each time.
 *
 * Conventions: z is the surface normal; every direction is a unit vector that
 * points away from the surface; wo (to the viewer) is given, wi (to the light)
 * asked about or sampled.  A band is a vacuum wavelength or one of R, G, B.
 *
 *   f       BSDF [1/sr], one value a band, without the cosine; of radiance,
 *           so that through an interface f(wo, wi) / n_o^2 = f(wi, wo) / n_i^2
 *   pdf     density of wi per solid angle [1/sr]
 *   weight  f |wi.z| / pdf, one value a band
 *   u       three numbers, uniform in [0, 1): all the chance that there is
 *
 * Arrays are flat, a record after the other:
 *
 *             in, 6 numbers      out
 *   eval      wo.xyz, wi.xyz     f: `bands` numbers
 *   pdf       wo.xyz, wi.xyz     pdf
 *   sample    wo.xyz, u.xyz      wi.xyz, pdf, weight: `bands` numbers, delta
 *
 * A sample that is refused is all zeros, which is what out is beforehand. delta
 * is 1 where wi has a probability in place of a density (a mirror), else 0;
 * eval and pdf are 0 there.
 */
#ifndef BSDF_PLUGIN_H
#define BSDF_PLUGIN_H

#include <stddef.h>

#define BSDF_PLUGIN_ABI 1

#ifdef __cplusplus
#define BSDF_PLUGIN_EXPORT extern "C" __attribute__((visibility("default")))
#else
#define BSDF_PLUGIN_EXPORT __attribute__((visibility("default")))
#endif

/** A setting, a number: "alpha" in "./my.so:alpha=0.2". */
struct bsdf_plugin_param {
    const char *key;      /* of letters, digits and _ */
    double def, min, max; /* def NaN: it must be given */
    const char *about;    /* one line, with the unit */
};

enum bsdf_plugin_lobes {
    BSDF_PLUGIN_DIFFUSE_REFLECTION = 1,
    BSDF_PLUGIN_GLOSSY_REFLECTION = 2,
    BSDF_PLUGIN_DELTA_REFLECTION = 4,
    BSDF_PLUGIN_DIFFUSE_TRANSMISSION = 8,
    BSDF_PLUGIN_GLOSSY_TRANSMISSION = 16,
    BSDF_PLUGIN_DELTA_TRANSMISSION = 32
};

/** What a model says of itself, and is held to. */
struct bsdf_plugin_claims {
    unsigned lobes;      /* of enum bsdf_plugin_lobes; must be set */
    int lossless;        /* 0; 1: the albedo is 1 for every wo and band */
    int reciprocal;      /* 1: light may go back the way it came */
    int two_sided;       /* 0; 1: it answers a wo below the surface as well */
    double eta;          /* 1: index below the surface over that above */
    int single;          /* 0; 1: it computes in float */
    int cosine_included; /* 0; 1: eval gives f |wi.z| */
    int given_wi;        /* 0; 1: the direction that is given is the light's,
                            and transmission is not scaled by the indices;
                            what is compared is f (n_o / n_i)^2, n_o the index
                            on the side of the given direction */
};

struct bsdf_plugin {
    unsigned abi; /* BSDF_PLUGIN_ABI */
    size_t size;  /* sizeof(struct bsdf_plugin) */
    const char *name, *about;
    const struct bsdf_plugin_param *params; /* at most 63; the last has no key;
                                               NULL: none */

    /** Makes a model from the values of the settings, in the order of params,
     * for 1 to 4 bands: vacuum wavelengths nm [nm], or NULL for R, G, B.  NULL,
     * and a sentence in why, of at most size bytes, if it cannot be made.
     * Where create is NULL the state is the values, a const double *. */
    void *(*create)(const double *values, int bands, const double *nm,
                    char *why, size_t size);
    void (*destroy)(void *state); /* may be NULL */

    /** The claims are filled with the values that come first above. */
    void (*claims)(const void *state, struct bsdf_plugin_claims *claims);

    /** n from 1 to 65536. */
    void (*eval)(const void *state, int bands, size_t n, const double *in,
                 double *out);
    void (*pdf)(const void *state, int bands, size_t n, const double *in,
                double *out);
    void (*sample)(const void *state, int bands, size_t n, const double *in,
                   double *out);
};

#endif
