// Helpers for the tests of the geometry core: calls that must succeed, calls that must fail with a
// reason, and comparisons with a tolerance.

#ifndef CAG_TESTS_GEOM_SUPPORT_H
#define CAG_TESTS_GEOM_SUPPORT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/status.h"
#include "geom/linalg/vec.h"

static CagError err;

#define OK(call)                                                                                   \
  do {                                                                                             \
    if ((call) != CAG_OK) fail_msg("%s: %s", #call, err.message);                                  \
  } while (0)
// Assert that a call fails and names an element from `low` to `high`, the element `at`, or no
// element at all.
#define FAILS_AMONG(call, why, low, high)                                                          \
  do {                                                                                             \
    assert_int_not_equal((call), CAG_OK);                                                          \
    assert_string_equal(cag_error_info(err.id)->reason, why);                                      \
    if (err.index < (low) || err.index > (high))                                                   \
      fail_msg("%s: element %ld, not in %d..%d", #call, err.index, (int)(low), (int)(high));       \
  } while (0)
#define FAILS_AT(call, why, at) FAILS_AMONG(call, why, at, at)
#define FAILS(call, why) FAILS_AT(call, why, -1)
#define NEAR(a, b, tolerance)                                                                      \
  do {                                                                                             \
    double near_a = (a), near_b = (b);                                                             \
    if (!(fabs(near_a - near_b) <= (tolerance)))                                                   \
      fail_msg("%s = %.17g is not %.17g", #a, near_a, near_b);                                     \
  } while (0)

static inline void near_vec(CagVec3 a, CagVec3 b, double tolerance) {
  double d = cag_norm(cag_sub(a, b));
  if (!(d <= tolerance))
    fail_msg("[%.17g %.17g %.17g] is not [%.17g %.17g %.17g]", a.x, a.y, a.z, b.x, b.y, b.z);
}

#endif
