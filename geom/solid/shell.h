// Shared by the parts of closed shell construction (shell.c, shell_split.c, shell_loop.c).

#ifndef CAG_GEOM_SOLID_SHELL_H
#define CAG_GEOM_SOLID_SHELL_H

#include "geom/solid/build.h"

#define CAG_SHELL_PROBES 9

// A boundary curve of a face.
typedef struct CagShellBoundary {
  size_t face;
  int side;
  CagCurve *curve;             // in space
  CagVec3 p[CAG_SHELL_PROBES]; // at equal steps of its parameter
  bool paired;
} CagShellBoundary;

typedef struct CagShellBoundaries {
  CagShellBoundary *at;
  size_t n;
  double size, slack; // slack: edges with gaps up to this coincide
} CagShellBoundaries;

typedef struct CagShellLink {
  size_t a, b; // faces
  bool agrees; // their orientations agree
} CagShellLink;

typedef struct CagShellLinks {
  CagShellLink *at;
  size_t n, room;
} CagShellLinks;

// Faces, each with the index under which the caller knows it.
typedef struct CagShellFaces {
  CagSurface **at;
  size_t *origin;
  size_t n, room;
} CagShellFaces;

CagStatus cag_shell_add_face(CagShellFaces *f, const CagSurface *face, size_t origin,
                             CagError *err);
void cag_shell_free_faces(CagShellFaces *f);
CagStatus cag_shell_add_link(CagShellLinks *l, CagShellLink link, CagError *err);

// Orientation of a side within the face's boundary: whether the face is on the left of its
// parameter direction (seen from outside).
static inline int cag_shell_sense(int side) { return side == 0 || side == 3 ? -1 : 1; }
// Whether the boundary is a loop of a planar face.
static inline bool cag_shell_is_loop(const CagShellBoundary *b) { return b->side >= 4; }

// Splits faces at the ends of other faces' edges that lie within their own edges. *split: some were
// split, and *out has the new faces, owned by the caller.
CagStatus cag_shell_split(const CagShellBoundaries *all, const CagShellFaces *faces, bool *split,
                          CagShellFaces *out, CagError *err);

// Pairs loops of planar faces with the sides of other faces that run along them, and straight
// pieces of loops with each other. Adds edges to the solid, and links.
CagStatus cag_shell_pair_loops(CagSolid *s, CagShellBoundaries *all, CagShellLinks *links,
                               CagError *err);

#endif
