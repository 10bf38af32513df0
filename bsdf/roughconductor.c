/* roughconductor.c - a metal of small mirrors
 *
 *   f = F(wi.h) D(h) G2(wo, wi) / (4 cos_o cos_i)
 *   pdf = D(h) cos_h / (4 wi.h)       all normals
 *         G1(wo) D(h) / (4 cos_o)     visible normals
 *
 * The height-correlated G2 = 1 / (1 + Lambda(wo) + Lambda(wi)) is the default,
 * the separable one G1(wo) G1(wi).
 *
 * [1] K. Torrance and E. Sparrow, Theory for Off-Specular Reflection from
 *     Roughened Surfaces, JOSA 57(9), 1967.
 * [2] B. Walter et al., Microfacet Models for Refraction through Rough
 *     Surfaces, EGSR 2007, eq. 20, 13, 14.
 * [3] E. Heitz, Understanding the Masking-Shadowing Function in
 *     Microfacet-Based BRDFs, JCGT 3(2), 2014, eq. 99 (correlated G2).
 */
#include "bsdf/facets.h"
#include "bsdf/fresnel.h"
#include "bsdf/metal.h"
#include "bsdf/roughness.h"
#include "bsdf/types.h"

enum { EXACT, APPROX, SCHLICK };

struct roughconductor {
    char *material;
    struct spectrum eta, k, specular_reflectance;
    struct spectrum r0; /* reflectance at normal incidence */
    double alpha, alpha_u, alpha_v;
    int distribution, sample_visible, masking, fresnel;
    int bands;
    struct facets facets;
};

static const char *const fresnels[] = { "exact", "approx", "schlick", NULL };

#define FIELD(name) offsetof(struct roughconductor, name)
static const struct bsdf_param params[] = {
    METAL_PARAMS(struct roughconductor),
    ROUGHNESS_PARAMS(struct roughconductor),
    { "fresnel", BSDF_CHOICE, FIELD(fresnel), "exact", 0, 0, fresnels,
      "reflectance of a facet" },
    { "specular_reflectance", BSDF_SPECTRUM, FIELD(specular_reflectance), "1",
      0, 1, NULL, "factor on the result; 1 is physical" },
    { 0 },
};

static bool init(void *state, const struct bands *bands, struct err *err)
{
    struct roughconductor *m = state;
    if (!roughness_settle("roughconductor", m->alpha, &m->alpha_u, &m->alpha_v,
                          err))
        return false;
    if (!metal_settle("roughconductor", m->material, &m->eta, &m->k, bands,
                      err))
        return false;
    m->facets = facets_of(roughness_ndf[m->distribution]->family, m->alpha_u,
                          m->alpha_v);
    m->bands = bands->count;
    for (int b = 0; b < m->bands; b++)
        m->r0.band[b] = fresnel_conductor(1, m->eta.band[b], m->k.band[b]);
    return true;
}

static struct bsdf_claims claims(const void *state, const struct bands *bands)
{
    (void)state, (void)bands;
    return (struct bsdf_claims){ .lobes = BSDF_GLOSSY_REFLECTION,
                                 .reciprocal = true,
                                 .eta = 1 };
}

/* Both; written as one comparison, as gcc 12 makes vectors of that. */
INLINE bool above(struct vec3 wo, struct vec3 wi)
{
    return (wo.z > 0 ? wi.z : 0) > 0;
}

/* What a pdf of visible normals has of wo: G1(wo) / (4 cos_o). */
INLINE double g1_per_cos(struct vec3 wo, double lo)
{
    return 1 / (4 * wo.z * (1 + lo));
}

/* 1 / G2, from lambda(wo) and lambda(wi). */
INLINE double per_g2(const struct roughconductor *m, double lo, double li)
{
    return m->masking == MASKING_CORRELATED ? 1 + lo + li : (1 + lo) * (1 + li);
}

