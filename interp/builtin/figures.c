// Shapes that say something about other shapes: labels and marks, combs of curvature, normals.
//
// A label is a mesh without faces: its first vertex is the place, a second one, where there is one,
// the end of its direction. So every transform moves it as it moves shapes. What it says stands
// in its style.

#include "interp/builtin/figures.h"

#include <stdlib.h>

#include "interp/scene/scene.h"

// --- Labels ---

bool cag_figures_label(CagCall *call, CagValue *result) {
  static const char *const fields[] = {"label", "place", "mark", "size"};
  CagVec3 at, along;
  const char *text;
  double size = 0;
  int place, mark;
  if (!cag_arg_vec(call, 0, &at, NULL) || !cag_arg_text(call, 1, &text) ||
      !cag_arg_choice(call, 2, cag_label_places, &place) ||
      !cag_arg_choice(call, 3, cag_label_marks, &mark))
    return false;
  bool sized = cag_given(call, 4) && call->values[4].type != CAG_NONE;
  bool directed = cag_given(call, 5) && call->values[5].type != CAG_NONE;
  if (sized && !cag_arg_positive(call, 4, &size)) return false;
  if (directed && !cag_arg_direction(call, 5, at, &along, NULL)) return false;
  if (mark == CAG_LABEL_ARROW && !directed)
    return cag_fail_call(call, 3, CAG_ERR_value,
                         "expects the direction of an arrow: `along` is missing");
  CagMesh *anchor;
  CagError err;
  if (!cag_geometry_ok(call, cag_mesh_new(directed ? 2 : 1, 0, false, false, false, &anchor, &err),
                       &err))
    return false;
  anchor->positions[0] = at;
  if (directed) anchor->positions[1] = cag_add(at, along);
  *result = cag_mesh_value(call->vm, anchor);
  CagValue values[] = {call->values[1], cag_number(place), cag_number(mark), cag_number(size)};
  CAG_AS_SHAPE(*result)->style = CAG_AS_RECORD(cag_record_new(call->vm, fields, values, 4));
  return true;
}

// --- Combs ---

#define TEETH_MAX 100000
// The longest tooth of a comb that says no scale, as a part of the curve's size.
#define TOOTH_PART 0.25

typedef struct Tooth {
  CagVec3 foot, bend; // bend: the vector of curvature
} Tooth;

typedef struct Comb {
  Tooth *teeth;
  size_t *starts; // of the smooth pieces, and the end
  size_t count, pieces;
} Comb;

// The second derivative by arc length.
static CagVec3 bend_of(const CagVec3 e[3]) {
  double speed2 = cag_dot(e[1], e[1]);
  if (!(speed2 > 0)) return cag_vec3(0, 0, 0);
  CagVec3 across = cag_sub(cag_scaled(e[2], speed2), cag_scaled(e[1], cag_dot(e[1], e[2])));
  return cag_scaled(across, 1 / (speed2 * speed2));
}

// The curve's smooth pieces share the teeth by their part of the domain; both ends of a piece have
// one, so that a jump of the curvature shows.
static CagStatus fill_comb(const CagCurve *c, size_t n, Comb *out, CagError *err) {
  size_t breaks = c->kind->breaks ? c->kind->breaks(c, NULL, 0) : 0;
  double *cuts = malloc((breaks + 2) * sizeof *cuts);
  out->starts = malloc((breaks + 2) * sizeof *out->starts);
  out->teeth = malloc((n + 3 * (breaks + 1)) * sizeof *out->teeth);
  CagStatus status = CAG_OK;
  if (!cuts || !out->starts || !out->teeth) status = cag_fail_memory(err);
  if (!status && breaks > 0) c->kind->breaks(c, cuts + 1, breaks);
  if (!status) {
    cuts[0] = c->start;
    cuts[breaks + 1] = c->end;
  }
  for (size_t i = 0; !status && i <= breaks; i++) {
    double a = cuts[i], b = cuts[i + 1];
    size_t steps = 1 + (size_t)((double)n * (b - a) / (c->end - c->start));
    out->starts[i] = out->count;
    for (size_t k = 0; !status && k <= steps; k++) {
      double t = k == steps ? b : a + (b - a) * (double)k / (double)steps;
      CagVec3 e[3];
      status = cag_curve_eval(c, t, 2, k == steps ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, e, err);
      if (!status) out->teeth[out->count++] = (Tooth){e[0], bend_of(e)};
    }
  }
  if (!status) out->starts[breaks + 1] = out->count;
  out->pieces = breaks + 1;
  free(cuts);
  return status;
}

