/* gnuplot.h - running gnuplot, and what may safely stand in its scripts */
#ifndef PLOTS_GNUPLOT_H
#define PLOTS_GNUPLOT_H

#include <stdio.h>

#include "bsdf/err.h"

enum { GNUPLOT_SAID_MAX = 2048 };

/** Writes a string of a script, quotes included.  Every byte that could mean
 * something to gnuplot is written as an octal escape, so that any text is just
 * text. */
void gnuplot_string(FILE *script, const char *text);

/** Runs a script in its folder, without a shell, the user's settings or a
 * date, its variable `picture` set to where to draw.  Both are names in that
 * folder.  said is filled with what gnuplot had to say, "" if nothing; false
 * when gnuplot is not there, fails, or takes more than a minute. */
bool gnuplot_run(const char *folder, const char *script, const char *picture,
                 char said[GNUPLOT_SAID_MAX], struct err *err);

/** Runs a script in its folder, with its variable `window` set to a terminal
 * that opens one of so many pixels, which stays until it is closed.  False and
 * one line where gnuplot has no such terminal, or there is no display. */
bool gnuplot_window(const char *folder, const char *script, double width,
                    double height, struct err *err);

#endif
