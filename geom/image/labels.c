// Labels of connected regions, by runs and a union-find structure.
//
// The runs of each row are joined with those of the row above that they touch (He, Chao, and Suzuki
// 2008). The equivalences are a forest in an array, in which the root of a tree is its first run,
// found with path halving (Tarjan and van Leeuwen 1984). Roots in raster order are numbered from 1.

#include "geom/image/labels.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"

static CagStatus check_gray(const CagRaster *r, size_t x, size_t y, CagError *err) {
  const double v = *cag_raster_at(r, 0, x, y);
  char text[32];
  if (isnan(v) || (v >= 0 && v < INFINITY)) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_gray_weight, "", -1,
                  "expected finite gray values of at least 0, found %s at pixel [%zu, %zu]",
                  cag_number_text(v, text), x, y);
}

static CagStatus run_add(CagLabels *l, size_t *capacity, CagRun run, CagError *err) {
  if (!CAG_RESERVE(l->runs, *capacity, l->run_count + 1)) return cag_fail_memory(err);
  l->runs[l->run_count++] = run;
  return CAG_OK;
}

static CagStatus row_runs(CagLabels *l, const CagRaster *r, size_t y, size_t *capacity,
                          CagError *err) {
  const double *row = cag_raster_at(r, 0, 0, y);
  CagStatus status = CAG_OK;
  for (size_t x = 0; !status && x < r->width;) {
    if (row[x] > 0 && row[x] < INFINITY) {
      const size_t start = x;
      while (x < r->width && row[x] > 0 && row[x] < INFINITY) x++;
      const CagRun run = {.y = (uint32_t)y, .start = (uint32_t)start, .end = (uint32_t)x};
      status = run_add(l, capacity, run, err);
    } else if (row[x] == 0) {
      x++;
    } else {
      status = check_gray(r, x, y, err);
      x++;
    }
  }
  return status;
}

static uint32_t forest_root(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

// The first run stays the root.
static void forest_join(uint32_t *parent, uint32_t a, uint32_t b) {
  a = forest_root(parent, a);
  b = forest_root(parent, b);
  if (a < b) parent[b] = a;
  else parent[a] = b;
}

// Joins runs of neighboring rows. `reach` is 1 if diagonal neighbors touch.
static void join_rows(const CagLabels *l, uint32_t *parent) {
  const uint32_t reach = l->connectivity == 8;
  size_t above = 0;
  for (size_t i = 0; i < l->run_count; i++) {
    const CagRun run = l->runs[i];
    while (above < i && (l->runs[above].y + 1 < run.y || (l->runs[above].y + 1 == run.y &&
                                                          l->runs[above].end + reach <= run.start)))
      above++;
    for (size_t k = above; k < i; k++) {
      const CagRun upper = l->runs[k];
      if (upper.y + 1 != run.y || upper.start >= run.end + reach) break;
      forest_join(parent, (uint32_t)k, (uint32_t)i);
    }
  }
}

static CagStatus number_runs(CagLabels *l, CagError *err) {
  uint32_t *parent = cag_malloc((l->run_count + 1) * sizeof *parent);
  if (!parent) return cag_fail_memory(err);
  for (size_t i = 0; i < l->run_count; i++) parent[i] = (uint32_t)i;
  join_rows(l, parent);
  for (size_t i = 0; i < l->run_count; i++) {
    const uint32_t root = forest_root(parent, (uint32_t)i);
    l->runs[i].label = root == i ? (uint32_t)++l->count : l->runs[root].label;
  }
  cag_free(parent);
  return CAG_OK;
}

// Sorts the runs by label, by counting.
static CagStatus sort_runs(CagLabels *l, CagError *err) {
  l->by = cag_malloc((l->run_count + 1) * sizeof *l->by);
  l->first = cag_calloc(l->count + 2, sizeof *l->first);
  if (!l->by || !l->first) return cag_fail_memory(err);
  for (size_t i = 0; i < l->run_count; i++) l->first[l->runs[i].label]++;
  for (size_t k = 1; k <= l->count; k++) l->first[k] += l->first[k - 1];
  // first[k - 1] is the next slot of label k, and becomes the start of label k + 1.
  for (size_t i = 0; i < l->run_count; i++) l->by[l->first[l->runs[i].label - 1]++] = l->runs[i];
  memmove(l->first + 1, l->first, l->count * sizeof *l->first);
  l->first[0] = 0;
  return CAG_OK;
}

static CagStatus fill_labels(CagLabels *l, CagError *err) {
  l->at = cag_calloc(l->width * l->height, sizeof *l->at);
  if (!l->at) return cag_fail_memory(err);
  for (size_t i = 0; i < l->run_count; i++) {
    const CagRun run = l->runs[i];
    for (size_t x = run.start; x < run.end; x++) l->at[run.y * l->width + x] = run.label;
  }
  return CAG_OK;
}

CagStatus cag_labels_new(const CagRaster *r, int connectivity, CagLabels *out, CagError *err) {
  CagLabels l = {.width = r->width, .height = r->height, .connectivity = connectivity};
  size_t capacity = 0;
  CagStatus status = CAG_OK;
  for (size_t y = 0; !status && y < r->height; y++) {
    status = row_runs(&l, r, y, &capacity, err);
    if (!status) status = cag_stop_check(err);
  }
  if (!status) status = number_runs(&l, err);
  if (!status) status = sort_runs(&l, err);
  if (!status) status = fill_labels(&l, err);
  if (status) cag_labels_free(&l);
  else *out = l;
  return status;
}

void cag_labels_free(CagLabels *l) {
  cag_free(l->runs);
  cag_free(l->by);
  cag_free(l->first);
  cag_free(l->at);
  *l = (CagLabels){0};
}
