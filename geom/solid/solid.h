// Solids: a primitive with its exact parameters, or closed shells of surfaces.
//
// A solid records how it was made (so that exporters can use native objects) and represents its
// boundary by `faces`, surfaces whose normals point outward. Immutable, reference counted. A
// transform is applied to the faces and recorded in `placement`.
//
// The kinds from MESH on have no faces: solids bounded by meshes, unbounded solids, and set
// operations. They are represented by triangles; see csg.h. The body of a quadric within a box is a
// set operation that has faces but no table of edges: its measures and exact files come from the
// faces.

#ifndef CAG_GEOM_SOLID_H
#define CAG_GEOM_SOLID_H

#include <stdint.h>

#include "geom/surface/quadric.h"
#include "geom/surface/surface.h"
#include "geom/surface/swept.h"
#include "geom/tessellate/tessellate.h"

typedef enum CagSolidKind {
  CAG_SOLID_BOX,        // size: with a corner at the origin, or centered
  CAG_SOLID_SPHERE,     // radius
  CAG_SOLID_CYLINDER,   // height, radius, top: a cylinder, frustum, or cone standing on z = 0
  CAG_SOLID_TORUS,      // major, minor, about Z
  CAG_SOLID_EXTRUSION,  // region along a vector, with twist and scale
  CAG_SOLID_REVOLUTION, // closed region, or profile that meets the axis, revolved (full, or partial
                        // with caps)
  CAG_SOLID_TUBE,       // tube along a path, with caps
  CAG_SOLID_SWEEP,      // region along a path, or under a motion
  CAG_SOLID_LOFT,       // surface through closed sections, with caps
  CAG_SOLID_SHELL,      // given closed surfaces
  CAG_SOLID_EXACT,      // exact boundaries (exact.h)
  CAG_SOLID_MESH,       // the inside of a closed mesh
  CAG_SOLID_HALF_SPACE, // one side of a plane: unbounded
  CAG_SOLID_QUADRIC,    // the points at which a quadratic form is negative: unbounded
  CAG_SOLID_UNION,      // set operations
  CAG_SOLID_DIFFERENCE,
  CAG_SOLID_INTERSECTION
} CagSolidKind;

// The definition of kinds without faces, in their own coordinates (csg.h).
typedef struct CagSolidCore CagSolidCore;
// The boundaries of a solid of the kind EXACT (exact.h).
typedef struct CagExact CagExact;

typedef struct CagSolid {
  int references;
  CagSolidKind kind;
  double a, b, c; // BOX size; SPHERE a; CYLINDER a = height, b = radius, c = top; TORUS a, b
  bool centered;  // BOX
  uint32_t label; // label of its triangles if it is an operand (mesh.h); 0: none
  CagTransform placement; // from the primitive's local coordinates to the world
  size_t face_count;
  CagSurface **faces; // in world coordinates; normals outward
  // Edges shared by faces, for the mesh.
  size_t edge_count;
  CagFaceEdge *edges;
  CagSolidCore *core; // for set operations and unbounded kinds, which may have faces as well;
                      // shared by transformed copies; else NULL
  CagExact *exact;    // EXACT, likewise; else NULL
} CagSolid;

// Whether a solid has valid faces or a core, its edges refer to existing faces, and its placement
// is finite.
bool cag_check_solid(const CagSolid *s);

CagStatus cag_solid_box(CagVec3 size, bool centered, CagSolid **out, CagError *err);
CagStatus cag_solid_sphere(double radius, CagSolid **out, CagError *err);
CagStatus cag_solid_cylinder(double height, double radius, double top, CagSolid **out,
                             CagError *err); // radius or top 0: a cone
CagStatus cag_solid_torus(double major, double minor, CagSolid **out, CagError *err);
// Extrudes a region (dimension 2, in z = 0) along v, twisted and scaled about the z axis; normals
// are outward for either direction of v.
CagStatus cag_solid_extrude(const CagRegion *r, CagVec3 v, double twist, double scale,
                            CagSolid **out, CagError *err);
// Revolves a region in the half plane x >= 0 (its [x, y] means [x, 0, y]) about the axis; partial
// turns get caps.
CagStatus cag_solid_revolve(const CagRegion *r, CagVec3 axis, CagVec3 through, double from,
                            double to, CagSolid **out, CagError *err);
CagStatus cag_solid_tube(const CagCurve *path, double radius, CagSolid **out, CagError *err);
// A region carried by a motion (section coordinates x, y), with caps unless it returns to its
// start. Fails with "sweep-not-closed" if a closed path returns it rotated.
CagStatus cag_solid_sweep(const CagRegion *r, const CagMotion *motion, CagSolid **out,
                          CagError *err);
// A disk whose radius varies along the path.
CagStatus cag_solid_tube_along(const CagCurve *path, const CagAlong *radius, CagSolid **out,
                               CagError *err);
// A loft (surface.h) closed in u, with flat caps if it is not closed in v. Fails with
// "section-not-plane", "section-open".
CagStatus cag_solid_loft(const CagSurface *side, CagSolid **out, CagError *err);
// The solid between a surface and its offset by d along its normals.
CagStatus cag_solid_thicken(const CagSurface *s, double d, CagSolid **out, CagError *err);
// The only face of a swept or lofted solid that is not a cap; NULL if there is none, or more than
// one.
const CagSurface *cag_solid_side(const CagSolid *s);
// Surfaces that together have no boundary (edges matched to 1e-6 of the size; else "solid-open"
// with the gap), oriented outward.
CagStatus cag_solid_shell(CagSurface *const *faces, size_t n, CagSolid **out, CagError *err);

CagSolid *cag_solid_retain(const CagSolid *s);
// Adds everything that the solid depends on to a digest: those with equal digests are the same.
void cag_solid_digest(const CagSolid *s, CagDigest *d);
// Whether the solid is one that keeps its own coordinates beside its placement: a primitive, a set
// operation, or a mesh. The second function then adds the solid in its own coordinates to a digest.
bool cag_solid_has_own_frame(const CagSolid *s);
void cag_solid_digest_in_own_frame(const CagSolid *s, CagDigest *d);
void cag_solid_release(CagSolid *s);
CagStatus cag_solid_transform(const CagSolid *s, const CagTransform *t, CagSolid **out,
                              CagError *err);
CagStatus cag_solid_bounds(const CagSolid *s, CagBounds *out, CagError *err);
CagStatus cag_solid_mass(const CagSolid *s, CagMassProperties *out,
                         CagError *err); // closed forms for primitives, else integrals over faces
// A description such as "sphere, radius 10, at [1, 2, 3]": the kind and its sizes, then the
// remaining effect of its transforms ("scaled by", "turned by", "mapped by") and the location of
// its origin. describe_form omits the latter two.
void cag_solid_describe(const CagSolid *s, char *buffer, size_t size);
void cag_solid_describe_form(const CagSolid *s, char *buffer, size_t size);
const char *cag_solid_kind_name(CagSolidKind kind); // "box"

#endif
