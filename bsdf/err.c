/* err.c - sentences about what went wrong, and what was probably meant
 *
 * V. Levenshtein, Binary codes capable of correcting deletions, insertions,
 * and reversals, Soviet Physics Doklady 10, 1966; by one row of the table.
 */
#include "bsdf/err.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

bool err_set(struct err *err, const char *format, ...)
{
    if (!err)
        return false;
    va_list args;
    va_start(args, format);
    vsnprintf(err->text, sizeof err->text, format, args);
    va_end(args);
    return false;
}

static size_t lower(char c)
{
    return (size_t)(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
}

static size_t distance(const char *a, const char *b, size_t worst)
{
    size_t row[65];
    const size_t na = strlen(a), nb = strlen(b);
    if (na >= 64 || nb >= 64)
        return worst;
    for (size_t j = 0; j <= nb; j++)
        row[j] = j;
    for (size_t i = 1; i <= na; i++) {
        size_t corner = row[0];
        row[0] = i;
        for (size_t j = 1; j <= nb; j++) {
            size_t least = corner + (lower(a[i - 1]) != lower(b[j - 1]));
            corner = row[j];
            if (row[j] + 1 < least)
                least = row[j] + 1;
            if (row[j - 1] + 1 < least)
                least = row[j - 1] + 1;
            row[j] = least;
        }
    }
    return row[nb];
}

const char *err_nearest(const char *meant, const char *const words[])
{
    const char *nearest = NULL;
    const size_t length = strlen(meant);
    size_t least = (length < 3 ? 1 : length / 3) + 1;
    for (; *words; words++) {
        const size_t d = distance(meant, *words, least);
        if (d < least) {
            least = d;
            nearest = *words;
        }
    }
    return nearest;
}

bool err_unknown(struct err *err, const char *what, const char *meant,
                 const char *const words[])
{
    char list[512] = "";
    for (int i = 0; words[i]; i++) {
        const size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "",
                 words[i]);
    }
    const char *near = err_nearest(meant, words);
    if (near)
        return err_set(err,
                       "%s \"%.60s\" is unknown: did you mean \"%s\"? "
                       "There is: %s",
                       what, meant, near, list);
    return err_set(err, "%s \"%.60s\" is unknown; there is: %s", what, meant,
                   list[0] ? list : "nothing to set");
}
