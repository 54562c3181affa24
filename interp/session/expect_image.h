// Expected images of tests.

#ifndef CAG_INTERP_SESSION_EXPECT_IMAGE_H
#define CAG_INTERP_SESSION_EXPECT_IMAGE_H

#include <stdbool.h>

#include "cag.h"

// Largest difference of a number from that of an .exr file, as a fraction of the largest one: 32-bit
// floats, and the rounding of processors.
#define CAG_TEST_IMAGE_EXR 1e-6
// The same for a .png file, after clipping to 0..1: one of its codes.
#define CAG_TEST_IMAGE_PNG (1.0 / 255)

// Compares an image that the session shows (name NULL: the only one) with a file. Returns an empty
// text if they are the same, or else why not; free it with cag_free. NULL if memory ran out.
char *cag_test_image(CagSession *s, const char *name, const char *path);

#endif
