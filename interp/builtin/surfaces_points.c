// Control points of Bezier and B-spline surfaces: which act where, what they are multiplied by,
// edits of corners and edges, and the patches' other forms.

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geom/basis/bernstein.h"
#include "geom/basis/bspline.h"
#include "geom/basis/knots.h"
#include "geom/mesh/mesh.h"
#include "geom/surface/edit.h"
#include "geom/surface/reshape.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"

static const char *const directions[] = {"u", "v"};

static CagValue vector_value(CagVm *vm, CagVec3 p) {
  return cag_vector(vm, (double[]){p.x, p.y, p.z}, 3);
}

// --- One direction of a net ---

typedef struct Axis {
  int degree;
  size_t count, distinct;
  bool periodic;
  const double *knots;
} Axis;

// A surface with control points: its view and the two axes.
typedef struct Net {
  CagSurface *s;
  CagSurfaceNurbsView view;
  Axis axis[2];
} Net;

static bool read_net(CagCall *call, Net *n) {
  if (!cag_arg_surface(call, 0, &n->s)) return false;
  if (!cag_surface_nurbs_view(n->s, &n->view)) {
    cag_fail(call->err, CAG_E_UNSUPPORTED, CAG_ERR_no_control_points, "", -1,
             "a surface of kind %s has no control points; `to_nurbs` gives its rational form where "
             "there is one",
             n->s->kind->name);
    return cag_fail_geometry(call, call->err);
  }
  const CagSurfaceNurbsView *v = &n->view;
  n->axis[0] = (Axis){v->degree_u, v->nu, v->distinct_u, v->periodic_u, v->knots_u};
  n->axis[1] = (Axis){v->degree_v, v->nv, v->distinct_v, v->periodic_v, v->knots_v};
  return true;
}

// u and v within the domain.
static bool read_place(CagCall *call, const Net *n, int at, double t[2]) {
  CagVec3 p;
  return cag_arg_uv(call, n->s, at, &t[0], &t[1]) &&
         cag_geometry_ok(call, cag_surface_point(n->s, t[0], t[1], &p, call->err));
}

static CagValue range_of(CagVm *vm, double from, double to) {
  return cag_range_new(vm, from, to, 1, false, false, false);
}

static CagValue spans_value(CagVm *vm, const Axis *a) {
  CagBuilder *list = cag_builder_new(vm);
  for (size_t i = (size_t)a->degree; i < a->count; i++)
    if (a->knots[i] < a->knots[i + 1])
      cag_builder_add(vm, list, range_of(vm, a->knots[i], a->knots[i + 1]));
  return cag_builder_finish(vm, list);
}

bool cag_tensors_spans(CagCall *call, CagValue *result) {
  Net n;
  if (!read_net(call, &n)) return false;
  CagValue values[] = {spans_value(call->vm, &n.axis[0]), spans_value(call->vm, &n.axis[1])};
  *result = cag_record_new(call->vm, directions, values, 2);
  return true;
}

// As of curves: a range, of a closed direction a list of ranges.
static CagValue support_value(CagVm *vm, const Axis *a, size_t i) {
  size_t p = (size_t)a->degree;
  double lo = a->knots[p], hi = a->knots[a->count], from = 0, to = 0;
  CagBuilder *list = cag_builder_new(vm);
  for (size_t k = i; k < a->count; k += a->distinct) {
    double b = fmax(a->knots[k], lo), e = fmin(a->knots[k + p + 1], hi);
    if (!(b < e)) continue;
    if (from < to && b > to) cag_builder_add(vm, list, range_of(vm, from, to));
    from = from < to && b <= to ? from : b;
    to = e;
  }
  CagValue last = from < to ? range_of(vm, from, to) : cag_none();
  if (!a->periodic) return last;
  cag_builder_add(vm, list, last);
  return cag_builder_finish(vm, list);
}

bool cag_tensors_support(CagCall *call, CagValue *result) {
  Net n;
  long i, j;
  if (!read_net(call, &n) || !cag_arg_integer(call, 1, 0, (long)n.axis[0].distinct - 1, &i) ||
      !cag_arg_integer(call, 2, 0, (long)n.axis[1].distinct - 1, &j))
    return false;
  CagValue values[] = {support_value(call->vm, &n.axis[0], (size_t)i),
                       support_value(call->vm, &n.axis[1], (size_t)j)};
  *result = cag_record_new(call->vm, directions, values, 2);
  return true;
}

