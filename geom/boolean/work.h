// What the steps of a set operation share. Not for users of the mesh module.
//
// The operands become one set of faces: triangles over shared points. Wherever faces meet they are
// cut, until two pieces have nothing but whole edges and corners in common or are the same
// triangle. Around each edge the pieces are then sorted by angle: neighbors enclose a piece of
// space, whose winding numbers follow from piece to piece, and from one ray where they start. A
// piece that has the solid on one side only is a part of the result.
//
//   boolean.c         operands, operations of two and of many
//   boolean_points.c  points: of the operands, and where a line or planes meet, exactly
//   boolean_snap.c    corners and planes that are one within rounding
//   boolean_pairs.c   which faces meet, and in what
//   boolean_plane.c   faces cut along what they meet
//   boolean_cells.c   winding numbers
//   boolean_flat.c    flat faces in few triangles
//   boolean_result.c  the closed mesh

#ifndef CAG_GEOM_BOOLEAN_WORK_H
#define CAG_GEOM_BOOLEAN_WORK_H

#include "geom/boolean/boolean.h"
#include "geom/mesh/exact.h"

#define BOOL_NONE UINT32_MAX

// A growing array; items are of one type each.
typedef struct BoolList {
  void *items;
  size_t n, room;
} BoolList;

bool cag_bool_list_reserve(BoolList *l, size_t n, size_t item_size); // room for n items in all

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

// Points have numbers. No two numbers are one point, except those of cag_bool_points_add_far.
typedef struct BoolPoints {
  size_t n, room;
  CagVec3 *at;            // the point, each coordinate rounded to the nearest double
  uint32_t *exact;        // where in `coordinates`; BOOL_NONE: `at` is the point
  BoolList coordinates;   // of BoolHomogeneous
  BoolBlock *blocks;      // their limbs
  uint32_t *heads, *next; // a hash of `at`
  size_t mask;
  CagExactSpace space; // of one computation
} BoolPoints;

bool cag_bool_points_start(BoolPoints *p, size_t expected);
void cag_bool_points_free(BoolPoints *p);
uint32_t cag_bool_points_add(BoolPoints *p, CagVec3 at);     // BOOL_NONE: no memory; so below
uint32_t cag_bool_points_add_far(BoolPoints *p, CagVec3 at); // a help of a triangulation
// The first of the points that are rounded to the same place.
uint32_t cag_bool_points_first(const BoolPoints *p, uint32_t i);
// Signs: of b's coordinate less a's, of the first coordinate in which they differ.
int cag_bool_compare(BoolPoints *p, uint32_t a, uint32_t b, int axis);
int cag_bool_compare_all(BoolPoints *p, uint32_t a, uint32_t b);
// Positive where a, b, c turn left in the plane that is seen along the axis.
int cag_bool_turn(BoolPoints *p, uint32_t a, uint32_t b, uint32_t c, int axis);
// As cag_side_of_plane, for a plane of three corners of operands.
int cag_bool_side(BoolPoints *p, const uint32_t plane[3], uint32_t d);

// Planes that cut: of a face, or through an edge of a face and along an axis.
typedef struct BoolCut {
  uint32_t a, b, c; // c BOOL_NONE: the edge a, b and the axis
  int axis;
} BoolCut;

// The exact normal of a face's plane, and the sign of a coordinate of it.
void cag_bool_normal(BoolPoints *p, const uint32_t plane[3], CagExact normal[3]);
int cag_bool_normal_sign(BoolPoints *p, const uint32_t plane[3], int axis);
// For planes with the normals m, n: signs of m . n and of a coordinate of m x n.
int cag_bool_normals_dot(BoolPoints *p, const uint32_t m[3], const uint32_t n[3]);
int cag_bool_normals_cross(BoolPoints *p, const uint32_t m[3], const uint32_t n[3], int axis);

// The point of the line a, b (corners of operands on two sides of the plane) in the plane.
uint32_t cag_bool_points_cross(BoolPoints *p, uint32_t a, uint32_t b, const uint32_t plane[3]);
// The point in which three planes meet; they do meet in one.
uint32_t cag_bool_points_meet(BoolPoints *p, const uint32_t plane[3], BoolCut one, BoolCut two);
// Point i moved onto n planes (1 to 3), along the axes that are not kept: 3 - n coordinates stay as
// they are. Planes and kept axes are independent.
uint32_t cag_bool_points_put(BoolPoints *p, uint32_t i, const uint32_t (*planes)[3], int n,
                             const int kept[2]);
uint32_t cag_bool_points_centroid(BoolPoints *p, const uint32_t v[3]);

