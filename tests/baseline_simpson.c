/* baseline_simpson.c - see the header */
#include "tests/baseline_simpson.h"

#include <math.h>
#include <stdbool.h>

static const float pi = 3.14159265F;

struct fvec {
    float x, y, z;
};

struct fsample {
    struct fvec wi;
    float pdf, weight[3];
};

/* The interface that a renderer's models share. */
struct model {
    float (*pdf)(const struct baseline *b, struct fvec wo, struct fvec wi);
    struct fsample (*sample)(const struct baseline *b, struct fvec wo, float u,
                             float v);
};

/* -- the model ------------------------------------------------------------- */

static float dot(struct fvec a, struct fvec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static struct fvec unit(struct fvec a)
{
    const float s = 1 / sqrtf(dot(a, a));
    return (struct fvec){ s * a.x, s * a.y, s * a.z };
}

static struct fvec half(struct fvec a, struct fvec b)
{
    return unit((struct fvec){ a.x + b.x, a.y + b.y, a.z + b.z });
}

static struct fvec reflect(struct fvec w, struct fvec h)
{
    const float t = 2 * dot(w, h);
    return (struct fvec){ t * h.x - w.x, t * h.y - w.y, t * h.z - w.z };
}

static float tan2(struct fvec w)
{
    return (1 - w.z * w.z) / (w.z * w.z);
}

static float d_beckmann(float alpha, struct fvec h)
{
    const float z2 = h.z * h.z, a2 = alpha * alpha;
    return expf(-tan2(h) / a2) / (pi * a2 * z2 * z2);
}

static float g1_beckmann(float alpha, struct fvec w)
{
    const float t2 = tan2(w);
    if (t2 <= 0)
        return 1;
    const float a = 1 / (alpha * sqrtf(t2));
    return a >= 1.6F ? 1
                     : (3.535F * a + 2.181F * a * a) /
                           (1 + 2.276F * a + 2.577F * a * a);
}

static float d_ggx(float alpha, struct fvec h)
{
    const float a2 = alpha * alpha, t = 1 + (a2 - 1) * h.z * h.z;
    return a2 / (pi * t * t);
}

static float g1_ggx(float alpha, struct fvec w)
{
    return 2 / (1 + sqrtf(1 + alpha * alpha * tan2(w)));
}

static float fresnel(float c, float eta, float k)
{
    const float c2 = c * c, s2 = 1 - c2;
    const float t0 = eta * eta - k * k - s2;
    const float ab = sqrtf(t0 * t0 + 4 * eta * eta * k * k);
    const float a = sqrtf(fmaxf((ab + t0) / 2, 0));
    const float rs = (ab + c2 - 2 * a * c) / (ab + c2 + 2 * a * c);
    const float t3 = c2 * ab + s2 * s2, t4 = 2 * a * c * s2;
    return rs * (1 + (t3 - t4) / (t3 + t4)) / 2;
}

static void weigh(const struct baseline *b, float cos_d, float common,
                  struct fsample *s)
{
    for (int i = 0; i < 3; i++)
        s->weight[i] = common * fresnel(cos_d, b->eta[i], b->k[i]);
}

static float pdf_beckmann(const struct baseline *b, struct fvec wo,
                          struct fvec wi)
{
    if (wo.z <= 0 || wi.z <= 0)
        return 0;
    const struct fvec h = half(wo, wi);
    return d_beckmann(b->alpha, h) * h.z / (4 * dot(wo, h));
}

static struct fsample sample_beckmann(const struct baseline *b, struct fvec wo,
                                      float u, float v)
{
    const float t2 = -b->alpha * b->alpha * log1pf(-u), phi = 2 * pi * v;
    const float z = 1 / sqrtf(1 + t2), r = sqrtf(fmaxf(1 - z * z, 0));
    const struct fvec h = { r * cosf(phi), r * sinf(phi), z };
    struct fsample s = { .wi = reflect(wo, h) };
    const float cos_d = dot(wo, h);
    if (cos_d <= 0 || s.wi.z <= 0)
        return s;
    s.pdf = d_beckmann(b->alpha, h) * z / (4 * cos_d);
    weigh(b, cos_d,
          g1_beckmann(b->alpha, wo) * g1_beckmann(b->alpha, s.wi) * cos_d /
              (wo.z * z),
          &s);
    return s;
}

static float pdf_ggx(const struct baseline *b, struct fvec wo, struct fvec wi)
{
    if (wo.z <= 0 || wi.z <= 0)
        return 0;
    return d_ggx(b->alpha, half(wo, wi)) * g1_ggx(b->alpha, wo) / (4 * wo.z);
}

static struct fsample sample_ggx(const struct baseline *b, struct fvec wo,
                                 float u, float v)
{
    const struct fvec w =
        unit((struct fvec){ b->alpha * wo.x, b->alpha * wo.y, wo.z });
    const float phi = 2 * pi * v, z = (1 - u) * (1 + w.z) - w.z;
    const float r = sqrtf(fmaxf(1 - z * z, 0));
    const struct fvec h =
        unit((struct fvec){ b->alpha * (r * cosf(phi) + w.x),
                            b->alpha * (r * sinf(phi) + w.y), z + w.z });
    struct fsample s = { .wi = reflect(wo, h) };
    const float cos_d = dot(wo, h);
    if (cos_d <= 0 || s.wi.z <= 0)
        return s;
    s.pdf = d_ggx(b->alpha, h) * g1_ggx(b->alpha, wo) / (4 * wo.z);
    weigh(b, cos_d, g1_ggx(b->alpha, s.wi), &s);
    return s;
}

static const struct model models[] = {
    [BASELINE_BECKMANN_ALL] = { pdf_beckmann, sample_beckmann },
    [BASELINE_GGX_VISIBLE] = { pdf_ggx, sample_ggx },
};

/* -- the samples ----------------------------------------------------------- */

static uint32_t pcg32(uint64_t *state)
{
    const uint64_t old = *state;
    *state = old * 6364136223846793005U + 1442695040888963407U;
    const uint32_t mixed = (uint32_t)(((old >> 18) ^ old) >> 27);
    const uint32_t turn = (uint32_t)(old >> 59);
    return mixed >> turn | mixed << (-turn & 31);
}

static float uniform(uint64_t *state)
{
    return (float)(pcg32(state) >> 8) * 0x1p-24F;
}

static struct fvec outgoing(const struct baseline *b)
{
    return (struct fvec){ sinf(b->theta), 0, cosf(b->theta) };
}

static size_t cell(float x, float whole, size_t n)
{
    const long i = (long)(x / whole * (float)n);
    return i < 0 ? 0 : i < (long)n ? (size_t)i : n - 1;
}

double baseline_sample(const struct baseline *b, uint64_t seed, long samples,
                       size_t strips, size_t slices, long *counts)
{
    const struct model *volatile chosen = &models[b->kind];
    const struct model *m = chosen; /* the compiler must not see through it */
    const struct fvec wo = outgoing(b);
    uint64_t state = seed;
    double sum = 0;
    for (long i = 0; i < samples; i++) {
        const float u = uniform(&state), v = uniform(&state);
        const struct fsample s = m->sample(b, wo, u, v);
        sum += (s.weight[0] + s.weight[1] + s.weight[2]) / 3;
        if (s.pdf <= 0)
            continue;
        const float phi = atan2f(s.wi.y, s.wi.x);
        const float theta = acosf(fminf(s.wi.z, 1));
        counts[cell(theta, pi, strips) * slices +
               cell(phi < 0 ? phi + 2 * pi : phi, 2 * pi, slices)]++;
    }
    return sum / (double)samples;
}

/* -- the quadrature -------------------------------------------------------- */

/* The usual tolerance of a bin and depth of the recursion. */
enum { DEPTH = 6 };
static const double tolerance = 1e-6;

struct integrand {
    double (*f)(const struct integrand *self, double x);
    const struct baseline *b;
    const struct model *m;
    struct fvec wo;
    double phi0, phi1, theta;
};

static double panel(const struct integrand *g, double a, double c, double b,
                    double fa, double fc, double fb, double whole, double eps,
                    int deeper)
{
    const double d = (a + c) / 2, e = (c + b) / 2, h = b - a;
    const double fd = g->f(g, d), fe = g->f(g, e);
    const double left = h / 12 * (fa + 4 * fd + fc);
    const double right = h / 12 * (fc + 4 * fe + fb);
    const double off = left + right - whole;
    if (deeper <= 0 || fabs(off) <= 15 * eps)
        return left + right + off / 15;
    return panel(g, a, d, c, fa, fd, fc, left, eps / 2, deeper - 1) +
           panel(g, c, e, b, fc, fe, fb, right, eps / 2, deeper - 1);
}

static double simpson(const struct integrand *g, double a, double b)
{
    const double c = (a + b) / 2;
    const double fa = g->f(g, a), fc = g->f(g, c), fb = g->f(g, b);
    return panel(g, a, c, b, fa, fc, fb, (b - a) / 6 * (fa + 4 * fc + fb),
                 tolerance, DEPTH);
}

static double over_phi(const struct integrand *g, double phi)
{
    const float s = sinf((float)g->theta), c = cosf((float)g->theta);
    const struct fvec wi = { s * cosf((float)phi), s * sinf((float)phi), c };
    return (double)(g->m->pdf(g->b, g->wo, wi) * s);
}

static double over_theta(const struct integrand *g, double theta)
{
    struct integrand inner = *g;
    inner.f = over_phi;
    inner.theta = theta;
    return simpson(&inner, g->phi0, g->phi1);
}

void baseline_integrate(const struct baseline *b, size_t strips, size_t slices,
                        double *mass)
{
    const struct model *volatile chosen = &models[b->kind];
    const double dtheta = M_PI / (double)strips;
    const double dphi = 2 * M_PI / (double)slices;
    struct integrand g = { over_theta, b, chosen, outgoing(b), 0, 0, 0 };
    for (size_t i = 0; i < strips; i++)
        for (size_t k = 0; k < slices; k++) {
            g.phi0 = dphi * (double)k;
            g.phi1 = dphi * (double)(k + 1);
            mass[i * slices + k] =
                simpson(&g, dtheta * (double)i, dtheta * (double)(i + 1));
        }
}

double chi_square_pooled(const long *counts, const double *mass, size_t n,
                         long samples, long *degrees)
{
    double sum = 0, expected = 0, counted = 0;
    *degrees = -1;
    for (size_t i = 0; i < n; i++) {
        expected += mass[i] * (double)samples;
        counted += (double)counts[i];
        if (expected < 5 && i + 1 < n)
            continue;
        if (expected > 0) {
            sum += (counted - expected) * (counted - expected) / expected;
            ++*degrees;
        }
        expected = counted = 0;
    }
    return sum;
}
