// Bodies below fields of heights.

#include "geom/mesh/height_field.h"
#include "geom/solid/csg.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/image_calls.h"
#include "interp/builtin/solids.h"
#include "interp/vm/vm.h"

static bool check_heights(CagCall *call, const CagRaster *r) {
  enum { FEWEST = 2 };
  if (r->width < FEWEST || r->height < FEWEST)
    return cag_fail_call(call, 0, CAG_ERR_too_few_points,
                         "expects at least 2 rows and 2 columns, found %zu and %zu", r->height,
                         r->width);
  for (size_t y = 0; y < r->height; y++) {
    if (!cag_keep_going(call->vm)) return false;
    for (size_t x = 0; x < r->width; x++) {
      const double value = *cag_raster_at(r, 0, x, y);
      if (value >= 0 && value <= 1) continue;
      cag_fail_call(call, 0, CAG_ERR_value,
                    "expects values from 0 to 1, found %.9g in row %zu, column %zu", value, y, x);
      return cag_fail_help(call->vm, isnan(value)
                                         ? "each pixel needs a value"
                                         : "map the values to 0..1, and state the range by `size`");
    }
  }
  return true;
}

bool cag_solids_height_field(CagCall *call, const struct cag_solids_height_field *a,
                             CagValue *result) {
  CagVec3 size = {0, 0, 0};
  int dimension = 0;
  CagMesh *mesh = NULL;
  CagSolid *s = NULL;
  const bool is_image = a->image.type == CAG_IMAGE;
  CagRaster *r = NULL;
  if (is_image && !cag_arg_image(call, 0, &r)) return false;
  if (!is_image && !(r = cag_held_rows(call, 0))) return false;
  if (!cag_gray_image(call, 0, r) || !cag_arg_vec(call, 1, &size, &dimension)) return false;
  if (dimension != 3 || !(size.x > 0 && size.y > 0 && size.z > 0))
    return cag_fail_value(call, 1, "three positive sizes [x, y, z]");
  if (!check_heights(call, r)) return false;
  const CagHeightField field = {r->data, r->width, r->height, size, a->base};
  if (!cag_geometry_ok(call, cag_mesh_height_field(&field, &mesh, call->err))) return false;
  cag_hold_mesh(call, mesh);
  return cag_solid_result(call, cag_solid_from_mesh(mesh, &s, call->err), &s, result);
}