static CagValue point_value(CagVm *vm, const double *h) {
  return h[3] > 0 ? vector_value(vm, cag_project(h)) : cag_none();
}

static CagValue indices_value(CagVm *vm, const Axis *a, size_t span) {
  double *out;
  CagValue list = cag_list_numbers(vm, (size_t)a->degree + 1, &out);
  for (size_t i = span - (size_t)a->degree; i <= span; i++) *out++ = (double)(i % a->distinct);
  return list;
}

bool cag_arg_surface_sides(CagCall *call, int argument, CagSide out[2]) {
  static const char *const sides[] = {"right", "left", NULL};
  CagValue v = call->values[argument];
  out[0] = out[1] = CAG_SIDE_RIGHT;
  if (v.type == CAG_UNSET) return true;
  for (int k = 0; k < 2; k++) {
    CagValue one = v;
    if (v.type == CAG_LIST && CAG_AS_LIST(v)->length == 2)
      one = cag_list_get(call->vm, CAG_AS_LIST(v), (size_t)k);
    bool known = one.type == CAG_TEXT && (strcmp(CAG_AS_TEXT(one)->bytes, sides[0]) == 0 ||
                                          strcmp(CAG_AS_TEXT(one)->bytes, sides[1]) == 0);
    if (!known) return cag_fail_value(call, argument, "\"right\" or \"left\", or two for u and v");
    if (strcmp(CAG_AS_TEXT(one)->bytes, sides[1]) == 0) out[k] = CAG_SIDE_LEFT;
  }
  return true;
}

bool cag_tensors_acting_points(CagCall *call, CagValue *result) {
  static const char *const names[] = {"u", "v", "rows", "columns", "points"};
  Net n;
  double t[2];
  CagSide side[2];
  if (!read_net(call, &n) || !read_place(call, &n, 1, t) || !cag_arg_surface_sides(call, 3, side))
    return false;
  size_t span[2];
  CagValue values[5];
  for (int k = 0; k < 2; k++) {
    const Axis *a = &n.axis[k];
    span[k] = cag_knots_span(a->knots, a->count, a->degree, t[k], side[k] == CAG_SIDE_LEFT,
                             (size_t)a->degree);
    values[k] = range_of(call->vm, a->knots[span[k]], a->knots[span[k] + 1]);
    values[2 + k] = indices_value(call->vm, a, span[k]);
  }
  CagBuilder *rows = cag_builder_new(call->vm);
  for (size_t i = span[0] - (size_t)n.axis[0].degree; i <= span[0]; i++) {
    CagBuilder *row = cag_builder_new(call->vm);
    for (size_t j = span[1] - (size_t)n.axis[1].degree; j <= span[1]; j++)
      if (!cag_builder_add(call->vm, row,
                           point_value(call->vm, n.view.homogeneous + 4 * (i * n.view.nv + j))))
        return false;
    if (!cag_builder_add(call->vm, rows, cag_builder_finish(call->vm, row))) return false;
  }
  values[4] = cag_builder_finish(call->vm, rows);
  *result = cag_record_new(call->vm, names, values, 5);
  return true;
}

// --- Basis ---

// Values at t of the functions of all distinct points; held.
static double *basis_line(CagCall *call, const Axis *a, double t) {
  double *out = cag_hold_array(call, a->distinct, sizeof *out);
  size_t p = (size_t)a->degree;
  double *values = cag_hold_array(call, p + 1, sizeof *values);
  size_t span = cag_knots_span(a->knots, a->count, a->degree, t, false, p);
  cag_bspline_basis(a->knots, a->degree, span, t, values);
  for (size_t i = 0; i <= p; i++) out[(span - p + i) % a->distinct] += values[i];
  return out;
}

