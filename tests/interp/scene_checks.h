// Helpers for the tests of scenes: the scene of a script, comparisons, and random vectors.

#ifndef CAG_TESTS_INTERP_SCENE_CHECKS_H
#define CAG_TESTS_INTERP_SCENE_CHECKS_H

#include "interp/session/session.h"
#include "scene_fixture.h"
#include "session_support.h"
#include "tests/geom/random.h"

static inline CagSession *shown(const char *text) {
  CagSession *s = new_session();
  CagShownCounts counts;
  if (cag_session_run_text(s, "script", text, strlen(text)) != CAG_STATUS_OK ||
      cag_session_scene(s, &counts) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("there is no scene of: %s", text);
  }
  return s;
}

static inline void is_near(double x, double expected, double within, const char *what) {
  if (!(fabs(x - expected) <= within)) fail_msg("%s: %.12g, not %.12g", what, x, expected);
}

static inline void is_point(CagVec3 p, CagVec3 q, const char *what) {
  if (!(cag_norm(cag_sub(p, q)) < 1e-9))
    fail_msg("%s: [%g, %g, %g], not [%g, %g, %g]", what, p.x, p.y, p.z, q.x, q.y, q.z);
}

static inline CagVec3 random_vec(double size) {
  CagVec3 v;
  v.x = uniform(-size, size);
  v.y = uniform(-size, size);
  v.z = uniform(-size, size);
  return v;
}

#endif
