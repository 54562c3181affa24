// Flat faces of closed meshes (see facets.h).
//
// The triangles are a half-edge structure: half-edge 3 t + k runs from corner k of triangle t to the
// next one, and its mate is the same edge in the neighboring triangle. A face grows from its largest
// triangle over mates, as long as all corners stay in the plane of that triangle. It is divided into
// its triangles again if its outline meets itself at a vertex.

#include "geom/mesh/facets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/sort.h"
#include "base/stop.h"
#include "geom/mesh/edges.h"

// A triangle of at most this many slacks in height has no plane of its own: within the slack, its
// normal could be off by the reciprocal, in radians.
#define THIN 10.0
#define NONE UINT32_MAX

// A triangle as the possible start of a face.
typedef struct Seed {
  uint32_t triangle, shell;
  double area; // twice; 0: it is thin, so that it comes last
} Seed;

typedef struct Plane {
  CagVec3 origin, normal;
} Plane;

// A use of an edge with more than two triangles.
typedef struct Spoke {
  double angle;
  uint32_t half;
  bool forward;
} Spoke;

typedef struct Work {
  const CagMesh *mesh;
  double slack;
  uint32_t *mate;   // of half-edges; NONE: of triangles that collapse to an edge
  uint32_t *shell;  // of triangles; first a union-find forest, then the number of the shell
  uint32_t *face;   // of triangles, or NONE
  uint32_t *order;  // triangles by faces
  uint32_t *first;  // of each face, in `order`; one more than there are faces
  uint32_t *stack;  // triangles whose neighbors are not examined yet
  uint32_t *edge;   // of half-edges, or NONE
  uint32_t *number; // of vertices, or NONE
  uint32_t *seen;   // of vertices: the face, plus 1, whose outline was last found there
  bool *walked;     // half-edges of outlines
  Plane *planes;    // of faces
  Spoke *spokes;
  size_t spoke_room, face_count, shell_count;
  CagFacets *out;
} Work;

static uint32_t next_half(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }

// The welded vertex at which a half-edge starts.
static uint32_t start_of(const Work *w, uint32_t h) {
  const uint32_t v = w->mesh->triangles[h];
  return w->mesh->weld ? w->mesh->weld[v] : v;
}
static CagVec3 point_of(const Work *w, uint32_t h) { return w->mesh->positions[start_of(w, h)]; }

static bool has_area(const Work *w, uint32_t t) {
  const uint32_t a = start_of(w, 3 * t), b = start_of(w, 3 * t + 1), c = start_of(w, 3 * t + 2);
  return a != b && b != c && c != a;
}

static CagVec3 triangle_cross(const Work *w, uint32_t t) {
  const CagVec3 a = point_of(w, 3 * t);
  return cag_cross(cag_sub(point_of(w, 3 * t + 1), a), cag_sub(point_of(w, 3 * t + 2), a));
}

static double longest_side(const Work *w, uint32_t t) {
  double most = 0;
  for (uint32_t k = 0; k < 3; k++)
    most = fmax(most, cag_norm(cag_sub(point_of(w, next_half(3 * t + k)), point_of(w, 3 * t + k))));
  return most;
}

// area: twice that of the triangle
static bool is_thin(const Work *w, uint32_t t, double area) {
  return area <= THIN * w->slack * longest_side(w, t);
}

// --- Mates ---

static CagStatus fail_open(const Work *w, const CagMeshEdge *e, CagError *err) {
  const CagVec3 a = w->mesh->positions[e->low], b = w->mesh->positions[e->high];
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_mesh_open, "", -1,
      "the mesh must be closed: its edge from [%.9g, %.9g, %.9g] to [%.9g, %.9g, %.9g] does not belong to two faces with opposite directions; `weld` merges vertices that nearly coincide",
      a.x, a.y, a.z, b.x, b.y, b.z);
}

static uint32_t half_of(const CagMeshEdge *e) {
  return (uint32_t)(3 * cag_mesh_edge_triangle(e) + cag_mesh_edge_corner(e));
}

static void join(Work *w, uint32_t a, uint32_t b) {
  w->mate[a] = b;
  w->mate[b] = a;
}

static int by_angle(const void *a, const void *b) {
  const Spoke *s = a, *t = b;
  if (s->angle != t->angle) return s->angle < t->angle ? -1 : 1;
  return s->half < t->half ? -1 : s->half > t->half;
}

