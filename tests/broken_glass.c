/* broken_glass.c - rough glass and a pane, each with its mistakes */
#include "bsdf/fresnel.h"
#include "bsdf/medium.h"
#include "bsdf/ndf.h"
#include "tests/broken.h"

/* What is wrong is mixed in with a share of size, 1 if not given. */
enum fault {
    NONE,
    JACOBIAN,    /* |wo.h| for n^2 |wi.h| in the pdf of refraction [1] */
    BACK_FACING, /* facets that face away are kept [1] */
    NO_SIDES,    /* the pdf knows facets that the sampler refuses [2] */
    SAME_SIDE,   /* the refracted f is added on the side of wo [3] */
    UNORIENTED,  /* F with the index of the upper side, whatever side [4] */
    SWAPPED,     /* wi and wo are swapped in f and pdf [8] */
    NO_SHARE,    /* the pdf of refraction lacks 1 - F [20] */
    G1_BELOW,    /* G1 is 0 below, in f [21] */
    NO_SQUARE,   /* f lacks the squared index of radiance */
};

static const char *const faults[] = {
    "none",      "jacobian",   "back_facing", "no_sides",
    "same_side", "unoriented", "swapped",     "no_share",
    "g1_below",  "no_square",  NULL,
};

struct glass {
    double alpha, eta, size;
    int fault;
};

static const struct bsdf_param glass_params[] = {
    { "alpha", BSDF_NUMBER, offsetof(struct glass, alpha), "0.4", 1e-4, 1, NULL,
      "roughness" },
    { "eta", BSDF_NUMBER, offsetof(struct glass, eta), "1.5", 1, 10, NULL,
      "index below" },
    { "fault", BSDF_CHOICE, offsetof(struct glass, fault), "none", 0, 0, faults,
      "what is wrong" },
    { "size", BSDF_NUMBER, offsetof(struct glass, size), "1", 0, 1, NULL,
      "share of it" },
    { 0 },
};

static struct bsdf_claims glass_claims(const void *state,
                                       const struct bands *bands)
{
    const struct glass *m = state;
    (void)bands;
    return (struct bsdf_claims){
        .lobes = BSDF_GLOSSY_REFLECTION | BSDF_GLOSSY_TRANSMISSION,
        .reciprocal = true,
        .two_sided = true,
        .eta = m->eta,
    };
}

static double mixed(double right, double wrong, double share)
{
    return right + share * (wrong - right);
}

static double fresnel(const struct glass *m, double c, double n)
{
    const double right = fresnel_dielectric(fmin(c, 1), n, NULL);
    return m->fault != UNORIENTED
               ? right
               : mixed(right, fresnel_dielectric(fmin(c, 1), m->eta, NULL),
                       m->size);
}

/* 1 less that, with the digits that the difference would lose. */
static double through(const struct glass *m, double co, double ci, double n)
{
    const double right = fresnel_dielectric_through(fmin(co, 1), ci, n);
    return m->fault != UNORIENTED
               ? right
               : mixed(right, 1 - fresnel_dielectric(fmin(co, 1), m->eta, NULL),
                       m->size);
}

struct turn {
    bool exists, reflects;
    struct vec3 h;
    double n, co, ci, square, share;
};

static struct turn turn_of(const struct glass *m, struct vec3 wo,
                           struct vec3 wi, bool reflects)
{
    struct turn t = { .reflects = reflects,
                      .n = wo.z > 0 ? m->eta : 1 / m->eta };
    const struct vec3 sum = vec3_add(wo, vec3_scale(reflects ? 1 : t.n, wi));
    t.square = vec3_dot(sum, sum);
    t.h = vec3_scale(copysign(1, sum.z) / sqrt(t.square), sum);
    t.co = vec3_dot(wo, t.h) * copysign(1, wo.z);
    t.ci = vec3_dot(wi, t.h) * copysign(1, wi.z);
    t.exists = (t.co > 0 && t.ci > 0) || m->fault == BACK_FACING ||
               (m->fault == SAME_SIDE && !reflects && wo.z * wi.z > 0);
    t.co = fabs(t.co);
    t.ci = fabs(t.ci);
    t.share = reflects ? fresnel(m, t.co, t.n) : through(m, t.co, t.ci, t.n);
    return t;
}

static double d(const struct glass *m, struct vec3 h)
{
    return ndf_d(&ndf_beckmann, m->alpha, m->alpha, h);
}

static double g1(const struct glass *m, struct vec3 w)
{
    return ndf_g1(&ndf_beckmann, m->alpha, m->alpha, w);
}

static double f_of(const struct glass *m, struct vec3 wo, struct vec3 wi,
                   bool reflects)
{
    const struct turn t = turn_of(m, wo, wi, reflects);
    if (!t.exists || (m->fault == G1_BELOW && (wo.z <= 0 || wi.z <= 0)))
        return 0;
    const double common =
        t.share * d(m, t.h) * g1(m, wo) * g1(m, wi) / fabs(wo.z * wi.z);
    return reflects                ? common / 4
           : m->fault == NO_SQUARE ? common * t.co * t.ci * t.n * t.n / t.square
                                   : common * t.co * t.ci / t.square;
}

static double pdf_of(const struct glass *m, struct vec3 wo, struct vec3 wi)
{
    const struct turn t = turn_of(m, wo, wi, wo.z * wi.z > 0);
    if ((!t.exists && m->fault != NO_SIDES) || wo.z * wi.z == 0)
        return 0;
    const double p = d(m, t.h) * t.h.z;
    if (t.reflects)
        return t.share * p / (4 * t.co);
    const double jacobian =
        (m->fault == JACOBIAN ? t.co : t.n * t.n * t.ci) / t.square;
    return (m->fault == NO_SHARE ? 1 : t.share) * p * jacobian;
}

