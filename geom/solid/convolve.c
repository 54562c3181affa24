// Minkowski sums by convolution.
//
// The convolution of a closed mesh with a convex body B has, for each face of the mesh, the face
// moved by the vertex of B that is farthest along its normal; for each edge, the parallelograms of
// the edge and of the edges of B that the normal passes as it turns from one face to the other; and
// for each vertex, the faces of B whose normals are within the polygon of the normals around the
// vertex, as often as the polygon winds around them. It winds around a point x as often as the
// Euler characteristic of the part of the solid within x - B (Guibas, Ramshaw, and Stolfi 1983, A
// kinetic framework for computational geometry, for the plane).
//
// That is positive for points of the sum, unless the part has a hole, as the rim of a cup that B
// covers. Such a part has concave edges. If the result has points that are nearer to the solid than
// B reaches, the sums of B and of the concave edges there are added, until there are none.
//
// All positions are sums of a vertex of the mesh and one of B, so that pieces fit exactly. The
// paths over B are found with slightly rotated normals, which are never perpendicular to its edges.

#include "geom/solid/convolve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/boolean/boolean.h"
#include "geom/linalg/tolerance.h"
#include "geom/mesh/box_tree.h"
#include "geom/mesh/distance.h"
#include "geom/mesh/edges.h"
#include "geom/mesh/hull.h"
#include "geom/solid/ball.h"
#include "geom/solid/csg.h"

#define NONE UINT32_MAX
// Rotation (radians) of the normals for decisions: far above rounding, far below the angles between
// the faces of a body.
#define ROTATION 1e-6
// An edge whose faces turn by less than this (sine) to the inside is not concave.
#define CONCAVE 1e-9
// A point of the result is inside of the sum if this part of the body reaches the solid.
#define INSIDE (1 - 1e-6)
// To find holes of the sum with a ball, it is if it is deeper than the faces of the polyhedron by this multiple of their
// distance from the sphere. Vertices that pass through a face of the polyhedron leave holes of less
// depth, which are within the tolerance.
#define DEPTH 1.5
// Rounds of adding concave edges. Each one closes all holes at the points that it finds.
#define ROUNDS 20
// Faces of the body that are compared to find one far from the normals of a vertex.
#define CANDIDATES 48

// --- The body ---

typedef struct Neighbor {
  uint32_t vertex, face; // the face on the left of the edge to the vertex
} Neighbor;

typedef struct Body {
  const CagMesh *mesh;
  bool round;       // on a sphere about the origin
  CagVec3 *normals; // of faces, unit
  uint32_t *first;  // neighbors of vertex i: first[i] .. first[i + 1] - 1, in `around`
  Neighbor *around;
  CagVec3 center;
  double inner, outer; // radii of balls about the center, inside and around
  double sure;         // points this close are inside of the sum
} Body;

static void body_free(Body *b) {
  cag_free(b->normals);
  cag_free(b->first);
  cag_free(b->around);
}

static CagVec3 triangle_normal(CagVec3 a, CagVec3 b, CagVec3 c) {
  return cag_unit(cag_cross(cag_sub(b, a), cag_sub(c, a)));
}

// The mesh is a hull, without copies of vertices.
static CagStatus body_new(const CagMesh *m, bool round, Body *out, CagError *err) {
  const size_t n = m->vertex_count, faces = m->triangle_count;
  *out = (Body){m,
                round,
                cag_malloc((faces + 1) * sizeof(CagVec3)),
                cag_calloc(n + 2, sizeof(uint32_t)),
                cag_malloc((3 * faces + 1) * sizeof(Neighbor)),
                {0, 0, 0},
                INFINITY,
                0,
                0};
  if (!out->normals || !out->first || !out->around) {
    body_free(out);
    return cag_fail_memory(err);
  }
  for (size_t i = 0; i < 3 * faces; i++) out->first[m->triangles[i] + 2]++;
  for (size_t i = 0; i < n; i++) out->first[i + 2] += out->first[i + 1];
  for (size_t f = 0; f < faces; f++) {
    const uint32_t *v = m->triangles + 3 * f;
    out->normals[f] = triangle_normal(m->positions[v[0]], m->positions[v[1]], m->positions[v[2]]);
    for (int k = 0; k < 3; k++)
      out->around[out->first[v[k] + 1]++] = (Neighbor){v[(k + 1) % 3], (uint32_t)f};
  }
  if (!round) {
    for (size_t i = 0; i < n; i++) out->center = cag_add(out->center, m->positions[i]);
    out->center = cag_scaled(out->center, 1 / (double)n);
  }
  for (size_t i = 0; i < n; i++)
    out->outer = fmax(out->outer, cag_norm(cag_sub(m->positions[i], out->center)));
  for (size_t f = 0; f < faces; f++)
    out->inner = fmin(out->inner, cag_dot(out->normals[f],
                                          cag_sub(m->positions[m->triangles[3 * f]], out->center)));
  out->sure = round ? out->inner - DEPTH * (out->outer - out->inner) : INSIDE * out->inner;
  return CAG_OK;
}

