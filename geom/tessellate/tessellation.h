// The internals of tessellation: the data that its steps share.
//
// A face's parameter rectangle is cut at the breaks into smooth cells, and these are bisected into
// leaves where the curvature varies (plan.c). A leaf has a grid of nu x nv quadrilaterals. The
// sides of leaves lie on lines, u = const or v = const. Each line is divided only once for the
// leaves on both of its sides: a seam once for both ends of the domain, and an edge of a solid once
// for both faces (lines.c, even.c). The nodes of lines become vertices (nodes.c). Then each leaf's
// grid is filled in and stitched to the nodes around it (fill.c), the sides of cusps get separate
// normals (sides.c), edges of triangles that lean away from the surface are flipped (turn_edges.c),
// and planar faces are triangulated from the nodes of their loops (planar.c).
//
// If the surface bends least along lines that cross both families of parameter lines at an angle,
// as on a thread, whole cells become strips instead of leaves with grids (strips.c). A strip is a
// leaf without interior points. Its long sides are lines along one parameter. The nodes on all of
// its sides lie where lines of least bending, called slants, meet them.
//
// Vertices of lines come first in the mesh, interiors of leaves after them. While it is built,
// `weld` is a union-find forest over the vertices of lines whose roots are the members with the
// lowest index.

#ifndef CAG_GEOM_TESSELLATE_TESSELLATION_H
#define CAG_GEOM_TESSELLATE_TESSELLATION_H

#include "geom/tessellate/tessellate.h"

#define NO_INDEX UINT32_MAX

enum { SIDE_U0, SIDE_U1, SIDE_V0, SIDE_V1 };

// The slants of a strip are given by along - slope * (across - from[across]) = phase + k * step,
// where `along` is the parameter of the direction `along` and `across` is the other parameter.
typedef struct Slants {
  int along;
  double slope, phase, step; // step > 0 in a strip, else 0
} Slants;

typedef struct Leaf {
  double from[2], to[2];     // [0]: u, [1]: v
  Slants slants;             // of a strip; its n are 1
  uint32_t n[2], planned[2]; // current, and before cag_tess_make_even_lines
  uint32_t face;
  uint32_t line[4];     // by side
  size_t nodes[4];      // index of the side's first node among all nodes
  uint32_t segments[4]; // of the side
  bool regular;         // the sides' nodes coincide with those of the grid
} Leaf;

// A piece of a line between two neighboring leaf corners (on either side), in n equal steps.
typedef struct Atom {
  double from, to;
  double needed; // number of steps, before rounding up
  uint32_t n;
  bool corner; // `from` is a corner of a leaf of this face
} Atom;

// A line with fixed `coordinate` in direction `fixed` (0: u, 1: v). The leaves before it (lower
// coordinates) and after it use the vertices of nodes for their side. At a seam the leaves before
// it are those at the far end of the domain, with the coordinate `before`.
typedef struct Line {
  uint32_t face;
  int fixed;
  double coordinate, before;
  bool seam, pole, border, is_break; // border: an end of the domain that is not a seam or pole
  size_t atom, atom_count;
  size_t node, node_count; // node_count = sum of n + 1
  uint32_t joined;         // line of another face with the same nodes, or NO_INDEX
  bool joined_reversed;
  double *own_parameters; // of nodes, if the parameters of joined lines are not related by a
                          // piecewise affine map; else NULL
} Line;

// Parameter along the line, and the vertices for leaves before [0] and after [1] it; at a leaf
// corner the vertices are in the corner table.
typedef struct Node {
  double t;
  uint32_t vertex[2];
  uint32_t corner;
} Node;

// quadrant[2 * (after the v-line) + (after the u-line)]
typedef struct Corner {
  double u, v;
  uint32_t face;
  uint32_t quadrant[4];
} Corner;

typedef struct Face {
  const CagSurface *surface;
  bool planar;
  double *breaks[2]; // including both ends of the domain
  size_t break_count[2];
  size_t leaf, leaf_count;
  size_t line, line_count;
  uint32_t *triangles; // of planar faces only
  size_t triangle_count;
} Face;

