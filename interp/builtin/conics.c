// The table of conics, circles and lines that touch, and plane curves by their coordinates.

#include "interp/builtin/conics.h"

#define CURVES CAG_TAKES(CURVE)
#define LISTS CAG_TAKES_LISTS
#define NUMBERS CAG_TAKES(NUMBER)
#define EQUATIONS (CAG_TAKES(CURVE) | CAG_TAKES(LIST))

static const char axes[] = "Conics: from axes";
static const char general[] = "Conics: from equations";
static const char touching[] = "Tangent circles and lines";
static const char coordinates[] = "Analytic geometry of the plane";

const CagBuiltin cag_builtins_conics[] = {
    // --- By their axes ---
    {"parabola(a: length, range: range of numbers or angles = none, center: point = [0, 0], "
     "normal: vector = none, x: range of lengths = none, y: range of lengths = none)",
     cag_conics_parabola, "curve",
     "Returns the parabola y^2 = 4 a x with its vertex at `center`. A range of numbers t selects "
     "the quadratic form [a t^2, 2 a t]; a range of angles between -90deg and 90deg selects the "
     "tangent form [tan(t)^2, 2 sqrt(a) tan(t)]. Instead, `x` gives the range of x on the upper "
     "half, or `y` the range of y (domain). A decreasing range gives the reversed curve over the "
     "increasing range. With a normal, it lies in space.",
     "c = parabola(1, -1..2)\n"
     "print c(-1), c(2) // expect: [1, -2] [4, 4]\n"
     "print domain(parabola(1, x: 1..4)) // expect: 1..2",
     NUMBERS, axes},
    {"hyperbola(a: length, b: length, range: range of numbers or angles = none, "
     "center: point = [0, 0], normal: vector = none, x: range of lengths = none, "
     "y: range of lengths = none)",
     cag_conics_hyperbola, "curve",
     "Returns the hyperbola x^2/a^2 - y^2/b^2 = 1. A range of numbers t selects the hyperbolic "
     "form [a cosh(t), b sinh(t)], the right branch; a range of angles between two odd multiples "
     "of 90deg selects the secant form [a / cos(t), b tan(t)], which within 90deg..270deg is the "
     "left branch. Instead, `x` gives the range of x on the upper half of the right branch, or "
     "`y` the range of y (domain). A decreasing range gives the reversed curve over the "
     "increasing range.",
     "h = hyperbola(2, 1, -60deg..60deg)\n"
     "print near(h(60deg), [4, sqrt(3)]) // expect: true\n"
     "print near(h(0deg), hyperbola(2, 1, -1..1)(0)) // expect: true",
     NUMBERS, axes},
    {"conic_points(C: conic or curve, n: integer, "
     "by: \"parameter\" or \"angle\" or \"length\" or \"rational\" or \"x\" = "
     "\"parameter\"|\"angle\"|\"length\"|\"rational\"|\"x\")",
     cag_conics_conic_points, "list",
     "Returns n points of a conic or an arc of one, including both ends; a closed curve ends at "
     "its first point. \"parameter\": at equal steps of the parameter, by the classical "
     "recurrences, which inscribe the polygon of largest area. For circles and ellipses, "
     "\"angle\": at equal polar angles about the center, or \"rational\": at equal steps of "
     "tan(t/2). For any curve, \"length\": at equal arc lengths, or \"x\": at equal steps of x.",
     "print conic_points(parabola(1, 0..2), 3) // expect: [[0, 0], [1, 2], [4, 4]]\n"
     "print near(conic_points(circle(1), 5)[1], [0, 1]) // expect: true",
     CURVES, axes},
    {"conic_arc(P: point, apex: point, Q: point, rho: number in 0..1 = none, "
     "shoulder: point = none, weight: number = none)",
     cag_conics_conic_arc, "curve",
     "Returns the arc of a conic from P to Q whose end tangents meet at the apex, as a rational "
     "Bezier curve of degree 2. Its fullness is given by one of: the `weight` of the apex (1: "
     "parabola; less: ellipse; more: hyperbola; 0: the chord, a line); `rho` = weight/(1 + "
     "weight), the fraction of the way from the chord's midpoint to the apex; or `shoulder`, a "
     "point inside the triangle through which the arc passes.",
     "q = conic_arc([1, 0], [1, 1], [0, 1], weight: sqrt(0.5))\n"
     "print near(norm(q(0.3)), 1) // expect: true\n"
     "print conic_arc([0, 0], [1, 2], [2, 0], rho: 0.5)(0.5) // expect: [1, 1]",
     LISTS, axes},

    // --- By their equation ---
    {"conic(coefficients: list of 6 numbers or list of 3 rows, halved: bool = false)",
     cag_conics_conic, "curve",
     "Returns the conic a x^2 + b xy + c y^2 + d x + e y + f = 0, given as [a, b, c, d, e, f] or "
     "as the 3 rows of its symmetric matrix. With `halved: true`, the form is a x^2 + 2b xy + c "
     "y^2 + 2d x + 2e y + f = 0. Degenerate and empty conics are values, too: `classify` "
     "describes a conic, and `branches` returns its curves. A conic with one branch is that "
     "curve itself. Transforms of the plane, including projective ones, transform the equation "
     "as well.",
     "c = conic([1, 0, 4, 0, 0, -4])\n"
     "print classify(c).class, near(c(90deg), [0, 1]) // expect: ellipse true",
     LISTS, general},
    {"conic(C: conic or curve)", cag_conics_conic_of_curve, "curve",
     "Returns the whole conic to which a circle, ellipse, parabola, hyperbola, arc of one, line, "
     "or Bezier curve of degree 2 belongs.",
     "print classify(conic(bezier([[0, 0], [1, 2], [2, 0]]))).class // expect: parabola", CURVES,
     general},
    {"coefficients(C: conic or curve)", cag_conics_coefficients, "list",
     "Returns the coefficients [a, b, c, d, e, f] of a conic a x^2 + b xy + c y^2 + d x + e y + "
     "f = 0, or of the conic of a curve (see `conic`). They are determined up to a common "
     "factor.",
     "print coefficients(conic([1, 2, 3, 4, 5, 6], halved: true)) // expect: [1, 4, 3, 8, 10, 6]",
     EQUATIONS, general},
    {"classify(C: conic or curve)", cag_conics_classify, "record",
     "Describes a conic: the class (\"ellipse\" \"circle\" \"hyperbola\" \"parabola\" \"point\" "
     "\"intersecting_lines\" \"parallel_lines\" \"double_line\" \"line\" \"plane\" \"empty\"); the "
     "discriminant b^2 - 4ac; central (false for a parabola); the center; the vertex of a "
     "parabola; the angle of the major or real axis in -90deg..90deg (for a parabola, the "
     "direction into its opening); a, b, and axes [a, b] (for a hyperbola, a is real); p of a "
     "parabola (y^2 = 4 p x in its axes); the eccentricity; the foci; the lines [p, q, r] of "
     "which it consists; standard (the angle that removes the xy term, the coefficients in those "
     "axes, and alpha x^2 + beta y^2 = kappa about the center); and the symmetric matrix. Fields "
     "that do not apply are none. For a plane curve in space, center, vertex, and foci are "
     "points of space; everything else is in coordinates of the plane, which `frame` maps to "
     "space.",
     "k = classify(conic([2, -72, 23, 140, -20, 50]))\n"
     "print k.class, k.center, near(k.axes, [2, sqrt(2)]) // expect: hyperbola [1, 2] true",
     CURVES, general},
    {"branches(C: conic or curve, range: range of numbers = -2..2)", cag_conics_branches, "list",
     "Returns the real curves of a conic: an ellipse or circle, a parabola, the two branches of "
     "a hyperbola, or its lines; none for a point or an empty conic. The range is that of the "
     "quadratic parameter of a parabola, the hyperbolic parameter of a hyperbola, or the "
     "distance on a line from the point nearest to the center.",
     "print map(branches(conic([1, 0, -1, 0, 0, -1])), b => b(0)) // expect: [[1, 0], [-1, 0]]",
     EQUATIONS, general},
    {"conic_point(C: conic or curve, x: length, "
     "branch: \"lower\" or \"upper\" = \"lower\"|\"upper\")",
     cag_conics_point_of_conic, "list",
     "Returns the point of a conic at this x with the smaller or the larger y. If the conic does "
     "not reach this x, it is an error (domain).",
     "print conic_point(conic([1, 0, 1, 0, 0, -25]), 3, branch: \"upper\") // expect: [3, 4]",
     EQUATIONS, general},
    {"conic_segment(C: conic or curve, x: range of lengths, "
     "branch: \"lower\" or \"upper\" = \"lower\"|\"upper\")",
     cag_conics_conic_segment, "curve",
     "Returns the arc of a conic over a range of x (which may decrease), on the branch with the "
     "smaller or the larger y. It is an error if the conic has no point at an end, or if the "
     "ends lie on different branches of a hyperbola (domain).",
     "s = conic_segment(conic([1, 0, 1, 0, 0, -25]), -3..4, branch: \"upper\")\n"
     "print near(start_point(s), [-3, 4]), near(end_point(s), [4, 3]) // expect: true true",
     EQUATIONS, general},
    {"conic_through(P: point, ...)", cag_conics_conic_through, "curve",
     "Returns the conic through five points of the plane, given one by one or as one list. "
     "Further points must be consistent. Points that do not determine the conic are an error "
     "(conditions-dependent).",
     "c = conic_through([1, 0], [0, 1], [-1, 0], [0, -1], [0.6, 0.8])\n"
     "print classify(c).class // expect: circle",
     LISTS, general},
    {"conic_by(points: list of points, tangents: list of records {point, direction} = [], "
     "kind: \"general\" or \"axis\" or \"circle\" or \"line\" = "
     "\"general\"|\"axis\"|\"circle\"|\"line\")",
     cag_conics_conic_by, "curve",
     "Returns the conic through given points that also has the given tangents, a list of {point, "
     "direction} at points that it passes through. Points and tangents are one condition each: "
     "`general` needs 5, `axis` (axes along x and y) 4, `circle` 3, and `line` 2. Too few, "
     "dependent, or contradictory conditions are errors. The coefficient of y^2 is 1; if it is "
     "0, the first other one is 1.",
     "c = conic_by([[0, 1], [2, 0]], tangents: [{point: [0, 1], direction: [1, 0]},\n"
     "  {point: [2, 0], direction: [0, 1]}], kind: \"axis\")\n"
     "print near(coefficients(c), [0.25, 0, 1, 0, 0, -1]) // expect: true",
     LISTS, general},
    {"intersect_line(C: conic or curve, P: point or list [p, q, r], Q: point = none)",
     cag_conics_intersect_line, "record",
     "Returns where a whole conic meets the infinite line through P and Q, or the line [p, q, r] "
     "given instead of P: the status (\"two\", \"tangent\", \"one\" for lines along an asymptote or a "
     "parabola's axis, \"none\", or \"within\" for lines that are part of the conic) and the points.",
     "r = intersect_line(circle(5), [3, 4], [3, 0])\n"
     "print r.status, round(r.points, 9) // expect: two [[3, 4], [3, -4]]\n"
     "print intersect_line(circle(1), [1, 1, -3]).status // expect: none",
     EQUATIONS, general},
    {"polar_line(C: conic or curve, P: point)", cag_conics_polar_line, "list",
     "Returns the polar line [p, q, r] of P. For a point of the conic, it is the tangent.",
     "print polar_line(conic([1, 0, 1, 0, 0, -25]), [3, 4]) // expect: [3, 4, -25]", EQUATIONS,
     general},
    {"implicit_at(C: conic or curve, P: point)", cag_conics_implicit_at, "record",
     "For f(x, y) = 0, with f the form of the conic, returns at P: the value and the gradient of "
     "f, and the slope (none: vertical), the curvature, and its radius (none: straight) of the "
     "level curve of f.",
     "print implicit_at(conic([1, 0, 1, 0, 0, -25]), [3, 4]).slope // expect: -0.75", EQUATIONS,
     general},

    // --- Touching ---
    {"circle_tangent(A: line or circle, B: line or circle, radius: length, "
     "side: \"left\" or \"right\" = \"left\"|\"right\", nearness: \"far\" or \"near\" = "
     "\"far\"|\"near\", "
     "contact: \"outside\" or \"inside\" or list of 2 texts = \"outside\"|\"inside\")",
     cag_conics_circle_tangent, "curve",
     "Returns the circle of this radius that is tangent to A and B, lines (infinite) or circles. "
     "For two lines, `side` is the side of A in its direction, and `far` the side of B to which "
     "A runs. For a line and a circle, `side` is the side of the line, and `near` the first of "
     "the two positions along it. For two circles, `side` is the side of the way from A's center "
     "to B's. `contact` states whether one of two tangent circles lies inside the other; a list "
     "of two states it for A and for B. Parallel lines are an error (parallel-lines).",
     "c = circle_tangent(line([-1, 0], [1, 0]), line([0, -1], [0, 1]), 2, side: \"left\")\n"
     "print near(classify(c).center, [2, 2]) // expect: true",
     CURVES, touching},
    {"fillet(A: curve, B: curve, radius: length > 0)", cag_conics_fillet, "curve",
     "Returns the arc of this radius that rounds the corner where the plane curves A and B meet: "
     "where the end of A is the start of B, or else at their last intersection along A. It is an "
     "error if the arc does not fit (radius-too-large).",
     "f = fillet(line([0, 0], [10, 0]), line([10, 0], [10, 10]), 2)\n"
     "print near(start_point(f), [8, 0]), near(end_point(f), [10, 2]) // expect: true true",
     CURVES, touching},
    {"tangent_lines(C: curve, P: point or curve)", cag_conics_tangent_lines, "list",
     "Returns the tangent lines of a plane curve that pass through P, from the point of contact "
     "to P. If P is a curve, returns the lines that are tangent to both, from one point of "
     "contact to the other.",
     "print map(tangent_lines(circle(3), [5, 0]), l => round(length(l), 9)) // expect: [4, 4]\n"
     "print len(tangent_lines(circle(1), circle(1, center: [5, 0]))) // expect: 4",
     CURVES, touching},
    {"rounded(C: curve or region, radius: length)", cag_conics_rounded, "curve",
     "Replaces the corners of a polyline, or of any plane curve, by arcs of this radius. A "
     "radius that does not fit is an error (radius-too-large) that names the edge.",
     "print near(length(rounded(polyline([[0, 0], [4, 0], [4, 4]]), 1)), 6 + pi / 2) // expect: "
     "true",
     CURVES, touching},
    {"rounded(R: region, radius: length)", cag_conics_rounded_region, "region",
     "Rounds the corners of all boundaries of a region by this radius.",
     "print near(area(rounded(rectangle(4, 4), 1)), 12 + pi) // expect: true", CAG_TAKES(REGION),
     touching},

    // --- By coordinates ---
    {"line_through(P: point, Q: point)", cag_conics_line_through, "list",
     "Returns the line p x + q y + r = 0 through two points of the plane, as [p, q, r].",
     "print line_through([0, 0], [1, 2]) // expect: [-2, 1, 0]", LISTS, coordinates},
    {"meet_lines(A: list [p, q, r], B: list [p, q, r])", cag_conics_meet_lines, "record",
     "Returns where the lines [p, q, r] meet: the status \"point\", \"parallel\", or \"coincident\"; "
     "the point, also as [x, y, w]; and for parallel lines, their direction as the point at "
     "infinity [x, y, 0].",
     "print meet_lines([1, 1, -1], [1, 1, 0]).homogeneous // expect: [1, -1, 0]", LISTS,
     coordinates},
    {"line_image(A: list [p, q, r], T: transform)", cag_conics_line_image, "list",
     "Returns the image of the line [p, q, r] under a transform of the plane.",
     "print line_image([1, 0, -2], translate([3, 0])) // expect: [1, 0, -5]", LISTS, coordinates},
    {"points_at(C: curve, x: length = none, y: length = none)", cag_conics_points_at, "list",
     "Returns the points where a plane curve has this x, or this y: records of t and point, "
     "sorted by t.",
     "print map(points_at(line([0, 0], [4, 2]), x: 2), m => m.point) // expect: [[2, 1]]", CURVES,
     coordinates},
    {"slope(C: curve, t: number or angle)", cag_conics_slope, "number",
     "Returns the slope dy/dx of a plane curve; none where it is vertical.",
     "print slope(line([0, 0], [4, 2]), 0), slope(line([0, 0], [0, 1]), 0) // expect: 0.5 none",
     CURVES, coordinates},
    {"signed_curvature(C: curve, t: number or angle)", cag_conics_signed_curvature, "number",
     "Returns the curvature of a plane curve, which is positive where the curve turns left.",
     "print near(signed_curvature(reverse(circle(4)), 10deg), -0.25) // expect: true", CURVES,
     coordinates},
    {"fit_formula(points: list of points, "
     "model: \"polynomial\" or \"power\" or \"exponential\" = "
     "\"polynomial\"|\"power\"|\"exponential\", "
     "degree: integer = 1)",
     cag_conics_fit_formula, "record",
     "Returns a least-squares fit in y: the coefficients [c0, c1, ...] of the polynomial c0 + c1 "
     "x + ... of the degree; or a and b of the power law a x^b or of a exp(b x), which are "
     "fitted as lines through the logarithms; and the residual_sum_of_squares of y. It is an "
     "error if there are fewer different x than coefficients (underdetermined).",
     "print fit_formula([[0, 1], [1, 3], [2, 5]]).coefficients |> round(12) // expect: [1, 2]",
     LISTS, coordinates},
    {0}};
