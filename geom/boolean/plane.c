// Cuts the faces of a set operation along their intersections.
//
// A face that overlaps no coplanar face is triangulated with its contacts. Coplanar faces that
// overlap are triangulated together, inside a large triangle and with their edges as segments; each
// cell is then a piece of all faces that cover it. So pieces of two faces are either identical or
// disjoint. Neighbors in one flat face form a patch, of which only the outline is inserted, so the
// division into triangles does not matter.

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geom/boolean/net.h"
#include "geom/mesh/edges.h"

// Groups of faces, or points and segments of one, between checks of the stop flag.
#define STOP_INTERVAL 64

// Faces or contacts sorted by group: those of a group are items[start[root]] to items[start[root +
// 1] - 1].
typedef struct Groups {
  size_t *start;
  uint32_t *items;
} Groups;

// The coverage of a cell.
typedef struct Cover {
  int32_t times[2];
  uint32_t face; // the first face; BOOL_NONE: none
  signed char facing;
  uint32_t mark; // the last patch that covered it, plus 1
} Cover;

// A projected edge of a face of a group: the face is to its left.
typedef struct Side {
  uint32_t from, to, face, patch;
  bool shared; // it belongs to more than two faces and must be kept
  bool inner;  // between two faces of a patch
} Side;

typedef struct Cutter {
  BoolWork *w;
  BoolNet net;
  Groups faces, contacts;
  BoolList points; // of Spot
  BoolList covers; // of Cover
  BoolList stack;  // of uint32_t
  BoolList sides;  // of Side: of the group, sorted by patch
  BoolList walls;  // of uint32_t, by 3 * cell + corner: the last patch that ends there, plus 1
  uint32_t *patch; // union-find forest of the faces
  uint8_t *shared; // for each face, bits for the edges that have more than two faces or are touched
                   // by others
} Cutter;

typedef struct Spot {
  double x, y;
  uint32_t point;
} Spot;

// --- Groups ---

static uint32_t contact_face(const BoolWork *w, size_t i) {
  return ((const BoolContact *)w->contacts.items)[i].face;
}

static bool sort_groups(BoolWork *w, size_t n, bool contacts, Groups *g) {
  g->start = cag_calloc(w->face_count + 2, sizeof *g->start);
  g->items = cag_malloc((n + 1) * sizeof *g->items);
  if (!g->start || !g->items) return false;
  for (int pass = 0; pass < 2; pass++) {
    for (size_t i = 0; i < n; i++) {
      const uint32_t root = cag_bool_root(w->plane_of, contacts ? contact_face(w, i) : (uint32_t)i);
      if (pass == 0) g->start[root + 2]++;
      else g->items[g->start[root + 1]++] = (uint32_t)i;
    }
    for (size_t f = 2; pass == 0 && f < w->face_count + 2; f++) g->start[f] += g->start[f - 1];
  }
  return true;
}

static bool add_piece(BoolWork *w, BoolPiece piece) {
  if (piece.times[0] == 0 && piece.times[1] == 0) return true;
  if (!cag_bool_list_reserve(&w->pieces, w->pieces.n + 1, sizeof piece)) return false;
  bool_pieces(w)[w->pieces.n++] = piece;
  return true;
}

// One group may be large. Steps return false if canceled, as if memory ran out.
static bool goes_on(const Cutter *c, size_t i) {
  return i % STOP_INTERVAL != 0 || !cag_bool_stopped(c->w);
}

// --- Points, in an order that keeps walks short ---

static bool note_point(Cutter *c, uint32_t point) {
  if (!cag_bool_list_reserve(&c->points, c->points.n + 1, sizeof(Spot))) return false;
  const CagVec3 p = c->w->points.at[point];
  const int axis = c->net.axis;
  ((Spot *)c->points.items)[c->points.n++] = (Spot){axis == 0   ? p.y
                                                    : axis == 1 ? p.z
                                                                : p.x,
                                                    axis == 0   ? p.z
                                                    : axis == 1 ? p.x
                                                                : p.y,
                                                    point};
  return true;
}

static int by_x(const void *a, const void *b) {
  const Spot *p = a, *q = b;
  if (p->x != q->x) return p->x < q->x ? -1 : 1;
  if (p->y != q->y) return p->y < q->y ? -1 : 1;
  return p->point < q->point ? -1 : p->point > q->point;
}
static int by_y(const void *a, const void *b) {
  const Spot *p = a, *q = b;
  if (p->y != q->y) return p->y < q->y ? -1 : 1;
  return by_x(a, b);
}
static int by_y_down(const void *a, const void *b) { return by_y(b, a); }

