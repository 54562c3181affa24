// Workspaces from structure: the axes of the joints in one pose identify the classical arm types,
// and the limits give the ranges for their formulas.

#include "geom/robot/workspace.h"

#include <math.h>

#include "geom/linalg/tolerance.h"
#include "geom/robot/numeric.h"

// Axes are parallel if their sine, or intersect if their distance as a fraction of the reach, is
// below this.
#define ALIGNED CAG_PARALLEL
// A range this close to a full turn is a full turn.
#define FULL (2 * M_PI * (1 - 1e-12))

// The arm: the first joints, which position the point.
typedef struct Arm {
  const CagRobot *r;
  size_t n;      // joints of the arm
  CagVec3 point; // at q
  CagVec3 o[CAG_ROBOT_JOINTS_MAX], z[CAG_ROBOT_JOINTS_MAX];
  double q[CAG_ROBOT_JOINTS_MAX];
} Arm;

static const CagRobotLink *link_of(const Arm *a, size_t i) {
  return &a->r->links[a->r->joint_link[i]];
}
static bool turns(const Arm *a, size_t i) {
  return link_of(a, i)->kind == CAG_JOINT_REVOLUTE && link_of(a, i)->screw == 0;
}
static bool slides(const Arm *a, size_t i) { return link_of(a, i)->kind == CAG_JOINT_PRISMATIC; }
static double span(const Arm *a, size_t i) { return link_of(a, i)->high - link_of(a, i)->low; }

// --- Lines ---

static bool parallel(CagVec3 u, CagVec3 v) { return cag_norm(cag_cross(u, v)) <= ALIGNED; }
static bool square(CagVec3 u, CagVec3 v) { return fabs(cag_dot(u, v)) <= ALIGNED; }

// The component of b - a perpendicular to the unit direction z.
static CagVec3 across(CagVec3 a, CagVec3 b, CagVec3 z) {
  CagVec3 w = cag_sub(b, a);
  return cag_madd(w, -cag_dot(w, z), z);
}
static double from_axis(const Arm *a, size_t i, CagVec3 p) {
  return cag_norm(across(a->o[i], p, a->z[i]));
}
static bool on_axis(const Arm *a, size_t i, CagVec3 p) {
  return from_axis(a, i, p) <= ALIGNED * a->r->reach;
}

// The intersection of two axes.
static bool meet(const Arm *a, size_t i, size_t j, CagVec3 *out) {
  CagVec3 u = a->z[i], v = a->z[j], w = cag_sub(a->o[j], a->o[i]);
  double uv = cag_dot(u, v), d = 1 - uv * uv;
  if (parallel(u, v)) return false;
  *out = cag_madd(a->o[i], (cag_dot(u, w) - uv * cag_dot(v, w)) / d, u);
  return on_axis(a, j, *out);
}

// --- The arm of a chain ---

// The middle of the ranges, with no joint stretched or folded.
static void generic_place(Arm *a) {
  const double share = 0.41421356237309515;
  for (size_t i = 0; i < a->r->joint_count; i++) a->q[i] = link_of(a, i)->low + share * span(a, i);
}

// Sets the arm and its point; returns true if the point is the wrist's and not the tool's.
static bool find_arm(const CagRobot *r, Arm *a) {
  CagTransform tool;
  *a = (Arm){.r = r, .n = r->joint_count};
  generic_place(a);
  cag_robot_axes(r, a->q, a->o, a->z);
  cag_robot_forward(r, a->q, &tool);
  a->point = cag_vec3(tool.m[0][3], tool.m[1][3], tool.m[2][3]);
  size_t n = a->n;
  while (n > 1 && turns(a, n - 1) && on_axis(a, n - 1, a->point)) n--;
  CagVec3 center;
  bool wrist = a->n >= 6 && turns(a, a->n - 1) && turns(a, a->n - 2) && turns(a, a->n - 3) &&
               meet(a, a->n - 2, a->n - 1, &center) && on_axis(a, a->n - 3, center);
  if (wrist && n > a->n - 3) {
    a->n -= 3;
    a->point = center;
    return true;
  }
  a->n = n;
  return false;
}

