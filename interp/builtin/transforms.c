// The table of transforms, planes, and points and lines in the plane.
//
// The names that also take first what they move have two rows: see transforms_move.c.

#include "interp/builtin/transforms.h"

#define MOVED (CAG_TAKES_MOVABLE | CAG_TAKES(LIST))
#define LISTS CAG_TAKES_LISTS
#define OF_TRANSFORM CAG_TAKES(TRANSFORM)

static const char family[] = "Transforms";
static const char in_the_plane[] = "Plane geometry";

const CagBuiltin cag_builtins_transforms[] = {
    // --- Made, or applied at once ---
    {"translate(V: vector)", cag_transforms_translate, "transform",
     "Returns the translation by V (mm). A translation by [x, y] keeps plane shapes plane.",
     "print translate([1, 2, 3]) * origin // expect: [1, 2, 3]", CAG_TAKES(LIST), family},
    {"translate(G: shape or plane or transform or camera or light or list of these, "
     "V: vector)",
     cag_transforms_translate, "as G",
     "Moves G by V. G is a shape, plane, transform, camera, or light, or a list of these.",
     "print bounds(box(2) |> translate([0, 0, 5])).min // expect: [0, 0, 5]", MOVED, family},
    {"rotate(angle: angle or point, about: point = [0, 0])", cag_transforms_rotate, "transform",
     "Returns the rotation about the vertical axis through a point, counter-clockwise seen from "
     "above. With a point [x, y], plane shapes stay plane.",
     "print rotate(90deg) * [2, 0] // expect: [0, 2]", CAG_TAKES(ANGLE), family},
    {"rotate(axis: vector or angle, angle: angle or point = none, about: point = origin, "
     "rpy: list of angles = none)",
     cag_transforms_rotate, "transform",
     "Returns the rotation about an axis through the point `about`, by the right-hand rule. A "
     "zero axis is an error.",
     "print rotate(X, 90deg) * [0, 1, 0] // expect: [0, 0, 1]", CAG_TAKES(LIST), family},
    {"rotate(G: shape or plane or transform or camera or light or list of these, "
     "axis: vector or angle = none, angle: angle or point = none, about: point = origin, "
     "rpy: list of angles = none)",
     cag_transforms_rotate, "as G",
     "Rotates G about an axis through a point. `rotate(G, angle)` and `rotate(G, angle, about)` "
     "rotate about Z. `rotate(G, rpy: [a, b, c])` rotates about X by a, then about Y by b, then "
     "about Z by c, like `rpy(a, b, c)`. A plane curve or region that is rotated about Z through "
     "a point with z = 0 stays in the plane.",
     "print bounds(box([1, 2, 3]) |> rotate(Z, 90deg)).size // expect: [2, 1, 3]\n"
     "print end_point(line([0, 0], [2, 0]) |> rotate(90deg)) // expect: [0, 2]\n"
     "print bounds(rotate(box([1, 2, 3]), rpy: [0deg, 90deg, 0deg])).size // expect: [3, 2, 1]",
     MOVED, family},
    {"scale(factor: number or list of numbers, about: point = origin)", cag_transforms_scale,
     "transform",
     "Returns the scaling by a factor, or by one factor for each of x, y, and z ([fx, fy] in the "
     "plane). The point `about` stays fixed. A negative factor mirrors. A factor of 0 is an "
     "error.",
     "print scale([1, 2, 3]) * [1, 1, 1] // expect: [1, 2, 3]\n"
     "print scale(2, about: [1, 1]) * [2, 1] // expect: [3, 1]",
     CAG_TAKES(NUMBER) | CAG_TAKES(LIST), family},
    {"scale(G: shape or plane or transform or camera or light or list of these, "
     "factor: number or list of numbers, about: point = origin)",
     cag_transforms_scale, "as G",
     "Scales G by a factor, or by one factor for each axis, about a point.",
     "print volume(box(1) |> scale(2)) // expect: 8", MOVED, family},
    {"reflect(normal: vector or plane, through: point = origin)", cag_transforms_reflect,
     "transform",
     "Returns the reflection in the plane through a point with this normal, or in a given plane. "
     "With vectors [x, y], it is the reflection in a line of the plane. A zero normal is an "
     "error.",
     "print reflect(X) * [1, 2, 3] // expect: [-1, 2, 3]\n"
     "print reflect(plane([0, 0, 1], Z)) * [0, 0, 3] // expect: [0, 0, -1]",
     CAG_TAKES(LIST) | CAG_TAKES(PLANE), family},
    {"reflect(G: shape or plane or transform or camera or light or list of these, "
     "normal: vector or plane, through: point = origin)",
     cag_transforms_reflect, "as G", "Reflects G. To keep G as well, use `mirrored`.",
     "print bounds(box(2) |> reflect(X)).min // expect: [-2, 0, 0]", MOVED, family},
    {"shear(xy: number = 0, xz: number = 0, yx: number = 0, yz: number = 0, zx: number = 0, "
     "zy: number = 0)",
     cag_transforms_shear, "transform",
     "Returns the shear that adds multiples of the other coordinates to each coordinate. For "
     "example, x becomes x + xy * y.",
     "print shear(xy: 0.5) * [1, 2] // expect: [2, 2]", CAG_TAKES(NUMBER), family},
    {"shear(G: shape or plane or transform or camera or light or list of these, "
     "xy: number = 0, xz: number = 0, yx: number = 0, yz: number = 0, zx: number = 0, "
     "zy: number = 0)",
     cag_transforms_shear, "as G", "Shears G. For example, x becomes x + xy * y.",
     "print volume(box(2) |> shear(xz: 1)) // expect: 8", MOVED, family},
    {"project(onto: plane, along: vector = none, from: point = none)", cag_transforms_project,
     "transform",
     "Returns the projection onto a plane: orthogonal by default, parallel along a vector, or "
     "central from a point. A central projection divides by w. A point that it maps to infinity "
     "is an error.",
     "print project(plane(origin, Z)) * [1, 2, 3] // expect: [1, 2, 0]\n"
     "print project(onto: plane(origin, Z), from: [0, 0, 2]) * [1, 0, 1] // expect: [2, 0, 0]",
     CAG_TAKES(PLANE), family},
    {"project(G: shape or plane or transform or camera or light or list of these, "
     "onto: plane, along: vector = none, from: point = none)",
     cag_transforms_project, "as G", "Projects G onto a plane.",
     "print project(line([0, 0, 1], [3, 4, 9]), plane(origin, Z)) |> length // expect: 5",
     MOVED & ~CAG_TAKES(PLANE), family},
    {"moved(G: shape or plane or transform or camera or light or list of these, "
     "T: transform)",
     cag_transforms_moved, "as G", "Returns T * G. Use it at the end of a pipe.",
     "print [1, 0, 0] |> moved(translate(Z)) // expect: [1, 0, 1]", MOVED | CAG_TAKES(LIST),
     family},

    // --- Made ---
    {"reflect_line(P: point, Q: point)", cag_transforms_reflect_line, "transform",
     "Returns the reflection in the line PQ of the XY plane. It is an error if P equals Q.",
     "print reflect_line([0, 0], [1, 1]) * [2, 0] // expect: [0, 2]", LISTS, family},
    {"reflect_point(P: point)", cag_transforms_reflect_point, "transform",
     "Returns the point reflection in P.",
     "print reflect_point([1, 1, 1]) * origin // expect: [2, 2, 2]", LISTS, family},
    {"transform(rows: list of rows of numbers, kind: \"plane\" or \"linear\" = \"plane\")",
     cag_transforms_from_rows, "transform",
     "Returns the transform with these rows, which acts on column vectors: 2x2, 3x3, 3x4, or "
     "4x4. A 3x3 matrix is homogeneous in the plane; with `kind: \"linear\"`, it is a linear map "
     "of space.",
     "print transform([[0, -1, 5], [1, 0, 0], [0, 0, 1]]) * [1, 0] // expect: [5, 1]\n"
     "print transform([[2, 0, 0], [0, 2, 0], [0, 0, 2]], kind: \"linear\") * Z // expect: [0, 0, "
     "2]",
     LISTS, family},
    {"axes(origin: point, x: vector, y: vector)", cag_transforms_axes, "transform",
     "Returns the frame with this origin and x axis. Its y axis is on the side of y, "
     "perpendicular to x, and z is x cross y. It is an error if x and y are parallel.",
     "print axes([1, 0, 0], Y, Z) * [2, 0, 0] // expect: [1, 2, 0]", LISTS, family},
    {"look_at(from: point, to: point, up: vector = Z)", cag_transforms_look_at, "transform",
     "Returns the frame at `from` whose z axis points to `to`. x points right and y points down, "
     "as a camera sees it. If the view is along `up`, Y is up.",
     "print look_at([0, -5, 0], origin).z // expect: [0, 1, 0]", LISTS, family},
    {"euler(a: angle, b: angle, c: angle, order: text)", cag_transforms_euler, "transform",
     "Returns the rotation by three Euler angles about the moving axes that `order` names, such "
     "as \"zyx\" or \"zyz\". All 12 orders are supported.",
     "print near(euler(30deg, 0deg, 0deg, \"zyx\"), rotate(Z, 30deg)) // expect: true",
     CAG_TAKES(ANGLE), family},
    {"rpy(roll: angle, pitch: angle, yaw: angle)", cag_transforms_rpy, "transform",
     "Returns rotate(Z, yaw) * rotate(Y, pitch) * rotate(X, roll).",
     "print near(rpy(0deg, 0deg, 90deg) * X, Y) // expect: true", CAG_TAKES(ANGLE), family},
    {"quaternion(w: number, x: number, y: number, z: number)", cag_transforms_quaternion,
     "transform",
     "Returns the rotation of a quaternion, which is normalized. The zero quaternion is an "
     "error.",
     "print near(quaternion(1, 0, 0, 1) * X, Y) // expect: true", CAG_TAKES(NUMBER), family},
    {"axis_angle(V: vector, angle: angle)", cag_transforms_axis_angle, "transform",
     "Returns the rotation about the axis V through the origin.",
     "print near(axis_angle(Z, 90deg) * X, Y) // expect: true", LISTS, family},
    {"cylindrical(r: length, theta: angle, z: length, orient: bool = false)",
     cag_transforms_cylindrical, "transform",
     "Returns the translation to radius r, angle theta, and height z. With `orient: true`, it "
     "also rotates by theta.",
     "print cylindrical(2, 90deg, 5) * origin // expect: [0, 2, 5]", CAG_TAKES(NUMBER), family},
    {"spherical(r: length, azimuth: angle, polar: angle, orient: bool = false)",
     cag_transforms_spherical, "transform",
     "Returns the translation to distance r in the direction given by the azimuth about Z and "
     "the polar angle from Z. With `orient: true`, it also rotates, so that z points outward.",
     "print spherical(2, 0deg, 90deg) * origin // expect: [2, 0, 0]", CAG_TAKES(NUMBER), family},
    {"dh(theta: angle, d: length, a: length, alpha: angle)", cag_transforms_dh, "transform",
     "Returns the transform of one link by standard Denavit-Hartenberg parameters: rotate(Z, "
     "theta) * translate(d Z) * translate(a X) * rotate(X, alpha).",
     "print dh(0deg, 3, 2, 90deg).origin // expect: [2, 0, 3]", CAG_TAKES(ANGLE), family},
    {"mdh(theta: angle, d: length, a: length, alpha: angle)", cag_transforms_mdh, "transform",
     "Returns the transform of one link by modified Denavit-Hartenberg parameters: rotate(X, "
     "alpha) * translate(a X) * rotate(Z, theta) * translate(d Z).",
     "print mdh(0deg, 3, 2, 90deg).origin // expect: [2, -3, 0]", CAG_TAKES(ANGLE), family},
    {"transform_from(points: list of points, images: list of points)", cag_transforms_from_pairs,
     "transform",
     "Returns the transform that maps points to their images. In the plane, 2 pairs determine a "
     "similarity, 3 an affine map, and 4 a projective map. In space, 4 pairs determine an affine "
     "map. Degenerate points, such as collinear ones, are an error.",
     "T = transform_from([[0, 0], [1, 0]], [[1, 1], [1, 3]])\n"
     "print near(T * [0, 1], [-1, 1]) // expect: true",
     LISTS, family},
    {"solve_frame(left: list of texts, right: list of texts, frames: record of transforms)",
     cag_transforms_solve_frame, "transform",
     "Returns the unknown frame of a loop of frames. `left` and `right` are lists of names whose "
     "products are equal. `frames` is a record of all frames but one. A singular frame that must "
     "be inverted is an error.",
     "T = solve_frame([\"base\", \"tool\"], [\"goal\"], {base: translate(X), goal: translate(Z)})\n"
     "print T.origin // expect: [-1, 0, 1]",
     LISTS, family},

    // --- Asked ---
    {"inverse(T: transform)", cag_transforms_inverse, "transform",
     "Returns the inverse of T. A singular T, such as a projection, is an error.",
     "print inverse(translate([1, 2, 3])) * [1, 2, 3] // expect: [0, 0, 0]", OF_TRANSFORM, family},
    {"determinant(T: transform)", cag_transforms_determinant, "number",
     "Returns the determinant of the 4x4 matrix. For an affine T, it is the factor by which "
     "volumes change; it is negative if T mirrors.",
     "print determinant(scale(2)) // expect: 8", OF_TRANSFORM, family},
    {"transpose(T: transform)", cag_transforms_transpose, "transform",
     "Returns the transpose of the 4x4 matrix. The transpose of a rotation is its inverse.",
     "print near(transpose(rotate(Z, 30deg)), rotate(Z, -30deg)) // expect: true", OF_TRANSFORM,
     family},
    {"position(T: transform)", cag_transforms_position, "list", "Returns the image of the origin.",
     "print position(translate([1, 2, 3]) * rotate(Z, 30deg)) // expect: [1, 2, 3]", OF_TRANSFORM,
     family},
    {"rotation(T: transform)", cag_transforms_rotation, "transform",
     "Returns T without its translation.",
     "print rotation(translate([1, 2, 3])) == identity // expect: true", OF_TRANSFORM, family},
    {"euler_of(T: transform, order: text)", cag_transforms_euler_of, "record",
     "Returns the angles a, b, and c for which euler(a, b, c, order) is T. At gimbal lock, "
     "`singular` is true and c is 0deg.",
     "print near(euler_of(rotate(Z, 30deg), \"zyz\").a, 30deg) // expect: true", OF_TRANSFORM,
     family},
    {"rpy_of(T: transform)", cag_transforms_rpy_of, "record",
     "Returns the angles roll, pitch, and yaw of T. At gimbal lock (pitch of 90deg), `singular` "
     "is true and yaw is 0deg.",
     "print near(rpy_of(rotate(X, 20deg)).roll, 20deg) // expect: true", OF_TRANSFORM, family},
    {"axis_angle_of(T: transform)", cag_transforms_axis_angle_of, "record",
     "Returns the axis and the angle (0deg..180deg) of T's rotation. `singular` is true if T does "
     "not rotate.",
     "print near(axis_angle_of(rotate(Y, 40deg)).angle, 40deg) // expect: true", OF_TRANSFORM,
     family},
    {"quaternion_of(T: transform)", cag_transforms_quaternion_of, "list",
     "Returns the unit quaternion [w, x, y, z] of T's rotation, with w >= 0.",
     "print quaternion_of(identity) // expect: [1, 0, 0, 0]", OF_TRANSFORM, family},
    {"classify(T: transform)", cag_transforms_classify, "record",
     "Classifies a transform. `class` is \"rigid\", \"mirror\", \"similarity\", \"affine\", or "
     "\"projective\". `scale` is its factor. `axis` and `angle` describe its rotation, or are "
     "none if it does not rotate. `fixed` is \"all\", \"plane\", \"line\", \"point\", or \"none\", with a "
     "`fixed_point`, and with `fixed_direction`, the direction of a line or the normal of a "
     "plane.",
     "c = classify(rotate(Z, 30deg, about: [1, 0, 0]))\n"
     "print c.class, c.fixed // expect: rigid line",
     OF_TRANSFORM, family},
    {"homogeneous(P: point, w: number = 1)", cag_transforms_homogeneous, "list",
     "Returns the homogeneous coordinates [x w, y w, z w, w] of P. For w = 0, returns the point "
     "at infinity in the direction of P.",
     "print homogeneous([1, 2, 3], 2) // expect: [2, 4, 6, 2]", LISTS, family},
    {"dehomogenize(h: list of 3 or 4 numbers)", cag_transforms_dehomogenize, "list",
     "Returns the point with the homogeneous coordinates [x, y, z, w], or [x, y, w] in the "
     "plane. For a point at infinity (w = 0), returns its direction. It is an error if all "
     "coordinates are 0.",
     "print dehomogenize([2, 4, 6, 2]), dehomogenize([2, 4, 2]) // expect: [1, 2, 3] [1, 2]", LISTS,
     family},
    {"mix(A: transform, B: transform, t: finite number)", cag_transforms_mix, "transform",
     "Interpolates between two rigid transforms: the rotation by slerp, and the position along a "
     "line.",
     "print near(mix(identity, rotate(Z, 90deg), 0.5), rotate(Z, 45deg)) // expect: true",
     OF_TRANSFORM, family},

    // --- Planes ---
    {"plane(P: point or list of 4 numbers, Q: vector or point = none, R: point = none)",
     cag_transforms_plane, "plane",
     "Returns the plane through P with normal Q; through three points P, Q, R (its normal "
     "follows the right-hand rule); or with the equation a x + b y + c z + d = 0, given as [a, "
     "b, c, d]. A plane has the fields `.point`, `.normal` (a unit vector), and `.row`. A zero "
     "normal and collinear points are errors.",
     "print plane([0, 0, 2], [0, 0, 5]).row // expect: [0, 0, 1, -2]\n"
     "print plane(X, Y, Z).normal.x == 1 / sqrt(3) // expect: true",
     LISTS, family},
    {"polar(r: length, angle: angle, center: point = [0, 0])", cag_transforms_polar, "list",
     "Returns the point of the plane at distance r and at this angle from the x direction, as "
     "seen from the center.",
     "print polar(2, 90deg) // expect: [0, 2]", CAG_TAKES(NUMBER), in_the_plane},
    {"intersect_lines(P: point, Q: point, R: point, S: point)", cag_transforms_intersect_lines,
     "list",
     "Returns the intersection of the infinite lines PQ and RS; none if they are parallel or "
     "skew.",
     "print intersect_lines([0, 0], [1, 1], [0, 4], [4, 0]) // expect: [2, 2]", LISTS,
     in_the_plane},
    {"distance_to_line(P: point, Q: point, R: point)", cag_transforms_distance_to_line, "number",
     "Returns the distance (mm) between P and the infinite line QR.",
     "print distance_to_line([0, 3], [-1, 0], [5, 0]) // expect: 3", LISTS, in_the_plane},
    {"area(points: list of points)", cag_transforms_area_of_points, "number",
     "Returns the area (mm2) of the polygon with these vertices.",
     "print area([[0, 0], [4, 0], [0, 3]]) // expect: 6", LISTS, in_the_plane},
    {"centroid(points: list of points)", cag_transforms_centroid_of_points, "list",
     "Returns the centroid of the polygon with these vertices.",
     "print centroid([[0, 0], [3, 0], [0, 3]]) // expect: [1, 1]", LISTS, in_the_plane},
    {"contains(A: plane or shape, P: point or shape)", cag_transforms_contains, "bool",
     "Tests whether a region, closed plane curve, or polygon contains P. The boundary is "
     "included.",
     "print contains(rectangle(4, 2), [2, 1]), contains([[0, 0], [1, 0], [0, 1]], [1, 1]) // "
     "expect: "
     "true false",
     CAG_TAKES(REGION) | CAG_TAKES(CURVE) | CAG_TAKES(LIST), in_the_plane},
    {0}};
