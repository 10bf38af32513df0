/* roughdielectric.c - glass of small interfaces
 *
 * With n the index on the side of wi over that on the side of wo, and h the
 * facets' normal, kept above the surface:
 *
 *   reflection    h ~ wo + wi
 *     f   = F D G2 / (4 |cos_o cos_i|)
 *     pdf = F p(h) / (4 |wo.h|)
 *   transmission  h ~ wo + n wi
 *     f   = (1 - F) D G2 |wo.h| |wi.h| / (|cos_o cos_i| |wo + n wi|^2)
 *     pdf = (1 - F) p(h) n^2 |wi.h| / |wo + n wi|^2
 *
 * where |wo + n wi| = |wo.h + n wi.h|, p(h) is that of visible or of all
 * normals, and both directions must be on the side of h that they are on the
 * side of the surface.  f is radiance's: it obeys f(wo, wi) / n_o^2 =
 * f(wi, wo) / n_i^2.
 *
 * Masking: reflection as in roughconductor; in transmission heights are
 * correlated as G2 = Beta(1 + Lambda(wo), 1 + Lambda(wi)), or separable.
 *
 * Equal indices bend nothing: light goes straight through, one direction.
 *
 * [1] B. Walter et al., Microfacet Models for Refraction through Rough
 *     Surfaces, EGSR 2007, eq. 16, 17, 20, 21.
 * [2] E. Heitz et al., Multiple-Scattering Microfacet BSDFs with the Smith
 *     Model, SIGGRAPH 2016, supplemental: the Beta function.
 */
#include <gsl/gsl_sf_gamma.h>

#include "bsdf/facets.h"
#include "bsdf/fresnel.h"
#include "bsdf/medium.h"
#include "bsdf/roughness.h"
#include "bsdf/types.h"

enum { BOTH, REFLECTION, TRANSMISSION };

struct roughdielectric {
    char *int_ior, *ext_ior;
    struct spectrum specular_reflectance, specular_transmittance;
    double alpha, alpha_u, alpha_v;
    double eta; /* below over above */
    int distribution, sample_visible, masking, lobes;
    struct facets facets;
};

static const char *const lobe_sets[] = { "both", "reflection", "transmission",
                                         NULL };

#define FIELD(name) offsetof(struct roughdielectric, name)
static const struct bsdf_param params[] = {
    MEDIUM_PARAMS(struct roughdielectric),
    ROUGHNESS_PARAMS(struct roughdielectric),
    { "specular_reflectance", BSDF_SPECTRUM, FIELD(specular_reflectance), "1",
      0, 1, NULL, "factor on what is reflected; 1 is physical" },
    { "specular_transmittance", BSDF_SPECTRUM, FIELD(specular_transmittance),
      "1", 0, 1, NULL, "factor on what is refracted; 1 is physical" },
    { "lobes", BSDF_CHOICE, FIELD(lobes), "both", 0, 0, lobe_sets,
      "one alone is drawn with its own share, the rest absorbed" },
    { 0 },
};

static bool init(void *state, const struct bands *bands, struct err *err)
{
    struct roughdielectric *m = state;
    if (!roughness_settle("roughdielectric", m->alpha, &m->alpha_u, &m->alpha_v,
                          err))
        return false;
    m->facets = facets_of(roughness_ndf[m->distribution]->family, m->alpha_u,
                          m->alpha_v);
    return medium_settle("roughdielectric", m->int_ior, m->ext_ior, bands,
                         &m->eta, err);
}

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    const struct roughdielectric *m = state;
    const unsigned lobes[] = { BSDF_GLOSSY_REFLECTION |
                                   BSDF_GLOSSY_TRANSMISSION,
                               BSDF_GLOSSY_REFLECTION,
                               BSDF_GLOSSY_TRANSMISSION };
    (void)bands;
    return (struct bsdf_claims){
        .lobes = m->eta != 1              ? lobes[m->lobes]
                 : m->lobes == REFLECTION ? 0u
                                          : BSDF_DELTA_TRANSMISSION,
        .reciprocal = true,
        .two_sided = true,
        .eta = m->eta,
    };
}

static double g2(const struct roughdielectric *m, double lo, double li,
                 bool reflected)
{
    if (m->masking == MASKING_SEPARABLE)
        return 1 / ((1 + lo) * (1 + li));
    return reflected ? 1 / (1 + lo + li) : exp(gsl_sf_lnbeta(1 + lo, 1 + li));
}

/* A facet that turns light from one direction to the other. */
struct facet {
    bool exists, reflects;
    struct vec3 h;
    double n;      /* index on the side of wi over that of wo */
    double co, ci; /* |wo.h|, |wi.h| */
    double square; /* |wo + n wi|^2; 4 co^2 in reflection */
    double share;  /* F, or 1 - F */
};

