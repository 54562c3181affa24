// The new items are made in a list of their own, which replaces that of the scene at the end. A
// failure therefore leaves the scene as it was.

#include "interp/scene/section.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/array.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/meet/section.h"
#include "geom/meet/section_region.h"
#include "geom/solid/clip.h"
#include "geom/solid/csg.h"
#include "interp/scene/item_mesh.h"

// A flat shape lies in the plane if its distance is below this fraction of its size.
#define IN_PLANE 1e-9
// scene_build.c adds these two before all others.
#define DEFAULT_MATERIAL 0
#define INK_MATERIAL 1

typedef struct Section {
  const CagScene *scene;
  CagPlane plane;
  CagTransform frame, to_frame;
  CagSolid *half; // the side that is kept
  CagItem *items;
  size_t count, capacity;
  CagHashIndex names; // of items of both lists, by number in `known`
  char **known;
  size_t known_count, known_capacity;
  CagSectionReach reach;
} Section;

// --- Names ---

static bool is_known(const Section *x, const char *name) {
  size_t i;
  CagHashWalk w = cag_hash_walk(&x->names, cag_hash_text(CAG_HASH_START, name));
  while (cag_hash_next(&w, &i))
    if (!strcmp(x->known[i], name)) return true;
  return false;
}

static CagStatus note_name(Section *x, const char *name, CagError *err) {
  char *copy = cag_strdup(name);
  if (!copy || !CAG_RESERVE(x->known, x->known_capacity, x->known_count + 1) ||
      !cag_hash_add(&x->names, cag_hash_text(CAG_HASH_START, name), x->known_count)) {
    cag_free(copy);
    return cag_fail_memory(err);
  }
  x->known[x->known_count++] = copy;
  return CAG_OK;
}

// The name of piece `number`, counted from 0, of an item. The first one has the item's own.
static CagStatus piece_name(Section *x, const char *whole, size_t *number, char **out,
                            CagError *err) {
  const size_t size = strlen(whole) + 24;
  char *name = cag_malloc(size);
  if (!name) return cag_fail_memory(err);
  snprintf(name, size, "%s", whole);
  for (++*number; *number > 1; ++*number) {
    snprintf(name, size, "%s.%zu", whole, *number);
    if (!is_known(x, name)) break;
  }
  const CagStatus status = *number > 1 ? note_name(x, name, err) : CAG_OK;
  if (status) cag_free(name);
  else *out = name;
  return status;
}

// --- Items ---

// Adds a piece of `whole`, which has its attributes. Takes over the geometry of `piece`.
static CagStatus add_piece(Section *x, const CagItem *whole, CagItem piece, size_t *number,
                           CagError *err) {
  CagItem item = *whole;
  item.kind = piece.kind;
  item.as = piece.as;
  item.placement = piece.placement;
  item.measured = false;
  item.name = NULL;
  item.labels = NULL;
  CagStatus status = piece_name(x, whole->name, number, &item.name, err);
  const size_t bytes = whole->label_count * sizeof *item.labels;
  if (!status && bytes > 0) {
    item.labels = cag_malloc(bytes);
    if (item.labels) memcpy(item.labels, whole->labels, bytes);
    else status = cag_fail_memory(err);
  }
  if (!status && !CAG_RESERVE(x->items, x->capacity, x->count + 1)) status = cag_fail_memory(err);
  if (status) cag_item_free(&item);
  else x->items[x->count++] = item;
  return status;
}

static CagStatus keep_item(Section *x, const CagItem *whole, CagError *err) {
  CagItem same = *whole;
  size_t number = 0;
  switch (whole->kind) {
  case CAG_ITEM_CURVE: cag_curve_retain(same.as.curve); break;
  case CAG_ITEM_REGION: cag_region_retain(same.as.region); break;
  case CAG_ITEM_SURFACE: cag_surface_retain(same.as.surface); break;
  case CAG_ITEM_SOLID: cag_solid_retain(same.as.solid); break;
  case CAG_ITEM_MESH: cag_mesh_retain(same.as.mesh); break;
  case CAG_ITEM_GROUND: break;
  }
  return add_piece(x, whole, same, &number, err);
}

static CagItem mesh_item(CagMesh *m) {
  return (CagItem){.kind = CAG_ITEM_MESH, .as.mesh = m, .placement = cag_transform_identity()};
}
static CagItem solid_item(CagSolid *s) {
  return (CagItem){.kind = CAG_ITEM_SOLID, .as.solid = s, .placement = cag_transform_identity()};
}
static CagItem curve_item(CagCurve *c) {
  return (CagItem){.kind = CAG_ITEM_CURVE, .as.curve = c, .placement = cag_transform_identity()};
}