// The vertex farthest along n, uphill from a given one.
static uint32_t farthest(const Body *b, CagVec3 n, uint32_t from) {
  for (;;) {
    uint32_t best = from;
    double most = 0;
    for (uint32_t k = b->first[from]; k < b->first[from + 1]; k++) {
      const uint32_t v = b->around[k].vertex;
      const double more = cag_dot(n, cag_sub(b->mesh->positions[v], b->mesh->positions[from]));
      if (more > most) {
        most = more;
        best = v;
      }
    }
    if (best == from) return from;
    from = best;
  }
}

// The next vertex on the path along which the farthest vertex moves as the normal turns from n to
// m, or NONE: it stays the farthest. The condition is linear in the normal.
static uint32_t next_on_path(const Body *b, CagVec3 n, CagVec3 m, uint32_t at) {
  uint32_t best = NONE;
  double least = INFINITY;
  for (uint32_t k = b->first[at]; k < b->first[at + 1]; k++) {
    const uint32_t v = b->around[k].vertex;
    const CagVec3 step = cag_sub(b->mesh->positions[v], b->mesh->positions[at]);
    const double before = cag_dot(n, step), after = cag_dot(m, step);
    if (!(after > 0)) continue;
    const double when = -before / (after - before);
    if (before >= after || when < least) {
      least = before >= after ? -INFINITY : when;
      best = v;
    }
  }
  return best;
}

// --- The solid ---

// An edge with the triangles on its left and right.
typedef struct SolidEdge {
  uint32_t from, to, left, right;
} SolidEdge;

typedef struct Solid {
  const CagMesh *mesh;
  uint32_t *corners; // of triangles, welded
  CagVec3 *normals;
  CagVec3 *turned;   // normals for decisions
  uint32_t *support; // the farthest vertex of the body, by face
  SolidEdge *edges;
  size_t edge_count;
  uint32_t *first, *incident; // edges of vertex i: first[i] .. first[i + 1] - 1, in `incident`
  double *angles;             // of the faces at each vertex, added
  uint32_t *concave;
  size_t concave_count;
} Solid;

static void solid_free(Solid *s) {
  cag_free(s->corners);
  cag_free(s->normals);
  cag_free(s->turned);
  cag_free(s->support);
  cag_free(s->edges);
  cag_free(s->first);
  cag_free(s->incident);
  cag_free(s->angles);
  cag_free(s->concave);
}

// A rotation by ROTATION about an axis without meaning.
static CagVec3 turned(CagVec3 n) {
  const CagVec3 axis = {0.5571, 0.3263, -0.7637};
  return cag_madd(n, ROTATION, cag_cross(axis, n));
}

static uint32_t corner_off_edge(const Solid *s, uint32_t triangle, const SolidEdge *e) {
  const uint32_t *v = s->corners + 3 * triangle;
  for (int k = 0; k < 3; k++)
    if (v[k] != e->from && v[k] != e->to) return v[k];
  return v[0];
}

// Whether the faces of the edge enclose more than half a turn inside.
static bool is_concave(const Solid *s, const SolidEdge *e) {
  const CagVec3 p = s->mesh->positions[e->from];
  const CagVec3 across = cag_sub(s->mesh->positions[corner_off_edge(s, e->right, e)], p);
  return cag_dot(s->normals[e->left], across) > CONCAVE * cag_norm(across);
}

static CagStatus find_edges(Solid *s, CagError *err) {
  size_t n = 0;
  CagMeshEdge *uses =
      cag_mesh_edges(s->corners, s->mesh->triangle_count, NULL, s->mesh->vertex_count, &n);
  s->edges = cag_malloc((n / 2 + 1) * sizeof *s->edges);
  CagStatus status = uses && s->edges ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i + 1 < n; i += 2) {
    const CagMeshEdge *a = &uses[i], *b = &uses[i + 1];
    const bool ahead = cag_mesh_edge_forward(a);
    if (a->low != b->low || a->high != b->high || ahead == cag_mesh_edge_forward(b)) {
      status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_mesh_open, "mesh", -1,
                        "the mesh must be closed, with each edge in two triangles");
      break;
    }
    const uint32_t t[2] = {(uint32_t)cag_mesh_edge_triangle(a),
                           (uint32_t)cag_mesh_edge_triangle(b)};
    s->edges[s->edge_count++] =
        (SolidEdge){a->low, a->high, ahead ? t[0] : t[1], ahead ? t[1] : t[0]};
  }
  cag_free(uses);
  return status;
}

