// The mesh of a set operation: pieces that bound the solid, rounded to doubles and closed.
//
// Points that round to the same location are merged. Triangles that collapse to an edge or a point
// are dropped, and so are pairs of coincident triangles with opposite orientation. This keeps as
// many triangles on one side of each edge as on the other. If an edge is left with more than two
// triangles, they are joined in pairs around the solid between them; corners that are joined become
// one vertex.

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geom/boolean/work.h"
#include "geom/mesh/edges.h"

// A vertex of the result, linked to the other vertices of the same corners.
typedef struct Vertex {
  CagVec3 normal;
  uint32_t point, next, first;
} Vertex;

// Two triangles joined at an edge that has more of them.
typedef struct Pair {
  uint32_t low, high;
  uint32_t triangle[2];
  uint32_t corner[2]; // of the first triangle at the ends, as in `corner` below
} Pair;

// A triangle whose edge from low to high gets a midpoint.
typedef struct Pinch {
  uint32_t low, high, triangle, middle;
} Pinch;

typedef struct Builder {
  BoolWork *w;
  bool normals;
  BoolPart *parts;
  size_t n;
  BoolSource *sources; // of the parts before flat faces were merged
  uint32_t *triangles;
  uint32_t *corner; // forest of the corners 3 t + k
  uint32_t *head;   // of a corner's root: its vertices
  Vertex *vertices;
  size_t vertex_count;
  BoolList pairs, pinched; // of Pair, of Pinch
} Builder;

static bool is_inside(CagSetOperation op, bool a, bool b) {
  return op == CAG_UNION ? a || b : op == CAG_DIFFERENCE ? a && !b : a && b;
}

// --- Triangles ---

static void take_piece(Builder *b, CagSetOperation op, uint32_t i) {
  BoolWork *w = b->w;
  const BoolPiece *p = &bool_pieces(w)[i];
  const int32_t *front = w->winding[i];
  const bool outer = is_inside(op, front[0] > 0, front[1] > 0);
  const bool inner = is_inside(op, front[0] + p->times[0] > 0, front[1] + p->times[1] > 0);
  if (inner == outer) return;
  const uint32_t source = (uint32_t)b->n;
  BoolPart part = {.source = {source, source, source}};
  b->sources[source] = (BoolSource){p->face, (p->facing > 0) == outer};
  for (int k = 0; k < 3; k++)
    part.v[k] = cag_bool_points_first(&w->points, p->v[outer && k ? 3 - k : k]);
  if (part.v[0] == part.v[1] || part.v[1] == part.v[2] || part.v[2] == part.v[0]) return;
  b->parts[b->n++] = part;
}

// Rotates the corners so that the smallest comes first; returns whether the next is the larger of
// the other two.
static bool sorted_corners(const BoolPart *p, uint32_t v[3]) {
  int least = 0;
  for (int k = 1; k < 3; k++)
    if (p->v[k] < p->v[least]) least = k;
  v[0] = p->v[least];
  v[1] = p->v[(least + 1) % 3];
  v[2] = p->v[(least + 2) % 3];
  if (v[1] < v[2]) return false;
  const uint32_t middle = v[2];
  v[2] = v[1];
  v[1] = middle;
  return true;
}

static int by_corners(const void *a, const void *b) {
  uint32_t v[3], u[3];
  const BoolPart *p = a, *q = b;
  const bool back = sorted_corners(p, v), other = sorted_corners(q, u);
  for (int k = 0; k < 3; k++)
    if (v[k] != u[k]) return v[k] < u[k] ? -1 : 1;
  if (back != other) return back ? 1 : -1;
  return p->source[0] < q->source[0] ? -1 : p->source[0] > q->source[0];
}

// Among triangles with the same corners, keeps those of one orientation first, then those of the
// other.
static size_t cancel(BoolPart *p, size_t n) {
  uint32_t v[3];
  size_t ahead = 0;
  while (ahead < n && !sorted_corners(&p[ahead], v)) ahead++;
  const size_t back = n - ahead;
  if (back > ahead) memmove(p, p + ahead + ahead, (back - ahead) * sizeof *p);
  return back > ahead ? back - ahead : ahead - back;
}

