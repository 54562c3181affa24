// Curves as tubes.
//
// The curve becomes points; the points are cut into runs at sharp corners and, where it is dashed,
// at the ends of dashes. Each run is a tube of its own: rings of SIDES vertices in
// rotation-minimizing frames (double reflection, Wang et al. 2008), with flat caps. A ball stands
// at each sharp corner. A closed smooth curve is one run whose last ring is its first.
//
// Runs and balls are closed each by itself and overlap. No two of them share an edge: their
// vertices would weld, and an edge of four triangles is not the edge of a solid. So at a corner the
// ends of the runs stop short of it by different lengths, and the ball's rings lie askew.

#include <stdlib.h>
#include <string.h>

#include "interp/scene/item_mesh.h"

#define SIDES 12
#define BALL_RINGS 5
// A curve follows its points to this part of the radius.
#define CHORD_PART 0.1
// How far runs end before a sharp corner and begin behind it, as parts of the radius: within the
// ball, and different, so that a run back along the same line has no ring in common.
#define SHORT_AT_END 0.03
#define SHORT_AT_START 0.05
// Cosine of the turn from which a corner gets a ball: 25 degrees.
static const double SHARP_COSINE = 0.9063;
static const double PI = 3.14159265358979323846;

typedef struct Buffer {
  CagVec3 *positions, *normals;
  uint32_t *triangles;
  size_t vertices, vertex_room, count, room;
  size_t max_triangles;
} Buffer;

// Room for so many more; the limit of triangles is checked before memory is taken.
static CagStatus reserve(Buffer *b, size_t vertices, size_t triangles, CagError *err) {
  if (b->count + triangles > b->max_triangles)
    return cag_fail(err, CAG_E_LIMIT, "triangle-limit", "", -1,
                    "the lines need more than the %zu triangles allowed", b->max_triangles);
  while (b->vertices + vertices > b->vertex_room) {
    size_t room = b->vertex_room ? 2 * b->vertex_room : 1024;
    CagVec3 *p = realloc(b->positions, room * sizeof *p);
    if (p) b->positions = p;
    CagVec3 *n = realloc(b->normals, room * sizeof *n);
    if (n) b->normals = n;
    if (!p || !n) return cag_fail_memory(err);
    b->vertex_room = room;
  }
  while (b->count + triangles > b->room) {
    size_t room = b->room ? 2 * b->room : 2048;
    uint32_t *t = realloc(b->triangles, 3 * room * sizeof *t);
    if (!t) return cag_fail_memory(err);
    b->triangles = t;
    b->room = room;
  }
  return CAG_OK;
}

static size_t add_vertex(Buffer *b, CagVec3 p, CagVec3 n) {
  b->positions[b->vertices] = p;
  b->normals[b->vertices] = n;
  return b->vertices++;
}

static void add_triangle(Buffer *b, size_t i, size_t j, size_t k) {
  uint32_t *t = b->triangles + 3 * b->count++;
  t[0] = (uint32_t)i;
  t[1] = (uint32_t)j;
  t[2] = (uint32_t)k;
}

// --- Rings ---

static CagVec3 perpendicular(CagVec3 t) {
  CagVec3 other = fabs(t.z) < 0.9 ? cag_vec3(0, 0, 1) : cag_vec3(1, 0, 0);
  return cag_unit(cag_cross(t, other));
}

// The mean direction of the segments that meet at point i.
static CagVec3 tangent_at(const CagVec3 *p, size_t n, bool closed, size_t i) {
  CagVec3 before = {0, 0, 0}, after = {0, 0, 0};
  if (i > 0) before = cag_unit(cag_sub(p[i], p[i - 1]));
  else if (closed) before = cag_unit(cag_sub(p[0], p[n - 2]));
  if (i + 1 < n) after = cag_unit(cag_sub(p[i + 1], p[i]));
  else if (closed) after = cag_unit(cag_sub(p[1], p[0]));
  CagVec3 t = cag_unit(cag_add(before, after));
  return cag_norm(t) > 0 ? t : after;
}

