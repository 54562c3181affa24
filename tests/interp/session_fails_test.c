// The status and reason of rejected requests: pictures, formats, cameras, and limits.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "session_support.h"

static volatile int interrupt;

static CagSession *run(const char *pov_csg, const char *text, int expected) {
  CagSessionOptions options = session_options();
  options.pov_csg = pov_csg;
  options.interrupt = &interrupt;
  CagSession *s = cag_session_new(&options);
  assert_non_null(s);
  assert_int_equal(cag_session_run_text(s, "script.cag", text, strlen(text)), expected);
  return s;
}

static void is_refused(CagSession *s, int status, int expected, const char *reason) {
  CagErrorView e;
  cag_session_error(s, 0, &e);
  assert_non_null(e.reason);
  assert_string_equal(e.reason, reason);
  assert_int_equal(status, expected);
  cag_session_free(s);
}

static void options_that_a_picture_cannot_have(void **state) {
  (void)state;
  CagRenderOptions usual;
  cag_render_options_init(&usual);
  static const struct {
    const char *path, *quality, *camera, *pov_csg, *reason;
    int width;
    CagRenderRegion region;
  } cases[] = {
      {.path = "/dev/null/a", .reason = "format-unknown"},
      {.path = "/dev/null/a.jpg", .reason = "format-unknown"},
      {.path = "/dev/null/a.exr", .quality = "best", .reason = "format-unknown"},
      {.path = "/dev/null/a.PNG", .pov_csg = "always", .reason = "format-unknown"},
      {.path = "/dev/null/a.png", .camera = "none", .reason = "camera-unknown"},
      {.path = "/dev/null/a.png", .width = 1 << 30, .reason = "picture-size"},
      {.path = "/dev/null/a.png", .region = {-1, 0, 5, 5}, .reason = "region-outside"},
      {.path = "/dev/null/a.png", .region = {0, -1, 5, 5}, .reason = "region-outside"},
      {.path = "/dev/null/a.png", .region = {0, 0, -5, 5}, .reason = "region-outside"},
      {.path = "/dev/null/a.png", .region = {0, 0, 5, 0}, .reason = "region-outside"},
      {.path = "/dev/null/a.png", .region = {60, 0, 5, 5}, .reason = "region-outside"},
      {.path = "/dev/null/a.png", .region = {0, 44, 5, 5}, .reason = "region-outside"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagSession *s =
        run(cases[i].pov_csg, "show sphere(1), camera([9, 9, 9], size: [64, 48])\n", CAG_STATUS_OK);
    CagRenderOptions o = usual;
    if (cases[i].quality) o.quality = cases[i].quality;
    o.camera = cases[i].camera;
    if (cases[i].width) o.width = o.height = cases[i].width;
    o.region = cases[i].region;
    is_refused(s, cag_session_render(s, &o, cases[i].path), CAG_STATUS_USAGE, cases[i].reason);
  }
}

// Regions that touch the edges of the picture are valid; the failure is due to the missing
// renderer.
static void regions_up_to_the_edges_are_good(void **state) {
  (void)state;
  static const CagRenderRegion regions[] = {
      {0, 0, 64, 48}, {63, 47, 1, 1}, {0, 47, 64, 1}, {1, 0, 63, 48}, {0, 0, 0, 9}};
  static const char *const paths[] = {"/dev/null/a.png", "/dev/null/a.PNG", "/dev/null/a.exr",
                                      "/dev/null/a.b.EXR", NULL};
  static const char *const qualities[] = {"draft", "normal", "final", NULL};
  static const char *const csg[] = {"auto", "native", "mesh", NULL};
  char *path = strdup(getenv("PATH"));
  setenv("PATH", "/nowhere", 1);
  for (size_t i = 0; i < sizeof regions / sizeof *regions; i++) {
    CagSession *s =
        run(csg[i % 4], "show sphere(1), camera([9, 9, 9], size: [64, 48])\n", CAG_STATUS_OK);
    CagRenderOptions o;
    cag_render_options_init(&o);
    o.quality = qualities[i % 4];
    o.engine = "povray";
    o.region = regions[i];
    const char *to = paths[i % 4];
    is_refused(s, cag_session_render(s, &o, to), CAG_STATUS_RENDERER, "renderer");
  }
  setenv("PATH", path, 1);
  free(path);
}

// For an unknown camera, the message suggests the closest name, or lists the cameras.
static void cameras_are_suggested(void **state) {
  (void)state;
  for (int n = 1; n < 150; n = 2 * n + 5) {
    char text[200];
    snprintf(text, sizeof text,
             "show sphere(1), [for i in 0..<%d: named(camera([9, 9, 9]), \"place{i}\")]\n", n);
    static const struct {
      const char *name, *help;
    } cases[] = {
        {"plac0", "did you mean `place0`?"},
        {"fron", "did you mean `front`?"},
        {"tpo", "did you mean `top`?"},
        {"zzzzzz",
         "the scene has `place0`; top, bottom, front, back, left, right, and iso always work"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
      // If there are too many cameras to compare, the standard views are not considered.
      if (n > 57 && (i == 1 || i == 2)) continue;
      CagSession *s = run(NULL, text, CAG_STATUS_OK);
      CagRenderOptions o;
      CagErrorView e = {0};
      cag_render_options_init(&o);
      o.camera = cases[i].name;
      assert_int_equal(cag_session_render(s, &o, "/dev/null/a.png"), CAG_STATUS_USAGE);
      cag_session_error(s, 0, &e);
      if (!e.help || strcmp(e.help, cases[i].help) != 0)
        fail_msg("%s of %d: %s", cases[i].name, n, e.help ? e.help : "no help");
      cag_session_free(s);
    }
  }
}

static void formats_that_a_session_cannot_write(void **state) {
  (void)state;
  static const struct {
    const char *path, *format, *pov_csg;
  } cases[] = {{"/dev/null/a", NULL, NULL},
               {"/dev/null/a.doc", NULL, NULL},
               {"/dev/null/a.stl", "doc", NULL},
               {"/dev/null/a.pov", NULL, "always"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagSession *s = run(cases[i].pov_csg, "show sphere(1)\n", CAG_STATUS_OK);
    is_refused(s, cag_session_export(s, cases[i].path, cases[i].format), CAG_STATUS_USAGE,
               "format-unknown");
  }
  // Images have formats of their own, but a sphere is not an image.
  CagSession *s = run(NULL, "show sphere(1)\n", CAG_STATUS_OK);
  is_refused(s, cag_session_export(s, "/dev/null/a.png", NULL), CAG_STATUS_SCRIPT,
             "no-image-shown");
}

static void statuses_tell_what_kind_of_failure_it_was(void **state) {
  (void)state;
  static const struct {
    const char *text, *reason;
    int status;
  } cases[] = {{"x = ", "expected-expression", CAG_STATUS_SCRIPT},
               {"f(n) = 1 + f(n + 1)\nprint f(0)", "depth-limit", CAG_STATUS_LIMIT},
               {"import none_such", "module-not-found", CAG_STATUS_SCRIPT}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagSession *s = run(NULL, cases[i].text, cases[i].status);
    is_refused(s, cases[i].status, cases[i].status, cases[i].reason);
  }
  CagSession *s = run(NULL, "show box(1)\n", CAG_STATUS_OK);
  is_refused(s, cag_session_export(s, "/dev/null/a.stl", NULL), CAG_STATUS_FILE, "output");
  s = run(NULL, "x = 1\n", CAG_STATUS_OK);
  is_refused(s, cag_session_export(s, "/dev/null/a.stl", NULL), CAG_STATUS_SCRIPT,
             "nothing-to-show");
  interrupt = 1;
  s = run(NULL, "print sum([for i in 0..100000: i])\n", CAG_STATUS_INTERRUPTED);
  interrupt = 0;
  is_refused(s, CAG_STATUS_INTERRUPTED, CAG_STATUS_INTERRUPTED, "interrupted");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(options_that_a_picture_cannot_have),
      cmocka_unit_test(regions_up_to_the_edges_are_good),
      cmocka_unit_test(cameras_are_suggested),
      cmocka_unit_test(formats_that_a_session_cannot_write),
      cmocka_unit_test(statuses_tell_what_kind_of_failure_it_was),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
