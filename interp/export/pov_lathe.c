// Curves as cubic Bezier pieces, and what POV-Ray makes of them: lathes and prisms.
//
// A lathe is a profile in the half plane (radius, height) turned about its y axis; a prism a plane
// outline drawn along its y axis. Both take linear and Bezier splines, and both let several closed
// outlines stand one after the other, so holes come along. Only what is exact is written: profiles
// that are polynomials of degree up to 3.

#include <stdlib.h>
#include <string.h>

#include "interp/export/pov_write.h"

#define DEGREE_MAX 3
// Points are the same, or a line is straight, to this part of the curve's size: rounding of the
// knot insertions below.
#define SAME 1e-9

// --- Bezier pieces ---

typedef struct Pieces {
  CagVec3 *points; // four a piece
  size_t count, capacity;
} Pieces;

static bool add_piece(Pieces *p, const CagVec3 cubic[4]) {
  if (p->count == p->capacity) {
    size_t capacity = p->capacity ? 2 * p->capacity : 8;
    CagVec3 *points = realloc(p->points, capacity * 4 * sizeof *points);
    if (!points) return false;
    p->points = points;
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

// The polar form of the span [knots[i], knots[i + 1]] at the arguments a[0..degree): de Boor with
// another argument at each level. Bezier point k is that of degree - k times the span's start and k
// times its end (Ramshaw).
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

static bool nurbs_pieces(const CagNurbsView *v, Pieces *out) {
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
    if (!add_piece(out, cubic)) return false;
  }
  return out->count > 0;
}

static bool polyline_pieces(const CagVec3 *points, size_t n, bool closed, Pieces *out) {
  for (size_t i = 0; i + 1 < n + (closed ? 1 : 0); i++) {
    CagVec3 cubic[4], ends[2] = {points[i], points[(i + 1) % n]};
    elevate(ends, 1, cubic);
    if (!add_piece(out, cubic)) return false;
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

// True when the pieces are the curve: a guard against kinds whose NURBS form is not what is drawn.
static bool pieces_are_curve(const Pieces *p, const CagCurve *c) {
  CagError err;
  CagVec3 from, to;
  if (cag_curve_point(c, c->start, &from, &err) || cag_curve_point(c, c->end, &to, &err))
    return false;
  double size = 0;
  for (size_t i = 0; i < 4 * p->count; i++) size = fmax(size, cag_norm(p->points[i]));
  return nearly(from, p->points[0], size) && nearly(to, p->points[4 * p->count - 1], size);
}

bool pov_cubic_pieces(const CagCurve *c, CagVec3 **out, size_t *n, bool *linear) {
  Pieces p = {0};
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
    ok = cag_curve_to_nurbs(c, &nurbs, &err) == CAG_OK;
    if (ok) {
      ok = cag_curve_nurbs_view(nurbs, &view) && nurbs_pieces(&view, &p);
      cag_curve_release(nurbs);
    }
  }
  if (!ok || !pieces_are_curve(&p, c)) {
    free(p.points);
    return false;
  }
  *linear = true;
  for (size_t i = 0; i < p.count && *linear; i++) *linear = is_even_line(p.points + 4 * i);
  *out = p.points;
  *n = p.count;
  return true;
}

// --- Outlines of two coordinates, in POV-Ray's order ---

typedef struct Outline {
  Pieces all;
  bool linear; // every piece is straight, and they follow one another
} Outline;

static bool add_curve(Outline *o, const CagCurve *c) {
  CagVec3 *points;
  size_t n;
  bool linear;
  if (!pov_cubic_pieces(c, &points, &n, &linear)) return false;
  // Separate outlines are told apart by Bezier pieces only.
  if (o->all.count > 0 || !linear) o->linear = false;
  bool ok = true;
  for (size_t i = 0; ok && i < n; i++) ok = add_piece(&o->all, points + 4 * i);
  free(points);
  return ok;
}

static void write_outline(CagPovWriter *w, const Outline *o) {
  size_t n = o->all.count;
  const CagVec3 *p = o->all.points;
  if (o->linear) {
    pov_printf(w, "  %zu", n + 1);
    for (size_t i = 0; i <= n; i++) {
      pov_text(w, i % 6 == 0 ? ",\n  " : ", ");
      CagVec3 at = i < n ? p[4 * i] : p[4 * n - 1];
      pov_vec2(w, at.x, at.y);
    }
  } else {
    pov_printf(w, "  %zu", 4 * n);
    for (size_t i = 0; i < 4 * n; i++) {
      pov_text(w, i % 4 == 0 ? ",\n  " : ", ");
      pov_vec2(w, p[i].x, p[i].y);
    }
  }
  pov_text(w, "\n");
}

static double largest(const Pieces *p) {
  double size = 0;
  for (size_t i = 0; i < 4 * p->count; i++) size = fmax(size, cag_norm(p->points[i]));
  return size;
}

// Rounding leaves coordinates such as 3e-17 where 0 is meant: a 10^-13th of the size is no shape.
static void tidy(Pieces *p) {
  double unit = largest(p) * 1e-13;
  for (size_t i = 0; i < 4 * p->count; i++) {
    CagVec3 *q = p->points + i;
    if (fabs(q->x) < unit) q->x = 0;
    if (fabs(q->y) < unit) q->y = 0;
  }
}

// --- Lathes ---

typedef struct Turn {
  CagVec3 axis, through, out; // out: unit, square to the axis, in the profile's half plane
  bool has_out;
} Turn;

#define FULL_TURN (2 * 3.14159265358979323846)

static CagVec3 radial_part(const Turn *t, CagVec3 p) {
  CagVec3 d = cag_sub(p, t->through);
  return cag_madd(d, -cag_dot(d, t->axis), t->axis);
}

// Takes the pieces to (radius, height); false: they leave the half plane.
static bool to_half_plane(Turn *t, Pieces *p) {
  double size = 0;
  CagVec3 farthest = {0, 0, 0};
  for (size_t i = 0; i < 4 * p->count; i++) {
    CagVec3 r = radial_part(t, p->points[i]);
    if (cag_norm(r) > cag_norm(farthest)) farthest = r;
    size = fmax(size, cag_norm(cag_sub(p->points[i], t->through)));
  }
  if (cag_norm(farthest) <= SAME * size) return false; // all on the axis
  if (!t->has_out) t->out = cag_unit(farthest), t->has_out = true;
  for (size_t i = 0; i < 4 * p->count; i++) {
    CagVec3 r = radial_part(t, p->points[i]);
    double radius = cag_dot(r, t->out);
    if (cag_norm(cag_madd(r, -radius, t->out)) > SAME * size || radius < -SAME * size) return false;
    double height = cag_dot(cag_sub(p->points[i], t->through), t->axis);
    p->points[i] = cag_vec3(fmax(radius, 0), height, 0);
  }
  return true;
}

static bool same_axis(const Turn *t, CagVec3 axis, CagVec3 through) {
  CagVec3 between = cag_sub(through, t->through);
  double off = cag_norm(cag_cross(between, t->axis));
  return fabs(fabs(cag_dot(axis, t->axis)) - 1) < SAME && off <= SAME * (1 + cag_norm(between));
}

static bool add_profile(Outline *o, Turn *t, const CagSurface *s) {
  const CagCurve *profile;
  CagVec3 axis, through;
  double from, to;
  if (!cag_surface_revolution_view(s, &profile, &axis, &through, &from, &to)) return false;
  if (fabs(fabs(to - from) - FULL_TURN) > SAME) return false;
  if (o->all.count == 0) t->axis = cag_unit(axis), t->through = through;
  else if (!same_axis(t, cag_unit(axis), through)) return false;
  Outline part = {.linear = true};
  CagCurve *space = NULL;
  CagError err;
  bool ok = cag_curve_to_space(profile, &space, &err) == CAG_OK && add_curve(&part, space) &&
            to_half_plane(t, &part.all);
  cag_curve_release(space);
  if (o->all.count > 0 || !part.linear) o->linear = false;
  for (size_t i = 0; ok && i < part.all.count; i++)
    ok = add_piece(&o->all, part.all.points + 4 * i);
  free(part.all.points);
  return ok;
}

// y of the lathe to the axis, x to the profile's side.
static CagTransform lathe_placement(const Turn *t) {
  CagTransform m = cag_transform_identity();
  CagVec3 x = t->out, y = t->axis, z = cag_cross(x, y);
  const CagVec3 columns[4] = {x, y, z, t->through};
  for (int j = 0; j < 4; j++) {
    m.m[0][j] = columns[j].x;
    m.m[1][j] = columns[j].y;
    m.m[2][j] = columns[j].z;
  }
  return m;
}

bool pov_try_lathe(CagPovWriter *w, const CagSurface *const *s, size_t n) {
  Outline o = {.linear = true};
  Turn turn = {.has_out = false};
  bool ok = n > 0;
  for (size_t i = 0; ok && i < n; i++) ok = add_profile(&o, &turn, s[i]);
  if (ok) {
    tidy(&o.all);
    pov_text(w, "lathe { // points are (radius, height)\n");
    pov_text(w, o.linear ? "  linear_spline\n" : "  bezier_spline\n");
    write_outline(w, &o);
    if (!o.linear) pov_text(w, "  sturm\n");
    CagTransform placement = lathe_placement(&turn);
    pov_placement(w, "  ", &placement);
    pov_text(w, "}");
  }
  free(o.all.points);
  return ok;
}

// --- Prisms ---

// The straight extrusion's two flat ends: the same region, moved without turning.
static bool find_ends(const CagSolid *s, const CagRegion **region, CagTransform *low,
                      CagTransform *high) {
  size_t found = 0;
  for (size_t i = 0; i < s->face_count; i++) {
    const CagRegion *r;
    CagTransform frame;
    if (!cag_surface_planar_view(s->faces[i], &r, &frame)) continue;
    if (found == 0) *region = r, *low = frame;
    if (found == 1) *high = frame;
    found++;
  }
  return found == 2;
}

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static bool next_side(const CagSolid *s, size_t *i) {
  for (; *i < s->face_count; ++*i)
    if (!cag_surface_planar_view(s->faces[*i], NULL, NULL)) return true;
  return false;
}

// The vector from the low end to the high one, as the first side has it.
static bool find_along(const CagSolid *s, const CagTransform *low, const CagTransform *high,
                       CagVec3 *along) {
  CagError err;
  CagVec3 a, b;
  size_t i = 0;
  if (!next_side(s, &i)) return false;
  const CagSurface *side = s->faces[i];
  if (cag_surface_point(side, side->u0, side->v0, &a, &err) ||
      cag_surface_point(side, side->u0, side->v1, &b, &err))
    return false;
  CagVec3 normal = cag_cross(column(low, 0), column(low, 1));
  double up = cag_dot(cag_sub(column(high, 3), column(low, 3)), normal);
  *along = cag_sub(b, a);
  if (up * cag_dot(*along, normal) < 0) *along = cag_scaled(*along, -1);
  return cag_norm(*along) > 0;
}

// A side of a straight extrusion is ruled along one vector; a twisted one is not, whatever its ends
// are.
static bool side_is_straight(const CagSurface *s, CagVec3 along, double size) {
  CagError err;
  const int samples = 8;
  for (int i = 0; i <= samples; i++) {
    double u = s->u0 + (s->u1 - s->u0) * i / samples;
    CagVec3 a, m, b;
    if (cag_surface_point(s, u, s->v0, &a, &err) || cag_surface_point(s, u, s->v1, &b, &err) ||
        cag_surface_point(s, u, (s->v0 + s->v1) / 2, &m, &err))
      return false;
    CagVec3 d = cag_sub(b, a);
    if (cag_dot(d, along) < 0) d = cag_scaled(d, -1);
    if (!nearly(d, along, size) || !nearly(m, cag_lerp(a, b, 0.5), size)) return false;
  }
  return true;
}

static bool sides_are_straight(const CagSolid *s, const CagTransform *low, CagVec3 along) {
  double size = cag_norm(along);
  for (int j = 0; j < 4; j++) size = fmax(size, cag_norm(column(low, j)));
  for (size_t i = 0; next_side(s, &i); i++)
    if (!side_is_straight(s->faces[i], along, size)) return false;
  return true;
}

bool pov_try_prism(CagPovWriter *w, const CagSolid *s) {
  const CagRegion *region = NULL;
  CagTransform low, high;
  CagVec3 along;
  if (!find_ends(s, &region, &low, &high) || !find_along(s, &low, &high, &along) ||
      !sides_are_straight(s, &low, along))
    return false;
  Outline o = {.linear = true};
  bool ok = true;
  for (size_t i = 0; ok && i < region->count; i++) ok = add_curve(&o, region->loops[i]);
  if (ok) {
    tidy(&o.all);
    // The outline's x and y stay, and the prism's own y, from 0 to 1, goes along the extrusion.
    CagTransform m = low;
    const CagVec3 columns[3] = {column(&low, 0), along, column(&low, 1)};
    for (int j = 0; j < 3; j++) {
      m.m[0][j] = columns[j].x;
      m.m[1][j] = columns[j].y;
      m.m[2][j] = columns[j].z;
    }
    pov_text(w, "prism {\n  linear_sweep\n");
    pov_text(w, o.linear ? "  linear_spline\n" : "  bezier_spline\n");
    pov_text(w, "  0, 1,\n");
    write_outline(w, &o);
    if (!o.linear) pov_text(w, "  sturm\n");
    pov_placement(w, "  ", &m);
    pov_text(w, "}");
  }
  free(o.all.points);
  return ok;
}

// --- Flat pieces ---

static bool corners(const CagCurve *loop, const CagVec3 **points, size_t *n) {
  bool closed;
  if (!cag_curve_vertices(loop, points, n, &closed)) return false;
  if (*n > 1 && cag_norm(cag_sub((*points)[0], (*points)[*n - 1])) == 0) --*n;
  return true;
}

bool pov_try_polygon(CagPovWriter *w, const CagRegion *r, const CagTransform *placement) {
  size_t total = 0;
  for (size_t i = 0; i < r->count; i++) {
    const CagVec3 *points;
    size_t n;
    if (!corners(r->loops[i], &points, &n)) return false;
    total += n + 1;
  }
  if (!cag_transform_is_affine(placement)) return false;
  pov_printf(w, "polygon { // each outline ends where it begins; inner ones are holes\n  %zu",
             total);
  for (size_t i = 0; i < r->count; i++) {
    const CagVec3 *points;
    size_t n;
    corners(r->loops[i], &points, &n);
    for (size_t k = 0; k <= n; k++) {
      pov_text(w, k % 6 == 0 ? ",\n  " : ", ");
      pov_vec2(w, points[k % n].x, points[k % n].y);
    }
  }
  pov_text(w, "\n");
  pov_placement(w, "  ", placement);
  pov_text(w, "}");
  return true;
}
