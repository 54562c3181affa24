// Writes a POV-Ray file in this order: header, settings, camera, lights, sky, materials, items.

#include "interp/formats/pov.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/solid/general.h"
#include "interp/formats/pov_write.h"

static void heading(CagPovWriter *w, const char *text) {
  cag_pov_printf(w, "\n// ---------- %s ----------\n\n", text);
}

// --- Used items and materials ---

static CagStatus find_closed(const CagItem *item, bool *closed, CagError *err) {
  *closed = item->kind != CAG_ITEM_REGION;
  if (item->kind == CAG_ITEM_SURFACE) *closed = cag_surface_is_closed(item->as.surface);
  return item->kind == CAG_ITEM_MESH ? cag_mesh_watertight(item->as.mesh, closed, NULL, err)
                                     : CAG_OK;
}

static CagStatus write_materials(CagPovWriter *w, const bool *closed, CagError *err) {
  const CagScene *s = w->scene;
  enum { THIN = 1, CLOSED = 2 };
  unsigned char *used = cag_calloc(s->material_count + 1, 1);
  if (!used) return cag_fail_memory(err);
  for (size_t i = 0; i < s->item_count; i++)
    used[s->items[i].material] |=
        closed[i] || !(s->materials[s->items[i].material].transmission > 0) ? CLOSED : THIN;
  for (size_t i = 0; i < s->item_count; i++)
    for (size_t k = 0; k < s->items[i].label_count; k++)
      used[s->items[i].labels[k].material] |= CLOSED;
  for (size_t i = 0; i < s->material_count; i++) {
    if (used[i] & CLOSED) cag_pov_material(w, i, true);
    if (used[i] & THIN) cag_pov_material(w, i, false);
  }
  cag_free(used);
  return CAG_OK;
}

// --- Settings ---

static void write_radiosity(CagPovWriter *w) {
  bool final = w->options->quality == CAG_POV_FINAL;
  cag_pov_text(w, "  radiosity { // light from everywhere\n");
  cag_pov_printf(w, "    pretrace_start 0.08 pretrace_end %s\n", final ? "0.01" : "0.02");
  cag_pov_printf(w, "    count %d nearest_count %d error_bound %s recursion_limit %d\n",
                 final ? 120 : 50, final ? 10 : 6, final ? "0.5" : "0.9", final ? 2 : 1);
  cag_pov_text(w,
               "    low_error_factor 0.6 gray_threshold 0 minimum_reuse 0.012 brightness 1\n  }\n");
}

static void write_settings(CagPovWriter *w) {
  cag_pov_text(w, "global_settings {\n  assumed_gamma 1.0 // colors are linear light\n");
  cag_pov_text(w, "  max_trace_level 12\n");
  if (w->indirect) {
    write_radiosity(w);
  } else {
    cag_pov_text(w, "  ambient_light ");
    cag_pov_color(w, cag_pov_ambient(w->scene));
    cag_pov_text(w, " // instead of light from everywhere\n");
  }
  cag_pov_text(w, "}\n");
}

// --- Items ---

static void write_ground(CagPovWriter *w, const CagItem *item) {
  if (isinf(item->ground_size)) {
    cag_pov_text(w, "plane {\n  z, ");
    cag_pov_number(w, item->ground_z);
    cag_pov_text(w, "\n}");
    return;
  }
  const double thickness = 1e-3; // as a fraction of its size: a slab below its level
  double half = item->ground_size / 2;
  cag_pov_text(w, "box {\n  ");
  cag_pov_vec(w, cag_vec3(-half, -half, item->ground_z - thickness * item->ground_size));
  cag_pov_text(w, ", ");
  cag_pov_vec(w, cag_vec3(half, half, item->ground_z));
  cag_pov_text(w, "\n}");
}

static bool is_operation(const CagItem *item) {
  return item->kind == CAG_ITEM_SOLID &&
         (item->as.solid->kind == CAG_SOLID_UNION || item->as.solid->kind == CAG_SOLID_DIFFERENCE ||
          item->as.solid->kind == CAG_SOLID_INTERSECTION);
}

static bool is_meshed(const CagPovWriter *w, const CagItem *item) {
  const CagPovCsg csg = w->options->csg;
  if (w->options->meshes_only) return true;
  if (csg == CAG_POV_CSG_NATIVE || !is_operation(item)) return false;
  return csg == CAG_POV_CSG_MESH ||
         !cag_solid_in_general_position(item->as.solid, w->scene->interrupt);
}

