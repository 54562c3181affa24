// The images that a script shows.
//
// Their names are those set by `named`, or else those of their definitions, or "image". They are
// unique within the script: "depth", "depth.2".

#ifndef CAG_INTERP_SESSION_IMAGES_H
#define CAG_INTERP_SESSION_IMAGES_H

#include "geom/image/raster.h"
#include "interp/session/session.h"

typedef struct CagShownImage {
  char *name;
  CagRaster *raster; // holds one reference
} CagShownImage;

typedef struct CagShownImages {
  CagShownImage *items;
  size_t count, capacity;
} CagShownImages;

// Lists the shown images in order; release it with cag_shown_images_free. Must be called from work
// of the session (cag_session_geometry), and released there.
CagStatus cag_shown_images(CagSession *s, CagShownImages *out, CagError *err);
void cag_shown_images_free(CagShownImages *images);
// The image of a name; NULL: the only one. Otherwise adds a diagnostic and returns its status.
int cag_shown_image_find(CagSession *s, const CagShownImages *images, const char *name,
                         const CagShownImage **out);
// Writes the image that is shown, or the first one, as a PNG picture of at most width x height
// pixels to look at, unless the file exists: enlarged or reduced, black for the least number and white for the greatest,
// unless all are in 0..1. *out_width and *out_height are the size of the picture.
int cag_session_write_preview(CagSession *s, const char *path, size_t width, size_t height,
                              size_t *out_width, size_t *out_height);

#endif