// The frame vector r at p with tangent t carried to q with tangent u: two reflections.
static CagVec3 carry(CagVec3 p, CagVec3 t, CagVec3 r, CagVec3 q, CagVec3 u) {
  CagVec3 v = cag_sub(q, p);
  double c = cag_dot(v, v);
  if (!(c > 0)) return r;
  CagVec3 rl = cag_madd(r, -2 / c * cag_dot(v, r), v), tl = cag_madd(t, -2 / c * cag_dot(v, t), v);
  CagVec3 w = cag_sub(u, tl);
  double d = cag_dot(w, w);
  return d > 0 ? cag_madd(rl, -2 / d * cag_dot(w, rl), w) : rl;
}

static void add_ring(Buffer *b, CagVec3 p, CagVec3 t, CagVec3 r, double turn, double radius) {
  CagVec3 s = cag_cross(t, r);
  for (int k = 0; k < SIDES; k++) {
    double a = turn + 2 * PI * k / SIDES;
    CagVec3 n = cag_madd(cag_scaled(r, cos(a)), sin(a), s);
    add_vertex(b, cag_madd(p, radius, n), n);
  }
}

static void add_cap(Buffer *b, size_t ring, CagVec3 p, CagVec3 outward, bool at_end) {
  size_t center = add_vertex(b, p, outward), first = b->vertices;
  for (size_t k = 0; k < SIDES; k++) add_vertex(b, b->positions[ring + k], outward);
  for (size_t k = 0; k < SIDES; k++) {
    size_t i = first + k, j = first + (k + 1) % SIDES;
    if (at_end) add_triangle(b, center, i, j);
    else add_triangle(b, center, j, i);
  }
}

static void add_side(Buffer *b, size_t ring, size_t next) {
  for (size_t k = 0; k < SIDES; k++) {
    size_t l = (k + 1) % SIDES;
    add_triangle(b, ring + k, ring + l, next + l);
    add_triangle(b, ring + k, next + l, next + k);
  }
}

// A tube through n points. Of a closed one the last point is the first.
static CagStatus add_run(Buffer *b, const CagVec3 *p, size_t n, bool closed, double radius,
                         CagError *err) {
  if (n < 2) return CAG_OK;
  CagStatus status = reserve(b, (n + 2) * SIDES + 2, 2 * SIDES * (n + 1), err);
  if (status != CAG_OK) return status;
  CagVec3 t = tangent_at(p, n, closed, 0), first = perpendicular(t), r = first;
  // The frame comes back turned: each ring takes its share of the difference.
  double twist = 0;
  for (size_t i = 1; closed && i < n; i++) {
    CagVec3 u = tangent_at(p, n, closed, i);
    r = carry(p[i - 1], t, r, p[i], u);
    t = u;
  }
  if (closed) {
    twist = atan2(cag_dot(cag_cross(r, first), t), cag_dot(r, first));
    r = first;
    t = tangent_at(p, n, closed, 0);
  }
  size_t rings = closed ? n - 1 : n, start = b->vertices;
  CagVec3 begin = t;
  for (size_t i = 0; i < rings; i++) {
    CagVec3 u = tangent_at(p, n, closed, i);
    if (i > 0) r = carry(p[i - 1], t, r, p[i], u);
    t = u;
    add_ring(b, p[i], t, r, twist * (double)i / (double)rings, radius);
  }
  for (size_t i = 0; i + 1 < rings; i++) add_side(b, start + i * SIDES, start + (i + 1) * SIDES);
  if (closed) add_side(b, start + (rings - 1) * SIDES, start);
  else {
    add_cap(b, start, p[0], cag_scaled(begin, -1), false);
    add_cap(b, start + (rings - 1) * SIDES, p[n - 1], t, true);
  }
  return CAG_OK;
}

// A direction turned by no angle that rings of tubes along the axes have: a rotation with the
// columns (9, -20, 12)/25, (12, 15, 16)/25 and (-20, 0, 15)/25.
static CagVec3 askew(CagVec3 n) {
  return cag_vec3((9 * n.x + 12 * n.y - 20 * n.z) / 25, (15 * n.y - 20 * n.x) / 25,
                  (12 * n.x + 16 * n.y + 15 * n.z) / 25);
}

