// Properties of the equation of a quadric, plane sections, and contours of curvature.

#include "geom/meet/section.h"

#include <string.h>

#include "geom/meet/curvature_contour.h"
#include "geom/meet/curvature_line.h"
#include "geom/meet/shadow.h"
#include "geom/surface/motion.h"
#include "interp/builtin/solids.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"
#include "interp/builtin/targets.h"
#include "interp/vm/vm.h"

// --- Quadrics ---

static CagValue coefficients(CagVm *vm, CagQuadric q) {
  for (int i = 0; i < 10; i++) q.c[i] += 0.0; // replaces -0 by 0
  return cag_vector(vm, q.c, 10);
}

bool cag_sections_coefficients(CagCall *call, CagValue *result) {
  CagQuadric q;
  if (!cag_arg_quadric(call, &q)) return false;
  *result = coefficients(call->vm, q);
  return true;
}

bool cag_sections_rows(CagCall *call, CagValue *result) {
  CagQuadric q;
  double rows[4][4], *m;
  if (!cag_arg_quadric(call, &q)) return false;
  cag_quadric_rows(&q, rows);
  *result = cag_list_vectors(call->vm, 4, 4, &m);
  for (int i = 0; i < 16; i++) m[i] = rows[i / 4][i % 4] + 0.0;
  return true;
}

