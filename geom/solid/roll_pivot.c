// Turns of the ball about an edge of the opposite bend (see roll_pivot.h).

#include "geom/solid/roll_pivot.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/roll_body.h"

// Faces whose normals have a smaller sine are parallel.
#define PARALLEL 1e-6

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

// The height along the axis at which a point at `out` (a vector) from it has a distance from F.
static double height_at(const CagRollPivot *v, CagVec3 out, double distance) {
  const CagVec3 at = cag_add(cag_sub(v->axis, v->point), out);
  return (distance - cag_dot(at, v->face)) / cag_dot(v->along, v->face);
}

// How far beyond the corner the ball at an end of the turn is, along the edge of this tip.
static double pivot_offset(const CagRollPivot *v, int k, CagVec3 leaving) {
  if (v->flat) return 0;
  const CagVec3 out = cag_scaled(v->toward[k], v->inner + v->radius);
  const CagVec3 center = cag_madd(cag_add(v->axis, out), height_at(v, out, v->radius), v->along);
  return cag_dot(cag_sub(center, v->point), leaving);
}

// Lets the edge end where the turn begins.
static CagStatus set_range(CagRollPlan *p, CagRollPivot *v, int k, bool *possible, CagError *err) {
  CagRollPick *pick = &p->picks[v->tips[k].pick];
  const CagCurve *c = pick->e.curve;
  const int end = v->tips[k].end;
  CagVec3 leaving, d[2];
  CagStatus status = cag_roll_leaving(pick, end, &leaving, err);
  if (!status)
    status =
        cag_curve_eval(c, end ? c->end : c->start, 1, end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  const double offset = pivot_offset(v, k, leaving), speed = cag_norm(d[1]);
  const double near = CAG_COINCIDENT * (v->radius + v->inner);
  v->beyond[k] = offset > near;
  *possible = is_line(c) || fabs(offset) <= near;
  if (offset < -near) pick->range[end] += (end ? 1 : -1) * offset / speed;
  pick->station[end] = pick->range[end];
  return CAG_OK;
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
  const CagRollSide *planes[3] = {&a->sides[at[0]], &a->sides[1 - at[0]], &b->sides[1 - at[1]]};
  for (int k = 0; k < 3; k++)
    if (planes[k]->carrier->kind != CAG_CARRIER_PLANE) return false;
  v->side = at[0];
  v->face = plane_toward(a, at[0]);
  v->toward[0] = plane_toward(a, 1 - at[0]);
  v->toward[1] = plane_toward(b, 1 - at[1]);
  const double size = a->size[v->tips[0].end][0], other = b->size[v->tips[1].end][0];
  v->flat = a->flat;
  v->radius = size;
  return v->flat || fabs(size - other) <= CAG_COINCIDENT * size;
}

CagStatus cag_roll_add_pivot(CagRollPlan *p, size_t part, size_t corner, const CagRollTip tips[2],
                             CagRollTip third, bool *done, CagError *err) {
  const CagRollPart *all = &p->parts[part];
  const size_t edge = third_edge(p, part, corner, tips);
  CagRollPivot v = {.tips = {tips[0], tips[1]}, .third = third.pick};
  CagRollEdge e;
  CagVec3 d[2], leaving[2];
  int at[2];
  *done = false;
  if (edge == CAG_ROLL_NONE) return CAG_OK;
  CagStatus status = cag_roll_edge(all, edge, &e, err);
  for (int k = 0; !status && k < 2; k++)
    status = cag_roll_leaving(&p->picks[tips[k].pick], tips[k].end, &leaving[k], err);
  if (!status && !pivot_planes(p, &v, &e, at)) return CAG_OK;
  if (!status) status = cag_curve_eval(e.curve, e.curve->start, 1, CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  const bool from_start = all->b->edges[edge].from == corner;
  v.point = all->b->corners[corner];
  v.along = cag_unit(cag_scaled(d[1], from_start ? 1 : -1));
  v.length = cag_norm(d[1]) * (e.curve->end - e.curve->start);
  if (third.pick != CAG_ROLL_NONE) v.inner = p->picks[third.pick].e.size[third.end][0];
  if (!pivot_axis(&v) || (v.flat && !miter(p, &v, leaving, at))) return CAG_OK;
  bool possible = true;
  for (int k = 0; !status && possible && k < 2; k++) {
    status = set_range(p, &v, k, &possible, err);
    p->picks[tips[k].pick].pivot[tips[k].end] = p->pivot_count + 1;
  }
  if (status || !possible) return status;
  CagRollSection s;
  for (int k = 0; k < 3 && !v.flat; k++) {
    cag_roll_pivot_section(p, &v, tips[0], k / 2.0, &s);
    const double height = cag_dot(cag_sub(s.contact[1 - v.side], v.axis), v.along);
    if (height < 0 || height > v.length) p->unfit = tips[0].pick;
  }
  if (!CAG_RESERVE(p->pivots, p->pivot_room, p->pivot_count + 1)) return cag_fail_memory(err);
  p->pivots[p->pivot_count++] = v;
  *done = true;
  return CAG_OK;
}

size_t cag_roll_pivot_parts(const CagRollPlan *p, const CagRollPivot *v) {
  if (v->flat) return 2;
  const double angle =
      atan2(cag_norm(cag_cross(v->toward[0], v->toward[1])), cag_dot(v->toward[0], v->toward[1]));
  return cag_roll_arc(2 * (v->inner + v->radius), angle, p->tolerance);
}

void cag_roll_pivot_section(const CagRollPlan *p, const CagRollPivot *v, CagRollTip tip, double t,
                            CagRollSection *out) {
  // Someone who comes from the second edge sees the sides exchanged.
  const bool first = tip.pick == v->tips[0].pick && tip.end == v->tips[0].end;
  const int face = v->tips[0].end == 1 ? v->side : 1 - v->side, on = first ? face : 1 - face;
  const CagVec3 w = cag_roll_arc_direction(v->toward[first ? 0 : 1], v->toward[first ? 1 : 0], t);
  const CagVec3 near = cag_scaled(w, v->inner), far = cag_scaled(w, v->inner + v->radius);
  CagRollSection s = {.origin = tip.pick, .edge = v->point, .radius = v->flat ? 0 : v->radius};
  s.start[on] = s.toward[on] = v->face;
  s.start[1 - on] = s.toward[1 - on] = w;
  s.along = p->sections ? p->sections[p->section_count ? p->section_count - 1 : 0].along : v->along;
  if (v->flat) {
    s.contact[on] = v->contact[0];
    s.contact[1 - on] = v->contact[1];
  } else {
    const double height = height_at(v, far, v->radius);
    s.center = cag_madd(cag_add(v->axis, far), height, v->along);
    s.contact[on] = cag_madd(s.center, -v->radius, v->face);
    s.contact[1 - on] = cag_madd(s.center, -v->radius, w);
    s.edge = cag_madd(cag_add(v->axis, near), height_at(v, near, 0), v->along);
  }
  *out = s;
}
