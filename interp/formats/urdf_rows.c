// Converts a chain of URDF joints to Denavit-Hartenberg rows.
//
// `at` is the current frame of the walk, relative to the frame that the last joint has moved. At
// the next joint, the transform to its axis is constant. By the common normal of the two axes, it
// is Rot(z) Trans(z) Trans(x) Rot(x), which completes the row of the last joint, and a rest, Rot(z)
// Trans(z), which commutes with the next joint's own motion and is added to the transform after it.
// Nearly parallel axes have no usable common normal. The row then stays empty, and a fixed link is
// inserted. Bodies belong to the last row and are transformed when it is completed. Before the
// first joint, the transform is the robot's base, or a fixed link if it has bodies. After the last
// joint, it completes the row, or is the tool.

#include <string.h>

#include "base/memory.h"
#include "geom/robot/kernel.h"
#include "interp/formats/urdf_read.h"

// Directions that differ less, as a sine or in radians, are rounded to a simple one. Files have
// angles with 12 digits or more. An arm of 10 m then ends within 1e-10 m of the exact point.
#define SAME_DIRECTION 1e-11
// Lengths are rounded to 1 / LENGTH_PARTS mm, which is 1e-13 m.
#define LENGTH_PARTS 1e10
#define LENGTH_MOST 1e5
// The maximum distance, in millimeters, of the next axis from where a row leads.
#define OFF_AXIS 1e-10
// If the sine of the angle between axes is smaller, their common normal is not computed, because
// rounding would move it.
#define LEAST_SINE 1e-5

typedef struct Walk {
  const CagUrdfTree *tree;
  CagUrdfRows *out;
  CagTransform at;
  size_t placed_count;
  bool bodies;
} Walk;

// --- Rounding ---

static double round_length(double x) {
  return fabs(x) < LENGTH_MOST ? round(x * LENGTH_PARTS) / LENGTH_PARTS + 0.0 : x;
}

static double round_angle(double x) {
  double quarters = round(x / M_PI_2);
  return fabs(x - quarters * M_PI_2) < SAME_DIRECTION ? quarters * M_PI_2 + 0.0 : x;
}

// Rounds a number that is nearly 0, 1, or -1.
static double round_cosine(double x) {
  double whole = round(x);
  return fabs(x - whole) < SAME_DIRECTION * SAME_DIRECTION + 1e-15 ? whole + 0.0 : x;
}

static void round_frame(CagTransform *t) {
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) t->m[i][j] = round_cosine(t->m[i][j]);
    t->m[i][3] = round_length(t->m[i][3]);
  }
}

static bool is_identity(const CagTransform *t) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (t->m[i][j] != (i == j)) return false;
  return true;
}

// --- Rows ---

// Computes the x axis of a row whose z axis leads to that of t: the direction of the common normal,
// with the sign that makes theta small. Returns false if the axes are nearly parallel.
static bool normal_of(const CagTransform *t, CagVec3 *x) {
  CagVec3 z = cag_vec3(t->m[0][2], t->m[1][2], 0), p = cag_vec3(t->m[0][3], t->m[1][3], 0);
  double sine = hypot(z.x, z.y), away = hypot(p.x, p.y);
  bool parallel = sine < SAME_DIRECTION;
  if (!parallel && sine < LEAST_SINE) return false;
  *x = cag_vec3(1, 0, 0);
  if (!parallel) *x = cag_vec3(-z.y / sine, z.x / sine, 0);
  else if (away > OFF_AXIS) *x = cag_vec3(p.x / away, p.y / away, 0);
  else if (z.x == 0 && t->m[2][2] > 0) *x = cag_vec3(t->m[0][0], t->m[1][0], 0);
  bool back = x->x < -SAME_DIRECTION;
  if (fabs(x->x) <= SAME_DIRECTION)
    back = fabs(cag_dot(p, *x)) > OFF_AXIS ? cag_dot(p, *x) < 0 : x->y < 0;
  if (back) *x = cag_scaled(*x, -1);
  return true;
}