static CagStatus find_incident(Solid *s, CagError *err) {
  const size_t n = s->mesh->vertex_count;
  s->first = cag_calloc(n + 2, sizeof *s->first);
  s->incident = cag_malloc((2 * s->edge_count + 1) * sizeof *s->incident);
  s->concave = cag_malloc((s->edge_count + 1) * sizeof *s->concave);
  if (!s->first || !s->incident || !s->concave) return cag_fail_memory(err);
  for (size_t i = 0; i < s->edge_count; i++) {
    s->first[s->edges[i].from + 2]++;
    s->first[s->edges[i].to + 2]++;
  }
  for (size_t i = 0; i < n; i++) s->first[i + 2] += s->first[i + 1];
  for (size_t i = 0; i < s->edge_count; i++) {
    s->incident[s->first[s->edges[i].from + 1]++] = (uint32_t)i;
    s->incident[s->first[s->edges[i].to + 1]++] = (uint32_t)i;
    if (is_concave(s, &s->edges[i])) s->concave[s->concave_count++] = (uint32_t)i;
  }
  return CAG_OK;
}

static double angle_between(CagVec3 a, CagVec3 b) {
  return atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b));
}

static CagStatus solid_new(const CagMesh *m, Solid *out, CagError *err) {
  const size_t n = m->vertex_count, faces = m->triangle_count;
  *out = (Solid){.mesh = m,
                 .corners = cag_malloc((3 * faces + 1) * sizeof *out->corners),
                 .normals = cag_malloc((faces + 1) * sizeof *out->normals),
                 .turned = cag_malloc((faces + 1) * sizeof *out->turned),
                 .support = cag_calloc(faces + 1, sizeof *out->support),
                 .angles = cag_calloc(n + 1, sizeof *out->angles)};
  CagStatus status = CAG_OK;
  if (!out->corners || !out->normals || !out->turned || !out->support || !out->angles)
    status = cag_fail_memory(err);
  for (size_t f = 0; !status && f < faces; f++) {
    uint32_t *v = out->corners + 3 * f;
    CagVec3 p[3];
    for (int k = 0; k < 3; k++) {
      const uint32_t i = m->triangles[3 * f + k];
      v[k] = m->weld ? m->weld[i] : i;
      p[k] = m->positions[v[k]];
    }
    out->normals[f] = triangle_normal(p[0], p[1], p[2]);
    out->turned[f] = turned(out->normals[f]);
    for (int k = 0; k < 3; k++)
      out->angles[v[k]] +=
          angle_between(cag_sub(p[(k + 1) % 3], p[k]), cag_sub(p[(k + 2) % 3], p[k]));
  }
  if (!status) status = find_edges(out, err);
  if (!status) status = find_incident(out, err);
  if (status) solid_free(out);
  return status;
}

// --- The pieces ---

// Triangles with their own corners.
typedef struct Pieces {
  CagVec3 *at, *normals;
  size_t n, room, normal_room;
  bool smooth; // with normals
} Pieces;

static void pieces_free(Pieces *p) {
  cag_free(p->at);
  cag_free(p->normals);
}

static CagStatus put_triangle(Pieces *p, const CagVec3 at[3], const CagVec3 normals[3],
                              CagError *err) {
  if (!CAG_RESERVE(p->at, p->room, p->n + 3)) return cag_fail_memory(err);
  if (p->smooth && !CAG_RESERVE(p->normals, p->normal_room, p->n + 3)) return cag_fail_memory(err);
  for (int k = 0; k < 3; k++) {
    p->at[p->n + (size_t)k] = at[k];
    if (p->smooth) p->normals[p->n + (size_t)k] = normals[k];
  }
  p->n += 3;
  return CAG_OK;
}

// A triangle whose corners are sums of points and vertices of the body.
static CagStatus put_sum(Pieces *p, const Body *b, const CagVec3 at[3], const uint32_t v[3],
                         CagError *err) {
  CagVec3 sums[3], normals[3];
  for (int k = 0; k < 3; k++) {
    const CagVec3 q = b->mesh->positions[v[k]];
    sums[k] = cag_add(at[k], q);
    normals[k] = b->round ? cag_unit(q) : (CagVec3){0, 0, 0};
  }
  return put_triangle(p, sums, normals, err);
}

static CagStatus pieces_mesh(const Pieces *p, CagMesh **out, CagError *err) {
  CagMesh *m;
  CagStatus status = cag_mesh_new(p->n, p->n / 3, p->smooth, false, false, &m, err);
  if (status) return status;
  if (p->n) memcpy(m->positions, p->at, p->n * sizeof *p->at);
  if (p->n && p->smooth) memcpy(m->normals, p->normals, p->n * sizeof *p->normals);
  for (size_t i = 0; i < p->n; i++) m->triangles[i] = (uint32_t)i;
  *out = m;
  return CAG_OK;
}

static CagStatus add_faces(Pieces *out, Solid *s, const Body *b, CagError *err) {
  uint32_t at = 0;
  for (size_t f = 0; f < s->mesh->triangle_count; f++) {
    CagVec3 p[3];
    at = s->support[f] = farthest(b, s->turned[f], at);
    const uint32_t v[3] = {at, at, at};
    for (int k = 0; k < 3; k++) p[k] = s->mesh->positions[s->corners[3 * f + k]];
    CagStatus status = put_sum(out, b, p, v, err);
    if (!status && f % 1024 == 0) status = cag_stop_check(err);
    if (status) return status;
  }
  return CAG_OK;
}

