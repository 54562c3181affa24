// Drawings of robots: the shapes of the links in the current frames, or rods and drums.

#include "interp/builtin/robots.h"
#include "interp/builtin/solids.h"
#include "interp/vm/vm.h"

static const double rod_color[3] = CAG_PLAIN_ROD_COLOR, drum_color[3] = CAG_PLAIN_DRUM_COLOR,
                    foot_color[3] = CAG_PLAIN_FOOT_COLOR;

typedef struct Drawing {
  CagCall *call;
  CagBuilder *items;
  double size;
  CagLimb limb; // of the next shape
} Drawing;

// What the following shapes move with: see CagLimb.
static void go_on_with(Drawing *d, size_t frame, size_t section) {
  d->limb.frame = frame;
  d->limb.section = section;
}

// Adds a shape that nothing else refers to.
static bool add_limb(Drawing *d, CagValue shape) {
  CAG_AS_SHAPE(shape)->limb = cag_limb_new(d->call->vm, &d->limb);
  d->limb.number++;
  return cag_builder_add(d->call->vm, d->items, shape);
}

// Adds a body in one of the default colors, and takes over its reference.
static bool add_body(Drawing *d, CagStatus status, CagSolid **body, const double color[3]) {
  static const char *const names[] = {"color"};
  if (!cag_geometry_ok(d->call, status)) return false;
  CagVm *vm = d->call->vm;
  CagValue shape = cag_solid_value(vm, *body), value = cag_vector(vm, color, 3);
  CAG_AS_SHAPE(shape)->material = CAG_AS_RECORD(cag_record_new(vm, names, &value, 1));
  return add_limb(d, shape);
}

static bool add_rod(Drawing *d, CagVec3 p, CagVec3 q, double radius, const double color[3]) {
  CagSolid *body = NULL;
  if (cag_norm(cag_sub(q, p)) <= CAG_PLAIN_SHORT * d->size) return true;
  CagStatus status = cag_solid_rod(p, q, radius, radius, &body, d->call->err);
  return add_body(d, status, &body, color);
}

// Adds a square bar along the axis of a prismatic joint.
static bool add_slide(Drawing *d, const CagTransform *frame) {
  CagSolid *bar = NULL, *placed = NULL;
  double side = CAG_PLAIN_SLIDE_SIDE * d->size;
  CagStatus status = cag_solid_box(cag_vec3(side, side, CAG_PLAIN_DRUM_LENGTH * d->size), true,
                                   &bar, d->call->err);
  if (!status) status = cag_solid_transform(bar, frame, &placed, d->call->err);
  cag_solid_release(bar);
  return add_body(d, status, &placed, drum_color);
}

static bool add_joint(Drawing *d, const CagRobotLink *l, const CagTransform *frame) {
  if (l->kind == CAG_JOINT_PRISMATIC) return add_slide(d, frame);
  CagVec3 half = cag_vec3(0, 0, CAG_PLAIN_DRUM_LENGTH / 2 * d->size);
  return add_rod(d, cag_transform_point(frame, cag_scaled(half, -1)),
                 cag_transform_point(frame, half), CAG_PLAIN_DRUM_RADIUS * d->size, drum_color);
}

static double length_of(const CagVec3 *points, size_t n) {
  double sum = 0;
  for (size_t i = 1; i < n; i++) sum += cag_norm(cag_sub(points[i], points[i - 1]));
  return sum > 0 ? sum : 1;
}

// Adds the rods between the points of the skeleton. The directions of both rods of a link are fixed
// in a frame: that from the frame before the link to the foot of the common normal in that frame,
// and that from there to the frame after the link in this one.
static bool add_rods(Drawing *d, const CagRobot *r, const CagVec3 *points, size_t n) {
  size_t at = 1;
  for (size_t i = 0; i <= r->link_count; i++) {
    const bool joint = i < r->link_count && r->links[i].kind != CAG_JOINT_FIXED;
    for (size_t k = 0; k < (joint ? 2 : 1) && at < n; k++, at++) {
      go_on_with(d, i + k, at);
      if (!add_rod(d, points[at - 1], points[at], CAG_PLAIN_ROD_RADIUS * d->size, rod_color))
        return false;
    }
  }
  return true;
}

