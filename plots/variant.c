/* variant.c - other settings of a model */
#include "plots/variant.h"

#include <stdlib.h>
#include <string.h>

#include "validate/energy.h"
#include "validate/foreign.h"

bool variant_has(const struct bsdf *b, const char *key)
{
    for (const struct bsdf_param *p = bsdf_type(b)->params; p->key; p++)
        if (strcmp(p->key, key) == 0)
            return true;
    return false;
}

struct bsdf *variant_new(const struct bsdf *b, const struct variant *v, int n,
                         struct err *err)
{
    char *spec = strdup(bsdf_spec(b));
    if (!spec)
        err_set(err, "out of memory");
    for (int i = 0; spec && i < n; i++) {
        char *next = bsdf_spec_with(spec, v[i].key, v[i].value, err);
        free(spec);
        spec = next;
    }
    struct bsdf *made = spec ? foreign_new(spec, bsdf_bands(b), err) : NULL;
    free(spec);
    if (made && err)
        err->text[0] = '\0';
    return made;
}

bool variant_albedo(const struct bsdf *b, struct vec3 wo, uint64_t seed,
                    struct estimate albedo[BANDS_MAX], struct err *err)
{
    struct estimate beside[BANDS_MAX];
    return variant_energy(b, wo, seed, albedo, beside, err);
}

bool variant_energy(const struct bsdf *b, struct vec3 wo, uint64_t seed,
                    struct estimate albedo[BANDS_MAX],
                    struct estimate beside[BANDS_MAX], struct err *err)
{
    struct plan plan = plan_default;
    struct subject s;
    plan.seed = seed;
    plan.samples = 1000; /* for the survey's pilots; quadrature needs no more */
    plan.threads = 1;
    if (!subject_init(&s, b, wo, &plan, err))
        return false;
    const struct energy *e = subject_energy(&s);
    for (int i = 0; e && i < BANDS_MAX; i++) {
        albedo[i] = e->albedo[i];
        beside[i] = e->beside[i];
    }
    subject_clear(&s);
    return e || err_set(err, "out of memory");
}

void variant_weights(const struct bsdf *b, struct vec3 wo, uint64_t seed,
                     uint64_t n, struct estimate albedo[BANDS_MAX])
{
    enum { BATCH = 256 };
    const struct plan plan = { .seed = seed };
    const struct subject s = subject_plain(b, wo, &plan);
    const struct rng rng = subject_rng(&s, STREAM_SURVEY);
    const int bands = bsdf_bands(b)->count;
    struct bsdf_sample a[BATCH];
    double sum[BANDS_MAX] = { 0 }, square[BANDS_MAX] = { 0 };
    double first[BANDS_MAX] = { 0 }; /* so that nothing cancels */
    for (uint64_t from = 0; from < n; from += BATCH) {
        const size_t m = n - from < BATCH ? (size_t)(n - from) : BATCH;
        subject_draw(&s, rng, from, m, a);
        for (size_t i = 0; i < m; i++)
            for (int k = 0; k < bands; k++) {
                const double w =
                    a[i].weight.band[k] * subject_compression(&s, a[i].wi);
                first[k] = from + i > 0 ? first[k] : w;
                sum[k] += w - first[k];
                square[k] += (w - first[k]) * (w - first[k]);
            }
    }
    const double count = (double)n;
    for (int k = 0; k < bands; k++) {
        const double mean = sum[k] / count;
        const double variance = fmax(square[k] / count - mean * mean, 0);
        albedo[k] =
            (struct estimate){ first[k] + mean, sqrt(variance / count) };
    }
}
