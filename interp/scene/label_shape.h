// What is drawn for a label: its text and its mark as regions, with the compiled-in font.

#ifndef CAG_INTERP_SCENE_LABEL_SHAPE_H
#define CAG_INTERP_SCENE_LABEL_SHAPE_H

#include "geom/camera/camera.h"
#include "geom/letter/font.h"
#include "interp/scene/scene.h"

// The height of a text without a size, as a fraction of the picture's diagonal: 3.5 mm on a figure
// 130 mm wide.
#define CAG_LABEL_PART 0.024

// The fonts of labels, which are opened when they are first needed. A zeroed structure has none.
typedef struct CagLabelFonts {
  CagFont upright, slanted;
} CagLabelFonts;
void cag_label_fonts_free(CagLabelFonts *fonts);

// Regions in the plane of the picture, with y up.
typedef struct CagLabelShape {
  CagRegion *text, *mark; // in the label's color; NULL: none
  CagRegion *paper;       // white, below the mark; NULL: none
  CagBounds box;          // around the label's location, its mark, and the room of its text
} CagLabelShape;

// The shape of a label whose location is `at`, in a picture in which its text is `size` high (the em
// of the font). `along`: the label's direction in the picture, of any length, or zero. A name is in
// italics, with the parts after a _ as subscripts. Characters that the font does not have are boxes.
CagStatus cag_label_shape(CagLabelFonts *fonts, const CagLabel *l, CagVec3 at, CagVec3 along,
                          double size, CagLabelShape *out, CagError *err);
void cag_label_shape_free(CagLabelShape *s);

// Calls `draw` for the regions of a shape from below to above, with their colors.
typedef CagStatus (*CagLabelDraw)(void *context, const CagRegion *r, CagColor color, CagError *err);
CagStatus cag_label_shape_draw(const CagLabelShape *s, CagColor color, CagLabelDraw draw,
                               void *context, CagError *err);

// The same in the picture of a camera, in pixels with the origin in the lower left corner. The shape
// is empty if the location is not in front of the camera.
CagStatus cag_label_in_picture(CagLabelFonts *fonts, const CagLabel *l, const CagCamera *camera,
                               const CagCameraMap *map, CagLabelShape *out, CagError *err);

#endif
