// Values of surfaces at the vertices of their meshes.
//
// The mesh comes from tessellation, which keeps the parameters of each vertex. At an ordinary
// vertex the value is that of the surface there. At a break or a pole it depends on the side, so
// each corner of a triangle is evaluated slightly inside its triangle, and corners with different
// values become separate vertices, welded to the first.

#include "geom/meet/value_map.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/linalg/tolerance.h"
#include "geom/meet/curvature_line.h"

#define X(name, text) text,
const char *const cag_surface_values[] = {CAG_SURFACE_VALUES(X) NULL};
#undef X

#define DEGREES 57.29577951308232

// Fraction of a triangle by which a corner at a break or a pole is moved inside for evaluation.
#define INWARD 1e-3
// Relative difference above which two values at one vertex are distinct.
#define JUMP 1e-2
// A parameter closer to a break than this fraction of the domain is on it.
#define ON_BREAK CAG_COINCIDENT

static CagStatus value_at(const CagSurface *s, CagSurfaceValue kind, double u, double v,
                          bool *found, double *out, CagError *err) {
  CagPrincipal p;
  *found = false;
  *out = 0;
  if (kind == CAG_VALUE_SLOPE) {
    CagVec3 n;
    if (cag_surface_normal(s, u, v, &n, err)) return CAG_OK;
    *out = DEGREES * atan2(hypot(n.x, n.y), fabs(n.z));
    *found = true;
    return CAG_OK;
  }
  CagStatus status = cag_surface_principal(s, u, v, found, &p, err);
  if (status) return status;
  switch (kind) {
  case CAG_VALUE_GAUSSIAN: *out = p.k[0] * p.k[1]; break;
  case CAG_VALUE_MEAN: *out = (p.k[0] + p.k[1]) / 2; break;
  case CAG_VALUE_PRINCIPAL_MIN: *out = p.k[0]; break;
  default: *out = p.k[1];
  }
  *found = *found && isfinite(*out);
  return CAG_OK;
}

// --- Where the value depends on the side ---

typedef struct Breaks {
  double *at[2];
  size_t n[2];
  double same[2];
} Breaks;

static void free_breaks(Breaks *b) {
  cag_free(b->at[0]);
  cag_free(b->at[1]);
}

static bool read_breaks(const CagSurface *s, Breaks *b) {
  *b = (Breaks){.same = {ON_BREAK * (s->u1 - s->u0), ON_BREAK * (s->v1 - s->v0)}};
  for (int k = 0; k < 2; k++) {
    b->n[k] = s->kind->breaks ? s->kind->breaks(s, k, NULL, 0) : 0;
    b->at[k] = cag_malloc((b->n[k] + 1) * sizeof *b->at[k]);
    if (!b->at[k]) return false;
    if (b->n[k] > 0) s->kind->breaks(s, k, b->at[k], b->n[k]);
  }
  return true;
}

static bool on_break(const Breaks *b, const double *uv) {
  for (int k = 0; k < 2; k++) { // breaks ascend
    size_t low = 0, high = b->n[k];
    while (low < high) {
      size_t middle = (low + high) / 2;
      if (b->at[k][middle] < uv[k] - b->same[k]) low = middle + 1;
      else high = middle;
    }
    if (low < b->n[k] && b->at[k][low] <= uv[k] + b->same[k]) return true;
  }
  return false;
}

// --- The mesh with more vertices ---

typedef struct Draft {
  const CagSurface *s;
  CagSurfaceValue kind;
  const CagMesh *plain;
  bool *sided;       // for each vertex of plain: its value depends on the side
  double *values;    // for each vertex of the draft
  uint32_t *origin;  // vertex of plain
  uint32_t *next;    // another vertex of the same origin; UINT32_MAX: none
  bool *known;       // has a value
  uint32_t *corners; // like CagMesh.triangles
  size_t count, capacity;
} Draft;

