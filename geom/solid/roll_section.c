// Cross sections of rounded edges (see roll_section.h).

#include "geom/solid/roll_section.h"

#include <math.h>

#include "geom/linalg/tolerance.h"

// Steps of Newton's method. Carriers without a closed form of the nearest point converge linearly.
#define STEPS 200
// Normals whose triple product with the tangent is smaller are parallel.
#define PARALLEL 1e-6
// A step toward the nearest point of a carrier without a closed form is shortened by this factor.
// It converges up to a distance of 3 radii of curvature from the convex side.
#define DAMPED 0.5

// One step of the Gauss-Newton method toward the nearest point.
static void foot_step(const CagCarrierPoint *at, CagVec3 p, double uv[2]) {
  const CagVec3 off = cag_sub(p, at->point);
  const double uu = cag_dot(at->du, at->du), uv2 = cag_dot(at->du, at->dv);
  const double vv = cag_dot(at->dv, at->dv), det = uu * vv - uv2 * uv2;
  const double ru = cag_dot(at->du, off), rv = cag_dot(at->dv, off);
  if (!(det > CAG_ROUNDING * uu * vv)) return;
  uv[0] += DAMPED * (vv * ru - uv2 * rv) / det;
  uv[1] += DAMPED * (uu * rv - uv2 * ru) / det;
}

CagStatus cag_roll_foot(const CagRollSide *side, CagVec3 p, double uv[2], CagVec3 *foot,
                        CagVec3 *normal, CagError *err) {
  const CagCarrier *c = side->carrier;
  CagCarrierPoint at;
  CagStatus status = CAG_OK;
  if (cag_carrier_is_analytic(c)) {
    const double near[2] = {uv[0], uv[1]};
    cag_carrier_parameters(c, p, near, uv);
  } else {
    status = cag_carrier_eval(c, uv[0], uv[1], &at, err);
    if (!status) foot_step(&at, p, uv);
  }
  if (!status) status = cag_carrier_eval(c, uv[0], uv[1], &at, err);
  if (!status) status = cag_carrier_normal(c, uv[0], uv[1], normal, err);
  if (status) return status;
  *foot = at.point;
  *normal = cag_scaled(*normal, side->outward);
  return CAG_OK;
}

// The vector x with rows[i] . x = values[i]. Returns false if the rows are nearly dependent.
static bool solve_rows(const CagVec3 rows[3], const double values[3], CagVec3 *x) {
  const CagVec3 c0 = cag_cross(rows[1], rows[2]), c1 = cag_cross(rows[2], rows[0]);
  const CagVec3 c2 = cag_cross(rows[0], rows[1]);
  const double det = cag_dot(rows[0], c0);
  if (!(fabs(det) > PARALLEL)) return false;
  *x = cag_scaled(cag_madd(cag_madd(cag_scaled(c0, values[0]), values[1], c1), values[2], c2),
                  1 / det);
  return true;
}

// A ball that touches carriers: those of `count` faces, and (count == 2) with its center in a
// plane.
typedef struct Touch {
  const CagRollSide *sides[3];
  double uv[3][2];
  int count;
  double radius, sign; // sign 1: the ball is on the outer side
  CagVec3 plane_at, plane_normal;
  CagVec3 foot[3], toward[3];
  CagVec3 center;
} Touch;

static CagStatus touch_feet(Touch *t, CagVec3 p, CagError *err) {
  for (int i = 0; i < t->count; i++) {
    CagVec3 normal;
    CagStatus status = cag_roll_foot(t->sides[i], p, t->uv[i], &t->foot[i], &normal, err);
    if (status) return status;
    t->toward[i] = cag_scaled(normal, t->sign);
  }
  return CAG_OK;
}

