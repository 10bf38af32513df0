/* report.c - a recorded run as one HTML page
 *
 * The page needs nothing but itself: style and pictures are inline, there is no
 * script, and it is XML as well as HTML.  Colours are the blue and vermillion
 * that those who see few colours tell apart (M. Okabe and K. Ito, Color
 * Universal Design, 2008), always beside a sign and a word.
 *
 * Pictures are made for some of the models that fail, from their worst
 * direction: what is sampled against what the pdf says, and the lobe.
 */
#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bsdf/cli.h"
#include "plots/html.h"
#include "plots/kinds.h"
#include "validate/foreign.h"
#include "validate/recorded.h"
#include "validate/report.h"

enum {
    MODELS_MAX = 6,  /* that pictures are drawn for, two each */
    WORST_MAX = 5,   /* directions of a check that fails */
    COLUMNS_MAX = 64 /* checks */
};
static const uint64_t picture_samples = 1000000;

struct page {
    FILE *out;
    const struct recorded *r;
    const char *file; /* the report's path */
    bool programs;    /* may be started */
    const char *folder;
    size_t columns; /* checks of the first result */
    int pictures, drawn_models;
};

/* -- text ------------------------------------------------------------------ */

/* A spec, which may go on in the next line behind its punctuation. */
static void spec_html(FILE *out, const char *spec)
{
    while (*spec) {
        const size_t n = strcspn(spec, ":,("), all = n + (spec[n] != '\0');
        char *part = strndup(spec, all);
        html_text(out, part ? part : "");
        free(part);
        spec += all;
        if (*spec)
            fputs("<wbr/>", out);
    }
}

/* A word of a command for the shell, in quotes where it needs them. */
static void shell_word(FILE *out, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRST"
                                "UVWXYZ0123456789_-./,:=+@%";
    if (*word && strspn(word, plain) == strlen(word)) {
        html_text(out, word);
        return;
    }
    fputs("&#39;", out);
    for (const char *p = word; *p;) {
        const size_t n = strcspn(p, "'");
        char *run = strndup(p, n);
        html_text(out, run ? run : "");
        free(run);
        p += n;
        if (*p == '\'') {
            fputs("&#39;\\&#39;&#39;", out);
            p++;
        }
    }
    fputs("&#39;", out);
}

static void number(FILE *out, double x, const char *format)
{
    if (isfinite(x))
        fprintf(out, format, x);
    else
        fputs("not finite", out);
}

static void direction(FILE *out, struct vec3 w)
{
    const struct angles a = dir_to_degrees(w);
    if (isfinite(w.x + w.y + w.z))
        fprintf(out, "%.6g°, %.5g°", a.theta_deg, a.phi_deg);
    else
        fputs("not finite", out);
}

/* -- what there is to say -------------------------------------------------- */

/* A model's results: [first, last). */
struct span {
    size_t first, last;
};

static struct span span_next(const struct recorded *r, size_t first)
{
    struct span s = { first, first };
    while (s.last < r->results &&
           r->result[s.last].model == r->result[first].model)
        s.last++;
    return s;
}

/* The verdict of a column, or NULL: results may have fewer. */
static const struct verdict *verdict_at(const struct recorded *r, size_t i,
                                        size_t column)
{
    return column < r->result[i].verdicts ? &r->result[i].verdict[column]
                                          : NULL;
}

static const struct verdict *worst_of(const struct recorded *r, struct span s,
                                      size_t column)
{
    const struct verdict *worst = NULL;
    for (size_t i = s.first; i < s.last; i++) {
        const struct verdict *v = verdict_at(r, i, column);
        if (v && (!worst || report_worse(v, worst)))
            worst = v;
    }
    return worst;
}

static bool fails(const struct verdict *v)
{
    return v && v->applies && !v->passed;
}

static size_t failures(const struct page *p, struct span s)
{
    size_t n = 0;
    for (size_t c = 0; c < p->columns; c++)
        n += fails(worst_of(p->r, s, c));
    return n;
}

static const char *sign_of(const struct verdict *v)
{
    return !v || !v->applies ? "–" : v->passed ? "✓" : "✗";
}

static const char *word_of(const struct verdict *v)
{
    return !v || !v->applies ? "n/a" : v->passed ? "pass" : "fail";
}

static const char *class_of(const struct verdict *v)
{
    return !v || !v->applies ? "none" : v->passed ? "good" : "bad";
}

/* -- head ------------------------------------------------------------------ */

