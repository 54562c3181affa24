// Arithmetic of jets.

#include "interp/vm/jet.h"

#include <math.h>
#include <string.h>

#include "interp/vm/vm.h"

// --- Values ---

static CagJet *new_jet(CagVm *vm, int variables, int order, uint32_t level, bool angle) {
  CagJet *j = cag_alloc(vm, CAG_JET, sizeof *j + cag_jet_count(variables, order) * sizeof(double));
  j->variables = (uint8_t)variables;
  j->order = (uint8_t)order;
  j->level = level;
  j->angle = angle;
  return j;
}

CagValue cag_jet_value(CagVm *vm, const CagSeries *s, bool angle) {
  CagJet *j = new_jet(vm, s->variables, s->order, s->level, angle);
  memcpy(j->c, s->c, cag_jet_count(s->variables, s->order) * sizeof(double));
  return cag_object(CAG_JET, j);
}

CagValue cag_jet_variable(CagVm *vm, int variables, int order, uint32_t level, int which, double x,
                          double rate, bool angle) {
  CagJet *j = new_jet(vm, variables, order, level, angle);
  j->c[0] = x;
  j->c[1 + which] = rate;
  return cag_object(CAG_JET, j);
}

// Coordinates are not nested deeper.
#define DEPTH_MOST 100
// Nor do they have more parts. Traversing lists with shared parts could take forever.
#define PARTS_MOST 4000000

static bool holds_jet(CagValue v, int depth, size_t *parts) {
  if (v.type == CAG_JET) return true;
  if (depth > DEPTH_MOST || ++*parts > PARTS_MOST) return false;
  if (v.type == CAG_LIST && CAG_AS_LIST(v)->dim == 0) {
    const CagList *l = CAG_AS_LIST(v);
    for (size_t i = 0; i < l->length; i++)
      if (holds_jet(l->as.items[i], depth + 1, parts)) return true;
  } else if (v.type == CAG_RECORD) {
    const CagRecord *r = CAG_AS_RECORD(v);
    for (size_t i = 0; i < r->layout->count; i++)
      if (holds_jet(r->fields[i], depth + 1, parts)) return true;
  }
  return false;
}
bool cag_holds_jet(CagValue v) { return holds_jet(v, 0, &(size_t){0}); }

CagValue cag_without_jets(CagVm *vm, CagValue v) {
  if (vm->stop) return cag_none(); // the next safe point ends the run
  if (!cag_holds_jet(v)) return v;
  if (v.type == CAG_JET) return cag_plain(v);
  if (v.type == CAG_RECORD) {
    CagRecord *r = CAG_AS_RECORD(v);
    CagValue copy = cag_record_with_layout(vm, r->layout, r->fields);
    for (size_t i = 0; i < r->layout->count; i++)
      CAG_AS_RECORD(copy)->fields[i] = cag_without_jets(vm, r->fields[i]);
    return copy;
  }
  const CagList *l = CAG_AS_LIST(v);
  CagBuilder *b = cag_builder_new(vm);
  for (size_t i = 0; i < l->length; i++)
    cag_builder_add(vm, b, cag_without_jets(vm, l->as.items[i]));
  return cag_builder_finish(vm, b);
}

static size_t count_of(const CagSeries *a) { return cag_jet_count(a->variables, a->order); }

static void shape_like(const CagSeries *like, CagSeries *out) {
  out->variables = like->variables;
  out->order = like->order;
  out->level = like->level;
}

bool cag_series_of(CagValue v, const CagSeries *like, CagSeries *out) {
  if (v.type != CAG_JET) {
    cag_series_constant(like, v.as.number, out);
    return true;
  }
  const CagJet *j = CAG_AS_JET(v);
  if (j->level != like->level) return false;
  shape_like(like, out);
  memcpy(out->c, j->c, count_of(like) * sizeof(double));
  return true;
}

// --- Ring operations ---

void cag_series_constant(const CagSeries *like, double x, CagSeries *out) {
  shape_like(like, out);
  memset(out->c, 0, count_of(like) * sizeof(double));
  out->c[0] = x;
}

bool cag_series_is_constant(const CagSeries *a) {
  for (size_t i = 1; i < count_of(a); i++)
    if (a->c[i] != 0) return false;
  return true;
}

void cag_series_add(const CagSeries *a, double factor, const CagSeries *b, CagSeries *out) {
  const size_t n = count_of(a);
  shape_like(a, out);
  for (size_t i = 0; i < n; i++) out->c[i] = a->c[i] + factor * b->c[i];
}

