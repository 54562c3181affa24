#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/image/lines.h"

#define ANGLES 180
#define DEGREES (180 / M_PI)
// Pixels whose centers are within these distances of a peak's line, and of the fitted line, belong
// to it.
#define PEAK_WIDTH 1.5
#define LINE_WIDTH 1
// How often the line is fitted to the pixels that are within LINE_WIDTH of the previous fit.
#define FITS 3

typedef struct Point {
  double x, y; // y up, relative to the center of the image
} Point;

typedef struct Hough {
  Point *points;
  size_t count, capacity;
  size_t bins;                         // for distances from -bins / 2 to bins / 2
  uint32_t *votes;                     // ANGLES x bins
  double cosine[ANGLES], sine[ANGLES]; // of the normals
} Hough;

// x cosine + y sine = distance
typedef struct Normal {
  double cosine, sine, distance;
} Normal;

static double normal_distance(Normal l, Point p) {
  return p.x * l.cosine + p.y * l.sine - l.distance;
}

static CagStatus collect_points(Hough *h, const CagRaster *r, CagError *err) {
  const double cx = (double)r->width / 2, cy = (double)r->height / 2;
  for (size_t y = 0; y < r->height; y++) {
    const double *row = cag_raster_at(r, 0, 0, y);
    for (size_t x = 0; x < r->width; x++) {
      if (!(row[x] > 0)) continue;
      if (!CAG_RESERVE(h->points, h->capacity, h->count + 1)) return cag_fail_memory(err);
      h->points[h->count++] = (Point){(double)x + 0.5 - cx, cy - ((double)y + 0.5)};
    }
    if (cag_stopped()) return cag_stop_fail(err);
  }
  return CAG_OK;
}

static void point_vote(Hough *h, Point p, uint32_t vote) {
  const double middle = (double)(h->bins / 2) + 0.5;
  for (size_t k = 0; k < ANGLES; k++) {
    const double d = p.x * h->cosine[k] + p.y * h->sine[k];
    h->votes[k * h->bins + (size_t)(d + middle)] += vote;
  }
}

static Normal strongest_bin(const Hough *h, uint32_t *votes) {
  size_t best = 0;
  for (size_t i = 1; i < ANGLES * h->bins; i++)
    if (h->votes[i] > h->votes[best]) best = i;
  *votes = h->votes[best];
  const size_t k = best / h->bins;
  return (Normal){h->cosine[k], h->sine[k], (double)(best % h->bins) - (double)(h->bins / 2)};
}

// The line through the points near `line` with the least sum of squared distances.
static Normal line_fit(const Hough *h, Normal line, double within) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (size_t i = 0; i < h->count; i++) {
    const Point p = h->points[i];
    if (!(fabs(normal_distance(line, p)) <= within)) continue;
    n++;
    x += p.x;
    y += p.y;
    xx += p.x * p.x;
    xy += p.x * p.y;
    yy += p.y * p.y;
  }
  if (n < 2) return line;
  x /= n;
  y /= n;
  const double slope = atan2(2 * (xy / n - x * y), xx / n - x * x - (yy / n - y * y)) / 2;
  const Normal fit = {-sin(slope), cos(slope), y * cos(slope) - x * sin(slope)};
  return fit;
}

// Removes the points of the line and their votes, and measures its extent.
static CagImageLine line_take(Hough *h, Normal line, const CagRaster *r) {
  double slope = atan2(-line.cosine, line.sine);
  if (slope <= -M_PI / 2) slope += M_PI;
  if (slope > M_PI / 2) slope -= M_PI;
  const double c = cos(slope), s = sin(slope);
  const double cx = (double)r->width / 2, cy = (double)r->height / 2;
  const double across = line.distance * (line.sine * c - line.cosine * s > 0 ? 1 : -1);
  double from = INFINITY, to = -INFINITY;
  size_t kept = 0;
  CagImageLine out = {.theta = slope * DEGREES, .distance = across + cy * c - cx * s};
  for (size_t i = 0; i < h->count; i++) {
    const Point p = h->points[i];
    if (!(fabs(normal_distance(line, p)) <= LINE_WIDTH)) {
      h->points[kept++] = p;
      continue;
    }
    point_vote(h, p, (uint32_t)-1);
    out.pixels++;
    from = fmin(from, p.x * c + p.y * s);
    to = fmax(to, p.x * c + p.y * s);
  }
  h->count = kept;
  out.start = cag_vec3(cx + from * c - across * s, cy + from * s + across * c, 0);
  out.end = cag_vec3(cx + to * c - across * s, cy + to * s + across * c, 0);
  return out;
}

static CagStatus hough_search(Hough *h, const CagRaster *r, size_t n, CagImageLine *lines,
                              size_t *count, CagError *err) {
  *count = 0;
  while (*count < n) {
    uint32_t votes;
    Normal line = strongest_bin(h, &votes);
    if (votes < 2) break;
    line = line_fit(h, line, PEAK_WIDTH);
    for (int i = 0; i < FITS; i++) line = line_fit(h, line, LINE_WIDTH);
    lines[*count] = line_take(h, line, r);
    if (lines[*count].pixels < 2) break;
    ++*count;
    CagStatus status = cag_stop_check(err);
    if (status) return status;
  }
  return CAG_OK;
}

static CagStatus hough_votes(Hough *h, const CagRaster *r, CagError *err) {
  // The farthest center of a pixel is half a diagonal away.
  h->bins = 2 * (size_t)ceil(hypot((double)r->width, (double)r->height) / 2) + 3;
  h->votes = cag_calloc(ANGLES * h->bins, sizeof *h->votes);
  if (!h->votes) return cag_fail_memory(err);
  for (size_t k = 0; k < ANGLES; k++) {
    h->cosine[k] = cos((double)k / DEGREES);
    h->sine[k] = sin((double)k / DEGREES);
  }
  for (size_t i = 0; i < h->count; i++) {
    point_vote(h, h->points[i], 1);
    if (i % r->width == 0 && cag_stopped()) return cag_stop_fail(err);
  }
  return CAG_OK;
}

CagStatus cag_hough_lines(const CagRaster *r, size_t n, CagImageLine **out, size_t *count,
                          CagError *err) {
  Hough h = {0};
  CagImageLine *lines = cag_calloc(n, sizeof *lines);
  CagStatus status = lines ? CAG_OK : cag_fail_memory(err);
  if (!status) status = collect_points(&h, r, err);
  if (!status) status = hough_votes(&h, r, err);
  if (!status) status = hough_search(&h, r, n, lines, count, err);
  cag_free(h.points);
  cag_free(h.votes);
  if (status) cag_free(lines);
  else *out = lines;
  return status;
}
