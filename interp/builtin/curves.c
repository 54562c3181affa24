// The table of curves and regions.

#include "interp/builtin/curves.h"

#define CURVES CAG_TAKES(CURVE)
#define LISTS CAG_TAKES_LISTS
#define NUMBERS CAG_TAKES(NUMBER)

static const char asked[] = "Curves: queries";
static const char changed[] = "Curves: editing";
static const char made[] = "Curves: construction";
static const char splines[] = "Curves: Bezier and B-splines";
static const char regions[] = "Regions";

const CagBuiltin cag_builtins_curves[] = {
    // --- At one parameter ---
    {"at(C: curve, t: number or angle, unit: bool = false)", cag_curves_at, "list",
     "The point of the curve at t, as C(t) does. t is the natural parameter, an angle of circles, "
     "arcs, ellipses and helices; with `unit: true` it goes from 0 to 1. A t outside of the domain "
     "is an error (parameter-range).",
     "print at(line([0, 0], [4, 2]), 0.5), at(circle(2), 0.25, unit: true) // expect: [2, 1] [0, "
     "2]",
     CURVES, asked},
    {"derivative(C: curve, t: number or angle, order: integer = 1, "
     "side: \"right\" or \"left\" = \"right\")",
     cag_curves_derivative, "list",
     "The derivative of this order by t (by an angle: per radian); at a knot or corner the one to "
     "its right, or with `side: \"left\"` the one to its left.",
     "print derivative(bezier([[0, 0], [1, 2], [2, 0]]), 0) // expect: [2, 4]", CURVES, asked},
    {"tangent(C: curve, t: number or angle, side: \"right\" or \"left\" = \"right\")",
     cag_curves_tangent, "list",
     "The unit tangent, at a corner the one to its right or `side: \"left\"`; where the derivative "
     "vanishes, its limit if there is one.",
     "print near(tangent(line([0, 0], [3, 4]), 0.2), [0.6, 0.8]) // expect: true", CURVES, asked},
    {"normal(C: curve, t: number or angle)", cag_curves_normal, "list",
     "The unit normal, towards the center of curvature. Where the curvature is 0 there is none: an "
     "error.",
     "print near(normal(circle(2), 0deg), [-1, 0]) // expect: true", CURVES, asked},
    {"binormal(C: curve, t: number or angle)", cag_curves_binormal, "list",
     "The unit binormal, tangent x normal, in space. Where the curvature is 0 there is none: an "
     "error.",
     "print near(binormal(circle(2), 0deg), Z) // expect: true", CURVES, asked},
    {"curvature(C: curve, t: number or angle)", cag_curves_curvature, "number",
     "The curvature, at least 0, in 1/mm: one over the radius of the circle that fits best.",
     "print near(curvature(circle(4), 10deg), 0.25) // expect: true", CURVES, asked},
    {"torsion(C: curve, t: number or angle)", cag_curves_torsion, "number",
     "The torsion in 1/mm, positive of a right-handed screw. Where the curvature is 0 there is "
     "none: "
     "an error.",
     "print near(torsion(helix(1, tau, 1), 0deg), 0.5) // expect: true", CURVES, asked},
    {"frenet(C: curve, t: number or angle)", cag_curves_frenet, "record",
     "All of it: point, tangent, normal, binormal, curvature, torsion, and the planes "
     "osculating_plane, normal_plane and rectifying_plane. Where the curvature is 0, what does not "
     "exist is none.",
     "print near(frenet(circle(2), 90deg).curvature, 0.5) // expect: true", CURVES, asked},
    {"domain(C: curve)", cag_curves_domain, "range", "The range of the parameter.",
     "print domain(circle(2)) // expect: 0deg..360deg", CURVES, asked},
    {"start(C: curve)", cag_curves_start, "number or angle", "The first parameter.",
     "print start(line([0, 0], [1, 0])) // expect: 0", CURVES, asked},
    {"end(C: curve)", cag_curves_end, "number or angle", "The last parameter.",
     "print end(circle(1)) // expect: 360deg", CURVES, asked},
    {"start_point(C: curve)", cag_curves_start_point, "list", "The first point.",
     "print start_point(line([1, 2], [3, 4])) // expect: [1, 2]", CURVES, asked},
    {"end_point(C: curve)", cag_curves_end_point, "list", "The last point.",
     "print end_point(line([1, 2], [3, 4])) // expect: [3, 4]", CURVES, asked},
    {"degree(C: curve)", cag_curves_degree, "number",
     "The degree of a Bezier or B-spline curve or a polyline; others have none: an error "
     "(no-control-points).",
     "print degree(bezier([[0, 0], [1, 1], [2, 0]])) // expect: 2", CURVES, asked},
    {"points(C: curve)", cag_curves_points, "list",
     "The control points of a Bezier or B-spline curve, the corners of a polyline; of a closed one "
     "as they were given. A point whose weight is 0 acts on nothing and is none. Other kinds have "
     "none: an error (no-control-points).",
     "print points(polyline([[0, 0], [1, 1]])) // expect: [[0, 0], [1, 1]]", CURVES, asked},
    {"weights(C: curve)", cag_curves_weights, "list",
     "The weights of the control points, 1 each where none were given.",
     "print weights(bezier([[0, 0], [1, 1]])) // expect: [1, 1]", CURVES, asked},
    {"knots(C: curve)", cag_curves_knots, "list", "The knots of a Bezier or B-spline curve.",
     "print knots(bezier([[0, 0], [1, 1], [2, 0]])) // expect: [0, 0, 0, 1, 1, 1]", CURVES, asked},
    {"is_closed(C: curve)", cag_curves_is_closed, "bool", "Whether the ends meet.",
     "print is_closed(circle(1)) // expect: true", CURVES, asked},
    {"is_planar(C: curve)", cag_curves_is_planar, "bool",
     "Whether the curve lies in a plane, to 1e-9 of its size.",
     "print is_planar(circle(1)), is_planar(helix(1, 1, 1)) // expect: true false", CURVES, asked},
    {"is_straight(C: curve)", cag_curves_is_straight, "bool", "Whether the curve lies on a line.",
     "print is_straight(line([0, 0], [1, 2])) // expect: true", CURVES, asked},

    // --- Of the whole ---
    {"length(C: curve, over: range = domain(C))", cag_curves_length, "number",
     "The length (mm) of the curve or of a range of it, to 1e-10; of a region that of its "
     "boundary.",
     "print length(line([0, 0], [3, 4])) // expect: 5\n"
     "print near(length(circle(1), over: 0deg..90deg), pi / 2) // expect: true",
     CURVES | CAG_TAKES(REGION), asked},
    {"parameter_at_length(C: curve, s: length)", cag_curves_parameter_at_length, "number or angle",
     "The parameter at the length s (mm) from the start; s beyond the curve's length is an error.",
     "print near(parameter_at_length(circle(1), pi), 180deg) // expect: true", CURVES, asked},
    {"sample(C: curve, n: integer)", cag_curves_sample, "list",
     "n points (2 at least) in equal steps of the parameter, both ends in.",
     "print sample(line([0, 0], [2, 4]), 3) // expect: [[0, 0], [1, 2], [2, 4]]", CURVES, asked},
    {"divide(C: curve, n: integer, by: \"length\" or \"chord\" or \"parameter\" = \"length\")",
     cag_curves_divide, "list",
     "The n + 1 parameters of n parts of equal length, of equal chords (`by: \"chord\"`) or of "
     "equal "
     "steps (`by: \"parameter\"`).",
     "print divide(line([0, 0], [5, 0]), 2, by: \"parameter\") // expect: [0, 0.5, 1]", CURVES,
     asked},
    {"closest(C: curve, P: point)", cag_curves_closest, "record",
     "The point of the curve nearest to P: t, point and distance (mm).",
     "print near(closest(circle(2), [5, 0]).distance, 3) // expect: true", CURVES, asked},
    {"bounds(G: shape or group)", cag_curves_bounds, "record",
     "The box around a shape or a list of shapes: min, max, size and center, tight to 1e-9.",
     "print bounds(line([1, 2], [4, 6])).size // expect: [3, 4]",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), asked},
    {"area(C: curve or region)", cag_curves_area, "number",
     "The area (mm2) of a region or within a closed plane curve, to 1e-10. An open curve is an "
     "error.",
     "print near(area(circle(2)), 4 * pi, relative: 1e-12), area(rectangle(2, 3)) // expect: true "
     "6",
     CURVES | CAG_TAKES(REGION), asked},
    {"centroid(C: curve or region)", cag_curves_centroid, "list",
     "The center of area of a region or of a closed plane curve.",
     "print near(centroid(circle(2, center: [3, 4])), [3, 4]) // expect: true",
     CURVES | CAG_TAKES(REGION), asked},

    // --- Another curve ---
    {"reverse(C: curve)", cag_curves_reverse, "curve",
     "The curve run backwards over the same domain.",
     "print start_point(reverse(line([0, 0], [1, 2]))) // expect: [1, 2]", CURVES, changed},
    {"trim(C: curve, range: range of numbers or angles)", cag_curves_trim, "curve",
     "The part over a range of the parameter. On a closed curve the range may run over the seam, "
     "up to one whole turn.",
     "print near(length(trim(circle(1), 0deg..180deg)), pi) // expect: true\n"
     "print start_point(trim(circle(1), 270deg..450deg)) // expect: [0, -1]",
     CURVES, changed},
    {"reparametrize(C: curve, range: range of numbers or angles)", cag_curves_reparametrize,
     "curve", "The same points over another range of the parameter, of numbers or of angles.",
     "print domain(reparametrize(line([0, 0], [1, 0]), 0..5)) // expect: 0..5\n"
     "print reparametrize(circle(2), 0..1)(0.25) // expect: [0, 2]",
     CURVES, changed},
    {"split(C: curve, t: text or number or angle)", cag_curves_split, "list",
     "The two parts before and after t. At an end of the curve one of them is a point: its domain "
     "is t..t, its length 0, and it has no tangent.",
     "print [for c in split(line([0, 0], [4, 0]), 0.25): length(c)] // expect: [1, 3]\n"
     "print split(line([0, 0], [4, 0]), 1)[1] // expect: point, [4, 0], t in 1..1",
     CURVES, changed},
    {"join_curves(C: curve, ...)", cag_curves_join_curves, "curve",
     "The curves, or one list of them, one after the other. Each must start where the one before "
     "ends: else an error that tells the gap.",
     "c = join_curves(line([0, 0], [3, 0]), line([3, 0], [3, 4]))\n"
     "print length(c) // expect: 7",
     CURVES | CAG_TAKES(LIST), changed},
    {"to_nurbs(C: curve)", cag_curves_to_nurbs, "curve",
     "The exact rational B-spline of the curve. A helix has none: an error (no-exact-form).",
     "print degree(to_nurbs(circle(1))) // expect: 2", CURVES, changed},
    {"polygonize(C: curve, tolerance: length)", cag_curves_polygonize, "curve",
     "A polyline whose distance (mm) from the curve is at most the tolerance.",
     "print abs(length(polygonize(circle(1), 0.001)) - tau) < 0.01 // expect: true", CURVES,
     changed},

    // --- Constructors ---
    {"line(P: point, Q: point)", cag_curves_line, "curve", "The line from P (t = 0) to Q (t = 1).",
     "print line([0, 0], [2, 4])(0.5) // expect: [1, 2]", LISTS, made},
    {"polyline(points: list of points, closed: bool = false)", cag_curves_polyline, "curve",
     "Straight from point to point; corner i is at t = i.",
     "print length(polyline([[0, 0], [3, 0], [3, 4]], closed: true)) // expect: 12", LISTS, made},
    {"circle(radius: length, center: point = [0, 0], normal: vector = none)", cag_curves_circle,
     "curve",
     "The circle, by the angle 0deg..360deg. With a normal, or a center in space, a circle of "
     "space, right-handed about the normal.",
     "print circle(2)(90deg) // expect: [0, 2]", NUMBERS, made},
    {"arc(radius: length, range: range of angles, center: point = [0, 0], "
     "normal: vector = none)",
     cag_curves_arc, "curve",
     "The part of a circle over a range of angles. A range from the larger angle to the smaller "
     "one "
     "runs clockwise: `arc(r, b..a)` is `reverse(arc(r, a..b))`, with the domain a..b.",
     "print start_point(arc(2, 90deg..180deg)) // expect: [0, 2]\n"
     "print end_point(arc(2, 180deg..90deg)) // expect: [0, 2]",
     NUMBERS, made},
    {"ellipse(a: length, b: length, range: range of angles = 0deg..360deg, "
     "center: point = [0, 0], normal: vector = none)",
     cag_curves_ellipse, "curve",
     "The ellipse [a cos t, b sin t] about the center, t an angle (not that of the ray to the "
     "point). A range from the larger angle to the smaller one runs clockwise, as of `arc`.",
     "print ellipse(3, 2)(90deg) // expect: [0, 2]", NUMBERS, made},
    {"arc_through(P: point, Q: point, R: point)", cag_curves_arc_through, "curve",
     "The arc from P through Q to R, by the angle turned. Points on one line are an error "
     "(collinear).",
     "print near(length(arc_through([1, 0], [0, 1], [-1, 0])), pi) // expect: true", LISTS, made},
    {"circle_through(P: point, Q: point, R: point)", cag_curves_circle_through, "curve",
     "The circle through three points. Points on one line are an error (collinear).",
     "print near(bounds(circle_through([2, 0], [0, 2], [-2, 0])).center, [0, 0]) // expect: true",
     LISTS, made},
    {"helix(radius: length, pitch: length, turns: number, taper: length = 0)", cag_curves_helix,
     "curve",
     "The helix from [radius, 0, 0] up along Z, by the angle turned: each turn rises by the pitch "
     "and adds the taper to the radius (mm). Negative turns are left-handed.",
     "print near(end_point(helix(10, 5, 3)), [10, 0, 15]) // expect: true", NUMBERS, made},
    {"bezier(points: list of points, weights: list of numbers = none)", cag_curves_bezier, "curve",
     "The Bezier curve of these control points over 0..1, rational with weights (positive, one for "
     "each point). A single control point gives a curve of degree 0, which stays in that point.",
     "print bezier([[0, 0], [1, 2], [2, 0]])(0.5) // expect: [1, 1]", LISTS, splines},
    {"bspline(points: list of points, degree: integer >= 1 = 3, "
     "knots: \"open\" or \"periodic\" or \"chord\" or list of numbers = \"open\", "
     "closed: bool = false, weights: list of numbers = none, order: integer = none)",
     cag_curves_bspline, "curve",
     "The B-spline of these control points. `knots` is \"open\" (through both ends), \"periodic\" "
     "(uniform), \"chord\" (by the points' distances) or a list of points + degree + 1 numbers "
     "that "
     "do not decrease; a closed one has uniform knots, joins smoothly, and takes a last point that "
     "repeats the first once. `order` is degree + 1.",
     "c = bspline([[0, 0], [1, 2], [3, 2], [4, 0]], degree: 2)\n"
     "print domain(c), c(0) // expect: 0..2 [0, 0]",
     LISTS, splines},
    {"nurbs(points: list of points, degree: integer >= 1 = 3, "
     "knots: \"open\" or \"periodic\" or \"chord\" or list of numbers = \"open\", "
     "closed: bool = false, weights: list of numbers = none, order: integer = none)",
     cag_curves_nurbs, "curve", "As bspline, with weights (positive, one for each point) required.",
     "q = nurbs([[1, 0], [1, 1], [0, 1]], degree: 2, weights: [1, sqrt(0.5), 1])\n"
     "print near(norm(q(0.3)), 1) // expect: true",
     LISTS, splines},
    {"knot_vector(count: integer or list of points, degree: integer >= 1 = 3, "
     "kind: \"open\" or \"periodic\" or \"chord\" = \"open\", order: integer = none, "
     "over: range = none)",
     cag_curves_knot_vector, "list",
     "The knots of so many control points: \"open\", \"periodic\", or, of the list of the points, "
     "by their chords; in whole steps from 0, or with the usable range `over`.",
     "print knot_vector(4, 2) // expect: [0, 0, 0, 1, 2, 2, 2]", NUMBERS, splines},
    {"bernstein(n: integer, t: number or angle)", cag_curves_bernstein, "list",
     "The values at t of the n + 1 Bernstein polynomials of degree n.",
     "print bernstein(2, 0.5) // expect: [0.25, 0.5, 0.25]", NUMBERS, splines},

    // --- Regions ---
    {"region(outline: closed curve or list of points or list of closed curves, "
     "holes: list of closed curves = [])",
     cag_curves_region, "region",
     "The piece of the plane within a closed plane curve or a list of points, less its holes, "
     "likewise given. A list of closed curves that do not cross bounds what an odd number of them "
     "surrounds. Boundaries in space must lie in one plane, and the region stays there: "
     "region(section(G, plane)) is the cut face. region([]) is the empty region, which is the cut "
     "face if the plane misses G. Open or crossing outlines and holes outside are errors "
     "(region-not-closed, region-crossing, hole-outside).",
     "print near(area(region(circle(2), holes: [circle(1)])), 3 * pi) // expect: true\n"
     "print near(area(region(section(box(4), plane([2, 2, 2], [1, 0, 1])))), 16 * sqrt(2)) // "
     "expect: true",
     CURVES | CAG_TAKES(LIST), regions},
    {"polygon(points: list of points, holes: list of closed curves = [])", cag_curves_polygon,
     "region", "The region within these points, less its holes.",
     "print area(polygon([[0, 0], [4, 0], [0, 3]])) // expect: 6", LISTS, regions},
    {"rectangle(w: length, h: length, radius: length = 0)", cag_curves_rectangle, "region",
     "The rectangle of this width and height about the origin, its corners rounded by the radius "
     "(at most half of the shorter side).",
     "print area(rectangle(4, 3)) // expect: 12", NUMBERS, regions},
    {"regular_polygon(n: integer >= 3, radius: length)", cag_curves_regular_polygon, "region",
     "The polygon of n equal sides about the origin with its corners at the radius, the first on "
     "+x.",
     "print near(area(regular_polygon(4, 1)), 2) // expect: true", NUMBERS, regions},
    {"boundary(R: region)", cag_curves_boundary, "list",
     "The curves around a region: outlines counter-clockwise, holes clockwise.",
     "print len(boundary(region(circle(2), holes: [circle(1)]))) // expect: 2", CAG_TAKES(REGION),
     regions},
    {0}};
