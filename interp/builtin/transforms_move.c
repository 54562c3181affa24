// Transforms that optionally take the moved object first: `translate(V)` is a transform,
// `translate(G, V)` is `translate(V) * G`.
//
// Each name has two rows in the table: one that makes the transform, and one whose first parameter
// is the moved object. A list as the first argument may be a vector or a list of shapes, which the
// table cannot distinguish. If it holds shapes, the first row therefore reads its arguments like
// the second one.

#include <math.h>
#include <string.h>

#include "geom/linalg/tolerance.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "lang/foreign.h"

// Reads the arguments, beginning at parameter `at`.
typedef bool (*MakeTransform)(CagCall *call, int at, CagTransform *out);

// The largest number of parameters of the rows here, plus one for the moved object.
#define PARAMETERS_MAX 8

// Returns the row of the same function whose first parameter is the moved object.
static const CagBuiltin *moving_row(const CagBuiltin *row) {
  size_t n;
  const CagBuiltin *rows =
      cag_builtin_rows(cag_builtin_find(cag_builtin_signature_of(row)->name), &n);
  for (size_t i = 0; i < n; i++)
    if (rows[i].function == row->function && (rows[i].first & CAG_TYPE_BIT(CURVE))) return &rows[i];
  return row;
}

// Whether v is a list, possibly nested, whose first element has one of the types in `mask`.
static bool holds_types(CagVm *vm, CagValue v, uint64_t mask) {
  while (v.type == CAG_LIST) {
    const CagList *list = CAG_AS_LIST(v);
    if (list->dim != 0 || list->length == 0) return false;
    v = cag_list_get(vm, list, 0);
  }
  return v.type < 64 && (mask >> v.type & 1);
}

static bool make_or_move(CagCall *call, CagValue *result, MakeTransform make) {
  CagTransform t;
  CagCall moving = *call;
  CagValue values[PARAMETERS_MAX];
  bool moves = (call->builtin->first & CAG_TYPE_BIT(CURVE)) != 0;
  if (!moves && call->values[0].type == CAG_LIST &&
      holds_types(call->vm, call->values[0], moving_row(call->builtin)->first)) {
    size_t n = call->count < PARAMETERS_MAX ? call->count : PARAMETERS_MAX - 1;
    memcpy(values, call->values, n * sizeof *values);
    for (size_t i = n; i < PARAMETERS_MAX; i++) values[i] = cag_unset();
    moving.builtin = moving_row(call->builtin);
    moving.values = values;
    moving.count = PARAMETERS_MAX;
    moves = true;
  }
  if (!make(&moving, moves ? 1 : 0, &t)) return false;
  if (moves) return cag_transform_apply(call->vm, &t, moving.values[0], result);
  *result = cag_transform_value(call->vm, &t);
  return true;
}

static bool made(CagCall *call, CagStatus status, bool planar, CagTransform *out) {
  if (!cag_geometry_ok(call, status)) return false;
  out->planar = planar;
  return true;
}

static bool make_translate(CagCall *call, int at, CagTransform *out) {
  CagVec3 v;
  int dimension;
  if (!cag_arg_vec(call, at, &v, &dimension)) return false;
  *out = cag_translate(v);
  return made(call, CAG_OK, dimension == 2, out);
}

bool cag_transforms_translate(CagCall *call, CagValue *result) {
  return make_or_move(call, result, make_translate);
}

// Reports a missing angle. In front of a shape, three numbers (see `dimension`) are probably meant
// as rotations about x, y, and z.
static bool fail_angle(CagCall *call, int dimension, CagVec3 axis) {
  cag_fail_call(call, -1, CAG_ERR_arity, "needs an argument for `angle`");
  if (dimension < 3) return false;
  return cag_fail_help(
      call->vm,
      "for rotations about x, y, and z, write rpy: [%.15gdeg, %.15gdeg, %.15gdeg], as in %s",
      axis.x, axis.y, axis.z, cag_foreign_call("rotate"));
}

