// Which faces of a set operation meet, and in what.
//
// A tree of boxes over the faces in Morton order is traversed against itself. Two faces in
// different planes meet in a point or a segment. Its ends are corners of one face in the other, or
// points where an edge of one passes through the other, as decided by signs of determinants of the
// operands' corners. Faces that overlap or touch in one plane form a group and are cut together.

#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boolean/work.h"

#define LEAF_FACES 4
#define STOP_INTERVAL 1024 // pairs of leaves between looks at the caller's wish to stop

typedef struct BoolNode {
  CagBounds box;
  uint32_t first, count; // of `order`
  uint32_t right;        // the left child follows its parent; 0: a leaf
} BoolNode;

static bool boxes_meet(const CagBounds *a, const CagBounds *b) {
  return a->min.x <= b->max.x && b->min.x <= a->max.x && a->min.y <= b->max.y &&
         b->min.y <= a->max.y && a->min.z <= b->max.z && b->min.z <= a->max.z;
}

// For numbers other than NaN; fmin and fmax are slower.
static double least(double a, double b) { return a < b ? a : b; }
static double most(double a, double b) { return a > b ? a : b; }

static void add_box(CagBounds *all, const CagBounds *b) {
  all->min = cag_vec3(least(all->min.x, b->min.x), least(all->min.y, b->min.y),
                      least(all->min.z, b->min.z));
  all->max =
      cag_vec3(most(all->max.x, b->max.x), most(all->max.y, b->max.y), most(all->max.z, b->max.z));
}

static CagBounds face_box(const BoolWork *w, uint32_t f) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (int k = 0; k < 3; k++) {
    const CagVec3 p = w->points.at[w->faces[f].v[k]];
    add_box(&box, &(CagBounds){p, p});
  }
  const CagVec3 room = {w->slack, w->slack, w->slack};
  return (CagBounds){cag_sub(box.min, room), cag_add(box.max, room)};
}

// --- The tree ---

typedef struct Place {
  uint64_t code;
  uint32_t face;
} Place;

// Moves each bit to every third position.
static uint64_t spread(uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffu;
  x = (x | x << 16) & 0x1f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

static uint64_t grid_step(double x, double low, double high) {
  const double steps = 2097151; // 21 bits
  return high > low ? (uint64_t)((x - low) / (high - low) * steps) : 0;
}

// A stable sort by code; needs n more items of scratch space after p.
static void sort_places(Place *p, size_t n) {
  // 66 bits: an even number of passes, so that the result ends up in p.
  enum { BITS = 11, DIGITS = 6 };
  // Before each pass p holds a permutation, which remains if the work is canceled.
  for (int digit = 0; digit < DIGITS && !cag_stopped(); digit++) {
    size_t start[(1 << BITS) + 1] = {0};
    Place *from = digit % 2 ? p + n : p, *to = digit % 2 ? p : p + n;
    const uint64_t mask = (1 << BITS) - 1;
    for (size_t i = 0; i < n; i++) start[(from[i].code >> (BITS * digit) & mask) + 1]++;
    for (int k = 0; k < 1 << BITS; k++) start[k + 1] += start[k];
    for (size_t i = 0; i < n; i++) to[start[from[i].code >> (BITS * digit) & mask]++] = from[i];
  }
}

static bool sort_faces(BoolWork *w) {
  Place *places = cag_malloc((2 * w->face_count + 1) * sizeof *places);
  if (!places) return false;
  CagBounds all = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < w->corners; i++)
    add_box(&all, &(CagBounds){w->points.at[i], w->points.at[i]});
  for (uint32_t f = 0; f < w->face_count; f++) {
    const CagBounds box = face_box(w, f);
    const CagVec3 c = cag_lerp(box.min, box.max, 0.5);
    places[f].face = f;
    places[f].code = spread(grid_step(c.x, all.min.x, all.max.x)) |
                     spread(grid_step(c.y, all.min.y, all.max.y)) << 1 |
                     spread(grid_step(c.z, all.min.z, all.max.z)) << 2;
  }
  sort_places(places, w->face_count);
  for (size_t i = 0; i < w->face_count; i++) {
    w->order[i] = places[i].face;
    w->boxes[i] = face_box(w, places[i].face);
  }
  cag_free(places);
  return true;
}

