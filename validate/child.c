/* child.c - posix_spawn, two pipes, and a keeper */
#include "validate/child.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* Blocks until the pipe that this program holds ends, and kills its group. */
static const char keeper_script[] = "trap '' HUP INT TERM; read -r x; "
                                    "kill -KILL 0";

/* Above the standard streams, lest one that is closed here be overwritten
 * there. */
static bool pipe_above(int end[2])
{
    int low[2];
    if (pipe2(low, O_CLOEXEC) != 0)
        return false;
    for (int i = 0; i < 2; i++) {
        end[i] = fcntl(low[i], F_DUPFD_CLOEXEC, 3);
        close(low[i]);
    }
    if (end[0] >= 0 && end[1] >= 0)
        return true;
    for (int i = 0; i < 2; i++)
        if (end[i] >= 0)
            close(end[i]);
    return false;
}

static void shut(int *fd)
{
    if (*fd >= 0)
        close(*fd);
    *fd = -1;
}

/* A program in a process group, 0 for a new one that it leads; out < 0 for
 * nowhere.  An errno, or 0. */
static int spawn(pid_t *pid, char *const argv[], pid_t group, int in, int out)
{
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_t files;
    sigset_t none, pipe;
    int bad = posix_spawnattr_init(&attributes);
    if (bad)
        return bad;
    bad = posix_spawn_file_actions_init(&files);
    if (bad) {
        posix_spawnattr_destroy(&attributes);
        return bad;
    }
    sigemptyset(&none);
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP |
                                              POSIX_SPAWN_SETSIGMASK |
                                              POSIX_SPAWN_SETSIGDEF);
    posix_spawnattr_setpgroup(&attributes, group);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &pipe);
    bad = posix_spawn_file_actions_adddup2(&files, in, STDIN_FILENO);
    if (!bad && out >= 0)
        bad = posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO);
    else if (!bad)
        bad = posix_spawn_file_actions_addopen(&files, STDOUT_FILENO,
                                               "/dev/null", O_WRONLY, 0);
    if (!bad)
        bad = posix_spawnp(pid, argv[0], &files, &attributes, argv, environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    return bad;
}

static bool nonblocking(int fd)
{
    return fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_NONBLOCK) == 0;
}

