// Turns of the ball about an edge of the opposite bend (see roll_pivot.h).

#include "geom/solid/roll_pivot.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/roll_body.h"
#include "geom/solid/roll_corner.h"

// Faces whose normals have a smaller sine are parallel.
#define PARALLEL 1e-6
// Steps of Newton's method.
#define STEPS 100

static bool is_line(const CagCurve *c) {
  CagNurbsView view;
  return strcmp(c->kind->name, "line") == 0 ||
         (cag_curve_nurbs_view(c, &view) && view.degree == 1 && view.count == 2);
}

// The third sharp edge of the corner, and its number of sharp ends there.
static size_t third_edge(const CagRollPlan *p, size_t part, size_t corner,
                         const CagRollTip tips[2]) {
  const CagRollPart *all = &p->parts[part];
  size_t found = CAG_ROLL_NONE, ends = 0;
  for (size_t e = 0; e < all->b->edge_count; e++) {
    if (all->bends[e] == CAG_ROLL_SMOOTH) continue;
    const size_t here =
        (size_t)(all->b->edges[e].from == corner) + (size_t)(all->b->edges[e].to == corner);
    ends += here;
    if (here == 1 && e != p->picks[tips[0].pick].edge && e != p->picks[tips[1].pick].edge)
      found = e;
  }
  return ends == 3 ? found : CAG_ROLL_NONE;
}

// The side of each edge on the face that both have, which is left by `at`. Returns false if there
// is none, or several.
static bool shared_side(const CagRollEdge *a, const CagRollEdge *b, int at[2]) {
  int found = 0;
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 2; k++)
      if (a->sides[i].face == b->sides[k].face) {
        at[0] = i, at[1] = k;
        found++;
      }
  return found == 1;
}

static CagVec3 plane_toward(const CagRollEdge *e, int side) {
  const CagVec3 normal = cag_frame_column(&e->sides[side].carrier->frame, 2);
  return cag_scaled(normal, e->sides[side].outward * (e->convex ? -1 : 1));
}

// The point whose distances from the planes through `point` with these normals are given.
static bool meeting_point(CagVec3 point, const CagVec3 normals[3], const double distances[3],
                          CagVec3 *out) {
  const CagVec3 c0 = cag_cross(normals[1], normals[2]), c1 = cag_cross(normals[2], normals[0]);
  const CagVec3 c2 = cag_cross(normals[0], normals[1]);
  const double det = cag_dot(normals[0], c0);
  if (!(fabs(det) > PARALLEL)) return false;
  const CagVec3 sum =
      cag_madd(cag_madd(cag_scaled(c0, distances[0]), distances[1], c1), distances[2], c2);
  *out = cag_madd(point, 1 / det, sum);
  return true;
}

// The axis of a turn about the third edge or its fillet.
static bool pivot_axis(CagRollPivot *v) {
  const CagVec3 normals[3] = {v->toward[0], v->toward[1], v->along};
  const double distances[3] = {-v->inner, -v->inner, 0};
  return fabs(cag_dot(v->along, v->face)) > PARALLEL &&
         meeting_point(v->point, normals, distances, &v->axis);
}

// The point of the line through `from` along the axis at a distance from F, with the nearest point
// of F and its normal there. *found: false if there is none.
static CagStatus point_off_face(const CagRollPivot *v, CagVec3 from, double distance, CagVec3 *out,
                                CagVec3 *foot, CagVec3 *toward, bool *found, CagError *err) {
  double uv[2] = {v->uv[0], v->uv[1]}, moved = INFINITY;
  CagVec3 at = from;
  CagStatus status = CAG_OK;
  *found = false;
  for (int k = 0; !status && !*found && k < STEPS; k++) {
    CagVec3 normal;
    status = cag_roll_foot(&v->base, at, uv, foot, &normal, err);
    if (status) break;
    *toward = cag_scaled(normal, v->sign);
    const double slope = cag_dot(v->along, *toward);
    if (fabs(slope) < PARALLEL) return CAG_OK;
    const double step = (distance - cag_dot(cag_sub(at, *foot), *toward)) / slope;
    *found = k > 0 && fabs(step) + fabs(moved) <= CAG_COINCIDENT * (v->inner + v->radius);
    at = cag_madd(at, step, v->along);
    moved = step;
  }
  *out = at;
  return status;
}

// The place of the ball at the fraction t of the turn from the first edge to the second.
typedef struct Place {
  CagVec3 outward;                 // from the axis to the ball
  CagVec3 center, contact, toward; // on F
  CagVec3 foot, foot_toward;       // where the edge between F and the fillet about the axis is
  bool found;
} Place;

static CagStatus place_at(const CagRollPivot *v, double t, Place *out, CagError *err) {
  Place p = {.outward = cag_roll_arc_direction(v->toward[0], v->toward[1], t)};
  const CagVec3 far = cag_madd(v->axis, v->inner + v->radius, p.outward);
  const CagVec3 near = cag_madd(v->axis, v->inner, p.outward);
  CagVec3 nearest;
  bool on_face = true;
  CagStatus status =
      point_off_face(v, far, v->radius, &p.center, &p.contact, &p.toward, &p.found, err);
  if (v->inner > 0) {
    if (!status)
      status = point_off_face(v, near, 0, &p.foot, &nearest, &p.foot_toward, &on_face, err);
  } else {
    p.foot = v->point;
    p.foot_toward = v->face;
  }
  p.found = p.found && on_face;
  *out = p;
  return status;
}

