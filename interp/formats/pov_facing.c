// Adjusts normals of meshes at the silhouette, as seen by the camera.
//
// A triangle near the silhouette that faces the camera may have corners whose smooth normals point
// away from it. POV-Ray reverses such a normal and shades the invisible side, which causes dark
// pixels along the silhouette. The corners of these triangles get separate vertices, whose normals
// are rotated by the smallest sufficient angle toward the camera, or away from it if the back of
// the triangle is visible. Mirrors may still show such pixels.

#include <string.h>

#include "interp/formats/pov_write.h"

// The minimum cosine between a normal and a ray: above the rounding of normals, which are written
// with five decimals, and of single precision in the renderer.
#define FACING_MARGIN 1e-4

typedef struct Viewer {
  CagVec3 eye, direction; // direction: of all rays of an orthographic camera
  bool parallel;
  double lens; // radius of the lens
} Viewer;

static CagVec3 ray_to(const Viewer *v, CagVec3 p) {
  return v->parallel ? v->direction : cag_sub(p, v->eye);
}

// Returns 1 if the camera sees the side of the triangle to which its normals point, else -1.
static double side_seen(const CagVec3 p[3], const CagVec3 n[3], CagVec3 view) {
  const CagVec3 g = cag_cross(cag_sub(p[1], p[0]), cag_sub(p[2], p[0]));
  const CagVec3 mean = cag_add(cag_add(n[0], n[1]), n[2]);
  return (cag_dot(g, mean) < 0) == (cag_dot(g, view) < 0) ? -1 : 1;
}

// Rotates the normals of the corners, so that all normals between them are on the same side of all
// rays to the triangle. Returns the rotated corners as bits.
static unsigned turn_normals(const Viewer *v, const CagVec3 p[3], CagVec3 n[3]) {
  CagVec3 ray[3], view = {0, 0, 0};
  double margin[3];
  for (int j = 0; j < 3; j++) {
    ray[j] = ray_to(v, p[j]);
    margin[j] = FACING_MARGIN * cag_norm(ray[j]) + v->lens;
    view = cag_add(view, ray[j]);
  }
  view = cag_unit(view);
  for (int j = 0; j < 3; j++)
    if (!(cag_dot(view, ray[j]) > 0)) return 0; // the camera is too close
  const double side = side_seen(p, n, view);
  unsigned turned = 0;
  for (int i = 0; i < 3; i++) {
    double turn = 0;
    for (int j = 0; j < 3; j++)
      turn = fmax(turn, (side * cag_dot(n[i], ray[j]) + margin[j]) / cag_dot(view, ray[j]));
    if (!(turn > 0)) continue;
    n[i] = cag_unit(cag_madd(n[i], -side * turn, view));
    turned |= 1u << i;
  }
  return turned;
}

// Converts the camera to the coordinates of the mesh.
static bool viewer_of(const CagPovWriter *w, Viewer *v) {
  const CagCamera *c = w->camera;
  const CagTransform frame = cag_camera_frame(c);
  CagTransform inverse;
  CagError err;
  if (cag_transform_inverse(&w->outer, &inverse, &err)) return false;
  v->eye = cag_transform_point(&inverse, cag_vec3(frame.m[0][3], frame.m[1][3], frame.m[2][3]));
  v->direction =
      cag_transform_vector(&inverse, cag_vec3(frame.m[0][2], frame.m[1][2], frame.m[2][2]));
  v->parallel = c->orthographic;
  v->lens = cag_camera_has_lens(c) ? c->aperture / 2 : 0;
  return true;
}

// Returns the triangle's corners with rotated normals, and the rotated corners as bits.
static unsigned turn_corners(const Viewer *v, const CagMesh *m, size_t t, CagVec3 p[3],
                             CagVec3 n[3]) {
  for (int k = 0; k < 3; k++) {
    const uint32_t at = m->triangles[3 * t + (size_t)k];
    p[k] = m->positions[at];
    n[k] = m->normals[at];
  }
  return turn_normals(v, p, n);
}

// Copies a mesh with room for more vertices, without weld and labels.
static CagStatus roomy_copy(const CagMesh *m, size_t more, CagMesh **out, CagError *err) {
  CagMesh *copy;
  const size_t n = m->vertex_count;
  CagStatus status =
      cag_mesh_new(n + more, m->triangle_count, true, m->uv != NULL, false, &copy, err);
  if (status) return status;
  memcpy(copy->positions, m->positions, n * sizeof *m->positions);
  memcpy(copy->normals, m->normals, n * sizeof *m->normals);
  if (m->uv) memcpy(copy->uv, m->uv, 2 * n * sizeof *m->uv);
  memcpy(copy->triangles, m->triangles, 3 * m->triangle_count * sizeof *m->triangles);
  copy->scale = m->scale;
  copy->vertex_count = n;
  *out = copy;
  return CAG_OK;
}

static void add_corners(CagMesh *m, size_t t, unsigned turned, const CagVec3 p[3],
                        const CagVec3 n[3]) {
  for (int k = 0; k < 3; k++) {
    if (!(turned >> k & 1)) continue;
    uint32_t *corner = &m->triangles[3 * t + (size_t)k];
    const size_t at = m->vertex_count++;
    m->positions[at] = p[k];
    m->normals[at] = n[k];
    if (m->uv) memcpy(m->uv + 2 * at, m->uv + 2 * (size_t)*corner, 2 * sizeof *m->uv);
    *corner = (uint32_t)at;
  }
}

CagStatus cag_pov_facing_mesh(const CagPovWriter *w, const CagMesh *m, CagMesh **out,
                              CagError *err) {
  Viewer v;
  CagMesh *facing;
  CagVec3 p[3], n[3];
  size_t more = 0;
  const bool seen = m->normals && viewer_of(w, &v);
  for (size_t t = 0; seen && t < m->triangle_count; t++) {
    const unsigned turned = turn_corners(&v, m, t, p, n);
    more += (turned & 1) + (turned >> 1 & 1) + (turned >> 2);
  }
  if (more == 0) {
    *out = cag_mesh_retain(m);
    return CAG_OK;
  }
  CagStatus status = roomy_copy(m, more, &facing, err);
  if (status) return status;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const unsigned turned = turn_corners(&v, m, t, p, n);
    add_corners(facing, t, turned, p, n);
  }
  *out = facing;
  return CAG_OK;
}