// Computes theta, d, a, and alpha of a row that leads from one axis to the next, and the remaining
// rotation and translation about that axis. Returns false if there are no suitable ones.
static bool as_row(const CagTransform *t, CagRobotLink *l, CagTransform *rest) {
  CagVec3 x;
  if (!normal_of(t, &x)) return false;
  CagVec3 y = cag_vec3(-x.y, x.x, 0);
  CagVec3 z = cag_vec3(t->m[0][2], t->m[1][2], t->m[2][2]);
  CagVec3 p = cag_vec3(t->m[0][3], t->m[1][3], t->m[2][3]);
  double sine = -cag_dot(z, y); // of alpha
  bool parallel = fabs(sine) < SAME_DIRECTION;
  double beyond = parallel ? 0 : -cag_dot(p, y) / sine;
  l->theta = round_angle(atan2(x.y, x.x));
  l->alpha = round_angle(atan2(sine, z.z));
  l->a = round_length(cag_dot(p, x));
  l->d = round_length(p.z - beyond * z.z);
  CagTransform row = cag_dh(l->theta, l->d, l->a, l->alpha), back = cag_robot_rigid_inverse(&row);
  *rest = cag_transform_multiply(&back, t);
  if (hypot(rest->m[0][2], rest->m[1][2]) > SAME_DIRECTION || rest->m[2][2] < 0) return false;
  if (hypot(rest->m[0][3], rest->m[1][3]) > OFF_AXIS) return false;
  *rest =
      cag_dh(round_angle(atan2(rest->m[1][0], rest->m[0][0])), round_length(rest->m[2][3]), 0, 0);
  return true;
}

static CagUrdfRow *add_row(Walk *w, CagJointKind kind) {
  CagUrdfRow *row = &w->out->rows[w->out->row_count++];
  *row = (CagUrdfRow){.link = cag_robot_link(kind), .first = w->placed_count};
  return row;
}

static bool has_bodies(const Walk *w, size_t node) {
  const CagUrdfNode *n = &w->tree->nodes[node];
  return w->bodies && (n->visuals || n->collisions);
}

static void add_bodies(Walk *w, size_t node) {
  if (!has_bodies(w, node)) return;
  w->out->placed[w->placed_count++] = (CagUrdfPlaced){node, w->at};
  // Bodies before the first joint are counted when they have a row.
  if (w->out->row_count > 0) w->out->rows[w->out->row_count - 1].count++;
}

// Transforms the bodies of the row to a frame at t.
static void carry(Walk *w, const CagUrdfRow *row, const CagTransform *t) {
  CagTransform back = cag_robot_rigid_inverse(t);
  for (size_t i = row->first; i < row->first + row->count; i++)
    w->out->placed[i].place = cag_transform_multiply(&back, &w->out->placed[i].place);
}

// Makes the transform from the last joint to `t` part of its row, except for `rest`. Returns false
// if it is not the transform of a row.
static bool complete(Walk *w, const CagTransform *t, CagTransform *rest) {
  CagRobotLink row = {.kind = CAG_JOINT_FIXED};
  if (w->out->row_count == 0) return false;
  CagUrdfRow *last = &w->out->rows[w->out->row_count - 1];
  if (last->link.kind == CAG_JOINT_FIXED || !as_row(t, &row, rest)) return false;
  last->link.theta = row.theta;
  last->link.d = row.d;
  last->link.a = row.a;
  last->link.alpha = row.alpha;
  CagTransform done = cag_dh(row.theta, row.d, row.a, row.alpha);
  carry(w, last, &done);
  return true;
}

// Continues to the next joint's frame. Returns the part of the transform that remains after that
// joint.
static CagTransform go_to(Walk *w, CagTransform t) {
  CagTransform rest = cag_transform_identity();
  round_frame(&t);
  if (complete(w, &t, &rest)) return rest;
  bool first = w->out->row_count == 0;
  rest = cag_transform_identity();
  if (first && w->placed_count == 0) {
    w->out->base = t;
    return rest;
  }
  CagUrdfRow *row = add_row(w, CAG_JOINT_FIXED);
  row->link.fixed = t;
  if (!first) return rest;
  row->first = 0;
  row->count = w->placed_count;
  carry(w, row, &t);
  return rest;
}

// --- Joints ---

// Returns the smallest rotation that brings z to the axis.
static CagTransform to_axis(CagVec3 u) {
  CagTransform t = cag_transform_identity();
  CagError err;
  double x = round_cosine(u.x), y = round_cosine(u.y), z = round_cosine(u.z);
  if (x == 0 && y == 0) {
    if (z < 0) t = cag_dh(0, 0, 0, M_PI);
    return t;
  }
  double angle = round_angle(atan2(hypot(x, y), z));
  cag_rotate(cag_vec3(-y, x, 0), angle, cag_vec3(0, 0, 0), &t, &err); // an axis that is not zero
  t.planar = false;
  return t;
}

