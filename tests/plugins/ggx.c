/* ggx.c - a rough mirror of GGX facets, F = 1, as a plugin; with faults
 *
 * D and Smith's G, drawn through the facets that wo sees: E. Heitz, Sampling
 * the GGX Distribution of Visible Normals, JCGT 7(4), 2018.  The same as
 * tests/broken.c's sound metal.  `fault` makes it go wrong, see `misbehave`.
 */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bsdf/plugin.h"

#ifndef ABI
#define ABI BSDF_PLUGIN_ABI
#endif

static const double pi = 3.14159265358979323846;

enum { ALPHA, FAULT, AT };
enum {
    NONE,
    SEGFAULT,
    LOOP,
    STOP,
    EXIT,
    NOT_A_NUMBER,
    PRINT,
    COSINE,
    COSINE_SAID,
    FLOAT,
    FLOAT_SAID,
    ABORT,
    REFUSE,
    MASKED_ONCE
};

static const struct bsdf_plugin_param params[] = {
    { "alpha", 0.3, 0.001, 1, "roughness" },
    { "fault", 0, 0, 13, "what goes wrong" },
    { "at", 0.5, -1, 2, "where wi.z (eval, pdf) is above: there it does" },
    { 0 },
};

static void *create(const double *values, int bands, const double *nm,
                    char *why, size_t size)
{
    double *state;
    (void)bands, (void)nm;
    if ((int)values[FAULT] == REFUSE) {
        snprintf(why, size, "no such day");
        return NULL;
    }
    state = malloc(3 * sizeof *state);
    if (state)
        memcpy(state, values, 3 * sizeof *values);
    return state;
}

static void claims(const void *state, struct bsdf_plugin_claims *c)
{
    const int fault = (int)((const double *)state)[FAULT];
    c->lobes = BSDF_PLUGIN_GLOSSY_REFLECTION;
    c->cosine_included = fault == COSINE_SAID;
    c->single = fault == FLOAT_SAID;
}

static void misbehave(const double *m, double wi_z)
{
    if (!(wi_z > m[AT]))
        return;
    switch ((int)m[FAULT]) {
    case SEGFAULT:
        signal(SIGSEGV, SIG_DFL); /* whatever a sanitizer made of it */
        raise(SIGSEGV);
        break;
    case LOOP:
        for (;;)
            ;
    case STOP:
        raise(SIGSTOP);
        break;
    case EXIT:
        exit(0);
    case ABORT:
        abort();
    case PRINT:
        printf("wi.z = %g\n", wi_z);
        fflush(stdout);
        break;
    }
}

static double d(double alpha, const double h[3])
{
    const double x = h[0] / alpha, y = h[1] / alpha;
    const double s = x * x + y * y + h[2] * h[2];
    return h[2] > 0 ? 1 / (pi * alpha * alpha * s * s) : 0;
}

static double lambda(double alpha, const double w[3])
{
    const double t2 = (w[0] * w[0] + w[1] * w[1]) / (w[2] * w[2]);
    const double a2 = alpha * alpha * t2;
    return a2 / (2 * (1 + sqrt(1 + a2))); /* (sqrt(1 + a2) - 1) / 2 */
}

static int half(const double *wo, const double *wi, double h[3])
{
    double length = 0;
    int k;
    if (!(wo[2] > 0 && wi[2] > 0))
        return 0;
    for (k = 0; k < 3; k++)
        length += (wo[k] + wi[k]) * (wo[k] + wi[k]);
    for (k = 0; k < 3; k++)
        h[k] = (wo[k] + wi[k]) / sqrt(length);
    return 1;
}

static double value(const double *m, const double *in)
{
    double h[3];
    if (!half(in, in + 3, h))
        return 0;
    return d(m[ALPHA], h) /
           (1 + lambda(m[ALPHA], in) +
            (m[FAULT] == MASKED_ONCE ? 0 : lambda(m[ALPHA], in + 3))) /
           (4 * in[2] * in[5]);
}

