// How code for wide registers is compiled: inlined into each of its callers, and once for each
// vector unit.
//
// CAG_ONE_COPY, which `make coverage` sets, compiles every function once. Otherwise branches would
// be counted in each inlined copy, including the copies for other processors, which cannot run.

#ifndef CAG_GEOM_WIDE_H
#define CAG_GEOM_WIDE_H

#if defined(CAG_ONE_COPY) || !defined(__GNUC__)
#define INLINE static inline
#else
#define INLINE static inline __attribute__((always_inline))
#endif

// The widest vector unit of the machine is chosen when the program starts. The arithmetic is the
// same in each version (no contraction), so the results are, too.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__) && !defined(CAG_ONE_COPY)
#define WIDEST __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define WIDEST
#endif

#endif
