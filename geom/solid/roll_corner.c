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
// Edges continue each other smoothly if their tangents differ by less, in radians (as in roll_plan.c).
#define SMOOTH_JOINT 1e-2
// The radius of a zone, as a multiple of how far the contacts are from the edges, ...
#define ZONE 1.8
// ... which is at least and at most this multiple of the radius.
#define REACH_LEAST 0.7
#define REACH_MOST 6
// The largest turn of the normals across an edge that counts.
#define STEEPEST 3.0
// Edges end within a zone at this fraction of its radius, found in this many steps along the edge.
#define WITHIN 0.75
#define MARCH 32
// Where the section of an edge is taken that tells the size of a zone, as a fraction of the edge.
#define ALONG 0.02

// The ends of rounded edges at a corner, and what is known of all edges there.
typedef struct Ends {
  CagRollTip tips[CAG_ROLL_VALENCE];
  size_t count;      // of tips, which may be more than there is room for
  size_t sharp;      // ends of edges that are not smooth
  size_t of_bend[2]; // of these, the convex and the concave ones
  size_t rounded[2]; // likewise, of the rounded ones
  bool flat, several_radii;
} Ends;

static double tip_size(const CagRollPlan *p, CagRollTip tip) {
  return p->picks[tip.pick].e.size[tip.end][0];
}