// --- Faces and pieces ---

typedef struct BoolFace {
  uint32_t v[3];
  uint32_t plane[3];        // points of its plane, in the same sense: its corners, or others
  int32_t times[2];         // how often operand a (b) has the face; turned ones count -1
  uint32_t owner, triangle; // operand and its triangle whose sense v has
  signed char axis, sign;   // an axis along which it is seen with area, and the sign of that area
} BoolFace;

// A face meets another in a point (a == b) or a segment, which `cut` has too.
typedef struct BoolContact {
  uint32_t face, a, b;
  BoolCut cut;
} BoolContact;

// A part of a face.
typedef struct BoolPiece {
  uint32_t v[3];
  uint32_t plane; // the face in whose plane and sense it lies
  int32_t times[2];
  uint32_t face;      // which it is part of, for normals
  signed char facing; // 1: in that face's sense; -1: turned
} BoolPiece;

// A face whose plane, normals and material a part has; back: the part runs against it.
typedef struct BoolSource {
  uint32_t face;
  bool back;
} BoolSource;

// A triangle of the result; source: that of each corner, as numbers of a list.
typedef struct BoolPart {
  uint32_t v[3], source[3];
  uint32_t origin; // the triangle that it was split from, or itself
} BoolPart;

typedef struct BoolWork {
  const CagMesh *meshes[2];
  bool whole; // flat faces stay in the triangles that the cuts leave
  const volatile int *interrupt;
  CagError *err;
  BoolPoints points;
  size_t corners; // points 0 .. corners - 1 are those of the operands, as given and as snapped
  BoolFace *faces;
  size_t face_count;
  double slack;           // faces closer than this may be in one plane
  struct BoolNode *nodes; // a tree of boxes over `order`
  uint32_t *order;        // of the faces
  CagBounds *boxes;       // in that order
  uint32_t *plane_of;     // forest of the faces that overlap others of their plane
  uint8_t *touched;       // of faces, by bits: edges (from corner k on) along which another runs
  BoolList contacts;      // of BoolContact
  BoolList pieces;        // of BoolPiece
  int32_t (*winding)[2];  // in front of each piece
} BoolWork;

static inline BoolPiece *bool_pieces(const BoolWork *w) { return w->pieces.items; }

CagStatus cag_bool_stopped(const BoolWork *w); // CAG_E_CALLBACK if the work must stop

// Calls `visit` with each pair of faces whose boxes are at most twice the slack apart. Returns
// false if memory ran out.
typedef bool BoolPairVisit(void *context, uint32_t f, uint32_t g);
CagStatus cag_bool_visit_pairs(BoolWork *w, BoolPairVisit *visit, void *context);
// Forgets the boxes: faces have changed.
void cag_bool_forget_pairs(BoolWork *w);

// Finds which points of the operands are one within rounding: number[i] is the first of them.
// *found: there are some.
CagStatus cag_bool_find_twins(BoolWork *w, uint32_t *number, bool *found);
// Finds the planes that faces of both operands have in common within rounding, and gives the
// numbers of their corners on these planes; the points of planes go to `plane`, 3 for each face,
// BOOL_NONE where it has no such plane.
CagStatus cag_bool_find_planes(BoolWork *w, uint32_t *number, uint32_t *plane, bool *found);
CagStatus cag_bool_find_contacts(BoolWork *w);
CagStatus cag_bool_cut_faces(BoolWork *w);
CagStatus cag_bool_find_windings(BoolWork *w);
// Flat faces that so many triangles meet in one point of are given rounder triangles before the
// cut: two such fans, one on the other, would cross as often as the product of their triangles.
#define BOOL_FAN 48

// Gives flat faces of the parts few triangles and replaces *parts. If only_fans is set, only fans
// are triangulated again, and their outlines keep all points. Returns false if memory ran out or
// the caller canceled.
bool cag_bool_flatten(BoolWork *w, const BoolSource *sources, bool only_fans, BoolPart **parts,
                      size_t *n);
CagStatus cag_bool_build(BoolWork *w, CagSetOperation op, CagMesh **out);

// Calls with the faces whose boxes the ray from `from` along +x may meet.
typedef void BoolRayVisit(void *context, uint32_t face);
void cag_bool_visit_ray(const BoolWork *w, CagVec3 from, BoolRayVisit *visit, void *context);
// Is v, in the plane of f, in f or on its edge?
bool cag_bool_is_in_face(BoolWork *w, const BoolFace *f, uint32_t v);
uint32_t cag_bool_root(uint32_t *parent, uint32_t i);

#endif