static uint32_t build_node(BoolWork *w, uint32_t first, uint32_t count, uint32_t *used) {
  const uint32_t at = (*used)++;
  BoolNode *node = &w->nodes[at];
  *node = (BoolNode){CAG_BOUNDS_EMPTY, first, count, 0};
  if (count <= LEAF_FACES) {
    for (uint32_t i = 0; i < count; i++) add_box(&node->box, &w->boxes[first + i]);
    return at;
  }
  const uint32_t half = count / 2, left = build_node(w, first, half, used);
  node->right = build_node(w, first + half, count - half, used);
  add_box(&node->box, &w->nodes[left].box);
  add_box(&node->box, &w->nodes[node->right].box);
  return at;
}

static bool build_tree(BoolWork *w) {
  w->order = cag_malloc((w->face_count + 1) * sizeof *w->order);
  w->nodes = cag_malloc((2 * w->face_count + 1) * sizeof *w->nodes);
  w->boxes = cag_malloc((w->face_count + 1) * sizeof *w->boxes);
  if (!w->order || !w->nodes || !w->boxes || !sort_faces(w)) return false;
  uint32_t used = 0;
  build_node(w, 0, (uint32_t)w->face_count, &used);
  return true;
}

static void visit_ray(const BoolWork *w, uint32_t at, CagVec3 from, BoolRayVisit *visit,
                      void *context) {
  const BoolNode *node = &w->nodes[at];
  const CagBounds *b = &node->box;
  if (b->max.x < from.x || b->min.y > from.y || b->max.y < from.y || b->min.z > from.z ||
      b->max.z < from.z)
    return;
  if (node->right) {
    visit_ray(w, at + 1, from, visit, context);
    visit_ray(w, node->right, from, visit, context);
    return;
  }
  for (uint32_t i = 0; i < node->count; i++) visit(context, w->order[node->first + i]);
}

void cag_bool_visit_ray(const BoolWork *w, CagVec3 from, BoolRayVisit *visit, void *context) {
  visit_ray(w, 0, from, visit, context);
}

// --- Coplanar faces ---

uint32_t cag_bool_root(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

static void join(uint32_t *parent, uint32_t a, uint32_t b) {
  a = cag_bool_root(parent, a);
  b = cag_bool_root(parent, b);
  if (a < b) parent[b] = a;
  else parent[a] = b;
}

bool cag_bool_is_in_face(BoolWork *w, const BoolFace *f, uint32_t v) {
  for (int k = 0; k < 3; k++)
    if (cag_bool_turn(&w->points, f->v[k], f->v[(k + 1) % 3], v, f->axis) == -f->sign) return false;
  return true;
}

static bool has_corner(const BoolFace *f, uint32_t v) {
  return f->v[0] == v || f->v[1] == v || f->v[2] == v;
}

static bool edges_cross(BoolWork *w, const uint32_t a[2], const uint32_t b[2], int axis) {
  return cag_bool_turn(&w->points, a[0], a[1], b[0], axis) *
                 cag_bool_turn(&w->points, a[0], a[1], b[1], axis) <
             0 &&
         cag_bool_turn(&w->points, b[0], b[1], a[0], axis) *
                 cag_bool_turn(&w->points, b[0], b[1], a[1], axis) <
             0;
}

// Whether two coplanar faces share more than whole edges and corners.
static bool touch_in_plane(BoolWork *w, const BoolFace *f, const BoolFace *g) {
  for (int k = 0; k < 3; k++) {
    if (!has_corner(g, f->v[k]) && cag_bool_is_in_face(w, g, f->v[k])) return true;
    if (!has_corner(f, g->v[k]) && cag_bool_is_in_face(w, f, g->v[k])) return true;
  }
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      const uint32_t a[2] = {f->v[i], f->v[(i + 1) % 3]}, b[2] = {g->v[k], g->v[(k + 1) % 3]};
      if (edges_cross(w, a, b, f->axis)) return true;
    }
  return false;
}

// --- Faces in different planes ---

typedef struct Meeting {
  uint32_t points[12];
  int n;
} Meeting;

