/* shell.c - by popen */
#include "tests/shell.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>

#include "tests/close.h"

char folder[64], output[1 << 20];

static const char *first = "";

int shell_setup(const char *name, const char *before)
{
    char path[8192];
    const char *given = getenv("BIN");
    char *bin = realpath(given ? given : "build/bin", NULL);
    char *root = realpath(".", NULL);
    first = before;
    snprintf(folder, sizeof folder, "/tmp/bsdf-%s-XXXXXX", name);
    snprintf(path, sizeof path, "%s:%s", bin ? bin : "", getenv("PATH"));
    unsetenv("T");
    unsetenv("BSDF_IOR_PATH");
    unsetenv("BSDF_PLUGIN_HOST");
    const bool good = bin && root && mkdtemp(folder) &&
                      !setenv("T", folder, 1) && !setenv("ROOT", root, 1) &&
                      !setenv("BIN", bin, 1) && !setenv("PATH", path, 1);
    free(bin);
    free(root);
    return good ? 0 : -1;
}

int shell_teardown(void **state)
{
    (void)state;
    return sh("rm -rf \"$T\"");
}

const char *in_folder(const char *name)
{
    static char path[2][256];
    static int turn;
    turn = !turn;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
    return path[turn];
}

int sh(const char *command)
{
    char *line;
    assert_true(asprintf(&line, "exec </dev/null; %s%s", first, command) > 0);
    FILE *pipe = popen(line, "r");
    free(line);
    assert_non_null(pipe);
    const size_t n = fread(output, 1, sizeof output - 1, pipe);
    output[n] = '\0';
    while (fgetc(pipe) != EOF)
        ;
    const int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void ends(const char *command, int expected)
{
    const int status = sh(command);
    if (status != expected)
        fail_msg("%s: status %d, expected %d: %s", command, status, expected,
                 output);
}

void does(const char *command)
{
    ends(command, 0);
}

void prints(const char *command, const char *expected)
{
    does(command);
    if (strcmp(output, expected) != 0)
        fail_msg("%s: \"%s\", expected \"%s\"", command, output, expected);
}

void refused(const char *command, const char *a, const char *b)
{
    char *line;
    assert_true(asprintf(&line,
                         "mkdir -p $T/refused && cd $T/refused && { %s; } 2>&1 "
                         ">$T/printed",
                         command) > 0);
    ends(line, 2);
    free(line);
    assert_has(output, a);
    assert_has(output, b);
    const char *end = strchr(output, '\n');
    if (!end || end[1] != '\0')
        fail_msg("%s: expected one line: %s", command, output);
    does("[ ! -s $T/printed ] && rmdir $T/refused");
}