// Finds the angles of the triangles about their edge, from the first one.
static void find_angles(const Work *w, const CagMeshEdge *e, size_t n) {
  const CagVec3 from = w->mesh->positions[e->low];
  const CagVec3 axis = cag_unit(cag_sub(w->mesh->positions[e->high], from));
  CagVec3 x = {0, 0, 0}, y = {0, 0, 0};
  for (size_t i = 0; i < n; i++) {
    const uint32_t half = half_of(&e[i]);
    const CagVec3 apex = cag_sub(point_of(w, next_half(next_half(half))), from);
    const CagVec3 off = cag_madd(apex, -cag_dot(apex, axis), axis);
    if (i == 0) {
      x = cag_unit(off);
      y = cag_cross(axis, x);
    }
    w->spokes[i] =
        (Spoke){atan2(cag_dot(off, y), cag_dot(off, x)), half, cag_mesh_edge_forward(&e[i])};
  }
}

// The inside lies on the side of growing angles of a triangle that uses the edge backward, and ends
// at the next one that uses it forward. Two turns find those of wedges across the first angle.
static CagStatus join_wedges(Work *w, const CagMeshEdge *e, size_t n, CagError *err) {
  size_t forward = 0, open = 0;
  for (size_t i = 0; i < n; i++) forward += cag_mesh_edge_forward(&e[i]);
  if (2 * forward != n) return fail_open(w, e, err);
  uint32_t *wedges = cag_malloc((n + 1) * sizeof *wedges);
  if (!wedges || !CAG_RESERVE(w->spokes, w->spoke_room, n)) {
    cag_free(wedges);
    return cag_fail_memory(err);
  }
  find_angles(w, e, n);
  qsort(w->spokes, n, sizeof *w->spokes, by_angle);
  for (size_t i = 0; i < 2 * n; i++) {
    const Spoke *s = &w->spokes[i % n];
    if (w->mate[s->half] != NONE) continue;
    if (!s->forward && i < n) wedges[open++] = s->half;
    else if (s->forward && open > 0) join(w, wedges[--open], s->half);
  }
  cag_free(wedges);
  return CAG_OK;
}

static CagStatus find_mates(Work *w, CagError *err) {
  const CagMesh *m = w->mesh;
  size_t n, kept = 0, run;
  CagMeshEdge *e = cag_mesh_edges(m->triangles, m->triangle_count, m->weld, m->vertex_count, &n);
  if (!e) return cag_stopped() ? cag_stop_fail(err) : cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) // the neighbors of a triangle without area share an edge
    if (has_area(w, (uint32_t)cag_mesh_edge_triangle(&e[i]))) e[kept++] = e[i];
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < kept; i += run) {
    for (run = 1; i + run < kept && e[i + run].low == e[i].low && e[i + run].high == e[i].high;)
      run++;
    if (run > 2) status = join_wedges(w, &e[i], run, err);
    else if (run < 2 || cag_mesh_edge_forward(&e[i]) == cag_mesh_edge_forward(&e[i + 1]))
      status = fail_open(w, &e[i], err);
    else join(w, half_of(&e[i]), half_of(&e[i + 1]));
    if (!status) status = cag_stop_check(err);
  }
  cag_free(e);
  return status;
}

// --- Shells ---

static uint32_t root_of(uint32_t *parent, uint32_t t) {
  while (parent[t] != t) t = parent[t] = parent[parent[t]];
  return t;
}

// Numbers the shells by their first triangles.
static void find_shells(Work *w) {
  const uint32_t n = (uint32_t)w->mesh->triangle_count;
  for (uint32_t t = 0; t < n; t++) w->shell[t] = t;
  for (uint32_t h = 0; h < 3 * n; h++) {
    if (w->mate[h] == NONE) continue;
    const uint32_t a = root_of(w->shell, h / 3), b = root_of(w->shell, w->mate[h] / 3);
    if (a < b) w->shell[b] = a;
    else w->shell[a] = b;
  }
  // A root is the first triangle of its shell, so that its number is known before it is needed.
  for (uint32_t t = 0; t < n; t++)
    w->shell[t] = !has_area(w, t)    ? NONE
                  : w->shell[t] == t ? (uint32_t)w->shell_count++
                                     : w->shell[w->shell[t]];
}

