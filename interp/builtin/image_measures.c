// Measures of images and silhouettes, and their segmentation.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/image/contour.h"
#include "geom/image/filter.h"
#include "geom/image/histogram.h"
#include "geom/image/silhouette.h"
#include "interp/builtin/image_calls.h"
#include "interp/vm/vm.h"

static void release_labels(void *l) {
  cag_labels_free(l);
  cag_free(l);
}

// Labels the regions of an image. The call holds them.
static CagLabels *hold_labels(CagCall *call, const CagRaster *r, int connectivity) {
  CagLabels *l = cag_malloc(sizeof *l);
  CagStatus status = l ? CAG_OK : cag_fail_memory(call->err);
  if (!status) status = cag_labels_new(r, connectivity, l, call->err);
  if (status) cag_free(l);
  if (!cag_geometry_ok(call, status)) return NULL;
  cag_hold_for(call, release_labels, l);
  return l;
}

// --- Measures ---

#define MEASURES(X)                                                                                \
  X(area)                                                                                          \
  X(center_of_area)                                                                                \
  X(centroid)                                                                                      \
  X(xx)                                                                                            \
  X(yy)                                                                                            \
  X(xy)                                                                                            \
  X(theta)                                                                                         \
  X(least)                                                                                         \
  X(greatest)                                                                                      \
  X(roundness)                                                                                     \
  X(thinness)                                                                                      \
  X(direction) X(perimeter) X(chain_length) X(r_min) X(r_max) X(holes) X(euler) X(touches_border)
#define X(name) #name,
static const char *const measure_names[] = {MEASURES(X)};
#undef X
#define X(name) MEASURE_##name,
enum { MEASURES(X) MEASURE_COUNT };
#undef X

static CagValue number_if(bool has, double x) { return has ? cag_number(x) : cag_none(); }
static CagValue angle_if(bool has, double degrees) { return has ? cag_angle(degrees) : cag_none(); }

static void measure_values(CagVm *vm, const CagMeasures *m, CagValue *v) {
  v[MEASURE_area] = cag_number(m->area);
  v[MEASURE_center_of_area] = cag_xy(vm, m->center[0], m->center[1]);
  v[MEASURE_centroid] = cag_xy(vm, m->centroid[0], m->centroid[1]);
  v[MEASURE_xx] = cag_number(m->xx);
  v[MEASURE_yy] = cag_number(m->yy);
  v[MEASURE_xy] = cag_number(m->xy);
  v[MEASURE_theta] = angle_if(m->has_theta, m->theta);
  v[MEASURE_least] = cag_number(m->least);
  v[MEASURE_greatest] = cag_number(m->greatest);
  v[MEASURE_roundness] = cag_number(m->roundness);
  v[MEASURE_thinness] = number_if(m->has_thinness, m->thinness);
  v[MEASURE_direction] = angle_if(m->has_direction, m->direction);
  v[MEASURE_perimeter] = cag_number(m->perimeter);
  v[MEASURE_chain_length] = number_if(m->of_pixels, m->chain_length);
  v[MEASURE_r_min] = cag_number(m->r_min);
  v[MEASURE_r_max] = cag_number(m->r_max);
  v[MEASURE_holes] = cag_number((double)m->holes);
  v[MEASURE_euler] = cag_number((double)m->euler);
  v[MEASURE_touches_border] = m->of_pixels ? cag_bool(m->touches_border) : cag_none();
}

static CagStatus measure_of(const CagMassOf *of, int connectivity, CagMeasures *out,
                            CagError *err) {
  CagLabels labels;
  if (!of->raster) return cag_measure_region(of->region, out, err);
  CagStatus status = cag_labels_new(of->raster, connectivity, &labels, err);
  if (status) return status;
  status = cag_measure_figure(of->raster, &labels, 0, of->mass, out, err);
  cag_labels_free(&labels);
  return status;
}

bool cag_measures_measure(CagCall *call, const struct cag_measures_measure *a, CagValue *result) {
  CagMassOf of;
  int connectivity;
  CagMeasures m;
  CagValue values[MEASURE_COUNT];
  if (!cag_arg_mass(call, 0, (CagMass)a->moments, &of) ||
      !cag_arg_connectivity(call, 2, &connectivity) ||
      !cag_geometry_ok(call, measure_of(&of, connectivity, &m, call->err)))
    return false;
  measure_values(call->vm, &m, values);
  *result = cag_record_new(call->vm, measure_names, values, MEASURE_COUNT);
  return true;
}

