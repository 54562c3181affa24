// Curves as tubes.
//
// The curve is sampled, and a ring of SIDES vertices is placed around each point in
// rotation-minimizing frames (double reflection, Wang et al. 2008). Open ends have flat caps. A
// closed smooth curve is a loop of rings whose last ring is the first.
//
// At a sharp corner, the tubes are cut at the plane that bisects them. A wedge of a ball fills the
// gap on the outer side of the corner. The whole path is then one shell that does not overlap
// itself at the corner (add_joint). If a segment is too short for that, or the curve reverses, the
// path is cut: its parts are closed separately and overlap a ball at the corner. Parts and balls
// must not share an edge, because their vertices would be welded, and a solid must not have an edge
// with four triangles. Therefore the parts stop at different distances from such a corner, and the
// rings of the ball are rotated.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "interp/scene/item_mesh.h"

#define SIDES 12
#define BALL_RINGS 5
// The chord tolerance of a curve, as a fraction of the radius.
#define CHORD_PART 0.1
// How far before and after a sharp corner runs stop, as fractions of the radius. This is within the
// ball, and the two differ, so that a run that returns along the same line has no ring in common.
#define SHORT_AT_END 0.03
#define SHORT_AT_START 0.05
// A joint takes at most this fraction of the adjacent segments on the inside.
#define JOINT_PART 0.49
// If a path returns to its open end, the ring there is turned by one of these angles. It then
// shares no vertices with the other rings at that point, which would be welded.
#define TURN_AT_START 0.1
#define TURN_AT_END (-0.17)
// The cosine of the turn from which a corner counts as sharp: 25 degrees.
#define SHARP_COSINE 0.9063

typedef struct Buffer {
  CagVec3 *positions, *normals;
  uint32_t *triangles;
  size_t vertices, vertex_room, count, room;
  size_t max_triangles;
} Buffer;

