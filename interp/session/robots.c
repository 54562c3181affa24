// The robots that a scene shows, and where their parts go if their joints move.
//
// A robot is a run of items that have limbs of one posture, in the same place and in ascending
// order. So a drawing that is shown twice is two robots.
//
// A part that moves with a frame F of the chain goes, in the world of the robot, from F(q0) to
// F(q). Its motion in the scene is base F(q) F(q0)^-1 base^-1.

#include "interp/session/robots.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/robot/path.h"
#include "interp/builtin/shapes.h"

// Poses are equally close if their errors differ by less than this fraction.
#define AS_CLOSE 0.03
// Axes of a target are dependent if they are shorter than this fraction after orthogonalization.
#define DEPENDENT 1e-6
// A rod is not made shorter than this fraction of the reach, so that its motion has an inverse.
#define ROD_SHORTEST 1e-6

// --- The list ---

void cag_session_drop_robots(CagSession *s) {
  CagSessionRobots *all = s->robots;
  if (!all) return;
  for (size_t i = 0; i < all->count; i++) cag_free(all->items[i].name);
  cag_free(all->items);
  cag_free(all->parts);
  cag_free(all->numbers);
  cag_hash_free(&all->names);
  cag_free(all);
  s->robots = NULL;
}

static bool same_transform(const CagTransform *a, const CagTransform *b) {
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 4; k++)
      if (a->m[i][k] != b->m[i][k]) return false;
  return true;
}

// Whether a limb belongs to the robot whose last part is `last`.
static bool continues(const CagLimb *last, const CagLimb *limb) {
  return last && last->posture == limb->posture && last->number < limb->number &&
         same_transform(&last->motion, &limb->motion);
}

static bool find_name(const CagSessionRobots *all, const char *name, size_t *out) {
  const uint64_t hash = cag_hash_text(CAG_HASH_START, name);
  for (CagHashWalk w = cag_hash_walk(&all->names, hash); cag_hash_next(&w, out);)
    if (!strcmp(all->items[*out].name, name)) return true;
  return false;
}

// Returns "arm", "arm 2", "arm 3" ..., or NULL if memory ran out. The search goes on from the last
// number of the name, so that naming many robots alike takes linear time.
static char *robot_name(CagSessionRobots *all, const char *wanted) {
  const size_t size = strlen(wanted) + 24;
  size_t first, taken;
  char *name = cag_malloc(size);
  if (!name) return NULL;
  snprintf(name, size, "%s", wanted);
  if (!find_name(all, name, &first)) return name;
  do snprintf(name, size, "%s %zu", wanted, ++all->items[first].last_number);
  while (find_name(all, name, &taken));
  return name;
}

static bool begin_robot(CagSessionRobots *all, const CagItem *item, const CagLimb *limb) {
  CagError ignored;
  const CagText *own = limb->posture->robot->name;
  if (!CAG_RESERVE(all->items, all->capacity, all->count + 1)) return false;
  CagSessionRobot *r = &all->items[all->count];
  *r = (CagSessionRobot){.name = robot_name(all, own->length ? own->bytes : item->name),
                         .last_number = 1,
                         .chain = limb->posture->robot->robot,
                         .posture = limb->posture,
                         .base = limb->motion,
                         .first = all->part_count};
  r->flat = cag_transform_inverse(&r->base, &r->back, &ignored) != CAG_OK;
  if (!r->name) return false;
  all->count++;
  return cag_hash_add(&all->names, cag_hash_text(CAG_HASH_START, r->name), all->count - 1);
}

// The shape that an item was made of; NULL: none.
static const CagShape *shape_of_item(const CagSession *s, const CagItem *item) {
  const bool known = item->kind != CAG_ITEM_GROUND && item->number < s->sources.count;
  return known ? s->sources.items[item->number].shape : NULL;
}

