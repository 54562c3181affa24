// Area, volume, centroid and inertia of solids, closed surfaces, meshes, and groups of these.

#include "interp/builtin/solids.h"

// Integrals over the body: of 1; of x, y, z; of xx, yy, zz, xy, yz, zx, about the origin.
typedef struct Body {
  double area;
  double terms[10];
} Body;

static CagStatus solid_body(const CagSolid *s, Body *out, CagError *err) {
  CagMassProperties mass;
  CagStatus status = cag_solid_mass(s, &mass, err);
  if (status != CAG_OK) return status;
  CagVec3 c = mass.volume_centroid;
  double v = mass.volume, trace = 0;
  const double x[3] = {c.x, c.y, c.z};
  for (int i = 0; i < 3; i++) trace += mass.inertia[i][i] / 2;
  out->area = mass.area;
  out->terms[0] = v;
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3;
    out->terms[1 + i] = v * x[i];
    // The matrix holds trace - xx on its diagonal and -xy beside it, about the centroid.
    out->terms[4 + i] = trace - mass.inertia[i][i] + v * x[i] * x[i];
    out->terms[7 + i] = -mass.inertia[i][j] + v * x[i] * x[j];
  }
  return CAG_OK;
}

static CagStatus mesh_body(const CagMesh *m, bool volume, Body *out, CagError *err) {
  CagVec3 edge[2];
  out->area = cag_mesh_area(m);
  if (!volume) return CAG_OK;
  if (!cag_mesh_is_watertight(m, edge))
    return cag_fail(
        err, CAG_E_ARGUMENT, "mesh-open", "", -1,
        "the mesh is not closed: the edge from [%g, %g, %g] to [%g, %g, %g] has not two "
        "faces; it holds no volume",
        edge[0].x, edge[0].y, edge[0].z, edge[1].x, edge[1].y, edge[1].z);
  cag_mesh_volume_terms(m, out->terms);
  return CAG_OK;
}

static CagStatus surface_body(const CagSurface *s, bool volume, Body *out, CagError *err) {
  CagVec3 centroid;
  CagStatus status = cag_surface_area(s, &out->area, &centroid, err);
  if (status != CAG_OK || !volume) return status;
  if (!cag_surface_is_closed(s))
    return cag_fail(err, CAG_E_ARGUMENT, "surface-open", "", -1,
                    "the surface has a boundary, so it holds no volume");
  status = cag_surface_volume_terms(s, out->terms, err);
  // A surface that is inside out is the same body.
  for (int i = 9; i >= 0; i--)
    if (out->terms[0] < 0) out->terms[i] = -out->terms[i];
  return status;
}

static bool shape_body(CagCall *call, CagValue v, bool volume, Body *out) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagError err;
  *out = (Body){0};
  switch (v.type) {
  case CAG_SOLID: return cag_geometry_ok(call, solid_body(shape->as.solid, out, &err), &err);
  case CAG_MESH: return cag_geometry_ok(call, mesh_body(shape->as.mesh, volume, out, &err), &err);
  case CAG_SURFACE:
    return cag_geometry_ok(call, surface_body(shape->as.surface, volume, out, &err), &err);
  default:
    return cag_fail_call(call, 0, CAG_ERR_type, "expects solids, surfaces and meshes, found %s",
                         cag_type_article(v));
  }
}

static bool read_body(CagCall *call, bool volume, Body *out) {
  CagBuilder *builder = cag_builder_new(call->vm);
  if (!cag_shapes_collect(call, call->values[0], builder)) return false;
  const CagList *shapes = CAG_AS_LIST(cag_builder_finish(call->vm, builder));
  *out = (Body){0};
  for (size_t i = 0; i < shapes->length; i++) {
    Body one;
    if (!shape_body(call, cag_list_get(call->vm, shapes, i), volume, &one)) return false;
    out->area += one.area;
    for (int k = 0; k < 10; k++) out->terms[k] += one.terms[k];
  }
  return true;
}

bool cag_solids_area(CagCall *call, CagValue *result) {
  Body body;
  if (!read_body(call, false, &body)) return false;
  *result = cag_number(body.area);
  return true;
}

bool cag_solids_volume(CagCall *call, CagValue *result) {
  Body body;
  if (!read_body(call, true, &body)) return false;
  *result = cag_number(body.terms[0]);
  return true;
}

static bool read_massive(CagCall *call, Body *body, CagVec3 *center) {
  if (!read_body(call, true, body)) return false;
  if (body->terms[0] == 0)
    return cag_fail_call(call, 0, CAG_ERR_value, "expects a body with a volume, found none");
  *center =
      cag_scaled(cag_vec3(body->terms[1], body->terms[2], body->terms[3]), 1 / body->terms[0]);
  return true;
}

bool cag_solids_centroid(CagCall *call, CagValue *result) {
  Body body;
  CagVec3 center;
  if (!read_massive(call, &body, &center)) return false;
  *result = cag_point(call->vm, center, 3);
  return true;
}

bool cag_solids_inertia(CagCall *call, CagValue *result) {
  static const char *const names[] = {"mass", "center", "matrix"};
  Body body;
  CagVec3 center;
  double density, *m;
  if (!cag_arg_number_or(call, 1, 1, &density) || !read_massive(call, &body, &center)) return false;
  const double c[3] = {center.x, center.y, center.z};
  double second[3], product[3], v = body.terms[0];
  for (int i = 0; i < 3; i++) {
    second[i] = body.terms[4 + i] - v * c[i] * c[i];
    product[i] = body.terms[7 + i] - v * c[i] * c[(i + 1) % 3];
  }
  CagValue matrix = cag_list_vectors(call->vm, 3, 3, &m);
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    m[3 * i + i] = density * (second[j] + second[k]);
    m[3 * i + j] = m[3 * j + i] = -density * product[i];
  }
  CagValue values[] = {cag_number(density * v), cag_point(call->vm, center, 3), matrix};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}