// Makes room for more vertices and triangles. Checks the limit of triangles before it allocates.
static CagStatus reserve(Buffer *b, size_t vertices, size_t triangles, CagError *err) {
  if (b->count + triangles > b->max_triangles)
    return cag_fail(err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "", -1,
                    "the lines need more than the %zu triangles allowed", b->max_triangles);
  while (b->vertices + vertices > b->vertex_room) {
    size_t room = b->vertex_room ? 2 * b->vertex_room : 1024;
    if (!CAG_RESIZE(b->positions, room) || !CAG_RESIZE(b->normals, room))
      return cag_fail_memory(err);
    b->vertex_room = room;
  }
  while (b->count + triangles > b->room) {
    size_t room = b->room ? 2 * b->room : 2048;
    if (!CAG_RESIZE(b->triangles, 3 * room)) return cag_fail_memory(err);
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

// Returns the mean direction of the segments that meet at point i.
static CagVec3 tangent_at(const CagVec3 *p, size_t n, bool closed, size_t i) {
  CagVec3 before = {0, 0, 0}, after = {0, 0, 0};
  if (i > 0) before = cag_unit(cag_sub(p[i], p[i - 1]));
  else if (closed) before = cag_unit(cag_sub(p[0], p[n - 2]));
  if (i + 1 < n) after = cag_unit(cag_sub(p[i + 1], p[i]));
  else if (closed) after = cag_unit(cag_sub(p[1], p[0]));
  CagVec3 t = cag_unit(cag_add(before, after));
  return cag_norm(t) > 0 ? t : after;
}

// Transports the frame vector r from p with tangent t to q with tangent u, by two reflections.
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
    double a = turn + 2 * M_PI * k / SIDES;
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

// Vertex k of a ring is connected to vertex k + shift of the next.
static void add_side(Buffer *b, size_t ring, size_t next, size_t shift) {
  for (size_t k = 0; k < SIDES; k++) {
    size_t l = (k + 1) % SIDES, m = next + (k + shift) % SIDES, n = next + (l + shift) % SIDES;
    add_triangle(b, ring + k, ring + l, n);
    add_triangle(b, ring + k, n, m);
  }
}

// --- Joints ---

// A corner where two tubes meet. Vertex k of both rings is at the angle 2 PI k / SIDES, measured
// from `outward` towards `axis`. outward[0] belongs to the tube that ends, outward[1] to the one
// that begins.
typedef struct Joint {
  size_t ends, begins; // first vertices of the rings
  CagVec3 outward[2], axis;
} Joint;

// How far the tubes are cut back on the inside of a corner, in radii: the tangent of half the turn.
static double joint_depth(CagVec3 t, CagVec3 u) {
  return cag_norm(cag_cross(t, u)) / (1 + cag_dot(t, u));
}

// The vertices of the wedge of a ball. `step` counts from the ring that ends to the ring that
// begins. `k` runs from -SIDES/4 to SIDES/4, where the wedge ends in a point.
typedef struct Wedge {
  const Joint *joint;
  size_t steps, inner; // first vertex between the rings
} Wedge;

static size_t wedge_vertex(const Wedge *w, size_t step, int k) {
  const int quarter = SIDES / 4;
  const size_t around = (size_t)((k + SIDES) % SIDES);
  if (step == 0 || k == -quarter || k == quarter) return w->joint->ends + around;
  if (step == w->steps) return w->joint->begins + around;
  return w->inner + (step - 1) * (size_t)(2 * quarter - 1) + (size_t)(k + quarter - 1);
}

static void add_wedge(Buffer *b, const Wedge *w) {
  const int quarter = SIDES / 4;
  for (size_t i = 0; i < w->steps; i++)
    for (int k = -quarter; k < quarter; k++) {
      size_t near = wedge_vertex(w, i, k), far = wedge_vertex(w, i, k + 1);
      size_t next_near = wedge_vertex(w, i + 1, k), next_far = wedge_vertex(w, i + 1, k + 1);
      if (far != next_far) add_triangle(b, near, far, next_far);
      if (near != next_near) add_triangle(b, near, next_far, next_near);
    }
}

// Adds the joint at p between a tube along t and a tube along u: two rings and the wedge between
// them.
static CagStatus add_joint(Buffer *b, CagVec3 p, CagVec3 t, CagVec3 u, double radius, Joint *out,
                           CagError *err) {
  const int quarter = SIDES / 4;
  const double turn = atan2(cag_norm(cag_cross(t, u)), cag_dot(t, u)), depth = joint_depth(t, u);
  const double rounding = 1e-9; // a quarter turn has SIDES / 4 steps
  const size_t steps = (size_t)ceil(turn * SIDES / (2 * M_PI) - rounding);
  CagStatus status = reserve(b, (steps + 2) * SIDES, steps * (SIDES - 2), err);
  if (status) return status;
  CagVec3 o = cag_unit(cag_madd(cag_scaled(u, -1), cag_dot(t, u), t)), a = cag_cross(t, o);
  *out = (Joint){.outward = {o, cag_madd(cag_scaled(o, cos(turn)), sin(turn), t)}, .axis = a};
  size_t *const firsts[] = {&out->ends, &out->begins};
  for (int side = 0; side < 2; side++) {
    *firsts[side] = b->vertices;
    for (int k = 0; k < SIDES; k++) {
      // Both rings share the ends of the axis, which must not differ by rounding.
      const double c = k % (SIDES / 2) == quarter ? 0 : cos(2 * M_PI * k / SIDES);
      const double s = sin(2 * M_PI * k / SIDES);
      CagVec3 n = cag_madd(cag_scaled(out->outward[side], c), s, a);
      CagVec3 cut = cag_madd(cag_scaled(a, s), c, cag_madd(o, depth, t)); // in the bisecting plane
      const bool inside = k > quarter && k < SIDES - quarter;
      add_vertex(b, cag_madd(p, radius, inside ? cut : n), n);
    }
  }
  const Wedge wedge = {out, steps, b->vertices};
  for (size_t i = 1; i < steps; i++)
    for (int k = 1 - quarter; k < quarter; k++) {
      const double at = turn * (double)i / (double)steps, angle = 2 * M_PI * k / SIDES;
      CagVec3 level = cag_madd(cag_scaled(o, cos(at)), sin(at), t);
      CagVec3 n = cag_madd(cag_scaled(level, cos(angle)), sin(angle), a);
      add_vertex(b, cag_madd(p, radius, n), n);
    }
  add_wedge(b, &wedge);
  return CAG_OK;
}

// --- Runs ---

// An end of a run: a joint, or a cap if `joint` is NULL. The ring of a cap may be turned.
typedef struct RunEnd {
  const Joint *joint;
  double turn;
} RunEnd;

// Returns the angle by which to turn the frame that starts as `first`, so that the vertices of the
// last ring coincide with those of the joint. Also counts the vertices of the joint to skip.
static double turn_to_joint(const CagVec3 *p, size_t n, CagVec3 first, const Joint *to,
                            size_t *shift) {
  CagVec3 t = tangent_at(p, n, false, 0), r = first;
  for (size_t i = 1; i < n; i++) {
    CagVec3 u = tangent_at(p, n, false, i);
    r = carry(p[i - 1], t, r, p[i], u);
    t = u;
  }
  const double angle = atan2(cag_dot(r, to->axis), cag_dot(r, to->outward[0]));
  const long steps = lround(angle * SIDES / (2 * M_PI));
  *shift = (size_t)((steps + SIDES) % SIDES);
  return 2 * M_PI * (double)steps / SIDES - angle;
}

// Adds an open tube through n points. Between two joints, the turn is distributed over the rings.
static CagStatus add_run(Buffer *b, const CagVec3 *p, size_t n, RunEnd from, RunEnd to,
                         double radius, CagError *err) {
  if (n < 2) return CAG_OK;
  const size_t caps = (from.joint ? 0u : 1u) + (to.joint ? 0u : 1u);
  CagStatus status = reserve(b, (n + 2) * SIDES + 2, (2 * (n - 1) + caps) * SIDES, err);
  if (status) return status;
  CagVec3 t = tangent_at(p, n, false, 0);
  CagVec3 r = from.joint ? from.joint->outward[1] : perpendicular(t);
  size_t shift = 0, ring = from.joint ? from.joint->begins : b->vertices;
  const double arrive = to.joint ? turn_to_joint(p, n, r, to.joint, &shift) : 0;
  const double begin = from.joint ? 0 : arrive + from.turn, end = arrive + to.turn;
  if (!from.joint) {
    add_ring(b, p[0], t, r, begin, radius);
    add_cap(b, ring, p[0], cag_scaled(t, -1), false);
  }
  for (size_t i = 1; i < n; i++) {
    if (cag_stop_check(err)) return err->status;
    CagVec3 u = tangent_at(p, n, false, i);
    r = carry(p[i - 1], t, r, p[i], u);
    t = u;
    const bool joins = to.joint && i + 1 == n;
    const size_t next = joins ? to.joint->ends : b->vertices;
    const double turn = begin + (end - begin) * (double)i / (double)(n - 1);
    if (!joins) add_ring(b, p[i], t, r, turn, radius);
    add_side(b, ring, next, joins ? shift : 0);
    ring = next;
  }
  if (!to.joint) add_cap(b, ring, p[n - 1], t, true);
  return CAG_OK;
}

// Adds a closed smooth tube through n points, the last of which is the first.
static CagStatus add_loop(Buffer *b, const CagVec3 *p, size_t n, double radius, CagError *err) {
  if (n < 2) return CAG_OK;
  CagStatus status = reserve(b, n * SIDES, 2 * SIDES * (n - 1), err);
  if (status) return status;
  const CagVec3 begin = tangent_at(p, n, true, 0), first = perpendicular(begin);
  CagVec3 t = begin, r = first;
  // The frame returns rotated: distribute the difference over the rings.
  for (size_t i = 1; i < n; i++) {
    CagVec3 u = tangent_at(p, n, true, i);
    r = carry(p[i - 1], t, r, p[i], u);
    t = u;
  }
  const double twist = atan2(cag_dot(cag_cross(r, first), t), cag_dot(r, first));
  const size_t rings = n - 1, start = b->vertices;
  t = begin;
  r = first;
  for (size_t i = 0; i < rings; i++) {
    if (cag_stop_check(err)) return err->status;
    CagVec3 u = tangent_at(p, n, true, i);
    if (i > 0) r = carry(p[i - 1], t, r, p[i], u);
    t = u;
    add_ring(b, p[i], t, r, twist * (double)i / (double)rings, radius);
  }
  for (size_t i = 0; i < rings; i++)
    add_side(b, start + i * SIDES, start + (i + 1) % rings * SIDES, 0);
  return CAG_OK;
}

// Rotates a direction by an angle that the rings of tubes along the axes do not have: by the
// rotation with the columns (9, -20, 12)/25, (12, 15, 16)/25, and (-20, 0, 15)/25.
static CagVec3 askew(CagVec3 n) {
  return cag_vec3((9 * n.x + 12 * n.y - 20 * n.z) / 25, (15 * n.y - 20 * n.x) / 25,
                  (12 * n.x + 16 * n.y + 15 * n.z) / 25);
}

static CagStatus add_ball(Buffer *b, CagVec3 p, double radius, CagError *err) {
  CagStatus status = reserve(b, BALL_RINGS * SIDES + 2, 2 * SIDES * (size_t)BALL_RINGS, err);
  if (status) return status;
  size_t start = b->vertices;
  for (int i = 1; i <= BALL_RINGS; i++) {
    double a = M_PI * i / (BALL_RINGS + 1);
    for (int k = 0; k < SIDES; k++) {
      double c = 2 * M_PI * k / SIDES;
      CagVec3 n = askew(cag_vec3(sin(a) * cos(c), sin(a) * sin(c), -cos(a)));
      add_vertex(b, cag_madd(p, radius, n), n);
    }
  }
  for (int i = 0; i + 1 < BALL_RINGS; i++)
    add_side(b, start + (size_t)i * SIDES, start + (size_t)(i + 1) * SIDES, 0);
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

// Returns the point at this distance from a corner toward the next point, at most halfway.
static CagVec3 short_of(CagVec3 corner, CagVec3 next, double length) {
  double whole = cag_norm(cag_sub(next, corner));
  return cag_lerp(corner, next, fmin(length / whole, 0.5));
}

// The points of a path, and the state of its corners. A closed path starts at a sharp corner, and
// its last point equals the first.
typedef struct Path {
  const CagVec3 *points;
  size_t count;
  bool closed;
  double radius;
} Path;

// The directions in which a path reaches point i and leaves it. Returns false at an open end.
static bool directions_at(const Path *h, size_t i, CagVec3 *t, CagVec3 *u, double *shortest) {
  const CagVec3 *p = h->points;
  const size_t n = h->count;
  if (!h->closed && (i == 0 || i + 1 == n)) return false;
  CagVec3 before = cag_sub(p[i], i > 0 ? p[i - 1] : p[n - 2]);
  CagVec3 after = cag_sub(i + 1 < n ? p[i + 1] : p[1], p[i]);
  *t = cag_unit(before);
  *u = cag_unit(after);
  *shortest = fmin(cag_norm(before), cag_norm(after));
  return true;
}

// Adds the joint at point i if there is room for one.
static CagStatus try_joint(Buffer *b, const Path *h, size_t i, Joint *joint, bool *joined,
                           CagError *err) {
  CagVec3 t, u;
  double shortest;
  *joined = directions_at(h, i, &t, &u, &shortest) &&
            h->radius * joint_depth(t, u) <= JOINT_PART * shortest;
  return *joined ? add_joint(b, h->points[i], t, u, h->radius, joint, err) : CAG_OK;
}

// Tests whether an open path returns to its end, point i.
static bool comes_back(const Path *h, size_t i) {
  const double near = 1e-6 * h->radius; // vertices this close may be welded
  for (size_t j = 0; j < h->count; j++)
    if (j != i && cag_norm(cag_sub(h->points[j], h->points[i])) <= near) return true;
  return false;
}

// Adds the run from point i to point k, which stops short of sharp corners without joints.
static CagStatus add_part(Buffer *b, const Path *h, size_t i, size_t k, const Joint *from,
                          const Joint *to, CagError *err) {
  const size_t n = k - i + 1;
  const CagVec3 *p = h->points + i;
  CagVec3 *q = cag_malloc(n * sizeof *q);
  if (!q) return cag_fail_memory(err);
  memcpy(q, p, n * sizeof *q);
  RunEnd begin = {from, 0}, end = {to, 0};
  if (!from && (i > 0 || h->closed)) q[0] = short_of(p[0], p[1], SHORT_AT_START * h->radius);
  else if (!from && comes_back(h, i)) begin.turn = TURN_AT_START;
  if (!to && (k + 1 < h->count || h->closed))
    q[n - 1] = short_of(p[n - 1], p[n - 2], SHORT_AT_END * h->radius);
  else if (!to && comes_back(h, k)) end.turn = TURN_AT_END;
  CagStatus status = add_run(b, q, n, begin, end, h->radius, err);
  cag_free(q);
  return status;
}

// Adds the runs between the sharp corners, and a joint or a ball at each corner.
static CagStatus add_corners(Buffer *b, const Path *h, CagError *err) {
  const CagVec3 *p = h->points;
  const size_t n = h->count;
  Joint start = {0}, from, to;
  bool starts, joined;
  CagStatus status = try_joint(b, h, 0, &start, &starts, err);
  if (!status && h->closed && !starts) status = add_ball(b, p[0], h->radius, err);
  bool begins = starts;
  from = start;
  size_t at = 0;
  for (size_t i = 1; !status && i < n; i++) {
    const bool last = i + 1 == n;
    if (!last && !is_sharp(p[i - 1], p[i], p[i + 1])) continue;
    to = start;
    joined = starts;
    if (!last) status = try_joint(b, h, i, &to, &joined, err);
    if (!status && !last && !joined) status = add_ball(b, p[i], h->radius, err);
    if (!status) status = add_part(b, h, at, i, begins ? &from : NULL, joined ? &to : NULL, err);
    from = to;
    begins = joined;
    at = i;
  }
  return status;
}

// Adds the closed path p, starting at its point `start`.
static CagStatus add_closed_corners(Buffer *b, const CagVec3 *p, size_t n, size_t start,
                                    double radius, CagError *err) {
  CagVec3 *q = cag_malloc(n * sizeof *q);
  if (!q) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) q[i] = p[(start + i) % (n - 1)];
  CagStatus status = add_corners(b, &(Path){q, n, true, radius}, err);
  cag_free(q);
  return status;
}

static CagStatus add_path(Buffer *b, const CagVec3 *p, size_t n, bool closed, double radius,
                          CagError *err) {
  if (n < 2) return CAG_OK;
  if (!closed) return add_corners(b, &(Path){p, n, false, radius}, err);
  for (size_t i = 0; n > 2 && i + 1 < n; i++)
    if (is_sharp(p[i > 0 ? i - 1 : n - 2], p[i], p[i + 1]))
      return add_closed_corners(b, p, n, i, radius, err);
  return add_loop(b, p, n, radius, err);
}

// Adds whole dashes, as many as fit with gaps of the same length between them. Both ends of an open
// curve are drawn.
static CagStatus add_dashes(Buffer *b, const CagVec3 *p, size_t n, bool closed, double dash,
                            double radius, CagError *err) {
  double length = 0;
  for (size_t i = 1; i < n; i++) length += cag_norm(cag_sub(p[i], p[i - 1]));
  double count = floor(length / dash);
  if (closed) count = 2 * floor(count / 2);
  else count = 2 * floor((count - 1) / 2) + 1;
  if (count < 2) return add_path(b, p, n, closed, radius, err);
  // A dash has at least two triangles per side, and every second step is a dash.
  if (count * SIDES > (double)b->max_triangles)
    return cag_fail(err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "dash", -1,
                    "%.0f dashes need more than the %zu triangles allowed: make them longer",
                    ceil(count / 2), b->max_triangles);
  double step = length / count;
  CagVec3 *run = cag_malloc((n + 2) * sizeof *run);
  if (!run) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  double at = 0, next = step;        // length so far, and the end of the dash or gap
  const double sliver = 1e-9 * step; // a dash that ends this close to a point ends there
  bool drawn = true;
  size_t m = 0;
  run[m++] = p[0];
  for (size_t i = 1; !status && i < n; i++) {
    double part = cag_norm(cag_sub(p[i], p[i - 1]));
    while (!status && part > 0 && next < at + part - sliver) {
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
    if (status || i + 1 == n || next > at + sliver) continue;
    if (drawn) status = add_path(b, run, m, false, radius, err);
    drawn = !drawn;
    m = 0;
    run[m++] = p[i];
    next += step;
  }
  // Rounding may leave a sliver after the last gap.
  if (!status && drawn && next - at < step / 2) status = add_path(b, run, m, false, radius, err);
  cag_free(run);
  return status;
}

// Removes repeated points. Returns the number of points left.
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
  if (status) return status;
  *out = cag_malloc(*n * sizeof **out);
  status = *out ? cag_curve_eval_many(c, t, *n, 0, *out, err) : cag_fail_memory(err);
  cag_free(t);
  if (status) {
    cag_free(*out);
    return status;
  }
  *n = distinct(*out, *n);
  return CAG_OK;
}

static CagStatus take_mesh(const Buffer *b, CagMesh **out, CagError *err) {
  CagMesh *m = NULL;
  CagStatus status = cag_mesh_new(b->vertices, b->count, true, false, false, &m, err);
  if (status) return status;
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
  if (status) return status;
  if (c->closed && n > 1) points[n - 1] = points[0];
  status = dash > 0 ? add_dashes(&b, points, n, c->closed, dash, radius, err)
                    : add_path(&b, points, n, c->closed, radius, err);
  if (!status) status = take_mesh(&b, out, err);
  cag_free(points);
  cag_free(b.positions);
  cag_free(b.normals);
  cag_free(b.triangles);
  return status;
}