static CagStatus add_ball(Buffer *b, CagVec3 p, double radius, CagError *err) {
  CagStatus status = reserve(b, BALL_RINGS * SIDES + 2, 2 * SIDES * (size_t)(BALL_RINGS + 1), err);
  if (status != CAG_OK) return status;
  size_t start = b->vertices;
  for (int i = 1; i <= BALL_RINGS; i++) {
    double a = PI * i / (BALL_RINGS + 1);
    for (int k = 0; k < SIDES; k++) {
      double c = 2 * PI * k / SIDES;
      CagVec3 n = askew(cag_vec3(sin(a) * cos(c), sin(a) * sin(c), -cos(a)));
      add_vertex(b, cag_madd(p, radius, n), n);
    }
  }
  for (int i = 0; i + 1 < BALL_RINGS; i++)
    add_side(b, start + (size_t)i * SIDES, start + (size_t)(i + 1) * SIDES);
  const CagVec3 up = askew(cag_vec3(0, 0, 1));
  size_t low = add_vertex(b, cag_madd(p, -radius, up), cag_scaled(up, -1));
  size_t high = add_vertex(b, cag_madd(p, radius, up), up);
  size_t top = start + (size_t)(BALL_RINGS - 1) * SIDES;
  for (size_t k = 0; k < SIDES; k++) {
    size_t l = (k + 1) % SIDES;
    add_triangle(b, low, start + l, start + k);
    add_triangle(b, high, top + k, top + l);
  }
  return CAG_OK;
}

// --- Corners and dashes ---

static bool is_sharp(CagVec3 a, CagVec3 b, CagVec3 c) {
  return cag_dot(cag_unit(cag_sub(b, a)), cag_unit(cag_sub(c, b))) < SHARP_COSINE;
}

// The point on the way from a corner to the next point, at most half of it.
static CagVec3 short_of(CagVec3 corner, CagVec3 next, double length) {
  double whole = cag_norm(cag_sub(next, corner));
  return cag_lerp(corner, next, fmin(length / whole, 0.5));
}

// An open run through p[0 .. n) whose ends at sharp corners stop short of them.
static CagStatus add_part(Buffer *b, const CagVec3 *p, size_t n, bool sharp_start, bool sharp_end,
                          double radius, CagError *err) {
  CagVec3 *q = malloc((n + 1) * sizeof *q);
  if (!q) return cag_fail_memory(err);
  memcpy(q, p, n * sizeof *q);
  if (sharp_start) q[0] = short_of(p[0], p[1], SHORT_AT_START * radius);
  if (sharp_end) q[n - 1] = short_of(p[n - 1], p[n - 2], SHORT_AT_END * radius);
  CagStatus status = add_run(b, q, n, false, radius, err);
  free(q);
  return status;
}

// Runs between the sharp corners, and a ball at each.
static CagStatus add_path(Buffer *b, const CagVec3 *p, size_t n, bool closed, double radius,
                          CagError *err) {
  bool sharp_seam = closed && n > 2 && is_sharp(p[n - 2], p[0], p[1]);
  bool any = sharp_seam;
  for (size_t i = 1; i + 1 < n; i++) any = any || is_sharp(p[i - 1], p[i], p[i + 1]);
  if (closed && !any) return add_run(b, p, n, true, radius, err);
  CagStatus status = CAG_OK;
  size_t from = 0;
  for (size_t i = 1; status == CAG_OK && i < n; i++) {
    bool last = i + 1 == n;
    if (!last && !is_sharp(p[i - 1], p[i], p[i + 1])) continue;
    status = add_part(b, p + from, i - from + 1, from > 0 || closed, !last || closed, radius, err);
    if (status == CAG_OK && (!last || closed)) status = add_ball(b, p[i], radius, err);
    from = i;
  }
  return status;
}

