// Renders a scene by POV-Ray, from its source, or by the built-in renderer, and writes EXR or PNG.

#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/stop.h"
#include "interp/formats/pov.h"
#include "interp/render/exr.h"
#include "interp/render/png.h"
#include "interp/render/povray.h"
#include "interp/render/preview.h"
#include "interp/render/preview_passes.h"
#include "interp/session/output.h"

#define SKY_FILE "sky.exr"

void cag_render_options_init(CagRenderOptions *o) { *o = (CagRenderOptions){.quality = "normal"}; }

const char *cag_standard_camera(size_t i) { return cag_standard_view(i); }

const char *cag_find_povray(char *buffer, size_t size) {
  CagError err = {0};
  char version[64];
  if (!cag_povray_find(NULL, 0, version, &err)) {
    snprintf(buffer, size, "%s", err.message);
    return NULL;
  }
  snprintf(buffer, size, "%s", version);
  return buffer;
}

static bool find_quality(const char *name, CagPovQuality *pov, CagPovrayQuality *engine) {
  static const char *const names[] = {"draft", "normal", "final"};
  static const CagPovQuality source[] = {CAG_POV_DRAFT, CAG_POV_NORMAL, CAG_POV_FINAL};
  static const CagPovrayQuality process[] = {CAG_POVRAY_DRAFT, CAG_POVRAY_NORMAL, CAG_POVRAY_FINAL};
  for (size_t i = 0; i < 3; i++) {
    if (strcmp(names[i], name) != 0) continue;
    *pov = source[i];
    *engine = process[i];
    return true;
  }
  return false;
}

static int add_view(CagSession *s, void *name) {
  CagError err = {0};
  const CagStatus status = cag_session_checked(s, cag_scene_add_view(&s->scene, name, &err), &err);
  return !status ? CAG_STATUS_OK : cag_session_fail_geometry(s, &err);
}

// Adds the camera of the host.
static int add_host_camera(CagSession *s, void *view) {
  const CagCameraView *v = view;
  CagError err = {0};
  const CagCamera c = {.name = (char *)(size_t)(v->name ? v->name : "view"),
                       .eye = {v->eye[0], v->eye[1], v->eye[2]},
                       .target = {v->target[0], v->target[1], v->target[2]},
                       .up = {v->up[0], v->up[1], v->up[2]},
                       .orthographic = v->orthographic,
                       .fov = v->fov * M_PI / 180,
                       .width = v->width,
                       .size = {v->size[0], v->size[1]}};
  const CagVec3 view_direction = cag_sub(c.target, c.eye), side = cag_cross(view_direction, c.up);
  const bool good = cag_norm(side) > 0 && isfinite(cag_norm(side)) &&
                    (c.orthographic ? c.width > 0 : c.fov > 0 && c.fov < M_PI);
  CagCamera square = c;
  if (good) square.up = cag_unit(cag_cross(side, view_direction));
  const CagStatus status =
      good ? cag_scene_add_camera(&s->scene, &square, &err)
           : cag_fail(
                 &err, CAG_E_ARGUMENT, CAG_ERR_value, "view", -1,
                 "the camera of the view needs a direction, an up vector, and an angle or width");
  return !status ? CAG_STATUS_OK : cag_session_fail_geometry(s, &err);
}

