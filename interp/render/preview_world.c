#include "interp/render/preview_world.h"

#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/ray/bvh_walk.h"
#include "geom/ray/ray_primitive.h"
#include "geom/solid/csg.h"
#include "interp/scene/color_scale.h"
#include "interp/scene/curve_rods.h"

// Set operations with more operands than this are met as meshes.
enum { OPERANDS_MAX = 64 };
// A finite ground is a slab of this thickness, as a fraction of its size.
#define SLAB 1e-3
// The fraction of the sky's mean color that replaces its light in a sketch, as in POV-Ray's source.
#define SKY_FRACTION 0.5
#define DIM_WHITE 0.12
// Highlights: see interp/formats/pov_material.c.
#define MIRROR_ROUGHNESS 0.5
#define MIRROR_LEAST 0.01
#define SPECULAR_ROUGHNESS_MIN 0.0008
#define COAT_IOR 1.5
#define COAT_EXPONENT 600.0

// --- Surfaces ---

static double clamp01(double x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

static double normal_reflectance(double ior) {
  const double f = (ior - 1) / (ior + 1);
  return f * f;
}

// The factors by which POV-Ray normalizes highlights ("albedo").
static double highlight_norm(double n) { return (n + 2) / (4 * (2 - pow(2, -n / 2))); }
static double coat_norm(double n) { return (n + 1) / 2; }

static CagPreviewSurface surface_of(const CagMaterial *m) {
  const double metallic = clamp01(m->metallic), rough = clamp01(m->roughness);
  const double coat = clamp01(m->coat), mirror = metallic * 0.95 * pow(1 - rough, 1.5);
  const double blurred = metallic - mirror, g = clamp01(1 - rough / MIRROR_ROUGHNESS);
  CagPreviewSurface s = {.color = m->color,
                         .emission = m->emission,
                         .metal = metallic > 0.5,
                         .ior = m->ior,
                         .material = m,
                         .pattern = cag_preview_find_pattern(m)};
  s.passed = clamp01(m->transmission) * (1 - metallic);
  s.diffuse = (1 - metallic) + 0.4 * blurred;
  s.exponent = 1 / fmax(SPECULAR_ROUGHNESS_MIN, rough * rough * rough * rough / 2);
  s.highlight = (s.metal ? 0.35 * blurred + 0.1 : 1.5 * normal_reflectance(m->ior)) *
                highlight_norm(s.exponent);
  s.coat = coat * normal_reflectance(COAT_IOR) * coat_norm(COAT_EXPONENT);
  s.mirror = s.metal ? mirror : fmax(g * g, coat);
  if (s.mirror < MIRROR_LEAST) s.mirror = 0;
  return s;
}

// --- Parts ---

void cag_preview_world_free(CagPreviewWorld *w) {
  for (size_t i = 0; i < w->count; i++) {
    cag_caster_free(w->parts[i].caster);
    cag_ray_rods_free(w->parts[i].rods);
    cag_ray_mesh_free(w->parts[i].mesh);
  }
  cag_free(w->parts);
  cag_bvh_free(&w->boxes);
  cag_free(w->surfaces);
  cag_free(w->lamps);
  cag_free(w->planes);
  cag_free(w->plane_items);
  cag_preview_sky_free(&w->sky);
  *w = (CagPreviewWorld){0};
}

// Whether rays meet the solid quickly without a mesh of it.
static bool has_equations(const CagSolid *s, int *operands) {
  CagQuadric form;
  if (++*operands > OPERANDS_MAX) return false;
  if (s->kind == CAG_SOLID_BOX || s->kind == CAG_SOLID_SPHERE || s->kind == CAG_SOLID_CYLINDER ||
      s->kind == CAG_SOLID_TORUS)
    return cag_transform_is_affine(&s->placement);
  if (cag_solid_form(s, &form)) return true;
  if (!s->core || s->kind == CAG_SOLID_MESH || s->core->count == 0) return false;
  for (size_t i = 0; i < s->core->count; i++)
    if (!has_equations(s->core->operands[i], operands)) return false;
  return true;
}

static CagStatus add_mesh(const CagScene *s, const CagItem *item, CagPreviewPart *part,
                          CagError *err) {
  CagMesh *m = NULL;
  CagStatus status = cag_item_mesh(s, item, &m, err);
  if (!status) status = cag_ray_mesh_new(m, &part->mesh, err);
  if (!status) part->bounds = cag_mesh_bounds(m);
  cag_mesh_release(m);
  return status;
}

static CagStatus add_planar(const CagItem *item, CagPreviewPart *part, CagError *err) {
  CagSurface *flat = NULL;
  CagStatus status = cag_surface_planar(item->as.region, &item->placement, &flat, err);
  if (!status) status = cag_caster_of_surface(flat, &part->caster, err);
  cag_surface_release(flat);
  return status;
}

static CagStatus add_ring(const CagCurveRods *c, CagPreviewPart *part, CagError *err) {
  CagSolid *torus = NULL, *moved = NULL;
  CagStatus status = cag_solid_torus(c->circle_radius, c->radius, &torus, err);
  if (!status) status = cag_solid_transform(torus, &c->frame, &moved, err);
  if (!status) status = cag_caster_of_solid(moved, &part->caster, err);
  cag_solid_release(torus);
  cag_solid_release(moved);
  return status;
}

// A curve is drawn as the POV-Ray source does (interp/formats/pov_curve.c). A torus without a hole
// is a mesh.
static CagStatus add_curve(const CagScene *s, const CagItem *item, CagPreviewPart *part,
                           CagError *err) {
  CagCurveRods c;
  CagStatus status = cag_curve_rods(s, item, &c, err);
  if (status) return status;
  if (c.circle && c.radius < c.circle_radius) status = add_ring(&c, part, err);
  else if (c.circle) status = add_mesh(s, item, part, err);
  else {
    status = cag_ray_rods_new(c.rods, c.count, c.radius, &part->rods, err);
    if (!status) part->bounds = part->rods->bvh.bounds;
  }
  cag_curve_rods_free(&c);
  return status;
}

static CagStatus add_slab(const CagItem *item, CagPreviewPart *part, CagError *err) {
  const double size = item->ground_size, half = size / 2;
  const CagTransform shift = cag_translate(cag_vec3(-half, -half, item->ground_z - SLAB * size));
  CagSolid *box = NULL, *moved = NULL;
  CagStatus status = cag_solid_box(cag_vec3(size, size, SLAB * size), false, &box, err);
  if (!status) status = cag_solid_transform(box, &shift, &moved, err);
  if (!status) status = cag_caster_of_solid(moved, &part->caster, err);
  cag_solid_release(box);
  cag_solid_release(moved);
  return status;
}

static bool is_flat(const CagSurface *s) {
  CagVec3 o, x, y;
  return cag_surface_planar_view(s, NULL, NULL) || cag_surface_parallelogram_view(s, &o, &x, &y);
}

// POV-Ray's source applies the rigid motion of a primitive after its material.
static CagStatus place_pattern(const CagSolid *s, CagPreviewPart *part, CagError *err) {
  const double rounding = 1e-12;
  double scale;
  if (!cag_ray_primitive_can(s) || !cag_transform_is_affine(&s->placement) ||
      !cag_transform_is_similarity(&s->placement, &scale) || fabs(scale - 1) > rounding)
    return CAG_OK;
  part->moved = true;
  return cag_transform_inverse(&s->placement, &part->to_pattern, err);
}

static CagStatus make_part(const CagPreviewWorld *w, size_t i, CagPreviewPart *part,
                           CagError *err) {
  const CagScene *s = w->scene;
  const CagItem *item = &s->items[i];
  int operands = 0;
  CagStatus status;
  *part = (CagPreviewPart){.item = i, .closed = true};
  if (item->kind == CAG_ITEM_GROUND) status = add_slab(item, part, err);
  else if (item->kind == CAG_ITEM_REGION) status = add_planar(item, part, err);
  else if (item->kind == CAG_ITEM_CURVE) status = add_curve(s, item, part, err);
  else if (item->kind == CAG_ITEM_SURFACE && is_flat(item->as.surface))
    status = cag_caster_of_surface(item->as.surface, &part->caster, err);
  else if (item->kind == CAG_ITEM_SOLID && has_equations(item->as.solid, &operands))
    status = cag_caster_of_solid(item->as.solid, &part->caster, err);
  else status = add_mesh(s, item, part, err);
  if (status) return status;
  if (part->caster) part->bounds = cag_caster_bounds(part->caster);
  if (item->kind == CAG_ITEM_SOLID) status = place_pattern(item->as.solid, part, err);
  if (item->kind == CAG_ITEM_REGION) part->closed = false;
  if (item->kind == CAG_ITEM_SURFACE) part->closed = cag_surface_is_closed(item->as.surface);
  if (item->kind == CAG_ITEM_MESH)
    return cag_mesh_watertight(item->as.mesh, &part->closed, NULL, err);
  return status;
}

static CagStatus make_parts(CagPreviewWorld *w, CagError *err) {
  const CagScene *s = w->scene;
  CagStatus status = CAG_OK;
  w->parts = cag_calloc(s->item_count + 1, sizeof *w->parts);
  w->planes = cag_calloc(s->item_count + 1, sizeof *w->planes);
  w->plane_items = cag_calloc(s->item_count + 1, sizeof *w->plane_items);
  if (!w->parts || !w->planes || !w->plane_items) return cag_fail_memory(err);
  for (size_t i = 0; !status && i < s->item_count; i++) {
    status = cag_stop_check(err);
    if (status) break;
    if (s->items[i].kind == CAG_ITEM_GROUND && isinf(s->items[i].ground_size)) {
      w->plane_items[w->plane_count] = i;
      w->planes[w->plane_count++] = s->items[i].ground_z;
      continue;
    }
    CagPreviewPart *part = &w->parts[w->count];
    status = make_part(w, i, part, err);
    w->count++; // a part that failed is freed with the others
  }
  if (status) return status;
  CagBounds *boxes = cag_malloc((w->count + 1) * sizeof *boxes);
  if (!boxes) return cag_fail_memory(err);
  for (size_t i = 0; i < w->count; i++) boxes[i] = w->parts[i].bounds;
  status = cag_bvh_build(boxes, w->count, 1, &w->boxes, err);
  cag_free(boxes);
  return status;
}

static CagColor ambient_of(const CagScene *s) {
  const size_t n = s->sky.color_count;
  if (n == 0 && s->sky.image) return (CagColor){SKY_FRACTION, SKY_FRACTION, SKY_FRACTION};
  if (n == 0) return (CagColor){DIM_WHITE, DIM_WHITE, DIM_WHITE};
  CagColor sum = {0, 0, 0};
  for (size_t i = 0; i < n; i++) {
    sum.r += s->sky.colors[i].r;
    sum.g += s->sky.colors[i].g;
    sum.b += s->sky.colors[i].b;
  }
  const double k = SKY_FRACTION / (double)n;
  return (CagColor){k * sum.r, k * sum.g, k * sum.b};
}

// A sun's distance in radii of the scene, and its angular diameter in radians (formats/pov_stage.c).
#define SUN_DISTANCE 1000.0
#define SUN_WIDTH 0.0175
// The part of a spot's cone with full light.
#define SPOT_CORE 0.8

static CagPreviewLamp lamp_of(const CagLight *l, double radius) {
  const double far = SUN_DISTANCE * radius;
  CagPreviewLamp lamp = {.light = l, .direction = cag_unit(l->direction)};
  lamp.color =
      (CagColor){l->color.r * l->strength, l->color.g * l->strength, l->color.b * l->strength};
  const double size = l->kind == CAG_LIGHT_SUN    ? far * SUN_WIDTH
                      : l->kind == CAG_LIGHT_AREA ? l->size
                                                  : 0;
  const CagVec3 other = fabs(lamp.direction.z) < 0.9 ? cag_vec3(0, 0, 1) : cag_vec3(1, 0, 0);
  const CagVec3 a = cag_unit(cag_cross(lamp.direction, other));
  lamp.wide = size > 0;
  lamp.across = cag_scaled(a, size);
  lamp.over = cag_scaled(cag_cross(lamp.direction, a), size);
  lamp.to_sun = cag_scaled(lamp.direction, -far);
  lamp.inner = cos(SPOT_CORE * l->angle / 2);
  lamp.outer = cos(l->angle / 2);
  return lamp;
}

static CagStatus make_lamps(CagPreviewWorld *w, CagError *err) {
  const CagScene *s = w->scene;
  w->lamps = cag_calloc(s->light_count + 1, sizeof *w->lamps);
  if (!w->lamps) return cag_fail_memory(err);
  for (size_t i = 0; i < s->light_count; i++) {
    const CagPreviewLamp lamp = lamp_of(&s->lights[i], w->radius);
    if (lamp.color.r + lamp.color.g + lamp.color.b > 0) w->lamps[w->lamp_count++] = lamp;
  }
  return CAG_OK;
}

CagStatus cag_preview_world(const CagScene *scene, CagPreviewWorld *out, CagError *err) {
  *out = (CagPreviewWorld){.scene = scene, .ambient = ambient_of(scene)};
  const CagBounds box = cag_scene_framed(scene);
  out->radius = cag_scene_radius(&box);
  out->center = cag_lerp(box.min, box.max, 0.5);
  out->surfaces = cag_calloc(scene->material_count + 1, sizeof *out->surfaces);
  CagStatus status = out->surfaces ? make_lamps(out, err) : cag_fail_memory(err);
  if (!status) status = cag_preview_sky_load(scene, &out->sky, err);
  if (!status) status = make_parts(out, err);
  for (size_t i = 0; !status && i < scene->material_count; i++) {
    out->surfaces[i] = surface_of(&scene->materials[i]);
    out->transparent = out->transparent || out->surfaces[i].passed > 0;
  }
  if (status) cag_preview_world_free(out);
  return status;
}

// --- Hits ---

// The normal of shading, from those of the corners. It stays on the side of the flat one.
static CagVec3 smooth_normal(const CagMesh *m, const CagCrossing *c) {
  if (!m->normals) return c->normal;
  const uint32_t *t = m->triangles + 3 * (size_t)c->face;
  const double b = c->weight[0], d = c->weight[1], a = 1 - b - d;
  const CagVec3 n = cag_unit(cag_madd(
      cag_madd(cag_scaled(m->normals[t[0]], a), b, m->normals[t[1]]), d, m->normals[t[2]]));
  return cag_dot(n, c->normal) > 0 ? n : c->normal;
}

static void fill_hit(const CagPreviewWorld *w, const CagPreviewPart *part, const CagRay *ray,
                     const CagCrossing *c, CagPreviewHit *out) {
  const CagItem *item = &w->scene->items[part->item];
  const CagMesh *m = part->mesh ? part->mesh->mesh : NULL;
  *out = (CagPreviewHit){.t = c->t,
                         .point = cag_ray_point(ray, c->t),
                         .normal = m ? smooth_normal(m, c) : c->normal,
                         .flat = c->normal,
                         .u = c->u,
                         .v = c->v,
                         .item = part->item,
                         .material = cag_item_label_material(item, c->label),
                         .leaves = c->sign > 0,
                         .closed = part->closed,
                         .mesh = m,
                         .face = c->face,
                         .to_pattern = part->moved ? &part->to_pattern : NULL,
                         .part = part,
                         .operand = c->part,
                         .flipped = c->flipped};
  if (!m || m->scale.kind == CAG_SCALE_NONE) return;
  out->scale = &m->scale;
  out->scale_value = c->u;
}

static CagStatus meet_part(const CagPreviewPart *part, const CagRay *ray, CagCrossings *work,
                           CagCrossing *out, bool *met, CagError *err) {
  if (part->caster) return cag_caster_first(part->caster, ray, work, out, met, err);
  *met = part->rods ? cag_ray_rods_first(part->rods, ray, out)
                    : cag_ray_mesh_first(part->mesh, ray, out);
  return CAG_OK;
}

static bool meet_ground(const CagPreviewWorld *w, const CagRay *ray, double most, double *t,
                        size_t *which) {
  bool met = false;
  for (size_t i = 0; i < w->plane_count; i++) {
    const double at = (w->planes[i] - ray->origin.z) / ray->direction.z;
    if (ray->direction.z == 0 || !(at > ray->least && at < most)) continue;
    met = true;
    *t = most = at;
    *which = i;
  }
  return met;
}

CagStatus cag_preview_meet(const CagPreviewWorld *w, const CagRay *ray, CagCrossings *work,
                           CagPreviewHit *out, bool *met, CagError *err) {
  CagRay rest = *ray;
  CagBvhRay walked;
  CagCrossing nearest = {0}, c;
  size_t part = SIZE_MAX, plane = 0, first, count;
  CagStatus status = CAG_OK;
  double ground;
  const bool grounded = meet_ground(w, ray, ray->most, &ground, &plane);
  if (grounded) rest.most = ground;
  if (cag_bvh_ray(&w->boxes, ray->origin, ray->direction, ray->least, rest.most, &walked)) {
    CagBvhWalk walk;
    cag_bvh_start(&w->boxes, &walk);
    while (!status && cag_bvh_next(&w->boxes, &walked, &walk, &first, &count))
      for (size_t k = first; !status && k < first + count; k++) {
        bool here = false;
        const size_t i = w->boxes.order[k];
        status = meet_part(&w->parts[i], &rest, work, &c, &here, err);
        if (status || !here) continue;
        // Of two parts at one distance, the first counts.
        if (part != SIZE_MAX && c.t == rest.most && i > part) continue;
        part = i;
        nearest = c;
        rest.most = c.t;
        walked.most = nextafterf((float)(c.t - walked.start), INFINITY);
      }
  }
  *met = !status && (part != SIZE_MAX || grounded);
  if (part != SIZE_MAX) fill_hit(w, &w->parts[part], ray, &nearest, out);
  else if (grounded) {
    const size_t item = w->plane_items[plane];
    *out = (CagPreviewHit){.t = ground,
                           .point = cag_ray_point(ray, ground),
                           .normal = {0, 0, 1},
                           .flat = {0, 0, 1},
                           .u = NAN,
                           .v = NAN,
                           .item = item,
                           .material = w->scene->items[item].material,
                           .leaves = ray->direction.z > 0,
                           .closed = true};
    out->point.z = w->planes[plane];
  }
  return status;
}

// Whether anything is in the way of the ray, if everything is opaque.
static CagStatus is_blocked(const CagPreviewWorld *w, const CagRay *ray, CagCrossings *work,
                            bool *blocked, CagError *err) {
  CagBvhRay walked;
  CagBvhWalk walk;
  size_t first, count, plane;
  double ground;
  CagStatus status = CAG_OK;
  *blocked = meet_ground(w, ray, ray->most, &ground, &plane);
  if (*blocked ||
      !cag_bvh_ray(&w->boxes, ray->origin, ray->direction, ray->least, ray->most, &walked))
    return CAG_OK;
  cag_bvh_start(&w->boxes, &walk);
  while (!status && !*blocked && cag_bvh_next(&w->boxes, &walked, &walk, &first, &count))
    for (size_t k = first; !status && !*blocked && k < first + count; k++) {
      const CagPreviewPart *part = &w->parts[w->boxes.order[k]];
      CagCrossing c;
      if (part->caster) status = cag_caster_first(part->caster, ray, work, &c, blocked, err);
      else if (part->rods) *blocked = cag_ray_rods_blocks(part->rods, ray);
      else *blocked = cag_ray_mesh_blocks(part->mesh, ray);
    }
  return status;
}

// The largest number of transparent surfaces that light passes.
enum { PASSAGE_MAX = 24 };

CagStatus cag_preview_passage(const CagPreviewWorld *w, const CagRay *ray, CagCrossings *work,
                              CagColor *out, CagError *err) {
  *out = (CagColor){1, 1, 1};
  if (!w->transparent) {
    bool blocked;
    const CagStatus status = is_blocked(w, ray, work, &blocked, err);
    if (blocked) *out = (CagColor){0, 0, 0};
    return status;
  }
  CagRay rest = *ray;
  const double step = fmax(ray->least, 1e-9 * w->radius);
  for (int i = 0; i < PASSAGE_MAX; i++) {
    CagPreviewHit hit;
    bool met;
    CagStatus status = cag_preview_meet(w, &rest, work, &hit, &met, err);
    if (status || !met) return status;
    const CagPreviewSurface *s = &w->surfaces[hit.material];
    if (s->passed == 0) break;
    const CagColor c = cag_preview_color(w, &hit);
    out->r *= s->passed * c.r;
    out->g *= s->passed * c.g;
    out->b *= s->passed * c.b;
    rest.least = hit.t + step;
  }
  *out = (CagColor){0, 0, 0};
  return CAG_OK;
}

static CagVec3 pattern_point(const CagPreviewHit *hit) {
  return hit->to_pattern ? cag_transform_point(hit->to_pattern, hit->point) : hit->point;
}

CagColor cag_preview_color(const CagPreviewWorld *w, const CagPreviewHit *hit) {
  if (hit->scale) return cag_color_scale_at(hit->scale, hit->scale_value);
  const CagPreviewSurface *s = &w->surfaces[hit->material];
  return s->pattern ? s->pattern->color(s->material, pattern_point(hit)) : s->color;
}

// The inverse of a rigid motion is its transpose.
static CagVec3 vector_back(const CagTransform *t, CagVec3 v) {
  return cag_vec3(t->m[0][0] * v.x + t->m[1][0] * v.y + t->m[2][0] * v.z,
                  t->m[0][1] * v.x + t->m[1][1] * v.y + t->m[2][1] * v.z,
                  t->m[0][2] * v.x + t->m[1][2] * v.y + t->m[2][2] * v.z);
}

CagVec3 cag_preview_normal(const CagPreviewWorld *w, const CagPreviewHit *hit) {
  const CagPreviewSurface *s = &w->surfaces[hit->material];
  if (!s->pattern || !s->pattern->bumps || hit->scale) return hit->normal;
  const CagTransform *t = hit->to_pattern;
  const CagVec3 normal = t ? cag_transform_vector(t, hit->normal) : hit->normal;
  const CagVec3 bumpy = s->pattern->bumps(s->material, pattern_point(hit), normal);
  return t ? vector_back(t, bumpy) : bumpy;
}
