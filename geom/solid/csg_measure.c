// Bounds and mass of solids without faces.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/solid/csg.h"
#include "geom/solid/tessellate.h"

// Tolerance of meshes for bounds and for a first estimate of a mass, as a fraction of the size.
#define FINE_SHARE 1e-4
// Masses are accurate to 2e-3: fraction of the volume that the mesh may miss.
#define VOLUME_SLACK 1.5e-3
// The finest mesh used for a mass, as a fraction of the size.
#define FINEST_SHARE 1e-5
// Unions of more solids are not searched for overlapping pairs.
#define PAIRS_MOST 2000

static bool apart(const CagBounds *a, const CagBounds *b) {
  return a->max.x < b->min.x || b->max.x < a->min.x || a->max.y < b->min.y || b->max.y < a->min.y ||
         a->max.z < b->min.z || b->max.z < a->min.z;
}

static CagStatus mesh_at(const CagSolid *s, double share, CagMesh **out, CagError *err) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagBounds reach;
  CagStatus status = cag_solid_reach(s, &reach, err);
  if (status) return status;
  double size = cag_norm(cag_sub(reach.max, reach.min));
  // If the bounds are not known yet, a mesh with the default tolerance determines them.
  if (!isfinite(size)) {
    status = cag_csg_mesh(s, &how, out, err);
    if (status) return status;
    cag_mesh_release(*out);
    status = cag_solid_reach(s, &reach, err);
    size = cag_norm(cag_sub(reach.max, reach.min));
  }
  if (status) return status;
  how.tolerance = isfinite(size) ? share * size : 0;
  return cag_csg_mesh(s, &how, out, err);
}

// An operand with its placement in the world.
static CagStatus placed(const CagSolid *s, size_t index, CagSolid **out, CagError *err) {
  return cag_solid_transform(s->core->operands[index], &s->placement, out, err);
}

// --- Bounds ---

static CagStatus fail_empty(const CagSolid *s, CagError *err) {
  char first[80], second[80];
  if (!s->core->count)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_empty_shape, "", -1,
                    s->kind == CAG_SOLID_UNION ? "the solid is empty, so its bounds are undefined"
                                               : "the form is nowhere negative");
  cag_solid_describe_form(s->core->operands[0], first, sizeof first);
  if (s->core->count < 2)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_empty_shape, "", -1, "the %s of (%s) is empty",
                    cag_solid_kind_name(s->kind), first);
  cag_solid_describe_form(s->core->operands[1], second, sizeof second);
  return cag_fail(
      err, CAG_E_DEGENERATE, CAG_ERR_empty_shape, "", -1,
      s->kind == CAG_SOLID_UNION ? "the %s of (%s) and (%s)%s is empty: all of them are"
      : s->kind == CAG_SOLID_DIFFERENCE
          ? "the %s of (%s) and (%s)%s is empty: the first is covered; make it larger, or move it"
          : "the %s of (%s) and (%s)%s is empty: they do not overlap; move them together",
      cag_solid_kind_name(s->kind), first, second, s->core->count > 2 ? " and others" : "");
}

// Each bound of the solid is between those of its mesh and of its reach; if these differ by at most
// the tolerance, use the reach, which is more often exact.
static void snap(CagBounds *b, const CagBounds *reach, double tolerance) {
  double *at[6] = {&b->min.x, &b->min.y, &b->min.z, &b->max.x, &b->max.y, &b->max.z};
  const double to[6] = {reach->min.x, reach->min.y, reach->min.z,
                        reach->max.x, reach->max.y, reach->max.z};
  for (int i = 0; i < 6; i++)
    if (fabs(*at[i] - to[i]) <= tolerance) *at[i] = to[i];
}

static CagStatus mesh_bounds(const CagSolid *s, CagBounds *out, CagError *err) {
  CagMesh *m;
  CagStatus status = mesh_at(s, FINE_SHARE, &m, err);
  if (status) return status;
  *out = cag_mesh_bounds(m);
  const bool empty = m->triangle_count == 0;
  cag_mesh_release(m);
  if (empty) return fail_empty(s, err);
  CagBounds reach;
  status = cag_solid_reach(s, &reach, err);
  if (status) return status;
  snap(out, &reach, FINE_SHARE * cag_norm(cag_sub(reach.max, reach.min)));
  return CAG_OK;
}

static CagStatus union_bounds(const CagSolid *s, CagBounds *out, CagError *err) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  bool empty = true;
  for (size_t i = 0; i < s->core->count; i++) {
    CagSolid *part;
    CagBounds one;
    CagStatus status = placed(s, i, &part, err);
    if (status) return status;
    status = cag_solid_bounds(part, &one, err);
    cag_solid_release(part);
    if (status && cag_is_empty_shape(err)) continue;
    if (status) return status;
    empty = false;
    cag_bounds_add(&box, one.min);
    cag_bounds_add(&box, one.max);
  }
  if (empty) return fail_empty(s, err);
  *out = box;
  return CAG_OK;
}

