/* publish.c - the lines between two markers, and what else they say */
#include "tests/publish.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bsdf/outfile.h"

/* Copies a file, with the text between the markers in place of what was there;
 * whether both were met, once and in order. */
static bool copy(FILE *in, FILE *out, const char *begin, const char *end,
                 const char *text)
{
    char *line = NULL;
    size_t size = 0;
    bool inside = false, ok = true;
    int met = 0;
    while (getline(&line, &size, in) >= 0) {
        if (strcmp(line, end) == 0) {
            ok &= inside;
            inside = false;
        }
        if (!inside)
            fputs(line, out);
        if (strcmp(line, begin) == 0) {
            ok &= !inside;
            inside = true;
            met++;
            fprintf(out, "%s", text);
        }
    }
    free(line);
    return ok && met == 1 && !inside;
}

bool publish(const char *path, const char *mark, const char *text,
             struct err *err)
{
    char begin[80], end[80];
    struct outfile out;
    snprintf(begin, sizeof begin, "<!-- %s -->\n", mark);
    snprintf(end, sizeof end, "<!-- /%s -->\n", mark);
    FILE *in = fopen(path, "r");
    if (!in)
        return err_set(err, "%s: cannot be read", path);
    bool ok = outfile_open(&out, path, err);
    if (ok && copy(in, out.stream, begin, end, text)) {
        ok = outfile_close(&out, err);
    } else if (ok) {
        outfile_abandon(&out);
        ok = err_set(err,
                     "%s: expected the lines <!-- %s --> and <!-- /%s -->"
                     ", once and in this order",
                     path, mark, mark);
    }
    fclose(in);
    return ok;
}

struct machine machine_now(void)
{
    struct machine m = { .processor = "an unknown processor" };
    char line[256];
    const time_t now = time(NULL);
    FILE *f = fopen("/proc/cpuinfo", "r");
    while (f && fgets(line, sizeof line, f))
        if (sscanf(line, "model name : %199[^\n]", m.processor) == 1)
            break;
    if (f)
        fclose(f);
    strftime(m.date, sizeof m.date, "%Y-%m-%d", localtime(&now));
    return m;
}