/* f without F, from lambda(wo), and wi.h as half the length of wo + wi. */
INLINE double shape(const struct roughconductor *m, struct facets facets,
                    struct vec3 wo, struct vec3 wi, double lo, double *cos_d)
{
    double h2;
    const struct vec3 h = facets_half(wo, wi, &h2);
    const double li = facets_lambda(facets, wi);
    const double f =
        facets_d(facets, h, h2) / (4 * wo.z * wi.z * per_g2(m, lo, li));
    const bool seen = above(wo, wi);
    *cos_d = seen ? fm_min(sqrt(h2) / 2, 1) : 1;
    return seen ? f : 0;
}

/* Of visible normals from g1_per_cos, or of all: a density of slopes at slope2
 * times a factor, which is 0 unless both are above. */
struct density {
    double slope2, factor;
};

INLINE struct density density_at(struct facets facets, bool visible,
                                 struct vec3 wo, struct vec3 wi, double g1)
{
    double h2;
    const struct vec3 h = facets_half(wo, wi, &h2);
    const struct facets_part d = facets_part(facets, h, h2);
    const double factor =
        visible ? d.t * d.t * g1 : d.t * (d.inverse * h.z) / 2;
    return (struct density){ d.slope2, above(wo, wi) ? factor : 0 };
}

INLINE double density_of(struct facets facets, struct density d)
{
    return facets_p22(facets, d.slope2) * d.factor;
}

INLINE double density(struct facets facets, bool visible, struct vec3 wo,
                      struct vec3 wi, double g1)
{
    return density_of(facets, density_at(facets, visible, wo, wi, g1));
}

/* A sample without its weight, by a facet with the normal's z. */
struct draw {
    struct vec3 wi;
    double pdf, cos_d, z;
};

/* By a facet with its normal along h, of any length; the pdf is still to be
 * found. */
INLINE struct draw draw_by(struct vec3 wo, struct vec3 h)
{
    const struct vec3 n = vec3_unit(h);
    const struct vec3 wi = vec3_unit_again(vec3_reflect(wo, n));
    return (struct draw){ .wi = wi, .cos_d = vec3_dot(wo, n), .z = n.z };
}

/* All 0 where a draw is refused; p is 0 unless both are above. */
INLINE struct draw draw_kept(struct draw s)
{
    const bool good = (s.cos_d > 0 ? s.pdf : 0) > 0;
    return (struct draw){
        .wi = { good ? s.wi.x : 0, good ? s.wi.y : 0, good ? s.wi.z : 0 },
        .pdf = good ? s.pdf : 0,
        .cos_d = good ? fm_min(s.cos_d, 1) : 1,
        .z = s.z,
    };
}

/* f cos_i / (F pdf), with D divided out by hand, of a draw that was kept; 0 of
 * one that was not. */
INLINE double draw_weight(const struct roughconductor *m, struct facets facets,
                          struct vec3 wo, struct draw s, double lo)
{
    const double per_g = per_g2(m, lo, facets_lambda(facets, s.wi));
    const double weight =
        m->sample_visible ? (1 + lo) / per_g : s.cos_d / (wo.z * s.z * per_g);
    return s.pdf > 0 ? weight : 0;
}

/* The model's F in one band, with its factor, times a common one. */
INLINE double tinted(const struct roughconductor *m, int fresnel, int band,
                     double cos_d, double common)
{
    const double eta = m->eta.band[band], k = m->k.band[band];
    const double r = fresnel == EXACT ? fresnel_conductor(cos_d, eta, k)
                     : fresnel == APPROX
                         ? fresnel_conductor_approx(cos_d, eta, k)
                         : fresnel_schlick(cos_d, m->r0.band[band]);
    return common * m->specular_reflectance.band[band] * r;
}

static struct spectrum tinted_all(const struct roughconductor *m, double cos_d,
                                  double common)
{
    struct spectrum f = { { 0 } };
    for (int b = 0; b < m->bands; b++)
        f.band[b] = tinted(m, m->fresnel, b, cos_d, common);
    return f;
}

static struct spectrum eval(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct roughconductor *m = state;
    double cos_d;
    if (!above(wo, wi))
        return (struct spectrum){ { 0 } };
    const double lo = facets_lambda(m->facets, wo);
    const double common = shape(m, m->facets, wo, wi, lo, &cos_d);
    return tinted_all(m, cos_d, common);
}

