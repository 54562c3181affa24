// Meshes that fillets remove or add (see roll_body.h).

#include "geom/solid/roll_body.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/mesh/polygon.h"

// The largest turn between neighboring facets of an arc, in radians, and the largest number of
// them.
#define TURN (M_PI / 12)
#define ARC_MOST 2000
// How much the first and last chord are lengthened, as a fraction of them.
#define LONGER_CHORD 0.5
#define LONGER_BEVEL 0.02
// A contact on an edge is moved across the edge by this fraction of the lift.
#define POINT_LIFT 0.02
// Directions whose angle has a smaller sine are interpolated along their chord.
#define NEARLY_SAME 1e-7

size_t cag_roll_arc(double radius, double angle, double tolerance) {
  const double sag = fmin(tolerance / radius, 1), step = fmin(TURN, 2 * acos(1 - sag));
  return (size_t)fmin(fmax(ceil(angle / step - 1e-9), 2), ARC_MOST);
}

CagVec3 cag_roll_arc_direction(CagVec3 a, CagVec3 b, double t) {
  const double sine = cag_norm(cag_cross(a, b)), angle = atan2(sine, cag_dot(a, b));
  if (sine < NEARLY_SAME) return cag_unit(cag_lerp(a, b, t));
  return cag_unit(cag_madd(cag_scaled(a, sin((1 - t) * angle)), sin(t * angle), b));
}

void cag_roll_ring(const CagRollSection *s, size_t arc, double lift, CagVec3 *out) {
  const CagVec3 from = cag_scaled(s->toward[0], -1), to = cag_scaled(s->toward[1], -1);
  const double longer = s->radius > 0 ? LONGER_CHORD : LONGER_BEVEL;
  for (size_t i = 1; i < arc; i++) {
    const double t = (double)i / (double)arc;
    out[i] = s->radius > 0 ? cag_madd(s->center, s->radius, cag_roll_arc_direction(from, to, t))
                           : cag_lerp(s->contact[0], s->contact[1], t);
  }
  const CagVec3 second = arc > 1 ? out[1] : s->contact[1];
  const CagVec3 last = arc > 1 ? out[arc - 1] : s->contact[0];
  out[0] = cag_madd(s->contact[0], longer, cag_sub(s->contact[0], second));
  out[arc] = cag_madd(s->contact[1], longer, cag_sub(s->contact[1], last));
  for (size_t k = 0; k < 2; k++) {
    const CagVec3 at_contact = s->pointed[k] ? s->into : cag_scaled(s->toward[k], -1);
    const CagVec3 at_edge = s->pointed[k] ? s->into : cag_scaled(s->start[k], -1);
    out[k ? arc + 1 : arc + 4] = cag_madd(s->contact[k], lift, at_contact);
    out[k ? arc + 2 : arc + 3] = cag_madd(s->edge, lift, at_edge);
    if (s->pointed[k]) out[k ? arc : 0] = cag_madd(s->contact[k], POINT_LIFT * lift, s->into);
  }
}

// --- Meshes ---

typedef struct Builder {
  CagVec3 *points;
  uint32_t *triangles;
  size_t points_used, triangles_used;
} Builder;

static void builder_free(Builder *b) {
  cag_free(b->points);
  cag_free(b->triangles);
}

static CagStatus builder_new(size_t points, size_t triangles, Builder *b, CagError *err) {
  *b = (Builder){.points = cag_calloc(points + 1, sizeof *b->points),
                 .triangles = cag_calloc(3 * triangles + 1, sizeof *b->triangles)};
  if (b->points && b->triangles && points < UINT32_MAX / 8) return CAG_OK;
  builder_free(b);
  return cag_fail_memory(err);
}

static void add_triangle(Builder *b, size_t i, size_t j, size_t k) {
  uint32_t *t = b->triangles + 3 * b->triangles_used++;
  t[0] = (uint32_t)i, t[1] = (uint32_t)j, t[2] = (uint32_t)k;
}

static void add_quad(Builder *b, size_t i, size_t j, size_t k, size_t l) {
  add_triangle(b, i, j, k);
  add_triangle(b, i, k, l);
}