int cag_session_find_camera(CagSession *s, const char *name, size_t *out) {
  *out = 0;
  if (!name) return CAG_STATUS_OK;
  const char *names[64];
  size_t n = 0;
  for (size_t i = 0; i < s->scene.camera_count; i++) {
    if (strcmp(s->scene.cameras[i].name, name) == 0) {
      *out = i;
      return CAG_STATUS_OK;
    }
    if (n < 64) names[n++] = s->scene.cameras[i].name;
  }
  for (size_t i = 0; cag_standard_view(i); i++) {
    if (strcmp(cag_standard_view(i), name) == 0) {
      *out = s->scene.camera_count;
      return cag_session_geometry(s, add_view, (void *)(size_t)name);
    }
    if (n < 64) names[n++] = cag_standard_view(i);
  }
  CagDiagnostic *d = cag_diagnostics_add(&s->diagnostics, CAG_ERR_camera_unknown, NULL,
                                         (CagSpan){0, 0}, "unknown camera `%s`", name);
  const char *nearest = cag_nearest_name(name, names, n);
  if (nearest) cag_diagnostic_set_help(d, "did you mean `%s`?", nearest);
  else
    cag_diagnostic_set_help(
        d, "the scene has `%s`; top, bottom, front, back, left, right, and iso always work",
        names[0]);
  return CAG_STATUS_USAGE;
}

bool cag_session_pov_csg(CagSession *s, CagPovCsg usual, CagPovCsg *out) {
  const char *word = s->options.pov_csg ? s->options.pov_csg : "auto";
  *out = usual;
  if (strcmp(word, "auto") == 0) return true;
  *out = strcmp(word, "native") == 0 ? CAG_POV_CSG_NATIVE : CAG_POV_CSG_MESH;
  if (*out == CAG_POV_CSG_NATIVE || strcmp(word, "mesh") == 0) return true;
  cag_diagnostics_add(&s->diagnostics, CAG_ERR_format_unknown, NULL, (CagSpan){0, 0},
                      "expected set operations as native, mesh, or auto, found %s", word);
  return false;
}

// --- Metadata ---

static bool add_matrix(CagExrMetadata *m, const char *name, const CagTransform *t, CagError *err) {
  double rows[16];
  for (int i = 0; i < 16; i++) rows[i] = t->m[i / 4][i % 4];
  return cag_exr_metadata_matrix(m, name, rows, err);
}

// Makes the metadata of a picture: script, camera, tolerance, versions.
static bool make_metadata(const CagSession *s, const CagCamera *camera, const char *renderer,
                          CagExrMetadata *m, CagError *err) {
  CagTransform frame = cag_camera_frame(camera), inverse;
  CagError ignored = {0};
  bool ok = cag_exr_metadata_text(m, "cag.version", CAG_VERSION, err) &&
            cag_exr_metadata_text(m, "cag.script", s->script ? s->script : "", err) &&
            cag_exr_metadata_text(m, "cag.renderer", renderer, err) &&
            cag_exr_metadata_text(m, "cag.camera", camera->name, err) &&
            cag_exr_metadata_number(m, "cag.tolerance", s->scene.tolerance, err) &&
            cag_exr_metadata_number(m, "cag.frame", s->frame, err) &&
            add_matrix(m, "cag.cameraToWorld", &frame, err);
  if (!ok) return false;
  if (camera->orthographic) ok = cag_exr_metadata_number(m, "cag.cameraWidth", camera->width, err);
  else ok = cag_exr_metadata_number(m, "cag.cameraFov", camera->fov * 180 / M_PI, err);
  if (ok && !cag_transform_inverse(&frame, &inverse, &ignored))
    ok = add_matrix(m, "worldToCamera", &inverse, err);
  return ok;
}

// --- Rendering ---

typedef enum Engine { POVRAY, PREVIEW } Engine;
typedef bool PassList[CAG_PASS_COUNT];

typedef struct Job {
  Engine renderer;
  PassList passes; // of the built-in renderer
  CagSession *session;
  const CagRenderOptions *options;
  CagCamera camera;
  size_t index; // of the camera
  CagPovQuality pov;
  CagPovCsg csg;
  CagPovrayQuality engine;
  char *source;
  size_t source_size;
  CagPovrayResult result;
  const char *path; // of the picture
} Job;

