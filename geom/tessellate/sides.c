// Separate vertices for corners of triangles whose normal belongs to another side of a crease or
// cusp.
//
// A corner is tested only if its normal leans away from the triangle. It gets the limit of the
// surface's normal from within the triangle, or the opposite of its own normal beyond a cusp.

#include "geom/tessellate/sides.h"

#include "base/array.h"
#include "base/memory.h"

#include "base/stop.h"

// The limit of the normal at a corner is evaluated at this fraction of the way to the middle of the
// triangle: normals change little over it, and partial derivatives that vanish at the corner are
// above rounding.
#define WITHIN_PART 1e-3
// Limits that differ by less are equal.
#define SAME_DIRECTION (1 - 1e-6)

typedef struct Sides {
  CagMesh *m;
  const CagSurface *surface;
  double least; // cosine of the maximum angle by which corners may lean
  double noise;
  uint32_t *copy; // for vertices: the last copy of a vertex; for a copy: the previous one
  size_t capacity;
} Sides;

// Returns the normal of a triangle, or zero if its height is at most the noise.
static CagVec3 normal_of(const Sides *s, size_t t) {
  const uint32_t *k = s->m->triangles + 3 * t;
  const CagVec3 a = s->m->positions[k[0]];
  const CagVec3 ab = cag_sub(s->m->positions[k[1]], a), ac = cag_sub(s->m->positions[k[2]], a);
  const CagVec3 n = cag_cross(ab, ac);
  const double longest = fmax(cag_norm(ab), fmax(cag_norm(ac), cag_norm(cag_sub(ac, ab))));
  return cag_norm(n) > s->noise * longest ? cag_unit(n) : cag_vec3(0, 0, 0);
}

static bool leans(const Sides *s, size_t t, uint32_t j, CagVec3 n) {
  return cag_dot(n, n) > 0 && cag_dot(n, s->m->normals[s->m->triangles[3 * t + j]]) < s->least;
}

// The normal of the surface at a fraction of the way from corner j to the parameters `to`.
static bool normal_towards(const Sides *s, size_t t, uint32_t j, const double to[2], double part,
                           CagVec3 *out) {
  const double *from = s->m->uv + 2 * (size_t)s->m->triangles[3 * t + j];
  CagError ignored;
  return !cag_surface_normal(s->surface, from[0] + part * (to[0] - from[0]),
                             from[1] + part * (to[1] - from[1]), out, &ignored);
}

// Tests whether the normal is reversed abruptly between corners j and i. At a narrow rim it turns
// continuously.
static bool is_reversed_between(const Sides *s, size_t t, uint32_t j, uint32_t i) {
  enum { HALVINGS = 30 };
  const uint32_t *k = s->m->triangles + 3 * t;
  const double *to = s->m->uv + 2 * (size_t)k[i];
  CagVec3 before = s->m->normals[k[j]], after = s->m->normals[k[i]], n;
  double low = 0, high = 1;
  for (int step = 0; step < HALVINGS && cag_dot(before, after) < 0; step++) {
    const double half = (low + high) / 2;
    if (!normal_towards(s, t, j, to, half, &n)) break; // the cusp: no normal
    if (cag_dot(n, before) > cag_dot(n, after)) low = half, before = n;
    else high = half, after = n;
  }
  return cag_dot(before, after) < 0;
}

// A triangle with the normal n may span a cusp: the normal of corner j is then the opposite of
// those along the triangle.
static bool is_beyond_cusp(const Sides *s, size_t t, uint32_t j, CagVec3 n) {
  const uint32_t *k = s->m->triangles + 3 * t;
  if (!(cag_dot(s->m->normals[k[j]], n) < 0)) return false;
  for (uint32_t i = 0; i < 3; i++)
    if (cag_dot(s->m->normals[k[i]], n) > 0 && is_reversed_between(s, t, j, i)) return true;
  return false;
}

// The limit at corner j from within the triangle.
static bool normal_within(const Sides *s, size_t t, uint32_t j, CagVec3 *out) {
  const uint32_t *k = s->m->triangles + 3 * t;
  double middle[2] = {0, 0};
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < 2; i++) middle[i] += s->m->uv[2 * (size_t)k[c] + (size_t)i] / 3;
  return normal_towards(s, t, j, middle, WITHIN_PART, out);
}