static bool add_meeting(Meeting *m, uint32_t point) {
  for (int i = 0; i < m->n; i++)
    if (m->points[i] == point) return true;
  m->points[m->n++] = point;
  return point != BOOL_NONE;
}

// Whether the line a, b, which crosses g's plane, passes through g or its boundary.
static bool goes_through(BoolWork *w, const BoolFace *g, uint32_t a, uint32_t b) {
  int seen = 0;
  for (int k = 0; k < 3; k++) {
    const uint32_t plane[3] = {a, b, g->v[k]};
    const int side = cag_bool_side(&w->points, plane, g->v[(k + 1) % 3]);
    if (side * seen < 0) return false;
    if (side) seen = side;
  }
  return true;
}

// Corners and edges of f in g; side: sides of g's plane for f's corners.
static bool meet_from(BoolWork *w, const BoolFace *f, const BoolFace *g, const int side[3],
                      Meeting *m) {
  for (int k = 0; k < 3; k++) {
    const uint32_t a = f->v[k], b = f->v[(k + 1) % 3];
    if (side[k] == 0 && (has_corner(g, a) || cag_bool_is_in_face(w, g, a)) && !add_meeting(m, a))
      return false;
    if (side[k] * side[(k + 1) % 3] >= 0 || !goes_through(w, g, a, b)) continue;
    if (!add_meeting(m, cag_bool_points_cross(&w->points, a, b, g->plane))) return false;
  }
  return true;
}

static bool add_contact(BoolWork *w, uint32_t f, uint32_t a, uint32_t b, const BoolFace *other) {
  const BoolFace *face = &w->faces[f];
  if (has_corner(face, a) && has_corner(face, b)) { // an edge of its own
    for (int k = 0; k < 3 && a != b; k++)
      if (face->v[k] != a && face->v[k] != b) w->touched[f] |= (uint8_t)(1u << (k + 1) % 3);
    return true;
  }
  if (!cag_bool_list_reserve(&w->contacts, w->contacts.n + 1, sizeof(BoolContact))) return false;
  ((BoolContact *)w->contacts.items)[w->contacts.n++] =
      (BoolContact){f, a, b, {other->plane[0], other->plane[1], other->plane[2], 0}};
  return true;
}

static bool meet_in_space(BoolWork *w, uint32_t f, uint32_t g, const int side_f[3],
                          const int side_g[3]) {
  const BoolFace *one = &w->faces[f], *two = &w->faces[g];
  Meeting m;
  m.n = 0;
  if (!meet_from(w, one, two, side_f, &m) || !meet_from(w, two, one, side_g, &m)) return false;
  if (m.n == 0) return true;
  uint32_t first = m.points[0], last = first;
  for (int i = 1; i < m.n; i++) {
    if (cag_bool_compare_all(&w->points, m.points[i], first) > 0) first = m.points[i];
    if (cag_bool_compare_all(&w->points, last, m.points[i]) > 0) last = m.points[i];
  }
  return add_contact(w, f, first, last, two) && add_contact(w, g, first, last, one);
}

// For neighbors in a mesh: whether an edge of f, seen along f's axis, separates f from g except for
// their common corners. This distinguishes most neighbors, without exact arithmetic if they are
// nearly coplanar.
static bool are_beside(BoolWork *w, const BoolFace *f, const BoolFace *g) {
  const bool shared[3] = {has_corner(f, g->v[0]), has_corner(f, g->v[1]), has_corner(f, g->v[2])};
  if (!shared[0] && !shared[1] && !shared[2]) return false;
  for (int i = 0; i < 3; i++) {
    const uint32_t a = f->v[i], b = f->v[(i + 1) % 3];
    int beyond = 0;
    for (int k = 0; k < 3 && beyond == k; k++) {
      const uint32_t v = g->v[k];
      if (shared[k]) beyond += v == a || v == b;
      else beyond += cag_bool_turn(&w->points, a, b, v, f->axis) == -f->sign;
    }
    if (beyond == 3) return true;
  }
  return false;
}

// Returns whether f is on one side of g's plane, touching it at most in one common corner.
static bool find_sides(BoolWork *w, const BoolFace *f, const BoolFace *g, int side[3],
                       bool *shares) {
  int above = 0, below = 0, shared = 0;
  for (int k = 0; k < 3; k++) {
    const bool both = has_corner(g, f->v[k]);
    side[k] = both ? 0 : cag_bool_side(&w->points, g->plane, f->v[k]);
    above += side[k] > 0;
    below += side[k] < 0;
    shared += both;
  }
  *shares = shared > 1;
  return above + shared == 3 ? shared < 2 : below + shared == 3 && shared < 2;
}