bool cag_sections_at(CagCall *call, const struct cag_sections_at *a, CagValue *result) {
  static const char *const names[] = {"value", "gradient"};
  CagQuadric q;
  if (!cag_arg_quadric(call, &q)) return false;
  CagValue values[] = {cag_number(cag_quadric_value(&q, a->P.at)),
                       cag_point(call->vm, cag_quadric_gradient(&q, a->P.at), 3)};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

bool cag_sections_center(CagCall *call, CagValue *result) {
  CagQuadric q;
  CagVec3 p;
  if (!cag_arg_quadric(call, &q) || !cag_geometry_ok(call, cag_quadric_center(&q, &p, call->err)))
    return false;
  *result = cag_point(call->vm, p, 3);
  return true;
}

bool cag_sections_tangent(CagCall *call, const struct cag_sections_tangent *a, CagValue *result) {
  CagQuadric q;
  CagPlane plane;
  if (!cag_arg_quadric(call, &q) ||
      !cag_geometry_ok(call, cag_quadric_tangent_plane(&q, a->P.at, &plane, call->err)))
    return false;
  *result = cag_plane_value(call->vm, &plane);
  return true;
}

bool cag_sections_rulings(CagCall *call, const struct cag_sections_rulings *a, CagValue *result) {
  static const char *const names[] = {"count", "directions"};
  CagQuadric q;
  CagRulings found;
  if (!cag_arg_quadric(call, &q) ||
      !cag_geometry_ok(call, cag_quadric_rulings(&q, a->P.at, &found, call->err)))
    return false;
  CagValue values[] = {found.all ? cag_text_c(call->vm, "all") : cag_number((double)found.count),
                       cag_points_value(call->vm, found.direction, found.count, 3)};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

bool cag_sections_moved(CagCall *call, const struct cag_sections_moved *a, CagValue *result) {
  CagQuadric q, moved;
  if (!cag_arg_quadric(call, &q) ||
      !cag_geometry_ok(call, cag_quadric_transform(&q, &a->T, &moved, call->err)))
    return false;
  *result = coefficients(call->vm, moved);
  return true;
}

// Reads a plane, or a transform whose x and y axes and origin are a frame of it.
static bool read_frame(CagCall *call, int argument, CagTransform *frame) {
  CagPlane plane;
  if (call->values[argument].type == CAG_TRANSFORM) return cag_arg_transform(call, argument, frame);
  if (!cag_arg_plane(call, argument, &plane)) return false;
  *frame = cag_plane_frame(&plane);
  return true;
}

bool cag_sections_section_conic(CagCall *call, CagValue *result) {
  static const char *const names[] = {"conic", "coefficients", "frame", "class"};
  CagQuadric q;
  CagTransform frame;
  CagConic conic;
  CagConicClass found;
  CagCurve *curve = NULL;
  if (!cag_arg_quadric(call, &q) || !read_frame(call, 1, &frame)) return false;
  cag_quadric_section(&q, &frame, &conic);
  if (!cag_geometry_ok(call, cag_conic_classify(&conic, &found, call->err))) return false;
  bool zero = true;
  for (int i = 0; i < 6; i++) {
    zero = zero && conic.c[i] == 0;
    conic.c[i] += 0.0;
  }
  // A plane that is part of the quadric has no equation.
  if (!zero && !cag_geometry_ok(call, cag_curve_conic(&conic, &curve, call->err))) return false;
  frame.planar = false;
  CagValue values[] = {curve ? cag_curve_value(call->vm, curve) : cag_none(),
                       cag_vector(call->vm, conic.c, 6), cag_transform_value(call->vm, &frame),
                       cag_text_c(call->vm, found.name)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

// --- Sections and outlines ---

// Returns the faces of a surface or solid; other shapes have none.
static size_t faces_of(CagValue v, CagSurface *const **faces) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  *faces = v.type == CAG_SOLID ? shape->as.solid->faces : (CagSurface *const *)&shape->as.surface;
  return v.type == CAG_SURFACE ? 1 : v.type == CAG_SOLID ? shape->as.solid->face_count : 0;
}

// Adds the curves of a section or outline of one shape to the list.
typedef bool (*CurvesOf)(CagCall *call, CagValue shape, const void *question, CagCurveList *list);

// Collects the curves of all shapes in the first argument.
static bool curves_result(CagCall *call, CurvesOf curves_of, const void *question,
                          CagValue *result) {
  CagList *shapes;
  if (!cag_list_shapes(call, call->values[0], &shapes)) return false;
  CagCurveList *list = cag_hold_curve_list(call);
  // Surfaces may call functions of the script, so the list of shapes is rooted.
  cag_root_push(call->vm, cag_object(CAG_LIST, shapes));
  bool ok = true;
  for (size_t i = 0; ok && i < shapes->length; i++)
    ok = curves_of(call, cag_list_get(call->vm, shapes, i), question, list);
  cag_root_pop(call->vm, 1);
  if (ok) *result = cag_curve_list_value(call->vm, list);
  return ok;
}

static bool section_of(CagCall *call, CagValue v, const void *question, CagCurveList *list) {
  const struct cag_sections_section *a = question;
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagSurface *flat = NULL;
  CagStatus status;
  if (v.type == CAG_SURFACE)
    status = cag_surface_section(shape->as.surface, &a->plane, a->tolerance, list, call->err);
  else if (v.type == CAG_SOLID)
    status = cag_solid_section(shape->as.solid, &a->plane, a->tolerance, list, call->err);
  else if (v.type == CAG_MESH)
    status = cag_mesh_section(shape->as.mesh, &a->plane, list, call->err);
  else if (v.type == CAG_REGION) {
    status = cag_surface_planar(shape->as.region, shape->placement, &flat, call->err);
    if (!status) status = cag_surface_section(flat, &a->plane, a->tolerance, list, call->err);
    cag_surface_release(flat);
  } else return cag_fail_type(call, 0, "surfaces, solids, meshes, or regions");
  return (status && cag_is_empty_shape(call->err)) || cag_geometry_ok(call, status);
}

bool cag_sections_section(CagCall *call, const struct cag_sections_section *a, CagValue *result) {
  return curves_result(call, section_of, a, result);
}

static bool contour_of(CagCall *call, CagValue v, const void *question, CagCurveList *list) {
  const struct cag_sections_contour *a = question;
  CagSurface *const *faces;
  const size_t n = faces_of(v, &faces);
  CagStatus status = CAG_OK;
  if (v.type != CAG_SURFACE && v.type != CAG_SOLID)
    return cag_fail_type(call, 0, "surfaces or solids");
  for (size_t i = 0; !status && i < n; i++)
    status = cag_surface_contour(faces[i], cag_unit(a->direction.at), a->from.at,
                                 cag_given(call, 2), a->tolerance, list, call->err);
  return cag_geometry_ok(call, status);
}

bool cag_sections_contour(CagCall *call, const struct cag_sections_contour *a, CagValue *result) {
  if (cag_given(call, 1) == cag_given(call, 2))
    return cag_fail_call(call, -1, CAG_ERR_value,
                         "needs either the direction of the view, or the eye point as `from`");
  return curves_result(call, contour_of, a, result);
}

// --- Silhouettes ---

// Adds the shadow of one shape to the list of regions, which the call holds.
static CagStatus solid_shadow(const CagVm *vm, const CagShape *shape, const CagTransform *frame,
                              CagRegion **out, CagError *err) {
  CagBounds box;
  CagStatus status = cag_solid_bounds(shape->as.solid, &box, err);
  if (status) return status;
  const double size = cag_norm(cag_sub(box.max, box.min));
  const CagTessellation how = cag_shape_tessellation(
      vm, shape->tolerance > 0 ? shape->tolerance : CAG_SHAPE_TOLERANCE * size);
  return cag_solid_shadow(shape->as.solid, frame, 0, &how, out, err);
}

static bool add_shadow(CagCall *call, CagValue v, const CagTransform *frame, CagRegion **out) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagSurface *flat = NULL;
  CagStatus status = CAG_OK;
  switch (v.type) {
  case CAG_SURFACE: status = cag_surface_shadow(shape->as.surface, frame, 0, out, call->err); break;
  case CAG_SOLID: status = solid_shadow(call->vm, shape, frame, out, call->err); break;
  case CAG_MESH: status = cag_mesh_shadow(shape->as.mesh, frame, out, call->err); break;
  case CAG_REGION:
    status = cag_surface_planar(shape->as.region, shape->placement, &flat, call->err);
    if (!status) status = cag_surface_shadow(flat, frame, 0, out, call->err);
    cag_surface_release(flat);
    break;
  default: return cag_fail_type(call, 0, "regions, surfaces, solids, or meshes");
  }
  if (status && cag_is_empty_shape(call->err)) status = cag_region_empty(out, call->err);
  return cag_geometry_ok(call, status);
}

bool cag_sections_silhouette(CagCall *call, const struct cag_sections_silhouette *a,
                             CagValue *result) {
  CagList *shapes;
  if (!cag_list_shapes(call, call->values[0], &shapes)) return false;
  const CagPlane plane = {.normal = cag_unit(a->direction.at)};
  CagTransform frame = cag_plane_frame(&plane);
  CagRegion **parts = cag_hold_region_array(call, shapes->length), *all = NULL;
  bool ok = true;
  cag_root_push(call->vm, cag_object(CAG_LIST, shapes));
  for (size_t i = 0; ok && i < shapes->length; i++)
    ok = add_shadow(call, cag_list_get(call->vm, shapes, i), &frame, &parts[i]);
  cag_root_pop(call->vm, 1);
  if (!ok) return false;
  const CagStatus status =
      shapes->length ? cag_region_combine(CAG_REGION_UNION, (const CagRegion *const *)parts,
                                          shapes->length, &all, call->err)
                     : cag_region_empty(&all, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  // Along Z, it is a region of the XY plane.
  const bool plain = plane.normal.x == 0 && plane.normal.y == 0 && plane.normal.z > 0;
  frame.planar = false;
  *result = cag_region_value(call->vm, all, plain ? NULL : &frame);
  return true;
}

bool cag_sections_curvature_line(CagCall *call, const struct cag_sections_curvature_line *a,
                                 CagValue *result) {
  CagSurface *s;
  CagCurve *line = NULL;
  double u, v;
  if (!cag_arg_side_uv(call, &s, &u, &v)) return false;
  return cag_curve_result(call, cag_surface_curvature_line(s, u, v, a->by == 0, &line, call->err),
                          &line, result);
}

// --- Contour lines of curvature ---

#define CONTOUR_LEVELS_MOST 1000

// Reads one number, or a list or range of numbers; *out is held.
static bool read_contour_levels(CagCall *call, int argument, double **out, size_t *n) {
  static const char what[] = "a finite number (1/mm, Gaussian 1/mm2), or a list of them";
  CagSequence levels = {.length = 1};
  bool single = call->values[argument].type == CAG_NUMBER;
  if (!single && call->values[argument].type != CAG_LIST &&
      call->values[argument].type != CAG_RANGE)
    return cag_fail_type(call, argument, what);
  if (!single && !cag_sequence_open(call, argument, false, &levels)) return false;
  *n = levels.length;
  if (*n == 0)
    return cag_fail_call(call, argument, CAG_ERR_value, "expects %s, found an empty one", what);
  if (*n > CONTOUR_LEVELS_MOST)
    return cag_fail_call(call, argument, CAG_ERR_value, "expects at most %d levels, found %zu",
                         CONTOUR_LEVELS_MOST, *n);
  *out = cag_hold_array(call, *n, sizeof **out);
  for (size_t i = 0; i < *n; i++) {
    CagValue v = single ? call->values[argument] : cag_sequence_element(call->vm, &levels, i);
    if (v.type != CAG_NUMBER || !isfinite(v.as.number))
      return single ? cag_fail_value(call, argument, what)
                    : cag_fail_element(call, argument, i, v, "finite numbers");
    (*out)[i] = v.as.number;
  }
  return true;
}

typedef struct ContourQuestion {
  CagCurvature of;
  double level, tolerance;
} ContourQuestion;

// Clears `everywhere` unless all of this shape has the given curvature.
static CagStatus curvature_contours_of(CagValue v, const ContourQuestion *q, CagCurveList *out,
                                       bool *everywhere, CagError *err) {
  CagSurface *const *faces;
  const size_t n = faces_of(v, &faces);
  if (n == 0)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_curvature, "", -1,
                    "%s has no surfaces with lines of constant curvature",
                    v.type == CAG_SOLID ? "a solid made by set operations or from meshes"
                                        : cag_type_article(v));
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++) {
    bool all = false;
    status = cag_surface_curvature_contour(faces[i], q->of, q->level, q->tolerance, out, &all, err);
    *everywhere = *everywhere && all;
  }
  return status;
}

// Creates the record of one level. `list` is empty before and after.
static bool contour_record(CagCall *call, const CagList *shapes, const ContourQuestion *q,
                           CagCurveList *list, CagValue *result) {
  static const char *const names[] = {"level", "curves", "everywhere"};
  bool everywhere = true;
  for (size_t i = 0; i < shapes->length; i++) {
    const CagValue shape = cag_list_get(call->vm, shapes, i);
    const CagStatus status = curvature_contours_of(shape, q, list, &everywhere, call->err);
    if (!cag_geometry_ok(call, status) || !cag_keep_going(call->vm)) return false;
  }
  CagValue values[] = {cag_number(q->level), cag_curve_list_value(call->vm, list),
                       cag_bool(everywhere)};
  cag_curve_list_free(list);
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

bool cag_sections_curvature_contours(CagCall *call, const struct cag_sections_curvature_contours *a,
                                     CagValue *result) {
  ContourQuestion q = {(CagCurvature)a->of, 0, a->tolerance};
  double *levels = NULL;
  size_t n = 0;
  CagList *shapes;
  if (!cag_list_shapes(call, call->values[0], &shapes)) return false;
  if (shapes->length == 0) return cag_fail_call(call, 0, CAG_ERR_value, "expects a surface");
  if (!read_contour_levels(call, 1, &levels, &n)) return false;
  CagCurveList *list = cag_hold_curve_list(call);
  // Surfaces may call functions of the script, so the shapes and records are rooted.
  cag_root_push(call->vm, cag_object(CAG_LIST, shapes));
  CagBuilder *out = cag_builder_new(call->vm);
  cag_root_push(call->vm, cag_builder_value(out));
  bool ok = true;
  for (size_t i = 0; ok && i < n; i++) {
    CagValue record = cag_none();
    q.level = levels[i] + 0.0; // replaces -0 by 0
    ok = contour_record(call, shapes, &q, list, &record) && cag_builder_add(call->vm, out, record);
  }
  if (ok) *result = cag_builder_finish(call->vm, out);
  cag_root_pop(call->vm, 2);
  return ok;
}

// --- Frames along a path ---

bool cag_sections_path_frame(CagCall *call, const struct cag_sections_path_frame *a,
                             CagValue *result) {
  CagPathMotion how = {.scale = {1, 1, NULL}};
  CagCurve *space = NULL;
  double t;
  if (!cag_arg_parameter(call, 1, a->C->angular, a->C->start, a->C->end, false, &t) ||
      !cag_arg_orient(call, 2, &how))
    return false;
  CagMotion *motion = NULL;
  CagTransform frame;
  CagStatus status = cag_curve_to_space(a->C, &space, call->err);
  if (!status) status = cag_motion_along(space, &how, &motion, call->err);
  if (!status) status = cag_motion_frame(motion, t, &frame, call->err);
  cag_curve_release(space);
  cag_motion_release(motion);
  if (!cag_geometry_ok(call, status)) return false;
  frame.planar = false;
  *result = cag_transform_value(call->vm, &frame);
  return true;
}
