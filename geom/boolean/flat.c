// Merges the triangles of flat faces.
//
// A flat face is a set of triangles that are connected by manifold edges, lie in one plane, and
// take their normals from one field (constant on flat faces, linear on the facets of a ruled face),
// whatever cuts run through it. Only its outline matters: points inside it are removed, and so are
// points at which the outline between the same two faces is straight. The rest is retriangulated. A
// point is removed from both faces or from none, so their edges still match; the solid changes only
// by the rounding that its points had before. Curved faces are not changed.
//
// Coordinates are used as rounded, identically on both sides of an edge. If rounding spoiled an
// outline (it crosses itself, or its area differs from that of the triangles), its face is left as
// it is.

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geom/boolean/net.h"
#include "geom/linalg/tolerance.h"
#include "geom/mesh/edges.h"

// Maximum deviation of points from a plane or line, relative to the largest coordinate: some
// thousand rounding errors, since operands may have been transformed before, and the plane comes
// from a single triangle.
#define FLATNESS CAG_ROUNDING
#define SAME_DIRECTION (1 - 1e-6) // cosine of 0.08 degrees, as in cag_mesh_weld
#define SAME_AREA CAG_COINCIDENT
// If rounding spoiled faces, they are excluded and the rest is retried up to this often.
#define ROUNDS 4
#define STOP_INTERVAL 64

// The edges between two flat faces that end at a point.
typedef struct Corner {
  uint32_t next[2];
  uint8_t count; // number of edges; 3: more than two
  bool kept;     // it must be kept
  bool seen;
} Corner;

typedef struct Field {
  CagVec3 at, normal; // point and normal of the plane
  CagVec3 v[3], n[3]; // corners and normals there
  bool constant;
} Field;

typedef struct Flat {
  BoolWork *w;
  const BoolSource *sources;
  BoolPart *parts;
  size_t n;
  bool normals, whole; // whole: no points are removed
  double slack;
  uint32_t *across; // across the edge from corner k of part i, at 3 i + k: the other part, or none
  uint32_t *label;  // flat face of each part
  size_t labels;
  uint32_t *start, *members; // parts by label
  uint32_t *seed;            // for each label: the part whose face determines the plane
  bool *frozen;              // labels that are not changed
  Corner *corners;           // of points
  bool *gone;                // points that are removed
  uint32_t *after;           // for removed points: the next point of the outline
  uint32_t *number;          // for each point: its index in `local`
  BoolPoints local;
  BoolNet net;
  BoolList places;   // of Place: of `local`
  BoolList segments; // of Segment
  BoolList inside;   // of signed char: cells
  BoolList stack;    // of uint32_t
  BoolList out;      // of BoolPart
} Flat;

typedef struct Place {
  uint32_t point, source;
} Place;
typedef struct Segment {
  uint32_t a, b; // of `local`
} Segment;

static CagVec3 area_of(CagVec3 a, CagVec3 b, CagVec3 c) {
  return cag_cross(cag_sub(b, a), cag_sub(c, a));
}

// --- Neighbors ---

static bool find_neighbors(Flat *f) {
  uint32_t *triangles = cag_malloc((3 * f->n + 1) * sizeof *triangles);
  f->across = cag_malloc((3 * f->n + 1) * sizeof *f->across);
  size_t n = 0;
  if (!triangles || !f->across) {
    cag_free(triangles);
    return false;
  }
  for (size_t i = 0; i < f->n; i++) memcpy(triangles + 3 * i, f->parts[i].v, sizeof f->parts[i].v);
  memset(f->across, 0xff, 3 * f->n * sizeof *f->across);
  CagMeshEdge *e = cag_mesh_edges(triangles, f->n, NULL, f->w->points.n, &n);
  for (size_t i = 0, uses; e && i < n; i += uses) {
    for (uses = 1; i + uses < n && e[i + uses].low == e[i].low && e[i + uses].high == e[i].high;)
      uses++;
    if (uses != 2 || cag_mesh_edge_forward(&e[i]) == cag_mesh_edge_forward(&e[i + 1])) continue;
    for (int k = 0; k < 2; k++) {
      const CagMeshEdge *one = &e[i + (size_t)k], *two = &e[i + 1 - (size_t)k];
      f->across[3 * cag_mesh_edge_triangle(one) + cag_mesh_edge_corner(one)] =
          (uint32_t)cag_mesh_edge_triangle(two);
    }
  }
  cag_free(triangles);
  cag_free(e);
  return e != NULL;
}