bool cag_tensors_basis(CagCall *call, CagValue *result) {
  Net n;
  double t[2], sum = 0;
  if (!read_net(call, &n) || !read_place(call, &n, 1, t)) return false;
  double *bu = basis_line(call, &n.axis[0], t[0]), *bv = basis_line(call, &n.axis[1], t[1]);
  size_t nu = n.axis[0].distinct, nv = n.axis[1].distinct;
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j < nv; j++)
      sum += bu[i] * bv[j] * n.view.homogeneous[4 * (i * n.view.nv + j) + 3];
  if (!(sum > 0)) {
    cag_fail(call->err, CAG_E_DEGENERATE, CAG_ERR_zero_denominator, "", -1,
             "all weights that act at this point are 0: give one of them a positive value");
    return cag_fail_geometry(call, call->err);
  }
  CagBuilder *rows = cag_builder_new(call->vm);
  for (size_t i = 0; i < nu; i++) {
    double *out;
    CagValue row = cag_list_numbers(call->vm, nv, &out);
    for (size_t j = 0; j < nv; j++)
      out[j] = bu[i] * bv[j] * n.view.homogeneous[4 * (i * n.view.nv + j) + 3] / sum;
    if (!cag_builder_add(call->vm, rows, row)) return false;
  }
  *result = cag_builder_finish(call->vm, rows);
  return true;
}

// --- Numerator and denominator ---

// The polynomial surface of the points times their weights, or of the weights as z.
static bool homogeneous_part(CagCall *call, const Net *n, bool weights, CagSurface **out) {
  const CagSurfaceNurbsView *v = &n->view;
  CagVec3 *net = cag_hold(call, cag_malloc(v->nu * v->nv * sizeof *net));
  for (size_t i = 0; i < v->nu * v->nv; i++) {
    const double *h = v->homogeneous + 4 * i;
    net[i] = weights ? cag_vec3(0, 0, h[3]) : cag_vec3(h[0], h[1], h[2]);
  }
  CagStatus status = cag_surface_nurbs(net, NULL, v->nu, v->nv, v->degree_u, v->degree_v,
                                       v->knots_u, v->knots_v, out, call->err);
  return cag_geometry_ok(call, status);
}

static bool part_at(CagCall *call, bool weights, CagVec3 *out) {
  Net n;
  double u, v;
  long du, dv;
  CagSurface *part = NULL;
  CagVec3 d[(CAG_MAX_PARTIAL + 1) * (CAG_MAX_PARTIAL + 1)];
  if (!read_net(call, &n) || !cag_arg_uv(call, n.s, 1, &u, &v) ||
      !cag_arg_integer_or(call, 3, 0, 0, CAG_MAX_PARTIAL, &du) ||
      !cag_arg_integer_or(call, 4, 0, 0, CAG_MAX_PARTIAL - du, &dv) ||
      !homogeneous_part(call, &n, weights, &part))
    return false;
  int order = (int)(du + dv);
  CagStatus status =
      cag_surface_eval(part, u, v, order, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, call->err);
  cag_surface_release(part);
  if (!cag_geometry_ok(call, status)) return false;
  *out = d[cag_partial(order, (int)du, (int)dv)];
  return true;
}

bool cag_tensors_numerator(CagCall *call, CagValue *result) {
  CagVec3 d;
  if (!part_at(call, false, &d)) return false;
  *result = vector_value(call->vm, d);
  return true;
}

bool cag_tensors_denominator(CagCall *call, CagValue *result) {
  CagVec3 d;
  if (!part_at(call, true, &d)) return false;
  *result = cag_number(d.z);
  return true;
}

// --- Polynomials ---

// Powers of one direction from Bernstein points, in place: n + 1 rows of `width` points, of the
// parameter from 0 to `length`.
static void to_powers(CagVec3 *b, int n, size_t width, double length) {
  // Forward differences, each row below the one that it is taken from.
  for (int k = 1; k <= n; k++)
    for (int i = n; i >= k; i--)
      for (size_t c = 0; c < width; c++)
        b[(size_t)i * width + c] =
            cag_sub(b[(size_t)i * width + c], b[(size_t)(i - 1) * width + c]);
  double power = 1;
  for (int i = 0; i <= n; i++, power *= length)
    for (size_t c = 0; c < width; c++)
      b[(size_t)i * width + c] = cag_scaled(b[(size_t)i * width + c], cag_binomial(n, i) / power);
}