static bool make_room(Draft *d) {
  if (d->count < d->capacity) return true;
  size_t room = d->capacity + d->capacity / 4 + 64;
  if (!CAG_RESIZE(d->values, room) || !CAG_RESIZE(d->origin, room) || !CAG_RESIZE(d->next, room) ||
      !CAG_RESIZE(d->known, room))
    return false;
  d->capacity = room;
  return true;
}

// The vertex at the same position with this value: an existing one, or a new one.
static bool take_vertex(Draft *d, uint32_t first, bool found, double value, uint32_t *out) {
  uint32_t k = first;
  if (!found) { // regardless of its neighbors
    *out = first;
    return true;
  }
  for (;; k = d->next[k]) {
    if (!d->known[k]) {
      d->known[k] = true;
      d->values[k] = value;
      break;
    }
    if (fabs(d->values[k] - value) <= JUMP * fmax(fabs(d->values[k]), fabs(value))) break;
    if (d->next[k] != UINT32_MAX) continue;
    if (!make_room(d)) return false;
    d->next[k] = (uint32_t)d->count;
    d->origin[d->count] = first;
    d->values[d->count] = value;
    d->known[d->count] = true;
    d->next[d->count] = UINT32_MAX;
    k = (uint32_t)d->count++;
    break;
  }
  *out = k;
  return true;
}

static CagStatus take_corner(Draft *d, size_t triangle, int corner, CagError *err) {
  const uint32_t *t = d->plain->triangles + 3 * triangle;
  const double *uv = d->plain->uv;
  bool found;
  double value, at[2];
  for (int k = 0; k < 2; k++) {
    double middle = (uv[2 * t[0] + k] + uv[2 * t[1] + k] + uv[2 * t[2] + k]) / 3;
    at[k] = uv[2 * t[corner] + k] + INWARD * (middle - uv[2 * t[corner] + k]);
  }
  CagStatus status = value_at(d->s, d->kind, at[0], at[1], &found, &value, err);
  if (status) return status;
  bool ok = take_vertex(d, t[corner], found, value, &d->corners[3 * triangle + (size_t)corner]);
  return ok ? CAG_OK : cag_fail_memory(err);
}

// Vertices without a value from any side (the surface has no normal all around) take a neighbor's.
static void fill_unknown(Draft *d) {
  for (size_t t = 0; t < d->plain->triangle_count; t++) {
    const uint32_t *k = d->corners + 3 * t;
    for (int j = 0; j < 3; j++)
      for (int i = 0; i < 3; i++)
        if (!d->known[k[j]] && d->known[k[i]]) {
          d->values[k[j]] = d->values[k[i]];
          d->known[k[j]] = true;
        }
  }
}

static CagStatus find_values(Draft *d, const CagTessellation *how, CagError *err) {
  const size_t look_up = 1024; // vertices between checks of the stop flag
  const CagMesh *m = d->plain;
  Breaks breaks;
  CagStatus status = read_breaks(d->s, &breaks) ? CAG_OK : cag_fail_memory(err);
  for (size_t v = 0; !status && v < m->vertex_count; v++) {
    const double *uv = m->uv + 2 * v;
    bool found = false;
    d->origin[v] = (uint32_t)v;
    d->next[v] = UINT32_MAX;
    if (v % look_up == 0 && how->interrupt && *how->interrupt)
      status =
          cag_fail(err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1, "the meshing was interrupted");
    else if (!on_break(&breaks, uv))
      status = value_at(d->s, d->kind, uv[0], uv[1], &found, &d->values[v], err);
    d->known[v] = found;
    d->sided[v] = !found;
  }
  free_breaks(&breaks);
  for (size_t k = 0; !status && k < 3 * m->triangle_count; k++) {
    d->corners[k] = m->triangles[k];
    if (d->sided[m->triangles[k]]) status = take_corner(d, k / 3, (int)(k % 3), err);
  }
  if (!status) fill_unknown(d);
  return status;
}

