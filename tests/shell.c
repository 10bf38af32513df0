/* shell.c - by popen */
#include "tests/shell.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>

#include "tests/close.h"

int shell(const char *command, char *output, size_t size)
{
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    const size_t n = fread(output, 1, size - 1, pipe);
    output[n] = '\0';
    while (fgetc(pipe) != EOF)
        ;
    const int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int shell_setup(const char *name, char bin[4096], char folder[64])
{
    char path[8192];
    const char *given = getenv("BIN");
    if (!realpath(given ? given : "build/bin", bin))
        return -1;
    snprintf(path, sizeof path, "%s:%s", bin, getenv("PATH"));
    snprintf(folder, 64, "/tmp/bsdf-%s-XXXXXX", name);
    return mkdtemp(folder) && setenv("PATH", path, 1) == 0 &&
                   setenv("T", folder, 1) == 0
               ? 0
               : -1;
}
