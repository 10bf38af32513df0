/* shell.h - commands as a user would type them, in a folder of the test's own
 *
 * shell_setup comes first and shell_teardown last; between them $T is the
 * folder, $ROOT the repository, where the commands start, $BIN has the
 * programs and comes first in PATH, and standard input is empty.
 */
#ifndef TESTS_SHELL_H
#define TESTS_SHELL_H

/** $T, a full path. */
extern char folder[64];

/** What the last command printed on standard output, cut off where it is more,
 * and a 0. */
extern char output[1 << 20];

/** Makes $T, /tmp/bsdf-NAME-...; the programs are those of the folder that BIN
 * names, build/bin if none.  Each command follows before, which may be "", or
 * "exec 2>&1; " where output is to have standard error as well.  Nonzero, as
 * for cmocka, if it cannot. */
int shell_setup(const char *name, const char *before);

/** Removes $T; the teardown of a group. */
int shell_teardown(void **state);

/** The path of a file in $T, until the call after the next. */
const char *in_folder(const char *name);

/** Runs a shell command; its exit status, or -1 if it was killed. */
int sh(const char *command);

/** A command that ends with the status; fails with what it printed if not. */
void ends(const char *command, int expected);

/** The same with status 0. */
void does(const char *command);

/** The same, where all that it prints is known. */
void prints(const char *command, const char *expected);

/** A wrong request, made in an empty folder: status 2, one line on standard
 * error with both parts, nothing on standard output and no file. */
void refused(const char *command, const char *a, const char *b);

#endif