typedef struct Tessellator {
  CagTessellation how; // tolerance > 0
  double size;         // diagonal of the bounds
  double noise;        // points closer than this are equal up to rounding
  bool is_point;       // the whole surface is one point: the mesh may be empty
  Face *faces;
  size_t face_count;
  Leaf *leaves;
  size_t leaf_count, leaf_capacity;
  double quads; // of all leaves
  Line *lines;
  size_t line_count, line_capacity;
  Atom *atoms;
  size_t atom_count, atom_capacity;
  Node *nodes;
  size_t node_count;
  Corner *corners;
  size_t corner_count, corner_capacity;
  uint32_t *corner_hash;
  size_t corner_mask;
  // Vertices of lines and planar faces.
  CagVec3 *positions, *normals;
  double *uv;
  uint32_t *weld;
  size_t vertex_count, vertex_capacity;
  uint32_t *own; // vertices of planar faces that are not shared with another face
  size_t own_count, own_capacity;
  bool needs_normals; // some vertex still has a zero normal
} Tessellator;

// The length up to which edges are exempt from the angle. There must be one, because at a cusp the
// normal jumps.
static inline double tess_short_edge(const CagTessellation *how) {
  return (how->short_edge > 0 ? how->short_edge : 0.2) * how->tolerance;
}

CagStatus cag_tess_interrupted(const Tessellator *t, CagError *err);
CagStatus cag_tess_limit(const Tessellator *t, double triangles, CagError *err);

CagStatus cag_tess_plan_face(Tessellator *t, uint32_t face, CagError *err);
// Replaces cells with strips if these take clearly fewer triangles than the leaves found by
// cag_tess_plan_face.
CagStatus cag_tess_plan_strips(Tessellator *t, uint32_t face, CagError *err);
CagStatus cag_tess_make_lines(Tessellator *t, uint32_t face, CagError *err);
// Like cag_tess_make_lines, but raises the counts of thin leaves to those of their neighbors.
CagStatus cag_tess_make_even_lines(Tessellator *t, uint32_t face, CagError *err);
// Refines the atoms of a line that is a border or a crease until its chords are within the
// tolerance.
CagStatus cag_tess_refine_chords(Tessellator *t, Line *line, CagError *err);
// Index of the line on a side of a face; NO_INDEX if the face is planar or the side is a pole or
// seam.
uint32_t cag_tess_side_line(const Tessellator *t, uint32_t face, int side);
CagStatus cag_tess_join_lines(Tessellator *t, uint32_t master, uint32_t slave, bool reversed,
                              CagError *err);
CagStatus cag_tess_make_nodes(Tessellator *t, CagError *err);
CagStatus cag_tess_planar_face(Tessellator *t, uint32_t face, const CagFaces *faces, CagError *err);
// Merges corners of planar faces of a solid that coincide.
CagStatus cag_tess_unite_corners(Tessellator *t, CagError *err);
CagStatus cag_tess_fill(Tessellator *t, CagMesh **out, CagError *err);
// Flips edges of triangles that lean away from the surface.
CagStatus cag_tess_turn_edges(const Tessellator *t, CagMesh *m, CagError *err);

CagStatus cag_tess_new_vertex(Tessellator *t, CagVec3 position, CagVec3 normal, double u, double v,
                              uint32_t *out, CagError *err);
uint32_t cag_tess_find(Tessellator *t, uint32_t vertex);
void cag_tess_unite(Tessellator *t, uint32_t a, uint32_t b);
// The vertex that the leaves of the line's own face after (or before) it use for a node.
uint32_t cag_tess_node_vertex(const Tessellator *t, const Line *line, const Node *node, bool after,
                              bool node_is_end);
static inline bool tess_is_strip(const Leaf *leaf) { return leaf->slants.step > 0; }

static inline double tess_mix(double a, double b, size_t k, size_t n) {
  return k == 0 ? a : k == n ? b : a + (b - a) * ((double)k / (double)n);
}

// Whether the quadrilateral a b c d is cut from a to c (else from b to d), by the shorter diagonal.
// Diagonals that are equal to rounding are cut from a to c, so that moved copies of a shape are cut
// alike.
static inline bool tess_cut_ac(CagVec3 a, CagVec3 b, CagVec3 c, CagVec3 d) {
  const double alike = 1e-6; // relative, of the squares; the rounding of coordinates far from the
                             // origin is smaller
  CagVec3 ac = cag_sub(c, a), bd = cag_sub(d, b);
  return cag_dot(ac, ac) <= cag_dot(bd, bd) * (1 + alike);
}

#endif
