// Images of plane regions.

#include <math.h>
#include <string.h>

#include "geom/image/coverage.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/images.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"

// Reads a side of the size, a whole number of pixels.
static bool read_side(CagCall *call, double side, size_t *out) {
  if (!(side >= 1 && side <= (double)CAG_RASTER_SIDE_MAX && side == floor(side)))
    return cag_fail_value(call, 1, "[width, height] in pixels, integers from 1 to 131072");
  *out = (size_t)side;
  return true;
}

static bool is_identity(const CagTransform *t) {
  const CagTransform identity = cag_transform_identity();
  return memcmp(t->m, identity.m, sizeof t->m) == 0;
}

// Reads the region as it lies in the plane, which the call holds.
static bool read_flat_region(CagCall *call, CagRegion **out) {
  CagRegion *region, *placed = NULL;
  CagTransform placement;
  if (!cag_arg_region(call, 0, &region, &placement)) return false;
  cag_hold_region(call, region);
  *out = region;
  if (is_identity(&placement)) return true;
  if (!placement.planar) return cag_fail_value(call, 0, "a region in the XY plane");
  if (!cag_geometry_ok(call, cag_region_transform(region, &placement, &placed, call->err)))
    return false;
  cag_hold_region(call, placed);
  *out = placed;
  return true;
}

bool cag_images_rasterize(CagCall *call, const struct cag_images_rasterize *a, CagValue *result) {
  CagRegion *region;
  CagRaster *made = NULL;
  CagGrid grid = {.x = a->origin.at.x, .y = a->origin.at.y, .pixel = a->pixel};
  if (a->size.count != 2) return cag_fail_value(call, 1, "[width, height] in pixels");
  if (!read_side(call, a->size.items[0], &grid.width) ||
      !read_side(call, a->size.items[1], &grid.height) || !read_flat_region(call, &region))
    return false;
  if (!isfinite(grid.pixel)) return cag_fail_value(call, 2, "a finite number");
  const CagPixelRule rule = a->rule == 0 ? CAG_PIXEL_COVERAGE : CAG_PIXEL_CENTER;
  return cag_raster_result(call, cag_raster_of_region(region, &grid, rule, &made, call->err), &made,
                           result);
}
