// Set operations by CGAL, for builds with `make CGAL=1`. Not for users of the mesh module.

#ifndef CAG_GEOM_MESH_BOOLEAN_CGAL_H
#define CAG_GEOM_MESH_BOOLEAN_CGAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct BoolCgalMesh {
  double *points; // 3 to a point
  size_t point_count;
  uint32_t *triangles;
  size_t triangle_count;
  uint32_t *operand, *source; // of a result: where each triangle is from; malloc'd as all of it
} BoolCgalMesh;

// operation: 0 a or b, 1 a without b, 2 a and b. False: CGAL does not take these operands (they
// touch or cross themselves, or the result would), or there is no memory.
bool bool_cgal_operate(int operation, const BoolCgalMesh operands[2], BoolCgalMesh *out);

#ifdef __cplusplus
}
#endif

#endif