// --- Where an item lies ---

typedef enum Side { BELOW, ACROSS, ABOVE } Side;

static CagVec3 corner(const CagBounds *b, int k) {
  return cag_vec3(k & 1 ? b->max.x : b->min.x, k & 2 ? b->max.y : b->min.y,
                  k & 4 ? b->max.z : b->min.z);
}

// The heights of an item over the plane. Those of a compound solid are cheap, and may be infinite
// or too wide.
static CagStatus find_heights(const Section *x, const CagItem *item, double *low, double *high,
                              CagError *err) {
  CagBounds box;
  *low = INFINITY;
  *high = -INFINITY;
  if (item->kind != CAG_ITEM_SOLID || !cag_solid_is_compound(item->as.solid)) {
    const CagStatus status = cag_item_bounds(item, &x->to_frame, &box, err);
    if (!status) *low = box.min.z, *high = box.max.z;
    return status;
  }
  const CagStatus status = cag_solid_reach(item->as.solid, &box, err);
  if (status) return status;
  const bool known = isfinite(box.min.x) && isfinite(box.max.x) && isfinite(box.min.y) &&
                     isfinite(box.max.y) && isfinite(box.min.z) && isfinite(box.max.z);
  if (!known) *low = -INFINITY, *high = INFINITY;
  for (int k = 0; known && box.min.x <= box.max.x && k < 8; k++) {
    const double z = cag_transform_point(&x->to_frame, corner(&box, k)).z;
    *low = fmin(*low, z);
    *high = fmax(*high, z);
  }
  return CAG_OK;
}

// An empty shape lies below, so that it is kept for its warning.
static CagStatus find_side(Section *x, const CagItem *item, Side *side, CagError *err) {
  double low, high;
  CagStatus status = find_heights(x, item, &low, &high, err);
  *side = BELOW;
  if (status) return cag_is_empty_shape(err) ? CAG_OK : status;
  if (!(low <= high)) return CAG_OK;
  const double origin = cag_dot(x->plane.point, x->plane.normal);
  if (isfinite(low) && isfinite(high)) {
    x->reach.low = fmin(x->reach.low, low + origin);
    x->reach.high = fmax(x->reach.high, high + origin);
  }
  // A flat shape in the plane stays.
  *side = high <= 0 ? BELOW : low >= 0 ? ABOVE : ACROSS;
  return CAG_OK;
}

// --- Solids ---

static CagStatus set_label(const CagSolid *s, uint32_t label, CagSolid **out, CagError *err);

static CagStatus meet_half(const CagSolid *s, const CagSolid *half, const volatile int *interrupt,
                           CagSolid **out, CagError *err) {
  CagSolid *operands[2] = {(CagSolid *)(size_t)s, NULL};
  CagStatus status = set_label(half, cag_solid_first_label(s), &operands[1], err);
  if (!status) status = cag_solid_combine(CAG_INTERSECTION, operands, 2, interrupt, out, err);
  cag_solid_release(operands[1]);
  return status;
}

static uint32_t replace_label(void *context, uint32_t label) {
  (void)label;
  return *(const uint32_t *)context;
}

static CagStatus set_label(const CagSolid *s, uint32_t label, CagSolid **out, CagError *err) {
  return cag_solid_relabel(s, replace_label, &label, out, err);
}

// Whether the operands of a union have materials of their own, so that the cut has several.
static bool is_mixed(const CagSolid *s) {
  for (size_t i = 1; i < s->core->count; i++)
    if (cag_solid_first_label(s->core->operands[i]) != cag_solid_first_label(s->core->operands[0]))
      return true;
  return false;
}