// --- Kinds ---

static bool is_cartesian(const Arm *a, CagWorkspace *w) {
  if (a->n != 3 || !slides(a, 0) || !slides(a, 1) || !slides(a, 2) || !square(a->z[0], a->z[1]) ||
      !square(a->z[1], a->z[2]) || !square(a->z[0], a->z[2]))
    return false;
  w->kind = CAG_WORKSPACE_CARTESIAN;
  w->exact = true;
  w->volume = span(a, 0) * span(a, 1) * span(a, 2);
  CagVec3 low = a->point, middle = a->point;
  for (size_t i = 0; i < 3; i++) {
    const CagRobotLink *l = link_of(a, i);
    low = cag_madd(low, l->low - a->q[i], a->z[i]);
    middle = cag_madd(middle, (l->low + l->high) / 2 - a->q[i], a->z[i]);
  }
  for (int corner = 0; corner < 8; corner++) {
    CagVec3 p = low;
    for (size_t i = 0; i < 3; i++)
      if (corner >> i & 1) p = cag_madd(p, span(a, i), a->z[i]);
    cag_bounds_add(&w->bounds, p);
  }
  w->center = middle;
  w->r_max = sqrt(span(a, 0) * span(a, 0) + span(a, 1) * span(a, 1) + span(a, 2) * span(a, 2)) / 2;
  return true;
}

// If joint i is a prismatic joint that moves radially from `from`: the distances at its limits.
static bool radial(const Arm *a, size_t i, CagVec3 from, double *low, double *high) {
  CagVec3 way = cag_sub(a->point, from);
  if (cag_norm(cag_cross(way, a->z[i])) > ALIGNED * a->r->reach) return false;
  double r = cag_dot(way, a->z[i]);
  *low = r + link_of(a, i)->low - a->q[i];
  *high = r + link_of(a, i)->high - a->q[i];
  if (fabs(*low) <= ALIGNED * a->r->reach) *low = 0;
  return true;
}

// Bounds of the distance for a prismatic joint that moves from low to high, possibly through its
// center.
static void bound_slide(CagWorkspace *w, double low, double high) {
  w->r_min = fmax(0, fmax(low, -high));
  w->r_max = fmax(-low, high);
}

static bool is_cylindrical(const Arm *a, CagWorkspace *w) {
  double low, high;
  if (a->n != 3 || !turns(a, 0) || !slides(a, 1) || !slides(a, 2) || !parallel(a->z[0], a->z[1]) ||
      !square(a->z[0], a->z[2]))
    return false;
  CagVec3 foot = cag_sub(a->point, across(a->o[0], a->point, a->z[0]));
  if (!radial(a, 2, foot, &low, &high)) return false;
  w->kind = CAG_WORKSPACE_CYLINDRICAL;
  w->center = a->o[0];
  bound_slide(w, low, high);
  // On the far side of the axis the joint would cover a part twice.
  w->exact = low >= 0;
  double angle = fmin(span(a, 0), 2 * M_PI);
  w->volume = angle / 2 * (high * high - low * low) * span(a, 1);
  return true;
}

static double shell_volume(const CagWorkspace *w) {
  return 4 * M_PI / 3 * (w->r_max * w->r_max * w->r_max - w->r_min * w->r_min * w->r_min);
}

