/* verdict.c - notes that fit, p-values of parts, smallest effects */
#include "validate/verdict.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "validate/power.h"
#include "validate/pvalue.h"

static void add(char *text, size_t size, const char *format, va_list args)
{
    const size_t used = strlen(text);
    vsnprintf(text + used, size - used, format, args);
}

void verdict_note(struct verdict *v, const char *format, ...)
{
    va_list args;
    v->note[0] = '\0';
    va_start(args, format);
    add(v->note, sizeof v->note, format, args);
    va_end(args);
}

void verdict_add(struct verdict *v, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    add(v->note, sizeof v->note, format, args);
    va_end(args);
}

void verdict_found(struct verdict *v, const char *format, ...)
{
    va_list args;
    if (v->effect[0])
        strncat(v->effect, "; ", sizeof v->effect - strlen(v->effect) - 1);
    va_start(args, format);
    add(v->effect, sizeof v->effect, format, args);
    va_end(args);
}

void verdict_part(struct verdict *v, struct verdict_part part)
{
    assert(v->parts < VERDICT_PARTS_MAX);
    v->part[v->parts++] = part;
}

void verdict_combine(struct verdict *v)
{
    double p[VERDICT_PARTS_MAX];
    for (int i = 0; i < v->parts; i++)
        p[i] = v->part[i].p;
    v->p = pvalue_best(p, v->parts);
}

/* The smallest mistake that a part would find at a level. */
static double smallest(const struct verdict_part *part, double level)
{
    switch (part->kind) {
    case PART_CHI_SQUARE:
        return sqrt(power_chi_square(part->degrees, level) / part->scale);
    case PART_NORMAL:
        return power_normal(level) / part->scale;
    case PART_POISSON:
        return power_poisson(part->mean, level) / part->scale;
    case PART_OTHER:
    default:
        return NAN;
    }
}

void verdict_effect(struct verdict *v, double level)
{
    for (int i = 0; i < v->parts; i++) {
        const struct verdict_part *part = &v->part[i];
        const double d =
            part->before ? smallest(part, level / v->parts) + part->error : NAN;
        if (!(d < 1)) /* nor where it is not a number */
            continue;
        if (!v->effect[0])
            v->effect_size = d;
        verdict_found(v, "%s%s%.2g %s", part->before,
                      part->before[0] ? " " : "", 100 * d, part->after);
    }
}
