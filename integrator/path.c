/* path.c - one path
 *
 * Rows of random numbers: 0 is the point of the pixel and the first number of
 * the lens, 1 its second; then for each bounce one for the BSDF and one for
 * each light sample, of whose first the third number is for Russian roulette.
 */
#include "integrator/path.h"

#include <math.h>

#include "integrator/light.h"

/* A vertex of a path, and what it is seen along. */
struct vertex {
    const struct scene *scene;
    const struct path_settings *settings;
    struct hit hit;
    struct vec3 wo; /* local */
    unsigned *rays;
};

static bool counts(const struct path_settings *p, int bounces)
{
    return bounces <= p->max_depth &&
           (p->only_bounce < 0 || bounces == p->only_bounce);
}

static void add(struct spectrum *sum, double factor, struct spectrum a,
                struct spectrum b)
{
    for (int i = 0; i < BANDS_MAX; i++)
        sum->band[i] += factor * a.band[i] * b.band[i];
}

/* Not a number if one of them is not. */
static double largest(struct spectrum s)
{
    double most = 0, sum = 0;
    for (int b = 0; b < BANDS_MAX; b++) {
        most = s.band[b] > most ? s.band[b] : most;
        sum += s.band[b];
    }
    return isnan(sum) ? sum : most;
}

/* -- directions that no model chose -----------------------------------------
 */

/* Over the hemisphere above, by the cosine or uniform. */
static struct vec3 hemisphere(enum path_sampling how, double u, double v,
                              double *pdf)
{
    const double z = how == PATH_COSINE ? sqrt(1 - u) : 1 - u;
    const double r = sqrt(fmax(0, 1 - z * z));
    *pdf = how == PATH_COSINE ? z / PI : 1 / (2 * PI);
    return (struct vec3){ r * cos(2 * PI * v), r * sin(2 * PI * v), z };
}

/* Takes half of the times from a number, which stays uniform. */
static bool heads(double *u)
{
    const bool head = *u < 0.5;
    *u = head ? 2 * *u : 2 * *u - 1;
    return head;
}

/* Sampled as stated at the top of path.h; all zeros if it leads nowhere. */
static struct bsdf_sample around(const struct vertex *v, enum path_sampling how,
                                 struct vec3 u)
{
    const unsigned lobes = v->hit.claims->lobes;
    const bool transmits = lobes & BSDF_TRANSMISSION & ~(unsigned)BSDF_DELTA;
    struct bsdf_sample s = { .pdf = 0 };
    s.wi = hemisphere(how, u.x, u.y, &s.pdf);
    if (transmits) {
        s.pdf /= 2;
        s.wi.z = heads(&u.z) ? -s.wi.z : s.wi.z;
    }
    if (v->wo.z < 0)
        s.wi.z = -s.wi.z;
    if (!(s.pdf > 0))
        return (struct bsdf_sample){ .pdf = 0 };
    s.weight = spectrum_scale(fabs(s.wi.z) / s.pdf,
                              bsdf_eval(v->hit.bsdf, v->wo, s.wi));
    return s;
}

static struct bsdf_sample next(const struct vertex *v, struct vec3 u)
{
    const unsigned lobes = v->hit.claims->lobes;
    const enum path_sampling how = v->settings->sampling;
    if (how == PATH_BSDF || !(lobes & ~(unsigned)BSDF_DELTA))
        return bsdf_sample(v->hit.bsdf, v->wo, u);
    if (!(lobes & BSDF_DELTA))
        return around(v, how, u);
    struct bsdf_sample s;
    if (heads(&u.z)) {
        s = bsdf_sample(v->hit.bsdf, v->wo, u);
        s.weight = spectrum_scale(s.delta ? 2 : 0, s.weight);
    } else {
        s = around(v, how, u);
        s.weight = spectrum_scale(2, s.weight);
        s.pdf /= 2;
    }
    return s;
}

/* -- direct light -----------------------------------------------------------
 */

/* The balance heuristic: n samples of density a against one of density b. */
static double balance(double n, double a, double b)
{
    return n * a / (n * a + b);
}

