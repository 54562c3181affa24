// Robots as URDF, the XML format for robots of ROS and most simulators.
//
// A URDF robot is a tree of links (frames with bodies) and joints between them. Here, it is a
// chain:
//
//     world -base-> base_link -joint_1-> link_1 -joint_2-> link_2 ... -> tool
//
// The frame of a link is the one that its joint has moved, and `tool` is the frame that fk returns.
// `world` is present only if the robot's base differs from the world. The constant part of a
// joint's Denavit-Hartenberg row becomes the origin of the next joint. A screw becomes two joints:
// a prismatic one that mimics a revolute one. Here, lengths are in millimeters and angles in
// radians, as everywhere. The writer converts lengths to meters.
// millimeters and angles radians, as everywhere; the writer makes them meters.

#ifndef CAG_INTERP_FORMATS_URDF_H
#define CAG_INTERP_FORMATS_URDF_H

#include "base/arena.h"
#include "base/atomic_file.h"
#include "interp/scene/scene.h"

// Defaults for joints, because URDF requires both: radians or millimeters per second, N m or N.
#define CAG_URDF_TURN_RATE 3.141592653589793
#define CAG_URDF_SLIDE_RATE 1000
#define CAG_URDF_EFFORT 100
// Default for materials, in kg / m^3: water.
#define CAG_URDF_DENSITY 1000

// A rigid body: kg, mm, kg mm^2 about the center in the axes of the link.
typedef struct CagUrdfMass {
  double mass;
  CagVec3 center;
  double inertia[3][3];
} CagUrdfMass;

typedef enum CagUrdfShapeKind { CAG_URDF_MESH, CAG_URDF_CYLINDER, CAG_URDF_BOX } CagUrdfShapeKind;

typedef struct CagUrdfShape {
  struct CagUrdfShape *next;
  CagUrdfShapeKind kind;
  CagTransform place; // in the frame of the link
  double size[3];     // CYLINDER: radius and length along z, centered; BOX: sides
  CagMesh *mesh;      // MESH: one reference
  char *file;         // its name in the folder of meshes
  size_t material;
} CagUrdfShape;

typedef struct CagUrdfLink {
  char *name;
  CagUrdfShape *shapes, **last_shape;
  CagUrdfMass mass; // mass 0: none
} CagUrdfLink;

typedef struct CagUrdfJoint {
  char *name;
  const char *type; // "revolute" "prismatic" "fixed"
  size_t parent, child;
  CagTransform origin;
  double low, high, effort, rate; // of moving joints; about or along z
  const char *mimic;              // name of the joint that it mimics; NULL: none
  double multiplier;              // for the mimicked joint, in mm per radian
} CagUrdfJoint;

typedef struct CagUrdfMaterial {
  char *name;
  CagColor color; // linear light
  double alpha;
} CagUrdfMaterial;

typedef struct CagUrdf {
  CagArena arena; // owns everything below
  const char *name;
  bool coupled; // motors are coupled to joints, which URDF cannot express
  bool meshes;  // at least one shape is a mesh
  CagUrdfLink *links;
  CagUrdfJoint *joints;
  CagUrdfMaterial *materials;
  size_t link_count, joint_count, material_count, material_room;
} CagUrdf;

void cag_urdf_free(CagUrdf *u);

// Computes the mass properties of an item of a scene, which are zero for open and flat shapes.
CagStatus cag_urdf_item_mass(const CagItem *item, double density, CagUrdfMass *out, CagError *err);
// Adds a part to the whole.
void cag_urdf_mass_join(CagUrdfMass *whole, const CagUrdfMass *part);
// Computes the mass properties of a cylinder (radius, length) or box (three sides) in place.
CagUrdfMass cag_urdf_plain_mass(const CagUrdfShape *shape, double density);

// Writes the XML text, in which meshes are called `folder`/FILE. Fails with "not-finite" if a
// number is not finite.
CagStatus cag_export_urdf(const CagUrdf *u, const char *folder, CagAtomicFile *file, CagError *err);
// Writes a mesh as binary STL in meters.
CagStatus cag_export_urdf_mesh(const CagUrdfShape *shape, CagAtomicFile *file, CagError *err);

#endif
