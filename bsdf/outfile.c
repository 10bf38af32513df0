/* outfile.c - write aside, then rename */
#include "bsdf/outfile.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void forget(struct outfile *out)
{
    free(out->path);
    free(out->temporary);
    *out = (struct outfile){ 0 };
}

/* Opens a file beside the path, with the rights of the one that it replaces or
 * those of a new one. */
static FILE *open_aside(struct outfile *out, const struct stat *old)
{
    const int fd = mkstemp(out->temporary);
    if (fd < 0)
        return NULL;
    const mode_t mask = umask(0); /* mkstemp's own are 0600 */
    umask(mask);
    FILE *stream = fchmod(fd, old ? old->st_mode & 0777 : 0666 & ~mask) == 0
                       ? fdopen(fd, "w")
                       : NULL;
    if (!stream) {
        const int why = errno;
        close(fd);
        unlink(out->temporary);
        errno = why;
    }
    return stream;
}

bool outfile_open(struct outfile *out, const char *path, struct err *err)
{
    struct stat old;
    const bool exists = stat(path, &old) == 0;
    *out = (struct outfile){ 0 };
    out->path = exists ? realpath(path, NULL) : NULL;
    if (!out->path)
        out->path = strdup(path);
    const bool aside = !exists || S_ISREG(old.st_mode);
    if (!out->path ||
        (aside && asprintf(&out->temporary, "%s.XXXXXX", out->path) < 0)) {
        out->temporary = NULL;
        forget(out);
        return err_set(err, "out of memory");
    }
    out->stream =
        aside ? open_aside(out, exists ? &old : NULL) : fopen(path, "w");
    if (out->stream)
        return true;
    err_set(err, "%s: cannot be written: %s", path, strerror(errno));
    forget(out);
    return false;
}

bool outfile_close(struct outfile *out, struct err *err)
{
    bool ok = !ferror(out->stream) && fflush(out->stream) == 0 &&
              (!out->temporary || fsync(fileno(out->stream)) == 0);
    ok = fclose(out->stream) == 0 && ok;
    ok = ok && (!out->temporary || rename(out->temporary, out->path) == 0);
    if (!ok) {
        err_set(err, "%s: cannot be written: %s", out->path, strerror(errno));
        if (out->temporary)
            unlink(out->temporary);
    }
    forget(out);
    return ok;
}

void outfile_abandon(struct outfile *out)
{
    fclose(out->stream);
    if (out->temporary)
        unlink(out->temporary);
    forget(out);
}
