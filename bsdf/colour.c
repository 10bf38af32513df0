/* colour.c - sums over wavelength, CIEDE2000, and fits over angle
 *
 *   X = sum F(lambda) D65(lambda) xbar(lambda) / sum D65 ybar,   Y, Z alike
 *
 * Sums are over every nanometre from 360 to 830, as CIE 015:2018, sec. 7.1 has
 * them; F is Fresnel's reflectance of n + i k at one angle.
 *
 * The reflectance of a channel depends on two numbers, eta and k, and the
 * spectral one is met at F0 and, near grazing, at its dip.  Those (eta, k) that
 * have a given F0 are on an arc,
 *
 *   k^2 = (F0 (eta + 1)^2 - (eta - 1)^2) / (1 - F0),
 *   (1 - sqrt F0) / (1 + sqrt F0) <= eta <= (1 + sqrt F0) / (1 - sqrt F0)   [1]
 *
 * along which the best is found by trying; from there a least-squares fit in
 * log eta and log k, weighted with the cosine, is free to leave it.
 *
 * [1] O. Gulbrandsen, Artist Friendly Metallic Fresnel, JCGT 3(4), 2014.
 */
#include "bsdf/colour.h"

#include <assert.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "bsdf/fresnel.h"
#include "bsdf/vec.h"

/* -- linear sRGB ----------------------------------------------------------- */

struct matrix {
    double at[3][3];
};

static struct matrix inverse(struct matrix m)
{
    struct matrix c; /* the adjugate, and then divided */
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int p = (j + 1) % 3, q = (j + 2) % 3;
            const int r = (i + 1) % 3, s = (i + 2) % 3;
            c.at[i][j] = m.at[p][r] * m.at[q][s] - m.at[p][s] * m.at[q][r];
        }
    double det = 0;
    for (int j = 0; j < 3; j++)
        det += m.at[0][j] * c.at[j][0];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            c.at[i][j] /= det;
    return c;
}

static void apply(const struct matrix *m, const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = m->at[i][0] * v[0] + m->at[i][1] * v[1] + m->at[i][2] * v[2];
}

/* IEC 61966-2-1: the columns are the primaries, as long as it takes for their
 * sum to be the white. */
static struct matrix xyz_from_rgb(void)
{
    static const double primary[3][2] = { { 0.64, 0.33 },
                                          { 0.30, 0.60 },
                                          { 0.15, 0.06 } };
    static const double x = 0.3127, y = 0.3290;
    const double white[3] = { x / y, 1, (1 - x - y) / y };
    struct matrix m;
    for (int c = 0; c < 3; c++) {
        m.at[0][c] = primary[c][0];
        m.at[1][c] = primary[c][1];
        m.at[2][c] = 1 - primary[c][0] - primary[c][1];
    }
    const struct matrix back = inverse(m);
    double length[3];
    apply(&back, white, length);
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            m.at[i][c] *= length[c];
    return m;
}

struct spectrum colour_rgb(struct xyz xyz)
{
    const struct matrix m = inverse(xyz_from_rgb());
    struct spectrum rgb = { { 0 } };
    apply(&m, (double[]){ xyz.x, xyz.y, xyz.z }, rgb.band);
    return rgb;
}

struct xyz colour_xyz(struct spectrum rgb)
{
    const struct matrix m = xyz_from_rgb();
    double out[3];
    apply(&m, rgb.band, out);
    return (struct xyz){ out[0], out[1], out[2] };
}

double colour_srgb_encode(double linear)
{
    const double v = fmin(fmax(linear, 0), 1);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
}

/* -- CIELAB and CIEDE2000 -------------------------------------------------- */

/* A cube root, and below (6/29)^3 its tangent. */
static double lab_f(double t)
{
    const double d = 6.0 / 29;
    return t > d * d * d ? cbrt(t) : t / (3 * d * d) + 4.0 / 29;
}

struct lab colour_lab(struct xyz xyz, struct xyz white)
{
    const double x = lab_f(xyz.x / white.x), y = lab_f(xyz.y / white.y),
                 z = lab_f(xyz.z / white.z);
    return (struct lab){ 116 * y - 16, 500 * (x - y), 200 * (y - z) };
}

/* sqrt(c^7 / (c^7 + 25^7)) */
static double seventh(double c)
{
    const double r = c / 25, r2 = r * r, r7 = r2 * r2 * r2 * r;
    return sqrt(r7 / (r7 + 1));
}

/* In [0, 360); 0 for a grey. */
static double hue_deg(double a, double b)
{
    const double h = atan2(b, a) * 180 / PI;
    return h < 0 ? h + 360 : h;
}

