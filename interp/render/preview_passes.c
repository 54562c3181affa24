#include "interp/render/preview_passes.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/stop.h"
#include "interp/render/cryptomatte.h"
#include "interp/render/preview_curvature.h"

// A pixel has a square of so many samples for the fractions of parts.
enum { SIDE = 4 };

const char *const cag_preview_pass_names[] = {
#define X(name, text, channels) text,
    CAG_PREVIEW_PASSES(X)
#undef X
        NULL};

bool cag_preview_read_passes(const char *text, bool out[CAG_PASS_COUNT], char wrong[32]) {
  memset(out, 0, CAG_PASS_COUNT * sizeof *out);
  while (*text) {
    const size_t n = strcspn(text, ",");
    int pass = 0;
    while (pass < CAG_PASS_COUNT && (strlen(cag_preview_pass_names[pass]) != n ||
                                     strncmp(cag_preview_pass_names[pass], text, n) != 0))
      pass++;
    if (pass == CAG_PASS_COUNT) {
      snprintf(wrong, 32, "%.*s", (int)(n < 31 ? n : 31), text);
      return false;
    }
    out[pass] = true;
    text += n + (text[n] == ',');
  }
  return true;
}

typedef struct Passes {
  const CagPreviewWorld *world;
  CagCameraMap map;
  CagPreviewCurvature curvature;
  const bool *wanted;
  size_t first[CAG_PASS_COUNT]; // channels
  float *items, *materials;     // hashes of names
  int x, y;                     // of the region
  CagImage *out;
  CagStatus status;
  CagError *err;
} Passes;

// --- Samples ---

static float *sample_at(const Passes *p, CagPreviewPass pass, size_t k, size_t pixel) {
  return cag_image_plane(p->out, p->first[pass] + k) + pixel;
}

static void store_nothing(const Passes *p, size_t pixel) {
  static const size_t counts[CAG_PASS_COUNT] = {
      [CAG_PASS_DEPTH] = 1, [CAG_PASS_NORMAL] = 3, [CAG_PASS_UV] = 2, [CAG_PASS_CURVATURE] = 2};
  for (int pass = 0; pass < CAG_PASS_COUNT; pass++)
    for (size_t k = 0; p->wanted[pass] && k < counts[pass]; k++)
      *sample_at(p, (CagPreviewPass)pass, k, pixel) = NAN;
}

static void store_hit(const Passes *p, const CagPreviewHit *hit, size_t pixel) {
  if (p->wanted[CAG_PASS_DEPTH]) {
    double at[2], depth = NAN;
    cag_camera_project(&p->map, hit->point, at, &depth);
    *sample_at(p, CAG_PASS_DEPTH, 0, pixel) = (float)depth;
  }
  if (p->wanted[CAG_PASS_NORMAL]) {
    *sample_at(p, CAG_PASS_NORMAL, 0, pixel) = (float)hit->normal.x;
    *sample_at(p, CAG_PASS_NORMAL, 1, pixel) = (float)hit->normal.y;
    *sample_at(p, CAG_PASS_NORMAL, 2, pixel) = (float)hit->normal.z;
  }
  if (p->wanted[CAG_PASS_UV]) {
    *sample_at(p, CAG_PASS_UV, 0, pixel) = (float)hit->u;
    *sample_at(p, CAG_PASS_UV, 1, pixel) = (float)hit->v;
  }
}

static CagStatus store_curvature(const Passes *p, const CagRay *ray, const CagPreviewHit *hit,
                                 size_t pixel, CagCrossings *work, CagError *err) {
  CagBend bend = {NAN, NAN};
  if (!p->wanted[CAG_PASS_CURVATURE]) return CAG_OK;
  CagStatus status = cag_preview_curvature_at(&p->curvature, ray, hit, work, &bend, err);
  *sample_at(p, CAG_PASS_CURVATURE, 0, pixel) = (float)bend.mean;
  *sample_at(p, CAG_PASS_CURVATURE, 1, pixel) = (float)bend.gaussian;
  return status;
}

