/* lanes.h - loops that the compiler turns into vector instructions
 *
 * A LANES function is compiled for AVX-512, AVX2 and the least that x86-64 has,
 * and the processor's own is taken when the program starts; elsewhere it is an
 * ordinary function.  In front of a loop, LANES_LOOP promises that its turns do
 * not depend on one another.  Its body is written without branches, from
 * functions that are INLINE, so that one call of those and a lane of the loop
 * are the same arithmetic.
 */
#ifndef BSDF_LANES_H
#define BSDF_LANES_H

#include <stddef.h>

#if defined(__x86_64__) && defined(__gnu_linux__)
#define LANES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define LANES
#endif

#define LANES_LOOP _Pragma("omp simd")
#define INLINE static inline __attribute__((always_inline, unused))

/** As many at a time as fit the first cache, some dozens of numbers each. */
enum { LANES_MAX = 128 };

#endif