static const char style[] =
    "h4{font-size:1rem;margin:0 0 .3rem}"
    "h3,.spec,pre,code{font-family:ui-monospace,monospace}"
    "p{margin:.4rem 0}"
    ".verdict{font-size:1.15rem;font-weight:600;padding:.6rem .9rem;"
    "border-left:.5rem solid;margin:.6rem 0 1rem}"
    ".verdict.good{background:#e3f0f9;border-color:#0072b2;color:#00456b}"
    ".verdict.bad{background:#fdeadd;border-color:#d55e00;color:#8a3200}"
    "dl{display:grid;grid-template-columns:max-content 1fr;gap:.1rem 1rem;"
    "margin:0}dt{color:#555}dd{margin:0}"
    ".n{text-align:right;font-variant-numeric:tabular-nums}"
    "td.wide{white-space:normal;min-width:16rem}"
    "th.spec{font-weight:400;white-space:normal;min-width:10.5rem;"
    "max-width:24rem;background:#fff}"
    "@media(min-width:60rem){th.spec{min-width:14rem}}"
    "td.good{background:#e3f0f9;color:#00456b}"
    "td.bad{background:#fdeadd;color:#8a3200;font-weight:600}"
    "td.none{color:#6a6a6a}"
    "td small{display:block;font-weight:400}"
    "article{border-left:.3rem solid #d55e00;padding:.2rem 0 .2rem .8rem;"
    "margin:.8rem 0 1.2rem}"
    ".diagnosis{background:#fff7d6;padding:.3rem .6rem}"
    ".pictures{display:grid;gap:1rem;"
    "grid-template-columns:repeat(auto-fit,minmax(min(100%,36rem),1fr))}"
    "figure svg{display:block;width:100%;"
    "height:auto;min-width:560px}"
    "@media(max-width:40rem){body{padding:.6rem}dl{grid-template-columns:1fr}"
    "dd{margin-bottom:.4rem}}"
    "@media print{body{max-width:none;font-size:11px}.scroll{overflow:visible;"
    "border:0}th,td{white-space:normal;padding:.15rem .25rem}"
    "table{font-size:.7rem}article,figure,tr{break-inside:avoid}"
    "thead th{position:static}th,td{overflow-wrap:normal}"
    "td small{display:none}th.spec{min-width:0;overflow-wrap:anywhere}"
    "details:not([open])::details-content{content-visibility:visible;"
    "block-size:auto}"
    "*{print-color-adjust:exact}}";

static void term(FILE *out, const char *what, const char *text)
{
    html_element(out, "dt", what);
    html_element(out, "dd", text);
    fputc('\n', out);
}

static void settings(const struct page *p)
{
    FILE *out = p->out;
    const struct recorded *r = p->r;
    char text[160];
    fputs("<dl>\n<dt>command</dt><dd><code>", out);
    for (size_t i = 0; i < r->words; i++) {
        fputs(i ? " " : "", out);
        shell_word(out, r->word[i]);
    }
    fputs("</code></dd>\n", out);
    bands_print(&r->bands, text, sizeof text);
    term(out, "bands", text);
    snprintf(text, sizeof text, "%llu", (unsigned long long)r->plan.seed);
    term(out, "seed", text);
    snprintf(text, sizeof text, "%llu for each model and direction",
             (unsigned long long)r->plan.samples);
    term(out, "samples", text);
    snprintf(text, sizeof text,
             "%g for the whole run, by Holm's procedure over %zu p-values",
             r->plan.significance, r->statistical);
    term(out, "significance", text);
    snprintf(text, sizeof text, "at most %d further looks at a doubtful result",
             r->plan.escalations);
    term(out, "escalations", text);
    fputs("<dt>skipped checks</dt><dd>", out);
    for (size_t i = 0; i < r->skips; i++) {
        fputs(i ? ", " : "", out);
        html_text(out, r->skip[i]);
    }
    fputs(r->skips ? "</dd>\n" : "none</dd>\n", out);
    if (r->ior_path)
        term(out, "optical constants", r->ior_path);
    term(out, "made by bsdf-validate", r->version);
    fputs("</dl>\n", out);
}

