/* verdict.c - notes that fit */
#include "validate/verdict.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void add(struct verdict *v, const char *format, va_list args)
{
    const size_t used = strlen(v->note);
    vsnprintf(v->note + used, sizeof v->note - used, format, args);
}

void verdict_note(struct verdict *v, const char *format, ...)
{
    va_list args;
    v->note[0] = '\0';
    va_start(args, format);
    add(v, format, args);
    va_end(args);
}

void verdict_add(struct verdict *v, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    add(v, format, args);
    va_end(args);
}
