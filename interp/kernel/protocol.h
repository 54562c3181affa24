// The messages between cag and the helper program cag-brep, which computes the boundaries of solids
// with Open CASCADE. Included by both (C and C++).
//
// Both run on one machine, so numbers are in its own order and size. A message is a header of two
// 64-bit integers, its type (CagBrepMessage) and the number of bytes that follow, and these bytes: a
// sequence of fields without padding.
//
//   u32         32-bit unsigned integer
//   f64         64-bit IEEE number
//   vec         3 f64
//   text        u32 length, then the bytes, UTF-8, without a final zero
//   bytes       u32 length, then the bytes
//   frame       vec origin, x, y, z: orthonormal, right-handed
//   placement   12 f64: the rows of an affine map, the last column is the translation
//   curve       u32 kind (CagBrepCurveKind), then its fields, see there. Curves in space have points
//               of 3 f64; curves in the parameters of a surface have points of 2 f64
//   surface     u32 kind (CagBrepSurfaceKind), then its fields
//   solid       u32 kind (CagBrepSolidKind), then its fields, then a placement
//   region      u32 loops, the first is the outer one; each: u32 curves, then per curve: curve (in
//               the plane: points of 2 f64), f64 first, f64 last. The curves of a loop join, in
//               order
//
// The helper starts by sending HELLO. Then it answers each request by one RESULT or one FAILURE. It
// ends when its input ends. Lengths are millimeters, angles radians.

#ifndef CAG_INTERP_KERNEL_PROTOCOL_H
#define CAG_INTERP_KERNEL_PROTOCOL_H

// Changes with every change of this file. A helper with another number is refused.
#define CAG_BREP_PROTOCOL 3

typedef enum CagBrepMessage {
  // From the helper.
  CAG_BREP_HELLO = 1,  // u32 CAG_BREP_PROTOCOL, text version of cag-brep, text version of the
                       // kernel
  CAG_BREP_RESULT = 2, // u32 solids, then per solid: text name, u32 has color, if so 3 f64 (linear
                       // red, green, blue), u32 original: the index of an earlier solid, of which
                       // this one is a copy, or CAG_BREP_NONE. Of a copy, the placement then maps
                       // the original to it, rigidly; of others, bytes body: the kernel's own form;
                       // boundary
  CAG_BREP_FAILURE = 3, // u32 reason (CagBrepFailure), text what failed, for people; u32 edge: its
                        // index in the boundary, or CAG_BREP_NONE; f64 limit: the largest radius or
                        // distance that was found to work there, 0 if none is known
  // Requests.
  CAG_BREP_EVALUATE = 16, // solid: its boundary
  CAG_BREP_FILLET = 17,   // solid, u32 n, per edge: u32 edge, f64 first radius, f64 last radius
  CAG_BREP_CHAMFER = 18,  // solid, u32 n, per edge: u32 edge, u32 face, f64 distance on this face,
                          // f64 distance on the other face
  CAG_BREP_SHELL = 19,    // solid, f64 thickness (positive: inward, negative: outward), u32 n, u32
                          // per open face
  CAG_BREP_OFFSET = 20,   // solid, f64 distance
  CAG_BREP_DRAFT = 21, // solid, f64 angle, vec pull, vec point on the neutral plane, u32 n, u32 per
                       // face
  CAG_BREP_SPLIT = 22, // solid, solid tool: the parts inside of the tool, then those outside
  CAG_BREP_IMPRINT = 23, // solid, u32 n, per curve: curve, f64 first, f64 last (drawn on the faces)
  CAG_BREP_READ_STEP = 24, // text path: all solids, placed, with names and colors
  CAG_BREP_READ_IGES = 25  // text path
} CagBrepMessage;

typedef enum CagBrepFailure {
  CAG_BREP_FAIL_INPUT = 1,  // the solid given is not one (not closed, not valid)
  CAG_BREP_FAIL_METHOD = 2, // the kernel's method failed
  CAG_BREP_FAIL_CHECK = 3,  // its result is not valid
  CAG_BREP_FAIL_EMPTY = 4,  // nothing is left
  CAG_BREP_FAIL_FILE = 5    // the file cannot be read
} CagBrepFailure;

#define CAG_BREP_NONE 0xffffffffu

