/* compare.c - Welch's t over blocks of pixels, and what it can see
 *
 * Of a block, with va and vb the variances of a pixel's two means, na and nb
 * their counts, sums over its pixels:
 *
 *   t  = sum(b - a) / sqrt(sum v)
 *   nu = (sum v)^2 / sum(v^2 / nu_v)
 *
 * where v is va with nu_v = na - 1 and vb with nb - 1 (Welch), or what both
 * together say of either, with na + nb - 2 (pooled) [1]; the larger sum wins,
 * and nu is at most (sum v)^2 / sum(v^2) / 2 - 1.
 * Numbers that are no further apart than a film's float can tell are equal.
 *
 * The power is that of the non-central t by the normal approximation of [2],
 * 26.7.10: P(t' <= t) = Phi((t (1 - 1 / (4 nu)) - delta) /
 * sqrt(1 + t^2 / (2 nu))).
 *
 * [1] F. E. Satterthwaite, An approximate distribution of estimates of variance
 *     components, Biometrics Bulletin 2, 1946.
 * [2] M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions, 1964.
 */
#include "integrator/compare.h"

#include <assert.h>
#include <float.h>
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

#include "validate/pvalue.h"

enum { BLOCK = 20 };
static const double carriers_enough = 16; /* of a block */
static const double default_significance = 1e-6, power = 0.99;
static const double full_colour = 6; /* [standard errors] */

/* One channel of a block, or of the picture. */
struct test {
    int x, y, width, height, channel;
    bool bad;
    double mean;           /* of A */
    double difference;     /* of the means, B less A, as far as it is sure */
    double error, freedom; /* standard error of the difference, nu */
    double p;
};

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static int larger(int a, int b)
{
    return a > b ? a : b;
}

/* -- pixels ---------------------------------------------------------------- */

static const struct film_pixel *at(const struct film *f, int x, int y)
{
    return &f->pixel[(size_t)y * (size_t)f->width + (size_t)x];
}

static bool bad_channel(const struct film_pixel *p, int c)
{
    return !isfinite(p->mean[c]) || !isfinite(p->variance[c]) ||
           p->variance[c] < 0;
}

static bool check(const struct film *f, const char *which, struct err *err)
{
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++)
            if (at(f, x, y)->count < 2)
                return err_set(
                    err,
                    "the %s picture has %u samples at (%d, %d), expected at "
                    "least 2, and variance.R, .G, .B of their mean",
                    which, at(f, x, y)->count, x, y);
    return true;
}

static void find_bad(const struct film *a, const struct film *b,
                     struct comparison *r)
{
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            int c = 0;
            while (c < 3 && !bad_channel(at(a, x, y), c) &&
                   !bad_channel(at(b, x, y), c))
                c++;
            if (c == 3)
                continue;
            if (r->bad++)
                continue;
            r->x = x;
            r->y = y;
            r->channel = c;
            r->width = r->height = 1;
        }
}

/* Of the luminance and of its variance, B over A, where both are finite. */
static void find_ratios(const struct film *a, const struct film *b,
                        struct comparison *r)
{
    double sum_a = 0, sum_b = 0, variance_a = 0, variance_b = 0;
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; i++) {
        const double la = film_luminance(a->pixel[i].mean);
        const double lb = film_luminance(b->pixel[i].mean);
        if (!isfinite(la) || !isfinite(lb))
            continue;
        sum_a += la;
        sum_b += lb;
        variance_a += (double)a->pixel[i].luminance_variance;
        variance_b += (double)b->pixel[i].luminance_variance;
    }
    r->ratio = sum_b / sum_a;
    r->variance_ratio = variance_b / variance_a;
}

/* -- one test -------------------------------------------------------------- */

/* Sums of v, v^2 and v^2 / nu_v. */
struct spread {
    double v, v2, v2_nu;
};

static void add(struct spread *s, double v, double freedom)
{
    s->v += v;
    s->v2 += v * v;
    s->v2_nu += v * v / freedom;
}