// --- Faces ---

static int by_shell_and_area(const void *a, const void *b) {
  const Seed *s = a, *t = b;
  if (s->shell != t->shell) return s->shell < t->shell ? -1 : 1;
  if (s->area != t->area) return s->area > t->area ? -1 : 1;
  return s->triangle < t->triangle ? -1 : s->triangle > t->triangle;
}

// Whether a triangle lies in the plane. Thin ones may have any normal.
static bool lies_in(Work *w, uint32_t t, const Plane *p) {
  double most = 0;
  for (uint32_t k = 0; k < 3; k++)
    most = fmax(most, fabs(cag_dot(cag_sub(point_of(w, 3 * t + k), p->origin), p->normal)));
  if (!(most <= w->slack)) return false;
  const CagVec3 cross = triangle_cross(w, t);
  if (!is_thin(w, t, cag_norm(cross)) && !(cag_dot(cross, p->normal) > 0)) return false;
  w->out->flatness = fmax(w->out->flatness, most);
  return true;
}

// The normal of a triangle, or a direction across its longest side if it is a line.
static CagVec3 normal_of(const Work *w, uint32_t t) {
  const CagVec3 cross = triangle_cross(w, t);
  if (cag_norm(cross) > 0) return cag_unit(cross);
  const double length = longest_side(w, t);
  CagVec3 side = {0, 0, 0};
  for (uint32_t k = 0; k < 3; k++) {
    const CagVec3 own = cag_sub(point_of(w, next_half(3 * t + k)), point_of(w, 3 * t + k));
    if (cag_norm(own) >= length) side = own;
  }
  const bool steep = fabs(side.x) > fabs(side.y);
  return cag_unit(cag_cross(side, steep ? cag_vec3(0, 1, 0) : cag_vec3(1, 0, 0)));
}

static CagStatus grow_face(Work *w, uint32_t seed, CagError *err) {
  const Plane p = {point_of(w, 3 * seed), normal_of(w, seed)};
  const uint32_t face = (uint32_t)w->face_count++;
  size_t open = 0;
  w->planes[face] = p;
  w->face[seed] = face;
  w->stack[open++] = seed;
  while (open > 0) {
    const uint32_t t = w->stack[--open];
    for (uint32_t k = 0; k < 3; k++) {
      const uint32_t other = w->mate[3 * t + k] / 3;
      if (w->face[other] != NONE || !lies_in(w, other, &p)) continue;
      w->face[other] = face;
      w->stack[open++] = other;
    }
  }
  return cag_stop_check(err);
}

static CagStatus grow_faces(Work *w, CagError *err) {
  const uint32_t n = (uint32_t)w->mesh->triangle_count;
  size_t count = 0;
  Seed *seeds = cag_malloc((n + 1) * sizeof *seeds);
  if (!seeds) return cag_fail_memory(err);
  for (uint32_t t = 0; t < n; t++) {
    if (!has_area(w, t)) continue;
    const double area = cag_norm(triangle_cross(w, t));
    seeds[count++] = (Seed){t, w->shell[t], is_thin(w, t, area) ? 0 : area};
  }
  CagStatus status = cag_sort(seeds, count, sizeof *seeds, by_shell_and_area, err);
  for (size_t i = 0; !status && i < count; i++)
    if (w->face[seeds[i].triangle] == NONE) status = grow_face(w, seeds[i].triangle, err);
  cag_free(seeds);
  return status;
}

// Sorts the triangles by faces.
static void sort_triangles(Work *w) {
  const uint32_t n = (uint32_t)w->mesh->triangle_count;
  memset(w->first, 0, (w->face_count + 2) * sizeof *w->first);
  for (uint32_t t = 0; t < n; t++)
    if (w->face[t] != NONE) w->first[w->face[t] + 2]++;
  for (size_t f = 2; f < w->face_count + 2; f++) w->first[f] += w->first[f - 1];
  for (uint32_t t = 0; t < n; t++)
    if (w->face[t] != NONE) w->order[w->first[w->face[t] + 1]++] = t;
}

// --- Outlines ---

static bool is_outline(const Work *w, uint32_t h) {
  return w->face[w->mate[h] / 3] != w->face[h / 3];
}

