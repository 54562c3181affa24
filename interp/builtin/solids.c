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
     "A cube of this size (mm), or a box of [x, y, z], with a corner in the origin or its center "
     "there. A size that is not greater than 0 is an error.",
     "print volume(box([1, 2, 3])), bounds(box(2, centered: true)).min // expect: 6 [-1, -1, -1]",
     NUMBERS | CAG_TAKES(LIST), primitives},
    {"sphere(radius: length > 0)", cag_solids_sphere, "solid", "The ball about the origin.",
     "print near(volume(sphere(3)), 36 * pi) // expect: true", NUMBERS, primitives},
    {"cylinder(height: length > 0, radius: length >= 0, top: length >= 0 = radius, "
     "centered: bool = false)",
     cag_solids_cylinder, "solid",
     "A cylinder standing on z = 0, or with the middle of its axis in the origin; with another "
     "radius on top a frustum, with 0 a cone.",
     "print near(volume(cylinder(5, 2)), 20 * pi) // expect: true\n"
     "print bounds(cylinder(4, 1, centered: true)).min // expect: [-1, -1, -2]",
     NUMBERS, primitives},
    {"cone(height: length > 0, radius: length > 0, centered: bool = false)", cag_solids_cone,
     "solid", "A cone standing on z = 0, or with the middle of its axis in the origin.",
     "print near(volume(cone(3, 2)), 4 * pi) // expect: true", NUMBERS, primitives},
    {"prism(region: region or closed curve or list of points, height: length, "
     "centered: bool = false)",
     cag_solids_prism, "solid",
     "A region, closed plane curve or list of points carried up by the height (mm). Centered, the "
     "prism reaches as far below the region as above it.",
     "print near(volume(prism([[0, 0], [4, 0], [0, 3]], 5)), 30) // expect: true\n"
     "print bounds(prism(rectangle(2, 2), 4, centered: true)).max // expect: [1, 1, 2]",
     CAG_TAKES(REGION) | CAG_TAKES(CURVE) | CAG_TAKES(LIST), primitives},
    {"rod(P: point, Q: point, radius: length >= 0, top: length >= 0 = radius)", cag_solids_rod,
     "solid",
     "A cylinder from P to Q; with another radius at Q a frustum or cone. One point twice is an "
     "error.",
     "print near(volume(rod(origin, [0, 3, 4], 1)), 5 * pi) // expect: true", LISTS, primitives},
    {"torus(major: length > 0, minor: length > 0)", cag_solids_torus, "solid",
     "The ring about Z: a disc of radius `minor` turned at the radius `major`.",
     "print near(volume(torus(3, 1)), 6 * pi^2) // expect: true", NUMBERS, primitives},
    {"solid(S: surface or region or mesh or list or group, within: box or range of z = none)",
     cag_solids_solid, "solid",
     "The body within closed surfaces: one, or a list or group of surfaces and regions whose edges "
     "meet. An open shell is an error that tells the gap (solid-open). Of a closed mesh the body "
     "in "
     "it, otherwise the error names an open edge (mesh-open). Pieces of a quadric cut by a box or "
     "a range of z are closed by exact flat faces. The 10 numbers or 4 rows of a quadric (see "
     "`quadric`) mean the side where its form is "
     "negative: all of it, to be cut by what it is intersected with or taken from, or the part "
     "`within` a solid or a range of z.",
     "print near(volume(solid(ellipsoid(1, 2, 3))), 8 * pi, relative: 1e-8) // expect: true\n"
     "ball = solid([1, 1, 1, 0, 0, 0, 0, 0, 0, -4])\n"
     "print contains(box(5) & ball, [1, 1, 1]), contains(box(5) & ball, [1.2, 1.2, 1.2]) // "
     "expect: "
     "true false",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), primitives},
    {"half_space(plane: plane)", cag_solids_half_space, "solid",
     "The side of a plane that its normal leaves, without end. It is cut by what it is intersected "
     "with or taken from; shown alone it is an error (solid-unbounded).",
     "half = sphere(3) & half_space(plane(origin, Z))\n"
     "print near(bounds(half).max.z, 0) // expect: true",
     CAG_TAKES(PLANE), primitives},

    // --- Set operations ---
    {"union(G: shape or group, ...)", cag_solids_union, "region or solid",
     "What lies in any of the solids, given one by one or as one list; `a | b`. Closed meshes and "
     "surfaces count as the bodies in them, a group as the union of its shapes. POV-Ray gets an "
     "operation of its own, everything else a mesh whose operands keep the tolerance. The result "
     "takes what was said of the material of the first.",
     "print near(volume(union(box(1), translate(box(1), [0.5, 0, 0]))), 1.5) // expect: true\n"
     "print volume([box(1), translate(box(1), [3, 0, 0])] |> union) // expect: 2",
     OPERANDS, operations},
    {"difference(G: shape or group, ...)", cag_solids_difference, "region or solid",
     "What lies in the first solid and in none of the others; `a - b`. Operands as of `union`. "
     "When "
     "nothing is left the solid is empty (see `is_empty`).",
     "print near(volume(difference(box(3), translate(box(1), [1, 1, 1]))), 26) // expect: true\n"
     "print volume(box(2) - translate(box(1), [5, 0, 0])) // expect: 8",
     OPERANDS, operations},
    {"intersection(G: shape or group, ...)", cag_solids_intersection, "region or solid",
     "What lies in all of the solids; `a & b`. Operands as of `union`. When nothing is left the "
     "solid is empty (see `is_empty`).",
     "print volume(intersection(box(2), translate(box(2), [1, 1, 1]))) // expect: 1\n"
     "print volume(box(1) & translate(box(1), [3, 0, 0])) // expect: 0",
     OPERANDS, operations},
    {"clip(G: shape or group, solid: solid or plane)", cag_solids_clip, "shape",
     "The part of G within a solid, or behind a plane: on the side opposite to its normal. Solids "
     "and "
     "closed meshes give solids, curves the pieces of them, surfaces, regions and open meshes the "
     "mesh of what lies inside, to the tolerance of G. Groups and lists are clipped shape by "
     "shape; "
     "a shape that lies outside is left out. When nothing is left of a solid, the solid is empty; "
     "of a "
     "surface, region or open mesh, the mesh; of curves, groups and lists, the group.",
     "c = clip(line([-5, 0, 0], [5, 0, 0]), sphere(2))\n"
     "print near(length(c), 4, 1e-9) // expect: true\n"
     "print near(area(clip(rectangle(4, 4), plane(origin, X))), 8) // expect: true",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), operations},

    {"is_empty(G: shape or group)", cag_solids_is_empty, "bool",
     "Whether nothing is left of a region, solid or mesh, or of all shapes of a group or list; "
     "also "
     "of the list of an intersection. Empty shapes are values: their length, area and volume are "
     "0, "
     "set operations go on with them, sections and boundaries of them are empty lists, an "
     "extrusion "
     "of one is an empty solid. Bounds, a centroid and the nearest point are the error "
     "empty-shape. "
     "Showing one adds nothing, with a warning.",
     "lost = box(1) - box(2)\n"
     "print is_empty(lost), volume(lost), volume(box(3) | lost) // expect: true 0 27\n"
     "print is_empty(circle(1) |> region), is_empty(intersect(circle(1), circle(3))) // expect: "
     "false true",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), operations},

    // --- Copies ---
    {"around(G: shape or group, n: integer, axis: vector = Z, through: point = origin)",
     cag_solids_around, "group", "n copies of G, turned evenly about an axis through a point.",
     "print bounds(around(translate(sphere(1), [4, 0, 0]), 2)).size.x // expect: 10",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), copies},
    {"rows(G: shape or group, n: integer, V: vector)", cag_solids_rows, "group",
     "n copies of G, each moved by V from the one before.",
     "print bounds(rows(box(1), 3, [2, 0, 0])).size // expect: [5, 1, 1]",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), copies},
    {"mirrored(G: shape or group, plane: plane)", cag_solids_mirrored, "group",
     "G and its image in a plane.",
     "print bounds(mirrored(box(1), plane(origin, X))).size // expect: [2, 1, 1]",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), copies},

    // --- Measures ---
    {"area(G: shape or group)", cag_solids_area, "number",
     "The area of the surface of a solid or mesh, in mm2; of a group the sum.",
     "print area(box([1, 2, 3])) // expect: 22", BODIES, measures},
    {"volume(G: shape or group)", cag_solids_volume, "number",
     "The volume of a solid or closed mesh, in mm3; of a group the sum. An open mesh is an error "
     "that names an open edge (mesh-open).",
     "print volume(box([1, 2, 3])) // expect: 6", BODIES, measures},
    {"centroid(G: shape or group)", cag_solids_centroid, "list",
     "The center of volume of a solid, closed mesh or group.",
     "print centroid(box([2, 4, 6])) // expect: [1, 2, 3]", BODIES, measures},
    {"inertia(G: shape or group, density: number = 1)", cag_solids_inertia, "record",
     "mass (volume times density), center, and matrix: the moments of inertia about the center.",
     "print near(inertia(box(1)).matrix[0][0], 1 / 6) // expect: true",
     BODIES | CAG_TAKES(SURFACE) | CAG_TAKES(LIST), measures},

    // --- Meshes ---
    {"mesh(vertices: list of points, faces: list of lists of integers)", cag_solids_mesh, "mesh",
     "A mesh of points and faces: each face a list of 3 or more numbers of vertices, "
     "counter-clockwise seen from outside. A number that is not a vertex is an error.",
     "m = mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])\n"
     "print area(m) // expect: 0.5",
     LISTS, meshes},
    {"vertices(M: mesh)", cag_solids_vertices, "list", "The points of a mesh or of a polyhedron.",
     "print len(vertices(mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))) // expect: 3",
     POLYHEDRA, meshes},
    {"faces(M: mesh)", cag_solids_faces, "list", "The triangles of a mesh, as numbers of vertices.",
     "print faces(mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])) // expect: [[0, 1, 2]]",
     POLYHEDRA, meshes},
    {"normals_of(M: mesh)", cag_solids_normals_of, "list",
     "The unit normal at each vertex: of the surface that the mesh was made of, else the mean of "
     "the faces around.",
     "print normals_of(mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))[0] // expect: [0, 0, "
     "1]",
     POLYHEDRA, meshes},
    {"is_watertight(M: mesh)", cag_solids_is_watertight, "bool",
     "Whether each edge has two faces that run it in opposite senses.",
     "print is_watertight(tessellate(sphere(1))) // expect: true", POLYHEDRA, meshes},
    {"euler_characteristic(M: mesh)", cag_solids_euler_characteristic, "number",
     "Vertices - edges + faces: 2 of a sphere, 0 of a torus.",
     "print euler_characteristic(tessellate(torus(3, 1))) // expect: 0", POLYHEDRA, meshes},
    {"weld(M: mesh, tolerance: length)", cag_solids_weld, "mesh",
     "The mesh with vertices nearer than the tolerance (mm) made one, also across sharp edges and "
     "seams. Normals stay where the joined ones agree, else the mesh is shaded by its faces.",
     "m = mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1e-9, 0, 0]], [[0, 1, 2], [3, 2, 1]])\n"
     "print is_watertight(weld(m, 1e-6)) // expect: true",
     MESHES, meshes},
    {"tessellate(G: shape or group, tolerance: length = none, angle: angle = 15deg, "
     "max_edge: length = none)",
     cag_solids_tessellate, "mesh",
     "Triangles whose distance from the true surface is at most the tolerance (mm; none: by the "
     "size of G), along whose edges the normal turns by at most the angle, and whose edges are at "
     "most `max_edge` long. The angle has two exceptions: edges shorter than a fifth of the "
     "tolerance, and cusps, poles and creases, where the normal turns at one point. "
     "`max_edge` has none: flat faces, set operations and meshes keep it as well. A curve has no "
     "faces: an error.",
     "m = tessellate(sphere(10), tolerance: 0.01)\n"
     "print abs(volume(m) / volume(sphere(10)) - 1) < 0.003 // expect: true",
     CAG_TAKES_SHAPES | CAG_TAKES(LIST), meshes},
    {"flip(M: mesh)", cag_solids_flip, "mesh", "The mesh turned inside out.",
     "print normals_of(flip(mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])))[0].z // expect: "
     "-1",
     MESHES, meshes},

    // --- Figures ---
    {"control_net(S: curve or surface)", cag_solids_control_net, "group",
     "The net of control points of a Bezier or B-spline surface, as lines.",
     "S = bezier_surface([[[0, 0, 0], [0, 9, 3]], [[9, 0, 0], [9, 9, 0]]])\n"
     "print len(control_net(S).items) // expect: 4",
     CAG_TAKES(SURFACE), figures},
    {"isolines(S: surface, nu: integer, nv: integer)", cag_solids_isolines, "group",
     "nu lines where u is fixed and nv lines where v is, evenly over the surface or the side of a "
     "swept solid, both ends in.",
     "s = bilinear([0, 0], [0, 2], [4, 0], [4, 2])\n"
     "print bounds(isolines(s, 3, 2)).max // expect: [4, 2, 0]",
     CAG_TAKES(SURFACE) | CAG_TAKES(SOLID), figures},
    {"arrow(P: point, V: vector, radius: length = none)", cag_solids_arrow, "group",
     "An arrow at P along V; none: a shaft as thick as suits its length.",
     "print near(bounds(arrow(origin, [0, 0, 10])).max.z, 10) // expect: true", LISTS, figures},
    {"triad(T: transform, size: length)", cag_solids_triad, "group",
     "The axes of a frame as arrows of this size (mm): x red, y green, z blue.",
     "print near(bounds(triad(identity, 5)).max.x, 5) // expect: true", CAG_TAKES(TRANSFORM),
     figures},
    {0}};