// Sorts into strips of about the square root of all points, alternating up and down.
static bool add_points(Cutter *c) {
  Spot *spots = c->points.items;
  const size_t n = c->points.n;
  qsort(spots, n, sizeof *spots, by_x);
  const size_t strip = (size_t)sqrt((double)n) + 1;
  for (size_t i = 0, k = 0; i < n; i += strip, k++)
    qsort(spots + i, n - i < strip ? n - i : strip, sizeof *spots, k % 2 ? by_y_down : by_y);
  for (size_t i = 0; i < n; i++)
    if (!goes_on(c, i) || !cag_bool_net_add_point(&c->net, spots[i].point)) return false;
  return true;
}

// --- One group ---

static bool start_large(Cutter *c, const BoolFace *rep) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  const int first = (rep->axis + 1) % 3, second = (rep->axis + 2) % 3;
  for (size_t i = 0; i < c->points.n; i++) {
    const Spot *s = (Spot *)c->points.items + i;
    low[first] = fmin(low[first], s->x);
    high[first] = fmax(high[first], s->x);
    low[second] = fmin(low[second], s->y);
    high[second] = fmax(high[second], s->y);
  }
  const double size = fmax(high[first] - low[first], high[second] - low[second]);
  uint32_t corners[3];
  for (int k = 0; k < 3; k++) {
    double at[3] = {0, 0, 0};
    at[first] = k == 1 ? high[first] + 5 * size : low[first] - 2 * size;
    at[second] = k == 2 ? high[second] + 5 * size : low[second] - 2 * size;
    corners[k] = cag_bool_points_add_far(&c->w->points, cag_vec3(at[0], at[1], at[2]));
    if (corners[k] == BOOL_NONE) return false;
  }
  return cag_bool_net_start(&c->net, corners);
}

static bool add_contacts(Cutter *c, uint32_t root) {
  for (size_t i = c->contacts.start[root]; i < c->contacts.start[root + 1]; i++) {
    const BoolContact *k = (BoolContact *)c->w->contacts.items + c->contacts.items[i];
    if (!goes_on(c, i)) return false;
    if (k->a != k->b && !cag_bool_net_add_segment(&c->net, k->a, k->b, k->cut)) return false;
  }
  return true;
}

static bool add_edges(Cutter *c) {
  for (size_t i = 0; i < c->sides.n; i++) {
    const Side *s = (Side *)c->sides.items + i;
    if (!goes_on(c, i)) return false;
    if (!s->inner && !cag_bool_net_add_segment(&c->net, s->from, s->to,
                                               (BoolCut){s->from, s->to, BOOL_NONE, c->net.axis}))
      return false;
  }
  return true;
}

// Collects the points of contacts and, for faces that are cut together, the ends of their edges.
static bool note_points(Cutter *c, uint32_t root, bool edges) {
  c->points.n = 0;
  for (size_t i = c->contacts.start[root]; i < c->contacts.start[root + 1]; i++) {
    const BoolContact *k = (BoolContact *)c->w->contacts.items + c->contacts.items[i];
    if (!note_point(c, k->a) || !note_point(c, k->b)) return false;
  }
  for (size_t i = 0; edges && i < c->sides.n; i++) {
    const Side *side = (Side *)c->sides.items + i;
    if (!side->inner && (!note_point(c, side->from) || !note_point(c, side->to))) return false;
  }
  return true;
}

// --- Patches ---

// Finds the edges of more than two faces, once, and only if faces are cut together.
static bool find_shared(Cutter *c) {
  const BoolWork *w = c->w;
  if (c->shared) return true;
  uint32_t *triangles = cag_malloc((3 * w->face_count + 1) * sizeof *triangles);
  c->shared = cag_malloc(w->face_count + 1);
  size_t n = 0;
  for (size_t i = 0; triangles && i < w->face_count; i++)
    memcpy(triangles + 3 * i, w->faces[i].v, sizeof w->faces[i].v);
  if (c->shared) memcpy(c->shared, w->touched, w->face_count);
  CagMeshEdge *e = triangles && c->shared
                       ? cag_mesh_edges(triangles, w->face_count, NULL, w->points.n, &n)
                       : NULL;
  for (size_t i = 0, uses; e && i < n; i += uses) {
    for (uses = 1; i + uses < n && e[i + uses].low == e[i].low && e[i + uses].high == e[i].high;)
      uses++;
    for (size_t k = 0; uses > 2 && k < uses; k++)
      c->shared[cag_mesh_edge_triangle(&e[i + k])] |=
          (uint8_t)(1u << cag_mesh_edge_corner(&e[i + k]));
  }
  cag_free(triangles);
  cag_free(e);
  return e != NULL;
}

