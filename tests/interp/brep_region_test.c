// Regions as planar faces: their loops have the areas and orientations of the outlines, and the
// surface of each face is a rectangle around its outline.

#include "interp/formats/brep.h"
#include "scene_checks.h"

// Converts a point to the axes of a face.
static CagVec3 in_plane(const CagBrepFace *f, CagVec3 p) {
  double x[3] = {0};
  for (int j = 0; j < 3; j++)
    x[j] = (p.x - f->carrier.frame.m[0][3]) * f->carrier.frame.m[0][j] +
           (p.y - f->carrier.frame.m[1][3]) * f->carrier.frame.m[1][j] +
           (p.z - f->carrier.frame.m[2][3]) * f->carrier.frame.m[2][j];
  return cag_vec3(x[0], x[1], x[2]);
}

// The signed area of a loop from chords, positive about the normal. Adds its points to the box.
static double area_of(const CagBrep *b, const CagBrepFace *f, const CagBrepLoop *l,
                      CagBounds *box) {
  enum { CHORDS = 400 };
  double area = 0;
  for (size_t i = 0; i < l->count; i++) {
    const CagBrepUse *u = &b->uses[l->first + i];
    const CagCurve *c = b->edges[u->edge].curve;
    CagVec3 last = {0, 0, 0};
    for (int k = 0; k <= CHORDS; k++) {
      const double at = (double)(u->reversed ? CHORDS - k : k) / CHORDS;
      CagVec3 p;
      OK(cag_curve_eval(c, c->start + at * (c->end - c->start), 0, CAG_SIDE_LEFT, &p, &err));
      p = in_plane(f, p);
      is_near(p.z, 0, 1e-9, "height over the plane");
      cag_bounds_add(box, p);
      if (k > 0) area += (last.x * p.y - last.y * p.x) / 2;
      last = p;
    }
  }
  return area;
}

static void regions_are_faces_with_their_loops(void **state) {
  (void)state;
  static const double hole = 9 * M_PI;
  static const struct {
    const char *region;
    size_t faces;
    struct {
      double outer, holes;
      size_t count; // loops
    } of[3];
  } cases[] = {
      {"rectangle(30, 20)", 1, {{600, 0, 1}}},
      {"disk(5)", 1, {{25 * M_PI, 0, 1}}},
      {"rectangle(30, 20) - translate(disk(3), [-8, 0, 0])", 1, {{600, hole, 2}}},
      {"rectangle(30, 20) - translate(disk(3), [-8, 0, 0]) - translate(rectangle(4, 2), [8, 0, 0])",
       1,
       {{600, hole + 8, 3}}},
      // An island in a hole, and a separate part with a hole.
      {"rectangle(30, 20) - disk(8) | disk(3) | (translate(rectangle(10, 70), [90, 0, 0]) - "
       "translate(disk(3), [90, 30, 0]))",
       3,
       {{600, 64 * M_PI, 2}, {hole, 0, 1}, {700, hole, 2}}},
  };
  static const char *const places[] = {"R", "translate(R, [5, -6, 7])",
                                       "rotate([1, 2, 3], 40deg) * translate(R, [1, 2, 3])"};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    for (size_t place = 0; place < 3; place++) {
      char script[600];
      snprintf(script, sizeof script, "disk(r) = region(circle(r))\nR = %s\nshow %s\n",
               cases[i].region, places[place]);
      CagSession *s = shown(script);
      CagBrep b;
      OK(cag_brep_of_scene(&s->scene, NULL, CAG_BREP_STEP, &b, &err));
      assert_int_equal(b.face_count, cases[i].faces);
      bool seen[3] = {false};
      for (size_t f = 0; f < b.face_count; f++) {
        const CagBrepFace *face = &b.faces[f];
        CagBounds box = CAG_BOUNDS_EMPTY, holes = CAG_BOUNDS_EMPTY, corners = CAG_BOUNDS_EMPTY;
        assert_true(face->flat);
        const double outer = area_of(&b, face, &b.loops[face->first], &box);
        double inner = 0;
        for (size_t l = 1; l < face->count; l++)
          inner += area_of(&b, face, &b.loops[face->first + l], &holes);
        bool found = false;
        for (size_t k = 0; k < cases[i].faces && !found; k++) {
          found = !seen[k] && fabs(outer - cases[i].of[k].outer) < 0.01 &&
                  fabs(inner + cases[i].of[k].holes) < 0.01 && face->count == cases[i].of[k].count;
          if (found) seen[k] = true;
        }
        if (!found) fail_msg("%s: areas %g and %g, %zu loops", script, outer, inner, face->count);
        if (face->count > 1)
          assert_true(holes.min.x > box.min.x && holes.max.x < box.max.x &&
                      holes.min.y > box.min.y && holes.max.y < box.max.y);
        // The surface extends beyond the outline by a thousandth of its longer side, and its
        // parameters are lengths.
        const CagSurface *r = face->surface;
        const double u[2] = {r->u0, r->u1}, v[2] = {r->v0, r->v1};
        const double off = 1e-3 * fmax(box.max.x - box.min.x, box.max.y - box.min.y);
        for (int k = 0; k < 4; k++) {
          CagVec3 p;
          OK(cag_surface_eval(r, u[k / 2], v[k % 2], 0, CAG_SIDE_LEFT, CAG_SIDE_LEFT, &p, &err));
          p = in_plane(face, p);
          is_near(p.z, 0, 1e-9, "height of a corner");
          is_near(p.x, k / 2 ? box.max.x + off : box.min.x - off, 1e-3, "corner");
          is_near(p.y, k % 2 ? box.max.y + off : box.min.y - off, 1e-3, "corner");
          cag_bounds_add(&corners, p);
        }
        is_near(u[1] - u[0], corners.max.x - corners.min.x, 1e-9, "length along u");
        is_near(v[1] - v[0], corners.max.y - corners.min.y, 1e-9, "length along v");
      }
      cag_brep_free(&b);
      cag_session_free(s);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(regions_are_faces_with_their_loops)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
