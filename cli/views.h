// Lists of cameras such as "iso,front", and the file names of their pictures, by a pattern such as
// "vase.%s.png".

#ifndef CAG_CLI_VIEWS_H
#define CAG_CLI_VIEWS_H

#include <stdbool.h>
#include <stddef.h>

// The longest name of a camera in a list, with its zero byte.
#define CAG_VIEW_NAME_MAX 128

// Copies the next name of the list at *at to `name`, and moves *at behind it. Returns false at the
// end. A name that is empty or too long is returned as an empty one.
bool cag_views_next(const char **at, char name[CAG_VIEW_NAME_MAX]);

// Returns the number of %s in a pattern, in which %% is a percent sign, or -1 if it contains another
// %.
int cag_views_places(const char *pattern);

// Writes the file name of a camera's picture. Returns false if it does not fit.
bool cag_views_name(const char *pattern, const char *view, char *out, size_t size);

#endif