// The half-edge of the outline after another one.
static uint32_t following(const Work *w, uint32_t h) {
  uint32_t k = next_half(h);
  while (!is_outline(w, k)) k = next_half(w->mate[k]);
  return k;
}

// Walks around an outline. Returns twice its area, seen against the normal of the face.
static double walk(Work *w, uint32_t from, size_t *count, bool *simple) {
  const uint32_t face = w->face[from / 3];
  const Plane *p = &w->planes[face];
  double area = 0;
  uint32_t h = from;
  *count = 0;
  do {
    const uint32_t next = following(w, h), v = start_of(w, h);
    *simple = *simple && w->seen[v] != face + 1;
    w->seen[v] = face + 1;
    w->walked[h] = true;
    area += cag_dot(p->normal, cag_cross(cag_sub(point_of(w, h), p->origin),
                                         cag_sub(point_of(w, next), p->origin)));
    h = next;
    ++*count;
  } while (h != from);
  return area;
}

// Whether a face has a single outer outline, and no outline meets itself or another one.
static bool is_simple(Work *w, size_t face) {
  size_t outer = 0, count;
  bool simple = true;
  for (uint32_t i = w->first[face]; i < w->first[face + 1]; i++)
    for (uint32_t h = 3 * w->order[i]; h < 3 * w->order[i] + 3; h++) {
      if (!is_outline(w, h) || w->walked[h]) continue;
      outer += walk(w, h, &count, &simple) > 0;
      simple = simple && count >= 3;
    }
  return simple && outer == 1;
}

// Makes a face of each triangle of faces that are not simple, in their planes. Faces stay sorted by
// shells.
static void divide_faces(Work *w, bool *divided) {
  const size_t n = w->face_count;
  size_t count = 0, more = 0;
  for (size_t f = 0; f < n; f++)
    if (w->first[f + 1] - w->first[f] > 1 && !is_simple(w, f)) {
      w->stack[count++] = (uint32_t)f;
      more += w->first[f + 1] - w->first[f] - 1;
    }
  *divided = count > 0;
  w->face_count = n + more;
  for (size_t f = n, to = n + more; f-- > 0;) {
    const bool whole = count == 0 || w->stack[count - 1] != f;
    if (!whole) count--;
    const Plane plane = w->planes[f];
    const uint32_t first = w->first[f], last = w->first[f + 1];
    if (whole) w->planes[--to] = plane;
    for (uint32_t i = last; i-- > first;) {
      if (!whole) w->planes[--to] = plane;
      w->face[w->order[i]] = (uint32_t)to;
    }
  }
}

// --- The result ---

static size_t vertex_number(Work *w, uint32_t v) {
  if (w->number[v] == NONE) {
    w->number[v] = (uint32_t)w->out->vertex_count;
    w->out->vertices[w->out->vertex_count++] = w->mesh->positions[v];
  }
  return w->number[v];
}

static void add_use(Work *w, uint32_t h) {
  CagFacets *out = w->out;
  const uint32_t mate = w->mate[h];
  const bool second = w->edge[mate] != NONE;
  if (!second) {
    w->edge[h] = (uint32_t)out->edge_count;
    out->edges[out->edge_count++] = (CagFacetEdge){vertex_number(w, start_of(w, h)),
                                                   vertex_number(w, start_of(w, next_half(h)))};
  }
  out->uses[out->use_count++] = (CagFacetUse){second ? w->edge[mate] : w->edge[h], second};
}

static void add_loop(Work *w, uint32_t from, CagFacet *f) {
  CagFacets *out = w->out;
  size_t count;
  bool unused = true;
  const bool outer = walk(w, from, &count, &unused) > 0;
  CagFacetLoop *l = &out->loops[out->loop_count++];
  *l = (CagFacetLoop){out->use_count, count};
  uint32_t h = from;
  for (size_t i = 0; i < count; i++, h = following(w, h)) add_use(w, h);
  if (outer && f->count > 0) {
    const CagFacetLoop hole = out->loops[f->first];
    out->loops[f->first] = *l;
    *l = hole;
  }
  f->count++;
}

