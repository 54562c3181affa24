// Regions of faces without seams (see unseamed.h).
//
// The traces of a loop are joined in the plane of the parameters by shifts of whole turns. A ring is
// a loop that does not come back to its start there, but to a point a whole turn beside it. The
// face is between two rings, or between a ring and a pole, and the seam joins their starts.

#include "geom/boundary/unseamed.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/carrier.h"
#include "geom/boundary/meshed.h"

#define TURN (2 * M_PI)
// Traces meet if their ends are closer than this fraction of the face's range of the parameter.
#define MEET 1e-3
// Ends that are closer are not joined by a line.
#define SAME 1e-12
// An angle is at the seam if it is at most this fraction of a turn away.
#define AT_SEAM 1e-9
// A step of an angle between samples of a trace that is larger (radians) is a jump at a pole.
#define JUMP 1.0
// Samples of a trace, and angles that are tried for a seam.
enum { SAMPLES = 64, SEAMS = 24, BISECTIONS = 60 };
// The region and the triangles of the mesh have the same area in the parameters to this fraction.
#define AREA_SHARE 0.25

typedef struct Ring {
  CagCurve **items; // room for all traces, their bridges, and one that is divided
  size_t n;
  CagVec3 first, last;
  int turns[2]; // along u and v
} Ring;

typedef struct Unseamed {
  const CagBoundary *b;
  const CagBoundaryFace *face;
  bool periodic[2];
  double slack[2]; // along u and v
  Ring *rings;
  size_t count;
  bool failed; // no region
} Unseamed;

static double coordinate(CagVec3 p, int axis) { return axis ? p.y : p.x; }

static CagVec3 along_axis(int axis, double x) {
  return axis ? cag_vec3(0, x, 0) : cag_vec3(x, 0, 0);
}

static void ring_free(Ring *r) {
  for (size_t i = 0; i < r->n; i++) cag_curve_release(r->items[i]);
  cag_free(r->items);
}

static void unseamed_free(Unseamed *s) {
  for (size_t i = 0; i < s->count; i++) ring_free(&s->rings[i]);
  cag_free(s->rings);
}

// --- Rings ---

// Replaces a curve by a shifted one.
static CagStatus shift_curve(CagCurve **c, CagVec3 by, CagError *err) {
  CagCurve *moved;
  if (by.x == 0 && by.y == 0) return CAG_OK;
  CagTransform t = cag_transform_identity();
  t.m[0][3] = by.x, t.m[1][3] = by.y;
  const CagStatus status = cag_curve_transform(*c, &t, &moved, err);
  if (status) return status;
  cag_curve_release(*c);
  *c = moved;
  return CAG_OK;
}

static CagStatus shift_ring(Ring *r, CagVec3 by, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < r->n; i++) status = shift_curve(&r->items[i], by, err);
  r->first = cag_add(r->first, by);
  r->last = cag_add(r->last, by);
  return status;
}

// The whole turns from a point to the one nearest to another one.
static CagVec3 turns_to(const Unseamed *s, CagVec3 from, CagVec3 to) {
  CagVec3 out = {0, 0, 0};
  for (int k = 0; k < 2; k++)
    if (s->periodic[k])
      out = cag_add(out,
                    along_axis(k, TURN * round((coordinate(to, k) - coordinate(from, k)) / TURN)));
  return out;
}

static bool is_near(const Unseamed *s, CagVec3 a, CagVec3 b) {
  return fabs(a.x - b.x) <= s->slack[0] && fabs(a.y - b.y) <= s->slack[1];
}

static CagStatus has_jump(const Unseamed *s, const CagCurve *c, bool *out, CagError *err) {
  CagVec3 last = {0, 0, 0}, p;
  CagStatus status = CAG_OK;
  *out = false;
  for (int i = 0; !status && !*out && i <= SAMPLES; i++, last = p) {
    status = cag_curve_point(c, c->start + (c->end - c->start) * i / SAMPLES, &p, err);
    for (int k = 0; !status && i > 0 && k < 2; k++)
      *out = *out || (s->periodic[k] && fabs(coordinate(p, k) - coordinate(last, k)) > JUMP);
  }
  return status;
}

