// Pictures of a surface's quality: colors of curvature, zebra stripes, isophotes.
//
// Colors are those of a mesh with a value at each vertex and a scale (CagColorScale), which every
// transform and exporter knows. The meshes are white, so that viewers which multiply the colors
// of vertices and material show them as they are.

#include "base/array.h"
#include "base/memory.h"
#include "geom/meet/isophote.h"
#include "geom/meet/value_map.h"
#include "geom/solid/tessellate.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "interp/scene/color_scale.h"
#include "interp/vm/vm.h"

// --- Meshes of several faces ---

typedef struct Meshes {
  CagMesh **items;
  size_t count, capacity;
} Meshes;

static void release_meshes(void *what) {
  const Meshes *m = what;
  for (size_t i = 0; i < m->count; i++) cag_mesh_release(m->items[i]);
  cag_free(m->items);
}

// No meshes yet; those that are added are released with the built-in.
static Meshes *hold_meshes(CagCall *call) {
  Meshes *m = cag_hold_array(call, 1, sizeof *m);
  cag_hold_for(call, release_meshes, m);
  return m;
}

// Takes the mesh over.
static CagStatus add_mesh(Meshes *m, CagMesh *mesh, CagError *err) {
  if (!CAG_RESERVE(m->items, m->capacity, m->count + 1)) {
    cag_mesh_release(mesh);
    return cag_fail_memory(err);
  }
  m->items[m->count++] = mesh;
  return CAG_OK;
}

// All the shapes of the first argument, as a list that the caller roots.
static bool read_shapes(CagCall *call, CagList **out) {
  CagBuilder *builder = cag_builder_new(call->vm);
  if (!cag_shapes_collect(call, call->values[0], builder)) return false;
  *out = CAG_AS_LIST(cag_builder_finish(call->vm, builder));
  return (*out)->length > 0 || cag_fail_call(call, 0, CAG_ERR_value, "expects a shape");
}

typedef CagStatus (*MakeMesh)(const void *what, const CagShape *shape, CagValue v,
                              const CagTessellation *how, Meshes *out, CagError *err);

// tolerance 0: that of each shape.
static bool make_meshes(CagCall *call, double tolerance, MakeMesh make, const void *what,
                        Meshes *out) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagList *shapes;
  if (call->vm->max_triangles > 0) how.max_triangles = call->vm->max_triangles;
  how.interrupt = cag_vm_stop(call->vm);
  if (!read_shapes(call, &shapes)) return false;
  // Formulas are called back: the shapes stay.
  cag_root_push(call->vm, cag_object(CAG_LIST, shapes));
  bool ok = true;
  for (size_t i = 0; ok && i < shapes->length; i++) {
    CagValue v = cag_list_get(call->vm, shapes, i);
    how.tolerance = tolerance > 0 ? tolerance : CAG_AS_SHAPE(v)->tolerance;
    ok = cag_geometry_ok(call, make(what, CAG_AS_SHAPE(v), v, &how, out, call->err));
  }
  cag_root_pop(call->vm, 1);
  return ok;
}

static bool give_mesh(CagCall *call, const Meshes *parts, CagColorScale scale, CagValue *result) {
  static const char *const names[] = {"color", "roughness", "ior"};
  static const double white[] = {1, 1, 1};
  const double matte_roughness = 0.6, matte_ior = 1.3;
  CagMesh *whole = NULL;
  for (size_t i = 0; i < parts->count; i++) parts->items[i]->scale = scale;
  if (!cag_geometry_ok(call, cag_mesh_append(parts->items, parts->count, &whole, call->err)))
    return false;
  *result = cag_mesh_value(call->vm, whole);
  CagValue fields[] = {cag_vector(call->vm, white, 3), cag_number(matte_roughness),
                       cag_number(matte_ior)};
  CAG_AS_SHAPE(*result)->material = CAG_AS_RECORD(cag_record_new(call->vm, names, fields, 3));
  return true;
}

// --- Colors of curvature ---