static CagStatus finish(const Draft *d, CagMesh **out, CagError *err) {
  const CagMesh *m = d->plain;
  CagMesh *c = NULL;
  bool weld = m->weld || d->count > m->vertex_count;
  CagStatus status =
      cag_mesh_new(d->count, m->triangle_count, m->normals != NULL, true, weld, &c, err);
  if (status) return status;
  for (size_t v = 0; v < d->count; v++) {
    uint32_t o = d->origin[v];
    c->positions[v] = m->positions[o];
    if (m->normals) c->normals[v] = m->normals[o];
    if (weld) c->weld[v] = m->weld ? m->weld[o] : o;
    c->uv[2 * v] = d->values[v];
    c->uv[2 * v + 1] = 0;
  }
  memcpy(c->triangles, d->corners, 3 * m->triangle_count * sizeof *c->triangles);
  *out = c;
  return CAG_OK;
}

static CagStatus values_of(const CagSurface *s, CagSurfaceValue kind, const CagMesh *plain,
                           const CagTessellation *how, CagMesh **out, CagError *err) {
  size_t n = plain->vertex_count;
  Draft d = {.s = s,
             .kind = kind,
             .plain = plain,
             .sided = cag_malloc((n + 1) * sizeof *d.sided),
             .values = cag_malloc((n + 1) * sizeof *d.values),
             .origin = cag_malloc((n + 1) * sizeof *d.origin),
             .next = cag_malloc((n + 1) * sizeof *d.next),
             .known = cag_malloc((n + 1) * sizeof *d.known),
             .corners = cag_malloc((3 * plain->triangle_count + 1) * sizeof *d.corners),
             .count = n,
             .capacity = n};
  CagStatus status = d.sided && d.values && d.origin && d.next && d.known && d.corners
                         ? find_values(&d, how, err)
                         : cag_fail_memory(err);
  if (!status) status = finish(&d, out, err);
  cag_free(d.sided);
  cag_free(d.values);
  cag_free(d.origin);
  cag_free(d.next);
  cag_free(d.known);
  cag_free(d.corners);
  return status;
}

// --- Refinement ---

// Maximum length of an edge of the first mesh as a fraction of the diagonal of the bounds, maximum
// turn of the normal along it in radians, maximum fraction of all values that one edge may span
// before the mesh is refined, and limits on the number of refinements and triangles.
#define EDGE_PART 0.02
#define EDGE_TURN 0.07
#define EDGE_SPAN 0.05
#define ROUNDS 3
#define TRIANGLES_FINE 250000

// Fraction of the triangles whose values span more than an edge may.
static double coarse_share(const CagMesh *m) {
  double from, to;
  size_t coarse = 0;
  cag_mesh_value_span((CagMesh *[]){(CagMesh *)m}, 1, 0, &from, &to);
  for (size_t t = 0; t < m->triangle_count; t++) {
    double low = INFINITY, high = -INFINITY;
    for (int k = 0; k < 3; k++) {
      double x = fmin(fmax(m->uv[2 * m->triangles[3 * t + (size_t)k]], from), to);
      low = fmin(low, x);
      high = fmax(high, x);
    }
    coarse += high - low > EDGE_SPAN * (to - from);
  }
  return m->triangle_count > 0 ? (double)coarse / (double)m->triangle_count : 0;
}

