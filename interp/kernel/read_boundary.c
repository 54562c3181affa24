// Boundaries from messages (see read_boundary.h). Everything is checked: an answer may be garbage.

#include "interp/kernel/read_boundary.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/nurbs.h"
#include "interp/kernel/protocol.h"

// The fewest bytes of an item, which bound the counts of a message.
#define CORNER_BYTES 24
#define EDGE_BYTES 36
#define FACE_BYTES 48
#define LOOP_BYTES 4
#define USE_BYTES 12

// How far a curve may end from its corner: this multiple of what the edge says, and of rounding.
#define END_SLACK 4.0
#define END_ROUNDING 1e-9
// Traces whose ranges differ from those of their edges by less than this fraction get these.
#define SAME_RANGE 1e-9

static CagStatus bad_answer(CagError *err) {
  return cag_fail(err, CAG_E_RENDERER, CAG_ERR_kernel_answer, "", -1,
                  "the answer of cag-brep is not a boundary");
}

static CagStatus checked(const CagFieldReader *r, CagError *err) {
  return r->bad ? bad_answer(err) : CAG_OK;
}

// --- Curves ---

static CagVec3 take_point(CagFieldReader *r, int dimension) {
  CagVec3 p = {0, 0, 0};
  p.x = cag_take_f64(r);
  p.y = cag_take_f64(r);
  if (dimension == 3) p.z = cag_take_f64(r);
  return p;
}

// A line from first to last, with the parameter of the message.
static CagStatus read_line(CagFieldReader *r, int dimension, double first, double last,
                           CagVec3 origin, CagVec3 along, CagCurve **out, CagError *err) {
  const CagVec3 ends[2] = {cag_madd(origin, first, along), cag_madd(origin, last, along)};
  const double knots[4] = {first, first, last, last};
  CagStatus status = checked(r, err);
  return status ? status : cag_curve_nurbs(ends, NULL, 2, 1, knots, dimension, out, err);
}

static CagStatus read_arc(CagFieldReader *r, int dimension, double first, double last,
                          CagVec3 center, bool ellipse, CagCurve **out, CagError *err) {
  const CagVec3 x = take_point(r, dimension), y = take_point(r, dimension);
  const double a = cag_take_f64(r), b = ellipse ? cag_take_f64(r) : a;
  CagStatus status = checked(r, err);
  if (status) return status;
  const CagVec3 z = cag_cross(x, y);
  CagTransform frame = cag_transform_identity();
  const CagVec3 columns[4] = {x, y, z, center};
  for (int j = 0; j < 4; j++) {
    frame.m[0][j] = columns[j].x;
    frame.m[1][j] = columns[j].y;
    frame.m[2][j] = columns[j].z;
  }
  frame.planar = dimension == 2;
  return cag_curve_arc(a, b, first, last, &frame, out, err);
}

static CagStatus read_spline(CagFieldReader *r, int dimension, double first, double last,
                             CagCurve **out, CagError *err) {
  const size_t degree = cag_take_u32(r);
  const bool rational = cag_take_u32(r) != 0;
  const size_t n = cag_take_count(r, (size_t)dimension * sizeof(double));
  if (r->bad || degree < 1 || degree > 100 || n <= degree) return bad_answer(err);
  CagVec3 *points = cag_calloc(n, sizeof *points);
  double *weights = cag_calloc(n, sizeof *weights);
  double *knots = cag_calloc(n + degree + 1, sizeof *knots);
  CagCurve *whole = NULL;
  CagStatus status = points && weights && knots ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    points[i] = take_point(r, dimension);
    weights[i] = rational ? cag_take_f64(r) : 1;
  }
  for (size_t i = 0; !status && i < n + degree + 1; i++) knots[i] = cag_take_f64(r);
  if (!status) status = checked(r, err);
  if (!status)
    status = cag_curve_nurbs(points, rational ? weights : NULL, n, (int)degree, knots, dimension,
                             &whole, err);
  cag_free(points);
  cag_free(weights);
  cag_free(knots);
  if (status || !whole) return status;
  first = fmax(first, whole->start);
  last = fmin(last, whole->end);
  if (first == whole->start && last == whole->end) *out = whole;
  else {
    status = cag_nurbs_clamped(whole, first, last, out, err);
    cag_curve_release(whole);
  }
  return status;
}

