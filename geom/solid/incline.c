// Drafts by moving the vertices of meshes.
//
// A vertex of an inclined face moves such that it lies in the new planes of all inclined faces that
// it is on, and in the planes of the triangles of the others. If the mesh overlaps itself then, its
// volume differs from that of its union.

#include "geom/solid/incline.h"

#include <math.h>

#include "base/memory.h"
#include "geom/boolean/boolean.h"
#include "geom/solid/csg.h"

// Normals of one flat face differ by less than this, as do those of parallel directions.
#define FLAT 1e-6
// Weight of inclined faces among those at a vertex.
#define HEAVY 100
// Folds beside curved faces have at most this part of the area of the inclined faces, and this part
// of the volume of a layer as thick as the tolerance.
#define FOLDED 0.02
#define FOLDS 0.02
// More folds than these, up to this part of the area, are allowed if the volume between the old and
// the new faces is that of wedges over the old ones, up to this part of it.
#define FOLDED_MOST 0.2
#define WEDGES 0.1

// An inclined face: its old normal, and its new plane.
typedef struct Incline {
  CagVec3 old, normal, point;
  bool known;
} Incline;

typedef struct Draft {
  const CagFaceMesh *m;
  const CagSolidFace *faces;
  size_t n;
  Incline *planes;
  CagFaceSteps *steps; // of vertices
  uint32_t *count;     // of triangles of inclined faces at each vertex
  CagVec3 at, pull;
  double angle, tolerance;
} Draft;

static size_t incline_of(const Draft *d, size_t triangle) {
  const CagSolidFace f = d->m->face[triangle];
  size_t i = 0;
  while (i < d->n && (d->faces[i].part != f.part || d->faces[i].face != f.face)) i++;
  return i;
}

static CagStatus fail_draft(const char *why, size_t face, CagError *err) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "faces", (long)face,
                  "the mesh of the solid cannot be drafted: %s", why);
}

static CagStatus fail_overlap(CagError *err) {
  return fail_draft("the inclined faces would intersect others", 0, err);
}

// Sets the new plane from the first triangle of a face, and compares the others with it.
static CagStatus see_triangle(Draft *d, size_t i, CagVec3 normal, CagVec3 p, CagError *err) {
  Incline *f = &d->planes[i];
  if (f->known)
    return cag_norm(cag_sub(normal, f->old)) <= FLAT ? CAG_OK
                                                     : fail_draft("a face is not flat", i, err);
  if (fabs(cag_dot(normal, d->pull)) > FLAT)
    return fail_draft("a face is not parallel to the pull", i, err);
  const double height = cag_dot(cag_sub(d->at, p), d->pull);
  f->known = true;
  f->old = normal;
  f->normal = cag_unit(cag_madd(cag_scaled(normal, cos(d->angle)), sin(d->angle), d->pull));
  f->point = cag_madd(p, height, d->pull);
  return CAG_OK;
}

static CagStatus add_triangle(Draft *d, size_t triangle, CagError *err) {
  const CagMesh *m = d->m->mesh;
  const size_t i = incline_of(d, triangle);
  CagCornerView c[3];
  cag_triangle_corners(m, triangle, c);
  for (size_t k = 0; k < 3; k++) {
    const uint32_t v = cag_mesh_corner(m, 3 * triangle + k);
    const CagVec3 p = m->positions[v];
    if (i == d->n) {
      cag_face_steps_add(&d->steps[v], c[k].angle, c[k].normal, 0);
      continue;
    }
    const CagStatus status = see_triangle(d, i, c[k].normal, p, err);
    if (status) return status;
    const Incline *f = &d->planes[i];
    d->count[v]++;
    cag_face_steps_add(&d->steps[v], HEAVY * c[k].angle, f->normal,
                       cag_dot(f->normal, cag_sub(f->point, p)));
  }
  return CAG_OK;
}

static CagStatus moved_mesh(const Draft *d, CagMesh **out, CagError *err) {
  const CagMesh *m = d->m->mesh;
  CagStatus status =
      cag_mesh_new(m->vertex_count, m->triangle_count, false, false, false, out, err);
  if (status) return status;
  for (size_t i = 0; i < m->vertex_count; i++) {
    CagVec3 step = {0, 0, 0};
    if (d->count[i]) cag_face_steps_solve(&d->steps[i], &step);
    (*out)->positions[i] = cag_add(m->positions[i], step);
  }
  for (size_t i = 0; i < 3 * m->triangle_count; i++) (*out)->triangles[i] = cag_mesh_corner(m, i);
  return CAG_OK;
}