static bool try_native(CagPovWriter *w, const CagItem *item) {
  if (item->kind == CAG_ITEM_GROUND) return write_ground(w, item), true;
  if (is_meshed(w, item)) return false;
  switch (item->kind) {
  case CAG_ITEM_SOLID: return cag_pov_try_solid(w, item->as.solid);
  case CAG_ITEM_SURFACE:
    return cag_pov_try_cones(w, item->as.surface) || cag_pov_try_surface(w, item->as.surface);
  case CAG_ITEM_REGION: return cag_pov_try_polygon(w, item->as.region, &item->placement);
  default: return false;
  }
}

static CagStatus write_mesh(CagPovWriter *w, const CagItem *item, CagError *err) {
  CagMesh *mesh;
  CagStatus status = cag_item_mesh(w->scene, item, &mesh, err);
  if (status) return status;
  status = cag_pov_mesh(w, mesh, err);
  cag_mesh_release(mesh);
  return status;
}

static void describe(const CagItem *item, char *buffer, size_t size) {
  buffer[0] = 0;
  switch (item->kind) {
  case CAG_ITEM_CURVE: item->as.curve->kind->describe(item->as.curve, buffer, size); break;
  case CAG_ITEM_SURFACE: item->as.surface->kind->describe(item->as.surface, buffer, size); break;
  case CAG_ITEM_SOLID: cag_solid_describe(item->as.solid, buffer, size); break;
  default: break;
  }
}

static const char *kind_name(const CagItem *item) {
  switch (item->kind) {
  case CAG_ITEM_CURVE: return item->as.curve->kind->name;
  case CAG_ITEM_SURFACE: return item->as.surface->kind->name;
  case CAG_ITEM_REGION: return "region";
  case CAG_ITEM_MESH: return "mesh";
  case CAG_ITEM_GROUND: return "ground";
  case CAG_ITEM_SOLID: return "solid";
  }
  return "";
}

static void write_item_comment(CagPovWriter *w, const CagItem *item) {
  char what[256], line[512];
  describe(item, what, sizeof what);
  snprintf(line, sizeof line, "%.150s: %s%s%s%s", item->name,
           item->kind == CAG_ITEM_SOLID ? "" : kind_name(item),
           item->kind == CAG_ITEM_SURFACE ? " surface"
           : item->kind == CAG_ITEM_CURVE ? " curve"
                                          : "",
           what[0] && item->kind != CAG_ITEM_SOLID ? ", " : "", what);
  cag_pov_comment(w, "", line);
}

// Tests whether all parts are opaque.
static bool is_opaque(const CagPovWriter *w, const CagItem *item) {
  bool opaque = !w->see_through;
  for (size_t k = 0; k < item->label_count; k++)
    opaque &= !(w->scene->materials[item->labels[k].material].transmission > 0);
  return opaque;
}

static CagStatus write_item(CagPovWriter *w, size_t index, bool closed, CagError *err) {
  const CagItem *item = &w->scene->items[index];
  const char *name = w->item_names[index];
  char material[64];
  CagStatus status = CAG_OK;
  bool meshed = false;
  w->item = item;
  w->placement = w->outer = cag_transform_identity();
  w->see_through = w->scene->materials[item->material].transmission > 0;
  write_item_comment(w, item);
  if (item->kind == CAG_ITEM_CURVE && !w->options->meshes_only) {
    status = cag_pov_curve(w, item, name, err);
  } else {
    cag_pov_printf(w, "#declare %s = ", name);
    meshed = !try_native(w, item);
    if (meshed) status = write_mesh(w, item, err);
    if (!status && w->failure.status) {
      *err = w->failure;
      status = w->failure.status;
    }
  }
  if (status) return status;
  cag_pov_material_name(w, item->material, closed, material);
  cag_pov_printf(w, "\nobject {\n  %s\n", name);
  if (item->kind == CAG_ITEM_MESH && item->as.mesh->scale.kind && item->as.mesh->triangle_count)
    cag_pov_scale_material(w, item->material, &item->as.mesh->scale);
  else cag_pov_printf(w, "  material { %s }\n", material);
  // If smooth normals of a mesh point away from a ray, the renderer reverses them and lights the
  // back side, which causes black specks. This never happens in direct view (pov_facing.c), but may
  // in a mirror. The back side of an opaque body is in its own shadow, so lighting both sides is
  // correct.
  if (meshed && closed && is_opaque(w, item)) cag_pov_text(w, "  double_illuminate\n");
  cag_pov_placement(w, "  ", &w->placement);
  cag_pov_text(w, w->unit != 1 ? "  scale unit\n}\n\n" : "}\n\n");
  return CAG_OK;
}

