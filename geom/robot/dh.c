// The assignment of frames to joint axes.

#include "geom/robot/dh.h"

#include "geom/linalg/tolerance.h"
#include "geom/robot/kernel.h"

// Sine of the angle between axes below which they are parallel.
#define PARALLEL CAG_PARALLEL
// Distances below this fraction of the size of the chain are 0.
#define MEETING CAG_COINCIDENT

typedef struct Frame {
  CagVec3 o, x, z;
} Frame;

static CagTransform matrix_of(const Frame *f) {
  CagVec3 y = cag_cross(f->z, f->x);
  CagRobotFrame frame = {f->x, y, f->z, f->o};
  CagTransform t;
  cag_robot_frame_to(&frame, &t);
  return t;
}

// The feet of the common normal of two nonparallel lines.
static void common_normal(CagVec3 p, CagVec3 u, CagVec3 q, CagVec3 v, CagVec3 *f, CagVec3 *g) {
  CagVec3 w = cag_sub(q, p);
  double uv = cag_dot(u, v), uw = cag_dot(u, w), vw = cag_dot(v, w), d = 1 - uv * uv;
  *f = cag_madd(p, (uw - uv * vw) / d, u);
  *g = cag_madd(q, (uv * uw - vw) / d, v);
}

// The frame on the next axis (point c, unit direction z), and the foot of the common normal on the
// current one.
static Frame next_frame(const Frame *f, CagVec3 c, CagVec3 z, bool last, double size,
                        CagVec3 *foot) {
  CagVec3 across = cag_cross(f->z, z);
  Frame next = {.z = z};
  if (cag_norm(across) > PARALLEL) {
    common_normal(f->o, f->z, c, z, foot, &next.o);
    CagVec3 normal = cag_sub(next.o, *foot);
    bool skew = cag_norm(normal) > MEETING * size;
    next.x = cag_unit(skew ? normal : across);
    // Exactly perpendicular to both axes, despite rounding of the feet.
    next.x = cag_unit(cag_madd(next.x, -cag_dot(next.x, z), z));
    return next;
  }
  CagVec3 way = cag_sub(c, f->o);
  CagVec3 w = cag_madd(way, -cag_dot(way, f->z), f->z);
  bool apart = cag_norm(w) > MEETING * size;
  next.x = apart ? cag_unit(w) : f->x;
  next.o = apart ? cag_add(f->o, w) : f->o;
  *foot = f->o;
  if (!last) return next;
  double height = cag_dot(way, f->z);
  next.o = cag_madd(next.o, height, f->z);
  *foot = cag_madd(*foot, height, f->z);
  return next;
}

// The row from one frame to the next.
static CagRobotLink row_between(const Frame *f, const Frame *next, CagVec3 foot,
                                CagJointKind kind) {
  CagRobotLink l = cag_robot_link(kind);
  l.theta = atan2(cag_dot(cag_cross(f->x, next->x), f->z), cag_dot(f->x, next->x));
  l.d = cag_dot(cag_sub(foot, f->o), f->z) + 0.0;
  l.a = cag_dot(cag_sub(next->o, foot), next->x) + 0.0;
  l.alpha = atan2(cag_dot(cag_cross(f->z, next->z), next->x), cag_dot(f->z, next->z));
  return l;
}

static CagStatus unit_direction(const CagJointAxis *axis, long index, CagVec3 *out, CagError *err) {
  *out = cag_unit(axis->direction);
  if (isfinite(cag_norm(axis->direction)) && cag_norm(*out) > 0) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_vector, index < 0 ? "end" : "axes", index,
                  index < 0 ? "the direction of the end must not be zero"
                            : "the direction of axes[%ld] must not be zero",
                  index);
}

// Size of the given data, to which distances are compared.
static double size_of(CagVec3 o, const CagJointAxis *axes, size_t n, const CagJointAxis *end) {
  double size = cag_norm(cag_sub(end->point, o));
  for (size_t i = 0; i < n; i++) size = fmax(size, cag_norm(cag_sub(axes[i].point, o)));
  return size > 0 ? size : 1;
}

CagStatus cag_robot_dh_assign(const CagTransform *base, const CagJointAxis *axes, size_t n,
                              const CagJointAxis *end, CagRobotLink *links, CagTransform *frames,
                              CagError *err) {
  CagVec3 z;
  if (n == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_chain, "axes", -1,
                    "a chain needs the axis of at least one joint");
  CagStatus status = cag_robot_pose_check(base, "base", err);
  if (!status) status = unit_direction(&axes[0], 0, &z, err);
  if (status) return status;
  CagRobotFrame start;
  cag_robot_frame_from(base, &start);
  Frame f = {start.p, start.x, start.z};
  double size = size_of(f.o, axes, n, end);
  CagVec3 way = cag_sub(axes[0].point, f.o);
  if (cag_norm(cag_sub(z, f.z)) > PARALLEL || cag_norm(cag_cross(way, f.z)) > MEETING * size)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_axis_off_base, "base", -1,
                    "the z axis of the base must lie on the first joint's axis, in its direction");
  frames[0] = matrix_of(&f);
  for (size_t i = 0; i < n; i++) {
    bool last = i + 1 == n;
    const CagJointAxis *to = last ? end : &axes[i + 1];
    status = unit_direction(to, last ? -1 : (long)i + 1, &z, err);
    if (status) return status;
    CagVec3 foot;
    Frame next = next_frame(&f, to->point, z, last, size, &foot);
    links[i] = row_between(&f, &next, foot, axes[i].kind);
    frames[i + 1] = matrix_of(&next);
    f = next;
  }
  return CAG_OK;
}
