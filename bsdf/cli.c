/* cli.c - reading what a user typed, telling how far the work is */
#include "bsdf/cli.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

bool cli_direction(struct vec3 *w, const char *text, struct err *err)
{
    char *end;
    const double theta_deg = strtod(text, &end);
    if (end != text && *end == ',') {
        const char *second = end + 1;
        const double phi_deg = strtod(second, &end);
        if (end != second && *end == '\0' && isfinite(phi_deg) &&
            theta_deg >= 0 && theta_deg <= 180) {
            *w = dir_from_degrees(theta_deg, phi_deg);
            return true;
        }
    }
    return err_set(err,
                   "direction \"%.60s\": expected THETA,PHI in degrees, "
                   "theta in [0, 180], as in 45,0",
                   text);
}

bool cli_count(uint64_t *n, const char *what, const char *text, uint64_t min,
               uint64_t max, struct err *err)
{
    char *end;
    errno = 0;
    uint64_t value = strtoull(text, &end, 10);
    bool ok = isdigit((unsigned char)*text) && errno == 0;
    if (ok && (*end == 'e' || *end == 'E')) {
        /* 1e6, and nothing that a double could round */
        const double x = strtod(text, &end);
        ok = x >= 0 && x <= 0x1p53 && x == floor(x);
        value = ok ? (uint64_t)x : 0;
    }
    if (!ok || *end != '\0' || value < min || value > max)
        return err_set(err, "%s %.60s: expected a whole number in [%llu, %llu]",
                       what, text, (unsigned long long)min,
                       (unsigned long long)max);
    *n = value;
    return true;
}

bool cli_number(double *x, const char *what, const char *text, double min,
                double max, struct err *err)
{
    char *end;
    const double value = strtod(text, &end);
    if (end == text || *end != '\0' || !(value >= min && value <= max))
        return err_set(err, "%s %.60s: expected a number in [%g, %g]", what,
                       text, min, max);
    *x = value;
    return true;
}

bool cli_ior_path(const char *path, struct err *err)
{
    struct stat about;
    if (stat(path, &about) != 0)
        return err_set(err, "--ior-path %s: %s", path, strerror(errno));
    if (!S_ISDIR(about.st_mode))
        return err_set(err, "--ior-path %s: expected a folder", path);
    return setenv("BSDF_IOR_PATH", path, 1) == 0 ||
           err_set(err, "out of memory");
}

double cli_elapsed(void)
{
    static double first = -1;
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    const double now = (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
    first = first < 0 ? now : first;
    return now - first;
}

void cli_progress(const char *what, size_t done, size_t of)
{
    const double left = cli_elapsed() * (double)(of - done) / (double)done;
    fprintf(stderr, "\r%zu of %zu %s, %.0f s left\033[K%s", done, of, what,
            left, done == of ? "\r\033[K" : "");
    fflush(stderr);
}