// Finds the center; `center` is a point near all faces at first.
static CagStatus touch_solve(Touch *t, bool *fits, CagError *err) {
  *fits = false;
  CagStatus status = touch_feet(t, t->center, err);
  for (int k = 0; !status && k < STEPS; k++) {
    CagVec3 rows[3] = {t->toward[0], t->toward[1], t->count == 3 ? t->toward[2] : t->plane_normal};
    double values[3];
    CagVec3 step;
    for (int i = 0; i < t->count; i++)
      values[i] = t->radius - cag_dot(cag_sub(t->center, t->foot[i]), t->toward[i]);
    if (t->count < 3) values[2] = cag_dot(cag_sub(t->plane_at, t->center), t->plane_normal);
    if (!solve_rows(rows, values, &step)) return CAG_OK;
    const CagVec3 next = cag_add(t->center, step);
    CagVec3 before[3] = {t->foot[0], t->foot[1], t->foot[2]};
    status = touch_feet(t, next, err);
    double moved = k == 0 ? INFINITY : cag_norm(step);
    for (int i = 0; i < t->count; i++)
      moved = fmax(moved, cag_norm(cag_sub(t->foot[i], before[i])));
    t->center = next;
    if (!isfinite(cag_norm(next))) return status;
    *fits = moved <= 8 * CAG_ROUNDING * (t->radius + cag_norm(next));
    if (*fits) break;
  }
  // The tangent planes alone do not tell whether the ball really touches.
  for (int i = 0; !status && *fits && i < t->count; i++)
    *fits = fabs(cag_norm(cag_sub(t->center, t->foot[i])) - t->radius) <=
            CAG_COINCIDENT * (t->radius + cag_norm(t->center));
  return status;
}

CagStatus cag_roll_corner(const CagRollSide *const sides[3], const double at[3][2], double radius,
                          bool inside, CagVec3 *center, bool *fits, CagError *err) {
  Touch t = {.count = 3, .radius = radius, .sign = inside ? -1 : 1};
  CagCarrierPoint p;
  for (int i = 0; i < 3; i++) {
    t.sides[i] = sides[i];
    for (int k = 0; k < 2; k++) t.uv[i][k] = at[i][k];
  }
  CagStatus status = cag_carrier_eval(sides[0]->carrier, at[0][0], at[0][1], &p, err);
  if (status) return status;
  t.center = p.point;
  status = touch_solve(&t, fits, err);
  *center = t.center;
  return status;
}

// --- Sections ---

// The point of a face at a distance from E in the plane of the section.
static CagStatus bevel_contact(const CagRollSide *side, CagVec3 into, double distance, double uv[2],
                               CagRollSection *s, int k, bool *fits, CagError *err) {
  CagVec3 at = cag_madd(s->edge, distance, into), foot, normal;
  CagStatus status = CAG_OK;
  *fits = false;
  for (int i = 0; !status && !*fits && i < STEPS; i++) {
    status = cag_roll_foot(side, at, uv, &foot, &normal, err);
    if (status) break;
    CagVec3 way = cag_sub(foot, s->edge);
    way = cag_madd(way, -cag_dot(way, s->along), s->along);
    const CagVec3 next = cag_madd(s->edge, distance, cag_unit(way));
    *fits = i > 0 &&
            cag_norm(cag_sub(next, at)) <= 8 * CAG_ROUNDING * (distance + cag_norm(next)) &&
            cag_norm(cag_sub(foot, next)) <= CAG_COINCIDENT * (distance + cag_norm(next));
    at = next;
  }
  if (status) return status;
  s->contact[k] = at;
  s->toward[k] = normal;
  return CAG_OK;
}

