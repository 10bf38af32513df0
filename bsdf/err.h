/* err.h - why something could not be done
 *
 * A function that can fail takes a struct err last, owned by the caller, and
 * returns false or NULL after filling it with one sentence that names the
 * thing, the value and what was expected.  NULL is allowed: nobody asks.
 */
#ifndef BSDF_ERR_H
#define BSDF_ERR_H

#include <stdbool.h>

struct err {
    char text[1024]; /* no newline at the end; cut off where it is too long */
};

/** Always false, so that a caller can return it. */
__attribute__((format(printf, 2, 3))) bool err_set(struct err *err,
                                                   const char *format, ...);

/** The nearest of the words (the last is NULL) to what was meant, within a
 * third of its letters and at least one; NULL if none is. */
const char *err_nearest(const char *meant, const char *const words[]);

/** Always false: what was meant is none of the words, which one is near, and
 * what there is. */
bool err_unknown(struct err *err, const char *what, const char *meant,
                 const char *const words[]);

#endif