static double cos_deg(double degrees)
{
    return cos(degrees * PI / 180);
}

/* Sharma et al., eqs. 2 to 22.  The hues' difference comes from the cross and
 * dot product of (a', b'): no rounding then decides on which side the mean of
 * opposite hues lies, which is 180 degrees off on the other. */
double colour_ciede2000(struct lab p, struct lab q)
{
    const double g = (1 - seventh((hypot(p.a, p.b) + hypot(q.a, q.b)) / 2)) / 2;
    const double a1 = (1 + g) * p.a, a2 = (1 + g) * q.a;
    const double c1 = hypot(a1, p.b), c2 = hypot(a2, q.b);
    const double h1 = hue_deg(a1, p.b), h2 = hue_deg(a2, q.b);

    const double cross = a1 * q.b - a2 * p.b, dot = a1 * a2 + p.b * q.b;
    double dh = atan2(cross, dot) * 180 / PI;
    if (cross == 0 && dot < 0)
        dh = h1 < h2 ? 180 : -180;
    const bool grey = c1 * c2 == 0;
    double h = grey ? h1 + h2 : h1 + dh / 2;
    h += h < 0 ? 360 : h >= 360 ? -360 : 0;

    const double l = (p.l + q.l) / 2, c = (c1 + c2) / 2;
    const double t = 1 - 0.17 * cos_deg(h - 30) + 0.24 * cos_deg(2 * h) +
                     0.32 * cos_deg(3 * h + 6) - 0.20 * cos_deg(4 * h - 63);
    const double l50 = (l - 50) * (l - 50);
    const double turn = (h - 275) / 25;
    const double rt = -2 * seventh(c) * sin(PI / 3 * exp(-turn * turn));

    const double dl = (q.l - p.l) / (1 + 0.015 * l50 / sqrt(20 + l50));
    const double dc = (c2 - c1) / (1 + 0.045 * c);
    const double ds =
        grey ? 0
             : 2 * sqrt(c1 * c2) * sin(dh / 2 * PI / 180) / (1 + 0.015 * c * t);
    return sqrt(fmax(dl * dl + dc * dc + ds * ds + rt * dc * ds, 0));
}

/* -- sums over wavelength -------------------------------------------------- */

static double sum_y(const struct cie *cie)
{
    double sum = 0;
    for (int row = 0; row < CIE_ROWS; row++)
        sum += cie->d65[row] * cie->bar[row][1];
    return sum;
}

struct xyz colour_white(const struct cie *cie)
{
    const double y = sum_y(cie);
    struct xyz white = { 0, 1, 0 };
    for (int row = 0; row < CIE_ROWS; row++) {
        white.x += cie->d65[row] * cie->bar[row][0] / y;
        white.z += cie->d65[row] * cie->bar[row][2] / y;
    }
    return white;
}

/* The least share of X, Y, Z of the white between two wavelengths. */
static double coverage(const struct cie *cie, double lo_nm, double hi_nm)
{
    double all[3] = { 0 }, inside[3] = { 0 }, least = 1;
    for (int row = 0; row < CIE_ROWS; row++) {
        const int nm = CIE_LO_NM + row;
        for (int c = 0; c < 3; c++) {
            const double part = cie->d65[row] * cie->bar[row][c];
            all[c] += part;
            inside[c] += nm >= lo_nm && nm <= hi_nm ? part : 0;
        }
    }
    for (int c = 0; c < 3; c++)
        least = fmin(least, inside[c] / all[c]);
    return least;
}

static bool needs_k(const struct ior_page *page, struct err *err)
{
    if (!ior_page_has_k(page))
        return err_set(err,
                       "%.400s: the page gives n alone, and the colour of a "
                       "metal needs k",
                       ior_page_path(page));
    return true;
}

bool colour_metal_init(struct colour_metal *metal, const struct cie *cie,
                       const struct ior_page *page, struct err *err)
{
    double lo, hi;
    *metal = (struct colour_metal){ .cie = cie };
    if (!needs_k(page, err))
        return false;
    ior_page_range(page, &lo, &hi);
    const double covered = coverage(cie, lo, hi);
    if (covered < 0.5)
        return err_set(
            err,
            "%.400s: has %g to %g nm, where %.3g %% of the least of "
            "X, Y and Z of D65 lies; expected at least half, as from "
            "430 to 650 nm",
            ior_page_path(page), lo, hi, 100 * covered);
    for (int row = 0; row < CIE_ROWS; row++) {
        const double nm = fmin(fmax(CIE_LO_NM + row, lo), hi);
        if (!ior_page_at(page, nm, &metal->n[row], &metal->k[row], err))
            return false;
    }
    metal->lo_nm = fmax(lo, CIE_LO_NM);
    metal->hi_nm = fmin(hi, CIE_HI_NM);
    metal->covered = covered;
    return true;
}

