// Solids with exact boundaries.
//
// Transformed copies share the boundaries, their measures, and the last mesh that was made of them.

#include "geom/solid/exact.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/boundary/carrier.h"
#include "geom/boundary/face_feature.h"
#include "geom/boundary/measure.h"
#include "geom/boundary/mesh.h"
#include "geom/boundary/moved.h"
#include "geom/boundary/patch.h"
#include "geom/solid/build.h"

// Default tolerance as a fraction of the size (as in tessellate.h).
#define DEFAULT_SHARE 1e-3

// The volume of the faces and that which the kernel finds agree to this fraction. Both are far more
// accurate, unless the kernel's edges are far from its faces.
#define VOLUME_SHARE 1e-3

// The mesh of a check is not shown: where all faces have simple forms, it may turn as far (radians) as
// its tolerance allows, nearly.
#define CHECK_ANGLE (M_PI / 4)

struct CagExact {
  int references;
  CagBoundary *parts;
  size_t count;
  CagMesh *mesh; // in their coordinates; NULL: none yet
  CagTessellation how;
  bool bounded; // `box` is known
  CagBounds box;
  bool measured; // `body` is known
  CagSolidBody body;
};

CagExact *cag_exact_retain(CagExact *e) {
  if (e) e->references++;
  return e;
}

void cag_exact_release(CagExact *e) {
  if (!e || --e->references > 0) return;
  for (size_t i = 0; i < e->count; i++) cag_boundary_free(&e->parts[i]);
  cag_free(e->parts);
  cag_mesh_release(e->mesh);
  cag_free(e);
}

const CagBoundary *cag_solid_boundaries(const CagSolid *s, size_t *n) {
  if (!s->exact) return NULL;
  *n = s->exact->count;
  return s->exact->parts;
}

void cag_exact_digest(const CagExact *e, CagDigest *d) {
  for (size_t i = 0; i < e->count; i++) {
    const CagBoundary *b = &e->parts[i];
    cag_digest_word(d, b->face_count);
    cag_digest_bytes(d, b->corners, b->corner_count * sizeof *b->corners);
    cag_digest_bytes(d, b->body, b->body_length);
    if (b->mesh) cag_mesh_digest(b->mesh, d);
  }
}

// Takes the contents of the boundaries.
static CagStatus exact_new(CagBoundary *parts, size_t n, CagExact **out, CagError *err) {
  CagExact *e = cag_calloc(1, sizeof *e);
  CagBoundary *own = cag_calloc(n + 1, sizeof *own);
  if (!e || !own) {
    for (size_t i = 0; i < n; i++) cag_boundary_free(&parts[i]);
    cag_free(e);
    cag_free(own);
    return cag_fail_memory(err);
  }
  memcpy(own, parts, n * sizeof *own);
  memset(parts, 0, n * sizeof *parts);
  *e = (CagExact){.references = 1, .parts = own, .count = n};
  *out = e;
  return CAG_OK;
}

CagStatus cag_solid_exact(CagBoundary *parts, size_t n, CagSolid **out, CagError *err) {
  CagExact *e;
  CagSolid *s = NULL;
  size_t faces = 0;
  CagStatus status = exact_new(parts, n, &e, err);
  if (status) return status;
  for (size_t i = 0; i < n; i++) faces += e->parts[i].face_count;
  status = cag_solid_block(CAG_SOLID_EXACT, faces, &s, err);
  if (status) {
    cag_exact_release(e);
    return status;
  }
  s->exact = e;
  for (size_t i = 0; !status && i < n; i++)
    for (size_t f = 0; !status && f < e->parts[i].face_count; f++) {
      CagSurface *face;
      status = cag_boundary_surface(&e->parts[i], f, &face, err);
      if (!status) cag_solid_add(s, face);
    }
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}

// --- Measures ---

// Second moments xx yy zz xy yz zx from the inertia: it is their trace minus themselves.
static void second_moments(const CagMassProperties *m, double out[6]) {
  const double trace = (m->inertia[0][0] + m->inertia[1][1] + m->inertia[2][2]) / 2;
  for (int i = 0; i < 3; i++) {
    out[i] = trace - m->inertia[i][i];
    out[3 + i] = -m->inertia[i][(i + 1) % 3];
  }
}

// Adds the moments of a part about its centroid, moved to the centroid of all.
static void add_moments(const CagMassProperties *part, CagVec3 centroid, double moment[6]) {
  const CagVec3 d = cag_sub(part->volume_centroid, centroid);
  const double by[3] = {d.x, d.y, d.z};
  double own[6];
  second_moments(part, own);
  for (int i = 0; i < 3; i++) {
    moment[i] += own[i] + part->volume * by[i] * by[i];
    moment[3 + i] += own[3 + i] + part->volume * by[i] * by[(i + 1) % 3];
  }
}