static CagStatus value_mesh(const void *what, const CagShape *shape, CagValue v,
                            const CagTessellation *how, Meshes *out, CagError *err) {
  CagSurfaceValue kind = *(const CagSurfaceValue *)what;
  const CagSurface *one[1] = {shape->as.surface};
  const CagSurface *const *faces = one;
  size_t n = 1;
  if (v.type == CAG_SOLID) {
    faces = (const CagSurface *const *)shape->as.solid->faces;
    n = shape->as.solid->face_count;
  }
  if ((v.type != CAG_SURFACE && v.type != CAG_SOLID) || n == 0)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_curvature, "", -1,
                    "%s has no surfaces with a curvature to show",
                    v.type == CAG_SOLID ? "a solid made by set operations or from meshes"
                                        : cag_type_article(v));
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++) {
    CagMesh *mesh = NULL;
    status = cag_surface_value_mesh(faces[i], kind, how, &mesh, err);
    if (!status) status = add_mesh(out, mesh, err);
  }
  return status;
}

// The size of all meshes, from which follows what curvature is rounding.
static double size_of(const Meshes *m) {
  CagBounds all = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < m->count; i++) {
    CagBounds b = cag_mesh_bounds(m->items[i]);
    all.min =
        cag_vec3(fmin(all.min.x, b.min.x), fmin(all.min.y, b.min.y), fmin(all.min.z, b.min.z));
    all.max =
        cag_vec3(fmax(all.max.x, b.max.x), fmax(all.max.y, b.max.y), fmax(all.max.z, b.max.z));
  }
  return cag_norm(cag_sub(all.max, all.min));
}

// Curvatures below this part of the inverse size are none.
#define FLAT 1e-7

// A span with values of both signs is made symmetric, so that 0 has the middle color.
static void find_span(const Meshes *m, CagSurfaceValue kind, double *from, double *to) {
  double size = size_of(m), unit = size > 0 ? 1 / size : 1;
  double least = FLAT * (kind == CAG_VALUE_GAUSSIAN ? unit * unit : unit);
  if (kind == CAG_VALUE_SLOPE) least = FLAT;
  cag_mesh_value_span(m->items, m->count, least, from, to);
  const double both = 0.02; // a sign that takes up less of the span does not count
  if (*from<-both * * to && * to> - both * *from) {
    *to = fmax(*to, -*from);
    *from = -*to;
  }
}

static bool check_span(CagCall *call, CagRangeEnds range, bool slope) {
  if (range.angle && !slope)
    return cag_fail_call(call, 2, CAG_ERR_value,
                         "expects a range of numbers: curvatures are 1/mm (mean and principal) and "
                         "1/mm2 (Gaussian)");
  return (isfinite(range.start) && isfinite(range.end) && range.start != range.end) ||
         cag_fail_call(call, 2, CAG_ERR_value,
                       "expects a range with two different finite ends, found %g..%g", range.start,
                       range.end);
}

static bool is_symmetric(double from, double to) {
  const double same = 1e-9;
  return from * to < 0 && fabs(from + to) <= same * (fabs(from) + fabs(to));
}

bool cag_quality_colored_by(CagCall *call, const struct cag_quality_colored_by *a,
                            CagValue *result) {
  double from = a->range.start, to = a->range.end;
  int kind;
  if (!cag_arg_choice(call, 1, cag_surface_values, &kind)) return false;
  CagSurfaceValue value = (CagSurfaceValue)kind;
  const bool said = cag_given(call, 2);
  if (said && !check_span(call, a->range, value == CAG_VALUE_SLOPE)) return false;
  Meshes *parts = hold_meshes(call);
  if (!make_meshes(call, a->tolerance, value_mesh, &value, parts)) return false;
  if (!said) find_span(parts, value, &from, &to);
  const bool diverging = a->colors == 2 || (a->colors == 0 && is_symmetric(from, to));
  CagColorScale scale = {diverging ? CAG_SCALE_DIVERGING : CAG_SCALE_SEQUENCE, from, to, 0};
  return give_mesh(call, parts, scale, result);
}

// --- What a colored mesh says ---

static bool check_colored(CagCall *call, const CagMesh *m) {
  return (m->scale.kind && m->uv) ||
         cag_geometry_ok(
             call,
             cag_fail(call->err, CAG_E_UNSUPPORTED, CAG_ERR_no_values, "", -1,
                      "the mesh has no values; `colored_by` and `zebra` make meshes with values"));
}