static bool make_rotate(CagCall *call, int at, CagTransform *out) {
  CagVec3 axis = {0, 0, 1}, about = {0, 0, 0};
  int axis_dimension = 2, about_dimension = 2;
  double angle;
  // Without an axis, the rotation is about Z.
  bool plain = call->values[at].type == CAG_ANGLE;
  int next = plain ? at : at + 1;
  if (!plain && !cag_arg_vec(call, at, &axis, &axis_dimension)) return false;
  if (!cag_given(call, next)) return fail_angle(call, at > 0 ? axis_dimension : 0, axis);
  if (!cag_arg_angle(call, next, &angle)) return false;
  // By position, `about` follows the angle. By name, it follows the parameter for an angle after an
  // axis.
  size_t place = (size_t)next + 1;
  if (plain && at > 0 && place + 1 < call->count && cag_given(call, (int)place + 1)) place++;
  if (place < call->count && cag_given(call, (int)place) &&
      !cag_arg_vec(call, (int)place, &about, &about_dimension))
    return false;
  // A shape that is rotated about a line parallel to Z stays in its drawing plane.
  const bool upright = at > 0 && axis.x == 0 && axis.y == 0 && about.z == 0;
  return made(call, cag_rotate(axis, angle, about, out, call->err),
              upright || (plain && about_dimension == 2), out);
}

// Reads the angles of `rpy` from a list of three, in radians.
static bool read_rpy(CagCall *call, int argument, double rpy[3]) {
  CagList *list;
  if (!cag_arg_list(call, argument, &list)) return false;
  if (list->length != 3)
    return cag_fail_call(call, argument, CAG_ERR_type,
                         "expects three angles as `rpy`, about x, y, and z; found %zu",
                         list->length);
  for (size_t i = 0; i < 3; i++) {
    const CagValue v = cag_list_get(call->vm, list, i);
    if (v.type != CAG_ANGLE) {
      cag_fail_element(call, argument, i, v, "an angle");
      if (v.type != CAG_NUMBER) return false;
      return cag_fail_help(call->vm, "write %.15gdeg", v.as.number);
    }
    rpy[i] = v.as.number * (M_PI / 180);
  }
  return true;
}

// rotate(G, rpy: [a, b, c]): about the fixed axes x, y, and z, in this order. `place` is the index
// of the parameter. `about` is before it, and the parameters that `rpy` replaces are before that.
static bool rotate_rpy(CagCall *call, int place, CagValue *result) {
  double rpy[3];
  CagVec3 about;
  int dimension;
  for (int i = 1; i < place - 1; i++)
    if (cag_given(call, i))
      return cag_fail_call(call, place, CAG_ERR_value, "takes `rpy` in place of an axis and angle");
  if (!holds_types(call->vm, call->values[0], moving_row(call->builtin)->first))
    return cag_fail_call(call, 0, CAG_ERR_value, "takes `rpy` in place of an axis and angle");
  if (!read_rpy(call, place, rpy) ||
      !cag_arg_vec_or(call, place - 1, cag_vec3(0, 0, 0), &about, &dimension))
    return false;
  const CagTransform turn = cag_rpy(rpy[0], rpy[1], rpy[2]), there = cag_translate(about),
                     back = cag_translate(cag_vec3(-about.x, -about.y, -about.z));
  CagTransform t = cag_transform_multiply(&turn, &back);
  t = cag_transform_multiply(&there, &t);
  t.planar = false;
  return cag_transform_apply(call->vm, &t, call->values[0], result);
}

bool cag_transforms_rotate(CagCall *call, CagValue *result) {
  const CagSignature *s = cag_builtin_signature_of(call->builtin);
  const int last = (int)s->count - 1;
  if (strcmp(s->parameters[last], "rpy") == 0 && cag_given(call, last))
    return rotate_rpy(call, last, result);
  if (!cag_given(call, 1) && strcmp(s->parameters[0], "G") == 0)
    return cag_fail_call(call, -1, CAG_ERR_arity, "needs an argument for `angle`");
  return make_or_move(call, result, make_rotate);
}

static bool make_scale(CagCall *call, int at, CagTransform *out) {
  CagVec3 factors, about = {0, 0, 0};
  int dimension = 2, about_dimension = 2;
  if (call->values[at].type == CAG_NUMBER) {
    double f;
    if (!cag_arg_finite(call, at, &f)) return false;
    factors = cag_vec3(f, f, f);
  } else {
    if (call->values[at].type != CAG_LIST)
      return cag_fail_type(call, at, "a factor or a vector of factors");
    if (!cag_arg_vec(call, at, &factors, &dimension)) return false;
    if (dimension == 2) factors.z = 1;
  }
  if (cag_given(call, at + 1) && !cag_arg_vec(call, at + 1, &about, &about_dimension)) return false;
  return made(call, cag_scale(factors, about, out, call->err),
              dimension == 2 && about_dimension == 2, out);
}

