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

enum { OPT_NM = 0x1000, OPT_RGB, OPT_IOR_PATH, OPT_SEED };

static const struct argp_option options[] = {
    { "nm", OPT_NM, "A,B,C", 0, "bands: one to four wavelengths", 0 },
    { "rgb", OPT_RGB, "METHOD", 0,
      "bands: R, G, B by fit (if neither is given), average or fixed:A,B,C",
      0 },
    { "ior-path", OPT_IOR_PATH, "DIR", 0,
      "a refractiveindex.info database (or BSDF_IOR_PATH)", 0 },
    { "seed", OPT_SEED, "S", 0, "of the random numbers; 1", 0 },
    { 0 },
};

static error_t option(int key, char *arg, struct argp_state *state)
{
    struct cli_shared *r = state->input;
    struct err err;
    bool ok;
    switch (key) {
    case OPT_NM:
        r->given = "nm";
        ok = r->has_bands = bands_parse(&r->bands, arg, &err);
        break;
    case OPT_RGB:
        r->given = "rgb";
        r->all = r->compares && strcmp(arg, "all") == 0;
        ok = r->has_bands = r->all || bands_parse_rgb(&r->bands, arg, &err);
        break;
    case OPT_IOR_PATH:
        ok = cli_ior_path(arg, &err);
        break;
    case OPT_SEED:
        r->given = "seed";
        ok = cli_count(&r->seed, "--seed", arg, 0, INT64_MAX, &err);
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    if (!ok)
        argp_failure(state, EXIT_REQUEST, 0, "%s", err.text);
    return 0;
}

const struct argp cli_shared_argp = { options, option, 0, 0, 0, 0, 0 };

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
