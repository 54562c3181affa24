// Curves and surfaces defined by functions of the script, which geometry calls.
//
// For points alone, the function is called with plain numbers. For derivatives, the parameters are
// jets (interp/vm/jet.h), and the resulting coordinates contain the derivatives.

#include <math.h>

#include "base/memory.h"
#include "geom/curve/function.h"
#include "geom/curve/natural.h"
#include "geom/surface/function.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "interp/vm/jet.h"
#include "interp/vm/vm.h"

#define DEGREES_PER_RADIAN 57.29577951308232

// --- A function of the script as data of the geometry core ---

typedef struct Formula {
  CagVm *vm;
  size_t slot;     // where the machine keeps the function
  bool angular[2]; // the script sees these parameters as angles
  int variables;
  size_t coordinates; // of a point; 0: not yet known
} Formula;

static void formula_free(void *context) {
  Formula *f = context;
  cag_vm_let_go(f->vm, f->slot);
  cag_free(f);
}

// Returns a formula that is held until geometry takes it over.
static Formula *formula_new(CagCall *call, CagValue function, int variables) {
  Formula *f = cag_hold_array(call, 1, sizeof *f);
  f->vm = call->vm;
  f->variables = variables;
  f->slot = cag_vm_keep(call->vm, function);
  cag_hold_for(call, formula_free, cag_give_held(call, f));
  return f;
}

// Converts radians to degrees. Whole degrees stay whole.
static double degrees_of(double radians) {
  const double degrees = radians * DEGREES_PER_RADIAN, whole = rint(degrees);
  return fabs(degrees - whole) <= 4e-16 * fabs(whole) ? whole : degrees;
}

static void parameter_text(const Formula *f, const double *at, char *out, size_t size) {
  static const char *const names[2][2] = {{"t", ""}, {"u", "v"}};
  char x[2][32];
  for (int i = 0; i < f->variables; i++)
    cag_number_text(f->angular[i] ? degrees_of(at[i]) : at[i], x[i]);
  const char *const *name = names[f->variables - 1];
  if (f->variables == 1)
    snprintf(out, size, "%s = %s%s", name[0], x[0], f->angular[0] ? "deg" : "");
  else
    snprintf(out, size, "%s = %s%s, %s = %s%s", name[0], x[0], f->angular[0] ? "deg" : "", name[1],
             x[1], f->angular[1] ? "deg" : "");
}

// --- Results of the function ---

static bool fail_point(Formula *f, const double *at, CagValue given) {
  char where[96], found[160];
  CagVm *vm = f->vm;
  parameter_text(f, at, where, sizeof where);
  cag_value_words(vm, given, found, sizeof found);
  const char *wanted = f->variables == 2     ? "a point of 3 numbers"
                       : f->coordinates == 2 ? "a point of 2 numbers, as at the start"
                       : f->coordinates == 3 ? "a point of 3 numbers, as at the start"
                                             : "a point of 2 or 3 numbers";
  return cag_vm_fail_in(vm, vm->kept[f->slot], CAG_ERR_type,
                        "the function of a %s must return %s; at %s, it returned %s",
                        f->variables == 1 ? "curve" : "surface", wanted, where, found);
}

static bool fail_not_finite(Formula *f, const double *at, const char *what) {
  char where[96];
  parameter_text(f, at, where, sizeof where);
  return cag_vm_fail_in(f->vm, f->vm->kept[f->slot], CAG_ERR_not_finite,
                        "%s of the function at %s is not finite", what, where);
}

// Reads a coordinate of a point: a number, or a jet of this evaluation. Returns false for anything
// else.
static bool coordinate(CagVm *vm, CagValue v, const CagSeries *like, CagSeries *out) {
  if (v.type == CAG_NUMBER) {
    cag_series_constant(like, v.as.number, out);
    return true;
  }
  if (v.type != CAG_JET || CAG_AS_JET(v)->angle) return false;
  return cag_series_of(v, like, out) || cag_fail_jet_level(vm);
}

// Reads a point into series. Returns false with the error set if that fails.
static bool read_point(Formula *f, const double *at, CagValue given, const CagSeries *like,
                       CagSeries *out) {
  const CagList *l = given.type == CAG_LIST ? CAG_AS_LIST(given) : NULL;
  bool good = l && l->dim <= 1 && (l->length == 3 || (l->length == 2 && f->variables == 1)) &&
              (f->coordinates == 0 || l->length == f->coordinates);
  if (!good) return fail_point(f, at, given);
  for (size_t i = 0; i < 3; i++) {
    if (i == l->length) cag_series_constant(like, 0, &out[i]);
    else if (l->dim == 1) cag_series_constant(like, l->as.numbers[i], &out[i]);
    else if (!coordinate(f->vm, l->as.items[i], like, &out[i]))
      return f->vm->failed ? false : fail_point(f, at, given);
    if (!isfinite(out[i].c[0])) return fail_not_finite(f, at, "the point");
    for (size_t k = 1; k < cag_jet_count(like->variables, like->order); k++)
      if (!isfinite(out[i].c[k])) return fail_not_finite(f, at, "a derivative");
  }
  f->coordinates = l->length;
  return true;
}

