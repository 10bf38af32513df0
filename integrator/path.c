/* path.c - a wave of paths, bounce by bounce
 *
 * Rows of random numbers: 0 is the point of the pixel and the first number of
 * the lens, 1 its second; then for each bounce one for the BSDF and one for
 * each light sample, of whose first the third number is for Russian roulette.
 *
 * A path has a slot, where what it has come by is kept.  A bounce goes
 *   trace    rays, of which there is one a living path, meet something
 *   sort     hits are put in groups of one BSDF each, those with delta lobes
 *            alone last; from here on they are vertices
 *   see      what shines against the ray
 *   direct   each light is sampled, the BSDF evaluated, the shadow ray traced
 *   go       the BSDF is sampled, weights are updated, rays start anew
 * in loops over the vertices, which share nothing, so that neither their order
 * nor their company changes a path.
 */
#include "integrator/path.h"

#include <math.h>
#include <stdlib.h>

#include "bsdf/fastmath.h"
#include "integrator/light.h"
#include "integrator/scene_parts.h"

/* How the ray was chosen that is being followed. */
struct chosen {
    bool alone; /* nothing else would have found what it finds */
    double pdf;
    struct vec3 from;
};

/* Vertices of one BSDF. */
struct group {
    const struct bsdf *bsdf;
    unsigned lobes;
    double eta;
    int number; /* of the BSDF in the scene */
    size_t from, n;
};
enum { NO_GROUP = WAVE };

struct paths {
    const struct scene *scene;
    const struct path_settings *settings;
    struct sampler sampler;
    uint64_t rays_traced;

    /* By piece. */
    size_t pieces;
    uint64_t stream[WAVE];
    int x[WAVE], y[WAVE];

    /* By slot. */
    size_t slots;
    uint16_t piece_of[WAVE];
    uint32_t sample_of[WAVE];
    struct path path[WAVE];
    struct spectrum beta[WAVE];
    double compression[WAVE]; /* of radiance, by the path's medium */
    bool albedo_seen[WAVE];
    struct chosen chosen[WAVE];

    /* The rays, then, by vertex, what they hit. */
    size_t n, lit; /* vertices; those that are not of delta lobes alone */
    uint16_t slot[WAVE], piece[WAVE];
    uint32_t sample[WAVE];
    struct rays rays;
    struct queue queue;
    struct met met;
    struct hits hits;
    struct vecs wo; /* local */
    size_t groups;
    struct group group[WAVE];
    uint16_t *group_of_bsdf; /* by its number; NO_GROUP but while sorting */

    /* For direct light and to go on. */
    uint64_t row; /* whose numbers u are; 0 for none */
    struct vecs u;
    struct light_samples light;
    struct vecs wi, dir; /* local, and in the world */
    struct spectrum f[WAVE];
    double pdf[WAVE], weight[WAVE];
    double share[BANDS_MAX][WAVE]; /* a band's weights */
    bool delta[WAVE], wanted[WAVE], blocked[WAVE];
    struct rays other; /* than those that make the path */
    struct met other_met;
    struct hits other_hits;
};

static bool counts(const struct path_settings *p, int bounces)
{
    return bounces <= p->max_depth &&
           (p->only_bounce < 0 || bounces == p->only_bounce);
}

INLINE void add(struct spectrum *sum, double factor, struct spectrum a,
                struct spectrum b)
{
    for (int i = 0; i < BANDS_MAX; i++)
        sum->band[i] += factor * a.band[i] * b.band[i];
}

/* Not a number if one of them is not. */
INLINE double largest(struct spectrum s)
{
    double most = 0, sum = 0;
    for (int b = 0; b < BANDS_MAX; b++) {
        most = fm_max(s.band[b], most);
        sum += s.band[b];
    }
    return isnan(sum) ? sum : most;
}

/* -- random numbers, and who is traced --------------------------------------
 */

static void numbers_into(struct paths *w, size_t n, uint64_t row,
                         struct vecs *u)
{
    const struct sampler_lanes lanes = { w->pieces, w->stream, n, w->piece,
                                         w->sample };
    sampler_row(&w->sampler, row, &lanes, u);
}