// Calls `step` for each edge of the body that the normal passes from the left face to the right one.
typedef CagStatus PathStep(void *context, const SolidEdge *e, uint32_t from, uint32_t to,
                           CagError *err);

static CagStatus follow_path(const Solid *s, const Body *b, const SolidEdge *e, PathStep *step,
                             void *context, CagError *err) {
  uint32_t at = s->support[e->left];
  const uint32_t end = s->support[e->right];
  // A path over a convex body visits no vertex twice.
  for (size_t k = 0; at != end && k < b->mesh->vertex_count; k++) {
    const uint32_t next = next_on_path(b, s->turned[e->left], s->turned[e->right], at);
    if (next == NONE) break;
    const CagStatus status = step(context, e, at, next, err);
    if (status) return status;
    at = next;
  }
  return at == end ? CAG_OK
                   : cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_convergence, "", -1,
                              "the normals at an edge of the mesh are undecided by rounding");
}

typedef struct EdgePieces {
  Pieces *out;
  const Solid *s;
  const Body *b;
} EdgePieces;

static CagStatus add_parallelogram(void *context, const SolidEdge *e, uint32_t from, uint32_t to,
                                   CagError *err) {
  const EdgePieces *w = context;
  const CagVec3 p = w->s->mesh->positions[e->from], q = w->s->mesh->positions[e->to];
  const CagVec3 one[3] = {q, p, p}, two[3] = {q, p, q};
  const uint32_t v_one[3] = {from, from, to}, v_two[3] = {from, to, to};
  const CagStatus status = put_sum(w->out, w->b, one, v_one, err);
  return status ? status : put_sum(w->out, w->b, two, v_two, err);
}

static CagStatus add_edges(Pieces *out, const Solid *s, const Body *b, CagError *err) {
  EdgePieces w = {out, s, b};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < s->edge_count; i++) {
    status = follow_path(s, b, &s->edges[i], add_parallelogram, &w, err);
    if (!status && i % 1024 == 0) status = cag_stop_check(err);
  }
  return status;
}

// How often each face of the body belongs to a vertex of the solid. `crossings` of the directed
// edges of the body: how often the faces on the left belong to it more often than those on the
// right.
typedef struct Around {
  const Body *b;
  uint32_t vertex;
  int32_t *crossings; // as `around` of the body
  int32_t *times;     // by face
  uint32_t *queue;
  bool *known;
  bool any;
} Around;

static uint32_t directed_edge(const Body *b, uint32_t from, uint32_t to) {
  for (uint32_t k = b->first[from]; k < b->first[from + 1]; k++)
    if (b->around[k].vertex == to) return k;
  return b->first[from];
}

static CagStatus count_step(void *context, const SolidEdge *e, uint32_t from, uint32_t to,
                            CagError *err) {
  (void)err;
  Around *w = context;
  const int sign = e->from == w->vertex ? -1 : 1;
  w->crossings[directed_edge(w->b, from, to)] += sign;
  w->crossings[directed_edge(w->b, to, from)] -= sign;
  w->any = true;
  return CAG_OK;
}

// The signed area of a spherical triangle (van Oosterom and Strackee 1983).
static double spherical_area(CagVec3 a, CagVec3 b, CagVec3 c) {
  return 2 * atan2(cag_dot(a, cag_cross(b, c)), 1 + cag_dot(a, b) + cag_dot(b, c) + cag_dot(c, a));
}

// A face whose normal is far from those around the vertex.
static uint32_t far_face(const Solid *s, const Body *b, uint32_t vertex) {
  const size_t faces = b->mesh->triangle_count, step = faces / CANDIDATES + 1;
  uint32_t best = 0;
  double least = INFINITY;
  for (size_t f = 0; f < faces; f += step) {
    double most = -1;
    for (uint32_t k = s->first[vertex]; k < s->first[vertex + 1]; k++) {
      const SolidEdge *e = &s->edges[s->incident[k]];
      const CagVec3 l = s->normals[e->left], r = s->normals[e->right];
      most = fmax(most, fmax(cag_dot(b->normals[f], l), cag_dot(b->normals[f], r)));
      most = fmax(most, cag_dot(b->normals[f], cag_unit(cag_add(l, r))));
    }
    if (most >= least) continue;
    least = most;
    best = (uint32_t)f;
  }
  return best;
}