// Calls the function with numbers, or with jets if derivatives are needed, and reads the result.
static bool call_formula(Formula *f, const double *at, CagSeries *like,
                         bool (*read)(Formula *f, const double *at, CagValue given,
                                      const CagSeries *like, CagSeries *out),
                         CagSeries *out) {
  CagVm *vm = f->vm;
  CagValue arguments[2], given;
  const uint32_t outer = vm->differentiation;
  if (like->order > 0) vm->differentiation = outer + 1;
  like->level = vm->differentiation;
  for (int i = 0; i < f->variables; i++) {
    const bool angle = f->angular[i];
    const double x = angle ? degrees_of(at[i]) : at[i];
    if (like->order > 0)
      arguments[i] = cag_jet_variable(vm, f->variables, like->order, like->level, i, x,
                                      angle ? DEGREES_PER_RADIAN : 1, angle);
    else arguments[i] = angle ? cag_angle(x) : cag_number(x);
  }
  bool ok = cag_call(vm, vm->kept[f->slot], arguments, (size_t)f->variables, &given) &&
            read(f, at, given, like, out);
  vm->differentiation = outer;
  return ok;
}

// Returns the status of a failed call. The machine holds the error.
static CagStatus fail_callback(const CagVm *vm, CagError *err) {
  return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_function_failed, "", -1, "%s",
                  vm->errors.count ? vm->errors.items[0].message : "the function failed");
}

// --- Curves ---

typedef struct CurveQuestion {
  Formula *formula;
  double t;
  int order;
  CagVec3 *out;
} CurveQuestion;

static bool answer_curve(CagVm *vm, void *context) {
  (void)vm;
  CurveQuestion *q = context;
  CagSeries like = {.variables = 1, .order = q->order}, x[3];
  if (!call_formula(q->formula, &q->t, &like, read_point, x)) return false;
  double factorial = 1;
  for (int k = 0; k <= q->order; k++) {
    if (k > 1) factorial *= k;
    q->out[k] = cag_vec3(factorial * x[0].c[k], factorial * x[1].c[k], factorial * x[2].c[k]);
  }
  return true;
}

static CagStatus curve_eval(void *context, double t, int order, CagVec3 *out, CagError *err) {
  Formula *f = context;
  CurveQuestion q = {f, t, order, out};
  return cag_vm_call_back(f->vm, answer_curve, &q) ? CAG_OK : fail_callback(f->vm, err);
}

// Reads a parameter range with finite ends; angles become radians.
static bool read_domain(CagCall *call, int argument, CagRangeEnds *out) {
  if (!cag_arg_interval(call, argument, &out->start, &out->end, &out->angle)) return false;
  if (!isfinite(out->start) || !isfinite(out->end))
    return cag_fail_value(call, argument, "a range with finite ends");
  if (out->angle) out->start *= CAG_RADIANS_PER_DEGREE;
  if (out->angle) out->end *= CAG_RADIANS_PER_DEGREE;
  return true;
}

bool cag_functions_curve(CagCall *call, const struct cag_functions_curve *a, CagValue *result) {
  CagRangeEnds t;
  if (!read_domain(call, 1, &t)) return false;
  Formula *f = formula_new(call, a->f, 1);
  f->angular[0] = t.angle;
  // The first point determines whether the curve lies in the plane or in space.
  CagVec3 p;
  CagCurve *c = NULL;
  const CagCurveFunction geometry = {.eval = curve_eval, .release = formula_free, .context = f};
  CagStatus status = t.start < t.end ? curve_eval(f, t.start, 0, &p, call->err) : CAG_OK;
  if (!status)
    status = cag_curve_function(&geometry, f->coordinates == 2 ? 2 : 3, t.start, t.end, t.angle, &c,
                                call->err);
  if (!cag_geometry_ok(call, status)) return false;
  cag_give_held(call, f);
  *result = cag_curve_value(call->vm, c);
  return true;
}

// --- Curves from natural equations ---

typedef struct Equations {
  Formula *curvature, *torsion; // torsion may be NULL
} Equations;

static void equations_free(void *context) {
  Equations *e = context;
  formula_free(e->curvature);
  if (e->torsion) formula_free(e->torsion);
  cag_free(e);
}

static bool read_number(Formula *f, const double *at, CagValue given, const CagSeries *like,
                        CagSeries *out) {
  if (!coordinate(f->vm, given, like, out)) {
    if (f->vm->failed) return false;
    char found[160], where[32];
    return cag_vm_fail_in(
        f->vm, f->vm->kept[f->slot], CAG_ERR_type,
        "curvature and torsion must be numbers; at s = %s, the function returned %s",
        cag_number_text(*at, where), cag_value_words(f->vm, given, found, sizeof found));
  }
  for (size_t k = 0; k < cag_jet_count(1, like->order); k++)
    if (!isfinite(out->c[k])) return fail_not_finite(f, at, k ? "a derivative" : "the value");
  return true;
}

