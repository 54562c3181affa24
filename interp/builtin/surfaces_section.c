// Questions to the equation of a quadric, and plane sections.

#include "geom/surface/section.h"

#include <stdlib.h>
#include <string.h>

#include "geom/surface/motion.h"
#include "interp/builtin/surfaces.h"

static const char QUADRICS[] = "Quadrics";
static const char SECTIONS[] = "Surfaces: sections";

// What cag_arg_quadric reads.
#define EQUATIONS (CAG_TAKES(SURFACE) | CAG_TAKES(SOLID) | CAG_TAKES(GROUP) | CAG_TAKES(LIST))

// --- Quadrics ---

static bool call_coefficients(CagCall *call, CagValue *result) {
  CagQuadric q;
  if (!cag_arg_quadric(call, &q)) return false;
  for (int i = 0; i < 10; i++) q.c[i] += 0.0; // no -0
  *result = cag_vector(call->vm, q.c, 10);
  return true;
}

static bool call_rows(CagCall *call, CagValue *result) {
  CagQuadric q;
  double rows[4][4], *m;
  if (!cag_arg_quadric(call, &q)) return false;
  cag_quadric_rows(&q, rows);
  *result = cag_list_vectors(call->vm, 4, 4, &m);
  for (int i = 0; i < 16; i++) m[i] = rows[i / 4][i % 4] + 0.0;
  return true;
}

