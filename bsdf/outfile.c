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

bool outfile_open(struct outfile *out, const char *path, struct err *err)
{
    *out = (struct outfile){ .path = strdup(path) };
    if (!out->path || asprintf(&out->temporary, "%s.XXXXXX", path) < 0) {
        out->temporary = NULL;
        forget(out);
        return err_set(err, "out of memory");
    }
    const int fd = mkstemp(out->temporary);
    if (fd >= 0) {
        const mode_t mask = umask(0); /* mkstemp's 0600 is not a user's file */
        umask(mask);
        fchmod(fd, 0666 & ~mask);
        out->stream = fdopen(fd, "w");
    }
    if (out->stream)
        return true;
    err_set(err, "%s: cannot be written: %s", path, strerror(errno));
    if (fd >= 0) {
        close(fd);
        unlink(out->temporary);
    }
    forget(out);
    return false;
}

bool outfile_close(struct outfile *out, struct err *err)
{
    bool ok = !ferror(out->stream) && fflush(out->stream) == 0 &&
              fsync(fileno(out->stream)) == 0;
    ok = fclose(out->stream) == 0 && ok;
    ok = ok && rename(out->temporary, out->path) == 0;
    if (!ok) {
        err_set(err, "%s: cannot be written: %s", out->path, strerror(errno));
        unlink(out->temporary);
    }
    forget(out);
    return ok;
}

void outfile_abandon(struct outfile *out)
{
    fclose(out->stream);
    unlink(out->temporary);
    forget(out);
}