static struct facet facet_between(const struct roughdielectric *m,
                                  struct vec3 wo, struct vec3 wi)
{
    struct facet t = { .reflects = wo.z * wi.z > 0,
                       .n = wo.z > 0 ? m->eta : 1 / m->eta };
    if (!(wo.z * wi.z != 0) || m->eta == 1)
        return t;
    if (m->lobes == (t.reflects ? TRANSMISSION : REFLECTION))
        return t;
    const struct vec3 sum = vec3_add(wo, vec3_scale(t.reflects ? 1 : t.n, wi));
    t.square = vec3_dot(sum, sum);
    t.h = vec3_scale(copysign(1, sum.z) / sqrt(t.square), sum);
    if (t.reflects) { /* exact, where the dot products cancel at grazing */
        t.exists = true;
        t.co = t.ci = fmin(sqrt(t.square) / 2, 1);
    } else {
        const double o = vec3_dot(wo, t.h) * copysign(1, wo.z);
        const double i = vec3_dot(wi, t.h) * copysign(1, wi.z);
        t.exists = o > 0 && i > 0;
        t.co = fmin(o, 1);
        t.ci = fmin(i, 1);
    }
    t.share = t.reflects ? fresnel_dielectric(t.co, t.n, NULL)
                         : fresnel_dielectric_through(t.co, t.ci, t.n);
    return t;
}

static double d(const struct roughdielectric *m, struct vec3 h)
{
    return h.z > 0 ? facets_d(m->facets, h, vec3_dot(h, h)) : 0;
}

/* From lambda(wo) and lambda(wi). */
static struct spectrum eval_of(const struct roughdielectric *m, struct vec3 wo,
                               struct vec3 wi, double lo, double li)
{
    const struct facet t = facet_between(m, wo, wi);
    if (!t.exists)
        return (struct spectrum){ { 0 } };
    const double common =
        t.share * d(m, t.h) * g2(m, lo, li, t.reflects) / fabs(wo.z * wi.z);
    return t.reflects ? spectrum_scale(common / 4, m->specular_reflectance)
                      : spectrum_scale(common * t.co * t.ci / t.square,
                                       m->specular_transmittance);
}

static struct spectrum eval(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct roughdielectric *m = state;
    return eval_of(m, wo, wi, facets_lambda(m->facets, wo),
                   facets_lambda(m->facets, wi));
}

/* The pdf from lambda(wo), which is asked for visible normals alone. */
static double density(const struct roughdielectric *m, struct vec3 wo,
                      const struct facet *t, double lo)
{
    const double p = m->sample_visible
                         ? t->co * d(m, t->h) / (fabs(wo.z) * (1 + lo))
                         : d(m, t->h) * t->h.z;
    return t->share * p *
           (t->reflects ? 1 / (4 * t->co) : t->n * t->n * t->ci / t->square);
}

static double pdf_of(const struct roughdielectric *m, struct vec3 wo,
                     struct vec3 wi, double lo)
{
    const struct facet t = facet_between(m, wo, wi);
    return t.exists ? density(m, wo, &t, lo) : 0;
}

static double pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct roughdielectric *m = state;
    return pdf_of(m, wo, wi,
                  m->sample_visible ? facets_lambda(m->facets, wo) : 0);
}

/* By a facet with its normal along h, of any length and on the side of wo;
 * from lambda(wo). */
static struct bsdf_sample sample_of(const struct roughdielectric *m,
                                    struct vec3 wo, struct vec3 h, double u,
                                    double lo)
{
    const struct bsdf_sample refused = { 0 };
    const double side = copysign(1, wo.z);
    if (wo.z == 0)
        return refused;
    if (m->eta == 1)
        return m->lobes == REFLECTION
                   ? refused
                   : (struct bsdf_sample){ .wi = vec3_scale(-1, wo),
                                           .pdf = 1,
                                           .weight = m->specular_transmittance,
                                           .delta = true };
    h = vec3_unit(h);
    const double n = wo.z > 0 ? m->eta : 1 / m->eta;
    const double c = vec3_dot(wo, h) * side;
    if (!(c > 0))
        return refused;
    double cos_t;
    const bool reflects = u < fresnel_dielectric(fmin(c, 1), n, &cos_t);
    const struct vec3 wi =
        reflects ? vec3_unit(vec3_reflect(wo, h))
                 : medium_refract(wo, vec3_scale(side, h), n, cos_t);
    const struct facet t = facet_between(m, wo, wi);
    if (!t.exists || t.reflects != reflects)
        return refused;
    const double p = density(m, wo, &t, lo);
    if (!(p > 0))
        return refused;
    const double g = g2(m, lo, facets_lambda(m->facets, wi), reflects);
    const double ratio =
        m->sample_visible ? g * (1 + lo) : g * t.co / (fabs(wo.z) * t.h.z);
    return (struct bsdf_sample){
        .wi = wi,
        .pdf = p,
        .weight = reflects ? spectrum_scale(ratio, m->specular_reflectance)
                           : spectrum_scale(ratio / (n * n),
                                            m->specular_transmittance),
    };
}