// (a | b) & h = (a & h) | (b & h): each operand of a union then has a cut in its own material.
static CagStatus cut_solid(const CagSolid *s, const CagSolid *half, const volatile int *interrupt,
                           CagSolid **out, CagError *err) {
  CagTransform back;
  CagError singular;
  if (s->kind != CAG_SOLID_UNION || s->core->count < 2 || !is_mixed(s) ||
      cag_transform_inverse(&s->placement, &back, &singular))
    return meet_half(s, half, interrupt, out, err);
  const size_t n = s->core->count;
  CagSolid **parts = cag_calloc(n, sizeof *parts), *local = NULL, *whole = NULL;
  if (!parts) return cag_fail_memory(err);
  CagStatus status = cag_solid_transform(half, &back, &local, err);
  for (size_t i = 0; !status && i < n; i++)
    status = cut_solid(s->core->operands[i], local, interrupt, &parts[i], err);
  if (!status) status = cag_solid_combine(CAG_UNION, parts, n, interrupt, &whole, err);
  if (!status) status = cag_solid_transform(whole, &s->placement, out, err);
  for (size_t i = 0; i < n; i++) cag_solid_release(parts[i]);
  cag_solid_release(local);
  cag_solid_release(whole);
  cag_free(parts);
  return status;
}

static CagStatus add_cut_solid(Section *x, const CagItem *whole, const CagSolid *s, CagError *err) {
  CagSolid *cut = NULL;
  CagBounds reach;
  size_t number = 0;
  CagStatus status = cut_solid(s, x->half, x->scene->interrupt, &cut, err);
  if (status) return status;
  // What the bounds show to be outside would only be reported as empty.
  if (!cag_solid_reach(cut, &reach, err) && !(reach.min.x <= reach.max.x)) {
    cag_solid_release(cut);
    return CAG_OK;
  }
  return add_piece(x, whole, solid_item(cut), &number, err);
}

// --- Other shapes ---

static CagStatus add_cut_mesh(Section *x, const CagItem *whole, CagMesh *m, CagError *err) {
  size_t number = 0;
  if (m->triangle_count > 0) return add_piece(x, whole, mesh_item(m), &number, err);
  cag_mesh_release(m);
  return CAG_OK;
}

// What is cut may be shown in a picture, whose pixels are finer than the default tolerance.
static CagTessellation cut_fineness(const Section *x, const CagItem *item) {
  const double of_usual = 0.25;
  CagScene fine = *x->scene; // shares everything
  fine.usual_tolerance *= of_usual;
  return cag_item_fineness(&fine, item);
}

static CagStatus cut_surface(Section *x, const CagItem *item, const CagSurface *s, CagError *err) {
  const CagTessellation how = cut_fineness(x, item);
  CagMesh *m = NULL;
  const CagStatus status = cag_surface_clip(s, x->half, &how, &m, err);
  return status ? status : add_cut_mesh(x, item, m, err);
}

static CagStatus cut_region(Section *x, const CagItem *item, CagError *err) {
  CagSurface *flat = NULL;
  CagStatus status = cag_surface_planar(item->as.region, &item->placement, &flat, err);
  if (!status) status = cut_surface(x, item, flat, err);
  cag_surface_release(flat);
  return status;
}

static CagStatus cut_mesh(Section *x, const CagItem *item, CagError *err) {
  const CagMesh *mesh = item->as.mesh;
  CagSolid *body = NULL;
  CagMesh *m = NULL;
  CagStatus status;
  if (mesh->scale.kind == CAG_SCALE_NONE && cag_mesh_is_watertight(mesh, NULL)) {
    status = cag_solid_from_mesh(mesh, &body, err);
    if (!status) status = add_cut_solid(x, item, body, err);
    cag_solid_release(body);
    return status;
  }
  const CagTessellation how = cut_fineness(x, item);
  status = cag_mesh_clip(mesh, x->half, &how, &m, err);
  return status ? status : add_cut_mesh(x, item, m, err);
}

static CagStatus cut_curve(Section *x, const CagItem *item, CagError *err) {
  CagCurveList pieces = {0};
  size_t number = 0;
  CagStatus status = cag_curve_clip(item->as.curve, x->half, x->scene->interrupt, &pieces.items,
                                    &pieces.count, err);
  for (size_t i = 0; !status && i < pieces.count; i++)
    status = add_piece(x, item, curve_item(cag_curve_retain(pieces.items[i])), &number, err);
  cag_curve_list_free(&pieces);
  return status;
}

static CagStatus cut_item(Section *x, const CagItem *item, CagError *err) {
  Side side;
  if (item->kind == CAG_ITEM_GROUND) return keep_item(x, item, err);
  const CagStatus status = find_side(x, item, &side, err);
  if (status || side == ABOVE) return status;
  if (side == BELOW) return keep_item(x, item, err);
  switch (item->kind) {
  case CAG_ITEM_CURVE: return cut_curve(x, item, err);
  case CAG_ITEM_REGION: return cut_region(x, item, err);
  case CAG_ITEM_SURFACE: return cut_surface(x, item, item->as.surface, err);
  case CAG_ITEM_SOLID: return add_cut_solid(x, item, item->as.solid, err);
  case CAG_ITEM_MESH: return cut_mesh(x, item, err);
  case CAG_ITEM_GROUND: break;
  }
  return CAG_OK;
}