static CagValue table_of(CagVm *vm, const CagVec3 *p, size_t n, size_t m) {
  CagBuilder *rows = cag_builder_new(vm);
  for (size_t i = 0; i < n; i++) cag_builder_add(vm, rows, cag_points_value(vm, p + i * m, m, 3));
  return cag_builder_finish(vm, rows);
}

static CagValue piece_powers(CagCall *call, const CagSurface *piece, double lu, double lv) {
  CagSurfaceNurbsView v;
  cag_surface_nurbs_view(piece, &v);
  size_t n = v.nu, m = v.nv;
  CagVec3 *b = cag_hold(call, cag_malloc(2 * n * m * sizeof *b));
  CagVec3 *turned = b + n * m;
  for (size_t i = 0; i < n * m; i++) b[i] = cag_project(v.homogeneous + 4 * i);
  to_powers(b, (int)n - 1, m, lu);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < m; j++) turned[j * n + i] = b[i * m + j];
  to_powers(turned, (int)m - 1, n, lv);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < m; j++) b[i * m + j] = turned[j * n + i];
  CagValue table = table_of(call->vm, b, n, m);
  cag_release_held(call, b);
  return table;
}

static size_t span_lengths(const Axis *a, double *out) {
  size_t n = 0;
  for (size_t i = (size_t)a->degree; i < a->count; i++)
    if (a->knots[i] < a->knots[i + 1]) out[n++] = a->knots[i + 1] - a->knots[i];
  return n;
}

