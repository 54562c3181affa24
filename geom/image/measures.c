// Measures of the figure of an image, from its runs of pixels.
//
// All sums go through the profiles of the figure, which are its column sums and, for each row, the
// sums of w, w x, and w x^2. The moments are computed from the profiles about the centroid, so that
// large coordinates do not cancel.

#include "geom/image/measures.h"

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/image/contour.h"

// The slope is undefined if the moments about the axes differ by less than this fraction.
#define ALL_AXES_ALIKE 1e-12
// A third moment below this fraction of area * greatest^(3/2) is rounding.
#define NO_DIRECTION 1e-9
// The second moment of a pixel about its center, divided by its area.
#define PIXEL_MOMENT (1.0 / 12)
#define DEGREES (180 / M_PI)

// The runs to measure, and their box: columns [left, right) and rows [top, bottom), y down.
typedef struct Figure {
  const CagRaster *raster;
  const CagLabels *labels;
  const CagRun *runs;
  size_t count;
  size_t left, right, top, bottom;
  double *columns;   // sums over the columns of the box
  double (*rows)[3]; // for each row of the box, the sums of w, w x, and w x^2, where x is relative
                     // to the middle of the box
} Figure;

static void figure_box(Figure *f) {
  f->left = f->runs[0].start;
  f->top = f->runs[0].y;
  f->right = f->bottom = 0;
  for (size_t i = 0; i < f->count; i++) {
    const CagRun run = f->runs[i];
    if (run.start < f->left) f->left = run.start;
    if (run.end > f->right) f->right = run.end;
    if (run.y + 1 > f->bottom) f->bottom = run.y + 1;
  }
}

static void figure_profiles(Figure *f) {
  const double middle = (double)(f->right - f->left) / 2;
  for (size_t i = 0; i < f->count; i++) {
    const CagRun run = f->runs[i];
    const double *w = cag_raster_at(f->raster, 0, 0, run.y);
    double *row = f->rows[run.y - f->top];
    for (size_t x = run.start; x < run.end; x++) {
      const double d = (double)(x - f->left) + 0.5 - middle;
      f->columns[x - f->left] += w[x];
      row[0] += w[x];
      row[1] += w[x] * d;
      row[2] += w[x] * d * d;
    }
  }
}

// The location that halves the sum of n weights, each spread over an interval of length 1. `stride`
// is the distance between weights. If a whole interval halves the sum, returns its middle.
static double profile_median(const double *w, size_t n, size_t stride, double total) {
  const double half = total / 2;
  double before = 0;
  size_t i = 0;
  while (i + 1 < n && before + w[i * stride] < half) before += w[i++ * stride];
  if (before + w[i * stride] > half) return (double)i + (half - before) / w[i * stride];
  // The weights up to i are exactly half: the interval ends at the next weight.
  size_t next = i + 1;
  while (next < n && w[next * stride] == 0) next++;
  return ((double)(i + 1) + (double)next) / 2;
}

static double power_sum(const double *w, size_t n, double center, int power) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) {
    const double d = (double)i + 0.5 - center;
    sum += w[i] * (power == 1 ? d : power == 2 ? d * d : d * d * d);
  }
  return sum;
}

