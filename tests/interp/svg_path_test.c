// Paths of SVG pictures compared with the curves: for random curves and cameras, each path is
// interpreted according to SVG and compared with the projected curve.

#include "tests/geom/random.h"
#include "tests/interp/scene_fixture.h"

#include "interp/formats/svg.h"

static char folder[64];

static CagStatus export_to(const Fixture *f, char **text, CagError *err) {
  char path[128];
  CagError io;
  snprintf(path, sizeof path, "%s/picture.svg", folder);
  CagAtomicFile *file = cag_atomic_file_open(path, &io);
  assert_non_null(file);
  const CagStatus status = cag_export_svg(&f->scene, 0, file, err);
  if (status != CAG_OK) {
    cag_atomic_file_abort(file);
    return status;
  }
  assert_true(cag_atomic_file_commit(file, &io));
  *text = read_whole(path);
  return CAG_OK;
}

static char *export_text(const Fixture *f) {
  char *text = NULL;
  OK(export_to(f, &text, &err));
  return text;
}

// --- Reading paths ---

typedef struct Segment {
  char kind;   // L C A
  bool starts; // the pen was moved to its start
  double v[7];
  CagVec3 from, to; // y up
} Segment;

#define SEGMENTS_MAX 20000
static Segment segments[SEGMENTS_MAX];

static const char *read_numbers(const char *at, double *out, int n) {
  for (int i = 0; i < n; i++) {
    char *end;
    at += strspn(at, " ,");
    out[i] = strtod(at, &end);
    if (end == at) fail_msg("not a number: %.30s", at);
    at = end;
  }
  return at;
}

// Reads the path with the title `name`.
static size_t read_path(const char *text, const char *name) {
  char title[100];
  snprintf(title, sizeof title, "<title>%s</title>", name);
  const char *end = strstr(text, title);
  assert_non_null(end);
  const char *at = end;
  while (strncmp(at, " d=\"", 4) != 0) at--;
  size_t n = 0;
  CagVec3 pen = {0, 0, 0};
  bool moved = false;
  for (at += 4; *at != '"';) {
    at += strspn(at, " ,");
    const char kind = *at++;
    if (kind == 'Z') continue;
    Segment s = {.kind = kind, .from = pen, .starts = moved};
    const int count = kind == 'C' ? 6 : kind == 'A' ? 7 : kind == 'L' || kind == 'M' ? 2 : 0;
    if (count == 0) fail_msg("the command `%c`", kind);
    at = read_numbers(at, s.v, count);
    s.to = pen = cag_vec3(s.v[count - 2], -s.v[count - 1], 0);
    moved = kind == 'M';
    if (moved) continue;
    assert_true(n < SEGMENTS_MAX);
    segments[n++] = s;
  }
  return n;
}

// A point of an elliptic arc, by the implementation notes of SVG 1.1 (F.6.5), with y downward.
static CagVec3 arc_at(const Segment *s, double t) {
  const double rx = s->v[0], ry = s->v[1], phi = s->v[2] * M_PI / 180, c = cos(phi), k = sin(phi);
  const bool large = s->v[3] != 0, sweep = s->v[4] != 0;
  const double x1 = s->from.x, y1 = -s->from.y, x2 = s->to.x, y2 = -s->to.y;
  const double dx = (x1 - x2) / 2, dy = (y1 - y2) / 2;
  const double u = (c * dx + k * dy) / rx, v = (c * dy - k * dx) / ry;
  const double left = 1 - u * u - v * v, root = sqrt(fmax(left, 0) / (u * u + v * v));
  const double sign = large == sweep ? -1 : 1;
  const double cu = sign * root * v, cv = -sign * root * u;
  const double cx = c * rx * cu - k * ry * cv + (x1 + x2) / 2;
  const double cy = k * rx * cu + c * ry * cv + (y1 + y2) / 2;
  const double begin = atan2(v - cv, u - cu);
  double span = atan2(-v - cv, -u - cu) - begin;
  if (sweep && span < 0) span += 2 * M_PI;
  if (!sweep && span > 0) span -= 2 * M_PI;
  const double a = begin + t * span;
  return cag_vec3(cx + c * rx * cos(a) - k * ry * sin(a), -(cy + k * rx * cos(a) + c * ry * sin(a)),
                  0);
}