bool cag_measures_spread(CagCall *call, const struct cag_measures_spread *a, CagValue *result) {
  CagMassOf of;
  CagMeasures m;
  double s, c;
  if (!cag_arg_mass(call, 0, (CagMass)a->moments, &of) ||
      !cag_geometry_ok(call, measure_of(&of, 8, &m, call->err)))
    return false;
  cag_sincos(a->theta, &s, &c);
  return cag_give_number(call, m.xx * s * s - 2 * m.xy * s * c + m.yy * c * c, result);
}

// --- Comparison ---

static double axis_turn(double from, double to) {
  double turn = to - from;
  if (turn <= -90) turn += 180;
  if (turn > 90) turn -= 180;
  return turn;
}

// The measures of b minus those of a.
static CagValue measure_differences(CagVm *vm, const CagMeasures *a, const CagMeasures *b) {
  static const char *const names[] = {
      "area",      "center_of_area", "centroid",  "xx",    "yy",    "xy",    "theta",
      "roundness", "thinness",       "perimeter", "r_min", "r_max", "holes", "euler"};
  const CagValue values[] = {
      cag_number(b->area - a->area),
      cag_xy(vm, b->center[0] - a->center[0], b->center[1] - a->center[1]),
      cag_xy(vm, b->centroid[0] - a->centroid[0], b->centroid[1] - a->centroid[1]),
      cag_number(b->xx - a->xx),
      cag_number(b->yy - a->yy),
      cag_number(b->xy - a->xy),
      angle_if(a->has_theta && b->has_theta, axis_turn(a->theta, b->theta)),
      cag_number(b->roundness - a->roundness),
      number_if(a->has_thinness && b->has_thinness, b->thinness - a->thinness),
      cag_number(b->perimeter - a->perimeter),
      cag_number(b->r_min - a->r_min),
      cag_number(b->r_max - a->r_max),
      cag_number((double)(b->holes - a->holes)),
      cag_number((double)(b->euler - a->euler))};
  return cag_record_new(vm, names, values, sizeof names / sizeof *names);
}

// *empty states whether the figure is empty instead.
static bool measure_or_empty(CagCall *call, const CagMassOf *of, CagMeasures *m, bool *empty) {
  CagStatus status = measure_of(of, 8, m, call->err);
  *empty = status == CAG_E_DEGENERATE &&
           (call->err->id == CAG_ERR_empty_image || call->err->id == CAG_ERR_empty_silhouette);
  return *empty || cag_geometry_ok(call, status);
}