bool cag_tensors_polynomials(CagCall *call, CagValue *result) {
  Net n;
  size_t nu, nv;
  if (!read_net(call, &n)) return false;
  if (n.view.rational) {
    cag_fail(call->err, CAG_E_UNSUPPORTED, CAG_ERR_rational_patch, "", -1,
             "the surface has weights, so it is not a polynomial: ask for `numerator` and "
             "`denominator`");
    return cag_fail_geometry(call, call->err);
  }
  double *lu = cag_hold_array(call, n.axis[0].count, sizeof *lu);
  double *lv = cag_hold_array(call, n.axis[1].count, sizeof *lv);
  span_lengths(&n.axis[0], lu);
  span_lengths(&n.axis[1], lv);
  CagSurfaceArray *pieces = cag_hold_surfaces(call);
  CagStatus status = cag_surface_to_bezier(n.s, &pieces->items, &nu, &nv, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  pieces->count = nu * nv;
  CagBuilder *rows = cag_builder_new(call->vm);
  for (size_t i = 0; i < nu; i++) {
    CagBuilder *row = cag_builder_new(call->vm);
    for (size_t j = 0; j < nv; j++)
      if (!cag_builder_add(call->vm, row,
                           piece_powers(call, pieces->items[i * nv + j], lu[i], lv[j])))
        return false;
    if (!cag_builder_add(call->vm, rows, cag_builder_finish(call->vm, row))) return false;
  }
  *result = cag_builder_finish(call->vm, rows);
  return true;
}

// --- Corners ---

bool cag_tensors_patch_corners(CagCall *call, CagValue *result) {
  static const char *const names[] = {"corners", "tangents_u", "tangents_v", "twists"};
  CagSurface *s;
  CagHermiteCorners c;
  if (!cag_arg_surface(call, 0, &s) ||
      !cag_geometry_ok(call, cag_surface_corners(s, &c, call->err)))
    return false;
  CagValue values[] = {table_of(call->vm, c.p[0], 2, 2), table_of(call->vm, c.pu[0], 2, 2),
                       table_of(call->vm, c.pv[0], 2, 2), table_of(call->vm, c.puv[0], 2, 2)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

bool cag_tensors_hermite_matrix(CagCall *call, CagValue *result) {
  CagSurface *s;
  CagHermiteCorners c;
  if (!cag_arg_surface(call, 0, &s) ||
      !cag_geometry_ok(call, cag_surface_hermite_corners(s, &c, call->err)))
    return false;
  CagVec3 q[16];
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      q[4 * i + j] = c.p[i][j];
      q[4 * i + 2 + j] = c.pv[i][j];
      q[4 * (2 + i) + j] = c.pu[i][j];
      q[4 * (2 + i) + 2 + j] = c.puv[i][j];
    }
  *result = table_of(call->vm, q, 4, 4);
  return true;
}

// A number scales what is there, a vector takes its place.
static bool read_edit(CagCall *call, int argument, CagCornerEdit *e, int k) {
  e->factor[k] = 1;
  if (!cag_given(call, argument)) return true;
  if (call->values[argument].type == CAG_NUMBER)
    return cag_arg_finite(call, argument, &e->factor[k]);
  e->by_vector[k] = true;
  return cag_arg_vec(call, argument, &e->vector[k], NULL);
}

// S, u, v, tangent_u, tangent_v, twist
bool cag_tensors_edit_corner(CagCall *call, CagValue *result) {
  CagSurface *s, *out = NULL;
  CagCornerEdit e = {0};
  long u, v;
  if (!cag_arg_surface(call, 0, &s) || !cag_arg_integer(call, 1, 0, 1, &u) ||
      !cag_arg_integer(call, 2, 0, 1, &v))
    return false;
  e.u = (int)u;
  e.v = (int)v;
  for (int k = 0; k < 3; k++)
    if (!read_edit(call, 3 + k, &e, k)) return false;
  return cag_surface_result(call, cag_surface_edit_corner(s, &e, &out, call->err), &out, result);
}

bool cag_tensors_set_point(CagCall *call, CagValue *result) {
  CagSurface *s, *out = NULL;
  CagVec3 p;
  long i, j;
  double weight = -1;
  if (!cag_arg_surface(call, 0, &s) || !cag_arg_integer(call, 1, 0, LONG_MAX, &i) ||
      !cag_arg_integer(call, 2, 0, LONG_MAX, &j) || !cag_arg_vec(call, 3, &p, NULL))
    return false;
  if (cag_given(call, 4)) {
    if (!cag_arg_finite(call, 4, &weight)) return false;
    if (weight < 0) {
      char text[32];
      cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_negative_weight, "weight", -1,
               "`weight` must not be negative, it is %s", cag_number_text(weight, text));
      return cag_fail_geometry(call, call->err);
    }
  }
  CagStatus status = cag_surface_set_point(s, (size_t)i, (size_t)j, p, weight, &out, call->err);
  return cag_surface_result(call, status, &out, result);
}

// --- Edges ---

static const char *const sides[] = {"u0", "u1", "v0", "v1", NULL};

static bool read_match(CagCall *call, int ratio, int shear, CagEdgeMatch *how) {
  const double *x;
  size_t n;
  *how = (CagEdgeMatch){1, {0, 0}};
  if (!cag_arg_number_or(call, ratio, 1, &how->ratio)) return false;
  if (!cag_given(call, shear)) return true;
  if (call->values[shear].type == CAG_NUMBER) {
    if (!cag_arg_finite(call, shear, &how->shear[0])) return false;
    how->shear[1] = how->shear[0];
    return true;
  }
  if (!cag_as_vector(call->values[shear], &x, &n) || n != 2 || !isfinite(x[0] + x[1]))
    return cag_fail_value(call, shear, "a number, or two for the ends of the edge");
  how->shear[0] = x[0];
  how->shear[1] = x[1];
  return true;
}

// S, edge, ratio, shear, degree
bool cag_tensors_bezier_join(CagCall *call, CagValue *result) {
  static const char *const order[] = {"u1", "u0", "v0", "v1", NULL}; // the default comes first
  static const int SIDE[] = {1, 0, 2, 3};
  static const char *const names[] = {"points", "weights"};
  CagSurface *s;
  CagEdgeMatch how;
  int edge;
  long degree;
  double *lines = NULL;
  size_t n = 0;
  CagSurfaceNurbsView v;
  if (!cag_arg_surface(call, 0, &s) || !cag_arg_choice(call, 1, order, &edge) ||
      !read_match(call, 2, 3, &how))
    return false;
  int side = SIDE[edge];
  bool known = cag_surface_nurbs_view(s, &v);
  long usual = !known ? 3 : side < 2 ? v.degree_u : v.degree_v;
  if (!cag_arg_integer_or(call, 4, usual, 1, 1000, &degree)) return false;
  CagStatus status = cag_surface_join_lines(s, side, (int)degree, &how, &lines, &n, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_for(call, cag_free, lines);
  CagBuilder *rows = cag_builder_new(call->vm), *weights = cag_builder_new(call->vm);
  for (size_t i = 0; i < 2; i++) {
    CagBuilder *row = cag_builder_new(call->vm);
    double *w;
    CagValue list = cag_list_numbers(call->vm, n, &w);
    for (size_t j = 0; j < n; j++) {
      const double *h = lines + 4 * (i * n + j);
      w[j] = h[3];
      if (!cag_builder_add(call->vm, row, point_value(call->vm, h))) return false;
    }
    if (!cag_builder_add(call->vm, rows, cag_builder_finish(call->vm, row))) return false;
    if (!cag_builder_add(call->vm, weights, list)) return false;
  }
  CagValue values[] = {cag_builder_finish(call->vm, rows), cag_builder_finish(call->vm, weights)};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

// A list of two sides, or none.
bool cag_arg_edges(CagCall *call, int argument, int out[2], bool *given) {
  CagValue v = call->values[argument];
  *given = cag_given(call, argument);
  if (!*given) return true;
  const bool both = v.type == CAG_TEXT;
  bool good = both || (v.type == CAG_LIST && CAG_AS_LIST(v)->length == 2);
  for (int k = 0; good && k < 2; k++) {
    CagValue one = both ? v : cag_list_get(call->vm, CAG_AS_LIST(v), (size_t)k);
    out[k] = 0;
    while (sides[out[k]] && one.type == CAG_TEXT &&
           strcmp(sides[out[k]], CAG_AS_TEXT(one)->bytes) != 0)
      out[k]++;
    good = one.type == CAG_TEXT && sides[out[k]];
  }
  return good ||
         cag_fail_value(call, argument,
                        "a side of both surfaces, such as \"u1\" (u0, u1, v0, v1), or one of "
                        "each, such as [\"u1\", \"u0\"]");
}

// A, B, ratio, shear, edges
bool cag_tensors_match_edge(CagCall *call, CagValue *result) {
  CagSurface *a, *b, *out = NULL;
  CagEdgeMatch how;
  int edges[2];
  bool given;
  if (!cag_arg_surface(call, 0, &a) || !cag_arg_surface(call, 1, &b) ||
      !read_match(call, 2, 3, &how) || !cag_arg_edges(call, 4, edges, &given))
    return false;
  CagStatus status = cag_surface_match(a, b, &how, given ? edges : NULL, &out, call->err);
  if (!cag_surface_result(call, status, &out, result)) return false;
  cag_shape_say_alike(*result, call->values[1]);
  return true;
}

// --- Flat and creased places ---

bool cag_tensors_creases(CagCall *call, CagValue *result) {
  static const char *const names[] = {"at", "angle"};
  CagSurface *s;
  CagValue both[2];
  if (!cag_arg_surface(call, 0, &s)) return false;
  for (int k = 0; k < 2; k++) {
    CagCrease *found = NULL;
    size_t n = 0;
    if (!cag_geometry_ok(call, cag_surface_creases(s, k, &found, &n, call->err))) return false;
    cag_hold_for(call, cag_free, found);
    CagBuilder *list = cag_builder_new(call->vm);
    for (size_t i = 0; i < n; i++) {
      CagValue values[] = {cag_parameter_value(k == 0 ? s->angular_u : s->angular_v, found[i].at),
                           cag_angle(found[i].angle / CAG_RADIANS_PER_DEGREE)};
      if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 2)))
        return false;
    }
    both[k] = cag_builder_finish(call->vm, list);
  }
  *result = cag_record_new(call->vm, directions, both, 2);
  return true;
}