static bool call_at(CagCall *call, CagValue *result) {
  static const char *const names[] = {"value", "gradient"};
  CagQuadric q;
  CagVec3 p;
  if (!cag_arg_quadric(call, &q) || !cag_arg_vec(call, 1, &p, NULL)) return false;
  CagValue values[] = {cag_number(cag_quadric_value(&q, p)),
                       cag_point(call->vm, cag_quadric_gradient(&q, p), 3)};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

static bool call_center(CagCall *call, CagValue *result) {
  CagQuadric q;
  CagVec3 p;
  CagError err;
  if (!cag_arg_quadric(call, &q) || !cag_geometry_ok(call, cag_quadric_center(&q, &p, &err), &err))
    return false;
  *result = cag_point(call->vm, p, 3);
  return true;
}

static bool call_tangent(CagCall *call, CagValue *result) {
  CagQuadric q;
  CagVec3 p;
  CagPlane plane;
  CagError err;
  if (!cag_arg_quadric(call, &q) || !cag_arg_vec(call, 1, &p, NULL) ||
      !cag_geometry_ok(call, cag_quadric_tangent_plane(&q, p, &plane, &err), &err))
    return false;
  *result = cag_plane_value(call->vm, &plane);
  return true;
}

static bool call_rulings(CagCall *call, CagValue *result) {
  static const char *const names[] = {"count", "directions"};
  CagQuadric q;
  CagVec3 p;
  CagRulings found;
  CagError err;
  if (!cag_arg_quadric(call, &q) || !cag_arg_vec(call, 1, &p, NULL) ||
      !cag_geometry_ok(call, cag_quadric_rulings(&q, p, &found, &err), &err))
    return false;
  CagValue values[] = {found.all ? cag_text_c(call->vm, "all") : cag_number((double)found.count),
                       cag_points_value(call->vm, found.direction, found.count, 3)};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

static bool call_moved(CagCall *call, CagValue *result) {
  CagQuadric q, moved;
  CagTransform t;
  CagError err;
  if (!cag_arg_quadric(call, &q) || !cag_arg_transform(call, 1, &t) ||
      !cag_geometry_ok(call, cag_quadric_transform(&q, &t, &moved, &err), &err))
    return false;
  for (int i = 0; i < 10; i++) moved.c[i] += 0.0;
  *result = cag_vector(call->vm, moved.c, 10);
  return true;
}

// A plane, or a transform whose x and y axes and origin are a frame of it.
static bool read_frame(CagCall *call, int argument, CagTransform *frame) {
  CagPlane plane;
  if (call->values[argument].type == CAG_TRANSFORM) return cag_arg_transform(call, argument, frame);
  if (!cag_arg_plane(call, argument, &plane)) return false;
  *frame = cag_plane_frame(&plane);
  return true;
}

static bool call_section_conic(CagCall *call, CagValue *result) {
  static const char *const names[] = {"conic", "coefficients", "frame", "class"};
  CagQuadric q;
  CagTransform frame;
  CagConic conic;
  CagConicClass found;
  CagCurve *curve = NULL;
  CagError err;
  if (!cag_arg_quadric(call, &q) || !read_frame(call, 1, &frame)) return false;
  cag_quadric_section(&q, &frame, &conic);
  if (!cag_geometry_ok(call, cag_conic_classify(&conic, &found, &err), &err)) return false;
  bool zero = true;
  for (int i = 0; i < 6; i++) {
    zero = zero && conic.c[i] == 0;
    conic.c[i] += 0.0;
  }
  // A plane that is part of the quadric gives no equation.
  if (!zero && !cag_geometry_ok(call, cag_curve_conic(&conic, &curve, &err), &err)) return false;
  frame.planar = false;
  CagValue values[] = {curve ? cag_curve_value(call->vm, curve) : cag_none(),
                       cag_vector(call->vm, conic.c, 6), cag_transform_value(call->vm, &frame),
                       cag_text_c(call->vm, found.name)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

// --- Frames along a path ---

static bool call_path_frame(CagCall *call, CagValue *result) {
  CagCurve *path, *space = NULL;
  CagError err;
  double t;
  if (!cag_arg_curve(call, 0, &path) ||
      !cag_arg_parameter(call, 1, path->angular, path->start, path->end, false, &t))
    return false;
  CagPathMotion how = {CAG_ORIENT_RMF, {0, 0, 0}, {0, 0, NULL}, {1, 1, NULL}};
  static const char *const orients[] = {"rmf", "frenet", "fixed", NULL};
  int orient = 0;
  if (call->values[2].type == CAG_LIST) {
    how.orient = CAG_ORIENT_UP;
    if (!cag_arg_vec(call, 2, &how.up, NULL)) return false;
  } else if (!cag_arg_choice(call, 2, orients, &orient)) {
    return false;
  } else {
    how.orient = orient == 0 ? CAG_ORIENT_RMF : orient == 1 ? CAG_ORIENT_FRENET : CAG_ORIENT_FIXED;
  }
  CagMotion *motion = NULL;
  CagTransform frame;
  CagStatus status = cag_curve_to_space(path, &space, &err);
  if (status == CAG_OK) status = cag_motion_along(space, &how, &motion, &err);
  if (status == CAG_OK) status = cag_motion_frame(motion, t, &frame, &err);
  cag_curve_release(space);
  cag_motion_release(motion);
  if (!cag_geometry_ok(call, status, &err)) return false;
  frame.planar = false;
  *result = cag_transform_value(call->vm, &frame);
  return true;
}

const CagBuiltin cag_builtins_sections[] = {
    {"coefficients(Q)", call_coefficients, "list",
     "The ten numbers of a quadric, as `quadric` takes them.",
     "print coefficients(ellipsoid(1, 0.5, 0.5))[0..2] // expect: [1, 4, 4]",
     CAG_TAKES(SURFACE) | CAG_TAKES(SOLID) | CAG_TAKES(GROUP), QUADRICS},
    {"quadric_rows(Q)", call_rows, "list",
     "The symmetric matrix of a quadric: p A p = 0 for the points p = [x, y, z, 1].",
     "print quadric_rows([1, 1, 1, 4, 0, 0, 0, 0, 6, -9])[0] // expect: [1, 2, 0, 0]", EQUATIONS,
     QUADRICS},
    {"quadric_at(Q, P)", call_at, "record",
     "The `value` of a quadric's form at a point, negative inside of a closed one, and its "
     "`gradient`.",
     "print quadric_at([1, 1, 1, 0, 0, 0, 0, 0, 0, -9], [1, 2, 2]) // expect: {value: 0, gradient: "
     "[2, 4, 4]}",
     EQUATIONS, QUADRICS},
    {"quadric_center(Q)", call_center, "list",
     "The center of a quadric. One without center, or with a line or plane of them, is an error "
     "(quadric-not-central).",
     "print quadric_center([1, 2, 1, 0, 0, 0, -2, 0, 6, 0]) // expect: [1, 0, -3]", EQUATIONS,
     QUADRICS},
    {"quadric_tangent(Q, P)", call_tangent, "plane",
     "The plane that touches a quadric in a point of it, its normal along the gradient; errors "
     "point-not-on-surface and singular-point.",
     "print quadric_tangent([1, 1, 1, 0, 0, 0, 0, 0, 0, -9], [0, 0, 3]).row // expect: [0, 0, 1, "
     "-3]",
     EQUATIONS, QUADRICS},
    {"quadric_rulings(Q, P)", call_rulings, "record",
     "The straight lines of a quadric through a point of it: `count` is 0, 1, 2 or \"all\" (of "
     "planes), `directions` are unit vectors. Errors as of quadric_tangent.",
     "print quadric_rulings([1, 1, 0, 0, 0, 0, 0, 0, 0, -25], [3, 4, 5]).count // expect: 1",
     EQUATIONS, QUADRICS},
    {"quadric_moved(Q, T)", call_moved, "list", "The ten numbers of the image of a quadric.",
     "print quadric_moved([1, 1, 1, 0, 0, 0, 0, 0, 0, -1], translate([1, 0, 0])) // expect: [1, 1, "
     "1, 0, 0, 0, -2, 0, 0, 0]",
     EQUATIONS, QUADRICS},
    {"section_conic(Q, plane)", call_section_conic, "record",
     "The section of a quadric with a plane, in the coordinates of a frame of the plane: `conic` "
     "is a curve value for `classify`, `branches` and the other functions of conics, "
     "`coefficients` its equation, `frame` the frame (of a plane: its point, and x as near to X as "
     "may be; a transform is itself the frame), `class` as of conics. Where the plane belongs to "
     "the quadric the class is \"plane\" and `conic` none.",
     "s = section_conic(ellipsoid(2, 1, 1), plane([0, 0, 0.6], Z))\n"
     "print s.class, near(classify(s.conic).axes, [1.6, 0.8]) // expect: ellipse true",
     EQUATIONS, QUADRICS},
    {"path_frame(C, t, orient = \"rmf\")", call_path_frame, "transform",
     "The frame that `sweep` carries along a path, at the parameter t: x along the frame's normal, "
     "y along its binormal, z along the tangent. `orient` as of sweep; fixed keeps the frame of "
     "the start.",
     "print near(path_frame(line([0, 0, 0], [0, 0, 4]), 0.5).z, Z) // expect: true",
     CAG_TAKES(CURVE), SECTIONS},
    {0}};
