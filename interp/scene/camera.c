// The picture of a camera: where it is in front of the eye, and which pixel shows a point.

#include "interp/scene/scene.h"

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

// The width of the picture: of a perspective camera, at the distance 1 of the eye.
static double picture_width(const CagCamera *c) {
  if (c->orthographic) return c->width;
  return c->focal > 0 ? c->width / c->focal : 2 * tan(c->fov / 2);
}

// A pixel to the right is the vector x / f, and one down is (y - skew x) / (f (1 + stretch)), where f
// is the number of pixels in a unit of length (see cag_camera_parts).
CagCameraWindow cag_camera_window(const CagCamera *c) {
  const CagTransform frame = cag_camera_frame(c);
  const CagVec3 right = column(&frame, 0);
  const CagVec3 down =
      cag_scaled(cag_madd(column(&frame, 1), -c->skew, right), 1 / (1 + c->stretch));
  return (CagCameraWindow){right, down,
                           cag_madd(cag_scaled(right, c->shift[0]), c->shift[1], down)};
}

CagCameraParts cag_camera_parts(const CagCamera *c) {
  const CagTransform frame = cag_camera_frame(c);
  const double pixels = c->size[0] / picture_width(c);
  CagCameraParts out = {
      .k = {{pixels, pixels * c->skew, c->size[0] * (0.5 - c->shift[0])},
            {0, pixels * (1 + c->stretch), c->size[1] * 0.5 - c->size[0] * c->shift[1]},
            {0, 0, 1}}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) out.r[i][j] = frame.m[j][i];
  return out;
}

CagStatus cag_scene_camera_map(const CagCamera *c, CagCameraMap *out, CagError *err) {
  const CagCameraParts parts = cag_camera_parts(c);
  return cag_camera_map_of_parts(&parts, c->eye, c->orthographic, c->focal, out, err);
}
