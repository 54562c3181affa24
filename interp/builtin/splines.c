// The table of curves through and near points: cubic splines, blends, fits, and what is asked of
// their segments.

#include "interp/builtin/splines.h"

#define CURVES CAG_TAKES(CURVE)
#define LISTS CAG_TAKES_LISTS
#define NUMBERS CAG_TAKES(NUMBER)
#define TEXTS CAG_TAKES(TEXT)

static const char through[] = "Curves: interpolation";
static const char data[] = "Curves: fitting";
static const char segments[] = "Curves: cubic segments and bases";

const CagBuiltin cag_builtins_splines[] = {
    // --- Through points ---
    {"hermite(points: list of points, tangents: list of vectors, "
     "parameters: \"chord\" or \"uniform\" or \"centripetal\" or list of numbers = \"uniform\", "
     "limit: number = none)",
     cag_splines_hermite, "curve",
     "Returns cubic segments through the points with these tangents, one for each point, with "
     "respect to the parameter. The parameter of the points is 0, 1, 2, ..., or as for "
     "cubic_spline. With `limit`, tangents longer than this many chords of a segment are "
     "shortened; 3 avoids loops unless a tangent points backward.",
     "c = hermite([[0, 0], [1, 1]], [[3, 0], [3, 0]])\n"
     "print c(0.5), derivative(c, 1) // expect: [0.5, 0.5] [3, 0]",
     LISTS, through},
    {"cubic_spline(points: list of points, ends: end conditions = relaxed(), "
     "parameters: \"chord\" or \"uniform\" or \"centripetal\" or list of numbers = \"chord\", "
     "tension: number or list of numbers = 0)",
     cag_splines_cubic_spline, "curve",
     "Returns the cubic spline through the points, whose second derivative is continuous. `ends` "
     "is relaxed(), clamped(V, V), cyclic(), anticyclic(), or ends(start, finish). The parameter "
     "increases by the distance between points (\"chord\"), its square root (\"centripetal\"), or 1 "
     "(\"uniform\"), or is a list: a number for each point, or the lengths between them. A tension "
     "nu (one, or one for each inner point) gives the nu-spline, whose second derivative jumps "
     "by nu times the first. Coincident consecutive points are an error (coincident-points).",
     "c = cubic_spline([[0, 0], [1, 1], [2, -1], [3, 0]], clamped([1, 1], [1, 1]), "
     "parameters: \"uniform\")\n"
     "print near(derivative(c, 1), [1, -0.8]) // expect: true",
     LISTS, through},
    {"clamped(start: vector, finish: vector, direction: bool = false)", cag_splines_clamped,
     "record",
     "End conditions of a cubic spline: the tangents at both ends, with respect to the "
     "parameter. With `direction: true`, only their directions apply, and the speed is that of "
     "the end segments.",
     "c = cubic_spline([[0, 0], [3, 4]], clamped([2, 0], [0, 2]))\n"
     "print domain(c), derivative(c, 0) // expect: 0..5 [2, 0]",
     LISTS, through},
    {"relaxed()", cag_splines_relaxed, "record",
     "End conditions of a cubic spline: the second derivative is 0 at both ends.",
     "c = cubic_spline([[0, 0], [1, 2], [3, 2]], relaxed())\n"
     "print norm(derivative(c, 0, 2)) < 1e-14 // expect: true",
     0, through},
    {"cyclic()", cag_splines_cyclic, "record",
     "End conditions of a cubic spline: the first and second derivatives are the same at both "
     "ends. If the last point equals the first, the curve closes smoothly.",
     "c = cubic_spline([[0, 0], [2, 0], [2, 2], [0, 2], [0, 0]], cyclic())\n"
     "print is_closed(c), near(derivative(c, 0), derivative(c, 8)) // expect: true true",
     0, through},
    {"anticyclic()", cag_splines_anticyclic, "record",
     "End conditions of a cubic spline: the first and second derivatives are opposite at both "
     "ends, as in the outline of a racket.",
     "c = cubic_spline([[0, 0], [2, 1], [3, 3], [1, 4], [0, 0]], anticyclic(), "
     "parameters: \"uniform\")\n"
     "print near(derivative(c, 0), -derivative(c, 4)) // expect: true",
     0, through},
    {"ends(start: vector = none, finish: vector = none, direction: bool = false)", cag_splines_ends,
     "record",
     "End conditions of a cubic spline that differ: a tangent for each end, or none for a "
     "relaxed end.",
     "c = cubic_spline([[0, 0], [1, 2]], ends([0, 4], none), parameters: \"uniform\")\n"
     "print derivative(c, 0), near(derivative(c, 1, 2), [0, 0]) // expect: [0, 4] true",
     0, through},
    {"parabolic_blend(points: list of points, "
     "alpha: number or list of numbers or \"chord\" = 0.5, "
     "ends: \"open\" or \"parabola\" = \"open\", closed: bool = false)",
     cag_splines_parabolic_blend, "curve",
     "Returns cubic segments that blend the parabolas through each three consecutive points. A "
     "parabola passes its middle point at alpha, between 0 and 1: one number, a list with one "
     "for each middle point, or \"chord\", by the chord lengths, which are then the parameter. The "
     "curve runs from the second point to the second last. `ends: \"parabola\"` adds arcs of the "
     "first and the last parabola.",
     "c = parabolic_blend([[0, 0], [1, 1], [2, -1], [3, 0]])\n"
     "print c(0), near(c(1 / 3), [4 / 3, 4 / 9]) // expect: [1, 1] true",
     LISTS, through},
    {"catmull_rom(points: list of points, alpha: number in 0..1 = 0.5, "
     "ends: \"open\" or \"parabola\" = \"open\", closed: bool = false)",
     cag_splines_catmull_rom, "curve",
     "Returns the Catmull-Rom spline, a parabolic blend whose parameter increases by the "
     "distance between points to the power alpha: 0 uniform, 0.5 centripetal, 1 chordal.",
     "c = catmull_rom([[0, 0], [1, 1], [2, -1], [3, 0]], alpha: 0)\n"
     "print domain(c), near(derivative(c, 0), [1, -0.5]) // expect: 0..1 true",
     LISTS, through},
    {"polynomial_curve(coefficients: list of points and vectors, length: number = 1)",
     cag_splines_polynomial_curve, "curve",
     "Returns the curve a + b t + c t^2 + ... with the vectors [a, b, c, ...] over 0..length.",
     "c = polynomial_curve([[0, 0], [1, 1], [0, 2]])\n"
     "print c(0.5), derivative(c, 1) // expect: [0.5, 1] [1, 5]",
     LISTS, through},

    // --- From data ---
    {"data_parameters(points: list of points, "
     "by: \"chord\" or \"uniform\" or \"centripetal\" = \"chord\")",
     cag_splines_data_parameters, "list",
     "Returns parameters for data points: the cumulative distances (\"chord\"), the cumulative "
     "square roots of the distances (\"centripetal\"), or 0, 1, 2, ... (\"uniform\").",
     "print data_parameters([[0, 0], [3, 4], [3, 6]]) // expect: [0, 5, 7]", LISTS, data},
    {"interpolate(points: list of points, degree: integer >= 1 = 3, "
     "parameters: \"chord\" or \"uniform\" or \"centripetal\" or list of numbers = \"chord\", "
     "tangents: list of vectors = none, "
     "knots: \"auto\" or \"open\" or \"averaged\" or list of numbers = \"auto\", "
     "order: integer = none)",
     cag_splines_interpolate, "curve",
     "Returns the B-spline curve of this degree through all points. Parameters by spacing run "
     "over 0..spans; given parameters are kept. `tangents` (with respect to the parameter) are "
     "two for the ends, or one for each point. Knots are \"open\" (uniform), \"averaged\" from the "
     "parameters, a list, or \"auto\": uniform if they suit the parameters, otherwise averaged. "
     "Data that do not determine a control point are an error (fit-singular).",
     "c = interpolate([[0, 0], [1.5, 2], [3, 2.5], [4.5, 2], [6, 0]], degree: 2)\n"
     "print near(c(1.5), [3, 2.5]), near(points(c)[2], [3, 2.874362872], 1e-9) // expect: true "
     "true",
     LISTS, data},
    {"fit(points: list of points, degree: integer >= 1 = 3, "
     "count: integer or list of 2 integers = degree + 1, "
     "parameters: \"chord\" or \"uniform\" or \"centripetal\" or list of numbers = \"chord\", "
     "fixed: \"ends\" or \"none\" or \"x\" or \"y\" or \"z\" = \"ends\", "
     "knots: \"auto\" or \"open\" or \"averaged\" or list of numbers = \"auto\", "
     "error: number = 1e-9, order: integer = none)",
     cag_splines_fit, "curve",
     "Returns the least-squares fit of a B-spline curve with this degree and number of control "
     "points. With `fixed: \"ends\"`, the curve passes through the first and the last point; "
     "\"none\" is a plain least-squares fit; with \"x\", \"y\", or \"z\", the ends are fixed, and the "
     "parameters move until the curve has the data's coordinate at each, to within `error`. "
     "Parameters and knots are as for interpolate.",
     "c = fit([[0, 0], [1.5, 2], [3, 2.5], [4.5, 2], [6, 0]], degree: 2, count: 4)\n"
     "print near(points(c)[1], [0.788487526, 2.413257869], 1e-8) // expect: true",
     LISTS, data},
    {"fit_report(points: list of points, degree: integer >= 1 = 3, "
     "count: integer or list of 2 integers = degree + 1, "
     "parameters: \"chord\" or \"uniform\" or \"centripetal\" or list of numbers = \"chord\", "
     "fixed: \"ends\" or \"none\" or \"x\" or \"y\" or \"z\" = \"ends\", "
     "knots: \"auto\" or \"open\" or \"averaged\" or list of numbers = \"auto\", "
     "error: number = 1e-9, order: integer = none)",
     cag_splines_fit_report, "record",
     "Returns a record about fit: curve, parameters, residuals (curve minus data), rms (their "
     "root mean square), largest, and the rounds needed to hold a coordinate. For rows of "
     "points, with a count for u and v, returns the record of fit_surface_report, which takes "
     "more arguments.",
     "r = fit_report([[0, 0], [1.5, 2], [3, 2.5], [4.5, 2], [6, 0]], degree: 2, count: 4, fixed: "
     "\"none\")\n"
     "print near(r.rms, 0.050231855, 1e-8) // expect: true",
     LISTS, data},

    // --- Segments and bases ---
    {"polynomials(C: curve)", cag_splines_polynomials, "list",
     "Returns the coefficients of each piece of a polynomial curve with respect to the parameter "
     "from the start of the piece, lowest power first. A rational curve is an error "
     "(not-polynomial).",
     "print polynomials(bezier([[0, 0], [1, 2], [2, 0]])) // expect: [[[0, 0], [2, 4], [0, -4]]]",
     CURVES, segments},
    {"basis_matrix(kind: \"bezier\" or \"bspline\" or \"hermite\" or \"catmull_rom\" or "
     "\"parabolic\", "
     "degree: integer >= 1 = 3, alpha: number in 0..1 = 0.5, beta: number in 0..1 = 0.5)",
     cag_splines_basis_matrix, "list",
     "Returns the matrix N of [t^n ... t 1] N G for one segment over 0..1 with points G: of a "
     "\"bezier\" or uniform \"bspline\" segment of this degree, a \"hermite\" segment (G = start, end, "
     "tangents), or a \"catmull_rom\" or \"parabolic\" blend (with alpha and beta) of four points.",
     "print basis_matrix(\"bezier\", 2) // expect: [[1, -2, 1], [-2, 2, 0], [1, 0, 0]]", TEXTS,
     segments},
    {"bezier_matrices(n: integer)", cag_splines_bezier_matrices, "record",
     "Returns the matrix N of a Bezier curve of degree n, and its factors C and the diagonal D: "
     "N = C D.",
     "m = bezier_matrices(2)\n"
     "print m.C, m.N == multiply(m.C, m.D) // expect: [[1, -1, 1], [-2, 1, 0], [1, 0, 0]] true",
     NUMBERS, segments},
    {"bernstein_maxima(n: integer)", cag_splines_bernstein_maxima, "record",
     "Returns where each Bernstein polynomial of degree n has its maximum (t = i / n), and the "
     "maximum.",
     "print bernstein_maxima(2) // expect: {t: [0, 0.5, 1], value: [1, 0.5, 1]}", NUMBERS,
     segments},
    {"hermite_basis(t: number or angle, length: number = 1)", cag_splines_hermite_basis, "list",
     "Returns the weights of the start, the end, and both tangents of a Hermite segment of this "
     "parameter length at the fraction t, 0..1.",
     "print hermite_basis(0.5) // expect: [0.5, 0.5, 0.125, -0.125]", NUMBERS, segments},
    {"hermite_shape(P: point, Q: point, V: vector, W: vector)", cag_splines_hermite_shape, "record",
     "Describes the plane segment from P to Q with tangents V and W over 0..1: the chord; the "
     "lengths of the tangents k0 and k1, as multiples of the chord ratio0 and ratio1, and their "
     "projections on the chord projection0 and projection1; within_limit (neither is longer than "
     "3 chords); and the parameters of inflections, of a cusp, and of the double point of a loop, "
     "each of which is none if the segment does not have it.",
     "s = hermite_shape([0, 0], [1, 0], [3, 3], [3, -3])\n"
     "print s.cusp, s.loop, s.within_limit // expect: 0.5 none false",
     LISTS, segments},
    {"hermite_by_curvature(P: point, Q: point, V: vector, W: vector, start: curvature, "
     "finish: curvature)",
     cag_splines_hermite_by_curvature, "list",
     "Returns the plane segments from P to Q in the directions V and W with these curvatures "
     "(1/mm, positive to the left) at both ends. There are up to four.",
     "c = hermite_by_curvature([0, 0], [1, 1], [1, 0], [0, 1], 4, 4)\n"
     "print any(c, h => near(derivative(h, 0), [1, 0])) // expect: true",
     LISTS, segments},
    {"convert_cubic(points: list of 4 points or vectors, "
     "from: \"bezier\" or \"hermite\" or \"power\" or \"parabolic\" = \"bezier\")",
     cag_splines_convert_cubic, "record",
     "Returns a cubic segment over 0..1 in all forms: bezier (control points), hermite (start, "
     "end, both tangents), power (coefficients, lowest first), and parabolic (the four points "
     "whose uniform blend it is). `from` is the form of the four points.",
     "print convert_cubic([[1, 1], [2, 3], [4, 3], [3, 1]]).power // expect: [[1, 1], [3, 6], [3, "
     "-6], [-4, 0]]",
     LISTS, segments},
    {"bezier_join(C: curve, degree: integer >= 1 = 3, order: integer in 0..2 = 1, "
     "ratio: number = 1)",
     cag_splines_bezier_join, "list",
     "Returns the first control points of a Bezier curve of this degree that continues C: its "
     "end, and further points so that derivatives up to the order (0, 1, or 2) agree, after "
     "division by the ratio of the speeds.",
     "print bezier_join(bezier([[1, 1], [2, 3], [4, 3], [3, 1]]), 3, order: 2) // expect: [[3, 1], "
     "[2, -1], [-2, -5]]",
     CURVES, segments},
    {"continuity(C: curve, D: curve, tolerance: number = 1e-9)", cag_splines_continuity, "record",
     "Describes how D continues C: the class, which is the strongest of \"none\", \"C0\", \"G1\", "
     "\"C1\", \"G2\", and \"C2\"; which of these hold; the gap (mm), the angle between the tangents, "
     "the ratio of their lengths, and the jumps of the first and second derivative and of the "
     "curvature. The tolerance is relative.",
     "a = bezier([[1, 1], [2, 3], [4, 3], [3, 1]])\n"
     "print continuity(a, bezier([[3, 1], [2, -1], [0, 0]])).class // expect: G1",
     CURVES, segments},
    {"line_crossings(C: curve, normal: vector, offset: finite number)", cag_splines_line_crossings,
     "record",
     "Returns where a curve meets the line (or plane) of all points whose dot product with the "
     "normal is the offset: the parameters t, the points, their number curve_crossings, and "
     "polygon_crossings, the number of times the control polygon changes sides, which is never "
     "less for crossings.",
     "r = line_crossings(bezier([[1, 1], [2, 3], [4, 3], [3, 1]]), [0, 1], 2)\n"
     "print r.curve_crossings, r.polygon_crossings // expect: 2 2",
     CURVES, segments},
    {"hulls_disjoint(points: list of points, others: list of points)", cag_splines_hulls_disjoint,
     "bool",
     "Tests whether the convex hulls of two lists of points are disjoint. Curves with such "
     "control points do not meet.",
     "print hulls_disjoint([[0, 0], [1, 0], [0, 1]], [[2, 0], [3, 0], [2, 2]]) // expect: true",
     LISTS, segments},
    {0}};
