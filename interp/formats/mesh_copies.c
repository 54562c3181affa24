// Finds parts of an output that are congruent.
//
// Three vertices that are far from collinear define a frame for each mesh. A mesh with the same
// number of vertices and triangles, whose frame has the same lengths, is compared vertex by vertex
// with the other mesh after a motion from frame to frame. Meshes are looked up by a hash of their
// counts.

#include "interp/formats/mesh_copies.h"

#include <string.h>

#include "base/memory.h"

// The largest difference between corresponding vertices, as a fraction of the size of the mesh. It
// is far above rounding and far below single precision.
#define SAME 1e-9
// A difference of unit normals and of parameters that is invisible in shading.
#define SAME_NORMAL 1e-6
// The maximum number of meshes with the same counts but different shapes that are compared with a
// mesh. A thousand balls of different sizes are not compared pairwise.
#define CANDIDATES 32

#define NONE SIZE_MAX

typedef struct Frame {
  uint32_t corner[3]; // of the original
  double size;        // from the first to the second
  CagTransform t;     // columns: the axes, and the first corner
} Frame;

typedef struct Finder {
  const CagMeshPart *parts;
  bool same_material;
  CagMeshCopy *copies;
  Frame *frames; // of originals
  size_t *slots; // hash -> the last original, NONE
  size_t *next;  // of an original: the previous one
  size_t mask;
} Finder;

// Hashes what a motion preserves. Triangles may differ in diagonals.
static size_t hash(const CagMesh *m, const CagMaterial *material) {
  uint64_t h = m->vertex_count * 0x9e3779b97f4a7c15u + m->triangle_count; // any odd constant
  h ^= (uintptr_t)material * 0xc2b2ae3d27d4eb4fu;
  return (size_t)(h ^ h >> 32);
}

// Computes the frame of three corners. Returns false if they are collinear.
static bool frame_of(const CagMesh *m, Frame *f) {
  const double least = 1e-6; // sine of the angle between the sides
  CagVec3 a = m->positions[f->corner[0]];
  CagVec3 x = cag_sub(m->positions[f->corner[1]], a), y = cag_sub(m->positions[f->corner[2]], a);
  f->size = cag_norm(x);
  CagVec3 z = cag_cross(x, y);
  if (!(cag_norm(z) > least * f->size * cag_norm(y))) return false;
  x = cag_unit(x);
  z = cag_unit(z);
  y = cag_cross(z, x);
  const CagVec3 columns[4] = {x, y, z, a};
  f->t = cag_transform_identity();
  for (int k = 0; k < 4; k++) {
    f->t.m[0][k] = columns[k].x;
    f->t.m[1][k] = columns[k].y;
    f->t.m[2][k] = columns[k].z;
  }
  return true;
}

static bool choose_frame(const CagMesh *m, Frame *f) {
  if (m->vertex_count < 3) return false;
  double most = -1;
  CagVec3 a = m->positions[0];
  *f = (Frame){0};
  for (size_t v = 1; v < m->vertex_count; v++) {
    double d = cag_norm(cag_sub(m->positions[v], a));
    if (d > most) most = d, f->corner[1] = (uint32_t)v;
  }
  CagVec3 x = cag_sub(m->positions[f->corner[1]], a);
  most = -1;
  for (size_t v = 1; v < m->vertex_count; v++) {
    double d = cag_norm(cag_cross(x, cag_sub(m->positions[v], a)));
    if (d > most) most = d, f->corner[2] = (uint32_t)v;
  }
  return frame_of(m, f);
}

// Computes the motion from frame a to frame b. A translation is exact.
static CagTransform motion(const Frame *a, const Frame *b) {
  CagTransform t = cag_transform_identity();
  const double straight = 1e-12; // smaller rotations are rounding errors
  bool turned = false;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double sum = 0;
      for (int k = 0; k < 3; k++) sum += b->t.m[i][k] * a->t.m[j][k];
      t.m[i][j] = sum;
      turned |= fabs(sum - (i == j)) > straight;
    }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3 && !turned; j++) t.m[i][j] = i == j;
    double moved = 0;
    for (int j = 0; j < 3; j++) moved += t.m[i][j] * a->t.m[j][3];
    t.m[i][3] = b->t.m[i][3] - moved;
  }
  return t;
}

static bool near_vector(CagVec3 a, CagVec3 b, double most) {
  return fabs(a.x - b.x) <= most && fabs(a.y - b.y) <= most && fabs(a.z - b.z) <= most;
}

