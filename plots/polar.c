/* polar.c - curves over a grid of angles and rings */
#include "plots/polar.h"

#include <stdlib.h>
#include <string.h>

#include "plots/axis.h"
#include "plots/colours.h"
#include "plots/key.h"

enum { RADIUS = 146 }; /* pixels */

static void curve_columns(struct polar *p, int cosine, int i)
{
    struct chart_curve *c = &p->curve[cosine][i];
    const struct trace *t = &p->trace[p->traces > 1 ? i : 0];
    const int first = 2 + cosine * t->bands;
    *c = (struct chart_curve){ .block = p->traces > 1 ? i : 0,
                               .x = "$1",
                               .line = i + 1 };
    if (p->traces > 1) {
        colours_mean_columns(bsdf_bands(t->bsdf), first, c->y, sizeof c->y);
        return;
    }
    snprintf(c->y, sizeof c->y, "$%d", first + i);
    c->line = t->same ? LINE_ONLY : colours_line(bsdf_bands(t->bsdf), i);
}

enum { SPEC_MAX = 64 }; /* bytes of a spec in the key */

/* Backward to where a character begins. */
static size_t whole(const char *text, size_t n)
{
    while (n > 0 && ((unsigned char)text[n] & 0xc0) == 0x80)
        n--;
    return n;
}

/* How many bytes all specs begin with that are too long for the key, up to
 * where a setting begins; 0 where these are the same. */
static size_t common(const struct polar *p)
{
    const char *first = NULL;
    bool differ = false;
    size_t n = 0;
    for (int i = 0; i < p->traces; i++) {
        const char *spec = bsdf_spec(p->trace[i].bsdf);
        if (strlen(spec) <= SPEC_MAX)
            continue;
        if (!first) {
            first = spec;
            n = strlen(spec);
        }
        differ |= strcmp(spec, first) != 0;
        size_t k = 0;
        while (k < n && spec[k] == first[k])
            k++;
        n = k;
    }
    while (n > 0 && !strchr(":,(", first[n - 1]))
        n--;
    return differ ? n : 0;
}

/* A spec; of one that is too long for the key what not all of these begin with,
 * cut in the middle. */
static int spec_short(const struct polar *p, const char *spec, char *text,
                      size_t size)
{
    const size_t length = strlen(spec);
    const size_t from = length > SPEC_MAX ? common(p) : 0;
    const char *sign = from ? "…" : "", *rest = spec + from;
    if (length - from <= SPEC_MAX)
        return snprintf(text, size, "%s%s", sign, rest);
    return snprintf(text, size, "%s%.*s…%s", sign,
                    (int)whole(rest, SPEC_MAX / 2), rest,
                    rest + whole(rest, length - from - SPEC_MAX / 2));
}

/* What the one of several is, by what differs. */
static void name(const struct polar *p, int i, char *text, size_t size)
{
    const struct trace *t = &p->trace[i];
    bool specs = false, directions = false;
    for (int k = 0; k < p->traces; k++) {
        const struct trace *o = &p->trace[k];
        specs |= strcmp(bsdf_spec(o->bsdf), bsdf_spec(t->bsdf)) != 0;
        directions |=
            o->wo.x != t->wo.x || o->wo.y != t->wo.y || o->wo.z != t->wo.z;
    }
    const struct angles a = dir_to_degrees(t->wo);
    size_t n = 0;
    text[0] = '\0';
    if (specs || !directions)
        n = (size_t)spec_short(p, bsdf_spec(t->bsdf), text, size);
    if (directions && n < size)
        snprintf(text + n, size - n, "%sωₒ at %.6g°, %.6g°", n ? ", " : "",
                 a.theta_deg, a.phi_deg);
}

/* Those that read the same are told apart by where they come. */
static void number_alike(struct polar *p)
{
    bool alike[POLAR_CURVES_MAX] = { false };
    for (int i = 0; i < p->curves; i++)
        for (int k = 0; k < p->curves; k++)
            alike[i] |=
                k != i && strcmp(p->curve[0][i].text, p->curve[0][k].text) == 0;
    for (int i = 0; i < p->curves; i++) {
        char *text = p->curve[0][i].text;
        const size_t size = sizeof p->curve[0][i].text;
        char was[sizeof p->curve[0][i].text];
        if (!alike[i])
            continue;
        strcpy(was, text);
        snprintf(text, size, "%d: %.*s", 1 + i,
                 (int)whole(was, strnlen(was, size - 4)), was);
    }
}

static double mean_most(const struct trace *t, bool cosine)
{
    const struct bands *bands = bsdf_bands(t->bsdf);
    double most = 0;
    for (size_t i = 0; i < t->points; i++) {
        struct spectrum f = { { 0 } };
        for (int b = 0; b < t->bands; b++)
            f.band[b] = t->point[i].f[cosine * t->bands + b];
        const double mean = colours_mean(bands, f);
        if (isfinite(mean))
            most = fmax(most, mean);
    }
    return most;
}