static double pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct roughconductor *m = state;
    if (!above(wo, wi))
        return 0;
    const double lo = m->sample_visible ? facets_lambda(m->facets, wo) : 0;
    return density(m->facets, m->sample_visible, wo, wi, g1_per_cos(wo, lo));
}

static struct bsdf_sample sample(const void *state, struct vec3 wo,
                                 struct vec3 u)
{
    const struct roughconductor *m = state;
    if (!(wo.z > 0))
        return (struct bsdf_sample){ 0 };
    const struct vec3 h = m->sample_visible
                              ? facets_visible(m->facets, wo, u.x, u.y)
                              : facets_all(m->facets, u.x, u.y);
    const double lo = facets_lambda(m->facets, wo);
    struct draw s = draw_by(wo, h);
    s.pdf = density(m->facets, m->sample_visible, wo, s.wi, g1_per_cos(wo, lo));
    s = draw_kept(s);
    return (struct bsdf_sample){
        .wi = s.wi,
        .pdf = s.pdf,
        .weight = tinted_all(m, s.cos_d, draw_weight(m, m->facets, wo, s, lo)),
    };
}

/* -- many at once: up to LANES_MAX lanes, by loops over parts of the above --
 */

struct lanes {
    double lo[LANES_MAX], g1[LANES_MAX]; /* of wo: lambda, g1_per_cos */
    double cos_d[LANES_MAX], shape[LANES_MAX], slope2[LANES_MAX];
    double hx[LANES_MAX], hy[LANES_MAX], hz[LANES_MAX];
    bool one; /* all wo of the call are the same */
};

LANES static void g1_lanes(size_t n, struct dirs wo, struct lanes *l)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        l->g1[i] = g1_per_cos(dirs_at(wo, i), l->lo[i]);
}

/* What depends on wo alone of the next k directions of a call for n, from `at`
 * on; once if all n are the same, and in the first lane alone. */
static void glance(const struct roughconductor *m, size_t n, size_t at,
                   size_t k, struct dirs wo, struct lanes *l)
{
    if (at == 0)
        l->one = dirs_same(n, wo);
    if (l->one && at > 0)
        return;
    const struct dirs o = dirs_from(wo, at);
    facets_lambda_many(m->facets, l->one ? 1 : k, o, l->lo);
    g1_lanes(l->one ? 1 : k, o, l);
}

/* The same in every lane. */
static void look(const struct roughconductor *m, size_t n, size_t at, size_t k,
                 struct dirs wo, struct lanes *l)
{
    glance(m, n, at, k, wo, l);
    if (l->one && at == 0) {
        facets_fill(k, l->lo);
        facets_fill(k, l->g1);
    }
}

INLINE void shape_loop(const struct roughconductor *m, struct facets facets,
                       size_t n, struct dirs wo, struct dirs wi,
                       struct lanes *l)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        l->shape[i] = shape(m, facets, dirs_at(wo, i), dirs_at(wi, i), l->lo[i],
                            &l->cos_d[i]);
}

LANES static void shape_lanes(const struct roughconductor *m, size_t n,
                              struct dirs wo, struct dirs wi, struct lanes *l)
{
    if (m->facets.family == NDF_GGX)
        shape_loop(m, facets_as(m->facets, NDF_GGX), n, wo, wi, l);
    else
        shape_loop(m, facets_as(m->facets, NDF_BECKMANN), n, wo, wi, l);
}

/* After a glance.  An exponential has a loop of its own, as in draw_loop. */
INLINE void density_loop(struct facets facets, bool visible, size_t n,
                         struct dirs wo, struct dirs wi, struct lanes *l,
                         double *p)
{
    const bool later = facets.family != NDF_GGX;
    if (l->one) {
        const struct vec3 o = dirs_at(wo, 0);
        const double g1 = l->g1[0];
        LANES_LOOP
        for (size_t i = 0; i < n; i++) {
            const struct density d =
                density_at(facets, visible, o, dirs_at(wi, i), g1);
            l->slope2[i] = d.slope2;
            p[i] = later ? d.factor : density_of(facets, d);
        }
    } else {
        LANES_LOOP
        for (size_t i = 0; i < n; i++) {
            const struct density d = density_at(facets, visible, dirs_at(wo, i),
                                                dirs_at(wi, i), l->g1[i]);
            l->slope2[i] = d.slope2;
            p[i] = later ? d.factor : density_of(facets, d);
        }
    }
    LANES_LOOP
    for (size_t i = 0; i < (later ? n : 0); i++)
        p[i] = density_of(facets, (struct density){ l->slope2[i], p[i] });
}