/* The density at which next() takes a direction. */
static double density(const struct vertex *v, struct vec3 wi)
{
    const unsigned lobes = v->hit.claims->lobes;
    const enum path_sampling how = v->settings->sampling;
    if (how == PATH_BSDF)
        return bsdf_pdf(v->hit.bsdf, v->wo, wi);
    const bool transmits = lobes & BSDF_TRANSMISSION & ~(unsigned)BSDF_DELTA;
    const double shares =
        (transmits ? 0.5 : 1) * (lobes & BSDF_DELTA ? 0.5 : 1);
    if (!transmits && wi.z * v->wo.z < 0)
        return 0;
    return shares * (how == PATH_COSINE ? fabs(wi.z) / PI : 1 / (2 * PI));
}

/* What one sample of a light sends through the vertex, before the weights of
 * the path and of the number of samples. */
static struct spectrum from_light(const struct vertex *v, int light, double a,
                                  double b)
{
    const struct path_settings *p = v->settings;
    const struct hit *hit = &v->hit;
    struct spectrum sum = { { 0 } };
    const struct light_sample l =
        light_sample(v->scene, light, hit->point, a, b, p->compat);
    if (!(l.pdf > 0))
        return sum;
    const struct vec3 wi = frame_to_local(&hit->shading, l.wi);
    const struct spectrum f = bsdf_eval(hit->bsdf, v->wo, wi);
    if (largest(f) == 0)
        return sum;
    double weight = fabs(wi.z) / l.pdf;
    if (p->direct == PATH_MIS && !l.delta && light_can_be_hit(v->scene, light))
        weight *= balance(p->light_samples, l.pdf, density(v, wi));
    const struct ray ray =
        l.infinite ? trace_from(hit, l.wi) : trace_to(hit, l.wi, l.point);
    ++*v->rays;
    if (!trace_blocked(v->scene, &ray))
        add(&sum, weight, f, l.radiance);
    return sum;
}

/* What a ray that was not chosen for its sake sees: all that emits. */
static struct spectrum emission(const struct scene *s, const struct hit *hit,
                                bool there, struct vec3 dir)
{
    struct spectrum sum = { { 0 } };
    const struct spectrum one = spectrum_of(BANDS_MAX, 1);
    if (there)
        return hit->emits ? hit->surface->radiance : sum;
    for (int i = 0; i < light_count(s); i++)
        add(&sum, 1, one, light_background(s, i, dir));
    return sum;
}

static struct spectrum from_hemisphere(const struct vertex *v, struct vec3 u)
{
    struct spectrum sum = { { 0 } };
    const struct bsdf_sample s = around(v, PATH_UNIFORM, u);
    if (largest(s.weight) == 0)
        return sum;
    const struct vec3 dir = frame_to_world(&v->hit.shading, s.wi);
    const struct ray ray = trace_from(&v->hit, dir);
    struct hit hit;
    ++*v->rays;
    const bool there = trace_hit(v->scene, &ray, &hit);
    add(&sum, 1, s.weight, emission(v->scene, &hit, there, dir));
    return sum;
}

/* The direct light of a vertex; its rows of numbers begin at row. */
static struct spectrum direct(const struct vertex *v, struct sampler *sampler,
                              uint64_t row)
{
    const struct path_settings *p = v->settings;
    const struct spectrum one = spectrum_of(BANDS_MAX, 1);
    const int n = p->light_samples, lights = light_count(v->scene);
    struct spectrum sum = { { 0 } }, blind = { { 0 } };
    int blinds = 0;
    for (int i = 0; i < lights; i++) {
        const bool found = light_can_be_hit(v->scene, i);
        if (p->direct == PATH_HIT && found)
            continue;
        const bool uniform =
            p->direct == PATH_HEMISPHERE && !light_is_point(v->scene, i);
        for (int k = 0; k < n; k++, row++) {
            const struct vec3 u = sampler_row(sampler, row);
            if (uniform)
                add(&blind, 1, one, from_hemisphere(v, u));
            else
                add(&sum, 1.0 / n, one, from_light(v, i, u.x, u.y));
        }
        blinds += uniform ? n : 0;
    }
    if (blinds > 0) /* each of them sees all the lights */
        add(&sum, 1.0 / blinds, one, blind);
    return sum;
}

/* -- the path ---------------------------------------------------------------
 */

/* How the ray was chosen that is being followed. */
struct chosen {
    bool alone; /* nothing else would have found what it finds */
    double pdf;
    struct vec3 from;
};

static double emission_weight(const struct scene *s,
                              const struct path_settings *p,
                              const struct chosen *by, int light,
                              struct vec3 dir, const struct hit *hit)
{
    if (by->alone || p->direct == PATH_HIT)
        return 1;
    if (p->direct != PATH_MIS)
        return 0;
    const double pdf = light_pdf(s, light, by->from, dir, hit);
    return 1 - balance(p->light_samples, pdf, by->pdf);
}