/* A row's numbers of every vertex. */
static const struct vecs *numbers(struct paths *w, uint64_t row)
{
    if (w->row != row)
        numbers_into(w, w->n, row, &w->u);
    w->row = row;
    return &w->u;
}

/* A ray's piece and the octant of its direction; those that are not wanted come
 * last. */
enum { OCTANTS = 8, OCTANTS_MAX = OCTANTS * WAVE };
LANES static void octants(const struct vecs *dir, const uint16_t *piece,
                          const bool *wanted, size_t n, uint64_t *octant)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const uint64_t x = dir->x[i] < 0 ? 1 : 0, y = dir->y[i] < 0 ? 2 : 0;
        const uint64_t z = dir->z[i] < 0 ? 4 : 0;
        octant[i] = OCTANTS * (uint64_t)piece[i] + x + y + z;
    }
    for (size_t i = 0; i < n; i++)
        octant[i] = wanted[i] ? octant[i] : OCTANTS_MAX;
}

/* Puts those of n rays that are wanted in the order of pieces, and in a piece
 * in that of octants, as rays that go the same way are traced faster
 * together. */
static void line_up(struct paths *w, size_t n, const struct rays *r)
{
    struct queue *q = &w->queue;
    const size_t last = OCTANTS * w->pieces;
    uint64_t octant[WAVE];
    uint16_t next[OCTANTS_MAX + 1];
    uint16_t ray[2 * WAVE]; /* with those that nobody wants */
    octants(&r->dir, w->piece, w->wanted, n, octant);
    for (size_t k = 0; k < last; k++)
        next[k] = 0;
    next[OCTANTS_MAX] = 0;
    for (size_t i = 0; i < n; i++)
        next[octant[i]]++;
    q->n = 0;
    for (size_t k = 0; k < last; k++) {
        const uint16_t more = next[k];
        next[k] = (uint16_t)q->n;
        q->n += more;
    }
    next[OCTANTS_MAX] = WAVE;
    for (size_t i = 0; i < n; i++)
        ray[next[octant[i]]++] = (uint16_t)i;
    for (size_t k = 0; k < q->n; k++) {
        q->ray[k] = ray[k];
        q->piece[k] = w->piece[ray[k]];
    }
    w->rays_traced += q->n;
}

/* -- directions that no model chose -----------------------------------------
 */

/* One vertex, for what is done one by one. */
struct vertex {
    const struct group *group;
    struct vec3 wo;
};

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
    const unsigned lobes = v->group->lobes;
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
                              bsdf_eval(v->group->bsdf, v->wo, s.wi));
    return s;
}

static struct bsdf_sample around_or_delta(const struct vertex *v,
                                          enum path_sampling how, struct vec3 u)
{
    if (!(v->group->lobes & BSDF_DELTA))
        return around(v, how, u);
    struct bsdf_sample s;
    if (heads(&u.z)) {
        s = bsdf_sample(v->group->bsdf, v->wo, u);
        s.weight = spectrum_scale(s.delta ? 2 : 0, s.weight);
    } else {
        s = around(v, how, u);
        s.weight = spectrum_scale(2, s.weight);
        s.pdf /= 2;
    }
    return s;
}

/* The density at which around_or_delta takes a direction. */
static double around_density(const struct vertex *v, enum path_sampling how,
                             struct vec3 wi)
{
    const unsigned lobes = v->group->lobes;
    const bool transmits = lobes & BSDF_TRANSMISSION & ~(unsigned)BSDF_DELTA;
    const double shares =
        (transmits ? 0.5 : 1) * (lobes & BSDF_DELTA ? 0.5 : 1);
    if (!transmits && wi.z * v->wo.z < 0)
        return 0;
    return shares * (how == PATH_COSINE ? fabs(wi.z) / PI : 1 / (2 * PI));
}