// --- Grouping triangles into flat faces ---

static Field field_of(const Flat *f, const BoolSource *s) {
  const BoolFace *face = &f->w->faces[s->face];
  const CagMesh *m = f->w->meshes[face->owner];
  const double sense = s->back ? -1 : 1;
  Field out;
  for (int k = 0; k < 3; k++) out.v[k] = m->positions[m->triangles[3 * (size_t)face->triangle + k]];
  out.at = out.v[0];
  out.normal = cag_scaled(cag_unit(area_of(out.v[0], out.v[1], out.v[2])), sense);
  for (int k = 0; k < 3; k++)
    out.n[k] = m->normals
                   ? cag_scaled(m->normals[m->triangles[3 * (size_t)face->triangle + k]], sense)
                   : out.normal;
  out.constant = cag_dot(out.n[0], out.n[1]) >= SAME_DIRECTION &&
                 cag_dot(out.n[0], out.n[2]) >= SAME_DIRECTION;
  return out;
}

// The field, extended linearly beyond its triangle.
static CagVec3 normal_of(const Field *s, CagVec3 p) {
  if (s->constant) return s->n[0];
  const CagVec3 whole = area_of(s->v[0], s->v[1], s->v[2]);
  CagVec3 sum = {0, 0, 0};
  for (int k = 0; k < 3; k++) {
    const CagVec3 part = area_of(p, s->v[(k + 1) % 3], s->v[(k + 2) % 3]);
    sum = cag_madd(sum, cag_dot(part, whole), s->n[k]);
  }
  return cag_norm(sum) > 0 ? cag_unit(sum) : s->n[0];
}

static bool goes_with(const Flat *f, const Field *seed, const Field *other) {
  if (!(cag_dot(seed->normal, other->normal) > 0)) return false;
  for (int k = 0; k < 3; k++) {
    if (!(fabs(cag_dot(seed->normal, cag_sub(other->v[k], seed->at))) <= f->slack)) return false;
    if (f->normals && !(cag_dot(normal_of(seed, other->v[k]), other->n[k]) >= SAME_DIRECTION))
      return false;
  }
  return true;
}

static uint32_t material_of(const Flat *f, const BoolSource *s) {
  const BoolFace *face = &f->w->faces[s->face];
  const CagMesh *m = f->w->meshes[face->owner];
  return m->labels ? m->labels[face->triangle] : 0;
}

static const BoolSource *source_of(const Flat *f, uint32_t part) {
  return &f->sources[f->parts[part].source[0]];
}

// Collects the parts connected to the seed by edges that belong to its face.
static bool grow(Flat *f, uint32_t seed, uint32_t label) {
  const BoolSource *first = source_of(f, seed), *tried = first;
  const Field field = field_of(f, first);
  bool fits = true;
  f->label[seed] = label;
  f->stack.n = 0;
  for (uint32_t at = seed;; at = ((uint32_t *)f->stack.items)[--f->stack.n]) {
    for (int k = 0; k < 3; k++) {
      const uint32_t next = f->across[3 * (size_t)at + (size_t)k];
      if (next == BOOL_NONE || f->label[next] != BOOL_NONE) continue;
      const BoolSource *s = source_of(f, next);
      if (s->face != tried->face || s->back != tried->back) {
        const Field other = field_of(f, s);
        fits = (s->face == first->face && s->back == first->back) ||
               (material_of(f, s) == material_of(f, first) && goes_with(f, &field, &other));
        tried = s;
      }
      if (!fits) continue;
      f->label[next] = label;
      if (!cag_bool_list_reserve(&f->stack, f->stack.n + 1, sizeof(uint32_t))) return false;
      ((uint32_t *)f->stack.items)[f->stack.n++] = next;
    }
    if (f->stack.n == 0) return true;
  }
}

