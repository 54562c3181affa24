// Constructors of solids: primitives, prisms, rods, and closed shells.

#include "geom/meet/quadric_body.h"
#include "geom/solid/csg.h"
#include "geom/solid/rounded.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/solids.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"
#include "interp/vm/vm.h"

// Reads positive sizes in x, y, and z: one for all, or three.
static bool read_size(CagCall *call, CagValue v, CagVec3 *size) {
  int dimension = 0;
  if (v.type == CAG_NUMBER) {
    if (!cag_arg_positive(call, 0, &size->x)) return false;
    size->y = size->z = size->x;
    return true;
  }
  if (v.type == CAG_LIST && !cag_arg_vec(call, 0, size, &dimension)) return false;
  return dimension == 3 || cag_fail_type(call, 0, "a number or the sizes [x, y, z]");
}

bool cag_solids_box(CagCall *call, const struct cag_solids_box *a, CagValue *result) {
  CagVec3 size;
  CagSolid *s = NULL;
  if (!read_size(call, a->size, &size)) return false;
  return cag_solid_result(call, cag_solid_box(size, a->centered, &s, call->err), &s, result);
}

bool cag_solids_superellipsoid(CagCall *call, const struct cag_solids_superellipsoid *a,
                               CagValue *result) {
  const double least = 0.02, most = 2; // edges of the least one are rounded by about 1% of the size
  CagVec3 size;
  CagSurface *face = NULL;
  CagSolid *s = NULL;
  if (!read_size(call, a->size, &size)) return false;
  if (!(size.x > 0 && size.y > 0 && size.z > 0)) return cag_fail_value(call, 0, "positive sizes");
  if (!(a->e >= least && a->e <= most)) return cag_fail_value(call, 1, "a number from 0.02 to 2");
  if (!(a->n >= least && a->n <= most)) return cag_fail_value(call, 2, "a number from 0.02 to 2");
  CagStatus status = cag_surface_superellipsoid(size, a->e, a->n, &face, call->err);
  if (!status) status = cag_solid_shell(&face, 1, &s, call->err);
  if (face) cag_surface_release(face);
  return cag_solid_result(call, status, &s, result);
}

bool cag_solids_sphere(CagCall *call, const struct cag_solids_sphere *a, CagValue *result) {
  CagSolid *s = NULL;
  return cag_solid_result(call, cag_solid_sphere(a->radius, &s, call->err), &s, result);
}

bool cag_solids_rounded_box(CagCall *call, const struct cag_solids_rounded_box *a,
                            CagValue *result) {
  CagVec3 size;
  CagSolid *s = NULL;
  if (!read_size(call, a->size, &size)) return false;
  return cag_solid_result(call, cag_solid_rounded_box(size, a->radius, a->centered, &s, call->err),
                          &s, result);
}

// A solid that stands on z = 0, or with its middle there. Takes ownership of the solid.
static bool standing_result(CagCall *call, CagStatus status, CagSolid *s, double height,
                            bool centered, CagValue *result) {
  CagSolid *moved = NULL;
  if (status || !centered) return cag_solid_result(call, status, &s, result);
  const CagTransform down = cag_translate(cag_vec3(0, 0, -height / 2));
  status = cag_solid_transform(s, &down, &moved, call->err);
  cag_solid_release(s);
  return cag_solid_result(call, status, &moved, result);
}

bool cag_solids_rounded_cylinder(CagCall *call, const struct cag_solids_rounded_cylinder *a,
                                 CagValue *result) {
  CagSolid *s = NULL;
  const CagStatus status =
      cag_solid_rounded_cylinder(a->height, a->radius, a->fillet, &s, call->err);
  return standing_result(call, status, s, a->height, a->centered, result);
}

// A cylinder or frustum about Z.
static bool upright_result(CagCall *call, double height, double radius, double top, bool centered,
                           CagValue *result) {
  CagSolid *s = NULL;
  const CagStatus status = cag_solid_cylinder(height, radius, top, &s, call->err);
  return standing_result(call, status, s, height, centered, result);
}

bool cag_solids_cylinder(CagCall *call, const struct cag_solids_cylinder *a, CagValue *result) {
  return upright_result(call, a->height, a->radius, a->top, a->centered, result);
}

bool cag_solids_cone(CagCall *call, const struct cag_solids_cone *a, CagValue *result) {
  return upright_result(call, a->height, a->radius, 0, a->centered, result);
}

bool cag_solids_prism(CagCall *call, const struct cag_solids_prism *a, CagValue *result) {
  const struct cag_surfaces_extrude extrusion = {.C = a->region,
                                                 .height = cag_number(a->height),
                                                 .scale = 1,
                                                 .caps = true,
                                                 .fillet = cag_unset(),
                                                 .chamfer = cag_unset(),
                                                 .centered = a->centered};
  return cag_surfaces_extrude(call, &extrusion, result);
}