static CagStatus write_items(CagPovWriter *w, const bool *closed, CagError *err) {
  for (size_t i = 0; i < w->scene->item_count; i++) {
    if (w->scene->interrupt && *w->scene->interrupt)
      return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1,
                      "the export was interrupted");
    if (cag_atomic_file_failed(w->file)) return CAG_OK; // its commit reports the error
    CagStatus status = write_item(w, i, closed[i], err);
    if (status) return status;
  }
  return CAG_OK;
}

// --- The whole file ---

static bool make_names(CagPovWriter *w) {
  const CagScene *s = w->scene;
  size_t n = s->item_count > s->material_count ? s->item_count : s->material_count;
  const char **names = cag_malloc((n ? n : 1) * sizeof *names);
  if (!names) return false;
  for (size_t i = 0; i < s->item_count; i++) names[i] = s->items[i].name;
  bool ok = cag_pov_names("", names, s->item_count, &w->item_names);
  for (size_t i = 0; i < s->material_count; i++) names[i] = s->materials[i].name;
  ok = ok && cag_pov_names("M_", names, s->material_count, &w->material_names);
  cag_free(names);
  return ok;
}

// POV-Ray's tolerances are absolute, about 1e-3. Scenes with radii in this range are well above
// them, and well below the range where doubles are imprecise. Others are scaled to about 100 by a
// power of ten.
#define RADIUS_MIN 2.0
#define RADIUS_MAX 1e6

static double unit_for(double radius) {
  if (radius >= RADIUS_MIN && radius <= RADIUS_MAX) return 1;
  return pow(10, 2 - floor(log10(radius)));
}

static void measure(CagPovWriter *w) {
  const CagBounds *b = &w->scene->bounds;
  bool empty = !(b->min.x <= b->max.x);
  w->center = empty ? cag_vec3(0, 0, 0) : cag_lerp(b->min, b->max, 0.5);
  w->radius = empty ? 0 : cag_norm(cag_sub(b->max, b->min)) / 2;
  if (!(w->radius > 0)) w->radius = 100; // only grounds or points: any size is suitable
  w->unit = unit_for(w->radius);
}

static CagStatus write_all(CagPovWriter *w, const bool *closed, CagError *err) {
  const CagScene *s = w->scene;
  cag_pov_comment(w, "", s->script && s->script[0] ? s->script : "a scene");
  cag_pov_text(w, "// Written by cag " CAG_VERSION " for POV-Ray 3.7. Millimeters, Z up.\n\n");
  cag_pov_text(w, "#version 3.7;\n\n");
  write_settings(w);
  if (w->unit != 1) {
    cag_pov_text(w, "\n// The renderer's tolerances are meant for scenes some 100 units large.\n");
    cag_pov_printf(w, "#declare unit = %.9g; // a millimeter\n", w->unit);
  }
  heading(w, "Camera");
  cag_pov_camera(w);
  heading(w, "Light and sky");
  cag_pov_lights(w);
  cag_pov_sky(w);
  heading(w, "Materials");
  CagStatus status = write_materials(w, closed, err);
  if (status) return status;
  heading(w, "Things");
  status = write_items(w, closed, err);
  if (status || s->label_count == 0) return status;
  heading(w, "Labels");
  return cag_pov_labels(w, err);
}

static bool lit_by_sky_alone(const CagScene *s) {
  return s->light_count == 0 && (s->sky.color_count > 0 || s->sky.image);
}

CagStatus cag_export_pov(const CagScene *scene, const CagPovOptions *options, CagAtomicFile *file,
                         CagError *err) {
  CagPovWriter w = {.scene = scene, .options = options, .file = file};
  if (scene->item_count == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_nothing_to_show, "", -1,
                    "the script shows no shape");
  if (options->camera >= scene->camera_count)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_camera_unknown, "camera", (long)options->camera,
                    "the scene has %zu cameras, but none with the number %zu", scene->camera_count,
                    options->camera);
  w.camera = &scene->cameras[options->camera];
  w.indirect = options->quality == CAG_POV_FINAL ||
               (options->quality == CAG_POV_NORMAL && lit_by_sky_alone(scene));
  measure(&w);
  bool *closed = cag_malloc(scene->item_count * sizeof *closed);
  CagStatus status = CAG_OK;
  if (!closed || !make_names(&w)) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < scene->item_count; i++)
    status = find_closed(&scene->items[i], &closed[i], err);
  if (!status) status = write_all(&w, closed, err);
  if (!status && w.failure.status) {
    *err = w.failure;
    status = w.failure.status;
  }
  cag_free(closed);
  cag_free(w.item_names);
  cag_free(w.material_names);
  return status;
}