static CagStatus join_last(Ring *r, CagVec3 to, CagError *err) {
  const CagVec3 gap = cag_sub(to, r->last);
  if (cag_norm(gap) <= SAME * (cag_norm(to) + cag_norm(r->last))) return CAG_OK;
  const CagStatus status = cag_curve_line(r->last, to, 2, &r->items[r->n], err);
  if (!status) r->n++;
  return status;
}

// Adds a trace after the last one of the ring.
static CagStatus add_trace(Unseamed *s, Ring *r, const CagBoundaryUse *use, CagError *err) {
  CagCurve *c = NULL;
  CagVec3 from, to;
  bool jumps = false;
  CagStatus status = CAG_OK;
  if (use->reversed) status = cag_curve_reverse(use->trace, &c, err);
  else c = cag_curve_retain(use->trace);
  if (!status) status = has_jump(s, c, &jumps, err);
  if (!status) status = cag_curve_point(c, c->start, &from, err);
  if (!status && r->n > 0) status = shift_curve(&c, turns_to(s, from, r->last), err);
  if (!status) status = cag_curve_point(c, c->start, &from, err);
  if (!status) status = cag_curve_point(c, c->end, &to, err);
  if (!status && r->n > 0) {
    s->failed |= !is_near(s, from, r->last);
    status = join_last(r, from, err);
  } else r->first = from;
  s->failed |= jumps;
  if (status) {
    cag_curve_release(c);
    return status;
  }
  r->last = to;
  r->items[r->n++] = c;
  return CAG_OK;
}

static CagStatus add_ring(Unseamed *s, const CagBoundaryLoop *l, CagError *err) {
  Ring *r = &s->rings[s->count++];
  *r = (Ring){.items = cag_calloc(2 * l->count + 4, sizeof *r->items)};
  CagStatus status = r->items ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < l->count; i++)
    status = add_trace(s, r, &s->b->uses[l->first + i], err);
  if (status) return status;
  const CagVec3 turns = turns_to(s, r->first, r->last), end = cag_add(r->first, turns);
  s->failed |= !is_near(s, end, r->last);
  for (int k = 0; k < 2; k++) r->turns[k] = (int)lround(coordinate(turns, k) / TURN);
  status = join_last(r, end, err);
  r->last = end;
  return status;
}

// --- Seams ---

// Where a ring crosses a seam.
typedef struct SeamCut {
  size_t count, item;
  double t, low, high; // low = high = t: at the start of the item
} SeamCut;

// Whole turns of a coordinate from the seam, and whether it is on the seam.
static double turns_from(CagVec3 p, int axis, double seam, bool *on) {
  const double turns = (coordinate(p, axis) - seam) / TURN;
  *on = fabs(turns - round(turns)) <= AT_SEAM;
  return floor(turns);
}

static CagStatus find_cut(const Ring *r, int axis, double seam, SeamCut *out, CagError *err) {
  CagStatus status = CAG_OK;
  *out = (SeamCut){0};
  for (size_t i = 0; !status && i < r->n; i++) {
    const CagCurve *c = r->items[i];
    double last = 0, at = 0;
    bool known = false;
    for (int k = 0; !status && k <= SAMPLES; k++) {
      const double t = k < SAMPLES ? c->start + (c->end - c->start) * k / SAMPLES : c->end;
      CagVec3 p;
      bool on;
      status = cag_curve_point(c, t, &p, err);
      if (status) break;
      const double turns = turns_from(p, axis, seam, &on);
      if (on && k == 0) *out = (SeamCut){out->count + 1, i, t, t, t};
      if (on) continue;
      if (known && turns != last) *out = (SeamCut){out->count + 1, i, t, at, t};
      last = turns, at = t, known = true;
    }
  }
  return status;
}