CagStatus cag_exact_body(CagExact *e, CagSolidBody *out, CagError *err) {
  CagSolidBody body = {0};
  CagMassProperties *parts = e->measured ? NULL : cag_calloc(e->count + 1, sizeof *parts);
  CagStatus status = e->measured || parts ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && parts && i < e->count; i++) {
    status = cag_boundary_mass(&e->parts[i], &parts[i], err);
    if (status) break;
    body.volume += parts[i].volume;
    body.area += parts[i].area;
    body.centroid = cag_madd(body.centroid, parts[i].volume, parts[i].volume_centroid);
    body.area_centroid = cag_madd(body.area_centroid, parts[i].area, parts[i].area_centroid);
  }
  if (!status && parts) {
    body.centroid = cag_scaled(body.centroid, 1 / body.volume);
    body.area_centroid = cag_scaled(body.area_centroid, 1 / body.area);
    for (size_t i = 0; i < e->count; i++) add_moments(&parts[i], body.centroid, body.moment);
    e->body = body;
    e->measured = true;
  }
  cag_free(parts);
  if (!status) *out = e->body;
  return status;
}

// --- Bounds ---

static CagStatus own_bounds(CagExact *e, CagBounds *out, CagError *err) {
  CagBounds all = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; !e->bounded && i < e->count; i++) {
    CagBounds box;
    CagStatus status = cag_boundary_bounds(&e->parts[i], &box, err);
    if (status) return status;
    cag_bounds_add(&all, box.min);
    cag_bounds_add(&all, box.max);
  }
  if (!e->bounded) e->box = all;
  e->bounded = true;
  *out = e->box;
  return CAG_OK;
}

// Whether a transform keeps the directions of the axes, so that it maps bounds to bounds.
static bool keeps_axes(const CagTransform *t) {
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      if (i != k && t->m[i][k] != 0) return false;
  return true;
}

// The range of a coordinate of the images of all points under an affine map: that of a coordinate
// along its row, which is the x of a boundary that is turned.
static CagStatus range_of_row(const CagExact *e, const CagTransform *t, int row, double range[2],
                              CagError *err) {
  const CagVec3 along = cag_vec3(t->m[row][0], t->m[row][1], t->m[row][2]);
  const double length = cag_norm(along);
  range[0] = range[1] = t->m[row][3];
  if (length == 0) return CAG_OK;
  const CagVec3 other = fabs(along.x) < 0.5 * length ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
  CagTransform axes, turn;
  CagBounds all = CAG_BOUNDS_EMPTY;
  CagStatus status = cag_axes(cag_vec3(0, 0, 0), along, other, &axes, err);
  if (!status) status = cag_transform_inverse(&axes, &turn, err);
  for (size_t i = 0; !status && i < e->count; i++) {
    CagBoundary turned;
    CagBounds box;
    status = cag_boundary_moved(&e->parts[i], &turn, &turned, err);
    if (status) break;
    status = cag_boundary_bounds(&turned, &box, err);
    cag_boundary_free(&turned);
    cag_bounds_add(&all, box.min);
    cag_bounds_add(&all, box.max);
  }
  range[0] += length * all.min.x;
  range[1] += length * all.max.x;
  return status;
}

static CagStatus bounds_by_rows(const CagExact *e, const CagTransform *t, CagBounds *out,
                                CagError *err) {
  double range[3][2];
  CagStatus status = CAG_OK;
  for (int row = 0; !status && row < 3; row++) status = range_of_row(e, t, row, range[row], err);
  if (status) return status;
  *out = (CagBounds){cag_vec3(range[0][0], range[1][0], range[2][0]),
                     cag_vec3(range[0][1], range[1][1], range[2][1])};
  return CAG_OK;
}

CagStatus cag_exact_bounds(const CagSolid *s, CagBounds *out, CagError *err) {
  const CagTransform *t = &s->placement;
  CagBounds box = CAG_BOUNDS_EMPTY, all = CAG_BOUNDS_EMPTY;
  double scale;
  CagStatus status = CAG_OK;
  if (keeps_axes(t)) {
    status = own_bounds(s->exact, &box, err);
    cag_bounds_add(&all, cag_transform_point(t, box.min));
    cag_bounds_add(&all, cag_transform_point(t, box.max));
  } else if (cag_transform_is_similarity(t, &scale)) {
    for (size_t i = 0; !status && i < s->exact->count; i++) {
      CagBoundary moved;
      status = cag_boundary_moved(&s->exact->parts[i], t, &moved, err);
      if (status) break;
      status = cag_boundary_bounds(&moved, &box, err);
      cag_boundary_free(&moved);
      cag_bounds_add(&all, box.min);
      cag_bounds_add(&all, box.max);
    }
  } else return bounds_by_rows(s->exact, t, out, err);
  if (!status) *out = all;
  return status;
}