// Skips a curve's fields to find its range, which follows it, and reads it with the range.
static CagStatus read_kind(CagFieldReader *r, int dimension, double first, double last,
                           CagCurve **out, CagError *err) {
  const uint32_t kind = cag_take_u32(r);
  *out = NULL;
  if (r->bad) return bad_answer(err);
  if (kind == CAG_BREP_POINT) return CAG_OK;
  if (kind == CAG_BREP_SPLINE_CURVE) return read_spline(r, dimension, first, last, out, err);
  const CagVec3 origin = take_point(r, dimension);
  if (kind == CAG_BREP_LINE)
    return read_line(r, dimension, first, last, origin, take_point(r, dimension), out, err);
  if (kind == CAG_BREP_CIRCLE || kind == CAG_BREP_ELLIPSE)
    return read_arc(r, dimension, first, last, origin, kind == CAG_BREP_ELLIPSE, out, err);
  return bad_answer(err);
}

static void skip_curve(CagFieldReader *r, int dimension) {
  const size_t point = (size_t)dimension * sizeof(double);
  size_t bytes = 0;
  switch (cag_take_u32(r)) {
  case CAG_BREP_POINT: break;
  case CAG_BREP_LINE: bytes = 2 * point; break;
  case CAG_BREP_CIRCLE: bytes = 3 * point + sizeof(double); break;
  case CAG_BREP_ELLIPSE: bytes = 3 * point + 2 * sizeof(double); break;
  case CAG_BREP_SPLINE_CURVE: {
    const size_t degree = cag_take_u32(r), rational = cag_take_u32(r) != 0, n = cag_take_u32(r);
    bytes = n * (point + rational * sizeof(double)) + (n + degree + 1) * sizeof(double);
    break;
  }
  default: r->bad = true;
  }
  if (r->bad || bytes > (size_t)(r->end - r->at)) r->bad = true;
  else r->at += bytes;
}

// A curve that is followed by its range.
static CagStatus read_ranged(CagFieldReader *r, double range[2], CagCurve **out, CagError *err) {
  CagFieldReader curve = *r;
  skip_curve(r, 3);
  range[0] = cag_take_f64(r);
  range[1] = cag_take_f64(r);
  if (r->bad) return bad_answer(err);
  return read_kind(&curve, 3, fmin(range[0], range[1]), fmax(range[0], range[1]), out, err);
}

// --- Surfaces ---

static CagTransform take_frame(CagFieldReader *r) {
  static const int COLUMNS[] = {3, 0, 1, 2};
  CagTransform t = cag_transform_identity();
  t.planar = false;
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < 3; i++) t.m[i][COLUMNS[k]] = cag_take_f64(r);
  return t;
}

static CagStatus read_net(CagFieldReader *r, CagSurface **out, CagError *err) {
  const size_t p = cag_take_u32(r), q = cag_take_u32(r);
  const bool rational = cag_take_u32(r) != 0;
  const size_t nu = cag_take_u32(r), nv = cag_take_u32(r);
  if (r->bad || p < 1 || q < 1 || p > 100 || q > 100 || nu <= p || nv <= q ||
      nu > (size_t)(r->end - r->at) / CORNER_BYTES / nv)
    return bad_answer(err);
  CagVec3 *points = cag_calloc(nu * nv, sizeof *points);
  double *weights = cag_calloc(nu * nv, sizeof *weights);
  double *knots = cag_calloc(nu + p + 1 + nv + q + 1, sizeof *knots);
  CagStatus status = points && weights && knots ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < nu * nv; i++) {
    points[i] = cag_take_vec(r);
    weights[i] = rational ? cag_take_f64(r) : 1;
  }
  for (size_t i = 0; !status && i < nu + p + 1 + nv + q + 1; i++) knots[i] = cag_take_f64(r);
  if (!status) status = checked(r, err);
  if (!status)
    status = cag_surface_nurbs(points, rational ? weights : NULL, nu, nv, (int)p, (int)q, knots,
                               knots + nu + p + 1, out, err);
  cag_free(points);
  cag_free(weights);
  cag_free(knots);
  return status;
}