bool cag_quality_values_of(CagCall *call, const struct cag_quality_values_of *a, CagValue *result) {
  const CagMesh *m = a->M;
  double *x;
  if (!check_colored(call, m)) return false;
  *result = cag_list_numbers(call->vm, m->vertex_count, &x);
  for (size_t v = 0; v < m->vertex_count; v++) x[v] = m->uv[2 * v] + 0.0;
  return true;
}

bool cag_quality_color_range(CagCall *call, const struct cag_quality_color_range *a,
                             CagValue *result) {
  if (!check_colored(call, a->M)) return false;
  *result = cag_domain_value(call->vm, false, a->M->scale.from, a->M->scale.to);
  return true;
}

bool cag_quality_scale_color(CagCall *call, const struct cag_quality_scale_color *a,
                             CagValue *result) {
  if (!check_colored(call, a->M)) return false;
  const CagColor c = cag_color_scale_at(&a->M->scale, a->value);
  const double rgb[] = {c.r, c.g, c.b};
  *result = cag_vector(call->vm, rgb, 3);
  return true;
}

// --- Zebra stripes ---

typedef struct Zebra {
  CagVec3 eye, across;
  int stripes;
} Zebra;

// Vertices along the narrowest stripe; the mirrored direction turns twice as fast as the normal.
#define STRIPE_EDGES 2.5

static CagStatus zebra_mesh(const void *what, const CagShape *shape, CagValue v,
                            const CagTessellation *how, Meshes *out, CagError *err) {
  const Zebra *z = what;
  CagTessellation fine = *how;
  CagMesh *mesh = NULL;
  fine.angle = fmin(how->angle, 1 / (2 * STRIPE_EDGES * z->stripes));
  CagStatus status;
  if (v.type == CAG_SURFACE) status = cag_surface_tessellate(shape->as.surface, &fine, &mesh, err);
  else if (v.type == CAG_SOLID) status = cag_solid_tessellate(shape->as.solid, &fine, &mesh, err);
  else if (v.type == CAG_MESH && shape->as.mesh->normals) {
    CagTransform still = cag_transform_identity(); // a copy of its own
    status = cag_mesh_transform(shape->as.mesh, &still, &mesh, err);
  } else
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_curvature, "", -1,
                    "%s has no smooth normals to reflect stripes", cag_type_article(v));
  if (!status && !mesh->normals) {
    cag_mesh_release(mesh);
    return cag_fail(
        err, CAG_E_UNSUPPORTED, CAG_ERR_no_curvature, "", -1,
        "a solid made by set operations or from flat meshes has no smooth normals to reflect stripes");
  }
  if (!status) status = cag_mesh_reflect(mesh, z->eye, z->across, err);
  if (!status) return add_mesh(out, mesh, err);
  cag_mesh_release(mesh);
  return status;
}

// `across` made perpendicular to the view; where none is said (0) the world's Z, or Y for a view
// along it.
static bool find_across(CagCall *call, CagVec3 v, CagVec3 eye, CagVec3 *out) {
  const double parallel = 1e-9; // sine
  if (cag_norm(v) == 0) {
    v = cag_vec3(0, 0, 1);
    if (cag_norm(cag_cross(v, eye)) < parallel) v = cag_vec3(0, 1, 0);
  }
  v = cag_unit(v);
  CagVec3 square = cag_madd(v, -cag_dot(v, eye), eye);
  if (cag_norm(square) < parallel)
    return cag_fail_call(call, 3, CAG_ERR_value,
                         "expects a direction that differs from the direction of the view");
  *out = cag_unit(square);
  return true;
}

bool cag_quality_zebra(CagCall *call, const struct cag_quality_zebra *a, CagValue *result) {
  const CagVec3 usual = {0.4, -0.8, 0.5}; // from the front, a little above
  Zebra z = {.eye = cag_unit(cag_given(call, 2) ? a->view.at : usual), .stripes = (int)a->stripes};
  if (!find_across(call, a->across.at, z.eye, &z.across)) return false;
  Meshes *parts = hold_meshes(call);
  return make_meshes(call, a->tolerance, zebra_mesh, &z, parts) &&
         give_mesh(call, parts, (CagColorScale){CAG_SCALE_STRIPES, -1, 1, z.stripes}, result);
}

