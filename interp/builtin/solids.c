// The table of solids, meshes, copies, and shapes that explain others.

#include "interp/builtin/solids.h"

#define NUMBERS CAG_TAKES(NUMBER)
#define LISTS CAG_TAKES_LISTS
#define MESHES CAG_TAKES(MESH)
// Solids that are polyhedra (hulls, bodies within meshes) answer for the mesh that bounds them.
#define POLYHEDRA (MESHES | CAG_TAKES(SOLID))
// What has a volume; surfaces have rows of their own.
#define BODIES (CAG_TAKES(SOLID) | MESHES | CAG_TAKES(GROUP))

// What encloses a part of space; operations of regions have rows of their own.
#define OPERANDS                                                                                   \
  (CAG_TAKES(SOLID) | MESHES | CAG_TAKES(SURFACE) | CAG_TAKES(GROUP) | CAG_TAKES(LIST))

static const char primitives[] = "Solids";
static const char operations[] = "Set operations";
static const char copies[] = "Copies";
static const char measures[] = "Solids: measures";
static const char meshes[] = "Meshes";
static const char figures[] = "Figures";

const CagBuiltin cag_builtins_solids[] = {
    {"box(size: length or list [x, y, z], centered: bool = false)", cag_solids_box, "solid",
     "Returns a cube with this edge length (mm), or a box of size [x, y, z]. One corner is at "
     "the origin, or the box is centered there. Sizes must be positive.",
     "print volume(box([1, 2, 3])), bounds(box(2, centered: true)).min // expect: 6 [-1, -1, -1]",
     NUMBERS | CAG_TAKES(LIST), primitives},
    {"sphere(radius: length > 0)", cag_solids_sphere, "solid",
     "Returns a ball, centered at the origin.",
     "print near(volume(sphere(3)), 36 * pi) // expect: true", NUMBERS, primitives},
    {"cylinder(height: length > 0, radius: length >= 0, top: length >= 0 = radius, "
     "centered: bool = false)",
     cag_solids_cylinder, "solid",
     "Returns a cylinder about Z that stands on z = 0, or is centered at the origin. With "
     "another radius at the top, it is a frustum, and with 0 a cone.",
     "print near(volume(cylinder(5, 2)), 20 * pi) // expect: true\n"
     "print bounds(cylinder(4, 1, centered: true)).min // expect: [-1, -1, -2]",
     NUMBERS, primitives},
    {"cone(height: length > 0, radius: length > 0, centered: bool = false)", cag_solids_cone,
     "solid",
     "Returns a cone about Z that stands on z = 0, or whose axis is centered at the origin.",
     "print near(volume(cone(3, 2)), 4 * pi) // expect: true", NUMBERS, primitives},
    {"prism(region: region or closed curve or list of points, height: length, "
     "centered: bool = false)",
     cag_solids_prism, "solid",
     "Extrudes a region, closed plane curve, or polygon by the height (mm) along z. If it is "
     "centered, the prism extends equally far below and above the region.",
     "print near(volume(prism([[0, 0], [4, 0], [0, 3]], 5)), 30) // expect: true\n"
     "print bounds(prism(rectangle(2, 2), 4, centered: true)).max // expect: [1, 1, 2]",
     CAG_TAKES(REGION) | CAG_TAKES(CURVE) | CAG_TAKES(LIST), primitives},
    {"rod(P: point, Q: point, radius: length >= 0, top: length >= 0 = radius)", cag_solids_rod,
     "solid",
     "Returns a cylinder from P to Q. With another radius at Q, it is a frustum or cone. It is "
     "an error if P equals Q.",
     "print near(volume(rod(origin, [0, 3, 4], 1)), 5 * pi) // expect: true", LISTS, primitives},
    {"torus(major: length > 0, minor: length > 0)", cag_solids_torus, "solid",
     "Returns a torus about Z: a disk of radius `minor` whose center moves on a circle of radius "
     "`major`.",
     "print near(volume(torus(3, 1)), 6 * pi^2) // expect: true", NUMBERS, primitives},
    {"solid(S: surface or region or mesh or list or group, within: box or range of z = none)",
     cag_solids_solid, "solid",
     "Returns the solid that closed surfaces bound: one surface, or a list or group of surfaces "
     "and regions whose edges meet. An open shell is an error that states the gap (solid-open). "
     "A closed mesh gives the solid inside; for an open mesh, the error names an open edge "
     "(mesh-open). Pieces of a quadric that were cut by a box or a range of z are closed by "
     "exact flat faces. The 10 numbers or 4 rows of a quadric (see `quadric`) give the points "
     "where its form is negative: all of them, to be limited by a set operation, or those "
     "`within` a solid or a range of z.",
     "print near(volume(solid(ellipsoid(1, 2, 3))), 8 * pi, relative: 1e-8) // expect: true\n"
     "ball = solid([1, 1, 1, 0, 0, 0, 0, 0, 0, -4])\n"
     "print contains(box(5) & ball, [1, 1, 1]), contains(box(5) & ball, [1.2, 1.2, 1.2]) // "
     "expect: "
     "true false",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), primitives},
    {"half_space(plane: plane)", cag_solids_half_space, "solid",
     "Returns the side of a plane that is opposite to its normal. It is unbounded, so limit it "
     "by a set operation. To show it as it is, is an error (solid-unbounded).",
     "half = sphere(3) & half_space(plane(origin, Z))\n"
     "print near(bounds(half).max.z, 0) // expect: true",
     CAG_TAKES(PLANE), primitives},

    // --- Set operations ---
    {"union(G: shape or group, ...)", cag_solids_union, "region or solid",
     "Returns the union of solids, given one by one or as one list, like `a | b`. Closed meshes "
     "and surfaces count as the solids inside, and a group as the union of its shapes. For "
     "POV-Ray, it is a native operation; otherwise, a mesh within the tolerance of the operands. "
     "The result has the material of the first operand.",
     "print near(volume(union(box(1), translate(box(1), [0.5, 0, 0]))), 1.5) // expect: true\n"
     "print volume([box(1), translate(box(1), [3, 0, 0])] |> union) // expect: 2",
     OPERANDS, operations},
    {"difference(G: shape or group, ...)", cag_solids_difference, "region or solid",
     "Returns the part of the first solid that is in none of the others, like `a - b`. Operands "
     "are as for `union`. If nothing is left, the solid is empty (see `is_empty`).",
     "print near(volume(difference(box(3), translate(box(1), [1, 1, 1]))), 26) // expect: true\n"
     "print volume(box(2) - translate(box(1), [5, 0, 0])) // expect: 8",
     OPERANDS, operations},
    {"intersection(G: shape or group, ...)", cag_solids_intersection, "region or solid",
     "Returns the part that is in all solids, like `a & b`. Operands are as for `union`. If "
     "nothing is left, the solid is empty (see `is_empty`).",
     "print volume(intersection(box(2), translate(box(2), [1, 1, 1]))) // expect: 1\n"
     "print volume(box(1) & translate(box(1), [3, 0, 0])) // expect: 0",
     OPERANDS, operations},
    {"clip(G: shape or group, solid: solid or plane)", cag_solids_clip, "shape",
     "Returns the part of G inside a solid, or on the side of a plane that is opposite to its "
     "normal. Solids and closed meshes give solids, and curves give pieces of curves. Surfaces, "
     "regions, and open meshes give a mesh within the tolerance of G. Groups and lists are "
     "clipped shape by shape, without the shapes that are entirely outside. If nothing is left, "
     "the result is an empty solid, mesh, or group.",
     "c = clip(line([-5, 0, 0], [5, 0, 0]), sphere(2))\n"
     "print near(length(c), 4, 1e-9) // expect: true\n"
     "print near(area(clip(rectangle(4, 4), plane(origin, X))), 8) // expect: true",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), operations},

    {"is_empty(G: shape or group)", cag_solids_is_empty, "bool",
     "Tests whether a region, solid, mesh, or list of curves is empty, or all shapes of a group "
     "or list are. The length, area, and volume of an empty shape are 0, and it can be used in "
     "set operations. Its sections and boundaries are empty lists, and an extrusion of it is an "
     "empty solid. Its bounds, centroid, and nearest point are errors (empty-shape). If it is "
     "shown, it adds nothing, and there is a warning.",
     "lost = box(1) - box(2)\n"
     "print is_empty(lost), volume(lost), volume(box(3) | lost) // expect: true 0 27\n"
     "print is_empty(circle(1) |> region), is_empty(intersect(circle(1), circle(3))) // expect: "
     "false true",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), operations},

    // --- Copies ---
    {"around(G: shape or group, n: integer, axis: vector = Z, through: point = origin)",
     cag_solids_around, "group",
     "Returns n copies of G, evenly rotated about an axis through a point.",
     "print bounds(around(translate(sphere(1), [4, 0, 0]), 2)).size.x // expect: 10",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), copies},
    {"rows(G: shape or group, n: integer, V: vector)", cag_solids_rows, "group",
     "Returns n copies of G, each translated by V from the previous one.",
     "print bounds(rows(box(1), 3, [2, 0, 0])).size // expect: [5, 1, 1]",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), copies},
    {"mirrored(G: shape or group, plane: plane)", cag_solids_mirrored, "group",
     "Returns G together with its reflection in a plane.",
     "print bounds(mirrored(box(1), plane(origin, X))).size // expect: [2, 1, 1]",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), copies},

    // --- Measures ---
    {"area(G: shape or group)", cag_solids_area, "number",
     "Returns the surface area (mm2) of a solid or mesh, or the sum for a group.",
     "print area(box([1, 2, 3])) // expect: 22", BODIES, measures},
    {"volume(G: shape or group)", cag_solids_volume, "number",
     "Returns the volume (mm3) of a solid or closed mesh, or the sum for a group. An open mesh "
     "is an error that names an open edge (mesh-open).",
     "print volume(box([1, 2, 3])) // expect: 6", BODIES, measures},
    {"centroid(G: shape or group)", cag_solids_centroid, "list",
     "Returns the center of volume of a solid, closed mesh, or group.",
     "print centroid(box([2, 4, 6])) // expect: [1, 2, 3]", BODIES, measures},
    {"inertia(G: shape or group, density: number = 1)", cag_solids_inertia, "record",
     "Returns a record with the mass (volume times density), the center, and the matrix of the "
     "moments of inertia about the center.",
     "print near(inertia(box(1)).matrix[0][0], 1 / 6) // expect: true",
     BODIES | CAG_TAKES(SURFACE) | CAG_TAKES(LIST), measures},

    // --- Meshes ---
    {"mesh(vertices: list of points, faces: list of lists of integers)", cag_solids_mesh, "mesh",
     "Returns a mesh of vertices and faces. Each face is a list of at least 3 vertex indices, "
     "counter-clockwise as seen from outside. An index out of range is an error.",
     "m = mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])\n"
     "print area(m) // expect: 0.5",
     LISTS, meshes},
    {"vertices(M: mesh)", cag_solids_vertices, "list",
     "Returns the vertices of a mesh or polyhedron.",
     "print len(vertices(mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))) // expect: 3",
     POLYHEDRA, meshes},
    {"faces(M: mesh)", cag_solids_faces, "list",
     "Returns the triangles of a mesh as lists of vertex indices.",
     "print faces(mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])) // expect: [[0, 1, 2]]",
     POLYHEDRA, meshes},
    {"normals_of(M: mesh)", cag_solids_normals_of, "list",
     "Returns the unit normal at each vertex: that of the surface from which the mesh was made, "
     "or else the mean of the adjacent faces.",
     "print normals_of(mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))[0] // expect: [0, 0, "
     "1]",
     POLYHEDRA, meshes},
    {"is_watertight(M: mesh)", cag_solids_is_watertight, "bool",
     "Tests whether each edge belongs to two faces with opposite orientations.",
     "print is_watertight(tessellate(sphere(1))) // expect: true", POLYHEDRA, meshes},
    {"euler_characteristic(M: mesh)", cag_solids_euler_characteristic, "number",
     "Returns vertices - edges + faces, which is 2 for a sphere and 0 for a torus.",
     "print euler_characteristic(tessellate(torus(3, 1))) // expect: 0", POLYHEDRA, meshes},
    {"weld(M: mesh, tolerance: length)", cag_solids_weld, "mesh",
     "Merges vertices that are closer than the tolerance (mm), also across sharp edges and "
     "seams. Normals are kept where the merged ones agree; otherwise, the mesh is flat-shaded.",
     "m = mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1e-9, 0, 0]], [[0, 1, 2], [3, 2, 1]])\n"
     "print is_watertight(weld(m, 1e-6)) // expect: true",
     MESHES, meshes},
    {"tessellate(G: shape or group, tolerance: length = none, angle: angle = 15deg, "
     "max_edge: length = none)",
     cag_solids_tessellate, "mesh",
     "Returns a triangle mesh whose distance from the true surface is at most the tolerance (mm; "
     "none: by the size of G). Along each edge, the normal turns by at most the angle, and no "
     "edge is longer than `max_edge`. The limit of the angle does not apply to edges shorter "
     "than a fifth of the tolerance, and to cusps, poles, and creases. `max_edge` applies to "
     "flat faces, set operations, and meshes as well. A curve has no faces, which is an error.",
     "m = tessellate(sphere(10), tolerance: 0.01)\n"
     "print abs(volume(m) / volume(sphere(10)) - 1) < 0.003 // expect: true",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), meshes},
    {"flip(M: mesh)", cag_solids_flip, "mesh", "Returns the mesh with reversed orientation.",
     "print normals_of(flip(mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])))[0].z // expect: "
     "-1",
     MESHES, meshes},

    // --- Figures ---
    {"control_net(S: curve or surface)", cag_solids_control_net, "group",
     "Returns the control net of a Bezier or B-spline surface as lines.",
     "S = bezier_surface([[[0, 0, 0], [0, 9, 3]], [[9, 0, 0], [9, 9, 0]]])\n"
     "print len(control_net(S).items) // expect: 4",
     CAG_TAKES(SURFACE), figures},
    {"isolines(S: surface, nu: integer, nv: integer)", cag_solids_isolines, "group",
     "Returns nu lines of constant u and nv lines of constant v on a surface, or on the side of "
     "a swept solid. They are evenly spaced and include the edges.",
     "s = bilinear([0, 0], [0, 2], [4, 0], [4, 2])\n"
     "print bounds(isolines(s, 3, 2)).max // expect: [4, 2, 0]",
     CAG_TAKES(SURFACE) | CAG_TAKES(SOLID), figures},
    {"arrow(P: point, V: vector, radius: length = none)", cag_solids_arrow, "group",
     "Returns an arrow that starts at P and extends by V. By default, its thickness depends on "
     "its length.",
     "print near(bounds(arrow(origin, [0, 0, 10])).max.z, 10) // expect: true", LISTS, figures},
    {"triad(T: transform, size: length > 0)", cag_solids_triad, "group",
     "Returns the axes of a frame as arrows of this length (mm): x red, y green, and z blue.",
     "print near(bounds(triad(identity, 5)).max.x, 5) // expect: true", CAG_TAKES(TRANSFORM),
     figures},
    {0}};