static double f_as_is(const struct glass *m, struct vec3 wo, struct vec3 wi)
{
    const bool reflects = wo.z * wi.z > 0;
    if (m->fault == SWAPPED)
        return f_of(m, wi, wo, reflects);
    return f_of(m, wo, wi, reflects) +
           (m->fault == SAME_SIDE && reflects ? f_of(m, wo, wi, false) : 0);
}

static double pdf_as_is(const struct glass *m, struct vec3 wo, struct vec3 wi)
{
    return m->fault == SWAPPED ? pdf_of(m, wi, wo) : pdf_of(m, wo, wi);
}

/* The same without the fault.  F is mixed where it is made. */
static struct glass mended(const struct glass *m)
{
    struct glass right = *m;
    right.fault = m->fault == UNORIENTED ? UNORIENTED : NONE;
    return right;
}

static struct spectrum glass_eval(const void *state, struct vec3 wo,
                                  struct vec3 wi)
{
    const struct glass *m = state, right = mended(m);
    if (wo.z * wi.z == 0)
        return (struct spectrum){ { 0 } };
    return spectrum_of(
        3, mixed(f_as_is(&right, wo, wi), f_as_is(m, wo, wi), m->size));
}

static double glass_pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct glass *m = state, right = mended(m);
    return mixed(pdf_as_is(&right, wo, wi), pdf_as_is(m, wo, wi), m->size);
}

static struct bsdf_sample glass_sample(const void *state, struct vec3 wo,
                                       struct vec3 u)
{
    const struct glass *m = state;
    const struct bsdf_sample refused = { 0 };
    const double side = copysign(1, wo.z), n = wo.z > 0 ? m->eta : 1 / m->eta;
    const struct vec3 h =
        ndf_sample_all(&ndf_beckmann, m->alpha, m->alpha, u.x, u.y);
    const double c = vec3_dot(wo, h) * side;
    if (!(c > 0) || wo.z == 0)
        return refused;
    double cos_t;
    (void)fresnel_dielectric(fmin(c, 1), n, &cos_t);
    const bool reflects = u.z < fresnel(m, c, n);
    if (!reflects && cos_t == 0)
        return refused;
    const struct vec3 wi =
        reflects ? vec3_unit(vec3_reflect(wo, h))
                 : medium_refract(wo, vec3_scale(side, h), n, cos_t);
    if ((wo.z * wi.z > 0) != reflects)
        return refused;
    const double pdf = glass_pdf(m, wo, wi);
    if (!(pdf > 0))
        return refused;
    return (struct bsdf_sample){
        .wi = wi,
        .pdf = pdf,
        .weight = spectrum_scale(fabs(wi.z) / pdf, glass_eval(m, wo, wi)),
    };
}

const struct bsdf_type type_broken_glass = {
    .name = "broken_glass",
    .about = "rough glass with a fault",
    .params = glass_params,
    .size = sizeof(struct glass),
    .claims = glass_claims,
    .eval = glass_eval,
    .pdf = glass_pdf,
    .sample = glass_sample,
};

struct pane {
    double eta, size;
    int fault;
};

enum { SIGNED = 1, COMPLEMENT };
static const char *const pane_faults[] = { "none", "signed", "complement",
                                           NULL };
static const struct bsdf_param pane_params[] = {
    { "eta", BSDF_NUMBER, offsetof(struct pane, eta), "1.5", 1, 10, NULL,
      "index of the pane" },
    { "fault", BSDF_CHOICE, offsetof(struct pane, fault), "none", 0, 0,
      pane_faults, "what is wrong" },
    { "size", BSDF_NUMBER, offsetof(struct pane, size), "1", 0, 1, NULL,
      "share of it" },
    { 0 },
};

static struct bsdf_claims pane_claims(const void *state,
                                      const struct bands *bands)
{
    (void)state, (void)bands;
    return (struct bsdf_claims){ .lobes = BSDF_DELTA_REFLECTION |
                                          BSDF_DELTA_TRANSMISSION,
                                 .reciprocal = true,
                                 .two_sided = true,
                                 .eta = 1 };
}

/* What the front and the back of a pane reflect together. */
static double pane_all(const struct pane *m, double c)
{
    const double r = fresnel_dielectric(c, m->eta, NULL);
    return 2 * r / (1 + r);
}

/* Half of what is reflected is absorbed. */
static struct bsdf_sample pane_sample(const void *state, struct vec3 wo,
                                      struct vec3 u)
{
    const struct pane *m = state;
    const double tint = 0.5, c = fmin(fabs(wo.z), 1);
    if (wo.z == 0)
        return (struct bsdf_sample){ 0 };
    double all = pane_all(m, c);
    if (m->fault == SIGNED)
        all = mixed(all, pane_all(m, fmin(wo.z, 1)), m->size);
    const bool reflects = u.z < all;
    const double through = m->fault == COMPLEMENT
                               ? mixed(1, (1 - tint * all) / (1 - all), m->size)
                               : 1;
    return (struct bsdf_sample){
        .wi =
            reflects ? (struct vec3){ -wo.x, -wo.y, wo.z } : vec3_scale(-1, wo),
        .pdf = reflects ? all : 1 - all,
        .weight = spectrum_of(3, reflects ? tint : through),
        .delta = true,
    };
}

const struct bsdf_type type_broken_pane = {
    .name = "broken_pane",
    .about = "pane of glass with a fault",
    .params = pane_params,
    .size = sizeof(struct pane),
    .claims = pane_claims,
    .sample = pane_sample,
};