struct polar polar_of(const struct trace *trace, int traces, bool log)
{
    struct polar p = { .trace = trace, .traces = traces, .log = log };
    p.curves = traces > 1 ? traces : trace->same ? 1 : trace->bands;
    for (int cosine = 0; cosine < 2; cosine++) {
        for (int i = 0; i < p.curves; i++)
            curve_columns(&p, cosine, i);
        for (int i = 0; i < traces; i++)
            p.most[cosine] =
                fmax(p.most[cosine], traces > 1 ? mean_most(&trace[i], cosine)
                                                : trace_most(trace, cosine));
    }
    for (int i = 0; i < p.curves; i++) {
        char *text = p.curve[0][i].text;
        const size_t size = sizeof p.curve[0][i].text;
        if (traces > 1)
            name(&p, i, text, size);
        else if (trace->same && trace->bands > 1)
            strcpy(text, "all bands");
        else
            bands_print_one(bsdf_bands(trace->bsdf), i, text, (int)size);
    }
    if (traces > 1)
        number_alike(&p);
    return p;
}

void polar_table(FILE *out, const struct polar *p)
{
    for (int i = 0; i < p->traces; i++) {
        fputs(i ? "\n\n" : "", out);
        trace_write(out, &p->trace[i]);
    }
    for (int i = 0; i < p->traces; i++)
        if (p->trace[i].pilots.deltas > 0) {
            fputs("\n\n", out);
            trace_write_deltas(out, &p->trace[i]);
        }
}

static const char *what(bool cosine)
{
    return cosine ? "f |cos θᵢ|" : "f";
}

struct chart_axis polar_axis(const struct polar *p, bool cosine)
{
    const double most = p->most[cosine] > 0 ? p->most[cosine] : 1;
    if (!p->log)
        return chart_axis(0, most, 5, what(cosine), "1/sr");
    const double hi = pow(10, ceil(log10(most) - 1e-9));
    return chart_axis_log(hi * pow(10, -TRACE_DECADES), hi, what(cosine),
                          "1/sr");
}

bool polar_half(const struct polar *p)
{
    for (int i = 0; i < p->traces; i++)
        if (p->trace[i].limit_deg > 90)
            return false;
    return true;
}

/* Spokes and their labels; rings, for a plot command to go on with.  A circle
 * is a curve because the terminal for SVG loses the colour of an object. */
static void grid(struct figure *fig, bool half)
{
    FILE *out = fig->script;
    fprintf(out,
            "do for [a=%d:%d:15] {\n"
            "    set arrow from 0,0 to sin(a),cos(a) nohead back lt %d lw (a "
            "%% 30 ? 0.3 : 0.6)\n"
            "}\n",
            half ? -90 : -165, half ? 90 : 180, LINE_GRID);
    for (int a = half ? -90 : -150; a <= (half ? 90 : 180); a += 30) {
        const double s = sin(a * PI / 180), c = cos(a * PI / 180);
        char text[16];
        snprintf(text, sizeof text, "%s%d°", a < 0 ? "−" : "", abs(a));
        if (fabs(s) < 0.1)
            figure_label_at(fig, text, "0,%.6g center tc rgb \"#505050\"",
                            1.19 * c);
        else
            figure_label_at(fig, text, "%.6g,%.6g %s tc rgb \"#505050\"",
                            (fabs(c) < 0.1 ? 1.1 : 1.14) * s, 1.15 * c,
                            s < 0 ? "right" : "left");
    }
}

static int rings_of(const struct chart_axis *a)
{
    return a->log ? (int)lround(log10(a->hi / a->lo))
                  : (int)lround(a->hi / a->step);
}

static void ring_numbers(struct figure *fig, const struct chart_axis *a,
                         bool half)
{
    const int n = rings_of(a);
    for (int i = half ? 0 : 1; i <= n; i++) {
        char text[32];
        if (a->log) {
            const int e = (int)lround(log10(a->lo)) + i;
            if ((n - i) % 2)
                continue;
            axis_unit(text, sizeof text, e, "");
            text[strcspn(text, " ")] = '\0';
            if (e == 0)
                strcpy(text, "1");
        } else {
            snprintf(text, sizeof text, "%g", i * a->step);
        }
        figure_label_at(fig, text, "%.6g,-0.09 center tc rgb \"#505050\"",
                        (half ? 1. : -1.) * i / n);
    }
}

static void curves(FILE *out, const struct polar *p, bool cosine,
                   const struct chart_axis *a)
{
    for (int i = 0; i < p->curves; i++) {
        const struct chart_curve *c = &p->curve[cosine][i];
        char r[320];
        if (a->log)
            snprintf(r, sizeof r, "((%s) > %.10g ? log10((%s)/%.10g)/%d : 0)",
                     c->y, a->lo, c->y, a->lo, rings_of(a));
        else
            snprintf(r, sizeof r, "((%s)/%.10g)", c->y,
                     a->hi * pow(10, a->exponent));
        fprintf(out,
                ", \\\n     table index %d using (%s*sin($1)):(%s*cos($1)) "
                "with lines lt %d",
                c->block, r, r, c->line);
    }
}

