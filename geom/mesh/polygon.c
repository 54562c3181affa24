// Triangulation of a single polygon in space, as a plane polygon seen along its normal.

#include "geom/mesh/polygon.h"

#include <string.h>

#include "base/memory.h"

// Twice the vector area (Newell); its direction is the normal.
static CagVec3 vector_area(const CagVec3 *vertices, const uint32_t *face, size_t count) {
  CagVec3 sum = {0, 0, 0}, origin = vertices[face[0]];
  for (size_t k = 1; k + 1 < count; k++)
    sum = cag_add(
        sum, cag_cross(cag_sub(vertices[face[k]], origin), cag_sub(vertices[face[k + 1]], origin)));
  return sum;
}

static bool is_convex(const CagVec3 *vertices, const uint32_t *face, size_t count, CagVec3 normal) {
  // All fan triangles and all corners turn left: the polygon is convex or star-shaped about the
  // first corner.
  for (size_t k = 0; k < count; k++) {
    CagVec3 a = vertices[face[k]], b = vertices[face[(k + 1) % count]],
            c = vertices[face[(k + 2) % count]];
    if (cag_dot(cag_cross(cag_sub(b, a), cag_sub(c, b)), normal) <= 0) return false;
  }
  CagVec3 a = vertices[face[0]];
  for (size_t k = 1; k + 1 < count; k++) {
    CagVec3 b = cag_sub(vertices[face[k]], a), c = cag_sub(vertices[face[k + 1]], a);
    if (cag_dot(cag_cross(b, c), normal) <= 0) return false;
  }
  return true;
}

// A concave polygon: projected along the axis nearest to its normal, which keeps collinear corners
// collinear.
static CagStatus triangulate_concave(const CagVec3 *vertices, const uint32_t *face, size_t count,
                                     CagVec3 normal, uint32_t *triangles, CagError *err) {
  double *xy = cag_malloc(2 * count * sizeof *xy);
  if (!xy) return cag_fail_memory(err);
  double ax = fabs(normal.x), ay = fabs(normal.y), az = fabs(normal.z);
  for (size_t k = 0; k < count; k++) {
    CagVec3 p = vertices[face[k]];
    double x, y;
    if (ax >= ay && ax >= az) x = normal.x > 0 ? p.y : -p.y, y = p.z;
    else if (ay >= az) x = normal.y > 0 ? p.z : -p.z, y = p.x;
    else x = normal.z > 0 ? p.x : -p.x, y = p.y;
    xy[2 * k] = x;
    xy[2 * k + 1] = y;
  }
  uint32_t *local;
  size_t n;
  CagStatus status = cag_triangulate(xy, &count, 1, &local, &n, err);
  cag_free(xy);
  if (status) return status;
  for (size_t k = 0; k < 3 * n && n == count - 2; k++) triangles[k] = face[local[k]];
  cag_free(local);
  return CAG_OK;
}

CagStatus cag_polygon_triangulate(const CagVec3 *vertices, const uint32_t *face, size_t count,
                                  size_t number, uint32_t *triangles, CagError *err) {
  if (count == 3) {
    memcpy(triangles, face, 3 * sizeof *face);
    return CAG_OK;
  }
  CagVec3 normal = vector_area(vertices, face, count);
  if (cag_norm(normal) == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_face_degenerate, "faces", (long)number,
                    "a face must have an area: the corners of faces[%zu] lie on one line", number);
  if (is_convex(vertices, face, count, normal)) {
    for (size_t k = 0; k + 2 < count; k++) {
      triangles[3 * k] = face[0];
      triangles[3 * k + 1] = face[k + 1];
      triangles[3 * k + 2] = face[k + 2];
    }
    return CAG_OK;
  }
  CagStatus status = triangulate_concave(vertices, face, count, normal, triangles, err);
  if (status == CAG_E_ARGUMENT)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_face_self_intersection, "faces", (long)number,
                    "the boundary of a face must not cross or touch itself: faces[%zu] does; "
                    "give it as triangles",
                    number);
  return status;
}
