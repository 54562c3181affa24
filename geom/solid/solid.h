// Solids: closed bodies, as a primitive with its exact parameters or as closed shells of surfaces.
//
// A solid keeps how it was made (so that exporters can use native objects) and answers as a
// boundary: `faces`, surfaces whose normals point outward. Immutable, reference counted. A
// transform is applied to faces and kept beside the primitive.
//
// The kinds from MESH on have no faces: bodies within a mesh, unbounded sides, and set operations.
// They answer by triangles; see csg.h. The body of a quadric within a box is a set operation that
// has faces, without a table of their edges: its measures and exact files are those of the faces.

#ifndef CAG_GEOM_SOLID_H
#define CAG_GEOM_SOLID_H

#include <stdint.h>

#include "geom/surface/quadric.h"
#include "geom/surface/surface.h"
#include "geom/surface/swept.h"
#include "geom/tessellate/tessellate.h"

typedef enum CagSolidKind {
  CAG_SOLID_BOX,        // size: a corner in the origin, or centered
  CAG_SOLID_SPHERE,     // radius
  CAG_SOLID_CYLINDER,   // height, radius, top: a cylinder, frustum or cone standing on z = 0
  CAG_SOLID_TORUS,      // major, minor, about Z
  CAG_SOLID_EXTRUSION,  // region along a vector, with twist and scale
  CAG_SOLID_REVOLUTION, // closed region or profile that meets the axis, turned about an axis (full,
                        // or partial with caps)
  CAG_SOLID_TUBE,       // tube along a path with its caps
  CAG_SOLID_SWEEP,      // region along a path, or under a motion
  CAG_SOLID_LOFT,       // surface through closed sections with its caps
  CAG_SOLID_SHELL,      // closed surfaces given
  CAG_SOLID_MESH,       // within a closed mesh
  CAG_SOLID_HALF_SPACE, // one side of a plane: unbounded
  CAG_SOLID_QUADRIC,    // where a form of second degree is negative: unbounded
  CAG_SOLID_UNION,      // set operations
  CAG_SOLID_DIFFERENCE,
  CAG_SOLID_INTERSECTION
} CagSolidKind;

// What kinds without faces are made of, in coordinates of their own (csg.h).
typedef struct CagSolidCore CagSolidCore;

typedef struct CagSolid {
  int references;
  CagSolidKind kind;
  double a, b, c; // BOX size; SPHERE a; CYLINDER a = height, b = radius, c = top; TORUS a, b
  bool centered;  // BOX
  uint32_t label; // what its triangles are labeled with as an operand (mesh.h); 0: nothing
  CagTransform placement; // from the primitive's own coordinates to the world
  size_t face_count;
  CagSurface **faces; // in the world; normals outward
  // Edges shared by faces, for the mesh.
  size_t edge_count;
  CagFaceEdge *edges;
  CagSolidCore *core; // of set operations and unbounded kinds, which may have faces as well: shared
                      // by the copies that were moved; else NULL
} CagSolid;

// Whether a solid has faces that are sound, or a core, its edges name faces, and its placement is
// finite.
bool cag_check_solid(const CagSolid *s);

CagStatus cag_solid_box(CagVec3 size, bool centered, CagSolid **out, CagError *err);
CagStatus cag_solid_sphere(double radius, CagSolid **out, CagError *err);
CagStatus cag_solid_cylinder(double height, double radius, double top, CagSolid **out,
                             CagError *err); // radius or top 0: a cone
CagStatus cag_solid_torus(double major, double minor, CagSolid **out, CagError *err);
// Region (dimension 2, in z = 0) along v, twisted and scaled about the z axis; outward whatever the
// sense of v.
CagStatus cag_solid_extrude(const CagRegion *r, CagVec3 v, double twist, double scale,
                            CagSolid **out, CagError *err);
// Region in the half plane x >= 0 (its [x, y] meaning [x, 0, y]) turned about the axis; partial
// turns get caps.
CagStatus cag_solid_revolve(const CagRegion *r, CagVec3 axis, CagVec3 through, double from,
                            double to, CagSolid **out, CagError *err);
CagStatus cag_solid_tube(const CagCurve *path, double radius, CagSolid **out, CagError *err);
// Region carried by a motion (section coordinates x, y), with caps unless it comes home; fails with
// "sweep-not-closed" where a closed path brings it home turned.
CagStatus cag_solid_sweep(const CagRegion *r, const CagMotion *motion, CagSolid **out,
                          CagError *err);
// Disk whose radius changes along the path.
CagStatus cag_solid_tube_along(const CagCurve *path, const CagAlong *radius, CagSolid **out,
                               CagError *err);
// A loft (surface.h) closed by u, with flat caps where it is not closed by v: "section-not-plane",
// "section-open".
CagStatus cag_solid_loft(const CagSurface *side, CagSolid **out, CagError *err);
// Between a surface and its offset by d along its normals.
CagStatus cag_solid_thicken(const CagSurface *s, double d, CagSolid **out, CagError *err);
// The one face of a swept or lofted solid that is no cap; NULL: there is none, or several.
const CagSurface *cag_solid_side(const CagSolid *s);
// Surfaces that together have no boundary (edges matched to 1e-6 of the size; else "solid-open"
// with the gap); turned outward.
CagStatus cag_solid_shell(CagSurface *const *faces, size_t n, CagSolid **out, CagError *err);

CagSolid *cag_solid_retain(const CagSolid *s);
void cag_solid_release(CagSolid *s);
CagStatus cag_solid_transform(const CagSolid *s, const CagTransform *t, CagSolid **out,
                              CagError *err);
CagStatus cag_solid_bounds(const CagSolid *s, CagBounds *out, CagError *err);
CagStatus cag_solid_mass(const CagSolid *s, CagMassProperties *out,
                         CagError *err); // closed forms of primitives, else integrals over faces
// "sphere, radius 10, at [1, 2, 3]": what it is with the sizes that it has, then what else its
// transforms did: "scaled by", "turned by", "mapped by" and where its own origin came. The form
// alone leaves these out.
void cag_solid_describe(const CagSolid *s, char *buffer, size_t size);
void cag_solid_describe_form(const CagSolid *s, char *buffer, size_t size);
const char *cag_solid_kind_name(CagSolidKind kind); // "box"

#endif
