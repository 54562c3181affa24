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
     "Returns the point of the curve at t, like C(t). t is the natural parameter: an angle for "
     "circles, arcs, ellipses, and helices. With `unit: true`, the domain is normalized to 0..1. "
     "It is an error if t is outside of the domain (parameter-range).",
     "print at(line([0, 0], [4, 2]), 0.5), at(circle(2), 0.25, unit: true) // expect: [2, 1] [0, "
     "2]",
     CURVES, asked},
    {"derivative(C: curve, t: number or angle, order: integer = 1, "
     "side: \"right\" or \"left\" = \"right\")",
     cag_curves_derivative, "list",
     "Returns a derivative of the curve with respect to t. If t is an angle, the derivative is "
     "per radian. At a knot or corner, it is the derivative to the right, or to the left with "
     "`side: \"left\"`.",
     "print derivative(bezier([[0, 0], [1, 2], [2, 0]]), 0) // expect: [2, 4]", CURVES, asked},
    {"tangent(C: curve, t: number or angle, side: \"right\" or \"left\" = \"right\")",
     cag_curves_tangent, "list",
     "Returns the unit tangent. At a corner, it is the tangent to the right, or to the left with "
     "`side: \"left\"`. Where the derivative vanishes, it is the limit of the tangent, if there is "
     "one.",
     "print near(tangent(line([0, 0], [3, 4]), 0.2), [0.6, 0.8]) // expect: true", CURVES, asked},
    {"normal(C: curve, t: number or angle)", cag_curves_normal, "list",
     "Returns the unit normal, which points to the center of curvature. It is an error if the "
     "curvature is 0.",
     "print near(normal(circle(2), 0deg), [-1, 0]) // expect: true", CURVES, asked},
    {"binormal(C: curve, t: number or angle)", cag_curves_binormal, "list",
     "Returns the unit binormal of a space curve, tangent x normal. It is an error if the "
     "curvature is 0.",
     "print near(binormal(circle(2), 0deg), Z) // expect: true", CURVES, asked},
    {"curvature(C: curve, t: number or angle)", cag_curves_curvature, "number",
     "Returns the curvature (1/mm), the reciprocal of the radius of the osculating circle. It is "
     "never negative.",
     "print near(curvature(circle(4), 10deg), 0.25) // expect: true", CURVES, asked},
    {"torsion(C: curve, t: number or angle)", cag_curves_torsion, "number",
     "Returns the torsion (1/mm), which is positive for a right-handed helix. It is an error if "
     "the curvature is 0.",
     "print near(torsion(helix(1, tau, 1), 0deg), 0.5) // expect: true", CURVES, asked},
    {"frenet(C: curve, t: number or angle)", cag_curves_frenet, "record",
     "Returns a record of the point, tangent, normal, binormal, curvature, torsion, "
     "osculating_plane, normal_plane, and rectifying_plane. If the curvature is 0, the fields "
     "that are undefined are none.",
     "print near(frenet(circle(2), 90deg).curvature, 0.5) // expect: true", CURVES, asked},
    {"domain(C: curve)", cag_curves_domain, "range",
     "Returns the domain of the parameter as a range.",
     "print domain(circle(2)) // expect: 0deg..360deg", CURVES, asked},
    {"start(C: curve)", cag_curves_start, "number or angle",
     "Returns the first parameter of the domain.", "print start(line([0, 0], [1, 0])) // expect: 0",
     CURVES, asked},
    {"end(C: curve)", cag_curves_end, "number or angle",
     "Returns the last parameter of the domain.", "print end(circle(1)) // expect: 360deg", CURVES,
     asked},
    {"start_point(C: curve)", cag_curves_start_point, "list", "Returns the first point.",
     "print start_point(line([1, 2], [3, 4])) // expect: [1, 2]", CURVES, asked},
    {"end_point(C: curve)", cag_curves_end_point, "list", "Returns the last point.",
     "print end_point(line([1, 2], [3, 4])) // expect: [3, 4]", CURVES, asked},
    {"degree(C: curve)", cag_curves_degree, "number",
     "Returns the degree of a Bezier curve, B-spline curve, or polyline. Other curves have no "
     "degree, which is an error (no-control-points).",
     "print degree(bezier([[0, 0], [1, 1], [2, 0]])) // expect: 2", CURVES, asked},
    {"points(C: curve)", cag_curves_points, "list",
     "Returns the control points of a Bezier or B-spline curve, or the vertices of a polyline. "
     "For a closed curve, they are as given. A point of weight 0 has no effect and is none. "
     "Other curves have no control points, which is an error (no-control-points).",
     "print points(polyline([[0, 0], [1, 1]])) // expect: [[0, 0], [1, 1]]", CURVES, asked},
    {"weights(C: curve)", cag_curves_weights, "list",
     "Returns the weights of the control points; they are 1 if none were given.",
     "print weights(bezier([[0, 0], [1, 1]])) // expect: [1, 1]", CURVES, asked},
    {"knots(C: curve)", cag_curves_knots, "list",
     "Returns the knots of a Bezier or B-spline curve.",
     "print knots(bezier([[0, 0], [1, 1], [2, 0]])) // expect: [0, 0, 0, 1, 1, 1]", CURVES, asked},
    {"is_closed(C: curve)", cag_curves_is_closed, "bool",
     "Tests whether the curve ends where it starts.", "print is_closed(circle(1)) // expect: true",
     CURVES, asked},
    {"is_planar(C: curve)", cag_curves_is_planar, "bool",
     "Tests whether the curve lies in a plane, to within 1e-9 of its size.",
     "print is_planar(circle(1)), is_planar(helix(1, 1, 1)) // expect: true false", CURVES, asked},
    {"is_straight(C: curve)", cag_curves_is_straight, "bool",
     "Tests whether the curve lies on a line.",
     "print is_straight(line([0, 0], [1, 2])) // expect: true", CURVES, asked},

    // --- Of the whole ---
    {"length(C: curve, over: range = domain(C))", cag_curves_length, "number",
     "Returns the length (mm) of a curve or of a part of it, to 1e-10; or the perimeter of a "
     "region.",
     "print length(line([0, 0], [3, 4])) // expect: 5\n"
     "print near(length(circle(1), over: 0deg..90deg), pi / 2) // expect: true",
     CURVES | CAG_TAKES(REGION), asked},
    {"parameter_at_length(C: curve, s: length)", cag_curves_parameter_at_length, "number or angle",
     "Returns the parameter at arc length s (mm) from the start. It is an error if s exceeds the "
     "length of the curve.",
     "print near(parameter_at_length(circle(1), pi), 180deg) // expect: true", CURVES, asked},
    {"sample(C: curve, n: integer in 2..100000000)", cag_curves_sample, "list",
     "Returns n points (at least 2) at equal steps of the parameter, including both ends.",
     "print sample(line([0, 0], [2, 4]), 3) // expect: [[0, 0], [1, 2], [2, 4]]", CURVES, asked},
    {"divide(C: curve, n: integer, by: \"length\" or \"chord\" or \"parameter\" = \"length\")",
     cag_curves_divide, "list",
     "Returns the n + 1 parameters that divide the curve into n parts of equal length, of equal "
     "chords (`by: \"chord\"`), or of equal steps of the parameter (`by: \"parameter\"`).",
     "print divide(line([0, 0], [5, 0]), 2, by: \"parameter\") // expect: [0, 0.5, 1]", CURVES,
     asked},
    {"closest(C: curve, P: point)", cag_curves_closest, "record",
     "Returns the point of the curve nearest to P, with the fields t, point, and distance (mm).",
     "print near(closest(circle(2), [5, 0]).distance, 3) // expect: true", CURVES, asked},
    {"bounds(G: shape or group)", cag_curves_bounds, "record",
     "Returns the bounding box of a shape or a list of shapes, with the fields min, max, size, "
     "and center. It is tight to 1e-9.",
     "print bounds(line([1, 2], [4, 6])).size // expect: [3, 4]",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), asked},
    {"area(C: curve or region)", cag_curves_area, "number",
     "Returns the area (mm2) of a region, or of the interior of a closed plane curve, to 1e-10. "
     "An open curve is an error.",
     "print near(area(circle(2)), 4 * pi, relative: 1e-12), area(rectangle(2, 3)) // expect: true "
     "6",
     CURVES | CAG_TAKES(REGION), asked},
    {"centroid(C: curve or region)", cag_curves_centroid, "list",
     "Returns the centroid of a region or closed plane curve.",
     "print near(centroid(circle(2, center: [3, 4])), [3, 4]) // expect: true",
     CURVES | CAG_TAKES(REGION), asked},

    // --- Another curve ---
    {"reverse(C: curve)", cag_curves_reverse, "curve",
     "Returns the curve in the opposite direction, with the same domain.",
     "print start_point(reverse(line([0, 0], [1, 2]))) // expect: [1, 2]", CURVES, changed},
    {"trim(C: curve, range: range of numbers or angles)", cag_curves_trim, "curve",
     "Returns the part of the curve over a range of the parameter. On a closed curve, the range "
     "may cross the seam, up to one full turn.",
     "print near(length(trim(circle(1), 0deg..180deg)), pi) // expect: true\n"
     "print start_point(trim(circle(1), 270deg..450deg)) // expect: [0, -1]",
     CURVES, changed},
    {"reparametrize(C: curve, range: range of numbers or angles)", cag_curves_reparametrize,
     "curve", "Returns the same curve with another domain, a range of numbers or angles.",
     "print domain(reparametrize(line([0, 0], [1, 0]), 0..5)) // expect: 0..5\n"
     "print reparametrize(circle(2), 0..1)(0.25) // expect: [0, 2]",
     CURVES, changed},
    {"split(C: curve, t: text or number or angle)", cag_curves_split, "list",
     "Splits the curve at t and returns both parts. If t is an end of the curve, one part is a "
     "point: its domain is t..t, its length is 0, and it has no tangent.",
     "print [for c in split(line([0, 0], [4, 0]), 0.25): length(c)] // expect: [1, 3]\n"
     "print split(line([0, 0], [4, 0]), 1)[1] // expect: point, [4, 0], t in 1..1",
     CURVES, changed},
    {"join_curves(C: curve, ...)", cag_curves_join_curves, "curve",
     "Joins curves, given one by one or as one list, end to end. Each must start where the "
     "previous one ends; otherwise, the error states the gap.",
     "c = join_curves(line([0, 0], [3, 0]), line([3, 0], [3, 4]))\n"
     "print length(c) // expect: 7",
     CURVES | CAG_TAKES(LIST), changed},
    {"to_nurbs(C: curve)", cag_curves_to_nurbs, "curve",
     "Returns the curve as an exact rational B-spline. A helix has no such form, which is an "
     "error (no-exact-form).",
     "print degree(to_nurbs(circle(1))) // expect: 2", CURVES, changed},
    {"polygonize(C: curve, tolerance: length > 0)", cag_curves_polygonize, "curve",
     "Approximates the curve by a polyline whose distance (mm) from the curve is at most the "
     "tolerance.",
     "print abs(length(polygonize(circle(1), 0.001)) - tau) < 0.01 // expect: true", CURVES,
     changed},

    // --- Constructors ---
    {"line(P: point, Q: point)", cag_curves_line, "curve",
     "Returns the line segment from P (t = 0) to Q (t = 1).",
     "print line([0, 0], [2, 4])(0.5) // expect: [1, 2]", LISTS, made},
    {"polyline(points: list of points, closed: bool = false)", cag_curves_polyline, "curve",
     "Returns straight segments that connect the points. Vertex i is at t = i.",
     "print length(polyline([[0, 0], [3, 0], [3, 4]], closed: true)) // expect: 12", LISTS, made},
    {"circle(radius: length, center: point = [0, 0], normal: vector = none)", cag_curves_circle,
     "curve",
     "Returns a circle, parametrized by the angle 0deg..360deg. With a normal, or a center in "
     "space, it is a circle in space that turns by the right-hand rule about the normal.",
     "print circle(2)(90deg) // expect: [0, 2]", NUMBERS, made},
    {"arc(radius: length, range: range of angles, center: point = [0, 0], "
     "normal: vector = none)",
     cag_curves_arc, "curve",
     "Returns the part of a circle over a range of angles. If the range decreases, the arc runs "
     "clockwise: `arc(r, b..a)` is `reverse(arc(r, a..b))` with the domain a..b.",
     "print start_point(arc(2, 90deg..180deg)) // expect: [0, 2]\n"
     "print end_point(arc(2, 180deg..90deg)) // expect: [0, 2]",
     NUMBERS, made},
    {"ellipse(a: length, b: length, range: range of angles = 0deg..360deg, "
     "center: point = [0, 0], normal: vector = none)",
     cag_curves_ellipse, "curve",
     "Returns the ellipse [a cos t, b sin t] about the center. t is the angle of the "
     "parametrization, not of the ray to the point. If the range decreases, the ellipse runs "
     "clockwise, like `arc`.",
     "print ellipse(3, 2)(90deg) // expect: [0, 2]", NUMBERS, made},
    {"arc_through(P: point, Q: point, R: point)", cag_curves_arc_through, "curve",
     "Returns the arc from P through Q to R, parametrized by its angle. Collinear points are an "
     "error (collinear).",
     "print near(length(arc_through([1, 0], [0, 1], [-1, 0])), pi) // expect: true", LISTS, made},
    {"circle_through(P: point, Q: point, R: point)", cag_curves_circle_through, "curve",
     "Returns the circle through three points. Collinear points are an error (collinear).",
     "print near(bounds(circle_through([2, 0], [0, 2], [-2, 0])).center, [0, 0]) // expect: true",
     LISTS, made},
    {"helix(radius: length, pitch: length, turns: finite number, taper: number = 0)",
     cag_curves_helix, "curve",
     "Returns the helix that starts at [radius, 0, 0] and rises along Z, parametrized by its "
     "angle. In each turn, it rises by the pitch, and its radius grows by the taper (mm). A "
     "negative number of turns makes it left-handed.",
     "print near(end_point(helix(10, 5, 3)), [10, 0, 15]) // expect: true", NUMBERS, made},
    {"bezier(points: list of points, weights: list of numbers = none)", cag_curves_bezier, "curve",
     "Returns the Bezier curve of these control points over 0..1. With weights (positive, one "
     "for each point), it is rational. A single control point gives a curve of degree 0, which "
     "is a point.",
     "print bezier([[0, 0], [1, 2], [2, 0]])(0.5) // expect: [1, 1]", LISTS, splines},
    {"bspline(points: list of points, degree: integer >= 1 = 3, "
     "knots: \"open\" or \"periodic\" or \"chord\" or list of numbers = \"open\", "
     "closed: bool = false, weights: list of numbers = none, order: integer = none)",
     cag_curves_bspline, "curve",
     "Returns the B-spline curve of these control points. `knots` is \"open\" (the curve passes "
     "through both ends), \"periodic\" (uniform), \"chord\" (by the distances of the points), or a "
     "nondecreasing list of points + degree + 1 numbers. A closed curve has uniform knots and is "
     "smooth at the seam; its last point may repeat the first. `order` is degree + 1.",
     "c = bspline([[0, 0], [1, 2], [3, 2], [4, 0]], degree: 2)\n"
     "print domain(c), c(0) // expect: 0..2 [0, 0]",
     LISTS, splines},
    {"nurbs(points: list of points, degree: integer >= 1 = 3, "
     "knots: \"open\" or \"periodic\" or \"chord\" or list of numbers = \"open\", "
     "closed: bool = false, weights: list of numbers = none, order: integer = none)",
     cag_curves_nurbs, "curve",
     "Returns the rational B-spline curve of these control points and weights (positive, one for "
     "each point). Otherwise like bspline.",
     "q = nurbs([[1, 0], [1, 1], [0, 1]], degree: 2, weights: [1, sqrt(0.5), 1])\n"
     "print near(norm(q(0.3)), 1) // expect: true",
     LISTS, splines},
    {"knot_vector(count: integer or list of points, degree: integer >= 1 = 3, "
     "kind: \"open\" or \"periodic\" or \"chord\" = \"open\", order: integer = none, "
     "over: range = none)",
     cag_curves_knot_vector, "list",
     "Returns the knots for a number of control points, \"open\" or \"periodic\", or for a list of "
     "points by their chords. The knots are integers from 0, or cover the usable range `over`.",
     "print knot_vector(4, 2) // expect: [0, 0, 0, 1, 2, 2, 2]", NUMBERS, splines},
    {"bernstein(n: integer, t: number or angle)", cag_curves_bernstein, "list",
     "Returns the values of the n + 1 Bernstein polynomials of degree n at t.",
     "print bernstein(2, 0.5) // expect: [0.25, 0.5, 0.25]", NUMBERS, splines},

    // --- Regions ---
    {"region(outline: closed curve or list of points or list of closed curves, "
     "holes: list of closed curves = [])",
     cag_curves_region, "region",
     "Returns the region inside a closed plane curve or a polygon, without its holes. A list of "
     "closed curves that do not cross bounds the points that an odd number of them encloses. "
     "Boundaries in space must lie in one plane, and the region stays there: region(section(G, "
     "plane)) is the cut face. region([]) is the empty region, which is the cut face if the "
     "plane misses G. Open or crossing outlines, and holes outside, are errors "
     "(region-not-closed, region-crossing, hole-outside).",
     "print near(area(region(circle(2), holes: [circle(1)])), 3 * pi) // expect: true\n"
     "print near(area(region(section(box(4), plane([2, 2, 2], [1, 0, 1])))), 16 * sqrt(2)) // "
     "expect: true",
     CURVES | CAG_TAKES(LIST), regions},
    {"polygon(points: list of points, holes: list of closed curves = [])", cag_curves_polygon,
     "region", "Returns the region inside a polygon, without its holes.",
     "print area(polygon([[0, 0], [4, 0], [0, 3]])) // expect: 6", LISTS, regions},
    {"rectangle(w: length > 0, h: length > 0, radius: number = 0)", cag_curves_rectangle, "region",
     "Returns a rectangle of this width and height, centered at the origin. Its corners are "
     "rounded by the radius, at most half of the shorter side.",
     "print area(rectangle(4, 3)) // expect: 12", NUMBERS, regions},
    {"regular_polygon(n: integer in 3..1000000, radius: length > 0)", cag_curves_regular_polygon,
     "region",
     "Returns the regular polygon with n sides, centered at the origin. Its vertices are at "
     "distance `radius`, the first one on the positive x axis.",
     "print near(area(regular_polygon(4, 1)), 2) // expect: true", NUMBERS, regions},
    {"boundary(R: region)", cag_curves_boundary, "list",
     "Returns the boundary curves of a region: outlines counter-clockwise, holes clockwise.",
     "print len(boundary(region(circle(2), holes: [circle(1)]))) // expect: 2", CAG_TAKES(REGION),
     regions},
    {0}};