static int by_ends(const void *a, const void *b) {
  const Side *p = a, *q = b;
  const uint32_t low = p->from < p->to ? p->from : p->to, other = q->from < q->to ? q->from : q->to;
  const uint32_t high = p->from ^ p->to ^ low, second = q->from ^ q->to ^ other;
  if (low != other) return low < other ? -1 : 1;
  if (high != second) return high < second ? -1 : 1;
  return p->face < q->face ? -1 : p->face > q->face;
}

static bool list_sides(Cutter *c, uint32_t root) {
  const signed char up = c->w->faces[root].axis;
  c->sides.n = 0;
  for (size_t i = c->faces.start[root]; i < c->faces.start[root + 1]; i++) {
    const uint32_t face = c->faces.items[i];
    const BoolFace *f = &c->w->faces[face];
    const bool left = cag_bool_turn(&c->w->points, f->v[0], f->v[1], f->v[2], up) > 0;
    c->patch[face] = face;
    if (!goes_on(c, i) || !cag_bool_list_reserve(&c->sides, c->sides.n + 3, sizeof(Side)))
      return false;
    for (int k = 0; k < 3; k++) {
      const uint32_t a = f->v[k], b = f->v[(k + 1) % 3];
      ((Side *)c->sides.items)[c->sides.n++] =
          (Side){left ? a : b, left ? b : a, face, face, c->shared[face] >> k & 1, false};
    }
  }
  return true;
}

// Whether two triangles have the same constant normal.
static bool share_normal(const CagMesh *m, uint32_t one, uint32_t two) {
  const double same_direction = 1 - 1e-12;
  if (!m->normals) return true;
  const CagVec3 normal = m->normals[m->triangles[3 * (size_t)one]];
  for (size_t k = 0; k < 3; k++) {
    const CagVec3 p = m->normals[m->triangles[3 * (size_t)one + k]];
    const CagVec3 q = m->normals[m->triangles[3 * (size_t)two + k]];
    if (cag_dot(normal, p) < same_direction || cag_dot(normal, q) < same_direction) return false;
  }
  return true;
}

// Whether the faces at two sides of an edge belong to one flat face.
static bool are_one(const BoolWork *w, const Side *one, const Side *two) {
  const BoolFace *f = &w->faces[one->face], *g = &w->faces[two->face];
  if (one->from != two->to || f->owner != g->owner || f->times[0] != g->times[0] ||
      f->times[1] != g->times[1])
    return false;
  const CagMesh *m = w->meshes[f->owner];
  if (m->labels && m->labels[f->triangle] != m->labels[g->triangle]) return false;
  return share_normal(m, f->triangle, g->triangle);
}

static int by_patch(const void *a, const void *b) {
  const Side *p = a, *q = b;
  if (p->patch != q->patch) return p->patch < q->patch ? -1 : 1;
  if (p->face != q->face) return p->face < q->face ? -1 : 1;
  return p->from < q->from ? -1 : p->from > q->from;
}

// Joins the faces of flat faces into patches, and sorts the sides by patch.
static void find_patches(Cutter *c, bool alone) {
  Side *s = c->sides.items;
  if (!s) return; // there are none
  if (!alone) qsort(s, c->sides.n, sizeof *s, by_ends);
  for (size_t i = 0, same; !alone && i < c->sides.n; i += same) {
    for (same = 1;
         i + same < c->sides.n && ((s[i].from == s[i + same].from && s[i].to == s[i + same].to) ||
                                   (s[i].from == s[i + same].to && s[i].to == s[i + same].from));)
      same++;
    if (same != 2 || s[i].shared || s[i + 1].shared || !are_one(c->w, &s[i], &s[i + 1])) continue;
    const uint32_t a = cag_bool_root(c->patch, s[i].face),
                   b = cag_bool_root(c->patch, s[i + 1].face);
    c->patch[a < b ? b : a] = a < b ? a : b;
    s[i].inner = s[i + 1].inner = true;
  }
  if (alone) return; // each face has its own three sides
  for (size_t i = 0; i < c->sides.n; i++) s[i].patch = cag_bool_root(c->patch, s[i].face);
  qsort(s, c->sides.n, sizeof *s, by_patch);
}

