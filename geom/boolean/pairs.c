// Which faces of a set operation meet, and in what.
//
// A tree of boxes over the faces is traversed against itself. Two faces in different planes meet in a point or a segment. Its ends are corners of one face in the other, or
// points where an edge of one passes through the other, as decided by signs of determinants of the
// operands' corners. Faces that overlap or touch in one plane form a group and are cut together.

#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boolean/work.h"

#define STOP_INTERVAL 1024 // pairs between looks at the caller's wish to stop

static CagBounds face_box(const BoolWork *w, uint32_t f) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (int k = 0; k < 3; k++) cag_bounds_add(&box, w->points.at[w->faces[f].v[k]]);
  const CagVec3 room = {w->slack, w->slack, w->slack};
  return (CagBounds){cag_sub(box.min, room), cag_add(box.max, room)};
}

static CagStatus build_tree(BoolWork *w) {
  CagBounds *boxes = cag_malloc((w->face_count + 1) * sizeof *boxes);
  if (!boxes) return cag_fail_memory(w->err);
  for (uint32_t f = 0; f < w->face_count; f++) boxes[f] = face_box(w, f);
  const CagStatus status = cag_box_tree_new(boxes, w->face_count, &w->tree, w->err);
  cag_free(boxes);
  return status;
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
  size_t pairs;
} Search;

static CagStatus visit_pair(void *context, uint32_t f, uint32_t g) {
  Search *s = context;
  if (s->pairs++ % STOP_INTERVAL == 0 && cag_bool_stopped(s->work)) return s->work->err->status;
  return s->visit(s->context, f, g) ? CAG_OK : cag_fail_memory(s->work->err);
}

void cag_bool_forget_pairs(BoolWork *w) { cag_box_tree_free(&w->tree); }

CagStatus cag_bool_visit_pairs(BoolWork *w, BoolPairVisit *visit, void *context) {
  CagStatus status = w->tree.nodes ? CAG_OK : build_tree(w);
  if (!status) status = cag_stop_check(w->err);
  Search s = {w, visit, context, 0};
  return status ? status : cag_box_tree_pairs(&w->tree, visit_pair, &s);
}

CagStatus cag_bool_find_contacts(BoolWork *w) {
  w->plane_of = cag_malloc((w->face_count + 1) * sizeof *w->plane_of);
  w->touched = cag_calloc(w->face_count + 1, 1);
  if (!w->plane_of || !w->touched) return cag_fail_memory(w->err);
  for (uint32_t f = 0; f < w->face_count; f++) w->plane_of[f] = f;
  return cag_bool_visit_pairs(w, meet, w);
}
