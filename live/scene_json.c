#include "live/scene_json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "live/place_json.h"
#include "live/robot_json.h"

enum { MESH_MARK = 0x6d676163, MESH_VERSION = 1, MESH_NORMALS = 1, MESH_LABELS = 2 };

// --- Meshes ---

static unsigned char *put(unsigned char *at, const void *from, size_t n) {
  if (n > 0) memcpy(at, from, n);
  return at + n;
}

bool cag_live_mesh_bytes(const CagMeshView *m, unsigned char **out, size_t *size) {
  const size_t v = m->vertex_count, t = m->triangle_count, e = m->edge_count, word = 4;
  const uint32_t head[8] = {
      MESH_MARK,   MESH_VERSION, (uint32_t)v,
      (uint32_t)t, (uint32_t)e,  (m->normals ? MESH_NORMALS : 0u) | (m->labels ? MESH_LABELS : 0u)};
  *size = sizeof head + word * (3 * v * (m->normals ? 2 : 1) + (m->labels ? 4 : 3) * t + 2 * e);
  unsigned char *at = *out = malloc(*size);
  if (!at) return false;
  at = put(at, head, sizeof head);
  at = put(at, m->positions, 3 * v * word);
  if (m->normals) at = put(at, m->normals, 3 * v * word);
  at = put(at, m->triangles, 3 * t * word);
  if (m->labels) at = put(at, m->labels, t * word);
  put(at, m->edges, 2 * e * word);
  return true;
}

// --- Parts of the scene ---

static void write_param(CagJson *j, CagSession *s, size_t i, const CagParamView *p) {
  const char *choice;
  cag_json_open(j, '{');
  cag_json_text(j, "name", p->name);
  cag_json_text(j, "description", p->description);
  cag_json_text(j, "kind", p->kind);
  cag_json_text(j, "value", p->value);
  cag_json_text(j, "initial", p->initial);
  if (p->ranged) {
    cag_json_number(j, "low", p->low);
    cag_json_number(j, "high", p->high);
  }
  cag_json_text(j, "unit", strcmp(p->kind, "angle") ? "" : "deg");
  cag_json_open_in(j, "choices", '[');
  for (size_t k = 0; (choice = cag_session_param_choice(s, i, k)); k++)
    cag_json_text(j, NULL, choice);
  cag_json_close(j, ']');
  cag_json_open_in(j, "place", '{');
  cag_live_place(j, &p->place);
  cag_json_close(j, '}');
  cag_json_close(j, '}');
}

static void write_params(CagJson *j, CagSession *s) {
  CagParamView p;
  cag_json_open_in(j, "params", '[');
  for (size_t i = 0; cag_session_param(s, i, &p); i++) write_param(j, s, i, &p);
  cag_json_close(j, ']');
}

static void write_materials(CagJson *j, CagSession *s) {
  CagMaterialView m;
  cag_json_open_in(j, "materials", '[');
  for (size_t i = 0; cag_session_material(s, i, &m); i++) {
    cag_json_open(j, '{');
    cag_json_text(j, "name", m.name);
    cag_json_numbers(j, "color", m.color, 3);
    cag_json_number(j, "metallic", m.metallic);
    cag_json_number(j, "roughness", m.roughness);
    cag_json_number(j, "transmission", m.transmission);
    cag_json_number(j, "ior", m.ior);
    cag_json_numbers(j, "emission", m.emission, 3);
    cag_json_number(j, "coat", m.coat);
    cag_json_text(j, "texture", m.texture);
    cag_json_numbers(j, "color2", m.color2, 3);
    cag_json_number(j, "scale", m.texture_scale);
    cag_json_close(j, '}');
  }
  cag_json_close(j, ']');
}

static void write_bounds(CagJson *j, const double low[3], const double high[3]) {
  cag_json_open_in(j, "bounds", '[');
  cag_json_numbers(j, NULL, low, 3);
  cag_json_numbers(j, NULL, high, 3);
  cag_json_close(j, ']');
}

static void write_origin(CagJson *j, CagSession *s, size_t part) {
  const char *what;
  CagPlaceView place;
  cag_json_open_in(j, "origin", '[');
  for (size_t k = 0; cag_session_part_place(s, part, k, &what, &place); k++) {
    if (!place.file) continue;
    cag_json_open(j, '{');
    cag_json_text(j, "what", what);
    cag_live_place(j, &place);
    cag_json_close(j, '}');
  }
  cag_json_close(j, ']');
}