// Control points that miss their common plane by less than this part of their extent are in it.
#define FLAT 1e-9

// Whether all acting points lie in a plane.
static bool acting_flat(const Net *n, size_t su, size_t sv) {
  size_t p = (size_t)n->axis[0].degree, q = (size_t)n->axis[1].degree, nv = n->view.nv;
  const double *h = n->view.homogeneous;
  CagVec3 origin = cag_vec3(0, 0, 0), along = origin, normal = origin;
  double reach = 0;
  // The farthest from the first, then the farthest from that line, then all from the plane.
  for (int pass = 0; pass < 3; pass++) {
    double most = 0;
    CagVec3 best = origin;
    bool first = true;
    for (size_t i = su - p; i <= su; i++)
      for (size_t j = sv - q; j <= sv; j++) {
        const double *at = h + 4 * (i * nv + j);
        if (!(at[3] > 0)) continue;
        CagVec3 x = cag_project(at);
        if (first && pass == 0) origin = x;
        first = false;
        CagVec3 d = cag_sub(x, origin), c = pass == 1 ? cag_cross(along, d) : d;
        double size = pass == 2 ? fabs(cag_dot(normal, d)) : cag_norm(c);
        if (size > most) most = size, best = c;
      }
    if (pass == 0) reach = most, along = cag_unit(best);
    if (pass == 1) normal = most > FLAT * reach ? cag_unit(best) : cag_vec3(0, 0, 0);
    if (pass == 2) return most <= FLAT * reach;
  }
  return true;
}

