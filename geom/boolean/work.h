// Data shared by the steps of a set operation. Internal to the boolean module.
//
// The operands become one set of faces: triangles over shared points. Faces that meet are cut until
// any two pieces share only whole edges and corners, or are the same triangle. The pieces around
// each edge are then sorted by angle. Two neighbors enclose a wedge of space, so winding numbers
// propagate from piece to piece, starting from one ray per component. A piece with the solid on
// exactly one side belongs to the result.
//
//   boolean.c  operands; operations on two and on many meshes
//   points.c   points: those of the operands, and exact intersections of lines and planes
//   snap.c     corners and planes that coincide within rounding
//   pairs.c    which faces meet, and in what
//   plane.c    cutting faces along their intersections
//   cells.c    winding numbers
//   flat.c     merging the triangles of flat faces
//   result.c   the closed mesh

#ifndef CAG_GEOM_BOOLEAN_WORK_H
#define CAG_GEOM_BOOLEAN_WORK_H

#include "geom/boolean/boolean.h"
#include "geom/mesh/box_tree.h"
#include "geom/mesh/exact.h"

#define BOOL_NONE UINT32_MAX

// A growing array; all items of a list have one type.
typedef struct BoolList {
  void *items;
  size_t n, room;
} BoolList;

bool cag_bool_list_reserve(BoolList *l, size_t n, size_t item_size); // room for n items in total

// --- Points ---

// x / w, y / w, z / w; w > 0.
typedef struct BoolHomogeneous {
  CagExact x, y, z, w;
} BoolHomogeneous;

typedef struct BoolBlock {
  struct BoolBlock *next;
  size_t used, size;
  uint64_t limbs[];
} BoolBlock;

// Points are numbered. Two numbers never denote the same point, except for those of
// cag_bool_points_add_far.
typedef struct BoolPoints {
  size_t n, room;
  CagVec3 *at;            // each point with its coordinates rounded to the nearest double
  uint32_t *exact;        // index into `coordinates`; BOOL_NONE: `at` is exact
  BoolList coordinates;   // of BoolHomogeneous
  BoolBlock *blocks;      // their limbs
  uint32_t *heads, *next; // a hash table over `at`
  size_t mask;
  CagExactSpace space; // scratch space of one computation
} BoolPoints;

bool cag_bool_points_start(BoolPoints *p, size_t expected);
void cag_bool_points_free(BoolPoints *p);
uint32_t cag_bool_points_add(BoolPoints *p, CagVec3 at);     // BOOL_NONE: out of memory; so below
uint32_t cag_bool_points_add_far(BoolPoints *p, CagVec3 at); // an auxiliary point of a
                                                             // triangulation
// The first of the points that round to the same location.
uint32_t cag_bool_points_first(const BoolPoints *p, uint32_t i);
// Signs of b's coordinate minus a's: along the axis, or in the first coordinate that differs.
int cag_bool_compare(BoolPoints *p, uint32_t a, uint32_t b, int axis);
int cag_bool_compare_all(BoolPoints *p, uint32_t a, uint32_t b);
// Positive if a, b, c turn left in the plane as seen along the axis.
int cag_bool_turn(BoolPoints *p, uint32_t a, uint32_t b, uint32_t c, int axis);
// Like cag_side_of_plane, for a plane through three corners of operands.
int cag_bool_side(BoolPoints *p, const uint32_t plane[3], uint32_t d);

// A cutting plane: that of a face, or one through an edge of a face and parallel to an axis.
typedef struct BoolCut {
  uint32_t a, b, c; // c BOOL_NONE: through the edge a, b, parallel to the axis
  int axis;
} BoolCut;

// The exact normal of a face's plane, and the sign of one of its coordinates.
void cag_bool_normal(BoolPoints *p, const uint32_t plane[3], CagExact normal[3]);
int cag_bool_normal_sign(BoolPoints *p, const uint32_t plane[3], int axis);
// For planes with normals m and n: the signs of m . n, and of a coordinate of m x n.
int cag_bool_normals_dot(BoolPoints *p, const uint32_t m[3], const uint32_t n[3]);
int cag_bool_normals_cross(BoolPoints *p, const uint32_t m[3], const uint32_t n[3], int axis);

// The intersection of the line a, b (corners of operands on opposite sides of the plane) with the
// plane.
uint32_t cag_bool_points_cross(BoolPoints *p, uint32_t a, uint32_t b, const uint32_t plane[3]);
// The intersection of three planes, which must be a single point.
uint32_t cag_bool_points_meet(BoolPoints *p, const uint32_t plane[3], BoolCut one, BoolCut two);
// Point i moved onto n planes (1 to 3) along the axes that are not kept; 3 - n coordinates stay
// unchanged. The planes and the kept axes must be independent.
uint32_t cag_bool_points_put(BoolPoints *p, uint32_t i, const uint32_t (*planes)[3], int n,
                             const int kept[2]);
