// Faces of a set operation cut along what they meet.
//
// A face that overlaps no other in its plane is triangulated with its contacts. Faces of one plane
// that overlap are triangulated together, inside a large triangle and with their edges as segments;
// each cell then is a piece of all faces that cover it. So pieces of two faces are either the same
// or apart.

#include <stdlib.h>

#include "geom/mesh/boolean_net.h"

// Groups of faces, or points and segments of one, between looks at the caller's wish to stop.
#define STOP_INTERVAL 64

// The faces and contacts by the group that they belong to: a group's are items[start[root]] to
// items[start[root + 1] - 1].
typedef struct Groups {
  size_t *start;
  uint32_t *items;
} Groups;

// What covers a cell.
typedef struct Cover {
  int32_t times[2];
  uint32_t face; // the first; BOOL_NONE: nothing
  signed char facing;
  uint32_t mark; // the last face that was tried, plus 1
} Cover;

typedef struct Cutter {
  BoolWork *w;
  BoolNet net;
  Groups faces, contacts;
  BoolList points; // of Spot
  BoolList covers; // of Cover
  BoolList stack;  // of uint32_t
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
  g->start = calloc(w->face_count + 2, sizeof *g->start);
  g->items = malloc((n + 1) * sizeof *g->items);
  if (!g->start || !g->items) return false;
  for (int pass = 0; pass < 2; pass++) {
    for (size_t i = 0; i < n; i++) {
      const uint32_t root = bool_root(w->plane_of, contacts ? contact_face(w, i) : (uint32_t)i);
      if (pass == 0) g->start[root + 2]++;
      else g->items[g->start[root + 1]++] = (uint32_t)i;
    }
    for (size_t f = 2; pass == 0 && f < w->face_count + 2; f++) g->start[f] += g->start[f - 1];
  }
  return true;
}

static bool add_piece(BoolWork *w, BoolPiece piece) {
  if (piece.times[0] == 0 && piece.times[1] == 0) return true;
  if (!bool_list_reserve(&w->pieces, w->pieces.n + 1, sizeof piece)) return false;
  bool_pieces(w)[w->pieces.n++] = piece;
  return true;
}

// One group may be large. Steps end with false where the caller wants a stop, as without memory.
static bool goes_on(const Cutter *c, size_t i) {
  return i % STOP_INTERVAL != 0 || bool_stopped(c->w) == CAG_OK;
}

// --- Points, in an order that keeps walks short ---

static bool note_point(Cutter *c, uint32_t point) {
  if (!bool_list_reserve(&c->points, c->points.n + 1, sizeof(Spot))) return false;
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

// Strips of about the square root of all points, up and down by turns.
static bool add_points(Cutter *c) {
  Spot *spots = c->points.items;
  const size_t n = c->points.n;
  qsort(spots, n, sizeof *spots, by_x);
  const size_t strip = (size_t)sqrt((double)n) + 1;
  for (size_t i = 0, k = 0; i < n; i += strip, k++)
    qsort(spots + i, n - i < strip ? n - i : strip, sizeof *spots, k % 2 ? by_y_down : by_y);
  for (size_t i = 0; i < n; i++)
    if (!goes_on(c, i) || !bool_net_add_point(&c->net, spots[i].point)) return false;
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
    corners[k] = bool_points_add_far(&c->w->points, cag_vec3(at[0], at[1], at[2]));
    if (corners[k] == BOOL_NONE) return false;
  }
  return bool_net_start(&c->net, corners);
}

static bool add_contacts(Cutter *c, uint32_t root) {
  for (size_t i = c->contacts.start[root]; i < c->contacts.start[root + 1]; i++) {
    const BoolContact *k = (BoolContact *)c->w->contacts.items + c->contacts.items[i];
    if (!goes_on(c, i)) return false;
    if (k->a != k->b && !bool_net_add_segment(&c->net, k->a, k->b, k->cut)) return false;
  }
  return true;
}

static bool add_edges(Cutter *c, uint32_t root) {
  for (size_t i = c->faces.start[root]; i < c->faces.start[root + 1]; i++) {
    const BoolFace *f = &c->w->faces[c->faces.items[i]];
    if (!goes_on(c, i)) return false;
    for (int k = 0; k < 3; k++) {
      const uint32_t a = f->v[k], b = f->v[(k + 1) % 3];
      if (!bool_net_add_segment(&c->net, a, b, (BoolCut){a, b, BOOL_NONE, c->net.axis}))
        return false;
    }
  }
  return true;
}

static bool note_points(Cutter *c, uint32_t root, bool corners) {
  c->points.n = 0;
  for (size_t i = c->contacts.start[root]; i < c->contacts.start[root + 1]; i++) {
    const BoolContact *k = (BoolContact *)c->w->contacts.items + c->contacts.items[i];
    if (!note_point(c, k->a) || !note_point(c, k->b)) return false;
  }
  for (size_t i = c->faces.start[root]; corners && i < c->faces.start[root + 1]; i++)
    for (int k = 0; k < 3; k++)
      if (!note_point(c, c->w->faces[c->faces.items[i]].v[k])) return false;
  return true;
}

// --- Which faces cover a cell ---

static bool is_covered(Cutter *c, uint32_t cell, const BoolFace *f) {
  for (int k = 0; k < 3; k++)
    if (!bool_is_in_face(c->w, f, bool_cells(&c->net)[cell].v[k])) return false;
  return true;
}