static CagStatus add_face(Work *w, size_t face, CagError *err) {
  CagFacets *out = w->out;
  const Plane *p = &w->planes[face];
  CagFacet *f = &out->faces[out->face_count++];
  *f = (CagFacet){p->origin, p->normal, out->loop_count, 0};
  for (uint32_t i = w->first[face]; i < w->first[face + 1]; i++)
    for (uint32_t h = 3 * w->order[i]; h < 3 * w->order[i] + 3; h++)
      if (is_outline(w, h) && !w->walked[h]) add_loop(w, h, f);
  out->shells[w->shell[w->order[w->first[face]]]].count++;
  return cag_stop_check(err);
}

static CagStatus add_faces(Work *w, CagError *err) {
  CagFacets *out = w->out;
  const size_t halves = 3 * w->mesh->triangle_count;
  size_t count = 0;
  for (uint32_t h = 0; h < halves; h++) count += w->mate[h] != NONE && is_outline(w, h);
  out->vertices = cag_malloc((w->mesh->vertex_count + 1) * sizeof *out->vertices);
  out->edges = cag_malloc((count / 2 + 1) * sizeof *out->edges);
  out->uses = cag_malloc((count + 1) * sizeof *out->uses);
  out->loops = cag_malloc((count / 3 + w->face_count + 1) * sizeof *out->loops);
  out->faces = cag_malloc((w->face_count + 1) * sizeof *out->faces);
  out->shells = cag_calloc(w->shell_count + 1, sizeof *out->shells);
  if (!out->vertices || !out->edges || !out->uses || !out->loops || !out->faces || !out->shells)
    return cag_fail_memory(err);
  memset(w->walked, 0, halves * sizeof *w->walked);
  CagStatus status = CAG_OK;
  for (size_t f = 0; !status && f < w->face_count; f++) status = add_face(w, f, err);
  out->shell_count = w->shell_count;
  for (size_t i = 1; i < out->shell_count; i++)
    out->shells[i].first = out->shells[i - 1].first + out->shells[i - 1].count;
  return status;
}

// --- Cavities ---

// The fraction of all directions in which a triangle is seen (van Oosterom and Strackee 1983).
static double seen_part(const Work *w, uint32_t t, CagVec3 p) {
  const CagVec3 a = cag_sub(point_of(w, 3 * t), p), b = cag_sub(point_of(w, 3 * t + 1), p);
  const CagVec3 c = cag_sub(point_of(w, 3 * t + 2), p);
  const double la = cag_norm(a), lb = cag_norm(b), lc = cag_norm(c);
  const double over = cag_dot(a, cag_cross(b, c));
  const double under = la * lb * lc + cag_dot(a, b) * lc + cag_dot(b, c) * la + cag_dot(c, a) * lb;
  return over == 0 ? 0 : atan2(over, under) / (2 * M_PI);
}

// The triangles of a shell, in `order`.
static void shell_range(const Work *w, size_t shell, uint32_t *first, uint32_t *last) {
  const CagFacetShell *s = &w->out->shells[shell];
  *first = w->first[s->first];
  *last = w->first[s->first + s->count];
}

static void measure_shell(const Work *w, size_t shell, CagBounds *box) {
  uint32_t first, last;
  double six = 0;
  shell_range(w, shell, &first, &last);
  const CagVec3 tip = point_of(w, 3 * w->order[first]);
  *box = CAG_BOUNDS_EMPTY;
  for (uint32_t i = first; i < last; i++) {
    const uint32_t h = 3 * w->order[i];
    for (uint32_t k = 0; k < 3; k++) cag_bounds_add(box, point_of(w, h + k));
    six += cag_dot(cag_sub(point_of(w, h), tip),
                   cag_cross(cag_sub(point_of(w, h + 1), tip), cag_sub(point_of(w, h + 2), tip)));
  }
  w->out->shells[shell].volume = six / 6;
}

// Whether a shell surrounds most of three points of another one.
static bool surrounds(const Work *w, size_t shell, size_t inner) {
  enum { PROBES = 3 };
  uint32_t first, last, from, to;
  size_t inside = 0;
  shell_range(w, shell, &first, &last);
  shell_range(w, inner, &from, &to);
  for (uint32_t k = 0; k < PROBES; k++) {
    const uint32_t h =
        3 * w->order[from + (uint32_t)((uint64_t)(to - 1 - from) * k / (PROBES - 1))];
    const CagVec3 sum = cag_add(cag_add(point_of(w, h), point_of(w, h + 1)), point_of(w, h + 2));
    double turns = 0;
    for (uint32_t i = first; i < last && !cag_stopped(); i++)
      turns += seen_part(w, w->order[i], cag_scaled(sum, 1.0 / 3));
    inside += fabs(turns) > 0.5;
  }
  return 2 * inside > PROBES;
}