static bool same_corners(const BoolPart *p, const BoolPart *q) {
  uint32_t v[3], u[3];
  sorted_corners(p, v);
  sorted_corners(q, u);
  return memcmp(v, u, sizeof v) == 0;
}

static int by_piece(const void *a, const void *b) {
  const BoolPart *p = a, *q = b;
  return p->source[0] < q->source[0] ? -1 : p->source[0] > q->source[0];
}

static void cancel_opposites(Builder *b) {
  size_t kept = 0;
  qsort(b->parts, b->n, sizeof *b->parts, by_corners);
  for (size_t i = 0, same; i < b->n; i += same) {
    for (same = 1; i + same < b->n && same_corners(&b->parts[i], &b->parts[i + same]);) same++;
    const size_t left = cancel(b->parts + i, same);
    memmove(b->parts + kept, b->parts + i, left * sizeof *b->parts);
    kept += left;
  }
  b->n = kept;
  qsort(b->parts, b->n, sizeof *b->parts, by_piece);
}

// --- Corners ---

static void join(uint32_t *parent, uint32_t a, uint32_t b) {
  a = cag_bool_root(parent, a);
  b = cag_bool_root(parent, b);
  if (a < b) parent[b] = a;
  else parent[a] = b;
}

static Pair join_uses(Builder *b, const CagMeshEdge *one, const CagMeshEdge *two) {
  Pair pair = {one->low, one->high, {0, 0}, {0, 0}};
  for (int i = 0; i < 2; i++) {
    const CagMeshEdge *e = i ? two : one;
    pair.triangle[i] = (uint32_t)cag_mesh_edge_triangle(e);
    const uint32_t base = 3 * pair.triangle[i], k = cag_mesh_edge_corner(e);
    const bool forward = cag_mesh_edge_forward(e);
    const uint32_t low = base + (forward ? k : (k + 1) % 3);
    const uint32_t high = base + (forward ? (k + 1) % 3 : k);
    if (i) {
      join(b->corner, pair.corner[0], low);
      join(b->corner, pair.corner[1], high);
    } else {
      pair.corner[0] = low;
      pair.corner[1] = high;
    }
  }
  return pair;
}

typedef struct Spoke {
  double angle;
  const CagMeshEdge *use;
} Spoke;

static int by_angle(const void *a, const void *b) {
  const Spoke *p = a, *q = b;
  if (p->angle != q->angle) return p->angle < q->angle ? -1 : 1;
  return p->use < q->use ? -1 : 1;
}

// Counter-clockwise about the edge from low to high, the space from a triangle that runs it
// backward to one that runs it forward is solid: such neighbors are joined, like brackets.
static bool join_many(Builder *b, const CagMeshEdge *e, size_t n) {
  const CagVec3 *at = b->w->points.at;
  Spoke *spokes = cag_malloc(n * sizeof *spokes);
  const CagMeshEdge **open = cag_malloc(n * sizeof *open);
  const CagVec3 low = at[e->low], d = cag_unit(cag_sub(at[e->high], low));
  const CagVec3 least = fabs(d.x) < fabs(d.y)
                            ? cag_vec3(fabs(d.x) > fabs(d.z), 0, fabs(d.x) <= fabs(d.z))
                            : cag_vec3(0, fabs(d.y) <= fabs(d.z), fabs(d.y) > fabs(d.z));
  const CagVec3 x = cag_unit(cag_cross(d, least)), y = cag_cross(d, x);
  for (size_t i = 0; spokes && i < n; i++) {
    const BoolPart *p = &b->parts[cag_mesh_edge_triangle(&e[i])];
    const CagVec3 apex = cag_sub(at[p->v[(cag_mesh_edge_corner(&e[i]) + 2) % 3]], low);
    spokes[i] = (Spoke){atan2(cag_dot(apex, y), cag_dot(apex, x)), &e[i]};
  }
  const bool done =
      spokes && open && cag_bool_list_reserve(&b->pairs, b->pairs.n + n / 2, sizeof(Pair));
  if (done) qsort(spokes, n, sizeof *spokes, by_angle);
  // Two turns, for brackets that open before the start and close after it.
  size_t depth = 0;
  for (size_t i = 0; done && i < 2 * n; i++) {
    const CagMeshEdge **use = &spokes[i % n].use;
    if (!*use) continue;
    if (!cag_mesh_edge_forward(*use)) {
      if (i < n) open[depth++] = *use;
    } else if (depth > 0) {
      ((Pair *)b->pairs.items)[b->pairs.n++] = join_uses(b, open[--depth], *use);
      *use = NULL;
    }
  }
  cag_free(spokes);
  cag_free(open);
  return done;
}

