// Line-based comparison of two texts.

#ifndef CAG_CLI_DIFF_H
#define CAG_CLI_DIFF_H

#include <stddef.h>
#include <stdio.h>

// Writes the difference from `a` to `b` as a unified diff with three lines of context, as accepted
// by `patch`, or nothing if they are equal.
void cag_tool_diff(const char *name, const char *a, size_t a_length, const char *b, size_t b_length,
                   FILE *out);

#endif
