// Loops as sides and bends.
//
// Between two parts that follow each other, a corner turns from the direction of the first to that
// of the second, even if they differ only by rounding. The directions therefore form a closed
// sequence.

#include "geom/curve/outline.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/biarc.h"
#include "geom/curve/family.h"
#include "geom/curve/runs.h"
#include "geom/linalg/tolerance.h"

// --- Directions ---

int cag_direction_turn(CagVec3 a, CagVec3 b) {
  const double p = a.x * b.y, q = a.y * b.x;
  const double difference = (p - q) + (fma(a.x, b.y, -p) - fma(a.y, b.x, -q));
  return (difference > 0) - (difference < 0);
}

CagVec3 cag_bend_point(const CagBend *b, CagVec3 direction) {
  if (b->radius == 0) return b->center;
  const double scale = b->radius / hypot(direction.x, direction.y);
  return cag_madd(b->center, scale, cag_vec3(direction.y, -direction.x, 0));
}

static CagVec3 left_of(CagVec3 v) { return cag_vec3(-v.y, v.x, 0); }

static bool same_direction(CagVec3 a, CagVec3 b) {
  return cag_direction_turn(a, b) == 0 && cag_dot(a, b) > 0;
}

// --- The parts of a loop ---

// A loop while it is traced: the end of the last part, and the start of the first one.
typedef struct Trace {
  CagOutline *out;
  double tolerance;
  bool started, near;
  CagVec3 first_point, first_direction, first_beyond;
  CagVec3 last_direction, last_before;
} Trace;

static CagStatus add_bend(CagOutline *o, CagBend b, CagError *err) {
  if (same_direction(b.low, b.high)) return CAG_OK;
  if (!CAG_RESERVE(o->bends, o->bend_capacity, o->bend_count + 1)) return cag_fail_memory(err);
  o->bends[o->bend_count++] = b;
  return CAG_OK;
}

static CagStatus add_turn(CagOutline *o, CagVec3 center, double radius, int sense, CagVec3 from,
                          CagVec3 to, CagError *err) {
  return add_bend(o, (CagBend){center, radius, sense, sense > 0 ? from : to, sense > 0 ? to : from},
                  err);
}

// A corner between two directions. If the loop turns straight back, the sense is that of the side
// on which it leaves: `before` and `beyond` are points on the parts before and after it.
static CagStatus add_corner(Trace *t, CagVec3 at, CagVec3 from, CagVec3 to, CagVec3 before,
                            CagVec3 beyond, CagError *err) {
  if (same_direction(from, to)) return CAG_OK;
  int sense = cag_direction_turn(from, to);
  if (sense == 0)
    sense = cag_direction_turn(cag_sub(beyond, at), cag_sub(before, at)) >= 0 ? 1 : -1;
  if (cag_dot(from, to) >= 0) return add_turn(t->out, at, 0, sense, from, to, err);
  const CagVec3 middle = cag_scaled(left_of(from), sense);
  CagStatus status = add_turn(t->out, at, 0, sense, from, middle, err);
  return status ? status : add_turn(t->out, at, 0, sense, middle, to, err);
}

// Begins a part at a point; `beyond` is a point on it.
static CagStatus begin_part(Trace *t, CagVec3 at, CagVec3 direction, CagVec3 beyond,
                            CagError *err) {
  if (t->started)
    return add_corner(t, at, t->last_direction, direction, t->last_before, beyond, err);
  t->started = true;
  t->first_point = at;
  t->first_direction = direction;
  t->first_beyond = beyond;
  return CAG_OK;
}

static void end_part(Trace *t, CagVec3 direction, CagVec3 before) {
  t->last_direction = direction;
  t->last_before = before;
}

static CagStatus put_side(Trace *t, CagVec3 p, CagVec3 q, CagError *err) {
  const CagVec3 along = cag_sub(q, p);
  if (along.x == 0 && along.y == 0) return CAG_OK;
  CagOutline *o = t->out;
  CagStatus status = begin_part(t, p, along, q, err);
  if (!status && !CAG_RESERVE(o->sides, o->side_capacity, o->side_count + 1))
    status = cag_fail_memory(err);
  if (status) return status;
  o->sides[o->side_count++] = (CagSideLine){p, q, along};
  end_part(t, along, p);
  return CAG_OK;
}

// An arc with the signed radius (negative: to the right), from the point in the unit direction, by
// the angle.
static CagStatus put_arc(Trace *t, CagVec3 from, CagVec3 direction, double radius, double turn,
                         CagError *err) {
  const CagVec3 center = cag_madd(from, radius, left_of(direction));
  const int sense = radius > 0 ? 1 : -1, parts = (int)ceil(turn / (M_PI / 2)) + 1;
  CagVec3 before = from, d = direction;
  for (int i = 1; i <= parts; i++) {
    double s, c;
    cag_sincos(sense * turn * i / parts, &s, &c);
    const CagVec3 next = {c * direction.x - s * direction.y, s * direction.x + c * direction.y, 0};
    const CagVec3 to = cag_madd(center, -radius, left_of(next));
    CagStatus status = begin_part(t, before, d, to, err);
    if (!status) status = add_turn(t->out, center, radius, sense, d, next, err);
    if (status) return status;
    end_part(t, next, before);
    before = to;
    d = next;
  }
  return CAG_OK;
}

static CagStatus put_step(void *context, const CagArcStep *step, CagError *err) {
  Trace *t = context;
  return isinf(step->radius)
             ? put_side(t, step->from, step->to, err)
             : put_arc(t, step->from, step->direction, step->radius, step->turn, err);
}

// --- Loops ---

static CagStatus put_bent(Trace *t, const CagCurve *c, CagError *err) {
  CagVec3 center, x, y;
  double rate;
  if (cag_curve_arc_axes(c, &center, &x, &y, &rate)) {
    const double r = cag_norm(x);
    if (fabs(cag_norm(y) - r) <= CAG_ROUNDING * r && fabs(cag_dot(x, y)) <= CAG_ROUNDING * r * r) {
      CagVec3 from, u;
      CagStatus status = cag_curve_point(c, c->start, &from, err);
      if (!status) status = cag_curve_tangent(c, c->start, CAG_SIDE_RIGHT, &u, err);
      const double sense = rate * cag_cross(x, y).z > 0 ? 1 : -1;
      return status ? status
                    : put_arc(t, from, u, sense * r, fabs(rate) * (c->end - c->start), err);
    }
  }
  t->near = true;
  return cag_curve_arcs(c, t->tolerance, put_step, t, err);
}

void cag_outline_free(CagOutline *o) {
  cag_free(o->bends);
  cag_free(o->sides);
  *o = (CagOutline){0};
}

CagStatus cag_outline_of(const CagCurve *loop, double tolerance, CagOutline *out, bool *near,
                         CagError *err) {
  CagRuns runs;
  *out = (CagOutline){0};
  CagStatus status = cag_runs_of(loop, &runs, err);
  if (status) return status;
  Trace t = {.out = out, .tolerance = tolerance};
  for (size_t i = 0; !status && i < runs.n; i++) {
    const CagRun *run = &runs.items[i];
    if (run->bent) status = put_bent(&t, run->bent, err);
    for (size_t k = 0; !status && k + 1 < run->n; k++)
      status = put_side(&t, run->vertices[k], run->vertices[k + 1], err);
  }
  cag_runs_free(&runs);
  if (!status && t.started)
    status = add_corner(&t, t.first_point, t.last_direction, t.first_direction, t.last_before,
                        t.first_beyond, err);
  *near = *near || t.near;
  if (status) cag_outline_free(out);
  return status;
}
