// Chains with parallel axes: the motion in the plane perpendicular to them is solved separately.
//
// Axes 2, 3, 4 parallel, and axis 5 perpendicular to them: the offset of the origin of link 5 along
// their direction depends only on joint 1. The angle of the last axis to theirs determines joint 5,
// the rotation about it joint 6; the rest is a planar motion, two links and a rotation. All axes
// parallel: the same planar motion, and the prismatic joint.

#include "geom/robot/inverse_parts.h"

static int sign_of(double x) { return x < 0 ? -1 : 1; }
static bool is_square(const InverseRow *r) { return fabs(r->cosine) < INVERSE_PARALLEL; }
static bool is_parallel(const InverseRow *r) { return fabs(r->sine) < INVERSE_PARALLEL; }

bool cag_inverse_is_parallel(const InverseChain *c) {
  const InverseRow *r = c->row;
  if (c->n != 5 && c->n != 6) return false;
  for (size_t i = 0; i < c->n; i++)
    if (!r[i].turns) return false;
  return is_square(&r[0]) && is_parallel(&r[1]) && is_parallel(&r[2]) && is_square(&r[3]) &&
         fabs(r[1].a) > INVERSE_NOTHING * c->reach && fabs(r[2].a) > INVERSE_NOTHING * c->reach &&
         (c->n == 5 || (is_square(&r[4]) && fabs(r[4].a) < INVERSE_NOTHING * c->reach));
}

// --- Two links in the plane ---

// The angles p1 and p2 of two links with a (cos p1, sin p1) + b (cos p2, sin p2) = (x, y); returns
// the number of solutions, 0 to 2.
static int two_links(double a, double b, double x, double y, double scale, double p1[2],
                     double p2[2]) {
  const double cosine = (x * x + y * y - a * a - b * b) / (2 * a * b);
  const double slack = INVERSE_CLAMP * scale * scale / fabs(a * b);
  if (fabs(cosine) > 1 + slack) return 0;
  const double c = fmax(-1, fmin(1, cosine)), s = sqrt(1 - c * c);
  const int n = s > INVERSE_NOTHING ? 2 : 1;
  for (int i = 0; i < n; i++) {
    const double bend = atan2(i ? -s : s, c);
    p1[i] = atan2(y, x) - atan2(b * (i ? -s : s), a + b * c);
    p2[i] = p1[i] + bend;
  }
  return n;
}

// --- Axes 2, 3 and 4 parallel ---

// The orientations of axes 3 and 4 relative to axis 2.
static void senses(const InverseChain *c, double s[2]) {
  s[0] = c->row[1].cosine < 0 ? -1 : 1;
  s[1] = c->row[2].cosine < 0 ? -s[0] : s[0];
}

// Joints 2, 3, 4 for the pose of frame 4 in frame 1.
static void solve_plane(InverseTask *t, const CagRobotFrame *f, double *q, CagConfiguration base,
                        unsigned free) {
  const InverseChain *c = t->chain;
  const InverseRow *r = c->row;
  double s[2], p2[2], p3[2];
  senses(c, s);
  const double p4 = atan2(f->x.y, f->x.x);
  const double x = f->p.x - r[3].a * cos(p4), y = f->p.y - r[3].a * sin(p4);
  const int n = two_links(r[1].a, r[2].a, x, y, c->reach, p2, p3);
  for (int i = 0; i < n; i++) {
    const double theta3 = s[0] * (p3[i] - p2[i]), theta4 = s[1] * (p4 - p3[i]);
    q[1] = inverse_value(&r[1], p2[i]);
    q[2] = inverse_value(&r[2], theta3);
    q[3] = inverse_value(&r[3], theta4);
    base.elbow = sign_of(sin(theta3));
    cag_inverse_keep(t, q, base, free);
  }
  t->placed = t->placed || n > 0;
}