// --- Isophotes ---

#define LEVELS_MOST 1000

// The cosines of the levels: of a count, angles evenly between 0 and 180 degrees, ends left out; of
// a list, its angles. *out is held.
static bool read_levels(CagCall *call, int argument, double **out, size_t *n) {
  const bool listed = call->values[argument].type == CAG_LIST;
  long count = 11;
  const double straight = 3.14159265358979323846;
  CagList *list = NULL;
  if (listed && !cag_arg_list(call, argument, &list)) return false;
  if (!listed && !cag_arg_integer_or(call, argument, count, 1, LEVELS_MOST, &count)) return false;
  *n = listed ? list->length : (size_t)count;
  if (*n > LEVELS_MOST)
    return cag_fail_call(call, argument, CAG_ERR_value, "expects at most %d angles", LEVELS_MOST);
  *out = cag_hold_array(call, *n, sizeof **out);
  for (size_t i = 0; i < *n; i++) {
    double angle = straight * (double)(i + 1) / (double)(*n + 1);
    if (listed) {
      CagValue v = cag_list_get(call->vm, list, i);
      if (v.type != CAG_ANGLE || !(v.as.number >= 0 && v.as.number <= 180))
        return cag_fail_call(
            call, argument, CAG_ERR_value,
            "expects a number of levels or a list of angles from 0deg to 180deg; element %zu is not such an angle",
            i);
      angle = v.as.number * CAG_RADIANS_PER_DEGREE;
    }
    // A right angle is where the outline is: its cosine is 0, not rounding.
    (*out)[i] = fabs(angle - straight / 2) < 1e-15 ? 0 : cos(angle);
  }
  return true;
}

static CagStatus isophotes_of(CagValue v, CagVec3 direction, double cosine, double tolerance,
                              CagCurveList *out, CagError *err) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  if (v.type == CAG_SURFACE)
    return cag_surface_isophote(shape->as.surface, direction, cosine, tolerance, out, err);
  if (v.type != CAG_SOLID || shape->as.solid->face_count == 0)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_curvature, "", -1,
                    "%s has no surfaces to draw isophotes on",
                    v.type == CAG_SOLID ? "a solid made by set operations or from meshes"
                                        : cag_type_article(v));
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < shape->as.solid->face_count; i++)
    status =
        cag_surface_isophote(shape->as.solid->faces[i], direction, cosine, tolerance, out, err);
  return status;
}

static bool give_curves(CagCall *call, const CagCurveList *list, CagValue *result) {
  CagBuilder *out = cag_builder_new(call->vm);
  for (size_t i = 0; i < list->count; i++)
    if (!cag_builder_add(call->vm, out,
                         cag_curve_value(call->vm, cag_curve_retain(list->items[i]))))
      return false;
  *result = cag_group_value(call->vm, cag_builder_finish(call->vm, out));
  return true;
}

bool cag_quality_isophotes(CagCall *call, const struct cag_quality_isophotes *a, CagValue *result) {
  const CagVec3 direction = cag_unit(a->direction.at);
  double *cosines = NULL;
  size_t n;
  CagList *shapes;
  CagCurveList *list = cag_hold_curve_list(call);
  if (!read_shapes(call, &shapes) || !read_levels(call, 2, &cosines, &n)) return false;
  cag_root_push(call->vm, cag_object(CAG_LIST, shapes));
  bool ok = true;
  for (size_t i = 0; ok && i < shapes->length; i++)
    for (size_t k = 0; ok && k < n; k++)
      ok = cag_geometry_ok(call, isophotes_of(cag_list_get(call->vm, shapes, i), direction,
                                              cosines[k], a->tolerance, list, call->err)) &&
           cag_keep_going(call->vm);
  ok = ok && give_curves(call, list, result);
  cag_root_pop(call->vm, 1);
  return ok;
}
