// Parts, refinement, and joins of surfaces; offsets and plates.

#include "geom/surface/reshape.h"
#include "geom/surface/trimmed.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"

// Reads either `u:` or `v:`, the parameters `at` and at + 1. *direction tells which one; *t is its
// value.
static bool read_direction(CagCall *call, const CagSurface *s, int at, int *direction, double *t) {
  bool u = cag_given(call, at), v = cag_given(call, at + 1);
  *direction = u ? 0 : 1;
  if (u == v)
    return cag_fail_call(call, u ? at + 1 : -1, CAG_ERR_value, "expects either `u:` or `v:`");
  return u ? cag_arg_parameter(call, at, s->angular_u, s->u0, s->u1, false, t)
           : cag_arg_parameter(call, at + 1, s->angular_v, s->v0, s->v1, false, t);
}

// Reads the region bounded by closed plane curves. It is given as a region, curve, or list of
// points, or as a list of curves. *out has one reference.
static bool read_loops(CagCall *call, int argument, CagRegion **out) {
  CagValue v = call->values[argument];
  CagTransform place;
  bool curves = v.type == CAG_LIST && CAG_AS_LIST(v)->length > 0 &&
                cag_list_get(call->vm, CAG_AS_LIST(v), 0).type == CAG_CURVE;
  if (!curves) {
    CagRegion *region;
    if (!cag_arg_region(call, argument, &region, &place)) return false;
    CagStatus status = cag_region_transform(region, &place, out, call->err);
    cag_region_release(region);
    return cag_geometry_ok(call, status);
  }
  const CagList *list = CAG_AS_LIST(v);
  CagCurve **loops = cag_hold_array(call, list->length, sizeof(CagCurve *));
  for (size_t i = 0; i < list->length; i++) {
    CagValue c = cag_list_get(call->vm, list, i);
    if (c.type != CAG_CURVE) return cag_fail_element(call, argument, i, c, "closed plane curves");
    loops[i] = CAG_AS_SHAPE(c)->as.curve;
  }
  return cag_geometry_ok(call, cag_region_from_loops(loops, list->length, out, call->err));
}

bool cag_surfaces_trim(CagCall *call, const struct cag_surfaces_trim *a, CagValue *result) {
  const CagSurface *s = a->S;
  CagSurface *out = NULL;
  if (cag_given(call, 1)) {
    CagRegion *region;
    if (cag_given(call, 2) || cag_given(call, 3))
      return cag_fail_call(call, 1, CAG_ERR_value, "takes `curves` or ranges u and v, not both");
    if (!read_loops(call, 1, &region)) return false;
    CagStatus status = cag_surface_trimmed(s, region, &out, call->err);
    cag_region_release(region);
    return cag_changed_surface_result(call, status, &out, result);
  }
  double u0 = s->u0, u1 = s->u1, v0 = s->v0, v1 = s->v1;
  if ((cag_given(call, 2) && !cag_arg_parameter_range(call, 2, s->angular_u, &u0, &u1)) ||
      (cag_given(call, 3) && !cag_arg_parameter_range(call, 3, s->angular_v, &v0, &v1)))
    return false;
  return cag_changed_surface_result(call, cag_surface_part(s, u0, u1, v0, v1, &out, call->err),
                                    &out, result);
}

bool cag_surfaces_split(CagCall *call, const struct cag_surfaces_split *a, CagValue *result) {
  const CagSurface *s = a->S;
  int direction;
  double t;
  if (!read_direction(call, s, 1, &direction, &t)) return false;
  const double low = direction == 0 ? s->u0 : s->v0, high = direction == 0 ? s->u1 : s->v1;
  if (!(t > low && t < high)) {
    const double shown = (direction == 0 ? s->angular_u : s->angular_v) ? 180 / M_PI : 1;
    const char *deg = shown == 1 ? "" : "deg";
    char from[32], to[32], at[32];
    return cag_fail_call(
        call, -1, CAG_ERR_parameter_range,
        "expects a value inside the domain, between %s%s and %s%s, but `%c` is %s%s",
        cag_number_text(shown * low, from), deg, cag_number_text(shown * high, to), deg,
        "uv"[direction], cag_number_text(shown * t, at), deg);
  }
  CagBuilder *parts = cag_builder_new(call->vm);
  for (int k = 0; k < 2; k++) {
    CagSurface *part = NULL;
    const double lo = k == 0 ? low : t, hi = k == 0 ? t : high;
    CagStatus status = direction == 0 ? cag_surface_part(s, lo, hi, s->v0, s->v1, &part, call->err)
                                      : cag_surface_part(s, s->u0, s->u1, lo, hi, &part, call->err);
    CagValue v;
    if (!cag_changed_surface_result(call, status, &part, &v) ||
        !cag_builder_add(call->vm, parts, v))
      return false;
  }
  *result = cag_builder_finish(call->vm, parts);
  return true;
}