static double freedom(const struct spread *s)
{
    const double v2 = s->v * s->v;
    return v2 > 0 ? fmax(1, fmin(v2 / s->v2_nu, v2 / s->v2 / 2 - 1)) : 1;
}

static double p_value(const struct test *t)
{
    if (t->difference == 0)
        return 1;
    if (t->error == 0)
        return pvalue_impossible;
    const double p =
        2 * gsl_cdf_tdist_Q(fabs(t->difference) / t->error, t->freedom);
    return fmax(p, pvalue_impossible);
}

static void sum_pixels(struct test *t, const struct film *fa,
                       const struct film *fb)
{
    const int c = t->channel;
    const double pixels = (double)t->width * t->height;
    double sum_a = 0, sum_b = 0, rounding = 0;
    struct spread welch = { 0 }, pooled = { 0 };
    for (int y = t->y; y < t->y + t->height; y++)
        for (int x = t->x; x < t->x + t->width; x++) {
            const struct film_pixel *a = at(fa, x, y), *b = at(fb, x, y);
            t->bad = t->bad || bad_channel(a, c) || bad_channel(b, c);
            const double na = a->count, nb = b->count;
            const double va = (double)a->variance[c];
            const double vb = (double)b->variance[c];
            sum_a += (double)a->mean[c];
            sum_b += (double)b->mean[c];
            rounding += (double)FLT_EPSILON / 2 * fabs((double)a->mean[c]) +
                        (double)FLT_EPSILON / 2 * fabs((double)b->mean[c]);
            add(&welch, va, na - 1);
            add(&welch, vb, nb - 1);
            add(&pooled,
                ((na - 1) * na * va + (nb - 1) * nb * vb) / (na + nb - 2) *
                    (1 / na + 1 / nb),
                na + nb - 2);
        }
    const struct spread s = pooled.v > welch.v ? pooled : welch;
    const double d = sum_b - sum_a;
    t->mean = sum_a / pixels;
    t->difference = copysign(fmax(fabs(d) - rounding, 0), d) / pixels;
    t->error = sqrt(s.v) / pixels;
    t->freedom = freedom(&s);
    t->p = t->bad ? 1 : p_value(t);
}

static double z_of(const struct test *t)
{
    if (t->bad)
        return NAN;
    return t->difference == 0 ? 0 : t->difference / t->error;
}

/* -- how large a block must be --------------------------------------------- */

/* The pixels that carry the variance of one channel of one picture, which is
 * taken relative to the mean of both in the block around. */
static double carriers(const struct film *f, const struct film *other, int c)
{
    double sum = 0, squares = 0;
    for (int top = 0; top < f->height; top += BLOCK)
        for (int left = 0; left < f->width; left += BLOCK) {
            struct test t = { .x = left,
                              .y = top,
                              .width = smaller(BLOCK, f->width - left),
                              .height = smaller(BLOCK, f->height - top),
                              .channel = c };
            sum_pixels(&t, f, other);
            const double mean = t.mean + t.difference / 2;
            if (t.bad || !(mean > 0))
                continue;
            for (int y = top; y < top + t.height; y++)
                for (int x = left; x < left + t.width; x++) {
                    const double v =
                        (double)at(f, x, y)->variance[c] / (mean * mean);
                    sum += v;
                    squares += v * v;
                }
        }
    return sum > 0 ? sum * sum / squares : INFINITY;
}

static void choose_block(struct comparison *r, const struct film *a,
                         const struct film *b, int asked)
{
    const double pixels = (double)a->width * a->height;
    double least = INFINITY;
    for (int c = 0; c < 3; c++)
        least = fmin(least, fmin(carriers(a, b, c), carriers(b, a, c)));
    const double share = least / pixels;
    r->block = asked ? asked : BLOCK;
    while (!asked && r->block < larger(a->width, a->height) &&
           share * r->block * r->block < carriers_enough)
        r->block *= 2;
    r->carriers = fmin(least, share * r->block * r->block);
}

/* -- all of them ----------------------------------------------------------- */