// A frame with a given z axis.
static CagTransform frame_along(CagVec3 origin, CagVec3 z) {
  const CagVec3 other = fabs(z.x) < 0.5 ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
  const CagVec3 x = cag_unit(cag_cross(other, z)), y = cag_cross(z, x);
  const CagVec3 columns[4] = {x, y, z, origin};
  CagTransform t = cag_transform_identity();
  t.planar = false;
  for (int j = 0; j < 4; j++) {
    t.m[0][j] = columns[j].x;
    t.m[1][j] = columns[j].y;
    t.m[2][j] = columns[j].z;
  }
  return t;
}

static CagStatus read_swept(CagFieldReader *r, bool revolved, CagCarrier *out, CagError *err) {
  double range[2];
  const CagVec3 origin = revolved ? cag_take_vec(r) : cag_vec3(0, 0, 0);
  out->frame = frame_along(origin, cag_unit(cag_take_vec(r)));
  out->kind = revolved ? CAG_CARRIER_REVOLVED : CAG_CARRIER_EXTRUDED;
  CagStatus status = read_ranged(r, range, &out->profile, err);
  return status || out->profile ? status : bad_answer(err);
}

static CagStatus read_carrier(CagFieldReader *r, CagCarrier *out, CagError *err) {
  static const struct {
    uint32_t said;
    CagCarrierKind kind;
    int numbers;
  } PLAIN[] = {{CAG_BREP_PLANE, CAG_CARRIER_PLANE, 0},
               {CAG_BREP_CYLINDRICAL, CAG_CARRIER_CYLINDER, 1},
               {CAG_BREP_CONICAL, CAG_CARRIER_CONE, 2},
               {CAG_BREP_SPHERICAL, CAG_CARRIER_SPHERE, 1},
               {CAG_BREP_TOROIDAL, CAG_CARRIER_TORUS, 2}};
  const uint32_t said = cag_take_u32(r);
  if (r->bad) return bad_answer(err);
  if (said == CAG_BREP_SPLINE) {
    out->kind = CAG_CARRIER_SPLINE;
    return read_net(r, &out->spline, err);
  }
  if (said == CAG_BREP_REVOLVED || said == CAG_BREP_EXTRUDED)
    return read_swept(r, said == CAG_BREP_REVOLVED, out, err);
  for (size_t i = 0; i < sizeof PLAIN / sizeof *PLAIN; i++) {
    if (PLAIN[i].said != said) continue;
    out->kind = PLAIN[i].kind;
    out->frame = take_frame(r);
    if (PLAIN[i].numbers > 0) out->a = cag_take_f64(r);
    if (PLAIN[i].numbers > 1) out->b = cag_take_f64(r);
    return checked(r, err);
  }
  return bad_answer(err);
}

// --- Topology ---

static CagStatus read_corners(CagFieldReader *r, CagBoundary *b, CagError *err) {
  b->corner_count = cag_take_count(r, CORNER_BYTES);
  b->corners = cag_calloc(b->corner_count + 1, sizeof *b->corners);
  if (!b->corners) {
    b->corner_count = 0;
    return cag_fail_memory(err);
  }
  for (size_t i = 0; i < b->corner_count; i++) b->corners[i] = cag_take_vec(r);
  return checked(r, err);
}

