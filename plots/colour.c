/* colour.c - the colour of a metal by each way to three pairs of eta and k
 *
 * For each page a strip for the spectrum and for each method: the colour of the
 * reflectance under D65 against the angle of incidence, coded for sRGB and
 * clamped into it; beside it how far each is from the spectral one, by
 * CIEDE2000, where 1 is just seen.  What a method gives at 0 degrees is F0.
 */
#include "bsdf/colour.h"

#include <stdlib.h>
#include <string.h>

#include "bsdf/cli.h"
#include "bsdf/fresnel.h"
#include "plots/chart.h"
#include "plots/key.h"
#include "plots/kinds.h"
#include "plots/table.h"

enum { PAGES_MAX = 4, METHODS_MAX = 6, STEPS = 45 };

struct method {
    char name[64];
    enum colour_method way;
    struct bands bands; /* of COLOUR_FIXED */
};

struct strip {
    bool there;
    struct spectrum rgb[STEPS + 1]; /* linear */
    double off[STEPS + 1];          /* CIEDE2000 */
};

struct swatch {
    char name[128];
    struct strip spectral, of[METHODS_MAX];
    bool clamped;
};

struct swatches {
    struct method method[METHODS_MAX];
    int methods;
    struct swatch page[PAGES_MAX];
    int pages;
    double most; /* of the differences */
};

static double angle_deg(int i)
{
    return 90. * i / STEPS;
}

static double cosine(int i)
{
    return i == STEPS ? 0 : cos(angle_deg(i) * PI / 180);
}

/* The methods there are, and wavelengths of the caller's if these are new. */
static void methods_set(struct swatches *s, const struct bands *asked)
{
    static const double fixed[][3] = { { 614, 549, 466 },
                                       { 650, 550, 450 },
                                       { 630, 532, 465 } };
    s->method[s->methods++] =
        (struct method){ .name = "fit", .way = COLOUR_FIT };
    s->method[s->methods++] =
        (struct method){ .name = "average", .way = COLOUR_AVERAGE };
    for (int i = 0; i < 4; i++) {
        struct method m = { .way = COLOUR_FIXED, .bands = bands_fixed };
        if (i < 3)
            memcpy(m.bands.nm, fixed[i], sizeof fixed[i]);
        else if (asked->kind == BANDS_NM && asked->count == 3)
            m.bands = *asked;
        else
            break;
        bool known = false;
        for (int k = 0; k < s->methods; k++)
            known |= s->method[k].way == COLOUR_FIXED &&
                     s->method[k].bands.nm[0] == m.bands.nm[0] &&
                     s->method[k].bands.nm[1] == m.bands.nm[1] &&
                     s->method[k].bands.nm[2] == m.bands.nm[2];
        bands_print(&m.bands, m.name, sizeof m.name);
        if (!known)
            s->method[s->methods++] = m;
    }
}

static void strip_fill(struct strip *strip, const struct swatch *page,
                       const struct cie *cie, const struct spectrum *eta,
                       const struct spectrum *k)
{
    const struct xyz white = colour_white(cie);
    strip->there = true;
    for (int i = 0; i <= STEPS; i++) {
        const struct xyz spectral = colour_xyz(page->spectral.rgb[i]);
        for (int b = 0; b < 3; b++)
            strip->rgb[i].band[b] =
                fresnel_conductor(cosine(i), eta->band[b], k->band[b]);
        strip->off[i] =
            colour_ciede2000(colour_lab(spectral, white),
                             colour_lab(colour_xyz(strip->rgb[i]), white));
    }
}

static void clamps(struct swatch *page, const struct strip *strip)
{
    for (int i = 0; i <= STEPS; i++)
        for (int b = 0; b < 3; b++)
            page->clamped |= strip->rgb[i].band[b] < -1e-3 ||
                             strip->rgb[i].band[b] > 1 + 1e-3;
}