static bool holds(const CagBounds *a, const CagBounds *b) {
  return a->min.x <= b->min.x && a->min.y <= b->min.y && a->min.z <= b->min.z &&
         a->max.x >= b->max.x && a->max.y >= b->max.y && a->max.z >= b->max.z;
}

// A cavity is in the smallest shell around it.
static CagStatus find_cavities(Work *w, CagError *err) {
  CagFacets *out = w->out;
  CagBounds *box = cag_malloc((out->shell_count + 1) * sizeof *box);
  if (!box) return cag_fail_memory(err);
  for (size_t i = 0; i < out->shell_count; i++) {
    out->shells[i].void_of = i;
    measure_shell(w, i, &box[i]);
  }
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < out->shell_count; i++) {
    double best = INFINITY;
    for (size_t k = 0; out->shells[i].volume < 0 && k < out->shell_count; k++) {
      const double volume = out->shells[k].volume;
      if (!(volume > 0) || !(volume < best) || !holds(&box[k], &box[i]) || !surrounds(w, k, i))
        continue;
      best = volume;
      out->shells[i].void_of = k;
    }
    status = cag_stop_check(err);
  }
  cag_free(box);
  return status;
}

// --- The whole ---

static void free_work(Work *w) {
  void *const all[] = {w->mate, w->shell,  w->face, w->order,  w->first,  w->stack,
                       w->edge, w->number, w->seen, w->walked, w->planes, w->spokes};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) cag_free(all[i]);
}

static bool take_work(Work *w) {
  const size_t n = w->mesh->triangle_count, v = w->mesh->vertex_count;
  w->mate = cag_malloc((3 * n + 1) * sizeof *w->mate);
  w->shell = cag_malloc((n + 1) * sizeof *w->shell);
  w->face = cag_malloc((n + 1) * sizeof *w->face);
  w->order = cag_malloc((n + 1) * sizeof *w->order);
  w->first = cag_malloc((n + 3) * sizeof *w->first);
  w->stack = cag_malloc((n + 1) * sizeof *w->stack);
  w->edge = cag_malloc((3 * n + 1) * sizeof *w->edge);
  w->number = cag_malloc((v + 1) * sizeof *w->number);
  w->seen = cag_calloc(v + 1, sizeof *w->seen);
  w->walked = cag_calloc(3 * n + 1, sizeof *w->walked);
  w->planes = cag_malloc((n + 1) * sizeof *w->planes);
  if (!w->mate || !w->shell || !w->face || !w->order || !w->first || !w->stack || !w->edge ||
      !w->number || !w->seen || !w->walked || !w->planes)
    return false;
  memset(w->mate, 0xff, 3 * n * sizeof *w->mate);
  memset(w->face, 0xff, n * sizeof *w->face);
  memset(w->edge, 0xff, 3 * n * sizeof *w->edge);
  memset(w->number, 0xff, v * sizeof *w->number);
  return true;
}

CagStatus cag_mesh_facets(const CagMesh *m, double slack, CagFacets *out, CagError *err) {
  *out = (CagFacets){0};
  if (m->triangle_count >= NONE / 3)
    return cag_fail(err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "", -1,
                    "the mesh has too many triangles");
  Work w = {.mesh = m, .slack = slack, .out = out};
  bool divided = false;
  CagStatus status = take_work(&w) ? find_mates(&w, err) : cag_fail_memory(err);
  if (!status) {
    find_shells(&w);
    status = grow_faces(&w, err);
  }
  if (!status) {
    sort_triangles(&w);
    divide_faces(&w, &divided);
    if (divided) sort_triangles(&w);
    status = add_faces(&w, err);
  }
  if (!status) status = find_cavities(&w, err);
  free_work(&w);
  if (status) cag_facets_free(out);
  return status;
}

void cag_facets_free(CagFacets *f) {
  cag_free(f->vertices);
  cag_free(f->edges);
  cag_free(f->uses);
  cag_free(f->loops);
  cag_free(f->faces);
  cag_free(f->shells);
  *f = (CagFacets){0};
}