// Centers and moments. In the profiles, y points down.
static void figure_moments(const Figure *f, CagMass mass, CagMeasures *m) {
  const size_t w = f->right - f->left, h = f->bottom - f->top;
  const double middle = (double)w / 2;
  double area = 0, y = 0, yy = 0, yyy = 0, xy = 0, xxy = 0, xyy = 0;
  for (size_t i = 0; i < h; i++) area += f->rows[i][0];
  for (size_t i = 0; i < h; i++) y += f->rows[i][0] * ((double)i + 0.5);
  const double cx = power_sum(f->columns, w, 0, 1) / area, cy = y / area, d = cx - middle;
  for (size_t i = 0; i < h; i++) {
    const double *row = f->rows[i], up = cy - ((double)i + 0.5);
    const double x1 = row[1] - d * row[0], x2 = row[2] - 2 * d * row[1] + d * d * row[0];
    yy += row[0] * up * up;
    yyy += row[0] * up * up * up;
    xy += x1 * up;
    xyy += x1 * up * up;
    xxy += x2 * up;
  }
  const double pixel = mass == CAG_MASS_AREA ? PIXEL_MOMENT : 0;
  const double third[4] = {power_sum(f->columns, w, cx, 3) / area, xxy / area, xyy / area,
                           yyy / area};
  const double base = (double)(f->raster->height - f->top); // y of the upper side of the box
  m->area = area;
  m->centroid[0] = (double)f->left + cx;
  m->centroid[1] = base - cy;
  m->center[0] = (double)f->left + profile_median(f->columns, w, 1, area);
  m->center[1] = base - profile_median(f->rows[0], h, 3, area);
  m->xx = power_sum(f->columns, w, cx, 2) / area + pixel;
  m->yy = yy / area + pixel;
  m->xy = xy / area;
  cag_measures_derive(m, third);
}

void cag_measures_derive(CagMeasures *m, const double third[4]) {
  const double sum = m->xx + m->yy, difference = hypot(m->xx - m->yy, 2 * m->xy);
  m->least = fmax(0, (sum - difference) / 2);
  m->greatest = (sum + difference) / 2;
  m->roundness = sum / m->area;
  m->has_thinness = sum > 0;
  if (m->has_thinness) m->thinness = difference / sum;
  m->has_theta = difference > ALL_AXES_ALIKE * sum;
  if (!m->has_theta) return;
  if (m->thinness < ALL_AXES_ALIKE) m->thinness = 0;
  const double theta = atan2(2 * m->xy, m->xx - m->yy) / 2;
  m->theta = theta * DEGREES;
  if (m->theta <= -90) m->theta += 180;
  const double c = cos(theta), s = sin(theta);
  const double along = c * c * c * third[0] + 3 * c * c * s * third[1] + 3 * c * s * s * third[2] +
                       s * s * s * third[3];
  m->has_direction = fabs(along) > NO_DIRECTION * m->greatest * sqrt(m->greatest);
  if (!m->has_direction) return;
  m->direction = along > 0 ? m->theta : m->theta > 0 ? m->theta - 180 : m->theta + 180;
}

// The distance from the origin to the segment from (x, y) along one axis, of length 1.
static double side_distance(double across, double along) {
  const double beyond = fmax(0, fmax(along, -along - 1));
  return hypot(across, beyond);
}

// What the boundary of one pixel adds.
typedef struct Boundary {
  const Figure *f;
  CagMass mass;
  double cx, cy; // the centroid, y down
  size_t sides;
  double least, most;          // distances from the centroid
  long corners, edges, pixels; // of the union of the closed pixels, or of the graph of neighbors
  bool touches;
} Boundary;

// Adds the pixel to the counts for Euler's number, as the corners minus the edges plus the faces of
// a complex (Gray 1971). With 8 neighbors, the faces are the pixels, and each corner and edge is
// counted at its first pixel in raster order. With 4 neighbors, the corners are the pixels, the
// edges join neighbors, and the faces are blocks of four.
static void count_cells(Boundary *b, long x, long y) {
  const CagLabels *l = b->f->labels;
  const bool left = cag_labels_has(l, x - 1, y), up = cag_labels_has(l, x, y - 1);
  const bool up_left = cag_labels_has(l, x - 1, y - 1);
  if (l->connectivity == 4) {
    b->corners++;
    b->edges += left + up;
    b->pixels += left && up && up_left;
    return;
  }
  b->corners += 1 + !left + (!up && !cag_labels_has(l, x + 1, y - 1)) + (!left && !up && !up_left);
  b->edges += 2 + !left + !up;
  b->pixels++;
}

