// Misspelled expectations in tests.

#ifndef CAG_INTERP_SESSION_EXPECT_NEAR_H
#define CAG_INTERP_SESSION_EXPECT_NEAR_H

#include <stdbool.h>
#include <stddef.h>

// Returns the start that a comment was probably meant to have, "expect:" or "expect error:", or
// NULL if it has it or is an ordinary comment.
const char *cag_test_meant(const char *text, size_t length);

#endif