struct tests {
    struct test *test; /* blocks by rows, three channels each; last the whole */
    int count, blocks; /* blocks: those without the whole picture's */
    double level;      /* at which the first of them is found, by Holm */
};

static void add_region(struct tests *t, const struct film *a,
                       const struct film *b, int x, int y, int side)
{
    for (int c = 0; c < 3; c++) {
        struct test *test = &t->test[t->count++];
        *test = (struct test){
            .x = x,
            .y = y,
            .width = smaller(side, a->width - x),
            .height = smaller(side, a->height - y),
            .channel = c,
        };
        sum_pixels(test, a, b);
    }
}

static bool make_tests(struct tests *t, const struct film *a,
                       const struct film *b, int side, struct err *err)
{
    const size_t across = ((size_t)a->width - 1) / (size_t)side + 1;
    const size_t down = ((size_t)a->height - 1) / (size_t)side + 1;
    *t = (struct tests){ .test = malloc(3 * (across * down + 1) *
                                        sizeof *t->test) };
    if (!t->test)
        return err_set(err, "out of memory");
    for (int y = 0; y < a->height; y += side)
        for (int x = 0; x < a->width; x += side)
            add_region(t, a, b, x, y, side);
    t->blocks = t->count;
    if (t->blocks > 3)
        add_region(t, a, b, 0, 0, FILM_SIDE_MAX);
    return true;
}

static int by_p(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Holm's: the i-th smallest of m is tested at a level of 1 / (m - i), and none
 * after the first that passes. */
static bool holm(const struct tests *t, struct comparison *r, struct err *err)
{
    assert(t->count > 0);
    double *p = malloc((size_t)t->count * sizeof *p);
    if (!p)
        return err_set(err, "out of memory");
    for (int i = 0; i < t->count; i++)
        p[i] = t->test[i].p;
    qsort(p, (size_t)t->count, sizeof *p, by_p);
    r->p = fmin(1, p[0] * t->count);
    while (r->different < t->count &&
           p[r->different] * (t->count - r->different) <= r->significance)
        r->different++;
    free(p);
    return true;
}

static const struct test *worst(const struct tests *t)
{
    const struct test *w = &t->test[0];
    for (int i = 1; i < t->count; i++) {
        const struct test *o = &t->test[i];
        if (o->p < w->p || (o->p == w->p && fabs(z_of(o)) > fabs(z_of(w))))
            w = o;
    }
    return w;
}

/* -- power ----------------------------------------------------------------- */

/* The t that is just found at a level, and the normal's view of it. */
struct threshold {
    double at, sigma;
};

static struct threshold threshold(double level, double freedom)
{
    const double t = gsl_cdf_tdist_Qinv(level / 2, freedom);
    return (struct threshold){ t * (1 - 1 / (4 * freedom)),
                               sqrt(1 + t * t / (2 * freedom)) };
}

/* What a bias amounts to, in standard errors; 0 where there is no light, and
 * where there is no noise, as of a lamp that fills the block: that any bias of
 * it would be found says nothing of the rest. */
static double per_bias(const struct test *t)
{
    return !t->bad && t->mean > 0 && t->error > 0 ? t->mean / t->error : 0;
}

/* The bias of this region alone that is found. */
static double own_bias(const struct test *t, double level)
{
    const struct threshold h = threshold(level, t->freedom);
    return (h.at + gsl_cdf_ugaussian_Pinv(power) * h.sigma) / per_bias(t);
}

static int by_size(const void *a, const void *b)
{
    return by_p(a, b);
}

/* A block's three channels see the same paths: the best of them counts for the
 * block.  (Blocks do not share any.) */
struct block {
    double per_bias;
    struct threshold h;
};

static struct block best_channel(const struct test *t, double level)
{
    struct block best = { 0 };
    double least = INFINITY;
    for (int c = 0; c < 3; c++) {
        const double bias = own_bias(&t[c], level);
        if (!(bias < least))
            continue;
        least = bias;
        best.per_bias = per_bias(&t[c]);
        best.h = threshold(level, t[c].freedom);
    }
    return best;
}

static bool noiseless(const struct tests *t)
{
    for (int i = 0; i < t->count; i++)
        if (t->test[i].error > 0)
            return false;
    return true;
}

/* log of the probability that no block notices. */
static double log_missed(const struct block *b, int n, double bias)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        if (b[i].per_bias > 0)
            sum += log(gsl_cdf_ugaussian_P((b[i].h.at - bias * b[i].per_bias) /
                                           b[i].h.sigma));
    return sum;
}

