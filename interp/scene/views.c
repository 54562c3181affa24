// Framing of cameras: their distance, and the standard views by name.
//
// Each item needs room on both sides of the picture. Its bounds are computed along the camera's
// axes, because the axis-aligned box of a slender oblique shape is many times larger than the
// shape.

#include <string.h>

#include "base/array.h"
#include "base/guard.h"
#include "base/memory.h"
#include "base/stop.h"
#include "interp/scene/scene.h"

// The fraction of half the picture that stays free on each side.
#define MARGIN 0.09

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static CagVec3 corner(const CagBounds *b, int k) {
  return cag_vec3(k & 1 ? b->max.x : b->min.x, k & 2 ? b->max.y : b->min.y,
                  k & 4 ? b->max.z : b->min.z);
}

// --- Bounds of items ---

static void join(CagBounds *into, const CagBounds *b) {
  if (b->min.x > b->max.x) return;
  cag_bounds_add(into, b->min);
  cag_bounds_add(into, b->max);
}

static CagStatus region_bounds(const CagItem *item, const CagTransform *t, CagBounds *out,
                               CagError *err) {
  if (cag_region_is_empty(item->as.region)) return cag_region_bounds(item->as.region, out, err);
  const CagTransform place = cag_transform_multiply(t, &item->placement);
  for (size_t i = 0; i < item->as.region->count; i++) {
    CagCurve *placed = NULL;
    CagBounds loop;
    CagStatus status = cag_curve_transform(item->as.region->loops[i], &place, &placed, err);
    if (!status) status = cag_curve_bounds(placed, &loop, err);
    cag_curve_release(placed);
    if (status) return status;
    join(out, &loop);
  }
  return CAG_OK;
}

static CagStatus curve_bounds(const CagCurve *c, const CagTransform *t, CagBounds *out,
                              CagError *err) {
  CagCurve *placed = NULL;
  CagStatus status = cag_curve_transform(c, t, &placed, err);
  if (!status) status = cag_curve_bounds(placed, out, err);
  cag_curve_release(placed);
  return status;
}

static CagStatus surface_bounds(const CagSurface *s, const CagTransform *t, CagBounds *out,
                                CagError *err) {
  CagSurface *placed = NULL;
  CagStatus status = cag_surface_transform(s, t, &placed, err);
  if (!status) status = cag_surface_bounds(placed, out, err);
  cag_surface_release(placed);
  return status;
}

static CagStatus solid_bounds(const CagSolid *s, const CagTransform *t, CagBounds *out,
                              CagError *err) {
  CagSolid *placed = NULL;
  CagStatus status = cag_solid_transform(s, t, &placed, err);
  if (!status) status = cag_solid_bounds(placed, out, err);
  cag_solid_release(placed);
  return status;
}

static CagStatus mesh_bounds(const CagMesh *m, const CagTransform *t, CagBounds *out,
                             CagError *err) {
  CagMesh *placed = NULL;
  CagStatus status = cag_mesh_transform(m, t, &placed, err);
  if (!status) *out = cag_mesh_bounds(placed);
  cag_mesh_release(placed);
  return status;
}

CagStatus cag_item_bounds(const CagItem *item, const CagTransform *t, CagBounds *out,
                          CagError *err) {
  const CagTransform unit = cag_transform_identity();
  *out = CAG_BOUNDS_EMPTY;
  switch (item->kind) {
  case CAG_ITEM_REGION: return region_bounds(item, t ? t : &unit, out, err);
  case CAG_ITEM_GROUND: return CAG_OK;
  case CAG_ITEM_CURVE:
    return t ? curve_bounds(item->as.curve, t, out, err)
             : cag_curve_bounds(item->as.curve, out, err);
  case CAG_ITEM_SURFACE:
    return t ? surface_bounds(item->as.surface, t, out, err)
             : cag_surface_bounds(item->as.surface, out, err);
  case CAG_ITEM_SOLID:
    return t ? solid_bounds(item->as.solid, t, out, err)
             : cag_solid_bounds(item->as.solid, out, err);
  case CAG_ITEM_MESH:
    if (item->as.mesh->triangle_count == 0)
      return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_empty_shape, "", -1,
                      "the mesh has no triangles");
    if (t) return mesh_bounds(item->as.mesh, t, out, err);
    *out = cag_mesh_bounds(item->as.mesh);
    return CAG_OK;
  }
  return CAG_OK;
}