static size_t uses_of(const CagMeshEdge *e, size_t left) {
  size_t n = 1;
  while (n < left && e[n].low == e[0].low && e[n].high == e[0].high) n++;
  return n;
}

// Whether two of the pairs at an edge have the same vertices at both ends. This happens if a solid
// touches itself along an edge and is connected around each end.
static bool is_pinched(Builder *b, const Pair *p, size_t n) {
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < i; k++) {
      bool same = true;
      for (int end = 0; end < 2 && same; end++)
        same = cag_bool_root(b->corner, p[i].corner[end]) ==
               cag_bool_root(b->corner, p[k].corner[end]);
      if (same) return true;
    }
  return false;
}

// Gives each pair at such an edge its own midpoint.
static bool part_pairs(Builder *b, const Pair *p, size_t n) {
  if (!cag_bool_list_reserve(&b->pinched, b->pinched.n + 2 * n, sizeof(Pinch))) return false;
  for (size_t i = 0; i < n; i++) {
    const CagVec3 *at = b->w->points.at;
    const CagVec3 half = cag_lerp(at[p[i].low], at[p[i].high], 0.5);
    const uint32_t middle = cag_bool_points_add_far(&b->w->points, half);
    if (middle == BOOL_NONE) return false;
    for (int k = 0; k < 2; k++)
      ((Pinch *)b->pinched.items)[b->pinched.n++] =
          (Pinch){p[i].low, p[i].high, p[i].triangle[k], middle};
  }
  return true;
}

static int by_edge(const void *a, const void *b) {
  const Pinch *p = a, *q = b;
  if (p->low != q->low) return p->low < q->low ? -1 : 1;
  if (p->high != q->high) return p->high < q->high ? -1 : 1;
  return p->triangle < q->triangle ? -1 : p->triangle > q->triangle;
}

static bool find_pinched(Builder *b) {
  const Pair *p = b->pairs.items;
  b->pinched.n = 0;
  for (size_t i = 0, same; i < b->pairs.n; i += same) {
    for (same = 1;
         i + same < b->pairs.n && p[i + same].low == p[i].low && p[i + same].high == p[i].high;)
      same++;
    if (is_pinched(b, p + i, same) && !part_pairs(b, p + i, same)) return false;
  }
  if (b->pinched.n) qsort(b->pinched.items, b->pinched.n, sizeof(Pinch), by_edge);
  return true;
}

static bool join_corners(Builder *b) {
  size_t n = 0;
  cag_free(b->corner);
  cag_free(b->triangles);
  b->corner = cag_malloc((3 * b->n + 1) * sizeof *b->corner);
  b->triangles = cag_malloc((3 * b->n + 1) * sizeof *b->triangles);
  if (!b->corner || !b->triangles) return false;
  for (uint32_t i = 0; i < 3 * b->n; i++) {
    b->corner[i] = i;
    b->triangles[i] = b->parts[i / 3].v[i % 3];
  }
  CagMeshEdge *edges = cag_mesh_edges(b->triangles, b->n, NULL, b->w->points.n, &n);
  bool done = edges != NULL;
  b->pairs.n = 0;
  for (size_t i = 0, uses; done && i < n; i += uses) {
    uses = uses_of(edges + i, n - i);
    if (uses == 2) (void)join_uses(b, &edges[i], &edges[i + 1]);
    else done = join_many(b, edges + i, uses);
  }
  cag_free(edges);
  return done;
}

