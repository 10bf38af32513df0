/* report.h - a run as a table for people and as JSON for programs */
#ifndef VALIDATE_REPORT_H
#define VALIDATE_REPORT_H

#include <stdio.h>

#include "validate/run.h"

/** A row a model and check with its worst direction, or every direction where
 * verbose; the last line is "N passed, N failed". */
void report_text(FILE *out, const struct run *run, bool verbose);

/** The whole run, every verdict; numbers that are not finite become null.
 * Written aside and renamed. */
bool report_json(const char *path, const struct run *run, struct err *err);

#endif