static int write_source(CagSession *s, void *context) {
  Job *j = context;
  CagError io = {0};
  CagError err = {0};
  CagAtomicFile *f = cag_atomic_file_open_memory(&io);
  if (!f) return cag_session_fail_io(s, CAG_ERR_output_file, &io);
  // The sky's panorama is copied beside the scene under a plain name (see povray.h).
  CagScene *scene = &s->scene;
  char plain[] = SKY_FILE, *image = scene->sky.image;
  if (image) scene->sky.image = plain;
  CagPovOptions options = {.quality = j->pov,
                           .samples = j->options->samples,
                           .camera = j->index,
                           .size = {j->camera.size[0], j->camera.size[1]},
                           .csg = j->csg};
  CagStatus written = cag_session_checked(s, cag_export_pov(scene, &options, f, &err), &err);
  scene->sky.image = image;
  if (written) {
    cag_atomic_file_abort(f);
    return cag_session_fail_geometry(s, &err);
  }
  if (!cag_atomic_file_commit_memory(f, &j->source, &j->source_size, &io))
    return cag_session_fail_io(s, CAG_ERR_output_file, &io);
  return CAG_STATUS_OK;
}

static int render(Job *j) {
  CagError io = {0};
  const CagScene *scene = &j->session->scene;
  CagPovrayFile sky = {SKY_FILE, scene->sky.image};
  CagPovrayJob job = {.scene = j->source,
                      .scene_size = j->source_size,
                      .file = scene->sky.image ? &sky : NULL,
                      .width = j->camera.size[0],
                      .height = j->camera.size[1],
                      .region_x = j->options->region.x,
                      .region_y = j->options->region.y,
                      .region_width = j->options->region.width,
                      .region_height = j->options->region.height,
                      .quality = j->engine,
                      .lens = cag_camera_has_lens(&j->camera),
                      .threads = j->options->threads,
                      .time_limit = j->options->time_limit,
                      .interrupted = &j->session->vm->stop,
                      .progress = j->options->progress,
                      .progress_user = j->options->progress_context};
  if (!cag_povray_render(&job, &j->result, &io))
    return cag_session_fail_io(j->session, CAG_ERR_renderer, &io);
  return CAG_STATUS_OK;
}

static bool is_png(const char *path) {
  const char *dot = strrchr(path, '.');
  return dot && strcasecmp(dot, ".png") == 0;
}

// Reads the requested part of the renderer's picture.
static bool read_picture(const Job *j, CagImage *out, CagError *io) {
  const CagRenderRegion r = j->options->region;
  CagImage whole;
  if (!cag_exr_read_memory(j->result.exr, j->result.exr_size, "the renderer's picture", &whole,
                           NULL, io))
    return false;
  if (!r.width) {
    *out = whole;
    return true;
  }
  const bool ok = cag_image_create(out, (size_t)r.width, (size_t)r.height, whole.channel_count, io);
  for (size_t c = 0; ok && c < whole.channel_count; c++) {
    cag_image_set_name(out, c, whole.channels[c].name);
    for (int y = 0; y < r.height; y++)
      memcpy(cag_image_plane(out, c) + (size_t)y * out->width,
             cag_image_plane(&whole, c) + (size_t)(r.y + y) * whole.width + (size_t)r.x,
             out->width * sizeof(float));
  }
  cag_image_free(&whole);
  return ok;
}

static bool write_png(Job *j, const char *path, CagError *io) {
  CagImage image;
  if (!read_picture(j, &image, io)) return false;
  CagPngText texts[] = {{"Software", "cag " CAG_VERSION},
                        {"Title", j->session->script ? j->session->script : ""}};
  bool ok = cag_png_write(
      path, &image, &(CagPngOptions){.exposure = j->options->exposure, .bits = 8}, texts, 2, io);
  cag_image_free(&image);
  return ok;
}

// POV-Ray's pictures are half floats, so their parts are, too.
static bool write_part(Job *j, const char *path, const CagExrMetadata *m, CagError *io) {
  CagImage image;
  if (!read_picture(j, &image, io)) return false;
  const bool ok = cag_exr_write(path, &image, CAG_EXR_HALF, m, io);
  cag_image_free(&image);
  return ok;
}