// Lets the edge end where the turn begins.
static CagStatus set_range(CagRollPlan *p, CagRollPivot *v, int k, bool *possible, CagError *err) {
  CagRollPick *pick = &p->picks[v->tips[k].pick];
  const int end = v->tips[k].end;
  const double corner = end ? pick->e.curve->end : pick->e.curve->start;
  CagVec3 leaving;
  Place place = {.center = v->point};
  bool found = true;
  if (v->flat) return CAG_OK;
  CagStatus status = cag_roll_leaving(pick, end, &leaving, err);
  if (!status) status = place_at(v, k, &place, err);
  if (status) return status;
  const double offset = cag_dot(cag_sub(place.center, v->point), leaving);
  const double near = CAG_COINCIDENT * (v->radius + v->inner);
  double t = corner;
  v->beyond[k] = offset > near;
  if (offset < -near) status = cag_roll_station(pick, end, place.center, &t, &found, err);
  *possible = place.found && found && (is_line(pick->e.curve) || !v->beyond[k]);
  pick->range[end] = pick->station[end] = t;
  return status;
}

// The miter of chamfers: contacts that both edges share.
static bool miter(const CagRollPlan *p, CagRollPivot *v, const CagVec3 leaving[2],
                  const int at[2]) {
  CagVec3 into[2], across[2];
  double size[2][2];
  for (int k = 0; k < 2; k++) {
    const CagRollPick *pick = &p->picks[v->tips[k].pick];
    const CagVec3 other =
        cag_sub(leaving[1 - k], cag_scaled(leaving[k], cag_dot(leaving[1 - k], leaving[k])));
    into[k] = cag_unit(cag_cross(v->face, leaving[k]));
    // The faces are on the side opposite to the other edge, as the corner is wider than pi in F.
    if (cag_dot(into[k], other) < 0) into[k] = cag_scaled(into[k], -1);
    across[k] = cag_unit(cag_sub(v->along, cag_scaled(leaving[k], cag_dot(v->along, leaving[k]))));
    for (int j = 0; j < 2; j++)
      size[k][j] = pick->e.size[v->tips[k].end][j == 0 ? at[k] : 1 - at[k]];
  }
  const double one = size[0][1] / cag_dot(v->along, across[0]);
  const double two = size[1][1] / cag_dot(v->along, across[1]);
  const double bend = 1 + cag_dot(into[0], into[1]);
  const double least = fmin(size[0][0], size[0][1]);
  if (!(bend > PARALLEL) || v->inner > 0) return false;
  v->contact[0] = cag_madd(v->point, size[0][0] / bend, cag_add(into[0], into[1]));
  v->contact[1] = cag_madd(v->point, one, v->along);
  return fabs(one - two) <= CAG_COINCIDENT * least &&
         fabs(size[0][0] - size[1][0]) <= CAG_COINCIDENT * least;
}

// Fills in the planes of the turn. Returns false if the corner is of another kind.
static bool pivot_planes(const CagRollPlan *p, CagRollPivot *v, const CagRollEdge *third,
                         int at[2]) {
  const CagRollEdge *a = &p->picks[v->tips[0].pick].e, *b = &p->picks[v->tips[1].pick].e;
  if (!shared_side(a, b, at) || third->convex == a->convex || !is_line(third->curve)) return false;
  const CagRollSide *planes[2] = {&a->sides[1 - at[0]], &b->sides[1 - at[1]]};
  for (int k = 0; k < 2; k++)
    if (planes[k]->carrier->kind != CAG_CARRIER_PLANE) return false;
  v->side = at[0];
  v->base = a->sides[at[0]];
  v->sign = a->convex ? -1 : 1;
  v->toward[0] = plane_toward(a, 1 - at[0]);
  v->toward[1] = plane_toward(b, 1 - at[1]);
  const double size = a->size[v->tips[0].end][0], other = b->size[v->tips[1].end][0];
  v->flat = a->flat;
  v->radius = size;
  return v->flat || fabs(size - other) <= CAG_COINCIDENT * size;
}

// The parameters and the normal of F at the corner.
static CagStatus face_at_corner(const CagRollPlan *p, CagRollPivot *v, CagError *err) {
  const CagRollPick *pick = &p->picks[v->tips[0].pick];
  const CagCurve *c = pick->e.curve;
  CagVec3 normal;
  CagStatus status =
      cag_edge_path_eval(&v->base.path, v->tips[0].end ? c->end : c->start, v->uv, NULL, err);
  if (!status) status = cag_carrier_normal(v->base.carrier, v->uv[0], v->uv[1], &normal, err);
  if (!status) v->face = cag_scaled(normal, v->base.outward * v->sign);
  return status;
}