// Draws a robot that has no shapes.
static bool draw_plain(Drawing *d, const CagRobot *r, const double *q, const CagTransform *frames,
                       CagVec3 *points) {
  size_t n = cag_robot_skeleton(r, q, points);
  CagVec3 axes[CAG_ROBOT_JOINTS_MAX], directions[CAG_ROBOT_JOINTS_MAX];
  d->size = length_of(points, n);
  cag_robot_axes(r, q, axes, directions);
  CagVec3 top = cag_vec3(0, 0, -CAG_PLAIN_DRUM_LENGTH / 2 * d->size);
  CagVec3 foot = cag_madd(top, -CAG_PLAIN_FOOT_HEIGHT * d->size, cag_vec3(0, 0, 1));
  if (!add_rod(d, cag_transform_point(&frames[0], foot), cag_transform_point(&frames[0], top),
               CAG_PLAIN_FOOT_RADIUS * d->size, foot_color))
    return false;
  if (!add_rods(d, r, points, n)) return false;
  for (size_t i = 0; i < r->joint_count; i++) {
    go_on_with(d, r->joint_link[i], 0); // the axis of a joint is fixed in the frame before its link
    CagTransform frame;
    CagVec3 z = directions[i];
    CagVec3 side = fabs(z.x) < 0.9 ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
    CagStatus status = cag_axes(axes[i], cag_cross(z, side), cag_cross(z, cag_cross(z, side)),
                                &frame, d->call->err);
    if (!cag_geometry_ok(d->call, status) || !add_joint(d, &r->links[r->joint_link[i]], &frame))
      return false;
  }
  return true;
}

// Adds the shapes that move with a frame of the chain.
static bool add_moved(Drawing *d, const CagTransform *t, size_t frame, CagValue shape) {
  CagVm *vm = d->call->vm;
  CagBuilder *all = cag_builder_new(vm);
  CagValue moved;
  if (shape.type == CAG_NONE) return true;
  if (!cag_transform_apply(vm, t, shape, &moved) || !cag_shapes_collect(d->call, moved, all))
    return false;
  go_on_with(d, frame, 0);
  const CagList *list = CAG_AS_LIST(cag_builder_finish(vm, all));
  for (size_t i = 0; i < list->length; i++)
    if (!add_limb(d, cag_shape_copy(vm, cag_list_get(vm, list, i)))) return false;
  return true;
}

static bool draw(Drawing *d, const CagRobotValue *v, const double *q, CagValue holding) {
  const CagRobot *r = v->robot;
  CagTransform tool, *frames = cag_hold_array(d->call, r->link_count + 1, sizeof *frames);
  CagVec3 *points = cag_hold_array(d->call, 2 * r->link_count + 2, sizeof *points);
  bool shaped = false;
  cag_robot_frames(r, q, frames);
  for (size_t i = 0; i < r->link_count; i++) {
    CagValue shape = CAG_AS_LINK(v->links->as.items[i])->shape;
    shaped = shaped || shape.type != CAG_NONE;
    if (!add_moved(d, &frames[i + 1], i + 1, shape)) return false;
  }
  if (!shaped && !draw_plain(d, r, q, frames, points)) return false;
  cag_robot_forward(r, q, &tool);
  return add_moved(d, &tool, r->link_count + 1, holding);
}

static bool drawing_result(CagCall *call, const CagRobotValue *v, const double *q, CagValue holding,
                           CagValue *result) {
  Drawing d = {.call = call,
               .items = cag_builder_new(call->vm),
               .size = 1,
               .limb = {.posture = cag_posture_new(call->vm, (CagRobotValue *)v, q),
                        .motion = cag_transform_identity()}};
  if (!draw(&d, v, q, holding)) return false;
  *result = cag_group_value(call->vm, cag_builder_finish(call->vm, d.items));
  // Formats that describe robots need the robot of a drawing.
  CAG_AS_SHAPE(*result)->drawn = (CagRobotValue *)v;
  if (v->name->length) CAG_AS_SHAPE(*result)->name = v->name;
  return true;
}

bool cag_robots_posed(CagCall *call, const struct cag_robots_posed *a, CagValue *result) {
  double q[CAG_ROBOT_JOINTS_MAX];
  if (!cag_arg_joints_or_home(call, 1, a->robot, a->limits, q)) return false;
  CagValue holding = cag_given(call, 2) ? a->holding : cag_none();
  // Checked before it is moved, so that errors name this function.
  if (holding.type != CAG_NONE && !cag_shapes_collect(call, holding, cag_builder_new(call->vm)))
    return false;
  return drawing_result(call, CAG_AS_ROBOT(call->values[0]), q, holding, result);
}

bool cag_robot_at_home(CagVm *vm, CagValue robot, CagValue *group) {
  size_t rows;
  double q[CAG_ROBOT_JOINTS_MAX];
  CagValue values[] = {robot, cag_unset(), cag_unset(), cag_unset()};
  CagCall call = {vm, cag_builtin_rows(cag_builtin_find("posed"), &rows), values, 4,
                  &vm->core_error};
  cag_robot_home(CAG_AS_ROBOT(robot)->robot, q);
  const size_t held = vm->held_count;
  const bool ok = drawing_result(&call, CAG_AS_ROBOT(robot), q, cag_none(), group);
  cag_vm_release_held(vm, held);
  return ok;
}