// --- Coverage of cells by patches ---

static bool cover(Cutter *c, uint32_t cell, uint32_t face, signed char facing) {
  const BoolFace *f = &c->w->faces[face];
  Cover *at = (Cover *)c->covers.items + cell;
  if (at->mark == face + 1) return true;
  at->mark = face + 1;
  for (int k = 0; k < 2; k++) at->times[k] += facing * f->times[k];
  if (at->face == BOOL_NONE) at->face = face, at->facing = facing;
  if (!cag_bool_list_reserve(&c->stack, c->stack.n + 1, sizeof(uint32_t))) return false;
  ((uint32_t *)c->stack.items)[c->stack.n++] = cell;
  return true;
}

// Covers the cells along the inside of an outline.
static bool cover_sides(Cutter *c, const Side *s, size_t n, uint32_t face, signed char facing) {
  uint32_t *walls = c->walls.items;
  for (size_t i = 0; i < n; i++) {
    uint32_t cell;
    int e;
    if (s[i].inner) continue;
    for (uint32_t at = s[i].from; at != s[i].to;) {
      at = cag_bool_net_step(&c->net, at, s[i].to, &cell, &e);
      if (at == BOOL_NONE) break; // not reached: the segment was inserted
      walls[3 * (size_t)cell + (size_t)e] = face + 1;
      if (!cover(c, cell, face, facing)) return false;
    }
  }
  return true;
}

static double cell_area(const Cutter *c, const uint32_t v[3]) {
  const CagVec3 *p = c->w->points.at;
  const CagVec3 n = cag_cross(cag_sub(p[v[1]], p[v[0]]), cag_sub(p[v[2]], p[v[0]]));
  return fabs(c->net.axis == 0 ? n.x : c->net.axis == 1 ? n.y : n.z);
}

// Covers the cells of a patch, from its outline inward. *covered is their area.
static bool cover_patch(Cutter *c, const Side *s, size_t n, const BoolFace *rep, double *covered) {
  const uint32_t face = s->patch;
  const BoolFace *f = &c->w->faces[face];
  const int seen = cag_bool_turn(&c->w->points, f->v[0], f->v[1], f->v[2], rep->axis);
  const signed char facing = (signed char)(seen * rep->sign);
  if (!cover_sides(c, s, n, face, facing)) return false;
  while (c->stack.n > 0) {
    const uint32_t at = ((uint32_t *)c->stack.items)[--c->stack.n];
    const BoolCell cell = bool_cells(&c->net)[at];
    *covered += cell_area(c, cell.v);
    for (int k = 0; k < 3; k++) {
      const bool ends = ((uint32_t *)c->walls.items)[3 * (size_t)at + (size_t)k] == face + 1;
      if (ends || cell.neighbor[k] == BOOL_NONE) continue;
      if (!cover(c, cell.neighbor[k], face, facing)) return false;
    }
  }
  return true;
}

// Covers the cells of all patches. *overlaps: a patch overlaps itself, so its cells do not count
// how often.
static bool cover_cells(Cutter *c, const BoolFace *rep, bool *overlaps) {
  const double same_area = 1e-6; // far above rounding, far below a triangle that counts twice
  const Side *s = c->sides.items;
  *overlaps = false;
  for (size_t i = 0, n; i < c->sides.n; i += n) {
    double covered = 0, given = 0;
    for (n = 0; i + n < c->sides.n && s[i + n].patch == s[i].patch;) n++;
    if (!goes_on(c, i / 3) || !cover_patch(c, s + i, n, rep, &covered)) return false;
    for (size_t k = 0; k < n; k++) given += cell_area(c, c->w->faces[s[i + k].face].v) / 3;
    if (n > 3 && fabs(covered - given) > same_area * given) *overlaps = true;
  }
  return true;
}