static double largest_bend(const Comb *comb) {
  double most = 0;
  for (size_t i = 0; i < comb->count; i++) most = fmax(most, cag_norm(comb->teeth[i].bend));
  return most;
}

static bool add_curve(CagCall *call, CagBuilder *list, CagStatus status, CagCurve *c,
                      const CagError *err) {
  return cag_geometry_ok(call, status, err) &&
         cag_builder_add(call->vm, list, cag_curve_value(call->vm, c));
}

static bool add_teeth(CagCall *call, CagBuilder *list, const Comb *comb, double scale,
                      int dimension) {
  CagError err;
  CagCurve *c = NULL;
  CagVec3 *tips = malloc(comb->count * sizeof *tips);
  if (!tips) return cag_fail_call(call, -1, CAG_ERR_limit_memory, "needs more memory");
  bool ok = true;
  for (size_t i = 0; ok && i < comb->count; i++) {
    const Tooth *tooth = &comb->teeth[i];
    tips[i] = cag_madd(tooth->foot, -scale, tooth->bend);
    if (cag_norm(cag_sub(tips[i], tooth->foot)) == 0) continue;
    CagStatus status = cag_curve_line(tooth->foot, tips[i], dimension, &c, &err);
    ok = add_curve(call, list, status, c, &err);
  }
  for (size_t i = 0; ok && i < comb->pieces; i++) {
    size_t from = comb->starts[i], n = comb->starts[i + 1] - from;
    CagStatus status = cag_curve_polyline(tips + from, n, false, dimension, &c, &err);
    ok = add_curve(call, list, status, c, &err);
  }
  free(tips);
  return ok;
}

// Reads `scale`: 0 where none is said.
static bool read_scale(CagCall *call, double *scale) {
  *scale = 0;
  if (!cag_given(call, 1) || call->values[1].type == CAG_NONE) return true;
  if (!cag_arg_finite(call, 1, scale)) return false;
  if (*scale == 0) return cag_fail_call(call, 1, CAG_ERR_value, "expects a scale that is not 0");
  return true;
}

static double size_of(const CagBounds *b) { return cag_norm(cag_sub(b->max, b->min)); }

static bool give_group(CagCall *call, CagBuilder *list, CagValue *result) {
  *result = cag_group_value(call->vm, cag_builder_finish(call->vm, list));
  return true;
}

bool cag_figures_curve_comb(CagCall *call, CagValue *result) {
  CagCurve *c;
  double scale;
  long n;
  CagBounds box;
  CagError err;
  Comb comb = {0};
  if (!cag_arg_curve(call, 0, &c) || !read_scale(call, &scale) ||
      !cag_arg_integer_or(call, 2, 100, 1, TEETH_MAX, &n) ||
      !cag_geometry_ok(call, cag_curve_bounds(c, &box, &err), &err))
    return false;
  CagBuilder *list = cag_builder_new(call->vm);
  bool ok = cag_geometry_ok(call, fill_comb(c, (size_t)n, &comb, &err), &err);
  if (ok && scale == 0) {
    double most = largest_bend(&comb);
    scale = most > 0 ? TOOTH_PART * size_of(&box) / most : 0;
  }
  ok = ok && add_teeth(call, list, &comb, scale, c->dimension);
  free(comb.teeth);
  free(comb.starts);
  return ok && give_group(call, list, result);
}