/* Each of the two a loop without a branch on the family. */
LANES static void density_visible(struct facets f, size_t n, struct dirs wo,
                                  struct dirs wi, struct lanes *l, double *p)
{
    if (f.family == NDF_GGX)
        density_loop(facets_as(f, NDF_GGX), true, n, wo, wi, l, p);
    else
        density_loop(facets_as(f, NDF_BECKMANN), true, n, wo, wi, l, p);
}

LANES static void density_all(struct facets f, size_t n, struct dirs wo,
                              struct dirs wi, struct lanes *l, double *p)
{
    if (f.family == NDF_GGX)
        density_loop(facets_as(f, NDF_GGX), false, n, wo, wi, l, p);
    else
        density_loop(facets_as(f, NDF_BECKMANN), false, n, wo, wi, l, p);
}

INLINE struct draw draw_of(const struct lanes *l, const struct bsdf_samples *to,
                           size_t i)
{
    return (struct draw){
        { to->x[i], to->y[i], to->z[i] }, to->pdf[i], l->cos_d[i], l->hz[i]
    };
}

INLINE void draw_put(struct lanes *l, const struct bsdf_samples *to, size_t i,
                     struct draw s)
{
    to->x[i] = s.wi.x, to->y[i] = s.wi.y, to->z[i] = s.wi.z;
    to->pdf[i] = s.pdf;
    l->cos_d[i] = s.cos_d, l->hz[i] = s.z;
}

/* In short loops: a processor that waits for a root or a quotient has room for
 * some dozens of instructions, which are then those of other lanes. */
INLINE void draw_loop(struct facets facets, bool visible, size_t n,
                      struct dirs wo, struct lanes *l,
                      const struct bsdf_samples *out)
{
    const struct bsdf_samples to = *out;
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct vec3 h = { l->hx[i], l->hy[i], l->hz[i] };
        draw_put(l, &to, i, draw_by(dirs_at(wo, i), h));
    }
    density_loop(facets, visible, n, wo, (struct dirs){ to.x, to.y, to.z }, l,
                 to.pdf);
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        draw_put(l, &to, i, draw_kept(draw_of(l, &to, i)));
}

LANES static void draw_visible(struct facets f, size_t n, struct dirs wo,
                               struct lanes *l, const struct bsdf_samples *to)
{
    if (f.family == NDF_GGX)
        draw_loop(facets_as(f, NDF_GGX), true, n, wo, l, to);
    else
        draw_loop(facets_as(f, NDF_BECKMANN), true, n, wo, l, to);
}

LANES static void draw_all(struct facets f, size_t n, struct dirs wo,
                           struct lanes *l, const struct bsdf_samples *to)
{
    if (f.family == NDF_GGX)
        draw_loop(facets_as(f, NDF_GGX), false, n, wo, l, to);
    else
        draw_loop(facets_as(f, NDF_BECKMANN), false, n, wo, l, to);
}

INLINE void weight_loop(const struct roughconductor *m, struct facets facets,
                        size_t n, struct dirs wo, struct lanes *l,
                        const struct bsdf_samples *drawn)
{
    const struct bsdf_samples s = *drawn;
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        l->shape[i] =
            draw_weight(m, facets, dirs_at(wo, i), draw_of(l, &s, i), l->lo[i]);
}

LANES static void weight_lanes(const struct roughconductor *m, size_t n,
                               struct dirs wo, struct lanes *l,
                               const struct bsdf_samples *drawn)
{
    if (m->facets.family == NDF_GGX)
        weight_loop(m, facets_as(m->facets, NDF_GGX), n, wo, l, drawn);
    else
        weight_loop(m, facets_as(m->facets, NDF_BECKMANN), n, wo, l, drawn);
}