// --- Outlines of the cut ---

static CagItem as_drawn(const CagItem *item) {
  CagItem line = *item;
  if (line.material == DEFAULT_MATERIAL) line.material = INK_MATERIAL;
  line.label_count = 0;
  return line;
}

static CagStatus add_outline(Section *x, const CagItem *item, const CagCurve *c, size_t *number,
                             CagError *err) {
  const CagItem line = as_drawn(item);
  CagCurve *flat = NULL;
  const CagStatus status = cag_curve_flatten(c, &x->frame, &flat, err);
  return status ? status : add_piece(x, &line, curve_item(flat), number, err);
}

static CagStatus draw_solid(Section *x, const CagItem *item, CagError *err) {
  const CagItem line = as_drawn(item);
  const CagTessellation how = cut_fineness(x, item);
  CagRegion *cut = NULL;
  size_t number = 0;
  CagStatus status = cag_solid_section_region(item->as.solid, &x->frame, 0, &how, &cut, err);
  for (size_t i = 0; !status && i < cut->count; i++)
    status = add_piece(x, &line, curve_item(cag_curve_retain(cut->loops[i])), &number, err);
  cag_region_release(cut);
  return status;
}

static CagStatus draw_surface(Section *x, const CagItem *item, const CagSurface *s, CagError *err) {
  CagCurveList curves = {0};
  size_t number = 0;
  CagStatus status = cag_surface_section(s, &x->plane, 0, &curves, err);
  for (size_t i = 0; !status && i < curves.count; i++)
    status = add_outline(x, item, curves.items[i], &number, err);
  cag_curve_list_free(&curves);
  return status;
}

static CagStatus draw_mesh(Section *x, const CagItem *item, CagError *err) {
  CagCurveList curves = {0};
  size_t number = 0;
  CagStatus status = cag_mesh_section(item->as.mesh, &x->plane, &curves, err);
  for (size_t i = 0; !status && i < curves.count; i++)
    status = add_outline(x, item, curves.items[i], &number, err);
  cag_curve_list_free(&curves);
  return status;
}

static CagStatus draw_region(Section *x, const CagItem *item, bool in_plane, CagError *err) {
  CagSurface *flat = NULL;
  CagItem drawn = *item;
  size_t number = 0;
  if (in_plane) {
    drawn.placement = cag_transform_multiply(&x->to_frame, &item->placement);
    cag_region_retain(drawn.as.region);
    return add_piece(x, item, drawn, &number, err);
  }
  CagStatus status = cag_surface_planar(item->as.region, &item->placement, &flat, err);
  if (!status) status = draw_surface(x, item, flat, err);
  cag_surface_release(flat);
  return status;
}

static CagStatus draw_item(Section *x, const CagItem *item, CagError *err) {
  CagBounds box;
  Side side;
  size_t number = 0;
  if (item->kind == CAG_ITEM_GROUND) return CAG_OK;
  CagStatus status = find_side(x, item, &side, err);
  if (status) return status;
  if (item->kind != CAG_ITEM_CURVE && item->kind != CAG_ITEM_REGION) {
    switch (item->kind) {
    case CAG_ITEM_SURFACE: status = draw_surface(x, item, item->as.surface, err); break;
    case CAG_ITEM_SOLID: status = draw_solid(x, item, err); break;
    case CAG_ITEM_MESH: status = draw_mesh(x, item, err); break;
    default: break;
    }
    return status && cag_is_empty_shape(err) ? CAG_OK : status;
  }
  status = cag_item_bounds(item, &x->to_frame, &box, err);
  if (status) return cag_is_empty_shape(err) ? CAG_OK : status;
  const double size = cag_norm(cag_sub(box.max, box.min)) + cag_norm(x->plane.point);
  const bool in_plane = fmax(fabs(box.min.z), fabs(box.max.z)) <= IN_PLANE * size;
  if (item->kind == CAG_ITEM_REGION) return draw_region(x, item, in_plane, err);
  return in_plane ? add_outline(x, item, item->as.curve, &number, err) : CAG_OK;
}