// The sides of a pixel that border on the background, and its corners.
static void measure_pixel(Boundary *b, long x, long y) {
  static const int step[4][2] = {{1, 0}, {0, -1}, {-1, 0}, {0, 1}};
  const CagLabels *l = b->f->labels;
  const double dx = (double)x - b->cx, dy = (double)y - b->cy; // the upper left corner
  bool at_boundary = false;
  for (int k = 0; k < 4; k++) {
    if (cag_labels_has(l, x + step[k][0], y + step[k][1])) continue;
    at_boundary = true;
    b->sides++;
    if (b->mass == CAG_MASS_POINT) continue;
    const double distance = step[k][0] ? side_distance(dx + (step[k][0] > 0), dy)
                                       : side_distance(dy + (step[k][1] > 0), dx);
    b->least = fmin(b->least, distance);
  }
  if (!at_boundary) return;
  if (b->mass == CAG_MASS_POINT) {
    const double distance = hypot(dx + 0.5, dy + 0.5);
    b->least = fmin(b->least, distance);
    b->most = fmax(b->most, distance);
  } else {
    b->most = fmax(b->most, hypot(fmax(fabs(dx), fabs(dx + 1)), fmax(fabs(dy), fabs(dy + 1))));
  }
  b->touches |= x == 0 || y == 0 || (size_t)x + 1 == l->width || (size_t)y + 1 == l->height;
}

static CagStatus figure_boundary(const Figure *f, CagMass mass, CagMeasures *m, CagError *err) {
  Boundary b = {.f = f,
                .mass = mass,
                .cx = m->centroid[0],
                .cy = (double)f->raster->height - m->centroid[1],
                .least = INFINITY};
  for (size_t i = 0; i < f->count; i++) {
    const CagRun run = f->runs[i];
    for (size_t x = run.start; x < run.end; x++) {
      count_cells(&b, (long)x, (long)run.y);
      measure_pixel(&b, (long)x, (long)run.y);
    }
    if (cag_stopped()) return cag_stop_fail(err);
  }
  m->of_pixels = true;
  m->perimeter = (double)b.sides;
  m->r_min = b.least;
  m->r_max = b.most;
  m->euler = b.corners - b.edges + b.pixels;
  m->touches_border = b.touches;
  return CAG_OK;
}

static CagStatus figure_measure(Figure *f, size_t label, CagMass mass, CagMeasures *m,
                                CagError *err) {
  const size_t from = label ? label : 1, to = label ? label : f->labels->count;
  f->columns = cag_calloc(f->right - f->left, sizeof *f->columns);
  f->rows = cag_calloc(f->bottom - f->top, sizeof *f->rows);
  if (!f->columns || !f->rows) return cag_fail_memory(err);
  figure_profiles(f);
  figure_moments(f, mass, m);
  if (!(m->area < INFINITY && m->greatest < INFINITY))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_gray_weight, "", -1,
                    "the sum of the gray values is too large");
  for (size_t k = from; k <= to; k++) m->chain_length += cag_contour_outer_length(f->labels, k);
  CagStatus status = figure_boundary(f, mass, m, err);
  m->holes = (long)(to - from + 1) - m->euler;
  return status;
}

CagStatus cag_measure_figure(const CagRaster *r, const CagLabels *l, size_t label, CagMass mass,
                             CagMeasures *out, CagError *err) {
  Figure f = {.raster = r, .labels = l, .runs = l->runs, .count = l->run_count};
  CagMeasures m = {0};
  if (label > 0) {
    f.runs = l->by + l->first[label - 1];
    f.count = l->first[label] - l->first[label - 1];
  }
  if (f.count == 0)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_empty_image, "", -1,
                    "expected an image with gray values greater than 0, found none");
  figure_box(&f);
  CagStatus status = figure_measure(&f, label, mass, &m, err);
  cag_free(f.columns);
  cag_free(f.rows);
  if (!status) *out = m;
  return status;
}
