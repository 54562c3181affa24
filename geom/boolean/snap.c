// Identifies corners and planes of the operands that coincide within rounding.
//
// If two solids were transformed separately, their corners were rounded separately. Faces that
// should be coplanar then cross each other at random, and a difference leaves a thin film. Before
// anything is decided, corners that nearly coincide are merged, and planes shared by faces of both
// operands are found; the corners of these faces are moved onto them. A corner of one such plane
// moves along one axis, one of two keeps one coordinate, and one of three becomes their
// intersection. These points are not rounded, so faces of one plane lie in it exactly. Faces that
// share no plane with the other operand, and operands whose faces are exact, are not changed.

#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boolean/work.h"

// Squared sine of the largest angle between coplanar faces.
#define PARALLEL 1e-6
// Faces with a height below this many slacks do not determine a plane.
#define THIN 1e3
// Planes at a corner are independent if the volume spanned by their normals is above this.
#define INDEPENDENT 1e-5
// A plane may be this many slacks away from corners of its faces, and a corner may move as far.
#define REACH 8

// --- Twins ---

typedef struct Twins {
  const BoolPoints *points;
  double cell;
  uint32_t *heads, *next;
  size_t mask;
} Twins;

static size_t slot_of(const Twins *t, const int64_t at[3]) {
  uint64_t h = (uint64_t)at[0] * 0x9e3779b97f4a7c15u;
  h = (h ^ h >> 29 ^ (uint64_t)at[1]) * 0xbf58476d1ce4e5b9u;
  h = (h ^ h >> 32 ^ (uint64_t)at[2]) * 0x94d049bb133111ebu;
  return (size_t)(h ^ h >> 31) & t->mask;
}

static void cell_of(const Twins *t, CagVec3 p, int64_t at[3]) {
  at[0] = (int64_t)floor(p.x / t->cell);
  at[1] = (int64_t)floor(p.y / t->cell);
  at[2] = (int64_t)floor(p.z / t->cell);
}

// A box of one slack around the point overlaps at most eight cells.
static uint32_t find_twin(const Twins *t, CagVec3 p, double slack) {
  int64_t low[3], high[3], at[3];
  cell_of(t, cag_sub(p, cag_vec3(slack, slack, slack)), low);
  cell_of(t, cag_add(p, cag_vec3(slack, slack, slack)), high);
  for (at[0] = low[0]; at[0] <= high[0]; at[0]++)
    for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
      for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
        for (uint32_t i = t->heads[slot_of(t, at)]; i != BOOL_NONE; i = t->next[i])
          if (cag_norm(cag_sub(t->points->at[i], p)) <= slack) return i;
  return BOOL_NONE;
}

CagStatus cag_bool_find_twins(BoolWork *w, uint32_t *number, bool *found) {
  const size_t n = w->points.n;
  Twins t = {.points = &w->points, .cell = 8 * w->slack, .mask = 1023};
  *found = false;
  for (uint32_t i = 0; i < n; i++) number[i] = i;
  if (!(t.cell > 0)) return CAG_OK; // all corners are at the origin
  while (t.mask < 2 * n) t.mask = 2 * t.mask + 1;
  t.heads = cag_malloc((t.mask + 1) * sizeof *t.heads);
  t.next = cag_malloc((n + 1) * sizeof *t.next);
  if (!t.heads || !t.next) {
    cag_free(t.heads);
    cag_free(t.next);
    return cag_fail_memory(w->err);
  }
  memset(t.heads, 0xff, (t.mask + 1) * sizeof *t.heads);
  CagStatus status = CAG_OK;
  for (uint32_t i = 0; !status && i < n; i++) {
    status = cag_stop_check(w->err);
    const uint32_t twin = find_twin(&t, w->points.at[i], w->slack);
    if (twin != BOOL_NONE) {
      number[i] = twin;
      *found = true;
      continue;
    }
    int64_t at[3];
    cell_of(&t, w->points.at[i], at);
    uint32_t *head = &t.heads[slot_of(&t, at)];
    t.next[i] = *head;
    *head = i;
  }
  cag_free(t.heads);
  cag_free(t.next);
  return status;
}

// --- Classes of faces ---

// The plane of a face in doubles; area 0: the face determines none.
typedef struct Plane {
  CagVec3 at, normal; // unit
  double area;
} Plane;

// A plane shared by faces.
typedef struct Class {
  uint32_t face;  // the largest face
  uint8_t owners; // bit k: has faces that belong only to operand k
  uint32_t points[3];
} Class;

typedef struct Snap {
  BoolWork *w;
  Plane *planes;    // of the faces
  uint32_t *parent; // union-find forest of the faces: connected faces of one plane
  Class *classes;   // of roots
  // Corners and the classes of their faces: those of corner i from start[i] to start[i + 1] - 1.
  size_t *start;
  uint32_t *members;
} Snap;