static void head(const struct page *p)
{
    FILE *out = p->out;
    const struct recorded *r = p->r;
    const bool bad = r->failed > 0;
    char title[80];
    snprintf(title, sizeof title, "%s: %zu passed, %zu failed",
             bad ? "Not sound" : "Sound", r->passed, r->failed);
    html_head(out, title, style);
    fprintf(out,
            "<body>\n<h1>Validation of scattering models</h1>\n"
            "<p class=\"verdict %s\">%s %s: %zu verdicts passed, %zu failed, "
            "of %zu model%s from %zu direction%s in all.</p>\n",
            bad ? "bad" : "good", bad ? "✗" : "✓", bad ? "Not sound" : "Sound",
            r->passed, r->failed, r->models, r->models == 1 ? "" : "s",
            r->results, r->results == 1 ? "" : "s");
    settings(p);
}

/* -- models and checks ----------------------------------------------------- */

static void cell(FILE *out, const struct verdict *v)
{
    fprintf(out, "<td class=\"%s\">%s %s", class_of(v), sign_of(v), word_of(v));
    if (v && v->applies) {
        fputs("<small>", out);
        number(out, v->value, "%.2g");
        fprintf(out, " %s ", v->passed ? "≤" : "&gt;");
        number(out, v->limit, "%.2g");
        fputs("</small><small>", out);
        direction(out, v->wo);
        fputs("</small>", out);
    }
    fputs("</td>", out);
}

static void overview(const struct page *p)
{
    FILE *out = p->out;
    const struct recorded *r = p->r;
    fputs("<h2>Models and checks</h2>\n<p>In each cell the direction (θ, φ of "
          "ωₒ) that is worst: its value, and the limit.</p>\n"
          "<div class=\"scroll\"><table>\n<thead><tr><th>model</th>",
          out);
    for (size_t c = 0; c < p->columns; c++)
        html_element(out, "th", r->result[0].verdict[c].check);
    fputs("</tr></thead>\n<tbody>\n", out);
    for (struct span s = { 0, 0 }; s.last < r->results;) {
        s = span_next(r, s.last);
        fprintf(out, "<tr><th class=\"spec\">%s ", failures(p, s) ? "✗" : "✓");
        spec_html(out, r->result[s.first].spec);
        fputs("</th>", out);
        for (size_t c = 0; c < p->columns; c++)
            cell(out, worst_of(r, s, c));
        fputs("</tr>\n", out);
    }
    fputs("</tbody></table></div>\n", out);
}

/* -- pictures -------------------------------------------------------------- */

/* Draws into the folder and removes what was drawn. */
static bool draw(struct page *p, const struct plot *plot,
                 const struct plot_request *r, struct err *err)
{
    struct figure_made made = { .paths = 0 };
    bool ok = plot->run(r, &made, err);
    char *svg = ok ? html_file(r->output) : NULL;
    if (svg) {
        p->pictures++;
        fputs("<figure><div class=\"scroll\">", p->out);
        html_svg(p->out, svg, p->pictures);
        fputs("</div><figcaption>", p->out);
        html_text(p->out, plot->about);
        fputs("</figcaption></figure>\n", p->out);
    } else if (ok) {
        ok = err_set(err, "%s: cannot be read", r->output);
    }
    free(svg);
    for (int i = 0; i < made.paths; i++)
        unlink(made.path[i]);
    figure_made_clear(&made);
    return ok;
}

/* The same names in whatever folder: they are no part of the picture. */
static void pictures_of(struct page *p, const struct recorded_result *one)
{
    static const struct plot *const kind[] = { &plot_histogram, &plot_lobe };
    FILE *out = p->out;
    char path[4200];
    struct err why = { "" };
    if (p->drawn_models == MODELS_MAX) {
        fprintf(out,
                "<p>No picture: there are some for the first %d models that "
                "fail. <code>bsdf-plot histogram</code> and <code>bsdf-plot "
                "lobe</code> draw more.</p>\n",
                MODELS_MAX);
        return;
    }
    struct bsdf *b = one->repaired ? NULL
                                   : foreign_recorded(one->spec, &p->r->bands,
                                                      p->programs, &why);
    if (!b) {
        fputs("<p>No picture: this model cannot be made again", out);
        if (why.text[0]) {
            fputs(" (", out);
            html_text(out, why.text);
            fputs(")", out);
        }
        fputs(".</p>\n", out);
        return;
    }
    p->drawn_models++;
    const uint64_t n = p->r->plan.samples;
    struct plot_request r = {
        .bsdf = { b },
        .bsdfs = 1,
        .bands = p->r->bands,
        .wo = { one->wo },
        .wos = 1,
        .phi_deg = NAN,
        .seed = p->r->plan.seed,
        .samples = n < picture_samples ? n : picture_samples,
        .output = path,
    };
    fputs("<div class=\"pictures\">\n", out);
    const bool single = !(bsdf_claims(b).lobes & ~(unsigned)BSDF_DELTA);
    if (single)
        fputs("<p>No map of samples: this model has only delta lobes.</p>\n",
              out);
    for (size_t k = single; k < 2; k++) {
        snprintf(path, sizeof path, "%s/%s.svg", p->folder, kind[k]->name);
        if (!draw(p, kind[k], &r, &why)) {
            fputs("<p>No picture: ", out);
            html_text(out, why.text);
            fputs(".</p>\n", out);
        }
    }
    fputs("</div>\n", out);
    bsdf_free(b);
}