CagStatus cag_solid_rod(CagVec3 p, CagVec3 q, double radius, double top, CagSolid **out,
                        CagError *err) {
  CagVec3 along = cag_sub(q, p);
  double height = cag_norm(along);
  if (height == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_same_points, "", -1,
                    "the two ends of the rod are the same point");
  CagVec3 side = cag_cross(cag_vec3(0, 0, 1), along);
  // If the axis is nearly vertical, any horizontal direction will do.
  if (cag_norm(side) <= 1e-12 * height) side = cag_vec3(1, 0, 0);
  CagTransform frame;
  CagSolid *standing = NULL;
  CagStatus status = cag_axes(p, side, cag_cross(along, side), &frame, err);
  if (!status) status = cag_solid_cylinder(height, radius, top, &standing, err);
  if (!status) status = cag_solid_transform(standing, &frame, out, err);
  cag_solid_release(standing);
  return status;
}

bool cag_solids_rod(CagCall *call, const struct cag_solids_rod *a, CagValue *result) {
  CagSolid *s = NULL;
  return cag_solid_result(call, cag_solid_rod(a->P.at, a->Q.at, a->radius, a->top, &s, call->err),
                          &s, result);
}

bool cag_solids_torus(CagCall *call, const struct cag_solids_torus *a, CagValue *result) {
  CagSolid *s = NULL;
  return cag_solid_result(call, cag_solid_torus(a->major, a->minor, &s, call->err), &s, result);
}

// Collects the faces of a closed body: surfaces, and regions as planar surfaces.
static bool collect_faces(CagCall *call, const CagList *shapes, CagSurface **faces) {
  for (size_t i = 0; i < shapes->length; i++) {
    CagValue v = cag_list_get(call->vm, shapes, i);
    const CagShape *shape = CAG_AS_SHAPE(v);
    if (v.type == CAG_SURFACE) {
      faces[i] = cag_surface_retain(shape->as.surface);
    } else if (v.type == CAG_REGION) {
      if (!cag_geometry_ok(
              call, cag_surface_planar(shape->as.region, shape->placement, &faces[i], call->err)))
        return false;
    } else {
      return cag_fail_call(call, 0, CAG_ERR_type, "expects surfaces and regions, found %s",
                           cag_type_article(v));
    }
  }
  return true;
}

// Makes a solid of surfaces, which either are closed or are pieces of one quadric that planar faces
// can close.
static CagStatus close_faces(CagCall *call, CagSurface **faces, size_t n, CagSolid **out,
                             CagError *err) {
  CagStatus status = cag_solid_shell(faces, n, out, err);
  if (!status || !cag_solid_has_quadric_body(faces, n)) return status;
  return cag_solid_quadric_body(faces, n, cag_vm_stop(call->vm), out, err);
}

static bool solid_of_mesh(CagCall *call, CagValue v, CagValue *result) {
  CagSolid *s = NULL;
  if (!cag_solid_result(call, cag_solid_from_mesh(CAG_AS_SHAPE(v)->as.mesh, &s, call->err), &s,
                        result))
    return false;
  cag_shape_say_alike(*result, v);
  return true;
}

static bool solid_of_faces(CagCall *call, const CagList *shapes, CagValue *result) {
  CagSolid *s = NULL;
  CagSurface **faces = cag_hold_surface_array(call, shapes->length);
  if (!collect_faces(call, shapes, faces) ||
      !cag_solid_result(call, close_faces(call, faces, shapes->length, &s, call->err), &s, result))
    return false;
  cag_shape_say_alike(*result, cag_list_get(call->vm, shapes, 0));
  return true;
}

// Whether v is a quadratic form: ten numbers, or its rows.
static bool is_form(CagValue v) {
  return v.type == CAG_LIST && ((CAG_AS_LIST(v)->dim == 1 && CAG_AS_LIST(v)->length == 10) ||
                                (CAG_AS_LIST(v)->dim == 4 && CAG_AS_LIST(v)->length == 4));
}

bool cag_solids_solid(CagCall *call, CagValue *result) {
  const CagValue v = call->values[0];
  CagQuadric q;
  if (is_form(v))
    return cag_surfaces_read_form(call, &q) && cag_solids_of_form(call, &q, 1, result);
  if (cag_given(call, 1))
    return cag_fail_call(
        call, 1, CAG_ERR_value,
        "accepts `within` only for a quadric given by its 10 numbers or 4 rows; a surface has its own range");
  if (v.type == CAG_SOLID) {
    *result = v;
    return true;
  }
  if (v.type == CAG_MESH) return solid_of_mesh(call, v, result);
  CagList *shapes;
  if (!cag_list_shapes(call, v, &shapes)) return false;
  if (shapes->length == 0) return cag_fail_call(call, 0, CAG_ERR_value, "expects surfaces");
  const CagValue first = cag_list_get(call->vm, shapes, 0);
  if (shapes->length == 1 && first.type == CAG_MESH) return solid_of_mesh(call, first, result);
  return solid_of_faces(call, shapes, result);
}
