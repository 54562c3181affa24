// Gaps between boxes with integer corners, of any size, compared with those of their sides.

#include "geom/curve/hulls.h"
#include "random.h"
#include "support.h"

static int whole(int low, int high) { return low + (int)floor(uniform(0, high - low + 1)); }

// The corners of a box in any order, some of them repeated.
static size_t corners(const int low[3], const int high[3], double scale, CagVec3 *out) {
  const size_t n = 8 + (size_t)whole(0, 2);
  for (size_t i = 0; i < n; i++) {
    const unsigned k = i < 8 ? (unsigned)i : (unsigned)whole(0, 7);
    const CagVec3 p =
        cag_vec3(k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]);
    out[i] = cag_scaled(p, scale);
  }
  for (size_t i = n - 1; i > 0; i--) {
    const size_t j = (size_t)whole(0, (int)i);
    const CagVec3 p = out[i];
    out[i] = out[j];
    out[j] = p;
  }
  return n;
}

static void gaps_of_boxes_are_those_of_their_sides(void **state) {
  (void)state;
  seed = 81;
  int meeting = 0;
  for (int round = 0; round < 4000; round++) {
    const double scale = pow(2, whole(-3, 3) * 10);
    int low[2][3], high[2][3];
    double gap[3];
    CagVec3 p[2][10];
    size_t n[2];
    for (int k = 0; k < 3; k++) {
      for (int i = 0; i < 2; i++) {
        low[i][k] = whole(-3, 3);
        high[i][k] = low[i][k] + whole(0, 2);
      }
      gap[k] = low[0][k] > high[1][k]   ? low[0][k] - high[1][k]
               : low[1][k] > high[0][k] ? high[0][k] - low[1][k]
                                        : 0;
    }
    for (int i = 0; i < 2; i++) n[i] = corners(low[i], high[i], scale, p[i]);
    const CagVec3 found = cag_scaled(cag_hulls_gap(p[0], n[0], p[1], n[1]), 1 / scale);
    near_vec(found, cag_vec3(gap[0], gap[1], gap[2]), 1e-12);
    const bool apart = gap[0] != 0 || gap[1] != 0 || gap[2] != 0;
    assert_true(cag_hulls_disjoint(p[0], n[0], p[1], n[1]) == apart);
    meeting += !apart;
  }
  assert_true(meeting > 100);
}

// The tolerance for contact is relative to the size of all points.
static void contact_depends_on_the_size(void **state) {
  (void)state;
  for (int k = 0; k < 3; k++) {
    const CagVec3 near[1] = {{0.25, 0.25, 1e-7}};
    CagVec3 wide[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    assert_true(cag_hulls_disjoint(near, 1, wide, 3));
    assert_true(cag_hulls_disjoint(wide, 3, near, 1));
    wide[k].x += k == 1 ? 1e6 : 0;
    wide[k].y += k == 1 ? 0 : 1e6;
    if (k == 0) wide[2].y = -1;
    assert_false(cag_hulls_disjoint(near, 1, wide, 3));
    assert_false(cag_hulls_disjoint(wide, 3, near, 1));
  }
}

int main(void) {
  (void)err;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(gaps_of_boxes_are_those_of_their_sides),
      cmocka_unit_test(contact_depends_on_the_size),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