struct xyz colour_metal_xyz(const struct colour_metal *metal, double cos_i)
{
    const struct cie *cie = metal->cie;
    double sum[3] = { 0 };
    for (int row = 0; row < CIE_ROWS; row++) {
        const double f = fresnel_conductor(cos_i, metal->n[row], metal->k[row]);
        for (int c = 0; c < 3; c++)
            sum[c] += f * cie->d65[row] * cie->bar[row][c];
    }
    const double y = sum_y(cie);
    return (struct xyz){ sum[0] / y, sum[1] / y, sum[2] / y };
}

struct spectrum colour_metal_rgb(const struct colour_metal *metal, double cos_i)
{
    return colour_rgb(colour_metal_xyz(metal, cos_i));
}

/* -- the methods ----------------------------------------------------------- */

const char *const colour_method_names[] = { "fixed", "average", "fit", NULL };

bool colour_method_parse(enum colour_method *method, const char *text,
                         struct err *err)
{
    for (int m = 0; colour_method_names[m]; m++)
        if (strcmp(text, colour_method_names[m]) == 0) {
            *method = (enum colour_method)m;
            return true;
        }
    return err_set(
        err, "colour method \"%.80s\": expected fixed, average or fit", text);
}

struct pairs {
    struct spectrum eta, k;
};

static bool fixed(const struct ior_page *page, const struct bands *bands,
                  struct pairs *pairs, struct err *err)
{
    if (bands->count != 3)
        return err_set(err, "%d wavelengths; expected three, for R, G and B",
                       bands->count);
    if (!needs_k(page, err))
        return false;
    for (int b = 0; b < 3; b++)
        if (!ior_page_at(page, bands->nm[b], &pairs->eta.band[b],
                         &pairs->k.band[b], err))
            return false;
    return true;
}

/* Of n or k under equal energy, and nothing negative. */
static struct spectrum average(const struct cie *cie,
                               const double value[CIE_ROWS])
{
    double sum[3] = { 0 }, y = 0;
    for (int row = 0; row < CIE_ROWS; row++) {
        for (int c = 0; c < 3; c++)
            sum[c] += value[row] * cie->bar[row][c];
        y += cie->bar[row][1];
    }
    struct spectrum rgb =
        colour_rgb((struct xyz){ sum[0] / y, sum[1] / y, sum[2] / y });
    for (int b = 0; b < 3; b++)
        rgb.band[b] = fmax(rgb.band[b], 0);
    return rgb;
}

/* -- fitting over angle ---------------------------------------------------- */

/* Grazing light itself is left out: every metal returns all of it. */
enum { ANGLES = 32 };

static double cos_at(int angle)
{
    return 1 - (double)angle / ANGLES;
}

/* What a channel is asked to return at most and at least.  A metal that returns
 * all has eta = 0 with any k, and between such mirrors light would go to and
 * fro for ever. */
static const double most = 0.999, least = 0.001;

struct channel {
    double target[ANGLES];
};

/* Angles count as they do in an albedo, with their cosine. */
static double misfit2(const struct channel *ch, double eta, double k)
{
    double sum = 0;
    for (int i = 0; i < ANGLES; i++) {
        const double d = fresnel_conductor(cos_at(i), eta, k) - ch->target[i];
        sum += cos_at(i) * d * d;
    }
    return sum;
}

static int residuals(const gsl_vector *log_eta_k, void *context, gsl_vector *f)
{
    const struct channel *ch = context;
    const double eta = exp(gsl_vector_get(log_eta_k, 0));
    const double k = exp(gsl_vector_get(log_eta_k, 1));
    for (int i = 0; i < ANGLES; i++) {
        const double d = fresnel_conductor(cos_at(i), eta, k) - ch->target[i];
        gsl_vector_set(f, (size_t)i, sqrt(cos_at(i)) * d);
    }
    return GSL_SUCCESS;
}

/* The best of the arc whose F0 is that of the target. */
static void start(const struct channel *ch, double *eta, double *k)
{
    enum { TRIES = 64 };
    const double f0 = ch->target[0], root = sqrt(f0);
    const double lo = log1p(-root) - log1p(root); /* of log eta; hi = -lo */
    double best = INFINITY;
    for (int i = 0; i < TRIES; i++) {
        const double n = exp(lo * (1 - (2 * i + 1) / (double)TRIES));
        const double k2 =
            (f0 * (n + 1) * (n + 1) - (n - 1) * (n - 1)) / (1 - f0);
        const double sum = misfit2(ch, n, sqrt(fmax(k2, 0)));
        if (k2 > 0 && sum < best) {
            best = sum;
            *eta = n;
            *k = sqrt(k2);
        }
    }
}

