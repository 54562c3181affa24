#include "interp/builtin/image_calls.h"

#include "interp/builtin/holds.h"

bool cag_gray_image(CagCall *call, int argument, const CagRaster *r) {
  if (r->channel_count == 1) return true;
  cag_fail_call(call, argument, CAG_ERR_several_channels,
                "expects an image with a single channel, found %zu channels", r->channel_count);
  return cag_fail_help(call->vm, "select a channel with `channel(image, name)`");
}

static bool arg_silhouette(CagCall *call, int argument, CagRegion **out) {
  CagTransform placement;
  const CagValue v = call->values[argument];
  if (v.type != CAG_REGION && v.type != CAG_CURVE && v.type != CAG_LIST)
    return cag_fail_type(call, argument,
                         "an image, a region, a closed plane curve, or a list of points");
  if (!cag_arg_region(call, argument, out, &placement)) return false;
  cag_hold_region(call, *out);
  return placement.planar ||
         cag_fail_call(call, argument, CAG_ERR_value,
                       "expects a region of the plane, found one that was moved into space");
}

bool cag_arg_mass(CagCall *call, int argument, CagMass mass, CagMassOf *out) {
  *out = (CagMassOf){.mass = mass};
  if (call->values[argument].type == CAG_IMAGE) {
    out->raster = CAG_AS_IMAGE(call->values[argument])->raster;
    return cag_gray_image(call, argument, out->raster);
  }
  CagRegion *region;
  if (!arg_silhouette(call, argument, &region)) return false;
  out->region = region;
  return true;
}

bool cag_arg_connectivity(CagCall *call, int argument, int *out) {
  long n;
  if (!cag_arg_integer_or(call, argument, 8, 0, 8, &n)) return false;
  *out = (int)n;
  return n == 4 || n == 8 || cag_fail_value(call, argument, "4 or 8");
}

bool cag_odd_size(CagCall *call, int argument, long size) {
  return size % 2 == 1 || cag_fail_value(call, argument, "an odd number of pixels");
}

bool cag_hold_image(CagCall *call, CagStatus status, CagRaster **made) {
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_raster(call, *made);
  return true;
}

CagValue cag_xy(CagVm *vm, double x, double y) { return cag_point(vm, cag_vec3(x, y, 0), 2); }