static bool is_moved(const CagMesh *a, const CagMesh *b, const CagTransform *t, double size) {
  for (size_t v = 0; v < a->vertex_count; v++) {
    CagVec3 p = cag_transform_point(t, a->positions[v]);
    if (!near_vector(p, b->positions[v], SAME * size)) return false;
    if (a->normals &&
        !near_vector(cag_transform_vector(t, a->normals[v]), b->normals[v], SAME_NORMAL))
      return false;
    for (size_t k = 2 * v; a->uv && k < 2 * v + 2; k++)
      if (fabs(a->uv[k] - b->uv[k]) > SAME_NORMAL * fmax(1, fabs(a->uv[k]))) return false;
  }
  return true;
}

static bool same_triangle(const uint32_t *a, const uint32_t *b) {
  for (int r = 0; r < 3; r++)
    if (a[0] == b[r] && a[1] == b[(r + 1) % 3] && a[2] == b[(r + 2) % 3]) return true;
  return false;
}

static bool names(const uint32_t *six, uint32_t v) {
  for (int k = 0; k < 6; k++)
    if (six[k] == v) return true;
  return false;
}

// Tests whether two pairs of triangles are the same quad with different diagonals.
static bool same_quad(const uint32_t *a, const uint32_t *b) {
  for (int k = 0; k < 6; k++)
    if (!names(b, a[k]) || !names(a, b[k])) return false;
  return true;
}

static bool same_scale(const CagColorScale *a, const CagColorScale *b) {
  return a->kind == b->kind && a->from == b->from && a->to == b->to && a->stripes == b->stripes;
}

static bool same_triangles(const CagMesh *a, const CagMesh *b) {
  if (!same_scale(&a->scale, &b->scale)) return false;
  bool alike = !a->normals == !b->normals && !a->uv == !b->uv && !a->weld == !b->weld;
  if (!alike || (a->weld && memcmp(a->weld, b->weld, a->vertex_count * sizeof *a->weld)))
    return false;
  for (size_t t = 0; t < a->triangle_count; t++) {
    const uint32_t *s = a->triangles + 3 * t, *r = b->triangles + 3 * t;
    if (same_triangle(s, r)) continue;
    if (t + 1 == a->triangle_count || !same_quad(s, r)) return false;
    t++;
  }
  return true;
}

// Tests whether part i is a copy of original k, and sets the copy.
static bool try_original(Finder *f, size_t i, size_t k) {
  const CagMesh *a = f->parts[k].mesh, *b = f->parts[i].mesh;
  if (f->same_material && f->parts[k].material != f->parts[i].material) return false;
  if (a == b) return f->copies[i].original = k, true;
  if (a->vertex_count != b->vertex_count || a->triangle_count != b->triangle_count) return false;
  Frame frame = f->frames[k];
  if (!frame_of(b, &frame)) return false;
  double size = f->frames[k].size;
  if (fabs(frame.size - size) > SAME * size) return false;
  CagTransform t = motion(&f->frames[k], &frame);
  if (!same_triangles(a, b) || !is_moved(a, b, &t, size)) return false;
  f->copies[i] = (CagMeshCopy){k, t};
  return true;
}

static void find_one(Finder *f, size_t i) {
  const CagMesh *m = f->parts[i].mesh;
  f->copies[i] = (CagMeshCopy){i, cag_transform_identity()};
  const CagMaterial *material = f->same_material ? f->parts[i].material : NULL;
  size_t *slot = &f->slots[hash(m, material) & f->mask];
  size_t looked = 0;
  for (size_t k = *slot; k != NONE && looked < CANDIDATES; k = f->next[k], looked++)
    if (try_original(f, i, k)) return;
  if (!choose_frame(m, &f->frames[i])) return; // collinear vertices: copies are not detected
  f->next[i] = *slot;
  *slot = i;
}

CagStatus cag_mesh_find_copies(const CagMeshPart *parts, size_t n, bool same_material,
                               CagMeshCopy **out, CagError *err) {
  size_t size = 16;
  while (size < 2 * n) size *= 2;
  Finder f = {.parts = parts,
              .same_material = same_material,
              .copies = cag_malloc((n + 1) * sizeof *f.copies),
              .frames = cag_malloc((n + 1) * sizeof *f.frames),
              .slots = cag_malloc(size * sizeof *f.slots),
              .next = cag_malloc((n + 1) * sizeof *f.next),
              .mask = size - 1};
  bool good = f.copies && f.frames && f.slots && f.next;
  for (size_t i = 0; good && i < size; i++) f.slots[i] = NONE;
  if (good && n == 1) f.copies[0] = (CagMeshCopy){0, cag_transform_identity()};
  else
    for (size_t i = 0; good && i < n; i++) find_one(&f, i);
  cag_free(f.frames);
  cag_free(f.slots);
  cag_free(f.next);
  if (!good) cag_free(f.copies);
  *out = good ? f.copies : NULL;
  return good ? CAG_OK : cag_fail_memory(err);
}