// The parts of the area of the inclined faces that are turned over in the moved mesh, and the volumes
// of wedges between the old and new planes over the old faces.
typedef struct Changes {
  double kept, turned;
  double removed, moved; // by the wedges, counting those outward as negative, and as positive
} Changes;

static void add_changes(const Draft *d, size_t face, const CagVec3 old[3], const CagVec3 now[3],
                        Changes *c) {
  const CagVec3 middle = cag_scaled(cag_add(old[0], cag_add(old[1], old[2])), 1 / 3.0);
  const double height = cag_dot(cag_sub(middle, d->at), d->pull);
  const CagVec3 was = cag_cross(cag_sub(old[1], old[0]), cag_sub(old[2], old[0]));
  const double area =
      cag_dot(cag_cross(cag_sub(now[1], now[0]), cag_sub(now[2], now[0])), d->planes[face].normal);
  const double wedge = cag_norm(was) / 2 * height * tan(d->angle);
  *(area < 0 ? &c->turned : &c->kept) += fabs(area);
  c->removed += wedge;
  c->moved += fabs(wedge);
}

// Whether the triangles of the inclined faces keep their sides, up to folds beside curved faces. Where
// two faces would pass through each other, half of their area is turned over.
static bool keeps_sides(const Draft *d, const CagMesh *moved) {
  const CagMesh *m = d->m->mesh;
  double before[10] = {0}, after[10] = {0};
  Changes c = {0};
  for (size_t t = 0; t < moved->triangle_count; t++) {
    const size_t i = incline_of(d, t);
    CagVec3 old[3], now[3];
    if (i == d->n) continue;
    for (size_t k = 0; k < 3; k++) {
      old[k] = m->positions[cag_mesh_corner(m, 3 * t + k)];
      now[k] = moved->positions[moved->triangles[3 * t + k]];
    }
    add_changes(d, i, old, now, &c);
  }
  if (c.turned <= FOLDED * c.kept) return true;
  cag_mesh_volume_terms(m, before);
  cag_mesh_volume_terms(moved, after);
  return c.turned <= FOLDED_MOST * c.kept &&
         fabs(before[0] - after[0] - c.removed) <= WEDGES * c.moved;
}

// The union of the mesh with itself, which has the same volume unless it overlaps.
static CagStatus without_overlaps(const CagMesh *m, double tolerance, CagMesh **out,
                                  CagError *err) {
  CagMesh *clean = NULL;
  double own[10] = {0}, whole[10] = {0};
  CagStatus status = cag_mesh_boolean_many(CAG_UNION, &m, 1, NULL, &clean, err);
  if (status) return status;
  cag_mesh_volume_terms(m, own);
  cag_mesh_volume_terms(clean, whole);
  if (own[0] > 0 && fabs(own[0] - whole[0]) <= FOLDS * tolerance * cag_mesh_area(m)) {
    *out = clean;
    return CAG_OK;
  }
  cag_mesh_release(clean);
  return fail_overlap(err);
}

static CagStatus draft_mesh(Draft *d, CagMesh **out, CagError *err) {
  const CagMesh *m = d->m->mesh;
  CagMesh *moved = NULL;
  d->planes = cag_calloc(d->n + 1, sizeof *d->planes);
  d->steps = cag_calloc(m->vertex_count + 1, sizeof *d->steps);
  d->count = cag_calloc(m->vertex_count + 1, sizeof *d->count);
  CagStatus status = d->planes && d->steps && d->count ? CAG_OK : cag_fail_memory(err);
  for (size_t t = 0; !status && t < m->triangle_count; t++) status = add_triangle(d, t, err);
  if (!status) status = moved_mesh(d, &moved, err);
  if (!status && !keeps_sides(d, moved)) status = fail_overlap(err);
  if (!status) status = without_overlaps(moved, d->tolerance, out, err);
  cag_mesh_release(moved);
  cag_free(d->planes);
  cag_free(d->steps);
  cag_free(d->count);
  return status;
}

CagStatus cag_solid_incline(const CagSolid *s, const CagSolidFace *faces, size_t n, double angle,
                            CagVec3 at, CagVec3 pull, double tolerance, CagSolid **out,
                            CagError *err) {
  CagFaceMesh m;
  CagMesh *made = NULL;
  CagStatus status = cag_solid_face_mesh(s, tolerance, &m, err);
  if (status) return status;
  Draft d = {.m = &m,
             .faces = faces,
             .n = n,
             .at = at,
             .pull = pull,
             .angle = angle,
             .tolerance = tolerance};
  status = draft_mesh(&d, &made, err);
  if (!status) status = cag_solid_from_mesh(made, out, err);
  cag_mesh_release(made);
  cag_face_mesh_free(&m);
  return status;
}
