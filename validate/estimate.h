/* estimate.h - a computed number travels with how far off it may be */
#ifndef VALIDATE_ESTIMATE_H
#define VALIDATE_ESTIMATE_H

#include <stdint.h>

struct estimate {
    double value, error; /* |value - truth| <= error, as far as is known */
};

/** A mean of n numbers between 0 and most. */
struct mean {
    double value, variance, most;
    uint64_t n;
};

static inline struct estimate estimate_add(struct estimate a, struct estimate b)
{
    return (struct estimate){ a.value + b.value, a.error + b.error };
}

#endif
