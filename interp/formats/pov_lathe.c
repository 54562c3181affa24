// Lathes, prisms, and flat polygons.
//
// A lathe is a profile in the half plane (radius, height), revolved about its y axis. A prism is a
// plane outline, extruded along its y axis. Both accept linear and Bezier splines, and several
// closed outlines in sequence, which include holes. Polynomials of degree up to 3 are written
// exactly, and others (arcs, conics, higher degrees) are approximated by cubics (pov_outline.h).
// `sor` is not used: its radius is the root of a cubic in the height, which no spline is.

#include <stdlib.h>

#include "interp/formats/pov_outline.h"

// Points count as equal or coplanar up to this fraction of the size, which allows for rounding of
// knot insertions.
#define SAME 1e-9

static bool nearly(CagVec3 a, CagVec3 b, double size) {
  return cag_norm(cag_sub(a, b)) <= SAME * size;
}

// --- Lathes ---

typedef struct Turn {
  CagVec3 axis, through, out; // out: a unit vector perpendicular to the axis, in the half plane of
                              // the profile
  bool has_out;
  CagTransform map; // applied to the whole revolution
} Turn;

#define FULL_TURN (2 * 3.14159265358979323846)

static CagVec3 radial_part(const Turn *t, CagVec3 p) {
  CagVec3 d = cag_sub(p, t->through);
  return cag_madd(d, -cag_dot(d, t->axis), t->axis);
}

// Converts the pieces to (radius, height). Returns false if they leave the half plane.
static bool to_half_plane(Turn *t, CagPieces *p) {
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

// All faces of a body have exactly the same map.
static bool same_map(const CagTransform *a, const CagTransform *b) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (a->m[i][j] != b->m[i][j]) return false;
  return true;
}

static bool add_profile(CagPovOutline *o, Turn *t, const CagSurface *s) {
  const CagCurve *profile;
  CagVec3 axis, through;
  CagTransform map;
  double from, to;
  s = cag_pov_unplaced(s, &map);
  if (!cag_surface_revolution_view(s, &profile, &axis, &through, &from, &to)) return false;
  if (fabs(fabs(to - from) - FULL_TURN) > SAME || !cag_pov_takes(&map)) return false;
  if (o->all.count == 0) t->axis = cag_unit(axis), t->through = through, t->map = map;
  else if (!same_map(&t->map, &map) || !same_axis(t, cag_unit(axis), through)) return false;
  CagPovOutline part = CAG_POV_OUTLINE_EMPTY;
  CagCurve *space = NULL;
  CagError err;
  bool ok = !cag_curve_to_space(profile, &space, &err) && cag_pov_outline_add(&part, space) &&
            to_half_plane(t, &part.all);
  cag_curve_release(space);
  ok = ok && cag_pov_outline_append(o, &part);
  cag_pov_outline_free(&part);
  return ok;
}

// Maps y of the lathe to the axis and x to the side of the profile, and then applies the map.
static CagTransform lathe_placement(const Turn *t) {
  CagTransform m = cag_transform_identity();
  CagVec3 x = t->out, y = t->axis, z = cag_cross(x, y);
  const CagVec3 columns[4] = {x, y, z, t->through};
  for (int j = 0; j < 4; j++) {
    m.m[0][j] = columns[j].x;
    m.m[1][j] = columns[j].y;
    m.m[2][j] = columns[j].z;
  }
  m.planar = false;
  return cag_transform_multiply(&t->map, &m);
}

bool cag_pov_try_lathe(CagPovWriter *w, const CagSurface *const *s, size_t n) {
  CagPovOutline o = CAG_POV_OUTLINE_EMPTY;
  Turn turn = {.has_out = false};
  bool ok = n > 0;
  for (size_t i = 0; ok && i < n; i++) ok = add_profile(&o, &turn, s[i]);
  if (ok) {
    cag_pov_outline_tidy(&o);
    cag_pov_text(w, "lathe { // points are (radius, height)\n");
    cag_pov_outline_write(w, &o, "");
    // Degree 6 always uses Sturm sequences. Without this keyword, pieces that happen to have degree
    // 2 would be solved in closed form, which misses points where the profile is vertical.
    if (!o.linear) cag_pov_text(w, "  sturm\n");
    CagTransform placement = lathe_placement(&turn);
    cag_pov_placement(w, "  ", &placement);
    cag_pov_text(w, "}");
  }
  cag_pov_outline_free(&o);
  return ok;
}

// Writes a profile of straight lines as open cones and rings, which render almost twice as fast as
// the same lathe. It is a shell without an inside, so it cannot be an operand of a set operation.

static void write_straight(CagPovWriter *w, CagVec3 a, CagVec3 b, double size) {
  if (fabs(a.x) <= SAME * size && fabs(b.x) <= SAME * size) return; // on the axis
  if (nearly(a, b, size)) return;
  bool flat = fabs(a.y - b.y) <= SAME * size;
  cag_pov_text(w, flat ? "  disc { " : "  cone { ");
  cag_pov_vec(w, cag_vec3(0, a.y, 0));
  cag_pov_text(w, flat ? ", y, " : ", ");
  cag_pov_number(w, flat ? fmax(a.x, b.x) : a.x);
  cag_pov_text(w, ", ");
  if (!flat) {
    cag_pov_vec(w, cag_vec3(0, b.y, 0));
    cag_pov_text(w, ", ");
  }
  cag_pov_number(w, flat ? fmin(a.x, b.x) : b.x);
  cag_pov_text(w, flat ? " }\n" : " open }\n");
}