CagStatus cag_surface_value_mesh(const CagSurface *s, CagSurfaceValue value,
                                 const CagTessellation *how, CagMesh **out, CagError *err) {
  const double coarse_most = 0.02;
  CagBounds box;
  CagTessellation fine = *how;
  CagStatus status = cag_surface_bounds(s, &box, err);
  if (status) return status;
  fine.max_edge = EDGE_PART * cag_norm(cag_sub(box.max, box.min));
  fine.angle = fmin(how->angle, EDGE_TURN);
  *out = NULL;
  for (int round = 0; !status && round < ROUNDS; round++, fine.max_edge /= 2) {
    CagMesh *plain = NULL, *finer = NULL;
    status = cag_surface_tessellate(s, &fine, &plain, err);
    if (!status) status = values_of(s, value, plain, how, &finer, err);
    cag_mesh_release(plain);
    if (status) break;
    cag_mesh_release(*out);
    *out = finer;
    // The next mesh has four times as many triangles.
    if (4 * finer->triangle_count > TRIANGLES_FINE ||
        4 * finer->triangle_count > how->max_triangles || coarse_share(finer) <= coarse_most)
      break;
  }
  if (status) {
    cag_mesh_release(*out);
    *out = NULL;
  }
  return status;
}

// --- The span of values ---

typedef struct Sample {
  double value, weight;
} Sample;

static int by_value(const void *a, const void *b) {
  double x = ((const Sample *)a)->value, y = ((const Sample *)b)->value;
  return (x > y) - (x < y);
}

// A tail that extends farther than this fraction of the rest is cut off.
#define TAIL_AREA 0.02
#define TAIL_REACH 0.5

static void add_samples(const CagMesh *m, Sample *out) {
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    CagVec3 a = m->positions[k[0]];
    CagVec3 n = cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a));
    for (int j = 0; j < 3; j++) out[3 * t + (size_t)j] = (Sample){m->uv[2 * k[j]], cag_norm(n)};
  }
}

static void span_of_samples(const Sample *s, size_t n, double *from, double *to) {
  double total = 0, sum = 0, low = s[0].value, high = s[n - 1].value;
  for (size_t i = 0; i < n; i++) total += s[i].weight;
  *from = low;
  *to = high;
  bool begun = false;
  for (size_t i = 0; i < n; i++) {
    sum += s[i].weight;
    if (!begun && sum >= TAIL_AREA * total) low = s[i].value, begun = true;
    if (sum <= (1 - TAIL_AREA) * total) high = s[i].value;
  }
  if (high < low) return;
  const double rest = high - low;
  if (*from < low - TAIL_REACH * rest) *from = low;
  if (*to > high + TAIL_REACH * rest) *to = high;
}

void cag_mesh_value_span(CagMesh *const *meshes, size_t n, double least, double *from, double *to) {
  size_t triangles = 0, at = 0;
  *from = 0;
  *to = 1;
  for (size_t i = 0; i < n; i++) triangles += meshes[i]->triangle_count;
  Sample *s = triangles > 0 ? cag_malloc(3 * triangles * sizeof *s) : NULL;
  if (!s) return;
  for (size_t i = 0; i < n; i++) {
    add_samples(meshes[i], s + at);
    at += 3 * meshes[i]->triangle_count;
  }
  qsort(s, at, sizeof *s, by_value);
  span_of_samples(s, at, from, to);
  cag_free(s);
  const double same = 1e-6; // relative to the value: smaller differences are rounding of second
                            // derivatives
  double large = fmax(fabs(*from), fabs(*to));
  if (*to - *from > fmax(same * large, least)) return;
  double around = large > least ? large / 2 : 1;
  double middle = large > least ? (*from + *to) / 2 : 0;
  *from = middle - around;
  *to = middle + around;
}

// --- Reflections ---

CagStatus cag_mesh_reflect(CagMesh *m, CagVec3 eye, CagVec3 across, CagError *err) {
  if (!m->uv) {
    m->uv = cag_malloc((m->vertex_count + 1) * 2 * sizeof *m->uv);
    if (!m->uv) return cag_fail_memory(err);
  }
  for (size_t v = 0; v < m->vertex_count; v++) {
    CagVec3 n = m->normals[v];
    // across . (2 (n . e) n - e), and across . e is 0.
    m->uv[2 * v] = 2 * cag_dot(n, eye) * cag_dot(n, across);
    m->uv[2 * v + 1] = 0;
  }
  return CAG_OK;
}
