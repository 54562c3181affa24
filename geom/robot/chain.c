// Serial chains: construction and validation of a robot, its uniform stages, and its frames.

#include <string.h>

#include "base/memory.h"
#include "geom/linalg/tolerance.h"
#include "geom/robot/kernel.h"
#include "geom/robot/robot.h"

// Accepted deviation of a rotation's columns from orthonormal ones: rounding of given data.
#define RIGID CAG_PARALLEL
// A coupling is singular if its determinant is below this fraction of the product of its rows'
// lengths.
#define COUPLING_SINGULAR CAG_ROUNDING
// Largest length whose squares and products do not overflow.
#define REACH_MAX 1e100
// Joint values beyond a limit by less than this (radians, or fractions of the reach) are on it.
#define ON_LIMIT CAG_ROUNDING

// --- Checks ---

static CagStatus check_rigid(const CagTransform *t, const char *argument, long link,
                             CagError *err) {
  if (cag_transform_is_rigid(t)) return CAG_OK;
  char place[48] = "";
  if (link >= 0) snprintf(place, sizeof place, " of links[%ld]", link);
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_rigid, argument, link,
                  "the transform%s must be a rigid motion, without scaling, shear, or reflection",
                  place);
}

CagStatus cag_robot_pose_check(const CagTransform *t, const char *argument, CagError *err) {
  return check_rigid(t, argument, -1, err);
}

// joint -1: a single link.
static CagStatus check_limits(const CagRobotLink *l, long joint, CagError *err) {
  char low[32], high[32], home[32], of[32] = "the joint";
  if (joint >= 0) snprintf(of, sizeof of, "joint %ld", joint + 1);
  double unit = l->kind == CAG_JOINT_REVOLUTE ? 180 / M_PI : 1;
  const char *word = l->kind == CAG_JOINT_REVOLUTE ? "deg" : "";
  cag_number_text(l->low * unit, low);
  cag_number_text(l->high * unit, high);
  cag_number_text(l->home * unit, home);
  if (!isfinite(l->high - l->low))
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_joint_limits, "limits", joint,
        "the limits of %s are %s%s..%s%s; they must be finite; for a joint that rotates freely, use -360deg..360deg",
        of, low, word, high, word);
  if (l->low > l->high)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_joint_limits, "limits", joint,
                    "the limits of %s decrease from %s%s to %s%s; the lower limit comes first", of,
                    low, word, high, word);
  if (!(l->home >= l->low && l->home <= l->high))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_home_outside, "home", joint,
                    "the home value %s%s of %s lies outside of its limits %s%s..%s%s", home, word,
                    of, low, word, high, word);
  return CAG_OK;
}

