/* baseline_tracer.c - camera, bounce, lamp; nothing else
 *
 * [1] D. Blackman and S. Vigna, Scrambled linear pseudorandom number
 *     generators, ACM TOMS 47(4), 2021: xoshiro128+; its states start from
 *     splitmix64.
 * [2] J. T. Kajiya, The rendering equation, SIGGRAPH 1986.
 * [3] T. Duff et al., Building an orthonormal basis, revisited, JCGT 6(1),
 *     2017.
 */
#include "tests/baseline_tracer.h"

#include <embree3/rtcore.h>
#include <math.h>
#include <omp.h>
#include <stdalign.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef __SSE__
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

enum { TILE = 16, BUNCH = 16 };
enum { SINGLE, COHERENT }; /* rays */
static const float pi = 3.14159265f;
/* A ray starts and ends this far off, of the distance from the world's origin
 * and of its own length. */
static const float off = 1e-4f;

/* -- vectors --------------------------------------------------------------- */

struct v3 {
    float x, y, z;
};

static inline struct v3 v3(float x, float y, float z)
{
    return (struct v3){ x, y, z };
}

static inline struct v3 load(const float *p)
{
    return v3(p[0], p[1], p[2]);
}

static inline struct v3 add(struct v3 a, struct v3 b)
{
    return v3(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline struct v3 sub(struct v3 a, struct v3 b)
{
    return v3(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline struct v3 scale(struct v3 a, float s)
{
    return v3(a.x * s, a.y * s, a.z * s);
}

static inline struct v3 mul(struct v3 a, struct v3 b)
{
    return v3(a.x * b.x, a.y * b.y, a.z * b.z);
}

static inline float dot(struct v3 a, struct v3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct v3 cross(struct v3 a, struct v3 b)
{
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
              a.x * b.y - a.y * b.x);
}

static inline struct v3 unit(struct v3 a)
{
    return scale(a, 1 / sqrtf(dot(a, a)));
}

/* -- random numbers -------------------------------------------------------- */

struct random {
    uint32_t s[4];
};

static uint64_t splitmix(uint64_t *x)
{
    uint64_t z = *x += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
}

static struct random random_at(uint64_t seed, uint64_t pixel)
{
    uint64_t x = seed;
    x = splitmix(&x) ^ pixel;
    const uint64_t a = splitmix(&x), b = splitmix(&x);
    return (struct random){ { (uint32_t)a, (uint32_t)(a >> 32), (uint32_t)b,
                              (uint32_t)(b >> 32) | 1 } };
}

/* In [0, 1), a multiple of 2^-24. */
static inline float uniform(struct random *r)
{
    uint32_t *s = r->s;
    const uint32_t sum = s[0] + s[3], t = s[1] << 9;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= t;
    s[3] = s[3] << 11 | s[3] >> 21;
    return (float)(sum >> 8) * 0x1p-24f;
}

/* -- rays ------------------------------------------------------------------ */

/* What all threads look at. */
struct view {
    const struct tracer_scene *scene;
    RTCScene embree;
    struct v3 eye, right, down, corner; /* of the picture, at a distance of 1 */
    struct v3 light_normal, light_u, light_v, light_corner, radiance;
    float light_area;
    int depth, samples;
    uint64_t seed;
};

struct counts {
    uint64_t rays;
};

static inline struct RTCRay ray(struct v3 o, struct v3 d, float near, float far)
{
    return (struct RTCRay){ .org_x = o.x,
                            .org_y = o.y,
                            .org_z = o.z,
                            .tnear = near,
                            .dir_x = d.x,
                            .dir_y = d.y,
                            .dir_z = d.z,
                            .tfar = far,
                            .mask = ~0u };
}

/* What a ray hit: where, and the normal on the ray's side. */
struct hit {
    struct v3 p, n;
    const float *albedo; /* NULL of the lamp */
    bool emits;
};

static inline struct hit hit_at(const struct view *w, struct v3 p, struct v3 d,
                                struct v3 normal, unsigned triangle)
{
    const int m = w->scene->material[triangle];
    const bool front = dot(normal, d) < 0, lamp = m == w->scene->light.lamp;
    return (struct hit){
        .p = p,
        .n = unit(front ? normal : scale(normal, -1)),
        .albedo = lamp ? NULL : w->scene->albedo + 3 * m,
        .emits = lamp && front,
    };
}

static inline bool trace(const struct view *w, struct RTCIntersectContext *c,
                         struct v3 o, struct v3 d, float near, struct hit *h)
{
    struct RTCRayHit r = { .ray = ray(o, d, near, INFINITY),
                           .hit.geomID = RTC_INVALID_GEOMETRY_ID };
    rtcIntersect1(w->embree, c, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    *h = hit_at(w, add(o, scale(d, r.ray.tfar)), d,
                v3(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z), r.hit.primID);
    return true;
}

/* -- paths ----------------------------------------------------------------- */

/* sin and cos of 2 pi u, by Taylor's series of half the angle from the middle:
 * within 1e-6. */
static inline void turn(float u, float *sine, float *cosine)
{
    const float t = pi * (u - 0.5f), t2 = t * t;
    const float s =
        t * (1 + t2 * (-1.f / 6 +
                       t2 * (1.f / 120 +
                             t2 * (-1.f / 5040 +
                                   t2 * (1.f / 362880 - t2 / 39916800)))));
    const float c =
        1 + t2 * (-1.f / 2 +
                  t2 * (1.f / 24 +
                        t2 * (-1.f / 720 + t2 * (1.f / 40320 - t2 / 3628800))));
    *sine = -2 * s * c;
    *cosine = 2 * s * s - 1;
}

/* By the cosine around n [3]. */
static inline struct v3 bounce(struct v3 n, struct random *r)
{
    const float radius2 = uniform(r), radius = sqrtf(radius2);
    float x, y;
    turn(uniform(r), &y, &x);
    x *= radius;
    y *= radius;
    const float z = sqrtf(1 - radius2);
    const float sign = copysignf(1, n.z);
    const float a = -1 / (sign + n.z), b = n.x * n.y * a;
    const struct v3 s = v3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    const struct v3 t = v3(b, sign + n.y * n.y * a, -n.y);
    return add(add(scale(s, x), scale(t, y)), scale(n, z));
}

/* Light that arrives from a point of the lamp, times the albedo's 1 / pi. */
static inline struct v3 direct(const struct view *w,
                               struct RTCIntersectContext *c,
                               const struct hit *h, float near,
                               struct random *r, struct counts *count)
{
    const struct v3 q = add(add(w->light_corner, scale(w->light_u, uniform(r))),
                            scale(w->light_v, uniform(r)));
    const struct v3 d = sub(q, h->p);
    const float here = dot(d, h->n), there = -dot(d, w->light_normal);
    if (here <= 0 || there <= 0)
        return v3(0, 0, 0);
    const float d2 = dot(d, d), length = sqrtf(d2);
    struct RTCRay shadow =
        ray(h->p, scale(d, 1 / length), near, length * (1 - off));
    count->rays++;
    rtcOccluded1(w->embree, c, &shadow);
    if (shadow.tfar < 0)
        return v3(0, 0, 0);
    return scale(w->radiance, here * there * w->light_area / (pi * d2 * d2));
}

/* Of a path that goes on from what the camera saw. */
static struct v3 path(const struct view *w, struct RTCIntersectContext *c,
                      struct hit h, struct random *r, struct counts *count)
{
    struct v3 sum = h.emits ? w->radiance : v3(0, 0, 0), weight = v3(1, 1, 1);
    for (int i = 1; h.albedo && i <= w->depth; i++) {
        const float near =
            off * (1 + fabsf(h.p.x) + fabsf(h.p.y) + fabsf(h.p.z));
        weight = mul(weight, load(h.albedo));
        sum = add(sum, mul(weight, direct(w, c, &h, near, r, count)));
        if (i == w->depth)
            break;
        count->rays++;
        if (!trace(w, c, h.p, bounce(h.n, r), near, &h))
            break;
    }
    return sum;
}

/* -- pictures -------------------------------------------------------------- */

/* The rays of a packet of samples of one pixel; valid is -1 of those. */
static void aim(const struct view *w, int x, int y, int n, struct random *r,
                int valid[BUNCH], struct RTCRayHit16 *p)
{
    const struct camera *camera = &w->scene->camera;
    for (int i = 0; i < BUNCH; i++) {
        const struct v3 d =
            add(add(w->corner, scale(w->right, (float)x + uniform(r))),
                scale(w->down, (float)y + uniform(r)));
        const float length = sqrtf(dot(d, d));
        valid[i] = i < n ? -1 : 0;
        p->ray.org_x[i] = w->eye.x;
        p->ray.org_y[i] = w->eye.y;
        p->ray.org_z[i] = w->eye.z;
        p->ray.tnear[i] = (float)camera->near * length;
        p->ray.dir_x[i] = d.x / length;
        p->ray.dir_y[i] = d.y / length;
        p->ray.dir_z[i] = d.z / length;
        p->ray.time[i] = 0;
        p->ray.tfar[i] = (float)camera->far * length;
        p->ray.mask[i] = ~0u;
        p->ray.id[i] = p->ray.flags[i] = 0;
        p->hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
}

static struct v3 packet(const struct view *w, struct RTCIntersectContext c[2],
                        int x, int y, int n, struct random *r,
                        struct counts *count)
{
    alignas(64) int valid[BUNCH];
    struct RTCRayHit16 p;
    struct v3 sum = v3(0, 0, 0);
    aim(w, x, y, n, r, valid, &p);
    rtcIntersect16(valid, w->embree, &c[COHERENT], &p);
    count->rays += (uint64_t)n;
    for (int i = 0; i < n; i++) {
        if (p.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID)
            continue;
        const struct v3 d = v3(p.ray.dir_x[i], p.ray.dir_y[i], p.ray.dir_z[i]);
        const struct hit h = hit_at(
            w, add(w->eye, scale(d, p.ray.tfar[i])), d,
            v3(p.hit.Ng_x[i], p.hit.Ng_y[i], p.hit.Ng_z[i]), p.hit.primID[i]);
        sum = add(sum, path(w, &c[SINGLE], h, r, count));
    }
    return sum;
}

static void pixel(const struct view *w, struct RTCIntersectContext c[2], int x,
                  int y, float *rgb, struct counts *count)
{
    struct random r = random_at(
        w->seed, (uint64_t)y * (uint64_t)w->scene->camera.width + (uint64_t)x);
    struct v3 sum = v3(0, 0, 0);
    for (int i = 0; i < w->samples; i += BUNCH) {
        const int left = w->samples - i;
        sum = add(sum,
                  packet(w, c, x, y, left < BUNCH ? left : BUNCH, &r, count));
    }
    rgb[0] = sum.x / (float)w->samples;
    rgb[1] = sum.y / (float)w->samples;
    rgb[2] = sum.z / (float)w->samples;
}

static void tile(const struct view *w, struct RTCIntersectContext c[2],
                 int left, int top, float *rgb, struct counts *count)
{
    const int width = w->scene->camera.width, height = w->scene->camera.height;
    for (int y = top; y < top + TILE && y < height; y++)
        for (int x = left; x < left + TILE && x < width; x++)
            pixel(w, c, x, y, rgb + 3 * ((size_t)y * (size_t)width + (size_t)x),
                  count);
}

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void render(const struct view *w, int threads, float *rgb,
                   struct tracer_result *result)
{
    const int across = (w->scene->camera.width + TILE - 1) / TILE;
    const int down = (w->scene->camera.height + TILE - 1) / TILE;
    const double start = seconds(CLOCK_MONOTONIC);
    double cpu = 0;
    uint64_t rays = 0;
#pragma omp parallel num_threads(threads) reduction(+ : cpu, rays)
    {
        const double from = seconds(CLOCK_THREAD_CPUTIME_ID);
#ifdef __SSE__
        const unsigned mode = _mm_getcsr();
        _mm_setcsr(mode | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
#endif
        struct RTCIntersectContext c[2];
        struct counts count = { 0 };
        rtcInitIntersectContext(&c[SINGLE]);
        rtcInitIntersectContext(&c[COHERENT]);
        c[COHERENT].flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#pragma omp for schedule(dynamic, 1) nowait
        for (int i = 0; i < across * down; i++)
            tile(w, c, i % across * TILE, i / across * TILE, rgb, &count);
#ifdef __SSE__
        _mm_setcsr(mode);
#endif
        rays += count.rays;
        cpu += seconds(CLOCK_THREAD_CPUTIME_ID) - from;
    }
    result->wall_s = seconds(CLOCK_MONOTONIC) - start;
    result->cpu_s = cpu;
    result->rays = rays;
    result->paths = (uint64_t)w->scene->camera.width *
                    (uint64_t)w->scene->camera.height * (uint64_t)w->samples;
}

/* -- setting up ------------------------------------------------------------ */

/* x of the camera is to the left; near and far are along its z. */
static void look(struct view *w)
{
    const struct camera *c = &w->scene->camera;
    struct v3 axis[4];
    for (int j = 0; j < 4; j++)
        axis[j] = v3((float)c->to_world.m[0][j], (float)c->to_world.m[1][j],
                     (float)c->to_world.m[2][j]);
    const float pixel_size = (float)(1 / c->focal);
    w->eye = axis[3];
    w->right = scale(axis[0], -pixel_size);
    w->down = scale(axis[1], -pixel_size);
    w->corner = add(axis[2], add(scale(w->right, -0.5f * (float)c->width),
                                 scale(w->down, -0.5f * (float)c->height)));
}

static void light(struct view *w)
{
    const struct tracer_scene *s = w->scene;
    w->light_corner = load(s->light.corner);
    w->light_u = load(s->light.u);
    w->light_v = load(s->light.v);
    w->radiance = load(s->light.radiance);
    const struct v3 n = cross(w->light_u, w->light_v);
    w->light_area = sqrtf(dot(n, n));
    w->light_normal = unit(n);
}

static bool attach(RTCDevice device, RTCScene scene,
                   const struct tracer_scene *s)
{
    const RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *xyz =
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), s->vertices);
    unsigned *index =
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), s->triangles);
    if (xyz && index) {
        memcpy(xyz, s->xyz, 3 * s->vertices * sizeof *xyz);
        memcpy(index, s->index, 3 * s->triangles * sizeof *index);
        rtcCommitGeometry(g);
        rtcAttachGeometry(scene, g);
        rtcCommitScene(scene);
    }
    rtcReleaseGeometry(g);
    return rtcGetDeviceError(device) == RTC_ERROR_NONE;
}

bool tracer_render(const struct tracer_scene *scene,
                   const struct tracer_options *options, float *rgb,
                   struct tracer_result *result, struct err *err)
{
    struct view w = {
        .scene = scene,
        .depth = options->depth,
        .samples = options->samples,
        .seed = options->seed,
    };
    const RTCDevice device = rtcNewDevice(NULL);
    if (!device)
        return err_set(err, "Embree cannot start");
    w.embree = rtcNewScene(device);
    const double start = seconds(CLOCK_MONOTONIC);
    const bool ok = attach(device, w.embree, scene);
    result->build_s = seconds(CLOCK_MONOTONIC) - start;
    look(&w);
    light(&w);
    if (ok)
        render(&w, options->threads ? options->threads : omp_get_max_threads(),
               rgb, result);
    rtcReleaseScene(w.embree);
    rtcReleaseDevice(device);
    return ok || err_set(err, "Embree cannot build the scene");
}

/* -- the scene of the bench ------------------------------------------------ */

enum { WHITE, RED, BLUE, LAMP, MATERIALS };

static const float albedos[3 * MATERIALS] = {
    .6f, .6f, .6f, .6f, .2f, .2f, .2f, .2f, .6f, 0, 0, 0,
};

struct builder {
    float *xyz;
    unsigned *index;
    unsigned char *material;
    unsigned vertices, triangles;
};

static void vertex(struct builder *b, double x, double y, double z)
{
    float *p = b->xyz + 3 * (size_t)b->vertices++;
    p[0] = (float)x;
    p[1] = (float)y;
    p[2] = (float)z;
}

static void triangle(struct builder *b, unsigned i, unsigned j, unsigned k,
                     int material)
{
    unsigned *t = b->index + 3 * (size_t)b->triangles;
    t[0] = i;
    t[1] = j;
    t[2] = k;
    b->material[b->triangles++] = (unsigned char)material;
}

/* The normal is along u x v. */
static void quad(struct builder *b, const double c[3], const double u[3],
                 const double v[3], int material)
{
    const unsigned i = b->vertices;
    for (int k = 0; k < 4; k++) {
        const double s = k == 1 || k == 2, t = k >= 2;
        vertex(b, c[0] + s * u[0] + t * v[0], c[1] + s * u[1] + t * v[1],
               c[2] + s * u[2] + t * v[2]);
    }
    triangle(b, i, i + 1, i + 2, material);
    triangle(b, i, i + 2, i + 3, material);
}

/* A sphere with waves on it, 2 n (n - 1) triangles. */
static void blob(struct builder *b, unsigned n)
{
    const unsigned first = b->vertices;
    for (unsigned i = 0; i <= n; i++)
        for (unsigned j = 0; j < n; j++) {
            const double theta = (double)pi * i / n;
            const double phi = 2 * (double)pi * j / n;
            const double r = 0.42 * (1 + 0.12 * sin(theta) * sin(theta) *
                                             sin(7 * phi) * sin(9 * theta));
            vertex(b, r * sin(theta) * cos(phi), 0.5 + r * cos(theta),
                   r * sin(theta) * sin(phi));
        }
    for (unsigned i = 0; i < n; i++)
        for (unsigned j = 0; j < n; j++) {
            const unsigned p = first + i * n + j;
            const unsigned q = first + i * n + (j + 1) % n;
            if (i > 0)
                triangle(b, p, q, p + n, WHITE);
            if (i + 1 < n)
                triangle(b, q, q + n, p + n, WHITE);
        }
}

static void walls(struct builder *b)
{
    quad(b, (double[]){ -1, 0, 1 }, (double[]){ 2, 0, 0 },
         (double[]){ 0, 0, -2 }, WHITE); /* floor */
    quad(b, (double[]){ -1, 1.5, -1 }, (double[]){ 2, 0, 0 },
         (double[]){ 0, 0, 2 }, WHITE); /* ceiling */
    quad(b, (double[]){ -1, 0, -1 }, (double[]){ 2, 0, 0 },
         (double[]){ 0, 1.5, 0 }, WHITE); /* back */
    quad(b, (double[]){ -1, 0, 1 }, (double[]){ 0, 0, -2 },
         (double[]){ 0, 1.5, 0 }, RED); /* left */
    quad(b, (double[]){ 1, 0, -1 }, (double[]){ 0, 0, 2 },
         (double[]){ 0, 1.5, 0 }, BLUE); /* right */
    quad(b, (double[]){ -.4, 1.49, -.3 }, (double[]){ .8, 0, 0 },
         (double[]){ 0, 0, .6 }, LAMP);
}

bool tracer_box(struct tracer_scene *scene, size_t triangles, struct err *err)
{
    const unsigned n = (unsigned)fmax(3, round(sqrt((double)triangles / 2)));
    const size_t most = 2 * (size_t)n * n + 12;
    const size_t vertices = (size_t)n * (n + 1) + 24;
    struct builder b = {
        .xyz = malloc(3 * vertices * sizeof(float)),
        .index = malloc(3 * most * sizeof(unsigned)),
        .material = malloc(most),
    };
    if (!b.xyz || !b.index || !b.material) {
        free(b.xyz);
        free(b.index);
        free(b.material);
        return err_set(err, "out of memory");
    }
    walls(&b);
    blob(&b, n);
    *scene = (struct tracer_scene){
        .xyz = b.xyz,
        .vertices = b.vertices,
        .index = b.index,
        .triangles = b.triangles,
        .material = b.material,
        .albedo = albedos,
        .materials = MATERIALS,
        .light = { .corner = { -.4f, 1.49f, -.3f },
                   .u = { .8f, 0, 0 },
                   .v = { 0, 0, .6f },
                   .radiance = { 10, 10, 10 },
                   .lamp = LAMP },
        .camera = { .to_world = { { { -1, 0, 0, 0 },
                                    { 0, 1, 0, .75 },
                                    { 0, 0, -1, 4.802344 } } },
                    .width = 480,
                    .height = 360,
                    .focal = 875,
                    .near = 0.1,
                    .far = 100 },
    };
    return true;
}

void tracer_box_free(struct tracer_scene *scene)
{
    free((void *)scene->xyz);
    free((void *)scene->index);
    free((void *)scene->material);
    *scene = (struct tracer_scene){ 0 };
}
