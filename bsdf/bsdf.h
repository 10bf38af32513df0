/* bsdf.h - what every scattering model does, and how to get one
 *
 * The conventions of the whole project:
 *   frame    z is the surface normal; every direction is a unit vector.
 *   wo, wi   outgoing (to the viewer) and incident (to the light), both
 *            pointing away from the surface; wo is given, wi asked about
 *            or sampled.
 *   band     a vacuum wavelength [nm]; an instance is made for up to four,
 *            see bands.h.
 *   f        value of the BSDF [1/sr] in each band, without the cosine.
 *   pdf      density of wi per solid angle [1/sr].
 *
 * A model is one constant bsdf_type.  A bsdf is an instance of one; it never
 * changes once made, so threads may share it.
 */
#ifndef BSDF_BSDF_H
#define BSDF_BSDF_H

#include <stdbool.h>
#include <stddef.h>

#include "bsdf/bands.h"
#include "bsdf/err.h"
#include "bsdf/vec.h"

/** All zeros when the light is absorbed, or the draw refused. */
struct bsdf_sample {
    struct vec3 wi;
    double pdf;             /* [1/sr]; a probability [1] where delta is set */
    struct spectrum weight; /* f |wi.z| / pdf [1] */
    bool delta;             /* one direction, where eval and pdf are 0 */
};

/** Where many samples go, an array a number; the caller's. */
struct bsdf_samples {
    double *x, *y, *z, *pdf;   /* wi, and its pdf */
    double *weight[BANDS_MAX]; /* NULL for bands that are not asked for; where
                                  that is all, a model has less to compute */
    bool *delta;
};

/** One setting of a model: the table parses specs, checks ranges, prints help.
 * A value that is neither given nor has a default is NaN (number, spectrum),
 * NULL (string, nested) or -1 (choice, flag). */
struct bsdf_param {
    const char *key;
    enum bsdf_param_kind {
        BSDF_NUMBER,   /* double, in [min, max] */
        BSDF_SPECTRUM, /* struct spectrum, each band in [min, max] */
        BSDF_CHOICE,   /* int, the index into choices */
        BSDF_FLAG,     /* int, 0 or 1, from "false" or "true" */
        BSDF_STRING,   /* char *, owned by the instance */
        BSDF_NESTED,   /* struct bsdf *, likewise, from "(spec)" */
    } kind;
    size_t offset;              /* of the field in the model's state */
    const char *def;            /* as a user would write it, or NULL */
    double min, max;            /* of numbers and spectra */
    const char *const *choices; /* of a choice; the last is NULL */
    const char *about;          /* one line, with the unit */
};

enum bsdf_lobes {
    BSDF_DIFFUSE_REFLECTION = 1,
    BSDF_GLOSSY_REFLECTION = 2,
    BSDF_DELTA_REFLECTION = 4,
    BSDF_DIFFUSE_TRANSMISSION = 8,
    BSDF_GLOSSY_TRANSMISSION = 16,
    BSDF_DELTA_TRANSMISSION = 32,
    BSDF_REFLECTION = 1 | 2 | 4,
    BSDF_TRANSMISSION = 8 | 16 | 32,
    BSDF_DELTA = 4 | 32,
};

/** What a model says of itself; the checks hold it to that. */
struct bsdf_claims {
    unsigned lobes;  /* of enum bsdf_lobes */
    bool lossless;   /* the albedo is 1 for every wo and band */
    bool reciprocal; /* f(wo, wi) = f(wi, wo), in radiance divided by n^2 */
    bool two_sided;  /* it answers a wo below the surface as well */
    double eta;      /* index of the lower side over that of the upper */
    double epsilon;  /* spacing of its floating-point numbers at 1: 2^-52 for
                        double, which 0 stands for, 2^-23 for float */
};

struct bsdf_type {
    const char *name; /* "roughconductor" in "roughconductor:alpha=0.2" */
    const char *about;
    const struct bsdf_param *params; /* its settings; the last has no key */
    size_t size;                     /* of the state that they fill */
    struct bsdf_claims (*claims)(const void *state, const struct bands *bands);

    /* Both NULL where there are only delta lobes: 0. */
    struct spectrum (*eval)(const void *state, struct vec3 wo, struct vec3 wi);
    double (*pdf)(const void *state, struct vec3 wo, struct vec3 wi);

    struct bsdf_sample (*sample)(const void *state, struct vec3 wo,
                                 struct vec3 u); /* u uniform in [0, 1)^3 */

    /* Optional: NULL is the common case. */
    bool (*init)(void *state, const struct bands *bands, struct err *err);
    void (*clear)(void *state); /* what init allocated; strings are freed */

    /* A microfacet model shows its facets: D(m) [1/sr] and Smith's G1(w). */
    double (*facet_d)(const void *state, struct vec3 m);
    double (*facet_g1)(const void *state, struct vec3 w);