/* band[b] may be NULL. */
INLINE void tint_loop(const struct roughconductor *m, int fresnel, size_t n,
                      const struct lanes *l, double *const *band)
{
    for (int b = 0; b < m->bands; b++) {
        double *const to = band[b];
        LANES_LOOP
        for (size_t i = 0; i < (to ? n : 0); i++)
            to[i] = tinted(m, fresnel, b, l->cos_d[i], l->shape[i]);
    }
}

LANES static void tint_lanes(const struct roughconductor *m, size_t n,
                             const struct lanes *l, double *const *band)
{
    if (m->fresnel == EXACT)
        tint_loop(m, EXACT, n, l, band);
    else if (m->fresnel == APPROX)
        tint_loop(m, APPROX, n, l, band);
    else
        tint_loop(m, SCHLICK, n, l, band);
}

static void eval_many(const void *state, size_t n, struct dirs wo,
                      struct dirs wi, struct spectrum *f)
{
    const struct roughconductor *m = state;
    double band[BANDS_MAX][LANES_MAX] = { { 0 } };
    struct lanes l;
    for (size_t at = 0, k; at < n; at += k) {
        const struct dirs o = dirs_from(wo, at), i = dirs_from(wi, at);
        k = n - at < LANES_MAX ? n - at : LANES_MAX;
        look(m, n, at, k, wo, &l);
        shape_lanes(m, k, o, i, &l);
        tint_lanes(m, k, &l,
                   (double *const[]){ band[0], band[1], band[2], band[3] });
        for (size_t lane = 0; lane < k; lane++)
            f[at + lane] =
                (struct spectrum){ { band[0][lane], band[1][lane],
                                     band[2][lane], band[3][lane] } };
    }
}

static void pdf_many(const void *state, size_t n, struct dirs wo,
                     struct dirs wi, double *p)
{
    const struct roughconductor *m = state;
    struct lanes l;
    for (size_t at = 0, k; at < n; at += k) {
        const struct dirs o = dirs_from(wo, at), i = dirs_from(wi, at);
        k = n - at < LANES_MAX ? n - at : LANES_MAX;
        glance(m, n, at, k, wo, &l);
        if (m->sample_visible)
            density_visible(m->facets, k, o, i, &l, p + at);
        else
            density_all(m->facets, k, o, i, &l, p + at);
    }
}

static void sample_many(const void *state, size_t n, struct dirs wo,
                        struct dirs u, struct bsdf_samples out)
{
    const struct roughconductor *m = state;
    struct lanes l;
    for (size_t at = 0, k; at < n; at += k) {
        const struct dirs o = dirs_from(wo, at), v = dirs_from(u, at);
        k = n - at < LANES_MAX ? n - at : LANES_MAX;
        look(m, n, at, k, wo, &l);
        const struct bsdf_samples to = bsdf_samples_from(&out, at);
        if (m->sample_visible) {
            facets_visible_many(m->facets, k, o, l.one, v, l.hx, l.hy, l.hz);
            draw_visible(m->facets, k, o, &l, &to);
        } else {
            facets_all_many(m->facets, k, v, l.hx, l.hy, l.hz);
            draw_all(m->facets, k, o, &l, &to);
        }
        if (to.weight[0]) {
            weight_lanes(m, k, o, &l, &to);
            tint_lanes(m, k, &l, to.weight);
        }
        memset(to.delta, 0, k * sizeof *to.delta);
    }
}

static double facet_d(const void *state, struct vec3 h)
{
    const struct roughconductor *m = state;
    return h.z > 0 ? facets_d(m->facets, h, vec3_dot(h, h)) : 0;
}

static double facet_g1(const void *state, struct vec3 w)
{
    const struct roughconductor *m = state;
    return 1 / (1 + facets_lambda(m->facets, w));
}

static void index_of(const void *state, struct spectrum *eta,
                     struct spectrum *k)
{
    const struct roughconductor *m = state;
    *eta = m->eta;
    *k = m->k;
}

const struct bsdf_type type_roughconductor = {
    .name = "roughconductor",
    .about = "rough metal (Torrance-Sparrow, Smith)",
    .params = params,
    .size = sizeof(struct roughconductor),
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
