// Balls and turns at corners (see roll_corner.h).

#include "geom/solid/roll_corner.h"

#include <math.h>

#include "base/array.h"
#include "base/stop.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/roll_pivot.h"

// Steps of Newton's method for the point of an edge whose section has the center of the ball, and
// for the nearest point of a carrier without a closed form.
#define STEPS 100
// Edges end beyond the section of the ball by this fraction of the rest.
#define BEYOND 0.5

// The ends of rounded edges at a corner, and what is known of all edges there.
typedef struct Ends {
  CagRollTip tips[CAG_ROLL_VALENCE];
  size_t count;         // of tips, which may be more than there is room for
  size_t sharp;         // ends of edges that are not smooth
  bool convex, concave; // among the rounded ones
  bool flat, several_radii;
} Ends;

static double tip_size(const CagRollPlan *p, CagRollTip tip) {
  return p->picks[tip.pick].e.size[tip.end][0];
}

static void collect_ends(const CagRollPlan *p, size_t part, size_t corner, Ends *out) {
  const CagRollPart *all = &p->parts[part];
  *out = (Ends){0};
  for (size_t e = 0; e < all->b->edge_count; e++)
    if (all->bends[e] != CAG_ROLL_SMOOTH)
      out->sharp += (size_t)(all->b->edges[e].from == corner) + (all->b->edges[e].to == corner);
  for (size_t i = 0; i < p->pick_count; i++)
    for (int end = 0; end < 2; end++) {
      const CagRollPick *pick = &p->picks[i];
      if (pick->part != part || pick->corner[end] != corner || pick->closed) continue;
      const CagRollTip tip = {i, end};
      if (out->count < CAG_ROLL_VALENCE) out->tips[out->count] = tip;
      out->count++;
      *(pick->e.convex ? &out->convex : &out->concave) = true;
      out->flat = out->flat || pick->e.flat;
      const double size = tip_size(p, tip), first = tip_size(p, out->tips[0]);
      if (fabs(size - first) > CAG_COINCIDENT * first) out->several_radii = true;
    }
}

static CagStatus corner_fail(const CagRollPlan *p, size_t part, size_t corner, const char *why,
                             CagError *err) {
  const CagVec3 at = p->parts[part].b->corners[corner];
  return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_boundary, "", -1,
                  "%s meet at [%.6g, %.6g, %.6g]", why, at.x, at.y, at.z);
}

// Puts the edges in the order in which they are passed around the corner, and finds their faces:
// edge i is between faces[i] and faces[i + 1]. Returns false if they do not form one cycle.
static bool order_ends(const CagRollPlan *p, Ends *ends, size_t faces[CAG_ROLL_VALENCE]) {
  for (size_t i = 0; i < ends->count; i++) {
    if (i == 0) faces[0] = p->picks[ends->tips[0].pick].e.sides[0].face;
    bool found = false;
    for (size_t k = i; !found && k < ends->count; k++) {
      const CagRollTip tip = ends->tips[k];
      const CagRollSide *sides = p->picks[tip.pick].e.sides;
      for (int j = 0; !found && j < 2; j++) {
        if (sides[j].face != faces[i]) continue;
        found = true;
        ends->tips[k] = ends->tips[i];
        ends->tips[i] = tip;
        if (i + 1 < ends->count) faces[i + 1] = sides[1 - j].face;
        else if (sides[1 - j].face != faces[0]) return false;
      }
    }
    if (!found) return false;
  }
  return true;
}

// The faces at the corner, in the order of `faces`.
static CagStatus corner_faces(const CagRollPlan *p, CagRollBall *ball, const size_t *faces,
                              CagRollMeeting *out, bool *all, CagError *err) {
  CagRollMeeting met[2 * CAG_ROLL_VALENCE];
  size_t n;
  CagStatus status =
      cag_roll_meetings(&p->parts[ball->part], ball->corner, met, 2 * CAG_ROLL_VALENCE, &n, err);
  if (status) return status;
  *all = n <= 2 * (size_t)CAG_ROLL_VALENCE;
  for (size_t i = 0; *all && i < ball->count; i++) {
    bool found = false;
    for (size_t k = 0; k < n; k++)
      if (met[k].side.face == faces[i]) {
        out[i] = met[k];
        found = true;
      }
    *all = found;
  }
  return CAG_OK;
}