static bool list_robots(CagSession *s, CagSessionRobots *all) {
  const CagLimb *last = NULL;
  for (size_t i = 0; i < s->scene.item_count; i++) {
    const CagItem *item = &s->scene.items[i];
    const CagShape *shape = shape_of_item(s, item);
    const CagLimb *limb = shape ? shape->limb : NULL;
    if (limb && !continues(last, limb) && !begin_robot(all, item, limb)) return false;
    last = limb;
    if (!limb) continue;
    if (!CAG_RESERVE(all->parts, all->part_capacity, all->part_count + 1)) return false;
    all->parts[all->part_count++] = (CagSessionPart){i, shape};
    all->items[all->count - 1].count++;
  }
  return true;
}

CagSessionRobot *cag_session_robot_at(CagSession *s, size_t i) {
  if (!s->has_scene) return NULL;
  if (!s->robots) {
    CagAccount *before = cag_account_lend(&s->vm->account);
    s->robots = cag_calloc(1, sizeof *s->robots);
    if (s->robots && !list_robots(s, s->robots)) cag_session_drop_robots(s);
    cag_account_lend(before);
  }
  return s->robots && i < s->robots->count ? &s->robots->items[i] : NULL;
}

// --- Descriptions ---

bool cag_session_robot(CagSession *s, size_t i, CagRobotView *out) {
  *out = (CagRobotView){0};
  if (!cag_session_begin(s)) return false;
  const CagSessionRobot *r = cag_session_robot_at(s, i);
  if (r)
    *out = (CagRobotView){.name = r->name,
                          .joint_count = r->chain->joint_count,
                          .part_count = r->count,
                          .frame_count = r->chain->link_count + 1};
  cag_session_end(s, CAG_STATUS_OK);
  return r != NULL;
}

size_t cag_session_robot_part(CagSession *s, size_t robot, size_t k, const char **name) {
  if (!cag_session_begin(s)) return (size_t)-1;
  const CagSessionRobot *r = cag_session_robot_at(s, robot);
  const size_t part = r && k < r->count ? s->robots->parts[r->first + k].item : (size_t)-1;
  if (name) *name = part == (size_t)-1 ? NULL : s->scene.items[part].name;
  cag_session_end(s, CAG_STATUS_OK);
  return part;
}

static const CagRobotLink *link_of_joint(const CagRobot *r, size_t joint) {
  return &r->links[r->joint_link[joint]];
}

// The degrees or millimeters of a joint's value.
static double shown_value(const CagRobotLink *l, double q) {
  return l->kind == CAG_JOINT_REVOLUTE ? cag_degrees_shown(q) : q;
}

bool cag_session_robot_joint(CagSession *s, size_t robot, size_t joint, CagJointView *out) {
  *out = (CagJointView){0};
  if (!cag_session_begin(s)) return false;
  const CagSessionRobot *r = cag_session_robot_at(s, robot);
  const bool found = r && joint < r->chain->joint_count;
  if (found) {
    const CagRobotLink *l = link_of_joint(r->chain, joint);
    const bool turns = l->kind == CAG_JOINT_REVOLUTE;
    *out = (CagJointView){.kind = turns ? "revolute" : "prismatic",
                          .unit = turns ? "deg" : "mm",
                          .low = shown_value(l, l->low),
                          .high = shown_value(l, l->high),
                          .home = shown_value(l, l->home),
                          .value = shown_value(l, r->posture->q[joint])};
    snprintf(out->name, sizeof out->name, "joint %zu", joint + 1);
  }
  cag_session_end(s, CAG_STATUS_OK);
  return found;
}

// --- Joint values ---

