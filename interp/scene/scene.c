// The scene as plain data: freeing it, the default material, and the frame of a camera.

#include "interp/scene/scene.h"

#include "base/memory.h"

const char *const cag_label_marks[] = {
#define X(name, text) text,
    CAG_LABEL_MARKS(X)
#undef X
        NULL};
const char *const cag_label_places[] = {
#define X(name, text, x, y) text,
    CAG_LABEL_PLACES(X)
#undef X
        NULL};

void cag_item_free(CagItem *item) {
  switch (item->kind) {
  case CAG_ITEM_CURVE: cag_curve_release(item->as.curve); break;
  case CAG_ITEM_REGION: cag_region_release(item->as.region); break;
  case CAG_ITEM_SURFACE: cag_surface_release(item->as.surface); break;
  case CAG_ITEM_SOLID: cag_solid_release(item->as.solid); break;
  case CAG_ITEM_MESH: cag_mesh_release(item->as.mesh); break;
  case CAG_ITEM_GROUND: break;
  }
  cag_free(item->name);
  cag_free(item->labels);
}

void cag_scene_free(CagScene *s) {
  const size_t items = s->item_count + (s->floor_hidden ? 1 : 0);
  for (size_t i = 0; i < items; i++) cag_item_free(&s->items[i]);
  for (size_t i = 0; i < s->empty_count; i++) cag_item_free(&s->empties[i]);
  for (size_t i = 0; i < s->label_count; i++) cag_free(s->labels[i].text);
  for (size_t i = 0; i < s->material_count; i++) {
    cag_free(s->materials[i].name);
    cag_free(s->materials[i].texture);
    cag_free(s->materials[i].pov);
  }
  for (size_t i = 0; i < s->camera_count; i++) cag_free(s->cameras[i].name);
  cag_free(s->items);
  cag_free(s->empties);
  cag_free(s->labels);
  cag_free(s->materials);
  cag_free(s->cameras);
  cag_free(s->lights);
  cag_free(s->sky.colors);
  cag_free(s->sky.image);
  cag_free(s->script);
  *s = (CagScene){0};
}

// Light gray and slightly glossy, to show form under any light. The texts are not allocated; code
// that stores the material in a scene must copy them.
CagMaterial cag_material_default(void) {
  static char name[] = "default", texture[] = "";
  return (CagMaterial){.name = name,
                       .color = {0.62, 0.62, 0.6},
                       .roughness = 0.5,
                       .ior = 1.5,
                       .texture = texture,
                       .color2 = {0.2, 0.2, 0.2},
                       .texture_scale = 10};
}

bool cag_camera_has_lens(const CagCamera *c) { return c->aperture > 0 && !c->orthographic; }

CagTransform cag_camera_frame(const CagCamera *c) {
  CagTransform frame;
  CagError err;
  if (!cag_look_at(c->eye, c->target, c->up, &frame, &err)) {
    for (int i = 0; i < 3 && c->mirrored; i++) frame.m[i][0] = 0.0 - frame.m[i][0];
    return frame;
  }
  // Eye and target coincide. Constructors reject that, but an extreme transform can cause it.
  cag_look_at(cag_vec3(0, 0, 0), cag_vec3(0, 1, 0), cag_vec3(0, 0, 1), &frame, &err);
  frame.m[0][3] = c->eye.x;
  frame.m[1][3] = c->eye.y;
  frame.m[2][3] = c->eye.z;
  return frame;
}
