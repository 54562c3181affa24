// Requests to cag-brep: volumes of results are those of formulas, and failures say what the kernel
// said. Without cag-brep, these tests are skipped.

#include <signal.h>

#include "base/memory.h"
#include "geom/solid/csg.h"
#include "geom/solid/exact.h"
#include "interp/kernel/answers.h"
#include "interp/kernel/kernel.h"
#include "interp/kernel/protocol.h"
#include "tests/geom/support.h"
#include "tests/interp/kernel_program.h"

static CagKernel *kernel;

static int open_kernel(void **state) {
  (void)state;
  if (use_kernel_program()) kernel = cag_kernel_new();
  return 0;
}

static int close_kernel(void **state) {
  (void)state;
  cag_kernel_free(kernel);
  return 0;
}

static CagSolid *a_box(double x, double y, double z) {
  CagSolid *s;
  OK(cag_solid_box(cag_vec3(x, y, z), false, &s, &err));
  return s;
}

static CagBoundary boundary_of(const CagSolid *s) {
  CagBoundaries all;
  bool approximate;
  OK(cag_kernel_boundary(kernel, s, 0, 0, &all, &approximate, &err));
  assert_int_equal(all.count, 1);
  const CagBoundary b = all.items[0];
  cag_free(all.items);
  return b;
}

// The edges between corners that differ only in z.
static size_t upright_edges(const CagBoundary *b, size_t *out) {
  size_t n = 0;
  for (size_t i = 0; i < b->edge_count; i++) {
    const CagVec3 d = cag_sub(b->corners[b->edges[i].to], b->corners[b->edges[i].from]);
    if (fabs(d.z) > fabs(d.x) + fabs(d.y)) out[n++] = i;
  }
  return n;
}

// The face whose plane contains the point and is perpendicular to the direction.
static size_t face_at(const CagBoundary *b, CagVec3 p, CagVec3 direction) {
  for (size_t i = 0; i < b->face_count; i++) {
    const CagTransform *t = &b->faces[i].carrier.frame;
    const CagVec3 origin = cag_vec3(t->m[0][3], t->m[1][3], t->m[2][3]);
    const CagVec3 z = cag_vec3(t->m[0][2], t->m[1][2], t->m[2][2]);
    if (fabs(fabs(cag_dot(z, direction)) - 1) < 1e-9 && fabs(cag_dot(z, cag_sub(p, origin))) < 1e-9)
      return i;
  }
  fail_msg("no such face");
  return 0;
}

static double volume_and_free(CagBoundaries *all) {
  double sum = 0;
  for (size_t i = 0; i < all->count; i++) {
    assert_true(all->items[i].body_length > 0);
    sum += all->items[i].volume;
  }
  cag_boundaries_free(all);
  return sum;
}

#define NEEDS_KERNEL                                                                               \
  (void)state;                                                                                     \
  if (!kernel) skip()

// A fillet of an edge takes (1 - pi / 4) r^2 per length. If r changes evenly from 1 to 2, the mean
// of r^2 is 7 / 3, nearly: sections of the fillet are not exactly round.
static void fillets_take_the_corners_of_a_box(void **state) {
  NEEDS_KERNEL;
  CagSolid *s = a_box(10, 20, 30);
  CagBoundary b = boundary_of(s);
  CagBlend blends[4] = {{0}};
  size_t edges[12];
  assert_int_equal(upright_edges(&b, edges), 4);
  for (int i = 0; i < 4; i++) blends[i] = (CagBlend){.edge = edges[i], .first = 2, .last = 2};
  CagBoundaries out;
  CagKernelFailure why;
  OK(cag_kernel_fillet(kernel, &b, blends, 4, &out, &why, &err));
  assert_int_equal(out.count, 1);
  assert_int_equal(out.items[0].face_count, 10);
  NEAR(volume_and_free(&out), 6000 - (4 - M_PI) * 4 * 30, 1e-6);
  blends[0].first = 1;
  OK(cag_kernel_fillet(kernel, &b, blends, 1, &out, &why, &err));
  NEAR(volume_and_free(&out), 6000 - (1 - M_PI / 4) * 7 / 3.0 * 30, 0.2);
  cag_boundary_free(&b);
  cag_solid_release(s);
}