static CagStatus read_joints(const CagRobot *r, const double *given, size_t count, double *q,
                             CagError *err) {
  if (count != r->joint_count)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_joint_count, "q", -1,
                    "expected %zu joint value%s as q, one for each joint of the robot, found %zu",
                    r->joint_count, r->joint_count == 1 ? "" : "s", count);
  for (size_t i = 0; i < count; i++) {
    if (!isfinite(given[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "q", (long)i,
                      "expected finite joint values as q, found %g for joint %zu", given[i], i + 1);
    const bool turns = link_of_joint(r, i)->kind == CAG_JOINT_REVOLUTE;
    q[i] = turns ? given[i] * CAG_RADIANS_PER_DEGREE : given[i];
  }
  return CAG_OK;
}

// --- Poses ---

// A chain with joint values. Frames are those of cag_robot_frames, and the tool.
typedef struct Posed {
  CagTransform *frames;
  CagVec3 *points; // of the skeleton
} Posed;

static bool pose_chain(const CagRobot *r, const double *q, Posed *out) {
  out->frames = cag_malloc((r->link_count + 2) * sizeof *out->frames);
  out->points = cag_malloc((2 * r->link_count + 2) * sizeof *out->points);
  if (!out->frames || !out->points) return false;
  cag_robot_frames(r, q, out->frames);
  cag_robot_forward(r, q, &out->frames[r->link_count + 1]);
  cag_robot_skeleton(r, q, out->points);
  return true;
}

static void free_posed(Posed *p) {
  cag_free(p->frames);
  cag_free(p->points);
}

// The inverse of a rigid motion.
static CagTransform rigid_inverse(const CagTransform *t) {
  CagTransform out = cag_transform_identity();
  for (int i = 0; i < 3; i++) {
    out.m[i][3] = 0;
    for (int k = 0; k < 3; k++) {
      out.m[i][k] = t->m[k][i];
      out.m[i][3] -= t->m[k][i] * t->m[k][3];
    }
  }
  out.planar = false;
  return out;
}

// Moves the rod between two points of the skeleton, whose direction is fixed in the frame of the
// limb, and makes it as long as it now is.
static CagTransform rod_motion(const CagRobot *r, const CagLimb *limb, const CagTransform *turn,
                               const Posed *from, const Posed *to) {
  const size_t end = limb->section;
  const CagVec3 p = from->points[end - 1], way = cag_sub(from->points[end], p);
  const CagVec3 along = cag_unit(way), now = cag_sub(to->points[end], to->points[end - 1]);
  double length = cag_dot(now, cag_transform_vector(turn, along));
  const double shortest = ROD_SHORTEST * r->reach;
  if (fabs(length) < shortest) length = length < 0 ? -shortest : shortest;
  const double axis[] = {along.x, along.y, along.z}, more = length / cag_norm(way) - 1;
  CagTransform stretch = cag_transform_identity(), out;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) stretch.m[i][k] += more * axis[i] * axis[k];
  stretch.planar = false;
  out = cag_transform_multiply(turn, &stretch);
  const CagVec3 at = cag_sub(to->points[end - 1], cag_transform_vector(&out, p));
  out.m[0][3] = at.x;
  out.m[1][3] = at.y;
  out.m[2][3] = at.z;
  return out;
}

static CagTransform limb_motion(const CagRobot *r, const CagLimb *limb, const Posed *from,
                                const Posed *to) {
  const CagTransform before = rigid_inverse(&from->frames[limb->frame]);
  const CagTransform motion = cag_transform_multiply(&to->frames[limb->frame], &before);
  return limb->section ? rod_motion(r, limb, &motion, from, to) : motion;
}

static void copy_rows(const CagTransform *t, double out[3][4]) {
  for (int i = 0; i < 3; i++) memcpy(out[i], t->m[i], sizeof out[i]);
}

// Fills the numbers of the pose, for which there is room. The robot is not flat.
static void fill_pose(const CagSessionRobots *all, const CagSessionRobot *robot, const Posed *from,
                      const Posed *to, CagRobotPose *out) {
  const CagRobot *r = robot->chain;
  double(*numbers)[3][4] = all->numbers;
  out->part_count = robot->count;
  out->frame_count = r->link_count + 1;
  out->motions = (const double(*)[3][4])numbers;
  out->frames = (const double(*)[3][4])(numbers + robot->count);
  for (size_t k = 0; k < robot->count; k++) {
    CagTransform m = limb_motion(r, all->parts[robot->first + k].shape->limb, from, to);
    m = cag_transform_multiply(&robot->base, &m);
    m = cag_transform_multiply(&m, &robot->back);
    copy_rows(&m, numbers[k]);
  }
  for (size_t k = 0; k <= r->link_count; k++) {
    const CagTransform f = cag_transform_multiply(&robot->base, &to->frames[k]);
    copy_rows(&f, numbers[robot->count + k]);
  }
  const CagTransform tool = cag_transform_multiply(&robot->base, &to->frames[r->link_count + 1]);
  copy_rows(&tool, out->tool);
}