bool cag_measures_compare_shapes(CagCall *call, const struct cag_measures_compare_shapes *args,
                                 CagValue *result) {
  static const char *const names[] = {"different", "overlap", "features"};
  CagMassOf a, b;
  CagMeasures of_a, of_b;
  bool empty_a, empty_b;
  CagValue values[3] = {cag_none(), cag_none(), cag_none()};
  (void)args;
  if (!cag_arg_mass(call, 0, CAG_MASS_AREA, &a) || !cag_arg_mass(call, 1, CAG_MASS_AREA, &b))
    return false;
  if (!a.raster == !b.raster) {
    double different, overlap;
    CagStatus status =
        a.raster ? cag_compare_figures(a.raster, b.raster, &different, &overlap, call->err)
                 : cag_compare_regions(a.region, b.region, &different, &overlap, call->err);
    if (!cag_geometry_ok(call, status)) return false;
    values[0] = cag_number(different);
    values[1] = cag_number(overlap);
  }
  if (!measure_or_empty(call, &a, &of_a, &empty_a) || !measure_or_empty(call, &b, &of_b, &empty_b))
    return false;
  if (!empty_a && !empty_b) values[2] = measure_differences(call->vm, &of_a, &of_b);
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

// --- Moments ---

bool cag_measures_moment(CagCall *call, const struct cag_measures_moment *a, CagValue *result) {
  CagMassOf of;
  double moment = 0;
  return cag_arg_mass(call, 0, (CagMass)a->moments, &of) &&
         cag_geometry_ok(call, cag_moment(&of, (int)a->m, (int)a->n, &moment, call->err)) &&
         cag_give_number(call, moment, result);
}

bool cag_measures_polar_moment(CagCall *call, const struct cag_measures_polar_moment *a,
                               CagValue *result) {
  CagMassOf of;
  double moment[2];
  if (!cag_arg_mass(call, 0, (CagMass)a->moments, &of)) return false;
  if (a->n < a->m || (a->n - a->m) % 2 != 0) return cag_fail_value(call, 2, "m, m + 2, m + 4, ...");
  if (!cag_geometry_ok(call, cag_polar_moment(&of, (int)a->m, (int)a->n, moment, call->err)))
    return false;
  *result = cag_vector(call->vm, moment, 2);
  return true;
}

bool cag_measures_turn_between(CagCall *call, const struct cag_measures_turn_between *args,
                               CagValue *result) {
  CagMassOf a, b;
  bool defined = false;
  double angle = 0;
  if (!cag_arg_mass(call, 0, CAG_MASS_AREA, &a) || !cag_arg_mass(call, 1, CAG_MASS_AREA, &b) ||
      !cag_geometry_ok(call, cag_turn_between(&a, &b, (int)args->m, &defined, &angle, call->err)))
    return false;
  *result = angle_if(defined, angle);
  return true;
}

// --- Histograms and thresholds ---

static bool image_counts(CagCall *call, const CagRaster *r, size_t levels, double *counts) {
  if (!cag_gray_image(call, 0, r)) return false;
  if (cag_geometry_ok(call, cag_histogram(r, levels, counts, call->err))) return true;
  return cag_fail_help(call->vm, "`quantize` makes whole numbers of other gray values");
}

bool cag_measures_histogram(CagCall *call, const struct cag_measures_histogram *a,
                            CagValue *result) {
  double *counts;
  *result = cag_list_numbers(call->vm, (size_t)a->levels, &counts);
  memset(counts, 0, (size_t)a->levels * sizeof *counts);
  return image_counts(call, a->image, (size_t)a->levels, counts);
}

static bool otsu_counts(CagCall *call, const double **counts, size_t *levels) {
  if (call->values[0].type != CAG_IMAGE) {
    if (!cag_arg_numbers(call, 0, counts, levels)) return false;
    for (size_t i = 0; i < *levels; i++)
      if (!((*counts)[i] >= 0 && (*counts)[i] < INFINITY))
        return cag_fail_element(call, 0, i, cag_number((*counts)[i]),
                                "finite numbers of at least 0");
    return true;
  }
  const CagRaster *r = CAG_AS_IMAGE(call->values[0])->raster;
  if (!cag_geometry_ok(call, cag_histogram_levels(r, levels, call->err))) return false;
  double *made = cag_hold_array(call, *levels, sizeof *made);
  *counts = made;
  return image_counts(call, r, *levels, made);
}

bool cag_measures_otsu(CagCall *call, const struct cag_measures_otsu *a, CagValue *result) {
  static const char *const names[] = {"threshold", "range", "variance", "below", "above"};
  const double *counts;
  size_t levels;
  CagOtsu o;
  (void)a;
  if (!otsu_counts(call, &counts, &levels) ||
      !cag_geometry_ok(call, cag_otsu(counts, levels, &o, call->err)))
    return false;
  const CagValue values[] = {cag_number(o.threshold), cag_xy(call->vm, o.low, o.high),
                             cag_number(o.variance), cag_number(o.below), cag_number(o.above)};
  *result = cag_record_new(call->vm, names, values, 5);
  return true;
}

bool cag_measures_threshold(CagCall *call, const struct cag_measures_threshold *a,
                            CagValue *result) {
  CagRaster *out = NULL;
  CagStatus status = cag_image_threshold(a->image, a->t, a->keep, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

// --- Regions ---

// The box of a region in pixels, y down: [left, right) and [top, bottom).
typedef struct Box {
  size_t left, right, top, bottom;
} Box;

static Box region_box(const CagLabels *l, size_t label) {
  const CagRun *runs = l->by + l->first[label - 1];
  const size_t n = l->first[label] - l->first[label - 1];
  Box b = {runs[0].start, runs[0].end, runs[0].y, runs[n - 1].y + 1};
  for (size_t i = 0; i < n; i++) {
    if (runs[i].start < b.left) b.left = runs[i].start;
    if (runs[i].end > b.right) b.right = runs[i].end;
  }
  return b;
}

static bool region_image(CagCall *call, const CagRaster *r, const CagLabels *l, size_t label,
                         Box box, CagValue *out) {
  CagRaster *image = cag_held_raster(call, box.right - box.left, box.bottom - box.top, 1);
  if (!image) return false;
  for (size_t i = l->first[label - 1]; i < l->first[label]; i++) {
    const CagRun run = l->by[i];
    memcpy(cag_raster_at(image, 0, run.start - box.left, run.y - box.top),
           cag_raster_at(r, 0, run.start, run.y), (run.end - run.start) * sizeof(double));
  }
  *out = cag_image_result(call, image);
  return true;
}

// The fields of a region after its measures.
enum { REGION_BOUNDS = MEASURE_COUNT, REGION_AT, REGION_IMAGE, REGION_COUNT };

static CagLayout *region_layout(CagVm *vm) {
  static const char *const further[] = {"bounds", "at", "image"};
  CagText *names[REGION_COUNT];
  for (size_t i = 0; i < REGION_COUNT; i++) {
    const char *name = i < MEASURE_COUNT ? measure_names[i] : further[i - MEASURE_COUNT];
    names[i] = cag_intern(vm, name, strlen(name));
  }
  return cag_layout_new(vm, names, REGION_COUNT);
}

static bool region_values(CagCall *call, const struct cag_measures_label_regions *a,
                          const CagLabels *l, size_t label, CagValue *v) {
  const Box box = region_box(l, label);
  const CagBounds bounds = {{(double)box.left, (double)(l->height - box.bottom), 0},
                            {(double)box.right, (double)(l->height - box.top), 0}};
  CagMeasures m;
  if (!cag_geometry_ok(call,
                       cag_measure_figure(a->image, l, label, (CagMass)a->moments, &m, call->err)))
    return false;
  measure_values(call->vm, &m, v);
  v[REGION_BOUNDS] = cag_bounds_value(call->vm, &bounds, 2);
  v[REGION_AT] = cag_xy(call->vm, (double)box.left, (double)box.top);
  v[REGION_IMAGE] = cag_none();
  return !a->images || region_image(call, a->image, l, label, box, &v[REGION_IMAGE]);
}

bool cag_measures_label_regions(CagCall *call, const struct cag_measures_label_regions *a,
                                CagValue *result) {
  static const char *const names[] = {"count", "labels", "regions"};
  int connectivity;
  CagLabels *l;
  CagRaster *labels;
  CagValue values[3], fields[REGION_COUNT];
  if (!cag_gray_image(call, 0, a->image) || !cag_arg_connectivity(call, 1, &connectivity) ||
      !(l = hold_labels(call, a->image, connectivity)) ||
      !(labels = cag_held_raster(call, l->width, l->height, 1)))
    return false;
  const size_t n = l->width * l->height;
  for (size_t i = 0; i < n; i++) labels->data[i] = l->at[i];
  CagBuilder *regions = cag_builder_new(call->vm);
  CagLayout *layout = region_layout(call->vm);
  for (size_t k = 1; k <= l->count; k++)
    if (!region_values(call, a, l, k, fields) ||
        !cag_builder_add(call->vm, regions, cag_record_with_layout(call->vm, layout, fields)))
      return false;
  values[0] = cag_number((double)l->count);
  values[1] = cag_image_result(call, labels);
  values[2] = cag_builder_finish(call->vm, regions);
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

// --- Contours ---

static void release_contours(void *c) {
  cag_contours_free(c);
  cag_free(c);
}

static CagValue contour_points(CagVm *vm, const CagContour *c, size_t height) {
  const size_t n = c->count ? c->count : 1;
  double *xy, x = (double)c->x + 0.5, y = (double)(height - c->y) - 0.5;
  CagValue points = cag_list_vectors(vm, n, 2, &xy);
  for (size_t i = 0; i < n; i++) {
    xy[2 * i] = x;
    xy[2 * i + 1] = y;
    if (i >= c->count) break;
    x += cag_contour_step[c->code[i]][0];
    y -= cag_contour_step[c->code[i]][1];
  }
  return points;
}

static CagValue contour_value(CagVm *vm, const CagContour *c, size_t height) {
  static const char *const names[] = {"hole", "start", "code", "length", "area", "points"};
  CagValue code;
  double *digits;
  if (c->count == 0) {
    code = cag_list_values(vm, NULL, 0);
  } else {
    code = cag_list_numbers(vm, c->count, &digits);
    for (size_t i = 0; i < c->count; i++) digits[i] = c->code[i];
  }
  const CagValue values[] = {
      cag_bool(c->hole),   cag_xy(vm, (double)c->x, (double)c->y), code, cag_number(c->length),
      cag_number(c->area), contour_points(vm, c, height)};
  return cag_record_new(vm, names, values, 6);
}

bool cag_measures_contours(CagCall *call, const struct cag_measures_contours *a, CagValue *result) {
  int connectivity;
  CagLabels *l;
  if (!cag_gray_image(call, 0, a->image) || !cag_arg_connectivity(call, 1, &connectivity) ||
      !(l = hold_labels(call, a->image, connectivity)))
    return false;
  CagContours *found = cag_malloc(sizeof *found);
  CagStatus status = found ? CAG_OK : cag_fail_memory(call->err);
  if (!status) status = cag_contours_new(l, found, call->err);
  if (status) cag_free(found);
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_for(call, release_contours, found);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < found->count; i++)
    if (!cag_builder_add(call->vm, list, contour_value(call->vm, &found->items[i], l->height)))
      return false;
  *result = cag_builder_finish(call->vm, list);
  return true;
}