typedef struct Ranked {
  double size;
  uint32_t part;
} Ranked;

static int by_size(const void *a, const void *b) {
  const Ranked *p = a, *q = b;
  if (p->size != q->size) return p->size > q->size ? -1 : 1;
  return p->part < q->part ? -1 : p->part > q->part;
}

// Sorts by size: the largest triangle of a face determines its plane best.
static bool rank_parts(const Flat *f, Ranked **out) {
  Ranked *r = cag_malloc((f->n + 1) * sizeof *r);
  if (!r) return false;
  for (uint32_t i = 0; i < f->n; i++) {
    const BoolFace *face = &f->w->faces[source_of(f, i)->face];
    const CagVec3 *at = f->w->points.at;
    r[i] = (Ranked){cag_norm(area_of(at[face->v[0]], at[face->v[1]], at[face->v[2]])), i};
  }
  qsort(r, f->n, sizeof *r, by_size);
  *out = r;
  return true;
}

static bool sort_by_label(Flat *f) {
  f->start = cag_calloc(f->labels + 3, sizeof *f->start);
  f->members = cag_malloc((f->n + 1) * sizeof *f->members);
  f->frozen = cag_calloc(f->labels + 1, sizeof *f->frozen);
  if (!f->start || !f->members || !f->frozen) return false;
  for (size_t i = 0; i < f->n; i++) f->start[f->label[i] + 2]++;
  for (size_t l = 3; l < f->labels + 3; l++) f->start[l] += f->start[l - 1];
  for (uint32_t i = 0; i < f->n; i++) f->members[f->start[f->label[i] + 1]++] = i;
  return true;
}

// Triangles of curved faces are not merged; neither are most triangles of meshes without normals,
// where a few cuts are not worth the time.
static bool stands_alone(const Flat *f, uint32_t label) {
  const size_t few = 8, n = f->start[label + 1] - f->start[label];
  const BoolSource *first = source_of(f, f->members[f->start[label]]);
  for (size_t i = f->start[label]; i < f->start[label + 1]; i++)
    if (source_of(f, f->members[i])->face != first->face) return false;
  return (!f->normals && n < few) || !field_of(f, first).constant;
}

static bool find_labels(Flat *f) {
  Ranked *ranked = NULL;
  f->label = cag_malloc((f->n + 1) * sizeof *f->label);
  f->seed = cag_malloc((f->n + 1) * sizeof *f->seed);
  if (!f->label || !f->seed || !rank_parts(f, &ranked)) return false;
  memset(f->label, 0xff, f->n * sizeof *f->label);
  bool done = true;
  for (size_t i = 0; done && i < f->n; i++) {
    if (f->label[ranked[i].part] != BOOL_NONE) continue;
    f->seed[f->labels] = ranked[i].part;
    done = grow(f, ranked[i].part, (uint32_t)f->labels++);
  }
  cag_free(ranked);
  if (!done || !sort_by_label(f)) return false;
  for (uint32_t l = 0; l < f->labels && !f->whole; l++) f->frozen[l] = stands_alone(f, l);
  return true;
}

// --- Removing points ---

static bool is_border(const Flat *f, uint32_t part, int k) {
  const uint32_t other = f->across[3 * (size_t)part + (size_t)k];
  return other == BOOL_NONE || f->label[other] != f->label[part];
}

static void note_edge(Flat *f, uint32_t from, uint32_t to) {
  Corner *c = &f->corners[from];
  if (c->count < 2) c->next[c->count] = to;
  if (c->count < 3) c->count++;
}

static void find_corners(Flat *f) {
  memset(f->corners, 0, f->w->points.n * sizeof *f->corners);
  for (uint32_t i = 0; i < f->n; i++)
    for (int k = 0; k < 3; k++) {
      const uint32_t a = f->parts[i].v[k], b = f->parts[i].v[(k + 1) % 3];
      const uint32_t other = f->across[3 * (size_t)i + (size_t)k];
      if (other == BOOL_NONE) f->corners[a].kept = f->corners[b].kept = true;
      if (f->frozen[f->label[i]]) f->corners[a].kept = true;
      if (other == BOOL_NONE || other < i || !is_border(f, i, k)) continue;
      note_edge(f, a, b);
      note_edge(f, b, a);
    }
}