bool cag_tensors_flat_spans(CagCall *call, CagValue *result) {
  Net n;
  if (!read_net(call, &n)) return false;
  const Axis *u = &n.axis[0], *v = &n.axis[1];
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = (size_t)u->degree; i < u->count; i++)
    for (size_t j = (size_t)v->degree; j < v->count; j++) {
      if (!(u->knots[i] < u->knots[i + 1] && v->knots[j] < v->knots[j + 1])) continue;
      if (!acting_flat(&n, i, j)) continue;
      CagValue values[] = {range_of(call->vm, u->knots[i], u->knots[i + 1]),
                           range_of(call->vm, v->knots[j], v->knots[j + 1])};
      if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, directions, values, 2)))
        return false;
    }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

// --- The net as a mesh ---

bool cag_tensors_net_mesh(CagCall *call, CagValue *result) {
  Net n;
  CagMesh *m = NULL;
  if (!read_net(call, &n)) return false;
  const CagSurfaceNurbsView *v = &n.view;
  size_t nu = v->distinct_u, nv = v->distinct_v;
  size_t cu = v->periodic_u ? nu : nu - 1, cv = v->periodic_v ? nv : nv - 1;
  for (size_t i = 0; i < nu * nv; i++)
    if (!(v->homogeneous[4 * (i / nv * v->nv + i % nv) + 3] > 0)) {
      cag_fail(
          call->err, CAG_E_DEGENERATE, CAG_ERR_zero_denominator, "", (long)i,
          "control point [%zu, %zu] has the weight 0 and so no place: the net has a hole there",
          i / nv, i % nv);
      return cag_fail_geometry(call, call->err);
    }
  if (!cag_geometry_ok(call,
                       cag_mesh_new(nu * nv, 2 * cu * cv, false, false, false, &m, call->err)))
    return false;
  for (size_t i = 0; i < nu * nv; i++)
    m->positions[i] = cag_project(v->homogeneous + 4 * (i / nv * v->nv + i % nv));
  uint32_t *t = m->triangles;
  for (size_t i = 0; i < cu; i++)
    for (size_t j = 0; j < cv; j++) {
      uint32_t a = (uint32_t)(i * nv + j), b = (uint32_t)((i + 1) % nu * nv + j);
      uint32_t c = (uint32_t)((i + 1) % nu * nv + (j + 1) % nv),
               d = (uint32_t)(i * nv + (j + 1) % nv);
      double ac = cag_norm(cag_sub(m->positions[a], m->positions[c]));
      double bd = cag_norm(cag_sub(m->positions[b], m->positions[d]));
      const uint32_t by_ac[6] = {a, b, c, a, c, d}, by_bd[6] = {a, b, d, b, c, d};
      memcpy(t, ac <= bd ? by_ac : by_bd, sizeof by_ac);
      t += 6;
    }
  *result = cag_mesh_value(call->vm, m);
  return true;
}