/* Where every vertex goes on, by numbers u: wi, pdf, share and delta. */
static void choose(struct paths *w, const struct vecs *u)
{
    const enum path_sampling how = w->settings->sampling;
    const struct bsdf_samples all = { w->wi.x,
                                      w->wi.y,
                                      w->wi.z,
                                      w->pdf,
                                      { w->share[0], w->share[1], w->share[2],
                                        w->share[3] },
                                      w->delta };
    for (const struct group *g = w->group; g < w->group + w->groups; g++) {
        if (how == PATH_BSDF || g->from >= w->lit) {
            bsdf_sample_into(g->bsdf, g->n, vecs_dirs(&w->wo, g->from),
                             vecs_dirs(u, g->from),
                             bsdf_samples_from(&all, g->from));
            continue;
        }
        for (size_t i = g->from; i < g->from + g->n; i++) {
            const struct vertex v = { g, vecs_at(&w->wo, i) };
            const struct bsdf_sample a =
                around_or_delta(&v, how, vecs_at(u, i));
            bsdf_samples_put(&all, i, &a);
        }
    }
}

/* The density at which choose takes wi, of lit vertices. */
static void densities(struct paths *w)
{
    const enum path_sampling how = w->settings->sampling;
    for (const struct group *g = w->group; g < w->group + w->groups; g++) {
        if (g->from >= w->lit)
            continue;
        if (how == PATH_BSDF) {
            bsdf_pdf_many(g->bsdf, g->n, vecs_dirs(&w->wo, g->from),
                          vecs_dirs(&w->wi, g->from), w->pdf + g->from);
            continue;
        }
        for (size_t i = g->from; i < g->from + g->n; i++) {
            const struct vertex v = { g, vecs_at(&w->wo, i) };
            w->pdf[i] = around_density(&v, how, vecs_at(&w->wi, i));
        }
    }
}

/* -- what rays see ----------------------------------------------------------
 */

/* The balance heuristic: n samples of density a against one of density b. */
INLINE double balance(double n, double a, double b)
{
    return n * a / (n * a + b);
}

static double emission_weight(const struct paths *w, const struct chosen *by,
                              int light, struct vec3 dir,
                              const struct light_hit *hit)
{
    if (by->alone || w->settings->direct == PATH_HIT)
        return 1;
    if (w->settings->direct != PATH_MIS)
        return 0;
    const double pdf = light_pdf(w->scene, light, by->from, dir, hit);
    return 1 - balance(w->settings->light_samples, pdf, by->pdf);
}

/* A ray that leaves the scene. */
static void see_background(struct paths *w, size_t ray)
{
    const size_t slot = w->slot[ray];
    const struct vec3 dir = vecs_at(&w->rays.dir, ray);
    for (int i = 0; i < light_count(w->scene); i++) {
        if (!light_is_infinite(w->scene, i))
            continue;
        const struct spectrum l = light_background(w->scene, i, dir);
        if (largest(l) > 0)
            add(&w->path[slot].radiance,
                emission_weight(w, &w->chosen[slot], i, dir, NULL),
                w->beta[slot], l);
    }
}

/* What surfaces emit against the rays. */
static void see_emission(struct paths *w)
{
    const struct hits *h = &w->hits;
    for (size_t i = 0; i < w->n; i++) {
        const size_t slot = w->slot[i];
        const struct chosen *by = &w->chosen[slot];
        const struct shape *a = h->shape[i];
        if (!h->emits[i] || !(by->alone || !a->surface.unsampled))
            continue;
        const struct light_hit at = { vecs_at(&h->point, i),
                                      vecs_at(&h->normal, i) };
        const double weight =
            emission_weight(w, by, a->light, (struct vec3){ 0 }, &at);
        add(&w->path[slot].radiance, weight, w->beta[slot],
            a->surface.radiance);
    }
}

/* All that emits against a ray that was not chosen for its sake. */
static struct spectrum emission(const struct scene *s, const struct shape *a,
                                bool emits, struct vec3 dir)
{
    struct spectrum sum = { { 0 } };
    const struct spectrum one = spectrum_of(BANDS_MAX, 1);
    if (a)
        return emits ? a->surface.radiance : sum;
    for (int i = 0; i < light_count(s); i++)
        if (light_is_infinite(s, i))
            add(&sum, 1, one, light_background(s, i, dir));
    return sum;
}