bool cag_surfaces_insert_knot(CagCall *call, const struct cag_surfaces_insert_knot *a,
                              CagValue *result) {
  CagSurface *out = NULL;
  int direction;
  double t;
  if (!read_direction(call, a->S, 1, &direction, &t)) return false;
  CagStatus status = cag_surface_insert_knot(a->S, direction, t, (int)a->times, &out, call->err);
  return cag_changed_surface_result(call, status, &out, result);
}

// A knot is redundant if removing it moves the surface by less than this fraction of its size.
#define WITHOUT_EFFECT 1e-9

bool cag_surfaces_remove_knot(CagCall *call, const struct cag_surfaces_remove_knot *a,
                              CagValue *result) {
  CagSurface *out = NULL;
  CagBounds box;
  int direction;
  double t, tolerance = a->tolerance;
  if (!read_direction(call, a->S, 1, &direction, &t)) return false;
  if (!cag_given(call, 3)) {
    if (!cag_geometry_ok(call, cag_surface_bounds(a->S, &box, call->err))) return false;
    tolerance = WITHOUT_EFFECT * cag_norm(cag_sub(box.max, box.min));
  }
  CagStatus status =
      cag_surface_remove_knot(a->S, direction, t, (int)a->times, tolerance, &out, NULL, call->err);
  return cag_changed_surface_result(call, status, &out, result);
}

// Lowers the degree in a direction several times. The changes add up to at most the tolerance,
// which is reduced by them.
static CagStatus reduce_times(CagSurface **s, int direction, long times, double *tolerance,
                              CagError *err) {
  CagStatus status = CAG_OK;
  for (long i = 0; !status && i < times; i++) {
    CagSurface *next;
    double moved;
    status = cag_surface_reduce_degree(*s, direction, *tolerance, &next, &moved, err);
    if (status) break;
    *tolerance -= moved;
    cag_surface_release(*s);
    *s = next;
  }
  return status;
}

bool cag_surfaces_reduce_degree(CagCall *call, const struct cag_surfaces_reduce_degree *a,
                                CagValue *result) {
  CagSurface *out = cag_surface_retain(a->S);
  double tolerance = a->tolerance;
  const bool both = !cag_given(call, 2) && !cag_given(call, 3);
  CagStatus status = reduce_times(&out, 0, both ? 1 : a->u, &tolerance, call->err);
  if (!status) status = reduce_times(&out, 1, both ? 1 : a->v, &tolerance, call->err);
  if (status) cag_surface_release(out);
  return cag_changed_surface_result(call, status, &out, result);
}

bool cag_surfaces_reverse(CagCall *call, const struct cag_surfaces_reverse *a, CagValue *result) {
  CagSurface *out = NULL;
  return cag_changed_surface_result(call, cag_surface_reverse(a->S, a->direction, &out, call->err),
                                    &out, result);
}

// Reads the refinement in one direction: whether there is any, and the knots to insert (NULL:
// midpoints).
static bool read_refinement(CagCall *call, int argument, CagRefinement *out) {
  *out = (CagRefinement){CAG_REFINE_MIDPOINTS, NULL, 0};
  CagValue v = call->values[argument];
  if (v.type == CAG_UNSET) return true;
  if (v.type == CAG_BOOL) {
    if (!v.as.boolean) out->how = CAG_REFINE_NOT;
    return true;
  }
  if (v.type == CAG_TEXT) {
    static const char *const names[] = {"midpoints", NULL};
    int midpoints;
    return cag_arg_choice(call, argument, names, &midpoints);
  }
  out->how = CAG_REFINE_KNOTS;
  return cag_arg_numbers(call, argument, &out->knots, &out->count);
}

bool cag_surfaces_refine(CagCall *call, const struct cag_surfaces_refine *a, CagValue *result) {
  CagSurface *out = NULL;
  CagRefinement r[2];
  return read_refinement(call, 1, &r[0]) && read_refinement(call, 2, &r[1]) &&
         cag_changed_surface_result(call, cag_surface_refine_by(a->S, r, &out, call->err), &out,
                                    result);
}