// The third edge's direction, away from the corner, and its length.
static CagStatus third_direction(CagRollPivot *v, const CagCurve *c, bool from_start,
                                 CagError *err) {
  CagVec3 d[2];
  CagStatus status = cag_curve_eval(c, c->start, 1, CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  v->along = cag_unit(cag_scaled(d[1], from_start ? 1 : -1));
  v->length = cag_norm(d[1]) * (c->end - c->start);
  return CAG_OK;
}

// Whether the ball's contacts on the third edge are within it, at the ends and in the middle.
static CagStatus contacts_within(const CagRollPivot *v, bool *within, CagError *err) {
  CagStatus status = CAG_OK;
  *within = true;
  for (int k = 0; !status && *within && k < 3; k++) {
    Place place;
    status = place_at(v, k / 2.0, &place, err);
    const double height = cag_dot(cag_sub(place.center, v->point), v->along);
    *within = place.found && height >= 0 && height <= v->length;
  }
  return status;
}

CagStatus cag_roll_add_pivot(CagRollPlan *p, size_t part, size_t corner, const CagRollTip tips[2],
                             CagRollTip third, bool *done, CagError *err) {
  const CagRollPart *all = &p->parts[part];
  const size_t edge = third_edge(p, part, corner, tips);
  CagRollPivot v = {.tips = {tips[0], tips[1]}, .third = third.pick};
  CagRollEdge e;
  CagVec3 leaving[2];
  int at[2];
  bool possible = true, within = true;
  *done = false;
  if (edge == CAG_ROLL_NONE) return CAG_OK;
  CagStatus status = cag_roll_edge(all, edge, &e, err);
  for (int k = 0; !status && k < 2; k++)
    status = cag_roll_leaving(&p->picks[tips[k].pick], tips[k].end, &leaving[k], err);
  if (!status && !pivot_planes(p, &v, &e, at)) return CAG_OK;
  if (!status) status = face_at_corner(p, &v, err);
  if (!status) status = third_direction(&v, e.curve, all->b->edges[edge].from == corner, err);
  if (status) return status;
  v.point = all->b->corners[corner];
  if (third.pick != CAG_ROLL_NONE) v.inner = p->picks[third.pick].e.size[third.end][0];
  if (!pivot_axis(&v) || (v.flat && !miter(p, &v, leaving, at))) return CAG_OK;
  for (int k = 0; !status && possible && k < 2; k++) status = set_range(p, &v, k, &possible, err);
  if (!status && possible && !v.flat) status = contacts_within(&v, &within, err);
  if (status || !possible || !within) return status;
  if (!CAG_RESERVE(p->pivots, p->pivot_room, p->pivot_count + 1)) return cag_fail_memory(err);
  p->pivots[p->pivot_count++] = v;
  for (int k = 0; k < 2; k++) p->picks[tips[k].pick].pivot[tips[k].end] = p->pivot_count;
  *done = true;
  return CAG_OK;
}

size_t cag_roll_pivot_parts(const CagRollPlan *p, const CagRollPivot *v) {
  if (v->flat) return 2;
  const double angle =
      atan2(cag_norm(cag_cross(v->toward[0], v->toward[1])), cag_dot(v->toward[0], v->toward[1]));
  return cag_roll_arc(2 * (v->inner + v->radius), angle, p->tolerance);
}

CagStatus cag_roll_pivot_section(const CagRollPivot *v, CagRollTip tip, double t,
                                 CagRollSection *out, bool *fits, CagError *err) {
  // Someone who comes from the second edge sees the sides exchanged.
  const bool first = tip.pick == v->tips[0].pick && tip.end == v->tips[0].end;
  const int side = v->tips[0].end == 1 ? v->side : 1 - v->side, on = first ? side : 1 - side;
  CagRollSection s = {.origin = tip.pick, .edge = v->point, .radius = v->flat ? 0 : v->radius};
  Place place = {.outward = cag_roll_arc_direction(v->toward[0], v->toward[1], first ? t : 1 - t)};
  CagStatus status = CAG_OK;
  *fits = true;
  s.pointed[1 - on] = !v->flat && !(v->inner > 0);
  s.into = cag_scaled(cag_unit(cag_add(v->toward[0], v->toward[1])), -1);
  s.start[1 - on] = s.toward[1 - on] = place.outward;
  if (v->flat) {
    s.start[on] = s.toward[on] = v->face;
    s.contact[on] = v->contact[0];
    s.contact[1 - on] = v->contact[1];
  } else {
    status = place_at(v, first ? t : 1 - t, &place, err);
    *fits = place.found;
    s.center = place.center;
    s.contact[on] = place.contact;
    s.toward[on] = place.toward;
    s.start[on] = place.foot_toward;
    s.contact[1 - on] = cag_madd(s.center, -v->radius, place.outward);
    s.edge = place.foot;
    s.bulge = v->base.carrier->kind == CAG_CARRIER_PLANE
                  ? 0
                  : fabs(cag_dot(cag_sub(s.contact[on], s.edge), s.toward[on]));
  }
  *out = s;
  return status;
}
