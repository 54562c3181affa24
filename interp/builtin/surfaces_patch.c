// Patches between given edges, corners and points: Coons and Hermite.

#include <string.h>

#include "base/memory.h"
#include "geom/surface/patches.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"

bool cag_surfaces_coons(CagCall *call, const struct cag_surfaces_coons *a, CagValue *result) {
  CagSurface *s = NULL;
  return cag_surface_result(call, cag_surface_coons(a->u0, a->u1, a->v0, a->v1, &s, call->err), &s,
                            result);
}

bool cag_surfaces_developable(CagCall *call, const struct cag_surfaces_developable *a,
                              CagValue *result) {
  CagSurface *s = NULL;
  return cag_surface_result(call, cag_surface_developable(a->A, a->B, &s, call->err), &s, result);
}

// --- Tables of vectors ---

static bool read_line(CagCall *call, int argument, CagValue line, const char *what, size_t n,
                      CagVec3 *out) {
  if (line.type != CAG_LIST)
    return cag_fail_call(call, argument, CAG_ERR_length, "expects %zu vectors %s, found %s", n,
                         what, cag_type_article(line));
  if (CAG_AS_LIST(line)->length != n)
    return cag_fail_call(call, argument, CAG_ERR_length, "expects %zu vectors %s, found %zu", n,
                         what, CAG_AS_LIST(line)->length);
  for (size_t i = 0; i < n; i++) {
    CagValue v = cag_list_get(call->vm, CAG_AS_LIST(line), i);
    if (!cag_read_vector(v, &out[i]))
      return cag_fail_call(call, argument, CAG_ERR_type,
                           "expects vectors of 2 or 3 finite numbers %s, found %s at [%zu]", what,
                           cag_type_article(v), i);
  }
  return true;
}

// rows x n vectors.
static bool read_table(CagCall *call, int argument, size_t rows, size_t n, CagVec3 *out) {
  CagList *list;
  if (!cag_arg_list(call, argument, &list)) return false;
  if (list->length != rows)
    return cag_fail_call(call, argument, CAG_ERR_length, "expects %zu rows as `%s`, found %zu",
                         rows, cag_parameter_name(call, argument), list->length);
  char what[96];
  for (size_t i = 0; i < rows; i++) {
    snprintf(what, sizeof what, "in row %zu of `%s`", i, cag_parameter_name(call, argument));
    if (!read_line(call, argument, cag_list_get(call->vm, list, i), what, n, out + i * n))
      return false;
  }
  return true;
}

// --- Bicubic patches ---

bool cag_surfaces_coons_bicubic(CagCall *call, CagValue *result) {
  static const char *const modes[] = {"zero", "adini", NULL};
  CagHermiteCorners c = {0};
  CagSurface *s = NULL;
  if (!read_table(call, 0, 2, 2, c.p[0]) || !read_table(call, 1, 2, 2, c.pu[0]) ||
      !read_table(call, 2, 2, 2, c.pv[0]))
    return false;
  if (call->values[3].type == CAG_LIST) {
    if (!read_table(call, 3, 2, 2, c.puv[0])) return false;
  } else {
    int mode;
    if (!cag_arg_choice(call, 3, modes, &mode)) return false;
    if (mode == 1) cag_hermite_adini(&c);
  }
  return cag_surface_result(call, cag_surface_hermite(&c, 0, 1, 0, 1, &s, call->err), &s, result);
}

bool cag_surfaces_hermite_patch(CagCall *call, CagValue *result) {
  CagVec3 q[16];
  CagHermiteCorners c;
  CagSurface *s = NULL;
  double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
  if (!read_table(call, 0, 4, 4, q) ||
      (cag_given(call, 1) && !cag_arg_interval(call, 1, &u0, &u1, NULL)) ||
      (cag_given(call, 2) && !cag_arg_interval(call, 2, &v0, &v1, NULL)))
    return false;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      c.p[i][j] = q[4 * i + j];
      c.pv[i][j] = q[4 * i + 2 + j];
      c.pu[i][j] = q[4 * (2 + i) + j];
      c.puv[i][j] = q[4 * (2 + i) + 2 + j];
    }
  return cag_surface_result(call, cag_surface_hermite(&c, u0, u1, v0, v1, &s, call->err), &s,
                            result);
}

// --- Composite ---

