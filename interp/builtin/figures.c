// Shapes that describe other shapes: labels, marks, and normals.

#include "interp/builtin/shapes.h"

#include "interp/scene/scene.h"

// --- Labels ---

bool cag_figures_label(CagCall *call, CagValue *result) {
  CagLabelText label = {.text = NULL};
  const char *text;
  if (!cag_arg_vec(call, 0, &label.at, NULL) || !cag_arg_text(call, 1, &text) ||
      !cag_arg_choice(call, 2, cag_label_places, &label.place) ||
      !cag_arg_choice(call, 3, cag_label_marks, &label.mark))
    return false;
  label.text = CAG_AS_TEXT(call->values[1]);
  if (cag_given(call, 4) && !cag_arg_positive(call, 4, &label.size)) return false;
  if (cag_given(call, 5) && !cag_arg_direction(call, 5, label.at, &label.along, NULL)) return false;
  if (label.mark == CAG_LABEL_ARROW && !cag_given(call, 5))
    return cag_fail_call(call, 3, CAG_ERR_value,
                         "expects the direction of an arrow: `along` is missing");
  *result = cag_label_value(call->vm, &label);
  return true;
}

// --- Normals ---

static bool add_curve(CagCall *call, CagBuilder *list, CagStatus status, CagCurve *c) {
  return cag_geometry_ok(call, status) &&
         cag_builder_add(call->vm, list, cag_curve_value(call->vm, c));
}

// Reads the length: 0 where none is said.
static bool read_length(CagCall *call, int argument, double *out) {
  *out = 0;
  if (!cag_given(call, argument)) return true;
  if (!cag_arg_finite(call, argument, out)) return false;
  if (*out == 0)
    return cag_fail_call(call, argument, CAG_ERR_value, "expects a length that is not 0");
  return true;
}

static double size_of(const CagBounds *b) { return cag_norm(cag_sub(b->max, b->min)); }

static bool give_group(CagCall *call, CagBuilder *list, CagValue *result) {
  *result = cag_group_value(call->vm, cag_builder_finish(call->vm, list));
  return true;
}

// The length of normals that say none, as a part of the surface's size.
#define NORMAL_PART 0.08

bool cag_figures_surface_normals(CagCall *call, CagValue *result) {
  CagSurface *s;
  double length;
  long n;
  CagBounds box;
  if (!cag_arg_surface(call, 0, &s) || !cag_arg_integer_or(call, 1, 12, 2, 1000, &n) ||
      !read_length(call, 2, &length) ||
      !cag_geometry_ok(call, cag_surface_bounds(s, &box, call->err)))
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
    CagStatus status = cag_surface_eval(s, u, v, 0, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, &p, call->err);
    if (!cag_geometry_ok(call, status)) return false;
    // Where there is no normal (the tip of a cone) no line stands.
    if (cag_surface_normal(s, u, v, &normal, call->err) != CAG_OK) continue;
    status = cag_curve_line(p, cag_madd(p, length, normal), 3, &c, call->err);
    if (!add_curve(call, list, status, c)) return false;
  }
  return give_group(call, list, result);
}
