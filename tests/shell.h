/* shell.h - a command as a user would type it */
#ifndef TESTS_SHELL_H
#define TESTS_SHELL_H

#include <stddef.h>

/** Runs a shell command; its exit status, or -1 if it was killed.  output, of
 * the size, takes what it printed on standard output, cut off where it is more,
 * and a 0. */
int shell(const char *command, char *output, size_t size);

/** Puts the programs, in the folder that BIN names (build/bin if none), before
 * what PATH has, and makes /tmp/bsdf-NAME-..., a folder of the test's own,
 * which is $T; both full paths are filled in.  Nonzero, as for cmocka, if it
 * cannot. */
int shell_setup(const char *name, char bin[4096], char folder[64]);

#endif