static bool read_steps(CagCall *call, CagHermiteGrid *g) {
  CagList *list;
  if (!cag_given(call, 3)) return true;
  if (!cag_arg_list(call, 3, &list)) return false;
  if (list->length != 2) return cag_fail_value(call, 3, "two lists, for u and v");
  for (int k = 0; k < 2; k++) {
    const size_t wanted = (k == 0 ? g->nu : g->nv) - 1;
    const CagValue line = cag_list_get(call->vm, list, (size_t)k);
    if (line.type != CAG_LIST || CAG_AS_LIST(line)->length != wanted || CAG_AS_LIST(line)->dim != 1)
      return cag_fail_call(call, 3, CAG_ERR_length, "expects %zu numbers for %c in `lengths`",
                           wanted, "uv"[k]);
    *(k == 0 ? &g->steps_u : &g->steps_v) = CAG_AS_LIST(line)->as.numbers;
  }
  return true;
}

static bool read_edges(CagCall *call, const CagRecord *edges, CagHermiteGrid *g) {
  static const char *const names[] = {"u0", "u1", "v0", "v1"};
  CagVec3 *at = cag_hold_array(call, 2 * (g->nu + g->nv), sizeof *at);
  const CagVec3 **into[] = {&g->u_start, &g->u_end, &g->v_start, &g->v_end};
  for (int k = 0; k < 4; k++) {
    CagValue line = cag_record_get(edges, names[k]);
    size_t n = k < 2 ? g->nv : g->nu;
    char what[48];
    snprintf(what, sizeof what, "for %s in `edge_tangents`", names[k]);
    if (line.type == CAG_UNSET)
      return cag_fail_call(
          call, 1, CAG_ERR_value,
          "expects a record with u0, u1, v0, and v1 as `edge_tangents`; %s is missing", names[k]);
    if (!read_line(call, 1, line, what, n, at)) return false;
    *into[k] = at;
    at += n;
  }
  return true;
}

bool cag_surfaces_hermite_surface(CagCall *call, const struct cag_surfaces_hermite_surface *a,
                                  CagValue *result) {
  CagHermiteGrid g = {0};
  CagList *rows;
  CagSurface *s = NULL;
  if (!cag_arg_list(call, 0, &rows)) return false;
  g.nu = rows->length;
  CagValue first = g.nu ? cag_list_get(call->vm, rows, 0) : cag_none();
  if (first.type != CAG_LIST) return cag_fail_type(call, 0, "rows of points");
  g.nv = CAG_AS_LIST(first)->length;
  CagVec3 *points = cag_hold_array(call, g.nu * g.nv, sizeof *points);
  if (!read_table(call, 0, g.nu, g.nv, points) || !read_edges(call, a->edge_tangents, &g) ||
      !read_table(call, 2, 2, 2, g.twist[0]) || !read_steps(call, &g))
    return false;
  g.points = points;
  return cag_surface_result(call, cag_surface_hermite_grid(&g, &s, call->err), &s, result);
}

// --- Triangles ---

bool cag_arg_triangle(CagCall *call, int argument, CagVec3 **net, int *degree) {
  CagList *rows;
  if (!cag_arg_list(call, argument, &rows)) return false;
  const size_t n = rows->length;
  char what[96];
  if (n < 1 || n > CAG_TRIANGLE_ROWS) {
    snprintf(what, sizeof what, "1 to %d rows of points", CAG_TRIANGLE_ROWS);
    return cag_fail_value(call, argument, what);
  }
  *degree = (int)n - 1;
  CagVec3 *row = *net = cag_hold_array(call, n * (n + 1) / 2, sizeof **net);
  for (size_t i = 0; i < n; row += ++i) {
    snprintf(what, sizeof what, "in row %zu of `%s`", i, cag_parameter_name(call, argument));
    if (!read_line(call, argument, cag_list_get(call->vm, rows, i), what, i + 1, row)) return false;
  }
  return true;
}

bool cag_surfaces_bezier_triangle(CagCall *call, CagValue *result) {
  CagVec3 *net;
  int degree;
  CagSurface *s = NULL;
  return cag_arg_triangle(call, 0, &net, &degree) &&
         cag_surface_result(call, cag_surface_bezier_triangle(net, degree, &s, call->err), &s,
                            result);
}