static bool is_spherical(const Arm *a, CagWorkspace *w) {
  CagVec3 center;
  if (a->n != 3 || !turns(a, 0) || !turns(a, 1) || !slides(a, 2) || !square(a->z[0], a->z[1]) ||
      !meet(a, 0, 1, &center))
    return false;
  double low, high;
  if (radial(a, 2, center, &low, &high) && square(a->z[1], a->z[2])) {
    // The elevation of the prismatic joint's direction over the plane perpendicular to the first
    // axis; it decreases as joint 2 turns.
    CagVec3 level = cag_cross(a->z[1], a->z[0]);
    double f = atan2(cag_dot(a->z[2], a->z[0]), cag_dot(a->z[2], level));
    double f1 = remainder(f - (link_of(a, 1)->high - a->q[1]), 2 * M_PI), f2 = f1 + span(a, 1);
    const double rounding = CAG_ROUNDING;
    // Entirely beyond the pole: the same points, from the other side.
    if (f1 <= -M_PI / 2 - rounding) {
      f1 += 2 * M_PI;
      f2 += 2 * M_PI;
    }
    if (f1 >= M_PI / 2 - rounding) {
      double lower = M_PI - f2;
      f2 = M_PI - f1;
      f1 = lower;
    }
    w->kind = CAG_WORKSPACE_SPHERICAL;
    w->center = center;
    bound_slide(w, low, high);
    w->exact = low >= 0 && f1 >= -M_PI / 2 - rounding && f2 <= M_PI / 2 + rounding;
    w->volume = fmin(span(a, 0), 2 * M_PI) / 3 * (high * high * high - low * low * low) *
                (sin(f2) - sin(f1));
    return true;
  }
  // An offset along the second axis: the point stays in a plane parallel to one through the first
  // axis.
  CagVec3 way = cag_sub(a->point, center);
  double offset = cag_dot(way, a->z[1]);
  CagVec3 foot = cag_madd(center, offset, a->z[1]);
  if (!square(a->z[1], a->z[2]) || !radial(a, 2, foot, &low, &high)) return false;
  w->kind = CAG_WORKSPACE_OFFSET;
  w->center = center;
  bound_slide(w, low, high);
  w->hole = fabs(offset);
  w->exact = low >= 0 && span(a, 0) >= FULL && span(a, 1) >= FULL;
  w->volume = shell_volume(w);
  return true;
}

// Ring reached by links of these lengths with unlimited rotation.
static void ring(const double *lengths, size_t n, double *r_min, double *r_max) {
  double sum = 0, largest = 0;
  for (size_t i = 0; i < n; i++) {
    sum += lengths[i];
    largest = fmax(largest, lengths[i]);
  }
  *r_max = sum;
  *r_min = fmax(0, 2 * largest - sum);
}

// The angle at joint i between the directions to the previous joint and to p, at q.
static double bend_of(const Arm *a, size_t i, CagVec3 p) {
  CagVec3 back = across(a->o[i - 1], a->o[i], a->z[i]), on = across(a->o[i], p, a->z[i]);
  return atan2(cag_dot(cag_cross(back, on), a->z[i]), cag_dot(back, on));
}

// The smallest and the largest distance of p from joint i-1's axis over the range of joint i.
static void two_links(const Arm *a, size_t i, CagVec3 p, double first, double second, double *r_min,
                      double *r_max) {
  double low = bend_of(a, i, p) + link_of(a, i)->low - a->q[i];
  low = remainder(low, 2 * M_PI);
  double high = low + span(a, i);
  bool stretched = high >= 2 * M_PI || (low <= 0 && high >= 0);
  bool folded = high >= M_PI || low <= -M_PI;
  double cl = cos(low), ch = cos(high);
  double most = stretched ? 1 : fmax(cl, ch), least = folded ? -1 : fmin(cl, ch);
  double sum = first * first + second * second, twice = 2 * first * second;
  *r_max = most == 1 ? first + second : sqrt(fmax(0, sum + twice * most));
  *r_min = least == -1 ? fabs(first - second) : sqrt(fmax(0, sum + twice * least));
}