// The ends of a curve are its corners, as far as the edge says.
static CagStatus check_ends(const CagBoundary *b, const CagBoundaryEdge *e, CagError *err) {
  CagVec3 from, to;
  if (!e->curve) return CAG_OK;
  CagStatus status = cag_curve_point(e->curve, e->curve->start, &from, err);
  if (!status) status = cag_curve_point(e->curve, e->curve->end, &to, err);
  if (status) return status;
  const double slack = END_SLACK * (e->gap + END_ROUNDING * (1 + cag_norm(from) + cag_norm(to)));
  return cag_norm(cag_sub(from, b->corners[e->from])) <= slack &&
                 cag_norm(cag_sub(to, b->corners[e->to])) <= slack
             ? CAG_OK
             : bad_answer(err);
}

// The ranges of the edges, by which the traces are read.
typedef double (*Ranges)[2];

static CagStatus read_edges(CagFieldReader *r, CagBoundary *b, Ranges *ranges, CagError *err) {
  const size_t n = cag_take_count(r, EDGE_BYTES);
  b->edges = cag_calloc(n + 1, sizeof *b->edges);
  *ranges = cag_calloc(n + 1, sizeof **ranges);
  if (!b->edges || !*ranges) return cag_fail_memory(err);
  CagStatus status = checked(r, err);
  for (size_t i = 0; !status && i < n; i++) {
    CagBoundaryEdge *e = &b->edges[i];
    double *range = (*ranges)[i];
    status = read_ranged(r, range, &e->curve, err);
    if (status) break;
    b->edge_count = i + 1;
    e->from = cag_take_u32(r);
    e->to = cag_take_u32(r);
    e->gap = cag_take_f64(r);
    if (r->bad || e->from >= b->corner_count || e->to >= b->corner_count) return bad_answer(err);
    if (range[0] > range[1]) { // the curve was read in its own direction
      const size_t from = e->from;
      e->from = e->to;
      e->to = from;
    }
    status = check_ends(b, e, err);
  }
  return status;
}

// Gives a trace the range of its edge. The knots of splines may be rounded differently.
static CagStatus fit_trace(CagCurve **trace, double start, double end, CagError *err) {
  const CagCurve *t = *trace;
  const double room = SAME_RANGE * (end - start);
  CagCurve *fitted;
  if (t->start == start && t->end == end) return CAG_OK;
  if (fabs(t->start - start) > room || fabs(t->end - end) > room) return CAG_OK;
  const CagStatus status = cag_curve_reparametrize(t, start, end, &fitted, err);
  if (status) return status;
  cag_curve_release(*trace);
  *trace = fitted;
  return CAG_OK;
}

static CagStatus read_use(CagFieldReader *r, CagBoundary *b, Ranges ranges, CagError *err) {
  if (!CAG_RESERVE(b->uses, b->use_room, b->use_count + 1)) return cag_fail_memory(err);
  CagBoundaryUse use = {.edge = cag_take_u32(r)};
  use.reversed = cag_take_u32(r) != 0;
  if (r->bad || use.edge >= b->edge_count) return bad_answer(err);
  const double *range = ranges[use.edge];
  if (range[0] > range[1]) use.reversed = !use.reversed;
  const double start = fmin(range[0], range[1]), end = fmax(range[0], range[1]);
  CagStatus status = read_kind(r, 2, start, end, &use.trace, err);
  if (!status) status = fit_trace(&use.trace, start, end, err);
  if (!status) b->uses[b->use_count++] = use;
  else cag_curve_release(use.trace);
  return status;
}

static CagStatus read_loop(CagFieldReader *r, CagBoundary *b, Ranges ranges, CagError *err) {
  if (!CAG_RESERVE(b->loops, b->loop_room, b->loop_count + 1)) return cag_fail_memory(err);
  const size_t n = cag_take_count(r, USE_BYTES);
  b->loops[b->loop_count++] = (CagBoundaryLoop){b->use_count, n};
  CagStatus status = n > 0 ? CAG_OK : bad_answer(err);
  for (size_t i = 0; !status && i < n; i++) status = read_use(r, b, ranges, err);
  return status;
}