/* Short lines outside the rim, each drawn from the first row of the table,
 * which is as good as any; and arrows for the single directions. */
static void marks(FILE *out, const struct polar *p)
{
    int block = p->traces;
    for (int i = 0; i < p->traces; i++) {
        const struct trace *t = &p->trace[i];
        const double at[2] = { t->mirror_deg, t->wo_deg };
        for (int k = 0; t->incidence && k < 2; k++)
            fprintf(out,
                    ", \\\n     table index 0 every ::0::0 using (%.8g):(%.8g):"
                    "(%.8g):(%.8g) with vectors %s",
                    1.012 * sin(at[k] * PI / 180),
                    1.012 * cos(at[k] * PI / 180),
                    0.075 * sin(at[k] * PI / 180),
                    0.075 * cos(at[k] * PI / 180), k ? key_wo : key_mirror);
        if (t->pilots.deltas > 0)
            fprintf(out,
                    ", \\\n     table index %d using (0):(0):(sin($1)):"
                    "(cos($1)) with vectors %s",
                    block++, key_delta);
    }
    fputc('\n', out);
}

void polar_disk(struct figure *fig, const struct polar *p, bool cosine,
                double x, double y)
{
    FILE *out = fig->script;
    const bool half = polar_half(p), any = p->most[cosine] > 0;
    const struct chart_axis a = polar_axis(p, cosine);
    const double side = (double)POLAR_SIDE / RADIUS;
    const double up = (double)POLAR_ABOVE / RADIUS;
    const double down = (double)(half ? POLAR_BELOW : POLAR_BACK) / RADIUS;
    const int n = rings_of(&a);
    fprintf(out,
            "\n# %s\nunset border; unset tics; unset key; unset logscale\n",
            cosine ? "f |cos|" : "f");
    figure_panel(fig, x - POLAR_SIDE, x + POLAR_SIDE, y - down * RADIUS,
                 y + POLAR_ABOVE);
    fprintf(out, "set xrange [%.6g:%.6g]; set yrange [%.6g:%.6g]\n", -side,
            side, -down, up);
    grid(fig, half);
    if (any) {
        figure_label_at(fig, a.title, "0,1.38 center");
        ring_numbers(fig, &a, half);
    }
    if (!half) /* the surface, and the numbers where lobes are rare */
        fputs("set arrow from -1,0 to 1,0 nohead back lc rgb \"#707070\" dt 1 "
              "lw 1.2\n",
              out);
    fprintf(out,
            "set parametric; set trange [%d:%d]; set samples 361\n"
            "plot for [i=1:%d] i/%d.*sin(t),i/%d.*cos(t) with lines lt %d",
            half ? -90 : -180, half ? 90 : 180, n, n, n, LINE_GRID);
    if (any)
        curves(out, p, cosine, &a);
    marks(out, p);
    fputs("unset parametric; unset arrow; unset label\n", out);
}

/* -- the key --------------------------------------------------------------- */

enum { ENTRIES_MAX = POLAR_CURVES_MAX + 3 };

static int entries(const struct polar *p, struct key_entry entry[ENTRIES_MAX])
{
    int n = 0;
    bool deltas = false, incidence = false;
    for (int i = 0; i < p->curves && p->most[0] > 0; i++, n++) {
        entry[n] = (struct key_entry){ .look = "" };
        snprintf(entry[n].look, sizeof entry[n].look, "nohead lt %d",
                 p->curve[0][i].line);
        snprintf(entry[n].text, sizeof entry[n].text, "%s",
                 p->curve[0][i].text);
    }
    for (int i = 0; i < p->traces; i++) {
        deltas |= p->trace[i].pilots.deltas > 0;
        incidence |= p->trace[i].incidence;
    }
    const struct {
        bool there;
        const char *look, *text;
    } others[] = { { incidence, key_wo, "ωₒ" },
                   { incidence, key_mirror, "mirror direction" },
                   { deltas, key_delta, "δ" } };
    for (int i = 0; i < 3; i++) {
        if (!others[i].there)
            continue;
        entry[n] = (struct key_entry){ .look = "" };
        snprintf(entry[n].look, sizeof entry[n].look, "%s", others[i].look);
        snprintf(entry[n++].text, sizeof entry[n].text, "%s", others[i].text);
    }
    return n;
}

int polar_key_rows(const struct polar *p)
{
    struct key_entry entry[ENTRIES_MAX];
    return key_rows(entry, entries(p, entry), FIGURE_PAGE);
}

void polar_key(struct figure *fig, const struct polar *p, double y)
{
    struct key_entry entry[ENTRIES_MAX];
    key_draw(fig, entry, entries(p, entry), y);
}