// The distance of the face from the middle of the chord between E and a contact.
static CagStatus chord_bulge(const CagRollSide *side, const double uv[2], CagRollSection *s, int k,
                             CagError *err) {
  const CagVec3 middle = cag_lerp(s->edge, s->contact[k], 0.5);
  double at[2] = {uv[0], uv[1]};
  CagVec3 foot = middle, normal;
  if (side->carrier->kind == CAG_CARRIER_PLANE) return CAG_OK;
  CagStatus status = CAG_OK;
  const int steps = cag_carrier_is_analytic(side->carrier) ? 1 : 8;
  for (int i = 0; !status && i < steps; i++)
    status = cag_roll_foot(side, middle, at, &foot, &normal, err);
  if (!status) s->bulge = fmax(s->bulge, cag_norm(cag_sub(foot, middle)));
  return status;
}

// The tangent plane of both faces at E: outward normals, and directions into the faces.
static CagStatus section_frame(const CagRollEdge *e, double t, CagRollSection *s, double uv[2][2],
                               CagVec3 into[2], CagError *err) {
  CagVec3 d[2], normal;
  CagStatus status =
      cag_curve_eval(e->curve, t, 1, t < e->curve->end ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, d, err);
  if (status) return status;
  s->edge = d[0];
  s->along = cag_unit(d[1]);
  for (int k = 0; !status && k < 2; k++) {
    const CagRollSide *side = &e->sides[k];
    status = cag_edge_path_eval(&side->path, t, uv[k], NULL, err);
    if (!status) status = cag_carrier_normal(side->carrier, uv[k][0], uv[k][1], &normal, err);
    if (status) return status;
    normal = cag_scaled(normal, side->outward);
    into[k] = cag_unit(cag_cross(normal, cag_scaled(s->along, k == 0 ? 1 : -1)));
    s->start[k] = cag_scaled(normal, e->convex ? -1 : 1);
  }
  return status;
}

CagStatus cag_roll_section(const CagRollEdge *e, double t, CagRollSection *out, bool *fits,
                           CagError *err) {
  CagRollSection s = {0};
  double uv[2][2], size[2];
  CagVec3 into[2];
  *fits = false;
  CagStatus status = section_frame(e, t, &s, uv, into, err);
  if (status) return status;
  if (cag_norm(into[0]) == 0 || cag_norm(into[1]) == 0) return CAG_OK;
  const double part = (t - e->curve->start) / (e->curve->end - e->curve->start);
  for (int k = 0; k < 2; k++)
    size[k] = e->size[0][k] + fmin(fmax(part, 0), 1) * (e->size[1][k] - e->size[0][k]);
  double at[2][2] = {{uv[0][0], uv[0][1]}, {uv[1][0], uv[1][1]}};
  if (e->flat) {
    bool both = true;
    for (int k = 0; !status && k < 2; k++) {
      bool one = false;
      status = bevel_contact(&e->sides[k], into[k], size[k], at[k], &s, k, &one, err);
      if (!status) s.toward[k] = cag_scaled(s.toward[k], e->convex ? -1 : 1);
      both = both && one;
    }
    *fits = both;
  } else {
    Touch ball = {.count = 2, .radius = size[0], .sign = e->convex ? -1 : 1, .center = s.edge};
    ball.plane_at = s.edge;
    ball.plane_normal = s.along;
    for (int k = 0; k < 2; k++) {
      ball.sides[k] = &e->sides[k];
      ball.uv[k][0] = uv[k][0], ball.uv[k][1] = uv[k][1];
    }
    status = touch_solve(&ball, fits, err);
    s.center = ball.center;
    s.radius = size[0];
    for (int k = 0; k < 2; k++) {
      s.contact[k] = ball.foot[k], s.toward[k] = ball.toward[k];
      at[k][0] = ball.uv[k][0], at[k][1] = ball.uv[k][1];
    }
  }
  for (int k = 0; !status && *fits && k < 2; k++)
    status = chord_bulge(&e->sides[k], uv[k], &s, k, err);
  // The contacts are on the faces, not on their continuations beyond the edge.
  for (int k = 0; *fits && k < 2; k++) *fits = cag_dot(cag_sub(s.contact[k], s.edge), into[k]) > 0;
  *out = s;
  return status;
}