// The ball that touches three faces must touch all of them. The normals at the contacts and at the
// corner are toward the side of the ball.
static CagStatus touch_faces(CagRollBall *ball, CagRollMeeting *faces, bool *fits, bool *touches,
                             CagError *err) {
  const CagRollSide *three[3];
  double at[3][2];
  for (int i = 0; i < 3; i++) {
    three[i] = &faces[i].side;
    at[i][0] = faces[i].uv[0], at[i][1] = faces[i].uv[1];
  }
  *touches = true;
  CagStatus status = cag_roll_corner(three, (const double(*)[2])at, ball->radius, ball->convex,
                                     &ball->center, fits, err);
  for (size_t i = 0; !status && *fits && i < ball->count; i++) {
    const CagRollMeeting *m = &faces[i];
    double uv[2] = {m->uv[0], m->uv[1]};
    CagVec3 normal;
    status = cag_carrier_normal(m->side.carrier, uv[0], uv[1], &normal, err);
    const double sign = ball->convex ? -1 : 1;
    ball->at_point[i] = cag_scaled(normal, sign * m->side.outward);
    const int steps = cag_carrier_is_analytic(m->side.carrier) ? 1 : STEPS;
    for (int k = 0; !status && k < steps; k++)
      status = cag_roll_foot(&m->side, ball->center, uv, &ball->contact[i], &normal, err);
    if (status) break;
    ball->toward[i] = cag_scaled(normal, sign);
    const double off = fabs(cag_norm(cag_sub(ball->center, ball->contact[i])) - ball->radius);
    *touches = *touches && off <= CAG_COINCIDENT * (ball->radius + cag_norm(ball->center));
  }
  return status;
}

CagStatus cag_roll_station(const CagRollPick *pick, int end, CagVec3 center, double *out,
                           bool *found, CagError *err) {
  const CagCurve *c = pick->e.curve;
  double t = end ? c->end : c->start;
  CagStatus status = CAG_OK;
  *found = false;
  for (int k = 0; !status && !*found && k < STEPS; k++) {
    CagVec3 d[2];
    status = cag_curve_eval(c, t, 1, t < c->end ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, d, err);
    if (status) break;
    const double step = cag_dot(cag_sub(center, d[0]), d[1]) / cag_dot(d[1], d[1]);
    const double next = fmin(fmax(t + step, c->start), c->end);
    *found = fabs(step) <= CAG_ROUNDING * (c->end - c->start);
    if (next == t && !*found) break; // beyond the other end
    t = next;
  }
  *out = t;
  return status;
}

static CagStatus add_stations(CagRollPlan *p, CagRollBall *ball, const Ends *ends,
                              const size_t *faces, CagError *err) {
  for (size_t i = 0; i < ball->count; i++) {
    const CagRollTip tip = ends->tips[i];
    CagRollPick *pick = &p->picks[tip.pick];
    CagRollSection s;
    bool fits;
    double t;
    const double corner = tip.end ? pick->e.curve->end : pick->e.curve->start;
    CagStatus status = cag_roll_station(pick, tip.end, ball->center, &t, &fits, err);
    if (!status && fits) {
      pick->ball[tip.end] = true;
      pick->station[tip.end] = t;
      pick->range[tip.end] = t + BEYOND * (corner - t);
      status = cag_roll_section(&pick->e, t, &s, &fits, err);
    }
    if (status) return status;
    if (!fits) {
      p->unfit = tip.pick;
      return CAG_OK;
    }
    const int left = pick->e.sides[0].face == faces[i] ? 0 : 1;
    ball->station[i] = s.edge;
    ball->before[i] = s.start[left];
    ball->after[i] = s.start[1 - left];
  }
  return CAG_OK;
}