static CagStatus fail_flat(CagError *err) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_rigid, "robot", -1,
                  "expected a robot with a volume, found one that was flattened by a transform");
}

static CagStatus make_pose(CagSession *s, const CagSessionRobot *robot, const double *given,
                           size_t count, CagRobotPose *out, CagError *err) {
  CagSessionRobots *all = s->robots;
  const CagRobot *r = robot->chain;
  const size_t need = robot->count + r->link_count + 1;
  double q[CAG_ROBOT_JOINTS_MAX];
  Posed from = {0}, to = {0};
  CagStatus status = read_joints(r, given, count, q, err);
  if (!status && robot->flat) status = fail_flat(err);
  if (status) return status;
  if (!CAG_RESERVE(all->numbers, all->number_capacity, need) ||
      !pose_chain(r, robot->posture->q, &from) || !pose_chain(r, q, &to))
    status = cag_fail_memory(err);
  else fill_pose(all, robot, &from, &to, out);
  free_posed(&from);
  free_posed(&to);
  return status;
}

// Ends a call with the error, if there is one.
static int end_call(CagSession *s, CagStatus status, const CagError *err) {
  if (!status) return cag_session_end(s, CAG_STATUS_OK);
  if (status == CAG_E_MEMORY) return cag_session_end(s, cag_session_fail_memory(s));
  cag_diagnostics_add(&s->diagnostics, err->id, NULL, (CagSpan){0, 0}, "%s", err->message);
  return cag_session_end(s, CAG_STATUS_USAGE);
}

int cag_session_robot_pose(CagSession *s, size_t robot, const double *q, size_t count,
                           CagRobotPose *out) {
  CagError err = {0};
  *out = (CagRobotPose){0};
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  const CagSessionRobot *r = cag_session_robot_at(s, robot);
  if (!r) return cag_session_end(s, CAG_STATUS_USAGE);
  CagAccount *before = cag_account_lend(&s->vm->account);
  const CagStatus status = make_pose(s, r, q, count, out, &err);
  cag_account_lend(before);
  return end_call(s, status, &err);
}

// --- Reach ---

// The target in the world of the robot: its axes are made orthogonal, in the order z, x, y, because
// a placement may have scaled them.
static CagStatus read_target(const CagSessionRobot *robot, const double given[3][4],
                             CagTransform *out, CagError *err) {
  CagTransform t = cag_transform_identity();
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 4; k++) {
      if (!isfinite(given[i][k]))
        return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "target", i,
                        "expected finite numbers in the target, found %g", given[i][k]);
      t.m[i][k] = given[i][k];
    }
  t.planar = false;
  if (robot->flat) return fail_flat(err);
  t = cag_transform_multiply(&robot->back, &t);
  const CagVec3 x = cag_vec3(t.m[0][0], t.m[1][0], t.m[2][0]),
                y = cag_vec3(t.m[0][1], t.m[1][1], t.m[2][1]),
                z = cag_vec3(t.m[0][2], t.m[1][2], t.m[2][2]), up = cag_unit(z);
  const CagVec3 right = cag_madd(x, -cag_dot(x, up), up), side = cag_cross(up, cag_unit(right));
  if (!(cag_norm(z) > 0) || !(cag_norm(right) > DEPENDENT * cag_norm(x)) ||
      !(cag_dot(side, y) > DEPENDENT * cag_norm(y)))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_rigid, "target", -1,
                    "expected three perpendicular axes in the target, in the order of those of the "
                    "tool");
  const CagVec3 axes[] = {cag_unit(right), side, up};
  for (int k = 0; k < 3; k++) {
    t.m[0][k] = axes[k].x;
    t.m[1][k] = axes[k].y;
    t.m[2][k] = axes[k].z;
  }
  *out = t;
  return CAG_OK;
}