// How often the normals around the vertex wind about the normal of a face of the body. The area
// that they enclose is the angle by which the faces at the vertex fall short of a full turn; the
// triangles from the opposite point do not contain the normal.
static int winding_about(const Solid *s, uint32_t vertex, CagVec3 q) {
  const CagVec3 apex = cag_scaled(q, -1);
  double area = 2 * M_PI - s->angles[vertex];
  for (uint32_t k = s->first[vertex]; k < s->first[vertex + 1]; k++) {
    const SolidEdge *e = &s->edges[s->incident[k]];
    // Counter-clockwise about the vertex, an edge that starts there leads from right to left.
    const bool out = e->from == vertex;
    area -= spherical_area(apex, s->normals[out ? e->right : e->left],
                           s->normals[out ? e->left : e->right]);
  }
  return (int)lround(area / (4 * M_PI));
}

// Spreads the number of the first face to the others: it changes where paths cross.
static void spread_times(Around *w, uint32_t start, int32_t times) {
  const CagMesh *m = w->b->mesh;
  size_t head = 0, tail = 0;
  memset(w->known, 0, m->triangle_count * sizeof *w->known);
  w->queue[tail++] = start;
  w->known[start] = true;
  w->times[start] = times;
  while (head < tail) {
    const uint32_t f = w->queue[head++], *v = m->triangles + 3 * f;
    for (int k = 0; k < 3; k++) {
      const uint32_t a = v[k], b = v[(k + 1) % 3];
      const uint32_t g = w->b->around[directed_edge(w->b, b, a)].face;
      if (w->known[g]) continue;
      w->known[g] = true;
      w->times[g] = w->times[f] - w->crossings[directed_edge(w->b, a, b)];
      w->queue[tail++] = g;
    }
  }
}

static CagStatus add_corner(Pieces *out, const Solid *s, Around *w, CagError *err) {
  const Body *b = w->b;
  const uint32_t vertex = w->vertex;
  const CagVec3 p = s->mesh->positions[vertex], at[3] = {p, p, p};
  const uint32_t start = far_face(s, b, vertex);
  const int base = winding_about(s, vertex, b->normals[start]);
  if (!w->any && base == 0) return CAG_OK;
  spread_times(w, start, base);
  for (size_t f = 0; f < b->mesh->triangle_count; f++) {
    const uint32_t *v = b->mesh->triangles + 3 * f;
    const bool back = w->times[f] < 0;
    const uint32_t turn[3] = {v[0], back ? v[2] : v[1], back ? v[1] : v[2]};
    for (int32_t k = abs(w->times[f]); k > 0; k--) {
      const CagStatus status = put_sum(out, b, at, turn, err);
      if (status) return status;
    }
  }
  return CAG_OK;
}

static CagStatus add_vertices(Pieces *out, const Solid *s, const Body *b, CagError *err) {
  const size_t faces = b->mesh->triangle_count;
  Around w = {.b = b,
              .crossings = cag_calloc(3 * faces + 1, sizeof *w.crossings),
              .times = cag_calloc(faces + 1, sizeof *w.times),
              .queue = cag_malloc((faces + 1) * sizeof *w.queue),
              .known = cag_calloc(faces + 1, sizeof *w.known)};
  CagStatus status = CAG_OK;
  if (!w.crossings || !w.times || !w.queue || !w.known) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < s->mesh->vertex_count; i++) {
    if (s->first[i] == s->first[i + 1]) continue;
    w.vertex = (uint32_t)i;
    if (w.any) memset(w.crossings, 0, 3 * faces * sizeof *w.crossings);
    w.any = false;
    for (uint32_t k = s->first[i]; !status && k < s->first[i + 1]; k++)
      status = follow_path(s, b, &s->edges[s->incident[k]], count_step, &w, err);
    if (!status) status = add_corner(out, s, &w, err);
    if (!status && i % 256 == 0) status = cag_stop_check(err);
  }
  cag_free(w.crossings);
  cag_free(w.times);
  cag_free(w.queue);
  cag_free(w.known);
  return status;
}

// --- Holes that the winding numbers leave ---

// Whether a segment or triangle (n points) has a point in x minus the scaled body.
static bool body_reaches(const Body *b, CagVec3 x, const CagVec3 *points, size_t n, double scale) {
  CagVec3 ring[64], next[64];
  const size_t most = 60;
  memcpy(ring, points, n * sizeof *ring);
  for (size_t f = 0; f < b->mesh->triangle_count; f++) {
    const CagVec3 normal = b->normals[f];
    const double level =
        cag_dot(normal, b->center) +
        scale * cag_dot(normal, cag_sub(b->mesh->positions[b->mesh->triangles[3 * f]], b->center));
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
      const CagVec3 p = ring[i], q = ring[(i + 1) % n];
      const double dp = level - cag_dot(normal, cag_sub(x, p));
      const double dq = level - cag_dot(normal, cag_sub(x, q));
      if (dp >= 0) next[kept++] = p;
      if ((dp < 0) != (dq < 0)) next[kept++] = cag_lerp(p, q, dp / (dp - dq));
    }
    if (kept == 0) return false;
    if (kept > most) return true;
    n = kept;
    memcpy(ring, next, n * sizeof *ring);
  }
  return true;
}

