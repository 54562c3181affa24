// Polyhedral balls: vertices along a spiral, and in given directions.

#include "geom/solid/ball.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/mesh/edges.h"
#include "geom/mesh/hull.h"

// Flat faces that get their own vertices, and arcs between them.
#define DIRECTIONS_MOST 64
#define ARCS_MOST 256
// A flat face has at least this part of the area of the surface.
#define LARGE 0.004
// Normals closer than this are those of one flat face.
#define SAME 1e-9
// Points of the sphere: a practical limit, and the least.
#define POINTS_MOST 40000
#define POINTS_LEAST 24
// Rounds of adding points until the polyhedron is within the tolerance.
#define ROUNDS 40

typedef struct Directions {
  CagVec3 *at;
  size_t n, room;
} Directions;

static CagStatus add_direction(Directions *d, CagVec3 v, CagError *err) {
  if (!CAG_RESERVE(d->at, d->room, d->n + 1)) return cag_fail_memory(err);
  d->at[d->n++] = v;
  return CAG_OK;
}

static double nearest_of(const Directions *d, CagVec3 v) {
  double least = INFINITY;
  for (size_t i = 0; i < d->n; i++) least = fmin(least, cag_norm(cag_sub(d->at[i], v)));
  return least;
}

// --- Flat faces ---

typedef struct Flat {
  CagVec3 normal;
  double area;
} Flat;

static uint32_t corner_of(const CagMesh *m, size_t i) {
  return m->weld ? m->weld[m->triangles[i]] : m->triangles[i];
}

static CagVec3 face_vector(const CagMesh *m, size_t f) {
  const CagVec3 a = m->positions[m->triangles[3 * f]], b = m->positions[m->triangles[3 * f + 1]],
                c = m->positions[m->triangles[3 * f + 2]];
  return cag_cross(cag_sub(b, a), cag_sub(c, a));
}

// The index of the direction of each triangle, or n.
static CagStatus find_flats(const CagMesh *m, Directions *out, CagError *err) {
  Flat *flats = NULL;
  size_t n = 0, room = 0;
  const double whole = 2 * cag_mesh_area(m);
  CagStatus status = CAG_OK;
  for (size_t f = 0; !status && f < m->triangle_count; f++) {
    const CagVec3 v = face_vector(m, f), normal = cag_unit(v);
    size_t k = 0;
    while (k < n && cag_norm(cag_sub(flats[k].normal, normal)) > SAME) k++;
    if (k == n && n == 4 * DIRECTIONS_MOST) continue; // a curved surface
    if (k == n) {
      if (!CAG_RESERVE(flats, room, n + 1)) status = cag_fail_memory(err);
      else flats[n++] = (Flat){normal, 0};
    }
    if (!status) flats[k].area += cag_norm(v);
  }
  for (size_t k = 0; !status && k < n && out->n < DIRECTIONS_MOST; k++)
    if (flats[k].area >= LARGE * whole) status = add_direction(out, flats[k].normal, err);
  cag_free(flats);
  return status;
}

static bool is_direction(const Directions *d, size_t n, CagVec3 normal) {
  for (size_t i = 0; i < n; i++)
    if (cag_norm(cag_sub(d->at[i], normal)) <= SAME) return true;
  return false;
}

// Points along the arc between two directions, in equal steps of at most `step`.
static CagStatus add_arc(Directions *d, CagVec3 a, CagVec3 b, double step, CagError *err) {
  const double angle = atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b));
  const int n = (int)ceil(angle / step);
  CagStatus status = CAG_OK;
  for (int i = 1; !status && i < n; i++) {
    const double t = angle * i / n;
    const CagVec3 v =
        cag_scaled(cag_madd(cag_scaled(a, sin(angle - t)), sin(t), b), 1 / sin(angle));
    if (nearest_of(d, v) > step / 4) status = add_direction(d, cag_unit(v), err);
  }
  return status;
}

