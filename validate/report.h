/* report.h - a run as a table for people, and as JSON or JUnit for programs
 *
 * Files are written aside and renamed, and hold neither a date nor a duration:
 * the same run gives the same bytes.  Text that is no UTF-8 (a spec may hold
 * any bytes) is shown with each bad byte as \xHH.
 */
#ifndef VALIDATE_REPORT_H
#define VALIDATE_REPORT_H

#include <jansson.h>
#include <stdio.h>

#include "validate/run.h"

/** What the layout of a JSON report is called; see report.schema.json. */
enum { REPORT_SCHEMA = 1 };

/** The words of a verdict. */
extern const char report_pass[], report_fail[], report_none[];

/** Whether a comes before b in a list of the worst: failures before passes,
 * then the least room below the limit; a check without a word on one direction
 * may have one on another. */
bool report_worse(const struct verdict *a, const struct verdict *b);

/** A row a model and check with its worst direction, or every direction where
 * verbose; the last line is "N passed, N failed". */
void report_text(FILE *out, const struct run *run, bool verbose);

/** The whole run, every verdict, and what it takes to run it again; words are
 * the command line.  Numbers that are not finite become null, and every field
 * is there, null where it does not apply.  NULL when out of memory; owned by
 * the caller. */
json_t *report_json_of(const struct run *run, int words, char *const *word);

/** Writes that. */
bool report_json(const char *path, const struct run *run, int words,
                 char *const *word, struct err *err);

/** JUnit's XML, as continuous integration reads it: a suite a spec, a case a
 * check and direction, skipped where the check does not apply. */
bool report_junit(const char *path, const struct run *run, struct err *err);

#endif
