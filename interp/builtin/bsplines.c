// The table of B-splines: knots and bases as data, the spans of a curve, its other forms, and what
// it shares with other shapes.

#include "interp/builtin/bsplines.h"

#define CURVES CAG_TAKES(CURVE)
#define LISTS CAG_TAKES_LISTS
#define NUMBERS CAG_TAKES(NUMBER)

static const char bases[] = "B-splines: knots and bases";
static const char spans[] = "B-splines: spans and control points";
static const char forms[] = "Curves: conversion";
static const char near[] = "Curves: distances and intersections";
static const char shown[] = "Curves: display";

const CagBuiltin cag_builtins_bsplines[] = {
    // --- Knots and bases ---
    {"uniform_knots(count: integer, start: number = 0, step: number = 1)",
     cag_bsplines_uniform_knots, "list", "Returns this number of equally spaced knots.",
     "print uniform_knots(5, start: -0.5, step: 0.25) // expect: [-0.5, -0.25, 0, 0.25, 0.5]",
     NUMBERS, bases},
    {"classify_knots(knots: list of numbers, degree: integer >= 1 = 3, "
     "order: integer = none)",
     cag_bsplines_classify_knots, "record",
     "Describes a knot vector: its `class` (\"uniform\", \"open-uniform\", \"open-nonuniform\", or "
     "\"nonuniform\"), the number of control `points`, the `multiplicities` (each knot and how "
     "often it occurs), the usable `range`, its number of `segments`, and the `full_range` of "
     "all knots. At a knot of multiplicity m, a curve is degree - m times continuously "
     "differentiable.",
     "k = classify_knots([0, 0, 0, 1, 1, 2, 2, 2], 2)\n"
     "print k.class, k.points, k.multiplicities // expect: open-nonuniform 5 [[0, 3], [1, 2], [2, "
     "3]]",
     LISTS, bases},
    {"basis(knots: list of numbers, degree: integer >= 1 = 3, "
     "t: number or list of numbers = 0, derivative: integer = 0, order: integer = none, "
     "weights: list of numbers = none, side: \"right\" or \"left\" = \"right\")",
     cag_bsplines_basis, "list",
     "Returns the values at t of all B-spline basis functions of a knot vector, or their "
     "derivatives (at a knot, from the right, or from the left with `side: \"left\"`). With "
     "weights, the functions are rational. t may be anywhere within the knots; the sum is 1 "
     "within the usable range. For a list of parameters, returns one row for each.",
     "print basis([0, 0, 0, 1, 1, 1], 2, 0.5) // expect: [0.25, 0.5, 0.25]\n"
     "print basis([0, 0, 1, 1], 1, [0, 0.25, 1]) // expect: [[1, 0], [0.75, 0.25], [0, 1]]\n"
     "print basis([0, 0, 0, 1, 1, 1], 2, 0.5, weights: [1, 2, 1])[1] == 2 / 3 // expect: true",
     LISTS, bases},
    {"basis_triangle(knots: list of numbers, degree: integer >= 1 = 3, "
     "t: number or list of numbers = 0, order: integer = none)",
     cag_bsplines_basis_triangle, "list",
     "Returns the values at t of all basis functions of degree 0, 1, ..., up to the degree: one "
     "list for each degree.",
     "print basis_triangle([0, 1, 2, 3, 4], 1, 1.5) // expect: [[0, 1, 0, 0], [0.5, 0.5, 0]]",
     LISTS, bases},
    {"basis_pieces(knots: list of numbers, degree: integer >= 1 = 3, order: integer = none, "
     "local: bool = false)",
     cag_bsplines_basis_pieces, "list",
     "Returns the polynomial pieces of the basis functions, one record for each knot interval: "
     "the `interval`, the indices of the `functions` that are not 0 there, the `coefficients` of "
     "each in ascending powers of t (with `local`, of t minus the start of the interval), and "
     "the `matrix`: [t^p .. t 1] * matrix gives the values of these functions.",
     "p = basis_pieces([0, 0, 0, 1, 2, 2, 2], 2)[0]\n"
     "print p.interval, p.functions, p.coefficients\n"
     "// expect: 0..1 [0, 1, 2] [[1, -2, 1], [0, 2, -1.5], [0, 0, 0.5]]",
     LISTS, bases},
    {"basis_dependency(i: integer, degree: integer >= 1 = 3, order: integer = none, "
     "count: integer = none)",
     cag_bsplines_basis_dependency, "record",
     "Returns, for degree 0, 1, ..., the indices of the basis functions that function i of the "
     "degree `needs`, and of those that function i of degree 0 `feeds`; limited to `count` "
     "functions of the degree if it is given.",
     "print basis_dependency(2, 2).feeds // expect: [[2], [1, 2], [0, 1, 2]]", NUMBERS, bases},
    {"oslo(knots: list of numbers, refined: list of numbers, degree: integer >= 1 = 3, "
     "order: integer = none)",
     cag_bsplines_oslo, "list",
     "Returns the coefficients of the Oslo algorithm, which inserts knots: for degree 0, 1, ..., "
     "the table a[i][j]. With the last table, new point j is the sum over i of a[i][j] times old "
     "point i. `refined` must contain all knots (not-a-refinement).",
     "print oslo([0, 0, 1, 1], [0, 0, 0.5, 1, 1], 1)[1] // expect: [[1, 0.5, 0], [0, 0.5, 1]]",
     LISTS, bases},
    {"phantom_points(points: list of points, degree: integer >= 1 = 3, "
     "start: \"position\" or record = \"position\", end: \"position\" or record = \"position\", "
     "order: integer = none)",
     cag_bsplines_phantom_points, "list",
     "Adds a point before and after the points, so that the B-spline with uniform knots (`knots: "
     "\"periodic\"`) starts and ends at the given end points, or has the derivative `{tangent: V}` "
     "or the second derivative `{second: V}` there.",
     "p = phantom_points([[0, 0], [3, 9], [6, 3], [9, 6]], end: {tangent: [3, 0]})\n"
     "print p[0], p[-1] // expect: [-3, -9] [12, 3]\n"
     "print near(start_point(bspline(p, knots: \"periodic\")), [0, 0]) // expect: true",
     LISTS, bases},

    // --- Spans and control points ---
    {"spans(C: curve)", cag_bsplines_spans, "list",
     "Returns the knot intervals of a Bezier or B-spline curve. On each, the curve is polynomial "
     "or rational.",
     "print spans(bspline([[0, 0], [1, 2], [3, 2], [4, 0]], degree: 2)) // expect: [0..1, 1..2]",
     CURVES, spans},
    {"support(C: curve, i: integer)", cag_bsplines_support, "range",
     "Returns the range that control point i influences. For a closed curve, it is a list of "
     "ranges, two if it passes the seam. It is none if the point has no influence.",
     "print support(bspline([for i in 0..7: [i, i % 2]]), 4) // expect: 1..5", CURVES, spans},
    {"acting_points(C: curve, t: number or angle, side: \"right\" or \"left\" = \"right\")",
     cag_bsplines_acting_points, "record",
     "Returns the control points that influence the curve at t: the knot `span`, their "
     "`indices`, and the `points`. The curve over the span lies in their convex hull.",
     "a = acting_points(bspline([for i in 0..4: [i, i^2]], degree: 2), 1.5)\n"
     "print a.span, a.indices // expect: 1..2 [1, 2, 3]",
     CURVES, spans},
    {"straight_spans(C: curve)", cag_bsplines_straight_spans, "list",
     "Returns the spans on which the curve is straight because its control points there are "
     "collinear.",
     "c = bspline([[0, 0], [1, 2], [2, 2], [3, 2], [4, 0]], degree: 2, knots: \"periodic\")\n"
     "print straight_spans(c) // expect: [3..4]",
     CURVES, spans},
    {"denominator(C: curve, t: number or angle, derivative: integer = 0, "
     "side: \"right\" or \"left\" = \"right\")",
     cag_bsplines_denominator, "number",
     "Returns the sum of the weights times the basis functions at t, by which a rational curve "
     "is divided, or its derivative. It is 1 if the curve is not rational.",
     "c = bezier([[0, 0], [1, 2], [2, 0]], weights: [1, 3, 1])\n"
     "print denominator(c, 0.5) // expect: 2",
     CURVES, spans},
    {"nurbs_circle(radius: length, segments: integer = 4, center: point = [0, 0], "
     "normal: vector = none, start: angle = 0deg)",
     cag_bsplines_nurbs_circle, "curve",
     "Returns the circle as a rational B-spline curve of degree 2 with this number of equal arcs "
     "(at least 3), one for each unit of the parameter. Its control points are the vertices of "
     "the circumscribed polygon and the midpoints of its sides.",
     "c = nurbs_circle(2, segments: 3)\n"
     "print domain(c), near(norm(c(0.7)), 2), near(weights(c)[1], 0.5) // expect: 0..3 true true",
     NUMBERS, spans},

    {"nurbs_arc(radius: length, range: range of angles, segments: integer = 1, "
     "center: point = [0, 0], normal: vector = none)",
     cag_bsplines_nurbs_arc, "curve",
     "Returns an arc over a range of angles (which may decrease) as a rational B-spline curve of "
     "degree 2 with this number of equal pieces. Each piece must span less than 180deg "
     "(arc-too-wide).",
     "print near(weights(nurbs_arc(2, 0deg..120deg)), [1, 0.5, 1]) // expect: true", NUMBERS,
     spans},

    // --- Other forms ---
    {"to_bezier(C: curve)", cag_bsplines_to_bezier, "list",
     "Returns the Bezier curves, each over 0..1, that make up the curve. A curve without an "
     "exact rational form is an error (no-exact-form).",
     "c = bspline([[0, 0], [1, 1], [2, 1], [3, 0]], degree: 2)\n"
     "print points(to_bezier(c)[0]) // expect: [[0, 0], [1, 1], [1.5, 1]]",
     CURVES, forms},
    {"elevate(C: curve, times: integer in 0..1000 = 1)", cag_bsplines_elevate, "curve",
     "Raises the degree without changing the curve. The multiplicity of each knot increases, so "
     "the smoothness stays the same.",
     "print degree(elevate(bezier([[0, 0], [1, 2], [2, 0]]))) // expect: 3", CURVES, forms},
    {"reduce_degree(C: curve, tolerance: length)", cag_bsplines_reduce_degree, "curve",
     "Returns a curve of one degree less that keeps the ends and is within the tolerance (mm) at "
     "each parameter. If this is not possible, the error (tolerance-exceeded) states by how much "
     "points would move. `deviation` measures the change.",
     "c = bezier([[0, 0], [1, 2], [2, 0]])\n"
     "print near(points(reduce_degree(elevate(c), 1e-9)), points(c)) // expect: true",
     CURVES, forms},
    {"insert_knot(C: curve, t: number or angle, times: integer = 1)", cag_bsplines_insert_knot,
     "curve",
     "Inserts the knot t this many times without changing the curve. A knot may occur at most as "
     "often as the degree (knot-multiplicity). A closed curve becomes an open one.",
     "c = insert_knot(bspline([[0, 0], [1, 1], [2, 1], [3, 0]], degree: 2), 1)\n"
     "print points(c) // expect: [[0, 0], [1, 1], [1.5, 1], [2, 1], [3, 0]]",
     CURVES, forms},
    {"remove_knot(C: curve, t: number or angle, tolerance: length = none, "
     "times: integer = 1)",
     cag_bsplines_remove_knot, "curve",
     "Removes the inner knot t this many times, if no point moves by more than the tolerance "
     "(mm; none: 1e-9 of the size; inf: no limit). Otherwise, the error (tolerance-exceeded) "
     "states by how much points would move.",
     "c = bspline([[0, 0], [1, 1], [2, 1], [3, 0]], degree: 2)\n"
     "print near(points(remove_knot(insert_knot(c, 0.25), 0.25)), points(c)) // expect: true",
     CURVES, forms},
    {"refine(C: curve, knots: list of numbers or \"midpoints\" = \"midpoints\")",
     cag_bsplines_refine, "curve",
     "Inserts all given knots, or one in the middle of each span, without changing the curve. "
     "With midpoints, uniform knots stay uniform, and a closed curve stays closed with twice as "
     "many points.",
     "c = bspline([[0, 0], [4, 0], [4, 4], [0, 4]], degree: 2, closed: true)\n"
     "print points(refine(c))[0] // expect: [1, 0]",
     CURVES, forms},
    {"clamp_ends(C: curve)", cag_bsplines_clamp_ends, "curve",
     "Repeats the end knots without changing the curve, so that it starts at its first control "
     "point and ends at its last.",
     "c = bspline([[0, 0], [3, 9], [6, 3], [9, 6]], degree: 2, knots: \"periodic\")\n"
     "print knots(clamp_ends(c)) // expect: [2, 2, 2, 3, 4, 4, 4]",
     CURVES, forms},

    // --- Near and across ---
    {"deviation(C: curve, D: curve)", cag_bsplines_deviation, "number",
     "Returns the largest distance (mm) between points of equal parameters. The domain of D is "
     "mapped to that of C.",
     "print deviation(line([0, 0], [2, 0]), line([0, 1], [2, 3])) // expect: 3", CURVES, near},
    {"approximate(C: curve, tolerance: length > 0)", cag_bsplines_approximate, "curve",
     "Returns a B-spline curve within the tolerance (mm) of the curve: the exact form if there "
     "is one, otherwise a cubic that is continuously differentiable where the curve is.",
     "h = helix(10, 5, 2)\n"
     "print deviation(approximate(h, 0.001), h) < 0.001 // expect: true",
     CURVES, near},
    {"offset(C: curve, d: length, tolerance: length = none)", cag_bsplines_offset, "curve",
     "Returns the curve at distance d (mm) to the left of a plane curve, or to the right if d is "
     "negative. For lines, polylines, and circles, it is exact; for other curves, it is within "
     "the tolerance (none: 1e-6 of the size). Outer corners become arcs, or sharp corners for "
     "polylines. Inner corners are trimmed where the parts meet (offset-corner if they do not). "
     "Where d exceeds the radius of curvature, the curve crosses itself. A circle of which "
     "nothing is left is an error (offset-collapses).",
     "print near(length(offset(circle(5), 1)), 8 * pi) // expect: true\n"
     "print points(offset(polyline([[0, 0], [4, 0], [4, 4]]), 1)) // expect: [[0, 1], [3, 1], [3, "
     "4]]",
     CURVES, near},
    {"intersect(C: curve, A: curve or surface or plane)", cag_bsplines_intersect, "list",
     "Returns all points where the curve meets another curve, a surface, or a plane, sorted by "
     "t: records of point, t, t2 of the other curve or u and v of the surface, and multiplicity: "
     "1 at a crossing, or the order of contact where they touch (usually 2). Points within 1e-9 "
     "of the size are merged. It is an error if they share more than single points (overlap).",
     "m = intersect(circle(5), line([-10, 3], [10, 3]))\n"
     "print len(m), near(m[0].point, [4, 3]), near(m[0].t2, 0.7) // expect: 2 true true\n"
     "print intersect(circle(2), circle(1.9, center: [0.1, 0]))[0].multiplicity // expect: 2\n"
     "print len(intersect(helix(10, 5, 3), plane([0, 0, 4], Z))) // expect: 1\n"
     "s = intersect(line([-9, 0, 0], [9, 0, 0]), sphere_surface(3))\n"
     "print len(s), near(s[0].point, [-3, 0, 0]) // expect: 2 true",
     CURVES, near},

    // --- Pictures ---
    {"control_net(C: curve)", cag_bsplines_control_net, "curve",
     "Returns the control polygon of a Bezier or B-spline curve.",
     "print length(control_net(bezier([[0, 0], [3, 4], [6, 0]]))) // expect: 10", CURVES, shown},
    {"curvature_comb(C: curve, n: integer = none, scale: number = none)",
     cag_bsplines_curvature_comb, "group",
     "Returns the curvature comb of a curve: n lines that point away from the center of "
     "curvature. Their length is the curvature times `scale` (mm2). A further line connects "
     "their tips. By default, the longest line is a quarter of the size of the curve.",
     "show curvature_comb(bezier([[0, 0], [1, 2], [3, 2], [4, 0]]), 30)", CURVES, shown},
    {"hedgehog(C: curve, n: integer = none, scale: number = none)", cag_bsplines_curvature_comb,
     "group", "Deprecated: use `curvature_comb`.",
     "print len(hedgehog(circle(10), 4).items) // expect: 5", CURVES, shown},
    {0}};
