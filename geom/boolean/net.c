// Triangulations of a plane: points are inserted into the cell or edge found by a walk; segments
// flip the edges that they cross (Sloan 1993).

#include <float.h>

#include "geom/boolean/net.h"

#include "base/array.h"
#include "base/memory.h"

static int turn(const BoolNet *n, uint32_t a, uint32_t b, uint32_t c) {
  return cag_bool_turn(n->points, a, b, c, n->axis);
}

static int place_in(const BoolCell *c, uint32_t v) {
  return c->v[0] == v ? 0 : c->v[1] == v ? 1 : 2;
}
static int place_of_neighbor(const BoolCell *c, uint32_t cell) {
  return c->neighbor[0] == cell ? 0 : c->neighbor[1] == cell ? 1 : 2;
}

static void relink(BoolNet *n, uint32_t cell, uint32_t from, uint32_t to) {
  if (cell == BOOL_NONE) return;
  BoolCell *c = &bool_cells(n)[cell];
  c->neighbor[place_of_neighbor(c, from)] = to;
}

static void register_cell(BoolNet *n, uint32_t cell) {
  for (int k = 0; k < 3; k++) n->cell_of[bool_cells(n)[cell].v[k]] = cell;
  n->last = cell;
}

// Makes room for one more point, with its cells and table entries.
static bool reserve(BoolNet *n) {
  if (!cag_bool_list_reserve(&n->cells, n->cells.n + 2, sizeof(BoolCell))) return false;
  if (!cag_bool_list_reserve(&n->vertices, n->vertices.n + 3, sizeof(uint32_t))) return false;
  if (n->points->n <= n->cell_of_room) return true;
  const size_t room = n->points->n + n->points->n / 2;
  if (!CAG_RESIZE(n->cell_of, room)) return false;
  for (size_t i = n->cell_of_room; i < room; i++) n->cell_of[i] = BOOL_NONE;
  n->cell_of_room = room;
  return true;
}

static void note_vertex(BoolNet *n, uint32_t v) {
  ((uint32_t *)n->vertices.items)[n->vertices.n++] = v;
}

bool cag_bool_net_start(BoolNet *n, const uint32_t corners[3]) {
  for (size_t i = 0; i < n->vertices.n; i++)
    n->cell_of[((uint32_t *)n->vertices.items)[i]] = BOOL_NONE;
  n->cells.n = n->cuts.n = n->vertices.n = 0;
  if (!reserve(n)) return false;
  const bool left = turn(n, corners[0], corners[1], corners[2]) > 0;
  bool_cells(n)[0] = (BoolCell){{corners[0], corners[left ? 1 : 2], corners[left ? 2 : 1]},
                                {BOOL_NONE, BOOL_NONE, BOOL_NONE},
                                {BOOL_NONE, BOOL_NONE, BOOL_NONE}};
  n->cells.n = 1;
  for (int k = 0; k < 3; k++) note_vertex(n, corners[k]);
  register_cell(n, 0);
  return true;
}

void cag_bool_net_free(BoolNet *n) {
  cag_free(n->cells.items);
  cag_free(n->cuts.items);
  cag_free(n->vertices.items);
  cag_free(n->crossed.items);
  cag_free(n->doubtful.items);
  cag_free(n->cell_of);
}

// --- Flips ---

// Replaces the edge opposite corner e of a cell by the other diagonal of the two cells.
static void flip(BoolNet *n, uint32_t cell, int e) {
  BoolCell *c = &bool_cells(n)[cell];
  const BoolCell t = *c;
  const uint32_t other = t.neighbor[e];
  BoolCell *o = &bool_cells(n)[other];
  const BoolCell u = *o;
  const int f = place_of_neighbor(&u, cell), e1 = (e + 1) % 3, e2 = (e + 2) % 3;
  const int f1 = (f + 1) % 3, f2 = (f + 2) % 3;
  const uint32_t p = t.v[e], a = t.v[e1], b = t.v[e2], d = u.v[f];
  *c = (BoolCell){
      {p, a, d}, {u.neighbor[f1], other, t.neighbor[e2]}, {u.fixed[f1], BOOL_NONE, t.fixed[e2]}};
  *o = (BoolCell){
      {p, d, b}, {u.neighbor[f2], t.neighbor[e1], cell}, {u.fixed[f2], t.fixed[e1], BOOL_NONE}};
  relink(n, u.neighbor[f1], other, cell);
  relink(n, t.neighbor[e1], cell, other);
  register_cell(n, other);
  register_cell(n, cell);
}