bool cag_transforms_scale(CagCall *call, CagValue *result) {
  return make_or_move(call, result, make_scale);
}

// The factor that gives an extent this size; 1 if the size is 0.
static bool resizing_factor(CagCall *call, char axis, double size, double extent, double largest,
                            double *factor) {
  *factor = size == 0 ? 1 : size / extent;
  if (size < 0) return cag_fail_value(call, 1, "sizes that are not negative");
  if (size == 0 || extent > CAG_ROUNDING * largest) return true;
  return cag_fail_call(call, 1, CAG_ERR_value,
                       "expects 0 for %c, because the shape has no extent along it", axis);
}

bool cag_transforms_resized(CagCall *call, const struct cag_transforms_resized *a,
                            CagValue *result) {
  CagVec3 size, f;
  CagBounds b;
  int dimension, shown;
  CagTransform t;
  if (!cag_arg_vec(call, 1, &size, &dimension) || !cag_value_bounds(call, a->G, &b, &shown))
    return false;
  const CagVec3 extent = cag_sub(b.max, b.min);
  const double largest = fmax(extent.x, fmax(extent.y, extent.z));
  if (!resizing_factor(call, 'x', size.x, extent.x, largest, &f.x) ||
      !resizing_factor(call, 'y', size.y, extent.y, largest, &f.y) ||
      !resizing_factor(call, 'z', size.z, extent.z, largest, &f.z) ||
      !made(call, cag_scale(f, cag_vec3(0, 0, 0), &t, call->err), f.z == 1, &t))
    return false;
  return cag_transform_apply(call->vm, &t, a->G, result);
}

static bool make_reflect(CagCall *call, int at, CagTransform *out) {
  const CagValue v = call->values[at];
  CagVec3 normal, through = {0, 0, 0};
  int dimension, through_dimension = 2;
  if (v.type == CAG_PLANE) {
    const CagPlane *plane = &CAG_AS_PLANE(v)->plane;
    if (cag_given(call, at + 1))
      return cag_fail_call(call, at + 1, CAG_ERR_value,
                           "takes no `through` with a plane, which has its own point");
    return made(call, cag_reflect(plane->normal, plane->point, out, call->err), false, out);
  }
  if (v.type != CAG_LIST) return cag_fail_type(call, at, "a normal or a plane");
  if (!cag_arg_vec(call, at, &normal, &dimension) ||
      (cag_given(call, at + 1) && !cag_arg_vec(call, at + 1, &through, &through_dimension)))
    return false;
  return made(call, cag_reflect(normal, through, out, call->err),
              dimension == 2 && through_dimension == 2, out);
}

bool cag_transforms_reflect(CagCall *call, CagValue *result) {
  return make_or_move(call, result, make_reflect);
}

static bool make_shear(CagCall *call, int at, CagTransform *out) {
  double k[6] = {0}; // xy xz yx yz zx zy
  for (int i = 0; i < 6; i++)
    if (cag_given(call, at + i) && !cag_arg_finite(call, at + i, &k[i])) return false;
  *out = cag_shear(k[0], k[1], k[2], k[3], k[4], k[5]);
  return made(call, CAG_OK, k[1] == 0 && k[3] == 0 && k[4] == 0 && k[5] == 0, out);
}

bool cag_transforms_shear(CagCall *call, CagValue *result) {
  return make_or_move(call, result, make_shear);
}

static bool make_project(CagCall *call, int at, CagTransform *out) {
  CagPlane onto;
  CagVec3 along = {0, 0, 0}, from;
  const bool parallel = cag_given(call, at + 1), central = cag_given(call, at + 2);
  if (!cag_arg_plane(call, at, &onto)) return false;
  if (parallel && central)
    return cag_fail_call(call, at + 2, CAG_ERR_value,
                         "takes `along` (parallel) or `from` (central), not both");
  if (central)
    return cag_arg_vec(call, at + 2, &from, NULL) &&
           made(call, cag_project_central(&onto, from, out, call->err), false, out);
  if (parallel && !cag_arg_direction(call, at + 1, along, &along, NULL)) return false;
  return made(call, cag_project_parallel(&onto, along, out, call->err), false, out);
}

bool cag_transforms_project(CagCall *call, CagValue *result) {
  return make_or_move(call, result, make_project);
}

bool cag_transforms_moved(CagCall *call, const struct cag_transforms_moved *a, CagValue *result) {
  return cag_transform_apply(call->vm, &a->T, a->G, result);
}