// Splits triangles, including those that result from splitting, until no edge is pinched.
static bool split_pinched(Builder *b) {
  BoolList parts = {b->parts, b->n, b->n};
  for (uint32_t i = 0; i < b->n; i++) b->parts[i].origin = i;
  for (size_t i = 0; i < parts.n; i++)
    for (int k = 0; k < 3; k++) {
      const BoolPart part = ((BoolPart *)parts.items)[i];
      const uint32_t p = part.v[k], q = part.v[(k + 1) % 3];
      const Pinch key = {p < q ? p : q, p < q ? q : p, part.origin, 0};
      const Pinch *pinch = bsearch(&key, b->pinched.items, b->pinched.n, sizeof key, by_edge);
      if (!pinch) continue;
      if (!cag_bool_list_reserve(&parts, parts.n + 1, sizeof part)) return false;
      b->parts = parts.items;
      BoolPart half = part;
      half.v[k] = pinch->middle;
      b->parts[parts.n++] = half;
      b->parts[i].v[(k + 1) % 3] = pinch->middle;
      k = -1; // restart with the rest of the triangle
    }
  b->n = parts.n;
  return true;
}

// Terminates: each round leaves fewer edges with more than two triangles.
static bool join_all(Builder *b) {
  for (;;) {
    if (!join_corners(b) || !find_pinched(b)) return false;
    if (b->pinched.n == 0) return true;
    if (!split_pinched(b)) return false;
  }
}

// --- Normals ---

// The barycentric weights of p.
static void weights_at(const CagVec3 v[3], CagVec3 p, double weight[3]) {
  const CagVec3 n = cag_cross(cag_sub(v[1], v[0]), cag_sub(v[2], v[0]));
  double sum = 0;
  for (int k = 0; k < 3; k++) {
    const CagVec3 a = cag_sub(v[(k + 1) % 3], p), b = cag_sub(v[(k + 2) % 3], p);
    weight[k] = fmax(0, cag_dot(n, cag_cross(a, b)));
    sum += weight[k];
  }
  for (int k = 0; k < 3; k++) weight[k] = sum > 0 ? weight[k] / sum : 1 / 3.0;
}

static CagVec3 normal_at(const Builder *b, const BoolSource *source, CagVec3 p) {
  const BoolFace *face = &b->w->faces[source->face];
  const CagMesh *m = b->w->meshes[face->owner];
  const uint32_t *corner = m->triangles + 3 * (size_t)face->triangle;
  const double sense = source->back ? -1 : 1;
  CagVec3 v[3], normal = {0, 0, 0};
  double weight[3];
  for (int k = 0; k < 3; k++) v[k] = m->positions[corner[k]];
  if (m->normals) {
    weights_at(v, p, weight);
    for (int k = 0; k < 3; k++) {
      if (v[k].x == p.x && v[k].y == p.y && v[k].z == p.z)
        return cag_scaled(m->normals[corner[k]], sense);
      normal = cag_madd(normal, weight[k], m->normals[corner[k]]);
    }
  }
  if (!(cag_norm(normal) > 0)) normal = cag_cross(cag_sub(v[1], v[0]), cag_sub(v[2], v[0]));
  return cag_scaled(cag_unit(normal), sense);
}

// --- Vertices ---

