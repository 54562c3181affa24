// Reading of URDF files, the XML format for robots of ROS and most simulators, as plain data, and
// conversion of a serial chain to the rows of a robot.
//
// A file is a tree of links (frames with bodies) that are connected by joints. Lengths are
// converted from meters to millimeters. Files with a document type are refused, so that no entity
// is expanded and no other file is read.

#ifndef CAG_INTERP_FORMATS_URDF_READ_H
#define CAG_INTERP_FORMATS_URDF_READ_H

#include "base/arena.h"
#include "geom/robot/robot.h"
#include "interp/scene/scene.h"

#define CAG_URDF_NONE ((size_t)-1)

typedef enum CagUrdfBodyKind {
  CAG_URDF_BODY_MESH,
  CAG_URDF_BODY_BOX,
  CAG_URDF_BODY_CYLINDER,
  CAG_URDF_BODY_SPHERE
} CagUrdfBodyKind;

// A visual or collision body.
typedef struct CagUrdfBody {
  struct CagUrdfBody *next;
  CagUrdfBodyKind kind;
  CagTransform place;
  double size[3];   // BOX: sides; CYLINDER: radius, length; SPHERE: radius
  const char *file; // MESH: as in the file
  double scale[3];
  const char *material; // its name, or NULL
  bool colored;
  CagColor color; // linear light
  double alpha;
  long line;
} CagUrdfBody;

typedef struct CagUrdfNode {
  const char *name;
  CagUrdfBody *visuals, *collisions;
  size_t above; // its parent joint; CAG_URDF_NONE: a root
  long line;
} CagUrdfNode;

typedef enum CagUrdfJointKind {
  CAG_URDF_REVOLUTE,
  CAG_URDF_CONTINUOUS,
  CAG_URDF_PRISMATIC,
  CAG_URDF_FIXED,
  CAG_URDF_FLOATING,
  CAG_URDF_PLANAR
} CagUrdfJointKind;

typedef struct CagUrdfEdge {
  const char *name;
  CagUrdfJointKind kind;
  size_t parent, child;
  CagTransform origin;
  CagVec3 axis;                    // a unit vector
  double low, high, speed, effort; // radians or mm; 0: not given
  const char *mimic;               // name of the joint that it follows; NULL: none
  double multiplier, offset;       // as in the file
  long line;
} CagUrdfEdge;

typedef struct CagUrdfTree {
  CagArena arena;   // owns all texts and lists
  const char *file; // for messages
  const char *name;
  CagUrdfNode *nodes;
  CagUrdfEdge *edges;
  size_t node_count, edge_count;
} CagUrdfTree;

// Reads a file's bytes. Fails with CAG_E_ARGUMENT and one of the reasons
//   "urdf-syntax"   XML that is not well-formed, a missing element, or an invalid number; the
//                   message states the line
//   "urdf-chain"    links and joints that do not form a tree
//   "urdf-joint"    an unknown type of joint
//   "joint-limits"  invalid limits
// The tree must be freed in any case.
CagStatus cag_urdf_read(const char *file, const char *bytes, size_t size, CagUrdfTree *out,
                        CagError *err);
void cag_urdf_tree_free(CagUrdfTree *t);

// Returns the joints from the link `base` down to the link `tip` in order; *out is allocated with
// malloc. A NULL base means the root, and a NULL tip the end of the part that does not branch.
// Fails with "urdf-branches" or "urdf-chain".
CagStatus cag_urdf_chain(const CagUrdfTree *t, const char *base, const char *tip, size_t **out,
                         size_t *n, CagError *err);

// A body of a row, in the frame after the row.
typedef struct CagUrdfPlaced {
  size_t node;
  CagTransform place;
} CagUrdfPlaced;

typedef struct CagUrdfRow {
  CagRobotLink link;
  size_t first, count; // of the placed nodes
} CagUrdfRow;

typedef struct CagUrdfRows {
  CagUrdfRow *rows;
  size_t row_count;
  CagUrdfPlaced *placed;
  CagTransform base, tool;
} CagUrdfRows;

// Converts a chain to classic Denavit-Hartenberg rows. A fixed link is inserted if no row leads
// from one axis to the next. Links without bodies are merged into the preceding rows. `bodies`:
// whether bodies are needed. Fails with "urdf-joint" for floating and planar joints, and for joints
// that follow others, except the two halves of a screw. The result must be freed in any case.
CagStatus cag_urdf_rows(const CagUrdfTree *t, const char *base, const size_t *chain, size_t n,
                        bool bodies, CagUrdfRows *out, CagError *err);
void cag_urdf_rows_free(CagUrdfRows *r);

#endif