static CagStatus find_arcs(const CagMesh *m, Directions *d, double step, CagError *err) {
  size_t n = 0, arcs = 0;
  const size_t flats = d->n;
  uint32_t *corners = cag_malloc((3 * m->triangle_count + 1) * sizeof *corners);
  if (!corners) return cag_fail_memory(err);
  for (size_t i = 0; i < 3 * m->triangle_count; i++) corners[i] = corner_of(m, i);
  CagMeshEdge *e = cag_mesh_edges(corners, m->triangle_count, NULL, m->vertex_count, &n);
  cag_free(corners);
  if (!e) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i + 1 < n && arcs < ARCS_MOST; i += 2) {
    const CagVec3 a = cag_unit(face_vector(m, cag_mesh_edge_triangle(&e[i])));
    const CagVec3 b = cag_unit(face_vector(m, cag_mesh_edge_triangle(&e[i + 1])));
    const double turn = atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b));
    if (turn <= step || turn > M_PI - SAME) continue;
    if (!is_direction(d, flats, a) || !is_direction(d, flats, b)) continue;
    status = add_arc(d, a, b, step, err);
    arcs++;
  }
  cag_free(e);
  return status;
}

// --- The sphere ---

// Point i of n along a spiral from pole to pole (Vogel 1979), rotated so that no point or face has a
// direction that is usual in a model.
static CagVec3 spiral_point(size_t i, size_t n) {
  const double golden = M_PI * (3 - sqrt(5)), z = 1 - (2 * (double)i + 1) / (double)n;
  const double r = sqrt(1 - z * z), angle = golden * (double)i + 0.3711;
  const CagVec3 p = {r * cos(angle), r * sin(angle), z};
  const double c = cos(0.6173), s = sin(0.6173), c2 = cos(0.4219), s2 = sin(0.4219);
  const CagVec3 q = {c * p.x + s * p.z, p.y, c * p.z - s * p.x};
  return cag_vec3(q.x, c2 * q.y - s2 * q.z, s2 * q.y + c2 * q.z);
}

static double least_height(const CagMesh *hull) {
  double least = INFINITY;
  for (size_t f = 0; f < hull->triangle_count; f++)
    least = fmin(least,
                 cag_dot(cag_unit(face_vector(hull, f)), hull->positions[hull->triangles[3 * f]]));
  return least;
}

static CagStatus hull_of(const Directions *given, size_t n, double radius, CagMesh **out,
                         CagError *err) {
  Directions all = {0};
  CagStatus status = CAG_OK;
  // Points near a given one would make thin faces.
  const double apart = 0.6 * sqrt(4 * M_PI / (double)n);
  for (size_t i = 0; !status && i < given->n; i++) status = add_direction(&all, given->at[i], err);
  for (size_t i = 0; !status && i < n; i++) {
    const CagVec3 p = spiral_point(i, n);
    if (nearest_of(given, p) > apart) status = add_direction(&all, p, err);
  }
  for (size_t i = 0; i < all.n; i++) all.at[i] = cag_scaled(all.at[i], radius);
  if (!status) status = cag_hull_space(all.at, all.n, out, err);
  cag_free(all.at);
  return status;
}

static CagStatus fail_points(double radius, CagError *err) {
  char text[32];
  // The distance of n points decreases with their number: about 3 r / n.
  return cag_fail(err, CAG_E_LIMIT, CAG_ERR_ball_too_fine, "tolerance", -1,
                  "`tolerance` must be at least %s for this distance: a ball is replaced by a "
                  "polyhedron with at most %d vertices",
                  cag_number_text(radius * 4 / POINTS_MOST, text), POINTS_MOST);
}

CagStatus cag_ball_for(const CagMesh *m, double radius, double tolerance, CagMesh **out,
                       CagError *err) {
  const double part = fmin(tolerance / radius, 0.25);
  if (!(part >= 4.0 / POINTS_MOST)) return fail_points(radius, err);
  // A chord over the angle a is 1 - cos(a / 2) off.
  const double step = fmin(2 * acos(fmax(0, 1 - part)), M_PI / 4);
  Directions given = {0};
  CagStatus status = find_flats(m, &given, err);
  if (!status) status = find_arcs(m, &given, step, err);
  double n = fmax(POINTS_LEAST, 2.5 / part);
  CagMesh *hull = NULL;
  for (int round = 0; !status && round < ROUNDS; round++) {
    if (n > POINTS_MOST) status = fail_points(radius, err);
    if (!status) status = hull_of(&given, (size_t)n, radius, &hull, err);
    if (status || radius - least_height(hull) <= tolerance) break;
    cag_mesh_release(hull);
    hull = NULL;
    n *= 1.2;
  }
  cag_free(given.at);
  if (!status && !hull) status = fail_points(radius, err);
  if (status) cag_mesh_release(hull);
  else *out = hull;
  return status;
}
