// The POV-Ray objects for shapes, in the text of the scene. The expected numbers follow from the
// shape and from the manual of POV-Ray 3.7.

#include <ctype.h>

#include "interp/formats/pov.h"
#include "interp/session/session.h"
#include "scene_fixture.h"
#include "session_support.h"

// The text of the scene without comments, with each run of white space as one space.
static char *source_of(const char *script, CagPovOptions options) {
  CagSession *s = new_session();
  CagShownCounts counts;
  CagError io;
  if (cag_session_run_text(s, "script", script, strlen(script)) != CAG_STATUS_OK ||
      cag_session_scene(s, &counts) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("the script fails: %s", script);
  }
  CagAtomicFile *file = cag_atomic_file_open_memory(&io);
  OK(cag_export_pov(&s->scene, &options, file, &err));
  char *bytes;
  size_t size;
  assert_true(cag_atomic_file_commit_memory(file, &bytes, &size, &io));
  cag_session_free(s);
  char *text = malloc(size + 2), *to = text;
  for (size_t i = 0; i < size; i++) {
    if (i + 1 < size && bytes[i] == '/' && bytes[i + 1] == '/')
      while (i < size && bytes[i] != '\n') i++;
    const char c = isspace((unsigned char)bytes[i]) ? ' ' : bytes[i];
    if (c != ' ' || (to > text && to[-1] != ' ')) *to++ = c;
  }
  *to = 0;
  free(bytes);
  return text;
}

static bool begins_number(const char *c) {
  return isdigit((unsigned char)*c) || (*c == '-' && isdigit((unsigned char)c[1]));
}

// Whether a text begins with another one; numbers may differ by rounding.
static bool begins_with(const char *text, const char *expected) {
  while (*expected) {
    if (begins_number(expected) && begins_number(text)) {
      char *a, *b;
      const double x = strtod(text, &a), y = strtod(expected, &b);
      if (!(fabs(x - y) <= 1e-9 * fmax(1, fabs(y)))) return false;
      text = a;
      expected = b;
    } else if (*text++ != *expected++) return false;
  }
  return true;
}

static bool contains(const char *text, const char *part) {
  for (; *text; text++)
    if (begins_with(text, part)) return true;
  return false;
}

static const char *shown_part(const char *text) {
  const char *at = strstr(text, "#declare thing");
  return at ? at : text;
}

// Shows `thing` with a sun and a camera.
static void becomes(const char *thing, const char *expected) {
  char script[1000];
  snprintf(script, sizeof script,
           "thing = %s\nshow named(thing, \"thing\"), sun(-Z), camera([0, -40, 9])", thing);
  CagPovOptions options = CAG_POV_OPTIONS_DEFAULT;
  options.csg = CAG_POV_CSG_NATIVE;
  char *text = source_of(script, options);
  if (!contains(text, expected))
    fail_msg("%s:\n%.1500s\nand not\n%s", thing, shown_part(text), expected);
  free(text);
}

#define MESH "#declare thing = mesh2 {"
#define ALONG_Z "matrix <1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0>" // the lathe's y to Z