// Whether the body reaches the segment or triangle (n points) from x. For a ball, the distance
// decides, unless the result must be `exact`.
static bool is_within(const Body *b, bool exact, CagVec3 x, const CagVec3 *points, size_t n) {
  const CagVec3 c = cag_sub(x, b->center);
  const double d = n == 2 ? cag_distance_to_segment(c, points[0], points[1])
                          : cag_distance_to_triangle(c, points[0], points[1], points[2]);
  if (d < b->sure) return true;
  return (exact || !b->round) && d < b->outer && body_reaches(b, x, points, n, INSIDE);
}

// Trees of the triangles of the solid, and of its concave edges.
typedef struct Search {
  const Solid *s;
  const Body *b;
  CagBoxTree triangles, edges;
} Search;

static void search_free(Search *w) {
  cag_box_tree_free(&w->triangles);
  cag_box_tree_free(&w->edges);
}

static CagStatus search_new(const Solid *s, const Body *b, Search *out, CagError *err) {
  const CagVec3 *at = s->mesh->positions;
  const size_t n = s->mesh->triangle_count, most = n > s->concave_count ? n : s->concave_count;
  *out = (Search){.s = s, .b = b};
  CagBounds *boxes = cag_malloc((most + 1) * sizeof *boxes);
  if (!boxes) return cag_fail_memory(err);
  for (size_t f = 0; f < n; f++) {
    boxes[f] = CAG_BOUNDS_EMPTY;
    for (int k = 0; k < 3; k++) cag_bounds_add(&boxes[f], at[s->corners[3 * f + (size_t)k]]);
  }
  CagStatus status = cag_box_tree_new(boxes, n, &out->triangles, err);
  for (size_t i = 0; i < s->concave_count; i++) {
    const SolidEdge *e = &s->edges[s->concave[i]];
    boxes[i] = CAG_BOUNDS_EMPTY;
    cag_bounds_add(&boxes[i], at[e->from]);
    cag_bounds_add(&boxes[i], at[e->to]);
  }
  if (!status) status = cag_box_tree_new(boxes, s->concave_count, &out->edges, err);
  cag_free(boxes);
  if (status) search_free(out);
  return status;
}

// A point, and what is searched around it.
typedef struct Near {
  const Search *w;
  CagVec3 x;
  bool exact;
  const bool *marked; // concave edges whose sums have been added
  double least;       // the distance of the nearest concave edge
  uint32_t edge;
} Near;

static CagBounds reach_of(const Body *b, CagVec3 x) {
  const CagVec3 c = cag_sub(x, b->center), r = {b->outer, b->outer, b->outer};
  return (CagBounds){cag_sub(c, r), cag_add(c, r)};
}

static bool triangle_is_far(void *context, uint32_t triangle) {
  const Near *n = context;
  const Solid *s = n->w->s;
  CagVec3 p[3];
  for (int k = 0; k < 3; k++) p[k] = s->mesh->positions[s->corners[3 * triangle + (uint32_t)k]];
  return !is_within(n->w->b, n->exact, n->x, p, 3);
}

// Whether the solid's surface is nearer to x than the body reaches.
static bool is_inside_sum(const Search *w, bool exact, CagVec3 x) {
  const CagBounds box = reach_of(w->b, x);
  Near n = {.w = w, .x = x, .exact = exact};
  return !cag_box_tree_meeting(&w->triangles, &box, triangle_is_far, &n);
}

static bool compare_edge(void *context, uint32_t i) {
  Near *n = context;
  const Search *w = n->w;
  const SolidEdge *e = &w->s->edges[w->s->concave[i]];
  const CagVec3 p[2] = {w->s->mesh->positions[e->from], w->s->mesh->positions[e->to]};
  if (!is_within(w->b, false, n->x, p, 2)) return true;
  const double d = cag_distance_to_segment(cag_sub(n->x, w->b->center), p[0], p[1]);
  if (n->marked[i]) return false;
  if (d < n->least) {
    n->least = d;
    n->edge = i;
  }
  return true;
}

// The concave edge nearest to x, of those that reach it; NONE if one of these is marked.
static uint32_t unmarked_edge_near(const Search *w, CagVec3 x, const bool *marked) {
  const CagBounds box = reach_of(w->b, x);
  Near n = {.w = w, .x = x, .marked = marked, .least = INFINITY, .edge = NONE};
  return cag_box_tree_meeting(&w->edges, &box, compare_edge, &n) ? n.edge : NONE;
}