// Whether each side of the first operand's bounds has a point that is not near anything subtracted;
// then the difference has the same bounds.
static CagStatus keeps_sides(const CagMesh *first, const CagBounds *box, double slack,
                             const CagBounds *others, size_t n, bool *keeps) {
  bool kept[6] = {false};
  for (size_t i = 0; i < first->vertex_count; i++) {
    CagVec3 p = first->positions[i];
    const CagBounds here = {p, p};
    const double off[6] = {p.x - box->min.x, p.y - box->min.y, p.z - box->min.z,
                           box->max.x - p.x, box->max.y - p.y, box->max.z - p.z};
    bool near = false, asked = false;
    for (int k = 0; k < 6; k++) asked = asked || (!kept[k] && off[k] <= slack);
    for (size_t k = 0; asked && !near && k < n; k++) near = !apart(&here, &others[k]);
    for (int k = 0; asked && !near && k < 6; k++) kept[k] = kept[k] || off[k] <= slack;
  }
  *keeps = kept[0] && kept[1] && kept[2] && kept[3] && kept[4] && kept[5];
  return CAG_OK;
}

static CagStatus difference_keeps(const CagSolid *s, const CagSolid *first, const CagBounds *box,
                                  bool *keeps, CagError *err) {
  CagBounds *others = cag_malloc(s->core->count * sizeof *others);
  if (!others) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  size_t n = 0;
  for (size_t i = 1; !status && i < s->core->count; i++) {
    CagSolid *part;
    status = placed(s, i, &part, err);
    if (status) break;
    status = cag_solid_reach(part, &others[n], err);
    cag_solid_release(part);
    if (!status && !apart(&others[n], box)) n++;
  }
  *keeps = !status && n == 0;
  if (!status && n > 0 && !cag_solid_is_compound(first)) {
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m;
    double size = cag_norm(cag_sub(box->max, box->min));
    how.tolerance = FINE_SHARE * size;
    status = cag_solid_tessellate(first, &how, &m, err);
    if (!status) {
      status = keeps_sides(m, box, how.tolerance, others, n, keeps);
      cag_mesh_release(m);
    }
  }
  cag_free(others);
  return status;
}

static CagStatus difference_bounds(const CagSolid *s, CagBounds *out, CagError *err) {
  CagSolid *first;
  CagBounds box, reach;
  bool keeps = false;
  CagStatus status = cag_solid_reach(s, &reach, err);
  if (status) return status;
  if (!isfinite(cag_norm(cag_sub(reach.max, reach.min)))) return mesh_bounds(s, out, err);
  status = placed(s, 0, &first, err);
  if (status) return status;
  status = cag_solid_bounds(first, &box, err);
  if (!status) status = difference_keeps(s, first, &box, &keeps, err);
  cag_solid_release(first);
  if (status) return status;
  if (!keeps) return mesh_bounds(s, out, err);
  *out = box;
  return CAG_OK;
}

CagStatus cag_csg_bounds(const CagSolid *s, CagBounds *out, CagError *err) {
  switch (s->kind) {
  case CAG_SOLID_MESH: {
    CagMesh *m;
    CagStatus status = cag_mesh_transform(s->core->mesh, &s->placement, &m, err);
    if (status) return status;
    *out = cag_mesh_bounds(m);
    cag_mesh_release(m);
    return CAG_OK;
  }
  case CAG_SOLID_UNION: return union_bounds(s, out, err);
  case CAG_SOLID_DIFFERENCE: return difference_bounds(s, out, err);
  default: return mesh_bounds(s, out, err);
  }
}

CagStatus cag_solid_is_empty(const CagSolid *s, bool *out, CagError *err) {
  CagBounds unused;
  *out = false;
  if (s->face_count > 0) return CAG_OK;
  const CagStatus status = cag_csg_bounds(s, &unused, err);
  *out = status && cag_is_empty_shape(err);
  // An unbounded solid is not empty.
  return *out || (status && err->id == CAG_ERR_solid_unbounded) ? CAG_OK : status;
}

// --- Mass ---

// From integrals of 1; x, y, z; xx, yy, zz, xy, yz, zx about a point.
static void set_volume(const double terms[10], CagVec3 about, CagMassProperties *m) {
  const double v = terms[0];
  double c[3], second[3];
  for (int i = 0; i < 3; i++) {
    c[i] = v != 0 ? terms[1 + i] / v : 0;
    second[i] = terms[4 + i] - v * c[i] * c[i];
  }
  m->volume = v;
  m->volume_centroid = cag_add(about, cag_vec3(c[0], c[1], c[2]));
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3;
    m->inertia[i][i] = second[j] + second[(i + 2) % 3];
    m->inertia[i][j] = m->inertia[j][i] = v * c[i] * c[j] - terms[7 + i];
  }
}