static bool fit_channel(struct channel *ch, double *eta, double *k,
                        struct err *err)
{
    enum { STEPS_MAX = 200 };
    static const double x_small = 1e-10, f_small = 1e-14;
    gsl_multifit_nlinear_parameters how =
        gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_fdf fdf = {
        .f = residuals, .n = ANGLES, .p = 2, .params = ch
    };
    gsl_multifit_nlinear_workspace *w =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &how, ANGLES, 2);
    if (!w)
        return err_set(err, "fit of eta and k: out of memory");

    start(ch, eta, k);
    double x[2] = { log(*eta), log(*k) };
    const gsl_vector_view from = gsl_vector_view_array(x, 2);
    int why;
    gsl_multifit_nlinear_init(&from.vector, &fdf, w);
    /* It says "no progress" as well where it began at the best there is: what
     * is asked is whether it found something better. */
    (void)gsl_multifit_nlinear_driver(STEPS_MAX, x_small, f_small, f_small,
                                      NULL, NULL, &why, w);
    const gsl_vector *to = gsl_multifit_nlinear_position(w);
    const double n = exp(gsl_vector_get(to, 0)), m = exp(gsl_vector_get(to, 1));
    if (misfit2(ch, n, m) < misfit2(ch, *eta, *k)) {
        *eta = n;
        *k = m;
    }
    gsl_multifit_nlinear_free(w);
    return true;
}

static bool fit(const struct spectrum curve[ANGLES], struct pairs *pairs,
                struct err *err)
{
    for (int b = 0; b < 3; b++) {
        struct channel ch;
        for (int i = 0; i < ANGLES; i++)
            ch.target[i] = fmin(fmax(curve[i].band[b], least), most);
        if (!fit_channel(&ch, &pairs->eta.band[b], &pairs->k.band[b], err))
            return false;
    }
    return true;
}

/* -- and how well they do -------------------------------------------------- */

__attribute__((format(printf, 2, 3))) static void
warn(struct colour_report *report, const char *format, ...)
{
    const size_t size = sizeof report->warnings;
    size_t used = strlen(report->warnings);
    va_list args;
    if (used)
        used += (size_t)snprintf(report->warnings + used, size - used, "\n");
    va_start(args, format);
    vsnprintf(report->warnings + used, size - used, format, args);
    va_end(args);
}

static void warn_of_all(const struct colour_metal *metal, const char *path,
                        enum colour_method method, struct colour_report *report)
{
    /* A thousandth of the white: below what CIEDE2000 shows. */
    static const double enough = 0.999;
    if (metal->covered < enough)
        warn(report,
             "%.200s: has %g to %g nm of the visible; n and k at its ends were "
             "held for the other %.2g %% of the white",
             path, metal->lo_nm, metal->hi_nm, 100 * (1 - metal->covered));
    for (int b = 0; method == COLOUR_FIT && b < 3; b++) {
        const double f0 = report->f0_spectral.band[b];
        if (f0 < least || f0 > most)
            warn(report,
                 "%c: the spectrum has F0 = %.4f, which no eta and k give in "
                 "linear sRGB; %.3f was fitted instead, at this and at every "
                 "other angle where it is beyond that",
                 "RGB"[b], f0, f0 > most ? most : least);
    }
}

static void compare(const struct colour_metal *metal,
                    const struct spectrum curve[ANGLES],
                    const struct pairs *pairs, struct colour_report *report)
{
    *report = (struct colour_report){ .f0_spectral = curve[0],
                                      .covered = metal->covered };
    for (int b = 0; b < 3; b++) {
        double sum = 0, all = 0, worst = 0;
        for (int i = 0; i < ANGLES; i++) {
            const double f = fresnel_conductor(cos_at(i), pairs->eta.band[b],
                                               pairs->k.band[b]);
            const double d = f - curve[i].band[b];
            sum += cos_at(i) * d * d;
            all += cos_at(i);
            worst = fmax(worst, fabs(d));
            if (i == 0)
                report->f0.band[b] = f;
        }
        report->rms.band[b] = sqrt(sum / all);
        report->worst.band[b] = worst;
    }
    const struct xyz white = colour_white(metal->cie);
    report->ciede2000 =
        colour_ciede2000(colour_lab(colour_xyz(report->f0), white),
                         colour_lab(colour_xyz(curve[0]), white));
}

