/* shell.c - by popen */
#include "tests/shell.h"

#include <stdio.h>
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