// A solution, and how far it misses the target: fractions of the reach, and radians.
typedef struct Try {
  double q[CAG_ROBOT_JOINTS_MAX];
  CagRobotFound found;
  double error;
} Try;

static void weigh(const CagRobot *r, bool free, Try *t) {
  t->error = t->found.position / r->reach;
  if (!free) t->error = hypot(t->error, t->found.rotation);
}

// Goes on from `near` without a jump, to the target or to the closest pose on the way. `far`: also
// looks for the closest pose if the target is not reached.
static void try_near(const CagRobot *r, const CagTransform *target, const double *near, bool free,
                     bool far, Try *out) {
  const CagRobotSearch search = {.near = near,
                                 .position = 1e-6,
                                 .rotation = 1e-6,
                                 .position_only = free,
                                 .starts = 1,
                                 .closest = far,
                                 .stay_near = true};
  out->found = cag_robot_search(r, target, &search, out->q);
  weigh(r, free, out);
}

static void try_all(const CagRobot *r, const CagTransform *target, const double *near, bool free,
                    Try *out) {
  CagError ignored;
  const CagRobotGoal goal = {.near = near, .position_only = free};
  cag_robot_solve(r, target, &goal, out->q, &out->found, &ignored);
  weigh(r, free, out);
}

static void reach_target(const CagRobot *r, const CagTransform *target, CagReach orientation,
                         const double *near, Try *best) {
  const bool may_give_up = orientation == CAG_REACH_KEEP && r->joint_count < 6;
  if (may_give_up) {
    try_near(r, target, near, false, false, best);
    if (best->found.solved) return;
  }
  const bool free = orientation == CAG_REACH_FREE || may_give_up;
  Try other;
  try_near(r, target, near, free, true, best);
  if (best->found.solved) return;
  try_all(r, target, near, free, &other);
  if (other.found.solved || other.error < (1 - AS_CLOSE) * best->error) *best = other;
}

// Measures in the scene how far the tool is from the target.
static void measure_reach(const CagSessionRobot *robot, const double given[3][4],
                          const CagTransform *target, const Try *t, CagReachView *out) {
  CagTransform tool;
  double position, rotation;
  cag_robot_forward(robot->chain, t->q, &tool);
  cag_robot_pose_distance(&tool, target, &position, &rotation);
  tool = cag_transform_multiply(&robot->base, &tool);
  out->distance = cag_norm(
      cag_vec3(tool.m[0][3] - given[0][3], tool.m[1][3] - given[1][3], tool.m[2][3] - given[2][3]));
  out->angle = cag_degrees_shown(rotation);
  out->reached = t->found.solved;
}

static CagStatus make_reach(CagSession *s, const CagSessionRobot *robot, const double given[3][4],
                            CagReach orientation, const double *near, size_t count,
                            CagReachView *out, CagError *err) {
  const CagRobot *r = robot->chain;
  double from[CAG_ROBOT_JOINTS_MAX];
  CagTransform target;
  Try best;
  CagStatus status = read_joints(r, near, count, from, err);
  if (!status) status = read_target(robot, given, &target, err);
  if (status) return status;
  reach_target(r, &target, orientation, from, &best);
  measure_reach(robot, given, &target, &best, out);
  for (size_t i = 0; i < count; i++) s->robots->q[i] = shown_value(link_of_joint(r, i), best.q[i]);
  out->q = s->robots->q;
  out->joint_count = count;
  return CAG_OK;
}

int cag_session_robot_reach(CagSession *s, size_t robot, const double target[3][4],
                            CagReach orientation, const double *near, size_t count,
                            CagReachView *out) {
  CagError err = {0};
  *out = (CagReachView){0};
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  const CagSessionRobot *r = cag_session_robot_at(s, robot);
  if (!r) return cag_session_end(s, CAG_STATUS_USAGE);
  return end_call(s, make_reach(s, r, target, orientation, near, count, out, &err), &err);
}