static void write_sources(CagJson *j, CagSession *s, size_t part) {
  const char *name, *what;
  CagPlaceView place;
  cag_json_open_in(j, "sources", '[');
  for (size_t i = 0; (name = cag_session_part_source(s, part, i)); i++) {
    cag_json_open(j, '{');
    cag_json_text(j, "name", name);
    cag_json_open_in(j, "origin", '[');
    for (size_t k = 0; cag_session_source_place(s, part, i, k, &what, &place); k++) {
      cag_json_open(j, '{');
      cag_json_text(j, "what", what);
      cag_live_place(j, &place);
      cag_json_close(j, '}');
    }
    cag_json_close(j, ']');
    cag_json_close(j, '}');
  }
  cag_json_close(j, ']');
}

static void write_labels_of(CagJson *j, CagSession *s, size_t part) {
  uint32_t label;
  size_t material;
  cag_json_open_in(j, "labels", '[');
  for (size_t k = 0; cag_session_part_label(s, part, k, &label, &material); k++)
    cag_json_numbers(j, NULL, (const double[]){label, (double)material}, 2);
  cag_json_close(j, ']');
}

static void write_part(CagJson *j, CagSession *s, size_t i, const CagPartView *p,
                       const CagMeshView *m) {
  cag_json_open(j, '{');
  cag_json_text(j, "name", p->name);
  cag_json_text(j, "type", p->type);
  cag_json_text(j, "story", p->story);
  cag_json_text(j, "mesh", m->id);
  if (m->placed) cag_json_numbers(j, "placement", m->placement[0], 12);
  else cag_json_null(j, "placement");
  cag_json_number(j, "material", (double)p->material);
  write_labels_of(j, s, i);
  cag_json_bool(j, "line", m->line);
  cag_json_number(j, "radius", m->radius);
  write_bounds(j, p->low, p->high);
  write_origin(j, s, i);
  write_sources(j, s, i);
  cag_json_close(j, '}');
}

// The story of a part is only valid until its mesh is made.
static int write_parts(CagJson *j, CagSession *s, double coarse, const CagLiveMeshes *meshes) {
  CagPartView p;
  cag_json_open_in(j, "parts", '[');
  for (size_t i = 0; cag_session_part(s, i, &p); i++) {
    CagMeshView m;
    if (!strcmp(p.type, "ground")) continue;
    const int status = cag_session_part_mesh(s, i, coarse, meshes->has, meshes->context, &m);
    if (status != CAG_STATUS_OK) return status;
    if (m.positions && !meshes->keep(meshes->context, &m)) return CAG_STATUS_LIMIT;
    cag_session_part(s, i, &p);
    write_part(j, s, i, &p, &m);
  }
  cag_json_close(j, ']');
  return CAG_STATUS_OK;
}

static void write_grounds(CagJson *j, CagSession *s) {
  CagPartView p;
  cag_json_open_in(j, "grounds", '[');
  for (size_t i = 0; cag_session_part(s, i, &p); i++) {
    if (strcmp(p.type, "ground") != 0) continue;
    cag_json_open(j, '{');
    cag_json_text(j, "name", p.name);
    cag_json_number(j, "z", p.z);
    cag_json_number(j, "size", p.size);
    cag_json_number(j, "material", (double)p.material);
    cag_json_close(j, '}');
  }
  cag_json_close(j, ']');
}

static void write_cameras(CagJson *j, CagSession *s) {
  CagCameraView c;
  cag_json_open_in(j, "cameras", '[');
  for (size_t i = 0; cag_session_camera_view(s, i, &c); i++) {
    cag_json_open(j, '{');
    cag_json_text(j, "name", c.name);
    cag_json_numbers(j, "eye", c.eye, 3);
    cag_json_numbers(j, "target", c.target, 3);
    cag_json_numbers(j, "up", c.up, 3);
    if (c.orthographic) {
      cag_json_null(j, "fov");
      cag_json_number(j, "width", c.width);
    } else {
      cag_json_number(j, "fov", c.fov);
      cag_json_null(j, "width");
    }
    cag_json_numbers(j, "size", (const double[]){c.size[0], c.size[1]}, 2);
    cag_json_bool(j, "automatic", c.automatic);
    cag_json_close(j, '}');
  }
  cag_json_close(j, ']');
}