static CagRay ray_at(const Passes *p, double u, double v) {
  const double at[2] = {u, v};
  CagRay ray = {.least = 0, .most = INFINITY};
  cag_camera_sight(&p->map, at, &ray.origin, &ray.direction);
  return ray;
}

static CagStatus count_parts(const Passes *p, int x, int y, size_t pixel, CagCrossings *work,
                             CagError *err) {
  CagCryptoPixel items = {.n = 0}, materials = {.n = 0};
  const float fraction = 1.0f / (SIDE * SIDE);
  for (int k = 0; k < SIDE * SIDE; k++) {
    CagPreviewHit hit;
    bool met;
    const CagRay ray = ray_at(p, x + (k % SIDE + 0.5) / SIDE, y + (k / SIDE + 0.5) / SIDE);
    CagStatus status = cag_preview_meet(p->world, &ray, work, &hit, &met, err);
    if (status) return status;
    if (!met) continue;
    cag_crypto_add(&items, p->items[hit.item], fraction);
    cag_crypto_add(&materials, p->materials[hit.material], fraction);
  }
  if (p->wanted[CAG_PASS_OBJECT])
    cag_crypto_store(&items, p->out, p->first[CAG_PASS_OBJECT], pixel);
  if (p->wanted[CAG_PASS_MATERIAL])
    cag_crypto_store(&materials, p->out, p->first[CAG_PASS_MATERIAL], pixel);
  return CAG_OK;
}

static CagStatus render_row(const Passes *p, size_t row, CagCrossings *work, CagError *err) {
  CagStatus status = cag_stop_check(err);
  const int y = p->y + (int)row;
  for (size_t i = 0; !status && i < p->out->width; i++) {
    const int x = p->x + (int)i;
    const size_t pixel = row * p->out->width + i;
    CagPreviewHit hit;
    bool met;
    const CagRay ray = ray_at(p, x + 0.5, y + 0.5);
    status = cag_preview_meet(p->world, &ray, work, &hit, &met, err);
    if (status) break;
    if (met) store_hit(p, &hit, pixel);
    else store_nothing(p, pixel);
    if (met) status = store_curvature(p, &ray, &hit, pixel, work, err);
    if (!status && (p->wanted[CAG_PASS_OBJECT] || p->wanted[CAG_PASS_MATERIAL]))
      status = count_parts(p, x, y, pixel, work, err);
  }
  return status;
}

static bool render_numbered_row(void *context, size_t row, int thread) {
  Passes *p = context;
  CagError own;
  CagCrossings work = {0};
  const CagStatus status = render_row(p, row, &work, thread == 0 ? p->err : &own);
  cag_crossings_free(&work);
  if (thread == 0 && status) p->status = status;
  return !status;
}

// --- Channels ---

static void name_channels(CagImage *image, const Passes *p) {
  static const struct {
    CagPreviewPass pass;
    size_t k;
    const char *name;
  } NAMES[] = {{CAG_PASS_DEPTH, 0, "depth.Z"},
               {CAG_PASS_NORMAL, 0, "normal.X"},
               {CAG_PASS_NORMAL, 1, "normal.Y"},
               {CAG_PASS_NORMAL, 2, "normal.Z"},
               {CAG_PASS_UV, 0, "uv.U"},
               {CAG_PASS_UV, 1, "uv.V"},
               {CAG_PASS_CURVATURE, 0, "curvature.mean"},
               {CAG_PASS_CURVATURE, 1, "curvature.gaussian"}};
  for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++)
    if (p->wanted[NAMES[i].pass])
      cag_image_set_name(image, p->first[NAMES[i].pass] + NAMES[i].k, NAMES[i].name);
  if (p->wanted[CAG_PASS_OBJECT])
    cag_crypto_name_channels(image, p->first[CAG_PASS_OBJECT], "CryptoObject");
  if (p->wanted[CAG_PASS_MATERIAL])
    cag_crypto_name_channels(image, p->first[CAG_PASS_MATERIAL], "CryptoMaterial");
}