static bool meet(void *context, uint32_t f, uint32_t g) {
  BoolWork *w = context;
  const BoolFace *one = &w->faces[f], *two = &w->faces[g];
  int side_f[3], side_g[3];
  bool edge;
  if (cag_bool_root(w->plane_of, f) == cag_bool_root(w->plane_of, g))
    return true; // cut together anyway
  if (are_beside(w, one, two) || find_sides(w, one, two, side_f, &edge)) return true;
  const bool flat = !side_f[0] && !side_f[1] && !side_f[2];
  if (edge && !flat) return true; // only a common edge
  if (flat) {
    if (touch_in_plane(w, one, two)) join(w->plane_of, f, g);
    return true;
  }
  if (find_sides(w, two, one, side_g, &edge)) return true;
  return meet_in_space(w, f, g, side_f, side_g);
}

// --- Pairs ---

typedef struct Search {
  BoolWork *work;
  BoolPairVisit *visit;
  void *context;
  size_t leaves;
  CagStatus status;
} Search;

static bool goes_on(Search *s) {
  if (!s->status && s->leaves++ % STOP_INTERVAL == 0) s->status = cag_bool_stopped(s->work);
  return !s->status;
}

static void meet_leaves(Search *s, const BoolNode *a, const BoolNode *b) {
  BoolWork *w = s->work;
  if (!goes_on(s)) return;
  for (uint32_t i = 0; i < a->count; i++) {
    const uint32_t f = w->order[a->first + i];
    const CagBounds *box = &w->boxes[a->first + i];
    if (a != b && !boxes_meet(box, &b->box)) continue;
    for (uint32_t k = a == b ? i + 1 : 0; k < b->count; k++) {
      const uint32_t g = w->order[b->first + k];
      if (!boxes_meet(box, &w->boxes[b->first + k]) || s->visit(s->context, f, g)) continue;
      s->status = cag_fail_memory(w->err);
      return;
    }
  }
}

static void meet_nodes(Search *s, uint32_t i, uint32_t k) {
  const BoolNode *a = &s->work->nodes[i], *b = &s->work->nodes[k];
  if (s->status || !boxes_meet(&a->box, &b->box)) return;
  if (!a->right && !b->right) meet_leaves(s, a, b);
  else if (a->count >= b->count) {
    meet_nodes(s, i + 1, k);
    meet_nodes(s, a->right, k);
  } else {
    meet_nodes(s, i, k + 1);
    meet_nodes(s, i, b->right);
  }
}

static void meet_within(Search *s, uint32_t i) {
  const BoolNode *a = &s->work->nodes[i];
  if (s->status) return;
  if (!a->right) {
    meet_leaves(s, a, a);
    return;
  }
  meet_within(s, i + 1);
  meet_within(s, a->right);
  meet_nodes(s, i + 1, a->right);
}

void cag_bool_forget_pairs(BoolWork *w) {
  cag_free(w->nodes);
  cag_free(w->order);
  cag_free(w->boxes);
  w->nodes = NULL;
  w->order = NULL;
  w->boxes = NULL;
}

CagStatus cag_bool_visit_pairs(BoolWork *w, BoolPairVisit *visit, void *context) {
  if (!w->nodes && !build_tree(w)) return cag_fail_memory(w->err);
  if (cag_stop_check(w->err)) return w->err->status;
  Search s = {w, visit, context, 0, CAG_OK};
  meet_within(&s, 0);
  return s.status;
}

CagStatus cag_bool_find_contacts(BoolWork *w) {
  w->plane_of = cag_malloc((w->face_count + 1) * sizeof *w->plane_of);
  w->touched = cag_calloc(w->face_count + 1, 1);
  if (!w->plane_of || !w->touched) return cag_fail_memory(w->err);
  for (uint32_t f = 0; f < w->face_count; f++) w->plane_of[f] = f;
  return cag_bool_visit_pairs(w, meet, w);
}