/* -- direct light -----------------------------------------------------------
 */

LANES static void to_local(const struct hits *h, size_t n, const struct vecs *v,
                           double sign, struct vecs *local)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct frame f = hits_frame(h, i);
        vecs_put(local, i, vec3_scale(sign, frame_to_local(&f, vecs_at(v, i))));
    }
}

LANES static void to_world(const struct hits *h, size_t n, const struct vecs *v,
                           struct vecs *world)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++) {
        const struct frame f = hits_frame(h, i);
        vecs_put(world, i, frame_to_world(&f, vecs_at(v, i)));
    }
}

/* What a light's sample counts, of several; pdf 0 for it alone. */
LANES static void light_weights(size_t n, double several, const double *wi_z,
                                const double *light_pdf, const double *pdf,
                                double *weight)
{
    LANES_LOOP
    for (size_t i = 0; i < n; i++)
        weight[i] = fabs(wi_z[i]) / light_pdf[i] *
                    balance(several, light_pdf[i], pdf[i]);
}

/* What a vertex sends on, by its f, of light that arrives there. */
INLINE void gain(struct paths *w, size_t vertex, double factor,
                 struct spectrum light)
{
    const size_t slot = w->slot[vertex];
    add(&w->path[slot].radiance, factor, w->beta[slot],
        spectrum_mul(w->f[vertex], light));
}

/* One sample of a light for every lit vertex. */
static void from_light(struct paths *w, int light, const struct vecs *u)
{
    const struct path_settings *p = w->settings;
    const size_t n = w->lit;
    light_sample(w->scene, light, n, &w->hits.point, u, p->compat, &w->light);
    to_local(&w->hits, n, &w->light.wi, 1, &w->wi);
    for (const struct group *g = w->group; g < w->group + w->groups; g++)
        if (g->from < n)
            bsdf_eval_many(g->bsdf, g->n, vecs_dirs(&w->wo, g->from),
                           vecs_dirs(&w->wi, g->from), w->f + g->from);
    if (p->direct == PATH_MIS && light_can_be_hit(w->scene, light))
        densities(w);
    else
        for (size_t i = 0; i < n; i++)
            w->pdf[i] = 0;
    light_weights(n, p->light_samples, w->wi.z, w->light.pdf, w->pdf,
                  w->weight);
    if (light_is_infinite(w->scene, light))
        trace_from(&w->hits, n, &w->light.wi, &w->other);
    else
        trace_to(&w->hits, n, &w->light.wi, &w->light.point, &w->other);
    for (size_t i = 0; i < n; i++)
        w->wanted[i] = w->light.pdf[i] > 0 && largest(w->f[i]) != 0;
    line_up(w, n, &w->other);
    trace_blocked(w->scene, &w->other, &w->queue, w->blocked);
    const double share = 1.0 / p->light_samples;
    for (size_t i = 0; i < n; i++)
        if (w->wanted[i] && !w->blocked[i])
            gain(w, i, share * w->weight[i], w->light.radiance[i]);
}