static void write_lights(CagJson *j, CagSession *s) {
  CagLightView l;
  cag_json_open_in(j, "lights", '[');
  for (size_t i = 0; cag_session_light(s, i, &l); i++) {
    cag_json_open(j, '{');
    cag_json_text(j, "kind", l.kind);
    cag_json_numbers(j, "position", l.position, 3);
    cag_json_numbers(j, "direction", l.direction, 3);
    cag_json_number(j, "angle", l.angle);
    cag_json_number(j, "size", l.size);
    cag_json_numbers(j, "color", l.color, 3);
    cag_json_number(j, "strength", l.strength);
    cag_json_close(j, '}');
  }
  cag_json_close(j, ']');
}

static void write_labels(CagJson *j, CagSession *s) {
  CagLabelView l;
  CagLabelPaths paths;
  cag_json_open_in(j, "labels", '[');
  for (size_t i = 0; cag_session_label(s, i, &l); i++) {
    cag_json_open(j, '{');
    cag_json_text(j, "text", l.text);
    cag_json_numbers(j, "at", l.at, 3);
    cag_json_numbers(j, "along", l.along, 3);
    cag_json_text(j, "place", l.place);
    cag_json_text(j, "mark", l.mark);
    cag_json_number(j, "size", l.size);
    cag_json_number(j, "material", (double)l.material);
    if (cag_session_label_paths(s, i, &paths)) {
      cag_json_text(j, "text_path", paths.text ? paths.text : "");
      cag_json_text(j, "mark_path", paths.mark ? paths.mark : "");
      cag_json_text(j, "paper_path", paths.paper ? paths.paper : "");
    }
    cag_json_close(j, '}');
  }
  cag_json_close(j, ']');
}

static void write_stage(CagJson *j, CagSession *s) {
  CagStageView stage;
  double color[3];
  cag_session_stage(s, &stage);
  cag_json_bool(j, "studio", stage.studio);
  cag_json_bool(j, "drawing", stage.drawing);
  write_bounds(j, stage.low, stage.high);
  if (stage.has_background) cag_json_numbers(j, "background", stage.background, 3);
  else cag_json_null(j, "background");
  cag_json_open_in(j, "sky", '[');
  for (size_t i = 0; cag_session_sky_color(s, i, color); i++) cag_json_numbers(j, NULL, color, 3);
  cag_json_close(j, ']');
}

static void write_images(CagJson *j, CagSession *s) {
  const char *name;
  size_t width, height;
  cag_json_open_in(j, "images", '[');
  for (size_t i = 0; (name = cag_session_image(s, i)); i++) {
    cag_json_open(j, '{');
    cag_json_text(j, "name", name);
    cag_session_image_size(s, i, &width, &height);
    cag_json_number(j, "width", (double)width);
    cag_json_number(j, "height", (double)height);
    cag_json_close(j, '}');
  }
  cag_json_close(j, ']');
}

// A script that shows images alone, or nothing, has no scene, but params.
static bool has_scene(CagSession *s, int *status) {
  CagShownCounts counts;
  *status = cag_session_scene(s, &counts);
  if (*status == CAG_STATUS_SCRIPT && cag_session_error_count(s) > 0) {
    CagErrorView e;
    cag_session_error(s, cag_session_error_count(s) - 1, &e);
    if (!strcmp(e.reason, "nothing-to-show")) *status = CAG_STATUS_OK;
    return false;
  }
  return *status == CAG_STATUS_OK;
}

// A file is listed as it was asked for, and by its real path.
static bool is_real_path(const char *path) {
  char *real = realpath(path, NULL);
  const bool same = real && !strcmp(real, path);
  free(real);
  return same;
}

// The script and what it read below its folder.
static void write_files(CagJson *j, CagSession *s, const CagLiveModel *model) {
  const size_t n = strlen(model->folder);
  const char *path;
  cag_json_open_in(j, "files", '[');
  cag_json_text(j, NULL, model->script);
  for (size_t i = 0; (path = cag_session_read_file(s, i)); i++) {
    const bool below = !strncmp(path, model->folder, n) && path[n] == '/';
    if (below && strcmp(path + n + 1, model->script) != 0 && is_real_path(path))
      cag_json_text(j, NULL, path + n + 1);
  }
  cag_json_close(j, ']');
}