bool colour_conductor(const struct cie *cie, const struct ior_page *page,
                      enum colour_method method, const struct bands *bands,
                      struct spectrum *eta, struct spectrum *k,
                      struct colour_report *report, struct err *err)
{
    struct pairs pairs = { { { 0 } }, { { 0 } } };
    struct colour_metal metal;
    struct spectrum curve[ANGLES] = { { { 0 } } };
    if (method == COLOUR_FIXED &&
        !fixed(page, bands ? bands : &bands_fixed, &pairs, err))
        return false;
    if (method != COLOUR_FIXED || report) {
        if (!colour_metal_init(&metal, cie, page, err))
            return false;
        for (int i = 0; i < ANGLES; i++)
            curve[i] = colour_metal_rgb(&metal, cos_at(i));
    }
    if (method == COLOUR_AVERAGE) {
        pairs.eta = average(cie, metal.n);
        pairs.k = average(cie, metal.k);
    } else if (method == COLOUR_FIT && !fit(curve, &pairs, err)) {
        return false;
    }
    if (report) {
        compare(&metal, curve, &pairs, report);
        warn_of_all(&metal, ior_page_path(page), method, report);
    }
    *eta = pairs.eta;
    *k = pairs.k;
    return true;
}

/* -- matching -------------------------------------------------------------- */

struct matching {
    struct spectrum eta, k;
    double eta_half, k_half;
    const char *ior_path;
    struct colour_match best;
    struct err why; /* the last page was skipped */
};

/* In halves of a last digit. */
static double mismatch(const struct matching *m, int band, double n, double k)
{
    return fmax(fabs(n - m->eta.band[band]) / m->eta_half,
                fabs(k - m->k.band[band]) / m->k_half);
}

/* A number that lies half-way between two digits may be rounded either way, and
 * its double is next to it. */
static bool rounds_to(double error)
{
    return error <= 1 + 1e-9;
}

/* False where the page has nothing in the visible. */
static bool best_of(const struct matching *m, const struct ior_page *page,
                    struct colour_match *found, struct err *err)
{
    double lo, hi;
    if (!needs_k(page, err))
        return false;
    ior_page_range(page, &lo, &hi);
    double band[3] = { INFINITY, INFINITY, INFINITY };
    for (int nm = CIE_LO_NM; nm <= CIE_HI_NM; nm++) {
        double n, k;
        if (nm < lo || nm > hi || !ior_page_at(page, nm, &n, &k, NULL))
            continue;
        for (int b = 0; b < 3; b++) {
            const double e = mismatch(m, b, n, k);
            found->candidates[b] += rounds_to(e);
            if (e < band[b]) {
                band[b] = e;
                found->bands.nm[b] = nm;
                found->eta.band[b] = n;
                found->k.band[b] = k;
            }
        }
    }
    found->bands.count = 3;
    found->error = fmax(band[0], fmax(band[1], band[2]));
    found->within = rounds_to(found->error);
    if (isinf(found->error))
        return err_set(err,
                       "%.400s: %g to %g nm have no whole wavelength from "
                       "%d to %d nm",
                       ior_page_path(page), lo, hi, CIE_LO_NM, CIE_HI_NM);
    return true;
}

static void consider(void *context, const char *name)
{
    struct matching *m = context;
    struct colour_match found = { .page = "" };
    struct ior_page *page = ior_find(name, m->ior_path, &m->why);
    if (!page || !best_of(m, page, &found, &m->why)) {
        m->best.skipped++;
    } else {
        found.compared = m->best.compared + 1;
        found.skipped = m->best.skipped;
        if (found.error < m->best.error || found.compared == 1) {
            snprintf(found.page, sizeof found.page, "%s", name);
            m->best = found;
        }
        m->best.compared = found.compared;
    }
    ior_page_free(page);
}

bool colour_match(const struct spectrum *eta, const struct spectrum *k,
                  double eta_half, double k_half, const char *const names[],
                  size_t count, const char *ior_path,
                  struct colour_match *match, struct err *err)
{
    assert(eta_half > 0 && k_half > 0);
    struct matching m = {
        *eta, *k, eta_half, k_half, ior_path, { "" }, { "" }
    };
    m.best.error = INFINITY;
    if (!names && !ior_list(consider, &m, err))
        return false;
    for (size_t i = 0; names && i < count; i++)
        consider(&m, names[i]);
    if (!m.best.compared)
        return err_set(err, "no page of optical constants to compare with%s%s",
                       *m.why.text ? ": " : "", m.why.text);
    *match = m.best;
    return true;
}
