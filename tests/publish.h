/* publish.h - results, put into a document by the program that found them */
#ifndef TESTS_PUBLISH_H
#define TESTS_PUBLISH_H

#include <stdbool.h>

#include "bsdf/err.h"

/** Replaces what is between the lines "<!-- mark -->" and "<!-- /mark -->" of
 * a file by a text; written aside and renamed.  False, the file untouched, if
 * it does not have each of the lines once and in this order. */
bool publish(const char *path, const char *mark, const char *text,
             struct err *err);

#endif
