/* publish.h - results, put into a document by the program that found them, and
 * where and when that was */
#ifndef TESTS_PUBLISH_H
#define TESTS_PUBLISH_H

#include <stdbool.h>

#include "bsdf/err.h"

/** Replaces what is between the lines "<!-- mark -->" and "<!-- /mark -->" of
 * a file by a text; written aside and renamed.  False, the file untouched, if
 * it does not have each of the lines once and in this order. */
bool publish(const char *path, const char *mark, const char *text,
             struct err *err);

/** Today, as in 2026-11-22, and the processor's name. */
struct machine {
    char date[16], processor[200];
};
struct machine machine_now(void);

#endif
