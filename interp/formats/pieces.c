// Curves as cubic Bezier pieces.

#include "interp/formats/pieces.h"

#include <string.h>

#include "base/array.h"
#include "base/memory.h"

#define DEGREE_MAX 3
// Points count as equal, and a line as straight, up to this fraction of the curve's size, which
// allows for rounding in the knot insertions below.
#define SAME 1e-9

bool cag_pieces_add(CagPieces *p, const CagVec3 cubic[4]) {
  if (p->count == p->capacity) {
    size_t capacity = p->capacity ? 2 * p->capacity : 8;
    if (!CAG_RESIZE(p->points, 4 * capacity)) return false;
    p->capacity = capacity;
  }
  memcpy(p->points + 4 * p->count++, cubic, 4 * sizeof *cubic);
  return true;
}

// Raises a polynomial of `degree` up to 3 to a cubic.
static void elevate(const CagVec3 *b, int degree, CagVec3 out[4]) {
  CagVec3 c[4];
  memcpy(c, b, (size_t)(degree + 1) * sizeof *c);
  for (int d = degree; d < DEGREE_MAX; d++) {
    CagVec3 last = c[d];
    for (int i = d; i >= 1; i--) c[i] = cag_lerp(c[i], c[i - 1], (double)i / (d + 1));
    c[d + 1] = last;
  }
  memcpy(out, c, sizeof c);
}

// Evaluates the polar form of the span [knots[i], knots[i + 1]] at the arguments a[0..degree): de
// Boor's algorithm with a different argument at each level. The arguments of Bezier point k are
// degree - k times the span's start and k times its end (Ramshaw).
static CagVec3 blossom(const CagNurbsView *v, size_t i, const double *a) {
  CagVec3 d[DEGREE_MAX + 1];
  int p = v->degree;
  for (int j = 0; j <= p; j++) {
    const double *h = v->homogeneous + 4 * (i - (size_t)p + (size_t)j);
    d[j] = cag_vec3(h[0], h[1], h[2]);
  }
  for (int level = 1; level <= p; level++)
    for (int j = p; j >= level; j--) {
      size_t low = i - (size_t)p + (size_t)j, high = i + 1 + (size_t)(j - level);
      double t = (a[level - 1] - v->knots[low]) / (v->knots[high] - v->knots[low]);
      d[j] = cag_lerp(d[j - 1], d[j], t);
    }
  return d[p];
}

static bool nurbs_pieces(const CagNurbsView *v, CagPieces *out) {
  if (v->rational || v->degree > DEGREE_MAX) return false;
  size_t p = (size_t)v->degree;
  for (size_t i = p; i < v->count; i++) {
    double from = v->knots[i], to = v->knots[i + 1];
    if (!(from < to)) continue;
    CagVec3 b[DEGREE_MAX + 1], cubic[4];
    for (int k = 0; k <= v->degree; k++) {
      double a[DEGREE_MAX];
      for (int j = 0; j < v->degree; j++) a[j] = j < k ? to : from;
      b[k] = blossom(v, i, a);
    }
    elevate(b, v->degree, cubic);
    if (!cag_pieces_add(out, cubic)) return false;
  }
  return out->count > 0;
}

static bool polyline_pieces(const CagVec3 *points, size_t n, bool closed, CagPieces *out) {
  for (size_t i = 0; i + 1 < n + (closed ? 1 : 0); i++) {
    CagVec3 cubic[4], ends[2] = {points[i], points[(i + 1) % n]};
    elevate(ends, 1, cubic);
    if (!cag_pieces_add(out, cubic)) return false;
  }
  return out->count > 0;
}

static bool is_even_line(const CagVec3 c[4]) {
  double size = cag_norm(cag_sub(c[3], c[0]));
  CagVec3 a = cag_sub(c[1], cag_lerp(c[0], c[3], 1.0 / 3));
  CagVec3 b = cag_sub(c[2], cag_lerp(c[0], c[3], 2.0 / 3));
  return cag_norm(a) <= SAME * size && cag_norm(b) <= SAME * size;
}

static bool nearly(CagVec3 a, CagVec3 b, double size) {
  return cag_norm(cag_sub(a, b)) <= SAME * size;
}

// Tests whether the pieces equal the curve, in case its NURBS form differs from the curve itself.
static bool pieces_are_curve(const CagPieces *p, const CagCurve *c) {
  CagError err;
  CagVec3 from, to;
  if (cag_curve_point(c, c->start, &from, &err) || cag_curve_point(c, c->end, &to, &err))
    return false;
  double size = 0;
  for (size_t i = 0; i < 4 * p->count; i++) size = fmax(size, cag_norm(p->points[i]));
  return nearly(from, p->points[0], size) && nearly(to, p->points[4 * p->count - 1], size);
}

bool cag_pieces_append(CagPieces *p, const CagPieces *more) {
  for (size_t i = 0; i < more->count; i++)
    if (!cag_pieces_add(p, more->points + 4 * i)) return false;
  return true;
}

bool cag_pieces_of_curve(const CagCurve *c, CagPieces *out) {
  CagPieces p = {.linear = true};
  CagNurbsView view;
  const CagVec3 *vertices;
  size_t count;
  bool closed, ok;
  if (cag_curve_vertices(c, &vertices, &count, &closed)) {
    ok = polyline_pieces(vertices, count, closed, &p);
  } else if (cag_curve_nurbs_view(c, &view)) {
    ok = nurbs_pieces(&view, &p);
  } else { // joined curves and others that have an exact form
    CagError err;
    CagCurve *nurbs;
    ok = !cag_curve_to_nurbs(c, &nurbs, &err);
    if (ok) {
      ok = cag_curve_nurbs_view(nurbs, &view) && nurbs_pieces(&view, &p);
      cag_curve_release(nurbs);
    }
  }
  if (!ok || !pieces_are_curve(&p, c)) {
    cag_free(p.points);
    return false;
  }
  for (size_t i = 0; i < p.count && p.linear; i++) p.linear = is_even_line(p.points + 4 * i);
  *out = p;
  return true;
}