static void snap_free(Snap *s) {
  cag_free(s->planes);
  cag_free(s->parent);
  cag_free(s->classes);
  cag_free(s->start);
  cag_free(s->members);
}

static Plane plane_of(const BoolWork *w, const BoolFace *f) {
  const CagVec3 a = w->points.at[f->v[0]], b = w->points.at[f->v[1]], c = w->points.at[f->v[2]];
  const CagVec3 n = cag_cross(cag_sub(b, a), cag_sub(c, a));
  const double area = cag_norm(n);
  const double longest =
      fmax(cag_norm(cag_sub(b, a)), fmax(cag_norm(cag_sub(c, b)), cag_norm(cag_sub(a, c))));
  if (!(area > THIN * w->slack * longest)) return (Plane){a, {0, 0, 0}, 0};
  return (Plane){a, cag_scaled(n, 1 / area), area};
}

static double height(const Plane *p, CagVec3 point) {
  return fabs(cag_dot(p->normal, cag_sub(point, p->at)));
}

static bool lies_in(const Snap *s, uint32_t face, const Plane *plane) {
  const BoolFace *f = &s->w->faces[face];
  for (int k = 0; k < 3; k++)
    if (height(plane, s->w->points.at[f->v[k]]) > s->w->slack) return false;
  return true;
}

// Whether the smaller face lies in the plane of the larger, which is better determined.
static bool are_coplanar(const Snap *s, uint32_t f, uint32_t g) {
  const Plane *p = &s->planes[f], *q = &s->planes[g];
  if (!(p->area > 0) || !(q->area > 0)) return false;
  const CagVec3 across = cag_cross(p->normal, q->normal);
  if (cag_dot(across, across) > PARALLEL) return false;
  return p->area >= q->area ? lies_in(s, g, p) : lies_in(s, f, q);
}

static void join(uint32_t *parent, uint32_t a, uint32_t b) {
  a = cag_bool_root(parent, a);
  b = cag_bool_root(parent, b);
  if (a < b) parent[b] = a;
  else parent[a] = b;
}

static bool join_pair(void *context, uint32_t f, uint32_t g) {
  Snap *s = context;
  if (cag_bool_root(s->parent, f) != cag_bool_root(s->parent, g) && are_coplanar(s, f, g))
    join(s->parent, f, g);
  return true;
}

static bool is_shared(const Class *c) { return c->owners == 3; }

static uint32_t class_of(Snap *s, uint32_t face) {
  const uint32_t root = cag_bool_root(s->parent, face);
  return is_shared(&s->classes[root]) ? root : BOOL_NONE;
}

// Determines the classes of connected coplanar faces. *found: operands share a plane.
static void tell_classes(Snap *s, bool *found) {
  *found = false;
  for (uint32_t f = 0; f < s->w->face_count; f++)
    s->classes[f] = (Class){f, 0, {BOOL_NONE, BOOL_NONE, BOOL_NONE}};
  for (uint32_t f = 0; f < s->w->face_count; f++) {
    const BoolFace *face = &s->w->faces[f];
    Class *c = &s->classes[cag_bool_root(s->parent, f)];
    if (s->planes[f].area > s->planes[c->face].area) c->face = f;
    if (!face->times[0] != !face->times[1]) c->owners |= face->times[0] ? 1 : 2;
    *found = *found || is_shared(c);
  }
}

// --- Classes of corners ---

static bool holds(const Snap *s, uint32_t corner, size_t n, uint32_t class) {
  for (size_t i = 0; i < n; i++)
    if (s->members[s->start[corner] + i] == class) return true;
  return false;
}

// Lists each class of a corner once; *count: number for each corner.
static bool list_members(Snap *s, uint32_t *count) {
  const BoolWork *w = s->w;
  memset(count, 0, (w->points.n + 1) * sizeof *count);
  memset(s->start, 0, (w->points.n + 2) * sizeof *s->start);
  for (uint32_t f = 0; f < w->face_count; f++)
    for (int k = 0; k < 3 && class_of(s, f) != BOOL_NONE; k++) s->start[w->faces[f].v[k] + 1]++;
  for (size_t i = 0; i < w->points.n; i++) s->start[i + 1] += s->start[i];
  cag_free(s->members);
  s->members = cag_malloc((s->start[w->points.n] + 1) * sizeof *s->members);
  if (!s->members) return false;
  for (uint32_t f = 0; f < w->face_count; f++) {
    const uint32_t class = class_of(s, f);
    for (int k = 0; k < 3 && class != BOOL_NONE; k++) {
      const uint32_t v = w->faces[f].v[k];
      if (!holds(s, v, count[v], class)) s->members[s->start[v] + count[v]++] = class;
    }
  }
  return true;
}