static CagVec3 segment_at(const Segment *s, double t) {
  if (s->kind == 'L') return cag_lerp(s->from, s->to, t);
  if (s->kind == 'A') return arc_at(s, t);
  const CagVec3 a = cag_vec3(s->v[0], -s->v[1], 0), b = cag_vec3(s->v[2], -s->v[3], 0);
  const CagVec3 p = cag_lerp(s->from, a, t), q = cag_lerp(a, b, t), r = cag_lerp(b, s->to, t);
  return cag_lerp(cag_lerp(p, q, t), cag_lerp(q, r, t), t);
}

static CagVec3 curve_at(const CagCurve *c, double t) {
  CagVec3 p;
  OK(cag_curve_eval(c, t, 0, CAG_SIDE_LEFT, &p, &err));
  return p;
}

static void is_near(CagVec3 p, CagVec3 q, double within, const char *what) {
  if (!(cag_norm(cag_sub(p, q)) <= within))
    fail_msg("%s: [%.12g, %.12g], not [%.12g, %.12g]", what, p.x, p.y, q.x, q.y);
}

// Checks that the picture contains the box of what is drawn, with a border of 5% of the diagonal
// and half of the widest line. The box may be too small by `over`.
static void is_framed(const char *text, CagBounds box, double line, double over) {
  double x, y, w, h, wide, tall;
  const char *at = strstr(text, "width=\"");
  assert_int_equal(sscanf(at, "width=\"%lfmm\" height=\"%lfmm\" viewBox=\"%lf %lf %lf %lf\"", &wide,
                          &tall, &x, &y, &w, &h),
                   6);
  assert_true(wide == w && tall == h);
  const double dx = box.max.x - box.min.x, dy = box.max.y - box.min.y, diagonal = hypot(dx, dy);
  const double border = 0.05 * diagonal + fmax(0.003 * diagonal, line) / 2;
  const double within = 1.2 * over + 1e-6 * diagonal;
  if (fabs(x - (box.min.x - border)) > within || fabs(y - (-box.max.y - border)) > within ||
      fabs(w - (dx + 2 * border)) > 2 * within || fabs(h - (dy + 2 * border)) > 2 * within)
    fail_msg("the picture is [%g, %g, %g, %g], not [%g, %g, %g, %g]", x, y, w, h,
             box.min.x - border, -box.max.y - border, dx + 2 * border, dy + 2 * border);
  double stroke;
  at = strstr(text, "<g ");
  assert_int_equal(sscanf(strstr(at, "stroke-width=\""), "stroke-width=\"%lf\"", &stroke), 1);
  assert_true(fabs(stroke - 0.003 * diagonal) <= 0.006 * within + 1e-8 * diagonal);
}

// --- Flat pictures ---

static CagVec3 random_point(double size, double z) {
  const double x = uniform(-size, size);
  return cag_vec3(x, uniform(-size, size), z);
}

// Polynomials of degree up to 3 in a plane z = constant are one exact command, with the same
// parametrization. The picture ends where the curve does.
static void polynomials_are_exact(void **state) {
  (void)state;
  seed = 11;
  for (int round = 0; round < 150; round++) {
    const size_t degree = (size_t)(1 + round % 3);
    const double power = uniform(-3, 4), size = pow(10, round % 10 == 9 ? power + 10 : power);
    const double z = round % 2 ? size : 0;
    CagVec3 p[4];
    for (size_t i = 0; i <= degree; i++) p[i] = random_point(size, z);
    if (degree == 3 && round % 4 == 2) { // a straight line with constant speed
      p[1] = cag_lerp(p[0], p[3], 1.0 / 3);
      p[2] = cag_lerp(p[0], p[3], round % 8 == 2 ? 2.0 / 3 : 1.0 / 2);
    }
    Fixture f;
    CagCurve *c;
    OK(cag_curve_bezier(p, NULL, degree + 1, 3, &c, &err));
    fixture_begin(&f);
    CagItem *item = fixture_curve(&f, "c", c);
    item->line_radius = round % 5 == 0 ? 0.1 * size : 0;
    char *text = export_text(&f);
    assert_int_equal(read_path(text, "c"), 1);
    assert_int_equal(segments[0].kind, degree == 1 || (degree == 3 && round % 8 == 2) ? 'L' : 'C');
    CagBounds box = CAG_BOUNDS_EMPTY;
    for (int i = 0; i <= 4000; i++) {
      CagVec3 q = curve_at(c, i / 4000.0);
      q.z = 0;
      cag_bounds_add(&box, q);
      if (i % 400 == 0) is_near(segment_at(&segments[0], i / 4000.0), q, 1e-8 * size, "curve");
    }
    is_framed(text, box, 2 * item->line_radius, 1e-6 * size);
    free(text);
    fixture_end(&f);
  }
}