/* One of a number of uniform directions for every lit vertex. */
static void from_hemisphere(struct paths *w, const struct vecs *u,
                            double number)
{
    const size_t n = w->lit;
    for (const struct group *g = w->group; g < w->group + w->groups; g++)
        for (size_t i = g->from; g->from < n && i < g->from + g->n; i++) {
            const struct vertex v = { g, vecs_at(&w->wo, i) };
            const struct bsdf_sample a =
                around(&v, PATH_UNIFORM, vecs_at(u, i));
            vecs_put(&w->wi, i, a.wi);
            w->f[i] = a.weight;
            w->wanted[i] = largest(a.weight) != 0;
        }
    to_world(&w->hits, n, &w->wi, &w->dir);
    trace_from(&w->hits, n, &w->dir, &w->other);
    line_up(w, n, &w->other);
    trace_rays(w->scene, &w->other, &w->queue, false, &w->other_met);
    uint16_t there[WAVE], there_n = 0;
    for (size_t k = 0; k < w->queue.n; k++) {
        const uint16_t i = w->queue.ray[k];
        if (w->other_met.shape[i])
            there[there_n++] = i;
        else
            gain(w, i, 1 / number,
                 emission(w->scene, NULL, false, vecs_at(&w->dir, i)));
    }
    struct hits *h = &w->other_hits;
    trace_places(&w->other, &w->other_met, there, there_n, h);
    for (size_t k = 0; k < there_n; k++)
        gain(w, there[k], 1 / number,
             emission(w->scene, h->shape[k], h->emits[k], (struct vec3){ 0 }));
}

/* Whether a light's samples are uniform directions, each of which sees all. */
static bool blind(const struct paths *w, int light)
{
    return w->settings->direct == PATH_HEMISPHERE &&
           !light_is_point(w->scene, light);
}

/* The direct light of the lit vertices; its rows of numbers begin at row. */
static void direct(struct paths *w, uint64_t row)
{
    const struct path_settings *p = w->settings;
    const int lights = light_count(w->scene);
    double blinds = 0;
    for (int i = 0; i < lights; i++)
        blinds += blind(w, i) ? p->light_samples : 0;
    for (int i = 0; i < lights; i++) {
        if (p->direct == PATH_HIT && light_can_be_hit(w->scene, i))
            continue;
        for (int k = 0; k < p->light_samples; k++, row++) {
            if (blind(w, i))
                from_hemisphere(w, numbers(w, row), blinds);
            else
                from_light(w, i, numbers(w, row));
        }
    }
}

/* -- from one vertex to the next --------------------------------------------
 */

/* Divides the weight by the probability to go on; false if it does not. */
static bool roulette(const struct path_settings *p, double u,
                     double radiance_scale, struct spectrum *beta)
{
    const double q = p->rr_probability > 0
                         ? p->rr_probability
                         : fmin(0.95, largest(*beta) * radiance_scale);
    if (!(u < q))
        return false;
    *beta = spectrum_scale(1 / q, *beta);
    return true;
}

/* What sampling the BSDF makes of a path; false where it ends. */
static bool weigh(struct paths *w, const struct group *g, size_t i)
{
    const size_t slot = w->slot[i];
    struct spectrum weight, *beta = &w->beta[slot];
    for (int b = 0; b < BANDS_MAX; b++)
        weight.band[b] = w->share[b][i];
    if (!w->delta[i] && !w->albedo_seen[slot]) {
        w->albedo_seen[slot] = true;
        w->path[slot].albedo = weight;
    }
    *beta = spectrum_mul(*beta, weight);
    const double most = largest(*beta);
    if (!isfinite(most))
        w->path[slot].radiance.band[0] = NAN; /* which is not lost */
    if (!(most > 0))
        return false;
    if (w->wo.z[i] * w->wi.z[i] < 0)
        w->compression[slot] *=
            w->wo.z[i] > 0 ? g->eta * g->eta : 1 / (g->eta * g->eta);
    return true;
}

/* Of the rays that are the last of their paths, those that may see light. */
static void want_light(struct paths *w)
{
    const struct path_settings *p = w->settings;
    const bool found = p->direct == PATH_MIS || p->direct == PATH_HIT;
    bool toward[WAVE];
    trace_toward_light(w->scene, &w->rays, w->n, toward);
    for (size_t i = 0; i < w->n; i++)
        w->wanted[i] = w->wanted[i] && toward[i] && counts(p, p->max_depth) &&
                       (found || w->delta[i]);
}