// Joins parts of one plane that are separated by thin faces and meet at corners. *joined: there
// were some.
static void join_at_corners(Snap *s, const uint32_t *count, bool *joined) {
  *joined = false;
  for (uint32_t v = 0; v < s->w->points.n; v++)
    for (uint32_t i = 1; i < count[v]; i++)
      for (uint32_t k = 0; k < i; k++) {
        const uint32_t a = s->members[s->start[v] + i], b = s->members[s->start[v] + k];
        if (cag_bool_root(s->parent, a) == cag_bool_root(s->parent, b) ||
            !are_coplanar(s, s->classes[a].face, s->classes[b].face))
          continue;
        join(s->parent, a, b);
        *joined = true;
      }
}

// --- Points of a plane ---

// The next of three points: the farthest from the first, or from the line of the first two. Corners
// of more than three planes are preferred: if all these planes pass through them, they need not
// move.
static double spread(const BoolWork *w, const uint32_t *points, int n, uint32_t v) {
  const CagVec3 *at = w->points.at, off = cag_sub(at[v], at[points[0]]);
  if (n == 1) return cag_norm(off);
  return cag_norm(cag_cross(cag_unit(cag_sub(at[points[1]], at[points[0]])), off));
}

static void choose_point(const Snap *s, const uint32_t *faces, size_t n, const uint32_t *count,
                         double least, uint32_t *points, int *chosen) {
  double best[2] = {least, least};
  uint32_t next[2] = {BOOL_NONE, BOOL_NONE};
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) {
      const uint32_t v = s->w->faces[faces[i]].v[k];
      const int free = count[v] <= 3;
      const double far = *chosen ? spread(s->w, points, *chosen, v) : INFINITY;
      if (far > best[free]) best[free] = far, next[free] = v;
      if (!*chosen && next[0] != BOOL_NONE) break;
    }
  points[(*chosen)++] = next[0] != BOOL_NONE ? next[0] : next[1];
}

static void tell_points(Snap *s, uint32_t class, const uint32_t *faces, size_t n,
                        const uint32_t *count) {
  const BoolWork *w = s->w;
  Class *c = &s->classes[class];
  const BoolFace *largest = &w->faces[c->face];
  const double size = sqrt(s->planes[c->face].area), wide = 0.05; // of the largest face
  int chosen = 0;
  memcpy(c->points, largest->v, sizeof c->points);
  uint32_t points[3];
  while (chosen < 3) {
    choose_point(s, faces, n, count, wide * size, points, &chosen);
    if (points[chosen - 1] == BOOL_NONE) return;
  }
  const BoolFace alike = {.v = {points[0], points[1], points[2]}};
  const Plane plane = plane_of(w, &alike);
  if (!(plane.area > 0)) return;
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++)
      if (height(&plane, w->points.at[w->faces[faces[i]].v[k]]) > REACH * w->slack) return;
  memcpy(c->points, points, sizeof c->points);
}

static bool tell_all_points(Snap *s, const uint32_t *count) {
  const size_t n = s->w->face_count;
  size_t *start = cag_calloc(n + 2, sizeof *start);
  uint32_t *faces = cag_malloc((n + 1) * sizeof *faces);
  if (start && faces) {
    for (uint32_t f = 0; f < n; f++) start[cag_bool_root(s->parent, f) + 2]++;
    for (size_t i = 2; i < n + 2; i++) start[i] += start[i - 1];
    for (uint32_t f = 0; f < n; f++) faces[start[cag_bool_root(s->parent, f) + 1]++] = f;
    for (uint32_t f = 0; f < n; f++)
      if (class_of(s, f) == f) tell_points(s, f, faces + start[f], start[f + 1] - start[f], count);
  }
  const bool done = start && faces;
  cag_free(start);
  cag_free(faces);
  return done;
}

// --- Moving corners ---

static CagVec3 class_normal(const Snap *s, uint32_t class) {
  const CagVec3 *at = s->w->points.at;
  const uint32_t *p = s->classes[class].points;
  return cag_unit(cag_cross(cag_sub(at[p[1]], at[p[0]]), cag_sub(at[p[2]], at[p[0]])));
}

// Up to three independent planes of a corner: those with the largest volume.
static int choose_planes(const Snap *s, const uint32_t *classes, uint32_t n, uint32_t out[3]) {
  CagVec3 normal[2];
  int chosen = 0;
  while (chosen < 3) {
    double best = INDEPENDENT;
    uint32_t next = BOOL_NONE;
    for (uint32_t i = 0; i < n; i++) {
      const CagVec3 m = class_normal(s, classes[i]);
      const double span = chosen == 0   ? 1
                          : chosen == 1 ? cag_norm(cag_cross(normal[0], m))
                                        : fabs(cag_dot(cag_cross(normal[0], normal[1]), m));
      if (span > best) best = span, next = classes[i];
    }
    if (next == BOOL_NONE) break;
    if (chosen < 2) normal[chosen] = class_normal(s, next);
    out[chosen++] = next;
  }
  return chosen;
}

