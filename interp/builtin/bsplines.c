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
     cag_bsplines_uniform_knots, "list", "So many knots in equal steps.",
     "print uniform_knots(5, start: -0.5, step: 0.25) // expect: [-0.5, -0.25, 0, 0.25, 0.5]",
     NUMBERS, bases},
    {"classify_knots(knots: list of numbers, degree: integer >= 1 = 3, "
     "order: integer = none)",
     cag_bsplines_classify_knots, "record",
     "What a knot vector is: `class` (\"uniform\", \"open-uniform\", \"open-nonuniform\" or "
     "\"nonuniform\"), the number of control `points` it is for, `multiplicities` (each knot with "
     "how often it occurs), the usable `range`, its number of `segments`, and the `full_range` of "
     "all knots. At a knot that occurs m times a curve is degree - m times continuously "
     "differentiable.",
     "k = classify_knots([0, 0, 0, 1, 1, 2, 2, 2], 2)\n"
     "print k.class, k.points, k.multiplicities // expect: open-nonuniform 5 [[0, 3], [1, 2], [2, "
     "3]]",
     LISTS, bases},
    {"basis(knots: list of numbers, degree: integer >= 1 = 3, "
     "t: number or list of numbers = 0, derivative: integer = 0, order: integer = none, "
     "weights: list of numbers = none, side: \"right\" or \"left\" = \"right\")",
     cag_bsplines_basis, "list",
     "The values at t of all B-spline basis functions of these knots, or their derivatives (at a "
     "knot those to its right, or with `side: \"left\"` to its left); with weights of the rational "
     "functions. t may lie anywhere within the knots; the sum is 1 within the usable range. Of a "
     "list of parameters a row for each.",
     "print basis([0, 0, 0, 1, 1, 1], 2, 0.5) // expect: [0.25, 0.5, 0.25]\n"
     "print basis([0, 0, 1, 1], 1, [0, 0.25, 1]) // expect: [[1, 0], [0.75, 0.25], [0, 1]]\n"
     "print basis([0, 0, 0, 1, 1, 1], 2, 0.5, weights: [1, 2, 1])[1] == 2 / 3 // expect: true",
     LISTS, bases},
    {"basis_triangle(knots: list of numbers, degree: integer >= 1 = 3, "
     "t: number or list of numbers = 0, order: integer = none)",
     cag_bsplines_basis_triangle, "list",
     "The values at t of all basis functions of degree 0, 1, .. up to the degree: a list for each.",
     "print basis_triangle([0, 1, 2, 3, 4], 1, 1.5) // expect: [[0, 1, 0, 0], [0.5, 0.5, 0]]",
     LISTS, bases},
    {"basis_pieces(knots: list of numbers, degree: integer >= 1 = 3, order: integer = none, "
     "local: bool = false)",
     cag_bsplines_basis_pieces, "list",
     "The polynomials that the basis functions are made of, a record for each interval of knots: "
     "`interval`, the indices of the `functions` that live on it, `coefficients` of each by "
     "ascending powers of t (with `local` of t less the interval's start), and `matrix`: [t^p .. t "
     "1] * matrix gives the values of these functions.",
     "p = basis_pieces([0, 0, 0, 1, 2, 2, 2], 2)[0]\n"
     "print p.interval, p.functions, p.coefficients\n"
     "// expect: 0..1 [0, 1, 2] [[1, -2, 1], [0, 2, -1.5], [0, 0, 0.5]]",
     LISTS, bases},
    {"basis_dependency(i: integer, degree: integer >= 1 = 3, order: integer = none, "
     "count: integer = none)",
     cag_bsplines_basis_dependency, "record",
     "By degree 0, 1, .. the indices of the basis functions that function i of the degree `needs`, "
     "and of those that function i of degree 0 `feeds`; within the indices of `count` functions of "
     "the degree where it is given.",
     "print basis_dependency(2, 2).feeds // expect: [[2], [1, 2], [0, 1, 2]]", NUMBERS, bases},
    {"oslo(knots: list of numbers, refined: list of numbers, degree: integer >= 1 = 3, "
     "order: integer = none)",
     cag_bsplines_oslo, "list",
     "How control points change when knots are inserted (Oslo algorithm): for degree 0, 1, .. the "
     "rows a[i][j]; new point j is the sum over i of a[i][j] times old point i, with the last of "
     "these tables. `refined` contains all knots and more: else an error (not-a-refinement).",
     "print oslo([0, 0, 1, 1], [0, 0, 0.5, 1, 1], 1)[1] // expect: [[1, 0.5, 0], [0, 0.5, 1]]",
     LISTS, bases},
    {"phantom_points(points: list of points, degree: integer >= 1 = 3, "
     "start: \"position\" or record = \"position\", end: \"position\" or record = \"position\", "
     "order: integer = none)",
     cag_bsplines_phantom_points, "list",
     "The points with one more before and after them, so that the B-spline with uniform knots "
     "(`knots: \"periodic\"`) starts in the first and ends in the last of the given points, or has "
     "there the derivative `{tangent: V}` or the second derivative `{second: V}`.",
     "p = phantom_points([[0, 0], [3, 9], [6, 3], [9, 6]], end: {tangent: [3, 0]})\n"
     "print p[0], p[-1] // expect: [-3, -9] [12, 3]\n"
     "print near(start_point(bspline(p, knots: \"periodic\")), [0, 0]) // expect: true",
     LISTS, bases},

    // --- Spans and control points ---
    {"spans(C: curve)", cag_bsplines_spans, "list",
     "The ranges between the knots of a Bezier or B-spline curve: on each it is one polynomial, or "
     "quotient of two.",
     "print spans(bspline([[0, 0], [1, 2], [3, 2], [4, 0]], degree: 2)) // expect: [0..1, 1..2]",
     CURVES, spans},
    {"support(C: curve, i: integer)", cag_bsplines_support, "range",
     "The range over which control point i has an influence: what moves when it is moved. Of a "
     "closed curve a list of ranges, two where it passes the seam; none where it has none.",
     "print support(bspline([for i in 0..7: [i, i % 2]]), 4) // expect: 1..5", CURVES, spans},
    {"acting_points(C: curve, t: number or angle, side: \"right\" or \"left\" = \"right\")",
     cag_bsplines_acting_points, "record",
     "The control points that the curve at t is made of: the `span` between knots, their `indices` "
     "and the `points`. The curve over the span lies in their convex hull.",
     "a = acting_points(bspline([for i in 0..4: [i, i^2]], degree: 2), 1.5)\n"
     "print a.span, a.indices // expect: 1..2 [1, 2, 3]",
     CURVES, spans},
    {"straight_spans(C: curve)", cag_bsplines_straight_spans, "list",
     "The spans on which the curve is straight because all control points that act lie on a line.",
     "c = bspline([[0, 0], [1, 2], [2, 2], [3, 2], [4, 0]], degree: 2, knots: \"periodic\")\n"
     "print straight_spans(c) // expect: [3..4]",
     CURVES, spans},
    {"denominator(C: curve, t: number or angle, derivative: integer = 0, "
     "side: \"right\" or \"left\" = \"right\")",
     cag_bsplines_denominator, "number",
     "The sum of the weights times the basis functions at t, by which a rational curve is divided, "
     "or its derivative; 1 of one that is not rational.",
     "c = bezier([[0, 0], [1, 2], [2, 0]], weights: [1, 3, 1])\n"
     "print denominator(c, 0.5) // expect: 2",
     CURVES, spans},
    {"nurbs_circle(radius: length, segments: integer = 4, center: point = [0, 0], "
     "normal: vector = none, start: angle = 0deg)",
     cag_bsplines_nurbs_circle, "curve",
     "The circle as a rational B-spline of degree 2 of so many equal arcs (3 at least), one for "
     "each unit of the parameter; its control points are the corners of the polygon around it and "
     "the middles of the sides.",
     "c = nurbs_circle(2, segments: 3)\n"
     "print domain(c), near(norm(c(0.7)), 2), near(weights(c)[1], 0.5) // expect: 0..3 true true",
     NUMBERS, spans},

    {"nurbs_arc(radius: length, range: range of angles, segments: integer = 1, "
     "center: point = [0, 0], normal: vector = none)",
     cag_bsplines_nurbs_arc, "curve",
     "The arc over a range of angles (which may run down) as a rational B-spline of degree 2 of so "
     "many equal pieces; each turns by less than 180deg: else an error (arc-too-wide).",
     "print near(weights(nurbs_arc(2, 0deg..120deg)), [1, 0.5, 1]) // expect: true", NUMBERS,
     spans},

    // --- Other forms ---
    {"to_bezier(C: curve)", cag_bsplines_to_bezier, "list",
     "The Bezier curves, over 0..1 each, that the curve is made of. A curve without exact rational "
     "form is an error (no-exact-form).",
     "c = bspline([[0, 0], [1, 1], [2, 1], [3, 0]], degree: 2)\n"
     "print points(to_bezier(c)[0]) // expect: [[0, 0], [1, 1], [1.5, 1]]",
     CURVES, forms},
    {"elevate(C: curve, times: integer = 1)", cag_bsplines_elevate, "curve",
     "The same curve with its degree raised; each knot then occurs once more, so the smoothness "
     "stays.",
     "print degree(elevate(bezier([[0, 0], [1, 2], [2, 0]]))) // expect: 3", CURVES, forms},
    {"reduce_degree(C: curve, tolerance: length)", cag_bsplines_reduce_degree, "curve",
     "A curve of one degree less that keeps the ends and stays within the tolerance (mm) at each "
     "parameter; where that cannot be, the error (tolerance-exceeded) tells by how much points "
     "would move. `deviation` measures what was changed.",
     "c = bezier([[0, 0], [1, 2], [2, 0]])\n"
     "print near(points(reduce_degree(elevate(c), 1e-9)), points(c)) // expect: true",
     CURVES, forms},
    {"insert_knot(C: curve, t: number or angle, times: integer = 1)", cag_bsplines_insert_knot,
     "curve",
     "The same curve with a knot more at t, so often. A knot may occur as often as the degree: "
     "else "
     "an error (knot-multiplicity). A closed curve becomes an open one.",
     "c = insert_knot(bspline([[0, 0], [1, 1], [2, 1], [3, 0]], degree: 2), 1)\n"
     "print points(c) // expect: [[0, 0], [1, 1], [1.5, 1], [2, 1], [3, 0]]",
     CURVES, forms},
    {"remove_knot(C: curve, t: number or angle, tolerance: length = none, "
     "times: integer = 1)",
     cag_bsplines_remove_knot, "curve",
     "The curve without the inner knot t, taken away so often, where that moves no point by more "
     "than the tolerance (mm; none: 1e-9 of the size; inf: by any distance); else the error "
     "(tolerance-exceeded) tells how much it would.",
     "c = bspline([[0, 0], [1, 1], [2, 1], [3, 0]], degree: 2)\n"
     "print near(points(remove_knot(insert_knot(c, 0.25), 0.25)), points(c)) // expect: true",
     CURVES, forms},
    {"refine(C: curve, knots: list of numbers or \"midpoints\" = \"midpoints\")",
     cag_bsplines_refine, "curve",
     "The same curve with all these knots inserted, or one in the middle of each span. With "
     "midpoints uniform knots stay uniform, and a closed curve stays closed, with twice as many "
     "points.",
     "c = bspline([[0, 0], [4, 0], [4, 4], [0, 4]], degree: 2, closed: true)\n"
     "print points(refine(c))[0] // expect: [1, 0]",
     CURVES, forms},
    {"clamp_ends(C: curve)", cag_bsplines_clamp_ends, "curve",
     "The same curve with its end knots repeated, so that it starts in its first and ends in its "
     "last control point.",
     "c = bspline([[0, 0], [3, 9], [6, 3], [9, 6]], degree: 2, knots: \"periodic\")\n"
     "print knots(clamp_ends(c)) // expect: [2, 2, 2, 3, 4, 4, 4]",
     CURVES, forms},

    // --- Near and across ---
    {"deviation(C: curve, D: curve)", cag_bsplines_deviation, "number",
     "The largest distance (mm) of points of equal parameters, where D is run over the domain of "
     "C.",
     "print deviation(line([0, 0], [2, 0]), line([0, 1], [2, 3])) // expect: 3", CURVES, near},
    {"approximate(C: curve, tolerance: length)", cag_bsplines_approximate, "curve",
     "A B-spline whose points are within the tolerance (mm) of the curve's: the exact one where "
     "there is one, else a cubic that is continuously differentiable where the curve is.",
     "h = helix(10, 5, 2)\n"
     "print deviation(approximate(h, 0.001), h) < 0.001 // expect: true",
     CURVES, near},
    {"offset(C: curve, d: length, tolerance: length = none)", cag_bsplines_offset, "curve",
     "The curve at the distance d (mm) to the left of a plane curve, to the right where d is "
     "negative. Lines, polylines and circles have it exactly, others within the tolerance (none: "
     "1e-6 of the size). At corners it goes round the outside in an arc, of polylines to the "
     "corner of the two sides; the inside is cut where its parts meet (offset-corner where they do "
     "not). Where d is more than the radius of curvature the curve turns back and crosses itself; "
     "a "
     "circle of which nothing is left is an error (offset-collapses).",
     "print near(length(offset(circle(5), 1)), 8 * pi) // expect: true\n"
     "print points(offset(polyline([[0, 0], [4, 0], [4, 4]]), 1)) // expect: [[0, 1], [3, 1], [3, "
     "4]]",
     CURVES, near},
    {"intersect(C: curve, A: curve or surface or plane)", cag_bsplines_intersect, "list",
     "All places where the curve meets another curve, a surface or a plane, crossings and touches, "
     "in the order of t: records of point, t, t2 of the other curve or u and v of the surface, and "
     "multiplicity: 1 where they cross, the order of contact where they touch (2 as a rule). "
     "Points within 1e-9 of the size are one. Where they share more than single points it is an "
     "error (overlap).",
     "m = intersect(circle(5), line([-10, 3], [10, 3]))\n"
     "print len(m), near(m[0].point, [4, 3]), near(m[0].t2, 0.7) // expect: 2 true true\n"
     "print intersect(circle(2), circle(1.9, center: [0.1, 0]))[0].multiplicity // expect: 2\n"
     "print len(intersect(helix(10, 5, 3), plane([0, 0, 4], Z))) // expect: 1\n"
     "s = intersect(line([-9, 0, 0], [9, 0, 0]), sphere_surface(3))\n"
     "print len(s), near(s[0].point, [-3, 0, 0]) // expect: 2 true",
     CURVES, near},

    // --- Pictures ---
    {"control_net(C: curve)", cag_bsplines_control_net, "curve",
     "The control polygon of a Bezier or B-spline curve, to show.",
     "print length(control_net(bezier([[0, 0], [3, 4], [6, 0]]))) // expect: 10", CURVES, shown},
    {"curvature_comb(C: curve, n: integer = none, scale: number = none)",
     cag_bsplines_curvature_comb, "group",
     "The curvature comb of a curve: n lines that point away from the center of curvature. Their "
     "length is the curvature times `scale` (mm2). A further line connects their tips. By default, "
     "the longest line is a quarter of the size of the curve.",
     "show curvature_comb(bezier([[0, 0], [1, 2], [3, 2], [4, 0]]), 30)", CURVES, shown},
    {"hedgehog(C: curve, n: integer = none, scale: number = none)", cag_bsplines_curvature_comb,
     "group", "Deprecated: use `curvature_comb`.",
     "print len(hedgehog(circle(10), 4).items) // expect: 5", CURVES, shown},
    {0}};