static CagStatus add_ball(CagRollPlan *p, size_t part, size_t corner, Ends *ends, CagError *err) {
  size_t faces[CAG_ROLL_VALENCE];
  CagRollMeeting met[CAG_ROLL_VALENCE];
  bool whole = ends->count <= CAG_ROLL_VALENCE && order_ends(p, ends, faces), fits, touches;
  CagRollBall ball = {.part = part, .corner = corner, .convex = ends->convex};
  CagStatus status = CAG_OK;
  ball.pick = ends->tips[0].pick;
  ball.count = ends->count;
  ball.radius = tip_size(p, ends->tips[0]);
  ball.point = p->parts[part].b->corners[corner];
  if (whole) status = corner_faces(p, &ball, faces, met, &whole, err);
  if (status) return status;
  if (!whole) return corner_fail(p, part, corner, "too many faces", err);
  status = touch_faces(&ball, met, &fits, &touches, err);
  if (!status && fits && !touches)
    return corner_fail(p, part, corner, "faces that no ball touches", err);
  if (!status && !fits) p->unfit = ball.pick;
  if (!status && fits) status = add_stations(p, &ball, ends, faces, err);
  if (status || p->unfit != CAG_ROLL_NONE) return status;
  if (!CAG_RESERVE(p->balls, p->ball_room, p->ball_count + 1)) return cag_fail_memory(err);
  p->balls[p->ball_count++] = ball;
  return CAG_OK;
}

// Two rounded edges of one bend, at a corner whose third edge has the other one. The third edge may
// be rounded, too.
static CagStatus add_turn(CagRollPlan *p, size_t part, size_t corner, const Ends *ends, bool *done,
                          CagError *err) {
  CagRollTip tips[2], third = {CAG_ROLL_NONE, 0};
  size_t convex = 0, n = 0;
  *done = false;
  if (ends->sharp != 3 || ends->count > 3) return CAG_OK;
  for (size_t i = 0; i < ends->count; i++) convex += p->picks[ends->tips[i].pick].e.convex ? 1 : 0;
  const bool most = convex >= 2;
  if (!most && ends->count - convex < 2) return CAG_OK;
  for (size_t i = 0; i < ends->count; i++) {
    if (p->picks[ends->tips[i].pick].e.convex != most) third = ends->tips[i];
    else if (n < 2) tips[n++] = ends->tips[i];
  }
  if (n != 2 || (ends->count == 3 && third.pick == CAG_ROLL_NONE)) return CAG_OK;
  return cag_roll_add_pivot(p, part, corner, tips, third, done, err);
}

static CagStatus round_corner(CagRollPlan *p, size_t part, size_t corner, CagError *err) {
  Ends ends;
  bool done;
  collect_ends(p, part, corner, &ends);
  if (ends.count < 2) return CAG_OK;
  CagStatus status = add_turn(p, part, corner, &ends, &done, err);
  if (status || done) return status;
  if (ends.convex && ends.concave)
    return corner_fail(p, part, corner, "convex and concave edges that are rounded", err);
  if (ends.count < 3 || ends.count != ends.sharp || ends.flat) return CAG_OK;
  if (ends.several_radii)
    return corner_fail(p, part, corner, "edges that are rounded with different radii", err);
  return add_ball(p, part, corner, &ends, err);
}

CagStatus cag_roll_balls(CagRollPlan *p, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t part = 0; !status && part < p->part_count; part++)
    for (size_t c = 0; !status && c < p->parts[part].b->corner_count; c++) {
      status = cag_stop_check(err);
      if (!status) status = round_corner(p, part, c, err);
      if (p->unfit != CAG_ROLL_NONE) return status;
    }
  for (size_t i = 0; !status && i < p->pick_count && p->unfit == CAG_ROLL_NONE; i++) {
    const CagRollPick *pick = &p->picks[i];
    const double over = pick->station[0] - pick->station[1];
    if (over > CAG_COINCIDENT * (pick->e.curve->end - pick->e.curve->start)) p->unfit = i;
  }
  return status;
}