// Whether d is certainly inside the circle through a, b, c, for rounded points. If rounding might
// decide, the answer is no; therefore each flip lowers the lifted surface, and flips terminate.
static bool in_circle(const BoolNet *n, const uint32_t v[3], uint32_t d) {
  double x[3], y[3], lift[3], value = 0, size = 0;
  for (int k = 0; k < 3; k++) {
    const CagVec3 s = cag_sub(n->points->at[v[k]], n->points->at[d]);
    x[k] = n->axis == 0 ? s.y : n->axis == 1 ? s.z : s.x;
    y[k] = n->axis == 0 ? s.z : n->axis == 1 ? s.x : s.y;
    lift[k] = x[k] * x[k] + y[k] * y[k];
  }
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double one = x[i] * y[j], two = x[j] * y[i];
    value += lift[k] * (one - two);
    size += lift[k] * (fabs(one) + fabs(two));
  }
  return value > 16 * DBL_EPSILON * size;
}

static bool is_convex(const BoolNet *n, uint32_t p, uint32_t a, uint32_t d, uint32_t b) {
  return turn(n, p, a, d) > 0 && turn(n, p, d, b) > 0;
}

static bool should_flip(const BoolNet *n, uint32_t cell, int e) {
  const BoolCell *c = &bool_cells(n)[cell];
  if (c->neighbor[e] == BOOL_NONE || c->fixed[e] != BOOL_NONE) return false;
  const BoolCell *o = &bool_cells(n)[c->neighbor[e]];
  const uint32_t d = o->v[place_of_neighbor(o, cell)];
  return in_circle(n, c->v, d) && is_convex(n, c->v[e], c->v[(e + 1) % 3], d, c->v[(e + 2) % 3]);
}

static bool doubt(BoolNet *n, uint32_t cell, int e) {
  if (!cag_bool_list_reserve(&n->doubtful, n->doubtful.n + 1, sizeof(BoolEdge))) return false;
  const BoolCell *c = &bool_cells(n)[cell];
  ((BoolEdge *)n->doubtful.items)[n->doubtful.n++] =
      (BoolEdge){c->v[(e + 1) % 3], c->v[(e + 2) % 3], cell};
  return true;
}

// The cell with the directed edge from a to b, and the opposite corner; false: there is none. Tries
// edge.cell first, since some points have very many cells around them.
static bool find_edge(const BoolNet *n, BoolEdge edge, uint32_t *cell, int *corner) {
  const uint32_t a = edge.a, b = edge.b, start = n->cell_of[a];
  const BoolCell *had = &bool_cells(n)[edge.cell];
  for (int k = 0; k < 3; k++)
    if (had->v[k] == a && had->v[(k + 1) % 3] == b) {
      *cell = edge.cell;
      *corner = (k + 2) % 3;
      return true;
    }
  for (int step = 1; step <= 2; step++) { // counter-clockwise, then from a border the other way
    uint32_t at = start;
    do {
      const BoolCell *c = &bool_cells(n)[at];
      const int k = place_in(c, a);
      *cell = at;
      *corner = (k + 2) % 3;
      if (c->v[(k + 1) % 3] == b) return true;
      at = c->neighbor[(k + step) % 3];
    } while (at != BOOL_NONE && at != start);
    if (at == start) break;
  }
  return false;
}

static bool settle_doubts(BoolNet *n) {
  while (n->doubtful.n > 0) {
    const BoolEdge edge = ((BoolEdge *)n->doubtful.items)[--n->doubtful.n];
    uint32_t cell;
    int e;
    if (!find_edge(n, edge, &cell, &e) || !should_flip(n, cell, e)) continue;
    const uint32_t other = bool_cells(n)[cell].neighbor[e];
    flip(n, cell, e);
    // After a flip the corners that gained the diagonal are first and last, and first and middle.
    if (!doubt(n, cell, 0) || !doubt(n, cell, 2) || !doubt(n, other, 0) || !doubt(n, other, 1))
      return false;
  }
  return true;
}

bool cag_bool_net_improve(BoolNet *n) {
  for (uint32_t cell = 0; cell < n->cells.n; cell++)
    for (int e = 0; e < 3; e++) {
      const uint32_t other = bool_cells(n)[cell].neighbor[e];
      if (other != BOOL_NONE && other < cell && !doubt(n, cell, e)) return false;
    }
  return settle_doubts(n);
}