// Adds a polygon that has no self-intersections seen along its normal, of n points.
static CagStatus add_polygon(Builder *b, const size_t *corners, size_t n, bool reversed,
                             CagError *err) {
  uint32_t *face = cag_calloc(4 * n, sizeof *face), *found = face + n;
  if (!face) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) face[i] = (uint32_t)corners[i];
  CagStatus status = cag_polygon_triangulate(b->points, face, n, 0, found, err);
  for (size_t i = 0; !status && i < n - 2; i++) {
    const uint32_t *t = found + 3 * i;
    add_triangle(b, t[0], t[reversed ? 2 : 1], t[reversed ? 1 : 2]);
  }
  cag_free(face);
  if (!status || cag_is_final(status)) return status;
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
                  "a section of the rounding crosses itself");
}

CagStatus cag_roll_ring_is_simple(const CagVec3 *ring, size_t size, bool *out, CagError *err) {
  uint32_t *face = cag_calloc(4 * size, sizeof *face);
  if (!face) return cag_fail_memory(err);
  for (size_t i = 0; i < size; i++) face[i] = (uint32_t)i;
  const CagStatus status = cag_polygon_triangulate(ring, face, size, 0, face + size, err);
  cag_free(face);
  *out = !status;
  return cag_is_final(status) ? status : CAG_OK;
}

// The mesh, with its triangles outward; frees the builder.
static CagStatus builder_mesh(Builder *b, CagStatus status, CagMesh **out, CagError *err) {
  CagMesh *m = NULL, *flipped = NULL;
  double terms[10] = {0};
  if (!status)
    status = cag_mesh_new(b->points_used, b->triangles_used, false, false, false, &m, err);
  if (!status) {
    memcpy(m->positions, b->points, b->points_used * sizeof *m->positions);
    memcpy(m->triangles, b->triangles, 3 * b->triangles_used * sizeof *m->triangles);
    cag_mesh_volume_terms(m, terms);
  }
  builder_free(b);
  if (!status && terms[0] < 0) {
    status = cag_mesh_flip(m, &flipped, err);
    cag_mesh_release(m);
    m = flipped;
  }
  if (!status) *out = m;
  return status;
}

static CagStatus add_cap(Builder *b, size_t first, size_t size, bool reversed, CagError *err) {
  size_t *corners = cag_calloc(size, sizeof *corners);
  if (!corners) return cag_fail_memory(err);
  for (size_t i = 0; i < size; i++) corners[i] = first + i;
  CagStatus status = add_polygon(b, corners, size, reversed, err);
  cag_free(corners);
  return status;
}

CagStatus cag_roll_sweep(const CagVec3 *rings, size_t size, size_t n, bool closed, CagMesh **out,
                         CagError *err) {
  Builder b;
  const size_t spans = closed ? n : n - 1;
  CagStatus status = builder_new(size * n, 2 * size * (spans + 1), &b, err);
  if (status) return status;
  memcpy(b.points, rings, size * n * sizeof *rings);
  b.points_used = size * n;
  for (size_t i = 0; !status && i < spans; i++) {
    const size_t low = i * size, high = (i + 1) % n * size;
    status = cag_stop_check(err);
    for (size_t j = 0; j < size; j++) {
      const size_t k = (j + 1) % size;
      add_quad(&b, low + j, low + k, high + k, high + j);
    }
  }
  if (!status && !closed) status = add_cap(&b, 0, size, true, err);
  if (!status && !closed) status = add_cap(&b, (n - 1) * size, size, false, err);
  return builder_mesh(&b, status, out, err);
}

// --- Corners ---

// The points of the patch of the sphere are numbered so: its middle; on the arc from there to
// contact i, side_point; within the sector between the contacts i and i + 1, patch_point. Then, for
// each face, its lifted contact and corner, and for each edge, its lifted points.
static size_t side_point(size_t arc, size_t i, size_t row) {
  return row == 0 ? 0 : 1 + i * arc + row - 1;
}

static size_t patch_point(size_t arc, size_t count, size_t i, size_t row, size_t k) {
  if (k == 0) return side_point(arc, i, row);
  if (k == row) return side_point(arc, (i + 1) % count, row);
  return 1 + count * arc + i * (arc * (arc - 1) / 2) + (row - 1) * (row - 2) / 2 + k - 1;
}