// Arcs of ellipses, even if translated, rotated, reflected, or sheared, become elliptic arcs of at
// most a half turn. The midpoint of a command is that of its part of the curve, because affine maps
// preserve differences of the eccentric angle.
static void arcs_are_exact(void **state) {
  (void)state;
  seed = 12;
  for (int round = 0; round < 200; round++) {
    const double a = uniform(1, 10), b = round % 4 == 0 ? a : uniform(1, 10);
    const double start = uniform(-4, 4);
    const double span = round % 5 == 0 ? 2 * M_PI : round % 5 == 1 ? M_PI : uniform(0.1, 6.2);
    CagTransform frame = cag_translate(random_point(20, 3));
    const double turn = uniform(-4, 4), skew = round % 3 == 0 ? uniform(-2, 2) : 0;
    const double mirror = round % 2 ? 1 : -1;
    frame.m[0][0] = cos(turn), frame.m[1][0] = sin(turn);
    frame.m[0][1] = mirror * (skew * cos(turn) - sin(turn));
    frame.m[1][1] = mirror * (skew * sin(turn) + cos(turn));
    Fixture f;
    CagCurve *c, *placed;
    const CagTransform unit = cag_transform_identity();
    OK(cag_curve_arc(a, b, start, start + span, &unit, &c, &err));
    OK(cag_curve_transform(c, &frame, &placed, &err));
    cag_curve_release(c);
    fixture_begin(&f);
    fixture_curve(&f, "c", placed);
    char *text = export_text(&f);
    const size_t n = read_path(text, "c");
    assert_int_equal(n, (size_t)ceil(span / M_PI - 1e-9));
    assert_true((strstr(text, " Z\"") != NULL) == (round % 5 == 0));
    CagBounds box = CAG_BOUNDS_EMPTY;
    double largest = 0;
    for (size_t i = 0; i < n; i++) {
      assert_int_equal(segments[i].kind, 'A');
      largest = fmax(largest, segments[i].v[0]);
      assert_true(segments[i].v[0] >= segments[i].v[1]);
      assert_true(segments[i].starts == (i == 0));
      for (int k = 0; k <= 4; k++) {
        const double t =
            placed->start + (placed->end - placed->start) * ((double)i + k / 4.0) / (double)n;
        CagVec3 q = curve_at(placed, t);
        q.z = 0;
        // The center of a half turn is accurate only to the square root of rounding.
        is_near(segment_at(&segments[i], k / 4.0), q, 3e-3, "arc");
      }
    }
    for (int i = 0; i <= 2000; i++) {
      CagVec3 q = curve_at(placed, placed->start + (placed->end - placed->start) * i / 2000);
      q.z = 0;
      cag_bounds_add(&box, q);
    }
    is_framed(text, box, 0, largest / 800);
    free(text);
    fixture_end(&f);
  }
}

// A line without extent in x is drawn, too, and one without a radius has the default width.
static void an_upright_line_is_drawn(void **state) {
  (void)state;
  Fixture f;
  CagCurve *c;
  OK(cag_curve_line(cag_vec3(5, 0, 0), cag_vec3(5, 9, 0), 3, &c, &err));
  fixture_begin(&f);
  fixture_curve(&f, "c", c);
  char *text = export_text(&f);
  assert_int_equal(read_path(text, "c"), 1);
  is_framed(text, (CagBounds){{5, 0, 0}, {5, 9, 0}}, 0, 0);
  const char *path = strstr(text, "<path");
  assert_null(strstr(path, "stroke-width"));
  free(text);
  fixture_end(&f);
}

// The default size of a label is 0.024 of the diagonal of what is drawn, 3 by 4.
static void labels_have_a_size_by_what_is_drawn(void **state) {
  (void)state;
  Fixture f;
  CagCurve *c;
  CagLabel label = {.text = "", .mark = CAG_LABEL_DOT, .at = {1, 1, 0}};
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(3, 4, 0), 3, &c, &err));
  fixture_begin(&f);
  fixture_curve(&f, "c", c);
  f.scene.labels = &label;
  f.scene.label_count = 1;
  char *text = export_text(&f);
  // The radius of a dot is 0.24 of the size.
  assert_non_null(strstr(text, " A 0.0288 0.0288 "));
  free(text);
  fixture_end(&f);
}

