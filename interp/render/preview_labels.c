#include "interp/render/preview_labels.h"

#include <math.h>

#include "geom/image/coverage.h"
#include "interp/scene/label_shape.h"

enum { COLORS = 3 };

// A part of a camera's picture. Rows count from the bottom here.
typedef struct Part {
  CagImage *image;
  double left, bottom;
} Part;

// The pixels of the part that the box touches; false: none.
static bool grid_of(const Part *p, const CagBounds *box, CagGrid *out, size_t *column,
                    size_t *row) {
  const double width = (double)p->image->width, height = (double)p->image->height;
  const double left = fmax(floor(box->min.x - p->left), 0),
               right = fmin(ceil(box->max.x - p->left), width),
               bottom = fmax(floor(box->min.y - p->bottom), 0),
               top = fmin(ceil(box->max.y - p->bottom), height);
  if (!(left < right && bottom < top)) return false;
  *out = (CagGrid){p->left + left, p->bottom + bottom, 1, (size_t)(right - left),
                   (size_t)(top - bottom)};
  *column = (size_t)left;
  *row = (size_t)(height - top);
  return true;
}

static void blend(const Part *p, const CagRaster *coverage, size_t column, size_t row,
                  CagColor color) {
  const double rgb[COLORS] = {color.r, color.g, color.b};
  for (size_t c = 0; c < COLORS; c++)
    for (size_t y = 0; y < coverage->height; y++) {
      float *to = cag_image_plane(p->image, c) + (row + y) * p->image->width + column;
      for (size_t x = 0; x < coverage->width; x++) {
        const double part = *cag_raster_at(coverage, 0, x, y);
        to[x] = (float)((1 - part) * to[x] + part * rgb[c]);
      }
    }
}

static CagStatus draw(void *part, const CagRegion *r, CagColor color, CagError *err) {
  const Part *p = part;
  CagBounds box;
  CagGrid grid;
  CagRaster *coverage;
  size_t column, row;
  CagStatus status = cag_region_bounds(r, &box, err);
  if (status || !grid_of(p, &box, &grid, &column, &row)) return status;
  status = cag_raster_of_region(r, &grid, CAG_PIXEL_COVERAGE, &coverage, err);
  if (status) return status;
  blend(p, coverage, column, row, color);
  cag_raster_release(coverage);
  return CAG_OK;
}

CagStatus cag_preview_labels(const CagScene *scene, const CagCamera *camera,
                             const CagCameraMap *map, int x, int y, CagImage *part, CagError *err) {
  Part p = {part, x, (double)camera->size[1] - y - (double)part->height};
  CagLabelFonts fonts = {0};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < scene->label_count; i++) {
    const CagLabel *l = &scene->labels[i];
    CagLabelShape shape;
    status = cag_label_in_picture(&fonts, l, camera, map, &shape, err);
    if (status) break;
    status = cag_label_shape_draw(&shape, scene->materials[l->material].color, draw, &p, err);
    cag_label_shape_free(&shape);
  }
  cag_label_fonts_free(&fonts);
  return status;
}