static void a_fillet_that_does_not_fit_says_which_edge_and_the_largest_radius(void **state) {
  NEEDS_KERNEL;
  CagSolid *s = a_box(10, 20, 30);
  CagBoundary b = boundary_of(s);
  size_t edges[12];
  upright_edges(&b, edges);
  const CagBlend blend = {.edge = edges[0], .first = 12, .last = 12};
  CagBoundaries out;
  CagKernelFailure why;
  assert_int_equal(cag_kernel_fillet(kernel, &b, &blend, 1, &out, &why, &err), CAG_E_DEGENERATE);
  assert_int_equal(err.id, CAG_ERR_no_boundary);
  assert_true(why.reason == CAG_BREP_FAIL_METHOD || why.reason == CAG_BREP_FAIL_CHECK);
  assert_int_equal(why.edge, edges[0]);
  // The shorter side is 10 mm.
  assert_true(why.limit > 9.5 && why.limit <= 10.0);
  cag_boundary_free(&b);
  cag_solid_release(s);
}

// A chamfer takes d1 d2 / 2 per length.
// The next request starts the program again.
static void a_fillet_is_given_up_when_patience_ends(void **state) {
  NEEDS_KERNEL;
  CagSolid *s = a_box(10, 20, 30);
  CagBoundary b = boundary_of(s);
  size_t edges[12];
  upright_edges(&b, edges);
  const CagBlend blend = {.edge = edges[0], .first = 3, .last = 3};
  CagBoundaries out;
  CagKernelFailure why;
  cag_kernel_set_patience(kernel, 1e-9);
  assert_int_not_equal(cag_kernel_fillet(kernel, &b, &blend, 1, &out, &why, &err), CAG_OK);
  assert_int_equal(err.id, CAG_ERR_kernel_failed);
  assert_int_equal(why.reason, 0);
  cag_kernel_set_patience(kernel, 0);
  OK(cag_kernel_fillet(kernel, &b, &blend, 1, &out, &why, &err));
  NEAR(volume_and_free(&out), 6000 - (1 - M_PI / 4) * 9 * 30, 1e-6);
  cag_boundary_free(&b);
  cag_solid_release(s);
}

static void a_chamfer_has_its_first_distance_on_the_given_face(void **state) {
  NEEDS_KERNEL;
  CagSolid *s = a_box(10, 20, 30);
  CagBoundary b = boundary_of(s);
  size_t edges[12];
  upright_edges(&b, edges);
  const CagVec3 foot = b.corners[b.edges[edges[0]].from];
  const size_t face = face_at(&b, foot, cag_vec3(1, 0, 0)); // it extends along y
  const CagBlend blend = {.edge = edges[0], .face = face, .first = 3, .last = 1};
  CagBoundaries out;
  CagKernelFailure why;
  OK(cag_kernel_chamfer(kernel, &b, &blend, 1, &out, &why, &err));
  size_t found = 0;
  for (size_t i = 0; i < out.items[0].corner_count; i++) {
    const CagVec3 d = cag_sub(out.items[0].corners[i], foot);
    found += fabs(fabs(d.y) - 3) < 1e-9 && fabs(d.x) < 1e-9;
  }
  assert_int_equal(found, 2);
  NEAR(volume_and_free(&out), 6000 - 3 * 1 / 2.0 * 30, 1e-8);
  cag_boundary_free(&b);
  cag_solid_release(s);
}

static void shells_and_offsets_of_a_box(void **state) {
  NEEDS_KERNEL;
  CagSolid *s = a_box(10, 20, 30);
  CagBoundary b = boundary_of(s);
  const size_t top = face_at(&b, cag_vec3(0, 0, 30), cag_vec3(0, 0, 1));
  CagBoundaries out;
  CagKernelFailure why;
  OK(cag_kernel_shell(kernel, &b, 1, &top, 1, &out, &why, &err));
  NEAR(volume_and_free(&out), 6000 - 8 * 18 * 29, 1e-8);
  OK(cag_kernel_shell(kernel, &b, 1, NULL, 0, &out, &why, &err));
  assert_int_equal(out.items[0].shell_count, 2);
  NEAR(volume_and_free(&out), 6000 - 8 * 18 * 28, 1e-8);
  OK(cag_kernel_offset(kernel, s, -2, 0, &out, &why, &err));
  NEAR(volume_and_free(&out), 6 * 16 * 26, 1e-8);
  // Steiner: V + A d + (lengths / 4) pi d^2 + 4 pi / 3 d^3.
  OK(cag_kernel_offset(kernel, s, 1, 0, &out, &why, &err));
  NEAR(volume_and_free(&out), 6000 + 2200 + 60 * M_PI + 4 * M_PI / 3, 1e-5);
  cag_boundary_free(&b);
  cag_solid_release(s);
}