static bool try_cell(Cutter *c, uint32_t cell, uint32_t face, signed char facing) {
  const BoolFace *f = &c->w->faces[face];
  Cover *cover = (Cover *)c->covers.items + cell;
  if (cover->mark == face + 1) return true;
  cover->mark = face + 1;
  if (!is_covered(c, cell, f)) return true;
  for (int k = 0; k < 2; k++) cover->times[k] += facing * f->times[k];
  if (cover->face == BOOL_NONE) cover->face = face, cover->facing = facing;
  if (!bool_list_reserve(&c->stack, c->stack.n + 1, sizeof(uint32_t))) return false;
  ((uint32_t *)c->stack.items)[c->stack.n++] = cell;
  return true;
}

// The next cell around v, counter-clockwise. No corner of a face is on the large triangle's edges:
// the cells go all around.
static uint32_t next_around(const Cutter *c, uint32_t cell, uint32_t v) {
  const BoolCell *at = &bool_cells(&c->net)[cell];
  const int k = at->v[0] == v ? 0 : at->v[1] == v ? 1 : 2;
  return at->neighbour[(k + 1) % 3];
}

// From a covered cell at a corner of the face on to its neighbours. All corners are searched by
// turns: some may have very many cells around them.
static bool cover_cells(Cutter *c, uint32_t face, const BoolFace *rep) {
  const BoolFace *f = &c->w->faces[face];
  const int seen = bool_turn(&c->w->points, f->v[0], f->v[1], f->v[2], rep->axis);
  const signed char facing = (signed char)(seen * rep->sign);
  uint32_t at[3];
  for (int k = 0; k < 3; k++) at[k] = c->net.cell_of[f->v[k]];
  for (int k = 0; c->stack.n == 0; k = (k + 1) % 3) {
    if (!try_cell(c, at[k], face, facing)) return false;
    at[k] = next_around(c, at[k], f->v[k]);
  }
  while (c->stack.n > 0) {
    const BoolCell cell = bool_cells(&c->net)[((uint32_t *)c->stack.items)[--c->stack.n]];
    for (int k = 0; k < 3; k++)
      if (cell.neighbour[k] != BOOL_NONE && !try_cell(c, cell.neighbour[k], face, facing))
        return false;
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
  if (!note_points(c, root, false) || !bool_net_start(&c->net, f->v) || !add_points(c) ||
      !add_contacts(c, root) || !bool_net_improve(&c->net))
    return false;
  const Cover all = {{f->times[0], f->times[1]}, root, 1, 0};
  for (uint32_t i = 0; i < c->net.cells.n; i++)
    if (!add_cell(c, i, root, &all)) return false;
  return true;
}

static bool cut_together(Cutter *c, uint32_t root) {
  const BoolFace *rep = &c->w->faces[root];
  if (!note_points(c, root, true) || !start_large(c, rep) || !add_points(c) ||
      !add_edges(c, root) || !add_contacts(c, root) || !bool_net_improve(&c->net))
    return false;
  const size_t n = c->net.cells.n;
  if (!bool_list_reserve(&c->covers, n, sizeof(Cover))) return false;
  Cover *covers = c->covers.items;
  for (size_t i = 0; i < n; i++) covers[i] = (Cover){{0, 0}, BOOL_NONE, 0, 0};
  for (size_t i = c->faces.start[root]; i < c->faces.start[root + 1]; i++)
    if (!goes_on(c, i) || !cover_cells(c, c->faces.items[i], rep)) return false;
  for (uint32_t i = 0; i < n; i++)
    if (covers[i].face != BOOL_NONE && !add_cell(c, i, root, &covers[i])) return false;
  return true;
}

static bool cut_group(Cutter *c, uint32_t root) {
  const BoolFace *f = &c->w->faces[root];
  c->net.plane = f->v;
  c->net.axis = f->axis;
  if (c->faces.start[root + 1] - c->faces.start[root] > 1) return cut_together(c, root);
  if (c->contacts.start[root + 1] > c->contacts.start[root]) return cut_alone(c, root);
  return add_piece(
      c->w, (BoolPiece){{f->v[0], f->v[1], f->v[2]}, root, {f->times[0], f->times[1]}, root, 1});
}

CagStatus bool_cut_faces(BoolWork *w) {
  Cutter c = {.w = w, .net = {.points = &w->points}};
  bool done = sort_groups(w, w->face_count, false, &c.faces) &&
              sort_groups(w, w->contacts.n, true, &c.contacts) &&
              bool_list_reserve(&w->pieces, w->face_count + 1, sizeof(BoolPiece));
  CagStatus status = done ? CAG_OK : cag_fail_memory(w->err);
  size_t groups = 0;
  for (uint32_t f = 0; !status && f < w->face_count; f++) {
    if (c.faces.start[f + 1] == c.faces.start[f]) continue; // another face speaks for its group
    if (groups++ % STOP_INTERVAL == 0) status = bool_stopped(w);
    if (status || cut_group(&c, f)) continue;
    status = bool_stopped(w);
    if (!status) status = cag_fail_memory(w->err);
  }
  bool_net_free(&c.net);
  free(c.faces.start);
  free(c.faces.items);
  free(c.contacts.start);
  free(c.contacts.items);
  free(c.points.items);
  free(c.covers.items);
  free(c.stack.items);
  return status;
}
