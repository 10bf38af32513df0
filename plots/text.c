/* text.c - from UTF-8 to LaTeX */
#include "plots/text.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Longer ones before those that they begin with. */
static const char *const pairs[][2] = {
    { "θᵢ", "$\\theta_i$" },
    { "φᵢ", "$\\varphi_i$" },
    { "θₒ", "$\\theta_o$" },
    { "φₒ", "$\\varphi_o$" },
    { "ωᵢ", "$\\omega_i$" },
    { "ωₒ", "$\\omega_o$" },
    { "θ_h", "$\\theta_h$" },
    { "θ_d", "$\\theta_d$" },
    { "φ_d", "$\\varphi_d$" },
    { "φ′", "$\\varphi'$" },
    { "F₀", "$F_0$" },
    { "R₀", "$R_0$" },
    { "√n", "$\\sqrt{n}$" },
    { "√E", "$\\sqrt{E}$" },
    { "θ", "$\\theta$" },
    { "φ", "$\\varphi$" },
    { "ω", "$\\omega$" },
    { "δ", "$\\delta$" },
    { "Δ", "$\\Delta$" },
    { "Λ", "$\\Lambda$" },
    { "λ", "$\\lambda$" },
    { "σ", "$\\sigma$" },
    { "α", "$\\alpha$" },
    { "η", "$\\eta$" },
    { "π", "$\\pi$" },
    { "√", "$\\surd$" },
    { "°", "$^\\circ$" },
    { "′", "$'$" },
    { "−", "$-$" },
    { "–", "--" },
    { "“", "``" },
    { "”", "''" },
    { "·", "$\\cdot$" },
    { "×", "$\\times$" },
    { "±", "$\\pm$" },
    { "≤", "$\\le$" },
    { "≥", "$\\ge$" },
    { "≈", "$\\approx$" },
    { "…", "\\dots{}" },
    { "⁻", "$^-$" },
    { "⁰", "$^0$" },
    { "¹", "$^1$" },
    { "²", "$^2$" },
    { "³", "$^3$" },
    { "⁴", "$^4$" },
    { "⁵", "$^5$" },
    { "⁶", "$^6$" },
    { "⁷", "$^7$" },
    { "⁸", "$^8$" },
    { "⁹", "$^9$" },
    { "\\", "\\textbackslash{}" },
    { "{", "\\{" },
    { "}", "\\}" },
    { "$", "\\$" },
    { "&", "\\&" },
    { "#", "\\#" },
    { "%", "\\%" },
    { "_", "\\_" },
    { "^", "\\textasciicircum{}" },
    { "~", "\\textasciitilde{}" },
    { "<", "$<$" },
    { ">", "$>$" },
    { "|", "$|$" },
    { "\"", "''" },
    { "[", "{[}" }, /* a label of gnuplot's must not begin with it */
};

/* How many bytes a character takes, and its code point. */
static size_t decode(const unsigned char *p, unsigned *code)
{
    const size_t n = *p < 0x80 ? 1 : *p < 0xe0 ? 2 : *p < 0xf0 ? 3 : 4;
    static const unsigned char first[] = { 0, 0x7f, 0x1f, 0x0f, 0x07 };
    *code = *p & first[n];
    for (size_t i = 1; i < n; i++) {
        if ((p[i] & 0xc0) != 0x80)
            return i; /* not UTF-8 after all */
        *code = *code << 6 | (p[i] & 0x3f);
    }
    return n;
}

static void tex_write(FILE *out, const char *text, size_t size)
{
    enum { PAIRS = sizeof pairs / sizeof *pairs };
    for (const char *end = text + size; text < end;) {
        size_t i = 0, n;
        unsigned code;
        while (i < PAIRS &&
               strncmp(text, pairs[i][0], strlen(pairs[i][0])) != 0)
            i++;
        if (i < PAIRS) {
            fputs(pairs[i][1], out);
            text += strlen(pairs[i][0]);
            continue;
        }
        n = decode((const unsigned char *)text, &code);
        if (code < 0x80)
            fputc(*text, out);
        else
            fprintf(out, "U+%04X", code);
        text += n;
    }
}

size_t text_piece(const char *spec)
{
    const size_t n = strcspn(spec, ":,/=_");
    return n + (spec[n] != '\0');
}

static char *tex_of(const char *text, bool spec)
{
    char *tex = NULL;
    size_t size;
    FILE *out = open_memstream(&tex, &size);
    if (!out)
        return NULL;
    fputs("\\relax{}", out); /* nor with a brace */
    while (*text) {
        const size_t n = spec ? text_piece(text) : strlen(text);
        tex_write(out, text, n);
        text += n;
        if (*text)
            fputs("\\allowbreak{}", out);
    }
    if (fclose(out) == 0)
        return tex;
    free(tex);
    return NULL;
}

char *text_tex(const char *text)
{
    return tex_of(text, false);
}

char *text_tex_spec(const char *spec)
{
    return tex_of(spec, true);
}