static int largest_axis(CagVec3 v) {
  const double x = fabs(v.x), y = fabs(v.y), z = fabs(v.z);
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

// The number of the corner moved onto the planes; the corner itself if that is impossible.
static uint32_t moved_onto(Snap *s, uint32_t corner, const uint32_t *classes, int n) {
  BoolPoints *p = &s->w->points;
  uint32_t planes[3][3];
  int kept[2] = {0, 0}, axis = 0;
  bool there = true;
  for (int i = 0; i < n; i++) {
    memcpy(planes[i], s->classes[classes[i]].points, sizeof planes[i]);
    there = there && cag_bool_side(p, planes[i], corner) == 0;
  }
  if (there || n == 0) return corner;
  if (n == 1) {
    axis = largest_axis(class_normal(s, classes[0]));
    kept[0] = (axis + 1) % 3;
    kept[1] = (axis + 2) % 3;
  } else {
    kept[0] = largest_axis(cag_cross(class_normal(s, classes[0]), class_normal(s, classes[1])));
  }
  const uint32_t at = cag_bool_points_put(p, corner, (const uint32_t(*)[3])planes, n, kept);
  if (at == BOOL_NONE) return at;
  const double most = REACH * s->w->slack / INDEPENDENT;
  return cag_norm(cag_sub(p->at[at], p->at[corner])) <= most
             ? at
             : moved_onto(s, corner, classes, n - 1);
}

static bool move_corners(Snap *s, const uint32_t *count, size_t n, uint32_t *number) {
  for (uint32_t v = 0; v < n; v++) {
    uint32_t chosen[3];
    number[v] = v;
    if (!count[v]) continue;
    const int planes = choose_planes(s, s->members + s->start[v], count[v], chosen);
    number[v] = moved_onto(s, v, chosen, planes);
    if (number[v] == BOOL_NONE) return false;
  }
  return true;
}

// Replaces the plane of faces whose corners all lie in it now.
static void tell_faces(Snap *s, const uint32_t *number, uint32_t *plane) {
  for (uint32_t f = 0; f < s->w->face_count; f++) {
    const uint32_t class = class_of(s, f);
    uint32_t *to = plane + 3 * (size_t)f;
    to[0] = to[1] = to[2] = BOOL_NONE;
    if (class == BOOL_NONE) continue;
    const uint32_t *points = s->classes[class].points;
    bool all = true;
    for (int k = 0; k < 3 && all; k++)
      all = cag_bool_side(&s->w->points, points, number[s->w->faces[f].v[k]]) == 0;
    if (all) memcpy(to, points, 3 * sizeof *to);
  }
}

static CagStatus find_classes(Snap *s, uint32_t *count, bool *found) {
  BoolWork *w = s->w;
  bool joined = true;
  for (uint32_t f = 0; f < w->face_count; f++) {
    s->parent[f] = f;
    s->planes[f] = plane_of(w, &w->faces[f]);
    if (cag_stop_check(w->err)) return w->err->status;
  }
  CagStatus status = cag_bool_visit_pairs(w, join_pair, s);
  if (status) return status;
  tell_classes(s, found);
  while (*found && joined) { // terminates: each round leaves fewer classes
    if (cag_stop_check(w->err)) return w->err->status;
    if (!list_members(s, count)) return cag_fail_memory(w->err);
    join_at_corners(s, count, &joined);
    tell_classes(s, found);
  }
  return CAG_OK;
}

CagStatus cag_bool_find_planes(BoolWork *w, uint32_t *number, uint32_t *plane, bool *found) {
  const size_t faces = w->face_count + 1, points = w->points.n;
  Snap s = {.w = w};
  uint32_t *count = cag_malloc((points + 1) * sizeof *count);
  s.planes = cag_malloc(faces * sizeof *s.planes);
  s.parent = cag_malloc(faces * sizeof *s.parent);
  s.classes = cag_malloc(faces * sizeof *s.classes);
  s.start = cag_malloc((points + 2) * sizeof *s.start);
  *found = false;
  CagStatus status = CAG_OK;
  if (!count || !s.planes || !s.parent || !s.classes || !s.start) status = cag_fail_memory(w->err);
  if (!status) status = find_classes(&s, count, found);
  if (!status && *found) {
    if (tell_all_points(&s, count) && move_corners(&s, count, points, number))
      tell_faces(&s, number, plane);
    else status = cag_fail_memory(w->err);
  }
  cag_free(count);
  snap_free(&s);
  return status;
}
