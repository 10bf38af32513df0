/* course_microfacet.c - the microfacet BSDF of a course, with its faults
 *
 * The rough metal as a student of CS184/284A writes it in project 3-2, on the
 * starter code's masking.  It claims what its author would claim; two faults,
 * each of which can be mended, make that untrue:
 *
 *   lambda=course       L = (erf(a) - 1 + exp(-a^2) / (a pi)) / 2, a =
 *                       1 / (alpha tan(theta)): pi stands where sqrt(pi)
 *                       belongs, G exceeds 1 and energy is created.
 *   fresnel_at=normal   F at n.wi where wi.h belongs: not reciprocal.
 *
 *   f = F G D / (4 cos_o cos_i),  G = 1 / (1 + L(wo) + L(wi))
 *   pdf = D(h) cos_h / (4 wi.h)
 *
 * with D Beckmann's and F the write-up's approximation.  A direction sampled
 * below the horizon is refused.
 */
#include "bsdf/facets.h"
#include "bsdf/fresnel.h"
#include "bsdf/metal.h"
#include "bsdf/types.h"

enum { LAMBDA_COURSE, LAMBDA_EXACT };
enum { AT_NORMAL, AT_HALF };

struct course_microfacet {
    char *material;
    struct spectrum eta, k;
    double alpha;
    int lambda, fresnel_at;
    int bands;
};

static const char *const lambdas[] = { "course", "exact", NULL };
static const char *const places[] = { "normal", "half", NULL };

#define FIELD(name) offsetof(struct course_microfacet, name)
static const struct bsdf_param params[] = {
    METAL_PARAMS(struct course_microfacet),
    { "alpha", BSDF_NUMBER, FIELD(alpha), "0.5", 1e-4, 1, NULL, "roughness" },
    { "lambda", BSDF_CHOICE, FIELD(lambda), "course", 0, 0, lambdas,
      "masking with the course's pi, or exact" },
    { "fresnel_at", BSDF_CHOICE, FIELD(fresnel_at), "normal", 0, 0, places,
      "cosine in F: n.wi as in the course, or wi.h" },
    { 0 },
};

static bool init(void *state, const struct bands *bands, struct err *err)
{
    struct course_microfacet *m = state;
    m->bands = bands->count;
    return metal_settle("course_microfacet", m->material, &m->eta, &m->k, bands,
                        err);
}

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    (void)state, (void)bands;
    return (struct bsdf_claims){ .lobes = BSDF_GLOSSY_REFLECTION,
                                 .reciprocal = true,
                                 .eta = 1 };
}

static double lambda(const struct course_microfacet *m, struct vec3 w)
{
    if (m->lambda == LAMBDA_EXACT)
        return ndf_lambda(&ndf_beckmann, m->alpha, m->alpha, w);
    const double a = w.z / (m->alpha * hypot(w.x, w.y));
    return (exp(-a * a) / (a * PI) - erfc(a)) / 2;
}

static double g(const struct course_microfacet *m, struct vec3 wo,
                struct vec3 wi)
{
    return 1 / (1 + lambda(m, wo) + lambda(m, wi));
}

static struct spectrum f(const struct course_microfacet *m, double cos_i,
                         double cos_d, double common)
{
    struct spectrum s = { { 0 } };
    const double c = fmin(m->fresnel_at == AT_NORMAL ? cos_i : cos_d, 1);
    for (int b = 0; b < m->bands; b++)
        s.band[b] =
            common * fresnel_conductor_approx(c, m->eta.band[b], m->k.band[b]);
    return s;
}

static double d(const struct course_microfacet *m, struct vec3 h)
{
    return ndf_d(&ndf_beckmann, m->alpha, m->alpha, h);
}

static struct spectrum eval(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct course_microfacet *m = state;
    if (!(wo.z > 0 && wi.z > 0))
        return (struct spectrum){ { 0 } };
    double h2;
    const struct vec3 h = facets_half(wo, wi, &h2);
    return f(m, wi.z, sqrt(h2) / 2, d(m, h) * g(m, wo, wi) / (4 * wo.z * wi.z));
}

static double pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    if (!(wo.z > 0 && wi.z > 0))
        return 0;
    double h2;
    const struct vec3 h = facets_half(wo, wi, &h2);
    return d(state, h) * h.z / (2 * h2);
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct course_microfacet *m = state;
    const struct bsdf_sample refused = { 0 };
    if (!(wo.z > 0))
        return refused;
    const struct vec3 h =
        ndf_sample_all(&ndf_beckmann, m->alpha, m->alpha, u.x, u.y);
    const double cos_d = vec3_dot(wo, h);
    const struct vec3 wi = vec3_unit(vec3_reflect(wo, h));
    if (!(cos_d > 0 && wi.z > 0))
        return refused;
    const double density = pdf(m, wo, wi);
    if (!(density > 0))
        return refused;
    return (struct bsdf_sample){
        .wi = wi,
        .pdf = density,
        .weight = f(m, wi.z, cos_d, g(m, wo, wi) * cos_d / (wo.z * h.z)),
    };
}

static double facet_d(const void *state, struct vec3 h)
{
    return d(state, h);
}

static double facet_g1(const void *state, struct vec3 w)
{
    return 1 / (1 + lambda(state, w));
}

static void index_of(const void *state, struct spectrum *eta,
                     struct spectrum *k)
{
    const struct course_microfacet *m = state;
    *eta = m->eta;
    *k = m->k;
}

const struct bsdf_type type_course_microfacet = {
    .name = "course_microfacet",
    .about = "rough metal as in the course, faults included",
    .params = params,
    .size = sizeof(struct course_microfacet),
    .claims = claims,
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
    .init = init,
    .index = index_of,
    .facet_d = facet_d,
    .facet_g1 = facet_g1,
};