bool child_start(struct child *c, char *const argv[], struct err *err)
{
    char *const keeper[] = { "sh", "-c", (char *)keeper_script, NULL };
    int to[2] = { -1, -1 }, from[2] = { -1, -1 }, line[2] = { -1, -1 };
    *c = (struct child){ .to = -1, .from = -1, .lifeline = -1 };
    int bad = 0;
    if (!pipe_above(to) || !pipe_above(from) || !pipe_above(line) ||
        !nonblocking(to[1]) || !nonblocking(from[0]))
        bad = errno;
    if (!bad)
        bad = spawn(&c->keeper, keeper, 0, line[0], -1);
    if (!bad) {
        bad = spawn(&c->pid, argv, c->keeper, to[0], from[1]);
        if (bad)
            c->pid = 0;
    } else {
        c->keeper = 0;
    }
    shut(&to[0]);
    shut(&from[1]);
    shut(&line[0]);
    c->to = to[1];
    c->from = from[0];
    c->lifeline = line[1];
    if (!bad)
        return true;
    child_stop(c);
    return err_set(err, "%s cannot be started: %s", argv[0], strerror(bad));
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* How a child ended that ends by itself within a moment, which is still to be
 * waited for; false where it did not. */
static bool ended(pid_t pid, double seconds, siginfo_t *info)
{
    const double end = now() + seconds;
    for (;;) {
        info->si_pid = 0;
        if (waitid(P_PID, (id_t)pid, info, WEXITED | WNOHANG | WNOWAIT) != 0)
            return false;
        if (info->si_pid != 0)
            return true;
        if (!(now() < end))
            return false;
        poll(NULL, 0, 1);
    }
}

/* As the keeper is not waited for yet, the number of its group is not another
 * one's. */
void child_stop(struct child *c)
{
    shut(&c->to);
    shut(&c->from);
    if (c->keeper > 0)
        kill(-c->keeper, SIGKILL);
    const pid_t both[] = { c->pid, c->keeper };
    for (int i = 0; i < 2; i++)
        while (both[i] > 0 && waitpid(both[i], NULL, 0) < 0 && errno == EINTR)
            ;
    shut(&c->lifeline);
    free(c->reply);
    *c = (struct child){ .to = -1, .from = -1, .lifeline = -1 };
}

void child_bury(struct child *c, struct err *how)
{
    siginfo_t info;
    const bool over = ended(c->pid, 0.5, &info);
    const int status = over ? info.si_status : 0;
    if (!over)
        err_set(how, "closed its output");
    else if (info.si_code != CLD_EXITED)
        err_set(how, "killed by signal %d (%s)", status, strsignal(status));
    else if (status > 128 && status < 128 + 32) /* what a shell makes of it */
        err_set(how, "left with status %d (128 + signal %d, %s)", status,
                status - 128, strsignal(status - 128));
    else
        err_set(how, "left with status %d", status);
    child_stop(c);
}

void child_hush(struct child *c)
{
    shut(&c->to);
}

void child_dismiss(struct child *c)
{
    siginfo_t info;
    child_hush(c);
    (void)ended(c->pid, 1, &info);
    child_stop(c);
}

/* write without SIGPIPE, whatever the program does about it. */
static ssize_t write_quietly(int fd, const void *data, size_t n)
{
    sigset_t pipe, before, pending;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    sigemptyset(&pending);
    pthread_sigmask(SIG_BLOCK, &pipe, &before);
    if (sigismember(&before, SIGPIPE)) /* only then can one be waiting */
        sigpending(&pending);
    const ssize_t written = write(fd, data, n);
    const int bad = errno;
    if (written < 0 && bad == EPIPE && !sigismember(&pending, SIGPIPE))
        while (sigtimedwait(&pipe, NULL, &(struct timespec){ 0 }) < 0 &&
               errno == EINTR)
            ;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = bad;
    return written;
}

static bool would_block(void)
{
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

/* Room for n bytes and a NUL behind them. */
static bool room_for(struct child *c, size_t n)
{
    if (n + 1 <= c->room)
        return true;
    const size_t room = n + n / 2 + 4096;
    char *more = realloc(c->reply, room);
    if (!more)
        return false;
    c->reply = more;
    c->room = room;
    return true;
}

/* What has come, up to one byte more than most: a reply that is whole may have
 * bytes behind it. */
static enum child_said hear(struct child *c, size_t most, child_whole *whole,
                            void *context, bool *done)
{
    enum { CHUNK = 65536 };
    const size_t left = most + 1 - c->replied;
    const size_t n = left < CHUNK ? left : CHUNK;
    if (!room_for(c, c->replied + n))
        return CHILD_MEMORY;
    const ssize_t got = read(c->from, c->reply + c->replied, n);
    if (got < 0)
        return would_block() ? CHILD_WHOLE : CHILD_GONE;
    if (got == 0)
        return CHILD_GONE;
    c->replied += (size_t)got;
    c->reply[c->replied] = '\0';
    *done = whole(context, c->reply, c->replied);
    return c->replied > most && !*done ? CHILD_MUCH : CHILD_WHOLE;
}

enum child_said child_ask(struct child *c, const void *said, size_t n,
                          size_t most, double seconds, child_whole *whole,
                          void *context)
{
    struct pollfd fds[2] = { { c->from, POLLIN, 0 }, { c->to, POLLOUT, 0 } };
    const double end = now() + seconds;
    const char *at = said;
    c->replied = 0;
    if (!room_for(c, 1))
        return CHILD_MEMORY;
    c->reply[0] = '\0';
    if (c->asked && poll(fds, 1, 0) > 0)
        return fds[0].revents & POLLIN ? CHILD_SPOKE : CHILD_GONE;
    c->asked = true;
    for (bool done = false; !done || n > 0;) {
        if (n > 0) {
            const ssize_t wrote = write_quietly(c->to, at, n);
            if (wrote > 0) {
                at += wrote;
                n -= (size_t)wrote;
            } else if (wrote < 0 && !would_block()) {
                n = 0; /* gone; its last words may still be there */
            }
        }
        if (done && n == 0)
            break;
        /* Asked even when the time is up: after a pause of this program the
         * answer may lie there. */
        const double left = fmax(0, end - now());
        const int ready =
            poll(fds, n > 0 ? 2 : 1, (int)ceil(fmin(left, 1e6) * 1e3));
        if (ready == 0 && !(left > 0))
            return done ? CHILD_WHOLE : CHILD_LATE;
        if (ready > 0 && fds[0].revents) {
            const enum child_said heard = hear(c, most, whole, context, &done);
            if (heard != CHILD_WHOLE)
                return heard;
        }
    }
    return CHILD_WHOLE;
}