static void add_patch(Builder *b, const CagRollCorner *c, size_t arc) {
  CagVec3 middle = {0, 0, 0};
  for (size_t i = 0; i < c->count; i++) middle = cag_sub(middle, c->toward[i]);
  middle = cag_unit(middle);
  b->points[0] = cag_madd(c->center, c->radius, middle);
  for (size_t i = 0; i < c->count; i++) {
    const CagVec3 from = cag_scaled(c->toward[i], -1);
    const CagVec3 to = cag_scaled(c->toward[(i + 1) % c->count], -1);
    for (size_t row = 1; row <= arc; row++)
      for (size_t k = 0; k < row; k++) {
        const double part = (double)row / (double)arc;
        const CagVec3 d = cag_roll_arc_direction(cag_roll_arc_direction(middle, from, part),
                                                 cag_roll_arc_direction(middle, to, part),
                                                 (double)k / (double)row);
        b->points[patch_point(arc, c->count, i, row, k)] = cag_madd(c->center, c->radius, d);
      }
    b->points[side_point(arc, i, arc)] = c->contact[i];
    for (size_t row = 0; row < arc; row++)
      for (size_t k = 0; k <= row; k++) {
        const size_t here = patch_point(arc, c->count, i, row, k);
        const size_t next = patch_point(arc, c->count, i, row + 1, k + 1);
        add_triangle(b, here, patch_point(arc, c->count, i, row + 1, k), next);
        if (k < row) add_triangle(b, here, next, patch_point(arc, c->count, i, row, k + 1));
      }
  }
  b->points_used = 1 + c->count * arc + c->count * (arc * (arc - 1) / 2);
}

// The four lifted points of face i and of the edge i: contact, corner, and the station on both
// sides.
enum { LIFT_CONTACT, LIFT_CORNER, LIFT_BEFORE, LIFT_AFTER, LIFTS };

static void add_lifted(Builder *b, const CagRollCorner *c, double lift) {
  for (size_t i = 0; i < c->count; i++) {
    CagVec3 *p = b->points + b->points_used + LIFTS * i;
    p[LIFT_CONTACT] = cag_madd(c->contact[i], -lift, c->toward[i]);
    p[LIFT_CORNER] = cag_madd(c->point, -lift, c->at_point[i]);
    p[LIFT_BEFORE] = cag_madd(c->station[i], -lift, c->before[i]);
    p[LIFT_AFTER] = cag_madd(c->station[i], -lift, c->after[i]);
  }
  b->points_used += LIFTS * c->count;
}

// The wall in the section of edge i, from the sphere to the lifted points.
static CagStatus add_wall(Builder *b, const CagRollCorner *c, size_t arc, size_t base, size_t i,
                          size_t *corners, CagError *err) {
  const size_t own = base + LIFTS * i, next = base + LIFTS * ((i + 1) % c->count);
  size_t n = 0;
  for (size_t k = arc + 1; k-- > 0;) corners[n++] = patch_point(arc, c->count, i, arc, k);
  corners[n++] = own + LIFT_CONTACT;
  corners[n++] = own + LIFT_BEFORE;
  corners[n++] = own + LIFT_AFTER;
  corners[n++] = next + LIFT_CONTACT;
  return add_polygon(b, corners, n, false, err);
}

CagStatus cag_roll_corner_body(const CagRollCorner *c, size_t arc, double lift, CagMesh **out,
                               CagError *err) {
  const size_t m = c->count;
  Builder b;
  CagStatus status =
      builder_new(1 + m * (arc + arc * (arc - 1) / 2 + LIFTS), m * (arc * arc + arc + 16), &b, err);
  if (status) return status;
  size_t *corners = cag_calloc(arc + 8, sizeof *corners);
  if (!corners) status = cag_fail_memory(err);
  add_patch(&b, c, arc);
  const size_t base = b.points_used;
  add_lifted(&b, c, lift);
  for (size_t i = 0; !status && i < m; i++) {
    const size_t own = base + LIFTS * i, last = base + LIFTS * ((i + m - 1) % m);
    const size_t next = base + LIFTS * ((i + 1) % m);
    status = add_wall(&b, c, arc, base, i, corners, err);
    // The face, the strip along the edge, and the triangle at the corner.
    add_quad(&b, own + LIFT_CONTACT, last + LIFT_AFTER, own + LIFT_CORNER, own + LIFT_BEFORE);
    add_quad(&b, own + LIFT_AFTER, own + LIFT_BEFORE, own + LIFT_CORNER, next + LIFT_CORNER);
    if (i > 0 && i + 1 < m)
      add_triangle(&b, base + LIFT_CORNER, next + LIFT_CORNER, own + LIFT_CORNER);
  }
  cag_free(corners);
  return builder_mesh(&b, status, out, err);
}