static bool page_add(struct swatches *s, const struct cie *cie,
                     const char *name, struct err *err)
{
    struct swatch *page = &s->page[s->pages++];
    struct ior_page *ior = ior_find(name, NULL, err);
    struct colour_metal *metal = malloc(sizeof *metal);
    bool ok = ior && (metal || err_set(err, "out of memory")) &&
              colour_metal_init(metal, cie, ior, err);
    snprintf(page->name, sizeof page->name, "%s", name);
    page->spectral.there = true;
    for (int i = 0; ok && i <= STEPS; i++)
        page->spectral.rgb[i] = colour_metal_rgb(metal, cosine(i));
    clamps(page, &page->spectral);
    for (int m = 0; ok && m < s->methods; m++) {
        struct spectrum eta, k;
        struct err why;
        /* A page may not reach three wavelengths. */
        if (!colour_conductor(cie, ior, s->method[m].way, &s->method[m].bands,
                              &eta, &k, NULL, &why))
            continue;
        strip_fill(&page->of[m], page, cie, &eta, &k);
        clamps(page, &page->of[m]);
        for (int i = 0; i <= STEPS; i++)
            s->most = fmax(s->most, page->of[m].off[i]);
    }
    ior_page_free(ior);
    free(metal);
    return ok;
}

static bool swatches_make(struct swatches *s, const struct plot_request *r,
                          struct err *err)
{
    struct cie *cie = malloc(sizeof *cie);
    char *list = strdup(r->pages), *rest = list;
    bool ok = (cie && list) || err_set(err, "out of memory");
    ok = ok && cie_load(cie, err);
    methods_set(s, &r->bands);
    for (char *name; ok && (name = strsep(&rest, ","));) {
        if (*name == '\0')
            ok = err_set(err, "colour: a name is missing between commas");
        else if (s->pages == PAGES_MAX)
            ok = err_set(err, "colour: expected at most %d pages", PAGES_MAX);
        else
            ok = page_add(s, cie, name, err);
    }
    free(list);
    free(cie);
    return ok;
}

/* -- the table ------------------------------------------------------------- */

/* Strip 0 is the spectral one, above; those of methods follow downward. */
static const struct strip *strip_of(const struct swatch *page, int i)
{
    return i == 0 ? &page->spectral : &page->of[i - 1];
}

static void table_write(FILE *out, const struct swatches *s)
{
    table_comment(out, "made by", "bsdf-plot colour " BSDF_VERSION);
    for (int p = 0; p < s->pages; p++) {
        table_comment(out, "page", s->page[p].name);
        fprintf(out, "# theta [deg]\tstrip, from below\tR\tG\tB [1], linear "
                     "sRGB under D65\tR\tG\tB [1/255], coded and clamped\t"
                     "CIEDE2000 from the spectral colour [1]\n");
        for (int k = 0; k <= s->methods; k++) {
            const struct strip *strip = strip_of(&s->page[p], k);
            table_comment(out, "method",
                          k ? s->method[k - 1].name : "spectral");
            for (int i = 0; strip->there && i <= STEPS; i++) {
                double row[9] = { angle_deg(i), s->methods - k + 0.5 };
                for (int b = 0; b < 3; b++) {
                    const double x = strip->rgb[i].band[b];
                    row[2 + b] = x;
                    row[5 + b] = round(255 * colour_srgb_encode(x));
                }
                row[8] = k ? strip->off[i] : 0;
                table_row(out, row, 9);
            }
            if (k < s->methods)
                fputc('\n', out);
        }
        fputs(p + 1 < s->pages ? "\n\n" : "", out);
    }
}

/* -- the picture ----------------------------------------------------------- */

enum { NAMES = 150, STRIPS = 388, F0 = 393, LINES = 604, ROW = 27, HEAD = 58 };

static void names(struct figure *fig, const struct swatches *s,
                  const struct swatch *page, double bottom)
{
    for (int k = 0; k <= s->methods; k++) {
        const struct strip *strip = strip_of(page, k);
        const double y = bottom + ROW * (s->methods - k + 0.5);
        const struct spectrum f0 = strip->rgb[0];
        char text[96];
        figure_label(fig, NAMES - 8, y, "right",
                     k ? s->method[k - 1].name : "spectral");
        if (!strip->there)
            snprintf(text, sizeof text, "page too short");
        else
            snprintf(text, sizeof text, "%.3f %.3f %.3f", f0.band[0],
                     f0.band[1], f0.band[2]);
        figure_label(fig, F0, y, "left", text);
    }
    figure_label(fig, F0, bottom + ROW * (s->methods + 1) + 14, "left",
                 "F₀: R, G, B");
    figure_label(fig, (NAMES + STRIPS) / 2.,
                 bottom + ROW * (s->methods + 1) + 14, "center", page->name);
}