static void add_joint(Walk *w, const CagUrdfEdge *e, double screw) {
  CagTransform turn = to_axis(e->axis), way = cag_transform_multiply(&w->at, &e->origin);
  CagTransform rest = go_to(w, cag_transform_multiply(&way, &turn));
  CagUrdfRow *row =
      add_row(w, e->kind == CAG_URDF_PRISMATIC ? CAG_JOINT_PRISMATIC : CAG_JOINT_REVOLUTE);
  CagRobotLink *l = &row->link;
  l->low = e->low;
  l->high = e->high;
  l->home = l->kind == CAG_JOINT_REVOLUTE ? fmin(fmax(0, e->low), e->high) : e->low;
  l->speed = e->speed;
  l->effort = e->effort;
  l->screw = screw;
  CagTransform back = cag_robot_rigid_inverse(&turn);
  w->at = cag_transform_multiply(&rest, &back);
}

// Tests for a screw: two joints about and along the same axis, of which the prismatic one follows
// the revolute one.
static bool is_screw(const CagUrdfEdge *slide, const CagUrdfEdge *turn) {
  CagTransform origin = turn->origin;
  round_frame(&origin);
  return slide->kind == CAG_URDF_PRISMATIC && turn->kind <= CAG_URDF_CONTINUOUS && !turn->mimic &&
         !strcmp(slide->mimic, turn->name) && slide->offset == 0 && is_identity(&origin) &&
         cag_norm(cag_sub(slide->axis, turn->axis)) < SAME_DIRECTION;
}

static CagStatus fail_joint(const CagUrdfTree *t, const CagUrdfEdge *e, CagError *err) {
  if (e->mimic)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_urdf_joint, "path", e->line,
                    "%s, line %ld: the joint \"%.60s\" follows the joint \"%.60s\"; joints of a "
                    "chain must be independent: remove its <mimic>, or end the chain before it "
                    "(tip: \"%.60s\")",
                    t->file, e->line, e->name, e->mimic, t->nodes[e->parent].name);
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_urdf_joint, "path", e->line,
      "%s, line %ld: the joint \"%.60s\" is %s; each joint of a chain must rotate about or slide along one axis; begin after it (base: \"%.60s\")",
      t->file, e->line, e->name, e->kind == CAG_URDF_PLANAR ? "planar" : "floating",
      t->nodes[e->child].name);
}

static CagStatus add_edges(Walk *w, const size_t *chain, size_t n, CagError *err) {
  const CagUrdfTree *t = w->tree;
  for (size_t i = 0; i < n; i++) {
    const CagUrdfEdge *e = &t->edges[chain[i]], *next = i + 1 < n ? &t->edges[chain[i + 1]] : NULL;
    if (e->kind >= CAG_URDF_FLOATING) return fail_joint(t, e, err);
    if (e->kind == CAG_URDF_FIXED) {
      w->at = cag_transform_multiply(&w->at, &e->origin);
    } else if (!e->mimic) {
      add_joint(w, e, 0);
    } else if (next && is_screw(e, next)) {
      const double millimeters = 1000;
      CagUrdfEdge whole = *next;
      whole.origin = e->origin;
      add_joint(w, &whole, e->multiplier * millimeters);
      e = next;
      i++;
    } else {
      return fail_joint(t, e, err);
    }
    add_bodies(w, e->child);
  }
  return CAG_OK;
}

CagStatus cag_urdf_rows(const CagUrdfTree *t, const char *base, const size_t *chain, size_t n,
                        bool bodies, CagUrdfRows *out, CagError *err) {
  size_t first = n > 0 ? t->edges[chain[0]].parent : CAG_URDF_NONE;
  for (size_t i = 0; n == 0 && i < t->node_count; i++)
    if (base ? !strcmp(t->nodes[i].name, base) : t->nodes[i].above == CAG_URDF_NONE) first = i;
  *out = (CagUrdfRows){.rows = cag_calloc(2 * n + 2, sizeof *out->rows),
                       .placed = cag_calloc(n + 1, sizeof *out->placed),
                       .base = cag_transform_identity(),
                       .tool = cag_transform_identity()};
  if (!out->rows || !out->placed) return cag_fail_memory(err);
  Walk w = {.tree = t, .out = out, .at = cag_transform_identity(), .bodies = bodies};
  if (first != CAG_URDF_NONE) add_bodies(&w, first);
  CagStatus status = add_edges(&w, chain, n, err);
  if (status) return status;
  if (out->row_count == 0) { // no joint at all
    go_to(&w, w.at);
    if (out->row_count == 0) add_row(&w, CAG_JOINT_FIXED);
    return CAG_OK;
  }
  round_frame(&w.at);
  if (!complete(&w, &w.at, &out->tool)) out->tool = w.at;
  return CAG_OK;
}

void cag_urdf_rows_free(CagUrdfRows *r) {
  cag_free(r->rows);
  cag_free(r->placed);
}
