// Vectors: products, lengths, angles, and comparison within a tolerance.
//
// A vector is a list of any number of numbers. 2-D and 3-D vectors can be combined; the 2-D one
// then has z = 0.

#include "interp/builtin/support.h"

// --- Reading ---

typedef struct Vector {
  const double *x;
  size_t n;
} Vector;

static bool read_vector(CagCall *call, int argument, Vector *out) {
  CagValue v = call->values[argument];
  if (v.type != CAG_LIST) return cag_fail_type(call, argument, "a vector");
  if (CAG_AS_LIST(v)->length == 0)
    return cag_fail_value(call, argument, "a vector of at least one number");
  return cag_arg_numbers(call, argument, &out->x, &out->n);
}

// Returns element i, or 0 after the end of a plane vector.
static double element(Vector v, size_t i) { return i < v.n ? v.x[i] : 0; }

// Reads the arguments 0 and 1 as vectors of one length, which is stored in *n.
static bool read_two(CagCall *call, Vector *a, Vector *b, size_t *n) {
  if (!read_vector(call, 0, a) || !read_vector(call, 1, b)) return false;
  *n = a->n > b->n ? a->n : b->n;
  bool plane_and_space = a->n >= 2 && a->n <= 3 && b->n >= 2 && b->n <= 3;
  if (a->n == b->n || plane_and_space) return true;
  return cag_fail_call(call, 1, CAG_ERR_length,
                       "expects vectors of the same length, found %zu and %zu numbers", a->n, b->n);
}

// The root of the sum of squares of n numbers x[i * stride], scaled so that it neither overflows
// nor underflows.
static double norm_of(const double *x, size_t n) {
  double sum = 0, largest = 0;
  for (size_t i = 0; i < n; i++) {
    sum += x[i] * x[i];
    if (fabs(x[i]) > largest) largest = fabs(x[i]);
  }
  // Numbers between these bounds can be squared without scaling.
  static const double SMALL = 1e-140, LARGE = 1e140;
  if ((largest > SMALL && largest < LARGE) || largest == 0 || isinf(largest)) return sqrt(sum);
  sum = 0;
  for (size_t i = 0; i < n; i++) sum += (x[i] / largest) * (x[i] / largest);
  return largest * sqrt(sum);
}

// --- Functions ---

bool cag_vectors_dot(CagCall *call, CagValue *result) {
  Vector a, b;
  size_t n;
  if (!read_two(call, &a, &b, &n)) return false;
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += element(a, i) * element(b, i);
  return cag_give_number(call, sum, result);
}

bool cag_vectors_cross(CagCall *call, const struct cag_vectors_cross *a, CagValue *result) {
  *result = cag_point(call->vm, cag_cross(a->A.at, a->B.at), 3);
  return true;
}

bool cag_vectors_norm(CagCall *call, CagValue *result) {
  Vector v;
  return read_vector(call, 0, &v) && cag_give_number(call, norm_of(v.x, v.n), result);
}

bool cag_vectors_unit(CagCall *call, CagValue *result) {
  Vector v;
  if (!read_vector(call, 0, &v)) return false;
  double norm = norm_of(v.x, v.n);
  if (norm == 0)
    return cag_fail_call(call, 0, CAG_ERR_not_finite,
                         "of a zero vector is undefined: it has no direction");
  if (isinf(norm)) return cag_fail_value(call, 0, "a vector of finite length");
  double *numbers;
  CagValue unit = cag_list_numbers(call->vm, v.n, &numbers);
  for (size_t i = 0; i < v.n; i++) numbers[i] = v.x[i] / norm + 0.0;
  *result = unit;
  return true;
}

// distance is symmetric. If the second argument is a shape, the row for shapes is called with the
// arguments swapped.
static bool distance_to_shape(CagCall *call, CagValue *result) {
  size_t index = cag_builtin_find("distance"), rows;
  const CagBuiltin *row = cag_builtin_rows(index, &rows);
  for (size_t i = 0; i < rows; i++) {
    if ((row[i].first >> call->values[1].type & 1) == 0) continue;
    CagValue swapped[] = {call->values[1], call->values[0]};
    CagCall other = {call->vm, &row[i], swapped, 2, call->err};
    return row[i].function(&other, result);
  }
  return cag_fail_type(call, 1, "a point");
}

bool cag_vectors_distance(CagCall *call, CagValue *result) {
  Vector a, b;
  size_t n;
  if (cag_is_shape(call->values[1])) return distance_to_shape(call, result);
  if (!read_two(call, &a, &b, &n)) return false;
  if (n > CAG_MAX_PACKED) {
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum = hypot(sum, a.x[i] - b.x[i]);
    return cag_give_number(call, sum, result);
  }
  double difference[CAG_MAX_PACKED];
  for (size_t i = 0; i < n; i++) difference[i] = element(a, i) - element(b, i);
  return cag_give_number(call, norm_of(difference, n), result);
}

static bool fail_zero(CagCall *call, int argument) {
  return cag_fail_call(call, argument, CAG_ERR_not_finite,
                       "is undefined for a zero vector: it has no direction");
}

