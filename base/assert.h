// Invariants as code. CAG_ASSERT checks in builds with CAG_CHECKED, which the sanitized ones are;
// in others, the condition is compiled but not evaluated, so that the library never ends its host.

#ifndef CAG_BASE_ASSERT_H
#define CAG_BASE_ASSERT_H

#ifdef CAG_CHECKED
// Writes the condition and its location to standard error and aborts.
_Noreturn void cag_assert_failed(const char *condition, const char *file, int line);
#define CAG_ASSERT(condition)                                                                      \
  ((condition) ? (void)0 : cag_assert_failed(#condition, __FILE__, __LINE__))
#else
#define CAG_ASSERT(condition) ((void)sizeof(condition))
#endif

#endif
