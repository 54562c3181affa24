// Annotations of shapes: labels, marks, and normals.

#include "interp/builtin/shapes.h"

#include "interp/scene/scene.h"

// --- Labels ---

bool cag_figures_label(CagCall *call, const struct cag_figures_label *a, CagValue *result) {
  if (a->mark == CAG_LABEL_ARROW && !cag_given(call, 5))
    return cag_fail_call(call, 3, CAG_ERR_value,
                         "expects the direction of an arrow: `along` is missing");
  const CagLabelText label = {.text = CAG_AS_TEXT(call->values[1]),
                              .at = a->P.at,
                              .along = a->along.at,
                              .place = a->place,
                              .mark = a->mark,
                              .size = a->size};
  *result = cag_label_value(call->vm, &label);
  return true;
}

// --- Normals ---

// The default length of normals, as a fraction of the surface's size.
#define NORMAL_PART 0.08

bool cag_figures_surface_normals(CagCall *call, const struct cag_figures_surface_normals *a,
                                 CagValue *result) {
  const CagSurface *s = a->S;
  CagBounds box;
  if (cag_given(call, 2) && a->scale == 0)
    return cag_fail_call(call, 2, CAG_ERR_value, "expects a length that is not 0");
  if (!cag_geometry_ok(call, cag_surface_bounds(s, &box, call->err))) return false;
  const double length =
      cag_given(call, 2) ? a->scale : NORMAL_PART * cag_norm(cag_sub(box.max, box.min));
  CagBuilder *list = cag_builder_new(call->vm);
  for (long i = 0; i < a->n * a->n; i++) {
    // In a closed direction, the last line would coincide with the first.
    double u = (double)(i / a->n) / (double)(s->closed_u ? a->n : a->n - 1);
    double v = (double)(i % a->n) / (double)(s->closed_v ? a->n : a->n - 1);
    CagVec3 p, normal;
    CagCurve *c = NULL;
    CagValue line;
    u = u == 1 ? s->u1 : s->u0 + u * (s->u1 - s->u0);
    v = v == 1 ? s->v1 : s->v0 + v * (s->v1 - s->v0);
    CagStatus status = cag_surface_eval(s, u, v, 0, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, &p, call->err);
    if (!cag_geometry_ok(call, status)) return false;
    // Skips points without a normal, such as the tip of a cone.
    if (cag_surface_normal(s, u, v, &normal, call->err)) continue;
    status = cag_curve_line(p, cag_madd(p, length, normal), 3, &c, call->err);
    if (!cag_curve_result(call, status, &c, &line) || !cag_builder_add(call->vm, list, line))
      return false;
  }
  *result = cag_group_value(call->vm, cag_builder_finish(call->vm, list));
  return true;
}