/* Halves the interval, on a scale of factors, until it has 6 digits; at most is
 * enough for one of the blocks alone. */
static double blocks_bias(const struct block *b, int n, double most)
{
    double lo = most * 1e-6, hi = most;
    if (!isfinite(most) || most == 0)
        return most;
    while (hi / lo > 1 + 1e-6) {
        const double mid = sqrt(lo * hi);
        if (log_missed(b, n, mid) <= log(1 - power))
            hi = mid;
        else
            lo = mid;
    }
    return hi;
}

static bool find_biases(const struct tests *t, double level,
                        struct comparison *r, struct err *err)
{
    const int n = t->blocks / 3;
    struct block *block = malloc((size_t)n * sizeof *block);
    double *own = malloc((size_t)n * sizeof *own);
    const bool ok = block && own;
    if (ok) {
        for (int i = 0; i < n; i++) {
            block[i] = best_channel(&t->test[3 * i], level);
            own[i] = INFINITY;
            for (int c = 0; c < 3; c++)
                own[i] = fmin(own[i], own_bias(&t->test[3 * i + c], level));
        }
        qsort(own, (size_t)n, sizeof *own, by_size);
        r->block_bias = own[n / 2];
        r->bias = blocks_bias(block, n, own[0]);
        for (int i = t->blocks; i < t->count; i++)
            r->bias = fmin(r->bias, own_bias(&t->test[i], level));
        if (noiseless(t))
            r->bias = r->block_bias = 0;
    }
    free(block);
    free(own);
    return ok || err_set(err, "out of memory");
}

/* -- what is asked for ----------------------------------------------------- */

static struct film *draw(const struct tests *t, const struct film *a,
                         struct err *err)
{
    struct film *map = film_new(a->width, a->height, err);
    for (int i = 0; map && i < t->blocks; i++) {
        const struct test *b = &t->test[i];
        for (int y = b->y; y < b->y + b->height; y++)
            for (int x = b->x; x < b->x + b->width; x++)
                map->pixel[(size_t)y * (size_t)a->width + (size_t)x]
                    .mean[b->channel] = (float)z_of(b);
    }
    return map;
}

static void conclude(const struct tests *t, const struct film *a,
                     const struct film *b, struct comparison *r)
{
    const struct test *w = worst(t);
    r->tests = t->count;
    r->x = w->x;
    r->y = w->y;
    r->width = w->width;
    r->height = w->height;
    r->channel = w->channel;
    r->z = z_of(w);
    find_ratios(a, b, r);
    find_bad(a, b, r);
    if (r->bad) {
        r->p = pvalue_impossible;
        r->z = NAN;
    }
    r->same = r->p > r->significance;
}

bool compare_films(const struct film *a, const struct film *b,
                   const struct compare_options *options,
                   struct comparison *result, struct film **map,
                   struct err *err)
{
    const double significance = options->significance > 0
                                    ? options->significance
                                    : default_significance;
    assert(options->block >= 0);
    if (map)
        *map = NULL;
    *result = (struct comparison){ .significance = significance };
    if (a->width != b->width || a->height != b->height)
        return err_set(err,
                       "the pictures have %d x %d and %d x %d pixels, expected "
                       "the same",
                       a->width, a->height, b->width, b->height);
    if (!check(a, "first", err) || !check(b, "second", err))
        return false;
    struct tests t;
    choose_block(result, a, b, options->block);
    if (!make_tests(&t, a, b, result->block, err))
        return false;
    bool ok = holm(&t, result, err) &&
              find_biases(&t, significance / t.count, result, err);
    if (ok)
        conclude(&t, a, b, result);
    if (ok && map)
        ok = (*map = draw(&t, a, err)) != NULL;
    free(t.test);
    return ok;
}

