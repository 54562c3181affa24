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
     "The transform that moves everything by V (mm). Of [x, y] it keeps plane things plane.",
     "print translate([1, 2, 3]) * origin // expect: [1, 2, 3]", CAG_TAKES(LIST), family},
    {"translate(G: shape or plane or transform or camera or light or list of these, "
     "V: vector)",
     cag_transforms_translate, "as G",
     "G moved by V: a shape, plane, transform, camera or light, or a list of these.",
     "print bounds(box(2) |> translate([0, 0, 5])).min // expect: [0, 0, 5]", MOVED, family},
    {"rotate(angle: angle or point, about: point = [0, 0])", cag_transforms_rotate, "transform",
     "The turn by the angle about Z through a point, counter-clockwise seen from above. About a "
     "point [x, y] it keeps plane things plane.",
     "print rotate(90deg) * [2, 0] // expect: [0, 2]", CAG_TAKES(ANGLE), family},
    {"rotate(axis: vector or angle, angle: angle or point = none, about: point = origin, "
     "rpy: list of angles = none)",
     cag_transforms_rotate, "transform",
     "The turn by the angle about an axis through the point `about`, by the right hand: with the "
     "thumb along the axis it goes as the fingers do. A zero axis is an error.",
     "print rotate(X, 90deg) * [0, 1, 0] // expect: [0, 0, 1]", CAG_TAKES(LIST), family},
    {"rotate(G: shape or plane or transform or camera or light or list of these, "
     "axis: vector or angle = none, angle: angle or point = none, about: point = origin, "
     "rpy: list of angles = none)",
     cag_transforms_rotate, "as G",
     "G turned about an axis through a point; `rotate(G, angle)` and `rotate(G, angle, about)` "
     "turn about Z. `rotate(G, rpy: [a, b, c])` turns about X by a, then about Y by b, then about "
     "Z "
     "by c, as `rpy(a, b, c)` does. A plane curve or region turned about Z through a point with z "
     "= "
     "0 stays in the plane.",
     "print bounds(box([1, 2, 3]) |> rotate(Z, 90deg)).size // expect: [2, 1, 3]\n"
     "print end_point(line([0, 0], [2, 0]) |> rotate(90deg)) // expect: [0, 2]\n"
     "print bounds(rotate(box([1, 2, 3]), rpy: [0deg, 90deg, 0deg])).size // expect: [3, 2, 1]",
     MOVED, family},
    {"scale(factor: number or list of numbers, about: point = origin)", cag_transforms_scale,
     "transform",
     "Stretches by a factor, or by one along each of x, y, z ([fx, fy] in the plane), away from "
     "the point `about`. A negative factor mirrors, a zero factor is an error.",
     "print scale([1, 2, 3]) * [1, 1, 1] // expect: [1, 2, 3]\n"
     "print scale(2, about: [1, 1]) * [2, 1] // expect: [3, 1]",
     CAG_TAKES(NUMBER) | CAG_TAKES(LIST), family},
    {"scale(G: shape or plane or transform or camera or light or list of these, "
     "factor: number or list of numbers, about: point = origin)",
     cag_transforms_scale, "as G",
     "G stretched by a factor or by one along each axis, away from a point.",
     "print volume(box(1) |> scale(2)) // expect: 8", MOVED, family},
    {"reflect(normal: vector or plane, through: point = origin)", cag_transforms_reflect,
     "transform",
     "The mirror image in the plane through a point with this normal, or in a plane. Of [x, y] it "
     "is the image in a line of the plane. A zero normal is an error.",
     "print reflect(X) * [1, 2, 3] // expect: [-1, 2, 3]\n"
     "print reflect(plane([0, 0, 1], Z)) * [0, 0, 3] // expect: [0, 0, -1]",
     CAG_TAKES(LIST) | CAG_TAKES(PLANE), family},
    {"reflect(G: shape or plane or transform or camera or light or list of these, "
     "normal: vector or plane, through: point = origin)",
     cag_transforms_reflect, "as G", "The mirror image of G; `mirrored` keeps G beside it.",
     "print bounds(box(2) |> reflect(X)).min // expect: [-2, 0, 0]", MOVED, family},
    {"shear(xy: number = 0, xz: number = 0, yx: number = 0, yz: number = 0, zx: number = 0, "
     "zy: number = 0)",
     cag_transforms_shear, "transform",
     "Adds to each coordinate shares of the others: `xy` is what y adds to x.",
     "print shear(xy: 0.5) * [1, 2] // expect: [2, 2]", CAG_TAKES(NUMBER), family},
    {"shear(G: shape or plane or transform or camera or light or list of these, "
     "xy: number = 0, xz: number = 0, yx: number = 0, yz: number = 0, zx: number = 0, "
     "zy: number = 0)",
     cag_transforms_shear, "as G", "G sheared: `xy` is what y adds to x.",
     "print volume(box(2) |> shear(xz: 1)) // expect: 8", MOVED, family},
    {"project(onto: plane, along: vector = none, from: point = none)", cag_transforms_project,
     "transform",
     "The projection to the plane `onto`: parallel along a vector, at right angles when nothing is "
     "said, or central from a point. Points of a central one are divided by w; a point that goes "
     "to "
     "infinity is an error.",
     "print project(plane(origin, Z)) * [1, 2, 3] // expect: [1, 2, 0]\n"
     "print project(onto: plane(origin, Z), from: [0, 0, 2]) * [1, 0, 1] // expect: [2, 0, 0]",
     CAG_TAKES(PLANE), family},
    {"project(G: shape or plane or transform or camera or light or list of these, "
     "onto: plane, along: vector = none, from: point = none)",
     cag_transforms_project, "as G", "The projection of G to a plane.",
     "print project(line([0, 0, 1], [3, 4, 9]), plane(origin, Z)) |> length // expect: 5",
     MOVED & ~CAG_TAKES(PLANE), family},
    {"moved(G: shape or plane or transform or camera or light or list of these, "
     "T: transform)",
     cag_transforms_moved, "as G", "T * G, at the end of a pipe.",
     "print [1, 0, 0] |> moved(translate(Z)) // expect: [1, 0, 1]", MOVED | CAG_TAKES(LIST),
     family},

    // --- Made ---
    {"reflect_line(P: point, Q: point)", cag_transforms_reflect_line, "transform",
     "The mirror image in the line PQ of the XY plane. One point twice is an error.",
     "print reflect_line([0, 0], [1, 1]) * [2, 0] // expect: [0, 2]", LISTS, family},
    {"reflect_point(P: point)", cag_transforms_reflect_point, "transform",
     "The image through a point: P stays, all else goes to the other side.",
     "print reflect_point([1, 1, 1]) * origin // expect: [2, 2, 2]", LISTS, family},
    {"transform(rows: list of rows of numbers, kind: \"plane\" or \"linear\" = \"plane\")",
     cag_transforms_from_rows, "transform",
     "The transform of these rows on column vectors: 2x2, 3x3, 3x4 or 4x4. Rows 3x3 are "
     "homogeneous "
     "of the plane, with `kind: \"linear\"` a linear map of space.",
     "print transform([[0, -1, 5], [1, 0, 0], [0, 0, 1]]) * [1, 0] // expect: [5, 1]\n"
     "print transform([[2, 0, 0], [0, 2, 0], [0, 0, 2]], kind: \"linear\") * Z // expect: [0, 0, "
     "2]",
     LISTS, family},
    {"axes(origin: point, x: vector, y: vector)", cag_transforms_axes, "transform",
     "The frame with this origin, its x axis along x and its y axis on y's side, made "
     "perpendicular to x; "
     "z "
     "is x cross y. Parallel x and y are an error.",
     "print axes([1, 0, 0], Y, Z) * [2, 0, 0] // expect: [1, 2, 0]", LISTS, family},
    {"look_at(from: point, to: point, up: vector = Z)", cag_transforms_look_at, "transform",
     "The frame at `from` whose z axis points to `to`; x goes to the right and y down as a camera "
     "sees it. When the view is along `up`, Y is up.",
     "print look_at([0, -5, 0], origin).z // expect: [0, 1, 0]", LISTS, family},
    {"euler(a: angle, b: angle, c: angle, order: text)", cag_transforms_euler, "transform",
     "Three turns about the moving axes that `order` names, \"zyx\", \"zyz\" ...: all 12.",
     "print near(euler(30deg, 0deg, 0deg, \"zyx\"), rotate(Z, 30deg)) // expect: true",
     CAG_TAKES(ANGLE), family},
    {"rpy(roll: angle, pitch: angle, yaw: angle)", cag_transforms_rpy, "transform",
     "rotate(Z, yaw) * rotate(Y, pitch) * rotate(X, roll).",
     "print near(rpy(0deg, 0deg, 90deg) * X, Y) // expect: true", CAG_TAKES(ANGLE), family},
    {"quaternion(w: number, x: number, y: number, z: number)", cag_transforms_quaternion,
     "transform", "The turn of this quaternion, made a unit one; the zero quaternion is an error.",
     "print near(quaternion(1, 0, 0, 1) * X, Y) // expect: true", CAG_TAKES(NUMBER), family},
    {"axis_angle(V: vector, angle: angle)", cag_transforms_axis_angle, "transform",
     "The turn about V through the origin.",
     "print near(axis_angle(Z, 90deg) * X, Y) // expect: true", LISTS, family},
    {"cylindrical(r: length, theta: angle, z: length, orient: bool = false)",
     cag_transforms_cylindrical, "transform",
     "The position at radius r, angle theta and height z; with `orient: true` turned by theta as "
     "well.",
     "print cylindrical(2, 90deg, 5) * origin // expect: [0, 2, 5]", CAG_TAKES(NUMBER), family},
    {"spherical(r: length, azimuth: angle, polar: angle, orient: bool = false)",
     cag_transforms_spherical, "transform",
     "The position at distance r, turned by the azimuth about Z and down from Z by the polar "
     "angle; "
     "with `orient: true` turned likewise, so that z points outward.",
     "print spherical(2, 0deg, 90deg) * origin // expect: [2, 0, 0]", CAG_TAKES(NUMBER), family},
    {"dh(theta: angle, d: length, a: length, alpha: angle)", cag_transforms_dh, "transform",
     "One link by the classic Denavit-Hartenberg parameters: rotate(Z, theta) * translate(d Z) * "
     "translate(a X) * rotate(X, alpha).",
     "print dh(0deg, 3, 2, 90deg).origin // expect: [2, 0, 3]", CAG_TAKES(ANGLE), family},
    {"mdh(theta: angle, d: length, a: length, alpha: angle)", cag_transforms_mdh, "transform",
     "One link by the modified parameters: rotate(X, alpha) * translate(a X) * rotate(Z, theta) * "
     "translate(d Z).",
     "print mdh(0deg, 3, 2, 90deg).origin // expect: [2, -3, 0]", CAG_TAKES(ANGLE), family},
    {"transform_from(points: list of points, images: list of points)", cag_transforms_from_pairs,
     "transform",
     "The transform that takes points to images: of plane points 2 pairs (similarity), 3 (affine) "
     "or 4 (projective); of space points 4 (affine). Points that lie too specially are an error.",
     "T = transform_from([[0, 0], [1, 0]], [[1, 1], [1, 3]])\n"
     "print near(T * [0, 1], [-1, 1]) // expect: true",
     LISTS, family},
    {"solve_frame(left: list of texts, right: list of texts, frames: record of transforms)",
     cag_transforms_solve_frame, "transform",
     "The one frame that is not known: `left` and `right` are lists of names whose products are "
     "equal, `frames` a record of all others. A singular frame on the way is an error.",
     "T = solve_frame([\"base\", \"tool\"], [\"goal\"], {base: translate(X), goal: translate(Z)})\n"
     "print T.origin // expect: [-1, 0, 1]",
     LISTS, family},

    // --- Asked ---
    {"inverse(T: transform)", cag_transforms_inverse, "transform",
     "The transform that undoes T. A singular T (a projection) has none: an error.",
     "print inverse(translate([1, 2, 3])) * [1, 2, 3] // expect: [0, 0, 0]", OF_TRANSFORM, family},
    {"determinant(T: transform)", cag_transforms_determinant, "number",
     "The determinant of the 4x4 matrix: of an affine T the factor of volumes, negative for "
     "mirrors.",
     "print determinant(scale(2)) // expect: 8", OF_TRANSFORM, family},
    {"transpose(T: transform)", cag_transforms_transpose, "transform",
     "Rows and columns exchanged; of a turn its inverse.",
     "print near(transpose(rotate(Z, 30deg)), rotate(Z, -30deg)) // expect: true", OF_TRANSFORM,
     family},
    {"position(T: transform)", cag_transforms_position, "list",
     "The point where T puts the origin.",
     "print position(translate([1, 2, 3]) * rotate(Z, 30deg)) // expect: [1, 2, 3]", OF_TRANSFORM,
     family},
    {"rotation(T: transform)", cag_transforms_rotation, "transform", "T without its position.",
     "print rotation(translate([1, 2, 3])) == identity // expect: true", OF_TRANSFORM, family},
    {"euler_of(T: transform, order: text)", cag_transforms_euler_of, "record",
     "The angles a, b, c that give T by euler(a, b, c, order). At gimbal lock `singular` is true "
     "and "
     "c is 0deg.",
     "print near(euler_of(rotate(Z, 30deg), \"zyz\").a, 30deg) // expect: true", OF_TRANSFORM,
     family},
    {"rpy_of(T: transform)", cag_transforms_rpy_of, "record",
     "The angles roll, pitch, yaw of T. At gimbal lock (pitch of 90deg) `singular` is true and yaw "
     "is 0deg.",
     "print near(rpy_of(rotate(X, 20deg)).roll, 20deg) // expect: true", OF_TRANSFORM, family},
    {"axis_angle_of(T: transform)", cag_transforms_axis_angle_of, "record",
     "The axis and angle (0deg..180deg) of T's turn; `singular` is true where there is no turn.",
     "print near(axis_angle_of(rotate(Y, 40deg)).angle, 40deg) // expect: true", OF_TRANSFORM,
     family},
    {"quaternion_of(T: transform)", cag_transforms_quaternion_of, "list",
     "The unit quaternion [w, x, y, z] of T's turn, w >= 0.",
     "print quaternion_of(identity) // expect: [1, 0, 0, 0]", OF_TRANSFORM, family},
    {"classify(T: transform)", cag_transforms_classify, "record",
     "What T is: `class` is \"rigid\", \"mirror\", \"similarity\", \"affine\" or \"projective\"; "
     "`scale`; `axis` and `angle` of its turn (none without one); `fixed` is \"all\", \"plane\", "
     "\"line\", \"point\" or \"none\", with a `fixed_point` and the `fixed_direction` of a line or "
     "the normal of a plane.",
     "c = classify(rotate(Z, 30deg, about: [1, 0, 0]))\n"
     "print c.class, c.fixed // expect: rigid line",
     OF_TRANSFORM, family},
    {"homogeneous(P: point, w: number = 1)", cag_transforms_homogeneous, "list",
     "The homogeneous coordinates [x w, y w, z w, w] of P; with w = 0 the point at infinity in P's "
     "direction.",
     "print homogeneous([1, 2, 3], 2) // expect: [2, 4, 6, 2]", LISTS, family},
    {"dehomogenize(h: list of 3 or 4 numbers)", cag_transforms_dehomogenize, "list",
     "The point of the homogeneous coordinates [x, y, z, w], or [x, y, w] in the plane. A point at "
     "infinity (w = 0) gives its direction; if all coordinates are 0, there is no point: an "
     "error.",
     "print dehomogenize([2, 4, 6, 2]), dehomogenize([2, 4, 2]) // expect: [1, 2, 3] [1, 2]", LISTS,
     family},
    {"mix(A: transform, B: transform, t: number)", cag_transforms_mix, "transform",
     "Between two rigid transforms: the turn by the shortest way (slerp), the position along a "
     "line.",
     "print near(mix(identity, rotate(Z, 90deg), 0.5), rotate(Z, 45deg)) // expect: true",
     OF_TRANSFORM, family},

    // --- Planes ---
    {"plane(P: point or list of 4 numbers, Q: vector or point = none, R: point = none)",
     cag_transforms_plane, "plane",
     "The plane through P with normal Q; through three points P, Q, R (its normal by their right "
     "hand); or of the numbers [a, b, c, d] of a x + b y + c z + d = 0. It has `.point`, `.normal` "
     "(unit) and `.row`. A zero normal and points on one line are errors.",
     "print plane([0, 0, 2], [0, 0, 5]).row // expect: [0, 0, 1, -2]\n"
     "print plane(X, Y, Z).normal.x == 1 / sqrt(3) // expect: true",
     LISTS, family},
    {"polar(r: length, angle: angle, center: point = [0, 0])", cag_transforms_polar, "list",
     "The point of the plane at distance r from the center, at this angle from x.",
     "print polar(2, 90deg) // expect: [0, 2]", CAG_TAKES(NUMBER), in_the_plane},
    {"intersect_lines(P: point, Q: point, R: point, S: point)", cag_transforms_intersect_lines,
     "list",
     "The point where the lines PQ and RS meet, taken whole; none when they are parallel or, in "
     "space, pass each other.",
     "print intersect_lines([0, 0], [1, 1], [0, 4], [4, 0]) // expect: [2, 2]", LISTS,
     in_the_plane},
    {"distance_to_line(P: point, Q: point, R: point)", cag_transforms_distance_to_line, "number",
     "The distance (mm) of P from the line QR, taken whole.",
     "print distance_to_line([0, 3], [-1, 0], [5, 0]) // expect: 3", LISTS, in_the_plane},
    {"area(points: list of points)", cag_transforms_area_of_points, "number",
     "The area of the polygon of these points, in mm2.",
     "print area([[0, 0], [4, 0], [0, 3]]) // expect: 6", LISTS, in_the_plane},
    {"centroid(points: list of points)", cag_transforms_centroid_of_points, "list",
     "The center of area of the polygon of these points.",
     "print centroid([[0, 0], [3, 0], [0, 3]]) // expect: [1, 1]", LISTS, in_the_plane},
    {"contains(A: plane or shape, P: point or shape)", cag_transforms_contains, "bool",
     "Whether a region, closed plane curve or polygon of points contains P; its boundary belongs "
     "to it.",
     "print contains(rectangle(4, 2), [2, 1]), contains([[0, 0], [1, 0], [0, 1]], [1, 1]) // "
     "expect: "
     "true false",
     CAG_TAKES(REGION) | CAG_TAKES(CURVE) | CAG_TAKES(LIST), in_the_plane},
    {0}};
