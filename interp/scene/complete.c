// Default camera and lights, for scenes that show none.
//
// Camera: from the front, right, and above (a three-quarter view), as close as the corners of all
// items' bounds allow with a margin. Shapes that lie flat in a plane z = constant are shown from
// above, without perspective, on white paper.
//
// Lights (if the scene has no light and no sky): a studio scaled to the scene. It has a large warm
// key light from the camera's upper left, a dim cool fill light from its right, a rim light from
// behind, and a sky of soft grays that lights all sides. A gray floor at the lowest point blends
// into the sky, unless the scene has its own ground or the camera is below it.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "interp/scene/fineness.h"

#define AUTOMATIC_FOV 0.52 // radians, about 30 degrees: a moderate perspective
// The direction from the target to the automatic camera.
static const CagVec3 THREE_QUARTERS = {0.62, -1, 0.55};
// A scene is flat if its thickness is below this fraction of its width.
#define FLAT 1e-6

// --- Bounds ---

static void join(CagBounds *into, const CagBounds *b) {
  if (b->min.x > b->max.x) return;
  cag_bounds_add(into, b->min);
  cag_bounds_add(into, b->max);
}

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

// --- Camera ---

static bool is_flat(const CagBounds *b) {
  CagVec3 size = cag_sub(b->max, b->min);
  return size.z <= FLAT * fmax(size.x, size.y);
}

static CagStatus add_camera(CagScene *s, CagError *err) {
  CagBounds whole = cag_scene_framed(s);
  CagVec3 center = cag_lerp(whole.min, whole.max, 0.5);
  bool flat = is_flat(&whole);
  CagCamera *c = cag_malloc(sizeof *c);
  char *name = cag_strdup("automatic");
  if (!c || !name) {
    cag_free(c);
    cag_free(name);
    return cag_fail_memory(err);
  }
  CagVec3 back = flat ? cag_vec3(0, 0, 1) : cag_unit(THREE_QUARTERS);
  *c = (CagCamera){.name = name,
                   .eye = cag_add(center, back),
                   .target = center,
                   .orthographic = flat,
                   .fov = AUTOMATIC_FOV,
                   .framed = true,
                   .size = {1280, 720}};
  CagVec3 up = flat ? cag_vec3(0, 1, 0) : cag_vec3(0, 0, 1);
  c->up = cag_unit(cag_madd(up, -cag_dot(up, back), back));
  s->cameras = c;
  s->camera_count = 1;
  s->automatic_camera = true;
  cag_camera_frame_all(s, c);
  return CAG_OK;
}

// --- Studio ---

// The position of a light, in radii of the scene, to the camera's right, up, and backward.
typedef struct StudioLight {
  double right, up, back;
  double size; // side, in radii
  CagColor color;
  double strength;
} StudioLight;

static const StudioLight STUDIO[] = {
    {-2.2, 2.8, 2.2, 1.8, {1, 0.97, 0.92}, 0.62}, // key
    {3.2, 1.2, 2.0, 3.0, {0.9, 0.95, 1}, 0.16},   // fill
    {1.6, 2.6, -3.4, 1.2, {1, 1, 1}, 0.28},       // rim
};
#define STUDIO_COUNT (sizeof STUDIO / sizeof *STUDIO)
// From bottom to top; the middle color is the horizon, which the floor blends into.
static const CagColor STUDIO_SKY[] = {
    {0.30, 0.30, 0.31}, {0.44, 0.44, 0.45}, {0.50, 0.51, 0.53}, {0.58, 0.60, 0.63}};
#define SKY_COUNT (sizeof STUDIO_SKY / sizeof *STUDIO_SKY)
static const CagColor FLOOR = {0.52, 0.52, 0.52};
// The floor is slightly below the lowest point, so that it does not coincide with a flat shape
// there. The gap is as narrow as the renderer's tolerance allows, because a wide one shows a dark
// edge under shapes. (Shadows are not cast across 1e-3 mm or less.)
#define FLOOR_GAP_LEAST 2e-5 // radii
#define FLOOR_GAP_MOST 5e-4  // radii
#define FLOOR_GAP_OF_SHADOWS 1.5e-3
static const CagColor PAPER = {1, 1, 1};

static CagStatus set_sky(CagScene *s, const CagColor *colors, size_t n, CagError *err) {
  s->sky.colors = cag_malloc(n * sizeof *colors);
  if (!s->sky.colors) return cag_fail_memory(err);
  memcpy(s->sky.colors, colors, n * sizeof *colors);
  s->sky.color_count = n;
  return CAG_OK;
}

static double floor_gap(double radius) {
  return fmax(FLOOR_GAP_LEAST * radius, fmin(FLOOR_GAP_MOST * radius, FLOOR_GAP_OF_SHADOWS));
}

static CagStatus add_floor(CagScene *s, double z, CagError *err) {
  char *texts[] = {cag_strdup("studio_floor"), cag_strdup("studio_floor"), cag_strdup("")};
  if (!CAG_RESIZE(s->items, s->item_count + 1) ||
      !CAG_RESIZE(s->materials, s->material_count + 1) || !texts[0] || !texts[1] || !texts[2]) {
    for (int i = 0; i < 3; i++) cag_free(texts[i]);
    return cag_fail_memory(err);
  }
  CagMaterial m = cag_material_default();
  m.name = texts[1];
  m.texture = texts[2];
  m.color = FLOOR;
  m.roughness = 1;
  m.ior = 1.2;
  s->materials[s->material_count] = m;
  s->items[s->item_count++] = (CagItem){.kind = CAG_ITEM_GROUND,
                                        .name = texts[0],
                                        .placement = cag_transform_identity(),
                                        .material = s->material_count++,
                                        .ground_z = z,
                                        .ground_size = INFINITY};
  return CAG_OK;
}