static CagStatus check_link(const CagRobotLink *l, long index, long joint, CagError *err) {
  if (l->kind == CAG_JOINT_FIXED)
    return check_rigid(&l->fixed, index < 0 ? "T" : "links", index, err);
  const double numbers[] = {l->theta, l->d, l->a, l->alpha, l->screw, l->speed, l->effort};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    if (!isfinite(numbers[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_link_number, "links", index,
                      "links[%ld] has a number that is not finite", index);
  return check_limits(l, joint, err);
}

CagStatus cag_robot_link_check(const CagRobotLink *link, CagError *err) {
  return check_link(link, -1, -1, err);
}

// --- Construction ---

CagRobotLink cag_robot_link(CagJointKind kind) {
  CagRobotLink l = {.kind = kind, .fixed = cag_transform_identity()};
  if (kind == CAG_JOINT_REVOLUTE) {
    l.low = -M_PI;
    l.high = M_PI;
  }
  return l;
}

CagRobot *cag_robot_retain(const CagRobot *r) {
  CagRobot *mine = (CagRobot *)r;
  if (mine) mine->references++;
  return mine;
}

void cag_robot_release(CagRobot *r) {
  if (!r || --r->references > 0) return;
  cag_free(r->links);
  cag_free(r->joint_link);
  cag_free(r->stages);
  cag_free(r->coupling);
  cag_free(r->coupling_inverse);
  cag_free(r->coupling_offset);
  cag_free(r);
}

static CagRobot *allocate(const CagRobotSpec *spec, size_t joints) {
  CagRobot *r = cag_calloc(1, sizeof *r);
  if (!r) return NULL;
  r->references = 1;
  r->link_count = spec->link_count;
  r->joint_count = joints;
  r->links = cag_malloc(spec->link_count * sizeof *r->links);
  r->joint_link = cag_calloc(joints ? joints : 1, sizeof *r->joint_link);
  r->stages = cag_calloc(joints ? joints : 1, sizeof *r->stages);
  if (r->links && r->joint_link && r->stages) return r;
  cag_robot_release(r);
  return NULL;
}

// --- Stages ---

static void put_transform(CagRobotStage *s, CagTransform *before, const CagTransform *t) {
  CagTransform *place = s ? &s->fixed : before;
  *place = cag_transform_multiply(place, t);
  if (s) s->has_fixed = true;
}

static bool is_identity(const CagTransform *t) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (t->m[i][j] != (i == j)) return false;
  return true;
}

// Translation along x and rotation about x: the constant part of a row. It is stored in the stage
// itself if no transform is in between.
static void put_crank(CagRobotStage *s, CagTransform *before, double a, double alpha) {
  if (s && !s->has_fixed && s->a == 0 && s->alpha == 0) {
    s->a = a;
    s->alpha = alpha;
    return;
  }
  CagTransform t = cag_dh(0, 0, a, alpha);
  if (!is_identity(&t)) put_transform(s, before, &t);
}

static void fill_stages(CagRobot *r) {
  CagRobotStage *stage = NULL;
  size_t joint = 0;
  r->before = r->base;
  for (size_t i = 0; i < r->link_count; i++) {
    const CagRobotLink *l = &r->links[i];
    if (l->kind == CAG_JOINT_FIXED) {
      if (!is_identity(&l->fixed)) put_transform(stage, &r->before, &l->fixed);
      continue;
    }
    bool modified = r->convention == CAG_ROBOT_MODIFIED;
    if (modified) put_crank(stage, &r->before, l->a, l->alpha);
    stage = &r->stages[joint];
    r->joint_link[joint++] = i;
    bool turns = l->kind == CAG_JOINT_REVOLUTE;
    *stage = (CagRobotStage){.turn = turns ? 1 : 0,
                             .angle = l->theta,
                             .slide = turns ? l->screw : 1,
                             .shift = l->d,
                             .fixed = cag_transform_identity()};
    if (!modified) put_crank(stage, &r->before, l->a, l->alpha);
  }
  if (!is_identity(&r->tool)) put_transform(stage, &r->before, &r->tool);
  for (size_t i = 0; i < r->joint_count; i++)
    cag_sincos(r->stages[i].alpha, &r->stages[i].sine, &r->stages[i].cosine);
}

// The sum of the maximum lengths of all links.
static double reach_of(const CagRobot *r) {
  double sum = 0;
  for (size_t i = 0; i < r->joint_count; i++) {
    const CagRobotStage *s = &r->stages[i];
    const CagRobotLink *l = &r->links[r->joint_link[i]];
    double travel = fmax(fabs(s->shift + s->slide * l->low), fabs(s->shift + s->slide * l->high));
    sum += travel + fabs(s->a);
    if (s->has_fixed)
      sum += cag_norm(cag_vec3(s->fixed.m[0][3], s->fixed.m[1][3], s->fixed.m[2][3]));
  }
  return sum > 0 ? sum : 1;
}

// --- Couplings ---

// Inverts an n x n matrix, which becomes the identity, by Gauss-Jordan elimination with row pivots.
// False: it is singular.
static bool invert(double *m, size_t n, double *out) {
  double largest = 0;
  for (size_t i = 0; i < n * n; i++) largest = fmax(largest, fabs(m[i]));
  for (size_t i = 0; i < n * n; i++) out[i] = i % (n + 1) == 0;
  for (size_t k = 0; k < n; k++) {
    size_t pivot = k;
    for (size_t i = k + 1; i < n; i++)
      if (fabs(m[i * n + k]) > fabs(m[pivot * n + k])) pivot = i;
    if (!(fabs(m[pivot * n + k]) > COUPLING_SINGULAR * largest)) return false;
    for (size_t j = 0; j < n; j++) {
      double a = m[k * n + j], b = out[k * n + j];
      m[k * n + j] = m[pivot * n + j];
      out[k * n + j] = out[pivot * n + j];
      m[pivot * n + j] = a;
      out[pivot * n + j] = b;
    }
    double scale = m[k * n + k];
    for (size_t j = 0; j < n; j++) {
      m[k * n + j] /= scale;
      out[k * n + j] /= scale;
    }
    for (size_t i = 0; i < n; i++) {
      double factor = i == k ? 0 : m[i * n + k];
      if (factor == 0) continue;
      for (size_t j = 0; j < n; j++) {
        m[i * n + j] -= factor * m[k * n + j];
        out[i * n + j] -= factor * out[k * n + j];
      }
    }
  }
  return true;
}

static CagStatus fill_coupling(CagRobot *r, const CagRobotSpec *spec, CagError *err) {
  size_t n = r->joint_count;
  if (!spec->coupling || n == 0) return CAG_OK;
  r->coupling = cag_malloc(n * n * sizeof(double));
  r->coupling_inverse = cag_malloc(n * n * sizeof(double));
  r->coupling_offset = cag_calloc(n, sizeof(double));
  if (!r->coupling || !r->coupling_inverse || !r->coupling_offset) return cag_fail_memory(err);
  memcpy(r->coupling, spec->coupling, n * n * sizeof(double));
  if (spec->coupling_offset) memcpy(r->coupling_offset, spec->coupling_offset, n * sizeof(double));
  for (size_t i = 0; i < n * n; i++)
    if (!isfinite(r->coupling[i]) || !isfinite(r->coupling_offset[i / n]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_coupling_singular, "coupling", (long)(i / n),
                      "row %zu of the coupling has a number that is not finite", i / n + 1);
  double *work = cag_malloc(n * n * sizeof *work);
  if (!work) return cag_fail_memory(err);
  memcpy(work, r->coupling, n * n * sizeof *work);
  const bool regular = invert(work, n, r->coupling_inverse);
  cag_free(work);
  if (regular) return CAG_OK;
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_coupling_singular, "coupling", -1,
      "the coupling matrix is singular: the motor values do not determine the joint values; each joint needs a motor of its own");
}

void cag_robot_motors(const CagRobot *r, const double *q, double *motors) {
  size_t n = r->joint_count;
  for (size_t i = 0; i < n; i++) {
    double sum = r->coupling ? r->coupling_offset[i] : q[i];
    for (size_t j = 0; r->coupling && j < n; j++) sum += r->coupling[i * n + j] * q[j];
    motors[i] = sum;
  }
}

void cag_robot_joints(const CagRobot *r, const double *motors, double *q) {
  size_t n = r->joint_count;
  for (size_t i = 0; i < n; i++) {
    double sum = r->coupling ? 0 : motors[i];
    for (size_t j = 0; r->coupling && j < n; j++)
      sum += r->coupling_inverse[i * n + j] * (motors[j] - r->coupling_offset[j]);
    q[i] = sum;
  }
}

static CagStatus check_spec(const CagRobotSpec *spec, size_t *joints, CagError *err) {
  *joints = 0;
  if (spec->link_count == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_chain, "links", -1,
                    "a robot needs at least one link");
  for (size_t i = 0; i < spec->link_count; i++) {
    CagStatus status = check_link(&spec->links[i], (long)i, (long)*joints, err);
    if (status) return status;
    *joints += spec->links[i].kind != CAG_JOINT_FIXED;
  }
  if (*joints > CAG_ROBOT_JOINTS_MAX)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_many_joints, "links", -1,
                    "a robot can have at most %d joints, found %zu", CAG_ROBOT_JOINTS_MAX, *joints);
  CagStatus status = check_rigid(&spec->base, "base", -1, err);
  return status ? status : check_rigid(&spec->tool, "tool", -1, err);
}