int cag_live_scene(CagSession *s, const CagLiveModel *model, const CagLiveMeshes *meshes,
                   CagString *out) {
  CagJson j = {.to = out};
  int status;
  const bool scene = has_scene(s, &status);
  if (status != CAG_STATUS_OK) return status;
  cag_json_open(&j, '{');
  cag_json_number(&j, "run", model->run);
  cag_json_text(&j, "script", model->script);
  write_files(&j, s, model);
  cag_json_bool(&j, "timed", cag_session_is_timed(s));
  write_params(&j, s);
  write_images(&j, s);
  write_materials(&j, s);
  if (scene) status = write_parts(&j, s, model->coarse, meshes);
  else {
    cag_json_open_in(&j, "parts", '[');
    cag_json_close(&j, ']');
  }
  if (status != CAG_STATUS_OK) return status;
  write_grounds(&j, s);
  write_cameras(&j, s);
  write_lights(&j, s);
  write_labels(&j, s);
  write_stage(&j, s);
  cag_live_robots(&j, s);
  cag_json_close(&j, '}');
  return out->failed ? CAG_STATUS_LIMIT : CAG_STATUS_OK;
}

// --- Messages ---

static void write_prints(CagJson *j, const char *prints) {
  cag_json_open_in(j, "prints", '[');
  for (const char *at = prints; at && *at;) {
    const size_t n = strcspn(at, "\n");
    char *line = strndup(at, n);
    if (!line) break;
    cag_json_text(j, NULL, line);
    free(line);
    at += n + (at[n] == '\n');
  }
  cag_json_close(j, ']');
}

static void write_notes(CagJson *j, const CagSession *s, size_t error) {
  CagNoteView n;
  cag_json_open_in(j, "related", '[');
  for (size_t k = 0; cag_session_error_note(s, error, k, &n); k++) {
    char call[256];
    if (!n.file) continue;
    snprintf(call, sizeof call, *n.text ? "in %s, called here" : "called here", n.text);
    cag_json_open(j, '{');
    cag_json_text(j, "message", n.is_call ? call : n.text);
    cag_live_place(j, &(CagPlaceView){n.file, n.line, n.column, n.end_line, n.end_column, false});
    cag_json_close(j, '}');
  }
  cag_json_close(j, ']');
}

static void write_value(void *context, const CagValueView *v) {
  CagJson *j = context;
  cag_json_open(j, '{');
  cag_json_text(j, "name", v->name);
  cag_json_text(j, "text", v->text);
  cag_live_place(j, &v->place);
  cag_json_close(j, '}');
}

void cag_live_messages(CagSession *s, const CagLiveRun *run, CagString *out) {
  CagJson j = {.to = out};
  cag_json_open(&j, '{');
  cag_json_number(&j, "run", run->run);
  cag_json_bool(&j, "ok", run->status == CAG_STATUS_OK);
  cag_json_number(&j, "seconds", run->seconds);
  cag_json_number(&j, "memory", (double)cag_session_memory(s));
  write_prints(&j, run->prints);
  cag_json_open_in(&j, "diagnostics", '[');
  for (size_t i = 0; i < cag_session_error_count(s); i++) {
    CagErrorView e;
    cag_session_error(s, i, &e);
    cag_json_open(&j, '{');
    cag_json_text(&j, "severity", e.warning ? "warning" : "error");
    cag_json_text(&j, "code", e.code);
    cag_json_text(&j, "message", e.message);
    cag_json_text(&j, "help", e.help);
    cag_live_place(&j, &(CagPlaceView){e.file, e.line, e.column, e.end_line, e.end_column, false});
    write_notes(&j, s, i);
    cag_json_close(&j, '}');
  }
  cag_json_close(&j, ']');
  cag_json_open_in(&j, "values", '[');
  cag_session_values(s, write_value, &j);
  cag_json_close(&j, ']');
  if (run->status != CAG_STATUS_OK) write_params(&j, s); // otherwise, the scene has them
  cag_json_close(&j, '}');
}
