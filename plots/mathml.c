/* mathml.c - a formula read from left to right
 *
 * MathML Core: https://www.w3.org/TR/mathml-core/
 */
#include "plots/mathml.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH_MAX = 32 };

struct reader {
    const char *all, *at; /* the formula, and the next byte of it */
    int depth;
};

struct symbol {
    const char *name, *element, *text;
};

static const struct symbol symbols[] = {
    { "alpha", "mi", "α" },       { "beta", "mi", "β" },
    { "eta", "mi", "η" },         { "theta", "mi", "θ" },
    { "varphi", "mi", "φ" },      { "phi", "mi", "φ" },
    { "omega", "mi", "ω" },       { "Lambda", "mi", "Λ" },
    { "Omega", "mi", "Ω" },       { "pi", "mi", "π" },
    { "sigma", "mi", "σ" },       { "chi", "mi", "χ" },
    { "mu", "mi", "μ" },          { "cdot", "mo", "·" },
    { "times", "mo", "×" },       { "pm", "mo", "±" },
    { "le", "mo", "≤" },          { "ge", "mo", "≥" },
    { "approx", "mo", "≈" },      { "int", "mo", "∫" },
    { "sum", "mo", "∑" },         { "sin", "mi", "sin" },
    { "cos", "mi", "cos" },       { "tan", "mi", "tan" },
    { "arctan", "mi", "arctan" }, { "exp", "mi", "exp" },
    { "ln", "mi", "ln" },         { "max", "mi", "max" },
    { "quad", "mspace", "1em" },  { "qquad", "mspace", "2em" },
    { ",", "mspace", ".17em" },   { ";", "mspace", ".28em" },
};

static bool row(struct reader *r, FILE *out, char end, struct err *err);
static bool scripted(struct reader *r, FILE *out, struct err *err);

static bool wrong(const struct reader *r, const char *what, struct err *err)
{
    return err_set(err, "formula \"%.200s\": %s at \"%.20s\"", r->all, what,
                   r->at);
}

/* {...} or a single atom, as an element. */
static bool group(struct reader *r, FILE *out, struct err *err);

static bool pair(struct reader *r, FILE *out, const char *tag, int groups,
                 struct err *err)
{
    fprintf(out, "<%s>", tag);
    for (int i = 0; i < groups; i++)
        if (!group(r, out, err))
            return false;
    fprintf(out, "</%s>", tag);
    return true;
}

/* Letters as they stand, upright. */
static bool upright(struct reader *r, FILE *out, struct err *err)
{
    const char *close = *r->at == '{' ? strchr(r->at, '}') : NULL;
    if (!close)
        return wrong(r, "expected {letters}", err);
    for (const char *p = r->at + 1; p < close; p++)
        if (!isalnum((unsigned char)*p) && *p != ' ' && *p != ',')
            return wrong(r, "expected letters only", err);
    fprintf(out, "<mtext>%.*s</mtext>", (int)(close - r->at - 1), r->at + 1);
    r->at = close + 1;
    return true;
}

static bool fence(struct reader *r, FILE *out, struct err *err)
{
    if (!*r->at || !strchr("()[]|", *r->at))
        return wrong(r, "expected ( ) [ ] or |", err);
    fprintf(out, "<mo stretchy=\"true\">%c</mo>", *r->at++);
    return true;
}

/* From behind \left and its fence to \right and its own, as one element. */
static bool fenced(struct reader *r, FILE *out, struct err *err)
{
    static const char right[] = "\\right";
    bool ok = ++r->depth <= DEPTH_MAX || wrong(r, "too deep", err);
    while (ok && strncmp(r->at, right, strlen(right)) != 0)
        if (*r->at == ' ')
            r->at++;
        else
            ok = *r->at ? scripted(r, out, err)
                        : wrong(r, "\\right is missing", err);
    r->depth--;
    if (!ok)
        return false;
    r->at += strlen(right);
    return fence(r, out, err);
}

static bool in_row(struct reader *r, FILE *out, struct err *err)
{
    fputs("<mrow>", out);
    const bool ok = fence(r, out, err) && fenced(r, out, err);
    fputs("</mrow>", out);
    return ok;
}