static void go_on(struct paths *w, uint64_t row, int bounces)
{
    const struct path_settings *p = w->settings;
    struct vecs u;
    numbers_into(w, w->n, row, &u);
    choose(w, &u);
    for (const struct group *g = w->group; g < w->group + w->groups; g++)
        for (size_t i = g->from; i < g->from + g->n; i++) {
            w->wanted[i] = weigh(w, g, i);
            w->chosen[w->slot[i]] =
                (struct chosen){ w->delta[i], w->pdf[i],
                                 vecs_at(&w->hits.point, i) };
        }
    if (bounces + 1 >= p->rr_depth) {
        const struct vecs *v = numbers(w, row + 1);
        for (size_t i = 0; i < w->n; i++) {
            const size_t slot = w->slot[i];
            w->wanted[i] =
                w->wanted[i] &&
                roulette(p, v->z[i], w->compression[slot], &w->beta[slot]);
        }
    }
    to_world(&w->hits, w->n, &w->wi, &w->dir);
    trace_from(&w->hits, w->n, &w->dir, &w->rays);
    if (bounces + 1 == p->max_depth)
        want_light(w);
    line_up(w, w->n, &w->rays);
}

/* -- a bounce ---------------------------------------------------------------
 */

/* The group of a BSDF; a new one if need be. */
static uint16_t group_of(struct paths *w, const struct shape *a)
{
    uint16_t *const known = &w->group_of_bsdf[a->surface.bsdf];
    if (*known == NO_GROUP) {
        *known = (uint16_t)w->groups;
        w->group[w->groups++] = (struct group){
            a->bsdf, a->claims.lobes, a->claims.eta, a->surface.bsdf, 0, 0
        };
    }
    w->group[*known].n++;
    return *known;
}

static bool delta_only(const struct group *g)
{
    return !(g->lobes & ~(unsigned)BSDF_DELTA);
}

/* Those with delta lobes alone come last, and else groups are in the order of
 * BSDFs, so that the vertices of a piece are in one that is its own. */
static bool before(const struct group *a, const struct group *b)
{
    return delta_only(a) != delta_only(b) ? delta_only(b)
                                          : a->number < b->number;
}

/* Where the vertices of each group begin. */
static void lay_out(struct paths *w)
{
    uint16_t order[WAVE];
    for (size_t k = 0; k < w->groups; k++) {
        size_t i = k;
        for (; i > 0 && before(&w->group[k], &w->group[order[i - 1]]); i--)
            order[i] = order[i - 1];
        order[i] = (uint16_t)k;
    }
    w->n = w->lit = 0;
    for (size_t k = 0; k < w->groups; k++) {
        struct group *g = &w->group[order[k]];
        g->from = w->n;
        w->n += g->n;
        if (!delta_only(g))
            w->lit = w->n;
    }
}

/* Vertices of the rays of the queue that hit something, in groups. */
static void sort(struct paths *w)
{
    const struct queue *q = &w->queue;
    uint16_t ray[WAVE], slot[WAVE], group[WAVE];
    size_t at[WAVE];
    w->groups = 0;
    for (size_t k = 0; k < q->n; k++)
        if (w->met.shape[q->ray[k]])
            group[k] = group_of(w, w->met.shape[q->ray[k]]);
    lay_out(w);
    for (size_t k = 0; k < w->groups; k++) {
        at[k] = w->group[k].from;
        w->group_of_bsdf[w->group[k].number] = NO_GROUP;
    }
    for (size_t k = 0; k < q->n; k++)
        if (w->met.shape[q->ray[k]]) {
            const size_t to = at[group[k]]++;
            ray[to] = q->ray[k];
            slot[to] = w->slot[q->ray[k]];
        }
    w->row = 0;
    for (size_t k = 0; k < w->n; k++) {
        w->slot[k] = slot[k];
        w->piece[k] = w->piece_of[slot[k]];
        w->sample[k] = w->sample_of[slot[k]];
        vecs_put(&w->dir, k, vecs_at(&w->rays.dir, ray[k]));
    }
    trace_places(&w->rays, &w->met, ray, w->n, &w->hits);
    to_local(&w->hits, w->n, &w->dir, -1, &w->wo);
}