static bool write_exr(Job *j, const char *path, CagError *io) {
  char renderer[96];
  snprintf(renderer, sizeof renderer, "POV-Ray %s", j->result.version);
  CagExrMetadata m = {0};
  bool ok = make_metadata(j->session, &j->camera, renderer, &m, io);
  if (ok && j->options->region.width) ok = write_part(j, path, &m, io);
  else if (ok)
    ok = cag_exr_rewrite(j->result.exr, j->result.exr_size, "the renderer's picture", path, &m,
                         NULL, io);
  cag_exr_metadata_free(&m);
  return ok;
}

static int make_picture(CagSession *s, void *context) {
  Job *j = context;
  CagError io = {0};
  int status = render(j);
  if (status == CAG_STATUS_OK &&
      !(is_png(j->path) ? write_png(j, j->path, &io) : write_exr(j, j->path, &io)))
    status = cag_session_fail_io(s, CAG_ERR_output_file, &io);
  return status;
}

// --- The built-in renderer ---

// Samples of light for a picture of each quality; a draft is a sketch.
static const int PREVIEW_SAMPLES[] = {
    [CAG_POV_DRAFT] = 0, [CAG_POV_NORMAL] = 16, [CAG_POV_FINAL] = 128};

static bool write_preview(const Job *j, const CagImage *image, CagExrMetadata *m, bool finished,
                          CagError *io) {
  CagPngText texts[] = {{"Software", "cag " CAG_VERSION},
                        {"Title", j->session->script ? j->session->script : ""},
                        {"Comment", "unfinished"}};
  if (is_png(j->path))
    return cag_png_write(j->path, image,
                         &(CagPngOptions){.exposure = j->options->exposure, .bits = 8}, texts,
                         finished ? 2 : 3, io);
  bool ok = make_metadata(j->session, &j->camera, "cag preview", m, io);
  if (ok && !finished) ok = cag_exr_metadata_text(m, "cag.unfinished", "stopped", io);
  return ok && cag_exr_write(j->path, image, CAG_EXR_FLOAT, m, io);
}

// Both pictures as one, which takes the channels of both. The first may be empty.
static bool join_channels(CagImage *a, CagImage *b, CagError *io) {
  CagImage both;
  if (b->channel_count == 0) return true;
  if (!cag_image_create(&both, b->width, b->height, a->channel_count + b->channel_count, io))
    return false;
  const size_t n = b->width * b->height;
  for (size_t c = 0; c < both.channel_count; c++) {
    const CagImage *from = c < a->channel_count ? a : b;
    const size_t k = c < a->channel_count ? c : c - a->channel_count;
    cag_image_set_name(&both, c, from->channels[k].name);
    memcpy(cag_image_plane(&both, c), cag_image_plane(from, k), n * sizeof(float));
  }
  cag_image_free(a);
  *a = both;
  return true;
}

static CagPreviewOptions preview_options(const Job *j) {
  const CagRenderRegion r = j->options->region;
  return (CagPreviewOptions){
      .sky_light = j->pov == CAG_POV_FINAL || j->session->scene.light_count == 0,
      .samples = j->options->samples > 0 ? j->options->samples : PREVIEW_SAMPLES[j->pov],
      .region_x = r.x,
      .region_y = r.y,
      .region_width = r.width,
      .region_height = r.height,
      .progress = j->options->progress,
      .progress_user = j->options->progress_context};
}

// What the built-in renderer makes: the color, then the other passes.
typedef struct Preview {
  CagImage image, passes;
  CagExrMetadata metadata;
  bool finished;
} Preview;