CagBounds cag_scene_framed(const CagScene *s) {
  if (s->bounds.min.x <= s->bounds.max.x) return s->bounds;
  return (CagBounds){{-50, -50, 0}, {50, 50, 50}};
}

double cag_scene_radius(const CagBounds *b) {
  double radius = cag_norm(cag_sub(b->max, b->min)) / 2;
  return radius > 0 ? radius : 1;
}

// --- Framing ---

// The extent of the items in the picture's direction a (0: right, 1: down), as limits of the
// position e of the eye: a point at (x, z) requires x - k z <= e + k d and e - k d <= x + k z, with
// k the tangent of half the angle of view and d the distance.
typedef struct Reach {
  double high, low;
} Reach;

typedef struct Framing {
  CagTransform frame; // of the camera
  CagVec3 center;
  double k[2]; // 0: without perspective
} Framing;

// The transform that maps a point to x - k z and x + k z, with a third row that makes it regular.
static CagTransform reach_transform(const Framing *f, int a) {
  const CagVec3 x = column(&f->frame, a), other = column(&f->frame, 1 - a);
  const CagVec3 z = column(&f->frame, 2);
  const bool flat = f->k[a] == 0;
  const CagVec3 rows[3] = {cag_madd(x, -f->k[a], z), flat ? other : cag_madd(x, f->k[a], z),
                           flat ? z : other};
  CagTransform t = cag_transform_identity();
  for (int i = 0; i < 3; i++) {
    t.m[i][0] = rows[i].x, t.m[i][1] = rows[i].y, t.m[i][2] = rows[i].z;
    t.m[i][3] = -cag_dot(rows[i], f->center);
  }
  return t;
}

// The reach of an axis-aligned box.
static Reach reach_of_box(const Framing *f, int a, const CagBounds *box) {
  Reach out = {-INFINITY, INFINITY};
  for (int c = 0; c < 8; c++) {
    const CagVec3 p = cag_sub(corner(box, c), f->center);
    const double x = cag_dot(p, column(&f->frame, a)), z = cag_dot(p, column(&f->frame, 2));
    out.high = fmax(out.high, x - f->k[a] * z);
    out.low = fmin(out.low, x + f->k[a] * z);
  }
  return out;
}

// Both boxes contain the item, so the tighter limit is used on each side. A box that cannot be
// computed is ignored. If memory runs out, the work is abandoned, so that a picture never depends
// on the available memory.
static void add_item(const Framing *f, const CagItem *item, Reach r[2]) {
  CagBounds box;
  CagError err = {0};
  CagStatus status = cag_item_bounds(item, NULL, &box, &err);
  if (status == CAG_E_MEMORY) cag_memory_leave();
  if (status || box.min.x > box.max.x) return;
  for (int a = 0; a < 2; a++) {
    Reach one = reach_of_box(f, a, &box);
    const CagTransform t = reach_transform(f, a);
    CagBounds seen;
    status = cag_item_bounds(item, &t, &seen, &err);
    if (status == CAG_E_MEMORY) cag_memory_leave();
    if (!status && seen.min.x <= seen.max.x) {
      one.high = fmin(one.high, seen.max.x);
      one.low = fmax(one.low, f->k[a] == 0 ? seen.min.x : seen.min.y);
    }
    r[a].high = fmax(r[a].high, one.high);
    r[a].low = fmin(r[a].low, one.low);
  }
}