static bool has_ground(const CagScene *s) {
  for (size_t i = 0; i < s->item_count; i++)
    if (s->items[i].kind == CAG_ITEM_GROUND) return true;
  return false;
}

// Light for a drawing: even, from above, on paper.
static CagStatus add_paper_light(CagScene *s, CagError *err) {
  s->lights = cag_malloc(sizeof *s->lights);
  if (!s->lights) return cag_fail_memory(err);
  s->lights[0] = (CagLight){.kind = CAG_LIGHT_SUN,
                            .direction = cag_unit(cag_vec3(0.25, -0.35, -1)),
                            .color = {1, 1, 1},
                            .strength = 0.8};
  s->light_count = 1;
  if (!s->has_background) s->background = PAPER;
  s->has_background = true;
  return CAG_OK;
}

static CagStatus add_studio(CagScene *s, CagError *err) {
  CagBounds whole = cag_scene_framed(s);
  CagVec3 center = cag_lerp(whole.min, whole.max, 0.5), up = cag_vec3(0, 0, 1);
  double radius = cag_scene_radius(&whole);
  CagTransform frame = cag_camera_frame(&s->cameras[0]);
  s->studio = true;
  if (is_flat(&whole) && s->cameras[0].orthographic) return add_paper_light(s, err);
  // The camera's right and backward directions along the ground; as the camera sees them if it
  // looks straight down.
  CagVec3 right = column(&frame, 0), back = cag_cross(right, up);
  if (s->cameras[0].mirrored) back = cag_scaled(back, -1);
  if (cag_norm(back) == 0) back = cag_vec3(0, -1, 0);
  s->lights = cag_malloc(STUDIO_COUNT * sizeof *s->lights);
  if (!s->lights) return cag_fail_memory(err);
  for (size_t i = 0; i < STUDIO_COUNT; i++) {
    const StudioLight *l = &STUDIO[i];
    CagVec3 offset = cag_madd(cag_madd(cag_scaled(right, l->right * radius), l->up * radius, up),
                              l->back * radius, back);
    s->lights[i] = (CagLight){.kind = CAG_LIGHT_AREA,
                              .position = cag_add(center, offset),
                              .direction = cag_unit(cag_scaled(offset, -1)),
                              .size = l->size * radius,
                              .color = l->color,
                              .strength = l->strength};
  }
  s->light_count = STUDIO_COUNT;
  CagStatus status = s->has_background ? CAG_OK : set_sky(s, STUDIO_SKY, SKY_COUNT, err);
  bool floor = !s->has_background && !has_ground(s) && s->cameras[0].eye.z > whole.min.z;
  if (!status && floor) status = add_floor(s, whole.min.z - floor_gap(radius), err);
  return status;
}

// Computes the bounds of all items, and removes empty items.
static CagStatus find_bounds(CagScene *s, CagError *err) {
  s->bounds = CAG_BOUNDS_EMPTY;
  s->empties = cag_malloc((s->item_count + 1) * sizeof *s->empties);
  if (!s->empties) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  size_t kept = 0;
  for (size_t i = 0; i < s->item_count; i++) {
    CagBounds one = CAG_BOUNDS_EMPTY;
    if (!status) status = cag_stop_check(err);
    if (!status) status = cag_item_bounds(&s->items[i], NULL, &one, err);
    const bool empty = status && cag_is_empty_shape(err);
    if (empty) {
      s->empties[s->empty_count++] = s->items[i];
      status = CAG_OK;
      continue;
    }
    s->items[i].bounds = one;
    s->items[i].measured = !status;
    if (!status) join(&s->bounds, &one);
    s->items[kept++] = s->items[i];
  }
  s->item_count = kept;
  if (!(s->usual_tolerance > 0)) s->usual_tolerance = cag_usual_tolerance(&s->bounds);
  return status;
}

static bool is_finite(CagVec3 p) { return isfinite(p.x) && isfinite(p.y) && isfinite(p.z); }

// Fails for scenes so large that the positions of cameras and lights overflow.
static CagStatus check_finite(const CagScene *s, CagError *err) {
  const CagBounds *b = &s->bounds;
  bool good = !(b->min.x <= b->max.x) || is_finite(cag_sub(b->max, b->min));
  for (size_t i = 0; i < s->camera_count; i++) {
    const CagCamera *c = &s->cameras[i];
    good = good && is_finite(c->eye) && is_finite(c->target) && is_finite(c->up);
  }
  for (size_t i = 0; i < s->light_count; i++)
    good = good && is_finite(s->lights[i].position) && is_finite(s->lights[i].direction);
  if (good) return CAG_OK;
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
                  "the scene is too large for the range of numbers: from [%g, %g, %g] to "
                  "[%g, %g, %g]",
                  b->min.x, b->min.y, b->min.z, b->max.x, b->max.y, b->max.z);
}

CagStatus cag_scene_complete(CagScene *s, CagError *err) {
  CagStatus status = find_bounds(s, err);
  if (!status && s->item_count + s->label_count == 0) return CAG_OK;
  if (!status && s->camera_count == 0) status = add_camera(s, err);
  bool lit = s->light_count > 0 || s->sky.color_count > 0 || s->sky.image;
  if (!status && !lit) status = add_studio(s, err);
  return !status ? check_finite(s, err) : status;
}