// Whole dashes, as many as fit with gaps as long between them; both ends of an open curve are
// drawn.
static CagStatus add_dashes(Buffer *b, const CagVec3 *p, size_t n, bool closed, double dash,
                            double radius, CagError *err) {
  double length = 0;
  for (size_t i = 1; i < n; i++) length += cag_norm(cag_sub(p[i], p[i - 1]));
  double count = floor(length / dash);
  if (closed) count = 2 * floor(count / 2);
  else count = 2 * floor((count - 1) / 2) + 1;
  if (count < 2) return add_path(b, p, n, closed, radius, err);
  // A dash has two triangles on each side at least, and every second step is one.
  if (count * SIDES > (double)b->max_triangles)
    return cag_fail(err, CAG_E_LIMIT, "triangle-limit", "dash", -1,
                    "%.0f dashes need more than the %zu triangles allowed: make them longer",
                    ceil(count / 2), b->max_triangles);
  double step = length / count;
  CagVec3 *run = malloc((n + 2) * sizeof *run);
  if (!run) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  double at = 0, next = step; // length walked, and where the dash or gap ends
  bool drawn = true;
  size_t m = 0;
  run[m++] = p[0];
  for (size_t i = 1; status == CAG_OK && i < n; i++) {
    double part = cag_norm(cag_sub(p[i], p[i - 1]));
    while (status == CAG_OK && part > 0 && next < at + part) {
      CagVec3 q = cag_lerp(p[i - 1], p[i], (next - at) / part);
      run[m++] = q;
      if (drawn) status = add_path(b, run, m, false, radius, err);
      drawn = !drawn;
      m = 0;
      run[m++] = q;
      next += step;
    }
    at += part;
    run[m++] = p[i];
  }
  // Rounding may leave a sliver behind the last gap.
  if (status == CAG_OK && drawn && next - at < step / 2)
    status = add_path(b, run, m, false, radius, err);
  free(run);
  return status;
}

// Points without repetitions; returns how many.
static size_t distinct(CagVec3 *p, size_t n) {
  size_t m = 0;
  for (size_t i = 0; i < n; i++)
    if (m == 0 || cag_norm(cag_sub(p[i], p[m - 1])) > 0) p[m++] = p[i];
  return m;
}

static CagStatus curve_points(const CagCurve *c, double radius, const CagTessellation *how,
                              CagVec3 **out, size_t *n, CagError *err) {
  double *t = NULL, tolerance = CHORD_PART * radius;
  if (how->tolerance > 0) tolerance = fmin(tolerance, how->tolerance);
  CagStatus status = cag_curve_discretize(c, tolerance, how->angle, &t, n, err);
  if (status != CAG_OK) return status;
  *out = malloc(*n * sizeof **out);
  status = *out ? cag_curve_eval_many(c, t, *n, 0, *out, err) : cag_fail_memory(err);
  free(t);
  if (status != CAG_OK) {
    free(*out);
    return status;
  }
  *n = distinct(*out, *n);
  return CAG_OK;
}

static CagStatus take_mesh(const Buffer *b, CagMesh **out, CagError *err) {
  CagMesh *m = NULL;
  CagStatus status = cag_mesh_new(b->vertices, b->count, true, false, false, &m, err);
  if (status != CAG_OK) return status;
  if (b->vertices > 0) {
    memcpy(m->positions, b->positions, b->vertices * sizeof *m->positions);
    memcpy(m->normals, b->normals, b->vertices * sizeof *m->normals);
    memcpy(m->triangles, b->triangles, 3 * b->count * sizeof *m->triangles);
  }
  *out = m;
  return CAG_OK;
}

CagStatus cag_curve_tube_mesh(const CagCurve *c, double radius, double dash,
                              const CagTessellation *how, CagMesh **out, CagError *err) {
  CagVec3 *points = NULL;
  size_t n = 0;
  Buffer b = {.max_triangles = how->max_triangles};
  CagStatus status = curve_points(c, radius, how, &points, &n, err);
  if (status != CAG_OK) return status;
  if (c->closed && n > 1) points[n - 1] = points[0];
  status = dash > 0 ? add_dashes(&b, points, n, c->closed, dash, radius, err)
                    : add_path(&b, points, n, c->closed, radius, err);
  if (status == CAG_OK) status = take_mesh(&b, out, err);
  free(points);
  free(b.positions);
  free(b.normals);
  free(b.triangles);
  return status;
}