typedef struct EquationQuestion {
  Equations *equations;
  double s;
  int order;
  double *curvature, *torsion;
} EquationQuestion;

static bool answer_equation(CagVm *vm, void *context) {
  (void)vm;
  EquationQuestion *q = context;
  Formula *const formulas[2] = {q->equations->curvature, q->equations->torsion};
  double *const out[2] = {q->curvature, q->torsion};
  for (int i = 0; i < 2; i++) {
    CagSeries like = {.variables = 1, .order = q->order}, x;
    cag_series_constant(&like, 0, &x);
    if (formulas[i] && !call_formula(formulas[i], &q->s, &like, read_number, &x)) return false;
    for (int k = 0; k <= q->order; k++) out[i][k] = x.c[k];
  }
  return true;
}

static CagStatus equations_eval(void *context, double s, int order, double *curvature,
                                double *torsion, CagError *err) {
  Equations *e = context;
  EquationQuestion q = {e, s, order, curvature, torsion};
  CagVm *vm = e->curvature->vm;
  return cag_vm_call_back(vm, answer_equation, &q) ? CAG_OK : fail_callback(vm, err);
}

bool cag_functions_natural_curve(CagCall *call, const struct cag_functions_natural_curve *a,
                                 CagValue *result) {
  const bool twisted = cag_given(call, 2);
  CagCurve *c;
  Equations *e = cag_hold_array(call, 1, sizeof *e);
  e->curvature = formula_new(call, a->curvature, 1);
  if (twisted) e->torsion = formula_new(call, a->torsion, 1);
  const CagNaturalEquations equations = {equations_eval, equations_free, e};
  CagStatus status = cag_curve_natural(&equations, a->length, &a->frame,
                                       twisted || !a->frame.planar ? 3 : 2, &c, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  cag_give_held(call, e->torsion);
  cag_give_held(call, e->curvature);
  cag_give_held(call, e);
  *result = cag_curve_value(call->vm, c);
  return true;
}

// --- Surfaces ---

typedef struct SurfaceQuestion {
  Formula *formula;
  double u;
  const double *vs;
  size_t nv;
  int order;
  CagVec3 *out;
  bool row; // true: S, S_u, S_v at all vs; false: all partial derivatives at the only v
} SurfaceQuestion;

static CagVec3 coefficient(const CagSeries *x, size_t k, double factor) {
  return cag_vec3(factor * x[0].c[k], factor * x[1].c[k], factor * x[2].c[k]);
}

static bool answer_surface(CagVm *vm, void *context) {
  (void)vm;
  SurfaceQuestion *q = context;
  const int n = q->order;
  CagSeries like = {.variables = 2, .order = n}, x[3];
  double factorial[CAG_MAX_PARTIAL + 1] = {1};
  for (int i = 1; i <= n; i++) factorial[i] = factorial[i - 1] * i;
  for (size_t k = 0; k < q->nv; k++) {
    const double at[2] = {q->u, q->vs[k]};
    if (!call_formula(q->formula, at, &like, read_point, x)) return false;
    const size_t count = n ? 3 : 1;
    for (size_t i = 0; q->row && i < count; i++) q->out[k * count + i] = coefficient(x, i, 1);
    for (int i = 0; !q->row && i <= n; i++)
      for (int j = 0; i + j <= n; j++)
        q->out[cag_partial(n, i, j)] =
            coefficient(x, cag_jet_offset(2, i + j) + (size_t)j, factorial[i] * factorial[j]);
  }
  return true;
}

static CagStatus surface_eval(void *context, double u, double v, int n, CagVec3 *out,
                              CagError *err) {
  Formula *f = context;
  SurfaceQuestion q = {f, u, &v, 1, n, out, false};
  return cag_vm_call_back(f->vm, answer_surface, &q) ? CAG_OK : fail_callback(f->vm, err);
}

static CagStatus surface_row(void *context, double u, const double *vs, size_t nv, int n,
                             CagVec3 *out, CagError *err) {
  Formula *f = context;
  SurfaceQuestion q = {f, u, vs, nv, n, out, true};
  return cag_vm_call_back(f->vm, answer_surface, &q) ? CAG_OK : fail_callback(f->vm, err);
}

bool cag_functions_surface(CagCall *call, const struct cag_functions_surface *a, CagValue *result) {
  CagRangeEnds u = {0, 1, false}, v = {0, 1, false};
  if ((cag_given(call, 1) && !read_domain(call, 1, &u)) ||
      (cag_given(call, 2) && !read_domain(call, 2, &v)))
    return false;
  Formula *f = formula_new(call, a->f, 2);
  f->angular[0] = u.angle;
  f->angular[1] = v.angle;
  const CagSurfaceFunction geometry = {
      .eval = surface_eval, .eval_row = surface_row, .release = formula_free, .context = f};
  CagSurface *s;
  CagStatus status = cag_surface_function(&geometry, u.start, u.end, u.angle, v.start, v.end,
                                          v.angle, &s, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  cag_give_held(call, f);
  *result = cag_surface_value(call->vm, s);
  return true;
}