static double distance_from(CagVec3 p, CagVec3 a, CagVec3 b) {
  const CagVec3 d = cag_sub(b, a);
  const double length = cag_norm(d);
  return length > 0 ? cag_norm(cag_cross(d, cag_sub(p, a))) / length : INFINITY;
}

static bool runs_straight(const Flat *f, uint32_t i) {
  const Corner *c = &f->corners[i];
  const CagVec3 *at = f->w->points.at;
  if (c->count != 2 || c->next[0] == c->next[1]) return false;
  const CagVec3 p = at[i], a = at[c->next[0]], b = at[c->next[1]];
  return cag_dot(cag_sub(p, a), cag_sub(b, p)) > 0 && distance_from(p, a, b) <= f->slack;
}

// Collects the points to remove from `from` on; returns where they end.
static uint32_t follow(Flat *f, uint32_t from, uint32_t at) {
  while (f->gone[at] && f->corners[at].count == 2 && !f->corners[at].seen) {
    Corner *c = &f->corners[at];
    const uint32_t next = c->next[0] == from ? c->next[1] : c->next[0];
    c->seen = true;
    ((uint32_t *)f->stack.items)[f->stack.n++] = at;
    from = at;
    at = next;
  }
  return at;
}

// Keeps a chain of points that is bent as a whole, or that returns to its start.
static void check_way(Flat *f, uint32_t i) {
  const CagVec3 *at = f->w->points.at;
  Corner *c = &f->corners[i];
  f->stack.n = 0;
  c->seen = true;
  ((uint32_t *)f->stack.items)[f->stack.n++] = i;
  const uint32_t a = follow(f, i, c->next[0]), b = follow(f, i, c->next[1]);
  const uint32_t *way = f->stack.items;
  bool straight = a != b && !f->gone[a] && !f->gone[b];
  for (size_t k = 0; straight && k < f->stack.n; k++)
    straight = distance_from(at[way[k]], at[a], at[b]) <= f->slack;
  for (size_t k = 0; !straight && k < f->stack.n; k++) f->gone[way[k]] = false;
}

// For points in use; those without a border edge are inside a face.
static bool find_gone(Flat *f) {
  const size_t points = f->w->points.n;
  memset(f->gone, 0, points * sizeof *f->gone);
  if (f->whole) return true;
  find_corners(f);
  for (uint32_t i = 0; i < points; i++) {
    const Corner *c = &f->corners[i];
    f->gone[i] = !c->kept && (c->count == 0 || runs_straight(f, i));
  }
  if (!cag_bool_list_reserve(&f->stack, points + 1, sizeof(uint32_t))) return false;
  for (uint32_t i = 0; i < points; i++)
    if (f->gone[i] && f->corners[i].count == 2 && !f->corners[i].seen) check_way(f, i);
  return true;
}

// --- Retriangulating a face ---

static uint32_t local_number(Flat *f, uint32_t point, uint32_t source) {
  if (f->number[point] != BOOL_NONE) return f->number[point];
  if (!cag_bool_list_reserve(&f->places, f->places.n + 1, sizeof(Place))) return BOOL_NONE;
  const uint32_t n = cag_bool_points_add_far(&f->local, f->w->points.at[point]);
  if (n == BOOL_NONE) return n;
  ((Place *)f->places.items)[f->places.n++] = (Place){point, source};
  return f->number[point] = n;
}

// The outline without the removed points. Each of these has one border edge that starts there.
static bool list_segments(Flat *f, uint32_t label) {
  f->segments.n = 0;
  for (int pass = 0; pass < 2; pass++)
    for (uint32_t i = f->start[label]; i < f->start[label + 1]; i++)
      for (int k = 0; k < 3; k++) {
        const uint32_t part = f->members[i];
        const BoolPart *p = &f->parts[part];
        if (!is_border(f, part, k)) continue;
        uint32_t to = p->v[(k + 1) % 3];
        if (pass == 0) f->after[p->v[k]] = to;
        if (pass == 0 || f->gone[p->v[k]]) continue;
        for (size_t steps = 0; f->gone[to] && steps < f->w->points.n; steps++) to = f->after[to];
        const uint32_t a = local_number(f, p->v[k], p->source[k]);
        if (a == BOOL_NONE ||
            !cag_bool_list_reserve(&f->segments, f->segments.n + 1, sizeof(Segment)))
          return false;
        ((Segment *)f->segments.items)[f->segments.n++] = (Segment){a, to};
      }
  return true;
}