/* -- for people ------------------------------------------------------------ */

void compare_print(FILE *out, const struct comparison *c)
{
    if (c->bad)
        fprintf(out,
                "different: %ld pixel%s with a value or variance that is no "
                "finite number, the first at (%d, %d), channel %c\n",
                c->bad, c->bad == 1 ? "" : "s", c->x, c->y, "RGB"[c->channel]);
    else
        fprintf(out,
                "%s: %d of %d tests, p = %.3g after Holm, significance %g\n"
                "largest difference: %+.1f standard errors, channel %c, %d x "
                "%d pixels at (%d, %d)\n",
                c->same                         ? "same"
                : c->carriers < carriers_enough ? "unsure"
                                                : "different",
                c->different, c->tests, c->p, c->significance, c->z,
                "RGB"[c->channel], c -> width, c -> height, c -> x, c -> y);
    if (c->carriers < carriers_enough)
        fprintf(out,
                "note: only %.1f pixels of a block carry its noise, %g are "
                "wanted: pictures of which one has missed rare bright samples "
                "differ like this too; more samples or larger blocks would be "
                "surer\n",
                c->carriers, carriers_enough);
    fprintf(out, "mean luminance, second over first: %.5g\n", c->ratio);
    if (isfinite(c->variance_ratio)) /* a file may lack luminance's */
        fprintf(out, "variance of a pixel, second over first: %.4g\n",
                c->variance_ratio);
    if (isfinite(c->bias))
        fprintf(out,
                "found 99 times of 100: a bias of %.2g %% everywhere, of "
                "%.2g %% in a typical block\n",
                100 * c->bias, 100 * c->block_bias);
    else
        fprintf(out, "no bias would have been found 99 times of 100\n");
}

void compare_print_numbers(FILE *out, const struct comparison *c)
{
    fprintf(out, "same\t%d\ntests\t%d\ndifferent\t%d\nblock\t%d\n", c->same,
            c->tests, c->different, c->block);
    fprintf(out, "p\t%.9g\nsignificance\t%.9g\nz\t%.9g\n", c->p,
            c->significance, c->z);
    fprintf(out, "carriers\t%.9g\n", c->carriers);
    fprintf(out,
            "luminance_ratio\t%.9g\nvariance_ratio\t%.9g\nbias\t%.9g\n"
            "block_bias\t%.9g\n",
            c->ratio, c->variance_ratio, c->bias, c->block_bias);
}

static unsigned char shade(double x)
{
    return (unsigned char)floor(255 * fmin(fmax(x, 0), 1) + 0.5);
}

/* Of the channel that differs most; magenta for NaN. */
static void paint(unsigned char rgb[3], const float z[3])
{
    double most = 0;
    for (int c = 0; c < 3; c++)
        if (!(fabs((double)z[c]) <= fabs(most)))
            most = (double)z[c];
    if (isnan(z[0]) || isnan(z[1]) || isnan(z[2])) {
        rgb[0] = rgb[2] = 255;
        rgb[1] = 0;
        return;
    }
    const double pale = 1 - fabs(most) / full_colour;
    rgb[0] = shade(most >= 0 ? 1 : pale);
    rgb[1] = shade(pale);
    rgb[2] = shade(most <= 0 ? 1 : pale);
}

bool compare_write_map(const struct film *map, const char *path,
                       struct err *err)
{
    const size_t n = (size_t)map->width * (size_t)map->height;
    struct png png = { map->width, map->height, malloc(3 * n) };
    if (!png.rgb)
        return err_set(err, "out of memory");
    for (size_t i = 0; i < n; i++)
        paint(png.rgb + 3 * i, map->pixel[i].mean);
    const bool ok = png_write(&png, path, true, err);
    free(png.rgb);
    return ok;
}
