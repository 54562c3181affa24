// Control points of Bezier and B-spline surfaces: which act where, what they are multiplied by,
// edits of corners and edges, and the patches' other forms.

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

// --- One direction of a net ---

typedef struct Axis {
  int degree;
  size_t count, distinct;
  bool periodic;
  const double *knots;
} Axis;

// A surface with control points: its view and the two axes.
typedef struct Net {
  const CagSurface *s;
  CagSurfaceNurbsView view;
  Axis axis[2];
} Net;

static bool read_net(CagCall *call, const CagSurface *s, Net *n) {
  const CagSurfaceNurbsView *v = &n->view;
  n->s = s;
  if (!cag_surface_net(call, s, "control points", &n->view)) return false;
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

bool cag_tensors_spans(CagCall *call, const struct cag_tensors_spans *a, CagValue *result) {
  Net n;
  if (!read_net(call, a->S, &n)) return false;
  *result =
      cag_uv_value(call->vm, spans_value(call->vm, &n.axis[0]), spans_value(call->vm, &n.axis[1]));
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

bool cag_tensors_support(CagCall *call, const struct cag_tensors_support *a, CagValue *result) {
  Net n;
  long i, j;
  if (!read_net(call, a->S, &n) || !cag_arg_integer(call, 1, 0, (long)n.axis[0].distinct - 1, &i) ||
      !cag_arg_integer(call, 2, 0, (long)n.axis[1].distinct - 1, &j))
    return false;
  *result = cag_uv_value(call->vm, support_value(call->vm, &n.axis[0], (size_t)i),
                         support_value(call->vm, &n.axis[1], (size_t)j));
  return true;
}

static CagValue point_value(CagVm *vm, const double *h) {
  return h[3] > 0 ? cag_point(vm, cag_project(h), 3) : cag_none();
}

// Rows of points, which lie `stride` apart.
static CagValue net_value(CagVm *vm, const double *h, size_t rows, size_t columns, size_t stride) {
  CagBuilder *table = cag_builder_new(vm);
  for (size_t i = 0; i < rows; i++) {
    CagBuilder *row = cag_builder_new(vm);
    for (size_t j = 0; j < columns; j++)
      cag_builder_add(vm, row, point_value(vm, h + 4 * (i * stride + j)));
    cag_builder_add(vm, table, cag_builder_finish(vm, row));
  }
  return cag_builder_finish(vm, table);
}

static CagValue indices_value(CagVm *vm, const Axis *a, size_t span) {
  double *out;
  CagValue list = cag_list_numbers(vm, (size_t)a->degree + 1, &out);
  for (size_t i = span - (size_t)a->degree; i <= span; i++) *out++ = (double)(i % a->distinct);
  return list;
}

bool cag_arg_surface_sides(CagCall *call, int argument, CagSide out[2]) {
  const CagValue v = call->values[argument];
  const bool two = v.type == CAG_LIST && CAG_AS_LIST(v)->length == 2;
  out[0] = out[1] = CAG_SIDE_RIGHT;
  for (int k = 0; k < 2 && cag_given(call, argument); k++) {
    const CagValue one = two ? cag_list_get(call->vm, CAG_AS_LIST(v), (size_t)k) : v;
    const char *side = one.type == CAG_TEXT ? CAG_AS_TEXT(one)->bytes : "";
    if (strcmp(side, "left") == 0) out[k] = CAG_SIDE_LEFT;
    else if (strcmp(side, "right") != 0)
      return cag_fail_value(call, argument, "\"right\" or \"left\", or two for u and v");
  }
  return true;
}

bool cag_tensors_acting_points(CagCall *call, const struct cag_tensors_acting_points *a,
                               CagValue *result) {
  static const char *const names[] = {"u", "v", "rows", "columns", "points"};
  Net n;
  double t[2];
  CagSide side[2];
  if (!read_net(call, a->S, &n) || !read_place(call, &n, 1, t) ||
      !cag_arg_surface_sides(call, 3, side))
    return false;
  size_t span[2];
  CagValue values[5];
  for (int k = 0; k < 2; k++) {
    const Axis *axis = &n.axis[k];
    span[k] = cag_knots_span(axis->knots, axis->count, axis->degree, t[k], side[k] == CAG_SIDE_LEFT,
                             (size_t)axis->degree);
    values[k] = range_of(call->vm, axis->knots[span[k]], axis->knots[span[k] + 1]);
    values[2 + k] = indices_value(call->vm, axis, span[k]);
  }
  const size_t p = (size_t)n.axis[0].degree, q = (size_t)n.axis[1].degree, nv = n.view.nv;
  const double *first = n.view.homogeneous + 4 * ((span[0] - p) * nv + span[1] - q);
  values[4] = net_value(call->vm, first, p + 1, q + 1, nv);
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

bool cag_tensors_basis(CagCall *call, const struct cag_tensors_basis *a, CagValue *result) {
  Net n;
  double t[2], sum = 0;
  if (!read_net(call, a->S, &n) || !read_place(call, &n, 1, t)) return false;
  double *bu = basis_line(call, &n.axis[0], t[0]), *bv = basis_line(call, &n.axis[1], t[1]);
  size_t nu = n.axis[0].distinct, nv = n.axis[1].distinct;
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j < nv; j++)
      sum += bu[i] * bv[j] * n.view.homogeneous[4 * (i * n.view.nv + j) + 3];
  if (!(sum > 0))
    return cag_geometry_ok(
        call, cag_fail(call->err, CAG_E_DEGENERATE, CAG_ERR_zero_denominator, "", -1,
                       "all weights that act at this point are 0: give one of them a positive "
                       "value"));
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

static bool part_at(CagCall *call, const CagSurface *s, long du, bool weights, CagVec3 *out) {
  Net n;
  double u, v;
  long dv;
  CagSurface *part = NULL;
  CagVec3 d[(CAG_MAX_PARTIAL + 1) * (CAG_MAX_PARTIAL + 1)];
  if (!read_net(call, s, &n) || !cag_arg_uv(call, s, 1, &u, &v) ||
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

bool cag_tensors_numerator(CagCall *call, const struct cag_tensors_numerator *a, CagValue *result) {
  CagVec3 d;
  if (!part_at(call, a->S, a->du, false, &d)) return false;
  *result = cag_point(call->vm, d, 3);
  return true;
}

bool cag_tensors_denominator(CagCall *call, const struct cag_tensors_denominator *a,
                             CagValue *result) {
  CagVec3 d;
  if (!part_at(call, a->S, a->du, true, &d)) return false;
  *result = cag_number(d.z);
  return true;
}

// --- Polynomials ---

// Powers of one direction from Bernstein points, in place, of the parameter from 0 to `length`:
// n + 1 lines, which lie `line` apart, of `width` points, which lie `across` apart.
static void to_powers(CagVec3 *b, int n, size_t line, size_t width, size_t across, double length) {
  for (size_t c = 0; c < width; c++, b += across) {
    // Forward differences, each after the one that it is taken from.
    for (int k = 1; k <= n; k++)
      for (int i = n; i >= k; i--)
        b[(size_t)i * line] = cag_sub(b[(size_t)i * line], b[(size_t)(i - 1) * line]);
    double power = 1;
    for (int i = 0; i <= n; i++, power *= length)
      b[(size_t)i * line] = cag_scaled(b[(size_t)i * line], cag_binomial(n, i) / power);
  }
}

static CagValue piece_powers(CagCall *call, const CagSurface *piece, double lu, double lv) {
  CagSurfaceNurbsView v;
  cag_surface_nurbs_view(piece, &v);
  const size_t n = v.nu, m = v.nv;
  CagVec3 *b = cag_hold(call, cag_malloc(n * m * sizeof *b));
  for (size_t i = 0; i < n * m; i++) b[i] = cag_project(v.homogeneous + 4 * i);
  to_powers(b, (int)n - 1, m, m, 1, lu);
  to_powers(b, (int)m - 1, 1, n, m, lv);
  CagValue table = cag_table_value(call->vm, b, n, m);
  cag_release_held(call, b);
  return table;
}

// The lengths of the spans; held.
static double *span_lengths(CagCall *call, const Axis *a) {
  double *lengths = cag_hold_array(call, a->count, sizeof *lengths), *next = lengths;
  for (size_t i = (size_t)a->degree; i < a->count; i++)
    if (a->knots[i] < a->knots[i + 1]) *next++ = a->knots[i + 1] - a->knots[i];
  return lengths;
}

bool cag_tensors_polynomials(CagCall *call, const struct cag_tensors_polynomials *a,
                             CagValue *result) {
  Net n;
  size_t nu, nv;
  if (!read_net(call, a->S, &n)) return false;
  if (n.view.rational)
    return cag_geometry_ok(
        call,
        cag_fail(
            call->err, CAG_E_UNSUPPORTED, CAG_ERR_rational_patch, "", -1,
            "the surface has weights, so it is not a polynomial; use `numerator` and `denominator`"));
  const double *lu = span_lengths(call, &n.axis[0]), *lv = span_lengths(call, &n.axis[1]);
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

bool cag_tensors_patch_corners(CagCall *call, const struct cag_tensors_patch_corners *a,
                               CagValue *result) {
  static const char *const names[] = {"corners", "tangents_u", "tangents_v", "twists"};
  CagHermiteCorners c;
  if (!cag_geometry_ok(call, cag_surface_corners(a->S, &c, call->err))) return false;
  CagValue values[] = {
      cag_table_value(call->vm, c.p[0], 2, 2), cag_table_value(call->vm, c.pu[0], 2, 2),
      cag_table_value(call->vm, c.pv[0], 2, 2), cag_table_value(call->vm, c.puv[0], 2, 2)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

bool cag_tensors_hermite_matrix(CagCall *call, const struct cag_tensors_hermite_matrix *a,
                                CagValue *result) {
  CagHermiteCorners c;
  if (!cag_geometry_ok(call, cag_surface_hermite_corners(a->S, &c, call->err))) return false;
  CagVec3 q[16];
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      q[4 * i + j] = c.p[i][j];
      q[4 * i + 2 + j] = c.pv[i][j];
      q[4 * (2 + i) + j] = c.pu[i][j];
      q[4 * (2 + i) + 2 + j] = c.puv[i][j];
    }
  *result = cag_table_value(call->vm, q, 4, 4);
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

bool cag_tensors_edit_corner(CagCall *call, const struct cag_tensors_edit_corner *a,
                             CagValue *result) {
  CagSurface *out = NULL;
  CagCornerEdit e = {.u = (int)a->u, .v = (int)a->v};
  for (int k = 0; k < 3; k++)
    if (!read_edit(call, 3 + k, &e, k)) return false;
  return cag_surface_result(call, cag_surface_edit_corner(a->S, &e, &out, call->err), &out, result);
}

bool cag_tensors_set_point(CagCall *call, const struct cag_tensors_set_point *a, CagValue *result) {
  CagSurface *out = NULL;
  char text[32];
  if (a->weight < 0)
    return cag_geometry_ok(call, cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_negative_weight,
                                          "weight", -1, "`weight` must not be negative, found %s",
                                          cag_number_text(a->weight, text)));
  const double weight = cag_given(call, 4) ? a->weight : -1; // the core keeps the old one
  CagStatus status =
      cag_surface_set_point(a->S, (size_t)a->i, (size_t)a->j, a->P.at, weight, &out, call->err);
  return cag_surface_result(call, status, &out, result);
}

// --- Edges ---

static const char *const sides[] = {"u0", "u1", "v0", "v1", NULL};

// A number, or two for the ends of the edge.
static bool read_shear(CagCall *call, int argument, double shear[2]) {
  const double *x;
  size_t n;
  if (!cag_given(call, argument)) return true;
  if (call->values[argument].type == CAG_NUMBER) {
    if (!cag_arg_finite(call, argument, &shear[0])) return false;
    shear[1] = shear[0];
    return true;
  }
  if (!cag_as_vector(call->values[argument], &x, &n) || n != 2 || !isfinite(x[0] + x[1]))
    return cag_fail_value(call, argument, "a number, or two for the ends of the edge");
  memcpy(shear, x, 2 * sizeof *x);
  return true;
}

bool cag_tensors_bezier_join(CagCall *call, const struct cag_tensors_bezier_join *a,
                             CagValue *result) {
  static const char *const names[] = {"points", "weights"};
  CagEdgeMatch how = {.ratio = a->ratio};
  int degree = (int)a->degree;
  double *lines = NULL;
  size_t n = 0;
  CagSurfaceNurbsView v;
  if (!read_shear(call, 3, how.shear)) return false;
  if (degree == 0)
    degree = !cag_surface_nurbs_view(a->S, &v) ? 3 : a->edge < 2 ? v.degree_u : v.degree_v;
  CagStatus status = cag_surface_join_lines(a->S, a->edge, degree, &how, &lines, &n, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_for(call, cag_free, lines);
  CagValue weights[2];
  for (size_t i = 0; i < 2; i++) {
    double *w;
    weights[i] = cag_list_numbers(call->vm, n, &w);
    for (size_t j = 0; j < n; j++) w[j] = lines[4 * (i * n + j) + 3];
  }
  CagValue values[] = {net_value(call->vm, lines, 2, n, n), cag_list_values(call->vm, weights, 2)};
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
         cag_fail_value(
             call, argument,
             "an edge of both surfaces, such as \"u1\" (u0, u1, v0, v1), or one edge of each, such as [\"u1\", \"u0\"]");
}

bool cag_tensors_match_edge(CagCall *call, const struct cag_tensors_match_edge *a,
                            CagValue *result) {
  CagSurface *out = NULL;
  CagEdgeMatch how = {.ratio = a->ratio};
  int edges[2];
  bool given;
  if (!read_shear(call, 3, how.shear) || !cag_arg_edges(call, 4, edges, &given)) return false;
  CagStatus status = cag_surface_match(a->A, a->B, &how, given ? edges : NULL, &out, call->err);
  if (!cag_surface_result(call, status, &out, result)) return false;
  cag_shape_say_alike(*result, call->values[1]);
  return true;
}

// --- Flat and creased places ---

bool cag_tensors_creases(CagCall *call, const struct cag_tensors_creases *a, CagValue *result) {
  static const char *const names[] = {"at", "angle"};
  CagValue both[2];
  for (int k = 0; k < 2; k++) {
    CagCrease *found = NULL;
    size_t n = 0;
    if (!cag_geometry_ok(call, cag_surface_creases(a->S, k, &found, &n, call->err))) return false;
    cag_hold_for(call, cag_free, found);
    CagBuilder *list = cag_builder_new(call->vm);
    for (size_t i = 0; i < n; i++) {
      CagValue values[] = {
          cag_parameter_value(k == 0 ? a->S->angular_u : a->S->angular_v, found[i].at),
          cag_angle(found[i].angle / CAG_RADIANS_PER_DEGREE)};
      if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 2)))
        return false;
    }
    both[k] = cag_builder_finish(call->vm, list);
  }
  *result = cag_uv_value(call->vm, both[0], both[1]);
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

bool cag_tensors_flat_spans(CagCall *call, const struct cag_tensors_flat_spans *a,
                            CagValue *result) {
  Net n;
  if (!read_net(call, a->S, &n)) return false;
  const Axis *u = &n.axis[0], *v = &n.axis[1];
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = (size_t)u->degree; i < u->count; i++)
    for (size_t j = (size_t)v->degree; j < v->count; j++) {
      if (!(u->knots[i] < u->knots[i + 1] && v->knots[j] < v->knots[j + 1])) continue;
      if (!acting_flat(&n, i, j)) continue;
      const CagValue over = cag_uv_value(call->vm, range_of(call->vm, u->knots[i], u->knots[i + 1]),
                                         range_of(call->vm, v->knots[j], v->knots[j + 1]));
      if (!cag_builder_add(call->vm, list, over)) return false;
    }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

// --- The net as a mesh ---

bool cag_tensors_net_mesh(CagCall *call, const struct cag_tensors_net_mesh *a, CagValue *result) {
  Net n;
  CagMesh *m = NULL;
  if (!read_net(call, a->S, &n)) return false;
  const CagSurfaceNurbsView *v = &n.view;
  size_t nu = v->distinct_u, nv = v->distinct_v;
  size_t cu = v->periodic_u ? nu : nu - 1, cv = v->periodic_v ? nv : nv - 1;
  for (size_t i = 0; i < nu * nv; i++)
    if (!(v->homogeneous[4 * (i / nv * v->nv + i % nv) + 3] > 0))
      return cag_geometry_ok(
          call,
          cag_fail(
              call->err, CAG_E_DEGENERATE, CAG_ERR_zero_denominator, "", (long)i,
              "control point [%zu, %zu] has the weight 0, so it has no location and the net is incomplete",
              i / nv, i % nv));
  if (!cag_geometry_ok(call,
                       cag_mesh_new(nu * nv, 2 * cu * cv, false, false, false, &m, call->err)))
    return false;
  for (size_t i = 0; i < nu * nv; i++)
    m->positions[i] = cag_project(v->homogeneous + 4 * (i / nv * v->nv + i % nv));
  uint32_t *t = m->triangles;
  for (size_t i = 0; i < cu; i++)
    for (size_t j = 0; j < cv; j++) {
      const uint32_t p = (uint32_t)(i * nv + j), q = (uint32_t)((i + 1) % nu * nv + j);
      const uint32_t r = (uint32_t)((i + 1) % nu * nv + (j + 1) % nv);
      const uint32_t s = (uint32_t)(i * nv + (j + 1) % nv);
      const double pr = cag_norm(cag_sub(m->positions[p], m->positions[r]));
      const double qs = cag_norm(cag_sub(m->positions[q], m->positions[s]));
      const uint32_t by_pr[6] = {p, q, r, p, r, s}, by_qs[6] = {p, q, s, q, r, s};
      memcpy(t, pr <= qs ? by_pr : by_qs, sizeof by_pr);
      t += 6;
    }
  *result = cag_mesh_value(call->vm, m);
  return true;
}