static void solids_are_native_objects(void **state) {
  (void)state;
  static const char *const cases[][2] = {
      {"sphere(2)",
       "#declare thing = sphere { <0, 0, 0>, 2 } object { thing material { M_default } }"},
      {"translate(sphere(2), [1, 2, 3])",
       "sphere { <0, 0, 0>, 2 } object { thing material { M_default } translate <1, 2, 3> }"},
      {"scale(sphere(2), [1, 1, 3])", "sphere { <0, 0, 0>, 2 matrix <1, 0, 0, 0, 1, 0, 0, 0, 3, 0, "
                                      "0, 0> } object { thing material { M_default } }"},
      {"box([1, 2, 3])", "box { <0, 0, 0>, <1, 2, 3> }"},
      {"box([1, 2, 3], centered: true)", "box { <-0.5, -1, -1.5>, <0.5, 1, 1.5> }"},
      {"rotate(cylinder(5, 2), X, 90deg)",
       "cylinder { <0, 0, 0>, <0, 0, 5>, 2 } object { thing material { M_default } matrix <1, 0, "
       "0, 0, 0, 1, 0, -1, 0, 0, 0, 0> }"},
      {"cylinder(5, 2, 1)", "cone { <0, 0, 0>, 2, <0, 0, 5>, 1 }"},
      {"cone(5, 2)", "cone { <0, 0, 0>, 2, <0, 0, 5>, 0 }"},
      {"scale(torus(5, 1), [1, 1, 2])",
       "torus { 5, 1 rotate 90*x matrix <1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0> }"},
      {"torus(5, 1)", "torus { 5, 1 rotate 90*x } object { thing material { M_default } }"},
      {"solid(tessellate(box(1)))", MESH},
      {"sphere(3) & half_space(plane([0, 0, 1], Z))", "intersection { sphere { <0, 0, 0>, 3"},
      {"sphere(3) & half_space(plane([0, 0, 2], [0, 3, 4]))",
       "intersection { sphere { <0, 0, 0>, 3 } plane { <0, 0.6, 0.8>, 1.6 } }"},
      {"sphere(3) | box(2)", "#declare thing = union {"},
      {"translate(sphere(2), [4, 0, 0])", "material { M_default } translate <4, 0, 0> }"},
      {"translate(sphere(2), [0, 4, 0])", "material { M_default } translate <0, 4, 0> }"},
      {"translate(sphere(2), [0, 0, 4])", "material { M_default } translate <0, 0, 4> }"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) becomes(cases[i][0], cases[i][1]);
}

static void surfaces_are_native_objects(void **state) {
  (void)state;
  static const char *const cases[][2] = {
      {"sphere_surface(3)", "sphere { <0, 0, 0>, 3 }"},
      {"translate(sphere_surface(3), [1, 2, 3])", "sphere { <1, 2, 3>, 3 }"},
      {"torus_surface(4, 1)", "torus { 4, 1 rotate 90*x }"},
      {"translate(torus_surface(4, 1), [1, 2, 3])",
       "torus { 4, 1 rotate 90*x translate <1, 2, 3> }"},
      {"revolve(circle(1, center: [5, 0]))", "torus { 5, 1 rotate 90*x }"},
      {"revolve(translate(circle(1), [5, 2]))", "torus { 5, 1 rotate 90*x translate <0, 0, 2> }"},
      {"revolve(ellipse(1, 2) |> translate([5, 0]))", "lathe {"},
      // x^2 / 9 + y^2 / 16 + z^2 / 25 = 1
      {"ellipsoid(3, 4, 5)",
       "quadric { <0.1111111111111111, 0.0625, 0.04>, <0, 0, 0>, <0, 0, 0>, -1 } object"},
      {"quadric([1, 2, 3, 0.5, 0.25, 0.75, 0, 0, 0, -4])",
       "quadric { <0.25, 0.5, 0.75>, <0.125, 0.1875, 0.0625>, <0, 0, 0>, -1 } object"},
      {"translate(ellipsoid(1, 1, 2), [3, 0, 0])",
       "quadric { <1, 1, 0.25>, <0, 0, 0>, <-6, 0, 0>, 8 } object"},
      // Faces that do not cut are at a distance of 1e-4 of the diagonal, sqrt(4^2 + 8^2 + 5^2).
      {"elliptic_cylinder(2, 4, within: -1..4)",
       "clipped_by { box { <-2.0010246951, -4.0010246951, -1>, <2.0010246951, 4.0010246951, 4> } "
       "}"},
      {"elliptic_cylinder(2, 4, within: -1..4)",
       "quadric { <0.25, 0.0625, 0>, <0, 0, 0>, <0, 0, 0>, -1 clipped_by { box {"},
      // Quadratic and linear pieces are elevated, which divides their legs in thirds.
      {"revolve(bezier([[3, 0], [6, 3], [3, 9]]))",
       "lathe { bezier_spline 4, <3, 0>, <5, 2>, <5, 5>, <3, 9> sturm " ALONG_Z " }"},
      {"revolve(bezier([[3, 0], [6, 3], [5, 4], [3, 9]]))",
       "lathe { bezier_spline 4, <3, 0>, <6, 3>, <5, 4>, <3, 9> sturm " ALONG_Z " }"},
      {"revolve(bezier([[3, 0], [6, 3], [3, 9]]), angle: 0deg..359deg)", MESH},
      {"revolve(polyline([[0, 0], [3, 0], [3, 4], [1, 4], [1, 6]]))",
       "union { disc { <0, 0, 0>, y, 3, 0 } cone { <0, 0, 0>, 3, <0, 4, 0>, 3 open } "
       "disc { <0, 4, 0>, y, 3, 1 } cone { <0, 4, 0>, 1, <0, 6, 0>, 1 open } " ALONG_Z " }"},
      {"revolve(polyline([[3, 0], [5, 2], [0, 6], [0, 7]]))",
       "union { cone { <0, 0, 0>, 3, <0, 2, 0>, 5 open } cone { <0, 2, 0>, 5, <0, 6, 0>, 0 open "
       "} " ALONG_Z " }"},
      {"revolve(polyline([[1, 4], [3, 4]]))", "union { disc { <0, 4, 0>, y, 3, 1 } " ALONG_Z " }"},
      // About X through z = -2, radii are heights above the axis.
      {"revolve(line([3, 0, 0], [4, 0, 5]), axis: X, through: [0, 0, -2])",
       "union { cone { <0, 3, 0>, 2, <0, 4, 0>, 7 open } matrix <0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0, "
       "-2> }"},
      {"revolve(line([3, 0, 0], [0, 3, 5]))",
       MESH}, // a hyperboloid: the line leaves the half plane
      {"bezier_surface([for i in 0..3: [for j in 0..3: [i, j, i * j]]])",
       "bicubic_patch { type 1 flatness 0 u_steps 5 v_steps 5, <0, 0, 0>, <0, 1, 0>, <0, 2, 0>, "
       "<0, 3, 0>, "
       "<1, 0, 0>, <1, 1, 1>, <1, 2, 2>, <1, 3, 3>, <2, 0, 0>, <2, 1, 2>, <2, 2, 4>, <2, 3, 6>, "
       "<3, 0, 0>, <3, 1, 3>, <3, 2, 6>, <3, 3, 9> }"},
      {"bezier_surface([[[0,0,0],[0,3,0]], [[3,0,0],[3,3,0]], [[6,0,6],[6,3,6]]])",
       "bicubic_patch { type 1 flatness 0 u_steps 5 v_steps 5, <0, 0, 0>, <0, 1, 0>, <0, 2, 0>, "
       "<0, 3, 0>, "
       "<2, 0, 0>, <2, 1, 0>, <2, 2, 0>, <2, 3, 0>, <4, 0, 2>, <4, 1, 2>, <4, 2, 2>, <4, 3, 2>, "
       "<6, 0, 6>, <6, 1, 6>, <6, 2, 6>, <6, 3, 6> }"},
      {"bezier_surface([[[0,0,0],[0,3,0]], [[3,0,0],[3,3,1]]])", MESH},
      {"bezier_surface([for i in 0..4: [for j in 0..3: [i, j, i * j]]])", MESH},
      {"bezier_surface([for i in 0..3: [for j in 0..4: [i, j, i * j]]])", MESH},
      {"bezier_surface([for i in 0..2: [for j in 0..2: [i, j, i * j]]], weights: "
       "[[1,1,1],[1,2,1],[1,1,1]])",
       MESH},
      {"bspline_surface([for i in 0..4: [for j in 0..3: [i, j, i * j]]])", MESH},
      {"rectangle(4, 2)", "polygon { 5, <-2, -1>, <2, -1>, <2, 1>, <-2, 1>, <-2, -1> }"},
      {"translate(polygon([[0, 0], [4, 0], [0, 3]], holes: [[[1, 1], [2, 1], [1, 1.5]]]), [0, 0, "
       "5])",
       "polygon { 8, <0, 0>, <4, 0>, <0, 3>, <0, 0>, <1, 1>, <1, 1.5>, <2, 1>, <1, 1> translate "
       "<0, 0, 5> }"},
      {"region(circle(3))", MESH},
      {"surface((u, v) => [u, v, u * v], 0..1, 0..1)", MESH},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) becomes(cases[i][0], cases[i][1]);
}

static void curves_are_native_objects(void **state) {
  (void)state;
  static const char *const cases[][2] = {
      {"line_style(circle(5), 0.25)",
       "#local line_radius = 0.25; #declare thing = torus { 5, line_radius rotate 90*x }"},
      {"line_style(polyline([[0, 0, 0], [5, 0, 0], [5, 5, 5]]), 0.5)",
       "#declare thing = union { cylinder { <0, 0, 0>, <5, 0, 0>, line_radius } sphere { <0, 0, "
       "0>, line_radius } "
       "cylinder { <5, 0, 0>, <5, 5, 5>, line_radius } sphere { <5, 0, 0>, line_radius } sphere { "
       "<5, 5, 5>, line_radius } }"},
      {"line_style(polyline([[0, 0, 0], [5, 0, 0], [5, 5, 5]], closed: true), 0.5)",
       "cylinder { <5, 5, 5>, <0, 0, 0>, line_radius }"},
      // Dashes and gaps of length 2 along 10, and around a corner.
      {"line_style(line([0, 0, 0], [10, 0, 0]), 0.5, dash: 2)",
       "union { cylinder { <0, 0, 0>, <2, 0, 0>, line_radius } cylinder { <4, 0, 0>, <6, 0, 0>, "
       "line_radius } "
       "cylinder { <8, 0, 0>, <10, 0, 0>, line_radius } }"},
      {"line_style(polyline([[0, 0, 0], [5, 0, 0], [5, 5, 0]]), 0.5, dash: 2)",
       "union { cylinder { <0, 0, 0>, <2, 0, 0>, line_radius } cylinder { <4, 0, 0>, <5, 0, 0>, "
       "line_radius } "
       "cylinder { <5, 0, 0>, <5, 1, 0>, line_radius } cylinder { <5, 3, 0>, <5, 5, 0>, "
       "line_radius } }"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) becomes(cases[i][0], cases[i][1]);
}

// The corners of a straight extrusion: the matrix maps (x, 0, y) and (x, 1, y) of each point of the
// prism to the ends.
static void prisms_have_their_corners(void **state) {
  (void)state;
  static const struct {
    const char *thing;
    double along[3], corners[6][2];
    int count;
  } cases[] = {
      {"extrude(polygon([[0, 0], [4, 0], [0, 3]]), 2)", {0, 0, 2}, {{0, 0}, {4, 0}, {0, 3}}, 3},
      {"extrude(polygon([[0, 0], [4, 0], [5, 3], [0, 3]]), [1, 0.5, 5])",
       {1, 0.5, 5},
       {{0, 0}, {4, 0}, {5, 3}, {0, 3}},
       4},
      {"extrude(rectangle(4, 2), -3)", {0, 0, -3}, {{-2, -1}, {2, -1}, {2, 1}, {-2, 1}}, 4},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char script[300];
    snprintf(script, sizeof script, "show named(%s, \"thing\"), sun(-Z), camera([0, -40, 9])",
             cases[i].thing);
    char *text = source_of(script, CAG_POV_OPTIONS_DEFAULT),
         *at = strstr(text, "prism { linear_sweep linear_spline 0, 1, ");
    if (!at) fail_msg("%s", shown_part(text));
    at += strlen("prism { linear_sweep linear_spline 0, 1, ");
    const int n = (int)strtol(at, &at, 10);
    assert_int_equal(n, cases[i].count + 1); // the first point is repeated
    double p[8][2], m[4][3];
    for (int k = 0; k < n; k++)
      for (int j = 0; j < 2; j++) p[k][j] = strtod(at += strcspn(at, "-0123456789"), &at);
    at = strstr(at, "matrix");
    for (int k = 0; k < 12; k++) m[k / 3][k % 3] = strtod(at += strcspn(at, "-0123456789"), &at);
    for (int k = 0; k < cases[i].count; k++)
      for (int end = 0; end < 2; end++) {
        double least = INFINITY;
        for (int l = 0; l < n; l++)
          for (int up = 0; up < 2; up++) {
            double off = 0;
            for (int j = 0; j < 3; j++) {
              const double x = p[l][0] * m[0][j] + up * m[1][j] + p[l][1] * m[2][j] + m[3][j];
              off += fabs(x - (j < 2 ? cases[i].corners[k][j] : 0) - end * cases[i].along[j]);
            }
            least = fmin(least, off);
          }
        if (least > 1e-9) fail_msg("%s: corner %d is %g off", cases[i].thing, k, least);
      }
    free(text);
  }
  becomes("extrude(rectangle(4, 2), 3, twist: 30deg)", MESH);
  becomes("extrude(rectangle(4, 2), 3, twist: 360deg)", MESH);
  becomes("extrude(rectangle(4, 2), 3, scale: 0.5)", MESH);
  becomes("extrude(bezier([[0, 0], [4, 0], [4, 4], [0, 0]]), 2)",
          "prism { linear_sweep bezier_spline 0, 1, 4,");
}

// The rows of numbers of a block, such as `vertex_vectors { 2, <1,2,3>,<4,5,6> }`.
static int read_rows(const char *text, const char *name, double out[][3]) {
  const char *at = strstr(text, name);
  if (!at) fail_msg("no %s", name);
  char *end;
  const int n = (int)strtol(strchr(at, '{') + 1, &end, 10);
  for (int k = 0; k < n; k++)
    for (int j = 0; j < 3; j++) {
      end += strcspn(end, "-0123456789}");
      assert_true(*end != '}');
      out[k][j] = strtod(end, &end);
    }
  assert_int_equal(end[strcspn(end, "-0123456789}")], '}');
  return n;
}

// The numbers of a mesh far from the origin are relative to its center, and there is a translation.
static void meshes_have_their_corners(void **state) {
  (void)state;
  static double vertices[5000][3], normals[5000][3], faces[9000][3];
  char *text =
      source_of("show named(mesh([[100000.25, 200000, 300000], [100001.25, 200000.125, 300000], "
                "[100000.25, 200002, 300000.5], [100000.25, 200000, 300003]], "
                "[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]), \"thing\"), sun(-Z), "
                "camera([99900, 199900, 300100], [100000, 200000, 300000])",
                CAG_POV_OPTIONS_DEFAULT);
  const double corners[4][3] = {{100000.25, 200000, 300000},
                                {100001.25, 200000.125, 300000},
                                {100000.25, 200002, 300000.5},
                                {100000.25, 200000, 300003}};
  const int order[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  assert_int_equal(read_rows(text, "vertex_vectors", vertices), 4);
  assert_int_equal(read_rows(text, "face_indices", faces), 4);
  const char *at = strstr(strstr(text, "face_indices"), "translate <");
  double origin[3];
  assert_int_equal(sscanf(at, "translate <%lf, %lf, %lf>", &origin[0], &origin[1], &origin[2]), 3);
  for (int k = 0; k < 4; k++)
    for (int j = 0; j < 3; j++) {
      assert_true(fabs(vertices[k][j]) < 10);
      assert_true(fabs(vertices[k][j] + origin[j] - corners[k][j]) < 1e-7);
      assert_int_equal((int)faces[k][j], order[k][j]);
    }
  free(text);
  // All points of a ball are on it, and normals are radii, except for those near the outline, which
  // are slightly rotated.
  text = source_of("show named(tessellate(sphere(5)), \"thing\"), sun(-Z), camera([0, -60, 9])",
                   CAG_POV_OPTIONS_DEFAULT);
  const int n = read_rows(text, "vertex_vectors", vertices);
  assert_int_equal(read_rows(text, "normal_vectors", normals), n);
  const int m = read_rows(text, "face_indices", faces);
  int exact = 0;
  for (int k = 0; k < n; k++) {
    const CagVec3 p = cag_vec3(vertices[k][0], vertices[k][1], vertices[k][2]);
    const CagVec3 q = cag_vec3(normals[k][0], normals[k][1], normals[k][2]);
    assert_true(fabs(cag_norm(p) - 5) < 1e-6 && fabs(cag_norm(q) - 1) < 2e-5);
    const double cosine = cag_dot(p, q) / 5;
    assert_true(cosine > 0.98);
    exact += cosine > 1 - 3e-5; // five decimals
  }
  assert_true(exact > n / 2);
  double volume = 0;
  for (int k = 0; k < m; k++) {
    CagVec3 p[3];
    for (int j = 0; j < 3; j++) {
      assert_true(faces[k][j] >= 0 && faces[k][j] < n);
      const double *v = vertices[(int)faces[k][j]];
      p[j] = cag_vec3(v[0], v[1], v[2]);
    }
    volume += cag_dot(p[0], cag_cross(p[1], p[2])) / 6;
  }
  assert_true(fabs(volume / (4.0 / 3 * M_PI * 125) - 1) < 0.02);
  free(text);
}

// Solids refract, but open surfaces of the same material do not.
static void materials_are_those_of_bodies_or_sheets(void **state) {
  (void)state;
  static const char *const things[] = {"m(box(20))", "m(rectangle(10, 20))",
                                       "m(box(20)), m(rectangle(10, 20))"};
  for (int k = 0; k < 3; k++) {
    char script[300];
    snprintf(script, sizeof script,
             "m(g) = material(g, {transmission: 0.5, ior: 1.25, name: \"glass\"})\n"
             "show %s, sun(-Z), camera([0, -60, 9])",
             things[k]);
    char *text = source_of(script, CAG_POV_OPTIONS_DEFAULT);
    assert_true((strstr(text, "#declare M_glass = ") != NULL) == (k != 1));
    assert_true((strstr(text, "#declare M_glass_thin = ") != NULL) == (k != 0));
    assert_true((strstr(text, "material { M_glass }") != NULL) == (k != 1));
    assert_true((strstr(text, "material { M_glass_thin }") != NULL) == (k != 0));
    assert_true(contains(text, "filter 0.5"));
    assert_true(contains(text, "interior { ior 1.25 }") == (k != 1));
    free(text);
  }
}

static void quality_is_that_of_the_options(void **state) {
  (void)state;
  const char *script = "show bezier_surface([for i in 0..3: [for j in 0..3: [i, j, i * j]]]), "
                       "sun(-Z), area_light([0, 9, 0], origin, 5), camera([0, -40, 9])";
  static const char *const steps[] = {"u_steps 3 v_steps 3", "u_steps 5 v_steps 5",
                                      "u_steps 5 v_steps 5"};
  static const char *const lights[] = {NULL, ", 5, 5 adaptive 1 jitter", ", 9, 9 adaptive"};
  for (int q = 0; q < 3; q++) {
    CagPovOptions options = CAG_POV_OPTIONS_DEFAULT;
    options.quality = (CagPovQuality)q;
    char *text = source_of(script, options);
    assert_true(contains(text, steps[q]));
    assert_true((strstr(text, "area_light") != NULL) == (q > 0));
    if (lights[q]) assert_true(contains(text, lights[q]));
    assert_true((strstr(text, "radiosity {") != NULL) == (q == 2));
    free(text);
    options.meshes_only = true;
    text = source_of(script, options);
    assert_null(strstr(text, "bicubic_patch"));
    free(text);
  }
}

// Indirect light is computed for final pictures, and for normal ones with the sky as the only
// light. In other pictures, the ambient part of materials replaces it.
static void indirect_light_depends_on_quality_and_lights(void **state) {
  (void)state;
  static const struct {
    const char *stage;
    bool indirect[3]; // draft, normal, final
  } cases[] = {
      {"sky(\"white\")", {false, true, true}},
      {"sky(\"white\"), sun(-Z)", {false, false, true}},
      {"sun(-Z)", {false, false, true}},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
    for (int q = 0; q < 3; q++) {
      CagPovOptions options = CAG_POV_OPTIONS_DEFAULT;
      options.quality = (CagPovQuality)q;
      char script[99];
      snprintf(script, sizeof script, "show sphere(1), camera([0, -40, 9]), %s", cases[k].stage);
      char *text = source_of(script, options);
      assert_true(contains(text, "radiosity {") == cases[k].indirect[q]);
      assert_true(contains(text, "ambient_light") != cases[k].indirect[q]);
      free(text);
    }
}

// A light of strength 2 is twice as bright. A spot's falloff is half of its cone. The square of an
// area light has its size and is perpendicular to its direction. A camera of 40 degrees at 16:9 has
// the direction 16/9 / 2 / tan(20 degrees).
static void lights_and_cameras_have_their_numbers(void **state) {
  (void)state;
  char *text =
      source_of("show box(20), spot_light([0, 0, 10], [0, 0, 4], angle: 60deg, strength: 2), "
                "point_light([1, 2, 3], color: [1, 0.5, 0.25]), area_light([0, 9, 0], origin, 5), "
                "camera([0, -30, 0], origin, fov: 40deg), background([0.5, 0, 1])",
                CAG_POV_OPTIONS_DEFAULT);
  static const char *const parts[] = {
      "camera { perspective location <0, -30, 0> right 1.7777777777777777*<1, 0, 0> up <0, 0, 1> "
      "direction 2.442202150626331*<0, 1, 0> }",
      "light_source { <0, 0, 10> color rgb <2, 2, 2> spotlight radius 24 falloff 30 point_at <0, "
      "0, ",
      "light_source { <1, 2, 3> color rgb <1, 0.5, 0.25> }",
      "light_source { <0, 9, 0> color rgb <1, 1, 1> area_light 5*<-1, 0, 0>, 5*<0, 0, -1>, 5, 5 "
      "adaptive 1 jitter }",
      "background { rgb <0.5, 0, 1> }"};
  for (int i = 0; i < 5; i++)
    if (!contains(text, parts[i])) fail_msg("no %s in %.2000s", parts[i], text);
  free(text);
  text = source_of("show box(20), sun(-Z), camera([0, -30, 0], origin, kind: \"orthographic\", "
                   "width: 50, size: [100, 50])",
                   CAG_POV_OPTIONS_DEFAULT);
  assert_true(contains(text, "camera { orthographic location <0, -30, 0> right 50*<1, 0, 0> up "
                             "25*<0, 0, 1> direction <0, 1, 0> }"));
  free(text);
  text = source_of("show box(20), sky([[1, 0, 0], [0, 1, 0], [0, 0, 1]])", CAG_POV_OPTIONS_DEFAULT);
  assert_true(
      contains(text, "color_map { [0 rgb <1, 0, 0>] [0.5 rgb <0, 1, 0>] [1 rgb <0, 0, 1>] }"));
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solids_are_native_objects),
      cmocka_unit_test(surfaces_are_native_objects),
      cmocka_unit_test(curves_are_native_objects),
      cmocka_unit_test(prisms_have_their_corners),
      cmocka_unit_test(meshes_have_their_corners),
      cmocka_unit_test(materials_are_those_of_bodies_or_sheets),
      cmocka_unit_test(quality_is_that_of_the_options),
      cmocka_unit_test(indirect_light_depends_on_quality_and_lights),
      cmocka_unit_test(lights_and_cameras_have_their_numbers),
  };
  return cmocka_run_group_tests_name("pov_native", tests, NULL, NULL);
}
