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
     "The parabola y^2 = 4 a x with its vertex in `center`. A range of numbers t is the quadratic "
     "form [a t^2, 2 a t]; a range of angles between -90deg and 90deg the tangent form [tan(t)^2, "
     "2 sqrt(a) tan(t)]. Instead of it, `x` gives the range of x on the upper half, or `y` that of "
     "y (domain). A range that runs down gives the curve over the ascending range, reversed. With "
     "a "
     "normal it lies in space.",
     "c = parabola(1, -1..2)\n"
     "print c(-1), c(2) // expect: [1, -2] [4, 4]\n"
     "print domain(parabola(1, x: 1..4)) // expect: 1..2",
     NUMBERS, axes},
    {"hyperbola(a: length, b: length, range: range of numbers or angles = none, "
     "center: point = [0, 0], normal: vector = none, x: range of lengths = none, "
     "y: range of lengths = none)",
     cag_conics_hyperbola, "curve",
     "The hyperbola x^2/a^2 - y^2/b^2 = 1. A range of numbers t is the hyperbolic form [a cosh(t), "
     "b sinh(t)], the right branch; a range of angles between two odd multiples of 90deg the "
     "secant form [a / cos(t), b tan(t)], within 90deg..270deg the left branch. Instead of it, `x` "
     "gives the range of x on the upper half of the right branch, or `y` that of y (domain). A "
     "range "
     "that runs down gives the curve over the ascending range, reversed.",
     "h = hyperbola(2, 1, -60deg..60deg)\n"
     "print near(h(60deg), [4, sqrt(3)]) // expect: true\n"
     "print near(h(0deg), hyperbola(2, 1, -1..1)(0)) // expect: true",
     NUMBERS, axes},
    {"conic_points(C: conic or curve, n: integer, "
     "by: \"parameter\" or \"angle\" or \"length\" or \"rational\" or \"x\" = "
     "\"parameter\"|\"angle\"|\"length\"|\"rational\"|\"x\")",
     cag_conics_conic_points, "list",
     "n points of a circle, ellipse, parabola or hyperbola or an arc of one, both ends in (a "
     "closed one ends in its first point). \"parameter\": at equal steps of the parameter by the "
     "classical recurrences, which inscribe the largest area. Of circles and ellipses \"angle\": "
     "at equal polar angles about the center; \"rational\": at equal steps of tan(t/2). \"length\" "
     "and \"x\": at equal arc lengths, at equal steps of x; these two of any curve.",
     "print conic_points(parabola(1, 0..2), 3) // expect: [[0, 0], [1, 2], [4, 4]]\n"
     "print near(conic_points(circle(1), 5)[1], [0, 1]) // expect: true",
     CURVES, axes},
    {"conic_arc(P: point, apex: point, Q: point, rho: number in 0..1 = none, "
     "shoulder: point = none, weight: number = none)",
     cag_conics_conic_arc, "curve",
     "The arc of a conic from P to Q whose end tangents meet in the apex, as a rational Bezier "
     "curve of degree 2. How far it bulges is said by one of: `weight` of the apex (1: a parabola, "
     "less: an ellipse, more: a hyperbola, 0: the chord, which is a line), `rho` = weight/(1 + "
     "weight), the fraction of the way from the chord's middle to the apex, or `shoulder`, a point "
     "inside the triangle that it goes "
     "through.",
     "q = conic_arc([1, 0], [1, 1], [0, 1], weight: sqrt(0.5))\n"
     "print near(norm(q(0.3)), 1) // expect: true\n"
     "print conic_arc([0, 0], [1, 2], [2, 0], rho: 0.5)(0.5) // expect: [1, 1]",
     LISTS, axes},

    // --- By their equation ---
    {"conic(coefficients: list of 6 numbers or list of 3 rows, halved: bool = false)",
     cag_conics_conic, "curve",
     "The conic a x^2 + b xy + c y^2 + d x + e y + f = 0 of [a, b, c, d, e, f], or of the 3 rows "
     "of "
     "its symmetric matrix. `halved: true` reads the form with factors 2, a x^2 + 2b xy + c y^2 + "
     "2d x + 2e y + f = 0. All conics are values, degenerate and empty ones, too: `classify` tells "
     "what it is, `branches` gives its curves; with one branch it is that curve itself. Transforms "
     "of the plane carry the equation along, projective ones as well.",
     "c = conic([1, 0, 4, 0, 0, -4])\n"
     "print classify(c).class, near(c(90deg), [0, 1]) // expect: ellipse true",
     LISTS, general},
    {"conic(C: conic or curve)", cag_conics_conic_of_curve, "curve",
     "The whole conic that a circle, ellipse, parabola, hyperbola, an arc of one, a line or a "
     "Bezier curve of degree 2 belongs to.",
     "print classify(conic(bezier([[0, 0], [1, 2], [2, 0]]))).class // expect: parabola", CURVES,
     general},
    {"coefficients(C: conic or curve)", cag_conics_coefficients, "list",
     "The coefficients [a, b, c, d, e, f] of a conic a x^2 + b xy + c y^2 + d x + e y + f = 0, or "
     "of "
     "the conic that a curve belongs to (see `conic`); they have a common factor.",
     "print coefficients(conic([1, 2, 3, 4, 5, 6], halved: true)) // expect: [1, 4, 3, 8, 10, 6]",
     EQUATIONS, general},
    {"classify(C: conic or curve)", cag_conics_classify, "record",
     "What a conic is: class (\"ellipse\" \"circle\" \"hyperbola\" \"parabola\" \"point\" "
     "\"intersecting_lines\" \"parallel_lines\" \"double_line\" \"line\" \"plane\" \"empty\"), "
     "discriminant b^2 - 4ac, central (no parabola), center, vertex of a parabola, angle of the "
     "major or real axis in -90deg..90deg (of a parabola of the way into its opening), a, b and "
     "axes [a, b] (of a hyperbola a is real), p of a parabola (y^2 = 4 p x in its axes), "
     "eccentricity, foci, lines [p, q, r] that it consists of, standard (angle that removes the xy "
     "term, coefficients in those axes, alpha x^2 + beta y^2 = kappa about the center), and the "
     "symmetric matrix. What does not exist is none. Of a curve of space that lies in a plane, "
     "center, vertex and foci are points of space; all else is in coordinates of the plane, which "
     "`frame` carries to space.",
     "k = classify(conic([2, -72, 23, 140, -20, 50]))\n"
     "print k.class, k.center, near(k.axes, [2, sqrt(2)]) // expect: hyperbola [1, 2] true",
     CURVES, general},
    {"branches(C: conic or curve, range: range of numbers = -2..2)", cag_conics_branches, "list",
     "The real curves of a conic: one ellipse or circle, a parabola, the two branches of a "
     "hyperbola, its lines; none of a point or an empty conic. Of a parabola and hyperbola the "
     "quadratic or hyperbolic parameter runs over the range, of lines the distance from the point "
     "nearest to the center.",
     "print map(branches(conic([1, 0, -1, 0, 0, -1])), b => b(0)) // expect: [[1, 0], [-1, 0]]",
     EQUATIONS, general},
    {"conic_point(C: conic or curve, x: length, "
     "branch: \"lower\" or \"upper\" = \"lower\"|\"upper\")",
     cag_conics_point_of_conic, "list",
     "The point of a conic at this x that has the smaller or the larger y; an error where there is "
     "none (domain).",
     "print conic_point(conic([1, 0, 1, 0, 0, -25]), 3, branch: \"upper\") // expect: [3, 4]",
     EQUATIONS, general},
    {"conic_segment(C: conic or curve, x: range of lengths, "
     "branch: \"lower\" or \"upper\" = \"lower\"|\"upper\")",
     cag_conics_conic_segment, "curve",
     "The arc of a conic over a range of x (which may run down), on the branch of the smaller or "
     "the larger y. Where the conic has no point at an end, or the ends lie on two branches of a "
     "hyperbola, it is an error (domain).",
     "s = conic_segment(conic([1, 0, 1, 0, 0, -25]), -3..4, branch: \"upper\")\n"
     "print near(start_point(s), [-3, 4]), near(end_point(s), [4, 3]) // expect: true true",
     EQUATIONS, general},
    {"conic_through(P: point, ...)", cag_conics_conic_through, "curve",
     "The conic through five points of the plane, given one by one or as one list. More points "
     "must agree. Points that leave the conic open are an error (conditions-dependent).",
     "c = conic_through([1, 0], [0, 1], [-1, 0], [0, -1], [0.6, 0.8])\n"
     "print classify(c).class // expect: circle",
     LISTS, general},
    {"conic_by(points: list of points, tangents: list of records {point, direction} = [], "
     "kind: \"general\" or \"axis\" or \"circle\" or \"line\" = "
     "\"general\"|\"axis\"|\"circle\"|\"line\")",
     cag_conics_conic_by, "curve",
     "The conic through the points that has the given tangents: a list of {point, direction}, "
     "whose "
     "points it goes through as well. Points and tangents are one condition each: `general` needs "
     "5, `axis` (axes along x and y) 4, `circle` 3, `line` 2. Too few, dependent and contradicting "
     "conditions are errors. The coefficient of y^2 is 1, where it vanishes the first other.",
     "c = conic_by([[0, 1], [2, 0]], tangents: [{point: [0, 1], direction: [1, 0]},\n"
     "  {point: [2, 0], direction: [0, 1]}], kind: \"axis\")\n"
     "print near(coefficients(c), [0.25, 0, 1, 0, 0, -1]) // expect: true",
     LISTS, general},
    {"intersect_line(C: conic or curve, P: point or list [p, q, r], Q: point = none)",
     cag_conics_intersect_line, "record",
     "Where a whole conic meets the whole line through P and Q, or the line [p, q, r] given in "
     "place of P: status (\"two\", \"tangent\", \"one\" of lines along an asymptote or a "
     "parabola's "
     "axis, \"none\", \"within\" of lines that belong to the conic) and points.",
     "r = intersect_line(circle(5), [3, 4], [3, 0])\n"
     "print r.status, round(r.points, 9) // expect: two [[3, 4], [3, -4]]\n"
     "print intersect_line(circle(1), [1, 1, -3]).status // expect: none",
     EQUATIONS, general},
    {"polar_line(C: conic or curve, P: point)", cag_conics_polar_line, "list",
     "The polar line [p, q, r] of P: of a point of the conic its tangent.",
     "print polar_line(conic([1, 0, 1, 0, 0, -25]), [3, 4]) // expect: [3, 4, -25]", EQUATIONS,
     general},
    {"implicit_at(C: conic or curve, P: point)", cag_conics_implicit_at, "record",
     "Of f(x, y) = 0, f the conic's form: value and gradient of f at P, slope (none: vertical), "
     "curvature and its radius (none: straight) of the curve f = const there.",
     "print implicit_at(conic([1, 0, 1, 0, 0, -25]), [3, 4]).slope // expect: -0.75", EQUATIONS,
     general},

    // --- Touching ---
    {"circle_tangent(A: line or circle, B: line or circle, radius: length, "
     "side: \"left\" or \"right\" = \"left\"|\"right\", nearness: \"far\" or \"near\" = "
     "\"far\"|\"near\", "
     "contact: \"outside\" or \"inside\" or list of 2 texts = \"outside\"|\"inside\")",
     cag_conics_circle_tangent, "curve",
     "The circle of this radius that touches A and B, lines (taken whole) or circles. Of two "
     "lines: "
     "`side` is that of A as it runs, `far` the side of B that A runs to. Of a line and a circle: "
     "`side` of the line, `near` is the earlier of the two places along it. Of two circles: `side` "
     "of the way from A's center to B's. `contact` says whether of two circles that touch one lies "
     "in the other; a list of two says it of A and of B. Parallel lines have no corner "
     "(parallel-lines).",
     "c = circle_tangent(line([-1, 0], [1, 0]), line([0, -1], [0, 1]), 2, side: \"left\")\n"
     "print near(classify(c).center, [2, 2]) // expect: true",
     CURVES, touching},
    {"fillet(A: curve, B: curve, radius: length)", cag_conics_fillet, "curve",
     "The arc of this radius that leads from A to B in the corner where they meet: where the end "
     "of "
     "A is the start of B, else their last meeting along A. Plane curves of any kind. Where the "
     "arc "
     "does not fit it is an error (radius-too-large).",
     "f = fillet(line([0, 0], [10, 0]), line([10, 0], [10, 10]), 2)\n"
     "print near(start_point(f), [8, 0]), near(end_point(f), [10, 2]) // expect: true true",
     CURVES, touching},
    {"tangent_lines(C: curve, P: point or curve)", cag_conics_tangent_lines, "list",
     "The lines that touch a plane curve and go through P, from where they touch to P; or, P being "
     "a curve, those that touch both, from one touch to the other.",
     "print map(tangent_lines(circle(3), [5, 0]), l => round(length(l), 9)) // expect: [4, 4]\n"
     "print len(tangent_lines(circle(1), circle(1, center: [5, 0]))) // expect: 4",
     CURVES, touching},
    {"rounded(C: curve or region, radius: length)", cag_conics_rounded, "curve",
     "A polyline, or any plane curve with corners, its corners replaced by arcs of this radius. A "
     "radius that does not fit is an error (radius-too-large) that names the edge.",
     "print near(length(rounded(polyline([[0, 0], [4, 0], [4, 4]]), 1)), 6 + pi / 2) // expect: "
     "true",
     CURVES, touching},
    {"rounded(R: region, radius: length)", cag_conics_rounded_region, "region",
     "A region with the corners of all its boundaries rounded by this radius.",
     "print near(area(rounded(rectangle(4, 4), 1)), 12 + pi) // expect: true", CAG_TAKES(REGION),
     touching},

    // --- By coordinates ---
    {"line_through(P: point, Q: point)", cag_conics_line_through, "list",
     "The line p x + q y + r = 0 through two points of the plane, as [p, q, r].",
     "print line_through([0, 0], [1, 2]) // expect: [-2, 1, 0]", LISTS, coordinates},
    {"meet_lines(A: list [p, q, r], B: list [p, q, r])", cag_conics_meet_lines, "record",
     "Where the lines [p, q, r] meet: status \"point\", \"parallel\" or \"coincident\", the point, "
     "and it as [x, y, w]; of parallel lines their direction, [x, y, 0], a point at infinity.",
     "print meet_lines([1, 1, -1], [1, 1, 0]).homogeneous // expect: [1, -1, 0]", LISTS,
     coordinates},
    {"line_image(A: list [p, q, r], T: transform)", cag_conics_line_image, "list",
     "The image of the line [p, q, r] under a transform of the plane.",
     "print line_image([1, 0, -2], translate([3, 0])) // expect: [1, 0, -5]", LISTS, coordinates},
    {"points_at(C: curve, x: length = none, y: length = none)", cag_conics_points_at, "list",
     "Where a plane curve has this x, or this y: records of t and point, in the order of t.",
     "print map(points_at(line([0, 0], [4, 2]), x: 2), m => m.point) // expect: [[2, 1]]", CURVES,
     coordinates},
    {"slope(C: curve, t: number or angle)", cag_conics_slope, "number",
     "The slope dy/dx of a plane curve, none where it is vertical.",
     "print slope(line([0, 0], [4, 2]), 0), slope(line([0, 0], [0, 1]), 0) // expect: 0.5 none",
     CURVES, coordinates},
    {"signed_curvature(C: curve, t: number or angle)", cag_conics_signed_curvature, "number",
     "The curvature of a plane curve, positive where it turns left.",
     "print near(signed_curvature(reverse(circle(4)), 10deg), -0.25) // expect: true", CURVES,
     coordinates},
    {"fit_formula(points: list of points, "
     "model: \"polynomial\" or \"power\" or \"exponential\" = "
     "\"polynomial\"|\"power\"|\"exponential\", "
     "degree: integer = 1)",
     cag_conics_fit_formula, "record",
     "Least squares in y: coefficients [c0, c1, ...] of the polynomial c0 + c1 x + ... of the "
     "degree; a and b of the power law a x^b or of a exp(b x), fitted as lines through the "
     "logarithms; and the residual_sum_of_squares of y. Fewer different x than coefficients are an "
     "error (underdetermined).",
     "print fit_formula([[0, 1], [1, 3], [2, 5]]).coefficients |> round(12) // expect: [1, 2]",
     LISTS, coordinates},
    {0}};