static CagStatus add_capsule(Pieces *out, const Solid *s, const Body *b, const SolidEdge *e,
                             CagError *err) {
  const size_t n = b->mesh->vertex_count;
  CagVec3 *points = cag_malloc(2 * n * sizeof *points);
  if (!points) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) {
    points[i] = cag_add(s->mesh->positions[e->from], b->mesh->positions[i]);
    points[n + i] = cag_add(s->mesh->positions[e->to], b->mesh->positions[i]);
  }
  CagMesh *hull = NULL;
  CagStatus status = cag_hull_space(points, 2 * n, &hull, err);
  for (size_t f = 0; !status && f < hull->triangle_count; f++) {
    CagVec3 at[3], normals[3];
    for (int k = 0; k < 3; k++) {
      at[k] = hull->positions[hull->triangles[3 * f + (size_t)k]];
      const CagVec3 foot =
          cag_nearest_of_segment(at[k], s->mesh->positions[e->from], s->mesh->positions[e->to]);
      normals[k] = cag_unit(cag_sub(at[k], foot));
    }
    status = put_triangle(out, at, normals, err);
  }
  cag_mesh_release(hull);
  cag_free(points);
  return status;
}

// The union of the pieces and of a mesh, which may be NULL.
static CagStatus resolve(const CagMesh *m, const Pieces *p, const volatile int *interrupt,
                         CagMesh **out, CagError *err) {
  CagMesh *soup;
  CagStatus status = pieces_mesh(p, &soup, err);
  if (status) return status;
  const CagMesh *both[2] = {soup, m};
  const CagBooleanHow how = {.interrupt = interrupt};
  status = cag_mesh_boolean_many(CAG_UNION, both, m ? 2 : 1, &how, out, err);
  cag_mesh_release(soup);
  return status;
}

// The sums of concave edges near points of the result that lie inside of the whole sum.
static CagStatus find_holes(const Search *w, const CagMesh *result, bool *marked, Pieces *out,
                            CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < result->vertex_count; i++) {
    const CagVec3 x = result->positions[i];
    const uint32_t near = is_inside_sum(w, false, x) ? unmarked_edge_near(w, x, marked) : NONE;
    if (near != NONE) {
      marked[near] = true;
      status = add_capsule(out, w->s, w->b, &w->s->edges[w->s->concave[near]], err);
    }
    if (!status && i % 64 == 0) status = cag_stop_check(err);
  }
  return status;
}

// Adds them, until there are none. Replaces the result, also if it fails.
static CagStatus close_holes(const Search *w, const volatile int *interrupt, CagMesh **result,
                             CagError *err) {
  bool *marked = cag_calloc(w->s->concave_count + 1, sizeof *marked), more = true;
  CagStatus status = marked ? CAG_OK : cag_fail_memory(err);
  for (int round = 0; !status && more && round < ROUNDS; round++) {
    Pieces sums = {.smooth = w->b->round};
    CagMesh *closed = NULL;
    status = find_holes(w, *result, marked, &sums, err);
    more = sums.n > 0;
    if (!status && more) status = resolve(*result, &sums, interrupt, &closed, err);
    if (closed) {
      cag_mesh_release(*result);
      *result = closed;
    }
    pieces_free(&sums);
  }
  cag_free(marked);
  return status;
}

static uint32_t shell_root(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// Keeps the triangles of the shells that have a vertex that is not inside of the sum. The others
// bound holes within the tolerance.
static CagStatus drop_shells(const Search *w, CagMesh *m, CagError *err) {
  uint32_t *parent = cag_malloc((m->vertex_count + 1) * sizeof *parent);
  bool *outside = cag_calloc(m->vertex_count + 1, sizeof *outside);
  CagStatus status = parent && outside ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < m->vertex_count; i++)
    parent[i] = m->weld ? m->weld[i] : (uint32_t)i;
  for (size_t i = 0; !status && i < 3 * m->triangle_count; i++) {
    const uint32_t a = shell_root(parent, m->triangles[i - i % 3]),
                   b = shell_root(parent, m->triangles[i]);
    parent[a > b ? a : b] = a > b ? b : a;
  }
  for (size_t i = 0; !status && i < m->vertex_count; i++) {
    const uint32_t shell = shell_root(parent, (uint32_t)i);
    if (!outside[shell]) outside[shell] = !is_inside_sum(w, true, m->positions[i]);
    if (i % 64 == 0) status = cag_stop_check(err);
  }
  size_t kept = 0;
  for (size_t f = 0; !status && f < m->triangle_count; f++) {
    if (!outside[shell_root(parent, m->triangles[3 * f])]) continue;
    memmove(m->triangles + 3 * kept, m->triangles + 3 * f, 3 * sizeof *m->triangles);
    if (m->labels) m->labels[kept] = m->labels[f];
    kept++;
  }
  if (!status) m->triangle_count = kept;
  cag_free(parent);
  cag_free(outside);
  return status;
}

static CagStatus resolve_all(const Pieces *pieces, const Solid *s, const Body *b,
                             const volatile int *interrupt, CagMesh **out, CagError *err) {
  CagMesh *result = NULL;
  Search w = {0};
  CagStatus status = resolve(NULL, pieces, interrupt, &result, err);
  if (!status && s->concave_count > 0) {
    status = search_new(s, b, &w, err);
    if (!status) status = close_holes(&w, interrupt, &result, err);
    if (!status) status = drop_shells(&w, result, err);
    search_free(&w);
  }
  if (status) cag_mesh_release(result);
  else *out = result;
  return status;
}