// --- Points ---

static uint32_t next_random(BoolNet *n) {
  n->random = n->random * 1664525u + 1013904223u; // Numerical Recipes' generator
  return n->random >> 16;
}

// Walks to the cell that contains the point. *edge: the corner opposite the edge that it is on; -1:
// it is inside. A random first edge prevents cycles.
static uint32_t locate(BoolNet *n, uint32_t point, int *edge) {
  uint32_t at = n->last, from = BOOL_NONE;
  for (;;) {
    const BoolCell *c = &bool_cells(n)[at];
    const int first = (int)(next_random(n) % 3);
    uint32_t next = BOOL_NONE;
    *edge = -1;
    for (int i = 0; i < 3 && next == BOOL_NONE; i++) {
      const int e = (first + i) % 3;
      if (from != BOOL_NONE && c->neighbor[e] == from) continue;
      const int side = turn(n, c->v[(e + 1) % 3], c->v[(e + 2) % 3], point);
      if (side < 0) next = c->neighbor[e];
      if (side == 0) *edge = e;
    }
    if (next == BOOL_NONE) return at;
    from = at;
    at = next;
  }
}

static void split_cell(BoolNet *n, uint32_t cell, uint32_t p) {
  const BoolCell t = bool_cells(n)[cell];
  const uint32_t second = (uint32_t)n->cells.n, third = second + 1;
  const uint32_t a = t.v[0], b = t.v[1], c = t.v[2];
  n->cells.n += 2;
  bool_cells(n)[cell] =
      (BoolCell){{a, b, p}, {second, third, t.neighbor[2]}, {BOOL_NONE, BOOL_NONE, t.fixed[2]}};
  bool_cells(n)[second] =
      (BoolCell){{b, c, p}, {third, cell, t.neighbor[0]}, {BOOL_NONE, BOOL_NONE, t.fixed[0]}};
  bool_cells(n)[third] =
      (BoolCell){{c, a, p}, {cell, second, t.neighbor[1]}, {BOOL_NONE, BOOL_NONE, t.fixed[1]}};
  relink(n, t.neighbor[0], cell, second);
  relink(n, t.neighbor[1], cell, third);
  register_cell(n, third);
  register_cell(n, second);
  register_cell(n, cell);
}

// Splits a cell at an edge by p: its apex, the edge's start, p, and the remaining edges of the
// cell; the other half gets the edge's end.
static void split_edge(BoolNet *n, uint32_t cell, int e, uint32_t p) {
  const BoolCell t = bool_cells(n)[cell];
  const uint32_t other = t.neighbor[e], fixed = t.fixed[e];
  const int e1 = (e + 1) % 3, e2 = (e + 2) % 3;
  const uint32_t c = t.v[e], a = t.v[e1], b = t.v[e2];
  const uint32_t second = (uint32_t)n->cells.n, fourth = second + 1;
  const bool two = other != BOOL_NONE;
  n->cells.n += two ? 2 : 1;
  bool_cells(n)[cell] =
      (BoolCell){{c, a, p}, {other, second, t.neighbor[e2]}, {fixed, BOOL_NONE, t.fixed[e2]}};
  bool_cells(n)[second] = (BoolCell){
      {c, p, b}, {two ? fourth : BOOL_NONE, t.neighbor[e1], cell}, {fixed, t.fixed[e1], BOOL_NONE}};
  relink(n, t.neighbor[e1], cell, second);
  register_cell(n, second);
  register_cell(n, cell);
  if (!two) return;
  const BoolCell u = bool_cells(n)[other];
  const int f = place_of_neighbor(&u, cell), f1 = (f + 1) % 3, f2 = (f + 2) % 3;
  const uint32_t d = u.v[f];
  bool_cells(n)[other] =
      (BoolCell){{d, p, a}, {cell, u.neighbor[f1], fourth}, {fixed, u.fixed[f1], BOOL_NONE}};
  bool_cells(n)[fourth] =
      (BoolCell){{d, b, p}, {second, other, u.neighbor[f2]}, {fixed, BOOL_NONE, u.fixed[f2]}};
  relink(n, u.neighbor[f2], other, fourth);
  register_cell(n, fourth);
  register_cell(n, other);
}