static bool add_cell(Cutter *c, uint32_t i, uint32_t plane, const Cover *cover) {
  const BoolCell *cell = &bool_cells(&c->net)[i];
  const bool turned = c->w->faces[plane].sign < 0;
  return add_piece(c->w, (BoolPiece){{cell->v[0], cell->v[turned ? 2 : 1], cell->v[turned ? 1 : 2]},
                                     plane,
                                     {cover->times[0], cover->times[1]},
                                     cover->face,
                                     cover->facing});
}

static bool cut_alone(Cutter *c, uint32_t root) {
  const BoolFace *f = &c->w->faces[root];
  if (!note_points(c, root, false) || !cag_bool_net_start(&c->net, f->v) || !add_points(c) ||
      !add_contacts(c, root) || !cag_bool_net_improve(&c->net))
    return false;
  const Cover all = {{f->times[0], f->times[1]}, root, 1, 0};
  for (uint32_t i = 0; i < c->net.cells.n; i++)
    if (!add_cell(c, i, root, &all)) return false;
  return true;
}

static bool triangulate_together(Cutter *c, uint32_t root, bool alone) {
  if (!find_shared(c) || !list_sides(c, root)) return false;
  find_patches(c, alone);
  return note_points(c, root, true) && start_large(c, &c->w->faces[root]) && add_points(c) &&
         add_edges(c) && add_contacts(c, root) && cag_bool_net_improve(&c->net);
}

// alone: treats each face as a patch.
static bool cut_together(Cutter *c, uint32_t root, bool alone) {
  const BoolFace *rep = &c->w->faces[root];
  bool overlaps = false;
  if (!triangulate_together(c, root, alone)) return false;
  const size_t n = c->net.cells.n;
  if (!cag_bool_list_reserve(&c->covers, n, sizeof(Cover)) ||
      !cag_bool_list_reserve(&c->walls, 3 * n, sizeof(uint32_t)))
    return false;
  Cover *covers = c->covers.items;
  for (size_t i = 0; i < n; i++) covers[i] = (Cover){{0, 0}, BOOL_NONE, 0, 0};
  memset(c->walls.items, 0, 3 * n * sizeof(uint32_t));
  if (!cover_cells(c, rep, &overlaps)) return false;
  if (overlaps && !alone) return cut_together(c, root, true);
  for (uint32_t i = 0; i < n; i++)
    if (covers[i].face != BOOL_NONE && !add_cell(c, i, root, &covers[i])) return false;
  return true;
}

static bool cut_group(Cutter *c, uint32_t root) {
  const BoolFace *f = &c->w->faces[root];
  c->net.plane = f->plane;
  c->net.axis = f->axis;
  if (c->faces.start[root + 1] - c->faces.start[root] > 1) return cut_together(c, root, false);
  if (c->contacts.start[root + 1] > c->contacts.start[root]) return cut_alone(c, root);
  return add_piece(
      c->w, (BoolPiece){{f->v[0], f->v[1], f->v[2]}, root, {f->times[0], f->times[1]}, root, 1});
}

CagStatus cag_bool_cut_faces(BoolWork *w) {
  Cutter c = {.w = w, .net = {.points = &w->points}};
  c.patch = cag_malloc((w->face_count + 1) * sizeof *c.patch);
  bool done = c.patch && sort_groups(w, w->face_count, false, &c.faces) &&
              sort_groups(w, w->contacts.n, true, &c.contacts) &&
              cag_bool_list_reserve(&w->pieces, w->face_count + 1, sizeof(BoolPiece));
  CagStatus status = done ? CAG_OK : cag_fail_memory(w->err);
  size_t groups = 0;
  for (uint32_t f = 0; !status && f < w->face_count; f++) {
    if (c.faces.start[f + 1] == c.faces.start[f]) continue; // another face represents its group
    if (groups++ % STOP_INTERVAL == 0) status = cag_bool_stopped(w);
    if (status || cut_group(&c, f)) continue;
    status = cag_bool_stopped(w);
    if (!status) status = cag_fail_memory(w->err);
  }
  cag_bool_net_free(&c.net);
  cag_free(c.faces.start);
  cag_free(c.faces.items);
  cag_free(c.contacts.start);
  cag_free(c.contacts.items);
  cag_free(c.points.items);
  cag_free(c.covers.items);
  cag_free(c.stack.items);
  cag_free(c.sides.items);
  cag_free(c.walls.items);
  cag_free(c.patch);
  cag_free(c.shared);
  return status;
}