// Joint 5 and the rest, for a value of joint 1. `f` is the pose after joint 5 in frame 1, with all
// of link 5 stripped except its rotation.
static void solve5(InverseTask *t, CagRobotFrame f, double *q, CagConfiguration base,
                   unsigned free) {
  const InverseRow *r = t->chain->row;
  double s[2];
  senses(t->chain, s);
  // Axis 2 is the z axis of frame 1; in frame 4 it is (0, s sin(alpha4), 0).
  const double sense = s[1] * r[3].sine;
  const double theta5 = atan2(sense * f.x.z, sense * f.y.z);
  q[4] = inverse_value(&r[4], theta5);
  InverseRow turn = {.turns = true, .angle = r[4].angle, .cosine = 1};
  cag_inverse_strip_right(&turn, q[4], &f);
  // x of frame 4 before its twist lies in the plane.
  const double x = f.x.x, y = f.x.y;
  CagRobotFrame g = f;
  g.x = cag_vec3(x, y, 0);
  solve_plane(t, &g, q, base, free);
}

static void with_joint1_of5(InverseTask *t, double q1, unsigned free) {
  const InverseChain *c = t->chain;
  double q[CAG_INVERSE_JOINTS_MAX] = {q1};
  CagRobotFrame f = t->target;
  cag_inverse_strip_left(&c->row[0], q1, &f);
  const CagConfiguration base = {.shoulder = sign_of(f.p.x + c->row[0].a)};
  cag_inverse_strip_crank(&c->row[4], &f);
  if (fabs(f.z.z) > 1e-6) { // axis 5 leaves the plane
    t->placed = true;
    return;
  }
  solve5(t, f, q, base, free);
}

// Joint 6 and the rest, for values of joints 1 and 5.
static void with_joint5(InverseTask *t, CagRobotFrame f, double *q, double theta5,
                        CagConfiguration base, unsigned free, bool singular) {
  const InverseChain *c = t->chain;
  const InverseRow *r = c->row;
  double s[2];
  senses(c, s);
  q[4] = inverse_value(&r[4], theta5);
  CagRobotFrame g = f; // frame 6 before its twist, in frame 1
  if (singular) {
    // Joints 2 to 4 can turn against joint 6; `near` determines how far.
    const double p4 = inverse_theta(&r[1], t->near[1]) + s[0] * inverse_theta(&r[2], t->near[2]) +
                      s[1] * inverse_theta(&r[3], t->near[3]);
    CagRobotFrame frame5 = {.x = cag_vec3(1, 0, 0), .y = cag_vec3(0, 1, 0), .z = cag_vec3(0, 0, 1)};
    // Frame 5 from its links: Rot(z, p4) Rot(x, alpha4) Rot(z, theta5) Rot(x, alpha5).
    cag_robot_advance(&frame5,
                      &(CagRobotStage){.turn = 1, .sine = s[1] * r[3].sine, .cosine = r[3].cosine},
                      sin(p4), cos(p4), 0);
    cag_robot_advance(&frame5,
                      &(CagRobotStage){.turn = 1, .sine = r[4].sine, .cosine = r[4].cosine},
                      sin(theta5), cos(theta5), 0);
    const double theta6 = atan2(cag_dot(g.x, frame5.y), cag_dot(g.x, frame5.x));
    q[5] = inverse_value(&r[5], theta6);
  } else {
    // Axis 2 in frame 5 is (sense sin(theta5), 0, ...).
    const double sense = s[1] * r[3].sine * sin(theta5);
    q[5] = inverse_value(&r[5], atan2(-sense * g.y.z, sense * g.x.z));
  }
  InverseRow turn = {.turns = true, .angle = r[5].angle, .cosine = 1};
  cag_inverse_strip_right(&turn, q[5], &g);
  cag_inverse_strip_right(&r[4], q[4], &g);
  CagRobotFrame frame4 = g;
  frame4.x = cag_vec3(g.x.x, g.x.y, 0);
  solve_plane(t, &frame4, q, base, free);
}