CagStatus cag_robot_new(const CagRobotSpec *spec, CagRobot **out, CagError *err) {
  size_t joints;
  CagStatus status = check_spec(spec, &joints, err);
  if (status) return status;
  CagRobot *r = allocate(spec, joints);
  if (!r) return cag_fail_memory(err);
  memcpy(r->links, spec->links, spec->link_count * sizeof *r->links);
  r->convention = spec->convention;
  r->base = spec->base;
  r->tool = spec->tool;
  fill_stages(r);
  r->reach = reach_of(r);
  status = r->reach < REACH_MAX
               ? fill_coupling(r, spec, err)
               : cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_link_number, "links", -1,
                          "the lengths of the links add up to more than %g", REACH_MAX);
  if (status) cag_robot_release(r);
  else *out = r;
  return status;
}

// --- Frames ---

void cag_robot_forward(const CagRobot *r, const double *q, CagTransform *tool) {
  CagRobotTurns turns;
  CagRobotFrame f;
  cag_robot_turns(r, q, &turns);
  cag_robot_frame_from(&r->before, &f);
  for (size_t i = 0; i < r->joint_count; i++)
    cag_robot_advance(&f, &r->stages[i], turns.sine[i], turns.cosine[i], q[i]);
  cag_robot_frame_to(&f, tool);
}

