// Faces in the parameters of their carriers (see outline.h).

#include "geom/boundary/outline.h"

#include <math.h>
#include <stdint.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/carrier.h"

// Steps of an edge between its breaks, and of one without breaks.
#define STEPS 8
#define STEPS_WHOLE 64
// Halvings that find where an edge crosses a line.
#define HALVINGS 50
// Parameters may leave the box of the loops by this fraction of it.
#define BESIDE 1e-9

#define TURN (2 * M_PI)

static CagStatus add_step(CagFaceOutline *o, const CagOutlineStep *step, CagError *err) {
  if (!CAG_RESERVE(o->steps, o->room, o->count + 1)) return cag_fail_memory(err);
  o->steps[o->count++] = *step;
  for (int k = 0; k < 2; k++) {
    o->box[2 * k] = fmin(o->box[2 * k], fmin(step->from[k], step->to[k]));
    o->box[2 * k + 1] = fmax(o->box[2 * k + 1], fmax(step->from[k], step->to[k]));
  }
  return CAG_OK;
}

// Adds an edge, which starts at the end of the last step, or starts a loop.
static CagStatus add_use(CagFaceOutline *o, size_t use, bool first, CagError *err) {
  CagEdgePath path;
  CagStatus status = cag_edge_path(o->boundary, o->face, &o->boundary->uses[use], &path, err);
  if (status) return status;
  const CagCurve *curve = path.curve ? path.curve : path.trace;
  const size_t breaks = curve->kind->breaks ? curve->kind->breaks(curve, NULL, 0) : 0;
  const size_t n = path.straight ? 1 : breaks > STEPS ? STEPS * (breaks + 1) : STEPS_WHOLE;
  double at[2], next[2], rates[2];
  double t = path.reversed ? path.end : path.start;
  status = cag_edge_path_eval(&path, t, at, rates, err);
  if (!status && !first) {
    const CagOutlineStep *last = &o->steps[o->count - 1];
    const CagOutlineStep gap = {{last->to[0], last->to[1]}, {at[0], at[1]}, SIZE_MAX, 0, 0};
    status = add_step(o, &gap, err);
  }
  for (size_t i = 1; !status && i <= n; i++) {
    const double f = (double)i / (double)n, along = path.reversed ? 1 - f : f;
    const double to = path.start + along * (path.end - path.start);
    status = cag_edge_path_eval(&path, to, next, rates, err);
    const CagOutlineStep step = {
        {at[0], at[1]}, {next[0], next[1]}, path.straight ? SIZE_MAX : use, t, to};
    if (!status) status = add_step(o, &step, err);
    at[0] = next[0], at[1] = next[1];
    t = to;
  }
  return status;
}

static CagStatus add_loop(CagFaceOutline *o, const CagBoundaryLoop *loop, CagError *err) {
  const size_t first = o->count;
  CagStatus status = cag_stop_check(err);
  for (size_t u = 0; !status && u < loop->count; u++)
    status = add_use(o, loop->first + u, u == 0, err);
  if (status || o->count == first) return status;
  const CagOutlineStep *a = &o->steps[first], *b = &o->steps[o->count - 1];
  const CagOutlineStep gap = {{b->to[0], b->to[1]}, {a->from[0], a->from[1]}, SIZE_MAX, 0, 0};
  return add_step(o, &gap, err);
}

CagStatus cag_face_outline(const CagBoundary *b, size_t face, CagFaceOutline *out, CagError *err) {
  CagFaceOutline o = {
      .boundary = b, .face = &b->faces[face], .box = {INFINITY, -INFINITY, INFINITY, -INFINITY}};
  CagStatus status = CAG_OK;
  for (size_t l = o.face->first; !status && l < o.face->first + o.face->count; l++)
    status = add_loop(&o, &b->loops[l], err);
  if (status) cag_face_outline_free(&o);
  else *out = o;
  return status;
}

void cag_face_outline_free(CagFaceOutline *o) {
  cag_free(o->steps);
  *o = (CagFaceOutline){0};
}

// Where the edge of a step crosses the line of this v.
static CagStatus edge_crossing(const CagFaceOutline *o, const CagOutlineStep *s, double v,
                               double *u, CagError *err) {
  CagEdgePath path;
  double lo = s->start, hi = s->last, uv[2] = {s->from[0], 0}, rates[2];
  const bool up = s->from[1] <= v;
  CagStatus status = cag_edge_path(o->boundary, o->face, &o->boundary->uses[s->use], &path, err);
  for (int i = 0; !status && i < HALVINGS; i++) {
    const double middle = lo + (hi - lo) / 2;
    status = cag_edge_path_eval(&path, middle, uv, rates, err);
    if ((uv[1] <= v) == up) lo = middle;
    else hi = middle;
  }
  *u = uv[0];
  return status;
}

// Counts crossings with the ray from the point to larger u.
static CagStatus within_loops(const CagFaceOutline *o, double u, double v, bool *out,
                              CagError *err) {
  *out = false;
  for (size_t i = 0; i < o->count; i++) {
    const CagOutlineStep *s = &o->steps[i];
    if ((s->from[1] <= v) == (s->to[1] <= v)) continue;
    const double f = (v - s->from[1]) / (s->to[1] - s->from[1]);
    double at = s->from[0] + f * (s->to[0] - s->from[0]);
    // A chord is off by less than its length.
    const double length = fabs(s->to[0] - s->from[0]) + fabs(s->to[1] - s->from[1]);
    if (s->use != SIZE_MAX && fabs(at - u) < length) {
      CagStatus status = edge_crossing(o, s, v, &at, err);
      if (status) return status;
    }
    if (at > u) *out = !*out;
  }
  return CAG_OK;
}

// The values of a parameter that differ by periods and are within the box: the first one, and their
// number.
static size_t period_values(const CagFaceOutline *o, int direction, double value, double *first) {
  const double lo = o->box[2 * direction], hi = o->box[2 * direction + 1];
  const double slack = BESIDE * (hi - lo);
  *first = value;
  if (!cag_carrier_is_periodic(&o->face->carrier, direction)) return 1;
  const double down = ceil((lo - slack - value) / TURN), up = floor((hi + slack - value) / TURN);
  *first = value + TURN * down;
  return up >= down ? (size_t)(up - down) + 1 : 0;
}

CagStatus cag_face_outline_has(const CagFaceOutline *o, double uv[2], bool *out, CagError *err) {
  double u, v;
  const size_t nu = period_values(o, 0, uv[0], &u), nv = period_values(o, 1, uv[1], &v);
  *out = false;
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j < nv; j++) {
      const double at = u + TURN * (double)i, to = v + TURN * (double)j;
      CagStatus status = within_loops(o, at, to, out, err);
      if (status) return status;
      if (!*out) continue;
      uv[0] = at, uv[1] = to;
      return CAG_OK;
    }
  return CAG_OK;
}