// Returns the limit at a corner from within the triangle, if it differs from the normal of its
// vertex and is closer to the normal n of the triangle.
static bool find_limit(const Sides *s, size_t t, uint32_t j, CagVec3 n, CagVec3 *out) {
  const CagVec3 own = s->m->normals[s->m->triangles[3 * t + j]];
  if (normal_within(s, t, j, out) && cag_dot(*out, own) < s->least &&
      cag_dot(*out, n) > cag_dot(own, n))
    return true;
  *out = cag_scaled(own, -1);
  return is_beyond_cusp(s, t, j, n);
}

static CagStatus grow(Sides *s, CagError *err) {
  CagMesh *m = s->m;
  if (m->vertex_count < s->capacity) return CAG_OK;
  const size_t n = s->capacity + s->capacity / 2 + 64;
  if (n > UINT32_MAX) return cag_fail_memory(err);
  if (!CAG_RESIZE(m->positions, n) || !CAG_RESIZE(m->normals, n) || !CAG_RESIZE(m->uv, 2 * n) ||
      !CAG_RESIZE(m->weld, n) || !CAG_RESIZE(s->copy, n))
    return cag_fail_memory(err);
  s->capacity = n;
  return CAG_OK;
}

// The vertex at v with this normal.
static CagStatus copy_of(Sides *s, uint32_t v, CagVec3 normal, uint32_t *out, CagError *err) {
  CagMesh *m = s->m;
  for (uint32_t i = s->copy[v]; i != UINT32_MAX; i = s->copy[i])
    if (cag_dot(m->normals[i], normal) >= SAME_DIRECTION) {
      *out = i;
      return CAG_OK;
    }
  CagStatus status = grow(s, err);
  if (status) return status;
  const size_t at = m->vertex_count++;
  m->positions[at] = m->positions[v];
  m->normals[at] = normal;
  m->uv[2 * at] = m->uv[2 * (size_t)v];
  m->uv[2 * at + 1] = m->uv[2 * (size_t)v + 1];
  m->weld[at] = m->weld[v];
  s->copy[at] = s->copy[v];
  s->copy[v] = *out = (uint32_t)at;
  return CAG_OK;
}

static CagStatus begin(Sides *s, CagError *err) {
  CagMesh *m = s->m;
  if (!m->weld) {
    m->weld = cag_malloc((m->vertex_count + 1) * sizeof *m->weld);
    for (uint32_t v = 0; m->weld && v < m->vertex_count; v++) m->weld[v] = v;
  }
  s->capacity = m->vertex_count;
  s->copy = cag_malloc((s->capacity + 1) * sizeof *s->copy);
  if (!m->weld || !s->copy) return cag_fail_memory(err);
  for (size_t v = 0; v < s->capacity; v++) s->copy[v] = UINT32_MAX;
  return CAG_OK;
}

static CagStatus split_triangle(Sides *s, size_t t, CagError *err) {
  const CagVec3 n = normal_of(s, t);
  CagStatus status = CAG_OK;
  for (uint32_t j = 0; !status && j < 3; j++) {
    CagVec3 limit;
    uint32_t *corner = &s->m->triangles[3 * t + j];
    if (!leans(s, t, j, n) || !find_limit(s, t, j, n, &limit)) continue;
    if (!s->copy) status = begin(s, err);
    if (!status) status = copy_of(s, *corner, limit, corner, err);
  }
  return status;
}

CagStatus cag_mesh_split_sides(CagMesh *m, size_t from, size_t to, const CagSurface *surface,
                               double angle, double noise, CagError *err) {
  Sides s = {.m = m, .surface = surface, .least = cos(angle), .noise = noise};
  CagStatus status = CAG_OK;
  if (!(angle > 0)) return CAG_OK;
  for (size_t t = from; !status && t < to; t++) {
    status = cag_stop_check(err);
    if (!status) status = split_triangle(&s, t, err);
  }
  cag_free(s.copy);
  return status;
}