// --- Projection by cameras ---

// Projects a point by the definition of a camera, with y up. Returns false behind the camera.
static bool seen(const CagCamera *c, CagVec3 p, CagVec3 *out) {
  const CagVec3 view = cag_unit(cag_sub(c->target, c->eye)),
                right = cag_unit(cag_cross(view, c->up));
  const CagVec3 up = cag_cross(right, view), d = cag_sub(p, c->eye);
  const double x = (c->mirrored ? -1 : 1) * cag_dot(d, right), y = cag_dot(d, up);
  const double z = cag_dot(d, view),
               k = c->orthographic ? 1 : cag_norm(cag_sub(c->target, c->eye)) / z;
  *out = cag_vec3(k * x, k * y, 0);
  return c->orthographic || z > 1e-3 * cag_norm(cag_sub(c->target, c->eye));
}

static double distance_to_line(CagVec3 p, CagVec3 a, CagVec3 b) {
  const CagVec3 d = cag_sub(b, a);
  const double n = cag_dot(d, d), t = n > 0 ? cag_dot(cag_sub(p, a), d) / n : 0;
  return cag_norm(cag_sub(p, cag_lerp(a, b, fmin(fmax(t, 0), 1))));
}

// The distance of a point from a polyline.
static double distance_to(CagVec3 p, const CagVec3 *q, size_t n) {
  double least = INFINITY;
  for (size_t i = 0; i + 1 < n; i++) least = fmin(least, distance_to_line(p, q[i], q[i + 1]));
  return least;
}

static CagCurve *random_curve(int kind) {
  CagCurve *c = NULL, *placed = NULL;
  CagVec3 p[6];
  double w[6];
  const double knots[] = {0, 0, 0, 0, 1, 1, 2, 2, 2, 2};
  for (int i = 0; i < 6; i++) {
    p[i] = random_point(20, 0);
    p[i].z = uniform(-20, 20);
    w[i] = uniform(0.5, 2);
  }
  const CagTransform unit = cag_transform_identity();
  switch (kind) {
  case 0: OK(cag_curve_bezier(p, w, 4, 3, &c, &err)); break;
  case 1: OK(cag_curve_bezier(p, NULL, 6, 3, &c, &err)); break;
  case 2: OK(cag_curve_helix(10, 4, 2, 0, &c, &err)); break;
  case 3: OK(cag_curve_arc(uniform(3, 12), 8, 0.3, 5, &unit, &c, &err)); break;
  case 4: OK(cag_curve_polyline(p, 5, true, 3, &c, &err)); break;
  default: OK(cag_curve_nurbs(p, w, 6, 3, knots, 3, &c, &err)); // with a corner at 1
  }
  CagTransform move = cag_translate(p[5]);
  const double a = w[0] * 5, k = w[1];
  move.m[0][0] = cos(a), move.m[0][2] = sin(a), move.m[2][0] = -sin(a), move.m[2][2] = cos(a);
  for (int i = 0; i < 3; i++) move.m[i][1] *= k;
  OK(cag_curve_transform(c, &move, &placed, &err));
  cag_curve_release(c);
  return placed;
}