/* -- failures -------------------------------------------------------------- */

/* The fewest digits that give the very same direction, on which the random
 * numbers depend. */
static void direction_exact(char *text, size_t size, struct vec3 w)
{
    const struct angles a = dir_to_degrees(w);
    struct vec3 back = { 0, 0, 0 };
    for (int digits = 3; digits <= 17; digits++) {
        snprintf(text, size, "%.*g,%.*g", digits, a.theta_deg, digits,
                 a.phi_deg);
        if (cli_direction(&back, text, NULL) && back.x == w.x &&
            back.y == w.y && back.z == w.z)
            return;
    }
}

static void command(const struct page *p, const struct recorded_result *one,
                    const struct verdict *v)
{
    FILE *out = p->out;
    const struct recorded *r = p->r;
    char wo[64];
    direction_exact(wo, sizeof wo, v->wo);
    fputs("<pre>bsdf-validate ", out);
    shell_word(out, one->spec);
    fprintf(out, " --wo %s --samples %llu --seed %llu ", wo,
            (unsigned long long)r->plan.samples,
            (unsigned long long)r->plan.seed);
    if (r->bands.kind == BANDS_NM) {
        fputs("--nm ", out);
        for (int b = 0; b < r->bands.count; b++)
            fprintf(out, "%s%.17g", b ? "," : "", r->bands.nm[b]);
    } else {
        fprintf(out, "--rgb %s",
                r->bands.kind == BANDS_RGB_FIT ? "fit" : "average");
    }
    if (r->plan.significance != plan_default.significance)
        fprintf(out, " --significance %.17g", r->plan.significance);
    if (r->plan.escalations != plan_default.escalations)
        fprintf(out, " --escalations %d", r->plan.escalations);
    for (size_t i = 0; i < r->skips; i++) {
        fputs(" --skip ", out);
        shell_word(out, r->skip[i]);
    }
    if (r->ior_path) {
        fputs(" --ior-path ", out);
        shell_word(out, r->ior_path);
    }
    fputs("</pre>\n<pre>bsdf-validate --replay ", out);
    shell_word(out, p->file);
    fprintf(out, " --spec %zu</pre>\n", one->model + 1);
}

/* The columns of a table of failures that have something to say. */
struct said {
    bool wi, unit, p;
};

static struct said said_of(const struct verdict *const *v, size_t n)
{
    struct said said = { false, false, false };
    for (size_t i = 0; i < n; i++) {
        said.wi |= v[i]->has_wi;
        said.unit |= v[i]->unit[0] != '\0';
        said.p |= !isnan(v[i]->p);
    }
    return said;
}

static void worst_head(FILE *out, struct said said)
{
    fputs("<thead><tr><th>ωₒ: θ, φ</th>", out);
    if (said.wi)
        fputs("<th>ωᵢ: θ, φ</th>", out);
    fputs("<th class=\"n\">value</th><th class=\"n\">limit</th>", out);
    if (said.unit)
        fputs("<th>unit</th>", out);
    if (said.p)
        fputs("<th class=\"n\">p</th>", out);
    fputs("<th class=\"n\">samples</th>", out);
    if (said.p)
        fputs("<th>fresh samples</th>", out);
    fputs("<th>numbers</th></tr></thead>\n", out);
}

static void worst_row(FILE *out, const struct verdict *v, struct said said)
{
    fputs("<tr><td>", out);
    direction(out, v->wo);
    if (said.wi) {
        fputs("</td><td>", out);
        if (v->has_wi)
            direction(out, v->wi);
    }
    fputs("</td><td class=\"n\">", out);
    number(out, v->value, "%.6g");
    fputs("</td><td class=\"n\">", out);
    number(out, v->limit, "%.4g");
    if (said.unit) {
        fputs("</td><td>", out);
        html_text(out, v->unit);
    }
    if (said.p) {
        fputs("</td><td class=\"n\">", out);
        number(out, v->p, "%.2g");
    }
    fprintf(out, "</td><td class=\"n\">%llu", (unsigned long long)v->samples);
    if (said.p)
        fprintf(out, "</td><td>%s",
                v->confirmed ? "confirm it" : "not asked for");
    fputs("</td><td class=\"wide\">", out);
    html_text(out, v->note);
    fputs("</td></tr>\n", out);
}

