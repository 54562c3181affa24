// The difference of two texts, line by line.

#ifndef CAG_CLI_DIFF_H
#define CAG_CLI_DIFF_H

#include <stddef.h>
#include <stdio.h>

// Writes what turns `a` into `b` as a unified diff with three lines of context, in the form that
// `patch` reads; nothing where they are equal.
void cag_tool_diff(const char *name, const char *a, size_t a_length, const char *b, size_t b_length,
                   FILE *out);

#endif