// The points of all paths are on the projected curve, and vice versa, within the guaranteed
// 20,000th of the size.
static void cameras_see_curves_as_they_are(void **state) {
  (void)state;
  enum { N = 3000 };
  static CagVec3 exact[N + 1], drawn[N + 1];
  seed = 13;
  for (int round = 0; round < 60; round++) {
    CagCurve *c = random_curve(round % 6);
    Fixture f;
    fixture_begin(&f);
    f.camera.orthographic = round / 6 % 2;
    f.camera.mirrored = round % 4 == 3;
    f.camera.target = random_point(10, 4);
    f.camera.eye = cag_add(f.camera.target, cag_vec3(uniform(-90, 90), -120, 60));
    const CagVec3 view = cag_unit(cag_sub(f.camera.target, f.camera.eye));
    f.camera.up = cag_unit(cag_madd(cag_vec3(0, 0, 1), -view.z, view));
    fixture_curve(&f, "c", c);
    char *text = export_text(&f);
    const size_t n = read_path(text, "c");
    CagBounds whole, box = CAG_BOUNDS_EMPTY;
    OK(cag_curve_bounds(c, &whole, &err));
    const double size = cag_norm(cag_sub(whole.max, whole.min)), within = 6e-5 * size;
    double longest = 0;
    for (int i = 0; i <= N; i++) {
      assert_true(seen(&f.camera, curve_at(c, c->start + (c->end - c->start) * i / N), &exact[i]));
      cag_bounds_add(&box, exact[i]);
      if (i > 0) longest = fmax(longest, cag_norm(cag_sub(exact[i], exact[i - 1])));
    }
    // The points in the order of the path, with the same number for each command.
    size_t m = 0;
    const size_t steps = N / n;
    assert_true(steps > 10);
    for (size_t i = 0; i < n; i++) {
      assert_true(segments[i].starts == (i == 0));
      for (size_t k = 0; k <= steps; k += steps / 8)
        if (m <= N) drawn[m++] = segment_at(&segments[i], (double)k / (double)steps);
    }
    const double chord = longest * longest / size + 1e-7 * size; // of the samples
    for (size_t i = 0; i < m; i++)
      if (distance_to(drawn[i], exact, N + 1) > within + chord)
        fail_msg("round %d: drawn %g off the curve", round, distance_to(drawn[i], exact, N + 1));
    // The path includes ends and breaks.
    is_near(segments[0].from, exact[0], 1e-7 * size, "start");
    is_near(segments[n - 1].to, exact[N], 1e-7 * size, "end");
    for (int i = 0; i <= N; i += 60) {
      double least = INFINITY;
      for (size_t k = 0; k < n; k++) {
        CagVec3 q[65];
        for (int j = 0; j <= 64; j++) q[j] = segment_at(&segments[k], j / 64.0);
        least = fmin(least, distance_to(exact[i], q, 65));
      }
      if (least > within + size * 2e-3) fail_msg("round %d: a part of the curve is missing", round);
    }
    is_framed(text, box, 0, within + chord + (segments[0].kind == 'A' ? size / 800 : 0));
    free(text);
    fixture_end(&f);
  }
}

// The position and direction of a label are those of a projected short line. A label behind the
// camera is omitted.
static void cameras_see_labels_as_they_are(void **state) {
  (void)state;
  seed = 29;
  for (int round = 0; round < 40; round++) {
    Fixture f;
    fixture_begin(&f);
    f.camera.orthographic = round % 2;
    f.camera.mirrored = round % 4 > 1;
    f.camera.target = random_point(10, 4);
    f.camera.eye = cag_add(f.camera.target, cag_vec3(uniform(-90, 90), -120, 60));
    const CagVec3 view = cag_unit(cag_sub(f.camera.target, f.camera.eye));
    f.camera.up = cag_unit(cag_madd(cag_vec3(0, 0, 1), -view.z, view));
    const CagVec3 at = cag_add(f.camera.target, cag_vec3(uniform(-30, 30), uniform(-30, 30), 8));
    const double a = uniform(-3, 3), b = uniform(-1, 1);
    const CagVec3 along = cag_vec3(2 * cos(a), 2 * sin(a), b);
    CagLabel labels[] = {
        {.at = at, .along = along, .mark = CAG_LABEL_ARROW, .size = 10, .text = ""},
        {.at = cag_madd(f.camera.eye, -5, view), .mark = CAG_LABEL_DOT, .size = 10, .text = ""}};
    f.scene.labels = labels;
    f.scene.label_count = 2;
    char *text = export_text(&f);
    f.scene.labels = NULL;
    f.scene.label_count = 0;
    assert_true((strstr(text, " A ") != NULL) == f.camera.orthographic);
    const char *d = strstr(text, " d=\"M ");
    assert_non_null(d);
    double p[4][2];
    assert_int_equal(sscanf(d, " d=\"M %lf %lf L %lf %lf L %lf %lf L %lf %lf Z\"/>", &p[0][0],
                            &p[0][1], &p[1][0], &p[1][1], &p[2][0], &p[2][1], &p[3][0], &p[3][1]),
                     8);
    CagVec3 tip, next;
    assert_true(seen(&f.camera, at, &tip));
    assert_true(seen(&f.camera, cag_madd(at, 1e-6, along), &next));
    is_near(cag_vec3(p[0][0], -p[0][1], 0), tip, 0.0072, "tip");
    // The notch of the arrow is 6.75 behind the tip.
    const CagVec3 notch = cag_madd(tip, -6.75, cag_unit(cag_sub(next, tip)));
    is_near(cag_vec3(p[2][0], -p[2][1], 0), notch, 0.0072, "notch");
    free(text);
    fixture_end(&f);
  }
}

