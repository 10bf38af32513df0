/* close.h - comparing numbers, and cmocka with what it needs
 *
 * cmocka compares integers, and floats only after rounding to float, where a
 * NaN equals anything; assert_close is ours.
 */
#ifndef TESTS_CLOSE_H
#define TESTS_CLOSE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

/** |got - expected| <= limit; a NaN on either side fails. */
#define assert_close(got, expected, limit)                                     \
    assert_close_at(got, expected, limit, #got, __FILE__, __LINE__)

static inline void assert_close_at(double got, double expected, double limit,
                                   const char *what, const char *file, int line)
{
    if (fabs(got - expected) <= limit)
        return;
    print_error("%s = %.17g, expected %.17g within %g\n", what, got, expected,
                limit);
    _fail(file, line);
}

/** got <= limit; a NaN fails. */
#define assert_at_most(got, limit)                                             \
    assert_at_most_at(got, limit, #got, __FILE__, __LINE__)

static inline void assert_at_most_at(double got, double limit, const char *what,
                                     const char *file, int line)
{
    if (got <= limit)
        return;
    print_error("%s = %.17g, expected at most %g\n", what, got, limit);
    _fail(file, line);
}

/** The text holds the part; says both if not. */
#define assert_has(text, part) assert_has_at(text, part, __FILE__, __LINE__)

static inline void assert_has_at(const char *text, const char *part,
                                 const char *file, int line)
{
    if (strstr(text, part))
        return;
    print_error("expected \"%s\" in: %s\n", part, text);
    _fail(file, line);
}

#endif