typedef enum CagBrepSolidKind {
  CAG_BREP_BOX = 1,      // vec size, a corner at the origin
  CAG_BREP_SPHERE = 2,   // f64 radius, about the origin
  CAG_BREP_CYLINDER = 3, // f64 height, f64 radius at z = 0, f64 radius at the top; either may be 0
  CAG_BREP_TORUS = 4,    // f64 major, f64 minor, about z
  CAG_BREP_PRISM = 5,    // region in z = 0, vec along
  CAG_BREP_REVOLUTION =
      6, // region whose (x, y) is (x, 0, z) in space, f64 from, f64 to: angles about
         // z
  CAG_BREP_HALF_SPACE = 7, // z < 0, cut off: f64 size; the part within the cube of this half edge
                           // about the origin
  CAG_BREP_FACES = 8,  // u32 n, per face: u32 kind; if 0: surface (SPLINE), the whole of it; if 1:
                       // frame, region; if 2: surface (CYLINDRICAL, CONICAL, or SPHERICAL), 4 f64
                       // bounds u0 u1 v0 v1. Together they close; f64 tolerance of the gaps
  CAG_BREP_BODY = 9,   // bytes body: from a RESULT
  CAG_BREP_UNION = 10, // u32 n, n solids
  CAG_BREP_DIFFERENCE = 11, // the first minus all others
  CAG_BREP_INTERSECTION = 12
} CagBrepSolidKind;

typedef enum CagBrepCurveKind {
  CAG_BREP_POINT = 0,       // no fields: a degenerate edge (in space only)
  CAG_BREP_LINE = 1,        // point, direction (unit): origin + t direction
  CAG_BREP_CIRCLE = 2,      // point center, direction x, direction y, f64 radius
  CAG_BREP_ELLIPSE = 3,     // point center, direction x, direction y, f64 a, f64 b
  CAG_BREP_SPLINE_CURVE = 4 // u32 degree, u32 rational, u32 n, per point: point, and f64 weight if
                            // rational; n + degree + 1 f64 knots. Clamped, not periodic
} CagBrepCurveKind;

// S(u, v), as in STEP (ISO 10303-42), except for v of cones.
typedef enum CagBrepSurfaceKind {
  CAG_BREP_PLANE = 1,       // frame: O + u X + v Y
  CAG_BREP_CYLINDRICAL = 2, // frame, f64 radius r: O + r (cos u X + sin u Y) + v Z
  CAG_BREP_CONICAL = 3, // frame, f64 radius r, f64 half angle a: O + (r + v sin a) (cos u X + sin u
                        // Y) + v cos a Z
  CAG_BREP_SPHERICAL = 4, // frame, f64 r: O + r cos v (cos u X + sin u Y) + r sin v Z
  CAG_BREP_TOROIDAL = 5,  // frame, f64 R, f64 r: O + (R + r cos v) (cos u X + sin u Y) + r sin v Z
  CAG_BREP_SPLINE = 6,    // u32 degree u, degree v, rational, nu, nv; points (v varies faster; with
                          // weights if rational); nu + degree u + 1 f64 knots of u, then those of v
  CAG_BREP_REVOLVED = 7, // vec point and vec direction of the axis, curve, f64 first, f64 last: the
                         // curve C(v) turned by u
  CAG_BREP_EXTRUDED = 8  // vec direction (unit), curve, f64 first, f64 last: C(u) + v direction
} CagBrepSurfaceKind;

// A boundary:
//   f64 volume, f64 area, vec centroid: as the kernel finds them
//   u32 corners, per corner: vec
//   u32 edges, per edge: curve, f64 first, f64 last, u32 from, u32 to (corners; a degenerate edge is
//     at its corner), f64 tolerance
//   u32 faces, per face: surface, u32 reversed (the outward normal is opposite to dS/du x dS/dv),
//     4 f64 parameter bounds u0 u1 v0 v1 of the face, f64 tolerance, u32 loops (the outer one first),
//     per loop: u32 uses, per use: u32 edge, u32 reversed (the use runs from the end of the edge to
//     its start), trace: curve in the parameters, with the edge's parameter; uses in order, the face
//     on their left in the parameters, seen with u to the right and v up, unless the face is
//     reversed: then on their right
//   u32 shells, per shell: u32 faces, u32 per face; the outer shell first, then cavities
//
// Frames are right-handed: of a left-handed surface of the kernel, the equal right-handed one is
// sent, with its traces changed to match. Bezier curves, parabolas, hyperbolas, offset curves, and
// trimmed curves are sent as splines over first..last; offset surfaces and others as splines over
// the bounds of their face. Periodic splines are sent as clamped ones that cover first..last.

#endif