// The ring that starts at its cut.
static CagStatus cut_ring(Ring *r, int axis, double seam, CagError *err) {
  SeamCut cut;
  CagStatus status = find_cut(r, axis, seam, &cut, err);
  if (status) return status;
  CagCurve **turned = cag_calloc(r->n + 4, sizeof *turned), *parts[2] = {NULL, NULL};
  if (!turned) return cag_fail_memory(err);
  CagCurve *c = r->items[cut.item];
  const CagVec3 turn = along_axis(axis, TURN * r->turns[axis]);
  CagVec3 p = {0, 0, 0};
  bool on, inner = cut.low < cut.high;
  if (inner) {
    double low = cut.low, high = cut.high;
    status = cag_curve_point(c, low, &p, err);
    const double before = turns_from(p, axis, seam, &on);
    for (int k = 0; !status && k < BISECTIONS; k++) {
      const double middle = low + (high - low) / 2;
      status = cag_curve_point(c, middle, &p, err);
      if (turns_from(p, axis, seam, &on) == before) low = middle;
      else high = middle;
    }
    if (!status) status = cag_curve_trim(c, c->start, high, &parts[0], err);
    if (!status) status = cag_curve_trim(c, high, c->end, &parts[1], err);
    if (status) {
      cag_curve_release(parts[0]);
      cag_free(turned);
      return status;
    }
  }
  size_t n = 0;
  turned[n++] = inner ? parts[1] : cag_curve_retain(c);
  for (size_t i = cut.item + 1; i < r->n; i++) turned[n++] = cag_curve_retain(r->items[i]);
  const size_t kept = n;
  for (size_t i = 0; i < cut.item; i++) turned[n++] = cag_curve_retain(r->items[i]);
  if (inner) turned[n++] = parts[0];
  for (size_t i = kept; !status && i < n; i++) status = shift_curve(&turned[i], turn, err);
  ring_free(r);
  r->items = turned;
  r->n = n;
  if (!status) status = cag_curve_point(turned[0], turned[0]->start, &r->first, err);
  r->last = cag_add(r->first, turn);
  if (status) return status;
  const double start = r->turns[axis] > 0 ? seam : seam + TURN;
  return shift_ring(r, along_axis(axis, start - coordinate(r->first, axis)), err);
}

// Finds an angle that each ring with turns crosses once, and no other one.
static CagStatus find_seam(const Unseamed *s, int axis, double *out, bool *found, CagError *err) {
  CagStatus status = CAG_OK;
  *found = false;
  for (size_t k = 0; !status && !*found && k < s->count + SEAMS; k++) {
    const double seam =
        k < s->count ? coordinate(s->rings[k].first, axis) : TURN * (double)(k - s->count) / SEAMS;
    bool good = true;
    for (size_t i = 0; !status && good && i < s->count; i++) {
      SeamCut cut;
      status = find_cut(&s->rings[i], axis, seam, &cut, err);
      good = cut.count == (size_t)abs(s->rings[i].turns[axis]);
    }
    if (status || !good) continue;
    *out = seam - TURN * floor(seam / TURN + AT_SEAM);
    *found = true;
  }
  return status ? status : cag_stop_check(err);
}

// --- Outer rings ---

static CagStatus add_line(Ring *r, CagVec3 to, CagError *err) {
  CagStatus status = join_last(r, to, err);
  r->last = to;
  return status;
}

// The other coordinate of the pole beyond a ring, in the direction of the sign.
static bool pole_beyond(const CagCarrier *c, double from, double sign, double *out) {
  if (c->kind == CAG_CARRIER_SPHERE) *out = sign * M_PI / 2;
  else if (c->kind == CAG_CARRIER_CONE && sin(c->b) != 0) *out = -c->a / sin(c->b);
  else return false;
  return sign * (*out - from) > 0;
}