/* The worst directions of a check, each once, by insertion. */
static size_t worst_few(const struct recorded *r, struct span s, size_t column,
                        const struct verdict *few[WORST_MAX])
{
    size_t n = 0;
    for (size_t i = s.first; i < s.last; i++) {
        const struct verdict *v = verdict_at(r, i, column);
        if (!fails(v))
            continue;
        size_t at = n < WORST_MAX ? n++ : WORST_MAX;
        for (; at > 0 && report_worse(v, few[at - 1]); at--)
            if (at < WORST_MAX)
                few[at] = few[at - 1];
        if (at < WORST_MAX)
            few[at] = v;
    }
    return n;
}

static void failure(const struct page *p, struct span s, size_t column)
{
    FILE *out = p->out;
    const struct verdict *few[WORST_MAX] = { NULL };
    const size_t n = worst_few(p->r, s, column, few);
    size_t all = 0;
    assert(n > 0);
    for (size_t i = s.first; i < s.last; i++)
        all += fails(verdict_at(p->r, i, column));
    fputs("<article><h4>✗ ", out);
    html_text(out, few[0]->check);
    fprintf(out, ": %zu of %zu directions fail</h4>\n", all, s.last - s.first);
    if (few[0]->diagnosis[0]) {
        fputs("<p class=\"diagnosis\">Probably: ", out);
        html_text(out, few[0]->diagnosis);
        fputs("</p>\n", out);
    }
    const struct said said = said_of(few, n);
    fputs("<div class=\"scroll\"><table>", out);
    worst_head(out, said);
    fputs("<tbody>\n", out);
    for (size_t i = 0; i < n; i++)
        worst_row(out, few[i], said);
    fputs("</tbody></table></div>\n", out);
    if (all > n)
        fprintf(out, "<p>The worst %zu of %zu.</p>\n", n, all);
    command(p, &p->r->result[s.first], few[0]);
    fputs("</article>\n", out);
}

/* The result with most failures, and the worst by its own limit of those. */
static size_t worst_result(const struct page *p, struct span s)
{
    size_t worst = s.first, most = 0;
    const struct verdict *by = NULL;
    for (size_t i = s.first; i < s.last; i++) {
        const struct verdict *own = NULL;
        size_t n = 0;
        for (size_t c = 0; c < p->columns; c++) {
            const struct verdict *v = verdict_at(p->r, i, c);
            if (!fails(v))
                continue;
            n++;
            if (!own || report_worse(v, own))
                own = v;
        }
        if (n > most || (n > 0 && n == most && report_worse(own, by))) {
            worst = i;
            most = n;
            by = own;
        }
    }
    return worst;
}

static void failing(struct page *p)
{
    FILE *out = p->out;
    const struct recorded *r = p->r;
    fputs("<h2>What fails</h2>\n", out);
    if (r->failed == 0)
        fputs("<p>Nothing.</p>\n", out);
    else
        fprintf(out,
                "<p>The first command below a table runs its worst direction "
                "alone, with the limits of so small a run; the second one the "
                "whole run again, to the last bit. Pictures are drawn for at "
                "most %d models.</p>\n",
                MODELS_MAX);
    for (struct span s = { 0, 0 }; s.last < r->results;) {
        s = span_next(r, s.last);
        if (failures(p, s) == 0)
            continue;
        fputs("<section>", out);
        fputs("<h3>", out);
        spec_html(out, r->result[s.first].spec);
        fputs("</h3>\n", out);
        for (size_t c = 0; c < p->columns; c++)
            if (fails(worst_of(r, s, c)))
                failure(p, s, c);
        pictures_of(p, &r->result[worst_result(p, s)]);
        fputs("</section>\n", out);
    }
}

/* -- everything ------------------------------------------------------------ */

/* What the passes of a check would have found, from the direction where that
 * is least. */
static const char *effect_of(const struct recorded *r, struct span s,
                             size_t column)
{
    const struct verdict *least = NULL;
    for (size_t i = s.first; i < s.last; i++) {
        const struct verdict *v = verdict_at(r, i, column);
        if (v && v->effect[0] &&
            (!least || v->effect_size > least->effect_size))
            least = v;
    }
    return least ? least->effect : "";
}

