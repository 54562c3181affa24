// Area, volume, centroid and inertia of solids, closed surfaces, meshes, and groups of these.

#include "geom/solid/csg.h"
#include "interp/builtin/solids.h"

// Second moments (xx, yy, zz, xy, yz, zx) are about the body's own centroid: about a far origin
// they would lose their digits.
typedef struct Body {
  double area, volume;
  double center[3];
  double moment[3], product[3];
} Body;

static CagStatus solid_body(const CagSolid *s, double tolerance, Body *out, CagError *err) {
  CagMassProperties mass;
  CagStatus status = cag_solid_mass_within(s, tolerance, &mass, err);
  if (status) return status;
  const CagVec3 c = mass.volume_centroid;
  *out = (Body){.area = mass.area, .volume = mass.volume, .center = {c.x, c.y, c.z}};
  for (int i = 0; i < 3; i++) {
    out->moment[i] = mass.inertia[i][i];
    out->product[i] = -mass.inertia[i][(i + 1) % 3];
  }
  return CAG_OK;
}

// From integrals of 1; x, y, z; xx, yy, zz, xy, yz, zx about a point near the body.
static void set_body(const double terms[10], CagVec3 about, Body *out) {
  const double at[3] = {about.x, about.y, about.z};
  const double v = terms[0];
  double c[3] = {0, 0, 0}, second[3];
  for (int i = 0; v != 0 && i < 3; i++) c[i] = terms[1 + i] / v;
  out->volume = v;
  for (int i = 0; i < 3; i++) {
    out->center[i] = at[i] + c[i];
    second[i] = terms[4 + i] - v * c[i] * c[i];
    out->product[i] = terms[7 + i] - v * c[i] * c[(i + 1) % 3];
  }
  for (int i = 0; i < 3; i++) out->moment[i] = second[(i + 1) % 3] + second[(i + 2) % 3];
}

static CagTransform to_middle(const CagBounds *box, CagVec3 *middle) {
  *middle = cag_lerp(box->min, box->max, 0.5);
  return cag_translate(cag_scaled(*middle, -1));
}

static CagStatus mesh_body(const CagMesh *m, bool volume, Body *out, CagError *err) {
  CagVec3 edge[2], middle;
  CagMesh *near;
  double terms[10] = {0};
  out->area = cag_mesh_area(m);
  if (!volume || m->vertex_count == 0) return CAG_OK;
  if (!cag_mesh_is_watertight(m, edge))
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_mesh_open, "", -1,
        "the mesh is not closed, so it has no volume: the edge from [%g, %g, %g] to [%g, %g, %g] does not belong to two faces",
        edge[0].x, edge[0].y, edge[0].z, edge[1].x, edge[1].y, edge[1].z);
  const CagBounds box = cag_mesh_bounds(m);
  const CagTransform shift = to_middle(&box, &middle);
  CagStatus status = cag_mesh_transform(m, &shift, &near, err);
  if (status) return status;
  cag_mesh_volume_terms(near, terms);
  cag_mesh_release(near);
  set_body(terms, middle, out);
  return CAG_OK;
}

static CagStatus surface_body(const CagSurface *s, bool volume, Body *out, CagError *err) {
  CagVec3 centroid, middle;
  CagBounds box;
  CagSurface *near;
  double terms[10] = {0};
  CagStatus status = cag_surface_area(s, &out->area, &centroid, err);
  if (status || !volume) return status;
  if (!cag_surface_is_closed(s))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_surface_open, "", -1,
                    "the surface is open, so it has no volume");
  status = cag_surface_bounds(s, &box, err);
  if (status) return status;
  const CagTransform shift = to_middle(&box, &middle);
  status = cag_surface_transform(s, &shift, &near, err);
  if (status) return status;
  status = cag_surface_volume_terms(near, terms, err);
  cag_surface_release(near);
  // A surface that is inside out is the same body.
  for (int i = 9; i >= 0; i--)
    if (terms[0] < 0) terms[i] = -terms[i];
  set_body(terms, middle, out);
  return status;
}