// Joins the first ring with turns along the axis and the other one, or a pole, at the seam.
static CagStatus join_rings(Unseamed *s, int axis, double seam, Ring *out, CagError *err) {
  Ring *ring[2] = {NULL, NULL};
  size_t n = 0;
  CagStatus status = CAG_OK;
  for (size_t i = 0; i < s->count; i++) {
    if (s->rings[i].turns[axis] == 0) continue;
    s->failed |= n == 2 || abs(s->rings[i].turns[axis]) > 1;
    if (n < 2) ring[n++] = &s->rings[i];
  }
  s->failed |= n == 2 && ring[0]->turns[axis] == ring[1]->turns[axis];
  for (size_t i = 0; !status && !s->failed && i < n; i++)
    status = cut_ring(ring[i], axis, seam, err);
  if (status || s->failed) return status;
  const int other = !axis;
  const double from = coordinate(ring[0]->first, other);
  // The face is on the left of the ring, seen against the outward normal.
  const double left = (ring[0]->turns[axis] > 0) != s->face->reversed ? 1 : -1;
  const double sign = axis == 0 ? left : -left;
  double to = 0;
  if (n == 1) s->failed |= axis != 0 || !pole_beyond(&s->face->carrier, from, sign, &to);
  else {
    to = coordinate(ring[1]->first, other);
    const double turns = s->periodic[other] ? TURN * floor(sign * (to - from) / TURN) : 0;
    status = shift_ring(ring[1], along_axis(other, -sign * turns), err);
    to -= sign * turns;
    s->failed |= !(sign * (to - from) > 0);
  }
  if (status || s->failed) return status;
  const size_t room = ring[0]->n + (n == 2 ? ring[1]->n : 1) + 4;
  *out = (Ring){.items = cag_calloc(room, sizeof *out->items),
                .first = ring[0]->first,
                .last = ring[0]->last};
  if (!out->items) return cag_fail_memory(err);
  for (size_t i = 0; i < ring[0]->n; i++)
    out->items[out->n++] = cag_curve_retain(ring[0]->items[i]);
  if (n == 2) {
    status = add_line(out, ring[1]->first, err);
    for (size_t i = 0; !status && i < ring[1]->n; i++)
      out->items[out->n++] = cag_curve_retain(ring[1]->items[i]);
    out->last = ring[1]->last;
  } else {
    const CagVec3 rise = along_axis(other, to - from);
    status = add_line(out, cag_add(out->last, rise), err);
    if (!status) status = add_line(out, cag_add(out->first, rise), err);
  }
  return status ? status : add_line(out, out->first, err);
}

static CagStatus rectangle_ring(const double range[4], Ring *out, CagError *err) {
  const CagVec3 corners[4] = {{range[0], range[2], 0},
                              {range[1], range[2], 0},
                              {range[1], range[3], 0},
                              {range[0], range[3], 0}};
  *out =
      (Ring){.items = cag_calloc(4, sizeof *out->items), .first = corners[0], .last = corners[0]};
  CagStatus status = out->items ? CAG_OK : cag_fail_memory(err);
  for (int i = 1; !status && i <= 4; i++) status = add_line(out, corners[i % 4], err);
  return status;
}

// The whole carrier, of which loops cut holes.
static CagStatus whole_ring(Unseamed *s, Ring *out, CagError *err) {
  double range[4] = {0, 0, -M_PI / 2, M_PI / 2};
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 2; k++) {
    bool found = false;
    if (!s->periodic[k]) continue;
    status = find_seam(s, k, &range[2 * k], &found, err);
    range[2 * k + 1] = range[2 * k] + TURN;
    s->failed |= !found;
  }
  return status || s->failed ? status : rectangle_ring(range, out, err);
}

// --- Regions ---

static CagStatus ring_bounds(const Ring *r, CagBounds *out, CagError *err) {
  CagStatus status = CAG_OK;
  *out = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; !status && i < r->n; i++) {
    CagBounds box;
    status = cag_curve_bounds(r->items[i], &box, err);
    if (status) break;
    cag_bounds_add(out, box.min);
    cag_bounds_add(out, box.max);
  }
  return status;
}

static CagVec3 middle_of(const CagBounds *b) { return cag_scaled(cag_add(b->min, b->max), 0.5); }

// The index of the ring around the others: the one with the largest bounds.
static CagStatus largest_ring(const Unseamed *s, size_t *out, CagError *err) {
  double most = -1;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < s->count; i++) {
    CagBounds box;
    status = ring_bounds(&s->rings[i], &box, err);
    const double size = (box.max.x - box.min.x) * (box.max.y - box.min.y);
    if (!status && size > most) most = size, *out = i;
  }
  return status;
}

// Makes the region of an outer ring and the holes, which are the rings without turns; `skipped` is
// none of them.
static CagStatus make_region(Unseamed *s, const Ring *outer, size_t skipped, CagRegion **out,
                             CagBounds *box, CagError *err) {
  CagCurve **loops = cag_calloc(s->count + 1, sizeof *loops);
  size_t n = 0;
  CagStatus status = loops ? CAG_OK : cag_fail_memory(err);
  if (!status) status = ring_bounds(outer, box, err);
  if (!status) status = cag_curve_join(outer->items, outer->n, &loops[0], err);
  if (!status) n = 1;
  for (size_t i = 0; !status && i < s->count; i++) {
    Ring *r = &s->rings[i];
    CagBounds own;
    if (i == skipped || r->turns[0] || r->turns[1]) continue;
    status = ring_bounds(r, &own, err);
    if (!status) status = shift_ring(r, turns_to(s, middle_of(&own), middle_of(box)), err);
    if (!status) status = cag_curve_join(r->items, r->n, &loops[n], err);
    if (!status) n++;
  }
  if (!status) status = cag_region_from_loops(loops, n, out, err);
  for (size_t i = 0; i < n; i++) cag_curve_release(loops[i]);
  cag_free(loops);
  return status;
}

