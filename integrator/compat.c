/* compat.c - the course's ways of doing things, by name */
#include "integrator/compat.h"

#include <stdio.h>
#include <string.h>

/* In the order of the bits. */
static const char *const names[] = { "camera",     "tone",       "light-pdf",
                                     "light-quad", "schlick",    "lambda",
                                     "fresnel",    "refraction", NULL };
static const char *const words[] = { "course",     "none",      "camera",
                                     "tone",       "light-pdf", "light-quad",
                                     "schlick",    "lambda",    "fresnel",
                                     "refraction", NULL };

bool compat_parse(unsigned *compat, const char *text, struct err *err)
{
    unsigned read = 0;
    for (const char *at = text;;) {
        const size_t length = strcspn(at, ",");
        char word[64];
        snprintf(word, sizeof word, "%.*s", (int)(length < 63 ? length : 63),
                 at);
        int i = 0;
        while (names[i] && strcmp(names[i], word) != 0)
            i++;
        if (names[i])
            read |= 1u << i;
        else if (strcmp(word, "course") == 0)
            read |= COMPAT_COURSE;
        else if (strcmp(word, "none") != 0)
            return err_unknown(err, "compatibility", word, words);
        if (at[length] == '\0')
            break;
        at += length + 1;
    }
    *compat = read;
    return true;
}

void compat_print(unsigned compat, char *text, int size)
{
    int used = 0;
    snprintf(text, (size_t)size, "none");
    for (int i = 0; names[i] && used < size; i++)
        if (compat & 1u << i)
            used += snprintf(text + used, (size_t)(size - used), "%s%s",
                             used ? "," : "", names[i]);
}