/* What is emitted against the ray, times the weight of the path so far. */
static void see(const struct scene *s, const struct path_settings *p,
                const struct chosen *by, const struct ray *ray,
                const struct hit *hit, struct spectrum beta,
                struct spectrum *sum)
{
    if (hit) {
        const bool found =
            hit->emits && (by->alone || !hit->surface->unsampled);
        if (found)
            add(sum, emission_weight(s, p, by, hit->light, ray->dir, hit), beta,
                hit->surface->radiance);
        return;
    }
    for (int i = 0; i < light_count(s); i++) {
        const struct spectrum l = light_background(s, i, ray->dir);
        if (largest(l) > 0)
            add(sum, emission_weight(s, p, by, i, ray->dir, NULL), beta, l);
    }
}

/* Divides the weight by the probability to go on; false if it does not. */
static bool roulette(const struct path_settings *p, int bounces, double u,
                     double radiance_scale, struct spectrum *beta)
{
    if (bounces < p->rr_depth)
        return true;
    const double q = p->rr_probability > 0
                         ? p->rr_probability
                         : fmin(0.95, largest(*beta) * radiance_scale);
    if (!(u < q))
        return false;
    *beta = spectrum_scale(1 / q, *beta);
    return true;
}

static struct ray camera_sample(const struct scene *s, int x, int y,
                                struct sampler *sampler)
{
    const struct camera *c = scene_camera(s);
    const struct vec3 u = sampler_row(sampler, 0);
    const double v = c->lens_radius > 0 ? sampler_row(sampler, 1).x : 0;
    return camera_ray(c, x + u.x, y + u.y, u.z, v);
}

struct path path_trace(const struct scene *s, const struct path_settings *p,
                       int x, int y, struct sampler *sampler)
{
    struct path out = { .rays = 0 };
    struct vertex v; /* the hit is filled by rays, and large */
    v.scene = s;
    v.settings = p;
    v.rays = &out.rays;
    struct ray ray = camera_sample(s, x, y, sampler);
    struct chosen by = { .alone = true };
    struct spectrum beta = spectrum_of(scene_bands(s)->count, 1);
    double compression = 1; /* of radiance, by the medium that the path is in */
    bool seen_albedo = false;
    const uint64_t lights =
        (uint64_t)light_count(s) * (uint64_t)p->light_samples;
    const uint64_t rows = 1 + (lights > 0 ? lights : 1);
    for (int bounces = 0;; bounces++) {
        const uint64_t row = 2 + (uint64_t)bounces * rows;
        out.rays++;
        const bool there = trace_hit(s, &ray, &v.hit);
        if (counts(p, bounces))
            see(s, p, &by, &ray, there ? &v.hit : NULL, beta, &out.radiance);
        if (there && bounces == 0) {
            out.depth = v.hit.distance;
            out.normal = v.hit.shading.n;
        }
        if (!there || bounces == p->max_depth)
            break;
        v.wo = frame_to_local(&v.hit.shading, vec3_scale(-1, ray.dir));
        const bool delta_only = !(v.hit.claims->lobes & ~(unsigned)BSDF_DELTA);
        if (!delta_only && counts(p, bounces + 1))
            add(&out.radiance, 1, beta, direct(&v, sampler, row + 1));
        const struct bsdf_sample next_one = next(&v, sampler_row(sampler, row));
        if (!next_one.delta && !seen_albedo) {
            seen_albedo = true;
            out.albedo = next_one.weight;
        }
        beta = spectrum_mul(beta, next_one.weight);
        if (!isfinite(largest(beta)))
            out.radiance.band[0] = NAN; /* which is not lost */
        if (!(largest(beta) > 0))
            break;
        if (v.wo.z * next_one.wi.z < 0)
            compression *= v.wo.z > 0
                               ? v.hit.claims->eta * v.hit.claims->eta
                               : 1 / (v.hit.claims->eta * v.hit.claims->eta);
        if (!roulette(p, bounces + 1, sampler_row(sampler, row + 1).z,
                      compression, &beta))
            break;
        by = (struct chosen){ next_one.delta, next_one.pdf, v.hit.point };
        ray = trace_from(&v.hit, frame_to_world(&v.hit.shading, next_one.wi));
    }
    return out;
}