// --- Meshes ---

static bool is_same(const CagTessellation *a, const CagTessellation *b) {
  return a->tolerance == b->tolerance && a->angle == b->angle && a->max_edge == b->max_edge &&
         a->short_edge == b->short_edge;
}

static CagStatus mesh_parts(const CagExact *e, const CagTessellation *how, CagMesh **out,
                            CagError *err) {
  CagMesh **meshes = cag_calloc(e->count + 1, sizeof *meshes);
  size_t n = 0;
  CagStatus status = meshes ? CAG_OK : cag_fail_memory(err);
  while (!status && n < e->count) {
    status = cag_boundary_mesh(&e->parts[n], how, false, &meshes[n], err);
    if (!status) n++;
  }
  if (!status) status = cag_mesh_append(meshes, n, out, err);
  for (size_t i = 0; i < n; i++) cag_mesh_release(meshes[i]);
  cag_free(meshes);
  return status;
}

CagStatus cag_exact_mesh(const CagSolid *s, const CagTessellation *how, CagMesh **out,
                         CagError *err) {
  CagExact *e = s->exact;
  CagTessellation own = how ? *how : CAG_TESSELLATION_DEFAULT;
  const double scale = cag_transform_stretch(&s->placement);
  CagMesh *mesh = NULL;
  CagStatus status = CAG_OK;
  if (!(own.tolerance > 0)) {
    CagBounds box;
    status = cag_solid_bounds(s, &box, err);
    own.tolerance = DEFAULT_SHARE * cag_norm(cag_sub(box.max, box.min));
  }
  if (status) return status;
  own.tolerance /= scale;
  own.max_edge /= scale;
  if (e->mesh && is_same(&own, &e->how) && e->mesh->triangle_count <= own.max_triangles)
    mesh = cag_mesh_retain(e->mesh);
  else status = mesh_parts(e, &own, &mesh, err);
  if (status) return status;
  if (mesh != e->mesh) {
    cag_mesh_release(e->mesh);
    e->mesh = cag_mesh_retain(mesh);
    e->how = own;
  }
  status = cag_mesh_transform(mesh, &s->placement, out, err);
  cag_mesh_release(mesh);
  return status;
}

static CagStatus fail_volumes(const char *what, double found, double volume, CagError *err) {
  char a[32], b[32];
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
                  "its %s the volume %s, and the kernel finds %s", what, cag_number_text(found, a),
                  cag_number_text(volume, b));
}

static bool is_analytic(const CagExact *x) {
  for (size_t i = 0; i < x->count; i++)
    for (size_t k = 0; k < x->parts[i].face_count; k++)
      if (!cag_carrier_is_analytic(&x->parts[i].faces[k].carrier)) return false;
  return true;
}

CagStatus cag_solid_exact_check(const CagSolid *s, CagError *err) {
  double terms[10] = {0}, volume = 0;
  CagSolidBody body;
  CagBounds box;
  CagMesh *mesh;
  for (size_t i = 0; i < s->exact->count; i++) volume += s->exact->parts[i].volume;
  CagStatus status = cag_exact_body(s->exact, &body, err);
  if (status) return status;
  if (!(fabs(body.volume - volume) <= VOLUME_SHARE * volume))
    return fail_volumes("faces enclose", body.volume, volume, err);
  status = cag_solid_bounds(s, &box, err);
  if (status) return status;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = DEFAULT_SHARE * cag_norm(cag_sub(box.max, box.min));
  if (is_analytic(s->exact)) how.angle = CHECK_ANGLE;
  status = cag_exact_mesh(s, &how, &mesh, err);
  if (status) return status;
  cag_mesh_volume_terms(mesh, terms);
  // The mesh and the solid differ by a layer over the surface as thick as the tolerance.
  const double slack = 2 * how.tolerance * cag_mesh_area(mesh);
  cag_mesh_release(mesh);
  if (terms[0] > 0 && fabs(terms[0] - volume) <= slack) return CAG_OK;
  return fail_volumes("mesh encloses", terms[0], volume, err);
}