// --- Sums ---

// The sum of the solid, whose mesh has two triangles at each edge, and the body.
static CagStatus convolve(const CagMesh *m, const CagMesh *hull, bool round,
                          const volatile int *interrupt, CagMesh **out, CagError *err) {
  Body b;
  Solid s;
  Pieces pieces = {.smooth = round};
  CagStatus status = body_new(hull, round, &b, err);
  if (status) return status;
  status = solid_new(m, &s, err);
  if (status) {
    body_free(&b);
    return status;
  }
  status = add_faces(&pieces, &s, &b, err);
  if (!status) status = add_edges(&pieces, &s, &b, err);
  if (!status) status = add_vertices(&pieces, &s, &b, err);
  if (!status) status = resolve_all(&pieces, &s, &b, interrupt, out, err);
  pieces_free(&pieces);
  solid_free(&s);
  body_free(&b);
  return status;
}

// The solid of a mesh with two triangles at each edge.
static CagStatus cleaned(const CagMesh *m, const volatile int *interrupt, CagMesh **out,
                         CagError *err) {
  const CagBooleanHow how = {.interrupt = interrupt};
  return cag_mesh_boolean_many(CAG_UNION, &m, 1, &how, out, err);
}

CagStatus cag_mesh_minkowski(const CagMesh *m, const CagMesh *body, const volatile int *interrupt,
                             CagMesh **out, CagError *err) {
  CagMesh *hull = NULL, *clean = NULL;
  CagStatus status = cleaned(m, interrupt, &clean, err);
  if (!status && clean->triangle_count == 0) {
    *out = clean;
    return CAG_OK;
  }
  if (!status) status = cag_hull_space(body->positions, body->vertex_count, &hull, err);
  if (!status) status = convolve(clean, hull, false, interrupt, out, err);
  cag_mesh_release(hull);
  cag_mesh_release(clean);
  return status;
}

CagStatus cag_mesh_is_convex(const CagMesh *m, bool *out, CagError *err) {
  CagMesh *hull = NULL, *clean = NULL;
  CagStatus status = cleaned(m, NULL, &clean, err);
  if (!status && clean->triangle_count > 0)
    status = cag_hull_space(clean->positions, clean->vertex_count, &hull, err);
  double own[10] = {0}, whole[10] = {0};
  if (!status && hull) {
    cag_mesh_volume_terms(clean, own);
    cag_mesh_volume_terms(hull, whole);
  }
  if (!status) *out = fabs(own[0] - whole[0]) <= CAG_COINCIDENT * fabs(whole[0]);
  cag_mesh_release(hull);
  cag_mesh_release(clean);
  return status;
}

static CagBounds wider(CagBounds box, double by) {
  const CagVec3 step = cag_vec3(by, by, by);
  return (CagBounds){cag_sub(box.min, step), cag_add(box.max, step)};
}

// The complement of the solid grown by d, within a box.
static CagStatus shrink(const CagMesh *m, double d, double tolerance, const volatile int *interrupt,
                        CagMesh **out, CagError *err) {
  CagMesh *box = NULL, *outside = NULL, *ball = NULL, *grown = NULL, *within = NULL;
  const CagBounds bounds = cag_mesh_bounds(m), room = wider(bounds, 3 * d);
  CagStatus status = cag_box_mesh(&room, &box, err);
  if (!status) status = cag_mesh_boolean(CAG_DIFFERENCE, box, m, interrupt, &outside, err);
  if (!status) status = cag_ball_for(outside, d, tolerance, &ball, err);
  if (!status) status = convolve(outside, ball, true, interrupt, &grown, err);
  if (!status) status = cag_box_mesh(&bounds, &within, err);
  if (!status) status = cag_mesh_boolean(CAG_DIFFERENCE, within, grown, interrupt, out, err);
  cag_mesh_release(box);
  cag_mesh_release(outside);
  cag_mesh_release(ball);
  cag_mesh_release(grown);
  cag_mesh_release(within);
  return status;
}

CagStatus cag_mesh_offset(const CagMesh *m, double d, double tolerance,
                          const volatile int *interrupt, CagMesh **out, CagError *err) {
  CagMesh *clean = NULL, *ball = NULL;
  CagStatus status = cleaned(m, interrupt, &clean, err);
  if (status || d == 0 || clean->triangle_count == 0) {
    if (!status) *out = clean;
    return status;
  }
  if (d < 0) status = shrink(clean, -d, tolerance, interrupt, out, err);
  else {
    status = cag_ball_for(clean, d, tolerance, &ball, err);
    if (!status) status = convolve(clean, ball, true, interrupt, out, err);
  }
  cag_mesh_release(ball);
  cag_mesh_release(clean);
  return status;
}