// The transform of a single link.
static CagTransform link_transform(const CagRobot *r, const CagRobotLink *l, double q) {
  if (l->kind == CAG_JOINT_FIXED) return l->fixed;
  bool turns = l->kind == CAG_JOINT_REVOLUTE;
  double theta = l->theta + (turns ? q : 0), d = l->d + (turns ? l->screw * q : q);
  return r->convention == CAG_ROBOT_MODIFIED ? cag_mdh(theta, d, l->a, l->alpha)
                                             : cag_dh(theta, d, l->a, l->alpha);
}

// Without negative zeros.
static CagTransform cleaned(CagTransform t) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) t.m[i][j] += 0.0;
  t.planar = false;
  return t;
}

static CagTransform product_of_links(const CagRobot *r, const double *q, size_t from, size_t to,
                                     CagTransform start, CagTransform *frames) {
  size_t joint = 0;
  CagTransform t = start;
  for (size_t i = 0; i < to; i++) {
    const CagRobotLink *l = &r->links[i];
    double value = l->kind == CAG_JOINT_FIXED ? 0 : q[joint++];
    if (i < from) continue;
    CagTransform a = link_transform(r, l, value);
    t = cag_transform_multiply(&t, &a);
    if (frames) frames[i + 1] = cleaned(t);
  }
  return cleaned(t);
}

void cag_robot_frames(const CagRobot *r, const double *q, CagTransform *frames) {
  frames[0] = cleaned(r->base);
  product_of_links(r, q, 0, r->link_count, r->base, frames);
}

void cag_robot_subchain(const CagRobot *r, const double *q, size_t j, size_t i, CagTransform *out) {
  bool backwards = i < j;
  CagTransform t =
      product_of_links(r, q, backwards ? i : j, backwards ? j : i, cag_transform_identity(), NULL);
  *out = backwards ? cleaned(cag_robot_rigid_inverse(&t)) : t;
}

void cag_robot_axes(const CagRobot *r, const double *q, CagVec3 *points, CagVec3 *directions) {
  CagRobotTurns turns;
  CagRobotFrame f;
  cag_robot_turns(r, q, &turns);
  cag_robot_frame_from(&r->before, &f);
  for (size_t i = 0; i < r->joint_count; i++) {
    points[i] = f.p;
    directions[i] = f.z;
    cag_robot_advance(&f, &r->stages[i], turns.sine[i], turns.cosine[i], q[i]);
  }
}

