// Comments that look like expectations of a test.

#ifndef CAG_INTERP_SESSION_EXPECT_NEAR_H
#define CAG_INTERP_SESSION_EXPECT_NEAR_H

#include <stdbool.h>
#include <stddef.h>

// What a comment's text was meant to begin with, "expect:" or "expect error:"; NULL: with nothing
// of this kind, or it does.
const char *cag_test_meant(const char *text, size_t length);

#endif