void cag_series_scale(const CagSeries *a, double factor, CagSeries *out) {
  const size_t n = count_of(a);
  shape_like(a, out);
  for (size_t i = 0; i < n; i++) out->c[i] = factor * a->c[i];
}

// Adds factor * (part i of a) * (part j of b) to part i + j of out.
static inline void add_product(int variables, double factor, const double *a, int i,
                               const double *b, int j, double *out) {
  if (variables == 1) {
    out[i + j] += factor * a[i] * b[j];
    return;
  }
  const double *p = a + cag_jet_offset(2, i), *q = b + cag_jet_offset(2, j);
  double *r = out + cag_jet_offset(2, i + j);
  for (int k = 0; k <= i; k++) {
    const double x = factor * p[k];
    for (int l = 0; l <= j; l++) r[k + l] += x * q[l];
  }
}

static inline void clear_part(int variables, int d, double *out) {
  if (variables == 1) out[d] = 0;
  else memset(out + cag_jet_offset(2, d), 0, (size_t)(d + 1) * sizeof(double));
}

static inline void scale_part(int variables, int d, double factor, double *out) {
  const size_t from = cag_jet_offset(variables, d), to = cag_jet_offset(variables, d + 1);
  for (size_t i = from; i < to; i++) out[i] *= factor;
}

void cag_series_multiply(const CagSeries *a, const CagSeries *b, CagSeries *out) {
  const int variables = a->variables, order = a->order;
  double r[CAG_JET_MOST];
  for (int k = 0; k <= order; k++) {
    clear_part(variables, k, r);
    for (int i = 0; i <= k; i++) add_product(variables, 1, a->c, i, b->c, k - i, r);
  }
  shape_like(a, out);
  memcpy(out->c, r, count_of(a) * sizeof(double));
}

void cag_series_divide(const CagSeries *a, const CagSeries *b, CagSeries *out) {
  const int variables = a->variables, order = a->order;
  double r[CAG_JET_MOST];
  memcpy(r, a->c, count_of(a) * sizeof(double));
  const double b0 = b->c[0];
  for (int k = 0; k <= order; k++) {
    for (int i = 1; i <= k; i++) add_product(variables, -1, b->c, i, r, k - i, r);
    const size_t from = cag_jet_offset(variables, k), to = cag_jet_offset(variables, k + 1);
    for (size_t i = from; i < to; i++) r[i] /= b0;
  }
  shape_like(a, out);
  memcpy(out->c, r, count_of(a) * sizeof(double));
}

static void whole_power(const CagSeries *a, double r, CagSeries *out) {
  CagSeries square = *a, product;
  cag_series_constant(a, 1, &product);
  // Above the order, powers of a jet with value 0 are 0, so larger exponents need not be counted.
  for (long n = (long)fmin(r, 64); n > 0; n /= 2) {
    if (n % 2) cag_series_multiply(&product, &square, &product);
    if (n > 1) cag_series_multiply(&square, &square, &square);
  }
  *out = product;
}

bool cag_series_power(const CagSeries *a, double r, CagSeries *out) {
  const double a0 = a->c[0];
  if (r == 2) {
    cag_series_multiply(a, a, out);
    return true;
  }
  if (a0 == 0) {
    if (cag_series_is_constant(a) && r >= 0) cag_series_constant(a, pow(0, r), out);
    else if (r >= 0 && r == rint(r)) whole_power(a, r, out);
    else if (r > a->order) cag_series_constant(a, 0, out);
    else return false;
    return true;
  }
  // a E h = r h E a
  const int variables = a->variables;
  double h[CAG_JET_MOST];
  h[0] = pow(a0, r);
  for (int k = 1; k <= a->order; k++) {
    clear_part(variables, k, h);
    for (int j = 1; j <= k; j++) add_product(variables, r * j - (k - j), a->c, j, h, k - j, h);
    scale_part(variables, k, 1 / (k * a0), h);
  }
  shape_like(a, out);
  memcpy(out->c, h, count_of(a) * sizeof(double));
  return true;
}

// --- Elementary functions ---

