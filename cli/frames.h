// File names of the pictures of a film: a pattern such as "film.%04d.png" and a frame number.

#ifndef CAG_CLI_FRAMES_H
#define CAG_CLI_FRAMES_H

#include <stdbool.h>
#include <stddef.h>

// Returns the number of placeholders in a pattern: %d, %4d, or %04d, of at most
// CAG_FRAMES_DIGITS_MAX digits. %% is a percent sign. Returns -1 if the pattern contains another %.
#define CAG_FRAMES_DIGITS_MAX 12
int cag_frames_places(const char *pattern);

// Writes the name of a frame. Returns false if it does not fit.
bool cag_frames_name(const char *pattern, long frame, char *out, size_t size);

#endif