static void draw_labels(const Section *x, CagScene *s) {
  size_t kept = 0;
  for (size_t i = 0; i < s->label_count; i++) {
    CagLabel label = s->labels[i];
    const CagVec3 at = cag_transform_point(&x->to_frame, label.at);
    if (fabs(at.z) > IN_PLANE * (cag_norm(at) + cag_norm(x->plane.point))) {
      cag_free(label.text);
      continue;
    }
    label.at = cag_vec3(at.x, at.y, 0);
    label.along = cag_transform_vector(&x->to_frame, label.along);
    label.along.z = 0;
    s->labels[kept++] = label;
  }
  s->label_count = kept;
}

static void drop_labels_above(const Section *x, CagScene *s) {
  size_t kept = 0;
  for (size_t i = 0; i < s->label_count; i++)
    if (cag_transform_point(&x->to_frame, s->labels[i].at).z > 0) cag_free(s->labels[i].text);
    else s->labels[kept++] = s->labels[i];
  s->label_count = kept;
}

// The drawing is seen from above, on paper.
static void drop_setting(CagScene *s) {
  for (size_t i = 0; i < s->camera_count; i++) cag_free(s->cameras[i].name);
  cag_free(s->cameras);
  cag_free(s->lights);
  cag_free(s->sky.colors);
  cag_free(s->sky.image);
  s->cameras = NULL;
  s->lights = NULL;
  s->camera_count = s->light_count = 0;
  s->sky = (CagSky){0};
}

// --- The whole scene ---

CagTransform cag_section_frame(const CagPlane *plane) {
  const double steep = 0.9; // beyond, Z is too close to the normal to show what is up
  const CagVec3 n = plane->normal;
  const CagVec3 above = fabs(n.z) <= steep ? cag_vec3(0, 0, 1) : cag_vec3(0, n.z > 0 ? 1 : -1, 0);
  const CagVec3 x = cag_unit(cag_cross(above, n)), y = cag_cross(n, x);
  const CagVec3 o = cag_scaled(n, cag_dot(plane->point, n));
  return (CagTransform){
      .m = {{x.x, y.x, n.x, o.x}, {x.y, y.y, n.y, o.y}, {x.z, y.z, n.z, o.z}, {0, 0, 0, 1}}};
}

static CagStatus begin(Section *x, const CagScene *s, const CagPlane *plane, CagError *err) {
  *x = (Section){.scene = s, .frame = cag_section_frame(plane), .reach = {INFINITY, -INFINITY}};
  x->plane =
      (CagPlane){cag_vec3(x->frame.m[0][3], x->frame.m[1][3], x->frame.m[2][3]), plane->normal};
  CagStatus status = cag_transform_inverse(&x->frame, &x->to_frame, err);
  if (!status) status = cag_solid_half_space(&x->plane, &x->half, err);
  for (size_t i = 0; !status && i < s->item_count; i++)
    status = note_name(x, s->items[i].name, err);
  return status;
}

// Moves the new items to the scene if there was no error.
static CagStatus finish(Section *x, CagScene *s, CagStatus status, CagSectionReach *reach) {
  CagItem *old = status ? x->items : s->items;
  const size_t n = status ? x->count : s->item_count;
  if (!status) {
    s->items = x->items;
    s->item_count = x->count;
  }
  for (size_t i = 0; i < n; i++) cag_item_free(&old[i]);
  cag_free(old);
  cag_solid_release(x->half);
  cag_hash_free(&x->names);
  for (size_t i = 0; i < x->known_count; i++) cag_free(x->known[i]);
  cag_free(x->known);
  *reach = x->reach;
  return status;
}

static CagStatus each_item(Section *x, CagStatus (*make)(Section *, const CagItem *, CagError *),
                           CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < x->scene->item_count; i++) {
    status = cag_stop_check(err);
    if (!status) status = make(x, &x->scene->items[i], err);
  }
  return status;
}

CagStatus cag_scene_cut(CagScene *s, const CagPlane *plane, CagSectionReach *reach, CagError *err) {
  Section x;
  CagStatus status = begin(&x, s, plane, err);
  if (!status) status = each_item(&x, cut_item, err);
  if (!status) drop_labels_above(&x, s);
  return finish(&x, s, status, reach);
}

CagStatus cag_scene_section(CagScene *s, const CagPlane *plane, CagSectionReach *reach,
                            CagError *err) {
  Section x;
  CagStatus status = begin(&x, s, plane, err);
  if (!status) status = each_item(&x, draw_item, err);
  if (!status) {
    draw_labels(&x, s);
    drop_setting(s);
  }
  return finish(&x, s, status, reach);
}