CagTransform cag_robot_rigid_inverse(const CagTransform *t) {
  CagTransform out = cag_transform_identity();
  out.planar = false;
  for (int i = 0; i < 3; i++) {
    out.m[i][3] = 0;
    for (int j = 0; j < 3; j++) {
      out.m[i][j] = t->m[j][i];
      out.m[i][3] -= t->m[j][i] * t->m[j][3];
    }
  }
  return out;
}

// --- Skeleton ---

static CagVec3 origin_of(const CagTransform *t) {
  return cag_vec3(t->m[0][3], t->m[1][3], t->m[2][3]);
}

size_t cag_robot_skeleton(const CagRobot *r, const double *q, CagVec3 *points) {
  CagTransform frame = r->base;
  size_t n = 0, joint = 0;
  points[n++] = origin_of(&frame);
  for (size_t i = 0; i < r->link_count; i++) {
    const CagRobotLink *l = &r->links[i];
    double value = l->kind == CAG_JOINT_FIXED ? 0 : q[joint++];
    CagTransform a = link_transform(r, l, value);
    CagVec3 origin = origin_of(&a), bend = origin;
    if (l->kind != CAG_JOINT_FIXED)
      bend = r->convention == CAG_ROBOT_MODIFIED ? cag_vec3(l->a, 0, 0) : cag_vec3(0, 0, a.m[2][3]);
    if (l->kind != CAG_JOINT_FIXED) points[n++] = cag_transform_point(&frame, bend);
    points[n++] = cag_transform_point(&frame, origin);
    frame = cag_transform_multiply(&frame, &a);
  }
  if (!is_identity(&r->tool)) points[n++] = cag_transform_point(&frame, origin_of(&r->tool));
  return n;
}

// --- Limits ---

static double limit_slack(const CagRobot *r, const CagRobotLink *l) {
  return l->kind == CAG_JOINT_REVOLUTE ? ON_LIMIT * 2 * M_PI : ON_LIMIT * r->reach;
}

double cag_robot_joint_outside(const CagRobot *r, size_t joint, double q, double *limit) {
  const CagRobotLink *l = &r->links[r->joint_link[joint]];
  double over = fmax(l->low - q, q - l->high);
  *limit = q < l->low ? l->low : l->high;
  return over > limit_slack(r, l) ? over : 0;
}

size_t cag_robot_outside(const CagRobot *r, const double *q, double *by) {
  double limit;
  *by = 0;
  for (size_t i = 0; i < r->joint_count; i++) {
    *by = cag_robot_joint_outside(r, i, q[i], &limit);
    if (*by > 0) return i;
  }
  return r->joint_count;
}

// Among q and the values whole turns away from it, the one within the limits that is nearest to
// `wanted`.
static bool turn_into(const CagRobotLink *l, double slack, double wanted, double *q) {
  const double turn = 2 * M_PI;
  double x = wanted + remainder(*q - wanted, turn);
  if (x > l->high + slack) x -= ceil((x - l->high - slack) / turn) * turn;
  if (x < l->low - slack) x += ceil((l->low - slack - x) / turn) * turn;
  if (x > l->high + slack) return false;
  *q = fmin(fmax(x, l->low), l->high);
  return true;
}

bool cag_robot_into_limits(const CagRobot *r, const double *near, double *q) {
  for (size_t i = 0; i < r->joint_count; i++) {
    const CagRobotLink *l = &r->links[r->joint_link[i]];
    double slack = limit_slack(r, l);
    // Turns of a screw joint are not equivalent: each advances by the lead.
    bool turns = l->kind == CAG_JOINT_REVOLUTE && l->screw == 0;
    if (turns) {
      if (!turn_into(l, slack, near ? near[i] : q[i], &q[i])) return false;
      continue;
    }
    if (q[i] < l->low - slack || q[i] > l->high + slack) return false;
    q[i] = fmin(fmax(q[i], l->low), l->high);
  }
  return true;
}

void cag_robot_home(const CagRobot *r, double *q) {
  for (size_t i = 0; i < r->joint_count; i++) q[i] = r->links[r->joint_link[i]].home;
}