/* Seen from below the facets are those of the opposite direction. */
static struct vec3 turned_up(struct vec3 w)
{
    return vec3_scale(copysign(1, w.z), w);
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct roughdielectric *m = state;
    const struct vec3 h =
        m->sample_visible ? facets_visible(m->facets, turned_up(wo), u.x, u.y)
                          : facets_all(m->facets, u.x, u.y);
    return sample_of(m, wo, h, u.z, facets_lambda(m->facets, wo));
}

/* -- many at once: lambda and the normals in lanes, the rest one by one ---- */

struct lanes {
    double lo[LANES_MAX], li[LANES_MAX];
    double ox[LANES_MAX], oy[LANES_MAX], oz[LANES_MAX];
    double hx[LANES_MAX], hy[LANES_MAX], hz[LANES_MAX];
};

static void look(const struct roughdielectric *m, size_t n, struct dirs wo,
                 double *lo)
{
    const bool one = dirs_same(n, wo);
    facets_lambda_many(m->facets, one ? 1 : n, wo, lo);
    if (one)
        facets_fill(n, lo);
}

static void eval_many(const void *state, size_t n, struct dirs wo,
                      struct dirs wi, struct spectrum *f)
{
    const struct roughdielectric *m = state;
    struct lanes l;
    for (size_t at = 0, k; at < n; at += k) {
        const struct dirs o = dirs_from(wo, at), w = dirs_from(wi, at);
        k = n - at < LANES_MAX ? n - at : LANES_MAX;
        look(m, k, o, l.lo);
        facets_lambda_many(m->facets, k, w, l.li);
        for (size_t i = 0; i < k; i++)
            f[at + i] =
                eval_of(m, dirs_at(o, i), dirs_at(w, i), l.lo[i], l.li[i]);
    }
}

static void pdf_many(const void *state, size_t n, struct dirs wo,
                     struct dirs wi, double *p)
{
    const struct roughdielectric *m = state;
    struct lanes l;
    for (size_t at = 0, k; at < n; at += k) {
        const struct dirs o = dirs_from(wo, at), w = dirs_from(wi, at);
        k = n - at < LANES_MAX ? n - at : LANES_MAX;
        look(m, k, o, l.lo);
        for (size_t i = 0; i < k; i++)
            p[at + i] = pdf_of(m, dirs_at(o, i), dirs_at(w, i), l.lo[i]);
    }
}

static void sample_many(const void *state, size_t n, struct dirs wo,
                        struct dirs u, struct bsdf_samples out)
{
    const struct roughdielectric *m = state;
    struct lanes l;
    for (size_t at = 0, k; at < n; at += k) {
        const struct dirs o = dirs_from(wo, at), v = dirs_from(u, at);
        const struct dirs above = { l.ox, l.oy, l.oz };
        k = n - at < LANES_MAX ? n - at : LANES_MAX;
        look(m, k, o, l.lo);
        for (size_t i = 0; i < k; i++) {
            const struct vec3 up = turned_up(dirs_at(o, i));
            l.ox[i] = up.x, l.oy[i] = up.y, l.oz[i] = up.z;
        }
        if (m->sample_visible)
            facets_visible_many(m->facets, k, above, dirs_same(k, above), v,
                                l.hx, l.hy, l.hz);
        else
            facets_all_many(m->facets, k, v, l.hx, l.hy, l.hz);
        for (size_t i = 0; i < k; i++) {
            const struct bsdf_sample s = sample_of(
                m, dirs_at(o, i), (struct vec3){ l.hx[i], l.hy[i], l.hz[i] },
                v.z[i], l.lo[i]);
            bsdf_samples_put(&out, at + i, &s);
        }
    }
}

static double facet_d(const void *state, struct vec3 h)
{
    return d(state, h);
}

static double facet_g1(const void *state, struct vec3 w)
{
    const struct roughdielectric *m = state;
    return 1 / (1 + facets_lambda(m->facets, w));
}

static void index_of(const void *state, struct spectrum *eta,
                     struct spectrum *k)
{
    const struct roughdielectric *m = state;
    *eta = spectrum_of(BANDS_MAX, m->eta);
    *k = spectrum_of(BANDS_MAX, 0);
}

const struct bsdf_type type_roughdielectric = {
    .name = "roughdielectric",
    .about = "rough glass (Walter et al., Smith)",
    .params = params,
    .size = sizeof(struct roughdielectric),
    .claims = claims,
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
    .init = init,
    .index = index_of,
    .facet_d = facet_d,
    .facet_g1 = facet_g1,
    .eval_many = eval_many,
    .pdf_many = pdf_many,
    .sample_many = sample_many,
};