static double density(const double *m, const double *in)
{
    double h[3];
    if (!half(in, in + 3, h))
        return 0;
    return d(m[ALPHA], h) / (1 + lambda(m[ALPHA], in)) / (4 * in[2]);
}

/* As one that computes in float rounds. */
static double rounded(const double *m, double x)
{
    const int fault = (int)m[FAULT];
    return fault == FLOAT || fault == FLOAT_SAID ? (double)(float)x : x;
}

static void eval(const void *state, int bands, size_t n, const double *in,
                 double *out)
{
    const double *m = state;
    const int fault = (int)m[FAULT];
    size_t i;
    int b;
    for (i = 0; i < n; i++, in += 6)
        for (b = 0; b < bands; b++) {
            misbehave(m, in[5]);
            *out = rounded(m, value(m, in));
            if (fault == COSINE || fault == COSINE_SAID)
                *out *= in[5];
            if (fault == NOT_A_NUMBER && in[5] > m[AT])
                *out = NAN;
            out++;
        }
}

static void pdf(const void *state, int bands, size_t n, const double *in,
                double *out)
{
    size_t i;
    (void)bands;
    for (i = 0; i < n; i++, in += 6)
        *out++ = rounded(state, density(state, in));
}

static void normal(double alpha, const double *wo, double u, double v,
                   double h[3])
{
    double w[3] = { alpha * wo[0], alpha * wo[1], wo[2] };
    const double length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    const double flat = sqrt(w[0] * w[0] + w[1] * w[1]) / length;
    double s[3] = { 1, 0, 0 }, t[3], r = sqrt(u), phi = 2 * pi * v, x, y, z;
    int k;
    for (k = 0; k < 3; k++)
        w[k] /= length;
    if (flat > 0) {
        s[0] = -w[1] / flat;
        s[1] = w[0] / flat;
    }
    t[0] = w[1] * s[2] - w[2] * s[1];
    t[1] = w[2] * s[0] - w[0] * s[2];
    t[2] = w[0] * s[1] - w[1] * s[0];
    x = r * cos(phi);
    y = (1 - w[2]) / 2 * sqrt(1 - x * x) + (1 + w[2]) / 2 * r * sin(phi);
    z = sqrt(fmax(0, 1 - x * x - y * y));
    for (k = 0; k < 3; k++)
        h[k] = x * s[k] + y * t[k] + z * w[k];
    h[0] *= alpha;
    h[1] *= alpha;
    h[2] = fmax(1e-300, h[2]);
    r = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (k = 0; k < 3; k++)
        h[k] /= r;
}

static void sample(const void *state, int bands, size_t n, const double *in,
                   double *out)
{
    const double *m = state;
    size_t i;
    for (i = 0; i < n; i++, in += 6, out += 5 + bands) {
        double pair[6], h[3], dot = 0, length = 0;
        int k;
        if (!(in[2] > 0))
            continue;
        normal(m[ALPHA], in, in[3], in[4], h);
        for (k = 0; k < 3; k++)
            dot += in[k] * h[k];
        for (k = 0; k < 3; k++) {
            pair[k] = in[k];
            pair[3 + k] = 2 * dot * h[k] - in[k];
            length += pair[3 + k] * pair[3 + k];
        }
        for (k = 0; k < 3; k++)
            pair[3 + k] /= sqrt(length);
        if (!(pair[5] > 0 && density(m, pair) > 0))
            continue;
        memcpy(out, pair + 3, 3 * sizeof *out);
        out[3] = rounded(m, density(m, pair));
        for (k = 0; k < bands; k++)
            out[4 + k] =
                rounded(m, value(m, pair) * pair[5] / density(m, pair));
    }
}

BSDF_PLUGIN_EXPORT const struct bsdf_plugin *bsdf_plugin(void)
{
    static const struct bsdf_plugin plugin = {
        ABI,    sizeof plugin, "ggx",  "rough mirror of GGX facets",
        params, create,        free,   claims,
        eval,   pdf,           sample,
    };
    return &plugin;
}