static void with_joint1_of6(InverseTask *t, double q1, unsigned free) {
  const InverseChain *c = t->chain;
  const InverseRow *r = c->row;
  double q[CAG_INVERSE_JOINTS_MAX] = {q1}, s[2];
  senses(c, s);
  CagRobotFrame f = t->target;
  cag_inverse_strip_left(&r[0], q1, &f);
  cag_inverse_strip_crank(&r[5], &f);
  // Cosine between the last axis and axis 2: -s sin(alpha4) sin(alpha5) cos(theta5).
  const double cosine = -f.z.z * s[1] * r[3].sine * r[4].sine;
  // sin(theta5) is the component of axis 2 perpendicular to the last axis.
  const double sine = inverse_length(f.x.z, f.y.z);
  CagConfiguration base = {.shoulder = sign_of(f.p.x + r[0].a)};
  if (sine < INVERSE_NOTHING) {
    with_joint5(t, f, q, cosine < 0 ? M_PI : 0, base, free | 8u, true);
    return;
  }
  for (int sign = 1; sign >= -1; sign -= 2) {
    base.wrist = sign;
    with_joint5(t, f, q, atan2(sign * sine, cosine), base, free, false);
  }
}

// The values of joint 1 that bring the point to the plane of axes 2 to 4.
static int joint1(const InverseTask *t, CagVec3 p, double q1[2], unsigned *free) {
  const InverseChain *c = t->chain;
  const InverseRow *r = c->row;
  double s[2], x[2];
  senses(c, s);
  // Offset from the plane: that of links 2, 3, and 4.
  const double height = r[1].shift + s[0] * r[2].shift + s[1] * r[3].shift;
  // Axis 2 is sin(alpha1) (sin theta1, -cos theta1, 0).
  const int n = cag_inverse_trigonometric(-r[0].sine * p.y, r[0].sine * p.x, height, c->reach, x);
  *free = 0;
  if (n >= 0) {
    for (int i = 0; i < n; i++) q1[i] = inverse_value(&r[0], x[i]);
    return n;
  }
  // The point lies on axis 1. With five joints axis 5 lies in the plane.
  if (c->n == 5) {
    CagRobotFrame f = t->target;
    cag_inverse_strip_crank(&r[4], &f);
    if (inverse_length(f.z.x, f.z.y) > INVERSE_NOTHING) {
      const double theta = atan2(f.z.y, f.z.x);
      q1[0] = inverse_value(&r[0], theta);
      q1[1] = inverse_value(&r[0], theta + M_PI);
      return 2;
    }
  }
  *free = 1;
  q1[0] = t->near[0];
  return 1;
}

void cag_inverse_parallel(InverseTask *t) {
  const InverseChain *c = t->chain;
  CagRobotFrame f = t->target;
  double q1[2];
  unsigned free;
  // The origin of link 5 (or 6), after its rotation.
  cag_inverse_strip_crank(&c->row[c->n - 1], &f);
  const int n = joint1(t, f.p, q1, &free);
  for (int i = 0; i < n; i++) {
    if (c->n == 5) with_joint1_of5(t, q1[i], free);
    else with_joint1_of6(t, q1[i], free);
  }
}

void cag_inverse_parallel_labels(const InverseChain *c, const double *q, CagConfiguration *out) {
  const InverseRow *r = c->row;
  double s[2];
  senses(c, s);
  const double p2 = inverse_theta(&r[1], q[1]), theta3 = inverse_theta(&r[2], q[2]);
  const double p3 = p2 + s[0] * theta3, p4 = p3 + s[1] * inverse_theta(&r[3], q[3]);
  double x = r[0].a + r[1].a * cos(p2) + r[2].a * cos(p3) + r[3].a * cos(p4);
  x += r[4].shift * s[1] * r[3].sine * sin(p4); // along axis 5
  if (c->n == 5) x += r[4].a * cos(inverse_theta(&r[4], q[4])) * cos(p4);
  *out = (CagConfiguration){.shoulder = sign_of(x), .elbow = sign_of(sin(theta3))};
  if (c->n == 6) out->wrist = sign_of(sin(inverse_theta(&r[4], q[4])));
}

// --- All axes parallel ---

bool cag_inverse_is_plane(const InverseChain *c) {
  size_t turns = 0, slides = 0;
  for (size_t i = 0; i < c->n; i++) {
    turns += c->row[i].turns;
    slides += !c->row[i].turns;
    if (i + 1 < c->n && !is_parallel(&c->row[i])) return false;
  }
  return turns >= 1 && turns <= 3 && slides <= 1;
}