// Moves the camera, keeping its direction, so that all items just fit.
void cag_camera_frame_all(const CagScene *s, CagCamera *c) {
  const CagBounds whole = cag_scene_framed(s);
  const double radius = cag_scene_radius(&whole);
  const double k = c->orthographic ? 0 : tan(c->fov / 2) * (1 - MARGIN);
  const double aspect = (double)c->size[0] / c->size[1];
  Framing f = {.frame = cag_camera_frame(c),
               .center = cag_lerp(whole.min, whole.max, 0.5),
               .k = {k, k / aspect}};
  Reach r[2] = {{-INFINITY, INFINITY}, {-INFINITY, INFINITY}};
  for (size_t i = 0; i < s->item_count && !cag_stopped(); i++) add_item(&f, &s->items[i], r);
  for (int a = 0; a < 2; a++)
    if (!(r[a].high > -INFINITY)) r[a] = reach_of_box(&f, a, &whole);
  double middle[2], distance = 2 * radius;
  for (int a = 0; a < 2; a++) {
    middle[a] = (r[a].high + r[a].low) / 2;
    if (c->orthographic) continue;
    const double needed = (r[a].high - r[a].low) / (2 * f.k[a]);
    distance = a == 0 ? needed : fmax(distance, needed);
  }
  if (c->orthographic) {
    const double wide = r[0].high - r[0].low, tall = (r[1].high - r[1].low) * aspect;
    c->width = fmax(fmax(wide, tall), 1e-9 * radius) / (1 - MARGIN);
  }
  // A single point has no extent and is visible from any distance.
  if (!(distance > 0)) distance = 2 * radius;
  c->target =
      cag_madd(cag_madd(f.center, middle[0], column(&f.frame, 0)), middle[1], column(&f.frame, 1));
  c->eye = cag_madd(c->target, -distance, column(&f.frame, 2));
}

// --- Standard views ---

// Directions from the target to the camera, which has no perspective.
static const struct {
  const char *name;
  CagVec3 back, up;
} VIEWS[] = {{"top", {0, 0, 1}, {0, 1, 0}},    {"bottom", {0, 0, -1}, {0, -1, 0}},
             {"front", {0, -1, 0}, {0, 0, 1}}, {"back", {0, 1, 0}, {0, 0, 1}},
             {"left", {-1, 0, 0}, {0, 0, 1}},  {"right", {1, 0, 0}, {0, 0, 1}},
             {"iso", {1, -1, 1}, {0, 0, 1}}};
#define VIEW_COUNT (sizeof VIEWS / sizeof *VIEWS)

const char *cag_standard_view(size_t i) { return i < VIEW_COUNT ? VIEWS[i].name : NULL; }

// Hides the studio's floor, which would hide the shapes from below.
static void hide_floor(CagScene *s) {
  const CagItem *last = s->item_count ? &s->items[s->item_count - 1] : NULL;
  if (!s->studio || !last || last->kind != CAG_ITEM_GROUND || !last->name ||
      strcmp(last->name, "studio_floor") != 0)
    return;
  s->item_count--;
  s->floor_hidden = true;
}

void cag_scene_remove_view(CagScene *s) {
  cag_free(s->cameras[--s->camera_count].name);
  if (s->floor_hidden) s->item_count++;
  s->floor_hidden = false;
}

CagStatus cag_scene_add_camera(CagScene *s, const CagCamera *camera, CagError *err) {
  char *copy = cag_strdup(camera->name);
  if (!copy || !CAG_RESIZE(s->cameras, s->camera_count + 1)) {
    cag_free(copy);
    return cag_fail_memory(err);
  }
  CagCamera *c = &s->cameras[s->camera_count++];
  *c = *camera;
  c->name = copy;
  return CAG_OK;
}

CagStatus cag_scene_add_view(CagScene *s, const char *name, CagError *err) {
  size_t i = 0;
  while (i < VIEW_COUNT && strcmp(VIEWS[i].name, name) != 0) i++;
  if (i == VIEW_COUNT)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_camera_unknown, "camera", -1,
                    "unknown standard view `%s`", name);
  const CagBounds whole = cag_scene_framed(s);
  const CagVec3 center = cag_lerp(whole.min, whole.max, 0.5), back = cag_unit(VIEWS[i].back);
  const double distance = 4 * cag_scene_radius(&whole); // nothing is behind the camera
  CagCamera c = {.name = (char *)(size_t)name,
                 .eye = cag_madd(center, distance, back),
                 .target = center,
                 .up = cag_unit(cag_madd(VIEWS[i].up, -cag_dot(VIEWS[i].up, back), back)),
                 .orthographic = true,
                 .framed = true,
                 .size = {1280, 720}};
  if (s->camera_count > 0) memcpy(c.size, s->cameras[0].size, sizeof c.size);
  const CagStatus status = cag_scene_add_camera(s, &c, err);
  if (status) return status;
  if (back.z < 0) hide_floor(s);
  cag_camera_frame_all(s, &s->cameras[s->camera_count - 1]);
  return CAG_OK;
}