static size_t count_channels(Passes *p) {
  static const size_t counts[CAG_PASS_COUNT] = {[CAG_PASS_DEPTH] = 1,
                                                [CAG_PASS_NORMAL] = 3,
                                                [CAG_PASS_UV] = 2,
                                                [CAG_PASS_CURVATURE] = 2,
                                                [CAG_PASS_OBJECT] = CAG_CRYPTO_CHANNELS,
                                                [CAG_PASS_MATERIAL] = CAG_CRYPTO_CHANNELS};
  size_t n = 0;
  for (int pass = 0; pass < CAG_PASS_COUNT; pass++) {
    p->first[pass] = n;
    if (p->wanted[pass]) n += counts[pass];
  }
  return n;
}

// Hashes the names of items and materials, and describes them.
static CagStatus name_parts(Passes *p, const CagScene *s, CagExrMetadata *m, CagError *err) {
  const size_t most = s->item_count > s->material_count ? s->item_count : s->material_count;
  const char **names = cag_malloc((most + 1) * sizeof *names);
  p->items = cag_malloc((s->item_count + 1) * sizeof *p->items);
  p->materials = cag_malloc((s->material_count + 1) * sizeof *p->materials);
  bool good = names && p->items && p->materials;
  if (!good) cag_fail_memory(err);
  for (size_t i = 0; good && i < s->item_count; i++)
    p->items[i] = cag_crypto_hash(names[i] = s->items[i].name);
  if (good && p->wanted[CAG_PASS_OBJECT])
    good = cag_crypto_describe(m, "CryptoObject", names, s->item_count, err);
  for (size_t i = 0; good && i < s->material_count; i++)
    p->materials[i] = cag_crypto_hash(names[i] = s->materials[i].name);
  if (good && p->wanted[CAG_PASS_MATERIAL])
    good = cag_crypto_describe(m, "CryptoMaterial", names, s->material_count, err);
  cag_free(names);
  return good ? CAG_OK : err->status;
}

CagStatus cag_preview_passes(const CagScene *scene, const CagCamera *camera,
                             const CagPreviewOptions *options, const bool passes[CAG_PASS_COUNT],
                             CagImage *out, CagExrMetadata *metadata, CagError *err) {
  Passes p = {.wanted = passes, .out = out, .err = err};
  const bool whole = options->region_width <= 0;
  const int width = whole ? camera->size[0] : options->region_width;
  const int height = whole ? camera->size[1] : options->region_height;
  p.x = whole ? 0 : options->region_x;
  p.y = whole ? 0 : options->region_y;
  const size_t n = count_channels(&p);
  CagPreviewWorld world;
  if (n == 0) {
    *out = (CagImage){0};
    return CAG_OK;
  }
  CagStatus status = cag_scene_camera_map(camera, &p.map, err);
  if (!status) status = cag_preview_world(scene, &world, err);
  if (status) return status;
  p.world = &world;
  if (passes[CAG_PASS_CURVATURE]) status = cag_preview_curvature_new(&world, &p.curvature, err);
  if (!status) status = name_parts(&p, scene, metadata, err);
  if (!status && !cag_image_create(out, (size_t)width, (size_t)height, n, err))
    status = err->status;
  if (!status) {
    name_channels(out, &p);
    if (!cag_parallel_checked((size_t)height, render_numbered_row, &p))
      status = p.status ? p.status : cag_stop_check(err);
    if (status) cag_image_free(out);
  }
  cag_free(p.items);
  cag_free(p.materials);
  cag_preview_curvature_free(&p.curvature);
  cag_preview_world_free(&world);
  return status;
}
