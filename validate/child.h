/* child.h - another program, asked and answering within a time limit
 *
 * A child reads what it is told from its standard input and answers on its
 * standard output.  It and all that it starts are one process group, which dies
 * when the child is stopped, and also when this program does, in whatever way:
 * a keeper, the leader of that group, waits for the end of a pipe that only
 * this program holds open, and kills the group then.
 */
#ifndef VALIDATE_CHILD_H
#define VALIDATE_CHILD_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

#include "bsdf/err.h"

struct child {
    pid_t pid, keeper;
    int to, from, lifeline; /* our ends */
    bool asked;             /* once, at least */
    char *reply;            /* what it said last, with a NUL behind */
    size_t replied, room;
};

/** Starts a program, looked for in PATH; argv ends in NULL. */
bool child_start(struct child *c, char *const argv[], struct err *err);

/** Kills the whole group at once, waits for it, and frees. */
void child_stop(struct child *c);

/** The same where the child is said to be gone, after a moment in which it may
 * end by itself; how takes how it did: "left with status 3", "killed by signal
 * 11 (Segmentation fault)", or that it did not. */
void child_bury(struct child *c, struct err *how);

/** Ends its input, upon which it should leave by itself. */
void child_hush(struct child *c);

/** Stops a child with time for it to leave: its input ends first. */
void child_dismiss(struct child *c);

/** Says whether a reply is whole.  It is asked whenever more has come, with all
 * that has; the n bytes have a NUL behind them. */
typedef bool child_whole(void *context, const char *reply, size_t n);

enum child_said {
    CHILD_WHOLE,
    CHILD_GONE,  /* it closed its input or output before */
    CHILD_LATE,  /* the time was up before */
    CHILD_MUCH,  /* more than most bytes, and not whole */
    CHILD_SPOKE, /* it had said something before it was asked, if not for the
                    first time; not asked */
    CHILD_MEMORY,
};

/** Tells the child n bytes and takes its reply into c->reply, `most` bytes and
 * one at most, which may be more than the whole one; both at once, so that
 * neither waits for the other. */
enum child_said child_ask(struct child *c, const void *said, size_t n,
                          size_t most, double seconds, child_whole *whole,
                          void *context);

#endif