// The area of the face's triangles in the parameters.
static double triangles_area(const CagBoundary *b, size_t face) {
  const CagMesh *m = b->mesh;
  double area = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    double uv[3][2], near[2] = {0, 0};
    if (m->labels[t] != face + 1) continue;
    cag_carrier_parameters(&b->faces[face].carrier, cag_meshed_middle(m, t), near, near);
    for (size_t k = 0; k < 3; k++)
      cag_carrier_parameters(&b->faces[face].carrier, m->positions[m->triangles[3 * t + k]], near,
                             uv[k]);
    area += fabs((uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) -
                 (uv[1][1] - uv[0][1]) * (uv[2][0] - uv[0][0])) /
            2;
  }
  return area;
}

static CagStatus matches_mesh(const Unseamed *s, const CagRegion *r, size_t face, bool *out,
                              CagError *err) {
  double area;
  CagStatus status = cag_region_area(r, &area, NULL, err);
  if (!status) *out = fabs(area - triangles_area(s->b, face)) <= AREA_SHARE * area;
  return status;
}

static CagStatus find_region(Unseamed *s, size_t face, CagRegion **out, CagBounds *box,
                             CagError *err) {
  Ring outer = {0};
  size_t largest = SIZE_MAX;
  int axis = -1;
  double seam;
  bool found = true, good = false;
  for (size_t i = 0; i < s->count; i++)
    for (int k = 0; k < 2; k++)
      if (s->rings[i].turns[k]) {
        s->failed |= axis >= 0 && axis != k;
        axis = k;
      }
  const double *d = s->face->domain;
  CagStatus status = CAG_OK;
  if (s->failed) return status;
  if (axis >= 0) {
    status = find_seam(s, axis, &seam, &found, err);
    s->failed |= !found;
    if (!status && found) status = join_rings(s, axis, seam, &outer, err);
  } else if (d[1] - d[0] < TURN * (1 - AT_SEAM)) {
    status = largest_ring(s, &largest, err);
  } else {
    const CagCarrierKind kind = s->face->carrier.kind;
    s->failed |= kind != CAG_CARRIER_SPHERE && kind != CAG_CARRIER_TORUS;
    if (!s->failed) status = whole_ring(s, &outer, err);
  }
  if (!status && !s->failed)
    status =
        make_region(s, largest < SIZE_MAX ? &s->rings[largest] : &outer, largest, out, box, err);
  ring_free(&outer);
  if (status || s->failed) return status;
  status = matches_mesh(s, *out, face, &good, err);
  if (!status && good) return CAG_OK;
  cag_region_release(*out);
  *out = NULL;
  return status;
}

CagStatus cag_unseamed_region(const CagBoundary *b, size_t face, CagRegion **out, double bounds[4],
                              CagError *err) {
  const CagBoundaryFace *f = &b->faces[face];
  Unseamed s = {.b = b, .face = f};
  CagBounds box;
  *out = NULL;
  if (!cag_carrier_is_analytic(&f->carrier) || f->carrier.kind == CAG_CARRIER_PLANE ||
      f->count == 0)
    return CAG_OK;
  for (int k = 0; k < 2; k++) {
    s.periodic[k] = cag_carrier_is_periodic(&f->carrier, k);
    s.slack[k] = MEET * (f->domain[2 * k + 1] - f->domain[2 * k]);
  }
  s.rings = cag_calloc(f->count + 1, sizeof *s.rings);
  CagStatus status = s.rings ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && !s.failed && i < f->count; i++)
    status = add_ring(&s, &b->loops[f->first + i], err);
  if (!status && !s.failed) status = find_region(&s, face, out, &box, err);
  unseamed_free(&s);
  if (status && !cag_is_final(status)) status = CAG_OK; // a region that cannot be made is missing
  if (!*out) return status;
  memcpy(bounds, (double[4]){box.min.x, box.max.x, box.min.y, box.max.y}, 4 * sizeof *bounds);
  return status;
}
