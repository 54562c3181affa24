// Assertions. CAG_ASSERT checks its condition in builds with CAG_CHECKED, such as the sanitizer
// builds. In other builds, the condition is compiled but not evaluated, so that the library never
// aborts its host.

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