static void note_first(struct paths *w)
{
    for (size_t i = 0; i < w->slots; i++)
        w->path[i].depth = w->met.shape[i] ? w->met.distance[i] : 0;
    for (size_t i = 0; i < w->n; i++)
        w->path[w->slot[i]].normal = vecs_at(&w->hits.n, i);
}

static void leave_camera(struct paths *w)
{
    const struct camera *c = scene_camera(w->scene);
    struct vecs u, lens = { .x = { 0 } };
    for (size_t i = 0; i < w->slots; i++) {
        w->slot[i] = (uint16_t)i;
        w->piece[i] = w->piece_of[i];
        w->sample[i] = w->sample_of[i];
        w->wanted[i] = true;
    }
    w->n = w->slots;
    numbers_into(w, w->n, 0, &u);
    if (c->lens_radius > 0)
        numbers_into(w, w->n, 1, &lens);
    for (size_t i = 0; i < w->n; i++) {
        u.x[i] += w->x[w->piece[i]];
        u.y[i] += w->y[w->piece[i]];
    }
    camera_rays(c, w->n, u.x, u.y, u.z, lens.x, &w->rays);
    line_up(w, w->n, &w->rays);
}

static void begin(struct paths *w)
{
    const struct spectrum one = spectrum_of(scene_bands(w->scene)->count, 1);
    for (size_t i = 0; i < w->slots; i++) {
        w->path[i] = (struct path){ .depth = 0 };
        w->beta[i] = one;
        w->compression[i] = 1;
        w->albedo_seen[i] = false;
        w->chosen[i] = (struct chosen){ .alone = true };
    }
    leave_camera(w);
}

const struct path *paths_trace(struct paths *w, uint64_t *rays)
{
    const struct path_settings *p = w->settings;
    const uint64_t lights =
        (uint64_t)light_count(w->scene) * (uint64_t)p->light_samples;
    const uint64_t rows = 1 + (lights > 0 ? lights : 1);
    w->rays_traced = 0;
    begin(w);
    for (int bounces = 0; w->queue.n > 0; bounces++) {
        const uint64_t row = 2 + (uint64_t)bounces * rows;
        trace_rays(w->scene, &w->rays, &w->queue, bounces == 0, &w->met);
        for (size_t k = 0; counts(p, bounces) && k < w->queue.n; k++)
            if (!w->met.shape[w->queue.ray[k]])
                see_background(w, w->queue.ray[k]);
        sort(w);
        if (counts(p, bounces))
            see_emission(w);
        if (bounces == 0)
            note_first(w);
        if (bounces == p->max_depth)
            break;
        if (counts(p, bounces + 1) && w->lit > 0)
            direct(w, row + 1);
        go_on(w, row, bounces);
    }
    *rays += w->rays_traced;
    w->slots = w->pieces = 0;
    return w->path;
}

/* -- waves ------------------------------------------------------------------
 */

struct paths *paths_new(const struct scene *s, const struct path_settings *p,
                        struct sampler sampler)
{
    struct paths *w = calloc(1, sizeof *w);
    uint16_t *group = malloc((s->bsdfs + 1) * sizeof *group);
    if (!w || !group) {
        free(w);
        free(group);
        return NULL;
    }
    for (size_t i = 0; i < s->bsdfs; i++)
        group[i] = NO_GROUP;
    w->scene = s;
    w->settings = p;
    w->sampler = sampler;
    w->group_of_bsdf = group;
    return w;
}

void paths_free(struct paths *w)
{
    if (w)
        free(w->group_of_bsdf);
    free(w);
}

bool paths_add(struct paths *w, int x, int y, uint64_t stream, uint64_t first,
               size_t n)
{
    const size_t piece = w->pieces;
    if (w->slots + n > WAVE)
        return false;
    w->x[piece] = x;
    w->y[piece] = y;
    w->stream[piece] = stream;
    w->pieces++;
    for (size_t i = 0; i < n; i++, w->slots++) {
        w->piece_of[w->slots] = (uint16_t)piece;
        w->sample_of[w->slots] = (uint32_t)(first + i);
    }
    return true;
}