// A frustum of a pyramid: h / 3 (A + B + sqrt(A B)) for squares.
static void drafts_make_a_frustum(void **state) {
  NEEDS_KERNEL;
  CagSolid *s = a_box(10, 10, 10);
  CagBoundary b = boundary_of(s);
  size_t faces[4];
  for (int i = 0; i < 4; i++)
    faces[i] = face_at(&b, cag_vec3(i == 1 ? 10 : 0, i == 3 ? 10 : 0, 0),
                       i < 2 ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0));
  CagBoundaries out;
  CagKernelFailure why;
  OK(cag_kernel_draft(kernel, &b, atan(0.1), cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), faces, 4, &out,
                      &why, &err));
  NEAR(volume_and_free(&out), 10 / 3.0 * (100 + 64 + 80), 1e-8);
  cag_boundary_free(&b);
  cag_solid_release(s);
}

// The moved copy of an exact solid goes over in the kernel's own form.
static void a_moved_exact_solid_keeps_its_volume(void **state) {
  NEEDS_KERNEL;
  CagSolid *s = a_box(10, 20, 30), *exact, *moved;
  CagBoundary parts[2] = {boundary_of(s), boundary_of(s)};
  const CagTransform t = cag_rpy(0.1, 0.2, 0.3);
  // Two copies of one box are one part.
  OK(cag_solid_exact(parts, 2, &exact, &err));
  OK(cag_solid_transform(exact, &t, &moved, &err));
  CagBoundary b = boundary_of(moved);
  NEAR(b.volume, 6000, 1e-8);
  near_vec(b.centroid, cag_transform_point(&t, cag_vec3(5, 10, 15)), 1e-9);
  assert_int_equal(b.face_count, 6);
  cag_boundary_free(&b);
  cag_solid_release(exact);
  cag_solid_release(moved);
  cag_solid_release(s);
}

static void a_half_space_splits_a_box(void **state) {
  NEEDS_KERNEL;
  CagSolid *s = a_box(10, 20, 30), *tool;
  CagBoundaries out;
  CagKernelFailure why;
  const CagPlane plane = {cag_vec3(4, 0, 0), cag_vec3(1, 0, 0)};
  OK(cag_solid_half_space(&plane, &tool, &err));
  OK(cag_kernel_split(kernel, s, tool, 0, &out, &why, &err));
  assert_int_equal(out.count, 2);
  assert_string_equal(out.items[0].name, "inside");
  assert_string_equal(out.items[1].name, "outside");
  NEAR(fmin(out.items[0].volume, out.items[1].volume), 2400, 1e-8);
  NEAR(volume_and_free(&out), 6000, 1e-8);
  cag_solid_release(tool);
  cag_solid_release(s);
}

static void a_circle_is_drawn_on_a_face(void **state) {
  NEEDS_KERNEL;
  CagSolid *s = a_box(10, 20, 30);
  CagBoundary b = boundary_of(s);
  CagTransform frame = cag_translate(cag_vec3(5, 5, 30));
  CagCurve *circle;
  CagBoundaries out;
  CagKernelFailure why;
  frame.planar = false;
  OK(cag_curve_arc(2, 2, 0, 2 * M_PI, &frame, &circle, &err));
  OK(cag_kernel_imprint(kernel, &b, &circle, 1, 0, &out, &why, &err));
  assert_int_equal(out.items[0].face_count, 7);
  NEAR(volume_and_free(&out), 6000, 1e-8);
  cag_curve_release(circle);
  cag_boundary_free(&b);
  cag_solid_release(s);
}