static void model(const struct page *p, struct span s)
{
    FILE *out = p->out;
    const struct recorded *r = p->r;
    const size_t bad = failures(p, s);
    fprintf(out, "<details><summary>%s <span class=\"spec\">", bad ? "✗" : "✓");
    spec_html(out, r->result[s.first].spec);
    fprintf(out,
            "</span></summary>\n"
            "<div class=\"scroll\"><table><thead><tr><th>check</th>"
            "<th>verdict</th><th>worst ωₒ: θ, φ</th><th class=\"n\">value</th>"
            "<th class=\"n\">limit</th><th>unit</th><th "
            "class=\"n\">p</th><th>would have "
            "found</th><th>numbers</th></tr></thead><tbody>\n");
    for (size_t c = 0; c < p->columns; c++) {
        const struct verdict *v = worst_of(r, s, c);
        if (!v)
            continue;
        fputs("<tr>", out);
        html_element(out, "td", v->check);
        fprintf(out, "<td class=\"%s\">%s %s</td><td>", class_of(v), sign_of(v),
                word_of(v));
        if (v->applies)
            direction(out, v->wo);
        fputs("</td><td class=\"n\">", out);
        if (v->applies)
            number(out, v->value, "%.6g");
        fputs("</td><td class=\"n\">", out);
        if (v->applies)
            number(out, v->limit, "%.4g");
        fputs("</td><td>", out);
        html_text(out, v->applies ? v->unit : "");
        fputs("</td><td class=\"n\">", out);
        if (v->applies && !isnan(v->p))
            fprintf(out, "%.2g", v->p);
        fputs("</td><td class=\"wide\">", out);
        html_text(out, effect_of(r, s, c));
        fputs("</td><td class=\"wide\">", out);
        html_text(out, v->note);
        fputs("</td></tr>\n", out);
    }
    fputs("</tbody></table></div></details>\n", out);
}

static void everything(const struct page *p)
{
    fputs("<h2>Every model, and what its passes would have found</h2>\n"
          "<p>Each row has the worst direction of a check. A mistake at least "
          "as large as the one named would have failed the check 99 times of "
          "100, where passes say the least.</p>\n",
          p->out);
    for (struct span s = { 0, 0 }; s.last < p->r->results;) {
        s = span_next(p->r, s.last);
        model(p, s);
    }
}

static bool folder_make(char *folder, size_t size, struct err *err)
{
    const char *tmp = getenv("TMPDIR");
    snprintf(folder, size, "%s/bsdf-plot-XXXXXX", tmp && *tmp ? tmp : "/tmp");
    return mkdtemp(folder) ||
           err_set(err, "%s: cannot be made: %s", folder, strerror(errno));
}

/* Something else would be hard to open. */
static bool name_check(const char *path, struct err *err)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    return (dot && dot != name && strcmp(dot, ".html") == 0) ||
           err_set(err, "output \"%.200s\": expected a name that ends in .html",
                   path);
}

static bool write_page(struct page *p, const char *path,
                       struct figure_made *made, struct err *err)
{
    struct outfile out;
    if (!outfile_open(&out, path, err))
        return false;
    p->out = out.stream;
    p->columns = p->r->results ? p->r->result[0].verdicts : 0;
    head(p);
    overview(p);
    failing(p);
    everything(p);
    fputs("</body>\n</html>\n", p->out);
    return figure_made_keep(made, &out, path, err);
}

static bool run(const struct plot_request *r, struct figure_made *made,
                struct err *err)
{
    struct recorded recorded;
    char folder[4096];
    if (!name_check(r->output, err) || !recorded_read(&recorded, r->file, err))
        return false;
    bool ok = folder_make(folder, sizeof folder, err);
    if (ok && recorded.ior_path && !getenv("BSDF_IOR_PATH"))
        cli_ior_path(recorded.ior_path, NULL); /* or a model says why not */
    if (ok) {
        struct page page = { .r = &recorded,
                             .file = r->file,
                             .programs = r->programs,
                             .folder = folder };
        ok = write_page(&page, r->output, made, err);
        rmdir(folder);
    }
    recorded_clear(&recorded);
    err->text[0] = ok ? '\0' : err->text[0];
    return ok;
}

const struct plot plot_report = {
    .name = "report",
    .about = "a report of bsdf-validate --json as one page of HTML",
    .subject = PLOT_FILE,
    .file = "bsdf-validate --json",
    .extension = ".html",
    .run = run,
};