// The two as one body (Steiner's theorem).
static void join_bodies(Body *whole, const Body *part) {
  const double a = whole->volume, b = part->volume, v = a + b;
  whole->area += part->area;
  if (a == 0 || v == 0) {
    const double area = whole->area;
    if (a == 0) *whole = *part;
    whole->area = area, whole->volume = v;
    return;
  }
  double d[3];
  for (int i = 0; i < 3; i++) {
    d[i] = part->center[i] - whole->center[i];
    whole->center[i] += d[i] * (b / v);
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    whole->moment[i] += part->moment[i] + a * (b / v) * (d[j] * d[j] + d[k] * d[k]);
    whole->product[i] += part->product[i] + a * (b / v) * d[i] * d[j];
  }
  whole->volume = v;
}

static bool shape_body(CagCall *call, CagValue v, bool volume, Body *out) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  *out = (Body){0};
  switch (v.type) {
  case CAG_SOLID:
    return cag_geometry_ok(call, solid_body(shape->as.solid, shape->tolerance, out, call->err));
  case CAG_MESH: return cag_geometry_ok(call, mesh_body(shape->as.mesh, volume, out, call->err));
  case CAG_SURFACE:
    return cag_geometry_ok(call, surface_body(shape->as.surface, volume, out, call->err));
  default:
    return cag_fail_call(call, 0, CAG_ERR_type, "expects solids, surfaces, and meshes, found %s",
                         cag_type_article(v));
  }
}

bool cag_list_shapes(CagCall *call, CagValue v, CagList **out) {
  CagBuilder *builder = cag_builder_new(call->vm);
  if (!cag_shapes_collect(call, v, builder)) return false;
  *out = CAG_AS_LIST(cag_builder_finish(call->vm, builder));
  return true;
}

static bool read_body(CagCall *call, bool volume, Body *out) {
  CagList *shapes;
  if (!cag_list_shapes(call, call->values[0], &shapes)) return false;
  *out = (Body){0};
  for (size_t i = 0; i < shapes->length; i++) {
    Body one;
    if (i % CAG_LOOK_UP == 0 && !cag_keep_going(call->vm)) return false;
    if (!shape_body(call, cag_list_get(call->vm, shapes, i), volume, &one)) return false;
    join_bodies(out, &one);
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
  *result = cag_number(body.volume);
  return true;
}

// *empty: nothing is left of the shapes.
static bool read_massive(CagCall *call, Body *body, bool *empty) {
  if (!read_body(call, true, body)) return false;
  *empty = body->volume == 0 && body->area == 0;
  return body->volume != 0 || *empty ||
         cag_fail_call(call, 0, CAG_ERR_value, "expects a body with a volume, found one without");
}

static CagValue center_value(CagCall *call, const Body *body) {
  const double *c = body->center;
  return cag_point(call->vm, cag_vec3(c[0], c[1], c[2]), 3);
}

bool cag_solids_centroid(CagCall *call, CagValue *result) {
  Body body;
  bool empty;
  if (!read_massive(call, &body, &empty)) return false;
  if (empty)
    return cag_fail_call(call, 0, CAG_ERR_empty_shape,
                         "expects a body with a volume, found an empty one");
  *result = center_value(call, &body);
  return true;
}

bool cag_solids_inertia(CagCall *call, const struct cag_solids_inertia *a, CagValue *result) {
  static const char *const names[] = {"mass", "center", "matrix"};
  Body body;
  bool empty;
  double *m;
  if (!read_massive(call, &body, &empty)) return false;
  CagValue matrix = cag_list_vectors(call->vm, 3, 3, &m);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3;
    m[3 * i + i] = a->density * body.moment[i];
    m[3 * i + j] = m[3 * j + i] = 0 - a->density * body.product[i];
  }
  const CagValue center = empty ? cag_none() : center_value(call, &body);
  CagValue values[] = {cag_number(a->density * body.volume), center, matrix};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}
