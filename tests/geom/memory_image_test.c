// Tests operations on images with exhausted memory and with interrupted work. Each fault is
// reported, and nothing leaks.

#include "base/memory.h"
#include "faults.h"
#include "geom/image/contour.h"
#include "geom/image/edges.h"
#include "geom/image/filter.h"
#include "geom/image/lines.h"
#include "geom/image/moments.h"
#include "geom/image/morphology.h"
#include "geom/image/silhouette.h"
#include "geom/image/template.h"
#include "image_support.h"

#define QUESTION(name) static CagStatus name(const void *given, CagError *e)
// Takes the address because the caller evaluates it before the call that makes the image.
static CagStatus drop_image(CagStatus status, CagRaster *const *made) {
  if (status) return status;
  const double first = (*made)->data[0];
  fault_found(isnan(first) ? -1 : first);
  cag_raster_release(*made);
  return status;
}
static CagStatus drop_images(CagStatus status, CagRaster *const *a, CagRaster *const *b) {
  if (status) return status;
  drop_image(status, a);
  return drop_image(status, b);
}

QUESTION(labels) {
  CagLabels l;
  CagMeasures m;
  CagContours c = {0};
  CagStatus status = cag_labels_new(given, 8, &l, e);
  if (status) return status;
  status = cag_measure_figure(given, &l, 1, CAG_MASS_AREA, &m, e);
  if (!status) status = cag_contours_new(&l, &c, e);
  if (!status) fault_found(m.xx + (double)c.count);
  cag_contours_free(&c);
  cag_labels_free(&l);
  return status;
}
QUESTION(polar) {
  const CagMassOf of = {.raster = given};
  double p[2];
  const CagStatus status = cag_polar_moment(&of, 2, 4, p, e);
  if (!status) fault_found(p[0]);
  return status;
}
QUESTION(median) {
  CagRaster *out;
  return drop_image(cag_image_median(given, 5, CAG_BORDER_REFLECT, &out, e), &out);
}
QUESTION(blurred) {
  CagRaster *out;
  return drop_image(cag_image_blur(given, 1, CAG_BORDER_ZERO, &out, e), &out);
}
QUESTION(canny) {
  CagRaster *out;
  return drop_image(cag_edges_canny(given, 1, 2, 1, &out, e), &out);
}
QUESTION(roberts) {
  CagRaster *a, *b;
  return drop_images(cag_edges_roberts(given, &a, &b, e), &a, &b);
}
QUESTION(sobel) {
  CagRaster *a, *b;
  return drop_images(cag_edges_sobel(given, &a, &b, e), &a, &b);
}
QUESTION(dilated) {
  CagRaster *out;
  return drop_image(cag_image_dilate(given, 5, &out, e), &out);
}
QUESTION(distances) {
  CagRaster *out;
  return drop_image(cag_distance_transform(given, &out, e), &out);
}
QUESTION(hough) {
  CagImageLine *lines;
  size_t n;
  const CagStatus status = cag_hough_lines(given, 3, &lines, &n, e);
  if (status) return status;
  fault_found((double)n);
  cag_free(lines);
  return status;
}
QUESTION(corners) {
  CagImageCorner *found;
  size_t n;
  const CagStatus status = cag_image_corners(given, 9, &found, &n, e);
  if (status) return status;
  fault_found((double)n);
  cag_free(found);
  return status;
}
QUESTION(template_maps) {
  CagRaster *a, *b = NULL, *turned = NULL;
  CagMatch m;
  CagStatus status = cag_template_turned(given, 30, 0.3, &turned, e);
  if (status) return status;
  const CagTemplatePart part = {.pattern = turned};
  status = cag_template_find(given, &part, 1, &m, e);
  if (!status) fault_found(m.error);
  if (!status) status = drop_image(cag_template_errors(given, turned, &a, e), &a);
  if (!status) status = drop_image(cag_template_correlation(given, turned, true, &b, e), &b);
  cag_raster_release(turned);
  return status;
}
QUESTION(silhouette) {
  CagMeasures m;
  const CagStatus status = cag_measure_region(given, &m, e);
  if (!status) fault_found(m.area);
  return status;
}

static void images_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  fault_steps = FAULTS_OF_QUICK;
  seed = 7;
  CagRaster *r = random_picture(23, 17, 3, 0.4);
  try_faults("labels", "image", labels, r);
  try_faults("polar moment", "image", polar, r);
  try_faults("median", "image", median, r);
  try_faults("blur", "image", blurred, r);
  try_faults("canny", "image", canny, r);
  try_faults("roberts", "image", roberts, r);
  try_faults("sobel", "image", sobel, r);
  try_faults("dilate", "image", dilated, r);
  try_faults("distances", "image", distances, r);
  try_faults("hough", "image", hough, r);
  try_faults("corners", "image", corners, r);
  try_faults("templates", "image", template_maps, r);
  cag_raster_release(r);
  assert_int_equal(fault_problems, 0);
}

static void silhouettes_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  fault_steps = FAULTS_OF_QUICK;
  CagCurve *c;
  CagRegion *r;
  const CagTransform frame = cag_transform_identity();
  OK(cag_curve_arc(2, 1, 0, 2 * M_PI, &frame, &c, &err));
  OK(cag_region_new(c, NULL, 0, &r, &err));
  try_faults("measures", "ellipse", silhouette, r);
  cag_region_release(r);
  cag_curve_release(c);
  assert_int_equal(fault_problems, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(images_report_faults),
      cmocka_unit_test(silhouettes_report_faults),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