static bool is_planar(const Arm *a, CagWorkspace *w) {
  double lengths[CAG_ROBOT_JOINTS_MAX], stroke = 0;
  size_t axes[CAG_ROBOT_JOINTS_MAX], count = 0, strokes = 0;
  for (size_t i = 0; i < a->n; i++) {
    if (!parallel(a->z[0], a->z[i])) return false;
    if (turns(a, i)) axes[count++] = i;
    else if (slides(a, i) && strokes++ == 0) stroke = span(a, i);
    else return false;
  }
  if (count == 0 || strokes > 1) return false;
  bool free = span(a, axes[0]) >= FULL;
  for (size_t k = 0; k < count; k++) {
    CagVec3 to = k + 1 < count ? a->o[axes[k + 1]] : a->point;
    lengths[k] = from_axis(a, axes[k], to);
    if (k > 0) free = free && (span(a, axes[k]) >= FULL || count == 2);
  }
  w->kind = strokes ? CAG_WORKSPACE_SCARA : CAG_WORKSPACE_PLANAR;
  w->center = a->o[axes[0]];
  ring(lengths, count, &w->r_min, &w->r_max);
  if (count == 2 && axes[1] == axes[0] + 1)
    two_links(a, axes[1], a->point, lengths[0], lengths[1], &w->r_min, &w->r_max);
  else if (count == 2) free = free && span(a, axes[1]) >= FULL;
  double area = M_PI * (w->r_max * w->r_max - w->r_min * w->r_min);
  w->exact = free;
  w->volume = strokes ? area * stroke : area;
  return true;
}

static bool is_articulated(const Arm *a, CagWorkspace *w) {
  CagVec3 shoulder;
  if (a->n != 3 || !turns(a, 0) || !turns(a, 1) || !turns(a, 2) || !square(a->z[0], a->z[1]) ||
      !parallel(a->z[1], a->z[2]) || !meet(a, 0, 1, &shoulder))
    return false;
  double offset = cag_dot(cag_sub(a->point, shoulder), a->z[1]);
  double upper = from_axis(a, 1, a->o[2]), fore = from_axis(a, 2, a->point);
  w->kind = CAG_WORKSPACE_ARTICULATED;
  w->center = shoulder;
  two_links(a, 2, a->point, upper, fore, &w->r_min, &w->r_max);
  w->hole = fabs(offset);
  w->exact = span(a, 0) >= FULL && span(a, 1) >= FULL;
  w->volume = shell_volume(w);
  return true;
}

// --- What is bounded ---

// How far a shell with a hole extends in a direction whose cosine to the first axis is c: points at
// height h have the distance sqrt(R^2 - h^2) from the axis, where |h| <= r_max and
// R^2 = r_max^2 + hole^2.
static double extent(const CagWorkspace *w, double c) {
  double whole = hypot(w->r_max, w->hole);
  if (fabs(c) * whole <= w->r_max) return whole;
  return fabs(c) * w->r_max + sqrt(fmax(0, 1 - c * c)) * w->hole;
}

static void bound_round(const Arm *a, CagWorkspace *w) {
  if (!w->exact || (w->kind != CAG_WORKSPACE_ARTICULATED && w->kind != CAG_WORKSPACE_OFFSET))
    return;
  CagVec3 z = a->z[0], half = cag_vec3(extent(w, z.x), extent(w, z.y), extent(w, z.z));
  cag_bounds_add(&w->bounds, cag_sub(w->center, half));
  cag_bounds_add(&w->bounds, cag_add(w->center, half));
}

void cag_robot_workspace(const CagRobot *r, CagWorkspace *out) {
  Arm a;
  *out = (CagWorkspace){.kind = CAG_WORKSPACE_OTHER, .bounds = CAG_BOUNDS_EMPTY, .volume = NAN};
  if (r->joint_count == 0) return;
  out->of_wrist = find_arm(r, &a);
  bool known = is_cartesian(&a, out) || is_cylindrical(&a, out) || is_spherical(&a, out) ||
               is_planar(&a, out) || is_articulated(&a, out);
  if (!known || !out->exact) {
    out->volume = NAN;
    out->exact = false;
  }
  if (known) bound_round(&a, out);
}

void cag_robot_workspace_sample(const CagRobot *r, size_t k, size_t n, double *q) {
  size_t corner_bits = 0;
  while (corner_bits < r->joint_count && (size_t)2 << corner_bits <= n / 2) corner_bits++;
  size_t corners = (size_t)1 << corner_bits;
  cag_robot_sequence(r, k + 1, q);
  if (k >= corners || corner_bits == 0) return;
  for (size_t i = 0; i < corner_bits; i++) {
    const CagRobotLink *l = &r->links[r->joint_link[i]];
    q[i] = k >> i & 1 ? l->high : l->low;
  }
}
