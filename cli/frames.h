// Names of the pictures of a film: a pattern such as "film.%04d.png", and the frame in its place.

#ifndef CAG_CLI_FRAMES_H
#define CAG_CLI_FRAMES_H

#include <stdbool.h>
#include <stddef.h>

// Places for the number in a pattern: %d, %4d or %04d, of at most CAG_FRAMES_DIGITS_MAX digits. %%
// is a percent sign. -1 when another % stands in it.
#define CAG_FRAMES_DIGITS_MAX 12
int cag_frames_places(const char *pattern);

// Writes the name of a frame; false when it does not fit.
bool cag_frames_name(const char *pattern, long frame, char *out, size_t size);

#endif