// The links in the plane: the revolute joints with the following vectors, which include prismatic
// joints and their twists.
typedef struct Plane {
  size_t n, joint[3];
  double sense[3], length[3], lead[3]; // lead: from the joint's angle to that of its vector
  double height;
  size_t slide; // the prismatic joint, and its orientation
  double slide_sense;
  double foot[2], start; // before the first revolute joint: end point and angle
  double rest;           // angle after the last revolute joint
  double last_sense;     // of the last row
} Plane;

// Sine below which an arm is stretched or folded, so that its branches coincide: joint values there
// are known only to the square root of the rounding.
#define STRAIGHT 1e-7

static int elbow_sign(double theta) {
  return fabs(sin(theta)) < STRAIGHT ? 0 : sign_of(sin(theta));
}

static void plane_of(const InverseChain *c, Plane *p) {
  *p = (Plane){.slide = c->n};
  double sense = 1, angle = 0, x = 0, y = 0; // since the last revolute joint
  for (size_t i = 0; i < c->n; i++) {
    const InverseRow *r = &c->row[i];
    if (r->turns) {
      if (p->n) p->length[p->n - 1] = inverse_length(x, y), p->lead[p->n - 1] = atan2(y, x);
      else p->foot[0] = x, p->foot[1] = y, p->start = angle;
      p->joint[p->n] = i;
      p->sense[p->n++] = sense;
      x = r->a, y = 0, angle = 0;
    } else {
      p->slide = i;
      p->slide_sense = sense;
      angle += sense * r->angle;
      x += r->a * cos(angle), y += r->a * sin(angle);
    }
    p->height += sense * r->shift;
    p->rest = angle;
    p->last_sense = sense;
    if (i + 1 < c->n) sense *= r->cosine < 0 ? -1 : 1;
  }
  p->length[p->n - 1] = inverse_length(x, y);
  p->lead[p->n - 1] = atan2(y, x);
}

size_t cag_inverse_plane_turns(const InverseChain *c) {
  Plane p;
  plane_of(c, &p);
  return p.n;
}

// The constant angle by which a prismatic joint between the revolute joints k and k + 1 rotates x.
static double turn_between(const InverseChain *c, const Plane *p, size_t k) {
  double angle = 0;
  if (k + 1 < p->n)
    for (size_t j = p->joint[k] + 1; j < p->joint[k + 1]; j++)
      angle += p->sense[k] * (c->row[p->joint[k]].cosine < 0 ? -1 : 1) * c->row[j].angle;
  return angle;
}

// Values of the plane's revolute joints, for the angles of x after each of them.
static CagConfiguration plane_joints(const InverseChain *c, const Plane *p, const double *x_angle,
                                     double *q) {
  CagConfiguration label = {0};
  double before = p->start;
  for (size_t k = 0; k < p->n; k++) {
    const double theta = p->sense[k] * (x_angle[k] - before);
    q[p->joint[k]] = inverse_value(&c->row[p->joint[k]], theta);
    before = x_angle[k] + turn_between(c, p, k);
    if (k == 1) label.elbow = elbow_sign(theta);
  }
  return label;
}