static CagStatus render_preview(const Job *j, Preview *p, CagError *err) {
  const CagScene *scene = &j->session->scene;
  const CagPreviewOptions options = preview_options(j);
  CagStatus status = CAG_OK;
  p->finished = true;
  cag_set_thread_count(j->options->threads);
  if (j->passes[CAG_PASS_COLOR])
    status = cag_preview_render(scene, &j->camera, &options, &p->image, &p->finished, err);
  if (!status && p->finished)
    status =
        cag_preview_passes(scene, &j->camera, &options, j->passes, &p->passes, &p->metadata, err);
  cag_set_thread_count(0);
  if (!status && !p->finished) cag_stop_fail(err);
  return status;
}

// Renders and writes. A picture that was stopped is written if it is to be kept; the status is that
// of the stop in any case.
static int make_preview(CagSession *s, void *context) {
  Job *j = context;
  Preview p = {.finished = false};
  CagError err = {0}, io = {0};
  const CagStatus status = render_preview(j, &p, &err);
  int result = CAG_STATUS_OK;
  const volatile int *flag = cag_stop_lend(NULL); // the picture is written in any case
  if (!status && (p.finished || j->options->keep_partial) &&
      (!join_channels(&p.image, &p.passes, &io) ||
       !write_preview(j, &p.image, &p.metadata, p.finished, &io)))
    result = cag_session_fail_io(s, CAG_ERR_output_file, &io);
  cag_stop_lend(flag);
  cag_image_free(&p.image);
  cag_image_free(&p.passes);
  cag_exr_metadata_free(&p.metadata);
  if (result != CAG_STATUS_OK || (!status && p.finished)) return result;
  cag_session_checked(s, status ? status : CAG_E_CALLBACK, &err);
  return cag_session_fail_geometry(s, &err);
}

// Reads the passes, which only an .exr of the built-in renderer has.
static bool find_passes(CagSession *s, const CagRenderOptions *options, const char *path,
                        PassList out) {
  char wrong[32];
  const char *expected = NULL;
  memset(out, 0, sizeof(PassList));
  out[CAG_PASS_COLOR] = true;
  if (!options->passes) return true;
  if (!cag_preview_read_passes(options->passes, out, wrong)) {
    CagDiagnostic *d = cag_diagnostics_add(&s->diagnostics, CAG_ERR_format_unknown, NULL,
                                           (CagSpan){0, 0}, "unknown pass `%s`", wrong);
    cag_diagnostic_set_help(d, "the passes are color, depth, normal, object, material, uv, and "
                               "curvature");
    return false;
  }
  if (is_png(path)) expected = "passes need an .exr file";
  else if (options->engine && !strcmp(options->engine, "povray"))
    expected = "passes are made by the built-in renderer, not by povray";
  if (expected)
    cag_diagnostics_add(&s->diagnostics, CAG_ERR_format_unknown, NULL, (CagSpan){0, 0}, "%s",
                        expected);
  return !expected;
}

static bool find_engine(CagSession *s, const CagRenderOptions *options, CagPovQuality quality,
                        Engine *out) {
  const char *name = options->engine;
  if (!name || !strcmp(name, "auto")) {
    CagError missing;
    *out = quality == CAG_POV_DRAFT || !cag_povray_find(NULL, 0, NULL, &missing) ? PREVIEW : POVRAY;
    return true;
  }
  *out = !strcmp(name, "povray") ? POVRAY : PREVIEW;
  if (*out == POVRAY || !strcmp(name, "preview")) return true;
  cag_diagnostics_add(&s->diagnostics, CAG_ERR_format_unknown, NULL, (CagSpan){0, 0},
                      "expected povray, preview, or auto as the renderer, found %s", name);
  return false;
}

static int frame_all(CagSession *s, void *context) {
  cag_camera_frame_all(&s->scene, context);
  return CAG_STATUS_OK;
}