// Queues the edges opposite a new point for flips.
static bool doubt_around(BoolNet *n, uint32_t p) {
  const uint32_t start = n->cell_of[p];
  for (int step = 1; step <= 2; step++) {
    uint32_t at = start;
    do {
      const BoolCell *c = &bool_cells(n)[at];
      const int k = place_in(c, p);
      if (!doubt(n, at, k)) return false;
      at = bool_cells(n)[at].neighbor[(k + step) % 3];
    } while (at != BOOL_NONE && at != start);
    if (at == start) break;
  }
  return true;
}

static bool stands_on_corner(const BoolNet *n, uint32_t cell, uint32_t point) {
  const int first = (n->axis + 1) % 3, second = (n->axis + 2) % 3;
  for (int k = 0; k < 3; k++) {
    const uint32_t v = bool_cells(n)[cell].v[k];
    if (cag_bool_compare(n->points, v, point, first) == 0 &&
        cag_bool_compare(n->points, v, point, second) == 0)
      return true;
  }
  return false;
}

bool cag_bool_net_add_point(BoolNet *n, uint32_t point) {
  if (!reserve(n)) return false;
  if (n->cell_of[point] != BOOL_NONE) return true;
  int edge;
  const uint32_t cell = locate(n, point, &edge);
  if (n->simple && edge >= 0 && stands_on_corner(n, cell, point)) {
    n->spoiled = true;
    return false;
  }
  note_vertex(n, point);
  if (edge < 0) split_cell(n, cell, point);
  else split_edge(n, cell, edge, point);
  return doubt_around(n, point) && settle_doubts(n);
}

// --- Segments ---

// Where the ray from `from` to `to` leaves the cells around `from`: along an edge to `target`, or
// (target BOOL_NONE) across the edge opposite corner `corner` of `cell`.
typedef struct Exit {
  uint32_t target, cell;
  int corner;
} Exit;

// Two coordinates decide: the third is unreliable for a far corner.
static int order_in_plane(const BoolNet *n, uint32_t a, uint32_t b) {
  const int order = cag_bool_compare(n->points, a, b, (n->axis + 1) % 3);
  return order ? order : cag_bool_compare(n->points, a, b, (n->axis + 2) % 3);
}

static bool is_ahead(const BoolNet *n, uint32_t from, uint32_t to, uint32_t v, int side) {
  return v == to || (side == 0 && order_in_plane(n, from, to) == order_in_plane(n, from, v));
}

static Exit find_exit(const BoolNet *n, uint32_t from, uint32_t to) {
  const uint32_t start = n->cell_of[from];
  for (int step = 1; step <= 2; step++) {
    uint32_t at = start;
    do {
      const BoolCell *c = &bool_cells(n)[at];
      const int k = place_in(c, from);
      const uint32_t x = c->v[(k + 1) % 3], y = c->v[(k + 2) % 3];
      const int right = x == to ? 0 : turn(n, from, to, x);
      if (is_ahead(n, from, to, x, right)) return (Exit){x, at, k};
      const int left = y == to ? 0 : turn(n, from, to, y);
      if (is_ahead(n, from, to, y, left)) return (Exit){y, at, k};
      if (right < 0 && left > 0) return (Exit){BOOL_NONE, at, k};
      at = c->neighbor[(k + step) % 3];
    } while (at != BOOL_NONE && at != start);
    if (at == start) break;
  }
  return (Exit){to, start, 0}; // not reached: the cells around a point have no gap
}

static void fix_side(BoolNet *n, uint32_t cell, int e, uint32_t cut) {
  uint32_t *fixed = &bool_cells(n)[cell].fixed[e];
  if (*fixed == BOOL_NONE) *fixed = cut;
}

// hint: a cell that may contain the edge.
static void fix_edge(BoolNet *n, uint32_t a, uint32_t b, uint32_t hint, uint32_t cut) {
  uint32_t cell;
  int e;
  const bool ahead = find_edge(n, (BoolEdge){a, b, hint}, &cell, &e);
  if (!ahead && !find_edge(n, (BoolEdge){b, a, hint}, &cell, &e)) return;
  fix_side(n, cell, e, cut);
  const uint32_t other = bool_cells(n)[cell].neighbor[e];
  if (other != BOOL_NONE) fix_side(n, other, place_of_neighbor(&bool_cells(n)[other], cell), cut);
}

static bool push_crossed(BoolNet *n, BoolEdge edge) {
  if (!cag_bool_list_reserve(&n->crossed, n->crossed.n + 1, sizeof edge)) return false;
  ((BoolEdge *)n->crossed.items)[n->crossed.n++] = edge;
  return true;
}