static uint32_t vertex_of(Builder *b, uint32_t corner) {
  const double same_direction = 1 - 1e-6; // cosine of 0.08 degrees, as in cag_mesh_weld
  const BoolPart *part = &b->parts[corner / 3];
  const uint32_t root = cag_bool_root(b->corner, corner), point = part->v[corner % 3];
  const CagVec3 none = {0, 0, 0};
  const BoolSource *source = &b->sources[part->source[corner % 3]];
  const CagVec3 normal = b->normals ? normal_at(b, source, b->w->points.at[point]) : none;
  for (uint32_t i = b->head[root]; i != BOOL_NONE; i = b->vertices[i].next)
    if (!b->normals || cag_dot(b->vertices[i].normal, normal) >= same_direction) return i;
  const uint32_t head = b->head[root], i = (uint32_t)b->vertex_count++;
  b->vertices[i] = (Vertex){normal, point, head, head == BOOL_NONE ? i : b->vertices[head].first};
  b->head[root] = i;
  return i;
}

static uint32_t label_of(const Builder *b, size_t part) {
  const BoolFace *face = &b->w->faces[b->sources[b->parts[part].source[0]].face];
  const CagMesh *m = b->w->meshes[face->owner];
  return m->labels ? m->labels[face->triangle] : 0;
}

static CagStatus write_mesh(Builder *b, CagMesh **out) {
  CagMesh *m = NULL;
  const CagStatus status =
      cag_mesh_new(b->vertex_count, b->n, b->normals, false, b->normals, &m, b->w->err);
  if (status) return status;
  for (size_t i = 0; i < b->vertex_count; i++) {
    m->positions[i] = b->w->points.at[b->vertices[i].point];
    if (!b->normals) continue;
    m->normals[i] = b->vertices[i].normal;
    m->weld[i] = b->vertices[i].first;
  }
  memcpy(m->triangles, b->triangles, 3 * b->n * sizeof *m->triangles);
  if (b->w->meshes[0]->labels || b->w->meshes[1]->labels) {
    m->labels = cag_malloc((b->n + 1) * sizeof *m->labels);
    for (size_t t = 0; m->labels && t < b->n; t++) m->labels[t] = label_of(b, t);
    if (!m->labels) {
      cag_mesh_release(m);
      return cag_fail_memory(b->w->err);
    }
  }
  *out = m;
  return CAG_OK;
}

static bool make_vertices(Builder *b) {
  b->head = cag_malloc((3 * b->n + 1) * sizeof *b->head);
  b->vertices = cag_malloc((3 * b->n + 1) * sizeof *b->vertices);
  if (!b->head || !b->vertices) return false;
  for (size_t i = 0; i < 3 * b->n; i++) b->head[i] = BOOL_NONE;
  for (uint32_t i = 0; i < 3 * b->n; i++) b->triangles[i] = vertex_of(b, i);
  return true;
}

CagStatus cag_bool_build(BoolWork *w, CagSetOperation op, CagMesh **out) {
  Builder b = {.w = w};
  b.normals = w->meshes[0]->normals || w->meshes[1]->normals;
  b.parts = cag_malloc((w->pieces.n + 1) * sizeof *b.parts);
  b.sources = cag_malloc((w->pieces.n + 1) * sizeof *b.sources);
  CagStatus status = b.parts && b.sources ? CAG_OK : cag_fail_memory(w->err);
  if (!status) {
    for (uint32_t i = 0; i < w->pieces.n; i++) take_piece(&b, op, i);
    cancel_opposites(&b);
    const bool done = (w->whole || cag_bool_flatten(w, b.sources, false, &b.parts, &b.n)) &&
                      join_all(&b) && make_vertices(&b);
    if (!done) status = cag_bool_stopped(w);
    if (!done && !status) status = cag_fail_memory(w->err);
  }
  if (!status) status = write_mesh(&b, out);
  cag_free(b.parts);
  cag_free(b.sources);
  cag_free(b.triangles);
  cag_free(b.corner);
  cag_free(b.head);
  cag_free(b.pairs.items);
  cag_free(b.pinched.items);
  cag_free(b.vertices);
  return status;
}
