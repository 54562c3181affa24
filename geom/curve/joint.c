// The continuity between the end of one curve and the start of another.

#include "geom/curve/joint.h"

// K = (P'' (P'.P') - P' (P'.P'')) / (P'.P')^2
static CagVec3 curvature_vector(const CagVec3 d[3]) {
  const double v2 = cag_dot(d[1], d[1]);
  return cag_scaled(cag_madd(cag_scaled(d[2], v2), -cag_dot(d[1], d[2]), d[1]), 1 / (v2 * v2));
}

static double larger(CagVec3 a, CagVec3 b) { return fmax(cag_norm(a), cag_norm(b)); }

static bool same(CagVec3 a, CagVec3 b, double tolerance) {
  return cag_norm(cag_sub(a, b)) <= tolerance * larger(a, b);
}

// The angle between unit vectors, without the loss of accuracy of acos near 0.
static double angle_between(CagVec3 a, CagVec3 b) {
  return 2 * atan2(cag_norm(cag_sub(a, b)), cag_norm(cag_add(a, b)));
}

CagStatus cag_curve_joint(const CagCurve *a, const CagCurve *b, double tolerance, CagJoint *out,
                          CagError *err) {
  CagVec3 da[3], db[3], ta, tb;
  CagBounds box = CAG_BOUNDS_EMPTY;
  CagStatus status = cag_curve_eval(a, a->end, 2, CAG_SIDE_LEFT, da, err);
  if (!status) status = cag_curve_eval(b, b->start, 2, CAG_SIDE_RIGHT, db, err);
  if (status) return status;
  // The gap is relative to the size of the curves, since the joint may be at the origin.
  const CagCurve *both[2] = {a, b};
  for (int i = 0; i < 2; i++) {
    CagBounds hull = both[i]->kind->hull(both[i], both[i]->start, both[i]->end);
    cag_bounds_add(&box, hull.min);
    cag_bounds_add(&box, hull.max);
  }
  const double size = cag_norm(cag_sub(box.max, box.min));
  CagJoint j = {.gap = cag_norm(cag_sub(db[0], da[0])),
                .first_jump = cag_norm(cag_sub(db[1], da[1])),
                .second_jump = cag_norm(cag_sub(db[2], da[2])),
                .angle = NAN,
                .ratio = NAN,
                .curvature_jump = NAN};
  const double speed_a = cag_norm(da[1]), speed_b = cag_norm(db[1]);
  if (speed_a > 0) j.ratio = speed_b / speed_a;
  j.c0 = j.gap <= tolerance * size;
  j.c1 = j.c0 && same(da[1], db[1], tolerance);
  // Second derivatives are compared with the first ones as well, because those of a line are 0 up
  // to rounding.
  j.c2 = j.c1 && j.second_jump <= tolerance * fmax(larger(da[2], db[2]), larger(da[1], db[1]));
  CagError none;
  if (!cag_curve_tangent(a, a->end, CAG_SIDE_LEFT, &ta, &none) &&
      !cag_curve_tangent(b, b->start, CAG_SIDE_RIGHT, &tb, &none)) {
    j.angle = angle_between(ta, tb);
    j.g1 = j.c0 && j.angle <= tolerance;
  }
  if (speed_a > 0 && speed_b > 0) {
    const CagVec3 ka = curvature_vector(da), kb = curvature_vector(db);
    j.curvature_jump = cag_norm(cag_sub(ka, kb));
    j.g2 = j.g1 && j.curvature_jump <= tolerance * fmax(larger(ka, kb), size > 0 ? 1 / size : 0);
  }
  *out = j;
  return CAG_OK;
}

const char *cag_joint_class(const CagJoint *j) {
  return j->c2 ? "C2" : j->g2 ? "G2" : j->c1 ? "C1" : j->g1 ? "G1" : j->c0 ? "C0" : "none";
}
