/* gnuplot.c - a child process whose words are kept */
#include "plots/gnuplot.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const long patience_ms = 60000;

/* Quotes, backslashes, backquotes (commands), @ (macros) and $ among others.
 * gnuplot takes every digit that follows for a part of the escape. */
void gnuplot_string(FILE *script, const char *text)
{
    bool escaped = false;
    fputc('"', script);
    for (const unsigned char *p = (const unsigned char *)text; *p; p++) {
        const bool plain =
            *p >= 0x80 || isalpha(*p) || strchr(" ./_-,:;=+()[]|<>&%#", *p);
        escaped = !plain && (escaped || !isdigit(*p));
        fprintf(script, escaped ? "\\%03o" : "%c", *p);
    }
    fputc('"', script);
}

static long now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec * 1000 + t.tv_nsec / 1000000;
}

/* Reads until the other end is closed; false after a minute.  What does not
 * fit is read and dropped. */
static bool listen_to(int fd, char said[GNUPLOT_SAID_MAX])
{
    const long end = now_ms() + patience_ms;
    size_t n = 0;
    for (long left; (left = end - now_ms()) > 0;) {
        char part[512];
        if (poll(&(struct pollfd){ fd, POLLIN, 0 }, 1, (int)left) <= 0)
            continue;
        const ssize_t got = read(fd, part, sizeof part);
        if (got == 0)
            return true;
        if (got < 0)
            continue;
        const size_t room = GNUPLOT_SAID_MAX - 1 - n;
        const size_t keep = (size_t)got < room ? (size_t)got : room;
        memcpy(said + n, part, keep);
        n += keep;
        said[n] = '\0';
    }
    return false;
}

/* A PDF carries the time zone of its date.  Shares the strings of environ. */
static char **environment(void)
{
    static char utc[] = "TZ=UTC0";
    size_t n = 0, to = 0;
    while (environ[n])
        n++;
    char **copy = malloc((n + 2) * sizeof *copy);
    if (!copy)
        return NULL;
    for (size_t i = 0; i < n; i++)
        if (strncmp(environ[i], "TZ=", 3) != 0)
            copy[to++] = environ[i];
    copy[to++] = utc;
    copy[to] = NULL;
    return copy;
}

/* 0 or an error number. */
static int start(pid_t *child, const char *folder, char *const argv[],
                 int words)
{
    posix_spawn_file_actions_t act;
    char **env = environment();
    int failed = env ? posix_spawn_file_actions_init(&act) : ENOMEM;
    if (failed == 0) {
        failed =
            posix_spawn_file_actions_addopen(&act, 0, "/dev/null", O_RDONLY, 0);
        if (failed == 0)
            failed = posix_spawn_file_actions_addopen(&act, 1, "/dev/null",
                                                      O_WRONLY, 0);
        if (failed == 0)
            failed = posix_spawn_file_actions_adddup2(&act, words, 2);
        if (failed == 0)
            failed = posix_spawn_file_actions_addchdir_np(&act, folder);
        if (failed == 0)
            failed = posix_spawnp(child, argv[0], &act, NULL, argv, env);
        posix_spawn_file_actions_destroy(&act);
    }
    free(env);
    return failed;
}

/* Of `picture = "..."`; owned by the caller. */
static char *assignment(const char *picture)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    fputs("picture = ", out);
    gnuplot_string(out, picture);
    if (fclose(out) == 0)
        return text;
    free(text);
    return NULL;
}

/* Runs gnuplot to its end; said takes what it had to say. */
static bool run(const char *folder, char *const argv[],
                char said[GNUPLOT_SAID_MAX], struct err *err)
{
    int words[2] = { -1, -1 }, status = 0;
    pid_t child = -1;
    said[0] = '\0';
    if (pipe2(words, O_CLOEXEC) != 0)
        return err_set(err, "gnuplot cannot be run: %s", strerror(errno));
    const int failed = start(&child, folder, argv, words[1]);
    close(words[1]);
    if (failed != 0) {
        close(words[0]);
        return err_set(err, "gnuplot cannot be run: %s%s", strerror(failed),
                       failed == ENOENT ? "; is it installed, and on the PATH?"
                                        : "");
    }
    const bool in_time = listen_to(words[0], said);
    close(words[0]);
    if (!in_time)
        kill(child, SIGKILL);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    if (!in_time)
        return err_set(err, "gnuplot was stopped after %ld seconds",
                       patience_ms / 1000);
    if (WIFSIGNALED(status))
        return err_set(err, "gnuplot was ended by signal %d", WTERMSIG(status));
    return (WIFEXITED(status) && WEXITSTATUS(status) == 0) ||
           err_set(err, "gnuplot failed with exit status %d",
                   WEXITSTATUS(status));
}

bool gnuplot_run(const char *folder, const char *script, const char *picture,
                 char said[GNUPLOT_SAID_MAX], struct err *err)
{
    static char program[] = "gnuplot", plain[] = "-d", command[] = "-e";
    char *file = strdup(script), *set = assignment(picture);
    char *const argv[] = { program, plain, command, set, file, NULL };
    said[0] = '\0';
    const bool ok = file && set ? run(folder, argv, said, err)
                                : err_set(err, "out of memory");
    free(file);
    free(set);
    return ok;
}

/* -- windows --------------------------------------------------------------- */

/* The first of gnuplot's terminals that opens a window; NULL and what it has
 * not, or why none can be opened here. */
static const char *window_terminal(struct err *err)
{
    static const char *const windows[] = { "qt", "wxt", "x11", "aqua" };
    static char program[] = "gnuplot", plain[] = "-d", command[] = "-e";
    static char ask[] = "print GPVAL_TERMINALS";
    char *const argv[] = { program, plain, command, ask, NULL };
    char said[GNUPLOT_SAID_MAX];
    if (!run(".", argv, said, err))
        return NULL;
    for (char *rest = said, *name; (name = strsep(&rest, " \n"));)
        for (size_t i = 0; i < sizeof windows / sizeof *windows; i++)
            if (strcmp(name, windows[i]) == 0) {
                if (getenv("DISPLAY") || getenv("WAYLAND_DISPLAY"))
                    return windows[i];
                err_set(err, "--interactive: there is no display to open a "
                             "window on (neither DISPLAY nor WAYLAND_DISPLAY "
                             "is set)");
                return NULL;
            }
    err_set(err, "--interactive: the gnuplot that is there opens no windows; "
                 "expected one with qt, wxt or x11, as Debian's gnuplot-qt");
    return NULL;
}

bool gnuplot_window(const char *folder, const char *script, double width,
                    double height, struct err *err)
{
    static char program[] = "gnuplot", plain[] = "-d", stay[] = "-p";
    static char command[] = "-e";
    const char *terminal = window_terminal(err);
    char set[128], *file = terminal ? strdup(script) : NULL;
    pid_t child = -1;
    int status = 0;
    if (!terminal)
        return false;
    if (!file)
        return err_set(err, "out of memory");
    snprintf(set, sizeof set,
             "window = '%s size %.0f,%.0f noenhanced font \"sans-serif,9\"'",
             terminal, width, height);
    char *const argv[] = { program, plain, stay, command, set, file, NULL };
    const int failed = start(&child, folder, argv, 2);
    while (failed == 0 && waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    free(file);
    if (failed != 0)
        return err_set(err, "gnuplot cannot be run: %s", strerror(failed));
    return (WIFEXITED(status) && WEXITSTATUS(status) == 0) ||
           err_set(err, "--interactive: gnuplot's terminal %s failed",
                   terminal);
}