static bool check_region(const Job *j) {
  const CagRenderRegion r = j->options->region;
  const int *size = j->camera.size;
  if (!r.width || (r.x >= 0 && r.y >= 0 && r.width > 0 && r.height > 0 &&
                   r.width <= size[0] - r.x && r.height <= size[1] - r.y))
    return true;
  CagDiagnostic *d =
      cag_diagnostics_add(&j->session->diagnostics, CAG_ERR_region_outside, NULL, (CagSpan){0, 0},
                          "the region %dx%d+%d+%d exceeds the picture of %d by %d pixels", r.width,
                          r.height, r.x, r.y, size[0], size[1]);
  cag_diagnostic_set_help(d, "a region is WxH+X+Y within --size");
  return false;
}

// Renders with camera `j->index`.
static int render_camera(Job *j) {
  CagSession *s = j->session;
  const CagRenderOptions *options = j->options;
  int status = CAG_STATUS_OK;
  CagCamera *chosen = &s->scene.cameras[j->index];
  if (options->width > 0 && chosen->framed) { // for the shape of the picture
    chosen->size[0] = options->width;
    chosen->size[1] = options->height;
    status = cag_session_geometry(s, frame_all, chosen);
    if (status != CAG_STATUS_OK) return status;
  }
  j->camera = *chosen;
  if (options->width > 0) {
    j->camera.size[0] = options->width;
    j->camera.size[1] = options->height;
  }
  if (!check_region(j)) return CAG_STATUS_USAGE;
  cag_session_begin_meshes(s, &j->camera);
  if (j->renderer == POVRAY) status = cag_session_geometry(s, write_source, j);
  const double left = s->time_left;
  if (options->time_limit > 0) s->time_left = INFINITY; // the renderer has a separate time limit
  if (status == CAG_STATUS_OK)
    status = cag_session_geometry(s, j->renderer == POVRAY ? make_picture : make_preview, j);
  if (options->time_limit > 0) s->time_left = left;
  cag_session_end_meshes(s);
  cag_free(j->source);
  cag_povray_result_free(&j->result);
  return status;
}

static int render_scene(CagSession *s, const CagRenderOptions *options, const char *path) {
  const char *dot = strrchr(path, '.');
  if (!dot || (strcasecmp(dot, ".exr") != 0 && strcasecmp(dot, ".png") != 0)) {
    CagDiagnostic *d =
        cag_diagnostics_add(&s->diagnostics, CAG_ERR_format_unknown, NULL, (CagSpan){0, 0},
                            "expected an .exr or .png file, found %s", path);
    cag_diagnostic_set_help(d, "use `cag export` for other formats");
    return CAG_STATUS_USAGE;
  }
  int status = cag_session_build_scene(s);
  if (status != CAG_STATUS_OK) return status;
  Job j = {.session = s, .options = options, .path = path};
  if (!find_quality(options->quality, &j.pov, &j.engine)) {
    cag_diagnostics_add(&s->diagnostics, CAG_ERR_format_unknown, NULL, (CagSpan){0, 0},
                        "expected the quality draft, normal, or final, found %s", options->quality);
    return CAG_STATUS_USAGE;
  }
  if (!cag_session_pov_csg(s, CAG_POV_CSG_MESH, &j.csg)) return CAG_STATUS_USAGE;
  if (!find_passes(s, options, path, j.passes) || !find_engine(s, options, j.pov, &j.renderer))
    return CAG_STATUS_USAGE;
  if (options->passes) j.renderer = PREVIEW;
  const size_t own = s->scene.camera_count;
  j.index = own;
  status = options->view ? cag_session_geometry(s, add_host_camera, (void *)(size_t)options->view)
                         : cag_session_find_camera(s, options->camera, &j.index);
  if (status == CAG_STATUS_OK) status = render_camera(&j);
  if (s->scene.camera_count > own) cag_scene_remove_view(&s->scene);
  return status;
}

int cag_session_render(CagSession *s, const CagRenderOptions *options, const char *path) {
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  CagRenderOptions usual;
  cag_render_options_init(&usual);
  if (options) {
    const char *quality = options->quality ? options->quality : usual.quality;
    usual = *options;
    usual.quality = quality;
  }
  return cag_session_end(s, render_scene(s, &usual, path));
}