static double seen(const BoolPoints *p, uint32_t i, int axis) {
  const CagVec3 v = p->at[i];
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

// Starts the net with a triangle around all points; its corners are the next three points.
static bool start_net(Flat *f, int axis, uint32_t large[3]) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  const int first = (axis + 1) % 3, second = (axis + 2) % 3;
  for (uint32_t i = 0; i < f->places.n; i++)
    for (int k = 0; k < 3; k++) {
      low[k] = fmin(low[k], seen(&f->local, i, k));
      high[k] = fmax(high[k], seen(&f->local, i, k));
    }
  const double size = fmax(high[first] - low[first], high[second] - low[second]);
  for (int k = 0; k < 3; k++) {
    double at[3] = {0, 0, 0};
    at[first] = k == 1 ? high[first] + 5 * size : low[first] - 2 * size;
    at[second] = k == 2 ? high[second] + 5 * size : low[second] - 2 * size;
    large[k] = cag_bool_points_add_far(&f->local, cag_vec3(at[0], at[1], at[2]));
    if (large[k] == BOOL_NONE) return false;
  }
  f->net.points = &f->local;
  f->net.plane = large;
  f->net.axis = axis;
  f->net.simple = true;
  f->net.spoiled = false;
  return cag_bool_net_start(&f->net, large);
}

// Marks the cells inside the outline: an edge of it separates inside from outside. *borders: number
// of such edges.
static bool mark_inside(Flat *f, uint32_t outer, size_t *borders) {
  const size_t n = f->net.cells.n;
  const BoolCell *cells = bool_cells(&f->net);
  if (!cag_bool_list_reserve(&f->inside, n, 1) ||
      !cag_bool_list_reserve(&f->stack, n, sizeof(uint32_t)))
    return false;
  signed char *inside = f->inside.items;
  uint32_t *stack = f->stack.items;
  memset(inside, -1, n);
  stack[0] = f->net.cell_of[outer];
  inside[stack[0]] = 0;
  for (size_t depth = 1; depth > 0;) {
    const BoolCell *c = &cells[stack[--depth]];
    for (int k = 0; k < 3; k++) {
      const uint32_t next = c->neighbor[k];
      if (next == BOOL_NONE || inside[next] >= 0) continue;
      inside[next] = (signed char)(inside[c - cells] ^ (c->fixed[k] != BOOL_NONE));
      stack[depth++] = next;
    }
  }
  *borders = 0;
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) {
      const uint32_t next = cells[i].neighbor[k];
      *borders += inside[i] == 1 && (next == BOOL_NONE || inside[next] == 0);
    }
  return true;
}

// Whether each edge of the outline is an edge of a cell, with the face to its left (sign 1) or
// right. An edge with another point on it is not, since the other face would not have that point.
static bool keeps_outline(const Flat *f, int sign) {
  const signed char *inside = f->inside.items;
  for (size_t i = 0; i < f->segments.n; i++) {
    const Segment *s = (Segment *)f->segments.items + i;
    uint32_t cell;
    int e;
    if (cag_bool_net_step(&f->net, s->a, s->b, &cell, &e) != s->b) return false;
    const uint32_t other = bool_cells(&f->net)[cell].neighbor[e];
    if (other == BOOL_NONE || inside[cell] != (sign > 0) || inside[other] != (sign < 0))
      return false;
  }
  return true;
}

static double seen_area(const BoolPoints *p, const uint32_t v[3], int axis) {
  const CagVec3 n = area_of(p->at[v[0]], p->at[v[1]], p->at[v[2]]);
  return axis == 0 ? n.x : axis == 1 ? n.y : n.z;
}