// The length of normals that say none, as a part of the surface's size.
#define NORMAL_PART 0.08

bool cag_figures_surface_normals(CagCall *call, CagValue *result) {
  CagSurface *s;
  double length;
  long n;
  CagBounds box;
  CagError err;
  if (!cag_arg_surface(call, 0, &s) || !read_scale(call, &length) ||
      !cag_arg_integer_or(call, 2, 12, 2, 1000, &n) ||
      !cag_geometry_ok(call, cag_surface_bounds(s, &box, &err), &err))
    return false;
  if (length == 0) length = NORMAL_PART * size_of(&box);
  CagBuilder *list = cag_builder_new(call->vm);
  for (long i = 0; i < n * n; i++) {
    // A closed direction's last line is its first.
    double u = (double)(i / n) / (double)(s->closed_u ? n : n - 1);
    double v = (double)(i % n) / (double)(s->closed_v ? n : n - 1);
    CagVec3 p, normal;
    CagCurve *c = NULL;
    u = u == 1 ? s->u1 : s->u0 + u * (s->u1 - s->u0);
    v = v == 1 ? s->v1 : s->v0 + v * (s->v1 - s->v0);
    CagStatus status = cag_surface_eval(s, u, v, 0, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, &p, &err);
    if (!cag_geometry_ok(call, status, &err)) return false;
    // Where there is no normal (the tip of a cone) no line stands.
    if (cag_surface_normal(s, u, v, &normal, &err) != CAG_OK) continue;
    status = cag_curve_line(p, cag_madd(p, length, normal), 3, &c, &err);
    if (!add_curve(call, list, status, c, &err)) return false;
  }
  return give_group(call, list, result);
}

// --- The table ---

static const char figures[] = "Figures";

const CagBuiltin cag_builtins_figures[] = {
    {"label(P, text, place = \"right\", mark = \"none\", size = none, along = none)",
     cag_figures_label, "mesh",
     "A text at P in an .svg picture; other pictures and formats leave it out, but .json has it. "
     "It "
     "moves with transforms and keeps its size, `size` mm (none: by the size of the picture), in "
     "the colour said about it. `place`, where the text stands: right, left, above, below, center, "
     "above_right, above_left, below_right, below_left. `mark`, what is drawn at P: none, dot, "
     "circle (white inside), cross, arrow (the head of one, its tip at P, along V). With `along` "
     "the text runs along that direction. A name is set in italics with what follows a _ lowered: "
     "a letter that no letter follows, as in P_0 and C(t).",
     "show circle(10), label([10, 0], \"P_0\", mark: \"dot\")\n"
     "print bounds(translate([1, 2, 0]) * label([3, 4], \"Q\")).min // expect: [4, 6, 0]",
     CAG_TAKES(LIST), figures},
    {"hedgehog(C, scale = none, count = 100)", cag_figures_curve_comb, "group",
     "The comb of a curve's curvature: lines from about `count` points away from the center of "
     "curvature, as long as the curvature times the scale (in mm^2; none: by the size of C; "
     "negative: towards the center), and the line through their ends. Where the curvature jumps "
     "the "
     "comb has a step.",
     "print near(bounds(hedgehog(circle(10), scale: 20)).max.x, 12) // expect: true",
     CAG_TAKES(CURVE), figures},
    {"hedgehog(S, scale = none, count = 12)", cag_figures_surface_normals, "group",
     "The normals of a surface as lines of the length `scale` mm (none: by the size of S) at count "
     "by count points.",
     "s = bilinear([0, 0], [0, 2], [4, 0], [4, 2])\n"
     "print len(hedgehog(s, 1, 3).items), bounds(hedgehog(s, scale: -3)).size.z // expect: 9 3",
     CAG_TAKES(SURFACE), figures},
    {0}};