    /* A model of one interface shows its index eta + i k in each band, of what
     * is below over what is above. */
    void (*index)(const void *state, struct spectrum *eta, struct spectrum *k);

    /* For a model that is computed elsewhere, as by another program: tells and
     * forgets the first thing that went wrong in calls of this thread since it
     * was asked last; false if nothing did.  Values that could not be had are
     * NaN. */
    bool (*trouble)(const void *state, struct err *what);

    /* Many at once, bit for bit what the one-by-one calls give. */
    void (*eval_many)(const void *state, size_t n, struct dirs wo,
                      struct dirs wi, struct spectrum *f);
    void (*pdf_many)(const void *state, size_t n, struct dirs wo,
                     struct dirs wi, double *pdf);
    void (*sample_many)(const void *state, size_t n, struct dirs wo,
                        struct dirs u, struct bsdf_samples out);
};

/** The models that specs can name; the last is NULL.  See types.c. */
extern const struct bsdf_type *const bsdf_types[];

struct bsdf;

/** Makes what a spec describes: "name" or "name:key=value,key=a/b/c", where a
 * value may be in single quotes ('' is a quote inside), a spectrum is one value
 * or one a band, and a model inside another is in parentheses.  NULL and the
 * reason if it cannot be made.  Owned by the caller.  If it can, err has a
 * warning or is empty. */
struct bsdf *bsdf_new(const char *spec, const struct bands *bands,
                      struct err *err);

/** The same for a type of the caller's, with the settings alone ("" or
 * "key=value,..."). */
struct bsdf *bsdf_new_of(const struct bsdf_type *type, const char *settings,
                         const struct bands *bands, struct err *err);

/** The same for a state that is made already: a copy of its type->size bytes,
 * which bsdf_free clears.  The type has no settings; the spec is what bsdf_spec
 * gives.  NULL, and the state stays the caller's, when out of memory. */
struct bsdf *bsdf_new_around(const struct bsdf_type *type, const char *spec,
                             const void *state, const struct bands *bands,
                             struct err *err);

void bsdf_free(struct bsdf *b); /* NULL is fine */

/** A spec with one of its settings another, as it would stand there, or without
 * it where value is NULL.  NULL and the reason where its settings make no
 * sense; owned by the caller. */
char *bsdf_spec_with(const char *spec, const char *key, const char *value,
                     struct err *err);

const struct bsdf_type *bsdf_type(const struct bsdf *b);
const struct bands *bsdf_bands(const struct bsdf *b);
const char *bsdf_spec(const struct bsdf *b); /* as given */
struct bsdf_claims bsdf_claims(const struct bsdf *b);

struct spectrum bsdf_eval(const struct bsdf *b, struct vec3 wo, struct vec3 wi);
double bsdf_pdf(const struct bsdf *b, struct vec3 wo, struct vec3 wi);
struct bsdf_sample bsdf_sample(const struct bsdf *b, struct vec3 wo,
                               struct vec3 u);

/** n at once; the arrays are the caller's, of n elements each. */
void bsdf_eval_many(const struct bsdf *b, size_t n, struct dirs wo,
                    struct dirs wi, struct spectrum *f);
void bsdf_pdf_many(const struct bsdf *b, size_t n, struct dirs wo,
                   struct dirs wi, double *pdf);
void bsdf_sample_many(const struct bsdf *b, size_t n, struct dirs wo,
                      struct dirs u, struct bsdf_sample *sample);

/** The same into arrays, which is faster. */
void bsdf_sample_into(const struct bsdf *b, size_t n, struct dirs wo,
                      struct dirs u, struct bsdf_samples out);

/** One of the arrays' samples; bands that were not asked for are 0. */
struct bsdf_sample bsdf_samples_at(const struct bsdf_samples *s, size_t i);
void bsdf_samples_put(const struct bsdf_samples *s, size_t i,
                      const struct bsdf_sample *a);

/** The same arrays from one of the samples on. */
struct bsdf_samples bsdf_samples_from(const struct bsdf_samples *s, size_t i);

/** Whether the model can be in trouble, and the first that it was in during
 * calls of this thread since it was asked last. */
bool bsdf_has_trouble(const struct bsdf *b);
bool bsdf_trouble(const struct bsdf *b, struct err *what);

/** Whether the model shows its facets, and what they are: D(m) [1/sr], and
 * the share G1(w) of the facets facing w that w sees. */
bool bsdf_has_facets(const struct bsdf *b);
double bsdf_facet_d(const struct bsdf *b, struct vec3 m);
double bsdf_facet_g1(const struct bsdf *b, struct vec3 w);

/** The index of a model's interface, relative, in each band; false where it
 * shows none. */
bool bsdf_index(const struct bsdf *b, struct spectrum *eta, struct spectrum *k);

#endif