void cag_series_exp(const CagSeries *a, CagSeries *out) {
  const int variables = a->variables;
  double h[CAG_JET_MOST];
  h[0] = exp(a->c[0]);
  for (int k = 1; k <= a->order; k++) {
    clear_part(variables, k, h);
    for (int j = 1; j <= k; j++) add_product(variables, (double)j / k, a->c, j, h, k - j, h);
  }
  shape_like(a, out);
  memcpy(out->c, h, count_of(a) * sizeof(double));
}

void cag_series_ln(const CagSeries *a, CagSeries *out) {
  CagSeries one, slope;
  cag_series_constant(a, 1, &one);
  cag_series_divide(&one, a, &slope);
  cag_series_integrate(a, &slope, log(a->c[0]), out);
}

void cag_series_sin_cos(const CagSeries *a, bool hyperbolic, double sine, double cosine,
                        CagSeries *s, CagSeries *c) {
  const int variables = a->variables;
  const double sign = hyperbolic ? 1 : -1;
  double p[CAG_JET_MOST], q[CAG_JET_MOST];
  p[0] = sine;
  q[0] = cosine;
  for (int k = 1; k <= a->order; k++) {
    clear_part(variables, k, p);
    clear_part(variables, k, q);
    for (int j = 1; j <= k; j++) {
      const double factor = (double)j / k;
      add_product(variables, factor, a->c, j, q, k - j, p);
      add_product(variables, sign * factor, a->c, j, p, k - j, q);
    }
  }
  const size_t bytes = count_of(a) * sizeof(double);
  shape_like(a, s);
  shape_like(a, c);
  memcpy(s->c, p, bytes);
  memcpy(c->c, q, bytes);
}

void cag_series_tan(const CagSeries *a, bool hyperbolic, double tangent, CagSeries *out) {
  const int variables = a->variables;
  const double sign = hyperbolic ? -1 : 1;
  // E h = w E a with w = 1 + sign h^2, part by part.
  double h[CAG_JET_MOST], w[CAG_JET_MOST];
  h[0] = tangent;
  w[0] = 1 + sign * tangent * tangent;
  for (int k = 1; k <= a->order; k++) {
    clear_part(variables, k, h);
    for (int j = 1; j <= k; j++) add_product(variables, (double)j / k, a->c, j, w, k - j, h);
    clear_part(variables, k, w);
    for (int j = 0; j <= k; j++) add_product(variables, sign, h, j, h, k - j, w);
  }
  shape_like(a, out);
  memcpy(out->c, h, count_of(a) * sizeof(double));
}

void cag_series_integrate(const CagSeries *a, const CagSeries *slope, double value,
                          CagSeries *out) {
  const int variables = a->variables;
  double h[CAG_JET_MOST];
  h[0] = value;
  for (int k = 1; k <= a->order; k++) {
    clear_part(variables, k, h);
    for (int j = 1; j <= k; j++) add_product(variables, (double)j / k, a->c, j, slope->c, k - j, h);
  }
  shape_like(a, out);
  memcpy(out->c, h, count_of(a) * sizeof(double));
}

void cag_series_compose(const CagSeries *x, const double *derivatives, size_t stride,
                        CagSeries *out) {
  CagSeries step = *x, sum;
  step.c[0] = 0;
  double factorial = 1;
  for (int k = 2; k <= x->order; k++) factorial *= k;
  cag_series_constant(x, derivatives[(size_t)x->order * stride] / factorial, &sum);
  for (int k = x->order - 1; k >= 0; k--) { // Horner
    factorial /= k + 1;
    cag_series_multiply(&sum, &step, &sum);
    sum.c[0] = derivatives[(size_t)k * stride] / factorial;
  }
  *out = sum;
}

void cag_series_compose_2(const CagSeries *x, const CagSeries *y, const double *partials,
                          size_t stride, CagSeries *out) {
  const int n = x->order;
  CagSeries step_x = *x, step_y = *y, power, sum;
  step_x.c[0] = step_y.c[0] = 0;
  cag_series_constant(x, 1, &power); // (x - x0)^i / i!
  cag_series_constant(x, 0, &sum);
  for (int i = 0; i <= n; i++) {
    CagSeries term = power; // times (y - y0)^j / j!
    for (int j = 0; i + j <= n; j++) {
      cag_series_add(&sum, partials[cag_partial(n, i, j) * stride], &term, &sum);
      cag_series_multiply(&term, &step_y, &term);
      cag_series_scale(&term, 1.0 / (j + 1), &term);
    }
    cag_series_multiply(&power, &step_x, &power);
    cag_series_scale(&power, 1.0 / (i + 1), &power);
  }
  *out = sum;
}

