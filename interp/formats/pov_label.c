// Labels: flat meshes that face the camera, close to it, so that nothing is in front of them.

#include <math.h>

#include "interp/formats/pov_write.h"
#include "interp/scene/label_shape.h"

// Labels are this much closer to the camera than the scene, and in front of a camera that is within
// the scene at this part of the distance to its target.
#define IN_FRONT 0.5
#define WITHIN 0.02
// Later shapes are closer by this part, so that they cover the others.
#define STEP 1e-5
// The tolerance of edges, in pixels.
#define TOLERANCE 0.05

typedef struct Screen {
  CagPovWriter *writer;
  CagCamera camera; // with the size of the picture
  double depth;     // of the plane of the next shape
  CagLabelFonts fonts;
} Screen;

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static double first_depth(const CagPovWriter *w, const CagCamera *c) {
  const CagTransform frame = cag_camera_frame(c);
  const double nearest = cag_dot(cag_sub(w->center, c->eye), column(&frame, 2)) - w->radius,
               reach = cag_norm(cag_sub(c->target, c->eye));
  // Only what is in the plane of focus is sharp.
  if (cag_camera_has_lens(c)) return c->focus > 0 ? c->focus : reach;
  return nearest > WITHIN * reach ? IN_FRONT * nearest : WITHIN * reach;
}

// The map from pixels, with y up and the origin in the lower left corner, to the plane of a depth.
static CagTransform pixels_to_plane(const CagCamera *c, double depth, double *pixel) {
  const CagTransform frame = cag_camera_frame(c);
  const CagCameraWindow window = cag_camera_window(c);
  const CagCameraParts parts = cag_camera_parts(c);
  *pixel = (c->orthographic ? 1 : depth) / parts.k[0][0];
  CagVec3 middle = cag_madd(c->eye, depth, column(&frame, 2));
  middle = cag_madd(middle, *pixel * c->size[0], window.shift);
  const CagVec3 x = cag_scaled(window.right, *pixel), y = cag_scaled(window.down, -*pixel);
  const CagVec3 origin = cag_madd(cag_madd(middle, -0.5 * c->size[0], x), -0.5 * c->size[1], y);
  CagTransform out = cag_transform_identity();
  const CagVec3 columns[] = {x, y, column(&frame, 2), origin};
  for (int j = 0; j < 4; j++) {
    out.m[0][j] = columns[j].x;
    out.m[1][j] = columns[j].y;
    out.m[2][j] = columns[j].z;
  }
  out.planar = false;
  return out;
}

static CagStatus write_region(void *screen, const CagRegion *r, CagColor color, CagError *err) {
  Screen *s = screen;
  CagPovWriter *w = s->writer;
  double pixel;
  CagMesh *mesh;
  CagItem item = {.kind = CAG_ITEM_REGION, .as.region = cag_region_retain(r)};
  item.placement = pixels_to_plane(&s->camera, s->depth, &pixel);
  item.tolerance = TOLERANCE * pixel;
  s->depth *= 1 - STEP;
  CagStatus status = cag_item_mesh(w->scene, &item, &mesh, err);
  cag_region_release(item.as.region);
  if (status) return status;
  w->item = NULL;
  cag_pov_text(w, "object {\n  ");
  status = cag_pov_mesh(w, mesh, err);
  cag_mesh_release(mesh);
  if (status) return status;
  cag_pov_text(w, "\n  pigment { color ");
  cag_pov_color(w, color);
  cag_pov_text(w, " }\n  finish { ambient 0 diffuse 0 emission 1 }\n"
                  "  no_shadow no_reflection no_radiosity\n");
  cag_pov_text(w, w->unit != 1 ? "  scale unit\n}\n\n" : "}\n\n");
  return CAG_OK;
}

static CagStatus write_label(Screen *s, const CagCameraMap *map, const CagLabel *l, CagError *err) {
  const CagColor color = s->writer->scene->materials[l->material].color;
  CagLabelShape shape;
  CagStatus status = cag_label_in_picture(&s->fonts, l, &s->camera, map, &shape, err);
  if (status) return status;
  cag_pov_comment(s->writer, "", l->text);
  status = cag_label_shape_draw(&shape, color, write_region, s, err);
  cag_label_shape_free(&shape);
  return status;
}

CagStatus cag_pov_labels(CagPovWriter *w, CagError *err) {
  Screen s = {.writer = w, .camera = *w->camera};
  CagCameraMap map;
  const int *size = w->options->size;
  if (size[0] > 0 && size[1] > 0) {
    s.camera.size[0] = size[0];
    s.camera.size[1] = size[1];
  }
  s.depth = first_depth(w, &s.camera);
  CagStatus status = cag_scene_camera_map(&s.camera, &map, err);
  for (size_t i = 0; !status && i < w->scene->label_count; i++)
    status = write_label(&s, &map, &w->scene->labels[i], err);
  cag_label_fonts_free(&s.fonts);
  return status;
}