static int curves_of(const struct swatches *s, const struct swatch *page,
                     int block, struct chart_curve *curve)
{
    int n = 0;
    for (int m = 0; m < s->methods; m++) {
        if (page && !page->of[m].there)
            continue;
        curve[n] =
            (struct chart_curve){ .block = block, .y = "$9", .line = 1 + m };
        /* The rows of one strip. */
        snprintf(curve[n].x, sizeof curve[n].x, "$2==%g ? $1 : NaN",
                 s->methods - m - 0.5);
        snprintf(curve[n++].text, sizeof curve[0].text, "%s",
                 s->method[m].name);
    }
    return n;
}

static void page_draw(struct figure *fig, const struct swatches *s, int p,
                      double bottom)
{
    const struct swatch *page = &s->page[p];
    const double top = bottom + ROW * (s->methods + 1);
    struct chart_curve curve[METHODS_MAX];
    char *also = NULL;
    const struct chart_curve nothing = {
        .block = p, .x = "NaN", .y = "NaN", .line = LINE_GRID
    };
    if (asprintf(&also,
                 ", \\\n     table index %d using 1:2:6:7:8 with rgbimage%s "
                 "notitle",
                 p, strstr(fig->form->cells, "pixels") ? " pixels" : "") < 0)
        also = NULL;
    struct chart c = {
        .x0 = NAMES,
        .x1 = STRIPS,
        .y0 = bottom,
        .y1 = top,
        .x = chart_axis_exact(0, 90, 30, "θᵢ", "deg"),
        .y = { .lo = 0, .hi = s->methods + 1, .step = s->methods + 1 },
        .bare_y = true,
        .curve = &nothing,
        .curves = 1,
        .also = also,
    };
    names(fig, s, page, bottom);
    chart_draw(fig, &c);
    free(also);
    c.also = NULL;
    c.x0 = LINES;
    c.x1 = FIGURE_PAGE - 26;
    c.y = chart_axis(0, fmax(s->most, 1), 4, "CIEDE2000", "1");
    c.bare_y = false;
    c.curve = curve;
    c.curves = curves_of(s, page, p, curve);
    chart_draw(fig, &c);
}

static void script_write(struct figure *fig, const struct swatches *s)
{
    struct chart_curve key[METHODS_MAX];
    const int n = curves_of(s, NULL, 0, key), rows = chart_key_rows(key, n);
    const double high = ROW * (s->methods + 1) + CHART_BELOW + 34;
    bool clamped = false;
    for (int p = 0; p < s->pages; p++)
        clamped |= s->page[p].clamped;
    const int notes = 1 + clamped;
    const double foot = 12 + notes * CHART_NOTE;
    const double bottom = foot + rows * KEY_ROW + 14;
    figure_page(fig, FIGURE_PAGE, bottom + s->pages * high + 4,
                "Colours of metals by the ways to R, G, B",
                "reflectance under D65 in linear sRGB, shown coded for sRGB, "
                "against the angle of incidence θᵢ");
    chart_notes(fig, foot,
                (const char *[]){
                    "CIEDE2000: difference from the spectral colour; 1 is just "
                    "seen side by side",
                    "some colours lie outside of sRGB and are shown clamped "
                    "into it" },
                notes);
    chart_key(fig, key, n, foot + 14 + (rows - 1) * KEY_ROW);
    for (int p = 0; p < s->pages; p++)
        page_draw(fig, s, p, bottom + (s->pages - 1 - p) * high + CHART_BELOW);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct figure fig;
    struct swatches *s = calloc(1, sizeof *s);
    if (!s)
        return err_set(err, "out of memory");
    bool ok =
        swatches_make(s, r, err) && figure_open(&fig, r->output, &r->look, err);
    if (ok) {
        table_write(fig.table, s);
        script_write(&fig, s);
        plot_caption(&fig, &plot_colour, r, r->pages,
                     "Colour of the reflectance under D65 against the angle of "
                     "incidence, of the whole spectrum and by each way to "
                     "three pairs of eta and k; CIEDE2000 from the former. "
                     "Pages:");
        ok = figure_draw(&fig, made, err);
    }
    free(s);
    if (ok)
        err->text[0] = '\0';
    return ok;
}

const struct plot plot_colour = {
    .name = "colour",
    .about = "swatches of a metal by the ways from eta and k to R, G, B",
    .subject = PLOT_PAGES,
    .run = run,
};
