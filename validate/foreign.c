/* foreign.c - what a spec is the spec of */
#include "validate/foreign.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "validate/pipe.h"

static const char pipe_prefix[] = "pipe:", host_name[] = "bsdf-plugin-host";

/* The length of "my/path.so" in "my/path.so:alpha=0.2", or 0 where a spec is
 * none of a shared object. */
static size_t object_length(const char *spec)
{
    const size_t n = strcspn(spec, ":");
    return n >= 3 && memcmp(spec + n - 3, ".so", 3) == 0 ? n : 0;
}

/* In the folder of this program, or the one above it. */
static bool host_beside(char *path, size_t size)
{
    char self[PATH_MAX];
    const ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
    if (n < 0)
        return false;
    self[n] = '\0';
    for (int up = 0; up < 2; up++) {
        char *slash = strrchr(self, '/');
        if (!slash)
            return false;
        *slash = '\0';
        const int length = snprintf(path, size, "%s/%s", self, host_name);
        if (length > 0 && (size_t)length < size && access(path, X_OK) == 0)
            return true;
    }
    return false;
}

static struct bsdf *object_new(const char *spec, size_t length,
                               const struct bands *bands, struct err *err)
{
    char path[PATH_MAX];
    const char *host = getenv("BSDF_PLUGIN_HOST");
    if (!host || !*host)
        host = host_beside(path, sizeof path) ? path : host_name;
    char *object = strndup(spec, length);
    if (!object) {
        err_set(err, "out of memory");
        return NULL;
    }
    const char *settings = spec[length] == ':' ? spec + length + 1 : NULL;
    char *const argv[] = { (char *)host, object, (char *)settings, NULL };
    struct bsdf *b = pipe_new(spec, argv, bands, err);
    free(object);
    return b;
}

struct bsdf *foreign_new(const char *spec, const struct bands *bands,
                         struct err *err)
{
    const size_t prefix = sizeof pipe_prefix - 1, length = object_length(spec);
    if (strncmp(spec, pipe_prefix, prefix) == 0) {
        char *const argv[] = { "sh", "-c", (char *)spec + prefix, NULL };
        return pipe_new(spec, argv, bands, err);
    }
    if (length == 0)
        return bsdf_new(spec, bands, err);
    if (memchr(spec, '/', length))
        return object_new(spec, length, bands, err);
    err_set(err, "spec \"%.200s\": write ./%.200s for a shared object", spec,
            spec);
    return NULL;
}

struct bsdf *foreign_recorded(const char *spec, const struct bands *bands,
                              bool programs, struct err *err)
{
    const bool library = strncmp(spec, pipe_prefix, sizeof pipe_prefix - 1) &&
                         object_length(spec) == 0;
    if (library || programs)
        return foreign_new(spec, bands, err);
    err_set(err, "spec \"%.200s\" starts a program: expected --programs", spec);
    return NULL;
}