static CagStatus read_face(CagFieldReader *r, CagBoundary *b, Ranges ranges, CagBoundaryFace *f,
                           CagError *err) {
  CagStatus status = read_carrier(r, &f->carrier, err);
  if (status) return status;
  f->reversed = cag_take_u32(r) != 0;
  for (int k = 0; k < 4; k++) f->domain[k] = cag_take_f64(r);
  (void)cag_take_f64(r); // the tolerance is that of its edges
  f->count = cag_take_count(r, LOOP_BYTES);
  f->first = b->loop_count;
  for (size_t i = 0; !status && i < f->count; i++) status = read_loop(r, b, ranges, err);
  return status ? status : checked(r, err);
}

static CagStatus read_faces(CagFieldReader *r, CagBoundary *b, Ranges ranges, CagError *err) {
  const size_t n = cag_take_count(r, FACE_BYTES);
  b->faces = cag_calloc(n + 1, sizeof *b->faces);
  if (!b->faces) return cag_fail_memory(err);
  CagStatus status = checked(r, err);
  for (size_t i = 0; !status && i < n; i++) {
    b->face_count = i + 1;
    status = read_face(r, b, ranges, &b->faces[i], err);
  }
  return status;
}

static CagStatus read_shells(CagFieldReader *r, CagBoundary *b, CagError *err) {
  const size_t n = cag_take_count(r, LOOP_BYTES);
  b->shells = cag_calloc(n + 1, sizeof *b->shells);
  if (!b->shells) return cag_fail_memory(err);
  if (n == 0) return bad_answer(err);
  for (; b->shell_count < n; b->shell_count++) {
    const size_t faces = cag_take_count(r, sizeof(uint32_t));
    b->shells[b->shell_count] = (CagBoundaryShell){b->order_count, faces};
    if (!CAG_RESERVE(b->order, b->order_room, b->order_count + faces)) return cag_fail_memory(err);
    for (size_t k = 0; k < faces; k++) {
      const size_t face = cag_take_u32(r);
      if (r->bad || face >= b->face_count) return bad_answer(err);
      b->order[b->order_count++] = face;
    }
  }
  return checked(r, err);
}

static CagTransform take_placement(CagFieldReader *r) {
  CagTransform t = cag_transform_identity();
  t.planar = false;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) t.m[i][j] = cag_take_f64(r);
  return t;
}

static CagStatus read_boundary(CagFieldReader *r, CagBoundary *b, CagError *err) {
  Ranges ranges = NULL;
  const unsigned char *body = cag_take_bytes(r, &b->body_length);
  b->volume = cag_take_f64(r);
  b->area = cag_take_f64(r);
  b->centroid = cag_take_vec(r);
  CagStatus status = checked(r, err);
  if (!status && !(b->body = cag_malloc(b->body_length + 1))) status = cag_fail_memory(err);
  if (!status) memcpy(b->body, body, b->body_length);
  if (!status) status = read_corners(r, b, err);
  if (!status) status = read_edges(r, b, &ranges, err);
  if (!status) status = read_faces(r, b, ranges, err);
  if (!status) status = read_shells(r, b, err);
  cag_free(ranges);
  return status;
}

CagStatus cag_read_part(CagFieldReader *r, CagBoundary *out, CagBoundaryCopy *copy, CagError *err) {
  CagBoundary b = {0};
  size_t length;
  const unsigned char *name = cag_take_bytes(r, &length);
  b.has_color = cag_take_u32(r) != 0;
  for (int k = 0; b.has_color && k < 3; k++) b.color[k] = cag_take_f64(r);
  const uint32_t original = cag_take_u32(r);
  const bool copied = original != CAG_BREP_NONE;
  *copy = (CagBoundaryCopy){copied ? original : CAG_NOT_COPIED, cag_transform_identity()};
  if (copied) copy->placement = take_placement(r);
  CagStatus status = checked(r, err);
  if (!status && !(b.name = cag_strndup((const char *)name, length))) status = cag_fail_memory(err);
  if (!status && !copied) status = read_boundary(r, &b, err);
  if (status) cag_boundary_free(&b);
  else *out = b;
  return status;
}
