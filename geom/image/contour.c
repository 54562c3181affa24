// Border following (Suzuki and Abe 1985, algorithm 1).
//
// At each pixel, the neighbors are searched counter-clockwise, beginning after a neighbor that is
// known to be background. A run of pixels ends at a neighbor that is background on the right. If no
// contour has passed the end of a run and seen that neighbor, it belongs to a hole that has not
// been followed yet. The outer contour of a region starts at its first pixel in raster order.

#include "geom/image/contour.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"

const int cag_contour_step[8][2] = {{1, 0},  {1, -1}, {0, -1}, {-1, -1},
                                    {-1, 0}, {-1, 1}, {0, 1},  {1, 1}};

// Follows one border.
typedef struct Walk {
  const CagLabels *l;
  uint8_t *seen; // for each pixel, whether a contour has seen that its right neighbor is
                 // background; NULL: not needed
  long x, y;
  int step; // 1, or 2 if only neighbors that share a side connect
} Walk;

// The direction of the next pixel, searched from `start`; -1: the pixel has no neighbors.
static int walk_direction(const Walk *w, int start) {
  for (int i = 0; i < 8; i += w->step) {
    const int k = (start + i) % 8;
    if (cag_labels_has(w->l, w->x + cag_contour_step[k][0], w->y + cag_contour_step[k][1]))
      return k;
    if (k == 0 && w->seen) w->seen[(size_t)w->y * w->l->width + (size_t)w->x] = 1;
  }
  return -1;
}

// Where the search begins after a step in direction k: the pixels before this direction were
// background for the previous pixel.
static int walk_start(const Walk *w, int k) {
  return (k % 2 == 0 || w->step == 2 ? k + 6 : k + 5) % 8;
}

// Follows the border from the pixel of the walk, and adds the steps to *c if it stores them.
static CagStatus walk_around(Walk *w, int start, bool store, CagContour *c, CagError *err) {
  const long x = w->x, y = w->y;
  size_t capacity = 0, straight = 0, diagonal = 0;
  double twice_area = 0;
  const int first = walk_direction(w, start);
  for (int k = first; k >= 0;) {
    const int *step = cag_contour_step[k];
    if (store && !CAG_RESERVE(c->code, capacity, c->count + 1)) return cag_fail_memory(err);
    if (store) c->code[c->count++] = (uint8_t)k;
    if (k % 2) diagonal++;
    else straight++;
    // The cross product of the location and the step, relative to the start, with y up.
    twice_area += (double)(w->y - y) * step[0] - (double)(w->x - x) * step[1];
    w->x += step[0];
    w->y += step[1];
    k = walk_direction(w, walk_start(w, k));
    if (w->x == x && w->y == y && k == first) break;
  }
  c->length = (double)straight + M_SQRT2 * (double)diagonal;
  c->area = fabs(twice_area) / 2;
  return CAG_OK;
}

static Walk walk_at(const CagLabels *l, uint8_t *seen, size_t x, size_t y) {
  return (Walk){
      .l = l, .seen = seen, .x = (long)x, .y = (long)y, .step = l->connectivity == 4 ? 2 : 1};
}

// Directions in which a search begins, counter-clockwise after the background neighbor: the one on
// the left of the first pixel, or on the right of a pixel next to a hole.
static int outer_start(const CagLabels *l) { return l->connectivity == 4 ? 6 : 5; }
static int hole_start(const CagLabels *l) { return l->connectivity == 4 ? 2 : 1; }

static CagStatus contour_add(CagContours *all, const CagLabels *l, uint8_t *seen, CagContour c,
                             CagError *err) {
  if (!CAG_RESERVE(all->items, all->capacity, all->count + 1)) return cag_fail_memory(err);
  Walk w = walk_at(l, seen, c.x, c.y);
  CagContour *added = &all->items[all->count++];
  *added = c;
  return walk_around(&w, c.hole ? hole_start(l) : outer_start(l), true, added, err);
}

CagStatus cag_contours_new(const CagLabels *l, CagContours *out, CagError *err) {
  CagContours all = {0};
  size_t regions = 0; // whose outer contour has been followed
  uint8_t *seen = cag_calloc(l->width * l->height, 1);
  CagStatus status = seen ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < l->run_count; i++) {
    const CagRun run = l->runs[i];
    CagContour c = {.x = run.start, .y = run.y, .label = run.label};
    if (run.label > regions) {
      regions = run.label;
      status = contour_add(&all, l, seen, c, err);
    }
    c.hole = true;
    c.x = run.end - 1;
    if (!status && !seen[run.y * l->width + c.x]) status = contour_add(&all, l, seen, c, err);
    if (!status) status = cag_stop_check(err);
  }
  cag_free(seen);
  if (status) cag_contours_free(&all);
  else *out = all;
  return status;
}

double cag_contour_outer_length(const CagLabels *l, size_t label) {
  const CagRun run = l->by[l->first[label - 1]];
  Walk w = walk_at(l, NULL, run.start, run.y);
  CagContour c = {0};
  CagError unused;
  walk_around(&w, outer_start(l), false, &c, &unused); // cannot fail: nothing is stored
  return c.length;
}

void cag_contours_free(CagContours *c) {
  for (size_t i = 0; i < c->count; i++) cag_free(c->items[i].code);
  cag_free(c->items);
  *c = (CagContours){0};
}