// Whether the new face has the area of the old one and all its triangles are oriented alike.
static bool keeps_area(const Flat *f, uint32_t label, int axis, int sign) {
  double old = 0, size = 0, made = 0, around = 0;
  for (uint32_t i = f->start[label]; i < f->start[label + 1]; i++) {
    const double area = seen_area(&f->w->points, f->parts[f->members[i]].v, axis);
    old += area;
    size += fabs(area);
  }
  for (size_t i = 0; i < f->net.cells.n; i++)
    if (((signed char *)f->inside.items)[i] == 1)
      made += seen_area(&f->local, bool_cells(&f->net)[i].v, axis);
  for (size_t i = 0; i < f->segments.n; i++) {
    const Segment *s = (Segment *)f->segments.items + i;
    around += cag_norm(cag_sub(f->local.at[s->b], f->local.at[s->a]));
  }
  const double off = SAME_AREA * made + 4 * f->slack * around;
  return fabs(sign * old - made) <= off && fabs(size - made) <= off;
}

static bool give_cells(Flat *f, int sign) {
  const Place *places = f->places.items;
  for (size_t i = 0; i < f->net.cells.n; i++) {
    const BoolCell *c = &bool_cells(&f->net)[i];
    if (((signed char *)f->inside.items)[i] != 1) continue;
    if (!cag_bool_list_reserve(&f->out, f->out.n + 1, sizeof(BoolPart))) return false;
    BoolPart *p = (BoolPart *)f->out.items + f->out.n++;
    for (int k = 0; k < 3; k++) {
      const Place *place = &places[c->v[sign < 0 && k ? 3 - k : k]];
      p->v[k] = place->point;
      p->source[k] = place->source;
    }
    p->origin = 0;
  }
  return true;
}

// *made is false if rounding spoiled the outline.
static bool cut_face(Flat *f, uint32_t label, bool *made) {
  const CagVec3 n = field_of(f, source_of(f, f->seed[label])).normal;
  const double size[3] = {fabs(n.x), fabs(n.y), fabs(n.z)};
  const int axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
  const int sign = (axis == 0 ? n.x : axis == 1 ? n.y : n.z) < 0 ? -1 : 1;
  uint32_t large[3];
  size_t borders = 0;
  *made = false;
  if (f->segments.n < 3) return true;
  if (!start_net(f, axis, large)) return false;
  for (uint32_t i = 0; i < f->places.n; i++)
    if (!cag_bool_net_add_point(&f->net, i)) return f->net.spoiled;
  for (size_t i = 0; i < f->segments.n; i++) {
    const Segment s = ((Segment *)f->segments.items)[i];
    if (!cag_bool_net_add_segment(&f->net, s.a, s.b, (BoolCut){s.a, s.b, BOOL_NONE, axis}))
      return f->net.spoiled; // it crosses itself
  }
  if (!cag_bool_net_improve(&f->net) || !mark_inside(f, large[0], &borders)) return false;
  *made = borders == f->segments.n && keeps_outline(f, sign) && keeps_area(f, label, axis, sign);
  return !*made || give_cells(f, sign);
}

static bool retriangulate(Flat *f, uint32_t label, bool *made) {
  f->local.n = f->places.n = 0;
  const bool done = list_segments(f, label);
  bool closed = true;
  for (size_t i = 0; done && i < f->segments.n; i++) {
    Segment *s = (Segment *)f->segments.items + i;
    s->b = f->number[s->b]; // each end starts another segment
    closed = closed && s->b != BOOL_NONE;
  }
  const Place *places = f->places.items;
  for (size_t i = 0; i < f->places.n; i++) f->number[places[i].point] = BOOL_NONE;
  *made = false;
  return done && (!closed || cut_face(f, label, made));
}

// --- All faces ---

static bool keep_parts(Flat *f, uint32_t label) {
  const size_t n = f->start[label + 1] - f->start[label];
  if (!cag_bool_list_reserve(&f->out, f->out.n + n, sizeof(BoolPart))) return false;
  for (uint32_t i = f->start[label]; i < f->start[label + 1]; i++)
    ((BoolPart *)f->out.items)[f->out.n++] = f->parts[f->members[i]];
  return true;
}