static void damaged_files_are_named(void **state) {
  NEEDS_KERNEL;
  static const char TEXT[] = "no STEP";
  CagBoundaries out;
  CagKernelFailure why;
  assert_int_equal(cag_kernel_read_step(kernel, "a.step", TEXT, sizeof TEXT - 1, &out, &why, &err),
                   CAG_E_ARGUMENT);
  assert_int_equal(err.id, CAG_ERR_exact_file);
  assert_string_equal(err.message, "`a.step` is not a STEP file");
  assert_int_equal(cag_kernel_read_iges(kernel, "a.igs", "", 0, &out, &why, &err), CAG_E_ARGUMENT);
  assert_non_null(strstr(err.message, "`a.igs`"));
}

// Ends the program that was started last. Returns whether it is known.
static bool end_last_program(void) {
  FILE *list = fopen("/proc/thread-self/children", "r");
  long last = 0;
  for (long pid; list && fscanf(list, "%ld", &pid) == 1;) last = pid;
  if (list) fclose(list);
  return last > 0 && kill((pid_t)last, SIGKILL) == 0;
}

// The second time, the program has ended.
static void the_same_request_is_not_asked_again(void **state) {
  NEEDS_KERNEL;
  CagSolid *s = a_box(1, 2, 3), *other = a_box(1, 2, 4);
  CagKernel *own = cag_kernel_new(), *used = kernel;
  kernel = own;
  CagBoundary first = boundary_of(s);
  const bool ended = end_last_program();
  CagBoundary again = boundary_of(s);
  assert_int_equal(first.body_length, again.body_length);
  assert_memory_equal(first.body, again.body, first.body_length);
  CagBoundaries out;
  bool approximate;
  CagError failure;
  if (ended)
    assert_int_equal(cag_kernel_boundary(own, other, 0, 0, &out, &approximate, &failure),
                     CAG_E_RENDERER);
  cag_boundary_free(&first);
  cag_boundary_free(&again);
  cag_kernel_free(own);
  cag_solid_release(s);
  cag_solid_release(other);
  kernel = used;
}

static void the_oldest_answers_go_first(void **state) {
  (void)state;
  CagAnswers a = {0};
  CagDigest of[4];
  const size_t third = CAG_ANSWERS_MOST / 3;
  char *bytes = calloc(1, CAG_ANSWERS_MOST + 1);
  for (uint64_t i = 0; i < 4; i++) {
    of[i] = cag_digest_start();
    cag_digest_word(&of[i], i);
    if (i == 3) assert_non_null(cag_answers_find(&a, &of[0])); // now used later than of[1]
    cag_answers_keep(&a, &of[i], bytes, third);
  }
  assert_null(cag_answers_find(&a, &of[1]));
  for (int i = 0; i < 4; i += i ? 1 : 2)
    assert_int_equal(cag_answers_find(&a, &of[i])->length, third);
  // One that is too long changes nothing, and neither does one without an identity.
  CagDigest more = cag_digest_start();
  cag_answers_keep(&a, &more, bytes, CAG_ANSWERS_MOST + 1);
  more.unknown = true;
  cag_answers_keep(&a, &more, bytes, 1);
  assert_int_equal(a.count, 3);
  more.unknown = false;
  cag_answers_keep(&a, &more, bytes, CAG_ANSWERS_MOST);
  assert_int_equal(a.count, 1);
  cag_answers_free(&a);
  free(bytes);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fillets_take_the_corners_of_a_box),
      cmocka_unit_test(a_fillet_that_does_not_fit_says_which_edge_and_the_largest_radius),
      cmocka_unit_test(a_fillet_is_given_up_when_patience_ends),
      cmocka_unit_test(a_chamfer_has_its_first_distance_on_the_given_face),
      cmocka_unit_test(shells_and_offsets_of_a_box),
      cmocka_unit_test(drafts_make_a_frustum),
      cmocka_unit_test(a_moved_exact_solid_keeps_its_volume),
      cmocka_unit_test(a_half_space_splits_a_box),
      cmocka_unit_test(a_circle_is_drawn_on_a_face),
      cmocka_unit_test(damaged_files_are_named),
      cmocka_unit_test(the_same_request_is_not_asked_again),
      cmocka_unit_test(the_oldest_answers_go_first),
  };
  return cmocka_run_group_tests(tests, open_kernel, close_kernel);
}
