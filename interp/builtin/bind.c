// Reads the arguments of a call into a structure, by the types of the signature.

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "interp/builtin/images.h"
#include "interp/builtin/robots.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"

// Checks the range of a number. Infinite ends of ranges are not written in messages.
static bool check_range(CagCall *call, int argument, const CagParameterType *type, double x,
                        const char *noun) {
  if (!type->ranged) return true;
  if ((type->above_low ? x > type->low : x >= type->low) && x <= type->high) return true;
  char expected[120], low[32], high[32];
  cag_number_text(type->low, low);
  cag_number_text(type->high, high);
  if (isfinite(type->high)) snprintf(expected, sizeof expected, "%s in %s..%s", noun, low, high);
  else if (type->above_low) snprintf(expected, sizeof expected, "%s greater than %s", noun, low);
  else snprintf(expected, sizeof expected, "%s of at least %s", noun, low);
  return cag_fail_value(call, argument, expected);
}

static bool bind_number(CagCall *call, int argument, const CagParameterType *type, double *out) {
  const bool finite = type->kind == CAG_BIND_FINITE;
  if (!cag_arg_number(call, argument, out)) return false;
  // Of a number that is both infinite and out of range, the range is what matters.
  if (finite && !isfinite(*out) && (!type->ranged || *out > type->low))
    return cag_fail_value(call, argument,
                          type->above_low && type->low == 0 ? "a finite number greater than 0"
                                                            : "a finite number");
  return check_range(call, argument, type, *out, "a number");
}

static bool bind_integer(CagCall *call, int argument, const CagParameterType *type, long *out) {
  const long low = type->ranged ? (long)type->low : LONG_MIN;
  const long high = isfinite(type->high) ? (long)type->high : LONG_MAX;
  return cag_arg_integer(call, argument, low, high, out);
}

static bool bind_argument(CagCall *call, int argument, const CagParameterType *type, void *field) {
  switch (type->kind) {
  case CAG_BIND_VALUE: *(CagValue *)field = call->values[argument]; return true;
  case CAG_BIND_NUMBER:
  case CAG_BIND_FINITE: return bind_number(call, argument, type, field);
  case CAG_BIND_INTEGER: return bind_integer(call, argument, type, field);
  case CAG_BIND_ANGLE: return cag_arg_angle(call, argument, field);
  case CAG_BIND_BOOL: return cag_arg_bool_or(call, argument, false, field);
  case CAG_BIND_TEXT: return cag_arg_text(call, argument, field);
  case CAG_BIND_CHOICE: return cag_arg_choice(call, argument, type->choices, field);
  case CAG_BIND_POINT: {
    CagPoint *p = field;
    return cag_arg_vec(call, argument, &p->at, &p->dimension);
  }
  case CAG_BIND_DIRECTION: {
    CagPoint *p = field;
    return cag_arg_direction(call, argument, p->at, &p->at, &p->dimension);
  }
  case CAG_BIND_POINTS: {
    CagPoints *p = field;
    if (!cag_arg_points(call, argument, &p->items, &p->count, &p->dimension)) return false;
    cag_hold(call, p->items);
    return true;
  }
  case CAG_BIND_NUMBERS: {
    CagNumbers *n = field;
    return cag_arg_numbers(call, argument, &n->items, &n->count);
  }
  case CAG_BIND_RANGE: {
    CagRangeEnds *r = field;
    return cag_arg_interval(call, argument, &r->start, &r->end, &r->angle);
  }
  case CAG_BIND_LIST: return cag_arg_list(call, argument, field);
  case CAG_BIND_RECORD: return cag_arg_record(call, argument, field);
  case CAG_BIND_FUNCTION: return cag_arg_function(call, argument, field);
  case CAG_BIND_TRANSFORM: return cag_arg_transform(call, argument, field);
  case CAG_BIND_PLANE: return cag_arg_plane(call, argument, field);
  case CAG_BIND_CURVE: return cag_arg_curve(call, argument, field);
  case CAG_BIND_SURFACE: return cag_arg_surface(call, argument, field);
  case CAG_BIND_SOLID:
  case CAG_BIND_MESH: {
    const CagType wanted = type->kind == CAG_BIND_MESH ? CAG_MESH : CAG_SOLID;
    const CagValue v = call->values[argument];
    if (v.type != wanted)
      return cag_fail_type(call, argument, wanted == CAG_MESH ? "a mesh" : "a solid");
    if (wanted == CAG_MESH) *(CagMesh **)field = CAG_AS_SHAPE(v)->as.mesh;
    else *(CagSolid **)field = CAG_AS_SHAPE(v)->as.solid;
    return true;
  }
  case CAG_BIND_ROBOT: return cag_arg_robot(call, argument, field);
  case CAG_BIND_IMAGE: return cag_arg_image(call, argument, field);
  }
  return false;
}

// The default of an argument that was not given. The field is zero.
static void set_default(const CagParameterTypes *types, const CagParameterType *type,
                        char *structure) {
  void *field = structure + type->offset;
  const double *x = type->fallback;
  if (type->same_as_set) {
    const CagParameterType *other = &types->items[type->same_as];
    const size_t size = type->kind == CAG_BIND_POINT || type->kind == CAG_BIND_DIRECTION
                            ? sizeof(CagPoint)
                            : sizeof(double);
    memcpy(field, structure + other->offset, size);
    return;
  }
  switch (type->kind) {
  case CAG_BIND_NUMBER:
  case CAG_BIND_FINITE:
  case CAG_BIND_ANGLE: *(double *)field = x[0]; break;
  case CAG_BIND_INTEGER: *(long *)field = (long)x[0]; break;
  case CAG_BIND_BOOL: *(bool *)field = x[0] != 0; break;
  case CAG_BIND_CHOICE: *(int *)field = (int)x[0]; break;
  case CAG_BIND_POINT:
  case CAG_BIND_DIRECTION:
    *(CagPoint *)field = (CagPoint){cag_vec3(x[0], x[1], x[2]), type->dimension};
    break;
  case CAG_BIND_RANGE: *(CagRangeEnds *)field = (CagRangeEnds){x[0], x[1], type->dimension}; break;
  case CAG_BIND_VALUE: *(CagValue *)field = cag_unset(); break;
  case CAG_BIND_TRANSFORM: *(CagTransform *)field = cag_transform_identity(); break;
  case CAG_BIND_TEXT: *(const char **)field = type->fallback_text; break;
  default: break;
  }
}

bool cag_bind_field(CagCall *call, int argument, void *structure) {
  const CagParameterTypes *types = cag_signature_types(cag_builtin_signature_of(call->builtin));
  const CagParameterType *type = &types->items[argument];
  char *field = (char *)structure + type->offset;
  if (cag_given(call, argument)) return bind_argument(call, argument, type, field);
  memset(field, 0, type->size);
  set_default(types, type, structure);
  return true;
}

bool cag_bind_fits(const CagCall *call, size_t size) {
  const CagParameterTypes *types = cag_signature_types(cag_builtin_signature_of(call->builtin));
  // The structure may end with padding.
  return size >= types->size && size < types->size + _Alignof(max_align_t);
}