static bool named(struct reader *r, FILE *out, struct err *err)
{
    const char *name = r->at;
    size_t n = 0;
    while (isalpha((unsigned char)name[n]))
        n++;
    n = n ? n : 1;
    r->at += *name ? n : 0;
    while (*r->at == ' ')
        r->at++;
#define IS(word) (n == strlen(word) && strncmp(name, word, n) == 0)
    if (IS("frac"))
        return pair(r, out, "mfrac", 2, err);
    if (IS("sqrt"))
        return pair(r, out, "msqrt", 1, err);
    if (IS("mathrm"))
        return upright(r, out, err);
    if (IS("left"))
        return in_row(r, out, err);
    if (IS("bar")) {
        fputs("<mover accent=\"true\">", out);
        const bool ok = group(r, out, err);
        fputs("<mo>¯</mo></mover>", out);
        return ok;
    }
    for (size_t i = 0; i < sizeof symbols / sizeof *symbols; i++)
        if (IS(symbols[i].name)) {
            const struct symbol *s = &symbols[i];
            if (strcmp(s->element, "mspace") == 0)
                fprintf(out, "<mspace width=\"%s\"/>", s->text);
            else
                fprintf(out, "<%s>%s</%s>", s->element, s->text, s->element);
            return true;
        }
#undef IS
    r->at = name - 1;
    return wrong(r, "unknown command", err);
}

static bool atom(struct reader *r, FILE *out, struct err *err)
{
    const char c = *r->at;
    if (c == '\\') {
        r->at++;
        return named(r, out, err);
    }
    if (c == '{')
        return group(r, out, err);
    if (isdigit((unsigned char)c)) {
        const size_t n = strspn(r->at, "0123456789.");
        fprintf(out, "<mn>%.*s</mn>", (int)n, r->at);
        r->at += n;
        return true;
    }
    if (isalpha((unsigned char)c)) {
        fprintf(out, "<mi>%c</mi>", c);
    } else if (c && strchr("+=()[]|,.;:/!", c)) {
        fprintf(out, "<mo%s>%c</mo>",
                strchr("()[]|", c) ? " stretchy=\"false\"" : "", c);
    } else if (c == '-') {
        /* A sign where nothing stands before it. */
        const bool sign = r->at == r->all || strchr("({[", r->at[-1]);
        fprintf(out, "<mo%s>−</mo>", sign ? " form=\"prefix\"" : "");
    } else if (c == '<' || c == '>') {
        fprintf(out, "<mo>%s</mo>", c == '<' ? "&lt;" : "&gt;");
    } else {
        return wrong(r, "cannot be read", err);
    }
    r->at++;
    return true;
}

static bool group(struct reader *r, FILE *out, struct err *err)
{
    if (*r->at != '{')
        return atom(r, out, err);
    r->at++;
    fputs("<mrow>", out);
    const bool ok = row(r, out, '}', err);
    fputs("</mrow>", out);
    r->at += ok;
    return ok;
}

/* What is set apart from its argument. */
static bool is_function(const char *name)
{
    static const char *const functions[] = { "sin", "cos",    "tan",
                                             "exp", "arctan", "ln" };
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
        const size_t n = strlen(functions[i]);
        if (strncmp(name, functions[i], n) == 0 &&
            !isalpha((unsigned char)name[n]))
            return true;
    }
    return false;
}

/* An atom with what hangs on it. */
static bool scripted(struct reader *r, FILE *out, struct err *err)
{
    char *base = NULL, *sub = NULL, *super = NULL, **which;
    size_t size;
    FILE *mem = open_memstream(&base, &size);
    bool ok = mem || err_set(err, "out of memory");
    const bool letters = r->at[0] == '\\' && is_function(r->at + 1);
    if (mem) {
        ok = atom(r, mem, err);
        fclose(mem);
    }
    while (ok && (*r->at == '_' || *r->at == '^')) {
        which = *r->at == '_' ? &sub : &super;
        if (*which)
            ok = wrong(r, "a second one", err);
        mem = ok ? open_memstream(which, &size) : NULL;
        r->at++;
        if (mem) {
            ok = group(r, mem, err);
            fclose(mem);
        }
    }
    if (ok && (sub || super)) {
        const char *tag = sub && super ? "msubsup" : sub ? "msub" : "msup";
        fprintf(out, "<%s>%s%s%s</%s>", tag, base, sub ? sub : "",
                super ? super : "", tag);
    } else if (ok) {
        fputs(base, out);
    }
    if (ok && letters && *r->at && !strchr("(|)}", *r->at))
        fputs("<mspace width=\".17em\"/>", out);
    free(base);
    free(sub);
    free(super);
    return ok;
}

static bool row(struct reader *r, FILE *out, char end, struct err *err)
{
    bool ok = ++r->depth <= DEPTH_MAX || wrong(r, "too deep", err);
    while (ok && *r->at != end) {
        if (*r->at == ' ')
            r->at++;
        else if (*r->at == '\0')
            ok = wrong(r, "} is missing", err);
        else
            ok = scripted(r, out, err);
    }
    r->depth--;
    return ok;
}

bool mathml(FILE *out, const char *latex, bool display, struct err *err)
{
    struct reader r = { latex, latex, 0 };
    fprintf(out, "<math xmlns=\"http://www.w3.org/1998/Math/MathML\"%s><mrow>",
            display ? " display=\"block\"" : "");
    const bool ok = row(&r, out, '\0', err);
    fputs("</mrow></math>", out);
    return ok;
}