bool cag_surfaces_elevate(CagCall *call, const struct cag_surfaces_elevate *a, CagValue *result) {
  CagSurface *out = NULL;
  return cag_changed_surface_result(
      call, cag_surface_elevate(a->S, (int)a->u, (int)a->v, &out, call->err), &out, result);
}

bool cag_surfaces_to_bezier(CagCall *call, const struct cag_surfaces_to_bezier *a,
                            CagValue *result) {
  size_t nu, nv;
  CagSurfaceArray *pieces = cag_hold_surfaces(call);
  CagStatus status = cag_surface_to_bezier(a->S, &pieces->items, &nu, &nv, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  pieces->count = nu * nv;
  CagBuilder *rows = cag_builder_new(call->vm);
  for (size_t i = 0; i < nu; i++) {
    CagBuilder *row = cag_builder_new(call->vm);
    for (size_t j = 0; j < nv; j++) {
      CagValue v = cag_surface_value(call->vm, cag_surface_retain(pieces->items[i * nv + j]));
      cag_shape_say_alike(v, call->values[0]);
      if (!cag_builder_add(call->vm, row, v)) return false;
    }
    if (!cag_builder_add(call->vm, rows, cag_builder_finish(call->vm, row))) return false;
  }
  *result = cag_builder_finish(call->vm, rows);
  return true;
}

bool cag_surfaces_transpose_uv(CagCall *call, const struct cag_surfaces_transpose_uv *a,
                               CagValue *result) {
  CagSurface *out = NULL;
  return cag_changed_surface_result(call, cag_surface_transpose(a->S, &out, call->err), &out,
                                    result);
}

// --- Two surfaces ---

bool cag_surfaces_join_surfaces(CagCall *call, const struct cag_surfaces_join_surfaces *a,
                                CagValue *result) {
  CagSurface *out = NULL;
  return cag_changed_surface_result(
      call, cag_surface_join(a->A, a->B, a->tolerance, &out, call->err), &out, result);
}

bool cag_surfaces_continuity(CagCall *call, const struct cag_surfaces_continuity *a,
                             CagValue *result) {
  static const char *const names[] = {"class", "gap",      "angle", "first_jump", "curvature_jump",
                                      "edges", "reversed", "C0",    "G1",         "C1",
                                      "G2"};
  static const char *const sides[] = {"u0", "u1", "v0", "v1"};
  CagSeam seam;
  int edges_given[2];
  bool given;
  if (!cag_arg_edges(call, cag_given(call, 4) ? 4 : 2, edges_given, &given)) return false;
  CagStatus status =
      cag_surface_seam_on(a->A, a->B, given ? edges_given : NULL, a->tolerance, &seam, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  const char *class = !seam.c0 ? "none" : seam.g2 ? "G2" : seam.c1 ? "C1" : seam.g1 ? "G1" : "C0";
  CagBuilder *edges = cag_builder_new(call->vm);
  for (int k = 0; k < 2; k++)
    if (!cag_builder_add(call->vm, edges, cag_text_c(call->vm, sides[seam.side[k]]))) return false;
  CagValue values[] = {cag_text_c(call->vm, class),
                       cag_number(seam.gap),
                       cag_angle(seam.angle / CAG_RADIANS_PER_DEGREE),
                       cag_number(seam.first),
                       cag_number(seam.curvature),
                       cag_builder_finish(call->vm, edges),
                       cag_bool(seam.reversed),
                       cag_bool(seam.c0),
                       cag_bool(seam.g1),
                       cag_bool(seam.c1),
                       cag_bool(seam.g2)};
  *result = cag_record_new(call->vm, names, values, 11);
  return true;
}

// --- Offsets ---

bool cag_surfaces_offset(CagCall *call, const struct cag_surfaces_offset *a, CagValue *result) {
  CagSurface *out = NULL;
  return cag_changed_surface_result(call, cag_surface_offset(a->S, a->d, &out, call->err), &out,
                                    result);
}

bool cag_surfaces_thicken(CagCall *call, const struct cag_surfaces_thicken *a, CagValue *result) {
  CagSolid *out = NULL;
  CagSurface *from = NULL;
  if (a->thickness == 0) return cag_fail_value(call, 1, "a thickness that is not 0");
  CagStatus status = CAG_OK;
  if (a->centered) status = cag_surface_offset(a->S, -a->thickness / 2, &from, call->err);
  else from = cag_surface_retain(a->S);
  if (!status) status = cag_solid_thicken(from, a->thickness, &out, call->err);
  cag_surface_release(from);
  return cag_changed_solid_result(call, status, &out, result);
}
