// If the function of a face fails during an export, the error names the shape, and no file is
// written.

#include "tests/interp/scene_fixture.h"

#include "geom/surface/function.h"
#include "interp/formats/brep.h"

typedef struct Failing {
  size_t calls, fails_at; // the number of the call at which it returns NaN
} Failing;

// A wave over the unit square: (u, v, v sin u).
static CagStatus wave_eval(void *context, double u, double v, int n, CagVec3 *out, CagError *err) {
  (void)err;
  Failing *f = context;
  bool fails = f->calls++ == f->fails_at;
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      double x = i + j == 0 ? u : i == 1 && j == 0, y = i + j == 0 ? v : i == 0 && j == 1;
      double z = (j == 0 ? v : j == 1) * sin(u + i * M_PI / 2);
      out[cag_partial(n, i, j)] = cag_vec3(x, y, fails ? (double)NAN : z);
    }
  return CAG_OK;
}

static CagStatus wave_row(void *context, double u, const double *vs, size_t nv, int n, CagVec3 *out,
                          CagError *err) {
  for (size_t k = 0; k < nv; k++) {
    CagVec3 d[3];
    CagStatus status = wave_eval(context, u, vs[k], n, d, err);
    if (status) return status;
    CagVec3 *to = out + k * (n ? 3 : 1);
    to[0] = d[0];
    if (n) to[1] = d[cag_partial(1, 1, 0)];
    if (n) to[2] = d[cag_partial(1, 0, 1)];
  }
  return CAG_OK;
}

static void a_formula_that_fails_at_any_call_is_an_error_with_the_name(void **state) {
  (void)state;
  Failing f = {0, SIZE_MAX};
  const CagSurfaceFunction wave = {
      .eval = wave_eval, .eval_row = wave_row, .release = NULL, .context = &f};
  Fixture scene;
  fixture_begin(&scene);
  scene.scene.tolerance = 0.01;
  CagSurface *s;
  OK(cag_surface_function(&wave, 0, 1, false, 0, 1, false, &s, &(CagError){0}));
  scene.items[0] = (CagItem){.kind = CAG_ITEM_SURFACE, .name = "wave", .as.surface = s};
  scene.scene.item_count = 1;
  size_t failed = 0;
  for (size_t at = 0;; at++) {
    CagBrep b;
    CagError err = {0};
    f = (Failing){0, at};
    CagStatus status = cag_brep_of_scene(&scene.scene, NULL, CAG_BREP_STEP, &b, &err);
    cag_brep_free(&b);
    if (f.calls <= at) {
      assert_int_equal(status, CAG_OK);
      break;
    }
    if (!status) fail_msg("call %zu failed and the export went on", at);
    assert_string_equal(cag_error_info(err.id)->reason, "not-finite");
    assert_non_null(strstr(err.message, "wave"));
    failed++;
  }
  assert_true(failed > 100);
  cag_surface_release(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_formula_that_fails_at_any_call_is_an_error_with_the_name),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