void cag_inverse_plane_point(InverseTask *t, CagVec3 point, CagVec3 w) {
  const InverseChain *c = t->chain;
  const InverseRow *end = &c->row[c->n - 1];
  Plane p;
  plane_of(c, &p);
  const size_t last = p.n - 1;
  // The point becomes part of the last link.
  const CagVec3 tip = inverse_turn_x(point, end->sine, end->cosine);
  const double across = p.last_sense * tip.y;
  const double x = p.length[last] * cos(p.lead[last]) + tip.x * cos(p.rest) - across * sin(p.rest);
  const double y = p.length[last] * sin(p.lead[last]) + tip.x * sin(p.rest) + across * cos(p.rest);
  p.length[last] = inverse_length(x, y);
  p.lead[last] = atan2(y, x);
  double q[CAG_INVERSE_JOINTS_MAX] = {0}, p1[2], p2[2];
  if (p.slide < c->n) q[p.slide] = p.slide_sense * (w.z - p.height - p.last_sense * tip.z);
  const double to[2] = {w.x - p.foot[0], w.y - p.foot[1]};
  const double nothing = INVERSE_NOTHING * c->reach;
  unsigned free = 0;
  int n = 1;
  p1[0] = p2[0] = atan2(to[1], to[0]);
  if (p.n == 2 && p.length[1] < nothing) { // the second joint rotates the tool about the point
    p2[0] = p1[0] - p.lead[0] + turn_between(c, &p, 0) + p.lead[1] +
            p.sense[1] * inverse_theta(&c->row[p.joint[1]], t->near[p.joint[1]]);
    free = 1u << p.joint[1];
  } else if (p.n == 2 && inverse_length(to[0], to[1]) < nothing &&
             fabs(p.length[0] - p.length[1]) < nothing) { // folded, so the rotation is arbitrary
    p1[0] =
        p.start + p.lead[0] + p.sense[0] * inverse_theta(&c->row[p.joint[0]], t->near[p.joint[0]]);
    p2[0] = p1[0] + M_PI;
    free = 1u << p.joint[0];
  } else if (p.n == 2 && p.length[0] >= nothing) {
    n = two_links(p.length[0], p.length[1], to[0], to[1], c->reach, p1, p2);
  }
  for (int i = 0; i < n; i++) {
    const double x_angle[2] = {p1[i] - p.lead[0], p.n == 2 ? p2[i] - p.lead[1] : 0};
    const CagConfiguration label = plane_joints(c, &p, x_angle, q);
    cag_inverse_keep_point(t, point, w, q, free ? (CagConfiguration){0} : label, free);
  }
}

// Solves for the angles of the links; `turn` is the total rotation of the tool.
void cag_inverse_plane(InverseTask *t) {
  const InverseChain *c = t->chain;
  const CagRobotFrame f = t->target;
  Plane p;
  plane_of(c, &p);
  const size_t last = p.n - 1;
  double q[CAG_INVERSE_JOINTS_MAX] = {0};
  if (p.slide < c->n) q[p.slide] = p.slide_sense * (f.p.z - p.height);
  // The angle of x after the last revolute joint, and the remaining vector for the previous links.
  const double turn = atan2(f.x.y, f.x.x) - p.rest;
  const double tip[2] = {p.length[last] * cos(turn + p.lead[last]),
                         p.length[last] * sin(turn + p.lead[last])};
  const double x = f.p.x - p.foot[0] - tip[0], y = f.p.y - p.foot[1] - tip[1];
  const double nothing = INVERSE_NOTHING * c->reach;
  double p1[2] = {0}, p2[2] = {0};
  int n = 1;
  if (p.n == 3) n = two_links(p.length[0], p.length[1], x, y, c->reach, p1, p2);
  else if (p.n == 2)
    p1[0] = atan2(y, x), n = fabs(inverse_length(x, y) - p.length[0]) < 1e3 * nothing;
  else n = inverse_length(x, y) < 1e3 * nothing;
  // The position may be reachable with another orientation.
  const double away = inverse_length(f.p.x - p.foot[0], f.p.y - p.foot[1]);
  t->placed = n > 0 || (p.n < 3 && away <= p.length[0] + p.length[last] * (double)(p.n - 1) &&
                        away >= fabs(p.length[0] - p.length[last] * (double)(p.n - 1)));
  for (int i = 0; i < n; i++) {
    double x_angle[3]; // of x after each revolute joint
    x_angle[last] = turn;
    unsigned free = 0;
    if (p.n >= 2) x_angle[0] = p1[i] - p.lead[0];
    if (p.n == 3) x_angle[1] = p2[i] - p.lead[1];
    if (p.n == 2 && p.length[0] < nothing) {
      const size_t first = p.joint[0];
      x_angle[0] = p.start + p.sense[0] * inverse_theta(&c->row[first], t->near[first]);
      free = 1u << first;
    }
    const CagConfiguration label = plane_joints(c, &p, x_angle, q);
    cag_inverse_keep(t, q, label, free);
  }
}

void cag_inverse_plane_labels(const InverseChain *c, const double *q, CagConfiguration *out) {
  Plane p;
  plane_of(c, &p);
  *out = (CagConfiguration){0};
  if (p.n >= 2) out->elbow = elbow_sign(inverse_theta(&c->row[p.joint[1]], q[p.joint[1]]));
}