static CagStatus mass_of_mesh(const CagMesh *m, CagMassProperties *out, CagError *err) {
  *out = (CagMassProperties){0};
  if (m->triangle_count == 0) return CAG_OK;
  CagBounds box = cag_mesh_bounds(m);
  CagVec3 middle = cag_lerp(box.min, box.max, 0.5), moment = {0, 0, 0};
  CagTransform shift = cag_translate(cag_scaled(middle, -1));
  CagMesh *near;
  double terms[10] = {0};
  CagStatus status = cag_mesh_transform(m, &shift, &near, err);
  if (status) return status;
  cag_mesh_volume_terms(near, terms);
  for (size_t i = 0; i < near->triangle_count; i++) {
    const uint32_t *t = near->triangles + 3 * i;
    CagVec3 a = near->positions[t[0]], b = near->positions[t[1]], c = near->positions[t[2]];
    double area = cag_norm(cag_cross(cag_sub(b, a), cag_sub(c, a))) / 2;
    out->area += area;
    moment = cag_madd(moment, area / 3, cag_add(a, cag_add(b, c)));
  }
  cag_mesh_release(near);
  set_volume(terms, middle, out);
  out->area_centroid = out->area > 0 ? cag_madd(middle, 1 / out->area, moment) : middle;
  return CAG_OK;
}

// Adds a part by the parallel axis theorem.
static void add_mass(CagMassProperties *whole, const CagMassProperties *part) {
  double a = whole->volume, b = part->volume, area = whole->area + part->area;
  if (area > 0)
    whole->area_centroid = cag_lerp(whole->area_centroid, part->area_centroid, part->area / area);
  whole->area = area;
  if (a + b == 0) return;
  CagVec3 offset = cag_sub(part->volume_centroid, whole->volume_centroid);
  const double d[3] = {offset.x, offset.y, offset.z}, share = a * b / (a + b);
  double square = cag_dot(offset, offset);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      whole->inertia[i][k] += part->inertia[i][k] + share * ((i == k ? square : 0) - d[i] * d[k]);
  whole->volume_centroid = cag_madd(whole->volume_centroid, b / (a + b), offset);
  whole->volume = a + b;
}

// Exact mass of a union of disjoint solids. *done: they are disjoint.
static CagStatus mass_of_parts(const CagSolid *s, double tolerance, CagMassProperties *out,
                               bool *done, CagError *err) {
  size_t n = s->core->count;
  *done = false;
  if (s->kind != CAG_SOLID_UNION || n > PAIRS_MOST) return CAG_OK;
  CagBounds *reach = cag_malloc(n * sizeof *reach);
  if (!reach) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++)
    status = cag_solid_reach(s->core->operands[i], &reach[i], err);
  bool separate = !status;
  for (size_t i = 0; separate && i < n; i++)
    for (size_t k = i + 1; separate && k < n; k++) separate = apart(&reach[i], &reach[k]);
  cag_free(reach);
  if (!separate) return status;
  *out = (CagMassProperties){0};
  for (size_t i = 0; !status && i < n; i++) {
    CagSolid *part;
    CagMassProperties one;
    status = placed(s, i, &part, err);
    if (status) break;
    status = cag_solid_mass_within(part, tolerance, &one, err);
    cag_solid_release(part);
    if (!status) add_mass(out, &one);
  }
  *done = true;
  return status;
}

CagStatus cag_solid_mass_within(const CagSolid *s, double tolerance, CagMassProperties *out,
                                CagError *err) {
  return s->face_count == 0 ? cag_csg_mass(s, tolerance, out, err) : cag_solid_mass(s, out, err);
}

// A mesh whose faces are within the tolerance of the surface misses at most the tolerance times the
// area; by default the tolerance is chosen so that this is small relative to the volume.
CagStatus cag_csg_mass(const CagSolid *s, double tolerance, CagMassProperties *out, CagError *err) {
  CagMesh *m = NULL;
  CagMassProperties first;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  bool done = false;
  CagStatus status = CAG_OK;
  how.tolerance = tolerance;
  if (s->kind == CAG_SOLID_MESH) {
    status = cag_mesh_transform(s->core->mesh, &s->placement, &m, err);
  } else {
    if (s->core->count) status = mass_of_parts(s, tolerance, out, &done, err);
    if (status || done) return status;
    status = tolerance > 0 ? cag_csg_mesh(s, &how, &m, err) : mesh_at(s, FINE_SHARE, &m, err);
  }
  if (status) return status;
  status = mass_of_mesh(m, &first, err);
  cag_mesh_release(m);
  if (status) return status;
  *out = first;
  if (s->kind == CAG_SOLID_MESH || tolerance > 0 || !(first.volume > 0)) return CAG_OK;
  CagBounds reach;
  status = cag_solid_reach(s, &reach, err);
  if (status) return status;
  double size = cag_norm(cag_sub(reach.max, reach.min));
  double share = VOLUME_SLACK * first.volume / (first.area * size);
  if (share >= FINE_SHARE) return CAG_OK;
  status = mesh_at(s, fmax(share, FINEST_SHARE), &m, err);
  if (status) return status;
  status = mass_of_mesh(m, out, err);
  cag_mesh_release(m);
  return status;
}