// Inserts the intersection of a segment with a fixed edge.
static bool split_fixed(BoolNet *n, uint32_t cell, int e, uint32_t cut) {
  if (n->simple) {
    n->spoiled = true;
    return false;
  }
  const BoolCut *cuts = n->cuts.items;
  const uint32_t fixed = bool_cells(n)[cell].fixed[e];
  const uint32_t p = cag_bool_points_meet(n->points, n->plane, cuts[cut], cuts[fixed]);
  if (p == BOOL_NONE || !reserve(n)) return false;
  note_vertex(n, p);
  split_edge(n, cell, e, p);
  return doubt_around(n, p) && settle_doubts(n);
}

// Lists the edges that the segment crosses, up to a point on it: *target. If it meets a fixed edge,
// that edge is split instead, and *target is BOOL_NONE.
static bool list_crossed(BoolNet *n, uint32_t from, uint32_t to, Exit exit, uint32_t cut,
                         uint32_t *target) {
  uint32_t at = exit.cell;
  int e = exit.corner;
  n->crossed.n = 0;
  for (;;) {
    const BoolCell *c = &bool_cells(n)[at];
    *target = BOOL_NONE;
    if (c->fixed[e] != BOOL_NONE) return split_fixed(n, at, e, cut);
    const BoolEdge edge = {c->v[(e + 1) % 3], c->v[(e + 2) % 3], at}; // from right to left
    if (!push_crossed(n, edge)) return false;
    const uint32_t next = c->neighbor[e];
    const BoolCell *o = &bool_cells(n)[next];
    const int f = place_of_neighbor(o, at); // o: apex, left, right
    const uint32_t apex = o->v[f];
    const int side = apex == to ? 0 : turn(n, from, to, apex);
    *target = apex;
    if (side == 0) return true;
    at = next;
    e = side > 0 ? (f + 1) % 3 : (f + 2) % 3; // continue between right and apex, or apex and left
  }
}

// Flips the listed edges until none crosses the segment.
static bool flip_crossed(BoolNet *n, uint32_t from, uint32_t to) {
  for (size_t i = 0; i < n->crossed.n; i++) {
    const BoolEdge edge = ((BoolEdge *)n->crossed.items)[i];
    uint32_t cell;
    int e;
    if (!find_edge(n, edge, &cell, &e)) continue;
    const BoolCell *c = &bool_cells(n)[cell];
    const uint32_t other = c->neighbor[e];
    const BoolCell *o = &bool_cells(n)[other];
    const uint32_t p = c->v[e], d = o->v[place_of_neighbor(o, cell)];
    if (!is_convex(n, p, edge.a, d, edge.b)) {
      if (!push_crossed(n, edge)) return false;
      continue;
    }
    flip(n, cell, e);
    if (p == from || p == to || d == from || d == to) continue;
    if (turn(n, from, to, p) * turn(n, from, to, d) < 0 &&
        !push_crossed(n, (BoolEdge){p, d, other}))
      return false;
  }
  return true;
}

bool cag_bool_net_add_segment(BoolNet *n, uint32_t a, uint32_t b, BoolCut cut) {
  const uint32_t number = (uint32_t)n->cuts.n;
  if (!cag_bool_list_reserve(&n->cuts, n->cuts.n + 1, sizeof cut)) return false;
  ((BoolCut *)n->cuts.items)[n->cuts.n++] = cut;
  while (a != b) {
    const Exit exit = find_exit(n, a, b);
    uint32_t target = exit.target;
    if (target == BOOL_NONE && !list_crossed(n, a, b, exit, number, &target)) return false;
    if (target == BOOL_NONE) continue; // a fixed edge was split, so there is now a point on the way
    if (exit.target == BOOL_NONE && !flip_crossed(n, a, target)) return false;
    fix_edge(n, a, target, exit.target == BOOL_NONE ? n->last : exit.cell, number);
    a = target;
  }
  return true;
}

uint32_t cag_bool_net_step(const BoolNet *n, uint32_t a, uint32_t b, uint32_t *cell, int *corner) {
  const Exit exit = find_exit(n, a, b);
  if (exit.target == BOOL_NONE) return BOOL_NONE;
  return find_edge(n, (BoolEdge){a, exit.target, exit.cell}, cell, corner) ? exit.target
                                                                           : BOOL_NONE;
}
