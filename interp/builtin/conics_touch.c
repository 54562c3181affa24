// Tangent circles and lines, fillets, and rounded corners.

#include <string.h>

#include "base/memory.h"
#include "geom/curve/circles.h"
#include "geom/curve/family.h"
#include "interp/builtin/conics.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/support.h"

#define FULL_TURN 6.283185307179586 // 2 pi

// Returns the only branch of a conic, or the curve itself.
static const CagCurve *branch_of(const CagCurve *c) {
  const CagCurve *branch = cag_curve_conic_branch(c);
  return branch ? branch : c;
}

// Reads a line, which is extended to both sides, or the full circle of a circle or arc.
static bool read_touched(CagCall *call, int argument, CagTouched *out) {
  CagCurve *c;
  const CagVec3 *p;
  CagVec3 x, y;
  size_t n;
  bool closed;
  double rate;
  const double round = 1e-12;
  if (!cag_arg_curve(call, argument, &c)) return false;
  if (c->dimension == 2 && cag_curve_vertices(c, &p, &n, &closed) && n == 2) {
    *out = (CagTouched){p[0], cag_sub(p[1], p[0]), 0};
    return true;
  }
  if (c->dimension == 2 && cag_curve_arc_axes(branch_of(c), &out->p, &x, &y, &rate)) {
    out->radius = cag_norm(x);
    out->d = cag_vec3(0, 0, 0);
    if (fabs(cag_norm(y) - out->radius) <= round * out->radius &&
        fabs(cag_dot(x, y)) <= round * out->radius * out->radius)
      return true;
  }
  return cag_fail_call(call, argument, CAG_ERR_value,
                       "expects lines, circles, or arcs of circles in the plane");
}

// Reads a point of the plane, or what read_touched reads.
static bool read_touched_or_point(CagCall *call, int argument, CagTouched *out) {
  CagPoint p;
  if (call->values[argument].type == CAG_CURVE) {
    if (!read_touched(call, argument, out)) return false;
    return out->radius > 0 || cag_norm(out->d) > 0 ||
           cag_fail_value(call, argument, "a line whose length is not 0");
  }
  if (!cag_arg_vec(call, argument, &p.at, &p.dimension)) return false;
  if (p.dimension != 2) return cag_fail_value(call, argument, "a point [x, y] of the plane");
  *out = (CagTouched){.p = p.at};
  return true;
}

static bool circle_value(CagCall *call, CagVec3 center, double radius, CagValue *result) {
  CagCurve *c = NULL;
  CagTransform frame = cag_translate(center);
  frame.planar = true;
  CagStatus status = cag_curve_arc(radius, radius, 0, FULL_TURN, &frame, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

// Reads "inside" or "outside", or a list of two of these.
static bool read_contact(CagCall *call, int argument, bool inside[2]) {
  static const char *const words[] = {"outside", "inside", NULL};
  int word;
  CagValue v = call->values[argument];
  if (v.type == CAG_LIST && CAG_AS_LIST(v)->length == 2 && CAG_AS_LIST(v)->dim == 0) {
    for (int i = 0; i < 2; i++) {
      CagValue item = CAG_AS_LIST(v)->as.items[i];
      const char *text = item.type == CAG_TEXT ? CAG_AS_TEXT(item)->bytes : "";
      inside[i] = text[0] == 'i';
      if (strcmp(text, words[inside[i]]) != 0)
        return cag_fail_value(call, argument,
                              "\"outside\" or \"inside\", or a list of two of these");
    }
    return true;
  }
  if (!cag_arg_choice(call, argument, words, &word)) return false;
  inside[0] = inside[1] = word == 1;
  return true;
}

bool cag_conics_circle_tangent(CagCall *call, const struct cag_conics_circle_tangent *a,
                               CagValue *result) {
  CagTouched p, q;
  CagTouchChoice choice = {.right = a->side, .near = a->nearness};
  CagVec3 center, touch[2];
  if (!read_touched(call, 0, &p) || !read_touched(call, 1, &q) ||
      !read_contact(call, 5, choice.inside) ||
      !cag_geometry_ok(call,
                       cag_tangent_circle(&p, &q, a->radius, choice, &center, touch, call->err)))
    return false;
  return circle_value(call, center, a->radius, result);
}

bool cag_conics_circles_tangent(CagCall *call, const struct cag_conics_circles_tangent *a,
                                CagValue *result) {
  CagTouched touched[3];
  CagTangentCircle found[CAG_TANGENT_CIRCLES];
  size_t n;
  (void)a;
  for (int i = 0; i < 3; i++)
    if (!read_touched_or_point(call, i, &touched[i])) return false;
  if (!cag_geometry_ok(call, cag_circles_tangent(touched, found, &n, call->err))) return false;
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++) {
    CagValue v;
    if (!circle_value(call, found[i].center, found[i].radius, &v) ||
        !cag_builder_add(call->vm, list, v))
      return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

bool cag_conics_fillet(CagCall *call, const struct cag_conics_fillet *a, CagValue *result) {
  CagCurve *arc = NULL;
  double t, t2;
  CagStatus status = cag_fillet(a->A, a->B, a->radius, &arc, &t, &t2, call->err);
  return cag_curve_result(call, status, &arc, result);
}

bool cag_conics_tangent_lines(CagCall *call, const struct cag_conics_tangent_lines *a,
                              CagValue *result) {
  const CagCurve *c = branch_of(a->C);
  CagTangentLine *lines = NULL;
  size_t n = 0;
  CagStatus status;
  if (a->P.type == CAG_CURVE) {
    status = cag_tangents_of_two(c, branch_of(CAG_AS_SHAPE(a->P)->as.curve), &lines, &n, call->err);
  } else {
    CagPoint p;
    if (!cag_arg_vec(call, 1, &p.at, &p.dimension)) return false;
    if (p.dimension != 2) return cag_fail_value(call, 1, "a point [x, y] of the plane, or a curve");
    status = cag_tangents_from_point(c, p.at, &lines, &n, call->err);
  }
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_for(call, cag_free, lines);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++) {
    CagCurve *line = NULL;
    CagValue v;
    status = cag_curve_line(lines[i].p, lines[i].q, 2, &line, call->err);
    if (!cag_curve_result(call, status, &line, &v) || !cag_builder_add(call->vm, list, v))
      return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

bool cag_conics_rounded(CagCall *call, const struct cag_conics_rounded *a, CagValue *result) {
  CagCurve *out = NULL;
  CagStatus status = cag_curve_rounded(a->C, a->radius, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

bool cag_conics_rounded_region(CagCall *call, const struct cag_conics_rounded_region *a,
                               CagValue *result) {
  const CagShape *shape = CAG_AS_SHAPE(call->values[0]);
  const CagRegion *region = shape->as.region;
  CagRegion *out = NULL;
  CagCurve **loops = cag_hold_array(call, region->count, sizeof *loops);
  for (size_t i = 0; i < region->count; i++) {
    CagStatus status = cag_curve_rounded(region->loops[i], a->radius, &loops[i], call->err);
    if (!cag_geometry_ok(call, status)) return false;
    cag_hold_curve(call, loops[i]);
  }
  if (cag_region_is_empty(region)) out = cag_region_retain(region);
  else if (!cag_geometry_ok(call, cag_region_from_loops(loops, region->count, &out, call->err)))
    return false;
  *result = cag_region_value(call->vm, out, shape->placement);
  cag_shape_say_alike(*result, call->values[0]);
  return true;
}