uint32_t cag_bool_points_centroid(BoolPoints *p, const uint32_t v[3]);

// --- Faces and pieces ---

typedef struct BoolFace {
  uint32_t v[3];
  uint32_t plane[3];        // points that span its plane in the same orientation: its corners, or
                            // others
  int32_t times[2];         // how often operand a (b) has the face; reversed faces count -1
  uint32_t owner, triangle; // operand and its triangle that v is oriented like
  signed char axis, sign;   // an axis along which its projection has area, and the sign of that
                            // area
} BoolFace;

// A face meets another in a point (a == b) or in a segment that also lies in the plane `cut`.
typedef struct BoolContact {
  uint32_t face, a, b;
  BoolCut cut;
} BoolContact;

// A part of a face.
typedef struct BoolPiece {
  uint32_t v[3];
  uint32_t plane; // the face whose plane and orientation it has
  int32_t times[2];
  uint32_t face;      // the face it is part of, for normals
  signed char facing; // 1: oriented like that face; -1: reversed
} BoolPiece;

// The face that a part takes its plane, normals, and material from. back: the part is oriented
// against it.
typedef struct BoolSource {
  uint32_t face;
  bool back;
} BoolSource;

// A triangle of the result. source: for each corner, an index into a list of BoolSource.
typedef struct BoolPart {
  uint32_t v[3], source[3];
  uint32_t origin; // the triangle that it was split from, or itself
} BoolPart;

typedef struct BoolWork {
  const CagMesh *meshes[2];
  bool whole; // flat faces keep the triangles left by the cuts
  const volatile int *interrupt;
  CagError *err;
  BoolPoints points;
  size_t corners; // points 0 .. corners - 1 are those of the operands, as given and as snapped
  BoolFace *faces;
  size_t face_count;
  double slack;          // faces closer than this may be coplanar
  CagBoxTree tree;       // of the faces
  uint32_t *plane_of;    // union-find forest of the faces that overlap others in their plane
  uint8_t *touched;      // for each face, bits for the edges (starting at corner k) along which
                         // another edge runs
  BoolList contacts;     // of BoolContact
  BoolList pieces;       // of BoolPiece
  int32_t (*winding)[2]; // winding numbers in front of each piece
} BoolWork;

static inline BoolPiece *bool_pieces(const BoolWork *w) { return w->pieces.items; }

CagStatus cag_bool_stopped(const BoolWork *w); // CAG_E_CALLBACK if the work must stop

// Calls `visit` for each pair of faces whose boxes are at most twice the slack apart. Returns false
// if memory ran out.
typedef bool BoolPairVisit(void *context, uint32_t f, uint32_t g);
CagStatus cag_bool_visit_pairs(BoolWork *w, BoolPairVisit *visit, void *context);
// Discards the boxes after faces have changed.
void cag_bool_forget_pairs(BoolWork *w);

// Finds points of the operands that coincide within rounding: number[i] is the first of them.
// *found: there are some.
CagStatus cag_bool_find_twins(BoolWork *w, uint32_t *number, bool *found);
// Finds the planes that faces of both operands share within rounding, and assigns the numbers of
// their corners on these planes. `plane` receives the points that span the plane, 3 for each face,
// BOOL_NONE if it has no such plane.
CagStatus cag_bool_find_planes(BoolWork *w, uint32_t *number, uint32_t *plane, bool *found);
CagStatus cag_bool_find_contacts(BoolWork *w);
CagStatus cag_bool_cut_faces(BoolWork *w);
CagStatus cag_bool_find_windings(BoolWork *w);
// If this many triangles of a flat face meet in one point, the face gets better shaped triangles
// before the cut: two such fans on top of each other would cross as often as the product of their
// triangle counts.
#define BOOL_FAN 48

// Merges the triangles of flat faces and replaces *parts. If only_fans is set, only fans are
// retriangulated, and their outlines keep all points. Returns false if memory ran out or the caller
// canceled.
bool cag_bool_flatten(BoolWork *w, const BoolSource *sources, bool only_fans, BoolPart **parts,
                      size_t *n);
CagStatus cag_bool_build(BoolWork *w, CagSetOperation op, CagMesh **out);

// Whether v, a point in the plane of f, lies in f or on its boundary.
bool cag_bool_is_in_face(BoolWork *w, const BoolFace *f, uint32_t v);
uint32_t cag_bool_root(uint32_t *parent, uint32_t i);

#endif
