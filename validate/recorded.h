/* recorded.h - a JSON report read back
 *
 * Nothing in the file is taken on trust: every field is there, is of its type
 * and in its range, or the error names the file, the field, what it is and what
 * was expected.
 */
#ifndef VALIDATE_RECORDED_H
#define VALIDATE_RECORDED_H

#include <jansson.h>

#include "validate/run.h"

struct recorded_result {
    const char *spec;
    size_t model;  /* how many other specs come before it */
    bool repaired; /* the spec is not the one that ran: it had odd bytes */
    struct vec3 wo;
    size_t verdicts;
    struct verdict *verdict; /* without what parts say */
    const json_t *json;      /* the verdicts, as in the file */
};

/** A run of one model from several directions is that of consecutive results
 * with the same spec. */
struct recorded {
    const char *version; /* of the program that wrote it */
    struct plan plan;
    struct bands bands;
    const char *ior_path; /* or NULL */
    size_t words, skips;
    const char **word; /* of the command line */
    const char **skip; /* names of checks */
    size_t passed, failed, statistical;
    size_t models, results;
    struct recorded_result *result;
    json_t *root; /* owns every text */
};

/** Reads a report of at most RECORDED_MAX bytes. */
enum { RECORDED_MAX = 64 << 20 };
bool recorded_read(struct recorded *r, const char *path, struct err *err);
void recorded_clear(struct recorded *r);

#endif