// --- Operators ---

bool cag_fail_jet_level(CagVm *vm) {
  cag_vm_fail(vm, CAG_ERR_not_differentiable,
              "a function inside of another cannot be differentiated where it uses the parameter "
              "of the outer one");
  return cag_fail_help(vm, "write one formula for the point");
}

static bool fail_power(CagVm *vm, double base, double exponent) {
  char x[32], y[32];
  return cag_vm_fail(vm, CAG_ERR_not_differentiable,
                     "`^` cannot be differentiated at %s ^ %s: the derivatives are infinite there",
                     cag_number_text(base, x), cag_number_text(exponent, y));
}

static bool power(CagVm *vm, const CagSeries *a, const CagSeries *b, CagSeries *out) {
  if (cag_series_is_constant(b)) {
    if (cag_series_is_constant(a)) {
      cag_series_constant(a, 0, out); // the value is set by the caller
      return true;
    }
    return cag_series_power(a, b->c[0], out) || fail_power(vm, a->c[0], b->c[0]);
  }
  if (!(a->c[0] > 0)) return fail_power(vm, a->c[0], b->c[0]);
  CagSeries ln;
  cag_series_ln(a, &ln);
  cag_series_multiply(&ln, b, &ln);
  cag_series_exp(&ln, out);
  return true;
}

// Computes a - q b with the integer q of the quotient. Returns false at a discontinuity.
static bool modulo(CagVm *vm, const CagSeries *a, const CagSeries *b, double value,
                   CagSeries *out) {
  if (value == 0 && !(cag_series_is_constant(a) && cag_series_is_constant(b))) {
    char x[32], y[32];
    return cag_vm_fail(vm, CAG_ERR_not_differentiable,
                       "`%%` cannot be differentiated at %s %% %s: it jumps there",
                       cag_number_text(a->c[0], x), cag_number_text(b->c[0], y));
  }
  cag_series_add(a, -rint((a->c[0] - value) / b->c[0]), b, out);
  return true;
}

bool cag_jet_arithmetic(CagVm *vm, int op, CagValue a, CagValue b, CagValue value,
                        CagValue *result) {
  const CagJet *jet = CAG_AS_JET(a.type == CAG_JET ? a : b);
  // The most common case: the sum of a jet and a number, or of two jets.
  if (op <= CAG_OP_SUBTRACT) {
    const double sign = op == CAG_OP_ADD ? 1 : -1;
    const size_t n = cag_jet_count(jet->variables, jet->order);
    CagJet *r = new_jet(vm, jet->variables, jet->order, jet->level, jet->angle);
    if (a.type == CAG_JET && b.type == CAG_JET) {
      const CagJet *x = CAG_AS_JET(a), *y = CAG_AS_JET(b);
      if (x->level != y->level) return cag_fail_jet_level(vm);
      for (size_t i = 1; i < n; i++) r->c[i] = x->c[i] + sign * y->c[i];
    } else {
      const double factor = a.type == CAG_JET ? 1 : sign;
      for (size_t i = 1; i < n; i++) r->c[i] = factor * jet->c[i];
    }
    r->c[0] = value.as.number;
    *result = cag_object(CAG_JET, r);
    return true;
  }
  const CagSeries like = cag_series_shape(jet);
  CagSeries x, y, out;
  shape_like(&like, &out);
  if (!cag_series_of(a, &like, &x) || !cag_series_of(b, &like, &y)) return cag_fail_jet_level(vm);
  switch (op) {
  case CAG_OP_MULTIPLY:
    if (a.type != CAG_JET) cag_series_scale(&y, x.c[0], &out);
    else if (b.type != CAG_JET) cag_series_scale(&x, y.c[0], &out);
    else cag_series_multiply(&x, &y, &out);
    break;
  case CAG_OP_DIVIDE:
    if (b.type == CAG_JET) {
      cag_series_divide(&x, &y, &out);
    } else {
      out = x;
      for (size_t i = 1; i < count_of(&x); i++) out.c[i] = x.c[i] / y.c[0];
    }
    break;
  case CAG_OP_MODULO:
    if (!modulo(vm, &x, &y, value.as.number, &out)) return false;
    break;
  default:
    if (!power(vm, &x, &y, &out)) return false;
    break;
  }
  out.c[0] = value.as.number;
  *result = cag_jet_value(vm, &out, value.type == CAG_ANGLE);
  return true;
}