static bool is_fan(const Flat *f, uint32_t label) {
  const size_t n = f->start[label + 1] - f->start[label];
  size_t most = 0;
  for (int pass = 0; pass < 2 && n >= BOOL_FAN; pass++)
    for (uint32_t i = f->start[label]; i < f->start[label + 1]; i++)
      for (int k = 0; k < 3; k++) {
        uint32_t *count = &f->after[f->parts[f->members[i]].v[k]];
        *count = pass == 0 ? 0 : *count + 1;
        if (pass == 1 && *count > most) most = *count;
      }
  return most >= BOOL_FAN;
}

static bool gains(const Flat *f, uint32_t label) {
  if (f->frozen[label]) return false;
  if (f->whole) return is_fan(f, label);
  for (uint32_t i = f->start[label]; i < f->start[label + 1]; i++)
    for (int k = 0; k < 3; k++)
      if (f->gone[f->parts[f->members[i]].v[k]]) return true;
  return false;
}

// *spoiled: some faces were excluded; try again without them.
static bool make_faces(Flat *f, bool *spoiled) {
  *spoiled = false;
  f->out.n = 0;
  for (uint32_t label = 0; label < f->labels; label++) {
    if (label % STOP_INTERVAL == 0 && cag_bool_stopped(f->w)) return false;
    bool made = true;
    if (!gains(f, label)) {
      if (!keep_parts(f, label)) return false;
      continue;
    }
    if (!retriangulate(f, label, &made)) return false;
    if (made) continue;
    f->frozen[label] = *spoiled = true;
    if (f->whole && !keep_parts(f, label)) return false;
  }
  return true;
}

static bool flatten(Flat *f, bool *done) {
  const size_t points = f->w->points.n + 1;
  *done = false;
  f->corners = cag_malloc(points * sizeof *f->corners);
  f->gone = cag_malloc(points * sizeof *f->gone);
  f->after = cag_malloc(points * sizeof *f->after);
  f->number = cag_malloc(points * sizeof *f->number);
  if (!f->corners || !f->gone || !f->after || !f->number) return false;
  memset(f->number, 0xff, points * sizeof *f->number);
  if (!cag_bool_points_start(&f->local, 64) || !find_neighbors(f) || !find_labels(f)) return false;
  bool spoiled = true;
  for (int round = 0; round < ROUNDS && spoiled; round++) {
    if (!find_gone(f) || !make_faces(f, &spoiled)) return false;
    if (f->whole) spoiled = false;
  }
  *done = !spoiled;
  return true;
}

static void free_flat(Flat *f) {
  cag_free(f->across);
  cag_free(f->label);
  cag_free(f->start);
  cag_free(f->members);
  cag_free(f->seed);
  cag_free(f->frozen);
  cag_free(f->corners);
  cag_free(f->gone);
  cag_free(f->after);
  cag_free(f->number);
  cag_bool_points_free(&f->local);
  cag_bool_net_free(&f->net);
  cag_free(f->places.items);
  cag_free(f->segments.items);
  cag_free(f->inside.items);
  cag_free(f->stack.items);
}

static double slack_of(const BoolWork *w) {
  double size = 0;
  for (size_t i = 0; i < w->corners; i++) {
    const CagVec3 p = w->points.at[i];
    size = fmax(size, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
  }
  return FLATNESS * size;
}

bool cag_bool_flatten(BoolWork *w, const BoolSource *sources, bool only_fans, BoolPart **parts,
                      size_t *n) {
  Flat f = {.w = w, .sources = sources, .parts = *parts, .n = *n, .slack = slack_of(w)};
  f.whole = only_fans;
  bool made = false;
  f.normals = w->meshes[0]->normals || w->meshes[1]->normals;
  const bool done = *n == 0 || flatten(&f, &made);
  if (done && made) {
    cag_free(*parts);
    *parts = f.out.items;
    *n = f.out.n;
  } else {
    cag_free(f.out.items);
  }
  free_flat(&f);
  return done;
}
