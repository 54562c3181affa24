// Robots as URDF, the XML format in which ROS and most simulators describe them.
//
// A URDF robot is a tree of links (frames with bodies) and joints between them. Ours are chains:
//
//     world -base-> base_link -joint_1-> link_1 -joint_2-> link_2 ... -> tool
//
// The frame of a link is the one that its joint has moved; `tool` is the frame that fk gives, and
// `world` is there only where the robot's base is not the world itself. What a joint carries to the
// next one (the constant part of its Denavit-Hartenberg row) is the origin of the next joint. A
// screw is two joints, of which the sliding one mimics the turning one. Lengths here are
// millimeters and angles radians, as everywhere; the writer makes them meters.

#ifndef CAG_INTERP_FORMATS_URDF_H
#define CAG_INTERP_FORMATS_URDF_H

#include "base/arena.h"
#include "base/atomic_file.h"
#include "interp/scene/scene.h"

// Of joints that say none; URDF wants both. Radians or millimeters each second, N m or N.
#define CAG_URDF_TURN_RATE 3.141592653589793
#define CAG_URDF_SLIDE_RATE 1000
#define CAG_URDF_EFFORT 100
// Of materials that say none, in kg / m^3: water.
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
  CagTransform place; // in the link's frame
  double size[3];     // CYLINDER: radius and length along z, about its middle; BOX: sides
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
  double low, high, effort, rate; // joints that move; about or along z
  const char *mimic;              // NULL: the joint moves by itself
  double multiplier;              // of the joint that is mimicked, mm each radian
} CagUrdfJoint;

typedef struct CagUrdfMaterial {
  char *name;
  CagColor color; // linear light
  double alpha;
} CagUrdfMaterial;

typedef struct CagUrdf {
  CagArena arena; // of all that follows
  const char *name;
  bool coupled; // motors are coupled to joints, which the format cannot say
  bool meshes;  // some shape is a mesh
  CagUrdfLink *links;
  CagUrdfJoint *joints;
  CagUrdfMaterial *materials;
  size_t link_count, joint_count, material_count, material_room;
} CagUrdf;

void cag_urdf_free(CagUrdf *u);

// The masses of an item of a scene: none of what is open or flat.
CagStatus cag_urdf_item_mass(const CagItem *item, double density, CagUrdfMass *out, CagError *err);
// The two as one body.
void cag_urdf_mass_join(CagUrdfMass *whole, const CagUrdfMass *part);
// A plain cylinder (radius, length) or box (three sides) at its place.
CagUrdfMass cag_urdf_plain_mass(const CagUrdfShape *shape, double density);

// Writes the XML text, in which meshes are called `folder`/FILE. Fails with "not-finite" if a
// number is not finite.
CagStatus cag_export_urdf(const CagUrdf *u, const char *folder, CagAtomicFile *file, CagError *err);
// One mesh as a binary STL in meters.
CagStatus cag_export_urdf_mesh(const CagUrdfShape *shape, CagAtomicFile *file, CagError *err);

#endif