static void collect_ends(const CagRollPlan *p, size_t part, size_t corner, Ends *out) {
  const CagRollPart *all = &p->parts[part];
  *out = (Ends){0};
  for (size_t e = 0; e < all->b->edge_count; e++)
    if (all->bends[e] != CAG_ROLL_SMOOTH) {
      const size_t ends =
          (size_t)(all->b->edges[e].from == corner) + (all->b->edges[e].to == corner);
      out->sharp += ends;
      out->of_bend[all->bends[e] == CAG_ROLL_CONCAVE] += ends;
    }
  for (size_t i = 0; i < p->pick_count; i++)
    for (int end = 0; end < 2; end++) {
      const CagRollPick *pick = &p->picks[i];
      if (pick->part != part || pick->corner[end] != corner || pick->closed) continue;
      const CagRollTip tip = {i, end};
      if (out->count < CAG_ROLL_VALENCE) out->tips[out->count] = tip;
      out->count++;
      out->rounded[!pick->e.convex]++;
      out->flat = out->flat || pick->e.flat;
      const double size = tip_size(p, tip), first = tip_size(p, out->tips[0]);
      if (fabs(size - first) > CAG_COINCIDENT * first) out->several_radii = true;
    }
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

// *fits: false if an edge has no section there.
static CagStatus add_stations(CagRollPlan *p, CagRollBall *ball, const Ends *ends,
                              const size_t *faces, bool *all, CagError *err) {
  double stations[CAG_ROLL_VALENCE];
  *all = true;
  for (size_t i = 0; *all && i < ball->count; i++) {
    const CagRollTip tip = ends->tips[i];
    const CagRollPick *pick = &p->picks[tip.pick];
    CagRollSection s;
    CagStatus status = cag_roll_station(pick, tip.end, ball->center, &stations[i], all, err);
    if (!status && *all) status = cag_roll_section(&pick->e, stations[i], &s, all, err);
    if (status) return status;
    if (!*all) break;
    const int left = pick->e.sides[0].face == faces[i] ? 0 : 1;
    ball->station[i] = s.edge;
    ball->before[i] = s.start[left];
    ball->after[i] = s.start[1 - left];
  }
  for (size_t i = 0; *all && i < ball->count; i++) {
    const CagRollTip tip = ends->tips[i];
    CagRollPick *pick = &p->picks[tip.pick];
    const double corner = tip.end ? pick->e.curve->end : pick->e.curve->start;
    pick->ball[tip.end] = true;
    pick->station[tip.end] = stations[i];
    pick->range[tip.end] = stations[i] + BEYOND * (corner - stations[i]);
  }
  return CAG_OK;
}

// *done: false if no ball touches all faces, between the ends of the edges. Sets `unfit` if it would
// be smaller, and nothing else may be made of the corner.
static CagStatus add_ball(CagRollPlan *p, size_t part, size_t corner, Ends *ends, bool *done,
                          CagError *err) {
  size_t faces[CAG_ROLL_VALENCE];
  CagRollMeeting met[CAG_ROLL_VALENCE];
  bool whole = ends->count <= CAG_ROLL_VALENCE && order_ends(p, ends, faces), fits, touches;
  CagRollBall ball = {.part = part, .corner = corner, .convex = ends->rounded[0] > 0};
  CagStatus status = CAG_OK;
  *done = false;
  ball.pick = ends->tips[0].pick;
  ball.count = ends->count;
  ball.radius = tip_size(p, ends->tips[0]);
  ball.point = p->parts[part].b->corners[corner];
  if (whole) status = corner_faces(p, &ball, faces, met, &whole, err);
  if (status || !whole) return status;
  status = touch_faces(&ball, met, &fits, &touches, err);
  if (!status && fits && !touches) return CAG_OK;
  if (!status && fits) status = add_stations(p, &ball, ends, faces, done, err);
  if (!status && !*done && p->corners == CAG_ROLL_BALLS) p->unfit = ball.pick;
  if (status || !*done) return status;
  if (!CAG_RESERVE(p->balls, p->ball_room, p->ball_count + 1)) return cag_fail_memory(err);
  p->balls[p->ball_count++] = ball;
  return CAG_OK;
}

// --- Zones ---

// How far the ball's contacts are from the corner end of an edge whose faces are nearly flat.
static CagStatus tip_reach(const CagRollPlan *p, CagRollTip tip, double *out, CagError *err) {
  const CagRollPick *pick = &p->picks[tip.pick];
  const CagCurve *c = pick->e.curve;
  const double t = c->start + (c->end - c->start) * (tip.end ? 1 - ALONG : ALONG);
  CagRollSection s = {0};
  bool fits;
  CagStatus status = cag_roll_section(&pick->e, t, &s, &fits, err);
  if (status) return status;
  const double turn = acos(fmin(1, fmax(-1, cag_dot(s.start[0], s.start[1]))));
  *out = tip_size(p, tip) * fmin(tan(fmin(turn, STEEPEST) / 2), REACH_MOST);
  return CAG_OK;
}

// Lets an edge end within the zone about its end: at the first point that is far enough from it.
static CagStatus enter_zone(CagRollPlan *p, CagRollTip tip, CagVec3 point, double reach,
                            CagError *err) {
  CagRollPick *pick = &p->picks[tip.pick];
  const CagCurve *c = pick->e.curve;
  const double from = tip.end ? c->end : c->start, to = tip.end ? c->start : c->end;
  double low = 0, high = 0;
  CagStatus status = CAG_OK;
  for (int k = 1; k <= MARCH + STEPS / 2; k++) {
    const double at = k <= MARCH ? (double)k / MARCH : (low + high) / 2;
    CagVec3 q;
    if (k <= MARCH && high > 0) continue;
    status = cag_curve_point(c, from + at * (to - from), &q, err);
    if (status) return status;
    *(cag_norm(cag_sub(q, point)) >= WITHIN * reach ? &high : &low) = at;
    if (k == MARCH && high == 0) break;
  }
  pick->ball[tip.end] = true;
  pick->station[tip.end] = pick->range[tip.end] =
      high > 0 ? from + high * (to - from) : to + (to - from);
  return CAG_OK;
}

static void drop_balls(CagRollPlan *p, size_t part, size_t corner) {
  size_t kept = 0;
  for (size_t i = 0; i < p->pick_count; i++)
    for (int end = 0; end < 2; end++) {
      CagRollPick *pick = &p->picks[i];
      if (pick->part != part || pick->corner[end] != corner || pick->closed) continue;
      pick->ball[end] = false;
      pick->station[end] = pick->range[end] = end ? pick->e.curve->end : pick->e.curve->start;
    }
  for (size_t i = 0; i < p->ball_count; i++)
    if (p->balls[i].part != part || p->balls[i].corner != corner) p->balls[kept++] = p->balls[i];
  p->ball_count = kept;
}

// Whether all faces at a corner are planes: offsets of others take long.
static CagStatus corner_is_flat(const CagRollPlan *p, size_t part, size_t corner, bool *out,
                                CagError *err) {
  CagRollMeeting met[2 * CAG_ROLL_VALENCE];
  size_t n;
  CagStatus status = cag_roll_meetings(&p->parts[part], corner, met, 2 * CAG_ROLL_VALENCE, &n, err);
  *out = !status && n <= 2 * (size_t)CAG_ROLL_VALENCE;
  for (size_t i = 0; *out && i < n; i++) *out = met[i].side.carrier->kind == CAG_CARRIER_PLANE;
  return status;
}

// Rounds the edges at a corner within a zone, of each bend all of whose edges there are rounded. The
// others end as at other corners.
static CagStatus add_zones(CagRollPlan *p, size_t part, size_t corner, const Ends *ends,
                           CagError *err) {
  double reach[2] = {0, 0}, radius[2] = {INFINITY, INFINITY}, most[2] = {0, 0};
  size_t pick[2] = {CAG_ROLL_NONE, CAG_ROLL_NONE};
  const CagVec3 point = p->parts[part].b->corners[corner];
  bool flat;
  CagStatus done = corner_is_flat(p, part, corner, &flat, err);
  drop_balls(p, part, corner);
  if (done || !flat || p->corners != CAG_ROLL_ZONES || ends->flat || ends->count > CAG_ROLL_VALENCE)
    return done;
  for (size_t i = 0; i < ends->count; i++) {
    const CagRollTip tip = ends->tips[i];
    const int bend = p->picks[tip.pick].e.convex ? 0 : 1;
    double own;
    CagStatus status = tip_reach(p, tip, &own, err);
    if (status) return status;
    own = fmax(own, tip_size(p, tip) * REACH_LEAST);
    reach[bend] = fmax(reach[bend], own);
    most[bend] += own * own;
    radius[bend] = fmin(radius[bend], tip_size(p, tip));
    pick[bend] = tip.pick;
  }
  const double whole = ZONE * (reach[0] + reach[1]) + 4 * p->tolerance;
  for (int bend = 1; bend >= 0; bend--) { // concave ones first
    if (ends->rounded[bend] == 0 || ends->rounded[bend] != ends->of_bend[bend]) continue;
    for (size_t i = 0; i < ends->count; i++) {
      if (p->picks[ends->tips[i].pick].e.convex != (bend == 0)) continue;
      CagStatus status = enter_zone(p, ends->tips[i], point, whole, err);
      if (status) return status;
    }
    if (!CAG_RESERVE(p->zones, p->zone_room, p->zone_count + 1)) return cag_fail_memory(err);
    p->zones[p->zone_count++] = (CagRollZone){part,
                                              corner,
                                              pick[bend],
                                              bend == 0,
                                              radius[bend],
                                              whole,
                                              most[bend] * whole + 10 * pow(radius[bend], 3),
                                              point};
  }
  return CAG_OK;
}

// Whether the only two sharp edges at a corner continue each other.
static CagStatus ends_continue(const CagRollPlan *p, const Ends *ends, bool *out, CagError *err) {
  CagVec3 leaving[2];
  CagStatus status = CAG_OK;
  *out = false;
  if (ends->count != 2 || (ends->rounded[0] > 0 && ends->rounded[1] > 0)) return CAG_OK;
  for (int k = 0; !status && k < 2; k++)
    status = cag_roll_leaving(&p->picks[ends->tips[k].pick], ends->tips[k].end, &leaving[k], err);
  if (!status) *out = cag_norm(cag_add(leaving[0], leaving[1])) <= SMOOTH_JOINT;
  return status;
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
  CagStatus status = ends_continue(p, &ends, &done, err);
  if (!status && !done) status = add_turn(p, part, corner, &ends, &done, err);
  if (status || done) return status;
  const bool one_bend = ends.rounded[0] == 0 || ends.rounded[1] == 0;
  if (one_bend && ends.count >= 3 && ends.count == ends.sharp && !ends.flat && !ends.several_radii)
    status = add_ball(p, part, corner, &ends, &done, err);
  // The bodies of the edges of a convex corner reach beyond the solid.
  if (status || done) return status;
  return add_zones(p, part, corner, &ends, err);
}

// Balls at the ends of an edge that pass each other are replaced by zones, which may cover it.
static CagStatus check_order(CagRollPlan *p, CagError *err) {
  bool changed = true;
  CagStatus status = CAG_OK;
  while (!status && changed && p->corners != CAG_ROLL_BALLS) {
    changed = false;
    for (size_t i = 0; !status && i < p->ball_count; i++) {
      const CagRollBall ball = p->balls[i];
      Ends ends;
      bool passed = false;
      collect_ends(p, ball.part, ball.corner, &ends);
      for (size_t k = 0; k < ends.count; k++) {
        const CagRollPick *pick = &p->picks[ends.tips[k].pick];
        passed = passed || pick->station[0] > pick->station[1];
      }
      if (!passed) continue;
      changed = true;
      status = add_zones(p, ball.part, ball.corner, &ends, err);
      break;
    }
  }
  for (size_t i = 0; !status && i < p->pick_count; i++) {
    CagRollPick *pick = &p->picks[i];
    if (!(pick->station[0] > pick->station[1])) continue;
    pick->zoned = p->corners == CAG_ROLL_ZONES && pick->ball[0] && pick->ball[1];
    if (!pick->zoned) p->unfit = i;
  }
  return status;
}

CagStatus cag_roll_balls(CagRollPlan *p, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t part = 0; !status && part < p->part_count; part++)
    for (size_t c = 0; !status && c < p->parts[part].b->corner_count; c++) {
      status = cag_stop_check(err);
      if (!status) status = round_corner(p, part, c, err);
      if (p->unfit != CAG_ROLL_NONE) return status;
    }
  return status ? status : check_order(p, err);
}