// A line that passes the camera ends at a depth of a thousandth of the target's distance, or within
// the last bisection step behind that. The part behind the camera is omitted.
static void what_is_behind_the_camera_is_left_out(void **state) {
  (void)state;
  for (int back = 0; back < 2; back++) {
    const CagVec3 front = {10, 100, 5}, behind = {10, -500, 10};
    Fixture f;
    CagCurve *c;
    OK(cag_curve_line(back ? behind : front, back ? front : behind, 3, &c, &err));
    fixture_begin(&f); // at y = -300, looking along +Y toward the origin
    fixture_curve(&f, "c", c);
    char *text = export_text(&f);
    const size_t n = read_path(text, "c");
    const CagVec3 far = back ? segments[n - 1].to : segments[0].from;
    const CagVec3 near = back ? segments[0].from : segments[n - 1].to;
    is_near(far, cag_vec3(7.5, 3.75, 0), 1e-6, "the far end");
    const double depth = 3000 / near.x;
    assert_true(depth > 0.3 && depth <= 0.3 + 600 / pow(2, 17) + 1e-9);
    for (size_t i = 0; i < n; i++) {
      assert_true(segments[i].starts == (i == 0));
      for (int k = 0; k <= 4; k++) {
        const CagVec3 p = segment_at(&segments[i], k / 4.0);
        const double z = 5 + (400 - 3000 / p.x) / 120; // of the point on the line
        assert_true(p.x >= 7.5 - 1e-3 && fabs(p.y - p.x / 10 * z) < 0.02);
      }
    }
    free(text);
    fixture_end(&f);
  }
}

// A curve whose ends are behind the camera, but whose middle is not. It is visible from a depth of
// a thousandth of the target's distance: y = -299.7 at the roots of 1620 t^2 - 1600 t + 300.3.
static void a_part_that_comes_into_view_is_drawn(void **state) {
  (void)state;
  const CagVec3 p[] = {{-10, -600, 0}, {0, 200, 10}, {10, -620, 20}};
  Fixture f;
  CagCurve *c, *hidden;
  OK(cag_curve_bezier(p, NULL, 3, 3, &c, &err));
  OK(cag_curve_line(cag_vec3(0, -700, 0), cag_vec3(0, -301, 5), 3, &hidden, &err));
  fixture_begin(&f);
  fixture_curve(&f, "c", c);
  fixture_curve(&f, "hidden", hidden);
  char *text = export_text(&f);
  assert_int_equal(read_path(text, "hidden"), 0);
  const size_t n = read_path(text, "c");
  const double half = sqrt(1600.0 * 1600 - 4 * 1620 * 300.3) / 3240, step = pow(2, -17);
  for (int end = 0; end < 2; end++) {
    const double root = 1600.0 / 3240 + (end ? half : -half), sign = end ? -1 : 1;
    CagVec3 q[101];
    for (int i = 0; i <= 100; i++)
      seen(&f.camera, curve_at(c, root + sign * step * i / 100), &q[i]);
    const double off = distance_to(end ? segments[n - 1].to : segments[0].from, q, 101);
    if (off > 1e-3) fail_msg("end %d is %g off", end, off);
  }
  for (size_t i = 0; i < n; i++) assert_true(segments[i].starts == (i == 0));
  free(text);
  fixture_end(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(polynomials_are_exact),
      cmocka_unit_test(arcs_are_exact),
      cmocka_unit_test(an_upright_line_is_drawn),
      cmocka_unit_test(labels_have_a_size_by_what_is_drawn),
      cmocka_unit_test(cameras_see_curves_as_they_are),
      cmocka_unit_test(cameras_see_labels_as_they_are),
      cmocka_unit_test(what_is_behind_the_camera_is_left_out),
      cmocka_unit_test(a_part_that_comes_into_view_is_drawn),
  };
  fixture_folder(folder);
  int failed = cmocka_run_group_tests_name("svg_path", tests, NULL, NULL);
  fixture_folder_remove(folder);
  return failed;
}
