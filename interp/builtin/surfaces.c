// The table of surfaces.

#include "interp/builtin/surfaces.h"

#define SURFACES CAG_TAKES(SURFACE)
// Surfaces, and solids for their side.
#define SIDES (CAG_TAKES(SURFACE) | CAG_TAKES(SOLID))
#define CURVES CAG_TAKES(CURVE)
#define LISTS CAG_TAKES_LISTS
#define NUMBERS CAG_TAKES(NUMBER)

static const char asked[] = "Surfaces: queries";
static const char curvature[] = "Surfaces: curvature";
static const char changed[] = "Surfaces: editing";
static const char made[] = "Surfaces: construction from curves";
static const char patches[] = "Surfaces: patches";
static const char nets[] = "Surfaces: control nets";
static const char quadrics[] = "Quadrics";

const CagBuiltin cag_builtins_surfaces[] = {
    // --- At one place, and data ---
    {"at(S: surface, u: number or angle, v: number or angle, unit: bool = false)", cag_surfaces_at,
     "list",
     "Returns the point of the surface at u, v, like S(u, v). The parameters are natural: knots, "
     "or angles of rotation. With `unit: true`, both are normalized to 0..1. It is an error if "
     "they are outside of the domain (parameter-range).",
     "print at(bilinear([0, 0], [0, 2], [4, 0], [4, 2]), 0.5, 0.5) // expect: [2, 1, 0]\n"
     "print near(at(sphere_surface(3), 0.5, 0, unit: true), [3, 0, 0]) // expect: true",
     SIDES, asked},
    {"partial(S: surface, u: number or angle, v: number or angle, du: integer = 1, "
     "dv: integer = 0, side: \"right\" or \"left\" = \"right\")",
     cag_surfaces_partial, "list",
     "Returns the partial derivative of order du in u and dv in v (for angles, per radian). At a "
     "knot where it jumps, it is the limit from the right (at the end of the domain, from the "
     "left), or from the given `side`: one for both directions, or two for u and v.",
     "print partial(bilinear([0, 0], [0, 2], [4, 0], [4, 2]), 0, 0) // expect: [4, 0, 0]", SIDES,
     asked},
    {"normal(S: surface, u: number or angle, v: number or angle)", cag_surfaces_normal, "list",
     "Returns the unit normal, in the direction of partial u x partial v. At a pole, it is the "
     "limit of the normal, if there is one.",
     "print near(normal(sphere_surface(2), 90deg, 0deg), X) // expect: true", SIDES, asked},
    {"tangent_plane(S: surface, u: number or angle, v: number or angle)",
     cag_surfaces_tangent_plane, "plane", "Returns the tangent plane at u, v.",
     "print near(tangent_plane(sphere_surface(2), 90deg, 0deg).normal, X) // expect: true", SIDES,
     asked},
    {"domain(S: surface)", cag_surfaces_domain, "record", "Returns the domains of u and v.",
     "print domain(sphere_surface(1)) // expect: {u: 0deg..180deg, v: 0deg..360deg}", SIDES, asked},
    {"degree(S: surface)", cag_surfaces_degree, "list",
     "Returns the degrees of a Bezier or B-spline surface in u and v. Other surfaces have none, "
     "which is an error (no-control-points).",
     "print degree(bezier_surface([[[0, 0, 0], [1, 0, 0]], [[0, 1, 0], [1, 1, 1]]])) // expect: "
     "[1, "
     "1]",
     SURFACES, asked},
    {"knots(S: surface)", cag_surfaces_knots, "list", "Returns the knots in u and in v.",
     "print knots(bezier_surface([[[0, 0, 0], [1, 0, 0]], [[0, 1, 0], [1, 1, 1]]]))[0] // expect: "
     "[0, 0, 1, 1]",
     SURFACES, asked},
    {"points(S: surface)", cag_surfaces_points, "list", "Returns the control net, by rows of u.",
     "print points(bezier_surface([[[0, 0, 0], [1, 0, 0]], [[0, 1, 0], [1, 1, 1]]]))[1][1] // "
     "expect: [1, 1, 1]",
     SURFACES, asked},
    {"weights(S: surface)", cag_surfaces_weights, "list",
     "Returns the weights of the control points, by rows of u; they are 1 if none were given.",
     "print weights(bezier_surface([[[0, 0, 0], [1, 0, 0]], [[0, 1, 0], [1, 1, 1]]])) // expect: "
     "[[1, 1], [1, 1]]",
     SURFACES, asked},
    {"is_closed(S: surface)", cag_surfaces_is_closed, "bool",
     "Tests whether the surface has no boundary.",
     "print is_closed(sphere_surface(1)) // expect: true", SURFACES, asked},
    {"closed_in(S: surface)", cag_surfaces_closed_in, "record",
     "Tests for u and for v whether the opposite edges coincide.",
     "print closed_in(torus_surface(3, 1)) // expect: {u: true, v: true}", SURFACES, asked},

    // --- Curvature ---
    {"first_form(S: surface, u: number or angle, v: number or angle)", cag_surfaces_first_form,
     "list",
     "Returns the first fundamental form [E, F, G], the dot products of the partial derivatives.",
     "print first_form(bilinear([0, 0], [0, 2], [4, 0], [4, 2]), 0, 0) // expect: [16, 0, 4]",
     SIDES, curvature},
    {"second_form(S: surface, u: number or angle, v: number or angle)", cag_surfaces_second_form,
     "list",
     "Returns the second fundamental form [L, M, N], the normal components of the second partial "
     "derivatives. It is undefined at a pole, which is an error (degenerate-normal).",
     "print second_form(bilinear([0, 0], [0, 2], [4, 0], [4, 2]), 0, 0) // expect: [0, 0, 0]",
     SIDES, curvature},
    {"gaussian_curvature(S: surface, u: number or angle, v: number or angle)",
     cag_surfaces_gaussian_curvature, "number",
     "Returns the product of the principal curvatures (1/mm2).",
     "print near(gaussian_curvature(sphere_surface(2), 60deg, 10deg), 0.25) // expect: true", SIDES,
     curvature},
    {"mean_curvature(S: surface, u: number or angle, v: number or angle)",
     cag_surfaces_mean_curvature, "number",
     "Returns the mean of the principal curvatures (1/mm). It is negative if the surface bends "
     "away from its normal.",
     "print near(mean_curvature(sphere_surface(2), 60deg, 10deg), -0.5) // expect: true", SIDES,
     curvature},
    {"normal_curvature(S: surface, u: number or angle, v: number or angle, V: vector)",
     cag_surfaces_normal_curvature, "number",
     "Returns the curvature (1/mm) of the normal section in the direction of V, projected to the "
     "tangent plane.",
     "print near(normal_curvature(sphere_surface(2), 90deg, 0deg, Y), -0.5) // expect: true", SIDES,
     curvature},
    {"principal_curvatures(S: surface, u: number or angle, v: number or angle)",
     cag_surfaces_principal_curvatures, "record",
     "Returns the smallest and the largest normal curvature as min and max, with the unit "
     "vectors min_direction and max_direction, which are perpendicular.",
     "k = principal_curvatures(torus_surface(3, 1), 0deg, 0deg)\n"
     "print near(k.min * k.max, 0.25) // expect: true",
     SIDES, curvature},
    {"curvature_class(S: surface, u: number or angle, v: number or angle)",
     cag_surfaces_curvature_class, "text",
     "Returns \"elliptic\", \"hyperbolic\", \"parabolic\", or \"planar\".",
     "print curvature_class(sphere_surface(1), 90deg, 0deg) // expect: elliptic", SIDES, curvature},

    // --- Of the whole ---
    {"area(S: surface)", cag_surfaces_area, "number", "Returns the area (mm2), to 1e-8.",
     "print near(area(sphere_surface(1)), 4 * pi, relative: 1e-8) // expect: true", SURFACES,
     asked},
    {"volume(S: surface)", cag_surfaces_volume, "number",
     "Returns the volume (mm3) inside a closed surface, to 1e-8. An open surface is an error "
     "(surface-open).",
     "print near(volume(sphere_surface(3)), 36 * pi, relative: 1e-8) // expect: true", SURFACES,
     asked},
    {"centroid(S: surface)", cag_surfaces_centroid, "list",
     "Returns the center of volume of a closed surface, or the centroid of an open surface.",
     "print near(centroid(trim(sphere_surface(3), u: 0deg..90deg)), [0, 0, 1.5]) // expect: true",
     SURFACES, asked},
    {"is_developable(S: surface, tolerance: number = 1e-9)", cag_surfaces_is_developable, "bool",
     "Tests whether the surface can be unrolled into the plane without stretching: whether its "
     "Gaussian curvature, times the square of its size, is at most the tolerance everywhere.",
     "print is_developable(revolve(line([1, 0], [2, 4]))), is_developable(sphere_surface(1)) // "
     "expect: true false",
     SURFACES, asked},
    {"sample(S: surface, nu: integer, nv: integer)", cag_surfaces_sample, "list",
     "Returns nu by nv points (at least 2 by 2) at equal steps of the parameters, by rows of u. "
     "For a swept solid, samples its side.",
     "print sample(bilinear([0, 0], [0, 2], [4, 0], [4, 2]), 2, 3)[1] // expect: [[4, 0, 0], [4, "
     "1, "
     "0], [4, 2, 0]]",
     SIDES, asked},
    {"to_nurbs(S: surface)", cag_surfaces_to_nurbs, "surface",
     "Returns the exact rational B-spline form of the surface, or of the side of a swept solid. "
     "A surface without such a form is an error (no-exact-form).",
     "print degree(to_nurbs(sphere_surface(1))) // expect: [2, 2]", SIDES, changed},
    {"flip(S: surface)", cag_surfaces_flip, "surface",
     "Returns the same surface with reversed normals.",
     "s = flip(sphere_surface(1))\n"
     "print near(normal(s, 90deg, 0deg), -X) // expect: true",
     SURFACES, changed},
    {"isocurve(S: surface, u: number or angle = none, v: number or angle = none)",
     cag_surfaces_isocurve, "curve",
     "Returns the curve of constant u or v on the surface, or on the side of a swept solid.",
     "print near(length(isocurve(sphere_surface(1), u: 90deg)), tau) // expect: true\n"
     "print near(length(isocurve(prism(circle(2), 5), v: 0.5)), 4 * pi) // expect: true",
     SIDES, changed},
    {"boundary(S: surface)", cag_surfaces_boundary, "list",
     "Returns the boundary curves: the open edges, or the outlines of a trimmed or unrolled "
     "surface. A closed surface has none.",
     "print len(boundary(bilinear([0, 0], [0, 2], [4, 0], [4, 2]))) // expect: 4\n"
     "sheet = boundary(unroll(revolve(line([1, 0], [1, 5]))))\n"
     "print len(sheet), near(length(sheet[0]), 2 * (5 + tau)) // expect: 1 true",
     SURFACES, changed},

    {"trim(S: surface, curves: list of closed curves = none, "
     "u: range of numbers or angles = none, v: range of numbers or angles = none)",
     cag_surfaces_trim, "surface",
     "Returns the part of the surface over ranges of the parameters, which do not change; a "
     "surface with control points gets the exact ones of the part. Or returns the part inside "
     "closed curves [u, v] of the parameter plane (radians for angles), given as a region, a "
     "curve, points, or a list of curves, whose inner ones are holes. Its area and volume are "
     "exact, its mesh ends on the curves, and `boundary` returns them in space. Curves that "
     "leave the domain are an error (curve-outside).",
     "s = trim(sphere_surface(1), u: 0deg..90deg)\n"
     "print near(area(s), tau, relative: 1e-8) // expect: true\n"
     "flat = bilinear([0, 0], [0, 8], [8, 0], [8, 8])\n"
     "rings = [circle(0.25, center: [0.5, 0.5]), circle(0.125, center: [0.5, 0.5])]\n"
     "print near(area(trim(flat, rings)), 3 * pi, relative: 1e-8) // expect: true",
     SURFACES, changed},
    {"split(S: surface, u: number or angle = none, v: number or angle = none)", cag_surfaces_split,
     "list", "Splits the surface at a value of u or v, and returns both parts.",
     "parts = split(sphere_surface(1), u: 90deg)\n"
     "print near(area(parts[1]), tau, relative: 1e-8) // expect: true",
     SURFACES, changed},
    {"insert_knot(S: surface, u: number or angle = none, v: number or angle = none, "
     "times: integer = 1)",
     cag_surfaces_insert_knot, "surface",
     "Inserts a knot in u or v without changing the surface, which adds a row of control points.",
     "s = bezier_surface([[[0, 0, 0], [0, 1, 0], [0, 2, 0]], [[1, 0, 0], [1, 1, 2], [1, 2, 0]]])\n"
     "print len(points(insert_knot(s, v: 0.5))[0]) // expect: 4",
     SURFACES, changed},
    {"refine(S: surface, u: bool or \"midpoints\" or list of numbers = true, "
     "v: bool or \"midpoints\" or list of numbers = true)",
     cag_surfaces_refine, "surface",
     "Inserts knots without changing the surface: by default, at the middle of each knot "
     "interval in both directions or in one. Closed directions stay closed. For u and v, you can "
     "also give a complete list of new knots, which must contain the old ones "
     "(knots-not-superset), or \"midpoints\".",
     "s = bezier_surface([[[0, 0, 0], [0, 1, 0], [0, 2, 0]], [[1, 0, 0], [1, 1, 2], [1, 2, 0]]])\n"
     "print len(points(refine(s))), len(points(refine(s))[0]) // expect: 3 4",
     SURFACES, changed},
    {"elevate(S: surface, u: integer in 0..20 = 0, v: integer in 0..20 = 0)", cag_surfaces_elevate,
     "surface", "Raises the degrees in u and v without changing the surface.",
     "s = bezier_surface([[[0, 0, 0], [0, 1, 0], [0, 2, 0]], [[1, 0, 0], [1, 1, 2], [1, 2, 0]]])\n"
     "print degree(elevate(s, u: 2, v: 1)) // expect: [3, 3]",
     SURFACES, changed},
    {"to_bezier(S: surface)", cag_surfaces_to_bezier, "list",
     "Returns the Bezier patches of the surface, each over 0..1, by rows of u.",
     "s = bezier_surface([[[0, 0, 0], [0, 1, 0], [0, 2, 0]], [[1, 0, 0], [1, 1, 2], [1, 2, 0]]])\n"
     "print len(to_bezier(refine(s))[1]) // expect: 2",
     SURFACES, changed},
    {"transpose_uv(S: surface)", cag_surfaces_transpose_uv, "surface",
     "Exchanges u and v, which reverses the normals.",
     "s = transpose_uv(bilinear([0, 0], [0, 2], [4, 0], [4, 2]))\n"
     "print s(0.5, 0.25) // expect: [1, 1, 0]",
     SURFACES, changed},
    {"join_surfaces(A: surface, B: surface, tolerance: number = 1e-9)", cag_surfaces_join_surfaces,
     "surface",
     "Joins two surfaces with a common edge. u runs over the first, then over the second. The "
     "tolerance is a fraction of their size. If they have no common edge, it is an error "
     "(edges-do-not-match).",
     "s = bezier_surface([[[0, 0, 0], [0, 1, 0], [0, 2, 0]], [[1, 0, 0], [1, 1, 2], [1, 2, 0]]])\n"
     "parts = split(s, u: 0.5)\n"
     "print near(area(join_surfaces(parts[0], parts[1])), area(s), relative: 1e-8) // expect: true",
     SURFACES, changed},
    {"continuity(A: surface, B: surface, edge: text or list of 2 texts = none, "
     "tolerance: number = 1e-9, edges: list of 2 texts = none)",
     cag_surfaces_continuity, "record",
     "Describes how two surfaces meet along their nearest edges, or along the `edge` of both "
     "(such as \"u1\", or [\"u1\", \"u0\"] for A and B; `edges` is another name). The record has the "
     "class (\"none\", \"C0\", \"G1\", \"C1\", or \"G2\"), the largest gap (mm), the largest angle between "
     "the tangent planes, the largest jumps of the cross derivative and of the curvature, the "
     "edges and whether they are `reversed`, and C0, G1, C1, and G2 separately.",
     "parts = split(sphere_surface(1), u: 60deg)\n"
     "print continuity(parts[0], parts[1]).class // expect: G2",
     SURFACES, asked},
    {"unroll(S: surface)", cag_surfaces_unroll, "surface",
     "Unrolls a developable surface, such as a cylinder or cone, into the plane z = 0. "
     "Parameters and lengths stay the same; the surface is straight along u or v. A surface that "
     "would be stretched is an error (not-developable).",
     "flat = unroll(revolve(line([1, 0], [1, 5])))\n"
     "print near(bounds(flat).size, [5, tau, 0]) // expect: true",
     SURFACES, changed},
    {"map_onto(G: shape or group, S: surface, tolerance: length = none)", cag_surfaces_map_onto,
     "curve, surface, mesh or group",
     "Maps a shape onto a surface: x and y of G become u and v (radians for angles), and z the "
     "distance along the normal. Curves and surfaces keep exact derivatives. Regions, solids, "
     "and meshes become meshes within the tolerance (none: a thousandth of the size); closed "
     "ones stay closed. For a group or list, maps each member. Points outside of the domain are "
     "an error (parameter-range).",
     "s = bilinear([0, 0], [0, 8], [8, 0], [8, 8])\n"
     "print near(length(map_onto(circle(0.25, center: [0.5, 0.5]), s)), 4 * pi) // expect: true\n"
     "m = map_onto(translate(box([0.5, 0.5, 3]), [0.2, 0.2, 0]), s)\n"
     "print near(volume(m), 48), is_watertight(m) // expect: true true",
     CURVES | SURFACES | CAG_TAKES(REGION) | CAG_TAKES(SOLID) | CAG_TAKES(MESH) | CAG_TAKES(GROUP) |
         CAG_TAKES(LIST),
     changed},
    {"remap(S: surface, f: function (u, v) => [u, v], u: range of numbers or angles = none, "
     "v: range of numbers or angles = none)",
     cag_surfaces_remap, "surface",
     "Returns the surface S(f(u, v)), where f returns the old parameters for the new ones, over "
     "these ranges (none: those of S). Derivatives are exact.",
     "s = remap(bilinear([0, 0], [0, 2], [4, 0], [4, 2]), (u, v) => [u^2, 1 - v])\n"
     "print near(s(0.5, 0.25), [1, 1.5, 0]) // expect: true",
     SURFACES, changed},
    {"offset(S: surface, d: length)", cag_surfaces_offset, "surface",
     "Returns the surface at this distance (mm) along its normals.",
     "print near(area(offset(sphere_surface(2), 1)), 36 * pi, relative: 1e-7) // expect: true",
     SURFACES, changed},
    {"thicken(S: surface, d: length)", cag_surfaces_thicken, "solid",
     "Returns the solid between a surface and its offset at this distance (mm).",
     "s = bilinear([0, 0], [0, 2], [4, 0], [4, 2])\n"
     "print near(volume(thicken(s, 0.5)), 4, relative: 1e-8) // expect: true",
     SURFACES, changed},

    // --- Of curves ---
    {"revolve(C: curve or region or list of points, axis: vector = Z, "
     "through: point = origin, angle: range of angles or angle = 0deg..360deg)",
     cag_surfaces_revolve, "surface or solid",
     "Rotates a curve about an axis through a point, over a range of angles; an angle a means "
     "0deg..a. Returns a surface with the parameter u of the curve and the angle v. A region or "
     "polygon gives a solid. If the axis is parallel to Z, a plane [x, y] is placed as [x, 0, "
     "y]. A zero axis and a region that the axis cuts are errors.",
     "print near(volume(revolve(polygon([[0, 0], [2, 0], [0, 3]]))), 4 * pi) // expect: true\n"
     "print near(area(revolve(line([2, 0], [2, 5]))), 20 * pi) // expect: true",
     CURVES | CAG_TAKES(REGION) | CAG_TAKES(LIST), made},
    {"extrude(C: curve or region or list of points, height: length or vector, "
     "twist: angle = 0deg, scale: number = 1, caps: bool = true, centered: bool = false)",
     cag_surfaces_extrude, "solid or surface",
     "Moves a curve along a vector, or up by a height (mm). Returns a surface with the parameter "
     "u of the curve and v in 0..1. A region, polygon, or closed plane curve gives a solid with "
     "caps, unless `caps: false`. Along the way, the section rotates by the twist and grows to "
     "the scale, about the z axis. A positive twist is counter-clockwise seen from the tip of z, "
     "so edges rise like a right-handed thread. If it is centered, the result is moved back by "
     "half the vector.",
     "print near(volume(extrude(rectangle(4, 3), 5)), 60) // expect: true\n"
     "print near(area(extrude(line([0, 0], [4, 0]), [0, 0, 5])), 20) // expect: true",
     CURVES | CAG_TAKES(REGION) | CAG_TAKES(LIST), made},
    {"ruled(A: curve, B: curve)", cag_surfaces_ruled, "surface",
     "Returns the ruled surface between two curves: the first at u = 1, the second at u = 0, "
     "with v in 0..1 along both.",
     "s = ruled(line([0, 0, 1], [4, 0, 1]), line([0, 0, 0], [4, 0, 0]))\n"
     "print s(1, 0.5) // expect: [2, 0, 1]",
     CURVES, made},
    {"bilinear(P: point, Q: point, R: point, S: point)", cag_surfaces_bilinear, "surface",
     "Returns the bilinear surface between four corners: P at u = 0, v = 0; Q at u = 0, v = 1; R "
     "at u = 1, v = 0; and S at u = 1, v = 1.",
     "print bilinear([0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 4])(0.5, 0.5) // expect: [0.5, 0.5, "
     "1]",
     LISTS, made},
    {"sweep(C: curve or region or list of points, path: curve, "
     "orient: text or vector = \"rmf\", twist: angle or function of t = 0deg, "
     "scale: number or function of t = 1, caps: bool = true)",
     cag_surfaces_sweep, "solid or surface",
     "Sweeps a section along a path. The section is perpendicular to the path: its x is along "
     "the frame's normal, and its y along the binormal. The frame is rotation-minimizing "
     "(\"rmf\"), that of Frenet (\"frenet\"), constant (\"fixed\"), or has its y as near as possible "
     "to a given direction. The section rotates by `twist` and grows to `scale` along the path, "
     "linearly, or by functions of the path's parameter. A region, polygon, or closed plane "
     "curve gives a solid with caps, whose u and v are those of its side. Otherwise, or with "
     "`caps: false`, the result is a surface with u of the section and v of the path. Corners of "
     "the path are mitered. A positive twist is counter-clockwise seen from the end of the path, "
     "like a right-handed screw. On a helix about Z, with \"frenet\" and with `orient: Z`, x "
     "points at the axis and y is nearest to Z. \"rmf\" and \"fixed\" start with X and Y rotated by "
     "the shortest way that takes Z to the path.",
     "path = polyline([[0, 0, 0], [0, 0, 5]])\n"
     "print near(volume(sweep(rectangle(4, 2), path)), 40, relative: 1e-8) // expect: true\n"
     "print near(volume(sweep(circle(1), circle(5))), 10 * pi^2, relative: 1e-8) // expect: true",
     CURVES | CAG_TAKES(REGION) | CAG_TAKES(LIST), made},
    {"sweep_by(C: curve, map: function t => transform, range: range of numbers or angles, "
     "caps: bool = true)",
     cag_surfaces_sweep_by, "solid or surface",
     "Moves a section by a transform that depends on one parameter: S(u, v) = map(v) * C(u), "
     "with v over the range. A region, polygon, or closed plane curve gives a solid with caps. A "
     "discontinuous map is an error (function-jumps).",
     "s = sweep_by(rectangle(2, 2), t => translate([0, 0, t]) * rotate(Z, t * 10deg), 0..3)\n"
     "print near(volume(s), 12, relative: 1e-8) // expect: true",
     CURVES | CAG_TAKES(REGION) | CAG_TAKES(LIST), made},
    {"tube(path: curve, radius: number or function of t, caps: bool = true)", cag_surfaces_tube,
     "solid or surface",
     "Returns a tube of this radius (mm) along a path. The radius may be a function of the "
     "path's parameter. The tube is a solid with caps; with `caps: false`, it is the side alone, "
     "with the angle u around the path and the path's parameter v.",
     "path = line([0, 0, 0], [0, 0, 5])\n"
     "print near(volume(tube(path, 2)), 20 * pi, relative: 1e-8) // expect: true\n"
     "print near(volume(tube(path, t => 2 - t)), 35 * pi / 3, relative: 1e-8) // expect: true",
     CURVES, made},
    {"loft(curves: list of curves or regions, degree: integer >= 1 = 3, "
     "closed: bool = false, caps: bool = true)",
     cag_surfaces_loft, "solid or surface",
     "Returns the surface through curves, or through regions without holes, in order. u in 0..1 "
     "runs along each curve, and v = i is curve i. In v, the surface is a spline of this degree. "
     "With `closed: true`, it continues from the last curve to the first. If the curves are "
     "closed, the ends get flat caps, and the result is a solid. If a curve has no exact NURBS "
     "form, such as a formula or helix, u is the fraction of each curve's domain.",
     "a = circle(2)\n"
     "tower = loft([for z in [0, 3, 5]: translate(a, [0, 0, z])])\n"
     "print near(volume(tower), 20 * pi, relative: 1e-8) // expect: true",
     LISTS, made},
    {"translational(A: curve, B: curve)", cag_surfaces_translational, "surface",
     "Moves curve A along curve B, starting at B's start.",
     "s = translational(line([0, 0, 0], [4, 0, 0]), line([0, 0, 0], [0, 3, 0]))\n"
     "print near(area(s), 12) // expect: true",
     CURVES, made},
    {"sphere_surface(radius: length)", cag_surfaces_sphere_surface, "surface",
     "Returns the sphere about the origin as a surface: u is the polar angle from Z, and v the "
     "azimuth.",
     "print near(sphere_surface(2)(90deg, 90deg), [0, 2, 0]) // expect: true", NUMBERS, made},
    {"torus_surface(major: length > 0, minor: length > 0)", cag_surfaces_torus_surface, "surface",
     "Returns the torus about Z as a surface: a circle of radius `minor` whose center moves on a "
     "circle of radius `major`.",
     "print near(area(torus_surface(3, 1)), 12 * pi^2, relative: 1e-8) // expect: true", NUMBERS,
     made},

    // --- Patches ---
    {"developable(A: curve, B: curve)", cag_surfaces_developable, "surface",
     "Returns the developable surface between two curves. Like `ruled` (the first at u = 1, the "
     "second at u = 0), but each ruling lies in one plane with the tangents at both ends, so the "
     "surface can be unrolled. The rulings start as near to the starts of the curves as "
     "possible, and extend as far as both curves have them. v in 0..1 is the fraction of the "
     "first curve's parameter range. If such rulings do not exist, it is an error (no-rulings).",
     "s = developable(circle(1), translate(ellipse(2, 1), [0, 0, 3]))\n"
     "print is_developable(s), is_developable(ruled(circle(1), translate(ellipse(2, 1), [0, 0, "
     "3]))) "
     "// expect: true false",
     CURVES, patches},
    {"coons(u0: curve, u1: curve, v0: curve, v1: curve)", cag_surfaces_coons, "surface",
     "Returns the Coons surface between four edges, named by the side on which they lie: u0 and "
     "u1 run along v, and v0 and v1 along u, in the direction of increasing parameters. Edges "
     "that do not meet are an error (coons-corner-mismatch), which states the corner, the gap, "
     "and which edge to reverse.",
     "s = coons(line([0, 0, 0], [0, 2, 0]), line([2, 0, 0], [2, 2, 4]), line([0, 0, 0], [2, 0, "
     "0]), "
     "line([0, 2, 0], [2, 2, 4]))\n"
     "print s(0.5, 0.5) // expect: [1, 1, 1]",
     CURVES, patches},
    {"coons_bicubic(corners: list of 2 rows of points, "
     "tangents_u: list of 2 rows of vectors, tangents_v: list of 2 rows of vectors, "
     "twists: \"zero\" or \"adini\" or list of 2 rows of vectors = \"zero\")",
     cag_surfaces_coons_bicubic, "surface",
     "Returns the bicubic patch over 0..1 with these corners, derivatives in u and v, and "
     "twists. Each is a table [[u = 0 and v = 0, u = 0 and v = 1], [u = 1 and v = 0, u = 1 and v "
     "= 1]]. Twists can also be \"zero\" (Ferguson's patch) or \"adini\" (those of the bilinear "
     "Coons surface).",
     "flat = [[[0, 0, 0], [0, 3, 0]], [[3, 0, 0], [3, 3, 0]]]\n"
     "s = coons_bicubic(flat, [[[3, 0, 8], [3, 0, 8]], [[3, 0, -8], [3, 0, -8]]], [[[0, 3, 0], [0, "
     "3, 0]], [[0, 3, 0], [0, 3, 0]]])\n"
     "print s(0.5, 0.5) // expect: [1.5, 1.5, 2]",
     LISTS, patches},
    {"hermite_patch(Q: list of rows of points and vectors, "
     "u: range of numbers or angles = 0..1, v: range of numbers or angles = 0..1)",
     cag_surfaces_hermite_patch, "surface",
     "Returns the bicubic patch of a 4 by 4 table of vectors: the rows are for u = 0, u = 1, and "
     "the derivatives in u there; the columns likewise for v. Derivatives are with respect to "
     "the parameters of the ranges.",
     "q = [[[0, 0, 0], [0, 3, 0], [0, 3, 0], [0, 3, 0]], [[3, 0, 0], [3, 3, 0], [0, 3, 0], [0, 3, "
     "0]], [[3, 0, 0], [3, 0, 0], [0, 0, 0], [0, 0, 0]], [[3, 0, 0], [3, 0, 0], [0, 0, 0], [0, 0, "
     "0]]]\n"
     "print near(hermite_patch(q)(0.5, 0.25), [1.5, 0.75, 0]) // expect: true",
     LISTS, patches},
    {"hermite_surface(grid: list of rows of points, "
     "edge_tangents: record of lists of vectors, corner_twists: list of 2 rows of vectors, "
     "lengths: list of lists of numbers = none)",
     cag_surfaces_hermite_surface, "surface",
     "Returns the bicubic surface with continuous curvature through a grid of points, given by "
     "rows of u: point [i][j] is at u = i, v = j, or at the cumulative sums of `lengths`, the "
     "steps in u and v. edge_tangents is a record: u0 and u1 are the derivatives in u along the "
     "first and the last row, v0 and v1 those in v along the first and the last column. "
     "corner_twists is a table of 2 by 2.",
     "grid = [for i in 0..2: [for j in 0..2: [i, j, 0]]]\n"
     "x = [for i in 0..2: X]\n"
     "y = [for i in 0..2: Y]\n"
     "o = [0, 0, 0]\n"
     "s = hermite_surface(grid, {u0: x, u1: x, v0: y, v1: y}, [[o, o], [o, o]])\n"
     "print near(s(0.5, 1.25), [0.5, 1.25, 0]) // expect: true",
     LISTS, patches},

    // --- Nets ---
    {"bezier_surface(net: list of rows of points, weights: list of numbers = none)",
     cag_surfaces_bezier_surface, "surface",
     "Returns the Bezier surface of a control net, given by rows of u, over 0..1 in both "
     "directions. With weights, in rows like the points, it is rational.",
     "s = bezier_surface([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 4]]])\n"
     "print s(0.5, 0.5) // expect: [0.5, 0.5, 1]",
     LISTS, nets},
    {"bezier_triangle(net: list of rows of points)", cag_surfaces_bezier_triangle, "surface",
     "Returns the triangular Bezier surface of rows of 1, 2, 3, ... points. The first row is the "
     "corner at u = 0, and the last is the edge u = 1, along which v runs. The barycentric "
     "coordinates of u, v are 1 - u, u (1 - v), and u v.",
     "s = bezier_triangle([[[0, 0, 0]], [[1, 0, 1], [0, 1, 1]], [[2, 0, 0], [1, 1, 1], [0, 2, "
     "0]]])\n"
     "print near(s(2 / 3, 0.5), [2 / 3, 2 / 3, 2 / 3]) // expect: true",
     LISTS, nets},
    {"bspline_surface(net: list of rows of points, "
     "degree: integer or list of 2 integers = [3, 3], "
     "knots: list of \"open\" or \"periodic\" or list of numbers = [\"open\", \"open\"], "
     "closed: bool or list of 2 bools = [false, false], weights: list of numbers = none, "
     "order: integer or list of 2 integers = none)",
     cag_surfaces_bspline_surface, "surface",
     "Returns the B-spline surface of a control net, given by rows of u. `degree`, `knots`, and "
     "`closed` are one value for both directions, or a list of two for u and v. Knots are as for "
     "bspline, except \"chord\".",
     "net = [for i in 0..3: [for j in 0..3: [i, j, 0]]]\n"
     "print near(area(bspline_surface(net)), 9) // expect: true",
     LISTS, nets},
    {"nurbs_surface(net: list of rows of points, "
     "degree: integer or list of 2 integers = [3, 3], "
     "knots: list of \"open\" or \"periodic\" or list of numbers = [\"open\", \"open\"], "
     "closed: bool or list of 2 bools = [false, false], weights: list of numbers = none, "
     "order: integer or list of 2 integers = none)",
     cag_surfaces_nurbs_surface, "surface",
     "Returns the rational B-spline surface of a control net and weights (in rows like the "
     "points). Otherwise like bspline_surface.",
     "s = nurbs_surface([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]], degree: 1, weights: [[1, "
     "1], [1, 1]])\n"
     "print near(area(s), 1) // expect: true",
     LISTS, nets},

    {"interpolate_surface(grid: list of rows of points, "
     "degree: integer or list of 2 integers = [3, 3], "
     "parameters: \"chord\" or \"mean\" or \"uniform\" or list of 2 lists of numbers = \"chord\", "
     "knots: list of 2 lists of numbers = none, closed: bool or list of 2 bools = [false, "
     "false])",
     cag_surfaces_interpolate_surface, "surface",
     "Returns the B-spline surface through a grid of points, given by rows of u, over 0..1. The "
     "parameters are by chord length (its mean over the rows, and over the columns), \"uniform\", "
     "or a record with u and v, each a list with one value for each line, or a table. The knots "
     "are means of the parameters, or two lists. A closed direction continues from its last line "
     "to the first, over 0..the number of lines. Points that do not determine the surface are an "
     "error (fit-singular).",
     "grid = [for i in 0..4: [for j in 0..5: [i, j, i * j / 10]]]\n"
     "s = interpolate_surface(grid)\n"
     "print near(s(0, 0), [0, 0, 0]), near(s(1, 1), [4, 5, 2]) // expect: true true\n"
     "ring = [for z in 0..3: [for k in 0..<5: polar(2, k * 72deg) |> (p => [p.x, p.y, z])]]\n"
     "t = interpolate_surface(ring, closed: [false, true], parameters: \"uniform\")\n"
     "print near(t(0, 5), [2, 0, 0]), closed_in(t).v // expect: true true",
     LISTS, nets},
    {"fit_surface(grid: list of rows of points, degree: integer or list of 2 integers, "
     "count: integer or list of 2 integers, "
     "parameters: \"chord\" or \"mean\" or \"uniform\" or list of 2 lists of numbers = \"chord\", "
     "knots: list of 2 lists of numbers = none, closed: bool or list of 2 bools = [false, "
     "false], corrections: integer = 0, fixed: \"none\" or \"x\" or \"y\" or \"z\" = \"none\", "
     "planes: list of numbers or \"auto\" or record = none, error: length >= 0 = 1e-9)",
     cag_surfaces_fit_surface, "surface",
     "Returns the least-squares fit of a B-spline surface with `count` control points (two "
     "numbers, for u and v) to a grid of points, on open uniform knots or on given ones. The "
     "parameters are by chord length along each row and column, by their \"mean\", \"uniform\", or a "
     "record as for interpolate_surface. In up to `corrections` rounds, the parameters move to "
     "the nearest points of the surface, and it is fitted again, as long as the fit improves. "
     "`fixed` names a coordinate (\"x\", \"y\", or \"z\") that must match that of the data, to within "
     "`error`; parameters move to achieve it (not with `error: inf`), and the edges are fitted "
     "to the border alone. With `planes`, the control points have given values of this "
     "coordinate, one for each row ({v: ...}: for each column), or \"auto\", by the stations of "
     "the data.",
     "grid = [for i in 0..4: [for j in 0..5: [i, j, i * j / 10]]]\n"
     "print near(area(fit_surface(grid, 2, [3, 4])), area(interpolate_surface(grid)), relative: "
     "1e-6) // expect: true\n"
     "hull = fit_surface(grid, 2, [3, 4], fixed: \"x\", planes: [0, 2.5, 4])\n"
     "print [for row in points(hull): row[1].x] // expect: [0, 2.5, 4]",
     LISTS, nets},
    {"fit_surface_report(grid: list of rows of points, "
     "degree: integer or list of 2 integers, count: integer or list of 2 integers, "
     "parameters: \"chord\" or \"mean\" or \"uniform\" or list of 2 lists of numbers = \"chord\", "
     "knots: list of 2 lists of numbers = none, closed: bool or list of 2 bools = [false, "
     "false], corrections: integer = 0, fixed: \"none\" or \"x\" or \"y\" or \"z\" = \"none\", "
     "planes: list of numbers or \"auto\" or record = none, error: length >= 0 = 1e-9)",
     cag_surfaces_fit_surface_report, "record",
     "Returns a record about fit_surface: the surface; the parameters u and v of each point; the "
     "residuals (surface minus data); the rms and largest of their lengths (mm); the rounds in "
     "which parameters moved; and the planes of control points by u or v, in the form in which "
     "fit_surface accepts them, or none if the fit did not use planes.",
     "grid = [for i in 0..4: [for j in 0..5: [i, j, i * j / 10]]]\n"
     "print fit_surface_report(grid, 2, [3, 4], \"uniform\").largest < 1e-12 // expect: true",
     LISTS, nets},
    {"grid_parameters(grid: list of rows of points, "
     "parameters: \"chord\" or \"mean\" or \"uniform\" or list of 2 lists of numbers = \"chord\", "
     "ends: list of 2 numbers = [1, 1], closed: bool or list of 2 bools = [false, false])",
     cag_surfaces_grid_parameters, "record",
     "Returns the parameters u and v of each point of a grid, from 0 to `ends`: by chord length "
     "along each row and column, by their \"mean\", or \"uniform\". In a closed direction, the way "
     "back to the first point is included.",
     "p = grid_parameters([[[0, 0], [1, 0], [4, 0]], [[0, 2], [3, 2], [4, 2]]])\n"
     "print p.u, p.v // expect: [[0, 0, 0], [1, 1, 1]] [[0, 0.25, 1], [0, 0.75, 1]]",
     LISTS, nets},

    // --- Quadrics ---
    {"quadric(coefficients: list of 10 numbers or list of 4 rows, "
     "within: box or range of z = none)",
     cag_surfaces_quadric, "surface or group",
     "Returns the real surface a x^2 + b y^2 + c z^2 + d xy + e yz + f xz + g x + h y + j z + k "
     "= 0, given as ten numbers or as 4 rows of 4. Two sheets or planes are a group. `within` "
     "cuts it by a box, or by a range of z in the coordinates of the equation; later transforms "
     "move the cut as well. Where the cut is not along parameters, the surface is trimmed by "
     "curves that are exact to 1e-11 of the box's diagonal. A quadric without real points is an "
     "error (quadric-imaginary). So is one that is unbounded within the range, or without "
     "`within` (quadric-unbounded).",
     "b = box([4, 6, 9], centered: true)\n"
     "print near(bounds(quadric([1, 1, -1, 0, 0, 0, 0, 0, 0, -1], within: b)).max.y, 3) // expect: "
     "true\n"
     "print near(area(quadric([1, 1, 1, 0, 0, 0, 0, 0, 0, -4])), 16 * pi, relative: 1e-8) // "
     "expect: "
     "true",
     LISTS, quadrics},
    {"ellipsoid(a: length, b: length, c: length, within: box or range of z = none)",
     cag_surfaces_ellipsoid, "surface or group",
     "Returns the surface x^2/a^2 + y^2/b^2 + z^2/c^2 = 1, or its part in the box or range of z "
     "`within`.",
     "print near(bounds(ellipsoid(3, 2, 1)).size, [6, 4, 2]) // expect: true\n"
     "print near(area(ellipsoid(2, 2, 2, within: 0..1)), 4 * pi) // expect: true",
     NUMBERS, quadrics},
    {"hyperboloid(a: length, b: length, c: length, sheets: 1 or 2 = 1, "
     "within: box or range of z = none)",
     cag_surfaces_hyperboloid, "surface or group",
     "Returns the surface x^2/a^2 + y^2/b^2 - z^2/c^2 = 1, or -1 with `sheets: 2`, cut by "
     "`within`.",
     "print classify(hyperboloid(1, 1, 1, within: -2..2)).class // expect: hyperboloid-1", NUMBERS,
     quadrics},
    {"paraboloid(a: length, b: length, within: box or range of z = none)", cag_surfaces_paraboloid,
     "surface or group", "Returns the surface z = x^2/a^2 + y^2/b^2, cut by `within`.",
     "print near(bounds(paraboloid(1, 1, within: 0..4)).max, [2, 2, 4]) // expect: true", NUMBERS,
     quadrics},
    {"hyperbolic_paraboloid(a: length, b: length, within: box or range of z = none)",
     cag_surfaces_hyperbolic_paraboloid, "surface or group",
     "Returns the saddle z = x^2/a^2 - y^2/b^2, cut by `within`.",
     "s = hyperbolic_paraboloid(1, 1, within: box(2, centered: true))\n"
     "print classify(s).class // expect: hyperbolic-paraboloid",
     NUMBERS, quadrics},
    {"elliptic_cone(a: length, b: length, c: length, within: box or range of z = none)",
     cag_surfaces_elliptic_cone, "surface or group",
     "Returns the cone x^2/a^2 + y^2/b^2 - z^2/c^2 = 0, cut by `within`.",
     "print classify(elliptic_cone(1, 2, 1, within: -1..1)).class // expect: cone", NUMBERS,
     quadrics},
    {"elliptic_cylinder(a: length, b: length, within: box or range of z = none)",
     cag_surfaces_elliptic_cylinder, "surface or group",
     "Returns the cylinder x^2/a^2 + y^2/b^2 = 1 along Z, cut by `within`. A box may leave "
     "several strips, as a group.",
     "print near(area(elliptic_cylinder(1, 1, within: 0..3)), 6 * pi, relative: 1e-8) // expect: "
     "true",
     NUMBERS, quadrics},
    {"parabolic_cylinder(a: length, within: box or range of z = none)",
     cag_surfaces_parabolic_cylinder, "surface or group",
     "Returns the cylinder y^2 = 4 a x along Z, with focal length a, cut by `within`.",
     "s = parabolic_cylinder(1, within: box(2, centered: true))\n"
     "print classify(s).class // expect: parabolic-cylinder",
     NUMBERS, quadrics},
    {"hyperbolic_cylinder(a: length, b: length, within: box or range of z = none)",
     cag_surfaces_hyperbolic_cylinder, "surface or group",
     "Returns the cylinder x^2/a^2 - y^2/b^2 = 1 along Z, cut by `within`.",
     "s = hyperbolic_cylinder(1, 1, within: box(4, centered: true))\n"
     "print classify(s).class // expect: hyperbolic-cylinder",
     NUMBERS, quadrics},
    {"classify(Q: quadric or list of 10 numbers or list of 4 rows)", cag_surfaces_classify,
     "record",
     "Classifies a quadric, sphere, ten numbers, or four rows: `class` (17 kinds, including "
     "imaginary ones), the canonical `frame`, the `center` (or none), the "
     "`semi_axes`, and the ranks `rank3` and `rank4` of its matrices.",
     "print classify([1, 1, 1, 0, 0, 0, 0, 0, 0, 4]).class // expect: imaginary-ellipsoid",
     SURFACES | CAG_TAKES(SOLID) | CAG_TAKES(GROUP) | CAG_TAKES(LIST), quadrics},
    {0}};
