/* shell.h - a command as a user would type it */
#ifndef TESTS_SHELL_H
#define TESTS_SHELL_H

#include <stddef.h>

/** Runs a shell command; its exit status, or -1 if it was killed.  output, of
 * the size, takes what it printed on standard output, cut off where it is more,
 * and a 0. */
int shell(const char *command, char *output, size_t size);

#endif