bool cag_pov_try_cones(CagPovWriter *w, const CagSurface *s) {
  CagPovOutline o = CAG_POV_OUTLINE_EMPTY;
  Turn turn = {.has_out = false};
  bool ok = add_profile(&o, &turn, s) && o.linear;
  if (ok) {
    cag_pov_outline_tidy(&o);
    double size = 0;
    for (size_t i = 0; i < 4 * o.all.count; i++) size = fmax(size, cag_norm(o.all.points[i]));
    cag_pov_text(w, "union { // along y\n");
    for (size_t i = 0; i < o.all.count; i++)
      write_straight(w, o.all.points[4 * i], o.all.points[4 * i + 3], size);
    CagTransform placement = lathe_placement(&turn);
    cag_pov_placement(w, "  ", &placement);
    cag_pov_text(w, "}");
  }
  cag_pov_outline_free(&o);
  return ok;
}

// --- Prisms ---

// Finds the two flat ends of a straight extrusion: the same region, translated.
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

// Finds the vector from the low end to the high one, from the first side.
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

// Tests whether a side of an extrusion is ruled along one vector, as the side of an extrusion
// without twist is. After whole turns, the ends and the middle of a twisted side look straight, so
// the tangents are compared as well.
static bool side_is_straight(const CagSurface *s, CagVec3 along, double size) {
  CagError err;
  const int samples = 8;
  for (int i = 0; i <= samples; i++) {
    double u = s->u0 + (s->u1 - s->u0) * i / samples;
    CagVec3 a[4], m, b;
    if (cag_surface_eval(s, u, s->v0, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, a, &err) ||
        cag_surface_point(s, u, s->v1, &b, &err) ||
        cag_surface_point(s, u, (s->v0 + s->v1) / 2, &m, &err))
      return false;
    const CagVec3 way = cag_sub(b, a[0]);
    const CagVec3 tangent = cag_scaled(a[cag_partial(1, 0, 1)], s->v1 - s->v0);
    const CagVec3 d = cag_dot(way, along) < 0 ? cag_scaled(way, -1) : way;
    if (!nearly(d, along, size) || !nearly(m, cag_lerp(a[0], b, 0.5), size) ||
        !nearly(tangent, way, size))
      return false;
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

bool cag_pov_try_prism(CagPovWriter *w, const CagSolid *s) {
  const CagRegion *region = NULL;
  CagTransform low, high;
  CagVec3 along;
  if (!find_ends(s, &region, &low, &high) || !find_along(s, &low, &high, &along) ||
      !sides_are_straight(s, &low, along))
    return false;
  CagPovOutline o = CAG_POV_OUTLINE_EMPTY;
  bool ok = true;
  for (size_t i = 0; ok && i < region->count; i++) ok = cag_pov_outline_add(&o, region->loops[i]);
  if (ok) {
    cag_pov_outline_tidy(&o);
    // The x and y of the outline are kept, and the prism's y, from 0 to 1, is along the extrusion.
    CagTransform m = low;
    const CagVec3 columns[3] = {column(&low, 0), along, column(&low, 1)};
    for (int j = 0; j < 3; j++) {
      m.m[0][j] = columns[j].x;
      m.m[1][j] = columns[j].y;
      m.m[2][j] = columns[j].z;
    }
    cag_pov_text(w, "prism {\n  linear_sweep\n");
    cag_pov_outline_write(w, &o, "  0, 1,\n");
    if (!o.linear) cag_pov_text(w, "  sturm\n");
    cag_pov_placement(w, "  ", &m);
    cag_pov_text(w, "}");
  }
  cag_pov_outline_free(&o);
  return ok;
}

// --- Flat pieces ---

static bool corners(const CagCurve *loop, const CagVec3 **points, size_t *n) {
  bool closed;
  if (!cag_curve_vertices(loop, points, n, &closed)) return false;
  if (*n > 1 && cag_norm(cag_sub((*points)[0], (*points)[*n - 1])) == 0) --*n;
  return true;
}

bool cag_pov_try_polygon(CagPovWriter *w, const CagRegion *r, const CagTransform *placement) {
  size_t total = 0;
  for (size_t i = 0; i < r->count; i++) {
    const CagVec3 *points;
    size_t n;
    if (!corners(r->loops[i], &points, &n)) return false;
    total += n + 1;
  }
  if (!cag_transform_is_affine(placement)) return false;
  cag_pov_printf(w, "polygon { // each outline ends where it begins; inner ones are holes\n  %zu",
                 total);
  for (size_t i = 0; i < r->count; i++) {
    const CagVec3 *points;
    size_t n;
    corners(r->loops[i], &points, &n);
    for (size_t k = 0; k <= n; k++) {
      cag_pov_text(w, k % 6 == 0 ? ",\n  " : ", ");
      cag_pov_vec2(w, points[k % n].x, points[k % n].y);
    }
  }
  cag_pov_text(w, "\n");
  cag_pov_placement(w, "  ", placement);
  cag_pov_text(w, "}");
  return true;
}