bool cag_vectors_angle_between(CagCall *call, CagValue *result) {
  Vector a, b;
  size_t n;
  if (!read_two(call, &a, &b, &n)) return false;
  double na = norm_of(a.x, a.n), nb = norm_of(b.x, b.n);
  if (na == 0) return fail_zero(call, 0);
  if (nb == 0) return fail_zero(call, 1);
  if (isinf(na) || isinf(nb))
    return cag_fail_value(call, isinf(na) ? 0 : 1, "a vector of finite length");
  if (n == 2 || n == 3) {
    // From sine and cosine, which is exact for multiples of 45deg and accurate near 0 and 180deg.
    CagVec3 u = cag_vec3(a.x[0] / na, a.x[1] / na, element(a, 2) / na);
    CagVec3 v = cag_vec3(b.x[0] / nb, b.x[1] / nb, element(b, 2) / nb);
    *result = cag_angle(cag_atan2_degrees(cag_norm(cag_cross(u, v)), cag_dot(u, v)));
    return true;
  }
  // Kahan's formula: twice the angle in the triangle of the sum and the difference of the unit
  // vectors.
  double sum = 0, difference = 0;
  for (size_t i = 0; i < n; i++) {
    double u = a.x[i] / na, v = b.x[i] / nb;
    sum += (u + v) * (u + v);
    difference += (u - v) * (u - v);
  }
  *result = cag_angle(2 * cag_atan2_degrees(sqrt(difference), sqrt(sum)));
  return true;
}

bool cag_vectors_is_parallel(CagCall *call, CagValue *result) {
  const double same = 1e-9; // radians
  CagValue angle;
  if (!cag_vectors_angle_between(call, &angle)) return false;
  const double radians = angle.as.number * M_PI / 180;
  *result = cag_bool(fmin(radians, M_PI - radians) <= same);
  return true;
}

// --- near ---

typedef struct Nearness {
  CagCall *call;
  double tolerance, relative;
  int depth; // of lists
} Nearness;

static bool near_numbers(const Nearness *by, double a, double b) {
  return a == b || fabs(a - b) <= fmax(by->tolerance, by->relative * fabs(b));
}

static bool near_transforms(const Nearness *by, const CagTransform *a, const CagTransform *b) {
  bool all = true;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) all = all && near_numbers(by, a->m[i][j], b->m[i][j]);
  return all;
}

// Compares two values into *out. Returns false with the error set if they cannot be compared.
static bool near_values(Nearness *by, CagValue a, CagValue b, bool *out);

static bool near_lists(Nearness *by, const CagList *a, const CagList *b, bool *out) {
  if (a->length != b->length)
    return cag_fail_call(by->call, 1, CAG_ERR_length,
                         "expects lists of the same length, found %zu and %zu elements", a->length,
                         b->length);
  *out = true;
  if (a->dim > 0 && a->dim == b->dim) {
    for (size_t i = 0; i < a->length * a->dim && *out; i++)
      *out = near_numbers(by, a->as.numbers[i], b->as.numbers[i]);
    return true;
  }
  if (!cag_may_nest(by->call, ++by->depth)) return false;
  for (size_t i = 0; i < a->length && *out; i++)
    if (!near_values(by, cag_list_get(by->call->vm, a, i), cag_list_get(by->call->vm, b, i), out))
      return false;
  by->depth--;
  return true;
}

static bool near_values(Nearness *by, CagValue a, CagValue b, bool *out) {
  CagVm *vm = by->call->vm;
  bool lists =
      (a.type == CAG_LIST || a.type == CAG_RANGE) && (b.type == CAG_LIST || b.type == CAG_RANGE);
  if (lists)
    return cag_as_list(vm, a, &a) && cag_as_list(vm, b, &b) &&
           near_lists(by, CAG_AS_LIST(a), CAG_AS_LIST(b), out);
  if (a.type == b.type && (a.type == CAG_NUMBER || a.type == CAG_ANGLE)) {
    *out = near_numbers(by, a.as.number, b.as.number);
    return true;
  }
  if (a.type == b.type && a.type == CAG_TRANSFORM) {
    *out = near_transforms(by, &CAG_AS_TRANSFORM(a)->t, &CAG_AS_TRANSFORM(b)->t);
    return true;
  }
  char left[120], right[120];
  return cag_fail_call(
      by->call, 1, CAG_ERR_type,
      "expects two numbers, angles, vectors, transforms, or lists of these, found %s and %s",
      cag_value_words(vm, a, left, sizeof left), cag_value_words(vm, b, right, sizeof right));
}

// Reads a number of at least 0, or, if the values may be angles, an angle.
static bool read_tolerance(CagCall *call, int argument, double fallback, double *out) {
  CagValue v = call->values[argument];
  *out = fallback;
  if (v.type == CAG_UNSET) return true;
  if (v.type == CAG_ANGLE && call->values[0].type == CAG_ANGLE) *out = v.as.number;
  else if (!cag_arg_number(call, argument, out)) return false;
  return *out >= 0 || cag_fail_value(call, argument, "a tolerance of at least 0");
}

bool cag_vectors_near(CagCall *call, CagValue *result) {
  static const double TOLERANCE = 1e-9; // the default stated in the signature
  Nearness by = {.call = call};
  bool near;
  if (!read_tolerance(call, 2, TOLERANCE, &by.tolerance) ||
      !read_tolerance(call, 3, 0, &by.relative))
    return false;
  if (!near_values(&by, call->values[0], call->values[1], &near)) return false;
  *result = cag_bool(near);
  return true;
}
